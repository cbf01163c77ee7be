/* Loops without branches, compiled for what every machine has and once more for AVX2 with a multiply-add. (The Makefile
 * tells gcc not to mind floating-point traps here: it would keep one side of a selection behind a branch otherwise.) */
#include "finder/batch.h"

#include "num/binary64.h"

#include "num/vector.inl"

#include "num/sum_rest.inl"
#include "overlap/quadratic.inl"

#include "overlap/ball_ball.inl"
#include "overlap/ball_leave.inl"
#include "overlap/ball_plane.inl"
#include "overlap/half_space.inl"

#include "finder/claim.inl"
#include "method/stable.inl"

#include "method/compensated.inl"
#include "method/rounded_fast.inl"

/* stable_meeting() and stable_parting() once more, without branches. */
static inline __attribute__((always_inline)) double meeting_directly(const struct quadratic *f)
{
	double later = f->c / (sqrt(f->discriminant) - f->b);
	double time = f->discriminant > 0 ? later : INFINITY;
	time = f->c > 0 ? time : 0;
	return f->b < 0 ? time : INFINITY;
}

static inline __attribute__((always_inline)) double parting_directly(const struct quadratic *f)
{
	int comes = f->b<0, real = f->discriminant> 0, inside = f->c < 0;
	double end = sqrt(real ? f->discriminant : 0), over = comes ? end - f->b : -f->c, under = comes ? f->a : f->b + end;
	double later = over / under, time = (comes | (real & inside)) ? later : 0;
	return f->a > 0 ? time : INFINITY;
}

/* What `compensated` answers wherever neither b nor c cancels, NaN elsewhere. */
static inline __attribute__((always_inline)) double compensated_directly(bool part, const struct balls *balls,
																		 struct quadratic *f)
{
	struct sum sum_of_b = sum_dot(balls->r, balls->v), sum_of_c = sum_c(balls);
	struct pair a = summed(sum_dot(balls->v, balls->v)), b = summed(sum_of_b), c = summed(sum_of_c);
	*f = (struct quadratic){a.high, b.high, c.high, pair_discriminant(a, b, c)};
	double time = part ? parting_directly(f) : meeting_directly(f);
	int cancel = fabs(b.high) < enough_of(sum_of_b), cancel_too = fabs(c.high) < enough_of(sum_of_c);
	return (cancel | cancel_too) ? NAN : time;
}

/* Questions that are turned into columns, one number of all in a row, at a time; they are answered by eights. */
enum { COLUMN = 64, LANES = 8 };

typedef double column[COLUMN];
typedef double direct_finder(bool part, const struct balls *balls, struct quadratic *f);

/* Question k. (What it declares would be given an array each, if the loop below declared it.) */
static inline __attribute__((always_inline)) double answer_one(direct_finder *finder, bool part, column *number, int k)
{
	struct balls balls = {.r = {number[0][k], number[1][k], number[2][k]},
						  .v = {number[3][k], number[4][k], number[5][k]},
						  .contact = number[6][k]};
	struct quadratic f;
	return finder(part, &balls, &f);
}

static inline __attribute__((always_inline)) void answer_columns(direct_finder *finder, bool part, int count,
																 column *number, double *time)
{
	for (int k = 0; k < count; k++) time[k] = answer_one(finder, part, number, k);
}

static inline __attribute__((always_inline)) void answer_all(direct_finder *finder, bool part,
															 const double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
															 size_t count, double *times)
{
	column number[TOUCHSTONE_MOST_NUMBERS] = {0}, time;
	for (size_t begin = 0; begin < count; begin += COLUMN) {
		size_t here = count - begin < COLUMN ? count - begin : COLUMN;
		int eights = (int)(here + LANES - 1) / LANES;
		for (size_t k = 0; k < here; k++)
			for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) number[i][k] = numbers[begin + k][i];
		if (part)
			answer_columns(finder, true, eights * LANES, number, time);
		else
			answer_columns(finder, false, eights * LANES, number, time);
		for (size_t k = 0; k < here; k++) times[begin + k] = time[k];
	}
}

#ifdef __x86_64__
__attribute__((target("arch=x86-64-v3"))) static void
rounded_wide(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, double *times)
{
	answer_all(fast_balls, part, numbers, count, times);
}

__attribute__((target("arch=x86-64-v3"))) static void
compensated_wide(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, double *times)
{
	answer_all(compensated_directly, part, numbers, count, times);
}

static bool is_wide(void)
{
	return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}
#endif

static void rounded_anywhere(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, double *times)
{
	answer_all(fast_balls, part, numbers, count, times);
}

static void compensated_anywhere(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count,
								 double *times)
{
	answer_all(compensated_directly, part, numbers, count, times);
}

void batch_rounded(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, double *times)
{
	batch *chosen = rounded_anywhere;
#ifdef __x86_64__
	if (is_wide()) chosen = rounded_wide;
#endif
	chosen(part, numbers, count, times);
}

void batch_compensated(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, double *times)
{
	batch *chosen = compensated_anywhere;
#ifdef __x86_64__
	if (is_wide()) chosen = compensated_wide;
#endif
	chosen(part, numbers, count, times);
}

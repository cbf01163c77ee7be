/* The loop over the fast path, which has no branches, compiled for what every machine has and once more for AVX2 with a
 * multiply-add. (The Makefile tells gcc not to mind floating-point traps here: it would keep one side of a selection
 * behind a branch otherwise.) */
#include "method/rounded_batch.h"

#include "num/binary64.h"

#include "num/vector.inl"
#include "overlap/quadratic.inl"

#include "overlap/ball_ball.inl"
#include "overlap/ball_plane.inl"

#include "method/rounded_fast.inl"

/* Questions that are turned into columns, one number of all in a row, at a time; they are answered by eights. */
enum { BATCH = 64, LANES = 8 };

/* Question k. (What it declares would be given an array each, if the loop below declared it.) */
static inline __attribute__((always_inline)) double answer(bool part, double column[][BATCH], int k)
{
	struct balls balls = {.r = {column[0][k], column[1][k], column[2][k]},
						  .v = {column[3][k], column[4][k], column[5][k]},
						  .contact = column[6][k]};
	struct quadratic f;
	return fast_balls(&balls, part, &f);
}

static inline __attribute__((always_inline)) void answer_columns(bool part, int count, double column[][BATCH],
																 double time[BATCH])
{
#pragma omp simd
	for (int k = 0; k < count; k++) time[k] = answer(part, column, k);
}

static inline __attribute__((always_inline)) void
answer_all(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, double *times)
{
	double column[TOUCHSTONE_MOST_NUMBERS][BATCH] = {0}, time[BATCH];
	for (size_t begin = 0; begin < count; begin += BATCH) {
		size_t here = count - begin < BATCH ? count - begin : BATCH;
		for (size_t k = 0; k < here; k++)
			for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) column[i][k] = numbers[begin + k][i];
		int eights = (int)(here + LANES - 1) / LANES;
		if (part)
			answer_columns(true, eights * LANES, column, time);
		else
			answer_columns(false, eights * LANES, column, time);
		for (size_t k = 0; k < here; k++) times[begin + k] = time[k];
	}
}

#ifdef __x86_64__
__attribute__((target("arch=x86-64-v3"))) static void
answer_all_wide(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, double *times)
{
	answer_all(part, numbers, count, times);
}
#endif

void rounded_batch(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, double *times)
{
#ifdef __x86_64__
	if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
		answer_all_wide(part, numbers, count, times);
		return;
	}
#endif
	answer_all(part, numbers, count, times);
}

#include "fuzz/shrink.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "store/query_file.h"

enum {
	DOUBLE_BITS = 53,
	MOST_CRASHES = 300, /* each costs a process */
	MOST_HANGS = 40,    /* each costs all the patience there is */
};

unsigned fuzz_bits(double number)
{
	uint64_t bits, hidden = UINT64_C(1) << (DOUBLE_BITS - 1);
	memcpy(&bits, &number, sizeof bits);
	uint64_t significand = bits & (hidden - 1);
	if (bits << 1 >= hidden << 1) significand |= hidden; /* but for zero and the subnormal */
	if (significand == 0) return 0;
	return 64 - (unsigned)__builtin_clzll(significand) - (unsigned)__builtin_ctzll(significand);
}

unsigned fuzz_case_bits(enum touchstone_shape shape, const struct fuzz_case *one)
{
	unsigned bits = 0;
	for (int q = 0; q < one->questions; q++)
		for (size_t n = 0; n < shape_numbers(shape); n++) bits += fuzz_bits(one->number[q][n]);
	return bits;
}

/* What makes a case simple, the weightiest first. */
struct burden {
	unsigned bits, exponents, signs, questions_differ;
};

/* One case on its way to a simpler one. */
struct shrinking {
	const struct fuzz_subject *subject;
	struct oracle *oracle;
	struct fuzz_case best;
	struct burden burden; /* of the best */
	size_t numbers, all;  /* of a question, of the case */
	unsigned tried, most;
	unsigned crashes, hangs; /* tries that ended so: dear ones */
	const volatile int *stop;
};

static double *number_of(const struct shrinking *shrinking, struct fuzz_case *one, size_t n)
{
	return &one->number[n / shrinking->numbers][n % shrinking->numbers];
}

static struct burden burden_of(const struct shrinking *shrinking, struct fuzz_case *one)
{
	struct burden burden = {.bits = fuzz_case_bits(shrinking->subject->shape, one)};
	for (size_t n = 0; n < shrinking->all; n++) {
		double number = *number_of(shrinking, one, n);
		if (number == 0) continue;
		burden.exponents += (unsigned)abs(ilogb(number));
		burden.signs += number < 0;
		burden.questions_differ +=
			one->questions == 2 && one->number[0][n % shrinking->numbers] != one->number[1][n % shrinking->numbers];
	}
	return burden;
}

static bool lighter(const struct burden *one, const struct burden *other)
{
	if (one->bits != other->bits) return one->bits < other->bits;
	if (one->exponents != other->exponents) return one->exponents < other->exponents;
	if (one->questions_differ != other->questions_differ) return one->questions_differ < other->questions_differ;
	return one->signs < other->signs;
}

static bool at_end(const struct shrinking *shrinking)
{
	return shrinking->tried >= shrinking->most || shrinking->crashes >= MOST_CRASHES ||
		   shrinking->hangs >= MOST_HANGS || (shrinking->stop && *shrinking->stop);
}

/* Takes the candidate if it is simpler and fails alike. */
static bool offer(struct shrinking *shrinking, struct fuzz_case *candidate)
{
	for (size_t n = 0; n < shrinking->all; n++)
		if (!isfinite(*number_of(shrinking, candidate, n))) return false;
	struct burden burden = burden_of(shrinking, candidate);
	if (!lighter(&burden, &shrinking->burden) || at_end(shrinking)) return false;
	shrinking->tried++;
	bool fails = fuzz_try(shrinking->subject, shrinking->oracle, candidate);
	shrinking->crashes += fails && candidate->failure == FUZZ_CRASH;
	shrinking->hangs += fails && candidate->failure == FUZZ_HANG;
	if (!fails || !fuzz_same(candidate, &shrinking->best)) return false;
	shrinking->best = *candidate;
	shrinking->burden = burden;
	return true;
}

/* ---- simpler numbers */

/* Cut to so many significant bits, toward zero or away from it. */
static double cut(double number, unsigned bits, bool away)
{
	int exponent;
	double significand = ldexp(frexp(number, &exponent), (int)bits);
	double whole = away ? copysign(ceil(fabs(significand)), significand) : trunc(significand);
	return ldexp(whole, exponent - (int)bits);
}

static double shifted(double number, int exponent)
{
	return number == 0 ? 0 : ldexp(number, exponent);
}

static bool replace(struct shrinking *shrinking, size_t n, double number)
{
	struct fuzz_case candidate = shrinking->best;
	*number_of(shrinking, &candidate, n) = number;
	return offer(shrinking, &candidate);
}

/* One number for itself: gone, one, a power of two, fewer bits, a smaller exponent, no sign. */
static bool simplify_number(struct shrinking *shrinking, size_t n)
{
	double number = *number_of(shrinking, &shrinking->best, n);
	if (number == 0) return false;
	if (replace(shrinking, n, 0) || replace(shrinking, n, 1) || replace(shrinking, n, -1)) return true;
	for (unsigned bits = 1, most = fuzz_bits(number); bits < most; bits++)
		if (replace(shrinking, n, cut(number, bits, false)) || replace(shrinking, n, cut(number, bits, true)))
			return true;
	int exponent = ilogb(number);
	for (int left = 0; exponent != 0; left = left ? left + (exponent - left) / 2 : exponent / 2) {
		if (replace(shrinking, n, shifted(number, left - exponent))) return true;
		if (abs(exponent - left) <= 1) break;
	}
	return replace(shrinking, n, fabs(number));
}

/* Two numbers at once, where a failure hangs on their relation: equal, opposite, cut alike, exchanged for one another's
 * power of two. */
static bool simplify_pair(struct shrinking *shrinking, size_t m, size_t n)
{
	double one = *number_of(shrinking, &shrinking->best, m), other = *number_of(shrinking, &shrinking->best, n);
	if (one == 0 || other == 0) return false;
	if (replace(shrinking, n, one) || replace(shrinking, n, -one)) return true;
	for (int exponent = -64; exponent <= 64; exponent += 8) { /* a far smaller or larger one in place of both */
		struct fuzz_case candidate = shrinking->best;
		*number_of(shrinking, &candidate, m) = 0;
		*number_of(shrinking, &candidate, n) = copysign(ldexp(1, exponent), other);
		if (offer(shrinking, &candidate)) return true;
	}
	unsigned most = fuzz_bits(one) > fuzz_bits(other) ? fuzz_bits(one) : fuzz_bits(other);
	for (unsigned bits = 1; bits < most; bits++)
		for (int way = 0; way < 4; way++) {
			struct fuzz_case candidate = shrinking->best;
			*number_of(shrinking, &candidate, m) = bits < fuzz_bits(one) ? cut(one, bits, way & 1) : one;
			*number_of(shrinking, &candidate, n) = bits < fuzz_bits(other) ? cut(other, bits, way & 2) : other;
			if (offer(shrinking, &candidate)) return true;
		}
	for (int way = 0; way < 4; way++) { /* opposite shifts keep a product, equal ones a ratio */
		struct fuzz_case candidate = shrinking->best;
		int by = way & 1 ? 1 : -1;
		*number_of(shrinking, &candidate, m) = shifted(one, by);
		*number_of(shrinking, &candidate, n) = shifted(other, way & 2 ? by : -by);
		if (offer(shrinking, &candidate)) return true;
	}
	return false;
}

/* Units: which power of the unit of length and of time each number carries, shape by shape. */
static const struct {
	signed char length, time;
} units[TOUCHSTONE_SHAPES][TOUCHSTONE_MOST_NUMBERS] = {
	[TOUCHSTONE_BALL_BALL] = {{1, 0}, {1, 0}, {1, 0}, {1, -1}, {1, -1}, {1, -1}, {1, 0}},
	[TOUCHSTONE_BALL_LEAVE] = {{1, 0}, {1, 0}, {1, 0}, {1, -1}, {1, -1}, {1, -1}, {1, 0}},
	[TOUCHSTONE_BALL_PLANE] = {{1, 0}, {1, -1}, {1, -2}, {1, 0}},
	[TOUCHSTONE_HALF_SPACE] = {{1, 0}, {1, -1}},
};

/* Another unit, which changes nothing where nothing overflows: by powers of two, large ones first. */
static bool simplify_units(struct shrinking *shrinking)
{
	for (int time = 0; time < 2; time++)
		for (int step = 512; step; step /= 2)
			for (int sign = -1; sign <= 1; sign += 2) {
				struct fuzz_case candidate = shrinking->best;
				for (size_t n = 0; n < shrinking->all; n++) {
					size_t which = n % shrinking->numbers;
					int power = time ? units[shrinking->subject->shape][which].time
									 : units[shrinking->subject->shape][which].length;
					double *number = number_of(shrinking, &candidate, n);
					*number = shifted(*number, sign * step * power);
				}
				if (offer(shrinking, &candidate)) return true;
			}
	return false;
}

static bool simplify(struct shrinking *shrinking)
{
	if (simplify_units(shrinking)) return true;
	for (size_t n = 0; n < shrinking->all; n++)
		if (simplify_number(shrinking, n)) return true;
	for (size_t m = 0; m < shrinking->all; m++)
		for (size_t n = 0; n < shrinking->all; n++)
			if (m != n && simplify_pair(shrinking, m, n)) return true;
	return false;
}

unsigned fuzz_shrink(const struct fuzz_subject *subject, struct oracle *oracle, struct fuzz_case *failed,
					 unsigned tries, const volatile int *stop)
{
	struct shrinking shrinking = {.subject = subject,
								  .oracle = oracle,
								  .best = *failed,
								  .numbers = shape_numbers(subject->shape),
								  .most = tries,
								  .stop = stop};
	shrinking.all = shrinking.numbers * (size_t)failed->questions;
	shrinking.burden = burden_of(&shrinking, &shrinking.best);
	while (!at_end(&shrinking) && simplify(&shrinking)) continue;
	*failed = shrinking.best;
	return shrinking.tried;
}

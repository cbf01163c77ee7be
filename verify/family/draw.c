#include "family/draw.h"

#include <math.h>
#include <string.h>

bool draw_chance(struct random_state *random, unsigned one_in)
{
	return random_below(random, one_in) == 0;
}

int draw_between(struct random_state *random, int least, int most)
{
	return least + (int)random_below(random, (uint64_t)(most - least) + 1);
}

int64_t draw_steps(struct random_state *random, unsigned bits)
{
	uint64_t first = UINT64_C(1) << random_below(random, bits);
	return (int64_t)(first + random_below(random, first));
}

int64_t draw_whole(struct random_state *random, unsigned bits)
{
	if (draw_chance(random, 2)) return draw_steps(random, bits);
	return (int64_t)(1 + random_below(random, (UINT64_C(1) << bits) - 1));
}

double draw_sign(struct random_state *random, double x)
{
	return random_bits(random) >> 63 ? -x : x;
}

static double from_pattern(uint64_t pattern)
{
	double x;
	memcpy(&x, &pattern, sizeof x);
	return x;
}

double draw_significand(struct random_state *random)
{
	return from_pattern(UINT64_C(0x3ff) << 52 | random_bits(random) >> 12);
}

double draw_uniform(struct random_state *random)
{
	uint64_t bits = random_bits(random);
	int zeros = bits ? __builtin_clzll(bits) : 64;
	return ldexp(draw_significand(random), -1 - zeros);
}

double draw_scaled(struct random_state *random, int least, int most)
{
	double significand = draw_sign(random, draw_significand(random));
	return ldexp(significand, draw_between(random, least, most));
}

double draw_pattern(struct random_state *random)
{
	double x;
	do x = from_pattern(random_bits(random));
	while (!isfinite(x));
	return x;
}

void draw_vector(struct random_state *random, double vector[3])
{
	int axes = draw_chance(random, 8) ? draw_between(random, 1, 2) : 3;
	for (int axis = 0; axis < 3; axis++) vector[axis] = axis < axes ? draw_sign(random, draw_uniform(random)) : 0;
}

double draw_stepped(double x, int64_t steps)
{
	uint64_t pattern;
	memcpy(&pattern, &x, sizeof x);
	return from_pattern(pattern + (uint64_t)steps);
}

double draw_dot(const double a[3], const double b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void draw_shift(double *number, int count, int exponent)
{
	for (int i = 0; i < count; i++) number[i] = ldexp(number[i], exponent);
}

struct draw_frame draw_frame(struct random_state *random, unsigned bits)
{
	int most = (1 << bits) - 1;
	int64_t w = draw_between(random, 1, most), x = draw_between(random, -most, most);
	int64_t y = draw_between(random, -most, most), z = draw_between(random, -most, most);
	return (struct draw_frame){
		.axis = {{w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)},
				 {2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)},
				 {2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z}},
		.length = w * w + x * x + y * y + z * z,
	};
}

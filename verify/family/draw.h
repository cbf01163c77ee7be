/* What questions are made of: numbers with all 53 bits drawn, and vectors in exact relations to each other. */
#ifndef VERIFY_FAMILY_DRAW_H
#define VERIFY_FAMILY_DRAW_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/random.h"

/* True once in so many times. */
bool draw_chance(struct random_state *random, unsigned one_in);

/* Whole numbers: from least to most; and from 1 up, of at most so many bits (1 to 63), each number of bits as likely
 * as the others. */
int draw_between(struct random_state *random, int least, int most);
int64_t draw_steps(struct random_state *random, unsigned bits);

/* From 1 up, of at most so many bits: half of them uniform, so that most have nearly all bits, the others as above. */
int64_t draw_whole(struct random_state *random, unsigned bits);

/* x or -x. */
double draw_sign(struct random_state *random, double x);

/* A significand, in [1, 2): all 52 bits below the first are drawn. */
double draw_significand(struct random_state *random);

/* Uniform in (0, 1), with all 53 bits of the significand drawn however small it is. */
double draw_uniform(struct random_state *random);

/* A significand of any sign times 2^exponent, the exponent from least to most, each as likely as the others. */
double draw_scaled(struct random_state *random, int least, int most);

/* Any finite double, each bit pattern as likely as the others. */
double draw_pattern(struct random_state *random);

/* Components uniform in (-1, 1); once in eight times only the first one, or the first two, are not zero. */
void draw_vector(struct random_state *random, double vector[3]);

/* The double so many steps above x > 0; below it when `steps` is negative. */
double draw_stepped(double x, int64_t steps);

double draw_dot(const double a[3], const double b[3]);

/* Multiplies by a power of two. */
void draw_shift(double *number, int count, int exponent);

/* Three vectors of whole numbers, orthogonal to each other and of the same whole length: the columns of the rotation
 * by a quaternion of whole numbers, over its norm (Euler and Rodrigues). Components and length are at most
 * 4 (2^bits - 1)^2. */
struct draw_frame {
	int64_t axis[3][3];
	int64_t length;
};
struct draw_frame draw_frame(struct random_state *random, unsigned bits);

#endif

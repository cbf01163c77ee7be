/* Random numbers that are the same on every machine: whole-number arithmetic and comparisons only. */
#ifndef TOUCHSTONE_RANDOM_H
#define TOUCHSTONE_RANDOM_H

#include <stdint.h>

/* xoshiro256** (Blackman and Vigna 2021, "Scrambled linear pseudorandom number generators"). */
struct random_state {
	uint64_t word[4];
};

/* Fills the state from one number by splitmix64 (Steele, Lea and Flood 2014), so that near seeds start far apart. */
struct random_state random_seed(uint64_t seed);

/* The next 64 bits. */
uint64_t random_bits(struct random_state *state);

/* Uniform in [0, 1): a multiple of 2^-53, with all 53 bits drawn. */
double random_uniform(struct random_state *state);

/* A whole number below `bound` (> 0), each exactly as likely as the others. */
uint64_t random_below(struct random_state *state, uint64_t bound);

/* Mean 0, variance 1, by algorithm N of Karney 2016, "Sampling exactly from the normal distribution": the law is
 * exact up to the 64 bits that each comparison looks at, and no logarithm is taken. */
double random_normal(struct random_state *state);

#endif

#include "scene/random.h"

#include <stdbool.h>

struct random_state random_seed(uint64_t seed)
{
	struct random_state state;
	for (int i = 0; i < 4; i++) {
		uint64_t mixed = seed += UINT64_C(0x9e3779b97f4a7c15);
		mixed = (mixed ^ mixed >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
		mixed = (mixed ^ mixed >> 27) * UINT64_C(0x94d049bb133111eb);
		state.word[i] = mixed ^ mixed >> 31;
	}
	return state;
}

static uint64_t rotated(uint64_t word, int left)
{
	return word << left | word >> (64 - left);
}

uint64_t random_bits(struct random_state *state)
{
	uint64_t *word = state->word;
	uint64_t result = rotated(word[1] * 5, 7) * 9;
	uint64_t shifted = word[1] << 17;
	word[2] ^= word[0];
	word[3] ^= word[1];
	word[1] ^= word[2];
	word[0] ^= word[3];
	word[2] ^= shifted;
	word[3] = rotated(word[3], 45);
	return result;
}

double random_uniform(struct random_state *state)
{
	return (double)(random_bits(state) >> 11) * 0x1p-53;
}

uint64_t random_below(struct random_state *state, uint64_t bound)
{
	uint64_t surplus = -bound % bound; /* 2^64 modulo bound: that many numbers too many */
	uint64_t bits;
	do bits = random_bits(state);
	while (bits < surplus);
	return bits % bound;
}

/* True with probability exp(-1/2): a descending run of uniform numbers that starts below 1/2 has an even length
 * with just that probability (algorithm H). */
static bool half_decay(struct random_state *state)
{
	uint64_t last = UINT64_C(1) << 63;
	for (bool even = true;; even = !even) {
		uint64_t next = random_bits(state);
		if (next >= last) return even;
		last = next;
	}
}

/* True with probability exp(-x (2k + x) / (2k + 2)), where x is `fraction` in units of 2^-64 (algorithm B). */
static bool decay(struct random_state *state, uint64_t k, uint64_t fraction)
{
	uint64_t last = fraction;
	for (bool even = true;; even = !even) {
		uint64_t next = random_bits(state);
		if (next >= last) return even;
		uint64_t choice = random_below(state, 2 * k + 2);
		if (choice == 0 || (choice == 1 && random_bits(state) >= fraction)) return even;
		last = next;
	}
}

double random_normal(struct random_state *state)
{
	for (;;) {
		uint64_t k = 0;
		while (half_decay(state)) k++;
		bool accepted = true;
		for (uint64_t n = k > 1 ? k * (k - 1) : 0; n > 0 && accepted; n--) accepted = half_decay(state);
		if (!accepted) continue;
		uint64_t fraction = random_bits(state);
		for (uint64_t n = 0; n <= k && accepted; n++) accepted = decay(state, k, fraction);
		if (!accepted) continue;
		double magnitude = (double)k + (double)fraction * 0x1p-64;
		return random_bits(state) >> 63 ? -magnitude : magnitude;
	}
}

#include "store/checksum.h"

#include <string.h>

/* One to one in either argument. */
static uint64_t mix(uint64_t sum, uint64_t word)
{
	sum = (sum ^ word) * UINT64_C(0x9e3779b97f4a7c15);
	return sum ^ sum >> 32;
}

uint64_t checksum(uint64_t sum, const void *bytes, size_t size)
{
	const char *at = bytes;
	uint64_t word;
	sum = mix(sum, size + 1); /* so that zeros count */
	for (; size >= sizeof word; size -= sizeof word, at += sizeof word) {
		memcpy(&word, at, sizeof word);
		sum = mix(sum, word);
	}
	word = 0;
	memcpy(&word, at, size);
	return mix(sum, word);
}

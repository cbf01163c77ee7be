/* Whether an arithmetic is what its name says where a test runs: emulators, valgrind among them, compute long double in
 * 53 bits. */
#ifndef LIB_TEST_LONG_DOUBLE_H
#define LIB_TEST_LONG_DOUBLE_H

#include <float.h>
#include <stdbool.h>
#include <string.h>

#include <cmocka.h>

/* Where it is not, a test leaves it out, which is told. */
static inline bool arithmetic_is_whole(const char *arithmetic)
{
	volatile long double one = 1, least = LDBL_EPSILON;
	if (strcmp(arithmetic, "extended") != 0) return true;
	bool whole = one + least != one;
	if (!whole) print_message("%s is left out: long double has fewer bits here than it should\n", arithmetic);
	return whole;
}

#endif

/* Whether long double has its 64 bits where a test runs: emulators, valgrind among them, compute it in 53. What depends
 * on it is left out there, which is told. */
#ifndef LIB_TEST_LONG_DOUBLE_H
#define LIB_TEST_LONG_DOUBLE_H

#include <float.h>
#include <stdbool.h>
#include <string.h>

#include <cmocka.h>

static inline bool long_double_is_whole(const char *what)
{
	volatile long double one = 1, least = LDBL_EPSILON;
	bool whole = one + least != one;
	if (!whole) print_message("%s: left out, for long double has fewer bits here than it should\n", what);
	return whole;
}

/* Whether the arithmetic is what its name says. */
static inline bool arithmetic_is_whole(const char *arithmetic)
{
	return strcmp(arithmetic, "extended") != 0 || long_double_is_whole(arithmetic);
}

#endif

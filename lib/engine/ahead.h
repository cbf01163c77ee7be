/* Fetching into the cache what will be looked at. */
#ifndef TOUCHSTONE_AHEAD_H
#define TOUCHSTONE_AHEAD_H

/* The statement that does nothing is there because gcc takes a function that only fetches for one without effect, and
 * calls to it for superfluous. */
static inline void ahead(const void *place)
{
	__builtin_prefetch(place);
	__asm__ volatile("");
}

/* The same for what will be written. */
static inline void ahead_to_change(const void *place)
{
	__builtin_prefetch(place, 1);
	__asm__ volatile("");
}

#endif

#include "engine/memory.h"

#include <stdint.h>
#include <stdlib.h>

#ifdef __linux__
#include <sys/mman.h>
#endif

static const size_t line = 64, page = (size_t)2 << 20, large = (size_t)8 << 20;

/* Asks for large pages where the room has whole ones that were not written to. Where that is refused, pages are small.
 */
static void ask_for_pages(void *room, size_t bytes)
{
#ifdef MADV_HUGEPAGE
	uintptr_t first = ((uintptr_t)room + page - 1) / page * page, end = ((uintptr_t)room + bytes) / page * page;
	if (bytes >= large && first < end) madvise((void *)first, end - first, MADV_HUGEPAGE);
#else
	(void)room, (void)bytes;
#endif
}

/* Gives back the pages of room that may hold anything: those that were used before are small, and what is written next
 * is on new ones. Cells on small pages took a gas of 10^6 a twelfth of its time. */
static void forget_pages(void *room, size_t bytes)
{
#ifdef MADV_HUGEPAGE
	madvise(room, bytes, MADV_DONTNEED);
#else
	(void)room, (void)bytes;
#endif
}

void *memory_room(size_t bytes)
{
	size_t unit = bytes < large ? line : page;
	if (bytes > (size_t)-1 - unit) return NULL;
	bytes = (bytes + unit - 1) / unit * unit;
	void *room = aligned_alloc(unit, bytes ? bytes : unit);
	if (!room || unit != page) return room;
	forget_pages(room, bytes);
	ask_for_pages(room, bytes);
	return room;
}

void *memory_grow(void *room, size_t bytes)
{
	void *grown = realloc(room, bytes);
	if (grown) ask_for_pages(grown, bytes);
	return grown;
}

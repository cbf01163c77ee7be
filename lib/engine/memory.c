#include "engine/memory.h"

#include <stdlib.h>

#ifdef __linux__
#include <sys/mman.h>
#endif

void *memory_room(size_t bytes)
{
	static const size_t line = 64, page = (size_t)2 << 20, large = (size_t)8 << 20;
	size_t unit = bytes < large ? line : page;
	if (bytes > (size_t)-1 - unit) return NULL;
	bytes = (bytes + unit - 1) / unit * unit;
	void *room = aligned_alloc(unit, bytes ? bytes : unit);
#ifdef MADV_HUGEPAGE
	if (room && unit == page) madvise(room, bytes, MADV_HUGEPAGE); /* where it is refused, pages are small */
#endif
	return room;
}

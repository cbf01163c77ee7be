/* Room for what there is one of per particle, cell or day. */
#ifndef TOUCHSTONE_MEMORY_H
#define TOUCHSTONE_MEMORY_H

#include <stddef.h>

/* So many bytes that begin a cache line, to be given back with free(); NULL when there is no memory. A large room lies
 * in pages of 2 MB where the system has them: in a gas of 10^6 particles nearly everything that is looked at is on a
 * page that was not looked at lately, and finding small ones took a tenth of the time. What it holds is of no meaning.
 */
void *memory_room(size_t bytes);

#endif

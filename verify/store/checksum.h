/* A sum of 64 bits over bytes, in the order given: whatever changes within one aligned word of eight bytes changes the
 * sum for certain, anything else but once in 2^64 times. Against accidents, not against malice. */
#ifndef VERIFY_CHECKSUM_H
#define VERIFY_CHECKSUM_H

#include <stddef.h>
#include <stdint.h>

/* The sum of what gave `sum` (0 for nothing) and these bytes after it. */
uint64_t checksum(uint64_t sum, const void *bytes, size_t size);

#endif

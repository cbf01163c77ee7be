/* What coverage-guided fuzzers drive: a target takes bytes, and ends the program when they bring out a fault. libFuzzer
 * calls it by this name, AFL++ through its driver for libFuzzer's targets. */
#ifndef VERIFY_FUZZ_TARGET_H
#define VERIFY_FUZZ_TARGET_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Puts the bytes into a file without a name, for those who read files; `path` is where it is found. To be closed. */
static inline int target_file(const uint8_t *data, size_t size, char path[40])
{
	int file = memfd_create("input", MFD_CLOEXEC);
	if (file < 0 || write(file, data, size) != (ssize_t)size) abort();
	snprintf(path, 40, "/proc/self/fd/%d", file);
	return file;
}

#endif

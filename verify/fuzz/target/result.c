/* The reader of results. */
#include "fuzz/target/target.h"

#include "result.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	char path[40], error[REPORT_ERROR];
	int file = target_file(data, size, path);
	result_free(result_read(path, error));
	close(file);
	return 0;
}

/* The reader of suites. */
#include "fuzz/target/target.h"

#include "audit/suite.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	char path[40], error[STORE_ERROR];
	int file = target_file(data, size, path);
	suite_close(suite_open(path, "cases", error));
	close(file);
	return 0;
}

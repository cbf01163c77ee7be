/* The reader of campaign files, and of the scenes at each point of their grids. */
#include "fuzz/target/target.h"

#include "campaign/campaign_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	char path[40], error[STORE_ERROR];
	int file = target_file(data, size, path);
	campaign_file_close(campaign_file_open(path, "cases", error));
	close(file);
	return 0;
}

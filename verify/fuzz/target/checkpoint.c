/* The reader of checkpoints: the file as it is, most of which its checksum keeps from being looked at; and what stands
 * behind the head as if the checksum had let it through. */
#include "fuzz/target/target.h"

#include "store/checkpoint_tree.h"

enum { HEAD = 512 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	char path[40], error[STORE_ERROR];
	int file = target_file(data, size, path);
	struct checkpoint checkpoint;
	if (checkpoint_read(path, &checkpoint, error)) checkpoint_free(&checkpoint);
	close(file);
	if (size <= HEAD) return 0;
	checkpoint = (struct checkpoint){0};
	checkpoint_tree_read(data + HEAD, size - HEAD, &checkpoint);
	checkpoint_free(&checkpoint);
	return 0;
}

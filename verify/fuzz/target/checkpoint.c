/* The reader of checkpoints: the file as it is, most of which its checksum keeps from being looked at. Then a state, in
 * which the bytes have changed a few numbers, is taken in, if it makes sense, and gone on from. (HDF5 itself is not
 * asked to bear damage: Debian's loses memory over it, which is what the checksum is for.) */
#include "fuzz/target/target.h"

#include <math.h>
#include <signal.h>
#include <string.h>
#include <sys/time.h>

#include "store/checkpoint.h"
#include "store/scene_file.h"

/* What one change is made of. */
struct change {
	uint8_t field;
	uint16_t place;
	uint8_t bytes[8];
} __attribute__((packed));

static struct touchstone_scene scene;
static struct touchstone_snapshot state;

static bool make_state(void)
{
	static const char *const settings[] = {"particles=8", "density=0.2", "start.temperature=1",
										   "virtual_walls=[{point: [0, 0, 0], normal: [1, 0, 0]}]"};
	char error[STORE_ERROR];
	struct scene_file *file = scene_file_open("cases/square-well.yaml", 4, settings, error);
	if (!file || !scene_file_build(file, &scene, error)) return false;
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	if (!engine) return false;
	touchstone_run(engine, &(struct touchstone_limits){.events = 100, .time = 100}, NULL);
	bool made = touchstone_save(engine, &state);
	touchstone_destroy(engine);
	scene_file_close(file);
	return made;
}

static void alter(struct touchstone_snapshot *snapshot, const uint8_t *data, size_t size)
{
	struct change change;
	for (; size >= sizeof change; data += sizeof change, size -= sizeof change) {
		memcpy(&change, data, sizeof change);
		struct touchstone_field *field = &snapshot->field[change.field % snapshot->count];
		size_t bytes = touchstone_field_bytes(snapshot, field);
		for (size_t b = 0; bytes > 0 && b < sizeof change.bytes; b++)
			((uint8_t *)field->data)[(change.place + b) % bytes] = change.bytes[b];
	}
}

static volatile int stop; /* after 0.1 s: what moves absurdly fast crosses cells for ages before it meets anything */

static void tell_stop(int signal)
{
	stop = signal;
}

static void go_on(const struct touchstone_snapshot *snapshot)
{
	char error[160];
	struct touchstone_engine *engine = touchstone_restore(&scene, "binary64", "stable", snapshot, error);
	if (!engine) return;
	const struct itimerval most = {.it_value.tv_usec = 100000}, none = {0};
	stop = 0;
	signal(SIGVTALRM, tell_stop);
	setitimer(ITIMER_VIRTUAL, &most, NULL);
	touchstone_run(engine, &(struct touchstone_limits){.events = 20, .time = INFINITY, .stop = &stop}, NULL);
	setitimer(ITIMER_VIRTUAL, &none, NULL);
	touchstone_destroy(engine);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	char path[40], error[STORE_ERROR];
	struct checkpoint checkpoint;
	if (!state.count && !make_state()) abort();
	int file = target_file(data, size, path);
	if (checkpoint_read(path, &checkpoint, error)) checkpoint_free(&checkpoint);
	close(file);
	if (size > 1000) return 0; /* a file, not changes */
	struct touchstone_snapshot altered = state;
	for (size_t f = 0; f < state.count; f++) {
		size_t bytes = touchstone_field_bytes(&state, &state.field[f]);
		if (!(altered.field[f].data = malloc(bytes + 1))) abort();
		memcpy(altered.field[f].data, state.field[f].data, bytes);
	}
	alter(&altered, data, size);
	go_on(&altered);
	touchstone_snapshot_free(&altered);
	return 0;
}

/* Files of checkpoints: what is written is read to the last bit; what is not whole, or of another version, is refused,
 * whatever was done to it. */
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene/random.h"
#include "scene/scene.h"
#include "store/checkpoint.h"
#include "store/checksum.h"
#include "store/scene_identity.h"
#include "test/folder.h"

enum { SEED = 20161120 };

static char *folder, *path;

/* The state of a square-well gas after a while, and some numbers of those who look on. */
static struct checkpoint sample(const char *arithmetic, uint64_t events)
{
	static const struct scene_species one_size[] = {{1, {1, 1}}};
	static const struct touchstone_step well[] = {{1.8, -0.75}};
	static const struct touchstone_potential wells[] = {{{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, well}};
	static const struct touchstone_virtual_wall walls[] = {{{0}, {1, 0, 0}}};
	const struct scene_recipe recipe = {.dimensions = 3,
										.particle_count = 108,
										.density = 0.3,
										.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
										.species_count = 1,
										.species = one_size,
										.restitution = {TOUCHSTONE_CONSTANT, 1},
										.potential_count = 1,
										.potentials = wells,
										.virtual_wall_count = 1,
										.virtual_walls = walls,
										.positions = SCENE_LATTICE,
										.velocities = SCENE_MAXWELL,
										.temperature = 1};
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160];
	assert_true(scene_build(&recipe, SEED, &scene, &complaint));
	struct touchstone_engine *engine = touchstone_create(&scene, arithmetic, "stable", error);
	assert_non_null(engine);
	touchstone_run(engine, &(struct touchstone_limits){events, INFINITY, NULL}, NULL);
	struct checkpoint checkpoint = {.scene = "sample", .method = "stable", .seed = SEED, .identity = 1};
	checkpoint.state_version = TOUCHSTONE_STATE_VERSION;
	snprintf(checkpoint.arithmetic, sizeof checkpoint.arithmetic, "%s", arithmetic);
	assert_true(touchstone_save(engine, &checkpoint.state));
	assert_true(checkpoint_put(&checkpoint, "numbers", TOUCHSTONE_DOUBLES, 2, (double[]){0.1, -INFINITY}));
	touchstone_destroy(engine);
	scene_free(&scene);
	return checkpoint;
}

static void write_sample(const char *arithmetic)
{
	char error[STORE_ERROR];
	struct checkpoint checkpoint = sample(arithmetic, 500);
	if (!checkpoint_write(path, &checkpoint, error)) fail_msg("%s", error);
	checkpoint_free(&checkpoint);
}

static void assert_same_fields(const struct touchstone_snapshot *one, const struct touchstone_snapshot *other)
{
	assert_int_equal(one->count, other->count);
	assert_int_equal(one->words, other->words);
	assert_int_equal(one->doubles, other->doubles);
	for (size_t f = 0; f < one->count; f++) {
		const struct touchstone_field *field = &one->field[f];
		size_t g = 0;
		while (g < other->count && strcmp(other->field[g].name, field->name) != 0) g++;
		assert_in_range(g, 0, other->count - 1);
		assert_int_equal(other->field[g].content, field->content);
		assert_int_equal(other->field[g].rows, field->rows);
		assert_int_equal(other->field[g].columns, field->columns);
		size_t bytes = touchstone_field_bytes(one, field);
		if (bytes && memcmp(field->data, other->field[g].data, bytes) != 0) fail_msg("'%s' differs", field->name);
	}
}

static void what_is_written_is_read(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "binary32",  "short:11", "twin",
											  "extended", "binary128", "mpfr:70",  "mpfr:1000"};
	for (size_t a = 0; a < sizeof arithmetics / sizeof *arithmetics; a++)
		for (uint64_t events = 0; events < 1000; events += 999) {
			struct checkpoint written = sample(arithmetics[a], events), read;
			char error[STORE_ERROR];
			assert_true(checkpoint_write(path, &written, error));
			if (!checkpoint_read(path, &read, error)) fail_msg("%s", error);
			assert_same_fields(&written.state, &read.state);
			assert_same_fields(&written.run, &read.run);
			assert_string_equal(read.scene, "sample");
			assert_string_equal(read.arithmetic, arithmetics[a]);
			assert_string_equal(read.method, "stable");
			assert_true(read.seed == SEED && read.identity == 1);
			double numbers[2];
			assert_true(checkpoint_get(&read, "numbers", TOUCHSTONE_DOUBLES, 2, numbers));
			assert_true(numbers[0] == 0.1 && numbers[1] == -INFINITY);
			assert_false(checkpoint_get(&read, "numbers", TOUCHSTONE_DOUBLES, 1, numbers));
			assert_false(checkpoint_get(&read, "others", TOUCHSTONE_DOUBLES, 2, numbers));
			checkpoint_free(&written);
			checkpoint_free(&read);
		}
	assert_int_equal(folder_count(folder, ""), 1); /* nothing is left beside it */
}

/* ------------------------------------------------------------------ files that are not whole */

static void assert_refused(const char *words)
{
	struct checkpoint checkpoint;
	char error[STORE_ERROR] = "";
	assert_false(checkpoint_read(path, &checkpoint, error));
	if (!strstr(error, words) || strchr(error, '\n') || strncmp(error, path, strlen(path)) != 0)
		fail_msg("not one line 'FILE: ... %s ...': %s", words, error);
}

static void alter(off_t at, const void *bytes, size_t size)
{
	int file = open(path, O_WRONLY);
	assert_true(file >= 0 && pwrite(file, bytes, size, at) == (ssize_t)size);
	close(file);
}

static void files_cut_short_are_refused(void **state)
{
	(void)state;
	write_sample("binary64");
	struct random_state random = random_seed(SEED);
	struct stat whole;
	assert_int_equal(stat(path, &whole), 0);
	for (int trial = 0; trial < 100; trial++) {
		off_t size = trial ? (off_t)random_below(&random, (uint64_t)whole.st_size) : whole.st_size - 1;
		assert_int_equal(truncate(path, size), 0);
		assert_refused("checkpoint");
		write_sample("binary64");
	}
	alter(whole.st_size, "x", 1); /* or longer */
	assert_refused("altered");
}

static void a_flipped_bit_is_refused(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED + 1);
	write_sample("twin");
	struct stat whole;
	assert_int_equal(stat(path, &whole), 0);
	for (int trial = 0; trial < 400; trial++) {
		off_t at = (off_t)random_below(&random, trial % 2 ? (uint64_t)whole.st_size : 600);
		char byte = 0, flipped;
		int file = open(path, O_RDONLY);
		assert_true(file >= 0 && pread(file, &byte, 1, at) == 1);
		close(file);
		flipped = (char)(byte ^ 1 << random_below(&random, 8));
		alter(at, &flipped, 1);
		assert_refused("checkpoint");
		alter(at, &byte, 1);
	}
	struct checkpoint checkpoint;
	char error[STORE_ERROR];
	assert_true(checkpoint_read(path, &checkpoint, error));
	checkpoint_free(&checkpoint);
}

static void other_files_and_versions_are_refused(void **state)
{
	(void)state;
	char error[STORE_ERROR];
	unlink(path);
	assert_refused("No such file");
	folder_put(folder, "kept.h5", "");
	assert_refused("no checkpoint");
	folder_put(folder, "kept.h5", "particles: 5\n");
	assert_refused("no checkpoint");
	write_sample("binary64");
	alter((off_t)strlen("Touchstone checkpoint\nformat "), "2", 1);
	assert_refused("format 2; accepted: format 1");
	struct checkpoint checkpoint = sample("binary64", 10);
	checkpoint.state_version++;
	assert_true(checkpoint_write(path, &checkpoint, error));
	assert_refused("a state of version 2; accepted: version 1");
	checkpoint_free(&checkpoint);
}

/* A file that cannot be written leaves the one that is there as it is. */
static void trouble_leaves_what_is_there(void **state)
{
	(void)state;
	char error[STORE_ERROR] = "";
	struct checkpoint checkpoint = sample("binary64", 10);
	assert_false(checkpoint_write("/no/such/folder/kept.h5", &checkpoint, error));
	assert_non_null(strstr(error, "cannot be written"));
	assert_false(checkpoint_write(folder, &checkpoint, error));
	assert_non_null(strstr(error, "not a file"));
	checkpoint_free(&checkpoint);
}

/* ------------------------------------------------------------------ identity */

/* Whatever decides a run makes another scene, and how neighbours are searched for does not. */
static void identity_is_what_decides_a_run(void **state)
{
	(void)state;
	struct touchstone_particle particles[2] = {{{-1, 0, 0}, {1, 0, 0}, 0}, {{1, 0, 0}, {0}, 0}};
	struct touchstone_species species[1] = {{1, 1}};
	struct touchstone_wall walls[1] = {{{2, 0, 0}, {-1, 0, 0}, {TOUCHSTONE_CONSTANT, 1}}};
	struct touchstone_step steps[1] = {{1.5, -1}};
	struct touchstone_potential potentials[1] = {{{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, steps}};
	struct touchstone_virtual_wall virtual_walls[1] = {{{0}, {0, 1, 0}}};
	struct touchstone_scene scene = {
		.dimensions = 2,
		.particle_count = 2,
		.particles = particles,
		.species_count = 1,
		.species = species,
		.wall_count = 1,
		.walls = walls,
		.periodic = {false, true, false},
		.box = {5, 5, 0},
		.restitution = {TOUCHSTONE_CONSTANT, 1},
		.potential_count = 1,
		.potentials = potentials,
		.virtual_wall_count = 1,
		.virtual_walls = virtual_walls,
	};
	double *const numbers[] = {&particles[1].position[0],
							   &particles[0].velocity[1],
							   &species[0].diameter,
							   &species[0].mass,
							   &walls[0].point[0],
							   &walls[0].normal[1],
							   &walls[0].restitution.coefficient,
							   &steps[0].distance,
							   &steps[0].energy,
							   &potentials[0].core,
							   &potentials[0].restitution.coefficient,
							   &virtual_walls[0].point[1],
							   &scene.box[1],
							   &scene.acceleration[0],
							   &scene.restitution.coefficient,
							   &scene.clock};
	uint64_t identity = scene_identity(&scene);
	for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) {
		double number = *numbers[n];
		*numbers[n] = nextafter(number, 9);
		if (scene_identity(&scene) == identity) fail_msg("number %zu does not count", n);
		*numbers[n] = number;
	}
	scene.form = TOUCHSTONE_ABSOLUTE;
	assert_true(scene_identity(&scene) != identity);
	scene.form = TOUCHSTONE_RELATIVE;
	scene.search = TOUCHSTONE_ALL, scene.cell = 3, particles[1].velocity[0] = -0.0;
	assert_true(scene_identity(&scene) == identity);
	assert_true(checksum(0, "\0", 1) != checksum(0, "", 0));
}

static int begin(void **state)
{
	(void)state;
	folder = folder_new();
	return asprintf(&path, "%s/kept.h5", folder) < 0;
}

static int end(void **state)
{
	(void)state;
	free(path);
	folder_remove(folder);
	return 0;
}

int main(void)
{
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(what_is_written_is_read),      cmocka_unit_test(files_cut_short_are_refused),
		cmocka_unit_test(a_flipped_bit_is_refused),     cmocka_unit_test(other_files_and_versions_are_refused),
		cmocka_unit_test(trouble_leaves_what_is_there), cmocka_unit_test(identity_is_what_decides_a_run),
	};
	return cmocka_run_group_tests(tests, begin, end);
}

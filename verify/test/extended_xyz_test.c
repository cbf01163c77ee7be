/* Extended XYZ: what is written is read back to the last bit; what is no such file is refused with its line. */
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
#include "store/extended_xyz.h"
#include "store/scene_file.h"

static const uint64_t seed = 5;

static char folder[] = "/tmp/extended_xyz_test.XXXXXX";
static char xyz[64], yaml[64];

static void write_file(const char *path, const char *text)
{
	FILE *stream = fopen(path, "w");
	assert_non_null(stream);
	assert_true(fputs(text, stream) >= 0);
	assert_int_equal(fclose(stream), 0);
}

/* Scenes of any dimensions and sizes, written and started from again, are the same. */
static void written_and_read_is_the_same(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed);
	for (int trial = 0; trial < 60; trial++) {
		struct scene_species species[2];
		for (int i = 0; i < 2; i++) {
			double diameter = 0.5 + random_uniform(&random), mass = 1 + random_uniform(&random);
			species[i] = (struct scene_species){0.5, {diameter, mass}};
		}
		struct scene_recipe recipe = {.density = 0.1,
									  .species_count = 2,
									  .species = species,
									  .restitution = {TOUCHSTONE_CONSTANT, 1},
									  .boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
									  .positions = SCENE_RANDOM,
									  .temperature = 1};
		recipe.dimensions = 1 + (int)random_below(&random, 3);
		recipe.particle_count = 2 + random_below(&random, 100);
		static const uint32_t counts[102] = {3, 1};
		struct touchstone_scene scene, again;
		struct scene_error problem;
		char error[STORE_ERROR], settings[2][80];
		assert_true(scene_build(&recipe, random_bits(&random), &scene, &problem));
		assert_true(extended_xyz_write(xyz, &scene, trial % 2 ? counts : NULL, error));

		write_file(yaml, "start:\n  positions: file\n  file: start.xyz\n");
		snprintf(settings[0], sizeof settings[0], "dimensions=%d", recipe.dimensions);
		snprintf(settings[1], sizeof settings[1], "particles=%zu", recipe.particle_count);
		const char *const set[] = {settings[0], settings[1]};
		struct scene_file *file = scene_file_open(yaml, 2, set, error);
		if (!file || !scene_file_build(file, &again, error)) fail_msg("%s", error);
		assert_int_equal(again.particle_count, scene.particle_count);
		assert_memory_equal(again.box, scene.box, sizeof scene.box);
		for (size_t p = 0; p < scene.particle_count; p++) {
			const struct touchstone_particle *one = &scene.particles[p], *two = &again.particles[p];
			assert_memory_equal(one->position, two->position, sizeof one->position);
			assert_memory_equal(one->velocity, two->velocity, sizeof one->velocity);
			assert_true(scene.species[one->species].diameter == again.species[two->species].diameter);
			assert_true(scene.species[one->species].mass == again.species[two->species].mass);
		}
		scene_free(&scene);
		scene_free(&again);
		scene_file_close(file);
	}
}

/* As other programs write it: no velocities, further columns, sides from 0 to L. */
static void foreign_files_are_read(void **state)
{
	(void)state;
	write_file(xyz,
			   "3\nTime=1.5 pbc='T T T' Lattice=\"10 0 0 0 10.0 0 0 0 10\" flag Properties=id:I:1:species:S:1:pos:R:3:"
			   "forces:R:3:radius:R:1\n"
			   "1 He 1 2 3 0 0 0 0.5\n2 He 9.5 2 3 0 0 0 0.5\n  3\tNe 5 5 5 0 0 0 1\n");
	struct extended_xyz file;
	char error[STORE_ERROR];
	assert_true(extended_xyz_read(&file, xyz, 3, 0, NULL, error));
	assert_true(file.particle_count == 3 && file.species_count == 2 && file.has_box && !file.has_velocities);
	assert_true(file.box[0] == 10 && file.first_line == 3 && file.particles[1].position[0] == 9.5);
	assert_true(file.species[file.particles[2].species].diameter == 2);
	extended_xyz_free(&file);

	write_file(yaml, "species: [{name: He, diameter: 1}, {name: Ne, diameter: 3}]\nstart:\n  positions: file\n"
					 "  velocities: rest\n  file: start.xyz\n");
	struct scene_file *scene = scene_file_open(yaml, 0, NULL, error);
	struct touchstone_scene built;
	if (!scene || !scene_file_build(scene, &built, error)) fail_msg("%s", error);
	assert_true(built.particles[1].position[0] == -0.5); /* an image of 9.5 */
	assert_true(built.species[built.particles[2].species].diameter == 3);
	scene_free(&built);
	scene_file_close(scene);
}

#define HEAD "2\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3:velo:R:3\n"

/* Read as the start of a scene, the file is refused at a line of its own or of the scene's. */
static void assert_refused(const char *text, const char *setting, const char *place, const char *words)
{
	write_file(xyz, text);
	write_file(yaml, "dimensions: 3\nstart:\n  positions: file\n  file: start.xyz\n");
	char error[STORE_ERROR] = "";
	struct scene_file *file = scene_file_open(yaml, setting != NULL, &setting, error);
	struct touchstone_scene scene;
	if (file && scene_file_build(file, &scene, error)) {
		scene_free(&scene);
		fail_msg("accepted: %s", text);
	}
	scene_file_close(file);
	assert_null(strchr(error, '\n'));
	if (!strstr(error, place) || !strstr(error, words))
		fail_msg("'%s' does not say '%s' and '%s'", error, place, words);
}

static void bad_files_are_refused(void **state)
{
	(void)state;
	assert_refused("", NULL, "start.xyz:1: ", "the file ends");
	assert_refused("two\n", NULL, "start.xyz:1: ", "'two'");
	assert_refused("0\n\n", NULL, "start.xyz:1: ", "accepted: 1 to");
	assert_refused("60000000\n\n", NULL, "start.xyz:1: ", "too short for 60000000");
	assert_refused("1\n", NULL, "start.xyz:2: ", "the file ends");
	assert_refused("2\nLattice=\"9 0 0 0 9 0 0 0\"\nA 0 0 0\nA 2 0 0\n", NULL, "start.xyz:2: ", "Lattice; accepted: 9");
	assert_refused("2\nLattice=\"9 1 0 0 9 0 0 0 9\"\nA 0 0 0\nA 2 0 0\n", NULL, "start.xyz:2: ", "slanted");
	assert_refused("2\nLattice=\"0 0 0 0 9 0 0 0 9\"\nA 0 0 0\nA 2 0 0\n", NULL, "start.xyz:2: ", "side of 0");
	assert_refused("2\nLattice=\"9 0\nA 0 0 0\nA 2 0 0\n", NULL, "start.xyz:2: ", "quote");
	assert_refused("2\nProperties=species:S:1\nA\nA\n", NULL, "start.xyz:2: ", "no positions");
	assert_refused("2\nProperties=pos:R:2\n0 0\n2 0\n", NULL, "start.xyz:2: ", "accepted: pos:R:3");
	assert_refused("2\nProperties=pos:R:3:tag:I:99\n0 0 0\n2 0 0\n", NULL, "start.xyz:2: ", "'tag'");
	assert_refused("2\nProperties=pos:R:3:tag\n0 0 0\n2 0 0\n", NULL, "start.xyz:2: ", "NAME:TYPE:COUNT");
	assert_refused(HEAD "A 0 0 0 1 0 0\n", NULL, "start.xyz:4: ", "the file ends");
	assert_refused(HEAD "A 0 0 0 1 0 0\nA 2 0\n", NULL, "start.xyz:4: ", "3 columns; accepted: 7");
	assert_refused(HEAD "A 0 0 0 1 0 0\nA 2 0 0 0 0 0 0\n", NULL, "start.xyz:4: ", "more columns");
	assert_refused(HEAD "A 0 0 0 1 0 0\nA 2 nan 0 0 0 0\n", NULL, "start.xyz:4: ", "'nan' is no number");
	assert_refused("2\nProperties=pos:R:3:radius:R:1\n0 0 0 1\n2 0 0 -1\n", NULL, "start.xyz:4: ", "radius -1");
	assert_refused(HEAD "A 0 0 0 1 0 0\nA 0.5 0 0 0 0 0\n", NULL, "start.xyz:4: ", "overlap by 0.5");
	assert_refused(HEAD "A 0 0 0 1 0 0\nA 2 0 1 0 0 0\n", "dimensions=2", "start.xyz:4: ", "1 along z");
	assert_refused(HEAD "A 0 0 0 1 0 0\nA 2 0 0 0 0 0\n", "particles=3", "--set particles=3", "has 2");
	assert_refused(HEAD "A 0 0 0 1 0 0\nA 2 0 0 0 0 0\n", "species=[{name: B}]", "start.xyz:3: ", "species 'A'");
	assert_refused("2\nLattice=\"9 0 0 0 9 0 0 0 9\"\nA 0 0 0\nA 2 0 0\n", NULL,
				   "scene.yaml:4: start.file: ", "no velocities");
	assert_refused("2\n\nA 0 0 0\nA 2 0 0\n", "start.velocities=rest", "scene.yaml:1: box: ", "extent of 0");
	assert_refused("1\n\n", "start.file=/no/such.xyz", "/no/such.xyz: ", "cannot be read: No such file");
	assert_refused("1\n\n", "start.file=/dev/zero", "/dev/zero:1: ", "");
}

/* Damage of any kind is refused on one line or makes sense all the same. */
static void damaged_files_do_no_harm(void **state)
{
	(void)state;
	static const char sound[] = HEAD "A 0 0 0 1 0 0\nA 2.5 0 0 0 0 0\n";
	struct random_state random = random_seed(seed);
	int refused = 0;
	for (int trial = 0; trial < 5000; trial++) {
		char text[sizeof sound];
		memcpy(text, sound, sizeof text);
		for (uint64_t n = 1 + random_below(&random, 4); n > 0; n--) {
			size_t at = random_below(&random, sizeof text - 1);
			text[at] = (char)random_below(&random, 256);
		}
		FILE *stream = fopen(xyz, "w");
		assert_int_equal(fwrite(text, 1, sizeof text - 1, stream), sizeof text - 1);
		fclose(stream);
		struct extended_xyz file;
		char error[STORE_ERROR] = "";
		if (extended_xyz_read(&file, xyz, 3, 0, NULL, error)) {
			extended_xyz_free(&file);
			continue;
		}
		refused++;
		assert_true(strncmp(error, xyz, strlen(xyz)) == 0);
		assert_null(strchr(error, '\n'));
	}
	assert_true(refused > 1000 && refused < 5000);
}

static void nowhere_to_write(void **state)
{
	(void)state;
	struct touchstone_scene nothing = {.dimensions = 3};
	char error[STORE_ERROR];
	assert_false(extended_xyz_write("/no/such/folder/a.xyz", &nothing, NULL, error));
	assert_non_null(strstr(error, "/no/such/folder/a.xyz: cannot be written"));
}

static int make_folder(void **state)
{
	(void)state;
	if (!mkdtemp(folder)) return -1;
	snprintf(xyz, sizeof xyz, "%s/start.xyz", folder);
	snprintf(yaml, sizeof yaml, "%s/scene.yaml", folder);
	return 0;
}

static int remove_folder(void **state)
{
	(void)state;
	unlink(xyz);
	unlink(yaml);
	return rmdir(folder);
}

int main(void)
{
	printf("seed %llu\n", (unsigned long long)seed);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(written_and_read_is_the_same),
		cmocka_unit_test(damaged_files_do_no_harm),
		cmocka_unit_test(foreign_files_are_read),
		cmocka_unit_test(bad_files_are_refused),
		cmocka_unit_test(nowhere_to_write),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

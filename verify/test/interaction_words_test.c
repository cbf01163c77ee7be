/* Potentials and virtual walls in scene files, and what a run tells of them. */
#include "scene_text.h"

#include <math.h>

#include "program.h"

#define WELL GAS "potentials:\n  - steps:\n      - {distance: 1.5, energy: -1}\n"
#define TWO GAS "species: [{name: a, fraction: 0.5}, {name: b, fraction: 0.5, diameter: 0.5}]\n"

/* The paper's two, and what they are made of. */
static void cases_are_the_papers(void **state)
{
	(void)state;
	const char *const names[] = {"cases/square-well.yaml", "cases/square-shoulder.yaml"};
	for (int c = 0; c < 2; c++) {
		char error[STORE_ERROR];
		struct touchstone_scene scene;
		struct scene_file *file = scene_file_open(names[c], 0, NULL, error);
		assert_true(file && scene_file_build(file, &scene, error));
		assert_int_equal(scene.particle_count, 32000);
		assert_true(fabs(32000 / (scene.box[0] * scene.box[1] * scene.box[2]) - 1e-3) < 1e-12);
		assert_int_equal(scene.potential_count, 1);
		assert_int_equal(scene.potentials[0].step_count, 1);
		assert_true(scene.potentials[0].core == 1 && scene.potentials[0].steps[0].distance == 3);
		assert_true(scene.potentials[0].steps[0].energy == (c ? 1 : -1));
		scene_free(&scene);
		scene_file_close(file);
	}
}

static void what_is_accepted(void **state)
{
	(void)state;
	assert_accepted(WELL, NULL);
	assert_accepted(WELL "    core: 0\n    restitution: 0.9\n", NULL);
	assert_accepted(GAS, "potentials=[{core: 0.8, lennard_jones: {cutoff: 2, steps: 7}}]");
	assert_accepted(TWO
					"potentials:\n  - {between: [a], steps: [{distance: 2, energy: 1}]}\n"
					"  - {between: [b, a], core: 0.1, steps: [{distance: 1, energy: 1}, {distance: 2, energy: -3}]}\n",
					NULL);
	assert_accepted(GAS, "virtual_walls=[{point: [0, 0, 0], normal: [0, -2, 0]}]");
	assert_accepted(GAS "boundaries: [walls, walls, periodic]\n", "virtual_walls=[{point: [0,0,0], normal: [1,1,0]}]");
}

static void what_is_refused(void **state)
{
	(void)state;
	assert_refused(GAS "potentials:\n  - {step: 1}\n", NULL, "scene.yaml:5: potentials[0]: ", "unknown key 'step'");
	assert_refused(WELL "      - {distance: 1.25, energy: 0}\n", NULL,
				   "scene.yaml:7: potentials[0].steps[1].distance: ", "innermost outwards");
	assert_refused(WELL "      - {distance: 1.5, energy: 0}\n", NULL,
				   "scene.yaml:7: potentials[0].steps[1].distance: ", "innermost outwards");
	assert_refused(GAS "potentials:\n  - steps:\n      - {distance: 0.75, energy: -1}\n", NULL,
				   "scene.yaml:6: potentials[0].steps[0].distance: ", "within the core");
	assert_refused(GAS "potentials:\n  - steps:\n      - {distance: 1.5, energy: inf}\n", NULL,
				   "scene.yaml:6: potentials[0].steps[0].energy: ", "accepted: a finite number");
	assert_refused(GAS "potentials:\n  - steps:\n      - {distance: -1.5, energy: 1}\n", NULL,
				   "scene.yaml:6: potentials[0].steps[0].distance: ", "above 0");
	assert_refused(GAS "potentials:\n  - steps:\n      - {distance: 1.5}\n", NULL,
				   "scene.yaml:6: potentials[0].steps[0].energy: ", "not given");
	assert_refused(GAS "potentials:\n  - steps:\n      - {distance: 15, energy: 1}\n", NULL,
				   "scene.yaml:6: potentials[0].steps[0].distance: ", "its own image");
	assert_refused(WELL "    core: 1.25\n", NULL, "scene.yaml:7: potentials[0].core: ", "mean of the diameters");
	assert_refused(WELL "    restitution: 2\n", NULL, "scene.yaml:7: potentials[0].restitution: ", "0 to 1");
	assert_refused(WELL "  - steps: [{distance: 2, energy: 1}]\n", NULL, "scene.yaml:7: potentials[1]",
				   "the same species as in potentials[0]");
	assert_refused(TWO "potentials:\n  - {between: [a, c]}\n", NULL,
				   "scene.yaml:6: potentials[0].between: ", "'c' is not one of the 2 species; the first is 'a'");
	assert_refused(TWO "potentials:\n  - {core: 1}\n", NULL, "scene.yaml:6: potentials[0]", "names of two");
	assert_refused(WELL "    lennard_jones: {steps: 3}\n", NULL,
				   "scene.yaml:5: potentials[0].steps: ", "one of the two");
	assert_refused(GAS, "potentials=[{lennard_jones: {cutoff: 0.5}}]", "--set potentials", "above the core");
	assert_refused(GAS, "potentials=[{core: 0, lennard_jones: {cutoff: 2}}]", "--set potentials", "a core above 0");
	assert_refused(GAS, "potentials=[{lennard_jones: {steps: 0}}]", "--set potentials", "1 to 1000");
	assert_refused(GAS "virtual_walls:\n  - {point: [0, 0, 0]}\n", NULL,
				   "scene.yaml:5: virtual_walls[0].normal: ", "not given");
	assert_refused(GAS "virtual_walls:\n  - {point: [0, 0, 0], normal: [1, 1, 0]}\n", NULL,
				   "scene.yaml:5: virtual_walls[0].normal: ", "aslant to the periodic axis");
	assert_refused(GAS "virtual_walls:\n  - {point: [0, 0, 0], normal: [0, 0, 0]}\n", NULL,
				   "scene.yaml:5: virtual_walls[0].normal: ", "no direction");
	assert_refused(GAS "virtual_walls:\n  - {point: [0, 9, 0], normal: [0, 1, 0]}\n", NULL,
				   "scene.yaml:5: virtual_walls[0].point: ", "in a periodic box");
	assert_refused(GAS "virtual_walls:\n  - {point: [0, 0, 0], normal: [0, 1, 0], restitution: 1}\n", NULL,
				   "scene.yaml:5: virtual_walls[0]: ", "unknown key 'restitution'");
}

/* A rule gives the table that the table gives. */
static void lennard_jones_is_a_table(void **state)
{
	(void)state;
	char error[STORE_ERROR];
	struct touchstone_scene scene;
	struct scene_file *file = scene_file_open("cases/stepped-lennard-jones.yaml", 0, NULL, error);
	assert_true(file && scene_file_build(file, &scene, error));
	const struct touchstone_potential *potential = &scene.potentials[0];
	assert_true(potential->core == 0.8 && potential->step_count == 17 && potential->steps[16].distance == 2.5);
	double least = 0;
	for (size_t s = 0; s < potential->step_count; s++) least = fmin(least, potential->steps[s].energy);
	assert_true(least < -0.9 && least > -1);
	assert_true(potential->steps[0].energy > 10);
	scene_free(&scene);
	scene_file_close(file);
}

static void runs_tell_of_states(void **state)
{
	(void)state;
	static const char text[] = "particles: 500\ndensity: 0.1\npotentials:\n  - steps: [{distance: 3, energy: -1}]\n"
							   "virtual_walls:\n  - {point: [1, 0, 0], normal: [1, 0, 0]}\nequilibrate: 5\n"
							   "events: 20000\n";
	write_file("scene.yaml", text, strlen(text));
	json_t *json = program_json(program_run("run %s --measure conservation --explain --json -", path), 0);
	double captures = json_number(json, "captures"), releases = json_number(json, "releases");
	double all = captures + releases + json_number(json, "bounces") + json_number(json, "collisions");
	assert_true(all == 20000 && captures > 1000 && releases > 1000);
	assert_true(json_number(json, "potential_energy") == -json_number(json, "captured_pairs"));
	assert_true(json_number(json, "state_bytes_per_particle") > 0);
	assert_true(fabs(json_number(json_object_get(json, "conservation"), "energy_drift")) < 1e-11);
	json_t *fluxes = json_array_get(json_object_get(json, "fluxes"), 0);
	double with = json_number(json_array_get(fluxes, 0), "count"),
		   against = json_number(json_array_get(fluxes, 1), "count");
	assert_true(with > 10 && against > 10 && with + against == json_number(json, "crossings"));
	assert_true(json_number(json_array_get(fluxes, 0), "mass") == with);
	size_t index, said = 0;
	json_t *line;
	json_array_foreach(json_object_get(json, "explained"), index, line)
	{
		said += strstr(json_string_value(line), "core at 1; energy -1 within 3") != NULL;
		said += strstr(json_string_value(line), "pair states: tracked") != NULL;
		said += strstr(json_string_value(line), "virtual walls: 1") != NULL;
	}
	assert_int_equal(said, 3);
	json_decref(json);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(cases_are_the_papers), cmocka_unit_test(what_is_accepted),
		cmocka_unit_test(what_is_refused),      cmocka_unit_test(lennard_jones_is_a_table),
		cmocka_unit_test(runs_tell_of_states),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* Scene files: all cases load and build; whatever is wrong with a file is said on one line, with its place. */
#include <glob.h>
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
#include "scene_text.h"

enum { DAMAGED = 2000 };
static const uint64_t seed = 42;

static void every_case_builds(void **state)
{
	(void)state;
	glob_t cases;
	assert_int_equal(glob("cases/*.yaml", 0, NULL, &cases), 0); /* tests run in the top folder */
	assert_true(cases.gl_pathc >= 8);
	for (size_t i = 0; i < cases.gl_pathc; i++) {
		char error[STORE_ERROR] = "";
		struct scene_file *file = scene_file_open(cases.gl_pathv[i], 0, NULL, error);
		struct touchstone_scene scene;
		if (!file || !scene_file_build(file, &scene, error)) fail_msg("%s", error);
		assert_string_equal(file->method, "stable");
		assert_string_not_equal(file->title, file->name); /* each has one of its own */
		assert_true(file->limits.events < UINT64_MAX);
		assert_int_equal(scene.particle_count, file->recipe.particle_count);
		scene_free(&scene);
		scene_file_close(file);
	}
	globfree(&cases);
}

/* What the standard scenes are must not drift. */
static void cases_are_what_they_are(void **state)
{
	(void)state;
	char error[STORE_ERROR];
	struct touchstone_scene scene;
	struct scene_file *file = scene_file_open("cases/hard-spheres.yaml", 0, NULL, error);
	assert_true(file && scene_file_build(file, &scene, error));
	assert_string_equal(file->name, "hard-spheres");
	assert_int_equal(scene.particle_count, 13500);
	assert_true(scene.box[0] == 30 && scene.periodic[2] && file->equilibrate == 50);
	scene_free(&scene);
	scene_file_close(file);
	const char *absolute[] = {"form=absolute", "search=all",
							  "walls=[{point: [0x1p-2], normal: [2], restitution: 0.25}]"};
	file = scene_file_open("cases/bouncing-ball.yaml", 3, absolute, error);
	assert_true(file && scene_file_build(file, &scene, error));
	assert_true(scene.wall_count == 1 && scene.walls[0].restitution.coefficient == 0.25);
	assert_true(scene.walls[0].normal[0] == 1 && scene.walls[0].point[0] == 0.25 && scene.acceleration[0] == -1);
	assert_true(scene.form == TOUCHSTONE_ABSOLUTE && scene.search == TOUCHSTONE_ALL);
	scene_free(&scene);
	scene_file_close(file);
	const char *unsieved[] = {"search=unsieved"};
	file = scene_file_open("cases/mixture.yaml", 1, unsieved, error);
	assert_true(file && scene_file_build(file, &scene, error));
	assert_true(scene.species_count == 2 && scene.species[1].diameter == 0.5);
	assert_true(scene.search == TOUCHSTONE_UNSIEVED);
	scene_free(&scene);
	scene_file_close(file);
}

static void unknown_keys_and_kinds(void **state)
{
	(void)state;
	assert_refused(GAS "densty: 1\n", NULL,
				   "scene.yaml:4: ", "unknown key 'densty'; accepted: title, about, dimensions");
	assert_refused("\n\n" GAS "start:\n  positons: lattice\n", NULL, "scene.yaml:7: start: ",
				   "unknown key 'positons'; accepted: positions, velocities, file, temperature");
	assert_refused(GAS "species:\n  - {diameter: 1}\n  - {diametr: 1}\n", NULL,
				   "scene.yaml:6: species[1]: ", "diametr");
	assert_refused(GAS "density: 1\n", NULL, "scene.yaml:4: ", "given twice");
	assert_refused(GAS "gravity: 1\n", NULL, "scene.yaml:4: gravity: ", "one value; accepted: a list");
	assert_refused(GAS "restitution: [1, 2]\n", NULL, "scene.yaml:4: restitution: ", "a list; accepted: one value");
	assert_refused(GAS "start: lattice\n", NULL, "scene.yaml:4: start: ", "accepted: a mapping");
	assert_refused(GAS "gravity: [0, 0, 0, 1]\n", NULL, "scene.yaml:4: gravity: ", "4 entries; accepted: 1 to 3");
	assert_refused(GAS "gravity: [0, 1]\n", NULL, "scene.yaml:4: gravity: ", "2 entries; accepted: 3");
	assert_refused(GAS "form: big\n", NULL, "scene.yaml:4: form: ", "'big' is unknown; accepted: relative, absolute");
	assert_refused(GAS "boundaries: [periodic, solid, open]\n", NULL,
				   "scene.yaml:4: boundaries[1]: ", "accepted: periodic, walls, open");
	assert_refused("- dimensions\n", NULL, "scene.yaml:1: ", "a list; accepted: a mapping");
	assert_refused(GAS "[a, b]: 1\n", NULL, "scene.yaml:4: ", "a key that is a list");
	assert_refused(GAS "title: \"a\\0b\"\n", NULL, "scene.yaml:4: title: ", "character 0");
	assert_refused(GAS "title: &t x\nabout: *t\n", NULL, "scene.yaml:5: about: ", "an alias");
	assert_refused(GAS "gravity: [0, &a 0, *a]\n", NULL, "scene.yaml:4: gravity[2]: ", "an alias");
	assert_refused(GAS "title: [a\n", NULL, "scene.yaml:5: ", "not YAML");
	assert_refused("density: 1\n  x: 2\n", NULL, "scene.yaml:2: ", "not YAML");
	assert_refused("density: 1\ntitle: \xff\n", NULL, "scene.yaml:2: ", "not YAML");
	assert_refused(GAS "---\n" GAS, NULL, "scene.yaml:5: ", "second document");
	assert_refused("", NULL, "scene.yaml:1: ", "empty");
	assert_refused("# nothing\n", NULL, "scene.yaml:1: ", "empty");
}

static void values_out_of_range(void **state)
{
	(void)state;
	const struct {
		const char *word, *says;
	} bad[] = {{"nan", "'nan'"}, {".nan", "'.nan'"}, {"inf", "'inf'"},   {"1e999", "'1e999'"}, {"one", "'one'"},
			   {"1 2", "'1 2'"}, {"0", "'0'"},       {"-0.5", "'-0.5'"}, {"''", "''"},         {"0x", "'0x'"},
			   {"'1 '", "'1 '"}, {"1,5", "'1,5'"},   {"~", "'~'"},       {"1e", "'1e'"}};
	for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
		char text[128];
		snprintf(text, sizeof text, "particles: 100\ndensity: %s\n", bad[i].word);
		assert_refused(text, NULL, "scene.yaml:2: density: ", bad[i].says);
		snprintf(text, sizeof text, GAS "species:\n  - diameter: 1\n    mass: %s\n", bad[i].word);
		assert_refused(text, NULL, "scene.yaml:6: species[0].mass: ", "above 0");
	}
	const char *counts[] = {"0", "-1", "1.5", "1e9", "99999999999999999999999", "many", "0x"};
	for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
		char text[128];
		snprintf(text, sizeof text, "density: 0.5\nparticles: %s\n", counts[i]);
		assert_refused(text, NULL, "scene.yaml:2: particles: ", "accepted: a whole number, 1 to 67108863");
	}
	assert_refused("dimensions: 4\n", NULL, "scene.yaml:1: dimensions: ", "'4'; accepted: a whole number, 1 to 3");
	assert_refused(GAS "species: [{diameter: -1}]\n", NULL, "scene.yaml:4: species[0].diameter: ", "'-1'");
	const char *restitutions[] = {"1.1", "-0.1", "nan", "viscoelastic", "viscoelastic -1", "elastic"};
	for (size_t i = 0; i < sizeof restitutions / sizeof *restitutions; i++) {
		char text[128];
		snprintf(text, sizeof text, GAS "\nrestitution: %s\n", restitutions[i]);
		assert_refused(text, NULL, "scene.yaml:5: restitution: ", "accepted: a coefficient, 0 to 1");
	}
	assert_refused(GAS "seed: -1\n", NULL, "scene.yaml:4: seed: ", "'-1'");
	assert_refused(GAS "time: -1\n", NULL, "scene.yaml:4: time: ", "'-1'");
	assert_refused(GAS "start: {temperature: 0}\n", NULL, "scene.yaml:4: start.temperature: ", "above 0");
}

static void states_that_cannot_be(void **state)
{
	(void)state;
	assert_refused("particles: 13500\ndensity: 1.5\n", NULL, "scene.yaml:2: density: ", "beyond close packing");
	assert_refused("particles: 1000\ndensity: 1.4\n", NULL, "scene.yaml:2: density: ", "up to");
	assert_refused("particles: 1000\nbox: [1]\n", NULL, "scene.yaml:2: box: ", "beyond close packing");
	assert_refused("particles: 1000\nbox: [100, 100, 0.5]\n", NULL, "scene.yaml:2: box: ", "own image");
	assert_refused(GAS "start:\n  positions: random\n", "density=1.3", "scene.yaml:5: start.positions: ", "found room");
	assert_refused(PAIR "  - position: [1.25]\n", NULL,
				   "scene.yaml:6: bodies[2]: ", "particles 1 and 2 overlap by 0.25");
	assert_refused(PAIR "walls:\n  - {point: [2], normal: [-1]}\n", NULL, "scene.yaml:5: bodies[1]: ", "the wall");
	assert_refused(PAIR "walls:\n  - point: [2]\n    normal: [0]\n", NULL,
				   "scene.yaml:8: walls[0].normal: ", "direction");
	assert_refused(PAIR "walls:\n  - point: [2]\n", NULL, "scene.yaml:7: walls[0].normal: ", "not given");
	assert_refused(GAS "species: [{fraction: 0.5}, {fraction: 0.25}]\n", NULL, "scene.yaml:4: species: ", "0.75");
}

static void keys_that_do_not_go_together(void **state)
{
	(void)state;
	assert_refused("density: 0.5\n", NULL, "scene.yaml:1: particles: ", "not given");
	assert_refused("particles: 5\n", NULL, "scene.yaml:1: density: ", "not given");
	assert_refused(GAS "box: [10]\n", NULL, "scene.yaml:4: box: ", "beside a density");
	assert_refused(PAIR "particles: 2\n", NULL, "scene.yaml:6: particles: ", "bodies");
	assert_refused(PAIR "density: 2\n", NULL, "scene.yaml:6: density: ", "accepted: a box");
	assert_refused(PAIR "start: {positions: lattice}\n", NULL, "scene.yaml:6: start.positions: ", "bodies");
	assert_refused(PAIR "  - {position: [4], species: iron}\n", NULL,
				   "scene.yaml:6: bodies[2].species: ", "list of species");
	assert_refused(PAIR "species: [{name: a}, {name: b}]\n", NULL, "scene.yaml:4: bodies[0].species: ", "first is 'a'");
	assert_refused(PAIR "  - velocity: [1]\n", NULL, "scene.yaml:6: bodies[2].position: ", "not given");
	assert_refused(GAS "start: {velocities: file}\n", NULL, "scene.yaml:4: start.velocities: ", "positions: file");
	assert_refused(GAS "start: {file: a.xyz}\n", NULL, "scene.yaml:4: start.file: ", "positions: file");
	assert_refused("start: {positions: file}\n", NULL, "scene.yaml:1: start.file: ", "not given");
}

static void what_is_accepted(void **state)
{
	(void)state;
	assert_accepted("particles: 1\ndensity: 0.1\n", NULL);
	assert_accepted("particles: 1e3\ndensity: 0x1p-1\nseed: 0xffffffffffffffff\nrestitution: viscoelastic 0.05\n",
					NULL);
	assert_accepted(PAIR "  - {position: [4.5], diameter: 2, mass: 3}\n", NULL);
	assert_accepted(PAIR "start: {velocities: maxwell}\n", NULL);
	assert_accepted(GAS "start: {temperature: 2}\n", "start.velocities=rest");
	assert_accepted(GAS, "gravity=[0,0,-1]");
	assert_accepted(GAS, "start={positions: random, velocities: uniform}");
	assert_accepted(GAS, "boundaries=[walls]");
	assert_accepted(GAS, "box=[20, 20, 0x1p4]"); /* takes the place of the density */
	assert_accepted(GAS, "dimensions=2");
}

static void settings_override(void **state)
{
	(void)state;
	char error[STORE_ERROR] = "";
	write_file("scene.yaml", GAS "start: {positions: random}\n", strlen(GAS "start: {positions: random}\n"));
	const char *settings[] = {"density=0.25", "start.temperature=3", "density=0.125", "particles=50", "seed=7"};
	struct scene_file *file = scene_file_open(path, 5, settings, error);
	assert_non_null(file);
	assert_true(file->recipe.density == 0.125 && file->recipe.temperature == 3 && file->recipe.particle_count == 50);
	assert_true(file->recipe.positions == SCENE_RANDOM && file->seed == 7);
	assert_false(scene_file_refuse(file, error, "density", "as said"));
	assert_string_equal(error, "--set density=0.125: density: as said");
	assert_false(scene_file_refuse(file, error, "start.positions", "as said"));
	assert_non_null(strstr(error, "scene.yaml:4: start.positions: as said"));
	assert_false(scene_file_refuse(file, error, "arithmetic", "as said"));
	assert_non_null(strstr(error, "scene.yaml:1: arithmetic: as said"));
	scene_file_close(file);
}

static void settings_are_refused(void **state)
{
	(void)state;
	const struct {
		const char *setting, *says;
	} bad[] = {{"density", "accepted: KEY=VALUE"},
			   {"=1", "accepted: KEY=VALUE"},
			   {"start.=1", "accepted: KEY=VALUE"},
			   {".start=1", "accepted: KEY=VALUE"},
			   {"a b=1", "accepted: KEY=VALUE"},
			   {"title=a\nseed: 3", "accepted: KEY=VALUE"},
			   {"densty=1", "unknown key 'densty'"},
			   {"density.x=1", "a mapping; accepted: one value"},
			   {"start.foo=1", "unknown key 'foo'"},
			   {"density=[1]", "a list; accepted: one value"},
			   {"density=1.5", "beyond close packing"},
			   {"density=", "''"},
			   {"density=a: b", "not YAML"},
			   {"gravity=[0,0", "not YAML"},
			   {"form=exact", "accepted: relative, absolute"},
			   {"box=[10, -1, 10]", "'-1'"},
			   {"restitution=2", "'2'"}};
	for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
		char place[64];
		snprintf(place, sizeof place, "--set %.*s", (int)strcspn(bad[i].setting, "\n"), bad[i].setting);
		assert_refused(GAS, bad[i].setting, place, bad[i].says);
	}
}

static void files_that_are_none(void **state)
{
	(void)state;
	char error[STORE_ERROR];
	assert_null(scene_file_open("no/such/file.yaml", 0, NULL, error));
	assert_string_equal(error, "no/such/file.yaml: cannot be read: No such file or directory");
	assert_null(scene_file_open(folder, 0, NULL, error));
	assert_non_null(strstr(error, "cannot be read: Is a directory"));
	assert_null(scene_file_open("/dev/zero", 0, NULL, error));
	assert_non_null(strstr(error, "too large"));
	char binary[1000];
	struct random_state random = random_seed(seed);
	for (size_t i = 0; i < sizeof binary; i++) binary[i] = (char)random_bits(&random);
	write_file("binary.yaml", binary, sizeof binary);
	assert_null(scene_file_open(path, 0, NULL, error));
	assert_non_null(strstr(error, "binary.yaml:1: not YAML"));
	assert_one_line(error);
	write_file("locked.yaml", GAS, strlen(GAS));
	assert_int_equal(chmod(path, 0), 0);
	if (access(path, R_OK) == 0) return; /* root reads everything */
	assert_null(scene_file_open(path, 0, NULL, error));
	assert_non_null(strstr(error, "cannot be read: Permission denied"));
}

/* ------------------------------------------------------------------ random damage */

struct text {
	char *bytes;
	size_t length;
};

static struct text read_text(const char *name)
{
	FILE *stream = fopen(name, "r");
	assert_non_null(stream);
	struct text text = {malloc(1 << 16), 0};
	text.length = fread(text.bytes, 1, 1 << 16, stream);
	fclose(stream);
	return text;
}

/* Replaces `removed` bytes at `at` by a word. */
static void splice(struct text *text, size_t at, size_t removed, const char *word)
{
	size_t added = strlen(word);
	char *bytes = malloc(text->length - removed + added);
	memcpy(bytes, text->bytes, at);
	memcpy(bytes + at, word, added);
	memcpy(bytes + at + added, text->bytes + at + removed, text->length - removed - at);
	free(text->bytes);
	text->bytes = bytes;
	text->length += added - removed;
}

static void damage(struct text *text, struct random_state *random)
{
	static const char *const words[] = {
		"nan",    "-1",   "1e400", "[",     "]",           "{",         "}",    ": ",       "- ",    "\n",
		"\t",     "#",    "&a ",   "*a",    "? ",          "!!str ",    "|",    ">",        "'",     "\"",
		"bodies", "[[]]", "---\n", "...\n", "%YAML 9.9\n", "0x1p-1074", "\x01", "\xc3\x28", "start", "\xef\xbb\xbf"};
	size_t at = random_below(random, text->length), left = text->length - at;
	const char *word = words[random_below(random, sizeof words / sizeof *words)];
	switch (random_below(random, 4)) {
	case 0: /* one bit */
		text->bytes[at] ^= (char)(1 << random_below(random, 8));
		break;
	case 1: /* a stretch is lost */
		splice(text, at, 1 + random_below(random, left < 20 ? left : 20), "");
		break;
	case 2: /* a word is put in */
		splice(text, at, 0, word);
		break;
	default: /* a word takes the place of another */
		splice(text, at, random_below(random, left < 8 ? left : 8), word);
	}
	if (text->length == 0) splice(text, 0, 0, "\n");
}

static void damaged_files_do_no_harm(void **state)
{
	(void)state;
	glob_t cases;
	assert_int_equal(glob("cases/*.yaml", 0, NULL, &cases), 0);
	struct random_state random = random_seed(seed);
	const char *fewer = "particles=64";
	int accepted = 0, refused = 0;
	for (int trial = 0; trial < DAMAGED; trial++) {
		struct text text = read_text(cases.gl_pathv[random_below(&random, cases.gl_pathc)]);
		char *keys = memmem(text.bytes, text.length, "title:", 6); /* most of the damage where it matters */
		if (random_below(&random, 8)) splice(&text, 0, (size_t)(keys - text.bytes), "");
		for (uint64_t n = 1 + random_below(&random, 3); n > 0; n--) damage(&text, &random);
		write_file("damaged.yaml", text.bytes, text.length);
		free(text.bytes);
		char error[STORE_ERROR] = "";
		struct scene_file *file = scene_file_open(path, random_below(&random, 2), &fewer, error);
		struct touchstone_scene scene;
		bool built = file && file->recipe.particle_count < 500 && scene_file_build(file, &scene, error);
		if (built) scene_free(&scene);
		if (!built && (!file || file->recipe.particle_count < 500)) {
			assert_one_line(error);
			assert_true(strncmp(error, path, strlen(path)) == 0 || strncmp(error, "--set ", 6) == 0);
			refused++;
		} else {
			accepted++;
		}
		scene_file_close(file);
	}
	globfree(&cases);
	printf("of %d damaged files %d were refused, %d still made sense\n", DAMAGED, refused, accepted);
	assert_true(refused > 1000 && accepted > 100);
}

int main(void)
{
	printf("seed %llu\n", (unsigned long long)seed);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(damaged_files_do_no_harm), cmocka_unit_test(every_case_builds),
		cmocka_unit_test(cases_are_what_they_are),  cmocka_unit_test(what_is_accepted),
		cmocka_unit_test(settings_override),        cmocka_unit_test(settings_are_refused),
		cmocka_unit_test(unknown_keys_and_kinds),   cmocka_unit_test(values_out_of_range),
		cmocka_unit_test(states_that_cannot_be),    cmocka_unit_test(keys_that_do_not_go_together),
		cmocka_unit_test(files_that_are_none),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

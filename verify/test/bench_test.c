/* The benchmark without its clock: statistics, the points it measures, how each is measured, what it refuses. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include <cmocka.h>

#include "bench/instructions.h"
#include "measure/spread.h"
#include "bench/timing.h"
#include "scene/random.h"
#include "test/folder.h"

enum { SEED = 20221103 };

static char error[REPORT_ERROR];

/* ------------------------------------------------------------------ statistics */

/* Half of the values lie on either side of the median, a quarter beyond each quartile, in whatever order they came. */
static void quartiles_part_a_sample(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	print_message("seed %d\n", SEED);
	for (int trial = 0; trial < 2000; trial++) {
		struct sample sample = {0}, turned = {0};
		size_t count = 1 + random_below(&random, SAMPLE_MOST);
		for (size_t i = 0; i < count; i++) sample_add(&sample, exp(random_normal(&random)));
		for (size_t i = count; i-- > 0;) {
			sample_add(&turned, sample.value[i]);
			if (turned.count < SAMPLE_MOST - 1 && i % 7 == 0 && count < 20) sample_add(&turned, NAN);
		}
		struct spread spread = spread_of(&sample), again = spread_of(&turned);
		assert_memory_equal(&spread, &again, sizeof spread);
		size_t below[3] = {0}, above[3] = {0};
		const double cut[3] = {spread.low, spread.median, spread.high};
		for (size_t i = 0; i < count; i++)
			for (int c = 0; c < 3; c++) {
				below[c] += sample.value[i] < cut[c];
				above[c] += sample.value[i] > cut[c];
			}
		for (int c = 0; c < 3; c++) {
			double place = (double)(count - 1) * (c + 1) / 4; /* between two values, by interpolation */
			assert_true((double)below[c] <= ceil(place) && (double)above[c] <= (double)(count - 1) - floor(place));
		}
	}
	assert_true(isnan(spread_of(&(struct sample){0}).median));
	struct sample full = {0};
	for (int i = 0; i < SAMPLE_MOST + 3; i++) sample_add(&full, i);
	assert_int_equal(full.count, SAMPLE_MOST);
}

/* A machine that is slow for a while slows both, and leaves the quotient alone. */
static void ratios_are_taken_pair_by_pair(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	struct sample over = {0}, under = {0};
	for (int i = 0; i < 9; i++) {
		double slowness = ldexp(1, (int)random_below(&random, 8));
		sample_add(&over, 3 * slowness);
		sample_add(&under, 2 * slowness);
	}
	struct spread ratio = spread_of_ratio(&over, &under);
	assert_true(ratio.low == 1.5 && ratio.median == 1.5 && ratio.high == 1.5);
	under.count = 0;
	assert_true(isnan(spread_of_ratio(&over, &under).median));
}

/* ------------------------------------------------------------------ points */

static void points_are_scenes(void **state)
{
	(void)state;
	const struct effort quick = effort_of(false), full = effort_of(true);
	char name[POINT_NAME];
	assert_true(quick.repetitions >= 5 && full.repetitions >= 5);
	assert_true(full.repetitions <= SAMPLE_MOST);
	for (int p = 0; p < POINTS; p++) {
		const struct point *point = &points[p];
		struct scene_file *file = point_open(point, &quick, error);
		if (!file) fail_msg("%s", error);
		assert_int_equal(point_named(point_name(point, name)), p);
		assert_string_equal(file->name, point->scene);
		assert_int_equal(file->recipe.particle_count, point->particles);
		assert_true(file->recipe.density == point->density);
		assert_string_equal(file->arithmetic, point->arithmetic);
		assert_true((file->recipe.search == TOUCHSTONE_UNSIEVED) == (strcmp(point->search, "unsieved") == 0));
		for (int axis = 0; axis < file->recipe.dimensions; axis++)
			assert_int_equal(file->recipe.boundary[axis], SCENE_PERIODIC);
		assert_true(file->equilibrate == point_melt(point, &quick));
		assert_true(point_melt(point, &full) > point_melt(point, &quick));
		assert_true(point_melt(point, &quick) >= 5 || point->particles > 13500);
		assert_true(point_counted(point, &full) && (point_counted(point, &quick) || point->particles > 13500));
		scene_file_close(file);
	}
	assert_int_equal(point_named("hard-spheres 7 0.5 binary64"), -1);
	assert_int_equal(effort_events(&(struct effort){.scale = 1e-9}, 1000), 1);
}

/* The same point gives the same events each time, with the sieve and without, and a signal ends it without a word. */
static void runs_repeat_themselves(void **state)
{
	(void)state;
	const struct effort effort = effort_of(false);
	struct engine_timing timing[3];
	struct point point = points[0];
	const int stop = 1;
	double seconds;
	for (int run = 0; run < 3; run++) {
		if (run == 2) point.search = "unsieved";
		struct scene_file *file = point_open(&point, &effort, error);
		assert_non_null(file);
		if (!engine_time(file, 2000, NULL, &timing[run], error)) fail_msg("%s", error);
		assert_true(timing[run].event > 0 && timing[run].start_up > 0 && timing[run].bytes > 0);
		assert_int_equal(timing[run].digest, timing[0].digest);
		assert_true(engine_count(file, 100, error));
		assert_false(engine_time(file, 2000, &stop, &timing[run], error));
		assert_string_equal(error, "");
		scene_file_close(file);
	}
	assert_true(timing[2].bytes < timing[0].bytes); /* no shadows */
	assert_true(drop_time(1000, NULL, &seconds, error) && seconds > 0);
	assert_false(drop_time(1000, &stop, &seconds, error));
	assert_string_equal(error, "");
}

static void two_runs_go_side_by_side(void **state)
{
	(void)state;
	const struct effort effort = effort_of(false);
	struct cores cores = cores_look();
	double times = 0;
	struct scene_file *file = point_open(&points[0], &effort, error);
	assert_non_null(file);
	assert_true(cores.count >= 1 && CPU_ISSET(cores.chosen[0], &cores.all) && CPU_ISSET(cores.chosen[1], &cores.all));
	assert_true((cores.chosen[0] == cores.chosen[1]) == (cores.count == 1));
	if (!speed_up(file, 1000, &cores, NULL, &times, error)) fail_msg("%s", error);
	assert_true(times > 0);
	cores_roam(&cores);
	struct cores after = cores_look();
	assert_int_equal(after.count, cores.count);
	scene_file_close(file);
}

/* ------------------------------------------------------------------ counting */

static void counts_are_read(void **state)
{
	(void)state;
	static const struct {
		const char *text;
		double count;
	} files[] = {
		{"# callgrind format\nevents: Ir\nsummary: 12\n\nfn=(1) main\n0 7\ntotals: 22863211\n", 22863211},
		{"totals: 3", 3},
		{"events: Ir\n", NAN},
		{"", NAN},
		{"totals: \n", NAN},
		{"totals: many\n", NAN},
		{"totals: 12 x\n", NAN},
		{"totals: 0\n", NAN},
	};
	char *folder = folder_new(), *path;
	assert_true(asprintf(&path, "%s/counts", folder) > 0);
	for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
		folder_put(folder, "counts", files[f].text);
		double count = instructions_read(path, error);
		assert_true(isnan(files[f].count) ? isnan(count) && strstr(error, "totals: NUMBER") : count == files[f].count);
	}
	assert_true(isnan(instructions_read("/nowhere/counts", error)) && strstr(error, "/nowhere/counts: No such file"));
	free(path);
	folder_remove(folder);
}

/* What the program says, both ways together, and its exit status. */
static int say(char text[2000], const char *arguments)
{
	char command[500];
	snprintf(command, sizeof command, "%s %s 2>&1", TOUCHSTONE_BENCH, arguments);
	FILE *stream = popen(command, "r");
	assert_non_null(stream);
	text[fread(text, 1, 1999, stream)] = '\0';
	return WEXITSTATUS(pclose(stream));
}

static void bad_wishes_are_refused(void **state)
{
	(void)state;
	char *folder = folder_new(), text[2000], arguments[200];
	folder_put(folder, "b.json", "{]");
	snprintf(arguments, sizeof arguments, "--baseline %s/b.json --results %s/none", folder, folder);
	assert_int_equal(say(text, arguments), 2);
	assert_non_null(strstr(text, "b.json:1: damaged baseline"));
	assert_int_equal(folder_count(folder, "none"), 0);
	assert_int_equal(say(text, "--scale 0"), 2);
	assert_string_equal(text, "touchstone: --scale: '0'; accepted: a number above 0, to 1000\n");
	assert_int_equal(say(text, "--count 'hard-spheres 7'"), 2);
	assert_non_null(strstr(text, "accepted: the name of a run"));
	assert_int_equal(say(text, "--events 10 --count 'hard-spheres 500 0.5 binary64'"), 0);
	assert_string_equal(text, "");
	folder_remove(folder);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(quartiles_part_a_sample),  cmocka_unit_test(ratios_are_taken_pair_by_pair),
		cmocka_unit_test(points_are_scenes),        cmocka_unit_test(runs_repeat_themselves),
		cmocka_unit_test(two_runs_go_side_by_side), cmocka_unit_test(counts_are_read),
		cmocka_unit_test(bad_wishes_are_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The measures of pair states: inconsistencies against a plain count over all pairs in exact arithmetic, and the
 * watcher against methods that are known to go wrong, and one that does not; the figure's runs are those of its
 * commands. */
#include <math.h>

#include "figure/step_gas.h"
#include "measure/inconsistency.h"
#include "measure/misreading.h"
#include "program.h"
#include "scene/scene.h"

enum { SEED = 20160301, PARTICLES = 40 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

static const struct touchstone_step steps[] = {{1.25, 0.5}, {1.6, -1}};
static const struct touchstone_potential potential = {{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 2, steps};

/* A measurement and the plain count beside it. */
struct both {
	struct inconsistency measured;
	uint64_t told, wrong, executed;
	bool step_event, inside;
};

/* |r|^2 against d^2 in long arithmetic: sums and squares of 16-bit numbers are exact in long double. */
static bool within(const struct touchstone_engine *engine)
{
	double terms[3][3 * TOUCHSTONE_MOST_TERMS], distance[TOUCHSTONE_MOST_TERMS];
	int count = touchstone_separation(engine, terms, distance);
	long double square = 0;
	for (int axis = 0; axis < 3; axis++) {
		long double sum = 0;
		for (int term = 0; term < count; term++) sum += (long double)terms[axis][term];
		square += sum * sum;
	}
	return square < (long double)distance[0] * (long double)distance[0];
}

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct both *both = context;
	bool passes = event->kind == TOUCHSTONE_CAPTURE || event->kind == TOUCHSTONE_RELEASE;
	if (passes || event->kind == TOUCHSTONE_BOUNCE) {
		bool from_inside = passes ? event->after < event->before : event->approach < 0;
		both->executed += within(engine) != from_inside;
	}
	inconsistency_see(&both->measured, engine, event);
}

static void hear(void *context, struct touchstone_engine *engine, const struct touchstone_test *test)
{
	struct both *both = context;
	int read = fabs(test->excess) > 0.01 ? test->within : test->step + within(engine);
	both->told++;
	both->wrong += read != test->state;
	inconsistency_test(&both->measured, engine, test);
}

static void inconsistencies_are_counted(void **state)
{
	(void)state;
	static const struct scene_species ball = {1, {1, 1}};
	const struct scene_recipe recipe = {.dimensions = 3,
										.particle_count = PARTICLES,
										.density = 0.1,
										.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
										.species_count = 1,
										.species = &ball,
										.restitution = {TOUCHSTONE_CONSTANT, 1},
										.potential_count = 1,
										.potentials = &potential,
										.velocities = SCENE_MAXWELL,
										.temperature = 1};
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160] = "";
	assert_true(scene_build(&recipe, SEED, &scene, &complaint));
	struct touchstone_engine *engine = touchstone_create(&scene, "short:12", "stable", error);
	if (!engine) fail_msg("%s", error);
	struct both both = {0};
	assert_true(inconsistency_begin(&both.measured, 12, PARTICLES));
	struct touchstone_listener listener = {hear, &both, inconsistency_reach, INFINITY, 0};
	touchstone_observe_tests(engine, &listener);
	uint64_t events = brief ? 5000 : 40000;
	touchstone_run(engine, &(struct touchstone_limits){events, INFINITY, NULL},
				   &(struct touchstone_observer){see, &both});
	const uint64_t *count = both.measured.count;
	print_message("%llu events, %llu tests;", (unsigned long long)events, (unsigned long long)both.told);
	for (int kind = 0; kind < INCONSISTENCIES; kind++)
		print_message(" %s %llu", inconsistency_name((enum inconsistency_kind)kind), (unsigned long long)count[kind]);
	print_message("\n");
	assert_true(both.measured.events == events && listener.tests == both.told);
	assert_true(count[INCONSISTENT_EXECUTED] == both.executed);
	assert_true(count[INCONSISTENT_AFTER] + count[INCONSISTENT_LATER] + count[INCONSISTENT_OTHERS] == both.wrong);
	for (int kind = 0; kind < INCONSISTENCIES; kind++) assert_true(count[kind] > 0 && count[kind] < events);
	assert_true(count[INCONSISTENT_FOUND] < count[INCONSISTENT_AFTER]);
	struct inconsistency sum = {0};
	inconsistency_merge(&sum, &both.measured);
	inconsistency_merge(&sum, &both.measured);
	assert_true(sum.events == 2 * events && sum.count[INCONSISTENT_LATER] == 2 * count[INCONSISTENT_LATER]);
	inconsistency_end(&both.measured);
	touchstone_destroy(engine);
	scene_free(&scene);
}

/* ------------------------------------------------------------------ the watcher */

static struct step_gas_outcome watched(const char *method, const char *arithmetic, bool shoulder)
{
	const struct step_gas gas = {.shoulder = shoulder,
								 .particles = 500,
								 .form = TOUCHSTONE_ABSOLUTE,
								 .arithmetic = arithmetic,
								 .method = method,
								 .events = 5000,
								 .watched = true};
	struct step_gas_outcome outcome;
	step_gas_run(&gas, 1, NULL, &(struct watch){0}, &outcome);
	if (*outcome.error) fail_msg("%s", outcome.error);
	assert_true(outcome.begun && !outcome.stopped && !outcome.misreading.exhausted);
	assert_true(outcome.misreading.events == outcome.end.events);
	return outcome;
}

static void tracked_states_are_never_misread(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"short:16", "binary64"};
	for (int a = 0; a < 2; a++)
		for (int shoulder = 0; shoulder < 2; shoulder++) {
			struct step_gas_outcome outcome = watched("stable", arithmetics[a], shoulder);
			assert_true(outcome.misreading.repeats == 0 && outcome.misreading.misses == 0);
			assert_true(outcome.misreading.energy == 0 && outcome.misreading.stuck.event == 0);
			if (a == 1) assert_true(fabs(outcome.energy_drift) < 1e-13);
		}
}

/* What the 2016 paper reports of Alder and Wainwright's implementation; and that energy out of nothing is what the
 * particles then have too much. */
static void positional_is_stuck(void **state)
{
	(void)state;
	struct step_gas_outcome outcome = watched("positional", "binary64", true);
	const struct misreading *misreading = &outcome.misreading;
	char text[200];
	print_message("%s\n", misreading_tell(&misreading->repeated, text));
	print_message("%s\n", misreading_tell(&misreading->stuck, text));
	assert_int_equal(misreading->stuck.kind, TOUCHSTONE_RELEASE);
	assert_true(misreading->repeated.event > 0 && misreading->repeated.event < misreading->stuck.event);
	assert_true(misreading->stuck.event < 1000);
	assert_int_equal(outcome.end.verdict, TOUCHSTONE_COLLAPSED);
	assert_true(misreading->energy > 1000);
	double drift = misreading->energy / (1.5 * 500); /* of 500 particles of temperature 1, nearly */
	assert_true(fabs(outcome.energy_drift / drift - 1) < 0.1);
}

static void corrections_fail_by_third_particles(void **state)
{
	(void)state;
	static const char *const methods[] = {"stretch", "nudge", "last-event"};
	for (int m = 0; m < 3; m++) {
		struct step_gas_outcome outcome = watched(methods[m], "short:16", false);
		char text[200];
		print_message("%s: %s\n", methods[m], misreading_tell(&outcome.misreading.missed, text));
		assert_true(outcome.misreading.misses > 0);
		assert_true(outcome.misreading.missed.third < 500);
		assert_non_null(strstr(text, "when one of them met"));
	}
}

static void commands_show_the_same(void **state)
{
	(void)state;
	const struct step_gas gas = {.shoulder = true,
								 .particles = 500,
								 .form = TOUCHSTONE_ABSOLUTE,
								 .arithmetic = "binary64",
								 .method = "positional",
								 .events = 5000,
								 .watched = true};
	struct step_gas_outcome outcome = watched(gas.method, gas.arithmetic, gas.shoulder);
	char command[320], text[200];
	step_gas_command(&gas, 1, command);
	assert_true(strncmp(command, "touchstone ", 11) == 0);
	struct said said = program_run("%s", command + 11);
	assert_int_equal(said.status, 0); /* it collapsed, which is no failure of the program */
	assert_non_null(strstr(said.out, misreading_tell(&outcome.misreading.repeated, text)));
	assert_non_null(strstr(said.out, misreading_tell(&outcome.misreading.stuck, text)));
	said_free(&said);
	said = program_run("%s --json -", command + 11);
	snprintf(text, sizeof text, "\"repeats\": %llu", (unsigned long long)outcome.misreading.repeats);
	assert_non_null(strstr(said.out, text));
	assert_non_null(strstr(said.out, "\"kind\": \"release\""));
	said_free(&said);
}

/* ------------------------------------------------------------------ what is kept of a gas under way */

/* Asks for an end after so many events, those before a checkpoint included. */
struct impatient {
	uint64_t left;
	int stop;
};

static void grow_impatient(void *context, uint64_t more, const struct touchstone_status *now)
{
	(void)now;
	struct impatient *impatient = context;
	impatient->left -= more < impatient->left ? more : impatient->left;
	impatient->stop = impatient->left == 0;
}

static bool file_exists(const char *path)
{
	return access(path, F_OK) == 0;
}

static void stopped_gases_go_on(void **state)
{
	(void)state;
	const struct step_gas gas = {.particles = 500,
								 .form = TOUCHSTONE_RELATIVE,
								 .arithmetic = "short:14",
								 .method = "stable",
								 .equilibrate = 2,
								 .events = 20000};
	char *folder = folder_new(), path[60];
	snprintf(path, sizeof path, "%s/gas.checkpoint", folder);
	struct step_gas_outcome whole, parts;
	step_gas_run(&gas, 7, NULL, &(struct watch){0}, &whole);
	int calls = 0;
	do {
		struct impatient impatient = {.left = 6000 * (1 + (uint64_t)calls)};
		const struct watch watch = {&impatient.stop, grow_impatient, &impatient};
		step_gas_run(&gas, 7, path, &watch, &parts);
		assert_true(!*parts.error && file_exists(path) == parts.stopped);
		if (calls++ == 0) { /* another gas does not take it for its own */
			struct step_gas_outcome other;
			impatient = (struct impatient){.left = 1};
			step_gas_run(&gas, 8, path, &watch, &other);
			assert_true(other.inconsistency.events < parts.inconsistency.events && file_exists(path));
		}
	} while (parts.stopped && calls < 10);
	print_message("%d calls, %llu inconsistencies by others\n", calls,
				  (unsigned long long)whole.inconsistency.count[INCONSISTENT_OTHERS]);
	assert_true(calls > 2);
	assert_true(!parts.stopped && whole.inconsistency.count[INCONSISTENT_OTHERS] > 0);
	assert_memory_equal(parts.inconsistency.count, whole.inconsistency.count, sizeof whole.inconsistency.count);
	assert_true(parts.end.digest == whole.end.digest && parts.end.events == gas.events);
	assert_true(parts.energy_drift == whole.energy_drift && parts.inconsistency.events == gas.events);
	assert_int_equal(folder_count(folder, ""), 0);
	folder_remove(folder);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(inconsistencies_are_counted), cmocka_unit_test(tracked_states_are_never_misread),
		cmocka_unit_test(positional_is_stuck),         cmocka_unit_test(corrections_fail_by_third_particles),
		cmocka_unit_test(commands_show_the_same),      cmocka_unit_test(stopped_gases_go_on),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}

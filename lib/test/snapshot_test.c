/* A run that is saved and taken up again, anywhere and any number of times, is the run that never stopped, to the last
 * bit: in every arithmetic, with any search, for scenes of all kinds. */
#include "step_scenes.h"

#include <signal.h>
#include <sys/time.h>

static bool brief; /* under sanitizers, where everything takes ten times longer */

static const char *const arithmetics[] = {"binary64", "binary32",  "short:9", "twin",     "binary64",
										  "extended", "binary128", "mpfr:53", "mpfr:300", "short:22"};
enum { ARITHMETICS = sizeof arithmetics / sizeof *arithmetics };

/* ------------------------------------------------------------------ scenes */

static const struct touchstone_particle row[] = {
	{{-4, 0, 0}, {1, 0, 0}, 0}, {{-0.5, 0, 0}, {0}, 0}, {{0.5, 0, 0}, {0}, 0}, {{1.5, 0, 0}, {0}, 0}};
static const struct touchstone_particle ball[] = {{{0, 0, 1}, {0.25, 0, 0}, 0}};

static struct scene_recipe given(int dimensions, size_t count, const struct touchstone_particle *particles)
{
	struct scene_recipe recipe = gas(dimensions, count, 0);
	recipe.particles = particles;
	recipe.positions = SCENE_GIVEN;
	recipe.velocities = SCENE_AS_GIVEN;
	for (int axis = 0; axis < dimensions; axis++) recipe.box[axis] = 12, recipe.boundary[axis] = SCENE_WALLS;
	return recipe;
}

enum { STEPPED, INELASTIC, CRADLE, BALL, COLUMN, KINDS };

static struct scene_recipe draw_scene(int kind, struct drawn *drawn, struct random_state *random)
{
	struct scene_recipe recipe;
	switch (kind) {
	case INELASTIC:
		recipe =
			gas(1 + (int)random_below(random, 3), 24 + random_below(random, 40), 0.3 + 0.4 * random_uniform(random));
		recipe.restitution.coefficient = 0.5 + 0.5 * random_uniform(random);
		break;
	case CRADLE:
		recipe = given(1, 4, row);
		break;
	case BALL:
		recipe = given(3, 1, ball);
		recipe.acceleration[2] = -1;
		recipe.boundary_restitution.coefficient = 0.3 + 0.6 * random_uniform(random);
		break;
	case COLUMN:
		recipe = gas(1 + (int)random_below(random, 2), 12, 0.4);
		recipe.boundary[recipe.dimensions - 1] = SCENE_WALLS;
		recipe.acceleration[recipe.dimensions - 1] = -1;
		recipe.restitution.coefficient = recipe.boundary_restitution.coefficient = 0.8;
		break;
	default:
		return draw_gas(drawn, random);
	}
	recipe.form = random_below(random, 2) ? TOUCHSTONE_ABSOLUTE : TOUCHSTONE_RELATIVE;
	return recipe;
}

/* ------------------------------------------------------------------ how states compare */

static const struct touchstone_field *field_of(const struct touchstone_snapshot *snapshot, const char *name)
{
	for (size_t f = 0; f < snapshot->count; f++)
		if (strcmp(snapshot->field[f].name, name) == 0) return &snapshot->field[f];
	return NULL;
}

/* All but where a particle is counted from and what was looked up on the way, which is bookkeeping. */
static void assert_same_state(const struct run *one, const struct run *other)
{
	static const char *const same[] = {"position",        "velocity",     "time",     "page",   "stalls",
									   "now_time",        "now_page",     "events",   "kinds",  "digest",
									   "elastic",         "verdict",      "reason",   "blamed", "crossed_time",
									   "flux_with_count", "flux_against", "flux_with"};
	struct touchstone_snapshot a, b;
	assert_true(touchstone_save(one->engine, &a) && touchstone_save(other->engine, &b));
	assert_int_equal(a.count, b.count);
	for (size_t s = 0; s < sizeof same / sizeof *same; s++) {
		const struct touchstone_field *first = field_of(&a, same[s]), *second = field_of(&b, same[s]);
		if (!first && !second) continue;
		assert_int_equal(touchstone_field_bytes(&a, first), touchstone_field_bytes(&b, second));
		if (memcmp(first->data, second->data, touchstone_field_bytes(&a, first)) != 0)
			fail_msg("field '%s' differs", same[s]);
	}
	touchstone_snapshot_free(&a);
	touchstone_snapshot_free(&b);
	struct touchstone_status first = status_of(one), second = status_of(other);
	assert_int_equal(first.captured, second.captured);
	assert_true(first.potential_energy == second.potential_energy);
	for (uint32_t p = 0; p < first.count; p++)
		assert_int_equal(touchstone_captured(one->engine, p, NULL, 0), touchstone_captured(other->engine, p, NULL, 0));
}

/* Saves a run, ends it, and takes it up again with a search of its own. */
static void interrupt(struct run *run, const char *arithmetic, const char *method, struct random_state *random)
{
	struct touchstone_snapshot snapshot;
	char error[160];
	assert_true(touchstone_save(run->engine, &snapshot));
	touchstone_destroy(run->engine);
	run->scene.search = (enum touchstone_search)random_below(random, 3);
	run->scene.cell = random_below(random, 2) ? 0 : 1 + 2 * random_uniform(random);
	run->engine = touchstone_restore(&run->scene, arithmetic, method, &snapshot, error);
	if (!run->engine) fail_msg("%s", error);
	touchstone_snapshot_free(&snapshot);
}

static void a_stop_changes_nothing(void **state)
{
	(void)state;
	enum { STOPS = 3 };
	struct random_state random = random_seed(SEED);
	print_message("seed %d\n", SEED);
	size_t methods = 1;
	while (touchstone_method_name(methods)) methods++;
	int stops = 0, ended[TOUCHSTONE_DIVERGED + 1] = {0};
	for (int trial = 0; trial < (brief ? 12 : 40); trial++) {
		struct drawn drawn;
		int kind = trial % 2 ? STEPPED : trial / 2 % KINDS;
		struct scene_recipe recipe = draw_scene(kind, &drawn, &random);
		const char *arithmetic = arithmetics[random_below(&random, ARITHMETICS)];
		const char *method =
			touchstone_method_name(trial % 3 || kind == STEPPED ? 0 : 1 + random_below(&random, methods - 1));
		uint64_t events = recipe.particle_count < 20 ? 1500 : 300;
		struct run whole = begin(&recipe, arithmetic, method), broken = begin(&recipe, arithmetic, method);
		struct touchstone_status expected = advance(&whole, events), got = {0};
		uint64_t left = expected.events;
		for (int stop = 0; stop < STOPS; stop++, stops++) {
			uint64_t more = random_below(&random, left + 1);
			double at = random_below(&random, 3) ? INFINITY : got.time + expected.time * random_uniform(&random) / 4;
			touchstone_run(broken.engine, &(struct touchstone_limits){more, at, NULL}, NULL);
			interrupt(&broken, arithmetic, method, &random);
			got = status_of(&broken);
			left = expected.events - got.events;
		}
		if (expected.verdict != TOUCHSTONE_DONE || left > 0) advance(&broken, events - got.events);
		got = status_of(&broken);
		if (got.digest != expected.digest || got.crossings != expected.crossings || got.verdict != expected.verdict)
			fail_msg("trial %d (kind %d, %d dimensions, %s, %s): %016llx after %llu events, but %016llx after %llu; %s",
					 trial, kind, recipe.dimensions, arithmetic, method, (unsigned long long)got.digest,
					 (unsigned long long)got.events, (unsigned long long)expected.digest,
					 (unsigned long long)expected.events, got.reason);
		assert_true(got.verdict != TOUCHSTONE_DONE || got.time == expected.time || got.events < events);
		if (expected.events == events) assert_same_state(&whole, &broken);
		ended[got.verdict]++;
		end(&whole);
		end(&broken);
	}
	print_message("%d stops; %d runs done, %d collapsed\n", stops, ended[TOUCHSTONE_DONE], ended[TOUCHSTONE_COLLAPSED]);
	assert_true(ended[TOUCHSTONE_DONE] > 0 && (brief || ended[TOUCHSTONE_COLLAPSED] > 0));
}

/* What is saved is taken in as it is: saved again at once, it is the same field by field. */
static void a_state_survives_to_the_last_bit(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED + 1);
	for (int a = 0; a < ARITHMETICS; a++) {
		struct drawn drawn;
		struct scene_recipe recipe = draw_gas(&drawn, &random);
		struct run run = begin(&recipe, arithmetics[a], "stable");
		struct touchstone_status status = advance(&run, 500);
		struct run again = {run.scene, NULL};
		struct touchstone_snapshot snapshot;
		char error[160];
		assert_true(touchstone_save(run.engine, &snapshot));
		assert_int_equal(snapshot.words, status.bits == 300 ? 7 : status.bits > 53 || a == 7 ? 2 + (a == 7) : 1);
		again.engine = touchstone_restore(&run.scene, arithmetics[a], "stable", &snapshot, error);
		assert_non_null(again.engine);
		assert_same_state(&run, &again);
		const struct touchstone_field *pairs = field_of(&snapshot, "pairs");
		assert_int_equal(pairs->rows, status.captured);
		touchstone_snapshot_free(&snapshot);
		touchstone_destroy(again.engine);
		end(&run);
	}
}

/* After a change of units pages begin anywhere: that, too, is part of a state. */
static void a_stop_after_other_units_changes_nothing(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED + 3);
	for (int a = 0; a < ARITHMETICS; a++) {
		struct scene_recipe recipe = gas(3, 32, 0.4);
		recipe.restitution.coefficient = 0.8;
		recipe.form = a % 3 ? TOUCHSTONE_RELATIVE : TOUCHSTONE_ABSOLUTE;
		struct run whole = begin(&recipe, arithmetics[a], "stable"), broken = begin(&recipe, arithmetics[a], "stable");
		advance(&whole, 150);
		advance(&broken, 150);
		assert_true(touchstone_rescale(whole.engine, 2) && touchstone_rescale(broken.engine, 2));
		interrupt(&broken, arithmetics[a], "stable", &random);
		assert_int_equal(advance(&broken, 150).digest, advance(&whole, 150).digest);
		assert_same_state(&whole, &broken);
		end(&whole);
		end(&broken);
	}
}

/* ------------------------------------------------------------------ states of no run */

static void assert_refused(const struct run *run, const char *arithmetic, const struct touchstone_snapshot *snapshot)
{
	char error[160] = "";
	struct touchstone_engine *engine = touchstone_restore(&run->scene, arithmetic, "stable", snapshot, error);
	assert_null(engine);
	assert_true(strlen(error) > 20);
}

static void other_scenes_and_arithmetics_are_refused(void **state)
{
	(void)state;
	struct scene_recipe recipe = gas(3, 32, 0.3);
	struct run run = begin(&recipe, "binary64", "stable");
	struct touchstone_snapshot snapshot;
	assert_true(touchstone_save(run.engine, &snapshot));
	assert_refused(&run, "twin", &snapshot);
	assert_refused(&run, "mpfr:53", &snapshot);
	recipe.particle_count = 108;
	struct run larger = begin(&recipe, "binary64", "stable");
	assert_refused(&larger, "binary64", &snapshot);
	recipe.particle_count = 32, recipe.density = 0.4;
	struct run denser = begin(&recipe, "binary64", "stable");
	assert_refused(&denser, "binary64", &snapshot);
	end(&run);
	end(&larger);
	end(&denser);
	touchstone_snapshot_free(&snapshot);
}

/* Bytes changed at random: the state is refused, or an engine goes on from it; it never crashes. */
static void altered_states_do_no_harm(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED + 2);
	int refused = 0, taken = 0;
	for (int trial = 0; trial < (brief ? 60 : 600); trial++) {
		struct drawn drawn;
		struct scene_recipe recipe = draw_gas(&drawn, &random);
		const char *arithmetic = arithmetics[trial % ARITHMETICS];
		struct run run = begin(&recipe, arithmetic, "stable");
		struct touchstone_snapshot snapshot;
		char error[160] = "";
		advance(&run, 100);
		assert_true(touchstone_save(run.engine, &snapshot));
		struct touchstone_field *field = &snapshot.field[random_below(&random, snapshot.count)];
		size_t bytes = touchstone_field_bytes(&snapshot, field);
		if (bytes && random_below(&random, 8))
			((uint8_t *)field->data)[random_below(&random, bytes)] ^= (uint8_t)(1 << random_below(&random, 8));
		else if (random_below(&random, 2))
			field->columns++;
		else
			field->name[0]++;
		struct touchstone_engine *engine = touchstone_restore(&run.scene, arithmetic, "stable", &snapshot, error);
		refused += !engine;
		taken += engine != NULL;
		if (engine) touchstone_run(engine, &(struct touchstone_limits){100, INFINITY, NULL}, NULL);
		assert_true(engine || strlen(error) > 20);
		touchstone_destroy(engine);
		touchstone_snapshot_free(&snapshot);
		end(&run);
	}
	print_message("%d refused, %d taken\n", refused, taken);
	assert_true(refused > 0 && taken > 0);
}

/* ------------------------------------------------------------------ states that nothing leads to */

static volatile int stop;

static void tell_stop(int number)
{
	(void)number;
	stop = 1;
}

/* A ball that was made so fast that it crosses its cells at one and the same time by the clock, and meets nothing. */
static void a_run_can_be_stopped_where_time_stands_still(void **state)
{
	(void)state;
	static const struct touchstone_particle apart[2] = {{.velocity = {1, 0.5, 0.25}}, {.position = {0, 5, 5}}};
	static const struct touchstone_species species = {1, 1};
	const struct touchstone_scene scene = {.dimensions = 3,
										   .particle_count = 2,
										   .particles = apart,
										   .species_count = 1,
										   .species = &species,
										   .box = {20, 20, 20},
										   .periodic = {true, true, true},
										   .cell = 2};
	char error[160];
	struct touchstone_snapshot snapshot;
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	if (!engine) fail_msg("%s", error);
	touchstone_run(engine, &(struct touchstone_limits){100, 0.7, NULL}, NULL);
	assert_true(touchstone_save(engine, &snapshot));
	touchstone_destroy(engine);
	double *velocity = field_of(&snapshot, "velocity")->data;
	for (int axis = 0; axis < 3; axis++) velocity[axis] *= 1e30;
	memcpy(field_of(&snapshot, "time")->data, field_of(&snapshot, "now_time")->data, sizeof(double));
	engine = touchstone_restore(&scene, "binary64", "stable", &snapshot, error);
	touchstone_snapshot_free(&snapshot);
	if (!engine) fail_msg("%s", error);
	struct touchstone_status status;
	const struct itimerval soon = {.it_value.tv_usec = 20000}, none = {.it_value.tv_usec = 0};
	signal(SIGVTALRM, tell_stop);
	setitimer(ITIMER_VIRTUAL, &soon, NULL);
	touchstone_run(engine, &(struct touchstone_limits){1, INFINITY, &stop}, NULL);
	setitimer(ITIMER_VIRTUAL, &none, NULL);
	touchstone_status(engine, &status);
	print_message("stopped after %llu looks and %llu events\n", (unsigned long long)status.lookups,
				  (unsigned long long)status.events);
	assert_in_range(status.lookups, 1, 1 << 22);
	touchstone_destroy(engine);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_stop_changes_nothing),
		cmocka_unit_test(a_stop_after_other_units_changes_nothing),
		cmocka_unit_test(a_state_survives_to_the_last_bit),
		cmocka_unit_test(other_scenes_and_arithmetics_are_refused),
		cmocka_unit_test(altered_states_do_no_harm),
		cmocka_unit_test(a_run_can_be_stopped_where_time_stands_still),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}

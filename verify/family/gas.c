/* What an engine's search asks: small gases of hard spheres are run, and after every event each particle that took part
 * is asked about its neighbours, the walls, and the faces of its search cell, as the engine itself would. Positions and
 * velocities are those the engine holds. Lengths are in diameters; kT = m = 1 at the start. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "family/make.h"
#include "oracle/oracle.h"
#include "scene/scene.h"

enum {
	PARTICLES = 108,    /* 4 x 3^3: fills the lattice */
	EQUILIBRATE = 8,    /* elastic collisions per particle, which forget the lattice */
	COOL = 4,           /* collisions per particle by the gas's own law before it is asked */
	MOST_EVENTS = 1000, /* of one run; a cooling gas is then begun anew */
	MOST_RUNS = 64,     /* of one block */
};

struct gas {
	double density, restitution;
	double reach; /* of a search, along each axis: one and a half cells of one particle each */
	double shell; /* asked about instead of contact; 0: none */
};

struct harvest {
	const struct gas *gas;
	enum touchstone_shape shape;
	struct touchstone_scene scene;
	struct touchstone_engine *engine;
	struct oracle *oracle; /* knows when shells are crossed */
	double position[PARTICLES][3], velocity[PARTICLES][3];
	uint32_t involved[2];       /* in what happened last */
	int involved_count;         /* 0: nothing has happened */
	bool crossing;              /* the two are crossing their shell, */
	enum touchstone_shape from; /* on which they were asked this before */
	double (*numbers)[TOUCHSTONE_MOST_NUMBERS];
	size_t count;
};

/* ---- the run */

static void note_event(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	struct harvest *harvest = context;
	harvest->involved[0] = event->first;
	harvest->involved[1] = event->second;
	harvest->involved_count = event->kind == TOUCHSTONE_CONTACT ? 2 : 1;
}

/* Goes on by so many events, but not beyond `time`, and looks where everything is. */
static void advance(struct harvest *harvest, uint64_t events, double time)
{
	const struct touchstone_limits limits = {.events = events, .time = time};
	const struct touchstone_observer observer = {note_event, harvest};
	harvest->involved_count = 0;
	harvest->crossing = false;
	touchstone_run(harvest->engine, &limits, &observer);
	for (uint32_t p = 0; p < PARTICLES; p++)
		touchstone_state(harvest->engine, p, harvest->position[p], harvest->velocity[p]);
}

/* From the second particle to the first, nearest image. Whether they are neighbours: in reach of
 * a search through 27 cells. */
static bool relative(const struct harvest *harvest, uint32_t first, uint32_t second, double r[3], double v[3])
{
	bool near = true;
	for (int axis = 0; axis < 3; axis++) {
		double box = harvest->scene.box[axis];
		r[axis] = harvest->position[first][axis] - harvest->position[second][axis];
		v[axis] = harvest->velocity[first][axis] - harvest->velocity[second][axis];
		if (harvest->scene.periodic[axis]) r[axis] -= fabs(r[axis]) > box / 2 ? copysign(box, r[axis]) : 0;
		near &= fabs(r[axis]) < harvest->gas->reach;
	}
	return near;
}

/* Square of the distance less that of the shell. */
static double beyond_shell(const struct gas *gas, const double r[3])
{
	return r[0] * r[0] + r[1] * r[1] + r[2] * r[2] - gas->shell * gas->shell;
}

/* The shape that a pair and its shell have for each other: inside they can only part, outside only meet. */
static enum touchstone_shape shell_shape(const struct gas *gas, const double r[3])
{
	return beyond_shell(gas, r) < 0 ? TOUCHSTONE_BALL_LEAVE : TOUCHSTONE_BALL_BALL;
}

/* Goes on to where one of the particle's neighbours first crosses the shell around it, if both are left in peace until
 * then. The engine has no square wells: nothing happens to the pair there, but it is asked about. */
static void advance_to_shell(struct harvest *harvest, uint32_t particle)
{
	double earliest = INFINITY;
	uint32_t partner = particle;
	for (uint32_t other = 0; other < PARTICLES; other++) {
		struct oracle_query query = {.ball.contact = harvest->gas->shell};
		if (other == particle || !relative(harvest, particle, other, query.ball.r, query.ball.v)) continue;
		query.shape = (enum oracle_shape)shell_shape(harvest->gas, query.ball.r);
		struct oracle_time time = oracle_solve(harvest->oracle, &query);
		double wait = oracle_round(harvest->oracle, &time, MPFR_RNDN);
		if (wait >= earliest) continue;
		earliest = wait;
		harvest->from = (enum touchstone_shape)query.shape;
		partner = other;
	}
	struct touchstone_status status;
	touchstone_status(harvest->engine, &status);
	if (partner == particle) return;
	advance(harvest, UINT64_MAX, status.time + earliest);
	touchstone_status(harvest->engine, &status);
	harvest->involved[0] = particle;
	harvest->involved[1] = partner;
	harvest->involved_count = status.verdict == TOUCHSTONE_DONE ? 2 : 0;
	harvest->crossing = true;
}

/* ---- the questions */

/* What is asked about a pair in a well. One that is just crossing is taken for what it becomes, on whichever side
 * rounding has put it, as an engine with logical states does (2016 paper). */
static enum touchstone_shape shape_to_ask(const struct harvest *harvest, uint32_t first, uint32_t second,
										  const double r[3])
{
	bool crossing = harvest->crossing && first == harvest->involved[0] && second == harvest->involved[1];
	if (!crossing || fabs(beyond_shell(harvest->gas, r)) > 1e-9) return shell_shape(harvest->gas, r);
	return harvest->from == TOUCHSTONE_BALL_LEAVE ? TOUCHSTONE_BALL_BALL : TOUCHSTONE_BALL_LEAVE;
}

static void ask(struct harvest *harvest, const double number[TOUCHSTONE_MOST_NUMBERS])
{
	if (harvest->count == FAMILY_BLOCK) return;
	memcpy(harvest->numbers[harvest->count++], number, TOUCHSTONE_MOST_NUMBERS * sizeof *number);
}

static void ask_neighbours(struct harvest *harvest, uint32_t particle, uint32_t asked_before)
{
	const struct gas *gas = harvest->gas;
	for (uint32_t other = 0; other < PARTICLES; other++) {
		double number[TOUCHSTONE_MOST_NUMBERS];
		if (other == particle || other == asked_before) continue;
		if (!relative(harvest, particle, other, number, number + 3)) continue;
		if (gas->shell > 0 && shape_to_ask(harvest, particle, other, number) != harvest->shape) continue;
		number[6] = gas->shell > 0 ? gas->shell : 1;
		ask(harvest, number);
	}
}

static void ask_walls(struct harvest *harvest, uint32_t particle)
{
	for (size_t w = 0; w < harvest->scene.wall_count; w++) {
		const struct touchstone_wall *wall = &harvest->scene.walls[w];
		double number[TOUCHSTONE_MOST_NUMBERS] = {[3] = 0.5};
		for (int axis = 0; axis < 3; axis++) {
			number[0] += (harvest->position[particle][axis] - wall->point[axis]) * wall->normal[axis];
			number[1] += harvest->velocity[particle][axis] * wall->normal[axis];
		}
		ask(harvest, number);
	}
}

/* Both faces of a cell of about one particle, on each axis. */
static void ask_faces(struct harvest *harvest, uint32_t particle)
{
	for (int axis = 0; axis < 3; axis++) {
		double box = harvest->scene.box[axis], cell = box / floor(box * 1.5 / harvest->gas->reach);
		double position = harvest->position[particle][axis], speed = harvest->velocity[particle][axis];
		double face = floor(position / cell) * cell;
		ask(harvest, (const double[TOUCHSTONE_MOST_NUMBERS]){position - face, speed});
		ask(harvest, (const double[TOUCHSTONE_MOST_NUMBERS]){face + cell - position, -speed});
	}
}

static void ask_all(struct harvest *harvest)
{
	uint32_t before = PARTICLES;
	for (int i = 0; i < harvest->involved_count; i++) {
		uint32_t particle = harvest->involved[i];
		if (harvest->shape == TOUCHSTONE_BALL_PLANE)
			ask_walls(harvest, particle);
		else if (harvest->shape == TOUCHSTONE_HALF_SPACE)
			ask_faces(harvest, particle);
		else
			ask_neighbours(harvest, particle, before);
		before = particle;
	}
}

/* ---- the harvest */

static bool begin(struct harvest *harvest, uint64_t seed, char error[160])
{
	static const struct scene_species ball[] = {{1, {1, 1}}};
	const struct scene_recipe recipe = {
		.dimensions = 3,
		.particle_count = PARTICLES,
		.density = harvest->gas->density,
		.boundary = {SCENE_PERIODIC, SCENE_PERIODIC, SCENE_WALLS},
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 1,
		.species = ball,
		.restitution = {TOUCHSTONE_CONSTANT, harvest->gas->restitution},
		.positions = SCENE_LATTICE,
		.velocities = SCENE_MAXWELL,
		.temperature = 1,
	};
	struct scene_error complaint;
	if (!scene_build(&recipe, seed, &harvest->scene, &complaint)) {
		snprintf(error, 160, "%s: %.100s", complaint.key, complaint.text);
		return false;
	}
	harvest->engine = touchstone_create(&harvest->scene, "binary64", "stable", error);
	if (!harvest->engine) {
		scene_free(&harvest->scene);
		return false;
	}
	struct touchstone_limits limits = {.events = EQUILIBRATE * PARTICLES / 2, .time = INFINITY};
	touchstone_elastic(harvest->engine, true);
	touchstone_run(harvest->engine, &limits, NULL);
	touchstone_elastic(harvest->engine, false);
	limits.events = COOL * PARTICLES / 2;
	if (harvest->gas->restitution < 1) touchstone_run(harvest->engine, &limits, NULL);
	return true;
}

static void run(struct harvest *harvest)
{
	for (int event = 0; event < MOST_EVENTS && harvest->count < FAMILY_BLOCK; event++) {
		bool to_shell = harvest->gas->shell > 0 && event % 2 == 1;
		if (to_shell)
			advance_to_shell(harvest, harvest->involved[0]);
		else
			advance(harvest, 1, INFINITY);
		if (harvest->involved_count == 0) break; /* the run is over: collapsed, for one */
		ask_all(harvest);
	}
	touchstone_destroy(harvest->engine);
	scene_free(&harvest->scene);
}

static bool harvest_gas(const struct gas *gas, enum touchstone_shape shape, uint64_t seed,
						double (*numbers)[TOUCHSTONE_MOST_NUMBERS], char error[160])
{
	struct harvest harvest = {.gas = gas, .shape = shape, .numbers = numbers};
	harvest.oracle = oracle_create();
	if (!harvest.oracle) {
		snprintf(error, 160, "no memory for the oracle");
		return false;
	}
	struct random_state random = random_seed(seed);
	bool good = true;
	for (int runs = 0; good && harvest.count < FAMILY_BLOCK; runs++) {
		good = runs < MOST_RUNS;
		if (!good) snprintf(error, 160, "%d runs of the engine ended without a harvest", MOST_RUNS);
		good = good && begin(&harvest, random_bits(&random), error);
		if (good) run(&harvest);
	}
	oracle_destroy(harvest.oracle);
	return good;
}

bool harvest_dense(enum touchstone_shape shape, uint64_t seed, double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
				   char error[160])
{
	static const struct gas gas = {.density = 0.8, .restitution = 1, .reach = 1.6};
	return harvest_gas(&gas, shape, seed, numbers, error);
}

bool harvest_dilute(enum touchstone_shape shape, uint64_t seed, double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
					char error[160])
{
	static const struct gas gas = {.density = 0.05, .restitution = 1, .reach = 4};
	return harvest_gas(&gas, shape, seed, numbers, error);
}

bool harvest_inelastic(enum touchstone_shape shape, uint64_t seed, double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
					   char error[160])
{
	static const struct gas gas = {.density = 0.5, .restitution = 0.5, .reach = 1.9};
	return harvest_gas(&gas, shape, seed, numbers, error);
}

/* The engine has no square wells yet: these are the shells of 1.5 diameters around its hard spheres. Between events the
 * run stops where a shell is crossed, so that half of what is asked is about pairs on or near theirs. */
bool harvest_wells(enum touchstone_shape shape, uint64_t seed, double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
				   char error[160])
{
	static const struct gas gas = {.density = 0.3, .restitution = 1, .reach = 2.25, .shell = 1.5};
	return harvest_gas(&gas, shape, seed, numbers, error);
}

/* The live page's engine: what its worker calls in WebAssembly. One or two panes run the same start in two arithmetics
 * or by two methods; what comes out is an array of discs to draw and an array of counts. Texts go in and out by one
 * buffer. The order of numbers is known to reports/live/worker.js. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "live/sequence.h"
#include "live/view.h"
#include "live/witness.h"
#include "scene/scene.h"
#include "touchstone.h"

#define EXPORT(name) __attribute__((export_name(#name)))

static const struct {
	const char *name, *title;
	struct scene_recipe recipe;
} scenes[] = {
#include "recipes.inl"
};
enum { SCENES = sizeof scenes / sizeof *scenes, PANES = 2, TEXT = 2048 };

static struct pane {
	struct touchstone_scene scene;
	struct touchstone_particle *now; /* the scene's own particles, where they are at the last look */
	struct touchstone_engine *engine;
	struct witness witness;
	struct view view;
	float *depth, *warmth; /* per particle */
	double idle;           /* how long ago the last event was, when none is left */
	double count[32];
} panes[PANES];

static struct sequence sequence; /* of both panes, as far as they agree */
static char text[TEXT];

/* ------------------------------------------------------------------ what there is */

EXPORT(live_text) char *live_text(void)
{
	return text;
}

EXPORT(live_scene_name) const char *live_scene_name(int scene)
{
	return scene < SCENES ? scenes[scene].name : NULL;
}

EXPORT(live_scene_title) const char *live_scene_title(int scene)
{
	return scenes[scene].title;
}

static bool is_open(const struct scene_recipe *recipe, int axis)
{
	return axis < recipe->dimensions && recipe->boundary[axis] == SCENE_OPEN;
}

/* dimensions; particles; whether their places are given; whether it hangs upright: gravity along its only axis; whether
 * there is no box to look into; whether pairs have states */
EXPORT(live_scene_fact) double live_scene_fact(int scene, int fact)
{
	const struct scene_recipe *recipe = &scenes[scene].recipe;
	const double facts[] = {recipe->dimensions,
							(double)recipe->particle_count,
							recipe->positions == SCENE_GIVEN,
							recipe->dimensions == 1 && recipe->acceleration[0] != 0,
							is_open(recipe, 0) || is_open(recipe, 1),
							recipe->potential_count > 0};
	return facts[fact];
}

/* Those methods that this build has. */
EXPORT(live_method) const char *live_method(int number)
{
	char error[160];
	const char *name;
	for (size_t m = 0; (name = touchstone_method_name(m)); m++)
		if (touchstone_drop("binary64", name, NULL, 0, NULL, NULL, NULL, error) && number-- == 0) return name;
	return NULL;
}

/* ------------------------------------------------------------------ a run */

static void close_pane(struct pane *pane)
{
	touchstone_destroy(pane->engine);
	scene_free(&pane->scene);
	witness_end(&pane->witness);
	view_end(&pane->view);
	free(pane->depth);
	free(pane->warmth);
	*pane = (struct pane){0};
}

EXPORT(live_close) void live_close(void)
{
	for (int p = 0; p < PANES; p++) close_pane(&panes[p]);
	sequence_clear(&sequence);
}

/* Makes a pane: the arithmetic and, after its NUL, the method stand in the text. Sizes are read in 2 dimensions, the
 * count wherever places are not given. Returns how many particles were placed; 0 with the reason in the text. */
EXPORT(live_open) double live_open(int number, int scene, double width, double height, double count, double seed)
{
	struct pane *pane = &panes[number];
	struct scene_recipe recipe = scenes[scene].recipe;
	struct scene_error complaint;
	char error[160], arithmetic[40], method[40];
	snprintf(arithmetic, sizeof arithmetic, "%s", text);
	snprintf(method, sizeof method, "%s", text + strlen(text) + 1);
	close_pane(pane);
	bool given = recipe.positions == SCENE_GIVEN;
	if (recipe.dimensions == 2 && !given) {
		recipe.density = 0;
		recipe.box[0] = width, recipe.box[1] = height;
		if (recipe.packing_limit == 0) recipe.packing_limit = 0.6;
	}
	if (!given) recipe.particle_count = (size_t)count;
	if (!scene_build(&recipe, (uint64_t)seed, &pane->scene, &complaint)) {
		snprintf(text, TEXT, "%s: %s", complaint.key, complaint.text);
		return 0;
	}
	size_t placed = pane->scene.particle_count;
	pane->now = (struct touchstone_particle *)pane->scene.particles;
	pane->engine = touchstone_create(&pane->scene, arithmetic, method, error);
	pane->depth = malloc(placed * sizeof *pane->depth);
	pane->warmth = malloc(placed * sizeof *pane->warmth);
	const bool open[3] = {is_open(&recipe, 0), is_open(&recipe, 1), is_open(&recipe, 2)};
	struct touchstone_status status;
	if (pane->engine) touchstone_status(pane->engine, &status);
	if (pane->engine && pane->depth && pane->warmth && witness_begin(&pane->witness, &pane->scene, status.bits) &&
		view_begin(&pane->view, &pane->scene, open))
		return (double)placed;
	snprintf(text, TEXT, "%s", pane->engine ? "not enough memory" : error);
	close_pane(pane);
	return 0;
}

EXPORT(live_box) double live_box(int number, int axis)
{
	return axis < panes[number].scene.dimensions ? panes[number].scene.box[axis] : 0;
}

EXPORT(live_wall_count) int live_wall_count(int number)
{
	return (int)panes[number].scene.wall_count;
}

/* A wall as view_wall() has it; NULL: it is not drawn. */
EXPORT(live_wall) double *live_wall(int number, int wall)
{
	static double drawn[4];
	return view_wall(&panes[number].view, (size_t)wall, drawn) ? drawn : NULL;
}

EXPORT(live_ring) double live_ring(int number)
{
	return view_ring(&panes[number].view);
}

EXPORT(live_time) double live_time(int number)
{
	struct touchstone_status status;
	touchstone_status(panes[number].engine, &status);
	return status.time;
}

/* Whether a run has come to an end of its own: by a verdict, or because no event is left. */
EXPORT(live_ended) bool live_ended(int number)
{
	struct touchstone_status status;
	touchstone_status(panes[number].engine, &status);
	return status.verdict != TOUCHSTONE_DONE || panes[number].idle > 0;
}

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct pane *pane = context;
	witness_see(&pane->witness, engine, event);
	if (panes[1].engine) sequence_enter(&sequence, pane == &panes[1], event);
}

/* The time that has passed without an event where none is left: a clock that stays behind by more than the rounding of
 * the time it was to reach. */
static double idle_time(const struct touchstone_status *status, double time)
{
	double behind = time - status->time;
	bool over = status->verdict == TOUCHSTONE_DONE && isfinite(time) && behind > ldexp(fabs(time), 2 - status->bits);
	return over ? behind : 0;
}

/* Runs to a time, `most` events at most. Returns how many events there have been in all. */
EXPORT(live_run) double live_run(int number, double time, double most)
{
	struct pane *pane = &panes[number];
	struct touchstone_observer observer = {see, pane};
	struct touchstone_status before, status;
	touchstone_status(pane->engine, &before);
	touchstone_run(pane->engine, &(struct touchstone_limits){(uint64_t)most, time, NULL}, &observer);
	touchstone_status(pane->engine, &status);
	pane->idle = status.events < before.events + (uint64_t)most ? idle_time(&status, time) : 0;
	if (status.verdict == TOUCHSTONE_HALTED || status.verdict == TOUCHSTONE_DIVERGED) {
		witness_stop(&pane->witness, status.time);
		if (panes[1].engine) sequence_end(&sequence, pane == &panes[1]);
	}
	return (double)status.events;
}

/* ------------------------------------------------------------------ what is seen */

/* Sums over all particles. */
struct sums {
	double energy, momentum[3], squares; /* of speeds */
};

/* Where no event is left and nothing bounds the flight, everything flies on. */
static void fly_on(const struct pane *pane, struct touchstone_particle *particle)
{
	if (!pane->view.open) return;
	for (int axis = 0; axis < pane->scene.dimensions; axis++) {
		double gained = pane->scene.acceleration[axis] * pane->idle;
		particle->position[axis] += (particle->velocity[axis] + gained / 2) * pane->idle;
		particle->velocity[axis] += gained;
	}
}

/* Where everything is, and the sums over it. */
static struct sums look(struct pane *pane)
{
	struct sums sums = {0};
	for (uint32_t p = 0; p < pane->scene.particle_count; p++) {
		struct touchstone_particle *particle = &pane->now[p];
		touchstone_state(pane->engine, p, particle->position, particle->velocity);
		if (pane->idle > 0) fly_on(pane, particle);
		double mass = pane->scene.species[particle->species].mass;
		for (int axis = 0; axis < pane->scene.dimensions; axis++) {
			double speed = particle->velocity[axis];
			sums.energy += mass * speed * speed / 2;
			sums.squares += speed * speed;
			sums.momentum[axis] += mass * speed;
			if (!pane->scene.periodic[axis])
				sums.energy -= mass * pane->scene.acceleration[axis] * particle->position[axis];
		}
	}
	return sums;
}

/* From 0 to 1: a particle's temperature, or in a scene without heat its speed over twice the mean one. */
static void warm(struct pane *pane, double squares)
{
	double usual = 2 * sqrt(squares / (double)pane->scene.particle_count);
	for (uint32_t p = 0; p < pane->scene.particle_count; p++) {
		const double *v = pane->now[p].velocity;
		double warmth = touchstone_temperature(pane->engine, p);
		if (isnan(warmth)) warmth = usual > 0 ? sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / usual : 0;
		pane->warmth[p] = (float)fmin(warmth, 1);
	}
}

/* Makes discs and lines as view.h has them, and counts; false when there is no memory. */
EXPORT(live_look) bool live_look(int number)
{
	struct pane *pane = &panes[number];
	struct sums sums = look(pane);
	struct touchstone_status status;
	touchstone_status(pane->engine, &status);
	struct witness *witness = &pane->witness;
	warm(pane, sums.squares);
	if (!witness_look(witness, &pane->scene, status.time + pane->idle, pane->depth) ||
		!view_discs(&pane->view, pane->warmth, pane->depth) || !view_lines(&pane->view, pane->engine))
		return false;
	const double counts[] = {
		(double)status.events,
		(double)status.collisions,
		status.time + pane->idle,
		sums.energy + status.potential_energy,
		sums.momentum[0],
		sums.momentum[1],
		sums.momentum[2],
		status.kicked_energy,
		(double)witness->overlapping,
		(double)witness->entangled,
		(double)witness->dropped,
		(double)witness->repeated,
		(double)witness->parting,
		(double)witness->backwards,
		witness->deepest,
		witness->deepest_ever,
		witness->first_failure,
		witness->first_sight,
		(double)status.verdict,
		(double)(status.digest >> 32),
		(double)(status.digest & UINT32_MAX),
		(double)pane->scene.particle_count,
		(double)witness->three_body.events,
		(double)status.captures,
		(double)status.releases,
		(double)status.bounces,
		(double)status.captured,
		(double)pane->view.discs,
		(double)pane->view.lines,
	};
	_Static_assert(sizeof counts <= sizeof pane->count, "room for all counts");
	memcpy(pane->count, counts, sizeof counts);
	return true;
}

EXPORT(live_discs) float *live_discs(int number)
{
	return panes[number].view.disc;
}

EXPORT(live_lines) float *live_lines(int number)
{
	return panes[number].view.line;
}

EXPORT(live_bounds) double *live_bounds(int number)
{
	return panes[number].view.bounds;
}

EXPORT(live_counts) double *live_counts(int number)
{
	return panes[number].count;
}

/* The reason of a verdict, and the last events a line each, newest first, into the text. */
EXPORT(live_tell) char *live_tell(int number)
{
	static const char *const kinds[] = {[TOUCHSTONE_CONTACT] = "meets",
										[TOUCHSTONE_WALL] = "meets wall",
										[TOUCHSTONE_CAPTURE] = "captures",
										[TOUCHSTONE_RELEASE] = "lets go of",
										[TOUCHSTONE_BOUNCE] = "turns back at"};
	const struct pane *pane = &panes[number];
	const struct witness *witness = &pane->witness;
	struct touchstone_status status;
	touchstone_status(pane->engine, &status);
	size_t length = (size_t)snprintf(text, TEXT, "%s", status.reason);
	for (uint64_t k = 1; k <= WITNESS_LOG && k <= witness->seen; k++) {
		const struct touchstone_event *event = &witness->log[(witness->seen - k) % WITNESS_LOG];
		length +=
			(size_t)snprintf(text + length, TEXT - length, "\n%.17g\t%u %s %u\t%lld\t%.6g", event->time, event->first,
							 kinds[event->kind], event->second, (long long)event->steps, event->approach);
	}
	return text;
}

/* Events that both panes have in common before they first differ; negative, less 1, while they have not. */
EXPORT(live_horizon) double live_horizon(void)
{
	return sequence.differ ? (double)sequence.common : -1 - (double)sequence.common;
}

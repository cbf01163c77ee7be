#include "figure/gas_points.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "figure/figure_campaign.h"

static const uint64_t most_per_piece = 10000000; /* events: some ten seconds to a few minutes */

struct points {
	const struct figure_setup *setup;
	const struct gas_point *point;
	size_t *first; /* piece of each point, and at the end how many there are */
	size_t count;
};

static size_t pieces_of(const struct gas_point *point)
{
	return (size_t)((point->events + most_per_piece - 1) / most_per_piece);
}

static size_t point_of(const struct points *points, size_t piece)
{
	size_t p = 0;
	while (points->first[p + 1] <= piece) p++;
	return p;
}

static struct kept_setup piece_setup(const struct points *points, size_t piece)
{
	size_t number = point_of(points, piece), part = piece - points->first[number];
	const struct gas_point *point = &points->point[number];
	uint64_t pieces = pieces_of(point);
	return (struct kept_setup){
		.particles = point->particles,
		.density = point->density,
		.restitution = point->restitution,
		.arithmetic = point->arithmetic,
		.method = "stable",
		.form = point->form,
		.clock = point->clock,
		.equilibrate = 20,
		.settle = point->restitution < 1 ? 20 : 0,
		.events = point->events * (part + 1) / pieces - point->events * part / pieces,
		.starts = point->starts ? point->starts : 8,
		.halvings = point->halvings ? point->halvings : 1,
		.seed = points->setup->seed * 100000 + part,
	};
}

static void piece_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	struct kept_setup one = piece_setup(context, piece);
	snprintf(key, CAMPAIGN_KEY,
			 "arithmetic=%s restitution=%.17g density=%.17g particles=%zu form=%s clock=%.17g equilibrate=%g settle=%g "
			 "events=%" PRIu64 " starts=%d halvings=%d seed=%" PRIu64,
			 one.arithmetic, one.restitution, one.density, one.particles,
			 one.form == TOUCHSTONE_ABSOLUTE ? "absolute" : "relative", one.clock, one.equilibrate, one.settle,
			 one.events, one.starts, one.halvings, one.seed);
}

/* Arithmetics in software take longer, and the coarsest, in which nothing can be sifted out, longest. */
static double piece_cost(void *context, size_t piece)
{
	const struct points *points = context;
	const struct gas_point *point = &points->point[point_of(points, piece)];
	double each = point->bits == 24 || point->bits == 53 ? 1 : point->bits < 10 ? 300 : point->bits < 14 ? 20 : 5;
	return each * (double)piece_setup(points, piece).events;
}

static json_t *whole(uint64_t value)
{
	return json_integer((json_int_t)value);
}

static json_t *make_piece(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR])
{
	struct kept_setup one = piece_setup(context, piece);
	struct figure_piece progress = {watch, 0,
									(double)one.events + (one.equilibrate + one.settle) / 2 * (double)one.particles};
	struct watch look = {watch->stop, figure_piece_report, &progress};
	struct kept_gas gas;
	struct timespec begin, end;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
	bool through = kept_gas_run(&one, &look, &gas, error);
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
	kept_gas_free(&gas);
	if (!through) return NULL;
	const struct three_body *three_body = &gas.mishaps.three_body;
	double seconds = (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
	return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:{s:f}}", "contacts",
					 whole(three_body->contacts), "overlapping", whole(three_body->overlapping), "events",
					 whole(three_body->events), "encounters", whole(three_body->encounters), "depth",
					 campaign_number(three_body->depth), "deepest", campaign_number(three_body->deepest), "repeated",
					 whole(gas.mishaps.repeated), "entangled", whole(gas.mishaps.entangled), "collapsed",
					 whole(gas.collapsed), "halted", whole(gas.halted), "diverged", whole(gas.diverged), "starts",
					 whole(gas.starts), "recentred", whole(gas.recentred), "dropped", whole(gas.dropped), "drift",
					 campaign_number(gas.drift), "made", "seconds", seconds);
}

static uint64_t count_of(const json_t *piece, const char *member)
{
	return (uint64_t)json_integer_value(json_object_get(piece, member));
}

static void add_piece(struct gas_tally *tally, const json_t *piece, uint64_t events)
{
	const struct three_body three_body = {
		.contacts = count_of(piece, "contacts"),
		.overlapping = count_of(piece, "overlapping"),
		.events = count_of(piece, "events"),
		.encounters = count_of(piece, "encounters"),
		.depth = campaign_value(piece, "depth"),
		.deepest = campaign_value(piece, "deepest"),
	};
	three_body_merge(&tally->three_body, &three_body);
	tally->repeated += count_of(piece, "repeated");
	tally->entangled += count_of(piece, "entangled");
	tally->collapsed += count_of(piece, "collapsed");
	tally->halted += count_of(piece, "halted");
	tally->diverged += count_of(piece, "diverged");
	tally->starts += count_of(piece, "starts");
	tally->recentred += count_of(piece, "recentred");
	tally->dropped += count_of(piece, "dropped");
	tally->drift += campaign_value(piece, "drift");
	tally->finished += events;
	tally->seconds += json_number_value(json_object_get(json_object_get(piece, "made"), "seconds"));
}

bool gas_points_measure(const char *name, const struct figure_setup *setup, const struct gas_point *points,
						size_t count, struct gas_tally *tally, bool *stopped, char error[512])
{
	struct points all = {setup, points, calloc(count + 1, sizeof *all.first), count};
	if (!all.first) {
		snprintf(error, 512, "not enough memory");
		return false;
	}
	for (size_t p = 0; p < count; p++) all.first[p + 1] = all.first[p] + pieces_of(&points[p]);
	const struct campaign campaign = {name, all.first[count], piece_key, piece_cost, make_piece, &all};
	json_t *results = figure_campaign_run(&campaign, setup, error);
	if (results) {
		*stopped = campaign_finished(results) < campaign.count;
		for (size_t p = 0; p < count; p++) {
			tally[p] = (struct gas_tally){0};
			for (size_t piece = all.first[p]; piece < all.first[p + 1]; piece++) {
				const json_t *found = json_array_get(results, piece);
				if (json_is_object(found)) add_piece(&tally[p], found, piece_setup(&all, piece).events);
			}
		}
	}
	json_decref(results);
	free(all.first);
	return results;
}

bool gas_lasted(const struct gas_tally *tally)
{
	return tally->three_body.contacts > 0 && tally->three_body.contacts >= tally->finished / 2;
}

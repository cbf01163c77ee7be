#include "figure/horizon_study.h"

#include "figure/figure_campaign.h"
#include "measure/start_state.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const char *const ladder[STUDY_RUNGS] = {
	"short:8",  "short:9",  "short:10", "short:11", "short:12", "short:13", "short:14",  "short:15", "short:16",
	"short:17", "short:18", "short:19", "short:20", "short:21", "short:22", "short:23",  "binary32", "short:25",
	"mpfr:32",  "mpfr:40",  "binary64", "extended", "mpfr:80",  "twin",     "binary128", "mpfr:160", "mpfr:200"};

/* What one's machine has of the ladder, down to the finest that is wanted. */
struct horizon_study horizon_study_choose(const struct figure_setup *setup)
{
	struct horizon_study quick = {.setup = setup,
								  .spheres = 108,
								  .starts = 20,
								  .box = {10, 6, 5},
								  .equilibrate = 20,
								  .turning = 30,
								  .growing = 200};
	struct horizon_study full = quick;
	full.spheres = 500;
	full.starts = STUDY_STARTS;
	full.box[0] = 17, full.box[1] = 10, full.box[2] = 8.25;
	full.growing = 1000;
	struct horizon_study study = setup->full ? full : quick;
	char error[160];
	size_t most = setup->full ? STUDY_RUNGS : STUDY_RUNGS - 1;
	for (size_t k = 0; k < most; k++) {
		int bits = horizon_bits(ladder[k], error);
		if (!bits) continue;
		study.rung[study.rungs] = ladder[k];
		study.bits[study.rungs++] = bits;
	}
	return study;
}

double horizon_study_density(const struct horizon_study *study, size_t d)
{
	return (double)study->spheres / pow(study->box[d], 3);
}

/* What comes of one start state. */
struct start {
	bool done;
	struct horizon horizon[STUDY_RUNGS];
	struct tangent_growth tangent;
};

/* ------------------------------------------------------------------ pieces: one start state each */

static uint64_t seed_of(const struct horizon_study *study, size_t piece)
{
	return study->setup->seed + piece % study->starts;
}

static void piece_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	const struct horizon_study *study = context;
	snprintf(key, CAMPAIGN_KEY, "spheres=%zu box=%g seed=%" PRIu64 " finest=%s growing=%g", study->spheres,
			 study->box[piece / study->starts], seed_of(study, piece), study->rung[study->rungs - 1], study->growing);
}

/* The denser, the more events until two arithmetics part. */
static double piece_cost(void *context, size_t piece)
{
	return horizon_study_density(context, piece / ((const struct horizon_study *)context)->starts);
}

static json_t *start_json(const struct horizon_study *study, const struct horizon *horizon,
						  const struct tangent_growth *growth)
{
	json_t *horizons = json_array();
	for (size_t rung = 0; rung < study->rungs; rung++)
		json_array_append_new(horizons,
							  json_pack("{s:s, s:I, s:f, s:f, s:b}", "arithmetic", study->rung[rung], "events",
										(json_int_t)horizon[rung].events, "per_particle", horizon[rung].per_particle,
										"time", horizon[rung].time, "differ", horizon[rung].differ));
	return json_pack("{s:o, s:{s:f, s:f, s:f}}", "horizons", horizons, "tangent", "growth", growth->growth,
					 "per_particle", growth->per_particle, "time", growth->time);
}

static struct start start_of_json(const struct horizon_study *study, const json_t *json)
{
	struct start start = {.done = json_is_object(json)};
	for (size_t rung = 0; start.done && rung < study->rungs; rung++) {
		const json_t *one = json_array_get(json_object_get(json, "horizons"), rung);
		start.horizon[rung] = (struct horizon){
			.events = (uint64_t)json_integer_value(json_object_get(one, "events")),
			.per_particle = json_real_value(json_object_get(one, "per_particle")),
			.time = json_real_value(json_object_get(one, "time")),
			.differ = json_is_true(json_object_get(one, "differ")),
		};
	}
	const json_t *tangent = json_object_get(json, "tangent");
	start.tangent.growth = json_real_value(json_object_get(tangent, "growth"));
	start.tangent.per_particle = json_real_value(json_object_get(tangent, "per_particle"));
	start.tangent.time = json_real_value(json_object_get(tangent, "time"));
	return start;
}

static json_t *make_piece(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR])
{
	const struct horizon_study *study = context;
	struct scene_recipe recipe = start_spheres(study->spheres, 0);
	for (int axis = 0; axis < 3; axis++) recipe.box[axis] = study->box[piece / study->starts];
	const struct watch look = {.stop = watch->stop};
	const struct touchstone_limits limits = {.events = course_events(10000, study->spheres), .time = INFINITY};
	const struct horizon_ladder climbed = {study->rungs, study->rung, "mpfr:256"};
	struct touchstone_scene scene;
	struct horizon horizon[STUDY_RUNGS];
	struct tangent_growth growth;
	char why[160];
	bool made = start_scene(&recipe, seed_of(study, piece), study->equilibrate, &look, &scene, why);
	bool good = made && horizon_ladder_climb(&climbed, &scene, &limits, &look, horizon, why) &&
				!horizon[study->rungs - 1].stopped;
	if (good) {
		watch->progress(watch, 0.95);
		good = tangent_grow(&scene, seed_of(study, piece), study->turning, study->growing, &look, &growth, why);
	}
	if (made) scene_free(&scene);
	bool stopped = watch->stop && *watch->stop;
	snprintf(error, CAMPAIGN_ERROR, "%s", good || stopped ? "" : why);
	return good && !stopped ? start_json(study, horizon, &growth) : NULL;
}

/* ------------------------------------------------------------------ all together */

static struct horizon_finding find(const struct horizon_study *study, const struct start *starts)
{
	struct horizon_finding finding = {0};
	double values[STUDY_STARTS], times[STUDY_STARTS], slopes[2][STUDY_STARTS], grown[2][STUDY_STARTS], intercepts = 0;
	size_t first = 0;
	while (study->bits[first] < STUDY_FITTED_FROM) first++;
	for (size_t s = 0; s < study->starts; s++) {
		if (!starts[s].done) continue;
		double per_particle[STUDY_RUNGS], time[STUDY_RUNGS];
		for (size_t rung = 0; rung < study->rungs; rung++) {
			per_particle[rung] = starts[s].horizon[rung].per_particle;
			time[rung] = starts[s].horizon[rung].time;
		}
		struct line_fit line = fit_line(study->bits + first, per_particle + first, study->rungs - first);
		slopes[0][finding.starts] = line.slope;
		slopes[1][finding.starts] = fit_line(study->bits + first, time + first, study->rungs - first).slope;
		grown[0][finding.starts] = starts[s].tangent.growth / starts[s].tangent.per_particle;
		grown[1][finding.starts++] = starts[s].tangent.growth / starts[s].tangent.time;
		intercepts += line.intercept;
	}
	finding.intercept = intercepts / (double)finding.starts;
	finding.slope = estimate_mean(slopes[0], finding.starts);
	for (int unit = 0; unit < 2; unit++) {
		finding.by_slope[unit] = estimate_exponent(estimate_mean(slopes[unit], finding.starts));
		finding.by_tangent[unit] = estimate_mean(grown[unit], finding.starts);
	}
	for (size_t rung = 0; rung < study->rungs; rung++) {
		size_t count = 0;
		for (size_t s = 0; s < study->starts; s++) {
			if (!starts[s].done) continue;
			values[count] = starts[s].horizon[rung].per_particle;
			times[count++] = starts[s].horizon[rung].time;
		}
		finding.horizon[rung] = estimate_mean(values, count);
		finding.time[rung] = estimate_mean(times, count);
		finding.deviation[rung] = finding.horizon[rung].error * sqrt((double)count);
	}
	return finding;
}

bool horizon_study_run(struct horizon_study *study, struct horizon_finding finding[STUDY_DENSITIES], size_t *finished,
					   size_t *all, char error[512])
{
	const struct figure_setup *setup = study->setup;
	const size_t pieces = *all = STUDY_DENSITIES * study->starts;
	const struct campaign campaign = {"horizon", pieces, piece_key, piece_cost, make_piece, study};
	json_t *results = figure_campaign_run(&campaign, setup, error);
	if (!results) return false;
	*finished = campaign_finished(results);
	struct start *starts = calloc(pieces, sizeof *starts);
	if (!starts) snprintf(error, 512, "not enough memory");
	for (size_t p = 0; starts && p < pieces; p++) starts[p] = start_of_json(study, json_array_get(results, p));
	for (size_t d = 0; starts && d < STUDY_DENSITIES; d++) finding[d] = find(study, starts + d * study->starts);
	json_decref(results);
	bool good = starts;
	free(starts);
	return good;
}

/* Figures 4 and 6 of the 2014 paper: three bodies in contact, event by event, and what each method makes of it. */
#include "figure/figure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/cases.h"
#include "measure/trace.h"
#include "store/scene_file.h"

static const char *const methods[] = {"stable", "naive", "rewind", "skip", "search", "shrink", "tc"};
enum { METHODS = sizeof methods / sizeof *methods, BALLS = 3, MOST_EVENTS = 4 };

struct stage {
	struct result_figure figure;
	struct result_table table;
};

/* Distances near contact as they are drawn: touching where they touch, far apart where they are, and a difference of
 * one representable number already visible. */
static double drawn(double distance)
{
	double ulps = (distance - 1) / 0x1p-53;
	return 1 + copysign(0.35 * (1 - 1 / (1 + 0.3 * log2(1 + fabs(ulps)))), ulps);
}

/* The balls as they are now, with the last event of the trace, if any. */
static void draw(struct result_figure figure, const struct touchstone_engine *engine, const char *method,
				 const char *when, const struct trace_event *last, const char *note)
{
	double position[BALLS][3], velocity[BALLS][3], shown[BALLS] = {0};
	for (uint32_t b = 0; b < BALLS; b++) touchstone_state(engine, b, position[b], velocity[b]);
	shown[0] = -drawn(position[1][0] - position[0][0]);
	shown[2] = drawn(position[2][0] - position[1][0]);
	struct figure_series series = figure_series(figure, method, SERIES_POINTS);
	for (uint32_t b = 0; b < BALLS; b++) {
		double speed = velocity[b][0];
		bool touched = last && (last->event.first == b || last->event.second == b);
		series_row(series,
				   (double[]){shown[b], 0.5, copysign(0.8 * sqrt(fabs(speed)), speed), touched, position[b][0], speed});
	}
	series_panel(series, method, when, note);
}

static void tell(struct result_table table, const char *method, size_t number, const struct trace_event *one)
{
	table_row(table);
	table_text(table, "%s", method);
	table_count(table, number);
	table_text(table, "%u and %u", one->event.first, one->event.second);
	table_text(table, "%.17g", one->event.time);
	table_number(table, one->wait);
	table_text(table, "%lld", (long long)one->event.steps);
	table_text(table, "%s", one->stabilising ? "stabilising" : one->backwards ? "back in time" : "-");
	table_text(table, "%.17g and %.17g", one->body[0].velocity[0], one->body[1].velocity[0]);
}

/* Runs the scene by one method; the trace is the caller's to free. */
static bool play(const struct stage *stage, const struct touchstone_scene *scene, const char *method,
				 struct trace *trace, struct touchstone_status *status, char error[512])
{
	static const char *const when[] = {"start", "event 1", "event 2", "event 3", "event 4", "event 5"};
	const struct touchstone_limits limits = {.events = MOST_EVENTS, .time = INFINITY};
	char why[160];
	struct touchstone_engine *engine = touchstone_create(scene, "binary64", method, why);
	bool good = engine && trace_begin(trace, engine);
	if (!good) snprintf(error, 512, "%s: %s", method, engine ? "out of memory" : why);
	if (good) draw(stage->figure, engine, method, when[0], NULL, "");
	for (size_t e = 0; good && e < MOST_EVENTS && trace_step(trace, engine, &limits, NULL); e++) {
		const struct trace_event *one = &trace->events[e];
		char note[80];
		snprintf(note, sizeof note, "%u and %u, %lld ulp%s", one->event.first, one->event.second,
				 (long long)one->event.steps,
				 one->stabilising ? ", stabilising"
				 : one->backwards ? ", back in time"
								  : "");
		draw(stage->figure, engine, method, when[e + 1], one, note);
		tell(stage->table, method, e + 1, one);
	}
	if (engine) touchstone_status(engine, status);
	if (good && status->verdict == TOUCHSTONE_HALTED)
		draw(stage->figure, engine, method, when[trace->count + 1], NULL, "halts: a negative time");
	touchstone_destroy(engine);
	return good;
}

static void add_claims(struct result *result, const struct trace *stable, bool parted, bool naive_halts)
{
	size_t stabilising = 0;
	for (size_t e = 0; e < stable->count; e++) stabilising += stable->events[e].stabilising;
	bool as_drawn = stable->count == 3 && stabilising == 1 && stable->events[2].stabilising && parted;
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "events by the stable rule, stabilising ones among them",
					 .reported = "two impacts, then a stabilising collision of the first pair, and all part",
					 .where = "2014, section 4.2 and fig. 6",
					 .measured = (double)stable->count,
					 .unit = "events",
					 .shown = as_drawn ? "3 events; the third is stabilising, and no event is left" : NULL,
					 .verdict = as_drawn ? RESULT_AGREES : RESULT_DIFFERS,
					 .why = "A stabilising event is one at the very time of the pair's last event, below contact. "
							"The start state was searched for: the figure is a sketch and gives no numbers.",
				 });
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "the textbook's roots on the same state",
					 .reported = "negative values of dt for overlapped pairs",
					 .where = "2014, section 3 and fig. 4",
					 .measured = NAN,
					 .shown = naive_halts ? "a negative time, and the run halts" : "no negative time",
					 .verdict = naive_halts ? RESULT_AGREES : RESULT_DIFFERS,
					 .why = "Textbook roots round the two impacts to the other order: the outer pair meets first, "
							"and the inner pair, driven together, is found overlapped.",
				 });
}

static bool play_all(struct result *result, const struct touchstone_scene *scene, char error[512])
{
	static const char *const columns[] = {"x", "radius", "speed", "touched", "position", "velocity", NULL};
	static const char *const heads[] = {"method", "event",      "between",          "time", "wait",
										"ulp",    "what it is", "velocities after", NULL};
	struct stage stage = {
		result_figure(
			result,
			&(struct figure_frame){
				.name = "discs",
				.kind = "discs",
				.title = "Three balls on a line, event by event",
				.caption = "Methods down, events across. The two that have just collided are drawn bold. Gaps and "
						   "overlaps are strongly exaggerated, as in the paper's figures: one representable number "
						   "of overlap (10^-16 diameters) can be seen. Arrows grow with the square root of the speed, "
						   "and show velocities after the event.",
				.alternative = "By the stable rule balls 0 and 1 collide, then 1 and 2, then 0 and 1 once more, "
							   "marked as stabilising; naive and search halt, rewind goes back in time, skip "
							   "leaves the last collision out.",
				.x = {"", 0, {0, 0}},
				.y = {"", 0, {0, 0}},
				.columns = columns,
			}),
		result_table(result, "Events",
					 "Wait: since the later of the pair's last events. ulp: separation less contact, in representable "
					 "numbers of binary64. Replayed by `touchstone run three-body --trace --method METHOD`.",
					 heads),
	};
	struct trace trace[METHODS] = {{0}};
	struct touchstone_status status[METHODS] = {{0}};
	bool good = true;
	for (int m = 0; good && m < METHODS; m++) good = play(&stage, scene, methods[m], &trace[m], &status[m], error);
	if (good)
		add_claims(result, &trace[0], status[0].verdict == TOUCHSTONE_DONE && status[0].events < MOST_EVENTS,
				   status[1].verdict == TOUCHSTONE_HALTED);
	for (int m = 0; m < METHODS; m++) {
		if (good && status[m].reason[0]) result_note(result, "%s: %s.", methods[m], status[m].reason);
		trace_free(&trace[m]);
	}
	return good;
}

struct result *figure_stepping(const struct figure_setup *setup, char error[512])
{
	char *path = cases_find(cases_folder(NULL), "three-body");
	struct scene_file *file = path ? scene_file_open(path, 0, NULL, error) : NULL;
	struct touchstone_scene scene;
	struct result *result = NULL;
	if (!path) snprintf(error, 512, "there is no case three-body in %s", cases_folder(NULL));
	bool built = file && scene_file_build(file, &scene, error);
	if (built && scene.particle_count == BALLS && scene.dimensions == 1)
		result = result_new("fig4", "Three bodies in contact, event by event");
	else if (built)
		snprintf(error, 512, "%s: accepted: three balls in one dimension", path);
	if (result) {
		result_paragraph(result,
						 "Three balls on a line, from cases/three-body.yaml: the second catches up with the first, the "
						 "third strikes the second 5 x 10^-16 later. By rounding the first pair overlaps when it is "
						 "driven together again. Each method runs the same start in binary64.");
		if (!play_all(result, &scene, error)) {
			result_free(result);
			result = NULL;
		}
	}
	if (built) scene_free(&scene);
	scene_file_close(file);
	free(path);
	if (setup->progress) setup->progress(setup->context, 1);
	return result;
}

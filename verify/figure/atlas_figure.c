/* The atlas of failures: what each method does in each stress scene, and from which precision on it survives. */
#include "figure/figure.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/cases.h"
#include "measure/failure.h"
#include "store/scene_file.h"

static const char *const names[] = {"dilute", "dense",  "inelastic", "near-collapse", "cradle",
									"column", "corner", "grazing",   "far-away",      "long-times"};
enum { SCENES = sizeof names / sizeof *names, MOST_METHODS = 32 };

/* Precisions, from coarse to fine: every one from 4 to 25 bits, then some. */
static const int ladder[] = {4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18,
							 19, 20, 21, 22, 23, 24, 25, 28, 32, 40, 46, 53, 64, 113};
enum { RUNGS = sizeof ladder / sizeof *ladder, PRODUCTION = RUNGS - 3, FINEST = RUNGS - 1 };

static const char *arithmetic_at(int rung, char name[16])
{
	int bits = ladder[rung];
	if (bits == 53) return "binary64";
	if (bits == 113) return "binary128";
	snprintf(name, 16, "%s:%d", bits <= 25 ? "short" : "mpfr", bits);
	return name;
}

/* One method in one scene. */
struct cell {
	struct failure failure; /* in binary64 */
	int rung;               /* coarsest at which it survives; RUNGS: none */
	struct failure below;   /* what happens one rung coarser, if there is one */
	bool done, refused;
	char error[160];
};

struct atlas {
	const struct figure_setup *setup;
	struct scene_file *file[SCENES];
	struct touchstone_scene scene[SCENES];
	int scenes; /* that have been made */
	const char *method[MOST_METHODS];
	int methods, done;
	struct touchstone_limits limits;
	struct cell (*cell)[SCENES];
};

/* No stress scene runs out of events of its own accord. */
static bool goes_well(enum failure_kind kind)
{
	return kind == FAILURE_NONE || kind == FAILURE_REST;
}

static bool survives(const struct atlas *atlas, int method, int scene, int rung, struct failure *failure,
					 char error[160])
{
	char name[16];
	const struct watch watch = {atlas->setup->stop, NULL, NULL};
	return failure_find(&atlas->scene[scene], 0, arithmetic_at(rung, name), atlas->method[method], &atlas->limits,
						&watch, failure, error) &&
		   !failure->stopped && goes_well(failure->kind);
}

/* In binary64, then by bisection where it begins to survive. */
static void fill(const struct atlas *atlas, int method, int scene, struct cell *cell)
{
	bool lives = survives(atlas, method, scene, PRODUCTION, &cell->failure, cell->error);
	struct failure failure = cell->failure;
	int low = lives ? -1 : PRODUCTION, high = lives ? PRODUCTION : RUNGS; /* it fails at low, survives at high */
	cell->refused = cell->error[0];
	if (cell->refused || failure.stopped) return;
	if (!lives) {
		cell->below = failure;
		if (survives(atlas, method, scene, FINEST, &failure, cell->error))
			high = FINEST;
		else
			low = FINEST, cell->below = failure;
	}
	while (high - low > 1 && !failure.stopped) {
		int middle = (low + high) / 2;
		if (survives(atlas, method, scene, middle, &failure, cell->error))
			high = middle;
		else
			low = middle, cell->below = failure;
	}
	cell->rung = high;
	cell->done = !failure.stopped;
}

static bool open_scenes(struct atlas *atlas, char error[512])
{
	for (; atlas->scenes < SCENES; atlas->scenes++) {
		int s = atlas->scenes;
		char name[40];
		snprintf(name, sizeof name, "stress/%s", names[s]);
		char *path = cases_find(cases_folder(NULL), name);
		atlas->file[s] = path ? scene_file_open(path, 0, NULL, error) : NULL;
		if (!path) snprintf(error, 512, "there is no case %s in %s", name, cases_folder(NULL));
		free(path);
		if (atlas->file[s] && scene_file_build(atlas->file[s], &atlas->scene[s], error)) continue;
		scene_file_close(atlas->file[s]);
		return false;
	}
	return true;
}

static void close_scenes(struct atlas *atlas)
{
	for (int s = 0; s < atlas->scenes; s++) {
		scene_free(&atlas->scene[s]);
		scene_file_close(atlas->file[s]);
	}
}

static void measure(struct atlas *atlas)
{
	int cells = atlas->methods * SCENES;
#pragma omp parallel for schedule(dynamic, 1) num_threads(atlas->setup->threads)
	for (int c = 0; c < cells; c++) {
		int scene = c / atlas->methods, method = c % atlas->methods;
		const volatile int *stop = atlas->setup->stop;
		if (!stop || !*stop) fill(atlas, method, scene, &atlas->cell[method][scene]);
#pragma omp critical(figure_progress)
		if (atlas->setup->progress) atlas->setup->progress(atlas->setup->context, (double)++atlas->done / cells);
	}
}

/* ------------------------------------------------------------------ as a result */

static unsigned level_of(enum failure_kind kind)
{
	static const unsigned levels[] = {0, 0, 3, 1, 2, 3, 3, 3, 4, 4, 4};
	return levels[kind];
}

static void write_bits(const struct cell *cell, char text[40])
{
	if (cell->rung == RUNGS)
		snprintf(text, 40, "never");
	else
		snprintf(text, 40, "%s%d bits", cell->rung ? "" : "<= ", ladder[cell->rung]);
}

static void add_glance(struct result *result, const struct atlas *atlas)
{
	const char *columns[SCENES + 2] = {"method"};
	for (int s = 0; s < SCENES; s++) columns[s + 1] = names[s];
	struct result_table table =
		result_table(result, "What happens",
					 "In binary64, with the first event that shows it; below that the least number of significand "
					 "bits with which the method survives the scene (4 to 25 one by one, then 28, 32, 40, 46, 53, 64, "
					 "113). To come to rest is right where the scene loses energy.",
					 columns);
	for (int m = 0; m < atlas->methods; m++) {
		table_row(table);
		table_text(table, "%s", atlas->method[m]);
		for (int s = 0; s < SCENES; s++) {
			const struct cell *cell = &atlas->cell[m][s];
			char bits[40], event[40] = "";
			write_bits(cell, bits);
			if (cell->failure.event) snprintf(event, sizeof event, "event %" PRIu64 "; ", cell->failure.event);
			if (cell->done)
				table_shaded(table, level_of(cell->failure.kind), "%s; %s%s", failure_word(cell->failure.kind), event,
							 bits);
			else
				table_text(table, "%s", cell->refused ? "refused" : "not run");
		}
	}
}

static void add_cells(struct result *result, const struct atlas *atlas)
{
	static const char *const columns[] = {"scene and method", "in binary64", "survives from", "to see it", NULL};
	struct result_table table =
		result_table(result, "Every cell", "In brackets what happens one step of precision below.", columns);
	for (int s = 0; s < SCENES; s++)
		for (int m = 0; m < atlas->methods; m++) {
			const struct cell *cell = &atlas->cell[m][s];
			const struct failure *failure = &cell->failure;
			char bits[40];
			if (!cell->done) continue;
			write_bits(cell, bits);
			table_row(table);
			table_text(table, "%s, %s", names[s], atlas->method[m]);
			if (failure->event)
				table_text(table, "%s at event %" PRIu64 ": %s", failure_word(failure->kind), failure->event,
						   failure->text);
			else
				table_text(table, "%s", failure_word(failure->kind));
			if (cell->rung > 0)
				table_text(table, "%s (%s)", bits, failure_word(cell->below.kind));
			else
				table_text(table, "%s", bits);
			table_text(table, "run stress/%s --method %s --events %" PRIu64 " --measure failure", names[s],
					   atlas->method[m], atlas->limits.events);
		}
}

static void add_claim(struct result *result, const struct atlas *atlas)
{
	int survived = 0, run = 0;
	for (int s = 0; s < SCENES; s++) {
		const struct cell *cell = &atlas->cell[0][s]; /* the first method is the stable rule */
		run += cell->done;
		survived += cell->done && goes_well(cell->failure.kind);
	}
	char shown[80];
	snprintf(shown, sizeof shown, "%d of %d stress scenes", survived, run);
	if (run == 0) return;
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "scenes that the stable rule survives in binary64",
					 .reported = "handles these situations in a stable and efficient manner",
					 .where = "2014, abstract",
					 .measured = survived,
					 .shown = shown,
					 .count = (uint64_t)run,
					 .verdict = survived == run ? RESULT_AGREES : RESULT_DIFFERS,
					 .why = "The table tells of the others. Which of them survive is a matter of the scenes, and "
							"of how long they run.",
				 });
}

static struct result *tell(const struct atlas *atlas)
{
	struct result *result = result_new("atlas", "Where methods fail");
	if (!result) return NULL;
	bool stopped = atlas->setup->stop && *atlas->setup->stop;
	result_paragraph(result,
					 "%d methods in %d scenes that are hard on floating point, %" PRIu64
					 " events each. A watcher checks "
					 "each run whenever its particles have had an event each: whether it halts or loops, whether time "
					 "runs backwards, whether particles are deep in one another and stay so, whether energy comes or "
					 "goes. Then bisection over the precision finds from how many bits on the method survives.",
					 atlas->methods, SCENES, atlas->limits.events);
	add_claim(result, atlas);
	add_glance(result, atlas);
	add_cells(result, atlas);
	result_note(result,
				"Deep is nearer than %g of the contact distance; energy may change by %g of its scale. An overlap "
				"that lasts ten checks is an entangled pair, one that clears is a pair that penetrates.",
				failure_depth, failure_energy);
	result_note(
		result,
		"Bisection takes it that a method that survives does so with more bits too. That is not certain: runs of "
		"different precision part after their horizon, and one may be luckier than another.");
	if (stopped) result_incomplete(result, "interrupted; cells that were not finished are missing");
	return result;
}

struct result *figure_atlas(const struct figure_setup *setup, char error[512])
{
	struct atlas atlas = {.setup = setup, .limits = {setup->full ? 1000000 : 2000, INFINITY, NULL}};
	const char *name;
	for (size_t n = 0; (name = touchstone_method_name(n)) && n < MOST_METHODS; n++)
		atlas.method[atlas.methods++] = name;
	struct result *result = NULL;
	atlas.cell = calloc((size_t)atlas.methods, sizeof *atlas.cell);
	if (!atlas.cell) snprintf(error, 512, "not enough memory");
	if (atlas.cell && open_scenes(&atlas, error)) {
		measure(&atlas);
		result = tell(&atlas);
	}
	close_scenes(&atlas);
	free(atlas.cell);
	return result;
}

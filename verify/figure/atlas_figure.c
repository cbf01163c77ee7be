/* The atlas of failures as a page: what each method does in each stress scene, and from which precision on it survives.
 */
#include "figure/figure.h"

#include <inttypes.h>
#include <stdio.h>

#include "figure/atlas.h"
#include "figure/atlas_live.h"

static unsigned level_of(enum failure_kind kind)
{
	static const unsigned levels[] = {0, 0, 3, 1, 2, 3, 3, 3, 4, 4, 4};
	return levels[kind];
}

static void write_bits(const struct atlas_cell *cell, char text[40])
{
	if (cell->rung == ATLAS_RUNGS)
		snprintf(text, 40, "never");
	else
		snprintf(text, 40, "%s%d bits", cell->rung ? "" : "<= ", atlas_bits(cell->rung));
}

/* The name of the cell's command, to which the cell leads. */
static const char *write_anchor(const struct atlas *atlas, int method, int scene, char anchor[80])
{
	snprintf(anchor, 80, "%s-%s", atlas->scene_name[scene], atlas->method[method]);
	return anchor;
}

static void add_command(struct result_table table, const struct atlas *atlas, int method, int scene)
{
	int rung = atlas_shown(&atlas->cell[method][scene]);
	char name[16], arithmetic[40] = "", anchor[80];
	if (rung != ATLAS_BINARY64)
		snprintf(arithmetic, sizeof arithmetic, " --arithmetic %s", atlas_arithmetic(rung, name));
	table_text(table, "touchstone run stress/%s --method %s --events %" PRIu64 " --measure failure%s",
			   atlas->scene_name[scene], atlas->method[method], atlas->limits.events, arithmetic);
	table_anchor(table, write_anchor(atlas, method, scene, anchor));
}

static void add_glance(struct result *result, const struct atlas *atlas)
{
	const char *columns[ATLAS_SCENES + 2] = {"method"};
	for (int s = 0; s < atlas->scenes; s++) columns[s + 1] = atlas->scene_name[s];
	struct result_table table = result_table(
		result, "What happens",
		"In binary64, with the first event that shows it; below that the least number of significand "
		"bits with which the method survives the scene (4 to 25 one by one, then 28, 32, 40, 46, 53, 64, "
		"113). To come to rest is right where the scene loses energy. Each cell leads to the command that shows it.",
		columns);
	for (int m = 0; m < atlas->methods; m++) {
		table_row(table);
		table_text(table, "%s", atlas->method[m]);
		for (int s = 0; s < atlas->scenes; s++) {
			const struct atlas_cell *cell = &atlas->cell[m][s];
			char bits[40], event[40] = "";
			write_bits(cell, bits);
			if (cell->failure.event) snprintf(event, sizeof event, "event %" PRIu64 "; ", cell->failure.event);
			if (!cell->done) {
				table_text(table, "%s", cell->refused ? "refused" : "not run");
				continue;
			}
			table_shaded(table, level_of(cell->failure.kind), "%s; %s%s", failure_word(cell->failure.kind), event,
						 bits);
			char anchor[80], query[300], unseen[80];
			table_link(table, write_anchor(atlas, m, s, anchor));
			if (atlas_live(atlas, m, s, query, unseen)) table_live(table, query);
			if (*unseen) table_unseen(table, unseen);
		}
	}
}

/* Each scene on the live page, by the stable rule in double and in single precision. */
static void add_scenes(struct result *result, const struct atlas *atlas)
{
	for (int s = 0; s < atlas->scenes; s++) {
		char query[80];
		snprintf(query, sizeof query, "scene=stress-%s&seed=%" PRIu64, atlas->scene_name[s], atlas->file[s]->seed);
		result_live(result, atlas->file[s]->title, query);
	}
}

static void add_cells(struct result *result, const struct atlas *atlas)
{
	static const char *const columns[] = {"scene and method", "in binary64", "survives from", "to see it", NULL};
	struct result_table table =
		result_table(result, "Every cell",
					 "In brackets what happens one step of precision below. The "
					 "command shows the failure in binary64, or else the one in brackets, event by event.",
					 columns);
	for (int s = 0; s < atlas->scenes; s++)
		for (int m = 0; m < atlas->methods; m++) {
			const struct atlas_cell *cell = &atlas->cell[m][s];
			const struct failure *failure = &cell->failure;
			char bits[40];
			if (!cell->done) continue;
			write_bits(cell, bits);
			table_row(table);
			table_text(table, "%s, %s", atlas->scene_name[s], atlas->method[m]);
			if (failure->event)
				table_text(table, "%s at event %" PRIu64 ": %s", failure_word(failure->kind), failure->event,
						   failure->text);
			else
				table_text(table, "%s", failure_word(failure->kind));
			if (cell->rung > 0)
				table_text(table, "%s (%s)", bits, failure_word(cell->below.kind));
			else
				table_text(table, "%s", bits);
			add_command(table, atlas, m, s);
		}
}

static void add_claim(struct result *result, const struct atlas *atlas)
{
	int survived = 0, run = 0;
	for (int s = 0; s < atlas->scenes; s++) {
		const struct atlas_cell *cell = &atlas->cell[0][s]; /* the first method is the stable rule */
		run += cell->done;
		survived += cell->done && atlas_goes_well(cell->failure.kind);
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

struct result *atlas_result(const struct atlas *atlas)
{
	struct result *result = result_new("atlas", "Where methods fail");
	if (!result) return NULL;
	bool stopped = atlas->setup->stop && *atlas->setup->stop;
	result_paragraph(result,
					 "%d methods in %d scenes that are hard on floating point, %" PRIu64
					 " events each. A watcher checks "
					 "each run whenever its particles have had an event each: whether it halts or loops, whether time "
					 "runs backwards, whether particles are deep in one another and stay so, whether energy comes or "
					 "goes, or momentum that nothing outside changes. Then bisection over the precision finds from how "
					 "many bits on the method survives.",
					 atlas->methods, atlas->scenes, atlas->limits.events);
	add_claim(result, atlas);
	add_scenes(result, atlas);
	add_glance(result, atlas);
	add_cells(result, atlas);
	result_note(result,
				"Deep is nearer than %g of the contact distance; energy may change by %g of its scale at the start, "
				"momentum by as much of its scale at the time. An overlap that lasts ten checks is an entangled pair, "
				"one that clears is a pair that penetrates.",
				failure_depth, failure_conserved);
	result_note(
		result,
		"Bisection takes it that a method that survives does so with more bits too. That is not certain: runs of "
		"different precision part after their horizon, and one may be luckier than another.");
	if (stopped) result_incomplete(result, "interrupted; cells that were not finished are missing");
	return result;
}

struct result *figure_atlas(const struct figure_setup *setup, char error[512])
{
	static const char *const scenes[] = {"dilute", "dense",   "inelastic", "near-collapse", "cradle", "column",
										 "corner", "grazing", "far-away",  "long-times",    NULL};
	struct atlas *atlas = atlas_open(setup, scenes, setup->full ? 1000000 : 2000, error);
	struct result *result = atlas && atlas_measure(atlas, error) ? atlas_result(atlas) : NULL;
	atlas_close(atlas);
	return result;
}

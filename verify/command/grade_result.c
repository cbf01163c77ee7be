/* Grades as a result for the report: for each shape, hand-made and harvested questions apart, a table to be taken in at
 * a glance and one with all numbers. */
#include "command/grading.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "display.h"
#include "result.h"

/* The rows of one table. */
struct part {
	const struct grading_plan *plan;
	const struct grading *grading;
	enum touchstone_shape shape;
	enum family_origin origin;
};

static bool belongs(const struct part *part, const struct grade_row *row)
{
	return row->shape == part->shape && row->source->origin == part->origin;
}

static const struct grade_row *row_of(const struct part *part, const struct question_source *source,
									  const struct finder *finder)
{
	for (size_t r = 0; r < part->grading->row_count; r++) {
		const struct grade_row *row = &part->grading->rows[r];
		if (belongs(part, row) && row->source == source && row->finder == finder) return row;
	}
	return NULL;
}

static bool any(const struct part *part, const struct question_source *source, const struct finder *finder)
{
	for (size_t r = 0; r < part->grading->row_count; r++) {
		const struct grade_row *row = &part->grading->rows[r];
		if (belongs(part, row) && (!source || row->source == source) && (!finder || row->finder == finder)) return true;
	}
	return false;
}

static const char *words_of(const struct part *part)
{
	return part->origin == FAMILY_HARVESTED ? "harvested" : "hand-made";
}

/* ---- at a glance */

/* The largest share of the questions that is in one class of faults, or whose order is wrong. */
static double worst_share(const struct grade_row *row)
{
	double most = 0, cases = (double)finder_grade_cases(&row->grade);
	for (int class = FINDER_MISSED; class <= FINDER_NAN; class ++) most = fmax(most, (double)row->grade.count[class]);
	return cases > 0 ? fmax(most, (double)row->grade.misordered) / cases : 0;
}

/* From 0, no fault and at most 4 ulp, upwards. */
static unsigned level_of(const struct grade_row *row)
{
	double share = worst_share(row);
	if (share == 0 && row->faults == 0) return row->max_ulp > 4 ? 1 : 0;
	return share < 1e-3 ? 2 : share < 0.1 ? 3 : 4;
}

static void add_part(FILE *stream, uint64_t count, const char *what)
{
	char text[DISPLAY_ROOM];
	display_count(text, (json_int_t)count);
	if (count) fprintf(stream, "%s %s; ", text, what);
}

static void add_cell(struct result_table table, const struct grade_row *row)
{
	char *text = NULL, most[DISPLAY_ROOM];
	size_t size;
	FILE *stream = open_memstream(&text, &size);
	if (!stream) return;
	for (int class = FINDER_MISSED; class <= FINDER_NAN; class ++)
		add_part(stream, row->grade.count[class], finder_class_name((enum finder_class) class));
	add_part(stream, row->grade.misordered, "out of order");
	add_part(stream, row->faults, "not answered");
	display_number(most, row->max_ulp, 2);
	if (!isnan(row->max_ulp))
		fprintf(stream, "%s ulp", most);
	else if (ftell(stream) == 0)
		fputs("no event", stream);
	fclose(stream);
	table_shaded(table, level_of(row), "%s", text);
	free(text);
}

static char *finder_title(const struct finder *finder)
{
	char *title;
	bool usual = strcmp(finder->arithmetic, "binary64") == 0;
	return asprintf(&title, "%s%s%s", finder->method, usual ? "" : " ", usual ? "" : finder->arithmetic) < 0 ? NULL
																											 : title;
}

static void add_glance(struct result *result, const struct part *part)
{
	const struct grading_plan *plan = part->plan;
	char **heads = calloc(plan->finder_count + 2, sizeof *heads), title[100];
	if (!heads) return;
	size_t columns = 0;
	heads[columns++] = strdup("family");
	for (size_t f = 0; f < plan->finder_count; f++)
		if (any(part, NULL, &plan->finders[f])) heads[columns++] = finder_title(&plan->finders[f]);
	snprintf(title, sizeof title, "%s, %s questions", shape_name(part->shape), words_of(part));
	struct result_table table = result_table(
		result, title,
		"Each cell: how many answers were missed, phantom, negative or not a number, and the largest error of the "
		"others in ulp of binary64. The shade goes by the gravest: no fault and at most 4 ulp; more than 4 ulp; faults "
		"in fewer than a thousandth of the questions; in fewer than a tenth; in more. Of an event that is now, any "
		"later "
		"time is off by an astronomical number of ulp.",
		(const char *const *)heads);
	for (const struct question_source *source = plan->sources; source < plan->sources + plan->source_count; source++) {
		if (!any(part, source, NULL)) continue;
		table_row(table);
		table_text(table, "%s", source->name);
		for (size_t f = 0; f < plan->finder_count; f++) {
			const struct grade_row *row = row_of(part, source, &plan->finders[f]);
			if (row)
				add_cell(table, row);
			else if (any(part, NULL, &plan->finders[f]))
				table_number(table, NAN);
		}
	}
	for (size_t c = 0; c < columns; c++) free(heads[c]);
	free(heads);
}

/* ---- all numbers */

static void add_numbers(struct result *result, const struct part *part)
{
	static const char *const columns[] = {"family",      "method",      "arithmetic",  "cases",      "missed",
										  "phantom",     "negative",    "nan",         "pairs",      "out of order",
										  "median ulp",  "99.9 % ulp",  "largest ulp", "median gap", "largest gap",
										  "ns per call", "worst input", NULL};
	char title[100];
	snprintf(title, sizeof title, "%s, %s questions: all numbers", shape_name(part->shape), words_of(part));
	struct result_table table = result_table(
		result, title,
		"Of each class of faults the count, never summed together. Errors are those of the events that were found; a "
		"gap is how far from contact they leave the bodies, in the question's unit of length. The worst input is that "
		"of the largest error, ready for touchstone replay.",
		columns);
	for (size_t r = 0; r < part->grading->row_count; r++) {
		const struct grade_row *row = &part->grading->rows[r];
		if (!belongs(part, row)) continue;
		const struct finder_example *worst = &row->grade.example[FINDER_FOUND];
		char *text = worst->there ? query_text(row->shape, worst->number) : NULL;
		table_row(table);
		table_text(table, "%s", row->source->name);
		table_text(table, "%s", row->finder->method);
		table_text(table, "%s", row->finder->arithmetic);
		table_count(table, finder_grade_cases(&row->grade));
		for (int class = FINDER_MISSED; class <= FINDER_NAN; class ++) table_count(table, row->grade.count[class]);
		table_number(table, row->grade.pairs ? (double)row->grade.pairs : NAN);
		table_number(table, row->grade.pairs ? (double)row->grade.misordered : NAN);
		const double numbers[] = {row->median_ulp, row->p999_ulp, row->max_ulp,
								  row->median_gap, row->max_gap,  row->nanoseconds};
		for (int n = 0; n < 6; n++) table_number(table, numbers[n]);
		if (text)
			table_text(table, "%s", text);
		else
			table_number(table, NAN);
		free(text);
	}
}

static void add_findings(struct result *result, const struct grading *grading)
{
	if (grading->fault_count == 0) return;
	static const char *const columns[] = {"plug-in", "family", "what it did", "alone", "input", NULL};
	struct result_table table = result_table(
		result, "What plug-ins did instead of answering",
		"Alone: whether the same happened when a new process was asked nothing but this question.", columns);
	for (size_t f = 0; f < grading->fault_count; f++) {
		const struct grade_fault *fault = &grading->faults[f];
		const struct grade_row *row = &grading->rows[fault->row];
		char words[120], *text = query_text(row->shape, fault->number);
		plugin_fault_words(&fault->fault, words);
		table_row(table);
		table_text(table, "%s", row->finder->method);
		table_text(table, "%s", row->source->name);
		table_text(table, "%s", words);
		table_text(table, "%s", fault->fault.alone ? "yes" : "no");
		table_text(table, "%s", text ? text : "");
		free(text);
	}
}

/* ---- the whole */

/* The finders that made no fault anywhere and were off by at most 4 ulp, as a sentence. */
static void add_spotless(struct result *result, const struct grading_plan *plan, const struct grading *grading)
{
	char names[400] = "";
	for (size_t f = 0; f < plan->finder_count; f++) {
		unsigned worst = 0;
		bool asked = false;
		for (size_t r = 0; r < grading->row_count; r++) {
			if (grading->rows[r].finder != &plan->finders[f]) continue;
			unsigned level = level_of(&grading->rows[r]);
			asked = true;
			if (level > worst) worst = level;
		}
		size_t length = strlen(names);
		if (asked && worst == 0)
			snprintf(names + length, sizeof names - length, "%s%s %s", length ? ", " : "", plan->finders[f].method,
					 plan->finders[f].arithmetic);
	}
	result_paragraph(result, "Without any fault, and never off by more than 4 ulp: %s.", *names ? names : "none");
}

static void add_summary(struct result *result, const struct grading_plan *plan, const struct grading *grading)
{
	char answers[DISPLAY_ROOM];
	size_t clean = 0;
	for (size_t r = 0; r < grading->row_count; r++) clean += level_of(&grading->rows[r]) == 0;
	display_count(answers, (json_int_t)grading->answered);
	result_paragraph(
		result,
		"Finders of event times, held against the exact answer to each question: integers of any length decide whether "
		"there is an event, and the time is known to any digit. %s answers; in %zu of %zu sets of questions a finder "
		"made no fault and was off by at most 4 ulp.",
		answers, clean, grading->row_count);
	add_spotless(result, plan, grading);
	result_paragraph(
		result,
		"A missed event lets balls fly through each other, a phantom is a collision that never was, a negative time "
		"runs backwards, and what is not a number is nothing at all. These are four different faults and are counted "
		"apart; so are questions made to be hard and questions harvested from runs of the engine, since the shares "
		"among "
		"the former say nothing about how often a simulation meets them.");
	if (grading->interrupted) result_incomplete(result, "interrupted after %s answers", answers);
	for (size_t r = 0; r < grading->row_count; r++) {
		char *broken = grading->rows[r].grade.broken ? grade_row_broken(&grading->rows[r]) : NULL;
		if (broken) result_note(result, "A claim is not kept: %s.", broken);
		free(broken);
	}
}

static void add_sources(struct result *result, const struct grading_plan *plan)
{
	static const char *const columns[] = {"family", "origin", "what it holds", NULL};
	struct result_table table = result_table(result, "The questions", NULL, columns);
	for (size_t s = 0; s < plan->source_count; s++) {
		const struct question_source *source = &plan->sources[s];
		table_row(table);
		table_text(table, "%s", source->name);
		table_text(table, "%s", source->origin == FAMILY_HARVESTED ? "harvested" : "hand-made");
		table_text(table, "%s", source->family ? source->family->about : "the questions of a file");
	}
}

struct result *grading_result(const struct grading_plan *plan, const struct grading *grading, const char *name,
							  const char *title)
{
	struct result *result = result_new(name, title);
	if (!result) return NULL;
	add_summary(result, plan, grading);
	for (int detailed = 0; detailed < 2; detailed++) {
		for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++)
			for (int origin = FAMILY_HAND_MADE; origin <= FAMILY_HARVESTED; origin++) {
				struct part part = {plan, grading, (enum touchstone_shape)shape, (enum family_origin)origin};
				if (!any(&part, NULL, NULL)) continue;
				if (detailed)
					add_numbers(result, &part);
				else
					add_glance(result, &part);
			}
		if (!detailed) add_findings(result, grading);
	}
	add_sources(result, plan);
	return result;
}

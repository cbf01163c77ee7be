/* Grades as a table for people, and as comma-separated values. */
#include "command/grading.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- comma-separated values */

static void write_number(FILE *stream, double value, const char *format)
{
	fputc(',', stream);
	if (!isnan(value)) fprintf(stream, format, value);
}

static void write_row(FILE *stream, const struct grade_row *row)
{
	const uint64_t *count = row->grade.count;
	const struct finder_example *worst = &row->grade.example[FINDER_FOUND];
	fprintf(stream, "%s,%s,%s,%s", row->finder->method, row->finder->arithmetic, shape_name(row->shape),
			row->source->name);
	fprintf(stream, ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64, finder_grade_cases(&row->grade),
			count[FINDER_MISSED], count[FINDER_PHANTOM], count[FINDER_NEGATIVE], count[FINDER_NAN]);
	write_number(stream, row->median_ulp, "%.9g");
	write_number(stream, row->p999_ulp, "%.9g");
	write_number(stream, row->max_ulp, "%.9g");
	char *text = worst->there ? query_text(row->shape, worst->number) : NULL;
	fprintf(stream, ",%s", text ? text : "");
	free(text);
	write_number(stream, row->nanoseconds, "%.3f");
	fputc('\n', stream);
}

void grading_csv(FILE *stream, const struct grading *grading)
{
	fputs("method,arithmetic,shape,family,cases,missed,phantom,negative,nan,median_ulp,p999_ulp,max_ulp,worst_input,"
		  "ns_per_call\n",
		  stream);
	for (size_t r = 0; r < grading->row_count; r++) write_row(stream, &grading->rows[r]);
}

/* ---- for people */

static void print_number(FILE *stream, int width, double value)
{
	if (isnan(value))
		fprintf(stream, "%*s", width, "-");
	else
		fprintf(stream, "%*.3g", width, value);
}

static int longest(const struct grading *grading, const char *(*name)(const struct grade_row *row))
{
	int width = 0;
	for (size_t r = 0; r < grading->row_count; r++) {
		int length = (int)strlen(name(&grading->rows[r]));
		if (length > width) width = length;
	}
	return width;
}

static const char *method_of(const struct grade_row *row)
{
	return row->finder->method;
}

static const char *arithmetic_of(const struct grade_row *row)
{
	return row->finder->arithmetic;
}

static const char *source_of(const struct grade_row *row)
{
	return row->source->name;
}

struct widths {
	int source, method, arithmetic;
};

static void print_heading(FILE *stream, const struct grade_row *row, const struct widths *width)
{
	fprintf(stream, "\n%s, %s questions\n", shape_name(row->shape),
			row->source->origin == FAMILY_HARVESTED ? "harvested" : "hand-made");
	fprintf(stream, "%-*s  %-*s  %-*s %9s %8s %8s %8s %8s %8s %9s %9s %9s %9s %9s %8s\n", width->source, "family",
			width->method, "method", width->arithmetic, "in", "cases", "missed", "phantom", "negative", "nan",
			"disorder", "ulp 50 %", "99.9 %", "largest", "gap 50 %", "largest", "ns/call");
}

static void print_row(FILE *stream, const struct grade_row *row, const struct widths *width)
{
	const uint64_t *count = row->grade.count;
	fprintf(stream, "%-*s  %-*s  %-*s %9" PRIu64 " %8" PRIu64 " %8" PRIu64 " %8" PRIu64 " %8" PRIu64, width->source,
			row->source->name, width->method, row->finder->method, width->arithmetic, row->finder->arithmetic,
			finder_grade_cases(&row->grade), count[FINDER_MISSED], count[FINDER_PHANTOM], count[FINDER_NEGATIVE],
			count[FINDER_NAN]);
	if (row->grade.pairs)
		fprintf(stream, " %8" PRIu64, row->grade.misordered);
	else
		fprintf(stream, " %8s", "-");
	const double numbers[] = {row->median_ulp, row->p999_ulp, row->max_ulp, row->median_gap, row->max_gap};
	for (int n = 0; n < 5; n++) print_number(stream, 10, numbers[n]);
	print_number(stream, 9, row->nanoseconds);
	fputc('\n', stream);
}

/* Rows of one shape and origin together: all of `origin` and `shape`, in the order in which they were graded. */
static void print_table(FILE *stream, const struct grading *grading, const struct widths *width,
						enum touchstone_shape shape, enum family_origin origin)
{
	bool headed = false;
	for (size_t r = 0; r < grading->row_count; r++) {
		const struct grade_row *row = &grading->rows[r];
		if (row->shape != shape || row->source->origin != origin) continue;
		if (!headed) print_heading(stream, row, width);
		headed = true;
		print_row(stream, row, width);
	}
}

/* The gravest of what one finder did in one class: the largest error; for other classes, the first. */
static const struct grade_row *gravest(const struct grading *grading, const struct finder *finder, int class)
{
	const struct grade_row *found = NULL;
	for (size_t r = 0; r < grading->row_count; r++) {
		const struct grade_row *row = &grading->rows[r];
		if (row->finder != finder || !row->grade.example[class].there) continue;
		if (!found || (class == FINDER_FOUND && row->max_ulp > found->max_ulp)) found = row;
	}
	return found;
}

static void print_example(FILE *stream, const struct grade_row *row, enum finder_class class)
{
	const struct finder_example *example = &row->grade.example[class];
	char *text = query_text(row->shape, example->number), error[40];
	snprintf(error, sizeof error, "%.3g ulp", row->max_ulp);
	fprintf(stream, "%s %s, %s, %s: %s\n", row->finder->method, row->finder->arithmetic,
			class == FINDER_FOUND ? error : finder_class_name(class), row->source->name, text ? text : "");
	free(text);
}

/* Where a finder is first met. */
static size_t first_row(const struct grading *grading, const struct finder *finder)
{
	size_t first = 0;
	while (grading->rows[first].finder != finder) first++;
	return first;
}

static void print_examples(FILE *stream, const struct grading *grading)
{
	fputs("\nInputs to replay: of each finder the largest error, and the first of each other kind\n", stream);
	for (size_t r = 0; r < grading->row_count; r++) {
		const struct finder *finder = grading->rows[r].finder;
		if (first_row(grading, finder) < r) continue;
		for (int class = 0; class < FINDER_UNDEFINED; class ++) {
			const struct grade_row *row = class == FINDER_RIGHTLY_NEVER ? NULL : gravest(grading, finder, class);
			if (row) print_example(stream, row, (enum finder_class) class);
		}
	}
}

char *grade_row_broken(const struct grade_row *row)
{
	char words[200], *said = NULL;
	char *text = query_text(row->shape, row->grade.breach.number);
	finder_claim_words(&row->claim, words);
	if (asprintf(&said, "%s %s claims %s; not so %" PRIu64 " times in %s, first with %a for %s", row->finder->method,
				 row->finder->arithmetic, words, row->grade.broken, row->source->name, row->grade.breach.answer,
				 text ? text : "") < 0)
		said = NULL;
	free(text);
	return said;
}

static void print_fault(FILE *stream, const struct grade_row *row, const struct grade_fault *fault)
{
	char words[120], *text = query_text(row->shape, fault->number);
	plugin_fault_words(&fault->fault, words);
	fprintf(stream, "%s %s%s at %s %ld of %s: %s\n", row->finder->method, words,
			fault->fault.alone ? "" : ", though not when asked nothing else,",
			row->source->family ? "question" : "line", fault->line, row->source->name, text ? text : "");
	free(text);
}

/* The first few faults of a plug-in in one set of questions. */
static void print_faults(FILE *stream, const struct grading *grading, size_t r)
{
	enum { SHOWN = 3 };
	const struct grade_row *row = &grading->rows[r];
	uint64_t shown = 0;
	for (size_t f = 0; f < grading->fault_count && shown < SHOWN; f++) {
		if (grading->faults[f].row != r) continue;
		print_fault(stream, row, &grading->faults[f]);
		shown++;
	}
	if (row->faults > shown)
		fprintf(stream, "%s: and %" PRIu64 " such in %s\n", row->finder->method, row->faults - shown,
				row->source->name);
	if (row->given_up)
		fprintf(stream, "%s is given up on %s, %s: the other questions were not asked\n", row->finder->method,
				row->source->name, shape_name(row->shape));
}

/* Answers of a plug-in that are no times, over all questions. */
static void print_garbage(FILE *stream, const struct grading *grading, const struct finder *finder)
{
	uint64_t garbage = 0, cases = 0;
	for (size_t r = 0; r < grading->row_count; r++) {
		const struct grade_row *row = &grading->rows[r];
		if (row->finder != finder) continue;
		garbage += row->grade.count[FINDER_NAN] + row->grade.count[FINDER_NEGATIVE] - row->faults;
		cases += finder_grade_cases(&row->grade);
	}
	if (garbage)
		fprintf(stream, "%s answers %" PRIu64 " of %" PRIu64 " questions with what is no time\n", finder->method,
				garbage, cases);
}

void grading_print_findings(FILE *stream, const struct grading *grading)
{
	for (size_t r = 0; r < grading->row_count; r++) {
		const struct grade_row *row = &grading->rows[r];
		print_faults(stream, grading, r);
		char *broken = row->grade.broken ? grade_row_broken(row) : NULL;
		if (broken) fprintf(stream, "%s\n", broken);
		free(broken);
		if (row->finder->plugin && first_row(grading, row->finder) == r) print_garbage(stream, grading, row->finder);
	}
}

static void print_undefined(FILE *stream, const struct grading *grading)
{
	for (size_t r = 0; r < grading->row_count; r++) {
		const struct grade_row *row = &grading->rows[r];
		uint64_t count = row->grade.count[FINDER_UNDEFINED];
		bool first_of_set = r == 0 || row[-1].source != row->source || row[-1].shape != row->shape;
		if (count && first_of_set)
			fprintf(stream, "\n%" PRIu64 " %s questions of %s hold an infinity or a NaN: asked, but not graded\n",
					count, shape_name(row->shape), row->source->name);
	}
}

void grading_print(FILE *stream, const struct grading *grading)
{
	const struct widths width = {longest(grading, source_of), longest(grading, method_of),
								 longest(grading, arithmetic_of)};
	for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) {
		print_table(stream, grading, &width, (enum touchstone_shape)shape, FAMILY_HAND_MADE);
		print_table(stream, grading, &width, (enum touchstone_shape)shape, FAMILY_HARVESTED);
	}
	print_undefined(stream, grading);
	print_examples(stream, grading);
	if (grading_finding(grading)) fputs("\nFindings\n", stream);
	grading_print_findings(stream, grading);
	fprintf(stream, "\n%" PRIu64 " answers graded in %.3g s%s\n", grading->answered, grading->seconds,
			grading->interrupted ? ", interrupted" : "");
}

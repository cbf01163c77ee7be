/* One check over time: a figure for each measure that is a number, a table of when words changed. */
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "audit/trend_log.h"

static const char *const columns[] = {"time", "y", "low", "high", NULL};

static bool is_of(const struct trend_point *point, const char *check, const char *measure)
{
	return strcmp(point->check, check) == 0 && (!measure || strcmp(point->measure, measure) == 0);
}

/* The nights that a night is held against, as far as the page goes: the last good ones before it, without intervals. */
struct usual {
	double value[VERDICT_REFERENCE];
	size_t count, next;
};

static void usual_add(struct usual *usual, double value)
{
	if (isnan(value)) return;
	usual->value[usual->next] = value;
	usual->next = (usual->next + 1) % VERDICT_REFERENCE;
	if (usual->count < VERDICT_REFERENCE) usual->count++;
}

static void add_band(struct figure_series band, double time, const struct usual *usual)
{
	double sorted[VERDICT_REFERENCE];
	if (usual->count < 2) return;
	memcpy(sorted, usual->value, usual->count * sizeof *sorted);
	gsl_sort(sorted, 1, usual->count);
	series_row(band, (double[]){time, gsl_stats_median_from_sorted_data(sorted, 1, usual->count),
								gsl_stats_quantile_from_sorted_data(sorted, 1, usual->count, 0.025),
								gsl_stats_quantile_from_sorted_data(sorted, 1, usual->count, 0.975)});
	series_mark(band, &(struct series_mark){.name = "", .title = "the band"});
}

static void add_night(struct figure_series series, const struct trend_audit *audit, const struct trend_point *point)
{
	char name[40], title[700], link[40];
	snprintf(name, sizeof name, "audit %lld", (long long)audit->number);
	snprintf(title, sizeof title, "%s, %.10s, revision %.40s: %.6g%s%s", name, audit->date,
			 *audit->revision ? audit->revision : "unknown", point->value, point->finding ? "; " : "",
			 point->finding ? point->finding : "");
	series_row(series, (double[]){(double)audit->time, point->value, point->low, point->high});
	series_mark(series, &(struct series_mark){.name = name, .title = title, .link = trend_link(audit, link)});
}

/* Points of audits that were interrupted or killed are shown, but belong to no band. */
static void add_measure(struct result *result, const struct trend_log *log, const char *check, const char *measure,
						unsigned number)
{
	char name[20], title[120];
	snprintf(name, sizeof name, "measure-%u", number);
	snprintf(title, sizeof title, "%s of %s over the audits", measure, check);
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = name,
			.kind = "trend",
			.title = measure,
			.caption = "Each point is an audit, with its interval: rest the pointer on it, or click. The band is "
					   "where 95 % of the fifty good nights before it lie.",
			.alternative = title,
			.x = {"date", 0, {0, 0}},
			.y = {measure, 0, {0, 0}},
			.columns = columns,
		});
	struct figure_series band = figure_series(figure, "usual band", SERIES_LINE);
	struct figure_series nights = figure_series(figure, "audits", SERIES_POINTS);
	struct figure_series findings = figure_series(figure, "found wanting", SERIES_ENDS);
	struct usual usual = {0};
	for (size_t p = 0; p < log->point_count; p++) {
		const struct trend_point *point = &log->points[p];
		if (!is_of(point, check, measure)) continue;
		const struct trend_audit *audit = &log->audits[point->audit];
		if (point->accepted && strcmp(audit->state, "complete") == 0) usual = (struct usual){0};
		add_band(band, (double)audit->time, &usual);
		add_night(point->finding ? findings : nights, audit, point);
		if (!point->finding && strcmp(audit->state, "complete") == 0) usual_add(&usual, point->value);
	}
}

/* When a word was not what it was the night before. */
static void add_words(struct result *result, const struct trend_log *log, const char *check)
{
	static const char *const headings[] = {"measure", "word", "since audit", "date", "revision", "finding", NULL};
	struct result_table table = result_table(
		result, "Words", "Digests and verdicts, each where it changed. A digest belongs to its seed.", headings);
	for (size_t p = 0; p < log->point_count; p++) {
		const struct trend_point *point = &log->points[p], *before = NULL;
		if (!is_of(point, check, NULL) || point->nature != MEASURE_WORD) continue;
		for (size_t q = p; q-- > 0 && !before;)
			if (is_of(&log->points[q], check, point->measure)) before = &log->points[q];
		if (before && strcmp(before->word, point->word) == 0) continue;
		const struct trend_audit *audit = &log->audits[point->audit];
		table_row(table);
		table_text(table, "%s", point->measure);
		table_text(table, "%s", point->word);
		table_count(table, (uint64_t)audit->number);
		table_text(table, "%.10s", audit->date);
		table_text(table, "%s", audit->revision);
		table_text(table, "%s", point->finding ? point->finding : "");
	}
}

struct result *trend_of_check(const struct trend_log *log, const char *check)
{
	char name[80], title[80];
	snprintf(name, sizeof name, "trend-%s", check);
	snprintf(title, sizeof title, "Audits: %s", check);
	struct result *result = result_new(name, title);
	const struct trend_point *last = NULL;
	size_t findings = 0, points = 0;
	unsigned figures = 0;
	bool words = false;
	for (size_t p = 0; p < log->point_count; p++) {
		const struct trend_point *point = &log->points[p];
		if (!is_of(point, check, NULL)) continue;
		last = point, points++, findings += point->finding != NULL, words |= point->nature == MEASURE_WORD;
	}
	if (!result || !last) return result;
	result_paragraph(result, "%zu measurements, %zu of them with findings; the last in audit %lld of %.10s.", points,
					 findings, (long long)log->audits[last->audit].number, log->audits[last->audit].date);
	for (size_t p = 0; p < log->point_count; p++) { /* each measure where it comes up first */
		const struct trend_point *point = &log->points[p];
		bool first = is_of(point, check, NULL) && point->nature != MEASURE_WORD;
		for (size_t q = 0; q < p && first; q++) first = !is_of(&log->points[q], check, point->measure);
		if (first) add_measure(result, log, check, point->measure, ++figures);
	}
	if (words) add_words(result, log, check);
	return result;
}

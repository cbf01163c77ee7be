#include "bench/bench_result.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command/command.h"

static const char *const figure_columns[] = {"x", "y", "low", "high", "instructions", NULL};

/* Which points stand in a figure, and where. */
struct sweep {
	bool (*has)(const struct point *point);
	double (*x)(const struct point *point);
};

static bool is_gas(const struct point *point)
{
	return strcmp(point->scene, "hard-spheres") == 0;
}

static bool is_double(const struct point *point)
{
	return is_gas(point) && strcmp(point->arithmetic, "binary64") == 0;
}

static bool varies_size(const struct point *point)
{
	return is_double(point) && point->density == 0.5;
}

static double size_of(const struct point *point)
{
	return (double)point->particles;
}

static bool varies_density(const struct point *point)
{
	return is_double(point) && point->particles == 13500;
}

static double density_of(const struct point *point)
{
	return point->density;
}

static bool at_precision(const struct point *point)
{
	return is_gas(point) && point->particles == 2916;
}

static bool is_mpfr(const struct point *point)
{
	return at_precision(point) && strncmp(point->arithmetic, "mpfr:", 5) == 0 && strcmp(point->search, "cells") == 0;
}

static bool is_unsieved(const struct point *point)
{
	return at_precision(point) && strcmp(point->search, "unsieved") == 0;
}

static bool is_short(const struct point *point)
{
	return at_precision(point) && strncmp(point->arithmetic, "short:", 6) == 0;
}

static bool is_native(const struct point *point)
{
	return at_precision(point) && !strchr(point->arithmetic, ':');
}

static double bits_of(const struct point *point)
{
	return arithmetic_bits(point->arithmetic);
}

/* Points of a sweep in ascending order: these runs, or those that were stored. */
static void add_series(struct result_figure figure, const char *label, enum series_style style,
					   const struct sweep *sweep, const struct row *rows, const struct baseline *stored)
{
	struct figure_series series = figure_series(figure, label, style);
	for (double last = -INFINITY;;) {
		int next = -1;
		for (int p = 0; p < POINTS; p++)
			if (sweep->has(&points[p]) && sweep->x(&points[p]) > last &&
				(next < 0 || sweep->x(&points[p]) < sweep->x(&points[next])))
				next = p;
		if (next < 0) break;
		last = sweep->x(&points[next]);
		const struct row *row = &rows[next];
		struct spread cost = stored ? baseline_value(stored, row->name, NANOSECONDS) : row->value[NANOSECONDS];
		struct spread instructions =
			stored ? baseline_value(stored, row->name, INSTRUCTIONS) : row->value[INSTRUCTIONS];
		if (!isnan(cost.median))
			series_row(series, (double[]){last, cost.median, cost.low, cost.high, instructions.median});
	}
}

/* A figure of one sweep, from cost 0 upwards: this run, and the stored one beside it. */
static void add_sweep(struct result *result, struct figure_frame frame, const struct sweep *sweep,
					  const struct row *rows, const struct baseline *baseline)
{
	for (int p = 0; p < POINTS; p++)
		if (sweep->has(&points[p])) frame.y.range[1] = fmax(frame.y.range[1], 1.1 * rows[p].value[NANOSECONDS].high);
	struct result_figure figure = result_figure(result, &frame);
	add_series(figure, "this run", SERIES_POINTS, sweep, rows, NULL);
	if (baseline) add_series(figure, "stored run", SERIES_LINE, sweep, rows, baseline);
}

static void add_figures(struct result *result, const struct row *rows, const struct baseline *baseline)
{
	add_sweep(result,
			  (struct figure_frame){
				  .name = "size",
				  .kind = "curves",
				  .title = "Cost of an event over the number of spheres",
				  .caption = "Elastic hard spheres at density 0.5 in binary64, one core. The instructions are in the "
							 "CSV; where time grows and they do not, it is the way to ever more distant memory.",
				  .alternative = "Nanoseconds per event over 500 to a million spheres.",
				  .x = {"spheres", 10, {0, 0}},
				  .y = {"time per event / ns", 0, {0, 0}},
				  .columns = figure_columns,
			  },
			  &(struct sweep){varies_size, size_of}, rows, baseline);
	add_sweep(result,
			  (struct figure_frame){
				  .name = "density",
				  .kind = "curves",
				  .title = "Cost of an event over density",
				  .caption = "13 500 elastic hard spheres in binary64. Where a gas is dilute, cells are crossed many "
							 "times between two collisions, and that is part of what each costs.",
				  .alternative = "Nanoseconds per event over densities from 0.01 to 0.9.",
				  .x = {"density", 0, {0, 0}},
				  .y = {"time per event / ns", 0, {0, 0}},
				  .columns = figure_columns,
			  },
			  &(struct sweep){varies_density, density_of}, rows, baseline);
	struct result_figure bits = result_figure(
		result, &(struct figure_frame){
					.name = "bits",
					.kind = "curves",
					.title = "Cost of an event over precision",
					.caption = "2916 elastic hard spheres at density 0.5: the same scene in every arithmetic. Nearly "
							   "all pairs are rejected in binary32 with a proven bound; without that sieve, every pair "
							   "is worked out in MPFR.",
					.alternative = "Nanoseconds per event over significand bits, on a logarithmic scale, one mark for "
								   "each arithmetic; MPFR with the sieve and without.",
					.x = {"significand bits", 0, {0, 0}},
					.y = {"time per event / ns", 10, {0, 0}},
					.columns = figure_columns,
				});
	add_series(bits, "binary32, binary64, extended, twin, binary128", SERIES_POINTS,
			   &(struct sweep){is_native, bits_of}, rows, NULL);
	add_series(bits, "short", SERIES_POINTS, &(struct sweep){is_short, bits_of}, rows, NULL);
	add_series(bits, "mpfr", SERIES_POINTS, &(struct sweep){is_mpfr, bits_of}, rows, NULL);
	add_series(bits, "mpfr, without the sieve", SERIES_POINTS, &(struct sweep){is_unsieved, bits_of}, rows, NULL);
}

static void add_demands(struct result *result, const struct findings *findings)
{
	static const char *const columns[] = {"quantity",       "asked for", "found", "first quartile",
										  "third quartile", "met",       NULL};
	struct demand demands[DEMANDS];
	struct result_table table =
		result_table(result, "What was asked for", "Quotients are taken between runs of the same repetition.", columns);
	findings_demands(findings, demands);
	for (int d = 0; d < DEMANDS; d++) {
		const struct demand *demand = &demands[d];
		if (isnan(demand->found.median)) continue;
		table_row(table);
		table_text(table, "%s", demand->what);
		table_text(table, "%s %g", demand->at_most ? "at most" : "at least", demand->limit);
		table_number(table, demand->found.median);
		table_number(table, demand->found.low);
		table_number(table, demand->found.high);
		table_text(table, "%s", demand_met(demand) ? "yes" : "no");
	}
}

static void add_rows(struct result *result, const struct row *rows, const struct baseline *baseline)
{
	static const char *const columns[] = {"run",
										  "ns per event",
										  "first quartile",
										  "third quartile",
										  "over the stored",
										  "instructions per event",
										  "over the stored",
										  "bytes per particle",
										  "over the stored",
										  "seconds to start",
										  "over the stored",
										  NULL};
	struct result_table table = result_table(
		result, "Engines",
		"A run is named by its case, number of particles, density and arithmetic. Medians; quotients to the stored run "
		"are below 1 where less is taken than then.",
		columns);
	for (int r = 0; r < POINTS; r++) {
		const struct row *row = &rows[r];
		if (isnan(row->value[NANOSECONDS].median)) continue;
		table_row(table);
		table_text(table, "%s", row->name);
		table_number(table, row->value[NANOSECONDS].median);
		table_number(table, row->value[NANOSECONDS].low);
		table_number(table, row->value[NANOSECONDS].high);
		table_number(table, baseline_ratio(baseline, row, NANOSECONDS));
		for (enum quantity q = INSTRUCTIONS; q <= START_UP; q++) {
			table_number(table, row->value[q].median);
			table_number(table, baseline_ratio(baseline, row, q));
		}
	}
}

static void add_notes(struct result *result, const struct findings *findings, const struct baseline *baseline)
{
	char made[100];
	const struct effort *effort = &findings->effort;
	result_note(
		result,
		"Before the clock starts, particles have met %g times each on average, elastically; the million spheres "
		"only %g times, since each takes seconds.",
		point_melt(&points[0], effort),
		point_melt(&points[point_of("hard-spheres", 1000188, 0.5, "binary64", "cells")], effort));
	if (*findings->uncounted)
		result_note(result, "%c%s.", findings->uncounted[0] & ~0x20, findings->uncounted + 1);
	else
		result_note(result,
					"Instructions are counted by valgrind's callgrind within the event loop alone, without start-up "
					"and equilibration. Valgrind knows no AVX-512, so the sieve and the cells take their AVX2 paths there, and the "
					"counts are of those; `extended` is computed in 53 bits there.%s",
					effort->full ? "" : " Only --full counts more than 20 000 spheres.");
	if (findings->cores.count < 2)
		result_note(result, "Two runs on two cores were not measured: the program was given one core only.");
	else
		result_note(result, "The two cores are %s.",
					findings->cores.one ? "threads of one core, which share its arithmetic units"
										: "cores of their own, as far as the system says; a virtual machine may not "
										  "know better");
	if (baseline) result_note(result, "The stored run is of %s.", baseline_made(baseline, made));
}

static int counts(const struct row *rows)
{
	int counted = 0;
	for (int p = 0; p < POINTS; p++) counted += !isnan(rows[p].value[INSTRUCTIONS].median);
	return counted;
}

struct result *bench_result(const struct findings *findings, const struct row rows[ROWS],
							const struct baseline *baseline)
{
	struct result *result = result_new("bench", "What an event costs");
	if (!result) return NULL;
	result_paragraph(
		result,
		"Time and instructions for one event, over the number of particles, the density and the precision; "
		"one core, %u repetitions of everything in turn, medians with quartiles.",
		findings->effort.repetitions);
	add_figures(result, rows, baseline);
	add_demands(result, findings);
	add_rows(result, rows, baseline);
	add_notes(result, findings, baseline);
	if (findings->stopped)
		result_incomplete(result, "interrupted after %zu of %u repetitions; of %d runs, instructions are counted of %d",
						  findings->drop.count, findings->effort.repetitions, POINTS, counts(rows));
	return result;
}

/* The chart as comma-separated values, and as tables for people. */
#include "command/charting.h"

#include <inttypes.h>
#include <math.h>

/* ---- comma-separated values */

static void write_number(FILE *stream, double value)
{
	fputc(',', stream);
	if (!isnan(value)) fprintf(stream, "%.6g", value);
}

static void write_line(FILE *stream, const char *kind, const struct finder *finder, const double numbers[4])
{
	fprintf(stream, "%s,%s,%s", kind, finder->method, finder->arithmetic);
	for (int n = 0; n < 4; n++) write_number(stream, numbers[n]);
	fputc('\n', stream);
}

void chart_csv(FILE *stream, const struct chart_plan *plan, const struct chart *chart)
{
	fputs("kind,name,arithmetic,ns,cost_ratio,error_bits,horizon\n", stream);
	for (size_t f = 0; f < plan->finder_count; f++) {
		const struct chart_side *side = &chart->finders[f][FAMILY_HARVESTED];
		write_line(stream, "finder", &plan->finders[f],
				   (double[]){side->throughput, side->times_stable, side->bits, NAN});
	}
	for (size_t e = 0; e < plan->engine_count; e++) {
		const struct chart_engine *engine = &chart->engines[e];
		write_line(stream, "engine", &plan->engines[e],
				   (double[]){engine->nanoseconds, engine->times_stable, NAN, engine->horizon.mean});
	}
}

/* ---- for people */

static void print_numbers(FILE *stream, const double *numbers, int count)
{
	for (int n = 0; n < count; n++)
		if (isnan(numbers[n]))
			fprintf(stream, " %9s", "-");
		else
			fprintf(stream, " %9.4g", numbers[n]);
}

static void print_finders(FILE *stream, const struct chart_plan *plan, const struct chart *chart,
						  enum family_origin origin)
{
	fprintf(stream, "\nFinders, %s questions (ball-ball); * where none other is faster and better\n",
			origin == FAMILY_HARVESTED ? "harvested" : "hand-made");
	fprintf(stream, "  %-18s %-10s %9s %9s %9s %9s %9s %9s %9s %9s\n", "method", "in", "ns/call", "latency", "x stable",
			"bits", "50 %", "least", "missed", "phantom");
	for (size_t f = 0; f < plan->finder_count; f++) {
		const struct chart_side *side = &chart->finders[f][origin];
		bool best = side->best_bits[0] || side->best_bits[1];
		fprintf(stream, "%c %-18s %-10s", best ? '*' : ' ', plan->finders[f].method, plan->finders[f].arithmetic);
		print_numbers(
			stream,
			(double[]){side->throughput, side->latency, side->times_stable, side->bits, side->median, side->least}, 6);
		fprintf(stream, " %9" PRIu64 " %9" PRIu64 "\n", side->missed, side->phantom);
	}
}

static void print_engines(FILE *stream, const struct chart_plan *plan, const struct chart *chart)
{
	fprintf(stream,
			"\nEngines, %d elastic hard spheres; horizon: events per particle to be trusted, mean and deviation\n",
			CHART_SPHERES);
	fprintf(stream, "  %-18s %-10s %9s %9s %9s %9s %9s %s\n", "method", "in", "bits", "ns/event", "x stable", "horizon",
			"+-", "held against");
	for (size_t e = 0; e < plan->engine_count; e++) {
		const struct chart_engine *engine = &chart->engines[e];
		fprintf(stream, "%c %-18s %-10s", engine->best ? '*' : ' ', plan->engines[e].method,
				plan->engines[e].arithmetic);
		print_numbers(stream,
					  (double[]){engine->bits, engine->nanoseconds, engine->times_stable, engine->horizon.mean,
								 engine->horizon.deviation},
					  5);
		fprintf(stream, " %s\n", engine->reference);
	}
}

void chart_print(FILE *stream, const struct chart_plan *plan, const struct chart *chart)
{
	if (plan->finder_count)
		for (int origin = CHART_ORIGINS - 1; origin >= 0; origin--)
			print_finders(stream, plan, chart, (enum family_origin)origin);
	if (plan->engine_count) print_engines(stream, plan, chart);
	fprintf(stream, "\n%" PRIu64 " questions of each family, %d start states; %.3g s%s\n", chart->cases, chart->starts,
			chart->seconds, chart->interrupted ? ", interrupted" : "");
}

#include "bench/table.h"

#include <math.h>

enum { NAME = 40, CELL = 24 };

/* A number to so many digits, or a dash, at the right of a column. */
static void number(FILE *stream, int width, double value, int digits)
{
	char text[CELL] = "-";
	if (isfinite(value) && fabs(value) >= 1000)
		snprintf(text, sizeof text, "%.0f", value);
	else if (isfinite(value))
		snprintf(text, sizeof text, "%.*g", digits, value);
	fprintf(stream, " %*s", width, text);
}

/* A quotient, with as many places as matter. */
static void quotient(FILE *stream, double ratio)
{
	char text[CELL] = "-";
	if (isfinite(ratio)) snprintf(text, sizeof text, "%.3f", ratio);
	fprintf(stream, " %8s", text);
}

static void value(FILE *stream, const struct row *row, enum quantity quantity, const struct baseline *baseline)
{
	number(stream, 10, row->value[quantity].median, 4);
	quotient(stream, baseline_ratio(baseline, row, quantity));
}

static void quartiles(FILE *stream, const struct spread *spread)
{
	char text[2 * CELL] = "-";
	bool exact = isnan(spread->median) || spread->low == spread->high;
	if (!exact) snprintf(text, sizeof text, "%.4g..%.4g", spread->low, spread->high);
	fprintf(stream, " %16s", text);
}

void table_rows(FILE *stream, const struct row *rows, size_t count, const struct baseline *baseline)
{
	char made[100];
	fprintf(stream, "Medians, their quartiles, and quotients to the stored run%s%s: below 1 is less than then.\n\n",
			baseline ? " of " : " (there is none yet)", baseline ? baseline_made(baseline, made) : "");
	fprintf(stream, "%-*s %10s %16s %8s %10s %8s %10s %8s %10s %8s\n", NAME, "", "ns/event", "quartiles", "quotient",
			"instr.", "quotient", "bytes", "quotient", "start-up/s", "quotient");
	for (size_t r = 0; r < count; r++) {
		const struct row *row = &rows[r];
		if (isnan(row->value[NANOSECONDS].median)) continue;
		fprintf(stream, "%-*s", NAME, row->name);
		number(stream, 10, row->value[NANOSECONDS].median, 4);
		quartiles(stream, &row->value[NANOSECONDS]);
		quotient(stream, baseline_ratio(baseline, row, NANOSECONDS));
		value(stream, row, INSTRUCTIONS, baseline);
		value(stream, row, BYTES, baseline);
		value(stream, row, START_UP, baseline);
		putc('\n', stream);
	}
	putc('\n', stream);
	static const char *const units[QUANTITIES] = {[SECONDS] = "s", [TIMES] = "times one"};
	for (size_t r = 0; r < count; r++)
		for (enum quantity q = SECONDS; q <= TIMES; q++) {
			const struct row *row = &rows[r];
			if (isnan(row->value[q].median)) continue;
			fprintf(stream, "%-*s", NAME, row->name);
			number(stream, 10, row->value[q].median, 4);
			quartiles(stream, &row->value[q]);
			quotient(stream, baseline_ratio(baseline, row, q));
			fprintf(stream, " %s\n", units[q]);
		}
}

void table_demands(FILE *stream, const struct demand *demands, size_t count)
{
	fprintf(stream, "\n%-58s %10s %16s  %s\n", "Asked for", "found", "quartiles", "asked");
	for (size_t d = 0; d < count; d++) {
		const struct demand *demand = &demands[d];
		if (isnan(demand->found.median)) continue;
		fprintf(stream, "%-58s", demand->what);
		number(stream, 10, demand->found.median, 3);
		quartiles(stream, &demand->found);
		fprintf(stream, "  %s %g%s\n", demand->at_most ? "at most" : "at least", demand->limit,
				demand_met(demand) ? "" : ": not met");
	}
	putc('\n', stream);
}

/* What a result is: one thing measured, the claims it was held against, its tables and figures, and how it was made.
 *
 * A result is one JSON document stored as FOLDER/NAME.json; the format is told in schema.h. It is built up by the
 * functions below, in the order in which it is to be read, and knows nothing of what was simulated.
 *
 *	struct result *result = result_new("fig3", "Separation at impact");
 *	result_paragraph(result, "%llu collisions of %d spheres.", collisions, spheres);
 *	result_claim(result, &(struct result_claim){.quantity = "collisions below contact", .reported = "about half", ...});
 *	struct result_table table = result_table(result, "Moments", "in units of 1e-16", columns);
 *	table_row(table), table_text(table, "elastic"), table_number(table, mean);
 *	struct result_figure figure = result_figure(result, &(struct figure_frame){.kind = "curves", ...});
 *	struct figure_series series = figure_series(figure, "measured", SERIES_POINTS);
 *	series_row(series, (double[]){x, y, low, high});
 *	result_made_by(result, "touchstone reproduce fig3", seconds, revision);
 *	if (!result_write(result, "build/results", error)) ...
 *	result_free(result);
 *
 * All text is UTF-8 and is copied; NULL is no text, and bytes that are not UTF-8 become question marks. Builders do
 * not fail: what goes wrong on the way (no memory, a row of the wrong length) is told by result_write. Numbers may be
 * NaN ("no value") or infinite, and every double comes back bit for bit. Tables and series are handles into the
 * result, good until it is freed; there is nothing to release. One result belongs to one thread at a time. */
#ifndef REPORTS_RESULT_H
#define REPORTS_RESULT_H

#include "aside.h"
#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

struct result;

/* Starts a result, with today's date and the machine and compiler this program has to do with. The name is its
 * address: letters a to z, digits, '-' and '_' only. NULL when there is no memory. */
struct result *result_new(const char *name, const char *title);
void result_free(struct result *result); /* NULL is fine */

/* One paragraph of the summary: what was done and what came out. The first is shown on the overview. */
__attribute__((format(printf, 2, 3))) void result_paragraph(struct result *result, const char *format, ...);

/* Something to know when reading the numbers: a choice made, a doubt, an explanation that was tried. */
__attribute__((format(printf, 2, 3))) void result_note(struct result *result, const char *format, ...);

/* What the live page (build/live.html, beside the report) shows of it: a title for the link, and the page's parameters,
 * such as "scene=three-body&against=naive". */
void result_live(struct result *result, const char *title, const char *query);

/* The exact command that makes this result again, how many seconds of wall time it took, and the revision of the
 * source (NULL when it is not known). */
void result_made_by(struct result *result, const char *command, double seconds, const char *revision);

/* Marks the result as not what was asked for, and says how far it got: "stopped at 3.1e8 of 1e9 collisions". */
__attribute__((format(printf, 2, 3))) void result_incomplete(struct result *result, const char *format, ...);

/* ------------------------------------------------------------------ claims */

enum result_verdict { RESULT_AGREES, RESULT_DIFFERS, RESULT_NOT_COMPARABLE };

/* A printed value and what was measured here. */
struct result_claim {
	const char *quantity;       /* what it is: "collisions below contact" */
	const char *reported;       /* the paper's value as printed: "about half" */
	const char *where;          /* "2014, section 3 and fig. 3" */
	double measured;            /* NaN: not measured */
	double interval[2];         /* of the measured value; equal ends: none */
	const char *interval_means; /* "95 %, Clopper-Pearson" */
	const char *unit;           /* "per event"; NULL: a plain number */
	const char *shown;          /* how to print the measured value where the number alone is not it: "2 of 6 orders" */
	uint64_t count;             /* observations it rests on; 0: not a matter of counting */
	enum result_verdict verdict;
	const char *why; /* one or two sentences: the reason for the verdict, and what was tried */
};
void result_claim(struct result *result, const struct result_claim *claim);

/* ------------------------------------------------------------------ tables */

struct result_table {
	struct result *result;
	json_t *json;
};

/* Starts a table. `columns` are its headings, ended by NULL; `note` may be NULL. */
struct result_table result_table(struct result *result, const char *title, const char *note,
								 const char *const columns[]);

/* Starts a row; its cells follow from left to right, as many as there are columns. */
void table_row(struct result_table table);
__attribute__((format(printf, 2, 3))) void table_text(struct result_table table, const char *format, ...);
void table_number(struct result_table table, double value); /* shown with six digits, stored with all */
void table_count(struct result_table table, uint64_t count);
void table_hex(struct result_table table, double value); /* shown as a hex float, to be copied */

/* Text on a shade, for tables that are to be taken in at a glance: from level 0, nothing wrong, to TABLE_LEVELS - 1, as
 * wrong as can be. What semicolons part is shown on lines of its own. */
enum { TABLE_LEVELS = 5 };
__attribute__((format(printf, 3, 4))) void table_shaded(struct result_table table, unsigned level, const char *format,
														...);

/* Of the text or shaded cell appended last. Names are made as a result's name is. */
void table_anchor(struct result_table table, const char *name); /* names it, once in a result */
void table_link(struct result_table table, const char *anchor); /* a click leads to the cell so named in this result */
void table_live(struct result_table table, const char *query);  /* what the live page shows of it: see result_live */
void table_unseen(struct result_table table, const char *why);  /* what the live page does not show of it, and why */

/* ------------------------------------------------------------------ figures */

/* Kinds of figure, and the columns of numbers each needs (more are allowed, and go into the CSV):
 *
 *	impact-histogram  left right height         bars over the interval of reals that each number stands for; height is
 *	                                            a density (fraction per unit of x). SERIES_BARS are filled, SERIES_LINE
 *	                                            outlined; rows of touching intervals, in order. One panel per cell.
 *	trajectory        time height remaining     height over time, and again over the time that remains until rest, on
 *	                                            logarithmic axes. SERIES_ENDS has a cross where it stops.
 *	scaling           bits error                error over significand bits, with fits (series_fit) in the legend
 *	curves            x y low high              low and high are error bars: NaN for none
 *	bars              category value low high   grouped bars; category counts from 0 into the frame's categories
 *	discs             x radius speed touched    discs on a line with their velocities; touched is 1 for those that have
 *	                                            just collided. One panel per cell; the note stands in it.
 *	frontier          x y low high best         what each costs and is worth: points where best is 1 stand out, the
 *	                                            others are faint; SERIES_LINE is the frontier, from left to right.
 *	                                            Points are marked (series_mark). One panel per cell.
 *	trend             time y low high           over the days, time being seconds since 1970: SERIES_LINE is a band from
 *	                                            low to high around y, SERIES_POINTS are nights with their intervals,
 *	                                            SERIES_ENDS those that stand out. All may be marked.
 *	map               x y value                 a value > 0 on a logarithmic scale of colours, on an even grid of x and
 *y; NaN leaves a cell white. A point's name, where shown, stands in its cell
 */
struct figure_axis {
	const char *label;    /* with the unit: "time / s" */
	unsigned logarithmic; /* 0: linear; otherwise the base, 2 or 10 */
	double range[2];      /* equal ends: chosen from the data */
};

struct figure_frame {
	const char *name;        /* unique within the result; characters as in the result's name */
	const char *kind;        /* one of those above */
	const char *title;       /* short, above the figure */
	const char *caption;     /* below it: what is seen and what to notice */
	const char *alternative; /* for one who cannot see it: what the plot shows, in words */
	struct figure_axis x, y;
	const char *const *columns;    /* names of the numbers in each row, ended by NULL */
	const char *const *categories; /* of bars, ended by NULL; else NULL */
};

enum series_style {
	SERIES_LINE,
	SERIES_POINTS,
	SERIES_BARS,
	SERIES_ENDS, /* a line that stops: its last row is marked */
};

struct result_figure {
	struct result *result;
	json_t *json;
};

struct figure_series {
	struct result *result;
	json_t *json;
	size_t width; /* numbers per row */
};

struct result_figure result_figure(struct result *result, const struct figure_frame *frame);
struct figure_series figure_series(struct result_figure figure, const char *label, enum series_style style);

/* Appends one row: as many numbers as the figure has columns. */
void series_row(struct figure_series series, const double *values);

/* Names the row appended last. Of a series either all rows are marked or none. */
struct series_mark {
	const char *name;  /* stands in the CSV and, where `shown`, beside the point */
	const char *title; /* appears when the pointer rests on the point */
	const char *link;  /* where a click leads: an address within the report; NULL for nowhere */
	bool shown;
};
void series_mark(struct figure_series series, const struct series_mark *mark);

/* Puts the series into a small multiple: the panel in the row and the column of these names, which appear in the
 * order in which they are first named. `note` (or NULL) is printed in the panel: "49.8 % below contact". */
void series_panel(struct figure_series series, const char *row, const char *column, const char *note);

/* A straight line through the series as it is plotted: log_base(y) = intercept + slope * x. None is drawn if one of
 * them is not finite. */
void series_fit(struct figure_series series, double slope, double intercept);

/* ------------------------------------------------------------------ storing */

/* Writes FOLDER/NAME.json, making the folder if need be. False with a message when the result is not sound or the
 * file cannot be written; nothing partial is left behind. */
bool result_write(const struct result *result, const char *folder, char error[REPORT_ERROR]);

/* Reads a result back. NULL with a message when the file is not there, is damaged, or has a schema other than ours. */
struct result *result_read(const char *path, char error[REPORT_ERROR]);

/* The whole result, as schema.h describes it; belongs to the result. */
const json_t *result_document(const struct result *result);

#endif

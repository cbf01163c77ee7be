/* The stored form of a result, touchstone-result-1: one JSON object.
 *
 *	schema       "touchstone-result-1"
 *	name, title  text
 *	date         UTC, "2024-05-01T12:00:00Z"
 *	complete     true, or false when the run was stopped; then `reached` says how far it got
 *	command      the command that makes it again; seconds: of wall time; revision: of the source (these may be missing)
 *	machine      {processor, cores, memory_bytes, system, compiler}
 *	summary      [paragraph, ...]
 *	claims       [{quantity, reported, where, measured, interval: [low, high], interval_means, unit, shown, count,
 *	             verdict: "agrees" | "differs" | "not comparable", why}]; interval, interval_means, unit, shown and
 *	             count may be missing
 *	tables       [{title, note (may be missing), columns: [heading, ...], rows: [[cell, ...], ...]}], a cell being
 *	             text, a number, null for no value, or {text, level, anchor, link, live}: text on a shade, level 0 to 4,
 *	             with a name, a link to the cell of that name, and what the live page shows of it; all but the text
 *	             may be missing
 *	figures      [{name, kind, title, caption, alternative, x: {label, log, range: [low, high]}, y: likewise,
 *	             columns: [name, ...], categories: [name, ...] (may be missing),
 *	             series: [{label, style: "line" | "points" | "bars" | "ends", rows: [[number, ...], ...],
 *	             panel: {row, column, note}, fit: {slope, intercept}, marks: [{name, title, link, shown}, ...]}]}];
 *	             panel, fit and marks may be missing, and a mark's link; there are as many marks as rows
 *	notes        [paragraph, ...]
 *	live         [{title, query}], what the live page shows of it; may be missing
 *
 * Numbers are decimal with 17 digits, which gives every double back; null stands for NaN, and the texts "inf" and
 * "-inf" for infinities. Further keys are allowed and ignored; a change of meaning gets a new schema name. */
#ifndef REPORTS_SCHEMA_H
#define REPORTS_SCHEMA_H

#include "aside.h"
#include <jansson.h>
#include <stdbool.h>

#define RESULT_SCHEMA "touchstone-result-1"

/* Whether the document is a result, whole and sound; if not, the message begins with `place` and says where. */
bool schema_check(const json_t *document, const char *place, char error[REPORT_ERROR]);

/* A number as it is stored, and back. NaN stands for whatever is no number. */
json_t *schema_number(double value);
double schema_double(const json_t *number);

#endif

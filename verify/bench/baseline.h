/* A stored benchmark that later ones are held against: one JSON object,
 *
 *	schema         "touchstone-bench-1"
 *	machine, date  as in a result (schema.h), command, and revision where it is known
 *	rows           [{name, QUANTITY: [median, low, high], ...}], with the quantities of findings.h that it has
 */
#ifndef VERIFY_BENCH_BASELINE_H
#define VERIFY_BENCH_BASELINE_H

#include <jansson.h>

#include "aside.h"
#include "bench/findings.h"

struct baseline;

enum baseline_state {
	BASELINE_SOUND,
	BASELINE_ABSENT,
	BASELINE_FOREIGN, /* of another machine: numbers that cannot be compared */
	BASELINE_DAMAGED,
};

/* Reads one; `machine` is this one (provenance.h). It is *baseline, which the caller frees, when it is sound; NULL
 * otherwise, with a message that says why. */
enum baseline_state baseline_read(const char *path, const json_t *machine, struct baseline **baseline,
								  char error[REPORT_ERROR]);
void baseline_free(struct baseline *baseline); /* NULL is fine */

/* "2024-05-01T12:00:00Z, revision 39dc0da, make bench". Returns `text`. */
const char *baseline_made(const struct baseline *baseline, char text[100]);

/* The stored value of a row; NaN when it has none, or there is no baseline. */
struct spread baseline_value(const struct baseline *baseline, const char *name, enum quantity quantity);

/* A value over the stored one; NaN when there is none. */
double baseline_ratio(const struct baseline *baseline, const struct row *row, enum quantity quantity);

/* Stores rows beside where they come from: the keys machine, date, command and revision of a result's document. False
 * with a message when that cannot be written. */
bool baseline_write(const char *path, const json_t *document, const struct row *rows, size_t count,
					char error[REPORT_ERROR]);

#endif

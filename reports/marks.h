/* Points that answer: over a drawn figure lies a layer of invisible discs, one on each marked point (series_mark), with
 * a text that appears under the pointer and a link to click on. No script is needed, and it works from disk. */
#ifndef REPORTS_MARKS_H
#define REPORTS_MARKS_H

#include "aside.h"
#include <jansson.h>
#include <stdbool.h>

/* Whether any point of the figure is marked. */
bool marks_any(const json_t *figure);

/* Adds the layer to an SVG file that gnuplot wrote, and names the whole by the figure's title. `places` is a file with
 * one line a point: number of the series, number of the row, and where it is, in pixels from the left and the top.
 * Links to other than `pages`, a list of names, are left out. False with a message; the SVG then may be anything. */
bool marks_add(const json_t *figure, const json_t *pages, const char *places, const char *svg,
			   char error[REPORT_ERROR]);

#endif

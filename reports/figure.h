/* Figures: drawn by gnuplot from a stored figure, one plot script per kind. */
#ifndef REPORTS_FIGURE_H
#define REPORTS_FIGURE_H

#include "aside.h"
#include <jansson.h>
#include <stdbool.h>

/* The first column a figure of this kind needs and has not; NULL when it has all, or when the kind is not known. */
const char *figure_missing_column(const char *kind, const json_t *columns);

/* Draws FOLDER/STEM.svg and FOLDER/STEM.pdf. Of links only those are followed that lead to one of `pages`, a list of
 * names. False with a message when gnuplot is missing or fails; then neither file is touched. */
bool figure_draw(const json_t *figure, const json_t *pages, const char *folder, const char *stem,
				 char error[REPORT_ERROR]);

#endif

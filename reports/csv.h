/* The numbers of a result as comma-separated values (RFC 4180), every double with all its digits. */
#ifndef REPORTS_CSV_H
#define REPORTS_CSV_H

#include <jansson.h>
#include <stdio.h>

/* One line of headings, then one line a row. A value that is not there is an empty field. */
void csv_table(FILE *stream, const json_t *table);

/* panel_row, panel_column, series, where points have names (series_mark) the name, then the figure's own columns; one
 * line a point. */
void csv_figure(FILE *stream, const json_t *figure);

#endif

/* The report: pages made from stored results, to be opened from disk. */
#ifndef REPORTS_PAGE_H
#define REPORTS_PAGE_H

#include "aside.h"
#include <stdbool.h>

/* Reads every result (*.json) in one folder and writes the report into another: index.html, a page for each result,
 * its figures as SVG and PDF, all numbers as CSV. False with a message, before anything is written, when a result is
 * damaged or there is none, and when the report cannot be written. On true, `error` is empty or says in one line what
 * had to be left out (figures, where gnuplot is missing); the pages say so too. */
bool report_write(const char *results_folder, const char *report_folder, char error[REPORT_ERROR]);

#endif

/* What came of an audit as JUnit XML, the form in which continuous-integration systems read test results: one test
 * suite, a test case for each measure. */
#ifndef REPORTS_JUNIT_H
#define REPORTS_JUNIT_H

#include "aside.h"
#include <jansson.h>
#include <stdbool.h>

/* Writes the file at a path ("-": standard output). `audit` is an object with
 *
 *	suite, date, seconds, tests, failures, errors, skipped    the name, UTC, and how many test cases of each outcome
 *	checks  [{check, measures: [{measure, seconds, finding, error, unreached, shown}]}]
 *
 * where a measure has at most one of the texts finding, error and unreached; `shown`, what was found out, may be
 *missing. False with a message when the file cannot be written. */
bool junit_write(const char *path, const json_t *audit, char error[REPORT_ERROR]);

#endif

/* The history as results for the report: each check's measures over time, all audits, and those audits that found
 * something. */
#ifndef VERIFY_AUDIT_TRENDS_H
#define VERIFY_AUDIT_TRENDS_H

#include "aside.h"
#include "store/history.h"

enum { TREND_PAGES = 30 }; /* audits that get a page of their own: the last ones with findings, and the last of all */

/* Writes the results into a folder: trend-CHECK for each check, audits, and audit-NUMBER. False with a message. */
bool trends_write(struct history *history, const char *folder, char error[REPORT_ERROR]);

#endif

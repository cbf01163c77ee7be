/* What a campaign's runs come to, as tables: {"columns": [...], "rows": [[...], ...]}, as reports/csv.h writes them. */
#ifndef VERIFY_CAMPAIGN_TABLE_H
#define VERIFY_CAMPAIGN_TABLE_H

#include "campaign/campaign_file.h"
#include "result.h"

/* One row a run: the grid's keys, seed, verdict, digest, then every number that `run --json` tells, members of objects
 * under dotted names. Runs that are missing (null) have no row. The caller owns the table. */
json_t *campaign_table_runs(const struct campaign_file *file, const json_t *results);

/* One row a point of the grid: its keys, how many runs there are and how they ended, then for every number its mean
 * over the seeds, its standard deviation and how many runs have it. A number that no run has is null; so is the
 * deviation of fewer than two. The caller owns the table. */
json_t *campaign_table_points(const struct campaign_file *file, const json_t *results);

/* The few numbers of a points table that tell most, "mean ± deviation" in one cell. The caller owns the table. */
json_t *campaign_table_telling(const struct campaign_file *file, const json_t *points);

/* A result for the report, with that table; `finished` of all runs are there. NULL when out of memory. */
struct result *campaign_table_result(const struct campaign_file *file, const json_t *telling, size_t finished);

#endif

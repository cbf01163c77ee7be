/* A suite: what an audit checks, in YAML. The keys are explained at the top of cases/suites/standard.yaml.
 *
 * Everything that is wrong with one is said on one line, "FILE:LINE: key: what; accepted: what", before anything is
 * measured. */
#ifndef VERIFY_AUDIT_SUITE_H
#define VERIFY_AUDIT_SUITE_H

#include "audit/quantity.h"
#include "store/scene_file.h"
#include "touchstone.h"

/* One measure of a check and its thresholds: NaN or NULL where there is none. */
struct suite_measure {
	char name[80]; /* the quantity's, and the claim's */
	const struct quantity_entry *quantity;
	enum measure_worse worse;
	const char *claim;                    /* of a figure: words of the claim's quantity */
	const char *equal, *same_in;          /* a word; an arithmetic in which the digest must be the same */
	double at_most, at_least;             /* of the value itself */
	double at_most_times, at_least_times; /* of the median of the last good nights */
};

struct suite_check {
	const char *name;
	enum check_kind kind;
	double weight;  /* the most telling has the largest */
	uint64_t seeds; /* repetitions */
	bool own_seed;  /* it begins with `seed`, whatever the audit's seed is */
	uint64_t seed;
	char *scene;     /* path of the scene's file */
	char **settings; /* of the scene, KEY=VALUE */
	size_t setting_count;
	const char *method, *arithmetic; /* of a grade */
	const struct family *family;
	enum touchstone_shape shape;
	uint64_t cases;
	const char *figure;
	bool full; /* at the paper's own size, not at the quick one */
	struct suite_measure *measures;
	size_t measure_count;
	char *definition; /* what exactly is measured, without names, weights and thresholds */
};

struct suite {
	char *name; /* of the file, without folder and ending */
	const char *title, *about;
	double false_alarms; /* chance of an audit to raise one */
	struct suite_check *checks;
	size_t check_count; /* the most telling first */
	struct suite_source *source;
};

/* Reads a suite; its scenes are looked for in the folder `cases`. NULL with a message when it, or a scene it names, is
 * not what it should be. */
struct suite *suite_open(const char *path, const char *cases, char error[STORE_ERROR]);
void suite_close(struct suite *suite); /* NULL is fine */

/* Opens the scene of a check, in another arithmetic if one is given. NULL with a message. */
struct scene_file *suite_scene(const struct suite_check *check, const char *arithmetic, char error[STORE_ERROR]);

#endif

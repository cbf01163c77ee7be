/* What can be measured of a run: the words of `run --measure`, and of `measures` in a campaign. */
#ifndef VERIFY_RUN_MEASURES_H
#define VERIFY_RUN_MEASURES_H

/* One bit each. */
enum run_measure {
	RUN_IMPACT = 1 << 0,
	RUN_CONSERVATION = 1 << 1,
	RUN_THREE_BODY = 1 << 2,
	RUN_FAILURE = 1 << 3,
	RUN_STATES = 1 << 4,
};

struct run_measure_entry {
	const char *name;
	enum run_measure measure;
	const char *about;
};
extern const struct run_measure_entry run_measures[]; /* the name of the last one is NULL */

/* The measure of that name, or 0. */
unsigned run_measure_named(const char *name);

/* All names, parted by commas. Returns `names`. */
enum { RUN_MEASURE_NAMES = 100 };
const char *run_measure_names(char names[RUN_MEASURE_NAMES]);

#endif

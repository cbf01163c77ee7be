/* The keys of a suite, as libcyaml reads them: words, still to be understood. A key that is absent is NULL. */
#ifndef VERIFY_AUDIT_SUITE_SCHEMA_H
#define VERIFY_AUDIT_SUITE_SCHEMA_H

#include <cyaml/cyaml.h>

struct measure_words {
	char *measure, *claim, *equal, *same_in, *at_most, *at_least, *at_most_times, *at_least_times;
	int *worse; /* enum measure_worse */
};

struct check_words {
	char *name, *weight, *seeds, *seed;
	char *scene, *events, *method, *arithmetic, **set;
	char *grade, *family, *shape, *cases;
	char *figure, *size;
	struct measure_words *measures;
	unsigned set_count, measures_count;
};

struct suite_words {
	char *title, *about, *false_alarms;
	struct check_words *checks;
	unsigned checks_count;
};

/* Of type pointer to struct suite_words. */
extern const cyaml_schema_value_t suite_schema;

#endif

/* What a suite points into, and how its parts refuse. For the parts of the suite's reader only. */
#ifndef VERIFY_AUDIT_SUITE_SOURCE_H
#define VERIFY_AUDIT_SUITE_SOURCE_H

#include "audit/suite.h"
#include "audit/suite_schema.h"
#include "store/yaml_text.h"

struct suite_source {
	struct yaml_text text;
	struct suite_words *words;
	bool read; /* whether there is a text to close */
};

/* A key of a suite in hand: "checks[3]" and "at_most" name checks[3].at_most. */
struct suite_place {
	const struct suite_source *source;
	char path[YAML_PATH];
	char *error;
};

/* Says what is wrong with a key below the place ("": with the place itself), and returns false. */
__attribute__((format(printf, 3, 4))) bool suite_refuse(const struct suite_place *place, const char *key,
														const char *format, ...);

/* A number from `least` to `most`, a whole one; an absent word (NULL) leaves the value as it is. */
bool suite_number(const struct suite_place *place, const char *key, const char *word, double least, double most,
				  double *value);
bool suite_count(const struct suite_place *place, const char *key, const char *word, uint64_t least, uint64_t most,
				 uint64_t *value);

/* Understands the words of one check and of its measures. */
bool suite_check_understand(const struct suite_place *place, const struct check_words *words, const char *cases,
							struct suite_check *check);
bool suite_measures_understand(const struct suite_place *place, const struct check_words *words,
							   struct suite_check *check);

#endif

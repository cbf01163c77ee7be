#include "audit/suite_schema.h"

#include "audit/measurement.h"

/* Every value is a pointer, so that what is absent can be told from what is 0. */
enum { WORD = CYAML_FLAG_OPTIONAL | CYAML_FLAG_POINTER, CHOICE = WORD | CYAML_FLAG_STRICT };

static const cyaml_strval_t ways[] = {{"more", WORSE_MORE}, {"less", WORSE_LESS}, {"either", WORSE_EITHER}};

static const cyaml_schema_value_t setting = {CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char, 0, CYAML_UNLIMITED)};

static const cyaml_schema_field_t measure_fields[] = {
	CYAML_FIELD_STRING_PTR("measure", WORD, struct measure_words, measure, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("claim", WORD, struct measure_words, claim, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("equal", WORD, struct measure_words, equal, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("same_in", WORD, struct measure_words, same_in, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("at_most", WORD, struct measure_words, at_most, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("at_least", WORD, struct measure_words, at_least, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("at_most_times", WORD, struct measure_words, at_most_times, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("at_least_times", WORD, struct measure_words, at_least_times, 0, CYAML_UNLIMITED),
	CYAML_FIELD_ENUM_PTR("worse", CHOICE, struct measure_words, worse, ways, CYAML_ARRAY_LEN(ways)),
	CYAML_FIELD_END};
static const cyaml_schema_value_t measure = {
	CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, struct measure_words, measure_fields)};

static const cyaml_schema_field_t check_fields[] = {
	CYAML_FIELD_STRING_PTR("name", WORD, struct check_words, name, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("weight", WORD, struct check_words, weight, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("seeds", WORD, struct check_words, seeds, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("seed", WORD, struct check_words, seed, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("scene", WORD, struct check_words, scene, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("events", WORD, struct check_words, events, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("method", WORD, struct check_words, method, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("arithmetic", WORD, struct check_words, arithmetic, 0, CYAML_UNLIMITED),
	CYAML_FIELD_SEQUENCE("set", WORD, struct check_words, set, &setting, 1, 100),
	CYAML_FIELD_STRING_PTR("grade", WORD, struct check_words, grade, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("family", WORD, struct check_words, family, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("shape", WORD, struct check_words, shape, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("cases", WORD, struct check_words, cases, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("figure", WORD, struct check_words, figure, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("size", WORD, struct check_words, size, 0, CYAML_UNLIMITED),
	CYAML_FIELD_SEQUENCE("measures", WORD, struct check_words, measures, &measure, 1, 100),
	CYAML_FIELD_END};
static const cyaml_schema_value_t check = {CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, struct check_words, check_fields)};

static const cyaml_schema_field_t fields[] = {
	CYAML_FIELD_STRING_PTR("title", WORD, struct suite_words, title, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("about", WORD, struct suite_words, about, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("false_alarms", WORD, struct suite_words, false_alarms, 0, CYAML_UNLIMITED),
	CYAML_FIELD_SEQUENCE("checks", WORD, struct suite_words, checks, &check, 1, 1000), CYAML_FIELD_END};

const cyaml_schema_value_t suite_schema = {CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, struct suite_words, fields)};

/* One number, or one word, that an audit finds out, with what is needed to hold it against that of another night. */
#ifndef VERIFY_AUDIT_MEASUREMENT_H
#define VERIFY_AUDIT_MEASUREMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "measure/spread.h"

enum measure_nature {
	MEASURE_WORD,       /* a digest or a verdict: the same for the same seed, or not */
	MEASURE_PROPORTION, /* hits among a number of trials */
	MEASURE_RATE,       /* hits per unit of exposure, without a limit to how many */
	MEASURE_SAMPLE,     /* a value for each seed; the same seed gives the same value, different ones are independent */
	MEASURE_TIMING,     /* a value for each repetition; how busy the machine is differs from night to night */
};
enum { MEASURE_NATURES = 5 };

/* Which way it gets worse. */
enum measure_worse { WORSE_MORE, WORSE_LESS, WORSE_EITHER };

enum { MEASURE_WORDS = 48 }; /* room for a word */

struct measurement {
	enum measure_nature nature;
	double value;          /* the proportion, the rate, the median; NaN for a word */
	double low, high;      /* its 95 % interval; of a sample, its quartiles */
	uint64_t count;        /* observations it rests on */
	double hits, exposure; /* of a proportion or a rate */
	struct sample sample;  /* of a sample or a timing */
	char word[MEASURE_WORDS];
};

struct measurement measurement_word(const char *word);
struct measurement measurement_proportion(uint64_t hits, uint64_t trials);
struct measurement measurement_rate(uint64_t hits, double exposure);
struct measurement measurement_sample(enum measure_nature nature, const struct sample *sample);

/* "proportion", and back; false for an unknown word. */
const char *nature_name(enum measure_nature nature);
bool nature_named(const char *name, enum measure_nature *nature);
const char *worse_name(enum measure_worse worse); /* "more", "less", "either" */
bool worse_named(const char *name, enum measure_worse *worse);

/* As people read it: the word, or the value with count and interval. Returns `text`. */
enum { MEASUREMENT_TEXT = 120 };
const char *measurement_text(const struct measurement *measured, char text[MEASUREMENT_TEXT]);

#endif

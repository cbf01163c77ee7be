/* The finders of all methods: a byte for the shape, then numbers. A fault is an answer that breaks what the method's
 * file claims, in binary64. */
#include "fuzz/target/target.h"

#include <math.h>
#include <string.h>

#include "fuzz/corpus.h"
#include "measure/finder_grade.h"

static void ask(struct oracle *oracle, const char *method, enum touchstone_shape shape, const double *number)
{
	char why[160], words[320];
	const struct finder finder = {.method = method, .arithmetic = "binary64"};
	if (!finder_answers(&finder, shape, why)) return;
	struct fuzz_subject subject = fuzz_subject(&finder, shape, NAN);
	struct fuzz_case one = {.questions = 1};
	memcpy(one.number[0], number, sizeof one.number[0]);
	if (!subject.claims || !fuzz_try(&subject, oracle, &one) || !one.promised) return;
	fuzz_words(&subject, &one, words);
	fprintf(stderr, "%s: %s\n", method, words);
	abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static struct oracle *oracle;
	double number[TOUCHSTONE_MOST_NUMBERS] = {0};
	if (!oracle && !(oracle = oracle_create())) abort();
	if (size < 1) return -1;
	enum touchstone_shape shape = (enum touchstone_shape)(data[0] % TOUCHSTONE_SHAPES);
	size_t wanted = shape_numbers(shape) * sizeof *number;
	if (size - 1 < wanted) return -1;
	memcpy(number, data + 1, wanted);
	struct oracle_query query = finder_question(shape, number);
	if (!oracle_accepts(&query)) return -1;
	for (size_t m = 0; touchstone_finder_name(m); m++) ask(oracle, touchstone_finder_name(m), shape, number);
	return 0;
}

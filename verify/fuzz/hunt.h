/* The hunt: round after round, questions from the families and from the corpus, changed, asked and judged. What it
 * finds depends on the seed and the corpus, and neither on threads nor on time, which only says how far it gets. */
#ifndef VERIFY_FUZZ_HUNT_H
#define VERIFY_FUZZ_HUNT_H

#include "fuzz/failure.h"
#include "store/query_file.h"

/* A failure, as it was met and as it was shrunk. */
struct fuzz_finding {
	struct fuzz_case first, shrunk; /* shrunk: the simplest so far */
	uint64_t met;                   /* number of questions that fail alike, this one included */
	uint64_t question;              /* how many were asked before it */
	double seconds;                 /* into the hunt */
};

struct fuzz_hunt {
	struct fuzz_subject subject;
	uint64_t seed;
	int threads;
	double seconds;     /* at most; INFINITY: until the questions are asked */
	uint64_t questions; /* at most, but whole rounds */
	const volatile int *stop;

	/* what questions are made from besides the families: those of the subject's shape */
	double (*corpus)[TOUCHSTONE_MOST_NUMBERS];
	size_t corpus_count, corpus_room;

	uint64_t rounds; /* done so far, by earlier hunts too: begin with 0, or where one left off */

	/* told of each new finding, and again when it has become simpler; may be NULL */
	void (*tell)(void *context, const struct fuzz_finding *finding);
	void (*progress)(void *context, double part); /* may be NULL */
	void *context;

	/* what came of it */
	uint64_t asked;
	double elapsed;
	struct fuzz_finding *finding;
	size_t findings;
	bool given_up; /* a plug-in that crashes or hangs too often to go on */
};

/* Adds a question to the corpus. False when out of memory. */
bool fuzz_feed(struct fuzz_hunt *hunt, const double number[TOUCHSTONE_MOST_NUMBERS]);

/* Asks the corpus, then hunts. False with one line in `error`; end with fuzz_hunt_free either way. */
bool fuzz_hunt(struct fuzz_hunt *hunt, char error[160]);
void fuzz_hunt_free(struct fuzz_hunt *hunt);

#endif

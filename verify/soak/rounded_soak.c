/* `rounded` against the exact oracle, for as many questions as one has time for: `rounded_soak 1e9` asks that many, and
 * `make soak` until its share of the time is over. Three in four are random balls that approach, touch, graze or fall; the others are the
 * families that were built to be hard, in turn. Ctrl-C ends it with what was found so far. Exit status: 0 when none was
 * wrong, 1 when one was, 2 for wrong usage. */
#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/interrupt.h"
#include "command/progress.h"
#include "family/family.h"
#include "oracle/oracle.h"
#include "scene/random.h"
#include "touchstone.h"

enum { CHUNK = 8192, SEED = 20140501 };

struct asked {
	double number[CHUNK][TOUCHSTONE_MOST_NUMBERS], time[CHUNK];
};

struct tally {
	uint64_t asked, exact, wrong;
};

static double between(struct random_state *random, double least, double most)
{
	return least + (most - least) * random_uniform(random);
}

static int below(struct random_state *random, uint64_t limit)
{
	return (int)random_below(random, limit);
}

/* Two balls some distance apart that fly more or less at each other. */
static void draw_approach(struct random_state *random, double *number)
{
	for (int axis = 0; axis < 3; axis++) {
		number[axis] = between(random, -2, 2);
		number[3 + axis] = between(random, -1, 1) - number[axis] / 2;
	}
	number[6] = 1;
}

/* In or next to contact, by a distance of any order of magnitude. */
static void draw_contact(struct random_state *random, double *number)
{
	draw_approach(random, number);
	double distance = sqrt(number[0] * number[0] + number[1] * number[1] + number[2] * number[2]);
	double wanted = 1 + ldexp(between(random, -1, 1), -below(random, 54));
	for (int axis = 0; axis < 3; axis++) number[axis] *= wanted / distance;
}

/* Passing at the contact distance, more or less by any order of magnitude. */
static void draw_graze(struct random_state *random, double *number)
{
	double angle = between(random, 0, 7), flight = between(random, -1, 8), miss = between(random, -1, 1);
	double passes = 1 + ldexp(miss, -below(random, 54)), speed = between(random, 0.1, 3);
	double along[2] = {cos(angle), sin(angle)};
	memset(number, 0, TOUCHSTONE_MOST_NUMBERS * sizeof *number);
	number[0] = -along[1] * passes - along[0] * flight;
	number[1] = along[0] * passes - along[1] * flight;
	number[3] = along[0] * speed, number[4] = along[1] * speed;
	number[6] = 1;
}

/* Random questions of balls, or of a falling ball. */
static enum touchstone_shape draw_random(uint64_t chunk, struct asked *asked)
{
	static void (*const draw[])(struct random_state *, double *) = {draw_approach, draw_approach, draw_contact,
																	draw_graze};
	static const enum touchstone_shape shapes[] = {TOUCHSTONE_BALL_BALL, TOUCHSTONE_BALL_BALL, TOUCHSTONE_BALL_LEAVE,
												   TOUCHSTONE_BALL_PLANE};
	struct random_state random = random_seed(SEED + chunk);
	enum touchstone_shape shape = shapes[chunk % 4];
	for (int k = 0; k < CHUNK; k++) {
		double *number = asked->number[k];
		draw[k % 4](&random, number);
		if (shape == TOUCHSTONE_BALL_PLANE) number[2] = -fabs(number[2]), number[3] = 0.5;
	}
	return shape;
}

/* The family and shape whose turn it is, of those that were built to be hard. */
static const struct family *choose_family(uint64_t turn, enum touchstone_shape *shape)
{
	const struct family *family, *hard[256];
	enum touchstone_shape shapes[256];
	size_t count = 0;
	for (size_t f = 0; (family = family_at(f)); f++)
		for (int s = 0; s < TOUCHSTONE_SHAPES && count < 256; s++)
			if (family->origin == FAMILY_HAND_MADE && family->shapes >> s & 1)
				hard[count] = family, shapes[count++] = (enum touchstone_shape)s;
	*shape = shapes[turn % count];
	return hard[turn % count];
}

/* Fills a chunk: one in four with a family. */
static enum touchstone_shape draw_chunk(uint64_t chunk, struct asked *asked)
{
	char error[160];
	enum touchstone_shape shape;
	if (chunk % 4) return draw_random(chunk - chunk / 4, asked);
	const struct family *family = choose_family(chunk / 4, &shape);
	if (family_fill(family, shape, SEED, chunk * CHUNK, CHUNK, asked->number, error)) return shape;
	fprintf(stderr, "rounded_soak: %s\n", error);
	exit(2);
}

static void answer_chunk(struct oracle *oracle, uint64_t chunk, struct asked *asked, struct tally *tally)
{
	enum touchstone_shape shape = draw_chunk(chunk, asked);
	const double(*number)[TOUCHSTONE_MOST_NUMBERS] = (const double(*)[TOUCHSTONE_MOST_NUMBERS])asked->number;
	char error[160];
	if (!touchstone_find("binary64", "rounded", shape, number, CHUNK, false, asked->time, error)) {
		fprintf(stderr, "rounded_soak: %s\n", error);
		exit(2);
	}
	tally->asked += CHUNK;
	tally->exact += touchstone_exact_count(shape, number, CHUNK);
	for (int k = 0; k < CHUNK; k++) {
		struct oracle_query query = {.shape = (enum oracle_shape)shape};
		memcpy(query.number, asked->number[k], sizeof query.number);
		struct oracle_time time = oracle_solve(oracle, &query);
		double expected = oracle_round(oracle, &time, MPFR_RNDN);
		if (memcmp(&expected, &asked->time[k], sizeof expected) == 0) continue;
		if (tally->wrong++ >= 10) continue;
		const double *n = asked->number[k];
#pragma omp critical
		printf("wrong: shape %d, %a %a %a %a %a %a %a: %a instead of %a\n", (int)shape, n[0], n[1], n[2], n[3], n[4],
			   n[5], n[6], asked->time[k], expected);
	}
}

static struct tally soak(uint64_t chunks)
{
	struct tally total = {0};
	struct progress progress = progress_begin("rounded", "questions");
	uint64_t next = 0;
#pragma omp parallel
	{
		struct tally tally = {0};
		struct oracle *oracle = oracle_create();
		struct asked *asked = malloc(sizeof *asked);
		while (oracle && asked && !interrupted()) {
			uint64_t chunk;
#pragma omp atomic capture
			chunk = next++;
			if (chunk >= chunks) break;
			answer_chunk(oracle, chunk, asked, &tally);
#pragma omp critical
			progress_show(&progress, (double)chunk * CHUNK, (double)chunks * CHUNK);
		}
#pragma omp critical
		{
			total.asked += tally.asked;
			total.exact += tally.exact;
			total.wrong += tally.wrong;
		}
		free(asked);
		oracle_destroy(oracle);
		mpfr_free_cache();
	}
	progress_end(&progress);
	return total;
}

int main(int count, char **arguments)
{
	char *end = "";
	double wanted = count == 2 ? strtod(arguments[1], &end) : 1e9;
	if (count > 2 || *end || !(wanted >= 1 && wanted <= 1e15)) {
		fprintf(stderr, "rounded_soak: accepted is one number of questions, 1 to 1e15 (1e9 if none is given)\n");
		return 2;
	}
	interrupt_watch();
	double began = progress_clock();
	struct tally total = soak((uint64_t)ceil(wanted / CHUNK));
	printf("%" PRIu64 " questions, %" PRIu64 " of them answered by the exact path, %" PRIu64
		   " wrong; %.3g per second on %d threads%s\n",
		   total.asked, total.exact, total.wrong, (double)total.asked / (progress_clock() - began),
		   omp_get_max_threads(), interrupted() ? "; interrupted" : "");
	return total.wrong ? 1 : 0;
}

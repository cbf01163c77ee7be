/* The sieve of every machine held against all meetings, reckoned in long double: the earliest is never left out, nor
 * one that comes near it; and most of the others are. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "engine/cells.h"
#include "engine/sieve.h"
#include "scene/random.h"
#include "test/long_double.h"

enum { PARTICLES = 60, ROOM = PARTICLES + 32 };

struct particle { /* what the shadow is cast of */
	double position[3], velocity[3], time, radius;
};

static struct random_state randomness;
static bool judges; /* whether long double is good enough to tell what may be left out */

static double between(double low, double high)
{
	return low + (high - low) * random_uniform(&randomness);
}

/* The wait from `now` until two meet, by the stable rule; INFINITY if they do not. */
static long double meeting(const struct particle *a, const struct particle *b, const double shift[3], double now)
{
	long double rr = 0, rv = 0, vv = 0, contact = (long double)a->radius + b->radius;
	for (int axis = 0; axis < 3; axis++) {
		long double own = a->position[axis] + (long double)a->velocity[axis] * ((long double)now - a->time);
		long double other = b->position[axis] + (long double)b->velocity[axis] * ((long double)now - b->time);
		long double r = own - other - shift[axis], v = (long double)a->velocity[axis] - b->velocity[axis];
		rr += r * r, rv += r * v, vv += v * v;
	}
	long double c = rr - contact * contact, d = rv * rv - vv * c;
	if (rv >= 0 || (c > 0 && d <= 0)) return INFINITY;
	return c <= 0 ? 0 : c / (sqrtl(d) - rv);
}

/* Their distance then. */
static long double distance_at(const struct particle *a, const struct particle *b, const double shift[3], double now)
{
	long double square = 0;
	for (int axis = 0; axis < 3; axis++) {
		long double own = a->position[axis] + (long double)a->velocity[axis] * ((long double)now - a->time);
		long double other = b->position[axis] + (long double)b->velocity[axis] * ((long double)now - b->time);
		square += (own - other - shift[axis]) * (own - other - shift[axis]);
	}
	return sqrtl(square);
}

static void cast(const struct sieve_machine *machine, struct shadow *shadow, const struct particle *p)
{
	machine->cast(shadow, p->position[0], p->position[1], p->position[2], p->time, p->velocity[0], p->velocity[1],
				  p->velocity[2], p->radius);
}

/* A sieve in a periodic box at a time, for binary64. */
static struct sieve sieve_at(double box, double now)
{
	return (struct sieve){.box = {(float)box, (float)box, (float)box},
						  .boxes = 3 * (float)box,
						  .length = (float)between(0.5, 8),
						  .now = (float)now,
						  .span = (float)now,
						  .age = 0, /* the one that searches has just had an event */
						  .roundoff = 0x1p-53f,
						  .drift = 0x1p-40f,
						  .late = 0x1p-40f};
}

/* A search beside one that begins later in its list leaves the same as alone, and so does the other. */
static void two_at_once(const struct sieve_machine *machine, const struct sieve *sieve, const struct shadow *shadow,
						const uint32_t *entry, size_t count, const struct sieve_search *alone)
{
	uint32_t first[ROOM], second[ROOM], part[ROOM];
	size_t skipped = (size_t)between(0, (double)count + 1);
	if (skipped > count) skipped = count;
	memcpy(first, entry, sizeof first);
	memset(second, 0, sizeof second);
	memcpy(second, entry + skipped, (ROOM - skipped) * sizeof *second);
	memcpy(part, second, sizeof part);
	struct sieve_search one = {.entry = part, .count = count - skipped, .latest = alone->latest};
	machine->pass(sieve, shadow, &one, 1);
	struct sieve_search both[2] = {{.entry = first, .count = count, .latest = alone->latest},
								   {.entry = second, .count = count - skipped, .latest = alone->latest}};
	bool other_way = between(0, 1) < 0.5;
	if (other_way) {
		struct sieve_search whole = both[0];
		both[0] = both[1], both[1] = whole;
	}
	machine->pass(sieve, shadow, both, 2);
	const struct sieve_search *whole = &both[other_way], *rest = &both[!other_way];
	assert_int_equal(whole->count, alone->count);
	assert_memory_equal(whole->entry, alone->entry, alone->count * sizeof *alone->entry);
	assert_int_equal(rest->count, one.count);
	assert_memory_equal(rest->entry, part, one.count * sizeof *part);
}

/* One crowd of particles around number 0, and what each machine leaves of it; how many in all, and how many kept. */
static void one_crowd(struct shadow *shadow, uint64_t *all, uint64_t *kept_in_all)
{
	struct particle particle[PARTICLES];
	const double box = ldexp(1, (int)between(2, 10)), extent = between(1.2, 6), now = between(0.1, 64);
	const double speed = ldexp(1, (int)between(-6, 6)), centre = between(-0.5, 0.5) * box;
	uint32_t count = 1 + (uint32_t)between(0, PARTICLES - 2), entry[ROOM], kept[ROOM];
	for (uint32_t i = 0; i <= count; i++) {
		struct particle *p = &particle[i];
		p->time = i ? between(0, now) : now;
		p->radius = between(0, 1) < 0.5 ? 0.5 : between(0.2, 1);
		for (int axis = 0; axis < 3; axis++) {
			p->velocity[axis] = between(-speed, speed);
			double at = centre + (i ? between(-extent, extent) : 0);
			p->position[axis] = at - p->velocity[axis] * (now - p->time);
		}
	}
	bool images = between(0, 1) < 0.3;
	long double wait[PARTICLES], soonest = INFINITY;
	bool heard[PARTICLES];
	float reach = between(0, 1) < 0.3 ? (float)between(1, 1.1) : 0; /* of a listener */
	for (uint32_t k = 0; k < count; k++) {
		uint32_t code[3] = {0};
		double shift[3] = {0};
		for (int axis = 0; images && axis < 3; axis++) {
			code[axis] = (uint32_t)between(0, 3);
			shift[axis] = code[axis] == 1 ? box : code[axis] == 2 ? -box : 0;
			particle[k + 1].position[axis] -= shift[axis];
		}
		entry[k] = (k + 1) | (code[0] | code[1] << 2 | code[2] << 4) << ENTRY_BITS;
		wait[k] = meeting(&particle[0], &particle[k + 1], shift, now);
		double contact = particle[0].radius + particle[k + 1].radius;
		heard[k] = reach > 0 && distance_at(&particle[0], &particle[k + 1], shift, now) <= (double)reach * contact;
		if (wait[k] < soonest) soonest = wait[k];
	}
	for (uint32_t k = count; k < count + 32; k++) entry[k] = (uint32_t)between(0, count + 1); /* not to be looked at */
	struct sieve sieve = sieve_at(box, now);
	sieve.heard = reach;
	sieve.by_order = between(0, 1) < 0.8;
	sieve.timed = between(0, 1) < 0.5;
	sieve.images = images;
	double limit = between(0, 1) < 0.3 ? between(0, 2) / speed : INFINITY;
	float latest = sieve.by_order ? (float)(limit * 1.001) : INFINITY;
	const struct sieve_machine *machine;
	for (size_t m = 0; (machine = sieve_machine(m)); m++) {
		for (uint32_t i = 0; i <= count; i++) cast(machine, &shadow[i], &particle[i]);
		memcpy(kept, entry, sizeof kept);
		struct sieve_search search = {.entry = kept, .count = count, .latest = latest};
		machine->pass(&sieve, shadow, &search, 1);
		size_t left = search.count;
		assert_true(left <= count);
		two_at_once(machine, &sieve, shadow, entry, count, &search);
		*all += count, *kept_in_all += left;
		size_t at = 0;
		for (uint32_t k = 0; k < count; k++) {
			bool there = at < left && kept[at] == entry[k]; /* in the order in which they came */
			if (there) at++;
			bool near = wait[k] < INFINITY && (!sieve.by_order || (wait[k] <= soonest && wait[k] <= limit));
			if (judges && (near || heard[k]) && !there) {
				print_message("%s leaves out entry %u of %u, wait %Lg, soonest %Lg, box %g, extent %g, speed %g\n",
							  machine->name, k, count, wait[k], soonest, box, extent, speed);
				fail();
			}
		}
		assert_int_equal(at, left);
		if (!sieve.timed || !left || !judges) continue;
		long double last = wait[entry_particle(kept[left - 1]) - 1];
		bool early = last < (long double)search.from - 0x1p-40L,
			 late = search.by < INFINITY && last > (long double)search.by;
		if (early || late)
			fail_msg("%s has a meeting from %g to %g that is at %Lg", machine->name, (double)search.from,
					 (double)search.by, last);
	}
}

static void never_leaves_out_the_earliest(void **state)
{
	(void)state;
	struct shadow *shadow = aligned_alloc(64, ROOM * sizeof *shadow);
	assert_non_null(shadow);
	uint64_t all = 0, kept = 0;
	for (int crowd = 0; crowd < 100000; crowd++) one_crowd(shadow, &all, &kept);
	print_message("%.2f %% of %.3g candidates kept\n", 100.0 * (double)kept / (double)all, (double)all);
	assert_true(kept < all / 10);
	free(shadow);
}

/* The wait from `now` until two that are within `outer` part to it, by the stable rule. */
static long double parting(const struct particle *a, const struct particle *b, double outer, double now)
{
	long double rr = 0, rv = 0, vv = 0;
	for (int axis = 0; axis < 3; axis++) {
		long double own = a->position[axis] + (long double)a->velocity[axis] * ((long double)now - a->time);
		long double other = b->position[axis] + (long double)b->velocity[axis] * ((long double)now - b->time);
		long double r = own - other, v = (long double)a->velocity[axis] - b->velocity[axis];
		rr += r * r, rv += r * v, vv += v * v;
	}
	long double c = rr - (long double)outer * outer, d = rv * rv - vv * c;
	if (vv == 0) return INFINITY;
	if (rv >= 0 && c >= 0) return 0;
	if (d <= 0) return rv < 0 ? -rv / vv : 0;
	return rv < 0 ? (sqrtl(d) - rv) / vv : -c / (rv + sqrtl(d));
}

/* Some of the particles that number 0 is paired with go to where their images take their places. */
static void show_images(struct particle *particle, double box, struct pair_state pair[2][PARTICLES], uint32_t count)
{
	for (uint32_t k = 0; k < count; k++) {
		if (between(0, 1) < 0.7) continue;
		struct pair_state *both[2] = {&pair[0][k], &pair[1][count - 1 - k]};
		for (int axis = 0; axis < 3; axis++) {
			int image = (int)between(0, 3) - 1;
			particle[k + 1].position[axis] -= image * box;
			for (int p = 0; p < 2 && image; p++) both[p]->entry = entry_shifted(both[p]->entry, axis, image);
		}
	}
}

/* Which of so many times are not later than one, and not never. */
static void some_are_sooner(const struct sieve_machine *machine, const float *soonest, uint32_t count)
{
	uint32_t kept[ROOM], all = 0;
	float latest = between(0, 1) < 0.1 ? INFINITY : soonest[(uint32_t)between(0, count)], later, least = INFINITY;
	size_t found = machine->sooner(soonest, count, latest, kept, &later);
	for (uint32_t k = 0; k < count; k++)
		if (soonest[k] <= latest && soonest[k] < INFINITY)
			assert_true(all < found && kept[all++] == k);
		else
			least = fminf(least, soonest[k]);
	assert_true(all == found && later == least);
}

/* Particles within a distance of number 0, up to a rounding error, or beyond one, and how long each machine says that
 * nothing happens to them. */
static void one_hold(struct shadow *shadow, uint64_t *all, uint64_t *asked, uint64_t *tight)
{
	struct particle particle[PARTICLES];
	const double box = ldexp(1, (int)between(2, 10)), now = between(0.1, 64), centre = between(-0.5, 0.5) * box;
	const double speed = ldexp(1, (int)between(-6, 6));
	uint32_t count = 1 + (uint32_t)between(0, PARTICLES - 2);
	struct pair_state pair[2][PARTICLES];
	struct limits limits[PARTICLES];
	float bound[2][ROOM];
	long double wait[PARTICLES], soonest = INFINITY;
	for (uint32_t i = 0; i <= count; i++) {
		struct particle *p = &particle[i];
		double direction[3], length = 0, distance = between(0, 1);
		*p = (struct particle){.time = i ? between(0, now) : now};
		for (int axis = 0; axis < 3; axis++)
			direction[axis] = between(-1, 1), length += direction[axis] * direction[axis];
		if (i) {
			struct limits *own = &limits[i - 1];
			own->outer = (float)between(1, 3);
			own->inner = between(0, 1) < 0.2 ? 0 : own->outer * (float)between(0.2, 1);
			double low = own->inner;
			distance = distance < 0.2 ? own->outer : distance < 0.4 ? low : low + (own->outer - low) * between(0, 1);
		}
		for (int axis = 0; axis < 3; axis++) {
			p->velocity[axis] = between(-speed, speed);
			double at = centre + (i ? direction[axis] / sqrt(length) * distance : 0);
			p->position[axis] = at - p->velocity[axis] * (now - p->time);
		}
	}
	for (uint32_t k = 0; k < count; k++)
		if (between(0, 1) < 0.3)
			limits[k] = (struct limits){0, limits[k].outer}; /* some are not within: they do not part */
	for (uint32_t k = 0; k < count; k++) pair[0][k] = pair[1][count - 1 - k] = (struct pair_state){k + 1, k};
	for (uint32_t k = 0; k < count; k++) {
		struct particle sized = particle[0];
		sized.radius = limits[k].inner;
		long double in = meeting(&sized, &particle[k + 1], (double[3]){0}, now);
		long double out =
			limits[k].outer > 0 ? parting(&particle[0], &particle[k + 1], limits[k].outer, now) : INFINITY;
		wait[k] = in < out ? in : out;
		if (wait[k] < soonest) soonest = wait[k];
	}
	if (between(0, 1) < 0.5) show_images(particle, box, pair, count);
	struct sieve sieve = sieve_at(box, now);
	sieve.by_order = true;
	const struct sieve_machine *machine;
	for (size_t m = 0; (machine = sieve_machine(m)); m++) {
		for (uint32_t i = 0; i <= count; i++) cast(machine, &shadow[i], &particle[i]);
		uint32_t fewer = 1 + (uint32_t)between(0, count);
		struct sieve_outlook outlook[2] = {{0, pair[0], limits, count, bound[0], 0},
										   {0, pair[1] + count - fewer, limits, fewer, bound[1], 0}};
		machine->hold(&sieve, shadow, outlook, 2);
		for (uint32_t k = 0; k < fewer; k++) assert_true(bound[0][k] == bound[1][fewer - 1 - k]);
		bound[1][0] = NAN;
		machine->hold(&sieve, shadow, outlook, 1);
		assert_true(isnan(bound[1][0]));
		some_are_sooner(machine, bound[0], count);
		*all += count;
		for (uint32_t k = 0; k < count; k++) {
			*asked += bound[0][k] <= soonest;
			*tight += bound[0][k] == INFINITY ? wait[k] == INFINITY : bound[0][k] >= wait[k] * 0.999L;
			if (!(bound[0][k] <= wait[k])) {
				print_message("%s has pair %u of %u do nothing before %g, wait %Lg, from %g to %g, speed %g\n",
							  machine->name, k, count, (double)bound[0][k], wait[k], (double)limits[k].inner,
							  (double)limits[k].outer, speed);
				fail();
			}
			assert_true(bound[0][outlook[0].first] <= bound[0][k]);
		}
	}
}

static void bounds_are_below_and_near(void **state)
{
	(void)state;
	struct shadow *shadow = aligned_alloc(64, ROOM * sizeof *shadow);
	assert_non_null(shadow);
	uint64_t all = 0, asked = 0, tight = 0;
	for (int hold = 0; hold < 50000; hold++) one_hold(shadow, &all, &asked, &tight);
	print_message("of %.3g pairs %.2f %% to be asked, %.2f %% with a bound near their event\n", (double)all,
				  100.0 * (double)asked / (double)all, 100.0 * (double)tight / (double)all);
	assert_true(asked < all / 2 && tight > all / 5);
	free(shadow);
}

/* Pairs that ought to be between two distances, some of them at one, and what each machine keeps of them. */
static void one_check(struct shadow *shadow, uint64_t *all, uint64_t *kept_in_all)
{
	struct particle particle[PARTICLES];
	const double box = ldexp(1, (int)between(2, 10)), now = between(0.1, 64), centre = between(-0.5, 0.5) * box;
	uint32_t count = 1 + (uint32_t)between(0, PARTICLES - 2), entry[ROOM], kept[ROOM];
	float outer[ROOM], inner[ROOM];
	bool out[PARTICLES];
	for (uint32_t k = 0; k < ROOM; k++) {
		entry[k] = k < count ? k + 1 : (uint32_t)between(0, count + 1);
		inner[k] = between(0, 1) < 0.2 ? 0 : (float)between(0.5, 1.5);
		outer[k] = between(0, 1) < 0.2 ? INFINITY : inner[k] + (float)between(0.1, 2);
	}
	for (uint32_t i = 0; i <= count; i++) {
		struct particle *p = &particle[i];
		double direction[3], length = 0, far = i && outer[i - 1] < INFINITY ? (double)outer[i - 1] : 4;
		double distance = !i                    ? 0
						  : between(0, 1) < 0.2 ? far
						  : between(0, 1) < 0.2 ? (double)inner[i - 1]
												: far * between(0, 1.2);
		*p = (struct particle){.time = i ? between(0, now) : now};
		for (int axis = 0; axis < 3; axis++)
			direction[axis] = between(-1, 1), length += direction[axis] * direction[axis];
		for (int axis = 0; axis < 3; axis++) {
			p->velocity[axis] = between(-1, 1);
			double at = centre + direction[axis] / sqrt(length) * distance;
			p->position[axis] = at - p->velocity[axis] * (now - p->time);
		}
	}
	for (uint32_t k = 0; k < count; k++) {
		long double distance = distance_at(&particle[0], &particle[k + 1], (double[3]){0}, now);
		out[k] = !((inner[k] <= 0 || distance > (long double)inner[k]) && distance < (long double)outer[k]);
	}
	struct sieve sieve = sieve_at(box, now);
	const struct sieve_machine *machine;
	for (size_t m = 0; (machine = sieve_machine(m)); m++) {
		for (uint32_t i = 0; i <= count; i++) cast(machine, &shadow[i], &particle[i]);
		size_t left = machine->check(&sieve, shadow, 0, &(struct held){entry, outer, inner}, count, kept), at = 0;
		assert_true(left <= count);
		for (uint32_t k = 0; k < count; k++) {
			bool there = at < left && kept[at] == k;
			if (there) at++;
			if (out[k] && !there)
				fail_msg("%s takes pair %u of %u for one that is where it ought to be", machine->name, k, count);
			*all += !out[k], *kept_in_all += !out[k] && there;
		}
		assert_int_equal(at, left);
	}
}

static void never_overlooks_who_is_elsewhere(void **state)
{
	(void)state;
	struct shadow *shadow = aligned_alloc(64, ROOM * sizeof *shadow);
	assert_non_null(shadow);
	uint64_t all = 0, kept = 0;
	for (int trial = 0; trial < 20000; trial++) one_check(shadow, &all, &kept);
	print_message("%.2f %% of %.3g pairs that are where they ought to be kept\n", 100.0 * (double)kept / (double)all,
				  (double)all);
	assert_true(kept < all / 3);
	free(shadow);
}

/* Balls that graze, in contact within a rounding error, at rest to each other, in the same place. */
static void keeps_what_is_doubtful(void **state)
{
	(void)state;
	static const struct particle pair[][2] = {
		{{{0, 0, 0}, {1, 0, 0}, 0, 0.5}, {{3, 1, 0}, {0, 0, 0}, 0, 0.5}},             /* grazing exactly */
		{{{0, 0, 0}, {1, 0, 0}, 0, 0.5}, {{1 - 0x1p-52, 0, 0}, {0, 0, 0}, 0, 0.5}},   /* overlapping by an ulp */
		{{{0, 0, 0}, {1, 0, 0}, 0, 0.5}, {{1, 0, 0}, {1, 0, 0}, 0, 0.5}},             /* at rest */
		{{{0.1, 0, 0}, {1, 0, 0}, 0, 0.5}, {{0.1, 0, 0}, {1, 0, 0}, 0, 0.5}},         /* the same place */
		{{{0, 0, 0}, {NAN, 0, 0}, 0, 0.5}, {{3, 0, 0}, {0, 0, 0}, 0, 0.5}},           /* lost already */
		{{{0, 0, 0}, {1e30, 0, 0}, 0, 0.5}, {{3, 0, 0}, {-1e30, 0, 0}, 0, 0.5}},      /* beyond what squares hold */
		{{{0, 0, 0}, {1e-30, 0, 0}, 0, 0.5}, {{3, 0.3, 0}, {-1e-30, 0, 0}, 0, 0.5}}}; /* and below */
	struct shadow *shadow = aligned_alloc(64, ROOM * sizeof *shadow);
	assert_non_null(shadow);
	struct sieve sieve = {.length = 1, .age = 1, .roundoff = 0x1p-53f, .by_order = true};
	const struct sieve_machine *machine;
	for (size_t m = 0; (machine = sieve_machine(m)); m++)
		for (size_t p = 0; p < sizeof pair / sizeof *pair; p++) {
			uint32_t entry[ROOM] = {1};
			cast(machine, &shadow[0], &pair[p][0]);
			cast(machine, &shadow[1], &pair[p][1]);
			struct sieve_search search = {.entry = entry, .count = 1, .latest = INFINITY};
			machine->pass(&sieve, shadow, &search, 1);
			assert_int_equal(search.count, 1);
		}
	free(shadow);
}

int main(void)
{
	uint64_t seed = (uint64_t)time(NULL);
	const char *chosen = getenv("TOUCHSTONE_SEED");
	if (chosen) seed = strtoull(chosen, NULL, 0);
	print_message("seed %llu\n", (unsigned long long)seed);
	randomness = random_seed(seed);
	judges = long_double_is_whole("what the sieve must not leave out");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(never_leaves_out_the_earliest),
		cmocka_unit_test(bounds_are_below_and_near),
		cmocka_unit_test(never_overlooks_who_is_elsewhere),
		cmocka_unit_test(keeps_what_is_doubtful),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}

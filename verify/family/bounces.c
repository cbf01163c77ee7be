/* The 2014 paper's ball over a plate (section 5, fig. 7), asked after every bounce until it has come to rest: gaps and
 * speeds fall by a factor at each, down to where the gap is a few units in the last place, of either sign. Plates are
 * uniform in [0, 1); half of the balls have the paper's restitution of 1/2, the others any from 0.1 to 0.9. */
#include <string.h>

#include "family/draw.h"
#include "family/make.h"

enum { MOST_BOUNCES = 400 };

static const double gravity = -1, radius = 0.5;

struct bounces {
	double (*numbers)[TOUCHSTONE_MOST_NUMBERS];
	size_t count;
};

/* The distance, position less plate, is a sum of neighbours that is exact: the gap came from it. */
static void note(void *context, double time, double gap, double speed)
{
	(void)time;
	struct bounces *bounces = context;
	if (bounces->count == FAMILY_BLOCK) return;
	const double number[TOUCHSTONE_MOST_NUMBERS] = {gap + radius, speed, gravity, radius};
	memcpy(bounces->numbers[bounces->count++], number, sizeof number);
}

bool harvest_bouncing_ball(enum touchstone_shape shape, uint64_t seed, double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
						   char error[160])
{
	(void)shape;
	struct bounces bounces = {.numbers = numbers};
	struct random_state random = random_seed(seed);
	while (bounces.count < FAMILY_BLOCK) {
		struct touchstone_drop drop = {.gravity = gravity, .restitution = 0.5, .most = MOST_BOUNCES};
		drop.plate[0] = random_uniform(&random);
		drop.order = (unsigned)random_below(&random, TOUCHSTONE_DROP_ORDERS);
		if (draw_chance(&random, 2)) drop.restitution = 0.1 + 0.8 * random_uniform(&random);
		struct touchstone_landing landing;
		if (!touchstone_drop("binary64", "stable", &drop, 1, &landing, note, &bounces, error)) return false;
		note(&bounces, 0, landing.start[0] - landing.plate[0] - radius, 0); /* the drop itself */
	}
	return true;
}

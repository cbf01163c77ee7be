#include "measure/lyapunov.h"

#include "scene/random.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* One particle's part of the vector, as its last event left it. */
struct part {
	double position[3], velocity[3], time;
};

struct lyapunov {
	const struct touchstone_scene *scene;
	struct part *part;
	double growth;  /* logarithm of what the parts have been divided by */
	uint64_t until; /* events until they are next */
};

static double product(const double a[3], const double b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* A flight changes velocities alike for all particles, so that differences fly straight. */
static void fly(struct part *part, double time)
{
	for (int axis = 0; axis < 3; axis++) part->position[axis] += part->velocity[axis] * (time - part->time);
	part->time = time;
}

static double length_at(struct lyapunov *lyapunov, double time)
{
	double squares = 0;
	for (size_t p = 0; p < lyapunov->scene->particle_count; p++) {
		struct part *part = &lyapunov->part[p];
		fly(part, time);
		squares += product(part->position, part->position) + product(part->velocity, part->velocity);
	}
	return sqrt(squares);
}

/* Makes the vector as long as at first. */
static void shorten(struct lyapunov *lyapunov, double time)
{
	double length = length_at(lyapunov, time);
	lyapunov->growth += log(length);
	lyapunov->until = lyapunov->scene->particle_count;
	for (size_t p = 0; p < lyapunov->scene->particle_count; p++)
		for (int axis = 0; axis < 3; axis++) {
			lyapunov->part[p].position[axis] /= length;
			lyapunov->part[p].velocity[axis] /= length;
		}
}

static bool constant_laws(const struct touchstone_scene *scene)
{
	bool constant = scene->restitution.law == TOUCHSTONE_CONSTANT;
	for (size_t w = 0; w < scene->wall_count; w++) constant &= scene->walls[w].restitution.law == TOUCHSTONE_CONSTANT;
	for (size_t p = 0; p < scene->potential_count; p++)
		constant &= scene->potentials[p].restitution.law == TOUCHSTONE_CONSTANT;
	return constant;
}

struct lyapunov *lyapunov_begin(const struct touchstone_scene *scene, uint64_t seed, char error[160])
{
	if (!constant_laws(scene)) {
		snprintf(error, 160, "a tangent vector needs impact laws with a constant coefficient of restitution");
		return NULL;
	}
	struct lyapunov *lyapunov = calloc(1, sizeof *lyapunov);
	struct part *part = calloc(scene->particle_count, sizeof *part);
	if (!lyapunov || !part) {
		snprintf(error, 160, "no memory for a tangent vector of %zu particles", scene->particle_count);
		free(lyapunov);
		free(part);
		return NULL;
	}
	struct random_state random = random_seed(seed);
	*lyapunov = (struct lyapunov){.scene = scene, .part = part};
	for (size_t p = 0; p < scene->particle_count; p++) {
		part[p].time = scene->clock;
		for (int axis = 0; axis < scene->dimensions; axis++) {
			part[p].position[axis] = random_normal(&random);
			part[p].velocity[axis] = random_normal(&random);
		}
	}
	shorten(lyapunov, scene->clock);
	lyapunov->growth = 0;
	return lyapunov;
}

void lyapunov_free(struct lyapunov *lyapunov)
{
	if (lyapunov) free(lyapunov->part);
	free(lyapunov);
}

/* What an event does to the speed u along its normal: u becomes f(u). */
struct impulse {
	double jump;  /* f(u) - u */
	double slope; /* f'(u) */
};

/* The coefficient is told from what was handed over, which is right also while all collisions are elastic. */
static struct impulse impulse_of(const struct touchstone_event *event, double u, double mass)
{
	if (event->kind == TOUCHSTONE_CAPTURE || event->kind == TOUCHSTONE_RELEASE) {
		double after = copysign(sqrt(fmax(0, u * u - 2 * event->energy / mass)), u);
		return (struct impulse){after - u, u / after};
	}
	double coefficient = event->impulse / (mass * fabs(u)) - 1;
	return (struct impulse){-(1 + coefficient) * u, -coefficient};
}

static double mass_of(const struct lyapunov *lyapunov, uint32_t particle)
{
	return lyapunov->scene->species[lyapunov->scene->particles[particle].species].mass;
}

/* The difference delays the event by -(n.dq)/u, in which positions go on by what the event has changed of the velocity;
 * the normal turns with the positions at the delayed event. */
static void meet_particle(struct lyapunov *lyapunov, struct touchstone_engine *engine,
						  const struct touchstone_event *event)
{
	struct part *first = &lyapunov->part[event->first], *second = &lyapunov->part[event->second];
	double mass[2] = {mass_of(lyapunov, event->first), mass_of(lyapunov, event->second)};
	double terms[3][3 * TOUCHSTONE_MOST_TERMS], at[TOUCHSTONE_MOST_TERMS], where[3], r[3], v[3][3], n[3], dq[3], dv[3];
	int count = touchstone_separation(engine, terms, at);
	touchstone_state(engine, event->first, where, v[0]);
	touchstone_state(engine, event->second, where, v[1]);
	for (int axis = 0; axis < 3; axis++) {
		r[axis] = 0;
		for (int term = 0; term < count; term++) r[axis] += terms[axis][term];
		v[2][axis] = v[0][axis] - v[1][axis];
		dq[axis] = first->position[axis] - second->position[axis];
		dv[axis] = first->velocity[axis] - second->velocity[axis];
	}
	double distance = sqrt(product(r, r)), both = mass[0] + mass[1];
	for (int axis = 0; axis < 3; axis++) n[axis] = r[axis] / distance;
	double u = product(n, v[2]), along = product(n, dq), turn[3];
	if (u == 0) return; /* nothing is handed over */
	struct impulse impulse = impulse_of(event, u, mass[0] / both * mass[1]);
	for (int axis = 0; axis < 3; axis++) turn[axis] = (dq[axis] - v[2][axis] * along / u) / distance;
	double du = product(dv, n) + product(v[2], turn);
	for (int axis = 0; axis < 3; axis++) {
		double moved = impulse.jump / u * along * n[axis];
		double kicked = (impulse.slope - 1) * du * n[axis] + impulse.jump * turn[axis];
		first->position[axis] += mass[1] / both * moved;
		second->position[axis] -= mass[0] / both * moved;
		first->velocity[axis] += mass[1] / both * kicked;
		second->velocity[axis] -= mass[0] / both * kicked;
	}
}

/* A wall's normal does not turn, but gravity acts differently before and after a delayed impact. */
static void meet_wall(struct lyapunov *lyapunov, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct part *part = &lyapunov->part[event->first];
	const double *n = lyapunov->scene->walls[event->second].normal;
	double where[3], v[3];
	touchstone_state(engine, event->first, where, v);
	double u = product(n, v), along = product(n, part->position);
	if (u == 0) return;
	struct impulse impulse = impulse_of(event, u, mass_of(lyapunov, event->first));
	double du = product(n, part->velocity) - product(n, lyapunov->scene->acceleration) * along / u;
	for (int axis = 0; axis < 3; axis++) {
		part->position[axis] += impulse.jump / u * along * n[axis];
		part->velocity[axis] += (impulse.slope - 1) * du * n[axis];
	}
}

void lyapunov_see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct lyapunov *lyapunov = context;
	if (event->kind == TOUCHSTONE_CROSSING) return;
	fly(&lyapunov->part[event->first], event->time);
	if (event->kind == TOUCHSTONE_WALL) {
		meet_wall(lyapunov, engine, event);
	} else {
		fly(&lyapunov->part[event->second], event->time);
		meet_particle(lyapunov, engine, event);
	}
	if (--lyapunov->until == 0) shorten(lyapunov, event->time);
}

double lyapunov_growth(struct lyapunov *lyapunov, double time)
{
	return lyapunov->growth + log(length_at(lyapunov, time));
}

void lyapunov_part(const struct lyapunov *lyapunov, uint32_t particle, double time, double position[3],
				   double velocity[3])
{
	struct part part = lyapunov->part[particle];
	double length = exp(lyapunov->growth);
	fly(&part, time);
	for (int axis = 0; axis < 3; axis++) {
		position[axis] = length * part.position[axis];
		velocity[axis] = length * part.velocity[axis];
	}
}

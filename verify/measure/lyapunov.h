/* The largest Lyapunov exponent from a tangent vector: an infinitesimal difference of all positions and velocities,
 * carried along a run by the exact linear maps of flight and of each event (Dellago, Posch and Hoover 1996, Phys. Rev.
 * E 53, 1485: an event that a difference delays acts on it by the derivative of the impulse, and by what the flow gains
 * or loses in the delay), here for any masses, constant restitution, walls under gravity and steps of potentials.
 *
 * Work per event does not grow with the number of particles: each particle's part flies when the particle has its next
 * event. The vector is shortened again once in a while, and its growth is summed as a logarithm. */
#ifndef VERIFY_LYAPUNOV_H
#define VERIFY_LYAPUNOV_H

#include "touchstone.h"

struct lyapunov;

/* A tangent vector of length 1 in a direction drawn from the seed, at the time at which the scene begins. The scene is
 * the one the engine is made from, and must last as long. NULL with one line in `error` when there is no memory, or an
 * impact law has no constant coefficient. The caller ends it with lyapunov_free. */
struct lyapunov *lyapunov_begin(const struct touchstone_scene *scene, uint64_t seed, char error[160]);
void lyapunov_free(struct lyapunov *lyapunov);

/* Observes an event; pass to touchstone_run with a struct lyapunov as the context. */
void lyapunov_see(void *lyapunov, struct touchstone_engine *engine, const struct touchstone_event *event);

/* Natural logarithm of how much longer the vector is at `time`, at or after the last event, than it was at first.
 * Length is Euclid's over all positions and velocities; the exponent does not depend on that choice. */
double lyapunov_growth(struct lyapunov *lyapunov, double time);

/* The part of one particle in the vector at `time`, as if it had never been shortened. */
void lyapunov_part(const struct lyapunov *lyapunov, uint32_t particle, double time, double position[3],
				   double velocity[3]);

#endif

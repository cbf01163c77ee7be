#include "measure/conservation.h"

#include "num/twin.h"

static void store(double parts[2], num sum)
{
	parts[0] = sum.high;
	parts[1] = sum.low;
}

/* Difference of two stored sums, rounded once. */
static double difference(const double end[2], const double begin[2])
{
	return to_double(sub((num){end[0], end[1]}, (num){begin[0], begin[1]}));
}

struct conservation conservation_of(const struct touchstone_scene *scene, const struct touchstone_engine *engine)
{
	struct conservation conservation = {0};
	num energy = from_double(0), momentum[3] = {energy, energy, energy}, half = from_double(0.5);
	for (uint32_t p = 0; p < scene->particle_count; p++) {
		double position[3], velocity[3];
		touchstone_state(engine, p, position, velocity);
		num mass = from_double(scene->species[scene->particles[p].species].mass);
		num square = from_double(0), potential = square;
		for (int axis = 0; axis < scene->dimensions; axis++) {
			num speed = from_double(velocity[axis]);
			square = add(square, mul(speed, speed));
			momentum[axis] = add(momentum[axis], mul(mass, speed));
			if (scene->periodic[axis]) continue;
			potential = sub(potential, mul(from_double(scene->acceleration[axis]), from_double(position[axis])));
		}
		num kinetic = mul(half, square);
		energy = add(energy, mul(mass, add(kinetic, potential)));
		conservation.energy_scale += to_double(mass) * (to_double(kinetic) + fabs(to_double(potential)));
		conservation.momentum_scale += to_double(mass) * sqrt(to_double(square));
	}
	struct touchstone_status status;
	touchstone_status(engine, &status);
	energy = add(energy, from_double(status.potential_energy));
	conservation.energy_scale += fabs(status.potential_energy);
	store(conservation.energy, energy);
	for (int axis = 0; axis < 3; axis++) store(conservation.momentum[axis], momentum[axis]);
	return conservation;
}

double conservation_energy_drift(const struct conservation *begin, const struct conservation *end)
{
	double scale = begin->energy_scale;
	return scale > 0 ? difference(end->energy, begin->energy) / scale : NAN;
}

double conservation_momentum_drift(const struct conservation *begin, const struct conservation *end)
{
	double squares = 0;
	for (int axis = 0; axis < 3; axis++) {
		double change = difference(end->momentum[axis], begin->momentum[axis]);
		squares += change * change;
	}
	return begin->momentum_scale > 0 ? sqrt(squares) / begin->momentum_scale : NAN;
}

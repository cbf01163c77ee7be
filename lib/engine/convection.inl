/* Heat: what particles carry of it, how it kicks them, and walls that set velocities. A scene without pays one
 * comparison an event. The kicks follow a public simulator of convection ("event-driven simulator of many colliding
 * particles", its README): a pair at the temperature T' is kicked by dv = -kick (T' - neutral) along the last axis. */

/* What a change of one velocity component brings in, in double: for the books only. */
static double energy_of_change(const struct touchstone_engine *engine, uint32_t i, num before, num after)
{
	double from = to_double(before), to = to_double(after);
	return to_double(engine->mass[engine->place[i].species]) * (to - from) * (to + from) / 2;
}

/* Two particles that have just collided share their heat, and it kicks both. */
static void exchange_heat(struct touchstone_engine *engine, uint32_t i, uint32_t j)
{
	num mean = mul(from_double(0.5), add(engine->temperature[i], engine->temperature[j]));
	num kick = mul(engine->kick, sub(mean, engine->neutral));
	uint32_t both[2] = {i, j};
	for (int p = 0; p < 2; p++) {
		num *velocity = &engine->body[both[p]].velocity[engine->dimensions - 1], before = *velocity;
		*velocity = sub(before, kick);
		engine->temperature[both[p]] = mean;
		engine->kicked_energy += energy_of_change(engine, both[p], before, *velocity);
	}
}

/* A particle that has just met a wall takes its heat. */
static void take_heat(struct touchstone_engine *engine, uint32_t i, const struct wall *wall)
{
	if (!is_finite(wall->temperature)) return;
	engine->temperature[i] = mul(from_double(0.5), add(engine->temperature[i], wall->temperature));
}

/* The velocity with which particle i, which meets a thermal wall now, leaves it: normal along the wall, of variance
 * kT/m on each axis; off it as particles cross a plane in equilibrium, which is the length of two such components. It
 * is drawn from the particle's number and the time of the event, so that nothing has to be remembered. */
static void draw_velocity(const struct touchstone_engine *engine, uint32_t i, const struct wall *wall, num velocity[3])
{
	struct random_state random = random_seed(mix_now(engine, mix(first_digest, engine->itinerary[i].id)));
	double width = sqrt(engine->thermostat / to_double(engine->mass[engine->place[i].species]));
	double one = random_normal(&random), other = random_normal(&random);
	num leaves = from_double(width * sqrt(one * one + other * other)), drawn[3];
	for (int axis = 0; axis < 3; axis++)
		drawn[axis] = from_double(axis < engine->dimensions ? width * random_normal(&random) : 0);
	num excess = sub(dot(wall->normal, drawn), leaves);
	for (int axis = 0; axis < 3; axis++) velocity[axis] = sub(drawn[axis], mul(excess, wall->normal[axis]));
}

static void leave_thermal_wall(struct touchstone_engine *engine, uint32_t i, const num velocity[3])
{
	struct body *body = &engine->body[i];
	for (int axis = 0; axis < engine->dimensions; axis++) {
		engine->thermostat_energy += energy_of_change(engine, i, body->velocity[axis], velocity[axis]);
		body->velocity[axis] = velocity[axis];
	}
}

static double engine_temperature(const struct touchstone_engine *engine, uint32_t particle)
{
	return engine->temperature ? to_double(engine->temperature[engine->index_of[particle]]) : NAN;
}

/* False when there is no memory. */
static bool set_heat(struct touchstone_engine *engine, const struct touchstone_scene *scene)
{
	const struct touchstone_convection *convection = &scene->convection;
	engine->thermostat = scene->thermostat;
	if (!convection->temperatures) return true;
	engine->temperature = malloc(engine->count * sizeof *engine->temperature);
	if (!engine->temperature) return false;
	for (uint32_t i = 0; i < engine->count; i++)
		engine->temperature[i] = from_double(convection->temperatures[engine->itinerary[i].id]);
	for (size_t w = 0; w < engine->wall_count; w++)
		engine->wall[w].temperature = from_double(convection->wall_temperatures[w]);
	engine->kick = from_double(convection->kick);
	engine->neutral = from_double(convection->neutral);
	return true;
}

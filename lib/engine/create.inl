/* From a scene, and perhaps a state that was saved, to an engine. */

/* A method that an engine can run by: it has answers for balls and for planes. */
static const struct method *find_policy(const char *name, char error[160])
{
	const struct method *method = find_method(name, error);
	if (!method || method->ball_plane) return method;
	refuse(error, "method '%s' is a finder only: no engine runs by it, since it has no answer for planes", name);
	return NULL;
}

/* Rules for hard bodies have no finder for a pair that is to part. */
static bool suits(const struct method *method, const struct touchstone_scene *scene, char error[160])
{
	bool states = scene->virtual_wall_count > 0;
	for (size_t p = 0; p < scene->potential_count; p++) states |= scene->potentials[p].step_count > 0;
	return !states || (method->ball_leave && method->half_space) ||
		   refuse(error, "method '%s' is a rule for hard bodies: no scene with steps or virtual walls runs by it",
				  method->name);
}

static void engine_destroy(struct touchstone_engine *engine)
{
	if (!engine) return;
	for (size_t p = 0; p < engine->potential_count; p++) free(engine->potential[p].step);
	cells_destroy(&engine->cells);
	pairs_destroy(&engine->pairs);
	pairs_destroy(&engine->neighbours.pairs);
	agenda_destroy(&engine->agenda);
	void *owned[] = {engine->body,           engine->place,          engine->itinerary,      engine->index_of,
					 engine->radius,         engine->mass,           engine->wall,           engine->lists,
					 engine->shadows.shadow, engine->shadows.radius, engine->shadows.limits, engine->potential,
					 engine->potential_of,   engine->virtual_wall,   engine->side,           engine->crossed,
					 engine->captured,       engine->temperature,    engine->last_met,       engine->neighbours.anchor,
					 engine->open,           engine->second};
	for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
	free(engine);
}

/* Rounds x > 0 up to so many significant bits. */
static double round_up(double x, int bits)
{
	int exponent;
	double fraction = frexp(x, &exponent);
	return ldexp(ceil(ldexp(fraction, bits)), exponent - bits);
}

/* How large places and pages are (design, section 4). In the absolute form there is one place to a periodic box, and
 * one page. */
static void set_scales(struct touchstone_engine *engine, const struct touchstone_scene *scene)
{
	int bits = scene->grain && (int)scene->grain < engine->bits ? (int)scene->grain : engine->bits;
	bits = bits > 53 ? 51 : bits - 2 > 2 ? bits - 2 : 2;
	bool relative = scene->form == TOUCHSTONE_RELATIVE;
	double speed = 0, pull = 0;
	for (int axis = 0; axis < 3; axis++) engine->acceleration[axis] = from_double(0);
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double width = 0, box = scene->box[axis];
		engine->box[axis] = box;
		if (engine->periodic[axis]) {
			double places = relative ? fmax(1, floor(box / (2 * engine->largest))) : 1;
			width = round_up(box / places, bits);
			engine->places[axis] = (int32_t)places;
			engine->box[axis] = width * places;
		} else if (relative) {
			int exponent;
			frexp(4 * engine->largest, &exponent);
			width = ldexp(1, exponent);
		}
		engine->place_width[axis] = width;
		engine->place_size[axis] = from_double(width);
		engine->acceleration[axis] = from_double(scene->acceleration[axis]);
		engine->half_acceleration[axis] = mul(from_double(0.5), engine->acceleration[axis]);
		if (scene->acceleration[axis] != 0) engine->accelerated = true;
		pull = fmax(pull, fabs(scene->acceleration[axis]));
	}
	engine->page_length = INFINITY;
	engine->now = (struct moment){0, from_double(scene->clock)};
	if (!relative) return;
	for (size_t i = 0; i < scene->particle_count; i++)
		for (int axis = 0; axis < engine->dimensions; axis++)
			speed += scene->particles[i].velocity[axis] * scene->particles[i].velocity[axis];
	speed = fmax(sqrt(speed / (double)scene->particle_count), sqrt(pull * engine->largest));
	int exponent = 1;
	if (speed > 0) frexp(engine->largest / speed, &exponent);
	engine->page_turn = engine->page_length = ldexp(1, exponent - 1);
	engine->pages_per_time = 1 / engine->page_length;
	engine->now.page = floor(scene->clock * engine->pages_per_time) * engine->page_length;
	engine->now.time = from_double(scene->clock - engine->now.page);
}

/* A position as a place and the rest. */
static void set_position(const struct touchstone_engine *engine, const double position[3], num rest[3],
						 int32_t index[3])
{
	for (int axis = 0; axis < 3; axis++) {
		double width = axis < engine->dimensions ? engine->place_width[axis] : 0;
		double place = width > 0 ? rint(position[axis] / width) : 0;
		index[axis] = (int32_t)place;
		rest[axis] = from_double(axis < engine->dimensions ? fma(-place, width, position[axis]) : 0);
	}
}

static void set_plane(const struct touchstone_engine *engine, const double point[3], const double normal[3],
					  struct wall *wall)
{
	set_position(engine, point, wall->position, wall->index);
	for (int axis = 0; axis < 3; axis++) wall->normal[axis] = from_double(axis < engine->dimensions ? normal[axis] : 0);
	wall->acceleration = dot(wall->normal, engine->acceleration);
}

static bool set_species_and_walls(struct touchstone_engine *engine, const struct touchstone_scene *scene)
{
	engine->species_count = scene->species_count;
	engine->wall_count = scene->wall_count;
	engine->radius = malloc(scene->species_count * sizeof *engine->radius);
	engine->mass = malloc(scene->species_count * sizeof *engine->mass);
	engine->wall = malloc((scene->wall_count + 1) * sizeof *engine->wall);
	if (!engine->radius || !engine->mass || !engine->wall) return false;
	for (size_t s = 0; s < scene->species_count; s++) {
		engine->radius[s] = mul(from_double(0.5), from_double(scene->species[s].diameter));
		engine->mass[s] = from_double(scene->species[s].mass);
		engine->largest = fmax(engine->largest, scene->species[s].diameter);
	}
	set_scales(engine, scene);
	for (size_t w = 0; w < scene->wall_count; w++) {
		set_plane(engine, scene->walls[w].point, scene->walls[w].normal, &engine->wall[w]);
		engine->wall[w].restitution = scene->walls[w].restitution;
	}
	return true;
}

/* Interleaves the bits of a cell's coordinates: cells near each other in space get keys near each other. */
static uint64_t morton(const double cell[3])
{
	uint64_t key = 0;
	for (int bit = 0; bit < 20; bit++)
		for (int axis = 0; axis < 3; axis++) key |= ((uint64_t)cell[axis] >> bit & 1) << (3 * bit + axis);
	return key;
}

struct ordered {
	uint64_t key;
	uint32_t id;
};

static int compare_ordered(const void *a, const void *b)
{
	const struct ordered *x = a, *y = b;
	if (x->key != y->key) return x->key < y->key ? -1 : 1;
	return (x->id > y->id) - (x->id < y->id);
}

/* Enters the particles in an order that keeps neighbours together in memory. */
static bool set_particles(struct touchstone_engine *engine, const struct touchstone_scene *scene)
{
	size_t count = scene->particle_count;
	engine->count = (uint32_t)count;
	engine->body = memory_room(count * sizeof *engine->body);
	engine->place = memory_room(count * sizeof *engine->place);
	engine->itinerary = memory_room(count * sizeof *engine->itinerary);
	engine->index_of = malloc(count * sizeof *engine->index_of);
	struct ordered *order = malloc(count * sizeof *order);
	bool enough = engine->body && engine->place && engine->itinerary && engine->index_of && order;
	for (size_t id = 0; enough && id < count; id++) {
		double cell[3] = {0};
		for (int axis = 0; axis < engine->dimensions; axis++)
			cell[axis] = fmax(0, scene->particles[id].position[axis] + engine->box[axis] / 2) / engine->largest;
		order[id] = (struct ordered){morton(cell), (uint32_t)id};
	}
	if (enough) qsort(order, count, sizeof *order, compare_ordered);
	for (uint32_t i = 0; enough && i < count; i++) {
		uint32_t id = order[i].id;
		const struct touchstone_particle *particle = &scene->particles[id];
		struct body *body = &engine->body[i];
		set_position(engine, particle->position, body->position, engine->place[i].index);
		for (int axis = 0; axis < 3; axis++)
			body->velocity[axis] = from_double(axis < engine->dimensions ? particle->velocity[axis] : 0);
		body->time = engine->now.time;
		body->page = engine->now.page;
		engine->place[i].species = particle->species;
		engine->itinerary[i] = (struct itinerary){.id = id, .meets = MEETS_NOTHING, .time = from_double(0)};
		engine->index_of[id] = i;
	}
	free(order);
	return enough;
}

static bool set_sieve(struct touchstone_engine *engine)
{
	struct shadows *shadows = &engine->shadows;
	bool straight = !engine->accelerated, alone = engine->count < 2;
	if (engine->search != TOUCHSTONE_CELLS || engine->method->sieve == SIEVE_NOTHING || !straight || alone) return true;
	if (!set_shadow_radii(engine)) return shadows->radius;
	if (engine->captured && !set_limits(engine)) return false;
	shadows->machine = sieve_machine(0);
	shadows->shadow = memory_room(engine->count * sizeof *shadows->shadow);
	return shadows->shadow;
}

/* What the method's policy needs: a time in which a pair comes beyond rounding, as its file has it; and memory. */
static bool set_policy(struct touchstone_engine *engine)
{
	double speed = typical_speed(engine);
	engine->correction_time = from_double(speed > 0 ? ldexp(correction, -engine->bits) * engine->reach / speed : 0);
	if (!(engine->method->policy & POLICY_LAST_EVENT)) return true;
	engine->last_met = malloc(engine->count * sizeof *engine->last_met);
	for (uint32_t i = 0; engine->last_met && i < engine->count; i++) engine->last_met[i] = nobody;
	return engine->last_met;
}

static bool scene_makes_sense(const struct touchstone_scene *scene, char error[160])
{
	if (scene->dimensions < 1 || scene->dimensions > 3)
		return refuse(error, "%d dimensions: 1, 2 or 3 are possible", scene->dimensions);
	if (scene->particle_count < 1 || scene->particle_count >= ENTRY_PARTICLE)
		return refuse(error, "%zu particles: 1 to %u are possible", scene->particle_count, ENTRY_PARTICLE - 1);
	for (size_t s = 0; s < scene->species_count; s++)
		if (!(scene->species[s].diameter > 0 && scene->species[s].mass > 0))
			return refuse(error, "species %zu: diameter and mass must be positive", s);
	for (size_t i = 0; i < scene->particle_count; i++)
		if (scene->particles[i].species >= scene->species_count)
			return refuse(error, "particle %zu: there is no species %u", i, scene->particles[i].species);
	for (int axis = 0; axis < scene->dimensions; axis++)
		if (!(scene->box[axis] > 0 && scene->box[axis] < INFINITY))
			return refuse(error, "axis %d: the box must have a positive extent", axis);
	struct scene_error complaint;
	if (potential_check(scene, &complaint) && potential_check_virtual_walls(scene, &complaint)) return true;
	return refuse(error, "%s: %.100s", complaint.key, complaint.text);
}

/* From the start state: states are read from the positions, for once. */
static bool begin(struct touchstone_engine *engine)
{
	engine->slack = slack_needed(engine, moment_double(engine->now), typical_speed(engine));
	bool enough = (engine->count < 2 || lay_out_cells(engine)) && read_states(engine);
	read_sides(engine);
	return enough && look_ahead(engine);
}

static struct touchstone_engine *engine_create(const struct touchstone_scene *scene, const char *method,
											   const struct touchstone_snapshot *snapshot, char error[160])
{
	if (!scene_makes_sense(scene, error)) return NULL;
	const struct method *chosen = find_policy(method, error);
	if (!chosen || !suits(chosen, scene, error)) return NULL;
	struct touchstone_engine *engine = calloc(1, sizeof *engine);
	if (!engine) {
		refuse(error, "not enough memory");
		return NULL;
	}
	engine->unit = &THIS_UNIT;
	engine->method = chosen;
	engine->bits = num_bits();
	engine->two_units = from_double(ldexp(1, 2 - engine->bits));
	engine->dimensions = scene->dimensions;
	engine->restitution = scene->restitution;
	engine->search = scene->search;
	engine->wanted_cell = scene->cell;
	engine->digest = first_digest;
	for (int axis = 0; axis < scene->dimensions; axis++) engine->periodic[axis] = scene->periodic[axis];
	bool made = set_species_and_walls(engine, scene) && set_potentials(engine, scene) &&
				set_virtual_walls(engine, scene) && set_particles(engine, scene) && set_heat(engine, scene) &&
				set_sieve(engine) && set_policy(engine) && set_deferral(engine) && set_second(engine);
	if (made) read_policy(engine, scene);
	*error = '\0';
	made = made && (snapshot ? take_in(engine, snapshot, error) : begin(engine));
	if (!made) {
		if (!*error) refuse(error, "not enough memory for %zu particles", scene->particle_count);
		engine_destroy(engine);
		return NULL;
	}
	return engine;
}

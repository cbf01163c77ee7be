/* From a scene's potentials and virtual walls to the engine's. */

static bool set_potential(struct touchstone_engine *engine, const struct touchstone_potential *said,
						  struct potential *potential)
{
	const uint32_t *species = said->species;
	num first = engine->mass[species[0]], second = engine->mass[species[1]], outside = from_double(0);
	double energy = 0, diameters = to_double(add(engine->radius[species[0]], engine->radius[species[1]]));
	*potential = (struct potential){.hard = said->core > 0, .restitution = said->restitution};
	/* The mean of two diameters is formed as for hard bodies, so that the same cores meet at the same numbers. */
	potential->core = from_double(said->core);
	if (to_double(potential->core) == diameters)
		potential->core = add(engine->radius[species[0]], engine->radius[species[1]]);
	potential->step = calloc(said->step_count + 1, sizeof *potential->step);
	if (!potential->step) return false;
	potential->step_count = (uint32_t)said->step_count;
	for (size_t s = 0; s < said->step_count; s++) { /* outwards in the scene, inwards here */
		const struct touchstone_step *step = &said->steps[said->step_count - 1 - s];
		num inside = from_double(step->energy), gain = sub(inside, outside);
		energy += to_double(gain);
		potential->step[s].distance = from_double(step->distance);
		potential->step[s].climb = divide(mul(add(gain, gain), add(first, second)), mul(first, second));
		potential->step[s].energy = energy;
		outside = inside;
	}
	if (said->step_count) engine->reach = fmax(engine->reach, to_double(potential->step[0].distance));
	return true;
}

/* Makes the table of potentials. */
static bool fill_potentials(struct touchstone_engine *engine, const struct touchstone_scene *scene)
{
	size_t species = scene->species_count;
	engine->potential = calloc(scene->potential_count, sizeof *engine->potential);
	engine->potential_of = malloc(species * species * sizeof *engine->potential_of);
	if (!engine->potential || !engine->potential_of) return false;
	memset(engine->potential_of, 0xff, species * species * sizeof *engine->potential_of);
	bool stepped = false;
	for (uint32_t p = 0; p < scene->potential_count; p++) {
		const struct touchstone_potential *said = &scene->potentials[p];
		if (!set_potential(engine, said, &engine->potential[p])) return false;
		engine->potential_count++;
		engine->potential_of[said->species[0] * species + said->species[1]] = p;
		engine->potential_of[said->species[1] * species + said->species[0]] = p;
		stepped |= said->step_count > 0;
	}
	if (!stepped) return true;
	engine->captured = calloc(scene->particle_count, sizeof *engine->captured);
	return engine->captured && pairs_create(&engine->pairs, (uint32_t)scene->particle_count);
}

static bool set_potentials(struct touchstone_engine *engine, const struct touchstone_scene *scene)
{
	engine->reach = engine->largest;
	bool filled = !scene->potential_count || fill_potentials(engine, scene);
	if (filled) engine->outermost_kind = species_meeting(engine, 0, 0, &engine->outermost);
	return filled;
}

static void set_plane(const struct touchstone_engine *engine, const double point[3], const double normal[3],
					  struct wall *wall);

static bool set_virtual_walls(struct touchstone_engine *engine, const struct touchstone_scene *scene)
{
	size_t count = scene->virtual_wall_count;
	if (!count) return true;
	engine->virtual_wall = calloc(count, sizeof *engine->virtual_wall);
	engine->side = calloc(scene->particle_count * count, sizeof *engine->side);
	engine->crossed = calloc(scene->particle_count, sizeof *engine->crossed);
	if (!engine->virtual_wall || !engine->side || !engine->crossed) return false;
	engine->virtual_wall_count = count;
	for (size_t w = 0; w < count; w++) {
		struct virtual_wall *wall = &engine->virtual_wall[w];
		const double *normal = scene->virtual_walls[w].normal;
		set_plane(engine, scene->virtual_walls[w].point, normal, &wall->plane);
		wall->axis = -1;
		for (int axis = 0; axis < engine->dimensions; axis++)
			if (engine->periodic[axis] && normal[axis] != 0) wall->axis = axis, wall->along = normal[axis] > 0 ? 1 : -1;
	}
	return true;
}

/* Makes the table of limits, in units of the shadows' length; the first of them is nobody's. */
static bool set_limits(struct touchstone_engine *engine)
{
	struct shadows *shadows = &engine->shadows;
	size_t species = engine->species_count, count = 1 + species * species;
	double scale = 1 / power_of_two_below(engine->reach);
	for (size_t p = 0; p < engine->potential_count; p++) count += engine->potential[p].step_count + 1;
	struct limits *limits = shadows->limits = calloc(count, sizeof *limits);
	if (!limits) return false;
	limits++;
	for (size_t p = 0; p < engine->potential_count; p++, limits++) {
		struct potential *potential = &engine->potential[p];
		potential->limits = (size_t)(limits - shadows->limits);
		for (uint32_t s = 0; s < potential->step_count; s++, limits++)
			limits[0].inner = limits[1].outer = (float)(to_double(potential->step[s].distance) * scale);
		limits->inner = (float)(to_double(potential->core) * scale);
	}
	shadows->hard_limits = (size_t)(limits - shadows->limits);
	for (size_t a = 0; a < species; a++)
		for (size_t b = 0; b < species; b++, limits++)
			limits->inner = (float)(to_double(add(engine->radius[a], engine->radius[b])) * scale);
	return true;
}

/* The distance at which two species first meet, as a sum of what either brings to it: their shadows' radii. False when
 * there is no such sum, or no memory; without memory there are no radii either. */
static bool set_shadow_radii(struct touchstone_engine *engine)
{
	size_t species = engine->species_count;
	double *radius = malloc(species * sizeof *radius);
	engine->shadows.radius = radius;
	for (size_t s = 0; radius && s < species; s++) radius[s] = to_double(engine->radius[s]);
	if (!radius || !engine->potential_of) return radius;
	num distance;
	for (size_t s = 0; s < species; s++) {
		species_meeting(engine, s, s, &distance);
		radius[s] = to_double(distance) / 2;
	}
	bool adds_up = true;
	for (size_t a = 0; a < species; a++)
		for (size_t b = 0; b < a; b++) {
			double sum = radius[a] + radius[b];
			species_meeting(engine, a, b, &distance);
			adds_up &= fabs(to_double(distance) - sum) <= 0x1p-50 * sum;
		}
	return adds_up;
}

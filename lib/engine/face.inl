/* What an engine tells, and the table the unit exports. */

static size_t state_memory(const struct touchstone_engine *engine)
{
	size_t walls = engine->virtual_wall_count * sizeof *engine->side + sizeof *engine->crossed;
	size_t marks = engine->captured ? engine->count * sizeof *engine->captured : 0;
	return pairs_memory(&engine->pairs) + neighbours_memory(engine) + marks +
		   (engine->side ? engine->count * walls : 0);
}

static size_t engine_memory(const struct touchstone_engine *engine)
{
	size_t each = sizeof *engine->body + sizeof *engine->place + sizeof *engine->itinerary + sizeof *engine->index_of +
				  (engine->open ? sizeof *engine->open : 0) + (engine->second ? sizeof *engine->second : 0) +
				  (engine->shadows.shadow ? sizeof *engine->shadows.shadow : 0) +
				  (engine->temperature ? sizeof *engine->temperature : 0);
	return sizeof *engine + engine->count * each + state_memory(engine) + agenda_memory(&engine->agenda) +
		   engine->cells.entries * sizeof *engine->cells.entry;
}

static void engine_status(const struct touchstone_engine *engine, struct touchstone_status *status)
{
	*status = (struct touchstone_status){
		.verdict = engine->verdict,
		.count = engine->count,
		.bits = engine->bits,
		.events = engine->events,
		.collisions = engine->kinds[TOUCHSTONE_CONTACT],
		.captures = engine->kinds[TOUCHSTONE_CAPTURE],
		.releases = engine->kinds[TOUCHSTONE_RELEASE],
		.bounces = engine->kinds[TOUCHSTONE_BOUNCE],
		.crossings = engine->kinds[TOUCHSTONE_CROSSING],
		.captured = engine->pairs.count,
		.potential_energy = potential_energy(engine),
		.kicked_energy = engine->kicked_energy,
		.thermostat_energy = engine->thermostat_energy,
		.lookups = engine->lookups,
		.time = moment_double(engine->now),
		.digest = engine->digest,
		.memory = engine_memory(engine),
		.state_memory = state_memory(engine),
		.particles = {engine->blamed[0], engine->blamed[1]},
	};
	memcpy(status->reason, engine->reason, sizeof status->reason);
}

static void engine_recount(struct touchstone_engine *engine)
{
	engine->events = engine->lookups = 0;
	engine->kicked_energy = engine->thermostat_energy = 0;
	memset(engine->kinds, 0, sizeof engine->kinds);
	for (size_t w = 0; w < engine->virtual_wall_count; w++)
		memset(engine->virtual_wall[w].flux, 0, sizeof engine->virtual_wall[w].flux);
	engine->digest = first_digest;
}

static void engine_observe_tests(struct touchstone_engine *engine, struct touchstone_listener *listener)
{
	engine->listener = listener;
}

static void engine_elastic(struct touchstone_engine *engine, bool elastic)
{
	engine->elastic = elastic;
}

static void engine_state(const struct touchstone_engine *engine, uint32_t particle, double position[3],
						 double velocity[3])
{
	uint32_t i = engine->index_of[particle];
	struct body body = engine->body[i];
	struct place place = engine->place[i];
	advance(engine, &body, &place, engine->now);
	for (int axis = 0; axis < 3; axis++) {
		bool has = axis < engine->dimensions;
		double box = engine->box[axis];
		position[axis] = velocity[axis] = 0;
		if (!has) continue;
		position[axis] = fma(place.index[axis], engine->place_width[axis], to_double(body.position[axis]));
		if (engine->periodic[axis]) position[axis] -= box * rint(position[axis] / box);
		velocity[axis] = to_double(body.velocity[axis]);
	}
}

static int engine_separation(const struct touchstone_engine *engine, double terms[3][3 * TOUCHSTONE_MOST_TERMS],
							 double contact[TOUCHSTONE_MOST_TERMS])
{
	uint32_t i = engine->touching[0], j = engine->touching[1];
	if (engine->tested_offset) {
		write_contact(engine->touching_distance, contact);
		return tested_terms(engine, terms);
	}
	const struct standing first = {engine->body[i], engine->place[i]}, second = {engine->body[j], engine->place[j]};
	write_contact(engine->touching_distance, contact);
	return separation_terms(engine, &first, &second, engine->touching_image, terms);
}

static int engine_pair_state(const struct touchstone_engine *engine, uint32_t first, uint32_t second)
{
	if (!engine->pairs.bucket) return 0;
	uint32_t count, state = 0, partner = engine->index_of[second];
	const struct pair_state *captured = pairs_of(&engine->pairs, engine->index_of[first], &count);
	for (uint32_t k = 0; k < count; k++)
		if (entry_particle(captured[k].entry) == partner && captured[k].state > state) state = captured[k].state;
	return (int)state;
}

static size_t engine_captured(const struct touchstone_engine *engine, uint32_t particle,
							  struct touchstone_captured *list, size_t room)
{
	if (!engine->pairs.bucket) return 0;
	uint32_t count;
	const struct pair_state *captured = pairs_of(&engine->pairs, engine->index_of[particle], &count);
	for (uint32_t k = 0; k < count && k < room; k++) {
		uint32_t entry = captured[k].entry;
		list[k] = (struct touchstone_captured){
			engine->itinerary[entry_particle(entry)].id,
			{entry_image(entry, 0), entry_image(entry, 1), entry_image(entry, 2)},
			(int)captured[k].state,
		};
	}
	return count;
}

static int engine_side(const struct touchstone_engine *engine, uint32_t particle, size_t wall)
{
	return *side_of(engine, engine->index_of[particle], wall);
}

static void engine_flux(const struct touchstone_engine *engine, size_t wall, struct touchstone_flux flux[2])
{
	memcpy(flux, engine->virtual_wall[wall].flux, sizeof engine->virtual_wall[wall].flux);
}

/* What particles are to each other, and which states must be tracked for it. */
static void explain_states(const struct touchstone_engine *engine, void (*line)(void *context, const char *text),
						   void *context)
{
	char text[240];
	if (!engine->potential_count) line(context, "pair states: none; hard bodies have nothing to remember");
	for (size_t p = 0; p < engine->potential_count; p++) {
		const struct potential *potential = &engine->potential[p];
		int length = snprintf(text, sizeof text, "potential %zu: ", p + 1);
		if (potential->hard)
			length += snprintf(text + length, sizeof text - (size_t)length, "core at %g", to_double(potential->core));
		else
			length += snprintf(text + length, sizeof text - (size_t)length, "no core");
		for (uint32_t s = potential->step_count; s-- > 0 && length < 200;)
			length += snprintf(text + length, sizeof text - (size_t)length, "%s %g within %g",
							   s + 1 == potential->step_count ? "; energy" : ",", potential->step[s].energy,
							   to_double(potential->step[s].distance));
		if (length >= 200) snprintf(text + length, sizeof text - (size_t)length, ", ...");
		line(context, text);
	}
	if (engine->pairs.bucket) {
		bool positional = engine->method->policy & POLICY_POSITIONAL;
		snprintf(text, sizeof text,
				 "pair states: %s; stored for the %llu pairs within a step, in %.3g bytes per particle",
				 positional ? "read from separations whenever a pair is tested, as the method has it, though at a step "
							  "they cannot tell in from out"
							: "tracked, since at a step positions cannot tell in from out",
				 (unsigned long long)engine->pairs.count, (double)pairs_memory(&engine->pairs) / engine->count);
		line(context, text);
	}
	if (engine->neighbours.skin > 0) {
		snprintf(text, sizeof text,
				 "neighbour lists: pairs within %.3g of contact or of a step are asked, %.3g of them per particle; "
				 "made anew "
				 "when it has gone %.3g",
				 engine->neighbours.skin, 2 * (double)engine->neighbours.pairs.count / engine->count,
				 engine->neighbours.free);
		line(context, text);
	}
	if (engine->last_met) line(context, "last partners: one per particle, since the method knows who has just met");
	if (engine->cells.entry)
		line(context,
			 "cells and images: tracked; particles change them by leaving through a face, where positions cannot "
			 "tell either");
	if (engine->virtual_wall_count)
		snprintf(
			text, sizeof text,
			"virtual walls: %zu; the side each particle is on is tracked, since on a wall positions cannot tell, and "
			"nothing moves",
			engine->virtual_wall_count);
	else
		snprintf(text, sizeof text, "virtual walls: none, so no sides");
	line(context, text);
}

static void engine_explain(const struct touchstone_engine *engine, void (*line)(void *context, const char *text),
						   void *context)
{
	char text[240];
	const struct cells *cells = &engine->cells;
	snprintf(text, sizeof text, "numbers: %d significant bits, %zu bytes each; %zu bytes per particle in all",
			 engine->bits, sizeof(num), engine_memory(engine) / engine->count);
	line(context, text);
	if (engine->page_length < INFINITY)
		snprintf(text, sizeof text, "time: in pages of %g, so that its error does not grow", engine->page_length);
	else
		snprintf(text, sizeof text, "time: absolute, as in the papers; it loses bits as it grows");
	line(context, text);
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double width = engine->place_width[axis];
		snprintf(text, sizeof text, "axis %c: %s, extent %.17g; positions %s%s%g", "xyz"[axis],
				 engine -> periodic[axis] ? "periodic" : "not periodic, no images drawn", engine->box[axis],
				 width > 0 ? "within places of " : "from the origin", width > 0 ? "" : "; width ", width);
		if (width == 0) text[strlen(text) - strlen("; width 0")] = 0;
		line(context, text);
	}
	if (!cells->entry) {
		line(context, "search: none; one particle has no neighbours, so no cells are built");
	} else {
		int length = snprintf(
			text, sizeof text, "search: %d x %d x %d cells of side %.6g (%.3g slack), room for %u in each",
			cells->count[0], cells->count[1], cells->count[2], engine->cell_side[0], engine->slack, cells->capacity);
		if (engine->roomy)
			snprintf(text + length, sizeof text - (size_t)length, "; left when %.3g beyond them", engine->stray[0]);
		line(context, text);
	}
	const struct sieve_machine *machine = engine->shadows.machine;
	snprintf(text, sizeof text, "sieve: %s%s",
			 machine ? "most pairs are rejected in binary32 first, by way of " : "none",
			 machine ? machine->name : "; every pair is worked out in full");
	if (cells->entry) line(context, text);
	snprintf(text, sizeof text, "agenda: days of %g, %zu of them in the ring", engine->agenda.day, engine->agenda.days);
	line(context, text);
	line(context, engine->wall_count ? "walls: tested for every particle" : "walls: none, so none are tested");
	line(context, engine->accelerated ? "flights: parabolas" : "flights: straight, so no acceleration is computed");
	line(context, engine->species_count > 1 ? "species: several, contact distance per pair"
											: "species: one, so one contact distance for all pairs");
	explain_states(engine, line, context);
	if (engine->temperature) line(context, "convection: particles carry heat, and collisions kick them by it");
	if (engine->thermostat > 0) line(context, "walls: thermal, velocities drawn from particle and time of the event");
	explain_policy(engine, line, context);
}

const struct unit THIS_UNIT = {
	.name = num_name,
	.choose = num_choose,
	.bits = num_bits,
	.create = engine_create,
	.destroy = engine_destroy,
	.run = engine_run,
	.status = engine_status,
	.recount = engine_recount,
	.elastic = engine_elastic,
	.rescale = engine_rescale,
	.state = engine_state,
	.temperature = engine_temperature,
	.observe_tests = engine_observe_tests,
	.separation = engine_separation,
	.overlaps = engine_overlaps,
	.pair_state = engine_pair_state,
	.captured = engine_captured,
	.side = engine_side,
	.flux = engine_flux,
	.save = engine_save,
	.explain = engine_explain,
	.drop = unit_drop,
	.find = unit_find,
	.find_terms = unit_find_terms,
	.find_steps = unit_find_steps,
	.claim = unit_claim,
	.exact_count = exact_count,
};

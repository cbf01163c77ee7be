/* The state of an engine as a table of fields, and back. Where a field lies in the engine is said once, in the list
 * below, by which it is both saved and taken in: whatever else an event may come to leave behind belongs there too. */

static bool refuse(char error[160], const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(error, 160, format, arguments);
	va_end(arguments);
	return false;
}

enum holder {
	OF_ENGINE,
	OF_WALLS,     /* a row for each virtual wall */
	OF_PARTICLES, /* a row for each particle: in the order of the scene, not in the engine's own */
	OF_SCENE,     /* a row that follows from the scene, and must agree with it */
};

struct strip {
	const char *name;
	enum touchstone_content content;
	enum holder holder;
	size_t columns;
	void *first;   /* row 0, in the engine */
	size_t stride; /* from row to row, in bytes */
};

struct strips {
	size_t count;
	struct strip strip[TOUCHSTONE_MOST_FIELDS];
};

static void add_strips(struct strips *strips, const struct strip *more, size_t count)
{
	memcpy(strips->strip + strips->count, more, count * sizeof *more);
	strips->count += count;
}

static struct strips strips_of(struct touchstone_engine *engine)
{
	struct strips strips = {0};
	size_t bodies = sizeof *engine->body, places = sizeof *engine->place, itineraries = sizeof *engine->itinerary;
	const struct strip always[] = {
		{"position", TOUCHSTONE_NUMBERS, OF_PARTICLES, 3, engine->body->position, bodies},
		{"velocity", TOUCHSTONE_NUMBERS, OF_PARTICLES, 3, engine->body->velocity, bodies},
		{"time", TOUCHSTONE_NUMBERS, OF_PARTICLES, 1, &engine->body->time, bodies},
		{"page", TOUCHSTONE_DOUBLES, OF_PARTICLES, 1, &engine->body->page, bodies},
		{"place", TOUCHSTONE_INTEGERS, OF_PARTICLES, 3, engine->place->index, places},
		{"stalls", TOUCHSTONE_INTEGERS, OF_PARTICLES, 1, &engine->itinerary->stalls, itineraries},
		{"now_time", TOUCHSTONE_NUMBERS, OF_ENGINE, 1, &engine->now.time, 0},
		{"now_page", TOUCHSTONE_DOUBLES, OF_ENGINE, 1, &engine->now.page, 0},
		{"latest_time", TOUCHSTONE_NUMBERS, OF_ENGINE, 1, &engine->latest.time, 0},
		{"latest_page", TOUCHSTONE_DOUBLES, OF_ENGINE, 1, &engine->latest.page, 0},
		{"events", TOUCHSTONE_COUNTS, OF_ENGINE, 1, &engine->events, 0},
		{"kinds", TOUCHSTONE_COUNTS, OF_ENGINE, sizeof engine->kinds / sizeof *engine->kinds, engine->kinds, 0},
		{"lookups", TOUCHSTONE_COUNTS, OF_ENGINE, 1, &engine->lookups, 0},
		{"digest", TOUCHSTONE_COUNTS, OF_ENGINE, 1, &engine->digest, 0},
		{"kicked_energy", TOUCHSTONE_DOUBLES, OF_ENGINE, 1, &engine->kicked_energy, 0},
		{"thermostat_energy", TOUCHSTONE_DOUBLES, OF_ENGINE, 1, &engine->thermostat_energy, 0},
		{"elastic", TOUCHSTONE_BYTES, OF_ENGINE, 1, &engine->elastic, 0},
		{"uneven", TOUCHSTONE_BYTES, OF_ENGINE, 1, &engine->uneven, 0},
		{"verdict", TOUCHSTONE_INTEGERS, OF_ENGINE, 1, &engine->verdict, 0},
		{"reason", TOUCHSTONE_BYTES, OF_ENGINE, sizeof engine->reason, engine->reason, 0},
		{"blamed", TOUCHSTONE_INTEGERS, OF_ENGINE, 2, engine->blamed, 0},
		{"place_width", TOUCHSTONE_DOUBLES, OF_SCENE, 3, engine->place_width, 0},
		{"page_length", TOUCHSTONE_DOUBLES, OF_SCENE, 1, &engine->page_length, 0},
	};
	add_strips(&strips, always, sizeof always / sizeof *always);
	const struct strip heat = {"temperature",       TOUCHSTONE_NUMBERS,         OF_PARTICLES, 1,
							   engine->temperature, sizeof *engine->temperature};
	if (engine->temperature) add_strips(&strips, &heat, 1);
	const struct strip last = {"last_met", TOUCHSTONE_INTEGERS, OF_PARTICLES,
							   1,          engine->last_met,    sizeof *engine->last_met};
	if (engine->last_met) add_strips(&strips, &last, 1);
	size_t walls = engine->virtual_wall_count;
	if (!walls) return strips;
	struct touchstone_flux *flux = engine->virtual_wall->flux;
	enum { SUMS = 5 }; /* mass, momentum on three axes, energy */
	const struct strip at_walls[] = {
		{"side", TOUCHSTONE_INTEGERS, OF_PARTICLES, walls, engine->side, walls * sizeof *engine->side},
		{"crossed_time", TOUCHSTONE_NUMBERS, OF_PARTICLES, 1, &engine->crossed->time, sizeof *engine->crossed},
		{"crossed_page", TOUCHSTONE_DOUBLES, OF_PARTICLES, 1, &engine->crossed->page, sizeof *engine->crossed},
		{"flux_with_count", TOUCHSTONE_COUNTS, OF_WALLS, 1, &flux[0].count, sizeof *engine->virtual_wall},
		{"flux_with", TOUCHSTONE_DOUBLES, OF_WALLS, SUMS, &flux[0].mass, sizeof *engine->virtual_wall},
		{"flux_against_count", TOUCHSTONE_COUNTS, OF_WALLS, 1, &flux[1].count, sizeof *engine->virtual_wall},
		{"flux_against", TOUCHSTONE_DOUBLES, OF_WALLS, SUMS, &flux[1].mass, sizeof *engine->virtual_wall},
	};
	_Static_assert(sizeof always + sizeof heat + sizeof last + sizeof at_walls < sizeof strips.strip,
				   "and the captured pairs");
	add_strips(&strips, at_walls, sizeof at_walls / sizeof *at_walls);
	return strips;
}

static size_t strip_rows(const struct touchstone_engine *engine, const struct strip *strip)
{
	return strip->holder == OF_PARTICLES ? engine->count : strip->holder == OF_WALLS ? engine->virtual_wall_count : 1;
}

/* Where a row of a snapshot lies in the engine. */
static char *strip_row(const struct touchstone_engine *engine, const struct strip *strip, size_t row)
{
	size_t at = strip->holder == OF_PARTICLES ? engine->index_of[row] : row;
	return (char *)strip->first + at * strip->stride;
}

/* A new field at the end of a snapshot; false when there is no memory for it. */
static bool add_field(struct touchstone_snapshot *snapshot, const char *name, enum touchstone_content content,
					  size_t rows, size_t columns)
{
	struct touchstone_field *field = &snapshot->field[snapshot->count];
	*field = (struct touchstone_field){.content = content, .rows = rows, .columns = columns};
	snprintf(field->name, sizeof field->name, "%s", name);
	field->data = malloc(touchstone_field_bytes(snapshot, field) + 1);
	snapshot->count += field->data != NULL;
	return field->data;
}

static bool save_strip(const struct touchstone_engine *engine, const struct strip *strip,
					   struct touchstone_snapshot *snapshot)
{
	size_t rows = strip_rows(engine, strip), words = (size_t)snapshot->words;
	if (!add_field(snapshot, strip->name, strip->content, rows, strip->columns)) return false;
	const struct touchstone_field *field = &snapshot->field[snapshot->count - 1];
	size_t width = touchstone_field_bytes(snapshot, field) / rows;
	char *to = field->data;
	for (size_t row = 0; row < rows; row++, to += width) {
		const char *from = strip_row(engine, strip, row);
		if (strip->content != TOUCHSTONE_NUMBERS)
			memcpy(to, from, width);
		else
			for (size_t c = 0; c < strip->columns; c++) to_words(((const num *)from)[c], (uint64_t *)to + c * words);
	}
	return true;
}

/* False when a number is none, or the scene says otherwise. */
static bool take_strip(struct touchstone_engine *engine, const struct strip *strip,
					   const struct touchstone_snapshot *snapshot, const struct touchstone_field *field)
{
	size_t words = (size_t)snapshot->words, width = touchstone_field_bytes(snapshot, field) / field->rows;
	const char *from = field->data;
	bool sound = true;
	for (size_t row = 0; row < field->rows; row++, from += width) {
		char *to = strip_row(engine, strip, row);
		if (strip->holder == OF_SCENE)
			sound &= memcmp(to, from, width) == 0;
		else if (strip->content != TOUCHSTONE_NUMBERS)
			memcpy(to, from, width);
		else
			for (size_t c = 0; c < strip->columns; c++)
				sound &= from_words((const uint64_t *)from + c * words, (num *)to + c);
	}
	return sound;
}

/* A captured pair: two particles, by how many boxes the image of the second that is meant lies off, and the state. */
enum { PAIR_COLUMNS = 6 };
static const char pairs_name[] = "pairs";

static bool save_pairs(const struct touchstone_engine *engine, struct touchstone_snapshot *snapshot)
{
	if (!add_field(snapshot, pairs_name, TOUCHSTONE_INTEGERS, engine->pairs.count, PAIR_COLUMNS)) return false;
	int32_t *to = snapshot->field[snapshot->count - 1].data;
	for (uint32_t id = 0; id < engine->count; id++) {
		uint32_t count;
		const struct pair_state *captured = pairs_of(&engine->pairs, engine->index_of[id], &count);
		for (uint32_t k = 0; k < count; k++) {
			uint32_t entry = captured[k].entry, partner = engine->itinerary[entry_particle(entry)].id;
			if (partner < id) continue;
			*to++ = (int32_t)id, *to++ = (int32_t)partner;
			for (int axis = 0; axis < 3; axis++) *to++ = entry_image(entry, axis);
			*to++ = (int32_t)captured[k].state;
		}
	}
	return true;
}

static bool take_pair(struct touchstone_engine *engine, const int32_t pair[PAIR_COLUMNS])
{
	if (pair[0] < 0 || pair[0] >= pair[1] || (uint32_t)pair[1] >= engine->count) return false;
	uint32_t i = engine->index_of[pair[0]], entry = engine->index_of[pair[1]];
	const struct potential *potential = potential_between(engine, i, entry);
	for (int axis = 0; axis < 3; axis++) {
		int image = pair[2 + axis];
		if (image < -1 || image > 1 || (image && !engine->periodic[axis])) return false;
		entry = entry_shifted(entry, axis, image);
	}
	int32_t state = pair[PAIR_COLUMNS - 1];
	return potential && state > 0 && (uint32_t)state <= potential->step_count &&
		   pairs_get(&engine->pairs, i, entry) == 0 && set_state(engine, potential, i, entry, 0, (uint32_t)state);
}

static bool engine_save(const struct touchstone_engine *engine, struct touchstone_snapshot *snapshot)
{
	struct strips strips = strips_of((struct touchstone_engine *)engine); /* for reading only */
	*snapshot = (struct touchstone_snapshot){.words = num_words(), .doubles = num_words_are_doubles};
	bool enough = true;
	for (size_t s = 0; enough && s < strips.count; s++) enough = save_strip(engine, &strips.strip[s], snapshot);
	if (enough && engine->pairs.bucket) enough = save_pairs(engine, snapshot);
	if (!enough) touchstone_snapshot_free(snapshot);
	return enough;
}

/* The field of that name, if it is as it should be. */
static const struct touchstone_field *find_field(const struct touchstone_snapshot *snapshot, const char *name,
												 enum touchstone_content content, size_t columns, char error[160])
{
	for (size_t f = 0; f < snapshot->count; f++) {
		const struct touchstone_field *field = &snapshot->field[f];
		if (strcmp(field->name, name) != 0) continue;
		if (field->content == content && field->columns == columns) return field;
	}
	refuse(error, "the state has no field '%s' as this scene needs it", name);
	return NULL;
}

/* Whether a particle is where a search can go on from: along a periodic axis, near its box. */
static bool body_makes_sense(const struct touchstone_engine *engine, uint32_t i)
{
	static const int most_boxes = 64, most_places = 1 << 30;
	const struct body *body = &engine->body[i];
	bool sound = is_finite(body->time) && fabs(body->page) < INFINITY;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		int32_t place = engine->place[i].index[axis];
		sound &= place > -most_places && place < most_places;
		if (engine->periodic[axis]) sound &= fabs(coordinate_now(engine, i, axis)) < most_boxes * engine->box[axis];
	}
	for (size_t w = 0; w < engine->virtual_wall_count; w++) {
		int32_t side = engine->side[i * engine->virtual_wall_count + w];
		bool repeated = engine->virtual_wall[w].axis >= 0;
		sound &= repeated ? side >= -most_boxes && side <= most_boxes : side == 0 || side == -1;
	}
	return sound;
}

static bool state_makes_sense(const struct touchstone_engine *engine, char error[160])
{
	unsigned char elastic, uneven;
	memcpy(&elastic, &engine->elastic, 1);
	memcpy(&uneven, &engine->uneven, 1);
	if (elastic > 1 || uneven > 1 || engine->verdict > TOUCHSTONE_DIVERGED || engine->reason[159])
		return refuse(error, "the state's verdict is none");
	for (uint32_t id = 0; engine->verdict == TOUCHSTONE_DONE && id < engine->count; id++)
		if (!body_makes_sense(engine, engine->index_of[id]))
			return refuse(error, "the state of particle %u is none that a run could leave", id);
	return true;
}

/* Takes a state in and looks for what comes next in it; a run that has ended has nothing more to look for. False with
 * one line, or with none when memory ran out. */
static bool take_in(struct touchstone_engine *engine, const struct touchstone_snapshot *snapshot, char error[160])
{
	struct strips strips = strips_of(engine);
	size_t expected = strips.count + (engine->pairs.bucket != NULL);
	if (snapshot->words != num_words() || snapshot->count != expected)
		return refuse(error, "the state is that of another scene or arithmetic");
	for (size_t s = 0; s < strips.count; s++) {
		const struct strip *strip = &strips.strip[s];
		const struct touchstone_field *field = find_field(snapshot, strip->name, strip->content, strip->columns, error);
		if (!field) return false;
		if (field->rows != strip_rows(engine, strip) || !take_strip(engine, strip, snapshot, field))
			return refuse(error, "the state's field '%s' is none of this scene", strip->name);
	}
	if (!state_makes_sense(engine, error)) return false;
	if (engine->pairs.bucket) {
		const struct touchstone_field *field =
			find_field(snapshot, pairs_name, TOUCHSTONE_INTEGERS, PAIR_COLUMNS, error);
		if (!field) return false;
		for (size_t row = 0; row < field->rows; row++)
			if (!take_pair(engine, (const int32_t *)field->data + row * PAIR_COLUMNS))
				return refuse(error, "the state's captured pair %zu is none of this scene", row);
	}
	if (engine->verdict != TOUCHSTONE_DONE) return true;
	engine->slack = slack_needed(engine, moment_double(engine->now), typical_speed(engine));
	unsigned backwards = engine->method->policy & (POLICY_BACKWARDS | POLICY_SEARCH);
	if (backwards && moment_before(engine->now, engine->latest)) far_back(engine);
	return lay_out(engine);
}

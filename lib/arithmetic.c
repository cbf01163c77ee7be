/* The public functions: an arithmetic is found by name, everything else goes through its table. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit/unit.h"

#ifdef TOUCHSTONE_WITHOUT_MPFR /* nor with numbers of the compiler's own */
static const struct unit *const units[] = {&unit_short, &unit_binary32, &unit_binary64, &unit_twin};
#else
static const struct unit *const units[] = {&unit_short,     &unit_binary32, &unit_binary64, &unit_extended, &unit_twin,
										   &unit_binary128, &unit_mpfr2,    &unit_mpfr4,    &unit_mpfr16};
#endif
enum { UNITS = sizeof units / sizeof *units };

/* Finds the unit for "name" or "name:bits" and sets the thread's working precision to it. */
static const struct unit *choose(const char *arithmetic, char error[160])
{
	const char *colon = strchr(arithmetic, ':');
	size_t length = colon ? (size_t)(colon - arithmetic) : strlen(arithmetic);
	char *end = "";
	long bits = colon ? strtol(colon + 1, &end, 10) : 0;
	bool known = false, number = !colon || (colon[1] >= '0' && colon[1] <= '9' && !*end);
	for (int u = 0; u < UNITS; u++) {
		if (strlen(units[u]->name) != length || memcmp(units[u]->name, arithmetic, length) != 0) continue;
		known = true;
		if (number && bits <= 100000 && units[u]->choose((int)bits)) return units[u];
	}
	snprintf(error, 160,
			 known ? "arithmetic '%.40s': short:P takes P from 4 to 25, mpfr:P from 2 to 1024, the others no number"
				   : "no arithmetic '%.40s'; known are short:P, binary32, binary64, extended, twin, binary128, mpfr:P",
			 arithmetic);
	return NULL;
}

/* Every unit's engine begins with its unit and the precision it was made with. */
struct head {
	const struct unit *unit;
	int bits;
};

/* The unit of an engine, with the thread's working precision set to the engine's. */
static const struct unit *unit_of(const struct touchstone_engine *engine)
{
	const struct head *head = (const struct head *)engine;
	head->unit->choose(head->bits);
	return head->unit;
}

struct touchstone_engine *touchstone_create(const struct touchstone_scene *scene, const char *arithmetic,
											const char *method, char error[160])
{
	const struct unit *unit = choose(arithmetic, error);
	return unit ? unit->create(scene, method, NULL, error) : NULL;
}

struct touchstone_engine *touchstone_restore(const struct touchstone_scene *scene, const char *arithmetic,
											 const char *method, const struct touchstone_snapshot *snapshot,
											 char error[160])
{
	const struct unit *unit = choose(arithmetic, error);
	return unit ? unit->create(scene, method, snapshot, error) : NULL;
}

bool touchstone_save(const struct touchstone_engine *engine, struct touchstone_snapshot *snapshot)
{
	return unit_of(engine)->save(engine, snapshot);
}

size_t touchstone_field_bytes(const struct touchstone_snapshot *snapshot, const struct touchstone_field *field)
{
	size_t each = field->content == TOUCHSTONE_NUMBERS    ? sizeof(uint64_t) * (size_t)snapshot->words
				  : field->content == TOUCHSTONE_INTEGERS ? sizeof(int32_t)
				  : field->content == TOUCHSTONE_BYTES    ? 1
														  : sizeof(uint64_t);
	return field->rows * field->columns * each;
}

void touchstone_snapshot_free(struct touchstone_snapshot *snapshot)
{
	for (size_t f = 0; f < snapshot->count; f++) free(snapshot->field[f].data);
	*snapshot = (struct touchstone_snapshot){0};
}

void touchstone_destroy(struct touchstone_engine *engine)
{
	if (engine) unit_of(engine)->destroy(engine);
}

enum touchstone_verdict touchstone_run(struct touchstone_engine *engine, const struct touchstone_limits *limits,
									   const struct touchstone_observer *observer)
{
	return unit_of(engine)->run(engine, limits, observer);
}

void touchstone_status(const struct touchstone_engine *engine, struct touchstone_status *status)
{
	unit_of(engine)->status(engine, status);
}

void touchstone_recount(struct touchstone_engine *engine)
{
	unit_of(engine)->recount(engine);
}

void touchstone_elastic(struct touchstone_engine *engine, bool elastic)
{
	unit_of(engine)->elastic(engine, elastic);
}

bool touchstone_rescale(struct touchstone_engine *engine, int exponent)
{
	return unit_of(engine)->rescale(engine, exponent);
}

void touchstone_state(const struct touchstone_engine *engine, uint32_t particle, double position[3], double velocity[3])
{
	unit_of(engine)->state(engine, particle, position, velocity);
}

double touchstone_temperature(const struct touchstone_engine *engine, uint32_t particle)
{
	return unit_of(engine)->temperature(engine, particle);
}

void touchstone_observe_tests(struct touchstone_engine *engine, struct touchstone_listener *listener)
{
	unit_of(engine)->observe_tests(engine, listener);
}

int touchstone_separation(const struct touchstone_engine *engine, double terms[3][3 * TOUCHSTONE_MOST_TERMS],
						  double contact[TOUCHSTONE_MOST_TERMS])
{
	return unit_of(engine)->separation(engine, terms, contact);
}

size_t touchstone_overlaps(const struct touchstone_engine *engine, uint32_t particle, struct touchstone_overlap *list,
						   size_t room)
{
	return unit_of(engine)->overlaps(engine, particle, list, room);
}

int touchstone_pair_state(const struct touchstone_engine *engine, uint32_t first, uint32_t second)
{
	return unit_of(engine)->pair_state(engine, first, second);
}

size_t touchstone_captured(const struct touchstone_engine *engine, uint32_t particle, struct touchstone_captured *list,
						   size_t room)
{
	return unit_of(engine)->captured(engine, particle, list, room);
}

int touchstone_side(const struct touchstone_engine *engine, uint32_t particle, size_t wall)
{
	return unit_of(engine)->side(engine, particle, wall);
}

void touchstone_flux(const struct touchstone_engine *engine, size_t wall, struct touchstone_flux flux[2])
{
	unit_of(engine)->flux(engine, wall, flux);
}

void touchstone_explain(const struct touchstone_engine *engine, void (*line)(void *context, const char *text),
						void *context)
{
	unit_of(engine)->explain(engine, line, context);
}

bool touchstone_drop(const char *arithmetic, const char *method, const struct touchstone_drop *drop, size_t count,
					 struct touchstone_landing *landing, touchstone_bounce *bounce, void *context, char error[160])
{
	const struct unit *unit = choose(arithmetic, error);
	return unit && unit->drop(method, drop, count, landing, bounce, context, error);
}

const char *touchstone_drop_order(unsigned order)
{
	static const char *const orders[TOUCHSTONE_DROP_ORDERS] = {
		"gap (r - plate) - s/2, flight (r + v t) + g/2 t^2", "gap r - (plate + s/2), flight (r + v t) + g/2 t^2",
		"gap (r - plate) - s/2, flight r + (v t + g/2 t^2)", "gap r - (plate + s/2), flight r + (v t + g/2 t^2)",
		"gap (r - plate) - s/2, flight r + t (v + g/2 t)",   "gap r - (plate + s/2), flight r + t (v + g/2 t)",
	};
	return order < TOUCHSTONE_DROP_ORDERS ? orders[order] : NULL;
}

const char *touchstone_arithmetic_name(size_t number)
{
	static const char *const names[] = {"short:P", "binary32", "binary64", "extended", "twin", "binary128", "mpfr:P"};
	return number < sizeof names / sizeof *names ? names[number] : NULL;
}

static const char *const finder_names[] = {
	"stable", "naive",  "guarded", "compensated",       "rounded", "rewind",   "skip",
	"search", "shrink", "tc",      "numerical-recipes", "kahan",   "sterbenz", "textbook-epsilon"};
enum { FINDERS = sizeof finder_names / sizeof *finder_names, POLICIES = 10 };

/* Those that are a policy around the finders of another. */
static const char *const policy_names[] = {"positional", "stretch", "nudge", "last-event"};
enum { BORROWERS = sizeof policy_names / sizeof *policy_names };

const char *touchstone_method_name(size_t number)
{
	if (number < POLICIES) return finder_names[number];
	return number < POLICIES + BORROWERS ? policy_names[number - POLICIES] : NULL;
}

const char *touchstone_finder_name(size_t number)
{
	return number < FINDERS ? finder_names[number] : NULL;
}

bool touchstone_find(const char *arithmetic, const char *method, enum touchstone_shape shape,
					 const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, bool chained, double *times,
					 char error[160])
{
	const struct unit *unit = choose(arithmetic, error);
	return unit && unit->find(method, shape, numbers, count, chained, times, error);
}

bool touchstone_find_terms(const char *arithmetic, const char *method, enum touchstone_shape shape,
						   const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count,
						   double (*times)[TOUCHSTONE_MOST_TERMS], char error[160])
{
	const struct unit *unit = choose(arithmetic, error);
	return unit && unit->find_terms(method, shape, numbers, count, times, error);
}

bool touchstone_find_steps(const char *arithmetic, const char *method, enum touchstone_shape shape,
						   const double numbers[TOUCHSTONE_MOST_NUMBERS], struct touchstone_steps *steps,
						   char error[160])
{
	const struct unit *unit = choose(arithmetic, error);
	return unit && unit->find_steps(method, shape, numbers, steps, error);
}

bool touchstone_finder_claim(const char *arithmetic, const char *method, enum touchstone_shape shape,
							 struct touchstone_claim *claim, char error[160])
{
	const struct unit *unit = choose(arithmetic, error);
	return unit && unit->claim(method, shape, claim, error);
}

size_t touchstone_exact_count(enum touchstone_shape shape, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
							  size_t count)
{
	return unit_binary64.exact_count(shape, numbers, count);
}

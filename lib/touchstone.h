/* Touchstone: numerical robustness of event-driven particle dynamics.
 *
 * The public face of the library. It compiles alone, as C11 and as C++.
 *
 * Units are dimensionless: lengths, masses and times are whatever the scene means by 1. A hard-sphere gas
 * usually takes its largest diameter, its unit of mass and its temperature kT as 1.
 *
 * The engine is written once and compiled once per arithmetic. An arithmetic is chosen by name at run time:
 * "binary64", "binary32", "short:P" (4 <= P <= 25), "extended", "twin", "binary128", "mpfr:P" (2 <= P <= 1024).
 * Nothing here prints, and no function keeps state outside the engine it is given. One engine belongs to one
 * thread at a time; different engines may run on different threads. */
#ifndef TOUCHSTONE_H
#define TOUCHSTONE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default) /* the shared library shows what is declared here, and nothing else */
#endif

/* ------------------------------------------------------------------ scenes */

/* What happens to the normal velocity at an impact (2014 paper, eqs. 4 and 5). */
struct touchstone_restitution {
	enum touchstone_law {
		TOUCHSTONE_CONSTANT,     /* coefficient is the restitution itself, 0 to 1 */
		TOUCHSTONE_VISCOELASTIC, /* coefficient is the dissipation beta of Mueller and Poeschel 2011: restitution
									falls from 1 with the fifth root of the impact speed */
	} law;
	double coefficient;
};

struct touchstone_species {
	double diameter; /* > 0 */
	double mass;     /* > 0 */
};

/* Where one particle starts. Axes the scene does not have hold zeros. */
struct touchstone_particle {
	double position[3];
	double velocity[3];
	uint32_t species; /* index into the scene's species */
};

/* A fixed plane that particles touch with their surface: contact at half a diameter from it, on the side its
 * normal points to. */
struct touchstone_wall {
	double point[3];
	double normal[3]; /* of length 1 */
	struct touchstone_restitution restitution;
};

/* One step of a pair potential (2016 paper, fig. 1). */
struct touchstone_step {
	double distance; /* > 0 */
	double energy;   /* of a pair that is nearer than this, and not nearer than the next step inwards; finite */
};

/* What the particles of two species, or of one, are to each other, in place of hard bodies: a square well is one step
 * of negative energy, a square shoulder one of positive energy. Beyond the last step the energy is 0. */
struct touchstone_potential {
	uint32_t species[2];                       /* in any order; each pair of species has at most one potential */
	double core;                               /* distance at which they collide; 0: they never do */
	struct touchstone_restitution restitution; /* at the core */
	size_t step_count;                         /* 0: nothing but the core */
	const struct touchstone_step *steps;       /* outwards: each distance larger than the one before, and the core */
};

/* A plane that counts what passes through it and does nothing else (2016 paper, section 4). It stands once in every
 * image of the box, so that on a periodic axis its normal lies along the axis or across it. */
struct touchstone_virtual_wall {
	double point[3];  /* on periodic axes within the box */
	double normal[3]; /* of length 1 */
};

/* Particles that carry heat, as those of a public simulator of convection do ("event-driven simulator of many colliding
 * particles"). Two that collide both take the mean T' of their temperatures, and each is given a velocity of
 * -kick (T' - neutral) along the last axis, its own impulse apart; one that meets a wall takes the mean of its
 * temperature and the wall's. Kicks bring energy in: see touchstone_status. */
struct touchstone_convection {
	const double *temperatures; /* of the particles at the start; NULL: they carry none, and nothing else is read */
	const double *wall_temperatures; /* of the walls; NaN: it passes no heat on */
	double kick, neutral;
};

enum touchstone_form {
	TOUCHSTONE_RELATIVE, /* time since the page was turned, position within a place: errors do not grow */
	TOUCHSTONE_ABSOLUTE, /* one time since the start, one position within the box, as in the papers */
};

enum touchstone_search {
	TOUCHSTONE_CELLS,    /* only particles in neighbouring cells are looked at, and most rejected in binary32 */
	TOUCHSTONE_ALL,      /* every pair is looked at: slow, to check the others against */
	TOUCHSTONE_UNSIEVED, /* cells, with every rejection left to the working arithmetic: to tell what that costs */
};

/* All that an engine is made from. The arrays belong to the caller and are only read while the engine is made. */
struct touchstone_scene {
	int dimensions; /* 1, 2 or 3 */
	size_t particle_count;
	const struct touchstone_particle *particles;
	size_t species_count;
	const struct touchstone_species *species;
	size_t wall_count;
	const struct touchstone_wall *walls;
	bool periodic[3];
	double box[3];          /* extent of each axis, from -box/2 to +box/2; on an axis that is not periodic it only
							   guides the cells */
	double acceleration[3]; /* the same for all particles */
	struct touchstone_restitution restitution; /* between particles that have no potential */
	size_t potential_count;
	const struct touchstone_potential *potentials;
	size_t virtual_wall_count;
	const struct touchstone_virtual_wall *virtual_walls;
	struct touchstone_convection convection;
	double thermostat; /* kT of thermal walls: who meets one leaves it with a velocity drawn at that temperature
						  (Lebowitz and Spohn 1978); 0: walls send particles back by their restitution */
	enum touchstone_form form;
	enum touchstone_search search;
	double cell; /* side of a search cell; 0: chosen. Never changes a result */
	/* What methods leave open; 0: what their files say (lib/method), which other methods do not read. */
	double contact_time; /* `tc`: collisions within this time after another are elastic */
	double shrinking;    /* `shrink`: how much farther contacts are looked for, in units of the largest diameter */
	double search_step;  /* `search`: first step back, in roundoffs of the contact distance */
	double clock;   /* time at which everything begins, 0 or more: in the absolute form a late one costs precision */
	unsigned grain; /* significant bits of the places' size, so that it is exact in every arithmetic that is to run
					   this same scene; 0: as many as the engine's own arithmetic takes */
};

/* ------------------------------------------------------------------ engines */

struct touchstone_engine; /* made, run and destroyed by one thread at a time */

enum touchstone_kind {
	TOUCHSTONE_CONTACT,  /* two particles collide: hard bodies, or the cores of a potential */
	TOUCHSTONE_WALL,     /* a particle collides with a wall */
	TOUCHSTONE_CAPTURE,  /* two particles pass a step of their potential on their way in */
	TOUCHSTONE_RELEASE,  /* the same on their way out */
	TOUCHSTONE_BOUNCE,   /* two particles turn back at a step, from either side: too slow to climb it */
	TOUCHSTONE_CROSSING, /* a particle passes a virtual wall: told and counted apart, for nothing happens to it */
};

enum touchstone_verdict {
	TOUCHSTONE_DONE,      /* a limit was reached, or no event is left */
	TOUCHSTONE_COLLAPSED, /* events go on but time does not */
	TOUCHSTONE_HALTED,    /* the method has no answer for the state it is in */
	TOUCHSTONE_DIVERGED,  /* a coordinate is no longer finite */
};

/* A physical event, as an observer sees it: after the flight to contact, before the impulse. */
struct touchstone_event {
	enum touchstone_kind kind;
	uint32_t first;  /* particle, numbered as in the scene; of two, the smaller number */
	uint32_t second; /* particle, or wall, or virtual wall */
	double time;     /* since the start, rounded to double */
	double approach; /* speed with which the distance shrinks; negative where it grows */
	double impulse;  /* magnitude of the momentum handed over */
	double distance; /* centre to centre, or centre to wall, in the working arithmetic, rounded to double */
	int64_t steps;   /* how many representable numbers of the working arithmetic that distance lies above the
						distance of the event (contact, or the step); negative when below */
	int before;      /* tracked state until now: of a pair as touchstone_pair_state() has it, of a particle that passes
						a virtual wall as touchstone_side() does; 0 otherwise */
	int after;       /* the same from now on */
	double energy;   /* what the pair gains in potential energy */
};

/* Called for each physical event, which must not outlive the call. */
struct touchstone_observer {
	void (*event)(void *context, struct touchstone_engine *engine, const struct touchstone_event *event);
	void *context;
};

/* A pair that has a potential with steps and is tested because one of the two has just had an event. */
struct touchstone_test {
	uint32_t first, second; /* numbered as in the scene; first is the smaller */
	int state;              /* tracked, or as a method that reads states from positions has just read it */
	int within, step;       /* how many steps it is within, in the working arithmetic; and outside of the nearest one */
	double excess; /* |r|^2 / d^2 - 1 at that step's distance d, in the working arithmetic, rounded to double */
};

/* Who is told of such pairs, and of which. */
struct touchstone_listener {
	void (*tested)(void *context, struct touchstone_engine *engine, const struct touchstone_test *test);
	void *context;
	double reach; /* pairs count in a state other than 0, or no farther apart than so many times their outermost step */
	double margin;  /* told of is who has an excess no larger than this, at any step, or is elsewhere than its state
					   says, `within` against `state`; INFINITY: all that count */
	uint64_t tests; /* that counted so far, told or not */
};

struct touchstone_limits {
	uint64_t events;          /* physical events to execute at most, in this call */
	double time;              /* no event later than this is executed; INFINITY for no limit */
	const volatile int *stop; /* non-zero: return soon, wherever the run is; may be NULL */
};

/* What a run has come to. */
struct touchstone_status {
	enum touchstone_verdict verdict;
	char reason[160];    /* one sentence when the verdict is not DONE, with the particles and the time */
	uint32_t count;      /* particles */
	int bits;            /* significand bits of the arithmetic */
	uint64_t events;     /* physical events executed so far */
	uint64_t collisions; /* those in which two particles collide */
	uint64_t captures, releases, bounces; /* those at a step of a potential */
	uint64_t crossings;                   /* of virtual walls: no physical events, and not in the digest */
	uint64_t captured;                    /* pairs that are within a step now */
	double potential_energy;              /* of all of them */
	double kicked_energy;                 /* what the kicks of convection brought in so far */
	double thermostat_energy;             /* what thermal walls brought in */
	uint64_t lookups;                     /* bookkeeping: cells crossed, and searches repeated or put off */
	double time;                          /* of the last event (or the limit that was reached) */
	uint64_t digest;                      /* of kind, particles and exact time of every physical event so far */
	size_t memory;                        /* bytes the engine holds */
	size_t state_memory;                  /* those of them that hold tracked states: of pairs, and at virtual walls */
	uint32_t particles[2];                /* those a verdict other than DONE is about */
};

/* Doubles that suffice to write any number of any arithmetic as an exact sum. */
enum { TOUCHSTONE_MOST_TERMS = 24 };

/* Makes an engine for a scene, in the arithmetic and by the method named. Returns NULL and fills `error` (one line)
 * when it cannot: unknown names, precision out of range, too little memory, a scene that contradicts itself. */
struct touchstone_engine *touchstone_create(const struct touchstone_scene *scene, const char *arithmetic,
											const char *method, char error[160]);
void touchstone_destroy(struct touchstone_engine *engine);

/* What the names may be, for people: NULL after the last. */
const char *touchstone_arithmetic_name(size_t number);
const char *touchstone_method_name(size_t number); /* those an engine can run by */

/* Runs until a limit is reached or a verdict other than DONE ends the run. `observer` may be NULL and then costs
 * nothing. May be called again to go on. */
enum touchstone_verdict touchstone_run(struct touchstone_engine *engine, const struct touchstone_limits *limits,
									   const struct touchstone_observer *observer);
void touchstone_status(const struct touchstone_engine *engine, struct touchstone_status *status);

/* Forgets what has been counted, so that measuring starts here; the particles go on as they are. The digest starts
 * anew as well. */
void touchstone_recount(struct touchstone_engine *engine);

/* Elastic collisions from here on (true), or the scene's own law again (false). For equilibration. */
void touchstone_elastic(struct touchstone_engine *engine, bool elastic);

/* Another unit of time: from here on all speeds are 2^exponent times what they were, and all times, that of the last
 * event too, 2^-exponent times. To hard bodies this makes no difference (they have no energy of their own), and only
 * exponents change: no number is rounded, unless one leaves the range of the arithmetic. So a gas that cools can be
 * kept as warm as it began. In the absolute form all that follows is the same, event by event. In the relative form
 * pages keep their length, to which a cooled gas had grown slow, so that times are rounded again as they were at the
 * start. False, changing nothing, where something has a scale of its own (gravity, steps, viscoelastic restitution),
 * for methods that go back, in the relative form, and for more than 64 either way. Not to be called by an observer. */
bool touchstone_rescale(struct touchstone_engine *engine, int exponent);

/* Position and velocity of one particle at the time of the last event, rounded to double; positions within the box
 * along periodic axes. */
void touchstone_state(const struct touchstone_engine *engine, uint32_t particle, double position[3],
					  double velocity[3]);

/* The temperature a particle carries, rounded to double; NaN in a scene without convection. */
double touchstone_temperature(const struct touchstone_engine *engine, uint32_t particle);

/* From here on `listener` is told of pairs (and images) that the search after an event tests. It stays the caller's,
 * who keeps it while it is told. NULL: nobody is told, at no cost. */
void touchstone_observe_tests(struct touchstone_engine *engine, struct touchstone_listener *listener);

/* During an observer's call: the exact relative position, first minus second particle, of the pair whose event or test
 * it is. terms[axis] receives doubles whose exact sum is the component, and returned is how many; contact receives the
 * distance of the event (contact, or the step; of a test the nearest step) in the same way, filled with zeros. */
int touchstone_separation(const struct touchstone_engine *engine, double terms[3][3 * TOUCHSTONE_MOST_TERMS],
						  double contact[TOUCHSTONE_MOST_TERMS]);

/* A particle that overlaps another: both are hard bodies to each other, or have cores. */
struct touchstone_overlap {
	uint32_t partner;
	double depth; /* how much nearer their centres are than contact, rounded to double: > 0 */
};

/* Lists up to `room` particles that overlap this one at the time of the last event (during an observer's call: of the
 * event it is told of), in no order; returns how many there are. Positions are those which an event at that time would
 * leave in the working arithmetic, and whether they overlap is decided exactly. Looks at neighbouring cells only. */
size_t touchstone_overlaps(const struct touchstone_engine *engine, uint32_t particle, struct touchstone_overlap *list,
						   size_t room);

/* The tracked state of a pair: how many steps of its potential it is within. 0, the commonest, is not stored. It was
 * read from the positions once, when the engine was made (a pair exactly at a step is outside it), and is changed by
 * the pair's own events only, whatever the positions say (2016 paper, section 2). */
int touchstone_pair_state(const struct touchstone_engine *engine, uint32_t first, uint32_t second);

/* A particle's partner in a state other than 0. */
struct touchstone_captured {
	uint32_t partner;
	int image[3]; /* boxes by which the partner's image that is meant lies off, as the engine now counts positions */
	int state;
};

/* Lists up to `room` of them, in no order; returns how many there are. */
size_t touchstone_captured(const struct touchstone_engine *engine, uint32_t particle, struct touchstone_captured *list,
						   size_t room);

/* The tracked side of a virtual wall on which a particle is: 0 in front of it (or exactly on it, when the engine was
 * made), -1 behind it. Along a periodic axis: the number of the image of the wall that it is in front of and next to.
 */
int touchstone_side(const struct touchstone_engine *engine, uint32_t particle, size_t wall);

/* What has passed a virtual wall since counting began, with its normal [0] and against it [1]. */
struct touchstone_flux {
	uint64_t count;
	double mass, momentum[3], energy; /* kinetic; sums of numbers rounded to double */
};
void touchstone_flux(const struct touchstone_engine *engine, size_t wall, struct touchstone_flux flux[2]);

/* How the engine went about the scene, for people: one line a fact. `line` is called for each. */
void touchstone_explain(const struct touchstone_engine *engine, void (*line)(void *context, const char *text),
						void *context);

/* ------------------------------------------------------------------ the whole state */

/* Rises whenever a state is kept in another way, or goes on differently. */
enum { TOUCHSTONE_STATE_VERSION = 1, TOUCHSTONE_MOST_FIELDS = 64 };

enum touchstone_content {
	TOUCHSTONE_NUMBERS,  /* of the engine's arithmetic, exactly: `words` of uint64_t each */
	TOUCHSTONE_DOUBLES,  /* double */
	TOUCHSTONE_COUNTS,   /* uint64_t */
	TOUCHSTONE_INTEGERS, /* int32_t */
	TOUCHSTONE_BYTES,    /* char */
};

/* One part of a state, such as the positions: a table, row by row. Where rows are particles they stand as in the
 * scene. */
struct touchstone_field {
	char name[24];
	enum touchstone_content content;
	size_t rows, columns;
	void *data; /* from malloc */
};

/* All that decides how a run goes on, and what it has counted: what each particle's last event left, tracked states,
 * clocks, counters, digest. Where to look next is no part of it (design, section 2), nor is anything random, for no
 * engine draws.
 *
 * The words of a number are the bytes of its IEEE 754 encoding, lowest first, filled with zeros (binary32, binary64,
 * binary128, extended; of short those of the double); the two doubles of a twin; of mpfr its exponent, its kind (1 an
 * infinity, 2 a zero, 3 a regular number, 0 none; negative for a negative one) and its limbs, lowest first. */
struct touchstone_snapshot {
	int words;    /* per number */
	bool doubles; /* each word is a double, and the number their sum */
	size_t count;
	struct touchstone_field field[TOUCHSTONE_MOST_FIELDS];
};

/* Copies an engine's state; end with touchstone_snapshot_free. False, and nothing to free, when out of memory. */
bool touchstone_save(const struct touchstone_engine *engine, struct touchstone_snapshot *snapshot);
void touchstone_snapshot_free(struct touchstone_snapshot *snapshot);
size_t touchstone_field_bytes(const struct touchstone_snapshot *snapshot, const struct touchstone_field *field);

/* Makes an engine as touchstone_create() does, but in a state that was saved: its events, counters and digest go on as
 * those of the engine it was saved from would have, bit for bit. Scene, arithmetic and method must be the same; search
 * and size of cells may be others. NULL, with one line in `error`, also when the state is none of this scene. The
 * snapshot stays the caller's. */
struct touchstone_engine *touchstone_restore(const struct touchstone_scene *scene, const char *arithmetic,
											 const char *method, const struct touchstone_snapshot *snapshot,
											 char error[160]);

/* ------------------------------------------------------------------ a ball over a plate */

/* One ball of diameter 1, dropped at rest from plate + 1 onto a plate (2014 paper, section 5 and fig. 7): no cells, no
 * agenda, nothing but the finder and the flight. */
struct touchstone_drop {
	double plate[TOUCHSTONE_MOST_TERMS]; /* position of the plate, as a sum of doubles: rounded to the arithmetic */
	double gravity;                      /* < 0 */
	double restitution;                  /* 0 to 1 */
	unsigned order; /* order of evaluation: what `naive` comes to depends on it. Below touchstone_drop_orders */
	uint64_t most;  /* events after which to give up */
};

struct touchstone_landing {
	enum touchstone_verdict verdict; /* COLLAPSED: came to rest; HALTED: no answer; DONE: `most` events executed */
	uint64_t events;
	double plate[TOUCHSTONE_MOST_TERMS]; /* as the arithmetic holds it, an exact sum of doubles */
	double start[TOUCHSTONE_MOST_TERMS]; /* where the ball began: plate + 1, rounded */
	double time[TOUCHSTONE_MOST_TERMS];  /* of the last event */
	double gap;                          /* between ball and plate when it ended; negative: overlap */
};

enum { TOUCHSTONE_DROP_ORDERS = 6 };

/* Words for an order of evaluation: how the gap and how the flight are written. */
const char *touchstone_drop_order(unsigned order);

/* Drops `count` balls. `observer`, if not NULL, is told each bounce: time, gap and speed after it. False, with one
 * line in `error`, for an unknown arithmetic or method. */
typedef void touchstone_bounce(void *context, double time, double gap, double speed);
bool touchstone_drop(const char *arithmetic, const char *method, const struct touchstone_drop *drop, size_t count,
					 struct touchstone_landing *landing, touchstone_bounce *bounce, void *context, char error[160]);

/* ------------------------------------------------------------------ finders */

/* What two bodies may be to each other. The numbers of a question stand in the order in which queries are written. */
enum touchstone_shape {
	TOUCHSTONE_BALL_BALL,  /* two balls meet: r[3], v[3], contact distance */
	TOUCHSTONE_BALL_LEAVE, /* two balls part to a distance: r[3], v[3], contact distance */
	TOUCHSTONE_BALL_PLANE, /* a ball meets a plane: distance, speed, acceleration along its normal, contact distance */
	TOUCHSTONE_HALF_SPACE, /* a point passes a plane: distance, speed */
};
enum { TOUCHSTONE_SHAPES = 4, TOUCHSTONE_MOST_NUMBERS = 7 };

/* Asks the finder of a method `count` questions of one shape, in the arithmetic named, into which the numbers are
 * rounded first. times[k] is the answer rounded to double: the wait until the event, or INFINITY when none is found.
 * `chained` makes each question wait for the answer before it, so that a clock around the call sees the latency;
 * otherwise questions may be worked on together. False, with one line in `error`, for an unknown arithmetic or method
 * or when the method has no finder for the shape. */
bool touchstone_find(const char *arithmetic, const char *method, enum touchstone_shape shape,
					 const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, bool chained, double *times,
					 char error[160]);

/* The same answers, one question after the other and unrounded: times[k] receives doubles whose exact sum is the wait,
 * the nearest double to it first, filled with zeros. */
bool touchstone_find_terms(const char *arithmetic, const char *method, enum touchstone_shape shape,
						   const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count,
						   double (*times)[TOUCHSTONE_MOST_TERMS], char error[160]);

/* What a finder of balls or plane forms on its way to an answer, rounded to double: f(t) = a t^2 + 2 b t + c for balls,
 * a t^2 / 2 + b t + c for a plane; NaN for what it does not form. */
struct touchstone_steps {
	double a, b, c, discriminant, time;
};
bool touchstone_find_steps(const char *arithmetic, const char *method, enum touchstone_shape shape,
						   const double numbers[TOUCHSTONE_MOST_NUMBERS], struct touchstone_steps *steps,
						   char error[160]);

/* The methods that have finders, for people: NULL after the last. The first of them are those of
 * touchstone_method_name(), by which an engine can run as well. */
const char *touchstone_finder_name(size_t number);

/* What the file of a method claims of the times that touchstone_find() returns, so that it can be held to it. All is
 * about questions whose numbers the arithmetic holds exactly, each zero or of a magnitude from `least` to `most`. */
struct touchstone_claim {
	double least, most;
	int discriminant_bits; /* error, misses and phantoms: only where |b^2 - a c| > 2^-discriminant_bits b^2 (for planes
							  b^2 - 2 a c; f as in touchstone_steps); 0: everywhere */
	double most_ulp; /* error of a time that is found and exists, in units in the last place of the exact time: of the
						arithmetic, or of a double where that is coarser; INFINITY: nothing is claimed */
	bool never_misses, never_phantom; /* finds an event if and only if there is one */
	bool never_negative, never_nan;
};

/* False, with one line in `error`, as touchstone_find() would be, or when the method claims nothing. */
bool touchstone_finder_claim(const char *arithmetic, const char *method, enum touchstone_shape shape,
							 struct touchstone_claim *claim, char error[160]);

/* How many of these questions `rounded` in binary64 leaves to its exact path. */
size_t touchstone_exact_count(enum touchstone_shape shape, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
							  size_t count);

/* ------------------------------------------------------------------ finders written by others */

/* A plug-in is a shared object that exports one or more of these; nothing here defines them. Each returns the time
 * until the event by the stable rule, or infinity when there is none. Arguments are finite; r and v are relative
 * position and velocity. A plug-in is asked in a process of its own, one question at a time. */
typedef double touchstone_ball_ball_finder(const double r[3], const double v[3], double contact_distance);
typedef double touchstone_ball_leave_finder(const double r[3], const double v[3], double contact_distance);
typedef double touchstone_ball_plane_finder(double distance, double speed, double acceleration,
											double contact_distance);
touchstone_ball_ball_finder touchstone_ball_ball;
touchstone_ball_leave_finder touchstone_ball_leave;
touchstone_ball_plane_finder touchstone_ball_plane;

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif

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
	struct touchstone_restitution restitution; /* between particles */
	enum touchstone_form form;
	enum touchstone_search search;
	double cell;    /* side of a search cell; 0: chosen. Never changes a result */
	double clock;   /* time at which everything begins, 0 or more: in the absolute form a late one costs precision */
	unsigned grain; /* significant bits of the places' size, so that it is exact in every arithmetic that is to run
					   this same scene; 0: as many as the engine's own arithmetic takes */
};

/* ------------------------------------------------------------------ engines */

struct touchstone_engine; /* made, run and destroyed by one thread at a time */

enum touchstone_kind {
	TOUCHSTONE_CONTACT, /* two particles collide */
	TOUCHSTONE_WALL,    /* a particle collides with a wall */
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
	uint32_t second; /* particle, or wall */
	double time;     /* since the start, rounded to double */
	double approach; /* speed with which the distance shrinks */
	double impulse;  /* magnitude of the momentum handed over */
	double distance; /* centre to centre, or centre to wall, in the working arithmetic, rounded to double */
	int64_t steps;   /* how many representable numbers of the working arithmetic that distance lies above the
						contact distance; negative when below */
};

/* Called for each physical event, which must not outlive the call. */
struct touchstone_observer {
	void (*event)(void *context, struct touchstone_engine *engine, const struct touchstone_event *event);
	void *context;
};

struct touchstone_limits {
	uint64_t events;          /* physical events to execute at most, in this call */
	double time;              /* no event later than this is executed; INFINITY for no limit */
	const volatile int *stop; /* non-zero: return soon, wherever the run is; may be NULL */
};

/* What a run has come to. */
struct touchstone_status {
	enum touchstone_verdict verdict;
	char reason[160];      /* one sentence when the verdict is not DONE, with the particles and the time */
	uint32_t count;        /* particles */
	int bits;              /* significand bits of the arithmetic */
	uint64_t events;       /* physical events executed so far */
	uint64_t collisions;   /* those between two particles */
	uint64_t lookups;      /* bookkeeping: cells crossed and searches repeated */
	double time;           /* of the last event (or the limit that was reached) */
	uint64_t digest;       /* of kind, particles and exact time of every physical event so far */
	size_t memory;         /* bytes the engine holds */
	uint32_t particles[2]; /* those a verdict other than DONE is about */
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

/* Position and velocity of one particle at the time of the last event, rounded to double; positions within the box
 * along periodic axes. */
void touchstone_state(const struct touchstone_engine *engine, uint32_t particle, double position[3],
					  double velocity[3]);

/* During an observer's call: the exact relative position, first minus second particle, of the pair that is in
 * contact. terms[axis] receives doubles whose exact sum is the component, and returned is how many; contact
 * receives the contact distance in the same way, filled with zeros. */
int touchstone_separation(const struct touchstone_engine *engine, double terms[3][3 * TOUCHSTONE_MOST_TERMS],
						  double contact[TOUCHSTONE_MOST_TERMS]);

/* How the engine went about the scene, for people: one line a fact. `line` is called for each. */
void touchstone_explain(const struct touchstone_engine *engine, void (*line)(void *context, const char *text),
						void *context);

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

#ifdef __cplusplus
}
#endif

#endif

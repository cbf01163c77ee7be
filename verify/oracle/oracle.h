/* The exact oracle: when does an event happen, for any finite input, exactly or not at all. No tolerance anywhere.
 *
 * A query is a shape and its numbers, taken as the exact binary fractions that they are. Its answer by the stable rule
 *
 *     an event occurs after the smallest non-negative t with f(t) <= 0 and f'(t) < 0
 *
 * (2014 paper, eq. 10; 2016 paper, eq. 3) is never, now (t = 0), or later: a positive quadratic surd
 * 2^e (p +- sqrt(d)) / s over the integers. Where the rule's set is open, t is its infimum. Every question below is
 * decided on that surd by integer arithmetic (GMP). A filter in twice double precision, with a proven bound (see
 * filter.c), answers the easy questions first and always the same.
 *
 * Lengths, times and speeds are in the units of the query. Only finite numbers may be asked about. */
#ifndef VERIFY_ORACLE_H
#define VERIFY_ORACLE_H

#include <mpfr.h>
#include <stdbool.h>
#include <stdint.h>

enum oracle_shape {
	/* Two balls meet: f(t) = |r + v t|^2 - contact^2 = a t^2 + 2 b t + c (2014 paper, Algorithm 1; 2016 paper,
	 * Algorithm 1). Only the magnitude of `contact` counts.
	 *
	 *     b        c       b^2 - ac    time
	 *     >= 0     any     any         never: at rest or receding, overlapped or not
	 *     < 0      <= 0    (> 0)       now: touching or overlapped, and approaching
	 *     < 0      > 0     <= 0        never: a miss, or a glancing touch
	 *     < 0      > 0     > 0         the earlier root, c / (-b + sqrt(b^2 - ac)) */
	ORACLE_BALL_BALL,

	/* Two balls part, as when a pair leaves its well: f(t) = contact^2 - |r + v t|^2, a, b, c as above (2016 paper,
	 * Algorithm 2, whose two last lines are exchanged: each is the form that cancels, but exactly they are equal).
	 *
	 *     a      b        c       b^2 - ac    time
	 *     0      (0)      any     (0)         never: at rest
	 *     > 0    >= 0     >= 0    any         now: outside or touching, and receding or at the closest approach
	 *     > 0    < 0      (>= 0)  <= 0        -b / a: never inside; the infimum is the closest approach
	 *     > 0    otherwise                    the later root, (-b + sqrt(b^2 - ac)) / a */
	ORACLE_BALL_LEAVE,

	/* A ball meets a plane: f(t) = h + speed t + acceleration t^2 / 2 with h = distance - contact (2014 paper,
	 * Algorithm 2). Components are along the normal that points to the side the ball belongs to: the caller has turned
	 * it (the algorithm's first line), so a negative distance is an overlap. `contact` is the distance at which they
	 * touch, the ball's radius. With D = speed^2 - 2 acceleration h:
	 *
	 *     acceleration    speed    h       D       time
	 *     = 0             >= 0     any             never
	 *     = 0             < 0      <= 0            now
	 *     = 0             < 0      > 0             h / -speed
	 *     > 0             >= 0     any     any     never (for speed 0 the paper's algorithm returns a time <= 0)
	 *     > 0             < 0      <= 0    (> 0)   now
	 *     > 0             < 0      > 0     <= 0    never (for D = 0, a touch, the paper's algorithm returns the touch)
	 *     > 0             < 0      > 0     > 0     the earlier root, 2 h / (-speed + sqrt(D))
	 *     < 0             <= 0     <= 0    any     now: pressed on the plate, at the peak or past it
	 *     < 0             > 0      (<= 0)  <= 0    the peak, -speed / acceleration: overlapped and never free of it
	 *     < 0             otherwise                the later root, (speed + sqrt(D)) / -acceleration */
	ORACLE_BALL_PLANE,

	/* A point leaves its half-space: f(t) = distance + speed t (2016 paper, eq. 4), the normal pointing into the half
	 * that it belongs to. Uses `distance` and `speed` of the plane's numbers.
	 *
	 *     speed    distance    time
	 *     >= 0     any         never
	 *     < 0      <= 0        now
	 *     < 0      > 0         distance / -speed */
	ORACLE_HALF_SPACE,
};

struct oracle_query {
	enum oracle_shape shape;
	union {
		struct {
			double r[3], v[3]; /* relative position and velocity */
			double contact;    /* distance between the centres */
		} ball;
		struct {
			double distance, speed, acceleration, contact;
		} plane;
		double number[7]; /* either, in the order in which queries are written */
	};
};

enum oracle_event {
	ORACLE_NEVER,
	ORACLE_NOW,   /* t = 0 */
	ORACLE_LATER, /* t > 0, though its nearest double may be zero or infinity */
};

/* A real number known to lie within `bound` of high + low; nothing is known of it when the bound is infinite. */
struct oracle_estimate {
	double high, low, bound;
};

/* The exact answer, a plain value that owns nothing: the query stands for the surd, which is made when it is needed. */
struct oracle_time {
	enum oracle_event event;
	struct oracle_query query;
	struct oracle_estimate estimate; /* of a time later; the oracle's own */
};

/* The working space: integers that grow to the largest query seen, so that no memory is allocated from then on.
 * Created and destroyed by the caller; used by one thread at a time. GMP aborts when out of memory. MPFR's exponent
 * range must be as wide as it is by default. */
struct oracle;
struct oracle *oracle_create(void); /* NULL when out of memory */
void oracle_destroy(struct oracle *oracle);

/* From here on every question goes through the integers (true), or only those that the filter leaves (false). */
void oracle_force_exact(struct oracle *oracle, bool force);

/* How many times an answer was made in the integers so far. */
uint64_t oracle_exact_count(const struct oracle *oracle);

/* Whether every number of the query is finite: the condition for all that follows. */
bool oracle_accepts(const struct oracle_query *query);

/* Whether and when. */
struct oracle_time oracle_solve(struct oracle *oracle, const struct oracle_query *query);

/* The signs, -1, 0 or 1, of the coefficients and of the discriminant on which the tables above turn: of a, b, c and
 * b^2 - a c for balls; of acceleration, speed, h and D for a plane, of 0, speed, distance and speed^2 for a half-space.
 */
enum { ORACLE_SIGNS = 4 };
void oracle_signs(struct oracle *oracle, const struct oracle_query *query, int signs[ORACLE_SIGNS]);

/* The time as a double, correctly rounded to nearest-even, up, down or toward zero (MPFR_RNDN, RNDU, RNDD, RNDZ),
 * gradual underflow included. Beyond the largest double: infinity or DBL_MAX by the direction. Never: infinity. */
double oracle_round(struct oracle *oracle, const struct oracle_time *time, mpfr_rnd_t direction);

/* The time correctly rounded to the precision of `result`; returns the ternary value as MPFR does. Never: infinity. */
int oracle_round_mpfr(struct oracle *oracle, mpfr_t result, const struct oracle_time *time, mpfr_rnd_t direction);

/* The exact order of two times, of any pairs and shapes: -1, 0 or 1. Never comes after everything, and ties with
 * never. */
int oracle_compare(struct oracle *oracle, const struct oracle_time *first, const struct oracle_time *second);

/* The exact order of a time and a double, which may be infinite but not a NaN: -1, 0 or 1. Never ties with infinity. */
int oracle_compare_double(struct oracle *oracle, const struct oracle_time *time, double value);

/* How far a finder's answer is from the time: |got - t| / ulp(t), with ulp(t) = 2^(floor(log2 t) - 52) and at least
 * 2^-1074, to a relative 1e-9 where it is a normal double (infinity or zero beyond). No error for infinity where that
 * is correct: never, or a time whose nearest double it is. Else infinity where just one of the two is infinite (a
 * phantom or a missed event, to be counted as such), and NaN for a NaN. */
double oracle_error(struct oracle *oracle, const struct oracle_time *time, double got);

/* |b^2 - a c| / b^2, how far a query is from a graze (for planes with c = 2 h; 1 for a half-space), from exact
 * integers, to a relative 1e-12. Infinite for b = 0. */
double oracle_graze(struct oracle *oracle, const struct oracle_query *query);

/* The distance left at a time t: |r + v t| - |contact| for balls, f(t) for planes, from exact integers, to a relative
 * 1e-12 where it is a normal double. NaN when t is not finite. */
double oracle_gap(struct oracle *oracle, const struct oracle_query *query, double t);

#endif

/* The methods of this arithmetic. An engine can run by those that have an answer for balls and for planes; the solvers
 * of the literature have none for planes. */

/* What the sieve (engine/sieve.h) may leave out under a method, without changing what the method finds. */
enum sieving {
	SIEVE_NOTHING,
	SIEVE_MISSES, /* pairs that surely do not meet; the times it finds may be far off, or it may find none */
	SIEVE_ORDER,  /* and those that surely meet later than another pair */
};

/* What the engine does under a method besides asking its finder (engine/policy.inl). */
enum policy {
	POLICY_BACKWARDS = 1 << 0,     /* an event before now is executed: the run goes back */
	POLICY_SEARCH = 1 << 1,        /* an event that finds its bodies overlapped is moved back to where they do not */
	POLICY_EARLY = 1 << 2,         /* contacts are looked for at a slightly larger distance */
	POLICY_BRIEF_ELASTIC = 1 << 3, /* soon after a collision no energy is lost */
	POLICY_POSITIONAL = 1 << 8,    /* pair states are read from separations: method/positional.inl */
	POLICY_STRETCH = 1 << 9,       /* method/stretch.inl */
	POLICY_NUDGE = 1 << 10,        /* method/nudge.inl */
	POLICY_LAST_EVENT = 1 << 11,   /* method/last_event.inl */
};

/* How many times the roundoff the methods correct by that do so: no source says how much. With 64, in a gas so dilute
 * that particles fly 20 diameters between events, `stretch` failed at one event in 50. */
static const double correction = 1024;

struct method {
	const char *name;
	enum sieving sieve;
	ball_finder *ball_ball, *ball_leave;
	plane_finder *ball_plane;
	half_space_finder *half_space;
	claim_maker *claim; /* what the method's file claims; NULL: nothing */
	unsigned policy;    /* of enum policy */
};

enum {
	STABLE,
	NAIVE,
	GUARDED,
	COMPENSATED,
#ifndef TOUCHSTONE_WITHOUT_MPFR
	ROUNDED,
#endif
	REWIND,
	SKIP,
	SEARCH,
	SHRINK,
	TC,
	NUMERICAL_RECIPES,
	KAHAN,
	STERBENZ,
	TEXTBOOK_EPSILON,
	POSITIONAL,
	STRETCH,
	NUDGE,
	LAST_EVENT,
	METHODS,
};

static const struct method methods[METHODS] = {
	[STABLE] = {"stable", SIEVE_ORDER, stable_ball_ball, stable_ball_leave, stable_ball_plane, stable_half_space,
				stable_claim, 0},
	[NAIVE] = {"naive", SIEVE_MISSES, naive_ball_ball, naive_ball_leave, naive_ball_plane, naive_half_space, NULL, 0},
	[GUARDED] = {"guarded", SIEVE_MISSES, guarded_ball_ball, guarded_ball_leave, guarded_ball_plane, guarded_half_space,
				 guarded_claim, 0},
	[COMPENSATED] = {"compensated", SIEVE_ORDER, compensated_ball_ball, compensated_ball_leave, compensated_ball_plane,
					 stable_half_space, compensated_claim, 0},
#ifndef TOUCHSTONE_WITHOUT_MPFR
	[ROUNDED] = {"rounded", SIEVE_ORDER, rounded_ball_ball, rounded_ball_leave, rounded_ball_plane, rounded_half_space,
				 rounded_claim, 0},
#endif
	[REWIND] = {.name = "rewind",
				.sieve = SIEVE_MISSES,
				.ball_ball = naive_ball_ball,
				.ball_plane = naive_ball_plane,
				.policy = POLICY_BACKWARDS},
	[SKIP] = {.name = "skip", .sieve = SIEVE_MISSES, .ball_ball = skip_ball_ball, .ball_plane = skip_ball_plane},
	[SEARCH] = {.name = "search",
				.sieve = SIEVE_MISSES,
				.ball_ball = naive_ball_ball,
				.ball_plane = naive_ball_plane,
				.policy = POLICY_SEARCH},
	[SHRINK] = {.name = "shrink",
				.ball_ball = shrink_ball_ball,
				.ball_plane = shrink_ball_plane,
				.policy = POLICY_EARLY},
	[TC] = {.name = "tc",
			.sieve = SIEVE_ORDER,
			.ball_ball = stable_ball_ball,
			.ball_plane = stable_ball_plane,
			.policy = POLICY_BRIEF_ELASTIC},
	[NUMERICAL_RECIPES] = {.name = "numerical-recipes",
						   .ball_ball = numerical_recipes_ball_ball,
						   .ball_leave = numerical_recipes_ball_leave},
	[KAHAN] = {.name = "kahan", .ball_ball = kahan_ball_ball, .ball_leave = kahan_ball_leave},
	[STERBENZ] = {.name = "sterbenz", .ball_ball = sterbenz_ball_ball, .ball_leave = sterbenz_ball_leave},
	[TEXTBOOK_EPSILON] = {.name = "textbook-epsilon", .ball_ball = textbook_epsilon_ball_ball},
	[POSITIONAL] = {"positional", SIEVE_ORDER, stable_ball_ball, stable_ball_leave, stable_ball_plane,
					stable_half_space, NULL, POLICY_POSITIONAL},
	[STRETCH] = {"stretch", SIEVE_MISSES, stable_ball_ball, stable_ball_leave, stable_ball_plane, stable_half_space,
				 NULL, POLICY_POSITIONAL | POLICY_STRETCH},
	[NUDGE] = {"nudge", SIEVE_ORDER, stable_ball_ball, stable_ball_leave, stable_ball_plane, stable_half_space, NULL,
			   POLICY_POSITIONAL | POLICY_NUDGE},
	[LAST_EVENT] = {"last-event", SIEVE_MISSES, stable_ball_ball, stable_ball_leave, stable_ball_plane,
					stable_half_space, NULL, POLICY_POSITIONAL | POLICY_LAST_EVENT},
};

static const struct method *find_method(const char *name, char error[160])
{
	for (int m = 0; m < METHODS; m++)
		if (strcmp(methods[m].name, name) == 0) return &methods[m];
	snprintf(error, 160, "no method '%.20s'; known are", name);
	for (int m = 0; m < METHODS; m++) {
		size_t used = strlen(error), room = 160 - used;
		if (strlen(methods[m].name) + sizeof " and more" + 1 > room) {
			snprintf(error + used, room, " and more");
			break;
		}
		snprintf(error + used, room, "%s %s", m ? "," : "", methods[m].name);
	}
	return NULL;
}

/* What the engine remembers. A particle's state is what its last event left: where it was, how it moves, and when.
 * It is touched by events only; everything else here says where to look next. */

/* The last event of a particle. In binary64 a body fills one cache line, which is all that a pair test reads. */
struct body {
	num position[3]; /* from the middle of its place */
	num velocity[3];
	num time;    /* since the page began */
	double page; /* when that page began: a multiple of the page's length */
};

/* Which place of the box a body's position is counted from, in the periodic image the particle is in now. Places are
 * numbered from the middle of the box; their size is exact, so that a difference of places is exact. */
struct place {
	int32_t index[3];
	uint32_t species;
};

enum { MEETS_NOTHING = 255 };

/* Whether what is met is a particle. */
static inline bool with_particle(uint8_t meets)
{
	return meets != TOUCHSTONE_WALL && meets != TOUCHSTONE_CROSSING;
}

/* What is next for a particle, otherwise 1 + 2 axis + (side > 0): a cell is left that way. LEAVES_ANCHOR: from its
 * anchor. LOOKS_AGAIN: since its plan has come to nothing. */
enum { NEXT_IS_PHYSICAL = 0, LEAVES_ANCHOR = 7, LOOKS_AGAIN };

/* Where a particle is and what comes next for it, as far as it knows: one cache line in binary64. */
struct itinerary {
	_Alignas(64) num time; /* of its next physical event */
	double page;
	double leaves;            /* its cell, or looks again, if that comes first: since the page began */
	double entered;           /* its cell: since its last event */
	uint32_t partner;         /* entry of the other particle, or number of the wall */
	uint32_t partner_changes; /* of the other, when this was found: if it has had more, this is no longer true */
	uint32_t changes;         /* of this particle: its events, and its moves to another image */
	uint32_t stamp;           /* of its valid note in the agenda */
	uint32_t id;              /* the particle's number in the scene */
	uint32_t stalls;          /* events since time last moved for it */
	uint16_t cell[3];
	uint8_t meets; /* enum touchstone_kind, or MEETS_NOTHING */
	uint8_t next;
};

struct moment {
	double page;
	num time;
};

/* A possible next event of one particle. */
struct plan {
	struct moment moment;
	uint32_t partner;
	uint8_t meets; /* enum touchstone_kind, or MEETS_NOTHING */
	bool fresh;    /* found in this search */
	float open;    /* by how much later it may be: where it is deferred (engine/defer.inl) */
	double second; /* before which nothing else happens (engine/second.inl) */
};

struct touchstone_engine;

struct wall {
	num position[3]; /* from the middle of its place, like a body's */
	int32_t index[3];
	num normal[3];
	num acceleration; /* along the normal */
	num temperature;  /* NaN: it passes no heat on */
	struct touchstone_restitution restitution;
};

/* A step of a potential. The state of a pair is how many steps it is within, counted from outside. */
struct step {
	num distance;
	num climb; /* on the way in, of (r.v / |r|)^2: what it loses, 2 (energy inside - energy outside) / reduced mass */
	double energy;  /* of a pair inside it and not inside the next, as the steps in this arithmetic add up to */
	uint64_t pairs; /* in that state now */
};

/* What the particles of two species are to each other. */
struct potential {
	bool hard; /* whether they collide: */
	num core;  /* at this distance */
	struct touchstone_restitution restitution;
	uint32_t step_count;
	struct step *step; /* from outside in */
	size_t limits;     /* in the shadows' table, those of its outermost state: the others follow */
};

/* A virtual wall, which stands once in every image of the box along `axis`. */
struct virtual_wall {
	struct wall plane;
	int axis;  /* the periodic axis along which its normal lies, or -1 */
	int along; /* whether the normal points up that axis (1) or down (-1) */
	struct touchstone_flux flux[2];
};

/* The shadows of all particles, and the scale they are cast in: engine/shadow.inl. */
struct shadows {
	struct shadow *shadow; /* NULL: the sieve is not used */
	double *radius;        /* per species: two add up to the distance at which two particles first meet */
	struct limits *limits; /* of pairs in their states, by potentials; then of hard bodies, by pairs of species: */
	size_t hard_limits;    /* from here on */
	const struct sieve_machine *machine;
	struct sieve sieve;
	double base_page, base_time;            /* when the shadows' time is 0 */
	double per_length, per_time, per_speed; /* units, all powers of two */
	double now;                             /* time of the search, since the base */
	double age;                             /* of the oldest last event, at the base */
	float oldest;                           /* and now */
	double back;                            /* from now to the latest moment of the run */
};

/* Neighbour lists: engine/neighbours.inl. */
struct neighbours {
	double skin;           /* how far from a distance at which something happens a listed pair may be; 0: no lists */
	double free;           /* how far a particle may go from its anchor before its list is made anew */
	struct anchor *anchor; /* per particle: where it was when its list was made */
	struct bands bands;    /* of distances between anchors: of those that are listed */
	bands_lister *lister;
	struct pairs pairs; /* those listed, each with 1 + its state */
};

static const uint32_t nobody = UINT32_MAX; /* in place of a particle */

/* What a search will list, as far as that is known before: engine/ahead.inl. */
struct listing {
	uint32_t *entry;
	size_t count;
	uint32_t particle; /* for which; `nobody` for none */
	uint64_t changes;  /* of the cells, when it was listed */
};

struct touchstone_engine {
	const struct unit *unit; /* unit and bits come first: whoever calls does not know which unit it is */
	int bits;
	num two_units; /* in the last place of 1, at most */
	const struct method *method;

	/* the particles, in an order that keeps neighbours near each other in memory */
	uint32_t count;
	struct body *body;
	struct place *place;
	float *open;    /* per particle, or NULL: by how much its meeting may be later (engine/defer.inl) */
	double *second; /* per particle, or NULL: moment before which only its plan may happen (engine/second.inl) */
	struct itinerary *itinerary;
	uint32_t *index_of; /* of a particle's number in the scene */

	/* the scene */
	int dimensions;
	bool periodic[3];
	double box[3];
	size_t species_count, wall_count;
	num *radius, *mass; /* per species */
	struct wall *wall;
	bool accelerated;
	num acceleration[3], half_acceleration[3];
	struct touchstone_restitution restitution;
	bool elastic; /* overrides every restitution */

	/* what pairs of particles are to each other */
	size_t potential_count;
	struct potential *potential;
	uint32_t *potential_of; /* per pair of species: number of its potential; NULL: all particles are hard bodies */
	struct pairs pairs;     /* those within a step */
	uint16_t *captured;     /* per particle, a mark for the search at hand; NULL: there are no steps */
	num outermost;          /* distance at which two particles first meet, where there is one species, */
	uint8_t outermost_kind; /* and what then happens: enum touchstone_kind, or MEETS_NOTHING */

	/* heat */
	num *temperature;  /* per particle; NULL: they carry none */
	num kick, neutral; /* of convection */
	double thermostat; /* kT of thermal walls; 0: walls are not thermal */

	/* what methods keep that correct or remember: nothing under all others */
	num correction_time; /* of `stretch` and `last-event` */
	uint32_t *last_met;  /* per particle, the number of the partner of its last event; NULL but for `last-event` */
	/* what the method's policy needs (policy.inl) */
	num contact_time,
		margin;           /* of POLICY_BRIEF_ELASTIC, and of POLICY_EARLY: how much farther contacts are looked for */
	double search_part;   /* of POLICY_SEARCH: first step, as a part of the contact distance */
	struct moment latest; /* that the run has come to, where it may go back */

	/* virtual walls; side and crossed are NULL without */
	size_t virtual_wall_count;
	struct virtual_wall *virtual_wall;
	int32_t *side;          /* per particle and virtual wall: the number of the image it is in front of and next to */
	struct moment *crossed; /* per particle: when it last passed one */

	/* places and pages: how numbers are kept small */
	num place_size[3];
	double place_width[3]; /* the same; 0 on an axis that has no places */
	int32_t places[3];     /* per box, on a periodic axis */
	double page_length;    /* INFINITY: the page is never turned */
	double pages_per_time; /* its reciprocal, exactly */
	double page_turn;      /* the length, or 0 */
	bool uneven;           /* whether the page of a body's last event may begin within a page */

	/* where to look */
	enum touchstone_search search;
	double wanted_cell, largest; /* largest: diameter */
	double reach;                /* largest distance at which anything happens to a pair */
	double slack;                /* how much wider than `reach` a cell must be for rounding not to matter */
	double cell_side[3];
	double stray[3]; /* how far beyond the faces of its cell a particle goes before it leaves it */
	bool roomy;      /* whether that is far, in straight flights */
	struct cells cells;
	uint32_t *candidate[2];    /* entries that a search has listed; two searches may be under way */
	struct listing listing[2]; /* and those that the next ones will list */
	uint32_t *lists;           /* room for all of them */
	struct shadows shadows;
	struct neighbours neighbours;
	struct agenda agenda;

	/* what has happened */
	struct moment now;
	uint64_t events, kinds[TOUCHSTONE_CROSSING + 1], lookups, digest; /* kinds: events of each kind */
	double kicked_energy, thermostat_energy;
	enum touchstone_verdict verdict;
	char reason[160];
	uint32_t blamed[2];
	const struct touchstone_observer *observer;
	bool executing;                       /* whether the search at hand follows an event */
	struct touchstone_listener *listener; /* told of the pairs it tests; NULL: nobody is */
	const num *tested_offset;             /* of the pair that is being told of: first minus second; NULL: none is */
	uint32_t touching[2];                 /* the pair whose event it is while an observer is called */
	int touching_image[3];
	num touching_distance;
};

/* Questions to finders: what stands behind touchstone_find(). */

struct questions {
	enum touchstone_shape shape;
	const double (*numbers)[TOUCHSTONE_MOST_NUMBERS];
	size_t count;
	bool chained;
	double *times;
};

/* The bits of the answer before, all masked out, are mixed into the first number of a question: no compiler knows that
 * they change nothing, and no processor can begin before it has them. */
static inline double echoed(double number, uint64_t echo)
{
	uint64_t bits = bits_of(number) ^ echo;
	memcpy(&number, &bits, sizeof number);
	return number;
}

static inline struct balls read_balls(const double numbers[TOUCHSTONE_MOST_NUMBERS], uint64_t echo)
{
	struct balls balls = {.contact = from_double(numbers[6])};
	for (int axis = 0; axis < 3; axis++) {
		balls.r[axis] = from_double(axis ? numbers[axis] : echoed(numbers[0], echo));
		balls.v[axis] = from_double(numbers[3 + axis]);
	}
	return balls;
}

static inline struct flight read_flight(const double numbers[TOUCHSTONE_MOST_NUMBERS], uint64_t echo)
{
	return (struct flight){from_double(echoed(numbers[0], echo)), from_double(numbers[1]), from_double(numbers[2]),
						   from_double(numbers[3])};
}

static inline struct passage read_passage(const double numbers[TOUCHSTONE_MOST_NUMBERS], uint64_t echo)
{
	return (struct passage){from_double(echoed(numbers[0], echo)), from_double(numbers[1])};
}

/* One question of any shape. */
static inline __attribute__((always_inline)) num answer(const struct method *method, enum touchstone_shape shape,
														const double numbers[TOUCHSTONE_MOST_NUMBERS], uint64_t echo,
														struct quadratic *f)
{
	struct balls balls;
	struct flight flight;
	struct passage passage;
	switch (shape) {
	case TOUCHSTONE_BALL_BALL:
		balls = read_balls(numbers, echo);
		return method->ball_ball(&balls, f);
	case TOUCHSTONE_BALL_LEAVE:
		balls = read_balls(numbers, echo);
		return method->ball_leave(&balls, f);
	case TOUCHSTONE_BALL_PLANE:
		flight = read_flight(numbers, echo);
		return method->ball_plane(&flight, f);
	case TOUCHSTONE_HALF_SPACE:
		break;
	}
	passage = read_passage(numbers, echo);
	return method->half_space(&passage, f);
}

static inline __attribute__((always_inline)) void ask_each(const struct method *method, enum touchstone_shape shape,
														   const struct questions *questions, bool chained)
{
	volatile uint64_t unknown = 0;
	uint64_t nothing = unknown, echo = 0;
	for (size_t k = 0; k < questions->count; k++) {
		struct quadratic f;
		double time = to_double(answer(method, shape, questions->numbers[k], echo, &f));
		questions->times[k] = time;
		if (chained) echo = bits_of(time) & nothing;
	}
}

/* With everything that does not change from question to question known while compiling. */
static inline __attribute__((always_inline)) void ask(const struct method *method, const struct questions *questions)
{
	switch (questions->shape) {
	case TOUCHSTONE_BALL_BALL:
		if (questions->chained) ask_each(method, TOUCHSTONE_BALL_BALL, questions, true);
		if (!questions->chained) ask_each(method, TOUCHSTONE_BALL_BALL, questions, false);
		break;
	case TOUCHSTONE_BALL_LEAVE:
		if (questions->chained) ask_each(method, TOUCHSTONE_BALL_LEAVE, questions, true);
		if (!questions->chained) ask_each(method, TOUCHSTONE_BALL_LEAVE, questions, false);
		break;
	case TOUCHSTONE_BALL_PLANE:
		if (questions->chained) ask_each(method, TOUCHSTONE_BALL_PLANE, questions, true);
		if (!questions->chained) ask_each(method, TOUCHSTONE_BALL_PLANE, questions, false);
		break;
	case TOUCHSTONE_HALF_SPACE:
		if (questions->chained) ask_each(method, TOUCHSTONE_HALF_SPACE, questions, true);
		if (!questions->chained) ask_each(method, TOUCHSTONE_HALF_SPACE, questions, false);
		break;
	}
}

/* Questions in binary64. Each method has loops of its own, and all loops are compiled once more for machines with AVX2
 * and a multiply-add; `compensated` and `rounded` work on several pairs of balls at once. The
 * answers are the same: a multiply-add is one wherever it is computed, and what is correctly rounded has one value. */

/* All at once, then those that are left one by one. */
static inline __attribute__((always_inline)) void ask_batch(batch *at_once, const struct method *method,
															const struct questions *questions)
{
	bool balls = questions->shape == TOUCHSTONE_BALL_BALL || questions->shape == TOUCHSTONE_BALL_LEAVE;
	if (!balls || questions->chained) {
		ask(method, questions);
		return;
	}
	at_once(questions->shape == TOUCHSTONE_BALL_LEAVE, questions->numbers, questions->count, questions->times);
	for (size_t k = 0; k < questions->count; k++) {
		if (!isnan(questions->times[k])) continue;
		struct quadratic f;
		questions->times[k] = answer(method, questions->shape, questions->numbers[k], 0, &f);
	}
}

/* The method is known while compiling in each of these. */
static inline __attribute__((always_inline)) void ask_any(const struct method *method,
														  const struct questions *questions)
{
	if (method == &methods[STABLE]) ask(&methods[STABLE], questions);
	if (method == &methods[NAIVE]) ask(&methods[NAIVE], questions);
	if (method == &methods[GUARDED]) ask(&methods[GUARDED], questions);
	if (method == &methods[REWIND]) ask(&methods[REWIND], questions);
	if (method == &methods[SKIP]) ask(&methods[SKIP], questions);
	if (method == &methods[SEARCH]) ask(&methods[SEARCH], questions);
	if (method == &methods[SHRINK]) ask(&methods[SHRINK], questions);
	if (method == &methods[TC]) ask(&methods[TC], questions);
	if (method == &methods[NUMERICAL_RECIPES]) ask(&methods[NUMERICAL_RECIPES], questions);
	if (method == &methods[KAHAN]) ask(&methods[KAHAN], questions);
	if (method == &methods[STERBENZ]) ask(&methods[STERBENZ], questions);
	if (method == &methods[TEXTBOOK_EPSILON]) ask(&methods[TEXTBOOK_EPSILON], questions);
	if (method == &methods[COMPENSATED]) ask_batch(batch_compensated, &methods[COMPENSATED], questions);
	if (method == &methods[ROUNDED]) ask_batch(batch_rounded, &methods[ROUNDED], questions);
}

static void ask_anywhere(const struct method *method, const struct questions *questions)
{
	ask_any(method, questions);
}

#ifdef __x86_64__
__attribute__((target("arch=x86-64-v3"), flatten)) static void ask_with_fma(const struct method *method,
																			const struct questions *questions)
{
	ask_any(method, questions);
}
#endif

static void ask_best(const struct method *method, const struct questions *questions)
{
#ifdef __x86_64__
	if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
		ask_with_fma(method, questions);
		return;
	}
#endif
	ask_anywhere(method, questions);
}

static size_t exact_count(enum touchstone_shape shape, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count)
{
	size_t exact = 0;
	for (size_t k = 0; k < count; k++) {
		struct balls balls = read_balls(numbers[k], 0);
		struct flight flight = read_flight(numbers[k], 0);
		struct quadratic f;
		if (shape == TOUCHSTONE_BALL_PLANE)
			exact += isnan(fast_plane(&flight, &f));
		else if (shape != TOUCHSTONE_HALF_SPACE)
			exact += isnan(fast_balls(shape == TOUCHSTONE_BALL_LEAVE, &balls, &f));
	}
	return exact;
}

/* Questions in arithmetics that have no vectors: one after the other. */

static void ask_best(const struct method *method, const struct questions *questions)
{
	ask(method, questions);
}

static size_t exact_count(enum touchstone_shape shape, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count)
{
	(void)shape, (void)numbers;
	return count;
}

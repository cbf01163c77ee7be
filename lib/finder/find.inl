/* The public questions, in this arithmetic. */

static const struct method *find_finder(const char *name, enum touchstone_shape shape, char error[160])
{
	static const char *const shapes[] = {"ball-ball", "ball-leave", "ball-plane", "half-space"};
	const struct method *method = find_method(name, error);
	if (!method) return NULL;
	if (method->policy & POLICY_POSITIONAL) {
		snprintf(error, 160, "method '%s' has no finder of its own: an engine that runs by it asks those of stable",
				 name);
		return NULL;
	}
	const bool has[] = {method->ball_ball, method->ball_leave, method->ball_plane, method->half_space};
	if (has[shape]) return method;
	snprintf(error, 160, "method '%s' has no finder for %s", name, shapes[shape]);
	return NULL;
}

static bool unit_find(const char *name, enum touchstone_shape shape, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
					  size_t count, bool chained, double *times, char error[160])
{
	const struct method *method = find_finder(name, shape, error);
	if (!method) return false;
	ask_best(method, &(struct questions){shape, numbers, count, chained, times});
	return true;
}

static bool unit_find_terms(const char *name, enum touchstone_shape shape,
							const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count,
							double (*times)[TOUCHSTONE_MOST_TERMS], char error[160])
{
	const struct method *method = find_finder(name, shape, error);
	if (!method) return false;
	for (size_t k = 0; k < count; k++) {
		struct quadratic f;
		num time = answer(method, shape, numbers[k], 0, &f);
		int terms = expand(time, times[k], TOUCHSTONE_MOST_TERMS);
		for (int term = terms; term < TOUCHSTONE_MOST_TERMS; term++) times[k][term] = 0;
		times[k][0] = to_double(time); /* infinity and NaN too */
	}
	return true;
}

static bool unit_find_steps(const char *name, enum touchstone_shape shape,
							const double numbers[TOUCHSTONE_MOST_NUMBERS], struct touchstone_steps *steps,
							char error[160])
{
	const struct method *method = find_finder(name, shape, error);
	if (!method) return false;
	num unknown = from_double(NAN);
	struct quadratic f = {unknown, unknown, unknown, unknown};
	double time = to_double(answer(method, shape, numbers, 0, &f));
	*steps = (struct touchstone_steps){to_double(f.a), to_double(f.b), to_double(f.c), to_double(f.discriminant), time};
	return true;
}

static bool unit_claim(const char *name, enum touchstone_shape shape, struct touchstone_claim *claim, char error[160])
{
	const struct method *method = find_finder(name, shape, error);
	if (!method) return false;
	if (method->claim)
		method->claim(shape, claim);
	else
		snprintf(error, 160, "method '%s' claims nothing", name);
	return method->claim;
}

/* Vectors over any arithmetic. Sums run from the first axis to the last, so that axes a scene does not have add
 * exact zeros and change nothing. */

static inline num dot(const num a[3], const num b[3])
{
	return add(add(mul(a[0], b[0]), mul(a[1], b[1])), mul(a[2], b[2]));
}

/* The largest double not above x (for finite x): a key that never sorts a time too late. */
static inline double double_below(num x)
{
	double near = to_double(x);
	return less(x, from_double(near)) ? nextafter(near, -INFINITY) : near;
}

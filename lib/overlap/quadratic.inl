/* What an overlap function is made of, and what a finder forms on the way to its answer. A finder fills the parts that
 * it forms before it answers, and leaves the others alone. */

struct quadratic {
	num a, b, c, discriminant; /* b^2 - ac for balls, b^2 - 2ac for planes */
};

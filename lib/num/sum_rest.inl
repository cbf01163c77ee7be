/* What the rounding of a sum left out, exactly, in every arithmetic that rounds its sums to nearest (Knuth, "The Art of
 * Computer Programming", volume 2, section 4.2.2, theorem B). Twins, which do not, have their own. */

#ifndef NUM_HAS_SUM_REST
static inline num sum_rest(num a, num b, num sum)
{
	num b_part = sub(sum, a), a_part = sub(sum, b_part);
	return add(sub(a, a_part), sub(b, b_part));
}
#endif

/* Claims that the files of several methods make alike. */

/* Numbers between these keep every step of a finder within the range of the arithmetic, so that nothing overflows, and
 * every rounding error of a product is a number: with E the range's largest exponent, lengths, speeds and their last
 * bits are above 2^(-E/16 - bits), products of four of them above 2^(-E/2), and no product or quotient of products is
 * above 2^(E - 2). */
static inline void claim_within_range(struct touchstone_claim *claim)
{
	claim->least = ldexp(1, -num_largest_exponent / 16);
	claim->most = ldexp(1, num_largest_exponent / 16 * 3);
}

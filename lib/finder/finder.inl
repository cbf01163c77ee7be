/* What every finder is: from two bodies to the time until their event, or infinity. The parts of the overlap function
 * that it formed are left in f. */
typedef num ball_finder(const struct balls *balls, struct quadratic *f);
typedef num plane_finder(const struct flight *flight, struct quadratic *f);
typedef num half_space_finder(const struct passage *passage, struct quadratic *f);

/* What a method's file claims of its answers to one shape. */
typedef void claim_maker(enum touchstone_shape shape, struct touchstone_claim *claim);

/* Numbers between these keep every step of a finder within the range of the arithmetic, so that nothing overflows, and
 * every rounding error of a product is a number: with E the range's largest exponent, lengths, speeds and their last
 * bits are above 2^(-E/16 - bits), products of four of them above 2^(-E/2), and no product or quotient of products is
 * above 2^(E - 2). */
static void claim_within_range(struct touchstone_claim *claim)
{
	claim->least = ldexp(1, -num_largest_exponent / 16);
	claim->most = ldexp(1, num_largest_exponent / 16 * 3);
}

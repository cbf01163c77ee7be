/* What every finder is: from two bodies to the time until their event, or infinity. The parts of the overlap function
 * that it formed are left in f. */
typedef num ball_finder(const struct balls *balls, struct quadratic *f);
typedef num plane_finder(const struct flight *flight, struct quadratic *f);
typedef num half_space_finder(const struct passage *passage, struct quadratic *f);

/* What a method's file claims of its answers to one shape. */
typedef void claim_maker(enum touchstone_shape shape, struct touchstone_claim *claim);

/* search: a contact that finds its bodies overlapped is moved back along their path to where they are not.
 *
 * Source: Allen, Frenkel and Talbot, "Molecular dynamics simulation using hard particles", Computer Physics Reports 9,
 * 301 (1989), as the 2014 paper tells it in section 3: "retrospectively search along the pre-collision trajectory of
 * colliding particle pairs for a collision state which is not overlapping". The roots are those of method/naive.inl,
 * which the table of methods names for it; the walk is search_back() in engine/policy.inl.
 * Formula: t' = t - 2^k s for the first k = 0, 1, 2, ... at which r.r >= contact^2 in the working arithmetic, the
 * bodies flown there from their last events; no farther back than the later of these. Assumed, since the source walks
 * back by hand: steps that double; s the time in which the pair moves by `search_step` roundoffs (1 where the scene
 * says nothing) of the contact distance. It forms no overlap and knows none: a pair that overlaps and approaches all
 * the same, pushed by a third, has a negative time, for which there is no answer.
 *
 * Bound: none of the times; at contact r.r >= contact^2 wherever the later of the last events left the bodies apart.
 * Witness, without an answer:
 *     ball-ball 0x1.fffffffffffffp-1 0 0 -1 0 0 1 */

/* How long before the contact a walk begins that is `part` of the contact distance long. */
static inline num search_step(num contact, num speed, double part)
{
	return divide(mul(from_double(part), contact), speed);
}

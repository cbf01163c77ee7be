/* tc: a collision is elastic when one of the two has had its last one less than a contact time ago.
 *
 * Source: Luding and McNamara, "How to handle the inelastic collapse of a dissipative hard-sphere gas with the TC
 * model", Granular Matter 1, 113 (1998). Formula: restitution 1 where t - t_i <= t_c or t - t_j <= t_c, the scene's own
 * elsewhere. Events are found by the stable rule, which the table of methods names for it.
 * Assumed: the start counts as a collision of everybody, and walls count like particles; t_c is `contact_time`. Where
 * the scene says nothing it is 2^-20 (10^-6) of the time in which a typical particle flies its diameter at the start
 * (or falls by it, if that is shorter): the source leaves it to the material.
 *
 * Bound: that of method/stable.inl; the rule has no part in the finder. No witness: nothing is missed and nothing made
 * up, but energy that should be lost is kept, and a pile comes to no rest. */

static inline bool tc_elastic(num since, num contact_time)
{
	return !less(contact_time, since);
}

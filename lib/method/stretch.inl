/* stretch: a small time is added to an event, or taken off it, so that it finds the pair on the side where it belongs.
 *
 * Source: cited as [7] in the 2016 paper (section 2: "the addition or subtraction of a small quantity to the time of
 * the next event"), which gives neither the quantity nor the order in which events are then taken.
 * Built here: states are read from separations as by `positional`; the time of a pair's event is
 *
 *     t + h where the pair passes a step,    max(0, t - h) where it turns back there or at a core,
 *     h = 1024 n d / v
 *
 * with n the roundoff of the working arithmetic, d the largest distance at which anything happens, and v the root mean
 * square of the speeds at the start. Whether it passes is told by the speed with which it will arrive. Events are taken
 * in the order of these times. The finders are those of `stable`.
 *
 * What goes wrong: in h a pair that moves along its step does not leave it by more than rounding; and a third particle
 * that meets one of the two between t and t + h has them read where they then are, beyond a step that they never
 * passed: the event is lost, and its energy with it. */

/* The time at which an event, `wait` from now at the distance in `balls`, is to be executed. */
static num stretched(const struct touchstone_engine *engine, const struct balls *balls, const struct quadratic *f,
					 num wait, const struct step *step, bool inwards)
{
	num zero = from_double(0);
	if (!is_finite(wait)) return wait;
	if (step) {
		num climb = inwards ? step->climb : negated(step->climb), rv = add(f->b, mul(f->a, wait));
		if (climbs(climb, mul(balls->contact, balls->contact), rv)) return add(wait, engine->correction_time);
	}
	num early = sub(wait, engine->correction_time);
	return less(early, zero) ? zero : early;
}

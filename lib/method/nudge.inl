/* nudge: after an event the pair is moved to the side of the step, or of the core, on which it belongs.
 *
 * Source: cited as [9] in the 2016 paper (section 2: the position is changed "to 'nudge' the particles over the
 * corresponding discontinuity after processing the current event"), which does not say how far.
 * Built here: states are read from separations as by `positional`; where r.r after an event is not on its side of d^2,
 * the two are moved along their line of centres, their centre of mass staying where it is, to the distance
 *
 *     d (1 + 1024 n) outside,    d (1 - 1024 n) inside,
 *
 * n being the roundoff of the working arithmetic. The finders are those of `stable`.
 *
 * What goes wrong: other pairs of the two are moved as well, over steps that they never passed; and where pairs that
 * have had no event of late fly along a step, nothing nudges them. */

static void nudge(struct touchstone_engine *engine, uint32_t i, uint32_t j, const num r[3], num rr, num at, bool inside,
				  num share)
{
	num square = mul(at, at);
	if (inside ? less(rr, square) : less(square, rr)) return;
	num one = from_double(1), margin = from_double(ldexp(inside ? -correction : correction, -engine->bits));
	num stretch = sub(divide(mul(at, add(one, margin)), root(rr)), one);
	for (int axis = 0; axis < engine->dimensions; axis++) {
		num shift = mul(stretch, r[axis]), mine = mul(share, shift);
		engine->body[i].position[axis] = add(engine->body[i].position[axis], mine);
		engine->body[j].position[axis] = sub(engine->body[j].position[axis], sub(shift, mine));
	}
}

/* A point within a half-space: f(t) = distance + speed t along the normal, which points into the half that the point
 * belongs to; negative beyond the plane (2016 paper, eq. 4). As a quadratic: b t + c. */

struct passage {
	num distance, speed;
};

static inline void half_space(const struct passage *passage, struct quadratic *f)
{
	f->b = passage->speed;
	f->c = passage->distance;
}

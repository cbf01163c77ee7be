/* A ball over a plane: f(t) = distance + speed t + acceleration t^2 / 2 - contact, all along the plane's normal,
 * negative while the ball reaches through the plane (2014 paper, eq. 11). As a quadratic: a t^2 / 2 + b t + c. */

struct flight {
	num distance, speed, acceleration;
	num contact; /* distance at which they touch */
};

static inline void ball_plane(const struct flight *flight, struct quadratic *f)
{
	f->a = flight->acceleration;
	f->b = flight->speed;
	f->c = sub(flight->distance, flight->contact);
}

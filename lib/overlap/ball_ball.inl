/* Two balls: f(t) = (r + t v)^2 - contact^2 = a t^2 + 2 b t + c, negative while they overlap
 * (2014 paper, eq. 8; 2016 paper, eq. 1). Its derivative has the sign of a t + b. */

struct balls {
	num r[3], v[3]; /* relative position and velocity */
	num contact;    /* distance of the centres */
};

/* Forms b; whether the balls approach each other. One pair in two parts, and cannot meet whatever a and c are. */
static inline bool approaching(const struct balls *balls, struct quadratic *f)
{
	f->b = dot(balls->r, balls->v);
	return less(f->b, from_double(0));
}

/* Forms a and c. */
static inline void complete_ball_ball(const struct balls *balls, struct quadratic *f)
{
	f->a = dot(balls->v, balls->v);
	f->c = sub(dot(balls->r, balls->r), mul(balls->contact, balls->contact));
}

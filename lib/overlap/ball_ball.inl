/* Two balls: f(t) = (r + t v)^2 - contact^2 = a t^2 + 2 b t + c, negative while they overlap
 * (2014 paper, eq. 8; 2016 paper, eq. 1). Its derivative has the sign of a t + b. */

struct ball_ball {
	num a, b, c;
};

static inline struct ball_ball ball_ball(const num r[3], const num v[3], num contact)
{
	return (struct ball_ball){dot(v, v), dot(r, v), sub(dot(r, r), mul(contact, contact))};
}

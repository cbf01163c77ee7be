/* Two balls that are to stay within a distance: f(t) = contact^2 - (r + t v)^2, negative while they are farther apart
 * (2016 paper, section 3: the negative of ball_ball, whose a, b and c are kept). Its derivative has the sign of
 * -(a t + b). */

/* Forms a, b and c; whether the balls approach each other. */
static inline bool ball_leave(const struct balls *balls, struct quadratic *f)
{
	complete_ball_ball(balls, f);
	return approaching(balls, f);
}

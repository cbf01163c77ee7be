/* A ball over a plane: f(t) = distance + speed t + acceleration t^2 / 2 - contact, all along the plane's normal,
 * negative while the ball reaches through the plane (2014 paper, eq. 11). */

struct ball_plane {
	num gap, speed, acceleration; /* gap: distance - contact */
};

static inline struct ball_plane ball_plane(num distance, num speed, num acceleration, num contact)
{
	return (struct ball_plane){sub(distance, contact), speed, acceleration};
}

/* Steps of the sieve on machines that compare vectors into vectors. */
typedef whole_lanes mask;

INLINE mask less(lanes a, lanes b)
{
	return a < b;
}

INLINE mask behind(size_t count)
{
	return numbers() >= (int32_t)(count < LANES ? count : LANES);
}

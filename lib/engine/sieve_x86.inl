/* What the sieves of x86 have in common. */
MACHINE static void cast(struct shadow *shadow, double x, double y, double z, double time, double vx, double vy,
						 double vz, double radius)
{
	__m256 row =
		_mm256_setr_ps((float)x, (float)y, (float)z, (float)time, (float)vx, (float)vy, (float)vz, (float)radius);
	_mm256_store_ps((float *)shadow, row);
}

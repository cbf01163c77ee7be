/* A shared object that is no plug-in. */
double touchstone_bell_boll(double x);

double touchstone_bell_boll(double x)
{
	return x;
}

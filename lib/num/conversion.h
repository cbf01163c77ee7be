/* Conversion to MPFR and back, by which `rounded` goes its exact way. Where the library is built without MPFR, as for the
 * web, arithmetics have none, and there is no such method. */
#ifndef NUM_CONVERSION_H
#define NUM_CONVERSION_H

#ifndef TOUCHSTONE_WITHOUT_MPFR
#include <mpfr.h>
#endif

#endif

/* Numbers as people read them: 1.4 × 10⁻⁷, 13 500, −2.1. */
#ifndef REPORTS_DISPLAY_H
#define REPORTS_DISPLAY_H

#include <jansson.h>

enum { DISPLAY_ROOM = 80 };

/* A number with so many significant digits (1 to 17), zeros at its end left out; NaN is an empty dash. */
void display_number(char text[DISPLAY_ROOM], double value, int digits);

/* An integer with its digits in groups of three. */
void display_count(char text[DISPLAY_ROOM], json_int_t count);

/* Enough digits to tell the value from others in an interval of this width, and one more: 3 to 17. */
int display_digits(double value, double width);

/* A duration in its natural units: "12.3 s", "4 min 5 s", "2 h 3 min". */
void display_seconds(char text[DISPLAY_ROOM], double seconds);

#endif

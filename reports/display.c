#include "display.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MINUS "\u2212"
#define THIN_SPACE "\u202f" /* does not break the line */

static void power_of_ten(char *text, int exponent)
{
	static const char *const superscripts[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
	char digits[12];
	snprintf(digits, sizeof digits, "%d", abs(exponent));
	text = stpcpy(text, exponent < 0 ? "10⁻" : "10");
	for (const char *digit = digits; *digit; digit++) text = stpcpy(text, superscripts[*digit - '0']);
}

void display_number(char text[DISPLAY_ROOM], double value, int digits)
{
	if (!isfinite(value)) {
		strcpy(text, isnan(value) ? "–" : value > 0 ? "∞" : MINUS "∞");
		return;
	}
	char plain[40];
	snprintf(plain, sizeof plain, "%.*g", digits, fabs(value));
	char *exponent = strchr(plain, 'e');
	if (exponent) *exponent++ = '\0';
	char *end = stpcpy(text, value < 0 ? MINUS : "");
	if (!exponent || strcmp(plain, "1") != 0) end = stpcpy(end, plain);
	if (exponent && strcmp(plain, "1") != 0) end = stpcpy(end, THIN_SPACE "×" THIN_SPACE);
	if (exponent) power_of_ten(end, atoi(exponent));
}

void display_count(char text[DISPLAY_ROOM], json_int_t count)
{
	char digits[32];
	int length = snprintf(digits, sizeof digits, "%" JSON_INTEGER_FORMAT, count);
	const char *digit = digits;
	if (*digit == '-') {
		text = stpcpy(text, MINUS);
		digit++, length--;
	}
	/* Four digits read well without a gap. */
	for (int left = length; left > 0; left--) {
		if (left < length && left % 3 == 0 && length > 4) text = stpcpy(text, THIN_SPACE);
		*text++ = *digit++;
	}
	*text = '\0';
}

int display_digits(double value, double width)
{
	double ratio = fabs(value / width);
	int digits = isfinite(ratio) && ratio >= 1 ? (int)floor(log10(ratio)) + 3 : 3;
	return digits > 17 ? 17 : digits;
}

void display_seconds(char text[DISPLAY_ROOM], double seconds)
{
	if (!(seconds >= 0 && seconds < 1e12))
		strcpy(text, "–");
	else if (seconds < 100)
		snprintf(text, DISPLAY_ROOM, "%.3g" THIN_SPACE "s", seconds);
	else if (seconds < 6000)
		snprintf(text, DISPLAY_ROOM, "%.0f" THIN_SPACE "min %.0f" THIN_SPACE "s", floor(seconds / 60),
				 floor(fmod(seconds, 60)));
	else
		snprintf(text, DISPLAY_ROOM, "%.0f" THIN_SPACE "h %.0f" THIN_SPACE "min", floor(seconds / 3600),
				 floor(fmod(seconds, 3600) / 60));
}

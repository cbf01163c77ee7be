/* Numbers as people read them. */
#include "display.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

/* What a reader takes a displayed number for. */
static double read_back(const char *text)
{
	static const char *const superscripts[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹", "⁻"};
	char plain[200] = "";
	double sign = 1;
	bool raised = false;
	if (strncmp(text, "−", 3) == 0) sign = -1, text += 3;
	while (*text) {
		int i = 0;
		while (i < 11 && strncmp(text, superscripts[i], strlen(superscripts[i])) != 0) i++;
		if (i < 11) {
			char digit[2] = {"0123456789-"[i], '\0'};
			strcat(plain, digit);
			text += strlen(superscripts[i]);
		} else if (!raised && strncmp(text, "10", 2) == 0 && (unsigned char)text[2] > 127) {
			strcat(plain, *plain ? "e" : "1e");
			raised = true;
			text += 2;
		} else if ((*text >= '0' && *text <= '9') || *text == '.') {
			strcat(plain, (char[]){*text++, '\0'});
		} else {
			text++; /* spaces and the times sign */
		}
	}
	return sign * strtod(plain, NULL);
}

static void any_number_keeps_its_digits(void **state)
{
	(void)state;
	unsigned seed = (unsigned)time(NULL);
	print_message("seed %u\n", seed);
	for (int trial = 0; trial < 20000; trial++) {
		double value = (rand_r(&seed) - RAND_MAX / 2.0) * pow(10, rand_r(&seed) % 600 - 308);
		int digits = 1 + rand_r(&seed) % 17;
		char text[DISPLAY_ROOM];
		display_number(text, value, digits);
		assert_true(fabs(read_back(text) - value) <= 0.51 * pow(10, 1 - digits) * fabs(value));
	}
}

static void expect(double value, int digits, const char *expected)
{
	char text[DISPLAY_ROOM];
	display_number(text, value, digits);
	assert_string_equal(text, expected);
}

static void numbers(void **state)
{
	(void)state;
	expect(0, 6, "0");
	expect(0.49823, 6, "0.49823");
	expect(-2.5, 6, "−2.5");
	expect(1.42e-17, 6, "1.42\u202f×\u202f10⁻¹⁷");
	expect(1e-7, 6, "10⁻⁷");
	expect(-1e120, 6, "−10¹²⁰");
	expect(NAN, 6, "–");
	expect(-INFINITY, 6, "−∞");
}

static void counts(void **state)
{
	(void)state;
	const struct {
		json_int_t count;
		const char *text;
	} examples[] = {{0, "0"},
					{1234, "1234"},
					{13500, "13\u202f500"},
					{-1000000, "−1\u202f000\u202f000"},
					{INT64_MAX, "9\u202f223\u202f372\u202f036\u202f854\u202f775\u202f807"}};
	char text[DISPLAY_ROOM];
	for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
		display_count(text, examples[i].count);
		assert_string_equal(text, examples[i].text);
	}
}

static void digits_tell_the_ends_of_an_interval_apart(void **state)
{
	(void)state;
	for (double width = 1; width > 1e-13; width /= 3) {
		char low[DISPLAY_ROOM], high[DISPLAY_ROOM];
		display_number(low, 0.4982, display_digits(0.4982, width));
		display_number(high, 0.4982 + width, display_digits(0.4982, width));
		assert_string_not_equal(low, high);
	}
	assert_int_equal(display_digits(0, 1), 3);
	assert_int_equal(display_digits(1, 0), 3);
}

static void durations(void **state)
{
	(void)state;
	const struct {
		double seconds;
		const char *text;
	} examples[] = {{0.25, "0.25\u202fs"},
					{64.2, "64.2\u202fs"},
					{245, "4\u202fmin 5\u202fs"},
					{7380, "2\u202fh 3\u202fmin"},
					{NAN, "–"}};
	char text[DISPLAY_ROOM];
	for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
		display_seconds(text, examples[i].seconds);
		assert_string_equal(text, examples[i].text);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(any_number_keeps_its_digits),
		cmocka_unit_test(numbers),
		cmocka_unit_test(counts),
		cmocka_unit_test(digits_tell_the_ends_of_an_interval_apart),
		cmocka_unit_test(durations),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}

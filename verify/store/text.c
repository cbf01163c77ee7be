#include "store/text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool text_number(const char *text, double *value)
{
	const char *digits = text + (*text == '-' || *text == '+');
	if (!isdigit((unsigned char)*digits) && *digits != '.') return false; /* no blanks, no "nan", no "inf" */
	char *end;
	double number = strtod(text, &end);
	if (end == text || *end || !isfinite(number)) return false;
	*value = number;
	return true;
}

bool text_count(const char *text, uint64_t *value)
{
	bool hexadecimal = text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
	const char *digits = text + 2 * hexadecimal;
	size_t length = strspn(digits, hexadecimal ? "0123456789abcdefABCDEF" : "0123456789");
	if (length > 0 && !digits[length]) {
		errno = 0;
		unsigned long long count = strtoull(digits, NULL, hexadecimal ? 16 : 10);
		*value = count;
		return errno == 0;
	}
	double number;
	if (!text_number(text, &number) || number < 0 || number > 0x1p53 || number != floor(number)) return false;
	*value = (uint64_t)number;
	return true;
}

char *text_stem(const char *path)
{
	const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path, *dot = strrchr(base, '.');
	return strndup(base, dot && dot > base ? (size_t)(dot - base) : strlen(base));
}

void text_one_line(char *message)
{
	for (; *message; message++)
		if (iscntrl((unsigned char)*message)) *message = '?';
}

const char *text_shown(char shown[TEXT_SHOWN], const char *text)
{
	snprintf(shown, TEXT_SHOWN, "%.*s%s", TEXT_SHOWN - 4, text, strlen(text) > TEXT_SHOWN - 4 ? "..." : "");
	text_one_line(shown);
	return shown;
}

/* How commands say no. */
#include "command/command.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "store/text.h"

static void say(const char *format, va_list arguments)
{
	char message[1024];
	vsnprintf(message, sizeof message, format, arguments);
	text_one_line(message);
	fprintf(stderr, "touchstone: %s\n", message);
}

int refuse(const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	say(format, arguments);
	va_end(arguments);
	return STATUS_REFUSED;
}

_Noreturn void refuse_usage(const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	say(format, arguments);
	va_end(arguments);
	exit(STATUS_REFUSED);
}

_Noreturn void refuse_option(const char *option, const char *argument, const char *accepted)
{
	char shown[TEXT_SHOWN];
	refuse_usage("--%s: '%s'; accepted: %s", option, text_shown(shown, argument), accepted);
}

uint64_t option_count(const char *option, const char *argument, uint64_t least, uint64_t most)
{
	uint64_t count;
	char accepted[96];
	snprintf(accepted, sizeof accepted, "a whole number, %llu to %llu", (unsigned long long)least,
			 (unsigned long long)most);
	if (!text_count(argument, &count) || count < least || count > most) refuse_option(option, argument, accepted);
	return count;
}

double option_number(const char *option, const char *argument, double least, double most, const char *accepted)
{
	double number;
	if (!text_number(argument, &number) || !(number >= least && number <= most))
		refuse_option(option, argument, accepted);
	return number;
}

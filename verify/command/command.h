/* What the commands of the command line have in common. */
#ifndef VERIFY_COMMAND_H
#define VERIFY_COMMAND_H

#include <stddef.h>
#include <stdint.h>

/* Exit statuses. */
enum {
	STATUS_WELL = 0,
	STATUS_FINDING = 1,       /* a run that halted or diverged, a figure that could not be made */
	STATUS_REFUSED = 2,       /* wrong usage or bad input, or an output that cannot be written */
	STATUS_SKIPPED = 77,      /* an optional part is missing */
	STATUS_INTERRUPTED = 130, /* stopped by a signal; what was done by then is kept */
};

/* A command gets its own arguments, argv[0] being "touchstone COMMAND", and returns an exit status. */
int command_list(int argc, char **argv);
int command_run(int argc, char **argv);
int command_reproduce(int argc, char **argv);
int command_grade(int argc, char **argv);
int command_chart(int argc, char **argv);
int command_fuzz(int argc, char **argv);
int command_replay(int argc, char **argv);
int command_audit(int argc, char **argv);
int command_campaign(int argc, char **argv);
int command_merge(int argc, char **argv);
int command_report(int argc, char **argv);

/* The figures that `reproduce` makes; the name after the last is NULL. */
struct figure_setup;
struct figure_entry {
	const char *name, *about;
	struct result *(*make)(const struct figure_setup *setup, char error[512]);
};
extern const struct figure_entry figures[];

/* Says "touchstone: MESSAGE" on one line of standard error, and returns STATUS_REFUSED. */
__attribute__((format(printf, 1, 2))) int refuse(const char *format, ...);

/* For the parsers of arguments, before anything has begun: refuse and end the program. The second says
 * "touchstone: --OPTION: 'ARGUMENT'; accepted: ACCEPTED". */
__attribute__((format(printf, 1, 2))) _Noreturn void refuse_usage(const char *format, ...);
_Noreturn void refuse_option(const char *option, const char *argument, const char *accepted);

/* A whole number from least to most, such as "1000" or "1e6", or refuse_option. */
uint64_t option_count(const char *option, const char *argument, uint64_t least, uint64_t most);

/* A number from least to most, or refuse_option with `accepted`. */
double option_number(const char *option, const char *argument, double least, double most, const char *accepted);

/* The words of a command line, for a result to tell; to be freed. NULL when out of memory. */
char *command_line(int argc, char **argv);

/* Significand bits of an arithmetic that touchstone_create accepts. */
int arithmetic_bits(const char *name);

#endif

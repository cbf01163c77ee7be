/* What a shared object must be before it is loaded: there, and for this machine. The loader's own words for the latter
 * are "no such file". */
#include "plugin/host.h"

#include <elf.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* What the header says of the machine stands at the same place in all ELF files. */
struct machine {
	unsigned char ident[EI_NIDENT];
	uint16_t type, machine;
};

__attribute__((format(printf, 2, 3))) static bool refuse(char error[PLUGIN_ERROR], const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(error, PLUGIN_ERROR, format, arguments);
	va_end(arguments);
	return false;
}

static bool read_machine(const char *path, struct machine *machine)
{
	FILE *file = fopen(path, "rb");
	bool read = file && fread(machine, sizeof *machine, 1, file) == 1;
	if (file) fclose(file);
	return read && memcmp(machine->ident, ELFMAG, SELFMAG) == 0;
}

static bool same_machine(const struct machine *one, const struct machine *other)
{
	return one->ident[EI_CLASS] == other->ident[EI_CLASS] && one->ident[EI_DATA] == other->ident[EI_DATA] &&
		   one->machine == other->machine;
}

static bool check_file(const char *path, char error[PLUGIN_ERROR])
{
	struct machine machine, ours;
	struct stat status;
	if (stat(path, &status) != 0)
		return refuse(error, "%.200s: cannot be read: %s; accepted: a shared object, as FILE.so or FILE.so:SYMBOL",
					  path, strerror(errno));
	if (!S_ISREG(status.st_mode) || !read_machine(path, &machine))
		return refuse(error, "%.200s: no ELF file; accepted: a shared object", path);
	if (!read_machine("/proc/self/exe", &ours)) ours = machine; /* then the loader must tell */
	if (!same_machine(&machine, &ours))
		return refuse(error, "%.200s: for another machine (%d bits, ELF machine %d); accepted: %d bits, ELF machine %d",
					  path, machine.ident[EI_CLASS] == ELFCLASS64 ? 64 : 32, machine.machine,
					  ours.ident[EI_CLASS] == ELFCLASS64 ? 64 : 32, ours.machine);
	return machine.type == ET_DYN || refuse(error, "%.200s: an ELF file, but no shared object", path);
}

/* A colon with something that may be a symbol behind it. */
static const char *symbol_in(const char *name)
{
	const char *colon = strrchr(name, ':');
	bool symbol = colon && colon > name && colon[1] && !strchr(colon, '/');
	return symbol ? colon + 1 : NULL;
}

bool plugin_file(const char *name, char **path, const char **symbol, char error[PLUGIN_ERROR])
{
	*symbol = symbol_in(name);
	char *file = *symbol ? strndup(name, (size_t)(*symbol - name) - 1) : strdup(name);
	if (!file) return refuse(error, "out of memory");
	bool good = check_file(file, error);
	*path = good ? realpath(file, NULL) : NULL; /* a name without a slash would be looked for elsewhere */
	if (good && !*path) good = refuse(error, "%.200s: cannot be read: %s", file, strerror(errno));
	free(file);
	return good;
}

#include "aside.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool refuse(char error[REPORT_ERROR], const char *path, int reason)
{
	snprintf(error, REPORT_ERROR, "%s: cannot be written: %s", path, strerror(reason));
	return false;
}

static void forget(struct aside *file)
{
	free(file->path);
	free(file->temporary);
	*file = (struct aside){0};
}

bool aside_open(struct aside *file, char error[REPORT_ERROR], const char *format, ...)
{
	*file = (struct aside){0};
	va_list arguments;
	va_start(arguments, format);
	bool named = vasprintf(&file->path, format, arguments) >= 0;
	va_end(arguments);
	if (!named || asprintf(&file->temporary, "%s.%ld.part", file->path, (long)getpid()) < 0) {
		snprintf(error, REPORT_ERROR, "out of memory");
		return false;
	}
	struct stat there;
	if (stat(file->path, &there) == 0 && !S_ISREG(there.st_mode)) { /* renaming would destroy a device or a pipe */
		snprintf(error, REPORT_ERROR, "%.400s: not a file; accepted: a path that can be written", file->path);
		forget(file);
		return false;
	}
	file->stream = fopen(file->temporary, "w");
	if (file->stream) return true;
	refuse(error, file->path, errno);
	forget(file);
	return false;
}

bool aside_keep(struct aside *file, char error[REPORT_ERROR])
{
	errno = 0;
	bool whole = !ferror(file->stream);
	whole = fclose(file->stream) == 0 && whole;
	whole = whole && rename(file->temporary, file->path) == 0;
	if (!whole) {
		refuse(error, file->path, errno ? errno : EIO);
		unlink(file->temporary);
	}
	forget(file);
	return whole;
}

/* Has the names in the folder of a path written to disk; where a file system cannot, nothing is lost by trying. */
static void settle_folder(const char *path)
{
	char *copy = strdup(path);
	int folder = copy ? open(dirname(copy), O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
	if (folder >= 0) {
		fsync(folder);
		close(folder);
	}
	free(copy);
}

bool aside_keep_for_good(struct aside *file, char error[REPORT_ERROR])
{
	char *path = strdup(file->path);
	if (fflush(file->stream) != 0 || fsync(fileno(file->stream)) != 0) {
		refuse(error, file->path, errno);
		aside_drop(file);
		free(path);
		return false;
	}
	bool kept = aside_keep(file, error);
	if (kept && path) settle_folder(path);
	free(path);
	return kept;
}

void aside_drop(struct aside *file)
{
	fclose(file->stream);
	unlink(file->temporary);
	forget(file);
}

bool aside_folder(const char *path, char error[REPORT_ERROR])
{
	char *part = strdup(path);
	if (!part) return refuse(error, path, ENOMEM);
	bool made = true;
	for (char *slash = part; made && slash;) {
		slash = strchr(slash + 1, '/');
		if (slash) *slash = '\0';
		made = mkdir(part, 0777) == 0 || errno == EEXIST;
		if (slash) *slash = '/';
	}
	int reason = errno;
	free(part);
	struct stat there;
	if (made && stat(path, &there) == 0 && !S_ISDIR(there.st_mode)) return refuse(error, path, ENOTDIR);
	return made || refuse(error, path, reason);
}

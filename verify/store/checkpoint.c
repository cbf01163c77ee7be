#include "store/checkpoint.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "aside.h"
#include "store/checkpoint_tree.h"
#include "store/checksum.h"

enum { HEAD = 512 }; /* bytes of text before the HDF5, which looks for its own beginning at such places */
static const char title[] = "Touchstone checkpoint";

__attribute__((format(printf, 3, 4))) static bool blame(char error[STORE_ERROR], const char *path, const char *format,
														...)
{
	char text[STORE_ERROR / 2];
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(text, sizeof text, format, arguments);
	va_end(arguments);
	snprintf(error, STORE_ERROR, "%.200s: %s", path, text);
	text_one_line(error);
	return false;
}

/* The text that stands before such an image. */
static void write_head(char head[HEAD], const void *image, size_t size)
{
	char text[HEAD];
	int length = snprintf(text, sizeof text, "%s\nformat %d\nbytes %zu\nchecksum %016llx\n", title, CHECKPOINT_FORMAT,
						  size, (unsigned long long)checksum(0, image, size));
	memset(head, ' ', HEAD);
	memcpy(head, text, (size_t)length);
	head[HEAD - 1] = '\n';
}

bool checkpoint_write(const char *path, const struct checkpoint *checkpoint, char error[STORE_ERROR])
{
	size_t size;
	char head[HEAD];
	void *image = checkpoint_tree_make(checkpoint, &size);
	if (!image) return blame(error, path, "not enough memory for a checkpoint");
	write_head(head, image, size);
	struct aside file;
	bool written = aside_open(&file, error, "%s", path);
	if (written) {
		fwrite(head, 1, HEAD, file.stream);
		fwrite(image, 1, size, file.stream); /* trouble is noticed when it is kept */
		written = aside_keep_for_good(&file, error);
	}
	free(image);
	return written;
}

/* Whether the whole file is what its head says. */
static bool check(const char *path, const char *bytes, size_t size, char error[STORE_ERROR])
{
	static const char accepted[] = "accepted: a whole file that `touchstone run --checkpoint` wrote";
	char head[HEAD + 1] = "", expected[HEAD];
	int format;
	size_t said;
	memcpy(head, bytes, size < HEAD ? size : HEAD);
	if (strncmp(head, title, strlen(title)) != 0 || sscanf(head + strlen(title), "\nformat %d\n", &format) != 1)
		return blame(error, path, "no checkpoint; %s", accepted);
	if (format != CHECKPOINT_FORMAT)
		return blame(error, path, "a checkpoint of format %d; accepted: format %d", format, CHECKPOINT_FORMAT);
	if (sscanf(head + strlen(title), "\nformat %d\nbytes %zu\n", &format, &said) != 2 || size < HEAD ||
		said != size - HEAD)
		return blame(error, path, "a checkpoint cut short, or altered: it has %zu bytes; %s", size, accepted);
	write_head(expected, bytes + HEAD, size - HEAD);
	if (memcmp(head, expected, HEAD) == 0) return true;
	return blame(error, path, "an altered checkpoint: its checksum is another; %s", accepted);
}

/* The bytes of a file, from malloc; NULL with a message. */
static char *read_file(const char *path, size_t *size, char error[STORE_ERROR])
{
	FILE *stream = fopen(path, "r");
	struct stat there;
	char *bytes = NULL;
	*size = 0;
	if (!stream || fstat(fileno(stream), &there) != 0)
		blame(error, path, "cannot be read: %s", strerror(errno));
	else if (!S_ISREG(there.st_mode))
		blame(error, path, "not a file; accepted: a checkpoint");
	else if (!(bytes = malloc((size_t)there.st_size + 1)))
		blame(error, path, "not enough memory for its %lld bytes", (long long)there.st_size);
	else
		*size = fread(bytes, 1, (size_t)there.st_size, stream);
	if (stream) fclose(stream);
	return bytes;
}

bool checkpoint_read(const char *path, struct checkpoint *checkpoint, char error[STORE_ERROR])
{
	*checkpoint = (struct checkpoint){0};
	size_t size;
	char *bytes = read_file(path, &size, error);
	if (!bytes) return false;
	bool read = false;
	if (check(path, bytes, size, error)) {
		read = checkpoint_tree_read(bytes + HEAD, size - HEAD, checkpoint);
		uint64_t version = checkpoint->state_version;
		if (version && version != TOUCHSTONE_STATE_VERSION)
			read = blame(error, path, "a state of version %llu; accepted: version %d", (unsigned long long)version,
						 TOUCHSTONE_STATE_VERSION);
		else if (!read)
			blame(error, path, "its HDF5 is that of no checkpoint, or memory ran out");
	}
	free(bytes);
	if (!read) checkpoint_free(checkpoint);
	return read;
}

void checkpoint_free(struct checkpoint *checkpoint)
{
	touchstone_snapshot_free(&checkpoint->state);
	touchstone_snapshot_free(&checkpoint->run);
}

bool checkpoint_put(struct checkpoint *checkpoint, const char *name, enum touchstone_content content, size_t count,
					const void *numbers)
{
	struct touchstone_snapshot *run = &checkpoint->run;
	if (run->count == TOUCHSTONE_MOST_FIELDS) return false;
	run->words = 1;
	struct touchstone_field *field = &run->field[run->count];
	*field = (struct touchstone_field){.content = content, .rows = 1, .columns = count};
	snprintf(field->name, sizeof field->name, "%s", name);
	size_t bytes = touchstone_field_bytes(run, field);
	field->data = malloc(bytes + 1);
	if (!field->data) return false;
	memcpy(field->data, numbers, bytes);
	run->count++;
	return true;
}

bool checkpoint_get(const struct checkpoint *checkpoint, const char *name, enum touchstone_content content,
					size_t count, void *numbers)
{
	const struct touchstone_snapshot *run = &checkpoint->run;
	for (size_t f = 0; f < run->count; f++) {
		const struct touchstone_field *field = &run->field[f];
		if (strcmp(field->name, name) != 0 || field->content != content) continue;
		if (field->rows != 1 || field->columns != count) continue;
		memcpy(numbers, field->data, touchstone_field_bytes(run, field));
		return true;
	}
	return false;
}

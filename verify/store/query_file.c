#include "store/query_file.h"

#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "store/text.h"

enum { MESSAGE = 400, LONGEST_LINE = 4096, QUERIES_AT_ONCE = 256 };

static const char blanks[] = " \t\r\n\v\f";

static const struct {
	const char *name;
	size_t numbers;
	const char *form;
} shapes[TOUCHSTONE_SHAPES] = {
	[TOUCHSTONE_BALL_BALL] = {"ball-ball", 7, "rx ry rz vx vy vz contact"},
	[TOUCHSTONE_BALL_LEAVE] = {"ball-leave", 7, "rx ry rz vx vy vz contact"},
	[TOUCHSTONE_BALL_PLANE] = {"ball-plane", 4, "distance speed acceleration contact"},
	[TOUCHSTONE_HALF_SPACE] = {"half-space", 2, "distance speed"},
};

const char *shape_name(enum touchstone_shape shape)
{
	return shapes[shape].name;
}

size_t shape_numbers(enum touchstone_shape shape)
{
	return shapes[shape].numbers;
}

bool shape_named(const char *name, enum touchstone_shape *shape)
{
	for (int s = 0; s < TOUCHSTONE_SHAPES; s++) {
		if (strcmp(name, shapes[s].name) != 0) continue;
		*shape = (enum touchstone_shape)s;
		return true;
	}
	return false;
}

/* ---- one line */

__attribute__((format(printf, 2, 3))) static bool refuse(char error[MESSAGE], const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(error, MESSAGE, format, arguments);
	va_end(arguments);
	return false;
}

/* Numbers mean the same wherever the program runs. Returns what was in force, for numbers_as_before(). */
static locale_t numbers_with_points(void)
{
	return uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0));
}

static void numbers_as_before(locale_t before)
{
	freelocale(uselocale(before));
}

static bool names_no_finite_number(const char *word)
{
	word += *word == '-' || *word == '+';
	return strcasecmp(word, "inf") == 0 || strcasecmp(word, "infinity") == 0 || strcasecmp(word, "nan") == 0;
}

static bool read_number(const char *word, double *number, char error[MESSAGE])
{
	if (text_number(word, number)) return true;
	char *end, shown[TEXT_SHOWN];
	double value = strtod(word, &end);
	if (names_no_finite_number(word)) {
		*number = value;
		return true;
	}
	text_shown(shown, word);
	if (*end == '\0' && isinf(value))
		return refuse(error, "'%s' is too large; accepted: up to 0x1.fffffffffffffp+1023, or inf", shown);
	return refuse(error, "'%s' is no number; accepted: decimal (1e-3), hexadecimal (0x1.8p-3), inf, nan", shown);
}

static bool read_numbers(char *words, struct query *query, char error[MESSAGE])
{
	const char *name = shapes[query->shape].name, *form = shapes[query->shape].form;
	size_t wanted = shapes[query->shape].numbers;
	char shown[TEXT_SHOWN], *rest, *word = strtok_r(words, blanks, &rest);
	for (size_t i = 0; i < wanted; i++, word = strtok_r(NULL, blanks, &rest)) {
		if (!word) return refuse(error, "%zu numbers; accepted: %zu, %s %s", i, wanted, name, form);
		if (!read_number(word, &query->number[i], error)) return false;
	}
	return !word ||
		   refuse(error, "'%s' is too much; accepted: %zu numbers, %s %s", text_shown(shown, word), wanted, name, form);
}

/* Cuts the comment off the line, and the blanks off the comment. */
static const char *cut_comment(char *line)
{
	char *comment = strchr(line, '#');
	if (!comment) return NULL;
	*comment++ = '\0';
	comment += strspn(comment, blanks);
	size_t length = strlen(comment);
	while (length > 0 && strchr(blanks, comment[length - 1])) length--;
	comment[length] = '\0';
	return comment;
}

/* Takes a line apart. `asks` tells whether there is a question on it. */
static bool read_line(char *line, struct query *query, bool *asks, char error[MESSAGE])
{
	*query = (struct query){.comment = cut_comment(line)};
	char *shape = line + strspn(line, blanks), *numbers = shape + strcspn(shape, blanks);
	*asks = *shape != '\0';
	if (!*asks) return true;
	if (*numbers) *numbers++ = '\0';
	char shown[TEXT_SHOWN];
	if (!shape_named(shape, &query->shape))
		return refuse(error, "'%s' is no shape; accepted: ball-ball, ball-leave, ball-plane, half-space",
					  text_shown(shown, shape));
	locale_t before = numbers_with_points();
	bool read = read_numbers(numbers, query, error);
	numbers_as_before(before);
	return read;
}

bool query_parse(const char *text, struct query *query, char error[MESSAGE])
{
	char line[LONGEST_LINE];
	bool asks;
	if (strlen(text) >= sizeof line)
		return refuse(error, "a question without end; accepted: up to %d characters", LONGEST_LINE - 1);
	if (!read_line(strcpy(line, text), query, &asks, error)) return false;
	query->comment = NULL;
	return asks || refuse(error, "no question; accepted: a shape and its numbers, such as half-space 1 -0x1.8p-3");
}

/* ---- a file */

struct reader {
	const char *name;
	FILE *stream;
	long line;
	size_t used, room; /* of the text */
	struct query_file *file;
	char *error;
};

/* Puts the place before a message. */
static bool refuse_at(const struct reader *reader, const char *message)
{
	refuse(reader->error, "%.150s:%ld: %.230s", reader->name, reader->line, message);
	text_one_line(reader->error);
	return false;
}

/* Adds the next line to the text, with a '\0' instead of its end. `more`: whether there was one. */
static bool add_line(struct reader *reader, bool *more)
{
	struct query_file *file = reader->file;
	reader->line++;
	*more = false;
	for (size_t length = 0;; length++) {
		int next = getc(reader->stream);
		if (next == EOF && ferror(reader->stream)) {
			char message[100];
			snprintf(message, sizeof message, "cannot be read: %.60s", strerror(errno));
			return refuse_at(reader, message);
		}
		if (next == '\0') return refuse_at(reader, "a character of value 0; accepted: text");
		if (length == LONGEST_LINE) return refuse_at(reader, "a line without end; accepted: up to 4095 characters");
		if (reader->used == reader->room) {
			size_t room = 2 * reader->room + LONGEST_LINE;
			char *text = realloc(file->text, room);
			if (!text) return refuse_at(reader, "no memory for so long a file");
			file->text = text;
			reader->room = room;
		}
		bool ends = next == EOF || next == '\n';
		*more |= next != EOF;
		file->text[reader->used++] = ends ? '\0' : (char)next;
		if (ends) return true;
	}
}

/* Takes the text apart, line by line. */
static bool read_text(struct reader *reader)
{
	struct query_file *file = reader->file;
	size_t room = 0;
	reader->line = 0;
	for (size_t at = 0, next; at < reader->used; at = next) {
		next = at + strlen(file->text + at) + 1;
		reader->line++;
		if (file->count == room) {
			room += room / 2 + QUERIES_AT_ONCE;
			struct query *query = reallocarray(file->query, room, sizeof *query);
			if (!query) return refuse_at(reader, "no memory for so many questions");
			file->query = query;
		}
		bool asks;
		char message[MESSAGE];
		struct query *query = &file->query[file->count];
		if (!read_line(file->text + at, query, &asks, message)) return refuse_at(reader, message);
		query->line = reader->line;
		file->count += asks;
	}
	return file->count > 0 || refuse_at(reader, "the file ends without a question; accepted: one or more");
}

bool query_file_read(const char *path, struct query_file *file, char error[MESSAGE])
{
	bool standard = strcmp(path, "-") == 0;
	*file = (struct query_file){0};
	struct reader reader = {.name = standard ? "standard input" : path,
							.stream = standard ? stdin : fopen(path, "r"),
							.file = file,
							.error = error};
	if (!reader.stream) {
		refuse(error, "%.200s: cannot be read: %.60s", path, strerror(errno));
		text_one_line(error);
		return false;
	}
	bool read, more = true;
	do read = add_line(&reader, &more);
	while (read && more);
	if (!standard) fclose(reader.stream);
	read = read && read_text(&reader);
	if (!read) query_file_free(file);
	return read;
}

void query_file_free(struct query_file *file)
{
	free(file->query);
	free(file->text);
	*file = (struct query_file){0};
}

void query_write(FILE *stream, const struct query *query)
{
	locale_t before = numbers_with_points();
	fputs(shapes[query->shape].name, stream);
	for (size_t i = 0; i < shapes[query->shape].numbers; i++) fprintf(stream, " %a", query->number[i]);
	if (query->comment) fprintf(stream, " # %s", query->comment);
	numbers_as_before(before);
}

char *query_text(enum touchstone_shape shape, const double number[TOUCHSTONE_MOST_NUMBERS])
{
	char *text = NULL;
	size_t size;
	struct query query = {.shape = shape};
	memcpy(query.number, number, sizeof query.number);
	FILE *stream = open_memstream(&text, &size);
	if (!stream) return NULL;
	query_write(stream, &query);
	fclose(stream);
	return text;
}

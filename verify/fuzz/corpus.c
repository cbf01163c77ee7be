#include "fuzz/corpus.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "aside.h"
#include "fuzz/shrink.h"

enum { BRANCH_BITS = 8 };

/* ---- reading */

bool corpus_read_file(struct fuzz_hunt *hunt, const char *path, char error[CORPUS_ERROR])
{
	struct query_file file;
	if (!query_file_read(path, &file, error)) return false;
	bool good = true;
	for (size_t q = 0; good && q < file.count; q++) {
		const struct query *query = &file.query[q];
		bool finite = true;
		for (int n = 0; n < TOUCHSTONE_MOST_NUMBERS; n++) finite &= isfinite(query->number[n]);
		if (query->shape == hunt->subject.shape && finite) good = fuzz_feed(hunt, query->number);
	}
	query_file_free(&file);
	if (!good) snprintf(error, CORPUS_ERROR, "out of memory");
	return good;
}

static int is_text(const struct dirent *entry)
{
	const char *ending = strrchr(entry->d_name, '.');
	return ending && ending != entry->d_name && strcmp(ending, ".txt") == 0;
}

bool corpus_read(struct fuzz_hunt *hunt, const char *folder, char error[CORPUS_ERROR])
{
	struct dirent **entry;
	int count = scandir(folder, &entry, is_text, alphasort);
	if (count < 0 && errno == ENOENT) return true;
	if (count < 0) {
		snprintf(error, CORPUS_ERROR, "%.300s: %s; accepted: a folder", folder, strerror(errno));
		return false;
	}
	bool good = true;
	for (int e = 0; e < count; e++) {
		char *path;
		if (good && asprintf(&path, "%s/%s", folder, entry[e]->d_name) >= 0) {
			good = corpus_read_file(hunt, path, error);
			free(path);
		}
		free(entry[e]);
	}
	free(entry);
	return good;
}

/* ---- findings */

void fuzz_words(const struct fuzz_subject *subject, const struct fuzz_case *failed, char words[320])
{
	char branch[80], fault[120] = "";
	size_t length = (size_t)snprintf(words, 320, "%s:", fuzz_failure_name(failed->failure));
	if (failed->failure == FUZZ_CRASH || failed->failure == FUZZ_HANG) plugin_fault_words(&failed->fault, fault);
	for (int q = 0; q < failed->questions; q++) {
		const char *before = q ? " and then" : "";
		length += *fault ? (size_t)snprintf(words + length, 320 - length, " %s", fault)
						 : (size_t)snprintf(words + length, 320 - length, "%s answers %a", before, failed->answer[q]);
		length += (size_t)snprintf(words + length, 320 - length, ", exact %a", failed->exact[q]);
	}
	if (failed->failure == FUZZ_IMPRECISE)
		length += (size_t)snprintf(words + length, 320 - length, ", off by %.4g ulp", failed->ulp);
	fuzz_branch_words(subject->shape, failed->branch, branch);
	if (failed->questions == 1) snprintf(words + length, 320 - length, "; %s", branch);
}

/* "stable-binary64-ball-ball-missed-59", or "...-59-beyond" beyond what is claimed, so that neither hides the other;
 * with letters, digits, dots and dashes only. */
static char *title_of(const struct fuzz_subject *subject, const struct fuzz_case *failed)
{
	char *title;
	if (asprintf(&title, "%s-%s-%s-%s-%x%s", subject->finder->method, subject->finder->arithmetic,
				 shape_name(subject->shape), fuzz_failure_name(failed->failure), failed->branch,
				 failed->promised ? "" : "-beyond") < 0)
		return NULL;
	for (char *letter = title; *letter; letter++)
		if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_", *letter)) *letter = '-';
	return title;
}

static void write_query(FILE *stream, enum touchstone_shape shape, const double number[TOUCHSTONE_MOST_NUMBERS])
{
	struct query query = {.shape = shape};
	memcpy(query.number, number, sizeof query.number);
	query_write(stream, &query);
}

/* Bits of the finding that a file holds; UINT_MAX when there is none. */
static unsigned bits_of(const struct fuzz_subject *subject, const char *path)
{
	struct query_file file;
	char error[CORPUS_ERROR];
	if (access(path, F_OK) != 0 || !query_file_read(path, &file, error)) return (unsigned)-1;
	struct fuzz_case known = {0};
	for (size_t q = 0; q < file.count && known.questions < 2; q++)
		memcpy(known.number[known.questions++], file.query[q].number, sizeof *known.number);
	query_file_free(&file);
	return known.questions ? fuzz_case_bits(subject->shape, &known) : (unsigned)-1;
}

bool corpus_write(const struct fuzz_hunt *hunt, const struct fuzz_finding *finding, const char *folder,
				  char error[CORPUS_ERROR])
{
	const struct fuzz_subject *subject = &hunt->subject;
	const struct fuzz_case *shrunk = &finding->shrunk;
	char *title = title_of(subject, shrunk), *path = NULL, words[320];
	struct aside file;
	bool good = title && asprintf(&path, "%s/%s.txt", folder, title) >= 0;
	if (!good) path = NULL;
	if (!good) snprintf(error, CORPUS_ERROR, "out of memory");
	unsigned bits = fuzz_case_bits(subject->shape, shrunk);
	bool needed = good && bits < bits_of(subject, path);
	if (needed && (good = aside_open(&file, error, "%s", path))) {
		fuzz_words(subject, shrunk, words);
		fprintf(file.stream,
				"# %s in %s%s\n# Seed %" PRIu64 ", question %" PRIu64 "; shrunk from %u to %u significant bits.\n",
				subject->finder->method, subject->finder->arithmetic,
				shrunk->promised ? "" : ", beyond what its file claims", hunt->seed, finding->question,
				fuzz_case_bits(subject->shape, &finding->first), bits);
		for (int q = 0; q < shrunk->questions; q++) {
			write_query(file.stream, subject->shape, shrunk->number[q]);
			fprintf(file.stream, " # %s\n", q == 0 ? words : "the other of the two");
		}
		good = aside_keep(&file, error);
	}
	free(path);
	free(title);
	return good;
}

/* ---- rounds */

/* The book: a JSON object of how many rounds each finder has been through. */
static json_t *read_book(const char *path, char error[CORPUS_ERROR])
{
	json_error_t wrong;
	if (access(path, F_OK) != 0) return json_object();
	json_t *book = json_load_file(path, JSON_REJECT_DUPLICATES, &wrong);
	if (json_is_object(book)) return book;
	snprintf(error, CORPUS_ERROR,
			 "%.200s:%d: %.160s; accepted: the rounds that hunts have been through, or no such file", path,
			 book ? 1 : wrong.line, book ? "is no object" : wrong.text);
	json_decref(book);
	return NULL;
}

static char *book_path(const char *folder)
{
	char *path;
	return asprintf(&path, "%s/rounds.json", folder) < 0 ? NULL : path;
}

static char *entry_of(const struct fuzz_hunt *hunt)
{
	char *entry;
	const struct finder *finder = hunt->subject.finder;
	return asprintf(&entry, "%s %s %s, seed %" PRIu64, finder->method, finder->arithmetic,
					shape_name(hunt->subject.shape), hunt->seed) < 0
			   ? NULL
			   : entry;
}

bool corpus_rounds(struct fuzz_hunt *hunt, const char *folder, char error[CORPUS_ERROR])
{
	char *path = book_path(folder), *entry = entry_of(hunt);
	snprintf(error, CORPUS_ERROR, "out of memory");
	json_t *book = path && entry ? read_book(path, error) : NULL;
	if (book) hunt->rounds = (uint64_t)json_integer_value(json_object_get(book, entry));
	bool good = book;
	json_decref(book);
	free(entry);
	free(path);
	return good;
}

bool corpus_enter_rounds(const struct fuzz_hunt *hunt, const char *folder, char error[CORPUS_ERROR])
{
	char *path = book_path(folder), *entry = entry_of(hunt);
	snprintf(error, CORPUS_ERROR, "out of memory");
	json_t *book = path && entry ? read_book(path, error) : NULL;
	struct aside file;
	bool good = book && json_object_set_new(book, entry, json_integer((json_int_t)hunt->rounds)) == 0 &&
				aside_open(&file, error, "%s", path);
	if (good) {
		json_dumpf(book, file.stream, JSON_INDENT(2) | JSON_SORT_KEYS);
		fputc('\n', file.stream);
		good = aside_keep(&file, error);
	}
	json_decref(book);
	free(entry);
	free(path);
	return good;
}

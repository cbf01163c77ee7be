/* Folders for tests to write into, and a look at what is in them. */
#ifndef REPORTS_TEST_FOLDER_H
#define REPORTS_TEST_FOLDER_H

#include <dirent.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Makes a new folder and returns its path, which the caller frees. */
static inline char *folder_new(void)
{
	char *path = strdup("/tmp/touchstone-test-XXXXXX");
	if (!path || !mkdtemp(path)) abort();
	return path;
}

static inline int folder_remove_entry(const char *path, const struct stat *status, int type, struct FTW *place)
{
	(void)status, (void)type, (void)place;
	return remove(path);
}

/* Removes the folder with all it holds, and frees its path. */
static inline void folder_remove(char *path)
{
	nftw(path, folder_remove_entry, 8, FTW_DEPTH | FTW_PHYS);
	free(path);
}

/* How many entries of the folder have this in their name. */
static inline int folder_count(const char *path, const char *part)
{
	DIR *folder = opendir(path);
	int count = 0;
	for (struct dirent *entry; folder && (entry = readdir(folder));)
		count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 && strstr(entry->d_name, part);
	if (folder) closedir(folder);
	return count;
}

/* The file's whole text, which the caller frees; NULL when it is not there. */
static inline char *folder_text(const char *folder, const char *name)
{
	char *path = NULL, *text = NULL;
	size_t room = 0;
	if (asprintf(&path, "%s/%s", folder, name) < 0) abort();
	FILE *file = fopen(path, "r");
	free(path);
	if (!file) return NULL;
	if (getdelim(&text, &room, '\0', file) < 0) text[0] = '\0';
	fclose(file);
	return text;
}

static inline void folder_put(const char *folder, const char *name, const char *text)
{
	char *path = NULL;
	if (asprintf(&path, "%s/%s", folder, name) < 0) abort();
	FILE *file = fopen(path, "w");
	if (!file || fputs(text, file) < 0 || fclose(file) != 0) abort();
	free(path);
}

#endif

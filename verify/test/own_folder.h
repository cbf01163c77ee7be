/* A folder for the files of a test program, there from before its first test until after its last. */
#ifndef VERIFY_TEST_OWN_FOLDER_H
#define VERIFY_TEST_OWN_FOLDER_H

#include "test/folder.h"

static char *folder;

static inline int make_folder(void **state)
{
	(void)state;
	folder = folder_new();
	return 0;
}

static inline int remove_folder(void **state)
{
	(void)state;
	folder_remove(folder);
	return 0;
}

#endif

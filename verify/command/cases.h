/* The folder of cases, and finding a scene in it by name. */
#ifndef VERIFY_CASES_H
#define VERIFY_CASES_H

/* The folder the user asks for; without a wish (NULL) `cases` where the user stands, or else the one Touchstone was
 * installed with, or was built from. */
const char *cases_folder(const char *wanted);

/* The path of a scene: `name` itself when there is such a file, or a case of that name, with or without ".yaml". The
 * caller frees it. NULL when there is neither. */
char *cases_find(const char *folder, const char *name);

#endif

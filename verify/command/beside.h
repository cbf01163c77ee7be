/* What lies beside the program, wherever it was built or installed. */
#ifndef VERIFY_BESIDE_H
#define VERIFY_BESIDE_H

/* The path of a file or folder, given from the program's own folder on, such as "../share/touchstone/cases"; the caller
 * frees it. NULL when there is none. */
char *beside_program(const char *path);

#endif

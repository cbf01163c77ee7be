/* The corpus: a folder of questions that have broken somebody, one small text file each, as `touchstone replay` reads
 * them; and where hunts left off. */
#ifndef VERIFY_FUZZ_CORPUS_H
#define VERIFY_FUZZ_CORPUS_H

#include "fuzz/hunt.h"

enum { CORPUS_ERROR = 512 };

/* Feeds a hunt the questions of its subject's shape: of a file; of all files `*.txt` of a folder, in the order of their
 * names. A folder that is not there holds none. False with "file:line: what is wrong" in `error`. */
bool corpus_read_file(struct fuzz_hunt *hunt, const char *path, char error[CORPUS_ERROR]);
bool corpus_read(struct fuzz_hunt *hunt, const char *folder, char error[CORPUS_ERROR]);

/* Writes a finding to FOLDER/METHOD-ARITHMETIC-SHAPE-FAILURE-BRANCH[-beyond].txt, unless one that is as simple is
 * there: with the exact answer, and how it was found. False with a message. */
bool corpus_write(const struct fuzz_hunt *hunt, const struct fuzz_finding *finding, const char *folder,
				  char error[CORPUS_ERROR]);

/* How many rounds have been made against this finder from this seed, by the folder's own book of them; and the entry of
 * how many it is now. False with a message: what is there cannot be read, or the new one not written. */
bool corpus_rounds(struct fuzz_hunt *hunt, const char *folder, char error[CORPUS_ERROR]);
bool corpus_enter_rounds(const struct fuzz_hunt *hunt, const char *folder, char error[CORPUS_ERROR]);

/* One line on what happened: "missed: answers inf, exact 0x1.8p+1; a > 0, b < 0, c > 0, D > 0". */
void fuzz_words(const struct fuzz_subject *subject, const struct fuzz_case *failed, char words[320]);

#endif

/* Files that live in the program, so that it needs no folder of data beside it. */
#ifndef REPORTS_EMBED_H
#define REPORTS_EMBED_H

/* Declares the NUL-terminated contents of reports/PATH as the constant text `symbol`. The file is taken in when the
 * object is compiled, from the top of the source tree. */
#define EMBED(symbol, path)                                                                            \
	__asm__(".pushsection .rodata\n" #symbol ":\n.incbin \"reports/" path "\"\n.byte 0\n.popsection"); \
	extern const char symbol[] __attribute__((visibility("hidden")))

#endif

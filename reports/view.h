/* What a page shows of a result: the same facts, with numbers turned into text and names of files filled in. */
#ifndef REPORTS_VIEW_H
#define REPORTS_VIEW_H

#include <jansson.h>

/* A view of a result's document, as the templates name its parts; the caller owns it. Its figures have no `drawn` and
 * no `problem` yet: the one who draws them adds these. */
json_t *view_result(const json_t *document);

/* The overview over some views of results, which it shares. The caller owns it. */
json_t *view_index(const json_t *views);

#endif

/* Cells of the atlas on the live page. */
#ifndef VERIFY_ATLAS_LIVE_H
#define VERIFY_ATLAS_LIVE_H

#include "figure/atlas.h"

/* Writes the live page's parameters for a cell: its method beside the stable rule, in the precision and up to the event
 * that show its failure, where there is one. False where the page has not the method. `unseen` receives what it does
 * not show of the cell and why, or "". */
bool atlas_live(const struct atlas *atlas, int method, int scene, char query[300], char unseen[80]);

#endif

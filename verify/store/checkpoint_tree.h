/* The HDF5 of a checkpoint, in memory: store/checkpoint.h. */
#ifndef VERIFY_CHECKPOINT_TREE_H
#define VERIFY_CHECKPOINT_TREE_H

#include "store/checkpoint.h"

/* The file's image, from malloc, and its size; NULL when there is not enough memory. */
void *checkpoint_tree_make(const struct checkpoint *checkpoint, size_t *size);

/* Fills a checkpoint that is all zero from such an image, version 1 of the state or another. False, with what was made
 * until then still to be freed, when it is none. */
bool checkpoint_tree_read(const void *image, size_t size, struct checkpoint *checkpoint);

#endif

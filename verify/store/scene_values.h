/* Single words of a scene file as numbers. For the parts of the scene file's reader only.
 *
 * Each refuses, by scene_file_refuse, a word that is none of what it accepts. An absent word (NULL) leaves the value as
 * it is, unless said otherwise. */
#ifndef TOUCHSTONE_SCENE_VALUES_H
#define TOUCHSTONE_SCENE_VALUES_H

#include "store/scene_file.h"

enum value_range { VALUE_ANY, VALUE_NOT_NEGATIVE, VALUE_POSITIVE };

bool value_number(const struct scene_file *file, const char *key, const char *word, enum value_range range,
				  double *value, char *error);
bool value_count(const struct scene_file *file, const char *key, const char *word, uint64_t least, uint64_t most,
				 uint64_t *value, char *error);

/* Whether a list has one entry for each dimension, or, where that makes sense, a single one for all. */
bool value_length(const struct scene_file *file, const char *key, unsigned count, bool one_for_all, char *error);

/* Such a list of numbers. */
bool value_vector(const struct scene_file *file, const char *key, char **words, unsigned count, bool one_for_all,
				  enum value_range range, double vector[3], char *error);

/* A number, or "viscoelastic" and a number; an absent word means elastic. */
bool value_restitution(const struct scene_file *file, const char *key, const char *word,
					   struct touchstone_restitution *restitution, char *error);

#endif

/* From single words of a scene file to numbers. */
#include "store/scene_values.h"

#include <stdio.h>
#include <string.h>

#include "store/yaml_text.h"

bool value_number(const struct scene_file *file, const char *key, const char *word, enum value_range range,
				  double *value, char *error)
{
	static const char *const accepted[] = {"a finite number", "a finite number, 0 or more", "a finite number above 0"};
	if (!word) return true;
	double number;
	bool fits = text_number(word, &number) &&
				(range == VALUE_ANY || number > 0 || (range == VALUE_NOT_NEGATIVE && number == 0));
	char shown[TEXT_SHOWN];
	if (!fits)
		return scene_file_refuse(file, error, key, "'%s'; accepted: %s", text_shown(shown, word), accepted[range]);
	*value = number;
	return true;
}

bool value_count(const struct scene_file *file, const char *key, const char *word, uint64_t least, uint64_t most,
				 uint64_t *value, char *error)
{
	if (!word) return true;
	uint64_t count;
	char shown[TEXT_SHOWN];
	if (!text_count(word, &count) || count < least || count > most)
		return scene_file_refuse(file, error, key, "'%s'; accepted: a whole number, %llu to %llu",
								 text_shown(shown, word), (unsigned long long)least, (unsigned long long)most);
	*value = count;
	return true;
}

bool value_length(const struct scene_file *file, const char *key, unsigned count, bool one_for_all, char *error)
{
	int dimensions = file->recipe.dimensions;
	if ((int)count == dimensions || (one_for_all && count == 1)) return true;
	return scene_file_refuse(file, error, key, "%u entries; accepted: %d, the dimensions%s", count, dimensions,
							 one_for_all ? ", or one for all" : "");
}

bool value_vector(const struct scene_file *file, const char *key, char **words, unsigned count, bool one_for_all,
				  enum value_range range, double vector[3], char *error)
{
	if (!words) return true;
	if (!value_length(file, key, count, one_for_all, error)) return false;
	for (int axis = 0; axis < file->recipe.dimensions; axis++) {
		unsigned entry = count == 1 ? 0 : (unsigned)axis;
		char path[YAML_PATH];
		snprintf(path, sizeof path, "%.90s[%u]", key, entry);
		if (!value_number(file, path, words[entry], range, &vector[axis], error)) return false;
	}
	return true;
}

bool value_restitution(const struct scene_file *file, const char *key, const char *word,
					   struct touchstone_restitution *restitution, char *error)
{
	static const char law[] = "viscoelastic ";
	*restitution = (struct touchstone_restitution){TOUCHSTONE_CONSTANT, 1};
	if (!word) return true;
	bool viscoelastic = strncmp(word, law, strlen(law)) == 0;
	if (viscoelastic) restitution->law = TOUCHSTONE_VISCOELASTIC;
	double *coefficient = &restitution->coefficient;
	bool fits = text_number(word + (viscoelastic ? strlen(law) : 0), coefficient) && *coefficient >= 0 &&
				(viscoelastic || *coefficient <= 1);
	char shown[TEXT_SHOWN];
	return fits ||
		   scene_file_refuse(file, error, key,
							 "'%s'; accepted: a coefficient, 0 to 1, or 'viscoelastic BETA' with BETA 0 or more",
							 text_shown(shown, word));
}

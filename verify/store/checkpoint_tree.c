#include "store/checkpoint_tree.h"

#include <hdf5.h>
#include <stdlib.h>
#include <string.h>

static const size_t image_grows = 1 << 24, chunk_bytes = 1 << 20; /* chunks of what a processor's cache holds */

/* Files that live in memory. */
static hid_t memory_access(const void *image, size_t size)
{
	hid_t access = H5Pcreate(H5P_FILE_ACCESS);
	bool can = H5Pset_fapl_core(access, image_grows, false) >= 0;
	if (can && image) can = H5Pset_file_image(access, (void *)image, size) >= 0;
	if (can) return access;
	H5Pclose(access);
	return H5I_INVALID_HID;
}

/* How a field lies in a file and in memory alike. */
static hid_t type_of(const struct touchstone_snapshot *snapshot, enum touchstone_content content)
{
	switch (content) {
	case TOUCHSTONE_NUMBERS:
		return snapshot->doubles ? H5T_IEEE_F64LE : H5T_STD_U64LE;
	case TOUCHSTONE_DOUBLES:
		return H5T_IEEE_F64LE;
	case TOUCHSTONE_COUNTS:
		return H5T_STD_U64LE;
	case TOUCHSTONE_INTEGERS:
		return H5T_STD_I32LE;
	default:
		return H5T_STD_U8LE;
	}
}

/* ------------------------------------------------------------------ writing */

static bool write_attribute(hid_t object, const char *name, hid_t type, const void *value)
{
	hid_t space = H5Screate(H5S_SCALAR), attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
	bool written = attribute >= 0 && H5Awrite(attribute, type, value) >= 0;
	if (attribute >= 0) H5Aclose(attribute);
	H5Sclose(space);
	return written;
}

static hid_t text_type(void)
{
	hid_t type = H5Tcopy(H5T_C_S1);
	H5Tset_size(type, CHECKPOINT_NAME);
	return type;
}

static bool write_text(hid_t object, const char *name, const char text[CHECKPOINT_NAME])
{
	hid_t type = text_type();
	bool written = write_attribute(object, name, type, text);
	H5Tclose(type);
	return written;
}

/* How a dataset is laid out: in chunks with checksums, and the same bytes for the same content. */
static hid_t layout_of(int rank, const hsize_t size[3], size_t bytes)
{
	hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
	bool can = H5Pset_obj_track_times(layout, false) >= 0;
	if (bytes > 0) {
		hsize_t chunk[3] = {chunk_bytes / (bytes / size[0]), size[1], size[2]};
		chunk[0] = chunk[0] < 1 ? 1 : chunk[0] > size[0] ? size[0] : chunk[0];
		can = can && H5Pset_chunk(layout, rank, chunk) >= 0 && H5Pset_fletcher32(layout) >= 0;
	}
	if (can) return layout;
	H5Pclose(layout);
	return H5I_INVALID_HID;
}

static bool write_field(hid_t group, const struct touchstone_snapshot *snapshot, const struct touchstone_field *field)
{
	bool numbers = field->content == TOUCHSTONE_NUMBERS;
	hsize_t size[3] = {field->rows, field->columns, numbers ? (hsize_t)snapshot->words : 1};
	int rank = numbers ? 3 : 2, content = (int)field->content;
	hid_t type = type_of(snapshot, field->content), space = H5Screate_simple(rank, size, NULL);
	hid_t layout = layout_of(rank, size, touchstone_field_bytes(snapshot, field)), set = H5I_INVALID_HID;
	if (layout >= 0) set = H5Dcreate2(group, field->name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
	bool written = set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, field->data) >= 0 &&
				   write_attribute(set, "content", H5T_NATIVE_INT, &content);
	if (set >= 0) H5Dclose(set);
	if (layout >= 0) H5Pclose(layout);
	H5Sclose(space);
	return written;
}

static bool write_group(hid_t file, const char *name, const struct touchstone_snapshot *snapshot)
{
	hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
	int doubles = snapshot->doubles;
	bool written = group >= 0 && write_attribute(group, "words", H5T_NATIVE_INT, &snapshot->words) &&
				   write_attribute(group, "doubles", H5T_NATIVE_INT, &doubles);
	for (size_t f = 0; written && f < snapshot->count; f++) written = write_field(group, snapshot, &snapshot->field[f]);
	if (group >= 0) H5Gclose(group);
	return written;
}

static bool write_all(hid_t file, const struct checkpoint *checkpoint)
{
	return write_text(file, "program", checkpoint->program) && write_text(file, "scene", checkpoint->scene) &&
		   write_text(file, "arithmetic", checkpoint->arithmetic) && write_text(file, "method", checkpoint->method) &&
		   write_attribute(file, "seed", H5T_NATIVE_UINT64, &checkpoint->seed) &&
		   write_attribute(file, "identity", H5T_NATIVE_UINT64, &checkpoint->identity) &&
		   write_attribute(file, "state_version", H5T_NATIVE_UINT64, &checkpoint->state_version) &&
		   write_group(file, "state", &checkpoint->state) && write_group(file, "run", &checkpoint->run);
}

static void *image_of(hid_t file, size_t *size)
{
	ssize_t bytes = H5Fflush(file, H5F_SCOPE_LOCAL) >= 0 ? H5Fget_file_image(file, NULL, 0) : -1;
	void *image = bytes > 0 ? malloc((size_t)bytes) : NULL;
	if (image && H5Fget_file_image(file, image, (size_t)bytes) != bytes) {
		free(image);
		image = NULL;
	}
	*size = (size_t)bytes;
	return image;
}

void *checkpoint_tree_make(const struct checkpoint *checkpoint, size_t *size)
{
	H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* what went wrong is told in our own words */
	hid_t access = memory_access(NULL, 0), file = H5I_INVALID_HID;
	if (access >= 0) file = H5Fcreate("checkpoint", H5F_ACC_TRUNC, H5P_DEFAULT, access);
	void *image = file >= 0 && write_all(file, checkpoint) ? image_of(file, size) : NULL;
	if (file >= 0) H5Fclose(file);
	if (access >= 0) H5Pclose(access);
	return image;
}

/* ------------------------------------------------------------------ reading */

static bool read_attribute(hid_t object, const char *name, hid_t type, void *value)
{
	hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
	if (attribute < 0) return false;
	hid_t space = H5Aget_space(attribute), kept = H5Aget_type(attribute);
	bool alike = H5Sget_simple_extent_type(space) == H5S_SCALAR && H5Tget_class(kept) == H5Tget_class(type);
	bool read = alike && H5Aread(attribute, type, value) >= 0;
	H5Tclose(kept);
	H5Sclose(space);
	H5Aclose(attribute);
	return read;
}

static bool read_text(hid_t object, const char *name, char text[CHECKPOINT_NAME])
{
	hid_t type = text_type();
	bool read = read_attribute(object, name, type, text);
	text[CHECKPOINT_NAME - 1] = '\0';
	H5Tclose(type);
	return read;
}

/* Reads a dataset that was opened into the next field. */
static bool read_field(hid_t set, const char *name, struct touchstone_snapshot *snapshot)
{
	struct touchstone_field *field = &snapshot->field[snapshot->count];
	hsize_t size[3] = {0};
	int content;
	if (strlen(name) >= sizeof field->name || !read_attribute(set, "content", H5T_NATIVE_INT, &content)) return false;
	if (content < 0 || content > TOUCHSTONE_BYTES) return false;
	strcpy(field->name, name);
	field->content = (enum touchstone_content)content;
	bool numbers = field->content == TOUCHSTONE_NUMBERS;
	hid_t space = H5Dget_space(set), kept = H5Dget_type(set), type = type_of(snapshot, field->content);
	bool alike = H5Sget_simple_extent_ndims(space) == (numbers ? 3 : 2) && H5Tequal(kept, type) > 0;
	if (alike) H5Sget_simple_extent_dims(space, size, NULL);
	field->rows = size[0], field->columns = size[1];
	if (alike && numbers) alike = size[2] == (hsize_t)snapshot->words;
	if (alike) field->data = malloc(touchstone_field_bytes(snapshot, field) + 1);
	snapshot->count += field->data != NULL;
	bool read = field->data && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, field->data) >= 0;
	H5Tclose(kept);
	H5Sclose(space);
	return read;
}

static herr_t read_link(hid_t group, const char *name, const H5L_info_t *info, void *snapshot)
{
	(void)info;
	if (((struct touchstone_snapshot *)snapshot)->count == TOUCHSTONE_MOST_FIELDS) return -1;
	hid_t set = H5Dopen2(group, name, H5P_DEFAULT);
	if (set < 0) return -1;
	bool read = read_field(set, name, snapshot);
	H5Dclose(set);
	return read ? 0 : -1;
}

static bool read_group(hid_t file, const char *name, struct touchstone_snapshot *snapshot)
{
	hid_t group = H5Gopen2(file, name, H5P_DEFAULT);
	if (group < 0) return false;
	int doubles;
	bool read = read_attribute(group, "words", H5T_NATIVE_INT, &snapshot->words) &&
				read_attribute(group, "doubles", H5T_NATIVE_INT, &doubles) && snapshot->words > 0;
	if (read) snapshot->doubles = doubles;
	read = read && H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, read_link, snapshot) >= 0;
	H5Gclose(group);
	return read;
}

static bool read_all(hid_t file, struct checkpoint *checkpoint)
{
	return read_attribute(file, "state_version", H5T_NATIVE_UINT64, &checkpoint->state_version) &&
		   read_text(file, "program", checkpoint->program) && read_text(file, "scene", checkpoint->scene) &&
		   read_text(file, "arithmetic", checkpoint->arithmetic) && read_text(file, "method", checkpoint->method) &&
		   read_attribute(file, "seed", H5T_NATIVE_UINT64, &checkpoint->seed) &&
		   read_attribute(file, "identity", H5T_NATIVE_UINT64, &checkpoint->identity) &&
		   read_group(file, "state", &checkpoint->state) && read_group(file, "run", &checkpoint->run);
}

bool checkpoint_tree_read(const void *image, size_t size, struct checkpoint *checkpoint)
{
	H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
	hid_t access = memory_access(image, size), file = H5I_INVALID_HID;
	if (access >= 0) file = H5Fopen("checkpoint", H5F_ACC_RDONLY, access);
	bool read = file >= 0 && read_all(file, checkpoint);
	if (file >= 0) H5Fclose(file);
	if (access >= 0) H5Pclose(access);
	return read;
}

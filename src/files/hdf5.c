#include "files/hdf5.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_COMPRESSION 1100.0 /* bytes that one stored byte can stand for: 1032 at most with HDF5's deflate */

/* --- errors ------------------------------------------------------------------------------------------------------ */

struct reason {
  char *text;
  size_t size;
};

static herr_t take_innermost(unsigned n, const H5E_error2_t *error, void *context)
{
  const struct reason *reason = context;
  if (n > 0 || !error->desc)
    return 0;
  /* Of a failed read or write HDF5 tells the time of day and all arguments; the system's own words are enough. */
  const char *rest = strstr(error->desc, ": time = "), *quoted = rest ? strstr(rest, "error message = '") : NULL;
  if (quoted)
    quoted += strlen("error message = '");
  if (quoted)
    snprintf(reason->text, reason->size, "%.*s: %.*s", (int)(rest - error->desc), error->desc,
             (int)strcspn(quoted, "'"), quoted);
  else
    snprintf(reason->text, reason->size, "%s", error->desc);
  return 0;
}

void h5_reason(char *text, size_t size)
{
  snprintf(text, size, "unknown HDF5 error");
  struct reason reason = {text, size};
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_innermost, &reason);
  H5Eclear2(H5E_DEFAULT);
}

int h5_fail(struct message *message, const char *path, const char *doing)
{
  char reason[256];
  const bool known = H5Eget_num(H5E_DEFAULT) > 0;
  h5_reason(reason, sizeof reason);
  return message_set(message, "%s: %s%s%s", path, doing, known ? ": " : "", known ? reason : "");
}

static herr_t count_failure(hid_t stack, void *context)
{
  unsigned *failures = context;
  (void)stack;
  ++*failures;
  return 0;
}

void h5_watch(unsigned *failures)
{
  *failures = 0;
  H5Eset_auto2(H5E_DEFAULT, count_failure, failures);
}

void h5_own_process(void)
{
  H5dont_atexit();
}

static bool close_any(hid_t handle)
{
  switch (H5Iget_type(handle)) {
  case H5I_FILE:
    return H5Fclose(handle) >= 0;
  case H5I_GENPROP_LST:
    return H5Pclose(handle) >= 0;
  case H5I_DATASPACE:
    return H5Sclose(handle) >= 0;
  case H5I_DATATYPE:
    return H5Tclose(handle) >= 0;
  case H5I_ATTR:
    return H5Aclose(handle) >= 0;
  default:
    return H5Oclose(handle) >= 0;
  }
}

/* Every call of the library forgets the errors of the one before; those of a failure must outlive the tidying up. */
bool h5_close(hid_t handle)
{
  if (handle < 0)
    return true;
  hid_t errors = H5Eget_current_stack();
  bool ok = close_any(handle);
  if (ok && H5Eget_num(errors) > 0)
    H5Eset_current_stack(errors);
  else
    H5Eclose_stack(errors);
  return ok;
}

/* --- objects ----------------------------------------------------------------------------------------------------- */

hid_t h5_group(hid_t parent, const char *name)
{
  hid_t creation = H5Pcreate(H5P_GROUP_CREATE);
  H5Pset_obj_track_times(creation, false);
  hid_t group = H5Gcreate2(parent, name, H5P_DEFAULT, creation, H5P_DEFAULT);
  h5_close(creation);
  return group;
}

int h5_refuse(const char *why)
{
  H5Eclear2(H5E_DEFAULT);
  H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_FILE, H5E_BADVALUE, "%s", why);
  return -1;
}

/* Asked before anything of the dataset is read: its shape, of a virtual one, is already that of other files. */
static bool data_are_here(hid_t dataset)
{
  hid_t creation = H5Dget_create_plist(dataset);
  const H5D_layout_t layout = creation < 0 ? H5D_LAYOUT_ERROR : H5Pget_layout(creation);
  const int others = layout == H5D_CONTIGUOUS ? H5Pget_external_count(creation) : 0;
  h5_close(creation);
  if (layout == H5D_VIRTUAL || others > 0)
    h5_refuse(layout == H5D_VIRTUAL ? "a virtual dataset, whose numbers are in other files"
                                    : "external storage: the numbers are in another file");
  return layout >= 0 && layout != H5D_VIRTUAL && others == 0;
}

hid_t h5_open_object(hid_t parent, const char *name)
{
  if (parent < 0 || h5_look(parent, name) <= 0)
    return -1;
  hid_t object = H5Oopen(parent, name, H5P_DEFAULT);
  if (object < 0 || H5Iget_type(object) != H5I_DATASET || data_are_here(object))
    return object;
  h5_close(object);
  return -1;
}

static hid_t open_sort(hid_t parent, const char *name, H5I_type_t sort)
{
  hid_t object = h5_open_object(parent, name);
  if (object < 0 || H5Iget_type(object) == sort)
    return object;
  h5_close(object);
  return -1;
}

hid_t h5_open_group(hid_t parent, const char *name)
{
  return open_sort(parent, name, H5I_GROUP);
}

hid_t h5_open_dataset(hid_t parent, const char *name)
{
  return open_sort(parent, name, H5I_DATASET);
}

static hid_t little_endian(hid_t type)
{
  hid_t copy = H5Tcopy(type);
  H5T_class_t class = H5Tget_class(type);
  if (class == H5T_INTEGER || class == H5T_FLOAT)
    H5Tset_order(copy, H5T_ORDER_LE);
  return copy;
}

hid_t h5_dataset(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *dims, bool grows, hsize_t chunk)
{
  hsize_t most[4], chunks[4];
  for (int k = 0; k < rank; k++)
    most[k] = chunks[k] = dims[k];
  hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(creation, false);
  if (grows) {
    /* Fill values, so that the unused rows of a last chunk are zeros and not whatever was in memory. */
    H5Pset_fill_time(creation, H5D_FILL_TIME_ALLOC);
    most[0] = H5S_UNLIMITED;
    chunks[0] = chunk;
    H5Pset_chunk(creation, rank, chunks);
  }
  hid_t space = rank > 0 ? H5Screate_simple(rank, dims, most) : H5Screate(H5S_SCALAR);
  hid_t stored = little_endian(type);
  hid_t dataset = H5Dcreate2(parent, name, stored, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  h5_close(stored);
  h5_close(space);
  h5_close(creation);
  return dataset;
}

/* Whether the file holds, perhaps compressed, as many bytes as the shape claims. */
static bool is_stored(hid_t dataset, int rank, const hsize_t *dims)
{
  hid_t type = H5Dget_type(dataset);
  const double most = MOST_COMPRESSION * (double)H5Dget_storage_size(dataset);
  double bytes = type < 0 ? HUGE_VAL : (double)H5Tget_size(type);
  for (int k = 0; k < rank; k++)
    bytes *= (double)dims[k];
  h5_close(type);
  return bytes <= most || (h5_refuse("a shape of more numbers than the file holds"), false);
}

int h5_shape(hid_t dataset, int most, hsize_t *dims)
{
  if (dataset < 0)
    return -1;
  hid_t space = H5Dget_space(dataset);
  int rank = space < 0 ? -1 : H5Sget_simple_extent_ndims(space);
  bool readable = rank >= 0 && (rank > most || rank == 0 || H5Sget_simple_extent_dims(space, dims, NULL) >= 0);
  readable = readable && (rank > most || is_stored(dataset, rank, dims));
  h5_close(space);
  return !readable ? -2 : rank > most ? -1 : rank;
}

int h5_look(hid_t parent, const char *name)
{
  if (H5Iget_type(parent) == H5I_DATASET)
    return 0;
  H5L_info_t link;
  int found = H5Lexists(parent, name, H5P_DEFAULT);
  if (found <= 0)
    return found;
  if (H5Lget_info(parent, name, &link, H5P_DEFAULT) < 0)
    return -1;
  if (link.type != H5L_TYPE_HARD && link.type != H5L_TYPE_SOFT)
    return h5_refuse("a link to another file, which is not followed");
  return H5Oexists_by_name(parent, name, H5P_DEFAULT);
}

bool h5_has(hid_t parent, const char *name)
{
  bool has = h5_look(parent, name) > 0;
  H5Eclear2(H5E_DEFAULT);
  return has;
}

/* --- attributes -------------------------------------------------------------------------------------------------- */

bool h5_put(hid_t object, const char *name, hid_t type, size_t count, const void *data)
{
  hsize_t dims[1] = {count};
  hid_t space = count ? H5Screate_simple(1, dims, NULL) : H5Screate(H5S_SCALAR);
  hid_t stored = little_endian(type);
  hid_t attribute = H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT);
  bool ok = attribute >= 0 && H5Awrite(attribute, type, data) >= 0;
  h5_close(attribute);
  h5_close(stored);
  h5_close(space);
  return ok;
}

bool h5_get(hid_t object, const char *name, hid_t type, size_t count, void *data)
{
  hid_t attribute = H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
  hid_t space = attribute < 0 ? -1 : H5Aget_space(attribute);
  bool ok = space >= 0 && H5Sget_simple_extent_npoints(space) == (hssize_t)(count ? count : 1) &&
            H5Aread(attribute, type, data) >= 0;
  h5_close(space);
  h5_close(attribute);
  return ok;
}

hid_t h5_text_type(size_t length)
{
  hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, length + 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

bool h5_put_text(hid_t object, const char *name, const char *text)
{
  hid_t type = h5_text_type(strlen(text));
  bool ok = h5_put(object, name, type, 0, text);
  h5_close(type);
  return ok;
}

/* Texts written by others may be of variable length, which HDF5 does not convert to ours. */
static bool get_variable_text(hid_t attribute, hid_t stored, char *text, size_t size)
{
  char *value = NULL;
  hid_t type = H5Tcopy(stored);
  bool ok = H5Aread(attribute, type, &value) >= 0 && value && strlen(value) < size;
  if (ok)
    snprintf(text, size, "%s", value);
  H5free_memory(value);
  h5_close(type);
  return ok;
}

bool h5_get_text(hid_t object, const char *name, char *text, size_t size)
{
  hid_t attribute = H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
  hid_t stored = attribute < 0 ? -1 : H5Aget_type(attribute);
  hid_t space = attribute < 0 ? -1 : H5Aget_space(attribute);
  bool ok = stored >= 0 && H5Tget_class(stored) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1;
  if (ok && H5Tis_variable_str(stored) > 0) {
    ok = get_variable_text(attribute, stored, text, size);
  } else if (ok) {
    ok = H5Tget_size(stored) <= size && H5Aread(attribute, stored, text) >= 0;
    if (ok)
      text[H5Tget_size(stored) < size ? H5Tget_size(stored) : size - 1] = '\0';
  }
  h5_close(space);
  h5_close(stored);
  h5_close(attribute);
  return ok;
}

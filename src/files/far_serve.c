/* The side that answers: what HDF5 says of a file, object by object. */
#include "files/far.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files/reader.h"

#define KEPT 24 /* objects that stay open: more than a path has parts */

struct served {
  hid_t file;
  unsigned failures, turn;
  struct {
    char path[FAR_PATH];
    hid_t object; /* 0: none yet */
  } kept[KEPT];
};

/* Into *object, which stays open for a while; as h5_look: 1, or 0 if there is none, -1 if it cannot be read. */
static int find(struct served *s, const char *path, hid_t *object)
{
  char in[FAR_PATH];
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
  for (size_t k = 0; k < KEPT; k++)
    if (s->kept[k].object > 0 && strcmp(s->kept[k].path, path) == 0) {
      *object = s->kept[k].object;
      return 1;
    }
  *object = s->file;
  if (!*path)
    return 1;
  snprintf(in, sizeof in, "%.*s", slash ? (int)(slash - path) : 0, path);
  hid_t parent;
  int found = find(s, in, &parent); /* as deep as the path is, which this program makes */
  found = found > 0 ? h5_look(parent, name) : found;
  if (found <= 0)
    return found < 0 ? -1 : 0;
  *object = h5_open_object(parent, name);
  if (*object < 0)
    return -1;
  const unsigned at = s->turn++ % KEPT;
  if (s->kept[at].object > 0)
    h5_close(s->kept[at].object);
  s->kept[at].object = *object;
  snprintf(s->kept[at].path, FAR_PATH, "%s", path);
  return 1;
}

/* --- objects ----------------------------------------------------------------------------------------------------- */

static enum far_class class_of(hid_t type)
{
  switch (type < 0 ? H5T_NO_CLASS : H5Tget_class(type)) {
  case H5T_FLOAT:
    return FAR_REALS;
  case H5T_INTEGER:
    return FAR_INTEGERS;
  case H5T_ENUM:
    return FAR_ENUMERATION;
  case H5T_STRING:
    return H5Tis_variable_str(type) == 0 ? FAR_TEXTS : FAR_STRANGE;
  default:
    return FAR_STRANGE;
  }
}

static struct far_thing look_at(hid_t object)
{
  struct far_thing thing = {.kind = FAR_OTHER};
  H5G_info_t info = {.nlinks = 0};
  const H5I_type_t is = H5Iget_type(object);
  if (is == H5I_GROUP || is == H5I_FILE) {
    thing.kind = H5Gget_info(object, &info) >= 0 ? FAR_GROUP : FAR_BROKEN;
    thing.links = info.nlinks;
  } else if (is == H5I_DATASET) {
    hsize_t dims[FAR_RANK] = {0};
    const hid_t type = H5Dget_type(object);
    thing.kind = FAR_DATASET;
    thing.class = class_of(type);
    thing.size = type < 0 ? 0 : H5Tget_size(type);
    thing.links = thing.class == FAR_ENUMERATION ? (uint64_t)H5Tget_nmembers(type) : 0;
    thing.rank = h5_shape(object, FAR_RANK, dims);
    for (int k = 0; k < thing.rank; k++)
      thing.dims[k] = dims[k];
    h5_close(type);
  }
  return thing;
}

static bool read_link(hid_t group, const struct far_question *q, char *name)
{
  const ssize_t length =
      H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, q->row, name, (size_t)q->bytes, H5P_DEFAULT);
  return length > 0 && (uint64_t)length < q->bytes;
}

static hid_t type_of(uint64_t type)
{
  const hid_t types[FAR_NUMBERS] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_INT64, H5T_NATIVE_INT32, H5T_NATIVE_UINT64,
                                    H5T_NATIVE_UINT32};
  return types[type];
}

static bool read_all(hid_t dataset, const struct far_question *q, void *data)
{
  const hsize_t dims[FAR_RANK] = {q->dims[0], q->dims[1], q->dims[2], q->dims[3]};
  const hid_t type = q->type == FAR_TEXT ? H5Dget_type(dataset) : H5Tcopy(type_of(q->type));
  const bool ok = type >= 0 && (q->type != FAR_TEXT || H5Tget_size(type) == q->bytes) &&
                  h5_array_read(dataset, type, (int)q->rank, dims, q->row == FAR_ALL, data);
  h5_close(type);
  return ok;
}

static bool read_row(hid_t dataset, const struct far_question *q, void *data)
{
  hsize_t count[FAR_RANK], start[FAR_RANK] = {q->row};
  const int rank = (int)q->rank;
  if (h5_shape(dataset, FAR_RANK, count) != rank || q->row >= count[0])
    return false;
  count[0] = 1;
  for (int k = 1; k < rank; k++)
    if (count[k] != q->dims[k])
      return false;
  const hid_t space = H5Dget_space(dataset), memory = H5Screate_simple(rank, count, NULL);
  const bool ok = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
                  H5Dread(dataset, type_of(q->type), memory, space, H5P_DEFAULT, data) >= 0;
  h5_close(memory);
  h5_close(space);
  return ok;
}

/* The names of an enumeration of 32 bits, as we write them, whose values count from 0; others have them in the order of
 * names. */
static bool read_names(hid_t dataset, const struct far_question *q, char *names)
{
  const hid_t type = H5Dget_type(dataset);
  const int members = class_of(type) == FAR_ENUMERATION ? H5Tget_nmembers(type) : 0;
  const size_t size = members > 0 ? (size_t)q->bytes / (size_t)members : 0;
  bool ok = type >= 0 && (members == 0 || H5Tget_size(type) == sizeof(int32_t));
  for (int k = 0; ok && k < members; k++) {
    int32_t value = -1;
    char *name = H5Tget_member_name(type, (unsigned)k);
    ok = name && H5Tget_member_value(type, (unsigned)k, &value) >= 0 && value >= 0 && value < members;
    if (ok)
      snprintf(names + (size_t)value * size, size, "%s", name);
    H5free_memory(name);
  }
  h5_close(type);
  return ok;
}

/* --- attributes -------------------------------------------------------------------------------------------------- */

/* The values of an attribute of texts, each at most so long, one after the other; false if one is longer. */
static bool take_texts(hid_t attribute, hid_t stored, size_t count, size_t size, char *text)
{
  const bool variable = H5Tis_variable_str(stored) > 0;
  const size_t each = variable ? sizeof(char *) : H5Tget_size(stored) + 1;
  const hid_t type = H5Tcopy(variable ? stored : H5T_C_S1); /* HDF5 converts no variable length */
  if (!variable && (H5Tset_size(type, each) < 0 || H5Tset_cset(type, H5Tget_cset(stored)) < 0)) {
    h5_close(type);
    return false;
  }
  char *values = calloc(count, each);
  bool ok = values && H5Aread(attribute, type, values) >= 0;
  for (size_t k = 0; values && k < count; k++) {
    char *value = variable ? ((char **)(void *)values)[k] : values + k * each;
    ok = ok && value && (size_t)snprintf(text + k * size, size, "%s", value) < size;
    if (variable)
      H5free_memory(value);
  }
  free(values);
  h5_close(type);
  return ok;
}

static bool read_texts(hid_t object, const struct far_question *q, char *text)
{
  const size_t count = q->dims[0] ? (size_t)q->dims[0] : 1;
  const hid_t attribute = H5Aopen(object, q->attribute, H5P_DEFAULT);
  const hid_t stored = attribute < 0 ? -1 : H5Aget_type(attribute),
              space = attribute < 0 ? -1 : H5Aget_space(attribute);
  const bool ok = stored >= 0 && H5Tget_class(stored) == H5T_STRING &&
                  H5Sget_simple_extent_npoints(space) == (hssize_t)count &&
                  take_texts(attribute, stored, count, (size_t)q->bytes / count, text);
  h5_close(space);
  h5_close(stored);
  h5_close(attribute);
  return ok;
}

/* --- answers ----------------------------------------------------------------------------------------------------- */

static bool read_into(hid_t object, const struct far_question *q, void *data)
{
  if (q->attribute[0])
    return q->type == FAR_TEXT ? read_texts(object, q, data)
                               : h5_get(object, q->attribute, type_of(q->type), (size_t)q->dims[0], data);
  if (q->type == FAR_LINK)
    return read_link(object, q, data);
  if (H5Iget_type(object) != H5I_DATASET)
    return false;
  if (q->type == FAR_NAMES)
    return read_names(object, q, data);
  return (q->row >= FAR_PLAIN ? read_all : read_row)(object, q, data);
}

static void answer(struct apart *link, struct served *s, const struct far_question *q)
{
  struct far_answer a = {.reason = ""};
  hid_t object;
  H5Eclear2(H5E_DEFAULT);
  a.found = find(s, q->path, &object);
  if (a.found > 0 && q->attribute[0])
    a.found = H5Aexists(object, q->attribute);
  errno = 0;
  void *data = a.found > 0 ? calloc((size_t)q->bytes + 1, 1) : NULL;
  if (data && q->type == FAR_THING)
    *(struct far_thing *)data = look_at(object);
  else if (a.found > 0 && !(data && read_into(object, q, data))) {
    a.no_memory = errno == ENOMEM;
    a.found = -1;
  }
  a.failures = s->failures;
  if (H5Eget_num(H5E_DEFAULT) > 0)
    h5_reason(a.reason, sizeof a.reason);
  if (apart_put(link, &a, sizeof a) && a.found > 0)
    apart_put(link, data, (size_t)q->bytes);
  free(data);
}

/* The file is not closed: HDF5 may fail once more there, and the process ends anyway. */
void far_serve(struct apart *link)
{
  struct served s = {.turn = 0};
  struct message message = {.text = ""};
  struct far_question q;
  enum h5_trouble trouble;
  bool sealed = false;
  s.file = h5_open(link->path, false, &sealed, &trouble, &message);
  apart_shut();
  const uint64_t told = sealed;
  apart_put_verdict(link, (int)trouble, &message);
  if (trouble == H5_FINE && apart_put(link, &told, sizeof told))
    h5_watch(&s.failures);
  while (trouble == H5_FINE && apart_get(link, &q, sizeof q)) {
    apart_go_on(link);
    answer(link, &s, &q);
  }
}

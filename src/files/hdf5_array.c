/* Whole datasets, with the hash of their data. */
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "files/hdf5.h"

#define HASH_NAME "xxh64"

static uint64_t hash_of(hid_t type, int rank, const hsize_t *dims, const void *data)
{
  size_t bytes = H5Tget_size(type);
  for (int k = 0; k < rank; k++)
    bytes *= (size_t)dims[k];
  return XXH64(data, bytes, 0);
}

bool h5_array_write(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *dims, const void *data)
{
  hid_t dataset = h5_dataset(parent, name, type, rank, dims, false, 0);
  uint64_t hash = hash_of(type, rank, dims, data);
  bool ok = dataset >= 0 && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0 &&
            h5_put(dataset, HASH_NAME, H5T_NATIVE_UINT64, 0, &hash);
  h5_close(dataset);
  return ok;
}

static bool same_class(hid_t dataset, hid_t type)
{
  hid_t stored = H5Dget_type(dataset);
  H5T_class_t is = stored < 0 ? H5T_NO_CLASS : H5Tget_class(stored), wanted = H5Tget_class(type);
  h5_close(stored);
  return is == wanted || (wanted == H5T_INTEGER && is == H5T_ENUM);
}

static bool has_shape(hid_t dataset, int rank, const hsize_t *dims)
{
  hsize_t found[4];
  bool same = dataset >= 0 && h5_shape(dataset, 4, found) == rank;
  for (int k = 0; same && k < rank; k++)
    same = found[k] == dims[k];
  return same;
}

bool h5_array_is(hid_t parent, const char *name, int rank, const hsize_t *dims)
{
  hid_t dataset = h5_open_dataset(parent, name);
  const bool is = has_shape(dataset, rank, dims);
  h5_close(dataset);
  return is;
}

bool h5_array_read(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *dims, void *data)
{
  hid_t dataset = h5_open_dataset(parent, name);
  bool ok = has_shape(dataset, rank, dims) && same_class(dataset, type);
  ok = ok && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
  const htri_t hashed = ok ? H5Aexists(dataset, HASH_NAME) : 0;
  if (hashed != 0) {
    uint64_t hash;
    ok = hashed > 0 && h5_get(dataset, HASH_NAME, H5T_NATIVE_UINT64, 0, &hash) &&
         (hash == hash_of(type, rank, dims, data) || (h5_refuse("its numbers do not fit their checksum"), false));
  }
  h5_close(dataset);
  return ok;
}

bool h5_text_write(hid_t parent, const char *name, const char *text)
{
  hid_t type = h5_text_type(strlen(text));
  bool ok = h5_array_write(parent, name, type, 0, NULL, text);
  h5_close(type);
  return ok;
}

char *h5_text_read(hid_t parent, const char *name)
{
  hsize_t none[1];
  hid_t dataset = h5_open_dataset(parent, name);
  hid_t stored = h5_shape(dataset, 0, none) != 0 ? -1 : H5Dget_type(dataset);
  char *text = NULL;
  errno = 0;
  if (stored >= 0 && H5Tget_class(stored) == H5T_STRING && H5Tis_variable_str(stored) == 0) {
    size_t size = H5Tget_size(stored);
    text = calloc(size + 1, 1);
    if (text && !h5_array_read(parent, name, stored, 0, NULL, text)) {
      free(text);
      text = NULL;
    }
  }
  h5_close(stored);
  h5_close(dataset);
  return text;
}

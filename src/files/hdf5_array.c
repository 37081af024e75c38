/* Whole datasets, with the hash of their data. */
#include <stdint.h>
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

static bool has_shape(hid_t dataset, int rank, const hsize_t *dims)
{
  hsize_t found[4];
  bool same = h5_shape(dataset, 4, found) == rank;
  for (int k = 0; same && k < rank; k++)
    same = found[k] == dims[k];
  return same;
}

bool h5_array_read(hid_t dataset, hid_t type, int rank, const hsize_t *dims, bool hashed, void *data)
{
  bool ok = has_shape(dataset, rank, dims);
  ok = ok && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
  const htri_t has = ok && hashed ? H5Aexists(dataset, HASH_NAME) : 0;
  if (has != 0) {
    uint64_t hash;
    ok = has > 0 && h5_get(dataset, HASH_NAME, H5T_NATIVE_UINT64, 0, &hash) &&
         (hash == hash_of(type, rank, dims, data) || (h5_refuse("its numbers do not fit their checksum"), false));
  }
  return ok;
}

bool h5_text_write(hid_t parent, const char *name, const char *text)
{
  hid_t type = h5_text_type(strlen(text));
  bool ok = h5_array_write(parent, name, type, 0, NULL, text);
  h5_close(type);
  return ok;
}

/* Packs as HDF5. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "io/hdf5.h"
#include "oracle/pack.h"
#include "oracle/pack_text.h"

/* --- writing ----------------------------------------------------------------------------------------------------- */

static void group_name(const struct pack_place *place, char *name, size_t size)
{
  snprintf(name, size, "%s.%" PRIu64, place->operator_name, place->step);
}

static bool write_table(hid_t group, const struct pack_table *t)
{
  char words[PACK_COLUMNS * PACK_WORD] = "";
  for (uint32_t k = 0; k < t->columns; k++)
    snprintf(words + strlen(words), sizeof words - strlen(words), "%s%s", k ? " " : "", t->component[k]);
  const hsize_t dims[2] = {t->rows, t->columns};
  bool ok = h5_array_write(group, t->name, t->real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64, 2, dims, t->value.data);
  hid_t dataset = ok ? H5Dopen2(group, t->name, H5P_DEFAULT) : -1;
  ok = dataset >= 0 && h5_put_text(dataset, "components", words);
  h5_close(dataset);
  return ok;
}

static bool write_tables(hid_t file, const struct pack *pack)
{
  const int version = PACK_VERSION;
  bool ok = h5_put_text(file, "format", PACK_FORMAT) && h5_put(file, "version", H5T_NATIVE_INT, 0, &version);
  for (size_t k = 0; ok && k < pack->count; k++) {
    char name[2 * PACK_WORD];
    group_name(&pack->table[k].place, name, sizeof name);
    hid_t group = h5_has(file, name) ? h5_open_group(file, name) : h5_group(file, name);
    ok = group >= 0 && write_table(group, &pack->table[k]);
    h5_close(group);
  }
  return ok;
}

/* The bytes of the file, made in memory, so that a full disk never reaches HDF5; to be freed. */
static void *image_of(const struct pack *pack, size_t *bytes)
{
  hid_t file = h5_create_in_memory(1 << 20);
  void *image = file >= 0 && write_tables(file, pack) ? h5_image(file, bytes) : NULL;
  h5_close(file);
  return image;
}

bool pack_write(const struct pack *pack, FILE *out, const char *path, struct message *message)
{
  size_t bytes = 0;
  void *image = image_of(pack, &bytes);
  if (!image)
    return h5_fail(message, path, "cannot make the pack");
  bool ok = fwrite(image, 1, bytes, out) == bytes;
  free(image);
  return ok || message_set(message, "%s: cannot write", path);
}

/* --- reading ----------------------------------------------------------------------------------------------------- */

/* Names of the k-th link of a group. */
static bool link_name(hid_t group, hsize_t k, char *name, size_t size)
{
  ssize_t length = H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, size, H5P_DEFAULT);
  return length > 0 && (size_t)length < size;
}

/* How many links a group has. */
static bool count_links(hid_t group, hsize_t *count)
{
  H5G_info_t info = {.nlinks = 0};
  bool ok = group >= 0 && H5Gget_info(group, &info) >= 0;
  *count = info.nlinks;
  return ok;
}

static bool is_real(hid_t dataset)
{
  hid_t type = H5Dget_type(dataset);
  bool real = type >= 0 && H5Tget_class(type) == H5T_FLOAT;
  h5_close(type);
  return real;
}

/* Names of columns where the file has none. */
static const char *default_components(hsize_t columns)
{
  return columns == 1 ? "value" : columns == 3 ? "x y z" : "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15";
}

/* Only an attribute that is not there is made up for, never one that cannot be read. */
static bool read_components(hid_t dataset, hsize_t columns, char *words, size_t size)
{
  htri_t there = H5Aexists(dataset, "components");
  if (there == 0)
    snprintf(words, size, "%s", default_components(columns));
  return there == 0 || (there > 0 && h5_get_text(dataset, "components", words, size));
}

static bool read_table(hid_t group, const struct pack_place *place, const char *name, struct pack *pack)
{
  hid_t dataset = H5Dopen2(group, name, H5P_DEFAULT);
  hsize_t dims[2] = {0, 1};
  char words[PACK_COLUMNS * PACK_WORD];
  int rank = h5_shape(dataset, 2, dims);
  bool ok = (rank == 1 || rank == 2) && dims[0] < UINT32_MAX && dims[1] >= 1 && dims[1] <= PACK_COLUMNS;
  const bool real = ok && is_real(dataset);
  ok = ok && read_components(dataset, dims[1], words, sizeof words);
  h5_close(dataset);
  if (!ok)
    return false;
  void *data = real ? (void *)pack_put_reals(pack, place, name, words, (uint32_t)dims[0])
                    : (void *)pack_put_integers(pack, place, name, words, (uint32_t)dims[0]);
  struct pack_table *t = data ? &pack->table[pack->count - 1] : NULL;
  if (!t || t->columns < dims[1])
    return false;
  t->columns = (uint32_t)dims[1];
  return h5_array_read(group, name, real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64, rank, dims, data);
}

static bool read_group(hid_t file, const char *name, struct pack *pack)
{
  struct pack_place place;
  const char *dot = strchr(name, '.');
  if (!dot || dot - name >= PACK_WORD || dot[1] < '0' || dot[1] > '9')
    return false;
  snprintf(place.operator_name, sizeof place.operator_name, "%.*s", (int)(dot - name), name);
  place.step = strtoull(dot + 1, NULL, 10);
  hid_t group = h5_open_group(file, name);
  hsize_t count;
  bool ok = count_links(group, &count);
  for (hsize_t k = 0; ok && k < count; k++) {
    char table[PACK_WORD];
    ok = link_name(group, k, table, sizeof table) && read_table(group, &place, table, pack);
  }
  h5_close(group);
  return ok;
}

static bool read_hdf5(const char *path, struct pack *pack, struct message *message)
{
  enum h5_trouble trouble;
  char format[PACK_WORD] = "", name[2 * PACK_WORD];
  int version = 0;
  hid_t file = h5_open(path, false, &trouble, message);
  if (file < 0)
    return false;
  bool ok =
      (h5_get_text(file, "format", format, sizeof format) && strcmp(format, PACK_FORMAT) == 0 &&
       h5_get(file, "version", H5T_NATIVE_INT, 0, &version) && version == PACK_VERSION) ||
      message_set(message, "%s: not a pack of version %d; `uncross oracle emit` writes one, docs/porting.md says how",
                  path, PACK_VERSION);
  hsize_t count = 0;
  if (ok && !count_links(file, &count))
    ok = h5_fail(message, path, "cannot be read");
  for (hsize_t k = 0; ok && k < count; k++)
    ok = link_name(file, k, name, sizeof name) &&
         (read_group(file, name, pack) ||
          message_set(message,
                      "%s: group %s: cannot be read; a group is `operator.step`, its datasets are [rows] or "
                      "[rows][at most %d columns] of integers or reals, undamaged",
                      path, name, PACK_COLUMNS));
  h5_close(file);
  return ok;
}

bool pack_read(const char *path, struct pack *pack, struct message *message)
{
  static const unsigned char signature[4] = {0x89, 'H', 'D', 'F'};
  unsigned char head[4] = {0};
  memset(pack, 0, sizeof *pack);
  FILE *in = fopen(path, "rb");
  if (!in)
    return message_set(message, "%s: cannot be opened; a pack is wanted, as HDF5 or text", path);
  bool hdf5 = fread(head, 1, sizeof head, in) == sizeof head && memcmp(head, signature, sizeof head) == 0;
  rewind(in);
  bool ok = hdf5 ? read_hdf5(path, pack, message) : pack_read_text(in, path, pack, message);
  fclose(in);
  if (!ok)
    pack_free(pack);
  return ok;
}

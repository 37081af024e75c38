/* Packs as HDF5. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/opening.h"
#include "files/apart.h"
#include "files/hdf5.h"
#include "files/reader.h"
#include "oracle/pack.h"
#include "oracle/pack_text.h"

#define SEAL_NAME "seal"   /* attribute of files that end with one (seal.h) */
#define MOST_TABLES 100000 /* of a file */

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
  bool ok = h5_put_text(file, "format", PACK_FORMAT) && h5_put(file, "version", H5T_NATIVE_INT, 0, &version) &&
            h5_put_text(file, SEAL_NAME, "xxh64");
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
  hid_t dataset = h5_open_dataset(group, name);
  hsize_t dims[2] = {0, 1};
  char words[PACK_COLUMNS * PACK_WORD];
  int rank = h5_shape(dataset, 2, dims);
  bool ok = (rank == 1 || rank == 2) && dims[0] < UINT32_MAX && pack->count < MOST_TABLES && dims[1] >= 1 &&
            dims[1] <= PACK_COLUMNS;
  const bool real = ok && is_real(dataset);
  const bool unnamed = ok && H5Aexists(dataset, "components") == 0;
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
  t->unnamed = unnamed;
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

static bool known_format(hid_t file, const char *path, bool sealed, struct message *message)
{
  char format[PACK_WORD] = "";
  int version = 0;
  if (!h5_get_text(file, "format", format, sizeof format) || strcmp(format, PACK_FORMAT) != 0 ||
      !h5_get(file, "version", H5T_NATIVE_INT, 0, &version) || version < 1 || version > PACK_VERSION)
    return message_set(
        message, "%s: not a pack of version 1 to %d; `uncross oracle emit` writes one, docs/port/formats.md says how",
        path, PACK_VERSION);
  return sealed || H5Aexists(file, SEAL_NAME) == 0 ||
         message_set(message, "%s: damaged: its end with the seal is missing or changed", path);
}

static bool read_file(const char *path, struct pack *pack, struct message *message)
{
  enum h5_trouble trouble;
  char name[2 * PACK_WORD];
  bool sealed;
  unsigned failures;
  hid_t file = h5_open(path, false, &sealed, &trouble, message);
  apart_shut();
  h5_watch(&failures);
  if (file < 0)
    return false;
  bool ok = known_format(file, path, sealed, message);
  hsize_t count = 0;
  if (ok && !count_links(file, &count))
    ok = h5_fail(message, path, "cannot be read");
  for (hsize_t k = 0; ok && k < count; k++)
    ok = (link_name(file, k, name, sizeof name) || h5_fail(message, path, "cannot be read")) &&
         (read_group(file, name, pack) ||
          message_set(message,
                      "%s: group %s: cannot be read; a group is `operator.step`, its datasets are [rows] or "
                      "[rows][at most %d columns] of integers or reals, undamaged",
                      path, name, PACK_COLUMNS));
  h5_close(file);
  return ok && (failures == 0 || message_set(message, "%s: damaged: HDF5 cannot read some part of it", path));
}

/* --- the process that reads, and the one that wants the pack ----------------------------------------------------- */

static size_t bytes_of(const struct pack_table *t)
{
  return (size_t)t->rows * t->columns * sizeof(int64_t);
}

void pack_serve(struct apart *link)
{
  struct pack pack = {0};
  struct message message = {.text = ""};
  const bool ok = read_file(link->path, &pack, &message);
  const uint64_t count = pack.count;
  apart_put_verdict(link, ok ? 0 : 1, &message);
  if (!ok || !apart_put(link, &count, sizeof count))
    return;
  for (size_t k = 0; k < pack.count; k++)
    if (!apart_put(link, &pack.table[k], sizeof pack.table[k]) ||
        !apart_put(link, pack.table[k].value.data, bytes_of(&pack.table[k])))
      return;
}

static bool get_table(struct apart *apart, struct pack_table *t)
{
  t->value.data = NULL;
  if (!apart_get(apart, t, sizeof *t))
    return false;
  t->value.data = NULL; /* what was sent is an address over there */
  if (t->columns < 1 || t->columns > PACK_COLUMNS)
    return false;
  t->place.operator_name[PACK_WORD - 1] = t->name[PACK_WORD - 1] = '\0';
  for (int c = 0; c < PACK_COLUMNS; c++)
    t->component[c][PACK_WORD - 1] = '\0';
  t->value.data = malloc(bytes_of(t) + 1);
  return t->value.data && apart_get(apart, t->value.data, bytes_of(t));
}

static bool get_tables(struct apart *apart, struct pack *pack)
{
  uint64_t count;
  if (!apart_get(apart, &count, sizeof count) || count > MOST_TABLES)
    return false;
  pack->table = calloc((size_t)count + 1, sizeof *pack->table);
  bool ok = pack->table;
  while (ok && pack->count < count)
    ok = get_table(apart, &pack->table[pack->count++]);
  return ok;
}

static bool read_hdf5(const char *path, struct pack *pack, struct message *message)
{
  struct apart apart;
  if (!apart_start(&apart, path, "pack", message))
    return false;
  bool ok = apart_get_verdict(&apart, message) == 0;
  if (ok && !get_tables(&apart, pack))
    ok = apart.broken ? apart_lost(&apart, message) : message_set(message, "%s: out of memory", path);
  apart_end(&apart);
  return ok;
}

/* NULL, with a message, if it cannot be opened. */
static FILE *open_pack(const char *path, bool *hdf5, struct message *message)
{
  static const unsigned char signature[4] = {0x89, 'H', 'D', 'F'};
  unsigned char head[4] = {0};
  uint64_t bytes;
  FILE *in = open_input(path, &bytes, message);
  if (!in)
    return NULL;
  *hdf5 = fread(head, 1, sizeof head, in) == sizeof head && memcmp(head, signature, sizeof head) == 0;
  rewind(in);
  return in;
}

bool pack_begins(const char *path)
{
  struct message ignored;
  bool hdf5;
  FILE *in = open_pack(path, &hdf5, &ignored);
  if (!in)
    return false;
  const bool begins = hdf5 || pack_text_begins(in);
  fclose(in);
  return begins;
}

bool pack_read(const char *path, struct pack *pack, struct message *message)
{
  bool hdf5;
  memset(pack, 0, sizeof *pack);
  FILE *in = open_pack(path, &hdf5, message);
  if (!in)
    return false;
  bool ok = hdf5 ? read_hdf5(path, pack, message) : pack_read_text(in, path, pack, message);
  fclose(in);
  if (!ok)
    pack_free(pack);
  return ok;
}

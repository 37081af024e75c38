/* Packs as HDF5. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/opening.h"
#include "files/far.h"
#include "files/hdf5.h"
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

/* Names of columns where the file has none. */
static const char *default_components(uint64_t columns)
{
  return columns == 1 ? "value" : columns == 3 ? "x y z" : "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15";
}

static bool read_table(struct far *far, const char *group, const struct pack_place *place, const char *name,
                       struct pack *pack)
{
  const struct far_thing thing = far_look(far, group, name);
  const uint64_t rows = thing.dims[0], columns = thing.rank == 2 ? thing.dims[1] : 1;
  const bool real = thing.class == FAR_REALS;
  char words[PACK_COLUMNS * PACK_WORD];
  if ((!far_is(&thing, 1) && !far_is(&thing, 2)) || rows >= UINT32_MAX || pack->count >= MOST_TABLES || columns < 1 ||
      columns > PACK_COLUMNS)
    return false;
  const int named = far_get_text(far, group, name, "components", 0, words, sizeof words);
  if (named == 0)
    snprintf(words, sizeof words, "%s", default_components(columns));
  void *data = named < 0 || !far_affords(far, rows * columns * sizeof(int64_t)) ? NULL
               : real ? (void *)pack_put_reals(pack, place, name, words, (uint32_t)rows)
                      : (void *)pack_put_integers(pack, place, name, words, (uint32_t)rows);
  struct pack_table *t = data ? &pack->table[pack->count - 1] : NULL;
  if (!t || t->columns < columns)
    return false;
  t->columns = (uint32_t)columns;
  t->unnamed = named == 0;
  return far_read(far, group, name, FAR_ALL, real ? FAR_REAL : FAR_INTEGER, (int)thing.rank, thing.dims, data);
}

static bool read_group(struct far *far, const char *name, struct pack *pack)
{
  struct pack_place place;
  const char *dot = strchr(name, '.');
  if (!dot || dot - name >= PACK_WORD || dot[1] < '0' || dot[1] > '9')
    return false;
  snprintf(place.operator_name, sizeof place.operator_name, "%.*s", (int)(dot - name), name);
  place.step = strtoull(dot + 1, NULL, 10);
  const struct far_thing group = far_look(far, "", name);
  bool ok = group.kind == FAR_GROUP;
  for (uint64_t k = 0; ok && k < group.links; k++) {
    char table[PACK_WORD];
    ok = far_link(far, name, k, table, sizeof table) && read_table(far, name, &place, table, pack);
  }
  return ok;
}

static bool known_format(struct far *far, struct message *message)
{
  char format[PACK_WORD] = "";
  int32_t version = 0;
  char seal[16];
  const char *path = far->apart.path;
  if (far_get_text(far, "", "", "format", 0, format, sizeof format) <= 0 || strcmp(format, PACK_FORMAT) != 0 ||
      far_get(far, "", "", "version", FAR_SHORT, 0, &version) <= 0 || version < 1 || version > PACK_VERSION)
    return message_set(
        message, "%s: not a pack of version 1 to %d; `uncross oracle emit` writes one, docs/port/formats.md says how",
        path, PACK_VERSION);
  return far->sealed || far_get_text(far, "", "", SEAL_NAME, 0, seal, sizeof seal) == 0 ||
         message_set(message, "%s: damaged: its end with the seal is missing or changed", path);
}

static bool read_groups(struct far *far, struct pack *pack, struct message *message)
{
  char name[2 * PACK_WORD];
  const struct far_thing root = far_look(far, "", "");
  bool ok = known_format(far, message) && (root.kind == FAR_GROUP || far_fail(far, message, "cannot be read"));
  for (uint64_t k = 0; ok && k < root.links; k++)
    ok = (far_link(far, "", k, name, sizeof name) || far_fail(far, message, "cannot be read")) &&
         (read_group(far, name, pack) ||
          message_set(message,
                      "%s: group %s: cannot be read; a group is `operator.step`, its datasets are [rows] or "
                      "[rows][at most %d columns] of integers or reals, undamaged",
                      far->apart.path, name, PACK_COLUMNS));
  return ok && far_whole(far, 0, "damaged: HDF5 cannot read some part of it", message);
}

static bool read_hdf5(const char *path, struct pack *pack, struct message *message)
{
  struct far far;
  enum h5_trouble trouble;
  if (!far_open(&far, path, &trouble, message))
    return false;
  const bool read = read_groups(&far, pack, message),
             ok = far_whole(&far, far.failures, "", message) && read; /* that the reader is no more says most */
  far_close(&far);
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

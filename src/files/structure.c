#include "files/structure.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "files/trajectory.h"

/* --- writing ----------------------------------------------------------------------------------------------------- */

/* Names of an enumeration must differ: a kind that is called like an earlier one, or like the solvent, gets its number.
 */
static void species_name(const struct model *model, uint32_t kind, char *name, size_t size)
{
  bool taken = strcmp(model->kind[kind].name, STRUCTURE_SOLVENT) == 0 || model->kind[kind].name[0] == '\0';
  for (uint32_t k = 0; k < kind; k++)
    taken |= strcmp(model->kind[k].name, model->kind[kind].name) == 0;
  if (taken)
    snprintf(name, size, "%s#%u", model->kind[kind].name, kind);
  else
    snprintf(name, size, "%s", model->kind[kind].name);
}

static hid_t species_type(const struct model *model)
{
  hid_t type = H5Tenum_create(H5T_STD_I32LE);
  for (uint32_t k = 0; k <= model->kinds; k++) {
    char name[MODEL_NAME_SIZE + 16] = STRUCTURE_SOLVENT;
    int32_t value = (int32_t)k;
    if (k < model->kinds)
      species_name(model, k, name, sizeof name);
    H5Tenum_insert(type, name, &value);
  }
  return type;
}

bool structure_write_particles(hid_t group, const struct model *model, bool solvent)
{
  hsize_t n = model->vertices + (solvent ? model->solvent.particles : 0);
  int32_t *species = malloc((n + 1) * sizeof *species), *id = malloc((n + 1) * sizeof *id);
  double *mass = malloc((n + 1) * sizeof *mass);
  bool ok = species && id && mass;
  for (hsize_t i = 0; ok && i < n; i++) {
    bool vertex = i < model->vertices;
    id[i] = (int32_t)i;
    species[i] = (int32_t)(vertex ? model->fiber_kind_of[model->fiber_of[i]] : model->kinds);
    mass[i] = vertex ? model->mass[i] : 1.0;
  }
  hid_t type = species_type(model);
  ok = ok && h5_array_write(group, "species", type, 1, &n, species) &&
       h5_array_write(group, "id", H5T_NATIVE_INT32, 1, &n, id) &&
       h5_array_write(group, "mass", H5T_NATIVE_DOUBLE, 1, &n, mass);
  h5_close(type);
  free(species);
  free(id);
  free(mass);
  return ok;
}

/* The model's bonds as pairs, to be freed; NULL if memory is short. */
static int32_t *pairs_of(const struct model *model)
{
  int32_t *pair = malloc(((size_t)model->bonds + 1) * 2 * sizeof *pair);
  size_t b = 0;
  for (uint32_t v = 0; pair && v < model->vertices; v++)
    if (model->next[v] >= 0) {
      pair[2 * b] = (int32_t)v;
      pair[2 * b++ + 1] = model->next[v];
    }
  return pair;
}

bool structure_write_bonds(hid_t group, const struct model *model)
{
  const hsize_t dims[2] = {model->bonds, 2};
  int32_t *pair = pairs_of(model);
  bool ok = pair && h5_array_write(group, "bonds", H5T_NATIVE_INT32, 2, dims, pair);
  free(pair);
  return ok;
}

bool structure_same_bonds(const int32_t *stored, const struct model *model)
{
  int32_t *pair = pairs_of(model);
  const bool same = pair && memcmp(pair, stored, (size_t)model->bonds * 2 * sizeof *pair) == 0;
  free(pair);
  return same;
}

/* --- reading ----------------------------------------------------------------------------------------------------- */

/* Cleared memory for so many of this size, and one more; or NULL, with a message: the file is not to blame. */
static void *room(size_t count, size_t size, struct message *why)
{
  void *found = calloc(count + 1, size);
  if (!found)
    message_no_memory(why, "out of memory");
  return found;
}

static bool read_names(hid_t dataset, struct structure *s, struct message *why)
{
  hid_t type = H5Dget_type(dataset);
  int members = type >= 0 && H5Tget_class(type) == H5T_ENUM ? H5Tget_nmembers(type) : 0;
  hid_t base = members > 0 ? H5Tget_super(type) : -1;
  bool ok = type >= 0 && (members == 0 || (base >= 0 && H5Tget_size(base) == sizeof(int32_t))); /* as we write them */
  s->name = room((size_t)members, sizeof *s->name, why);
  for (int k = 0; s->name && ok && k < members; k++) {
    int32_t value = -1;
    char *name = H5Tget_member_name(type, (unsigned)k);
    ok = name && H5Tget_member_value(type, (unsigned)k, &value) >= 0 && value >= 0 && value < members;
    if (ok) /* others write them in the order of names */
      snprintf(s->name[value], sizeof s->name[value], "%s", name);
    H5free_memory(name);
  }
  s->kinds = members;
  h5_close(base);
  h5_close(type);
  return s->name && ok;
}

/* The frame and row whose species is another than in the frame before; false if there is none. */
static bool species_change(hid_t value, hid_t type, hsize_t frames, struct structure *s, bool *read,
                           struct message *why)
{
  int32_t *row = room(s->particles, sizeof *row, why);
  bool change = false;
  *read = row && trajectory_read_block(value, 0, 2, type, s->species);
  for (hsize_t k = 1; *read && !change && k < frames; k++) {
    *read = trajectory_read_block(value, k, 2, type, row);
    for (uint32_t i = 0; *read && !change && i < s->particles; i++) {
      change = row[i] != s->species[i];
      if (change)
        snprintf(s->odd_species, sizeof s->odd_species,
                 "its species change with time: row %" PRIu32 " of frame %" PRIu64 " is another; allowed: the same in "
                 "all frames",
                 i, (uint64_t)k);
    }
  }
  free(row);
  return change;
}

/* Of each frame: H5MD lets species change. Those that do, or are no numbers, tell nothing. */
static bool read_timed_species(hid_t group, struct structure *s, struct message *why)
{
  hsize_t dims[3];
  hid_t value = h5_has(group, "value") ? h5_open_dataset(group, "value") : -1,
        type = value < 0 ? -1 : H5Dget_type(value);
  const H5T_class_t class = type < 0 ? H5T_NO_CLASS : H5Tget_class(type);
  const bool fits = (class == H5T_ENUM || class == H5T_INTEGER) && h5_shape(value, 3, dims) == 2 &&
                    dims[1] == s->particles && dims[0] > 0;
  bool read = true;
  s->species = room(s->particles, sizeof *s->species, why);
  if (!fits)
    snprintf(s->odd_species, sizeof s->odd_species, "its species are not one whole number for each row");
  else if (!s->species || !read_names(value, s, why))
    read = false;
  else if (species_change(value, class == H5T_ENUM ? type : H5T_NATIVE_INT32, dims[0], s, &read, why))
    memset(s->species, 0, (size_t)s->particles * sizeof *s->species), s->kinds = 0;
  h5_close(type);
  h5_close(value);
  return s->species && read;
}

/* Memory is asked for only when the dataset has been found to hold so many rows. */
static bool read_species(hid_t particles, struct structure *s, struct message *why)
{
  hsize_t n = 0;
  const int found = h5_look(particles, "species");
  hid_t object = h5_open_object(particles, "species");
  const bool fixed = object >= 0 && H5Iget_type(object) == H5I_DATASET;
  if (object >= 0 && !fixed) {
    const bool timed = read_timed_species(object, s, why);
    h5_close(object);
    return timed;
  }
  bool ok = (found == 0 || object >= 0) && (!fixed || (h5_shape(object, 1, &n) == 1 && n == s->particles));
  s->species = ok ? room(s->particles, sizeof *s->species, why) : NULL;
  ok = ok && s->species;
  if (ok && fixed) {
    hid_t type = H5Dget_type(object);
    bool is_enum = H5Tget_class(type) == H5T_ENUM;
    ok = type >= 0 && read_names(object, s, why) &&
         h5_array_read(particles, "species", is_enum ? type : H5T_NATIVE_INT32, 1, &n, s->species);
    h5_close(type);
  }
  h5_close(object);
  return ok;
}

/* As real numbers. */
static bool read_whole_masses(hid_t particles, hsize_t n, double *mass, struct message *why)
{
  int64_t *whole = room((size_t)n, sizeof *whole, why);
  const bool ok = whole && h5_array_read(particles, "mass", H5T_NATIVE_INT64, 1, &n, whole);
  for (hsize_t i = 0; ok && i < n; i++)
    mass[i] = (double)whole[i];
  free(whole);
  return ok;
}

/* In files of other programs masses may be missing, or be of another form: they are not stored then. */
static bool read_mass(hid_t particles, struct structure *s, struct message *why)
{
  const hsize_t n = s->particles;
  hsize_t found = 0;
  const int there = h5_look(particles, "mass");
  hid_t object = h5_open_object(particles, "mass");
  hid_t type = object >= 0 && H5Iget_type(object) == H5I_DATASET ? H5Dget_type(object) : -1;
  const H5T_class_t class = type < 0 ? H5T_NO_CLASS : H5Tget_class(type);
  const bool fits = (class == H5T_FLOAT || class == H5T_INTEGER) && h5_shape(object, 1, &found) == 1 && found == n;
  bool ok = there == 0 || object >= 0;
  if (ok && fits) {
    s->mass = room((size_t)n, sizeof *s->mass, why);
    ok = s->mass && (class == H5T_FLOAT ? h5_array_read(particles, "mass", H5T_NATIVE_DOUBLE, 1, &n, s->mass)
                                        : read_whole_masses(particles, n, s->mass, why));
  }
  h5_close(type);
  h5_close(object);
  return ok;
}

/* A pair has no direction: it is that of a fiber, whose rows follow each other, or that from a ring's end to its
 * beginning. */
static void take_bond(struct structure *s, int32_t a, int32_t b)
{
  const int32_t low = a < b ? a : b, high = a < b ? b : a;
  if (high == low + 1)
    s->next[low] = high;
  else
    s->next[high] = low;
}

struct named {
  int64_t id;
  int32_t row;
};

static int compare_ids(const void *a, const void *b)
{
  const int64_t x = ((const struct named *)a)->id, y = ((const struct named *)b)->id;
  return (x > y) - (x < y);
}

/* The rows by their ids, to be freed; NULL, with a message, if memory is short. */
static struct named *sort_rows(const int64_t *id, uint32_t rows, struct message *why)
{
  struct named *by_id = room(rows, sizeof *by_id, why);
  for (uint32_t i = 0; by_id && i < rows; i++)
    by_id[i] = (struct named){id ? id[i] : i, (int32_t)i};
  if (by_id && id)
    qsort(by_id, rows, sizeof *by_id, compare_ids);
  return by_id;
}

static bool take_bonds(struct structure *s, const int32_t *pair, hsize_t bonds, const struct named *by_id,
                       struct message *why)
{
  for (hsize_t b = 0; b < bonds; b++) {
    const struct named *end[2];
    for (int k = 0; k < 2; k++) {
      const struct named wanted = {.id = pair[2 * b + (hsize_t)k]};
      end[k] = bsearch(&wanted, by_id, s->particles, sizeof *by_id, compare_ids);
      if (!end[k])
        return message_set(why, "its bonds name particle %" PRId64 ", and no row is that", wanted.id);
    }
    take_bond(s, end[0]->row, end[1]->row);
  }
  return true;
}

static bool read_bonds(hid_t connectivity, const int64_t *id, struct structure *s, struct message *why)
{
  hsize_t dims[2] = {0, 2};
  s->next = room(s->particles, sizeof *s->next, why);
  if (!s->next)
    return false;
  for (uint32_t i = 0; i < s->particles; i++)
    s->next[i] = -1;
  int found = connectivity < 0 ? 0 : h5_look(connectivity, "bonds");
  if (found <= 0)
    return found == 0;
  s->stored_bonds = true;
  hid_t dataset = h5_open_dataset(connectivity, "bonds");
  bool ok = h5_shape(dataset, 2, dims) == 2 && dims[1] == 2 && dims[0] <= INT32_MAX;
  h5_close(dataset);
  int32_t *pair = ok ? room((size_t)dims[0] * 2, sizeof *pair, why) : NULL;
  struct named *by_id = ok ? sort_rows(id, s->particles, why) : NULL;
  ok = pair && by_id && h5_array_read(connectivity, "bonds", H5T_NATIVE_INT32, 2, dims, pair) &&
       take_bonds(s, pair, dims[0], by_id, why);
  s->bonds = (uint32_t)dims[0];
  free(by_id);
  free(pair);
  return ok;
}

bool structure_read(hid_t particles, hid_t connectivity, const int64_t *id, uint32_t rows, struct structure *s,
                    struct message *why)
{
  memset(s, 0, sizeof *s);
  *why = (struct message){.text = ""};
  s->particles = rows;
  bool ok = read_species(particles, s, why) && read_mass(particles, s, why) && read_bonds(connectivity, id, s, why);
  if (!ok)
    structure_free(s);
  return ok;
}

void structure_free(struct structure *s)
{
  free(s->species);
  free(s->mass);
  free(s->name);
  free(s->next);
  memset(s, 0, sizeof *s);
}

bool structure_is_solvent(const struct structure *s, int32_t species)
{
  return species >= 0 && species < s->kinds && strcmp(s->name[species], STRUCTURE_SOLVENT) == 0;
}

const char *structure_name(const struct structure *s, int32_t species)
{
  return species >= 0 && species < s->kinds ? s->name[species] : "";
}

double structure_mass(const struct structure *s, uint32_t row)
{
  return s->mass && row < s->particles ? s->mass[row] : 1.0;
}

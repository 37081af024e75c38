#include "files/structure.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

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

static bool read_names(struct far *far, const char *in, const char *name, struct structure *s)
{
  uint64_t count;
  s->name = far_names(far, in, name, sizeof *s->name, &count);
  s->kinds = (int)count;
  return s->name;
}

/* The frame and row whose species is another than in the frame before; false if there is none. */
static bool species_change(struct far *far, const char *in, const struct far_thing *value, struct structure *s,
                           bool *read, struct message *why)
{
  int32_t *row = far_room(far, s->particles, sizeof *row, why);
  bool change = false;
  *read = row && far_read(far, in, "species/value", 0, FAR_SHORT, 2, value->dims, s->species);
  for (uint64_t k = 1; *read && !change && k < value->dims[0]; k++) {
    *read = far_read(far, in, "species/value", k, FAR_SHORT, 2, value->dims, row);
    for (uint32_t i = 0; *read && !change && i < s->particles; i++) {
      change = row[i] != s->species[i];
      if (change)
        snprintf(s->odd_species, sizeof s->odd_species,
                 "its species change with time: row %" PRIu32 " of frame %" PRIu64 " is another; allowed: the same in "
                 "all frames",
                 i, k);
    }
  }
  free(row);
  return change;
}

/* Of each frame: H5MD lets species change. Those that do, or are no numbers, tell nothing. */
static bool read_timed_species(struct far *far, const char *in, struct structure *s, struct message *why)
{
  const struct far_thing value = far_look(far, in, "species/value");
  bool read = true;
  if (!far_is(&value, 2) || (value.class != FAR_ENUMERATION && value.class != FAR_INTEGERS) ||
      value.dims[1] != s->particles || value.dims[0] == 0) {
    snprintf(s->odd_species, sizeof s->odd_species, "its species are not one whole number for each row");
    return true;
  }
  if (!read_names(far, in, "species/value", s))
    return false;
  if (species_change(far, in, &value, s, &read, why))
    memset(s->species, 0, (size_t)s->particles * sizeof *s->species), s->kinds = 0;
  return read;
}

/* Memory is asked for only when the dataset has been found to hold so many rows. */
static bool read_species(struct far *far, const char *in, struct structure *s, struct message *why)
{
  const struct far_thing species = far_look(far, in, "species");
  const bool fixed = species.kind == FAR_DATASET;
  if (species.kind == FAR_BROKEN || (fixed && (species.rank != 1 || species.dims[0] != s->particles)))
    return false;
  s->species = far_room(far, s->particles, sizeof *s->species, why);
  if (!s->species || species.kind == FAR_NOTHING)
    return s->species;
  if (!fixed)
    return read_timed_species(far, in, s, why);
  return read_names(far, in, "species", s) &&
         far_read(far, in, "species", FAR_ALL, FAR_SHORT, 1, species.dims, s->species);
}

/* In files of other programs masses may be missing, or be of another form: they are not stored then. */
static bool read_mass(struct far *far, const char *in, struct structure *s, struct message *why)
{
  const struct far_thing mass = far_look(far, in, "mass");
  if (!far_is(&mass, 1) || (mass.class != FAR_REALS && mass.class != FAR_INTEGERS) || mass.dims[0] != s->particles)
    return mass.kind != FAR_BROKEN;
  s->mass = far_room(far, s->particles, sizeof *s->mass, why);
  return s->mass && far_read(far, in, "mass", FAR_ALL, FAR_REAL, 1, mass.dims, s->mass);
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
static struct named *sort_rows(struct far *far, const int64_t *id, uint32_t rows, struct message *why)
{
  struct named *by_id = far_room(far, rows, sizeof *by_id, why);
  for (uint32_t i = 0; by_id && i < rows; i++)
    by_id[i] = (struct named){id ? id[i] : i, (int32_t)i};
  if (by_id && id)
    qsort(by_id, rows, sizeof *by_id, compare_ids);
  return by_id;
}

static bool take_bonds(struct structure *s, const int32_t *pair, uint64_t bonds, const struct named *by_id,
                       struct message *why)
{
  for (uint64_t b = 0; b < bonds; b++) {
    const struct named *end[2];
    for (int k = 0; k < 2; k++) {
      const struct named wanted = {.id = pair[2 * b + (uint64_t)k]};
      end[k] = bsearch(&wanted, by_id, s->particles, sizeof *by_id, compare_ids);
      if (!end[k])
        return message_set(why, "its bonds name particle %" PRId64 ", and no row is that", wanted.id);
    }
    take_bond(s, end[0]->row, end[1]->row);
  }
  return true;
}

static bool read_bonds(struct far *far, const char *in, const int64_t *id, struct structure *s, struct message *why)
{
  s->next = far_room(far, s->particles, sizeof *s->next, why);
  for (uint32_t i = 0; s->next && i < s->particles; i++)
    s->next[i] = -1;
  const struct far_thing bonds = in ? far_look(far, in, "bonds") : (struct far_thing){.kind = FAR_NOTHING};
  if (!s->next || bonds.kind <= FAR_NOTHING)
    return s->next && bonds.kind == FAR_NOTHING;
  s->stored_bonds = true;
  if (!far_is(&bonds, 2) || bonds.dims[1] != 2 || bonds.dims[0] > INT32_MAX)
    return false;
  int32_t *pair = far_room(far, (size_t)bonds.dims[0] * 2, sizeof *pair, why);
  struct named *by_id = sort_rows(far, id, s->particles, why);
  const bool ok = pair && by_id && far_read(far, in, "bonds", FAR_ALL, FAR_SHORT, 2, bonds.dims, pair) &&
                  take_bonds(s, pair, bonds.dims[0], by_id, why);
  s->bonds = (uint32_t)bonds.dims[0];
  free(by_id);
  free(pair);
  return ok;
}

bool structure_read(struct far *far, const char *particles, const char *connectivity, const int64_t *id, uint32_t rows,
                    struct structure *s, struct message *why)
{
  memset(s, 0, sizeof *s);
  *why = (struct message){.text = ""};
  s->particles = rows;
  bool ok = read_species(far, particles, s, why) && read_mass(far, particles, s, why) &&
            read_bonds(far, connectivity, id, s, why);
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

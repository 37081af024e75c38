#include "files/foreign.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

/* --- what is there ----------------------------------------------------------------------------------------------- */

/* Groups, and the arrays in them that are used or checked. */
static const struct known {
  const char *group; /* below the file, with a slash; "": the particles */
  const char *array[9];
  const char *allowed;
} known[] = {
    {"",
     {"position", "velocity", "force", "image", "mass", "species", "id", "box"},
     "position, velocity, force, image, mass, species, id, box"},
    {"connectivity/", {"bonds"}, "bonds"},
    {"box/", {"edges"}, "edges"},
};

static bool is_known(const struct known *in, const char *name)
{
  size_t k = 0;
  while (in->array[k] && strcmp(in->array[k], name) != 0)
    k++;
  return in->array[k];
}

/* The first array of which a run knows nothing. */
static void find_strange(hid_t group, const struct known *in, char *unfit, size_t size)
{
  H5G_info_t info;
  char name[64], shown[64];
  if (group < 0 || H5Gget_info(group, &info) < 0)
    return;
  for (hsize_t k = 0; k < info.nlinks && !*unfit; k++)
    if (H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, sizeof name, H5P_DEFAULT) > 0 &&
        !is_known(in, name))
      snprintf(unfit, size, "it holds '%s%s', of which a run knows nothing; allowed: %s", in->group,
               text_escape(name, shown, sizeof shown), in->allowed);
}

/* --- ids --------------------------------------------------------------------------------------------------------- */

/* A dataset [rows], or `value` [frames][rows] of a group: the row of the last frame. False if it is neither. */
static bool read_ids(const struct trajectory *t, hid_t object, int64_t *id)
{
  const bool timed = H5Iget_type(object) == H5I_GROUP;
  hsize_t dims[3];
  hid_t value = timed ? h5_open_dataset(object, "value") : object;
  hid_t type = value < 0 ? -1 : H5Dget_type(value);
  const int rank = h5_shape(value, 3, dims);
  bool ok = type >= 0 && H5Tget_class(type) == H5T_INTEGER && rank == 1 + timed && dims[rank - 1] == t->particles;
  if (ok && timed)
    ok = t->frames <= dims[0] && trajectory_read_block(value, t->frames - 1, 2, H5T_NATIVE_INT64, id);
  else if (ok)
    ok = H5Dread(value, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, id) >= 0;
  h5_close(type);
  if (timed)
    h5_close(value);
  return ok;
}

int64_t *foreign_ids(const struct trajectory *t)
{
  hid_t object = h5_has(t->group, "id") ? h5_open_object(t->group, "id") : -1;
  int64_t *id = object >= 0 && t->frames > 0 ? malloc(((size_t)t->particles + 1) * sizeof *id) : NULL;
  if (id && !read_ids(t, object, id)) {
    free(id);
    id = NULL;
  }
  h5_close(object);
  return id;
}

/* Rows are in the order of their ids, which have no gaps. */
static void check_ids(const struct trajectory *t, char *unfit, size_t size)
{
  int64_t *id = foreign_ids(t);
  if (!id && t->frames > 0 && h5_has(t->group, "id"))
    snprintf(unfit, size, "its ids are not one whole number for each row");
  for (uint32_t k = 1; id && k < t->particles && !*unfit; k++)
    if (id[k - 1] == INT64_MAX || id[k] != id[k - 1] + 1)
      snprintf(unfit, size,
               "row %" PRIu32 " has the id %" PRId64 ", after %" PRId64 "; rows must be in the order of ids, without "
               "gaps",
               k, id[k], id[k - 1]);
  free(id);
}

/* An object below a group, or below it in a group in it; below 0 if there is none. */
static hid_t find(hid_t group, const char *outer, const char *inner)
{
  hid_t object = h5_has(group, outer) ? h5_open_object(group, outer) : -1;
  const bool group_within = object >= 0 && H5Iget_type(object) == H5I_GROUP;
  if (!inner)
    return object;
  hid_t within = group_within && h5_has(object, inner) ? h5_open_object(object, inner) : -1;
  h5_close(object);
  return within;
}

/* --- what is told of numbers and box ----------------------------------------------------------------------------- */

/* An attribute `unit`, as H5MD has it. */
static void find_unit(hid_t object, const char *name, char *unfit, size_t size)
{
  char unit[32] = "?", shown[4 * sizeof unit];
  if (object < 0 || *unfit || H5Aexists(object, "unit") <= 0)
    return;
  h5_get_text(object, "unit", unit, sizeof unit);
  snprintf(unfit, size, "its %s has the unit '%s'; allowed: none, numbers in a0, t0 and m", name,
           text_escape(unit, shown, sizeof shown));
}

/* Of an array, or of its value. */
static void check_units(hid_t group, hid_t box, char *unfit, size_t size)
{
  const struct {
    hid_t group;
    const char *name;
  } rows[] = {{group, "position"}, {group, "velocity"}, {group, "mass"}, {box, "edges"}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    hid_t array = rows[k].group < 0 ? -1 : find(rows[k].group, rows[k].name, NULL),
          value = rows[k].group < 0 ? -1 : find(rows[k].group, rows[k].name, "value");
    find_unit(array, rows[k].name, unfit, size);
    find_unit(value, rows[k].name, unfit, size);
    h5_close(value);
    h5_close(array);
  }
}

static void check_dimension(hid_t box, char *unfit, size_t size)
{
  int32_t dimension;
  if (box >= 0 && h5_get(box, "dimension", H5T_NATIVE_INT32, 0, &dimension) && dimension != 3)
    snprintf(unfit, size, "its box has %" PRId32 " dimensions; allowed: 3, which a plane has, too", dimension);
}

void foreign_look(const struct trajectory *t, const struct structure *s, struct frames_about *about)
{
  char *unfit = about->unfit;
  const size_t size = sizeof about->unfit;
  hid_t connectivity = h5_has(t->file, "connectivity") ? h5_open_group(t->file, "connectivity") : -1;
  hid_t box = h5_has(t->group, "box") ? h5_open_group(t->group, "box") : -1;
  find_strange(t->group, &known[0], unfit, size);
  if (!*unfit)
    find_strange(connectivity, &known[1], unfit, size);
  if (!*unfit)
    find_strange(box, &known[2], unfit, size);
  if (!*unfit)
    check_dimension(box, unfit, size);
  if (!*unfit)
    check_units(t->group, box, unfit, size);
  h5_close(box);
  h5_close(connectivity);
  if (!*unfit)
    snprintf(unfit, size, "%s", s->odd_species);
  if (!*unfit && !s->mass && h5_has(t->group, "mass"))
    snprintf(unfit, size, "its mass is not one number for each row");
  if (!*unfit)
    check_ids(t, unfit, size);
}

/* --- frames ------------------------------------------------------------------------------------------------------ */

/* More than one, and none that is called as ours are. */
static bool one_group(const struct trajectory *t, struct message *message)
{
  char name[2][64] = {"", ""}, shown[2][256];
  hid_t particles = h5_open_group(t->file, "particles");
  H5G_info_t info;
  const bool several = particles >= 0 && H5Gget_info(particles, &info) >= 0 && info.nlinks > 1;
  const bool one = !several || h5_has(particles, "trajectory");
  for (hsize_t k = 0; k < 2 && !one; k++)
    H5Lget_name_by_idx(particles, ".", H5_INDEX_NAME, H5_ITER_INC, k, name[k], sizeof name[k], H5P_DEFAULT);
  h5_close(particles);
  return one || message_set(message,
                            "%s: it holds %" PRIu64 " groups of particles, '%s', '%s'%s; allowed: one, or one that is "
                            "called 'trajectory'",
                            t->path, (uint64_t)info.nlinks, text_escape(name[0], shown[0], sizeof shown[0]),
                            text_escape(name[1], shown[1], sizeof shown[1]), info.nlinks > 2 ? ", ..." : "");
}

/* The step of each row of an element, to be freed: one by one, or of a fixed increment. NULL: not told. */
static int64_t *read_steps(hid_t element, uint64_t rows)
{
  hsize_t n[1] = {0};
  int64_t increment = 0, begin = 0;
  hid_t step = h5_has(element, "step") ? h5_open_dataset(element, "step") : -1;
  const int rank = step < 0 ? -1 : h5_shape(step, 1, n);
  const bool each = rank == 1 && n[0] >= rows;
  int64_t *steps = each || rank == 0 ? malloc(((size_t)(each ? n[0] : rows) + 1) * sizeof *steps) : NULL;
  bool ok = steps && H5Dread(step, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, each ? steps : &increment) >= 0;
  if (ok && !each && H5Aexists(step, "offset") > 0)
    ok = h5_get(step, "offset", H5T_NATIVE_INT64, 0, &begin);
  for (uint64_t k = 0; ok && !each && k < rows; k++)
    steps[k] = (int64_t)((uint64_t)begin + k * (uint64_t)increment);
  h5_close(step);
  if (!ok)
    free(steps);
  return ok ? steps : NULL;
}

/* The same; false, with a message, if steps are told that are not those of so many rows. *steps: NULL if none are told.
 * What this program wrote may end in the middle of a frame. */
static bool take_steps(const struct trajectory *t, hid_t element, const char *name, uint64_t rows, int64_t **steps,
                       struct message *message)
{
  *steps = read_steps(element, rows);
  return *steps || t->ours || !h5_has(element, "step") ||
         message_set(message, "%s: its %s has no step that can be read for each of its %" PRIu64 " rows", t->path, name,
                     rows);
}

static uint64_t count_rows(hid_t element)
{
  hsize_t dims[3] = {0, 0, 0};
  hid_t value = h5_has(element, "value") ? h5_open_dataset(element, "value") : -1;
  const int rank = value < 0 ? -1 : h5_shape(value, 3, dims);
  h5_close(value);
  return rank > 0 ? dims[0] : 0;
}

/* An element that changes with time: as many rows as positions, of the same steps. steps: [rows] of the positions,
 * NULL: not told. */
static bool steps_with(const struct trajectory *t, hid_t element, const char *name, const int64_t *steps, uint64_t rows,
                       struct message *message)
{
  const bool timed = element >= 0 && H5Iget_type(element) == H5I_GROUP && h5_has(element, "value");
  const uint64_t own = timed ? count_rows(element) : rows, both = own < rows ? own : rows;
  bool ok = own == rows || t->ours ||
            message_set(message, "%s: its %s has %" PRIu64 " rows, its position %" PRIu64 "; allowed: as many", t->path,
                        name, own, rows);
  int64_t *its = NULL;
  if (ok && timed && steps)
    ok = take_steps(t, element, name, both, &its, message);
  for (uint64_t k = 0; ok && its && k < both; k++)
    if (its[k] != steps[k])
      ok = message_set(message,
                       "%s: its %s is of other steps than its position: row %" PRIu64 " is of step %" PRId64
                       ", not of %" PRId64,
                       t->path, name, k, its[k], steps[k]);
  free(its);
  return ok;
}

bool foreign_is_one(const struct trajectory *t, struct message *message)
{
  static const struct {
    const char *outer, *inner, *name;
  } elements[] = {{"velocity", NULL, "velocity"},
                  {"image", NULL, "image"},
                  {"id", NULL, "id"},
                  {"species", NULL, "species"},
                  {"box", "edges", "box/edges"}};
  hid_t position = h5_open_group(t->group, "position");
  const uint64_t rows = count_rows(position);
  int64_t *steps = NULL;
  bool ok = one_group(t, message) && take_steps(t, position, "position", rows, &steps, message);
  for (size_t k = 0; ok && k < sizeof elements / sizeof *elements; k++) {
    hid_t element = find(t->group, elements[k].outer, elements[k].inner);
    ok = steps_with(t, element, elements[k].name, steps, rows, message);
    h5_close(element);
  }
  free(steps);
  h5_close(position);
  return ok;
}

/* --- images ------------------------------------------------------------------------------------------------------ */

bool foreign_unfold(const struct trajectory *t, uint64_t frame, const double edge[3], double *position)
{
  const size_t numbers = 3 * (size_t)t->particles;
  if (!h5_has(t->group, "image"))
    return true;
  hsize_t dims[3];
  hid_t group = h5_open_group(t->group, "image"), value = h5_open_dataset(group, "value");
  hid_t type = value < 0 ? -1 : H5Dget_type(value);
  int32_t *image = malloc((numbers + 1) * sizeof *image);
  const bool ok = image && edge[0] > 0.0 && type >= 0 && H5Tget_class(type) == H5T_INTEGER &&
                  h5_shape(value, 3, dims) == 3 && dims[1] == t->particles && dims[2] == 3 &&
                  trajectory_read_block(value, frame, 3, H5T_NATIVE_INT32, image);
  for (size_t k = 0; ok && k < numbers; k++)
    position[k] += image[k] * edge[k % 3];
  free(image);
  h5_close(type);
  h5_close(value);
  h5_close(group);
  return ok;
}

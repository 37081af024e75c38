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

/* Rows are in the order of their ids, which have no gaps. */
static void check_ids(const struct trajectory *t, char *unfit, size_t size)
{
  hid_t object = h5_has(t->group, "id") ? h5_open_object(t->group, "id") : -1;
  int64_t *id = malloc(((size_t)t->particles + 1) * sizeof *id);
  const bool there = object >= 0 && t->frames > 0, read = there && id && read_ids(t, object, id);
  if (there && !read)
    snprintf(unfit, size, "its ids are not one whole number for each row");
  for (uint32_t k = 1; read && k < t->particles && !*unfit; k++)
    if (id[k - 1] == INT64_MAX || id[k] != id[k - 1] + 1)
      snprintf(unfit, size,
               "row %" PRIu32 " has the id %" PRId64 ", after %" PRId64 "; rows must be in the order of ids, without "
               "gaps",
               k, id[k], id[k - 1]);
  free(id);
  h5_close(object);
}

void foreign_look(const struct trajectory *t, bool masses, struct frames_about *about)
{
  char *unfit = about->unfit;
  const size_t size = sizeof about->unfit;
  hid_t connectivity = h5_has(t->file, "connectivity") ? h5_open_group(t->file, "connectivity") : -1;
  find_strange(t->group, &known[0], unfit, size);
  if (!*unfit)
    find_strange(connectivity, &known[1], unfit, size);
  h5_close(connectivity);
  if (!*unfit && !masses && h5_has(t->group, "mass"))
    snprintf(unfit, size, "its mass is not one number for each row");
  if (!*unfit)
    check_ids(t, unfit, size);
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

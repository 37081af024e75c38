#include "files/foreign.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

#define LONGEST_NAME 63 /* as shown */

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
static void find_strange(struct frames *f, const char *group, const struct known *in, char *unfit, size_t size)
{
  const uint64_t links = far_look(&f->file, "", group).links;
  char name[1024] = "...", shown[256];
  for (uint64_t k = 0; k < links && !*unfit; k++) {
    if (far_link(&f->file, group, k, name, sizeof name) && is_known(in, name))
      continue;
    name[LONGEST_NAME] = '\0';
    snprintf(unfit, size, "it holds '%s%s', of which a run knows nothing; allowed: %s", in->group,
             text_escape(name, shown, sizeof shown), in->allowed);
  }
}

/* --- ids --------------------------------------------------------------------------------------------------------- */

/* A dataset [rows], or `value` [frames][rows] of a group: the row of the last frame. */
int64_t *foreign_ids(struct frames *f)
{
  struct message ignored;
  const uint64_t rows = f->about.rows;
  const char *group = f->layout.group;
  const bool timed = far_look(&f->file, group, "id").kind == FAR_GROUP;
  const char *name = timed ? "id/value" : "id";
  const struct far_thing id = f->about.frames > 0 ? far_look(&f->file, group, name) : (struct far_thing){0};
  if (!far_is(&id, 1 + timed) || id.class != FAR_INTEGERS || id.dims[timed] != rows)
    return NULL;
  int64_t *found = far_room(&f->file, (size_t)rows, sizeof *found, &ignored);
  if (found &&
      far_read(&f->file, group, name, timed ? f->about.frames - 1 : FAR_PLAIN, FAR_INTEGER, 1 + timed, id.dims, found))
    return found;
  free(found);
  return NULL;
}

/* Rows are in the order of their ids, which have no gaps. */
static void check_ids(struct frames *f, char *unfit, size_t size)
{
  int64_t *id = foreign_ids(f);
  if (!id && f->about.frames > 0 && far_has(&f->file, f->layout.group, "id"))
    snprintf(unfit, size, "its ids are not one whole number for each row");
  for (uint32_t k = 1; id && k < f->about.rows && !*unfit; k++)
    if (id[k - 1] == INT64_MAX || id[k] != id[k - 1] + 1)
      snprintf(unfit, size,
               "row %" PRIu32 " has the id %" PRId64 ", after %" PRId64 "; rows must be in the order of ids, without "
               "gaps",
               k, id[k], id[k - 1]);
  free(id);
}

/* --- what is told of numbers and box ----------------------------------------------------------------------------- */

/* An attribute `unit`, as H5MD has it, of an array or of its value. */
static void check_units(struct frames *f, char *unfit, size_t size)
{
  static const struct {
    const char *place[2], *name;
  } rows[] = {{{"position", "position/value"}, "position"},
              {{"velocity", "velocity/value"}, "velocity"},
              {{"mass", "mass/value"}, "mass"},
              {{"box/edges", "box/edges/value"}, "edges"}};
  char unit[32] = "?", shown[4 * sizeof unit];
  for (size_t k = 0; k < 2 * sizeof rows / sizeof *rows; k++) {
    const char *place = rows[k / 2].place[k % 2];
    if (!*unfit && far_get_text(&f->file, f->layout.group, place, "unit", 0, unit, sizeof unit) != 0)
      snprintf(unfit, size, "its %s has the unit '%s'; allowed: none, numbers in a0, t0 and m", rows[k / 2].name,
               text_escape(unit, shown, sizeof shown));
  }
}

static void check_dimension(struct frames *f, char *unfit, size_t size)
{
  int32_t dimension;
  if (far_get(&f->file, f->layout.group, "box", "dimension", FAR_SHORT, 0, &dimension) > 0 && dimension != 3)
    snprintf(unfit, size, "its box has %" PRId32 " dimensions; allowed: 3, which a plane has, too", dimension);
}

void foreign_look(struct frames *f)
{
  char *unfit = f->about.unfit, box[FAR_PATH];
  const size_t size = sizeof f->about.unfit;
  snprintf(box, sizeof box, "%s/box", f->layout.group);
  find_strange(f, f->layout.group, &known[0], unfit, size);
  find_strange(f, "connectivity", &known[1], unfit, size);
  find_strange(f, box, &known[2], unfit, size);
  if (!*unfit)
    check_dimension(f, unfit, size);
  check_units(f, unfit, size);
  if (!*unfit)
    snprintf(unfit, size, "%s", f->structure.odd_species);
  if (!*unfit && !f->structure.mass && far_has(&f->file, f->layout.group, "mass"))
    snprintf(unfit, size, "its mass is not one number for each row");
  if (!*unfit)
    check_ids(f, unfit, size);
}

/* --- frames ------------------------------------------------------------------------------------------------------ */

/* More than one, and none that is called as ours are. */
static bool one_group(struct frames *f, struct message *message)
{
  char name[2][1024] = {"", ""}, shown[2][256];
  const uint64_t links = far_look(&f->file, "", "particles").links;
  if (links <= 1 || far_has(&f->file, "particles", "trajectory"))
    return true;
  for (uint64_t k = 0; k < 2; k++)
    if (far_link(&f->file, "particles", k, name[k], sizeof name[k]))
      name[k][LONGEST_NAME] = '\0';
  return message_set(message,
                     "%s: it holds %" PRIu64 " groups of particles, '%s', '%s'%s; allowed: one, or one that is "
                     "called 'trajectory'",
                     f->path, links, text_escape(name[0], shown[0], sizeof shown[0]),
                     text_escape(name[1], shown[1], sizeof shown[1]), links > 2 ? ", ..." : "");
}

/* The step of each row of an element, to be freed: one by one, or of a fixed increment. NULL: not told. */
static int64_t *read_steps(struct frames *f, const char *element, uint64_t rows)
{
  struct message ignored;
  char path[64];
  int64_t increment = 0, begin = 0;
  snprintf(path, sizeof path, "%s/step", element);
  const struct far_thing step = far_look(&f->file, f->layout.group, path);
  const bool each = far_is(&step, 1) && step.dims[0] >= rows;
  if (!each && !far_is(&step, 0))
    return NULL;
  int64_t *steps = far_room(&f->file, (size_t)(each ? step.dims[0] : rows), sizeof *steps, &ignored);
  bool ok = steps && far_read(&f->file, f->layout.group, path, FAR_PLAIN, FAR_INTEGER, (int)step.rank, step.dims,
                              each ? steps : &increment);
  if (ok && !each)
    ok = far_get(&f->file, f->layout.group, path, "offset", FAR_INTEGER, 0, &begin) >= 0;
  for (uint64_t k = 0; ok && !each && k < rows; k++)
    steps[k] = (int64_t)((uint64_t)begin + k * (uint64_t)increment);
  if (!ok)
    free(steps);
  return ok ? steps : NULL;
}

/* The same; false, with a message, if steps are told that are not those of so many rows. *steps: NULL if none are told.
 * What this program wrote may end in the middle of a frame. */
static bool take_steps(struct frames *f, const char *element, uint64_t rows, int64_t **steps, struct message *message)
{
  char path[64];
  snprintf(path, sizeof path, "%s/step", element);
  *steps = read_steps(f, element, rows);
  return *steps || f->layout.ours || !far_has(&f->file, f->layout.group, path) ||
         message_set(message, "%s: its %s has no step that can be read for each of its %" PRIu64 " rows", f->path,
                     element, rows);
}

/* Of `value` of an element. */
static uint64_t count_rows(struct frames *f, const char *element)
{
  char path[64];
  snprintf(path, sizeof path, "%s/value", element);
  const struct far_thing value = far_look(&f->file, f->layout.group, path);
  return value.kind == FAR_DATASET && value.rank > 0 && value.rank <= 3 ? value.dims[0] : 0;
}

/* An element that changes with time: as many rows as positions, of the same steps. steps: [rows] of the positions,
 * NULL: not told. */
static bool steps_with(struct frames *f, const char *element, const int64_t *steps, uint64_t rows,
                       struct message *message)
{
  char path[64];
  snprintf(path, sizeof path, "%s/value", element);
  const bool timed = far_has(&f->file, f->layout.group, path);
  const uint64_t own = timed ? count_rows(f, element) : rows, both = own < rows ? own : rows;
  bool ok = own == rows || f->layout.ours ||
            message_set(message, "%s: its %s has %" PRIu64 " rows, its position %" PRIu64 "; allowed: as many", f->path,
                        element, own, rows);
  int64_t *its = NULL;
  if (ok && timed && steps)
    ok = take_steps(f, element, both, &its, message);
  for (uint64_t k = 0; ok && its && k < both; k++)
    if (its[k] != steps[k])
      ok = message_set(message,
                       "%s: its %s is of other steps than its position: row %" PRIu64 " is of step %" PRId64
                       ", not of %" PRId64,
                       f->path, element, k, its[k], steps[k]);
  free(its);
  return ok;
}

bool foreign_is_one(struct frames *f, struct message *message)
{
  static const char *const elements[] = {"velocity", "image", "id", "species", "box/edges"};
  const uint64_t rows = count_rows(f, "position");
  int64_t *steps = NULL;
  bool ok = one_group(f, message) && take_steps(f, "position", rows, &steps, message);
  for (size_t k = 0; ok && k < sizeof elements / sizeof *elements; k++)
    ok = steps_with(f, elements[k], steps, rows, message);
  free(steps);
  return ok;
}

/* --- images ------------------------------------------------------------------------------------------------------ */

bool foreign_unfold(struct frames *f, uint64_t frame)
{
  const size_t numbers = 3 * (size_t)f->about.rows;
  const struct picture *p = &f->picture;
  if (!f->layout.images)
    return true;
  const struct far_thing value = far_look(&f->file, f->layout.group, "image/value");
  const bool fits = p->edge[0] > 0.0 && far_is(&value, 3) && value.class == FAR_INTEGERS &&
                    value.dims[1] == f->about.rows && value.dims[2] == 3;
  int32_t *image = fits ? malloc((numbers + 1) * sizeof *image) : NULL;
  const bool ok = image && far_read(&f->file, f->layout.group, "image/value", frame, FAR_SHORT, 3, value.dims, image);
  for (size_t k = 0; ok && k < numbers; k++)
    p->position[k] += image[k] * p->edge[k % 3];
  free(image);
  return ok;
}

/*
 * The network around the bead: number density of vertices and how they are displaced from sample to sample, averaged in
 * cells around the bead. A table "wake" with a row for each cell; docs/observables.md has its columns.
 *
 * A cell is a shell of 0.5 a0, from the surface of the bead to half of the shortest edge of the box, of which a quarter
 * is taken: those directions from the center whose cosine with the drive is in one of four intervals. The four have the
 * same volume. A vertex belongs to the cell in which it stood at the sample before, and all displacements are those of
 * the laboratory.
 */
#include <math.h>
#include <stdlib.h>

#include "observe/block.h"
#include "observe/observer.h"
#include "system/bead.h"

/* Quantities of a cell, each a pair (x, y). */
enum {
  ALONG, /* displacement along the drive, number */
  AWAY,  /* displacement away from the line through the center along the drive, number */
  QUANTITIES
};

enum { LEVELS = 24, SECTORS = 4 };
#define SHELL 0.5 /* a0 */

/* Integers: where bead and vertices were at the sample before, behind: */
enum { MARK, SEEN, PLACES }; /* SEEN: 1 after the first sample */

/* Sums over the vertices of a cell. */
struct cell {
  double n, along, away;
};

static uint32_t shells_of(const struct model *model)
{
  return (uint32_t)((0.5 * box_shortest_edge(&model->box) - model->bead.radius) / SHELL);
}

static uint32_t cells_of(const struct model *model)
{
  return shells_of(model) * SECTORS;
}

static void size_wake(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  (void)observer;
  const size_t cells = cells_of(model);
  size->reals = cells * QUANTITIES * LEVELS * BLOCK_LEVEL_DOUBLES;
  size->integers = PLACES + 3 * (1 + (size_t)model->vertices);
  size->scratch = cells * sizeof(struct cell) / sizeof(double);
}

static struct block_level *blocks_of(const struct observer *o, uint32_t cell, int quantity)
{
  return (struct block_level *)o->real + ((size_t)cell * QUANTITIES + (size_t)quantity) * LEVELS;
}

/* Direction of the drive: of its force, else of what its trap does, else x. */
static struct vec3 axis_of(const struct model *model)
{
  const struct bead_drive *d = &model->bead.drive;
  const struct vec3 choice[] = {d->force, d->velocity, d->amplitude, {1, 0, 0}};
  int k = 0;
  while (!(vec3_norm(choice[k]) > 0.0))
    k++;
  return vec3_scale(1.0 / vec3_norm(choice[k]), choice[k]);
}

/* A vertex that stood at this place relative to the bead's center, and has gone so far since, a0. */
static void add_vertex(struct cell *cell, const struct model *model, struct vec3 axis, struct vec3 place,
                       struct vec3 gone)
{
  const double distance = vec3_norm(place), along = vec3_dot(axis, place);
  const double shell = (distance - model->bead.radius) / SHELL, sector = 0.5 * SECTORS * (1.0 + along / distance);
  const struct vec3 out = vec3_add_scaled(place, -along, axis);
  const double across = vec3_norm(out);
  if (!(shell >= 0.0 && shell < shells_of(model)))
    return;
  struct cell *c = &cell[SECTORS * (uint32_t)shell + (uint32_t)fmin(fmax(sector, 0.0), SECTORS - 1)];
  c->n += 1.0;
  c->along += vec3_dot(axis, gone);
  c->away += across > 0.0 ? vec3_dot(out, gone) / across : 0.0;
}

static struct point before_of(const struct observer *o, uint32_t number)
{
  const int64_t *at = &o->integer[PLACES + 3 * (size_t)number];
  return (struct point){at[0], at[1], at[2]};
}

static void remember(struct observer *o, uint32_t number, struct point place)
{
  int64_t *at = &o->integer[PLACES + 3 * (size_t)number];
  at[0] = place.x, at[1] = place.y, at[2] = place.z;
}

static void add_wake(struct observer *o, struct view *view)
{
  const struct model *model = view->model;
  const struct state *state = view->state;
  const struct vec3 axis = axis_of(model);
  const struct point bead = before_of(o, 0);
  struct cell *cell = (struct cell *)o->scratch;
  for (uint32_t k = 0; k < cells_of(model); k++)
    cell[k] = (struct cell){0.0, 0.0, 0.0};
  for (uint32_t i = 0; i < state->vertices; i++) {
    const struct point from = before_of(o, 1 + i), to = state->position[i];
    remember(o, 1 + i, to);
    if (o->integer[SEEN])
      add_vertex(cell, model, axis, point_in_a0(bead_to_image(&model->box, bead, from)), point_difference(to, from));
  }
  remember(o, 0, state->bead->position);
  for (uint32_t k = 0; k < cells_of(model) && o->integer[SEEN]; k++) {
    block_add(blocks_of(o, k, ALONG), LEVELS, cell[k].along, cell[k].n);
    block_add(blocks_of(o, k, AWAY), LEVELS, cell[k].away, cell[k].n);
  }
  o->integer[SEEN] = 1;
}

/* --- the table --------------------------------------------------------------------------------------------------- */

static const char *const columns[] = {"distance",    "cosine", "number",     "number_error", "along",
                                      "along_error", "away",   "away_error", "samples"};

enum { COLUMNS = sizeof columns / sizeof *columns };

static void fill_row(const struct observer *o, const struct model *model, uint32_t k, double *cell)
{
  const uint32_t shell = k / SECTORS;
  const double inner = model->bead.radius + SHELL * shell, outer = inner + SHELL,
               volume = 4.0 / 3.0 * 3.14159265358979323846 * (outer * outer * outer - inner * inner * inner) / SECTORS;
  const struct block_level *number = blocks_of(o, k, ALONG);
  cell[0] = 0.5 * (inner + outer);
  cell[1] = (2.0 * (k % SECTORS) + 1.0) / SECTORS - 1.0;
  cell[2] = number->count > 0.0 ? number->mean[1] / volume : NAN;
  cell[3] = block_error(number, LEVELS, 0.0, 1.0 / volume);
  block_ratio(blocks_of(o, k, ALONG), LEVELS, &cell[4]);
  block_ratio(blocks_of(o, k, AWAY), LEVELS, &cell[6]);
  cell[8] = number->count;
}

static bool summarise_wake(const struct observer *o, const struct model *model, const struct observer_take *to)
{
  const uint32_t rows = cells_of(model);
  double *value = calloc((size_t)rows * COLUMNS, sizeof *value);
  if (!value)
    return false;
  for (uint32_t k = 0; k < rows; k++)
    fill_row(o, model, k, value + (size_t)k * COLUMNS);
  const struct observe_table table = {"wake", columns, COLUMNS, rows, value};
  const bool ok = to->take(to->context, &table);
  free(value);
  return ok;
}

const struct observer_type wake_observer = {
    .size = size_wake,
    .add = add_wake,
    .summarise = summarise_wake,
};

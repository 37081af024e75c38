/* Handles of trajectories, and the rows of a frame. */
#include "files/trajectory.h"
#include "files/frames.h"
#include "fluid/fluid.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

/* --- opening and closing ----------------------------------------------------------------------------------------- */

struct trajectory *trajectory_allocate(const char *path)
{
  struct trajectory *t = calloc(1, sizeof *t);
  if (!t)
    return NULL;
  t->file = t->position = t->velocity = t->edges = t->step = t->time = t->checksum = -1;
  t->path = strdup(path);
  if (!t->path) {
    free(t);
    return NULL;
  }
  return t;
}

bool trajectory_close(struct trajectory *t, struct message *message)
{
  if (!t)
    return true;
  const hid_t handles[] = {t->position, t->velocity, t->edges, t->step, t->time, t->checksum};
  bool ok = true;
  for (size_t k = 0; k < sizeof handles / sizeof *handles; k++)
    ok &= h5_close(handles[k]);
  ok &= h5_close_locked(t->file);
  if (!ok)
    h5_fail(message, t->path, "not closed properly, its last frames may be lost");
  free(t->path);
  free(t->row);
  free(t->slot);
  free(t);
  return ok;
}

struct trajectory *trajectory_give_up(struct trajectory *t)
{
  struct message ignored;
  trajectory_close(t, &ignored);
  return NULL;
}

/* --- rows of a frame --------------------------------------------------------------------------------------------- */

void frame_positions(const struct state *state, const struct model *model, const uint32_t *slot, double *row)
{
  for (uint32_t v = 0; v < state->vertices; v++, row += 3) {
    const struct vec3 r = point_in_a0(state->position[v]);
    memcpy(row, &r, sizeof r);
  }
  for (uint32_t id = 0; slot && id < state->solvent.n; id++, row += 3) {
    const struct vec3 r = point_in_a0(fluid_position_now(state, model, slot[id]));
    memcpy(row, &r, sizeof r);
  }
}

void frame_velocities(const struct state *state, const struct model *model, const uint32_t *slot, double *row)
{
  memcpy(row, state->velocity, state->vertices * sizeof *state->velocity);
  row += 3 * (size_t)state->vertices;
  for (uint32_t id = 0; slot && id < state->solvent.n; id++, row += 3) {
    const struct vec3 v = fluid_velocity_now(state, model, slot[id]);
    memcpy(row, &v, sizeof v);
  }
}

/* --- checksums --------------------------------------------------------------------------------------------------- */

uint64_t frame_sum_moment(uint64_t frame, int64_t step, double time)
{
  const struct {
    int64_t step;
    double time;
  } moment = {step, time};
  return XXH64(&moment, sizeof moment, frame);
}

uint64_t frame_sum_numbers(uint64_t frame, const double *number, size_t count)
{
  return XXH64(number, count * sizeof *number, frame);
}

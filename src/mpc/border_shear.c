/*
 * A collision in a sheared box (Lees and Edwards). Cells stay cubes, whatever the shear: a member at y belongs to image
 * j = floor((y + shift)/L) along y, and its cell holds the point (x - j Delta, y - j L) with the velocity
 * v_x - j rate L. So the row of cells that straddles the boundary holds members of both sides, each with its place and
 * velocity as seen from there. They take both before the collision (`enter`) and give them back after it (`leave`).
 */
#include "mpc/border.h"
#include "mpc/grid.h"
#include "wall/motion.h"

/* How the next image along y differs, at the time of this collision: where it is, and how fast it was during the
 * interval that ends now. */
struct slide {
  int64_t offset; /* along x, lattice units in [0, edge) */
  double speed;   /* along x, a0/t0 */
};

static struct slide slide_now(const struct state *state, const struct model *model)
{
  const uint64_t now = state->solvent_time + state->solvent_lag, interval = shear_interval(model, now);
  const uint64_t ended = interval > 0 ? interval - 1 : 0;
  return (struct slide){shear_offset(model, now), shear_rate(model, ended) * model->box.cells[1]};
}

static void enter_one(struct solvent *s, const struct model *model, struct slide slide, uint32_t i, struct mpc *c)
{
  s->x[i] -= slide.offset;
  s->x[i] += s->x[i] < 0 ? model->box.edge[0] : 0;
  s->vx[i] -= slide.speed;
  c->order[c->entered++] = i;
}

/* True if one of n particles is at `beyond` or above. */
static bool any_beyond(const int64_t *y, uint32_t n, int64_t beyond)
{
  int64_t less = 0;
  for (uint32_t i = 0; i < n; i++)
    less |= beyond - 1 - y[i];
  return less < 0;
}

/* Particles are in the box: their image is 0, or 1 if the shift takes them beyond y = L. mpc->order lists the latter;
 * it is free until particles are sorted. They are few, so that most handfuls are passed over without a branch for each
 * particle. */
static void enter(struct state *state, const struct model *model, uint32_t first, uint32_t n, struct mpc *c)
{
  enum { HANDFUL = 32 };
  struct solvent *s = &state->solvent;
  const struct slide slide = slide_now(state, model);
  const int64_t beyond = model->box.edge[1] - c->shift.y;
  const uint32_t end = first + n;
  for (uint32_t from = first; from < end; from += HANDFUL) {
    const uint32_t to = end - from < HANDFUL ? end : from + HANDFUL;
    if (!any_beyond(&s->y[from], to - from, beyond))
      continue;
    for (uint32_t i = from; i < to; i++)
      if (s->y[i] >= beyond)
        enter_one(s, model, slide, i, c);
  }
}

static int64_t image_of(const struct state *state, const struct model *model, const struct mpc *c, uint32_t v)
{
  return lattice_image(state->position[v].y + c->shift.y, model->box.edge[1]);
}

static void enter_vertices(struct state *state, const struct model *model, struct mpc *c)
{
  const struct slide slide = slide_now(state, model);
  for (uint32_t v = 0; v < state->vertices; v++) {
    const int64_t image = image_of(state, model, c, v);
    state->position[v].x -= image * slide.offset;
    state->velocity[v].x -= (double)image * slide.speed;
  }
}

static void leave(struct state *state, const struct model *model, struct mpc *c)
{
  struct solvent *s = &state->solvent;
  const struct slide slide = slide_now(state, model);
  const int64_t edge = model->box.edge[0];
  for (uint32_t k = 0; k < c->entered; k++) {
    const uint32_t i = c->order[k];
    s->x[i] += slide.offset;
    s->x[i] -= s->x[i] >= edge ? edge : 0;
    s->vx[i] += slide.speed;
  }
  for (uint32_t v = 0; v < state->vertices; v++) {
    const int64_t image = image_of(state, model, c, v);
    state->position[v].x += image * slide.offset;
    state->velocity[v].x += (double)image * slide.speed;
  }
}

const struct border border_sheared = {.name = "shear",
                                      .enter = enter,
                                      .enter_vertices = enter_vertices,
                                      .bin_particles = grid_bin_particles,
                                      .bin_vertices = grid_bin_vertices,
                                      .leave = leave};

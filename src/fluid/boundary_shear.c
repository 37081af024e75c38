/*
 * A sheared box: the images beyond y = 0 and y = L slide along x (Lees and Edwards, J. Phys. C 5, 1921 (1972)).
 *
 * Particles fly freely in the laboratory frame. One that ends in image j along y is replaced by its image in the box:
 * y - j L, x - j Delta, v_x - j rate L. Delta says how far the image beyond y = L has slid at the end of the flight. It
 * is a whole number of lattice units (wall/motion.h), so positions are exact at all times.
 */
#include "fluid/boundary.h"
#include "wall/motion.h"

struct slide boundary_slide(const struct model *model, uint64_t half_steps, uint64_t interval)
{
  return (struct slide){shear_offset(model, half_steps), shear_rate(model, interval) * model->box.cells[1]};
}

static struct slide slide_at_end(const struct model *model, const struct span *span)
{
  return boundary_slide(model, span->end, span->interval);
}

/* Adds the flights. The sign bit of the result is set if a particle is outside. Nothing accelerates along y. */
static int64_t fly_along_y(uint32_t n, int64_t *restrict y, const double *restrict v, double t, int64_t edge)
{
  int64_t outside = 0;
  for (uint32_t i = 0; i < n; i++) {
    const int64_t p = (int64_t)((uint64_t)y[i] + (uint64_t)boundary_flight(v[i], 0.0, t));
    outside |= p | (int64_t)((uint64_t)(edge - 1) - (uint64_t)p);
    y[i] = p;
  }
  return outside;
}

/* True if one of n particles is outside along y. */
static bool any_outside(const int64_t *y, uint32_t n, int64_t edge)
{
  int64_t outside = 0;
  for (uint32_t i = 0; i < n; i++)
    outside |= y[i] | (int64_t)((uint64_t)(edge - 1) - (uint64_t)y[i]);
  return outside < 0;
}

/* Few are outside, so that most handfuls are passed over without a branch for each particle. */
static bool bring_all_in(struct state *state, const struct model *model, const struct span *span, uint32_t first,
                         uint32_t n, struct fault *fault)
{
  enum { HANDFUL = 32 };
  struct solvent *s = &state->solvent;
  const struct slide slide = slide_at_end(model, span);
  const uint32_t end = first + n;
  for (uint32_t from = first; from < end; from += HANDFUL) {
    const uint32_t to = end - from < HANDFUL ? end : from + HANDFUL;
    if (!any_outside(&s->y[from], to - from, model->box.edge[1]))
      continue;
    for (uint32_t i = from; i < to; i++) {
      if ((uint64_t)s->y[i] < (uint64_t)model->box.edge[1])
        continue;
      const double move = s->vy[i] * span->time;
      if (!(fabs(move) < LATTICE_MAX_MOVE))
        return fault_record(fault, FAULT_SOLVENT_MOVE, state->step + 1, s->id[i], move, LATTICE_MAX_MOVE);
      boundary_bring_in(&model->box, slide, &s->x[i], &s->y[i], &s->vx[i]);
    }
  }
  return true;
}

static bool fly_block(struct state *state, const struct model *model, const struct span *span, uint32_t first,
                      uint32_t n, struct fault *fault)
{
  struct solvent *s = &state->solvent;
  const double t = span->time;
  const int64_t *edge = model->box.edge;
  int64_t outside = boundary_fly_periodic(n, &s->x[first], &s->vx[first], t, span->acceleration.x, edge[0]);
  outside |= boundary_fly_periodic(n, &s->z[first], &s->vz[first], t, span->acceleration.z, edge[2]);
  if (outside < 0 &&
      !(boundary_fold(state, model, 0, t, first, n, fault) && boundary_fold(state, model, 2, t, first, n, fault)))
    return false;
  return fly_along_y(n, &s->y[first], &s->vy[first], t, edge[1]) >= 0 ||
         bring_all_in(state, model, span, first, n, fault);
}

static bool fly_sheared(struct state *state, const struct model *model, const struct span *span, uint32_t first,
                        uint32_t n, struct fault *fault)
{
  for (uint32_t i = 0; i < n; i += BOUNDARY_BLOCK)
    if (!fly_block(state, model, span, first + i, boundary_block(n, i), fault))
      return false;
  return true;
}

static void now_sheared(const struct model *model, const struct span *span, struct point *x, struct vec3 *v)
{
  const struct vec3 a = span->acceleration;
  const int64_t *edge = model->box.edge;
  x->x = lattice_fold(x->x + boundary_flight(v->x, a.x, span->time), edge[0]);
  x->z = lattice_fold(x->z + boundary_flight(v->z, a.z, span->time), edge[2]);
  x->y += boundary_flight(v->y, 0.0, span->time);
  *v = vec3_add_scaled(*v, span->time, a);
  boundary_bring_in(&model->box, slide_at_end(model, span), &x->x, &x->y, &v->x);
}

const struct boundary boundary_sheared = {"shear", fly_sheared, now_sheared};

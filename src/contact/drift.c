#include "contact/drift.h"

#include <math.h>

#include "contact/rule.h"
#include "contact/wall.h"

enum { BLOCK = 64 }; /* vertices worked on at a time */

/* --- the frame --------------------------------------------------------------------------------------------------- */

__extension__ typedef __int128 wide;

/* a/b rounded down, b > 0 */
static int64_t divide_down(wide a, int64_t b)
{
  const wide q = a / b;
  return (int64_t)(q - (q * b > a));
}

/* The nearest whole number to slide (y - L/2)/L, halves up. So y + L gives `slide` more, exactly: all images are moved
 * alike. */
static int64_t sheared_by(const struct drift_frame *f, int64_t slide, int64_t y)
{
  return divide_down(2 * (wide)slide * (y - f->middle) + f->edge, 2 * f->edge);
}

struct drift_frame drift_frame_now(const struct state *state, const struct model *model, double fraction,
                                   uint32_t drift, bool forbids)
{
  struct drift_frame f = {.velocity = model_frame_velocity(model), .time = fraction * model->time_step};
  f.start = drift * f.time - 0.5 * model->time_step;
  const uint64_t now = state->solvent_time + state->solvent_lag;
  f.sheared = forbids && model_is_sheared(model);
  f.slit = slit_during(model, shear_interval(model, now));
  if (!model_is_sheared(model))
    return f;
  const int64_t edge = model->box.edge[0], before = shear_offset(model, now),
                after = shear_offset(model, now + (fraction == 0.5 ? 1 : 2));
  int64_t step = lattice_fold(after - before, edge);
  step -= 2 * step > edge ? edge : 0;
  f.edge = model->box.edge[1];
  f.middle = f.edge / 2;
  f.slid = 2 * before > edge ? before - edge : before;
  f.slides = f.slid + step;
  f.strain = (double)f.slides / (double)f.edge;
  f.growth = (double)step / (double)f.edge;
  f.image_speed = shear_rate(model, shear_interval(model, now)) * model->box.cells[1];
  return f;
}

struct point drift_enter(const struct drift_frame *f, struct point p)
{
  return (struct point){p.x - sheared_by(f, f->slid, p.y), p.y, p.z};
}

struct point drift_leave(const struct drift_frame *f, struct point p)
{
  return (struct point){p.x + sheared_by(f, f->slides, p.y), p.y, p.z};
}

struct point drift_place(const struct drift_frame *f, struct point p, double part)
{
  const double strain = f->strain - (1.0 - part) * f->growth;
  return f->sheared ? (struct point){p.x + lattice_round(strain * (double)(p.y - f->middle)), p.y, p.z} : p;
}

/* --- moves ------------------------------------------------------------------------------------------------------- */

bool drift_legal(const struct state *state, const struct model *model, uint32_t i, struct vec3 d, struct fault *fault)
{
  const double limit = model_longest_bond(model);
  if (fabs(d.x) < limit && fabs(d.y) < limit && fabs(d.z) < limit)
    return true;
  const double far = fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z)));
  return fault_record(fault, FAULT_VERTEX_MOVE, state->step + 1, i, far, limit);
}

bool drift_trial(const struct state *state, const struct model *model, const struct drift_frame *frame, uint32_t i,
                 struct point *to, struct fault *fault)
{
  const struct vec3 d = drift_displacement(frame, state->velocity[i], state->position[i].y);
  if (!drift_legal(state, model, i, d, fault))
    return false;
  *to = point_move(state->position[i], d);
  return true;
}

/* What a shear of the box adds to the displacements of n vertices. Not 0 if one is beyond the limit. */
static int64_t shear_displacements(const struct drift_frame *frame, const struct point *restrict p, uint32_t n,
                                   double limit, struct vec3 *restrict d)
{
  int64_t beyond = 0;
  for (uint32_t k = 0; k < n; k++) {
    d[k].x = drift_sheared(frame, d[k], p[k].y);
    beyond |= !(fabs(d[k].x) < limit);
  }
  return beyond;
}

bool drift_displacements(const struct state *state, const struct model *model, const struct drift_frame *frame,
                         uint32_t first, uint32_t n, struct vec3 *restrict d, struct fault *fault)
{
  const struct vec3 *restrict v = &state->velocity[first], velocity = frame->velocity;
  const double limit = model_longest_bond(model), time = frame->time;
  int64_t beyond = 0;
  for (uint32_t k = 0; k < n; k++) {
    d[k] = vec3_scale(time, vec3_sub(v[k], velocity));
    beyond |= !(fabs(d[k].x) < limit) | !(fabs(d[k].y) < limit) | !(fabs(d[k].z) < limit);
  }
  if (frame->sheared)
    beyond |= shear_displacements(frame, &state->position[first], n, limit, d);
  for (uint32_t k = 0; beyond && k < n; k++)
    if (!drift_legal(state, model, first + k, d[k], fault))
      return false;
  return true;
}

/* Moves all vertices to their trial positions. Those that would be beyond a wall hit it. */
static bool drift_free(struct state *state, const struct model *model, struct contact *contact, uint64_t step,
                       uint32_t drift, const struct contact_log *log, struct fault *fault)
{
  (void)step, (void)drift, (void)log;
  struct vec3 d[BLOCK];
  const bool walls = model_has_walls(model);
  if (walls && !wall_find_hits(state, model, contact, fault))
    return false;
  for (uint32_t first = 0; first < state->vertices; first += BLOCK) {
    const uint32_t n = state->vertices - first < BLOCK ? state->vertices - first : BLOCK;
    if (!drift_displacements(state, model, &contact->frame, first, n, d, fault))
      return false;
    struct point *restrict p = &state->position[first];
    for (uint32_t k = 0; k < n; k++)
      p[k] = point_move(p[k], d[k]);
  }
  if (walls)
    wall_answer_hits(state, model, contact);
  return true;
}

const struct crossing_rule free_rule = {"free", false, false, drift_free};

#include "system/sound.h"

#include <math.h>

#include "base/vec3.h"

static double furthest(struct vec3 r)
{
  return fmax(fabs(r.x), fmax(fabs(r.y), fabs(r.z)));
}

/* The component that is not finite, if one is not. */
static bool finite(struct vec3 v, double *component)
{
  const double parts[3] = {v.x, v.y, v.z};
  int k = 0;
  while (k < 3 && isfinite(parts[k]))
    k++;
  *component = k < 3 ? parts[k] : 0.0;
  return k == 3;
}

static bool vertices_sound(const struct state *s, const struct model *m, struct fault *fault)
{
  const double limit = model_longest_bond(m);
  const uint32_t lost = state_lost_vertex(s);
  double component;
  if (lost < s->vertices)
    return fault_record(fault, FAULT_VERTEX_PLACE, s->step, lost, furthest(point_in_a0(s->position[lost])),
                        (double)LATTICE_REACH * LATTICE_UNIT);
  for (uint32_t j = 0; j < s->vertices; j++) {
    if (!finite(s->velocity[j], &component))
      return fault_record(fault, FAULT_VERTEX_MOVE, s->step, j, component * m->time_step, limit);
    if (model_has_walls(m) && box_inside(&m->box, 1, s->position[j].y) != s->position[j].y)
      return fault_record(fault, FAULT_VERTEX_WALL, s->step, j, (double)s->position[j].y * LATTICE_UNIT,
                          m->box.cells[1]);
    if (!m->next || m->next[j] < 0)
      continue;
    const double length = vec3_norm(point_difference(s->position[m->next[j]], s->position[j]));
    if (!(length < limit))
      return fault_record(fault, FAULT_BOND_TOO_LONG, s->step, j, length, limit);
  }
  return true;
}

/* The flight of a component since the solvent was last streamed, and a bound of it; no number if v is none. */
static double flight(double v, double a, double t)
{
  return fabs(v * t) + 0.5 * fabs(a) * t * t;
}

static bool solvent_sound(const struct state *s, const struct model *m, struct fault *fault)
{
  const struct solvent *p = &s->solvent;
  const int64_t *at[3] = {p->x, p->y, p->z};
  const double *v[3] = {p->vx, p->vy, p->vz}, t = 0.5 * s->solvent_lag * m->time_step;
  const double a[3] = {m->solvent.acceleration.x, m->solvent.acceleration.y, m->solvent.acceleration.z};
  for (uint32_t i = 0; i < p->n; i++)
    for (int k = 0; k < 3; k++) {
      if (at[k][i] < 0 || at[k][i] >= m->box.edge[k] + (m->box.boundary[k] == BOUNDARY_WALL)) /* on a wall is inside */
        return fault_record(fault, FAULT_SOLVENT_PLACE, s->step, p->id[i], (double)at[k][i] * LATTICE_UNIT,
                            m->box.cells[k]);
      if (!isfinite(v[k][i]) || !(flight(v[k][i], a[k], t) < LATTICE_MAX_MOVE))
        return fault_record(fault, FAULT_SOLVENT_MOVE, s->step, p->id[i],
                            isfinite(v[k][i]) ? flight(v[k][i], a[k], t) : v[k][i], LATTICE_MAX_MOVE);
    }
  return true;
}

/* The vector of a dumbbell leads from the second particle to the first, or to one of its images. Along x the images of
 * a sheared box are anywhere. */
static bool dumbbells_sound(const struct state *s, const struct model *m, struct fault *fault)
{
  const struct dumbbells *d = &s->dumbbells;
  const int64_t *at[3] = {s->solvent.x, s->solvent.y, s->solvent.z}, *apart[3] = {d->x, d->y, d->z};
  const int64_t longest = (int64_t)LATTICE_MAX_MOVE * LATTICE_CELL;
  for (uint32_t p = 0; p < d->n; p++)
    for (int k = 0; k < 3; k++) {
      const int64_t r = apart[k][p], between = at[k][2 * p] - at[k][2 * p + 1];
      const bool wall = m->box.boundary[k] == BOUNDARY_WALL, slides = k == 0 && m->box.boundary[1] == BOUNDARY_SHEAR;
      if (r < -longest || r > longest || (wall && r != between) ||
          (!wall && !slides && lattice_fold(r, m->box.edge[k]) != lattice_fold(between, m->box.edge[k])))
        return fault_record(fault, FAULT_DUMBBELL, s->step, d->id[p], fabs((double)r * LATTICE_UNIT), LATTICE_MAX_MOVE);
    }
  return true;
}

bool state_sound(const struct state *state, const struct model *model, struct fault *fault)
{
  return vertices_sound(state, model, fault) && solvent_sound(state, model, fault) &&
         dumbbells_sound(state, model, fault);
}

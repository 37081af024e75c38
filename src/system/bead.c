#include "system/bead.h"

#include <math.h>

__extension__ typedef __int128 wide;

/* x folded into [-edge/2, edge/2). */
static int64_t nearest(int64_t x, int64_t edge)
{
  return lattice_fold(x + edge / 2, edge) - edge / 2;
}

struct point bead_to_image(const struct box *box, struct point from, struct point to)
{
  return (struct point){nearest(to.x - from.x, box->edge[0]), nearest(to.y - from.y, box->edge[1]),
                        nearest(to.z - from.z, box->edge[2])};
}

bool bead_is_outside(const struct model *model, struct point center, struct point place)
{
  const struct point d = bead_to_image(&model->box, center, place);
  const wide r = bead_radius(model);
  return (wide)d.x * d.x + (wide)d.y * d.y + (wide)d.z * d.z >= r * r;
}

/* Particles of a few thermal velocities must not reach an image of the bead. */
bool bead_fits(const struct model *m, struct model_error *error)
{
  const double half = 0.5 * box_shortest_edge(&m->box), beside = 2.0 + 20.0 * m->solvent.collision_interval;
  if (!model_has_bead(m))
    return true;
  return m->bead.radius + beside <= half ||
         model_reject(
             error, "bead.radius",
             "%.6g a0 in a box whose shortest edge is %d a0; allowed: at most %.6g a0, half the edge less 2 a0 "
             "and 20 collision intervals",
             m->bead.radius, box_shortest_edge(&m->box), fmax(0.0, half - beside));
}

static bool check_company(const struct model *m, struct model_error *error)
{
  const struct solvent_model *s = &m->solvent;
  const struct {
    bool ok;
    const char *path, *why;
  } rows[] = {
      {model_has_solvent(m), "bead", "it needs solvent particles, and there are none; allowed with a solvent"},
      {m->dimensions == 3, "dimensions", "a sphere is not in a plane; allowed with a bead: 3"},
      {m->medium.kind == 0, "medium", "its pairs do not know the bead; allowed with a bead: no medium"},
      {m->kinds == 0, "fibers", "a bead does not touch fibers yet; allowed with a bead: no fibers"},
      {m->walls.kind == WALL_ABSENT, "walls", "a bead does not touch walls; allowed with a bead: no walls"},
      {m->shear.rate == 0.0, "shear", "a bead has no image that moves; allowed with a bead: no shear"},
      {m->dumbbells.pairs == 0, "dumbbells", "springs do not touch a bead; allowed with a bead: no dumbbells"},
      {s->rule != RULE_AT_PLUS_A, "solvent.rule",
       "virtual particles of a bead have no angular momentum; allowed with a bead: srd | at-a"},
      {s->thermostat == THERMOSTAT_NONE, "solvent.thermostat",
       "its factors do not know the bead's virtual particles; allowed with a bead: none (rule: at-a holds kT = 1)"},
      {s->hydrodynamics, "solvent.hydrodynamics",
       "velocities that are permuted drag no bead; allowed with a bead: "
       "true"},
      {vec3_norm(s->acceleration) == 0.0, "solvent.acceleration",
       "the solvent around a bead is not accelerated; allowed with a bead: [0, 0, 0]"},
      {m->solvent.interval_steps == 1, "time_step",
       "a bead is moved with the solvent; allowed with a bead: the collision interval"},
      {m->scheme != SCHEME_DRIFT_SPLIT, "order",
       "half a drift would be late between steps; allowed with a bead: paper | kick-split"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (!rows[i].ok)
      return model_reject(error, rows[i].path, "%s", rows[i].why);
  return true;
}

bool bead_finish(struct model *m, struct model_error *error)
{
  const double displaced = m->solvent.per_cell * bead_volume(m);
  if (!model_has_bead(m))
    return true;
  if (!check_company(m, error))
    return false;
  if (m->bead.mass == 0.0)
    m->bead.mass = displaced;
  return m->bead.mass >= displaced ||
         model_reject(error, "bead.mass", "%.15g m, and the solvent it displaces has %.15g m; allowed: at least that",
                      m->bead.mass, displaced);
}

bool bead_sound(const struct state *state, const struct model *model, struct fault *fault)
{
  const struct solvent *s = &state->solvent;
  for (uint32_t i = 0; state->beads > 0 && i < s->n; i++) {
    const struct point x = {s->x[i], s->y[i], s->z[i]}, center = state->bead->position;
    if (!bead_is_outside(model, center, x))
      return fault_record(fault, FAULT_IN_BEAD, state->step, s->id[i],
                          vec3_norm(point_in_a0(bead_to_image(&model->box, center, x))), model->bead.radius);
  }
  return true;
}

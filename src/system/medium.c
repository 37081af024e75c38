#include "system/medium.h"

#include <math.h>

/* A row per thing that a medium cannot do. */
struct refusal {
  bool ok;
  const char *path, *why;
};

static bool refuse_first(const struct refusal *rows, size_t count, struct model_error *error)
{
  for (size_t k = 0; k < count; k++)
    if (!rows[k].ok)
      return model_reject(error, rows[k].path, "%s", rows[k].why);
  return true;
}

static bool check_company(const struct model *m, struct model_error *error)
{
  const bool alone = m->solvent.per_cell == 0.0 && m->solvent.collision_interval == 0.0;
  const struct refusal rows[] = {
      {alone, "medium", "there is a solvent of collision cells too; allowed: one of the two"},
      {m->dumbbells.spring == 0.0, "dumbbells",
       "only a solvent of collision cells has springs; allowed without a medium"},
      {m->walls.kind == WALL_ABSENT, "walls",
       "only a solvent of collision cells has rules for walls; allowed without a medium"},
      {!m->medium.inextensible || model_is_overdamped(m), "medium.inextensible",
       "only vertices without velocities are held by tension; allowed with kind: overdamped"},
      {m->shear.rate == 0.0 && m->shear.strain == 0.0, "shear",
       "only a solvent of collision cells has rules for images that slide; allowed without a medium"},
  };
  return refuse_first(rows, sizeof rows / sizeof *rows, error);
}

static bool check_rate(const struct model *m, struct model_error *error)
{
  const struct medium_model *b = &m->medium;
  return model_is_overdamped(m) || b->draw != DRAW_REPLACE || b->rate * m->time_step <= 1.0 + 1e-12 ||
         model_reject(
             error, "medium.rate",
             "%.15g times the time step %.15g is %.6g, which is no probability; allowed with draw: replace: up "
             "to %.15g",
             b->rate, m->time_step, b->rate * m->time_step, 1.0 / m->time_step);
}

static bool finish_private(struct model *m, struct model_error *error)
{
  const struct refusal rows[] = {
      {m->kinds > 0, "medium.kind", "a private bath is one of vertices, and there are no fibers; allowed: pairs"},
      {m->medium.density == 0.0, "medium.density", "a private bath has no particles; allowed with kind: pairs"},
      {m->medium.weight == WEIGHT_HAT, "medium.weight",
       "a private bath knows no distances; allowed: hat, which has no effect there"},
      {!model_repels(m), "medium.kind", "a private bath knows no distances, so no repulsion; allowed with it: pairs"},
  };
  return refuse_first(rows, sizeof rows / sizeof *rows, error);
}

/* What forces of pairs ask for. A contact of the event-driven rule needs the forces on its vertices at its own time. */
static bool check_forces(struct model *m, struct model_error *error)
{
  const struct medium_model *b = &m->medium;
  const bool chases = m->crossing.forbidden && m->crossing.rule == CROSSING_EVENT_DRIVEN && m->kinds > 0;
  const struct refusal rows[] = {
      {b->repulsion >= 0.0 || b->many.repulsion > 0.0, "medium.repulsion",
       "an attraction without many_body, under which all members fall onto each other; allowed: 0 and more"},
      {!model_repels(m) || !chases, "crossing.rule",
       "forces of particles are known once in a step, and contacts need them at their own time; allowed with "
       "repulsion: "
       "sequential"},
  };
  if (!refuse_first(rows, sizeof rows / sizeof *rows, error))
    return false;
  const double others = nearbyint(b->second.share * m->solvent.particles);
  m->medium.second.first = m->solvent.particles - (uint32_t)others;
  return b->second.share == 0.0 || others >= 1.0 ||
         model_reject(error, "medium.second.share",
                      "%.15g of %u particles is a group that no one has; allowed: 1 "
                      "particle and more",
                      b->second.share, m->solvent.particles);
}

static double count_vertices(const struct model *m)
{
  double vertices = 0.0;
  for (uint32_t k = 0; k < m->kinds; k++)
    vertices += (double)m->kind[k].count * m->kind[k].vertices;
  return vertices;
}

/* The pairs are found in cells of edge 1 a0 and their neighbors: three along each edge, so that no pair is met twice.
 */
static bool finish_pairs(struct model *m, struct model_error *error)
{
  const double particles = nearbyint(m->medium.density * box_volume(&m->box)), members = particles + count_vertices(m);
  const struct refusal rows[] = {
      {m->dimensions == 3, "dimensions", "pairs are in space; allowed with this medium: 3"},
      {box_shortest_edge(&m->box) >= 3, "box",
       "pairs up to 1 a0 apart, and an edge of the box is less than 3 a0; allowed with this medium: 3 and more"},
      {m->medium.density > 0.0, "medium.kind", "pairs without a density; allowed with a density above 0"},
  };
  if (!refuse_first(rows, sizeof rows / sizeof *rows, error))
    return false;
  if (!(particles >= 1.0 && members <= MEDIUM_MOST_MEMBERS))
    return model_reject(error, "medium.density",
                        "%.15g in a box of %.0f a0^3 makes %.0f particles, with vertices %.0f; allowed: 1 particle, up "
                        "to %.0f in all",
                        m->medium.density, box_volume(&m->box), particles, members, MEDIUM_MOST_MEMBERS);
  m->solvent.particles = (uint32_t)particles;
  return check_forces(m, error);
}

#define MOST_COUPLED 1000u /* vertices of a fiber with a tensor: a matrix of 72 MB */

static uint32_t longest_fiber(const struct model *m)
{
  uint32_t most = 0;
  for (uint32_t k = 0; k < m->kinds; k++)
    most = m->kind[k].vertices > most ? m->kind[k].vertices : most;
  return most;
}

/* The shortest bond length of all kinds. */
static double shortest_bond(const struct model *m)
{
  double least = m->kinds > 0 ? m->kind[0].bond_length : 1.0;
  for (uint32_t k = 1; k < m->kinds; k++)
    least = fmin(least, m->kind[k].bond_length);
  return least;
}

static bool finish_overdamped(struct model *m, struct model_error *error)
{
  const struct medium_model *b = &m->medium;
  const bool coupled = b->tensor != TENSOR_NONE;
  const struct refusal rows[] = {
      {m->kinds > 0, "medium.kind", "overdamped motion is one of vertices, and there are no fibers; allowed: pairs"},
      {m->dimensions == 3, "dimensions", "tensors are those of space; allowed with overdamped motion: 3"},
      {!m->crossing.forbidden, "crossing.forbidden",
       "overdamped vertices have no velocities, so bonds cannot exchange momentum; allowed with this medium: false"},
      {b->density == 0.0, "medium.density", "overdamped motion has no particles; allowed with kind: pairs"},
      {b->weight == WEIGHT_HAT && b->draw == DRAW_REPLACE && !model_repels(m), "medium.kind",
       "overdamped motion knows no pairs and draws no velocities: no draw, weight or repulsion; allowed with them: "
       "pairs"},
      {coupled == (b->radius > 0.0), coupled ? "medium.tensor" : "medium.radius",
       "a tensor needs a radius above 0, and a radius a tensor; allowed: both or none"},
      {!b->inextensible || shortest_bond(m) > 0.0, "medium.inextensible",
       "a kind of fibers has the bond_length 0, which no tension can hold; allowed with inextensible: above 0"},
      {!coupled || longest_fiber(m) <= MOST_COUPLED, "medium.tensor",
       "a fiber has more than 1000 vertices, and its matrix more than 72 MB; allowed with a tensor: up to 1000"},
  };
  return refuse_first(rows, sizeof rows / sizeof *rows, error);
}

bool medium_finish(struct model *m, struct model_error *error)
{
  static bool (*const finish[MEDIA])(struct model *, struct model_error *) = {
      [MEDIUM_PRIVATE] = finish_private, [MEDIUM_PAIRS] = finish_pairs, [MEDIUM_OVERDAMPED] = finish_overdamped};
  if (model_in_cells(m))
    return true;
  m->solvent.interval_steps = 1;
  return check_company(m, error) && check_rate(m, error) && finish[m->medium.kind](m, error);
}

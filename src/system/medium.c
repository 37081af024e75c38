#include "system/medium.h"

#include <math.h>

#include "system/refusals.h"

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

/* The particles of the second group, of those that there are. */
static bool derive_second(struct model *m, struct model_error *error)
{
  const double share = m->medium.second.share, others = nearbyint(share * m->solvent.particles);
  m->medium.second.first = m->solvent.particles - (uint32_t)others;
  return share == 0.0 || others >= 1.0 ||
         model_reject(error, "medium.second.share",
                      "%.15g of %u particles is a group that no one has; allowed: 1 "
                      "particle and more",
                      share, m->solvent.particles);
}

static double count_vertices(const struct model *m)
{
  double vertices = 0.0;
  for (uint32_t k = 0; k < m->kinds; k++)
    vertices += (double)m->kind[k].count * m->kind[k].vertices;
  return vertices;
}

static bool derive_pairs(struct model *m, struct model_error *error)
{
  const double particles = nearbyint(m->medium.density * box_volume(&m->box)), members = particles + count_vertices(m);
  if (!(particles >= 1.0 && members <= MEDIUM_MOST_MEMBERS))
    return model_reject(error, "medium.density",
                        "%.15g in a box of %.0f a0^3 makes %.0f particles, with vertices %.0f; allowed: 1 particle, up "
                        "to %.0f in all",
                        m->medium.density, box_volume(&m->box), particles, members, MEDIUM_MOST_MEMBERS);
  m->solvent.particles = (uint32_t)particles;
  return refusals_check(AT_PAIR_FORCES, m, NULL, error) && derive_second(m, error);
}

bool medium_finish(struct model *m, struct model_error *error)
{
  if (model_in_cells(m))
    return true;
  m->solvent.interval_steps = 1;
  return refusals_check(AT_MEDIUM, m, NULL, error) && check_rate(m, error) &&
         refusals_check(AT_MEDIUM_KIND, m, NULL, error) && (m->medium.kind != MEDIUM_PAIRS || derive_pairs(m, error));
}

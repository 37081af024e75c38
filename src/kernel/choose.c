#include "kernel/choose.h"

#include "kernel/collide.h"
#include "mpc/rules/spin.h"

/* Boundaries that leave particles alone that are clear of both ends of the box (enum course in solvent.c). */
static const bool free_inside[BOUNDARIES] = {
    [BOUNDARY_PERIODIC] = true, [BOUNDARY_WALL] = true, [BOUNDARY_SHEAR] = true};

/* Collision rules with formulas for several particles at once. */
static const bool has_lanes[RULES] = {[RULE_SRD] = true, [RULE_AT_A] = true, [RULE_AT_PLUS_A] = true};

struct kernel_parts kernel_parts_for(const struct model *m)
{
  const bool spins = m->solvent.rule == RULE_AT_PLUS_A;
  const bool thin = m->solvent.particles < (uint64_t)box_cell_count(&m->box); /* most are alone, and are not turned */
  const bool enough = box_cell_count(&m->box) >= 8;                           /* cells for a register */
  const bool crowd = m->solvent.per_cell > SPIN_HALVES_MOST / 8.0; /* else no cell has as many as halves cannot take */
  const bool particles = model_has_solvent(m) && has_lanes[m->solvent.rule] && !(spins && (crowd || !enough));
  return (struct kernel_parts){.gather = particles && free_inside[m->box.boundary[1]],
                               .solve = particles && enough && (!model_is_flat(m) || m->solvent.rule != RULE_SRD),
                               .turn = particles && !thin};
}

struct kernel kernel_mix(const struct kernel *fast, const struct model *model)
{
  const struct kernel_parts parts = kernel_parts_for(model);
  const struct kernel_ways *plain = &kernel_short.ways;
  if (fast == &kernel_plain)
    return kernel_plain;
  return (struct kernel){
      .name = fast->name,
      .collide = fast->collide,
      .ways = {.gather = parts.gather ? fast->ways.gather : plain->gather,
               .solve = parts.solve ? fast->ways.solve : plain->solve,
               .energies = parts.turn ? fast->ways.energies : plain->energies,
               .canonical = parts.solve ? fast->ways.canonical : plain->canonical,
               .turn = parts.turn ? fast->ways.turn : plain->turn,
               .halves = model->solvent.rule == RULE_AT_PLUS_A && parts.gather && fast->ways.halves}};
}

struct kernel kernel_choose(const struct model *model)
{
  const struct kernel *best = &kernel_plain;
  for (size_t k = 0; k < kernel_row_count; k++)
    if (kernel_rows[k].runs())
      best = kernel_rows[k].kernel;
  return kernel_mix(best, model);
}

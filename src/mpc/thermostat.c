#include "mpc/thermostat.h"

#include "base/normal.h"
#include "mpc/border.h"
#include "mpc/cell.h"
#include "mpc/rule.h"

double thermostat_gamma(uint64_t seed, uint64_t step, uint32_t cell, double shape)
{
  const double d = shape - 1.0 / 3.0, c = 1.0 / sqrt(9.0 * d);
  for (uint32_t draw = 0;; draw += 2) {
    double normal[2];
    random_normal_pair(random_at(seed, RANDOM_THERMOSTAT, draw, step, cell), normal);
    double u = random_uniform(random_at(seed, RANDOM_THERMOSTAT, draw + 1, step, cell), 0);
    double root = 1.0 + c * normal[0], v = root * root * root;
    if (v > 0.0 && elementary_log(u) < 0.5 * normal[0] * normal[0] + d - d * v + d * elementary_log(v))
      return d * v;
  }
}

double cell_freedoms(const struct mpc *c, const struct model *model, uint32_t place)
{
  const struct cell_sum *sum = &c->sum[place];
  const double n = c->filled ? border_virtual(c, model, place).n : 0.0;
  const uint32_t members = cell_members(sum);
  if (n == 0.0)
    return model->dimensions * (members - 1.0);
  return model->dimensions *
         (members - 1.0 - (cell_mass(sum) - n) / cell_mass(sum)); /* the virtual ones are one member */
}

/* One factor for all cells: a cell of N members has d (N-1) degrees of freedom with kT/2 each
 * (Padding 2009, step 4: "rescale velocities relative to center-of-mass velocity"). */
static void rescale(struct mpc *c, const struct model *model, uint64_t step)
{
  (void)step;
  double freedoms = 0.0, energy = 0.0;
  for (uint32_t k = 0; k < c->cells; k++) {
    if (c->turn[k].active == 0.0)
      continue;
    freedoms += cell_freedoms(c, model, k);
    energy += (double)c->relative[k] * CELL_ENERGY_UNIT;
  }
  double factor = energy > 0.0 ? sqrt(freedoms / energy) : 1.0;
  for (uint32_t k = 0; k < c->cells; k++)
    c->turn[k].factor = factor;
}

/* Twice the relative kinetic energy of a cell with its virtual particles, as the one member that they are. */
static double whole_energy(const struct mpc *c, const struct model *model, uint32_t place)
{
  const double energy = (double)c->relative[place] * CELL_ENERGY_UNIT;
  const struct virtual_members v = c->filled ? border_virtual(c, model, place) : (struct virtual_members){0};
  return v.n == 0.0 ? energy : energy + cell_energy(&c->turn[place], v.n, rule_virtual_velocity(model, &v));
}

/* Canonical: each cell's relative kinetic energy is drawn afresh from its Gamma distribution of d (N-1) degrees of
 * freedom, N with virtual particles as one (Huang, Chatterji, Sutmann, Gompper and Winkler, J. Comput. Phys. 229, 168
 * (2010)). */
static void maxwell_boltzmann(struct mpc *c, const struct model *model, uint64_t step)
{
  for (uint32_t k = 0; k < c->cells; k++) {
    if (c->turn[k].active == 0.0)
      continue;
    double energy = 0.5 * whole_energy(c, model, k);
    double wanted = thermostat_gamma(model->seed, step, k, 0.5 * model->dimensions * (cell_members(&c->sum[k]) - 1));
    c->turn[k].factor = energy > 0.0 ? sqrt(wanted / energy) : 1.0;
  }
}

/* A factor for each row of cells of the shifted grid along y: Tao, Goetze and Gompper, J. Chem. Phys. 128, 144902
 * (2008). Cell (z Ry + y) Lx + x is in row y. */
static void rescale_layers(struct mpc *c, const struct model *model, uint64_t step)
{
  (void)step;
  const uint32_t lx = (uint32_t)model->box.rows[0], ly = (uint32_t)model->box.rows[1];
  for (uint32_t row = 0; row < ly; row++) {
    double freedoms = 0.0, energy = 0.0;
    for (uint32_t first = row * lx; first < c->cells; first += ly * lx)
      for (uint32_t k = first; k < first + lx; k++) {
        if (c->turn[k].active == 0.0)
          continue;
        freedoms += cell_freedoms(c, model, k);
        energy += (double)c->relative[k] * CELL_ENERGY_UNIT;
      }
    const double factor = energy > 0.0 ? sqrt(freedoms / energy) : 1.0;
    for (uint32_t first = row * lx; first < c->cells; first += ly * lx)
      for (uint32_t k = first; k < first + lx; k++)
        c->turn[k].factor = factor;
  }
}

static const struct thermostat thermostats[THERMOSTATS] = {
    [THERMOSTAT_RESCALE] = {.name = "rescale", .factors = rescale},
    [THERMOSTAT_MAXWELL_BOLTZMANN] = {.name = "maxwell-boltzmann", .factors = maxwell_boltzmann},
    [THERMOSTAT_RESCALE_LAYERS] = {.name = "rescale-layers", .layered = true, .factors = rescale_layers},
};

const struct thermostat *thermostat_of(enum thermostat_kind kind)
{
  return kind == THERMOSTAT_NONE ? NULL : &thermostats[kind];
}

#include "mpc/thermostat.h"

#include "base/normal.h"
#include "mpc/border.h"
#include "mpc/cell.h"
#include "mpc/rule.h"

/* One attempt of Marsaglia and Tsang's, from a normal and a uniform deviate; negative if it is rejected. */
static inline double attempt(double shape, double normal, double u)
{
  const double d = shape - 1.0 / 3.0, c = 1.0 / sqrt(9.0 * d);
  const double root = 1.0 + c * normal, v = root * root * root;
  const bool below = elementary_log(u) < 0.5 * normal * normal + d - d * v + d * elementary_log(v);
  const bool taken = (v > 0.0) & below;
  return taken ? d * v : -1.0;
}

/* From this attempt on; each takes two draws. */
static double gamma_from(uint64_t seed, uint64_t step, uint32_t cell, double shape, uint32_t draw)
{
  for (;; draw += 2) {
    double normal[2];
    random_normal_pair(random_at(seed, RANDOM_THERMOSTAT, draw, step, cell), normal);
    const double u = random_uniform(random_at(seed, RANDOM_THERMOSTAT, draw + 1, step, cell), 0);
    const double gamma = attempt(shape, normal[0], u);
    if (gamma >= 0.0)
      return gamma;
  }
}

double thermostat_gamma(uint64_t seed, uint64_t step, uint32_t cell, double shape)
{
  return gamma_from(seed, step, cell, shape, 0);
}

static void attempts(const double *restrict shape, const double *restrict normal, const double *restrict u, uint32_t n,
                     double *restrict gamma)
{
  for (uint32_t k = 0; k < n; k++)
    gamma[k] = attempt(shape[k], normal[k], u[k]);
}

void thermostat_gammas(uint64_t seed, uint64_t step, const uint32_t *cell, const double *shape, uint32_t n,
                       double *gamma)
{
  double u[4][RANDOM_UNIFORMS], normal[RANDOM_UNIFORMS];
  random_uniform_columns(seed, RANDOM_THERMOSTAT, step, cell, n, u);
  random_normal_firsts(u[0], u[1], n, normal);
  attempts(shape, normal, u[2], n, gamma);
  for (uint32_t k = 0; k < n; k++)
    if (gamma[k] < 0.0)
      gamma[k] = gamma_from(seed, step, cell[k], shape[k], 2);
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

/* Of cells that share a factor. */
struct heat {
  double freedoms;
  energy_sum energy; /* twice the relative kinetic energy of their members; exact, so in any order */
};

/* Adds that of cells first .. first + n - 1. Whole numbers of degrees of freedom are counted as integers. */
static void heat_add(struct heat *heat, const struct mpc *c, const struct model *model, uint32_t first, uint32_t n)
{
  const uint32_t end = first + n;
  struct solved all = {0};
  for (uint32_t k = first; k < end; k++) {
    cell_count(&c->sum[k], &all);
    heat->energy += (uint64_t)c->relative[k];
  }
  if (!c->filled)
    heat->freedoms += model->dimensions * (double)all.others;
  for (uint32_t k = first; c->filled && k < end; k++)
    heat->freedoms += c->turn[k].active != 0.0 ? cell_freedoms(c, model, k) : 0.0;
}

static double heat_factor(const struct heat *heat)
{
  return heat->energy > 0 ? sqrt(heat->freedoms / ((double)heat->energy * CELL_ENERGY_UNIT)) : 1.0;
}

static void set_factors(struct mpc *c, uint32_t first, uint32_t n, double factor)
{
  for (uint32_t k = first; k < first + n; k++)
    c->turn[k].factor = factor;
}

void thermostat_set_factor(struct mpc *c, double freedoms, energy_sum energy)
{
  set_factors(c, 0, c->cells, heat_factor(&(struct heat){freedoms, energy}));
}

/* One factor for all cells: a cell of N members has d (N-1) degrees of freedom with kT/2 each
 * (Padding 2009, step 4: "rescale velocities relative to center-of-mass velocity"). */
static void rescale(struct mpc *c, const struct model *model, uint64_t step)
{
  (void)step;
  struct heat heat = {0};
  heat_add(&heat, c, model, 0, c->cells);
  thermostat_set_factor(c, heat.freedoms, heat.energy);
}

/* Twice the relative kinetic energy of a cell with its virtual particles, as the one member that they are. */
static double whole_energy(const struct mpc *c, const struct model *model, uint32_t place)
{
  const double energy = (double)c->relative[place] * CELL_ENERGY_UNIT;
  const struct virtual_members v = c->filled ? border_virtual(c, model, place) : (struct virtual_members){0};
  return v.n == 0.0 ? energy : energy + cell_energy(&c->turn[place], v.n, rule_virtual_velocity(model, &v));
}

/* The places among first .. end - 1 of cells that collide. Returns their number. */
static uint32_t list_active(const struct mpc *c, uint32_t first, uint32_t end, uint32_t *place)
{
  uint32_t n = 0;
  for (uint32_t k = first; k < end; k++) {
    place[n] = k;
    n += cell_members(&c->sum[k]) >= 2;
  }
  return n;
}

void thermostat_canonical(const struct model *model, struct mpc *c, uint64_t step, uint32_t begin)
{
  uint32_t place[RANDOM_UNIFORMS] = {0};
  double shape[RANDOM_UNIFORMS], wanted[RANDOM_UNIFORMS], energy[RANDOM_UNIFORMS], factor[RANDOM_UNIFORMS];
  for (uint32_t first = begin; first < c->cells; first += RANDOM_UNIFORMS) {
    const uint32_t left = c->cells - first, end = first + (left < RANDOM_UNIFORMS ? left : RANDOM_UNIFORMS);
    const uint32_t n = list_active(c, first, end, place);
    for (uint32_t k = 0; k < n; k++)
      shape[k] = 0.5 * model->dimensions * (cell_members(&c->sum[place[k]]) - 1);
    thermostat_gammas(model->seed, step, place, shape, n, wanted);
    for (uint32_t k = 0; k < n; k++)
      energy[k] = 0.5 * whole_energy(c, model, place[k]);
    for (uint32_t k = 0; k < n; k++) /* in columns, so that it vectorises */
      factor[k] = energy[k] > 0.0 ? sqrt(wanted[k] / energy[k]) : 1.0;
    for (uint32_t k = 0; k < n; k++)
      c->turn[place[k]].factor = factor[k];
  }
}

static void maxwell_boltzmann(struct mpc *c, const struct model *model, uint64_t step)
{
  thermostat_canonical(model, c, step, 0);
}

/* A factor for each row of cells of the shifted grid along y: Tao, Goetze and Gompper, J. Chem. Phys. 128, 144902
 * (2008). Cell (z Ry + y) Lx + x is in row y. */
static void rescale_layers(struct mpc *c, const struct model *model, uint64_t step)
{
  (void)step;
  const uint32_t lx = (uint32_t)model->box.rows[0], ly = (uint32_t)model->box.rows[1];
  for (uint32_t row = 0; row < ly; row++) {
    struct heat heat = {0};
    for (uint32_t first = row * lx; first < c->cells; first += ly * lx)
      heat_add(&heat, c, model, first, lx);
    for (uint32_t first = row * lx; first < c->cells; first += ly * lx)
      set_factors(c, first, lx, heat_factor(&heat));
  }
}

static const struct thermostat thermostats[THERMOSTATS] = {
    [THERMOSTAT_RESCALE] = {.name = "rescale", .common = true, .factors = rescale},
    [THERMOSTAT_MAXWELL_BOLTZMANN] = {.name = "maxwell-boltzmann", .factors = maxwell_boltzmann},
    [THERMOSTAT_RESCALE_LAYERS] = {.name = "rescale-layers", .layered = true, .factors = rescale_layers},
};

const struct thermostat *thermostat_of(enum thermostat_kind kind)
{
  return kind == THERMOSTAT_NONE ? NULL : &thermostats[kind];
}

#include "mpc/random_solvent.h"

#include <string.h>

#include "base/normal.h"
#include "mpc/cell.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/rule.h"

/* A Poisson number by inversion, from one uniform deviate. Stops at the latest where a further term is lost in the
 * rounding of the sum. */
static uint32_t poisson(double mean, double uniform)
{
  double term = elementary_exp(-mean), sum = term;
  uint32_t n = 0;
  while (uniform >= sum && (n < mean || sum + term > sum)) {
    term *= mean / ++n;
    sum += term;
  }
  return n;
}

/* e^-mean must not underflow, so a large mean is drawn in equal parts: a sum of Poisson numbers is one. */
#define LARGEST_PART 256.0

static uint32_t phantom_number(const struct model *model, uint64_t step, uint32_t cell)
{
  const double parts = ceil(model->solvent.per_cell / LARGEST_PART), mean = model->solvent.per_cell / parts;
  uint32_t n = 0;
  for (uint32_t part = 0; part < parts; part++)
    n += poisson(mean,
                 random_uniform(random_at(model->seed, RANDOM_PHANTOM_NUMBER, part / 2, step, cell), (int)(part % 2)));
  return n;
}

struct phantoms random_solvent_phantoms(const struct model *model, uint64_t step, uint32_t cell)
{
  const double n = phantom_number(model, step, cell);
  double xy[2], z[2];
  if (n == 0.0)
    return (struct phantoms){0.0, model->flow};
  random_normal_pair(random_at(model->seed, RANDOM_PHANTOM_VELOCITY, 0, step, cell), xy);
  random_normal_pair(random_at(model->seed, RANDOM_PHANTOM_VELOCITY, 1, step, cell), z);
  return (struct phantoms){n, vec3_add_scaled(model->flow, 1.0 / sqrt(n), (struct vec3){xy[0], xy[1], z[0]})};
}

/* The place of this cell in the list of occupied ones; it is appended if it is not there yet. The hash is Fibonacci's
 * (Knuth, TAOCP 3, Sec. 6.4), collisions go to the next slot. */
static uint32_t place_of_cell(struct mpc *c, uint32_t cell)
{
  const uint32_t mask = (uint32_t)(((uint64_t)1 << c->table_bits) - 1);
  uint32_t slot = (uint32_t)((uint64_t)(cell * 2654435769u) >> (32 - c->table_bits));
  while (c->table[slot] != 0 && c->occupied[c->table[slot] - 1] != cell)
    slot = (slot + 1) & mask;
  if (c->table[slot] == 0) {
    c->occupied[c->cells] = cell;
    c->table[slot] = ++c->cells;
  }
  return c->table[slot] - 1;
}

void random_solvent_bin(const struct state *state, const struct model *model, struct point shift, struct mpc *c)
{
  memset(c->table, 0, ((size_t)1 << c->table_bits) * sizeof *c->table);
  c->cells = 0;
  for (uint32_t v = 0; v < state->vertices; v++)
    c->vertex_cell[v] = place_of_cell(c, grid_cell_of(&model->box, state->position[v], shift));
}

/* The first vertex whose cell has this place. */
static int64_t vertex_in(const struct mpc *c, uint32_t place)
{
  int64_t v = 0;
  while (c->vertex_cell[v] != place)
    v++;
  return v;
}

/* True if momentum and mass stay in range with these phantoms added. Those of the vertices alone are in range
 * (collide_sum). */
static bool within_range(const struct mpc *c, uint32_t place, const struct phantoms *p, uint64_t step,
                         struct fault *fault)
{
  const double most = 0x1p62 * CELL_MOMENTUM_UNIT, heaviest = 0x1p40 * CELL_MASS_UNIT;
  const struct cell_sum *sum = &c->sum[place];
  const double momentum[3] = {(double)sum->px, (double)sum->py, (double)sum->pz};
  for (int k = 0; k < 3; k++)
    if (!(fabs(momentum[k]) * CELL_MOMENTUM_UNIT < most))
      return fault_record(fault, FAULT_VERTEX_SPEED, step, vertex_in(c, place), fabs(momentum[k]) * CELL_MOMENTUM_UNIT,
                          most);
  return cell_mass(sum) + p->mass < heaviest ||
         fault_record(fault, FAULT_CELL_MASS, step, c->occupied[place], cell_mass(sum) + p->mass, heaviest);
}

/* Adds the phantoms of each cell to its vertices, as one member. Half of a sum's range is reserved for them. They use
 * less than half of that: there are at most 1000 per cell on average, in a flow of at most 100 a0/t0
 * (system/model_finish.c). */
static bool add_phantoms(const struct model *model, struct mpc *c, uint64_t step, struct fault *fault)
{
  for (uint32_t k = 0; k < c->cells; k++) {
    const struct phantoms p = random_solvent_phantoms(model, step, c->occupied[k]);
    if (!within_range(c, k, &p, step, fault))
      return false;
    if (p.mass > 0.0)
      c->rule->add_virtual(model, c, step, k, &(struct virtual_members){p.mass, p.velocity, model->flow, 0.0, 1.0});
  }
  return true;
}

bool random_solvent_collide(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                            struct fault *fault)
{
  mpc->shift = grid_shift(model, step);
  random_solvent_bin(state, model, mpc->shift, mpc);
  if (!collide_sum(state, model, mpc, step, fault) || !add_phantoms(model, mpc, step, fault))
    return false;
  collide_solve(model, mpc, step);
  collide_turn(state, model, mpc, false);
  return true;
}

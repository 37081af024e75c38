#include "solvent/bath.h"

#include <string.h>

#include "solvent/collide.h"
#include "solvent/solvent.h"
#include "solvent/srd.h"

/* A Poisson number by inversion, from one uniform deviate. Stops at the latest where a further term is lost in the
 * rounding of the sum. */
static uint32_t poisson(double mean, double uniform)
{
  double term = exp(-mean), sum = term;
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

struct phantoms bath_phantoms(const struct model *model, uint64_t step, uint32_t cell)
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
static uint32_t place_of_cell(struct collision_work *c, uint32_t cell)
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

void bath_bin(const struct state *state, const struct model *model, struct work *work, struct point shift)
{
  struct collision_work *c = &work->collision;
  memset(c->table, 0, ((size_t)1 << c->table_bits) * sizeof *c->table);
  c->cells = 0;
  for (uint32_t v = 0; v < state->vertices; v++)
    c->vertex_cell[v] = place_of_cell(c, solvent_cell_of(&model->box, state->position[v], shift));
}

/* Some vertex of the cell in this place. */
static int64_t vertex_in(const struct collision_work *c, uint32_t place)
{
  int64_t v = 0;
  while (c->vertex_cell[v] != place)
    v++;
  return v;
}

/* Are momentum and mass still in range with these phantoms added? The vertices' own are (collide_sum). */
static bool within_range(struct work *work, uint32_t place, const struct phantoms *p, uint64_t step)
{
  const double most = 0x1p62 * SRD_MOMENTUM_UNIT, heaviest = 0x1p40 * SRD_MASS_UNIT;
  const struct cell_sum *sum = &work->collision.sum[place];
  const double momentum[3] = {(double)sum->px, (double)sum->py, (double)sum->pz};
  for (int k = 0; k < 3; k++)
    if (!(fabs(momentum[k]) * SRD_MOMENTUM_UNIT < most))
      return work_fault(work, FAULT_VERTEX_SPEED, step, vertex_in(&work->collision, place),
                        fabs(momentum[k]) * SRD_MOMENTUM_UNIT, most);
  return srd_mass(sum) + p->mass < heaviest ||
         work_fault(work, FAULT_CELL_MASS, step, work->collision.occupied[place], srd_mass(sum) + p->mass, heaviest);
}

/* The phantoms join the vertices of each cell, as one member. Half of a sum's range is for them: with at most 1000 per
 * cell on average (io/scene.c) in a flow of at most 100 a0/t0 they use less than half of that. */
static bool add_phantoms(const struct model *model, struct work *work, uint64_t step)
{
  struct collision_work *c = &work->collision;
  for (uint32_t k = 0; k < c->cells; k++) {
    const struct phantoms p = bath_phantoms(model, step, c->occupied[k]);
    if (!within_range(work, k, &p, step))
      return false;
    if (p.mass > 0.0)
      srd_add(&c->sum[k], p.mass, srd_load(p.mass), p.velocity);
  }
  return true;
}

bool bath_collide(struct state *state, const struct model *model, struct work *work, uint64_t step)
{
  bath_bin(state, model, work, solvent_grid_shift(model, step));
  if (!collide_sum(state, model, work, step) || !add_phantoms(model, work, step))
    return false;
  collide_solve(model, work, step);
  collide_turn(state, model, work);
  return true;
}

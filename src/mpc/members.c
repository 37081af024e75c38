#include "mpc/members.h"

#include <string.h>

#include "mpc/cell.h"

/* The bitwise or of what cell_add returns for each of these velocities; all ones if one is beyond the range of
 * lattice_round, or not a number. */
static uint64_t momentum_span(const double *v, uint32_t n)
{
  uint64_t span = 0;
  for (uint32_t k = 0; k < n; k++) {
    const double x = CELL_MOMENTUM_SCALE * v[k];
    const int64_t p = lattice_round(x);
    const uint64_t beyond = fabs(x) < 0x1p50 ? 0 : UINT64_MAX;
    span |= (uint64_t)(p ^ (p >> 63)) | beyond;
  }
  return span;
}

/* A cell_sum in one register, and four doubles. It is written out because compilers do not find it (four separate sums
 * take 1.7 ns per particle, one takes 0.9). The result must be that of cell_add. */
typedef uint64_t sum_lanes __attribute__((vector_size(sizeof(struct cell_sum))));
typedef int64_t whole_lanes __attribute__((vector_size(sizeof(struct cell_sum))));
typedef double double_lanes __attribute__((vector_size(sizeof(struct cell_sum))));

/* cell_add for n members of mass 1 whose momenta are in the range of lattice_round. lattice_round adds a magic
 * number, and subtracts its bits afterwards. Here the bits are subtracted in the same operation that adds the load. */
static void add_slow_particles(uint32_t n, const double *restrict vx, const double *restrict vy,
                               const double *restrict vz, const uint32_t *restrict cell, struct cell_sum *restrict sum)
{
  const double_lanes magic = {LATTICE_ROUND_MAGIC, LATTICE_ROUND_MAGIC, LATTICE_ROUND_MAGIC, LATTICE_ROUND_MAGIC};
  const sum_lanes load = {0, 0, 0, cell_load(1.0)};
  const sum_lanes addend = load - (sum_lanes)magic;
  for (uint32_t k = 0; k < n; k++) {
    const double_lanes v = {vx[k], vy[k], vz[k], 0.0};
    sum_lanes s;
    memcpy(&s, &sum[cell[k]], sizeof s);
    s += (sum_lanes)(CELL_MOMENTUM_SCALE * v + magic) + addend;
    memcpy(&sum[cell[k]], &s, sizeof s);
  }
}

uint64_t members_add(struct mpc *c, uint32_t first, uint32_t n, const double *vx, const double *vy, const double *vz)
{
  const uint32_t *cell = &c->solvent_cell[first];
  for (uint32_t k = 0; c->prefetch && k < n; k++)
    __builtin_prefetch(&c->sum[cell[k]], 1);
  uint64_t span = momentum_span(vx, n) | momentum_span(vy, n) | momentum_span(vz, n);
  if (span != UINT64_MAX) {
    add_slow_particles(n, vx, vy, vz, cell, c->sum);
    return span;
  }
  span = 0;
  for (uint32_t k = 0; k < n; k++)
    span |= cell_add(&c->sum[cell[k]], 1.0, cell_load(1.0), (struct vec3){vx[k], vy[k], vz[k]});
  return span;
}

enum { VERTICES = 64 }; /* worked on at a time */

/* What n vertices add to the sums of their cells, as cell_add has it, if the size of each momentum is below 2^51. If it
 * is not, neither is what this returns: the bitwise or of sizes. Masses are multiples of CELL_MASS_UNIT. */
static uint64_t addends_of(const double *restrict mass, const struct vec3 *restrict v, uint32_t n,
                           sum_lanes *restrict addend)
{
  const double_lanes magic = {LATTICE_ROUND_MAGIC, LATTICE_ROUND_MAGIC, LATTICE_ROUND_MAGIC, LATTICE_ROUND_MAGIC};
  const double_lanes scale = {CELL_MOMENTUM_SCALE, CELL_MOMENTUM_SCALE, CELL_MOMENTUM_SCALE, CELL_MASS_SCALE};
  const sum_lanes member = {0, 0, 0, CELL_MEMBER};
  sum_lanes span = {0, 0, 0, 0};
  for (uint32_t k = 0; k < n; k++) {
    const double_lanes each = {v[k].x, v[k].y, v[k].z, 1.0};
    const sum_lanes p = (sum_lanes)(mass[k] * scale * each + magic) - (sum_lanes)magic;
    span |= p ^ (sum_lanes)((whole_lanes)p < 0);
    addend[k] = p + member;
  }
  return span[0] | span[1] | span[2];
}

/* Cells of vertices are anywhere in memory. The sum that one needs is asked for MEMBERS_AHEAD vertices before. `known`:
 * length of `cell`, n of which are added. */
static void add_to_cells(uint32_t n, uint32_t known, const uint32_t *restrict cell, const sum_lanes *restrict addend,
                         struct cell_sum *restrict sum)
{
  for (uint32_t k = 0; k < n; k++) {
    __builtin_prefetch(&sum[cell[k + MEMBERS_AHEAD < known ? k + MEMBERS_AHEAD : k]], 1);
    sum_lanes s;
    memcpy(&s, &sum[cell[k]], sizeof s);
    s += addend[k];
    memcpy(&sum[cell[k]], &s, sizeof s);
  }
}

static uint64_t add_fast_ones(uint32_t n, const uint32_t *cell, const double *mass, const struct vec3 *v,
                              struct cell_sum *sum)
{
  uint64_t span = 0;
  for (uint32_t k = 0; k < n; k++)
    span |= cell_add(&sum[cell[k]], mass[k], cell_load(mass[k]), v[k]);
  return span;
}

uint64_t members_add_vertices(const struct state *state, const struct model *model, struct mpc *c)
{
  const uint64_t most = (uint64_t)1 << 51;
  sum_lanes addend[VERTICES];
  uint64_t span = 0;
  for (uint32_t first = 0; first < state->vertices; first += VERTICES) {
    const uint32_t left = state->vertices - first, n = left < VERTICES ? left : VERTICES;
    const uint32_t *cell = &c->vertex_cell[first];
    const double *mass = &model->mass[first];
    const struct vec3 *v = &state->velocity[first];
    uint64_t size = addends_of(mass, v, n, addend);
    if (size < most)
      add_to_cells(n, left, cell, addend, c->sum);
    else
      size = add_fast_ones(n, cell, mass, v, c->sum);
    span |= size;
  }
  return span;
}

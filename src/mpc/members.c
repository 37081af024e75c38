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

#include "solvent/collide.h"

#include <string.h>

#include "solvent/range.h"
#include "solvent/solvent.h"
#include "solvent/srd.h"
#include "solvent/thermostat.h"

/* Particles are sorted by cell again after this many collisions: at the paper's mean free path of 0.02 a0 most
 * neighbors in memory are then still neighbors in space. */
#define COLLISIONS_PER_SORT 50

/* The union of the spans of these velocities in momentum units, as srd_add has it; or all ones if one is beyond what
 * lattice_round can hold, or not a number. */
static uint64_t momentum_span(const double *v, uint32_t n)
{
  uint64_t span = 0;
  for (uint32_t k = 0; k < n; k++) {
    const double x = SRD_MOMENTUM_SCALE * v[k];
    const int64_t p = lattice_round(x);
    const uint64_t beyond = fabs(x) < 0x1p50 ? 0 : UINT64_MAX;
    span |= (uint64_t)(p ^ (p >> 63)) | beyond;
  }
  return span;
}

/* A cell_sum in one register, and four doubles. Written out, since compilers do not find it (1.7 ns per particle as
 * four separate sums, 0.9 as one); srd_add is what it must agree with. */
typedef uint64_t sum_lanes __attribute__((vector_size(sizeof(struct cell_sum))));
typedef double double_lanes __attribute__((vector_size(sizeof(struct cell_sum))));

/* srd_add for n members of mass 1 whose momenta lattice_round can hold. Its magic number turns up here: what it leaves
 * in the bits is taken off together with the load that is put on. */
static void add_slow_particles(uint32_t n, const double *restrict vx, const double *restrict vy,
                               const double *restrict vz, const uint32_t *restrict cell, struct cell_sum *restrict sum)
{
  const double_lanes magic = {LATTICE_ROUND_MAGIC, LATTICE_ROUND_MAGIC, LATTICE_ROUND_MAGIC, LATTICE_ROUND_MAGIC};
  const sum_lanes load = {0, 0, 0, srd_load(1.0)};
  const sum_lanes addend = load - (sum_lanes)magic;
  for (uint32_t k = 0; k < n; k++) {
    const double_lanes v = {vx[k], vy[k], vz[k], 0.0};
    sum_lanes s;
    memcpy(&s, &sum[cell[k]], sizeof s);
    s += (sum_lanes)(SRD_MOMENTUM_SCALE * v + magic) + addend;
    memcpy(&sum[cell[k]], &s, sizeof s);
  }
}

/* With more cells than this their sums and turns outgrow the caches, and asking for them ahead pays: 17 % of the time
 * with 100^3 cells; with 32^3 it would cost 0.9 ns of 7. */
static bool out_of_cache(const struct collision_work *c)
{
  return c->cells > 1 << 16;
}

/* The sums of n particles from number `first` on. Returns the union of their momentum spans. */
static uint64_t sum_particles(const struct solvent *s, struct collision_work *c, uint32_t first, uint32_t n)
{
  const double *vx = &s->vx[first], *vy = &s->vy[first], *vz = &s->vz[first];
  const uint32_t *cell = &c->solvent_cell[first];
  for (uint32_t k = 0; k < n && out_of_cache(c); k++)
    __builtin_prefetch(&c->sum[cell[k]], 1);
  uint64_t span = momentum_span(vx, n) | momentum_span(vy, n) | momentum_span(vz, n);
  if (span != UINT64_MAX) {
    add_slow_particles(n, vx, vy, vz, cell, c->sum);
    return span;
  }
  span = 0;
  for (uint32_t k = 0; k < n; k++)
    span |= srd_add(&c->sum[cell[k]], 1.0, srd_load(1.0), (struct vec3){vx[k], vy[k], vz[k]});
  return span;
}

/* Particles are handled so many at a time, through several operations, while they are in the cache. Fewer would keep
 * the processor from reading ahead. */
#define BLOCK 16384

static uint32_t block_size(uint32_t n, uint32_t first, uint32_t most)
{
  return n - first < most ? n - first : most;
}

static void clear_sums(struct collision_work *c)
{
  memset(c->sum, 0, (size_t)c->cells * sizeof *c->sum);
}

static uint64_t sum_vertices(const struct state *state, const struct model *model, struct collision_work *c)
{
  uint64_t span = 0;
  for (uint32_t v = 0; v < state->vertices; v++)
    span |= srd_add(&c->sum[c->vertex_cell[v]], model->mass[v], srd_load(model->mass[v]), state->velocity[v]);
  return span;
}

/* Axes of some cells at once, from their places in sum and turn. */
static void draw_axes(const struct model *model, struct collision_work *c, uint64_t step, const uint32_t *place,
                      uint32_t n)
{
  struct vec3 axis[RANDOM_AXES];
  uint32_t cell[RANDOM_AXES] = {0};
  for (uint32_t k = 0; k < n; k++)
    cell[k] = collision_cell(c, place[k]);
  random_axes(model->seed, RANDOM_ROTATION_AXIS, step, cell, n, axis);
  for (uint32_t k = 0; k < n; k++)
    c->turn[place[k]].axis = axis[k];
}

void collide_solve(const struct model *model, struct work *work, uint64_t step)
{
  struct collision_work *c = &work->collision;
  const uint32_t cells = c->cells;
  uint32_t active[RANDOM_AXES] = {0}, n = 0;
  for (uint32_t k = 0; k < cells; k++) {
    srd_solve(&c->sum[k], &c->turn[k]);
    if (c->turn[k].active != 0.0)
      active[n++] = k;
    if (n == RANDOM_AXES) {
      draw_axes(model, c, step, active, n);
      n = 0;
    }
  }
  draw_axes(model, c, step, active, n);
}

/* Wraps where a sum of int64 may not; whether it has is seen afterwards. */
static void add_energy(int64_t *sum, double energy)
{
  *sum = (int64_t)((uint64_t)*sum + (uint64_t)llrint(SRD_ENERGY_SCALE * energy));
}

/* Energies of all members, summed cell by cell in integers as the momenta are. (Momenta are in range by now, so all
 * energies are numbers.) */
static bool sum_relative_energy(const struct state *state, const struct model *model, struct work *work, uint64_t step)
{
  struct collision_work *c = &work->collision;
  memset(c->relative, 0, (size_t)box_cell_count(&model->box) * sizeof *c->relative);
  double largest = 0.0;
  for (uint32_t i = 0; i < state->solvent.n; i++) {
    const double energy = srd_energy(&c->turn[c->solvent_cell[i]], 1.0, solvent_velocity(&state->solvent, i));
    largest = energy > largest ? energy : largest;
    add_energy(&c->relative[c->solvent_cell[i]], energy);
  }
  for (uint32_t v = 0; v < state->vertices; v++) {
    const double energy = srd_energy(&c->turn[c->vertex_cell[v]], model->mass[v], state->velocity[v]);
    largest = energy > largest ? energy : largest;
    add_energy(&c->relative[c->vertex_cell[v]], energy);
  }
  return range_of_energies(state, model, work, largest, step);
}

/* New velocities of some particles, a column for each component. They are not written where the old ones stand, but
 * aside: a loop that stores through pointers might change what it reads, so it would not vectorise. */
#define TURNED 256
struct turned {
  double x[TURNED], y[TURNED], z[TURNED];
};

static inline __attribute__((always_inline)) void turn_block(struct solvent *s, const struct collision_work *c,
                                                             const struct solvent_model *rule, uint32_t first,
                                                             uint32_t n, const bool quarter, const bool scaled)
{
  const uint32_t *cell = &c->solvent_cell[first];
  const double *vx = &s->vx[first], *vy = &s->vy[first], *vz = &s->vz[first];
  const double cosine = rule->cosine, sine = rule->sine;
  struct turned new;
  for (uint32_t k = 0; k < n; k++) {
    const struct cell_turn *t = &c->turn[cell[k]];
    const struct vec3 v = {vx[k], vy[k], vz[k]}, w = srd_apply(t, v, quarter, cosine, sine, scaled);
    const bool active = t->active != 0.0;
    new.x[k] = active ? w.x : v.x;
    new.y[k] = active ? w.y : v.y;
    new.z[k] = active ? w.z : v.z;
  }
  memcpy(&s->vx[first], new.x, n * sizeof *new.x);
  memcpy(&s->vy[first], new.y, n * sizeof *new.y);
  memcpy(&s->vz[first], new.z, n * sizeof *new.z);
}

/* The plain form of the same: for solvents so thin that most members are alone in their cells, and stay as they are. */
static inline __attribute__((always_inline)) void turn_sparse(struct solvent *s, const struct collision_work *c,
                                                              const struct solvent_model *rule, const bool quarter,
                                                              const bool scaled)
{
  for (uint32_t i = 0; i < s->n; i++) {
    const struct cell_turn *t = &c->turn[c->solvent_cell[i]];
    if (t->active == 0.0)
      continue;
    const struct vec3 v = srd_apply(t, solvent_velocity(s, i), quarter, rule->cosine, rule->sine, scaled);
    s->vx[i] = v.x;
    s->vy[i] = v.y;
    s->vz[i] = v.z;
  }
}

static void prefetch_turns(const struct solvent *s, const struct collision_work *c, uint32_t first)
{
  for (uint32_t i = first; i < s->n && i < first + TURNED && out_of_cache(c); i++)
    __builtin_prefetch(&c->turn[c->solvent_cell[i]]);
}

static inline __attribute__((always_inline)) void turn_dense(struct solvent *s, const struct collision_work *c,
                                                             const struct solvent_model *rule, const bool quarter,
                                                             const bool scaled)
{
  prefetch_turns(s, c, 0);
  for (uint32_t i = 0; i < s->n; i += TURNED) {
    prefetch_turns(s, c, i + TURNED);
    turn_block(s, c, rule, i, block_size(s->n, i, TURNED), quarter, scaled);
  }
}

/* Velocities of all members of all cells; inlined four times, with `quarter` and `scaled` constants in each. */
static inline __attribute__((always_inline)) void turn_members(struct state *state, const struct model *model,
                                                               const struct work *work, const bool quarter,
                                                               const bool scaled)
{
  const struct collision_work *c = &work->collision;
  const struct solvent_model *rule = &model->solvent;
  if (state->solvent.n < c->cells)
    turn_sparse(&state->solvent, c, rule, quarter, scaled);
  else
    turn_dense(&state->solvent, c, rule, quarter, scaled);
  for (uint32_t v = 0; v < state->vertices; v++) {
    const struct cell_turn *t = &c->turn[c->vertex_cell[v]];
    if (t->active != 0.0)
      state->velocity[v] = srd_apply(t, state->velocity[v], quarter, rule->cosine, rule->sine, scaled);
  }
}

static void turn_quarter(struct state *state, const struct model *model, const struct work *work)
{
  turn_members(state, model, work, true, false);
}

static void turn_quarter_scaled(struct state *state, const struct model *model, const struct work *work)
{
  turn_members(state, model, work, true, true);
}

static void turn_by_angle(struct state *state, const struct model *model, const struct work *work)
{
  turn_members(state, model, work, false, false);
}

static void turn_by_angle_scaled(struct state *state, const struct model *model, const struct work *work)
{
  turn_members(state, model, work, false, true);
}

bool collide_sum(const struct state *state, const struct model *model, struct work *work, uint64_t step)
{
  const struct solvent *s = &state->solvent;
  uint64_t span = 0;
  clear_sums(&work->collision);
  for (uint32_t i = 0; i < s->n; i += BLOCK)
    span |= sum_particles(s, &work->collision, i, block_size(s->n, i, BLOCK));
  span |= sum_vertices(state, model, &work->collision);
  return range_of_momenta(state, model, work, span, step);
}

/* solvent_stream, solvent_bin and collide_sum, block by block. */
static bool gather(struct state *state, const struct model *model, struct work *work, uint64_t step)
{
  const struct solvent *s = &state->solvent;
  const struct point shift = solvent_grid_shift(model, step);
  uint64_t span = 0;
  clear_sums(&work->collision);
  for (uint32_t i = 0; i < s->n; i += BLOCK) {
    const uint32_t n = block_size(s->n, i, BLOCK);
    if (state->solvent_lag > 0 && !solvent_stream_some(state, model, work, i, n))
      return false;
    solvent_bin_some(state, model, work, shift, i, n);
    span |= sum_particles(s, &work->collision, i, n);
  }
  state->solvent_lag = 0;
  solvent_bin_vertices(state, model, work, shift);
  span |= sum_vertices(state, model, &work->collision);
  return range_of_momenta(state, model, work, span, step);
}

bool collide_thermostat(const struct state *state, const struct model *model, struct work *work, uint64_t step)
{
  if (!sum_relative_energy(state, model, work, step))
    return false;
  thermostat_factors(work, model, step);
  return true;
}

void collide_turn(struct state *state, const struct model *model, const struct work *work)
{
  typedef void turn(struct state *, const struct model *, const struct work *);
  static turn *const turns[2][2] = {{turn_by_angle, turn_by_angle_scaled}, {turn_quarter, turn_quarter_scaled}};
  turns[model->solvent.cosine == 0.0][model->solvent.thermostat != THERMOSTAT_NONE](state, model, work);
}

bool solvent_collide(struct state *state, const struct model *model, struct work *work, uint64_t step)
{
  if (!gather(state, model, work, step))
    return false;
  collide_solve(model, work, step);
  if (model->solvent.thermostat != THERMOSTAT_NONE && !collide_thermostat(state, model, work, step))
    return false;
  collide_turn(state, model, work);
  if (!model->solvent.hydrodynamics)
    solvent_swap_velocities(state, model, work, step);
  if (work->collision.since_sort++ % COLLISIONS_PER_SORT == 0)
    solvent_sort(state, model, work);
  return true;
}

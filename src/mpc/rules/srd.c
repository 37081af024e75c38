/* SRD for many particles at once. The formulas are in srd.h and cell.h; this file makes them fast. */
#include "mpc/rules/srd.h"

#include <string.h>

#include "mpc/members.h"
#include "mpc/rule.h"

/* --- sums -------------------------------------------------------------------------------------------------------- */

static uint64_t add_particles(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                              uint32_t first, uint32_t n)
{
  (void)model, (void)step;
  const struct solvent *s = &state->solvent;
  return members_add(c, first, n, &s->vx[first], &s->vy[first], &s->vz[first]);
}

/* Cells of vertices are anywhere in memory. What the cell of this one needs is asked for so many vertices ahead. */
enum { AHEAD = 24 };

static uint32_t vertex_ahead(const struct state *state, uint32_t v)
{
  return v + AHEAD < state->vertices ? v + AHEAD : v;
}

static uint64_t add_vertices(const struct state *state, const struct model *model, struct mpc *c, uint64_t step)
{
  (void)step;
  uint64_t span = 0;
  for (uint32_t v = 0; v < state->vertices; v++) {
    __builtin_prefetch(&c->sum[c->vertex_cell[vertex_ahead(state, v)]], 1);
    span |= cell_add(&c->sum[c->vertex_cell[v]], model->mass[v], cell_load(model->mass[v]), state->velocity[v]);
  }
  return span;
}

static void add_virtual(const struct model *model, struct mpc *c, uint64_t step, uint32_t place,
                        const struct virtual_members *members)
{
  (void)step;
  cell_add(&c->sum[place], members->n, cell_load(members->n), rule_virtual_velocity(model, members));
}

static struct vec3 virtual_gain(const struct model *model, const struct mpc *c, uint64_t step, uint32_t place,
                                const struct virtual_members *members, bool scaled)
{
  (void)step;
  const struct cell_turn *t = &c->turn[place];
  const struct solvent_model *rule = &model->solvent;
  if (t->active == 0.0)
    return (struct vec3){0, 0, 0};
  const struct vec3 old = rule_virtual_velocity(model, members);
  const struct vec3 new = srd_apply(t, old, rule->cosine == 0.0, rule->cosine, rule->sine, scaled);
  return vec3_scale(members->n, vec3_sub(new, old));
}

/* --- axes -------------------------------------------------------------------------------------------------------- */

/* Draws the axes of n cells at once. place: of the cells in sum and turn. */
static void draw_axes(const struct model *model, struct mpc *c, uint64_t step, const uint32_t *place, uint32_t n)
{
  struct vec3 axis[RANDOM_AXES];
  uint32_t cell[RANDOM_AXES] = {0};
  for (uint32_t k = 0; k < n; k++)
    cell[k] = mpc_cell(c, place[k]);
  random_axes(model->seed, RANDOM_ROTATION_AXIS, step, cell, n, axis);
  for (uint32_t k = 0; k < n; k++)
    c->turn[place[k]].axis = axis[k];
}

/* In a plane: by +alpha or -alpha about z, word 0 of the cell's number says which. */
static void draw_signs(const struct model *model, struct mpc *c, uint64_t step, const uint32_t *place, uint32_t n)
{
  for (uint32_t k = 0; k < n; k++) {
    const struct random_words r = random_at(model->seed, RANDOM_PLANE_TURN, 0, step, mpc_cell(c, place[k]));
    c->turn[place[k]].axis = (struct vec3){0.0, 0.0, r.w[0] & 1 ? 1.0 : -1.0};
  }
}

static void solve(const struct model *model, struct mpc *c, uint64_t step)
{
  typedef void draw(const struct model *, struct mpc *, uint64_t, const uint32_t *, uint32_t);
  draw *const draw_some = model_is_flat(model) ? draw_signs : draw_axes;
  const uint32_t cells = c->cells;
  uint32_t active[RANDOM_AXES] = {0}, n = 0;
  for (uint32_t k = 0; k < cells; k++) {
    cell_solve(&c->sum[k], &c->turn[k]);
    if (c->turn[k].active != 0.0)
      active[n++] = k;
    if (n == RANDOM_AXES) {
      draw_some(model, c, step, active, n);
      n = 0;
    }
  }
  draw_some(model, c, step, active, n);
}

/* --- turns ------------------------------------------------------------------------------------------------------- */

/* New velocities of a block of particles, a column for each component. They are written here first, not over the old
 * ones: a loop that stores through pointers might change what it reads, and compilers would not vectorise it. */
#define TURNED 256
struct turned {
  double x[TURNED], y[TURNED], z[TURNED];
};

static inline __attribute__((always_inline)) void turn_block(struct solvent *s, const struct mpc *c,
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

/* The same, particle by particle: faster for a thin solvent, where most members are alone in their cells and keep their
 * velocities. */
static inline __attribute__((always_inline)) void turn_sparse(struct solvent *s, const struct mpc *c,
                                                              const struct solvent_model *rule, uint32_t first,
                                                              const bool quarter, const bool scaled)
{
  for (uint32_t i = first; i < s->n; i++) {
    const struct cell_turn *t = &c->turn[c->solvent_cell[i]];
    if (t->active == 0.0)
      continue;
    const struct vec3 v = srd_apply(t, solvent_velocity(s, i), quarter, rule->cosine, rule->sine, scaled);
    s->vx[i] = v.x;
    s->vy[i] = v.y;
    s->vz[i] = v.z;
  }
}

static uint32_t block_from(const struct solvent *s, uint32_t first)
{
  return first >= s->n ? 0 : s->n - first < TURNED ? s->n - first : TURNED;
}

static inline __attribute__((always_inline)) void turn_dense(struct solvent *s, const struct mpc *c,
                                                             const struct solvent_model *rule, uint32_t first,
                                                             const bool quarter, const bool scaled)
{
  members_prefetch_turns(c, first, block_from(s, first));
  for (uint32_t i = first; i < s->n; i += TURNED) {
    members_prefetch_turns(c, i + TURNED, block_from(s, i + TURNED));
    turn_block(s, c, rule, i, block_from(s, i), quarter, scaled);
  }
}

/* Velocities of members of all cells; inlined four times, with `quarter` and `scaled` constants in each. */
static inline __attribute__((always_inline)) void turn_members(struct state *state, const struct model *model,
                                                               const struct mpc *c, uint32_t first, const bool quarter,
                                                               const bool scaled)
{
  const struct solvent_model *rule = &model->solvent;
  if (state->solvent.n < c->cells)
    turn_sparse(&state->solvent, c, rule, first, quarter, scaled);
  else
    turn_dense(&state->solvent, c, rule, first, quarter, scaled);
  for (uint32_t v = 0; v < state->vertices; v++) {
    const struct cell_turn *t = &c->turn[c->vertex_cell[v]];
    __builtin_prefetch(&c->turn[c->vertex_cell[vertex_ahead(state, v)]]);
    if (t->active != 0.0)
      state->velocity[v] = srd_apply(t, state->velocity[v], quarter, rule->cosine, rule->sine, scaled);
  }
}

static void turn_quarter(struct state *state, const struct model *model, const struct mpc *c, uint32_t first)
{
  turn_members(state, model, c, first, true, false);
}

static void turn_quarter_scaled(struct state *state, const struct model *model, const struct mpc *c, uint32_t first)
{
  turn_members(state, model, c, first, true, true);
}

static void turn_by_angle(struct state *state, const struct model *model, const struct mpc *c, uint32_t first)
{
  turn_members(state, model, c, first, false, false);
}

static void turn_by_angle_scaled(struct state *state, const struct model *model, const struct mpc *c, uint32_t first)
{
  turn_members(state, model, c, first, false, true);
}

void srd_turn_from(struct state *state, const struct model *model, const struct mpc *c, uint32_t first, bool scaled)
{
  typedef void turn(struct state *, const struct model *, const struct mpc *, uint32_t);
  static turn *const turns[2][2] = {{turn_by_angle, turn_by_angle_scaled}, {turn_quarter, turn_quarter_scaled}};
  turns[model->solvent.cosine == 0.0][scaled](state, model, c, first);
}

static void apply(struct state *state, const struct model *model, const struct mpc *c, bool scaled)
{
  srd_turn_from(state, model, c, 0, scaled);
}

const struct collision_rule srd_rule = {.name = "srd",
                                        .add_particles = add_particles,
                                        .add_vertices = add_vertices,
                                        .add_virtual = add_virtual,
                                        .virtual_gain = virtual_gain,
                                        .solve = solve,
                                        .apply = apply};

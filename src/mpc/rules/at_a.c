/*
 * The Andersen collision rule without angular momentum, MPC-AT-a (Noguchi, Kikuchi and Gompper, EPL 78, 10005 (2007)):
 *
 *   v_i' = V + xi_i - sum_j m_j xi_j / sum_j m_j,    V = sum_j m_j v_j / sum_j m_j,
 *
 * xi_i normal deviates of variance kT/m_i. So v_i' = xi_i + sum_j m_j (v_j - xi_j) / sum_j m_j: the sum of v - xi is
 * all that a cell needs, and one fixed-point sum keeps momentum whatever the order of the members.
 */
#include "mpc/rule.h"
#include "mpc/rules/andersen.h"

static uint64_t add_particles(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                              uint32_t first, uint32_t n)
{
  uint64_t span = 0;
  for (uint32_t i = first; i < first + n; i += ANDERSEN_BLOCK) {
    const uint32_t m = first + n - i < ANDERSEN_BLOCK ? first + n - i : ANDERSEN_BLOCK;
    struct andersen_change u;
    andersen_draw_block(&state->solvent, model, c, step, i, m, &u);
    span |= members_add(c, i, m, u.x, u.y, u.z);
  }
  return span;
}

static uint64_t add_vertices(const struct state *state, const struct model *model, struct mpc *c, uint64_t step)
{
  uint64_t span = 0;
  for (uint32_t v = 0; v < state->vertices; v++) {
    const double mass = model->mass[v];
    c->drawn_vertex[v] = andersen_draw(model, RANDOM_ANDERSEN_VERTEX, step, v, mass);
    span |=
        cell_add(&c->sum[c->vertex_cell[v]], mass, cell_load(mass), vec3_sub(state->velocity[v], c->drawn_vertex[v]));
  }
  return span;
}

/* The mean of the velocities that n virtual particles draw has the variance of one member of mass n. */
static struct vec3 draw_virtual(const struct model *model, const struct mpc *c, uint64_t step, uint32_t place,
                                const struct virtual_members *members)
{
  return andersen_draw(model, RANDOM_ANDERSEN_PHANTOM, step, mpc_cell(c, place) + members->aside, members->n);
}

static void add_virtual(const struct model *model, struct mpc *c, uint64_t step, uint32_t place,
                        const struct virtual_members *members)
{
  const struct vec3 xi = draw_virtual(model, c, step, place, members);
  cell_add(&c->sum[place], members->n, cell_load(members->n), vec3_sub(rule_virtual_velocity(model, members), xi));
}

static struct vec3 virtual_gain(const struct model *model, const struct mpc *c, uint64_t step, uint32_t place,
                                const struct virtual_members *members, bool scaled)
{
  (void)scaled;
  const struct cell_turn *t = &c->turn[place];
  if (t->active == 0.0)
    return (struct vec3){0, 0, 0};
  const struct vec3 v = vec3_add(t->center, draw_virtual(model, c, step, place, members));
  return vec3_scale(members->n, vec3_sub(v, rule_virtual_velocity(model, members)));
}

/* The centre is the mean of v - xi. */
static void solve(const struct model *model, struct mpc *c, uint64_t step)
{
  (void)model, (void)step;
  for (uint32_t k = 0; k < c->cells; k++)
    cell_solve(&c->sum[k], &c->turn[k]);
}

/* New velocities are written to columns of their own first, not over the old ones: the loop may then vectorise. */
static void apply_block(struct solvent *s, const struct mpc *c, uint32_t first, uint32_t n)
{
  const uint32_t *cell = &c->solvent_cell[first];
  const double *vx = &s->vx[first], *vy = &s->vy[first], *vz = &s->vz[first];
  const double *dx = &c->drawn[0][first], *dy = &c->drawn[1][first], *dz = &c->drawn[2][first];
  struct andersen_change new;
  for (uint32_t k = 0; k < n; k++) {
    const struct cell_turn *t = &c->turn[cell[k]];
    const bool active = t->active != 0.0;
    new.x[k] = active ? t->center.x + dx[k] : vx[k];
    new.y[k] = active ? t->center.y + dy[k] : vy[k];
    new.z[k] = active ? t->center.z + dz[k] : vz[k];
  }
  memcpy(&s->vx[first], new.x, n * sizeof *new.x);
  memcpy(&s->vy[first], new.y, n * sizeof *new.y);
  memcpy(&s->vz[first], new.z, n * sizeof *new.z);
}

void andersen_turn_from(struct state *state, const struct mpc *c, uint32_t first)
{
  const uint32_t n = state->solvent.n;
  for (uint32_t i = first; i < n; i += ANDERSEN_BLOCK) {
    const uint32_t m = n - i < ANDERSEN_BLOCK ? n - i : ANDERSEN_BLOCK;
    members_prefetch_turns(c, i, m);
    apply_block(&state->solvent, c, i, m);
  }
  for (uint32_t v = 0; v < state->vertices; v++) {
    const struct cell_turn *t = &c->turn[c->vertex_cell[v]];
    if (t->active != 0.0)
      state->velocity[v] = vec3_add(t->center, c->drawn_vertex[v]);
  }
}

static void apply(struct state *state, const struct model *model, const struct mpc *c, bool scaled)
{
  (void)model, (void)scaled; /* it is a thermostat by itself */
  andersen_turn_from(state, c, 0);
}

const struct collision_rule at_a_rule = {.name = "at-a",
                                         .thermal = true,
                                         .add_particles = add_particles,
                                         .add_vertices = add_vertices,
                                         .add_virtual = add_virtual,
                                         .virtual_gain = virtual_gain,
                                         .solve = solve,
                                         .apply = apply};

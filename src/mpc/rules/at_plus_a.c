/*
 * The Andersen collision rule that keeps angular momentum, MPC-AT+a (Noguchi, Kikuchi and Gompper, EPL 78, 10005
 * (2007)): as MPC-AT-a (at_a.c), and then the cell is turned so that its angular momentum is what it was,
 *
 *   v_i' = V + xi_i - sum_j m_j xi_j / sum_j m_j + Omega x (y_i - X),
 *   Omega = Pi^-1 sum_j m_j (y_j - X) x (v_j - xi_j),    Pi = sum_j m_j [(y_j - X)^2 - (y_j - X)(y_j - X)],
 *
 * with X the centre of mass and y_i the places in the cell. Sums and Omega are in spin.h.
 */
#include "mpc/rule.h"
#include "mpc/rules/andersen.h"
#include "mpc/rules/spin.h"

/* Positions of particles from place `first` of memory on, as they are when the collision takes place: those of images
 * where a border has moved members there. Pointers, because an index that is a sum of 32 bits may wrap: compilers then
 * gather each number on its own. */
struct positions {
  const int64_t *x, *y, *z;
};

static struct positions positions_from(const struct solvent *s, uint32_t first)
{
  return (struct positions){&s->x[first], &s->y[first], &s->z[first]};
}

static struct point place_of(const struct mpc *c, const struct positions *p, uint32_t k)
{
  return spin_place((struct point){p->x[k], p->y[k], p->z[k]}, c->shift);
}

/* The sums of all cells are three cache lines each: of 32^3 cells they do not fit the second level of a cache. So the
 * lines of a member are asked for while those before it are summed. */
enum { AHEAD = 12 }; /* members */

static inline void prefetch_spin(const struct cell_spin *s)
{
  const char *line = (const char *)s;
  for (size_t k = 0; k < sizeof *s; k += 64)
    __builtin_prefetch(line + k, 1);
}

/* Places in their cells, and momenta, of a block of particles: lattice units, 2^-44 m a0/t0. */
struct spin_block {
  int64_t x[ANDERSEN_BLOCK], y[ANDERSEN_BLOCK], z[ANDERSEN_BLOCK];
  int64_t px[ANDERSEN_BLOCK], py[ANDERSEN_BLOCK], pz[ANDERSEN_BLOCK];
};

/* In columns, which vectorise; `slow`: all momenta are in the range of lattice_round. */
static void fill_block(const struct solvent *s, const struct mpc *c, uint32_t first, uint32_t n,
                       const struct andersen_change *u, bool slow, struct spin_block *b)
{
  const struct positions at = positions_from(s, first);
  for (uint32_t k = 0; k < n; k++) {
    const struct point y = place_of(c, &at, k);
    b->x[k] = y.x, b->y[k] = y.y, b->z[k] = y.z;
  }
  for (uint32_t k = 0; slow && k < n; k++) {
    b->px[k] = lattice_round(CELL_MOMENTUM_SCALE * u->x[k]);
    b->py[k] = lattice_round(CELL_MOMENTUM_SCALE * u->y[k]);
    b->pz[k] = lattice_round(CELL_MOMENTUM_SCALE * u->z[k]);
  }
  for (uint32_t k = 0; !slow && k < n; k++) {
    const struct point p = spin_momentum(1.0, (struct vec3){u->x[k], u->y[k], u->z[k]});
    b->px[k] = p.x, b->py[k] = p.y, b->pz[k] = p.z;
  }
}

static void add_spins(struct mpc *c, uint32_t first, uint32_t n, const struct andersen_change *u,
                      const struct spin_block *b)
{
  const uint32_t *cell = &c->solvent_cell[first];
  for (uint32_t k = 0; k < n; k++) {
    const struct point y = {b->x[k], b->y[k], b->z[k]}, p = {b->px[k], b->py[k], b->pz[k]};
    prefetch_spin(&c->spin[cell[k + AHEAD < n ? k + AHEAD : n - 1]]);
    if (c->spin_in_halves)
      spin_add_halves(&c->spin[cell[k]].halves, y, p, (struct vec3){u->x[k], u->y[k], u->z[k]});
    else
      spin_add_particle(&c->spin[cell[k]], y, p);
  }
}

static uint64_t add_particles(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                              uint32_t first, uint32_t n)
{
  uint64_t span = 0;
  for (uint32_t i = first; i < first + n; i += ANDERSEN_BLOCK) {
    const uint32_t m = first + n - i < ANDERSEN_BLOCK ? first + n - i : ANDERSEN_BLOCK;
    struct andersen_change u;
    struct spin_block b;
    andersen_draw_block(&state->solvent, model, c, step, i, m, &u);
    const uint64_t reach = members_add(c, i, m, u.x, u.y, u.z);
    fill_block(&state->solvent, c, i, m, &u, reach < (uint64_t)LATTICE_NEAR, &b);
    add_spins(c, i, m, &u, &b);
    span |= reach;
  }
  return span;
}

static uint64_t add_vertices(const struct state *state, const struct model *model, struct mpc *c, uint64_t step)
{
  uint64_t span = 0;
  for (uint32_t v = 0; v < state->vertices; v++) {
    const double mass = model->mass[v];
    c->drawn_vertex[v] = andersen_draw(model, RANDOM_ANDERSEN_VERTEX, step, v, mass);
    const struct vec3 u = vec3_sub(state->velocity[v], c->drawn_vertex[v]);
    span |= cell_add(&c->sum[c->vertex_cell[v]], mass, cell_load(mass), u);
    spin_add(&c->spin[c->vertex_cell[v]], spin_place(state->position[v], c->shift), mass, u);
  }
  return span;
}

/* One virtual particle: its place, and v - xi. Its velocity and the one drawn for it are independent, so v - xi has
 * twice the variance of each. */
struct virtual_one {
  struct point place;
  struct vec3 change;
};

/* A coordinate in the cell that is uniform from low to high, 0 to 1, relative to the middle of the cell. */
static int64_t place_between(double low, double high, double uniform)
{
  const int64_t y = (int64_t)((low + (high - low) * uniform) * LATTICE_PER_A0);
  return (y < LATTICE_CELL ? y : LATTICE_CELL - 1) - LATTICE_CELL / 2;
}

static struct virtual_one draw_virtual(const struct model *model, const struct mpc *c, uint64_t step, uint32_t place,
                                       uint32_t number, const struct virtual_members *members)
{
  const uint32_t cell = mpc_cell(c, place);
  const bool flat = model_is_flat(model);
  const struct random_words xz = random_at(model->seed, RANDOM_SPIN_PLACE, 2 * number, step, cell);
  const struct random_words y = random_at(model->seed, RANDOM_SPIN_PLACE, 2 * number + 1, step, cell);
  double a[3];
  random_normal_three(random_at(model->seed, RANDOM_SPIN_VELOCITY, number, step, cell), a);
  return (struct virtual_one){
      {place_between(0.0, 1.0, random_uniform(xz, 0)), place_between(members->low, members->high, random_uniform(y, 0)),
       flat ? spin_place((struct point){0, 0, 0}, c->shift).z : place_between(0.0, 1.0, random_uniform(xz, 1))},
      vec3_add_scaled(members->flow, sqrt(2.0), (struct vec3){a[0], a[1], flat ? 0.0 : a[2]})};
}

static void add_virtual(const struct model *model, struct mpc *c, uint64_t step, uint32_t place,
                        const struct virtual_members *members)
{
  for (uint32_t k = 0; k < members->n; k++) {
    const struct virtual_one one = draw_virtual(model, c, step, place, k, members);
    cell_add(&c->sum[place], 1.0, cell_load(1.0), one.change);
    spin_add_particle(&c->spin[place], one.place, spin_momentum(1.0, one.change));
  }
}

static struct vec3 virtual_gain(const struct model *model, const struct mpc *c, uint64_t step, uint32_t place,
                                const struct virtual_members *members, bool scaled)
{
  (void)scaled;
  const struct cell_turn *t = &c->turn[place];
  struct vec3 gain = {0, 0, 0};
  for (uint32_t k = 0; k < members->n && t->active != 0.0; k++) {
    const struct virtual_one one = draw_virtual(model, c, step, place, k, members);
    gain = vec3_add(gain, vec3_sub(spin_velocity(t, c->middle[place], one.place), one.change));
  }
  return gain;
}

static void solve(const struct model *model, struct mpc *c, uint64_t step)
{
  (void)model, (void)step;
  for (uint32_t k = 0; k < c->cells; k++) {
    spin_solve(&c->sum[k], &c->spin[k], &c->turn[k], &c->middle[k]);
    memset(&c->spin[k], 0, sizeof c->spin[k]); /* for the next collision, while it is in the cache */
  }
  c->spin_is_clear = !c->occupied; /* else the next collision has other cells */
}

/* New velocities of a block of particles, without a branch, and written to columns of their own first (at_a.c). */
static void apply_block(struct solvent *s, const struct mpc *c, uint32_t first, uint32_t n)
{
  const uint32_t *cell = &c->solvent_cell[first];
  const double *vx = &s->vx[first], *vy = &s->vy[first], *vz = &s->vz[first];
  const double *dx = &c->drawn[0][first], *dy = &c->drawn[1][first], *dz = &c->drawn[2][first];
  const struct positions at = positions_from(s, first);
  struct andersen_change new;
  for (uint32_t k = 0; k < n; k++) {
    const struct cell_turn *t = &c->turn[cell[k]];
    const bool active = t->active != 0.0;
    const struct vec3 v = spin_velocity(t, c->middle[cell[k]], place_of(c, &at, k));
    new.x[k] = active ? v.x + dx[k] : vx[k];
    new.y[k] = active ? v.y + dy[k] : vy[k];
    new.z[k] = active ? v.z + dz[k] : vz[k];
  }
  memcpy(&s->vx[first], new.x, n * sizeof *new.x);
  memcpy(&s->vy[first], new.y, n * sizeof *new.y);
  memcpy(&s->vz[first], new.z, n * sizeof *new.z);
}

void spin_turn_from(struct state *state, const struct mpc *c, uint32_t first)
{
  struct solvent *s = &state->solvent;
  for (uint32_t i = first; i < s->n; i += ANDERSEN_BLOCK)
    apply_block(s, c, i, s->n - i < ANDERSEN_BLOCK ? s->n - i : ANDERSEN_BLOCK);
  for (uint32_t v = 0; v < state->vertices; v++) {
    const uint32_t cell = c->vertex_cell[v];
    const struct cell_turn *t = &c->turn[cell];
    const struct point y = spin_place(state->position[v], c->shift);
    if (t->active != 0.0)
      state->velocity[v] = vec3_add(spin_velocity(t, c->middle[cell], y), c->drawn_vertex[v]);
  }
}

static void apply(struct state *state, const struct model *model, const struct mpc *c, bool scaled)
{
  (void)model, (void)scaled; /* it is a thermostat by itself */
  spin_turn_from(state, c, 0);
}

const struct collision_rule at_plus_a_rule = {.name = "at+a",
                                              .thermal = true,
                                              .spinning = true,
                                              .add_particles = add_particles,
                                              .add_vertices = add_vertices,
                                              .add_virtual = add_virtual,
                                              .virtual_gain = virtual_gain,
                                              .solve = solve,
                                              .apply = apply};

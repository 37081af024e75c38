/*
 * What the suites of this folder share. A suite holds every row of a table of functions to the table's contract; no
 * test names a row. So a new row is tested by being listed: its number stands in the table's enum, whose last name
 * counts the rows.
 *
 * A choice says which row of each table a model takes. Zero is the first row of each.
 */
#ifndef UNCROSS_TESTS_CONTRACT_H
#define UNCROSS_TESTS_CONTRACT_H

#include "contact/rule.h"
#include "exact.h"
#include "fluid/boundary.h"
#include "fluid/fluid.h"
#include "mpc/grid.h"
#include "mpc/plan.h"
#include "mpc/random_solvent.h"
#include "mpc/rule.h"
#include "mpc/thermostat.h"
#include "statistics.h"
#include "system/model_keys.h"

struct choice {
  enum rule rule;
  enum thermostat_kind thermostat;
  enum bath bath;
  enum scheme scheme;
  enum fluid_kind fluid;
  enum crossing_kind crossing;
  bool flat;     /* in two dimensions */
  bool permuted; /* velocities of the solvent, after each collision: no hydrodynamic interactions */

  enum medium_kind medium; /* instead of collisions in cells */
  enum medium_draw draw;
  enum medium_weight weight;
  bool repels; /* pairs of the medium: with two groups and many bodies */
};

/* --- models ------------------------------------------------------------------------------------------------------ */

/* Draws that a medium has: an overdamped one has no velocities to draw. */
static inline int contract_draws(int medium)
{
  return medium == MEDIUM_OVERDAMPED ? 1 : MEDIUM_DRAWS;
}

/* The one place that says how a model takes a row. Rows that no key chooses yet are compared in contract_taken. */
static inline void contract_choose(struct model *m, struct choice c)
{
  if (c.flat) { /* as many cells, one of them thick */
    m->box = box_of_cells(2 * m->box.cells[0], m->box.cells[1] * m->box.cells[2] / 2, 1);
    m->dimensions = 2;
  }
  m->scheme = c.scheme;
  m->solvent.rule = c.rule;
  m->solvent.thermostat = c.thermostat;
  m->solvent.bath = c.bath;
  if (c.fluid == FLUID_DUMBBELLS)
    m->dumbbells = (struct dumbbell_model){.spring = 3.0, .fraction = 0.75};
  m->solvent.hydrodynamics = !c.permuted && !model_has_phantoms(m);
  m->crossing.forbidden = crossing_rule_row(c.crossing)->forbids;
  m->crossing.rule = c.crossing;
  if (c.medium != MEDIUM_CELLS) {
    const double density = c.medium == MEDIUM_PAIRS ? m->solvent.per_cell : 0.0;
    m->medium = (struct medium_model){
        .kind = c.medium, .rate = 0.4 / m->time_step, .draw = c.draw, .weight = c.weight, .density = density};
    if (c.medium == MEDIUM_OVERDAMPED) { /* no velocities: no crossing rule */
      m->medium.tensor = TENSOR_RPY;
      m->medium.radius = 0.25;
      m->crossing.forbidden = false;
    }
    if (c.repels) {
      m->medium.repulsion = 25.0;
      m->medium.second.share = 0.25, m->medium.second.repulsion = 40.0;
      m->medium.many.repulsion = 10.0, m->medium.many.range = 0.75;
    }
    m->solvent.per_cell = m->solvent.collision_interval = 0.0;
  }
}

/* The model took the rows that it was to take. */
static inline void contract_taken(const struct model *m, struct choice c)
{
  assert_ptr_equal(fluid_of(m), fluid_row(c.fluid));
  if (m->bonds > 1)
    assert_ptr_equal(crossing_rule_of(m), crossing_rule_row(c.crossing));
}

/* Crowded fibers of two masses, open and closed, in a thin solvent: a quarter of the members are alone in their cell.
 */
static inline struct model contract_scene(struct choice c)
{
  struct model m = test_model(6, 7, 8, 2, 0.01, 2);
  m.seed = dice_seed(2701);
  test_add_kind(&m, 30, 6);
  struct fiber_kind *ring = test_add_kind(&m, 12, 5);
  ring->ring = true;
  ring->mass = 2.5;
  ring->bending = 2.0;
  contract_choose(&m, c);
  return m;
}

/* Free vertices of two masses, which collide in every step, far enough apart in time that all meet all. */
static inline struct model contract_gas(struct choice c)
{
  struct model m = test_model(6, 6, 6, 3, 0.1, 1);
  m.seed = dice_seed(2702);
  test_add_kind(&m, 60, 1)->mass = 2.5;
  test_add_kind(&m, 60, 1)->mass = 10.0;
  contract_choose(&m, c);
  return m;
}

/* Can this scene run? If not, it is told why. */
static inline bool contract_accepts(struct choice c)
{
  struct model m = contract_scene(c);
  struct model_error error;
  const bool ok = model_finish(&m, &error);
  if (!ok)
    print_message("  rejected: %s: %s\n", error.path, error.text);
  model_free(&m);
  return ok;
}

/* The row that a rule is. */
static inline const struct collision_rule *contract_rule(enum rule rule)
{
  const struct model m = {.solvent.rule = rule};
  return collision_rule_of(&m);
}

/* May the two stand together? A thermal rule is its own thermostat (mpc/rule.h). */
static inline bool contract_together(enum rule rule, enum thermostat_kind thermostat)
{
  return !contract_rule(rule)->thermal || thermostat == THERMOSTAT_NONE;
}

/* The word for this row of a key of a section, as scenes have it; NULL if there is no such key or word. */
static inline const char *contract_word(const char *section, const char *name, int row, int *words)
{
  const struct key_table *table = &model_keys;
  *words = 0;
  for (size_t k = 0; k < model_keys.count && section; k++)
    if (strcmp(model_keys.key[k].name, section) == 0)
      table = model_keys.key[k].keys;
  for (size_t k = 0; k < table->count; k++)
    if (strcmp(table->key[k].name, name) == 0 && table->key[k].choice) {
      *words = key_choices(&table->key[k]);
      return row - table->key[k].first < *words ? table->key[k].choice[row - table->key[k].first] : NULL;
    }
  return NULL;
}

/* --- members ----------------------------------------------------------------------------------------------------- */

/* Solvent particles by id, then vertices. */
struct member {
  double mass;
  struct vec3 velocity;
  uint32_t cell;
};

static inline uint32_t contract_count(const struct test_run *r)
{
  return r->state.solvent.n + r->state.vertices;
}

/* As they are now, in the cells of the collision of this step; to be freed. */
static inline struct member *contract_members(const struct test_run *r, uint64_t step)
{
  const struct point shift = grid_shift(&r->model, step);
  const struct solvent *s = &r->state.solvent;
  struct member *all = calloc(contract_count(r), sizeof *all);
  for (uint32_t i = 0; i < s->n; i++)
    all[s->id[i]] = (struct member){1.0, solvent_v(&r->state, i),
                                    cell_by_floor(&r->model.box, (struct point){s->x[i], s->y[i], s->z[i]}, shift)};
  for (uint32_t v = 0; v < r->state.vertices; v++)
    all[s->n + v] = (struct member){r->model.mass[v], r->state.velocity[v],
                                    cell_by_floor(&r->model.box, r->state.position[v], shift)};
  return all;
}

/* What the members of a cell add up to. */
struct cell_total {
  uint32_t n;
  bool foreign; /* a random solvent takes part, which keeps its momentum to itself */
  double mass;
  long double momentum[3], energy; /* energy: twice the kinetic one */
  double sizes;                    /* sum of m |v| */
};

/* Of all cells; to be freed. */
static inline struct cell_total *contract_totals(const struct test_run *r, const struct member *all, uint64_t step)
{
  const uint32_t cells = (uint32_t)box_cell_count(&r->model.box);
  struct cell_total *total = calloc(cells, sizeof *total);
  for (uint32_t k = 0; k < cells && model_has_phantoms(&r->model); k++)
    total[k].foreign = random_solvent_phantoms(&r->model, step, k).mass > 0.0;
  for (uint32_t i = 0; i < contract_count(r); i++) {
    struct cell_total *t = &total[all[i].cell];
    const double v[3] = {all[i].velocity.x, all[i].velocity.y, all[i].velocity.z};
    t->n++;
    t->mass += all[i].mass;
    t->sizes += all[i].mass * vec3_norm(all[i].velocity);
    for (int c = 0; c < 3; c++) {
      t->momentum[c] += (long double)all[i].mass * v[c];
      t->energy += (long double)all[i].mass * v[c] * v[c];
    }
  }
  return total;
}

/* The collision that a plan has for this model, alone. */
static inline void contract_collide(struct test_run *r, uint64_t step)
{
  struct plan plan = {0};
  mpc_plan_collision(&plan, &r->model, offsetof(struct work, mpc), "collide");
  const struct moment now = {&r->state, &r->model, &r->work.fault, NULL, step};
  assert_int_equal(plan.stages, 1);
  if (!plan.stage[0].act((char *)&r->work + plan.stage[0].room, &now, &plan.stage[0])) {
    char text[512];
    fault_describe(&r->work.fault, text, sizeof text);
    fail_msg("%s", text);
  }
}

/* --- one collision ----------------------------------------------------------------------------------------------- */

enum { CONTRACT_ROUNDS = 12 };

/*
 * Momentum of a cell of N members, and its rounding. Each member's momentum is rounded to a multiple of 2^-44, by at
 * most 2^-45 per component: the sum is off by delta, |delta| <= sqrt(3) N 2^-45. New velocities are v_cm + f R (v -
 * v_cm) with a v_cm that is off by delta/M, so the new momentum is off by delta - f R delta: (1 + f) |delta| at most.
 * With velocities drawn anew f R delta is the rounding of the drawn ones' sum, of the same size. To this comes the
 * rounding of doubles, fewer than 16 operations on numbers not larger than |v| + |v'| + 2 |v_cm|: 2^-49 of that for
 * each member.
 */
static inline double momentum_bound(const struct cell_total *old, const struct cell_total *new, double factor)
{
  return 0x1p-45 * sqrt(3.0) * (1.0 + factor) * old->n + 0x1p-49 * (3.0 * old->sizes + new->sizes);
}

/* Energy: with v_cm off by delta/M, twice the energy is off by 2 v_cm.(R - 1) delta, at most 4 |v_cm| |delta|; and
 * 2^-48 of all that is added up, since the axis has unit length to a few 2^-53 only. */
static inline double energy_bound(const struct cell_total *old, const struct cell_total *new)
{
  return 0x1p-43 * sqrt(3.0) * old->n * old->sizes / old->mass + 0x1p-48 * (double)(old->energy + new->energy);
}

struct one_collision {
  struct test_run run;
  struct member *before, *after;
  struct cell_total *old, *new;
  uint64_t step;
};

/* Of a state by dice, everybody moving on at `flow`; a round of its own. */
static inline struct one_collision collide_once(struct choice c, uint64_t round, struct vec3 velocity)
{
  const struct vec3 flow = {velocity.x, velocity.y, c.flat ? 0.0 : velocity.z};
  struct dice d = {dice_seed(2703) + round};
  struct model m = contract_scene(c);
  m.seed = dice_u64(&d);
  m.solvent.rotation_angle = round % 2 ? 90.0 : dice_between(&d, 60.0, 170.0);
  m.flow = flow;
  struct one_collision x = {.run = dice_run(m, &d), .step = 1 + round};
  contract_taken(&x.run.model, c);
  for (uint32_t i = 0; i < x.run.state.solvent.n; i++)
    set_solvent_v(&x.run.state, i, vec3_add(flow, solvent_v(&x.run.state, i)));
  for (uint32_t v = 0; v < x.run.state.vertices; v++)
    x.run.state.velocity[v] = vec3_add(flow, x.run.state.velocity[v]);
  x.before = contract_members(&x.run, x.step);
  x.old = contract_totals(&x.run, x.before, x.step);
  contract_collide(&x.run, x.step);
  x.after = contract_members(&x.run, x.step);
  x.new = contract_totals(&x.run, x.after, x.step);
  return x;
}

static inline void end_collision(struct one_collision *x)
{
  free(x->before), free(x->after), free(x->old), free(x->new);
  test_end(&x->run);
}

/* What a thermostat has multiplied the relative velocities of a cell by. */
static inline double factor_of(const struct one_collision *x, uint32_t cell)
{
  return x->run.work.mpc.thermostat && x->old[cell].n > 1 ? x->run.work.mpc.turn[cell].factor : 1.0;
}

/* Momentum of every cell, and of everything. With velocities permuted, of everything only. */
static inline void contract_momentum(struct choice c)
{
  uint64_t cells = 0;
  for (uint64_t k = 0; k < CONTRACT_ROUNDS; k++) {
    struct one_collision x = collide_once(c, k, (struct vec3){0.5, -1.0, 0.25});
    double most = 0.0;
    long double gain[3] = {0, 0, 0};
    bool foreign = false;
    for (uint32_t i = 0; i < (uint32_t)box_cell_count(&x.run.model.box); i++) {
      const struct cell_total *old = &x.old[i], *new = &x.new[i];
      const double bound = momentum_bound(old, new, factor_of(&x, i));
      struct vec3 off = {(double)(new->momentum[0] - old->momentum[0]), (double)(new->momentum[1] - old->momentum[1]),
                         (double)(new->momentum[2] - old->momentum[2])};
      most += bound;
      for (int j = 0; j < 3; j++)
        gain[j] += new->momentum[j] - old->momentum[j];
      foreign |= old->foreign && old->n > 0;
      if (old->foreign || old->n == 0 || c.permuted)
        continue;
      cells++;
      if (!(vec3_norm(off) <= bound))
        fail_msg("round %lu: a cell of %u members gained %.3g m a0/t0, allowed %.3g", (unsigned long)k, old->n,
                 vec3_norm(off), bound);
    }
    if (!foreign)
      for (int j = 0; j < 3; j++)
        assert_close((double)gain[j], 0.0, most);
    end_collision(&x);
  }
  assert_true(c.permuted || cells > 100);
}

/* Does a collision of this choice keep the energy? */
static inline bool contract_keeps_energy(struct choice c)
{
  struct model m = {.solvent.bath = c.bath};
  return c.medium == MEDIUM_CELLS && !contract_rule(c.rule)->thermal && c.thermostat == THERMOSTAT_NONE &&
         !model_has_phantoms(&m);
}

static inline void contract_energy(struct choice c)
{
  double changed = 0.0;
  for (uint64_t k = 0; k < CONTRACT_ROUNDS; k++) {
    struct one_collision x = collide_once(c, k, (struct vec3){0.5, -1.0, 0.25});
    double most = 0.0;
    long double gain = 0.0;
    for (uint32_t i = 0; i < (uint32_t)box_cell_count(&x.run.model.box); i++) {
      const long double off = x.new[i].energy - x.old[i].energy;
      if (x.old[i].n == 0)
        continue;
      const double bound = energy_bound(&x.old[i], &x.new[i]);
      gain += off;
      most += bound;
      changed += x.old[i].n > 1 ? fabs((double)off) : 0.0;
      if (contract_keeps_energy(c) && !c.permuted && !(fabs((double)off) <= bound))
        fail_msg("round %lu: a cell of %u members gained %.3g kT, allowed %.3g", (unsigned long)k, x.old[i].n,
                 (double)off, bound);
    }
    if (contract_keeps_energy(c))
      assert_close((double)gain, 0.0, most);
    end_collision(&x);
  }
  if (!contract_keeps_energy(c)) /* else the choice does not do what its flags say */
    assert_true(changed > 1.0);
}

/* Members that are alone in their cell keep their velocities, to the rounding of a sum; all others change theirs. */
static inline void contract_lone(struct choice c)
{
  uint64_t lone = 0, others = 0, still = 0;
  for (uint64_t k = 0; k < CONTRACT_ROUNDS; k++) {
    struct one_collision x = collide_once(c, k, (struct vec3){0.5, -1.0, 0.25});
    for (uint32_t i = 0; i < contract_count(&x.run); i++) {
      const struct member *a = &x.before[i], *b = &x.after[i];
      const struct cell_total *cell = &x.old[a->cell];
      const double moved = vec3_norm(vec3_sub(b->velocity, a->velocity));
      if (cell->n > 1 || cell->foreign) {
        others++;
        still += moved < 1e-9;
        continue;
      }
      lone++;
      assert_close(moved, 0.0, 0x1p-44 * sqrt(3.0) / a->mass + 0x1p-49 * vec3_norm(a->velocity));
    }
    end_collision(&x);
  }
  print_message("  %lu lone members, %lu others\n", (unsigned long)lone, (unsigned long)others);
  assert_true(lone > 20 && others > 100);
  assert_true(still == 0);
}

/* The same collision in a uniform flow u: velocities are those without it, plus u. Where v_cm is rounded otherwise,
 * velocities are off by (1 + f) sqrt(3) 2^-44 over the lightest mass in the cell, as above; in doubles, by 2^-48 of
 * what is added. A thermostat's factor is the root of a ratio of energies, summed in units of 2^-32: relative, it is
 * off by N 2^-32 over the cell's relative energy, at most. */
static inline void contract_galilean(struct choice c)
{
  for (uint64_t k = 0; k < CONTRACT_ROUNDS; k++) {
    const struct vec3 none = {0, 0, 0}, u = {3.0 / 7.0, -5.0 / 3.0, c.flat ? 0.0 : 7.0 / 9.0};
    struct one_collision x = collide_once(c, k, none), y = collide_once(c, k, u);
    for (uint32_t i = 0; i < contract_count(&x.run); i++) {
      const struct vec3 a = x.after[i].velocity, b = y.after[i].velocity, off = vec3_sub(vec3_sub(b, a), u);
      const uint32_t cell = x.before[i].cell;
      const struct cell_total *t = &x.old[cell];
      const double factor = factor_of(&x, cell), size = sqrt((double)t->energy) + vec3_norm(a) + vec3_norm(u);
      double relative = (double)t->energy;
      for (int j = 0; j < 3; j++)
        relative -= (double)(t->momentum[j] * t->momentum[j]) / t->mass;
      double bound = 0x1p-44 * sqrt(3.0) * (1.0 + factor) + 0x1p-48 * (1.0 + factor) * size;
      if (x.run.work.mpc.thermostat && t->n > 1)
        bound += t->n * 0x1p-32 / fmax(relative, 1e-300) * factor * sqrt(fmax(relative, 0.0));
      assert_int_equal(cell, y.before[i].cell);
      if (!(vec3_norm(off) <= bound))
        fail_msg("round %lu: member %u is off by %.3g a0/t0 in a flow, allowed %.3g", (unsigned long)k, i,
                 vec3_norm(off), bound);
    }
    end_collision(&x);
    end_collision(&y);
  }
}

/* --- many collisions --------------------------------------------------------------------------------------------- */

enum { SPECIES = 3, BLOCK_STEPS = 100, BLOCKS = 200, WARM_UP = 300 };

static inline double kinetic_of_all(const struct test_run *r, double scale)
{
  double energy = 0.0;
  for (uint32_t i = 0; i < r->state.solvent.n; i++) {
    const struct vec3 v = vec3_scale(scale, solvent_v(&r->state, i));
    set_solvent_v((struct state *)&r->state, i, v);
    energy += vec3_dot(v, v);
  }
  for (uint32_t i = 0; i < r->state.vertices; i++) {
    r->state.velocity[i] = vec3_scale(scale, r->state.velocity[i]);
    energy += r->model.mass[i] * vec3_dot(r->state.velocity[i], r->state.velocity[i]);
  }
  return energy;
}

/* Far from equilibrium: cold solvent, hot vertices, all together so many kT for each degree of freedom, no momentum. */
static inline void start_unequal(struct test_run *r, double temperature)
{
  struct vec3 p = {0, 0, 0};
  for (uint32_t i = 0; i < r->state.solvent.n; i++) {
    set_solvent_v(&r->state, i, vec3_scale(0.5, solvent_v(&r->state, i)));
    p = vec3_add(p, solvent_v(&r->state, i));
  }
  for (uint32_t v = 0; v < r->state.vertices; v++) {
    r->state.velocity[v] = vec3_scale(2.0, r->state.velocity[v]);
    p = vec3_add_scaled(p, r->model.mass[v], r->state.velocity[v]);
  }
  const struct vec3 change = vec3_scale(-1.0 / r->model.total_mass, p);
  for (uint32_t i = 0; i < r->state.solvent.n; i++)
    set_solvent_v(&r->state, i, vec3_add(change, solvent_v(&r->state, i)));
  for (uint32_t v = 0; v < r->state.vertices; v++)
    r->state.velocity[v] = vec3_add(change, r->state.velocity[v]);
  const double wanted = r->model.dimensions * temperature * (contract_count(r) - 1.0);
  (void)kinetic_of_all(r, sqrt(wanted / kinetic_of_all(r, 1.0)));
}

/* Of one species: its temperature by second moments of velocity components, and by fourth ones. */
struct moments {
  double mass, n, second, fourth;
};

static inline void add_moments(struct moments *s, const struct model *m, double mass, struct vec3 v)
{
  const double x = mass * v.x * v.x, y = mass * v.y * v.y, z = mass * v.z * v.z;
  s->mass = mass;
  s->n += m->dimensions; /* z is 0 in a plane */
  s->second += x + y + z;
  s->fourth += x * x + y * y + z * z;
}

/*
 * Solvent and vertices of two masses have the Maxwell distribution at kT = 1, from a start far from it: <m v_x^2> = 1 -
 * m/M, where the total momentum is kept (M: mass of all), else 1; <(m v_x^2)^2> = 3 of its square. Where the energy is
 * kept, 1 is what it was set to; else the start is at kT = 2. Means over blocks of 100 collisions, much longer than the
 * memory of a velocity (ten collisions for the heaviest). Allowed: five standard errors (1 false alarm in 5e5 numbers),
 * and 4/N for the N members whose energy is fixed together, since ensembles that differ in what they keep differ by
 * that order.
 */
static inline void contract_equipartition(struct choice c)
{
  static const char *const names[SPECIES] = {"solvent", "light", "heavy"};
  struct dice d = {dice_seed(2704)};
  struct test_run r = dice_run(contract_gas(c), &d);
  if (model_has_dumbbells(&r.model)) /* springs in equilibrium */
    fluid_of(&r.model)->start(&r.state, &r.model);
  start_unequal(&r, contract_keeps_energy(c) ? 1.0 : 2.0);
  test_steps(&r, WARM_UP);
  struct sample second[SPECIES] = {{0}}, fourth[SPECIES] = {{0}};
  double mass[SPECIES] = {0};
  for (int b = 0; b < BLOCKS; b++) {
    struct moments s[SPECIES] = {{0}};
    for (int k = 0; k < BLOCK_STEPS; k++) {
      test_steps(&r, 1);
      for (uint32_t i = 0; i < r.state.solvent.n; i++)
        add_moments(&s[0], &r.model, 1.0, solvent_v(&r.state, i));
      for (uint32_t v = 0; v < r.state.vertices; v++)
        add_moments(&s[1 + r.model.fiber_kind_of[r.model.fiber_of[v]]], &r.model, r.model.mass[v], r.state.velocity[v]);
    }
    for (int k = 0; k < SPECIES && s[k].n >= 0.0; k++) {
      if (s[k].n == 0.0)
        continue;
      sample_add(&second[k], s[k].second / s[k].n);
      sample_add(&fourth[k], s[k].fourth / s[k].n);
      mass[k] = s[k].mass;
    }
  }
  const struct thermostat *thermostat = r.work.mpc.thermostat;
  const double together = contract_count(&r) / (thermostat && thermostat->layered ? r.model.box.rows[1] : 1.0);
  const double finite = 4.0 / together;
  for (int k = 0; k < SPECIES; k++) {
    if (second[k].n == 0.0)
      continue;
    const double expected = !model_keeps_momentum(&r.model) ? 1.0 : 1.0 - mass[k] / r.model.total_mass;
    print_message("  %-8s <m v^2> %.4f +- %.4f, <(m v^2)^2>/3 %.4f +- %.4f, expected %.4f\n", names[k], second[k].mean,
                  sample_error(&second[k]), fourth[k].mean / 3.0, sample_error(&fourth[k]) / 3.0, expected);
    assert_close(second[k].mean, expected, 5.0 * sample_error(&second[k]) + finite);
    assert_close(fourth[k].mean / 3.0, expected * expected, 5.0 * sample_error(&fourth[k]) / 3.0 + 2.0 * finite);
    assert_true(sample_error(&second[k]) < 0.02); /* or the test says nothing */
  }
  test_end(&r);
}

/* --- bits -------------------------------------------------------------------------------------------------------- */

enum { BIT_STEPS = 60 };

static inline void rebuild_work(struct test_run *r)
{
  work_free(&r->work);
  assert_true(work_alloc(&r->work, &r->model));
}

static inline void assert_same_state(const struct test_run *one, const struct test_run *other, const char *what)
{
  if (state_hash(&one->state) != state_hash(&other->state))
    fail_msg("%s: other bits", what);
  assert_memory_equal(&one->state.counts, &other->state.counts, sizeof one->state.counts);
}

/* The same bits with particles elsewhere in memory, and with a work that is thrown away after every step. */
static inline void contract_bits(struct choice c)
{
  struct dice d = {dice_seed(2705)};
  struct test_run plain = test_start(contract_scene(c)), other = test_start(contract_scene(c)),
                  thrown = test_start(contract_scene(c));
  contract_taken(&plain.model, c);
  for (int k = 0; k < BIT_STEPS; k++) {
    if (k % 7 == 0)
      shuffle_memory(&other.state, &d);
    test_steps(&plain, 1);
    test_steps(&other, 1);
    test_steps(&thrown, 1);
    rebuild_work(&thrown);
  }
  assert_same_state(&plain, &other, "another order in memory");
  assert_same_state(&plain, &thrown, "work rebuilt after every step");
  assert_true(!crossing_rule_of(&plain.model)->forbids || plain.state.counts.executed > 0);
  test_end(&plain);
  test_end(&other);
  test_end(&thrown);
}

/* --- what is not used is not there ------------------------------------------------------------------------------- */

/* Bytes and arrays that are asked for: memory_alloc comes here. */
static struct {
  uint64_t bytes, arrays;
} contract_taken_memory;

void *aligned_alloc(size_t edge, size_t room)
{
  void *memory = NULL;
  contract_taken_memory.bytes += room;
  contract_taken_memory.arrays++;
  return posix_memalign(&memory, edge, room) ? NULL : memory;
}

/* Arrays are rounded up to whole cache lines. */
static inline void assert_bytes(uint64_t counted, const char *room)
{
  const uint64_t taken = contract_taken_memory.bytes, spare = 63 * contract_taken_memory.arrays;
  if (!(taken >= counted && taken <= counted + spare))
    fail_msg("%s: %lu bytes are counted, %lu taken for %lu arrays", room, (unsigned long)counted, (unsigned long)taken,
             (unsigned long)contract_taken_memory.arrays);
  contract_taken_memory.bytes = contract_taken_memory.arrays = 0;
}

static inline void assert_there(const void *array, bool used, const char *what)
{
  if ((array != NULL) != used)
    fail_msg("%s %s", what, used ? "is missing" : "is there, but not used");
}

/* Arrays that this model does not use are NULL, and what is counted is what is taken. */
static inline void contract_scratch_of(struct model model)
{
  test_finish(&model);
  const struct model *m = &model;
  struct mpc c;
  struct contact t;
  struct fiber f;
  contract_taken_memory.bytes = contract_taken_memory.arrays = 0;
  assert_true(mpc_alloc(&c, m, fluid_of(m), false));
  assert_bytes(mpc_bytes(m), "mpc");
  assert_true(contact_alloc(&t, m, fiber_force_at, false));
  const bool forbids = crossing_rule_of(m)->forbids, in_turns = crossing_rule_of(m)->in_turns;
  if (forbids) /* the neighbors' grid is counted too, but taken when it is first built */
    assert_true(contract_taken_memory.bytes < contact_bytes(m) + 63 * contract_taken_memory.arrays);
  assert_bytes(forbids ? contract_taken_memory.bytes : contact_bytes(m), "contact");
  assert_true(fiber_alloc(&f, m));
  assert_bytes(fiber_bytes(m), "fiber");

  const bool particles = model_has_solvent(m) && model_in_cells(m), bathed = model_has_phantoms(m);
  const bool collides = model_has_cells(m), pairs = m->medium.kind == MEDIUM_PAIRS;
  const bool vertices = m->vertices > 0, thermal = c.rule->thermal;
  assert_there(c.sum, collides, "sum");
  assert_there(c.turn, collides, "turn");
  assert_there(c.relative, collides && c.thermostat, "relative");
  assert_there(c.solvent_cell, particles, "solvent_cell");
  assert_there(c.vertex_cell, collides && vertices, "vertex_cell");
  assert_there(c.occupied, bathed, "occupied");
  assert_there(c.table, bathed, "table");
  assert_there(c.order, particles, "order");
  assert_there(c.column, particles, "column");
  assert_there(c.slot, particles && !m->solvent.hydrodynamics, "slot");
  for (int k = 0; k < 3; k++)
    assert_there(c.drawn[k], particles && thermal, "drawn");
  assert_there(c.spin, collides && c.rule->spinning, "spin");
  assert_there(c.middle, collides && c.rule->spinning, "middle");
  assert_there(c.drawn_vertex, collides && vertices && thermal, "drawn_vertex");
  assert_there(t.order, in_turns, "contact order");
  assert_there(t.rank, in_turns, "rank");
  assert_there(t.range, forbids, "range");
  assert_there(t.queue, in_turns, "queue");
  assert_there(t.waits, in_turns, "waits");
  assert_there(t.turns, in_turns, "turns");
  assert_there(t.flights.version, forbids && !in_turns, "flights.version");
  assert_there(t.flights.bend_of, forbids && !in_turns, "flights.bend_of");
  assert_there(t.candidates.first, forbids, "candidates.first");
  assert_there(f.force, vertices, "force");
  struct medium b;
  contract_taken_memory.bytes = contract_taken_memory.arrays = 0;
  assert_true(medium_alloc(&b, m, fluid_of(m)));
  assert_bytes(medium_bytes(m), "medium");
  assert_there(b.place, pairs, "place");
  assert_there(b.first, pairs, "first");
  assert_there(b.x, pairs, "x");
  assert_there(b.number, pairs, "number");
  assert_there(b.mover, pairs, "mover");
  assert_there(b.encounter, false, "encounter");
  medium_free(&b);
  mpc_free(&c);
  contact_free(&t);
  fiber_free(&f);
  model_free(&model);
}

/* The scene; its solvent alone, if it has particles; its fibers alone; vertices without bonds. */
static inline void contract_scratch(struct choice c)
{
  contract_scratch_of(contract_scene(c));
  contract_scratch_of(contract_gas(c));
  struct model solvent = test_model(6, 6, 6, 3, 0.01, 2), fibers = contract_scene((struct choice){.scheme = c.scheme});
  contract_choose(&solvent, c);
  if (model_has_phantoms(&solvent))
    model_free(&solvent);
  else
    contract_scratch_of(solvent);
  fibers.solvent.per_cell = 0.0;
  fibers.crossing.forbidden = crossing_rule_row(c.crossing)->forbids;
  fibers.crossing.rule = c.crossing;
  contract_scratch_of(fibers);
}

/* A check of every medium with every draw and weight that it takes. */
static inline void contract_over_media(void (*check)(struct choice))
{
  for (int medium = MEDIUM_PRIVATE; medium < MEDIA; medium++)
    for (int draw = 0; draw < contract_draws(medium); draw++)
      for (int weight = 0; weight < (medium == MEDIUM_PAIRS ? MEDIUM_WEIGHTS : 1); weight++) {
        print_message("  medium %d, draw %d, weight %d\n", medium, draw, weight);
        check((struct choice){.medium = medium, .draw = draw, .weight = weight});
      }
}

#endif

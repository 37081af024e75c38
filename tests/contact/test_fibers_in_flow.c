/* Fibers between walls and in a sheared box (contact/drift.h, contact/wall.h), under every crossing rule. */
#include "contact/drift.h"
#include "contact/rings_in_flow.h"
#include "contact/rule.h"
#include "contact/skins.h"
#include "contact/takeoff.h"
#include "fiber/force.h"
#include "statistics.h"
#include "wall/account.h"

/* --- links ------------------------------------------------------------------------------------------------------- */

/* Number of looks, one after each 50 steps, at which links had changed. */
static uint32_t changed_links(struct test_run *r, uint64_t steps)
{
  struct bonds_of_rings start, now;
  uint32_t changed = 0;
  judge_links(r, &start);
  assert_true(start.links >= 1 && r->model.fibers <= 20);
  for (uint64_t k = 0; k < steps; k += 50) {
    test_steps(r, 50);
    judge_links(r, &now);
    changed += memcmp(&now, &start, sizeof now) != 0;
  }
  print_message("  %s, rate %g: %u links, %lu contacts, %lu negative, %lu rigid, changed %u times\n",
                crossing_rule_of(&r->model)->name, r->model.shear.rate, start.links,
                (unsigned long)r->state.counts.executed, (unsigned long)r->state.counts.negative,
                (unsigned long)r->state.counts.rigid, changed);
  return changed;
}

static struct model in_flow(struct model m, enum crossing_kind rule, uint64_t seed)
{
  m.crossing.rule = rule;
  m.seed = seed;
  if (m.solvent.per_cell > 0.0) {
    m.solvent.rule = RULE_AT_A;
    m.solvent.thermostat = THERMOSTAT_NONE;
  }
  return m;
}

static const enum crossing_kind forbidding[] = {CROSSING_SEQUENTIAL, CROSSING_EVENT_DRIVEN};

/* Rings that are linked with each other, and with images, above all with those above and below. */
static void links_are_kept_in_shear(void **unused)
{
  (void)unused;
  for (int k = 0; k < 2; k++)
    for (int oscillates = 0; oscillates < 2; oscillates++) {
      struct model m = in_flow(chain(3, 0.01), forbidding[k], dice_seed(3201));
      m.shear.rate = 0.4;
      m.shear.period = oscillates ? 16.0 : 0.0;
      struct test_run r = test_start(m);
      assert_int_equal(changed_links(&r, 3000), 0);
      assert_true(r.state.counts.executed > 10);
      test_end(&r);
      m = in_flow(dense_rings(3, 0.01), forbidding[k], dice_seed(3202));
      m.shear.rate = oscillates ? -0.3 : 0.3;
      struct test_run d = test_start(m);
      assert_int_equal(changed_links(&d, 1500), 0);
      assert_true(d.state.counts.executed > 300);
      test_end(&d);
    }
}

/* The instrument can see it: phantoms in the same flow. */
static void phantoms_lose_their_links(void **unused)
{
  (void)unused;
  struct model m = in_flow(chain(3, 0.01), CROSSING_SEQUENTIAL, dice_seed(3201));
  m.crossing.forbidden = false;
  m.shear.rate = 0.4;
  struct test_run r = test_start(m);
  assert_true(changed_links(&r, 3000) > 10);
  test_end(&r);
}

/* --- between walls ----------------------------------------------------------------------------------------------- */

static struct model slit(enum crossing_kind rule, enum wall_kind kind, double per_cell, double speed)
{
  struct model m = test_model(5, 4, 5, per_cell, 0.01, 2);
  struct fiber_kind *k = test_add_kind(&m, 25, 6);
  k->bending = 8.0;
  k = test_add_kind(&m, 10, 8);
  k->ring = true;
  k->bending = 2.0;
  k = test_add_kind(&m, 20, 1);
  k->mass = 2.0;
  m.walls.kind = kind;
  m.walls.upper = (struct vec3){speed, 0.0, -0.5 * speed};
  m.crossing.forbidden = rule != CROSSING_FREE;
  return in_flow(m, rule, dice_seed(3203));
}

static void assert_between_walls(const struct test_run *r)
{
  for (uint32_t i = 0; i < r->state.vertices; i++)
    if (r->state.position[i].y < 0 || r->state.position[i].y > r->model.box.edge[1])
      fail_msg("vertex %u is at %.15g a0", i, (double)r->state.position[i].y * LATTICE_UNIT);
}

static void momentum_of(const struct test_run *r, long double p[3])
{
  const struct solvent *s = &r->state.solvent;
  p[0] = p[1] = p[2] = 0.0L;
  for (uint32_t i = 0; i < s->n; i++)
    p[0] += (long double)s->vx[i], p[1] += (long double)s->vy[i], p[2] += (long double)s->vz[i];
  for (uint32_t v = 0; v < r->state.vertices; v++) {
    const struct vec3 u = r->state.velocity[v];
    const long double mass = (long double)r->model.mass[v];
    p[0] += mass * (long double)u.x, p[1] += mass * (long double)u.y, p[2] += mass * (long double)u.z;
  }
}

/* What all walls have given since the start, m a0/t0. */
static void given_by_walls(const struct state *state, long double p[3])
{
  p[0] = p[1] = p[2] = 0.0L;
  for (uint32_t k = 0; k < state->wall_rows; k++) {
    const struct point *a = &state->wall_momentum[k];
    p[0] += ldexpl((long double)a->x, -44), p[1] += ldexpl((long double)a->y, -44),
        p[2] += ldexpl((long double)a->z, -44);
  }
}

/* THEORY: the momentum of solvent and fibers changes by what the walls give, in every step. A velocity is rounded a few
 * times in a step, by at most 2^-52 of 8 a0/t0 each time; the account, and the sums of cells, by 2^-44 for each hit and
 * each cell. */
static void balance(enum crossing_kind rule, enum wall_kind kind, double per_cell)
{
  struct test_run r = test_start(slit(rule, kind, per_cell, kind == WALL_SLIP ? 0.0 : 0.4));
  const double members = r.state.solvent.n + 5.0 * r.state.vertices;
  const double rounding = 16.0 * (members + 125.0) * 0x1p-44;
  long double p[3], given[3], p0[3], given0[3];
  uint64_t touched = 0;
  assert_between_walls(&r);
  for (int step = 0; step < 400; step++) {
    momentum_of(&r, p0);
    given_by_walls(&r.state, given0);
    test_steps(&r, 1);
    assert_between_walls(&r);
    momentum_of(&r, p);
    given_by_walls(&r.state, given);
    for (int c = 0; c < 3; c++)
      assert_close((double)((p[c] - p0[c]) - (given[c] - given0[c])), 0.0, rounding);
    touched += given[1] != given0[1];
    if (crossing_rule_of(&r.model)->forbids)
      check_skins(&r);
  }
  print_message("  %s, %s: %lu steps with hits, %lu contacts\n", crossing_rule_of(&r.model)->name,
                kind == WALL_SLIP ? "slip" : "no slip", (unsigned long)touched, (unsigned long)r.state.counts.executed);
  assert_true(touched > 20);
  test_end(&r);
}

static void momentum_is_balanced(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < CROSSINGS; rule++)
    for (int kind = WALL_NO_SLIP; kind < WALL_KINDS; kind++)
      for (int solvent = 0; solvent < 2; solvent++)
        balance(rule, kind, solvent ? 5.0 : 0.0);
}

/* Rings that are linked keep their links between walls that slide. */
static void links_are_kept_between_walls(void **unused)
{
  (void)unused;
  const struct vec3 center[3] = {{1.0, 1.6, 1.0}, {2.1, 1.7, 1.1}, {3.2, 1.5, 1.2}};
  const struct vec3 direction[3] = {{0.1, 0.13, 1}, {0.07, 1, 0.11}, {0.12, 0.09, 1}};
  for (int k = 0; k < 2; k++) {
    struct model m = in_flow(ring_model(4, 3, 0.01, 3, 14, center, direction), forbidding[k], dice_seed(3204));
    m.walls.kind = WALL_NO_SLIP;
    m.walls.shear_rate = 0.3;
    struct test_run r = test_start(m);
    assert_int_equal(changed_links(&r, 6000), 0);
    assert_between_walls(&r);
    assert_true(r.state.counts.executed > 50);
    test_end(&r);
  }
}

/* Places the vertices of a run, all at rest. */
static void place(struct test_run *r, const struct vec3 *at)
{
  for (uint32_t i = 0; i < r->state.vertices; i++) {
    r->state.position[i] = point_move((struct point){0, 0, 0}, at[i]);
    r->state.velocity[i] = (struct vec3){0, 0, 0};
  }
}

/* A vertex is carried along by the wall that it hits: its bond would pass through another one only after the hit. */
static void bonds_are_met_after_a_hit(void **unused)
{
  (void)unused;
  const struct vec3 at[4] = {{1.0, 0.002, 2.0}, {1.0, 1.0, 2.0}, {1.03, 0.01, 1.5}, {1.03, 0.01, 2.5}};
  for (int k = 0; k < 2; k++)
    for (int mirrored = 0; mirrored < 2; mirrored++) {
      struct model m = test_model(4, 4, 4, 0, 0.05, 2);
      struct fiber_kind *kind = test_add_kind(&m, 2, 2);
      kind->bond_length = 1.0;
      m.solvent.collision_interval = 0.0;
      m.walls.kind = WALL_NO_SLIP;
      m.walls.lower.x = m.walls.upper.x = 0.9;
      struct test_run r = test_start(in_flow(m, forbidding[k], 1));
      struct vec3 there[4];
      for (int i = 0; i < 4; i++)
        there[i] = (struct vec3){at[i].x, mirrored ? 4.0 - at[i].y : at[i].y, at[i].z};
      place(&r, there);
      r.state.velocity[0].y = mirrored ? 0.2 : -0.2; /* on the wall after a fifth of the drift, then at 1.8 along x */
      assert_true(contact_drift(&r.state, &r.model, &r.work.contact, 1.0, 1, 0, NULL, &r.work.fault));
      assert_int_equal(r.state.counts.executed, 1);
      assert_true(r.state.position[0].x < r.state.position[2].x + LATTICE_CELL / 10);
      const struct vec3 p = point_difference(r.state.position[1], r.state.position[0]),
                        q = point_difference(r.state.position[3], r.state.position[2]),
                        w = point_difference(r.state.position[2], r.state.position[0]);
      const double volume = vec3_dot(vec3_cross(p, q), w);
      assert_true(mirrored ? volume < 0.0 : volume > 0.0); /* the other bond is still ahead */
      test_end(&r);
    }
}

/* A vertex that reaches a wall in the last tick of a drift, all at once, does not end beyond it. */
static void the_last_tick_counts(void **unused)
{
  (void)unused;
  struct model m = test_model(4, 4, 4, 0, 0.01, 2);
  struct fiber_kind *kind = test_add_kind(&m, 64, 1);
  kind->mass = 1.0;
  test_add_kind(&m, 2, 3); /* bonds that could meet: else vertices move freely */
  m.solvent.collision_interval = 0.0;
  m.walls.kind = WALL_SLIP;
  struct test_run r = test_start(in_flow(m, CROSSING_EVENT_DRIVEN, 1));
  for (uint32_t i = 0; i < 64; i++) {
    const struct point rate = flight_rate((struct vec3){0.0, -0.01, 0.0});
    const int64_t y = -rate.y * (FLIGHT_TICKS - 1) + (int64_t)i * (-rate.y / 64);
    r.state.position[i].y = i % 2 ? y : r.model.box.edge[1] - y;
    r.state.velocity[i] = (struct vec3){0.0, i % 2 ? -1.0 : 1.0, 0.0};
  }
  assert_true(contact_drift(&r.state, &r.model, &r.work.contact, 1.0, 1, 0, NULL, &r.work.fault));
  assert_between_walls(&r);
  for (uint32_t i = 0; i < 64; i++)
    assert_true(r.state.velocity[i].y == (i % 2 ? 1.0 : -1.0));
  test_end(&r);
}

/* --- energy ------------------------------------------------------------------------------------------------------ */

/* Energy at the time of the positions: velocities are those of half a step ahead. */
static double energy_of(struct test_run *r)
{
  const double half = 0.5 * r->model.time_step;
  const struct fiber_energy e = fiber_energies(&r->state, &r->model);
  double sum = e.bond + e.bend;
  for (uint32_t i = 0; i < r->state.vertices; i++) {
    const struct vec3 v =
        vec3_add_scaled(r->state.velocity[i], -half * r->model.inverse_mass[i], r->work.fiber.force[i]);
    sum += 0.5 * r->model.mass[i] * vec3_dot(v, v);
  }
  return sum;
}

/* THEORY: a hit that reverses the velocity of its own time conserves the leap-frog's energy to second order, as
 * contacts do (docs/contacts.md): some 3e-5 kT each at this time step. 150 vertices of mass 5 at 1.5 per a0^3 hit 50
 * a0^2 of walls 13 times per t0: in 40 t0 that is 0.02 kT. The energy of the leap-frog differs from this sum by a few
 * tenths of a kT at most. The rule `sequential` reverses the velocity of the middle of the drift, at walls and at
 * contacts, and heats. */
static void hits_do_not_heat(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < CROSSINGS; rule++)
    for (int kind = WALL_NO_SLIP; kind < WALL_KINDS; kind++) {
      struct model m = slit(rule, kind, 0.0, 0.0);
      m.kinds = 1; /* open fibers */
      m.kind[0].bending = 64.0;
      struct test_run r = test_start(m);
      const double before = energy_of(&r);
      test_steps(&r, 4000);
      const double gained = energy_of(&r) - before;
      print_message("  %s, wall %d: %.3f kT, %lu contacts\n", crossing_rule_of(&r.model)->name, kind, gained,
                    (unsigned long)r.state.counts.executed);
      if (crossing_rule_of(&r.model)->in_turns)
        assert_true(gained > 2.0);
      else
        assert_close(gained, 0.0, 0.5);
      test_end(&r);
    }
}

/* --- start ------------------------------------------------------------------------------------------------------- */

/* THEORY: a rod of length l fits at height y < l/2 from a wall with the probability 2 y/l, and with certainty beyond.
 */
static void rods_start_in_equilibrium(void **unused)
{
  (void)unused;
  enum { BINS = 10, RODS = 20000 };
  const double length = 3.0, gap = 4.0;
  struct model m = test_model(4, 4, 4, 0, 0.01, 2);
  struct fiber_kind *k = test_add_kind(&m, RODS, 2);
  k->bond_length = 1.5;
  k->vertices = 3;
  k->spring = 1e5;
  k->bending = 1e5;
  m.walls.kind = WALL_NO_SLIP;
  m.crossing.forbidden = false;
  m.time_step = 1e-4;
  m.solvent.collision_interval = 0.0;
  m.seed = dice_seed(3205);
  struct test_run r = test_start(m);
  double seen[BINS] = {0}, expected[BINS], all = 0.0, chi2 = 0.0;
  assert_between_walls(&r);
  for (uint32_t f = 0; f < RODS; f++) {
    const double y = (double)r.state.position[3 * f + 1].y * LATTICE_UNIT;
    seen[(int)(y / gap * BINS)] += 1.0;
  }
  for (int b = 0; b < BINS; b++) {
    expected[b] = 0.0;
    for (int i = 0; i < 1000; i++) {
      const double y = (b + (i + 0.5) / 1000) * gap / BINS, from_wall = fmin(y, gap - y);
      expected[b] += fmin(1.0, 2.0 * from_wall / length) / 1000;
    }
    all += expected[b];
  }
  for (int b = 0; b < BINS; b++) {
    const double e = RODS * expected[b] / all;
    chi2 += (seen[b] - e) * (seen[b] - e) / e;
  }
  print_message("  chi^2 %.3g of %d\n", chi2, BINS - 1);
  assert_true(gsl_cdf_chisq_Q(chi2, BINS - 1) > 1e-4);
  test_end(&r);
}

/* --- shear ------------------------------------------------------------------------------------------------------- */

static struct model sheared_crowd(enum crossing_kind rule, double rate)
{
  struct model m = test_model(4, 4, 3, 0, 0.01, 2);
  struct fiber_kind *k = test_add_kind(&m, 30, 7);
  k->bending = 8.0;
  k = test_add_kind(&m, 8, 8);
  k->ring = true;
  k->mass = 3.0;
  k->bending = 2.0;
  m.solvent.collision_interval = 0.0;
  m.shear.rate = rate;
  m.crossing.forbidden = rule != CROSSING_FREE;
  return in_flow(m, rule, dice_seed(3206));
}

/* True if both are in the same state, but for images of whole fibers. */
static bool same_but_for_images(const struct test_run *a, const struct test_run *b)
{
  const int64_t *edge = a->model.box.edge;
  for (uint32_t i = 0; i < a->state.vertices; i++) {
    const struct point p = a->state.position[i], q = b->state.position[i];
    if ((p.x - q.x) % edge[0] != 0 || (p.y - q.y) % edge[1] != 0 || (p.z - q.z) % edge[2] != 0)
      return false;
  }
  return memcmp(a->state.velocity, b->state.velocity, a->state.vertices * sizeof *a->state.velocity) == 0;
}

/* A box that is sheared at rate 0 is a periodic one. */
static void no_shear_is_periodic(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < CROSSINGS; rule++) {
    struct test_run r[2];
    for (int k = 0; k < 2; k++) {
      memset(&r[k], 0, sizeof r[k]);
      r[k].model = sheared_crowd(rule, 0.0);
      test_finish(&r[k].model);
      if (k == 1)
        box_bound(&r[k].model.box, 1, BOUNDARY_SHEAR);
      assert_true(state_alloc(&r[k].state, &r[k].model) && work_alloc(&r[k].work, &r[k].model));
      assert_true(start_state(&r[k].state, &r[k].model, &r[k].work));
    }
    for (int step = 0; step < 60; step++) {
      test_steps(&r[0], 1);
      test_steps(&r[1], 1);
      assert_true(same_but_for_images(&r[0], &r[1]));
    }
    assert_true(rule == CROSSING_FREE || r[1].state.counts.executed > 10);
    test_end(&r[0]);
    test_end(&r[1]);
  }
}

/* All fibers one row up, and faster by the rate, have the same future, but that they drift along x at the rate:
 * contacts with images included. Contacts amplify the rounding of places, 2^-40 a0. */
static void rows_are_alike(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < CROSSINGS; rule++) {
    const double rate = 0.5;
    struct test_run low = test_start(sheared_crowd(rule, rate)), high = test_start(sheared_crowd(rule, rate));
    for (uint32_t i = 0; i < high.state.vertices; i++) {
      high.state.position[i].y += LATTICE_CELL / 4; /* so that no fiber is taken back in one of the two only */
      high.state.velocity[i].x += 0.25 * rate;
    }
    for (int step = 1; step <= 40; step++) {
      test_steps(&low, 1);
      test_steps(&high, 1);
      for (uint32_t i = 0; i < low.state.vertices; i++) {
        const struct vec3 d = point_difference(high.state.position[i], low.state.position[i]),
                          v = vec3_sub(high.state.velocity[i], low.state.velocity[i]);
        const double image = nearbyint((d.y - 0.25) / 4.0);
        const double slid = image * (double)shear_offset(&low.model, high.state.solvent_time + high.state.solvent_lag);
        assert_close(d.y - 4.0 * image, 0.25, 1e-7);
        assert_close(remainder(d.x - slid * LATTICE_UNIT - 0.25 * rate * step * 0.01, 4.0), 0.0, 1e-7);
        assert_close(v.x - 4.0 * rate * image, 0.25 * rate, 1e-6);
        assert_close(v.y, 0.0, 1e-6);
      }
    }
    print_message("  %s: %lu contacts\n", crossing_rule_of(&low.model)->name, (unsigned long)low.state.counts.executed);
    assert_true(low.state.counts.executed == high.state.counts.executed);
    assert_true(rule == CROSSING_FREE || low.state.counts.executed > 20);
    test_end(&low);
    test_end(&high);
  }
}

/* Lists and strains that are made anew change no bit: a run whose scratch is thrown away again and again. */
static void scratch_is_not_state(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < CROSSINGS; rule++) {
    struct test_run kept = test_start(sheared_crowd(rule, 0.7)), renewed = test_start(sheared_crowd(rule, 0.7));
    for (int step = 0; step < 400; step += 7) { /* 11.2 a0 of slide, through the edge twice */
      test_steps(&kept, 7);
      test_steps(&renewed, 7);
      assert_true(state_hash(&kept.state) == state_hash(&renewed.state));
      work_free(&renewed.work);
      assert_true(work_alloc(&renewed.work, &renewed.model));
    }
    test_end(&kept);
    test_end(&renewed);
  }
}

struct watch {
  const struct test_run *run;
  uint64_t contacts, images;
  double worst; /* cosine of the angle between a normal and a bond */
};

/* A bond as it is in space, at a part of the drift. */
static struct vec3 bond_in_space(const struct test_run *r, uint32_t bond, double part)
{
  const struct contact *c = &r->work.contact;
  const uint32_t end[2] = {bond, (uint32_t)r->model.next[bond]};
  struct point at[2];
  for (int k = 0; k < 2; k++)
    at[k] = crossing_rule_of(&r->model)->in_turns
                ? r->state.position[end[k]]
                : flight_place(r->state.position[end[k]], takeoff_rate_now(&r->state, c, end[k]),
                               (int64_t)(part * FLIGHT_TICKS));
  const double strain = (double)c->frame.slid + part * (double)(c->frame.slides - c->frame.slid);
  struct vec3 p = point_difference(at[1], at[0]);
  p.x += strain / (double)r->model.box.edge[1] * p.y;
  return p;
}

static void look_at_normal(void *context, const struct contact_event *e)
{
  struct watch *w = context;
  const bool turns = crossing_rule_of(&w->run->model)->in_turns;
  const struct vec3 n = e->hit.normal;
  if (!e->executed)
    return;
  const struct vec3 q = bond_in_space(w->run, e->standing_bond, turns ? 1.0 : e->hit.time),
                    p = bond_in_space(w->run, e->moving_bond, turns ? 1.0 : e->hit.time);
  assert_close(vec3_norm(n), 1.0, 1e-12);
  w->worst = fmax(w->worst, fabs(vec3_dot(n, q)) / vec3_norm(q));
  if (!turns) /* in turns, the bond that moves is not where it was before */
    w->worst = fmax(w->worst, fabs(vec3_dot(n, p)) / vec3_norm(p));
  w->contacts++;
  w->images += e->image[1] != 0;
}

/* Bonds push each other along the line that is perpendicular to both in space. Parallel bonds have no such line. */
static void normals_are_those_of_space(void **unused)
{
  (void)unused;
  for (int k = 0; k < 2; k++) {
    struct test_run r = test_start(sheared_crowd(forbidding[k], 1.0));
    struct watch w = {.run = &r};
    const struct contact_log log = {look_at_normal, &w};
    for (int step = 0; step < 150; step++)
      assert_true(step_advance(&r.state, &r.model, &r.work, &log));
    print_message("  %s: %lu contacts, %lu with images beyond y = L, worst cosine %.2g\n",
                  crossing_rule_of(&r.model)->name, (unsigned long)w.contacts, (unsigned long)w.images, w.worst);
    assert_true(w.contacts > 50 && w.images > 5);
    assert_close(w.worst, 0.0, 1e-5);
    test_end(&r);
  }
}

/* Forces and exchanges conserve momentum. A fiber that is taken back into the box leaves with the image's velocity. */
static void momentum_is_conserved_in_shear(void **unused)
{
  (void)unused;
  uint32_t taken = 0;
  for (int rule = 0; rule < CROSSINGS; rule++) {
    struct test_run r = test_start(sheared_crowd(rule, 0.6));
    struct point *before = calloc(r.state.vertices, sizeof *before);
    for (int step = 0; step < 500; step++) {
      long double p0[3], p[3];
      momentum_of(&r, p0);
      memcpy(before, r.state.position, r.state.vertices * sizeof *before);
      test_steps(&r, 1);
      momentum_of(&r, p);
      for (uint32_t i = 0; i < r.state.vertices; i++) {
        const double image = nearbyint(point_difference(r.state.position[i], before[i]).y / 4.0);
        p0[0] += (long double)(image * r.model.mass[i] * 4.0 * 0.6);
        taken += image != 0.0;
      }
      for (int c = 0; c < 3; c++)
        assert_close((double)(p[c] - p0[c]), 0.0, 1e-10);
    }
    print_message("  %s: %u vertices taken back so far, %lu contacts\n", crossing_rule_of(&r.model)->name, taken,
                  (unsigned long)r.state.counts.executed);
    free(before);
    test_end(&r);
  }
  assert_true(taken > 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(links_are_kept_in_shear),
      cmocka_unit_test(phantoms_lose_their_links),
      cmocka_unit_test(momentum_is_balanced),
      cmocka_unit_test(links_are_kept_between_walls),
      cmocka_unit_test(bonds_are_met_after_a_hit),
      cmocka_unit_test(the_last_tick_counts),
      cmocka_unit_test(hits_do_not_heat),
      cmocka_unit_test(rods_start_in_equilibrium),
      cmocka_unit_test(no_shear_is_periodic),
      cmocka_unit_test(rows_are_alike),
      cmocka_unit_test(scratch_is_not_state),
      cmocka_unit_test(normals_are_those_of_space),
      cmocka_unit_test(momentum_is_conserved_in_shear),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/*
 * A bead between walls: flights against a plain simulation in long doubles, which has no ticks and no lists; the
 * balance of momentum in whole steps; bits.
 */
#include "ball.h"
#include "bead/bead.h"
#include "exact.h"
#include "fluid/fluid.h"
#include "kernel/choose.h"
#include "wall/wall.h"

static struct model slit_model(struct dice *d, enum rule rule, double height)
{
  struct model m = test_model(12, 6, 13, 5.0, 0.1, 1);
  m.seed = dice_u64(d);
  m.solvent.rule = rule;
  m.walls.kind = WALL_NO_SLIP;
  m.walls.fill = FILL_PLANAR;
  m.bead.radius = 1.5;
  m.bead.center = (struct vec3){dice_between(d, -10.0, 20.0), height, dice_between(d, -10.0, 20.0)};
  return m;
}

/* --- flights ----------------------------------------------------------------------------------------------------- */

/* within: of the center from walls at `low` and `high`. */
static long double time_to_wall(const struct ball *p, long double low, long double high, long double within)
{
  return p->v[1] < 0   ? (low + within - p->x[1]) / p->v[1]
         : p->v[1] > 0 ? (high - within - p->x[1]) / p->v[1]
                       : INFINITY;
}

struct plain {
  struct ball *p, bead;
  uint32_t n;
  long double radius, mass, low, high, given[2][3]; /* by the walls */
  int touches, rebounds;                            /* hits of the bead by particles; of walls by the bead */
};

static void hit_bead(struct plain *w, struct ball *p)
{
  for (int k = 0; k < 3; k++) {
    const long double u = (p->v[k] + w->mass * w->bead.v[k]) / (1 + w->mass), old = p->v[k];
    p->v[k] = 2 * u - old;
    w->bead.v[k] -= (p->v[k] - old) / w->mass;
  }
  w->touches++;
}

/* Walls move with these velocities. The bead keeps what it has along them. */
static void hit_wall(struct plain *w, struct ball *p, const struct vec3 wall[2])
{
  const int which = p->v[1] > 0;
  const bool bead = p == &w->bead;
  const long double flow[3] = {wall[which].x, wall[which].y, wall[which].z}, mass = bead ? w->mass : 1;
  for (int k = 0; k < 3; k++) {
    const long double after = bead ? (k == 1 ? -p->v[k] : p->v[k]) : 2 * flow[k] - p->v[k];
    w->given[which][k] += mass * (after - p->v[k]);
    p->v[k] = after;
  }
  w->rebounds += bead;
}

static void fly_plainly(struct plain *w, const struct vec3 wall[2], long double time)
{
  for (long double left = time;;) {
    struct ball *who = NULL;
    bool at_wall = false;
    long double first = left;
    for (uint32_t i = 0; i <= w->n; i++) {
      struct ball *p = i < w->n ? &w->p[i] : &w->bead;
      const long double t = time_to_wall(p, w->low, w->high, i < w->n ? 0 : w->radius);
      const long double touch = i < w->n ? time_to_bead(p, &w->bead, w->radius) : INFINITY;
      if (t < first)
        first = t, who = p, at_wall = true;
      if (touch < first)
        first = touch, who = p, at_wall = false;
    }
    for (uint32_t i = 0; i <= w->n; i++)
      for (int k = 0; k < 3; k++)
        (i < w->n ? &w->p[i] : &w->bead)->x[k] += (i < w->n ? &w->p[i] : &w->bead)->v[k] * first;
    left -= first;
    if (!who)
      return;
    if (at_wall)
      hit_wall(w, who, wall);
    else
      hit_bead(w, who);
  }
}

static struct vec3 vector(const long double x[3])
{
  return (struct vec3){(double)x[0], (double)x[1], (double)x[2]};
}

static struct vec3 sum_of_hits(const struct test_run *r, enum wall wall)
{
  const struct point none = {0, 0, 0};
  return account_between(none, r->state.wall_momentum[account_row(ACCOUNT_HITS, wall)]);
}

/* The flight alone, of all: what a collision does before it adds virtual particles. */
static void fly(struct test_run *r)
{
  struct mpc *c = &r->work.mpc;
  uint64_t span = 0;
  assert_true(bead_flight_alone(&r->state, &r->model, &r->work.bead->flight, &r->work.fault));
  r->state.solvent_lag = 2;
  assert_true(fluid_of(&r->model)->stream(&r->state, &r->model, 0, r->state.solvent.n, &r->work.fault));
  c->border->bin_particles(&r->state, &r->model, 0, r->state.solvent.n, c);
  assert_true(c->obstacle->rebound(c->obstacle->room, &r->state, &r->model, c, 1, &span, &r->work.fault));
}

/* An account across wraps at 2^20 m a0/t0. */
static void check_given(const struct test_run *r, enum wall wall, const long double given[3], double most)
{
  const struct vec3 sum = sum_of_hits(r, wall);
  assert_true(fabsl(sum.x - given[0]) < 1e-9L && fabsl(sum.z - given[2]) < 1e-9L);
  assert_true(fabsl(remainderl(sum.y - given[1], 0x1p20L)) < most);
}

#define HEAVY 1e9 /* m: a bead that gives a wall 2000 times what its account holds */

/* A hit may be early by a tick of two bodies, 1.5e-5 a0, and moves what follows by twice that. The account of a wall is
 * rounded to 2^-44 for each hit; a heavy bead gives 2 M V, of which V is rounded to 2^-52 at each of some 10 hits. */
static void flights_are_those_of_a_plain_simulation(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(4701)};
  int touches = 0, rebounds = 0;
  for (int round = 0; round < 40; round++) {
    struct model m = slit_model(&d, RULE_SRD, round % 2 ? 1.5 + 0.03 * dice_uniform(&d) : dice_between(&d, 1.5, 4.5));
    m.bead.mass = round % 8 == 5 ? HEAVY : 0.0;
    if (round % 4 > 1)
      m.walls.lower.x = 0.5, m.walls.upper = (struct vec3){-0.9, 0.0, 0.3};
    struct test_run r = test_start(m);
    struct solvent *s = &r.state.solvent;
    struct bead *b = r.state.bead;
    if (round % 2)
      b->velocity.y = -1.0 - (double)(round % 3);
    const struct point origin = b->position;
    struct plain w = {.p = calloc(s->n, sizeof *w.p),
                      .n = s->n,
                      .radius = r.model.bead.radius,
                      .mass = r.model.bead.mass,
                      .low = -(long double)origin.y * LATTICE_UNIT,
                      .high = (long double)(r.model.box.edge[1] - origin.y) * LATTICE_UNIT,
                      .bead = {.v = {b->velocity.x, b->velocity.y, b->velocity.z}}};
    for (uint32_t i = 0; i < s->n; i++) {
      const struct vec3 x = point_in_a0(bead_to_image(&r.model.box, origin, (struct point){s->x[i], s->y[i], s->z[i]}));
      w.p[i] = (struct ball){{x.x, x.y, x.z}, {s->vx[i], s->vy[i], s->vz[i]}};
    }
    const struct vec3 wall[2] = {m.walls.lower, m.walls.upper};
    fly_plainly(&w, wall, r.model.time_step);
    fly(&r);
    assert_int_equal(b->account.z, w.touches);
    for (uint32_t i = 0; i < s->n; i++) {
      const struct point expected = point_move(origin, vector(w.p[i].x));
      const struct vec3 off =
          point_in_a0(bead_to_image(&r.model.box, expected, (struct point){s->x[i], s->y[i], s->z[i]}));
      assert_true(vec3_norm(off) < 5e-5);
      assert_true(vec3_norm(vec3_sub(solvent_velocity(s, i), vector(w.p[i].v))) < 1e-12);
    }
    assert_true(vec3_norm(vec3_sub(point_difference(b->position, origin), vector(w.bead.x))) < 5e-5);
    for (int k = 0; k < 2; k++)
      check_given(&r, (enum wall)k, w.given[k], round % 8 == 5 ? HEAVY * 0x1p-46 : 1e-9);
    touches += w.touches, rebounds += w.rebounds;
    free(w.p);
    test_end(&r);
  }
  print_message("  %d hits of the bead, %d of walls by it\n", touches, rebounds);
  assert_true(touches > 200 && rebounds > 10);
}

/* --- whole steps ------------------------------------------------------------------------------------------------- */

static struct vec3 momentum_of(const struct test_run *r)
{
  long double p[3] = {0, 0, 0};
  const struct vec3 w = r->state.bead->velocity;
  for (uint32_t i = 0; i < r->state.solvent.n; i++) {
    const struct vec3 v = solvent_velocity(&r->state.solvent, i);
    p[0] += v.x, p[1] += v.y, p[2] += v.z;
  }
  return vec3_add_scaled(vector(p), r->model.bead.mass, w);
}

static struct vec3 given_by_walls(const struct state *state)
{
  struct vec3 sum = {0, 0, 0};
  for (uint32_t row = 0; row < WALLS * ACCOUNT_SHARES; row++)
    sum = vec3_add(sum, account_between((struct point){0, 0, 0}, state->wall_momentum[row]));
  return sum;
}

static void check_places(const struct test_run *r)
{
  const struct solvent *s = &r->state.solvent;
  const int64_t y = r->state.bead->position.y, radius = bead_radius(&r->model), edge = r->model.box.edge[1];
  struct fault fault = {.code = FAULT_NONE};
  assert_true(y >= radius && y <= edge - radius);
  assert_true(bead_sound(&r->state, &r->model, &fault));
  for (uint32_t i = 0; i < s->n; i++)
    assert_true(s->y[i] >= 0 && s->y[i] <= edge);
}

static struct model flow_model(struct dice *d, int k)
{
  struct model m = slit_model(d, k % 2 ? RULE_AT_A : RULE_SRD, k < 4 ? 3.0 : 1.6);
  if (k % 4 > 1) /* Couette and Poiseuille flow at once */
    m.walls.lower.x = -0.4, m.walls.upper.x = 0.4, m.solvent.acceleration = (struct vec3){0.0, 0.0, 0.02};
  if (k >= 4) { /* at a wall */
    m.bead.drive.force = (struct vec3){3.0, -20.0, 1.0};
    m.bead.drive.spring = k % 4 > 1 ? 5.0 : 0.0;
  }
  return m;
}

/* On the bead: of its drive, and of a flow that pushes it as the solvent that it displaces. */
static struct vec3 force_on(const struct test_run *r, struct point start)
{
  const struct bead_drive *d = &r->model.bead.drive;
  const double displaced = 5.0 * 14.137166941154069; /* (4/3) pi 1.5^3 */
  return vec3_add_scaled(vec3_add_scaled(d->force, displaced, r->model.solvent.acceleration), -d->spring,
                         point_difference(r->state.bead->position, start));
}

/* What solvent and bead have gained is what walls and forces gave. 6000 particles change their velocity some three
 * times in a step, each time rounded to 2^-52 of 4 a0/t0, and sums of cells and accounts are rounded to 2^-44 for each
 * member: 200 steps leave 2e-10 at most, if roundings are random. The last unit of an account is 6e-14. */
static void walls_and_forces_give_all_momentum(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(4702)};
  double largest = 0.0;
  for (int k = 0; k < 8; k++) {
    struct test_run r = test_start(flow_model(&d, k));
    const double dt = r.model.time_step;
    const struct point start = r.state.bead->position;
    struct vec3 expected = momentum_of(&r);
    for (int step = 0; step < 200; step++) {
      test_steps(&r, 1);
      check_places(&r);
      expected = vec3_add_scaled(expected, dt * r.state.solvent.n, r.model.solvent.acceleration);
      expected = vec3_add_scaled(expected, dt, force_on(&r, start));
    }
    const struct vec3 off = vec3_sub(vec3_sub(momentum_of(&r), expected), given_by_walls(&r.state));
    largest = fmax(largest, vec3_norm(off));
    assert_true(r.state.bead->account.z > 100);
    test_end(&r);
  }
  print_message("  momentum off by %.2g m a0/t0\n", largest);
  assert_true(largest < 1e-9);
}

/* A file may say so; a run never does. One lattice unit is what a place in a scene is rounded to. */
static void a_bead_in_a_wall_is_found(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(4704)};
  struct test_run r = test_start(slit_model(&d, RULE_SRD, 3.0));
  struct fault fault = {.code = FAULT_NONE};
  const int64_t radius = bead_radius(&r.model), edge = r.model.box.edge[1];
  r.state.solvent.n = 0; /* none of them is in its way */
  for (int upper = 0; upper < 2; upper++)
    for (int64_t in = -1; in <= 2; in++) {
      r.state.bead->position.y = upper ? edge - radius + in : radius - in;
      assert_true(bead_sound(&r.state, &r.model, &fault) == (in < 2));
    }
  assert_int_equal(fault.code, FAULT_BEAD_WALL);
  r.state.solvent.n = r.model.solvent.particles;
  test_end(&r);
}

static void memory_and_kernels_do_not_matter(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(4703)};
  for (int k = 4; k < 8; k++) {
    struct dice same = d;
    struct test_run a = test_start(flow_model(&d, k)), b = test_start(flow_model(&same, k));
    b.work.mpc.kernel = kernel_plain;
    for (int step = 0; step < 20; step++) {
      shuffle_memory(&b.state, &d);
      test_steps(&a, 1);
      test_steps(&b, 1);
      assert_true(state_hash(&a.state) == state_hash(&b.state));
    }
    test_end(&a);
    test_end(&b);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(flights_are_those_of_a_plain_simulation), cmocka_unit_test(walls_and_forces_give_all_momentum),
      cmocka_unit_test(a_bead_in_a_wall_is_found), cmocka_unit_test(memory_and_kernels_do_not_matter)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

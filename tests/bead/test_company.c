/*
 * A bead among fibers: no bond ever enters it, contacts keep what they must, and come as often as kinetic theory says.
 *
 * Distances are those of all bonds from all images of the bead, in long doubles, without lists. One run in 2000 fails
 * by chance, in the test of the rate.
 */
#include "contact/tubes.h"

#include "bead/company.h"
#include "fluid/fluid.h"
#include "observe/observe.h"
#include "statistics.h"
#include "system/bead.h"

/* --- all distances ------------------------------------------------------------------------------------------------ */

static double reach_of(const struct model *m, uint32_t bond)
{
  return m->bead.radius + 0.5 * m->kind[m->fiber_kind_of[m->fiber_of[bond]]].diameter;
}

/* The least of all distances of bonds from the center less what they must be, a0. */
static double bead_gap(const struct test_run *r)
{
  const struct model *m = &r->model;
  const struct point none = {0, 0, 0};
  double least = 1e9;
  for (uint32_t i = 0; i < m->vertices; i++) {
    if (m->next[i] < 0)
      continue;
    const struct axis3 p = axis_at(point_minus(r->state.position[m->next[i]], r->state.position[i]), none, 0.0L),
                       o = {0, 0, 0};
    const struct point to = point_minus(r->state.bead->position, r->state.position[i]);
    const struct point first = {lattice_fold(to.x, m->box.edge[0]), lattice_fold(to.y, m->box.edge[1]),
                                lattice_fold(to.z, m->box.edge[2])};
    for (int k = 0; k < 27; k++) {
      const int32_t image[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
      const struct axis3 center = axis_at(point_image(first, image, &m->box), none, 0.0L);
      least = fmin(least, (double)sqrtl(end_to_segment(center, o, p)) - reach_of(m, i));
    }
  }
  return least;
}

struct seen {
  long contacts, with_bead;
};

static void see(void *context, const struct contact_event *e)
{
  struct seen *s = context;
  s->contacts++;
  s->with_bead += e->standing_bond == EVENT_BEAD;
  assert_true(e->impulse > 0.0);
  assert_close(vec3_norm(e->hit.normal), 1.0, 1e-14);
  assert_true(e->hit.s >= 0.0 && e->hit.s <= 1.0);
}

static void advance(struct test_run *r, struct seen *seen)
{
  const struct contact_log log = {see, seen};
  if (step_advance(&r->state, &r->model, &r->work, &log))
    return;
  char text[512];
  fault_describe(&r->work.fault, text, sizeof text);
  fail_msg("%s", text);
}

static struct fiber_kind *add(struct model *m, uint32_t count, uint32_t vertices, double diameter)
{
  struct fiber_kind *k = test_add_kind(m, count, vertices);
  m->crossing.rule = CROSSING_EVENT_DRIVEN;
  k->diameter = diameter;
  return k;
}

static struct model with_bead(int edge, double per_cell, double dt, double radius)
{
  struct model m = test_model(edge, edge, edge, per_cell, dt, 1);
  m.bead.radius = radius;
  m.bead.center = (struct vec3){0.3, edge - 0.2, 0.5 * edge}; /* across edges of the box */
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  return m;
}

/* Lines, thick fibers, rings, flexible chains and rods. */
static struct model many_kinds(double radius, uint64_t seed)
{
  struct model m = with_bead(10, 2.0, 0.02, radius);
  m.seed = seed;
  add(&m, 30, 8, 0.0);
  add(&m, 10, 8, 0.3);
  add(&m, 10, 2, 0.5)->bending = 0.0;
  struct fiber_kind *k = add(&m, 6, 12, 0.1);
  k->ring = true, k->bending = 2.0;
  k = add(&m, 10, 12, 0.0);
  k->bending = 0.0, k->mass = 1.0;
  return m;
}

/* --- times of contact --------------------------------------------------------------------------------------------- */

/* A bond and a point that are a reach and a little apart at some tick: at a side or at an end, with any motion, or with
 * none towards each other. */
static struct tube_query draw_bond_and_bead(struct dice *d, int kind)
{
  const double radius = dice_between(d, 1.5, 8.0), motion = dice_log(d, 1e-6, 1.0);
  const struct vec3 n = any_unit(d);
  const double s = kind % 2 ? (double)(dice_u64(d) % 2) : dice_uniform(d);
  struct vec3 p = unit_across(d, n);
  if (kind % 2) /* the end looks at the center */
    p = vec3_add_scaled(p, (s == 0.0 ? -1.0 : 1.0) * dice_uniform(d), n);
  p = vec3_scale(dice_log(d, 0.02, 2.0) / vec3_norm(p), p);
  const struct vec3 vp = vec3_scale(motion * dice_uniform(d), any_unit(d));
  struct vec3 vw = vec3_scale(motion, any_unit(d));
  if (kind >= 4) { /* grazing */
    const struct vec3 v = vec3_add_scaled(vw, -s, vp);
    vw = vec3_add_scaled(vw, -vec3_dot(v, n), n);
  }
  const int32_t tick = kind >= 2 && kind < 4 ? 0 : (int32_t)dice_integer(d, 0, FLIGHT_TICKS);
  const double gap = 0x1p-40 * (double[]){0.0, 4.0, 1e3, 0x1p36 * motion}[dice_u64(d) % 4] * dice_between(d, -1, 1);
  struct tube_query k = {.reach = llrint(radius * 0x1p40), .from = 0};
  k.pair.p_rate = lattice_of(vec3_scale(0x1p-16, vp)), k.pair.w_rate = lattice_of(vec3_scale(0x1p-16, vw));
  k.pair.p = minus_ticks(lattice_of(p), k.pair.p_rate, tick);
  k.pair.w = minus_ticks(lattice_of(vec3_add_scaled(vec3_scale(s, p), radius + gap, n)), k.pair.w_rate, tick);
  return k;
}

static void contacts_are_never_late(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(5107)};
  struct tube_tally t = {0};
  for (int k = 0; t.queries < 24000; k++) {
    const struct tube_query query = draw_bond_and_bead(&d, k % 6);
    audit_tubes(&query, tube_contact, &t);
  }
  tell_tubes("bead", &t);
  assert_true(t.missed == 0 && t.invented == 0 && t.answers > 12000);
}

/* --- nothing enters ----------------------------------------------------------------------------------------------- */

static void no_bond_enters_the_bead(void **unused)
{
  (void)unused;
  for (int kind = 0; kind < 4; kind++) {
    struct model m = many_kinds(kind % 2 ? 2.0 : 1.5, dice_seed(5101) + (uint64_t)kind);
    m.scheme = kind < 2 ? SCHEME_KICK_SPLIT : SCHEME_PAPER;
    if (kind % 2)
      m.bead.drive = (struct bead_drive){.force = {20.0, 0.0, 8.0}};
    struct test_run r = test_start(m);
    struct seen seen = {0, 0};
    double least = bead_gap(&r);
    assert_true(least > 0.0);
    for (int step = 0; step < (kind < 2 ? 3000 : 800); step++) {
      advance(&r, &seen);
      const double gap = bead_gap(&r);
      least = fmin(least, gap);
      if (!(gap > -1e-14))
        fail_msg("step %d: a bond is %g a0 inside", step + 1, -gap);
      struct fault fault = {.code = FAULT_NONE};
      assert_true(bead_sound(&r.state, &r.model, &fault) && start_sound(&r.state, &r.model, &fault));
    }
    print_message("  %ld contacts, %ld with the bead, %lu rigid, %ld hits; least gap %.2g a0\n", seen.contacts,
                  seen.with_bead, (unsigned long)r.state.counts.rigid, (long)r.state.bead->account.z, least);
    assert_true(seen.with_bead > 15 && seen.contacts > 500 && least < 1e-2);
    test_end(&r);
  }
}

/* A wall of rods that stand still, 0.8 a0 apart: a fast bead of R = 1.5 does not get through it, whatever hits it. */
static void a_static_wall_holds_the_bead(void **unused)
{
  (void)unused;
  struct model m = with_bead(12, 1.0, 0.02, 1.5);
  struct fiber_kind *k = add(&m, 15, 24, 0.0);
  m.bead.center = (struct vec3){3.0, 6.0, 6.0};
  k->frozen = true, k->start = START_STRAIGHT, k->placed = k->count, k->place = calloc(k->count, sizeof *k->place);
  for (uint32_t n = 0; n < k->count; n++)
    k->place[n] = (struct fiber_place){{6.0, 0.8 * n, 6.0}, {0, 0, 1}};
  struct test_run r = test_start(m);
  struct seen seen = {0, 0};
  for (int step = 0; step < 2500; step++) {
    if (step % 50 == 0) /* always at the wall */
      r.state.bead->velocity = (struct vec3){4.0, 0.3, 0.2};
    advance(&r, &seen);
    assert_true(bead_gap(&r) > -1e-14);
    const double x = (double)r.state.bead->position.x * LATTICE_UNIT;
    assert_true(x < 6.0 - sqrt(1.5 * 1.5 - 0.4 * 0.4) + 1e-9);
  }
  print_message("  %ld contacts\n", seen.with_bead);
  assert_true(seen.with_bead > 30);
  test_end(&r);
}

/* --- what contacts keep ------------------------------------------------------------------------------------------- */

static struct vec3 no_force(const struct model *model, uint32_t vertex,
                            struct point (*place)(const void *context, uint32_t vertex), const void *context)
{
  (void)model, (void)vertex, (void)place, (void)context;
  return (struct vec3){0, 0, 0};
}

/* A drift and the flights of the solvent, without forces and collisions. */
static void fly(struct test_run *r, struct seen *seen)
{
  const struct contact_log log = {see, seen};
  struct bead_flight *all = &r->work.bead->flight;
  struct solvent *s = &r->state.solvent;
  r->work.contact.force = no_force;
  if (!contact_drift(&r->state, &r->model, &r->work.contact, 1.0, 1, 0, &log, &r->work.fault)) {
    char text[512];
    fault_describe(&r->work.fault, text, sizeof text);
    fail_msg("%s", text);
  }
  r->state.solvent_lag = 2;
  assert_true(fluid_stream(&r->state, &r->model, &r->work.fault));
  for (uint32_t k = 0; k < all->n; k++) {
    const struct bead_visit *m = &all->at[k];
    s->x[m->place] = m->at.x, s->y[m->place] = m->at.y, s->z[m->place] = m->at.z;
    s->vx[m->place] = m->velocity.x, s->vy[m->place] = m->velocity.y, s->vz[m->place] = m->velocity.z;
  }
  *r->state.bead = all->bead;
}

struct total {
  struct vec3 momentum, spin; /* about the place where the bead began */
  double energy;
};

static void total_add(struct total *t, double mass, struct vec3 v, struct vec3 x)
{
  t->momentum = vec3_add_scaled(t->momentum, mass, v);
  t->spin = vec3_add_scaled(t->spin, mass, vec3_cross(x, v));
  t->energy += 0.5 * mass * vec3_dot(v, v);
}

static struct total total_of(const struct test_run *r, struct point origin, bool solvent)
{
  struct total t = {{0, 0, 0}, {0, 0, 0}, 0.0};
  total_add(&t, r->model.bead.mass, r->state.bead->velocity, point_difference(r->state.bead->position, origin));
  for (uint32_t i = 0; i < r->model.vertices; i++)
    total_add(&t, r->model.mass[i], r->state.velocity[i], point_difference(r->state.position[i], origin));
  for (uint32_t i = 0; solvent && i < r->state.solvent.n; i++)
    total_add(&t, 1.0, solvent_velocity(&r->state.solvent, i), (struct vec3){0, 0, 0});
  return t;
}

/* Momentum and energy of fibers, solvent and bead, to rounding; with light beads, which leave any slack that was
 * allowed for, and heavy ones. And nothing is inside. */
static void contacts_keep_momentum_and_energy(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(5102)};
  struct seen seen = {0, 0};
  long hits = 0;
  for (int round = 0; round < 60; round++) {
    struct model m = with_bead(16, 1.0, 0.05, 1.5);
    m.seed = dice_u64(&d);
    m.bead.mass = round % 3 ? 0.0 : 2000.0;
    add(&m, 200, 3, round % 2 ? 0.0 : 0.2)->mass = round % 3 == 1 ? 30.0 : 3.0;
    struct test_run r = test_start(m);
    for (uint32_t i = 0; i < r.model.vertices; i++)
      r.state.velocity[i] = vec3_scale(round % 3 == 1 ? 20.0 : 8.0, r.state.velocity[i]);
    for (int k = 0; k < 6; k++) {
      const struct total before = total_of(&r, r.state.bead->position, true);
      fly(&r, &seen);
      const struct total after = total_of(&r, r.state.bead->position, true);
      const double size = sqrt(before.energy * 1e4);
      assert_close(after.energy, before.energy, 1e-12 * before.energy);
      assert_close(vec3_norm(vec3_sub(after.momentum, before.momentum)), 0.0, 1e-13 * size);
      assert_true(bead_gap(&r) > -1e-14);
      struct fault fault = {.code = FAULT_NONE};
      assert_true(bead_sound(&r.state, &r.model, &fault));
    }
    hits += (long)r.state.bead->account.z;
    test_end(&r);
  }
  print_message("  %ld contacts with the bead, %ld hits\n", seen.with_bead, hits);
  assert_true(seen.with_bead > 100 && hits > 200);
}

/* Bead and fibers alone keep their angular momentum: a push is along the line from the nearest point to the center.
 * Solvent particles stand still, and drifts in which one was hit are left out. A place is rounded to 2^-25 a0. */
static void contacts_keep_angular_momentum(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(5103)};
  struct seen all = {0, 0};
  double worst = 0.0, pushes = 0.0;
  for (int round = 0; round < 150; round++) {
    struct model m = with_bead(12, 0.01, 0.05, 2.0);
    m.seed = dice_u64(&d);
    m.bead.center = (struct vec3){6, 6, 6};
    m.bead.mass = 40.0;
    struct fiber_kind *k = add(&m, 40, 2, round % 2 ? 0.0 : 0.3);
    k->bending = 0.0, k->start = START_STRAIGHT, k->placed = k->count, k->place = calloc(k->count, sizeof *k->place);
    for (uint32_t n = 0; n < k->count; n++)
      k->place[n] = (struct fiber_place){
          vec3_add_scaled((struct vec3){6, 6, 6}, dice_between(&d, 2.4, 3.4), dice_direction(&d)), dice_direction(&d)};
    struct test_run r = {.model = m};
    test_finish(&r.model);
    assert_true(state_alloc(&r.state, &r.model) && work_alloc(&r.work, &r.model));
    if (start_state(&r.state, &r.model, &r.work)) { /* the thick ones may overlap */
      for (uint32_t i = 0; i < r.state.solvent.n; i++)
        r.state.solvent.vx[i] = r.state.solvent.vy[i] = r.state.solvent.vz[i] = 0.0;
      for (uint32_t i = 0; i < r.model.vertices; i++)
        r.state.velocity[i] = vec3_scale(15.0, r.state.velocity[i]);
      const struct point origin = r.state.bead->position;
      struct seen seen = {0, 0};
      const struct total before = total_of(&r, origin, false);
      fly(&r, &seen);
      const struct total after = total_of(&r, origin, false);
      if (r.state.bead->account.z == 0) {
        all.with_bead += seen.with_bead;
        worst = fmax(worst, vec3_norm(vec3_sub(after.spin, before.spin)));
        pushes += vec3_norm(vec3_sub(after.momentum, before.momentum));
      }
    }
    test_end(&r);
  }
  print_message("  %ld contacts; angular momentum to %.2g\n", all.with_bead, worst);
  assert_true(all.with_bead > 20);
  assert_close(worst, 0.0, 3e-4); /* 80 vertices of 5 m at some 7 a0/t0, each place to some 1e-7 a0 */
  assert_close(pushes, 0.0, 1e-9);
}

/* A light rod between a heavy bead and a rod that stands still is pressed until no impulse parts them. It moves rigidly
 * with the bead for the rest of the drift, or stands with the frozen rod; nothing enters anything, and what is frozen
 * stands. */
static void what_is_pressed_goes_along(void **unused)
{
  (void)unused;
  for (int k = 0; k < 2; k++) {
    const double gap = 4e-4;
    struct model m = with_bead(24, 0.01, 0.004, 1.5);
    struct fiber_kind *light = add(&m, 1, 2, 0.2), *wall = add(&m, 1, 2 + (uint32_t)k, 0.2);
    light = &m.kind[0]; /* it has moved */
    m.bead.mass = 4000.0;
    m.bead.center = (struct vec3){6.0 - 1.6 - 0.2 - 2.0 * gap, 6.0, 6.0};
    light->mass = 0x1p-9, wall->frozen = true;
    light->bending = wall->bending = 0.0;
    light->start = wall->start = START_STRAIGHT, light->placed = wall->placed = 1;
    light->place = calloc(1, sizeof *light->place), wall->place = calloc(1, sizeof *wall->place);
    light->place[0] = (struct fiber_place){{6.0 - 0.2 - gap, 6.0, 6.0}, {0, 1, 0}};
    wall->place[0] = (struct fiber_place){{6.0, 6.0, 6.0}, {0, 0, 1}};
    struct test_run r = test_start(m);
    struct seen seen = {0, 0};
    for (uint32_t i = 0; i < r.model.vertices; i++)
      r.state.velocity[i] = (struct vec3){0, 0, 0};
    const struct point stands = r.state.position[2];
    for (int step = 0; step < 10; step++) {
      r.state.bead->velocity = (struct vec3){0.6, 0, 0};
      fly(&r, &seen);
      assert_true(bead_gap(&r) > -1e-14);
      assert_memory_equal(&stands, &r.state.position[2], sizeof stands);
      struct fault fault = {.code = FAULT_NONE};
      assert_true(start_sound(&r.state, &r.model, &fault));
    }
    print_message("  %ld contacts, %ld with the bead, %lu rigid\n", seen.contacts, seen.with_bead,
                  (unsigned long)r.state.counts.rigid);
    assert_true(r.state.counts.rigid > 0);
    test_end(&r);
  }
}

/* --- by hand ------------------------------------------------------------------------------------------------------ */

/* A bead flies at the middle of a rod, or at one of its ends. Two bodies of one line: all is known. */
static void contacts_by_hand(void **unused)
{
  (void)unused;
  for (int end = 0; end < 2; end++)
    for (int thick = 0; thick < 2; thick++) {
      struct model m = with_bead(12, 0.001, 0.1, 2.0);
      m.bead.center = (struct vec3){3.0, 6.0, 6.0};
      m.bead.mass = 20.0;
      struct fiber_kind *k = add(&m, 1, 2, thick ? 0.4 : 0.0);
      const struct vec3 along = end ? (struct vec3){1, 0, 0} : (struct vec3){0, 0, 1};
      k->bending = 0.0, k->mass = 5.0, k->start = START_STRAIGHT, k->placed = 1, k->place = calloc(1, sizeof *k->place);
      k->place[0] = (struct fiber_place){{5.6, 6.0, 6.0}, along};
      struct test_run r = test_start(m);
      r.state.solvent.x[0] = r.state.solvent.y[0] = r.state.solvent.z[0] = 0; /* far off */
      const double half = 0.5 * vec3_norm(point_difference(r.state.position[1], r.state.position[0]));
      const double speed = 10.0, gap = 2.6 - 2.0 - 0.2 * thick - (end ? half : 0.0);
      for (int i = 0; i < 2; i++)
        r.state.velocity[i] = (struct vec3){0, 0, 0};
      r.state.bead->velocity = (struct vec3){speed, 0, 0};
      struct seen seen = {0, 0};
      fly(&r, &seen);
      assert_int_equal(seen.with_bead, 1);
      const double compliance = 1.0 / 20.0 + (end ? 1.0 / 5.0 : 0.5 / 5.0), push = 2.0 * speed / compliance;
      const double after = speed - push / 20.0, near = end ? push / 5.0 : 0.5 * push / 5.0, far = end ? 0.0 : near;
      assert_close(r.state.bead->velocity.x, after, 1e-9);
      assert_close(r.state.velocity[0].x, near, 1e-9);
      assert_close(r.state.velocity[1].x, far, 1e-9);
      const double met = gap / speed, rest = 0.1 - met;
      assert_close((double)r.state.bead->position.x * LATTICE_UNIT, 3.0 + speed * met + after * rest, 1e-4);
      assert_close((double)r.state.position[1].x * LATTICE_UNIT, 5.6 + (end ? half : 0.0) + far * rest, 1e-4);
      test_end(&r);
    }
}

/* --- as often as kinetic theory says -------------------------------------------------------------------------------
 */

/* Needles of one bond outside of a bead touch it on the surface of a cylinder with half spheres, of area 2 pi a l and
 * 4 pi a^2, a = R + D/2. At each point the mean flux is n sqrt(kT c/2 pi), c = ((1 - s)^2 + s^2)/m + 1/M. n is one per
 * what the bead leaves free. */
static double expected_rate(const struct model *m, double l)
{
  const double a = m->bead.radius + 0.5 * m->kind[0].diameter, pi = 3.14159265358979324;
  double side = 0.0;
  for (int k = 0; k < 1000; k++) {
    const double s = (k + 0.5) / 1000.0;
    side += sqrt(((1 - s) * (1 - s) + s * s) / m->kind[0].mass + 1.0 / m->bead.mass) / 1000.0;
  }
  const double ends = sqrt(1.0 / m->kind[0].mass + 1.0 / m->bead.mass);
  const double room = box_volume(&m->box) - (4.0 / 3.0 * pi * a * a * a + pi * a * a * l);
  return m->kind[0].count * (2.0 * pi * a * l * side + 4.0 * pi * a * a * ends) / sqrt(2.0 * pi) / room;
}

static void contacts_come_as_often_as_kinetic_theory_says(void **unused)
{
  (void)unused;
  test_begin_statistics();
  enum { RUNS = 12, STEPS = 2500, NEEDLES = 700 };
  struct dice d = {dice_seed(5104)};
  struct sample over = {0};
  for (int run = 0; run < RUNS; run++) {
    struct model m = with_bead(10, 1.0, 0.02, run % 2 ? 1.5 : 2.0);
    m.seed = dice_u64(&d);
    struct fiber_kind *k = add(&m, NEEDLES, 2, 0.0);
    k->bending = 0.0, k->bond_length = 1.0, k->mass = 2.0, k->spring = 100.0;
    struct test_run r = test_start(m);
    struct seen seen = {0, 0};
    double length = 0.0;
    for (int step = 0; step < STEPS; step++) {
      advance(&r, &seen);
      for (uint32_t i = 0; i < r.model.vertices && step % 100 == 0; i += 2)
        length += vec3_norm(point_difference(r.state.position[i + 1], r.state.position[i])) / NEEDLES / (STEPS / 100);
    }
    sample_add(&over, (double)seen.with_bead / (expected_rate(&r.model, length) * STEPS * r.model.time_step));
    test_end(&r);
  }
  const double rate = over.mean;
  assert_sigma(rate, sample_error(&over), 1.0, 4.85); /* of 11 degrees of freedom: one in 2000 */
  assert_true(sample_error(&over) < 0.07);
}

/* --- starts and lists --------------------------------------------------------------------------------------------- */

static void overlapping_starts_are_refused(void **unused)
{
  (void)unused;
  for (int k = 0; k < 8; k++) {
    const double apart = 2.15 + (k % 2 ? 1e-4 : -1e-4);
    struct model m = with_bead(10, 1.0, 0.02, 2.0);
    m.bead.center = (struct vec3){0.25 * k, 5.0, 9.9};
    struct fiber_kind *kind = add(&m, 1, 9, 0.3);
    kind->start = START_STRAIGHT, kind->placed = 1, kind->place = calloc(1, sizeof *kind->place);
    kind->place[0] = (struct fiber_place){{0.25 * k, 5.0 + apart, 9.9}, {0, 0, 1}};
    struct test_run r = {.model = m};
    test_finish(&r.model);
    assert_true(state_alloc(&r.state, &r.model) && work_alloc(&r.work, &r.model));
    assert_int_equal(start_state(&r.state, &r.model, &r.work), k % 2);
    if (k % 2 == 0) {
      assert_int_equal(r.work.fault.code, FAULT_BEAD_OVERLAP);
      assert_close(r.work.fault.value, apart, 1e-9);
      assert_close(r.work.fault.limit, 2.15, 1e-9);
    } else {
      assert_true(start_sound(&r.state, &r.model, &r.work.fault));
      for (uint32_t i = 0; i < r.model.vertices; i++)
        r.state.position[i].y -= lattice_from_a0(0.1);
      assert_true(!start_sound(&r.state, &r.model, &r.work.fault));
    }
    test_end(&r);
  }
}

/* Lists change nothing: a run whose scratch is thrown away after every step ends in the same bits. */
static void lists_change_nothing(void **unused)
{
  (void)unused;
  uint64_t hash[2];
  for (int anew = 0; anew < 2; anew++) {
    struct model m = many_kinds(2.0, dice_seed(5105));
    m.bead.drive = (struct bead_drive){.spring = 20.0, .amplitude = {0.5, 0.0, 0.0}, .period = 10.0};
    struct test_run r = test_start(m);
    for (int step = 0; step < 120; step++) {
      struct seen seen = {0, 0};
      const uint32_t sorted = r.work.mpc.since_sort;
      advance(&r, &seen);
      if (!anew)
        continue;
      work_free(&r.work);
      assert_true(work_alloc(&r.work, &r.model));
      r.work.mpc.since_sort = sorted + 1;
    }
    hash[anew] = state_hash(&r.state);
    test_end(&r);
  }
  assert_true(hash[0] == hash[1]);
}

/* The momentum of all stays 0 with a drive: vertices take up their share. */
static void all_momentum_stays_zero(void **unused)
{
  (void)unused;
  for (int k = 0; k < 2; k++) {
    struct model m = many_kinds(1.5, dice_seed(5106));
    m.scheme = k ? SCHEME_PAPER : SCHEME_KICK_SPLIT;
    m.bead.drive = (struct bead_drive){.force = {12.0, -3.0, 0.0}, .spring = 10.0};
    struct test_run r = test_start(m);
    struct seen seen = {0, 0};
    for (int step = 0; step < 200; step++) {
      advance(&r, &seen);
      assert_close(vec3_norm(observe_conserved(&r.model, &r.state).momentum), 0.0, 1e-9);
    }
    test_end(&r);
  }
}

static void what_does_not_touch_it_is_refused(void **unused)
{
  (void)unused;
  for (int k = 0; k < 6; k++) {
    struct model m = with_bead(10, 1.0, 0.02, 2.0);
    struct fiber_kind *kind = add(&m, 2, k == 0 ? 1 : 4, 0.0);
    struct model_error error;
    m.crossing.rule = k == 1 ? CROSSING_SEQUENTIAL : CROSSING_EVENT_DRIVEN;
    m.crossing.forbidden = k != 2;
    kind->bond_length = k == 3 ? 2.5 : 0.5;
    kind->bending = k == 0 ? 0.0 : 5.0;
    kind->frozen = k == 4;
    m.bead.drive.force.x = k == 4 ? 1.0 : 0.0;
    static const char *const paths[] = {"fibers.0.vertices", "crossing.rule", "crossing.forbidden",
                                        "fibers.0.bond_length", "fibers.0.frozen"};
    const bool ok = model_finish(&m, &error);
    assert_int_equal(ok, k == 5);
    if (!ok)
      assert_string_equal(error.path, paths[k]);
    model_free(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(contacts_are_never_late),
      cmocka_unit_test(contacts_by_hand),
      cmocka_unit_test(contacts_keep_momentum_and_energy),
      cmocka_unit_test(contacts_keep_angular_momentum),
      cmocka_unit_test(what_is_pressed_goes_along),
      cmocka_unit_test(no_bond_enters_the_bead),
      cmocka_unit_test(a_static_wall_holds_the_bead),
      cmocka_unit_test(contacts_come_as_often_as_kinetic_theory_says),
      cmocka_unit_test(overlapping_starts_are_refused),
      cmocka_unit_test(lists_change_nothing),
      cmocka_unit_test(all_momentum_stays_zero),
      cmocka_unit_test(what_does_not_touch_it_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

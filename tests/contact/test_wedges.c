/* Contacts that come many at a time, under the rule `event-driven`: states by hand, wedges of folded chains. Nothing
 * crosses, nothing is stuck. Each drift is replayed (flight_replay.h). */
#include "contact/flight_replay.h"
#include "contact/folded.h"

/* --- states by hand ----------------------------------------------------------------------------------------------- */

/* A dumbbell: ends in a0 from the middle of the box, velocities in a0/t0. */
struct bond_by_hand {
  double mass;
  struct vec3 end[2], velocity[2];
};

typedef contact_force force_by_hand;

struct outcome {
  uint64_t contacts, rigid, touching, most, early;
  double energy[2];      /* before, after */
  struct vec3 momentum;  /* gained */
  struct vec3 after[16]; /* velocities */
};

static double kinetic(const struct test_run *r)
{
  double e = 0.0;
  for (uint32_t v = 0; v < r->state.vertices; v++)
    e += 0.5 * r->model.mass[v] * vec3_dot(r->state.velocity[v], r->state.velocity[v]);
  return e;
}

static struct vec3 momentum_of(const struct test_run *r)
{
  struct vec3 p = {0, 0, 0};
  for (uint32_t v = 0; v < r->state.vertices; v++)
    p = vec3_add_scaled(p, r->model.mass[v], r->state.velocity[v]);
  return p;
}

static struct vec3 no_force(const struct model *model, uint32_t vertex,
                            struct point (*place)(const void *context, uint32_t vertex), const void *context)
{
  (void)model, (void)vertex, (void)place, (void)context;
  return (struct vec3){0, 0, 0};
}

/* A drift of 2^-6 t0 of some dumbbells without springs, so that exchanges are plain reversals; then more drifts with
 * the velocities that they have. */
static struct outcome throw_bonds_with(force_by_hand *force, uint32_t n, const struct bond_by_hand *bond, int drifts)
{
  struct model m = test_model(8, 8, 8, 0, 0x1p-6, 2);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  for (uint32_t k = 0; k < n; k++)
    test_add_kind(&m, 1, 2)->mass = bond[k].mass;
  struct dice d = {1};
  struct test_run r = dice_run(m, &d);
  r.work.contact.force = force;
  for (uint32_t v = 0; v < 2 * n; v++) {
    r.state.position[v] =
        point_move((struct point){4 * LATTICE_CELL, 4 * LATTICE_CELL, 4 * LATTICE_CELL}, bond[v / 2].end[v % 2]);
    r.state.velocity[v] = bond[v / 2].velocity[v % 2];
  }
  struct outcome o = {.energy = {kinetic(&r)}};
  const struct vec3 before = momentum_of(&r);
  struct replay *p = replay_open(&r);
  for (int k = 0; k < drifts; k++)
    replay_drift(p, &r, 1.0, 100 + (uint64_t)k, 0, 0);
  o.contacts = p->contacts, o.touching = p->touching, o.most = p->most_of_vertex, o.early = p->early;
  o.rigid = r.state.counts.rigid;
  o.energy[1] = kinetic(&r);
  o.momentum = vec3_sub(momentum_of(&r), before);
  for (uint32_t v = 0; v < 2 * n && v < 16; v++)
    o.after[v] = r.state.velocity[v];
  replay_close(p);
  test_end(&r);
  return o;
}

static struct outcome throw_bonds(uint32_t n, const struct bond_by_hand *bond, int drifts)
{
  return throw_bonds_with(no_force, n, bond, drifts);
}

/* No crossing, energy and momentum kept. */
static void expect_sound(const char *name, const struct outcome *o)
{
  print_message("  %-40s %4lu contacts, %lu of a vertex, %lu rigid, %lu touch\n", name, (unsigned long)o->contacts,
                (unsigned long)o->most, (unsigned long)o->rigid, (unsigned long)o->touching);
  assert_true(o->touching == 0 && o->early == 0);
  assert_close(o->energy[1], o->energy[0], 1e-9 * o->energy[0]);
  assert_close(vec3_norm(o->momentum), 0.0, 1e-9);
}

/* Two rods broadside on: parallel, in one plane, without rotation. */
static void parallel_rods(void **unused)
{
  (void)unused;
  const struct bond_by_hand bond[2] = {{1, {{0, 0, 0}, {0.5, 0, 0}}, {{0, 1, 0}, {0, 1, 0}}},
                                       {1, {{0.125, 0.0078125, 0}, {0.625, 0.0078125, 0}}, {{0, -1, 0}, {0, -1, 0}}}};
  const struct outcome o = throw_bonds(2, bond, 3);
  expect_sound("parallel", &o);
  assert_true(o.contacts >= 1 && o.rigid == 0);
  assert_true(o.after[0].y < 0.0 && o.after[2].y > 0.0);
}

/* An end flies at the middle of a rod, all in one plane: the rod gives way in the plane. */
static void end_on_rod_in_a_plane(void **unused)
{
  (void)unused;
  const struct bond_by_hand bond[2] = {{1, {{0, 0, 0}, {0.5, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}},
                                       {1, {{0.25, 0.0078125, 0}, {0.25, 0.5, 0}}, {{0, -2, 0}, {0, -2, 0}}}};
  const struct outcome o = throw_bonds(2, bond, 3);
  expect_sound("end on rod, in a plane", &o);
  assert_true(o.contacts >= 1 && o.rigid == 0 && o.after[0].y < 0.0);
}

/* Two rods on one line, end to end. */
static void end_on_end_on_a_line(void **unused)
{
  (void)unused;
  const struct bond_by_hand bond[2] = {{1, {{0, 0, 0}, {0.5, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}},
                                       {1, {{0.5078125, 0, 0}, {1, 0, 0}}, {{-1, 0, 0}, {-1, 0, 0}}}};
  const struct outcome o = throw_bonds(2, bond, 3);
  expect_sound("end on end, on a line", &o);
  assert_true(o.contacts >= 1 && o.rigid == 0);
}

/* Three rods along x, y and z come to one point at one tick. */
static void three_at_one_tick(void **unused)
{
  (void)unused;
  const double a = 0.0078125;
  const struct bond_by_hand bond[3] = {{1, {{-0.25, 0, 0}, {0.25, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}},
                                       {1, {{0, -0.25, a}, {0, 0.25, a}}, {{0, 0, -1}, {0, 0, -1}}},
                                       {1, {{a, a, -0.25}, {a, a, 0.25}}, {{-1, -1, 0}, {-1, -1, 0}}}};
  const struct outcome o = throw_bonds(3, bond, 3);
  expect_sound("three at one tick", &o);
  assert_true(o.contacts >= 2);
}

/* Heavy rods close on a light one, which goes back and forth between them. */
static void caught_between_two(void **unused)
{
  (void)unused;
  for (int k = 0; k < 6; k++) {
    const double gap = ldexp(1.0, -6 - 3 * k), mass = k % 2 ? 1000.0 : 50.0;
    const struct bond_by_hand bond[3] = {
        {mass, {{-0.25, 0.01, 0}, {0.25, 0, 0}}, {{0, 0, 1}, {0, 0, 1}}},
        {1.25, {{0.01, -0.25, gap / 3}, {0, 0.25, gap / 3}}, {{0, 0, 0.25}, {0.125, 0, 0}}},
        {mass, {{-0.2, -0.2, gap}, {0.2, 0.2, gap}}, {{0, 0, -1}, {0, 0, -1}}}};
    const struct outcome o = throw_bonds(3, bond, 3);
    char name[64];
    snprintf(name, sizeof name, "caught, gap %g, mass %g", gap, mass);
    expect_sound(name, &o);
    assert_true(o.contacts >= 3);
  }
}

/* So light that it would touch them some thousand times: from a stated number on the three move rigidly to the end of
 * the drift. In the next drift they begin anew. */
static void caught_for_too_long(void **unused)
{
  (void)unused;
  const double gap = 0x1p-14;
  const struct bond_by_hand bond[3] = {{65536, {{-0.25, 0, 0}, {0.25, 0, 0}}, {{0, 0, 0.05}, {0, 0, 0.05}}},
                                       {0x1p-6, {{0, -0.25, gap / 3}, {0, 0.25, gap / 3}}, {{0, 0, 0}, {0, 0, 0}}},
                                       {65536, {{-0.2, -0.2, gap}, {0.2, 0.2, gap}}, {{0, 0, -0.05}, {0, 0, -0.05}}}};
  const struct outcome o = throw_bonds(3, bond, 8);
  expect_sound("caught for too long", &o);
  assert_true(o.rigid >= 1 && o.most <= 1001);
}

/* Two such clusters fly at each other, and touch in the same drift: then both move as one. */
static void clusters_meet(void **unused)
{
  (void)unused;
  const double gap = 0x1p-14;
  struct bond_by_hand bond[6];
  for (int k = 0; k < 2; k++) {
    const double z = k ? 0.01 : 0.0, up = k ? -1.0 : 1.0, x = k ? 0.05 : 0.0, y = k ? 0.03 : 0.0;
    const struct vec3 low = {0, 0, up + 0.05}, middle = {0, 0, up}, high = {0, 0, up - 0.05};
    bond[3 * k] = (struct bond_by_hand){65536, {{x - 0.25, y, z}, {x + 0.25, y, z}}, {low, low}};
    bond[3 * k + 1] =
        (struct bond_by_hand){0x1p-6, {{x, y - 0.25, z + gap / 3}, {x, y + 0.25, z + gap / 3}}, {middle, middle}};
    bond[3 * k + 2] =
        (struct bond_by_hand){65536, {{x - 0.2, y - 0.2, z + gap}, {x + 0.2, y + 0.2, z + gap}}, {high, high}};
  }
  const struct outcome o = throw_bonds(6, bond, 1);
  expect_sound("clusters meet", &o);
  assert_true(o.rigid >= 3 && o.most <= 1001); /* a contact makes each cluster, another joins them */
}

/* The same between rods that meet at an angle of 2^-k: a wedge. */
static void caught_in_a_wedge(void **unused)
{
  (void)unused;
  for (int k = 1; k < 12; k++) {
    const double open = ldexp(0.5, -k);
    const struct bond_by_hand bond[3] = {{50, {{0, 0, 0}, {0.5, 0, open}}, {{0, 0, 0}, {0, 0, 0}}},
                                         {1.25, {{0.3, -0.3, 0}, {0.3, 0.3, 0}}, {{-20, 0, 0.5}, {-20, 0, 0.5}}},
                                         {50, {{0, 0.001, 0}, {0.5, 0.001, -open}}, {{0, 0, 0}, {0, 0, 0}}}};
    const struct outcome o = throw_bonds(3, bond, 4);
    char name[64];
    snprintf(name, sizeof name, "wedge of %g", 2 * open / 0.5);
    expect_sound(name, &o);
    assert_true(o.contacts >= 1);
  }
}

/* Rods that touch exactly at a tick, at the beginning, at the middle, and at the last tick of a drift. */
static void touch_at_a_tick(void **unused)
{
  (void)unused;
  for (int k = 0; k < 4; k++) {
    const double gap = ldexp((const double[]){0x1p-16, 0.25, 1.0, 1.0 - 0x1p-16}[k], -6);
    const struct bond_by_hand bond[2] = {{1, {{-0.25, 0, 0}, {0.25, 0, 0}}, {{0, 0, 0.5}, {0, 0, 0.5}}},
                                         {1, {{0, -0.25, gap}, {0, 0.25, gap}}, {{0, 0, -0.5}, {0, 0, -0.5}}}};
    const struct outcome o = throw_bonds(2, bond, 3);
    expect_sound("exact touch at a tick", &o);
    assert_true(o.contacts == 1 && o.rigid == 0);
    assert_close(o.after[0].z, -0.5, 1e-12);
  }
}

/* Rods that touch at the start, as no drift leaves them: two fibers laid through one point. They are not stuck. */
static void touching_at_the_start(void **unused)
{
  (void)unused;
  for (int way = -1; way <= 1; way += 2) {
    const struct bond_by_hand bond[2] = {{1, {{-0.25, 0, 0}, {0.25, 0, 0}}, {{0, 0, way}, {0, 0, way}}},
                                         {1, {{0, -0.25, 0}, {0, 0.25, 0}}, {{0, 0, -way}, {0, 0, -way}}}};
    const struct outcome o = throw_bonds(2, bond, 4);
    print_message("  touching at the start: %lu contacts, %lu rigid, touching in %lu drifts\n",
                  (unsigned long)o.contacts, (unsigned long)o.rigid, (unsigned long)o.touching);
    assert_true(o.touching <= 1);
  }
}

/* Rods at relative rest, some lattice units apart, in a common flight: no contact. And with a last bit of approach. */
static void relative_rest(void **unused)
{
  (void)unused;
  for (int k = 0; k < 3; k++) {
    const double creep = k * 0x1p-18; /* a tick's motion is k lattice units */
    const struct bond_by_hand bond[2] = {
        {1, {{-0.25, 0, 0}, {0.25, 0, 0}}, {{0, 0, 0.5}, {0, 0, 0.5}}},
        {1, {{0, -0.25, 0x1p-38}, {0, 0.25, 0x1p-38}}, {{0, 0, 0.5 - creep}, {0, 0, 0.5 - creep}}}};
    const struct outcome o = throw_bonds(2, bond, 3);
    expect_sound("relative rest", &o);
    assert_true(o.rigid == 0 && (k == 0) == (o.contacts == 0));
  }
}

/* S, hit from behind in the middle of a drift, is twice as fast from there on: what is left of its way is as long as
 * the whole way seemed to be, and it ends further from where it began. There lies C, which was beyond its reach. */
static void hit_from_behind(void **unused)
{
  (void)unused;
  for (int k = 0; k < 4; k++) {
    const double far = 0.34 + 0.03 * k;
    const struct bond_by_hand bond[3] = {
        {50000, {{0.05, -0.25, -0.078125}, {0.05, 0.25, -0.078125}}, {{0, 0, 30}, {0, 0, 30}}},
        {1, {{-0.25, 0, 0}, {0.25, 0, 0}}, {{0, 0, 20}, {0, 0, 20}}},
        {1, {{0.01, -0.25, far}, {0.01, 0.25, far}}, {{0, 0, 0}, {0, 0, 0}}}};
    const struct outcome o = throw_bonds(3, bond, 1);
    expect_sound("hit from behind", &o);
    assert_true(o.contacts >= 2 && o.after[4].z > 1.0);
  }
}

/* Two rods come near in one drift, each within the skin of its reference position; those positions are too far apart
 * for the pair list. In the next drift the first one would go back, but bounces off a heavy rod behind it: it goes no
 * further than it would have gone, but out of its skin, and to the other rod. */
static void thrown_out_of_the_skin(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0x1p-6, 2);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  for (int k = 0; k < 3; k++)
    test_add_kind(&m, 1, 2)->mass = k == 1 ? 50000 : 1;
  struct dice d = {1};
  struct test_run r = dice_run(m, &d);
  r.work.contact.force = no_force;
  /* rod, heavy rod, other rod: their places along x, and how far they go in the first and in the second drift */
  const double place[3] = {0.0, -0.01, 0.36}, first[3] = {0.16, 0.16, -0.16}, second[3] = {-0.1, 0.0, 0.0};
  for (uint32_t v = 0; v < 6; v++) {
    const double half = v % 2 ? 0.25 : -0.25;
    const struct vec3 end = {place[v / 2], v / 2 == 0 ? 0.0 : half, v / 2 == 0 ? half : 0.0};
    r.state.position[v] = point_move((struct point){4 * LATTICE_CELL, 4 * LATTICE_CELL, 4 * LATTICE_CELL}, end);
  }
  struct replay *p = replay_open(&r);
  for (int drift = 0; drift < 2; drift++) {
    for (uint32_t v = 0; v < 6; v++)
      r.state.velocity[v] = (struct vec3){(drift ? second : first)[v / 2] * 0x1p6, 0, 0};
    replay_drift(p, &r, 1.0, 100 + (uint64_t)drift, 0, 0);
  }
  assert_true(p->touching == 0 && p->contacts == 2);
  assert_true(r.state.velocity[4].x > 1.0); /* the other rod was hit */
  replay_close(p);
  test_end(&r);
}

/* On the first bond, away from the other. */
static struct vec3 lift(const struct model *model, uint32_t vertex,
                        struct point (*place)(const void *context, uint32_t vertex), const void *context)
{
  (void)model, (void)place, (void)context;
  return (struct vec3){0, 0, vertex < 2 ? 100.0 : 0.0};
}

/* A rod that slides along itself at a speed of 1 and turns: its height above another one is a parabola, of second
 * derivative -8, until they touch at t = 0.6 dt; and after every bounce they touch again in the same drift. The forces
 * ask for rebounds slower than the approach. If every rebound is, the bounces come ever faster and end in a rigid
 * cluster. */
static void bounces_do_not_collapse(void **unused)
{
  (void)unused;
  const double t = 0.6 * 0x1p-6, top = 0.3 * t; /* times of the contact, and of the top of the parabola */
  const double start = 4.0 * ((t - top) * (t - top) - top * top), rise = 8.0 * top - 4.0 * t;
  const struct bond_by_hand bond[2] = {{1, {{-0.25, 0, start}, {0.25, 0, start}}, {{1, 0, rise - 1}, {1, 0, rise + 1}}},
                                       {1000, {{t, -0.25, 0}, {t, 0.25, 0}}, {{0, 0, 0}, {0, 0, 0}}}};
  const struct outcome o = throw_bonds_with(lift, 2, bond, 1);
  print_message("  %-40s %4lu contacts, %lu rigid, %lu touch\n", "turning rod", (unsigned long)o.contacts,
                (unsigned long)o.rigid, (unsigned long)o.touching);
  assert_true(o.touching == 0 && o.contacts > 0 && o.rigid == 0);
}

/* Chains without bending stiffness, for a while. */
static void folded_chains(void **unused)
{
  (void)unused;
  for (int k = 0; k < FOLDED; k++) {
    const struct folded_tally t = fold(&folded[k], dice_seed(1951), 100);
    tell_folded(folded[k].name, &t);
    assert_true(t.contacts > 0);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parallel_rods),        cmocka_unit_test(end_on_rod_in_a_plane),
      cmocka_unit_test(end_on_end_on_a_line), cmocka_unit_test(three_at_one_tick),
      cmocka_unit_test(caught_between_two),   cmocka_unit_test(caught_for_too_long),
      cmocka_unit_test(clusters_meet),        cmocka_unit_test(caught_in_a_wedge),
      cmocka_unit_test(touch_at_a_tick),      cmocka_unit_test(touching_at_the_start),
      cmocka_unit_test(relative_rest),        cmocka_unit_test(bounces_do_not_collapse),
      cmocka_unit_test(hit_from_behind),      cmocka_unit_test(thrown_out_of_the_skin),
      cmocka_unit_test(folded_chains),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* What must not matter, over whole steps of random small suspensions: where the box is, who moves with it, which way it
 * is turned, in what order particles lie in memory, in which direction time runs, from which end fibers are counted. A
 * failing scene names its seed. */
#include "contact/contact.h"
#include "exact.h"
#include "fiber/force.h"
#include "mpc/grid.h"

/* --- random suspensions ------------------------------------------------------------------------------------------- */

static void add_random_kind(struct model *m, struct dice *d)
{
  struct fiber_kind *k = test_add_kind(m, (uint32_t)dice_integer(d, 1, 8), (uint32_t)dice_integer(d, 1, 9));
  k->ring = k->vertices > 2 && dice_u64(d) % 3 == 0;
  k->start = k->ring ? START_CIRCLE : START_EQUILIBRIUM;
  k->mass = (double)dice_integer(d, 1, 40) / 4.0;
  k->bond_length = dice_u64(d) % 4 ? dice_between(d, 0.2, 0.5) : 0.0;
  k->spring = dice_between(d, 100.0, 300.0);
  k->bending = k->bond_length > 0.0 ? dice_between(d, 0.0, 10.0) : 0.0;
  k->force = dice_vector(d, 0.5);
}

static struct model random_model(struct dice *d, bool solvent, bool forbidden)
{
  int edge[3];
  for (int c = 0; c < 3; c++)
    edge[c] = (int)dice_integer(d, 3, 6);
  struct model m = test_model(edge[0], edge[1], edge[2], solvent ? dice_between(d, 0.5, 8.0) : 0.0,
                              dice_between(d, 0.002, 0.01), (uint32_t)dice_integer(d, 1, 4));
  m.seed = dice_u64(d);
  m.scheme = (enum scheme)dice_integer(d, 0, 2);
  m.crossing.forbidden = forbidden;
  m.crossing.exclusion = (enum exclusion)dice_integer(d, 0, 1);
  m.solvent.thermostat = (enum thermostat_kind)dice_integer(d, 0, 2);
  m.solvent.hydrodynamics = dice_u64(d) & 1;
  m.solvent.acceleration = dice_vector(d, 0.1);
  const int64_t kinds = dice_integer(d, 1, 3);
  for (int64_t k = 0; k < kinds; k++)
    add_random_kind(&m, d);
  return m;
}

/* The same suspension twice, and the dice that go on from there. */
struct twins {
  struct test_run one, other;
  struct dice dice;
  uint64_t seed;
};

static struct twins make_twins(uint64_t seed, bool solvent, bool forbidden)
{
  struct dice d = {seed}, again = {seed};
  struct twins t = {.one = test_start(random_model(&d, solvent, forbidden)), .seed = seed};
  t.other = test_start(random_model(&again, solvent, forbidden));
  t.dice = d;
  return t;
}

static void end_twins(struct twins *t)
{
  test_end(&t->one);
  test_end(&t->other);
}

typedef struct point point_map(const void *context, uint32_t vertex, struct point p);

/* Largest distance of a coordinate of the other's vertices from where the map puts the one's, in lattice units. */
static int64_t off_by(const struct twins *t, point_map *map, const void *context)
{
  int64_t most = 0;
  for (uint32_t v = 0; v < t->one.state.vertices; v++) {
    const struct point p = map(context, v, t->one.state.position[v]), q = t->other.state.position[v];
    const int64_t off[3] = {llabs(p.x - q.x), llabs(p.y - q.y), llabs(p.z - q.z)};
    for (int c = 0; c < 3; c++)
      most = off[c] > most ? off[c] : most;
  }
  return most;
}

static void assert_off_by(const struct twins *t, point_map *map, const void *context, int64_t limit, const char *what)
{
  const int64_t off = off_by(t, map, context);
  if (off > limit)
    fail_msg("seed %lu: %s: a vertex is %ld units off after %lu steps", (unsigned long)t->seed, what, (long)off,
             (unsigned long)t->one.state.step);
}

enum { SCENES = 80 };

/* --- places ------------------------------------------------------------------------------------------------------- */

static struct point moved(const void *context, uint32_t vertex, struct point p)
{
  const struct point *by = (const struct point *)context + vertex;
  return (struct point){p.x + by->x, p.y + by->y, p.z + by->z};
}

static void move_other(struct twins *t, const struct point *by)
{
  for (uint32_t v = 0; v < t->other.state.vertices; v++)
    t->other.state.position[v] = moved(by, v, t->other.state.position[v]);
}

/* With the solvent, each fiber may stand in an image of its own: the same bits but for that. Without, everything may be
 * displaced by any lattice vector. */
static void places_do_not_matter(void **unused)
{
  (void)unused;
  uint64_t executed = 0;
  for (uint64_t k = 0; k < SCENES; k++) {
    const bool solvent = k & 1;
    struct twins t = make_twins(dice_seed(1701) + k, solvent, true);
    struct point *by = malloc((t.one.state.vertices + 1) * sizeof *by);
    const int64_t *edge = t.one.model.box.edge;
    const struct point far = dice_point(&t.dice, (int64_t)1 << 50, (int64_t)1 << 50, (int64_t)1 << 50);
    for (uint32_t f = 0; f < t.one.model.fibers; f++) {
      const struct point image = dice_point(&t.dice, 3, 3, 3);
      const struct point whole = {image.x * edge[0], image.y * edge[1], image.z * edge[2]};
      for (uint32_t v = t.one.model.fiber_first[f]; v < t.one.model.fiber_first[f + 1]; v++)
        by[v] = solvent ? whole : far;
    }
    move_other(&t, by);
    test_steps(&t.one, 120);
    test_steps(&t.other, 120);
    assert_off_by(&t, moved, by, 0, "displaced");
    assert_memory_equal(&t.one.state.counts, &t.other.state.counts, sizeof t.one.state.counts);
    assert_memory_equal(t.one.state.velocity, t.other.state.velocity,
                        t.one.state.vertices * sizeof *t.one.state.velocity);
    executed += t.one.state.counts.executed;
    free(by);
    end_twins(&t);
  }
  print_message("  %lu crossings prevented\n", (unsigned long)executed);
  assert_true(executed > 20);
}

/* A grid that is shifted the other way puts displaced particles into the same cells. */
static void cells_move_with_the_grid(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < SCENES; k++) {
    struct dice d = {dice_seed(1702) + k};
    const struct box box = box_of_cells((int)dice_integer(&d, 1, 9), (int)dice_integer(&d, 1, 9), 3);
    for (int n = 0; n < 1000; n++) {
      const struct point p = dice_point(&d, 9 * LATTICE_CELL, 9 * LATTICE_CELL, 9 * LATTICE_CELL);
      const struct point shift = {dice_integer(&d, 0, LATTICE_CELL - 1), dice_integer(&d, 0, LATTICE_CELL - 1), 0};
      const struct point left = {dice_integer(&d, 0, shift.x), dice_integer(&d, 0, shift.y), 0};
      const struct point q = {p.x + shift.x - left.x, p.y + shift.y - left.y, p.z};
      assert_true(grid_cell_of(&box, p, shift) == grid_cell_of(&box, q, left));
    }
  }
}

/* --- memory ------------------------------------------------------------------------------------------------------- */

static void order_in_memory_does_not_matter(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < SCENES; k++) {
    struct twins t = make_twins(dice_seed(1703) + k, true, true);
    for (int part = 0; part < 4; part++) {
      shuffle_memory(&t.other.state, &t.dice);
      test_steps(&t.one, 30);
      test_steps(&t.other, 30);
      if (state_hash(&t.one.state) != state_hash(&t.other.state))
        fail_msg("seed %lu: the order in memory matters", (unsigned long)t.seed);
    }
    end_twins(&t);
  }
}

/* --- frames ------------------------------------------------------------------------------------------------------- */

static void boost(struct test_run *r, struct vec3 u)
{
  for (uint32_t i = 0; i < r->state.solvent.n; i++)
    set_solvent_v(&r->state, i, vec3_add(solvent_v(&r->state, i), u));
  for (uint32_t v = 0; v < r->state.vertices; v++)
    r->state.velocity[v] = vec3_add(r->state.velocity[v], u);
}

static struct point carried(const void *context, uint32_t vertex, struct point p)
{
  (void)vertex;
  return point_move(p, *(const struct vec3 *)context);
}

/* Phantoms alone, in a frame that moves at u: shifted by u t, to the rounding of each step. */
static void phantoms_in_a_moving_frame(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < SCENES; k++) {
    struct twins t = make_twins(dice_seed(1704) + k, false, false);
    const struct vec3 u = dice_vector(&t.dice, 2.0);
    boost(&t.other, u);
    test_steps(&t.one, 100);
    test_steps(&t.other, 100);
    const struct vec3 way = vec3_scale(100 * t.one.model.time_step, u);
    assert_off_by(&t, carried, &way, 20000, "boosted"); /* 2e-8 a0: a unit per step, stretched by stiff bonds */
    end_twins(&t);
  }
}

/* With the solvent the frame must move by whole boxes from one collision to the next, since the grid stands still. */
static void suspensions_in_a_frame_of_whole_boxes(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < SCENES; k++) {
    struct dice d = {dice_seed(1705) + k}, again = d;
    struct twins t = {.seed = d.state};
    for (int i = 0; i < 2; i++) {
      struct model m = random_model(i ? &again : &d, true, false);
      m.box = box_of_cells(4, 4, 4);
      test_particles(&m, 64 * 3);
      m.time_step = 0x1p-8;
      m.solvent.collision_interval = 0x1p-6;
      m.scheme = k & 1 ? SCHEME_PAPER : SCHEME_KICK_SPLIT;
      *(i ? &t.other : &t.one) = test_start(m);
    }
    const struct vec3 u = {256.0, k % 3 ? 0.0 : -256.0, 0.0}; /* 1 a0 per step, a box per collision */
    boost(&t.other, u);
    test_steps(&t.one, 24);
    test_steps(&t.other, 24);
    const struct vec3 way = vec3_scale(24 * 0x1p-8, u);
    assert_off_by(&t, carried, &way, 20000, "boosted");
    end_twins(&t);
  }
}

/* With crossings the frame does matter, since vertices move one at a time and a carried one meets those that have not
 * moved yet. Until a hit is found in either frame, it does not. */
static void crossings_lag_in_a_moving_frame(void **unused)
{
  (void)unused;
  uint64_t steps = 0, hits[2] = {0};
  for (uint64_t k = 0; k < SCENES; k++) {
    struct twins t = make_twins(dice_seed(1706) + k, false, true);
    const struct vec3 u = dice_rod(&t.dice, 3.0, 6.0);
    boost(&t.other, u);
    for (int n = 1; n <= 60 && t.one.state.counts.possible + t.other.state.counts.possible == 0; n++) {
      test_steps(&t.one, 1);
      test_steps(&t.other, 1);
      if (t.one.state.counts.possible + t.other.state.counts.possible == 0) {
        const struct vec3 way = vec3_scale(n * t.one.model.time_step, u);
        assert_off_by(&t, carried, &way, 20000, "boosted");
        steps++;
      }
    }
    hits[0] += t.one.state.counts.possible;
    hits[1] += t.other.state.counts.possible;
    end_twins(&t);
  }
  print_message("  %lu steps alike; first hits at rest %lu, in a frame at 3 to 6 a0/t0 %lu\n", (unsigned long)steps,
                (unsigned long)hits[0], (unsigned long)hits[1]);
  assert_true(steps > 100 && hits[1] > hits[0]);
}

/* --- time --------------------------------------------------------------------------------------------------------- */

/* The leap-frog runs backwards through the places it came from: x(n+1) - v(n+1/2) dt is rounded as x(n) + v(n+1/2) dt
 * was. The kicks leave an ulp in the velocities, which now and then tips a rounding: a unit, no more. */
static void time_runs_backwards(void **unused)
{
  (void)unused;
  uint64_t exact = 0, all = 0;
  for (uint64_t k = 0; k < SCENES; k++) {
    struct twins t = make_twins(dice_seed(1707) + k, false, false);
    struct test_run *r = &t.other;
    test_steps(r, 40);
    assert_true(fiber_forces(&r->state, &r->model, r->work.fiber.force, r->state.step, &r->work.fault));
    fiber_kick(&r->state, &r->model, r->work.fiber.force, -1.0);
    for (uint32_t v = 0; v < r->state.vertices; v++)
      r->state.velocity[v] = vec3_scale(-1.0, r->state.velocity[v]);
    test_steps(r, 40);
    const struct vec3 none = {0, 0, 0};
    assert_off_by(&t, carried, &none, 1000, "mirrored in time");
    for (uint32_t v = 0; v < r->state.vertices; v++, all++)
      exact += memcmp(&r->state.position[v], &t.one.state.position[v], sizeof r->state.position[v]) == 0;
    end_twins(&t);
  }
  print_message("  %lu of %lu vertices return exactly\n", (unsigned long)exact, (unsigned long)all);
  assert_true((double)exact > 0.9 * (double)all);
}

/* --- directions --------------------------------------------------------------------------------------------------- */

static struct point mirrored(const void *context, uint32_t vertex, struct point p)
{
  (void)context;
  (void)vertex;
  return (struct point){-p.x, p.y, p.z};
}

static struct point turned(const void *context, uint32_t vertex, struct point p)
{
  (void)context;
  (void)vertex;
  return (struct point){-p.y, p.x, p.z};
}

static struct vec3 mirrored_vector(struct vec3 v)
{
  return (struct vec3){-v.x, v.y, v.z};
}

static struct vec3 turned_vector(struct vec3 v)
{
  return (struct vec3){-v.y, v.x, v.z};
}

static void map_other(struct twins *t, point_map *map, struct vec3 (*map_vector)(struct vec3))
{
  for (uint32_t v = 0; v < t->other.state.vertices; v++) {
    t->other.state.position[v] = map(NULL, v, t->one.state.position[v]);
    t->other.state.velocity[v] = map_vector(t->one.state.velocity[v]);
  }
  for (uint32_t k = 0; k < t->other.model.kinds; k++)
    t->other.model.kind[k].force = map_vector(t->one.model.kind[k].force);
}

/* Seen in a mirror every sum has the same terms but for their signs: the same bits. */
static void mirrors_show_the_same_bits(void **unused)
{
  (void)unused;
  uint64_t executed = 0;
  for (uint64_t k = 0; k < SCENES; k++) {
    struct twins t = make_twins(dice_seed(1708) + k, false, true);
    map_other(&t, mirrored, mirrored_vector);
    test_steps(&t.one, 200);
    test_steps(&t.other, 200);
    assert_off_by(&t, mirrored, NULL, 0, "mirrored");
    assert_memory_equal(&t.one.state.counts, &t.other.state.counts, sizeof t.one.state.counts);
    executed += t.one.state.counts.executed;
    end_twins(&t);
  }
  print_message("  %lu crossings prevented\n", (unsigned long)executed);
  assert_true(executed > 20);
}

/* Turned by 90 degrees the terms of a sum come in another order: the same to rounding. The box is turned too. */
static void turned_suspensions(void **unused)
{
  (void)unused;
  uint64_t executed = 0;
  for (uint64_t k = 0; k < SCENES; k++) {
    struct twins t = make_twins(dice_seed(1709) + k, false, true);
    const int *l = t.one.model.box.cells;
    t.other.model.box = box_of_cells(l[1], l[0], l[2]);
    map_other(&t, turned, turned_vector);
    test_steps(&t.one, 60);
    test_steps(&t.other, 60);
    assert_off_by(&t, turned, NULL, 1000000, "turned"); /* 1e-6 a0 */
    assert_memory_equal(&t.one.state.counts, &t.other.state.counts, sizeof t.one.state.counts);
    executed += t.one.state.counts.executed;
    end_twins(&t);
  }
  print_message("  %lu crossings prevented\n", (unsigned long)executed);
  assert_true(executed > 20);
}

/* --- the other end ------------------------------------------------------------------------------------------------ */

static void keep_first(void *context, const struct contact_event *event)
{
  struct contact_event *first = context;
  if (event->executed && first->hit.time < 0.0)
    *first = *event;
}

/* The vertex that stands where v stands if its fiber is counted from the other end. */
static uint32_t from_the_end(const struct model *m, uint32_t v)
{
  const uint32_t f = m->fiber_of[v];
  return m->fiber_first[f] + m->fiber_first[f + 1] - 1 - v;
}

/* All fibers counted from their other end. One vertex moves, so that the order of the sweep is none: it meets the same
 * bond, s' is counted from the other end, and the exchange is the same. */
static void counted_from_the_other_end(void **unused)
{
  (void)unused;
  uint64_t hits = 0;
  for (uint64_t k = 0; k < 100 * SCENES; k++) {
    struct twins t = make_twins(dice_seed(1710) + k, false, true);
    const struct model *m = &t.one.model;
    const uint32_t moving = (uint32_t)dice_integer(&t.dice, 0, t.one.state.vertices - 1);
    memset(t.one.state.velocity, 0, t.one.state.vertices * sizeof *t.one.state.velocity);
    t.one.state.velocity[moving] = vec3_scale(1.0 / m->time_step, dice_rod(&t.dice, 0.1, 1.2));
    for (uint32_t v = 0; v < t.one.state.vertices; v++) {
      t.other.state.position[from_the_end(m, v)] = t.one.state.position[v];
      t.other.state.velocity[from_the_end(m, v)] = t.one.state.velocity[v];
    }
    struct contact_event first = {.hit = {.time = -1.0}}, second = first;
    const struct contact_log log = {keep_first, &first}, log2 = {keep_first, &second};
    assert_true(contact_drift(&t.one.state, m, &t.one.work.contact, 1.0, 1, 0, &log, &t.one.work.fault));
    assert_true(
        contact_drift(&t.other.state, &t.other.model, &t.other.work.contact, 1.0, 1, 0, &log2, &t.other.work.fault));
    if ((first.hit.time < 0.0) != (second.hit.time < 0.0))
      fail_msg("seed %lu: hit %g from one end, %g from the other", (unsigned long)t.seed, first.hit.time,
               second.hit.time);
    if (first.hit.time >= 0.0) {
      hits++;
      assert_int_equal(second.vertex, from_the_end(m, first.vertex));
      assert_int_equal(second.standing_bond, from_the_end(m, (uint32_t)m->next[first.standing_bond]));
      assert_close(second.hit.time, first.hit.time, 1e-9);
      assert_close(second.hit.s, first.hit.s, 1e-9);
      assert_close(second.hit.s_standing, 1.0 - first.hit.s_standing, 1e-9);
      assert_close(second.impulse, first.impulse, 1e-9 * (1.0 + fabs(first.impulse)));
    }
    end_twins(&t);
  }
  print_message("  %lu hits\n", (unsigned long)hits);
  assert_true(hits > 50);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(places_do_not_matter),
      cmocka_unit_test(cells_move_with_the_grid),
      cmocka_unit_test(order_in_memory_does_not_matter),
      cmocka_unit_test(phantoms_in_a_moving_frame),
      cmocka_unit_test(suspensions_in_a_frame_of_whole_boxes),
      cmocka_unit_test(crossings_lag_in_a_moving_frame),
      cmocka_unit_test(time_runs_backwards),
      cmocka_unit_test(mirrors_show_the_same_bits),
      cmocka_unit_test(turned_suspensions),
      cmocka_unit_test(counted_from_the_other_end),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

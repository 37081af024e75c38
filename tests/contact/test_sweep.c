/* Whole sweeps against a sweep by brute force (reference.h): every vertex against every bond in every image, exact
 * decisions (GMP), the exchange in long double. And what all sweeps together must keep: the linking of rings. */
#include "contact/capsule.h"
#include "contact/neighbors.h"
#include "contact/reference.h"
#include "contact/rings.h"

static void dense_suspensions(void **unused)
{
  (void)unused;
  struct reference total = {.seed = 0};
  for (uint64_t k = 0; k < 12; k++) {
    const uint64_t seed = dice_seed(1101) + k;
    struct dice d = {seed};
    struct test_run r = dense(5, 4, 4, 40, 8, 0.54, &d);
    compare_sweeps(&r, &d, 8, k % 2 ? 0.02 : 0.1, seed, &total);
    test_end(&r);
  }
  report(&total);
  assert_true(total.counts.executed > 1000 && total.counts.possible > total.counts.executed + 100);
  assert_true(total.counts.negative > 50 && total.second_bond > 400 && total.image_hits > 100);
}

/* The same with the rule that a refused vertex finishes its step with its new velocity, if that crosses nothing. */
static void bouncing_suspensions(void **unused)
{
  (void)unused;
  struct reference total = {.seed = 0};
  for (uint64_t k = 0; k < 12; k++) {
    const uint64_t seed = dice_seed(1106) + k;
    struct dice d = {seed};
    struct test_run r = dense(5, 4, 4, 40, 8, 0.54, &d);
    r.model.crossing.rejection = REJECTION_BOUNCE;
    compare_sweeps(&r, &d, 8, k % 2 ? 0.02 : 0.1, seed, &total);
    test_end(&r);
  }
  report(&total);
  print_message("  %lu bounces stopped by another bond\n", (unsigned long)total.stopped);
  assert_true(total.counts.executed > 1000);
  assert_true(4 * total.stopped > total.counts.executed && 4 * total.stopped < 3 * total.counts.executed);
}

/* In the frame of a flow, slow or several times round the box, a sweep is the one of resting surroundings, and a
 * translation of everything: flow and time step are such that sums and products are exact, so the two agree to the bit.
 */
static void sweeps_in_a_moving_frame(void **unused)
{
  (void)unused;
  uint64_t executed = 0;
  for (uint64_t k = 0; k < 8; k++) {
    struct dice d[2] = {{dice_seed(1107) + k}, {dice_seed(1107) + k}};
    struct test_run r[2] = {dense(5, 4, 4, 40, 8, 0.54, &d[0]), dense(5, 4, 4, 40, 8, 0.54, &d[1])};
    const struct vec3 flow = vec3_scale(k < 4 ? 1.0 : 64.0, (struct vec3){3.0, -0.5, 0.25});
    for (int n = 0; n < 2; n++) {
      r[n].model.time_step = 0x1p-7;
      r[n].model.crossing.rejection = k % 2 ? REJECTION_BOUNCE : REJECTION_STAY;
    }
    r[1].model.crossing.frame = FRAME_FLOW;
    r[1].model.flow = flow;
    for (uint64_t step = 1; step <= 12; step++) {
      for (uint32_t v = 0; v < r[0].state.vertices; v++) {
        const struct point thrown = dice_point(&d[0], 8000000, 8000000, 8000000); /* multiples of 2^-20 a0/t0 */
        const struct vec3 w = {ldexp((double)thrown.x, -20), ldexp((double)thrown.y, -20),
                               ldexp((double)thrown.z, -20)};
        r[0].state.velocity[v] = w;
        r[1].state.velocity[v] = vec3_add(w, flow);
      }
      for (int n = 0; n < 2; n++)
        assert_true(contact_drift(&r[n].state, &r[n].model, &r[n].work.contact, 1.0, step, 0, NULL, &r[n].work.fault));
      const struct vec3 shift = vec3_scale((double)step * 0x1p-7, flow);
      for (uint32_t v = 0; v < r[0].state.vertices; v++) {
        const struct vec3 far = vec3_sub(point_difference(r[1].state.position[v], r[0].state.position[v]), shift);
        /* velocities after an exchange are rounded differently: a lattice unit or so per exchange */
        assert_true(vec3_norm(far) < 1e-9);
      }
    }
    assert_true(r[0].state.counts.executed == r[1].state.counts.executed);
    executed += r[0].state.counts.executed;
    test_end(&r[0]);
    test_end(&r[1]);
  }
  assert_true(executed > 300);
}

/* Slow suspensions, where nearly all vertices move before their turn, with a few fast vertices: what these hit gets
 * fast in turn, and calls back others that thought they would meet nobody. */
static void calm_suspensions_with_fast_vertices(void **unused)
{
  (void)unused;
  struct reference total = {.seed = 0, .fast = 0.05};
  uint64_t waited = 0, called_back = 0;
  for (uint64_t k = 0; k < 60; k++) {
    const uint64_t seed = dice_seed(1104) + k;
    struct dice d = {seed};
    struct test_run r = dense(5, 4, 4, 40, 8, 0.54, &d);
    r.model.crossing.rejection = k % 2 ? REJECTION_BOUNCE : REJECTION_STAY;
    compare_sweeps(&r, &d, 10, 0.002, seed, &total);
    waited += r.work.contact.waited;
    called_back += r.work.contact.called_back;
    test_end(&r);
  }
  report(&total);
  print_message("  %lu waited for their turn, %lu of them called back\n", (unsigned long)waited,
                (unsigned long)called_back);
  assert_true(total.counts.executed > 1000 && called_back > 200 && 4 * waited < 3 * total.counts.moves);
}

/* What a pair has left of its limit is never more than the distance of the two bonds. */
static uint64_t check_limits(const struct test_run *r)
{
  const struct neighbors *nb = &r->work.contact.neighbors;
  const struct point *at = r->state.position;
  uint64_t waiting = 0;
  for (uint32_t n = 0; n < nb->pairs.count; n++) {
    const uint32_t i = nb->pairs.bond[n], l = nb->pairs.other[n];
    const int32_t left = (int32_t)(nb->pairs.limit[n] - nb->path[i] - nb->path[l]);
    if (left < 0)
      continue;
    const uint32_t j = (uint32_t)r->model.next[i], m = (uint32_t)r->model.next[l];
    const double distance =
        capsule_distance(point_difference(at[j], at[i]), point_difference(at[m], at[l]),
                         point_difference(point_image(at[l], nb->pairs.detail[n].image.k, &r->model.box), at[i]));
    if (distance < left * 0x1p-20)
      fail_msg("bonds %u and %u are %g a0 apart, and need not be looked at for %g a0", i, l, distance, left * 0x1p-20);
    waiting++;
  }
  return waiting;
}

/* Paths are counted modulo 2^32: these are about to begin anew, not all at once. */
static void make_paths_long(struct test_run *r)
{
  struct neighbors *nb = &r->work.contact.neighbors;
  assert_true(neighbors_build(&r->state, &r->model, &r->work.contact, &r->work.fault));
  for (uint32_t j = 0; j < r->state.vertices; j++)
    nb->path[j] = UINT32_MAX - 40000 * (j % 7);
  assert_true(neighbors_build(&r->state, &r->model, &r->work.contact, &r->work.fault));
}

/* Slow suspensions with a few fast vertices: exchanges make others fast in the middle of a sweep, and whole steps
 * alternate with halves. */
static void limits_of_pairs_hold(void **unused)
{
  (void)unused;
  uint64_t waiting = 0, listed = 0, executed = 0;
  for (uint64_t k = 0; k < 20; k++) {
    struct dice d = {dice_seed(1108) + k};
    struct test_run r = dense(5, 4, 4, 40, 8, 0.54, &d);
    r.model.crossing.rejection = k % 2 ? REJECTION_BOUNCE : REJECTION_STAY;
    if (k % 4 < 2)
      make_paths_long(&r);
    for (uint64_t step = 1; step <= 40; step++) {
      for (uint32_t v = 0; v < r.state.vertices; v++)
        r.state.velocity[v] = vec3_scale(dice_integer(&d, 0, 99) ? 0.5 : 20.0, dice_vector(&d, 1.0));
      assert_true(
          contact_drift(&r.state, &r.model, &r.work.contact, step % 2 ? 1.0 : 0.5, step, 0, NULL, &r.work.fault));
      waiting += check_limits(&r);
      listed += r.work.contact.neighbors.pairs.count;
    }
    executed += r.state.counts.executed;
    test_end(&r);
  }
  print_message("  %lu hits; %lu of %lu times, a pair was not due\n", (unsigned long)executed, (unsigned long)waiting,
                (unsigned long)listed);
  assert_true(executed > 200 && 2 * waiting > listed);
}

struct thrown_bond {
  double mass;
  struct vec3 end[2], velocity[2];
};

struct orders {
  uint64_t hits, called_back;
};

/* One step of some dumbbells in 400 orders of their turns. */
static struct orders all_orders(enum rejection refusal, uint32_t n, const struct thrown_bond *bond)
{
  struct model m = test_model(8, 8, 8, 0, 0.01, 2);
  m.crossing.rejection = refusal;
  for (uint32_t k = 0; k < n; k++)
    test_add_kind(&m, 1, 2)->mass = bond[k].mass;
  struct dice d = {dice_seed(1105)};
  struct test_run r = dice_run(m, &d);
  struct events *told = calloc(1, sizeof *told);
  struct reference ref = {.model = &r.model, .told = told, .seed = 1105};
  ref.position = malloc(2 * n * sizeof *ref.position);
  ref.velocity = malloc(2 * n * sizeof *ref.velocity);
  exact_open(&ref.exact);
  told->run = &r;
  const struct contact_log log = {collect, told};
  for (uint64_t step = 1; step <= 400; step++) {
    told->n = told->read = 0;
    for (uint32_t v = 0; v < 2 * n; v++) {
      r.state.position[v] = point_move((struct point){0, 0, 0}, bond[v / 2].end[v % 2]);
      r.state.velocity[v] = bond[v / 2].velocity[v % 2];
    }
    r.work.contact.neighbors.built = false; /* they were moved by hand */
    copy_state(&ref, &r.state);
    assert_true(contact_drift(&r.state, &r.model, &r.work.contact, 1.0, step, 0, &log, &r.work.fault));
    sweep_by_hand(&ref, r.model.time_step, step, 0);
    assert_int_equal(told->read, told->n);
    compare_states(&ref, &r.state);
  }
  const struct orders done = {ref.counts.executed, r.work.contact.called_back};
  exact_close(&ref.exact);
  free(ref.position);
  free(ref.velocity);
  free(told);
  test_end(&r);
  return done;
}

/* A heavy bond F hits a light one S, which then flies further than any list looked ahead, into C; and C has moved
 * before its turn, since it met nobody. Where its turn is after S's, it must be where it was. With the paper's rule F
 * hits S; with the other one S, falling slowly, may also hit F and bounce off into C. */
static void who_is_hit_hits_others(void **unused)
{
  (void)unused;
  struct thrown_bond bond[3] = {{50.0, {{3.6, 4, 3.9}, {4.5, 4, 3.9}}, {{0, 0, 30}, {0, 0, 30}}},
                                {1.25, {{4, 3.6, 4}, {4, 4.5, 4}}, {{0, 0, 0}, {0, 0, 0}}},
                                {5.0, {{3.5, 4.1, 4.5}, {4.6, 4.1, 4.5}}, {{0, 1, 0}, {0, 1, 0}}}};
  for (int rule = 0; rule < 2; rule++) {
    const struct orders fast = all_orders(rule ? REJECTION_BOUNCE : REJECTION_STAY, 3, bond);
    assert_true(fast.hits >= 400 && fast.called_back > 50);
  }
  for (int k = 0; k < 12; k++) { /* C falls on S, wherever that is by then */
    for (int end = 0; end < 2; end++) {
      bond[0].velocity[end] = (struct vec3){0, 0, 4};
      bond[1].end[end].z = 3.902, bond[1].velocity[end] = (struct vec3){0, 0, -0.5};
      bond[2].end[end].z = 3.925 + 0.005 * k, bond[2].velocity[end] = (struct vec3){0, 1, -0.5};
    }
    assert_true(all_orders(REJECTION_BOUNCE, 3, bond).hits >= 400);
  }
}

/* Dumbbells at rest in a flow, for one sweep, and then as thrown: in the frame of the flow. */
static void thrown_in_flow(struct test_run *r, uint32_t n, const struct thrown_bond *bond, uint64_t step)
{
  const struct vec3 flow = model_frame_velocity(&r->model);
  for (uint32_t v = 0; v < 2 * n; v++) {
    r->state.position[v] = point_move((struct point){0, 0, 0}, bond[v / 2].end[v % 2]);
    r->state.velocity[v] = flow;
  }
  r->work.contact.neighbors.built = false;
  assert_true(contact_drift(&r->state, &r->model, &r->work.contact, 1.0, step, 0, NULL, &r->work.fault));
  for (uint32_t v = 0; v < 2 * n; v++)
    r->state.velocity[v] = vec3_add(bond[v / 2].velocity[v % 2], flow);
  assert_true(contact_drift(&r->state, &r->model, &r->work.contact, 1.0, step, 1, NULL, &r->work.fault));
}

/* F hits S, which hits C, as above; in a flow that carries all of them to the other side of the box meanwhile, S has to
 * look around where it is. */
static void who_is_hit_in_a_flow_hits_others(void **unused)
{
  (void)unused;
  const struct thrown_bond bond[3] = {{50.0, {{3.6, 4, 3.9}, {4.5, 4, 3.9}}, {{0, 0, 30}, {0, 0, 30}}},
                                      {1.25, {{4, 3.6, 4}, {4, 4.5, 4}}, {{0, 0, 0}, {0, 0, 0}}},
                                      {5.0, {{3.5, 4.1, 4.5}, {4.6, 4.1, 4.5}}, {{0, 1, 0}, {0, 1, 0}}}};
  const struct vec3 flow = {384.0, -256.0, 128.0}, shift = vec3_scale(2.0 * 0x1p-6, flow);
  struct test_run r[2];
  for (int k = 0; k < 2; k++) {
    struct model m = test_model(8, 8, 8, 0, 0x1p-6, 2);
    for (uint32_t b = 0; b < 3; b++)
      test_add_kind(&m, 1, 2)->mass = bond[b].mass;
    m.crossing.frame = FRAME_FLOW;
    struct dice d = {dice_seed(1108)};
    r[k] = dice_run(m, &d);
    r[k].model.flow = vec3_scale(k, flow); /* faster than a scene may say */
  }
  for (uint64_t step = 1; step <= 100; step++) {
    for (int k = 0; k < 2; k++)
      thrown_in_flow(&r[k], 3, bond, step);
    for (uint32_t v = 0; v < 6; v++) {
      const struct vec3 moved = point_difference(r[1].state.position[v], r[0].state.position[v]);
      assert_true(vec3_norm(vec3_sub(moved, shift)) < 1e-9);
    }
  }
  assert_true(r[0].state.counts.executed > 100 && r[0].state.counts.executed == r[1].state.counts.executed);
  for (int k = 0; k < 2; k++)
    test_end(&r[k]);
}

/* S falls on F with one end, after the other end had its turn; it bounces further than it fell, into C, which lies
 * where nobody looked: nothing has changed for the end that had its turn, and C does not move. */
static void who_bounces_looks_around(void **unused)
{
  (void)unused;
  for (int k = 0; k < 12; k++) {
    const double above = 3.907 + 0.0005 * k;
    const struct thrown_bond bond[3] = {{50.0, {{3.6, 4, 3.9}, {4.5, 4, 3.9}}, {{0, 0, 4}, {0, 0, 4}}},
                                        {1.25, {{4, 3.6, 3.902}, {4, 4.5, 3.902}}, {{0, 0, -0.5}, {0, 0, 0}}},
                                        {5.0, {{3.5, 4.1, above}, {4.6, 4.1, above}}, {{0, 0, 0}, {0, 0, 0}}}};
    assert_true(all_orders(REJECTION_BOUNCE, 3, bond).hits > 400);
  }
}

/* Two heavy bonds drive two light ones towards each other, each so fast that it leaves its anchor and so far from the
 * other that they meet only since both are fast: who moves last has to find the other one where it has gone. */
static void both_are_hit_and_meet(void **unused)
{
  (void)unused;
  for (int k = 0; k < 8; k++) {
    const double z = 4.7 + 0.05 * k;
    const struct thrown_bond bond[4] = {{50.0, {{4.1, 3.6, 3.9}, {4.1, 4.5, 3.9}}, {{0, 0, 30}, {0, 0, 30}}},
                                        {1.25, {{3.6, 4, 4}, {4.5, 4, 4}}, {{0, 0, 0}, {0, 0, 0}}},
                                        {1.25, {{4, 3.6, z}, {4, 4.5, z}}, {{0, 0, 0}, {0, 0, 0}}},
                                        {50.0, {{3.6, 4.1, z + 0.1}, {4.5, 4.1, z + 0.1}}, {{0, 0, -30}, {0, 0, -30}}}};
    assert_true(all_orders(REJECTION_STAY, 4, bond).hits > 800);
  }
}

/* C has nobody to meet and moves up before its turn; F hits S, which then looks around where C has gone. G, hit by H,
 * comes near to C and calls it back; it hits C, which turns down, no faster than before, and S comes up: they meet
 * where S has not looked unless it looked where C could be called back to. */
static void who_is_called_back_turns_around(void **unused)
{
  (void)unused;
  uint64_t called_back = 0;
  for (int k = 0; k < 24; k++) {
    const double z = 4.185 + 0.003 * (k / 2);
    const struct thrown_bond bond[5] = {
        {50.0, {{4, 3.5, 3.996}, {4, 4.5, 3.996}}, {{0, 0, 7.5}, {0, 0, 7.5}}},
        {1.25, {{3.5, 4, 4}, {4.5, 4, 4}}, {{0, 0, 0}, {0, 0, 0}}},
        {2.2, {{4, 3.5, z}, {4, 4.5, z}}, {{0, 0, 10}, {0, 0, 10}}},
        {1.25, {{3.5, 4, 4.321}, {4.5, 4, 4.321}}, {{0, 0, 0}, {0, 0, 0}}},
        {50.0, {{4.32, 3.5, 4.325}, {4.32, 4.5, 4.325}}, {{0, 0, -10.25}, {0, 0, -10.25}}}};
    const struct orders done = all_orders(k % 2 ? REJECTION_BOUNCE : REJECTION_STAY, 5, bond);
    assert_true(done.hits > 800);
    called_back += done.called_back;
  }
  assert_true(called_back > 100);
}

/* Moves longer than the margin of the neighbor list. Who is hit may turn where nobody was looked for, without being
 * faster: beyond its anchor. (In a suspension of seed 3902 that was once missed, under the paper's rule.) */
static void who_is_hit_turns_around(void **unused)
{
  (void)unused;
  struct reference total = {.seed = 0};
  for (uint64_t k = 0; k < 80; k++) {
    const uint64_t seed = 3702 + 10 * (k / 2);
    struct dice d = {seed};
    struct test_run r = dense(4, 4, 4, 40, 8, 0.54, &d);
    r.model.crossing.rejection = k % 2 ? REJECTION_BOUNCE : REJECTION_STAY;
    compare_sweeps(&r, &d, 2, 0.2, seed, &total);
    test_end(&r);
  }
  report(&total);
  assert_true(total.counts.executed > 5000);
}

/* Boxes of one to three cells: bonds meet their own fiber's images, and one bond several images of another. */
static void boxes_of_few_cells(void **unused)
{
  (void)unused;
  struct reference total = {.seed = 0};
  const int size[][3] = {{1, 1, 1}, {2, 1, 1}, {1, 3, 2}, {2, 2, 2}, {3, 2, 3}};
  for (uint64_t k = 0; k < 150; k++) {
    const uint64_t seed = dice_seed(1102) + k;
    struct dice d = {seed};
    const int *s = size[k % 5];
    const int shortest = s[0] < s[1] ? (s[0] < s[2] ? s[0] : s[2]) : (s[1] < s[2] ? s[1] : s[2]);
    const int cells = s[0] * s[1] * s[2];
    struct test_run r = dense(s[0], s[1], s[2], 2 + (uint32_t)cells, 6, 0.35 * shortest, &d);
    r.model.crossing.rejection = k % 2 ? REJECTION_BOUNCE : REJECTION_STAY;
    compare_sweeps(&r, &d, 5, 0.02 * shortest, seed, &total);
    test_end(&r);
  }
  report(&total);
  assert_true(total.counts.executed > 1000 && total.image_hits > 1000);
  assert_true(total.linked_image_hits == 0); /* the images of linked bonds are out of reach: neighbors.h */
}

/* One long fiber alone in a small box meets itself and its images. */
static void one_fiber_meets_itself(void **unused)
{
  (void)unused;
  struct reference total = {.seed = 0};
  for (uint64_t k = 0; k < 30; k++) {
    const uint64_t seed = dice_seed(1103) + k;
    struct dice d = {seed};
    struct test_run r = dense(2, 2, 3, 1, 60, 0.6, &d);
    r.model.crossing.exclusion = k % 2 ? EXCLUSION_PAPER : EXCLUSION_SHARED_VERTEX;
    r.model.crossing.rejection = k % 4 < 2 ? REJECTION_STAY : REJECTION_BOUNCE;
    compare_sweeps(&r, &d, 6, 0.05, seed, &total);
    test_end(&r);
  }
  report(&total);
  assert_true(total.counts.executed > 300);
}

/* --- the first of several ----------------------------------------------------------------------------------------- */

/* A fiber of three vertices along x, its middle one moving up by 0.4 a0 through `n` rods that lie along y at heights
 * 0.1, 0.2, 0.3 over either of its bonds, numbered in every order, each in an image of its own (THEORY test 8). */
static void first_of_several(void **unused)
{
  (void)unused;
  const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int n = 1; n <= 3; n++)
    for (int k = 0; k < 6 * 8; k++) {
      struct model m = test_model(4, 5, 6, 0, 0.5, 2);
      test_add_kind(&m, 3, 2);
      test_add_kind(&m, 1, 3);
      for (int kind = 0; kind < 2; kind++) /* soft enough for the time step; no force acts here */
        m.kind[kind].spring = 10.0, m.kind[kind].bending = 0.0;
      struct dice d = {1};
      struct test_run r = dice_run(m, &d);
      const double a0 = (double)LATTICE_CELL;
      for (int rod = 0; rod < 3; rod++) { /* rods not used lie far off the path */
        const int height = orders[k % 6][rod];
        const double x = 2.0 + (k / 6 >> rod & 1 ? 0.1 : -0.1), z = rod < n ? 3.1 + 0.1 * height : 5.0;
        for (int end = 0; end < 2; end++)
          r.state.position[2 * rod + end] =
              (struct point){(int64_t)(x * a0) + (rod - 1) * r.model.box.edge[0],
                             (int64_t)((end ? 3.2 : 2.0) * a0) - rod * r.model.box.edge[1],
                             (int64_t)(z * a0) + 3 * rod * r.model.box.edge[2]};
      }
      for (int v = 0; v < 3; v++)
        r.state.position[6 + v] = (struct point){(int64_t)((1.0 + v) * a0), (int64_t)(2.5 * a0), 3 * LATTICE_CELL};
      for (uint32_t v = 0; v < 9; v++)
        r.state.velocity[v] = (struct vec3){0, 0, v == 7 ? 0.8 : 0.0};
      int lowest = 0; /* the rod hit first: the lowest of those used (they are all 0.1 from the middle) */
      for (int rod = 1; rod < n; rod++)
        if (orders[k % 6][rod] < orders[k % 6][lowest])
          lowest = rod;
      struct events told = {.n = 0};
      const struct contact_log log = {collect, &told};
      const struct point before = r.state.position[7];
      assert_true(contact_drift(&r.state, &r.model, &r.work.contact, 1.0, 5, 0, &log, &r.work.fault));
      assert_true(memcmp(&before, &r.state.position[7], sizeof before) == 0); /* rejected */
      assert_int_equal(told.n, n);
      assert_int_equal(r.state.counts.possible, n);
      assert_int_equal(r.state.counts.executed, 1);
      for (int e = 0; e < n; e++) {
        const struct contact_event *t = &told.event[e];
        assert_true(t->executed == (t->standing_bond == 2 * (uint32_t)lowest));
        /* the bond is at height 0.9 of the vertex's where the rod is: 0.4 t 0.9 = 0.1 (1 + height) */
        assert_close(t->hit.time, (1 + orders[k % 6][t->standing_bond / 2]) / 3.6, 1e-9);
        assert_close(t->hit.s, 0.1, 1e-9);
        assert_close(t->hit.s_standing, 0.5 / 1.2, 1e-9);
        assert_close(t->hit.normal.z, 1.0 / sqrt(1.0 + pow(0.4 * t->hit.time, 2)), 1e-9);
        assert_true(t->impulse == 0.0 || t->impulse > 0.0);
      }
      assert_true(r.state.velocity[7].z < 0.8 && r.state.velocity[2 * lowest].z > 0.0);
      for (int rod = 0; rod < 3; rod++)
        assert_true(rod == lowest || r.state.velocity[2 * rod].z == 0.0);
      test_end(&r);
    }
}

/* A fiber of four vertices whose third (or, named backwards, second) moves up, so that the bond beyond it meets the
 * first bond: in a box of 8 cells the bond itself, which the paper leaves out and the stricter option does not; in a
 * box of 4 the bond's image, which is not linked to anything. */
static void exclusion_is_of_bonds_not_of_images(void **unused)
{
  (void)unused;
  const double x[4][3] = {{2.5, 0.5, 0.1}, {4.0, 0.0, 0.0}, {1.7, 0.0, 0.0}, {3.2, 0.6, 0.0}};
  for (int k = 0; k < 8; k++) {
    const bool image = k & 1, backwards = k & 2, paper = k & 4;
    struct model m = test_model(image ? 4 : 8, image ? 4 : 8, image ? 4 : 8, 0, 0.5, 2);
    m.crossing.exclusion = paper ? EXCLUSION_PAPER : EXCLUSION_SHARED_VERTEX;
    struct fiber_kind *kind = test_add_kind(&m, 1, 4);
    kind->spring = 10.0, kind->bending = 0.0; /* soft enough for the time step; no force acts here */
    struct dice d = {1};
    struct test_run r = dice_run(m, &d);
    for (int v = 0; v < 4; v++) {
      const int at = backwards ? 3 - v : v;
      const double shift = image && v < 2 ? -4.0 : 0.0;
      r.state.position[at] = point_move((struct point){0, 0, 0}, (struct vec3){x[v][0] + shift, x[v][1], x[v][2]});
      r.state.velocity[at] = (struct vec3){0, 0, v == 2 ? 0.8 : 0.0};
    }
    struct events *told = calloc(1, sizeof *told);
    const struct contact_log log = {collect, told};
    assert_true(contact_drift(&r.state, &r.model, &r.work.contact, 1.0, 5, 0, &log, &r.work.fault));
    assert_int_equal(told->n, paper && !image ? 0 : 1);
    if (told->n == 1) {
      assert_int_equal(told->event[0].moving_bond, backwards ? 0 : 2);
      assert_int_equal(told->event[0].standing_bond, backwards ? 2 : 0);
      assert_int_equal(told->event[0].image[0], image ? 1 : 0);
    }
    free(told);
    test_end(&r);
  }
}

/* --- the limits of a move ----------------------------------------------------------------------------------------- */

static void impossible_moves_are_found(void **unused)
{
  (void)unused;
  const double bad[] = {NAN, INFINITY, 2.0 / 0.01, -2.0 / 0.01, 1e300};
  for (int k = 0; k < 30; k++) {
    struct model m = test_model(5, 4, 6, 0, 0.01, 2);
    m.crossing.forbidden = k % 2;
    test_add_kind(&m, 4, 3);
    struct dice d = {1};
    struct test_run r = dense(5, 4, 6, 4, 3, 0.5, &d);
    r.model.crossing.forbidden = k % 2;
    r.state.step = 41;
    double *component[] = {&r.state.velocity[7].x, &r.state.velocity[7].y, &r.state.velocity[7].z};
    *component[k / 2 % 3] = bad[k / 6];
    assert_false(contact_drift(&r.state, &r.model, &r.work.contact, 1.0, 42, 0, NULL, &r.work.fault));
    assert_int_equal(r.work.fault.code, FAULT_VERTEX_MOVE);
    assert_true(r.work.fault.entity == 7 && r.work.fault.step == 42);
    assert_close(r.work.fault.limit, 2.0, 0.0);
    test_end(&r);
    model_free(&m);
  }
}

/* An end of a light bond falls, slowly, on a heavy one that is fast and has yet to move. It would bounce off at 2 x 41/
 * (0.724 + 0.01) 0.95/1.25 - 1 = 84 a0/t0, further than half the box in what is left of the step. */
static void bounces_have_the_same_limit(void **unused)
{
  (void)unused;
  const struct thrown_bond bond[2] = {{50.0, {{0.3, 0.5, 0.5}, {0.7, 0.5, 0.5}}, {{0, 0, 40}, {0, 0, 40}}},
                                      {1.25, {{0.5, 0.48, 0.502}, {0.5, 0.88, 0.502}}, {{0, 0, -1}, {0, 0, 0}}}};
  uint32_t falls_first = 0;
  for (uint64_t step = 1; step <= 40; step++) {
    struct model m = test_model(1, 1, 1, 0, 0.01, 2);
    m.crossing.rejection = REJECTION_BOUNCE;
    for (uint32_t k = 0; k < 2; k++) {
      struct fiber_kind *kind = test_add_kind(&m, 1, 2);
      kind->mass = bond[k].mass;
      kind->bond_length = 0.25;
    }
    struct dice d = {1};
    struct test_run r = dice_run(m, &d);
    for (uint32_t v = 0; v < 4; v++) {
      r.state.position[v] = point_move((struct point){0, 0, 0}, bond[v / 2].end[v % 2]);
      r.state.velocity[v] = bond[v / 2].velocity[v % 2];
    }
    const bool whole = contact_drift(&r.state, &r.model, &r.work.contact, 1.0, step, 0, NULL, &r.work.fault);
    const uint32_t *rank = r.work.contact.rank;
    if (rank[2] < rank[0] && rank[2] < rank[1]) {
      falls_first++;
      assert_false(whole);
      assert_int_equal(r.work.fault.code, FAULT_VERTEX_MOVE);
      assert_int_equal(r.work.fault.entity, 2);
      assert_true(r.work.fault.value > 0.5 && r.work.fault.value < 0.84);
      const struct point start = point_move((struct point){0, 0, 0}, bond[1].end[0]);
      assert_true(vec3_norm(point_difference(r.state.position[2], start)) == 0.0);
    }
    test_end(&r);
  }
  assert_true(falls_first > 5);
}

/* Phantom fibers move straight through; the log stays silent. */
static void phantom_fibers_just_move(void **unused)
{
  (void)unused;
  struct dice d = {7};
  struct test_run r = dense(4, 4, 4, 20, 6, 0.5, &d);
  r.model.crossing.forbidden = false;
  struct point *before = malloc(r.state.vertices * sizeof *before);
  memcpy(before, r.state.position, r.state.vertices * sizeof *before);
  struct events *told = calloc(1, sizeof *told);
  const struct contact_log log = {collect, told};
  assert_true(contact_drift(&r.state, &r.model, &r.work.contact, 0.5, 1, 0, &log, &r.work.fault));
  for (uint32_t v = 0; v < r.state.vertices; v++) {
    assert_true(r.state.position[v].x == before[v].x + llrint(0x1p40 * (0.005 * r.state.velocity[v].x)));
    assert_true(r.state.position[v].y == before[v].y + llrint(0x1p40 * (0.005 * r.state.velocity[v].y)));
    assert_true(r.state.position[v].z == before[v].z + llrint(0x1p40 * (0.005 * r.state.velocity[v].z)));
  }
  assert_true(told->n == 0 && r.state.counts.executed == 0);
  free(before);
  free(told);
  test_end(&r);
}

/* --- topology
 * --------------------------------------------------------------------------------------------------------- */

/* THEORY test 6: 10^4 steps at several dt, with and without solvent (which takes the heat of many exchanges at the
 * longest step), either exclusion; chains of three; many rings in a small box. */
static void links_are_kept(void **unused)
{
  (void)unused;
  const struct {
    struct model (*make)(double per_cell, double dt);
    double per_cell, dt;
    uint64_t steps;
    enum rejection refusal;
  } runs[] = {{pairs, 0, 0.005, 10000, REJECTION_STAY},      {pairs, 0, 0.01, 10000, REJECTION_STAY},
              {pairs, 0, 0.02, 10000, REJECTION_STAY},       {pairs, 3, 0.01, 10000, REJECTION_STAY},
              {pairs, 3, 0.02, 10000, REJECTION_STAY},       {pairs, 3, 0.04, 10000, REJECTION_STAY},
              {chain, 0, 0.01, 10000, REJECTION_STAY},       {chain, 3, 0.02, 10000, REJECTION_STAY},
              {dense_rings, 3, 0.02, 1000, REJECTION_STAY},  {pairs, 3, 0.02, 10000, REJECTION_BOUNCE},
              {dense_rings, 3, 0.02, 1000, REJECTION_BOUNCE}};
  for (int k = 0; k < 11; k++) {
    struct model m = runs[k].make(runs[k].per_cell, runs[k].dt);
    m.seed = dice_seed(1104) + (uint64_t)k;
    m.crossing.exclusion = k % 2 ? EXCLUSION_PAPER : EXCLUSION_SHARED_VERTEX;
    m.crossing.rejection = runs[k].refusal;
    struct test_run r = test_start(m);
    const struct followed f = follow_links(&r, runs[k].steps);
    if (f.changed > 0)
      fail_msg("seed %lu: a linking number changes at dt = %g", (unsigned long)r.model.seed, runs[k].dt);
    print_message("  gamma %g, dt %g: %lu crossings prevented in %lu steps\n", runs[k].per_cell, runs[k].dt,
                  (unsigned long)f.executed, (unsigned long)f.steps);
    assert_true(f.executed > 40);
    test_end(&r);
  }
}

/* Links as they were laid: of a chain the first with the second, the second with the third. */
static void links_of_a_chain(void **unused)
{
  (void)unused;
  struct test_run r = test_start(chain(0.0, 0.01));
  struct links links;
  find_links(&r, &links);
  assert_int_equal(links.n, 2);
  for (uint32_t k = 0; k < 2; k++) {
    assert_true(links.link[k].ring == k && links.link[k].other == k + 1);
    assert_int_equal(llabs(links.link[k].lk), 1);
  }
  test_end(&r);
}

/* The same rings as phantoms do not stay linked: the test above can fail. */
static void phantom_links_are_lost(void **unused)
{
  (void)unused;
  struct model m = pairs(0.0, 0.02);
  m.crossing.forbidden = false;
  m.seed = 5;
  struct test_run r = test_start(m);
  const struct followed f = follow_links(&r, 3000);
  assert_true(f.changed > 5);
  assert_true(f.executed == 0);
  test_end(&r);
}

/* So many boxes of 5 x 4 x 4 along x, and all that is within work with them: the frame has gone there. */
static void send_off(struct test_run *r, int64_t a0)
{
  const int64_t far = a0 / 5 * r->model.box.edge[0];
  for (uint32_t v = 0; v < r->state.vertices; v++)
    r->state.position[v].x += far;
  r->work.contact.neighbors.moved.x += far;
}

/* Who comes too far for differences of places stops the run, noncrossing or phantom, at a step that looks. */
static void lost_vertices_are_found(void **unused)
{
  (void)unused;
  for (int k = 0; k < 4; k++) {
    struct dice d = {17};
    struct test_run r = dense(5, 4, 4, 4, 8, 0.54, &d);
    r.model.crossing.forbidden = k % 2;
    r.state.position[0].x = k < 2 ? LATTICE_REACH : -LATTICE_REACH;
    for (uint32_t v = 1; v < 8; v++)
      r.state.position[v] = point_move(r.state.position[v - 1], (struct vec3){k < 2 ? 0.54 : -0.54, 0, 0});
    assert_true(contact_drift(&r.state, &r.model, &r.work.contact, 1.0, 1023, 0, NULL, &r.work.fault));
    assert_false(contact_drift(&r.state, &r.model, &r.work.contact, 1.0, 1024, 0, NULL, &r.work.fault));
    assert_int_equal(r.work.fault.code, FAULT_VERTEX_PLACE);
    assert_true(r.work.fault.entity < 8 && r.work.fault.value > r.work.fault.limit);
    test_end(&r);
  }
}

/* A frame that has gone as far is forgotten, and nothing else: the sweep is that of the same suspension near by. */
static void far_frames_are_forgotten(void **unused)
{
  (void)unused;
  struct dice d[2] = {{18}, {18}};
  struct test_run r[2] = {dense(5, 4, 4, 40, 8, 0.54, &d[0]), dense(5, 4, 4, 40, 8, 0.54, &d[1])};
  send_off(&r[1], -1500000);
  for (int n = 0; n < 2; n++) {
    assert_true(neighbors_build(&r[n].state, &r[n].model, &r[n].work.contact, &r[n].work.fault));
    r[n].model.crossing.frame = FRAME_FLOW;
    r[n].model.flow.x = 3.0;
    r[n].model.time_step = 0.05;
  }
  send_off(&r[1], 3000000);
  for (int n = 0; n < 2; n++)
    for (uint64_t step = 1015; step < 1035; step++)
      assert_true(contact_drift(&r[n].state, &r[n].model, &r[n].work.contact, 1.0, step, 0, NULL, &r[n].work.fault));
  assert_true(point_within_reach(r[1].work.contact.neighbors.moved));
  assert_true(r[0].state.counts.executed > 10 && r[0].state.counts.executed == r[1].state.counts.executed);
  for (uint32_t v = 0; v < r[0].state.vertices; v++)
    r[1].state.position[v].x -= 1500000 / 5 * r[1].model.box.edge[0];
  assert_memory_equal(r[0].state.position, r[1].state.position, r[0].state.vertices * sizeof *r[0].state.position);
  test_end(&r[0]);
  test_end(&r[1]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(dense_suspensions),
      cmocka_unit_test(bouncing_suspensions),
      cmocka_unit_test(sweeps_in_a_moving_frame),
      cmocka_unit_test(calm_suspensions_with_fast_vertices),
      cmocka_unit_test(limits_of_pairs_hold),
      cmocka_unit_test(who_is_hit_hits_others),
      cmocka_unit_test(who_is_hit_in_a_flow_hits_others),
      cmocka_unit_test(who_bounces_looks_around),
      cmocka_unit_test(both_are_hit_and_meet),
      cmocka_unit_test(who_is_called_back_turns_around),
      cmocka_unit_test(who_is_hit_turns_around),
      cmocka_unit_test(boxes_of_few_cells),
      cmocka_unit_test(one_fiber_meets_itself),
      cmocka_unit_test(first_of_several),
      cmocka_unit_test(exclusion_is_of_bonds_not_of_images),
      cmocka_unit_test(impossible_moves_are_found),
      cmocka_unit_test(bounces_have_the_same_limit),
      cmocka_unit_test(phantom_fibers_just_move),
      cmocka_unit_test(lost_vertices_are_found),
      cmocka_unit_test(far_frames_are_forgotten),
      cmocka_unit_test(links_of_a_chain),
      cmocka_unit_test(links_are_kept),
      cmocka_unit_test(phantom_links_are_lost),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Moves and bonds made to be hard to judge: exactly or nearly degenerate, needles, of all sizes. */
#ifndef UNCROSS_TESTS_ADVERSARIAL_H
#define UNCROSS_TESTS_ADVERSARIAL_H

#include "contact/line.h"
#include "contact/reference.h"

static inline struct point plus(struct point p, int64_t factor, struct point q)
{
  return (struct point){p.x + factor * q.x, p.y + factor * q.y, p.z + factor * q.z};
}

static inline struct point cube(struct dice *d, int64_t size)
{
  return dice_point(d, size, size, size);
}

static inline struct crossing_query any_query(struct dice *d, int64_t size)
{
  struct crossing_query q;
  q.from = cube(d, size), q.to = cube(d, size), q.pivot = cube(d, size), q.a = cube(d, size), q.b = cube(d, size);
  q.flip = dice_u64(d) & 1;
  return q;
}

/* The standing bond along the moving one, before, or after the move. */
static inline struct crossing_query parallel(struct dice *d, int64_t size)
{
  struct crossing_query q = any_query(d, size);
  const struct point end = dice_u64(d) & 1 ? q.from : q.to;
  const int64_t factor = dice_integer(d, 1, 3);
  q.b = plus(plus(q.a, factor, q.pivot), -factor, end);
  return q;
}

static inline struct point in_plane(struct dice *d, const struct crossing_query *q)
{
  const int64_t alpha = dice_integer(d, -3, 3), beta = dice_integer(d, -3, 3);
  const struct point p = plus(plus(q->pivot, alpha, q->from), -alpha, q->pivot);
  return plus(plus(p, beta, q->to), -beta, q->pivot);
}

static inline struct crossing_query coplanar(struct dice *d, int64_t size)
{
  struct crossing_query q = any_query(d, size);
  q.a = in_plane(d, &q);
  q.b = in_plane(d, &q);
  return q;
}

static inline struct crossing_query collinear(struct dice *d, int64_t size)
{
  struct crossing_query q = any_query(d, size);
  struct point along = plus(q.pivot, -1, q.from);
  q.a = plus(q.pivot, dice_integer(d, -3, 3), along);
  q.b = plus(q.pivot, dice_integer(d, -3, 3), along);
  if (dice_u64(d) & 1)
    q.to = plus(q.pivot, dice_integer(d, -3, 3), along);
  return q;
}

static inline struct crossing_query end_to_end(struct dice *d, int64_t size)
{
  struct crossing_query q = any_query(d, size);
  const struct point ends[] = {q.from, q.to, q.pivot};
  *(dice_u64(d) & 1 ? &q.a : &q.b) = ends[dice_integer(d, 0, 2)];
  return q;
}

/* An end of the standing bond on an edge of the swept triangle: on the bond before or after, or on the path. */
static inline struct crossing_query end_on_bond(struct dice *d, int64_t size)
{
  struct crossing_query q = any_query(d, size);
  struct point *all[] = {&q.from, &q.to, &q.pivot};
  for (int k = 0; k < 3; k++)
    *all[k] = plus((struct point){0, 0, 0}, 4, *all[k]);
  const struct point p = *all[dice_integer(d, 0, 2)], r = *all[dice_integer(d, 0, 2)];
  const int64_t part = dice_integer(d, 0, 4);
  *(dice_u64(d) & 1 ? &q.a : &q.b) =
      (struct point){p.x + (r.x - p.x) / 4 * part, p.y + (r.y - p.y) / 4 * part, p.z + (r.z - p.z) / 4 * part};
  return q;
}

/* The standing bond passes exactly through the bond, before or after, or through the path of the vertex. */
static inline struct crossing_query bond_on_edge(struct dice *d, int64_t size)
{
  struct crossing_query q = end_on_bond(d, size);
  const struct point place = q.a, half = cube(d, size);
  q.a = plus(place, 1, half);
  q.b = plus(place, -dice_integer(d, 1, 2), half);
  return q;
}

/* A move of a few units of the lattice at the end of a long bond, and a standing bond through its middle or so. */
static inline struct crossing_query needle(struct dice *d, int64_t size)
{
  struct crossing_query q = any_query(d, size);
  q.to = plus(q.from, 1, cube(d, 3));
  const struct point half = cube(d, size);
  const struct point middle = {q.from.x / 2 + q.pivot.x / 2, q.from.y / 2 + q.pivot.y / 2,
                               q.from.z / 2 + q.pivot.z / 2};
  q.a = plus(plus(middle, 1, half), 1, cube(d, 2));
  q.b = plus(plus(middle, -1, half), 1, cube(d, 2));
  return q;
}

/* A pivot almost on the path: the triangle is all edge. */
static inline struct crossing_query flat_triangle(struct dice *d, int64_t size)
{
  struct crossing_query q = needle(d, size);
  const struct point far = q.pivot, near = q.to;
  q.to = far;
  q.pivot = plus((struct point){far.x / 2 + near.x / 2, far.y / 2 + near.y / 2, far.z / 2 + near.z / 2}, 1, cube(d, 2));
  return q;
}

static const struct family {
  const char *name;
  struct crossing_query (*draw)(struct dice *d, int64_t size);
} families[] = {
    {"any", any_query},
    {"parallel", parallel},
    {"coplanar", coplanar},
    {"collinear", collinear},
    {"end to end", end_to_end},
    {"end on bond", end_on_bond},
    {"bond on edge", bond_on_edge},
    {"needle", needle},
    {"flat triangle", flat_triangle},
};
enum { FAMILIES = sizeof families / sizeof families[0] };

/* From a few units of the lattice to about 1000 a0, most of it spread evenly in the logarithm. */
static inline int64_t dice_size(struct dice *d)
{
  return dice_u64(d) & 1 ? dice_integer(d, 1, 4) : (int64_t)1 << dice_integer(d, 3, 46);
}

/* All points displaced by up to `units` of the lattice each, and all of them far away together. */
static inline void jitter(struct dice *d, struct crossing_query *q, int64_t units)
{
  struct point *all[] = {&q->from, &q->to, &q->pivot, &q->a, &q->b};
  const struct point far = dice_u64(d) & 1 ? (struct point){0, 0, 0} : cube(d, (int64_t)1 << 59);
  for (int k = 0; k < 5; k++)
    *all[k] = plus(plus(*all[k], 1, far), 1, cube(d, units));
}

struct verdicts {
  uint64_t judged, missed, invented, hits, touches, touches_hit;
};

static inline void judge_query(struct exact_test *x, const struct crossing_query *q, struct verdicts *v)
{
  struct crossing_hit hit;
  const bool found = crossing_find(q, &hit);
  const enum exact_verdict verdict = exact_crossing(x, q->from, q->to, q->pivot, q->a, q->b);
  const bool right =
      verdict == EXACT_TOUCH ? touch_counts(x, q->from, q->to, q->pivot, q->a, q->b, q->flip) : verdict == EXACT_HIT;
  v->judged++;
  v->missed += right && !found;
  v->invented += found && !right;
  v->hits += verdict == EXACT_HIT;
  v->touches += verdict == EXACT_TOUCH;
  v->touches_hit += verdict == EXACT_TOUCH && found;
  if (!found)
    return;
  assert_true(hit.time >= 0.0 && hit.time <= 1.0 && hit.s >= 0.0 && hit.s <= 1.0);
  assert_true(hit.s_standing >= 0.0 && hit.s_standing <= 1.0);
  assert_close(vec3_dot(hit.normal, hit.normal), 1.0, 1e-12);
}

/* So many cases of each family, a third of them exactly as drawn, the rest displaced by a unit or two. */
static inline void audit_families(uint64_t seed, uint64_t cases)
{
  struct exact_test x;
  struct dice d = {seed};
  exact_open(&x);
  print_message("  %-14s %9s %9s %9s %9s %7s %9s\n", "", "judged", "hits", "touches", "counted", "missed", "invented");
  for (int f = 0; f < FAMILIES; f++) {
    struct verdicts v = {0};
    for (uint64_t k = 0; k < cases; k++) {
      struct crossing_query q = families[f].draw(&d, dice_size(&d));
      jitter(&d, &q, (int64_t)(k % 3));
      judge_query(&x, &q, &v);
    }
    print_message("  %-14s %9lu %9lu %9lu %9lu %7lu %9lu\n", families[f].name, (unsigned long)v.judged,
                  (unsigned long)v.hits, (unsigned long)v.touches, (unsigned long)v.touches_hit,
                  (unsigned long)v.missed, (unsigned long)v.invented);
    if (v.missed + v.invented > 0)
      fail_msg("seed %lu: %s: %lu missed, %lu invented", (unsigned long)seed, families[f].name, (unsigned long)v.missed,
               (unsigned long)v.invented);
    assert_true(v.hits + v.touches > cases / 1000);
  }
  exact_close(&x);
}

/* Moves of dense suspensions: short ones, ones far longer than the margin of the neighbor lists, and exact candidates
 * on a coarse lattice. */
static inline void audit_sweeps(uint64_t seed, uint64_t suspensions)
{
  const struct {
    const char *name;
    double size;
    int sweeps, edge;
    uint32_t fibers;
  } kinds[] = {{"moves of 0.02", 0.02, 8, 4, 40},
               {"moves of 0.1", 0.1, 6, 4, 40},
               {"moves of 0.2", 0.2, 2, 4, 40},
               {"moves of 0.5", 0.5, 1, 6, 100},
               {"touches", 0.0, 2, 4, 40}};
  print_message("  %-14s %9s %9s %9s %9s  none missed, none invented\n", "", "moves", "hits", "executed", "touches");
  for (int kind = 0; kind < 5; kind++) {
    const int edge = kinds[kind].edge;
    const uint32_t fibers = kinds[kind].fibers;
    struct reference total = {.seed = 0, .by_convention = kinds[kind].size == 0.0};
    for (uint64_t k = 0; k < suspensions; k++) {
      struct dice d = {seed + 10 * k};
      struct test_run r =
          total.by_convention ? coarse(edge, fibers, 8, &d) : dense(edge, edge, edge, fibers, 8, 0.54, &d);
      compare_sweeps(&r, &d, kinds[kind].sweeps, kinds[kind].size, seed + 10 * k, &total);
      test_end(&r);
    }
    const struct collision_counts *c = &total.counts;
    print_message("  %-14s %9lu %9lu %9lu %9lu\n", kinds[kind].name, (unsigned long)c->moves,
                  (unsigned long)c->possible, (unsigned long)c->executed, (unsigned long)total.touches);
    assert_true(c->executed > c->moves / 1000);
    assert_true(!total.by_convention || total.touches > c->moves / 100);
  }
}

/* --- brawls ------------------------------------------------------------------------------------------------------- */

/* A fiber across the z axis, in rows one way and the other, all of it at one speed or nearly. */
static inline void lay(struct test_run *r, struct dice *d, uint32_t fiber, double z, double speed)
{
  const uint32_t first = r->model.fiber_first[fiber], n = r->model.fiber_first[fiber + 1] - first;
  const double turn = (fiber % 2 ? 1.5707963 : 0.0) + dice_between(d, -0.2, 0.2), half = 0.5 * (n - 1.0);
  const struct vec3 middle = {4.0 + dice_between(d, -0.2, 0.2), 4.0 + dice_between(d, -0.2, 0.2), z};
  for (uint32_t v = 0; v < n; v++) {
    const struct vec3 along = {(v - half) * 0.9 * cos(turn), (v - half) * 0.9 * sin(turn), 0.0};
    r->state.position[first + v] = point_move((struct point){0, 0, 0}, vec3_add(middle, along));
    r->state.velocity[first + v] = vec3_add((struct vec3){0, 0, speed}, dice_vector(d, 0.1));
  }
}

/* Light fibers at rest, each with a heavy one that is about to hit it from below or above, and others that fly by
 * between them, at the distances that they go in a step or two: who is hit hits others, and calls back who had moved
 * before its turn. Heavy, light and flying ones are the model's fibers in turn. */
static inline void throw_stack(struct test_run *r, struct dice *d)
{
  double z = 4.0;
  for (uint32_t f = 0; f < r->model.fibers; f += 3) {
    const double way = dice_u64(d) & 1 ? 1.0 : -1.0, gap = dice_between(d, 0.001, 0.02);
    lay(r, d, f, z, way * dice_between(d, 4.0, 12.0));
    lay(r, d, f + 1, z + way * gap, 0.0);
    z += dice_between(d, 0.03, 0.25);
    lay(r, d, f + 2, z, (dice_u64(d) & 1 ? 1.0 : -1.0) * dice_between(d, 2.0, 12.0));
    z += dice_between(d, 0.03, 0.25);
  }
  r->work.contact.neighbors.built = false; /* they were moved by hand */
}

/* So many stacks, each in an order of its own, against brute force; masses are the same in 50. */
static inline void audit_brawls(uint64_t seed, uint64_t stacks)
{
  struct events *told = calloc(1, sizeof *told);
  const struct contact_log log = {collect, told};
  uint64_t hits = 0, called_back = 0;
  for (uint64_t k = 0; k < stacks; k += 50) {
    struct dice d = {seed + k};
    struct model m = test_model(8, 8, 8, 0, 0.01, 2);
    m.crossing.rejection = dice_u64(&d) & 1 ? REJECTION_BOUNCE : REJECTION_STAY;
    for (uint32_t f = 0; f < 9; f++)
      test_add_kind(&m, 1, 2 + (uint32_t)(dice_u64(&d) % 4 == 0))->mass =
          (const double[]){50.0, 1.25, 1.25}[f % 3] * dice_between(&d, 1.0, f % 3 == 2 ? 5.0 : 1.5);
    struct test_run r = dice_run(m, &d);
    struct reference ref = {.model = &r.model, .told = told, .seed = seed + k};
    ref.position = malloc(r.state.vertices * sizeof *ref.position);
    ref.velocity = malloc(r.state.vertices * sizeof *ref.velocity);
    exact_open(&ref.exact);
    for (uint64_t step = 1; step <= 50; step++) {
      throw_stack(&r, &d);
      told->n = told->read = 0;
      copy_state(&ref, &r.state);
      assert_true(contact_drift(&r.state, &r.model, &r.work.contact, 1.0, step, 0, &log, &r.work.fault));
      sweep_by_hand(&ref, r.model.time_step, step, 0);
      assert_int_equal(told->read, told->n);
      compare_states(&ref, &r.state);
    }
    hits += ref.counts.executed;
    called_back += r.work.contact.called_back;
    exact_close(&ref.exact);
    free(ref.position);
    free(ref.velocity);
    test_end(&r);
  }
  free(told);
  print_message("  %lu stacks, %lu hits executed, %lu vertices called back\n", (unsigned long)stacks,
                (unsigned long)hits, (unsigned long)called_back);
  assert_true(hits > stacks && called_back > stacks / 20);
}

#endif

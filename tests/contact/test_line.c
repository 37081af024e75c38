/* The crossing test against exact integers (GMP, exact.h), which share no code with it: decisions in every
 * nondegenerate case, times and places, degenerate cases by what topology demands of them, symmetries. */
#include "contact/determinant.h"
#include "contact/line.h"
#include "exact.h"

static struct point dice_cube(struct dice *d, int64_t size)
{
  return dice_point(d, size, size, size);
}

static struct point scaled(struct point p, int64_t factor)
{
  return (struct point){p.x * factor, p.y * factor, p.z * factor};
}

static struct point sum(struct point a, struct point b)
{
  return (struct point){a.x + b.x, a.y + b.y, a.z + b.z};
}

static struct crossing_query dice_query(struct dice *d, int64_t size)
{
  struct crossing_query q;
  q.from = dice_cube(d, size);
  q.to = dice_cube(d, size);
  q.pivot = dice_cube(d, size);
  q.a = dice_cube(d, size);
  q.b = dice_cube(d, size);
  q.flip = dice_u64(d) & 1;
  return q;
}

static enum exact_verdict judge(struct exact_test *x, const struct crossing_query *q)
{
  return exact_crossing(x, q->from, q->to, q->pivot, q->a, q->b);
}

static void describe(const struct crossing_query *q, char *text, size_t size)
{
  snprintf(text, size, "from %ld,%ld,%ld to %ld,%ld,%ld pivot %ld,%ld,%ld a %ld,%ld,%ld b %ld,%ld,%ld flip %d",
           (long)q->from.x, (long)q->from.y, (long)q->from.z, (long)q->to.x, (long)q->to.y, (long)q->to.z,
           (long)q->pivot.x, (long)q->pivot.y, (long)q->pivot.z, (long)q->a.x, (long)q->a.y, (long)q->a.z, (long)q->b.x,
           (long)q->b.y, (long)q->b.z, q->flip);
}

/* The decision is right wherever the exact coordinates lie strictly in or strictly out; returns the verdict. */
static enum exact_verdict check_decision(struct exact_test *x, const struct crossing_query *q, struct crossing_hit *hit,
                                         uint64_t seed)
{
  const bool found = crossing_find(q, hit);
  const enum exact_verdict verdict = judge(x, q);
  if (verdict != EXACT_TOUCH && found != (verdict == EXACT_HIT)) {
    char text[400];
    describe(q, text, sizeof text);
    fail_msg("seed %lu: %s, exactly %s: %s", (unsigned long)seed, found ? "hit" : "miss", found ? "miss" : "hit", text);
  }
  if (found) {
    assert_true(hit->time >= 0.0 && hit->time <= 1.0);
    assert_true(hit->s >= 0.0 && hit->s <= 1.0 && hit->s_standing >= 0.0 && hit->s_standing <= 1.0);
    assert_close(vec3_dot(hit->normal, hit->normal), 1.0, 1e-12);
  }
  return verdict;
}

/* Generic points of bonds and moves of all sizes, up to 4096 a0. */
static void generic_cases(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(901);
  struct dice d = {seed};
  struct exact_test x;
  exact_open(&x);
  uint64_t hits = 0;
  for (int k = 0; k < 400000; k++) {
    struct crossing_query q = dice_query(&d, (int64_t)1 << dice_integer(&d, 8, 51));
    struct crossing_hit hit;
    if (check_decision(&x, &q, &hit, seed) != EXACT_HIT)
      continue;
    hits++;
    double time, s, s_standing;
    exact_contact(&x, &time, &s, &s_standing);
    /* how well the two bonds determine the place is the angle between them at contact, and their lengths */
    struct vec3 p = point_difference(q.pivot, q.from), m = point_difference(q.to, q.from),
                g = point_difference(q.b, q.a);
    p = vec3_add_scaled(p, -time, m);
    double sine2 = vec3_dot(vec3_cross(p, g), vec3_cross(p, g)) / (vec3_dot(p, p) * vec3_dot(g, g));
    double spread = (vec3_norm(p) + vec3_norm(m) + vec3_norm(g)) / fmin(vec3_norm(p), vec3_norm(g));
    double flat = fabs(vec3_dot(vec3_cross(p, g), m)) / (vec3_norm(p) * vec3_norm(g) * vec3_norm(m));
    assert_close(hit.time * (1 - s), time * (1 - s), 1e-13 * spread * spread / flat);
    assert_close(hit.s, s, 1e-13 * spread * spread / (flat * sine2));
    assert_close(hit.s_standing, s_standing, 1e-13 * spread * spread / (flat * sine2));
    struct vec3 n = vec3_cross(p, g);
    n = vec3_scale((vec3_dot(n, m) < 0.0 ? -1.0 : 1.0) / vec3_norm(n), n);
    assert_close(vec3_norm(vec3_sub(n, hit.normal)), 0.0, 1e-13 * spread * spread / (flat * sine2));
  }
  exact_close(&x);
  assert_true(hits > 10000);
}

/* As in a run: bonds of about 0.5 a0 and moves of about 0.005 a0, a quarter of them hit. Rounding displaces the point
 * of contact along its path, and along both bonds, by some 1e-15 a0 where bonds and move are at right angles; by as
 * much more as the sines of the two angles are smaller. */
static void cases_of_a_run(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(902);
  struct dice d = {seed};
  struct exact_test x;
  exact_open(&x);
  uint64_t hits = 0, misses = 0;
  double worst_time = 0.0, worst_place = 0.0;
  for (int k = 0; k < 300000; k++) {
    const struct vec3 p = dice_rod(&d, 0.2, 0.9);
    const struct vec3 g = dice_rod(&d, 0.2, 0.9), m = dice_vector(&d, 0.005);
    const double s = dice_between(&d, -0.2, 1.2), t = dice_between(&d, -0.2, 1.2), when = dice_between(&d, -0.5, 1.5);
    struct crossing_query q = {.from = dice_cube(&d, 100 * LATTICE_CELL), .flip = k & 1};
    q.pivot = point_move(q.from, p);
    q.to = point_move(q.from, m);
    const struct vec3 place = vec3_add(vec3_scale(s, p), vec3_scale((1 - s) * when, m)); /* of the contact */
    q.a = point_move(q.from, vec3_add_scaled(place, -t, g));
    q.b = point_move(q.from, vec3_add_scaled(place, 1 - t, g));
    struct crossing_hit hit;
    if (check_decision(&x, &q, &hit, seed) != EXACT_HIT) {
      misses++;
      continue;
    }
    hits++;
    double time, es, est;
    exact_contact(&x, &time, &es, &est);
    const struct vec3 n = vec3_cross(p, g);
    const double sine = vec3_norm(n) / (vec3_norm(p) * vec3_norm(g)); /* of the angle between the bonds */
    const double steep = fabs(vec3_dot(n, m)) / (vec3_norm(n) * vec3_norm(m));
    worst_time = fmax(worst_time, fabs(hit.time - time) * (1 - es) * vec3_norm(m) * sine * steep);
    worst_place = fmax(worst_place, fmax(fabs(hit.s - es), fabs(hit.s_standing - est)) * sine * sine * steep);
  }
  exact_close(&x);
  print_message("  %lu hits, %lu misses; worst error at right angles: t_I %.2g a0, s and s' %.2g\n",
                (unsigned long)hits, (unsigned long)misses, worst_time, worst_place);
  assert_true(hits > 50000 && misses > 50000);
  assert_close(worst_time, 0.0, 2e-14);
  assert_close(worst_place, 0.0, 2e-13);
}

/* Tiny whole coordinates, where most determinants of chance vanish; and the same blown up and displaced by a unit or
 * two, where they nearly vanish and doubles alone would guess. */
static void degenerate_and_nearly_degenerate_cases(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(903);
  struct dice d = {seed};
  struct exact_test x;
  exact_open(&x);
  uint64_t count[3] = {0}, nearly[3] = {0};
  for (int k = 0; k < 450000; k++) {
    struct crossing_query q = dice_query(&d, 3);
    struct crossing_hit hit;
    if (k % 3) {
      const int64_t factor = (int64_t)1 << dice_integer(&d, 20, 49), jitter = dice_integer(&d, 1, 3);
      struct point *p[] = {&q.from, &q.to, &q.pivot, &q.a, &q.b};
      for (int i = 0; i < 5; i++)
        *p[i] = sum(scaled(*p[i], factor), dice_cube(&d, jitter));
      nearly[check_decision(&x, &q, &hit, seed)]++;
    } else {
      count[check_decision(&x, &q, &hit, seed)]++;
    }
  }
  exact_close(&x);
  print_message("  tiny: %lu misses, %lu touches, %lu hits; nearly degenerate: %lu, %lu, %lu\n",
                (unsigned long)count[EXACT_MISS], (unsigned long)count[EXACT_TOUCH], (unsigned long)count[EXACT_HIT],
                (unsigned long)nearly[EXACT_MISS], (unsigned long)nearly[EXACT_TOUCH],
                (unsigned long)nearly[EXACT_HIT]);
  assert_true(count[EXACT_TOUCH] > 5000 && count[EXACT_HIT] > 500 && nearly[EXACT_HIT] > 3000);
}

/* The sign of the orientation, zeros included, against GMP: tiny, blown up with jitter, and of full size. */
static void orientation_is_exact(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(904);
  struct dice d = {seed};
  struct exact_test x;
  exact_open(&x);
  uint64_t zeros = 0;
  for (int k = 0; k < 300000; k++) {
    struct point p[4];
    for (int i = 0; i < 4; i++) {
      p[i] = dice_cube(&d, k % 3 == 2 ? ((int64_t)1 << 51) - 1 : 3);
      if (k % 3 == 1)
        p[i] = sum(scaled(p[i], (int64_t)1 << (20 + k % 30)), dice_cube(&d, 1));
    }
    if (k % 7 == 3) { /* p[3] in the plane of the others, but for one unit */
      p[3] =
          sum(p[1], (struct point){(p[2].x - p[0].x), (p[2].y - p[0].y), (p[2].z - p[0].z) + dice_integer(&d, -1, 1)});
    }
    int expected = exact_orientation(&x, p[0], p[1], p[2], p[3]);
    const double det = determinant(difference(p[1], p[0]), difference(p[2], p[0]), difference(p[3], p[0]));
    if ((det > 0.0) - (det < 0.0) != expected)
      fail_msg("seed %lu case %d: determinant %g, its sign is %d", (unsigned long)seed, k, det, expected);
    zeros += expected == 0;
  }
  exact_close(&x);
  assert_true(zeros > 5000);
}

/* A straight move cut in two at a lattice point, and a standing bond cut in two: where the whole is clearly hit,
 * exactly one part is, even if the cut is exactly at the point of contact. */
static void parts_add_up_to_the_whole(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(905);
  struct dice d = {seed};
  struct exact_test x;
  exact_open(&x);
  uint64_t wholes = 0, on_the_cut = 0;
  for (int k = 0; k < 600000; k++) {
    struct crossing_query q = dice_query(&d, 3), first, second;
    const bool cut_move = k & 1;
    struct point middle = cut_move ? sum(q.from, q.to) : sum(q.a, q.b);
    struct point *all[] = {&q.from, &q.to, &q.pivot, &q.a, &q.b};
    for (int i = 0; i < 5; i++)
      *all[i] = scaled(*all[i], 2);
    struct crossing_hit hit;
    if (judge(&x, &q) != EXACT_HIT)
      continue;
    first = second = q;
    *(cut_move ? &first.to : &first.b) = middle;
    *(cut_move ? &second.from : &second.a) = middle;
    on_the_cut += judge(&x, &first) == EXACT_TOUCH;
    wholes++;
    int parts = crossing_find(&first, &hit) + crossing_find(&second, &hit);
    if (parts != 1) {
      char text[400];
      describe(&q, text, sizeof text);
      fail_msg("seed %lu: %d parts hit (%s cut): %s", (unsigned long)seed, parts, cut_move ? "move" : "bond", text);
    }
  }
  exact_close(&x);
  assert_true(wholes > 4000 && on_the_cut > 200);
}

/* The vertex that two standing bonds share lies exactly in the swept triangle: if they come from either side the fiber
 * is crossed once, if from the same side no times or twice. */
static void standing_bonds_that_share_a_vertex_agree(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(910);
  struct dice d = {seed};
  struct exact_test x;
  exact_open(&x);
  uint64_t through = 0, grazing = 0;
  for (int k = 0; k < 200000; k++) {
    struct crossing_query first = dice_query(&d, 3), second;
    struct point middle = sum(sum(first.from, first.to), scaled(first.pivot, 2)); /* all coordinates times 4 */
    struct point *all[] = {&first.from, &first.to, &first.pivot};
    for (int i = 0; i < 3; i++)
      *all[i] = scaled(*all[i], 4);
    first.a = sum(middle, dice_cube(&d, 4));
    first.b = middle;
    second = first;
    second.a = middle;
    second.b = sum(middle, dice_cube(&d, 4));
    int side = exact_orientation(&x, first.from, first.to, first.pivot, first.a);
    int other = exact_orientation(&x, first.from, first.to, first.pivot, second.b);
    if (side == 0 || other == 0)
      continue;
    struct crossing_hit hit;
    int hits = crossing_find(&first, &hit) + crossing_find(&second, &hit);
    if (side != other ? hits != 1 : hits == 1)
      fail_msg("seed %lu case %d: %d hits, ends on %s", (unsigned long)seed, k, hits,
               side == other ? "one side" : "two sides");
    through += side != other;
    grazing += side == other;
  }
  exact_close(&x);
  assert_true(through > 10000 && grazing > 10000);
}

/* Both bonds of the moving vertex share its path. A standing bond that runs exactly through the path, between pivots on
 * either side of the plane of path and bond, crosses the fiber once; between pivots on one side it grazes: no times or
 * twice. */
static void bonds_that_share_the_vertex_agree(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(906);
  struct dice d = {seed};
  struct exact_test x;
  exact_open(&x);
  uint64_t through = 0, grazing = 0;
  for (int k = 0; k < 1500000; k++) {
    struct crossing_query before = dice_query(&d, 2);
    before.flip = false;
    struct crossing_query after = before;
    after.pivot = dice_cube(&d, 2);
    after.flip = true; /* the vertex is the first of the bond that follows it */
    /* a bond whose middle is the middle of the path (all coordinates doubled) */
    struct point middle = sum(before.from, before.to), half = dice_cube(&d, 2);
    struct crossing_query *both[] = {&before, &after};
    for (int i = 0; i < 2; i++) {
      both[i]->from = scaled(both[i]->from, 2);
      both[i]->to = scaled(both[i]->to, 2);
      both[i]->pivot = scaled(both[i]->pivot, 2);
      both[i]->a = sum(middle, half);
      both[i]->b = sum(middle, scaled(half, -1));
    }
    int side = exact_orientation(&x, before.from, before.to, before.a, before.pivot);
    int other = exact_orientation(&x, after.from, after.to, after.a, after.pivot);
    if (side == 0 || other == 0)
      continue;
    struct crossing_hit hit;
    int hits = crossing_find(&before, &hit) + crossing_find(&after, &hit);
    if (side != other ? hits != 1 : hits == 1) {
      char text[400];
      describe(&before, text, sizeof text);
      fail_msg("seed %lu: %d hits, pivots on %s: %s", (unsigned long)seed, hits,
               side == other ? "one side" : "two sides", text);
    }
    through += side != other;
    grazing += side == other;
  }
  exact_close(&x);
  assert_true(through > 10000 && grazing > 10000);
}

/* Two moves, of either bond's either end, with the bonds exactly touching in between (volume zero). What is found in
 * all must not change if the touching place is shifted by one unit to either side that counts as the same: zero counts
 * as a positive volume of (j, j+1, k, k+1), whichever bond moves. */
static void successive_moves_agree_about_zero(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(907);
  struct dice d = {seed};
  struct exact_test x;
  exact_open(&x);
  uint64_t seen = 0, crossed = 0;
  for (int k = 0; k < 600000; k++) {
    struct point bond[2][2]; /* bond 0 moves first, bond 1 second */
    for (int i = 0; i < 4; i++)
      bond[i / 2][i % 2] = scaled(dice_cube(&d, 3), (int64_t)1 << 30);
    const int end = (int)(dice_u64(&d) & 1), end2 = (int)(dice_u64(&d) & 1), who2 = (int)(dice_u64(&d) & 1);
    if (exact_orientation(&x, bond[0][0], bond[0][1], bond[1][0], bond[1][1]) != 0)
      continue;
    const struct point start = scaled(dice_cube(&d, 3), (int64_t)1 << 30),
                       finish = scaled(dice_cube(&d, 3), (int64_t)1 << 30);
    int hits[2] = {0, 0};
    bool clean = true;
    for (int shifted = 0; shifted < 2; shifted++) {
      struct point now[2][2];
      memcpy(now, bond, sizeof now);
      struct point *place = &now[0][end];
      if (shifted) { /* a unit along the axis that makes the volume positive */
        int sign = 0;
        for (int axis = 0; axis < 6 && sign <= 0; axis++) {
          *place = bond[0][end];
          *(axis / 2 == 0 ? &place->x : axis / 2 == 1 ? &place->y : &place->z) += axis % 2 ? 1 : -1;
          sign = exact_orientation(&x, now[0][0], now[0][1], now[1][0], now[1][1]);
        }
        clean = clean && sign > 0;
      }
      struct crossing_query one = {start, *place, now[0][1 - end], now[1][0], now[1][1], end == 0};
      struct crossing_query two = {now[who2][end2],  finish,           now[who2][1 - end2],
                                   now[1 - who2][0], now[1 - who2][1], end2 == 0};
      struct crossing_hit hit;
      hits[shifted] = crossing_find(&one, &hit) + 2 * crossing_find(&two, &hit);
      if (shifted)
        clean = clean && judge(&x, &one) != EXACT_TOUCH && judge(&x, &two) != EXACT_TOUCH;
      else /* only the touching itself may be degenerate: everything else about the two moves is not */
        clean = clean && exact_orientation(&x, one.a, one.b, one.from, one.to) &&
                exact_orientation(&x, two.a, two.b, two.from, two.to) &&
                exact_orientation(&x, one.from, one.to, one.pivot, one.a) &&
                exact_orientation(&x, one.from, one.to, one.pivot, one.b) &&
                exact_orientation(&x, two.from, two.to, two.pivot, two.a) &&
                exact_orientation(&x, two.from, two.to, two.pivot, two.b) &&
                exact_orientation(&x, one.a, one.b, one.pivot, one.from) &&
                exact_orientation(&x, two.a, two.b, two.pivot, two.to);
    }
    if (!clean)
      continue;
    seen++;
    crossed += hits[0] > 0;
    if (hits[0] != hits[1])
      fail_msg("seed %lu case %d: hits %d at zero, %d beside it", (unsigned long)seed, k, hits[0], hits[1]);
  }
  exact_close(&x);
  print_message("  %lu pairs of moves with a touch in between, %lu of them crossing\n", (unsigned long)seen,
                (unsigned long)crossed);
  assert_true(seen > 2000 && crossed > 300);
}

static void assert_hits_equal(const struct crossing_hit *a, const struct crossing_hit *b, double tolerance)
{
  assert_close(a->time, b->time, tolerance);
  assert_close(a->s, b->s, tolerance);
  assert_close(a->s_standing, b->s_standing, tolerance);
}

typedef struct point point_map(struct point);

static struct point quarter_about_z(struct point p)
{
  return (struct point){-p.y, p.x, p.z};
}

static struct point third_about_diagonal(struct point p)
{
  return (struct point){p.z, p.x, p.y};
}

static struct point mirror_x(struct point p)
{
  return (struct point){-p.x, p.y, p.z};
}

static struct point shift_far(struct point p)
{
  return (struct point){p.x + 123456789012345, p.y - 987654321098765, p.z + 5};
}

static struct crossing_query mapped(const struct crossing_query *q, point_map *map)
{
  return (struct crossing_query){map(q->from), map(q->to), map(q->pivot), map(q->a), map(q->b), q->flip};
}

static struct vec3 map_vector(struct vec3 v, point_map *map)
{
  /* maps of points, used on a vector through two lattice points */
  struct point o = map((struct point){0, 0, 0});
  struct point p = map((struct point){(int64_t)(v.x * 0x1p45), (int64_t)(v.y * 0x1p45), (int64_t)(v.z * 0x1p45)});
  return (struct vec3){(double)(p.x - o.x) * 0x1p-45, (double)(p.y - o.y) * 0x1p-45, (double)(p.z - o.z) * 0x1p-45};
}

/* THEORY test 7: the same hits after translation, rotation, reflection; with the standing bond named backwards (s'
 * turns to 1-s'); with the move run backwards (t_I turns to 1-t_I). Every decision, and t_I, s, s' to rounding. */
static void symmetries(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(908);
  struct dice d = {seed};
  struct exact_test x;
  exact_open(&x);
  point_map *const maps[] = {shift_far, quarter_about_z, third_about_diagonal, mirror_x};
  uint64_t hits = 0;
  for (int k = 0; k < 150000; k++) {
    struct crossing_query q = dice_query(&d, k % 2 ? 5 : (int64_t)1 << 40);
    if (k % 2) {
      struct point *all[] = {&q.from, &q.to, &q.pivot, &q.a, &q.b};
      for (int i = 0; i < 5; i++)
        *all[i] = scaled(*all[i], (int64_t)1 << 37);
    }
    const enum exact_verdict verdict = judge(&x, &q);
    struct crossing_hit hit, image;
    const bool found = crossing_find(&q, &hit);
    struct vec3 p = point_difference(q.pivot, q.from), m = point_difference(q.to, q.from),
                g = point_difference(q.b, q.a);
    const double time = found ? hit.time : 0.0;
    struct vec3 n = vec3_cross(vec3_add_scaled(p, -time, m), g);
    const double flat = fabs(vec3_dot(n, m)) / (1e-30 + vec3_norm(n) * vec3_norm(m));
    const double sine = vec3_norm(n) / (1e-30 + vec3_norm(p) * vec3_norm(g));
    const bool decent = flat > 0.02 && sine > 0.02;
    for (int i = 0; i < 4; i++) {
      struct crossing_query other = mapped(&q, maps[i]);
      bool again = crossing_find(&other, &image);
      if (verdict == EXACT_TOUCH && i == 3)
        continue; /* a reflection exchanges the sides of a zero */
      assert_true(again == found);
      if (found && decent) {
        assert_hits_equal(&image, &hit, 1e-8);
        assert_close(vec3_norm(vec3_sub(image.normal, map_vector(hit.normal, maps[i]))), 0.0, 1e-8);
      }
      if (found && i == 0)
        assert_memory_equal(&image, &hit, sizeof hit); /* translations are exact */
    }
    if (verdict == EXACT_TOUCH)
      continue;
    struct crossing_query back = q, mirror = q;
    back.a = q.b, back.b = q.a, back.flip = !q.flip;
    mirror.from = q.to, mirror.to = q.from;
    assert_true(crossing_find(&back, &image) == found);
    if (found && decent) {
      image.s_standing = 1.0 - image.s_standing;
      assert_hits_equal(&image, &hit, 1e-8);
    }
    assert_true(crossing_find(&mirror, &image) == found);
    if (found && decent) {
      image.time = 1.0 - image.time;
      assert_hits_equal(&image, &hit, 1e-8);
      assert_close(vec3_norm(vec3_add(image.normal, hit.normal)), 0.0, 1e-8); /* n points the way of the move */
    }
    hits += found;
  }
  exact_close(&x);
  assert_true(hits > 5000);
}

/* By hand: the vertex goes from z = -1 to z = 3 at the origin; the pivot is at (4,0,0); a standing bond along y at
 * x = 1, z = 1 from y = -1 to y = 3. The moving bond is at height z = -1 + 4t at x = 0, 0 at x = 4: 3/4 (-1 + 4t) = 1.
 */
static void crossing_by_hand(void **unused)
{
  (void)unused;
  const int64_t a0 = LATTICE_CELL;
  for (int flip = 0; flip < 2; flip++) {
    const struct crossing_query q = {{0, 0, -a0},   {0, 0, 3 * a0},   {4 * a0, 0, 0},
                                     {a0, -a0, a0}, {a0, 3 * a0, a0}, flip};
    struct crossing_hit hit;
    assert_true(crossing_find(&q, &hit));
    assert_close(hit.time, 7.0 / 12.0, 1e-15);
    assert_close(hit.s, 0.25, 1e-15);
    assert_close(hit.s_standing, 0.25, 1e-15);
    assert_close(hit.normal.x, 1.0 / sqrt(10.0), 1e-15); /* across (4, 0, -4/3) and y, upwards */
    assert_close(hit.normal.y, 0.0, 1e-15);
    assert_close(hit.normal.z, 3.0 / sqrt(10.0), 1e-15);
  }
}

/* No bond, no move, or a move along the bond's own line: nothing is swept, nothing is hit. */
static void nothing_swept_nothing_hit(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(909)};
  for (int k = 0; k < 100000; k++) {
    struct crossing_query q = dice_query(&d, 3);
    struct crossing_hit hit;
    switch (k % 4) {
    case 0:
      q.to = q.from;
      break;
    case 1:
      q.b = q.a;
      break;
    case 2:
      q.pivot = q.from;
      break;
    default: { /* along the bond */
      struct point step = dice_cube(&d, 1);
      q.pivot = sum(q.from, scaled(step, 2));
      q.to = sum(q.from, scaled(step, (int)dice_integer(&d, -3, 3)));
      break;
    }
    }
    assert_false(crossing_find(&q, &hit));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(crossing_by_hand),
      cmocka_unit_test(generic_cases),
      cmocka_unit_test(cases_of_a_run),
      cmocka_unit_test(degenerate_and_nearly_degenerate_cases),
      cmocka_unit_test(orientation_is_exact),
      cmocka_unit_test(parts_add_up_to_the_whole),
      cmocka_unit_test(standing_bonds_that_share_a_vertex_agree),
      cmocka_unit_test(bonds_that_share_the_vertex_agree),
      cmocka_unit_test(successive_moves_agree_about_zero),
      cmocka_unit_test(symmetries),
      cmocka_unit_test(nothing_swept_nothing_hit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

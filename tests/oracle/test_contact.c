/* Rows of `crossing` and `exchange`, columns by name, and tolerances, against GMP (exact.h) and formulas written out
 * here. tests/oracle/test_edges.py does the same from the text of a pack. */
#include "contact/line.h"
#include "exact.h"
#include "oracle/oracle.h"
#include "oracle/pair.h"

static const struct pack_table *table(const struct pack *pack, const char *operator_name, const char *name)
{
  struct pack_place place = {.step = 1};
  snprintf(place.operator_name, sizeof place.operator_name, "%s", operator_name);
  const struct pack_table *t = pack_find(pack, &place, name);
  if (!t)
    fail_msg("no table %s %s", operator_name, name);
  return t;
}

static struct point point_of(const struct pack *pack, const char *name, uint32_t row)
{
  const int64_t *r = &table(pack, "crossing", name)->value.integer[3 * row];
  return (struct point){r[0], r[1], r[2]};
}

static struct vec3 vector_of(const struct pack *pack, const char *name, uint32_t row)
{
  const double *v = &table(pack, "exchange", name)->value.number[3 * row];
  return (struct vec3){v[0], v[1], v[2]};
}

/* The pack of constructed inputs, with the outputs of this code. */
static int make_edges(void **state)
{
  static struct pack pack;
  struct pack kept;
  struct message message;
  *state = &pack;
  const bool ok =
      pack_read("reference-data/edges.pack.h5", &kept, &message) && oracle_answer(&kept, true, &pack, &message);
  if (!ok)
    print_error("%s\n", message.text);
  pack_free(&kept);
  return ok ? 0 : -1;
}

static int free_edges(void **state)
{
  pack_free(*state);
  return 0;
}

/* --- crossing ---------------------------------------------------------------------------------------------------- */

static bool positive(int sign, bool flip)
{
  return flip ? sign > 0 : sign >= 0;
}

/* docs/conventions.md, with GMP's signs. */
static bool crosses(struct exact_test *x, const struct crossing_query *q)
{
  const bool side = positive(exact_orientation(x, q->a, q->b, q->pivot, q->from), q->flip);
  return positive(exact_orientation(x, q->a, q->b, q->pivot, q->to), q->flip) != side &&
         positive(exact_orientation(x, q->a, q->b, q->from, q->to), false) == side &&
         positive(exact_orientation(x, q->pivot, q->from, q->to, q->a), false) !=
             positive(exact_orientation(x, q->pivot, q->from, q->to, q->b), false);
}

static struct crossing_query query_of(const struct pack *pack, uint32_t row)
{
  return (struct crossing_query){.from = point_of(pack, "in.from", row),
                                 .to = point_of(pack, "in.to", row),
                                 .pivot = point_of(pack, "in.pivot", row),
                                 .a = point_of(pack, "in.a", row),
                                 .b = point_of(pack, "in.b", row),
                                 .flip = table(pack, "crossing", "in.flip")->value.integer[row] != 0};
}

static int sign_in_doubles(struct point o, struct point u, struct point v, struct point w)
{
  const struct vec3 p = point_difference(u, o), q = point_difference(v, o), r = point_difference(w, o);
  const double det = r.x * (p.y * q.z - p.z * q.y) + r.y * (p.z * q.x - p.x * q.z) + r.z * (p.x * q.y - p.y * q.x);
  return (det > 0.0) - (det < 0.0);
}

static void verdicts_of_edges(void **state)
{
  const struct pack *pack = *state;
  struct exact_test x;
  uint32_t hits = 0, flips = 0, wrong_signs = 0, zeros = 0;
  exact_open(&x);
  const struct pack_table *found = table(pack, "crossing", "out.crosses"), *how = table(pack, "crossing", "out.hit"),
                          *condition = table(pack, "crossing", "bound.hit");
  assert_int_equal(found->rows, 540);
  for (uint32_t row = 0; row < found->rows; row++) {
    const struct crossing_query q = query_of(pack, row);
    assert_int_equal(found->value.integer[row], crosses(&x, &q));
    hits += found->value.integer[row] != 0;
    flips += q.flip;
    const int exact = exact_orientation(&x, q.a, q.b, q.pivot, q.from);
    zeros += exact == 0;
    wrong_signs += exact != 0 && exact != sign_in_doubles(q.a, q.b, q.pivot, q.from);
    double time, s, s_standing;
    if (exact_crossing(&x, q.from, q.to, q.pivot, q.a, q.b) != EXACT_HIT)
      continue;
    exact_contact(&x, &time, &s, &s_standing);
    const double tolerance = 64.0 * condition->value.number[row] * 0x1p-53, *hit = &how->value.number[6 * row];
    assert_close(hit[0], time, tolerance);
    assert_close(hit[1], s, tolerance);
    assert_close(hit[2], s_standing, tolerance);
  }
  assert_in_range(hits, 200, 400);
  assert_in_range(flips, 200, 340);
  assert_true(wrong_signs >= 40);
  assert_true(zeros >= 40);
  exact_close(&x);
}

/* --- exchange ---------------------------------------------------------------------------------------------------- */

static void exchanges_conserve(void **state)
{
  static const char *const ends[4] = {"moving", "pivot", "a", "b"};
  const struct pack *pack = *state;
  const struct pack_table *mass = table(pack, "exchange", "in.mass"), *dp = table(pack, "exchange", "out.momentum"),
                          *contact = table(pack, "exchange", "in.contact");
  uint32_t unequal = 0;
  for (uint32_t row = 0; row < mass->rows; row++) {
    const struct vec3 n = vector_of(pack, "in.normal", row);
    const double s = contact->value.number[2 * row], t = contact->value.number[2 * row + 1];
    const double lever[4] = {1.0 - s, s, t - 1.0, -t}, *m = &mass->value.number[4 * row];
    double energy = 0.0, approach = 0.0, separate = 0.0, size = 1.0;
    struct vec3 momentum = {0, 0, 0};
    unequal += m[0] != m[1] || m[0] != m[2] || m[0] != m[3];
    for (int k = 0; k < 4; k++) {
      char name[PACK_WORD];
      snprintf(name, sizeof name, "in.%s", ends[k]);
      const struct vec3 before = vector_of(pack, name, row);
      snprintf(name, sizeof name, "out.%s", ends[k]);
      const struct vec3 after = vector_of(pack, name, row), change = vec3_sub(after, before);
      energy += 0.5 * m[k] * (vec3_dot(after, after) - vec3_dot(before, before));
      size += m[k] * (vec3_dot(after, after) + vec3_dot(before, before));
      momentum = vec3_add_scaled(momentum, m[k], change);
      approach += lever[k] * vec3_dot(before, n), separate += lever[k] * vec3_dot(after, n);
      assert_close(m[k] * vec3_dot(change, n), -lever[k] * dp->value.number[row], 1e-13 * size);
    }
    assert_close(energy, 0.0, 1e-13 * size);
    assert_close(vec3_norm(momentum), 0.0, 1e-13 * size);
    assert_close(separate, -approach, 1e-13 * size);
  }
  assert_in_range(unequal, 50, 90);
}

/* --- columns by name --------------------------------------------------------------------------------------------- */

static void put_row(struct pack *pack, const char *name, const char *components, const int64_t *row)
{
  int64_t *to = pack_put_integers(pack, &(struct pack_place){"kick", 1}, name, components, 1);
  memcpy(to, row, pack->table[pack->count - 1].columns * sizeof *row);
}

static void columns_are_aligned(void **state)
{
  static const struct {
    const char *name, *components;
    bool good;
    uint32_t columns;
    int64_t first;
  } cases[] = {{"out.velocity", "x y z", true, 3, 1},   {"out.velocity", "z x y", true, 3, 2},
               {"out.velocity", "y z", true, 2, 1},     {"out.velocity", "x y w", false, 0, 0},
               {"out.velocity", "x y y", false, 0, 0},  {"out.speed", "x y z", false, 0, 0},
               {"bound.velocity", "x y z", true, 3, 1}, {"in.velocity", "x", false, 0, 0}};
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const int64_t values[3] = {1, 2, 3};
    struct pack ours = {0}, theirs = {0};
    struct message message;
    put_row(&ours, "out.velocity", "x y z", values);
    put_row(&theirs, cases[k].name, cases[k].components, values);
    assert_int_equal(oracle_align(&ours, &theirs, &message), cases[k].good);
    if (cases[k].good) {
      assert_int_equal(theirs.table[0].columns, cases[k].columns);
      assert_int_equal(theirs.table[0].value.integer[0], cases[k].first);
    }
    pack_free(&ours);
    pack_free(&theirs);
  }
}

/* --- tolerances -------------------------------------------------------------------------------------------------- */

static void put_row_of_exchange(struct pack *pack, const char *name, const char *components, const double *row)
{
  double *to = pack_put_reals(pack, &(struct pack_place){"exchange", 1}, name, components, 1);
  memcpy(to, row, pack->table[pack->count - 1].columns * sizeof *row);
}

/* Of one exchange with V = (2, 0, 0) and rest, n along x, masses 1, s = s' = 1/2: A = 4, D = 1, E = 2, dP = 2. */
static void tolerances_of_an_exchange(void **state)
{
  static const double fast[3] = {2, 0, 0}, rest[3] = {0, 0, 0}, ones[4] = {1, 1, 1, 1}, half[2] = {0.5, 0.5};
  (void)state;
  struct pack pack = {0};
  put_row_of_exchange(&pack, "in.moving", "x y z", fast);
  put_row_of_exchange(&pack, "in.pivot", "x y z", rest);
  put_row_of_exchange(&pack, "in.a", "x y z", rest);
  put_row_of_exchange(&pack, "in.b", "x y z", rest);
  put_row_of_exchange(&pack, "in.mass", "moving pivot a b", ones);
  put_row_of_exchange(&pack, "in.contact", "s s_standing", half);
  put_row_of_exchange(&pack, "in.normal", "x y z", (const double[3]){1, 0, 0});
  put_row_of_exchange(&pack, "out.momentum", "momentum", (const double[1]){2});
  put_row_of_exchange(&pack, "out.moving", "x y z", (const double[3]){1, 0, 0});
  struct oracle_pair p = {&pack, &pack, NULL, NULL, 0x1p-53, NULL};
  p.ours = p.theirs = table(&pack, "exchange", "out.momentum");
  const double momentum = 26.0 * 4.0 + 2.0 * (8.0 * 2.0 + 20.0);
  assert_close(oracle_tolerance(&p, 0, 0), momentum * 0x1p-53, 1e-20);
  p.ours = p.theirs = table(&pack, "exchange", "out.moving");
  assert_close(oracle_tolerance(&p, 0, 0), (momentum + 18.0 * 2.0 + 4.0 * 2.0) * 0x1p-53, 1e-20);
  p.rounding = 0x1p-24;
  assert_close(oracle_tolerance(&p, 0, 1), (momentum + 18.0 * 2.0) * 0x1p-24, 1e-12);
  pack_free(&pack);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(verdicts_of_edges),
      cmocka_unit_test(exchanges_conserve),
      cmocka_unit_test(columns_are_aligned),
      cmocka_unit_test(tolerances_of_an_exchange),
  };
  return cmocka_run_group_tests(tests, make_edges, free_edges);
}

/* Lattice arithmetic against GMP: rounding, folding, differences, moves, the box. */
#include <fenv.h>

#include "base/lattice.h"
#include "exact.h"

/* C's rint in the default rounding mode: to nearest, ties to even. */
static void rounding_is_to_nearest_even(void **unused)
{
  (void)unused;
  assert_int_equal(fegetround(), FE_TONEAREST);
  const double ties[] = {0.5, 1.5, 2.5, -0.5, -1.5, -2.5, 0x1p50 + 0.5, 0x1p50 + 1.5, -0x1p50 - 0.5, -0x1p50 - 1.5};
  for (size_t k = 0; k < sizeof ties / sizeof *ties; k++)
    assert_true(lattice_round(ties[k]) == (int64_t)rint(ties[k]));
  assert_true(lattice_round(0x1p51 - 1) == (int64_t)0x1p51 - 1);
  assert_true(lattice_round(1 - 0x1p51) == 1 - (int64_t)0x1p51);

  const uint64_t seed = dice_seed(101);
  struct dice d = {seed};
  for (int k = 0; k < 200000; k++) {
    const double size = exp2(dice_between(&d, -2.0, 51.0));
    double x = size * dice_between(&d, -1.0, 1.0);
    if (lattice_round(x) != (int64_t)rint(x))
      fail_msg("seed %lu: lattice_round(%.17g) = %ld", (unsigned long)seed, x, (long)lattice_round(x));
  }
}

/* Every displacement up to the stated limit must convert to within half a unit. */
static void conversion_holds_up_to_the_stated_limit(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(102)};
  for (int k = 0; k < 100000; k++) {
    double a0 = dice_between(&d, -LATTICE_MAX_MOVE, LATTICE_MAX_MOVE);
    assert_close((double)lattice_from_a0(a0), a0 * 0x1p40, 0.5);
  }
  assert_true(lattice_from_a0(LATTICE_MAX_MOVE) == (int64_t)2047 << 40);
  assert_true(lattice_from_a0(-LATTICE_MAX_MOVE) == -((int64_t)2047 << 40));
  assert_true(lattice_from_a0(1.0) == LATTICE_CELL);
}

static void folding_is_floor_division(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(103);
  struct dice d = {seed};
  mpz_t exact;
  mpz_init(exact);
  for (int k = 0; k < 50000; k++) {
    int64_t edge = dice_integer(&d, 1, LATTICE_MAX_EDGE) * LATTICE_CELL;
    const int shift = (int)dice_integer(&d, 3, 60);
    int64_t x = (int64_t)dice_u64(&d) >> shift;
    if (k % 4 == 0) /* around the faces of the images */
      x = (k / 4 % 17 - 8) * edge + dice_integer(&d, -1, 1);
    mpz_set_si(exact, x);
    mpz_fdiv_q_ui(exact, exact, (unsigned long)edge);
    const int64_t image = mpz_get_si(exact);
    assert_true(floor_divide(x, edge) == image); /* what other tests use */
    if (lattice_image(x, edge) != image || lattice_fold(x, edge) != x - image * edge)
      fail_msg("seed %lu: x %ld, edge %ld: image %ld, fold %ld", (unsigned long)seed, (long)x, (long)edge,
               (long)lattice_image(x, edge), (long)lattice_fold(x, edge));
    assert_true(lattice_fold(x, edge) >= 0 && lattice_fold(x, edge) < edge);
  }
  mpz_clear(exact);
}

/* A difference below 2^53 units is a double without rounding, wherever the two points are. */
static void differences_are_exact(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(104)};
  for (int k = 0; k < 100000; k++) {
    int64_t far = dice_integer(&d, -((int64_t)1 << 60), (int64_t)1 << 60);
    int64_t gap[3];
    for (int c = 0; c < 3; c++)
      gap[c] = dice_integer(&d, 1 - ((int64_t)1 << 53), ((int64_t)1 << 53) - 1);
    struct point b = {far, -far, far / 3}, a = {b.x + gap[0], b.y + gap[1], b.z + gap[2]};
    struct vec3 r = point_difference(a, b);
    assert_true((int64_t)(r.x * 0x1p40) == gap[0] && (int64_t)(r.y * 0x1p40) == gap[1] &&
                (int64_t)(r.z * 0x1p40) == gap[2]);
    struct vec3 in_a0 = point_in_a0((struct point){gap[0], gap[1], gap[2]});
    assert_true(in_a0.x == r.x && in_a0.y == r.y && in_a0.z == r.z);
  }
}

static void moves_round_the_displacement_only(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(105)};
  for (int k = 0; k < 100000; k++) {
    const int64_t far = (int64_t)1 << 59;
    struct point a = dice_point(&d, far, far, far);
    struct vec3 v = dice_rod(&d, 0.0, 500.0);
    v.y *= 1e-6;
    struct point b = point_move(a, v);
    assert_close((double)(b.x - a.x), v.x * 0x1p40, 0.5);
    assert_close((double)(b.y - a.y), v.y * 0x1p40, 0.5);
    assert_close((double)(b.z - a.z), v.z * 0x1p40, 0.5);
    struct point back = point_move(b, (struct vec3){-v.x, -v.y, -v.z});
    assert_true(back.x == a.x && back.y == a.y && back.z == a.z); /* rounding is symmetric: a move can be undone */
  }
}

static void box_counts_cells(void **unused)
{
  (void)unused;
  struct box b = box_of_cells(1024, 3, 70);
  assert_true(b.edge[0] == (int64_t)1 << 50 && b.edge[1] == (int64_t)3 << 40 && b.edge[2] == (int64_t)70 << 40);
  assert_true(box_cell_count(&b) == 215040);
  assert_int_equal(box_shortest_edge(&b), 3);
  assert_close(box_volume(&b), 215040.0, 0.0);
  struct box c = box_of_cells(1024, 1024, 1024);
  assert_true(box_cell_count(&c) == (int64_t)1 << 30);
  struct box x = box_of_cells(2, 5, 4), z = box_of_cells(9, 5, 4);
  assert_int_equal(box_shortest_edge(&x), 2);
  assert_int_equal(box_shortest_edge(&z), 4);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rounding_is_to_nearest_even),       cmocka_unit_test(conversion_holds_up_to_the_stated_limit),
      cmocka_unit_test(folding_is_floor_division),         cmocka_unit_test(differences_are_exact),
      cmocka_unit_test(moves_round_the_displacement_only), cmocka_unit_test(box_counts_cells),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Philox at its addresses, uniform and normal deviates, axes, permutations. */
#include "base/normal.h"
#include "exact.h"

/* Known answers of philox4x32 with 10 rounds, published with Random123 (Salmon et al., SC11; file kat_vectors), asked
 * for through the address layout { entity, purpose + 256 draw, step low, step high }. */
static void known_answers(void **unused)
{
  (void)unused;
  const struct {
    uint64_t seed;
    uint32_t purpose, draw;
    uint64_t step;
    uint32_t entity, answer[4];
  } kat[] = {
      {0, 0, 0, 0, 0, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
      {UINT64_MAX, 0xff, 0xffffff, UINT64_MAX, UINT32_MAX, {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
      /* counter 243f6a88 85a308d3 13198a2e 03707344, key a4093822 299f31d0: digits of pi */
      {0x299f31d0a4093822,
       0xd3,
       0x85a308,
       0x0370734413198a2e,
       0x243f6a88,
       {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
  };
  for (int k = 0; k < 3; k++) {
    struct random_words r =
        random_at(kat[k].seed, (enum random_purpose)kat[k].purpose, kat[k].draw, kat[k].step, kat[k].entity);
    for (int i = 0; i < 4; i++)
      assert_int_equal(r.w[i], kat[k].answer[i]);
    assert_true(random_u64(r, 0) == ((uint64_t)kat[k].answer[1] << 32 | kat[k].answer[0]));
    assert_true(random_u64(r, 1) == ((uint64_t)kat[k].answer[3] << 32 | kat[k].answer[2]));
  }
}

static void uniform_is_open_and_centered(void **unused)
{
  (void)unused;
  const struct random_words zeros = {{0, 0, 0, 0}}, ones = {{~0u, ~0u, ~0u, ~0u}};
  for (int k = 0; k < 2; k++) {
    assert_true(random_uniform(zeros, k) == 0x1p-53);
    assert_true(random_uniform(ones, k) == 1.0 - 0x1p-53);
  }
  const struct random_words half = {{0, 0x80000000u, 0, 0x40000000u}};
  assert_true(random_uniform(half, 0) == 0.5 + 0x1p-53 && random_uniform(half, 1) == 0.25 + 0x1p-53);

  enum { N = 200000 };
  double *u = malloc(2 * N * sizeof *u);
  for (uint32_t i = 0; i < N; i++) {
    struct random_words r = random_at(dice_seed(7), RANDOM_SOLVENT_POSITION, 0, 0, i);
    u[2 * i] = random_uniform(r, 0);
    u[2 * i + 1] = random_uniform(r, 1);
  }
  double distance = kolmogorov(u, 2 * N);
  free(u);
  assert_true(distance < KOLMOGOROV_LIMIT);
}

static void normal_deviates(void **unused)
{
  (void)unused;
  enum { N = 200000 };
  double *p = malloc(2 * N * sizeof *p);
  struct tally product = {0}, squares = {0};
  for (uint32_t i = 0; i < N; i++) {
    double z[2];
    random_normal_pair(random_at(dice_seed(8), RANDOM_SOLVENT_VELOCITY, 0, 0, i), z);
    p[2 * i] = gsl_cdf_ugaussian_P(z[0]);
    p[2 * i + 1] = gsl_cdf_ugaussian_P(z[1]);
    tally_add(&product, z[0] * z[1]);
    tally_add(&squares, z[0] * z[0] * z[1] * z[1]);
  }
  double distance = kolmogorov(p, 2 * N);
  free(p);
  assert_true(distance < KOLMOGOROV_LIMIT);
  assert_sigma(tally_mean(&product), tally_error(&product), 0.0, 5.0);
  assert_sigma(tally_mean(&squares), tally_error(&squares), 1.0, 5.0); /* the pair is independent */
}

/* Moments of a uniform unit vector: <n_i n_j> = delta_ij / 3, <n_i^4> = 1/5, <n_i^2 n_j^2> = 1/15; each component is
 * uniform on [-1,1] (Archimedes). An axis from a cube has <n_z^4> = 0.180, one of uniform polar angle <n_z^2> = 1/2. */
static void axes_are_uniform_on_the_sphere(void **unused)
{
  (void)unused;
  enum { N = 400000 };
  const uint64_t seed = dice_seed(9);
  struct tally two[3] = {{0}}, four[3] = {{0}}, cross[3] = {{0}}, mixed[3] = {{0}}, neighbor[2] = {{0}};
  double *flat[3];
  for (int c = 0; c < 3; c++)
    flat[c] = malloc(N * sizeof *flat[c]);
  struct vec3 last = {0, 0, 0};
  for (uint32_t i = 0; i < N; i++) {
    struct vec3 axis = random_axis(seed, RANDOM_ROTATION_AXIS, 5, i),
                later = random_axis(seed, RANDOM_ROTATION_AXIS, 6, i);
    const double n[3] = {axis.x, axis.y, axis.z};
    assert_close(vec3_dot(axis, axis), 1.0, 1e-15);
    for (int c = 0; c < 3; c++) {
      double a = n[c], b = n[(c + 1) % 3];
      tally_add(&two[c], a * a);
      tally_add(&four[c], a * a * a * a);
      tally_add(&cross[c], a * b);
      tally_add(&mixed[c], a * a * b * b);
      flat[c][i] = 0.5 * (1.0 + a);
    }
    tally_add(&neighbor[0], vec3_dot(axis, last)); /* cells are independent, and so are steps */
    tally_add(&neighbor[1], vec3_dot(axis, later));
    last = axis;
  }
  for (int c = 0; c < 3; c++) {
    assert_sigma(tally_mean(&two[c]), tally_error(&two[c]), 1.0 / 3.0, 5.0);
    assert_sigma(tally_mean(&four[c]), tally_error(&four[c]), 0.2, 5.0);
    assert_sigma(tally_mean(&cross[c]), tally_error(&cross[c]), 0.0, 5.0);
    assert_sigma(tally_mean(&mixed[c]), tally_error(&mixed[c]), 1.0 / 15.0, 5.0);
    double distance = kolmogorov(flat[c], N);
    assert_true(distance < KOLMOGOROV_LIMIT);
    free(flat[c]);
  }
  for (int k = 0; k < 2; k++)
    assert_sigma(tally_mean(&neighbor[k]), tally_error(&neighbor[k]), 0.0, 5.0);
}

/* The words outside the disk are passed over in the documented order: words 0, 1, then 2, 3, then the next draw. */
static void axes_take_the_documented_words(void **unused)
{
  (void)unused;
  struct vec3 n = {9, 9, 9};
  const struct random_words corner = {{0x7fffffffu, 0x7fffffffu, 0, 0}}; /* u = v = 1 - 2^-32, outside */
  assert_int_equal(random_axis_from_words(corner, 0, &n), 0);
  assert_int_equal(random_axis_from_words(corner, 1, &n), 1);
  assert_close(n.z, 1.0, 1e-18);

  int from_second = 0, from_later = 0;
  for (uint32_t e = 0; e < 2000; e++) {
    struct vec3 axis = random_axis(3, RANDOM_ROTATION_AXIS, 11, e);
    for (uint32_t k = 0;; k++) {
      struct random_words r = random_at(3, RANDOM_ROTATION_AXIS, k / 2, 11, e);
      double u = ((double)(int32_t)r.w[k % 2 * 2] + 0.5) / 2147483648.0;
      double v = ((double)(int32_t)r.w[k % 2 * 2 + 1] + 0.5) / 2147483648.0;
      if (u * u + v * v >= 1.0)
        continue;
      from_second += k == 1;
      from_later += k > 1;
      assert_close(axis.z, 1.0 - 2.0 * (u * u + v * v), 1e-15);
      assert_close(axis.x * v, axis.y * u, 1e-15); /* the azimuth is that of (u,v) */
      assert_true(axis.x * u >= 0.0 && axis.y * v >= 0.0);
      break;
    }
  }
  assert_true(from_second > 200 && from_later > 40); /* both fallbacks were seen: 1 - pi/4 = 21 %, 4.6 % */
}

/* The definition for ports (random.h), with its 96-bit products in GMP. */
static void permutation_is_as_defined(void **unused)
{
  (void)unused;
  mpz_t product;
  mpz_init(product);
  const uint32_t sizes[] = {1, 2, 3, 4, 5, 10, 257, 1000, 40001};
  for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
    for (uint32_t draw = 0; draw < 2; draw++) {
      const uint32_t n = sizes[s];
      uint32_t *order = malloc(n * sizeof *order), *expected = malloc(n * sizeof *expected);
      random_permutation(77, RANDOM_VERTEX_ORDER, draw, 1u << 20, n, order);
      for (uint32_t k = 0; k < n; k++)
        expected[k] = k;
      for (uint32_t k = n - 1; k >= 1 && n > 1; k--) {
        struct random_words r = random_at(77, RANDOM_VERTEX_ORDER, draw, 1u << 20, k / 2);
        mpz_set_ui(product, (unsigned long)random_u64(r, (int)(k % 2)));
        mpz_mul_ui(product, product, k + 1ul);
        mpz_fdiv_q_2exp(product, product, 64);
        uint32_t j = (uint32_t)mpz_get_ui(product), swap = expected[k];
        assert_true(j <= k);
        expected[k] = expected[j];
        expected[j] = swap;
      }
      assert_memory_equal(order, expected, n * sizeof *order);
      free(order);
      free(expected);
    }
  mpz_clear(product);
  random_permutation(77, RANDOM_VERTEX_ORDER, 0, 0, 0, NULL); /* nothing to do, nothing touched */
}

/* What is shuffled may be anything. */
static void entries_are_shuffled_as_numbers_are(void **unused)
{
  (void)unused;
  enum { N = 1001 };
  uint32_t order[N], entry[N];
  for (uint32_t k = 0; k < N; k++)
    entry[k] = 7 * k + 3;
  random_permutation(77, RANDOM_VELOCITY_SWAP, 0, 5, N, order);
  random_shuffle(77, RANDOM_VELOCITY_SWAP, 0, 5, N, entry);
  for (uint32_t k = 0; k < N; k++)
    assert_int_equal(entry[k], 7 * order[k] + 3);
}

/* Counts of all n! orders; the naive shuffle (j among all n each time) gives 4/27 and 5/27 for n = 3 and fails. */
static void permutations_are_equally_likely(void **unused)
{
  (void)unused;
  for (uint32_t n = 3; n <= 4; n++) {
    uint64_t count[24] = {0};
    size_t orders = n == 3 ? 6 : 24;
    for (uint64_t step = 0; step < 1000000; step++) {
      uint32_t order[4], rank = 0;
      random_permutation(dice_seed(10), RANDOM_VERTEX_ORDER, 0, step, n, order);
      for (uint32_t k = 0; k < n; k++) {
        uint32_t smaller = 0;
        for (uint32_t m = k + 1; m < n; m++)
          smaller += order[m] < order[k];
        rank = rank * (n - k) + smaller;
      }
      count[rank]++;
    }
    double chance = equal_chances(count, orders);
    print_message("  %zu orders: chance %.3g\n", orders, chance);
    assert_true(chance > LEAST_CHANCE);
  }
}

/* In a long permutation every place holds every entry equally often, and sweeps 0 and 1 of a step are unrelated. */
static void long_permutations_mix(void **unused)
{
  (void)unused;
  enum { N = 20, STEPS = 40000 };
  uint64_t at[N * N] = {0}, both[N * N] = {0};
  for (uint64_t step = 0; step < STEPS; step++) {
    uint32_t a[N], b[N];
    random_permutation(dice_seed(11), RANDOM_VERTEX_ORDER, 0, step, N, a);
    random_permutation(dice_seed(11), RANDOM_VERTEX_ORDER, 1, step, N, b);
    for (uint32_t k = 0; k < N; k++)
      at[k * N + a[k]]++;
    both[a[0] * N + b[0]]++;
  }
  /* a doubly stochastic table has (N-1)^2 degrees of freedom, and each row is a full trial: chi^2 scales by N/(N-1) */
  double chi2 = 0.0, expected = (double)STEPS / N;
  for (int k = 0; k < N * N; k++)
    chi2 += ((double)at[k] - expected) * ((double)at[k] - expected) / expected;
  double chance = gsl_cdf_chisq_Q(chi2 * (N - 1) / N, (N - 1.0) * (N - 1.0));
  assert_true(chance > LEAST_CHANCE && chance < 1.0 - LEAST_CHANCE);
  assert_true(equal_chances(both, N * N) > LEAST_CHANCE);
}

/* No two purposes, draws, steps, entities or seeds share words. */
static void addresses_are_distinct(void **unused)
{
  (void)unused;
  struct random_words base = random_at(5, RANDOM_ROTATION_AXIS, 0, 9, 4);
  const struct random_words others[] = {
      random_at(6, RANDOM_ROTATION_AXIS, 0, 9, 4),  random_at(5 + ((uint64_t)1 << 32), RANDOM_ROTATION_AXIS, 0, 9, 4),
      random_at(5, RANDOM_VERTEX_ORDER, 0, 9, 4),   random_at(5, RANDOM_ROTATION_AXIS, 1, 9, 4),
      random_at(5, RANDOM_ROTATION_AXIS, 0, 10, 4), random_at(5, RANDOM_ROTATION_AXIS, 0, 9 + ((uint64_t)1 << 32), 4),
      random_at(5, RANDOM_ROTATION_AXIS, 0, 9, 5),
  };
  for (size_t k = 0; k < sizeof others / sizeof *others; k++)
    assert_memory_not_equal(&base, &others[k], sizeof base);
}

/* Made in columns, words and axes are those of one at a time, to the bit, for any number and any entities. */
static void columns_are_the_same(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(1)};
  uint32_t entity[RANDOM_AXES], w[4][RANDOM_AXES], *columns[4] = {w[0], w[1], w[2], w[3]}, second = 0, later = 0;
  struct vec3 axis[RANDOM_AXES];
  for (uint32_t n = 0; n <= RANDOM_AXES; n++) {
    const uint64_t seed = dice_u64(&d), step = dice_u64(&d);
    for (uint32_t k = 0; k < n; k++)
      entity[k] = (uint32_t)dice_u64(&d);
    random_columns(seed, RANDOM_ROTATION_AXIS, n, step, entity, n, columns);
    random_axes(seed, RANDOM_ROTATION_AXIS, step, entity, n, axis);
    for (uint32_t k = 0; k < n; k++) {
      const struct random_words one = random_at(seed, RANDOM_ROTATION_AXIS, n, step, entity[k]);
      for (int i = 0; i < 4; i++)
        assert_true(one.w[i] == w[i][k]);
      struct vec3 same = random_axis(seed, RANDOM_ROTATION_AXIS, step, entity[k]), first;
      assert_memory_equal(&same, &axis[k], sizeof same);
      const struct random_words words = random_at(seed, RANDOM_ROTATION_AXIS, 0, step, entity[k]);
      const bool outside = !random_axis_from_words(words, 0, &first);
      second += outside;
      later += outside && !random_axis_from_words(words, 1, &first);
    }
  }
  assert_true(second > 350 && later > 50); /* of 2080: a share 0.215 and 0.046 */
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(known_answers),
      cmocka_unit_test(uniform_is_open_and_centered),
      cmocka_unit_test(normal_deviates),
      cmocka_unit_test(axes_are_uniform_on_the_sphere),
      cmocka_unit_test(axes_take_the_documented_words),
      cmocka_unit_test(columns_are_the_same),
      cmocka_unit_test(permutation_is_as_defined),
      cmocka_unit_test(entries_are_shuffled_as_numbers_are),
      cmocka_unit_test(permutations_are_equally_likely),
      cmocka_unit_test(long_permutations_mix),
      cmocka_unit_test(addresses_are_distinct),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

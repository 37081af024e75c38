/* Logarithm, exponential, cosine, sine, error function against MPFR; their bits; normal deviates. */
#include "base/elementary.h"

#include <mpfr.h>
#include <xxhash.h>

#include "base/elementary_lanes.h"
#include "base/normal.h"
#include "exact.h"

enum { PRECISION = 128 }; /* bits of the reference */

/* --- the functions, and what MPFR says of them -------------------------------------------------------------------- */

static double turns_cosine(double u)
{
  return elementary_circle_turns(u).cosine;
}

static double turns_sine(double u)
{
  return elementary_circle_turns(u).sine;
}

static double degrees_cosine(double angle)
{
  return elementary_circle_degrees(angle).cosine;
}

static double degrees_sine(double angle)
{
  return elementary_circle_degrees(angle).sine;
}

/* Inline functions have no address of their own that a compiler could not see through. */
static double logarithm(double x)
{
  return elementary_log(x);
}

static double exponential(double x)
{
  return elementary_exp(x);
}

static void exact_log(mpfr_t out, const mpfr_t x)
{
  mpfr_log(out, x, MPFR_RNDN);
}

static void exact_exp(mpfr_t out, const mpfr_t x)
{
  mpfr_exp(out, x, MPFR_RNDN);
}

static void exact_turns_cosine(mpfr_t out, const mpfr_t x)
{
  mpfr_cosu(out, x, 1, MPFR_RNDN);
}

static void exact_turns_sine(mpfr_t out, const mpfr_t x)
{
  mpfr_sinu(out, x, 1, MPFR_RNDN);
}

static void exact_degrees_cosine(mpfr_t out, const mpfr_t x)
{
  mpfr_cosu(out, x, 360, MPFR_RNDN);
}

static void exact_degrees_sine(mpfr_t out, const mpfr_t x)
{
  mpfr_sinu(out, x, 360, MPFR_RNDN);
}

static void exact_erf(mpfr_t out, const mpfr_t x)
{
  mpfr_erf(out, x, MPFR_RNDN);
}

enum { LOG, EXP, TURNS_COSINE, TURNS_SINE, DEGREES_COSINE, DEGREES_SINE, ERF, FUNCTIONS };

/* The error that elementary.h states for each, in units in the last place. */
static const struct {
  const char *name;
  double (*ours)(double);
  void (*exact)(mpfr_t, const mpfr_t);
  double allowed;
} functions[FUNCTIONS] = {
    [LOG] = {"log", logarithm, exact_log, 1.0},
    [EXP] = {"exp", exponential, exact_exp, 1.0},
    [TURNS_COSINE] = {"cosine of turns", turns_cosine, exact_turns_cosine, 1.0},
    [TURNS_SINE] = {"sine of turns", turns_sine, exact_turns_sine, 1.0},
    [DEGREES_COSINE] = {"cosine of degrees", degrees_cosine, exact_degrees_cosine, 1.0},
    [DEGREES_SINE] = {"sine of degrees", degrees_sine, exact_degrees_sine, 1.0},
    [ERF] = {"erf", elementary_erf, exact_erf, 2.0},
};

/* Error of `ours` in units in the last place of the exact result: 2^(e-53) for one in [2^(e-1), 2^e). Where the exact
 * result is 0, ours must be +0. */
static double ulps(double ours, mpfr_t exact)
{
  if (mpfr_zero_p(exact))
    return ours == 0.0 && !signbit(ours) ? 0.0 : INFINITY;
  if (!isfinite(ours))
    return INFINITY;
  const mpfr_exp_t e = mpfr_get_exp(exact);
  mpfr_sub_d(exact, exact, ours, MPFR_RNDN);
  mpfr_mul_2si(exact, exact, 53 - e, MPFR_RNDN);
  return fabs(mpfr_get_d(exact, MPFR_RNDN));
}

struct worst {
  double error, at;
};

static void look(int function, double x, struct worst *worst)
{
  mpfr_t argument, exact;
  mpfr_init2(argument, 53);
  mpfr_init2(exact, PRECISION);
  mpfr_set_d(argument, x, MPFR_RNDN);
  functions[function].exact(exact, argument);
  const double error = ulps(functions[function].ours(x), exact);
  if (!(error <= worst->error))
    *worst = (struct worst){error, x};
  mpfr_clears(argument, exact, (mpfr_ptr)NULL);
}

static void judge(int function, const char *where, struct worst worst)
{
  print_message("  %-18s %-34s %.4f ulp at %.17g (%a)\n", functions[function].name, where, worst.error, worst.at,
                worst.at);
  if (!(worst.error <= functions[function].allowed))
    fail_msg("%s: %.4f ulp at %.17g, allowed: %g", functions[function].name, worst.error, worst.at,
             functions[function].allowed);
}

/* --- arguments ---------------------------------------------------------------------------------------------------- */

/* The uniform deviates of random.h: odd multiples of 2^-53 in (0,1). */
static double unit_open(struct dice *d)
{
  return ((double)(dice_u64(d) >> 12) + 0.5) * 0x1p-52;
}

/* Of either sign, of any magnitude from 2^low to 2^high. */
static double any_magnitude(struct dice *d, int low, int high)
{
  const double size = ldexp(1.0 + dice_uniform(d), (int)dice_integer(d, low, high - 1));
  return dice_u64(d) & 1 ? -size : size;
}

/* Beside x at a distance of one unit in the last place to an eighth of x. */
static double beside(struct dice *d, double x)
{
  const double step = ldexp(1.0 + dice_uniform(d), (int)dice_integer(d, 0, 49)) * 0x1p-53 * fmax(fabs(x), 0x1p-20);
  return dice_u64(d) & 1 ? x - step : x + step;
}

static double any_normal(struct dice *d)
{
  return fabs(any_magnitude(d, -1022, 1023));
}

static double near_one(struct dice *d)
{
  return beside(d, 1.0);
}

static double octave(struct dice *d)
{
  return dice_between(d, 0.5, 2.0);
}

/* Where the significand passes sqrt(1/2) and the exponent changes. */
static double near_root_half(struct dice *d)
{
  return ldexp(beside(d, 0.70710678118654752), (int)dice_integer(d, -60, 60));
}

static double exponents(struct dice *d)
{
  return dice_between(d, -708.0, 709.0);
}

static double small(struct dice *d)
{
  return any_magnitude(d, -1000, 0);
}

/* Where the multiple of ln 2 changes. */
static double near_half_ln2(struct dice *d)
{
  return beside(d, ((double)dice_integer(d, -900, 900) + 0.5) * 0.69314718055994531);
}

static double turns(struct dice *d)
{
  return dice_between(d, -4.0, 4.0);
}

static double near_octant(struct dice *d)
{
  return beside(d, (double)dice_integer(d, -64, 64) * 0.125);
}

static double huge(struct dice *d)
{
  return any_magnitude(d, 2, 49);
}

static double angles(struct dice *d)
{
  return dice_between(d, -720.0, 720.0);
}

static double whole_angles(struct dice *d)
{
  return (double)dice_integer(d, -3600, 3600) * 0.5;
}

static double near_multiple_of_45(struct dice *d)
{
  return beside(d, (double)dice_integer(d, -64, 64) * 45.0);
}

static double erf_range(struct dice *d)
{
  return dice_between(d, -6.5, 6.5);
}

static double near_joint(struct dice *d)
{
  return beside(d, dice_u64(d) & 1 ? 0.875 : 6.0);
}

/* The largest error over many arguments of each kind. */
static void error_is_as_stated(void **unused)
{
  (void)unused;
  const struct {
    int function;
    const char *where;
    double (*argument)(struct dice *);
  } rows[] = {
      {LOG, "uniform deviates", unit_open},
      {LOG, "all normal numbers", any_normal},
      {LOG, "[1/2, 2)", octave},
      {LOG, "beside 1", near_one},
      {LOG, "beside sqrt(1/2) 2^k", near_root_half},
      {EXP, "[-708, 709)", exponents},
      {EXP, "[-4, 4)", turns},
      {EXP, "small", small},
      {EXP, "beside odd multiples of ln 2 / 2", near_half_ln2},
      {TURNS_COSINE, "uniform deviates", unit_open},
      {TURNS_COSINE, "[-4, 4)", turns},
      {TURNS_COSINE, "beside multiples of 1/8", near_octant},
      {TURNS_COSINE, "small", small},
      {TURNS_COSINE, "huge", huge},
      {TURNS_SINE, "uniform deviates", unit_open},
      {TURNS_SINE, "[-4, 4)", turns},
      {TURNS_SINE, "beside multiples of 1/8", near_octant},
      {TURNS_SINE, "small", small},
      {TURNS_SINE, "huge", huge},
      {DEGREES_COSINE, "[-720, 720)", angles},
      {DEGREES_COSINE, "multiples of 1/2", whole_angles},
      {DEGREES_COSINE, "beside multiples of 45", near_multiple_of_45},
      {DEGREES_COSINE, "huge", huge},
      {DEGREES_SINE, "[-720, 720)", angles},
      {DEGREES_SINE, "multiples of 1/2", whole_angles},
      {DEGREES_SINE, "beside multiples of 45", near_multiple_of_45},
      {DEGREES_SINE, "small", small},
      {DEGREES_SINE, "huge", huge},
      {ERF, "[-6.5, 6.5)", erf_range},
      {ERF, "[1/2, 2)", octave},
      {ERF, "small", small},
      {ERF, "beside 7/8 and 6", near_joint},
  };
  const char *wanted = getenv("UNCROSS_TEST_ARGUMENTS"); /* of each kind */
  const long arguments = wanted ? atol(wanted) : 20000;
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    struct dice d = {dice_seed(100 + k)};
    struct worst worst = {0.0, 0.0};
    for (long n = 0; n < arguments; n++)
      look(rows[k].function, rows[k].argument(&d), &worst);
    judge(rows[k].function, rows[k].where, worst);
  }
}

/* Single arguments at the ends of the ranges and on either side of each place where a formula changes. */
static void error_at_the_ends(void **unused)
{
  (void)unused;
  const struct {
    int function;
    double x;
  } rows[] = {
      {LOG, DBL_MIN},    {LOG, DBL_MAX},
      {LOG, 0x1p-53},    {LOG, 1.0 - 0x1p-53},
      {LOG, 0x1p-52},    {LOG, 1.0 + 0x1p-52},
      {LOG, 2.0},        {LOG, 0x1.6a09e667f3bccp-1},
      {LOG, 0.5},        {LOG, 0x1.6a09e667f3bcdp-1},
      {EXP, -708.0},     {EXP, 709.0},
      {EXP, 0x1p-1022},  {EXP, -0x1p-54},
      {EXP, 1.0},        {EXP, -1.0},
      {ERF, 0x1p-1000},  {ERF, 6.0},
      {ERF, -0x1p-1000}, {ERF, 0x1.7ffffffffffffp+2},
      {ERF, 0.875},      {ERF, 0x1.bffffffffffffp-1},
  };
  const double circle[] = {0x1p-53, 1.0 - 0x1p-53, 0x1p-1000, 0x1p49, 0x1p49 - 0.0625, 0.125, 0.375, 0.625, 0.875};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    struct worst worst = {0.0, 0.0};
    look(rows[k].function, rows[k].x, &worst);
    assert_true(worst.error <= functions[rows[k].function].allowed);
  }
  for (int function = TURNS_COSINE; function <= DEGREES_SINE; function++)
    for (size_t k = 0; k < sizeof circle / sizeof *circle; k++)
      for (int side = -1; side <= 1; side++)
        for (int sign = -1; sign <= 1; sign += 2) {
          struct worst worst = {0.0, 0.0};
          const double x = circle[k] >= 0.125 && circle[k] < 1.0 ? nextafter(circle[k], side * 2.0) : circle[k];
          look(function, sign * x, &worst);
          assert_true(worst.error <= functions[function].allowed);
        }
}

/* The constants and their remainders, to 2^-80 of themselves, which no error of a result would show; how many bits the
 * first parts have. */
static void constants_are_exact(void **unused)
{
  (void)unused;
  mpfr_t ln2, quarter, degree;
  mpfr_inits2(200, ln2, quarter, degree, (mpfr_ptr)NULL);
  mpfr_const_log2(ln2, MPFR_RNDN);
  mpfr_const_pi(quarter, MPFR_RNDN);
  mpfr_div_ui(degree, quarter, 180, MPFR_RNDN);
  mpfr_div_2ui(quarter, quarter, 1, MPFR_RNDN);
  const struct {
    mpfr_ptr exact;
    double high, rest;
    int bits, precision;
  } rows[] = {{ln2, ELEMENTARY_LN2, ELEMENTARY_LN2_REST, 42, 95},
              {quarter, ELEMENTARY_QUARTER, ELEMENTARY_QUARTER_REST, 27, 80},
              {degree, ELEMENTARY_DEGREE, ELEMENTARY_DEGREE_REST, 27, 80}};
  for (int k = 0; k < 3; k++) {
    assert_true((elementary_bits(rows[k].high) & (((uint64_t)1 << (53 - rows[k].bits)) - 1)) == 0);
    mpfr_sub_d(rows[k].exact, rows[k].exact, rows[k].high, MPFR_RNDN);
    mpfr_sub_d(rows[k].exact, rows[k].exact, rows[k].rest, MPFR_RNDN);
    assert_true(fabs(mpfr_get_d(rows[k].exact, MPFR_RNDN)) < ldexp(rows[k].high, -rows[k].precision));
  }
  mpfr_clears(ln2, quarter, degree, (mpfr_ptr)NULL);
}

/* --- exact values ------------------------------------------------------------------------------------------------- */

static bool is_bits(double x, double expected)
{
  return elementary_bits(x) == elementary_bits(expected);
}

static void exact_values(void **unused)
{
  (void)unused;
  assert_true(is_bits(elementary_log(1.0), 0.0));
  assert_true(is_bits(elementary_exp(0.0), 1.0) && is_bits(elementary_exp(-0.0), 1.0));
  assert_true(is_bits(elementary_exp(nextafter(-708.0, -800.0)), 0.0) && is_bits(elementary_exp(-INFINITY), 0.0));
  assert_true(is_bits(elementary_exp(-1e300), 0.0) && elementary_exp(1e300) == INFINITY);
  assert_true(elementary_exp(nextafter(709.0, 800.0)) == INFINITY && elementary_exp(INFINITY) == INFINITY);
  assert_true(isnan(elementary_exp(NAN)));
  assert_true(elementary_exp(-708.0) >= DBL_MIN && elementary_exp(709.0) <= DBL_MAX);
  assert_true(is_bits(elementary_erf(0.0), 0.0) && elementary_erf(INFINITY) == 1.0 &&
              elementary_erf(-INFINITY) == -1.0);

  const double cycle[4] = {1.0, 0.0, -1.0, 0.0};
  for (int64_t k = -4000; k <= 4000; k++) {
    const struct circle_point turns = elementary_circle_turns(0.25 * (double)k);
    const struct circle_point degrees = elementary_circle_degrees(90.0 * (double)k);
    const double cosine = cycle[k & 3], sine = cycle[(k + 3) & 3];
    assert_true(is_bits(turns.cosine, cosine) && is_bits(turns.sine, sine));
    assert_true(is_bits(degrees.cosine, cosine) && is_bits(degrees.sine, sine));
  }
  const struct circle_point zero = elementary_circle_turns(-0.0);
  assert_true(is_bits(zero.cosine, 1.0) && is_bits(zero.sine, 0.0));
}

/* A turn more changes nothing, a sign changes the sine's; a quarter more exchanges the two (but at odd eighths, which
 * are reduced to an eighth to one side only). Arguments are multiples of 2^-48, so that sums are exact. */
static void symmetries_hold_to_the_bit(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(140)};
  for (int k = 0; k < 100000; k++) {
    const double u = (double)(dice_u64(&d) >> 16) * 0x1p-48;
    const struct circle_point p = elementary_circle_turns(u), minus = elementary_circle_turns(-u);
    const struct circle_point more = elementary_circle_turns(u + 3.0), quarter = elementary_circle_turns(u + 0.25);
    assert_true(is_bits(more.cosine, p.cosine) && is_bits(more.sine, p.sine));
    assert_true(minus.cosine == p.cosine && minus.sine == -p.sine);
    assert_true(fmod(u, 0.25) == 0.125 || (quarter.cosine == -p.sine && quarter.sine == p.cosine));
    const double x = any_magnitude(&d, -60, 3);
    assert_true(elementary_erf(-x) == -elementary_erf(x));
  }
}

/* --- the same bits ------------------------------------------------------------------------------------------------ */

enum { GOLDEN = 65536 };

/* Arguments of the golden outputs, from one uniform deviate r 2^-53 each, by operations that every machine rounds
 * alike. The logarithm takes the uniform deviates of random.h and all normal numbers in turn. */
static double golden_argument(int function, uint64_t r, int k)
{
  const double u = (double)(r >> 11) * 0x1p-53;
  const double range[FUNCTIONS][2] = {[EXP] = {-708.0, 1417.0},          [TURNS_COSINE] = {-8.0, 16.0},
                                      [TURNS_SINE] = {-8.0, 16.0},       [DEGREES_COSINE] = {-720.0, 1440.0},
                                      [DEGREES_SINE] = {-720.0, 1440.0}, [ERF] = {-8.0, 16.0}};
  if (function == LOG)
    return k % 2 ? elementary_from_bits(0x0010000000000000 + r % 0x7fe0000000000000)
                 : ((double)(r >> 12) + 0.5) * 0x1p-52;
  return range[function][0] + range[function][1] * u;
}

/* XXH64 of the outputs, doubles in little-endian order. Not from an independent source, but the same of gcc and clang,
 * at every optimisation level and instruction set, and of the port to NumPy (ports/numpy/check-elementary reads this
 * table). A change here is a change of the dynamics of every scene. */
static const struct {
  const char *name;
  uint64_t hash;
} golden[FUNCTIONS + 2] = {
    {"log", 0xe1bd1b39893d79a0},
    {"exp", 0x81e2a043b8e7a65c},
    {"turns cosine", 0x22f99b2f8f8fdc92},
    {"turns sine", 0x691a9e54c31666ac},
    {"degrees cosine", 0xefd54864601c0314},
    {"degrees sine", 0x8c1b121c3ffec114},
    {"erf", 0xc143c465bf2eb8f7},
    {"normals", 0x576ac4e2d8cd3c0c},
    {"three normals", 0x118fad1452bb7bf9},
};

static void of_two_draws(uint64_t seed, uint64_t step, const uint32_t *entity, uint32_t n, double *x, double *y,
                         double *z)
{
  random_normal_columns(seed, RANDOM_SOLVENT_VELOCITY, step, entity, n, x, y, z);
}

static void of_one_draw(uint64_t seed, uint64_t step, const uint32_t *entity, uint32_t n, double *x, double *y,
                        double *z)
{
  random_normal_three_columns(seed, RANDOM_SOLVENT_VELOCITY, 0, step, entity, n, x, y, z);
}

/* Three columns of normal deviates, of two draws and of one. */
static void (*const normals_of[2])(uint64_t, uint64_t, const uint32_t *, uint32_t, double *, double *,
                                   double *) = {of_two_draws, of_one_draw};

static void golden_outputs(void **unused)
{
  (void)unused;
  static double out[3 * GOLDEN];
  static uint32_t entity[GOLDEN];
  int wrong = 0;
  for (int function = 0; function <= FUNCTIONS + 1; function++) {
    struct dice d = {1};
    size_t n = GOLDEN;
    for (int k = 0; k < GOLDEN && function < FUNCTIONS; k++)
      out[k] = functions[function].ours(golden_argument(function, dice_u64(&d), k));
    if (function >= FUNCTIONS) {
      n = 3 * GOLDEN;
      for (uint32_t k = 0; k < GOLDEN; k++)
        entity[k] = 7 * k;
      normals_of[function - FUNCTIONS](0x123456789abcdef0, (uint64_t)1 << 40, entity, GOLDEN, out, out + GOLDEN,
                                       out + 2 * GOLDEN);
    }
    const uint64_t hash = XXH64(out, n * sizeof *out, 0);
    print_message("  {\"%s\", 0x%016llx}\n", golden[function].name, (unsigned long long)hash);
    wrong += hash != golden[function].hash;
  }
  assert_int_equal(wrong, 0);
}

/* Loops over columns as a compiler makes them vector code, with a remainder. */
enum { COLUMN = 1003 };

static void log_column(const double *restrict x, uint32_t n, double *restrict out)
{
  for (uint32_t k = 0; k < n; k++)
    out[k] = elementary_log(x[k]);
}

static void exp_column(const double *restrict x, uint32_t n, double *restrict out)
{
  for (uint32_t k = 0; k < n; k++)
    out[k] = elementary_exp(x[k]);
}

static void turns_cosine_column(const double *restrict x, uint32_t n, double *restrict out)
{
  for (uint32_t k = 0; k < n; k++)
    out[k] = elementary_circle_turns(x[k]).cosine;
}

static void turns_sine_column(const double *restrict x, uint32_t n, double *restrict out)
{
  for (uint32_t k = 0; k < n; k++)
    out[k] = elementary_circle_turns(x[k]).sine;
}

static void log_lanes(const double *restrict x, uint32_t n, double *restrict out)
{
  for (uint32_t k = 0; k < n; k += LANES)
    store_reals(&out[k], elementary_log_lanes(load_reals(&x[k])));
}

static void cosine_lanes(const double *restrict x, uint32_t n, double *restrict out)
{
  for (uint32_t k = 0; k < n; k += LANES)
    store_reals(&out[k], elementary_cosine_turns_lanes(load_reals(&x[k])));
}

/* In loops that vectorise, and several in one register (elementary_lanes.h). */
static void columns_are_the_same(void **unused)
{
  (void)unused;
  const struct {
    int function;
    void (*column)(const double *restrict, uint32_t, double *restrict);
  } rows[] = {{LOG, log_column},
              {EXP, exp_column},
              {TURNS_COSINE, turns_cosine_column},
              {TURNS_SINE, turns_sine_column},
              {LOG, log_lanes},
              {TURNS_COSINE, cosine_lanes}};
  static double x[COLUMN + LANES], out[COLUMN + LANES]; /* to the end of a register */
  double (*volatile one)(double);
  for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
    struct dice d = {dice_seed(160 + r)};
    for (int k = 0; k < COLUMN; k++)
      x[k] = golden_argument(rows[r].function, dice_u64(&d), k);
    rows[r].column(x, COLUMN, out);
    one = functions[rows[r].function].ours;
    for (int k = 0; k < COLUMN; k++)
      assert_true(is_bits(out[k], one(x[k])));
  }
}

/* --- normal deviates ---------------------------------------------------------------------------------------------- */

static void normal_columns_are_the_same(void **unused)
{
  (void)unused;
  enum { MOST = 200 };
  struct dice d = {dice_seed(170)};
  uint32_t entity[MOST];
  double x[MOST + 1], y[MOST + 1], z[MOST + 1];
  for (uint32_t n = 0; n <= MOST; n++) {
    const uint64_t seed = dice_u64(&d), step = dice_u64(&d);
    for (uint32_t k = 0; k < n; k++)
      entity[k] = (uint32_t)dice_u64(&d);
    x[n] = y[n] = z[n] = 77.0;
    random_normal_columns(seed, RANDOM_PHANTOM_VELOCITY, step, entity, n, x, y, z);
    assert_true(x[n] == 77.0 && y[n] == 77.0 && z[n] == 77.0); /* nothing is written beyond the end */
    for (uint32_t k = 0; k < n; k++) {
      double a[2], b[2];
      random_normal_pair(random_at(seed, RANDOM_PHANTOM_VELOCITY, 0, step, entity[k]), a);
      random_normal_pair(random_at(seed, RANDOM_PHANTOM_VELOCITY, 1, step, entity[k]), b);
      assert_true(is_bits(x[k], a[0]) && is_bits(y[k], a[1]) && is_bits(z[k], b[0]));
    }
  }
}

/* Box and Muller's formula in MPFR, from the words. In relative errors of u = 2^-53: 2 u of the logarithm are u of the
 * radius, the root adds u, the circle 2 u, the product u. That is 5 ulp at most. Words at the ends: the radius is at
 * most 8.57. */
static void normal_pair_is_as_defined(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(171)};
  mpfr_t radius, exact, v;
  mpfr_inits2(PRECISION, radius, exact, v, (mpfr_ptr)NULL);
  double worst = 0.0;
  for (int k = 0; k < 20000; k++) {
    struct random_words r;
    for (int i = 0; i < 4; i++)
      r.w[i] = k < 16 ? (k >> i & 1 ? ~0u : 0u) : (uint32_t)dice_u64(&d);
    double out[2];
    random_normal_pair(r, out);
    mpfr_set_d(radius, random_uniform(r, 0), MPFR_RNDN);
    mpfr_log(radius, radius, MPFR_RNDN);
    mpfr_mul_si(radius, radius, -2, MPFR_RNDN);
    mpfr_sqrt(radius, radius, MPFR_RNDN);
    mpfr_set_d(v, random_uniform(r, 1), MPFR_RNDN);
    for (int i = 0; i < 2; i++) {
      (i ? mpfr_sinu : mpfr_cosu)(exact, v, 1, MPFR_RNDN);
      mpfr_mul(exact, exact, radius, MPFR_RNDN);
      worst = fmax(worst, ulps(out[i], exact));
    }
  }
  mpfr_clears(radius, exact, v, (mpfr_ptr)NULL);
  print_message("  normal pair: %.3f ulp\n", worst);
  assert_true(worst <= 5.0);
  const struct random_words zeros = {{0, 0, 0, 0}};
  double out[2];
  random_normal_pair(zeros, out);
  assert_close(out[0], 8.5716743, 1e-6); /* sqrt(2 53 ln 2) */
}

/* Distribution, moments, tails, independence of the three columns. False alarms: 10^-6 for each of three distances and
 * twelve counts, 6 10^-7 (5 sigma) for each of nineteen means. Moments of a standard normal deviate: 0, 1, 0, 3, 15. */
static void columns_are_normal(int kind)
{
  enum { N = 400000 };
  const uint64_t seed = dice_seed(172 + (uint64_t)kind);
  double *z[3], *p = malloc(N * sizeof *p);
  uint32_t *entity = malloc(N * sizeof *entity);
  for (int c = 0; c < 3; c++)
    z[c] = malloc(N * sizeof *z[c]);
  for (uint32_t k = 0; k < N; k++)
    entity[k] = k;
  normals_of[kind](seed, 0, entity, N, z[0], z[1], z[2]);
  for (int c = 0; c < 3; c++) {
    struct tally mean = {0}, square = {0}, cube = {0}, fourth = {0}, product = {0}, squares = {0};
    unsigned beyond[2][2] = {{0}};
    for (uint32_t k = 0; k < N; k++) {
      const double a = z[c][k], b = z[(c + 1) % 3][k];
      tally_add(&mean, a);
      tally_add(&square, a * a);
      tally_add(&cube, a * a * a);
      tally_add(&fourth, a * a * a * a);
      tally_add(&product, a * b);
      tally_add(&squares, a * a * b * b);
      for (int i = 0; i < 2; i++) {
        beyond[i][0] += a < -(3.0 + i);
        beyond[i][1] += a > 3.0 + i;
      }
      p[k] = gsl_cdf_ugaussian_P(a);
    }
    assert_sigma(tally_mean(&mean), 1.0 / sqrt(N), 0.0, 5.0);
    assert_sigma(tally_mean(&square), sqrt(2.0 / N), 1.0, 5.0);
    assert_sigma(tally_mean(&cube), sqrt(15.0 / N), 0.0, 5.0);
    assert_sigma(tally_mean(&fourth), sqrt(96.0 / N), 3.0, 5.0);
    assert_sigma(tally_mean(&product), 1.0 / sqrt(N), 0.0, 5.0);
    assert_sigma(tally_mean(&squares), sqrt(8.0 / N), 1.0, 5.0);
    for (int i = 0; i < 2; i++)
      for (int side = 0; side < 2; side++) {
        const double chance = gsl_cdf_ugaussian_Q(3.0 + i);
        print_message("  %u beyond %d sigma, expected %.1f\n", beyond[i][side], 3 + i, N * chance);
        assert_true(gsl_cdf_binomial_P(beyond[i][side], chance, N) > 0.5 * LEAST_CHANCE);
        assert_true(beyond[i][side] == 0 || gsl_cdf_binomial_Q(beyond[i][side] - 1, chance, N) > 0.5 * LEAST_CHANCE);
      }
    assert_true(kolmogorov(p, N) < KOLMOGOROV_LIMIT);
  }
  struct tally triple = {0};
  for (uint32_t k = 0; k < N; k++)
    tally_add(&triple, z[0][k] * z[1][k] * z[2][k]);
  assert_sigma(tally_mean(&triple), 1.0 / sqrt(N), 0.0, 5.0);
  for (int c = 0; c < 3; c++)
    free(z[c]);
  free(p);
  free(entity);
}

static void normals_are_normal(void **unused)
{
  (void)unused;
  columns_are_normal(0);
}

static void three_of_one_draw_are_normal(void **unused)
{
  (void)unused;
  columns_are_normal(1);
}

/* Signs of the three numbers and the sizes of the first two are of different bits of two words: the octants, and which
 * is larger, are equally likely. 16 counts of 400 000, false alarms 10^-6 for all. */
static void octants_are_alike(void **unused)
{
  (void)unused;
  enum { N = 400000 };
  unsigned count[16] = {0};
  const uint64_t seed = dice_seed(174);
  for (uint32_t k = 0; k < N; k++) {
    double x[3];
    random_normal_three(random_at(seed, RANDOM_SOLVENT_VELOCITY, 0, 0, k), x);
    count[(x[0] > 0) + 2 * (x[1] > 0) + 4 * (x[2] > 0) + 8 * (fabs(x[0]) > fabs(x[1]))]++;
  }
  double square = 0.0;
  for (int k = 0; k < 16; k++)
    square += (count[k] - N / 16.0) * (count[k] - N / 16.0) / (N / 16.0);
  assert_true(gsl_cdf_chisq_Q(square, 15.0) > LEAST_CHANCE);
}

/* The definition in MPFR, from the words, to 2e-12 of the radius; at the ends of the words, too. The largest magnitude
 * is sqrt(2 41 ln 2); every radius has it in reach. One draw and columns have the same bits. */
static void three_normals_are_as_defined(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(173)};
  mpfr_t radius, turn, exact;
  mpfr_inits2(PRECISION, radius, turn, exact, (mpfr_ptr)NULL);
  double worst = 0.0;
  for (int k = 0; k < 20000; k++) {
    struct random_words r;
    for (int i = 0; i < 4; i++)
      r.w[i] = k < 16 ? (k >> i & 1 ? ~0u : 0u) : (uint32_t)dice_u64(&d);
    double out[3], wanted[3];
    random_normal_three(r, out);
    for (int i = 0; i < 3; i++) {
      const uint64_t word = (uint64_t)r.w[i == 2 ? 2 : 0] << 32 | r.w[i == 2 ? 3 : 1]; /* 40 bits, signs, angle */
      mpfr_set_d(radius, ldexp((double)(word >> 24) + 0.5, -40), MPFR_RNDN);
      mpfr_log(radius, radius, MPFR_RNDN);
      mpfr_mul_si(radius, radius, -2, MPFR_RNDN);
      mpfr_sqrt(radius, radius, MPFR_RNDN);
      const double v = i == 2 ? ldexp((double)(word % 16777216) + 0.5, -25) - 0.25 /* turns: -1/4 to 1/4 */
                              : ldexp((double)(word % 4194304) + 0.5, -24);        /* 0 to 1/4 */
      mpfr_set_d(turn, v, MPFR_RNDN);
      (i == 0 ? mpfr_cosu : mpfr_sinu)(exact, turn, 1, MPFR_RNDN);
      mpfr_mul(exact, exact, radius, MPFR_RNDN);
      wanted[i] = mpfr_get_d(exact, MPFR_RNDN) * (i < 2 && word >> (23 - i) & 1 ? -1.0 : 1.0);
      worst = fmax(worst, fabs(out[i] - wanted[i]) / mpfr_get_d(radius, MPFR_RNDN));
      assert_true(fabs(out[i]) < 7.54);
    }
  }
  mpfr_clears(radius, turn, exact, (mpfr_ptr)NULL);
  print_message("  three normals: %.3g of the radius\n", worst);
  assert_true(worst <= 2e-12);
  const struct random_words steep = {{0, 0x3fffff, 0, 0xffffff}};
  double out[3];
  random_normal_three(steep, out);
  assert_close(out[1], 7.5391, 1e-4); /* sqrt(2 41 ln 2) */
  assert_close(out[2], 7.5391, 1e-4);
}

static void three_normals_of_columns_are_the_same(void **unused)
{
  (void)unused;
  enum { MOST = 200 };
  struct dice d = {dice_seed(175)};
  uint32_t entity[MOST];
  double x[MOST + 1], y[MOST + 1], z[MOST + 1];
  for (uint32_t n = 0; n <= MOST; n++) {
    const uint64_t seed = dice_u64(&d), step = dice_u64(&d);
    const uint32_t draw = n % 3;
    for (uint32_t k = 0; k < n; k++)
      entity[k] = (uint32_t)dice_u64(&d);
    x[n] = y[n] = z[n] = 77.0;
    random_normal_three_columns(seed, RANDOM_ANDERSEN_PARTICLE, draw, step, entity, n, x, y, z);
    assert_true(x[n] == 77.0 && y[n] == 77.0 && z[n] == 77.0); /* nothing is written beyond the end */
    for (uint32_t k = 0; k < n; k++) {
      double a[3];
      random_normal_three(random_at(seed, RANDOM_ANDERSEN_PARTICLE, draw, step, entity[k]), a);
      assert_true(is_bits(x[k], a[0]) && is_bits(y[k], a[1]) && is_bits(z[k], a[2]));
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(error_is_as_stated),           cmocka_unit_test(error_at_the_ends),
      cmocka_unit_test(constants_are_exact),          cmocka_unit_test(exact_values),
      cmocka_unit_test(symmetries_hold_to_the_bit),   cmocka_unit_test(golden_outputs),
      cmocka_unit_test(columns_are_the_same),         cmocka_unit_test(normal_columns_are_the_same),
      cmocka_unit_test(normal_pair_is_as_defined),    cmocka_unit_test(normals_are_normal),
      cmocka_unit_test(three_of_one_draw_are_normal), cmocka_unit_test(octants_are_alike),
      cmocka_unit_test(three_normals_are_as_defined), cmocka_unit_test(three_normals_of_columns_are_the_same),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

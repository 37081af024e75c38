/* Instruments of the exact tests that share nothing with the code under test: a generator of their own, exact rationals
 * (GMP), goodness of fit (GSL). Every random test takes its seed from dice_seed and names the failing seed: run the
 * program with UNCROSS_TEST_SEED=<seed> to try others. */
#ifndef UNCROSS_TESTS_EXACT_H
#define UNCROSS_TESTS_EXACT_H

#include <gmp.h>
#include <gsl/gsl_cdf.h>

#include "support.h"

/* --- dice: splitmix64 (Steele, Lea and Flood 2014), not Philox ---------------------------------------------------- */

struct dice {
  uint64_t state;
};

static inline uint64_t dice_seed(uint64_t usual)
{
  const char *wanted = getenv("UNCROSS_TEST_SEED");
  return wanted ? strtoull(wanted, NULL, 0) : usual;
}

static inline uint64_t dice_u64(struct dice *d)
{
  uint64_t z = (d->state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/* [0,1) */
static inline double dice_uniform(struct dice *d)
{
  return (double)(dice_u64(d) >> 11) * 0x1p-53;
}

static inline double dice_between(struct dice *d, double low, double high)
{
  return low + (high - low) * dice_uniform(d);
}

/* low .. high, both included */
static inline int64_t dice_integer(struct dice *d, int64_t low, int64_t high)
{
  return low + (int64_t)(dice_u64(d) % (uint64_t)(high - low + 1));
}

static inline double dice_normal(struct dice *d)
{
  double u = 1.0 - dice_uniform(d), w = dice_uniform(d);
  return sqrt(-2.0 * log(u)) * cos(6.283185307179586477 * w);
}

static inline struct vec3 dice_vector(struct dice *d, double size)
{
  double x = size * dice_normal(d), y = size * dice_normal(d), z = size * dice_normal(d);
  return (struct vec3){x, y, z};
}

static inline struct vec3 dice_direction(struct dice *d)
{
  struct vec3 n = dice_vector(d, 1.0);
  return vec3_scale(1.0 / vec3_norm(n), n);
}

/* A vector of random direction and of a length between low and high. (Drawn one after the other: C does not say in
 * which order arguments are evaluated.) */
static inline struct vec3 dice_rod(struct dice *d, double low, double high)
{
  const double length = dice_between(d, low, high);
  return vec3_scale(length, dice_direction(d));
}

/* Coordinates from -x to x, -y to y, -z to z. */
static inline struct point dice_point(struct dice *d, int64_t x, int64_t y, int64_t z)
{
  struct point p;
  p.x = dice_integer(d, -x, x);
  p.y = dice_integer(d, -y, y);
  p.z = dice_integer(d, -z, z);
  return p;
}

static inline void dice_shuffle(struct dice *d, uint32_t *order, uint32_t n)
{
  for (uint32_t k = n; k-- > 1;) {
    uint32_t j = (uint32_t)dice_integer(d, 0, k), swap = order[k];
    order[k] = order[j];
    order[j] = swap;
  }
}

/* --- integers ----------------------------------------------------------------------------------------------------- */

/* floor(x / edge); test_lattice.c holds it to GMP. */
static inline int64_t floor_divide(int64_t x, int64_t edge)
{
  return x / edge - (x % edge < 0);
}

/* --- goodness of fit ---------------------------------------------------------------------------------------------- */

/* Chance of a chi^2 at least this large if all `kinds` outcomes are equally likely. */
static inline double equal_chances(const uint64_t *count, size_t kinds)
{
  double total = 0.0, chi2 = 0.0;
  for (size_t k = 0; k < kinds; k++)
    total += (double)count[k];
  for (size_t k = 0; k < kinds; k++)
    chi2 += ((double)count[k] - total / kinds) * ((double)count[k] - total / kinds) / (total / kinds);
  return gsl_cdf_chisq_Q(chi2, (double)kinds - 1.0);
}

static inline int compare_doubles(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* sqrt(n) times the Kolmogorov-Smirnov distance of u (sorted here) from uniform on [0,1]. Exceeds 2.7 by chance once in
 * 10^6 tests (Kolmogorov: 2 exp(-2 x^2)). */
static inline double kolmogorov(double *u, size_t n)
{
  qsort(u, n, sizeof *u, compare_doubles);
  double worst = 0.0;
  for (size_t k = 0; k < n; k++) {
    worst = fmax(worst, fabs((double)(k + 1) / n - u[k]));
    worst = fmax(worst, fabs(u[k] - (double)k / n));
  }
  return sqrt((double)n) * worst;
}
#define KOLMOGOROV_LIMIT 2.7
#define LEAST_CHANCE 1e-6 /* false alarms of the chi^2 tests */

/* Mean and standard error of a stream of numbers. */
struct tally {
  double n, sum, squares;
};

static inline void tally_add(struct tally *t, double x)
{
  t->n += 1.0;
  t->sum += x;
  t->squares += x * x;
}

static inline double tally_mean(const struct tally *t)
{
  return t->sum / t->n;
}

static inline double tally_error(const struct tally *t)
{
  double mean = tally_mean(t);
  return sqrt(fmax(0.0, t->squares / t->n - mean * mean) / (t->n - 1.0));
}

/* --- states by dice ----------------------------------------------------------------------------------------------- */

/* A run whose solvent and vertices are thrown uniformly (vertices up to three boxes away) with Maxwell velocities. */
static inline struct test_run dice_run(struct model model, struct dice *d)
{
  struct test_run r = {.model = model};
  test_finish(&r.model);
  assert_true(state_alloc(&r.state, &r.model));
  assert_true(work_alloc(&r.work, &r.model));
  const int64_t *edge = r.model.box.edge;
  struct solvent *s = &r.state.solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    s->x[i] = dice_integer(d, 0, edge[0] - 1);
    s->y[i] = dice_integer(d, 0, edge[1] - 1);
    s->z[i] = dice_integer(d, 0, edge[2] - 1);
    struct vec3 v = dice_vector(d, 1.0);
    s->vx[i] = v.x;
    s->vy[i] = v.y;
    s->vz[i] = v.z;
    if (model_is_flat(&r.model)) {
      s->z[i] = 0;
      s->vz[i] = 0.0;
    }
  }
  struct dumbbells *b = &r.state.dumbbells;
  for (uint32_t p = 0; p < b->n; p++) {
    const int64_t image = dice_integer(d, -1, 1);
    b->x[p] = s->x[2 * p] - s->x[2 * p + 1] + image * edge[0];
    b->y[p] = s->y[2 * p] - s->y[2 * p + 1] + (model_has_walls(&r.model) ? 0 : image * edge[1]);
    b->z[p] = s->z[2 * p] - s->z[2 * p + 1];
  }
  for (uint32_t v = 0; v < r.state.vertices; v++) {
    r.state.position[v] = dice_point(d, 3 * edge[0], 3 * edge[1], 3 * edge[2]);
    r.state.velocity[v] = dice_vector(d, sqrt(r.model.inverse_mass[v]));
    if (model_is_flat(&r.model))
      r.state.position[v].z = 0, r.state.velocity[v].z = 0.0;
  }
  return r;
}

static inline struct vec3 solvent_v(const struct state *state, uint32_t i)
{
  return (struct vec3){state->solvent.vx[i], state->solvent.vy[i], state->solvent.vz[i]};
}

static inline void set_solvent_v(struct state *state, uint32_t i, struct vec3 v)
{
  state->solvent.vx[i] = v.x;
  state->solvent.vy[i] = v.y;
  state->solvent.vz[i] = v.z;
}

/* Solvent particles of a state moved to other places in memory; physically the same state. */
static inline void swap_particles(struct solvent *s, uint32_t k, uint32_t j)
{
  int64_t *lattice[] = {s->x, s->y, s->z};
  double *real[] = {s->vx, s->vy, s->vz};
  const uint32_t id = s->id[k];
  for (int c = 0; c < 3; c++) {
    int64_t p = lattice[c][k];
    double v = real[c][k];
    lattice[c][k] = lattice[c][j];
    lattice[c][j] = p;
    real[c][k] = real[c][j];
    real[c][j] = v;
  }
  s->id[k] = s->id[j];
  s->id[j] = id;
}

/* Dumbbells stay before the other particles, and their particles together. */
static inline void shuffle_memory(struct state *state, struct dice *d)
{
  struct solvent *s = &state->solvent;
  struct dumbbells *b = &state->dumbbells;
  for (uint32_t k = b->n; k-- > 1;) {
    const uint32_t j = (uint32_t)dice_integer(d, 0, k), id = b->id[k];
    int64_t *r[] = {b->x, b->y, b->z};
    for (int c = 0; c < 3; c++) {
      const int64_t apart = r[c][k];
      r[c][k] = r[c][j];
      r[c][j] = apart;
    }
    b->id[k] = b->id[j];
    b->id[j] = id;
    swap_particles(s, 2 * k, 2 * j);
    swap_particles(s, 2 * k + 1, 2 * j + 1);
  }
  for (uint32_t k = s->n; k-- > 2 * b->n + 1;)
    swap_particles(s, k, (uint32_t)dice_integer(d, 2 * b->n, k));
}

/* Cell number (z Ly + y) Lx + x of a point on a shifted grid, by floor divisions. */
static inline uint32_t cell_by_floor(const struct box *box, struct point p, struct point shift)
{
  const int64_t at[3] = {p.x + shift.x, p.y + shift.y, p.z + shift.z};
  int64_t c[3];
  for (int k = 0; k < 3; k++) {
    c[k] = floor_divide(at[k], (int64_t)1 << 40);
    c[k] -= floor_divide(c[k], box->cells[k]) * box->cells[k];
  }
  return (uint32_t)((c[2] * box->cells[1] + c[1]) * box->cells[0] + c[0]);
}

/* --- does a segment pierce a triangle? ---------------------------------------------------------------------------- */

/* The segment (a, b) meets the plane of the triangle (pivot, from, to) where
 *
 *     pivot + alpha (from - pivot) + beta (to - pivot) = a + s' (b - a),
 *
 * three linear equations for alpha, beta, s', solved here in integers by Cramer's rule. The moving bond is in contact
 * at t = beta / (alpha + beta), s = 1 - alpha - beta (s counted from the moving vertex). */
enum exact_verdict {
  EXACT_MISS,  /* some coordinate lies strictly outside, or the segment never leaves a plane parallel to the triangle */
  EXACT_TOUCH, /* a coordinate is exactly 0 or 1: an edge or an end is touched */
  EXACT_HIT    /* all lie strictly inside */
};

struct exact_test {
  mpz_t u[3], v[3], q[3], w[3], alpha, beta, standing, whole, rest, minor, term;
};

static inline void exact_open(struct exact_test *x)
{
  for (int k = 0; k < 3; k++)
    mpz_inits(x->u[k], x->v[k], x->q[k], x->w[k], NULL);
  mpz_inits(x->alpha, x->beta, x->standing, x->whole, x->rest, x->minor, x->term, NULL);
}

static inline void exact_close(struct exact_test *x)
{
  for (int k = 0; k < 3; k++)
    mpz_clears(x->u[k], x->v[k], x->q[k], x->w[k], NULL);
  mpz_clears(x->alpha, x->beta, x->standing, x->whole, x->rest, x->minor, x->term, NULL);
}

/* of coordinates below 2^62 */
static inline void exact_difference(mpz_t out[3], struct point a, struct point b)
{
  mpz_set_si(out[0], a.x - b.x);
  mpz_set_si(out[1], a.y - b.y);
  mpz_set_si(out[2], a.z - b.z);
}

/* det of the columns a, b, c, by the rule of Sarrus */
static inline void exact_volume(struct exact_test *x, mpz_t out, mpz_t a[3], mpz_t b[3], mpz_t c[3])
{
  mpz_set_ui(out, 0);
  for (int k = 0; k < 3; k++) {
    int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    mpz_mul(x->minor, a[k], b[k1]);
    mpz_addmul(out, x->minor, c[k2]);
    mpz_mul(x->minor, a[k], b[k2]);
    mpz_submul(out, x->minor, c[k1]);
  }
}

static inline int exact_orientation(struct exact_test *x, struct point o, struct point a, struct point b,
                                    struct point c)
{
  exact_difference(x->u, a, o);
  exact_difference(x->v, b, o);
  exact_difference(x->w, c, o);
  exact_volume(x, x->term, x->u, x->v, x->w);
  return mpz_sgn(x->term);
}

static inline enum exact_verdict exact_crossing(struct exact_test *x, struct point from, struct point to,
                                                struct point pivot, struct point a, struct point b)
{
  exact_difference(x->u, from, pivot);
  exact_difference(x->v, to, pivot);
  exact_difference(x->q, a, b);
  exact_difference(x->w, a, pivot);
  exact_volume(x, x->whole, x->u, x->v, x->q);
  int sign = mpz_sgn(x->whole);
  if (sign == 0)
    return EXACT_MISS;
  exact_volume(x, x->alpha, x->w, x->v, x->q);
  exact_volume(x, x->beta, x->u, x->w, x->q);
  exact_volume(x, x->standing, x->u, x->v, x->w);
  if (sign < 0) {
    mpz_neg(x->whole, x->whole);
    mpz_neg(x->alpha, x->alpha);
    mpz_neg(x->beta, x->beta);
    mpz_neg(x->standing, x->standing);
  }
  mpz_sub(x->rest, x->whole, x->alpha);
  mpz_sub(x->rest, x->rest, x->beta);
  mpz_sub(x->term, x->whole, x->standing);
  const int inside[5] = {mpz_sgn(x->alpha), mpz_sgn(x->beta), mpz_sgn(x->rest), mpz_sgn(x->standing), mpz_sgn(x->term)};
  enum exact_verdict verdict = EXACT_HIT;
  for (int k = 0; k < 5; k++) {
    if (inside[k] < 0)
      return EXACT_MISS;
    if (inside[k] == 0)
      verdict = EXACT_TOUCH;
  }
  return verdict;
}

/* numerator / denominator, correctly truncated to a double */
static inline double exact_ratio(mpz_t numerator, mpz_t denominator)
{
  mpq_t r;
  mpq_init(r);
  mpq_set_num(r, numerator);
  mpq_set_den(r, denominator);
  mpq_canonicalize(r);
  double d = mpq_get_d(r);
  mpq_clear(r);
  return d;
}

/* Where and when, after a verdict EXACT_HIT. */
static inline void exact_contact(struct exact_test *x, double *time, double *s, double *s_standing)
{
  mpz_add(x->term, x->alpha, x->beta);
  *time = exact_ratio(x->beta, x->term);
  *s = exact_ratio(x->rest, x->whole);
  *s_standing = exact_ratio(x->standing, x->whole);
}

#endif

/*
 * Do two tubes in straight flight touch? Decided with polynomials over the integers (GMP): exact, and without anything
 * of src/ but the structure of a query.
 *
 * The axes are as far apart as the origin is from the parallelogram w + t q - s p, 0 <= s, t <= 1. Its point nearest to
 * the origin is inside, on one of four edges c + t e, or one of four corners c. So at a time the tubes are not apart if
 * and only if one of nine features has f <= 0 and all its g > 0:
 *
 *     corner   f = c.c - R^2
 *     edge     f = |c x e|^2 - R^2 e.e,        g = -c.e, e.e + c.e
 *     inside   f = (n.w)^2 - R^2 n.n,          g = S, n.n - S, T, n.n - T,    n = p x q, S = (w x q).n, T = (w x p).n
 *
 * where R is the reach. (Of parallel axes, n = 0, the nearest points may be taken on an edge.) All vectors are linear
 * in time, so f and g are polynomials of degree 6 or less. Over an interval they are written in Bernstein form, in
 * integers. If all coefficients of f are > 0, or those of one g all <= 0, the feature is apart at all times of the
 * interval. If f <= 0 and all g > 0 at an end of it, the tubes are not. Else it is halved, without rounding.
 */
#ifndef UNCROSS_TESTS_EXACT_TUBES_H
#define UNCROSS_TESTS_EXACT_TUBES_H

#include "contact/flight.h"
#include "exact.h"

enum {
  BERNSTEIN_DEGREE = 6,
  BERNSTEIN_LIMITS = 4,     /* g of a feature, at most */
  BERNSTEIN_HALVINGS = 160, /* 65536 ticks are 1e-43 ticks then */
  REACH_BITS = 20           /* a reach is a whole number of lattice units over 2^20 */
};

enum tube_verdict { TUBES_APART, TUBES_TOUCH, TUBES_OPEN };

/* A polynomial over an interval, 0 <= u <= 1: sum of c_k u^k (1 - u)^(degree - k). So products are convolutions. The
 * Bernstein coefficients are c_k over binomials: the same signs. */
struct form {
  int degree;
  mpz_t c[BERNSTEIN_DEGREE + 1];
};

/* f and the g of a feature, over an interval. */
struct piece {
  int limits;
  struct form f, g[BERNSTEIN_LIMITS];
};

struct exact_tubes {
  struct piece piece[BERNSTEIN_HALVINGS + 1];
  struct form p[3], q[3], w[3], c[3], e[3], n[3], v[3], volume, ce, ee, raised;
  mpz_t reach_squared;
};

static inline void form_open(struct form *f)
{
  for (int k = 0; k <= BERNSTEIN_DEGREE; k++)
    mpz_init2(f->c[k], 512);
}

static inline void form_close(struct form *f)
{
  for (int k = 0; k <= BERNSTEIN_DEGREE; k++)
    mpz_clear(f->c[k]);
}

static inline void exact_tubes_each(struct exact_tubes *e, void (*act)(struct form *f))
{
  for (int k = 0; k <= BERNSTEIN_HALVINGS; k++) {
    act(&e->piece[k].f);
    for (int g = 0; g < BERNSTEIN_LIMITS; g++)
      act(&e->piece[k].g[g]);
  }
  struct form *vectors[] = {e->p, e->q, e->w, e->c, e->e, e->n, e->v};
  for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
    for (int axis = 0; axis < 3; axis++)
      act(&vectors[k][axis]);
  act(&e->volume), act(&e->ce), act(&e->ee), act(&e->raised);
}

/* On the heap: it is large. */
static inline struct exact_tubes *exact_tubes_open(void)
{
  struct exact_tubes *e = calloc(1, sizeof *e);
  assert_non_null(e);
  exact_tubes_each(e, form_open);
  mpz_init(e->reach_squared);
  return e;
}

static inline void exact_tubes_close(struct exact_tubes *e)
{
  exact_tubes_each(e, form_close);
  mpz_clear(e->reach_squared);
  free(e);
}

/* --- forms -------------------------------------------------------------------------------------------------------- */

static inline void form_zero(struct form *f, int degree)
{
  f->degree = degree;
  for (int k = 0; k <= degree; k++)
    mpz_set_ui(f->c[k], 0);
}

/* sum += sign a b; degrees fit. */
static inline void form_add_product(struct form *sum, int sign, const struct form *a, const struct form *b)
{
  assert_int_equal(sum->degree, a->degree + b->degree);
  for (int i = 0; i <= a->degree; i++)
    for (int j = 0; j <= b->degree; j++)
      (sign > 0 ? mpz_addmul : mpz_submul)(sum->c[i + j], a->c[i], b->c[j]);
}

static inline void form_dot(struct form *to, const struct form a[3], const struct form b[3])
{
  form_zero(to, a->degree + b->degree);
  for (int k = 0; k < 3; k++)
    form_add_product(to, 1, &a[k], &b[k]);
}

static inline void form_cross(struct form to[3], const struct form a[3], const struct form b[3])
{
  for (int k = 0; k < 3; k++) {
    form_zero(&to[k], a->degree + b->degree);
    form_add_product(&to[k], 1, &a[(k + 1) % 3], &b[(k + 2) % 3]);
    form_add_product(&to[k], -1, &a[(k + 2) % 3], &b[(k + 1) % 3]);
  }
}

/* to = a b_sign b, of the same degree. */
static inline void form_sum(struct form *to, const struct form *a, int sign, const struct form *b)
{
  to->degree = a->degree;
  for (int k = 0; k <= a->degree; k++)
    (sign > 0 ? mpz_add : mpz_sub)(to->c[k], a->c[k], b->c[k]);
}

static inline void form_minus(struct form *to, const struct form *a)
{
  to->degree = a->degree;
  for (int k = 0; k <= a->degree; k++)
    mpz_neg(to->c[k], a->c[k]);
}

/* f -= R^2 a, whose degree is less by 2: times (u + 1 - u)^2. */
static inline void form_less_reach(struct exact_tubes *e, struct form *f, const struct form *a)
{
  struct form *r = &e->raised;
  form_zero(r, a->degree + 2);
  for (int k = 0; k <= a->degree; k++)
    for (int j = 0; j < 3; j++)
      mpz_addmul_ui(r->c[k + j], a->c[k], j == 1 ? 2 : 1);
  for (int k = 0; k <= r->degree; k++)
    mpz_submul(f->c[k], r->c[k], e->reach_squared);
}

/* A vector from tick `from` to tick `to`. */
static inline void form_vector(struct form v[3], struct point at, struct point rate, int32_t from, int32_t to)
{
  const int64_t x[3] = {at.x, at.y, at.z}, r[3] = {rate.x, rate.y, rate.z};
  for (int k = 0; k < 3; k++) {
    v[k].degree = 1;
    mpz_set_si(v[k].c[0], x[k] + r[k] * from);
    mpz_set_si(v[k].c[1], x[k] + r[k] * to);
    mpz_mul_2exp(v[k].c[0], v[k].c[0], REACH_BITS);
    mpz_mul_2exp(v[k].c[1], v[k].c[1], REACH_BITS);
  }
}

/* --- features ----------------------------------------------------------------------------------------------------- */

static inline void make_corner(struct exact_tubes *e, struct piece *x)
{
  x->limits = 0;
  form_dot(&x->f, e->c, e->c);
  for (int k = 0; k <= 2; k++) {
    mpz_sub(x->f.c[k], x->f.c[k], e->reach_squared);
    if (k == 1)
      mpz_sub(x->f.c[k], x->f.c[k], e->reach_squared);
  }
}

static inline void make_edge(struct exact_tubes *e, struct piece *x)
{
  x->limits = 2;
  form_cross(e->v, e->c, e->e);
  form_dot(&x->f, e->v, e->v);
  form_dot(&e->ee, e->e, e->e);
  form_dot(&e->ce, e->c, e->e);
  form_less_reach(e, &x->f, &e->ee);
  form_minus(&x->g[0], &e->ce);
  form_sum(&x->g[1], &e->ee, 1, &e->ce);
}

static inline void make_inside(struct exact_tubes *e, struct piece *x)
{
  x->limits = 4;
  form_cross(e->n, e->p, e->q);
  form_dot(&e->volume, e->n, e->w);
  form_dot(&e->ee, e->n, e->n);
  form_zero(&x->f, 6);
  form_add_product(&x->f, 1, &e->volume, &e->volume);
  form_less_reach(e, &x->f, &e->ee);
  form_cross(e->v, e->w, e->q);
  form_dot(&x->g[0], e->v, e->n);
  form_sum(&x->g[1], &e->ee, -1, &x->g[0]);
  form_cross(e->v, e->w, e->p);
  form_dot(&x->g[2], e->v, e->n);
  form_sum(&x->g[3], &e->ee, -1, &x->g[2]);
}

static inline void form_copy(struct form *to, const struct form *from)
{
  to->degree = from->degree;
  for (int k = 0; k <= from->degree; k++)
    mpz_set(to->c[k], from->c[k]);
}

enum { TUBE_FEATURES = 9 };

/* Corners w, w - p, w + q, w + q - p; edges w + t q, w - p + t q, w - t p, w + q - t p; the inside. */
static inline void make_feature(struct exact_tubes *e, int feature, struct piece *x)
{
  static const struct {
    bool less_p, plus_q;
    char along;
  } row[TUBE_FEATURES - 1] = {{0, 0, 0},   {1, 0, 0},   {0, 1, 0},   {1, 1, 0},
                              {0, 0, 'q'}, {1, 0, 'q'}, {0, 0, 'p'}, {0, 1, 'p'}};
  if (feature == TUBE_FEATURES - 1) {
    make_inside(e, x);
    return;
  }
  for (int k = 0; k < 3; k++) {
    form_copy(&e->c[k], &e->w[k]);
    if (row[feature].less_p)
      form_sum(&e->c[k], &e->c[k], -1, &e->p[k]);
    if (row[feature].plus_q)
      form_sum(&e->c[k], &e->c[k], 1, &e->q[k]);
    (row[feature].along == 'q' ? form_copy : form_minus)(&e->e[k], row[feature].along == 'q' ? &e->q[k] : &e->p[k]);
  }
  (row[feature].along ? make_edge : make_corner)(e, x);
}

/* --- the verdict -------------------------------------------------------------------------------------------------- */

/* All coefficients are > 0; or all are <= 0. */
static inline bool form_above(const struct form *f)
{
  for (int k = 0; k <= f->degree; k++)
    if (mpz_sgn(f->c[k]) <= 0)
      return false;
  return true;
}

static inline bool form_not_above(const struct form *f)
{
  for (int k = 0; k <= f->degree; k++)
    if (mpz_sgn(f->c[k]) > 0)
      return false;
  return true;
}

static inline bool piece_apart(const struct piece *x)
{
  bool apart = form_above(&x->f);
  for (int g = 0; g < x->limits; g++)
    apart = apart || form_not_above(&x->g[g]);
  return apart;
}

static inline bool piece_touches_at(const struct piece *x, bool end)
{
  bool touch = mpz_sgn(x->f.c[end ? x->f.degree : 0]) <= 0;
  for (int g = 0; g < x->limits; g++)
    touch = touch && mpz_sgn(x->g[g].c[end ? x->g[g].degree : 0]) > 0;
  return touch;
}

/* Both halves, times 2^degree n. With y = u, x = 1 - u, the first half is f(x + y/2, y/2), and the other f(x/2, y +
 * x/2): sums c_k y^k (2 x + y)^(n - k), and c_k (2 y + x)^k x^(n - k). Each is a shift by one, by Pascal's sums. */
static inline void form_halve(struct form *f, struct form *first)
{
  const int n = f->degree;
  form_copy(first, f);
  for (int round = 0; round < n; round++)
    for (int k = 1; k <= n - round; k++)
      mpz_add(first->c[k], first->c[k], first->c[k - 1]);
  for (int round = 0; round < n; round++)
    for (int k = n - 1; k >= round; k--)
      mpz_add(f->c[k], f->c[k], f->c[k + 1]);
  for (int k = 0; k <= n; k++) {
    mpz_mul_2exp(first->c[k], first->c[k], (mp_bitcnt_t)(n - k));
    mpz_mul_2exp(f->c[k], f->c[k], (mp_bitcnt_t)k);
  }
}

static inline enum tube_verdict judge_piece(struct exact_tubes *e, int level, int halvings)
{
  struct piece *now = &e->piece[level];
  for (;; halvings++) {
    if (piece_apart(now))
      return TUBES_APART;
    if (piece_touches_at(now, false) || piece_touches_at(now, true))
      return TUBES_TOUCH;
    if (halvings == BERNSTEIN_HALVINGS)
      return TUBES_OPEN;
    struct piece *first = &e->piece[level + 1];
    first->limits = now->limits;
    form_halve(&now->f, &first->f);
    for (int g = 0; g < now->limits; g++)
      form_halve(&now->g[g], &first->g[g]);
    const enum tube_verdict verdict = judge_piece(e, level + 1, halvings + 1);
    if (verdict != TUBES_APART)
      return verdict;
  }
}

/* Are the axes further apart than the reach at all times from tick `from` to tick `to`, both included? reach: lattice
 * units over 2^REACH_BITS. */
static inline enum tube_verdict exact_tubes_verdict(struct exact_tubes *e, const struct flight_pair *pair,
                                                    int64_t reach, int32_t from, int32_t to)
{
  enum tube_verdict worst = TUBES_APART;
  form_vector(e->p, pair->p, pair->p_rate, from, to);
  form_vector(e->q, pair->q, pair->q_rate, from, to);
  form_vector(e->w, pair->w, pair->w_rate, from, to);
  mpz_set_si(e->reach_squared, reach);
  mpz_mul(e->reach_squared, e->reach_squared, e->reach_squared);
  for (int feature = 0; feature < TUBE_FEATURES && worst != TUBES_TOUCH; feature++) {
    make_feature(e, feature, &e->piece[0]);
    const enum tube_verdict verdict = judge_piece(e, 0, 0);
    worst = verdict == TUBES_APART ? worst : verdict;
  }
  return worst;
}

#endif

/* Do two bonds in straight flight touch? Decided with polynomials over the integers (GMP): exact, and without anything
 * of src/. With t counted from the beginning of the interval,
 *
 *     p(t) = p0 + t p1,  q(t), w(t) likewise,    n = p x q,  f = n.w,
 *     where n != 0 the bonds touch if f = 0,  0 <= S <= N,  0 <= S' <= N,   N = n.n, S = (w x q).n, S' = (w x p).n
 *
 * since w = s p - s' q with s = S/N, s' = S'/N. The roots of f are isolated by Sturm's theorem. The sign of another
 * polynomial g at a root is found by halving the interval of the root, and is zero if gcd(f, g) has a root there. Bonds
 * that are parallel at the root are compared along their line. If f is zero at all times, all motion is in a plane:
 * then bonds that begin apart touch first with an end. */
#ifndef UNCROSS_TESTS_EXACT_FLIGHT_H
#define UNCROSS_TESTS_EXACT_FLIGHT_H

#include "contact/flight.h"
#include "exact.h"

/* --- polynomials -------------------------------------------------------------------------------------------------- */

enum { MOST_DEGREE = 12, POLYNOMIALS = 64 };

struct polynomial {
  int degree; /* -1: zero */
  mpz_t c[MOST_DEGREE + 1];
};

/* Work space: numbered polynomials, taken and given back like a stack. */
struct exact_flight {
  struct polynomial store[POLYNOMIALS];
  int taken;
  mpz_t a, b, x;
  struct polynomial *p[3], *q[3], *w[3], *n[3], *f;
};

static inline void exact_flight_open(struct exact_flight *e)
{
  memset(e, 0, sizeof *e);
  for (int k = 0; k < POLYNOMIALS; k++)
    for (int i = 0; i <= MOST_DEGREE; i++)
      mpz_init(e->store[k].c[i]);
  mpz_inits(e->a, e->b, e->x, NULL);
}

static inline void exact_flight_close(struct exact_flight *e)
{
  for (int k = 0; k < POLYNOMIALS; k++)
    for (int i = 0; i <= MOST_DEGREE; i++)
      mpz_clear(e->store[k].c[i]);
  mpz_clears(e->a, e->b, e->x, NULL);
}

static inline struct polynomial *take(struct exact_flight *e)
{
  assert_true(e->taken < POLYNOMIALS);
  struct polynomial *p = &e->store[e->taken++];
  p->degree = -1;
  return p;
}

static inline void trim(struct polynomial *p)
{
  while (p->degree >= 0 && mpz_sgn(p->c[p->degree]) == 0)
    p->degree--;
}

static inline void copy_polynomial(struct polynomial *to, const struct polynomial *from)
{
  to->degree = from->degree;
  for (int i = 0; i <= from->degree; i++)
    mpz_set(to->c[i], from->c[i]);
}

static inline void raise_degree(struct polynomial *p, int degree)
{
  assert_true(degree <= MOST_DEGREE);
  for (; p->degree < degree; p->degree++)
    mpz_set_ui(p->c[p->degree + 1], 0);
}

/* sum += factor a b, factor 1 or -1 */
static inline void add_product(struct polynomial *sum, int factor, const struct polynomial *a,
                               const struct polynomial *b)
{
  if (a->degree < 0 || b->degree < 0)
    return;
  raise_degree(sum, a->degree + b->degree);
  for (int i = 0; i <= a->degree; i++)
    for (int j = 0; j <= b->degree; j++)
      (factor > 0 ? mpz_addmul : mpz_submul)(sum->c[i + j], a->c[i], b->c[j]);
  trim(sum);
}

static inline void add_polynomial(struct polynomial *sum, int factor, const struct polynomial *a)
{
  raise_degree(sum, a->degree);
  for (int i = 0; i <= a->degree; i++)
    (factor > 0 ? mpz_add : mpz_sub)(sum->c[i], sum->c[i], a->c[i]);
  trim(sum);
}

static inline void differentiate(struct polynomial *d, const struct polynomial *p)
{
  d->degree = p->degree - 1;
  for (int i = 1; i <= p->degree; i++)
    mpz_mul_si(d->c[i - 1], p->c[i], i);
  if (d->degree < 0)
    d->degree = -1;
}

/* Divides by the greatest common divisor of the coefficients, which is positive. */
static inline void make_primitive(struct exact_flight *e, struct polynomial *p)
{
  mpz_set_ui(e->a, 0);
  for (int i = 0; i <= p->degree; i++)
    mpz_gcd(e->a, e->a, p->c[i]);
  for (int i = 0; i <= p->degree; i++)
    mpz_divexact(p->c[i], p->c[i], e->a);
}

/* a becomes the remainder of a / b, times something positive; quotient, if any, likewise. */
static inline void divide(struct exact_flight *e, struct polynomial *a, const struct polynomial *b,
                          struct polynomial *quotient)
{
  const mpz_t *lead = &b->c[b->degree];
  if (quotient)
    raise_degree(quotient, a->degree - b->degree);
  while (a->degree >= b->degree) {
    const int shift = a->degree - b->degree;
    mpz_set(e->x, a->c[a->degree]);
    if (mpz_sgn(*lead) < 0)
      mpz_neg(e->x, e->x);
    mpz_abs(e->b, *lead);
    if (quotient) {
      for (int i = 0; i <= quotient->degree; i++)
        mpz_mul(quotient->c[i], quotient->c[i], e->b);
      mpz_add(quotient->c[shift], quotient->c[shift], e->x);
    }
    for (int i = 0; i <= a->degree; i++)
      mpz_mul(a->c[i], a->c[i], e->b);
    for (int i = 0; i <= b->degree; i++)
      mpz_submul(a->c[i + shift], e->x, b->c[i]);
    trim(a);
  }
}

/* g = gcd(a, b), primitive; neither is zero at all times. */
static inline void greatest_common_divisor(struct exact_flight *e, struct polynomial *g, const struct polynomial *a,
                                           const struct polynomial *b)
{
  const int mark = e->taken;
  struct polynomial *r = take(e), *s = take(e);
  copy_polynomial(r, a), copy_polynomial(s, b);
  while (s->degree >= 0) {
    divide(e, r, s, NULL);
    make_primitive(e, r);
    struct polynomial *swap = r;
    r = s, s = swap;
  }
  make_primitive(e, r);
  copy_polynomial(g, r);
  e->taken = mark;
}

/* --- roots -------------------------------------------------------------------------------------------------------- */

/* The places between which a root lies: low / 2^bits < root <= high / 2^bits, or root = low = high. */
struct between {
  mpz_t low, high;
  unsigned bits;
};

/* Sign at x / 2^bits. */
static inline int sign_of(struct exact_flight *e, const struct polynomial *p, const mpz_t x, unsigned bits)
{
  if (p->degree < 0)
    return 0;
  mpz_set(e->a, p->c[p->degree]);
  for (int i = p->degree; i-- > 0;) {
    mpz_mul(e->a, e->a, x);
    mpz_mul_2exp(e->b, p->c[i], bits * (unsigned)(p->degree - i));
    mpz_add(e->a, e->a, e->b);
  }
  return mpz_sgn(e->a);
}

struct sturm {
  struct polynomial *chain[MOST_DEGREE + 2];
  int length, mark;
};

/* Of a polynomial without multiple roots that is not zero. */
static inline struct sturm sturm_of(struct exact_flight *e, const struct polynomial *p)
{
  struct sturm s = {.mark = e->taken};
  struct polynomial *first = take(e), *second = take(e);
  copy_polynomial(first, p);
  differentiate(second, p);
  s.chain[s.length++] = first;
  for (struct polynomial *last = second, *before = first; last->degree >= 0;) {
    s.chain[s.length++] = last;
    struct polynomial *next = take(e);
    copy_polynomial(next, before);
    divide(e, next, last, NULL);
    make_primitive(e, next);
    for (int i = 0; i <= next->degree; i++)
      mpz_neg(next->c[i], next->c[i]);
    before = last, last = next;
  }
  return s;
}

static inline int variations(struct exact_flight *e, const struct sturm *s, const mpz_t x, unsigned bits)
{
  int count = 0, last = 0;
  for (int k = 0; k < s->length; k++) {
    const int sign = sign_of(e, s->chain[k], x, bits);
    count += sign && last && sign != last;
    last = sign ? sign : last;
  }
  return count;
}

/* Number of roots with low < x <= high. */
static inline int roots_between(struct exact_flight *e, const struct sturm *s, const struct between *i)
{
  return variations(e, s, i->low, i->bits) - variations(e, s, i->high, i->bits);
}

/* The same with low <= x, of a polynomial that may have multiple roots. */
static inline int roots_within(struct exact_flight *e, const struct polynomial *p, const struct between *i)
{
  const int mark = e->taken;
  struct polynomial *d = take(e), *g = take(e), *rest = take(e), *plain = take(e);
  differentiate(d, p);
  copy_polynomial(plain, p);
  if (d->degree >= 0) {
    greatest_common_divisor(e, g, p, d);
    copy_polynomial(rest, p);
    plain->degree = -1;
    divide(e, rest, g, plain);
    make_primitive(e, plain);
  }
  const struct sturm s = sturm_of(e, plain);
  const int n = (sign_of(e, plain, i->low, i->bits) == 0) + roots_between(e, &s, i);
  e->taken = mark;
  return n;
}

/* The half in which the root of p is: the only one in low < x <= high, and a simple one. */
static inline void halve(struct exact_flight *e, const struct polynomial *p, struct between *i)
{
  if (mpz_cmp(i->low, i->high) == 0)
    return;
  mpz_mul_2exp(i->low, i->low, 1);
  mpz_mul_2exp(i->high, i->high, 1);
  i->bits++;
  const int end = sign_of(e, p, i->high, i->bits);
  mpz_add(e->x, i->low, i->high);
  mpz_fdiv_q_2exp(e->x, e->x, 1);
  const int middle = end ? sign_of(e, p, e->x, i->bits) : 0;
  if (end == 0)
    mpz_set(i->low, i->high);
  else if (middle == 0)
    mpz_set(i->low, e->x), mpz_set(i->high, e->x);
  else if (middle == end)
    mpz_set(i->high, e->x);
  else
    mpz_set(i->low, e->x);
}

/* True if p has certainly no root in low <= x <= high: |p(low)| exceeds the sum of the sizes of the other terms of its
 * Taylor series about low. Only saves time. */
static inline bool no_root_by_taylor(struct exact_flight *e, const struct polynomial *p, const struct between *i)
{
  const int mark = e->taken, n = p->degree;
  struct polynomial *t = take(e);
  copy_polynomial(t, p); /* 2^(bits n) p((low + u) / 2^bits) */
  for (int k = 0; k < n; k++)
    mpz_mul_2exp(t->c[k], t->c[k], i->bits * (unsigned)(n - k));
  for (int k = 0; k < n; k++)
    for (int l = n - 1; l >= k; l--)
      mpz_addmul(t->c[l], t->c[l + 1], i->low);
  mpz_sub(e->x, i->high, i->low);
  mpz_set_ui(e->a, 0);
  for (int k = n; k > 0; k--) {
    mpz_abs(e->b, t->c[k]);
    mpz_add(e->a, e->a, e->b);
    mpz_mul(e->a, e->a, e->x);
  }
  const bool none = mpz_cmpabs(t->c[0], e->a) > 0;
  e->taken = mark;
  return none;
}

/* Sign of g at the only root of f in an interval, which may become smaller. f has no multiple root. */
static inline int sign_at_root(struct exact_flight *e, const struct polynomial *g, const struct polynomial *f,
                               struct between *i)
{
  if (g->degree < 0)
    return 0;
  for (int tries = 0; mpz_cmp(i->low, i->high) != 0; tries++) {
    if (no_root_by_taylor(e, g, i))
      return sign_of(e, g, i->high, i->bits);
    if (tries == 12) { /* is the root of f in (low, high] one of g too? */
      const int mark = e->taken;
      struct polynomial *common = take(e);
      greatest_common_divisor(e, common, f, g);
      const bool at_low = sign_of(e, common, i->low, i->bits) == 0;
      const bool zero = common->degree > 0 && roots_within(e, common, i) - at_low > 0;
      e->taken = mark;
      if (zero)
        return 0;
    }
    halve(e, f, i);
  }
  return sign_of(e, g, i->high, i->bits);
}

/* --- do they touch? ----------------------------------------------------------------------------------------------- */

static inline void dot_polynomials(struct polynomial *sum, struct polynomial *const a[3], struct polynomial *const b[3])
{
  for (int k = 0; k < 3; k++)
    add_product(sum, 1, a[k], b[k]);
}

static inline void cross_polynomials(struct exact_flight *e, struct polynomial *c[3], struct polynomial *const a[3],
                                     struct polynomial *const b[3])
{
  for (int k = 0; k < 3; k++) {
    c[k] = take(e);
    add_product(c[k], 1, a[(k + 1) % 3], b[(k + 2) % 3]);
    add_product(c[k], -1, a[(k + 2) % 3], b[(k + 1) % 3]);
  }
}

static inline void set_linear(struct polynomial *p, int64_t at, int64_t rate, int64_t tick)
{
  p->degree = 1;
  mpz_set_si(p->c[1], rate);
  mpz_set_si(p->c[0], rate);
  mpz_mul_si(p->c[0], p->c[0], tick);
  if (at >= 0)
    mpz_add_ui(p->c[0], p->c[0], (unsigned long)at);
  else
    mpz_sub_ui(p->c[0], p->c[0], (unsigned long)-at);
  trim(p);
}

static inline void set_vector(struct exact_flight *e, struct polynomial *v[3], struct point at, struct point rate,
                              int64_t tick)
{
  for (int k = 0; k < 3; k++)
    v[k] = take(e);
  set_linear(v[0], at.x, rate.x, tick);
  set_linear(v[1], at.y, rate.y, tick);
  set_linear(v[2], at.z, rate.z, tick);
}

/* A root of f at hand, and signs there. */
struct at_root {
  struct exact_flight *e;
  const struct polynomial *f;
  struct between *i;
};

static inline int sign_here(const struct at_root *r, const struct polynomial *g)
{
  return sign_at_root(r->e, g, r->f, r->i);
}

/* 0 <= part <= whole */
static inline bool within_here(const struct at_root *r, const struct polynomial *part, const struct polynomial *whole)
{
  if (sign_here(r, part) < 0)
    return false;
  const int mark = r->e->taken;
  struct polynomial *rest = take(r->e);
  copy_polynomial(rest, whole);
  add_polynomial(rest, -1, part);
  const bool within = sign_here(r, rest) >= 0;
  r->e->taken = mark;
  return within;
}

static inline bool all_zero_here(const struct at_root *r, struct polynomial *const v[3])
{
  return sign_here(r, v[0]) == 0 && sign_here(r, v[1]) == 0 && sign_here(r, v[2]) == 0;
}

/* The end of a vector v from one end of bond b lies on b. */
static inline bool end_on_bond_here(const struct at_root *r, struct polynomial *const v[3],
                                    struct polynomial *const b[3])
{
  struct exact_flight *e = r->e;
  const int mark = e->taken;
  struct polynomial *c[3], *along = take(e), *whole = take(e);
  cross_polynomials(e, c, v, b);
  dot_polynomials(along, v, b);
  dot_polynomials(whole, b, b);
  /* of a bond without length, only its place */
  const bool on = sign_here(r, whole) > 0 ? all_zero_here(r, c) && within_here(r, along, whole) : all_zero_here(r, v);
  e->taken = mark;
  return on;
}

/* factor_a a + factor_b b, factors 1, 0 or -1 */
static inline void combine(struct exact_flight *e, struct polynomial *v[3], int factor_a, struct polynomial *const a[3],
                           int factor_b, struct polynomial *const b[3])
{
  for (int k = 0; k < 3; k++) {
    v[k] = take(e);
    if (factor_a)
      add_polynomial(v[k], factor_a, a[k]);
    if (factor_b)
      add_polynomial(v[k], factor_b, b[k]);
  }
}

/* An end of one bond lies on the other. */
static inline bool end_touches_here(const struct at_root *r)
{
  struct exact_flight *e = r->e;
  const int mark = e->taken;
  bool touches = false;
  for (int end = 0; end < 4 && !touches; end++) {
    struct polynomial *v[3];
    e->taken = mark;
    if (end < 2)
      combine(e, v, 1, e->w, end, e->q); /* ends of q, from the first of p */
    else
      combine(e, v, -1, e->w, end - 2, e->p); /* ends of p, from the first of q */
    touches = end_on_bond_here(r, v, end < 2 ? e->p : e->q);
  }
  e->taken = mark;
  return touches;
}

/* At a time when f = 0. */
static inline bool touches_here(const struct at_root *r)
{
  struct exact_flight *e = r->e;
  const int mark = e->taken;
  struct polynomial *c[3], *whole = take(e), *s = take(e), *t = take(e);
  dot_polynomials(whole, e->n, e->n);
  if (sign_here(r, whole) == 0) {
    e->taken = mark;
    return end_touches_here(r); /* on one line, or not at all */
  }
  cross_polynomials(e, c, e->w, e->q);
  dot_polynomials(s, c, e->n);
  bool touches = within_here(r, s, whole);
  if (touches) {
    cross_polynomials(e, c, e->w, e->p);
    dot_polynomials(t, c, e->n);
    touches = within_here(r, t, whole);
  }
  e->taken = mark;
  return touches;
}

/* Whether `touches` holds at any root of g in the closed interval. g is not zero. */
static inline bool any_root(struct exact_flight *e, const struct polynomial *g, int64_t length,
                            bool (*touches)(const struct at_root *))
{
  const int mark = e->taken;
  struct polynomial *d = take(e), *common = take(e), *rest = take(e), *plain = take(e);
  differentiate(d, g);
  copy_polynomial(plain, g);
  if (d->degree >= 0) {
    greatest_common_divisor(e, common, g, d);
    copy_polynomial(rest, g);
    plain->degree = -1;
    divide(e, rest, common, plain);
    make_primitive(e, plain);
  }
  bool found = false;
  struct between stack[64];
  int depth = 0;
  if (plain->degree > 0) {
    const struct sturm s = sturm_of(e, plain);
    struct at_root r = {e, plain, &stack[0]};
    for (int k = 0; k < 64; k++)
      mpz_inits(stack[k].low, stack[k].high, NULL);
    stack[0].bits = 0;
    if (sign_of(e, plain, stack[0].low, 0) == 0) /* a root at the beginning */
      found = touches(&r);
    mpz_set_si(stack[0].high, length);
    for (depth = 1; !found && depth > 0;) {
      struct between *i = &stack[depth - 1];
      const int n = roots_between(e, &s, i);
      if (n == 0)
        depth--;
      else if (n == 1) {
        r.i = i;
        depth--;
        found = touches(&r);
      } else {
        assert_true(depth < 63);
        struct between *half = &stack[depth++];
        mpz_mul_2exp(i->low, i->low, 1);
        mpz_mul_2exp(i->high, i->high, 1);
        half->bits = ++i->bits;
        mpz_set(half->high, i->high);
        mpz_add(half->low, i->low, i->high);
        mpz_fdiv_q_2exp(half->low, half->low, 1);
        mpz_set(i->high, half->low);
      }
    }
    for (int k = 0; k < 64; k++)
      mpz_clears(stack[k].low, stack[k].high, NULL);
  }
  e->taken = mark;
  return found;
}

/* Changes of sign of the coefficients of f in the Bernstein basis of the interval, if f is zero at neither end; else
 * -1. f has no root there if there is none, and one simple root if there is one (Descartes' rule of signs). Only saves
 * time. */
static inline int changes_of_sign(struct exact_flight *e, const struct polynomial *f, int64_t length)
{
  /* f(u length) = sum a_i u^i;  b_j = sum_i C(j,i)/C(3,i) a_i;  times 3: 3 a0, 3 a0 + a1, 3 a0 + 2 a1 + a2, 3 (...) */
  static const int weight[4][4] = {{3, 0, 0, 0}, {3, 1, 0, 0}, {3, 2, 1, 0}, {3, 3, 3, 3}};
  int sign[4], changes = 0, last = 0;
  for (int j = 0; j < 4; j++) {
    mpz_set_ui(e->a, 0);
    for (int i = f->degree; i >= 0; i--) { /* Horner: sum weight a_i */
      mpz_mul_si(e->a, e->a, length);
      mpz_mul_si(e->b, f->c[i], weight[j][i]);
      mpz_add(e->a, e->a, e->b);
    }
    sign[j] = mpz_sgn(e->a);
    changes += sign[j] && last && sign[j] != last;
    last = sign[j] ? sign[j] : last;
  }
  return sign[0] && sign[3] ? changes : -1;
}

/* At the only root of f, a simple one, between 0 and length. */
static inline bool touches_at_only_root(struct exact_flight *e, int64_t length)
{
  struct between i = {.bits = 0};
  mpz_init_set_si(i.low, 0);
  mpz_init_set_si(i.high, length);
  const struct at_root r = {e, e->f, &i};
  const bool touches = touches_here(&r);
  mpz_clears(i.low, i.high, NULL);
  return touches;
}

/* A plane that keeps two coordinates of the bonds apart at both ends of the interval, hence between. */
static inline bool boxes_apart(const struct flight_pair *pair, int64_t from, int64_t to)
{
  __extension__ typedef __int128 wide_integer;
  const int64_t *at = &pair->p.x, *rate = &pair->p_rate.x;
  bool apart = false;
  for (int k = 0; k < 3; k++) {
    bool above = true, below = true;
    for (int end = 0; end < 2; end++) {
      const wide_integer tick = end ? to : from, p = at[k] + tick * rate[k], q = at[3 + k] + tick * rate[3 + k],
                         w = at[6 + k] + tick * rate[6 + k];
      above &= w + (q < 0 ? q : 0) - (p > 0 ? p : 0) > 0;
      below &= w + (q > 0 ? q : 0) - (p < 0 ? p : 0) < 0;
    }
    apart |= above || below;
  }
  return apart;
}

/* True if the two bonds touch at some time from tick `from` to tick `to`, both included. */
static inline bool exact_touch(struct exact_flight *e, const struct flight_pair *pair, int64_t from, int64_t to)
{
  if (boxes_apart(pair, from, to))
    return false;
  e->taken = 0;
  set_vector(e, e->p, pair->p, pair->p_rate, from);
  set_vector(e, e->q, pair->q, pair->q_rate, from);
  set_vector(e, e->w, pair->w, pair->w_rate, from);
  cross_polynomials(e, e->n, e->p, e->q);
  e->f = take(e);
  dot_polynomials(e->f, e->n, e->w);
  const int64_t length = to - from;
  if (e->f->degree >= 0) {
    const int changes = changes_of_sign(e, e->f, length);
    if (changes == 0 || changes == 1)
      return changes == 1 && touches_at_only_root(e, length);
    return any_root(e, e->f, length, touches_here);
  }

  /* In a plane, they touch at the beginning, or first with an end. */
  struct between begin = {.bits = 0};
  struct polynomial *linear = take(e);
  raise_degree(linear, 1); /* t, with its root at 0 */
  mpz_set_ui(linear->c[1], 1);
  mpz_inits(begin.low, begin.high, NULL);
  const struct at_root r = {e, linear, &begin};
  bool touches = touches_here(&r);
  mpz_clears(begin.low, begin.high, NULL);
  const int mark = e->taken;
  for (int end = 0; end < 4 && !touches; end++) {
    struct polynomial *v[3], *c[3], *const *bond = end < 2 ? e->p : e->q;
    e->taken = mark;
    if (end < 2)
      combine(e, v, 1, e->w, end, e->q);
    else
      combine(e, v, -1, e->w, end - 2, e->p);
    cross_polynomials(e, c, v, bond);
    struct polynomial *g = take(e);
    for (int k = 0; k < 3; k++) {
      if (c[k]->degree >= 0 && g->degree >= 0)
        greatest_common_divisor(e, g, g, c[k]);
      else if (c[k]->degree >= 0)
        copy_polynomial(g, c[k]);
    }
    if (g->degree >= 0) {
      touches = any_root(e, g, length, end_touches_here);
      continue;
    }
    /* Always on the line of the bond: it comes to an end of it, or the bond's length passes through zero. */
    for (int k = 0; k < 3 && !touches; k++) {
      struct polynomial *d = take(e);
      copy_polynomial(d, v[k]);
      touches = d->degree >= 0 && any_root(e, d, length, end_touches_here);
      add_polynomial(d, -1, bond[k]);
      touches = touches || (d->degree >= 0 && any_root(e, d, length, end_touches_here));
    }
  }
  return touches;
}

/* --- how far apart? ----------------------------------------------------------------------------------------------- */

struct exact_distance {
  mpz_t p[3], q[3], w[3], n[3], v[3], motion, pp, x, y, z, square;
};

static inline void exact_distance_open(struct exact_distance *d)
{
  for (int k = 0; k < 3; k++)
    mpz_inits(d->p[k], d->q[k], d->w[k], d->n[k], d->v[k], NULL);
  mpz_inits(d->motion, d->pp, d->x, d->y, d->z, d->square, NULL);
}

static inline void exact_distance_close(struct exact_distance *d)
{
  for (int k = 0; k < 3; k++)
    mpz_clears(d->p[k], d->q[k], d->w[k], d->n[k], d->v[k], NULL);
  mpz_clears(d->motion, d->pp, d->x, d->y, d->z, d->square, NULL);
}

static inline void dot_integers(mpz_t out, mpz_t a[3], mpz_t b[3])
{
  mpz_mul(out, a[0], b[0]);
  mpz_addmul(out, a[1], b[1]);
  mpz_addmul(out, a[2], b[2]);
}

/* The point v, from the first end of bond b, is at most as far from b as `motion` (squared) says. */
static inline bool end_is_near(struct exact_distance *d, mpz_t v[3], mpz_t b[3])
{
  dot_integers(d->pp, b, b);
  dot_integers(d->x, v, b);
  dot_integers(d->square, v, v);
  if (mpz_sgn(d->x) <= 0)
    return mpz_cmp(d->square, d->motion) <= 0;
  if (mpz_cmp(d->x, d->pp) >= 0) { /* |v - b|^2 = v.v - 2 v.b + b.b */
    mpz_submul_ui(d->square, d->x, 2);
    mpz_add(d->square, d->square, d->pp);
    return mpz_cmp(d->square, d->motion) <= 0;
  }
  mpz_sub(d->square, d->square, d->motion); /* (v.v - motion) b.b <= (v.b)^2 */
  mpz_mul(d->square, d->square, d->pp);
  mpz_mul(d->x, d->x, d->x);
  return mpz_cmp(d->square, d->x) <= 0;
}

static inline void set_integers(mpz_t v[3], struct point at, struct point rate, int64_t tick)
{
  const int64_t a[3] = {at.x, at.y, at.z}, r[3] = {rate.x, rate.y, rate.z};
  for (int k = 0; k < 3; k++) {
    mpz_set_si(v[k], r[k]);
    mpz_mul_si(v[k], v[k], tick);
    if (a[k] >= 0)
      mpz_add_ui(v[k], v[k], (unsigned long)a[k]);
    else
      mpz_sub_ui(v[k], v[k], (unsigned long)-a[k]);
  }
}

/* True if at this tick the distance of the bonds is at most `ticks` times the largest relative motion of any two of
 * their points within one tick. Squares of integers. */
static inline bool exact_near(struct exact_distance *d, const struct flight_pair *pair, int64_t tick, unsigned ticks)
{
  mpz_set_ui(d->motion, 0);
  for (int corner = 0; corner < 4; corner++) {
    const struct point zero = {0, 0, 0};
    set_integers(d->v, zero, pair->w_rate, 1);
    set_integers(d->p, zero, pair->p_rate, corner & 1);
    set_integers(d->q, zero, pair->q_rate, corner >> 1);
    for (int k = 0; k < 3; k++) {
      mpz_sub(d->v[k], d->v[k], d->p[k]);
      mpz_add(d->v[k], d->v[k], d->q[k]);
    }
    dot_integers(d->x, d->v, d->v);
    if (mpz_cmp(d->x, d->motion) > 0)
      mpz_set(d->motion, d->x);
  }
  mpz_mul_ui(d->motion, d->motion, (unsigned long)ticks * ticks);
  set_integers(d->p, pair->p, pair->p_rate, tick);
  set_integers(d->q, pair->q, pair->q_rate, tick);
  set_integers(d->w, pair->w, pair->w_rate, tick);

  bool near = end_is_near(d, d->w, d->p); /* the first end of q */
  for (int k = 0; k < 3; k++)
    mpz_add(d->v[k], d->w[k], d->q[k]);
  near = near || end_is_near(d, d->v, d->p);
  for (int k = 0; k < 3; k++)
    mpz_neg(d->v[k], d->w[k]);
  near = near || end_is_near(d, d->v, d->q);
  for (int k = 0; k < 3; k++)
    mpz_add(d->v[k], d->v[k], d->p[k]);
  near = near || end_is_near(d, d->v, d->q);
  if (near)
    return true;

  for (int k = 0; k < 3; k++) {
    mpz_mul(d->n[k], d->p[(k + 1) % 3], d->q[(k + 2) % 3]);
    mpz_submul(d->n[k], d->p[(k + 2) % 3], d->q[(k + 1) % 3]);
  }
  dot_integers(d->pp, d->n, d->n);
  if (mpz_sgn(d->pp) == 0)
    return false;
  for (int other = 0; other < 2; other++) { /* 0 <= (w x b).n <= n.n for b = q, p */
    mpz_t *b = other ? d->p : d->q;
    for (int k = 0; k < 3; k++) {
      mpz_mul(d->v[k], d->w[(k + 1) % 3], b[(k + 2) % 3]);
      mpz_submul(d->v[k], d->w[(k + 2) % 3], b[(k + 1) % 3]);
    }
    dot_integers(d->x, d->v, d->n);
    if (mpz_sgn(d->x) < 0 || mpz_cmp(d->x, d->pp) > 0)
      return false;
  }
  dot_integers(d->x, d->w, d->n); /* distance^2 = (w.n)^2 / n.n */
  mpz_mul(d->x, d->x, d->x);
  mpz_mul(d->y, d->motion, d->pp);
  return mpz_cmp(d->x, d->y) <= 0;
}

#endif

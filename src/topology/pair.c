/* Bounds of rounding are multiples of u = 2^-53 and of the largest components P, Q, W of the vectors. */
#include "topology/pair.h"

#include <math.h>

#define DEEPEST 40 /* halvings of [0, 1] */
#define WIDTH 0x1p-26
#define FINE_WIDTH 0x1p-48 /* of the few whose lines meet near an end of a bond */

/* A determinant has 6 products of three, each rounded at most 5 times: 31 u PQW. A coefficient of Bernstein is the
 * third of a sum of three: 64 u PQW with its own roundings. A halving takes three means of numbers up to 6 PQW: 19 u
 * PQW; a cut at a quarter twice as much. At most 48 and 16 of them: 1584 u PQW. */
#define CUBIC_ERROR (2048 * 0x1p-53)
#define MOST_QUARTERS 8 /* of each narrowing; a piece is narrowed twice at most */

/* (w x q).(p x q) has 12 products of four vectors, each known at t to 4 u of its largest component and multiplied and
 * added in 7 roundings: 288 u. Their derivative is below 12 * 4 * 2 = 96 products of the largest components. */
#define QUARTIC_ERROR (512 * 0x1p-53)
#define QUARTIC_SLOPE 96.0

/* How far off a piece may begin: after a cut at a quarter each of at most 64 cuts, and the middle, rounds it by u/2. */
#define BEGINS_WITHIN 0x1p-47

static double largest(const struct vec3 v[2])
{
  return fmax(fmax(fmax(fabs(v[0].x), fabs(v[0].y)), fmax(fabs(v[0].z), fabs(v[1].x))),
              fmax(fabs(v[1].y), fabs(v[1].z)));
}

static double determinant(struct vec3 a, struct vec3 b, struct vec3 c)
{
  return vec3_dot(vec3_cross(a, b), c);
}

static struct vec3 at(const struct vec3 v[2], double t)
{
  return vec3_add(v[0], vec3_scale(t, vec3_sub(v[1], v[0])));
}

/* True if w + s' q - s p lies on one side of 0 throughout: its corners do at both ends. */
static bool on_one_side(const double p[2], const double q[2], const double w[2])
{
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (int k = 0; k < 2; k++) {
    low = fmin(low, w[k] + fmin(q[k], 0.0) - fmax(p[k], 0.0));
    high = fmax(high, w[k] + fmax(q[k], 0.0) - fmin(p[k], 0.0));
  }
  return low > 0.0 || high < 0.0;
}

static bool apart_along_axis(const struct pair *a)
{
  return on_one_side((double[]){a->p[0].x, a->p[1].x}, (double[]){a->q[0].x, a->q[1].x},
                     (double[]){a->w[0].x, a->w[1].x}) ||
         on_one_side((double[]){a->p[0].y, a->p[1].y}, (double[]){a->q[0].y, a->q[1].y},
                     (double[]){a->w[0].y, a->w[1].y}) ||
         on_one_side((double[]){a->p[0].z, a->p[1].z}, (double[]){a->q[0].z, a->q[1].z},
                     (double[]){a->w[0].z, a->w[1].z});
}

/* f between a and a + width. */
struct piece {
  double c[4], a, width;
};

static int sign_of(double value, double error)
{
  return (value > error) - (value < -error);
}

static void halve(const struct piece *f, struct piece half[2])
{
  const double *c = f->c, a = 0.5 * (c[0] + c[1]), b = 0.5 * (c[1] + c[2]), d = 0.5 * (c[2] + c[3]);
  const double left = 0.5 * (a + b), right = 0.5 * (b + d), middle = 0.5 * (left + right);
  half[0] = (struct piece){{c[0], a, left, middle}, f->a, 0.5 * f->width};
  half[1] = (struct piece){{middle, right, d, c[3]}, f->a + 0.5 * f->width, 0.5 * f->width};
}

static double quarter(double a, double b)
{
  return 0.75 * a + 0.25 * b;
}

/* The last three quarters. */
static struct piece without_quarter(const struct piece *f)
{
  const double *c = f->c, a = quarter(c[0], c[1]), b = quarter(c[1], c[2]), d = quarter(c[2], c[3]);
  const double left = quarter(a, b), right = quarter(b, d);
  return (struct piece){{quarter(left, right), right, d, c[3]}, f->a + 0.25 * f->width, 0.75 * f->width};
}

/* The root in a piece with one, of which both ends have certain signs. A root in the middle is left there by a cut at a
 * quarter. */
static void narrow(struct piece *f, double width, double error)
{
  struct piece half[2];
  const int begin = sign_of(f->c[0], 0.0);
  for (int quarters = 0; f->width > width;) {
    halve(f, half);
    int middle = sign_of(half[1].c[0], error);
    if (middle == 0) {
      half[1] = without_quarter(f);
      middle = sign_of(half[1].c[0], error);
      if (middle != begin || quarters++ == MOST_QUARTERS)
        return;
    }
    *f = half[middle == begin];
  }
}

/* Whether the lines that meet in this piece meet within the bonds. */
static enum pair_verdict within(const struct pair *a, const struct piece *f, double P, double Q, double W,
                                struct crossing *crossing)
{
  const double t = f->a + 0.5 * f->width, doubt = QUARTIC_ERROR + QUARTIC_SLOPE * (0.5 * f->width + BEGINS_WITHIN);
  const struct vec3 p = at(a->p, t), q = at(a->q, t), w = at(a->w, t), n = vec3_cross(p, q);
  const double N = vec3_dot(n, n), on[2] = {vec3_dot(vec3_cross(w, q), n), vec3_dot(vec3_cross(w, p), n)};
  const double doubt_N = doubt * P * P * Q * Q, doubt_on[2] = {doubt * W * Q * P * Q, doubt * W * P * P * Q};
  bool inside = true;
  for (int k = 0; k < 2; k++) {
    if (on[k] < -doubt_on[k] || on[k] - N > doubt_on[k] + doubt_N)
      return PAIR_APART;
    inside = inside && on[k] > doubt_on[k] && N - on[k] > doubt_on[k] + doubt_N;
  }
  *crossing = (struct crossing){f->c[3] > 0.0 ? 1 : -1, t, {on[0] / N, on[1] / N}};
  return inside ? PAIR_CROSSED : PAIR_UNSURE;
}

enum pair_verdict pair_decide(const struct pair *a, struct crossing crossing[3], int *crossings)
{
  const struct vec3 *p = a->p, *q = a->q, *w = a->w;
  const double P = largest(p), Q = largest(q), W = largest(w), error = CUBIC_ERROR * P * Q * W;
  *crossings = 0;
  if (!(P < PAIR_REACH && Q < PAIR_REACH && W < PAIR_REACH))
    return PAIR_UNSURE;
  if (apart_along_axis(a))
    return PAIR_APART;
  const double b1 = determinant(p[1], q[0], w[0]) + determinant(p[0], q[1], w[0]) + determinant(p[0], q[0], w[1]);
  const double b2 = determinant(p[0], q[1], w[1]) + determinant(p[1], q[0], w[1]) + determinant(p[1], q[1], w[0]);
  struct piece stack[DEEPEST + 2] = {
      {{determinant(p[0], q[0], w[0]), b1 / 3.0, b2 / 3.0, determinant(p[1], q[1], w[1])}, 0.0, 1.0}};
  for (int pieces = 1; pieces > 0;) {
    struct piece f = stack[--pieces];
    const int c[4] = {sign_of(f.c[0], error), sign_of(f.c[1], error), sign_of(f.c[2], error), sign_of(f.c[3], error)};
    if (c[0] == 0 || c[3] == 0)
      return PAIR_UNSURE;
    if (c[0] == c[1] && c[0] == c[2] && c[0] == c[3])
      continue;
    if (c[0] != c[3] && (c[1] == c[0] || c[2] == c[3])) { /* one change of sign, whatever is not certain */
      narrow(&f, WIDTH, error);
      enum pair_verdict verdict = within(a, &f, P, Q, W, &crossing[*crossings]);
      if (verdict == PAIR_UNSURE) {
        narrow(&f, FINE_WIDTH, error);
        verdict = within(a, &f, P, Q, W, &crossing[*crossings]);
      }
      if (verdict == PAIR_UNSURE)
        return verdict;
      *crossings += verdict == PAIR_CROSSED;
      continue;
    }
    if (f.width < WIDTH)
      return PAIR_UNSURE;
    struct piece half[2];
    halve(&f, half);
    stack[pieces++] = half[1];
    stack[pieces++] = half[0];
  }
  return *crossings > 0 ? PAIR_CROSSED : PAIR_APART;
}

enum pair_verdict pair_folds(const struct pair *a)
{
  const struct vec3 *p = a->p, *q = a->q;
  const double P = largest(p), Q = largest(q), error = 64 * 0x1p-53 * P * Q;
  if (!(P < PAIR_REACH && Q < PAIR_REACH))
    return PAIR_UNSURE;
  /* Coefficients of Bernstein: the middle ones are twice what is written. */
  const double dot[3] = {vec3_dot(p[0], q[0]), vec3_dot(p[0], q[1]) + vec3_dot(p[1], q[0]), vec3_dot(p[1], q[1])};
  if (dot[0] < -error && dot[1] < -error && dot[2] < -error)
    return PAIR_APART;
  const struct vec3 first = vec3_cross(p[0], q[0]), last = vec3_cross(p[1], q[1]);
  const struct vec3 middle = vec3_add(vec3_cross(p[0], q[1]), vec3_cross(p[1], q[0]));
  const double cross[3][3] = {{first.x, middle.x, last.x}, {first.y, middle.y, last.y}, {first.z, middle.z, last.z}};
  for (int k = 0; k < 3; k++) {
    const int sign = sign_of(cross[k][0], error);
    if (sign != 0 && sign == sign_of(cross[k][1], error) && sign == sign_of(cross[k][2], error))
      return PAIR_APART;
  }
  return PAIR_UNSURE;
}

bool pair_is_near(const struct pair *a, double near)
{
  const struct vec3 p = a->p[0], q = a->q[0], w = a->w[0], n = vec3_cross(p, q);
  const double N = vec3_dot(n, n), s = vec3_dot(vec3_cross(w, q), n), other = vec3_dot(vec3_cross(w, p), n);
  const double height = vec3_dot(n, w);
  return N > 0.0 && s >= 0.0 && s <= N && other >= 0.0 && other <= N && height * height < near * near * N;
}

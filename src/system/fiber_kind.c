#include "system/fiber_kind.h"

#include "base/elementary.h"

static const double pi = 3.14159265358979323846;

double fiber_bonds(const struct fiber_kind *kind)
{
  return kind->ring ? kind->vertices : kind->vertices - 1.0;
}

/* The square of a size of a Gaussian chain of n vertices, over <l^2>: R_e^2 = n - 1, and six times R_g^2 = (n^2 - 1)/n.
 */
static double shape_of(double n, enum fiber_size size)
{
  return size == SIZE_ENDS ? n - 1.0 : (n * n - 1.0) / n;
}

double fiber_coarse_softening(const struct fiber_kind *kind)
{
  return kind->stands_for == 0 ? 1.0 : shape_of(kind->stands_for, kind->keeps) / shape_of(kind->vertices, kind->keeps);
}

double fiber_coarse_ratio(const struct fiber_kind *kind, enum fiber_size size)
{
  return kind->stands_for == 0
             ? 1.0
             : fiber_coarse_softening(kind) * shape_of(kind->vertices, size) / shape_of(kind->stands_for, size);
}

/* In d dimensions: <l> for p(l) ~ l^(d-1) exp(-k (l-l0)^2/2), l > 0; in the plane it is I_2/I_1. In space:
 *
 * <l> for p(l) ~ l^2 exp(-k (l-l0)^2/2), l > 0. With z = l sqrt(k), c = l0 sqrt(k), and the half-line moments
 * I_n = int_0^inf z^n exp(-(z-c)^2/2) dz: I_{n+1} = c I_n + n I_{n-1} (+ exp(-c^2/2) for n = 0), <z> = I_3/I_2. */
double fiber_mean_bond(const struct fiber_kind *kind)
{
  const double root = sqrt(kind->spring), c = kind->bond_length * root;
  const double i0 = 1.2533141373155002512 * (1.0 + elementary_erf(c * 0.70710678118654752440));
  const double i1 = c * i0 + elementary_exp(-0.5 * c * c);
  const double i2 = c * i1 + i0;
  const double i3 = c * i2 + 2.0 * i1;
  return kind->dimensions == 2 ? i2 / i1 / root : i3 / i2 / root;
}

double fiber_contour(const struct fiber_kind *kind)
{
  return fiber_bonds(kind) * fiber_mean_bond(kind);
}

double fiber_stretch_frequency(const struct fiber_kind *kind)
{
  if (kind->vertices < 2)
    return 0.0;
  double end = kind->ring ? 1.0 : cos(0.5 * pi / kind->vertices);
  return 2.0 * sqrt(kind->spring / kind->mass) * end;
}

/* True if lambda exceeds every eigenvalue of the n x n matrix with rows ... 1 -4 6 -4 1 ...: all pivots of lambda - A
 * are positive then (its Cholesky factor exists). */
static bool exceeds_fourth_difference(double lambda, uint32_t n)
{
  double pivot[2] = {1.0, 1.0}, first = 0.0, second = 0.0; /* two pivots back; l(i,i-1) d(i-1) of last row */
  double carried = 0.0;                                    /* l(i-1,i-2) */
  for (uint32_t i = 0; i < n; i++) {
    second = i >= 2 ? -1.0 / pivot[0] : 0.0;
    first = i >= 1 ? (4.0 - second * pivot[0] * carried) / pivot[1] : 0.0;
    double d = lambda - 6.0 - second * second * pivot[0] - first * first * pivot[1];
    if (!(d > 0.0))
      return false;
    pivot[0] = pivot[1];
    pivot[1] = d;
    carried = first;
  }
  return true;
}

/* Largest eigenvalue of D D^T, D the second differences of n + 2 points of a free chain. Its vector is an alternating
 * half wave on n + 2 - 1/sqrt(2) intervals, up to the layers at both ends: right to 1e-9 from 64 points on (compared
 * with LAPACK's eigenvalues). */
static double largest_fourth_difference(uint32_t n)
{
  if (n >= 64) {
    const double c = cos(0.5 * pi / (n + 1.29289321881345248));
    return 16.0 * c * c * c * c;
  }
  double low = 0.0, high = 16.0;
  for (int halving = 0; halving < 60; halving++) {
    double middle = 0.5 * (low + high);
    if (exceeds_fourth_difference(middle, n))
      high = middle;
    else
      low = middle;
  }
  return high;
}

double fiber_bend_frequency(const struct fiber_kind *kind)
{
  if (kind->vertices < 3)
    return 0.0;
  double lambda = kind->ring ? 16.0 : largest_fourth_difference(kind->vertices - 2);
  return sqrt(kind->bending * lambda / kind->mass) / fiber_mean_bond(kind);
}

double fiber_highest_frequency(const struct fiber_kind *kind)
{
  const double stretch = fiber_stretch_frequency(kind), bend = fiber_bend_frequency(kind);
  const double tension = fmax(0.0, 1.0 - kind->bond_length / fiber_mean_bond(kind));
  return fmax(stretch, sqrt(bend * bend + tension * stretch * stretch));
}

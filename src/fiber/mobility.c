#include "fiber/mobility.h"

#include <math.h>
#include <string.h>

static void oseen(double r, double a, double *p, double *q)
{
  *p = *q = 0.75 * a / r;
}

static void rotne_prager_yamakawa(double r, double a, double *p, double *q)
{
  const double s = a / r;
  if (r < 2.0 * a) {
    *p = 1.0 - 9.0 * r / (32.0 * a);
    *q = 3.0 * r / (32.0 * a);
    return;
  }
  *p = 0.75 * s * (1.0 + 2.0 / 3.0 * s * s);
  *q = 0.75 * s * (1.0 - 2.0 * s * s);
}

const struct mobility *mobility_of(enum medium_tensor tensor)
{
  static const struct mobility rows[MEDIUM_TENSORS] = {
      [TENSOR_NONE] = {"none", NULL}, [TENSOR_OSEEN] = {"oseen", oseen}, [TENSOR_RPY] = {"rpy", rotne_prager_yamakawa}};
  return &rows[tensor];
}

static void put_block(double p, double q, struct vec3 e, size_t order, double *corner)
{
  const double x[3] = {e.x, e.y, e.z};
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3; i++)
      corner[(size_t)k * order + (size_t)i] = (i == k ? p : 0.0) + q * x[i] * x[k];
}

void mobility_fill(const struct mobility *mobility, double a, uint32_t n, const struct vec3 *place, double *d)
{
  const size_t order = 3 * (size_t)n;
  for (uint32_t j = 0; j < n; j++) {
    put_block(1.0, 0.0, (struct vec3){0, 0, 0}, order, &d[3 * j * order + 3 * j]);
    for (uint32_t i = j + 1; i < n; i++) {
      const struct vec3 apart = vec3_sub(place[i], place[j]);
      const double r = sqrt(vec3_dot(apart, apart));
      double p, q;
      mobility->block(r, a, &p, &q);
      put_block(p, q, vec3_scale(r > 0.0 ? 1.0 / r : 0.0, apart), order, &d[3 * j * order + 3 * i]);
    }
  }
}

void mobility_apply(uint32_t n, const double *restrict d, const double *restrict x, double *restrict y)
{
  memset(y, 0, n * sizeof *y);
  for (uint32_t k = 0; k < n; k++) {
    const double *column = &d[(size_t)k * n];
    double sum = column[k] * x[k];
    for (uint32_t i = k + 1; i < n; i++) {
      y[i] += column[i] * x[k];
      sum += column[i] * x[i];
    }
    y[k] += sum;
  }
}

bool mobility_factor(uint32_t n, double *d, double *pivot)
{
  for (uint32_t k = 0; k < n; k++) {
    double *restrict column = &d[(size_t)k * n];
    *pivot = column[k];
    if (!(*pivot > -1e-12))
      return false;
    const double inverse = *pivot > 1e-12 ? 1.0 / sqrt(*pivot) : 0.0;
    for (uint32_t i = k; i < n; i++)
      column[i] *= inverse;
    for (uint32_t j = k + 1; j < n; j++) {
      double *restrict next = &d[(size_t)j * n];
      const double factor = column[j];
      for (uint32_t i = j; i < n; i++)
        next[i] -= factor * column[i];
    }
  }
  return true;
}

void mobility_root(uint32_t n, const double *restrict l, const double *restrict x, double *restrict y)
{
  memset(y, 0, n * sizeof *y);
  for (uint32_t k = 0; k < n; k++) {
    const double *column = &l[(size_t)k * n];
    for (uint32_t i = k; i < n; i++)
      y[i] += column[i] * x[k];
  }
}

void mobility_solve(uint32_t n, const double *restrict l, double *restrict x)
{
  for (uint32_t k = 0; k < n; k++) {
    const double *column = &l[(size_t)k * n];
    x[k] /= column[k];
    for (uint32_t i = k + 1; i < n; i++)
      x[i] -= column[i] * x[k];
  }
  for (uint32_t k = n; k-- > 0;) {
    const double *column = &l[(size_t)k * n];
    for (uint32_t i = k + 1; i < n; i++)
      x[k] -= column[i] * x[i];
    x[k] /= column[k];
  }
}

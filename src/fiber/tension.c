#include "fiber/tension.h"

#include <stddef.h>

#include "fiber/mobility.h"

static double entry(const double *d, size_t n, size_t i, size_t k)
{
  return !d ? (double)(i == k) : i >= k ? d[k * n + i] : d[i * n + k];
}

/* u.D_ij.w of two vertices. */
static double between(const double *d, uint32_t n, uint32_t i, struct vec3 u, uint32_t j, struct vec3 w)
{
  const double x[3] = {u.x, u.y, u.z}, y[3] = {w.x, w.y, w.z};
  double sum = 0.0;
  for (uint32_t a = 0; a < 3; a++)
    for (uint32_t b = 0; b < 3; b++)
      sum += x[a] * entry(d, n, 3 * i + a, 3 * j + b) * y[b];
  return sum;
}

static double matrix_entry(const double *d, uint32_t n, const struct tension_bond *p, const struct tension_bond *q)
{
  return between(d, n, p->to, p->along, q->to, q->along) - between(d, n, p->to, p->along, q->from, q->along) -
         between(d, n, p->from, p->along, q->to, q->along) + between(d, n, p->from, p->along, q->from, q->along);
}

static struct vec3 vector_at(const double *x, uint32_t vertex)
{
  return (struct vec3){x[3 * (size_t)vertex], x[3 * (size_t)vertex + 1], x[3 * (size_t)vertex + 2]};
}

static void add_at(double *x, uint32_t vertex, double t, struct vec3 u)
{
  x[3 * (size_t)vertex] += t * u.x;
  x[3 * (size_t)vertex + 1] += t * u.y;
  x[3 * (size_t)vertex + 2] += t * u.z;
}

bool tension_add(uint32_t n, const double *d, const double *pull, uint32_t bonds, const struct tension_bond *bond,
                 double *matrix, double *t, double *force, double *pivot)
{
  for (uint32_t k = 0; k < bonds; k++) {
    const struct vec3 apart = vec3_sub(vector_at(pull, bond[k].to), vector_at(pull, bond[k].from));
    t[k] = -vec3_dot(bond[k].along, apart) - bond[k].excess;
    for (uint32_t i = k; i < bonds; i++)
      matrix[(size_t)k * bonds + i] = matrix_entry(d, n, &bond[i], &bond[k]);
  }
  if (!mobility_factor(bonds, matrix, pivot))
    return false;
  for (uint32_t k = 0; k < bonds; k++) {
    *pivot = matrix[(size_t)k * bonds + k] * matrix[(size_t)k * bonds + k];
    if (!(*pivot > TENSION_LEAST_PIVOT))
      return false;
  }
  mobility_solve(bonds, matrix, t);
  for (uint32_t k = 0; k < bonds; k++) {
    add_at(force, bond[k].to, t[k], bond[k].along);
    add_at(force, bond[k].from, -t[k], bond[k].along);
  }
  return true;
}

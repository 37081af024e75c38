/* Tolerances of contacts at their own time: docs/port/tolerances.md derives them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/lattice.h"
#include "contact/impulse.h"
#include "oracle/tolerance.h"

/* --- one impulse ------------------------------------------------------------------------------------------------- */

struct sizes {
  double approach, pull;       /* a and h of our inputs */
  double of_approach, of_pull; /* sums of the sizes of their terms */
  double compliance, levers;   /* sum of lever^2/M, of |lever|/M */
  double momentum;             /* |dP| */
};

static const char *const ends_of[4] = {"p0", "p1", "q0", "q1"};

static double value(const struct oracle_pair *p, const char *kind, int end, uint32_t row, uint32_t column)
{
  char name[PACK_WORD];
  snprintf(name, sizeof name, "in.%s%s", kind, ends_of[end]);
  const struct pack_table *t = oracle_sibling(p, name);
  return t ? pack_value(t, row, column) : NAN;
}

static bool take_sizes(const struct oracle_pair *p, uint32_t row, struct sizes *z)
{
  const struct pack_table *mass = oracle_sibling(p, "in.mass"), *contact = oracle_sibling(p, "in.contact"),
                          *normal = oracle_sibling(p, "in.normal"), *tau = oracle_sibling(p, "in.tau"),
                          *momentum = oracle_sibling(p, "out.momentum");
  if (!mass || !contact || !normal || !tau || !momentum)
    return false;
  const double s = pack_value(contact, row, 0), t = pack_value(contact, row, 1);
  const double lever[4] = {1.0 - s, s, t - 1.0, -t}, time = pack_value(tau, row, 0);
  *z = (struct sizes){.momentum = fabs(pack_value(momentum, row, 0))};
  for (int k = 0; k < 4; k++) {
    const double m = pack_value(mass, row, (uint32_t)k);
    for (uint32_t c = 0; c < 3; c++) {
      const double n = pack_value(normal, row, c), v = lever[k] * value(p, "", k, row, c) * n,
                   f = time * lever[k] * value(p, "force_", k, row, c) * n / m;
      z->approach += v, z->of_approach += fabs(v);
      z->pull += f, z->of_pull += fabs(f);
    }
    z->compliance += lever[k] * lever[k] / m;
    z->levers += fabs(lever[k]) / m;
  }
  return z->compliance > 0.0;
}

/* At a bound of the rebound, and where bonds hardly approach, rounding may choose. */
double tolerance_impulse_answer(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  struct sizes z;
  (void)column;
  if (!take_sizes(p, row, &z))
    return 0.0;
  const double bound = CONTACT_SLOWEST_REBOUND, a = z.approach, straight = a + 2.0 * z.pull;
  const double of_a = 26.0 * z.of_approach * p->rounding, off = of_a + 60.0 * z.of_pull * p->rounding;
  return fabs(a) <= of_a ? 2.0 : fabs(straight - bound * a) <= off || fabs(bound * straight - a) <= off ? 1.0 : 0.0;
}

double tolerance_impulse_momentum(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  struct sizes z;
  (void)column;
  if (!take_sizes(p, row, &z))
    return 0.0;
  return (740.0 * z.of_approach + 260.0 * z.of_pull + z.momentum * (8.0 * z.levers + 20.0 * z.compliance)) /
         z.compliance * p->rounding;
}

double tolerance_impulse_velocity(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  struct sizes z;
  const struct pack_table *mass = oracle_sibling(p, "in.mass");
  for (int k = 0; mass && take_sizes(p, row, &z) && k < 4; k++)
    if (strcmp(ends_of[k], p->ours->name + strlen("out.")) == 0) {
      const double m = pack_value(mass, row, (uint32_t)k), v = fabs(value(p, "", k, row, column));
      return tolerance_impulse_momentum(p, row, column) / m + (18.0 * z.momentum / m + 4.0 * v) * p->rounding;
    }
  return 0.0;
}

/* --- a drift ------------------------------------------------------------------------------------------------------ */

static double condition(const struct oracle_pair *p, uint32_t row)
{
  const struct pack_table *t = oracle_sibling(p, "bound.hit");
  return t && row < t->rows ? pack_value(t, row, 0) : 1.0;
}

static double length_of(const struct oracle_pair *p)
{
  return tolerance_largest(oracle_sibling(p, "in.time"), 0, 1);
}

/* Speeds, of vertices and of what forces add to them in tau. */
static double find_speeds(const struct oracle_pair *p)
{
  const struct pack_table *time = oracle_sibling(p, "in.time");
  const double tau = length_of(p) + tolerance_largest(time, 1, 2);
  return tolerance_size_of(p, "in.velocity") + tau * tolerance_strongest(p) / tolerance_lightest(p);
}

static double speeds(const struct oracle_pair *p)
{
  return tolerance_once(p, find_speeds);
}

/* The four vertices of an event, and those up to two further along their fibers, whose places its forces depend on; a
 * vertex may come twice. Numbers that are no vertices are left out. */
static uint32_t reached_by(const struct pack_table *chain, const struct pack_table *event, uint32_t row,
                           uint32_t vertex[20])
{
  uint32_t n = 0;
  for (uint32_t k = 0; k < 2; k++) {
    const double bond = pack_value(event, row, k);
    const double ends[2] = {bond, bond >= 0.0 && bond < chain->rows ? pack_value(chain, (uint32_t)bond, 0) : -1.0};
    for (int e = 0; e < 2; e++)
      if (ends[e] >= 0.0 && ends[e] < chain->rows)
        vertex[n++] = (uint32_t)ends[e];
  }
  const uint32_t own = n;
  for (uint32_t k = 0; k < own; k++)
    for (uint32_t way = 0; way < 2; way++) {
      double at = vertex[k];
      for (int far = 0; far < 2; far++) {
        at = pack_value(chain, (uint32_t)at, way);
        if (!(at >= 0.0 && at < chain->rows))
          break;
        vertex[n++] = (uint32_t)at;
      }
    }
  return n;
}

/* worst[v]: the largest condition number among the contacts that the flight of vertex v depends on: its own, and those
 * before them of all who took part. 0: it had no contact. NULL if memory is short, or without a chain. */
static double *find_worst(const struct oracle_pair *p)
{
  const struct pack_table *event = oracle_sibling(p, "out.event"), *chain = tolerance_of_model(p, "in.chain");
  double *worst = chain ? calloc((size_t)chain->rows + 1, sizeof *worst) : NULL;
  uint32_t at[20];
  for (uint32_t row = 0; worst && event && row < event->rows; row++) {
    double most = condition(p, row);
    const uint32_t n = reached_by(chain, event, row, at);
    for (uint32_t k = 0; k < n; k++)
      most = fmax(most, worst[at[k]]);
    for (uint32_t k = 0; k < 4 && k < n; k++)
      worst[at[k]] = most;
  }
  return worst;
}

static double worst_of(const struct oracle_pair *p, uint32_t vertex)
{
  const struct pack_table *chain = tolerance_of_model(p, "in.chain");
  return tolerance_of_vertex(p, find_worst, vertex, chain ? chain->rows : 0);
}

double tolerance_event_hit(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double scale = column == 5 ? 200.0 * tolerance_heaviest(p) * speeds(p) : 1.0;
  return 64.0 * condition(p, row) * scale * p->rounding;
}

double tolerance_event_velocity(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double exchange = 64.0 * worst_of(p, row) * 200.0 * tolerance_heaviest(p) / tolerance_lightest(p);
  (void)column;
  return (exchange + (tolerance_single(p) ? 1.0 : 0.0)) * speeds(p) * p->rounding;
}

/* A rate may fall to the next integer: a unit in each tick. Velocities that go in are exact, but in single precision.
 */
double tolerance_event_position(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const bool inexact = tolerance_single(p) || worst_of(p, row) > 0.0;
  return inexact ? 0x1p16 + LATTICE_PER_A0 * length_of(p) *
                                (tolerance_event_velocity(p, row, column) + 4.0 * speeds(p) * p->rounding)
                 : 0.0;
}

/* Tolerances of crossings, of their exchanges, and of sweeps, in which vertices move one by one
 * (docs/port/tolerances.md). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/lattice.h"
#include "oracle/tolerance.h"

static double condition(const struct oracle_pair *p, uint32_t row)
{
  const struct pack_table *t = oracle_sibling(p, "bound.hit");
  return t && row < t->rows ? pack_value(t, row, 0) : 1.0;
}

double tolerance_crossing_hit(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  return 64.0 * condition(p, row) * p->rounding;
}

/* --- what a sweep inherits from its own exchanges ---------------------------------------------------------------- */

enum { MOST_INHERITING = 1 << 16 };

/* Moving vertex, pivot, and the ends of the standing bond of an event. False if the pack has no such vertices. */
static bool four_of(const struct oracle_pair *p, const struct pack_table *event, uint32_t row, uint32_t four[4])
{
  const struct pack_table *chain = tolerance_of_model(p, "in.chain");
  if (!chain || event->columns < 3)
    return false;
  const double vertex = pack_value(event, row, 0), moving = pack_value(event, row, 1),
               standing = pack_value(event, row, 2);
  if (!(vertex >= 0.0 && vertex < chain->rows && standing >= 0.0 && standing < chain->rows))
    return false;
  const double pivot = moving == vertex ? pack_value(chain, (uint32_t)vertex, 0) : moving;
  const double end = pack_value(chain, (uint32_t)standing, 0);
  if (!(pivot >= 0.0 && pivot < chain->rows && end >= 0.0 && end < chain->rows))
    return false;
  four[0] = (uint32_t)vertex, four[1] = (uint32_t)pivot, four[2] = (uint32_t)standing, four[3] = (uint32_t)end;
  return true;
}

/* error[v]: bound on the relative error of the velocities of vertex v before event `until`, over u. An exchange takes
 * the errors of its four vertices into its data, amplified by the condition number, and hands them on. */
static bool inherit(const struct oracle_pair *p, uint32_t until, double error[MOST_INHERITING])
{
  const struct pack_table *event = oracle_sibling(p, "out.event"), *chain = tolerance_of_model(p, "in.chain");
  const double masses = 8.0 * tolerance_heaviest(p) / tolerance_lightest(p);
  uint32_t four[4];
  if (!event || event->columns < 7 || !chain || chain->rows > MOST_INHERITING)
    return false;
  memset(error, 0, chain->rows * sizeof *error);
  for (uint32_t row = 0; row < event->rows && row < until; row++) {
    if (pack_value(event, row, 6) == 0.0 || !four_of(p, event, row, four))
      continue;
    double most = 0.0;
    for (int k = 0; k < 4; k++)
      most = fmax(most, error[four[k]]);
    for (int k = 0; k < 4; k++)
      error[four[k]] = most + 8.0 + (64.0 + most) * condition(p, row) * masses;
  }
  return true;
}

/* The largest such error among the vertices of an event; of one vertex after all events. */
static double inherited_by_event(const struct oracle_pair *p, uint32_t row)
{
  double *error = malloc(MOST_INHERITING * sizeof *error), most = 0.0;
  const struct pack_table *event = oracle_sibling(p, "out.event");
  uint32_t four[4];
  if (error && event && inherit(p, row, error) && four_of(p, event, row, four))
    for (int k = 0; k < 4; k++)
      most = fmax(most, error[four[k]]);
  free(error);
  return most;
}

static double *find_inherited(const struct oracle_pair *p)
{
  double *error = calloc(MOST_INHERITING, sizeof *error);
  if (error && !inherit(p, UINT32_MAX, error))
    memset(error, 0, MOST_INHERITING * sizeof *error);
  return error;
}

static double inherited_by_vertex(const struct oracle_pair *p, uint32_t vertex)
{
  return tolerance_of_vertex(p, find_inherited, vertex, MOST_INHERITING);
}

double tolerance_sweep_hit(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double scale = column == 6 ? 8.0 * tolerance_heaviest(p) * tolerance_size_of(p, "in.velocity") : 1.0;
  const double inherited = tolerance_single(p) ? inherited_by_event(p, row) : 0.0;
  return (64.0 + inherited) * condition(p, row) * scale * p->rounding;
}

double tolerance_sweep_velocity(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double exchange = tolerance_single(p) ? inherited_by_vertex(p, row)
                                              : 64.0 * tolerance_size_of(p, "bound.hit") * 8.0 * tolerance_heaviest(p) /
                                                    tolerance_lightest(p);
  (void)column;
  return (8.0 + exchange) * tolerance_size_of(p, "in.velocity") * p->rounding;
}

double tolerance_sweep_position(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double time = tolerance_size_of(p, "in.time");
  return 1.0 + LATTICE_PER_A0 * time *
                   (4.0 * tolerance_size_of(p, "in.velocity") * p->rounding + tolerance_sweep_velocity(p, row, column));
}

/* --- one exchange ------------------------------------------------------------------------------------------------ */

struct exchange_sizes {
  double approach, compliance, levers; /* 2 sum |V||n|, sum of lever^2/M, sum of |lever|/M */
  double momentum;                     /* |dP| */
};

static const char *const exchange_ends[4] = {"in.moving", "in.pivot", "in.a", "in.b"};

static bool take_sizes(const struct oracle_pair *p, uint32_t row, struct exchange_sizes *z)
{
  const struct pack_table *mass = oracle_sibling(p, "in.mass"), *contact = oracle_sibling(p, "in.contact"),
                          *normal = oracle_sibling(p, "in.normal"), *momentum = oracle_sibling(p, "out.momentum");
  if (!mass || !contact || !normal || !momentum)
    return false;
  const double s = pack_value(contact, row, 0), standing = pack_value(contact, row, 1);
  const double lever[4] = {1.0 - s, s, 1.0 - standing, standing};
  *z = (struct exchange_sizes){.momentum = fabs(pack_value(momentum, row, 0))};
  for (uint32_t k = 0; k < 4; k++) {
    const struct pack_table *v = oracle_sibling(p, exchange_ends[k]);
    for (uint32_t c = 0; v && c < 3; c++)
      z->approach += 2.0 * fabs(pack_value(v, row, c) * pack_value(normal, row, c));
    z->compliance += lever[k] * lever[k] / pack_value(mass, row, k);
    z->levers += fabs(lever[k]) / pack_value(mass, row, k);
  }
  return z->compliance > 0.0;
}

double tolerance_exchange_momentum(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  struct exchange_sizes z;
  (void)column;
  if (!take_sizes(p, row, &z))
    return 0.0;
  return (26.0 * z.approach + z.momentum * (8.0 * z.levers + 20.0 * z.compliance)) / z.compliance * p->rounding;
}

double tolerance_exchange_velocity(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  struct exchange_sizes z;
  const struct pack_table *mass = oracle_sibling(p, "in.mass");
  for (uint32_t k = 0; mass && take_sizes(p, row, &z) && k < 4; k++)
    if (strcmp(exchange_ends[k] + strlen("in."), p->ours->name + strlen("out.")) == 0) {
      const double m = pack_value(mass, row, k);
      const double v = fabs(pack_value(oracle_sibling(p, exchange_ends[k]), row, column));
      return tolerance_exchange_momentum(p, row, column) / m + (18.0 * z.momentum / m + 4.0 * v) * p->rounding;
    }
  return 0.0;
}

/* Tables of the operators `crossing` and `exchange`: one test for a crossing, one exchange of momentum, each alone. */
#ifndef UNCROSS_ORACLE_CONTACT_ROWS_H
#define UNCROSS_ORACLE_CONTACT_ROWS_H

#include "contact/line.h"
#include "oracle/operators.h"

/* What an exchange of momentum is computed from; the four vertices are moving vertex, pivot, and the standing bond's
 * first and second end. */
struct oracle_exchange {
  struct vec3 velocity[4]; /* a0/t0 */
  double mass[4];
  double s, s_standing;
  struct vec3 normal;
};

/* Puts n tests with their results; n exchanges with the velocities after them. */
void oracle_put_crossings(struct oracle_stage *g, const struct crossing_query *q, uint32_t n);
void oracle_put_exchanges(struct oracle_stage *g, const struct oracle_exchange *before, uint32_t n);

#endif

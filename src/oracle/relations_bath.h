/* Inside the oracle: what guesses of baths (relations_medium.c) and of pairs (relations_pairs.c) have in common. */
#ifndef UNCROSS_ORACLE_RELATIONS_BATH_H
#define UNCROSS_ORACLE_RELATIONS_BATH_H

#include "medium/bath.h"
#include "oracle/relations_flow.h"

enum { KIND, DRAW, WEIGHT, TENSOR, SECOND };                              /* columns of in.medium */
enum { RATE, RADIUS, REPULSION, BETWEEN, MANY_BODY, MANY_RANGE, FLOW_X }; /* of in.bath */

static inline double of_bath(const struct evidence_part *part, uint32_t column)
{
  return of_model(part, "in.bath", 0, column);
}

static inline double rate_times_step(const struct evidence_part *part)
{
  return of_bath(part, RATE) * of_model(part, "in.reals", 0, 0);
}

/* The loss of the pack's draw; linear: x itself. NaN where the draw is none. */
static inline double loss_of(const struct evidence_part *part, double x, bool linear)
{
  const double draw = of_model(part, "in.medium", 0, DRAW);
  double loss = NAN;
  if (draw >= 0.0 && draw < MEDIUM_DRAWS)
    bath_draw_of((enum medium_draw)(int)draw)->lose(&x, 1, &loss);
  return linear ? x : loss;
}

static inline bool draw_chooses(const struct evidence_part *part)
{
  return of_model(part, "in.medium", 0, DRAW) == DRAW_REPLACE;
}

/* The amplitude of a bath's noise; linear: as if the loss were small. */
static inline double noise_of(double loss, double inverse, bool linear)
{
  return linear ? sqrt(2.0 * loss * inverse) : bath_noise(loss, inverse);
}

#endif

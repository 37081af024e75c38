/* The turn of a collision, made with one thing changed. */
#include <math.h>

#include "oracle/patterns.h"
#include "oracle/relations.h"

#define COUNT_OF(list) (sizeof(list) / sizeof *(list))

/* --- rotation ----------------------------------------------------------------------------------------------------- */

struct rotation_twist {
  double sense, cosine, sine, along; /* less 1; of the terms cos w, sin n x w, (1 - cos) n (n.w) */
  double power;                      /* of the factor, less 1 */
  double subtract, add;              /* times the center, less 1 */
  int axis_of, center_of, factor_of; /* cells further on */
  int flipped;                       /* 1 + component of the axis */
  const char *text;
  bool quarter, no_versine, versine_turned, exchanged, unturned, turned_back, center_scaled, inactive, axis_of_first;
  bool factor_of_first, center_of_first, half_turn, exchanged_terms;
};

static double of_cell(const struct pack_table *t, uint32_t cell, int further, uint32_t column)
{
  return pack_value(t, (cell + t->rows + (uint32_t)further) % t->rows, column);
}

static double rotation_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct rotation_twist *t = twist;
  char name[PACK_WORD];
  snprintf(name, sizeof name, "in.%.20s_cell", part->pair.ours->name + 4);
  const struct pack_table *cells = oracle_sibling(&part->pair, name), *in = oracle_before(&part->pair);
  const struct pack_table *active = oracle_sibling(&part->pair, "in.active"),
                          *center = oracle_sibling(&part->pair, "in.center");
  const struct pack_table *axis = oracle_sibling(&part->pair, "in.axis"),
                          *factor = oracle_sibling(&part->pair, "in.factor");
  const struct pack_table *reals = oracle_model(&part->pair, "in.reals");
  if (!cells || !in || !active || !center || !axis || !factor || !reals || in->columns != 3 || axis->rows == 0 ||
      center->rows == 0 || factor->rows == 0)
    return NAN;
  const double number = pack_value(cells, row, 0);
  if (!(number >= 0.0 && number < active->rows))
    return NAN;
  const uint32_t cell = (uint32_t)number;
  if (pack_value(active, cell, 0) == 0.0 && !t->inactive)
    return pack_value(in, row, column);
  double w[3], n[3], c[3];
  for (uint32_t k = 0; k < 3; k++) {
    c[k] = t->center_of_first ? pack_value(center, 0, k) : of_cell(center, cell, t->center_of, k);
    n[k] = (1.0 + t->sense) * (t->axis_of_first ? pack_value(axis, 0, k) : of_cell(axis, cell, t->axis_of, k));
    n[k] = t->flipped == (int)k + 1 ? -n[k] : n[k];
    w[k] = pack_value(in, row, k) - (1.0 + t->subtract) * c[k];
    w[k] = t->turned_back ? -w[k] : w[k];
  }
  const double cos_alpha = t->exchanged ? pack_value(reals, 0, 2) : pack_value(reals, 0, 1);
  const double sin_alpha = t->exchanged ? pack_value(reals, 0, 1) : pack_value(reals, 0, 2);
  const double cosine = t->quarter ? 0.0 : t->half_turn ? -1.0 : cos_alpha;
  const double sine = t->quarter ? 1.0 : t->half_turn ? 0.0 : sin_alpha;
  const double still = 1.0 - (t->exchanged_terms ? sin_alpha : cosine);
  const double dot = n[0] * w[0] + n[1] * w[1] + n[2] * w[2];
  const uint32_t i = (column + 1) % 3, j = (column + 2) % 3;
  const double turned = (t->cosine < 0.0 ? 1.0 : cosine) * w[column] * (t->cosine > 0.0 ? 0.0 : 1.0) +
                        (1.0 + t->along) *
                            (t->no_versine       ? 1.0
                             : t->versine_turned ? 1.0 + cosine
                                                 : still) *
                            dot * n[column] +
                        (1.0 + t->sine) * sine * (n[i] * w[j] - n[j] * w[i]);
  const double f =
      pow(t->factor_of_first ? pack_value(factor, 0, 0) : of_cell(factor, cell, t->factor_of, 0), 1.0 + t->power);
  return (1.0 + t->add) * (t->center_scaled ? f : 1.0) * c[column] + f * (t->unturned ? w[column] : turned);
}

static bool rotations(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct rotation_twist known[] = {
      {.sense = -2.0, .text = "rotation transposed: turned by -alpha"},
      {.inactive = true, .text = "cells that are not active are turned, too"},
      {.power = -1.0, .text = "the thermostat's factor is left out"},
      {.power = 1.0, .text = "the thermostat's factor squared"},
      {.power = -2.0, .text = "the thermostat's factor inverted"},
      {.power = -0.5, .text = "the root of the thermostat's factor"},
      {.center_scaled = true, .text = "the factor of the center too: it is of the relative velocity"},
      {.subtract = -1.0,
       .add = -1.0,
       .text = "turned in the frame at rest: the center is not subtracted and added again"},
      {.add = -1.0, .text = "the center is not added again after the turn"},
      {.subtract = -1.0, .text = "the center is not subtracted before the turn"},
      {.subtract = -2.0, .text = "sign: the center is added before the turn, not subtracted"},
      {.add = -2.0, .text = "sign: the center is subtracted after the turn, not added"},
      {.add = 1.0, .text = "the center is added twice after the turn"},
      {.quarter = true, .text = "turned by 90 degrees always"},
      {.cosine = -1.0, .text = "cosine left out: w for cos w"},
      {.cosine = 1.0, .text = "the term with the cosine left out: cos w"},
      {.exchanged = true, .text = "cosine and sine of the angle exchanged"},
      {.exchanged = true, .exchanged_terms = true, .text = "cosine and sine exchanged in the terms across the axis"},
      {.versine_turned = true, .text = "1 + cosine for 1 - cosine in the part along the axis"},
      {.unturned = true, .text = "relative velocities are scaled, but not turned"},
      {.turned_back = true, .text = "sign: the relative velocity is the center's less the member's"},
      {.half_turn = true, .text = "turned by 180 degrees always"},
      {.factor_of_first = true, .text = "the factor of one cell, number 0, for all"},
      {.center_of_first = true, .text = "the center of one cell, number 0, for all"},
      {.no_versine = true, .text = "1 - cosine left out of the part along the axis"},
      {.along = -1.0, .text = "the part along the axis is left out"},
      {.along = -2.0, .text = "sign of the part along the axis"},
      {.sine = -1.0, .text = "the term with the sine is left out"},
      {.axis_of = 1, .text = "the axis of another cell: the next one"},
      {.axis_of = -1, .text = "the axis of another cell: the one before"},
      {.axis_of_first = true, .text = "the axis of one cell, number 0, for all"},
      {.flipped = 1, .text = "sign of the axis' x"},
      {.flipped = 2, .text = "sign of the axis' y"},
      {.flipped = 3, .text = "sign of the axis' z"},
      {.center_of = 1, .text = "the center of another cell: the next one"},
      {.center_of = -1, .text = "the center of another cell: the one before"},
      {.factor_of = 1, .text = "the factor of another cell: the next one"},
      {.factor_of = -1, .text = "the factor of another cell: the one before"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, rotation_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

const struct relation oracle_relations_rotate[] = {
    {"rotate", NULL, rotations, false},
    {.make = NULL},
};

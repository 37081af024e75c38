/* The collision by the rule at-a, made with one thing changed: velocities that are drawn, and those that are given. */
#include <math.h>
#include <string.h>

#include "base/normal.h"
#include "oracle/patterns.h"
#include "oracle/relations.h"

#define COUNT_OF(list) (sizeof(list) / sizeof *(list))

static bool is_vertex(const struct evidence_part *part)
{
  return strcmp(part->pair.ours->name, "out.vertex") == 0;
}

/* --- drawn velocities --------------------------------------------------------------------------------------------- */

struct draw_twist {
  int later, draw, entity, purpose; /* more than it should be */
  double power;                     /* of the mass; -1/2 */
  bool of_other, of_pairs, without_signs;
  int place; /* of the number that is taken, after its own */
  const char *text;
};

static double draw_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct draw_twist *t = twist;
  const bool vertex = is_vertex(part) != t->of_other;
  const struct pack_table *masses = oracle_model(&part->pair, "in.vertex");
  const uint64_t step = part->pair.ours->place.step + (uint64_t)(int64_t)t->later, seed = oracle_seed(&part->pair);
  const enum random_purpose own = vertex ? RANDOM_ANDERSEN_VERTEX : RANDOM_ANDERSEN_PARTICLE;
  const enum random_purpose purpose = t->purpose ? (enum random_purpose)t->purpose : own;
  const uint32_t entity = row + (uint32_t)t->entity;
  double three[4];
  if (t->of_pairs) {
    random_normal_pair(random_at(seed, purpose, 0, step, entity), three);
    random_normal_pair(random_at(seed, purpose, 1, step, entity), &three[2]);
  } else {
    random_normal_three(random_at(seed, purpose, (uint32_t)t->draw, step, entity), three);
  }
  const double mass = is_vertex(part) && masses ? pack_value(masses, row, 0) : 1.0;
  const double number = three[(column + (uint32_t)t->place) % 3];
  return (t->without_signs && column < 2 ? fabs(number) : number) * pow(mass, t->power);
}

static bool draws(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct draw_twist known[] = {
      {.later = -1, .power = -0.5, .text = "random address: the velocities of the step before"},
      {.later = 1, .power = -0.5, .text = "random address: the velocities of the step after"},
      {.draw = 1, .power = -0.5, .text = "random address: draw 1: it is 0"},
      {.entity = 1, .power = -0.5, .text = "random address: the velocities of the next entity"},
      {.of_other = true, .power = -0.5, .text = "random address: purposes of particles and vertices exchanged"},
      {.of_pairs = true, .power = -0.5, .text = "normal pairs of draws 0 and 1: all three are of draw 0"},
      {.without_signs = true, .power = -0.5, .text = "x and y without their signs, bits 23 and 22 of word 1"},
      {.place = 1, .power = -0.5, .text = "the three numbers in another order: y, z, x"},
      {.place = 2, .power = -0.5, .text = "the three numbers in another order: z, x, y"},
      {.power = 0.0, .text = "velocities without the mass: they are over its root"},
      {.power = -1.0, .text = "velocities over the mass: over its root"},
      {.power = 0.5, .text = "velocities times the root of the mass: over it"},
  };
  struct draw_twist t = {.power = -0.5};
  if (k < COUNT_OF(known)) {
    t = known[k];
    relation_say(text, "%s", t.text);
  } else if (k < COUNT_OF(known) + 24) {
    t.purpose = 1 + (int)(k - COUNT_OF(known));
    relation_say(text, "random address: the velocities with purpose %d", t.purpose);
  } else {
    return false;
  }
  relation_fill(e, draw_value, &t);
  return true;
}

/* --- velocities that members are given ---------------------------------------------------------------------------- */

struct give_twist {
  double center, drawn, own; /* times what they are; own: of the velocity before */
  int center_of, drawn_of;
  bool inactive, inactive_drawn;
  const char *text;
};

static double give_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct give_twist *t = twist;
  const struct oracle_pair *p = &part->pair;
  const struct pack_table *cells = oracle_sibling(p, is_vertex(part) ? "in.vertex_cell" : "in.solvent_cell");
  const struct pack_table *drawn = oracle_sibling(p, is_vertex(part) ? "in.vertex_drawn" : "in.solvent_drawn");
  const struct pack_table *active = oracle_sibling(p, "in.active"), *center = oracle_sibling(p, "in.center");
  const struct pack_table *before = oracle_before(p);
  if (!cells || !drawn || !active || !center || !before || drawn->rows == 0 || center->rows != active->rows)
    return NAN;
  const double number = pack_value(cells, row, 0);
  if (!(number >= 0.0 && number < active->rows))
    return NAN;
  const uint32_t cell = (uint32_t)number, n = active->rows;
  const double v = pack_value(before, row, column);
  const double xi = pack_value(drawn, (row + drawn->rows + (uint32_t)t->drawn_of) % drawn->rows, column);
  if (pack_value(active, cell, 0) == 0.0 && !t->inactive)
    return t->inactive_drawn ? xi : v;
  return t->center * pack_value(center, (cell + n + (uint32_t)t->center_of) % n, column) + t->drawn * xi + t->own * v;
}

static bool gives(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct give_twist known[] = {
      {.center = 1, .drawn = 1, .inactive = true, .text = "members of cells that are not active are changed, too"},
      {.center = 1,
       .drawn = 1,
       .inactive_drawn = true,
       .text = "members that are alone get a drawn velocity: they keep theirs"},
      {.drawn = 1, .text = "the center is left out: the cell's momentum is lost"},
      {.center = 1, .text = "the drawn velocity is left out: all members move as one"},
      {.center = 1, .drawn = -1, .text = "sign: the drawn velocity is subtracted"},
      {.center = -1, .drawn = 1, .text = "sign: the center is subtracted"},
      {.center = 2, .drawn = 1, .text = "the center is added twice"},
      {.center = 1, .drawn = 1, .own = 1, .text = "the velocity before is added: it is replaced"},
      {.center = 1, .drawn = 2, .own = -1, .text = "the drawn velocity twice, less the velocity before"},
      {.center = 1, .own = 1, .text = "the velocity before in place of the drawn one"},
      {.center = 1, .drawn = 1, .center_of = 1, .text = "the center of another cell: the next one"},
      {.center = 1, .drawn = 1, .center_of = -1, .text = "the center of another cell: the one before"},
      {.center = 1, .drawn = 1, .drawn_of = 1, .text = "the velocity drawn for another member: the next one"},
      {.center = 1, .drawn = 1, .drawn_of = -1, .text = "the velocity drawn for another member: the one before"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, give_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

const struct relation oracle_relations_andersen[] = {
    {"draw", NULL, draws, false},
    {"give", NULL, gives, false},
    {.make = NULL},
};

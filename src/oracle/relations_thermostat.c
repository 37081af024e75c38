/* Factors of the thermostats, made with one thing changed. */
#include <math.h>

#include "base/elementary.h"
#include "base/normal.h"
#include "base/random.h"
#include "mpc/cell.h"
#include "oracle/patterns.h"
#include "oracle/relations.h"

#define COUNT_OF(list) (sizeof(list) / sizeof *(list))

/* --- one factor for all ------------------------------------------------------------------------------------------ */

struct rescale_twist {
  double per_member, per_cell; /* degrees of freedom, more than 3 and -3 */
  double of_all;               /* more, once */
  bool by_mass;                /* in units of m, for members */
  bool of_theirs;              /* relative energies */
  bool inverted, no_root, all_factors, all_cells, per_cell_factor, double_energy;
  const char *text;
};

static bool make_rescale(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct rescale_twist *t = twist;
  const struct pack_table *load = oracle_sibling(&part->pair, "in.load");
  const struct pack_table *energy =
      (t->of_theirs ? oracle_sibling_of_theirs : oracle_sibling)(&part->pair, "out.relative");
  double wanted = 0.0, present = 0.0;
  if (!load || !energy || load->rows != part->rows || energy->rows != part->rows || part->pair.ours->columns != 1)
    return false;
  for (int pass = 0; pass < 2; pass++)
    for (uint32_t cell = 0; cell < part->rows; cell++) {
      const double n = pack_value(load, cell, 0),
                   has = pack_value(energy, cell, 0) * 0x1p-32 * (t->double_energy ? 0.5 : 1.0);
      const bool active = n >= 2.0;
      const double members = t->by_mass ? pack_value(load, cell, 1) * CELL_MASS_UNIT : n;
      const double degrees = (3.0 + t->per_member) * members + (-3.0 + t->per_cell);
      if (pass == 0 && cell == 0)
        wanted += t->of_all;
      if (pass == 0 && (active || (t->all_cells && n > 0.0)))
        wanted += degrees, present += has;
      const double ratio = t->per_cell_factor ? degrees / has : wanted / present;
      const double right = t->inverted ? 1.0 / ratio : ratio;
      guess[cell] = active || t->all_factors ? (t->no_root ? right : sqrt(right)) : 1.0;
    }
  return true;
}

static bool rescales(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct rescale_twist known[] = {
      {.per_cell = 3.0, .text = "3 N degrees of freedom for 3 (N - 1)"},
      {.per_cell = 3.0, .all_cells = true, .text = "3 N degrees of freedom of all cells for 3 (N - 1) of active ones"},
      {.per_cell = 2.0, .text = "3 N - 1 degrees of freedom for 3 (N - 1)"},
      {.per_member = -2.0, .per_cell = 2.0, .text = "N - 1 degrees of freedom for 3 (N - 1)"},
      {.per_member = -1.0, .per_cell = 1.0, .text = "2 (N - 1) degrees of freedom for 3 (N - 1)"},
      {.per_member = -2.0, .per_cell = 3.0, .text = "N degrees of freedom for 3 (N - 1)"},
      {.per_cell = -3.0, .text = "3 (N - 2) degrees of freedom for 3 (N - 1)"},
      {.per_cell = 3.0, .of_all = -3.0, .text = "3 N - 3 degrees of freedom in all of active cells: 3 (N - 1) of each"},
      {.per_cell = 3.0,
       .of_all = -3.0,
       .all_cells = true,
       .text = "3 N - 3 degrees of freedom in all of all cells: 3 (N - 1) of each active one"},
      {.per_member = 1.0, .per_cell = -1.0, .text = "4 (N - 1) degrees of freedom for 3 (N - 1)"},
      {.per_member = 3.0, .per_cell = -3.0, .text = "6 (N - 1) degrees of freedom for 3 (N - 1)"},
      {.by_mass = true, .text = "degrees of freedom by the mass of members, not by their number"},
      {.all_cells = true, .text = "degrees of freedom of cells that are not active, too"},
      {.of_theirs = true, .text = "the factor is right for their relative energies, which differ within tolerance"},
      {.inverted = true, .text = "the factor inverted: root of present over wanted"},
      {.no_root = true, .text = "the factor without its root"},
      {.inverted = true, .no_root = true, .text = "the factor inverted and without its root"},
      {.all_factors = true, .text = "the factor in cells that are not active, too: it is 1 there"},
      {.per_cell_factor = true, .text = "a factor of each cell: rescale has one for all"},
      {.per_member = -1.5, .per_cell = 1.5, .text = "a constant factor of 0.707107: relative is twice the energy"},
      {.double_energy = true, .text = "a constant factor of 1.41421: relative is twice the energy"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill_tables(e, make_rescale, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

struct gamma_twist {
  double shape;             /* more than 1.5 (N - 1), in units of 1.5; per_degree: half of it */
  double third;             /* d = a - 1/3 + this */
  double scale;             /* of the energy, 0: 1 */
  double shape_scale, nine; /* times the shape, the 9 in 1/sqrt(9 d): less 1 */
  bool c_of_shape, c_without_root, same_draw, squeezed, one_cell, sign_of_x, of_theirs, normal_of_test;
  int later, entity, purpose, draw;
  int stride; /* draws per attempt, 0: 2 */
  bool second, untested, other_uniform, inverted, no_root, without_d, rank, test_turned, one_member_less, squared;
  const char *text;
};

static double gamma_deviate(const struct gamma_twist *t, uint64_t seed, uint64_t step, uint32_t cell, double shape)
{
  const double a = (1.0 + t->shape_scale) * shape, d = a - 1.0 / 3.0 + t->third;
  const double nine = 9.0 * (1.0 + t->nine) * (t->c_of_shape ? a : d);
  const double c = (t->sign_of_x ? -1.0 : 1.0) / (t->c_without_root ? nine : sqrt(nine));
  const enum random_purpose purpose = t->purpose ? (enum random_purpose)t->purpose : RANDOM_THERMOSTAT;
  for (uint32_t attempt = 0; attempt < 256; attempt++) {
    const uint32_t draw = attempt * (uint32_t)(t->stride ? t->stride : 2) + (uint32_t)t->draw;
    double pair[2];
    random_normal_pair(random_at(seed, purpose, draw + (t->normal_of_test ? 1 : 0), step, cell), pair);
    const double x = pair[t->second],
                 w = random_uniform(random_at(seed, purpose, draw + (t->same_draw ? 0 : 1), step, cell),
                                    t->other_uniform);
    const double root = 1.0 + c * x, v = t->squared ? root * root : root * root * root;
    if (v <= 0.0)
      continue;
    const bool squeezed = w < 1.0 - 0.0331 * x * x * x * x;
    const bool taken = elementary_log(w) < 0.5 * x * x + d - d * v + d * elementary_log(v);
    if (t->squeezed ? squeezed : t->untested || taken != t->test_turned)
      return t->without_d ? v : d * v;
  }
  return NAN;
}

static bool make_boltzmann(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct gamma_twist *t = twist;
  const struct pack_table *load = oracle_sibling(&part->pair, "in.load");
  const struct pack_table *energy =
      (t->of_theirs ? oracle_sibling_of_theirs : oracle_sibling)(&part->pair, "out.relative");
  uint32_t rank = 0;
  if (!load || !energy || load->rows != part->rows || energy->rows != part->rows || part->pair.ours->columns != 1)
    return false;
  for (uint32_t cell = 0; cell < part->rows; cell++) {
    const double n = pack_value(load, cell, 0), has = 0.5 * pack_value(energy, cell, 0) * 0x1p-32;
    guess[cell] = 1.0;
    if (n < 2.0 || has == 0.0)
      continue;
    const double g =
        gamma_deviate(t, oracle_seed(&part->pair), part->pair.ours->place.step + (uint64_t)(int64_t)t->later,
                      (t->one_cell ? 0
                       : t->rank   ? rank
                                   : cell) +
                          (uint32_t)t->entity,
                      1.5 * (n - 1.0 + t->shape));
    const double ratio = g / has * (t->scale != 0.0 ? t->scale : 1.0), right = t->inverted ? 1.0 / ratio : ratio;
    guess[cell] = t->no_root ? right : sqrt(right);
    rank++;
  }
  return true;
}

static bool boltzmanns(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct gamma_twist known[] = {
      {.shape = 1.0, .text = "Gamma of 3 N degrees of freedom for 3 (N - 1)"},
      {.shape = 2.0 / 3.0, .text = "Gamma of 3 N - 1 degrees of freedom for 3 (N - 1)"},
      {.shape = -1.0 / 3.0, .text = "Gamma of 3 N - 4 degrees of freedom for 3 (N - 1)"},
      {.shape = 1.0 / 3.0, .text = "Gamma of 3 N - 2 degrees of freedom for 3 (N - 1)"},
      {.shape = -1.0, .text = "Gamma of 3 (N - 2) degrees of freedom for 3 (N - 1)"},
      {.third = 1.0 / 3.0 - 0.33, .text = "Gamma with 0.33 for 1/3"},
      {.third = 1.0 / 3.0 - 0.333, .text = "Gamma with 0.333 for 1/3"},
      {.third = 1.0 / 3.0 - 0.3333, .text = "Gamma with 0.3333 for 1/3"},
      {.second = true, .text = "Gamma of the normal pair's second: it takes the first"},
      {.other_uniform = true, .text = "Gamma with uniform 1 of the test's draw: it takes uniform 0"},
      {.untested = true, .text = "Gamma without its test: the first attempt is taken where it should be rejected, too"},
      {.same_draw = true, .text = "Gamma's uniform from the draw of the normal: it is of the next draw"},
      {.normal_of_test = true, .text = "Gamma's normal from the draw of the uniform: it is of the draw before"},
      {.third = -1.0 / 6.0, .text = "Gamma with d = a - 1/2: it is a - 1/3"},
      {.squeezed = true, .text = "Gamma with the squeeze 1 - 0.0331 x^4 for the test with logarithms"},
      {.shape_scale = 1.0, .text = "Gamma of twice the shape: 3 (N - 1)/2"},
      {.shape_scale = -1.0 / 3.0, .text = "Gamma of shape N - 1: 3 (N - 1)/2"},
      {.shape_scale = -2.0 / 3.0, .text = "Gamma of shape (N - 1)/2: 3 (N - 1)/2"},
      {.shape_scale = -0.5, .text = "Gamma of half the shape: 3 (N - 1)/2"},
      {.nine = -2.0 / 3.0, .text = "Gamma with c = 1/sqrt(3 d): it is 1/sqrt(9 d)"},
      {.nine = -8.0 / 9.0, .text = "Gamma with c = 1/sqrt(d): it is 1/sqrt(9 d)"},
      {.nine = 8.0, .text = "Gamma with c = 1/(9 sqrt(d)): it is 1/sqrt(9 d)"},
      {.c_of_shape = true, .text = "Gamma with c of the shape: it is 1/sqrt(9 d)"},
      {.c_without_root = true, .text = "Gamma with c = 1/(9 d): it is 1/sqrt(9 d)"},
      {.sign_of_x = true, .text = "Gamma with the sign of x: 1 - c x for 1 + c x"},
      {.one_cell = true, .text = "random address: Gamma of cell 0 for all"},
      {.test_turned = true, .text = "Gamma with its test turned round"},
      {.without_d = true, .text = "Gamma without its factor d: it is d v"},
      {.third = 1.0 / 3.0, .text = "Gamma with d = a: it is a - 1/3"},
      {.squared = true, .text = "Gamma with (1 + c x)^2 for (1 + c x)^3"},
      {.stride = 1, .text = "random address: attempts one draw apart: the normal has draw 2k, the uniform 2k + 1"},
      {.draw = 1, .text = "random address: Gamma begins with draw 1"},
      {.later = -1, .text = "random address: Gamma of the step before"},
      {.later = 1, .text = "random address: Gamma of the step after"},
      {.entity = 1, .text = "random address: Gamma of cell + 1"},
      {.rank = true, .text = "random address: Gamma by the rank of the active cell"},
      {.purpose = 2, .text = "random address: Gamma with purpose 2"},
      {.purpose = 4, .text = "random address: Gamma with purpose 4"},
      {.of_theirs = true, .text = "the factor is right for their relative energies, which differ within tolerance"},
      {.inverted = true, .text = "the factor inverted"},
      {.no_root = true, .text = "the factor without its root"},
      {.inverted = true, .no_root = true, .text = "the factor inverted and without its root"},
      {.scale = 0.5, .text = "a constant factor of 0.707107: relative is twice the energy"},
      {.scale = 2.0, .text = "a constant factor of 1.41421: g is not doubled"},
  };
  if (k >= COUNT_OF(known))
    return false;
  e->decides = known[k].untested || known[k].test_turned || known[k].squeezed || known[k].same_draw;
  relation_fill_tables(e, make_boltzmann, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

const struct relation oracle_relations_thermostat[] = {
    {"rescale", "out.factor", rescales, false},
    {"maxwell_boltzmann", "out.factor", boltzmanns, false},
    {.make = NULL},
};

/* What patterns of differences usually mean. Each is a guess of a bug that is tried on the numbers of the pack. */
#include <math.h>
#include <string.h>

#include "base/random.h"
#include "io/oracle_compare.h"
#include "solvent/solvent.h"
#include "solvent/srd.h"

static uint32_t common_rows(const struct oracle_pair *p)
{
  return p->ours->rows < p->theirs->rows ? p->ours->rows : p->theirs->rows;
}

static bool close_to(const struct oracle_pair *p, uint32_t row, uint32_t column, double guess)
{
  const double size = fabs(pack_value(p->theirs, row, column) - guess);
  return size <= fmax(oracle_tolerance(p, row, column), 0x1p-40 * fabs(guess));
}

/* True if a guess is right wherever ours is not, and ours is wrong somewhere. */
static bool explains(const struct oracle_pair *p, double (*guess)(const struct oracle_pair *, uint32_t, uint32_t))
{
  bool any = false;
  for (uint32_t row = 0; row < common_rows(p); row++)
    for (uint32_t column = 0; column < p->ours->columns; column++) {
      if (close_to(p, row, column, pack_value(p->ours, row, column)))
        continue;
      any = true;
      if (!close_to(p, row, column, guess(p, row, column)))
        return false;
    }
  return any;
}

static int64_t model_integer(const struct oracle_pair *p, const char *table, uint32_t column)
{
  const struct pack_table *t = pack_find(p->pack, &(struct pack_place){"model", 0}, table);
  return t && t->rows > 0 && column < t->columns ? (int64_t)pack_value(t, 0, column) : 0;
}

/* --- any operator ------------------------------------------------------------------------------------------------ */

/* The input of which an output is the changed form. */
static const struct pack_table *before(const struct oracle_pair *p)
{
  char name[PACK_WORD];
  snprintf(name, sizeof name, "in.%.27s", p->ours->name + strlen("out."));
  const struct pack_table *t = oracle_sibling(p, name);
  return t && t->rows == p->ours->rows && t->columns == p->ours->columns ? t : NULL;
}

static double unchanged(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return pack_value(before(p), row, column);
}

static double changed_by(const struct oracle_pair *p, uint32_t row, uint32_t column, double part)
{
  const double in = pack_value(before(p), row, column);
  return in + part * (pack_value(p->ours, row, column) - in);
}

static double half(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return changed_by(p, row, column, 0.5);
}

static double twice(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return changed_by(p, row, column, 2.0);
}

static double backwards(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return changed_by(p, row, column, -1.0);
}

static double negated(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return -pack_value(p->ours, row, column);
}

static bool is_unchanged(const struct oracle_pair *p)
{
  return before(p) && explains(p, unchanged);
}

static bool is_half(const struct oracle_pair *p)
{
  return before(p) && explains(p, half);
}

static bool is_twice(const struct oracle_pair *p)
{
  return before(p) && explains(p, twice);
}

static bool is_backwards(const struct oracle_pair *p)
{
  return before(p) && explains(p, backwards);
}

static bool is_negated(const struct oracle_pair *p)
{
  return explains(p, negated);
}

/* Right to seven digits or so, and no better. */
static bool is_single(const struct oracle_pair *p)
{
  double worst = 0.0, size = 0.0;
  for (uint32_t row = 0; row < common_rows(p); row++)
    for (uint32_t column = 0; column < p->ours->columns; column++) {
      size = fmax(size, fabs(pack_value(p->ours, row, column)));
      const double d = fabs(pack_value(p->ours, row, column) - pack_value(p->theirs, row, column));
      worst = d <= worst ? worst : d;
    }
  return p->rounding < 0x1p-30 && worst > 0.0 && worst < 0x1p-16 * size;
}

/* --- random numbers ---------------------------------------------------------------------------------------------- */

static uint64_t seed_of(const struct oracle_pair *p)
{
  return (uint64_t)model_integer(p, "in.numbers", 0) | (uint64_t)model_integer(p, "in.numbers", 1) << 32;
}

static bool shift_is_of(const struct oracle_pair *p, uint64_t step)
{
  struct random_words r = random_at(seed_of(p), RANDOM_GRID_SHIFT, 0, step, 0);
  for (uint32_t k = 0; k < 3; k++)
    if (pack_value(p->theirs, 0, k) != (double)((uint64_t)r.w[k] << (LATTICE_BITS - 32)))
      return false;
  return true;
}

static bool shift_of_other_step(const struct oracle_pair *p)
{
  return p->theirs->rows == 1 && p->theirs->columns == 3 &&
         (shift_is_of(p, p->ours->place.step - 1) || shift_is_of(p, p->ours->place.step + 1));
}

static double inverse_of(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  for (uint32_t k = 0; k < p->ours->rows; k++)
    if (pack_value(p->ours, k, 0) == row)
      return k;
  return -1.0;
}

static bool is_inverse(const struct oracle_pair *p)
{
  return explains(p, inverse_of);
}

/* --- solvent ----------------------------------------------------------------------------------------------------- */

/* A table of x, y, z that reaches to this row: packs may come from anywhere. */
static bool is_vectors(const struct pack_table *t, bool real, uint32_t row)
{
  return t && t->real == real && t->columns == 3 && row < t->rows;
}

/* The cell for another shift than ours. */
static double cell_for(const struct oracle_pair *p, uint32_t row, double sign)
{
  char name[PACK_WORD];
  snprintf(name, sizeof name, "in.%.27s", p->ours->name + strlen("out."));
  const struct pack_table *r = oracle_sibling(p, name), *s = oracle_sibling(p, "in.shift");
  const struct box box = box_of_cells((int)model_integer(p, "in.box", 0), (int)model_integer(p, "in.box", 1),
                                      (int)model_integer(p, "in.box", 2));
  const struct point none = {0, 0, 0};
  if (!r || !s || !is_vectors(r, false, row) || !is_vectors(s, false, 0) || box.cells[0] < 1 || box.cells[1] < 1 ||
      box.cells[2] < 1)
    return -1.0;
  struct point at = {r->value.integer[3 * row], r->value.integer[3 * row + 1], r->value.integer[3 * row + 2]};
  at.x += (int64_t)sign * s->value.integer[0];
  at.y += (int64_t)sign * s->value.integer[1];
  at.z += (int64_t)sign * s->value.integer[2];
  return solvent_cell_of(&box, at, none);
}

static double subtracted(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  return cell_for(p, row, -1.0);
}

static double unshifted(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  return cell_for(p, row, 0.0);
}

static double x_slowest(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const int64_t lx = model_integer(p, "in.box", 0), ly = model_integer(p, "in.box", 1),
                lz = model_integer(p, "in.box", 2), cell = p->ours->real ? 0 : p->ours->value.integer[row];
  (void)column;
  if (lx < 1 || ly < 1 || p->ours->columns != 1)
    return NAN;
  const int64_t x = cell % lx, y = cell / lx % ly, z = cell / (lx * ly);
  const int64_t number = (x * ly + y) * lz + z;
  return (double)number;
}

static bool shift_subtracted(const struct oracle_pair *p)
{
  return explains(p, subtracted);
}

static bool shift_missing(const struct oracle_pair *p)
{
  return explains(p, unshifted);
}

static bool cells_transposed(const struct oracle_pair *p)
{
  return explains(p, x_slowest);
}

/* Ours, with the axis turned round or the factor left out. */
static double rotated(const struct oracle_pair *p, uint32_t row, uint32_t column, double sense, bool with_factor)
{
  const bool solvent = strcmp(p->ours->name, "out.solvent") == 0;
  const struct pack_table *cell = oracle_sibling(p, solvent ? "in.solvent_cell" : "in.vertex_cell");
  const struct pack_table *center = oracle_sibling(p, "in.center"), *axis = oracle_sibling(p, "in.axis");
  const struct pack_table *factor = oracle_sibling(p, "in.factor"), *in = before(p);
  const struct pack_table *reals = pack_find(p->pack, &(struct pack_place){"model", 0}, "in.reals");
  if (!cell || !factor || !reals || !is_vectors(in, true, row))
    return NAN;
  const double number = pack_value(cell, row, 0);
  const uint32_t in_cell = number >= 0.0 && number < factor->rows ? (uint32_t)number : factor->rows;
  if (!is_vectors(center, true, in_cell) || !is_vectors(axis, true, in_cell))
    return NAN;
  const size_t k = 3 * (size_t)in_cell;
  const double *c = &center->value.number[k], *n = &axis->value.number[k], *v = &in->value.number[3 * (size_t)row];
  const struct cell_turn turn = {.center = {c[0], c[1], c[2]},
                                 .axis = {sense * n[0], sense * n[1], sense * n[2]},
                                 .factor = with_factor ? pack_value(factor, in_cell, 0) : 1.0};
  const struct vec3 w =
      srd_apply(&turn, (struct vec3){v[0], v[1], v[2]}, false, pack_value(reals, 0, 1), pack_value(reals, 0, 2), true);
  return column == 0 ? w.x : column == 1 ? w.y : w.z;
}

static double transposed(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return rotated(p, row, column, -1.0, true);
}

static double without_factor(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return rotated(p, row, column, 1.0, false);
}

static bool rotation_transposed(const struct oracle_pair *p)
{
  return explains(p, transposed);
}

static bool factor_missing(const struct oracle_pair *p)
{
  return explains(p, without_factor);
}

/* Differ by whole box edges. */
static bool not_wrapped(const struct oracle_pair *p)
{
  for (uint32_t row = 0; row < common_rows(p); row++)
    for (uint32_t k = 0; k < 3; k++) {
      const double edge = (double)model_integer(p, "in.box", k) * LATTICE_PER_A0;
      if (fabs(remainder(pack_value(p->theirs, row, k) - pack_value(p->ours, row, k), edge)) > 1.0)
        return false;
    }
  return true;
}

/* --- sweep ------------------------------------------------------------------------------------------------------- */

enum event_column { VERTEX, MOVING, STANDING, IMAGE_X, IMAGE_Y, IMAGE_Z, EXECUTED };
enum hit_column { TIME, S, S_STANDING, NORMAL_X, NORMAL_Y, NORMAL_Z, MOMENTUM };

static bool same_hit(const struct oracle_pair *p, uint32_t mine, uint32_t its)
{
  for (uint32_t k = VERTEX; k < EXECUTED; k++)
    if (pack_value(p->ours, mine, k) != pack_value(p->theirs, its, k))
      return false;
  return true;
}

/* The first event of ours that is not theirs too, at the same place; rows if there is none. */
static uint32_t first_other(const struct oracle_pair *p)
{
  uint32_t row = 0;
  while (row < common_rows(p) && same_hit(p, row, row))
    row++;
  return row;
}

static bool image_missing(const struct oracle_pair *p)
{
  const uint32_t row = first_other(p);
  return row < p->ours->rows && (pack_value(p->ours, row, IMAGE_X) != 0.0 || pack_value(p->ours, row, IMAGE_Y) != 0.0 ||
                                 pack_value(p->ours, row, IMAGE_Z) != 0.0);
}

static bool other_executed(const struct oracle_pair *p)
{
  for (uint32_t row = 0; row < first_other(p); row++)
    if (pack_value(p->ours, row, EXECUTED) != pack_value(p->theirs, row, EXECUTED))
      return true;
  return false;
}

static bool crossing_missing(const struct oracle_pair *p)
{
  const uint32_t row = first_other(p);
  return row + 1 < p->ours->rows && row < p->theirs->rows ? same_hit(p, row + 1, row) : row == p->theirs->rows;
}

static double lever(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double mine = pack_value(p->ours, row, column);
  return column == S || column == S_STANDING ? 1.0 - mine : pack_value(p->theirs, row, column);
}

static bool lever_swapped(const struct oracle_pair *p)
{
  for (uint32_t row = 0; row < common_rows(p); row++)
    if (close_to(p, row, S, pack_value(p->ours, row, S)) &&
        close_to(p, row, S_STANDING, pack_value(p->ours, row, S_STANDING)))
      return false;
  return explains(p, lever);
}

static double clipped(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return column == MOMENTUM ? fmax(pack_value(p->ours, row, column), 0.0) : pack_value(p->theirs, row, column);
}

static double turned(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return column >= NORMAL_X ? -pack_value(p->ours, row, column) : pack_value(p->ours, row, column);
}

static double halved(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return column == MOMENTUM ? 0.5 * pack_value(p->ours, row, column) : pack_value(p->ours, row, column);
}

/* The first event whose dP is negative here has none there; what follows may be anything. */
static bool momentum_clipped(const struct oracle_pair *p)
{
  for (uint32_t row = 0; row < common_rows(p); row++)
    if (!close_to(p, row, MOMENTUM, pack_value(p->ours, row, MOMENTUM)))
      return pack_value(p->ours, row, MOMENTUM) < 0.0 && close_to(p, row, MOMENTUM, clipped(p, row, MOMENTUM));
  return false;
}

static bool normal_turned(const struct oracle_pair *p)
{
  return explains(p, turned);
}

static bool momentum_halved(const struct oracle_pair *p)
{
  return explains(p, halved);
}

/* --- the table --------------------------------------------------------------------------------------------------- */

/* Those of one operator first, then those of any; the first that fits is told. */
static const struct {
  const char *operator_name, *table; /* NULL: any */
  bool (*fits)(const struct oracle_pair *);
  const char *meaning;
} patterns[] = {
    {"shift", "out.shift", shift_of_other_step, "random address: the shift of the step before or after"},
    {"order", "out.order", is_inverse, "the inverse permutation"},
    {"swap", "out.order", is_inverse, "the inverse permutation"},
    {"bin", NULL, shift_subtracted, "grid shift sign: the shift is subtracted from positions, not added"},
    {"bin", "out.vertex", shift_missing, "grid shift applied to the solvent only"},
    {"bin", NULL, shift_missing, "no grid shift"},
    {"bin", NULL, cells_transposed, "cell numbers with x slowest instead of fastest"},
    {"rotate", NULL, rotation_transposed, "rotation transposed: turned by -alpha"},
    {"rotate", NULL, factor_missing, "the thermostat's factor is left out"},
    {"stream", "out.position", not_wrapped, "positions are not wrapped into the box"},
    {"sweep", "out.event", image_missing, "missing image: a partner across the face of the box is not found"},
    {"sweep", "out.event", other_executed, "another hit than the first in time was executed (last, or closest?)"},
    {"sweep", "out.event", crossing_missing, "a crossing is missed: stale neighbor list, or the exclusion of bonds"},
    {"sweep", "out.hit", momentum_clipped, "dP clipped at 0: it is used with its sign (footnote 61)"},
    {"sweep", "out.hit", lever_swapped, "lever rule swapped: s counts from the moving vertex, s' from bond's first"},
    {"sweep", "out.hit", normal_turned, "normal turned round: it points the way the vertex moves"},
    {"sweep", "out.hit", momentum_halved, "dP without its factor of 2"},
    {"sweep", "out.velocity", is_unchanged, "no exchange of momentum"},
    {NULL, NULL, is_single, "single precision somewhere: right to 5 to 8 digits (--single has its tolerances)"},
    {NULL, NULL, is_negated, "sign: the negative of what is wanted"},
    {NULL, NULL, is_unchanged, "nothing done: what came out is what went in"},
    {NULL, NULL, is_half, "half a step: changed by half of what is wanted"},
    {NULL, NULL, is_twice, "a step instead of half a step: changed by twice what is wanted"},
    {NULL, NULL, is_backwards, "sign: changed by the negative of what is wanted"},
};

const char *oracle_diagnose(const struct oracle_pair *p)
{
  const bool comparable = p->ours->columns == p->theirs->columns;
  const bool swept = strcmp(p->ours->place.operator_name, "long_sweep") == 0;
  const char *name = swept ? "sweep" : p->ours->place.operator_name;
  for (size_t k = 0; comparable && k < sizeof patterns / sizeof *patterns; k++) {
    const bool of_operator = !patterns[k].operator_name || strcmp(patterns[k].operator_name, name) == 0;
    const bool of_table = !patterns[k].table || strcmp(patterns[k].table, p->ours->name) == 0;
    if (of_operator && of_table && patterns[k].fits(p))
      return patterns[k].meaning;
  }
  return NULL;
}

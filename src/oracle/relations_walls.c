/* The solvent between walls, made with one thing changed; and how walls and sheared images move. */
#include "base/normal.h"
#include "mpc/cell.h"
#include "mpc/virtual.h"
#include "oracle/relations.h"
#include "oracle/relations_flow.h"
#include "system/account.h"

enum { SLIP = 1, FILL = 2, PER_PERIOD = 3 }; /* columns of in.boundary */

/* --- motion ------------------------------------------------------------------------------------------------------- */

struct motion_twist {
  int64_t later; /* half intervals */
  double factor; /* 0: 1 */
  bool constant, swapped;
  const char *text;
};

static double wave_of(const struct evidence_part *part, int64_t half_intervals)
{
  const int64_t period = 2 * (int64_t)of_model(part, "in.boundary", 0, PER_PERIOD);
  return period > 0 && half_intervals >= 0 ? of_model(part, "in.wave", (uint32_t)(half_intervals % period), 0) : 1.0;
}

static double motion_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct motion_twist *t = twist;
  const double interval = in(part, "in.interval", row, 0), factor = t->factor == 0.0 ? 1.0 : t->factor;
  if (!(interval >= 0.0 && interval < 0x1p60))
    return NAN;
  const int64_t half = 2 * (int64_t)interval + (is_table(part, "out.end") ? 2 : 1) + t->later;
  const double wave = t->constant ? 1.0 : wave_of(part, half);
  if (is_table(part, "out.rate"))
    return factor * of_model(part, "in.flow", 0, 1) * wave;
  const uint32_t wall = t->swapped ? 1 - column / 3 : column / 3;
  return factor * wave * of_model(part, "in.wall", wall, column % 3);
}

static bool motions(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct motion_twist known[] = {
      {.constant = true, .text = "the motion does not oscillate: its cosine is left out"},
      {.later = 1, .text = "the motion of half an interval later"},
      {.later = -1, .text = "the motion of half an interval earlier"},
      {.later = 2, .text = "the motion of the interval after"},
      {.later = -2, .text = "the motion of the interval before"},
      {.swapped = true, .text = "the two walls exchanged"},
      {.factor = -1.0, .text = "sign of the motion"},
      {.factor = 0.5, .text = "half of the motion"},
      {.factor = 2.0, .text = "twice the motion"},
  };
  return k < COUNT_OF(known) && make(e, motion_value, &known[k], known[k].text, text);
}

/* --- flights between walls ---------------------------------------------------------------------------------------- */

enum hit_as { AS_IT_IS, REVERSED, TANGENTIAL_KEPT };

struct wall_twist {
  double doubled; /* w doubled, less 2 */
  enum hit_as hit;
  bool at_rest, swapped, periodic, without_force;
  double given; /* times what walls give, 0: 1 */
  const char *text;
};

struct hit_way {
  double sign, change[3], moved[3];
  int64_t given[2][3];
};

static void go_on(struct hit_way *way, const double a[3], double time)
{
  for (int k = 0; k < 3; k++) {
    way->moved[k] += time * way->change[k] + 0.5 * time * time * a[k];
    way->change[k] += time * a[k];
  }
}

static void meet(struct hit_way *way, const struct wall_twist *t, bool slip, int which, double wall[2][3],
                 const double v[3])
{
  for (int k = 0; k < 3; k++) {
    const double w = (t->at_rest ? 0.0 : 1.0) * wall[t->swapped ? 1 - which : which][k];
    const double before = way->change[k] + way->sign * v[k];
    const double gain = slip ? (k == 1 ? -2.0 * way->sign * v[1] : 0.0) : (2.0 + t->doubled) * w - 2.0 * before;
    way->given[which][k] += llrint(ACCOUNT_SCALE * gain * (t->given == 0.0 ? 1.0 : t->given));
    if (!slip)
      way->change[k] = (2.0 + t->doubled) * w - way->change[k];
  }
  way->sign = -way->sign;
}

/* The whole flight of one particle. False if the pack has not what it takes. */
static bool fly(const struct evidence_part *part, const struct wall_twist *t, uint32_t row, double position[3],
                double velocity[3], struct hit_way *way)
{
  struct box box;
  double wall[2][3], a[3], x[3], v[3];
  const double time = in(part, "in.time", 0, 0);
  bool slip = of_model(part, "in.boundary", 0, SLIP) != 0.0;
  for (uint32_t k = 0; k < 3; k++) {
    wall[0][k] = in(part, "in.wall", 0, k), wall[1][k] = in(part, "in.wall", 1, k);
    a[k] = t->without_force ? 0.0 : of_model(part, "in.reals", 0, 3 + k);
    x[k] = in(part, "in.position", row, k), v[k] = in(part, "in.velocity", row, k);
    if (!(fabs(x[k]) < 0x1p52 && fabs(v[k] * time) < 512.0 && isfinite(wall[0][k] + wall[1][k] + a[k])))
      return false;
  }
  if (!oracle_box(&part->pair, &box))
    return false;
  slip = t->hit == TANGENTIAL_KEPT ? true : t->hit == REVERSED ? false : slip;
  const double edge = (double)box.edge[1], d = rint(v[1] * time * LATTICE_PER_A0), free_end = x[1] + d;
  *way = (struct hit_way){.sign = 1.0};
  double y = x[1], left = fabs(d);
  bool down = d < 0.0;
  const bool hits = (free_end < 0.0 || free_end > edge) && !t->periodic;
  double reach = down ? y : edge - y;
  while (hits && left > reach) {
    go_on(way, a, time * (reach / fabs(d)));
    meet(way, t, slip, down ? 0 : 1, wall, v);
    left -= reach, y = down ? 0.0 : edge, down = !down;
    reach = edge;
  }
  if (hits)
    go_on(way, a, time * (left / fabs(d)));
  y = hits ? (down ? y - left : y + left) : t->periodic ? free_end - edge * floor(free_end / edge) : free_end;
  const double ahead = hits && !slip ? time * ((y - x[1]) / d) : time;
  for (uint32_t k = 0; k < 3; k++) {
    const bool bent = hits && !slip;
    const double move = bent ? v[k] * ahead + way->moved[k] : v[k] * time + 0.5 * a[k] * time * time;
    const double end = x[k] + rint(move * LATTICE_PER_A0), of = (double)box.edge[k];
    position[k] = k == 1 ? y : end - of * floor(end / of);
    velocity[k] = bent ? way->change[k] + way->sign * v[k] : hits && k == 1 ? way->sign * v[k] : v[k] + a[k] * time;
  }
  return true;
}

static double wall_flight_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  double position[3], velocity[3];
  struct hit_way way;
  if (column > 2)
    return NAN;
  if (is_table(part, "out.given")) {
    const struct pack_table *particles = oracle_sibling(&part->pair, "in.position");
    double sum = 0.0;
    for (uint32_t i = 0; particles && row < 2 && i < particles->rows; i++)
      sum += fly(part, twist, i, position, velocity, &way) ? (double)way.given[row][column] : NAN;
    return sum;
  }
  if (!fly(part, twist, row, position, velocity, &way))
    return NAN;
  return is_table(part, "out.position") ? position[column] : velocity[column];
}

static bool wall_flights(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct wall_twist known[] = {
      {.at_rest = true, .text = "walls at rest: a hit reverses the velocity relative to the wall"},
      {.doubled = -1.0, .text = "the wall's velocity once: a hit gives 2 w - v"},
      {.swapped = true, .text = "velocities of the two walls exchanged"},
      {.hit = TANGENTIAL_KEPT, .text = "slip walls: a hit reverses all components of the velocity, not y alone"},
      {.hit = REVERSED, .text = "no-slip walls: at slip walls a hit reverses y alone"},
      {.periodic = true, .text = "wrapped along y: there are walls"},
      {.without_force = true, .text = "body force left out of flights that hit a wall, or of all"},
      {.given = -1.0, .text = "sign: what a wall gives is what the particle gains"},
      {.given = 0.5, .text = "half of what walls give: the velocity changes by twice w - v"},
      {.given = 2.0, .text = "twice what walls give"},
  };
  return k < COUNT_OF(known) && make(e, wall_flight_value, &known[k], known[k].text, text);
}

/* --- rows of cells between walls ---------------------------------------------------------------------------------- */

struct row_twist {
  int rows; /* less those there are */
  bool wrapped, unshifted, clamped;
  const char *text;
};

static double row_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct row_twist *t = twist;
  struct box box;
  (void)column;
  if (!oracle_box(&part->pair, &box))
    return NAN;
  double place[3];
  for (uint32_t k = 0; k < 3; k++) {
    const double shift = t->unshifted && k == 1 ? 0.0 : in(part, "in.shift", 0, k);
    place[k] = floor((in(part, "in.solvent", row, k) + shift) / (double)LATTICE_CELL);
    if (k != 1 || t->wrapped)
      place[k] -= box.cells[k] * floor(place[k] / box.cells[k]);
  }
  if (t->clamped)
    place[1] = fmin(place[1], box.cells[1] - 1.0);
  return (place[2] * (box.cells[1] + 1.0 - t->rows) + place[1]) * box.cells[0] + place[0];
}

static bool rows_of_cells(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct row_twist known[] = {
      {.wrapped = true, .text = "the grid is wrapped along y: between walls it has one row more"},
      {.wrapped = true, .rows = 1, .text = "the periodic grid: between walls it has one row more, and is not wrapped"},
      {.rows = 1, .text = "stride of cell numbers: (z (Ly + 1) + y) Lx + x"},
      {.unshifted = true, .text = "no grid shift along y"},
      {.clamped = true, .text = "the last row joined to the one before"},
  };
  return k < COUNT_OF(known) && make(e, row_value, &known[k], known[k].text, text);
}

/* --- virtual particles -------------------------------------------------------------------------------------------- */

enum number { AS_WANTED, OTHER_PART, WHOLE_CELL, OTHER_RULE, OF_MEAN, STEP_BEFORE };

struct fill_twist {
  enum number number;
  double wall;       /* times the wall's velocity, less 1 */
  double power;      /* of n in the velocity's deviation, less -1/2 */
  bool swapped;      /* walls */
  bool mean_of_real; /* real members weigh 1/n */
  bool without_mass; /* virtual ones weigh as one */
  bool uncounted, lone, lone_uncounted, by_number;
  double load; /* share of the mass that is added, less 1 */
  int step, entity;
  const char *text;
};

static uint32_t cell_of_cut(const struct box *box, uint32_t cut)
{
  const uint32_t lx = (uint32_t)box->cells[0], each = lx * (uint32_t)box->cells[2];
  const uint32_t rows = (uint32_t)box->cells[1] + 1, in_row = cut % each;
  return (in_row / lx * rows + (cut < each ? 0 : rows - 1)) * lx + in_row % lx;
}

/* The number of virtual particles in a cut cell. */
static double virtual_count(const struct evidence_part *part, const struct fill_twist *t, const struct box *box,
                            uint32_t cut)
{
  const double gamma = of_model(part, "in.flow", 0, 0), shift = in(part, "in.shift", 0, 1) * LATTICE_UNIT;
  const bool lower = cut < (uint32_t)(box->cells[0] * box->cells[2]),
             paper = of_model(part, "in.boundary", 0, FILL) == 1;
  const uint32_t cell = cell_of_cut(box, cut);
  const double missing = gamma - in(part, "in.load", cell, 0);
  const double beyond = lower == (t->number == OTHER_PART) ? 1.0 - shift : shift;
  const double mean = gamma * (t->number == WHOLE_CELL ? 1.0 : beyond);
  const struct model model = {.seed = oracle_seed(&part->pair)};
  if (t->number == AS_WANTED || !(mean >= 0.0 && mean < 1e4))
    return t->lone && in(part, "in.load", cell, 0) == 1.0 ? 0.0 : in(part, "out.filled", cut, 0);
  if (t->number == OF_MEAN)
    return mean;
  if (paper != (t->number == OTHER_RULE))
    return missing > 0.0 ? rint(missing * CELL_MASS_SCALE) * CELL_MASS_UNIT : 0.0;
  struct virtual_law law;
  virtual_law_of(mean, &law);
  return virtual_number(&law, &model, part->pair.ours->place.step - (t->number == STEP_BEFORE), cell);
}

static double velocity_of_virtual(const struct evidence_part *part, const struct fill_twist *t, const struct box *box,
                                  uint32_t cut, uint32_t column)
{
  const double n = virtual_count(part, t, box, cut);
  const uint32_t each = (uint32_t)(box->cells[0] * box->cells[2]), wall = (cut < each) == t->swapped;
  const uint64_t step = part->pair.ours->place.step + (uint64_t)(int64_t)t->step;
  double pair[2];
  if (!(n > 0.0))
    return 0.0;
  random_normal_pair(random_at(oracle_seed(&part->pair), RANDOM_PHANTOM_VELOCITY, column == 2, step,
                               cell_of_cut(box, cut) + (uint32_t)t->entity),
                     pair);
  return (1.0 + t->wall) * in(part, "in.wall", wall, column) + pow(n, t->power - 0.5) * pair[column == 1];
}

static double fill_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct fill_twist *t = twist;
  struct box box;
  if (!oracle_box(&part->pair, &box))
    return NAN;
  if (is_table(part, "out.filled"))
    return column == 0 ? virtual_count(part, t, &box, row) : velocity_of_virtual(part, t, &box, row, column - 1);
  const int64_t cut = cut_of(&box, row);
  const double n = cut < 0 ? 0.0 : in(part, "out.filled", (uint32_t)cut, 0);
  const double real = in(part, "in.load", row, 0);
  if (is_table(part, "out.load")) {
    const double more = column == 0 ? (t->by_number ? n : 1.0) : (1.0 + t->load) * n * CELL_MASS_SCALE;
    const bool left_out =
        n == 0.0 || ((t->uncounted || (t->lone_uncounted && real == 1.0)) && column == 0) || (t->lone && real == 1.0);
    return in(part, "in.load", row, column) + (left_out ? 0.0 : rint(more));
  }
  const double momentum = in(part, "in.momentum", row, column);
  if (n == 0.0 || (t->lone && real == 1.0))
    return momentum;
  const double v = velocity_of_virtual(part, t, &box, (uint32_t)cut, column);
  return (t->mean_of_real && real > 0.0 ? rint(momentum / real) : momentum) +
         rint((t->without_mass ? 1.0 : n) * CELL_MOMENTUM_SCALE * v);
}

static bool fills(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct fill_twist known[] = {
      {.number = OTHER_PART,
       .text = "the number of virtual particles by the part of the cell before the wall: it is that beyond"},
      {.number = WHOLE_CELL,
       .text = "the number of virtual particles of a whole cell: it is of the part beyond the wall"},
      {.number = OTHER_RULE, .text = "the number of virtual particles by the other rule, planar or paper"},
      {.number = OF_MEAN, .text = "the mean number of virtual particles: it is drawn"},
      {.number = STEP_BEFORE, .text = "random address: numbers of virtual particles of the step before"},
      {.wall = -1.0, .text = "virtual particles at rest: they have the wall's velocity"},
      {.wall = 1.0, .text = "virtual particles with twice the wall's velocity"},
      {.wall = -2.0, .text = "sign of the wall's velocity in virtual particles"},
      {.swapped = true, .text = "virtual particles with the velocity of the other wall"},
      {.power = 0.5,
       .text = "the velocity of one virtual particle for the mean of n: its deviation is over the root of n"},
      {.power = -0.5, .text = "the mean of virtual velocities over n: its deviation is over the root of n"},
      {.power = 1.0, .text = "the sum of virtual velocities for their mean"},
      {.step = -1, .text = "random address: virtual velocities of the step before"},
      {.step = 1, .text = "random address: virtual velocities of the step after"},
      {.entity = 1, .text = "random address: virtual velocities of the next cell"},
      {.mean_of_real = true, .text = "real members weigh 1/n: their mean velocity is taken for their sum"},
      {.without_mass = true, .text = "virtual particles weigh as one particle: their mass is their number"},
      {.lone = true, .text = "cells with one real member are not filled: it collides with the virtual ones"},
      {.lone_uncounted = true, .text = "one real member does not collide with virtual ones: they count as a member"},
      {.uncounted = true,
       .text = "virtual particles are not counted as a member: a lone real member would not collide"},
      {.by_number = true, .text = "virtual particles counted by their number: all of a cell are one member"},
      {.load = -1.0, .text = "the mass of virtual particles is left out of the load"},
  };
  return k < COUNT_OF(known) && make(e, fill_value, &known[k], known[k].text, text);
}

const struct relation oracle_relations_walls[] = {
    {"wall_motion", NULL, motions, false},
    {"shear_motion", "out.rate", motions, false},
    {"wall_stream", NULL, wall_flights, false},
    {"wall_bin", NULL, rows_of_cells, false},
    {"fill", NULL, fills, false},
    {.make = NULL},
};

/* --- a random wall ------------------------------------------------------------------------------------------------ */

/* Wrong are components along y of particles that hit a wall, and nothing else: no number is the reversed one. */
static bool is_redrawn(const struct oracle_pair *p)
{
  struct evidence_part part = {.pair = *p, .rows = p->ours->rows};
  const struct wall_twist right = {.text = NULL};
  uint32_t wrong = 0;
  for (uint32_t row = 0; row < oracle_common_rows(p); row++) {
    double position[3], velocity[3];
    struct hit_way way;
    if (!fly(&part, &right, row, position, velocity, &way))
      return false;
    const bool hit = way.given[0][1] != 0 || way.given[1][1] != 0;
    for (uint32_t k = 0; k < 3; k++) {
      const bool same = oracle_agrees(p, row, k);
      if (!same && (!hit || k != 1))
        return false;
      wrong += !same;
    }
  }
  return wrong > 0;
}

/* Whole edges of the box too much. */
static bool is_unfolded(const struct oracle_pair *p)
{
  struct box box;
  bool other = false;
  if (!oracle_box(p, &box) || p->ours->real || p->theirs->real)
    return false;
  for (uint32_t row = 0; row < oracle_common_rows(p); row++) {
    const int64_t ours = p->ours->value.integer[row], theirs = p->theirs->value.integer[row];
    if (lattice_fold(theirs, box.edge[0]) != ours)
      return false;
    other |= ours != theirs;
  }
  return other;
}

/* The offset at another half step, of a constant rate. */
static bool is_half_step_off(const struct oracle_pair *p)
{
  struct box box;
  const struct pack_table *reals = oracle_model(p, "in.reals"), *flow = oracle_model(p, "in.flow");
  if (!oracle_box(p, &box) || p->ours->real || p->theirs->real || !reals || !flow || flow->columns < 2)
    return false;
  const int64_t slide = lattice_from_a0(pack_value(flow, 0, 1) * box.cells[1] * 0.5 * pack_value(reals, 0, 0));
  for (int later = -1; later <= 1; later += 2) {
    bool fits = slide != 0;
    for (uint32_t row = 0; row < oracle_common_rows(p); row++)
      fits = fits && lattice_fold(p->ours->value.integer[row] + later * slide - p->theirs->value.integer[row],
                                  box.edge[0]) == 0;
    if (fits)
      return true;
  }
  return false;
}

const struct oracle_pattern oracle_patterns_flow[] = {
    {"wall_stream", "out.velocity", "the component along y of particles that hit a wall is drawn anew: it is reversed",
     .fits = is_redrawn},
    {"shear_motion", "out.offset", "not folded into the box: by whole edges of the box too much", .fits = is_unfolded},
    {"shear_motion", "out.offset", "the offset of half a step more or less", .fits = is_half_step_off},
    {.meaning = NULL},
};

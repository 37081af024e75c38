/* Dumbbells, made with one thing changed: their flights and their start. Flights are the program's own, of a model that
 * is changed. */
#include <stdlib.h>

#include "fluid/dumbbell.h"
#include "fluid/fluid.h"
#include "oracle/relations.h"
#include "oracle/relations_flow.h"
#include "system/account.h"

enum { KIND = 0, SLIP = 1 };                              /* columns of in.boundary */
enum { SPRING = 0, FREQUENCY = 1, DEPTH = 2, RANGE = 3 }; /* of in.spring */

struct spring_twist {
  double frequency, depth, speed, offset; /* times, less 1 */
  bool without_force, at_rest, swapped, other_kind, offset_of_end, offset_of_begin;
  double length; /* of a start: times, less 1 */
  const char *text;
};

/* --- flights ------------------------------------------------------------------------------------------------------ */

struct flight {
  uint32_t n;
  struct model model;
  struct span span;
  struct pairs pairs;
  struct point sums[WALLS];
  uint64_t turns[WALLS];
  int64_t *lattice;
  double *real;
};

/* The model of the pack, as far as dumbbells ask for it. False if the pack has not what it takes. */
static bool take_model(const struct evidence_part *part, const struct spring_twist *t, struct model *m)
{
  const double number = of_model(part, "in.dumbbells", 0, 0), kind = of_model(part, "in.boundary", 0, KIND);
  memset(m, 0, sizeof *m);
  if (!oracle_box(&part->pair, &m->box) || !(number >= 1.0 && number < 0x1p24))
    return false;
  struct dumbbell_model *d = &m->dumbbells;
  m->dimensions = 3;
  m->box.boundary[1] = kind == 1.0 ? BOUNDARY_WALL : kind == 2.0 ? BOUNDARY_SHEAR : BOUNDARY_PERIODIC;
  m->walls.kind = (of_model(part, "in.boundary", 0, SLIP) != 0.0) != t->other_kind ? WALL_SLIP : WALL_NO_SLIP;
  d->pairs = (uint32_t)number;
  d->spring = of_model(part, "in.spring", 0, SPRING);
  d->frequency = (1.0 + t->frequency) * of_model(part, "in.spring", 0, FREQUENCY);
  d->depth = (1.0 + t->depth) * of_model(part, "in.spring", 0, DEPTH);
  d->range = of_model(part, "in.spring", 0, RANGE);
  return d->spring > 0.0 && d->frequency > 0.0 && d->frequency < 0x1p20 && fabs(d->depth) < 8.0 && d->range > 0.0 &&
         d->spring * m->box.cells[1] * m->box.cells[1] >= 4.0;
}

static void take_walls(const struct evidence_part *part, const struct spring_twist *t, struct model *m)
{
  struct vec3 wall[WALLS] = {{0, 0, 0}, {0, 0, 0}};
  const struct pack_table *in = oracle_sibling(&part->pair, "in.wall");
  for (uint32_t w = 0; w < WALLS && oracle_is_vectors(in, true, w) && !t->at_rest; w++)
    wall[w] = oracle_vector(in, t->swapped && in->rows == WALLS ? 1 - w : w);
  m->walls.lower = wall[WALL_LOWER], m->walls.upper = wall[WALL_UPPER];
}

/* False if memory is short, or if the pack has not what it takes; flight_free in any case. */
static bool take_flight(const struct evidence_part *part, const struct spring_twist *t, struct flight *f)
{
  const struct pack_table *x = oracle_sibling(&part->pair, "in.position"),
                          *v = oracle_sibling(&part->pair, "in.velocity"),
                          *r = oracle_sibling(&part->pair, "in.vector");
  memset(f, 0, sizeof *f);
  if (!take_model(part, t, &f->model))
    return false;
  take_walls(part, t, &f->model);
  const uint32_t n = f->n = f->model.dumbbells.pairs;
  if (!oracle_is_vectors(x, false, 2 * n - 1) || !oracle_is_vectors(v, true, 2 * n - 1) ||
      !oracle_is_vectors(r, false, n - 1))
    return false;
  f->lattice = malloc(9 * (size_t)n * sizeof *f->lattice);
  f->real = malloc(6 * (size_t)n * sizeof *f->real);
  if (!f->lattice || !f->real)
    return false;
  f->pairs.n = n;
  for (uint32_t k = 0; k < 3; k++) {
    int64_t *at = f->pairs.at[k] = f->lattice + 2 * (size_t)n * k;
    double *speed = f->pairs.v[k] = f->real + 2 * (size_t)n * k;
    int64_t *apart = f->pairs.apart[k] = f->lattice + (6 + (size_t)k) * n;
    for (size_t i = 0; i < 2 * (size_t)n; i++)
      at[i] = x->value.integer[3 * i + k], speed[i] = v->value.number[3 * i + k];
    for (size_t p = 0; p < n; p++)
      apart[p] = r->value.integer[3 * p + k];
  }
  const double force = t->without_force ? 0.0 : 1.0;
  f->span.time = in(part, "in.time", 0, 0);
  f->span.acceleration =
      (struct vec3){force * of_model(part, "in.reals", 0, 3), force * of_model(part, "in.reals", 0, 4),
                    force * of_model(part, "in.reals", 0, 5)};
  return f->span.time > 0.0 && f->span.time < 0x1p10;
}

static void flight_free(struct flight *f)
{
  free(f->lattice);
  free(f->real);
}

/* Second particles of dumbbells across the boundary, sign 1: to the image next to the first; -1: back. */
static void slide_seconds(struct flight *f, double sign, double offset, double speed)
{
  const int64_t *edge = f->model.box.edge;
  for (uint32_t p = 0; p < f->n; p++) {
    const int64_t image = (f->pairs.at[1][2 * p] - f->pairs.apart[1][p] - f->pairs.at[1][2 * p + 1]) / edge[1];
    int64_t *x = &f->pairs.at[0][2 * p + 1];
    *x = lattice_fold(*x + llrint(sign * (double)image * offset), edge[0]);
    f->pairs.v[0][2 * p + 1] += sign * (double)image * speed;
  }
}

static void fly_in_shear(const struct evidence_part *part, const struct spring_twist *t, struct flight *f)
{
  const struct swing swing = swing_for(f->model.dumbbells.frequency, f->span.time);
  const double begin = (1.0 + t->offset) * in(part, t->offset_of_end ? "in.offset" : "in.begin", 0, 0),
               end = (1.0 + t->offset) * in(part, t->offset_of_begin ? "in.begin" : "in.offset", 0, 0),
               speed = in(part, "in.speed", 0, 0);
  const int64_t *edge = f->model.box.edge;
  if (!(fabs(begin) < 0x1p50 && fabs(end) < 0x1p50))
    return;
  slide_seconds(f, 1.0, begin, (1.0 + t->speed) * speed);
  pairs_fly(&f->pairs, 0, &swing, f->span.acceleration.x, edge[0]);
  pairs_fly(&f->pairs, 1, &swing, 0.0, 0);
  pairs_fly(&f->pairs, 2, &swing, f->span.acceleration.z, edge[2]);
  slide_seconds(f, -1.0, end, (1.0 + t->speed) * speed);
  for (uint32_t i = 0; i < 2 * f->n; i++)
    boundary_bring_in(&f->model.box, (struct slide){llrint(end), speed}, &f->pairs.at[0][i], &f->pairs.at[1][i],
                      &f->pairs.v[0][i]);
}

static bool fly(const struct evidence_part *part, const struct spring_twist *t, struct flight *f)
{
  if (!take_flight(part, t, f))
    return false;
  const struct swing swing = swing_for(f->model.dumbbells.frequency, f->span.time);
  if (f->model.box.boundary[1] == BOUNDARY_SHEAR)
    fly_in_shear(part, t, f);
  else
    dumbbell_boundary_of(&f->model.box)
        ->fly(&f->pairs, &f->model, &f->span, &swing, (struct account){f->sums, f->turns});
  return true;
}

/* Others than dumbbells are ours. */
static void put_flight(const struct evidence_part *part, const struct flight *f, const struct flight *right,
                       double *guess)
{
  const struct pack_table *ours = part->pair.ours;
  const bool velocity = is_table(part, "out.velocity"), vector = is_table(part, "out.vector"),
             given = is_table(part, "out.given");
  for (uint32_t row = 0; row < ours->rows; row++)
    for (uint32_t k = 0; k < 3; k++) {
      double *to = &guess[3 * (size_t)row + k];
      const struct point more = row < WALLS ? f->sums[row] : (struct point){0, 0, 0},
                         less = row < WALLS ? right->sums[row] : (struct point){0, 0, 0};
      const int64_t extra[3] = {more.x - less.x, more.y - less.y, more.z - less.z};
      *to = pack_value(ours, row, k);
      if (given)
        *to += (double)extra[k];
      else if (vector && row < f->n)
        *to = (double)f->pairs.apart[k][row];
      else if (!vector && row < 2 * f->n)
        *to = velocity ? f->pairs.v[k][row] : (double)f->pairs.at[k][row];
    }
}

static bool make_flight(const struct evidence_part *part, const void *twist, double *guess)
{
  static const struct spring_twist none = {.text = ""};
  struct flight f, right;
  memset(&right, 0, sizeof right);
  const bool ok = part->pair.ours->columns == 3 && fly(part, twist, &f) && fly(part, &none, &right);
  if (ok)
    put_flight(part, &f, &right, guess);
  if (part->pair.ours->columns == 3)
    flight_free(&f);
  flight_free(&right);
  return ok;
}

#define ROOT_HALF (-0.29289321881345247) /* sqrt(1/2) - 1 */
#define ROOT_TWO 0.41421356237309515

static bool tell(struct evidence *e, const struct spring_twist *twist, relation_table *value, char text[RELATION_TEXT])
{
  relation_fill_tables(e, value, twist);
  return relation_say(text, "%s", twist->text);
}

static bool flights(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct spring_twist known[] = {
      {.frequency = ROOT_HALF, .text = "dumbbells swing at sqrt(K/m): at sqrt(2 K/m) they do"},
      {.frequency = ROOT_TWO, .text = "dumbbells swing at 2 sqrt(K/m): at sqrt(2 K/m) they do"},
      {.frequency = -0.5, .text = "dumbbells swing at half of their frequency"},
      {.frequency = 1.0, .text = "dumbbells swing at twice their frequency"},
      {.without_force = true, .text = "the acceleration is left out of the flight of centers"},
      {.speed = -1.0,
       .text = "momentum jump ignored: the second particle of a dumbbell across the sheared boundary has "
               "the velocity of its image"},
      {.offset_of_end = true, .text = "offset of the end of the flight at its beginning"},
      {.offset_of_begin = true, .text = "offset of the beginning of the flight at its end"},
      {.offset = -1.0, .text = "offset ignored: images beyond the sheared boundary have slid along x"},
      {.depth = -2.0, .text = "sign of the potential of the walls: they attract centers where depth is positive"},
      {.depth = -1.0, .text = "the potential of the walls is left out"},
      {.depth = 1.0, .text = "twice the potential of the walls: a dumbbell has the mass 2"},
      {.at_rest = true, .text = "walls at rest: a hit reverses the velocity relative to the wall"},
      {.swapped = true, .text = "velocities of the two walls exchanged"},
      {.other_kind = true, .text = "hits of no-slip walls where they slip, or of slip walls where they do not"},
  };
  return k < COUNT_OF(known) && tell(e, &known[k], make_flight, text);
}

/* --- start -------------------------------------------------------------------------------------------------------- */

static bool make_start(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct spring_twist *t = twist;
  const bool vector = is_table(part, "out.vector");
  struct model m;
  struct state state = {0};
  if (!take_model(part, t, &m))
    return false;
  const double stretch = 1.0 + t->length;
  m.dumbbells.spring /= stretch * stretch;
  m.dumbbells.range /= stretch; /* the reach stays */
  m.solvent.particles = 2 * m.dumbbells.pairs;
  m.seed = oracle_seed(&part->pair);
  if (part->pair.ours->columns != 3 || part->rows != (vector ? m.dumbbells.pairs : m.solvent.particles) ||
      m.dumbbells.spring * m.box.cells[1] * m.box.cells[1] < 4.0 || !state_alloc(&state, &m))
    return false;
  fluid_dumbbells.start(&state, &m);
  const struct solvent *s = &state.solvent;
  const struct dumbbells *d = &state.dumbbells;
  const int64_t *const table[2][3] = {{s->x, s->y, s->z}, {d->x, d->y, d->z}};
  for (uint32_t row = 0; row < part->rows; row++)
    for (uint32_t k = 0; k < 3; k++)
      guess[3 * (size_t)row + k] = (double)table[vector][k][row];
  state_free(&state);
  return true;
}

static bool starts(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct spring_twist known[] = {
      {.depth = -2.0, .text = "sign of the potential of the walls: they attract centers where depth is positive"},
      {.depth = -1.0, .text = "the potential of the walls is left out"},
      {.depth = 1.0, .text = "twice the potential of the walls"},
      {.length = ROOT_HALF, .text = "components of variance kT/(2 K): it is kT/K"},
      {.length = ROOT_TWO, .text = "components of variance 2 kT/K: it is kT/K"},
  };
  return k < COUNT_OF(known) && tell(e, &known[k], make_start, text);
}

const struct relation oracle_relations_dumbbell[] = {
    {"dumbbell_start", NULL, starts, false},
    {"dumbbell_stream", NULL, flights, false},
    {"dumbbell_wall_stream", NULL, flights, false},
    {"dumbbell_shear_stream", NULL, flights, false},
    {.make = NULL},
};

/* The bath of pairs and the forces of pairs, made with one thing changed: lists of all pairs of a pack's members. */
#include <stdlib.h>

#include "base/lattice.h"
#include "base/normal.h"
#include "oracle/relations.h"
#include "oracle/relations_bath.h"

static const double pi = 3.14159265358979323846;

struct pair_twist {
  bool by_number, no_images, linear_weight, no_weight, one_mass, linear, unmatched, swapped, other_side;
  bool at_once, halves, exchanged, quiet, same_word;
  bool square, own_only, first_only, self, beyond, vertices_too;
  uint64_t earlier;
  const char *text;
};

/* --- members ------------------------------------------------------------------------------------------------------ */

static uint32_t rows_of(const struct evidence_part *part, const char *name)
{
  const struct pack_table *t = oracle_sibling(&part->pair, name);
  return t ? t->rows : 0;
}

static uint32_t particles_of(const struct evidence_part *part)
{
  return rows_of(part, "in.solvent");
}

static uint32_t members_of(const struct evidence_part *part)
{
  return particles_of(part) + rows_of(part, "in.vertex");
}

static double member(const struct evidence_part *part, uint32_t i, uint32_t column)
{
  const uint32_t n = particles_of(part);
  return i < n ? in(part, "in.solvent", i, column) : in(part, "in.vertex", i - n, column);
}

static double mass_of(const struct evidence_part *part, uint32_t i)
{
  const uint32_t n = particles_of(part);
  return i < n ? 1.0 : of_model(part, "in.vertex", i - n, 0);
}

/* Place of i less that of j, a0. */
static struct vec3 apart(const struct evidence_part *part, const struct pair_twist *t, const struct box *box,
                         uint32_t i, uint32_t j)
{
  double d[3];
  for (uint32_t k = 0; k < 3; k++) {
    const double edge = (double)box->edge[k], x = member(part, i, k), y = member(part, j, k);
    d[k] = (x - edge * floor(x / edge)) - (y - edge * floor(y / edge));
    d[k] = (d[k] - (t->no_images ? 0.0 : edge * rint(d[k] / edge))) * LATTICE_UNIT;
  }
  return (struct vec3){d[0], d[1], d[2]};
}

/* --- pairs of the bath ---------------------------------------------------------------------------------------------
 */

struct listed {
  uint32_t i, j, order;
  struct vec3 along;
  double loss, noise;
};

/* False if the bath does not act on this pair. */
static bool take_pair(const struct evidence_part *part, const struct pair_twist *t, const struct box *box, uint32_t i,
                      uint32_t j, struct listed *l)
{
  const struct vec3 d = apart(part, t, box, i, j);
  const double r = sqrt(vec3_dot(d, d)), near = 1.0 - r;
  const bool hat = of_model(part, "in.medium", 0, WEIGHT) == WEIGHT_HAT || t->no_weight;
  const double x = rate_times_step(part) * (hat ? 1.0 : t->linear_weight ? near : near * near);
  const double loss = loss_of(part, x, t->linear);
  const double inverse = t->one_mass ? 1.0 : 1.0 / mass_of(part, i) + 1.0 / mass_of(part, j);
  if (!(r < 1.0 && r > 0.0))
    return false;
  const uint64_t step = part->pair.ours->place.step - t->earlier;
  const struct random_words w =
      random_at(oracle_seed(&part->pair), RANDOM_BATH_PAIR, t->swapped ? i : j, step, t->swapped ? j : i);
  double normal[3];
  random_normal_three(w, normal);
  *l = (struct listed){.i = i,
                       .j = j,
                       .order = t->by_number ? 0 : w.w[t->same_word ? 0 : 1],
                       .along = vec3_scale((t->other_side ? -1.0 : 1.0) / r, d),
                       .loss = loss,
                       .noise = noise_of(loss, inverse, t->unmatched) * normal[2]};
  return !draw_chooses(part) || bath_chooses(w.w[0], x);
}

static int by_order(const void *left, const void *right)
{
  const struct listed *a = left, *b = right;
  const uint64_t x = (uint64_t)a->i << 32 | a->j, y = (uint64_t)b->i << 32 | b->j;
  return a->order != b->order ? (a->order < b->order ? -1 : 1) : (x > y) - (x < y);
}

static double listed_value(const struct listed *l, const char *table, uint32_t column)
{
  if (strcmp(table, "out.pair") == 0)
    return column == 0 ? l->i : l->j;
  if (strcmp(table, "out.along") == 0)
    return oracle_component(l->along, column);
  return column == 0 ? l->loss : l->noise;
}

static void make_pairs(const struct evidence_part *part, const struct pair_twist *twist, double *guess)
{
  const uint32_t n = members_of(part), columns = part->pair.ours->columns;
  uint32_t count = 0, room = 64 * n + 1;
  struct box box;
  struct listed *list = malloc(room * sizeof *list);
  bool ok = list && n < 4096 && oracle_box(&part->pair, &box);
  for (uint32_t i = 0; ok && i < n; i++)
    for (uint32_t j = i + 1; j < n && count < room; j++)
      count += take_pair(part, twist, &box, i, j, &list[count]);
  ok = ok && count < room;
  if (ok)
    qsort(list, count, sizeof *list, by_order);
  /* A list may be longer than ours or shorter. */
  ok = ok && count == part->pair.theirs->rows;
  for (uint32_t k = 0; k < part->rows * columns; k++)
    guess[k] = ok ? listed_value(&list[k / columns], part->pair.ours->name, k % columns) : NAN;
  free(list);
}

static bool tell_list(struct evidence *e, const struct pair_twist *t, char text[RELATION_TEXT])
{
  for (uint32_t k = 0; k < e->parts; k++)
    make_pairs(&e->part[k], t, &e->guess[(size_t)e->part[k].first * e->columns]);
  return relation_say(text, "%s", t->text);
}

static bool pair_lists(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct pair_twist known[] = {
      {.by_number = true, .text = "pairs in the order of their numbers: a random word orders them"},
      {.same_word = true, .text = "pairs in the order of the word that chooses: it is the next one"},
      {.no_images = true, .text = "missing image: pairs across the faces of the box are not found"},
      {.swapped = true, .text = "random address: the numbers of the two members exchanged"},
      {.earlier = 1, .text = "random address: the pairs of the step before"},
      {.linear_weight = true, .text = "the weight 1 - r: it is its square"},
      {.no_weight = true, .text = "no weight: it falls with the distance"},
      {.linear = true, .text = "a loss of rate dt w: it is that of the draw"},
      {.unmatched = true, .text = "noise of the root of 2 loss: it is that of loss (2 - loss)"},
      {.one_mass = true, .text = "noise without the masses: it is over the root of the reduced mass"},
      {.other_side = true, .text = "sign: the line from the first member to the second"},
  };
  return k < COUNT_OF(known) && tell_list(e, &known[k], text);
}

/* --- what the bath makes of velocities -----------------------------------------------------------------------------
 */

static void act(const struct evidence_part *part, const struct pair_twist *t, uint32_t k, const struct vec3 *old,
                struct vec3 *v)
{
  const uint32_t n = members_of(part);
  const double i = in(part, "in.pair", k, 0), j = in(part, "in.pair", k, 1);
  const struct pack_table *along = oracle_sibling(&part->pair, "in.along");
  if (!(i >= 0.0 && i < n && j >= 0.0 && j < n) || !oracle_is_vectors(along, true, k))
    return;
  const uint32_t a = (uint32_t)i, b = (uint32_t)j;
  const struct vec3 e = oracle_vector(along, k), *from = t->at_once ? old : v;
  const double u = vec3_dot(e, vec3_sub(from[a], from[b])), noise = t->quiet ? 0.0 : in(part, "in.bath", k, 1);
  const double change = bath_change(u, in(part, "in.bath", k, 0), noise);
  const double m = t->halves ? 1.0 : mass_of(part, t->exchanged ? b : a);
  const double o = t->halves ? 1.0 : mass_of(part, t->exchanged ? a : b);
  v[a] = vec3_add_scaled(v[a], change * (o / (m + o)), e);
  v[b] = vec3_add_scaled(v[b], -change * (m / (m + o)), e);
}

static bool make_velocities(const struct evidence_part *part, const void *twist, double *guess)
{
  const uint32_t n = members_of(part), pairs = rows_of(part, "in.pair");
  const uint32_t first = is_table(part, "out.vertex") ? particles_of(part) : 0;
  struct vec3 *v = malloc((2 * (size_t)n + 1) * sizeof *v);
  const bool ok = v && part->pair.ours->columns == 3 && first + part->rows <= n;
  for (uint32_t i = 0; ok && i < n; i++)
    v[i] = v[n + i] = (struct vec3){member(part, i, 0), member(part, i, 1), member(part, i, 2)};
  for (uint32_t k = 0; ok && k < pairs; k++)
    act(part, twist, k, &v[n], v);
  for (uint32_t k = 0; ok && k < 3 * part->rows; k++)
    guess[k] = oracle_component(v[first + k / 3], k % 3);
  free(v);
  return ok;
}

static bool tell(struct evidence *e, const struct pair_twist *t, relation_table *make_it, char text[RELATION_TEXT])
{
  relation_fill_tables(e, make_it, t);
  return relation_say(text, "%s", t->text);
}

static bool pair_baths(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct pair_twist known[] = {
      {.at_once = true, .text = "old velocities: a pair has those that the pairs before it have left"},
      {.exchanged = true, .text = "masses exchanged: the heavy member's velocity changes less"},
      {.halves = true, .text = "masses ignored: both velocities change alike"},
      {.quiet = true, .text = "the noise is left out"},
  };
  return k < COUNT_OF(known) && tell(e, &known[k], make_velocities, text);
}

/* --- forces ------------------------------------------------------------------------------------------------------- */

static double crowd_weight(const struct evidence_part *part, const struct pair_twist *t, double r)
{
  const double d = of_bath(part, MANY_RANGE), near = 1.0 - r / d;
  return near > 0.0 || t->beyond ? 15.0 / (2.0 * pi * d * d * d) * near * near : 0.0;
}

static bool is_second(const struct evidence_part *part, const struct pair_twist *t, uint32_t i)
{
  return i >= of_model(part, "in.medium", 0, SECOND) && (i < particles_of(part) || t->vertices_too);
}

/* F over r. */
static double push_of(const struct evidence_part *part, const struct pair_twist *t, double r, uint32_t i, uint32_t j)
{
  const bool others = of_bath(part, BETWEEN) != 0.0 && is_second(part, t, i) != is_second(part, t, j);
  const double a = of_bath(part, others && !t->own_only ? BETWEEN : REPULSION),
               near = 1.0 - r / of_bath(part, MANY_RANGE);
  const uint32_t low = i < j ? i : j, high = t->first_only ? low : i < j ? j : i;
  const double density = (in(part, "in.crowd", low, 0) + in(part, "in.crowd", high, 0)) * 0x1p-32;
  const double many = of_bath(part, MANY_BODY), base = a * (1.0 - r) * (t->square ? 1.0 - r : 1.0);
  return (base + (many != 0.0 && near > 0.0 ? many * near * density : 0.0)) / r;
}

static bool make_sums(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct pair_twist *t = twist;
  const uint32_t n = members_of(part), columns = part->pair.ours->columns;
  const bool crowd = columns == 1;
  struct box box;
  if (part->rows != n || n > 4096 || !oracle_box(&part->pair, &box))
    return false;
  for (uint32_t i = 0; i < n; i++) {
    double sum[3] = {t->self ? rint(0x1p32 * crowd_weight(part, t, 0.0)) : 0.0, 0.0, 0.0};
    for (uint32_t j = 0; j < n; j++) {
      const struct vec3 d = apart(part, t, &box, i, j);
      const double r = sqrt(vec3_dot(d, d));
      if (i == j || !(r < 1.0 && r > 0.0))
        continue;
      const double scaled = 0x1p32 * (crowd ? crowd_weight(part, t, r) : push_of(part, t, r, i, j));
      for (uint32_t k = 0; k < columns && k < 3; k++)
        sum[k] += rint(scaled * (crowd ? 1.0 : oracle_component(d, k)));
    }
    for (uint32_t k = 0; k < columns; k++)
      guess[columns * (size_t)i + k] = k < 3 ? sum[k] : NAN;
  }
  return true;
}

static bool sums(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct pair_twist known[] = {
      {.no_images = true, .text = "missing image: pairs across the faces of the box are not found"},
      {.self = true, .text = "a member counts in its own density"},
      {.beyond = true, .text = "densities up to 1 a0: up to their own range"},
      {.square = true, .text = "a repulsion that falls as (1 - r)^2: it falls as 1 - r"},
      {.own_only = true, .text = "one repulsion for all: between the groups it is another"},
      {.first_only = true, .text = "the density about one member of a pair, twice: it is the sum of both"},
      {.vertices_too = true, .text = "vertices in the second group: they are in the first"},
  };
  return k < COUNT_OF(known) && tell(e, &known[k], make_sums, text);
}

const struct relation oracle_relations_pairs[] = {
    {"pairs", NULL, pair_lists, false},
    {"pair_bath", NULL, pair_baths, false},
    {"crowd", NULL, sums, false},
    {"repulsion", NULL, sums, false},
    {.make = NULL},
};

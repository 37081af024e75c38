/* The bath of vertices and overdamped motion, made with one thing changed. */
#include "base/lattice.h"
#include "base/normal.h"
#include "fiber/mobility.h"
#include "oracle/relations.h"
#include "oracle/relations_bath.h"

/* --- private bath ------------------------------------------------------------------------------------------------ */

struct private_twist {
  double flow;  /* times, less 1 */
  double power; /* of 1/M in the noise's square, less 1 */
  double noise; /* times, less 1 */
  uint64_t earlier;
  bool linear, unmatched, all, same_draw;
  const char *text;
};

static double private_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct private_twist *t = twist;
  const uint64_t seed = oracle_seed(&part->pair), step = part->pair.ours->place.step - t->earlier;
  const double x = rate_times_step(part), loss = loss_of(part, x, t->linear), v = in(part, "in.velocity", row, column);
  const double u = v - (1.0 + t->flow) * of_bath(part, FLOW_X + column);
  const double inverse = pow(1.0 / of_model(part, "in.vertex", row, 0), 1.0 + t->power);
  const struct random_words word = random_at(seed, RANDOM_BATH_VERTEX, t->same_draw ? 0 : 1, step, row);
  double normal[3];
  random_normal_three(random_at(seed, RANDOM_BATH_VERTEX, 0, step, row), normal);
  if (column > 2 || (draw_chooses(part) && !t->all && !bath_chooses(word.w[0], x)))
    return v;
  return v + bath_change(u, loss, (1.0 + t->noise) * noise_of(loss, inverse, t->unmatched) * normal[column]);
}

static bool private_baths(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct private_twist known[] = {
      {.flow = -1.0, .text = "the bath is at rest: it goes with the flow"},
      {.flow = -2.0, .text = "sign of the flow"},
      {.power = -1.0, .text = "noise without the mass: it is over its root"},
      {.power = 1.0, .text = "noise over the mass: over its root"},
      {.noise = -1.0, .text = "the noise is left out"},
      {.linear = true, .text = "a loss of rate dt: it is 1 - exp(-rate dt)"},
      {.unmatched = true, .text = "noise of the root of 2 loss: it is that of loss (2 - loss)"},
      {.all = true, .text = "the bath acts on all: those that a random word chooses"},
      {.same_draw = true, .text = "chosen by a word of draw 0, which the noise has: it is one of draw 1"},
      {.earlier = 1, .text = "random address: the noise of the step before"},
  };
  return k < COUNT_OF(known) && make(e, private_value, &known[k], known[k].text, text);
}

/* --- tensors ----------------------------------------------------------------------------------------------------- */

/* Fibers of the model, and where their entries begin. */
struct triangle {
  uint32_t first, order; /* vertex; 3 times the vertices */
  uint32_t entry;        /* number of its first entry */
};

/* The fiber of an entry. False if there is none. */
static bool triangle_of(const struct evidence_part *part, uint32_t entry, struct triangle *t)
{
  const struct pack_table *chain = oracle_model(&part->pair, "in.chain");
  *t = (struct triangle){0, 0, 0};
  for (uint32_t end = 0; chain && t->first < chain->rows; t->first = end) {
    while (end < chain->rows && at(chain, end, 2) == at(chain, t->first, 2))
      end++;
    t->order = 3 * (end - t->first);
    if (entry < t->entry + t->order * (t->order + 1) / 2)
      return true;
    t->entry += t->order * (t->order + 1) / 2;
    if (end == t->first)
      return false;
  }
  return false;
}

/* Number of entry i, k, i >= k. */
static uint32_t entry_at(const struct triangle *t, uint32_t i, uint32_t k)
{
  return t->entry + (k * (2 * t->order + 1 - k)) / 2 + (i - k);
}

struct tensor_twist {
  bool without_overlap, swapped, oseen, plain;
  double radius; /* times, less 1 */
  const char *text;
};

static void twisted_factors(const struct tensor_twist *t, double r, double a, double *p, double *q)
{
  const double s = a / r;
  *p = *q = 0.75 * s;
  if (t->oseen)
    return;
  if (r < 2.0 * a && !t->without_overlap) {
    *p = 1.0 - (t->swapped ? 3.0 : 9.0) * r / (32.0 * a);
    *q = (t->swapped ? 9.0 : 3.0) * r / (32.0 * a);
    return;
  }
  *p *= 1.0 + (t->plain ? 1.0 : 2.0 / 3.0) * s * s;
  *q *= 1.0 - (t->plain ? 1.0 : 2.0) * s * s;
}

static double tensor_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct tensor_twist *t = twist;
  const struct pack_table *place = oracle_sibling(&part->pair, "in.position");
  struct triangle f;
  double p, q;
  if (column > 0 || !triangle_of(part, row, &f))
    return NAN;
  uint32_t k = 0, rest = row - f.entry;
  while (rest >= f.order - k)
    rest -= f.order - k++;
  const uint32_t i = k + rest, one = f.first + i / 3, other = f.first + k / 3;
  if (!oracle_is_vectors(place, false, one))
    return NAN;
  const struct vec3 apart = point_difference(oracle_point(place, one), oracle_point(place, other));
  const double r = sqrt(vec3_dot(apart, apart));
  if (one == other)
    return i == k ? 1.0 : 0.0;
  twisted_factors(t, r, (1.0 + t->radius) * of_bath(part, RADIUS), &p, &q);
  return (i % 3 == k % 3 ? p : 0.0) + q * (oracle_component(apart, i % 3) / r) * (oracle_component(apart, k % 3) / r);
}

static bool tensors(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct tensor_twist known[] = {
      {.without_overlap = true, .text = "spheres that overlap as spheres apart: they have factors of their own"},
      {.swapped = true, .text = "9/32 and 3/32 exchanged"},
      {.oseen = true, .text = "the tensor of points (Oseen)"},
      {.plain = true, .text = "a^2 for 2 a^2/3 and 2 a^2"},
      {.radius = 1.0, .text = "twice the radius"},
      {.radius = -0.5, .text = "half of the radius"},
  };
  return k < COUNT_OF(known) && make(e, tensor_value, &known[k], known[k].text, text);
}

/* --- roots ------------------------------------------------------------------------------------------------------- */

static double unit_root(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  struct triangle f;
  (void)twist;
  if (column > 0 || !triangle_of(part, row, &f))
    return NAN;
  uint32_t k = 0, rest = row - f.entry;
  while (rest >= f.order - k)
    rest -= f.order - k++;
  return at(part->pair.ours, row, 0) / at(part->pair.ours, row - rest, 0);
}

static bool roots(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  return k == 0 && make(e, unit_root, NULL, "columns over their first entry: those of L D L^T, not L L^T", text);
}

/* --- a move ------------------------------------------------------------------------------------------------------ */

struct move_twist {
  bool uncoupled, transposed, quiet;
  double flow, jump, pull; /* times, less 1 */
  double power;            /* of dt in the noise, less 1/2 */
  uint64_t earlier;
  const char *text;
};

static double entry_of(const struct evidence_part *part, const char *name, const struct triangle *f, uint32_t i,
                       uint32_t k)
{
  return i >= k ? in(part, name, entry_at(f, i, k), 0) : 0.0;
}

/* Sums over the fiber of component i: D F, and L xi. */
static void couple(const struct evidence_part *part, const struct move_twist *t, const struct triangle *f, uint32_t i,
                   double *pull, double *jump)
{
  const uint64_t seed = oracle_seed(&part->pair), step = part->pair.ours->place.step - t->earlier;
  const bool coupled = oracle_sibling(&part->pair, "in.tensor") != NULL;
  *pull = *jump = 0.0;
  for (uint32_t k = 0; k < f->order; k++) {
    const uint32_t low = i < k ? i : k, high = i < k ? k : i;
    double normal[3];
    random_normal_three(random_at(seed, RANDOM_BATH_VERTEX, 0, step, f->first + k / 3), normal);
    const double d = coupled && !t->uncoupled ? entry_of(part, "in.tensor", f, high, low) : i == k;
    const double l = !coupled        ? (double)(i == k)
                     : t->transposed ? entry_of(part, "in.root", f, k, i)
                                     : entry_of(part, "in.root", f, i, k);
    *pull += d * in(part, "in.force", f->first + k / 3, k % 3);
    *jump += l * normal[k % 3];
  }
}

static bool fiber_of_vertex(const struct evidence_part *part, uint32_t vertex, struct triangle *f)
{
  uint32_t entry = 0;
  while (triangle_of(part, entry, f)) {
    if (vertex < f->first + f->order / 3)
      return true;
    entry = f->entry + f->order * (f->order + 1) / 2;
  }
  return false;
}

static double move_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct move_twist *t = twist;
  struct triangle f;
  double pull, jump;
  if (column > 2 || !fiber_of_vertex(part, row, &f))
    return NAN;
  couple(part, t, &f, 3 * (row - f.first) + column, &pull, &jump);
  const double dt = of_model(part, "in.reals", 0, 0);
  const double drift = dt / (of_model(part, "in.vertex", row, 0) * of_bath(part, RATE));
  const double noise = (1.0 + t->jump) * sqrt(2.0 * drift) * pow(dt, t->power) * jump;
  const double move = (1.0 + t->pull) * drift * pull + noise + (1.0 + t->flow) * of_bath(part, FLOW_X + column) * dt;
  return in(part, "in.position", row, column) + rint(move * LATTICE_PER_A0);
}

static bool moves(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct move_twist known[] = {
      {.uncoupled = true, .text = "forces do not go through the tensor"},
      {.transposed = true, .text = "the root transposed: the noise is L xi"},
      {.pull = -2.0, .text = "sign of the forces"},
      {.pull = -1.0, .text = "forces are left out"},
      {.jump = -1.0, .text = "the noise is left out"},
      {.jump = 0.70710678118654752440 - 1.0, .text = "noise of D dt: it is of 2 D dt"},
      {.power = -0.5, .text = "noise without the root of the time step"},
      {.power = 0.5, .text = "noise with the time step: it goes with its root"},
      {.flow = -1.0, .text = "the flow is left out"},
      {.earlier = 1, .text = "random address: the noise of the step before"},
  };
  return k < COUNT_OF(known) && make(e, move_value, &known[k], known[k].text, text);
}

const struct relation oracle_relations_medium[] = {
    {"private_bath", NULL, private_baths, false},
    {"mobility", NULL, tensors, false},
    {"root", NULL, roots, false},
    {"move", NULL, moves, false},
    {.make = NULL},
};

/* Random numbers, made with one thing changed: words, uniforms, normals, axes, the grid shift, permutations. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/elementary.h"
#include "base/random.h"
#include "oracle/edges.h"
#include "oracle/patterns.h"
#include "oracle/relations.h"
#include "oracle/single.h"

#define COUNT_OF(list) (sizeof(list) / sizeof *(list))

/* --- words -------------------------------------------------------------------------------------------------------- */

enum { PURPOSE, DRAW, STEP, ENTITY };

/* Zeros: as it should be. */
struct philox_twist {
  unsigned rounds;
  bool key_exchanged, key_raised, key_constant, weyl_exchanged, multipliers_exchanged, halves_exchanged;
  int draw_factor; /* -1: 0 */
  uint32_t entity_mask;
  bool step_short, step_exchanged;
  const uint8_t *order; /* of the counter's words */
  const char *text;
};

static uint32_t low_of(uint64_t x)
{
  return (uint32_t)x;
}

static uint32_t high_of(uint64_t x)
{
  return (uint32_t)(x >> 32);
}

static void philox(const struct philox_twist *t, uint32_t c[4], uint32_t k0, uint32_t k1)
{
  static const uint32_t factor[2] = {0xD2511F53U, 0xCD9E8D57U}, weyl[2] = {0x9E3779B9U, 0xBB67AE85U};
  for (unsigned round = 0; round < (t->rounds ? t->rounds : 10); round++) {
    if ((round > 0 || t->key_raised) && !t->key_constant)
      k0 += weyl[t->weyl_exchanged], k1 += weyl[!t->weyl_exchanged];
    const uint64_t a = (uint64_t)factor[t->multipliers_exchanged] * c[0];
    const uint64_t b = (uint64_t)factor[!t->multipliers_exchanged] * c[2];
    const uint32_t h0 = t->halves_exchanged ? low_of(a) : high_of(a), l0 = t->halves_exchanged ? high_of(a) : low_of(a);
    const uint32_t h1 = t->halves_exchanged ? low_of(b) : high_of(b), l1 = t->halves_exchanged ? high_of(b) : low_of(b);
    const uint32_t next[4] = {h1 ^ c[1] ^ k0, l1, h0 ^ c[3] ^ k1, l0};
    memcpy(c, next, sizeof next);
  }
}

static bool make_words(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct philox_twist *t = twist;
  const struct pack_table *in = oracle_sibling(&part->pair, "in.address");
  const uint64_t seed = oracle_seed(&part->pair);
  if (!in || in->real || in->columns != 4 || part->pair.ours->columns != 4 || in->rows < part->rows)
    return false;
  for (uint32_t row = 0; row < part->rows; row++) {
    const int64_t *a = &in->value.integer[4 * (size_t)row];
    const uint32_t draws = t->draw_factor < 0 ? 0 : t->draw_factor ? (uint32_t)t->draw_factor : 256;
    const uint32_t low = low_of((uint64_t)a[STEP]), high = t->step_short ? 0 : high_of((uint64_t)a[STEP]);
    const uint32_t counter[4] = {(uint32_t)a[ENTITY] & (t->entity_mask ? t->entity_mask : UINT32_MAX),
                                 (uint32_t)a[PURPOSE] + draws * (uint32_t)a[DRAW], t->step_exchanged ? high : low,
                                 t->step_exchanged ? low : high};
    uint32_t c[4];
    for (int k = 0; k < 4; k++)
      c[k] = counter[t->order ? t->order[k] : k];
    philox(t, c, t->key_exchanged ? high_of(seed) : low_of(seed), t->key_exchanged ? low_of(seed) : high_of(seed));
    for (int k = 0; k < 4; k++)
      guess[4 * (size_t)row + k] = c[k];
  }
  return true;
}

static bool words(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct philox_twist known[] = {
      {.key_exchanged = true, .text = "the key's words exchanged: the low one of the seed comes first"},
      {.key_raised = true, .text = "Philox: the key is raised between rounds, not before the first"},
      {.key_constant = true, .text = "Philox: the key is not raised between rounds"},
      {.weyl_exchanged = true, .text = "Philox: the key's two increments are exchanged"},
      {.multipliers_exchanged = true, .text = "Philox: the two multipliers are exchanged"},
      {.halves_exchanged = true, .text = "Philox: high and low words of the products are exchanged"},
      {.draw_factor = -1, .text = "random address: the draw is left out of the counter"},
      {.draw_factor = 1, .text = "random address: the draw is not times 256"},
      {.draw_factor = 16, .text = "random address: the draw is times 16, not 256"},
      {.draw_factor = 128, .text = "random address: the draw is times 128, not 256"},
      {.draw_factor = 255, .text = "random address: the draw is times 255, not 256"},
      {.draw_factor = 65536, .text = "random address: the draw is times 65536, not 256"},
      {.draw_factor = 0x1000000, .text = "random address: the draw is times 2^24, not 256"},
      {.entity_mask = 0xFF, .text = "entities cut to 8 bits"},
      {.entity_mask = 0xFFFF, .text = "entities cut to 16 bits"},
      {.entity_mask = 0xFFFFFF, .text = "entities cut to 24 bits"},
      {.step_short = true, .text = "steps cut to 32 bits: the high word is the counter's last"},
      {.step_exchanged = true, .text = "random address: the step's two words are exchanged"},
      {.draw_factor = 0x1000000, .text = "random address: the draw is times 2^24, not 256"},
  };
  static uint8_t const orders[24][4] = {
      {0, 1, 3, 2}, {0, 2, 1, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 3, 2, 1}, {1, 0, 2, 3}, {1, 0, 3, 2}, {1, 2, 0, 3},
      {1, 2, 3, 0}, {1, 3, 0, 2}, {1, 3, 2, 0}, {2, 0, 1, 3}, {2, 0, 3, 1}, {2, 1, 0, 3}, {2, 1, 3, 0}, {2, 3, 0, 1},
      {2, 3, 1, 0}, {3, 0, 1, 2}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 1, 2, 0}, {3, 2, 0, 1}, {3, 2, 1, 0}};
  struct philox_twist t = {0};
  if (k < COUNT_OF(known)) {
    t = known[k];
  } else if (k < COUNT_OF(known) + 16) {
    t.rounds = k - COUNT_OF(known) + 1;
    t.text = "Philox with another number of rounds than 10";
  } else if (k < COUNT_OF(known) + 16 + 23) {
    t.order = orders[k - COUNT_OF(known) - 16];
    t.text = "random address: the counter's words in another order than entity, purpose and draw, step";
  } else {
    return false;
  }
  relation_fill_tables(e, make_words, &t);
  return relation_say(text, "%s", t.text);
}

/* --- what is made of words ---------------------------------------------------------------------------------------- */

struct uniform_twist {
  bool high_first, one_word, exchanged;
  int bits;     /* 0: 52 */
  double added; /* beyond a half */
  const char *text;
};

static double uniform_of(const struct uniform_twist *t, const uint32_t w[4], uint32_t which)
{
  const uint32_t k = t->exchanged ? 1 - which : which;
  if (t->one_word)
    return (w[t->one_word && !t->high_first ? 2 * k : 2 * k + 1] + 0.5 + t->added) * 0x1p-32;
  const uint64_t n = t->high_first ? (uint64_t)w[2 * k] << 32 | w[2 * k + 1] : (uint64_t)w[2 * k + 1] << 32 | w[2 * k];
  const int bits = t->bits ? t->bits : 52;
  return ldexp((double)(n >> (64 - bits)) + 0.5 + t->added, -bits);
}

static bool words_of(const struct evidence_part *part, uint32_t row, uint32_t w[4])
{
  const struct pack_table *t = oracle_sibling(&part->pair, "out.word");
  for (uint32_t k = 0; k < 4; k++) {
    const double x = t && t->columns == 4 ? pack_value(t, row, k) : -1.0;
    if (!(x >= 0.0 && x < 0x1p32))
      return false;
    w[k] = (uint32_t)x;
  }
  return true;
}

static double uniform_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  uint32_t w[4];
  return words_of(part, row, w) && column < 2 ? uniform_of(twist, w, column) : NAN;
}

static bool uniforms(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct uniform_twist known[] = {
      {.added = -0.5, .text = "uniforms without their half: multiples of 2^-52, and 0 among them"},
      {.added = 0.5, .text = "uniforms with 1 for their half: 1 among them, no 0"},
      {.bits = 53, .text = "uniforms of 53 bits: they have 52, and a half"},
      {.bits = 53, .added = -0.5, .text = "uniforms of 53 bits without a half: they have 52, and a half"},
      {.bits = 24, .text = "uniforms of 24 bits: they have 52, and a half"},
      {.bits = 32, .text = "uniforms of the high word of 32 bits: they have 52, of both words"},
      {.bits = 24, .added = -0.5, .text = "uniforms of 24 bits: they have 52, and a half"},
      {.bits = 32, .added = -0.5, .text = "uniforms of the high word of 32 bits: they have 52, of both words"},
      {.high_first = true, .text = "the high word first: of two words, the first is the low one"},
      {.one_word = true, .text = "uniforms of one word, the low one: they have 52 bits of both"},
      {.one_word = true, .added = -0.5, .text = "uniforms of one word, the low one: they have 52 bits of both"},
      {.exchanged = true, .text = "uniforms exchanged: 0 is of words 0 and 1"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, uniform_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

struct normal_twist {
  double scale, turns;
  bool exchanged, sine, uncut;
  const char *text;
};

static double normal_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct normal_twist *t = twist;
  const struct pack_table *u = oracle_sibling(&part->pair, "out.uniform");
  if (!u || u->columns != 2)
    return NAN;
  const double first = pack_value(u, row, t->exchanged), second = pack_value(u, row, !t->exchanged);
  const double squared = -2.0 * t->scale * elementary_log(t->uncut ? 1.0 - first : first);
  const struct circle_point angle = elementary_circle_turns(second * t->turns);
  return sqrt(squared) * ((column == 0) != t->sine ? angle.cosine : angle.sine);
}

static bool normals(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const double pi = 3.14159265358979323846;
  const struct normal_twist known[] = {
      {.scale = 1.0, .turns = 1.0, .exchanged = true, .text = "uniforms exchanged: the radius is of uniform 0"},
      {.scale = 1.0, .turns = 1.0, .sine = true, .text = "columns exchanged: the normal pair's first has the cosine"},
      {.scale = 0.5, .turns = 1.0, .text = "a constant factor of 1/sqrt(2): -2 ln u is under the root"},
      {.scale = 1.0, .turns = 0.5, .text = "an angle of pi times the uniform, not 2 pi"},
      {.scale = 1.0, .turns = -1.0, .text = "sign: the angle's negative"},
      {.scale = 1.0, .turns = 1.0, .uncut = true, .text = "the radius from 1 - u: it is of u"},
      {.scale = 1.0, .turns = single_of(pi) / pi, .text = "pi in single precision"},
      {.scale = 1.0, .turns = single_of(2.0 * pi) / (2.0 * pi), .text = "2 pi in single precision"},
      {.scale = 1.0, .turns = 3.14159 / pi, .text = "pi of 6 digits"},
      {.scale = 1.0, .turns = 3.1415926 / pi, .text = "pi of 8 digits"},
      {.scale = 1.0, .turns = 3.14159265 / pi, .text = "pi of 9 digits"},
      {.scale = 1.0, .turns = 3.1415926535 / pi, .text = "pi of 11 digits"},
      {.scale = 1.0, .turns = 3.1416 / pi, .text = "pi of 5 digits"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, normal_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

/* --- axes --------------------------------------------------------------------------------------------------------- */

enum rank_of { OWN, RANK, ONE, MODULO };

/* Where an axis, or another number, comes from, and how it is made. */
struct axis_twist {
  int purpose; /* 0: its own */
  int later, entity, draw;
  bool unsigned_words, halves_exchanged, one_pair, one_draw, without_root, without_half, whole_square, by_angle;
  enum rank_of rank;
  uint32_t modulus;
  bool x_slowest, all_cells;
  double factor; /* 0: 1 */
  const char *text;
};

static bool axis_from(const struct axis_twist *t, const uint32_t w[4], uint32_t k, double n[3])
{
  const double half = t->without_half ? 0.0 : 0.5;
  const double u = ((t->unsigned_words ? (double)w[2 * k] : (double)(int32_t)w[2 * k]) + half) * 0x1p-31;
  const double v = ((t->unsigned_words ? (double)w[2 * k + 1] : (double)(int32_t)w[2 * k + 1]) + half) * 0x1p-31;
  const double q = u * u + v * v, root = t->without_root ? 1.0 - q : sqrt(1.0 - q);
  const double f = t->factor != 0.0 ? t->factor : 1.0;
  if (q >= 1.0)
    return false;
  n[0] = f * 2.0 * u * root, n[1] = f * 2.0 * v * root, n[2] = f * (1.0 - 2.0 * q);
  return true;
}

static void axis_at(const struct axis_twist *t, uint64_t seed, const int64_t address[4], double n[3])
{
  n[0] = n[1] = n[2] = NAN;
  for (uint32_t draw = (uint32_t)address[DRAW]; draw < (uint32_t)address[DRAW] + 64; draw++) {
    const struct random_words r =
        random_at(seed, (enum random_purpose)(t->purpose ? t->purpose : address[PURPOSE]), draw + (uint32_t)t->draw,
                  (uint64_t)(address[STEP] + t->later), (uint32_t)(address[ENTITY] + t->entity));
    for (uint32_t k = 0; k < (t->one_pair ? 1 : 2); k++)
      if (axis_from(t, r.w, t->halves_exchanged ? 1 - k : k, n))
        return;
  }
}

static double axis_of_address(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *in = oracle_sibling(&part->pair, "in.address");
  double n[3];
  if (!in || in->real || in->columns != 4 || row >= in->rows || column > 2)
    return NAN;
  const int64_t *a = &in->value.integer[4 * (size_t)row], address[4] = {a[PURPOSE], 0, a[STEP], a[ENTITY]};
  axis_at(twist, oracle_seed(&part->pair), address, n);
  return n[column];
}

static double axis_of_cell(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct axis_twist *t = twist;
  const struct pack_table *load = oracle_sibling(&part->pair, "in.load");
  struct box box;
  double n[3];
  if (!load || column > 2 || !oracle_box(&part->pair, &box))
    return NAN;
  if (pack_value(load, row, 0) < 2.0 && !t->all_cells)
    return 0.0;
  uint32_t cell = row;
  if (t->rank == RANK)
    for (uint32_t k = cell = 0; k < row; k++)
      cell += pack_value(load, k, 0) >= 2.0;
  if (t->rank == ONE)
    cell = 0;
  if (t->rank == MODULO)
    cell %= t->modulus;
  if (t->x_slowest) {
    const uint32_t lx = (uint32_t)box.cells[0], ly = (uint32_t)box.cells[1], lz = (uint32_t)box.cells[2];
    cell = (row % lx * ly + row / lx % ly) * lz + row / (lx * ly);
  }
  const int64_t address[4] = {RANDOM_ROTATION_AXIS, 0, (int64_t)part->pair.ours->place.step, cell};
  axis_at(t, oracle_seed(&part->pair), address, n);
  return n[column];
}

static bool axes(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct axis_twist known[] = {
      {.unsigned_words = true, .text = "axes of unsigned words: they are signed, of 32 bits"},
      {.halves_exchanged = true, .text = "axes of words 2, 3 before words 0, 1"},
      {.one_pair = true, .text = "axes of words 0, 1 of each draw only: words 2, 3 come before the next draw"},
      {.without_root = true, .text = "not of length 1: the root of 1 - q is left out"},
      {.without_half = true, .text = "axes of words without their half: (w + 1/2) 2^-31"},
      {.factor = -1.0, .text = "sign: the negative of what is wanted"},
      {.draw = 1, .text = "random address: axes begin with draw 1"},
      {.entity = 1, .text = "random address: the axis of cell + 1 (entity + 1)"},
      {.entity = -1, .text = "random address: the axis of cell - 1 (entity - 1)"},
      {.later = -1, .text = "random address: axes of the step before"},
      {.later = 1, .text = "random address: axes of the step after"},
      {.rank = RANK, .text = "random address: axes by the rank of the active cell, not by its number"},
      {.rank = ONE, .text = "random address: all axes are that of cell 0"},
      {.all_cells = true, .text = "axes of cells that are not active, too: they are zeros"},
      {.x_slowest = true, .text = "random address: axes by cell numbers with x slowest"},
  };
  const bool cells = strcmp(e->part[0].pair.ours->place.operator_name, "solve") == 0;
  struct axis_twist t = {0};
  if (k < COUNT_OF(known)) {
    t = known[k];
    relation_say(text, "%s", t.text);
  } else if (k < COUNT_OF(known) + 24) {
    t.purpose = (int)(k - COUNT_OF(known));
    relation_say(text, "random address: axes with purpose %d", t.purpose);
  } else if (k < COUNT_OF(known) + 24 + 8) {
    t.rank = MODULO, t.modulus = 2U << (k - COUNT_OF(known) - 24);
    relation_say(text, "random address: axes of the cell's number modulo %u", t.modulus);
  } else {
    return false;
  }
  relation_fill(e, cells ? axis_of_cell : axis_of_address, &t);
  return true;
}

/* A length that is not 1, the same in all rows or not. */
static bool axis_length(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  double least = INFINITY, most = 0.0;
  for (uint32_t row = 0; row < e->rows && e->columns == 3; row++) {
    const double *n = &e->theirs[3 * (size_t)row], *m = &e->ours[3 * (size_t)row];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const bool zero = m[0] == 0.0 && m[1] == 0.0 && m[2] == 0.0;
    for (int c = 0; c < 3; c++)
      e->guess[3 * (size_t)row + c] = zero ? 0.0 : length * m[c];
    if (zero)
      continue;
    least = fmin(least, length), most = fmax(most, length);
  }
  if (k > 0 || e->columns != 3 || !(least > 0.0) || (fabs(least - 1.0) < 1e-9 && fabs(most - 1.0) < 1e-9))
    return false;
  return relation_say(text, "the right direction, but not of length 1: %.6g to %.6g", least, most);
}

/* --- grid shift --------------------------------------------------------------------------------------------------- */

struct shift_twist {
  int purpose, later, draw, entity, first; /* first: word of x */
  bool signed_words, uniform;
  const char *text;
};

static double shift_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct shift_twist *t = twist;
  const struct random_words r =
      random_at(oracle_seed(&part->pair), (enum random_purpose)(t->purpose ? t->purpose : RANDOM_GRID_SHIFT),
                (uint32_t)t->draw, part->pair.ours->place.step + (uint64_t)(int64_t)t->later, (uint32_t)t->entity);
  if (row > 0 || column > 2)
    return NAN;
  const uint32_t w = r.w[((uint32_t)t->first + column) % 4];
  return (t->signed_words ? (double)(int32_t)w : (double)w) * 0x1p8;
}

static bool shifts(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct shift_twist known[] = {
      {.later = -1, .text = "random address: the shift of the step before"},
      {.later = 1, .text = "random address: the shift of the step after"},
      {.draw = 1, .text = "random address: the shift of draw 1"},
      {.entity = 1, .text = "random address: the shift of entity 1"},
      {.first = 1, .text = "the shift from words 1, 2, 3: it is words 0, 1, 2"},
      {.first = 2, .text = "the shift from words 2, 3, 0: it is words 0, 1, 2"},
      {.signed_words = true, .text = "the shift from signed words: they are unsigned"},
  };
  struct shift_twist t = {0};
  if (k < COUNT_OF(known)) {
    t = known[k];
    relation_say(text, "%s", t.text);
  } else if (k < COUNT_OF(known) + 24) {
    t.purpose = (int)(k - COUNT_OF(known));
    relation_say(text, "random address: the shift with purpose %d", t.purpose);
  } else {
    return false;
  }
  relation_fill(e, shift_value, &t);
  return true;
}

/* --- permutations ------------------------------------------------------------------------------------------------- */

enum deviate { WHOLE, LOW_WORD, HIGH_WORD, HIGH_FIRST };

struct shuffle_twist {
  int purpose, draw, later;
  int range;  /* added to k + 1 */
  int single; /* 1 + the way of edges_single_index; 0: integers */
  enum deviate deviate;
  const char *text;
  bool last_zero, remainder, forward, other_half, entity_per_number, without_last, upward, doubles;
};

/* Where a permutation's random numbers are. */
struct shuffle_address {
  uint64_t seed, step;
  enum random_purpose purpose;
  uint32_t draw;
};

/* Of an operator that is not given an address, the scene has it. */
static struct shuffle_address address_of(const struct oracle_pair *p)
{
  const struct pack_table *in = oracle_sibling(p, "in.address");
  const bool swap = strcmp(p->ours->place.operator_name, "swap") == 0;
  struct shuffle_address a = {oracle_seed(p), p->ours->place.step, swap ? RANDOM_VELOCITY_SWAP : RANDOM_VERTEX_ORDER,
                              0};
  if (in && !in->real && in->rows == 1 && in->columns == 4) {
    a.purpose = (enum random_purpose)in->value.integer[PURPOSE];
    a.draw = (uint32_t)in->value.integer[DRAW];
    a.step = (uint64_t)in->value.integer[STEP];
  }
  return a;
}

static uint64_t deviate_of(const struct shuffle_twist *t, const struct shuffle_address *a, uint32_t k)
{
  const uint32_t half = t->entity_per_number ? 0 : t->other_half ? 1 - k % 2 : k % 2;
  const struct random_words r =
      random_at(a->seed, t->purpose ? (enum random_purpose)t->purpose : a->purpose, a->draw + (uint32_t)t->draw,
                a->step + (uint64_t)(int64_t)t->later, t->entity_per_number ? k : k / 2);
  const uint64_t low = r.w[2 * half], high = r.w[2 * half + 1];
  return t->deviate == LOW_WORD     ? low << 32
         : t->deviate == HIGH_WORD  ? high << 32
         : t->deviate == HIGH_FIRST ? low << 32 | high
                                    : high << 32 | low;
}

static uint32_t place_of(const struct shuffle_twist *t, uint64_t deviate, uint64_t range)
{
  if (t->remainder)
    return (uint32_t)(range ? deviate % range : 0);
  if (t->doubles)
    return (uint32_t)((double)range * ((double)deviate * 0x1p-64));
  if (t->single)
    return edges_single_index(deviate, (uint32_t)range, t->single - 1);
  const uint64_t low = (deviate & UINT32_MAX) * range, high = (deviate >> 32) * range;
  return (uint32_t)((high + (low >> 32)) >> 32);
}

static bool make_order(const struct evidence_part *part, const void *twist, double *order)
{
  const struct shuffle_twist *t = twist;
  const uint32_t n = part->rows;
  const struct shuffle_address address = address_of(&part->pair);
  for (uint32_t k = 0; k < n; k++)
    order[k] = k;
  for (uint32_t i = 1; i < n; i++) {
    const uint32_t k = t->forward ? i : n - i;
    if (t->without_last && i + 1 == n)
      break;
    const uint64_t deviate = t->last_zero && k == n - 1 && n % 2 == 1 ? 0 : deviate_of(t, &address, k);
    const uint32_t j =
        t->upward ? k + place_of(t, deviate, n - k) : place_of(t, deviate, (uint64_t)((int64_t)k + 1 + t->range));
    if (j >= n)
      return false;
    const double kept = order[k];
    order[k] = order[j];
    order[j] = kept;
  }
  return true;
}

static bool orders(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct shuffle_twist known[] = {
      {.draw = 1, .text = "random address: the order of the other sweep of the step"},
      {.later = -1, .text = "random address: the permutation of the step before or after (the one before)"},
      {.later = 1, .text = "random address: the permutation of the step before or after (the one after)"},
      {.range = -1, .text = "permutation: entry k changes places with one of k, not of k + 1"},
      {.last_zero = true, .text = "permutation of an odd number: the last entry's random number is left out"},
      {.remainder = true, .text = "permutation by remainder: floor((k + 1) R / 2^64), not R modulo k + 1"},
      {.deviate = LOW_WORD, .text = "permutation of the low word only: R has 64 bits"},
      {.deviate = HIGH_WORD, .text = "permutation of the high word only: R has 64 bits"},
      {.deviate = HIGH_FIRST, .text = "permutation: R with the high word first; the first of two words is the low one"},
      {.forward = true, .text = "permutation from the front: k goes down from n - 1 to 1"},
      {.upward = true, .forward = true, .text = "permutation from the front: entry k changes with one after it"},
      {.other_half = true, .text = "permutation: integers 0 and 1 of a draw exchanged"},
      {.entity_per_number = true, .text = "permutation: entity k for k/2, integer 0 only"},
      {.without_last = true, .text = "permutation without its last exchange, k = 1"},
      {.doubles = true, .text = "permutation in doubles: the product (k + 1) R is of integers"},
      {.single = 1, .text = "permutation: its index in single precision; it needs all 64 bits of the integer"},
      {.single = 2, .text = "permutation: its index in single precision; it needs all 64 bits of the integer"},
      {.single = 3, .text = "permutation: its index in single precision; it needs all 64 bits of the integer"},
      {.single = 4, .text = "permutation: its index in single precision; it needs all 64 bits of the integer"},
  };
  struct shuffle_twist t = {0};
  if (k < COUNT_OF(known)) {
    t = known[k];
    relation_say(text, "%s", t.text);
  } else if (k < COUNT_OF(known) + 24) {
    t.purpose = (int)(k - COUNT_OF(known));
    relation_say(text, "random address: the permutation with purpose %d", t.purpose);
  } else {
    return false;
  }
  relation_fill_tables(e, make_order, &t);
  return true;
}

static double own_number(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  (void)part, (void)column, (void)twist;
  return row;
}

static double inverse_number(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  (void)column, (void)twist;
  for (uint32_t k = 0; k < part->rows; k++)
    if (pack_value(part->pair.ours, k, 0) == row)
      return k;
  return NAN;
}

static double backward_number(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  (void)column, (void)twist;
  return pack_value(part->pair.ours, part->rows - 1 - row, 0);
}

static bool order_changed(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct {
    relation_value *f;
    const char *text;
  } known[] = {{inverse_number, "the inverse permutation: applied from the other side"},
               {own_number, "not permuted: the order of their numbers"},
               {backward_number, "the permutation backwards: from its last entry to its first"}};
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, known[k].f, NULL);
  return relation_say(text, "%s", known[k].text);
}

/* Velocity of the particle that has ours, instead of whose ours has. */
static double from_other_side(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *in = oracle_before(&part->pair), *order = oracle_sibling(&part->pair, "out.order");
  (void)twist;
  for (uint32_t k = 0; in && order && k < order->rows; k++)
    if (pack_value(order, k, 0) == row)
      return pack_value(in, k, column);
  return NAN;
}

static double twice_applied(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *in = oracle_before(&part->pair), *order = oracle_sibling(&part->pair, "out.order");
  const double first = order ? pack_value(order, row, 0) : NAN;
  const double from = first >= 0.0 && first < part->rows ? pack_value(order, (uint32_t)first, 0) : NAN;
  (void)twist;
  return in && from >= 0.0 && from < in->rows ? pack_value(in, (uint32_t)from, column) : NAN;
}

static bool swapped(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  relation_fill(e, k == 0 ? from_other_side : twice_applied, NULL);
  return k < 2 && relation_say(text, "%s",
                               k == 0 ? "the permutation is right, but applied from the other side"
                                      : "the permutation is right, but applied twice");
}

const struct relation oracle_relations_random[] = {
    {"random", "out.word", words, false},      {"random", "out.uniform", uniforms, false}, {"random", "out.normal", normals, false},
    {"random", "out.axis", axes, false},       {"random", "out.axis", axis_length, false}, {"shift", "out.shift", shifts, false},
    {NULL, "out.order", order_changed, false}, {NULL, "out.order", orders, false},         {"solve", "out.axis", axes, false},
    {"solve", "out.axis", axis_length, false}, {"swap", "out.velocity", swapped, false},   {.make = NULL},
};

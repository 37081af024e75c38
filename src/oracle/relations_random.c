/* Random numbers, made with one thing changed: words, uniforms, normals, axes, the grid shift. */
#include <math.h>
#include <string.h>

#include "base/elementary.h"
#include "base/random.h"
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
  bool step_short, step_exchanged, draw_first, seed_short;
  int entity, later, draw, purpose; /* more */
  const uint8_t *order;             /* of the counter's words */
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

static void twisted_philox(const struct philox_twist *t, uint32_t c[4], uint32_t k0, uint32_t k1)
{
  static const uint32_t factor[2] = {PHILOX_MULTIPLIER_0, PHILOX_MULTIPLIER_1};
  static const uint32_t weyl[2] = {PHILOX_KEY_STEP_0, PHILOX_KEY_STEP_1};
  for (unsigned round = 0; round < (t->rounds ? t->rounds : PHILOX_ROUNDS); round++) {
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
    const uint64_t step = (uint64_t)(a[STEP] + t->later);
    const uint32_t low = low_of(step), high = t->step_short ? 0 : high_of(step);
    const uint32_t purpose = (uint32_t)(a[PURPOSE] + t->purpose), draw = (uint32_t)(a[DRAW] + t->draw);
    const uint32_t counter[4] = {(uint32_t)(a[ENTITY] + t->entity) & (t->entity_mask ? t->entity_mask : UINT32_MAX),
                                 t->draw_first ? draw + draws * purpose : purpose + draws * draw,
                                 t->step_exchanged ? high : low, t->step_exchanged ? low : high};
    uint32_t c[4];
    for (int k = 0; k < 4; k++)
      c[k] = counter[t->order ? t->order[k] : k];
    const uint32_t first = low_of(seed), second = t->seed_short ? 0 : high_of(seed);
    twisted_philox(t, c, t->key_exchanged ? second : first, t->key_exchanged ? first : second);
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
      {.draw_first = true, .text = "random address: draw + 256 purpose for purpose + 256 draw"},
      {.seed_short = true, .text = "the key's high word is 0: the seed has 64 bits"},
      {.entity = 1, .text = "random address: entities from 1, not 0 (entity + 1)"},
      {.entity = -1, .text = "random address: entity - 1"},
      {.later = 1, .text = "random address: words of the step after"},
      {.later = -1, .text = "random address: words of the step before"},
      {.draw = 1, .text = "random address: words of the next draw"},
      {.purpose = 1, .text = "random address: purpose + 1"},
      {.purpose = -1, .text = "random address: purpose - 1"},
      {.draw_factor = -1, .text = "random address: the draw is left out of the counter"},
      {.draw_factor = 1, .text = "random address: the draw is not times 256"},
      {.draw_factor = 16, .text = "random address: the draw is times 16, not 256"},
      {.draw_factor = 128, .text = "random address: the draw is times 128, not 256"},
      {.draw_factor = 255, .text = "random address: the draw is times 255, not 256"},
      {.draw_factor = 65536, .text = "random address: the draw is times 65536, not 256"},
      {.draw_factor = 0x1000000, .text = "random address: the draw is times 2^24, not 256"},
      {.entity_mask = 0xFF, .text = "entities cut to 8 bits"},
      {.entity_mask = 0xFFF, .text = "entities cut to 12 bits"},
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
      {.added = -1.0, .text = "uniforms with a half less, not more"},
      {.bits = 51, .text = "uniforms of 51 bits: they have 52, and a half"},
      {.bits = 50, .text = "uniforms of 50 bits: they have 52, and a half"},
      {.bits = 48, .text = "uniforms of 48 bits: they have 52, and a half"},
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
      {.scale = 2.0, .turns = 1.0, .text = "a constant factor of sqrt(2): -2 ln u is under the root"},
      {.scale = 1.44269504088896340736, .turns = 1.0, .text = "the logarithm to base 2: it is the natural one"},
      {.scale = 0.43429448190325182765, .turns = 1.0, .text = "the logarithm to base 10: it is the natural one"},
      {.scale = 1.0, .turns = 2.0, .text = "an angle of 4 pi times the uniform, not 2 pi"},
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
  double disk;   /* radius squared, 0: 1 */
  bool steps_of_two, exchanged;
  const char *text;
};

static bool axis_from(const struct axis_twist *t, const uint32_t w[4], uint32_t k, double n[3])
{
  const double half = t->without_half ? 0.0 : 0.5;
  const double u = ((t->unsigned_words ? (double)w[2 * k] : (double)(int32_t)w[2 * k]) + half) * 0x1p-31;
  const double v = ((t->unsigned_words ? (double)w[2 * k + 1] : (double)(int32_t)w[2 * k + 1]) + half) * 0x1p-31;
  const double q = u * u + v * v, root = t->without_root ? 1.0 - q : sqrt(1.0 - q);
  const double f = t->factor != 0.0 ? t->factor : 1.0;
  if (q >= (t->disk != 0.0 ? t->disk : 1.0))
    return false;
  n[0] = f * 2.0 * (t->exchanged ? v : u) * root, n[1] = f * 2.0 * (t->exchanged ? u : v) * root;
  n[2] = f * (1.0 - 2.0 * q);
  return true;
}

static void axis_at(const struct axis_twist *t, uint64_t seed, const int64_t address[4], double n[3])
{
  n[0] = n[1] = n[2] = NAN;
  for (uint32_t draw = (uint32_t)address[DRAW]; draw < (uint32_t)address[DRAW] + 64; draw += 1 + t->steps_of_two) {
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
      {.exchanged = true, .text = "columns exchanged: x of an axis is of the second word, y of the first"},
      {.halves_exchanged = true, .text = "axes of words 2, 3 before words 0, 1"},
      {.one_pair = true, .text = "axes of words 0, 1 of each draw only: words 2, 3 come before the next draw"},
      {.disk = 0.5, .text = "points of the disk of radius squared 1/2: it is 1"},
      {.disk = 0.25, .text = "points of the disk of radius 1/2: it is 1"},
      {.steps_of_two = true, .text = "random address: axes skip every second draw"},
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
  bool signed_words, by_entity, by_draw;
  const char *text;
};

static double shift_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct shift_twist *t = twist;
  const struct random_words r = random_at(
      oracle_seed(&part->pair), (enum random_purpose)(t->purpose ? t->purpose : RANDOM_GRID_SHIFT),
      (uint32_t)t->draw + (t->by_draw ? column : 0), part->pair.ours->place.step + (uint64_t)(int64_t)t->later,
      (uint32_t)t->entity + (t->by_entity ? column : 0));
  if (row > 0 || column > 2)
    return NAN;
  const uint32_t w = r.w[t->by_entity || t->by_draw ? (uint32_t)t->first : ((uint32_t)t->first + column) % 4];
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
      {.by_entity = true, .text = "the shift from word 0 of entities 0, 1, 2: it is words 0, 1, 2 of entity 0"},
      {.by_draw = true, .text = "the shift from word 0 of draws 0, 1, 2: it is words 0, 1, 2 of draw 0"},
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

const struct relation oracle_relations_random[] = {
    {"random", "out.word", words, false},
    {"random", "out.uniform", uniforms, false},
    {"random", "out.normal", normals, false},
    {"random", "out.axis", axes, false},
    {"random", "out.axis", axis_length, false},
    {"shift", "out.shift", shifts, false},
    {"solve", "out.axis", axes, false},
    {"solve", "out.axis", axis_length, false},
    {.make = NULL},
};

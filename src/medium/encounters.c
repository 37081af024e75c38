/*
 * All pairs of members nearer than 1 a0, each once: those within a cell, and those between a cell and the half of its
 * 26 neighbors that come after it. Cells along x follow each other in memory, so that half is the cell to the right and
 * four rows of three. Differences of places are exact, so that distances do not depend on which member is the first.
 */
#include "base/elementary.h"
#include "base/memory.h"
#include "base/normal.h"
#include "medium/medium.h"

enum { BLOCK = RANDOM_UNIFORMS, MOST_RANGES = 10 };

/* Members side by side, with the image of theirs that is meant. */
struct range {
  uint32_t first, end;
  struct vec3 shift;
};

/* Pairs that are near, before it is known which are chosen. */
struct near {
  uint32_t n;
  uint32_t a[2 * BLOCK], b[2 * BLOCK];
};

/* What is the same for all pairs of a step. */
struct search {
  const struct model *model;
  struct medium *medium;
  const struct bath_draw *draw;
  bath_weight *weigh;
  double x; /* rate dt */
  uint64_t step;
};

/* --- pairs that are near: the random numbers -----------------------------------------------------------------------
 */

/* A difference of two coordinates of the box, to the nearest image: exact. */
static inline double nearest(double difference, double edge)
{
  const double turns = difference / edge + ELEMENTARY_ROUND;
  return difference - edge * (turns - ELEMENTARY_ROUND);
}

/* Columns of a block of near pairs. */
struct columns {
  double x[BLOCK], y[BLOCK], z[BLOCK], r[BLOCK]; /* a - b, a0 */
  double rate[BLOCK], loss[BLOCK], normal[BLOCK];
  uint64_t word[4][BLOCK];
};

static void measure(const struct search *s, const uint32_t *a, const uint32_t *b, uint32_t n, struct columns *c)
{
  const struct medium *m = s->medium;
  const int *edge = s->model->box.cells;
  for (uint32_t k = 0; k < n; k++) {
    c->x[k] = nearest(m->x[a[k]] - m->x[b[k]], edge[0]);
    c->y[k] = nearest(m->y[a[k]] - m->y[b[k]], edge[1]);
    c->z[k] = nearest(m->z[a[k]] - m->z[b[k]], edge[2]);
  }
  for (uint32_t k = 0; k < n; k++)
    c->r[k] = sqrt(c->x[k] * c->x[k] + c->y[k] * c->y[k] + c->z[k] * c->z[k]);
  s->weigh(c->r, n, c->rate);
  for (uint32_t k = 0; k < n; k++)
    c->rate[k] *= s->x;
}

static void draw_words(const struct search *s, const uint32_t *a, const uint32_t *b, uint32_t n, struct columns *c)
{
  uint32_t low[BLOCK], high[BLOCK];
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t i = s->medium->number[a[k]], j = s->medium->number[b[k]];
    low[k] = i < j ? i : j;
    high[k] = i < j ? j : i;
  }
  random_wide_pair_columns(s->model->seed, RANDOM_BATH_PAIR, s->step, low, high, n, c->word);
}

/* Moves the pairs that are chosen to the front; their number. */
static uint32_t choose(uint32_t *a, uint32_t *b, uint32_t n, struct columns *c)
{
  uint32_t chosen = 0;
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t to = chosen;
    chosen += bath_chooses((uint32_t)c->word[0][k], c->rate[k]);
    a[to] = a[k];
    b[to] = b[k];
    c->x[to] = c->x[k];
    c->y[to] = c->y[k];
    c->z[to] = c->z[k];
    c->r[to] = c->r[k];
    for (int i = 1; i < 4; i++)
      c->word[i][to] = c->word[i][k];
  }
  return chosen;
}

static bool make_room(struct medium *m, uint32_t more)
{
  while (m->room - m->encounters < more)
    if (!memory_double((void **)&m->encounter, &m->room, 1024, sizeof *m->encounter) ||
        !memory_grow((void **)&m->key, m->room, sizeof *m->key) ||
        !memory_grow((void **)&m->spare, m->room, sizeof *m->spare))
      return false;
  return true;
}

/* Lists the chosen ones of up to BLOCK near pairs. */
static bool list_pairs(const struct search *s, uint32_t *a, uint32_t *b, uint32_t n)
{
  struct medium *m = s->medium;
  struct columns c;
  if (!make_room(m, n))
    return false;
  measure(s, a, b, n, &c);
  draw_words(s, a, b, n, &c);
  if (s->draw->chooses)
    n = choose(a, b, n, &c);
  s->draw->lose(c.rate, n, c.loss);
  random_normal_third_column(c.word[2], c.word[3], n, c.normal);
  for (uint32_t k = 0; k < n; k++) {
    const double inverse = 1.0 / c.r[k];
    const double masses = 1.0 / m->mover[a[k]].mass + 1.0 / m->mover[b[k]].mass;
    m->key[m->encounters] = (uint64_t)(uint32_t)c.word[1][k] << 32 | m->encounters;
    m->encounter[m->encounters++] = (struct encounter){{c.x[k] * inverse, c.y[k] * inverse, c.z[k] * inverse},
                                                       c.loss[k],
                                                       bath_noise(c.loss[k], masses) * c.normal[k],
                                                       a[k],
                                                       b[k]};
  }
  return true;
}

/* --- the search ----------------------------------------------------------------------------------------------------
 */

/* Cells x - 1 to x + 1 of a row, or x + 1 alone; where the box ends, two ranges. */
static uint32_t add_row(const struct search *s, int low, int high, int y, int z, uint32_t ranges, struct range *range)
{
  const int *edge = s->model->box.cells;
  const uint32_t *first = s->medium->first;
  const int row_y = y < 0 ? y + edge[1] : y < edge[1] ? y : y - edge[1], row_z = z < edge[2] ? z : z - edge[2];
  const uint32_t row = ((uint32_t)row_z * (uint32_t)edge[1] + (uint32_t)row_y) * (uint32_t)edge[0];
  const double along_y = y - row_y, along_z = z - row_z;
  const int inner_low = low < 0 ? 0 : low, inner_high = high < edge[0] ? high : edge[0] - 1;
  if (low < 0)
    range[ranges++] = (struct range){
        first[row + (uint32_t)edge[0] - 1], first[row + (uint32_t)edge[0]], {-(double)edge[0], along_y, along_z}};
  if (inner_low <= inner_high)
    range[ranges++] = (struct range){
        first[row + (uint32_t)inner_low], first[row + (uint32_t)inner_high + 1], {0.0, along_y, along_z}};
  if (high >= edge[0])
    range[ranges++] = (struct range){first[row], first[row + 1], {edge[0], along_y, along_z}};
  return ranges;
}

/* Adds the members of a part of a range that are near member i, and lists blocks that are full. */
static bool scan_block(const struct search *s, uint32_t i, struct vec3 shift, uint32_t first, uint32_t n,
                       struct near *near)
{
  const struct medium *m = s->medium;
  const double xi = m->x[i] - shift.x, yi = m->y[i] - shift.y, zi = m->z[i] - shift.z;
  double square[BLOCK];
  for (uint32_t k = 0; k < n; k++) {
    const double x = m->x[first + k] - xi, y = m->y[first + k] - yi, z = m->z[first + k] - zi;
    square[k] = x * x + y * y + z * z;
  }
  for (uint32_t k = 0; k < n; k++) {
    near->a[near->n] = i;
    near->b[near->n] = first + k;
    near->n += (square[k] < 1.0) & (square[k] > 0.0); /* no line joins two members at one place */
  }
  if (near->n < BLOCK)
    return true;
  near->n -= BLOCK;
  return list_pairs(s, &near->a[near->n], &near->b[near->n], BLOCK);
}

static bool scan(const struct search *s, uint32_t i, const struct range *range, uint32_t first, struct near *near)
{
  for (; first < range->end; first += BLOCK) {
    const uint32_t n = range->end - first < BLOCK ? range->end - first : BLOCK;
    if (!scan_block(s, i, range->shift, first, n, near))
      return false;
  }
  return true;
}

static bool search_cell(const struct search *s, int x, int y, int z, struct near *near)
{
  const int *edge = s->model->box.cells;
  const uint32_t cell = (uint32_t)((z * edge[1] + y) * edge[0] + x);
  const struct range own = {s->medium->first[cell], s->medium->first[cell + 1], {0, 0, 0}};
  struct range range[MOST_RANGES];
  uint32_t ranges = add_row(s, x + 1, x + 1, y, z, 0, range);
  ranges = add_row(s, x - 1, x + 1, y + 1, z, ranges, range);
  for (int dy = -1; dy <= 1; dy++)
    ranges = add_row(s, x - 1, x + 1, y + dy, z + 1, ranges, range);
  bool ok = true;
  for (uint32_t i = own.first; ok && i < own.end; i++) {
    ok = scan(s, i, &own, i + 1, near);
    for (uint32_t k = 0; ok && k < ranges; k++)
      ok = scan(s, i, &range[k], range[k].first, near);
  }
  return ok;
}

bool encounters_find(const struct model *model, struct medium *medium, uint64_t step)
{
  const struct search s = {model,
                           medium,
                           bath_draw_of(model->medium.draw),
                           bath_weight_of(model->medium.weight),
                           model->medium.rate * model->time_step,
                           step};
  const int *edge = model->box.cells;
  struct near near = {.n = 0};
  bool ok = true;
  medium->encounters = 0;
  for (int z = 0; z < edge[2]; z++)
    for (int y = 0; y < edge[1]; y++)
      for (int x = 0; ok && x < edge[0]; x++)
        ok = search_cell(&s, x, y, z, &near);
  return ok && list_pairs(&s, near.a, near.b, near.n);
}

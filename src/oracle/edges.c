/*
 * Constructed inputs, for what the state of a scene hardly ever shows: hits at the same time, positions one lattice
 * unit beside faces of cells, permutations that 24 bits get wrong. docs/port/packs.md says what is in each.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "mpc/grid.h"
#include "oracle/dice.h"
#include "oracle/drift.h"
#include "oracle/edges.h"
#include "oracle/rows.h"
#include "oracle/stages.h"

/* --- a permutation ----------------------------------------------------------------------------------------------- */

enum { PERMUTED = ORACLE_PERMUTED, TRIES = 4096 };

uint32_t edges_single_index(uint64_t r, uint32_t n, int way)
{
  const float all = (float)r * 0x1p-64f, high = (float)(r >> 32) * 0x1p-32f, cut = (float)(r >> 40) * 0x1p-24f;
  const float uniform = (float)(((double)(r >> 12) + 0.5) * 0x1p-52);
  const float ways[EDGES_SINGLE_WAYS] = {all, high, cut, uniform};
  const uint32_t at = (uint32_t)(ways[way] * (float)n);
  return at < n ? at : n - 1;
}

static uint32_t index_of(uint64_t r, uint32_t n)
{
  return (uint32_t)((uint64_t)(((r >> 32) * n + ((r & UINT32_MAX) * n >> 32)) >> 32));
}

/* True if each of these ways gets an index wrong, so that its permutation is another one. */
static bool single_is_wrong(uint64_t seed, uint64_t step)
{
  bool wrong[EDGES_SINGLE_WAYS] = {false, false, false, false};
  for (uint32_t k = 1; k < PERMUTED; k++) {
    const uint64_t r = random_u64(random_at(seed, RANDOM_VERTEX_ORDER, 0, step, k / 2), (int)(k % 2));
    for (int way = 0; way < EDGES_SINGLE_WAYS; way++)
      wrong[way] |= edges_single_index(r, k + 1, way) != index_of(r, k + 1);
  }
  return wrong[0] && wrong[1] && wrong[2] && wrong[3];
}

bool oracle_edges_permutation(struct oracle_stage *g)
{
  uint64_t step = 1;
  while (step < TRIES && !single_is_wrong(g->model->seed, step))
    step++;
  const struct oracle_permutation p = {.address = {RANDOM_VERTEX_ORDER, 0, PERMUTED, step}};
  return oracle_add_rows(g, &p, 1, sizeof p);
}

/* --- exchanges --------------------------------------------------------------------------------------------------- */

enum { EXCHANGES = 100 };

struct vec3 edges_normal(struct dice *d)
{
  const struct vec3 axes[3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  struct vec3 n = dice_vector(d, 1.0);
  while (vec3_norm(n) < 0.1)
    n = dice_vector(d, 1.0);
  return dice_u64(d) % 8 == 0 ? axes[dice_u64(d) % 3] : vec3_scale(1.0 / vec3_norm(n), n);
}

/* Ends of bonds are met now and then. */
double edges_place(struct dice *d)
{
  const double ends[3] = {0.0, 1.0, 0.5};
  const uint64_t k = dice_u64(d) % 8;
  return k < 3 ? ends[k] : dice_between(d, 0.0, 1.0);
}

struct vec3 edges_velocity(struct dice *d, bool moves)
{
  const struct vec3 v = dice_vector(d, 2.0);
  return vec3_scale(dice_u64(d) % 8 && moves ? 1.0 : 0.0, v);
}

bool oracle_edges_exchange(struct oracle_stage *g)
{
  static const double masses[6] = {1.0, 2.0, 5.0, 7.5, 100.25, 0x1p-4};
  struct dice d = {28};
  struct oracle_exchange e[EXCHANGES] = {{.s = 0.0}};
  for (int k = 0; k < EXCHANGES; k++) {
    for (int end = 0; end < 4; end++) {
      e[k].velocity[end] = edges_velocity(&d, k % 16);
      e[k].mass[end] = k % 4 == 0 ? 5.0 : masses[dice_u64(&d) % 6];
    }
    e[k].s = edges_place(&d), e[k].s_standing = edges_place(&d);
    e[k].normal = edges_normal(&d);
  }
  return oracle_add_rows(g, e, EXCHANGES, sizeof *e);
}

/* --- cells ------------------------------------------------------------------------------------------------------- */

/* On a face of a cell, one lattice unit below it, or one above; along the other axes too, or anywhere. */
static struct point beside_face(const struct box *box, struct point shift, struct dice *d, uint32_t k)
{
  const int64_t s[3] = {shift.x, shift.y, shift.z};
  int64_t x[3];
  for (uint32_t axis = 0; axis < 3; axis++) {
    const int64_t face = (int64_t)(dice_u64(d) % (uint64_t)box->cells[axis]) * LATTICE_CELL;
    const int64_t beside = axis == k % 3 ? (int64_t)(k / 3 % 3) - 1 : dice_integer(d, 1);
    const bool anywhere = axis != k % 3 && k % 2 == 0;
    const int64_t at = anywhere ? face + (int64_t)(dice_u64(d) % LATTICE_CELL) : face + beside;
    x[axis] = lattice_fold(at - s[axis], box->edge[axis]);
  }
  return (struct point){x[0], x[1], x[2]};
}

/* So many box edges away: none, a few, or nearly as many as a vertex may go. */
static struct point far_away(const struct box *box, struct dice *d, uint32_t k)
{
  const int64_t most[3] = {0, 3, 300000};
  struct point by = dice_point(d, most[k % 3]);
  by.x *= box->edge[0], by.y *= box->edge[1], by.z *= box->edge[2];
  return by;
}

bool oracle_edges_bin(struct oracle_stage *g)
{
  const struct box *box = &g->model->box;
  const struct point shift = grid_shift(g->model, g->place.step);
  struct solvent *s = &g->state->solvent;
  struct dice d = {40};
  for (uint32_t i = 0; i < s->n; i++) {
    const struct point r = beside_face(box, shift, &d, i);
    s->x[i] = r.x, s->y[i] = r.y, s->z[i] = r.z;
  }
  for (uint32_t v = 0; v < g->state->vertices; v++) {
    const struct point by = far_away(box, &d, v), at = beside_face(box, shift, &d, v);
    g->state->position[v] = point_plus(at, by);
  }
  return true;
}

/* --- hits at the same time --------------------------------------------------------------------------------------- */

#define PART (LATTICE_CELL / 16)
#define SLOTS 30
#define HALF_TURN 8 /* parts: a moving vertex goes from 4 to 12 along y */

/* Where the next fibers stand. */
struct scaffold {
  struct oracle_stage *stage;
  uint32_t pair, chain; /* the next vertex of each kind */
  uint32_t slot;
};

static struct point part_of(const struct scaffold *f, int x, int y, int z, const int32_t image[3])
{
  const uint32_t k = f->slot;
  const struct point corner = {(int64_t)(2 * (k % 2) + 1) * LATTICE_CELL, (int64_t)(k / 2 % 5) * LATTICE_CELL,
                               (int64_t)(k / 10) * LATTICE_CELL + 8 * PART};
  return point_image(point_plus(corner, (struct point){x * PART, y * PART, z * PART}), image, &f->stage->model->box);
}

static const int32_t here[3] = {0, 0, 0};

static void stand(struct scaffold *f, uint32_t vertex, int x, int y, int z, const int32_t image[3])
{
  f->stage->state->position[vertex] = part_of(f, x, y, z, image);
  f->stage->state->velocity[vertex] = (struct vec3){0, 0, 0};
}

/* A standing pair along z through (x, 8), a few boxes away. */
static void stand_pair(struct scaffold *f, int x)
{
  const int up = f->pair % 4 ? 1 : -1;
  const int32_t image[3] = {(int32_t)(f->pair % 3) - 1, (int32_t)(f->pair / 2 % 4) - 2, (int32_t)(f->pair / 4 % 2)};
  stand(f, f->pair, x, HALF_TURN, -4 * up, image);
  stand(f, f->pair + 1, x, HALF_TURN, 4 * up, image);
  f->pair += 2;
}

/* A moving pair: its vertex at x = 8 goes through y = 8 at half of its time, its pivot at x = 0 stays there. */
static void move_pair(struct scaffold *f)
{
  const uint32_t v = f->pair + f->slot % 2, pivot = f->pair + 1 - f->slot % 2;
  stand(f, pivot, 0, HALF_TURN, 0, here);
  stand(f, v, 8, 4, 0, here);
  f->stage->state->velocity[v].y = 0.5 / (32.0 * f->stage->model->time_step);
  f->pair += 2;
}

/* A moving chain: its middle vertex does so at x = 0, both its neighbors at x = -8 and 8 stay. */
static void move_chain(struct scaffold *f)
{
  const int side = f->slot % 2 ? 8 : -8;
  stand(f, f->chain, side, HALF_TURN, 0, here);
  stand(f, f->chain + 1, 0, 4, 0, here);
  stand(f, f->chain + 2, -side, HALF_TURN, 0, here);
  f->stage->state->velocity[f->chain + 1].y = 0.5 / (32.0 * f->stage->model->time_step);
  f->chain += 3;
}

/* A standing chain along z, its middle vertex where the moving bond is at the beginning, the middle, the end of its
 * move. */
static void stand_chain(struct scaffold *f, int y, int bent)
{
  const int32_t image[3] = {0, (int32_t)(f->slot % 3) - 1, 2};
  stand(f, f->chain, 4, y + bent, -4, image);
  stand(f, f->chain + 1, 4, y, 0, image);
  stand(f, f->chain + 2, 4, y, 4, image);
  f->chain += 3;
}

static void build(struct scaffold *f)
{
  static const int three[6][3] = {{2, 5, 7}, {2, 7, 5}, {5, 2, 7}, {5, 7, 2}, {7, 2, 5}, {7, 5, 2}};
  static const int both[6][4] = {{4, -4, 0, 0}, {4, -4, 0, 0},  {-4, 4, 0, 0},
                                 {-4, 4, 0, 0}, {6, -3, 3, -6}, {-6, 3, -3, 6}};
  static const int touched[4][2] = {{8, 0}, {8, 1}, {6, 0}, {10, -1}}; /* y at x = 4, of the moving bond: 6 to 10 */
  for (int k = 0; k < 6; k++, f->slot++) {
    move_pair(f);
    for (int j = 0; j < 3; j++)
      stand_pair(f, three[k][j]);
  }
  for (int k = 0; k < 6; k++, f->slot++) {
    move_chain(f);
    for (int j = 0; j < 4 && both[k][j]; j++)
      stand_pair(f, both[k][j]);
  }
  for (int k = 0; k < 4; k++, f->slot++) {
    move_pair(f);
    stand_chain(f, touched[k][0], touched[k][1]);
  }
}

void edges_at_the_same_time(struct oracle_stage *g)
{
  struct scaffold f = {g, 0, 2 * EDGES_PAIRS, 0};
  memset(g->state->velocity, 0, g->state->vertices * sizeof *g->state->velocity);
  build(&f);
  contact_forget_places(&g->work->contact);
}

bool oracle_edges_sweep(struct oracle_stage *g)
{
  edges_at_the_same_time(g);
  return oracle_begin_drift_of(g, 32.0 * g->model->time_step, 0);
}

#include "fiber/overdamped.h"

#include <math.h>
#include <string.h>

#include "base/normal.h"
#include "fiber/mobility.h"
#include "fiber/tension.h"
#include "system/fiber_kind.h"

static uint32_t longest_fiber(const struct model *m)
{
  uint32_t most = 0;
  for (uint32_t k = 0; k < m->kinds; k++)
    most = m->kind[k].vertices > most ? m->kind[k].vertices : most;
  return most;
}

enum { BOND_DOUBLES = (sizeof(struct tension_bond) + sizeof(double) - 1) / sizeof(double) + 1 };

/* Four vectors and, with a tensor, a matrix of the longest fiber; with tensions those of its bonds, and a matrix. */
size_t overdamped_doubles(const struct model *m)
{
  const size_t most = longest_fiber(m), order = 3 * most;
  if (!model_is_overdamped(m))
    return 0;
  return order * 5 + (m->medium.tensor != TENSOR_NONE ? order * order : 0) +
         (m->medium.inextensible ? most * (most + BOND_DOUBLES) : 0);
}

/* One fiber, n components of n/3 vertices. */
struct chain {
  uint32_t first, n;
  double *force, *noise, *pull, *jump; /* [n] F, xi, D F/D0, L xi */
  struct vec3 *place;                  /* [n/3] relative to the first vertex, a0 */
  double *tensor;                      /* [n][n] D/D0, then L */
};

static struct chain chain_of(const struct model *m, uint32_t fiber, double *scratch)
{
  const uint32_t first = m->fiber_first[fiber], n = 3 * (m->fiber_first[fiber + 1] - first);
  return (struct chain){.first = first,
                        .n = n,
                        .force = scratch,
                        .noise = scratch + n,
                        .pull = scratch + 2 * (size_t)n,
                        .jump = scratch + 3 * (size_t)n,
                        .place = (struct vec3 *)(scratch + 4 * (size_t)n),
                        .tensor = scratch + 5 * (size_t)n};
}

/* Normals of a block of vertices, of one fiber or several. */
struct normals {
  uint32_t first, end;
  double x[RANDOM_UNIFORMS], y[RANDOM_UNIFORMS], z[RANDOM_UNIFORMS];
};

static void draw_normals(const struct model *m, uint64_t step, uint32_t first, struct normals *d)
{
  uint32_t vertex[RANDOM_UNIFORMS];
  const uint32_t n = m->vertices - first < RANDOM_UNIFORMS ? m->vertices - first : RANDOM_UNIFORMS;
  for (uint32_t k = 0; k < n; k++)
    vertex[k] = first + k;
  random_normal_three_columns(m->seed, RANDOM_BATH_VERTEX, 0, step, vertex, n, d->x, d->y, d->z);
  d->first = first;
  d->end = first + n;
}

/* xi of a fiber's vertices, which come after those before. */
static void gather_noise(const struct model *m, uint64_t step, const struct chain *c, struct normals *d)
{
  for (uint32_t i = 0, v = c->first; i < c->n; i += 3, v++) {
    if (v >= d->end)
      draw_normals(m, step, v, d);
    c->noise[i] = d->x[v - d->first];
    c->noise[i + 1] = d->y[v - d->first];
    c->noise[i + 2] = d->z[v - d->first];
  }
}

/* Forces; and places, if a tensor or tensions need them. */
static void gather(const struct state *state, const struct model *m, const struct vec3 *force, const struct chain *c)
{
  for (uint32_t i = 0, v = c->first; i < c->n; i += 3, v++) {
    c->force[i] = force[v].x;
    c->force[i + 1] = force[v].y;
    c->force[i + 2] = force[v].z;
  }
  if (m->medium.tensor == TENSOR_NONE && !m->medium.inextensible)
    return;
  for (uint32_t k = 0; k < c->n / 3; k++)
    c->place[k] = point_difference(state->position[c->first + k], state->position[c->first]);
}

static double vertex_mobility(const struct model *m, uint32_t vertex)
{
  return m->inverse_mass[vertex] / m->medium.rate;
}

/* Adds tensions to the forces. There is no noise. */
static bool hold_bonds(const struct model *m, struct chain *c, bool coupled, uint64_t step, struct fault *fault)
{
  const uint32_t n = c->n / 3;
  double *matrix = c->tensor + (coupled ? (size_t)c->n * c->n : 0), *t = matrix + (size_t)n * n, pivot = 0.0;
  struct tension_bond *bond = (struct tension_bond *)(t + n);
  const double length = m->kind[m->fiber_kind_of[m->fiber_of[c->first]]].bond_length;
  const double moved = vertex_mobility(m, c->first) * m->time_step;
  uint32_t bonds = 0;
  for (uint32_t v = 0; v < n; v++) {
    if (m->next[c->first + v] < 0)
      continue;
    const uint32_t to = (uint32_t)m->next[c->first + v] - c->first;
    const struct vec3 r = vec3_sub(c->place[to], c->place[v]);
    const double now = vec3_norm(r);
    bond[bonds++] = (struct tension_bond){vec3_scale(now > 0.0 ? 1.0 / now : 0.0, r), (now - length) / moved, v, to};
  }
  memset(c->jump, 0, c->n * sizeof *c->jump);
  return tension_add(c->n, coupled ? c->tensor : NULL, c->pull, bonds, bond, matrix, t, c->force, &pivot) ||
         fault_record(fault, FAULT_TENSION, step, c->first, pivot, TENSION_LEAST_PIVOT);
}

/* pull = D F and jump = L xi. */
static bool couple(const struct model *m, struct chain *c, uint64_t step, struct fault *fault)
{
  const struct mobility *mobility = mobility_of(m->medium.tensor);
  const bool coupled = mobility->block != NULL;
  double pivot;
  if (!coupled) {
    c->pull = c->force;
    c->jump = c->noise;
    return !m->medium.inextensible || hold_bonds(m, c, coupled, step, fault);
  }
  mobility_fill(mobility, m->medium.radius, c->n / 3, c->place, c->tensor);
  mobility_apply(c->n, c->tensor, c->force, c->pull);
  if (m->medium.inextensible) {
    const bool held = hold_bonds(m, c, coupled, step, fault);
    mobility_apply(c->n, c->tensor, c->force, c->pull);
    return held;
  }
  if (!mobility_factor(c->n, c->tensor, &pivot))
    return fault_record(fault, FAULT_MOBILITY, step, c->first, pivot, 0.0);
  mobility_root(c->n, c->tensor, c->noise, c->jump);
  return true;
}

static double largest(struct vec3 d)
{
  return fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z)));
}

static inline bool is_within(struct vec3 d, double limit)
{
  return fabs(d.x) < limit && fabs(d.y) < limit && fabs(d.z) < limit;
}

/* All vertices but ends that are held. */
static bool move(struct state *state, const struct model *m, const struct chain *c, uint64_t step, struct fault *fault)
{
  const uint32_t skip = model_is_held(m, c->first), end = c->n - 3 * model_is_held(m, c->first + c->n / 3 - 1);
  const double drift = vertex_mobility(m, c->first + skip) * m->time_step, jump = sqrt(2.0 * drift);
  const double limit = model_longest_bond(m), reach = (double)LATTICE_REACH * LATTICE_UNIT;
  for (uint32_t i = 3 * skip, v = c->first + skip; i < end; i += 3, v++) {
    const struct vec3 d = {drift * c->pull[i] + jump * c->jump[i] + m->flow.x * m->time_step,
                           drift * c->pull[i + 1] + jump * c->jump[i + 1] + m->flow.y * m->time_step,
                           drift * c->pull[i + 2] + jump * c->jump[i + 2] + m->flow.z * m->time_step};
    struct point *p = &state->position[v];
    if (!is_within(d, limit))
      return fault_record(fault, FAULT_VERTEX_MOVE, step, v, largest(d), limit);
    *p = (struct point){p->x + lattice_from_a0(d.x), p->y + lattice_from_a0(d.y), p->z + lattice_from_a0(d.z)};
    const struct vec3 r = point_in_a0(*p);
    if (!is_within(r, reach))
      return fault_record(fault, FAULT_VERTEX_PLACE, step, v, largest(r), reach);
  }
  return true;
}

bool overdamped_move(struct state *state, const struct model *m, const struct vec3 *force, double *scratch,
                     uint64_t step, struct fault *fault)
{
  bool ok = true;
  struct normals normals;
  normals.first = normals.end = 0;
  for (uint32_t f = 0; ok && f < m->fibers; f++) {
    struct chain chain = chain_of(m, f, scratch);
    if (fiber_stands(&m->kind[m->fiber_kind_of[f]]))
      continue;
    gather(state, m, force, &chain);
    if (!m->medium.inextensible)
      gather_noise(m, step, &chain, &normals);
    ok = couple(m, &chain, step, fault) && move(state, m, &chain, step, fault);
  }
  return ok;
}

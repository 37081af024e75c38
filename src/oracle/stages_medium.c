/* The operators of baths other than that of collision cells, of forces of pairs and of overdamped motion, each alone:
 * docs/port/media.md, *Media*. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fiber/mobility.h"
#include "fiber/overdamped.h"
#include "medium/near.h"
#include "medium/repulsion.h"
#include "oracle/columns.h"
#include "oracle/stages.h"

void oracle_put_medium(struct oracle_stage *g)
{
  const struct model *m = g->model;
  const struct medium_model *b = &m->medium;
  int64_t *to = oracle_put_integers(g, "in.medium", "kind draw weight tensor second", 1);
  const int64_t which[5] = {b->kind, b->draw, b->weight, b->tensor,
                            b->second.share > 0.0 ? b->second.first : m->solvent.particles};
  if (to)
    memcpy(to, which, sizeof which);
  double *real =
      oracle_put_reals(g, "in.bath", "rate radius repulsion between many_body many_body_range flow_x flow_y flow_z", 1);
  const double r[9] = {b->rate,   b->radius, b->repulsion, b->second.repulsion, b->many.repulsion, b->many.range,
                       m->flow.x, m->flow.y, m->flow.z};
  if (real)
    memcpy(real, r, sizeof r);
}

/* --- private --------------------------------------------------------------------------------------------------- */

bool oracle_run_private_bath(struct oracle_stage *g)
{
  oracle_put_vectors(g, "in.velocity", g->state->velocity, g->state->vertices);
  const bool ok = private_collide(g->state, g->model, &g->work->medium, g->place.step, &g->work->fault);
  oracle_put_vectors(g, "out.velocity", g->state->velocity, g->state->vertices);
  return ok;
}

/* --- pairs ----------------------------------------------------------------------------------------------------- */

static void put_places(struct oracle_stage *g)
{
  oracle_put_solvent_positions(g, "in.solvent");
  oracle_put_points(g, "in.vertex", g->state->position, g->state->vertices);
}

/* Chosen pairs in the order in which the bath acts on them; the line from the second number to the first, which is the
 * smaller one. */
static void put_encounters(struct oracle_stage *g, bool in)
{
  const struct medium *m = &g->work->medium;
  const uint32_t n = m->encounters;
  int64_t *pair = oracle_put_integers(g, in ? "in.pair" : "out.pair", "first second", n);
  double *along = oracle_put_reals(g, in ? "in.along" : "out.along", "x y z", n);
  double *bath = oracle_put_reals(g, in ? "in.bath" : "out.bath", "loss noise", n);
  for (uint32_t k = 0; pair && along && bath && k < n; k++) {
    const struct encounter *e = &m->encounter[(uint32_t)m->key[k]];
    const uint32_t a = m->number[e->a], b = m->number[e->b];
    const double sign = a < b ? 1.0 : -1.0;
    pair[2 * k] = a < b ? a : b, pair[2 * k + 1] = a < b ? b : a;
    along[3 * k] = sign * e->along.x, along[3 * k + 1] = sign * e->along.y, along[3 * k + 2] = sign * e->along.z;
    bath[2 * k] = e->loss, bath[2 * k + 1] = e->noise;
  }
}

bool oracle_run_pairs(struct oracle_stage *g)
{
  struct medium *m = &g->work->medium;
  state_solvent_slots(g->state, g->slot);
  put_places(g);
  members_gather(g->state, g->model, m);
  g->pack->failed |= !encounters_find(g->model, m, g->place.step);
  encounters_order(m);
  put_encounters(g, false);
  return !g->pack->failed;
}

/* After `pairs`, with its members. */
bool oracle_run_pair_bath(struct oracle_stage *g)
{
  struct medium *m = &g->work->medium;
  put_encounters(g, true);
  oracle_put_velocities(g, "in.solvent", "in.vertex");
  for (uint32_t k = 0; k < m->encounters; k++)
    encounter_act(&m->encounter[(uint32_t)m->key[k]], m->mover);
  members_scatter(g->state, m);
  state_solvent_slots(g->state, g->slot);
  oracle_put_velocities(g, "out.solvent", "out.vertex");
  return true;
}

/* --- forces of pairs --------------------------------------------------------------------------------------------- */

/* Sums of members, by their numbers. */
static void put_sums(struct oracle_stage *g, const char *name, const char *components, uint32_t columns,
                     const int64_t *sum)
{
  const struct medium *m = &g->work->medium;
  int64_t *to = oracle_put_integers(g, name, components, m->members);
  for (uint32_t k = 0; to && k < m->members; k++)
    memcpy(&to[(size_t)columns * m->number[k]], &sum[(size_t)columns * k], columns * sizeof *to);
}

bool oracle_run_crowd(struct oracle_stage *g)
{
  state_solvent_slots(g->state, g->slot);
  put_places(g);
  const bool ok = repulsion_forces(g->state, g->model, &g->work->medium, &g->work->fault);
  if (ok)
    put_sums(g, "out.crowd", "crowd", 1, g->work->medium.crowd);
  return ok;
}

bool oracle_run_repulsion(struct oracle_stage *g)
{
  state_solvent_slots(g->state, g->slot);
  put_places(g);
  const bool ok = repulsion_forces(g->state, g->model, &g->work->medium, &g->work->fault);
  if (ok && g->model->medium.many.repulsion != 0.0)
    put_sums(g, "in.crowd", "crowd", 1, g->work->medium.crowd);
  if (ok)
    put_sums(g, "out.force", "x y z", 3, g->work->medium.push);
  return ok;
}

bool oracle_run_repulsion_kick(struct oracle_stage *g)
{
  oracle_put_number(g, "in.time", "dt", 0.5 * g->model->time_step);
  put_sums(g, "in.force", "x y z", 3, g->work->medium.push);
  oracle_put_velocities(g, "in.solvent", "in.vertex");
  repulsion_kick(g->state, g->model, &g->work->medium, 0.5);
  oracle_put_velocities(g, "out.solvent", "out.vertex");
  return true;
}

/* --- overdamped motion ------------------------------------------------------------------------------------------- */

static uint32_t vertices_of(const struct model *m, uint32_t fiber)
{
  return m->fiber_first[fiber + 1] - m->fiber_first[fiber];
}

/* Entries of the lower triangles of all fibers. */
static uint32_t entries(const struct model *m)
{
  uint32_t n = 0;
  for (uint32_t f = 0; f < m->fibers; f++)
    n += 3 * vertices_of(m, f) * (3 * vertices_of(m, f) + 1) / 2;
  return n;
}

/* |D^-1| of Frobenius, from L: of which the rounding of L is a multiple (docs/port/tolerances.md, *Tolerances*). */
static double inverse_norm(uint32_t n, const double *l, double *x, double *y)
{
  double sum = 0.0;
  for (uint32_t k = 0; k < n; k++) {
    memset(x, 0, n * sizeof *x);
    for (uint32_t i = k; i < n; i++) { /* L x = e_k */
      double rest = i == k ? 1.0 : 0.0;
      for (uint32_t j = k; j < i; j++)
        rest -= l[(size_t)j * n + i] * x[j];
      x[i] = rest / l[(size_t)i * n + i];
    }
    for (uint32_t i = n; i-- > 0;) { /* L^T y = x */
      double rest = x[i];
      for (uint32_t j = i + 1; j < n; j++)
        rest -= l[(size_t)i * n + j] * y[j];
      y[i] = rest / l[(size_t)i * n + i];
      sum += y[i] * y[i];
    }
  }
  return sqrt(sum);
}

enum entry { TENSOR, ROOT, CONDITION };

/* One fiber's tensor, its root, or the condition of it, into `to`. False if the tensor is not positive. */
static bool fill_entries(struct oracle_stage *g, uint32_t fiber, enum entry what, double *scratch, double *to)
{
  const struct model *m = g->model;
  const uint32_t first = m->fiber_first[fiber], vertices = vertices_of(m, fiber), n = 3 * vertices;
  struct vec3 *place = (struct vec3 *)scratch;
  double *d = scratch + n, *x = d + (size_t)n * n, pivot = 0.0;
  for (uint32_t v = 0; v < vertices; v++)
    place[v] = point_difference(g->state->position[first + v], g->state->position[first]);
  mobility_fill(mobility_of(m->medium.tensor), m->medium.radius, vertices, place, d);
  if (what != TENSOR && !mobility_factor(n, d, &pivot))
    return fault_record(&g->work->fault, FAULT_MOBILITY, g->place.step, first, pivot, 0.0);
  const double condition = what == CONDITION ? inverse_norm(n, d, x, x + n) : 0.0;
  for (uint32_t k = 0; k < n; k++)
    for (uint32_t i = k; i < n; i++)
      *to++ = what == CONDITION ? condition : d[(size_t)k * n + i];
  return true;
}

static bool put_entries(struct oracle_stage *g, const char *name, const char *component, enum entry what)
{
  const struct model *m = g->model;
  uint32_t most = 0;
  for (uint32_t f = 0; f < m->fibers; f++)
    most = vertices_of(m, f) > most ? vertices_of(m, f) : most;
  const size_t n = 3 * (size_t)most;
  double *to = oracle_put_reals(g, name, component, entries(m)),
         *scratch = malloc((n * n + 3 * n + 1) * sizeof *scratch);
  bool ok = to && scratch;
  g->pack->failed |= !ok;
  for (uint32_t f = 0; ok && f < m->fibers; f++) {
    const uint32_t order = 3 * vertices_of(m, f);
    ok = fill_entries(g, f, what, scratch, to);
    to += order * (order + 1) / 2;
  }
  free(scratch);
  return ok;
}

bool oracle_run_mobility(struct oracle_stage *g)
{
  oracle_put_points(g, "in.position", g->state->position, g->state->vertices);
  return put_entries(g, "out.tensor", "entry", TENSOR);
}

bool oracle_run_root(struct oracle_stage *g)
{
  return put_entries(g, "in.tensor", "entry", TENSOR) && put_entries(g, "out.root", "entry", ROOT) &&
         put_entries(g, "bound.root", "condition", CONDITION);
}

/* After `force`. */
bool oracle_run_move(struct oracle_stage *g)
{
  const struct fiber *f = &g->work->fiber;
  const bool coupled = g->model->medium.tensor != TENSOR_NONE;
  oracle_put_points(g, "in.position", g->state->position, g->state->vertices);
  oracle_put_vectors(g, "in.force", f->force, g->state->vertices);
  if (coupled && !(put_entries(g, "in.tensor", "entry", TENSOR) && put_entries(g, "in.root", "entry", ROOT)))
    return false;
  const bool ok = overdamped_move(g->state, g->model, f->force, f->overdamped, g->place.step, &g->work->fault);
  oracle_put_points(g, "out.position", g->state->position, g->state->vertices);
  return ok;
}

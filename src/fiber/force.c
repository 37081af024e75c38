#include "fiber/force.h"

#include "base/lattice_lanes.h"
#include "system/fiber_kind.h"

/* Derivative of bond_energy; positive pulls the ends of the bond together. */
static inline double bond_tension(const struct fiber_kind *k, double length)
{
  return k->spring * (length - k->bond_length);
}

/* Padding 2009, Eq. (1), with k = K/l0. */
static inline double bond_energy(const struct fiber_kind *k, double length)
{
  return 0.5 * k->spring * (length - k->bond_length) * (length - k->bond_length);
}

/* Padding 2009, Eq. (2), with kappa = l_p/l0. Its forces are derived in force.h. */
static inline double bend_energy(const struct fiber_kind *k, double cosine)
{
  return k->bending * (1.0 - cosine);
}

static bool bond_fits(const struct model *model, uint64_t step, uint32_t j, double squared, struct fault *fault)
{
  const double limit = model_longest_bond(model);
  return squared < limit * limit || fault_record(fault, FAULT_BOND_TOO_LONG, step, j, sqrt(squared), limit);
}

enum { BLOCK = 125, ROOM = BLOCK + 3 }; /* vertices per block; bonds that act on them, directly or through bends */

/* A stretch of a fiber in columns, so that loops vectorise. Entry c is bond or bend number first + c; bend number i
 * lies between bonds i - 1 and i. Beyond the ends of an open fiber an entry has length 0 and exerts no force. */
struct stretch {
  int64_t first;
  uint32_t n;                          /* bonds */
  double x[ROOM], y[ROOM], z[ROOM];    /* bond vectors, then the force of each bond's spring on its first vertex */
  double ux[ROOM], uy[ROOM], uz[ROOM]; /* unit vectors */
  double inverse[ROOM];                /* of lengths */
  double bx[ROOM], by[ROOM], bz[ROOM]; /* force of each bend on the vertex before its own */
  double ax[ROOM], ay[ROOM], az[ROOM]; /* and after it */
};

/* Bond vectors of consecutive bonds; from, to: vertices of the first of them. True if one is too long. */
static bool measure_bonds(const struct state *state, double limit, uint32_t from, uint32_t to, uint32_t n,
                          struct stretch *restrict s, uint32_t c)
{
  double *restrict x = &s->x[c], *restrict y = &s->y[c], *restrict z = &s->z[c];
  struct vec3 bonds[ROOM];
  int64_t beyond = 0;
  point_differences(&state->position[to], &state->position[from], n, bonds);
  for (uint32_t k = 0; k < n; k++) {
    const struct vec3 r = bonds[k];
    x[k] = r.x, y[k] = r.y, z[k] = r.z;
    beyond |= !(vec3_dot(r, r) < limit * limit);
  }
  return beyond;
}

/* Fills all bond vectors of the stretch. False, with the fault recorded, if one is too long. */
static bool measure(const struct state *state, const struct model *model, uint64_t step, const struct fiber_kind *kind,
                    uint32_t fiber, struct stretch *s, struct fault *fault)
{
  const int64_t last = kind->vertices - 1;
  const double limit = model_longest_bond(model);
  bool beyond = false;
  for (uint32_t c = 0; c < s->n;) {
    const int64_t j = s->first + c;
    uint32_t n = 1;
    if (j >= 0 && j < last) {
      n = (uint32_t)(last - j) < s->n - c ? (uint32_t)(last - j) : s->n - c;
      beyond |= measure_bonds(state, limit, fiber + (uint32_t)j, fiber + (uint32_t)j + 1, n, s, c);
    } else if (kind->ring) {
      const uint32_t from = (uint32_t)((j + last + 1) % (last + 1)), to = (uint32_t)((j + last + 2) % (last + 1));
      beyond |= measure_bonds(state, limit, fiber + from, fiber + to, 1, s, c);
    } else
      s->x[c] = s->y[c] = s->z[c] = 0.0;
    c += n;
  }
  bool ok = true;
  for (uint32_t c = 0; beyond && c < s->n; c++) {
    const struct vec3 r = {s->x[c], s->y[c], s->z[c]};
    const uint32_t j = (uint32_t)((s->first + c + last + 1) % (last + 1));
    ok = ok && bond_fits(model, step, fiber + j, vec3_dot(r, r), fault);
  }
  return ok;
}

/* Springs without a rest length pull along the bond vector itself: no square root. */
static void pull_of_zero_length(const struct fiber_kind *kind, struct stretch *restrict s)
{
  for (uint32_t c = 0; c < s->n; c++) {
    const struct vec3 f = vec3_scale(kind->spring, (struct vec3){s->x[c], s->y[c], s->z[c]});
    s->x[c] = f.x, s->y[c] = f.y, s->z[c] = f.z;
  }
}

static void pull(const struct fiber_kind *kind, struct stretch *restrict s)
{
  for (uint32_t c = 0; c < s->n; c++) {
    const struct vec3 r = {s->x[c], s->y[c], s->z[c]};
    const double length = sqrt(vec3_dot(r, r)), inverse = length > 0.0 ? 1.0 / length : 0.0;
    const struct vec3 u = vec3_scale(inverse, r), f = vec3_scale(bond_tension(kind, length), u);
    s->inverse[c] = inverse;
    s->ux[c] = u.x, s->uy[c] = u.y, s->uz[c] = u.z;
    s->x[c] = f.x, s->y[c] = f.y, s->z[c] = f.z;
  }
}

/* Forces of a bend on the vertices before and after its own, which gets the opposite of both. */
struct bend_force {
  struct vec3 before, after;
};

/* u0, u1: unit vectors of the bonds before and after; their inverse lengths. The formula: force.h. */
static inline struct bend_force bend_of_bonds(const struct fiber_kind *kind, struct vec3 u0, double inverse0,
                                              struct vec3 u1, double inverse1)
{
  const double cosine = vec3_dot(u0, u1);
  return (struct bend_force){vec3_scale(-kind->bending * inverse0, vec3_add_scaled(u1, -cosine, u0)),
                             vec3_scale(kind->bending * inverse1, vec3_add_scaled(u0, -cosine, u1))};
}

static void bend(const struct fiber_kind *kind, struct stretch *restrict s)
{
  for (uint32_t c = 1; c < s->n; c++) {
    const struct vec3 u0 = {s->ux[c - 1], s->uy[c - 1], s->uz[c - 1]}, u1 = {s->ux[c], s->uy[c], s->uz[c]};
    const struct bend_force f = bend_of_bonds(kind, u0, s->inverse[c - 1], u1, s->inverse[c]);
    s->bx[c] = f.before.x, s->by[c] = f.before.y, s->bz[c] = f.before.z;
    s->ax[c] = f.after.x, s->ay[c] = f.after.y, s->az[c] = f.after.z;
  }
}

/* Forces on n vertices, the first of them number first + 2. */
static void add_pulls(const struct fiber_kind *kind, const struct stretch *restrict s, uint32_t n,
                      struct vec3 *restrict force)
{
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t c = k + 2;
    const struct vec3 before = {s->x[c - 1], s->y[c - 1], s->z[c - 1]}, after = {s->x[c], s->y[c], s->z[c]};
    force[k] = vec3_add(vec3_sub(kind->force, before), after);
  }
}

static void add_bends(const struct stretch *restrict s, uint32_t n, struct vec3 *restrict force)
{
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t c = k + 2;
    const struct vec3 of_before = {s->ax[c - 1], s->ay[c - 1], s->az[c - 1]},
                      own = {s->bx[c] + s->ax[c], s->by[c] + s->ay[c], s->bz[c] + s->az[c]},
                      of_after = {s->bx[c + 1], s->by[c + 1], s->bz[c + 1]};
    force[k] = vec3_add(vec3_sub(vec3_add(force[k], of_before), own), of_after);
  }
}

/* The same for the first or last vertex of a ring, entry c. Terms are added in the order of bonds, then of bends; those
 * that close the ring have the numbers of its last and first vertex. */
static struct vec3 force_where_ring_closes(const struct fiber_kind *kind, const struct stretch *s, uint32_t c,
                                           bool is_first)
{
  const struct vec3 before = {s->x[c - 1], s->y[c - 1], s->z[c - 1]}, after = {s->x[c], s->y[c], s->z[c]};
  const struct vec3 pulled =
      is_first ? vec3_sub(vec3_add(kind->force, after), before) : vec3_add(vec3_sub(kind->force, before), after);
  if (kind->bending == 0.0)
    return pulled;
  const struct vec3 of_before = {s->ax[c - 1], s->ay[c - 1], s->az[c - 1]},
                    own = {s->bx[c] + s->ax[c], s->by[c] + s->ay[c], s->bz[c] + s->az[c]},
                    of_after = {s->bx[c + 1], s->by[c + 1], s->bz[c + 1]};
  return is_first ? vec3_add(vec3_add(vec3_sub(pulled, own), of_after), of_before)
                  : vec3_sub(vec3_add(vec3_add(pulled, of_after), of_before), own);
}

/* Forces on vertices number v .. v + n - 1 of a fiber. */
static bool forces_on(const struct state *state, const struct model *model, uint64_t step,
                      const struct fiber_kind *kind, uint32_t fiber, uint32_t v, uint32_t n, struct vec3 *force,
                      struct fault *fault)
{
  struct stretch s;
  s.first = (int64_t)v - 2, s.n = n + 3;
  const bool ok = measure(state, model, step, kind, fiber, &s, fault), bent = kind->bending != 0.0;
  if (kind->bond_length == 0.0 && !bent)
    pull_of_zero_length(kind, &s);
  else
    pull(kind, &s);
  add_pulls(kind, &s, n, force);
  if (bent) {
    bend(kind, &s);
    add_bends(&s, n, force);
  }
  const uint32_t last = kind->vertices - 1;
  if (kind->ring && v == 0)
    force[0] = force_where_ring_closes(kind, &s, 2, true);
  if (kind->ring && v + n > last)
    force[last - v] = force_where_ring_closes(kind, &s, last - v + 2, false);
  return ok;
}

bool fiber_forces(const struct state *state, const struct model *model, struct vec3 *force, uint64_t step,
                  struct fault *fault)
{
  bool ok = true;
  for (uint32_t f = 0; f < model->fibers; f++) {
    const struct fiber_kind *kind = &model->kind[model->fiber_kind_of[f]];
    if (kind->vertices == 1) {
      force[model->fiber_first[f]] = kind->force;
      continue;
    }
    for (uint32_t v = 0; v < kind->vertices; v += BLOCK) {
      const uint32_t left = kind->vertices - v;
      ok &= forces_on(state, model, step, kind, model->fiber_first[f], v, left < BLOCK ? left : BLOCK,
                      &force[model->fiber_first[f] + v], fault);
    }
  }
  return ok;
}

/* --- the force on one vertex -------------------------------------------------------------------------------------- */

/* A bond near the vertex; absent beyond the end of an open fiber. */
struct near_bond {
  bool there;
  struct vec3 unit, pull; /* pull: of its spring, on its first end */
  double inverse;         /* of its length */
};

static struct near_bond near_bond(const struct fiber_kind *kind, int32_t from, int32_t to,
                                  struct point (*place)(const void *context, uint32_t vertex), const void *context)
{
  struct near_bond b = {from >= 0 && to >= 0, {0, 0, 0}, {0, 0, 0}, 0.0};
  if (!b.there)
    return b;
  const struct vec3 r = point_difference(place(context, (uint32_t)to), place(context, (uint32_t)from));
  const double length = sqrt(vec3_dot(r, r));
  b.inverse = length > 0.0 ? 1.0 / length : 0.0;
  b.unit = vec3_scale(b.inverse, r);
  b.pull = kind->bond_length == 0.0 ? vec3_scale(kind->spring, r) : vec3_scale(bond_tension(kind, length), b.unit);
  return b;
}

struct vec3 fiber_force_at(const struct model *model, uint32_t vertex,
                           struct point (*place)(const void *context, uint32_t vertex), const void *context)
{
  const struct fiber_kind *kind = &model->kind[model->fiber_kind_of[model->fiber_of[vertex]]];
  const int32_t prev = model->prev[vertex], next = model->next[vertex];
  const struct near_bond before = near_bond(kind, prev, (int32_t)vertex, place, context),
                         after = near_bond(kind, (int32_t)vertex, next, place, context);
  struct vec3 force = vec3_add(vec3_sub(kind->force, before.pull), after.pull);
  if (kind->bending == 0.0)
    return force;
  struct bend_force bend;
  if (before.there) {
    const struct near_bond far = near_bond(kind, model->prev[prev], prev, place, context);
    bend = bend_of_bonds(kind, far.unit, far.inverse, before.unit, before.inverse);
    force = far.there ? vec3_add(force, bend.after) : force;
  }
  if (before.there && after.there) {
    bend = bend_of_bonds(kind, before.unit, before.inverse, after.unit, after.inverse);
    force = vec3_sub(force, vec3_add(bend.before, bend.after));
  }
  if (after.there) {
    const struct near_bond far = near_bond(kind, next, model->next[next], place, context);
    bend = bend_of_bonds(kind, after.unit, after.inverse, far.unit, far.inverse);
    force = far.there ? vec3_add(force, bend.before) : force;
  }
  return force;
}

/* Components are in one row, x, y, z of each vertex. */
static void kick_row(double *restrict velocity, const double *restrict force, size_t n, double scale)
{
  for (size_t k = 0; k < n; k++)
    velocity[k] += scale * force[k];
}

/* Those of one fiber that are not held stand in a row. */
static void kick_between_held(struct state *state, const struct model *model, uint32_t fiber, const struct vec3 *force,
                              double dt)
{
  const struct fiber_kind *kind = &model->kind[model->fiber_kind_of[fiber]];
  const uint32_t first = model->fiber_first[fiber] + 1, free = kind->vertices - fiber_held(kind);
  if (free > 0)
    kick_row(&state->velocity[first].x, &force[first].x, 3 * (size_t)free, dt / kind->mass);
}

/* Padding 2009, Eq. (8). All vertices of a kind have one mass, and fibers of a kind are mostly next to each other. */
void fiber_kick(struct state *state, const struct model *model, const struct vec3 *force, double fraction)
{
  const double dt = fraction * model->time_step;
  for (uint32_t fiber = 0, end; fiber < model->fibers; fiber = end) {
    end = fiber + 1;
    if (model->kind[model->fiber_kind_of[fiber]].held != HELD_NONE) {
      kick_between_held(state, model, fiber, force, dt);
      continue;
    }
    while (end < model->fibers && model->fiber_kind_of[end] == model->fiber_kind_of[fiber])
      end++;
    const uint32_t first = model->fiber_first[fiber];
    kick_row(&state->velocity[first].x, &force[first].x, 3 * (size_t)(model->fiber_first[end] - first),
             dt * model->inverse_mass[first]);
  }
}

struct fiber_energy fiber_energies(const struct state *state, const struct model *model)
{
  struct fiber_energy e = {0.0, 0.0};
  for (uint32_t j = 0; j < state->vertices; j++) {
    if (model->next[j] < 0)
      continue;
    const struct fiber_kind *kind = &model->kind[model->fiber_kind_of[model->fiber_of[j]]];
    struct vec3 r = fiber_bond(state, model, j);
    e.bond += bond_energy(kind, vec3_norm(r));
    if (kind->bending != 0.0 && model->prev[j] >= 0) {
      struct vec3 before = fiber_bond(state, model, (uint32_t)model->prev[j]);
      double lengths = vec3_norm(before) * vec3_norm(r);
      e.bend += bend_energy(kind, lengths > 0.0 ? vec3_dot(before, r) / lengths : 0.0); /* as the forces have it */
    }
  }
  return e;
}

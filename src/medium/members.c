/* Members of pairs, sorted by cell: a counting sort, and the way back. */
#include <string.h>

#include "medium/medium.h"

/* Of a place in the box. */
static inline uint32_t cell_of(const struct box *box, struct point p)
{
  const uint32_t x = (uint32_t)(p.x >> LATTICE_BITS), y = (uint32_t)(p.y >> LATTICE_BITS),
                 z = (uint32_t)(p.z >> LATTICE_BITS);
  return (z * (uint32_t)box->cells[1] + y) * (uint32_t)box->cells[0] + x;
}

static inline struct point particle_at(const struct solvent *s, uint32_t i)
{
  return (struct point){s->x[i], s->y[i], s->z[i]};
}

static inline struct point vertex_at(const struct state *state, const struct box *box, uint32_t v)
{
  const struct point p = state->position[v];
  return (struct point){lattice_fold(p.x, box->edge[0]), lattice_fold(p.y, box->edge[1]),
                        lattice_fold(p.z, box->edge[2])};
}

/* The next place of a cell: first[cell] runs from the begin of the cell to that of the next. Returns it. */
static inline uint32_t put(struct medium *medium, uint32_t cell, struct point p, uint32_t number, struct mover mover)
{
  const uint32_t place = medium->first[cell]++;
  medium->x[place] = (double)p.x * LATTICE_UNIT;
  medium->y[place] = (double)p.y * LATTICE_UNIT;
  medium->z[place] = (double)p.z * LATTICE_UNIT;
  medium->number[place] = number;
  medium->mover[place] = mover;
  return place;
}

/* first[k] = members in cells before k; place[i] = cell of member i */
static void count(const struct state *state, const struct box *box, struct medium *medium)
{
  const struct solvent *s = &state->solvent;
  const uint32_t cells = (uint32_t)box_cell_count(box);
  memset(medium->first, 0, ((size_t)cells + 1) * sizeof *medium->first);
  for (uint32_t i = 0; i < s->n; i++)
    medium->first[medium->place[i] = cell_of(box, particle_at(s, i))]++;
  for (uint32_t v = 0; v < state->vertices; v++)
    medium->first[medium->place[s->n + v] = cell_of(box, vertex_at(state, box, v))]++;
  uint32_t sum = 0;
  for (uint32_t k = 0; k <= cells; k++) {
    const uint32_t here = medium->first[k];
    medium->first[k] = sum;
    sum += here;
  }
}

void members_gather(const struct state *state, const struct model *model, struct medium *medium)
{
  const struct solvent *s = &state->solvent;
  const struct box *box = &model->box;
  count(state, box, medium);
  for (uint32_t i = 0; i < s->n; i++)
    medium->place[i] =
        put(medium, medium->place[i], particle_at(s, i), s->id[i], (struct mover){solvent_velocity(s, i), 1.0});
  for (uint32_t v = 0; v < state->vertices; v++)
    medium->place[s->n + v] = put(medium, medium->place[s->n + v], vertex_at(state, box, v), s->n + v,
                                  (struct mover){state->velocity[v], model->mass[v]});
  memmove(&medium->first[1], medium->first, (size_t)box_cell_count(box) * sizeof *medium->first);
  medium->first[0] = 0;
}

void members_take_velocities(const struct state *state, struct medium *medium)
{
  const struct solvent *s = &state->solvent;
  for (uint32_t i = 0; i < s->n; i++)
    medium->mover[medium->place[i]].velocity = solvent_velocity(s, i);
  for (uint32_t v = 0; v < state->vertices; v++)
    medium->mover[medium->place[s->n + v]].velocity = state->velocity[v];
}

void members_scatter(struct state *state, const struct medium *medium)
{
  struct solvent *s = &state->solvent;
  uint32_t i = 0;
  for (uint32_t k = 0; k < medium->members; k++) {
    const struct vec3 v = medium->mover[k].velocity;
    if (medium->number[k] >= s->n) {
      state->velocity[medium->number[k] - s->n] = v;
      continue;
    }
    s->x[i] = lattice_from_a0(medium->x[k]);
    s->y[i] = lattice_from_a0(medium->y[k]);
    s->z[i] = lattice_from_a0(medium->z[k]);
    s->vx[i] = v.x;
    s->vy[i] = v.y;
    s->vz[i] = v.z;
    s->id[i++] = medium->number[k];
  }
}

#include "system/model.h"
#include "system/fiber_kind.h"
#include "system/topology.h"

#include <stdlib.h>
#include <string.h>

static bool allocate(struct model *m)
{
  size_t v = m->vertices ? m->vertices : 1, f = m->fibers ? m->fibers : 1;
  m->fiber_first = calloc(f + 1, sizeof *m->fiber_first);
  m->fiber_kind_of = calloc(f, sizeof *m->fiber_kind_of);
  m->fiber_of = calloc(v, sizeof *m->fiber_of);
  m->next = calloc(v, sizeof *m->next);
  m->prev = calloc(v, sizeof *m->prev);
  m->mass = calloc(v, sizeof *m->mass);
  m->inverse_mass = calloc(v, sizeof *m->inverse_mass);
  return m->fiber_first && m->fiber_kind_of && m->fiber_of && m->next && m->prev && m->mass && m->inverse_mass;
}

static void lay_fiber(struct model *m, uint32_t fiber, uint32_t first, uint32_t kind)
{
  const struct fiber_kind *k = &m->kind[kind];
  m->fiber_first[fiber] = first;
  m->fiber_kind_of[fiber] = kind;
  for (uint32_t i = 0; i < k->vertices; i++) {
    uint32_t v = first + i;
    bool last = i + 1 == k->vertices;
    m->fiber_of[v] = fiber;
    m->next[v] = !last ? (int32_t)v + 1 : k->ring ? (int32_t)first : -1;
    m->prev[v] = i > 0 ? (int32_t)v - 1 : k->ring ? (int32_t)(first + k->vertices - 1) : -1;
    m->mass[v] = k->mass;
    m->inverse_mass[v] = fiber_holds(k, i) ? 0.0 : 1.0 / k->mass;
  }
}

void model_count(struct model *m)
{
  m->fibers = m->vertices = m->bonds = m->held = 0;
  m->thickness = 0;
  m->total_mass = m->solvent.particles;
  m->max_mass = 1.0;
  for (uint32_t k = 0; k < m->kinds; k++) {
    const struct fiber_kind *kind = &m->kind[k];
    m->fibers += kind->count;
    m->vertices += kind->count * kind->vertices;
    m->held += kind->count * fiber_held(kind);
    m->bonds += kind->count * (kind->vertices - !kind->ring);
    m->total_mass += kind->mass * kind->vertices * kind->count;
    m->max_mass = kind->mass > m->max_mass ? kind->mass : m->max_mass;
    m->thickness = 2 * kind->radius > m->thickness ? 2 * kind->radius : m->thickness;
  }
}

bool model_lay(struct model *m)
{
  if (!allocate(m))
    return false;
  uint32_t fiber = 0, first = 0;
  for (uint32_t k = 0; k < m->kinds; k++)
    for (uint32_t n = 0; n < m->kind[k].count; n++, fiber++, first += m->kind[k].vertices)
      lay_fiber(m, fiber, first, k);
  m->fiber_first[fiber] = first;
  return true;
}

bool model_tube_is_blind(const struct model *m, uint32_t bond, uint32_t other)
{
  const uint32_t fiber = m->fiber_of[bond], between = bond > other ? bond - other : other - bond;
  const struct fiber_kind *k = &m->kind[m->fiber_kind_of[fiber]];
  return m->fiber_of[other] == fiber && (between < k->blind || (k->ring && k->vertices - between < k->blind));
}

uint32_t model_bonds_at(const struct model *model, uint32_t n, const uint32_t *vertex, uint32_t *bond)
{
  uint32_t count = 0;
  for (uint32_t k = 0; k < n; k++) {
    uint32_t both[2];
    const int its = model_bonds_of(model, vertex[k], both);
    for (int b = 0; b < its; b++) {
      uint32_t known = 0;
      while (known < count && bond[known] != both[b])
        known++;
      if (known == count)
        bond[count++] = both[b];
    }
  }
  return count;
}

void model_free(struct model *m)
{
  for (uint32_t k = 0; k < m->kinds; k++)
    free(m->kind[k].place);
  free(m->kind);
  free(m->fiber_first);
  free(m->fiber_kind_of);
  free(m->fiber_of);
  free(m->next);
  free(m->prev);
  free(m->mass);
  free(m->inverse_mass);
  free(m->wave.cosine);
  free(m->wave.slid);
  memset(m, 0, sizeof *m);
}

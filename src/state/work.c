#include "state/work.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "state/state.h"

/* One array of the work: where its pointer stands, and how many bytes this model needs of it. */
struct need {
  void **where;
  size_t count, size;
};

enum { NEEDS = 17 };

/* Bits of a hash table that is at most half full. */
static uint32_t table_bits(uint32_t entries)
{
  uint32_t bits = 1;
  while (((uint64_t)1 << bits) < 2 * (uint64_t)entries)
    bits++;
  return bits;
}

/* Entries of the cells' sums. */
static size_t count_cells(const struct model *m)
{
  return model_has_phantoms(m) ? m->vertices : model_has_solvent(m) ? (size_t)box_cell_count(&m->box) : 0;
}

/* The single place that says which scratch a model uses. */
static void list_needs(struct work *w, const struct model *m, struct need need[NEEDS])
{
  size_t cells = count_cells(m);
  size_t particles = m->solvent.particles;
  size_t colliding = model_collides(m) ? m->vertices : 0;
  size_t bathed = model_has_phantoms(m) ? m->vertices : 0;
  size_t thermostatted = m->solvent.thermostat != THERMOSTAT_NONE ? cells : 0;
  size_t swapped = m->solvent.hydrodynamics ? 0 : particles;
  size_t noncrossing = m->crossing.forbidden ? m->vertices : 0;
  struct collision_work *c = &w->collision;
  struct fiber_work *f = &w->fiber;
  const struct need all[NEEDS] = {
      {(void **)&c->sum, cells, sizeof *c->sum},
      {(void **)&c->turn, cells, sizeof *c->turn},
      {(void **)&c->relative, thermostatted, sizeof *c->relative},
      {(void **)&c->solvent_cell, particles, sizeof *c->solvent_cell},
      {(void **)&c->vertex_cell, colliding, sizeof *c->vertex_cell},
      {(void **)&c->occupied, bathed, sizeof *c->occupied},
      {(void **)&c->table, bathed ? (size_t)1 << table_bits(m->vertices) : 0, sizeof *c->table},
      {(void **)&c->order, particles, sizeof *c->order},
      {(void **)&c->slot, swapped, sizeof *c->slot},
      {(void **)&c->column, particles, sizeof *c->column},
      {(void **)&f->order, m->vertices, sizeof *f->order},
      {(void **)&f->rank, noncrossing, sizeof *f->rank},
      {(void **)&f->range, noncrossing, sizeof *f->range},
      {(void **)&f->queue, noncrossing, sizeof *f->queue},
      {(void **)&f->waits, noncrossing, sizeof *f->waits},
      {(void **)&f->meetings.first, noncrossing, sizeof *f->meetings.first},
      {(void **)&f->force, m->vertices, sizeof *f->force},
  };
  memcpy(need, all, sizeof all);
}

bool work_alloc(struct work *w, const struct model *m)
{
  memset(w, 0, sizeof *w);
  struct need need[NEEDS];
  list_needs(w, m, need);
  for (int k = 0; k < NEEDS; k++) {
    if (need[k].count == 0)
      continue;
    *need[k].where = memory_alloc(need[k].count, need[k].size);
    if (!*need[k].where) {
      work_free(w);
      return false;
    }
  }
  w->collision.cells = (uint32_t)count_cells(m);
  w->collision.table_bits = table_bits(m->vertices);
  return true;
}

static void free_neighbors(struct neighbors *nb)
{
  for (uint32_t c = 0; nb->entries && c < nb->cell_count; c++)
    if (nb->entries[c].room > NEIGHBORS_FIRST_ENTRIES)
      free(nb->entries[c].at);
  free(nb->entries);
  free(nb->anchor);
  free(nb->clock);
  free(nb->pairs.bond);
  free(nb->pairs.other);
  free(nb->pairs.limit);
  free(nb->pairs.generation);
  free(nb->pairs.image);
}

void work_free(struct work *w)
{
  struct need need[NEEDS];
  const struct model nothing = {0};
  list_needs(w, &nothing, need);
  for (int k = 0; k < NEEDS; k++)
    free(*need[k].where);
  free(w->fiber.meetings.at);
  free(w->fiber.near.at);
  free_neighbors(&w->fiber.neighbors);
  memset(w, 0, sizeof *w);
}

uint64_t work_bytes(const struct model *m)
{
  struct work w = {0};
  struct need need[NEEDS];
  list_needs(&w, m, need);
  uint64_t bytes = (uint64_t)m->solvent.particles * (6 * sizeof(double) + sizeof(uint32_t)) +
                   (uint64_t)m->vertices * (sizeof(struct point) + sizeof(struct vec3));
  for (int k = 0; k < NEEDS; k++)
    bytes += need[k].count * need[k].size;
  if (m->crossing.forbidden)
    bytes += (uint64_t)m->bonds * (sizeof(struct anchor) + sizeof(struct bond_clock) + sizeof(struct grid_row));
  return bytes;
}

bool work_fault(struct work *w, enum fault_code code, uint64_t step, int64_t entity, double value, double limit)
{
  if (w->fault.code == FAULT_NONE)
    w->fault = (struct fault){code, step, entity, value, limit};
  return false;
}

bool work_no_memory(struct work *w, uint64_t step)
{
  return work_fault(w, FAULT_NO_MEMORY, step, 0, 0.0, 0.0);
}

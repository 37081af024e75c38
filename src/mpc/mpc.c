#include "mpc/mpc.h"

#include <string.h>

#include "base/memory.h"
#include "mpc/border.h"
#include "mpc/rule.h"
#include "mpc/rules/spin.h"
#include "mpc/thermostat.h"

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
  const size_t cells = model_has_phantoms(m) ? m->vertices : (size_t)box_cell_count(&m->box);
  return model_has_cells(m) ? cells : 0;
}

enum { NEEDS = 18 };

/* The single list of the scratch that the collisions of a model use. */
static void list_needs(struct mpc *c, const struct model *m, bool everything, struct memory_need need[NEEDS])
{
  const size_t cells = count_cells(m), particles = model_in_cells(m) ? m->solvent.particles : 0;
  const size_t colliding = model_has_cells(m) ? m->vertices : 0, bathed = model_has_phantoms(m) ? m->vertices : 0;
  const size_t thermostatted = everything || m->solvent.thermostat != THERMOSTAT_NONE ? cells : 0;
  const size_t swapped = everything || !m->solvent.hydrodynamics ? particles : 0;
  const size_t cut = model_has_walls(m) ? 2 * (size_t)m->box.cells[0] * (size_t)m->box.cells[2] : 0;
  const bool drawing = everything || collision_rule_of(m)->thermal;
  const size_t spinning = everything || collision_rule_of(m)->spinning ? cells : 0;
  const struct memory_need all[NEEDS] = {
      {(void **)&c->sum, cells, sizeof *c->sum},
      {(void **)&c->turn, cells, sizeof *c->turn},
      {(void **)&c->relative, thermostatted, sizeof *c->relative},
      {(void **)&c->solvent_cell, particles, sizeof *c->solvent_cell},
      {(void **)&c->vertex_cell, colliding, sizeof *c->vertex_cell},
      {(void **)&c->occupied, bathed, sizeof *c->occupied},
      {(void **)&c->table, bathed ? (size_t)1 << table_bits(m->vertices) : 0, sizeof *c->table},
      {(void **)&c->filled, cut, sizeof *c->filled},
      {(void **)&c->order, particles, sizeof *c->order},
      {(void **)&c->slot, swapped, sizeof *c->slot},
      {(void **)&c->slot_ids, swapped, sizeof *c->slot_ids},
      {(void **)&c->column, particles, sizeof *c->column},
      {(void **)&c->drawn[0], drawing ? particles : 0, sizeof *c->drawn[0]},
      {(void **)&c->drawn[1], drawing ? particles : 0, sizeof *c->drawn[1]},
      {(void **)&c->drawn[2], drawing ? particles : 0, sizeof *c->drawn[2]},
      {(void **)&c->drawn_vertex, drawing ? colliding : 0, sizeof *c->drawn_vertex},
      {(void **)&c->spin, spinning, sizeof *c->spin},
      {(void **)&c->middle, spinning > 0 ? spinning + 1 : 0, sizeof *c->middle},
  };
  memcpy(need, all, sizeof all);
}

/* More cells than this do not fit the caches. Asking for their sums and turns ahead then saves 17 % of the time (points
 * in 100^3 cells). With points in 32^3 cells it would cost 0.9 ns of 7: neighbours in memory are in the same cells.
 * Dumbbells are sorted by their first particles, so the second ones are anywhere near: it saves them 20 % there. */
static bool cells_are_far(const struct model *m)
{
  return count_cells(m) > (model_has_dumbbells(m) ? 1 << 13 : 1 << 16);
}

bool mpc_alloc(struct mpc *c, const struct model *m, const struct fluid *fluid, bool everything)
{
  struct memory_need need[NEEDS];
  *c = (struct mpc){.rule = collision_rule_of(m),
                    .thermostat = thermostat_of(m->solvent.thermostat),
                    .fluid = fluid,
                    .border = border_of(m),
                    .kernel = kernel_plain,
                    .cells = (uint32_t)count_cells(m),
                    .prefetch = cells_are_far(m),
                    .table_bits = table_bits(m->vertices)};
  list_needs(c, m, everything, need);
  return memory_take(need, NEEDS);
}

void mpc_free(struct mpc *c)
{
  struct memory_need need[NEEDS];
  const struct model nothing = {0};
  list_needs(c, &nothing, false, need);
  memory_release(need, NEEDS);
  memset(c, 0, sizeof *c);
}

uint64_t mpc_bytes(const struct model *m)
{
  struct mpc c = {0};
  struct memory_need need[NEEDS];
  list_needs(&c, m, false, need);
  return memory_bytes(need, NEEDS);
}

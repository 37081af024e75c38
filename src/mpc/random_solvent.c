#include "mpc/random_solvent.h"

#include <string.h>

#include "mpc/border.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/rule.h"
#include "mpc/virtual.h"
#include "wall/motion.h"

/* The flow about which the phantoms of a cell are drawn; in a sheared box, that of the height of its middle. */
static struct vec3 flow_of(const struct model *model, uint64_t step, uint32_t cell)
{
  if (!model_is_sheared(model))
    return model->flow;
  const uint32_t row = cell / (uint32_t)model->box.rows[0] % (uint32_t)model->box.rows[1];
  const double shift = (double)grid_shift(model, step).y * LATTICE_UNIT,
               y = row + 0.5 - shift - 0.5 * model->box.cells[1],
               rate = shear_rate(model, step / model->solvent.interval_steps - 1);
  return vec3_add(model->flow, (struct vec3){rate * y, 0, 0});
}

enum { BLOCK = 64 }; /* cells worked on at a time */

/* The phantoms of up to BLOCK cells, those of each as one member. */
static void draw(const struct virtual_law *law, const struct model *model, uint64_t step, const uint32_t *cell,
                 uint32_t cells, struct virtual_members *members)
{
  uint32_t n[BLOCK];
  struct vec3 normal[BLOCK];
  virtual_numbers(law, model, step, cell, cells, n);
  virtual_normals(model, step, cell, cells, normal);
  for (uint32_t k = 0; k < cells; k++) {
    const struct vec3 flow = flow_of(model, step, cell[k]);
    members[k] = (struct virtual_members){
        .n = n[k], .velocity = n[k] > 0 ? virtual_velocity(normal[k], n[k], flow) : flow, .flow = flow, .high = 1.0};
  }
}

struct phantoms random_solvent_phantoms(const struct model *model, uint64_t step, uint32_t cell)
{
  struct virtual_law law;
  struct virtual_members all;
  virtual_law_of(model->solvent.per_cell, &law);
  draw(&law, model, step, &cell, 1, &all);
  return (struct phantoms){all.n, all.velocity};
}

/* The place of this cell in the list of occupied ones; it is appended if it is not there yet. The hash is Fibonacci's
 * (Knuth, TAOCP 3, Sec. 6.4), collisions go to the next slot. */
static uint32_t place_of_cell(struct mpc *c, uint32_t cell)
{
  const uint32_t mask = (uint32_t)(((uint64_t)1 << c->table_bits) - 1);
  uint32_t slot = (uint32_t)((uint64_t)(cell * 2654435769u) >> (32 - c->table_bits));
  while (c->table[slot] != 0 && c->occupied[c->table[slot] - 1] != cell)
    slot = (slot + 1) & mask;
  if (c->table[slot] == 0) {
    c->occupied[c->cells] = cell;
    c->table[slot] = ++c->cells;
  }
  return c->table[slot] - 1;
}

void random_solvent_bin(const struct state *state, const struct model *model, struct point shift, struct mpc *c)
{
  memset(c->table, 0, ((size_t)1 << c->table_bits) * sizeof *c->table);
  c->cells = 0;
  for (uint32_t v = 0; v < state->vertices; v++)
    c->vertex_cell[v] = place_of_cell(c, grid_cell_of(&model->box, state->position[v], shift));
}

/* The first vertex whose cell has this place. */
static int64_t vertex_in(const struct mpc *c, uint32_t place)
{
  int64_t v = 0;
  while (c->vertex_cell[v] != place)
    v++;
  return v;
}

/* Adds the phantoms of each cell to its vertices, as one member. */
static bool add_phantoms(const struct model *model, struct mpc *c, uint64_t step, struct fault *fault)
{
  struct virtual_law law;
  struct virtual_members members[BLOCK];
  virtual_law_of(model->solvent.per_cell, &law);
  for (uint32_t k = 0; k < c->cells; k++) {
    const struct virtual_members *v = &members[k % BLOCK];
    if (k % BLOCK == 0)
      draw(&law, model, step, &c->occupied[k], c->cells - k < BLOCK ? c->cells - k : BLOCK, members);
    if (!virtual_room(&c->sum[k], v->n, step, c->occupied[k], FAULT_VERTEX_SPEED, fault)) {
      if (fault->code == FAULT_VERTEX_SPEED)
        fault->entity = vertex_in(c, k);
      return false;
    }
    if (v->n > 0.0)
      c->rule->add_virtual(model, c, step, k, v);
  }
  return true;
}

bool random_solvent_collide(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                            struct fault *fault)
{
  const struct border *border = mpc->border;
  mpc->shift = grid_shift(model, step);
  mpc->entered = 0;
  if (border->enter_vertices)
    border->enter_vertices(state, model, mpc);
  random_solvent_bin(state, model, mpc->shift, mpc);
  if (!collide_sum(state, model, mpc, step, fault) || !add_phantoms(model, mpc, step, fault))
    return false;
  collide_solve(model, mpc, step);
  collide_turn(state, model, mpc, false);
  if (border->leave)
    border->leave(state, model, mpc);
  return true;
}

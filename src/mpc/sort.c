/* Exchange of velocities (physics: hydrodynamics off), and of places in memory (speed only). */
#include "mpc/sort.h"

#include <string.h>

#include "base/random.h"
#include "mpc/grid.h"

/* column[k] <- column[from[k]] for all k; elements of 8 bytes. */
static void permute(void *column, const uint32_t *from, uint32_t n, int64_t *scratch)
{
  memcpy(scratch, column, (size_t)n * sizeof *scratch);
  for (uint32_t k = 0; k < n; k++)
    memcpy((char *)column + (size_t)k * sizeof *scratch, &scratch[from[k]], sizeof *scratch);
}

void mpc_swap_velocities(struct state *state, const struct model *model, struct mpc *c, uint64_t step)
{
  struct solvent *s = &state->solvent;
  random_permutation(model->seed, RANDOM_VELOCITY_SWAP, 0, step, s->n, c->order);
  state_solvent_slots(state, c->slot);
  uint32_t *from = (uint32_t *)c->solvent_cell; /* not needed any more in this collision */
  for (uint32_t i = 0; i < s->n; i++)
    from[i] = c->slot[c->order[s->id[i]]];
  permute(s->vx, from, s->n, c->column);
  permute(s->vy, from, s->n, c->column);
  permute(s->vz, from, s->n, c->column);
}

void mpc_sort(struct state *state, const struct model *model, struct mpc *c)
{
  struct solvent *s = &state->solvent;
  const struct point unshifted = {0, 0, 0};
  const int64_t cells = box_cell_count(&model->box);
  /* Counting sort; the cell sums are free to hold the counts. */
  memset(c->sum, 0, (size_t)cells * sizeof *c->sum);
  for (uint32_t i = 0; i < s->n; i++) {
    c->solvent_cell[i] = grid_cell_of(&model->box, (struct point){s->x[i], s->y[i], s->z[i]}, unshifted);
    c->sum[c->solvent_cell[i]].load++;
  }
  uint64_t start = 0;
  for (int64_t k = 0; k < cells; k++) {
    uint64_t here = c->sum[k].load;
    c->sum[k].load = start;
    start += here;
  }
  for (uint32_t i = 0; i < s->n; i++)
    c->order[c->sum[c->solvent_cell[i]].load++] = i;

  permute(s->x, c->order, s->n, c->column);
  permute(s->y, c->order, s->n, c->column);
  permute(s->z, c->order, s->n, c->column);
  permute(s->vx, c->order, s->n, c->column);
  permute(s->vy, c->order, s->n, c->column);
  permute(s->vz, c->order, s->n, c->column);
  memcpy(c->column, s->id, (size_t)s->n * sizeof *s->id);
  for (uint32_t k = 0; k < s->n; k++)
    s->id[k] = ((const uint32_t *)c->column)[c->order[k]];
}

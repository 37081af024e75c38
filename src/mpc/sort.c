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

/* Makes mpc->slot of this memory, if ids have moved in it since the last time. They do so only where particles are
 * sorted by cell. Both lists begin as zeros, which is right for a single particle. */
static void find_slots(const struct state *state, struct mpc *c)
{
  const struct solvent *s = &state->solvent;
  if (memcmp(c->slot_ids, s->id, (size_t)s->n * sizeof *s->id) == 0)
    return;
  memcpy(c->slot_ids, s->id, (size_t)s->n * sizeof *s->id);
  state_solvent_slots(state, c->slot);
}

/* What is shuffled are places in memory, in the order of ids: one look-up finds whose velocity a particle takes. */
void mpc_swap_velocities(struct state *state, const struct model *model, struct mpc *c, uint64_t step)
{
  struct solvent *s = &state->solvent;
  find_slots(state, c);
  memcpy(c->order, c->slot, (size_t)s->n * sizeof *c->order);
  random_shuffle(model->seed, RANDOM_VELOCITY_SWAP, 0, step, s->n, c->order);
  uint32_t *from = (uint32_t *)c->solvent_cell; /* not needed any more in this collision */
  for (uint32_t i = 0; i < s->n; i++)
    from[i] = c->order[s->id[i]];
  permute(s->vx, from, s->n, c->column);
  permute(s->vy, from, s->n, c->column);
  permute(s->vz, from, s->n, c->column);
}

/* Orders the particles first to end - 1 by cell; `together` of them, from the first on, go with their first one.
 * Counting sort; the cell sums are free to hold the counts. */
static void order_range(const struct state *state, const struct model *model, struct mpc *c, uint32_t first,
                        uint32_t end, uint32_t together)
{
  const int64_t cells = box_cell_count(&model->box);
  const struct point shift = c->shift;
  memset(c->sum, 0, (size_t)cells * sizeof *c->sum);
  c->sum_is_clear = false;
  c->shift = (struct point){0, 0, 0};
  grid_bin_particles(state, model, first, end - first, c);
  c->shift = shift;
  for (uint32_t i = first; i < end; i += together)
    c->sum[c->solvent_cell[i]].load += together;
  uint64_t start = first;
  for (int64_t k = 0; k < cells; k++) {
    uint64_t here = c->sum[k].load;
    c->sum[k].load = start;
    start += here;
  }
  for (uint32_t i = first; i < end; i += together)
    for (uint32_t k = 0; k < together; k++)
      c->order[c->sum[c->solvent_cell[i]].load++] = i + k;
}

static void permute_ids(uint32_t *id, const uint32_t *order, uint32_t n, int64_t *scratch)
{
  memcpy(scratch, id, (size_t)n * sizeof *id);
  for (uint32_t k = 0; k < n; k++)
    id[k] = ((const uint32_t *)scratch)[order[k]];
}

void mpc_sort(struct state *state, const struct model *model, struct mpc *c)
{
  struct solvent *s = &state->solvent;
  struct dumbbells *d = &state->dumbbells;
  order_range(state, model, c, 0, 2 * d->n, 2);
  order_range(state, model, c, 2 * d->n, s->n, 1);
  permute(s->x, c->order, s->n, c->column);
  permute(s->y, c->order, s->n, c->column);
  permute(s->z, c->order, s->n, c->column);
  permute(s->vx, c->order, s->n, c->column);
  permute(s->vy, c->order, s->n, c->column);
  permute(s->vz, c->order, s->n, c->column);
  permute_ids(s->id, c->order, s->n, c->column);
  if (d->n == 0)
    return;
  for (uint32_t p = 0; p < d->n; p++)
    c->order[p] = c->order[2 * p] / 2;
  permute(d->x, c->order, d->n, c->column);
  permute(d->y, c->order, d->n, c->column);
  permute(d->z, c->order, d->n, c->column);
  permute_ids(d->id, c->order, d->n, c->column);
}

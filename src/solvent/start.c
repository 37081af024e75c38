#include "base/random.h"
#include "solvent/solvent.h"

/* A uniform lattice coordinate along an edge of so many cells, from 64 random bits. */
static int64_t uniform_coordinate(uint64_t r, int cells)
{
  int64_t within = (int64_t)(r & (uint64_t)(LATTICE_CELL - 1));
  return (int64_t)(((r >> LATTICE_BITS) * (uint64_t)cells) >> (64 - LATTICE_BITS)) * LATTICE_CELL + within;
}

void solvent_start(struct state *state, const struct model *model)
{
  struct solvent *s = &state->solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    uint32_t id = s->id[i];
    struct random_words xy = random_at(model->seed, RANDOM_SOLVENT_POSITION, 0, 0, id);
    struct random_words z = random_at(model->seed, RANDOM_SOLVENT_POSITION, 1, 0, id);
    s->x[i] = uniform_coordinate(random_u64(xy, 0), model->box.cells[0]);
    s->y[i] = uniform_coordinate(random_u64(xy, 1), model->box.cells[1]);
    s->z[i] = uniform_coordinate(random_u64(z, 0), model->box.cells[2]);
    double a[2], b[2];
    random_normal_pair(random_at(model->seed, RANDOM_SOLVENT_VELOCITY, 0, 0, id), a);
    random_normal_pair(random_at(model->seed, RANDOM_SOLVENT_VELOCITY, 1, 0, id), b);
    s->vx[i] = a[0];
    s->vy[i] = a[1];
    s->vz[i] = b[0];
  }
}

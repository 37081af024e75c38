#include "mpc/grid.h"

#include "base/random.h"
#include "mpc/border.h"

struct point grid_shift(const struct model *model, uint64_t step)
{
  struct random_words r = random_at(model->seed, RANDOM_GRID_SHIFT, 0, step, 0);
  const int bits = LATTICE_BITS - 32;
  return (struct point){(int64_t)r.w[0] << bits, (int64_t)r.w[1] << bits, (int64_t)r.w[2] << bits};
}

/* Index along one edge of a coordinate in [0, edge], shift in [0, one cell). */
static inline uint32_t cell_index(int64_t x, int64_t shift, uint32_t cells)
{
  uint32_t c = (uint32_t)((uint64_t)(x + shift) >> LATTICE_BITS);
  return c - (c >= cells ? cells : 0);
}

uint32_t grid_cell_of(const struct box *box, struct point p, struct point shift)
{
  uint32_t lx = (uint32_t)box->rows[0], ly = (uint32_t)box->rows[1], lz = (uint32_t)box->rows[2];
  const bool walls = box->boundary[1] == BOUNDARY_WALL; /* rows are not folded: the last one begins below the wall */
  uint32_t x = cell_index(lattice_fold(p.x, box->edge[0]), shift.x, lx);
  uint32_t y = cell_index(walls ? p.y : lattice_fold(p.y, box->edge[1]), shift.y, ly);
  uint32_t z = cell_index(lattice_fold(p.z, box->edge[2]), shift.z, lz);
  return (z * ly + y) * lx + x;
}

void grid_bin_particles(const struct state *state, const struct model *model, uint32_t first, uint32_t n,
                        struct mpc *mpc)
{
  const struct solvent *s = &state->solvent;
  const struct box *box = &model->box;
  const uint32_t lx = (uint32_t)box->rows[0], ly = (uint32_t)box->rows[1], lz = (uint32_t)box->rows[2];
  const int64_t *restrict x = &s->x[first], *restrict y = &s->y[first], *restrict z = &s->z[first];
  uint32_t *restrict cell = &mpc->solvent_cell[first];
  const struct point shift = mpc->shift;
  for (uint32_t i = 0; i < n; i++)
    cell[i] = (cell_index(z[i], shift.z, lz) * ly + cell_index(y[i], shift.y, ly)) * lx + cell_index(x[i], shift.x, lx);
}

/* The same for an unwrapped coordinate along a periodic axis: the remainder of the row that it is in, counted from the
 * origin. The quotient may be one too small or too large, since it is cut towards zero and the product rounds; so a box
 * is added, or taken away. Rows have 24 bits. Without a branch or a division, so that a loop vectorises. */
static inline uint32_t row_of(int64_t x, int64_t shift, int32_t cells, double inverse)
{
  const int32_t row = (int32_t)((int64_t)((uint64_t)x + (uint64_t)shift) >> LATTICE_BITS);
  int32_t place = row - (int32_t)(row * inverse) * cells;
  place += place < 0 ? cells : 0;
  place -= place >= cells ? cells : 0;
  return (uint32_t)place;
}

static void bin_periodic(const struct point *restrict p, uint32_t n, const struct box *box, struct point shift,
                         uint32_t *restrict cell)
{
  const int32_t lx = (int32_t)box->rows[0], ly = (int32_t)box->rows[1], lz = (int32_t)box->rows[2];
  const double x = 1.0 / lx, y = 1.0 / ly, z = 1.0 / lz;
  for (uint32_t v = 0; v < n; v++)
    cell[v] = (row_of(p[v].z, shift.z, lz, z) * (uint32_t)ly + row_of(p[v].y, shift.y, ly, y)) * (uint32_t)lx +
              row_of(p[v].x, shift.x, lx, x);
}

void grid_bin_vertices(const struct state *state, const struct model *model, struct mpc *mpc)
{
  if (model->box.boundary[1] != BOUNDARY_WALL)
    bin_periodic(state->position, state->vertices, &model->box, mpc->shift, mpc->vertex_cell);
  else
    for (uint32_t v = 0; v < state->vertices; v++)
      mpc->vertex_cell[v] = grid_cell_of(&model->box, state->position[v], mpc->shift);
}

void grid_bin(const struct state *state, const struct model *model, struct point shift, struct mpc *mpc)
{
  mpc->shift = shift;
  mpc->border->bin_particles(state, model, 0, state->solvent.n, mpc);
  mpc->border->bin_vertices(state, model, mpc);
}

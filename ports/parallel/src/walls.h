// Cells that walls cut, what fills them, and the thermostat of layers. docs/port/flow.md, "Cut cells", "The account".
#pragma once

#include "bodies.h"

constexpr double largest_mean = 256.0; // of one draw of a phantom number

// Rows 0 and `rows` - 1 of the grid; its cells are numbered by wall, then z, then x.
struct CutCells {
  int64_t nx, rows, nz;
  BODY int64_t count() const
  {
    return 2 * nx * nz;
  }
  BODY int64_t cell(int64_t k) const
  {
    const int64_t upper = k / (nx * nz), zx = k % (nx * nz);
    return (zx / nx * rows + upper * (rows - 1)) * nx + zx % nx;
  }
  // -1: no wall cuts the cell.
  BODY int64_t number_of(int64_t cell) const
  {
    const int64_t zy = cell / nx, y = zy % rows;
    return y == 0 || y == rows - 1 ? ((y > 0) * nz + zy / rows) * nx + cell % nx : -1;
  }
};

// One wall: planar filling draws `parts` numbers of this mean, the first term of whose sum is `none`.
struct Filling {
  Vector velocity;
  int parts;
  double mean, none;
};

ANYWHERE double poisson(double mean, double none, double uniform)
{
  double term = none, sum = term, n = 0;
  while (uniform >= sum && (n < mean || sum + term > sum)) {
    n += 1;
    term *= mean / n;
    sum += term;
  }
  return n;
}

struct FillCell {
  CutCells cut;
  CellSum *sums;
  int shards;
  int64_t cell_count;
  Virtual *filled;
  int fill; // NO_FILL where walls slip
  double per_cell;
  Filling wall[2];
  Source number, velocity;

  BODY void operator()(int64_t k, int) const
  {
    const int64_t cell = cut.cell(k);
    const Filling &its = wall[k >= cut.nx * cut.nz];
    double n = 0;
    if (fill == PLANAR)
      n = planar(its, (uint32_t)cell);
    else if (fill == PAPER_FILL)
      n = missing(cell);
    filled[k] = {0, {0, 0, 0}};
    if (n == 0)
      return;
    const CirclePoint xy = normal_pair(words_of(velocity, 0, (uint32_t)cell)),
                      z = normal_pair(words_of(velocity, 1, (uint32_t)cell));
    const Vector v = its.velocity + (1.0 / std::sqrt(n)) * Vector{xy.cosine, xy.sine, z.cosine};
    filled[k] = {n, v};
    const Point p = nearest((n * momentum_per_unit) * v);
    CellSum &to = sums[cell];
    to.x += p.x, to.y += p.y, to.z += p.z;
    to.load += ((int64_t)1 << load_bits) + (int64_t)(n * mass_per_unit);
  }

private:
  BODY double planar(const Filling &its, uint32_t cell) const
  {
    double n = 0;
    for (int part = 0; part < its.parts; part++)
      n += poisson(its.mean, its.none, uniform_of(words_of(number, (uint32_t)part / 2, cell), part % 2));
    return n;
  }
  BODY double missing(int64_t cell) const
  {
    int64_t members = 0;
    for (int k = 0; k < shards; k++)
      members += sums[k * cell_count + cell].load >> load_bits;
    const double n = per_cell - (double)members;
    return n > 0 ? (double)nearest(n * mass_per_unit) * (1.0 / mass_per_unit) : 0.0;
  }
};

// What virtual particles give to the others in a collision.
struct AccountCell {
  CutCells cut;
  const Virtual *filled;
  const CellTurn *turn;
  double cosine, sine;
  int64_t *given;
  BODY void operator()(int64_t k, int shard) const
  {
    const Virtual old = filled[k];
    const CellTurn &cell = turn[cut.cell(k)];
    if (old.number == 0 || !cell.active)
      return;
    const Vector v = after_turn(cell, cosine, sine, old.velocity);
    const Point whole = nearest(momentum_per_unit * -(old.number * (v - old.velocity)));
    int64_t *const to = given + shard * account_stride + 6 + 3 * (k >= cut.nx * cut.nz);
    add_whole(to, whole.x), add_whole(to + 1, whole.y), add_whole(to + 2, whole.z);
  }
};

// The thermostat of layers: a factor for each row of cells along y. Relative energies of a row are below 2^31 kT.
struct LayerFactor {
  CutCells cut;
  const Virtual *filled; // null: no walls
  CellTurn *turn;
  Relative from;
  int shards;
  BODY void operator()(int64_t y, int) const
  {
    double wanted = 0;
    int64_t found = 0;
    for (int64_t z = 0; z < cut.nz; z++)
      for (int64_t x = 0; x < cut.nx; x++) {
        const int64_t cell = (z * cut.rows + y) * cut.nx + x, members = turn[cell].active;
        const int64_t energy = take_relative(from, shards, cell);
        if (!members)
          continue;
        found += energy;
        wanted += 3.0 * freedoms(cell, members);
      }
    const double factor = found > 0 ? std::sqrt(wanted / ((double)found * (1.0 / energy_per_unit))) : 1.0;
    for (int64_t z = 0; z < cut.nz; z++)
      for (int64_t x = 0; x < cut.nx; x++)
        turn[(z * cut.rows + y) * cut.nx + x].factor = factor;
  }

private:
  // Members between walls are particles of mass 1, and all virtual ones together.
  BODY double freedoms(int64_t cell, int64_t members) const
  {
    const int64_t k = filled ? cut.number_of(cell) : -1;
    const double free = (double)members - 1.0, n = k >= 0 ? filled[k].number : 0.0;
    return n > 0 ? free - free / (free + n) : free;
  }
};

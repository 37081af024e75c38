// Bodies of the loops over particles, vertices and cells: docs/port/contract.md, "The operators".
#pragma once

#include "borders.h"
#include "solvent.h"

struct Sums {
  CellSum *at;
  int64_t cell_count;
  int transposed;
};

struct Relative {
  int64_t *at;
  int64_t cell_count;
};

ANYWHERE int64_t cell_of(const Grid &grid, Point p)
{
  const int64_t x = fold(p.x + grid.shift.x, grid.edge.x) >> 40, y = fold(p.y + grid.shift.y, grid.edge.y) >> 40,
                z = fold(p.z + grid.shift.z, grid.edge.z) >> 40;
  return (z * grid.cells[1] + y) * grid.cells[0] + x;
}

ANYWHERE Point place_of(const Columns &c, int64_t i)
{
  return {c.x[i], c.y[i], c.z[i]};
}
ANYWHERE Vector velocity_of(const Columns &c, int64_t i)
{
  return {c.vx[i], c.vy[i], c.vz[i]};
}
ANYWHERE void set_velocity(const Columns &c, int64_t i, Vector v)
{
  c.vx[i] = v.x, c.vy[i] = v.y, c.vz[i] = v.z;
}

BODY inline void add_member(const Sums &sums, int shard, int64_t cell, double mass, Vector v)
{
  const Point p = nearest((mass * momentum_per_unit) * v);
  const int64_t load = ((int64_t)1 << load_bits) + (int64_t)(mass * mass_per_unit);
#ifdef __CUDA_ARCH__
  if (sums.transposed && __activemask() == 0xffffffffu) {
    const int lane = threadIdx.x & 31, component = lane & 3;
    for (int k = 0; k < 4; k++) {
      const int from = (lane & ~3) + k;
      const long long x = __shfl_sync(0xffffffffu, (long long)p.x, from);
      const long long y = __shfl_sync(0xffffffffu, (long long)p.y, from);
      const long long z = __shfl_sync(0xffffffffu, (long long)p.z, from);
      const long long m = __shfl_sync(0xffffffffu, (long long)load, from);
      const long long its = __shfl_sync(0xffffffffu, (long long)cell, from);
      add_whole(&sums.at[its].x + component, component == 0 ? x : component == 1 ? y : component == 2 ? z : m);
    }
    return;
  }
#endif
  CellSum *to = sums.at + shard * sums.cell_count + cell;
  add_whole(&to->x, p.x), add_whole(&to->y, p.y), add_whole(&to->z, p.z), add_whole(&to->load, load);
}

// R w
ANYWHERE Vector turned(double cosine, double sine, Vector n, Vector w)
{
  if (cosine == 0.0)
    return dot(n, w) * n + cross(n, w);
  return (cosine * w + ((1.0 - cosine) * dot(n, w)) * n) + sine * cross(n, w);
}

ANYWHERE Vector after_turn(const CellTurn &cell, double cosine, double sine, Vector v)
{
  return cell.active ? cell.center + cell.factor * turned(cosine, sine, cell.axis, v - cell.center) : v;
}

BODY inline void set_place(const Columns &c, int64_t i, Point p)
{
  c.x[i] = p.x, c.y[i] = p.y, c.z[i] = p.z;
}

template <class Border> struct Fly {
  Columns c;
  Flight flight;
  Border border;
  BODY void operator()(int64_t i, int shard) const
  {
    Point p = place_of(c, i);
    Vector v = velocity_of(c, i);
    border.fly(flight, p, v, shard), border.enter(p, v);
    set_place(c, i, p), set_velocity(c, i, v);
  }
};

template <class Border> struct FlySum {
  Columns c;
  Flight flight;
  Border border;
  Grid grid;
  Sums sums;
  BODY void operator()(int64_t i, int shard) const
  {
    Point p = place_of(c, i);
    Vector v = velocity_of(c, i);
    border.fly(flight, p, v, shard), border.enter(p, v);
    set_place(c, i, p), set_velocity(c, i, v);
    add_member(sums, shard, cell_of(grid, p), 1.0, v);
  }
};

template <class Border> struct TurnSolvent {
  Columns c;
  Grid grid;
  const CellTurn *turn;
  double cosine, sine;
  Border border;
  BODY void operator()(int64_t i, int) const
  {
    Point p = place_of(c, i);
    Vector v = after_turn(turn[cell_of(grid, p)], cosine, sine, velocity_of(c, i));
    border.leave(p, v);
    set_place(c, i, p), set_velocity(c, i, v);
  }
};

// What is left of a collision, and the flight to the next one.
template <class Border, bool right_angle> struct TurnFlySum {
  Columns c;
  Grid grid;
  const CellTurn *turn;
  double cosine, sine;
  Flight flight;
  Border border;
  Grid next;
  Sums sums;
  BODY void operator()(int64_t i, int shard) const
  {
    Point p = place_of(c, i);
    Vector v = after_turn(turn[cell_of(grid, p)], right_angle ? 0.0 : cosine, sine, velocity_of(c, i));
    border.leave(p, v), border.fly(flight, p, v, shard), border.enter(p, v);
    set_place(c, i, p), set_velocity(c, i, v);
    add_member(sums, shard, cell_of(next, p), 1.0, v);
  }
};

struct SumVertex {
  const Point *p;
  const Vector *v;
  const double *mass;
  Grid grid;
  Sums sums;
  BODY void operator()(int64_t i, int shard) const
  {
    add_member(sums, shard, cell_of(grid, p[i]), mass[i], v[i]);
  }
};

struct TurnVertex {
  const Point *p;
  Vector *v;
  Grid grid;
  const CellTurn *turn;
  double cosine, sine;
  BODY void operator()(int64_t i, int) const
  {
    v[i] = after_turn(turn[cell_of(grid, p[i])], cosine, sine, v[i]);
  }
};

// Sums become center and axis, and are cleared. `active` is the number of members.
struct SolveCell {
  CellSum *sums;
  int shards;
  int64_t cell_count;
  CellTurn *turn;
  Source axes;
  BODY void operator()(int64_t cell, int) const
  {
    CellSum s = {0, 0, 0, 0};
    for (int k = 0; k < shards; k++) {
      CellSum *part = sums + k * cell_count + cell;
      s.x += part->x, s.y += part->y, s.z += part->z, s.load += part->load;
      if (part->load != 0)
        *part = {0, 0, 0, 0};
    }
    const int64_t members = s.load >> load_bits, mass = s.load - (members << load_bits);
    if (members < 2) {
      turn[cell].active = 0;
      return;
    }
    const double each = (1.0 / momentum_per_unit) / ((double)mass * (1.0 / mass_per_unit));
    turn[cell] = {each * as_vector(Point{s.x, s.y, s.z}), axis_of(axes, (uint32_t)cell), 1.0, members};
  }
};

ANYWHERE int64_t relative_energy(const CellTurn &cell, double mass, Vector v)
{
  const Vector w = v - cell.center;
  return nearest((energy_per_unit * mass) * dot(w, w));
}

struct RelativeSolvent {
  Columns c;
  Grid grid;
  const CellTurn *turn;
  Relative to;
  BODY void operator()(int64_t i, int shard) const
  {
    const int64_t cell = cell_of(grid, place_of(c, i));
    if (turn[cell].active)
      add_whole(to.at + shard * to.cell_count + cell, relative_energy(turn[cell], 1.0, velocity_of(c, i)));
  }
};

struct RelativeVertex {
  const Point *p;
  const Vector *v;
  const double *mass;
  Grid grid;
  const CellTurn *turn;
  Relative to;
  BODY void operator()(int64_t i, int shard) const
  {
    const int64_t cell = cell_of(grid, p[i]);
    if (turn[cell].active)
      add_whole(to.at + shard * to.cell_count + cell, relative_energy(turn[cell], mass[i], v[i]));
  }
};

// The relative energy of a cell, which is cleared.
BODY inline int64_t take_relative(const Relative &from, int shards, int64_t cell)
{
  int64_t sum = 0;
  for (int k = 0; k < shards; k++) {
    sum += from.at[k * from.cell_count + cell];
    from.at[k * from.cell_count + cell] = 0;
  }
  return sum;
}

struct TotalRelative {
  const CellTurn *turn;
  Relative from;
  int shards;
  int64_t *total; // of each shard: members - 1, relative / 2^32, relative mod 2^32
  BODY void operator()(int64_t cell, int shard) const
  {
    const int64_t sum = take_relative(from, shards, cell), members = turn[cell].active; // 0 and 0: not active
    int64_t *const to = total + 3 * total_shard(shard);
    add_together(to, members > 0 ? members - 1 : 0);
    add_together(to + 1, sum >> 32);
    add_together(to + 2, sum & 0xffffffff);
  }
};

struct SetFactor {
  CellTurn *turn;
  double factor;
  BODY void operator()(int64_t cell, int) const
  {
    turn[cell].factor = factor;
  }
};

// A Gamma deviate (Marsaglia and Tsang).
ANYWHERE double gamma_deviate(const Source &source, uint32_t cell, double shape)
{
  const double d = shape - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
  for (uint32_t k = 0;; k++) {
    const double x = normal_pair(words_of(source, 2 * k, cell)).cosine;
    const double w = uniform_of(words_of(source, 2 * k + 1, cell), 0);
    const double root = 1.0 + c * x, v = root * root * root;
    if (v > 0.0 && natural_log(w) < 0.5 * x * x + d - d * v + d * natural_log(v))
      return d * v;
  }
}

struct DrawFactor {
  CellTurn *turn;
  Relative from;
  int shards;
  Source source;
  BODY void operator()(int64_t cell, int) const
  {
    const int64_t sum = take_relative(from, shards, cell);
    const int64_t members = turn[cell].active;
    if (members < 2 || sum <= 0)
      return;
    const double energy = 0.5 * ((double)sum * (1.0 / energy_per_unit));
    turn[cell].factor = std::sqrt(gamma_deviate(source, (uint32_t)cell, 1.5 * (double)(members - 1)) / energy);
  }
};

// Of the rule at-a: the drawn velocity of a particle, of a vertex.
ANYWHERE Vector drawn(const Source &source, uint32_t id)
{
  return three_normals(words_of(source, 0, id));
}

ANYWHERE Vector drawn(const Source &source, uint32_t vertex, double mass)
{
  return (1.0 / std::sqrt(mass)) * three_normals(words_of(source, 0, vertex));
}

struct DrawSum {
  Columns c;
  Grid grid;
  Sums sums;
  Source source;
  BODY void operator()(int64_t i, int shard) const
  {
    add_member(sums, shard, cell_of(grid, place_of(c, i)), 1.0, velocity_of(c, i) - drawn(source, c.id[i]));
  }
};

struct DrawSumVertex {
  const Point *p;
  const Vector *v;
  const double *mass;
  Grid grid;
  Sums sums;
  Source source;
  BODY void operator()(int64_t i, int shard) const
  {
    add_member(sums, shard, cell_of(grid, p[i]), mass[i], v[i] - drawn(source, (uint32_t)i, mass[i]));
  }
};

template <class Border> struct GiveSolvent {
  Columns c;
  Grid grid;
  const CellTurn *turn;
  Source source;
  Border border;
  BODY void operator()(int64_t i, int) const
  {
    Point p = place_of(c, i);
    Vector v = velocity_of(c, i);
    const CellTurn &cell = turn[cell_of(grid, p)];
    if (cell.active)
      v = cell.center + drawn(source, c.id[i]);
    border.leave(p, v);
    set_place(c, i, p), set_velocity(c, i, v);
  }
};

struct GiveVertex {
  const Point *p;
  Vector *v;
  const double *mass;
  Grid grid;
  const CellTurn *turn;
  Source source;
  BODY void operator()(int64_t i, int) const
  {
    const CellTurn &cell = turn[cell_of(grid, p[i])];
    if (cell.active)
      v[i] = cell.center + drawn(source, (uint32_t)i, mass[i]);
  }
};

// Sorting by cells: members are counted, each row of cells takes a piece of memory, particles go to their cell's part.
struct CountMembers {
  Columns c;
  Grid grid;
  int64_t *count;
  BODY void operator()(int64_t i, int) const
  {
    fetch_add_whole(count + cell_of(grid, place_of(c, i)), 1);
  }
};

struct PlaceRows {
  int64_t *count, *used;
  int64_t cells;
  BODY void operator()(int64_t row, int) const
  {
    int64_t *const mine = count + row * cells;
    int64_t members = 0;
    for (int64_t k = 0; k < cells; k++)
      members += mine[k];
    int64_t first = fetch_add_whole(used, members);
    for (int64_t k = 0; k < cells; k++) {
      const int64_t here = mine[k];
      mine[k] = first;
      first += here;
    }
  }
};

struct MoveToPlace {
  Columns from, to;
  Grid grid;
  int64_t *next;
  BODY void operator()(int64_t i, int) const
  {
    const Point p = place_of(from, i);
    const int64_t slot = fetch_add_whole(next + cell_of(grid, p), 1);
    to.x[slot] = p.x, to.y[slot] = p.y, to.z[slot] = p.z;
    set_velocity(to, slot, velocity_of(from, i));
    to.id[slot] = from.id[i];
  }
};

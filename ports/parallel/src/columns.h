// The passes over particles and cells on a CPU, `lanes` at a time in registers. The operations are those of the bodies,
// in the same order. Where a number is out of the usual range, the bodies do these particles.
#pragma once

#include "bodies.h"
#include "registers.h"

struct Three {
  reals x, y, z;
};

struct Places {
  wholes x, y, z;
};

INLINE Three operator+(const Three &a, const Three &b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
INLINE Three operator-(const Three &a, const Three &b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
INLINE Three operator*(reals s, const Three &a)
{
  return {s * a.x, s * a.y, s * a.z};
}
INLINE reals dot(const Three &a, const Three &b)
{
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
INLINE Three cross(const Three &a, const Three &b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* --- turn and flight -------------------------------------------------------------------------------------------- */

static_assert(offsetof(CellTurn, axis) == 24 && offsetof(CellTurn, factor) == 48 && offsetof(CellTurn, active) == 56,
              "two rows of four numbers");

template <bool right_angle>
INLINE Three turn_all(const CellTurn *turn, const int32_t *cell, double cosine, double sine, const Three &v)
{
  const Square low = load_rows([=](int k) { return &turn[cell[k]].center.x; }),
               high = load_rows([=](int k) { return &turn[cell[k]].axis.y; });
  const Three center = {low.at[0], low.at[1], low.at[2]}, axis = {low.at[3], high.at[0], high.at[1]};
  const Three w = v - center;
  const reals along = dot(axis, w);
  const Three turned = right_angle ? along * axis + cross(axis, w)
                                   : (each(cosine) * w + (each(1.0 - cosine) * along) * axis) + each(sine) * cross(axis, w);
  const Three changed = center + high.at[2] * turned;
  const wholes alone = (wholes)((wholes)high.at[3] == 0);
  return {choose(alone, v.x, changed.x), choose(alone, v.y, changed.y), choose(alone, v.z, changed.z)};
}

// A flight along one axis, which is not folded. A factor of 2^40 does not change how a product or a sum is rounded.
INLINE void fly_along(double time, double fall, double gain, wholes &p, reals &v)
{
  p += nearest_of(v * (time * lattice_per_a0) + fall * lattice_per_a0);
  v += gain;
}

// The same, folded. Like the other flights here: negative where p is not where it has to be.
INLINE wholes fly_folded(double time, double fall, double gain, int64_t edge, wholes &p, reals &v)
{
  fly_along(time, fall, gain, p, v);
  p = fold_once(p, edge);
  return outside(p, edge - 1);
}

INLINE wholes fly_xz(const Flight &f, Point edge, Places &p, Three &v)
{
  return fly_folded(f.time, f.fall.x, f.gain.x, edge.x, p.x, v.x) |
         fly_folded(f.time, f.fall.z, f.gain.z, edge.z, p.z, v.z);
}

// A border's `leave`, and its `fly` and `enter`; negative where the border has to look at the particle.
INLINE wholes leave_all(const Periodic &, const Places &, Three &)
{
  return wholes{};
}
INLINE wholes fly_all(const Periodic &b, const Flight &f, Places &p, Three &v)
{
  return fly_xz(f, b.edge, p, v) | fly_folded(f.time, f.fall.y, f.gain.y, b.edge.y, p.y, v.y);
}

INLINE wholes leave_all(const Walled &, const Places &, Three &)
{
  return wholes{};
}
INLINE wholes fly_all(const Walled &b, const Flight &f, Places &p, Three &v)
{
  const reals along_y = v.y;
  const wholes out = fly_xz(f, b.edge, p, v);
  fly_along(f.time, 0.0, 0.0, p.y, v.y);
  v.y = along_y;
  return out | outside(p.y, b.edge.y);
}

INLINE wholes leave_all(const Sheared &b, const Places &p, Three &v)
{
  if (b.kicks)
    for (int k = 0; k < lanes; k++)
      v.x[k] += b.affine(p.y[k]);
  return outside(p.y, b.edge.y - b.last.shift - 1);
}
INLINE wholes fly_all(const Sheared &b, const Flight &f, Places &p, Three &v)
{
  const wholes out = fly_xz(f, b.edge, p, v);
  fly_along(f.time, f.fall.y, f.gain.y, p.y, v.y);
  return out | outside(p.y, b.edge.y - b.next.shift - 1);
}

/* --- cells ------------------------------------------------------------------------------------------------------ */

// Of places in the box; shifts are smaller than a cell.
INLINE wholes cells_along(wholes x, int64_t shift, int64_t cells)
{
  const wholes at = (wholes)((words)(x + shift) >> 40);
  return at & (wholes)(at != cells);
}

INLINE halves cells_of(const Grid &grid, const Places &p)
{
  const wholes x = cells_along(p.x, grid.shift.x, grid.cells[0]), y = cells_along(p.y, grid.shift.y, grid.cells[1]),
               z = cells_along(p.z, grid.shift.z, grid.cells[2]);
  const words row = multiply_low((words)z, (uint32_t)grid.cells[1]) + (words)y;
  return __builtin_convertvector((wholes)(multiply_low(row, (uint32_t)grid.cells[0]) + (words)x), halves);
}

// Words of draw 0 of entities; each lane's low half is a word.
INLINE void words_of_all(const Source &source, words entity, words w[4])
{
  uint32_t k0 = (uint32_t)source.seed, k1 = (uint32_t)(source.seed >> 32);
  w[0] = entity, w[1] = words{} + source.purpose, w[2] = words{} + (uint32_t)source.step,
  w[3] = words{} + (source.step >> 32);
  for (int round = 0; round < 10; round++) {
    const words p = multiply_low(w[0], 0xD2511F53u), q = multiply_low(w[2], 0xCD9E8D57u);
    w[0] = (q >> 32) ^ (w[1] ^ k0), w[1] = q, w[2] = (p >> 32) ^ (w[3] ^ k1), w[3] = p;
    k0 += 0x9E3779B9u, k1 += 0xBB67AE85u;
  }
}

// (k + 0.5) 2^-31 of the signed low halves k. Bits 0x413 before 52 bits 2 (k + 2^31) + 1 are 2^20 + 1 more.
INLINE reals in_square(words x)
{
  return (reals)(((x << 1) & 0x1fffffffe) ^ 0x4130000100000001) - (0x1p20 + 1.0);
}

// `axis_of` by draw 0; z <= -1 where it gives none.
INLINE Three axes_of(const Source &source, words entity)
{
  words w[4];
  words_of_all(source, entity, w);
  const reals u0 = in_square(w[0]), v0 = in_square(w[1]), u1 = in_square(w[2]), v1 = in_square(w[3]);
  const reals q0 = u0 * u0 + v0 * v0, q1 = u1 * u1 + v1 * v1;
  const wholes first = (wholes)(q0 < 1.0);
  const reals u = choose(first, u0, u1), v = choose(first, v0, v1), q = choose(first, q0, q1);
  const reals root = square_root(1.0 - q);
  return {2.0 * u * root, 2.0 * v * root, 1.0 - 2.0 * q};
}

// SolveCell of `lanes` cells.
INLINE void solve_lanes(const SolveCell &s, int64_t first)
{
  Places p = {};
  words weight = {};
  for (int part = 0; part < s.shards; part++) {
    CellSum *const from = s.sums + part * s.cell_count + first;
    const Square sum = load_rows([=](int k) { return (const double *)(from + k); });
    p.x += (wholes)sum.at[0], p.y += (wholes)sum.at[1], p.z += (wholes)sum.at[2], weight += (words)sum.at[3];
    if (any_negative(-(wholes)sum.at[3])) { // a line that is not written stays with both cores
      UNROLL
      for (int k = 0; k < lanes; k++)
        store(whole_quad{}, &from[k].x);
    }
  }
  words cell;
  UNROLL
  for (int k = 0; k < lanes; k++)
    cell[k] = (uint64_t)(first + k);
  const words members = weight >> load_bits, mass = weight & (((uint64_t)1 << load_bits) - 1);
  const Three axis = axes_of(s.axes, cell);
  const reals whole_mass = (reals)(mass | 0x4330000000000000) - 0x1p52; // below 2^52
  const reals scale = (1.0 / momentum_per_unit) / (whole_mass * (1.0 / mass_per_unit));
  const wholes many = (wholes)((wholes)members > 1);
  CellTurn *const to = s.turn + first;
  store_rows({{scale * as_reals(p.x), scale * as_reals(p.y), scale * as_reals(p.z), axis.x}},
             [=](int k) { return &to[k].center.x; });
  store_rows({{axis.y, axis.z, each(1.0), (reals)((wholes)members & many)}}, [=](int k) { return &to[k].axis.y; });
  const wholes again = (wholes)(axis.z <= -1.0) & many;
  if (any_negative(again))
    for (int k = 0; k < lanes; k++)
      if (again[k])
        to[k].axis = axis_of(s.axes, (uint32_t)(first + k), 1);
}

// The body of a loop over blocks of cells.
struct SolveBlock {
  static constexpr int64_t size = 64;
  SolveCell body;
  void operator()(int64_t block, int shard) const
  {
    const SolveCell one = body;
    const int64_t first = block * size, last = first + size;
    for (int64_t cell = first; cell < last && last <= one.cell_count; cell += lanes)
      solve_lanes(one, cell);
    for (int64_t cell = first; cell < one.cell_count && last > one.cell_count; cell++)
      one(cell, shard);
  }
};

/* --- the passes ------------------------------------------------------------------------------------------------- */

// What a pass does with particles: turn (if it turns), flight, sums. `cell` has the cells of the last collision, and gets
// those of the next one.
template <class Border> struct Pass {
  Columns c;
  Border border;
  Grid next;
  const CellTurn *turn;
  double cosine, sine;
  Flight flight;
  Sums sums;
  int32_t *cell;
};

// A wrong flight of 2^51 or more ends outside of such a box.
constexpr int64_t most_cells = 1024;

inline bool suits_lanes(const Grid &grid)
{
  return grid.cells[0] <= most_cells && grid.cells[1] <= most_cells && grid.cells[2] <= most_cells &&
         grid.cells[0] * grid.cells[1] * grid.cells[2] < INT32_MAX;
}

constexpr int together = 64; // particles whose cells' turns are on the way before they are needed

// Particles first to first + lanes - 1. False if something is out of the usual range; then nothing has changed.
template <bool turns, bool right_angle, class Border>
INLINE bool pass_lanes(const Pass<Border> &pass, int64_t first, CellSum *add)
{
  const Columns &c = pass.c;
  Places p = {load<wholes>(c.x + first), load<wholes>(c.y + first), load<wholes>(c.z + first)};
  Three v = {load<reals>(c.vx + first), load<reals>(c.vy + first), load<reals>(c.vz + first)};
  wholes out = {};
  if (turns) {
    v = turn_all<right_angle>(pass.turn, pass.cell + first, pass.cosine, pass.sine, v);
    out = leave_all(pass.border, p, v);
  }
  out |= fly_all(pass.border, pass.flight, p, v);
  constexpr int64_t load = ((int64_t)1 << load_bits) + (int64_t)mass_per_unit, most = (int64_t)1 << 51;
  const wholes x = nearest_of(momentum_per_unit * v.x), y = nearest_of(momentum_per_unit * v.y),
               z = nearest_of(momentum_per_unit * v.z);
  const words large = ((words)(x + most) | (words)(y + most) | (words)(z + most)) >> 52;
  if (any_negative(out | -(wholes)large))
    return false;
  store(cells_of(pass.next, p), pass.cell + first);
  store(p.x, c.x + first), store(p.y, c.y + first), store(p.z, c.z + first);
  store(v.x, c.vx + first), store(v.y, c.vy + first), store(v.z, c.vz + first);
  store_rows({{(reals)x, (reals)y, (reals)z, (reals)(wholes{} + load)}}, [=](int k) { return (double *)(add + k); });
  return true;
}

// The body of a loop over blocks of particles. `Body` is that for a single one.
template <bool turns, bool right_angle, class Border, class Body> struct PassBlock {
  Pass<Border> its;
  Body body;
  int64_t n;

  void one_by_one(int64_t first, int64_t last, int shard) const
  {
    for (int64_t i = first; i < last; i++) {
      body(i, shard);
      its.cell[i] = (int32_t)cell_of(its.next, place_of(its.c, i));
    }
  }
  void operator()(int64_t block, int shard) const
  {
    const Pass<Border> pass = its;
    const int64_t first = block * together, last = first + together;
    if (last > n) {
      one_by_one(first, n, shard);
      return;
    }
    alignas(64) CellSum add[together];
    const int most = turns ? together : 0;
    UNROLL
    for (int k = 0; k < most; k++)
      __builtin_prefetch(pass.turn + pass.cell[first + k]);
    for (int k = 0; k < together; k += lanes)
      if (!pass_lanes<turns, right_angle>(pass, first + k, add + k)) {
        one_by_one(first + k, first + k + lanes, shard);
        std::memset((void *)(add + k), 0, lanes * sizeof *add);
      }
    CellSum *const to = pass.sums.at + shard * pass.sums.cell_count;
    UNROLL
    for (int k = 0; k < together; k++) {
      int64_t *const its_sum = &to[pass.cell[first + k]].x;
      store(load<whole_quad>(its_sum) + load<whole_quad>(&add[k].x), its_sum);
    }
  }
};

// FlySum, or TurnFlySum, over all particles.
template <bool turns, bool right_angle, class Border, class Body>
void pass_over(int64_t n, const Pass<Border> &pass, const Body &body)
{
  for_each_block((n + together - 1) / together, PassBlock<turns, right_angle, Border, Body>{pass, body, n});
}

/* --- vertices --------------------------------------------------------------------------------------------------- */

// Places along an axis of vertices, which may be many boxes away.
struct VertexAxis {
  int64_t edge, shift;
  double inverse;

  VertexAxis(int64_t edge, int64_t shift) : edge(edge), shift(shift), inverse(1.0 / (double)edge)
  {
  }
  int32_t cell(int64_t x) const
  {
    const int64_t whole = x + shift, image = (int64_t)((double)whole * inverse);
    return (int32_t)(fold(whole - image * edge, edge) >> 40);
  }
};

// SumVertex and TurnVertex of `together` vertices, whose cells are on the way before they are needed.
struct SumVertices {
  SumVertex one;
  int32_t *cell;
  int64_t n;
  void operator()(int64_t block, int shard) const
  {
    const Grid &grid = one.grid;
    const VertexAxis x(grid.edge.x, grid.shift.x), y(grid.edge.y, grid.shift.y), z(grid.edge.z, grid.shift.z);
    const int32_t nx = (int32_t)grid.cells[0], ny = (int32_t)grid.cells[1];
    const int64_t first = block * together, last = first + together < n ? first + together : n;
    for (int64_t i = first; i < last; i++) {
      const Point p = one.p[i];
      cell[i] = (z.cell(p.z) * ny + y.cell(p.y)) * nx + x.cell(p.x);
      __builtin_prefetch(one.sums.at + shard * one.sums.cell_count + cell[i], 1);
    }
    for (int64_t i = first; i < last; i++)
      add_member(one.sums, shard, cell[i], one.mass[i], one.v[i]);
  }
};

struct TurnVertices {
  TurnVertex one;
  const int32_t *cell;
  int64_t n;
  void operator()(int64_t block, int) const
  {
    const int64_t first = block * together, last = first + together < n ? first + together : n;
    for (int64_t i = first; i < last; i++)
      __builtin_prefetch(one.turn + cell[i]);
    for (int64_t i = first; i < last; i++)
      one.v[i] = after_turn(one.turn[cell[i]], one.cosine, one.sine, one.v[i]);
  }
};

template <class Body> void over_vertices(int64_t n, const Body &body)
{
  for_each_block((n + together - 1) / together, body);
}

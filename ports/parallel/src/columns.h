// The passes over particles on a CPU: 16 at a time in columns, which compilers turn into vector instructions. The
// operations are those of the bodies, in the same order. Where a number is out of the usual range, the bodies do
// the 16.
#pragma once

#include "bodies.h"

constexpr int lanes = 16;

struct Reals {
  alignas(64) double at[lanes];
};

struct Wholes {
  alignas(64) int64_t at[lanes];
};

struct Three {
  Reals x, y, z;
};

struct Places {
  Wholes x, y, z;
};

struct Cells {
  alignas(64) int32_t at[lanes];
};

inline void load(const double *from, Reals &to)
{
  for (int k = 0; k < lanes; k++)
    to.at[k] = from[k];
}
inline void load(const int64_t *from, Wholes &to)
{
  for (int k = 0; k < lanes; k++)
    to.at[k] = from[k];
}
inline void store(const Reals &from, double *to)
{
  for (int k = 0; k < lanes; k++)
    to[k] = from.at[k];
}
inline void store(const Wholes &from, int64_t *to)
{
  for (int k = 0; k < lanes; k++)
    to[k] = from.at[k];
}

// `nearest` of factor x, if all sizes are below 2^51: the sum with 1.5 2^52 is rounded to a whole number.
inline bool nearest_of(double factor, const Reals &x, Wholes &to)
{
  constexpr double magic = 0x1.8p52;
  int64_t large = 0;
  for (int k = 0; k < lanes; k++) {
    const double scaled = factor * x.at[k];
    large |= -(int64_t) !(std::fabs(scaled) < 0x1p51);
    to.at[k] = (int64_t)(bits_of(scaled + magic) - bits_of(magic));
  }
  return large == 0;
}

// `fold`, if no number is further out than one edge.
inline bool fold_all(Wholes &x, int64_t edge)
{
  int64_t out = 0;
  for (int k = 0; k < lanes; k++) {
    int64_t v = x.at[k];
    v = v + (v < 0 ? edge : 0) - (v >= edge ? edge : 0);
    out |= v | (edge - 1 - v);
    x.at[k] = v;
  }
  return out >= 0;
}

inline bool cells_along(const Wholes &x, int64_t shift, int64_t edge, Cells &to)
{
  Wholes shifted;
  for (int k = 0; k < lanes; k++)
    shifted.at[k] = x.at[k] + shift;
  const bool usual = fold_all(shifted, edge);
  for (int k = 0; k < lanes; k++)
    to.at[k] = (int32_t)((uint64_t)shifted.at[k] >> 40);
  return usual;
}

inline bool cells_of(const Grid &grid, const Places &p, Cells &to)
{
  Cells x, y, z;
  const bool usual = cells_along(p.x, grid.shift.x, grid.edge.x, x) & cells_along(p.y, grid.shift.y, grid.edge.y, y) &
                     cells_along(p.z, grid.shift.z, grid.edge.z, z);
  const int32_t nx = (int32_t)grid.cells[0], ny = (int32_t)grid.cells[1];
  for (int k = 0; k < lanes; k++)
    to.at[k] = (z.at[k] * ny + y.at[k]) * nx + x.at[k];
  return usual;
}

struct Turns {
  Three center, axis;
  Reals factor;
  Wholes active;
};

inline void gather(const CellTurn *turn, const Cells &cell, Turns &to)
{
  for (int k = 0; k < lanes; k++) {
    const CellTurn &t = turn[cell.at[k]];
    to.center.x.at[k] = t.center.x, to.center.y.at[k] = t.center.y, to.center.z.at[k] = t.center.z;
    to.axis.x.at[k] = t.axis.x, to.axis.y.at[k] = t.axis.y, to.axis.z.at[k] = t.axis.z;
    to.factor.at[k] = t.factor, to.active.at[k] = t.active;
  }
}

template <bool right_angle> void turn_all(const Turns &t, double cosine, double sine, Three &v)
{
  for (int k = 0; k < lanes; k++) {
    const Vector old = {v.x.at[k], v.y.at[k], v.z.at[k]};
    const CellTurn cell = {{t.center.x.at[k], t.center.y.at[k], t.center.z.at[k]},
                           {t.axis.x.at[k], t.axis.y.at[k], t.axis.z.at[k]},
                           t.factor.at[k],
                           1};
    const Vector changed = after_turn(cell, right_angle ? 0.0 : cosine, sine, old);
    const bool active = t.active.at[k] != 0;
    v.x.at[k] = active ? changed.x : old.x;
    v.y.at[k] = active ? changed.y : old.y;
    v.z.at[k] = active ? changed.z : old.z;
  }
}

// A flight along one axis, which is not folded.
inline bool fly_along(double time, double fall, double gain, Wholes &p, Reals &v)
{
  Reals way;
  Wholes whole;
  for (int k = 0; k < lanes; k++) {
    way.at[k] = time * v.at[k] + fall;
    v.at[k] = v.at[k] + gain;
  }
  const bool usual = nearest_of(lattice_per_a0, way, whole);
  for (int k = 0; k < lanes; k++)
    p.at[k] += whole.at[k];
  return usual;
}

// Is each number from 0 to `most`?
inline bool all_within(const Wholes &x, int64_t most)
{
  int64_t out = 0;
  for (int k = 0; k < lanes; k++)
    out |= x.at[k] | (most - x.at[k]);
  return out >= 0;
}

inline bool fly_xz(const Flight &f, Point edge, Places &p, Three &v)
{
  return fly_along(f.time, f.fall.x, f.gain.x, p.x, v.x) & fold_all(p.x, edge.x) &
         fly_along(f.time, f.fall.z, f.gain.z, p.z, v.z) & fold_all(p.z, edge.z);
}

// A border's `leave`, and its `fly` and `enter`, of 16 particles; false where the border has to look at one of them.
inline bool leave_all(const Periodic &, const Places &, Three &)
{
  return true;
}
inline bool fly_all(const Periodic &b, const Flight &f, Places &p, Three &v)
{
  return fly_xz(f, b.edge, p, v) & fly_along(f.time, f.fall.y, f.gain.y, p.y, v.y) & fold_all(p.y, b.edge.y);
}

inline bool leave_all(const Walled &, const Places &, Three &)
{
  return true;
}
inline bool fly_all(const Walled &b, const Flight &f, Places &p, Three &v)
{
  const Reals along_y = v.y;
  const bool usual = fly_xz(f, b.edge, p, v) & fly_along(f.time, 0.0, 0.0, p.y, v.y) & all_within(p.y, b.edge.y);
  v.y = along_y;
  return usual;
}

inline bool leave_all(const Sheared &b, const Places &p, Three &v)
{
  for (int k = 0; k < lanes && b.kicks; k++)
    v.x.at[k] += b.affine(p.y.at[k]);
  return all_within(p.y, b.edge.y - b.last.shift - 1);
}
inline bool fly_all(const Sheared &b, const Flight &f, Places &p, Three &v)
{
  return fly_xz(f, b.edge, p, v) & fly_along(f.time, f.fall.y, f.gain.y, p.y, v.y) &
         all_within(p.y, b.edge.y - b.next.shift - 1);
}

inline void add_members(CellSum *to, const Cells &cell, const Places &momentum)
{
  constexpr int64_t load = ((int64_t)1 << load_bits) + (int64_t)mass_per_unit;
  for (int k = 0; k < lanes; k++) {
    CellSum &sum = to[cell.at[k]];
    sum.x += momentum.x.at[k], sum.y += momentum.y.at[k], sum.z += momentum.z.at[k], sum.load += load;
  }
}

/* --- cells ------------------------------------------------------------------------------------------------------ */

struct WordLanes {
  alignas(64) uint32_t at[4][lanes];
};

// Words of draw 0 of 16 entities.
inline void words_of_all(const Source &source, uint32_t first, WordLanes &w)
{
  for (int k = 0; k < lanes; k++) {
    const Words one = words_of(source, 0, first + (uint32_t)k);
    w.at[0][k] = one.word[0], w.at[1][k] = one.word[1], w.at[2][k] = one.word[2], w.at[3][k] = one.word[3];
  }
}

// `axis_of` from the first pair of words of draw 0; `outside`: they give none.
inline void axes_of(const uint32_t *first, const uint32_t *second, Three &axis, Wholes &outside)
{
  for (int k = 0; k < lanes; k++) {
    const double u = ((double)(int32_t)first[k] + 0.5) * 0x1p-31, v = ((double)(int32_t)second[k] + 0.5) * 0x1p-31;
    const double q = u * u + v * v, root = std::sqrt(q < 1.0 ? 1.0 - q : 0.0);
    outside.at[k] = q < 1.0 ? 0 : 1;
    axis.x.at[k] = 2.0 * u * root, axis.y.at[k] = 2.0 * v * root, axis.z.at[k] = 1.0 - 2.0 * q;
  }
}

inline void take_sums(const SolveCell &s, int64_t first, Places &momentum, Wholes &weight)
{
  CellSum sum[lanes];
  CellSum *const from = s.sums + first;
  for (int k = 0; k < lanes; k++)
    sum[k] = from[k], from[k] = {0, 0, 0, 0};
  for (int part = 1; part < s.shards; part++)
    for (int k = 0; k < lanes; k++) {
      CellSum &each = from[part * s.cell_count + k];
      sum[k] = {sum[k].x + each.x, sum[k].y + each.y, sum[k].z + each.z, sum[k].load + each.load};
      each = {0, 0, 0, 0};
    }
  for (int k = 0; k < lanes; k++) {
    momentum.x.at[k] = sum[k].x, momentum.y.at[k] = sum[k].y, momentum.z.at[k] = sum[k].z;
    weight.at[k] = sum[k].load;
  }
}

// Whole numbers below 2^51 as doubles.
inline bool as_reals(const Wholes &x, Reals &to)
{
  constexpr double magic = 0x1.8p52;
  int64_t large = 0;
  for (int k = 0; k < lanes; k++) {
    const uint64_t above = (uint64_t)x.at[k] + 0x8000000000000; // from 0 to 2^52 - 1
    large |= (int64_t)(above >> 52);
    to.at[k] = from_bits((uint64_t)x.at[k] + bits_of(magic)) - magic;
  }
  return large == 0;
}

// SolveCell of 16 cells.
inline void solve_lanes(const SolveCell &s, int64_t first)
{
  Places p;
  Wholes weight, members, mass, outside, second_outside;
  Three momentum, axis, second;
  Reals whole_mass;
  WordLanes words;
  take_sums(s, first, p, weight);
  for (int k = 0; k < lanes; k++) {
    members.at[k] = (int64_t)((uint64_t)weight.at[k] >> load_bits);
    mass.at[k] = weight.at[k] & (((int64_t)1 << load_bits) - 1);
  }
  bool usual = as_reals(mass, whole_mass);
  usual = as_reals(p.x, momentum.x) & as_reals(p.y, momentum.y) & as_reals(p.z, momentum.z) & usual;
  words_of_all(s.axes, (uint32_t)first, words);
  axes_of(words.at[0], words.at[1], axis, outside);
  axes_of(words.at[2], words.at[3], second, second_outside);
  CellTurn *const to = s.turn + first;
  for (int k = 0; k < lanes; k++) {
    const double each = (1.0 / momentum_per_unit) / (whole_mass.at[k] * (1.0 / mass_per_unit));
    const bool later = outside.at[k] != 0;
    to[k].center = each * Vector{momentum.x.at[k], momentum.y.at[k], momentum.z.at[k]};
    to[k].axis = {later ? second.x.at[k] : axis.x.at[k], later ? second.y.at[k] : axis.y.at[k],
                  later ? second.z.at[k] : axis.z.at[k]};
    to[k].factor = 1.0, to[k].active = members.at[k] < 2 ? 0 : members.at[k];
    outside.at[k] &= second_outside.at[k];
  }
  for (int k = 0; k < lanes; k++)
    if (outside.at[k])
      to[k].axis = axis_of(s.axes, (uint32_t)(first + k));
  for (int k = 0; k < lanes && !usual; k++)
    to[k].center = ((1.0 / momentum_per_unit) / ((double)mass.at[k] * (1.0 / mass_per_unit))) *
                   as_vector({p.x.at[k], p.y.at[k], p.z.at[k]});
}

struct SolveBlock {
  SolveCell one;
  void operator()(int64_t block, int shard) const
  {
    const int64_t first = block * lanes, last = first + lanes;
    if (last <= one.cell_count)
      solve_lanes(one, first);
    else
      for (int64_t cell = first; cell < one.cell_count; cell++)
        one(cell, shard);
  }
};

/* --- the passes ------------------------------------------------------------------------------------------------- */

// What a pass does with 16 particles: turn (if it turns), flight, sums. `cell` has the cells of the last collision, and
// gets those of the next one.
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

// Another thread may look ahead at this cell, for what it prefetches; either of its numbers will do.
template <class Border> void keep_cell(const Pass<Border> &pass, int64_t i, int32_t cell)
{
  __atomic_store_n(&pass.cell[i], cell, __ATOMIC_RELAXED);
}

// What 16 particles add to their cells.
struct Addends {
  Cells cell;
  Places momentum;
};

constexpr int together = 4; // times 16 particles: their cells' sums are on the way while others are computed
constexpr int ahead = 2 * lanes;

// False if something is out of the usual range; then nothing has changed.
template <bool turns, bool right_angle, class Border>
bool pass_lanes(const Pass<Border> &pass, int64_t first, int shard, Addends &add)
{
  const Columns &c = pass.c;
  bool usual = true;
  Places p;
  Three v;
  load(c.x + first, p.x), load(c.y + first, p.y), load(c.z + first, p.z);
  load(c.vx + first, v.x), load(c.vy + first, v.y), load(c.vz + first, v.z);
  if (turns) {
    Cells cell;
    for (int k = 0; k < lanes; k++) {
      cell.at[k] = pass.cell[first + k];
      __builtin_prefetch(pass.turn + __atomic_load_n(&pass.cell[first + ahead + k], __ATOMIC_RELAXED));
    }
    Turns t;
    gather(pass.turn, cell, t);
    turn_all<right_angle>(t, pass.cosine, pass.sine, v);
    usual = leave_all(pass.border, p, v);
  }
  usual = usual & fly_all(pass.border, pass.flight, p, v) & cells_of(pass.next, p, add.cell) &
          nearest_of(momentum_per_unit, v.x, add.momentum.x) & nearest_of(momentum_per_unit, v.y, add.momentum.y) &
          nearest_of(momentum_per_unit, v.z, add.momentum.z);
  if (!usual)
    return false;
  for (int k = 0; k < lanes; k++) {
    keep_cell(pass, first + k, add.cell.at[k]);
    __builtin_prefetch(pass.sums.at + shard * pass.sums.cell_count + add.cell.at[k], 1);
  }
  store(p.x, c.x + first), store(p.y, c.y + first), store(p.z, c.z + first);
  store(v.x, c.vx + first), store(v.y, c.vy + first), store(v.z, c.vz + first);
  return true;
}

// The body of a loop over blocks of particles. `Body` is that for a single one.
template <bool turns, bool right_angle, class Border, class Body> struct PassBlock {
  Pass<Border> pass;
  Body body;
  int64_t n;
  void operator()(int64_t block, int shard) const
  {
    Addends add[together];
    bool whole[together];
    for (int k = 0; k < together; k++) {
      const int64_t first = (block * together + k) * lanes, last = first + lanes;
      whole[k] = last <= n && pass_lanes<turns, right_angle>(pass, first, shard, add[k]);
      for (int64_t i = first; !whole[k] && i < last && i < n; i++) {
        body(i, shard);
        keep_cell(pass, i, (int32_t)cell_of(pass.next, place_of(pass.c, i)));
      }
    }
    for (int k = 0; k < together; k++)
      if (whole[k])
        add_members(pass.sums.at + shard * pass.sums.cell_count, add[k].cell, add[k].momentum);
  }
};

// FlySum, or TurnFlySum, over all particles.
template <bool turns, bool right_angle, class Border, class Body>
void pass_over(int64_t n, const Pass<Border> &pass, const Body &body)
{
  constexpr int each = together * lanes;
  for_each_block((n + each - 1) / each, PassBlock<turns, right_angle, Border, Body>{pass, body, n});
}

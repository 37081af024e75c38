// Walls and shear: what they do and when. docs/port/flow.md, "Motion".
#pragma once

#include <vector>

#include "arithmetic.h"

enum BoundaryKind { PERIODIC = 0, WALLS = 1, SHEAR = 2 };
enum Fill { PLANAR = 0, PAPER_FILL = 1, NO_FILL = 2 };

struct WallPair {
  Vector at[2]; // lower, upper
};

// Units: a0, t0, kT; the box and the steps are those of the model.
struct Flow {
  int kind = PERIODIC;
  bool slip = false;
  int fill = PLANAR;
  int64_t intervals = 0; // collision intervals in a period; 0: the motion is constant
  int64_t early = 0;     // half steps by which collisions are early
  double per_cell = 0, rate = 0;
  WallPair wall = {};
  std::vector<double> cosine;

  // Of these numbers of half intervals, and of a collision interval.
  WallPair walls_at(int64_t half_intervals) const;
  double rate_during(int64_t interval) const
  {
    return rate * wave(2 * interval + 1);
  }
  // Lattice units by which the image has slid after so many half steps, in the edge along x.
  int64_t offset(const int64_t cells[3], double time_step, int64_t steps_between, int64_t half_steps) const;

private:
  double wave(int64_t half_intervals) const
  {
    return intervals > 0 ? cosine[(size_t)(half_intervals % (2 * intervals))] : 1.0;
  }
};

// What a start says: the constants of a scene and its state.
#pragma once

#include <string>
#include <vector>

#include "arithmetic.h"
#include "flow.h"

enum Scheme { PAPER = 0, KICK_SPLIT = 1, DRIFT_SPLIT = 2 };
enum Thermostat { NO_THERMOSTAT = 0, RESCALE = 1, MAXWELL_BOLTZMANN = 2, RESCALE_LAYERS = 3 };

struct Model {
  int64_t cells[3] = {0, 0, 0};
  uint64_t seed = 0;
  int64_t particles = 0, interval = 1;
  bool forbidden = false, exclusion_paper = false;
  double time_step = 0, cosine = 0, sine = 0;
  Vector acceleration = {0, 0, 0};
  std::vector<int32_t> next, prev, fiber; // of each vertex, -1: none
  std::vector<double> mass, bond_length, spring, bending;
  std::vector<Vector> constant_force;

  // Of a start.
  int64_t steps = 0;
  int scheme = KICK_SPLIT, thermostat = NO_THERMOSTAT;
  bool hydrodynamics = true, event_driven = false, andersen = false;
  Flow flow;

  // Of the grid along y: walls cut the first and the last.
  int64_t rows() const
  {
    return cells[1] + (flow.kind == WALLS);
  }
  int64_t cell_count() const
  {
    return cells[0] * rows() * cells[2];
  }
  Point edge() const
  {
    return {cells[0] << 40, cells[1] << 40, cells[2] << 40};
  }
  int32_t vertices() const
  {
    return (int32_t)mass.size();
  }
  Source source(uint32_t purpose, uint64_t step) const
  {
    return {seed, purpose, step};
  }
};

// Since a run's step 0, as `uncross` counts them: docs/files.md, "checkpoint.h5".
struct CollisionCounts {
  int64_t moves = 0, possible = 0, executed = 0, negative = 0, softened = 0, rigid = 0;
};

// Solvent by ids, vertices by numbers.
struct State {
  uint64_t step = 0, lag = 0;
  std::vector<Point> solvent, vertex;
  std::vector<Vector> solvent_velocity, vertex_velocity;
  // Of walls, what they have given in units of 2^-44: the lower and the upper one in hits, then both in collisions.
  std::vector<Point> account;
  CollisionCounts counts;
};

// XXH64 of whole words, seed 0.
class WordHash
{
public:
  void add(uint64_t word)
  {
    group[count++ & 3] = word;
    if ((count & 3) == 0)
      for (int k = 0; k < 4; k++)
        lane[k] = round(lane[k], group[k]);
  }
  void add(Point p)
  {
    add((uint64_t)p.x), add((uint64_t)p.y), add((uint64_t)p.z);
  }
  void add(Vector v)
  {
    add(bits_of(v.x)), add(bits_of(v.y)), add(bits_of(v.z));
  }

  uint64_t value() const
  {
    uint64_t h = P5;
    if (count >= 4) {
      h = turn(lane[0], 1) + turn(lane[1], 7) + turn(lane[2], 12) + turn(lane[3], 18);
      for (int k = 0; k < 4; k++)
        h = (h ^ round(0, lane[k])) * P1 + P4;
    }
    h += 8 * count;
    for (uint64_t k = 0; k < (count & 3); k++)
      h = turn(h ^ round(0, group[k]), 27) * P1 + P4;
    h = (h ^ (h >> 33)) * P2;
    h = (h ^ (h >> 29)) * P3;
    return h ^ (h >> 32);
  }

private:
  static constexpr uint64_t P1 = 0x9E3779B185EBCA87, P2 = 0xC2B2AE3D27D4EB4F, P3 = 0x165667B19E3779F9,
                            P4 = 0x85EBCA77C2B2AE63, P5 = 0x27D4EB2F165667C5;
  static uint64_t turn(uint64_t x, int bits)
  {
    return x << bits | x >> (64 - bits);
  }
  static uint64_t round(uint64_t v, uint64_t w)
  {
    return turn(v + w * P2, 31) * P1;
  }

  uint64_t lane[4] = {P1 + P2, P2, 0, 0 - P1};
  uint64_t group[4] = {0, 0, 0, 0};
  uint64_t count = 0;
};

// Fisher and Yates: docs/conventions.md, *Permutation*
std::vector<uint32_t> permutation(const Source &source, uint32_t draw, uint32_t size);

uint64_t state_hash(const State &state);
// A sum of one hash for each row: docs/conventions.md, "The same bits".
uint64_t state_digest(const State &state);

// The start of a solvent without fibers, as uncross draws it: for boxes whose starts would be long texts.
State draw_solvent(const Model &model);

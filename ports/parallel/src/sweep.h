// The rule `sequential`: vertices move one at a time. docs/port/contract.md, *Sweep*; docs/conventions.md, "The crossing
// test". It is serial by its words; only the list of pairs is made by all cores.
#pragma once

#include "pairs.h"

struct CrossingTest {
  Point from, to, pivot, a, b;
  bool flip; // the moving vertex is the first of its bond
};

struct CrossingHit {
  double time = 0, s = 0, s_standing = 0;
  Vector normal = {0, 0, 0};
};

// A crossing that a move has found.
struct SweepRow {
  int32_t vertex, moving, standing, image[3];
  bool executed;
  CrossingHit hit;
  double momentum;
};

bool crosses(const CrossingTest &test, CrossingHit &hit);
// Moving vertex, pivot, a, b: the velocities change.
double exchange_momentum(Vector velocity[4], const double mass[4], double s, double s_standing, Vector normal);

class Sweep
{
public:
  explicit Sweep(const Model &model) : model(model), list(model)
  {
  }

  // Rows are appended.
  void move(double time, const std::vector<uint32_t> &order, std::vector<Point> &position,
            std::vector<Vector> &velocity, std::vector<SweepRow> *rows);
  int64_t possible = 0, executed = 0, negative = 0; // crossings since the start: hits of refused moves, exchanges

private:
  void hits_of(int32_t vertex, Point to, const std::vector<Point> &position, std::vector<SweepRow> &hits) const;
  void hits_of_bond(int32_t vertex, int32_t moving, Point to, const std::vector<Point> &position,
                    std::vector<SweepRow> &hits) const;
  void execute(SweepRow &hit, std::vector<Vector> &velocity) const;

  const Model &model;
  PairList list;
};

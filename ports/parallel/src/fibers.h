// Forces on vertices, and kicks: docs/port/contract.md, "Forces".
#pragma once

#include <vector>

#include "model.h"

enum ForceParts { BONDS = 1, BENDS = 2, ALL_FORCES = 7 };

class Fibers
{
public:
  explicit Fibers(const Model &model);

  // Constant force, bonds, bends, or some of them, on all vertices.
  void forces(const std::vector<Point> &position, int parts, std::vector<Vector> &force) const;
  void kick(double time, const std::vector<Vector> &force, std::vector<Vector> &velocity) const;

  // The force on one vertex, added up as at a contact. `at` gives the place of a vertex.
  template <class Place> Vector force_on(int32_t j, const Place &at) const
  {
    const auto pull = [&](int32_t first) {
      return first < 0 ? Vector{0, 0, 0} : bond(first, in_a0(at(model.next[(size_t)first]) - at(first)));
    };
    const size_t number = (size_t)j;
    const bool whole = model.next[number] >= 0;
    Vector force = (model.constant_force[number] - pull(model.prev[number])) + (whole ? pull(j) : Vector{0, 0, 0});
    if (model.bending[number] == 0.0)
      return force;
    const auto bend_of = [&](int32_t m, Vector &a, Vector &b) {
      if (m < 0 || model.prev[(size_t)m] < 0 || model.next[(size_t)m] < 0)
        return false;
      const Point here = at(m);
      bend(m, in_a0(here - at(model.prev[(size_t)m])), in_a0(at(model.next[(size_t)m]) - here), a, b);
      return true;
    };
    Vector a, b;
    if (bend_of(model.prev[number], a, b))
      force = force + b;
    if (bend_of(j, a, b))
      force = force - (a + b);
    if (bend_of(model.next[number], a, b))
      force = force + a;
    return force;
  }

private:
  class Columns; // of one fiber
  Vector bond(int32_t j, Vector r) const;
  void bend(int32_t j, Vector before, Vector after, Vector &a, Vector &b) const;
  double fill(int32_t first, int32_t last, const std::vector<Point> &position, bool of_step, Columns &c) const;
  void add_forces(int32_t first, int32_t last, const Columns &c, int parts, std::vector<Vector> &force) const;

  const Model &model;
  std::vector<int32_t> first; // vertex of each fiber, and the number of all
  std::vector<double> inverse_mass;
};

#include "fibers.h"

#include <algorithm>

#include "stopped.h"

Fibers::Fibers(const Model &model) : model(model)
{
  for (int32_t j = 0; j < model.vertices(); j++)
    if (j == 0 || model.fiber[(size_t)j] != model.fiber[(size_t)j - 1])
      first.push_back(j);
  first.push_back(model.vertices());
}

// The force on vertex j, whose bond is r. Within a step, kinds with bends take the root, whatever l0.
Vector Fibers::bond(int32_t j, Vector r, bool of_step) const
{
  const size_t at = (size_t)j;
  if (model.bond_length[at] == 0.0 && !(of_step && model.bending[at] != 0.0))
    return model.spring[at] * r;
  const double length = std::sqrt(dot(r, r));
  return (model.spring[at] * (length - model.bond_length[at])) * ((1.0 / length) * r);
}

// The forces on the vertex before and on the one after.
void Fibers::bend(int32_t j, Vector before, Vector after, Vector &a, Vector &b) const
{
  const double kappa = model.bending[(size_t)j];
  const double each0 = 1.0 / std::sqrt(dot(before, before)), each1 = 1.0 / std::sqrt(dot(after, after));
  const Vector u0 = each0 * before, u1 = each1 * after;
  const double c = dot(u0, u1);
  a = (-kappa * each0) * (u1 - c * u0);
  b = (kappa * each1) * (u0 - c * u1);
}

void Fibers::add_forces(int32_t begin, int32_t end, const std::vector<Point> &position, int parts,
                        std::vector<Vector> &force) const
{
  for (int32_t j = begin; j < end; j++)
    force[(size_t)j] = parts == ALL_FORCES ? model.constant_force[(size_t)j] : Vector{0, 0, 0};
  for (int32_t j = begin; j < end && (parts & BONDS); j++) {
    const int32_t next = model.next[(size_t)j];
    if (next < 0)
      continue;
    const Vector pull = bond(j, in_a0(position[(size_t)next] - position[(size_t)j]), parts == ALL_FORCES);
    force[(size_t)j] = force[(size_t)j] + pull;
    force[(size_t)next] = force[(size_t)next] - pull;
  }
  for (int32_t j = begin; j < end && (parts & BENDS); j++) {
    const int32_t prev = model.prev[(size_t)j], next = model.next[(size_t)j];
    if (prev < 0 || next < 0 || model.bending[(size_t)j] == 0.0)
      continue;
    Vector a, b;
    const Point here = position[(size_t)j];
    bend(j, in_a0(here - position[(size_t)prev]), in_a0(position[(size_t)next] - here), a, b);
    force[(size_t)prev] = force[(size_t)prev] + a;
    force[(size_t)next] = force[(size_t)next] + b;
    force[(size_t)j] = force[(size_t)j] - (a + b);
  }
}

void Fibers::forces(const std::vector<Point> &position, int parts, std::vector<Vector> &force) const
{
  force.resize(position.size());
  double longest = 0.0;
#pragma omp parallel for reduction(max : longest) schedule(static)
  for (size_t j = 0; j < position.size(); j++)
    if (model.next[j] >= 0) {
      const Vector r = in_a0(position[(size_t)model.next[j]] - position[j]);
      longest = std::max(longest, dot(r, r));
    }
  const double limit = 0.5 * (double)std::min({model.cells[0], model.cells[1], model.cells[2]});
  if (parts == ALL_FORCES && longest > limit * limit)
    throw Stopped("a bond is longer than half the shortest edge");
#pragma omp parallel for schedule(static)
  for (size_t k = 0; k < first.size() - 1; k++)
    add_forces(first[k], first[k + 1], position, parts, force);
}

void Fibers::kick(double time, const std::vector<Vector> &force, std::vector<Vector> &velocity) const
{
#pragma omp parallel for schedule(static)
  for (size_t j = 0; j < velocity.size(); j++)
    velocity[j] = velocity[j] + (time * (1.0 / model.mass[j])) * force[j];
}

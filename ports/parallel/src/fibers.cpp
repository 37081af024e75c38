#include "fibers.h"

#include <algorithm>

#include "pack.h"
#include "stopped.h"

Fibers::Fibers(const Model &model) : model(model)
{
  for (int32_t j = 0; j < model.vertices(); j++)
    if (j == 0 || model.fiber[j] != model.fiber[j - 1])
      first.push_back(j);
  first.push_back(model.vertices());
  for (size_t k = 0; k + 1 < first.size(); k++)
    for (int32_t j = first[k]; j < first[k + 1]; j++) {
      const int32_t i = first[k], last = first[k + 1] - 1;
      if ((j < last && (model.next[j] != j + 1 || model.prev[j + 1] != j)) ||
          model.next[last] != (model.prev[i] < 0 ? -1 : i) || model.spring[j] != model.spring[i] ||
          model.bond_length[j] != model.bond_length[i] || model.bending[j] != model.bending[i])
        throw BadInput("vertices of a fiber must follow each other, and be of one kind");
    }
  for (const double mass : model.mass)
    inverse_mass.push_back(1.0 / mass);
}

// The force on vertex j, whose bond is r.
Vector Fibers::bond(int32_t j, Vector r) const
{
  const size_t at = (size_t)j;
  if (model.bond_length[at] == 0.0)
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

// Bonds and bends of one fiber in columns, which compilers turn into vector instructions. Bond k + 1 is that of the
// fiber's vertex k; bond 0 is that of the vertex before the first one, in rings.
struct Fibers::Columns {
  std::vector<double> x[3], unit[3], length, each, pull[3], a[3], b[3];

  void resize(size_t n)
  {
    for (int axis = 0; axis < 3; axis++)
      for (std::vector<double> *column : {&x[axis], &unit[axis], &pull[axis], &a[axis], &b[axis]})
        column->resize(n + 1);
    length.resize(n + 1), each.resize(n + 1);
  }
  static Vector at(const std::vector<double> *column, size_t k)
  {
    return {column[0][k], column[1][k], column[2][k]};
  }
};

// Returns the square of the longest bond.
double Fibers::fill(int32_t begin, int32_t end, const std::vector<Point> &position, bool of_step, Columns &c) const
{
  const int32_t n = end - begin;
  const bool ring = model.prev[begin] >= 0, of_bends = model.bending[begin] != 0.0;
  c.resize(n);
  double *const x = c.x[0].data(), *const y = c.x[1].data(), *const z = c.x[2].data();
  for (int32_t k = 0; k < n - 1; k++) {
    const Vector r = in_a0(position[begin + k + 1] - position[begin + k]);
    x[k + 1] = r.x, y[k + 1] = r.y, z[k + 1] = r.z;
  }
  const Vector last = ring ? in_a0(position[begin] - position[end - 1]) : Vector{0, 0, 0};
  x[0] = x[n] = last.x, y[0] = y[n] = last.y, z[0] = z[n] = last.z;
  double *const length = c.length.data(), *const each = c.each.data();
  double longest = 0.0;
  double *const u = c.unit[0].data(), *const v = c.unit[1].data(), *const w = c.unit[2].data();
  for (int32_t k = 0; k <= n; k++) {
    const double square = (x[k] * x[k] + y[k] * y[k]) + z[k] * z[k];
    longest = square > longest ? square : longest;
    length[k] = std::sqrt(square), each[k] = 1.0 / length[k];
    u[k] = each[k] * x[k], v[k] = each[k] * y[k], w[k] = each[k] * z[k];
  }
  const double spring = model.spring[begin], rest = model.bond_length[begin], kappa = model.bending[begin];
  const bool root = rest != 0.0 || (of_step && of_bends); // within a step, kinds with bends take the root, whatever l0
  double *const px = c.pull[0].data(), *const py = c.pull[1].data(), *const pz = c.pull[2].data();
  for (int32_t k = 0; k <= n; k++) {
    const double size = root ? spring * (length[k] - rest) : spring;
    px[k] = size * (root ? u[k] : x[k]), py[k] = size * (root ? v[k] : y[k]), pz[k] = size * (root ? w[k] : z[k]);
  }
  for (int32_t k = 0; k < n && of_bends; k++) {
    const Vector u0 = {u[k], v[k], w[k]}, u1 = {u[k + 1], v[k + 1], w[k + 1]};
    const double cosine = dot(u0, u1);
    const Vector before = (-kappa * each[k]) * (u1 - cosine * u0), after = (kappa * each[k + 1]) * (u0 - cosine * u1);
    c.a[0][k] = before.x, c.a[1][k] = before.y, c.a[2][k] = before.z;
    c.b[0][k] = after.x, c.b[1][k] = after.y, c.b[2][k] = after.z;
  }
  return longest;
}

// In the order of the contract: the constant force, bonds, bends.
void Fibers::add_forces(int32_t begin, int32_t end, const Columns &c, int parts, std::vector<Vector> &force) const
{
  for (int32_t j = begin; j < end; j++)
    force[j] = parts == ALL_FORCES ? model.constant_force[j] : Vector{0, 0, 0};
  for (int32_t j = begin; j < end && (parts & BONDS); j++) {
    const int32_t next = model.next[j];
    if (next < 0)
      continue;
    const Vector pull = Columns::at(c.pull, j - begin + 1);
    force[j] = force[j] + pull;
    force[next] = force[next] - pull;
  }
  for (int32_t j = begin; j < end && (parts & BENDS) && model.bending[begin] != 0.0; j++) {
    const int32_t prev = model.prev[j], next = model.next[j];
    if (prev < 0 || next < 0)
      continue;
    const Vector a = Columns::at(c.a, j - begin), b = Columns::at(c.b, j - begin);
    force[prev] = force[prev] + a;
    force[next] = force[next] + b;
    force[j] = force[j] - (a + b);
  }
}

void Fibers::forces(const std::vector<Point> &position, int parts, std::vector<Vector> &force) const
{
  force.resize(position.size());
  double longest = 0.0;
#pragma omp parallel reduction(max : longest)
  {
    Columns columns;
#pragma omp for schedule(static)
    for (size_t k = 0; k < first.size() - 1; k++) {
      longest = std::max(longest, fill(first[k], first[k + 1], position, parts == ALL_FORCES, columns));
      add_forces(first[k], first[k + 1], columns, parts, force);
    }
  }
  const double limit = 0.5 * (double)std::min({model.cells[0], model.cells[1], model.cells[2]});
  if (parts == ALL_FORCES && longest > limit * limit)
    throw Stopped("a bond is longer than half the shortest edge");
}

void Fibers::kick(double time, const std::vector<Vector> &force, std::vector<Vector> &velocity) const
{
#pragma omp parallel for schedule(static)
  for (size_t j = 0; j < velocity.size(); j++)
    velocity[j] = velocity[j] + (time * inverse_mass[j]) * force[j];
}

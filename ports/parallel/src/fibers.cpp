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

// Bonds and bends of one fiber in columns, which compilers turn into vector instructions where `omp simd` says that columns
// do not overlap. Bond k + 1 is that of the
// fiber's vertex k; bond 0 is that of the vertex before the first one, in rings. Loops end with whole vectors; what is beyond
// the last bond is not used.
class Fibers::Columns
{
public:
  enum Name { X, Y, Z, UNIT_X, UNIT_Y, UNIT_Z, LENGTH, EACH, PULL_X, PULL_Y, PULL_Z, A_X, A_Y, A_Z, B_X, B_Y, B_Z, NAMES };

  void resize(int32_t bonds)
  {
    length = bonds + 8;
    numbers.resize((size_t)NAMES * (size_t)length, 0.0);
  }
  double *of(int name)
  {
    return numbers.data() + (ptrdiff_t)name * length;
  }
  // Three columns from this one on.
  Vector at(int name, int32_t k) const
  {
    const double *const x = numbers.data() + (ptrdiff_t)name * length + k;
    return {x[0], x[length], x[2 * length]};
  }
  int32_t length = 0;

private:
  std::vector<double> numbers;
};

// Returns the square of the longest bond.
double Fibers::fill(int32_t begin, int32_t end, const std::vector<Point> &position, bool of_step, Columns &c) const
{
  const int32_t n = end - begin;
  const bool ring = model.prev[begin] >= 0, of_bends = model.bending[begin] != 0.0;
  c.resize(n + 1);
  double *const x = c.of(c.X), *const y = c.of(c.Y), *const z = c.of(c.Z);
  for (int32_t k = 0; k < n - 1; k++) {
    const Vector r = in_a0(position[begin + k + 1] - position[begin + k]);
    x[k + 1] = r.x, y[k + 1] = r.y, z[k + 1] = r.z;
  }
  const Vector last = ring ? in_a0(position[begin] - position[end - 1]) : Vector{0, 0, 0};
  x[0] = x[n] = last.x, y[0] = y[n] = last.y, z[0] = z[n] = last.z;
  for (int32_t k = n + 1; k < c.length; k++)
    x[k] = y[k] = z[k] = 0.0;
  const double spring = model.spring[begin], rest = model.bond_length[begin], kappa = model.bending[begin];
  const bool root = rest != 0.0 || (of_step && of_bends); // within a step, kinds with bends take the root, whatever l0
  double *const length = c.of(c.LENGTH), *const each = c.of(c.EACH);
  double *const u = c.of(c.UNIT_X), *const v = c.of(c.UNIT_Y), *const w = c.of(c.UNIT_Z);
  double *const px = c.of(c.PULL_X), *const py = c.of(c.PULL_Y), *const pz = c.of(c.PULL_Z);
  const int32_t begin_at = ring ? 0 : 1, end_at = begin_at + ((ring ? n + 1 : n - 1) + 3) / 4 * 4;
#pragma omp simd
  for (int32_t k = begin_at; k < end_at; k++) {
    length[k] = std::sqrt((x[k] * x[k] + y[k] * y[k]) + z[k] * z[k]);
    each[k] = 1.0 / length[k];
    u[k] = each[k] * x[k], v[k] = each[k] * y[k], w[k] = each[k] * z[k];
  }
  double longest[4] = {0.0, 0.0, 0.0, 0.0}; // squares: the limit is one, and a root could be rounded to it
  for (int32_t k = begin_at; k < end_at; k += 4)
    for (int lane = 0; lane < 4; lane++) {
      const int32_t m = k + lane;
      const double square = (x[m] * x[m] + y[m] * y[m]) + z[m] * z[m];
      longest[lane] = square > longest[lane] ? square : longest[lane];
    }
  const double *const dx = root ? u : x, *const dy = root ? v : y, *const dz = root ? w : z;
#pragma omp simd
  for (int32_t k = begin_at; k < end_at; k++) {
    const double size = root ? spring * (length[k] - rest) : spring;
    px[k] = size * dx[k], py[k] = size * dy[k], pz[k] = size * dz[k];
  }
  double *const ax = c.of(c.A_X), *const ay = c.of(c.A_Y), *const az = c.of(c.A_Z);
  double *const bx = c.of(c.B_X), *const by = c.of(c.B_Y), *const bz = c.of(c.B_Z);
  const int32_t last_at = of_bends ? begin_at + ((ring ? n : n - 2) + 3) / 4 * 4 : 0;
#pragma omp simd
  for (int32_t k = begin_at; k < last_at; k++) {
    const Vector u0 = {u[k], v[k], w[k]}, u1 = {u[k + 1], v[k + 1], w[k + 1]};
    const double cosine = dot(u0, u1);
    const Vector before = (-kappa * each[k]) * (u1 - cosine * u0), after = (kappa * each[k + 1]) * (u0 - cosine * u1);
    ax[k] = before.x, ay[k] = before.y, az[k] = before.z;
    bx[k] = after.x, by[k] = after.y, bz[k] = after.z;
  }
  if (of_bends && !ring) // lines have no bend at their ends; -0.0 changes no number that it is added to
    ax[n - 1] = ay[n - 1] = az[n - 1] = bx[0] = by[0] = bz[0] = -0.0;
  return std::max(std::max(longest[0], longest[1]), std::max(longest[2], longest[3]));
}

// In the order of the contract: the constant force, bonds, bends, each from the first vertex on.
void Fibers::add_forces(int32_t begin, int32_t end, const Columns &c, int parts, std::vector<Vector> &force) const
{
  const int32_t n = end - begin, last = n - 1;
  const bool ring = model.prev[begin] >= 0, bonds = (parts & BONDS) != 0,
             bends = (parts & BENDS) != 0 && model.bending[begin] != 0.0;
  const auto pull = [&](int32_t k) { return c.at(c.PULL_X, k + 1); };
  const auto before = [&](int32_t k) { return c.at(c.A_X, k); };
  const auto after = [&](int32_t k) { return c.at(c.B_X, k); };
  Vector *const f = force.data() + begin;
  for (int32_t k = 0; k < n; k++)
    f[k] = parts == ALL_FORCES ? model.constant_force[begin + k] : Vector{0, 0, 0};
  for (int32_t k = 1; k < last && bonds; k++)
    f[k] = (f[k] - pull(k - 1)) + pull(k);
  for (int32_t k = 1; k < last && bends; k++)
    f[k] = ((f[k] + after(k - 1)) - (before(k) + after(k))) + before(k + 1);
  if (bonds && n > 1) {
    f[0] = f[0] + pull(0), f[last] = f[last] - pull(last - 1);
    if (ring)
      f[last] = f[last] + pull(last), f[0] = f[0] - pull(last);
  }
  if (bends && ring) {
    f[0] = ((f[0] - (before(0) + after(0))) + before(1)) + after(last);
    f[last] = ((f[last] + before(0)) + after(last - 1)) - (before(last) + after(last));
  } else if (bends && n > 2) {
    f[0] = f[0] + before(1), f[last] = f[last] + after(last - 1);
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

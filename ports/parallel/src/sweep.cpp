#include "sweep.h"

#include <algorithm>
#include <tuple>

#include "flight.h"
#include "stopped.h"

constexpr double usual_skin = 0.3, margin = 1e-4;

/* --- the test --------------------------------------------------------------------------------------------------- */

// h 2^64 + l of the absolute value, each rounded.
static double rounded(const Wide &n)
{
  const bool negative = n.high < 0;
  const Whole high = negative ? -n.high - (n.low != 0) : n.high;
  const uint64_t low = negative ? 0 - n.low : n.low;
  const double value = (double)high * 0x1p64 + (double)low;
  return negative ? -value : value;
}

// (p x q).r, with the exact sign.
static double determinant(Point whole_p, Point whole_q, Point whole_r)
{
  const Vector p = as_vector(whole_p), q = as_vector(whole_q), r = as_vector(whole_r);
  const auto size_of = [](double a, double b, double c, double d) { return std::fabs(a * b) + std::fabs(c * d); };
  const double value = (r.x * (p.y * q.z - p.z * q.y) + r.y * (p.z * q.x - p.x * q.z)) + r.z * (p.x * q.y - p.y * q.x);
  const double size = (std::fabs(r.x) * size_of(p.y, q.z, p.z, q.y) + std::fabs(r.y) * size_of(p.z, q.x, p.x, q.z)) +
                      std::fabs(r.z) * size_of(p.x, q.y, p.y, q.x);
  return std::fabs(value) > 16.0 * 0x1p-53 * size ? value : rounded(exact_volume(whole_p, whole_q, whole_r));
}

static double clamp(double x)
{
  return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
}

static Vector normal_along(Vector p, Vector q, Vector step)
{
  Vector n = cross(p, q);
  if (n.x == 0.0 && n.y == 0.0 && n.z == 0.0)
    n = step - (dot(step, q) / dot(q, q)) * q;
  n = (1.0 / std::sqrt(dot(n, n))) * n;
  return dot(n, step) < 0.0 ? -n : n;
}

bool crosses(const CrossingTest &t, CrossingHit &hit)
{
  const auto negative = [&](double volume) { return volume < 0.0 || (t.flip && volume == 0.0); };
  const Point bond = t.b - t.a, pivot = t.pivot - t.a, from = t.from - t.a, to = t.to - t.a;
  const double before = determinant(bond, pivot, from), after = determinant(bond, pivot, to);
  if (negative(before) == negative(after) || (determinant(bond, from, to) < 0.0) != negative(before))
    return false;
  const Point whole_step = t.to - t.from, moving = t.pivot - t.from;
  if ((determinant(whole_step, moving, t.a - t.from) < 0.0) == (determinant(whole_step, moving, t.b - t.from) < 0.0))
    return false;
  hit.time = clamp(before / (before - after));
  const Vector step = in_a0(whole_step), at = in_a0(from) + hit.time * step, p = in_a0(pivot) - at, q = in_a0(bond);
  const double a = dot(p, p), b = dot(p, q), c = dot(q, q), d = dot(p, at), e = dot(q, at);
  const double below = a * c - b * b;
  hit.s = below > 0.0 ? clamp((b * e - c * d) / below) : 0.5;
  hit.s_standing = below > 0.0 ? clamp((a * e - b * d) / below) : 0.5;
  hit.normal = normal_along(p, q, step);
  return true;
}

double exchange_momentum(Vector velocity[4], const double mass[4], double s, double s_standing, Vector normal)
{
  const double lever[4] = {1.0 - s, s, s_standing - 1.0, -s_standing};
  double approach = 0.0, inertia = 0.0;
  for (int k = 0; k < 4; k++) {
    approach += lever[k] * dot(velocity[k], normal);
    inertia += (lever[k] * lever[k]) * (1.0 / mass[k]);
  }
  const double momentum = 2.0 * approach / inertia;
  for (int k = 0; k < 4; k++)
    velocity[k] = velocity[k] - ((lever[k] * momentum) * (1.0 / mass[k])) * normal;
  return momentum;
}

/* --- moves ------------------------------------------------------------------------------------------------------ */

static bool first_in_time(const SweepRow &a, const SweepRow &b)
{
  return std::make_tuple(a.hit.time, a.moving, a.standing, a.image[0], a.image[1], a.image[2]) <
         std::make_tuple(b.hit.time, b.moving, b.standing, b.image[0], b.image[1], b.image[2]);
}

void Sweep::hits_of_bond(int32_t vertex, int32_t moving, Point to, const std::vector<Point> &position,
                         std::vector<SweepRow> &hits) const
{
  const bool flip = moving == vertex;
  const int32_t pivot = flip ? model.next[(size_t)vertex] : moving;
  const int32_t other_pivot = flip ? model.prev[(size_t)vertex] : model.next[(size_t)vertex];
  const Point edge = model.edge();
  for (int32_t k = list.first[(size_t)moving]; k < list.first[(size_t)moving + 1]; k++) {
    const Near &near = list.near[(size_t)k];
    const int32_t a = near.other, b = model.next[(size_t)a];
    const bool home = near.image[0] == 0 && near.image[1] == 0 && near.image[2] == 0;
    if (model.exclusion_paper && home && (a == other_pivot || b == other_pivot))
      continue;
    const Point shift = {near.image[0] * edge.x, near.image[1] * edge.y, near.image[2] * edge.z};
    const CrossingTest test = {position[(size_t)vertex],    to,  position[(size_t)pivot], position[(size_t)a] + shift,
                               position[(size_t)b] + shift, flip};
    CrossingHit hit;
    if (crosses(test, hit))
      hits.push_back({vertex, moving, a, {near.image[0], near.image[1], near.image[2]}, false, hit, 0.0});
  }
}

void Sweep::hits_of(int32_t vertex, Point to, const std::vector<Point> &position, std::vector<SweepRow> &hits) const
{
  hits.clear();
  for (const int32_t moving : {model.prev[(size_t)vertex], vertex})
    if (moving >= 0 && model.next[(size_t)moving] >= 0)
      hits_of_bond(vertex, moving, to, position, hits);
  std::sort(hits.begin(), hits.end(), first_in_time);
}

void Sweep::execute(SweepRow &row, std::vector<Vector> &velocity) const
{
  const int32_t pivot = row.moving == row.vertex ? model.next[(size_t)row.vertex] : row.moving;
  const int32_t of[4] = {row.vertex, pivot, row.standing, model.next[(size_t)row.standing]};
  Vector v[4];
  double mass[4];
  for (int k = 0; k < 4; k++)
    v[k] = velocity[(size_t)of[k]], mass[k] = model.mass[(size_t)of[k]];
  row.momentum = exchange_momentum(v, mass, row.hit.s, row.hit.s_standing, row.hit.normal);
  row.executed = true;
  for (int k = 0; k < 4; k++)
    velocity[(size_t)of[k]] = v[k];
}

void Sweep::move(double time, const std::vector<uint32_t> &order, std::vector<Point> &position,
                 std::vector<Vector> &velocity, std::vector<SweepRow> *rows)
{
  const double limit = 0.5 * (double)std::min({model.cells[0], model.cells[1], model.cells[2]});
  if (model.forbidden && !list.built)
    list.build(position, usual_skin);
  std::vector<SweepRow> hits;
  for (const uint32_t vertex : order) {
    const Point here = position[vertex], to = here + nearest(lattice_per_a0 * (time * velocity[vertex]));
    const Vector way = in_a0(to - here);
    if (dot(way, way) >= limit * limit)
      throw Stopped("a vertex would move by half the shortest edge or more");
    if (model.forbidden) {
      if (2.0 * std::sqrt(list.moved((int32_t)vertex, to)) + margin > list.skin)
        list.build(position, std::max(usual_skin, 3.0 * std::sqrt(dot(way, way)) + margin));
      hits_of((int32_t)vertex, to, position, hits);
    }
    if (hits.empty()) {
      position[vertex] = to;
      continue;
    }
    execute(hits[0], velocity);
    possible += (int64_t)hits.size(), executed++, negative += hits[0].momentum < 0.0;
    if (rows)
      rows->insert(rows->end(), hits.begin(), hits.end());
  }
}

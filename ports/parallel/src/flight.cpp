#include "flight.h"

#include <algorithm>

struct Normal {
  Whole x, y, z;
};

static Normal exact_cross(Point a, Point b)
{
  return {(Whole)a.y * b.z - (Whole)a.z * b.y, (Whole)a.z * b.x - (Whole)a.x * b.z,
          (Whole)a.x * b.y - (Whole)a.y * b.x};
}

static Wide exact_dot(const Normal &n, Point c)
{
  const Whole high = (n.x >> 64) * c.x + (n.y >> 64) * c.y + (n.z >> 64) * c.z;
  const Whole low = (Whole)(uint64_t)n.x * c.x + (Whole)(uint64_t)n.y * c.y + (Whole)(uint64_t)n.z * c.z;
  return {high + (low >> 64), (uint64_t)low};
}

static int sign_of(const Wide &n)
{
  return n.high < 0 ? -1 : n.high > 0 || n.low > 0 ? 1 : 0;
}

static Wide operator+(const Wide &a, const Wide &b)
{
  const uint64_t low = a.low + b.low;
  return {a.high + b.high + (low < a.low), low};
}

Wide exact_volume(Point a, Point b, Point c)
{
  return exact_dot(exact_cross(a, b), c);
}

int sign_of_volume(Point a, Point b, Point c)
{
  return sign_of(exact_volume(a, b, c));
}

namespace
{
struct Three {
  Point p, q, w;
};
} // namespace

static Three at(const Flight3 &f, int64_t tick)
{
  return {at_tick(f.p, f.p_rate, tick), at_tick(f.q, f.q_rate, tick), at_tick(f.w, f.w_rate, tick)};
}

/* --- in doubles: what is certain -------------------------------------------------------------------------------- */

// Volumes of differences below `size` each have errors below this times size cubed. Each of the six products of a
// volume is rounded thrice, sums five times, and differences of up to 2^55 once before: 10 roundings of 2^-53 each.
constexpr double volume_error = 6 * 3 * 12 * 0x1p-53;

static double size_of(Point a)
{
  return (double)std::max({std::llabs(a.x), std::llabs(a.y), std::llabs(a.z)});
}

// Condition (i) for certain.
static bool certainly_keeps_side(const Three &a, const Three &b)
{
  const Vector p = as_vector(a.p), q = as_vector(a.q), w = as_vector(a.w);
  const Vector p1 = as_vector(b.p), q1 = as_vector(b.q), w1 = as_vector(b.w);
  const Vector pq = cross(p, q), pq1 = cross(p1, q1), mixed = cross(p1, q) + cross(p, q1);
  const double v0 = dot(pq, w), v1 = dot(mixed, w) + dot(pq, w1), v2 = dot(pq1, w) + dot(mixed, w1), v3 = dot(pq1, w1);
  const double bound = volume_error * std::max(size_of(a.p), size_of(b.p)) * std::max(size_of(a.q), size_of(b.q)) *
                       std::max(size_of(a.w), size_of(b.w));
  return (v0 > bound && v1 > bound && v2 > bound && v3 > bound) ||
         (v0 < -bound && v1 < -bound && v2 < -bound && v3 < -bound);
}

static double clamp(double x)
{
  return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
}

// A direction along which the bonds are apart, if they are: between nearest points.
static Vector gap_between(Vector p, Vector q, Vector w)
{
  const double pp = dot(p, p), qq = dot(q, q), pq = dot(p, q), pw = dot(p, w), qw = dot(q, w);
  const double nn = pp * qq - pq * pq;
  double s = nn > 0.0 ? clamp((pw * qq - pq * qw) / nn) : 0.5;
  const double t = qq > 0.0 ? clamp((s * pq - qw) / qq) : 0.0;
  s = pp > 0.0 ? clamp((t * pq + pw) / pp) : 0.0;
  return (w + t * q) - s * p;
}

// Condition (ii) for certain, with the plane across the gap at the middle.
static bool certainly_apart(const Three &a, const Three &b)
{
  const Vector p = as_vector(a.p), q = as_vector(a.q), w = as_vector(a.w);
  const Vector p1 = as_vector(b.p), q1 = as_vector(b.q), w1 = as_vector(b.w);
  const Vector n = gap_between(0.5 * (p + p1), 0.5 * (q + q1), 0.5 * (w + w1));
  const auto least = [&](Vector pp, Vector qq, Vector ww) {
    return dot(n, ww) + std::min(0.0, dot(n, qq)) - std::max(0.0, dot(n, pp));
  };
  const double size = size_of(a.p) + size_of(b.p) + size_of(a.q) + size_of(b.q) + size_of(a.w) + size_of(b.w);
  const double bound = 32 * 0x1p-53 * (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z)) * size;
  return least(p, q, w) > bound && least(p1, q1, w1) > bound;
}

/* --- exactly, for a single tick ------------------------------------------------------------------------------------
 */

static bool keeps_side(const Three &a, const Three &b)
{
  const int side = sign_of_volume(a.p, a.q, a.w);
  if (side == 0 || side != sign_of_volume(b.p, b.q, b.w))
    return false;
  const Wide first = exact_volume(b.p, a.q, a.w) + exact_volume(a.p, b.q, a.w) + exact_volume(a.p, a.q, b.w);
  const Wide second = exact_volume(b.p, b.q, a.w) + exact_volume(b.p, a.q, b.w) + exact_volume(a.p, b.q, b.w);
  return side == sign_of(first) && side == sign_of(second);
}

static bool is_zero(const Normal &n)
{
  return n.x == 0 && n.y == 0 && n.z == 0;
}

static int sign_of(Whole x)
{
  return (x > 0) - (x < 0);
}

static Whole whole_dot(Point a, Point b)
{
  return (Whole)a.x * b.x + (Whole)a.y * b.y + (Whole)a.z * b.z;
}

// The points of a plane through the origin lie strictly on one side of a line in it: one of them sees all others on its
// left, or straight ahead. d x c is along n, so one component of it tells its sense.
static bool on_one_side(const Point *point, int count, const Normal &n)
{
  const auto component = [&](const Normal &m) { return n.x != 0 ? m.x : n.y != 0 ? m.y : m.z; };
  const int sense = sign_of(component(n));
  for (int d = 0; d < count; d++) {
    bool all = true;
    for (int c = 0; c < count && all; c++) {
      const int turn = sense * sign_of(component(exact_cross(point[d], point[c])));
      all = turn > 0 || (turn == 0 && whole_dot(point[d], point[c]) > 0);
    }
    if (all)
      return true;
  }
  return count == 0;
}

// Condition (ii).
static bool has_plane(const Point *point)
{
  bool one_line = true;
  for (int a = 0; a < 8; a++)
    for (int b = a + 1; b < 8; b++) {
      const Normal n = exact_cross(point[a], point[b]);
      if (is_zero(n))
        continue;
      one_line = false;
      Point within[8];
      int count = 0, side = 0;
      bool decides = true;
      for (int c = 0; c < 8 && decides; c++) {
        const int sign = sign_of(exact_dot(n, point[c]));
        if (sign == 0)
          within[count++] = point[c];
        decides = sign == 0 || side == 0 || sign == side;
        side = sign != 0 ? sign : side;
      }
      if (decides)
        return on_one_side(within, count, n);
    }
  bool ahead = one_line;
  for (int c = 0; c < 8 && ahead; c++)
    ahead = whole_dot(point[0], point[c]) > 0;
  return ahead;
}

static bool excluded_tick(const Three &a, const Three &b)
{
  if (keeps_side(a, b))
    return true;
  const Point point[8] = {a.w, a.w + a.q, a.w - a.p, a.w + a.q - a.p, b.w, b.w + b.q, b.w - b.p, b.w + b.q - b.p};
  return has_plane(point);
}

static int64_t search(const Flight3 &f, int64_t from, const Three &a, int64_t to, const Three &b)
{
  if (certainly_keeps_side(a, b) || certainly_apart(a, b))
    return ticks;
  if (to - from == 1)
    return excluded_tick(a, b) ? ticks : from;
  const int64_t middle = (from + to) / 2;
  const Three m = at(f, middle);
  const int64_t first = search(f, from, a, middle, m);
  return first < ticks ? first : search(f, middle, m, to, b);
}

int64_t first_contact(const Flight3 &f, int64_t from)
{
  const auto still = [](Point rate) { return rate.x == 0 && rate.y == 0 && rate.z == 0; };
  if (from >= ticks || (still(f.p_rate) && still(f.q_rate) && still(f.w_rate)))
    return ticks;
  return search(f, from, at(f, from), ticks, at(f, ticks));
}

#include "contact/hull.h"

/* A minor: sign of the cross product of two points along each axis. */
struct signs {
  int x, y, z;
};

static int sign_of(int128 x)
{
  return (x > 0) - (x < 0);
}

static struct signs cross_signs(struct difference a, struct difference b)
{
  return (struct signs){sign_of((int128)a.y * b.z - (int128)a.z * b.y), sign_of((int128)a.z * b.x - (int128)a.x * b.z),
                        sign_of((int128)a.x * b.y - (int128)a.y * b.x)};
}

static bool is_zero(struct signs s)
{
  return s.x == 0 && s.y == 0 && s.z == 0;
}

/* Of two cross products along one line: 1 if they point the same way, -1 if not, 0 if the first is zero. */
static int alike(struct signs s, struct signs n)
{
  return n.x != 0 ? s.x * n.x : n.y != 0 ? s.y * n.y : s.z * n.z;
}

static int along(struct difference a, struct difference b)
{
  return sign_of((int128)a.x * b.x + (int128)a.y * b.y + (int128)a.z * b.z);
}

static int volume_sign(struct difference a, struct difference b, struct difference c)
{
  const double value = exact_determinant(a, b, c);
  return (value > 0.0) - (value < 0.0);
}

/* The points of the plane with the normal n, those of `within`: true if a line through the origin has all of them
 * strictly on one side. Then one of them is the first when seen from the origin: all others lie on one side of it. */
static bool line_separates(const struct difference point[HULL_POINTS], const bool within[HULL_POINTS], struct signs n)
{
  for (int a = 0; a < HULL_POINTS; a++) {
    bool first = within[a];
    for (int k = 0; k < HULL_POINTS && first; k++) {
      const int side = within[k] ? alike(cross_signs(point[a], point[k]), n) : 1;
      first = side > 0 || (side == 0 && along(point[a], point[k]) > 0);
    }
    if (first)
      return true;
  }
  return false;
}

/* True if no points lie on both sides of the plane through the origin and points i and j. within: those in it. */
static bool plane_supports(const struct difference point[HULL_POINTS], int i, int j, bool within[HULL_POINTS])
{
  int side = 0;
  for (int k = 0; k < HULL_POINTS; k++) {
    const int sign = k == i || k == j ? 0 : volume_sign(point[i], point[j], point[k]);
    if (sign * side < 0)
      return false;
    within[k] = sign == 0;
    side = sign != 0 ? sign : side;
  }
  return true;
}

/* If a plane has all points strictly on one side, it can be turned about the origin until it touches two of them; those
 * in the plane then lie on one side of a line in it. If they do not, no plane has all on one side. So the first plane
 * that supports the points decides. */
bool hull_misses_origin(const struct difference point[HULL_POINTS])
{
  bool within[HULL_POINTS];
  for (int i = 0; i < HULL_POINTS; i++)
    for (int j = 0; j < i; j++) {
      const struct signs n = cross_signs(point[i], point[j]);
      if (!is_zero(n) && plane_supports(point, i, j, within))
        return line_separates(point, within, n);
    }
  for (int k = 0; k < HULL_POINTS; k++) /* all on one line, or no such plane */
    if (!is_zero(cross_signs(point[0], point[k])) || along(point[0], point[k]) <= 0)
      return false;
  return true;
}

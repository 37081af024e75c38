// What a flight does at the edges of the box, and which particles a collision sees as their images there.
// docs/port/flow.md. A border flies a particle, lets it `enter` a collision and `leave` it.
#pragma once

#include "device.h"
#include "flow.h"

// A flight of given time: v t + ((0.5 a) t) t, and a t; -0.0, which changes no number, where there is none.
struct Flight {
  double time;
  Vector fall, gain;
};

inline Flight flight_of(Vector a, double time)
{
  const auto gain = [=](double along) { return along * time != 0.0 ? time * along : -0.0; };
  return {time, time * (time * (0.5 * a)), {gain(a.x), gain(a.y), gain(a.z)}};
}

ANYWHERE int64_t fold(int64_t x, int64_t edge)
{
  if (x < 0)
    x += edge;
  else if (x >= edge)
    x -= edge;
  if (x < 0 || x >= edge) {
    x %= edge;
    x += x < 0 ? edge : 0;
  }
  return x;
}

ANYWHERE Point flown(const Flight &flight, Point p, Vector v)
{
  return p + nearest(lattice_per_a0 * (flight.time * v + flight.fall));
}

struct Periodic {
  Point edge;

  ANYWHERE void fly(const Flight &flight, Point &p, Vector &v, int) const
  {
    p = flown(flight, p, v);
    p = {fold(p.x, edge.x), fold(p.y, edge.y), fold(p.z, edge.z)};
    v = v + flight.gain;
  }
  ANYWHERE void enter(Point &, Vector &) const
  {
  }
  ANYWHERE void leave(Point &, Vector &) const
  {
  }
};

// Of a collision in a sheared box: the grid's shift along y, the image's offset and speed.
struct Image {
  int64_t shift = 0, offset = 0;
  double speed = 0;
};

struct Sheared {
  Point edge;
  Image next, last; // of the collision at the end of the flight, and of that before it
  bool kicks;       // of an oscillating shear, whose rate changes after the last collision
  double change;

  ANYWHERE void fly(const Flight &flight, Point &p, Vector &v, int) const
  {
    p = flown(flight, p, v);
    v = v + flight.gain;
    int64_t image = p.y / edge.y;
    image -= p.y < image * edge.y;
    p = {fold(fold(p.x, edge.x) - image * next.offset, edge.x), p.y - image * edge.y, fold(p.z, edge.z)};
    if (image != 0)
      v.x -= (double)image * next.speed;
  }
  ANYWHERE void enter(Point &p, Vector &v) const
  {
    if (p.y + next.shift >= edge.y)
      p.x = fold(p.x - next.offset, edge.x), v.x -= next.speed;
  }
  ANYWHERE void leave(Point &p, Vector &v) const
  {
    if (p.y + last.shift >= edge.y)
      p.x = fold(p.x + last.offset, edge.x), v.x += last.speed;
    if (kicks)
      v.x += affine(p.y);
  }
  ANYWHERE double affine(int64_t y) const
  {
    return ((double)(y - edge.y / 2) * lattice_unit) * change;
  }
};

// Numbers of a wall's account, of each thread of the host: three of each wall by hits, three of each by collisions.
constexpr int account_numbers = 12, account_stride = 16;

struct Walled {
  Point edge;
  Vector acceleration; // none along y
  WallPair wall;
  bool slip;
  int64_t *given; // to the walls' account

  BODY void fly(const Flight &flight, Point &p, Vector &v, int shard) const
  {
    const int64_t d = nearest(lattice_per_a0 * (v.y * flight.time)), y = p.y + d;
    if (y < 0 || y > edge.y) {
      rebound(flight, d, p, v, shard);
      return;
    }
    along(flight, p, v);
    p.y = y;
  }
  BODY void enter(Point &, Vector &) const
  {
  }
  BODY void leave(Point &, Vector &) const
  {
  }

private:
  BODY void along(const Flight &flight, Point &p, Vector &v) const
  {
    const Point to = flown(flight, p, v);
    p.x = fold(to.x, edge.x), p.z = fold(to.z, edge.z);
    v.x = v.x + flight.gain.x, v.z = v.z + flight.gain.z;
  }

  // From wall to wall. Without slip the velocity is sign v + change.
  BODY void rebound(const Flight &flight, int64_t d, Point &p, Vector &v, int shard) const
  {
    double sign = 1.0;
    Vector change = {0, 0, 0}, moved = {0, 0, 0};
    const auto go_on = [&](double time) {
      moved = (moved + time * change) + ((0.5 * time) * time) * acceleration;
      change = change + time * acceleration;
    };
    bool down = d < 0;
    int64_t left = down ? -d : d, y = p.y, way = down ? y : edge.y - y;
    const double each = flight.time / (double)left;
    while (left > way) {
      go_on(each * (double)way);
      const int which = down ? 0 : 1;
      Vector gain = {0.0, -2.0 * sign * v.y, 0.0};
      if (!slip) {
        gain = 2.0 * (wall.at[which] - (change + sign * v));
        change = 2.0 * wall.at[which] - change;
      }
      give(shard, which, gain);
      sign = -sign;
      left -= way, y = down ? 0 : edge.y, way = edge.y, down = !down;
    }
    go_on(each * (double)left);
    const int64_t end = down ? y - left : y + left;
    if (slip) {
      along(flight, p, v);
      v.y = v.y * sign;
    } else {
      const Point to = nearest(lattice_per_a0 * (flight.time * ((double)(end - p.y) / (double)d) * v + moved));
      p.x = fold(p.x + to.x, edge.x), p.z = fold(p.z + to.z, edge.z);
      v = change + sign * v;
    }
    p.y = end;
  }

  BODY void give(int shard, int which, Vector gain) const
  {
    const Point whole = nearest(momentum_per_unit * gain);
    int64_t *const to = given + shard * account_stride + 3 * which;
    add_whole(to, whole.x), add_whole(to + 1, whole.y), add_whole(to + 2, whole.z);
  }
};

// Vectors, roundings, random numbers and elementary functions: docs/port/contract.md, "Arithmetic", docs/conventions.md,
// "Random numbers have addresses", docs/elementary.md. All of it runs on the host and on a GPU, with the same bits.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#ifdef __CUDACC__
#define ANYWHERE __host__ __device__ inline
#else
#define ANYWHERE inline
#endif

struct Vector {
  double x, y, z;
};

struct Point {
  int64_t x, y, z;
};

constexpr double lattice_per_a0 = 0x1p40, lattice_unit = 0x1p-40;
constexpr double momentum_per_unit = 0x1p44, mass_per_unit = 0x1p16, energy_per_unit = 0x1p32;

ANYWHERE Vector operator+(Vector a, Vector b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
ANYWHERE Vector operator-(Vector a, Vector b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
ANYWHERE Vector operator-(Vector a)
{
  return {-a.x, -a.y, -a.z};
}
ANYWHERE Vector operator*(double s, Vector a)
{
  return {s * a.x, s * a.y, s * a.z};
}
ANYWHERE double dot(Vector a, Vector b)
{
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
ANYWHERE Vector cross(Vector a, Vector b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

ANYWHERE Point operator+(Point a, Point b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
ANYWHERE Point operator-(Point a, Point b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
ANYWHERE Point operator*(int64_t s, Point a)
{
  return {s * a.x, s * a.y, s * a.z};
}
ANYWHERE Vector as_vector(Point a)
{
  return {(double)a.x, (double)a.y, (double)a.z};
}
ANYWHERE Vector in_a0(Point a)
{
  return lattice_unit * as_vector(a);
}

// To the nearest integer, ties to even.
ANYWHERE int64_t nearest(double x)
{
#ifdef __CUDA_ARCH__
  return __double2ll_rn(x);
#else
  return std::llrint(x);
#endif
}
ANYWHERE Point nearest(Vector a)
{
  return {nearest(a.x), nearest(a.y), nearest(a.z)};
}

ANYWHERE uint64_t bits_of(double x)
{
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

ANYWHERE double from_bits(uint64_t bits)
{
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

// "log x"
ANYWHERE double natural_log(double x)
{
  constexpr uint64_t one = 0x3ff0000000000000, root_half = 0x3fe6a09e667f3bcd;
  const uint64_t t = bits_of(x) + (one - root_half);
  const double e = (double)((int64_t)(t >> 52) - 1023);
  const double f = from_bits((t & 0x000fffffffffffff) + root_half) - 1.0;
  const double h = 0.5 * f * f, s = f / (2.0 + f), z = s * s, w = z * z;
  const double odd = 2.0 / 3 + w * (2.0 / 7 + w * (2.0 / 11 + w * (2.0 / 15 + w * (2.0 / 19))));
  const double even = 2.0 / 5 + w * (2.0 / 9 + w * (2.0 / 13 + w * (2.0 / 17 + w * (2.0 / 21))));
  const double rest = s * (h + (z * odd + w * even)) - h;
  const double whole = e * 0x1.62e42fefa38p-1, sum = whole + f, lost = (whole - sum) + f;
  return sum + (rest + (lost + e * 0x1.ef35793c7673p-45));
}

// "exp x", for x from -708 to 709
ANYWHERE double exponential(double x)
{
  const double turned = x * 0x1.71547652b82fep+0 + 0x1.8p52, n = turned - 0x1.8p52;
  const double near = x - n * 0x1.62e42fefa38p-1, rest = n * 0x1.ef35793c7673p-45;
  const double r = near - rest, lost = (near - r) - rest, w = r * r;
  const double even =
      1.0 / 2 + w * (1.0 / 24 + w * (1.0 / 720 + w * (1.0 / 40320 + w * (1.0 / 3628800 + w * (1.0 / 479001600)))));
  const double odd = 1.0 / 6 + w * (1.0 / 120 + w * (1.0 / 5040 +
                                                    w * (1.0 / 362880 + w * (1.0 / 39916800 + w * (1.0 / 6227020800.0)))));
  const double less_one = r + (lost + w * (even + r * odd));
  return (1.0 + less_one) * from_bits((bits_of(turned) + 1023) << 52);
}

struct CirclePoint {
  double cosine, sine;
};

// "Circle": the unit is high + low.
ANYWHERE CirclePoint circle(double t, double high, double low, int64_t quarters)
{
  const double t1 = from_bits(bits_of(t) & 0xfffffffff8000000), t2 = t - t1;
  const double exact = t1 * high, rest = t2 * high + t * low;
  const double x = exact + rest, lost = rest - (x - exact), z = x * x, w = z * z;
  const double s0 = -1.0 / 6 + w * (-1.0 / 5040 + w * (-1.0 / 39916800 + w * (-1.0 / 1307674368000.0)));
  const double s1 = 1.0 / 120 + w * (1.0 / 362880 + w * (1.0 / 6227020800.0 + w * (1.0 / 355687428096000.0)));
  const double along = x + (lost + x * (z * (s0 + z * s1)));
  const double c0 = 1.0 / 24 + w * (1.0 / 40320 + w * (1.0 / 479001600 + w * (1.0 / 20922789888000.0)));
  const double c1 = -1.0 / 720 + w * (-1.0 / 3628800 + w * (-1.0 / 87178291200.0));
  const double h = 0.5 * z, less = 1.0 - h;
  const double across = less + (((1.0 - less) - h) + (w * (c0 + z * c1) - x * lost));
  switch (quarters & 3) {
  case 0:
    return {across + 0.0, along + 0.0};
  case 1:
    return {-along + 0.0, across + 0.0};
  case 2:
    return {-across + 0.0, -along + 0.0};
  default:
    return {along + 0.0, -across + 0.0};
  }
}

ANYWHERE CirclePoint circle_turns(double turns)
{
  const double k = (4.0 * turns + 0x1.8p52) - 0x1.8p52;
  return circle(4.0 * turns - k, 0x1.921fb54p+0, 0x1.10b4611a62633p-30, (int64_t)k);
}

ANYWHERE CirclePoint circle_degrees(double angle)
{
  const double k = (angle / 90.0 + 0x1.8p52) - 0x1.8p52;
  return circle(angle - 90.0 * k, 0x1.1df46a4p-6, -0x1.ad62c6ea3e274p-34, (int64_t)k);
}

struct Words {
  uint32_t word[4];
};

enum Purpose : uint32_t {
  GRID_SHIFT = 1,
  ROTATION_AXIS = 2,
  VERTEX_ORDER = 3,
  VELOCITY_SWAP = 4,
  THERMOSTAT = 5,
  PHANTOM_NUMBER = 6,
  PHANTOM_VELOCITY = 7,
  DRAWN_PARTICLE = 8,
  DRAWN_VERTEX = 9,
  SOLVENT_POSITION = 16,
  SOLVENT_VELOCITY = 17,
};

// All of an address but entity and draw.
struct Source {
  uint64_t seed;
  uint32_t purpose;
  uint64_t step;
};

ANYWHERE uint32_t high_word(uint32_t a, uint32_t b)
{
  return (uint32_t)(((uint64_t)a * b) >> 32);
}

// Philox 4x32-10
ANYWHERE Words words_of(const Source &source, uint32_t draw, uint32_t entity)
{
  uint32_t c0 = entity, c1 = source.purpose + (draw << 8), c2 = (uint32_t)source.step,
           c3 = (uint32_t)(source.step >> 32);
  uint32_t k0 = (uint32_t)source.seed, k1 = (uint32_t)(source.seed >> 32);
  for (int round = 0; round < 10; round++) {
    const uint32_t h0 = high_word(0xD2511F53u, c0), l0 = 0xD2511F53u * c0;
    const uint32_t h1 = high_word(0xCD9E8D57u, c2), l1 = 0xCD9E8D57u * c2;
    c0 = h1 ^ c1 ^ k0, c1 = l1, c2 = h0 ^ c3 ^ k1, c3 = l0;
    k0 += 0x9E3779B9u, k1 += 0xBB67AE85u;
  }
  return {{c0, c1, c2, c3}};
}

ANYWHERE uint64_t integer_of(const Words &w, int k)
{
  return w.word[2 * k] | (uint64_t)w.word[2 * k + 1] << 32;
}
ANYWHERE double uniform_of(const Words &w, int k)
{
  return ((double)(integer_of(w, k) >> 12) + 0.5) * 0x1p-52;
}

ANYWHERE CirclePoint normal_pair(const Words &w)
{
  const double radius = std::sqrt(-2.0 * natural_log(uniform_of(w, 0)));
  const CirclePoint at = circle_turns(uniform_of(w, 1));
  return {radius * at.cosine, radius * at.sine};
}

// Marsaglia's axis: words 0, 1 of a draw, then words 2, 3, then the next draw.
ANYWHERE Vector axis_of(const Source &source, uint32_t entity, uint32_t draw = 0)
{
  for (;; draw++) {
    const Words w = words_of(source, draw, entity);
    for (int k = 0; k < 4; k += 2) {
      const double u = ((double)(int32_t)w.word[k] + 0.5) * 0x1p-31;
      const double v = ((double)(int32_t)w.word[k + 1] + 0.5) * 0x1p-31;
      const double q = u * u + v * v;
      if (q < 1.0) {
        const double root = std::sqrt(1.0 - q);
        return {2.0 * u * root, 2.0 * v * root, 1.0 - 2.0 * q};
      }
    }
  }
}

// "Three of one draw": -ln u of two words.
ANYWHERE double minus_log(uint32_t high, uint32_t low)
{
  constexpr uint64_t one = 0x3ff0000000000000, root_half = 0x3fe6a09e667f3bcd;
  const uint64_t fraction = (uint64_t)high << 20 | (uint64_t)(low & 0xff000000) >> 12;
  const double u = from_bits(one | fraction) - (1.0 - 0x1p-41);
  const uint64_t t = bits_of(u) + (one - root_half);
  const double e = (double)((int64_t)(t >> 52) - 1023);
  const double f = from_bits((t & 0x000fffffffffffff) + root_half) - 1.0;
  const double s = f / (2.0 + f), w = s * s, q = w * w;
  const double odd = 2.0 / 3 + q * (2.0 / 7 + q * (2.0 / 11));
  const double even = 2.0 + q * (2.0 / 5 + q * (2.0 / 9 + q * (2.0 / 13)));
  return -(e * 0x1.62e42fefa39efp-1) - s * (even + w * odd);
}

ANYWHERE Vector three_normals(const Words &words)
{
  constexpr double half_pi = 0x1.921fb54442d18p+0, pi = 0x1.921fb54442d18p+1;
  constexpr uint64_t one = 0x3ff0000000000000;
  const uint32_t w1 = words.word[1], w3 = words.word[3];
  const double a = (from_bits(one | (uint64_t)(w1 & 0x3fffff) << 30) - (1.5 - 0x1p-23)) * half_pi;
  const double w = a * a, q = w * w;
  const double sine = a * ((1.0 + q * (1.0 / 120 + q * (1.0 / 362880 + q * (1.0 / 6227020800.0)))) +
                           w * (-1.0 / 6 + q * (-1.0 / 5040 + q * (-1.0 / 39916800))));
  const double cosine = (1.0 + q * (1.0 / 24 + q * (1.0 / 40320 + q * (1.0 / 479001600)))) +
                        w * (-1.0 / 2 + q * (-1.0 / 720 + q * (-1.0 / 3628800)));
  const double root = std::sqrt(minus_log(words.word[0], w1));
  const double x = root * (cosine - sine), y = root * (cosine + sine);

  const double b = (from_bits(one | (uint64_t)(w3 & 0xffffff) << 28) - (1.5 - 0x1p-25)) * pi;
  const double bw = b * b, bq = bw * bw;
  const double e0 =
      1.0 + bq * (1.0 / 120 + bq * (1.0 / 362880 + bq * (1.0 / 6227020800.0 + bq * (1.0 / 355687428096000.0))));
  const double o0 = -1.0 / 6 + bq * (-1.0 / 5040 + bq * (-1.0 / 39916800 + bq * (-1.0 / 1307674368000.0)));
  const double z = std::sqrt(2.0 * minus_log(words.word[2], w3)) * (b * (e0 + bw * o0));
  return {w1 >> 23 & 1 ? -x : x, w1 >> 22 & 1 ? -y : y, z};
}

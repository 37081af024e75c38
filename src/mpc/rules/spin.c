#include "mpc/rules/spin.h"

#include "base/elementary.h"

/* The integer whose lowest 64 bits are these, and that is less than 2^63 from near 2^64. */
static spin_word whole_of(uint64_t low, double near)
{
  const int64_t high = llrint(near - (double)(low >> 12) * 0x1p-52);
  return (spin_word)(uint64_t)high << 64 | low;
}

void spin_widen(struct cell_spin *s)
{
  const struct spin_halves h = s->halves;
  const unsigned mass = 16; /* CELL_MASS_SCALE is 2^16 */
  for (int k = 0; k < 3; k++) {
    s->angular[k] = whole_of(h.angular[k], h.near_angular[k] * (CELL_MOMENTUM_SCALE * 0x1p-64));
    s->first[k] = (spin_word)(spin_wide)(int64_t)h.first[k] << mass;
  }
  for (int k = 0; k < 6; k++)
    s->second[k] = whole_of(h.second[k], h.near_second[k] * 0x1p-64) << mass;
}

/* A sum that is not negative as a double, to a relative 2^-51. The compiler's own conversion calls a function that
 * takes three times as long; a cell needs nine. */
static inline double size_in_double(spin_word size)
{
  return (double)(int64_t)(uint64_t)(size >> 64) * 0x1p64 +
         (double)(int64_t)(uint64_t)(size >> 32 & 0xffffffff) * 0x1p32 + (double)(int64_t)(uint64_t)(size & 0xffffffff);
}

/* The same of any sum. The sign is put on without a branch: nobody could predict it. */
static inline double in_double(spin_word sum)
{
  const uint64_t sign = 0 - (uint64_t)(sum >> 127);
  const spin_word wide = (spin_word)(spin_wide)(int64_t)sign, size = (sum ^ wide) - wide;
  return elementary_from_bits(elementary_bits(size_in_double(size)) | (sign & 0x8000000000000000));
}

/* The same of a sum whose size is below 2^85, correctly rounded, as in_double's then is. */
static inline double first_in_double(spin_word sum)
{
  return (double)(int64_t)(uint64_t)(sum >> 32) * 0x1p32 + (double)(int64_t)(uint64_t)(sum & 0xffffffff);
}

/* All members on a line along the largest column of C: its only eigenvalue but 0 is the trace. */
static struct vec3 rate_of_line(const double c[6], double trace, struct vec3 l)
{
  const struct vec3 column[3] = {{c[0], c[5], c[4]}, {c[5], c[1], c[3]}, {c[4], c[3], c[2]}};
  int k = 0;
  for (int j = 1; j < 3; j++)
    k = c[j] > c[k] ? j : k;
  const struct vec3 e = vec3_scale(1.0 / vec3_norm(column[k]), column[k]);
  return vec3_scale(1.0 / trace, vec3_add_scaled(l, -vec3_dot(e, l), e));
}

/* Where one eigenvalue is far below the others, it is the determinant over the sum of the principal minors. */
struct vec3 spin_rate(const double c[6], struct vec3 l)
{
  const double trace = c[0] + c[1] + c[2];
  const double xx = c[1] + c[2], yy = c[2] + c[0], zz = c[0] + c[1], yz = -c[3], zx = -c[4], xy = -c[5];
  const double minor_x = yy * zz - yz * yz, minor_y = zz * xx - zx * zx, minor_z = xx * yy - xy * xy;
  const double determinant = xx * minor_x + xy * (yz * zx - xy * zz) + zx * (xy * yz - yy * zx);
  if (!(trace > 0.0))
    return (struct vec3){0, 0, 0};
  if (!(determinant > SPIN_LEAST_SHARE * 2.0 * trace * (minor_x + minor_y + minor_z)))
    return rate_of_line(c, trace, l);
  /* Pi = T D T^t, T lower triangular with ones on its diagonal */
  const double t21 = xy / xx, t31 = zx / xx, d2 = yy - t21 * xy, below = yz - t21 * zx, t32 = below / d2;
  const double d3 = zz - t31 * zx - t32 * below;
  const double b2 = l.y - t21 * l.x, b3 = l.z - t31 * l.x - t32 * b2;
  const double z = b3 / d3, y = b2 / d2 - t32 * z, x = l.x / xx - t21 * y - t31 * z;
  return (struct vec3){x, y, z};
}

/* Sums are moved to a lattice point next to the centre of mass in integers, and from there to the centre in doubles:
 * what is subtracted last is smaller than half a lattice unit. */
static inline void moments_of(const struct cell_sum *sum, const struct cell_spin *s, struct vec3 center,
                              struct spin_moments *moments)
{
  const int64_t mass = (int64_t)(sum->load & (CELL_MEMBER - 1)), p[3] = {sum->px, sum->py, sum->pz};
  static const int row[6] = {0, 1, 2, 1, 2, 0}, column[6] = {0, 1, 2, 2, 0, 1};
  int64_t x[3], rest[3]; /* the centre of mass is at x + rest / mass, |rest| <= mass */
  double off[3], l[3];
  for (int k = 0; k < 3; k++) {
    x[k] = llrint(first_in_double(s->first[k]) / (double)mass);
    rest[k] = (int64_t)(uint64_t)(s->first[k] - spin_product(mass, x[k])); /* mass units times lattice units */
    off[k] = (double)rest[k];
  }
  const double inverse = 1.0 / (double)mass;
  for (int k = 0; k < 6; k++) {
    const int a = row[k], b = column[k];
    const spin_word moved = s->second[k] - spin_product(x[a], rest[b]) - spin_product(x[b], rest[a]) -
                            (uint64_t)mass * spin_product(x[a], x[b]);
    const double spread = a == b ? size_in_double(moved) : in_double(moved); /* sum m (y - x)^2 is not negative */
    moments->second[k] = 0x1p-96 * (spread - inverse * off[a] * off[b]);
  }
  const struct vec3 beyond = vec3_scale(LATTICE_UNIT * inverse, (struct vec3){off[0], off[1], off[2]});
  for (int k = 0; k < 3; k++) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    l[k] = 0x1p-84 * in_double(s->angular[k] - spin_product(x[a], p[b]) + spin_product(x[b], p[a]));
  }
  const struct vec3 momentum = vec3_scale(cell_mass(sum), center);
  moments->angular = vec3_sub((struct vec3){l[0], l[1], l[2]}, vec3_cross(beyond, momentum));
  moments->beyond = beyond;
  moments->middle = (struct point){x[0], x[1], x[2]};
}

void spin_moments(const struct cell_sum *sum, const struct cell_spin *s, struct vec3 center,
                  struct spin_moments *moments)
{
  moments_of(sum, s, center, moments);
}

void spin_solve(const struct cell_sum *sum, const struct cell_spin *s, struct cell_turn *turn, struct point *middle)
{
  struct spin_moments about;
  cell_solve(sum, turn);
  if (turn->active == 0.0)
    return;
  moments_of(sum, s, turn->center, &about);
  turn->axis = spin_rate(about.second, about.angular);
  turn->center = vec3_sub(turn->center, vec3_cross(turn->axis, about.beyond));
  *middle = about.middle;
}

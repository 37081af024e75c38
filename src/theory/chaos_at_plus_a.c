/*
 * A collision replaces the velocities of a cell by their projection on rigid motions, plus noise. What it keeps of
 * velocity and stress is the mean of that projection over the places of the members. Means of N members were computed
 * by validation/measure/rigid_share.c, to 0.1 %; here they are averaged over N.
 */
#include "theory/chaos.h"

#include <math.h>

/* Rotations of so many members that change their velocities: none of one, about all axes but their line of two. */
static double rotations(uint32_t d, uint32_t members)
{
  const double all = d == 2 ? 1.0 : 3.0, line = d == 2 ? 1.0 : 2.0;
  return members < 2 ? 0.0 : members == 2 ? line : all;
}

/*
 * What members keep of their own velocities adds up to the number of rigid motions, over d; members of equal mass have
 * equal shares. Another mass has its share of the mass in a translation. In a rotation about an axis across the line
 * to the others' centre it has its share of the moment of inertia, estimated by the means of squared distances, and in
 * one about the line none.
 */
static double velocity_loss(double cosine, uint32_t d, double mass, uint32_t others)
{
  (void)cosine;
  const double n = others, all = mass + n, axes = d - 1.0;
  if (others == 0)
    return 0.0;
  if (mass == 1.0)
    return 1.0 - (d + rotations(d, others + 1)) / (d * all);
  const double apart = mass * n / all * (1.0 + 1.0 / n), rest = (d == 2 ? 1.0 : 2.0 / 3.0) * (n - 1.0);
  return 1.0 - mass / all - axes / d * apart * n / all / (apart + rest);
}

enum { TABLE = 8 };

/* S of N members, N/S of the stress is lost; and Q, the momentum handed on, m a0^2: their values up to 8 members, and
 * the limits of many, a + b/N and (N - a - b/N)/24. */
static const struct row {
  double kept[TABLE + 1], kept_a, kept_b;
  double handed[TABLE + 1], handed_a, handed_b;
} rows[2] = {{{0.0, 1.0, 1.25173, 1.17453, 1.13324, 1.10689, 1.08838, 1.07570, 1.06593},
              1.0,
              0.522,
              {0.0, 0.0, 0.02245, 0.06104, 0.10287, 0.14503, 0.18728, 0.22945, 0.27186},
              1.42,
              0.45},
             {{0.0, 1.0, 1.46901, 1.55853, 1.48335, 1.43679, 1.40505, 1.38235, 1.36503},
              1.25,
              0.91,
              {0.0, 0.0, 0.01788, 0.04983, 0.08829, 0.12876, 0.16975, 0.21119, 0.25307},
              1.88,
              0.4}};

static double kept(uint32_t d, uint32_t members)
{
  const struct row *r = &rows[d == 3];
  return members <= TABLE ? r->kept[members] : r->kept_a + r->kept_b / members;
}

static double handed(uint32_t d, uint32_t members)
{
  const struct row *r = &rows[d == 3];
  return members <= TABLE ? r->handed[members] : (members - r->handed_a - r->handed_b / members) / 24.0;
}

/* Mean over cells whose number of members is of the Poisson distribution. */
static double mean(double (*value)(uint32_t, uint32_t), uint32_t d, double n)
{
  const uint32_t last = (uint32_t)(n + 40.0 * sqrt(n) + 40.0);
  double sum = 0.0;
  for (uint32_t k = 1; k <= last; k++)
    sum += exp(k * log(n) - n - lgamma(k + 1.0)) * value(d, k);
  return sum;
}

static double stress_loss(double cosine, uint32_t d, double n)
{
  (void)cosine;
  return 1.0 - mean(kept, d, n) / n;
}

static double handed_on(double cosine, uint32_t d, double n)
{
  (void)cosine;
  return mean(handed, d, n);
}

const struct chaos chaos_at_plus_a = {velocity_loss, stress_loss, handed_on};

#include "contact.h"

static double clamp(double x)
{
  return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
}

struct Levers {
  double of[4];
};

static Levers levers(const Contact &c)
{
  return {{1.0 - c.s, c.s, c.t - 1.0, -c.t}};
}

static Vector normal_of(Vector p, Vector q, Vector gap, Vector approach, int side)
{
  Vector n = cross(p, q);
  double speed = dot(n, approach);
  if (side < 0 || (side == 0 && speed < 0.0))
    n = -n, speed = -speed;
  if (!(dot(n, n) > (1e-24 * dot(p, p)) * dot(q, q)) || (side == 0 && !(speed > 0.0))) {
    n = gap;
    if (dot(gap, gap) == 0.0)
      n = approach + (-dot(approach, q) / dot(q, q)) * q;
  }
  return (1.0 / std::sqrt(dot(n, n))) * n;
}

bool find_contact(Point whole_p, Point whole_q, Point whole_w, const Vector velocity[4], Contact &contact)
{
  constexpr double tiny = 0x1p-1000;
  const int side = sign_of_volume(whole_p, whole_q, whole_w);
  const Vector p = in_a0(whole_p), q = in_a0(whole_q), w = in_a0(whole_w), across = cross(p, q);
  const double pp = dot(p, p) + tiny, qq = dot(q, q) + tiny, nn = dot(across, across) + tiny;
  const double pq = dot(p, q), pw = dot(p, w), qw = dot(q, w);
  const double start = clamp((pw * qq - pq * qw) / nn);
  contact.t = clamp((start * pq - qw) / qq);
  contact.s = clamp((contact.t * pq + pw) / pp);
  const Vector gap = (w + contact.t * q) + (-contact.s) * p;
  if (side == 0 && std::sqrt(dot(gap, gap)) < 0x1p-42)
    return false;
  const Levers lever = levers(contact);
  Vector approach = lever.of[0] * velocity[0];
  for (int k = 1; k < 4; k++)
    approach = approach + lever.of[k] * velocity[k];
  contact.normal = normal_of(p, q, gap, approach, side);
  return true;
}

Answer impulse(Ends &ends, const Contact &contact, double tau, double &momentum)
{
  const Levers lever = levers(contact);
  const Vector n = contact.normal;
  double a = 0.0, forces = 0.0, inertia = 0.0;
  for (int k = 0; k < 4; k++) {
    const double each = 1.0 / ends.mass[k];
    a += lever.of[k] * dot(ends.velocity[k], n);
    forces += lever.of[k] * (dot(ends.force[k], n) * each);
    inertia += (lever.of[k] * lever.of[k]) * each;
  }
  momentum = 0.0;
  if (!(a > 0.0))
    return NO_IMPULSE;
  const double h = tau * forces;
  double rebound = a + 2.0 * h;
  Answer answer = SOFTENED;
  if (rebound < 0.2 * a)
    rebound = (a * std::fabs(h)) / (std::fabs(h) + 1.6 * a);
  else if (0.2 * rebound > a)
    rebound = (a * std::fabs(h)) / (std::fabs(h) - 1.6 * a);
  else
    answer = FULL;
  momentum = (a + rebound) / inertia;
  for (int k = 0; k < 4; k++)
    ends.velocity[k] = ends.velocity[k] + ((-lever.of[k] * momentum) * (1.0 / ends.mass[k])) * n;
  return answer;
}

#include "oracle/event_model.h"

#include <math.h>

#include "contact/capsule.h"
#include "contact/determinant.h"
#include "contact/hull.h"
#include "oracle/event_rows.h"

/* --- the search --------------------------------------------------------------------------------------------------- */

struct at_tick {
  struct difference p, q, w;
};

static struct difference place(struct point at, struct point rate, int32_t tick)
{
  const struct point r = flight_place(at, rate, tick);
  return (struct difference){r.x, r.y, r.z};
}

static struct at_tick at_tick(const struct flight_pair *f, int32_t tick)
{
  return (struct at_tick){place(f->p, f->p_rate, tick), place(f->q, f->q_rate, tick), place(f->w, f->w_rate, tick)};
}

static struct vec3 real(struct difference d)
{
  return (struct vec3){(double)d.x * LATTICE_UNIT, (double)d.y * LATTICE_UNIT, (double)d.z * LATTICE_UNIT};
}

static double volume(bool doubles, struct difference p, struct difference q, struct difference w)
{
  return doubles ? vec3_dot(vec3_cross(real(p), real(q)), real(w)) : determinant(p, q, w);
}

static double sum_of_three(bool doubles, const struct at_tick *a, const struct at_tick *b)
{
  if (doubles)
    return volume(true, b->p, a->q, a->w) + volume(true, a->p, b->q, a->w) + volume(true, a->p, a->q, b->w);
  struct wide sum = {0, 0};
  wide_add_determinant(&sum, b->p, a->q, a->w);
  wide_add_determinant(&sum, a->p, b->q, a->w);
  wide_add_determinant(&sum, a->p, a->q, b->w);
  return wide_value(sum);
}

/* (i); ends_only: the volume at both ends of the interval only. */
static bool keeps_sign(bool doubles, bool ends_only, const struct at_tick *a, const struct at_tick *b)
{
  double c[4] = {volume(doubles, a->p, a->q, a->w), sum_of_three(doubles, a, b), sum_of_three(doubles, b, a),
                 volume(doubles, b->p, b->q, b->w)};
  if (ends_only)
    c[1] = c[2] = c[0];
  return (c[0] > 0.0 && c[1] > 0.0 && c[2] > 0.0 && c[3] > 0.0) ||
         (c[0] < 0.0 && c[1] < 0.0 && c[2] < 0.0 && c[3] < 0.0);
}

static double least_along(struct vec3 d, const struct at_tick *k)
{
  return vec3_dot(d, real(k->w)) + fmin(0.0, vec3_dot(d, real(k->q))) - fmax(0.0, vec3_dot(d, real(k->p)));
}

/* (ii) by the direction of the gap at either end. */
static bool gap_separates(const struct at_tick *a, const struct at_tick *b)
{
  const struct at_tick *const knot[2] = {a, b};
  for (int k = 0; k < 2; k++) {
    const struct vec3 p = real(knot[k]->p), q = real(knot[k]->q), w = real(knot[k]->w);
    double s, t;
    capsule_closest(p, q, w, &s, &t);
    const struct vec3 gap = capsule_between(p, q, w, s, t);
    if (least_along(gap, a) > 0.0 && least_along(gap, b) > 0.0)
      return true;
  }
  return false;
}

/* (ii) of a single tick, exactly. */
static bool plane_separates(const struct at_tick *a, const struct at_tick *b)
{
  const struct at_tick *const knot[2] = {a, b};
  struct difference corner[HULL_POINTS];
  for (int k = 0; k < 2; k++) {
    const struct difference p = knot[k]->p, q = knot[k]->q, w = knot[k]->w;
    corner[4 * k] = w, corner[4 * k + 1] = (struct difference){w.x + q.x, w.y + q.y, w.z + q.z};
    for (int j = 0; j < 2; j++) {
      const struct difference c = corner[4 * k + j];
      corner[4 * k + 2 + j] = (struct difference){c.x - p.x, c.y - p.y, c.z - p.z};
    }
  }
  return hull_misses_origin(corner);
}

static bool is_excluded(enum search_rule rule, const struct flight_pair *f, int32_t from, int32_t to)
{
  const struct at_tick a = at_tick(f, from), b = at_tick(f, to);
  const bool doubles = rule == SEARCH_DOUBLES, any_plane = rule != SEARCH_GAP_ONLY && to - from == 1;
  return (rule != SEARCH_PLANE_ONLY && keeps_sign(doubles, rule == SEARCH_ENDS_ONLY, &a, &b)) ||
         (rule != SEARCH_VOLUME_ONLY && (gap_separates(&a, &b) || (any_plane && plane_separates(&a, &b))));
}

static int32_t halve(enum search_rule rule, const struct flight_pair *f, int32_t from, int32_t to)
{
  if (is_excluded(rule, f, from, to))
    return FLIGHT_TICKS;
  if (to - from == 1)
    return from;
  const int32_t middle = from + (to - from) / 2, tick = halve(rule, f, from, middle);
  return tick < FLIGHT_TICKS ? tick : halve(rule, f, middle, to);
}

int32_t event_search(const struct event_twist *t, const struct flight_pair *pair, int32_t from)
{
  if (oracle_is_at_rest(pair))
    return t->search == SEARCH_AT_REST && !flight_excluded(pair, from, from + 1) ? from : FLIGHT_TICKS;
  const int32_t right = flight_contact(pair, t->search == SEARCH_FROM_ZERO ? 0 : from);
  switch (t->search) {
  case SEARCH_TICK_LATE:
    return right < FLIGHT_TICKS ? right + 1 : right;
  case SEARCH_TICK_EARLY:
    return right < FLIGHT_TICKS ? right - 1 : right;
  case SEARCH_NONE_IS_LAST:
    return right < FLIGHT_TICKS ? right : FLIGHT_TICKS - 1;
  case SEARCH_VOLUME_ONLY:
  case SEARCH_PLANE_ONLY:
  case SEARCH_GAP_ONLY:
  case SEARCH_DOUBLES:
  case SEARCH_ENDS_ONLY:
    return halve(t->search, pair, from, FLIGHT_TICKS);
  default:
    return right;
  }
}

/* --- the impulse -------------------------------------------------------------------------------------------------- */

static double inverse_mass(bool left_out, bool of_first, const struct oracle_impulse *e, int k)
{
  return left_out ? 1.0 : 1.0 / e->mass[of_first ? 0 : k];
}

static double rebound_of(const struct event_twist *t, double a, double h, enum contact_answer *answer)
{
  const double factor = t->rebound == REBOUND_HALF ? 1.0 : t->rebound == REBOUND_TWICE ? 4.0 : 2.0;
  const double straight = a + factor * h, size = fabs(h), bound = CONTACT_SLOWEST_REBOUND;
  const bool slow = straight < bound * a && t->rebound != REBOUND_FAST_ONLY,
             fast = straight * bound > a && t->rebound != REBOUND_SLOW_ONLY;
  *answer = CONTACT_CORRECTED;
  if (!(slow || fast) || t->rebound == REBOUND_NEVER_SOFT)
    return straight;
  *answer = CONTACT_SOFTENED;
  if (t->rebound == REBOUND_FULL_BEYOND)
    return a;
  if (t->rebound == REBOUND_CLAMPED || (slow && t->rebound == REBOUND_SLOW_CLAMPED))
    return slow ? bound * a : a / bound;
  return slow ? a * size / (size + 1.6 * a) : a * size / (size - 1.6 * a);
}

static void levers_of(const struct event_twist *t, const struct oracle_impulse *e, double lever[4])
{
  const bool p = t->lever == LEVER_SWAPPED_P || t->lever == LEVER_SWAPPED_BOTH,
             q = t->lever == LEVER_SWAPPED_Q || t->lever == LEVER_SWAPPED_BOTH;
  const double s = t->lever == LEVER_HALF ? 0.5
                   : p                    ? 1.0 - e->s
                                          : e->s,
               u = t->lever == LEVER_HALF ? 0.5
                   : q                    ? 1.0 - e->t
                                          : e->t;
  lever[0] = 1.0 - s, lever[1] = s, lever[2] = u - 1.0, lever[3] = -u;
}

static bool has_force(const struct event_twist *t, int k)
{
  return !(t->no_force_of == k + 1 || (t->no_force_of == 5 && k >= 2) || (t->no_force_of == 6 && k < 2));
}

double event_impulse(const struct event_twist *t, struct oracle_impulse *e, enum contact_answer *answer)
{
  double lever[4], approach = 0.0, pull = 0.0, compliance = 0.0;
  const bool none = t->mass == MASSES_NONE, first = t->mass == MASSES_OF_FIRST;
  levers_of(t, e, lever);
  for (int k = 0; k < 4; k++) {
    approach += lever[k] * vec3_dot(e->velocity[k], e->normal);
    if (has_force(t, k))
      pull += lever[k] *
              (vec3_dot(e->force[k], e->normal) * inverse_mass(none || t->mass == MASSES_NOT_IN_PULL, first, e, k));
    compliance += (t->unsquared ? fabs(lever[k]) : lever[k] * lever[k]) *
                  inverse_mass(none || t->mass == MASSES_NOT_IN_SUM, first, e, k);
  }
  *answer = CONTACT_NONE;
  if (!(approach > 0.0) && !t->separating_too)
    return 0.0;
  const double tau = t->tau == TAU_ZERO ? 0.0 : t->tau == TAU_TURNED ? -e->tau : e->tau;
  const double impulse = (approach + rebound_of(t, approach, tau * pull, answer)) / compliance;
  for (int k = 0; k < 4 && !t->no_change; k++)
    if (!(t->first_bond_only && k >= 2))
      e->velocity[k] = vec3_add_scaled(
          e->velocity[k], -lever[k] * impulse * inverse_mass(none || t->mass == MASSES_NOT_IN_CHANGE, first, e, k),
          e->normal);
  return impulse;
}

/* --- guesses ------------------------------------------------------------------------------------------------------ */

const struct event_twist event_search_twists[] = {
    {.search = SEARCH_TICK_LATE, .text = "a contact is answered a tick late: the first tick of the interval counts"},
    {.search = SEARCH_TICK_EARLY, .text = "a contact is answered a tick early"},
    {.search = SEARCH_VOLUME_ONLY,
     .text = "condition (i) only, the sign of the volume: bonds that pass beyond their ends count"},
    {.search = SEARCH_PLANE_ONLY, .text = "condition (ii) only, without (i), the sign of the volume"},
    {.search = SEARCH_GAP_ONLY, .text = "condition (ii) by the direction of the gap only: any plane counts"},
    {.search = SEARCH_DOUBLES, .text = "condition (i) in doubles alone: in a single tick its signs are exact"},
    {.search = SEARCH_ENDS_ONLY,
     .text = "condition (i) by the volume at both ends of the interval only: its Bernstein coefficients count"},
    {.search = SEARCH_FROM_ZERO, .text = "the search begins at tick 0, not at `from`"},
    {.search = SEARCH_NONE_IS_LAST, .text = "65535 for 65536 where there is no contact"},
    {.text = NULL},
};

const struct event_twist event_impulse_twists[] = {
    {.tau = TAU_ZERO,
     .text = "tau is left out, or the forces: the velocity of the drift is reversed, not that of the contact"},
    {.tau = TAU_TURNED, .text = "sign of tau, or of the forces: u = v + tau F/M"},
    {.no_force_of = 1, .text = "the force on the first bond's first vertex is left out"},
    {.no_force_of = 2, .text = "the force on the first bond's second vertex is left out"},
    {.no_force_of = 3, .text = "the force on the other bond's first vertex is left out"},
    {.no_force_of = 4, .text = "the force on the other bond's second vertex is left out"},
    {.no_force_of = 5, .text = "forces on the other bond are left out"},
    {.no_force_of = 6, .text = "forces on the first bond are left out"},
    {.rebound = REBOUND_NEVER_SOFT, .text = "rebounds are not softened: below a/5, and above 5 a, they are"},
    {.rebound = REBOUND_SLOW_ONLY, .text = "fast rebounds are not softened: above 5 a they are"},
    {.rebound = REBOUND_FAST_ONLY, .text = "slow rebounds are not softened: below a/5 they are"},
    {.rebound = REBOUND_FULL_BEYOND,
     .text = "beyond the bounds of the rebound the plain reversal: it is softened there"},
    {.rebound = REBOUND_CLAMPED, .text = "rebounds clamped to a/5 and 5 a: they are softened there"},
    {.rebound = REBOUND_SLOW_CLAMPED, .text = "slow rebounds clamped to a/5: they are softened there"},
    {.rebound = REBOUND_HALF, .text = "half of the correction: a + h for a + 2 h"},
    {.rebound = REBOUND_TWICE, .text = "twice the correction: a + 4 h for a + 2 h"},
    {.lever = LEVER_SWAPPED_P, .text = "lever rule swapped in the first bond: 1 - s goes to its first vertex"},
    {.lever = LEVER_SWAPPED_Q, .text = "lever rule swapped in the other bond: 1 - t goes to its first vertex"},
    {.lever = LEVER_SWAPPED_BOTH, .text = "lever rule swapped: 1 - s and 1 - t go to first vertices"},
    {.lever = LEVER_HALF, .text = "lever rule: levers are 0.5 always"},
    {.mass = MASSES_NONE, .text = "impulse without masses"},
    {.mass = MASSES_OF_FIRST, .text = "impulse with the mass of one vertex for all four"},
    {.mass = MASSES_NOT_IN_PULL, .text = "forces without the mass: F for F/M"},
    {.mass = MASSES_NOT_IN_CHANGE, .text = "changes of velocity without the mass: dP for dP/M"},
    {.mass = MASSES_NOT_IN_SUM, .text = "dP without mass in its denominator"},
    {.unsquared = true, .text = "levers are not squared in dP"},
    {.first_bond_only = true, .text = "the first bond only changes its velocities"},
    {.no_change = true, .text = "no exchange of momentum"},
    {.separating_too = true, .text = "bonds that part are answered, too: they get no impulse"},
    {.text = NULL},
};

const struct event_twist event_drift_twists[] = {
    {.tau = TAU_OF_START,
     .text = "tau counts from the start of the drift: it counts from the middle between two kicks"},
    {.tau = TAU_OF_END, .text = "tau counts from the end of the drift: it counts from the middle between two kicks"},
    {.force = FORCE_OF_START, .text = "forces of the start of the drift: those at the contact count"},
    {.force = FORCE_BONDS_ONLY, .text = "forces of bonds only, without bends"},
    {.force = FORCE_BENDS_ONLY, .text = "forces of bends only, without bonds"},
    {.force = FORCE_NOT_CONSTANT, .text = "constant forces left out of the forces at the contact"},
    {.push = PUSH_UNTURNED,
     .text = "the normal's sign as it comes from p x q: it points from the first bond to the other"},
    {.push = PUSH_TURNED, .text = "normal turned round: it points from the first bond to the other"},
    {.push = PUSH_GAP, .text = "the normal is the direction of the gap always: it is p x q"},
    {.push = PUSH_NO_GAP,
     .text = "the normal is p x q always: of parallel bonds, and in one plane, it is the direction of the gap"},
    {.push = PUSH_OF_START, .text = "s, t and the normal of the start of the drift: those of the contact count"},
    {.push = PUSH_BY_APPROACH,
     .text = "the normal's sign is that for which the bonds approach: it is that of the volume"},
    {.rate = RATE_CUT, .text = "displacement per tick cut toward zero, not rounded to the nearest lattice unit"},
    {.rate = RATE_DOWN, .text = "displacement per tick rounded down, not to the nearest lattice unit"},
    {.rate = RATE_STALE, .text = "flights do not bend: after a contact the four vertices have new rates"},
    {.again = AGAIN_TWO_BONDS,
     .text = "the two bonds only are searched again after a contact: all bonds at the four vertices are"},
    {.again = AGAIN_FIRST_BOND, .text = "partners of the other bond are not searched anew after a contact"},
    {.again = AGAIN_NOT_THE_PAIR,
     .text = "the two bonds of a contact are not searched again: they may touch once more"},
    {.again = AGAIN_NOTHING, .text = "nothing is searched again after a contact"},
    {.again = AGAIN_FROM_START, .text = "after a contact the search begins at tick 0, not at that of the contact"},
    {.again = AGAIN_TICK_LATER, .text = "after a contact the search begins a tick late"},
    {.again = AGAIN_OLD_STAY, .text = "old contacts stay: after a contact those of its bonds are out of date"},
    {.turn = TURN_BY_NUMBER, .text = "contacts in the order of bonds, not of ticks"},
    {.turn = TURN_LARGER_FIRST, .text = "contacts in one tick: those of the smaller numbers come first"},
    {.turn = TURN_BY_IMAGE_FIRST, .text = "contacts in one tick go by bond and other bond first, then by image"},
    {.image = IMAGE_NONE,
     .text = "missing image: a partner across the face of the box is not found (no images at all)"},
    {.image = IMAGE_ONE_BOX,
     .text = "missing image: a partner across the face of the box is not found (more than one box away)"},
    {.image = IMAGE_KEEPS_SIGN, .text = "images keep their sign when the two bonds of a pair change places"},
    {.image = IMAGE_REPORTED_TURNED, .text = "the image of an event is the negative of what is wanted"},
    {.not_tied = true, .text = "a bent path is not tied to its place at the contact"},
    {.touching_answered = true, .text = "bonds laid through one point are answered: they part at tick 0"},
    {.mean_down = true, .text = "the common rate of a cluster is rounded down: it is cut toward zero"},
    {.no_clusters = true, .text = "no clusters: where no impulse separates bonds, they fly on as one"},
    {.text = NULL},
};

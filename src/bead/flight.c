/*
 * Flights of solvent particles that may meet the bead, and the flight of the bead itself.
 *
 * A flight has 2^16 ticks. In a tick a body moves by a whole number of lattice units, its rate; so at each tick it
 * stands on the lattice, and a path may bend there without rounding. A particle hits the bead at the last tick at which
 * it is not inside while it would be inside at the next one. This is decided in exact integers. So at every tick every
 * particle is outside, or on the surface. What touches the bead between two ticks only, by less than 1e-12 of R, is no
 * hit.
 *
 * A hit reverses the velocity of the particle relative to the bead and keeps momentum and energy of the two:
 * v' = 2 U - v, U = (m v + M V)/(m + M). It bends the path of the bead as well, and so moves all later hits. Hits are
 * answered one after the other, by tick, then by particle id.
 *
 * The counterforce of a drive accelerates all particles. Those that follow ticks fly straight, with their velocity of
 * the middle of the flight: they get half of its kick before, half of it after. They end where the others would.
 *
 * Only those particles follow ticks that come within the slack of the bead's free flight (meet.c). All others are
 * further from it than the bead can be off that flight; if it is off further, there is more slack, and more follow
 * ticks.
 */
#include "bead/flight.h"

#include <math.h>

#include "bead/meet.h"

/* --- paths on ticks ---------------------------------------------------------------------------------------------- */

static struct point later(struct point at, struct point rate, int64_t ticks)
{
  return (struct point){at.x + rate.x * ticks, at.y + rate.y * ticks, at.z + rate.z * ticks};
}

/* The next hit of a particle, from the bead's clock on. */
static int64_t next_hit(const struct bead_way *bead, const struct bead_visit *m)
{
  const struct approach a = {point_minus(later(m->at, m->rate, bead->clock - m->clock), bead->at),
                             point_minus(m->rate, bead->rate)};
  const int64_t left = FLIGHT_TICKS - 1 - bead->clock, touch = m->rigid ? -1 : bead_touch(&a, bead->radius, left);
  return touch < 0 ? FLIGHT_TICKS : bead->clock + touch;
}

static void set_velocity(struct bead_way *bead, struct vec3 velocity)
{
  bead->velocity = velocity;
  bead->rate = bead->held ? (struct point){0, 0, 0} : bead_rate(velocity, bead->time);
}

/* Both at the tick of their hit. */
static void bounce(struct bead_way *bead, struct bead_visit *m)
{
  const struct vec3 center =
      vec3_scale(1.0 / (1.0 + bead->mass), vec3_add_scaled(m->velocity, bead->mass, bead->velocity));
  const struct vec3 after = vec3_sub(vec3_scale(2.0, center), m->velocity);
  set_velocity(bead, vec3_add_scaled(bead->velocity, -1.0 / bead->mass, vec3_sub(after, m->velocity)));
  m->velocity = after;
  m->rate = bead_rate(after, bead->time);
}

enum { MOST_AT_A_TICK = 8 }; /* hits of one particle: a pair that is at rest to rounding may go on for ever */

/* The bead goes on to a tick. */
static void go_to(struct bead_way *bead, int64_t tick)
{
  bead->at = later(bead->at, bead->rate, tick - bead->clock);
  bead->clock = tick;
}

/* --- walls ------------------------------------------------------------------------------------------------------- */

/* The last tick at which a body is not beyond a wall. y: its height at a tick; within: of its center from the walls. */
static int64_t last_between(const struct bead_flight *all, int64_t y, int64_t rate, int64_t tick, int64_t within)
{
  if (rate == 0)
    return FLIGHT_TICKS;
  const int64_t ticks =
      rate < 0 ? (y - all->height[WALL_LOWER] - within) / -rate : (all->height[WALL_UPPER] - within - y) / rate;
  return ticks < 0 ? tick : ticks < FLIGHT_TICKS - tick ? tick + ticks : FLIGHT_TICKS;
}

static int64_t visit_at_wall(const struct bead_flight *all, const struct bead_visit *m)
{
  return m->rigid ? FLIGHT_TICKS : last_between(all, m->at.y, m->rate.y, m->clock, 0);
}

static int64_t bead_at_wall(const struct bead_flight *all)
{
  const struct bead_way *w = &all->way;
  return all->walled ? last_between(all, w->at.y, w->rate.y, w->clock, w->radius) : FLIGHT_TICKS;
}

static enum wall wall_ahead(int64_t rate)
{
  return rate < 0 ? WALL_LOWER : WALL_UPPER;
}

static struct account given(struct bead_flight *all)
{
  return (struct account){all->given, all->turns};
}

#define ACCOUNT_RANGE 0x1p20 /* m a0/t0: sums across wrap there, and a heavy bead gives more than that */

/* The bead is smooth: its velocity across is reversed. */
static void bead_hits_wall(struct bead_flight *all)
{
  const enum wall wall = wall_ahead(all->way.rate.y);
  const struct vec3 before = all->way.velocity, after = {before.x, -before.y, before.z};
  const double gain = remainder(all->way.mass * (after.y - before.y), ACCOUNT_RANGE);
  go_to(&all->way, bead_at_wall(all));
  account_enter(given(all), wall, (struct vec3){0.0, gain < 0.5 * ACCOUNT_RANGE ? gain : -gain, 0.0});
  set_velocity(&all->way, after);
}

/* A particle goes on to the tick of its hit. */
static void arrive(struct bead_visit *m)
{
  m->again = m->clock == m->due ? m->again + 1 : 0;
  m->at = later(m->at, m->rate, m->due - m->clock);
  m->clock = m->due;
}

static void visit_hits_wall(struct bead_flight *all, struct bead_visit *m)
{
  const enum wall wall = wall_ahead(m->rate.y);
  const struct vec3 after = wall_reflect(&all->slit, wall, m->velocity);
  wall_gives(given(all), wall, 1.0, m->velocity, after);
  m->velocity = after;
  m->rate = bead_rate(after, all->way.time);
}

/* --- hits -------------------------------------------------------------------------------------------------------- */

static void answer(struct bead_flight *all)
{
  struct bead_way *const bead = &all->way;
  struct bead_visit *const m = all->first;
  if (!m) {
    bead_hits_wall(all);
    return;
  }
  arrive(m);
  if (m->at_wall) {
    visit_hits_wall(all, m);
    return;
  }
  go_to(bead, m->clock);
  bounce(bead, m);
  if (m->again > MOST_AT_A_TICK) {
    m->rigid = true;
    m->at = point_minus(m->at, bead->at);
  }
  all->bead.account.z++;
}

/* The first that is due, of the smallest id among those of the same tick. */
static struct bead_visit *first_due(const struct bead_flight *all, const uint32_t *id)
{
  struct bead_visit *first = all->at;
  for (uint32_t k = 0; k < all->n; k++) {
    struct bead_visit *m = &all->at[k];
    if (m->due < first->due || (m->due == first->due && id[m->place] < id[first->place]))
      first = m;
  }
  return first;
}

int64_t bead_flight_next(const struct state *state, struct bead_flight *all)
{
  for (uint32_t k = 0; k < all->n; k++) {
    struct bead_visit *m = &all->at[k];
    const int64_t wall = all->walled ? visit_at_wall(all, m) : FLIGHT_TICKS;
    m->due = next_hit(&all->way, m);
    m->at_wall = wall < m->due;
    m->due = m->at_wall ? wall : m->due;
  }
  const int64_t own = bead_at_wall(all);
  all->first = all->n > 0 ? first_due(all, state->solvent.id) : NULL;
  if (all->first && all->first->due <= own)
    return all->first->due;
  all->first = NULL;
  return own;
}

/* The bead is off its free flight by this at most, a0. */
static double off_free_flight(const struct bead_flight *all)
{
  const struct vec3 flown = all->way.held ? (struct vec3){0, 0, 0} : all->way.velocity;
  return all->way.time * vec3_norm(vec3_sub(flown, all->free));
}

/* --- the flight -------------------------------------------------------------------------------------------------- */

/* The bead at its start; no one meets it yet. */
static void set_out(const struct state *state, const struct model *model, double time, struct bead_flight *all)
{
  all->n = 0;
  all->bead = *state->bead;
  all->free = state->bead->velocity;
  all->way = (struct bead_way){.time = time, .mass = model->bead.mass, .radius = bead_radius(model)};
  set_velocity(&all->way, all->free);
  all->walled = model_has_walls(model);
  if (!all->walled)
    return;
  all->slit = slit_during(model, shear_interval(model, state->solvent_time));
  for (enum wall wall = 0; wall < WALLS; wall++) {
    all->height[wall] = wall_height(&model->box, wall) - state->bead->position.y;
    all->given[wall] = (struct point){0, 0, 0}, all->turns[wall] = 0;
  }
}

/* Where particles and bead are at the end. */
static void land(const struct model *model, const struct state *state, const struct span *span, struct bead_flight *all)
{
  const struct bead_way *bead = &all->way;
  const struct point end = later(bead->at, bead->rate, FLIGHT_TICKS - bead->clock), origin = state->bead->position;
  for (uint32_t k = 0; k < all->n; k++) {
    struct bead_visit *m = &all->at[k];
    const struct point at = m->rigid ? point_plus(end, m->at) : later(m->at, m->rate, FLIGHT_TICKS - m->clock);
    m->at =
        (struct point){lattice_fold(origin.x + at.x, model->box.edge[0]), box_inside(&model->box, 1, origin.y + at.y),
                       lattice_fold(origin.z + at.z, model->box.edge[2])};
    m->velocity = vec3_add_scaled(m->velocity, 0.5 * span->time, span->acceleration);
  }
  all->bead.position = point_plus(origin, end);
  all->bead.velocity = bead->velocity;
}

#define SLACK 0.5 /* a0/t0: of the bead's velocity in a drift, at first */

bool bead_flight_begin(const struct state *state, const struct model *model, struct bead_flight *all,
                       struct fault *fault)
{
  set_out(state, model, model->time_step, all);
  all->slack = SLACK * model->time_step;
  return bead_meet(state, model, -1.0, all->slack, all, fault);
}

/* More slack, if the bead has become so fast. Those who are taken now have met no one yet. */
static bool keep_slack(const struct state *state, const struct model *model, struct bead_flight *all,
                       struct fault *fault)
{
  const double known = all->slack, off = off_free_flight(all), most = bead_half_edge(model);
  if (off <= known)
    return true;
  if (!(2.0 * off + model->bead.radius < most))
    return fault_record(fault, FAULT_BEAD_MOVE, state->step + 1, 0, 2.0 * off + model->bead.radius, most);
  all->slack = 2.0 * off;
  return bead_meet(state, model, known, all->slack, all, fault);
}

bool bead_flight_answer(const struct state *state, const struct model *model, struct bead_flight *all,
                        struct fault *fault)
{
  answer(all);
  return keep_slack(state, model, all, fault);
}

bool bead_flight_turn(const struct state *state, const struct model *model, struct bead_flight *all, int64_t tick,
                      struct vec3 velocity, struct fault *fault)
{
  go_to(&all->way, tick);
  set_velocity(&all->way, velocity);
  return keep_slack(state, model, all, fault);
}

void bead_flight_end(const struct state *state, const struct model *model, struct bead_flight *all)
{
  const struct span span = bead_span(state, model);
  land(model, state, &span, all);
}

bool bead_flight_alone(const struct state *state, const struct model *model, struct bead_flight *all,
                       struct fault *fault)
{
  if (!bead_flight_begin(state, model, all, fault))
    return false;
  while (bead_flight_next(state, all) < FLIGHT_TICKS)
    if (!bead_flight_answer(state, model, all, fault))
      return false;
  bead_flight_end(state, model, all);
  return true;
}

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
 * Only those particles follow ticks that come within the slack of the bead's free flight. All others are further from
 * it than the bead can be off that flight; if it is off further, all is done again with more slack.
 */
#include "fluid/bead.h"

#include <math.h>

#include "base/memory.h"
#include "base/normal.h"
#include "fluid/boundary.h"

__extension__ typedef __int128 wide;

/* --- the next hit ------------------------------------------------------------------------------------------------ */

static wide product(struct point a, struct point b)
{
  return (wide)a.x * b.x + (wide)a.y * b.y + (wide)a.z * b.z;
}

/* Square of the distance at a tick, less that of the radius. */
struct gap {
  wide square, along, start; /* of the rate; rate times distance; at tick 0 */
};

static wide gap_at(const struct gap *g, int64_t tick)
{
  return g->start + (2 * g->along + g->square * tick) * tick;
}

/* The gap falls from tick 0, where it is not negative, to tick `inside`, where it is. The root in doubles is next to
 * the tick in nearly all cases. */
static int64_t last_outside(const struct gap *g, int64_t inside)
{
  enum { STEPS = 4 };
  const double a = (double)g->square, b = (double)g->along, c = (double)g->start;
  const double root = fmin(c / (-b + sqrt(fmax(0.0, b * b - a * c))), (double)(inside - 1));
  int64_t low = 0, high = inside, look = root < 1.0 ? 1 : (int64_t)root;
  for (int k = 0; high - low > 1; k++) {
    const bool outside = gap_at(g, look) >= 0;
    *(outside ? &low : &high) = look;
    look = k >= STEPS ? low + (high - low) / 2 : outside ? low + 1 : high - 1;
  }
  return low;
}

/* The paths pass each other by more than doubles can be wrong. */
static bool passes(const struct gap *g)
{
  const double along = (double)g->along;
  return (double)g->start * (double)g->square > along * along * (1.0 + 1e-12);
}

int64_t bead_touch(const struct approach *approach, int64_t radius, int64_t most)
{
  const struct gap g = {product(approach->rate, approach->rate), product(approach->apart, approach->rate),
                        product(approach->apart, approach->apart) - (wide)radius * radius};
  if (g.along >= 0) /* the distance grows from here on */
    return -1;
  if (g.start < 0)
    return 0;
  if (passes(&g))
    return -1;
  const int64_t lowest = (int64_t)(-g.along / g.square < most ? -g.along / g.square : most);
  const int64_t inside = gap_at(&g, lowest) < 0 ? lowest : lowest + 1;
  if (gap_at(&g, inside) >= 0)
    return -1;
  const int64_t tick = last_outside(&g, inside);
  return tick <= most ? tick : -1;
}

/* --- paths on ticks ---------------------------------------------------------------------------------------------- */

static struct point rate_of(struct vec3 velocity, double time)
{
  const double scale = time * LATTICE_PER_A0 / BEAD_TICKS;
  return (struct point){llrint(velocity.x * scale), llrint(velocity.y * scale), llrint(velocity.z * scale)};
}

static struct point later(struct point at, struct point rate, int64_t ticks)
{
  return (struct point){at.x + rate.x * ticks, at.y + rate.y * ticks, at.z + rate.z * ticks};
}

/* The bead on its way; `at` and clock as in struct bead_visit. */
struct way {
  double time, mass; /* of the flight, t0; of the bead, m */
  int64_t radius, clock;
  struct point at, rate;
  struct vec3 velocity;
};

/* The next hit of a particle, from the bead's clock on. */
static int64_t next_hit(const struct way *bead, const struct bead_visit *m)
{
  const struct approach a = {point_minus(later(m->at, m->rate, bead->clock - m->clock), bead->at),
                             point_minus(m->rate, bead->rate)};
  const int64_t left = BEAD_TICKS - 1 - bead->clock, touch = m->rigid ? -1 : bead_touch(&a, bead->radius, left);
  return touch < 0 ? BEAD_TICKS : bead->clock + touch;
}

/* Both at the tick of their hit. */
static void bounce(struct way *bead, struct bead_visit *m)
{
  const struct vec3 center =
      vec3_scale(1.0 / (1.0 + bead->mass), vec3_add_scaled(m->velocity, bead->mass, bead->velocity));
  const struct vec3 after = vec3_sub(vec3_scale(2.0, center), m->velocity);
  bead->velocity = vec3_add_scaled(bead->velocity, -1.0 / bead->mass, vec3_sub(after, m->velocity));
  bead->rate = rate_of(bead->velocity, bead->time);
  m->velocity = after;
  m->rate = rate_of(after, bead->time);
}

enum { MOST_AT_A_TICK = 8 }; /* hits of one particle: a pair that is at rest to rounding may go on for ever */

static void answer(struct way *bead, struct bead_visits *all, struct bead_visit *m)
{
  const int64_t now = m->due;
  m->again = m->clock == now ? m->again + 1 : 0;
  m->at = later(m->at, m->rate, now - m->clock);
  bead->at = later(bead->at, bead->rate, now - bead->clock);
  m->clock = bead->clock = now;
  bounce(bead, m);
  if (m->again > MOST_AT_A_TICK) {
    m->rigid = true;
    m->at = point_minus(m->at, bead->at);
  }
  all->bead.account.z++;
}

/* The first that is due, of the smallest id among those of the same tick. */
static struct bead_visit *first_due(struct bead_visits *all, const uint32_t *id)
{
  struct bead_visit *first = all->at;
  for (struct bead_visit *m = all->at; m < all->at + all->n; m++)
    if (m->due < first->due || (m->due == first->due && id[m->place] < id[first->place]))
      first = m;
  return first;
}

/* --- who meets the bead ------------------------------------------------------------------------------------------ */

/* Does a particle come within a distance of the bead, if both fly freely? apart: at the start, a0; go: by how much that
 * changes in the flight. */
static bool comes_within(struct vec3 apart, struct vec3 go, double distance)
{
  const double square = vec3_dot(go, go), along = -vec3_dot(apart, go);
  const double part = !(along > 0.0) ? 0.0 : along < square ? along / square : 1.0;
  const struct vec3 nearest = vec3_add_scaled(apart, part, go);
  return !(vec3_dot(nearest, nearest) > distance * distance);
}

static bool take(struct bead_visits *all, struct bead_visit m, uint64_t step, struct fault *fault)
{
  if (all->n == all->room && !memory_double((void **)&all->at, &all->room, 64, sizeof *all->at))
    return fault_no_memory(fault, step);
  all->at[all->n++] = m;
  return true;
}

#define ROUNDING 1e-6 /* a0: more than what ticks and doubles round */

static bool find_meetings(const struct state *state, const struct model *model, const struct span *span,
                          const uint32_t *near, uint32_t n, double slack, struct bead_visits *all, struct fault *fault)
{
  const struct solvent *s = &state->solvent;
  const struct bead *bead = state->bead;
  const double reach = model->bead.radius + slack + ROUNDING, t = span->time;
  const struct vec3 a = span->acceleration;
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t i = near[k];
    const struct vec3 end = solvent_velocity(s, i), v = vec3_add_scaled(end, -0.5 * t, a),
                      begin = vec3_add_scaled(end, -t, a);
    const struct point start = {s->x[i] - boundary_flight(begin.x, a.x, t), s->y[i] - boundary_flight(begin.y, a.y, t),
                                s->z[i] - boundary_flight(begin.z, a.z, t)};
    const struct point at = bead_to_image(&model->box, bead->position, start);
    if (!comes_within(point_in_a0(at), vec3_scale(t, vec3_sub(v, bead->velocity)), reach))
      continue;
    if (!take(all, (struct bead_visit){.place = i, .at = at, .rate = rate_of(v, t), .velocity = v}, state->step + 1,
              fault))
      return false;
  }
  return true;
}

/* --- the flight -------------------------------------------------------------------------------------------------- */

/* Answers all hits. False if the bead is off its free flight by more than the slack. */
static bool fly(struct way *bead, struct bead_visits *all, const uint32_t *id, double slack)
{
  const struct vec3 free = bead->velocity;
  for (;;) {
    for (struct bead_visit *m = all->at; m < all->at + all->n; m++)
      m->due = next_hit(bead, m);
    struct bead_visit *const m = first_due(all, id);
    if (all->n == 0 || m->due == BEAD_TICKS)
      return true;
    answer(bead, all, m);
    if (!(bead->time * vec3_norm(vec3_sub(bead->velocity, free)) <= slack))
      return false;
  }
}

/* Where particles and bead are at the end. */
static void land(const struct way *bead, const struct model *model, const struct state *state, const struct span *span,
                 struct bead_visits *all)
{
  const struct point end = later(bead->at, bead->rate, BEAD_TICKS - bead->clock), origin = state->bead->position;
  for (struct bead_visit *m = all->at; m < all->at + all->n; m++) {
    const struct point at = m->rigid ? point_plus(end, m->at) : later(m->at, m->rate, BEAD_TICKS - m->clock);
    m->at = (struct point){lattice_fold(origin.x + at.x, model->box.edge[0]),
                           lattice_fold(origin.y + at.y, model->box.edge[1]),
                           lattice_fold(origin.z + at.z, model->box.edge[2])};
    m->velocity = vec3_add_scaled(m->velocity, 0.5 * span->time, span->acceleration);
  }
  all->bead.position = point_plus(origin, end);
  all->bead.velocity = bead->velocity;
}

bool bead_meet(const struct state *state, const struct model *model, const uint32_t *near, uint32_t n, double slack,
               struct bead_visits *all, struct fault *fault)
{
  const struct span span = boundary_lag(state, model);
  struct way bead = {.time = span.time,
                     .mass = model->bead.mass,
                     .radius = bead_radius(model),
                     .rate = rate_of(state->bead->velocity, span.time),
                     .velocity = state->bead->velocity};
  all->n = 0;
  all->bead = *state->bead;
  if (!find_meetings(state, model, &span, near, n, slack, all, fault))
    return false;
  all->enough = fly(&bead, all, state->solvent.id, slack);
  land(&bead, model, state, &span, all);
  return true;
}

/* --- start ------------------------------------------------------------------------------------------------------- */

void bead_start(struct state *state, const struct model *model)
{
  const struct vec3 c = model->bead.center;
  double v[3];
  random_normal_three(random_at(model->seed, RANDOM_BEAD_REST, 0, 0, 0), v);
  *state->bead = (struct bead){.position = {lattice_from_a0(c.x), lattice_from_a0(c.y), lattice_from_a0(c.z)},
                               .velocity = vec3_scale(1.0 / sqrt(model->bead.mass), (struct vec3){v[0], v[1], v[2]})};
}

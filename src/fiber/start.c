#include "fiber/start.h"

#include "base/normal.h"
#include "system/fiber_kind.h"

/* A bond length in equilibrium: p(l) ~ l^w exp(-k (l-l0)^2/2), w = d - 1. The tangent of the log at the mode m bounds
 * w log(l) from above, so a Gaussian about m of variance 1/k bounds the distribution: l from it is kept with
 * probability exp(w (log(l/m) - (l/m - 1))), l > 0. */
static double sample_bond_length(const struct model *model, const struct fiber_kind *kind, uint64_t attempt,
                                 uint32_t bond)
{
  const double l0 = kind->bond_length, weight = model->dimensions - 1.0;
  const double mode = 0.5 * (l0 + sqrt(l0 * l0 + 4.0 * weight / kind->spring));
  for (uint32_t draw = 0;; draw += 2) {
    double normal[2];
    random_normal_pair(random_at(model->seed, RANDOM_BOND_LENGTH, draw, attempt, bond), normal);
    double x = 1.0 + normal[0] / (sqrt(kind->spring) * mode);
    double u = random_uniform(random_at(model->seed, RANDOM_BOND_LENGTH, draw + 1, attempt, bond), 0);
    if (x > 0.0 && elementary_log(u) < weight * (elementary_log(x) - (x - 1.0)))
      return x * mode;
  }
}

/* cos(theta) from p ~ exp(kappa cos) on [-1,1], by inversion. */
static double sample_bend(const struct model *model, const struct fiber_kind *kind, uint64_t attempt, uint32_t vertex)
{
  double u = random_uniform(random_at(model->seed, RANDOM_BEND, 0, attempt, vertex), 0);
  if (kind->bending < 1e-8)
    return 2.0 * u - 1.0;
  double c = 1.0 + elementary_log(u + (1.0 - u) * elementary_exp(-2.0 * kind->bending)) / kind->bending;
  return c < -1.0 ? -1.0 : c;
}

/* A unit vector across u, of uniform azimuth: the part across u of a uniform direction. */
static struct vec3 sample_across(const struct model *model, uint64_t attempt, uint32_t vertex, struct vec3 u)
{
  struct vec3 n = random_axis(model->seed, RANDOM_BEND_AZIMUTH, attempt, vertex);
  n = vec3_add_scaled(n, -vec3_dot(n, u), u);
  return vec3_scale(1.0 / vec3_norm(n), n);
}

/* A bend in the plane, as a point of the unit circle: von Mises' distribution, p ~ exp(kappa cos theta), by the
 * rejection of Best and Fisher (Appl. Statist. 28, 152 (1979)). */
static struct circle_point sample_turn(const struct model *model, const struct fiber_kind *kind, uint64_t attempt,
                                       uint32_t vertex)
{
  const double kappa = kind->bending, tau = 1.0 + sqrt(1.0 + 4.0 * kappa * kappa);
  const double rho = (tau - sqrt(2.0 * tau)) / (2.0 * kappa), r = (1.0 + rho * rho) / (2.0 * rho);
  if (kappa < 1e-4)
    return elementary_circle_turns(random_uniform(random_at(model->seed, RANDOM_BEND, 0, attempt, vertex), 0));
  for (uint32_t draw = 0;; draw += 2) {
    const struct random_words words = random_at(model->seed, RANDOM_BEND, draw, attempt, vertex);
    const struct random_words side = random_at(model->seed, RANDOM_BEND, draw + 1, attempt, vertex);
    const double z = elementary_circle_turns(0.5 * random_uniform(words, 0)).cosine, u = random_uniform(words, 1);
    const double f = (1.0 + r * z) / (r + z), c = kappa * (r - f);
    if (c * (2.0 - c) > u || elementary_log(c) - elementary_log(u) + 1.0 - c >= 0.0)
      return (struct circle_point){f, (side.w[0] & 1 ? 1.0 : -1.0) * sqrt(fmax(0.0, 1.0 - f * f))};
  }
}

static struct vec3 random_place(const struct model *model, uint64_t attempt, uint32_t fiber)
{
  struct random_words xy = random_at(model->seed, RANDOM_FIBER_POSITION, 0, attempt, fiber);
  struct random_words z = random_at(model->seed, RANDOM_FIBER_POSITION, 1, attempt, fiber);
  return (struct vec3){random_uniform(xy, 0) * model->box.cells[0], random_uniform(xy, 1) * model->box.cells[1],
                       model_is_flat(model) ? 0.0 : random_uniform(z, 0) * model->box.cells[2]};
}

/* Along a fiber, or normal to a ring: uniform; in a plane uniform within it, or along z. */
static struct vec3 random_direction(const struct model *model, const struct fiber_kind *kind, uint64_t attempt,
                                    uint32_t fiber)
{
  if (!model_is_flat(model))
    return random_axis(model->seed, RANDOM_FIBER_DIRECTION, attempt, fiber);
  const struct random_words r = random_at(model->seed, RANDOM_FIBER_DIRECTION, 0, attempt, fiber);
  const struct circle_point p = elementary_circle_turns(random_uniform(r, 0));
  return kind->ring ? (struct vec3){0.0, 0.0, 1.0} : (struct vec3){p.cosine, p.sine, 0.0};
}

/* The direction of the bond after the bend at this vertex, from that before it. */
static struct vec3 bend_in_plane(const struct model *model, const struct fiber_kind *kind, uint64_t attempt,
                                 uint32_t vertex, struct vec3 u)
{
  const struct circle_point p = sample_turn(model, kind, attempt, vertex);
  return (struct vec3){p.cosine * u.x - p.sine * u.y, p.sine * u.x + p.cosine * u.y, 0.0};
}

static struct vec3 bend_in_space(const struct model *model, const struct fiber_kind *kind, uint64_t attempt,
                                 uint32_t vertex, struct vec3 u)
{
  double cosine = sample_bend(model, kind, attempt, vertex);
  double sine = sqrt(fmax(0.0, 1.0 - cosine * cosine));
  return vec3_add(vec3_scale(cosine, u), vec3_scale(sine, sample_across(model, attempt, vertex, u)));
}

/* One fiber to be laid: its first vertex, its place. attempt: number of the attempt to lay it, for random numbers. */
struct site {
  uint32_t first;
  uint64_t attempt;
  struct vec3 center, direction;
};

static void lay_equilibrium(struct point *position, const struct model *model, const struct fiber_kind *kind,
                            const struct site *site)
{
  struct vec3 u = site->direction;
  position[site->first] = point_move((struct point){0, 0, 0}, site->center);
  for (uint32_t i = 1; i < kind->vertices; i++) {
    uint32_t bond = site->first + i - 1;
    if (i > 1) {
      u = model_is_flat(model) ? bend_in_plane(model, kind, site->attempt, bond, u)
                               : bend_in_space(model, kind, site->attempt, bond, u);
      u = vec3_scale(1.0 / vec3_norm(u), u);
    }
    position[bond + 1] =
        point_move(position[bond], vec3_scale(sample_bond_length(model, kind, site->attempt, bond), u));
  }
}

static void lay_straight(struct point *position, const struct model *model, const struct fiber_kind *kind,
                         const struct site *site)
{
  (void)model;
  const double l = fiber_mean_bond(kind);
  const struct point middle = point_move((struct point){0, 0, 0}, site->center);
  for (uint32_t i = 0; i < kind->vertices; i++)
    position[site->first + i] = point_move(middle, vec3_scale((i - 0.5 * (kind->vertices - 1)) * l, site->direction));
}

static void lay_circle(struct point *position, const struct model *model, const struct fiber_kind *kind,
                       const struct site *site)
{
  (void)model;
  const double vertices = kind->vertices;
  const double radius = 0.5 * fiber_mean_bond(kind) / elementary_circle_turns(0.5 / vertices).sine;
  const struct vec3 n = site->direction;
  const struct vec3 e = fabs(n.x) < 0.6 ? (struct vec3){1, 0, 0} : (struct vec3){0, 1, 0};
  struct vec3 a = vec3_cross(n, e);
  a = vec3_scale(1.0 / vec3_norm(a), a);
  const struct vec3 b = vec3_cross(n, a);
  const struct point middle = point_move((struct point){0, 0, 0}, site->center);
  for (uint32_t i = 0; i < kind->vertices; i++) {
    const struct circle_point p = elementary_circle_turns(i / vertices);
    struct vec3 r = vec3_add(vec3_scale(radius * p.cosine, a), vec3_scale(radius * p.sine, b));
    position[site->first + i] = point_move(middle, r);
  }
}

static void (*const layings[])(struct point *, const struct model *, const struct fiber_kind *, const struct site *) = {
    [START_EQUILIBRIUM] = lay_equilibrium,
    [START_STRAIGHT] = lay_straight,
    [START_CIRCLE] = lay_circle,
};

static void start_velocities(struct state *state, const struct model *model)
{
  for (uint32_t v = 0; v < state->vertices; v++) {
    double a[2], b[2];
    random_normal_pair(random_at(model->seed, RANDOM_VERTEX_VELOCITY, 0, 0, v), a);
    random_normal_pair(random_at(model->seed, RANDOM_VERTEX_VELOCITY, 1, 0, v), b);
    state->velocity[v] =
        vec3_scale(sqrt(1.0 / model->mass[v]), (struct vec3){a[0], a[1], model_is_flat(model) ? 0.0 : b[0]});
  }
}

/* True if a fiber is between the walls, or if there are none. */
static bool between_walls(const struct point *position, const struct model *model, const struct fiber_kind *kind,
                          uint32_t first)
{
  for (uint32_t i = first; model_has_walls(model) && i < first + kind->vertices; i++)
    if (box_inside(&model->box, 1, position[i].y) != position[i].y)
      return false;
  return true;
}

static enum fiber_verdict judge(const struct fiber_room *room, const struct state *state, uint32_t fiber)
{
  return room ? room->judge(room->context, state->position, fiber) : FIBER_STAYS;
}

static const enum fiber_start_end ends[] = {[FIBER_STAYS] = FIBERS_LAID,
                                            [FIBER_OVERLAPS] = FIBERS_OVERLAP,
                                            [FIBER_NO_MEMORY] = FIBERS_NO_MEMORY,
                                            [FIBER_GIVEN_UP] = FIBERS_GIVEN_UP};

/* Lays a fiber at random. A fiber that would be beyond a wall, or that overlaps, is drawn anew, shape and place: what
 * is kept is in equilibrium between the walls. */
static enum fiber_start_end lay_at_random(struct state *state, const struct model *model, uint32_t fiber,
                                          const struct fiber_room *room)
{
  const struct fiber_kind *kind = &model->kind[model->fiber_kind_of[fiber]];
  const uint32_t first = model->fiber_first[fiber];
  uint32_t overlaps = 0;
  for (uint64_t attempt = 0; overlaps < FIBER_MOST_ATTEMPTS; attempt++) {
    const struct site site = {first, attempt, random_place(model, attempt, fiber),
                              random_direction(model, kind, attempt, fiber)};
    layings[kind->start](state->position, model, kind, &site);
    if (!between_walls(state->position, model, kind, first))
      continue;
    const enum fiber_verdict verdict = judge(room, state, fiber);
    if (verdict != FIBER_OVERLAPS)
      return ends[verdict];
    overlaps++;
  }
  return FIBERS_NO_ROOM;
}

static enum fiber_start_end lay_at_place(struct state *state, const struct model *model, uint32_t fiber,
                                         const struct fiber_place *place, const struct fiber_room *room)
{
  const struct fiber_kind *kind = &model->kind[model->fiber_kind_of[fiber]];
  const struct site site = {model->fiber_first[fiber], 0, place->center,
                            vec3_scale(1.0 / vec3_norm(place->direction), place->direction)};
  layings[kind->start](state->position, model, kind, &site);
  return ends[judge(room, state, fiber)];
}

/* Lays all fibers that have places of their own, or all others. */
static enum fiber_start_end lay_fibers(struct state *state, const struct model *model, bool placed,
                                       const struct fiber_room *room, uint32_t *stuck)
{
  uint32_t fiber = 0;
  for (uint32_t k = 0; k < model->kinds; k++)
    for (uint32_t within = 0; within < model->kind[k].count; within++, fiber++) {
      if ((within < model->kind[k].placed) != placed)
        continue;
      const enum fiber_start_end end = placed ? lay_at_place(state, model, fiber, &model->kind[k].place[within], room)
                                              : lay_at_random(state, model, fiber, room);
      *stuck = fiber;
      if (end != FIBERS_LAID)
        return end;
    }
  return FIBERS_LAID;
}

enum fiber_start_end fiber_start(struct state *state, const struct model *model, const struct fiber_room *room,
                                 uint32_t *fiber)
{
  enum fiber_start_end end = lay_fibers(state, model, true, room, fiber);
  if (end == FIBERS_LAID)
    end = lay_fibers(state, model, false, room, fiber);
  start_velocities(state, model);
  return end;
}

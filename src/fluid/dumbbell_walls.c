/*
 * Dumbbells between walls at y = 0 and y = L. A particle that hits a wall of velocity w leaves it with 2 w - v, the
 * spring or not; at a slip wall only v_y is reversed. The spring may pull it back to the wall, so there may be several
 * hits in a flight.
 *
 * Along y a particle is at Y + V t + a t^2/2 +- (r cos(w t) + (u/w) sin(w t))/2. Its acceleration is at most M = |a| +
 * w^2 A/2 with the amplitude A = sqrt(r^2 + u^2/w^2). From a height f and a rate f' the wall is thus not reached before
 * f + f' s - M s^2/2 = 0. That time is gone to, again and again, until the height is a lattice unit: no hit can be
 * jumped over, and near the hit each step squares the error.
 *
 * Near a wall the center may be attracted by a potential (Tao et al. 2008, appendix). It is straight within its reach,
 * so that the center's acceleration is constant there; passing its border is an event as a hit is.
 */
#include "fluid/dumbbell.h"
#include "wall/wall.h"

double dumbbell_wall_energy(const struct model *model, double y)
{
  const struct dumbbell_model *d = &model->dumbbells;
  const double reach = d->range / sqrt(d->spring), near = fmin(y, model->box.cells[1] - y);
  return near < reach ? -d->depth * (1.0 - near / reach) : 0.0;
}

/* What flights between walls have in common. */
struct flight {
  const struct model *model;
  const struct span *span;
  const struct swing *swing; /* of the whole span */
  double edge;               /* a0 */
  double reach, pull;        /* of the potential: a0; acceleration towards the wall, a0/t0^2 */
  struct slit slit;
  struct account account; /* of hits */
};

static struct flight flight_of(const struct model *model, const struct span *span, const struct swing *swing,
                               struct account account)
{
  const struct dumbbell_model *d = &model->dumbbells;
  const double reach = d->depth != 0.0 ? d->range / sqrt(d->spring) : 0.0;
  return (struct flight){model,
                         span,
                         swing,
                         model->box.cells[1],
                         reach,
                         reach > 0.0 ? 0.5 * d->depth / reach : 0.0, /* a dumbbell has the mass 2 */
                         slit_during(model, span->interval),
                         account};
}

/* One dumbbell. */
struct couple {
  int64_t at[3][2], apart[3];
  double v[3][2];
};

static struct couple couple_at(const struct pairs *pairs, uint32_t p)
{
  struct couple c;
  for (int k = 0; k < 3; k++) {
    c.apart[k] = pairs->apart[k][p];
    for (int i = 0; i < 2; i++) {
      c.at[k][i] = pairs->at[k][2 * p + i];
      c.v[k][i] = pairs->v[k][2 * p + i];
    }
  }
  return c;
}

static struct pairs pairs_of_couple(struct couple *c)
{
  return (struct pairs){
      1, {c->at[0], c->at[1], c->at[2]}, {c->v[0], c->v[1], c->v[2]}, {&c->apart[0], &c->apart[1], &c->apart[2]}};
}

/* --- the course along y ------------------------------------------------------------------------------------------ */

/* Between two events. */
struct course {
  double middle, velocity, acceleration; /* of the center: a0, a0/t0, a0/t0^2 */
  double r, u, frequency;
  double most; /* M: the largest acceleration of a particle */
};

static struct course course_of(const struct flight *f, const struct couple *c, double acceleration)
{
  const double w = f->model->dumbbells.frequency, r = (double)c->apart[1] * LATTICE_UNIT;
  const double u = c->v[1][0] - c->v[1][1];
  return (struct course){0.5 * ((double)c->at[1][0] + (double)c->at[1][1]) * LATTICE_UNIT,
                         0.5 * (c->v[1][0] + c->v[1][1]),
                         acceleration,
                         r,
                         u,
                         w,
                         fabs(acceleration) + 0.5 * w * sqrt(w * w * r * r + u * u)};
}

/* Height of particle i above a wall, and its rate, at a time. */
static void height(const struct course *c, const struct flight *f, int i, enum wall wall, double t, double *height,
                   double *rate)
{
  const struct swing s = swing_for(c->frequency, t);
  const double sign = i == 0 ? 1.0 : -1.0, a = c->acceleration;
  const double half = (0.5 + s.return_r) * c->r + s.advance_u * c->u, half_rate = s.pull_r * c->r + s.keep_u * c->u;
  const double y = c->middle + c->velocity * t + 0.5 * a * t * t + sign * half;
  const double v = c->velocity + a * t + sign * half_rate;
  *height = wall == WALL_LOWER ? y : f->edge - y;
  *rate = wall == WALL_LOWER ? v : -v;
}

/* The first time up to `left` at which particle i reaches the wall; `left` if it does not. */
static double time_of_hit(const struct course *c, const struct flight *f, int i, enum wall wall, double left)
{
  const double least = 0x1p-44 * left; /* where height and rate are 0 */
  double t = 0.0;
  while (t < left) {
    double above, rate;
    height(c, f, i, wall, t, &above, &rate);
    if (above <= LATTICE_UNIT && rate < 0.0)
      return t;
    above = fmax(above, 0.0);
    const double root = sqrt(rate * rate + 2.0 * c->most * above);
    const double free = rate < 0.0 ? 2.0 * above / (root - rate) : c->most > 0.0 ? (rate + root) / c->most : left;
    t += fmax(free, least);
  }
  return left;
}

/* --- events ------------------------------------------------------------------------------------------------------ */

/* Where the center is, as the potential of the walls sees it. */
enum region { NEAR_LOWER, BETWEEN, NEAR_UPPER };

static enum region region_of(const struct flight *f, double middle)
{
  return middle < f->reach ? NEAR_LOWER : middle > f->edge - f->reach ? NEAR_UPPER : BETWEEN;
}

static double acceleration_in(const struct flight *f, enum region region)
{
  return region == NEAR_LOWER ? -f->pull : region == NEAR_UPPER ? f->pull : 0.0;
}

/* Time in which the center leaves the region, at least 0, and the region after it; `left` if it does not. */
static double time_of_exit(const struct flight *f, const struct course *c, enum region *region, double left)
{
  if (f->reach == 0.0)
    return left;
  double t = left;
  enum region next = BETWEEN;
  if (*region == BETWEEN) {
    next = c->velocity < 0.0 ? NEAR_LOWER : NEAR_UPPER;
    const double border = c->velocity < 0.0 ? f->reach : f->edge - f->reach;
    t = c->velocity != 0.0 ? (border - c->middle) / c->velocity : left;
  } else {
    const bool lower = *region == NEAR_LOWER;
    const double away = lower ? c->velocity : -c->velocity;
    const double to_go = f->reach - (lower ? c->middle : f->edge - c->middle);
    const double square = away * away - 2.0 * f->pull * to_go;
    t = away > 0.0 && square >= 0.0 ? 2.0 * to_go / (away + sqrt(square)) : left;
  }
  if (!(t < left))
    return left;
  *region = next;
  return fmax(t, 0.0);
}

static void hit(const struct flight *f, struct couple *c, int i, enum wall wall)
{
  const struct vec3 v = {c->v[0][i], c->v[1][i], c->v[2][i]}, after = wall_reflect(&f->slit, wall, v);
  wall_gives(f->account, wall, 1.0, v, after);
  c->v[0][i] = after.x, c->v[1][i] = after.y, c->v[2][i] = after.z;
  c->at[1][i] = wall_height(&f->model->box, wall);
  c->apart[1] = c->at[1][0] - c->at[1][1];
}

/* Both fly for a time without an event. Not 0 if that is out of range. */
static int64_t go_on(const struct flight *f, struct couple *c, double time, double acceleration)
{
  const struct swing swing = time == f->swing->time ? *f->swing : swing_for(f->swing->frequency, time);
  const struct vec3 a = f->span->acceleration;
  const struct pairs pairs = pairs_of_couple(c);
  return pairs_fly(&pairs, 0, &swing, a.x, 0) | pairs_fly(&pairs, 1, &swing, acceleration, 0) |
         pairs_fly(&pairs, 2, &swing, a.z, 0);
}

enum { MOST_EVENTS = 100000 }; /* of one dumbbell in one flight: more are no physics */

/* Not 0 if the flight is out of range. */
static int64_t follow(const struct flight *f, struct couple *c)
{
  double left = f->span->time;
  enum region region = region_of(f, 0.5 * (double)(c->at[1][0] + c->at[1][1]) * LATTICE_UNIT);
  for (int events = 0; left > 0.0; events++) {
    const double acceleration = acceleration_in(f, region);
    const struct course course = course_of(f, c, acceleration);
    if (events == MOST_EVENTS || !(fabs(course.velocity) * left + course.most * left * left < LATTICE_MAX_MOVE))
      return 1;
    double t = left;
    int who = -1;
    enum wall wall = WALL_LOWER;
    for (int i = 0; i < 2; i++)
      for (int k = 0; k < WALLS; k++) {
        const double at = time_of_hit(&course, f, i, (enum wall)k, t);
        if (at < t)
          t = at, who = i, wall = (enum wall)k;
      }
    enum region next = region;
    const double exit = time_of_exit(f, &course, &next, t);
    if (exit < t)
      t = exit, who = -1, region = next;
    if (go_on(f, c, t, acceleration))
      return 1;
    if (acceleration != 0.0)
      account_enter(f->account, acceleration < 0.0 ? WALL_LOWER : WALL_UPPER,
                    (struct vec3){0.0, 2.0 * acceleration * t, 0.0});
    if (who >= 0)
      hit(f, c, who, wall);
    left -= t;
  }
  for (int i = 0; i < 2; i++)
    c->at[1][i] = box_inside(&f->model->box, 1, c->at[1][i]); /* rounding leaves it outside by a lattice unit */
  c->apart[1] = c->at[1][0] - c->at[1][1];
  return 0;
}

/* --- many dumbbells ---------------------------------------------------------------------------------------------- */

enum { BLOCK = 128 };

/* May an event happen to a dumbbell? Numbers of those of n where one may; more of them than do. */
static uint32_t find_near(const struct pairs *pairs, const struct flight *f, uint32_t near[BLOCK])
{
  const double margin = 1e-6, t = f->span->time, per = 1.0 / f->swing->frequency;
  const int64_t *y = pairs->at[1], *apart = pairs->apart[1];
  const double *v = pairs->v[1];
  int64_t far[BLOCK]; /* 1: nothing can happen */
  for (size_t p = 0; p < pairs->n; p++) {
    const double r = pairs_real(apart[p]) * LATTICE_UNIT, u = (v[2 * p] - v[2 * p + 1]) * per;
    const double middle = 0.5 * (pairs_real(y[2 * p]) + pairs_real(y[2 * p + 1])) * LATTICE_UNIT;
    const double other = f->edge - middle, near_wall = middle < other ? middle : other;
    const double low = near_wall - fabs(0.5 * (v[2 * p] + v[2 * p + 1])) * t - margin;
    far[p] = (low > f->reach ? 1 : 0) & (low > 0.0 ? 1 : 0) & (4.0 * low * low > r * r + u * u ? 1 : 0);
  }
  uint32_t count = 0;
  for (uint32_t p = 0; p < pairs->n; p++) {
    near[count] = p;
    count += far[p] == 0;
  }
  return count;
}

/* Those to which events happen fly on their own, from where they were before. */
static int64_t fly_block(const struct pairs *pairs, const struct flight *f)
{
  const struct box *box = &f->model->box;
  const struct vec3 a = f->span->acceleration;
  uint32_t near[BLOCK];
  struct couple couple[BLOCK];
  const uint32_t count = find_near(pairs, f, near);
  int64_t far = 0;
  for (uint32_t k = 0; k < count; k++) {
    couple[k] = couple_at(pairs, near[k]);
    far |= follow(f, &couple[k]);
  }
  far |= pairs_fly(pairs, 0, f->swing, a.x, box->edge[0]);
  far |= pairs_fly(pairs, 1, f->swing, 0.0, 0);
  far |= pairs_fly(pairs, 2, f->swing, a.z, box->edge[2]);
  for (uint32_t k = 0; k < count; k++)
    for (int axis = 0; axis < 3; axis++) {
      pairs->apart[axis][near[k]] = couple[k].apart[axis];
      for (int i = 0; i < 2; i++) {
        const int64_t x = couple[k].at[axis][i];
        pairs->at[axis][2 * near[k] + i] = axis == 1 ? x : lattice_fold(x, box->edge[axis]);
        pairs->v[axis][2 * near[k] + i] = couple[k].v[axis][i];
      }
    }
  return far;
}

static int64_t fly_walls(const struct pairs *pairs, const struct model *model, const struct span *span,
                         const struct swing *swing, struct account account)
{
  const struct flight flight = flight_of(model, span, swing, account);
  int64_t far = 0;
  for (uint32_t p = 0; p < pairs->n && !far; p += BLOCK)
    far = fly_block(&(struct pairs){pairs->n - p < BLOCK ? pairs->n - p : BLOCK,
                                    {pairs->at[0] + 2 * p, pairs->at[1] + 2 * p, pairs->at[2] + 2 * p},
                                    {pairs->v[0] + 2 * p, pairs->v[1] + 2 * p, pairs->v[2] + 2 * p},
                                    {pairs->apart[0] + p, pairs->apart[1] + p, pairs->apart[2] + p}},
                    &flight);
  return far;
}

const struct dumbbell_boundary dumbbells_between_walls = {"walls", fly_walls};

/* A sweep by brute force, to hold the real one against: every vertex against every bond in every image, exact decisions
 * (GMP), the exchange in long double. It shares nothing with src/fiber but the order of the vertices. */
#ifndef UNCROSS_TESTS_REFERENCE_H
#define UNCROSS_TESTS_REFERENCE_H

#include "base/random.h"
#include "contact/contact.h"
#include "exact.h"

/* --- what the sweep tells ----------------------------------------------------------------------------------------- */

enum { MOST_EVENTS = 20000 };

struct events {
  uint32_t n, read;
  struct contact_event event[MOST_EVENTS];
  const struct test_run *run; /* of which the velocities that an exchange leaves are kept, if `after` is given */
  struct vec3 (*after)[4];    /* [MOST_EVENTS] of the vertices of event_vertices */
};

/* The moving vertex, its pivot, the two ends of the standing bond. */
static inline void event_vertices(const struct model *m, const struct contact_event *e, uint32_t vertex[4])
{
  vertex[0] = e->vertex;
  vertex[1] = e->moving_bond == e->vertex ? (uint32_t)m->next[e->vertex] : e->moving_bond;
  vertex[2] = e->standing_bond;
  vertex[3] = (uint32_t)m->next[e->standing_bond];
}

static inline void collect(void *context, const struct contact_event *event)
{
  struct events *e = context;
  assert_true(e->n < MOST_EVENTS);
  if (e->after) {
    uint32_t vertex[4];
    event_vertices(&e->run->model, event, vertex);
    for (int k = 0; k < 4; k++)
      e->after[e->n][k] = e->run->state.velocity[vertex[k]];
  }
  e->event[e->n++] = *event;
}

/* --- the sweep by brute force ------------------------------------------------------------------------------------- */

struct reference {
  const struct model *model;
  struct point *position;
  struct vec3 *velocity;
  struct exact_test exact;
  struct events *told;
  struct collision_counts counts;
  uint64_t image_hits;        /* hits of bonds that are not in the image 0 */
  uint64_t linked_image_hits; /* hits of an image of a bond that shares a vertex */
  uint64_t second_bond;       /* hits of the bond after the vertex */
  uint64_t stopped;           /* bounces that would have crossed something */
  uint64_t touches;           /* standing bonds that are exactly touched, and judged by convention */
  bool by_convention;         /* touches are expected */
  double fast;                /* share of the vertices that are thrown 150 times as far as the others */
  uint64_t seed;
};

struct found {
  uint32_t moving, standing;
  int64_t image[3];
  double time, s, s_standing;
};

/* Images of [low2, high2] that meet [low, high]. */
static inline void images_between(int64_t low, int64_t high, int64_t low2, int64_t high2, int64_t edge,
                                  int64_t range[2])
{
  range[0] = -floor_divide(high2 - low, edge);
  range[1] = floor_divide(high - low2, edge);
}

static inline int64_t least(int64_t a, int64_t b)
{
  return a < b ? a : b;
}

static inline int64_t most(int64_t a, int64_t b)
{
  return a > b ? a : b;
}

static inline void axis_images(int64_t p, int64_t q, int64_t r, int64_t a, int64_t b, int64_t edge, int64_t range[2])
{
  images_between(least(p, least(q, r)), most(p, most(q, r)), least(a, b), most(a, b), edge, range);
}

static inline bool meets(const struct model *m, int64_t bond, int64_t other)
{
  if (bond < 0 || other < 0)
    return false;
  return bond == other || m->next[bond] == other || m->next[other] == bond || m->next[bond] == m->next[other];
}

/* Padding: "All neighboring bonds (j,j+1) which are not directly linked to the bonds (i-1,i) or (i,i+1) must be
 * checked". Literally: a bond linked to either is checked against neither. Else only bonds that share a vertex with the
 * moving bond itself are left out. Only the bond itself is linked, not its images. */
static inline bool left_out(const struct model *m, int64_t before, int64_t after, int64_t moving, int64_t standing)
{
  if (m->crossing.exclusion == EXCLUSION_PAPER)
    return meets(m, before, standing) || meets(m, after, standing);
  return meets(m, moving, standing);
}

/* Does a touch count? The rule of docs/conventions.md: a volume of zero is positive, but negative where the moving
 * vertex is the first of its bond. */
static inline bool touch_counts(struct exact_test *x, struct point from, struct point to, struct point pivot,
                                struct point a, struct point b, bool first)
{
  const int before = exact_orientation(x, a, b, pivot, from), after = exact_orientation(x, a, b, pivot, to);
  const bool starts_above = first ? before > 0 : before >= 0, ends_above = first ? after > 0 : after >= 0;
  const bool path_above = exact_orientation(x, a, b, from, to) >= 0;
  const bool a_above = exact_orientation(x, pivot, from, to, a) >= 0;
  const bool b_above = exact_orientation(x, pivot, from, to, b) >= 0;
  return starts_above != ends_above && path_above == starts_above && a_above != b_above;
}

/* All hits of one moving bond. */
static inline uint32_t find_hits(struct reference *ref, uint32_t vertex, int64_t moving, struct point to,
                                 struct found *found)
{
  const struct model *m = ref->model;
  const int64_t before = m->prev[vertex], after = m->next[vertex] >= 0 ? (int64_t)vertex : -1, *edge = m->box.edge;
  const struct point from = ref->position[vertex];
  const struct point pivot = ref->position[moving == vertex ? m->next[vertex] : m->prev[vertex]];
  uint32_t n = 0;
  for (uint32_t bond = 0; bond < m->vertices; bond++) {
    if (m->next[bond] < 0 || bond == before || bond == after)
      continue; /* the bonds that move, images of them included */
    const struct point a = ref->position[bond], b = ref->position[m->next[bond]];
    int64_t x[2], y[2], z[2];
    axis_images(from.x, to.x, pivot.x, a.x, b.x, edge[0], x);
    axis_images(from.y, to.y, pivot.y, a.y, b.y, edge[1], y);
    axis_images(from.z, to.z, pivot.z, a.z, b.z, edge[2], z);
    for (int64_t i = x[0]; i <= x[1]; i++)
      for (int64_t j = y[0]; j <= y[1]; j++)
        for (int64_t k = z[0]; k <= z[1]; k++) {
          if (i == 0 && j == 0 && k == 0 && left_out(m, before, after, moving, bond))
            continue;
          const struct point shift = {i * edge[0], j * edge[1], k * edge[2]};
          const struct point a1 = {a.x + shift.x, a.y + shift.y, a.z + shift.z};
          const struct point b1 = {b.x + shift.x, b.y + shift.y, b.z + shift.z};
          enum exact_verdict verdict = exact_crossing(&ref->exact, from, to, pivot, a1, b1);
          if (verdict == EXACT_TOUCH && !ref->by_convention)
            fail_msg("seed %lu: an exact touch by chance", (unsigned long)ref->seed);
          struct found *f = &found[n];
          *f = (struct found){(uint32_t)moving, bond, {i, j, k}, 0, 0, 0};
          if (verdict == EXACT_HIT)
            exact_contact(&ref->exact, &f->time, &f->s, &f->s_standing);
          ref->touches += verdict == EXACT_TOUCH;
          if (verdict == EXACT_MISS ||
              (verdict == EXACT_TOUCH && !touch_counts(&ref->exact, from, to, pivot, a1, b1, moving == vertex)))
            continue;
          n++;
          ref->image_hits += i || j || k;
          ref->linked_image_hits += meets(m, moving, bond);
          ref->second_bond += moving == vertex;
        }
  }
  return n;
}

/* Eqs. (21)-(25), (28) with a mass for each vertex: dP = 2 (v_rel.n) / sum(lever^2 / M). */
static inline double exchange_by_hand(struct reference *ref, const struct found *f, uint32_t vertex, struct point to)
{
  const struct model *m = ref->model;
  const uint32_t pivot = (uint32_t)(f->moving == vertex ? m->next[vertex] : m->prev[vertex]);
  const uint32_t end[4] = {vertex, pivot, f->standing, (uint32_t)m->next[f->standing]};
  const long double lever[4] = {1 - f->s, f->s, -(1 - (long double)f->s_standing), -f->s_standing};
  const struct vec3 move = point_difference(to, ref->position[vertex]);
  const struct vec3 p = vec3_add_scaled(point_difference(ref->position[pivot], ref->position[vertex]), -f->time, move);
  struct vec3 n = vec3_cross(p, point_difference(ref->position[end[3]], ref->position[end[2]]));
  n = vec3_scale((vec3_dot(n, move) < 0.0 ? -1.0 : 1.0) / vec3_norm(n), n);
  long double approach = 0, compliance = 0;
  for (int k = 0; k < 4; k++) {
    approach += lever[k] * vec3_dot(ref->velocity[end[k]], n);
    compliance += lever[k] * lever[k] / m->mass[end[k]];
  }
  const long double dp = 2 * approach / compliance;
  for (int k = 0; k < 4; k++)
    ref->velocity[end[k]] = vec3_add_scaled(ref->velocity[end[k]], (double)(-lever[k] * dp / m->mass[end[k]]), n);
  return (double)dp;
}

/* The events told of this vertex are exactly the hits found; the first of them is executed. Returns its time. */
static inline double compare_events(struct reference *ref, uint32_t vertex, const struct found *found, uint32_t n,
                                    struct point to)
{
  uint32_t first = 0, executed = 0;
  for (uint32_t k = 1; k < n; k++)
    if (found[k].time < found[first].time)
      first = k;
  const double dp = exchange_by_hand(ref, &found[first], vertex, to);
  for (uint32_t k = 0; k < n; k++) {
    const struct found *f = &found[k];
    bool matched = false;
    for (uint32_t e = ref->told->read; e < ref->told->read + n && e < ref->told->n; e++) {
      const struct contact_event *t = &ref->told->event[e];
      if (t->vertex != vertex || t->moving_bond != f->moving || t->standing_bond != f->standing ||
          t->image[0] != f->image[0] || t->image[1] != f->image[1] || t->image[2] != f->image[2])
        continue;
      matched = true;
      assert_close(t->hit.time, f->time, 1e-7);
      assert_close(t->hit.s, f->s, 1e-7);
      assert_close(t->hit.s_standing, f->s_standing, 1e-7);
      assert_true(t->executed == (k == first));
      assert_close(t->impulse, k == first ? dp : 0.0, 1e-6 * (1.0 + fabs(dp)));
      executed += t->executed;
    }
    if (!matched)
      fail_msg("seed %lu: vertex %u, bond %u: hit of bond %u image %ld %ld %ld was not seen", (unsigned long)ref->seed,
               vertex, f->moving, f->standing, (long)f->image[0], (long)f->image[1], (long)f->image[2]);
  }
  assert_int_equal(executed, 1);
  ref->told->read += n;
  ref->counts.possible += n;
  ref->counts.executed++;
  ref->counts.negative += dp < 0.0;
  return found[first].time;
}

/* The same where touches are expected. Times of hits may then tie exactly, and normals are free where bonds are
 * parallel: the sweep's own choice among the first, and its own exchange, are taken over to the bit. */
static inline void compare_touches(struct reference *ref, uint32_t vertex, const struct found *found, uint32_t n)
{
  struct events *told = ref->told;
  const struct contact_event *executed = NULL;
  uint32_t matched = 0;
  for (uint32_t e = told->read; e < told->read + n && e < told->n; e++) {
    const struct contact_event *t = &told->event[e];
    for (uint32_t k = 0; k < n; k++)
      matched += t->vertex == vertex && t->moving_bond == found[k].moving && t->standing_bond == found[k].standing &&
                 t->image[0] == found[k].image[0] && t->image[1] == found[k].image[1] &&
                 t->image[2] == found[k].image[2];
    if (!t->executed)
      continue;
    assert_null(executed);
    executed = t;
    uint32_t end[4];
    event_vertices(ref->model, t, end);
    for (int k = 0; k < 4; k++)
      ref->velocity[end[k]] = told->after[e][k];
  }
  if (matched != n || !executed)
    fail_msg("seed %lu: vertex %u: %u hits, %u told", (unsigned long)ref->seed, vertex, n, matched);
  for (uint32_t e = told->read; e < told->read + n; e++)
    assert_true(told->event[e].hit.time >= executed->hit.time);
  told->read += n;
  ref->counts.possible += n;
  ref->counts.executed++;
  ref->counts.negative += executed->impulse < 0.0;
}

/* What is left of the step after a hit at this time, with the velocity that the exchange left: the vertex goes there if
 * nothing is in the way. */
static inline void bounce_by_hand(struct reference *ref, uint32_t i, struct vec3 before, double time, double dt,
                                  struct found *found)
{
  const struct vec3 after = ref->velocity[i];
  struct point to = ref->position[i];
  to.x += llrint(0x1p40 * dt * (time * before.x + (1.0 - time) * after.x));
  to.y += llrint(0x1p40 * dt * (time * before.y + (1.0 - time) * after.y));
  to.z += llrint(0x1p40 * dt * (time * before.z + (1.0 - time) * after.z));
  uint32_t hits = 0;
  if (ref->model->prev[i] >= 0)
    hits += find_hits(ref, i, ref->model->prev[i], to, found);
  if (ref->model->next[i] >= 0)
    hits += find_hits(ref, i, i, to, found + hits);
  if (hits == 0)
    ref->position[i] = to;
  else
    ref->stopped++;
}

static inline void sweep_by_hand(struct reference *ref, double dt, uint64_t step, uint32_t sweep)
{
  const uint32_t n = ref->model->vertices;
  uint32_t *order = malloc(n * sizeof *order);
  struct found *found = malloc(1000 * sizeof *found);
  random_permutation(ref->model->seed, RANDOM_VERTEX_ORDER, sweep, step, n, order); /* test_random.c */
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t i = order[k];
    const struct vec3 v = ref->velocity[i];
    struct point to = ref->position[i];
    to.x += llrint(0x1p40 * (dt * v.x));
    to.y += llrint(0x1p40 * (dt * v.y));
    to.z += llrint(0x1p40 * (dt * v.z));
    uint32_t hits = 0;
    if (ref->model->prev[i] >= 0)
      hits += find_hits(ref, i, ref->model->prev[i], to, found);
    if (ref->model->next[i] >= 0)
      hits += find_hits(ref, i, i, to, found + hits);
    ref->counts.moves++;
    if (hits == 0)
      ref->position[i] = to;
    else if (ref->by_convention)
      compare_touches(ref, i, found, hits);
    else {
      const double time = compare_events(ref, i, found, hits, to);
      if (ref->model->crossing.rejection == REJECTION_BOUNCE)
        bounce_by_hand(ref, i, v, time, dt, found);
    }
  }
  free(order);
  free(found);
}

/* --- sweeps compared
 * -------------------------------------------------------------------------------------------------- */

static inline void copy_state(struct reference *ref, const struct state *state)
{
  memcpy(ref->position, state->position, state->vertices * sizeof *ref->position);
  memcpy(ref->velocity, state->velocity, state->vertices * sizeof *ref->velocity);
}

/* The two have done the same: places to a lattice unit or two (an exchanged velocity may differ in its last bits), and
 * velocities to rounding. */
static inline void compare_states(const struct reference *ref, const struct state *state)
{
  for (uint32_t v = 0; v < state->vertices; v++) {
    const struct point p = ref->position[v], q = state->position[v];
    if (llabs(p.x - q.x) > 1000 || llabs(p.y - q.y) > 1000 || llabs(p.z - q.z) > 1000)
      fail_msg("seed %lu: vertex %u ends elsewhere", (unsigned long)ref->seed, v);
    assert_close(vec3_norm(vec3_sub(ref->velocity[v], state->velocity[v])), 0.0, 1e-6);
  }
}

/* Suspensions on a coarse lattice, where bonds meet exactly all the time: vertices at whole eighths of a0 move by whole
 * eighths (dt is a power of 2), and after a sweep those that an exchange led astray are put back. */
#define COARSE ((int64_t)1 << 37)

static inline struct vec3 coarse_velocity(struct dice *d, double dt)
{
  struct point k = dice_point(d, 2, 2, 2);
  return vec3_scale(0.125 / dt, (struct vec3){(double)k.x, (double)k.y, (double)k.z});
}

static inline void snap(struct test_run *r)
{
  for (uint32_t v = 0; v < r->state.vertices; v++) {
    struct point *p = &r->state.position[v];
    p->x -= p->x % COARSE;
    p->y -= p->y % COARSE;
    p->z -= p->z % COARSE;
  }
  r->work.contact.neighbors.built = false; /* they were moved by hand */
}

static inline struct test_run coarse(int cells, uint32_t fibers, uint32_t vertices, struct dice *d)
{
  struct model m = test_model(cells, cells, cells, 0, 0x1p-6, 2);
  m.seed = dice_u64(d);
  m.crossing.exclusion = dice_u64(d) & 1 ? EXCLUSION_PAPER : EXCLUSION_SHARED_VERTEX;
  test_add_kind(&m, fibers, vertices);
  struct test_run r = dice_run(m, d);
  for (uint32_t v = 0; v < r.state.vertices; v++) {
    if (v == r.model.fiber_first[r.model.fiber_of[v]])
      continue;
    struct point step = dice_point(d, 3, 3, 3), *p = &r.state.position[v];
    *p = (struct point){p[-1].x + step.x * COARSE, p[-1].y + step.y * COARSE, p[-1].z + step.z * COARSE};
  }
  snap(&r);
  return r;
}

static inline struct vec3 thrown(const struct test_run *r, struct dice *d, double size, const struct reference *how)
{
  if (how->by_convention)
    return coarse_velocity(d, r->model.time_step);
  const double factor = how->fast > 0.0 && dice_between(d, 0.0, 1.0) < how->fast ? 150.0 : 1.0;
  return dice_vector(d, factor * size / r->model.time_step);
}

/* Runs some sweeps of a run and of the reference from the same state each; velocities are thrown anew for each sweep,
 * so that the typical move is `size`. Totals are added to *total. */
static inline void compare_sweeps(struct test_run *r, struct dice *d, int sweeps, double size, uint64_t seed,
                                  struct reference *total)
{
  struct events *told = calloc(1, sizeof *told);
  struct reference ref = {.model = &r->model, .told = told, .seed = seed, .by_convention = total->by_convention};
  told->run = r;
  told->after = ref.by_convention ? malloc(MOST_EVENTS * sizeof *told->after) : NULL;
  ref.position = malloc(r->state.vertices * sizeof *ref.position);
  ref.velocity = malloc(r->state.vertices * sizeof *ref.velocity);
  exact_open(&ref.exact);
  const struct contact_log log = {collect, told};
  for (int k = 0; k < sweeps; k++) {
    told->n = told->read = 0;
    for (uint32_t v = 0; v < r->state.vertices; v++)
      r->state.velocity[v] = thrown(r, d, size, total);
    copy_state(&ref, &r->state);
    const double fraction = k % 3 == 2 ? 0.5 : 1.0;
    const uint32_t sweep = (uint32_t)k % 2;
    assert_true(contact_drift(&r->state, &r->model, &r->work.contact, fraction, 100 + (uint64_t)k, sweep, &log,
                              &r->work.fault));
    sweep_by_hand(&ref, fraction * r->model.time_step, 100 + (uint64_t)k, sweep);
    if (told->read != told->n)
      fail_msg("seed %lu: %u hits were told that are none", (unsigned long)seed, told->n - told->read);
    if (ref.by_convention)
      assert_memory_equal(ref.position, r->state.position, r->state.vertices * sizeof *ref.position);
    compare_states(&ref, &r->state);
    if (ref.by_convention)
      snap(r);
  }
  assert_true(r->state.counts.moves == ref.counts.moves && r->state.counts.possible == ref.counts.possible);
  assert_true(r->state.counts.executed == ref.counts.executed && r->state.counts.negative == ref.counts.negative);
  total->counts.moves += ref.counts.moves;
  total->counts.possible += ref.counts.possible;
  total->counts.executed += ref.counts.executed;
  total->counts.negative += ref.counts.negative;
  total->image_hits += ref.image_hits;
  total->linked_image_hits += ref.linked_image_hits;
  total->second_bond += ref.second_bond;
  total->touches += ref.touches;
  total->stopped += ref.stopped;
  exact_close(&ref.exact);
  free(ref.position);
  free(ref.velocity);
  free(told->after);
  free(told);
}

static inline void report(const struct reference *t)
{
  print_message("  %lu moves, %lu hits (%lu in images, %lu of the bond behind), %lu executed, %lu negative\n",
                (unsigned long)t->counts.moves, (unsigned long)t->counts.possible, (unsigned long)t->image_hits,
                (unsigned long)t->second_bond, (unsigned long)t->counts.executed, (unsigned long)t->counts.negative);
}

/* A dense suspension of fibers and rings of different masses, vertices thrown images away. */
static inline struct test_run dense(int lx, int ly, int lz, uint32_t fibers, uint32_t vertices, double bond,
                                    struct dice *d)
{
  struct model m = test_model(lx, ly, lz, 0, 0.01, 2);
  m.seed = dice_u64(d);
  m.crossing.exclusion = dice_u64(d) & 1 ? EXCLUSION_PAPER : EXCLUSION_SHARED_VERTEX;
  test_add_kind(&m, fibers, vertices);
  if (fibers > 1) {
    struct fiber_kind *ring = test_add_kind(&m, fibers / 2, 4);
    ring->ring = true;
    ring->mass = 1.25;
  }
  for (uint32_t k = 0; k < m.kinds; k++) /* of bonds that a small box allows; here they are laid by hand */
    m.kind[k].bond_length = fmin(0.5, 0.25 * box_shortest_edge(&m.box));
  struct test_run r = dice_run(m, d);
  for (uint32_t v = 0; v < r.state.vertices; v++) {
    const uint32_t first = r.model.fiber_first[r.model.fiber_of[v]];
    if (v == first)
      continue;
    if (r.model.mass[v] != 5.0) { /* corners of a crumpled square */
      const uint32_t i = v - first;
      struct vec3 at = {i == 1 || i == 2 ? 0.8 * bond : 0.0, i >= 2 ? 0.8 * bond : 0.0, 0};
      r.state.position[v] = point_move(r.state.position[first], vec3_add(at, dice_vector(d, 0.1 * bond)));
    } else {
      r.state.position[v] = point_move(r.state.position[v - 1], vec3_scale(bond, dice_direction(d)));
    }
  }
  return r;
}

#endif

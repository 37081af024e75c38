/* Whole drifts of the rule `event-driven`, audited by brute force (flight_replay.h). `make stress` runs the same for
 * longer. */
#include "contact/flight_replay.h"
#include "contact/impulse.h"

static void dense_suspensions(void **unused)
{
  (void)unused;
  for (int k = 0; k < REPLAYED; k++)
    replay_suspensions(dice_seed(1801), &replayed[k], 6);
}

/* --- clusters of contacts ----------------------------------------------------------------------------------------- */

/* A contact changes the flights of its four vertices, and depends on those of all that pull at them, two further along
 * their fibers. Contacts that share such a vertex are a cluster. The clusters of a finished list of contacts are worked
 * on one after the other, in any order: the velocities and places at the end are the drift's, to the bit. Before the
 * list is known an answer can make new contacts: contact/schedules.h. */
struct told {
  struct contact_event event;
  int32_t tick;
  uint32_t vertex[4], cluster;
};

struct many_told {
  const struct model *model;
  uint32_t count;
  struct told at[2000];
};

static void tell(void *context, const struct contact_event *e)
{
  struct many_told *all = context;
  assert_true(all->count < sizeof all->at / sizeof *all->at);
  all->at[all->count++] = (struct told){.event = *e,
                                        .tick = (int32_t)(e->hit.time * FLIGHT_TICKS),
                                        .vertex = {e->moving_bond, (uint32_t)all->model->next[e->moving_bond],
                                                   e->standing_bond, (uint32_t)all->model->next[e->standing_bond]}};
}

static uint32_t root_of(uint32_t *group, uint32_t v)
{
  while (group[v] != v)
    v = group[v] = group[group[v]];
  return v;
}

static void join(uint32_t *group, uint32_t a, uint32_t b)
{
  group[root_of(group, a)] = root_of(group, b);
}

/* Numbers of clusters; returns how many. reach: how far along a fiber. */
static uint32_t find_clusters(struct many_told *all, int reach)
{
  const struct model *m = all->model;
  uint32_t *group = malloc(m->vertices * sizeof *group), clusters = 0;
  for (uint32_t v = 0; v < m->vertices; v++)
    group[v] = v;
  for (uint32_t k = 0; k < all->count; k++)
    for (int end = 0; end < 4; end++) {
      join(group, all->at[k].vertex[end], all->at[k].vertex[0]);
      int64_t up = all->at[k].vertex[end], down = up;
      for (int step = 0; step < reach; step++) {
        up = up < 0 ? up : m->next[up], down = down < 0 ? down : m->prev[down];
        if (up >= 0)
          join(group, (uint32_t)up, all->at[k].vertex[0]);
        if (down >= 0)
          join(group, (uint32_t)down, all->at[k].vertex[0]);
      }
    }
  for (uint32_t k = 0; k < all->count; k++) {
    all->at[k].cluster = root_of(group, all->at[k].vertex[0]);
    bool known = false;
    for (uint32_t j = 0; j < k && !known; j++)
      known = all->at[j].cluster == all->at[k].cluster;
    clusters += !known;
  }
  free(group);
  return clusters;
}

struct flown {
  struct point *at, *rate;
  int32_t tick;
};

static struct point flown_place(const void *context, uint32_t vertex)
{
  const struct flown *f = context;
  return after_ticks(f->at[vertex], f->rate[vertex], f->tick);
}

static void answer(const struct test_run *r, const struct told *c, struct flown *f, struct vec3 *velocity)
{
  const double dt = r->model.time_step;
  struct contact_geometry at = {c->event.hit.s, c->event.hit.s_standing, c->event.hit.normal, 0.0};
  struct contact_end end[4];
  f->tick = c->tick;
  for (int k = 0; k < 4; k++)
    end[k] = (struct contact_end){&velocity[c->vertex[k]], r->model.inverse_mass[c->vertex[k]],
                                  r->work.contact.force(&r->model, c->vertex[k], flown_place, f)};
  impulse_at_own_time(end, &at, -0.5 * dt + dt * ((double)c->tick / FLIGHT_TICKS));
  for (int k = 0; k < 4; k++) {
    const uint32_t v = c->vertex[k];
    const struct point here = flown_place(f, v), rate = rate_by_hand(velocity[v], dt);
    f->at[v] = after_ticks(here, rate, -(int64_t)c->tick), f->rate[v] = rate;
  }
}

/* Works on the clusters in a random order. */
static void answer_all(const struct test_run *r, struct many_told *all, struct flown *f, struct vec3 *velocity,
                       struct dice *d)
{
  bool done[sizeof all->at / sizeof *all->at] = {false};
  for (uint32_t left = all->count; left > 0;) {
    uint32_t k = (uint32_t)dice_integer(d, 0, all->count - 1);
    if (done[k])
      continue;
    const uint32_t cluster = all->at[k].cluster;
    for (k = 0; k < all->count; k++)
      if (all->at[k].cluster == cluster) {
        answer(r, &all->at[k], f, velocity);
        done[k] = true;
        left--;
      }
  }
}

static bool ends_alike(const struct test_run *r, struct flown *f, const struct vec3 *velocity)
{
  f->tick = FLIGHT_TICKS;
  for (uint32_t v = 0; v < r->state.vertices; v++) {
    const struct point end = flown_place(f, v);
    if (memcmp(&end, &r->state.position[v], sizeof end) != 0 ||
        memcmp(&velocity[v], &r->state.velocity[v], sizeof *velocity) != 0)
      return false;
  }
  return true;
}

/* Drifts of fibers with springs and bends; clusters by a reach of two vertices, or less. Returns how many end alike. */
static int clusters_in_any_order_with(int reach, int drifts, uint64_t *contacts, uint64_t *clusters)
{
  struct dice d = {dice_seed(1802)};
  int alike = 0;
  for (int k = 0; k < drifts; k++) {
    struct test_run r = dense(8, 8, 8, 160, 8, 0.54, &d);
    follow_rule(&r, CROSSING_EVENT_DRIVEN);
    const uint32_t n = r.state.vertices;
    struct many_told *all = calloc(1, sizeof *all);
    all->model = &r.model;
    struct flown f = {malloc(n * sizeof *f.at), malloc(n * sizeof *f.rate), 0};
    struct vec3 *velocity = malloc(n * sizeof *velocity);
    for (uint32_t v = 0; v < n; v++) {
      velocity[v] = r.state.velocity[v] = dice_vector(&d, 0.03 / r.model.time_step);
      f.at[v] = r.state.position[v], f.rate[v] = rate_by_hand(velocity[v], r.model.time_step);
    }
    const struct contact_log log = {tell, all};
    assert_true(contact_drift(&r.state, &r.model, &r.work.contact, 1.0, 7, 0, &log, &r.work.fault));
    assert_int_equal(r.state.counts.rigid, 0);
    *clusters += find_clusters(all, reach);
    *contacts += all->count;
    answer_all(&r, all, &f, velocity, &d);
    alike += ends_alike(&r, &f, velocity);
    free(all), free(f.at), free(f.rate), free(velocity);
    test_end(&r);
  }
  return alike;
}

static void clusters_in_any_order(void **unused)
{
  (void)unused;
  uint64_t contacts = 0, clusters = 0, few = 0, many = 0;
  const int drifts = 12, alike = clusters_in_any_order_with(2, drifts, &contacts, &clusters);
  print_message("  %d drifts of %d end alike; %lu contacts in %lu clusters\n", alike, drifts, (unsigned long)contacts,
                (unsigned long)clusters);
  assert_int_equal(alike, drifts);
  assert_true(clusters > 10 * (uint64_t)drifts && contacts > clusters);
  /* Contacts that share no vertex, but pull at each other through a bend, have an order. */
  assert_true(clusters_in_any_order_with(0, drifts, &few, &many) < drifts && many > clusters);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(dense_suspensions),
      cmocka_unit_test(clusters_in_any_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The same bits whatever happens between steps to what is not state: memory order, scratch, sorting, restarts. */
#include "exact.h"
#include "mpc/grid.h"
#include "mpc/sort.h"

enum { STEPS = 120, VARIANTS = 8 };

static struct model variant(int k)
{
  struct model m = test_model(5, 4, 6, 5, 0.02, 2);
  m.scheme = (enum scheme)(k % 3);
  m.solvent.thermostat = (enum thermostat_kind)(k / 2 % 3);
  m.solvent.hydrodynamics = k % 4 != 1;
  m.crossing.exclusion = k % 2 ? EXCLUSION_PAPER : EXCLUSION_SHARED_VERTEX;
  if (k >= 4) {
    m.solvent.rotation_angle = 129.0;
    m.solvent.acceleration = (struct vec3){0.05, 0, -0.02};
  }
  test_add_kind(&m, 50, 8)->bending = 8.0;
  struct fiber_kind *ring = test_add_kind(&m, 6, 7);
  ring->ring = true;
  ring->mass = 1.5;
  ring->bending = 2.0;
  ring->start = START_CIRCLE;
  m.seed = dice_seed(1401) + (uint64_t)k;
  return m;
}

typedef void disturbance(struct test_run *, struct dice *, uint64_t step);

static void leave_alone(struct test_run *r, struct dice *d, uint64_t step)
{
  (void)r, (void)d, (void)step;
}

static void rebuild_work(struct test_run *r, struct dice *d, uint64_t step)
{
  (void)d, (void)step;
  work_free(&r->work);
  assert_true(work_alloc(&r->work, &r->model));
}

static void sort_solvent(struct test_run *r, struct dice *d, uint64_t step)
{
  (void)d;
  mpc_sort(&r->state, &r->model, &r->work.mpc);
  r->work.mpc.since_sort = (uint32_t)step * 7; /* and its own sorting comes at other times */
}

static void shuffle_at_start(struct test_run *r, struct dice *d, uint64_t step)
{
  if (step == 0)
    shuffle_memory(&r->state, d);
}

static void shuffle_always(struct test_run *r, struct dice *d, uint64_t step)
{
  (void)step;
  shuffle_memory(&r->state, d);
}

static void forget_neighbors(struct test_run *r, struct dice *d, uint64_t step)
{
  if (dice_integer(d, 0, 9) == 0 || step == 0)
    r->work.contact.neighbors.built = false;
}

/* The state alone is carried over to new memory, as by a checkpoint. */
static void restart(struct test_run *r, struct dice *d, uint64_t step)
{
  if (step % 17 != 5)
    return;
  struct state fresh;
  assert_true(state_alloc(&fresh, &r->model));
  const struct solvent *s = &r->state.solvent;
  fresh.step = r->state.step;
  fresh.solvent_lag = r->state.solvent_lag;
  fresh.counts = r->state.counts;
  for (uint32_t i = 0; i < s->n; i++) { /* in id order */
    uint32_t id = s->id[i];
    fresh.solvent.x[id] = s->x[i], fresh.solvent.y[id] = s->y[i], fresh.solvent.z[id] = s->z[i];
    fresh.solvent.vx[id] = s->vx[i], fresh.solvent.vy[id] = s->vy[i], fresh.solvent.vz[id] = s->vz[i];
  }
  memcpy(fresh.position, r->state.position, fresh.vertices * sizeof *fresh.position);
  memcpy(fresh.velocity, r->state.velocity, fresh.vertices * sizeof *fresh.velocity);
  state_free(&r->state);
  r->state = fresh;
  rebuild_work(r, d, step);
}

struct outcome {
  uint64_t hash;
  struct collision_counts counts;
};

static struct outcome run(int k, disturbance *disturb)
{
  struct dice d = {dice_seed(1402) + (uint64_t)k};
  struct test_run r = test_start(variant(k));
  for (uint64_t step = 0; step < STEPS; step++) {
    disturb(&r, &d, step);
    test_steps(&r, 1);
  }
  struct outcome out = {state_hash(&r.state), r.state.counts};
  test_end(&r);
  return out;
}

static void same_bits(void **unused)
{
  (void)unused;
  static const struct {
    const char *name;
    disturbance *disturb;
  } disturbances[] = {
      {"again", leave_alone},
      {"work rebuilt every step", rebuild_work},
      {"solvent sorted every step", sort_solvent},
      {"memory shuffled at the start", shuffle_at_start},
      {"memory shuffled every step", shuffle_always},
      {"neighbors forgotten now and then", forget_neighbors},
      {"restarts", restart},
  };
  uint64_t seen[VARIANTS];
  for (int k = 0; k < VARIANTS; k++) {
    const struct outcome plain = run(k, leave_alone);
    print_message("  variant %d: %lu crossings prevented\n", k, (unsigned long)plain.counts.executed);
    assert_true(plain.counts.executed > 15);
    seen[k] = plain.hash;
    for (int other = 0; other < k; other++)
      assert_true(seen[other] != plain.hash); /* options and seeds do matter */
    for (size_t n = 0; n < sizeof disturbances / sizeof *disturbances; n++) {
      const struct outcome other = run(k, disturbances[n].disturb);
      if (other.hash != plain.hash || memcmp(&other.counts, &plain.counts, sizeof plain.counts) != 0)
        fail_msg("variant %d, %s: other bits", k, disturbances[n].name);
    }
  }
}

/* The hash sees every number of the state, and nothing but the state. */
static void hash_sees_every_bit(void **unused)
{
  (void)unused;
  struct test_run r = test_start(variant(0));
  const uint64_t hash = state_hash(&r.state);
  struct solvent *s = &r.state.solvent;
  const uint32_t last = s->n - 1;
  void *words[] = {&s->x[0],
                   &s->y[last],
                   &s->z[5],
                   &s->vx[last],
                   &s->vy[0],
                   &s->vz[3],
                   &r.state.position[r.state.vertices - 1].z,
                   &r.state.position[0].y,
                   &r.state.position[3].x,
                   &r.state.velocity[0].x,
                   &r.state.velocity[r.state.vertices - 1].z,
                   &r.state.velocity[2].y,
                   &r.state.step};
  for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
    uint64_t word;
    memcpy(&word, words[k], sizeof word);
    word ^= 1;
    memcpy(words[k], &word, sizeof word);
    assert_true(state_hash(&r.state) != hash);
    word ^= 1;
    memcpy(words[k], &word, sizeof word);
  }
  r.state.solvent_lag++;
  assert_true(state_hash(&r.state) != hash);
  r.state.solvent_lag--;
  uint32_t id = s->id[0]; /* two particles that trade ids are another state */
  s->id[0] = s->id[1], s->id[1] = id;
  assert_true(state_hash(&r.state) != hash);
  s->id[1] = s->id[0], s->id[0] = id;
  r.state.counts.possible++;
  assert_true(state_hash(&r.state) == hash);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(same_bits), cmocka_unit_test(hash_sees_every_bit)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

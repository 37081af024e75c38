/* Checkpoints: the same bits back, the old one kept when the new one fails, damage found. */
#include "files/files.h"

#include <errno.h>

#include "base/random.h"
#include "files/hdf5.h"

struct memory {
  double sums[3];
  int64_t counts[2];
};

/* Observers' memory with values that only an exact copy brings back. */
static const struct memory some_memory = {{-0.0, 0x1.fffffffffffffp-1000, INFINITY}, {INT64_MIN, 7}};

static void list_blocks(struct memory *memory, struct observe_block blocks[3])
{
  blocks[0] = (struct observe_block){"dynamics/kind1/sums", false, 3, memory->sums, false, false, false};
  blocks[1] = (struct observe_block){"dynamics/kind1/counts", true, 2, memory->counts, false, false, true};
  blocks[2] = (struct observe_block){"nothing yet", false, 0, NULL, false, false, false};
}

static const struct checkpoint_head some_head = {.fingerprint = 0xfedcba9876543210u,
                                                 .seed = UINT64_MAX,
                                                 .wall_seconds = 12.5,
                                                 .start_energy = -3.25,
                                                 .start_momentum = {1.0, -2.0, 0x1p-1074},
                                                 .version = "0.1.0"};

static const char some_scene[] = "box: [6, 5, 7] # \xce\xb3 = 5\n";

static bool write_some(const char *path, const struct test_run *r, struct message *message)
{
  struct memory memory = some_memory;
  struct observe_block blocks[3];
  struct checkpoint_head head = some_head;
  list_blocks(&memory, blocks);
  return checkpoint_write(path, &head, &r->model, &r->state, blocks, 3, some_scene, message);
}

static bool read_state(const char *path, const struct model *model, struct state *state, struct message *message)
{
  struct checkpoint_head head;
  message->text[0] = '\0';
  return checkpoint_read(path, model, &head, state, NULL, 0, message);
}

/* To be freed; NULL if it cannot be read. */
static char *scene_text(const char *path)
{
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  char *text = file < 0 ? NULL : h5_text_read(file, "scene");
  h5_close(file);
  return text;
}

static void everything_comes_back(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  struct message message;
  struct test_run r = small_run(41);
  assert_true(r.state.solvent_lag > 0);
  if (!write_some(path, &r, &message))
    fail_msg("%s", message.text);

  struct state back;
  struct memory memory = {{0}, {0}};
  struct observe_block blocks[3];
  struct checkpoint_head head;
  list_blocks(&memory, blocks);
  assert_true(state_alloc(&back, &r.model));
  if (!checkpoint_read(path, &r.model, &head, &back, blocks, 3, &message))
    fail_msg("%s", message.text);
  assert_true(state_hash(&back) == state_hash(&r.state));
  assert_memory_equal(&back.counts, &r.state.counts, sizeof back.counts);
  assert_memory_equal(&memory, &some_memory, sizeof memory);
  assert_memory_equal(back.position, r.state.position, r.state.vertices * sizeof *back.position);
  assert_memory_equal(back.velocity, r.state.velocity, r.state.vertices * sizeof *back.velocity);
  assert_true(head.fingerprint == some_head.fingerprint && head.seed == some_head.seed);
  assert_true(head.state_hash == state_hash(&r.state));
  assert_true(head.wall_seconds == 12.5 && head.start_energy == -3.25 && head.start_momentum.z == 0x1p-1074);
  assert_string_equal(head.version, "0.1.0");
  char *scene = scene_text(path);
  assert_string_equal(scene, some_scene);
  free(scene);

  /* and the run goes on from it as if nothing had been */
  struct test_run resumed = {.model = r.model, .state = back};
  assert_true(work_alloc(&resumed.work, &resumed.model));
  test_steps(&resumed, 30);
  test_steps(&r, 30);
  assert_true(state_hash(&resumed.state) == state_hash(&r.state));
  work_free(&resumed.work);
  state_free(&resumed.state);
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

static void expect_refusal(const char *path, const struct model *model, struct state *state, const char *word);

/* A driven bead: its place, velocity and accounts, and the future. A scene without one does not take the file. */
static void a_bead_comes_back(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  struct message message;
  struct model m = test_model(12, 12, 12, 3.0, 0.1, 1), plain = m;
  m.bead.radius = 1.5;
  m.bead.center = (struct vec3){1.0, 2.0, 11.5};
  m.bead.drive = (struct bead_drive){.force = {5.0, 0.0, 0.0}, .spring = 10.0, .velocity = {0.0, 0.1, 0.0}};
  struct test_run r = test_start(m);
  test_steps(&r, 20);
  if (!write_some(path, &r, &message))
    fail_msg("%s", message.text);
  struct test_run resumed = {.model = r.model};
  struct memory memory = {{0}, {0}};
  struct observe_block blocks[3];
  struct checkpoint_head head;
  list_blocks(&memory, blocks);
  assert_true(state_alloc(&resumed.state, &r.model) && work_alloc(&resumed.work, &resumed.model));
  if (!checkpoint_read(path, &r.model, &head, &resumed.state, blocks, 3, &message))
    fail_msg("%s", message.text);
  assert_memory_equal(resumed.state.bead, r.state.bead, sizeof *r.state.bead);
  assert_true(r.state.bead->account.x != 0 && r.state.bead->account.y != 0 && r.state.bead->account.z > 0);
  test_steps(&resumed, 20);
  test_steps(&r, 20);
  assert_true(state_hash(&resumed.state) == state_hash(&r.state));
  assert_memory_equal(resumed.state.bead, r.state.bead, sizeof *r.state.bead);
  work_free(&resumed.work);
  state_free(&resumed.state);

  test_particles(&plain, r.state.solvent.n);
  struct test_run without = test_start(plain);
  expect_refusal(path, &without.model, &without.state, "bead");
  test_end(&without);
  test_end(&r);
  remove_folder(folder);
}

/* Fibers without solvent, solvent without fibers, and no scene text. */
static void parts_may_be_missing(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  struct message message;
  for (int k = 0; k < 2; k++) {
    struct model m = test_model(6, 6, 6, k == 0 ? 0 : 5, 0.01, 2);
    if (k == 0)
      test_add_kind(&m, 2, 5);
    struct test_run r = test_start(m);
    struct checkpoint_head head = some_head;
    if (!checkpoint_write(path, &head, &r.model, &r.state, NULL, 0, NULL, &message))
      fail_msg("%s", message.text);
    uint64_t hash = state_hash(&r.state);
    r.state.step = 99;
    if (!read_state(path, &r.model, &r.state, &message))
      fail_msg("%s", message.text);
    assert_true(state_hash(&r.state) == hash);
    test_end(&r);
  }
  remove_folder(folder);
}

/* Everything of one solvent particle trades places in memory with everything of another. */
/* In a plane bonds may be longer than half the edge along z, which is one cell. */
static void a_plane_comes_back(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  struct message message = {.text = ""};
  struct model m = test_model(8, 8, 1, 5.0, 0.05, 2);
  m.dimensions = 2;
  m.crossing.forbidden = false;
  test_add_kind(&m, 2, 4)->bond_length = 1.0;
  struct test_run r = test_start(m);
  struct checkpoint_head head = {.seed = r.model.seed, .version = "0.1.0"};
  if (!checkpoint_write(path, &head, &r.model, &r.state, NULL, 0, "", &message))
    fail_msg("%s", message.text);
  const uint64_t hash = state_hash(&r.state);
  if (!checkpoint_read(path, &r.model, &head, &r.state, NULL, 0, &message))
    fail_msg("%s", message.text);
  assert_true(state_hash(&r.state) == hash);

  /* without this number it is a box of three dimensions */
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), group = H5Gopen2(file, "structure", H5P_DEFAULT);
  uint32_t dimensions = 0;
  hid_t number = H5Aopen(group, "dimensions", H5P_DEFAULT);
  assert_true(H5Aread(number, H5T_NATIVE_UINT32, &dimensions) >= 0 && dimensions == 2);
  H5Aclose(number);
  H5Gclose(group);
  H5Fclose(file);
  test_end(&r);
  remove_folder(folder);
}

static void trade_places(struct solvent *p, uint32_t a, uint32_t b)
{
  int64_t *lattice[] = {p->x, p->y, p->z};
  double *real[] = {p->vx, p->vy, p->vz};
  for (int k = 0; k < 3; k++) {
    int64_t x = lattice[k][a];
    lattice[k][a] = lattice[k][b];
    lattice[k][b] = x;
    double v = real[k][a];
    real[k][a] = real[k][b];
    real[k][b] = v;
  }
  uint32_t id = p->id[a];
  p->id[a] = p->id[b];
  p->id[b] = id;
}

/* --- states that nobody wrote --- */

static void far_vertex(struct state *s)
{
  s->position[0].x = LATTICE_REACH; /* the furthest allowed, with bonds of two million a0 */
  s->position[0].y = s->position[0].z = -LATTICE_REACH;
}

static void lost_vertex(struct state *s)
{
  s->position[1].z = INT64_MIN;
}

static void long_bond(struct state *s)
{
  s->position[0].x = s->position[1].x + 5 * LATTICE_CELL / 2; /* half the shortest edge */
  s->position[0].y = s->position[1].y;
  s->position[0].z = s->position[1].z;
}

static void vertex_nan(struct state *s)
{
  s->velocity[s->vertices - 1].y = -NAN;
}

static void solvent_infinite(struct state *s)
{
  s->solvent.vz[s->solvent.n - 1] = -INFINITY;
}

static void solvent_below(struct state *s)
{
  s->solvent.x[0] = -1;
}

static void solvent_at_the_edge(struct state *s)
{
  s->solvent.y[3] = 5 * LATTICE_CELL;
}

static const struct {
  void (*spoil)(struct state *state);
  const char *words;
} unsound[] = {
    {far_vertex, "bond 0 is longer than half the shortest box edge: 3632"},
    {lost_vertex, "vertex 1 is too far from the origin, unwrapped: 8388608 a0; at most 2097152 is allowed"},
    {long_bond, "bond 0 is longer than half the shortest box edge: 2.5 a0; at most 2.5 is allowed"},
    {vertex_nan, "moves too far in one time step: nan a0"},
    {solvent_infinite, "moves too far in one collision interval: -inf a0"},
    {solvent_below, "is not in the box: -9.094947e-13 a0; 0 to 6 is allowed"},
    {solvent_at_the_edge, "is not in the box: 5 a0; 0 to 5 is allowed"},
};

/* Their hashes are right. A resume and a start both refuse them, with the same words. */
static void unsound_states_are_refused(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "c.h5");
  for (size_t k = 0; k < sizeof unsound / sizeof *unsound; k++) {
    struct message resumed, started;
    struct test_run r = small_run(3);
    unsound[k].spoil(&r.state);
    assert_true(write_some(path, &r, &resumed));
    assert_false(read_state(path, &r.model, &r.state, &resumed));
    assert_false(read_start(path, &r.model, &r.state, &started));
    if (!strstr(resumed.text, unsound[k].words))
      fail_msg("'%s' is not in '%s'", unsound[k].words, resumed.text);
    assert_string_equal(resumed.text, started.text);
    test_end(&r);
  }
  remove_folder(folder);
}

/* A lag that no run has would stream particles further than the lattice can tell. */
static void an_endless_lag_is_refused(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "c.h5");
  struct message message;
  struct test_run r = small_run(3);
  r.state.solvent_lag = UINT32_MAX;
  assert_true(write_some(path, &r, &message));
  assert_false(read_start(path, &r.model, &r.state, &message));
  assert_non_null(strstr(message.text, "moves too far in one collision interval"));
  test_end(&r);
  remove_folder(folder);
}

/* The bytes of the file do not depend on the order of the solvent in memory. */
static void bytes_are_canonical(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *first = in_folder(folder, "first.h5"), *second = in_folder(folder, "second.h5");
  struct message message;
  struct test_run r = small_run(11);
  assert_true(write_some(first, &r, &message));
  for (uint32_t k = 0; k < r.state.solvent.n / 3; k++)
    trade_places(&r.state.solvent, k, r.state.solvent.n - 1 - k);
  assert_true(write_some(second, &r, &message));
  size_t bytes, bytes2;
  char *a = slurp(first, &bytes), *b = slurp(second, &bytes2);
  assert_int_equal(bytes, bytes2);
  assert_memory_equal(a, b, bytes);
  free(a);
  free(b);
  test_end(&r);
  remove_folder(folder);
}

static herr_t has_no_time(hid_t object, const char *name, const H5O_info_t *info, void *unused)
{
  (void)object, (void)unused;
  if (info->ctime || info->mtime || info->atime || info->btime)
    fail_msg("%s carries a time", name);
  return 0;
}

static void no_object_carries_a_time(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  struct message message;
  struct test_run r = small_run(1);
  assert_true(write_some(path, &r, &message));
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, has_no_time, NULL) == 0);
  H5Fclose(file);
  test_end(&r);
  remove_folder(folder);
}

/* A full disk, a folder that is not there: the earlier checkpoint keeps its bytes, and no .part stays. */
static void the_old_one_survives(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5"), *part = in_folder(folder, "checkpoint.h5.part");
  struct message message = {.text = ""};
  struct test_run r = small_run(3);
  assert_true(write_some(path, &r, &message));
  size_t bytes, bytes2;
  char *before = slurp(path, &bytes);
  test_steps(&r, 2);

  for (rlim_t room = 0; room < bytes; room += bytes / 3) {
    limit_files(room);
    bool written = write_some(path, &r, &message);
    limit_files(RLIM_INFINITY);
    assert_false(written);
    assert_non_null(strstr(message.text, "checkpoint.h5"));
    assert_non_null(strstr(message.text, strerror(EFBIG)));
    assert_false(is_there(part));
    char *after = slurp(path, &bytes2);
    assert_int_equal(bytes2, bytes);
    assert_memory_equal(after, before, bytes);
    free(after);
  }
  assert_false(write_some(in_folder(folder, "nowhere/checkpoint.h5"), &r, &message));
  assert_non_null(strstr(message.text, strerror(ENOENT)));
  assert_true(write_some(path, &r, &message));
  free(before);
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

/* Reads a file that may be damaged: a message, or the very state. */
static bool survives(const char *path, const struct test_run *r, struct state *state, uint64_t hash)
{
  struct message message;
  bool read = read_state(path, &r->model, state, &message);
  if (read && state_hash(state) != hash)
    fail_msg("a damaged checkpoint was read as another state");
  if (!read && !strstr(message.text, path))
    fail_msg("no message about the file: '%s'", message.text);
  return read;
}

static void damage_is_found(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5"), *damaged = in_folder(folder, "damaged.h5");
  struct message message;
  struct test_run r = small_run(5);
  struct state state;
  assert_true(state_alloc(&state, &r.model));
  assert_true(write_some(path, &r, &message));
  const uint64_t hash = state_hash(&r.state);
  size_t bytes;
  char *data = slurp(path, &bytes);
  assert_true(survives(path, &r, &state, hash));

  for (size_t k = 0; k < 20; k++) {
    spill(damaged, data, bytes * k / 20);
    if (survives(damaged, &r, &state, hash))
      fail_msg("cut to %zu of %zu bytes, and yet it was read", bytes * k / 20, bytes);
  }
  unsigned refused = 0;
  for (uint32_t k = 0; k < 120; k++) {
    struct random_words w = random_at(1, RANDOM_THERMOSTAT, 0, 0, k);
    size_t at = w.w[0] % (k % 2          ? bytes
                          : bytes < 4096 ? bytes
                                         : 4096); /* every second one into the metadata in front */
    char flip = (char)(1 << w.w[1] % 8);
    data[at] ^= flip;
    spill(damaged, data, bytes);
    refused += !survives(damaged, &r, &state, hash);
    data[at] ^= flip;
  }
  assert_int_equal(refused, 120);
  free(data);
  state_free(&state);
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

/* Every bit of observers' memory, head and scene is guarded too, used or not. */
static void flipped_memory_is_found(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  struct message message;
  struct model m = test_model(4, 4, 4, 0, 0.01, 2);
  test_add_kind(&m, 1, 2);
  struct test_run r = test_start(m);
  assert_true(write_some(path, &r, &message));
  size_t bytes, read = 0;
  char *data = slurp(path, &bytes);
  for (size_t at = 0; at < bytes; at += 61) { /* each is read by a process of its own */
    struct memory memory = {{0}, {0}};
    struct observe_block blocks[3];
    struct checkpoint_head head;
    list_blocks(&memory, blocks);
    data[at] ^= 16;
    spill(path, data, bytes);
    data[at] ^= 16;
    read += checkpoint_read(path, &r.model, &head, &r.state, blocks, 3, &message);
  }
  assert_int_equal(read, 0);
  free(data);
  test_end(&r);
  remove_folder(folder);
}

static void expect_refusal(const char *path, const struct model *model, struct state *state, const char *word)
{
  struct message message;
  assert_false(read_state(path, model, state, &message));
  if (!strstr(message.text, word))
    fail_msg("'%s' does not say '%s'", message.text, word);
}

static void foreign_files_are_refused(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5"), *other = in_folder(folder, "other");
  struct message message;
  struct test_run r = small_run(1);
  assert_true(write_some(path, &r, &message));

  const struct point here = r.state.position[5];
  r.state.position[5].y = -LATTICE_REACH - 1;
  assert_true(write_some(other, &r, &message));
  expect_refusal(other, &r.model, &r.state, "vertex 5 is too far from the origin");
  r.state.position[5] = here;

  expect_refusal(in_folder(folder, "nothing"), &r.model, &r.state, strerror(ENOENT));
  expect_refusal(folder, &r.model, &r.state, "folder");
  spill(other, "", 0);
  expect_refusal(other, &r.model, &r.state, "not an HDF5 file");
  spill(other, "box: [6, 5, 7]\n", 15);
  expect_refusal(other, &r.model, &r.state, "not an HDF5 file");
  hid_t file = H5Fcreate(other, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  expect_refusal(other, &r.model, &r.state, "not a checkpoint");

  struct model m = r.model;
  m.box = box_of_cells(6, 5, 8);
  expect_refusal(path, &m, &r.state, "its box is 6 x 5 x 7 cells, the scene's 6 x 5 x 8");
  m = r.model;
  m.solvent.particles++;
  expect_refusal(path, &m, &r.state, "solvent particles");
  m = r.model;
  m.vertices++;
  expect_refusal(path, &m, &r.state, "fiber vertices");
  m = r.model;
  int32_t next = m.next[0];
  m.next[0] = 2;
  expect_refusal(path, &m, &r.state, "bonds");
  m.next[0] = next;
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

static void other_observers_are_refused(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  struct message message;
  struct test_run r = small_run(1);
  assert_true(write_some(path, &r, &message));
  struct memory memory;
  struct observe_block blocks[3];
  struct checkpoint_head head;
  list_blocks(&memory, blocks);
  blocks[1].name = "another";
  assert_false(checkpoint_read(path, &r.model, &head, &r.state, blocks, 3, &message));
  assert_non_null(strstr(message.text, "'another'"));
  list_blocks(&memory, blocks);
  blocks[0].count = 2;
  assert_false(checkpoint_read(path, &r.model, &head, &r.state, blocks, 3, &message));
  list_blocks(&memory, blocks);
  blocks[1].integer = false;
  assert_false(checkpoint_read(path, &r.model, &head, &r.state, blocks, 3, &message));
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(everything_comes_back),
                                     cmocka_unit_test(a_bead_comes_back),
                                     cmocka_unit_test(parts_may_be_missing),
                                     cmocka_unit_test(bytes_are_canonical),
                                     cmocka_unit_test(no_object_carries_a_time),
                                     cmocka_unit_test(the_old_one_survives),
                                     cmocka_unit_test(damage_is_found),
                                     cmocka_unit_test(flipped_memory_is_found),
                                     cmocka_unit_test(foreign_files_are_refused),
                                     cmocka_unit_test(other_observers_are_refused),
                                     cmocka_unit_test(unsound_states_are_refused),
                                     cmocka_unit_test(an_endless_lag_is_refused),
                                     cmocka_unit_test(a_plane_comes_back)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

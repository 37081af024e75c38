/* Trajectories: frames come back as they were, resumes drop what came after, damage is set aside. With the arguments
 * `sample FOLDER` the program writes the files that test_h5md.py reads. */
#include "files/files.h"

#include <errno.h>
#include <sys/wait.h>

#include "base/random.h"
#include "files/hdf5.h"
#include "fluid/fluid.h"

static const struct trajectory_options everything = {.solvent = true, .velocities = true, .seed = 42};
static const struct trajectory_options fibers_only = {.solvent = false, .velocities = false, .seed = 42};

static struct trajectory *open_or_fail(const char *path, const struct model *model,
                                       const struct trajectory_options *options, bool resume, uint64_t keep)
{
  struct message message;
  struct trajectory *t = trajectory_open(path, model, options, resume, keep, "box: [6, 5, 7]\n", &message);
  if (!t)
    fail_msg("%s", message.text);
  assert_string_equal(message.text, "");
  return t;
}

static void append_or_fail(struct trajectory *t, const struct test_run *r)
{
  struct message message;
  if (!trajectory_append(t, &r->model, &r->state, &message))
    fail_msg("%s", message.text);
}

/* Steps and appends after each step, `count` times. */
static void step_and_append(struct trajectory *t, struct test_run *r, int count)
{
  for (int k = 0; k < count; k++) {
    test_steps(r, 1);
    append_or_fail(t, r);
  }
}

static void close_or_fail(struct trajectory *t)
{
  struct message message;
  if (!trajectory_close(t, &message))
    fail_msg("%s", message.text);
}

/* Whoever made it, and whatever it is. */
static void a_file_that_is_there_stays(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct test_run r = small_run(1);
  struct message message;
  const char *own = in_folder(folder, "own.h5"), *other = in_folder(folder, "other.h5");
  close_or_fail(open_or_fail(own, &r.model, &everything, false, 0));
  spill(other, "somebody else's", 15);
  for (const char *const *path = (const char *const[]){own, other, NULL}; *path; path++) {
    size_t before, after;
    char *was = slurp(*path, &before);
    assert_null(trajectory_open(*path, &r.model, &everything, false, 0, "", &message));
    assert_non_null(strstr(message.text, *path));
    assert_non_null(strstr(message.text, strerror(EEXIST)));
    char *is = slurp(*path, &after);
    assert_true(before == after && memcmp(was, is, before) == 0);
    free(was);
    free(is);
  }
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

/* The state as a frame shows it: the solvent where it is now, in id order. */
static void assert_shows(const struct state *frame, const struct test_run *r, bool solvent)
{
  const struct state *s = &r->state;
  assert_true(frame->step == s->step);
  assert_memory_equal(frame->position, s->position, s->vertices * sizeof *s->position);
  if (!solvent)
    return;
  assert_memory_equal(frame->velocity, s->velocity, s->vertices * sizeof *s->velocity);
  const double t = 0.5 * s->solvent_lag * r->model.time_step;
  for (uint32_t i = 0; i < s->solvent.n; i++) {
    uint32_t id = s->solvent.id[i];
    struct point now = fluid_position_now(s, &r->model, i);
    assert_true(frame->solvent.x[id] == now.x && frame->solvent.y[id] == now.y && frame->solvent.z[id] == now.z);
    assert_true(frame->solvent.vx[id] == s->solvent.vx[i] + t * r->model.solvent.acceleration.x);
    assert_true(frame->solvent.vz[id] == s->solvent.vz[i] + t * r->model.solvent.acceleration.z);
  }
}

/* Places far away on the lattice, on either side of the origin. */
static void spread(struct state *state)
{
  const int64_t edge = (int64_t)1 << 53; /* 8192 a0 */
  for (uint32_t v = 0; v < state->vertices; v++) {
    struct random_words w = random_at(7, RANDOM_FIBER_POSITION, 0, 0, v), u = random_at(7, RANDOM_BEND, 0, 0, v);
    state->position[v].x = (int64_t)(random_u64(w, 0) >> 10) - edge;
    state->position[v].y = (int64_t)(random_u64(w, 1) >> 10) - edge;
    state->position[v].z = (int64_t)(random_u64(u, 0) >> 10) - edge;
  }
  state->position[0] = (struct point){edge - 1, 1 - edge, 0};
}

static void frames_come_back(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "trajectory.h5");
  struct message message;
  const struct trajectory_options *options[] = {&everything, &fibers_only};
  for (int k = 0; k < 2; k++) {
    bool solvent = options[k]->solvent;
    struct test_run r = small_run(0);
    struct trajectory *t = open_or_fail(path, &r.model, options[k], false, 0);
    step_and_append(t, &r, 7);
    assert_true(r.state.solvent_lag > 0);
    spread(&r.state);
    r.state.step++;
    append_or_fail(t, &r);
    close_or_fail(t);

    struct state back;
    assert_true(state_alloc(&back, &r.model));
    t = trajectory_open_read(path, &message);
    assert_non_null(t);
    assert_true(trajectory_frames(t) == 8);
    assert_true(trajectory_has_velocities(t) == solvent && trajectory_has_solvent(t, &r.model) == solvent);
    char *scene = trajectory_scene_text(t);
    assert_string_equal(scene, "box: [6, 5, 7]\n");
    free(scene);
    assert_true(trajectory_read(t, &r.model, 7, &back, &message));
    assert_shows(&back, &r, solvent);
    assert_true(trajectory_read(t, &r.model, 2, &back, &message));
    assert_true(back.step == 3);
    assert_false(trajectory_read(t, &r.model, 8, &back, &message));
    r.model.box.cells[2]++;
    assert_false(trajectory_read(t, &r.model, 0, &back, &message));
    assert_non_null(strstr(message.text, "box"));
    r.model.box.cells[2]--;
    close_or_fail(t);
    state_free(&back);
    test_end(&r);
    remove(path);
  }
  assert_all_closed();
  remove_folder(folder);
}

/* Beyond 8192 a0 doubles lose lattice points: the nearest double is at most half its distance to the next one away. No
 * run stops for that. */
static void far_vertices_are_rounded(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct message message;
  struct test_run r = small_run(1);
  const char *path = in_folder(folder, "trajectory.h5");
  const struct point far = {((int64_t)1 << 53) + 1, -((int64_t)1 << 60) - 77, LATTICE_REACH};
  struct trajectory *t = open_or_fail(path, &r.model, &fibers_only, false, 0);
  r.state.position[3] = far;
  append_or_fail(t, &r);
  close_or_fail(t);
  struct state back;
  assert_true(state_alloc(&back, &r.model));
  t = trajectory_open_read(path, &message);
  assert_non_null(t);
  if (!trajectory_read(t, &r.model, 0, &back, &message))
    fail_msg("%s", message.text);
  const struct point off = point_minus(back.position[3], far);
  assert_true(off.x >= -1 && off.x <= 1 && off.y >= -128 && off.y <= 128 && off.z == 0);
  close_or_fail(t);
  state_free(&back);
  test_end(&r);
  remove_folder(folder);
}

static void steps_must_increase(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct message message;
  struct test_run r = small_run(3);
  struct trajectory *t = open_or_fail(in_folder(folder, "trajectory.h5"), &r.model, &fibers_only, false, 0);
  append_or_fail(t, &r);
  append_or_fail(t, &r); /* the same step: it is there already */
  assert_true(trajectory_frames(t) == 1);
  r.state.step = 2;
  assert_false(trajectory_append(t, &r.model, &r.state, &message));
  close_or_fail(t);
  test_end(&r);
  remove_folder(folder);
}

/* A run is interrupted after 300 frames, its checkpoint is of step 170: the resumed file holds what one in one go does.
 */
static void resume_drops_later_frames(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *whole = in_folder(folder, "whole.h5"), *resumed = in_folder(folder, "resumed.h5");
  struct message message;
  struct test_run a = small_run(0), b = small_run(0);
  struct trajectory *t = open_or_fail(whole, &a.model, &fibers_only, false, 0);
  step_and_append(t, &a, 200);
  close_or_fail(t);

  t = open_or_fail(resumed, &b.model, &fibers_only, true, 0); /* a resume that finds nothing starts a file */
  step_and_append(t, &b, 170);
  struct test_run late = small_run(170);
  step_and_append(t, &late, 130);
  close_or_fail(t);
  close_or_fail(open_or_fail(resumed, &b.model, &fibers_only, true, 170));
  t = open_or_fail(resumed, &b.model, &fibers_only, true, UINT64_MAX);
  assert_true(trajectory_frames(t) == 170);
  step_and_append(t, &b, 30);
  close_or_fail(t);

  struct state x, y;
  assert_true(state_alloc(&x, &a.model) && state_alloc(&y, &a.model));
  struct trajectory *u = trajectory_open_read(whole, &message);
  t = trajectory_open_read(resumed, &message);
  assert_true(trajectory_frames(u) == 200 && trajectory_frames(t) == 200);
  for (uint64_t k = 0; k < 200; k++) {
    assert_true(trajectory_read(u, &a.model, k, &x, &message) && trajectory_read(t, &a.model, k, &y, &message));
    assert_true(x.step == k + 1 && y.step == k + 1);
    assert_memory_equal(x.position, y.position, x.vertices * sizeof *x.position);
  }
  close_or_fail(t);
  close_or_fail(u);
  t = open_or_fail(resumed, &b.model, &fibers_only, true, UINT64_MAX);
  assert_true(trajectory_frames(t) == 200);
  close_or_fail(t);
  state_free(&x);
  state_free(&y);
  test_end(&a);
  test_end(&b);
  test_end(&late);
  assert_all_closed();
  remove_folder(folder);
}

/* Each frame is in the file when trajectory_append returns: a process that is killed leaves them all. */
static void killed_runs_leave_their_frames(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "trajectory.h5");
  struct message message;
  struct test_run r = small_run(0);
  pid_t child = fork();
  if (child == 0) {
    struct trajectory *t = trajectory_open(path, &r.model, &everything, false, 0, "", &message);
    for (int k = 0; t && k < 9; k++) {
      test_steps(&r, 1);
      trajectory_append(t, &r.model, &r.state, &message);
    }
    raise(SIGKILL);
  }
  int status;
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_true(WIFSIGNALED(status));
  struct trajectory *t = trajectory_open_read(path, &message);
  if (!t)
    fail_msg("%s", message.text);
  assert_true(trajectory_frames(t) == 9);
  test_steps(&r, 9);
  struct state back;
  assert_true(state_alloc(&back, &r.model));
  assert_true(trajectory_read(t, &r.model, 8, &back, &message));
  assert_shows(&back, &r, true);
  close_or_fail(t);
  state_free(&back);
  test_end(&r);
  remove_folder(folder);
}

/* A damaged file is renamed and a new one begun, with a note; a second one gets the next number. */
static void damage_is_set_aside(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "trajectory.h5");
  const char *aside[] = {in_folder(folder, "trajectory.damaged.1.h5"), in_folder(folder, "trajectory.damaged.2.h5")};
  struct message message;
  struct test_run r = small_run(1);
  for (int k = 0; k < 2; k++) {
    struct trajectory *t = open_or_fail(path, &r.model, &fibers_only, false, 0);
    append_or_fail(t, &r);
    close_or_fail(t);
    size_t bytes, bytes2;
    char *data = slurp(path, &bytes);
    spill(path, data, k == 0 ? bytes / 2 : 10);
    t = trajectory_open(path, &r.model, &fibers_only, true, 5, "", &message);
    if (!t)
      fail_msg("%s", message.text);
    assert_non_null(strstr(message.text, aside[k]));
    assert_true(trajectory_frames(t) == 0);
    append_or_fail(t, &r);
    close_or_fail(t);
    char *kept = slurp(aside[k], &bytes2);
    assert_int_equal(bytes2, k == 0 ? bytes / 2 : 10);
    free(kept);
    free(data);
    remove(path);
  }
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

static void expect_no_resume(const char *path, const struct model *model, const struct trajectory_options *options,
                             const char *word)
{
  struct message message;
  assert_null(trajectory_open(path, model, options, true, 5, "", &message));
  if (!strstr(message.text, word))
    fail_msg("'%s' does not say '%s'", message.text, word);
}

/* A sound file of other particles, or one that somebody reads just now, is neither continued nor set aside. */
static void sound_files_are_not_set_aside(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "trajectory.h5");
  struct message message;
  struct test_run r = small_run(1);
  struct trajectory *t = open_or_fail(path, &r.model, &fibers_only, false, 0);
  append_or_fail(t, &r);
  close_or_fail(t);
  expect_no_resume(path, &r.model, &everything, "particles without velocities");
  int32_t next = r.model.next[0];
  r.model.next[0] = 2;
  expect_no_resume(path, &r.model, &fibers_only, "bonds");
  r.model.next[0] = next;
  t = trajectory_open_read(path, &message);
  expect_no_resume(path, &r.model, &fibers_only, "in use");
  close_or_fail(t);
  t = open_or_fail(path, &r.model, &fibers_only, true, 5);
  assert_true(trajectory_frames(t) == 1);
  close_or_fail(t);
  r.model.vertices = 0;
  expect_no_resume(path, &r.model, &fibers_only, "no particles");
  r.model.vertices = r.state.vertices;
  test_end(&r);
  remove_folder(folder);
}

/* Whatever is cut off or flipped in a trajectory: a resume goes on with sound frames or sets it aside, and never dies.
 */
static void damage_never_crashes(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "trajectory.h5");
  struct message message;
  struct test_run r = small_run(0);
  struct trajectory *t = open_or_fail(path, &r.model, &everything, false, 0);
  step_and_append(t, &r, 3);
  close_or_fail(t);
  size_t bytes;
  char *data = slurp(path, &bytes);
  struct state back;
  assert_true(state_alloc(&back, &r.model));
  for (uint32_t k = 0; k < 250; k++) {
    struct random_words w = random_at(2, RANDOM_THERMOSTAT, 0, 0, k);
    size_t at = w.w[0] % (k % 2 ? bytes : 8192), length = k < 50 ? bytes * k / 50 : bytes;
    data[at] ^= (char)(k < 50 ? 0 : 1 << w.w[1] % 8);
    spill(path, data, length);
    data[at] ^= (char)(k < 50 ? 0 : 1 << w.w[1] % 8);
    t = trajectory_open_read(path, &message);
    if (k < 50)
      assert_null(t);
    for (uint64_t f = 0; t && f < trajectory_frames(t); f++)
      trajectory_read(t, &r.model, f, &back, &message);
    trajectory_close(t, &message);
    t = trajectory_open(path, &r.model, &everything, true, 2, "", &message);
    trajectory_close(t, &message);
    remove(in_folder(folder, "trajectory.damaged.1.h5"));
  }
  free(data);
  state_free(&back);
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

/* A full disk: a message, a file that is sound and can be closed, and frames again once there is room. */
static void full_disks_are_reported(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "trajectory.h5");
  struct message message;
  struct test_run r = small_run(0);
  struct trajectory *t = open_or_fail(path, &r.model, &everything, false, 0);
  limit_files(1500000);
  uint64_t frames = 0;
  for (test_steps(&r, 1); trajectory_append(t, &r.model, &r.state, &message); frames++)
    test_steps(&r, 1);
  assert_true(frames > 5 && frames < 100);
  assert_non_null(strstr(message.text, path));
  assert_non_null(strstr(message.text, strerror(EFBIG)));
  close_or_fail(t);
  assert_null(
      trajectory_open(in_folder(folder, "nowhere/trajectory.h5"), &r.model, &everything, false, 0, "", &message));
  limit_files(1000);
  assert_null(trajectory_open(in_folder(folder, "new.h5"), &r.model, &everything, false, 0, "", &message));
  limit_files(RLIM_INFINITY);
  assert_false(is_there(in_folder(folder, "new.h5")));
  assert_all_closed();

  t = open_or_fail(path, &r.model, &everything, true, UINT64_MAX);
  assert_true(trajectory_frames(t) == frames);
  append_or_fail(t, &r);
  close_or_fail(t);
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

/* --- starts ------------------------------------------------------------------------------------------------------- */

/* A checkpoint with lag and the last frame of a trajectory of the same moment are the same start. */
static void both_files_start_alike(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *frames = in_folder(folder, "trajectory.h5"), *checkpoint = in_folder(folder, "checkpoint.h5");
  struct message message;
  struct test_run r = small_run(20);
  struct trajectory *t = open_or_fail(frames, &r.model, &everything, false, 0);
  step_and_append(t, &r, 21);
  close_or_fail(t);
  assert_true(r.state.solvent_lag > 0);
  struct checkpoint_head head = {0};
  assert_true(checkpoint_write(checkpoint, &head, &r.model, &r.state, NULL, 0, "", &message));

  struct state a, b;
  assert_true(state_alloc(&a, &r.model) && state_alloc(&b, &r.model));
  if (!read_start(frames, &r.model, &a, &message) || !read_start(checkpoint, &r.model, &b, &message))
    fail_msg("%s", message.text);
  assert_true(state_hash(&a) == state_hash(&b));
  assert_true(a.step == 0 && a.solvent_lag == 0 && b.counts.moves == 0);
  r.state.step = a.step;
  assert_shows(&a, &r, true);

  remove(frames);
  close_or_fail(open_or_fail(frames, &r.model, &fibers_only, false, 0));
  assert_false(read_start(frames, &r.model, &a, &message));
  assert_non_null(strstr(message.text, "without frames"));
  t = open_or_fail(frames, &r.model, &fibers_only, true, 0);
  append_or_fail(t, &r);
  close_or_fail(t);
  assert_false(read_start(frames, &r.model, &a, &message));
  assert_non_null(strstr(message.text, "no velocities"));
  spill(frames, "not hdf5", 8);
  assert_false(read_start(frames, &r.model, &a, &message));
  state_free(&a);
  state_free(&b);
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

static void assert_no_start(const char *frames, const struct test_run *r, struct state *state, const char *words)
{
  struct message message = {.text = ""};
  assert_false(read_start(frames, &r->model, state, &message));
  if (!strstr(message.text, words))
    fail_msg("'%s' is not in '%s'", words, message.text);
}

/* Five fibers of 8 vertices, three rings of 6, and solvent. */
static void what_contradicts_the_scene_is_no_start(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *frames = in_folder(folder, "trajectory.h5");
  struct test_run r = small_run(0);
  struct model *m = &r.model;
  struct state start;
  struct message message;
  struct trajectory *t = open_or_fail(frames, m, &everything, false, 0);
  append_or_fail(t, &r);
  close_or_fail(t);
  assert_true(state_alloc(&start, m));
  if (!read_start(frames, m, &start, &message))
    fail_msg("%s", message.text);
  m->next[7] = 0; /* a ring */
  m->bonds++;
  assert_no_start(frames, &r, &start, "vertex 7 is bonded to none in it, to 0 in the scene");
  m->next[7] = -1, m->next[3] = -1; /* shorter */
  m->bonds -= 2;
  assert_no_start(frames, &r, &start, "vertex 3 is bonded to 4 in it, to none in the scene");
  m->next[3] = 4;
  m->bonds++;
  m->mass[57] = 4.0;
  assert_no_start(frames, &r, &start, "vertex 57 has the mass 5 in it, 4 in the scene");
  m->mass[57] = 5.0;
  assert_true(read_start(frames, m, &start, &message));
  state_free(&start);
  test_end(&r);
  remove_folder(folder);
}

/* Other programs store a box that does not change once, as a vector or a matrix in the place of a group of frames. */
static void fixed_boxes_are_read(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *frames = in_folder(folder, "trajectory.h5");
  struct message message;
  struct test_run r = small_run(0);
  struct trajectory *t = open_or_fail(frames, &r.model, &everything, false, 0);
  append_or_fail(t, &r);
  close_or_fail(t);
  struct state start;
  assert_true(state_alloc(&start, &r.model));
  const double edges[9] = {6, 0, 0, 0, 5, 0, 0, 0, 7}, *vector = (const double[]){6, 5, 7};
  for (int rank = 1; rank <= 2; rank++) {
    const char *where = "particles/trajectory/box/edges";
    const hsize_t three[2] = {3, 3};
    hid_t file = H5Fopen(frames, H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(H5Ldelete(file, where, H5P_DEFAULT) >= 0);
    assert_true(h5_array_write(file, where, H5T_NATIVE_DOUBLE, rank, three, rank == 1 ? vector : edges));
    h5_close(file);
    memset(start.position, 0, start.vertices * sizeof *start.position);
    if (!read_start(frames, &r.model, &start, &message))
      fail_msg("%s", message.text);
    assert_shows(&start, &r, true);
  }
  state_free(&start);
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

/* --- files for test_h5md.py --------------------------------------------------------------------------------------- */

/* What the last frame and the checkpoint must hold: lattice points and the bits of velocities, as text. */
static void write_expected(const char *path, const struct test_run *r)
{
  FILE *out = fopen(path, "w");
  const struct state *s = &r->state;
  fprintf(out, "%llu %u %u\n", (unsigned long long)s->step, s->vertices, s->solvent.n);
  for (uint32_t v = 0; v < s->vertices; v++)
    fprintf(out, "%lld %lld %lld %a %a %a %d %.17g\n", (long long)s->position[v].x, (long long)s->position[v].y,
            (long long)s->position[v].z, s->velocity[v].x, s->velocity[v].y, s->velocity[v].z, r->model.next[v],
            r->model.mass[v]);
  fclose(out);
}

static int write_sample(const char *folder)
{
  struct message message = {.text = ""};
  struct test_run r = small_run(0);
  const struct trajectory_options half = {.solvent = false, .velocities = true, .seed = 42};
  struct trajectory *all =
      trajectory_open(in_folder(folder, "all.h5"), &r.model, &everything, false, 0, "a: 1\n", &message);
  struct trajectory *few =
      trajectory_open(in_folder(folder, "fibers.h5"), &r.model, &half, false, 0, "a: 1\n", &message);
  bool ok = all && few;
  for (int k = 0; ok && k < 6; k++) {
    test_steps(&r, 5);
    ok = trajectory_append(all, &r.model, &r.state, &message) && trajectory_append(few, &r.model, &r.state, &message);
  }
  struct checkpoint_head head = {.seed = 1, .version = "0.1.0"};
  ok = ok && trajectory_close(all, &message) && trajectory_close(few, &message) &&
       checkpoint_write(in_folder(folder, "checkpoint.h5"), &head, &r.model, &r.state, NULL, 0, "a: 1\n", &message);
  write_expected(in_folder(folder, "expected.txt"), &r);
  test_end(&r);
  if (!ok)
    fprintf(stderr, "%s\n", message.text);
  return ok ? 0 : 1;
}

int main(int argc, char **argv)
{
  if (argc == 3 && strcmp(argv[1], "sample") == 0)
    return write_sample(argv[2]);
  const struct CMUnitTest tests[] = {cmocka_unit_test(frames_come_back),
                                     cmocka_unit_test(far_vertices_are_rounded),
                                     cmocka_unit_test(a_file_that_is_there_stays),
                                     cmocka_unit_test(steps_must_increase),
                                     cmocka_unit_test(resume_drops_later_frames),
                                     cmocka_unit_test(damage_is_set_aside),
                                     cmocka_unit_test(sound_files_are_not_set_aside),
                                     cmocka_unit_test(damage_never_crashes),
                                     cmocka_unit_test(full_disks_are_reported),
                                     cmocka_unit_test(both_files_start_alike),
                                     cmocka_unit_test(fixed_boxes_are_read),
                                     cmocka_unit_test(what_contradicts_the_scene_is_no_start),
                                     cmocka_unit_test(killed_runs_leave_their_frames)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

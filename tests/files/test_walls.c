/* Files of runs between walls: checkpoints hold the account of the walls, and places on a wall are places in the box.
 */
#include "files/files.h"

#include "files/checkpoint.h"
#include "files/trajectory.h"
#include "fluid/fluid.h"

static struct model between_walls(void)
{
  struct model m = test_model(4, 5, 4, 5.0, 0.05, 2);
  m.seed = 2831;
  m.solvent.thermostat = THERMOSTAT_MAXWELL_BOLTZMANN;
  m.walls = (struct wall_model){.kind = WALL_NO_SLIP, .shear_rate = 0.2, .period = 1.0};
  return m;
}

/* The state, the account and the future come back. */
static void checkpoints_hold_the_account(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  struct message message = {.text = ""};
  struct test_run r = test_start(between_walls());
  test_steps(&r, 13);
  r.state.wall_turns[2] = (uint64_t)-3;
  r.state.solvent.y[0] = 0;
  r.state.solvent.y[1] = r.model.box.edge[1];
  assert_true(r.state.solvent_lag > 0 && r.state.wall_momentum[0].y != 0 && r.state.wall_momentum[3].x != 0);
  struct checkpoint_head head = {.seed = r.model.seed, .version = "0.1.0"};
  if (!checkpoint_write(path, &head, &r.model, &r.state, NULL, 0, "", &message))
    fail_msg("%s", message.text);

  struct test_run back = {.model = r.model};
  assert_true(state_alloc(&back.state, &back.model));
  assert_true(work_alloc(&back.work, &back.model));
  if (!checkpoint_read(path, &back.model, &head, &back.state, NULL, 0, &message))
    fail_msg("%s", message.text);
  assert_memory_equal(back.state.wall_momentum, r.state.wall_momentum, 4 * sizeof *r.state.wall_momentum);
  assert_memory_equal(back.state.wall_turns, r.state.wall_turns, sizeof r.state.wall_turns);
  assert_true(state_hash(&back.state) == state_hash(&r.state));
  test_steps(&r, 20);
  test_steps(&back, 20);
  assert_true(state_hash(&back.state) == state_hash(&r.state));

  struct checkpoint_summary summary;
  if (!checkpoint_look(path, &summary, &message))
    fail_msg("%s", message.text);
  assert_int_equal(summary.wall_rows, 4);

  /* a box of the same size without walls */
  struct model open = between_walls();
  open.walls = (struct wall_model){.kind = WALL_ABSENT};
  test_finish(&open);
  struct state none;
  assert_true(state_alloc(&none, &open));
  assert_false(checkpoint_read(path, &open, &head, &none, NULL, 0, &message));
  assert_non_null(strstr(message.text, "it is of a box between walls, the scene's box has none"));
  state_free(&none);
  model_free(&open);
  work_free(&back.work);
  state_free(&back.state);
  test_end(&r);
  remove_folder(folder);
}

/* A checkpoint of a periodic box has no account, and is no start between walls. */
static void periodic_files_have_no_account(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  struct message message = {.text = ""};
  struct model open = between_walls();
  open.walls = (struct wall_model){.kind = WALL_ABSENT};
  struct test_run r = test_start(open), walls = test_start(between_walls());
  struct checkpoint_head head = {.seed = open.seed, .version = "0.1.0"};
  if (!checkpoint_write(path, &head, &r.model, &r.state, NULL, 0, "", &message))
    fail_msg("%s", message.text);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(H5Lexists(file, "state/solvent_position", H5P_DEFAULT) > 0);
  assert_true(H5Lexists(file, "state/wall_momentum", H5P_DEFAULT) == 0);
  H5Fclose(file);
  assert_false(checkpoint_read(path, &walls.model, &head, &walls.state, NULL, 0, &message));
  assert_non_null(strstr(message.text, "it is of a box without walls, the scene's box has walls"));
  test_end(&walls);
  test_end(&r);
  remove_folder(folder);
}

/* Positions of now are between the walls, whatever the lag; many particles are in the outermost tenths. */
static void positions_are_between_the_walls(void **unused)
{
  (void)unused;
  struct test_run r = test_start(between_walls());
  uint32_t near = 0;
  for (int step = 0; step < 40; step++) {
    test_steps(&r, 1);
    for (uint32_t i = 0; i < r.state.solvent.n; i++) {
      const int64_t y = fluid_position_now(&r.state, &r.model, i).y;
      assert_true(y >= 0 && y <= r.model.box.edge[1]);
      near += y < LATTICE_CELL / 10 || y > r.model.box.edge[1] - LATTICE_CELL / 10;
    }
  }
  assert_true(near > 100);
  test_end(&r);
}

/* A frame with one particle at each height; those of 0 and 5 are on the walls. */
static void frames_have_no_solvent_beyond_the_walls(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "trajectory.h5");
  const struct trajectory_options options = {.solvent = true};
  const struct {
    int64_t y;
    const char *words;
  } rows[] = {{0, NULL},
              {5 * LATTICE_CELL, NULL},
              {-LATTICE_CELL / 8, "solvent particle 7 is at y = -0.125, beyond the walls at 0 and 5"},
              {5 * LATTICE_CELL + 1, "solvent particle 7 is at y = 5.0000000000009095, beyond the walls at 0 and 5"}};
  struct test_run r = test_start(between_walls());
  struct state back;
  struct message message = {.text = ""};
  assert_true(state_alloc(&back, &r.model));
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    remove(path);
    r.state.solvent.y[7] = rows[k].y;
    struct trajectory *t = trajectory_open(path, &r.model, &options, false, 0, "", &message);
    assert_true(t && trajectory_append(t, &r.model, &r.state, &message) && trajectory_close(t, &message));
    t = trajectory_open_read(path, &message);
    assert_non_null(t);
    assert_int_equal(trajectory_read(t, &r.model, 0, &back, &message), !rows[k].words);
    if (rows[k].words && !strstr(message.text, rows[k].words))
      fail_msg("%s", message.text);
    assert_true(rows[k].words || back.solvent.y[7] == rows[k].y);
    trajectory_close(t, &message);
  }
  state_free(&back);
  test_end(&r);
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(checkpoints_hold_the_account),
      cmocka_unit_test(periodic_files_have_no_account),
      cmocka_unit_test(positions_are_between_the_walls),
      cmocka_unit_test(frames_have_no_solvent_beyond_the_walls),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

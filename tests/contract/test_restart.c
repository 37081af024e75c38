/* A state that is saved and read goes on to the bits of the run that was not interrupted, in every combination of rows
 * that a model may have. */
#include "contract/contract.h"
#include "files/files.h"

/* Two copies of one model: model_finish allocates. */
static void restart_model(struct model model, struct model copy, const char *path)
{
  struct test_run whole = test_start(model), second = {.model = copy};
  struct checkpoint_head head = {.seed = whole.model.seed, .version = "0"};
  struct message message = {0};
  test_finish(&second.model);
  assert_true(state_alloc(&second.state, &second.model) && work_alloc(&second.work, &second.model));
  test_steps(&whole, 31); /* between two collisions: solvent lags, and has been sorted once */
  if (!checkpoint_write(path, &head, &whole.model, &whole.state, NULL, 0, NULL, &message) ||
      !checkpoint_read(path, &second.model, &head, &second.state, NULL, 0, &message))
    fail_msg("%s", message.text);
  assert_same_state(&whole, &second, "read");
  test_steps(&whole, 30);
  test_steps(&second, 30);
  assert_same_state(&whole, &second, "continued");
  test_end(&whole);
  test_end(&second);
}

static void restart(struct choice c, const char *path)
{
  restart_model(contract_scene(c), contract_scene(c), path);
}

/* Combinations, and those of them that models reject. */
static struct {
  uint32_t all, rejected;
} combinations;

static void restart_if_accepted(struct choice c, const char *path)
{
  struct model m = contract_scene(c);
  struct model_error error;
  const bool accepted = model_finish(&m, &error);
  /* phantoms have no thermostat, and no hydrodynamic interactions either way */
  const bool sound =
      contract_together(c.rule, c.thermostat) && !(model_has_phantoms(&m) && c.thermostat != THERMOSTAT_NONE);
  model_free(&m);
  combinations.all++;
  combinations.rejected += !accepted;
  if (accepted != sound)
    fail_msg("rule %d, thermostat %d, bath %d: %s", c.rule, c.thermostat, c.bath, accepted ? "accepted" : error.text);
  if (accepted)
    restart(c, path);
}

static void every_combination_restarts(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  for (int rule = 0; rule < RULES; rule++)
    for (int thermostat = 0; thermostat < THERMOSTATS; thermostat++)
      for (int bath = 0; bath < BATHS; bath++)
        for (int scheme = 0; scheme < SCHEMES; scheme++)
          for (int crossing = 0; crossing < CROSSINGS; crossing++)
            for (int permuted = 0; permuted < 2; permuted++)
              restart_if_accepted((struct choice){.rule = rule,
                                                  .thermostat = thermostat,
                                                  .bath = bath,
                                                  .scheme = scheme,
                                                  .crossing = crossing,
                                                  .permuted = permuted},
                                  path);
  print_message("  %u combinations, %u of them rejected\n", combinations.all, combinations.rejected);
  remove_folder(folder);
}

/* What no choice above takes: other fluids, one by one. */
static void every_fluid_restarts(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  for (int fluid = 0; fluid < FLUIDS; fluid++)
    for (int rule = 0; rule < RULES; rule++)
      restart((struct choice){.fluid = fluid, .rule = rule}, in_folder(folder, "checkpoint.h5"));
  remove_folder(folder);
}

static void every_medium_restarts(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  for (int medium = MEDIUM_PRIVATE; medium < MEDIA; medium++)
    for (int draw = 0; draw < contract_draws(medium); draw++)
      for (int scheme = 0; scheme < SCHEMES; scheme++)
        restart((struct choice){.medium = medium, .draw = draw, .scheme = scheme, .repels = medium == MEDIUM_PAIRS},
                in_folder(folder, "checkpoint.h5"));
  remove_folder(folder);
}

/* Flows: walls and shear, steady and oscillating, and every profile of a force. */
static void every_flow_restarts(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "checkpoint.h5");
  struct model m = test_model(6, 7, 8, 2, 0.05, 2);
  m.seed = dice_seed(2703);
  m.solvent.acceleration.x = 0.1;
  for (int scheme = 0; scheme < SCHEMES; scheme++) {
    m.scheme = scheme;
    for (int oscillates = 0; oscillates < 2; oscillates++) {
      struct model walled = m, sheared = m;
      walled.walls = (struct wall_model){.kind = WALL_NO_SLIP, .shear_rate = 0.1, .period = oscillates ? 1.1 : 0.0};
      sheared.shear = (struct shear_model){.rate = 0.3, .period = oscillates ? 1.1 : 0.0};
      restart_model(walled, walled, path);
      restart_model(sheared, sheared, path);
    }
    for (int profile = 0; profile < PROFILES; profile++) {
      struct model driven = m;
      driven.solvent.profile = profile;
      restart_model(driven, driven, path);
    }
  }
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_combination_restarts),
      cmocka_unit_test(every_fluid_restarts),
      cmocka_unit_test(every_medium_restarts),
      cmocka_unit_test(every_flow_restarts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

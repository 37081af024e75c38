/*
 * The drag of a bead in the solvent alone, by a small force. It is held against 6 pi eta R_h, with the slip length of a
 * flat wall and Hasimoto's factor of the box. docs/bead.md has longer runs; they are up to 6 % below it, so 8 % are
 * allowed here. One run in 16000 fails by chance. Without virtual particles the friction is lower by a fifth.
 */
#include "statistics.h"
#include "support.h"
#include "system/bead.h"
#include "theory/bead.h"

enum { STEPS = 60000, SKIP = 500, BLOCK = 3000 };

static void drag_is_that_of_a_sphere(void **unused)
{
  (void)unused;
  const double force = 8.0, allowed = 0.08;
  struct model m = test_model(12, 12, 12, 5.0, 0.1, 1);
  m.bead.radius = 2.0;
  m.bead.drive.force.x = force;
  struct test_run r = test_start(m);
  const double share = 1.0 + r.model.bead.mass / r.state.solvent.n;
  const double size = theory_bead_radius(2.0, theory_model_bead_slip(&r.model));
  const double expected = theory_model_bead_friction(&r.model) * theory_bead_box(size, 12.0);
  struct sample speed = {0};
  test_steps(&r, SKIP);
  for (int block = 0; block < STEPS / BLOCK; block++) {
    const int64_t begin = r.state.bead->position.x;
    test_steps(&r, BLOCK);
    sample_add(&speed, (double)(r.state.bead->position.x - begin) * LATTICE_UNIT / (BLOCK * 0.1));
  }
  const double found = force * share / speed.mean, error = found * sample_error(&speed) / speed.mean;
  print_message("  friction %.1f +- %.1f, expected %.1f\n", found, error, expected);
  assert_true(error < 0.05 * found);
  assert_close(found, expected, 4.0 * error + allowed * expected);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(drag_is_that_of_a_sphere)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

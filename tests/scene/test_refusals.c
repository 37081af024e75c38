/* Each row of system/refusals.c has a scene that it refuses, and one beside it that is allowed: the same but for what
 * the row is about. A row that no scene reaches fails. */
#include <string.h>

#include "scene/made.h"
#include "support.h"
#include "system/refusals.h"

#define BOX "box=[8,8,8] time_step=0.1 steps=1 "
#define FLUID BOX "solvent.per_cell=3 solvent.collision_interval=0.1 "
#define FIBER                                                                                                          \
  "fibers.0.name=f fibers.0.count=1 fibers.0.vertices=4 fibers.0.mass=5 fibers.0.bond_length=0.5 fibers.0.spring=100 "
#define PRIVATE BOX "medium.kind=private medium.rate=1 "
#define PAIRS BOX "medium.kind=pairs medium.rate=1 medium.density=3 "
#define SLOW BOX FIBER "medium.kind=overdamped medium.rate=1 crossing.forbidden=false "
#define PHANTOMS FLUID FIBER "solvent.bath=phantoms "
#define DUMBBELLS FLUID "dumbbells.spring=1 "
#define FLAT FLUID "dimensions=2 box=[8,8,1] "
#define FORCE_AND_PROFILE FLUID "solvent.acceleration=[0.1,0,0] solvent.profile=sine "
#define WALLS "walls.kind=no-slip "
#define SHEAR "shear.rate=0.1 "
#define GAUSSIAN BOX FIBER "fibers.0.bond_length=0 "
#define BEAD FLUID "box=[16,16,16] bead.radius=2 "
#define BEAD_AND_FIBER BEAD FIBER "fibers.0.spring=1000 time_step=0.01 solvent.collision_interval=0.01 "

/* The settings of a scene: those of both, then the wrong or the right ones, which set a key anew. */
static const struct {
  const char *key, *says, *both, *wrong, *right;
} rows[] = {
    {"medium", "there is a solvent of collision cells too", PAIRS, "solvent.per_cell=3 solvent.collision_interval=0.1",
     ""},
    {"dumbbells", "only a solvent of collision cells has springs", PAIRS, "dumbbells.spring=1", ""},
    {"walls", "only a solvent of collision cells has rules for walls", PAIRS, "walls.kind=slip", ""},
    {"medium.inextensible", "only vertices without velocities", PAIRS, "medium.inextensible=true", ""},
    {"shear", "only a solvent of collision cells has rules for images", PAIRS, "shear.rate=0.1", ""},
    {"shear", "only a solvent of collision cells has rules for images", PAIRS, "shear.strain=1 shear.period=1", ""},
    {"medium.kind", "a private bath is one of vertices", PRIVATE, "", FIBER},
    {"medium.density", "a private bath has no particles", PRIVATE FIBER, "medium.density=3", "medium.density=0"},
    {"medium.weight", "a private bath knows no distances; allowed: hat", PRIVATE FIBER, "medium.weight=quadratic", ""},
    {"medium.kind", "a private bath knows no distances, so no repulsion", PRIVATE FIBER, "medium.repulsion=1",
     "medium.repulsion=0"},
    {"medium.kind", "a private bath knows no distances, so no repulsion", PRIVATE FIBER, "medium.many_body.repulsion=1",
     ""},
    {"dimensions", "pairs are in space", PAIRS, "dimensions=2", "dimensions=3"},
    {"box", "pairs up to 1 a0 apart", PAIRS, "box=[8,2,8]", "box=[8,3,8]"},
    {"medium.kind", "pairs without a density", PAIRS FIBER, "medium.density=0", "medium.density=0.1"},
    {"medium.repulsion", "an attraction without many_body", PAIRS, "medium.repulsion=-1",
     "medium.repulsion=-1 medium.many_body.repulsion=1"},
    {"crossing.rule", "forces of particles are known once in a step", PAIRS FIBER, "medium.repulsion=1",
     "medium.repulsion=1 crossing.rule=sequential"},
    {"crossing.rule", "forces of particles are known once in a step", PAIRS FIBER, "medium.repulsion=1",
     "medium.repulsion=1 crossing.forbidden=false"},
    {"medium.kind", "overdamped motion is one of vertices", BOX "medium.kind=overdamped medium.rate=1 ", "",
     FIBER "crossing.forbidden=false"},
    {"dimensions", "tensors are those of space", SLOW, "dimensions=2", ""},
    {"crossing.forbidden", "overdamped vertices have no velocities", SLOW, "crossing.forbidden=true", ""},
    {"medium.density", "overdamped motion has no particles", SLOW, "medium.density=3", "medium.density=0"},
    {"medium.kind", "overdamped motion knows no pairs", SLOW, "medium.weight=quadratic", ""},
    {"medium.kind", "overdamped motion knows no pairs", SLOW, "medium.draw=relax", ""},
    {"medium.kind", "overdamped motion knows no pairs", SLOW, "medium.repulsion=1", ""},
    {"medium.tensor", "a tensor needs a radius above 0", SLOW, "medium.tensor=rpy",
     "medium.tensor=rpy medium.radius=0.25"},
    {"medium.radius", "a tensor needs a radius above 0", SLOW, "medium.radius=0.25", "medium.radius=0"},
    {"medium.inextensible", "a kind of fibers has the bond_length 0", SLOW "medium.inextensible=true ",
     "fibers.0.bond_length=0", ""},
    {"medium.inextensible", "a kind of fibers has the bond_length 0",
     SLOW "medium.inextensible=true fibers.1.name=g fibers.1.count=1 fibers.1.vertices=4 fibers.1.mass=5 "
          "fibers.1.spring=100 ",
     "fibers.1.bond_length=0", "fibers.1.bond_length=0.5"},
    {"medium.tensor", "a fiber has more than 1000 vertices", SLOW "medium.tensor=rpy medium.radius=0.25 ",
     "fibers.0.vertices=1001", "fibers.0.vertices=1000"},
    {"solvent.thermostat", "the collision rule holds the temperature by itself", FLUID "solvent.rule=at-a ",
     "solvent.thermostat=rescale", "solvent.thermostat=none"},
    {"solvent.thermostat", "the collision rule holds the temperature by itself", FLUID "solvent.rule=at+a ",
     "solvent.thermostat=rescale", "solvent.thermostat=none"},
    {"solvent.bath", "phantoms carry no hydrodynamic interactions", PHANTOMS, "", "solvent.hydrodynamics=false"},
    {"solvent.bath", "phantoms are a thermostat", PHANTOMS "solvent.hydrodynamics=false ", "solvent.thermostat=rescale",
     ""},
    {"solvent.bath", "phantoms are not accelerated", PHANTOMS "solvent.hydrodynamics=false ",
     "solvent.acceleration=[0,0,0.1]", ""},
    {"solvent.bath", "too many phantoms", PHANTOMS "solvent.hydrodynamics=false ", "solvent.per_cell=1000.5",
     "solvent.per_cell=1000"},
    {"solvent.bath", "phantoms are drawn for fibers only", FLUID "solvent.bath=phantoms solvent.hydrodynamics=false ",
     "", FIBER},
    {"dumbbells", "they are pairs of solvent particles", BOX FIBER, "dumbbells.spring=1", ""},
    {"solvent.hydrodynamics", "velocities that are permuted are not those of springs", DUMBBELLS,
     "solvent.hydrodynamics=false", ""},
    {"box", "with dimensions: 2 the box is one cell thick", FLAT, "box=[8,8,2]", ""},
    {"flow", "with dimensions: 2 nothing moves along z", FLAT, "flow=[0,0,0.1]", "flow=[0.1,0.1,0]"},
    {"solvent.acceleration", "with dimensions: 2 nothing moves along z", FLAT, "solvent.acceleration=[0,0,0.1]",
     "solvent.acceleration=[0.1,0.1,0]"},
    {"walls", "with dimensions: 2 nothing moves along z", FLAT WALLS, "walls.lower=[0,0,0.1]", "walls.lower=[0.1,0,0]"},
    {"walls", "with dimensions: 2 nothing moves along z", FLAT WALLS, "walls.upper=[0,0,0.1]", "walls.upper=[0.1,0,0]"},
    {"crossing.forbidden", "in a plane fibers cannot pass over each other", FLAT FIBER "fibers.0.start=straight ", "",
     "crossing.forbidden=false"},
    {"solvent.bath", "phantoms are drawn in space", FLAT FIBER "fibers.0.start=straight crossing.forbidden=false ",
     "solvent.bath=phantoms solvent.hydrodynamics=false", ""},
    {"solvent.hydrodynamics", "velocities are not permuted in a plane", FLAT, "solvent.hydrodynamics=false", ""},
    {"solvent.profile", "the profile repeats with the box", FORCE_AND_PROFILE, "walls.kind=slip", ""},
    {"solvent.profile", "the profile repeats with the box", FORCE_AND_PROFILE, "shear.rate=0.1", ""},
    {"solvent.profile", "the profile repeats with the box", FORCE_AND_PROFILE, "shear.strain=0.5 shear.period=10", ""},
    {"solvent.acceleration", "a force along y that depends on y", FORCE_AND_PROFILE, "solvent.acceleration=[0.1,0.1,0]",
     "solvent.acceleration=[0.1,0,0.1]"},
    {"solvent.hydrodynamics", "velocities that are permuted have no profile; allowed with this", FORCE_AND_PROFILE,
     "solvent.hydrodynamics=false", ""},
    {"solvent.profile", "phantoms are not accelerated; allowed: uniform", PHANTOMS "solvent.hydrodynamics=false ",
     "solvent.profile=sine", ""},
    {"solvent.acceleration", "the solvent would be pressed against a wall", FLUID WALLS,
     "solvent.acceleration=[0,0.1,0]", "solvent.acceleration=[0.1,0,0.1]"},
    {"solvent.acceleration", "the solvent would be moved across the shear", FLUID SHEAR,
     "solvent.acceleration=[0,0.1,0]", "solvent.acceleration=[0.1,0,0.1]"},
    {"solvent.acceleration", "the solvent would be moved across the shear", FLUID "shear.strain=0.5 shear.period=10 ",
     "solvent.acceleration=[0,0.1,0]", "solvent.acceleration=[0.1,0,0.1]"},
    {"walls.strain", "a strain without a period", FLUID WALLS "walls.strain=0.1 ", "", "walls.period=10"},
    {"walls.shear_rate", "velocities of the walls are given too", FLUID WALLS "walls.strain=0.1 walls.period=10 ",
     "walls.upper=[0.1,0,0]", ""},
    {"walls.shear_rate", "velocities of the walls are given too", FLUID WALLS "walls.shear_rate=0.1 ",
     "walls.upper=[0.1,0,0]", ""},
    {"shear.strain", "a strain without a period", FLUID "shear.strain=0.1 ", "", "shear.period=1"},
    {"shear.period", "a period without a rate or strain", FLUID "shear.period=1 ", "", "shear.rate=0.1"},
    {"shear", "walls and shear are both along y", FLUID WALLS, "shear.rate=0.1", ""},
    {"walls", "phantoms are drawn about the same velocity everywhere", PHANTOMS "solvent.hydrodynamics=false ",
     "walls.kind=slip", ""},
    {"walls", "they act on solvent and fibers", BOX WALLS, "", FIBER},
    {"shear", "they act on solvent and fibers", BOX SHEAR, "", FIBER},
    {"box", "with shear and bonds that must not cross", FLUID FIBER SHEAR, "box=[12,8,8]", "box=[16,8,8]"},
    {"box", "with shear and bonds that must not cross", FLUID FIBER SHEAR, "box=[12,8,8]",
     "box=[12,8,8] crossing.forbidden=false"},
    {"solvent.hydrodynamics", "velocities that are permuted have no profile; allowed between", FLUID WALLS,
     "solvent.hydrodynamics=false", ""},
    {"solvent.hydrodynamics", "velocities that are permuted have no profile; allowed between", FLUID SHEAR,
     "solvent.hydrodynamics=false", ""},
    {"flow", "a flow across walls or shear", FLUID WALLS, "flow=[0,0.1,0]", "flow=[0.1,0,0.1]"},
    {"flow", "a flow across walls or shear", FLUID SHEAR, "flow=[0,0.1,0]", "flow=[0.1,0,0.1]"},
    {"walls", "a wall that leaves its plane", FLUID WALLS, "walls.lower=[0,0.1,0]", "walls.lower=[0.1,0,0.1]"},
    {"walls", "a wall that leaves its plane", FLUID WALLS, "walls.upper=[0,0.1,0]", "walls.upper=[0.1,0,0.1]"},
    {"walls.fill", "slip walls have no virtual particles", FLUID "walls.kind=slip ", "walls.fill=none",
     "walls.fill=planar"},
    {"dumbbells.spring", "a dumbbell at rest is longer than half of the gap", DUMBBELLS WALLS,
     "dumbbells.spring=0.0624", "dumbbells.spring=0.0625"},
    {"dumbbells.depth", "a potential of walls", DUMBBELLS "dumbbells.depth=1 ", "", WALLS},
    {"dumbbells.range", "the potentials of the two walls overlap", DUMBBELLS WALLS "dumbbells.depth=1 ",
     "dumbbells.range=4.001", "dumbbells.range=4"},
    {"walls.fill", "per_cell less the members of a cell is not a whole number",
     FLUID WALLS "solvent.rule=at+a solvent.per_cell=3.5 ", "walls.fill=paper", "walls.fill=planar"},
    {"walls.fill", "per_cell less the members of a cell is not a whole number", FLUID WALLS "walls.fill=paper ",
     "solvent.rule=at+a solvent.per_cell=3.5", "solvent.rule=at+a"},
    {"fibers.persistence_length", "bending is given too", BOX FIBER "fibers.0.bending=1 ",
     "fibers.0.persistence_length=1", ""},
    {"fibers.persistence_length", "bending = persistence_length/bond_length needs", GAUSSIAN,
     "fibers.0.persistence_length=1", "fibers.0.bending=1"},
    {"fibers.keeps", "there is no finer chain", GAUSSIAN "fibers.0.keeps=gyration ", "", "fibers.0.stands_for=40"},
    {"fibers.stands_for", "only an open Gaussian chain", BOX FIBER, "fibers.0.stands_for=40",
     "fibers.0.stands_for=40 fibers.0.bond_length=0"},
    {"fibers.stands_for", "only an open Gaussian chain", GAUSSIAN "fibers.0.stands_for=40 ", "fibers.0.bending=1", ""},
    {"fibers.stands_for", "only an open Gaussian chain", GAUSSIAN "fibers.0.stands_for=40 ", "fibers.0.ring=true", ""},
    {"fibers.stands_for", "only an open Gaussian chain", GAUSSIAN "fibers.0.stands_for=40 ", "fibers.0.vertices=1",
     "fibers.0.vertices=2"},
    {"fibers.frozen", "frozen fibers together with a force", FLUID FIBER "fibers.0.frozen=true ",
     "fibers.0.force=[0,0,1]", ""},
    {"fibers.frozen", "frozen fibers together with a flow", FLUID FIBER "fibers.0.frozen=true ", "flow=[0,0.1,0]", ""},
    {"fibers.frozen", "frozen fibers together with walls", FLUID FIBER "fibers.0.frozen=true ", WALLS, ""},
    {"fibers.frozen", "frozen fibers together with shear", FLUID FIBER "fibers.0.frozen=true ", SHEAR, ""},
    {"fibers.held", "all vertices of a frozen fiber are held", FLUID FIBER "fibers.0.frozen=true ",
     "fibers.0.held=first", "fibers.0.held=none"},
    {"fibers.held", "a ring has no ends", FLUID FIBER "fibers.0.ring=true ", "fibers.0.held=ends",
     "fibers.0.held=first"},
    {"fibers.held", "held vertices together with a force", FLUID FIBER "fibers.0.held=ends ", "fibers.0.force=[0,0,1]",
     ""},
    {"fibers.held", "held vertices together with a flow", FLUID FIBER "fibers.0.held=first ", "flow=[0,0.1,0]", ""},
    {"fibers.held", "held vertices together with walls", FLUID FIBER "fibers.0.held=ends ", WALLS, ""},
    {"fibers.held", "held vertices together with shear", FLUID FIBER "fibers.0.held=ends ", SHEAR, ""},
    {"fibers.held", "with a tensor the others would feel what holds them", SLOW "fibers.0.held=ends ",
     "medium.tensor=rpy medium.radius=0.25", ""},
    {"fibers.held", "tensions know vertices that move only", SLOW "fibers.0.held=ends ", "medium.inextensible=true",
     ""},
    {"fibers.places", "fibers that start in equilibrium",
     BOX FIBER "fibers.0.places.0.center=[4,4,4] fibers.0.places.0.direction=[1,0,0] ", "fibers.0.start=equilibrium",
     "fibers.0.start=straight"},
    {"fibers.force", "with dimensions: 2 nothing moves along z",
     FLAT FIBER "fibers.0.start=straight crossing.forbidden=false ", "fibers.0.force=[0,0,1]",
     "fibers.0.force=[0,1,0]"},
    {"fibers.diameter", "a free point has no bond", BOX FIBER "fibers.0.diameter=0.1 ", "fibers.0.vertices=1", ""},
    {"fibers.diameter", "with crossing: {forbidden: false}", BOX FIBER "fibers.0.diameter=0.1 ",
     "crossing.forbidden=false", ""},
    {"fibers.diameter", "the rule sequential knows thin lines only", BOX FIBER "fibers.0.diameter=0.1 ",
     "crossing.rule=sequential", "crossing.rule=event-driven"},
    {"fibers.diameter", "walls know the axes of fibers only", BOX FIBER "fibers.0.diameter=0.1 ", WALLS, ""},
    {"fibers.diameter", "in a sheared box bonds move in sheared coordinates", BOX FIBER "fibers.0.diameter=0.1 ", SHEAR,
     ""},
    {"bead", "it needs solvent particles", BOX FIBER "box=[16,16,16] ", "bead.radius=2", ""},
    {"medium", "its pairs do not know the bead", PAIRS "box=[16,16,16] ", "bead.radius=2", ""},
    {"walls.kind", "they do not take up the momentum of a bead along them", BEAD "bead.center=[8,8,8] ",
     "walls.kind=slip", WALLS},
    {"walls.fill", "a cell that the bead cuts has few members", BEAD "bead.center=[8,8,8] " WALLS, "walls.fill=none",
     "walls.fill=planar"},
    {"fibers", "a cluster of fibers and bead does not touch walls", BEAD "bead.center=[8,8,8] " WALLS,
     FIBER "fibers.0.spring=1000 time_step=0.01 solvent.collision_interval=0.01", ""},
    {"shear", "a bead has no image that moves", BEAD, SHEAR, ""},
    {"dumbbells", "springs do not touch a bead", BEAD, "dumbbells.spring=1", ""},
    {"solvent.rule", "virtual particles of a bead have no angular momentum", BEAD, "solvent.rule=at+a",
     "solvent.rule=at-a"},
    {"solvent.thermostat", "its factors do not know the bead's virtual particles", BEAD, "solvent.thermostat=rescale",
     ""},
    {"solvent.hydrodynamics", "velocities that are permuted drag no bead", BEAD, "solvent.hydrodynamics=false", ""},
    {"solvent.acceleration", "nothing takes up the momentum", BEAD "bead.center=[8,8,8] ",
     "solvent.acceleration=[0,0,0.1]", "solvent.acceleration=[0,0,0.1] " WALLS},
    {"time_step", "a bead is moved with the solvent", BEAD, "time_step=0.05", ""},
    {"order", "half a drift would be late between steps", BEAD, "order=drift-split", "order=paper"},
    {"crossing.forbidden", "fibers do not touch the bead", BEAD_AND_FIBER, "crossing.forbidden=false", ""},
    {"crossing.rule", "fibers do not touch the bead", BEAD_AND_FIBER, "crossing.rule=sequential", ""},
    {"fibers.vertices", "a vertex without a bond does not touch the bead", BEAD_AND_FIBER, "fibers.0.vertices=1",
     "fibers.0.vertices=2"},
    {"fibers.frozen", "they do not take up the momentum of the drive", BEAD_AND_FIBER "fibers.0.frozen=true ",
     "bead.drive.spring=1", ""},
    {"fibers.frozen", "they do not take up the momentum of the drive", BEAD_AND_FIBER "fibers.0.frozen=true ",
     "bead.drive.force=[0,0,1]", ""},
    {"fibers.held", "they do not take up the momentum of the drive", BEAD_AND_FIBER "fibers.0.held=ends ",
     "bead.drive.spring=1", ""},
    {"fibers.held", "they do not take up the momentum of the drive", BEAD_AND_FIBER "fibers.0.held=ends ",
     "bead.drive.force=[0,0,1]", ""},
    /* the mean bond and 8/sqrt(spring), by quadrature: 3.008 and 2.957 a0 */
    {"fibers.bond_length", "a bond may be so long that it touches two images", BEAD_AND_FIBER, "fibers.0.spring=12.5",
     "fibers.0.spring=13"},
    {"bead.drive.velocity", "there is no trap to move", BEAD "bead.drive.velocity=[0.1,0,0] ", "",
     "bead.drive.spring=1"},
    {"bead.drive.amplitude", "there is no trap to move", BEAD "bead.drive.amplitude=[0.1,0,0] bead.drive.period=10 ",
     "", "bead.drive.spring=1"},
    {"bead.drive.amplitude", "an oscillation needs a period",
     BEAD "bead.drive.amplitude=[0.1,0,0] bead.drive.spring=1 ", "", "bead.drive.period=10"},
    {"bead.drive.period", "nothing oscillates", BEAD "bead.drive.period=10 bead.drive.spring=1 ", "",
     "bead.drive.amplitude=[0.1,0,0]"},
    {"crossing.refusal", "with rule: event-driven no move is refused", BOX FIBER "crossing.refusal=bounce ",
     "crossing.rule=event-driven", "crossing.rule=sequential"},
    {"crossing.frame", "with rule: event-driven no vertex stands still", BOX FIBER "crossing.frame=flow ",
     "crossing.rule=event-driven", "crossing.rule=sequential"},
    {"crossing.exclusion", "with rule: event-driven no bond moves alone", BOX FIBER "crossing.exclusion=paper ",
     "crossing.rule=event-driven", "crossing.rule=sequential"},
    {"", "there is nothing to simulate", BOX, "", FIBER},
};

enum { MOST_SETTINGS = 32 };

/* Reads the scene that these words make. */
static bool make_scene(const char *both, const char *more, struct message *message)
{
  char text[2048];
  const char *option[MOST_SETTINGS];
  struct scene_settings settings = {0, option, 0};
  struct scene scene;
  snprintf(text, sizeof text, "%s%s", both, more);
  for (char *word = strtok(text, " "); word && settings.count < MOST_SETTINGS; word = strtok(NULL, " "))
    option[settings.count++] = word;
  assert_true(settings.count < MOST_SETTINGS);
  const bool ok = scene_make(&settings, &scene, message);
  if (ok)
    scene_free(&scene);
  return ok;
}

/* The row of this key whose reason begins so; there is one. */
static size_t find_row(const char *key, const char *says)
{
  size_t found = refusal_count, count = 0;
  for (size_t i = 0; i < refusal_count; i++)
    if (strcmp(refusals[i].key, key) == 0 && strncmp(refusals[i].why, says, strlen(says)) == 0)
      found = i, count++;
  if (count != 1)
    fail_msg("%zu rows of %s begin with '%s'", count, key, says);
  return found;
}

static bool ends_with(const char *text, const char *end)
{
  return strlen(text) >= strlen(end) && strcmp(text + strlen(text) - strlen(end), end) == 0;
}

/* In a scene phantoms have a number; a model built by hand may leave it out. */
static void forget_number_of_phantoms(bool *reached)
{
  struct model m = {.box.cells = {8, 8, 8}, .time_step = 0.1, .solvent = {.bath = BATH_PHANTOMS}};
  struct model_error error;
  assert_false(model_finish(&m, &error));
  const size_t row = find_row("solvent.bath", "phantoms without a per_cell");
  assert_string_equal(error.path, refusals[row].key);
  assert_string_equal(error.text, refusals[row].why);
  reached[row] = true;
  model_free(&m);
}

static void every_row_refuses(void **unused)
{
  (void)unused;
  bool *reached = calloc(refusal_count, sizeof *reached);
  size_t wrong = 0;
  assert_non_null(reached);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    const size_t row = find_row(rows[k].key, rows[k].says);
    struct message message = {.text = ""};
    char end[1024];
    snprintf(end, sizeof end, ": %s%s%s", rows[k].key, *rows[k].key ? ": " : "", refusals[row].why);
    if (make_scene(rows[k].both, rows[k].wrong, &message) || !ends_with(message.text, end)) {
      print_error("%s%s\nshould be refused with\n  %s\nbut it says\n  %s\n", rows[k].both, rows[k].wrong, end + 2,
                  *message.text ? message.text : "nothing");
      wrong++;
    } else {
      reached[row] = true;
    }
    if (!make_scene(rows[k].both, rows[k].right, &message)) {
      print_error("%s%s\nshould be allowed, but it says\n  %s\n", rows[k].both, rows[k].right, message.text);
      wrong++;
    }
  }
  forget_number_of_phantoms(reached);
  for (size_t i = 0; i < refusal_count; i++)
    if (!reached[i]) {
      print_error("no scene reaches the row '%s: %s'\n", refusals[i].key, refusals[i].why);
      wrong++;
    }
  free(reached);
  assert_int_equal(wrong, 0);
}

/* A reason says what is wrong, and then what is allowed. */
static void every_row_says_what_is_allowed(void **unused)
{
  (void)unused;
  for (size_t i = 0; i < refusal_count; i++)
    if (!strstr(refusals[i].why, "; allowed") && *refusals[i].key)
      fail_msg("%s: %s", refusals[i].key, refusals[i].why);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_row_refuses),
      cmocka_unit_test(every_row_says_what_is_allowed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

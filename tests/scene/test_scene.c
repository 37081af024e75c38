/* Scenes: what is read, what is refused and where, what is said about it. Runs in the root of the tree. */
#include "support.h"

#include <time.h>

#include "scene/made.h"
#include "scene/words.h"

/* A scene that is all right, one line an entry, so that tests can replace a line and know where the value stands. */
static const char *const good[] = {
    /*  1 */ "box: [16, 16, 16]",
    /*  2 */ "time_step: 0.01",
    /*  3 */ "steps: 100",
    /*  4 */ "seed: 1",
    /*  5 */ "order: kick-split",
    /*  6 */ "solvent:",
    /*  7 */ "  per_cell: 5",
    /*  8 */ "  collision_interval: 0.02",
    /*  9 */ "  rotation_angle: 90",
    /* 10 */ "fibers:",
    /* 11 */ "  - name: a",
    /* 12 */ "    count: 2",
    /* 13 */ "    vertices: 8",
    /* 14 */ "    mass: 5",
    /* 15 */ "    bond_length: 0.5",
    /* 16 */ "    spring: 100",
    /* 17 */ "    bending: 10",
    /* 18 */ "crossing:",
    /* 19 */ "  forbidden: true",
    /* 20 */ "observe:",
    /* 21 */ "  dynamics: {every: 10}",
};
enum { GOOD_LINES = sizeof good / sizeof *good };

/* The good scene with line number `line` (0: none) replaced. */
static size_t make_scene(char *text, size_t size, size_t line, const char *replacement)
{
  size_t used = 0;
  for (size_t i = 0; i < GOOD_LINES; i++)
    used += (size_t)snprintf(text + used, size - used, "%s\n", i + 1 == line ? replacement : good[i]);
  assert_true(used < size);
  return used;
}

static struct scene read_text(const char *text)
{
  struct scene scene;
  struct message message;
  if (!scene_read_text("test.yaml", text, strlen(text), &scene, &message))
    fail_msg("%s", message.text);
  return scene;
}

static struct scene read_with(size_t line, const char *replacement)
{
  char text[4096];
  make_scene(text, sizeof text, line, replacement);
  return read_text(text);
}

/* --- bad input ---------------------------------------------------------------------------------------------------- */

struct bad {
  size_t line;       /* of the good scene, that is replaced */
  const char *text;  /* by this */
  size_t at, column; /* where the message points */
  const char *says;
};

static const struct bad bad_scenes[] = {
    /* keys */
    {4, "sead: 1", 4, 1, "unknown key 'sead'; did you mean 'seed'?"},
    {4, "qwertyuiop: 1", 4, 1, "unknown key 'qwertyuiop'; allowed: box time_step seed order"},
    {7, "  percell: 5", 7, 3, "unknown key 'percell' in solvent; did you mean 'per_cell'?"},
    {17, "    bendign: 10", 17, 5, "unknown key 'bendign' in fibers; did you mean 'bending'?"},
    {21, "  dynamic: {every: 10}", 21, 3, "did you mean 'dynamics'?"},
    {21, "  dynamics: {evry: 10}", 21, 14, "unknown key 'evry' in observe.dynamics; did you mean 'every'?"},
    {4, "steps: 200", 4, 1, "key 'steps' is given twice, first in line 3"},
    {17, "    mass: 6", 17, 5, "key 'mass' is given twice, first in line 14"},
    {3, "", 1, 1, "key 'steps' is missing; allowed: whole number 0 .."},
    {7, "", 8, 3, "solvent: key 'per_cell' is missing; allowed: number > 0"},
    {16, "", 11, 5, "fibers: key 'spring' is missing; allowed: number > 0, <= 1000000000"},
    {15, "", 11, 5, "fibers: key 'bond_length' is missing; allowed: number >= 0, <= 512"},
    {17, "  - {name: b, count: 1, vertices: 2, mass: 1}", 17, 5, "fibers: key 'bond_length' is missing"},
    {17, "  - {name: b, count: 1, vertices: 0, mass: 1}", 17, 35, "'0' is out of range"},
    {17, "  - {name: b, count: 1, vertices: 1, mass: 1, spring: 0}", 17, 55, "'0' is out of range"},
    {17, "  - {name: b, count: 1, vertices: 1}", 17, 5, "fibers: key 'mass' is missing"},
    {21, "  dynamics: {longest_lag: 10}", 21, 13, "observe.dynamics: key 'every' is missing"},
    {4, "[1, 2]: 3", 4, 1, "a key must be a word"},
    /* types */
    {2, "time_step: fast", 2, 12, "time_step: 'fast' is not a finite number; allowed: number > 0, <= 1"},
    {2, "time_step: \"0.01\"", 2, 12, "is not a finite number"},
    {2, "time_step: 0.01 t0", 2, 12, "'0.01 t0' is not a finite number"},
    {2, "time_step:", 2, 11, "'' is not a finite number"},
    {2, "time_step: [0.01]", 2, 12, "a list of 1 is not a finite number"},
    {2, "time_step: 0x1p-7", 2, 12, "is not a finite number"},
    {2, "time_step: 1_0", 2, 12, "is not a finite number"},
    {2, "time_step: 0.01.0", 2, 12, "is not a finite number"},
    {3, "steps: 1e4", 3, 8, "steps: '1e4' is a whole number, but not in digits: write 10000"},
    {21, "  statics: true", 21, 12, "observe.statics: 'true' is not a mapping, as {every: 100}; allowed: a mapping"},
    {21, "\tstatics: {every: 10}", 21, 1, "a tab indents this line: YAML indents by spaces"},
    {11, "  -\tname: a", 11, 4, "a tab indents this line: YAML indents by spaces"},
    {3, "steps: 100.5", 3, 8, "is not a whole number"},
    {3, "steps: 0100", 3, 8, "write 100;"},
    {19, "  forbidden: yes", 19, 14, "crossing.forbidden: 'yes' is neither true nor false; allowed: true | false"},
    {18, "checkpoint: 5\ncrossing:", 18, 13, "checkpoint: '5' is not a mapping, as {seconds: 0.5}; allowed: a mapping"},
    {5, "order: kicksplit", 5, 8, "order: 'kicksplit' is no choice here, did you mean 'kick-split'?; allowed: paper |"},
    {5, "order: 3", 5, 8, "is no choice here; allowed: paper | kick-split | drift-split"},
    {17, "    start: straight\n    places: none", 18, 13, "fibers.places: 'none' is not a list"},
    {17, "    start: straight\n    places: [3]", 18, 14, "fibers.places: '3' is not a mapping"},
    {11, "  - name: a b", 11, 11, "fibers.name: 'a b' is not a name"},
    {11, "  - name: ../a", 11, 11, "is not a name"},
    /* range */
    {1, "box: [16, 16]", 1, 6, "box: a list of 2 is not a list of three; allowed: [x, y, z], each a whole"},
    {1, "box: 16", 1, 6, "box: '16' is not a list of three"},
    {1, "box: [16, 16, 16.5]", 1, 15, "box: '16.5' is not a whole number"},
    {1, "box: [16, 0, 16]", 1, 11, "box: '0' is out of range; allowed: [x, y, z], each a whole number 1 .. 1024"},
    {1, "box: [1025, 16, 16]", 1, 7, "'1025' is out of range"},
    {2, "time_step: 0", 2, 12, "time_step: '0' is out of range"},
    {2, "time_step: -0.01", 2, 12, "'-0.01' is out of range"},
    {2, "time_step: .nan", 2, 12, "is not a finite number"},
    {2, "time_step: nan", 2, 12, "is not a finite number"},
    {2, "time_step: inf", 2, 12, "is not a finite number"},
    {2, "time_step: 1e999", 2, 12, "is not a finite number"},
    {2, "time_step: 1e-999", 2, 12, "is not a finite number"},
    {3, "steps: -1", 3, 8, "is not a whole number"},
    {3, "steps: 9223372036854775808", 3, 8, "is out of range; allowed: whole number 0 .. 9223372036854775807"},
    {4, "seed: 18446744073709551616", 4, 7, "seed: '18446744073709551616' is not a whole number of 64 bits"},
    {4, "seed: -1", 4, 7, "is not a whole number of 64 bits"},
    {5, "flow: [0, 0, 101]", 5, 14, "flow: '101' is out of range"},
    {9, "  rotation_angle: 181", 9, 19, "solvent.rotation_angle: '181' is out of range; allowed: number > 0, <= 180"},
    {12, "    count: 0", 12, 12, "fibers.count: '0' is out of range; allowed: whole number 1 .. 2147483647"},
    {12, "    count: 4294967297", 12, 12, "'4294967297' is out of range"},
    {14, "    mass: 65537", 14, 11, "fibers.mass: '65537' is out of range"},
    {14, "    mass: 1e-6", 14, 11, "rounded to a multiple of 2^-16"},
    {21, "  dynamics: {every: 0}", 21, 21, "observe.dynamics.every: '0' is out of range"},
    /* values that do not go together */
    {8, "  collision_interval: 0.025", 8, 23, "0.025 is 2.5 time steps of 0.01; allowed: a whole multiple"},
    {8, "  collision_interval: 0.005", 8, 23, "0.005 is 0.5 time steps"},
    {8, "  collision_interval: 0.0200001", 8, 23, "a whole multiple of the time step"},
    {7, "  per_cell: 0.0001", 7, 13, "makes 0 particles; allowed: 1 to 2147483647"},
    {1, "box: [1024, 1024, 1024]", 7, 13, "makes 5368709120 particles"},
    {12, "    count: 2147483647", 12, 12, "17179869176 vertices up to here; allowed: 2147483647"},
    {2, "time_step: 0.2", 8, 23, "0.1 time steps"},
    {16, "    spring: 1e6", 2, 12, "unstable for the fibers 'a', whose highest frequency is"},
    {17, "    bending: 20000", 2, 12, "time_step: 0.01 is unstable"},
    {17, "    bending: 10\n    persistence_length: 5", 18, 25, "bending is given too; allowed: one of the two"},
    {17, "    bending: 0\n    persistence_length: 5", 18, 25, "bending is given too"},
    {17, "    bending: 10\n    persistence_length: 0", 18, 25, "bending is given too"},
    {15, "    bond_length: 0\n    persistence_length: 5\n#", 16, 25, "bending is given too"},
    {17, "    persistence_length: 1e9", 17, 25, "persistence_length/bond_length is 2e+09 kT; allowed: at most 1e+09"},
    {15, "    bond_length: 8", 15, 18, "the mean length of a bond is 8.0025 a0; allowed: below half the shortest edge"},
    {1, "box: [16, 16, 1]", 15, 18, "allowed: below half the shortest edge of the box, 0.5 a0"},
    {13, "    vertices: 2\n    ring: true", 13, 15, "a ring of 2; allowed: 3 or more"},
    {17, "    diameter: 0.7", 17, 15,
     "0.7 for bonds of a mean length of 0.538462 a0; allowed: 0, a thin line, or from"},
    {17, "    diameter: -1", 17, 15, "fibers.diameter"},
    {17, "    ring: true\n    start: equilibrium", 18, 12, "equilibrium for a ring; allowed: circle"},
    {17, "    start: circle", 17, 12, "circle for an open fiber; allowed: equilibrium | straight"},
    {17, "    start: random", 17, 12, "'random' is no choice here; allowed: equilibrium | straight | circle"},
    {17, "    places: [{center: [1, 1, 1], direction: [0, 0, 1]}]", 17, 13, "in equilibrium are placed at random"},
    {17, "    start: straight\n    places: [{center: [1, 1, 1], direction: [0, 0, 0]}]", 18, 45, "no direction"},
    {17, "    start: straight\n    places: [{center: [1, 1, 1]}]", 18, 14, "key 'direction' is missing"},
    {12,
     "    count: 1\n    start: straight\n    places:\n    - {center: [1, 1, 1], direction: [0, 0, 1]}\n"
     "    - {center: [2, 1, 1], direction: [0, 0, 1]}",
     16, 7, "2 places; allowed: at most as many as fibers, 1"},
    {13, "    vertices: 10000\n    start: straight", 13, 15, "make a half length of 2692.04 a0; allowed: below 2046"},
    {13, "    vertices: 2000000", 13, 15, "make a contour of"},
    {17, "  - {name: a, count: 1, vertices: 1, mass: 1, bond_length: 0, spring: 1}", 17, 12, "'a' is the name of an"},
    {21, "  dynamics: {every: 10, longest_lag: 5}", 21, 38, "5 steps, sampled every 10; allowed: 0"},
    {21, "  from: 101\n  dynamics: {every: 10}", 21, 9,
     "observe.from: averages would begin at step 101, after the run's 100 steps; allowed: at most `steps`"},
    {21, "  from_time: 1.001\n  dynamics: {every: 10}", 21, 14, "observe.from_time: averages would begin at step 101"},
    {21, "  from_time: 1e17", 21, 14, "observe.from_time: averages would begin at step 9223372036854775807"},
    {21, "  from: -1", 21, 9, "is not a whole number"},
    {21, "  from: 10\n  from_time: 0.1", 22, 14, "observe.from_time: from is given too; allowed: one of the two"},
    {18, "start: {snapshot: nowhere.h5}\ncrossing:", 18, 19, "cannot be read: No such file or directory; allowed"},
    {9, "  bath: ghosts", 9, 9, "solvent.bath: 'ghosts' is no choice here; allowed: particles | phantoms"},
    {9, "  bath: phantoms", 9, 9, "phantoms carry no hydrodynamic interactions; allowed with hydrodynamics: false"},
    {9, "  hydrodynamics: false\n  bath: phantoms\n  thermostat: rescale", 10, 9, "phantoms are a thermostat; allowed"},
    {9, "  hydrodynamics: false\n  bath: phantoms\n  acceleration: [0, 0, 1]", 10, 9, "phantoms are not accelerated"},
    {7, "  per_cell: 1001\n  hydrodynamics: false\n  bath: phantoms", 9, 9, "allowed with a per_cell of at most 1000"},
    /* YAML itself */
    {4, "seed: &x 1", 4, 7, "anchors (&) are not read"},
    {4, "seed: *x", 4, 7, "aliases (*) are not read"},
    {4, "seed: !!int 1", 4, 7, "tags (!) are not read"},
    {10, "fibers: &f", 10, 9, "anchors (&) are not read"},
    {1, "%YAML 1.1\n---\nbox: [16, 16, 16]", 1, 1, "directives (%) are not read"},
    {21, "---\nbox: [1, 1, 1]", 21, 1, "a second document begins here"},
    {2, "time_step: [0.01", 3, 6, "not YAML: "},
    {2, "\ttime_step: 0.01", 2, 1, "not YAML: "},
    {2, "time_step: 0.01: 3", 2, 16, "not YAML: "},
    {2, "time_step: \"0.01", 22, 1, "not YAML: while scanning a quoted scalar (begun in line 2)"},
    {4, "seed: 1 # \xff", 4, 11, "not YAML: invalid"},
    {4, "<<: {seed: 1}", 4, 1, "unknown key '<<'"},
};

static bool refused(const char *text, size_t size, size_t line, size_t column, const char *says)
{
  const char *folder = getenv("BUILD");
  char path[512];
  snprintf(path, sizeof path, "%s/test-scene.yaml", folder ? folder : ".");
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(text, 1, size, file), size);
  fclose(file);
  struct scene scene;
  struct message message;
  bool read = scene_read(path, &scene, &message);
  remove(path);
  if (read) {
    scene_free(&scene);
    print_error("this was read, not refused (%s):\n%s\n", says, text);
    return false;
  }
  char where[600];
  snprintf(where, sizeof where, "%s:%zu:%zu: ", path, line, column);
  bool right = strncmp(message.text, where, strlen(where)) == 0 && strstr(message.text, says);
  if (!right)
    print_error("the message should be\n  %s... %s\nbut it is\n  %s\n", where, says, message.text);
  return right;
}

static void bad_input_is_refused(void **unused)
{
  (void)unused;
  char text[4096];
  int wrong = 0;
  for (size_t i = 0; i < sizeof bad_scenes / sizeof *bad_scenes; i++) {
    const struct bad *b = &bad_scenes[i];
    size_t size = make_scene(text, sizeof text, b->line, b->text);
    wrong += !refused(text, size, b->at, b->column, b->says);
  }
  assert_int_equal(wrong, 0);
  print_message("  %zu bad scenes refused\n", sizeof bad_scenes / sizeof *bad_scenes);
}

/* What a bead may not be, and what may not be with it. The bead's line is line 5. */
static void bad_beads_are_refused(void **unused)
{
  (void)unused;
  static const struct {
    const char *bead, *observe;
    size_t line, column;
    const char *says;
  } rows[] = {
      {"{radius: 5}", "{from: 0}", 5, 16,
       "bead.radius: 5 a0 in a box whose shortest edge is 16 a0; allowed: at most 4 a0"},
      {"{radius: 20}", "{from: 0}", 5, 16, "allowed: at most 4 a0"},
      {"{radius: 1.2}", "{from: 0}", 5, 16, "bead.radius: '1.2' is out of range"},
      {"{radius: 2, mass: 100}", "{from: 0}", 5, 25, "bead.mass: 100 m, and the solvent it displaces has 167.5"},
      {"{radius: 2, drive: {velocity: [0.1, 0, 0]}}", "{from: 0}", 5, 37,
       "there is no trap to move; allowed with a spring"},
      {"{radius: 2, drive: {spring: 1, amplitude: [1, 0, 0]}}", "{from: 0}", 5, 49, "an oscillation needs a period"},
      {"{radius: 2, drive: {spring: 1, period: 10}}", "{from: 0}", 5, 46,
       "nothing oscillates; allowed with an amplitude"},
      {"{radius: 2, drive: {spring: 1, amplitude: [0.1, 0, 0], period: 0.5}}", "{from: 0}", 5, 70,
       "allowed: 8 time steps"},
      {"{radius: 2, drive: {spring: 1, amplitude: [5, 0, 0], period: 10}}", "{from: 0}", 5, 49,
       "largest speed, 2 pi/period"},
      {"{radius: 2, drive: {spring: 1, velocity: [0.3, 0.3, 0.3]}}", "{from: 0}", 5, 48, "allowed: at most 0.5"},
      {"{radius: 2, drive: {spring: 5000}}", "{from: 0}", 5, 35, "allowed: at most 0.5, a spring of 4188.79"},
      {"{radius: 2, drive: {force: [0, 0, 200]}}", "{from: 0}", 5, 34, "too near the speed of sound; allowed: at most"},
      {"{radius: 2, drive: {pull: 1}}", "{from: 0}", 5, 27, "unknown key 'pull' in bead.drive"},
      {"{radius: 2}", "{stress: {every: 1}}", 6, 19, "observe.stress: momentum that the solvent gives to the bead"},
      {"{radius: 2}", "{pressure: {every: 1}}", 6, 21, "observe.pressure: momentum that the solvent gives to the bead"},
      {"{radius: 2}", "{profile: {every: 1, slabs: 4}}", 6, 20, "observe.profile: a slab is not full of solvent"},
      {"{radius: 2}", "{wake: {every: 1}}", 6, 17,
       "observe.wake: it looks at the fibers around a bead; allowed with both"},
  };
  int wrong = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char text[1024];
    const int size = snprintf(text, sizeof text,
                              "box: [16, 16, 16]\ntime_step: 0.1\nsteps: 1\n"
                              "solvent: {per_cell: 5, collision_interval: 0.1}\nbead: %s\nobserve: %s\n",
                              rows[i].bead, rows[i].observe);
    wrong += !refused(text, (size_t)size, rows[i].line, rows[i].column, rows[i].says);
  }
  static const char none[] = "box: [16, 16, 16]\ntime_step: 0.1\nsteps: 1\n"
                             "solvent: {per_cell: 5, collision_interval: 0.1}\nobserve: {bead: {every: 1}}\n";
  wrong += !refused(none, sizeof none - 1, 5, 17, "observe.bead: there is none; allowed with a bead");
  assert_int_equal(wrong, 0);
}

static void whole_files_are_refused(void **unused)
{
  (void)unused;
  assert_true(refused("", 0, 1, 1, "the scene is empty"));
  assert_true(refused("# nothing\n", 10, 1, 1, "the scene is empty"));
  assert_true(refused("- a\n", 4, 1, 1, "not a mapping"));
  assert_true(refused("box: [4, 4, 4]\ntime_step: 0.1\nsteps: 1\n", 39, 1, 1, "there is nothing to simulate"));
  assert_true(refused("box: 1\0\n", 8, 1, 7, "a NUL byte"));
  static const char bare[] = "box: [4, 4, 4]\ntime_step: 0.1\nsteps: 1\n"
                             "solvent: {per_cell: 3, collision_interval: 0.1}\ntrajectory: {every: 1}\n",
                    said[] =
                        "box: [4, 4, 4]\ntime_step: 0.1\nsteps: 1\n"
                        "solvent: {per_cell: 3, collision_interval: 0.1}\ntrajectory: {every: 1, solvent: false}\n";
  assert_true(
      refused(bare, strlen(bare), 5, 13, "trajectory.solvent: without fibers, frames of nothing; allowed: true"));
  assert_true(refused(said, strlen(said), 5, 33, "allowed: true"));
  static const char stiff[] = "box: [4, 4, 4]\ntime_step: 0.1\nsteps: 1\nfibers: [{name: a, count: 1, vertices: 2, "
                              "mass: 1, spring: 1,\n bond_length: 1e-300, persistence_length: 1e9}]\n";
  assert_true(refused(stiff, strlen(stiff), 5, 43, "persistence_length/bond_length is inf kT; allowed: at most"));
  struct scene scene;
  struct message message;
  assert_false(scene_read("no-such-folder/scene.yaml", &scene, &message));
  assert_non_null(strstr(message.text, "no-such-folder/scene.yaml: cannot be opened for reading: No such file"));
  assert_false(scene_read("scenes", &scene, &message));
  assert_non_null(strstr(message.text, "scenes: not a file but a folder"));
}

/* The good scene cut off anywhere is read or refused, never worse (valgrind and sanitizers see to that). */
static void truncated_files(void **unused)
{
  (void)unused;
  char text[4096];
  size_t size = make_scene(text, sizeof text, 0, "");
  for (size_t cut = 0; cut < size; cut++) {
    struct scene scene;
    struct message message;
    if (scene_read_text("cut.yaml", text, cut, &scene, &message))
      scene_free(&scene);
    else
      assert_int_equal(strncmp(message.text, "cut.yaml:", 9), 0);
  }
}

/* --- good input --------------------------------------------------------------------------------------------------- */

static void values_arrive(void **unused)
{
  (void)unused;
  struct scene s;
  struct message message;
  if (!scene_read("scenes/semidilute.yaml", &s, &message))
    fail_msg("%s", message.text);
  const struct model *m = &s.model;
  assert_int_equal(m->box.cells[0], 32);
  assert_true(m->box.edge[2] == 32 * LATTICE_CELL);
  assert_true(m->time_step == 0.01 && m->scheme == SCHEME_KICK_SPLIT);
  assert_int_equal(m->solvent.particles, 163840);
  assert_int_equal(m->solvent.interval_steps, 2);
  assert_true(m->solvent.cosine == 0.0 && m->solvent.sine == 1.0);
  assert_true(m->solvent.hydrodynamics && m->solvent.thermostat == THERMOSTAT_NONE);
  assert_true(m->crossing.forbidden && m->crossing.exclusion == EXCLUSION_SHARED_VERTEX);
  assert_int_equal(m->kinds, 1);
  assert_string_equal(m->kind[0].name, "fiber");
  assert_true(m->kind[0].bending == 64.0 && m->kind[0].spring == 100.0 && m->kind[0].mass == 5.0);
  assert_int_equal(m->vertices, 6400);
  assert_int_equal(m->bonds, 6300);
  assert_true(s.steps == 10000 && m->seed == 1 && s.checkpoint_seconds == 300.0);
  assert_true(s.observe.every[OBSERVE_DYNAMICS] == 10 && s.observe.every[OBSERVE_CONSERVED] == 100);
  assert_true(s.trajectory_every == 100 && !s.trajectory_velocities && !s.trajectory_solvent);
  assert_string_equal(s.path, "scenes/semidilute.yaml");
  assert_non_null(strstr(s.text, "the point of it all"));
  scene_free(&s);
}

/* Numbers at the edge of what a double or an integer holds. */
static void numbers_are_exact(void **unused)
{
  (void)unused;
  struct scene s = read_with(4, "seed: 18446744073709551615");
  assert_true(s.model.seed == UINT64_MAX);
  scene_free(&s);
  s = read_with(4, "seed: 9007199254740993"); /* 2^53 + 1, no double */
  assert_true(s.model.seed == 9007199254740993u);
  scene_free(&s);
  s = read_with(14, "    mass: 0.3"); /* 19660.8 units of 2^-16 */
  assert_true(s.model.kind[0].mass == 19661.0 / 65536.0 && s.model.mass[15] == 19661.0 / 65536.0);
  scene_free(&s);
  s = read_with(2, "time_step: +1.0E-2");
  assert_true(s.model.time_step == 0.01);
  scene_free(&s);
  s = read_with(7, "  per_cell: 0.1"); /* 409.6 particles */
  assert_int_equal(s.model.solvent.particles, 410);
  scene_free(&s);
}

static void rotation_angles(void **unused)
{
  (void)unused;
  struct scene s = read_with(9, "  rotation_angle: 180");
  assert_true(s.model.solvent.cosine == -1.0 && s.model.solvent.sine == 0.0);
  scene_free(&s);
  s = read_with(9, "  rotation_angle: 130"); /* bc -l: c(130*a(1)/45) */
  assert_close(s.model.solvent.cosine, -0.64278760968653932632, 1e-15);
  assert_close(s.model.solvent.sine, 0.76604444311897803520, 1e-15);
  scene_free(&s);
}

static void defaults(void **unused)
{
  (void)unused;
  struct scene s =
      read_text("box: [4, 5, 6]\ntime_step: 0.01\nsteps: 0\n"
                "fibers:\n- {name: r, count: 1, vertices: 8, ring: true, mass: 5, bond_length: 0.5, spring: 100}\n"
                "- {name: o, count: 1, vertices: 8, mass: 5, bond_length: 0.5, spring: 100}\n");
  const struct model *m = &s.model;
  assert_true(m->seed == 1 && m->scheme == SCHEME_KICK_SPLIT && vec3_norm(m->flow) == 0.0);
  assert_true(!model_has_solvent(m) && m->crossing.forbidden && m->solvent.hydrodynamics);
  assert_true(m->kind[0].start == START_CIRCLE && m->kind[1].start == START_EQUILIBRIUM);
  assert_true(m->kind[0].bending == 0.0 && m->kind[0].placed == 0);
  assert_true(m->box.cells[0] == 4 && m->box.cells[1] == 5 && m->box.cells[2] == 6);
  for (int i = 0; i < OBSERVABLES; i++)
    assert_true(s.observe.every[i] == 0);
  assert_true(s.trajectory_every == 0 && s.checkpoint_seconds == 300.0 && s.snapshot == NULL);
  scene_free(&s);
}

static void places(void **unused)
{
  (void)unused;
  struct scene s =
      read_with(17, "    start: straight\n    places:\n      - {center: [1, 2, 3], direction: [0, 0, -2]}");
  const struct fiber_kind *k = &s.model.kind[0];
  assert_int_equal(k->placed, 1);
  const struct fiber_place *p = &k->place[0];
  assert_true(p->center.x == 1.0 && p->center.y == 2.0 && p->center.z == 3.0 && p->direction.z == -2.0);
  scene_free(&s);
}

static void snapshot_path(void **unused)
{
  (void)unused;
  static const char text[] =
      "box: [4, 4, 4]\ntime_step: 0.01\nsteps: 1\nsolvent: {per_cell: 5, collision_interval: 0.01}\n"
      "start: {snapshot: %s}\n";
  const struct {
    const char *scene, *snapshot, *path;
  } rows[] = {
      {"a/b/s.yaml", "x.h5", "a/b/x.h5"},     {"s.yaml", "x.h5", "x.h5"},
      {"/s.yaml", "../x.h5", "/../x.h5"},     {"a/s.yaml", "/r/x.h5", "/r/x.h5"},
      {"a/s.yaml", "\"x y.h5\"", "a/x y.h5"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char whole[512];
    snprintf(whole, sizeof whole, text, rows[i].snapshot);
    struct scene s;
    struct message message;
    assert_true(scene_read_text(rows[i].scene, whole, strlen(whole), &s, &message));
    char *path = scene_snapshot_path(&s);
    assert_string_equal(path, rows[i].path);
    free(path);
    scene_free(&s);
  }
}

/* Just below omega dt = 2 is read, just above is not. Two masses 5 on a spring of 100: omega = sqrt(40). */
static void stability_limit(void **unused)
{
  (void)unused;
  static const char text[] = "box: [9, 9, 9]\ntime_step: %.17g\nsteps: 1\n"
                             "fibers: [{name: a, count: 1, vertices: 2, mass: 5, bond_length: 0.5, spring: 100}]\n";
  char whole[512];
  struct scene s;
  struct message message;
  snprintf(whole, sizeof whole, text, 2.0 / sqrt(40.0) * (1.0 - 1e-9));
  s = read_text(whole);
  scene_free(&s);
  snprintf(whole, sizeof whole, text, 2.0 / sqrt(40.0) * (1.0 + 1e-9));
  assert_false(scene_read_text("test.yaml", whole, strlen(whole), &s, &message));
}

/* --- the effective scene, and its fingerprint --------------------------------------------------------------------- */

static char *written(const struct scene *scene)
{
  char *text = NULL;
  size_t size = 0;
  FILE *stream = open_memstream(&text, &size);
  scene_write(scene, stream, false);
  fclose(stream);
  return text;
}

static const char *const shipped[] = {"scenes/semidilute.yaml", "scenes/dense.yaml", "scenes/dense-crossable.yaml",
                                      "scenes/chains.yaml",     "scenes/rings.yaml", "scenes/solvent.yaml"};

/* What is written reads back to the same scene. */
static void effective_scene_reads_back(void **unused)
{
  (void)unused;
  for (size_t i = 0; i < sizeof shipped / sizeof *shipped; i++) {
    struct scene s;
    struct message message;
    if (!scene_read(shipped[i], &s, &message))
      fail_msg("%s", message.text);
    char *once = written(&s);
    struct scene again = read_text(once);
    char *twice = written(&again);
    assert_string_equal(once, twice);
    assert_true(s.fingerprint == again.fingerprint);
    free(once);
    free(twice);
    scene_free(&again);
    scene_free(&s);
  }
}

/* A bead has no bonds, so their keys may be missing. The effective scene has a rest length of 0 and a spring of 1. */
static void beads_need_no_bonds(void **unused)
{
  (void)unused;
  struct scene bare = read_with(17, "  - {name: b, count: 1, vertices: 1, mass: 1}");
  struct scene full = read_with(17, "  - {name: b, count: 1, vertices: 1, mass: 1, bond_length: 0, spring: 1}");
  struct scene other = read_with(17, "  - {name: b, count: 1, vertices: 1, mass: 1, bond_length: 0.5, spring: 1}");
  assert_true(bare.model.kind[1].bond_length == 0.0 && bare.model.kind[1].spring == 1.0);
  assert_true(bare.fingerprint == full.fingerprint && bare.fingerprint != other.fingerprint);
  char *ours = written(&bare), *theirs = written(&full);
  assert_string_equal(ours, theirs);
  free(theirs);
  free(ours);
  scene_free(&other);
  scene_free(&full);
  scene_free(&bare);
}

static void fingerprints(void **unused)
{
  (void)unused;
  const struct {
    size_t line;
    const char *text;
    bool same;
  } rows[] = {
      {4, "seed: 2", true},
      {3, "steps: 7 # a comment", true},
      {21, "  conserved: {every: 3}", true},
      {18, "trajectory: {every: 5}\ncheckpoint: {seconds: 1}\ncrossing:", true},
      {15, "    bond_length: 5.0e-1", true},
      {1, "box: [16, 16, 17]", false},
      {2, "time_step: 0.02", false},
      {5, "order: paper", false},
      {5, "flow: [0, 0, 0.1]", false},
      {7, "  per_cell: 6", false},
      {8, "  collision_interval: 0.04", false},
      {9, "  rotation_angle: 91", false},
      {9, "  thermostat: rescale", false},
      {9, "  hydrodynamics: false", false},
      {9, "  hydrodynamics: false\n  bath: particles", false},
      {9, "  bath: particles", true},
      {9, "  acceleration: [1e-9, 0, 0]", false},
      {11, "  - name: b", false},
      {12, "    count: 3", false},
      {13, "    vertices: 9", false},
      {14, "    mass: 6", false},
      {15, "    bond_length: 0.50000000000000011", false},
      {16, "    spring: 101", false},
      {17, "    bending: 11", false},
      {17, "    bending: 10\n    ring: true", false},
      {17, "    bending: 10\n    start: straight", false},
      {17, "    bending: 10\n    force: [0, 1, 0]", false},
      {19, "  forbidden: false", false},
      {19, "  exclusion: paper", false},
      {18, "start: {snapshot: x.h5}\ncrossing:", false},
  };
  struct scene s = read_with(0, "");
  const uint64_t fingerprint = s.fingerprint;
  scene_free(&s);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    s = read_with(rows[i].line, rows[i].text);
    if ((s.fingerprint == fingerprint) != rows[i].same)
      fail_msg("the fingerprint %s with '%s'", rows[i].same ? "changes" : "does not change", rows[i].text);
    scene_free(&s);
  }
  s = read_with(17, "    persistence_length: 5"); /* kappa = 5/0.5 */
  assert_true(s.fingerprint == fingerprint);
  scene_free(&s);
}

/* As the program of commit af01d53 printed them (`uncross check`). A checkpoint resumes only with its fingerprint, so
 * they stay, whatever keys are added. What the scenes have changed since is set back. */
static void fingerprints_stay(void **unused)
{
  (void)unused;
  static const char *const paper[] = {"crossing.rule=sequential", "solvent.thermostat=rescale"};
  static const char *const pack[] = {"start.stream=own"};
  const struct {
    const char *path;
    uint64_t fingerprint;
    struct scene_settings back;
  } rows[] = {
      {"scenes/chains.yaml", 0xe900124ac639260b, {0, NULL, 0}},
      {"scenes/dense-crossable.yaml", 0x93d2febcb2ceecb8, {2, paper, 0}},
      {"scenes/dense.yaml", 0xd42870592b905d33, {2, paper, 0}},
      {"scenes/rings.yaml", 0x60247d7e46679b27, {1, paper, 0}},
      {"scenes/semidilute.yaml", 0x4fa44d7e597c2d40, {0, NULL, 0}},
      {"scenes/solvent.yaml", 0xfb58264a361f4f30, {1, paper, 0}},
      {"reference-data/coarse.yaml", 0x42df1dd8c37a4632, {1, pack, 0}},
      {"reference-data/dense.yaml", 0x5efa7dc91f00a88c, {1, pack, 0}},
      {"reference-data/mixed.yaml", 0xd4aa0ded08982ac7, {1, pack, 0}},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    struct scene s;
    struct message message;
    if (!scene_read_set(rows[i].path, &rows[i].back, &s, &message))
      fail_msg("%s", message.text);
    if (s.fingerprint != rows[i].fingerprint)
      fail_msg("%s has the fingerprint %016lx", rows[i].path, (unsigned long)s.fingerprint);
    scene_free(&s);
  }
}

/* --- keys from outside -------------------------------------------------------------------------------------------- */

static bool read_set(const char *const *options, size_t count, struct scene *scene, struct message *message)
{
  const struct scene_settings settings = {count, options, 0};
  return scene_read_set("scenes/rings.yaml", &settings, scene, message);
}

/* What is set is what the file would say: given by the file or not, in sections that it has or not, by number or name.
 */
static void settings_are_as_the_file(void **unused)
{
  (void)unused;
  static const char *const options[] = {
      "box=[17, 18, 19]",
      "time_step=0.005",
      "solvent.per_cell=4",
      "solvent.thermostat=rescale",
      "fibers.0.mass=4",
      "fibers.linked.spring=90",
      "seed=18446744073709551615",
      "flow=[0, 0, 1e-3]",
      "checkpoint.seconds=7",
      "trajectory.every=3",
      "trajectory.velocities=false",
      "fibers.2.name=more",
      "fibers.more.count=2",
      "fibers.more.vertices=3",
      "fibers.2.mass=2",
      "fibers.2.bond_length=0.5",
      "fibers.2.spring=50",
      "fibers.2.start=straight",
      "fibers.2.places.0.center=[1, 2, 3]",
      "fibers.2.places.0.direction=[ 0,0 , 1 ]",
      "steps= 12 ",
      "steps=13",
  };
  struct scene s, again;
  struct message message;
  if (!read_set(options, sizeof options / sizeof *options, &s, &message))
    fail_msg("%s", message.text);
  const struct model *m = &s.model;
  assert_true(m->box.cells[0] == 17 && m->box.cells[1] == 18 && m->box.cells[2] == 19);
  assert_true(m->time_step == 0.005 && m->solvent.per_cell == 4.0 && m->solvent.particles == 17 * 18 * 19 * 4);
  assert_true(m->solvent.thermostat == THERMOSTAT_RESCALE && m->seed == UINT64_MAX && m->flow.z == 1e-3);
  assert_true(m->kind[0].mass == 4.0 && m->kind[0].spring == 90.0 && s.checkpoint_seconds == 7.0);
  assert_true(s.trajectory_every == 3 && !s.trajectory_velocities && s.steps == 13);
  assert_true(m->kinds == 3 && m->kind[2].count == 2 && m->kind[2].placed == 1);
  assert_true(m->kind[2].place[0].center.z == 3.0 && m->kind[2].place[0].direction.z == 1.0);
  /* what files keep is the same scene, and says where it is from */
  assert_int_equal(
      strncmp(s.text, "# The effective scene of scenes/rings.yaml, every default filled in; --set box=", 79), 0);
  assert_true(scene_read_text("kept", s.text, strlen(s.text), &again, &message));
  assert_true(again.fingerprint == s.fingerprint && again.steps == 13 && again.model.seed == UINT64_MAX);
  char *once = written(&s), *twice = written(&again);
  assert_string_equal(once, twice);
  free(once);
  free(twice);
  scene_free(&again);
  scene_free(&s);
  assert_true(scene_read_set("scenes/semidilute.yaml", &(struct scene_settings){0, NULL, 0}, &s, &message));
  assert_non_null(strstr(s.text, "# ")); /* the file's own text, comments and all */
  assert_null(strstr(s.text, "effective scene"));
  scene_free(&s);
}

static void bad_settings_are_refused(void **unused)
{
  (void)unused;
  const struct {
    const char *option, *says;
  } rows[] = {
      {"solvent.per_cel=5", "unknown key 'per_cel' in solvent; did you mean 'per_cell'?"},
      {"solvnt.per_cell=5", "unknown key 'solvnt'; did you mean 'solvent'?"},
      {"fibers.0.massive=5", "unknown key 'massive' in fibers; did you mean 'mass'?"},
      {"solvent.per_cell=many", "solvent.per_cell: 'many' is not a finite number; allowed: number > 0"},
      {"solvent.per_cell=", "solvent.per_cell: '' is not a finite number"},
      {"solvent.per_cell=-1", "solvent.per_cell: '-1' is out of range"},
      {"solvent.per_cell='5'", "solvent.per_cell: '5' is not a finite number"},
      {"solvent.per_cell=[5]", "solvent.per_cell: a list of 1 is not a finite number"},
      {"solvent.thermostat=rescal", "'rescal' is no choice here, did you mean 'rescale'?"},
      {"solvent.per_cell=1e-9", "solvent.per_cell: 1e-09 in a box of"},
      {"fibers.0.vertices=2", "fibers.vertices: a ring of 2; allowed: 3 or more"},
      {"observe.dynamics.longest_lag=5", "observe.dynamics: key 'every' is missing"},
      {"fibers.7.count=1", "'7' is no item of the list; allowed: a name, or 0 to 2 (which appends one)"},
      {"fibers.rods.count=1", "'rods' is no item of the list"},
      {"fibers.2.count=1", "fibers: key 'name' is missing"},
      {"fibers.0=1", "'0' is not all of a path; allowed: a key of the item behind it"},
      {"fibers=1", "'fibers' has keys of its own; allowed: a path to one of them"},
      {"solvent={per_cell: 5}", "'solvent' has keys of its own"},
      {"time_step.x=1", "'time_step' has no keys of its own"},
      {"time_step", "no '='; allowed: --set path=value"},
      {"=1", "'' is no key"},
      {"solvent..per_cell=1", "'' is no key"},
      {"box=[4, 4, 4", "a list that is not closed"},
      {"box=[4, 4, 4] 5", "something follows the value"},
      {"box=[[[[[[[[[[[[[[[[[[4", "lists too deep"},
      {"flow={x: 1}", "a mapping; its keys are set one by one"},
      {"start.snapshot=\"a", "a quote that is not closed"},
      {"start.snapshot=\"no\\x\"", "a backslash in quotes"},
      {"start.snapshot=nowhere.h5", "start.snapshot: 'scenes/nowhere.h5' cannot be read"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    struct scene s;
    struct message message;
    char begins[256];
    snprintf(begins, sizeof begins, "--set %s: ", rows[i].option);
    if (read_set(&rows[i].option, 1, &s, &message))
      fail_msg("--set %s was taken", rows[i].option);
    if (strncmp(message.text, begins, strlen(begins)) != 0 || !strstr(message.text, rows[i].says))
      fail_msg("the message should be\n  %s... %s\nbut it is\n  %s", begins, rows[i].says, message.text);
  }
}

/* Without a file and without YAML: the scene is that of the file that says the same. */
static void settings_make_a_scene(void **unused)
{
  (void)unused;
  static const char *const options[] = {
      "box=[16, 16, 16]",
      "time_step=0.01",
      "steps=100",
      "solvent.per_cell=5",
      "solvent.collision_interval=0.02",
      "fibers.0.name=a",
      "fibers.0.count=2",
      "fibers.0.vertices=8",
      "fibers.0.mass=5",
      "fibers.0.bond_length=0.5",
      "fibers.0.spring=100",
      "fibers.0.bending=10",
      "observe.dynamics.every=10",
      "crossing.rule=sequential",
  };
  const struct scene_settings settings = {sizeof options / sizeof *options, options, 0};
  struct scene s, file = read_with(0, ""), again;
  struct message message;
  if (!scene_make(&settings, &s, &message))
    fail_msg("%s", message.text);
  char *one = written(&s), *other = written(&file);
  assert_string_equal(one, other);
  assert_true(s.fingerprint == file.fingerprint);
  assert_true(scene_read_text("kept", s.text, strlen(s.text), &again, &message));
  assert_true(again.fingerprint == s.fingerprint);
  free(one);
  free(other);
  scene_free(&s);
  scene_free(&file);
  scene_free(&again);
  const struct scene_settings few = {2, options, 0};
  assert_false(scene_make(&few, &s, &message));
  assert_non_null(strstr(message.text, "key 'steps' is missing"));
  const struct scene_settings none = {0, NULL, 0};
  assert_false(scene_make(&none, &s, &message));
}

/* Every section of a table in a scene that holds else what it must. Their number. */
static unsigned sections_are_refused(const struct key_table *table, const char *before, const char *after)
{
  unsigned count = 0;
  for (size_t k = 0; k < table->count; k++) {
    const struct key *key = &table->key[k];
    char text[300], says[100];
    struct scene scene;
    struct message message = {.text = ""};
    if (key->type == KEY_INCLUDE)
      count += sections_are_refused(key->keys, before, after);
    if (key->type != KEY_SECTION)
      continue;
    snprintf(text, sizeof text, "box: [4, 4, 4]\ntime_step: 0.1\nsteps: 1\n%s%s: {}%s\n", before, key->name, after);
    snprintf(says, sizeof says, "%s: is empty", key->name);
    assert_false(scene_read_text("s", text, strlen(text), &scene, &message));
    if (!strstr(message.text, says))
      fail_msg("%s is not called empty, but: %s", text, message.text);
    count += 1 + (strcmp(key->name, "observe") == 0 ? sections_are_refused(key->keys, "observe: {", "}") : 0);
  }
  return count;
}

static void empty_sections(void **unused)
{
  (void)unused;
  /* walls, shear, bead, observe and what is observed, crossing, ...: docs/scene.md has a table for each */
  assert_in_range(sections_are_refused(&scene_keys, "", ""), 20, 40);
}

/* Two thousand kinds, and as many settings, are read in a moment: no step of reading grows as their square. */
static void many_kinds(void **unused)
{
  (void)unused;
  enum { KINDS = 2000 };
  char *text = malloc(KINDS * 200), (*option)[64] = malloc(KINDS * sizeof *option);
  const char **options = malloc(KINDS * sizeof *options);
  size_t used = (size_t)sprintf(text, "box: [9, 9, 9]\ntime_step: 0.01\nsteps: 1\nfibers:\n");
  for (int k = 0; k < KINDS; k++) {
    used +=
        (size_t)sprintf(text + used, "- {name: k%d, count: 1, vertices: 2, mass: 5, bond_length: 0.5, spring: 100}\n",
                        k * 7919 % KINDS);
    snprintf(option[k], sizeof option[k], "fibers.k%d.mass=4", k);
    options[k] = option[k];
  }
  struct message message;
  struct scene s;
  clock_t begin = clock();
  assert_true(scene_read_text("many.yaml", text, used, &s, &message));
  assert_int_equal(s.model.kinds, KINDS);
  assert_true(s.model.kind[KINDS - 1].mass == 5.0);
  scene_free(&s);
  print_message("  %d kinds in %.3f s\n", KINDS, (double)(clock() - begin) / CLOCKS_PER_SEC);
  assert_true(clock() - begin < 2 * CLOCKS_PER_SEC);
  begin = clock();
  char path[512];
  snprintf(path, sizeof path, "%s/many.yaml", getenv("BUILD") ? getenv("BUILD") : "build");
  FILE *file = fopen(path, "w");
  fwrite(text, 1, used, file);
  fclose(file);
  const struct scene_settings settings = {KINDS, options, 0};
  if (!scene_read_set(path, &settings, &s, &message))
    fail_msg("%s", message.text);
  for (uint32_t k = 0; k < s.model.kinds; k++)
    assert_true(s.model.kind[k].mass == 4.0);
  print_message("  %d settings in %.3f s\n", KINDS, (double)(clock() - begin) / CLOCKS_PER_SEC);
  assert_true(clock() - begin < 4 * CLOCKS_PER_SEC);
  scene_free(&s);
  remove(path);
  /* the last one has the name of the first */
  sprintf(text + used, "- {name: k0, count: 1, vertices: 2, mass: 5, bond_length: 0.5, spring: 100}\n");
  assert_false(scene_read_text("many.yaml", text, strlen(text), &s, &message));
  assert_non_null(strstr(message.text, "many.yaml:2005:10: fibers.name: 'k0' is the name of an earlier kind"));
  free(text);
  free(option);
  free(options);
}

/* --- warnings and report ------------------------------------------------------------------------------------------ */

static void collect(void *context, const char *text)
{
  char *all = context;
  size_t used = strlen(all);
  snprintf(all + used, 8192 - used, "%s\n", text);
}

static void warnings(void **unused)
{
  (void)unused;
  const struct {
    size_t line;
    const char *text, *says; /* says NULL: no warning */
  } rows[] = {
      {0, "", NULL},
      {8, "  collision_interval: 0.1", NULL},
      {8, "  collision_interval: 0.11", "collision_interval 0.11 > 0.1 t0"},
      {9, "  rotation_angle: 60", "rotation_angle 60 < 90"},
      {9, "  rotation_angle: 130", NULL},
      {9, "  rotation_angle: 175", "close to 180"},
      {5, "flow: [0.1, 0, 0]", NULL},
      {5, "flow: [0.1, 0.1, 0]", "Mach number is 0.11 > 0.1"},
      {14, "    mass: 11", "mass 11 is far from gamma = 5"},
      {14, "    mass: 2", "mass 2 is far from gamma = 5"},
      {14, "    mass: 10", NULL},
      {15, "    bond_length: 1.2", "bond_length 1.2 > 1 a0: the solvent passes between vertices"},
      {13, "    vertices: 32", NULL}, /* L = 32 l0 = 16 a0: as long as the box */
      {13, "    vertices: 33", "a fiber can meet its own image: it reaches 16.5 a0"},
      {13, "    vertices: 64\n    ring: true", NULL}, /* half of it goes there, half back */
      {13, "    vertices: 66\n    ring: true", "a fiber can meet its own image: it reaches 16.5 a0"},
      {13, "    vertices: 60000", "no box can be so long"},
      {16, "    spring: 1.5e4", "omega dt ="},
      {5, "order: paper", "the order 'paper' heats"},
      {17, "    force: [0, 0, 1]", "a net force of (0, 0, 16)"},
      /* 16 vertices of force 1 against 4096*5 particles of acceleration -16/20480 */
      {17, "    force: [0, 0, 1]\nflow: [0, 0, 0]", "a net force"},
      {9, "  thermostat: rescale\n  acceleration: [0, 0, 0.001]", "a net force"},
      {16, "    spring: 0.3\n    start: equilibrium", "are expected to reach half the shortest edge"},
      {21, "  dynamics: {every: 10, longest_lag: 50}", "more than a quarter of the run's 100 steps"},
      {21, "  dynamics: {every: 200}", "sampled every 200 steps, but the run has 100"},
      {21, "  from: 61\n  dynamics: {every: 10, longest_lag: 10}", "more than a quarter of the observed 39 steps"},
      {21, "  from: 60\n  dynamics: {every: 10, longest_lag: 10}", NULL},
      {17, "    force: [0, 0, 1]", "use the columns g_cm_about_mean, D_about_mean"},
      {12, "    count: 1\n    force: [0, 0, 1]", "use the columns drift_x, drift_y, drift_z, or two fibers"},
      {17,
       "    force: [0, 0, 1]\n  - {name: b, count: 1, vertices: 1, mass: 5, bond_length: 0, spring: 1, force: [1, 0, "
       "0]}",
       "D = g_cm/6t of 'a' and 1 more kind contain (v t)^2; use the columns g_cm_about_mean"},
      {17, "    force: [0, 0, 1]", "balances it, with solvent.thermostat: rescale"},
      {9, "  hydrodynamics: false\n  bath: phantoms", NULL},
      {19, "  forbidden: false\n# ", NULL},
      {21, "  collisions: {every: 10}\n# ", NULL},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char all[8192] = "";
    struct scene s = read_with(rows[i].line, rows[i].text);
    int told = scene_warnings(&s, collect, all);
    if (rows[i].says ? !strstr(all, rows[i].says) : told != 0)
      fail_msg("with '%s' the warnings should %s%s, but they are:\n%s", rows[i].text, rows[i].says ? "say " : "be none",
               rows[i].says ? rows[i].says : "", all);
    assert_true((told > 0) == (all[0] != '\0'));
    scene_free(&s);
  }
  struct scene balanced = read_with(17, "    force: [0, 0, 1]"); /* 16 vertices; 20480 particles */
  balanced.model.solvent.thermostat = THERMOSTAT_RESCALE;
  balanced.model.solvent.acceleration.z = -16.0 / 20480.0;
  char all[8192] = "";
  assert_int_equal(scene_warnings(&balanced, collect, all), 1);
  assert_non_null(strstr(all, "contain (v t)^2"));
  balanced.observe.every[OBSERVE_DYNAMICS] = 0;
  assert_int_equal(scene_warnings(&balanced, NULL, NULL), 0);
  scene_free(&balanced);
  /* What is frozen does not drift. */
  struct scene posts =
      read_with(17, "    bending: 10\n  - {name: post, count: 3, vertices: 2, mass: 5, bond_length: 0.5, "
                    "spring: 100, frozen: true}");
  posts.model.solvent.acceleration.z = 0.001;
  all[0] = '\0';
  scene_warnings(&posts, collect, all);
  assert_non_null(strstr(all, "of 'a' contain (v t)^2"));
  posts.model.kind[0].frozen = true;
  all[0] = '\0';
  scene_warnings(&posts, collect, all);
  assert_null(strstr(all, "(v t)^2"));
  scene_free(&posts);
  /* A bath takes momentum and heat, and has no mean free path. */
  struct scene bath = read_with(8, "  collision_interval: 0.2\n  hydrodynamics: false\n  bath: phantoms");
  bath.model.kind[0].force.z = 1.0;
  bath.model.scheme = SCHEME_PAPER;
  bath.observe.every[OBSERVE_DYNAMICS] = 0;
  all[0] = '\0';
  scene_warnings(&bath, collect, all);
  assert_string_equal(all, "");
  scene_free(&bath);
}

/* The number that a warning names ends it: `change` puts it into the scene. */
static void remedies(void **unused)
{
  (void)unused;
  const struct {
    size_t line;
    const char *text, *warns, *number; /* what comes before the number */
    size_t to;
    const char *change;
  } rows[] = {
      {17, "    force: [0.3, 0.1, 1]", "a net force", "solvent.acceleration: ", 9,
       "  acceleration: %s\n  thermostat: rescale"},
      {16, "    spring: 1.5e4", "omega dt =", "with time_step ", 2, "time_step: %s"},
      {16, "    spring: 0.3\n    start: equilibrium", "half the shortest edge", "use edges of ", 1,
       "box: [%s, 99, 99]"},
      {21, "  dynamics: {every: 10, longest_lag: 50}", "longest_lag", "use steps: ", 3, "steps: %s"},
      {13, "    vertices: 33", "its own image", "use edges of ", 1, "box: [%s, %s, %s]"},
      {13, "    vertices: 300\n    ring: true", "its own image", "use edges of ", 1, "box: [%s, %s, %s]"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char all[8192] = "", number[128], line[256], text[4096];
    struct scene s = read_with(rows[i].line, rows[i].text);
    scene_warnings(&s, collect, all);
    scene_free(&s);
    assert_non_null(strstr(all, rows[i].warns));
    const char *at = strstr(all, rows[i].number) + strlen(rows[i].number);
    snprintf(number, sizeof number, "%.*s", (int)(*at == '[' ? strcspn(at, "]") + 1 : strcspn(at, " \n")), at);
    snprintf(line, sizeof line, rows[i].change, number, number, number);
    size_t used = 0;
    for (size_t k = 0; k < GOOD_LINES; k++)
      used += (size_t)snprintf(text + used, sizeof text - used, "%s\n",
                               k + 1 == rows[i].to     ? line
                               : k + 1 == rows[i].line ? rows[i].text
                                                       : good[k]);
    s = read_text(text);
    all[0] = '\0';
    scene_warnings(&s, collect, all);
    if (strstr(all, rows[i].warns))
      fail_msg("with '%s': %s", line, all);
    scene_free(&s);
  }
}

/* Rejected moves heat: at cL^3 = 1000 by a quarter in 300 t0, at 100 by 1e-5 per t0 (DESIGN's prototype). */
static void warning_of_heat(void **unused)
{
  (void)unused;
  struct scene s;
  struct message message;
  assert_true(scene_read("scenes/semidilute.yaml", &s, &message));
  s.steps = 30000;
  assert_int_equal(scene_warnings(&s, NULL, NULL), 0);
  s.model.kind[0].count = 1000;
  s.model.vertices = 64000;
  char all[8192] = "";
  scene_warnings(&s, collect, all);
  double percent = 0.0;
  const char *at = strstr(all, "by some ");
  assert_non_null(at);
  percent = strtod(at + 8, NULL);
  assert_close(percent, 24.0, 6.0);
  s.model.time_step = strtod(strstr(all, "time_step ") + 10, NULL);
  s.steps = (uint64_t)(300.0 / s.model.time_step);
  all[0] = '\0';
  scene_warnings(&s, collect, all);
  assert_null(strstr(all, "by some "));
  /* No time step is short enough for the longest run of many fibers: one is told at once, and a scene may have it. */
  s.steps = INT64_MAX;
  s.model.kind[0].count = 4000000;
  s.model.vertices = 4000000 * 64;
  s.model.time_step = 0.01;
  all[0] = '\0';
  scene_warnings(&s, collect, all);
  assert_true(strtod(strstr(all, "time_step ") + 10, NULL) >= 0.999e-9 * model_collision_interval(&s.model));
  s.model.solvent.thermostat = THERMOSTAT_RESCALE;
  all[0] = '\0';
  assert_int_equal(scene_warnings(&s, collect, all), 1);
  assert_non_null(strstr(all, "vertices load the fluid"));
  scene_free(&s);
}

/* Shipped scenes that are dense on purpose: their vertices make the fluid more than a quarter more viscous. */
static bool is_loaded(const char *path)
{
  static const char *const loaded[] = {"scenes/dense.yaml", "scenes/dense-crossable.yaml", "scenes/thick.yaml",
                                       "scenes/bead-fibers.yaml", "scenes/fibers-shear.yaml"};
  for (size_t i = 0; i < sizeof loaded / sizeof *loaded; i++)
    if (strcmp(path, loaded[i]) == 0)
      return true;
  return false;
}

static void shipped_scenes_are_sound(void **unused)
{
  (void)unused;
  for (size_t i = 0; i < sizeof shipped / sizeof *shipped; i++) {
    struct scene s;
    struct message message;
    char all[8192] = "";
    if (!scene_read(shipped[i], &s, &message))
      fail_msg("%s", message.text);
    const int told = scene_warnings(&s, collect, all);
    if (told != is_loaded(shipped[i]) || (told > 0 && !strstr(all, "vertices load the fluid")))
      fail_msg("%s: %s", shipped[i], all);
    scene_free(&s);
  }
}

/* What `uncross check` prints of a scene, to be freed. */
static char *report_of(const struct scene *scene)
{
  const char *program = getenv("UNCROSS"), *folder = getenv("BUILD");
  char path[512], command[1200];
  snprintf(path, sizeof path, "%s/report.yaml", folder ? folder : "build");
  snprintf(command, sizeof command, "%s check %s", program ? program : "build/uncross", path);
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  assert_true(scene_write(scene, file, false));
  fclose(file);
  char *text = calloc(1, 1 << 16);
  FILE *said = popen(command, "r");
  assert_non_null(said);
  assert_true(fread(text, 1, (1 << 16) - 1, said) > 0);
  assert_int_equal(pclose(said), 0);
  remove(path);
  return text;
}

/* The numbers of Tables I and II for the paper's own system, and what it skips. */
static void report(void **unused)
{
  (void)unused;
  static const char *const says[] = {
      "used    ... rotation by 90 degrees", "skipped ... rotation by any angle", "skipped thermostat",
      "used    search for crossings",       "used    observable: dynamics",      "steps per second",
      "none: within the paper's limits",
  };
  const struct {
    const char *symbol;
    double value;
  } numbers[] = {
      {"N_s", 163840},   {"eta", 11.1838},   {"nu", 2.23676},    {"Sc", 81.5238},        {"D_0", 0.010662},
      {"<l>", 0.538462}, {"omega", 26.6682}, {"p", 64},          {"c L^3", 100},         {"l_p*", 1},
      {"xi", 5.54256},   {"xi*", 0.173205},  {"L_perp", 1.7476}, {"2L_perp^2", 6.10819}, {"L_d", 5.79201},
  };
  struct scene s;
  struct message message;
  assert_true(scene_read("scenes/semidilute.yaml", &s, &message));
  char *text = report_of(&s);
  for (size_t i = 0; i < sizeof says / sizeof *says; i++)
    if (!strstr(text, says[i]))
      fail_msg("the report does not say '%s'", says[i]);
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
    char symbol[32];
    snprintf(symbol, sizeof symbol, " %-9s ", numbers[i].symbol);
    const char *at = strstr(text, symbol);
    if (!at)
      fail_msg("the report does not give %s", numbers[i].symbol);
    assert_close(strtod(at + strlen(symbol), NULL), numbers[i].value, 1e-5 * numbers[i].value);
  }
  free(text);
  scene_free(&s);

  s = read_text("box: [4, 4, 4]\ntime_step: 0.01\nsteps: 1\n"
                "fibers: [{name: a, count: 1, vertices: 4, mass: 5, bond_length: 0, spring: 30}]\n");
  text = report_of(&s);
  assert_non_null(strstr(text, "skipped streaming of the solvent"));
  assert_non_null(strstr(text, "used    springs"));
  assert_non_null(strstr(text, "skipped ... with a square root per bond"));
  assert_non_null(strstr(text, "skipped bends"));
  assert_null(strstr(text, "nan"));
  assert_null(strstr(text, "inf"));
  free(text);
  scene_free(&s);

  s = read_with(9, "  hydrodynamics: false\n  bath: phantoms");
  assert_true(s.model.solvent.particles == 0 && model_has_phantoms(&s.model));
  text = report_of(&s);
  assert_non_null(strstr(text, "skipped streaming of the solvent"));
  assert_non_null(strstr(text, "used    ... with phantoms for a solvent"));
  assert_non_null(strstr(text, "skipped permuted velocities"));
  assert_non_null(strstr(text, "vertex diffusion, without HI"));
  assert_null(strstr(text, "viscosity"));
  assert_null(strstr(text, "hydrodynamic radius"));
  free(text);
  scene_free(&s);
}

/* --- scenes/rings.yaml -------------------------------------------------------------------------------------------- */

/* Gauss's linking number of two rings, by its double integral over pieces of bonds:
 * (1/4 pi) sum (r1 - r2).(dr1 x dr2)/|r1 - r2|^3. */
static double linking_number(const struct test_run *r, uint32_t a, uint32_t b)
{
  enum { PIECES = 8 };
  const struct model *m = &r->model;
  double sum = 0.0;
  for (uint32_t i = m->fiber_first[a]; i < m->fiber_first[a + 1]; i++)
    for (uint32_t j = m->fiber_first[b]; j < m->fiber_first[b + 1]; j++) {
      struct vec3 p = point_in_a0(r->state.position[i]), q = point_in_a0(r->state.position[j]);
      struct vec3 u = vec3_sub(point_in_a0(r->state.position[m->next[i]]), p);
      struct vec3 v = vec3_sub(point_in_a0(r->state.position[m->next[j]]), q);
      for (int k = 0; k < PIECES * PIECES; k++) {
        struct vec3 d = vec3_sub(vec3_add_scaled(p, (k / PIECES + 0.5) / PIECES, u),
                                 vec3_add_scaled(q, (k % PIECES + 0.5) / PIECES, v));
        sum += vec3_dot(d, vec3_cross(u, v)) / pow(vec3_norm(d), 3.0) / (PIECES * PIECES);
      }
    }
  return sum / (4.0 * acos(-1.0));
}

static void rings_are_linked(void **unused)
{
  (void)unused;
  struct scene s;
  struct message message;
  assert_true(scene_read("scenes/rings.yaml", &s, &message));
  struct test_run r = {.model = s.model};
  assert_true(state_alloc(&r.state, &r.model) && work_alloc(&r.work, &r.model));
  assert_true(start_state(&r.state, &r.model, &r.work));
  assert_close(fabs(linking_number(&r, 0, 1)), 1.0, 0.01);
  assert_close(linking_number(&r, 2, 3), 0.0, 0.01);
  work_free(&r.work);
  state_free(&r.state);
  scene_free(&s);
}

/* --- documentation ------------------------------------------------------------------------------------------------ */

static char *whole_file(const char *path)
{
  FILE *f = fopen(path, "rb");
  if (!f)
    fail_msg("%s cannot be opened; tests run in the root of the tree", path);
  char *text = calloc(1, 1 << 20);
  assert_true(fread(text, 1, (1 << 20) - 1, f) > 0);
  fclose(f);
  return text;
}

/* The example in docs/scene.md is a scene. */
static void documented_example_is_read(void **unused)
{
  (void)unused;
  char *text = whole_file("docs/scene.md");
  char *begin = strstr(text, "```yaml\n") + 8, *end = strstr(begin, "```");
  *end = '\0';
  struct scene s = read_text(begin);
  assert_int_equal(s.model.vertices, 6400);
  scene_free(&s);
  free(text);
}

static void near_words(void **unused)
{
  (void)unused;
  static const char *const words[] = {"every", "time_step", "steps", "seed", NULL};
  assert_string_equal(nearest_word("evrey", words), "every");
  assert_string_equal(nearest_word("timestep", words), "time_step");
  assert_string_equal(nearest_word("tim", words), "time_step");
  assert_string_equal(nearest_word("step", words), "steps");
  assert_null(nearest_word("gamma", words));
  assert_null(nearest_word("", words));
  assert_null(nearest_word("a-word-that-is-much-too-long-to-be-any-of-these-keys", words));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bad_input_is_refused),
      cmocka_unit_test(bad_beads_are_refused),
      cmocka_unit_test(whole_files_are_refused),
      cmocka_unit_test(truncated_files),
      cmocka_unit_test(values_arrive),
      cmocka_unit_test(numbers_are_exact),
      cmocka_unit_test(rotation_angles),
      cmocka_unit_test(defaults),
      cmocka_unit_test(places),
      cmocka_unit_test(snapshot_path),
      cmocka_unit_test(stability_limit),
      cmocka_unit_test(effective_scene_reads_back),
      cmocka_unit_test(beads_need_no_bonds),
      cmocka_unit_test(fingerprints),
      cmocka_unit_test(fingerprints_stay),
      cmocka_unit_test(settings_are_as_the_file),
      cmocka_unit_test(bad_settings_are_refused),
      cmocka_unit_test(settings_make_a_scene),
      cmocka_unit_test(empty_sections),
      cmocka_unit_test(many_kinds),
      cmocka_unit_test(warnings),
      cmocka_unit_test(remedies),
      cmocka_unit_test(warning_of_heat),
      cmocka_unit_test(shipped_scenes_are_sound),
      cmocka_unit_test(report),
      cmocka_unit_test(rings_are_linked),
      cmocka_unit_test(documented_example_is_read),
      cmocka_unit_test(near_words),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The keys of a scene besides those of its model (system/model_keys.c): the one place where each is declared. */
#include "scene/scene_keys.h"

#include "system/key_rows.h"
#include "system/model_keys.h"

#define IN_SCENE(member) AT(struct scene, member)

static const char *const stream_words[] = {"own", "seed", NULL};
static const struct key start_keys[] = {
    {"snapshot", FILE_NAME, IN_SCENE(snapshot), FIRST_FORMAT,
     TEXT("A checkpoint, or an H5MD file with velocities; relative to the folder of the scene file. Replaces the "
          "`start` of every kind; box and numbers of particles and vertices must agree, and its center of mass must "
          "move with `flow`.")},
    {"stream", CHOICE(stream_words), IN_SCENE(stream), ABSENT("own"),
     TEXT("Which random numbers follow. `own`: those of a stream that is made of the seed and the snapshot, so that "
          "two runs never share their noise. `seed`: those of the seed, which every other run with this seed has at "
          "the same steps.")},
};
static const struct key_table start_table = {"start", NULL, ROWS(start_keys)};

/* Of most observables; where the cadence goes is the section's own. Dynamics has one key more. */
static const struct key every_keys[] = {
    {"every", WHOLE64(1, INT64_MAX), UNIT("steps"), TEXT("Steps between samples.")},
};
static const struct key dynamics_keys[] = {
    {"every", WHOLE64(1, INT64_MAX), IN_SCENE(observe.every[OBSERVE_DYNAMICS]), UNIT("steps"),
     TEXT("Steps between samples.")},
    {"longest_lag", WHOLE64(0, INT64_MAX), IN_SCENE(observe.longest_lag), UNIT("steps"), SYMBOL("t"), ABSENT("0"),
     TEXT("Longest lag; 0: as long as the run allows. Otherwise at least `every`. Above a quarter of `steps` a "
          "warning.")},
};
static const struct key profile_keys[] = {
    {"every", WHOLE64(1, INT64_MAX), IN_SCENE(observe.every[OBSERVE_PROFILE]), UNIT("steps"),
     TEXT("Steps between samples.")},
    {"slabs", WHOLE64(1, 8192), IN_SCENE(observe.slabs), TEXT("Slabs of equal thickness, from y = 0 to y = L.")},
};
static const struct key_table conserved_table = {"observe.conserved", NULL, ROWS(every_keys)};
static const struct key_table temperature_table = {"observe.temperature", NULL, ROWS(every_keys)};
static const struct key_table statics_table = {"observe.statics", NULL, ROWS(every_keys)};
static const struct key_table dynamics_table = {"observe.dynamics", NULL, ROWS(dynamics_keys)};
static const struct key_table collisions_table = {"observe.collisions", NULL, ROWS(every_keys)};
static const struct key_table profile_table = {"observe.profile", NULL, ROWS(profile_keys)};
static const struct key_table stress_table = {"observe.stress", NULL, ROWS(every_keys)};
static const struct key_table shape_table = {"observe.dumbbells", NULL, ROWS(every_keys)};
static const struct key_table orientation_table = {"observe.orientation", NULL, ROWS(every_keys)};
static const struct key_table memory_table = {"observe.memory", NULL, ROWS(every_keys)};
static const struct key_table bead_observe_table = {"observe.bead", NULL, ROWS(every_keys)};
static const struct key_table pressure_table = {"observe.pressure", NULL, ROWS(every_keys)};
static const struct key_table wake_table = {"observe.wake", NULL, ROWS(every_keys)};
static const struct key_table topology_table = {"observe.topology", NULL, ROWS(every_keys)};

static const struct key observe_keys[] = {
    {"from", WHOLE64(0, INT64_MAX), IN_SCENE(observe.from), UNIT("steps"), OPTIONAL, ASIDE,
     TEXT("Step at which averages (`statics`, `dynamics`, `profile`, `dumbbells`, `orientation`, `memory`, `wake`) "
          "and crossings (`topology`) begin, so that they leave a transient out. Time series begin at step 0 all the "
          "same. At most `steps`. If "
          "absent: 0.")},
    {"from_time", NUMBER(0, 1e18), IN_SCENE(observe_from_time), UNIT("t0"), EXCLUDES("from"), OPTIONAL, ASIDE, DERIVES,
     TEXT("The same as a time: sets `from` to the first step that is not before it.")},
    {"conserved", SECTION(conserved_table), IN_SCENE(observe.every[OBSERVE_CONSERVED]), OPTIONAL, ONE_LINE,
     TEXT("Time series of energies and momentum.")},
    {"temperature", SECTION(temperature_table), IN_SCENE(observe.every[OBSERVE_TEMPERATURE]), OPTIONAL, ONE_LINE,
     TEXT("Time series of solvent and vertex temperature.")},
    {"statics", SECTION(statics_table), IN_SCENE(observe.every[OBSERVE_STATICS]), OPTIONAL, ONE_LINE,
     TEXT("Averages of bonds, bends, end-to-end distance.")},
    {"dynamics", SECTION(dynamics_table), OPTIONAL, ONE_LINE,
     TEXT("Functions of the lag: g(t), g_cm(t), d^2(t), end-to-end correlation, diffusion coefficient.")},
    {"collisions", SECTION(collisions_table), IN_SCENE(observe.every[OBSERVE_COLLISIONS]), OPTIONAL, ONE_LINE,
     TEXT("Time series of crossings possible, executed, negative.")},
    {"profile", SECTION(profile_table), OPTIONAL, ONE_LINE,
     TEXT("Averages in slabs along y: density, velocity, temperature of the solvent.")},
    {"stress", SECTION(stress_table), IN_SCENE(observe.every[OBSERVE_STRESS]), OPTIONAL, ONE_LINE,
     TEXT("Time series of the stress: of the solvent in the bulk, of fibers, and on walls.")},
    {"dumbbells", SECTION(shape_table), IN_SCENE(observe.every[OBSERVE_DUMBBELLS]), OPTIONAL, ONE_LINE,
     TEXT("Averages of the second moments of the vectors of dumbbells: their extension and angle.")},
    {"orientation", SECTION(orientation_table), IN_SCENE(observe.every[OBSERVE_ORIENTATION]), OPTIONAL, ONE_LINE,
     TEXT("Averages of the second moments of fibers' end-to-end vectors and of the directions of their bonds.")},
    {"memory", SECTION(memory_table), IN_SCENE(observe.every[OBSERVE_MEMORY]), OPTIONAL, ONE_LINE,
     TEXT("Functions of the lag: memory of velocities and of the stress of fibers.")},
    {"bead", SECTION(bead_observe_table), IN_SCENE(observe.every[OBSERVE_BEAD]), OPTIONAL, ONE_LINE,
     TEXT("Time series of the bead: place, velocity, force of its drive, middle of its trap, work, heat, hits.")},
    {"pressure", SECTION(pressure_table), IN_SCENE(observe.every[OBSERVE_PRESSURE]), OPTIONAL, ONE_LINE,
     TEXT("Time series of the pressure tensor, of the potential energy and of the configurational temperature.")},
    {"wake", SECTION(wake_table), IN_SCENE(observe.every[OBSERVE_WAKE]), OPTIONAL, ONE_LINE,
     TEXT("Averages around the bead: density of vertices, and how they are displaced from sample to sample.")},
    {"topology", SECTION(topology_table), IN_SCENE(observe.every[OBSERVE_TOPOLOGY]), OPTIONAL, ONE_LINE,
     TEXT("Crossings of bonds from sample to sample; with `every: 1`, whether this run let bonds through.")},
};
static const struct key_table observe_table = {"observe", NULL, ROWS(observe_keys)};

static const struct key trajectory_keys[] = {
    {"every", WHOLE64(1, INT64_MAX), IN_SCENE(trajectory_every), UNIT("steps"), TEXT("Steps between frames.")},
    {"solvent", SWITCH, IN_SCENE(trajectory_solvent), ABSENT("false"),
     TEXT("Frames hold the solvent too (6.5 MB each at 164 thousand particles with velocities).")},
    {"velocities", SWITCH, IN_SCENE(trajectory_velocities), ABSENT("true"), TEXT("Frames hold velocities.")},
};
static const struct key_table trajectory_table = {"trajectory", NULL, ROWS(trajectory_keys)};

static const struct key checkpoint_keys[] = {
    {"seconds", NUMBER(0, 1e9), IN_SCENE(checkpoint_seconds), UNIT("s"), ABSENT("300"),
     TEXT("Wall time between checkpoints, the first of them after 10 s at most; 0: none but at step 0, on signals and "
          "at the end.")},
};
static const struct key_table checkpoint_table = {"checkpoint", NULL, ROWS(checkpoint_keys)};

static const struct key top_keys[] = {
    {NULL, INCLUDE(model_keys), IN_SCENE(model)},
    {"steps", WHOLE64(0, INT64_MAX), IN_SCENE(steps), ASIDE,
     TEXT("Steps in all; `--steps` says otherwise. A finished run can be extended.")},
    {"start", SECTION(start_table), OPTIONAL, TEXT("A start from a file.")},
    {"observe", SECTION(observe_table), OPTIONAL, ASIDE,
     TEXT("Observables on the fly; what is not asked for costs nothing.")},
    {"trajectory", SECTION(trajectory_table), OPTIONAL, ASIDE, ONE_LINE,
     TEXT("Frames in `trajectory.h5`; absent: none.")},
    {"checkpoint", SECTION(checkpoint_table), OPTIONAL, ASIDE, TEXT("How often `checkpoint.h5` is written.")},
};
const struct key_table scene_keys = {"", "Keys of the file itself.", ROWS(top_keys)};

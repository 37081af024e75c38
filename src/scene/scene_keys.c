/* The keys of a scene besides those of its model (system/model_keys.c): the one place where each is declared. */
#include "scene/scene_keys.h"

#include "system/model_keys.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define IN_SCENE(member) offsetof(struct scene, member)

static const char *const stream_words[] = {"own", "seed", NULL};
static const struct key start_keys[] = {
    {.name = "snapshot",
     .text = "A checkpoint, or an H5MD file with velocities; relative to the folder of the scene file. Replaces the "
             "`start` of every kind; box and numbers of particles and vertices must agree, and its center of mass must "
             "move with `flow`.",
     .type = KEY_TEXT,
     .offset = IN_SCENE(snapshot),
     .first_format = true},
    {.name = "stream",
     .text =
         "Which random numbers follow. `own`: those of a stream that is made of the seed and the snapshot, so that two "
         "runs never share their noise. `seed`: those of the seed, which every other run with this seed has at the "
         "same steps.",
     .type = KEY_CHOICE,
     .absent = "own",
     .choice = stream_words,
     .offset = IN_SCENE(stream)},
};
static const struct key_table start_table = {"start", NULL, COUNT(start_keys), start_keys};

/* Of most observables; where the cadence goes is the section's own. Dynamics has one key more. */
static const struct key every_keys[] = {
    {.name = "every",
     .text = "Steps between samples.",
     .type = KEY_WHOLE64,
     .least = 1,
     .most = INT64_MAX,
     .unit = "steps"},
};
static const struct key dynamics_keys[] = {
    {.name = "every",
     .text = "Steps between samples.",
     .type = KEY_WHOLE64,
     .least = 1,
     .most = INT64_MAX,
     .offset = IN_SCENE(observe.every[OBSERVE_DYNAMICS]),
     .unit = "steps"},
    {.name = "longest_lag",
     .text =
         "Longest lag; 0: as long as the run allows. Otherwise at least `every`. Above a quarter of `steps` a warning.",
     .type = KEY_WHOLE64,
     .absent = "0",
     .most = INT64_MAX,
     .offset = IN_SCENE(observe.longest_lag),
     .unit = "steps",
     .symbol = "t"},
};
static const struct key profile_keys[] = {
    {.name = "every",
     .text = "Steps between samples.",
     .type = KEY_WHOLE64,
     .least = 1,
     .most = INT64_MAX,
     .offset = IN_SCENE(observe.every[OBSERVE_PROFILE]),
     .unit = "steps"},
    {.name = "slabs",
     .text = "Slabs of equal thickness, from y = 0 to y = L.",
     .type = KEY_WHOLE64,
     .least = 1,
     .most = 8192,
     .offset = IN_SCENE(observe.slabs)},
};
static const struct key_table conserved_table = {"observe.conserved", NULL, COUNT(every_keys), every_keys};
static const struct key_table temperature_table = {"observe.temperature", NULL, COUNT(every_keys), every_keys};
static const struct key_table statics_table = {"observe.statics", NULL, COUNT(every_keys), every_keys};
static const struct key_table dynamics_table = {"observe.dynamics", NULL, COUNT(dynamics_keys), dynamics_keys};
static const struct key_table collisions_table = {"observe.collisions", NULL, COUNT(every_keys), every_keys};

static const struct key_table profile_table = {"observe.profile", NULL, COUNT(profile_keys), profile_keys};
static const struct key_table stress_table = {"observe.stress", NULL, COUNT(every_keys), every_keys};

static const struct key_table shape_table = {"observe.dumbbells", NULL, COUNT(every_keys), every_keys};

static const struct key_table orientation_table = {"observe.orientation", NULL, COUNT(every_keys), every_keys};

static const struct key_table memory_table = {"observe.memory", NULL, COUNT(every_keys), every_keys};

static const struct key_table bead_observe_table = {"observe.bead", NULL, COUNT(every_keys), every_keys};
static const struct key_table pressure_table = {"observe.pressure", NULL, COUNT(every_keys), every_keys};
static const struct key_table wake_table = {"observe.wake", NULL, COUNT(every_keys), every_keys};

static const struct key observe_keys[] = {
    {.name = "from",
     .text = "Step at which averages (`statics`, `dynamics`, `profile`, `dumbbells`, `orientation`, `memory`, `wake`) "
             "begin, "
             "so that they "
             "leave a transient out. "
             "Time series "
             "begin at step 0 all the same. At most `steps`. If absent: 0.",
     .type = KEY_WHOLE64,
     .optional = true,
     .most = INT64_MAX,
     .offset = IN_SCENE(observe.from),
     .unit = "steps",
     .aside = true},
    {.name = "from_time",
     .text = "The same as a time: sets `from` to the first step that is not before it.",
     .type = KEY_NUMBER,
     .optional = true,
     .low = 0,
     .high = 1e18,
     .offset = IN_SCENE(observe_from_time),
     .unit = "t0",
     .excludes = "from",
     .derives = true,
     .aside = true},
    {.name = "conserved",
     .text = "Time series of energies and momentum.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &conserved_table,
     .offset = IN_SCENE(observe.every[OBSERVE_CONSERVED]),
     .line = true},
    {.name = "temperature",
     .text = "Time series of solvent and vertex temperature.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &temperature_table,
     .offset = IN_SCENE(observe.every[OBSERVE_TEMPERATURE]),
     .line = true},
    {.name = "statics",
     .text = "Averages of bonds, bends, end-to-end distance.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &statics_table,
     .offset = IN_SCENE(observe.every[OBSERVE_STATICS]),
     .line = true},
    {.name = "dynamics",
     .text = "Functions of the lag: g(t), g_cm(t), d^2(t), end-to-end correlation, diffusion coefficient.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &dynamics_table,
     .line = true},
    {.name = "collisions",
     .text = "Time series of crossings possible, executed, negative.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &collisions_table,
     .offset = IN_SCENE(observe.every[OBSERVE_COLLISIONS]),
     .line = true},
    {.name = "profile",
     .text = "Averages in slabs along y: density, velocity, temperature of the solvent.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &profile_table,
     .line = true},
    {.name = "stress",
     .text = "Time series of the stress: of the solvent in the bulk, of fibers, and on walls.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &stress_table,
     .offset = IN_SCENE(observe.every[OBSERVE_STRESS]),
     .line = true},
    {.name = "dumbbells",
     .text = "Averages of the second moments of the vectors of dumbbells: their extension and angle.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &shape_table,
     .offset = IN_SCENE(observe.every[OBSERVE_DUMBBELLS]),
     .line = true},
    {.name = "orientation",
     .text = "Averages of the second moments of fibers' end-to-end vectors and of the directions of their bonds.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &orientation_table,
     .offset = IN_SCENE(observe.every[OBSERVE_ORIENTATION]),
     .line = true},
    {.name = "memory",
     .text = "Functions of the lag: memory of velocities and of the stress of fibers.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &memory_table,
     .offset = IN_SCENE(observe.every[OBSERVE_MEMORY]),
     .line = true},
    {.name = "bead",
     .text = "Time series of the bead: place, velocity, force of its drive, middle of its trap, work, heat, hits.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &bead_observe_table,
     .offset = IN_SCENE(observe.every[OBSERVE_BEAD]),
     .line = true},
    {.name = "pressure",
     .text = "Time series of the pressure tensor, of the potential energy and of the configurational temperature.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &pressure_table,
     .offset = IN_SCENE(observe.every[OBSERVE_PRESSURE]),
     .line = true},
    {.name = "wake",
     .text = "Averages around the bead: density of vertices, and how they are displaced from sample to sample.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &wake_table,
     .offset = IN_SCENE(observe.every[OBSERVE_WAKE]),
     .line = true},
};
static const struct key_table observe_table = {"observe", NULL, COUNT(observe_keys), observe_keys};

static const struct key trajectory_keys[] = {
    {.name = "every",
     .text = "Steps between frames.",
     .type = KEY_WHOLE64,
     .least = 1,
     .most = INT64_MAX,
     .offset = IN_SCENE(trajectory_every),
     .unit = "steps"},
    {.name = "solvent",
     .text = "Frames hold the solvent too (6.5 MB each at 164 thousand particles with velocities).",
     .type = KEY_SWITCH,
     .absent = "false",
     .offset = IN_SCENE(trajectory_solvent)},
    {.name = "velocities",
     .text = "Frames hold velocities.",
     .type = KEY_SWITCH,
     .absent = "true",
     .offset = IN_SCENE(trajectory_velocities)},
};
static const struct key_table trajectory_table = {"trajectory", NULL, COUNT(trajectory_keys), trajectory_keys};

static const struct key checkpoint_keys[] = {
    {.name = "seconds",
     .text = "Wall time between checkpoints, the first of them after 10 s at most; 0: none but at step 0, on signals "
             "and at the end.",
     .type = KEY_NUMBER,
     .absent = "300",
     .low = 0,
     .high = 1e9,
     .offset = IN_SCENE(checkpoint_seconds),
     .unit = "s"},
};
static const struct key_table checkpoint_table = {"checkpoint", NULL, COUNT(checkpoint_keys), checkpoint_keys};

static const struct key top_keys[] = {
    {.type = KEY_INCLUDE, .keys = &model_keys, .offset = IN_SCENE(model)},
    {.name = "steps",
     .text = "Steps in all; `--steps` says otherwise. A finished run can be extended.",
     .type = KEY_WHOLE64,
     .most = INT64_MAX,
     .offset = IN_SCENE(steps),
     .aside = true},
    {.name = "start", .text = "A start from a file.", .type = KEY_SECTION, .optional = true, .keys = &start_table},
    {.name = "observe",
     .text = "Observables on the fly; what is not asked for costs nothing.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &observe_table,
     .aside = true},
    {.name = "trajectory",
     .text = "Frames in `trajectory.h5`; absent: none.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &trajectory_table,
     .aside = true,
     .line = true},
    {.name = "checkpoint",
     .text = "How often `checkpoint.h5` is written.",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &checkpoint_table,
     .aside = true},
};
const struct key_table scene_keys = {"", "Keys of the file itself.", COUNT(top_keys), top_keys};

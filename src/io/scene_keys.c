#include "io/scene_keys.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define IN_SCENE(member) offsetof(struct draft, scene.member)
#define IN_KIND(member) offsetof(struct draft_kind, member)

const char *const scene_order_words[] = {"paper", "kick-split", "drift-split", NULL};
const char *const scene_thermostat_words[] = {"none", "rescale", "maxwell-boltzmann", NULL};
const char *const scene_bath_words[] = {"particles", "phantoms", NULL};
const char *const scene_exclusion_words[] = {"shared-vertex", "paper", NULL};
const char *const scene_refusal_words[] = {"stay", "bounce", NULL};
const char *const scene_frame_words[] = {"laboratory", "flow", NULL};
const char *const scene_start_words[] = {"equilibrium", "straight", "circle", NULL};

static const struct key solvent_keys[] = {
    {.name = "per_cell",
     .type = KEY_NUMBER,
     .low = 0,
     .above = true,
     .high = 10000,
     .offset = IN_SCENE(model.solvent.per_cell),
     .unit = "1/a0^3",
     .symbol = "gamma"},
    {.name = "collision_interval",
     .type = KEY_NUMBER,
     .low = 0,
     .above = true,
     .high = 10,
     .offset = offsetof(struct draft, collision_interval),
     .unit = "t0",
     .symbol = "dt_c"},
    {.name = "rotation_angle",
     .type = KEY_NUMBER,
     .fallback = "90",
     .low = 0,
     .above = true,
     .high = 180,
     .offset = IN_SCENE(model.solvent.rotation_angle),
     .unit = "degrees",
     .symbol = "alpha"},
    {.name = "thermostat",
     .type = KEY_CHOICE,
     .fallback = "none",
     .choice = scene_thermostat_words,
     .offset = IN_SCENE(model.solvent.thermostat)},
    {.name = "hydrodynamics",
     .type = KEY_SWITCH,
     .fallback = "true",
     .offset = IN_SCENE(model.solvent.hydrodynamics),
     .symbol = "HI"},
    {.name = "bath",
     .type = KEY_CHOICE,
     .fallback = "particles",
     .choice = scene_bath_words,
     .offset = IN_SCENE(model.solvent.bath)},
    {.name = "acceleration",
     .type = KEY_VECTOR,
     .fallback = "[0, 0, 0]",
     .low = -100,
     .high = 100,
     .offset = IN_SCENE(model.solvent.acceleration),
     .unit = "a0/t0^2",
     .symbol = "f/m"},
};
static const struct key_table solvent_table = {"solvent", COUNT(solvent_keys), solvent_keys};

static const struct key place_keys[] = {
    {.name = "center",
     .type = KEY_VECTOR,
     .low = -LATTICE_MAX_EDGE,
     .high = LATTICE_MAX_EDGE,
     .offset = offsetof(struct draft_place, center),
     .unit = "a0"},
    {.name = "direction",
     .type = KEY_VECTOR,
     .low = -1000,
     .high = 1000,
     .offset = offsetof(struct draft_place, direction)},
};
static const struct key_table place_table = {"fibers.places", COUNT(place_keys), place_keys};

static const struct key fiber_keys[] = {
    {.name = "name", .type = KEY_NAME, .offset = IN_KIND(kind.name)},
    {.name = "count",
     .type = KEY_WHOLE32,
     .least = 1,
     .most = INT32_MAX,
     .offset = IN_KIND(kind.count),
     .symbol = "N_c"},
    {.name = "vertices",
     .type = KEY_WHOLE32,
     .least = 1,
     .most = INT32_MAX,
     .offset = IN_KIND(kind.vertices),
     .symbol = "N_v"},
    {.name = "ring", .type = KEY_SWITCH, .fallback = "false", .offset = IN_KIND(kind.ring)},
    {.name = "mass",
     .type = KEY_NUMBER,
     .low = 0,
     .above = true,
     .high = 65536,
     .offset = IN_KIND(kind.mass),
     .unit = "m",
     .symbol = "M"},
    {.name = "bond_length",
     .type = KEY_NUMBER,
     .low = 0,
     .high = 512,
     .offset = IN_KIND(kind.bond_length),
     .unit = "a0",
     .symbol = "l0"},
    {.name = "spring",
     .type = KEY_NUMBER,
     .low = 0,
     .above = true,
     .high = 1e9,
     .offset = IN_KIND(kind.spring),
     .unit = "kT/a0^2",
     .symbol = "K/l0"},
    {.name = "bending",
     .type = KEY_NUMBER,
     .fallback = "0",
     .low = 0,
     .high = SCENE_MOST_BENDING,
     .offset = IN_KIND(kind.bending),
     .unit = "kT",
     .symbol = "kT l_p/l0"},
    {.name = "persistence_length",
     .type = KEY_NUMBER,
     .optional = true,
     .low = 0,
     .high = 1e9,
     .offset = IN_KIND(persistence_length),
     .unit = "a0",
     .symbol = "l_p"},
    {.name = "force",
     .type = KEY_VECTOR,
     .fallback = "[0, 0, 0]",
     .low = -1e6,
     .high = 1e6,
     .offset = IN_KIND(kind.force),
     .unit = "kT/a0",
     .symbol = "F"},
    {.name = "start", .type = KEY_CHOICE, .optional = true, .choice = scene_start_words, .offset = IN_KIND(kind.start)},
    {.name = "places",
     .type = KEY_LIST,
     .optional = true,
     .keys = &place_table,
     .item_size = sizeof(struct draft_place),
     .offset = IN_KIND(places)},
};
static const struct key_table fiber_table = {"fibers", COUNT(fiber_keys), fiber_keys};

static const struct key crossing_keys[] = {
    {.name = "forbidden", .type = KEY_SWITCH, .fallback = "true", .offset = IN_SCENE(model.crossing.forbidden)},
    {.name = "exclusion",
     .type = KEY_CHOICE,
     .fallback = "shared-vertex",
     .choice = scene_exclusion_words,
     .offset = IN_SCENE(model.crossing.exclusion)},
    {.name = "refusal",
     .type = KEY_CHOICE,
     .fallback = "stay",
     .choice = scene_refusal_words,
     .offset = IN_SCENE(model.crossing.refusal)},
    {.name = "frame",
     .type = KEY_CHOICE,
     .fallback = "laboratory",
     .choice = scene_frame_words,
     .offset = IN_SCENE(model.crossing.frame)},
};
static const struct key_table crossing_table = {"crossing", COUNT(crossing_keys), crossing_keys};

static const struct key start_keys[] = {
    {.name = "snapshot", .type = KEY_TEXT, .offset = IN_SCENE(snapshot)},
};
static const struct key_table start_table = {"start", COUNT(start_keys), start_keys};

/* Of most observables; where the cadence goes is the section's own. Dynamics has one key more. */
static const struct key every_keys[] = {
    {.name = "every", .type = KEY_WHOLE64, .least = 1, .most = INT64_MAX, .unit = "steps"},
};
static const struct key dynamics_keys[] = {
    {.name = "every",
     .type = KEY_WHOLE64,
     .least = 1,
     .most = INT64_MAX,
     .offset = IN_SCENE(observe.every[OBSERVE_DYNAMICS]),
     .unit = "steps"},
    {.name = "longest_lag",
     .type = KEY_WHOLE64,
     .fallback = "0",
     .most = INT64_MAX,
     .offset = IN_SCENE(observe.longest_lag),
     .unit = "steps",
     .symbol = "t"},
};
static const struct key_table conserved_table = {"observe.conserved", COUNT(every_keys), every_keys};
static const struct key_table temperature_table = {"observe.temperature", COUNT(every_keys), every_keys};
static const struct key_table statics_table = {"observe.statics", COUNT(every_keys), every_keys};
static const struct key_table dynamics_table = {"observe.dynamics", COUNT(dynamics_keys), dynamics_keys};
static const struct key_table collisions_table = {"observe.collisions", COUNT(every_keys), every_keys};

static const struct key observe_keys[] = {
    {.name = "conserved",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &conserved_table,
     .offset = IN_SCENE(observe.every[OBSERVE_CONSERVED])},
    {.name = "temperature",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &temperature_table,
     .offset = IN_SCENE(observe.every[OBSERVE_TEMPERATURE])},
    {.name = "statics",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &statics_table,
     .offset = IN_SCENE(observe.every[OBSERVE_STATICS])},
    {.name = "dynamics", .type = KEY_SECTION, .optional = true, .keys = &dynamics_table},
    {.name = "collisions",
     .type = KEY_SECTION,
     .optional = true,
     .keys = &collisions_table,
     .offset = IN_SCENE(observe.every[OBSERVE_COLLISIONS])},
};
static const struct key_table observe_table = {"observe", COUNT(observe_keys), observe_keys};

static const struct key trajectory_keys[] = {
    {.name = "every",
     .type = KEY_WHOLE64,
     .least = 1,
     .most = INT64_MAX,
     .offset = IN_SCENE(trajectory_every),
     .unit = "steps"},
    {.name = "solvent", .type = KEY_SWITCH, .fallback = "false", .offset = IN_SCENE(trajectory_solvent)},
    {.name = "velocities", .type = KEY_SWITCH, .fallback = "true", .offset = IN_SCENE(trajectory_velocities)},
};
static const struct key_table trajectory_table = {"trajectory", COUNT(trajectory_keys), trajectory_keys};

static const struct key checkpoint_keys[] = {
    {.name = "seconds",
     .type = KEY_NUMBER,
     .fallback = "300",
     .low = 0,
     .high = 1e9,
     .offset = IN_SCENE(checkpoint_seconds),
     .unit = "s"},
};
static const struct key_table checkpoint_table = {"checkpoint", COUNT(checkpoint_keys), checkpoint_keys};

static const struct key top_keys[] = {
    {.name = "box",
     .type = KEY_CELLS,
     .least = 1,
     .most = LATTICE_MAX_EDGE,
     .offset = IN_SCENE(model.box.cells),
     .unit = "a0",
     .symbol = "L_b"},
    {.name = "time_step",
     .type = KEY_NUMBER,
     .low = 0,
     .above = true,
     .high = 1,
     .offset = IN_SCENE(model.time_step),
     .unit = "t0",
     .symbol = "dt"},
    {.name = "steps", .type = KEY_WHOLE64, .most = INT64_MAX, .offset = IN_SCENE(steps)},
    {.name = "seed", .type = KEY_WHOLE64, .fallback = "1", .most = UINT64_MAX, .offset = IN_SCENE(model.seed)},
    {.name = "order",
     .type = KEY_CHOICE,
     .fallback = "kick-split",
     .choice = scene_order_words,
     .offset = IN_SCENE(model.order)},
    {.name = "flow",
     .type = KEY_VECTOR,
     .fallback = "[0, 0, 0]",
     .low = -SCENE_MOST_FLOW,
     .high = SCENE_MOST_FLOW,
     .offset = IN_SCENE(model.flow),
     .unit = "a0/t0",
     .symbol = "v_flow"},
    {.name = "solvent", .type = KEY_SECTION, .optional = true, .keys = &solvent_table},
    {.name = "fibers",
     .type = KEY_LIST,
     .optional = true,
     .keys = &fiber_table,
     .item_size = sizeof(struct draft_kind),
     .offset = offsetof(struct draft, fibers)},
    {.name = "crossing", .type = KEY_SECTION, .optional = true, .keys = &crossing_table},
    {.name = "start", .type = KEY_SECTION, .optional = true, .keys = &start_table},
    {.name = "observe", .type = KEY_SECTION, .optional = true, .keys = &observe_table},
    {.name = "trajectory", .type = KEY_SECTION, .optional = true, .keys = &trajectory_table},
    {.name = "checkpoint", .type = KEY_SECTION, .optional = true, .keys = &checkpoint_table},
};
const struct key_table scene_top_table = {"", COUNT(top_keys), top_keys};

const struct key_table *const *scene_key_tables(size_t *count)
{
  static const struct key_table *const tables[] = {
      &scene_top_table, &solvent_table,    &fiber_table,      &place_table,       &crossing_table,
      &start_table,     &observe_table,    &conserved_table,  &temperature_table, &statics_table,
      &dynamics_table,  &collisions_table, &trajectory_table, &checkpoint_table,
  };
  *count = COUNT(tables);
  return tables;
}

/*
 * model: what never changes during a run. It is built from a scene file (scene_read) or by hand. system/model_keys.c
 * lists each given value with its range. model_finish checks the given values and derives the rest.
 *
 * Units: a0 (cell edge) = kT = m (solvent particle) = 1, time in t0 = a0 sqrt(m/kT) (Padding 2009, Table I).
 */
#ifndef UNCROSS_SYSTEM_MODEL_H
#define UNCROSS_SYSTEM_MODEL_H

#include "system/keys.h"
#include "system/model_parts.h"

struct model {
  uint32_t dimensions; /* 3; 2: everything moves in the plane of x and y */
  struct box box;      /* cells are given; edges are derived */
  uint64_t seed;       /* key of every random number: the run's stream (system/stream.h) */
  double time_step;    /* dt, in t0 */
  enum scheme scheme;
  struct vec3 flow; /* uniform flow given to everything at the start, in a0/t0 */
  struct solvent_model solvent;
  struct medium_model medium;
  struct dumbbell_model dumbbells;
  struct bead_model bead;
  struct wall_model walls;
  struct shear_model shear;
  struct crossing_model crossing;

  uint32_t kinds;
  struct fiber_kind *kind; /* [kinds], allocated */

  /* Derived by model_finish. Vertices are numbered fiber by fiber, fibers kind by kind; bond j joins j and next[j]. */
  uint32_t fibers, vertices, bonds;
  int64_t thickness;       /* the largest diameter of all kinds, lattice units; 0: all fibers are thin */
  uint32_t held;           /* of the vertices */
  uint32_t *fiber_first;   /* [fibers + 1]: first vertex of each fiber */
  uint32_t *fiber_kind_of; /* [fibers] */
  uint32_t *fiber_of;      /* [vertices] */
  int32_t *next, *prev;    /* [vertices]: bonded neighbors along the fiber, -1 at an open end */
  double *mass;            /* [vertices] M */
  double *inverse_mass;    /* [vertices] 1/M; 0 if held (model_is_held). What needs M takes mass */
  double max_mass;         /* of any member of a collision cell */
  double total_mass;       /* of solvent and vertices, without a bead */
  struct wave wave;        /* of the walls' or the shear's motion */
};

/* Checks the given values, each against its row of model_keys and all of them together, and fills the derived part. On
 * failure, or if memory is short, returns false with the reason in *error; the model must then be freed. A model is
 * finished only once. */
bool model_finish(struct model *model, struct model_error *error);

/* The same without the lists of fibers and vertices, which stay NULL: for callers that estimate. The time and the
 * memory that it takes do not depend on how many fibers there are. */
bool model_finish_numbers(struct model *model, struct model_error *error);

/* Frees the derived part, the kinds and their places. */
void model_free(struct model *model);

/* True for a vertex that nothing moves: no force, no contact, no rigid cluster. */
static inline bool model_is_held(const struct model *model, uint32_t vertex)
{
  return model->inverse_mass[vertex] == 0.0;
}

/* True for a bond between two such vertices. */
static inline bool model_bond_stands(const struct model *model, uint32_t bond)
{
  return model_is_held(model, bond) && model_is_held(model, (uint32_t)model->next[bond]);
}

/* The bonds that end at a vertex: none, one or two. Returns their number. */
static inline int model_bonds_of(const struct model *model, uint32_t vertex, uint32_t bond[2])
{
  int bonds = 0;
  if (model->prev[vertex] >= 0)
    bond[bonds++] = (uint32_t)model->prev[vertex];
  if (model->next[vertex] >= 0)
    bond[bonds++] = vertex;
  return bonds;
}

/* a0: bonds must be shorter. In a plane there are no images along z. */
static inline double model_longest_bond(const struct model *model)
{
  const int *edge = model->box.cells;
  if (model->dimensions == 2)
    return 0.5 * (edge[0] < edge[1] ? edge[0] : edge[1]);
  return 0.5 * box_shortest_edge(&model->box);
}

/* The bonds that end at these vertices, each once. bond: room for 2 n. Returns their number. */
uint32_t model_bonds_at(const struct model *model, uint32_t n, const uint32_t *vertex, uint32_t *bond);

/* The distance of the axes of two bonds at which they touch, lattice units; 0: both are thin lines. */
static inline int64_t model_reach(const struct model *model, uint32_t bond, uint32_t other)
{
  if (model->thickness == 0)
    return 0;
  return model->kind[model->fiber_kind_of[model->fiber_of[bond]]].radius +
         model->kind[model->fiber_kind_of[model->fiber_of[other]]].radius;
}

/* True if two bonds have a vertex in common, or are the same. */
static inline bool model_share_vertex(const struct model *model, uint32_t bond, uint32_t other)
{
  return bond == other || model->next[bond] == (int32_t)other || model->next[other] == (int32_t)bond;
}

/* True if a bond of a thick fiber does not see another one of it, since they are near along the contour. */
bool model_tube_is_blind(const struct model *model, uint32_t bond, uint32_t other);

/* a0: the largest diameter of a fiber. */
static inline double model_thickness(const struct model *model)
{
  return (double)model->thickness * LATTICE_UNIT;
}

static inline bool model_has_solvent(const struct model *model)
{
  return model->solvent.particles > 0;
}

/* a0/t0: the velocity of the frame in which moves are made. */
static inline struct vec3 model_frame_velocity(const struct model *model)
{
  return model->crossing.frame == FRAME_FLOW ? model->flow : (struct vec3){0, 0, 0};
}

/* True if everything is in the plane z = 0, where nothing moves along z. */
static inline bool model_is_flat(const struct model *model)
{
  return model->dimensions == 2;
}

/* The collision rule draws velocities anew: it is a thermostat by itself (thermal, in mpc/rule.h). */
static inline bool model_rule_is_thermal(const struct model *model)
{
  return model->solvent.rule == RULE_AT_A || model->solvent.rule == RULE_AT_PLUS_A;
}

/* Collisions happen in cells, if there are any. */
static inline bool model_in_cells(const struct model *model)
{
  return model->medium.kind == MEDIUM_CELLS;
}

/* Members of the medium exert forces on each other. */
static inline bool model_repels(const struct model *model)
{
  return model->medium.repulsion != 0.0 || model->medium.many.repulsion != 0.0 || model->medium.second.share != 0.0;
}

/* Vertices have places and no velocities. */
static inline bool model_is_overdamped(const struct model *model)
{
  return model->medium.kind == MEDIUM_OVERDAMPED;
}

/* Something holds kT = 1: the rule, a thermostat, or a bath. */
static inline bool model_is_isothermal(const struct model *model)
{
  return model_rule_is_thermal(model) || model->solvent.thermostat != THERMOSTAT_NONE || !model_in_cells(model) ||
         model->solvent.bath == BATH_PHANTOMS;
}

/* True if the box has walls at y = 0 and y = L. */
static inline bool model_has_walls(const struct model *model)
{
  return model->box.boundary[1] == BOUNDARY_WALL;
}

/* True if the box is sheared. */
static inline bool model_is_sheared(const struct model *model)
{
  return model->box.boundary[1] == BOUNDARY_SHEAR;
}

static inline bool model_has_dumbbells(const struct model *model)
{
  return model->dumbbells.pairs > 0;
}

static inline bool model_has_bead(const struct model *model)
{
  return model->bead.radius > 0.0;
}

/* True if a bond may meet something: another one, or a bead. */
static inline bool model_bonds_meet(const struct model *model)
{
  return model->bonds > 1 || (model->bonds > 0 && model_has_bead(model));
}

static inline bool model_has_phantoms(const struct model *model)
{
  return model->solvent.bath == BATH_PHANTOMS;
}

/* m/a0^3: of the solvent's particles, or of phantoms. */
static inline double model_solvent_density(const struct model *model)
{
  return model_in_cells(model) ? model->solvent.per_cell : model->medium.density;
}

/* False if a bath takes up the momentum of vertices. */
static inline bool model_keeps_momentum(const struct model *model)
{
  return !model_has_phantoms(model) && (model_in_cells(model) || model->medium.kind == MEDIUM_PAIRS);
}

/* True if the model has solvent, phantoms or another bath; without them there are no collisions. */
static inline bool model_collides(const struct model *model)
{
  return model_has_solvent(model) || model_has_phantoms(model) || !model_in_cells(model);
}

/* True if these collisions are those of cells. */
static inline bool model_has_cells(const struct model *model)
{
  return model_in_cells(model) && model_collides(model);
}

static inline double model_collision_interval(const struct model *model)
{
  return model->time_step * model->solvent.interval_steps;
}

#endif

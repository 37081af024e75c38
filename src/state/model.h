/*
 * model: what never changes during a run. Built from a scene (io/scene.c) or by hand in tests.
 *
 * Units: a0 (cell edge) = kT = m (solvent particle) = 1, time in t0 = a0 sqrt(m/kT) (Padding 2009, Table I).
 */
#ifndef UNCROSS_MODEL_H
#define UNCROSS_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "base/lattice.h"

#define MODEL_NAME_SIZE 64

/* Where drift, collision and kick stand within a step: see step.c. */
enum order { ORDER_PAPER, ORDER_KICK_SPLIT, ORDER_DRIFT_SPLIT };

enum thermostat { THERMOSTAT_NONE, THERMOSTAT_RESCALE, THERMOSTAT_MAXWELL_BOLTZMANN };

/* What vertices collide with. */
enum bath {
  BATH_PARTICLES, /* the solvent's particles */
  BATH_PHANTOMS   /* velocities drawn anew at each collision: a heat bath, see solvent/bath.h */
};

/* Which bonds a moving bond is not tested against. */
enum exclusion {
  EXCLUSION_SHARED_VERTEX, /* those that share a vertex with it */
  EXCLUSION_PAPER          /* those linked to either of the two moving bonds (Padding 2009, Sec. III A, literally) */
};

/* What a vertex does whose move would cross a bond, after the exchange of momentum. */
enum refusal {
  REFUSAL_STAY,  /* it stays where it is (Padding 2009, Sec. III A) */
  REFUSAL_BOUNCE /* it goes on with its new velocity for what was left of the time, if that crosses nothing */
};

/* Where a refused move leaves its vertex: moves are made in a frame. */
enum frame {
  FRAME_LABORATORY, /* refused vertices stand, and so lag behind a flow (Padding 2009) */
  FRAME_FLOW        /* they go with the scene's flow */
};

/* How the fibers of a kind are laid at the start. */
enum fiber_start {
  START_EQUILIBRIUM, /* exact sample of the phantom chain, open fibers only */
  START_STRAIGHT,    /* evenly spaced by the mean bond length along a line, open fibers only */
  START_CIRCLE       /* evenly spaced on a circle, rings only */
};

/* Fibers of one kind: alike in all but place. */
struct fiber_kind {
  char name[MODEL_NAME_SIZE];
  uint32_t count;     /* fibers of this kind */
  uint32_t vertices;  /* N_v, per fiber */
  bool ring;          /* the last vertex is bonded to the first */
  double mass;        /* M, in m: a multiple of MODEL_MASS_UNIT */
  double bond_length; /* l0, in a0 */
  double spring;      /* k = K/l0, in kT/a0^2: Eq. (1) */
  double bending;     /* kappa = l_p/l0: Eq. (2); 0: no bend forces */
  struct vec3 force;  /* constant force on each vertex, in kT/a0 */
  enum fiber_start start;
  uint32_t placed;        /* fibers whose place is given below; the rest is placed at random */
  struct vec3 *center;    /* [placed] a0: middle of the straight fiber or of the circle */
  struct vec3 *direction; /* [placed] along the straight fiber, or normal to the circle; any length but 0 */
};

#define MODEL_MASS_UNIT 0x1p-16 /* masses are multiples of this, so that a cell's mass is summed exactly */

struct solvent_model {
  uint32_t particles;      /* N_s = gamma x cells; 0: none */
  double per_cell;         /* gamma */
  uint32_t interval_steps; /* dt_c / dt: a collision every so many steps */
  double rotation_angle;   /* alpha, in degrees */
  double cosine, sine;     /* of alpha; exactly 0 and 1 at 90 degrees */
  enum thermostat thermostat;
  enum bath bath;
  bool hydrodynamics;       /* false: particles' velocities are permuted after each collision */
  struct vec3 acceleration; /* constant body force per mass, in a0/t0^2 */
};

struct crossing_model {
  bool forbidden; /* false: crossable fibers */
  enum exclusion exclusion;
  enum refusal refusal;
  enum frame frame;
};

struct model {
  struct box box;
  uint64_t seed;    /* key of every random number */
  double time_step; /* dt, in t0 */
  enum order order;
  struct vec3 flow; /* uniform flow given to everything at the start, in a0/t0 */
  struct solvent_model solvent;
  struct crossing_model crossing;

  uint32_t kinds;
  struct fiber_kind *kind; /* [kinds] */

  /* Derived by model_finish. Vertices are numbered fiber by fiber, fibers kind by kind; bond j joins j and next[j]. */
  uint32_t fibers, vertices, bonds;
  uint32_t *fiber_first;   /* [fibers + 1]: first vertex of each fiber */
  uint32_t *fiber_kind_of; /* [fibers] */
  uint32_t *fiber_of;      /* [vertices] */
  int32_t *next, *prev;    /* [vertices]: bonded neighbors along the fiber, -1 at an open end */
  double *mass;            /* [vertices] M */
  double *inverse_mass;    /* [vertices] 1/M */
  double max_mass;         /* of any member of a collision cell */
  double total_mass;       /* of solvent and vertices */
};

/* Fills the derived part from box, solvent and kinds. Returns false if memory is short or vertices are too many. */
bool model_finish(struct model *model);

/* Frees the derived part, the kinds and their places. */
void model_free(struct model *model);

/* The one or two bonds that end at a vertex of a fiber, or none; how many. */
static inline int model_bonds_of(const struct model *model, uint32_t vertex, uint32_t bond[2])
{
  int bonds = 0;
  if (model->prev[vertex] >= 0)
    bond[bonds++] = (uint32_t)model->prev[vertex];
  if (model->next[vertex] >= 0)
    bond[bonds++] = vertex;
  return bonds;
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

static inline bool model_has_phantoms(const struct model *model)
{
  return model->solvent.bath == BATH_PHANTOMS;
}

/* Without either there are no collisions. */
static inline bool model_collides(const struct model *model)
{
  return model_has_solvent(model) || model_has_phantoms(model);
}

static inline double model_collision_interval(const struct model *model)
{
  return model->time_step * model->solvent.interval_steps;
}

#endif

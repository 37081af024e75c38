/* The parts of a model (system/model.h): words of its keys, and what is given and derived of solvent, medium, fibers,
 * dumbbells, bead, walls and shear. Units a0 = kT = m = 1. */
#ifndef UNCROSS_SYSTEM_MODEL_PARTS_H
#define UNCROSS_SYSTEM_MODEL_PARTS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/lattice.h"

#define MODEL_NAME_SIZE 64

/* The last name of an enum counts the others: tests/contract runs over all of them. */

/* Where drift, collision and kick stand within a step: see step.c. */
enum scheme { SCHEME_PAPER, SCHEME_KICK_SPLIT, SCHEME_DRIFT_SPLIT, SCHEMES };

enum thermostat_kind {
  THERMOSTAT_NONE,
  THERMOSTAT_RESCALE,
  THERMOSTAT_MAXWELL_BOLTZMANN,
  THERMOSTAT_RESCALE_LAYERS,
  THERMOSTATS
};

/* What happens in a collision cell: see mpc/rule.h. */
enum rule { RULE_SRD, RULE_AT_A, RULE_AT_PLUS_A, RULES };

/* What vertices collide with. */
enum bath {
  BATH_PARTICLES, /* the solvent's particles */
  BATH_PHANTOMS,  /* velocities drawn anew at each collision: a heat bath, see mpc/random_solvent.h */
  BATHS
};

/* With whom a bath mixes velocities: the rows of medium/medium.c. */
enum medium_kind {
  MEDIUM_CELLS,      /* with the members of a collision cell: the solvent's keys */
  MEDIUM_PRIVATE,    /* each vertex with a bath of its own: Langevin, Andersen */
  MEDIUM_PAIRS,      /* two members that are near each other: Lowe-Andersen, Peters, Shardlow */
  MEDIUM_OVERDAMPED, /* none: vertices have no velocities, fiber/overdamped.h */
  MEDIA
};

/* How a bath draws a velocity anew: the rows of medium/bath.c. */
enum medium_draw { DRAW_REPLACE, DRAW_RELAX, DRAW_CAYLEY, MEDIUM_DRAWS };

/* How the rate of a pair depends on its distance: the rows of medium/bath.c. */
enum medium_weight { WEIGHT_HAT, WEIGHT_QUADRATIC, MEDIUM_WEIGHTS };

/* How spheres of a fiber feel each other's flow in overdamped motion: the rows of fiber/mobility.c. */
enum medium_tensor { TENSOR_NONE, TENSOR_OSEEN, TENSOR_RPY, MEDIUM_TENSORS };

/* How the particles of two groups are laid at the start. */
enum medium_layout { LAYOUT_MIXED, LAYOUT_SLAB, MEDIUM_LAYOUTS };

/* Where the body force acts on the solvent, and how much of it: along y, in a box of edge L. */
enum force_profile {
  PROFILE_UNIFORM, /* everywhere the same */
  PROFILE_SINE,    /* sin(2 pi y/L) of it: Kolmogorov flow */
  PROFILE_REVERSE, /* all of it in the lower half, minus that in the upper: two Poiseuille flows */
  PROFILES
};

enum wall { WALL_LOWER, WALL_UPPER, WALLS };

/* What a wall does to a particle that hits it: its velocity relative to the wall is reversed, or only its component
 * normal to the wall. */
enum wall_kind { WALL_ABSENT, WALL_NO_SLIP, WALL_SLIP, WALL_KINDS };

/* The number of virtual particles in a cell that a wall cuts: mpc/border.h. */
enum wall_fill {
  FILL_PLANAR, /* Poisson, as many on average as solvent would be in the part beyond the wall */
  FILL_PAPER,  /* as many as the cell has fewer than gamma (Tao, Goetze and Gompper 2008) */
  FILL_NONE,
  FILLS
};

/* Which bonds a moving bond is not tested against. */
enum exclusion {
  EXCLUSION_SHARED_VERTEX, /* those that share a vertex with it */
  EXCLUSION_PAPER          /* those linked to either of the two moving bonds (Padding 2009, Sec. III A, literally) */
};

/* What happens where bonds would cross: the rows of contact/rule.c. */
enum crossing_kind {
  CROSSING_FREE,         /* nothing: bonds pass through each other */
  CROSSING_SEQUENTIAL,   /* one vertex at a time (Padding 2009, Sec. III A) */
  CROSSING_EVENT_DRIVEN, /* all vertices at once, contacts at their own time */
  CROSSINGS
};

/* What a vertex does after its move was rejected and momentum was exchanged. */
enum rejection {
  REJECTION_STAY,   /* it stays where it is (Padding 2009, Sec. III A) */
  REJECTION_BOUNCE, /* it moves with its new velocity for the rest of the time, if that crosses nothing */
  REJECTIONS
};

/* The frame in which moves are made. A vertex whose move is rejected is at rest in this frame. */
enum frame {
  FRAME_LABORATORY, /* rejected vertices stand still, and so lag behind a flow (Padding 2009) */
  FRAME_FLOW,       /* rejected vertices go with the scene's flow */
  FRAMES
};

/* What a chain that stands for a finer one has in common with it. */
enum fiber_size {
  SIZE_ENDS,     /* the end-to-end distance */
  SIZE_GYRATION, /* the radius of gyration */
  FIBER_SIZES
};

/* How the fibers of a kind are laid at the start. */
enum fiber_start {
  START_BY_SHAPE,    /* not said: circle for rings, equilibrium for open fibers; model_finish writes which */
  START_EQUILIBRIUM, /* exact sample of the phantom chain, open fibers only */
  START_STRAIGHT,    /* evenly spaced by the mean bond length along a line, open fibers only */
  START_CIRCLE       /* evenly spaced on a circle, rings only */
};

/* Which vertices of a fiber are held while the others move. */
enum held {
  HELD_NONE,
  HELD_FIRST, /* its first vertex */
  HELD_ENDS,  /* its first and its last */
  HELDS
};

/* The place of one fiber. */
struct fiber_place {
  struct vec3 center;    /* a0: middle of the straight fiber or of the circle */
  struct vec3 direction; /* along the straight fiber, or normal to the circle; any length but 0 */
};

/* Fibers of one kind differ only in place. model_finish replaces mass, bending and start by their effective values. */
struct fiber_kind {
  char name[MODEL_NAME_SIZE]; /* different from those of other kinds */
  uint32_t count;             /* fibers of this kind */
  uint32_t vertices;          /* N_v, per fiber */
  bool ring;                  /* the last vertex is bonded to the first */
  bool frozen;                /* all vertices are held: contact/held.h */
  enum held held;             /* or some of them */
  double mass;                /* M, in m; effective: rounded to a multiple of MODEL_MASS_UNIT */
  double bond_length;         /* l0, in a0 */
  double spring;              /* k = K/l0, in kT/a0^2: Eq. (1); given of the finer chain if there is one */
  uint32_t stands_for;        /* vertices of the finer Gaussian chain; 0: it is itself */
  enum fiber_size keeps;
  double bending;            /* kappa: Eq. (2); 0: no bend forces, or given by persistence_length */
  double persistence_length; /* l_p, in a0: sets bending to l_p/l0; 0: not given */
  double diameter;           /* D, in a0: of the tube around each bond; 0: a thin line */
  struct vec3 force;         /* constant force on each vertex, in kT/a0 */
  enum fiber_start start;
  uint32_t dimensions;       /* derived by model_finish: those of the model; 0 is 3 */
  int64_t radius;            /* derived: D/2, lattice units */
  uint32_t blind;            /* derived: a tube does not see bonds of its fiber that are less than so many bonds away */
  uint32_t placed;           /* number of fibers whose place is given; the others are placed at random */
  struct fiber_place *place; /* [placed], allocated */
};

#define MODEL_MASS_UNIT 0x1p-16 /* masses are multiples of this, so that a cell's mass is summed exactly */

#define MODEL_MOST_BENDING 1e9 /* kT, given or derived */
#define MODEL_MOST_FLOW 100.0  /* a0/t0, each component */
#define MODEL_MOST_KINDS 4096

struct solvent_model {
  double per_cell;           /* gamma; 0: no solvent */
  double collision_interval; /* dt_c, in t0; effective: interval_steps time steps */
  double rotation_angle;     /* alpha, in degrees */
  enum rule rule;
  enum thermostat_kind thermostat;
  enum bath bath;
  bool hydrodynamics;         /* false: particles' velocities are permuted after each collision */
  struct vec3 acceleration;   /* constant body force per mass, in a0/t0^2 */
  enum force_profile profile; /* of the acceleration */

  /* Derived by model_finish. */
  uint32_t particles;      /* N_s = gamma x cells; 0: none, or phantoms */
  uint32_t interval_steps; /* dt_c / dt: a collision every so many steps; 0 without a collision_interval */
  double cosine, sine;     /* of alpha; exact at 90 and 180 degrees */
};

/* A bath other than that of collision cells. It acts once in each time step. */
struct medium_model {
  enum medium_kind kind;
  double rate; /* 1/t0: at which a velocity, or the relative one of a pair at weight 1, is forgotten */
  enum medium_draw draw;
  enum medium_weight weight; /* of pairs */
  double density;            /* of pairs: particles of mass 1 per a0^3 */

  /* Of overdamped motion. */
  enum medium_tensor tensor;
  double radius;     /* a0: of a vertex; 0 without a tensor */
  bool inextensible; /* bonds keep their length by tension, and there is no noise */

  /* Forces of pairs, medium/repulsion.h. */
  double repulsion; /* kT/a0: of all pairs, at r = 0; 0: none */
  struct {
    double share;     /* of the particles that are of the second group; 0: there is none */
    double repulsion; /* kT/a0: between the groups */
    enum medium_layout start;
    uint32_t first; /* derived: number of its first particle */
  } second;
  struct {
    double repulsion; /* kT/a0 per density: B; 0: none */
    double range;     /* r_d, a0 */
  } many;
};

struct crossing_model {
  bool forbidden;          /* false: crossable fibers */
  enum crossing_kind rule; /* where they are not crossable */
  enum exclusion exclusion;
  enum rejection rejection;
  enum frame frame;
};

/* Dumbbells in the solvent: pairs of its particles with a harmonic spring (Tao, Goetze and Gompper, J. Chem. Phys. 128,
 * 144902 (2008)). */
struct dumbbell_model {
  double spring;   /* K, kT/a0^2; 0: none */
  double fraction; /* of the solvent's particles that are in dumbbells */

  /* Between walls, the potential of the center of a dumbbell at the distance Y from one: -depth (1 - Y/reach) below
   * the reach, else 0. */
  double depth; /* kT; 0: no potential */
  double range; /* reach in units of sqrt(kT/K) */

  /* Derived by model_finish. */
  uint32_t pairs;
  double frequency; /* sqrt(2 K/m), 1/t0 */
};

/* What pulls a bead: force - spring (x - trap), where the trap is at center + velocity t + amplitude sin(2 pi
 * t/period).
 */
struct bead_drive {
  struct vec3 force;     /* constant, kT/a0 */
  double spring;         /* k, kT/a0^2; 0: no trap */
  struct vec3 velocity;  /* of the trap, a0/t0 */
  struct vec3 amplitude; /* of the trap's oscillation, a0 */
  double period;         /* of it, t0; 0: none */
};

/* A sphere in the solvent: system/bead.h. */
struct bead_model {
  double radius;      /* R, a0; 0: none */
  double mass;        /* M, m; effective: that of the solvent it displaces, if 0 was given */
  struct vec3 center; /* at the start, a0 */
  struct bead_drive drive;
  struct vec3 carried; /* derived: what pushes it with the solvent, kT/a0 (system/bead.h) */
  bool driven;         /* derived: there is a force or a spring */
};

/* Walls at y = 0 and y = L. */
struct wall_model {
  enum wall_kind kind;       /* WALL_ABSENT: none */
  enum wall_fill fill;       /* of cells that a no-slip wall cuts */
  struct vec3 lower, upper;  /* velocities, a0/t0, without y component; with a period, their amplitudes */
  double shear_rate, strain; /* sets both: opposite velocities; 0: not given */
  double period;             /* t0; 0: the velocities are constant */
};

/* A shear of the box: its image beyond y = L moves along x at rate L faster. */
struct shear_model {
  double rate;   /* dv_x/dy, 1/t0; with a period, its amplitude */
  double strain; /* amplitude of the strain: sets rate to 2 pi strain/period; 0: not given */
  double period; /* t0; 0: the rate is constant */
  uint64_t slid; /* lattice units, below the edge: of the image beyond y = L along x at step 0; shear_begin */
};

/* The part of a velocity or rate that holds at each half collision interval of a period: system/shear.h. */
struct wave {
  uint32_t intervals; /* collision intervals per period; 0: constant */
  double *cosine;     /* [2 intervals] cos(pi k/intervals), allocated; NULL if constant */
  uint64_t *slid;     /* [intervals + 1] lattice units by which a sheared image slides in a half step, summed over the
                       * intervals before each; allocated; NULL if constant */
};

#endif

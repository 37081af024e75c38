/*
 * Random numbers with addresses, not drawn in sequence: Philox 4x32-10 (base/philox.h) of
 *
 *   counter = { entity, purpose + 256 draw, step (low 32 bits), step (high 32 bits) },   key = seed (low, high)
 *
 * The address alone determines the number, in any order of calls, on any machine. docs/conventions.md lists the
 * addresses.
 */
#ifndef UNCROSS_BASE_RANDOM_H
#define UNCROSS_BASE_RANDOM_H

#include <stddef.h>
#include <stdint.h>

#include "base/philox.h"
#include "base/vec3.h"

enum random_purpose {
  RANDOM_GRID_SHIFT = 1,        /* entity 0: words 0, 1, 2 shift x, y, z */
  RANDOM_ROTATION_AXIS = 2,     /* entity = cell */
  RANDOM_VERTEX_ORDER = 3,      /* permutation; draw = 0 or 1: the drift within the step */
  RANDOM_VELOCITY_SWAP = 4,     /* permutation of the solvent's velocities */
  RANDOM_THERMOSTAT = 5,        /* entity = cell; draw = attempt */
  RANDOM_PHANTOM_NUMBER = 6,    /* entity = cell; draw = part/2 */
  RANDOM_PHANTOM_VELOCITY = 7,  /* entity = cell; draw = 0 or 1 */
  RANDOM_ANDERSEN_PARTICLE = 8, /* entity = particle id */
  RANDOM_ANDERSEN_VERTEX = 9,   /* entity = vertex */
  RANDOM_ANDERSEN_PHANTOM = 10, /* entity = cell */
  RANDOM_BATH_VERTEX = 11,      /* entity = vertex; draw 0: normals; 1: word 0 chooses */
  RANDOM_BATH_PAIR = 12,        /* entity = smaller number of the pair; draw = larger: word 0 chooses, 1 orders */
  RANDOM_SPIN_VELOCITY = 13,    /* entity = cell; draw = k, the cell's virtual particle */
  RANDOM_SPIN_PLACE = 14,       /* entity = cell; draw = 2 k and 2 k + 1 of the same */
  RANDOM_PLANE_TURN = 15,       /* entity = cell: rotation in a plane */
  RANDOM_SOLVENT_POSITION = 16, /* entity = particle id; draw = 2 attempt: x, y; + 1: z; step 0 from here to 25 */
  RANDOM_SOLVENT_VELOCITY = 17, /* entity = particle id */
  RANDOM_VERTEX_VELOCITY = 18,  /* entity = vertex */
  RANDOM_FIBER_POSITION = 19,   /* entity = fiber */
  RANDOM_FIBER_DIRECTION = 20,  /* entity = fiber; draw = attempt */
  RANDOM_BOND_LENGTH = 21,      /* entity = bond (its first vertex); draw = attempt */
  RANDOM_BEND = 22,             /* entity = vertex */
  RANDOM_BEND_AZIMUTH = 23,     /* entity = vertex; draw = attempt */
  RANDOM_DUMBBELL_CENTER = 24,  /* entity = dumbbell; draw = 2 attempt: x, y; + 1: z, and a uniform number */
  RANDOM_DUMBBELL_VECTOR = 25,  /* the same: components along x, y; z */
  RANDOM_BEAD_PLACE = 26,       /* entity = cell; draw = k, the cell's virtual particle: words 0, 1, 2 */
  RANDOM_BEAD_REST = 27         /* entity 0; step 0: the bead's velocity; else that of its uncut part */
};

struct random_words {
  uint32_t w[4];
};

static inline struct random_words random_at(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step,
                                            uint32_t entity)
{
  struct random_words r = {{entity, (uint32_t)purpose + 256 * draw, (uint32_t)step, (uint32_t)(step >> 32)}};
  philox((uint32_t)seed, (uint32_t)(seed >> 32), r.w);
  return r;
}

#define RANDOM_UNIFORMS 64 /* entities that the functions with columns of fixed length take */

/* The words of n entities, a column for each word: [4][n]. The same as random_at, in a form that vectorises. */
void random_columns(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, const uint32_t *entity,
                    uint32_t n, uint32_t *restrict column[4]);

/* The words of n pairs, n <= RANDOM_UNIFORMS, each word in the low half of 64 bits; what is in the high half does not
 * matter. The same as random_at; each pair has its own draw, below RANDOM_DRAWS. */
#define RANDOM_DRAWS (1u << 24)
void random_wide_pair_columns(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity,
                              const uint32_t *draw, uint32_t n, uint64_t word[4][RANDOM_UNIFORMS]);

/* Uniform deviates 0 and 1 of draw 0, then those of draw 1, of n entities, n <= RANDOM_UNIFORMS: the same as
 * random_uniform of random_at, in a form that vectorises. Both draws at once: of twenty rounds three are shared. */
void random_uniform_columns(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity,
                            uint32_t n, double u[4][RANDOM_UNIFORMS]);

/* Words 2k and 2k+1 (low, high) as one 64-bit integer; k = 0 or 1. */
static inline uint64_t random_u64(struct random_words r, int k)
{
  return (uint64_t)r.w[2 * k] | (uint64_t)r.w[2 * k + 1] << 32;
}

/* Uniform in the open interval (0,1): odd multiples of 2^-53; k = 0 or 1. */
static inline double random_uniform(struct random_words r, int k)
{
  return ((double)(random_u64(r, k) >> 12) + 0.5) * 0x1p-52;
}

/* Words 2k, 2k+1 as a point (u,v) in the square (-1,1)^2, then as a unit vector n uniform on the sphere (Marsaglia,
 * Ann. Math. Stat. 43, 645 (1972)): needs only a square root. Returns 0 where the point is outside the unit disk
 * (probability 1 - pi/4) and another must be taken. */
static inline int random_axis_from_words(struct random_words r, int k, struct vec3 *n)
{
  double u = ((double)(int32_t)r.w[2 * k] + 0.5) * 0x1p-31;
  double v = ((double)(int32_t)r.w[2 * k + 1] + 0.5) * 0x1p-31;
  double s = u * u + v * v;
  if (s >= 1.0)
    return 0;
  double root = sqrt(1.0 - s);
  *n = (struct vec3){2.0 * u * root, 2.0 * v * root, 1.0 - 2.0 * s};
  return 1;
}

/* Uniform unit vector at an address: words 0, 1 of the first draw, else words 2, 3, else the same of the next one. */
static inline struct vec3 random_axis_from(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step,
                                           uint32_t entity)
{
  struct vec3 n;
  for (;; draw++) {
    struct random_words r = random_at(seed, purpose, draw, step, entity);
    if (random_axis_from_words(r, 0, &n) || random_axis_from_words(r, 1, &n))
      return n;
  }
}

/* The same from draw 0 on. */
static inline struct vec3 random_axis(uint64_t seed, enum random_purpose purpose, uint64_t step, uint32_t entity)
{
  return random_axis_from(seed, purpose, 0, step, entity);
}

/* The unit vectors of n entities, n <= RANDOM_AXES. The same as random_axis, in a form that vectorises. */
#define RANDOM_AXES 64
void random_axes(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity, uint32_t n,
                 struct vec3 *axis);

/* Shuffles n entries uniformly (Fisher and Yates; Durstenfeld 1964): for k = n-1 down to 1, entries k and
 * j = floor((k+1) R_k / 2^64) are exchanged, R_k = 64-bit integer (k mod 2) of entity k/2. Its bias, below n/2^64, is
 * not observable. */
void random_shuffle(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, uint32_t n,
                    uint32_t *entry);

/* A uniform random permutation: 0 .. n-1, shuffled. */
void random_permutation(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, uint32_t n,
                        uint32_t *order);

#endif

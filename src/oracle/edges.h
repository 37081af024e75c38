/* The scene of constructed inputs. */
#ifndef UNCROSS_ORACLE_EDGES_H
#define UNCROSS_ORACLE_EDGES_H

#include <stdint.h>

#include "base/vec3.h"
#include "oracle/operators.h"

/* Fibers of two and of three vertices, as many as the states of edges.c need. */
enum { EDGES_PAIRS = 44, EDGES_CHAINS = 10 };

/* Settings of the scene: three unlike edges, odd masses. */
#define EDGES_SETTINGS                                                                                                 \
  {                                                                                                                    \
    "box=[4, 5, 3]", "time_step=0.0078125", "steps=1", "seed=1311768467463790320", "solvent.per_cell=2",               \
        "solvent.collision_interval=0.0078125", "fibers.0.name=pair", "fibers.0.count=44", "fibers.0.vertices=2",      \
        "fibers.0.mass=1.5", "fibers.0.bond_length=0", "fibers.0.spring=30", "fibers.1.name=chain",                    \
        "fibers.1.count=10", "fibers.1.vertices=3", "fibers.1.mass=4", "fibers.1.bond_length=0", "fibers.1.spring=30", \
        "crossing.rule=sequential"                                                                                     \
  }

/* Settings of the scene of contacts at their own time: the same pairs and chains, so that the same states can be built,
 * and needles, chains with bends, and rings. */
enum { EDGES_NEEDLES = 20, EDGES_STIFF = 10, EDGES_RINGS = 4, EDGES_FAR = 8 };
#define EDGES_EVENT_SETTINGS                                                                                           \
  {                                                                                                                    \
    "box=[4, 5, 3]", "time_step=0.0078125", "steps=1", "seed=1311768467463790320", "crossing.rule=event-driven",       \
        "fibers.0.name=pair", "fibers.0.count=44", "fibers.0.vertices=2", "fibers.0.mass=1.5",                         \
        "fibers.0.bond_length=0", "fibers.0.spring=30", "fibers.1.name=chain", "fibers.1.count=10",                    \
        "fibers.1.vertices=3", "fibers.1.mass=4", "fibers.1.bond_length=0", "fibers.1.spring=30",                      \
        "fibers.2.name=needle", "fibers.2.count=20", "fibers.2.vertices=2", "fibers.2.mass=2",                         \
        "fibers.2.bond_length=0.5", "fibers.2.spring=20", "fibers.3.name=stiff", "fibers.3.count=10",                  \
        "fibers.3.vertices=4", "fibers.3.mass=3", "fibers.3.bond_length=0.3", "fibers.3.spring=100",                   \
        "fibers.3.bending=5", "fibers.3.force=[0.5, -2, 1]", "fibers.4.name=ring", "fibers.4.count=4",                 \
        "fibers.4.vertices=4", "fibers.4.ring=true", "fibers.4.mass=7.5", "fibers.4.bond_length=0.3",                  \
        "fibers.4.spring=50", "fibers.4.bending=2", "fibers.5.name=far", "fibers.5.count=8", "fibers.5.vertices=2",    \
        "fibers.5.mass=2", "fibers.5.bond_length=0.5", "fibers.5.spring=20"                                            \
  }

#define EDGES_PART (LATTICE_CELL / 16)

/* A unit vector, along an axis now and then; a place along a bond, an end now and then; a velocity, 0 now and then or
 * if nothing moves. */
struct dice; /* oracle/dice.h */
struct vec3 edges_normal(struct dice *d);
struct vec3 edges_velocity(struct dice *d, bool moves);
double edges_place(struct dice *d);

/* Sets the needles behind all others for a drift of so many t0: two that are long for their box, and two clusters that
 * fly, and join, at `corner`. */
void edges_long_needles(struct oracle_stage *g, uint32_t first, double drift);
void edges_joining_clusters(struct oracle_stage *g, uint32_t first, struct point corner, double drift);

/* Two needles of some lattice units, at `middle`, that are answered in tick 2, where they part already: no impulse
 * separates them. fly: rate of both, lattice units in a tick. */
void edges_tiny_pair(struct oracle_stage *g, uint32_t first, struct point middle, struct vec3 fly, double drift);

/* Sets pairs and chains so that within 32 dt bonds touch at exactly half of the time, several at once, some boxes away;
 * all other vertices are at rest. */
void edges_at_the_same_time(struct oracle_stage *g);

/* Ways to make an index below n of a 64-bit integer r in single precision: from all bits, from the high word, from 24
 * bits, from the uniform of 52 bits. The product may round to n; it is cut to n - 1. way: 0 to EDGES_SINGLE_WAYS - 1.
 */
enum { EDGES_SINGLE_WAYS = 4 };
uint32_t edges_single_index(uint64_t r, uint32_t n, int way);

#endif

/* The scene of constructed inputs. */
#ifndef UNCROSS_ORACLE_EDGES_H
#define UNCROSS_ORACLE_EDGES_H

#include <stdint.h>

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

/* Ways to make an index below n of a 64-bit integer r in single precision: from all bits, from the high word, from 24
 * bits, from the uniform of 52 bits. The product may round to n; it is cut to n - 1. way: 0 to EDGES_SINGLE_WAYS - 1.
 */
enum { EDGES_SINGLE_WAYS = 4 };
uint32_t edges_single_index(uint64_t r, uint32_t n, int way);

#endif

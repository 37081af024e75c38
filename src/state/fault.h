/* Why a run had to stop: found by the physics, said by whoever runs it. */
#ifndef UNCROSS_FAULT_H
#define UNCROSS_FAULT_H

#include <stddef.h>
#include <stdint.h>

enum fault_code {
  FAULT_NONE = 0,
  FAULT_SOLVENT_MOVE,   /* a solvent particle moves further than LATTICE_MAX_MOVE in one flight, or not a number */
  FAULT_SOLVENT_SPEED,  /* a solvent particle is too fast for the fixed-point sums of a cell, or not a number */
  FAULT_VERTEX_SPEED,   /* the same of a vertex */
  FAULT_SOLVENT_ENERGY, /* a solvent particle has too much energy for the fixed-point sum of a cell's thermostat */
  FAULT_VERTEX_ENERGY,  /* the same of a vertex */
  FAULT_CELL_MASS,      /* the members of a cell outweigh the range of its sum */
  FAULT_VERTEX_MOVE,    /* a vertex moves further than half the shortest edge in one step, or not a number */
  FAULT_VERTEX_PLACE,   /* a vertex is further from the origin than LATTICE_REACH, unwrapped */
  FAULT_BOND_TOO_LONG,  /* a bond is longer than half the shortest edge */
  FAULT_NO_MEMORY       /* a list of neighbor bonds could not grow */
};

struct fault {
  enum fault_code code;
  uint64_t step;  /* the step that was being made */
  int64_t entity; /* particle id, vertex, bond (its first vertex) or cell */
  double value;   /* the offending length, momentum or energy */
  double limit;   /* what it may be */
};

/* One sentence that says what went wrong where, and what is allowed. */
void fault_describe(const struct fault *fault, char *text, size_t size);

#endif

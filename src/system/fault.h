/* Why a run had to stop. The physics records a fault; the caller of step_advance reports it. */
#ifndef UNCROSS_SYSTEM_FAULT_H
#define UNCROSS_SYSTEM_FAULT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/message.h"

enum fault_code {
  FAULT_NONE = 0,
  FAULT_SOLVENT_MOVE,   /* a solvent particle moves further than LATTICE_MAX_MOVE in one flight, or not a number */
  FAULT_SOLVENT_SPEED,  /* a solvent particle is too fast for the fixed-point sums of a cell, or not a number */
  FAULT_VERTEX_SPEED,   /* the same of a vertex */
  FAULT_SOLVENT_ENERGY, /* a solvent particle has too much energy for the fixed-point sum of a cell's thermostat */
  FAULT_VERTEX_ENERGY,  /* the same of a vertex */
  FAULT_CELL_MASS,      /* the mass of a cell's members exceeds the range of its sum */
  FAULT_VERTEX_MOVE,    /* a vertex moves further than half the shortest edge in one step, or not a number */
  FAULT_VERTEX_PLACE,   /* a vertex is further from the origin than LATTICE_REACH, unwrapped */
  FAULT_SOLVENT_PLACE,  /* a solvent particle is not in the box (in a file: a run keeps them there) */
  FAULT_VERTEX_WALL,    /* a vertex is beyond a wall (in a file: a run keeps them between) */
  FAULT_DUMBBELL,       /* the vector of a dumbbell is not that between its particles (in a file) */
  FAULT_BEAD_MOVE,      /* a bead, or solvent near it, is so fast that its image may be hit too, or not a number */
  FAULT_BEAD_WALL,      /* the bead is nearer to a wall than its radius (in a file: a run keeps it between) */
  FAULT_IN_BEAD,        /* a solvent particle is in the bead (in a file: a run keeps them outside) */
  FAULT_BOND_TOO_LONG,  /* a bond is longer than half the shortest edge */
  FAULT_OVERLAP,        /* two bonds overlap or touch at the start: one of them, and the distance of their axes */
  FAULT_BEAD_OVERLAP,   /* a bond overlaps with the bead at the start: the distance of its axis from the center */
  FAULT_GIVEN_UP,       /* whoever waits for the start wants it no more: the fiber that was being laid */
  FAULT_NO_ROOM,        /* a thick fiber overlaps with others wherever it is laid: its number, and the attempts */
  FAULT_MOBILITY,       /* the diffusion tensor of a fiber is not positive: its first vertex, and a pivot over D0 */
  FAULT_TENSION,        /* the tensions of a fiber's bonds cannot be found: its first vertex, and a pivot */
  FAULT_NO_MEMORY       /* a list of neighbor bonds could not grow */
};

struct fault {
  enum fault_code code;
  uint64_t step;  /* the step that was being made */
  int64_t entity; /* particle id, vertex, bond (its first vertex) or cell */
  double value;   /* the length, momentum, energy or mass that is too large */
  double limit;   /* the largest value allowed */
};

/* Records the first fault of a run; later ones are consequences. Returns false, for `return fault_record(...)`. */
bool fault_record(struct fault *fault, enum fault_code code, uint64_t step, int64_t entity, double value, double limit);

/* The same for FAULT_NO_MEMORY. Returns false. */
bool fault_no_memory(struct fault *fault, uint64_t step);

/* Writes one sentence: what went wrong, where, and what is allowed. */
void fault_describe(const struct fault *fault, char *text, size_t size);

/* The same as a message. Always returns 0. */
int message_fault(struct message *message, const struct fault *fault);

#endif

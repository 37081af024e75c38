/* The particles of a file: kinds, masses, bonds. Trajectories and checkpoints have the same datasets. */
#ifndef UNCROSS_FILES_STRUCTURE_H
#define UNCROSS_FILES_STRUCTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/message.h"
#include "files/hdf5.h"
#include "system/model.h"

#define STRUCTURE_SOLVENT "solvent" /* name of the last species */

/* Bytes of all that stands in a file for a particle and for a bond. */
#define STRUCTURE_PARTICLE 16.0
#define STRUCTURE_BOND 8.0

/* Writes into a group: `species` (enumeration: kinds of fiber, then the solvent), `mass` (m) and `id`, one row per
 * vertex and, if asked for, per solvent particle. The id of a row is its number. */
bool structure_write_particles(hid_t group, const struct model *model, bool solvent);

/* Writes dataset `bonds` of pairs of vertices into a group. */
bool structure_write_bonds(hid_t group, const struct model *model);

/* True if these bonds, [model->bonds][2], are this model's. */
bool structure_same_bonds(const int32_t *stored, const struct model *model);

/* The same as read back, without a model. */
struct structure {
  uint32_t particles;
  int32_t *species;                   /* [particles] index into name */
  char odd_species[128];              /* why they tell no kinds; empty: they do, or there are none */
  int kinds;                          /* species, the solvent included if it has a name */
  char (*name)[MODEL_NAME_SIZE + 16]; /* [kinds] */
  int32_t *next;                      /* [particles] a bond goes on to this one; -1: none */
  double *mass;                       /* [particles]; NULL: not stored */
  uint32_t bonds;
  bool stored_bonds; /* the file says which bonds there are, or that there are none */
};

/* Reads `species` and `mass` of `particles`, and `bonds` of `connectivity` (below 0: there are none), for this number
 * of rows. Bonds are pairs of ids: [rows]; NULL: of numbers of rows. A file of another program without fixed species
 * has one species without a name. False if they do not fit together or memory is short, with a message if it is known
 * why, else an empty one; nothing needs freeing then. */
bool structure_read(hid_t particles, hid_t connectivity, const int64_t *id, uint32_t rows, struct structure *structure,
                    struct message *why);
void structure_free(struct structure *structure);

/* Mass of a row, m: as stored, else 1. */
double structure_mass(const struct structure *structure, uint32_t row);

/* Name of a species; empty if it has none. */
const char *structure_name(const struct structure *structure, int32_t species);

/* Whether particles that a file stores contradict the model: its bonds, masses, and the order of its kinds, as far as
 * they are stored. If so, the message says how, without the file. */
bool structure_differs(const struct structure *structure, const struct model *model, struct message *why);

/* The same of walls; between: the file's box is between them. */
bool structure_walls_differ(bool between, const struct model *model, struct message *why);

/* The same of masses alone: [rows], vertices first. */
bool structure_masses_differ(const double *mass, uint32_t rows, const struct model *model, struct message *why);

/* True if rows of this species are solvent. */
bool structure_is_solvent(const struct structure *structure, int32_t species);

#endif

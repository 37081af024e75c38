/* Tables of the operators `tube_search` and `tube_contact`: contacts of thick fibers, part by part. Those of
 * `bead_search` and `bead_contact` are the same: a bead is a tube without length, q = 0. */
#ifndef UNCROSS_ORACLE_TUBE_ROWS_H
#define UNCROSS_ORACLE_TUBE_ROWS_H

#include "oracle/event_rows.h"
#include "oracle/pair.h"

/* Two tubes at the tick of their contact, lattice units. */
struct oracle_tubes {
  struct point p, q, w;
};

/* Puts n searches of tubes with their ticks; n contacts with their points and normals. After them stand constructed
 * ones, which scenes do not have (docs/port/tubes.md). */
void oracle_put_tube_searches(struct oracle_stage *g, const struct oracle_search *search, uint32_t n);
void oracle_put_tube_contacts(struct oracle_stage *g, const struct oracle_tubes *tubes, uint32_t n);
void oracle_put_bead_searches(struct oracle_stage *g, const struct oracle_search *search, uint32_t n);
void oracle_put_bead_contacts(struct oracle_stage *g, const struct oracle_tubes *tubes, uint32_t n);

/* Radius of the tube around each vertex, and how many bonds it is blind to: a table of the model. */
void oracle_put_radii(struct oracle_stage *g);

/* Writes constructed searches and contacts, at most so many, and returns their number (edges_tube.c). */
enum { ORACLE_TUBE_SEARCHES = 200, ORACLE_TUBE_CONTACTS = 100 };
uint32_t oracle_edges_tube_searches(struct oracle_search search[ORACLE_TUBE_SEARCHES]);
uint32_t oracle_edges_tube_contacts(struct oracle_tubes tubes[ORACLE_TUBE_CONTACTS]);
uint32_t oracle_edges_bead_searches(struct oracle_search search[ORACLE_TUBE_SEARCHES]);
uint32_t oracle_edges_bead_contacts(struct oracle_tubes tubes[ORACLE_TUBE_CONTACTS]);

/* A search, a contact of a pack, in a0. False if there is none in this row, or none that is legal. */
bool oracle_tube_search_of(const struct oracle_pair *pair, uint32_t row, struct oracle_search *search);
bool oracle_tubes_of(const struct oracle_pair *pair, uint32_t row, struct vec3 *p, struct vec3 *q, struct vec3 *w);

#endif

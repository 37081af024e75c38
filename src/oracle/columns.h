/* Tables of a pack from what a state and its work hold, for the operators. Solvent goes by id: stage->slot is up to
 * date. Components are words with blanks between; see pack.h for what comes back. */
#ifndef UNCROSS_ORACLE_COLUMNS_H
#define UNCROSS_ORACLE_COLUMNS_H

#include "oracle/operators.h"

int64_t *oracle_put_integers(struct oracle_stage *g, const char *name, const char *components, uint32_t rows);
double *oracle_put_reals(struct oracle_stage *g, const char *name, const char *components, uint32_t rows);
void oracle_put_vectors(struct oracle_stage *g, const char *name, const struct vec3 *v, uint32_t rows);
void oracle_put_points(struct oracle_stage *g, const char *name, const struct point *p, uint32_t rows);

/* The points that stand at `offset` in each of the structs of this size from `first` on; first may be NULL if there are
 * none. */
void oracle_put_points_of(struct oracle_stage *g, const char *name, const void *first, size_t size, size_t offset,
                          uint32_t rows);
void oracle_put_counts(struct oracle_stage *g, const char *name, const char *component, const uint32_t *n,
                       uint32_t rows);
void oracle_put_number(struct oracle_stage *g, const char *name, const char *component, double value);

/* Solvent by id; velocities and cells of solvent and vertices, a table each. */
void oracle_put_solvent_positions(struct oracle_stage *g, const char *name);
void oracle_put_solvent_velocities(struct oracle_stage *g, const char *name);
void oracle_put_velocities(struct oracle_stage *g, const char *solvent, const char *vertex);
void oracle_put_cells(struct oracle_stage *g, const char *solvent, const char *vertex);

/* By collision cell; centers and axes are zeros where a cell is left alone. */
uint32_t oracle_cells(const struct oracle_stage *g);
void oracle_put_sums(struct oracle_stage *g, const char *momentum, const char *load);
void oracle_put_centers(struct oracle_stage *g, const char *name);
void oracle_put_axes(struct oracle_stage *g, const char *name);
void oracle_put_active(struct oracle_stage *g, const char *name);

#endif

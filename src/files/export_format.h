/* Forms in which frames are printed as text. A form is a row of export_formats (export.c); a new one is a file with its
 * functions, a declaration here, and a row. */
#ifndef UNCROSS_FILES_EXPORT_FORMAT_H
#define UNCROSS_FILES_EXPORT_FORMAT_H

#include "files/frames.h"
#include "files/snapshot.h"

/* Where a row stands: in which fiber, counted from 0 in the order of their first vertices, and at which place along it;
 * both -1 for solvent. */
struct place {
  int32_t fiber, along;
};

/* The cell that is repeated in space. A sheared box is a cell whose second edge leans, by what its image beyond y = L
 * has slid so far: (tilt, L, 0). */
struct export_cell {
  bool periodic[3]; /* along each edge; false: walls */
  bool leans;       /* a sheared box, even where tilt is 0 */
  double edge[3];   /* a0 */
  double tilt;      /* a0, from -Lx/2 to Lx/2 */
  double speed;     /* a0/t0: along x, of the image beyond y = L */
};

/* A file, and what is printed of it. */
struct export_view {
  const struct frames *frames; /* with the frame at hand in frames->picture */
  const struct export_options *options;
  const struct place *place; /* [structure.particles] */
  const int32_t *prev;       /* [structure.particles] a bond comes from this one; -1: none */
  const int32_t *number;     /* [about.rows] number among the rows that are printed, from 0; -1: not printed */
  uint32_t shown;            /* rows that are printed */
  bool wrapped;              /* coordinates are folded into the cell */
  bool solvent;              /* the solvent is shown: asked for, or there is nothing else */
  struct export_cell cell;   /* of the frame at hand */
  const struct model *model; /* of the scene in the file; NULL if there is none that can be read */
};

struct export_format {
  const char *name, *title;
  bool one_frame; /* the last of those that are chosen */
  bool folds;     /* coordinates are in the box, asked for or not: images unwrap them */
  /* False, with a message, if the file cannot have this form; NULL: any can. */
  bool (*allows)(const struct export_view *view, struct message *message);
  void (*begin)(FILE *out, const struct export_view *view); /* before the first frame; NULL: nothing */
  void (*frame)(FILE *out, const struct export_view *view);
};
extern const struct export_format export_xyz, export_lammps, export_lammps_dump, export_vtf;

/* True for solvent particles. */
bool export_is_solvent(const struct export_view *view, uint32_t row);

/* A row as it is printed: folded into the cell, along the edges that are periodic, if that is asked for; image: how
 * many of each edge were taken off; 0 where it is not folded. And its velocity, a0/t0: that of the image that is shown,
 * which in a sheared box is slower by the speed of the images between. False if the file has none. */
void export_place(const struct export_view *view, uint32_t row, double x[3], double image[3]);
bool export_velocity(const struct export_view *view, uint32_t row, double v[3]);

/* The name of a kind, in which no character has a meaning in these forms. */
void export_name(FILE *out, const char *name);

#endif

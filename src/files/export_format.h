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

/* A file, and what is printed of it. */
struct export_view {
  const struct frames *frames; /* with the frame at hand in frames->picture */
  const struct export_options *options;
  const struct place *place; /* [structure.particles] */
  const int32_t *prev;       /* [structure.particles] a bond comes from this one; -1: none */
  const int32_t *number;     /* [about.rows] number among the rows that are printed, from 0; -1: not printed */
  uint32_t shown;            /* rows that are printed */
  bool wrapped;              /* coordinates are folded into the box */
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
extern const struct export_format export_xyz, export_lammps, export_vtf;

/* True for solvent particles. */
bool export_is_solvent(const struct export_view *view, uint32_t row);

/* A coordinate as it is printed: folded into the box if that is asked for. Sets *image to the number of edges that were
 * taken off. */
double export_coordinate(const struct export_view *view, uint32_t row, int axis, double *image);

/* The name of a kind, in which no character has a meaning in these forms. */
void export_name(FILE *out, const char *name);

#endif

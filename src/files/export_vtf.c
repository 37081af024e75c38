/* VTF, for VMD: https://github.com/olenz/vtfplugin/wiki/VTF-format. Atoms and bonds once, then coordinates. */
#include <inttypes.h>
#include <math.h>

#include "base/text.h"
#include "files/export_format.h"

#define SOLVENT_RADIUS 0.1 /* a0, as shown */
#define VERTEX_RADIUS 0.25 /* a0: a_h of the paper's Table II */

#define DEGREES 57.295779513082321 /* in a radian */

/* Lengths of the edges; and the angles between them, where they are not right ones. */
static void print_cell(FILE *out, const struct export_cell *c)
{
  const double edge[3] = {c->edge[0], hypot(c->tilt, c->edge[1]), c->edge[2]};
  const double angle[3] = {90.0, 90.0, DEGREES * atan2(c->edge[1], c->tilt)};
  fputs("unitcell ", out);
  text_print_reals(out, 3, edge);
  fputs(c->leans ? " " : "", out);
  text_print_reals(out, c->leans ? 3 : 0, angle);
  fputc('\n', out);
}

static void print_structure(FILE *out, const struct export_view *v)
{
  const struct structure *is = &v->frames->structure;
  print_cell(out, &v->cell);
  for (uint32_t row = 0; row < v->frames->about.rows; row++) {
    if (v->number[row] < 0)
      continue;
    const bool solvent = export_is_solvent(v, row);
    const int32_t kind = row < is->particles ? is->species[row] : -1;
    fprintf(out, "atom %" PRId32 " radius %g name ", v->number[row], solvent ? SOLVENT_RADIUS : VERTEX_RADIUS);
    export_name(out, solvent ? STRUCTURE_SOLVENT : kind >= 0 && kind < is->kinds ? is->name[kind] : "vertex");
    fprintf(out, " type %" PRId64 " resid %" PRId32 " mass ", solvent ? (int64_t)0 : (int64_t)kind + 1,
            solvent ? 0 : v->place[row].fiber + 1);
    text_print_reals(out, 1, &(double){structure_mass(is, row)});
    fputc('\n', out);
  }
  for (uint32_t row = 0; row < is->particles; row++)
    if (is->next[row] >= 0 && v->number[row] >= 0 && v->number[is->next[row]] >= 0)
      fprintf(out, "bond %" PRId32 ":%" PRId32 "\n", v->number[row], v->number[is->next[row]]);
}

static void print_frame(FILE *out, const struct export_view *v)
{
  const struct picture *p = &v->frames->picture;
  double x[3], image[3];
  fprintf(out, "\ntimestep ordered\n# step %" PRIu64 " time ", p->step);
  text_print_reals(out, 1, &p->time);
  fputc('\n', out);
  print_cell(out, &v->cell);
  for (uint32_t row = 0; row < v->frames->about.rows; row++)
    if (v->number[row] >= 0) {
      export_place(v, row, x, image);
      text_print_reals(out, 3, x);
      fputc('\n', out);
    }
}

const struct export_format export_vtf = {"vtf", "VTF", false, false, NULL, print_structure, print_frame};

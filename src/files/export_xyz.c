/* Extended XYZ, for OVITO and ASE. */
#include <inttypes.h>

#include "base/text.h"
#include "files/export_format.h"

/* Programs that read XYZ want chemical symbols; these stand for the kinds of fiber, one after the other. */
static const char *const symbols[] = {"C", "N", "O", "F", "P", "S", "B", "Si", "Cl", "Se"};
#define SOLVENT_SYMBOL "H"

static const char *symbol_of(int32_t species)
{
  size_t n = sizeof symbols / sizeof *symbols;
  return symbols[(size_t)(species < 0 ? 0 : species) % n];
}

static void print_comment(FILE *out, const struct export_view *v)
{
  const struct frames *s = v->frames;
  const struct picture *p = &s->picture;
  const struct export_cell *c = &v->cell;
  const char *between = "";
  const double lattice[9] = {c->edge[0], 0.0, 0.0, c->tilt, c->edge[1], 0.0, 0.0, 0.0, c->edge[2]};
  fputs("Lattice=\"", out);
  text_print_reals(out, 9, lattice);
  fprintf(out, "\" Properties=species:S:1:pos:R:3%s:id:I:1:next:I:1:fiber:I:1:place:I:1",
          p->velocity ? ":velo:R:3" : "");
  fprintf(out, " pbc=\"%c %c %c\" Step=%" PRIu64 " Time=", "FT"[c->periodic[0]], "FT"[c->periodic[1]],
          "FT"[c->periodic[2]], p -> step);
  text_print_reals(out, 1, &p->time);
  fputs(" kinds=\"", out);
  for (int k = 0; k < s->structure.kinds; k++) {
    bool is_solvent = structure_is_solvent(&s->structure, k);
    if (is_solvent && !v->solvent)
      continue;
    fprintf(out, "%s%s:", between, is_solvent ? SOLVENT_SYMBOL : symbol_of(k));
    export_name(out, s->structure.name[k]);
    between = " ";
  }
  fputs("\"\n", out);
}

static void print_row(FILE *out, const struct export_view *v, uint32_t row)
{
  const struct structure *is = &v->frames->structure;
  double x[3], image[3], u[3];
  fputs(export_is_solvent(v, row) ? SOLVENT_SYMBOL : symbol_of(is->species[row]), out);
  export_place(v, row, x, image);
  const bool has_velocity = export_velocity(v, row, u);
  fputc(' ', out);
  text_print_reals(out, 3, x);
  fputs(has_velocity ? " " : "", out);
  text_print_reals(out, has_velocity ? 3 : 0, u);
  const struct place none = {-1, -1}, at = row < is->particles ? v->place[row] : none;
  fprintf(out, " %" PRIu32 " %" PRId32 " %" PRId32 " %" PRId32 "\n", row, row < is->particles ? is->next[row] : -1,
          at.fiber, at.along);
}

static void print_frame(FILE *out, const struct export_view *v)
{
  fprintf(out, "%" PRIu32 "\n", v->shown);
  print_comment(out, v);
  for (uint32_t row = 0; row < v->frames->about.rows; row++)
    if (v->number[row] >= 0)
      print_row(out, v, row);
}

const struct export_format export_xyz = {"xyz", "extended XYZ", false, false, NULL, NULL, print_frame};

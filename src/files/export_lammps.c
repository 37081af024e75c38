/* LAMMPS data: https://docs.lammps.org/read_data.html, atom_style molecular; and its dump files:
 * https://docs.lammps.org/dump.html, style custom. Data hold one frame with bonds and angles, a dump all frames; types
 * and numbers are the same, so that programs read both together. Coordinates are always in the cell, with the images
 * that unwrap them. Numbers count from 1. */
#include <inttypes.h>
#include <math.h>

#include "base/text.h"
#include "files/export_format.h"

#define MOST_TYPES 4097 /* kinds of a model, and the solvent */

/* Of a kind in the file's scene; NULL without one. */
static const struct fiber_kind *kind_of(const struct export_view *v, int32_t species)
{
  const bool known = v->model && species >= 0 && (uint32_t)species < v->model->kinds;
  return known ? &v->model->kind[species] : NULL;
}

/* The species of a row; the solvent of a checkpoint has no row of its own in the structure. */
static int32_t species_of(const struct export_view *v, uint32_t row)
{
  const struct structure *is = &v->frames->structure;
  if (row < is->particles && is->species[row] >= 0)
    return is->species[row] < MOST_TYPES ? is->species[row] : MOST_TYPES; /* which is one too many */
  int32_t solvent = is->kinds;
  for (int32_t k = 0; k < is->kinds; k++)
    solvent = structure_is_solvent(is, k) ? k : solvent;
  return solvent;
}

/* Types of atoms, from 1: kinds in the file's order. The solvent, and a type for rows of no kind, only if they are
 * shown. */
static int32_t types(const struct export_view *v)
{
  int32_t most = 0;
  for (int32_t k = 0; k < v->frames->structure.kinds; k++)
    most = structure_is_solvent(&v->frames->structure, k) ? most : k + 1;
  for (uint32_t row = 0; row < v->frames->about.rows; row++)
    if (v->number[row] >= 0 && species_of(v, row) + 1 > most)
      most = species_of(v, row) + 1;
  return most;
}

static bool has_bond(const struct export_view *v, uint32_t row)
{
  const struct structure *is = &v->frames->structure;
  return row < is->particles && is->next[row] >= 0 && v->number[row] >= 0 && v->number[is->next[row]] >= 0;
}

/* Vertex `row` is the middle of an angle: only of kinds that bend. */
static bool has_angle(const struct export_view *v, uint32_t row)
{
  const struct structure *is = &v->frames->structure;
  if (!has_bond(v, row) || v->prev[row] < 0 || v->number[v->prev[row]] < 0)
    return false;
  const struct fiber_kind *kind = kind_of(v, is->species[row]);
  return kind && kind->bending > 0.0;
}

static uint32_t count(const struct export_view *v, bool (*has)(const struct export_view *, uint32_t))
{
  uint32_t n = 0;
  for (uint32_t row = 0; row < v->frames->about.rows; row++)
    n += has(v, row);
  return n;
}

/* The mass of each type; 1 if no row has it. False, with the species in *odd, if rows of one have several, or one that
 * LAMMPS does not take. */
static bool find_masses(const struct export_view *v, double mass[MOST_TYPES], int32_t *odd)
{
  for (int32_t k = 0; k < MOST_TYPES; k++)
    mass[k] = 0.0;
  for (uint32_t row = 0; row < v->frames->about.rows; row++) {
    const int32_t species = species_of(v, row);
    const double m = structure_mass(&v->frames->structure, row);
    *odd = species;
    if (v->number[row] >= 0 && !(m > 0.0 && isfinite(m) && (mass[species] == 0.0 || mass[species] == m)))
      return false;
    if (v->number[row] >= 0)
      mass[species] = m;
  }
  for (int32_t k = 0; k < MOST_TYPES; k++)
    mass[k] = mass[k] == 0.0 ? 1.0 : mass[k];
  return true;
}

static bool allows(const struct export_view *v, struct message *message)
{
  double mass[MOST_TYPES];
  int32_t odd = 0;
  for (uint32_t row = 0; row < v->frames->about.rows; row++)
    if (species_of(v, row) >= MOST_TYPES)
      return message_set(message,
                         "%s: the species of row %" PRIu32 " is above %d, the last that LAMMPS data may have here",
                         v->frames->path, row, MOST_TYPES - 1);
  return find_masses(v, mass, &odd) ||
         message_set(message,
                     "%s: species %" PRId32 ": LAMMPS data have one mass for each, which is above 0; these are not",
                     v->frames->path, odd);
}

static void print_numbered(FILE *out, int32_t number, size_t count, const double *x)
{
  fprintf(out, "%" PRId32 " ", number);
  text_print_reals(out, count, x);
  fputc('\n', out);
}

static void print_head(FILE *out, const struct export_view *v, int32_t n)
{
  const struct picture *p = &v->frames->picture;
  double mass[MOST_TYPES];
  int32_t odd;
  find_masses(v, mass, &odd);
  const struct export_cell *c = &v->cell;
  const uint32_t bonds = count(v, has_bond), angles = count(v, has_angle);
  fprintf(out, "# uncross: step %" PRIu64 ", time ", p->step);
  text_print_reals(out, 1, &p->time);
  fprintf(out, " t0; units lj, atom_style molecular, boundary %c %c %c\n\n", "fp"[c->periodic[0]], "fp"[c->periodic[1]],
          "fp"[c->periodic[2]]);
  fprintf(out, "%" PRIu32 " atoms\n%" PRIu32 " bonds\n%" PRIu32 " angles\n", v->shown, bonds, angles);
  fprintf(out, "%" PRId32 " atom types\n%" PRId32 " bond types\n%" PRId32 " angle types\n\n", n, bonds > 0 ? n : 0,
          angles > 0 ? n : 0);
  for (int k = 0; k < 3; k++) {
    text_print_reals(out, 2, (const double[]){0.0, c->edge[k]});
    fprintf(out, " %clo %chi\n", "xyz"[k], "xyz"[k]);
  }
  text_print_reals(out, c->leans ? 1 : 0, &c->tilt);
  fputs(c->leans ? " 0 0 xy xz yz\n" : "", out);
  fputs("\nMasses\n\n", out);
  for (int32_t type = 1; type <= n; type++) {
    fprintf(out, "%" PRId32 " ", type);
    text_print_reals(out, 1, &mass[type - 1]);
    fputs(type <= v->frames->structure.kinds ? " # " : "", out);
    export_name(out, type <= v->frames->structure.kinds ? v->frames->structure.name[type - 1] : "");
    fputc('\n', out);
  }
}

/* Eq. (1) is k/2 (l - l0)^2, theirs is K (r - r0)^2; Eq. (2) is kappa (1 - cos theta) with theta = 0 where a fiber is
 * straight, theirs is K (1 + cos theta) with theta = 180 degrees there. */
static void print_coefficients(FILE *out, const struct export_view *v, int32_t n)
{
  if (count(v, has_bond) > 0 && v->model) {
    fputs("\nBond Coeffs # harmonic\n\n", out);
    for (int32_t type = 1; type <= n; type++) {
      const struct fiber_kind *k = kind_of(v, type - 1);
      const double coefficients[2] = {k ? 0.5 * k->spring : 0.0, k ? k->bond_length : 0.0};
      print_numbered(out, type, 2, coefficients);
    }
  }
  if (count(v, has_angle) > 0) {
    fputs("\nAngle Coeffs # cosine\n\n", out);
    for (int32_t type = 1; type <= n; type++)
      print_numbered(out, type, 1, &(double){kind_of(v, type - 1) ? kind_of(v, type - 1)->bending : 0.0});
  }
}

static int32_t molecule_of(const struct export_view *v, uint32_t row)
{
  return export_is_solvent(v, row) ? 0 : v->place[row].fiber + 1;
}

/* Number, molecule, type, place, images. */
static void print_atom(FILE *out, const struct export_view *v, uint32_t row)
{
  double x[3], image[3];
  export_place(v, row, x, image);
  fprintf(out, "%" PRId32 " %" PRId32 " %" PRId32 " ", v->number[row] + 1, molecule_of(v, row), species_of(v, row) + 1);
  text_print_reals(out, 3, x);
  fprintf(out, " %.0f %.0f %.0f", image[0], image[1], image[2]);
}

static void print_atoms(FILE *out, const struct export_view *v)
{
  double u[3];
  fputs("\nAtoms # molecular\n\n", out);
  for (uint32_t row = 0; row < v->frames->about.rows; row++) {
    if (v->number[row] < 0)
      continue;
    print_atom(out, v, row);
    fputc('\n', out);
  }
  if (!v->frames->picture.velocity)
    return;
  fputs("\nVelocities\n\n", out);
  for (uint32_t row = 0; row < v->frames->about.rows; row++)
    if (v->number[row] >= 0 && export_velocity(v, row, u))
      print_numbered(out, v->number[row] + 1, 3, u);
}

static void print_links(FILE *out, const struct export_view *v)
{
  const struct structure *is = &v->frames->structure;
  uint32_t n = 0;
  for (uint32_t row = 0; row < v->frames->about.rows; row++)
    if (has_bond(v, row)) {
      fputs(n == 0 ? "\nBonds\n\n" : "", out);
      fprintf(out, "%" PRIu32 " %" PRId32 " %" PRId32 " %" PRId32 "\n", ++n, species_of(v, row) + 1, v->number[row] + 1,
              v->number[is->next[row]] + 1);
    }
  n = 0;
  for (uint32_t row = 0; row < v->frames->about.rows; row++)
    if (has_angle(v, row)) {
      fputs(n == 0 ? "\nAngles\n\n" : "", out);
      fprintf(out, "%" PRIu32 " %" PRId32 " %" PRId32 " %" PRId32 " %" PRId32 "\n", ++n, species_of(v, row) + 1,
              v->number[v->prev[row]] + 1, v->number[row] + 1, v->number[is->next[row]] + 1);
    }
}

static void print_frame(FILE *out, const struct export_view *v)
{
  const int32_t n = types(v);
  print_head(out, v, n);
  print_coefficients(out, v, n);
  print_atoms(out, v);
  print_links(out, v);
}

/* --- dump ------------------------------------------------------------------------------------------------------- */

/* Of a cell that leans the bounds are those of the box around it. */
static void print_bounds(FILE *out, const struct export_cell *c)
{
  static const char *const words[] = {"ff", "pp"};
  fprintf(out, "ITEM: BOX BOUNDS%s", c->leans ? " xy xz yz" : "");
  for (int k = 0; k < 3; k++)
    fprintf(out, " %s", words[c->periodic[k]]);
  fputc('\n', out);
  for (int k = 0; k < 3; k++) {
    const double tilt = k == 0 ? c->tilt : 0.0;
    const double bounds[3] = {fmin(0.0, tilt), c->edge[k] + fmax(0.0, tilt), tilt};
    text_print_reals(out, c->leans ? 3 : 2, bounds);
    fputc('\n', out);
  }
}

static void print_dump(FILE *out, const struct export_view *v)
{
  double u[3];
  fprintf(out, "ITEM: TIMESTEP\n%" PRIu64 "\nITEM: NUMBER OF ATOMS\n%" PRIu32 "\n", v->frames->picture.step, v->shown);
  print_bounds(out, &v->cell);
  fprintf(out, "ITEM: ATOMS id mol type x y z ix iy iz%s\n", v->frames->picture.velocity ? " vx vy vz" : "");
  for (uint32_t row = 0; row < v->frames->about.rows; row++) {
    if (v->number[row] < 0)
      continue;
    print_atom(out, v, row);
    const bool moves = export_velocity(v, row, u);
    fputs(moves ? " " : "", out);
    text_print_reals(out, moves ? 3 : 0, u);
    fputc('\n', out);
  }
}

const struct export_format export_lammps = {"lammps", "LAMMPS data", true, true, allows, NULL, print_frame};
const struct export_format export_lammps_dump = {"lammps-dump", "a LAMMPS dump", false, true, NULL, NULL, print_dump};

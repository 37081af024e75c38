/* `uncross map`: a scene whose fibers are those of an experiment, and what it leaves wrong. docs/units.md explains the
 * choices, which are those of the paper's scenes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "cli/quantity.h"
#include "mpc/rule.h"
#include "scene/load_words.h"
#include "scene/scene.h"
#include "system/fiber_kind.h"
#include "theory/theory.h"

/* What was given, in SI units; 0: not given. */
struct given {
  double length, persistence, diameter, mesh, vertices;
};

#define AT(member) offsetof(struct given, member)

static const struct quantity_row rows[] = {
    {"length", QUANTITY_LENGTH, AT(length)},     {"persistence", QUANTITY_LENGTH, AT(persistence)},
    {"diameter", QUANTITY_LENGTH, AT(diameter)}, {"mesh", QUANTITY_LENGTH, AT(mesh)},
    {"vertices", QUANTITY_NUMBER, AT(vertices)},
};

/* The paper's: Sec. V A for chains without stiffness, Sec. V B for fibers. */
#define PAPER_VERTICES 64
#define PAPER_BOND 0.5     /* l0 of stiff fibers, a0: twice the radius of a vertex */
#define PAPER_SPRING 100.0 /* of stiff fibers, kT/a0^2 */
#define PAPER_CHAIN 3.0    /* of chains: <l^2> = 1 a0^2 */
#define PAPER_DIAMETER 0.6 /* b of Eq. (40), a0 */
#define PAPER_GAMMA 5.0
#define PAPER_INTERVAL 0.02 /* t0 */
#define PAPER_ANGLE 90.0
#define MOST_VERTICES 1e6

/* Time steps in a collision interval: two, and more for a fiber whose fastest vibration needs them. */
#define PAPER_SPLIT 2
#define MOST_SPLIT 64
#define MOST_PHASE 0.5 /* omega dt */

struct mapped {
  struct fiber_kind kind;
  int split; /* time steps in a collision interval */
  double a0;
  double edge;  /* a0 */
  double count; /* fibers in the box */
};

/* The one of vertices and a0 that is not given, so that bonds of the mean length `mean`, a0, make up the fiber. */
static void divide(double length, double mean, double *vertices, double *a0)
{
  if (*a0 > 0.0)
    *vertices = 1.0 + round(length / (mean * *a0));
  else
    *a0 = length / (mean * (*vertices - 1.0));
}

/* Stiff fibers have the right contour and persistence length. Where a bond is longer than l_p, bonds are springs of no
 * rest length: their chain has the right <R^2>, and no stiffness. */
static bool lay_out(const struct given *f, const struct units *u, struct mapped *p, struct message *message)
{
  const double square = si_wormlike_square(f->length, f->persistence);
  double n = f->vertices > 0.0 ? round(f->vertices) : PAPER_VERTICES;
  p->kind = (struct fiber_kind){.mass = PAPER_GAMMA, .bond_length = PAPER_BOND, .spring = PAPER_SPRING};
  p->a0 = u->a0;
  divide(f->length, fiber_mean_bond(&p->kind), &n, &p->a0);
  const bool stiff = f->persistence > f->length / (n - 1.0);
  if (!stiff) {
    p->kind = (struct fiber_kind){.mass = PAPER_GAMMA, .spring = PAPER_CHAIN};
    p->a0 = u->a0 > 0.0 ? u->a0 : sqrt(square / (n - 1.0));
    n = u->a0 > 0.0 ? 1.0 + round(square / (u->a0 * u->a0)) : n;
  }
  if (!(n >= 3.0 && n <= MOST_VERTICES))
    return message_set(message, "map: %.6g vertices: a fiber takes 3 to %g of them; choose another %s", n,
                       MOST_VERTICES, u->a0 > 0.0 ? "a0" : "number");
  p->kind.vertices = (uint32_t)n;
  if (stiff)
    p->kind.bending = si_bending(&p->kind, f->persistence / p->a0);
  return p->kind.bending < 0.5 * MODEL_MOST_BENDING ||
         message_set(message, "map: the fiber is too stiff: bending would be above %g kT", MODEL_MOST_BENDING);
}

/* Time steps that are short enough for the fastest vibration. A fiber that is straight anyway needs no stiffness that
 * takes more of them. */
static bool choose_step(const struct given *f, struct mapped *p, struct message *message)
{
  const double omega = fiber_highest_frequency(&p->kind);
  p->split = PAPER_SPLIT;
  while (p->split < MOST_SPLIT && omega * PAPER_INTERVAL / p->split > MOST_PHASE)
    p->split *= 2;
  const double phase = omega * PAPER_INTERVAL / p->split, least = pow(MOST_PHASE / phase, 2.0);
  char text[64];
  return phase <= MOST_PHASE ||
         message_set(
             message,
             "map: the fiber is too stiff: its fastest vibration, %.3g / t0, needs time steps below %.3g t0; use "
             "a persistence length of %s or less, which is %.3g times the length",
             omega, MOST_PHASE / omega, quantity_text(0.9 * least * f->persistence, "m", true, text, sizeof text),
             0.9 * least * f->persistence / f->length);
}

/* A box in which no fiber meets its own image, and as many fibers as the mesh asks for: c L = 3/xi^2. */
static bool fill_box(const struct given *f, struct mapped *p, struct message *message)
{
  p->edge = fmax(ceil(theory_reach(&p->kind) * (1.0 - 1e-9)), 4.0);
  if (p->edge > LATTICE_MAX_EDGE || PAPER_GAMMA * p->edge * p->edge * p->edge > INT32_MAX)
    return message_set(message, "map: a box of %.0f cells along each edge is too large; use fewer vertices", p->edge);
  const double mesh = f->mesh / p->a0, volume = p->edge * p->edge * p->edge;
  p->count = f->mesh > 0.0 ? fmax(round(3.0 / (mesh * mesh) * volume * p->a0 / f->length), 1.0) : 1.0;
  p->kind.count = (uint32_t)fmin(p->count, UINT32_MAX);
  return p->count * p->kind.vertices < INT32_MAX ||
         message_set(message, "map: %.3g fibers of %u vertices are too many; use a wider mesh", p->count,
                     p->kind.vertices);
}

static bool must_have(double value, const char *what, struct message *message)
{
  return value > 0.0 || message_set(message,
                                    "map: %s is missing, as in uncross map length=10um,persistence=17um --units "
                                    "T=300K,eta=1mPas",
                                    what);
}

static bool read_all(const struct arguments *a, struct given *f, struct units *u, struct message *message)
{
  *f = (struct given){0};
  return units_read(a->units, u, message) &&
         quantities_read("map", a->file[0], rows, sizeof rows / sizeof *rows, f, message) &&
         must_have(f->length, "length", message) && must_have(f->persistence, "persistence", message) &&
         must_have(u->temperature, "--units T", message) &&
         (f->vertices == 0.0 || u->a0 == 0.0 ||
          message_set(message, "map: vertices or --units a0: one follows from the other"));
}

/* --- printing ----------------------------------------------------------------------------------------------------- */

/* The comment at the head, without what follows from the whole scene. */
static void write_head(FILE *out, const struct given *f, const struct units *u, const struct mapped *p)
{
  char text[2][64];
  fprintf(out,
          "# A fiber of length %s and persistence length %s at %.6g K, in %u vertices (uncross map, docs/units.md).\n"
          "# SI units of this scene: --units a0=%.9gnm,T=%.9gK",
          quantity_text(f->length, "m", true, text[0], sizeof text[0]),
          quantity_text(f->persistence, "m", true, text[1], sizeof text[1]), u->temperature, p->kind.vertices,
          1e9 * p->a0, u->temperature);
  if (u->viscosity > 0.0)
    fprintf(out, ",eta=%.9gmPas", 1e3 * u->viscosity);
  if (u->density > 0.0)
    fprintf(out, ",rho=%.9gkg/m3", u->density);
  if (u->mass > 0.0)
    fprintf(out, ",mass=%.9gkg", u->mass);
  if (u->time > 0.0)
    fprintf(out, ",t0=%.9gs", u->time);
  fputs("\n#\n# What differs from the experiment:\n", out);
}

static void write_differences(FILE *out, const struct given *f, const struct units *u, const struct mapped *p)
{
  char text[2][64];
  if (p->kind.bending > 0.0 && f->diameter > 0.0) {
    const double wrong = PAPER_DIAMETER * p->a0;
    const double ratio =
        theory_rod_diffusion(1.0, f->length, wrong) / theory_rod_diffusion(1.0, f->length, f->diameter);
    fprintf(out,
            "# - In the flow the fiber has a diameter of %s (0.6 a0), not %s. A straight one diffuses %.3g times as "
            "fast.\n",
            quantity_text(wrong, "m", true, text[0], sizeof text[0]),
            quantity_text(f->diameter, "m", true, text[1], sizeof text[1]), ratio);
  }
  fprintf(out, "# - The springs are the paper's (%.6g kT/a0^2 = %s), not the fiber's own.\n", p->kind.spring,
          quantity_text(p->kind.spring * SI_BOLTZMANN * u->temperature / (p->a0 * p->a0), "N/m", true, text[0],
                        sizeof text[0]));
  fputs("# - Between contacts fibers have no width: no excluded volume.\n", out);
  if (p->kind.bending == 0.0)
    fprintf(out,
            "# - A bond is longer than l_p: the chain has no stiffness. It has the R_e of the wormlike chain, %s.\n",
            quantity_text(sqrt(si_wormlike_square(f->length, f->persistence)), "m", true, text[0], sizeof text[0]));
}

#define MUCH_FILLED 0.05 /* of the volume */

/* What is wrong with many fibers in a box. */
static void write_crowd(FILE *out, const struct mapped *p, const struct model *m)
{
  const double length = p->kind.count * fiber_contour(&p->kind) / box_volume(&m->box);
  const double filled = 0.25 * 3.14159265358979323846 * PAPER_DIAMETER * PAPER_DIAMETER * length;
  char text[512];
  if (p->kind.bending > 0.0 && filled > MUCH_FILLED)
    fprintf(out, "# - With the diameter that they have in the flow, 0.6 a0, fibers fill %.0f %% of the volume.\n",
            100.0 * filled);
  if (load_words(m, "--set fibers.fiber.mass", "--set solvent.per_cell", text, sizeof text))
    fprintf(out, "# - The %s.\n", text);
}

static void write_scene(FILE *out, const struct mapped *p)
{
  const int edge = (int)p->edge;
  fprintf(out,
          "\nbox: [%d, %d, %d]\ntime_step: %.9g\nsteps: %d\nseed: 1\n\n"
          "solvent:\n  per_cell: %g\n  collision_interval: %g\n  rotation_angle: %g\n\n"
          "fibers:\n  - name: fiber\n    count: %u\n    vertices: %u\n    mass: %g\n    bond_length: %.9g\n    spring: "
          "%.9g\n",
          edge, edge, edge, PAPER_INTERVAL / p->split, 10000 / PAPER_SPLIT * p->split, PAPER_GAMMA, PAPER_INTERVAL,
          PAPER_ANGLE, p->kind.count, p->kind.vertices, p->kind.mass, p->kind.bond_length, p->kind.spring);
  if (p->kind.bending > 0.0)
    fprintf(out, "    bending: %.9g\n", p->kind.bending);
  fputs("\nobserve:\n  conserved: {every: 100}\n  statics: {every: 100}\n  dynamics: {every: 10}\n\n"
        "trajectory: {every: 100}\n",
        out);
}

/* The text of the scene, to be freed; NULL if memory is short. */
static char *scene_text(const struct mapped *p, size_t *size)
{
  char *text = NULL;
  FILE *out = open_memstream(&text, size);
  if (!out)
    return NULL;
  write_scene(out, p);
  if (fclose(out) == 0)
    return text;
  free(text);
  return NULL;
}

/* Reads the scene as `check` does before it prints it: what is printed can be run. */
static bool print_all(const struct given *f, const struct units *u, const struct mapped *p, struct message *message)
{
  size_t size = 0;
  char *text = scene_text(p, &size);
  struct scene scene;
  struct message why;
  const bool good = text && scene_read_text("map", text, size, &scene, &why);
  if (good) {
    write_head(stdout, f, u, p);
    write_differences(stdout, f, u, p);
    write_crowd(stdout, p, &scene.model);
    fputs(text, stdout);
    scene_free(&scene);
  } else if (text)
    message_set(message, "map: no scene for these fibers: %s", why.text);
  else
    message_set(message, "map: no memory");
  free(text);
  return good;
}

enum exit_code command_map(const struct arguments *a)
{
  struct given f;
  struct units u;
  struct mapped p;
  struct message message;
  if (!read_all(a, &f, &u, &message) || !lay_out(&f, &u, &p, &message) || !choose_step(&f, &p, &message) ||
      !fill_box(&f, &p, &message) || !print_all(&f, &u, &p, &message)) {
    fprintf(stderr, "uncross: %s\n", message.text);
    return EXIT_BAD_INPUT;
  }
  return EXIT_DONE;
}

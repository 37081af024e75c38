/* A scene in one argument, for the programs of this folder: "cells=32,fibers=100,dt=0.01". What is not said is the
 * paper's: 5 solvent particles per cell, dt 0.01, a collision every 0.02, fibers of 64 vertices, crossings refused. */
#ifndef UNCROSS_BENCH_SCENE_H
#define UNCROSS_BENCH_SCENE_H

#include <math.h>

#include "../measure/measure.h"

struct scene {
  double cells;       /* edge of the cubic box */
  double per_cell;    /* 0: no solvent */
  double dt, every;   /* t0; a collision every `every` steps, 0: every 0.02 t0 */
  double fibers;      /* number of them */
  double vertices;    /* of each fiber */
  double crossing;    /* enum crossing_kind: 0 free, 1 sequential, 2 event-driven */
  double order;       /* 0 paper, 1 kick-split, 2 drift-split */
  double hydro;       /* 0: velocities of the solvent are swapped */
  double thermostat;  /* 0 none, 1 rescale, 2 maxwell-boltzmann */
  double rule;        /* 0 srd, 1 at-a, 2 at+a */
  double angle;       /* of srd, degrees */
  double bond_length; /* a0 */
  double spring;      /* kT/a0^2 */
  double bending;     /* kT */
  double walls;       /* 1: between no-slip walls that slide at a shear rate of 0.02 / t0 */
  double fill;        /* enum wall_fill: 0 planar, 1 paper, 2 none */
  double shear;       /* rate of a sheared box, 1/t0 */
  double diameter;    /* of fibers, a0 */
  double pairs;       /* spring constant of dumbbells, kT/a0^2; 0: independent particles */
  double bead;        /* radius of a bead that 10 kT/a0 pull, a0; 0: none */
};

static inline struct scene scene_default(void)
{
  return (struct scene){.cells = 32,
                        .per_cell = 5,
                        .dt = 0.01,
                        .vertices = 64,
                        .crossing = 1,
                        .order = SCHEME_KICK_SPLIT,
                        .hydro = 1,
                        .angle = 90,
                        .bond_length = 0.5,
                        .spring = 100,
                        .bending = 64};
}

static const struct scene_key {
  const char *name;
  size_t offset;
} scene_keys[] = {
    {"cells", offsetof(struct scene, cells)},
    {"per_cell", offsetof(struct scene, per_cell)},
    {"dt", offsetof(struct scene, dt)},
    {"every", offsetof(struct scene, every)},
    {"fibers", offsetof(struct scene, fibers)},
    {"vertices", offsetof(struct scene, vertices)},
    {"crossing", offsetof(struct scene, crossing)},
    {"order", offsetof(struct scene, order)},
    {"hydro", offsetof(struct scene, hydro)},
    {"thermostat", offsetof(struct scene, thermostat)},
    {"rule", offsetof(struct scene, rule)},
    {"angle", offsetof(struct scene, angle)},
    {"bond_length", offsetof(struct scene, bond_length)},
    {"spring", offsetof(struct scene, spring)},
    {"bending", offsetof(struct scene, bending)},
    {"walls", offsetof(struct scene, walls)},
    {"fill", offsetof(struct scene, fill)},
    {"shear", offsetof(struct scene, shear)},
    {"diameter", offsetof(struct scene, diameter)},
    {"pairs", offsetof(struct scene, pairs)},
    {"bead", offsetof(struct scene, bead)},
};

static inline bool scene_set(struct scene *scene, const char *name, size_t length, double value)
{
  for (size_t k = 0; k < sizeof scene_keys / sizeof *scene_keys; k++)
    if (strlen(scene_keys[k].name) == length && strncmp(scene_keys[k].name, name, length) == 0) {
      *(double *)((char *)scene + scene_keys[k].offset) = value;
      return true;
    }
  return false;
}

/* Ends the program with status 2 at what it does not understand. */
static inline struct scene scene_parse(const char *text)
{
  struct scene scene = scene_default();
  for (const char *p = text; *p != '\0';) {
    const char *equals = strchr(p, '=');
    char *end = NULL;
    const double value = equals ? strtod(equals + 1, &end) : 0.0;
    if (!equals || end == equals + 1 || (*end != ',' && *end != '\0') ||
        !scene_set(&scene, p, (size_t)(equals - p), value)) {
      fprintf(stderr, "scene '%s': what is '%s'? allowed: key=number, with commas between\n", text, p);
      exit(2);
    }
    p = *end == ',' ? end + 1 : end;
  }
  return scene;
}

static inline struct model scene_model(const struct scene *s)
{
  const int edge = (int)s->cells;
  const double interval = s->every > 0.0 ? s->every : fmax(1.0, nearbyint(0.02 / s->dt));
  struct model m = standard_model(edge, edge, edge, s->per_cell, s->dt, (uint32_t)interval);
  m.scheme = (enum scheme)s->order;
  m.crossing.forbidden = s->crossing != CROSSING_FREE;
  m.crossing.rule = (enum crossing_kind)s->crossing;
  m.solvent.hydrodynamics = s->hydro != 0.0;
  m.solvent.thermostat = (enum thermostat_kind)s->thermostat;
  m.solvent.rule = (enum rule)s->rule;
  m.solvent.rotation_angle = s->angle;
  if (s->walls != 0.0)
    m.walls = (struct wall_model){.kind = WALL_NO_SLIP, .fill = (enum wall_fill)s->fill, .shear_rate = 0.02};
  m.shear.rate = s->shear;
  if (s->pairs > 0.0)
    m.dumbbells = (struct dumbbell_model){.spring = s->pairs, .fraction = 1.0};
  if (s->bead > 0.0)
    m.bead = (struct bead_model){
        .radius = s->bead, .center = {0.5 * edge, 0.5 * edge, 0.5 * edge}, .drive = {.force = {10.0, 0.0, 0.0}}};
  if (s->fibers > 0.0) {
    struct fiber_kind *k = add_kind(&m, (uint32_t)s->fibers, (uint32_t)s->vertices);
    k->bond_length = s->bond_length;
    k->spring = s->spring;
    k->bending = s->bending;
    k->diameter = s->diameter;
  }
  return m;
}

#endif

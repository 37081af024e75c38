/*
 * Equation of state and order of hard spherocylinders: thick rods of one bond in flight, without solvent
 * (docs/thick.md).
 *
 * usage: thick_state EDGE RATIO BLOCKS TIME START PHI...
 *
 * Rods of length 1 a0 and diameter 1/RATIO in a cube of EDGE a0, at volume fractions PHI. START: `random`, laid one
 * after another; `aligned`, along z in a square lattice of layers, with S = 1; `grown`, at random while they are THIN
 * times as thick, then in flight until they are as thick as wanted: after each step they grow as far as the nearest two
 * allow. So this start is isotropic at densities at which no rod finds room at random. BLOCKS blocks of TIME t0 each.
 * The first half of the blocks is given to equilibration. Of the other half: Z = P V/(N kT) from contacts (rods.h), its
 * error from the blocks, and S (nematic.h). Both also for its two quarters: they must agree where equilibrium is
 * reached. `parsons`: 1 + (B2/v0) phi (1 - phi/2)/(1 - phi)^3. `grown`: t0 that growing took.
 */
#include "../../tests/statistics.h"
#include "contact/capsule.h"
#include "measure.h"
#include "nematic.h"
#include "rods.h"

/* Layers of a height of one rod and a diameter, with room; a square lattice in each. */
static void place_aligned(struct fiber_kind *k, int edge)
{
  const double length = 1.03 + k->diameter;
  const uint32_t layers = (uint32_t)(edge / length), each = (k->count + layers - 1) / layers,
                 side = (uint32_t)ceil(sqrt(each));
  if (edge / (double)side < 1.001 * k->diameter) {
    fprintf(stderr, "no room for %u aligned rods\n", k->count);
    exit(1);
  }
  k->start = START_STRAIGHT, k->placed = k->count, k->place = calloc(k->count, sizeof *k->place);
  for (uint32_t n = 0; n < k->count; n++) {
    const uint32_t in = n / layers;
    k->place[n].center = (struct vec3){(in % side + 0.5) * edge / side, (in / side + 0.5) * edge / side,
                                       (n % layers + 0.5) * edge / layers};
    k->place[n].direction = (struct vec3){0, 0, 1};
  }
}

/* --- rods that grow ----------------------------------------------------------------------------------------------- */

#define THIN 0.7 /* L/D of 7, and half of the volume */

enum start { RANDOM, ALIGNED, GROWN };

/* A rod: its center and half of its bond, a0. */
struct axis {
  struct vec3 center, half;
};

static double to_nearest_image(double x, double edge)
{
  return x - edge * rint(x / edge);
}

/* The least distance of two axes, a0. Rods are shorter than half of the box. */
static double least_distance(const struct run *r, struct axis *axis, double edge)
{
  const uint32_t n = r->model.fibers;
  double least = 1.0;
  for (uint32_t f = 0; f < n; f++) {
    const struct point *at = &r->state.position[r->model.fiber_first[f]];
    axis[f].half = vec3_scale(0.5, point_difference(at[1], at[0]));
    axis[f].center = vec3_add(point_in_a0(at[0]), axis[f].half);
  }
  for (uint32_t f = 0; f < n; f++)
    for (uint32_t g = 0; g < f; g++) {
      const struct axis *a = &axis[f], *b = &axis[g];
      const struct vec3 d = {to_nearest_image(b->center.x - a->center.x, edge),
                             to_nearest_image(b->center.y - a->center.y, edge),
                             to_nearest_image(b->center.z - a->center.z, edge)};
      const double reach = vec3_norm(a->half) + vec3_norm(b->half) + least;
      if (vec3_dot(d, d) < reach * reach)
        least = fmin(least, capsule_distance(vec3_scale(2.0, a->half), vec3_scale(2.0, b->half),
                                             vec3_add(d, vec3_sub(a->half, b->half))));
    }
  return least;
}

/* Steps until rods have the radius that the model was made with, lattice units. Lists were made for it, so that only
 * the radius itself changes. Returns the time it took, t0. */
static double grow(struct run *r, int64_t wanted, double edge)
{
  int64_t *radius = &r->model.kind[0].radius;
  const uint64_t start = r->state.step;
  struct axis *axis = malloc(r->model.fibers * sizeof *axis);
  stop_unless(axis, r);
  while (*radius < wanted) {
    run_steps(r, 1);
    /* Less by far more than doubles err, and 1e-4 of what a step grows by. */
    const int64_t room = lattice_from_a0(0.5 * least_distance(r, axis, edge) - 1e-9);
    if (room > *radius)
      *radius = room < wanted ? room : wanted;
  }
  free(axis);
  stop_unless(start_sound(&r->state, &r->model, &r->work.fault), r);
  return (double)(r->state.step - start) * r->model.time_step;
}

/* --- blocks ------------------------------------------------------------------------------------------------------- */

struct block {
  double z, s;
};

static struct block run_block(struct run *r, double time)
{
  struct rod_watch w = {.model = &r->model, .state = &r->state};
  const struct contact_log log = {rod_record, &w};
  const uint64_t steps = (uint64_t)(time / r->model.time_step + 0.5);
  double heat = 0.0, order = 0.0, looks = 0.0;
  for (uint64_t k = 0; k < steps; k++) {
    stop_unless(step_advance(&r->state, &r->model, &r->work, &log), r);
    heat += rod_temperature(&r->state, &r->model) / (double)steps;
    if (k % 40 == 0)
      order += nematic_order(&r->state, &r->model), looks += 1.0;
  }
  return (struct block){1.0 + w.virial / (3.0 * time * r->model.fibers * heat), order / looks};
}

static void measure_state(int edge, double ratio, int blocks, double time, enum start start, double phi)
{
  const double d = 1.0 / ratio, volume = pow(edge, 3);
  struct model m = standard_model(edge, edge, edge, 0, 0.005, 1);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  struct fiber_kind *k = add_kind(&m, (uint32_t)lround(phi * volume / rod_volume(1.0, d)), 2);
  k->bond_length = 1.0, k->spring = 2000.0, k->bending = 0.0, k->diameter = d;
  if (start == ALIGNED)
    place_aligned(k, edge);
  finish(&m);
  const int64_t radius = m.kind[0].radius;
  if (start == GROWN)
    m.kind[0].radius = (int64_t)(THIN * (double)radius);
  struct run r;
  run_start_finished(&r, m, 1);
  const double grown = grow(&r, radius, edge);
  const double length = rod_length_moment(&r.model.kind[0], 1), v0 = rod_volume(length, d), n = r.model.fibers,
               fraction = n * v0 / volume;
  struct sample z = {0}, s = {0}, zs[2] = {{0}}, ss[2] = {{0}};
  for (int b = 0; b < blocks; b++) {
    const struct block now = run_block(&r, time);
    if (2 * b < blocks)
      continue;
    const int later = 4 * b >= 3 * blocks;
    sample_add(&z, now.z), sample_add(&s, now.s), sample_add(&zs[later], now.z), sample_add(&ss[later], now.s);
  }
  printf("%.0f,%.6f,%.6g,%.3g,%.6g,%.4f,%.4f,%.6g,%.6g,%.4f,%.4f,%lu,%.6g\n", n, fraction, z.mean, sample_error(&z),
         1.0 + rod_b2(length, d) / v0 * fraction * rod_contact_value(fraction), s.mean, sample_error(&s), zs[0].mean,
         zs[1].mean, ss[0].mean, ss[1].mean, (unsigned long)r.state.counts.rigid, grown);
  fflush(stdout);
  run_end(&r);
}

int main(int argc, char **argv)
{
  static const char *const words[] = {[RANDOM] = "random", [ALIGNED] = "aligned", [GROWN] = "grown"};
  int start = -1;
  for (int k = RANDOM; argc > 6 && k <= GROWN; k++)
    start = strcmp(argv[5], words[k]) == 0 ? k : start;
  if (start < 0) {
    fprintf(stderr, "usage: %s EDGE RATIO BLOCKS TIME random|aligned|grown PHI...\n", argv[0]);
    return 2;
  }
  printf("rods,phi,Z,Z_error,parsons,S,S_error,Z_first,Z_second,S_first,S_second,rigid,grown\n");
  for (int a = 6; a < argc; a++)
    measure_state(atoi(argv[1]), atof(argv[2]), atoi(argv[3]), atof(argv[4]), (enum start)start, atof(argv[a]));
  return 0;
}

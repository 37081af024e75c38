/*
 * Equation of state and order of hard spherocylinders: thick rods of one bond in flight, without solvent
 * (docs/thick.md).
 *
 * usage: thick_state EDGE RATIO BLOCKS TIME START PHI...
 *
 * Rods of length 1 a0 and diameter 1/RATIO in a cube of EDGE a0, at volume fractions PHI. START: `random`, laid one
 * after another; `aligned`, along z in a square lattice of layers, with S = 1. BLOCKS blocks of TIME t0 each. The first
 * half of the blocks is given to equilibration. Of the other half: Z = P V/(N kT) from contacts (rods.h), its error
 * from the blocks, and S, the largest eigenvalue of <(3 u u - 1)/2>, the mean over the box. Both also for its two
 * quarters: they must agree where equilibrium is reached. `parsons`: 1 + (B2/v0) phi (1 - phi/2)/(1 - phi)^3.
 */
#include <gsl/gsl_eigen.h>

#include "../../tests/statistics.h"
#include "measure.h"
#include "rods.h"

static double nematic_order(const struct state *state, const struct model *model)
{
  double q[9] = {0}, n = model->fibers;
  for (uint32_t f = 0; f < model->fibers; f++) {
    const uint32_t i = model->fiber_first[f];
    const struct vec3 b = point_difference(state->position[i + 1], state->position[i]);
    const double u[3] = {b.x / vec3_norm(b), b.y / vec3_norm(b), b.z / vec3_norm(b)};
    for (int k = 0; k < 9; k++)
      q[k] += (1.5 * u[k / 3] * u[k % 3] - 0.5 * (k / 3 == k % 3)) / n;
  }
  gsl_matrix_view view = gsl_matrix_view_array(q, 3, 3);
  gsl_vector *value = gsl_vector_alloc(3);
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(3);
  gsl_eigen_symm(&view.matrix, value, work);
  const double most = gsl_vector_max(value);
  gsl_eigen_symm_free(work);
  gsl_vector_free(value);
  return most;
}

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

static void measure_state(int edge, double ratio, int blocks, double time, bool aligned, double phi)
{
  const double d = 1.0 / ratio, volume = pow(edge, 3);
  struct model m = standard_model(edge, edge, edge, 0, 0.005, 1);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  struct fiber_kind *k = add_kind(&m, (uint32_t)lround(phi * volume / rod_volume(1.0, d)), 2);
  k->bond_length = 1.0, k->spring = 2000.0, k->bending = 0.0, k->diameter = d;
  if (aligned)
    place_aligned(k, edge);
  struct run r;
  run_start(&r, m, 1);
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
  printf("%.0f,%.6f,%.6g,%.3g,%.6g,%.4f,%.4f,%.6g,%.6g,%.4f,%.4f,%lu\n", n, fraction, z.mean, sample_error(&z),
         1.0 + rod_b2(length, d) / v0 * fraction * rod_contact_value(fraction), s.mean, sample_error(&s), zs[0].mean,
         zs[1].mean, ss[0].mean, ss[1].mean, (unsigned long)r.state.counts.rigid);
  fflush(stdout);
  run_end(&r);
}

int main(int argc, char **argv)
{
  if (argc < 7) {
    fprintf(stderr, "usage: %s EDGE RATIO BLOCKS TIME random|aligned PHI...\n", argv[0]);
    return 2;
  }
  printf("rods,phi,Z,Z_error,parsons,S,S_error,Z_first,Z_second,S_first,S_second,rigid\n");
  for (int a = 6; a < argc; a++)
    measure_state(atoi(argv[1]), atof(argv[2]), atoi(argv[3]), atof(argv[4]), strcmp(argv[5], "aligned") == 0,
                  atof(argv[a]));
  return 0;
}

/*
 * The tube of a suspension of thick fibers: d^2 of their middle thirds against time (docs/claims/thick.md).
 *
 * usage: thick_tube SEED EDGE FIBERS VERTICES WIDEST DIAMETER TIME
 *
 * The paper's fibers (M = 5, k = 100, l0 = 0.5, l_p = L by its count) in a cube of EDGE a0, with contacts at their own
 * time (thin lines too) in a bath of phantoms. They are laid at random without overlap while they have the diameter
 * WIDEST, then have the DIAMETER. So all diameters up to WIDEST have the same start, places and velocities, for one
 * SEED. TIME t0 each. Rows: lag, mean of d^2 (d2_third, docs/observables.md) over fibers and intervals, its error from
 * the scatter of fibers, mean square displacement of the middle vertex, and S (nematic.h) of the start and of the end.
 */
#include "../../tests/statistics.h"
#include "measure.h"
#include "nematic.h"
#include "observe/dynamics.h"

enum { LAGS = 24 };
#define SAMPLE 0.25 /* t0 */

/* A lag: the state when its interval began, and sums of each fiber. */
struct lag {
  uint64_t samples;
  struct point *origin;  /* [vertices] */
  double *tube, *middle; /* [fibers] */
  double intervals;
};

static struct model model_of(int edge, uint32_t fibers, uint32_t vertices, double diameter)
{
  struct model m = standard_model(edge, edge, edge, 5.0, 0.01, 2);
  m.solvent.hydrodynamics = false, m.solvent.bath = BATH_PHANTOMS;
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  struct fiber_kind *k = add_kind(&m, fibers, vertices);
  k->bending = vertices, k->diameter = diameter;
  finish(&m);
  return m;
}

static uint32_t lags_begin(struct lag *lag, const struct run *r, uint64_t samples)
{
  uint32_t lags = 0;
  while (lags < LAGS && 2 * dynamics_lag(lags) <= samples) {
    struct lag *l = &lag[lags];
    *l = (struct lag){.samples = dynamics_lag(lags),
                      .origin = malloc(r->state.vertices * sizeof *l->origin),
                      .tube = calloc(r->model.fibers, sizeof *l->tube),
                      .middle = calloc(r->model.fibers, sizeof *l->middle)};
    stop_unless(l->origin && l->tube && l->middle, r);
    memcpy(l->origin, r->state.position, r->state.vertices * sizeof *l->origin);
    lags++;
  }
  return lags;
}

static void lag_look(struct lag *l, const struct run *r, struct vec3 *scratch)
{
  for (uint32_t f = 0; f < r->model.fibers; f++) {
    const uint32_t first = r->model.fiber_first[f];
    const struct fiber_motion motion =
        fiber_motion(&r->model.kind[0], &l->origin[first], &r->state.position[first], (struct vec3){0, 0, 0}, scratch);
    l->tube[f] += motion.tube_third, l->middle[f] += motion.middle;
  }
  l->intervals += 1.0;
  memcpy(l->origin, r->state.position, r->state.vertices * sizeof *l->origin);
}

static void lag_print(struct lag *l, const struct run *r, double diameter, double s_start, double s_end)
{
  struct sample tube = {0}, middle = {0};
  for (uint32_t f = 0; f < r->model.fibers; f++)
    sample_add(&tube, l->tube[f] / l->intervals), sample_add(&middle, l->middle[f] / l->intervals);
  printf("%g,%g,%.0f,%.6g,%.3g,%.6g,%.3g,%.4f,%.4f\n", diameter, (double)l->samples * SAMPLE, l->intervals, tube.mean,
         sample_error(&tube), middle.mean, sample_error(&middle), s_start, s_end);
  free(l->origin), free(l->tube), free(l->middle);
}

int main(int argc, char **argv)
{
  if (argc != 8) {
    fprintf(stderr, "usage: %s SEED EDGE FIBERS VERTICES WIDEST DIAMETER TIME\n", argv[0]);
    return 2;
  }
  const uint64_t seed = strtoull(argv[1], NULL, 10);
  const int edge = atoi(argv[2]);
  const uint32_t fibers = (uint32_t)atoi(argv[3]), vertices = (uint32_t)atoi(argv[4]);
  const double diameter = atof(argv[6]);
  struct run start, r;
  run_start_finished(&start, model_of(edge, fibers, vertices, atof(argv[5])), seed);
  run_start_finished(&r, model_of(edge, fibers, vertices, diameter), seed);
  memcpy(r.state.position, start.state.position, r.state.vertices * sizeof *r.state.position);
  memcpy(r.state.velocity, start.state.velocity, r.state.vertices * sizeof *r.state.velocity);
  stop_unless(start_sound(&r.state, &r.model, &r.work.fault), &r);
  run_end(&start);

  const uint64_t steps = (uint64_t)(SAMPLE / r.model.time_step + 0.5),
                 samples = (uint64_t)(atof(argv[7]) / SAMPLE + 0.5);
  struct lag lag[LAGS];
  struct vec3 *scratch = malloc(vertices * sizeof *scratch);
  const uint32_t lags = lags_begin(lag, &r, samples);
  stop_unless(scratch, &r);
  const double s_start = nematic_order(&r.state, &r.model);
  for (uint64_t n = 1; n <= samples; n++) {
    run_steps(&r, steps);
    for (uint32_t k = 0; k < lags; k++)
      if (n % lag[k].samples == 0)
        lag_look(&lag[k], &r, scratch);
  }
  const double s_end = nematic_order(&r.state, &r.model);
  printf("diameter,time,intervals,d2,d2_error,middle,middle_error,S_start,S_end\n");
  for (uint32_t k = 0; k < lags; k++)
    lag_print(&lag[k], &r, diameter, s_start, s_end);
  fprintf(stderr, "rigid %lu\n", (unsigned long)r.state.counts.rigid);
  free(scratch);
  run_end(&r);
  return 0;
}

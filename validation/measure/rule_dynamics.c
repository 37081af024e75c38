/*
 * Motion of fibers under crossing rules, compared: mean square displacements of vertices (g), of centers of mass (g_cm)
 * and from the tube (d^2, nearest point of the contour then), at the same temperature, in a bath of phantoms (no
 * hydrodynamics, gamma 5, dt_c 0.02, 90 degrees).
 *
 * usage: rule_dynamics CELLS FIBERS VERTICES KAPPA TIME RUNS SEED RULE:SCHEME:DT...
 *   Every choice makes RUNS runs of TIME t0, from the same equilibrium states and, at the same dt, with the same random
 *   numbers. Errors are from the scatter of runs; that of the difference from the first choice, of the runs'
 * differences.
 */
#include "../../tests/statistics.h"
#include "observe/dynamics.h"
#include "rules.h"

enum { LAGS = 8, CHOICES = 8 };
static const int lags[LAGS] = {1, 2, 5, 10, 20, 50, 100, 200}; /* t0 */

struct choice {
  const char *name;
  enum crossing_kind rule;
  enum scheme scheme;
  double dt;
  struct sample of[LAGS][3];
  double contacts, seconds, temperature;
};

/* One run: its means at each lag, from origins a quarter of the lag apart. */
static void measure(struct choice *c, const struct model *base, uint64_t seed, int time, double mean[LAGS][3])
{
  struct model m = *base;
  m.kind = NULL;
  m.kinds = 0;
  const struct fiber_kind *k = &base->kind[0];
  add_kind(&m, k->count, k->vertices)->bending = k->bending;
  m.time_step = c->dt;
  m.scheme = c->scheme;
  set_crossing(&m, c->rule);
  struct run run;
  run_start(&run, m, seed);
  const size_t n = run.model.vertices;
  const double start = cpu_seconds();
  struct point *at = malloc((size_t)(time + 1) * n * sizeof *at);
  struct vec3 *scratch = malloc(n * sizeof *scratch);
  if (!at || !scratch)
    exit(1);
  for (int t = 0; t <= time; t++) {
    if (t > 0)
      run_steps(&run, (uint64_t)(1.0 / c->dt + 0.5));
    memcpy(at + (size_t)t * n, run.state.position, n * sizeof *at);
    for (size_t v = 0; v < n; v++)
      c->temperature +=
          run.model.mass[v] * vec3_dot(run.state.velocity[v], run.state.velocity[v]) / 3.0 / (double)n / (time + 1);
  }
  c->seconds += cpu_seconds() - start;
  c->contacts += (double)run.state.counts.executed;
  for (int l = 0; l < LAGS && lags[l] <= time; l++) {
    const int every = lags[l] < 4 ? 1 : lags[l] / 4;
    double sum[3] = {0, 0, 0}, count = 0.0;
    for (int t = 0; t + lags[l] <= time; t += every)
      for (uint32_t f = 0; f < run.model.fibers; f++) {
        const size_t first = run.model.fiber_first[f];
        const struct fiber_motion motion =
            fiber_motion(&run.model.kind[0], at + (size_t)t * n + first, at + (size_t)(t + lags[l]) * n + first,
                         (struct vec3){0, 0, 0}, scratch);
        sum[0] += motion.vertices;
        sum[1] += motion.center;
        sum[2] += motion.tube_contour;
        count += 1.0;
      }
    for (int q = 0; q < 3; q++)
      mean[l][q] = sum[q] / count;
  }
  free(at);
  free(scratch);
  run_end(&run);
}

int main(int argc, char **argv)
{
  static struct choice choice[CHOICES];
  static struct sample difference[CHOICES][LAGS][3];
  static double mean[CHOICES][LAGS][3];
  const int choices = argc - 8;
  if (choices < 1 || choices > CHOICES) {
    fprintf(stderr, "usage: %s CELLS FIBERS VERTICES KAPPA TIME RUNS SEED RULE:SCHEME:DT...\n", argv[0]);
    return 2;
  }
  const int cells = atoi(argv[1]), time = atoi(argv[5]), runs = atoi(argv[6]);
  struct model base = standard_model(cells, cells, cells, 5, 0.01, 2);
  base.solvent.hydrodynamics = false;
  base.solvent.bath = BATH_PHANTOMS;
  add_kind(&base, (uint32_t)atoi(argv[2]), (uint32_t)atoi(argv[3]))->bending = atof(argv[4]);
  for (int c = 0; c < choices; c++) {
    char rule[32], scheme[32];
    choice[c].name = argv[8 + c];
    if (sscanf(argv[8 + c], "%31[^:]:%31[^:]:%lf", rule, scheme, &choice[c].dt) != 3)
      return 2;
    choice[c].rule = rule_of_word(rule);
    choice[c].scheme = scheme_of_word(scheme);
  }
  for (int r = 0; r < runs; r++)
    for (int c = 0; c < choices; c++) {
      measure(&choice[c], &base, strtoull(argv[7], NULL, 10) + (uint64_t)r, time, mean[c]);
      for (int l = 0; l < LAGS && lags[l] <= time; l++)
        for (int q = 0; q < 3; q++) {
          sample_add(&choice[c].of[l][q], mean[c][l][q]);
          sample_add(&difference[c][l][q], mean[c][l][q] - mean[0][l][q]);
        }
    }
  printf("choice,lag,g,g_error,g_difference,g_difference_error,g_cm,g_cm_error,g_cm_difference,g_cm_difference_error,"
         "d2,d2_error,d2_difference,d2_difference_error,contacts_per_t0,temperature,seconds_per_t0\n");
  for (int c = 0; c < choices; c++)
    for (int l = 0; l < LAGS && lags[l] <= time; l++) {
      printf("%s,%d", choice[c].name, lags[l]);
      for (int q = 0; q < 3; q++)
        printf(",%.6g,%.2g,%+.4f,%.4f", choice[c].of[l][q].mean, sample_error(&choice[c].of[l][q]),
               difference[c][l][q].mean / choice[0].of[l][q].mean,
               sample_error(&difference[c][l][q]) / choice[0].of[l][q].mean);
      printf(",%.5g,%.5f,%.3g\n", choice[c].contacts / runs / time, choice[c].temperature / runs,
             choice[c].seconds / runs / time);
    }
  free(base.kind);
  return 0;
}

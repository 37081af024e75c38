/*
 * Hydrodynamics off in two ways, the paper's velocity swap and the bath of phantoms (mpc/random_solvent.h), at the
 * paper's point: diffusion of loose vertices, diffusion of Gaussian chains and relaxation of their first two Rouse
 * modes, and the CPU time of each. The two run in turn, block by block, so that a busy machine slows both alike.
 */
#include "diffusion.h"
#include "measure.h"

enum { CHAIN = 10, CHAINS = 16, MODES = 3, DEPTH = 31 };

static const double pi = 3.14159265358979323846;
static const char *const names[] = {"velocity swap", "phantoms"};

static struct model without_hydrodynamics(enum bath bath)
{
  struct model m = standard_model(8, 8, 8, 5, 0.02, 1);
  m.solvent.hydrodynamics = false;
  m.solvent.bath = bath;
  return m;
}

static double per_vertex_and_step(double cpu, const struct run *run)
{
  return 1e9 * cpu / (double)run->state.step / run->state.vertices;
}

/* The swap spreads what n like bodies lose over all solvent particles, which then move the other way: a closed box
 * slows the mean of the bodies down, D of it by (M_solvent/M_total)^2, but not their motion relative to it. What is
 * left of the D of one. */
static double left_in_closed_box(const struct model *m, double n)
{
  return 1.0 - (1.0 - pow(m->solvent.particles / m->total_mass, 2.0)) / n;
}

/* --- loose vertices ----------------------------------------------------------------------------------------------- */

/* Mean square displacements between 0.6 and 1.8 t0, as in vertex_diffusion.c; phantoms `share` times as long. */
static void measure_vertices(uint32_t vertices, uint32_t rounds, uint32_t share)
{
  struct run run[2];
  struct sample d[2] = {{.n = 0.0}, {.n = 0.0}};
  double cpu[2] = {0.0, 0.0};
  for (int b = 0; b < 2; b++) {
    struct model m = without_hydrodynamics((enum bath)b);
    add_kind(&m, vertices, 1);
    run_start(&run[b], m, 31);
  }
  const double left = left_in_closed_box(&run[0].model, vertices);
  for (uint32_t round = 0; round < rounds; round++)
    for (int b = 0; b < 2; b++)
      for (uint32_t k = 0; k < (b ? share : 1); k++) {
        struct sample block;
        const double start = cpu_seconds();
        stop_unless(diffusion_run(&run[b].model, &run[b].state, &run[b].work, 30, 203, (uint32_t[]){1, 3}, &block),
                    &run[b]);
        cpu[b] += cpu_seconds() - start;
        sample_add(&d[b], block.mean);
      }
  for (int b = 0; b < 2; b++) {
    const double chaos = diffusion_chaos(&run[b].model);
    printf("%-14s %-9u %.6f    %.6f +- %.6f   %.4f +- %.4f     %7.0f\n", names[b], vertices, chaos, d[b].mean,
           sample_error(&d[b]), d[b].mean / chaos, sample_error(&d[b]) / chaos, per_vertex_and_step(cpu[b], &run[b]));
    run_end(&run[b]);
  }
  const double ratio = d[0].mean / left / d[1].mean;
  printf("%-14s %-9u %-40s%.4f +- %.4f\n", "swap/phantoms", vertices, "", ratio,
         ratio * hypot(sample_error(&d[0]) / d[0].mean, sample_error(&d[1]) / d[1].mean));
  fflush(stdout);
}

/* --- chains ------------------------------------------------------------------------------------------------------- */

struct chains {
  struct run run;
  struct vec3 (*past)[CHAINS][MODES]; /* [DEPTH] looks, 1 t0 apart */
  uint32_t looks;
  double cpu;
  struct sample kt, value[MODES]; /* D of the centre; mean square displacements of modes 1, 2 */
};

static const uint32_t mode_lag[MODES] = {15, 30, 10}, center_near = 5; /* t0 */

/* X_p = sqrt(2/N) sum cos(p pi (i + 1/2)/N) r_i of each chain; X_0: its centre of mass. */
static void take_modes(const struct state *state, struct vec3 (*mode)[MODES])
{
  memset(mode, 0, CHAINS * sizeof *mode);
  const struct point origin = {0, 0, 0};
  for (int c = 0; c < CHAINS; c++)
    for (int i = 0; i < CHAIN; i++) {
      const struct vec3 r = point_difference(state->position[c * CHAIN + i], origin);
      mode[c][0] = vec3_add_scaled(mode[c][0], 1.0 / CHAIN, r);
      for (int p = 1; p < MODES; p++)
        mode[c][p] = vec3_add_scaled(mode[c][p], sqrt(2.0 / CHAIN) * cos(p * pi * (i + 0.5) / CHAIN), r);
    }
}

/* Mean square displacement of a mode between now and `lag` looks ago. */
static double mode_displacement(const struct chains *s, int p, uint32_t lag)
{
  const uint32_t now = s->looks % DEPTH, then = (s->looks - lag) % DEPTH;
  double sum = 0.0;
  for (int c = 0; c < CHAINS; c++) {
    const struct vec3 move = vec3_sub(s->past[now][c][p], s->past[then][c][p]);
    sum += vec3_dot(move, move) / CHAINS;
  }
  return sum;
}

/* One entry per block of 100 t0. */
static void advance_block(struct chains *s)
{
  const double start = cpu_seconds();
  double sum[MODES] = {0.0}, kt = 0.0;
  for (int k = 0; k < 100; k++) {
    run_steps(&s->run, 50);
    take_modes(&s->run.state, s->past[++s->looks % DEPTH]);
    kt += diffusion_temperature(&s->run.state, &s->run.model) / 100.0;
    if (s->looks < DEPTH)
      continue;
    sum[0] += (mode_displacement(s, 0, mode_lag[0]) - mode_displacement(s, 0, center_near)) / 6.0 /
              (mode_lag[0] - center_near) / 100.0;
    for (int p = 1; p < MODES; p++)
      sum[p] += mode_displacement(s, p, mode_lag[p]) / 100.0;
  }
  s->cpu += cpu_seconds() - start;
  if (s->looks < 100 + DEPTH)
    return; /* the first block is short of past */
  sample_add(&s->kt, kt);
  for (int p = 0; p < MODES; p++)
    sample_add(&s->value[p], sum[p]);
}

/* Relaxation time of mode p from <dX^2> = 6 <X^2> (1 - exp(-t/tau)), <X^2> = kT/(4 k sin^2(p pi/2N)) per component. */
static double relaxation(const struct chains *s, int p, double spring, double *error)
{
  const double s2 = 1.0 / (4.0 * spring * pow(sin(p * pi / 2.0 / CHAIN), 2.0));
  const double kept = 1.0 - s->value[p].mean / s->kt.mean / (6.0 * s2), tau = -(double)mode_lag[p] / log(kept);
  *error = tau * tau / mode_lag[p] / kept * sample_error(&s->value[p]) / s->kt.mean / (6.0 * s2);
  return tau;
}

static void chains_start(struct chains *s, enum bath bath)
{
  struct model m = without_hydrodynamics(bath);
  struct fiber_kind *k = add_kind(&m, CHAINS, CHAIN);
  k->bond_length = 0.0;
  k->spring = 3.0;
  k->bending = 0.0;
  m.crossing.forbidden = false;
  memset(s, 0, sizeof *s);
  run_start(&s->run, m, 32);
  s->past = calloc(DEPTH, sizeof *s->past);
  stop_unless(s->past, &s->run);
}

static void print_ratio(const double value[2], const double error[2])
{
  const double ratio = value[0] / value[1];
  printf("  %.4f +- %.4f    ", ratio, ratio * hypot(error[0] / value[0], error[1] / value[1]));
}

static void measure_chains(uint32_t rounds, uint32_t share)
{
  struct chains s[2];
  double value[MODES][2], error[MODES][2];
  for (int b = 0; b < 2; b++)
    chains_start(&s[b], (enum bath)b);
  const double left = left_in_closed_box(&s[0].run.model, CHAINS);
  for (uint32_t round = 0; round < rounds; round++)
    for (int b = 0; b < 2; b++)
      for (uint32_t k = 0; k < (b ? share : 1); k++)
        advance_block(&s[b]);
  for (int b = 0; b < 2; b++) {
    value[0][b] = s[b].value[0].mean / s[b].kt.mean;
    error[0][b] = sample_error(&s[b].value[0]) / s[b].kt.mean;
    for (int p = 1; p < MODES; p++)
      value[p][b] = relaxation(&s[b], p, 3.0, &error[p][b]);
    printf("%-14s %.7f +- %.7f  %.1f +- %.1f    %.2f +- %.2f    %7.0f\n", names[b], value[0][b], error[0][b],
           value[1][b], error[1][b], value[2][b], error[2][b], per_vertex_and_step(s[b].cpu, &s[b].run));
    free(s[b].past);
    run_end(&s[b].run);
  }
  printf("%-14s", "swap/phantoms");
  value[0][0] /= left;
  error[0][0] /= left;
  for (int p = 0; p < MODES; p++)
    print_ratio(value[p], error[p]);
  printf("\n");
}

int main(int argc, char **argv)
{
  const double factor = effort(argc, argv);
  printf("swap/phantoms: without the closed box's part in the swap\n");
  printf("loose vertices, M = 5, in 8^3 cells; gamma 5, dt_c 0.02, 90 degrees\n");
  printf("%-14s %-9s %-11s %-22s %-20s %s\n", "", "vertices", "chaos", "D/kT", "D/chaos", "CPU ns/vertex/step");
  measure_vertices(8, 2 + (uint32_t)(factor * 240), 8);
  measure_vertices(32, 2 + (uint32_t)(factor * 100), 8);
  printf("%d Gaussian chains of %d vertices, k = 3, M = 5, in 8^3 cells, dt 0.02\n", CHAINS, CHAIN);
  printf("%-14s %-24s %-18s %-18s %s\n", "", "D/kT", "tau_1", "tau_2", "CPU ns/vertex/step");
  measure_chains(3 + (uint32_t)(factor * 200), 4);
  return 0;
}

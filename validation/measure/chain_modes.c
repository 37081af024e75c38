/*
 * Statics of fibers in a dense suspension, under any crossing rule: thin lines exclude no volume, so they are exactly
 * those of a phantom chain, in every mode. gamma 5, dt_c 0.02, canonical thermostat (maxwell-boltzmann).
 *
 * usage: chain_modes CELLS FIBERS VERTICES KAPPA RULE SCHEME DT TIME RUNS SEED
 *   RUNS runs of TIME t0, each from an equilibrium state of its own; looks every 0.5 t0 after 5 t0. Errors are from the
 *   scatter of the fibers' averages over time, RUNS x FIBERS of them.
 *
 * Rows: quantity, over exact, error, their difference from 1 in errors. Modes p = 1 ... N-1 have the weights
 * w_i = cos(pi p (i + 1/2)/N).
 *   x_p  mean square of sum_i w_i R_i over its exact value, sum_jk S_j S_k <b_j.b_k>, S_j = sum_{i>j} w_i: the bonds b
 *        have <b_j.b_j> = <l^2>, <b_j.b_k> = <l>^2 (coth kappa - 1/kappa)^|j-k|
 *   v_p  kinetic temperature of the mode, from the velocities that collisions see: on step; with drift-split, those of
 *        the drift
 */
#include "../../tests/statistics.h"
#include "rules.h"
#include "system/fiber_kind.h"
#include "theory/theory.h"

enum { MOST = 64, QUANTITIES = 4 + 2 * MOST };

struct averages {
  double looks, of[QUANTITIES]; /* <l>, <l^2>, <cos>, <R^2>, then x_p, then v_p from MOST on */
};

static double weight(uint32_t p, uint32_t i, uint32_t n)
{
  return cos(3.14159265358979323846 * p * (i + 0.5) / n);
}

static void expect(const struct fiber_kind *k, double *of)
{
  const uint32_t n = k->vertices;
  const double c = theory_bend_cosine(k->bending, 3), mean = fiber_mean_bond(k), square = theory_bond_square(k);
  of[0] = mean;
  of[1] = square;
  of[2] = c;
  of[3] = theory_end_to_end_square(k);
  for (uint32_t p = 1; p < n; p++) {
    double above[MOST] = {0}, sum = 0.0;
    for (uint32_t j = n - 1; j-- > 0;)
      above[j] = (j + 2 < n ? above[j + 1] : 0.0) + weight(p, j + 1, n);
    for (uint32_t j = 0; j + 1 < n; j++)
      for (uint32_t i = 0; i + 1 < n; i++)
        sum += above[i] * above[j] * (i == j ? square : mean * mean * pow(c, fabs((double)i - (double)j)));
    of[4 + p] = sum;
    of[4 + MOST + p] = 1.5 * n; /* sum of squared weights times 3 kT */
  }
}

/* a: [fibers] */
static void look(struct run *run, struct averages *averages)
{
  const struct state *s = &run->state;
  const struct model *m = &run->model;
  const uint32_t n = m->kind[0].vertices;
  stop_unless(fiber_forces(s, m, run->work.fiber.force, s->step, &run->work.fault), run);
  const double back = m->scheme == SCHEME_DRIFT_SPLIT ? 0.0 : 0.5 * m->time_step;
  for (uint32_t f = 0; f < m->fibers; f++) {
    const uint32_t first = m->fiber_first[f];
    struct averages *a = &averages[f];
    a->looks += 1.0;
    struct vec3 x[MOST] = {{0, 0, 0}}, v[MOST] = {{0, 0, 0}}, before = {0, 0, 0};
    for (uint32_t i = 0; i < n; i++) {
      const struct vec3 r = point_difference(s->position[first + i], s->position[first]),
                        at_collision = vec3_add_scaled(s->velocity[first + i], -back * m->inverse_mass[first + i],
                                                       run->work.fiber.force[first + i]);
      for (uint32_t p = 1; p < n; p++) {
        x[p] = vec3_add_scaled(x[p], weight(p, i, n), r);
        v[p] = vec3_add_scaled(v[p], weight(p, i, n), at_collision);
      }
      if (i + 1 == n) {
        a->of[3] += vec3_dot(r, r);
        break;
      }
      const struct vec3 b = point_difference(s->position[first + i + 1], s->position[first + i]);
      const double l = vec3_norm(b);
      a->of[0] += l / (n - 1);
      a->of[1] += l * l / (n - 1);
      if (i > 0)
        a->of[2] += vec3_dot(b, before) / (l * vec3_norm(before)) / (n - 2);
      before = b;
    }
    for (uint32_t p = 1; p < n; p++) {
      a->of[4 + p] += vec3_dot(x[p], x[p]);
      a->of[4 + MOST + p] += m->mass[first] * vec3_dot(v[p], v[p]);
    }
  }
}

static void print(const char *name, const struct sample *s)
{
  printf("%s,%.6f,%.2g,%+.2f\n", name, s->mean, sample_error(s), (s->mean - 1.0) / sample_error(s));
}

int main(int argc, char **argv)
{
  if (argc != 11 || atoi(argv[3]) > MOST) {
    fprintf(stderr, "usage: %s CELLS FIBERS VERTICES KAPPA RULE SCHEME DT TIME RUNS SEED\n", argv[0]);
    return 2;
  }
  const int cells = atoi(argv[1]), runs = atoi(argv[9]);
  const uint32_t n = (uint32_t)atoi(argv[3]);
  const double dt = atof(argv[7]), time = atof(argv[8]), start = cpu_seconds();
  struct sample of[QUANTITIES] = {{0}};
  double executed = 0.0;
  for (int r = 0; r < runs; r++) {
    struct model m = standard_model(cells, cells, cells, 5, dt, (uint32_t)(0.02 / dt + 0.5));
    set_crossing(&m, rule_of_word(argv[5]));
    m.scheme = scheme_of_word(argv[6]);
    m.solvent.thermostat = THERMOSTAT_MAXWELL_BOLTZMANN;
    add_kind(&m, (uint32_t)atoi(argv[2]), n)->bending = atof(argv[4]);
    struct run run;
    double expected[QUANTITIES] = {0};
    run_start(&run, m, strtoull(argv[10], NULL, 10) + (uint64_t)r);
    expect(&run.model.kind[0], expected);
    struct averages *a = calloc(run.model.fibers, sizeof *a);
    stop_unless(a, &run);
    run_steps(&run, (uint64_t)(5.0 / dt + 0.5));
    for (int k = 0; k < (int)(2.0 * time + 0.5); k++) {
      run_steps(&run, (uint64_t)(0.5 / dt + 0.5));
      look(&run, a);
    }
    for (uint32_t f = 0; f < run.model.fibers; f++)
      for (int q = 0; q < QUANTITIES; q++)
        if (expected[q] > 0.0)
          sample_add(&of[q], a[f].of[q] / a[f].looks / expected[q]);
    free(a);
    executed += (double)run.state.counts.executed;
    run_end(&run);
  }
  printf("# %s %s dt %s kappa %s: %.0f contacts, %.0f s\nquantity,over_exact,error,in_errors\n", argv[5], argv[6],
         argv[7], argv[4], executed, cpu_seconds() - start);
  const char *const names[] = {"l", "l2", "cos", "R2"};
  for (int q = 0; q < 4; q++)
    print(names[q], &of[q]);
  for (int what = 0; what < 2; what++)
    for (uint32_t p = 1; p < n; p++) {
      char name[16];
      snprintf(name, sizeof name, "%c_%u", what ? 'v' : 'x', p);
      print(name, &of[4 + what * MOST + p]);
    }
  return 0;
}

/* Errors of a time step and an order of drift, collision and kick, and what they cost: fibers in a small box.
 *
 * usage: precision SCENE TIME     TIME in t0; SCENE: scene.h
 *
 * Prints lines "quantity value error":
 *   cpu         CPU seconds per t0
 *   fault       the time at which the run had to stop, and then nothing else
 *   stiffest    mean square of the stiffest bending mode over its exact value, at the solvent's temperature
 *   bend        mean bend energy over its exact value
 *   drift       growth of the total energy, kT per t0 and degree of freedom
 *   msd         mean square displacement of vertices in 10 t0, ends left out (all of a fiber shorter than 5), a0^2
 *
 * The stiffest mode of N vertices is taken as S = sum_i w_i (u_{i+1} - u_i), w_i = (-1)^i sin(pi (i+1)/(n+1)), over its
 * n = N - 2 bends; u are unit vectors of bonds. Bonds' directions are a Markov chain with <u_i.u_j> = c^|i-j|, c = coth
 * kappa - 1/kappa, whence <S.S> = sum_ij w_i w_j B_ij,   B_ii = 2 (1 - c),   B_ij = -c^(|i-j|-1) (1 - c)^2. */
#include "../measure/energy.h"
#include "scene.h"
#include "statistics.h"

#define LOOK 0.1    /* t0 between looks */
#define SETTLED 5.0 /* t0 before the first that counts */
#define LAG 100     /* looks: 10 t0 */
#define BLOCK 400   /* looks: 40 t0 */

static double mode_weight(uint32_t i, uint32_t bends)
{
  return (i % 2 ? -1.0 : 1.0) * sin(3.14159265358979323846 * (i + 1) / (bends + 1));
}

static double mode_expected(uint32_t bends, double c)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < bends; i++)
    for (uint32_t j = 0; j < bends; j++) {
      const double apart = fabs((double)i - (double)j);
      const double b = i == j ? 2.0 * (1.0 - c) : -pow(c, apart - 1.0) * (1.0 - c) * (1.0 - c);
      sum += mode_weight(i, bends) * mode_weight(j, bends) * b;
    }
  return sum;
}

static struct vec3 bond_direction(const struct state *state, uint32_t v)
{
  const struct vec3 bond = point_difference(state->position[v + 1], state->position[v]);
  return vec3_scale(1.0 / sqrt(vec3_dot(bond, bond)), bond);
}

/* Mean of S.S over the fibers, which are all alike. */
static double mode_square(const struct run *run)
{
  const struct model *m = &run->model;
  const uint32_t bends = m->kind[0].vertices - 2;
  double sum = 0.0;
  for (uint32_t f = 0; f < m->fibers; f++) {
    struct vec3 s = {0, 0, 0}, before = bond_direction(&run->state, m->fiber_first[f]);
    for (uint32_t i = 0; i < bends; i++) {
      const struct vec3 after = bond_direction(&run->state, m->fiber_first[f] + i + 1);
      s = vec3_add_scaled(s, mode_weight(i, bends), vec3_sub(after, before));
      before = after;
    }
    sum += vec3_dot(s, s);
  }
  return sum / m->fibers;
}

/* Mean square displacement of inner vertices since `past`. */
static double displacement(const struct run *run, const struct point *past)
{
  const struct model *m = &run->model;
  const uint32_t n = m->kind[0].vertices, skip = n < 5 ? 0 : 2;
  double sum = 0.0;
  for (uint32_t v = 0; v < m->vertices; v++) {
    const uint32_t place = v % n;
    if (place < skip || place + skip >= n)
      continue;
    const struct vec3 d = point_difference(run->state.position[v], past[v]);
    sum += vec3_dot(d, d);
  }
  return sum / m->fibers / (n - 2 * skip);
}

static void print_sample(const char *name, const struct sample *s)
{
  printf("%s %.8g %.3g\n", name, s->mean, sample_error(s));
}

struct measured {
  struct blocks stiffest, bend, msd;
  struct line energy, part[4];
};

static void look(struct run *run, struct point *past, uint32_t n, uint32_t looks, struct measured *m)
{
  const struct fiber_kind *kind = &run->model.kind[0];
  const size_t vertices = run->model.vertices;
  const double kappa = kind->bending, c = 1.0 / tanh(kappa) - 1.0 / kappa;
  const struct energy e = energy_on_step(&run->state, &run->model, &run->work);
  const double kt = e.solvent / (1.5 * run->state.solvent.n * (1.0 - 1.0 / run->model.total_mass));
  struct point *slot = past + n % LAG * vertices;
  if (n >= LAG)
    blocks_add(&m->msd, displacement(run, slot));
  memcpy(slot, run->state.position, vertices * sizeof *slot);
  if (kind->vertices > 2) {
    blocks_add(&m->stiffest, mode_square(run) / mode_expected(kind->vertices - 2, c) / kt);
    blocks_add(&m->bend, e.bends / run->model.fibers / (kind->vertices - 2) / (kappa * (1.0 - c)) / kt);
  }
  line_add(&m->energy, LOOK * n, energy_total(&e));
  line_add(&m->part[4 * (uint64_t)n / looks], LOOK * n, energy_total(&e));
}

/* Some steps; false, with the time told, if the run has to stop. */
static bool advance(struct run *run, uint64_t steps)
{
  for (uint64_t k = 0; k < steps; k++)
    if (!step_advance(&run->state, &run->model, &run->work, NULL)) {
      printf("fault %.6g 0\n", run->model.time_step * (double)run->state.step);
      return false;
    }
  return true;
}

static void print_measured(const struct measured *m, const struct run *run, double cpu)
{
  struct sample slopes = {0};
  for (int p = 0; p < 4; p++)
    sample_add(&slopes, line_slope(&m->part[p]));
  const double freedoms = 3.0 * (run->model.solvent.particles + run->model.vertices);
  printf("cpu %.6g 0\n", cpu);
  print_sample("stiffest", &m->stiffest.of_blocks);
  print_sample("bend", &m->bend.of_blocks);
  print_sample("msd", &m->msd.of_blocks);
  printf("drift %.6g %.3g\n", line_slope(&m->energy) / freedoms, sample_error(&slopes) / freedoms);
}

int main(int argc, char **argv)
{
  const double time = argc == 3 ? atof(argv[2]) : 0.0;
  const uint32_t looks = (uint32_t)(time / LOOK);
  if (looks < 2 * BLOCK) {
    fprintf(stderr, "usage: precision SCENE TIME; TIME of at least %g t0\n", 2 * BLOCK * LOOK);
    return 2;
  }
  const struct scene scene = scene_parse(argv[1]);
  struct run run;
  run_start(&run, scene_model(&scene), 31);
  const uint64_t steps = (uint64_t)(LOOK / scene.dt + 0.5);
  struct point *past = calloc((size_t)LAG * run.model.vertices, sizeof *past);
  if (!past)
    return 1;
  struct measured m = {.stiffest = {.length = BLOCK}, .bend = {.length = BLOCK}, .msd = {.length = BLOCK}};
  bool ok = advance(&run, (uint64_t)(SETTLED / scene.dt));
  double seconds = 0.0;
  for (uint32_t n = 0; ok && n < looks; n++) {
    look(&run, past, n, looks, &m);
    const double begin = cpu_seconds();
    ok = advance(&run, steps);
    seconds += cpu_seconds() - begin;
  }
  if (ok)
    print_measured(&m, &run, seconds / (LOOK * looks));
  free(past);
  run_end(&run);
  return 0;
}

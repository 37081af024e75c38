/* What an error bar costs: transport coefficients by several estimators, each with its error and the CPU time it took.
 *
 * usage: efficiency wave SCENE TIME         viscosity from decaying shear waves, (shear_wave.h), in SCENE's box
 *        efficiency current SCENE TIME      viscosity from the decay of the thermal transverse currents of a solvent
 *        efficiency diffusion SCENE TIME SHORT LONG
 *                                           diffusion of the fibers' centers of mass: growth of their mean square
 * displacement from lag SHORT to lag LONG, and velocity times displacement since (SHORT + LONG)/2
 *
 * Times in t0. Prints lines "estimator value error CPU-seconds"; scenes: scene.h. */
#include "../measure/diffusion.h"
#include "../measure/shear_wave.h"
#include "scene.h"

static void print_line(const char *name, double value, double error, double seconds)
{
  printf("%s %.8g %.3g %.4g\n", name, value, error, seconds);
}

/* --- viscosity ---------------------------------------------------------------------------------------------------- */

#define NU 2.15 /* a0^2/t0, for weights and lags only */

static void wave(const struct scene *scene, double time)
{
  struct model m = scene_model(scene);
  const double k = 6.283185307179586477 / scene->cells, decay = 1.0 / (NU * k * k), interval = 4 * 0.02;
  const uint32_t last = (uint32_t)(2.0 * decay / interval) + 4;
  const struct shear_wave shape = {0.4, NU, 4, 4, last};
  struct state state;
  struct work work;
  struct ratio lambda = {0};
  double *amplitude = calloc(last + 1, sizeof *amplitude);
  finish(&m);
  if (!amplitude || !state_alloc(&state, &m) || !work_alloc(&work, &m))
    exit(1);
  const double begin = cpu_seconds();
  const uint32_t pairs = 2 + (uint32_t)(time / (2.0 * last * interval));
  for (uint32_t p = 0; p < pairs; p++)
    if (!shear_wave_pair(&m, &state, &work, &shape, 3000 + p, amplitude, &lambda))
      exit(1);
  const double correction = 1.0 - k * k / 30.0;
  print_line("wave", shear_wave_viscosity(&m, &shape, &lambda) / correction,
             shear_wave_error(&m, &shape, &lambda) / correction, cpu_seconds() - begin);
  free(amplitude);
  work_free(&work);
  state_free(&state);
  model_free(&m);
}

#define MODES 12 /* three directions of k, two of the velocity, cosine and sine */

/* Transverse currents of the smallest wave numbers of a cubic box, right after a collision. */
static void currents(const struct state *state, double k, double a[MODES])
{
  const struct solvent *s = &state->solvent;
  const int64_t *x[3] = {s->x, s->y, s->z};
  const double *v[3] = {s->vx, s->vy, s->vz};
  for (int mode = 0; mode < MODES; mode++)
    a[mode] = 0.0;
  for (int d = 0; d < 3; d++)
    for (uint32_t i = 0; i < s->n; i++) {
      const double phase = k * (double)x[d][i] * LATTICE_UNIT, c = cos(phase), q = sin(phase);
      const double first = v[(d + 1) % 3][i], second = v[(d + 2) % 3][i];
      a[4 * d] += c * first;
      a[4 * d + 1] += q * first;
      a[4 * d + 2] += c * second;
      a[4 * d + 3] += q * second;
    }
}

/* nu = ln[C(t_1)/C(t_2)] / [k^2 (t_2 - t_1)], C the autocorrelation of the currents; t_1 is beyond the transient. */
static void current(const struct scene *scene, double time)
{
  const double k = 6.283185307179586477 / scene->cells, decay = 1.0 / (NU * k * k), interval = 4 * 0.02;
  const uint32_t first = 4, last = first + (uint32_t)(decay / interval + 1.0), looks = (uint32_t)(time / interval);
  const uint32_t depth = last + 1, block = 20 * last;
  double(*past)[MODES] = calloc(depth, sizeof *past);
  struct run run;
  struct ratio lambda = {0};
  double before = 0.0, after = 0.0;
  if (!past)
    exit(1);
  const double begin = cpu_seconds();
  run_start(&run, scene_model(scene), 41);
  for (uint32_t n = 0; n < looks; n++) {
    run_steps(&run, 4 * run.model.solvent.interval_steps);
    double *now = past[n % depth];
    currents(&run.state, k, now);
    for (int mode = 0; n >= last && mode < MODES; mode++) {
      before += now[mode] * past[(n - first) % depth][mode];
      after += now[mode] * past[(n - last) % depth][mode];
    }
    if (n >= last && n % block == 0) {
      ratio_add(&lambda, after, before);
      before = after = 0.0;
    }
  }
  const double rate = k * k * (last - first) * interval, correction = 1.0 - k * k / 30.0;
  print_line("current", -log(ratio_value(&lambda)) / rate / correction,
             ratio_error(&lambda) / ratio_value(&lambda) / rate / correction, cpu_seconds() - begin);
  free(past);
  run_end(&run);
}

/* --- diffusion ---------------------------------------------------------------------------------------------------- */

static void centers(const struct run *run, struct vec3 *center, const struct point *origin)
{
  const struct model *m = &run->model;
  for (uint32_t f = 0; f < m->fibers; f++) {
    const uint32_t first = m->fiber_first[f], end = m->fiber_first[f + 1];
    struct vec3 sum = {0, 0, 0};
    for (uint32_t v = first; v < end; v++)
      sum = vec3_add(sum, point_difference(run->state.position[v], origin[v]));
    center[f] = vec3_scale(1.0 / (end - first), sum);
  }
}

/* Of one look: growth of the mean square displacement, and the exact derivative of it in discrete time, from the
 * displacement d of the next step: [<(x + d - x_0)^2> - <(x - x_0)^2>]/6 dt = <d.(x - x_0)>/3 dt + <d.d>/6 dt. */
struct estimate {
  double slope, green_kubo;
};

static struct estimate estimate(const struct model *m, const struct vec3 *now, const struct vec3 *next,
                                const struct vec3 *near, const struct vec3 *middle, const struct vec3 *far, double time)
{
  struct estimate e = {0, 0};
  for (uint32_t f = 0; f < m->fibers; f++) {
    const struct vec3 a = vec3_sub(now[f], near[f]), b = vec3_sub(now[f], far[f]), d = vec3_sub(next[f], now[f]);
    e.slope += (vec3_dot(b, b) - vec3_dot(a, a)) / 6.0 / time;
    e.green_kubo += (vec3_dot(d, vec3_sub(now[f], middle[f])) / 3.0 + vec3_dot(d, d) / 6.0) / m->time_step;
  }
  e.slope /= m->fibers;
  e.green_kubo /= m->fibers;
  return e;
}

static void diffusion(const struct scene *scene, double time, double from, double to)
{
  const double interval = 0.2;
  const uint32_t near = (uint32_t)(from / interval), far = (uint32_t)(to / interval), middle = (near + far) / 2;
  const uint32_t looks = (uint32_t)(time / interval), depth = far + 1;
  const uint64_t steps = (uint64_t)(interval / scene->dt + 0.5);
  struct run run;
  const double begin = cpu_seconds();
  run_start(&run, scene_model(scene), 43);
  const struct model *m = &run.model;
  struct vec3 *past = calloc((size_t)(depth + 1) * m->fibers, sizeof *past), *next = past + (size_t)depth * m->fibers;
  struct point *origin = calloc(m->vertices, sizeof *origin);
  struct blocks slope = {.length = 2 * far}, green_kubo = {.length = 2 * far};
  if (!past || !origin)
    exit(1);
  memcpy(origin, run.state.position, m->vertices * sizeof *origin);
  const double kt =
      diffusion_temperature(&run.state, m); /* of phantoms in a closed box it stays; bonds hold none yet */
  for (uint32_t n = 0; n < looks; n++) {
    struct vec3 *now = past + (size_t)(n % depth) * m->fibers;
    centers(&run, now, origin);
    run_steps(&run, 1);
    centers(&run, next, origin);
    run_steps(&run, steps - 1);
    if (n < far)
      continue;
    const struct estimate e = estimate(m, now, next, past + (size_t)((n - near) % depth) * m->fibers,
                                       past + (size_t)((n - middle) % depth) * m->fibers,
                                       past + (size_t)((n - far) % depth) * m->fibers, (far - near) * interval);
    blocks_add(&slope, e.slope / kt);
    blocks_add(&green_kubo, e.green_kubo / kt);
  }
  const double seconds = cpu_seconds() - begin;
  print_line("msd", slope.of_blocks.mean, sample_error(&slope.of_blocks), seconds);
  print_line("green-kubo", green_kubo.of_blocks.mean, sample_error(&green_kubo.of_blocks), seconds);
  free(past);
  free(origin);
  run_end(&run);
}

int main(int argc, char **argv)
{
  const double time = argc > 3 ? atof(argv[3]) : 0.0;
  if (argc > 3 && time > 0.0) {
    const struct scene scene = scene_parse(argv[2]);
    if (argc == 4 && strcmp(argv[1], "wave") == 0)
      return wave(&scene, time), 0;
    if (argc == 4 && strcmp(argv[1], "current") == 0)
      return current(&scene, time), 0;
    if (argc == 6 && strcmp(argv[1], "diffusion") == 0 && atof(argv[5]) > atof(argv[4]))
      return diffusion(&scene, time, atof(argv[4]), atof(argv[5])), 0;
  }
  fprintf(stderr, "usage: efficiency wave|current SCENE TIME, or efficiency diffusion SCENE TIME SHORT LONG\n");
  return 2;
}

/*
 * A filament (medium: {kind: overdamped, inextensible: true}) under a force, of N vertices with the radius A: B = F
 * L^2/ kappa, L = N - 1 bonds, F the force on all vertices together. Units b = mu_0 = kappa = 1: bond, mobility of a
 * vertex, bending rigidity. Shapes are deterministic, so there are no errors but those of the step.
 *
 *   filament across N A DT TIME TILT B ...            under a constant force along z; TILT: of the straight start,
 * radians from the direction across the force. A row per B, of the second half of the time: depth: middle ahead of the
 * ends, over L; ends: distance of the ends, over L; their least and greatest; angle: of the ends to the direction
 * across the force, at the end; speed: of the mean along the force, over that of a loose vertex; turns: how often the
 *                                                     ends have changed sides
 *   filament rotating N A DT TIME B RATE ...          under a force that turns about z, straight at 45 degrees to z. A
 * row per RATE (radians per time; 0: a constant force, along which z is then): decay: of ln tan(angle to z), or of that
 * to the direction across the constant force; rises: how many turns have ended with a larger angle to z than the one
 * before
 */
#include "measure.h"

static const double pi = 3.14159265358979323846;

struct question {
  uint32_t vertices;
  double radius, dt, time;
};

struct vertex_row {
  struct vec3 ends, ahead, mean; /* first to last; middle less the mean of the ends; mean of all */
};

static struct run filament(const struct question *q, struct vec3 along, struct vec3 force)
{
  struct run run;
  struct model m;
  memset(&m, 0, sizeof m);
  m.box = box_of_cells(64, 64, 64);
  m.time_step = q->dt;
  m.scheme = SCHEME_KICK_SPLIT;
  m.medium = (struct medium_model){
      .kind = MEDIUM_OVERDAMPED, .rate = 1.0, .tensor = TENSOR_RPY, .radius = q->radius, .inextensible = true};
  struct fiber_kind *k = add_kind(&m, 1, q->vertices);
  k->mass = k->bond_length = k->bending = 1.0;
  k->spring = 100.0;
  k->force = force;
  k->start = START_STRAIGHT;
  run_start(&run, m, 1);
  for (uint32_t v = 0; v < q->vertices; v++)
    run.state.position[v] = point_move((struct point){0, 0, 0}, vec3_scale(v, along));
  return run;
}

static struct vertex_row look(const struct run *run)
{
  const struct point *at = run->state.position;
  const uint32_t n = run->state.vertices;
  const struct vec3 first = point_in_a0(at[0]), last = point_in_a0(at[n - 1]), middle = point_in_a0(at[n / 2]);
  struct vertex_row row = {vec3_sub(last, first), vec3_add_scaled(middle, -0.5, vec3_add(first, last)), {0, 0, 0}};
  for (uint32_t v = 0; v < n; v++)
    row.mean = vec3_add_scaled(row.mean, 1.0 / n, point_in_a0(at[v]));
  return row;
}

static double force_of(const struct question *q, double b)
{
  const double length = q->vertices - 1.0;
  return b / (length * length * q->vertices);
}

static void across(const struct question *q, double tilt, double b)
{
  const double length = q->vertices - 1.0, force = force_of(q, b);
  const uint64_t steps = (uint64_t)llround(0.5 * q->time / q->dt);
  struct run run = filament(q, (struct vec3){cos(tilt), 0, sin(tilt)}, (struct vec3){0, 0, force});
  const double before = cpu_seconds();
  int turns = 0;
  bool left = false;
  double least = length, most = 0.0;
  run_steps(&run, steps);
  struct vertex_row row = look(&run);
  const double start = row.mean.z;
  left = row.ends.x < 0.0;
  for (uint64_t k = 0; k < steps; k++) {
    run_steps(&run, 1);
    row = look(&run);
    turns += (row.ends.x < 0.0) != left;
    left = row.ends.x < 0.0;
    least = fmin(least, vec3_norm(row.ends));
    most = fmax(most, vec3_norm(row.ends));
  }
  printf("%g,%.8g,%.8g,%.8g,%.8g,%.6g,%.8g,%d,%.1f\n", b, row.ahead.z / length, vec3_norm(row.ends) / length,
         least / length, most / length, atan2(row.ends.z, row.ends.x), (row.mean.z - start) / (steps * q->dt) / force,
         turns, cpu_seconds() - before);
  fflush(stdout);
  run_end(&run);
}

/* To z; or of a constant force along z, to the direction across it. */
static double angle(const struct run *run, double rate)
{
  const struct vec3 ends = look(run).ends;
  const double along = fabs(ends.z), beside = hypot(ends.x, ends.y);
  return rate == 0.0 ? atan2(along, beside) : atan2(beside, along);
}

static void rotating(const struct question *q, double b, double rate)
{
  const double force = force_of(q, b), half = sqrt(0.5), period = rate > 0.0 ? 2.0 * pi / rate : q->time / 20.0;
  const uint64_t steps = (uint64_t)llround(period / q->dt), rounds = (uint64_t)(q->time / period);
  struct run run = filament(q, (struct vec3){half, 0, half}, (struct vec3){0, 0, force});
  const double before = cpu_seconds();
  double first = 0.0, last = 0.0;
  uint32_t rises = 0;
  for (uint64_t round = 0; round < rounds; round++) {
    for (uint64_t k = 0; k < steps; k++) {
      const double phase = 2.0 * pi * k / steps;
      if (rate > 0.0)
        run.model.kind[0].force = (struct vec3){force * cos(phase), force * sin(phase), 0};
      run_steps(&run, 1);
    }
    const double now = angle(&run, rate);
    rises += round > 0 && now > last;
    first = round == 0 ? now : first;
    last = now;
  }
  const double decay = log(tan(first) / tan(last)) / ((rounds - 1) * steps * q->dt);
  printf("%g,%g,%.8g,%.8g,%.8g,%u,%llu,%.1f\n", b, rate, first, last, decay, rises, (unsigned long long)rounds,
         cpu_seconds() - before);
  fflush(stdout);
  run_end(&run);
}

int main(int argc, const char **argv)
{
  if (argc < 8) {
    fprintf(stderr, "usage: %s across N A DT TIME TILT B ...\n       %s rotating N A DT TIME B RATE ...\n", argv[0],
            argv[0]);
    return 2;
  }
  const bool turns = strcmp(argv[1], "rotating") == 0;
  const struct question q = {(uint32_t)atoi(argv[2]), atof(argv[3]), atof(argv[4]), atof(argv[5])};
  puts(turns ? "B,rate,first,last,decay,rises,rounds,seconds" : "B,depth,ends,least,most,angle,speed,turns,seconds");
  for (int k = 7; k < argc; k++)
    if (turns)
      rotating(&q, atof(argv[6]), atof(argv[k]));
    else
      across(&q, atof(argv[6]), atof(argv[k]));
  return 0;
}

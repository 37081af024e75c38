/* CPU time of the main loop, several scenes in turn: a block of steps of each, then the next round. Ratios between
 * scenes of one round hold when the machine's speed drifts. A scene "triad=MB" is the floor: c = a + s b over three
 * arrays of so many megabytes in all.
 *
 * usage: steps ROUNDS SECONDS SCENE ...     SECONDS: least length of a block. Scenes: scene.h
 *
 * Prints a line per block, tab-separated: round, number of the scene, steps, CPU seconds; and at last the most memory
 * that the process had, as "peak", kB. A block holds whole periods of the solvent's sorting by cell. Round 0 warms up
 * and is not printed. */
#include <time.h>

#include "base/memory.h"
#include "scene.h"

#define COLLISIONS_PER_BLOCK 100 /* as many as lie between two sorts, or a multiple */

#define SETTLING_STEPS 100

struct contender {
  bool triad;
  struct run run;
  size_t length; /* of each array of the triad */
  double *a, *b, *c;
  uint64_t block; /* steps at a time */
};

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Not inlined, and s not known before: or the compiler would leave the work out. */
static void __attribute__((noinline))
triad(double *restrict c, const double *restrict a, const double *restrict b, double s, size_t n)
{
  for (size_t i = 0; i < n; i++)
    c[i] = a[i] + s * b[i];
}

static void advance(struct contender *c, uint64_t steps)
{
  if (!c->triad)
    run_steps(&c->run, steps);
  for (uint64_t k = 0; c->triad && k < steps; k++)
    triad(c->c, c->a, c->b, 1e-3 * (double)k, c->length);
}

static void start(struct contender *c, const char *text)
{
  c->triad = strncmp(text, "triad=", 6) == 0;
  if (!c->triad) {
    const struct scene scene = scene_parse(text);
    run_start(&c->run, scene_model(&scene), 5);
    c->block = (scene.per_cell > 0.0 ? COLLISIONS_PER_BLOCK : 1) * (uint64_t)c->run.model.solvent.interval_steps;
    return;
  }
  c->length = (size_t)(atof(text + 6) * 1e6 / 24.0);
  c->a = memory_alloc(c->length, sizeof *c->a); /* in large pages, as what the program works on */
  c->b = memory_alloc(c->length, sizeof *c->b);
  c->c = memory_alloc(c->length, sizeof *c->c);
  c->block = 1;
  if (!c->a || !c->b || !c->c || c->length == 0) {
    fprintf(stderr, "steps: no memory for '%s'\n", text);
    exit(1);
  }
  for (size_t i = 0; i < c->length; i++)
    c->a[i] = c->b[i] = c->c[i] = (double)i;
}

/* Warms up, and makes blocks long enough. At the start all vertices stand where their reference positions are, and none
 * needs a new one for some 20 steps: what comes first is cheaper than what follows. */
static void warm_up(struct contender *c, double seconds)
{
  if (!c->triad)
    run_steps(&c->run, SETTLING_STEPS);
  const double begin = now();
  uint64_t blocks = 0;
  do {
    advance(c, c->block);
    blocks++;
  } while (now() - begin < seconds);
  c->block *= blocks;
}

/* Greatest resident set so far, kB (Linux); what getrusage says may be that of the process that started this one. */
static long peak_memory(void)
{
  char line[256];
  long kilobytes = 0;
  FILE *f = fopen("/proc/self/status", "r");
  while (f && fgets(line, sizeof line, f))
    if (strncmp(line, "VmHWM:", 6) == 0)
      kilobytes = atol(line + 6);
  if (f)
    fclose(f);
  return kilobytes;
}

int main(int argc, char **argv)
{
  const int rounds = argc > 3 ? atoi(argv[1]) : 0, n = argc - 3;
  const double seconds = argc > 3 ? atof(argv[2]) : 0.0;
  if (rounds < 1 || n < 1) {
    fprintf(stderr, "usage: steps ROUNDS SECONDS SCENE ...\n");
    return 2;
  }
  struct contender *c = calloc((size_t)n, sizeof *c);
  if (!c)
    return 1;
  for (int k = 0; k < n; k++) {
    start(&c[k], argv[k + 3]);
    warm_up(&c[k], seconds);
  }
  for (int round = 1; round <= rounds; round++)
    for (int k = 0; k < n; k++) {
      const double begin = now();
      advance(&c[k], c[k].block);
      printf("%d\t%d\t%llu\t%.6f\n", round, k, (unsigned long long)c[k].block, now() - begin);
      fflush(stdout);
    }
  printf("peak\t%ld\n", peak_memory());
  for (int k = 0; k < n; k++) {
    if (!c[k].triad)
      run_end(&c[k].run);
    free(c[k].a);
    free(c[k].b);
    free(c[k].c);
  }
  free(c);
  return 0;
}

/* CPU time of the main loop, several scenes in turn: a block of steps of each, then the next round. Ratios between
 * scenes of one round hold when the machine's speed drifts.
 *
 * usage: steps ROUNDS SECONDS SCENE ...     SECONDS: least length of a block. A SCENE is one of
 *
 *   cells=32,fibers=100       keys of scene.h: the main loop alone
 *   FILE.yaml KEY=VALUE ...   a scene file with settings, as for `uncross run --set`, in one argument: a run in a
 *                             folder of its own, below $TMPDIR, with all that the scene asks for; removed at the end
 *   triad=MB                  the floor: c = a + s b over three arrays of so many megabytes in all
 *
 * Prints a line per block, tab-separated: round, number of the scene, steps, CPU seconds; for each scene file
 * "members", its number, and how many particles and vertices it has; and at last the most memory that the process had,
 * as "peak", kB. A block holds whole periods of the solvent's sorting by cell. Round 0 warms up and is not printed. */
#define _XOPEN_SOURCE 700 /* nftw. NOLINT(bugprone-reserved-identifier) */

#include <ftw.h>
#include <time.h>
#include <unistd.h>

#include "base/memory.h"
#include "scene.h"
#include "uncross.h"

#define COLLISIONS_PER_BLOCK 100 /* as many as lie between two sorts, or a multiple */

#define SETTLING_STEPS 100

struct contender {
  const struct sort *sort;
  uint64_t block; /* steps at a time */
  struct run run;
  uncross_run *file;
  char folder[512];
  size_t length; /* of each array of the triad */
  double *a, *b, *c;
};

/* A way to say what is measured. */
struct sort {
  bool (*is)(const char *text);
  void (*start)(struct contender *c, const char *text); /* sets c->block, too */
  void (*advance)(struct contender *c, uint64_t steps);
  void (*end)(struct contender *c);
  uint64_t settling; /* steps before blocks are measured */
};

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* --- the triad --------------------------------------------------------------------------------------------------- */

static bool triad_is(const char *text)
{
  return strncmp(text, "triad=", 6) == 0;
}

static void triad_start(struct contender *c, const char *text)
{
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

/* Not inlined, and s not known before: or the compiler would leave the work out. */
static void __attribute__((noinline))
triad(double *restrict c, const double *restrict a, const double *restrict b, double s, size_t n)
{
  for (size_t i = 0; i < n; i++)
    c[i] = a[i] + s * b[i];
}

static void triad_advance(struct contender *c, uint64_t steps)
{
  for (uint64_t k = 0; k < steps; k++)
    triad(c->c, c->a, c->b, 1e-3 * (double)k, c->length);
}

static void triad_end(struct contender *c)
{
  free(c->a);
  free(c->b);
  free(c->c);
}

/* --- a scene file ------------------------------------------------------------------------------------------------ */

enum { MOST_SETTINGS = 32, MOST_TEXT = 4096, LONGEST_RUN = 1 << 30 };

static void stop(const uncross_error *error)
{
  fprintf(stderr, "steps: %s\n", error->message);
  exit(error->code);
}

static bool file_is(const char *text)
{
  return strstr(text, ".yaml") != NULL;
}

static uncross_scene *read_scene(const char *text, uncross_error *error)
{
  char words[MOST_TEXT];
  const char *path = words, *setting[MOST_SETTINGS];
  size_t settings = 0;
  if ((size_t)snprintf(words, sizeof words, "%s", text) >= sizeof words)
    return NULL;
  for (char *p = strchr(words, ' '); p && settings < MOST_SETTINGS; p = strchr(p, ' ')) {
    *p++ = '\0';
    setting[settings++] = p;
  }
  return uncross_scene_read(path, setting, settings, error);
}

static void file_start(struct contender *c, const char *text)
{
  uncross_error error = {.code = UNCROSS_BAD_INPUT, .message = "a scene in too many words"};
  const char *below = getenv("TMPDIR");
  uncross_scene *scene = read_scene(text, &error);
  double step = 0.0, interval = 0.0;
  snprintf(c->folder, sizeof c->folder, "%s/uncross-bench-XXXXXX", below ? below : "/tmp");
  if (!scene || uncross_scene_set_steps(scene, LONGEST_RUN, &error) != UNCROSS_OK ||
      uncross_scene_number(scene, "time_step", &step, &error) != UNCROSS_OK)
    stop(&error);
  if (uncross_scene_number(scene, "solvent.collision_interval", &interval, &error) != UNCROSS_OK)
    interval = step; /* a medium has none */
  if (!mkdtemp(c->folder)) {
    perror(c->folder);
    exit(1);
  }
  c->file = uncross_run_open(scene, c->folder, UNCROSS_NEW, &error);
  uncross_scene_free(scene);
  if (!c->file)
    stop(&error);
  c->block = COLLISIONS_PER_BLOCK * (uint64_t)fmax(1.0, nearbyint(interval / step));
}

static void file_advance(struct contender *c, uint64_t steps)
{
  uncross_error error;
  if (uncross_run_advance(c->file, steps, NULL, NULL, &error) != UNCROSS_OK)
    stop(&error);
}

static int take_away(const char *path, const struct stat *status, int kind, struct FTW *where)
{
  (void)status;
  (void)kind;
  (void)where;
  return remove(path);
}

static void file_end(struct contender *c)
{
  uncross_run_free(c->file);
  nftw(c->folder, take_away, 4, FTW_DEPTH | FTW_PHYS);
}

/* --- keys -------------------------------------------------------------------------------------------------------- */

static bool keys_are(const char *text)
{
  (void)text;
  return true;
}

static void keys_start(struct contender *c, const char *text)
{
  const struct scene scene = scene_parse(text);
  run_start(&c->run, scene_model(&scene), 5);
  c->block = (scene.per_cell > 0.0 ? COLLISIONS_PER_BLOCK : 1) * (uint64_t)c->run.model.solvent.interval_steps;
}

static void keys_advance(struct contender *c, uint64_t steps)
{
  run_steps(&c->run, steps);
}

static void keys_end(struct contender *c)
{
  run_end(&c->run);
}

/* --- in turn ----------------------------------------------------------------------------------------------------- */

static const struct sort sorts[] = {
    {triad_is, triad_start, triad_advance, triad_end, 0},
    {file_is, file_start, file_advance, file_end, SETTLING_STEPS},
    {keys_are, keys_start, keys_advance, keys_end, SETTLING_STEPS},
};

static void start(struct contender *c, const char *text)
{
  for (c->sort = sorts; !c->sort->is(text);)
    c->sort++;
  c->sort->start(c, text);
}

/* Warms up, and makes blocks long enough. At the start all vertices stand where their reference positions are, and none
 * needs a new one for some 20 steps: what comes first is cheaper than what follows. */
static void warm_up(struct contender *c, double seconds)
{
  c->sort->advance(c, c->sort->settling);
  const double begin = now();
  uint64_t blocks = 0;
  do {
    c->sort->advance(c, c->block);
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
      c[k].sort->advance(&c[k], c[k].block);
      printf("%d\t%d\t%llu\t%.6f\n", round, k, (unsigned long long)c[k].block, now() - begin);
      fflush(stdout);
    }
  for (int k = 0; k < n; k++)
    if (c[k].file) {
      const uncross_view *view = uncross_sim_view(uncross_run_sim(c[k].file));
      printf("members\t%d\t%u\t%u\n", k, view->particles, view->vertices);
    }
  printf("peak\t%ld\n", peak_memory());
  for (int k = 0; k < n; k++)
    c[k].sort->end(&c[k]);
  free(c);
  return 0;
}

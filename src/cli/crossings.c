/* `uncross crossings`: meetings of bonds between two frames, for `uncross topology`. docs/topology.md describes the
 * form.
 */
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cli/command.h"
#include "topology/search.h"

#define MOST ((uint32_t)1 << 28) /* vertices */

static bool read_all(void *to, size_t size, size_t count)
{
  return fread(to, size, count, stdin) == count;
}

static void print(void *sink, const struct meeting *c, enum pair_verdict verdict, const struct crossing *crossing,
                  int crossings)
{
  (void)sink;
  const char *const pair = " %" PRIu32 " %" PRIu32 " %" PRId64 " %" PRId64 " %" PRId64;
  for (int k = 0; k < (verdict == PAIR_UNSURE ? 1 : crossings); k++) {
    fputs(verdict == PAIR_UNSURE ? "unsure" : "crossed", stdout);
    printf(pair, c->bond[0], c->bond[1], c->image[0], c->image[1], c->image[2]);
    if (verdict == PAIR_CROSSED)
      printf(" %d %.9g %.9g %.9g", crossing[k].sign, crossing[k].t, crossing[k].s[0], crossing[k].s[1]);
    putchar('\n');
  }
}

static bool in_reach(int64_t x)
{
  return x >= -SEARCH_REACH && x <= SEARCH_REACH;
}

/* What is wrong with an interval, or NULL. */
static const char *look(const struct interval *v)
{
  for (int axis = 0; axis < 3; axis++)
    for (int t = 0; t < 2; t++)
      if (v->periodic[axis] &&
          (v->edge[t][axis] < 1 || v->edge[t][axis] > SEARCH_REACH || v->edge[t][axis] / 2 > v->edge[1 - t][axis]))
        return "an edge of the box is out of range, or doubles";
  if (!in_reach(v->offset[0]) || !in_reach(v->offset[1]))
    return "an offset is out of range";
  if (!(v->near >= 0.0 && v->near < PAIR_REACH))
    return "the number of the near is out of range";
  for (int t = 0; t < 2; t++)
    for (uint32_t k = 0; k < v->vertices; k++) {
      const struct point x = v->position[t][k];
      if (!in_reach(x.x) || !in_reach(x.y) || !in_reach(x.z))
        return "a position is out of range";
    }
  return NULL;
}

/* The next whole number of a line. */
static bool take(char **at, int64_t *number)
{
  char *end;
  errno = 0;
  *number = strtoll(*at, &end, 10);
  const bool there = end != *at && errno == 0;
  *at = end;
  return there;
}

/* Three edges at both frames, three times 0 or 1, two offsets, the distance of the near. */
static bool take_interval(char *at, struct interval *v)
{
  int64_t periodic;
  bool ok = true;
  for (int k = 0; k < 6; k++)
    ok = ok && take(&at, &v->edge[k / 3][k % 3]);
  for (int axis = 0; ok && axis < 3; axis++) {
    ok = take(&at, &periodic);
    v->periodic[axis] = periodic != 0;
  }
  ok = ok && take(&at, &v->offset[0]) && take(&at, &v->offset[1]);
  char *end = at;
  v->near = ok ? strtod(at, &end) : 0.0;
  return ok && end != at;
}

/* Those of standard input, until it ends. What is wrong, or NULL. */
static const char *answer(struct interval *v, struct point *position[2], struct search *search)
{
  char line[512];
  while (fflush(stdout) == 0 && fgets(line, sizeof line, stdin)) {
    uint64_t looked_at, near;
    if (!take_interval(line, v))
      return "a line is not the twelve numbers of an interval";
    for (int t = 0; t < 2; t++) {
      if (!read_all(position[t], sizeof *position[t], v->vertices))
        return "ends within an interval";
      v->position[t] = position[t];
    }
    const char *const wrong = look(v);
    if (wrong)
      return wrong;
    switch (search_pairs(search, v, print, NULL, &looked_at, &near)) {
    case SEARCH_NO_MEMORY:
      return "";
    case SEARCH_TOO_FAR:
      puts("far");
      break;
    case SEARCH_DONE:
      printf("done %" PRIu64 " %" PRIu64 "\n", looked_at, near);
    }
  }
  return NULL;
}

static const char *begin(struct interval *v, uint32_t (**bond)[2], struct point *position[2])
{
  char line[64], *at = line;
  int64_t vertices, bonds;
  if (!fgets(line, sizeof line, stdin) || !take(&at, &vertices) || !take(&at, &bonds) || vertices < 0 || bonds < 0 ||
      vertices > MOST || bonds > MOST / 8)
    return "the first line is not how many vertices and bonds there are";
  v->vertices = (uint32_t)vertices;
  v->bonds = (uint32_t)bonds;
  *bond = memory_alloc(v->bonds + (size_t)1, sizeof **bond);
  for (int t = 0; t < 2; t++)
    position[t] = memory_alloc(v->vertices + (size_t)1, sizeof *position[t]);
  if (!*bond || !position[0] || !position[1])
    return "";
  if (!read_all(*bond, sizeof **bond, v->bonds))
    return "ends within bonds";
  v->bond = (const uint32_t(*)[2]) * bond;
  for (uint32_t k = 0; k < v->bonds; k++)
    if (v->bond[k][0] >= v->vertices || v->bond[k][1] >= v->vertices)
      return "a bond of a vertex that is none";
  return NULL;
}

enum exit_code command_crossings(const struct arguments *a)
{
  (void)a;
  struct interval interval = {0};
  struct search search = {0};
  struct point *position[2] = {NULL, NULL};
  uint32_t(*bond)[2] = NULL;
  const char *wrong = begin(&interval, &bond, position);
  if (!wrong)
    wrong = answer(&interval, position, &search);
  search_free(&search);
  free(bond);
  free(position[0]);
  free(position[1]);
  if (!wrong)
    return EXIT_DONE;
  fprintf(stderr, "uncross: %s%s\n", *wrong ? "standard input: " : "no memory", wrong);
  return *wrong ? EXIT_BAD_INPUT : EXIT_TROUBLE;
}

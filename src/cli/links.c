/* `uncross links`: crossings and Alexander's polynomials of closed polygons, as plain numbers, for programs. The form
 * is in docs/topology.md. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/message.h"
#include "cli/command.h"
#include "topology/alexander.h"

enum { MOST_VALUES = 16, MOST_VERTICES = 1 << 28 };

#define FARTHEST ((int64_t)1 << 61) /* of coordinates and shifts */

/* One polygon of a job, as it is asked for. */
struct asked {
  int64_t curve, shift[3];
};

struct answer {
  int64_t status, crossings;
  int64_t above[2]; /* of two polygons: crossings with the first above, with the second above */
  int64_t signs[2]; /* and the sums of their signs */
  uint64_t value[MOST_VALUES];
};

/* The polygons that are given, and scratch of a job. */
struct links {
  uint64_t head[3]; /* polygons, values, most crossings of a job with values */
  uint64_t *first;  /* [polygons + 1] */
  struct point *at; /* [first[polygons]] */
  struct {
    uint64_t t, prime;
  } place[MOST_VALUES];
  uint32_t member_room, vertex_room;
  struct asked *asked;  /* [member_room] */
  uint32_t *job_first;  /* [member_room + 1] */
  struct point *job_at; /* [vertex_room] */
  struct diagram diagram;
  struct alexander alexander;
};

static bool within(int64_t x)
{
  return x > -FARTHEST && x < FARTHEST;
}

static bool point_is_within(struct point p)
{
  return within(p.x) && within(p.y) && within(p.z);
}

static bool read_numbers(void *numbers, uint64_t count, struct message *message)
{
  return fread(numbers, 8, count, stdin) == count || message_set(message, "standard input ends too early");
}

static bool read_polygons(struct links *l, struct message *message)
{
  if (!read_numbers(l->head, 3, message))
    return false;
  const uint64_t polygons = l->head[0];
  if (polygons > MOST_VERTICES || l->head[1] > MOST_VALUES || l->head[2] > INT32_MAX)
    return message_set(message, "standard input: at most %d polygons, %d values, %d crossings", MOST_VERTICES,
                       MOST_VALUES, INT32_MAX);
  l->first = calloc(polygons + 1, sizeof *l->first);
  if (!l->first)
    return message_no_memory(message, "no memory for the polygons");
  if (!read_numbers(l->first + 1, polygons, message))
    return false;
  for (uint64_t k = 0; k < polygons; k++) {
    if (l->first[k + 1] < 3 || l->first[k + 1] > MOST_VERTICES - l->first[k])
      return message_set(message, "standard input: polygon %" PRIu64 ": 3 or more vertices are allowed, %d in all", k,
                         MOST_VERTICES);
    l->first[k + 1] += l->first[k];
  }
  l->at = malloc((l->first[polygons] + 1) * sizeof *l->at);
  if (!l->at)
    return message_no_memory(message, "no memory for the polygons");
  if (!read_numbers(l->at, 3 * l->first[polygons], message) || !read_numbers(l->place, 2 * l->head[1], message))
    return false;
  for (uint64_t k = 0; k < l->first[polygons]; k++)
    if (!point_is_within(l->at[k]))
      return message_set(message, "standard input: a coordinate is beyond 2^61");
  for (uint64_t k = 0; k < l->head[1]; k++)
    if (ALEXANDER_ABOVE - l->place[k].prime - 1 >= 0xffff || l->place[k].t - 1 >= l->place[k].prime - 1)
      return message_set(message,
                         "standard input: value %" PRIu64
                         ": primes between 2^61 - 2^16 and 2^61 are allowed, t from 1 to below them",
                         k);
  return true;
}

/* The polygons of a job, shifted. */
static bool take_job(struct links *l, uint32_t members, struct message *message)
{
  l->job_first[0] = 0;
  for (uint32_t m = 0; m < members; m++) {
    const struct asked *a = &l->asked[m];
    const struct point shift = {a->shift[0], a->shift[1], a->shift[2]};
    if (a->curve < 0 || (uint64_t)a->curve >= l->head[0] || !point_is_within(shift))
      return message_set(message, "standard input: a job asks for a polygon that is not there, or too far away");
    const uint64_t from = l->first[a->curve], count = l->first[a->curve + 1] - from;
    uint32_t begin = l->job_first[m];
    if (count > MOST_VERTICES - begin)
      return message_set(message, "standard input: a job has more than %d vertices", MOST_VERTICES);
    while (begin + count > l->vertex_room)
      if (!memory_double((void **)&l->job_at, &l->vertex_room, 1024, sizeof *l->job_at))
        return message_no_memory(message, "no memory for %" PRIu64 " vertices", count);
    for (uint64_t k = 0; k < count; k++) {
      const struct point p = l->at[from + k];
      l->job_at[begin++] = (struct point){p.x + shift.x, p.y + shift.y, p.z + shift.z};
    }
    l->job_first[m + 1] = begin;
  }
  return true;
}

static bool answer_job(struct links *l, uint32_t members, struct message *message)
{
  struct answer a = {0};
  const uint32_t values = (uint32_t)l->head[1];
  struct diagram *d = &l->diagram;
  const struct polygons p = {members, l->job_first, l->job_at};
  a.status = diagram_make(d, &p, values > 0, (uint32_t)l->head[2]);
  bool ok = a.status != DIAGRAM_NO_MEMORY;
  if (a.status == DIAGRAM_FINE) {
    a.crossings = d->crossings;
    for (uint32_t k = 0; k < d->crossings; k++) {
      const struct crossing *c = &d->crossing[k];
      if (c->member[0] != c->member[1]) {
        a.above[c->member[0] != 0]++;
        a.signs[c->member[0] != 0] += c->sign;
      }
    }
    for (uint32_t k = 0; ok && k < values; k++)
      ok = alexander_value(&l->alexander, d, l->place[k].t, l->place[k].prime, &a.value[k]);
  }
  if (!ok)
    return message_no_memory(message, "no memory for a diagram of %" PRIu32 " vertices", l->job_first[members]);
  fwrite(&a, offsetof(struct answer, value) + values * sizeof *a.value, 1, stdout);
  return true;
}

static bool have_members(struct links *l, uint64_t members, struct message *message)
{
  if (members == 0 || members > MOST_VERTICES / 3)
    return message_set(message, "standard input: a job of %" PRIu64 " polygons; allowed: 1 to %d", members,
                       MOST_VERTICES / 3);
  const bool ok = members <= l->member_room || (memory_grow((void **)&l->asked, members, sizeof *l->asked) &&
                                                memory_grow((void **)&l->job_first, members + 1, sizeof *l->job_first));
  if (!ok)
    return message_no_memory(message, "no memory for %" PRIu64 " polygons", members);
  l->member_room = members > l->member_room ? (uint32_t)members : l->member_room;
  return true;
}

static bool answer_jobs(struct links *l, struct message *message)
{
  uint64_t members;
  while (!ferror(stdout) && fread(&members, 8, 1, stdin) == 1)
    if (!have_members(l, members, message) || !read_numbers(l->asked, 4 * members, message) ||
        !take_job(l, (uint32_t)members, message) || !answer_job(l, (uint32_t)members, message))
      return false;
  return true;
}

enum exit_code command_links(const struct arguments *arguments)
{
  (void)arguments;
  struct links l = {0};
  struct message message = {0};
  const bool ok = read_polygons(&l, &message) && answer_jobs(&l, &message);
  if (!ok)
    fprintf(stderr, "uncross: %s\n", message.text);
  diagram_free(&l.diagram);
  alexander_free(&l.alexander);
  free(l.first);
  free(l.at);
  free(l.asked);
  free(l.job_first);
  free(l.job_at);
  return ok ? EXIT_DONE : message.kind == MESSAGE_NO_MEMORY ? EXIT_TROUBLE : EXIT_BAD_INPUT;
}

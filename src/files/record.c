#include "files/record.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "base/opening.h"
#include "files/build_info.h"
#include "files/start.h"
#include "observe/units.h"
#include "version.h"

/* JSON knows no NaN: null. */
static json_t *real(double x)
{
  return isfinite(x) ? json_real(x) : json_null();
}

static json_t *conserved(double energy, struct vec3 p)
{
  return json_pack("{s:o, s:[o, o, o]}", "energy", real(energy), "momentum", real(p.x), real(p.y), real(p.z));
}

static json_t *counts(const struct collision_counts *c)
{
  return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I}", "moves", (json_int_t)c->moves, "possible", (json_int_t)c->possible,
                   "executed", (json_int_t)c->executed, "negative", (json_int_t)c->negative, "softened",
                   (json_int_t)c->softened, "rigid", (json_int_t)c->rigid);
}

static json_t *hexadecimal(uint64_t x)
{
  char text[32];
  snprintf(text, sizeof text, "%016" PRIx64, x);
  return json_string(text);
}

/* Seeds are 64-bit: a string where JSON readers would round. */
static json_t *seed(uint64_t x)
{
  char text[32];
  snprintf(text, sizeof text, "%" PRIu64, x);
  return json_string(text);
}

/* The snapshot that a stream is made of; null if there is none. */
static json_t *parent(const struct stream *s)
{
  if (!stream_has_parent(s))
    return json_null();
  return json_pack("{s:o, s:I, s:o}", "stream", s->from == STREAM_SNAPSHOT ? seed(s->parent) : json_null(), "step",
                   (json_int_t)s->parent_step, "state", hexadecimal(s->parent_state));
}

/* When it was written, UTC. */
static json_t *date(void)
{
  char text[32] = "";
  struct tm parts;
  const time_t now = time(NULL);
  if (gmtime_r(&now, &parts))
    strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return json_string(text);
}

static json_t *host(void)
{
  struct utsname name;
  return uname(&name) == 0 ? json_string(name.nodename) : json_null();
}

/* As Linux calls it; null where it does not say. */
static json_t *processor(void)
{
  char line[256];
  json_t *found = NULL;
  FILE *file = fopen("/proc/cpuinfo", "r");
  while (file && !found && fgets(line, sizeof line, file))
    if (strncmp(line, "model name", 10) == 0 && strchr(line, ':')) {
      const char *name = strchr(line, ':') + 1;
      name += strspn(name, " \t");
      found = json_stringn(name, strcspn(name, "\n"));
    }
  if (file)
    fclose(file);
  return found ? found : json_null();
}

static void add_text(void *list, const char *text)
{
  json_array_append_new(list, json_string(text));
}

/* What a reader of the results should know: of the scene, and of what happened. */
static json_t *warnings(const struct scene *scene, const struct record *r)
{
  json_t *list = json_array();
  scene_warnings(scene, add_text, list);
  start_warnings(scene, &r->stream, add_text, list);
  char text[256];
  if (r->counts.rigid > 0) {
    snprintf(
        text, sizeof text,
        "%" PRIu64
        " contacts found no impulse that separates the bonds, which then moved rigidly for the rest of a drift; such "
        "drifts do not conserve energy; a smaller time_step has fewer",
        r->counts.rigid);
    add_text(list, text);
  }
  return list;
}

static void add_unit(void *units, const char *column, const char *unit)
{
  json_object_set_new(units, column, json_string(unit));
}

/* Of the columns of tables: not in their header, where names would no longer be names. */
static json_t *units(const struct scene *scene)
{
  json_t *of = json_object();
  observe_units(&scene->observe, &scene->model, add_unit, of);
  return of;
}

bool record_write(const struct folder *folder, const struct scene *scene, const struct record *r,
                  struct message *message)
{
  json_t *root = json_pack(
      "{s:s, s:s?, s:s, s:s, s:s, s:s, s:s, s:o, s:o, s:o, s:o, s:I, s:I, s:f, s:f, s:f, s:o, s:o, s:o, s:o, s:o, s:o, "
      "s:o, s:s}",
      "status", r->status, "reason", r->reason, "program", "uncross", "version", UNCROSS_VERSION, "commit",
      build_info.commit, "compiler", build_info.compiler, "flags", build_info.flags, "seed", seed(scene->seed),
      "stream", seed(r->stream.key), "stream_from", parent(&r->stream), "scene_fingerprint",
      hexadecimal(scene->fingerprint), "steps", (json_int_t)r->step, "steps_wanted", (json_int_t)scene->steps, "time",
      (double)r->step * scene->model.time_step, "wall_seconds", r->wall_seconds, "steps_per_second",
      r->steps_per_second, "collisions", counts(&r->counts), "warnings", warnings(scene, r), "start",
      conserved(r->start_energy, r->start_momentum), "end", conserved(r->now.total, r->now.momentum), "state_hash",
      hexadecimal(r->state_hash), "state_digest", hexadecimal(r->state_digest), "units", units(scene), "scene",
      scene->text);
  if (root) {
    json_object_set_new(root, "date", date());
    json_object_set_new(root, "host", host());
    json_object_set_new(root, "processor", processor());
  }
  char *text = root ? json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(17)) : NULL;
  message_set(message, "%s/run.json: no memory for it", folder->name);
  bool ok = text && file_replace(folder, "run.json", text, strlen(text), message);
  free(text);
  json_decref(root);
  return ok;
}

/* All bytes of a file that is no larger than a record; -1, with errno, if it cannot be read. */
static ssize_t read_all(int fd, char *text, size_t most)
{
  size_t bytes = 0;
  ssize_t more = 1;
  while (bytes < most && (more = read(fd, text + bytes, most - bytes)) != 0) {
    if (more < 0 && errno != EINTR)
      return -1;
    bytes += more > 0 ? (size_t)more : 0;
  }
  return (ssize_t)bytes;
}

static json_t *load(int fd, const char *path, struct message *message)
{
  json_error_t error;
  struct stat status;
  json_t *root = NULL;
  const bool seen = fstat(fd, &status) == 0, large = seen && status.st_size > RECORD_MOST_BYTES;
  char *text = seen && !large ? malloc((size_t)status.st_size + 1) : NULL;
  const ssize_t bytes = text ? read_all(fd, text, (size_t)status.st_size) : -1;
  if (large)
    message_set(message, "%s:1:1: larger than %d bytes", path, RECORD_MOST_BYTES);
  else if (bytes < 0)
    message_unread(message, "%s: cannot be read: %s", path, strerror(errno));
  else if (!(root = json_loadb(text, (size_t)bytes, JSON_REJECT_DUPLICATES, &error)))
    message_set(message, "%s:%d:%d: not JSON: %s", path, error.line, error.column, error.text);
  free(text);
  return root;
}

json_t *record_read(const char *path, struct message *message)
{
  const int fd = open_regular(path, message);
  json_t *root = fd < 0 ? NULL : load(fd, path, message);
  if (fd >= 0)
    close(fd);
  return root;
}

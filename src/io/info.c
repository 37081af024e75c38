/* What a file is, in a few lines. Each sort of file is an entry of a table: how to know it, and what to say. */
#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/checkpoint.h"
#include "io/structure.h"
#include "io/trajectory.h"
#include "io/yaml.h"

#define HEAD_BYTES 4096
#define MOST_KEYS 64

/* A file and its beginning. */
struct look {
  const char *path;
  char head[HEAD_BYTES + 1];
  size_t bytes;
};

static bool ends_with(const char *text, const char *end)
{
  size_t n = strlen(text), m = strlen(end);
  return n >= m && strcmp(text + n - m, end) == 0;
}

/* --- HDF5 -------------------------------------------------------------------------------------------------------- */

static bool is_hdf5(const struct look *look)
{
  return look->bytes >= 8 && memcmp(look->head, "\x89HDF\r\n\x1a\n", 8) == 0;
}

static bool tell_checkpoint(const char *path, struct message *message)
{
  struct checkpoint_summary s;
  hid_t file = checkpoint_open(path, &s, message);
  if (file < 0)
    return false;
  h5_close(file);
  printf("%s: checkpoint of uncross %s\n", path, s.head.version);
  printf("  step %" PRIu64 ", time %.10g t0, %.6g s of wall time so far\n", s.step, (double)s.step * s.time_step,
         s.head.wall_seconds);
  printf("  box %d x %d x %d a0, %" PRIu32 " solvent particles, %" PRIu32 " fiber vertices\n", s.cells[0], s.cells[1],
         s.cells[2], s.particles, s.vertices);
  printf("  crossings: %" PRIu64 " possible, %" PRIu64 " executed, %" PRIu64 " negative in %" PRIu64 " moves\n",
         s.counts.possible, s.counts.executed, s.counts.negative, s.counts.moves);
  printf("  seed %" PRIu64 ", scene fingerprint %016" PRIx64 ", state hash %016" PRIx64 "\n", s.head.seed,
         s.head.fingerprint, s.head.state_hash);
  return true;
}

static void tell_creator(hid_t file)
{
  char name[128] = "unknown", version[64] = "", author[128] = "unknown";
  hid_t h5md = h5_open_group(file, "h5md"), creator = h5_open_group(h5md, "creator");
  hid_t by = h5_open_group(h5md, "author");
  if (creator >= 0) {
    h5_get_text(creator, "name", name, sizeof name);
    h5_get_text(creator, "version", version, sizeof version);
  }
  if (by >= 0)
    h5_get_text(by, "name", author, sizeof author);
  h5_close(by);
  h5_close(creator);
  h5_close(h5md);
  H5Eclear2(H5E_DEFAULT);
  printf("  written by %s %s, author %s\n", name, version, author);
}

static void tell_species(const struct trajectory *t)
{
  struct structure s;
  hid_t connectivity = h5_open_group(t->file, "connectivity");
  if (structure_read(t->group, connectivity, t->particles, &s)) {
    for (int k = 0; k < s.kinds; k++) {
      uint32_t count = 0;
      for (uint32_t i = 0; i < s.particles; i++)
        count += s.species[i] == k;
      if (count > 0)
        printf("  %" PRIu32 " particles of '%s'\n", count, s.name[k]);
    }
    printf("  %" PRIu32 " bonds\n", s.bonds);
    structure_free(&s);
  }
  h5_close(connectivity);
}

static bool tell_trajectory(const char *path, struct message *message)
{
  struct trajectory *t = trajectory_open_read(path, message);
  if (!t)
    return false;
  uint64_t first = 0, last = 0;
  double edge[3], begin = 0.0, end = 0.0;
  printf("%s: H5MD trajectory\n", path);
  tell_creator(t->file);
  printf("  %" PRIu64 " frames of %" PRIu32 " particles, %s velocities\n", t->frames, t->particles,
         trajectory_has_velocities(t) ? "with" : "without");
  if (t->frames > 0 && trajectory_moment(t, 0, &first, &begin) && trajectory_moment(t, t->frames - 1, &last, &end))
    printf("  steps %" PRIu64 " to %" PRIu64 ", times %.10g to %.10g\n", first, last, begin, end);
  if (t->frames > 0 && trajectory_edges(t, 0, edge))
    printf("  box %.10g x %.10g x %.10g\n", edge[0], edge[1], edge[2]);
  tell_species(t);
  char *scene = trajectory_scene_text(t);
  printf("  %s\n", scene ? "holds its scene: `uncross analyze` needs nothing else" : "holds no scene");
  free(scene);
  return trajectory_close(t, message);
}

static bool tell_hdf5(const struct look *look, struct message *message)
{
  enum h5_trouble trouble;
  hid_t file = h5_open(look->path, false, &trouble, message);
  if (file < 0)
    return false;
  bool checkpoint = checkpoint_is(file);
  h5_close(file);
  return (checkpoint ? tell_checkpoint : tell_trajectory)(look->path, message);
}

/* --- JSON -------------------------------------------------------------------------------------------------------- */

/* By its name, or since it can be read as JSON: a scene in braces cannot, or is both. */
static bool is_json(const struct look *look)
{
  json_t *root = ends_with(look->path, ".json") ? NULL : json_load_file(look->path, 0, NULL);
  json_decref(root);
  return root || ends_with(look->path, ".json");
}

static void tell_value(const char *key, const json_t *value)
{
  if (json_is_object(value) || json_is_array(value)) {
    size_t n = json_is_object(value) ? json_object_size(value) : json_array_size(value);
    printf("  %s: %zu entries\n", key, n);
    return;
  }
  char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(12));
  if (text && strlen(text) <= 100)
    printf("  %s: %s\n", key, text);
  else
    printf("  %s: a long text\n", key);
  free(text);
}

static bool tell_json(const struct look *look, struct message *message)
{
  json_error_t error;
  json_t *root = json_load_file(look->path, 0, &error);
  if (!root)
    return message_set(message, "%s:%d:%d: not JSON: %s", look->path, error.line, error.column, error.text);
  printf("%s: %s\n", look->path, json_object_get(root, "state_hash") ? "record of a run" : "JSON");
  for (void *i = json_object_iter(root); i; i = json_object_iter_next(root, i))
    tell_value(json_object_iter_key(i), json_object_iter_value(i));
  json_decref(root);
  return true;
}

/* --- text -------------------------------------------------------------------------------------------------------- */

static bool is_text(const struct look *look)
{
  return look->bytes > 0 && strlen(look->head) == look->bytes;
}

static bool is_extended_xyz(const struct look *look)
{
  const char *second = strchr(look->head, '\n');
  return is_text(look) && second && strspn(look->head, "0123456789 \r") == (size_t)(second - look->head) &&
         strstr(second, "Properties=");
}

static bool tell_extended_xyz(const struct look *look, struct message *message)
{
  (void)message;
  const char *second = strchr(look->head, '\n') + 1;
  printf("%s: extended XYZ, %.*s particles in its first frame\n  %.*s\n", look->path, (int)strcspn(look->head, " \r\n"),
         look->head, (int)strcspn(second, "\r\n"), second);
  return true;
}

static bool is_table(const struct look *look)
{
  return is_text(look) && ends_with(look->path, ".csv");
}

static bool tell_table(const struct look *look, struct message *message)
{
  FILE *file = fopen(look->path, "r");
  if (!file)
    return message_set(message, "%s: cannot be read: %s", look->path, strerror(errno));
  size_t header = strcspn(look->head, "\r\n"), columns = 1;
  uint64_t lines = 0;
  for (size_t k = 0; k < header; k++)
    columns += look->head[k] == ',';
  for (int c = fgetc(file); c != EOF; c = fgetc(file))
    lines += c == '\n';
  fclose(file);
  printf("%s: table of %zu columns and %" PRIu64 " rows\n", look->path, columns, lines > 0 ? lines - 1 : 0);
  printf("  columns: %.*s\n", (int)header, look->head);
  return true;
}

static bool tell_neither(const struct look *look, struct message *message)
{
  return message_set(message, "%s: neither a scene, checkpoint, trajectory, record of a run, table nor extended XYZ",
                     look->path);
}

static void tell_sections(const struct yaml_file *file, const yaml_node_t *root)
{
  const char *between = "";
  printf("%s: YAML, perhaps a scene; its sections: ", file->path);
  for (size_t i = 0; i < yaml_pairs(root) && i < MOST_KEYS; i++) {
    const yaml_node_t *value;
    const char *key = yaml_text(yaml_pair(file, root, i, &value));
    printf("%s%.100s", between, key ? key : "?");
    between = ", ";
  }
  printf("\n  `uncross check %s` says what it means\n", file->path);
}

/* Any text may be one; libyaml knows. Where it errs is of use if the text is meant as YAML, which its name says. */
static bool tell_scene(const struct look *look, struct message *message)
{
  const bool meant = ends_with(look->path, ".yaml") || ends_with(look->path, ".yml");
  size_t size;
  struct yaml_file file;
  char *text = yaml_read_file(look->path, &size, message);
  if (!text)
    return size > YAML_MOST_BYTES && !meant && tell_neither(look, message);
  if (!yaml_file_open(&file, look->path, text, size, message)) {
    free(text);
    return !meant && tell_neither(look, message);
  }
  const yaml_node_t *root = yaml_file_root(&file);
  bool mapping = root && root->type == YAML_MAPPING_NODE;
  if (mapping)
    tell_sections(&file, root);
  yaml_file_close(&file);
  free(text);
  return mapping || tell_neither(look, message);
}

/* --- all --------------------------------------------------------------------------------------------------------- */

static const struct sort {
  bool (*is)(const struct look *look);
  bool (*tell)(const struct look *look, struct message *message);
} sorts[] = {{is_hdf5, tell_hdf5},
             {is_extended_xyz, tell_extended_xyz},
             {is_table, tell_table},
             {is_json, tell_json},
             {is_text, tell_scene}};

static bool look_at(const char *path, struct look *look, struct message *message)
{
  *look = (struct look){.path = path};
  FILE *file = fopen(path, "rb");
  if (file)
    look->bytes = fread(look->head, 1, HEAD_BYTES, file);
  bool ok = file && !ferror(file);
  if (!ok)
    message_set(message, "%s: cannot be read: %s", path, strerror(errno));
  if (file)
    fclose(file);
  return ok;
}

bool file_info(const char *path, struct message *message)
{
  struct look look;
  if (!look_at(path, &look, message))
    return false;
  for (size_t k = 0; k < sizeof sorts / sizeof *sorts; k++)
    if (sorts[k].is(&look))
      return sorts[k].tell(&look, message);
  return tell_neither(&look, message);
}

/* What a file is, in a few lines. Each sort of file is an entry of a table: how to know it, and what to say. */
#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/opening.h"
#include "base/text.h"
#include "files/frames.h"
#include "files/record.h"
#include "files/table.h"
#include "files/verify.h"
#include "scene/yaml.h"

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

static void tell_checkpoint(const struct frames *f)
{
  const struct checkpoint_summary *s = &f->about.summary;
  printf("%s: checkpoint of uncross %s\n", text_shown(f->path), text_shown(s->head.version));
  printf("  step %" PRIu64 ", time %.10g t0, %.6g s of wall time so far\n", s->numbers.step,
         text_real((double)s->numbers.step * s->time_step), text_real(s->head.wall_seconds));
  printf("  box %d x %d x %d a0, %" PRIu32 " solvent particles, %" PRIu32 " fiber vertices\n", s->cells[0], s->cells[1],
         s->cells[2], s->particles, s->vertices);
  printf("  crossings: %" PRIu64 " possible, %" PRIu64 " executed, %" PRIu64 " negative in %" PRIu64 " moves\n",
         s->numbers.counts.possible, s->numbers.counts.executed, s->numbers.counts.negative, s->numbers.counts.moves);
  if (s->numbers.counts.softened + s->numbers.counts.rigid > 0)
    printf("  contacts: %" PRIu64 " softened rebounds, %" PRIu64 " rigid\n", s->numbers.counts.softened,
           s->numbers.counts.rigid);
  printf("  seed %" PRIu64 ", stream %" PRIu64 ", scene fingerprint %016" PRIx64 ", state hash %016" PRIx64 "\n",
         s->head.seed, s->head.stream.key, s->head.fingerprint, s->head.state_hash);
}

static void tell_species(const struct structure *s)
{
  for (int k = 0; k < s->kinds; k++) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->particles; i++)
      count += s->species[i] == k;
    if (count > 0)
      printf("  %" PRIu32 " particles of '%s'\n", count, text_shown(s->name[k]));
  }
  printf("  %" PRIu32 " bonds\n", s->bonds);
}

/* Step, time and box of a frame, unless it is damaged: that is told at the end. */
static bool look_at_frame(struct frames *f, uint64_t frame)
{
  struct message ignored;
  return frames_check(f, frame, &ignored) == FRAME_FINE;
}

static void tell_trajectory(struct frames *f)
{
  const struct frames_about *about = &f->about;
  printf("%s: H5MD trajectory\n", text_shown(f->path));
  printf("  written by %s %s, author %s\n", text_shown(about->creator), text_shown(about->version),
         text_shown(about->author));
  printf("  %" PRIu64 " frames of %" PRIu32 " particles, %s velocities\n", about->frames, about->rows,
         about->velocities ? "with" : "without");
  if (about->frames > 0 && look_at_frame(f, 0)) {
    const struct picture first = f->picture;
    if (look_at_frame(f, about->frames - 1))
      printf("  steps %" PRIu64 " to %" PRIu64 ", times %.10g to %.10g\n", first.step, f->picture.step,
             text_real(first.time), text_real(f->picture.time));
    if (first.has_box)
      printf("  box %.10g x %.10g x %.10g\n", text_real(first.edge[0]), text_real(first.edge[1]),
             text_real(first.edge[2]));
  }
  tell_species(&f->structure);
  printf("  %s\n", f->scene ? "holds its scene: `uncross analyze` needs nothing else" : "holds no scene");
}

static bool tell_hdf5(const struct look *look, struct message *message)
{
  enum h5_trouble trouble;
  struct frames *f = frames_open(look->path, &trouble, message);
  if (!f)
    return false;
  if (f->about.checkpoint)
    tell_checkpoint(f);
  else
    tell_trajectory(f);
  const enum condition condition = verify_frames(f, stdout);
  frames_close(f);
  return condition == CONDITION_WHOLE || message_set(message, "%s: %s, as said above", look->path,
                                                     condition == CONDITION_DAMAGED ? "damaged" : "cannot be read");
}

/* --- JSON -------------------------------------------------------------------------------------------------------- */

/* By its name, or since it can be read as JSON: a scene in braces cannot, or is both. */
static bool is_json(const struct look *look)
{
  struct message ignored;
  json_t *root = ends_with(look->path, ".json") ? NULL : record_read(look->path, &ignored);
  json_decref(root);
  return root || ends_with(look->path, ".json");
}

static void tell_value(const char *key, const json_t *value)
{
  if (json_is_object(value) || json_is_array(value)) {
    size_t n = json_is_object(value) ? json_object_size(value) : json_array_size(value);
    printf("  %s: %zu entries\n", text_shown(key), n);
    return;
  }
  char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(12));
  if (text && strlen(text) <= 100)
    printf("  %s: %s\n", text_shown(key), text_shown(text));
  else
    printf("  %s: a long text\n", text_shown(key));
  free(text);
}

static bool tell_json(const struct look *look, struct message *message)
{
  json_t *root = record_read(look->path, message);
  if (!root)
    return false;
  printf("%s: %s\n", text_shown(look->path), json_object_get(root, "state_hash") ? "record of a run" : "JSON");
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

/* So many bytes of a text, as a line. */
static void print_line(const char *text, size_t length)
{
  char line[HEAD_BYTES + 1], shown[4 * HEAD_BYTES + 1];
  snprintf(line, sizeof line, "%.*s", (int)length, text);
  puts(text_escape(line, shown, sizeof shown));
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
  printf("%s: extended XYZ, %.*s particles in its first frame\n  ", text_shown(look->path),
         (int)strcspn(look->head, " \r\n"), look->head);
  print_line(second, strcspn(second, "\r\n"));
  return true;
}

static bool is_table(const struct look *look)
{
  return is_text(look) && ends_with(look->path, ".csv");
}

static bool tell_table(const struct look *look, struct message *message)
{
  uint64_t bytes, lines = 0;
  char *line = NULL, *header = NULL;
  size_t room = 0;
  ssize_t length;
  FILE *file = open_input(look->path, &bytes, message);
  if (!file)
    return false;
  for (; (length = text_line(&line, &room, file)) >= 0; lines++)
    if (lines == 0)
      header = strndup(line, strcspn(line, "\r\n"));
  const bool read = !ferror(file);
  fclose(file);
  free(line);
  const bool ok = length == TEXT_TOO_LONG ? message_set(message, "%s: not a table: a line has more than %d bytes",
                                                        look->path, TEXT_LONGEST_LINE)
                  : !read                 ? message_set(message, "%s: cannot be read to its end", look->path)
                                          : header || message_no_memory(message, "%s: no memory", look->path);
  if (ok) {
    printf("%s: table of %zu columns and %" PRIu64 " rows\n  columns: ", text_shown(look->path), table_columns(header),
           lines - 1);
    text_print(stdout, header);
    putchar('\n');
  }
  free(header);
  return ok;
}

static bool tell_neither(const struct look *look, struct message *message)
{
  return message_set(message, "%s: neither a scene, checkpoint, trajectory, record of a run, table nor extended XYZ",
                     look->path);
}

static void tell_sections(const char *path, const struct node *root)
{
  const char *between = "";
  printf("%s: YAML, perhaps a scene; its sections: ", text_shown(path));
  for (size_t i = 0; i < root->count && i < MOST_KEYS; i++) {
    const char *key = node_text(root->key[i]);
    printf("%s%.100s", between, key ? text_shown(key) : "?");
    between = ", ";
  }
  printf("\n  `uncross check ");
  text_print_word(stdout, path);
  printf("` says what it means\n");
}

/* Any text may be one; libyaml knows. Where it errs is of use if the text is meant as YAML, which its name says. */
static bool tell_scene(const struct look *look, struct message *message)
{
  const bool meant = ends_with(look->path, ".yaml") || ends_with(look->path, ".yml");
  size_t size;
  struct tree tree;
  char *text = yaml_read_file(look->path, &size, message);
  if (!text)
    return size > YAML_MOST_BYTES && !meant && tell_neither(look, message);
  if (!yaml_read(&tree, look->path, text, size, message)) {
    free(text);
    return !meant && tell_neither(look, message);
  }
  bool mapping = tree.root && tree.root->type == NODE_MAPPING;
  if (mapping)
    tell_sections(look->path, tree.root);
  tree_free(&tree);
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
  uint64_t bytes;
  FILE *file = open_input(path, &bytes, message);
  if (!file)
    return false;
  look->bytes = fread(look->head, 1, HEAD_BYTES, file);
  const bool ok = !ferror(file) || message_set(message, "%s: cannot be read: %s", path, strerror(errno));
  fclose(file);
  return ok;
}

static bool file_info_of_one(const char *path, struct message *message)
{
  struct look look;
  if (!look_at(path, &look, message))
    return false;
  for (size_t k = 0; k < sizeof sorts / sizeof *sorts; k++)
    if (sorts[k].is(&look))
      return sorts[k].tell(&look, message);
  return tell_neither(&look, message);
}

/* The files that every run has, or may have. */
static bool folder_info(const char *folder, struct message *message)
{
  static const char *const names[] = {"run.json", "checkpoint.h5", "trajectory.h5"};
  bool any = false;
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    char path[4096 + 32];
    snprintf(path, sizeof path, "%s/%s", folder, names[k]);
    if (access(path, F_OK) != 0)
      continue;
    any = true;
    if (!file_info_of_one(path, message))
      return false;
  }
  return any || message_set(message, "%s: a folder without run.json, checkpoint.h5 or trajectory.h5", folder);
}

bool file_info(const char *path, struct message *message)
{
  struct stat s;
  if (strlen(path) <= 4096 && stat(path, &s) == 0 && S_ISDIR(s.st_mode))
    return folder_info(path, message);
  return file_info_of_one(path, message);
}

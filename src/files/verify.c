#include "files/verify.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/opening.h"
#include "base/text.h"
#include "files/complete.h"
#include "files/record.h"
#include "files/table.h"
#include "files/told.h"
#include "scene/scene.h"

static enum condition worse(enum condition a, enum condition b)
{
  return a > b ? a : b;
}

static enum condition say(FILE *out, enum condition condition, const struct message *message)
{
  fprintf(out, "%s\n", message->text);
  return condition;
}

/* --- checkpoints and trajectories -------------------------------------------------------------------------------- */

static enum condition verify_checkpoint(struct frames *f, FILE *out)
{
  struct message message;
  const enum frame_verdict verdict = frames_read(f, 0, &message);
  if (verdict != FRAME_FINE)
    return say(out, verdict == FRAME_DAMAGED ? CONDITION_DAMAGED : CONDITION_UNKNOWN, &message);
  if (f->about.checked)
    fprintf(out, "%s: whole: every byte fits its seal, the state its hash\n", text_shown(f->path));
  else
    fprintf(out,
            "%s: readable: the state fits its hash; the file is of version 1 and carries no checksum of the whole\n",
            text_shown(f->path));
  return CONDITION_WHOLE;
}

/* Steps must increase: what `frames_read` cannot see. */
static bool in_order(const struct frames *f, uint64_t frame, uint64_t before, struct message *message)
{
  return frame == 0 || !f->about.steps || f->picture.step > before ||
         message_set(message, "%s: frame %" PRIu64 " (step %" PRIu64 "): its step does not come after %" PRIu64,
                     f->path, frame, f->picture.step, before);
}

static enum condition verify_trajectory(struct frames *f, FILE *out)
{
  struct message message;
  uint64_t damaged = 0, before = 0;
  for (uint64_t k = 0; k < f->about.frames; k++) {
    enum frame_verdict verdict = frames_read(f, k, &message);
    if (verdict == FRAME_FINE && !in_order(f, k, before, &message))
      verdict = FRAME_DAMAGED;
    if (verdict == FRAME_LOST)
      return say(out, f->apart.died ? CONDITION_DAMAGED : CONDITION_UNKNOWN, &message);
    if (verdict == FRAME_FINE)
      before = f->picture.step;
    else
      say(out, CONDITION_DAMAGED, &message);
    damaged += verdict != FRAME_FINE;
  }
  if (damaged > 0)
    fprintf(out, "%s: damaged: %" PRIu64 " of %" PRIu64 " frames; --skip-damaged leaves them out\n",
            text_shown(f->path), damaged, f->about.frames);
  else if (f->about.checked)
    fprintf(out, "%s: whole: %" PRIu64 " frames fit their checksums\n", text_shown(f->path), f->about.frames);
  else
    fprintf(out, "%s: readable: %" PRIu64 " frames; the file carries no checksum of them\n", text_shown(f->path),
            f->about.frames);
  return damaged > 0 ? CONDITION_DAMAGED : CONDITION_WHOLE;
}

enum condition verify_frames(struct frames *f, FILE *out)
{
  return f->about.checkpoint ? verify_checkpoint(f, out) : verify_trajectory(f, out);
}

static enum condition condition_of(enum h5_trouble trouble)
{
  return trouble == H5_DAMAGED || trouble == H5_DEADLY ? CONDITION_DAMAGED : CONDITION_UNKNOWN;
}

static enum condition verify_hdf5(const char *path, bool *other, FILE *out)
{
  struct message message;
  enum h5_sort sort;
  enum h5_trouble trouble;
  if (!h5_find_sort(path, &sort, &trouble, &message))
    return say(out, condition_of(trouble), &message);
  *other = sort == H5_PACK;
  if (sort == H5_OTHER)
    message_set(&message, "%s: an HDF5 file, but no checkpoint, trajectory or pack", path);
  if (sort == H5_OTHER || *other)
    return *other ? CONDITION_UNKNOWN : say(out, CONDITION_UNKNOWN, &message);
  struct frames *f = frames_open(path, &trouble, &message);
  if (!f)
    return say(out, condition_of(trouble), &message);
  const enum condition condition = verify_frames(f, out);
  frames_close(f);
  return condition;
}

/* --- tables ------------------------------------------------------------------------------------------------------ */

/* True if a line holds so many numbers. */
static bool holds_numbers(const char *line, size_t columns)
{
  for (size_t k = 0; k < columns; k++) {
    char *end;
    strtod(line, &end);
    if (end == line || *end != (k + 1 < columns ? ',' : '\0'))
      return false;
    line = end + 1;
  }
  return true;
}

/* What a table holds, line by line. Of a series rows come one after the other in steps. */
struct rows {
  uint64_t count; /* that are sound */
  size_t columns; /* 0: there is no first line */
  bool series;
  double step, gap; /* of the last row, and to it from the one before; 0 where there is none */
  bool uneven;      /* the gaps differ */
  bool cut;         /* the last line has no end, as the table of a run that was killed may have */
};

static const char *odd_step(struct rows *r, const char *line)
{
  const double step = strtod(line, NULL), gap = r->count > 0 ? step - r->step : 0.0;
  if (r->count > 0 && !(gap > 0.0))
    return "its step does not come after that of the row before";
  r->uneven |= r->gap > 0.0 && gap != r->gap;
  r->step = step;
  r->gap = gap;
  return NULL;
}

/* What is wrong with a line, or NULL. */
static const char *odd_line(struct rows *r, const char *line)
{
  const char *odd = NULL;
  if (r->columns == 0) {
    r->columns = table_columns(line);
    r->series = strncmp(line, "step,", 5) == 0;
    return NULL;
  }
  if (!r->cut)
    odd = !holds_numbers(line, r->columns) ? "a row of numbers is wanted, one for each column"
          : r->series                      ? odd_step(r, line)
                                           : NULL;
  r->count += !odd;
  return odd;
}

/* True, with a message, if something is wrong with the lines of a table. */
static bool odd_table(FILE *in, const char *path, struct rows *rows, struct message *message)
{
  char *line = NULL;
  size_t room = 0;
  ssize_t length;
  const char *odd = NULL;
  *rows = (struct rows){0};
  for (uint64_t number = 1; !odd && (length = text_line(&line, &room, in)) >= 0; number++) {
    rows->cut = line[length - 1] != '\n';
    line[strcspn(line, "\r\n")] = '\0';
    odd = odd_line(rows, line);
    if (odd)
      message_set(message, "%s:%" PRIu64 ": damaged: %s", path, number, odd);
  }
  free(line);
  if (length == TEXT_TOO_LONG)
    return !message_set(message, "%s: damaged: a line has more than %d bytes", path, TEXT_LONGEST_LINE);
  if (!odd && feof(in) && rows->columns == 0)
    return !message_set(message, "%s: damaged: empty", path);
  return odd;
}

static enum condition verify_table(const char *path, bool running, FILE *out)
{
  struct message message;
  struct rows rows;
  uint64_t bytes;
  FILE *in = open_input(path, &bytes, &message);
  if (!in)
    return say(out, CONDITION_UNKNOWN, &message);
  const bool odd = odd_table(in, path, &rows, &message), read = feof(in);
  fclose(in);
  if (odd)
    return say(out, CONDITION_DAMAGED, &message);
  if (!read && !message_set(&message, "%s: cannot be read to its end", path))
    return say(out, CONDITION_UNKNOWN, &message);
  if (rows.cut)
    fprintf(out,
            running ? "%s: readable: %" PRIu64 " rows, the last without an end; --resume makes it again\n"
                    : "%s: damaged: the last of %" PRIu64 " rows has no end\n",
            text_shown(path), rows.count);
  else
    fprintf(out, "%s: readable: rows: %" PRIu64 "%s; a table carries no checksum\n", text_shown(path), rows.count,
            rows.uneven ? ", at steps that are not evenly spaced: rows are missing, or a resume changed `every`" : "");
  return rows.cut && !running ? CONDITION_DAMAGED : CONDITION_WHOLE;
}

/* --- run.json ---------------------------------------------------------------------------------------------------- */

static enum condition verify_record(const char *path, FILE *out)
{
  struct message message;
  json_t *root = record_read(path, &message);
  if (!root && message.kind != MESSAGE_WRONG)
    return say(out, CONDITION_UNKNOWN, &message);
  if (!root) {
    fprintf(out, "%s: damaged\n", message.text);
    return CONDITION_DAMAGED;
  }
  const bool run = json_is_string(json_object_get(root, "state_hash"));
  json_decref(root);
  fprintf(out, run ? "%s: readable: a record of a run; it carries no checksum\n" : "%s: readable: JSON\n",
          text_shown(path));
  return CONDITION_WHOLE;
}

/* --- any file ---------------------------------------------------------------------------------------------------- */

static bool ends_with(const char *text, const char *end)
{
  const size_t n = strlen(text), m = strlen(end);
  return n >= m && strcmp(text + n - m, end) == 0;
}

static enum condition verify_one(const char *path, bool running, bool *other, FILE *out)
{
  static const unsigned char signature[4] = {0x89, 'H', 'D', 'F'};
  unsigned char head[4] = {0};
  struct message message;
  *other = false;
  const int fd = open_regular(path, &message);
  if (fd < 0)
    return say(out, CONDITION_UNKNOWN, &message);
  const bool hdf5 = read(fd, head, sizeof head) == (ssize_t)sizeof head && memcmp(head, signature, sizeof head) == 0;
  close(fd);
  if (hdf5 || ends_with(path, ".h5"))
    return verify_hdf5(path, other, out);
  if (ends_with(path, ".csv"))
    return verify_table(path, running, out);
  if (ends_with(path, ".json"))
    return verify_record(path, out);
  *other = true;
  return CONDITION_UNKNOWN;
}

enum condition verify_file(const char *path, bool *other, FILE *out)
{
  return verify_one(path, false, other, out);
}

/* --- folders ----------------------------------------------------------------------------------------------------- */

/* The frames that were there when the checkpoint was written are synced before it. */
static enum condition same_frames(const char *folder, const struct checkpoint_summary *summary, FILE *out)
{
  char path[4096];
  uint64_t end;
  snprintf(path, sizeof path, "%.4000s/trajectory.h5", folder);
  if (summary->head.frames_end == 0 || access(path, F_OK) != 0 ||
      !trajectory_find_end(path, summary->head.frames_end - 1, &end) || end == summary->head.frames_end)
    return CONDITION_WHOLE;
  fprintf(out, "%s: damaged: it goes to step %" PRIu64 ", when the checkpoint was written to %" PRIu64 "\n",
          text_shown(path), end ? end - 1 : 0, summary->head.frames_end - 1);
  return CONDITION_DAMAGED;
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
  return strcmp((*a)->d_name, (*b)->d_name);
}

/* A table that a run of this model may make; NULL: any run. */
static bool is_table(const struct model *model, const char *file)
{
  char name[256];
  snprintf(name, sizeof name, "%.*s", (int)strlen(file) - (int)strlen(".csv"), file);
  return ends_with(file, ".csv") && observe_is_table(model, name);
}

/* Files of a run; those that it set aside are known to be damaged. All others are the user's own. */
static int is_of_run(const struct dirent *entry)
{
  const char *name = entry->d_name;
  return strcmp(name, "checkpoint.h5") == 0 || strcmp(name, "trajectory.h5") == 0 || strcmp(name, "run.json") == 0 ||
         is_table(NULL, name);
}

/* The scene in the checkpoint of a folder, which names the kinds of fiber. */
static bool find_scene(const char *folder, struct scene *scene)
{
  char path[4096];
  enum h5_trouble trouble;
  struct message ignored;
  snprintf(path, sizeof path, "%.4000s/checkpoint.h5", folder);
  struct frames *f = access(path, F_OK) == 0 ? frames_open(path, &trouble, &ignored) : NULL;
  const bool found = f && f->scene && scene_read_text_numbers(path, f->scene, strlen(f->scene), scene, &ignored);
  frames_close(f);
  return found;
}

/* Files that grow while a run is at work are looked at when it has ended. */
static enum condition verify_listed(const char *folder, bool at_work, struct dirent **list, int count, FILE *out)
{
  const bool running = !told_of(folder).finished; /* or killed, and has written so no more */
  enum condition condition = CONDITION_WHOLE;
  struct scene scene;
  const bool known = find_scene(folder, &scene);
  for (int k = 0; k < count; k++) {
    char path[4096];
    bool other;
    const char *name = list[k]->d_name;
    snprintf(path, sizeof path, "%.3800s/%.255s", folder, name);
    if ((!at_work || strcmp(name, "checkpoint.h5") == 0) &&
        (!ends_with(name, ".csv") || is_table(known ? &scene.model : NULL, name)))
      condition = worse(condition, verify_one(path, running, &other, out));
  }
  if (known)
    scene_free(&scene);
  return condition;
}

/* How the files of a run that has ended fit. It begins with a checkpoint, opens what grows, and writes run.json; later
 * averages come between each checkpoint and its run.json. whole: each by itself. */
static enum condition verify_together(const char *folder, bool whole, FILE *out)
{
  static const char why[] = "every run writes it";
  enum condition condition = CONDITION_WHOLE;
  struct checkpoint_summary summary;
  struct message ignored;
  char path[4096];
  const struct told told = told_of(folder);
  snprintf(path, sizeof path, "%.4000s/checkpoint.h5", folder);
  if (told.there)
    condition = complete_has(folder, "checkpoint.h5", why, out);
  if (access(path, F_OK) != 0 || !checkpoint_look(path, &summary, &ignored))
    return condition;
  const bool later = summary.numbers.step > 0;
  if (later)
    condition = worse(condition, complete_has(folder, "run.json", why, out));
  const struct complete_wish wish = {
      .averages = told.finished || told.step > 0, .finished = told.finished, .whole = whole};
  if (later || told.there)
    condition = worse(condition, complete_check(folder, path, &wish, out));
  return worse(condition, worse(told_check(folder, &summary, out), same_frames(folder, &summary, out)));
}

enum condition verify_folder(const char *folder, FILE *out)
{
  struct dirent **list = NULL;
  const bool at_work = folder_in_use(folder);
  const int count = scandir(folder, &list, is_of_run, by_name);
  if (count <= 0 && !at_work) {
    fprintf(out, "%s: %s\n", text_shown(folder), count < 0 ? strerror(errno) : "a folder without files of a run");
    free(list);
    return CONDITION_UNKNOWN;
  }
  enum condition condition = verify_listed(folder, at_work, list, count, out);
  for (int k = 0; k < count; k++)
    free(list[k]);
  free(list);
  if (!at_work)
    return worse(condition, verify_together(folder, condition == CONDITION_WHOLE, out));
  fprintf(out,
          "%s: being written by another process: tables, trajectory and run.json are looked at when it has ended\n",
          text_shown(folder));
  return worse(condition, CONDITION_UNKNOWN);
}

#include "files/complete.h"

#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "files/output.h"
#include "version.h"
#include "wall/motion.h"

#define MOST_MEMORY ((uint64_t)1 << 28) /* bytes, of observers that are asked for their tables */

struct complete {
  const char *folder;
  FILE *out;
  enum condition condition;
};

enum condition complete_has(const char *folder, const char *file, const char *why, FILE *out)
{
  char path[4096];
  snprintf(path, sizeof path, "%.3800s/%.255s", folder, file);
  if (access(path, F_OK) == 0)
    return CONDITION_WHOLE;
  fprintf(out, "%s: missing: %s\n", text_shown(path), why);
  return CONDITION_DAMAGED;
}

static void expect_file(void *context, const char *file)
{
  struct complete *c = context;
  if (complete_has(c->folder, file, "the scene in the checkpoint asks for it", c->out) != CONDITION_WHOLE)
    c->condition = CONDITION_DAMAGED;
}

static void complain(struct complete *c, const struct message *message)
{
  const enum condition found = message->kind != MESSAGE_WRONG ? CONDITION_UNKNOWN : CONDITION_DAMAGED;
  fprintf(c->out, "%s\n", message->text);
  c->condition = found > c->condition ? found : c->condition;
}

static bool hold_table(void *context, const struct observe_table *table)
{
  struct complete *c = context;
  struct message message;
  const struct folder folder = {c->folder, FOLDER_BY_NAME};
  if (!table_fits(&folder, table, &message))
    complain(c, &message);
  return true;
}

/* The scene becomes that of the run, with its seed, stream and images. */
static void check_run(struct complete *c, struct scene *scene, const struct checkpoint_head *head)
{
  const struct folder folder = {c->folder, FOLDER_BY_NAME};
  struct message message;
  scene->seed = head->seed;
  scene->model.seed = head->stream.key;
  shear_begin(&scene->model, head->slide);
  if (!output_is_of_run(scene, &folder, &message))
    complain(c, &message);
}

/* With the observers as they were when the checkpoint was written. */
static void check_ends(struct complete *c, const struct scene *scene, struct observers *observers,
                       const char *checkpoint, bool finished)
{
  const struct folder folder = {c->folder, FOLDER_BY_NAME};
  const struct observe_block *blocks;
  const size_t count = observers_blocks(observers, &blocks);
  struct checkpoint_head head;
  struct state state;
  struct message message;
  if (!state_alloc(&state, &scene->model))
    return;
  if (checkpoint_read(checkpoint, &scene->model, &head, &state, blocks, count, &message) &&
      strcmp(head.version, UNCROSS_VERSION) == 0) { /* tables of other versions may have other columns */
    if (!output_whole(scene, observers, &folder, head.frames_end, &message))
      complain(c, &message);
    if (finished)
      observers_summaries(observers, &scene->model, hold_table, c);
  }
  state_free(&state);
}

enum condition complete_check(const char *folder, const char *checkpoint, const struct complete_wish *wish, FILE *out)
{
  struct complete c = {folder, out, CONDITION_WHOLE};
  struct message ignored;
  enum h5_trouble trouble;
  struct scene scene;
  uint64_t scratch;
  struct frames *f = frames_open(checkpoint, &trouble, &ignored);
  if (f && f->scene && scene_read_text(checkpoint, f->scene, strlen(f->scene), &scene, &ignored)) {
    const bool small =
        wish->averages && observers_bytes(&scene.observe, &scene.model, &scratch) + scratch <= MOST_MEMORY;
    struct observers *observers = small ? observers_create(&scene.observe, &scene.model) : NULL;
    output_files(&scene, observers, expect_file, &c);
    check_run(&c, &scene, &f->about.summary.head);
    if (observers && wish->whole && c.condition == CONDITION_WHOLE)
      check_ends(&c, &scene, observers, checkpoint, wish->finished);
    observers_free(observers);
    scene_free(&scene);
  }
  frames_close(f);
  return c.condition;
}

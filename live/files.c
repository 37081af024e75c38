/*
 * In place of the room files/ in a page, which has none: what starts from a file is refused in words. files/start.c and
 * files/run.c are the program's own; of the latter, a page uses how a run begins.
 */
#include "files/checkpoint.h"
#include "files/same_run.h"
#include "files/snapshot.h"

static bool refuse(struct message *message, const char *path)
{
  return message_set(message, "%s: a page reads no files; allowed here: a scene that draws its start", path);
}

bool snapshot_read_start(const char *path, const struct model *model, struct state *state,
                         struct snapshot_origin *origin, struct message *message)
{
  (void)model, (void)state, (void)origin;
  return refuse(message, path);
}

bool checkpoint_read(const char *path, const struct model *model, struct checkpoint_head *head, struct state *state,
                     const struct observe_block *blocks, size_t block_count, struct message *message)
{
  (void)model, (void)head, (void)state, (void)blocks, (void)block_count;
  return refuse(message, path);
}

bool checkpoint_fingerprint(const char *path, uint64_t *fingerprint)
{
  (void)path, (void)fingerprint;
  return false;
}

bool same_run(const struct scene *scene, const struct checkpoint_head *head, const struct scene *then,
              const uint64_t *seed, const char *path, struct message *message)
{
  (void)scene, (void)head, (void)then, (void)seed;
  return refuse(message, path);
}

enum same_run same_run_as_begun(const struct scene *scene, const char *path, const uint64_t *seed,
                                struct message *message)
{
  (void)scene, (void)seed;
  refuse(message, path);
  return SAME_RUN_UNKNOWN;
}

#include "files/told.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "files/record.h"
#include "scene/scene.h"
#include "version.h"

static json_t *load(const char *folder)
{
  char path[4096];
  struct message ignored;
  snprintf(path, sizeof path, "%.4000s/run.json", folder);
  return record_read(path, &ignored);
}

static const char *text_of(const json_t *root, const char *key)
{
  return json_string_value(json_object_get(root, key));
}

static bool is_finished(const json_t *root)
{
  const char *status = text_of(root, "status");
  return status && strcmp(status, "finished") == 0;
}

static uint64_t step_of(const json_t *root)
{
  const json_int_t step = json_integer_value(json_object_get(root, "steps"));
  return step > 0 ? (uint64_t)step : 0;
}

struct told told_of(const char *folder)
{
  char path[4096];
  snprintf(path, sizeof path, "%.4000s/run.json", folder);
  struct told told = {.there = access(path, F_OK) == 0};
  json_t *root = told.there ? load(folder) : NULL;
  told.finished = is_finished(root);
  told.step = step_of(root);
  json_decref(root);
  return told;
}

/* --- against the checkpoint -------------------------------------------------------------------------------------- */

/* What every record has had since the first. */
static bool is_record(const json_t *root)
{
  return json_is_string(json_object_get(root, "status")) && json_is_integer(json_object_get(root, "steps")) &&
         json_is_string(json_object_get(root, "seed")) && json_is_string(json_object_get(root, "state_hash"));
}

static bool odd_status(const json_t *root, struct message *why)
{
  static const char *const allowed[] = {"finished", "interrupted", "stopped", "running"};
  const char *status = text_of(root, "status");
  char shown[256];
  for (size_t k = 0; k < sizeof allowed / sizeof *allowed; k++)
    if (strcmp(status, allowed[k]) == 0)
      return false;
  return !message_set(why, "its status is '%.60s'; allowed: finished, interrupted, stopped, running",
                      text_escape(status, shown, sizeof shown));
}

static bool odd_step(const json_t *root, uint64_t step, struct message *why)
{
  const json_int_t steps = json_integer_value(json_object_get(root, "steps"));
  if (steps < 0 || (uint64_t)steps > step)
    return !message_set(why, "its steps are %" JSON_INTEGER_FORMAT ", in the checkpoint %" PRIu64, steps, step);
  return is_finished(root) && (uint64_t)steps < step &&
         !message_set(why, "it is of a finished run of %" JSON_INTEGER_FORMAT " steps, the checkpoint of %" PRIu64,
                      steps, step);
}

/* Numbers that a record writes as words. Those of earlier programs may lack some. */
static bool odd_words(const json_t *root, const struct checkpoint_summary *summary, struct message *why)
{
  const struct checkpoint_head *head = &summary->head;
  const bool now = step_of(root) == summary->numbers.step;
  const struct {
    const char *key;
    bool hexadecimal, compare;
    uint64_t value;
  } rows[] = {{"seed", false, true, head->seed},
              {"stream", false, true, head->stream.key},
              {"scene_fingerprint", true, true, head->fingerprint},
              {"state_hash", true, now, head->state_hash},
              {"state_digest", true, now && head->state_digest != 0, head->state_digest}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    char wanted[32], shown[256];
    const char *found = text_of(root, rows[k].key);
    snprintf(wanted, sizeof wanted, rows[k].hexadecimal ? "%016" PRIx64 : "%" PRIu64, rows[k].value);
    if (!found && strcmp(head->version, UNCROSS_VERSION) == 0)
      return !message_set(why, "it says no %s", rows[k].key);
    if (found && rows[k].compare && strcmp(found, wanted) != 0)
      return !message_set(why, "its %s is %.60s, in the checkpoint %s", rows[k].key,
                          text_escape(found, shown, sizeof shown), wanted);
  }
  return false;
}

/* What its scene means. Programs of other versions may write what this one cannot read. */
static bool odd_scene(const json_t *root, const struct checkpoint_head *head, struct message *why)
{
  const char *text = text_of(root, "scene");
  struct message ignored;
  struct scene scene;
  if (!text || strcmp(head->version, UNCROSS_VERSION) != 0)
    return false;
  errno = 0;
  const bool read = scene_read_text_numbers("run.json", text, strlen(text), &scene, &ignored),
             same = read && scene.fingerprint == head->fingerprint;
  if (read)
    scene_free(&scene);
  return !same && (read || errno != ENOMEM) && !message_set(why, "its scene is another one than the checkpoint's");
}

enum condition told_check(const char *folder, const struct checkpoint_summary *summary, FILE *out)
{
  struct message why;
  message_set(&why, "it is no record of a run");
  json_t *root = load(folder);
  const bool odd = root && (!is_record(root) || odd_status(root, &why) || odd_step(root, summary->numbers.step, &why) ||
                            odd_words(root, summary, &why) || odd_scene(root, &summary->head, &why));
  json_decref(root);
  if (odd)
    fprintf(out, "%s/run.json: damaged: %s\n", text_shown(folder), why.text);
  return odd ? CONDITION_DAMAGED : CONDITION_WHOLE;
}

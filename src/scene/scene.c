#include "scene/scene.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

#include "base/text.h"
#include "observe/meaning.h"
#include "scene/read.h"
#include "scene/scene_keys.h"
#include "scene/set.h"
#include "scene/write.h"
#include "scene/yaml.h"
#include "system/bead.h"
#include "theory/bead.h"

/* --- where a key is said ----------------------------------------------------------------------------------------- */

/* "fibers.1.mass" is told as "fibers.mass": the place says which. */
static void told_path(const char *path, char *told, size_t size)
{
  size_t used = 0;
  while (*path && used + 1 < size) {
    const size_t length = strcspn(path, "."), digits = strspn(path, "0123456789");
    if (digits < length)
      used += (size_t)snprintf(told + used, size - used, "%s%.*s", used ? "." : "", (int)length, path);
    path += length + (path[length] == '.');
  }
  told[used < size ? used : size - 1] = '\0';
}

/* "place: key: what" of a key; "place: what" of the whole. Always returns false. */
static bool refuse_key(const struct scene *scene, const char *path, struct message *message, const char *what)
{
  char told[192];
  told_path(path, told, sizeof told);
  return node_refuse(node_near(scene->tree.root, path), message, "%s%s%s", told, *told ? ": " : "", what);
}

bool scene_refuse_at(const struct scene *scene, const char *place, const char *key, struct message *message,
                     const char *format, ...)
{
  char what[sizeof message->text];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(what, sizeof what, format, arguments);
  va_end(arguments);
  return node_refuse(node_near(scene->tree.root, place), message, "%s: %s", key, what);
}

bool scene_says(const struct scene *scene, const char *path)
{
  const struct node *node = scene->tree.root;
  while (node && *path) {
    char part[80];
    const size_t length = strcspn(path, ".");
    snprintf(part, sizeof part, "%.*s", (int)length, path);
    node = node->type == NODE_LIST ? node_item(node, strtoull(part, NULL, 10)) : node_value(node, part);
    path += length + (path[length] == '.');
  }
  return node != NULL;
}

/* --- what keys must be together, besides the model's -------------------------------------------------------------- */

/* A steady force must not drive the bead faster than a trap may. Friction in the box is more than without it. */
static bool check_force(const struct scene *scene, struct message *message)
{
  const double force = vec3_norm(scene->model.bead.drive.force), friction = theory_model_bead_friction(&scene->model);
  return force <= BEAD_MOST_SPEED * friction ||
         scene_refuse_at(
             scene, "bead.drive.force", "bead.drive.force", message,
             "%.6g kT/a0 drives the bead at %.3g a0/t0, too near the speed of sound; allowed: at most %.6g, "
             "for %g a0/t0",
             force, force / friction, BEAD_MOST_SPEED * friction, BEAD_MOST_SPEED);
}

/* What has no meaning here cannot be observed. */
static bool check_observed(const struct scene *scene, struct message *message)
{
  for (int k = 0; k < OBSERVABLES; k++) {
    const char *why = scene->observe.every[k] > 0 ? meaning_refusal(&scene->model, (enum observable)k) : NULL;
    char key[64];
    snprintf(key, sizeof key, "observe.%s", observable_names[k]);
    if (why)
      return scene_refuse_at(scene, key, key, message, "%s", why);
  }
  return true;
}
static bool check_lags(const struct scene *scene, struct message *message)
{
  const struct observe_plan *plan = &scene->observe;
  if (plan->longest_lag == 0 || plan->longest_lag >= plan->every[OBSERVE_DYNAMICS])
    return true;
  return scene_refuse_at(scene, "observe.dynamics.longest_lag", "observe.dynamics.longest_lag", message,
                         "%" PRIu64 " steps, sampled every %" PRIu64
                         "; allowed: 0 (as long as the run allows), or at least one sample's distance",
                         plan->longest_lag, plan->every[OBSERVE_DYNAMICS]);
}

/* Averages begin within the run. */
static bool check_from(const struct scene *scene, struct message *message)
{
  const bool as_time = scene_says(scene, "observe.from_time");
  const char *key = as_time ? "observe.from_time" : "observe.from";
  return scene->observe.from <= scene->steps ||
         scene_refuse_at(scene, key, key, message,
                         "averages would begin at step %" PRIu64 ", after the run's %" PRIu64
                         " steps; allowed: at most %s",
                         scene->observe.from, scene->steps, as_time ? "the time of the run" : "`steps`");
}

/* The first step that is not before a time. A time that is a step but for rounding is that step. */
static uint64_t step_of_time(double time, double time_step)
{
  const double steps = time / time_step, nearest = rint(steps);
  const double step = fabs(steps - nearest) <= 1e-9 * nearest ? nearest : ceil(steps);
  return step < 0x1p63 ? (uint64_t)step : INT64_MAX;
}

static bool check_trajectory(const struct scene *scene, struct message *message)
{
  return scene->trajectory_every == 0 || scene->model.kinds > 0 || scene->trajectory_solvent ||
         scene_refuse_at(scene, "trajectory.solvent", "trajectory.solvent", message,
                         "without fibers, frames of nothing; allowed: true");
}

/* The path of `name`, which is relative to the folder of the file `path`; to be freed. */
static char *beside(const char *path, const char *name)
{
  const char *slash = strrchr(path, '/');
  const size_t folder = slash && name[0] != '/' ? (size_t)(slash - path) + 1 : 0;
  char *joined = malloc(folder + strlen(name) + 1);
  if (joined) {
    memcpy(joined, path, folder);
    strcpy(joined + folder, name);
  }
  return joined;
}

bool scene_finds_snapshot(const struct scene *scene, struct message *message)
{
  char *path = scene_snapshot_path(scene);
  const bool ok = !scene->snapshot || (path && access(path, R_OK) == 0);
  if (!ok)
    scene_refuse_at(scene, "start.snapshot", "start.snapshot", message,
                    "'%s' cannot be read: %s; allowed: a checkpoint or an H5MD file", path ? path : scene->snapshot,
                    strerror(errno));
  free(path);
  return ok;
}

/* --- reading ------------------------------------------------------------------------------------------------------ */

/* What file and settings say. */
static bool read_tree(const struct scene_source *r, struct tree *tree)
{
  if (r->text && !yaml_read(tree, r->path, r->text, r->size, r->message))
    return false;
  for (size_t i = 0; r->settings && i < r->settings->count; i++)
    if (!tree_set_option(tree, r->keys, r->settings->option[i], i < r->settings->once, r->message))
      return false;
  if (!tree->root)
    return message_at(r->message, r->path, 1, 1, "the scene is empty; a scene is a YAML mapping, see docs/scene.md");
  return tree->root->type == NODE_MAPPING ||
         node_refuse(tree->root, r->message, "not a mapping; a scene is a YAML mapping, see docs/scene.md");
}

static bool finish_model(struct scene *scene, const struct scene_source *r)
{
  struct model_error error;
  if ((r->numbers_only ? model_finish_numbers : model_finish)(&scene->model, &error))
    return true;
  if (strncmp(error.text, "out of memory", 13) == 0)
    return message_set(r->message, "%s: %s", r->path, error.text);
  return refuse_key(scene, error.path, r->message, error.text);
}

/* XXH64, seed 0, of the effective physics written out: comments and layout do not matter. */
static bool set_fingerprint(struct scene *scene, const struct scene_source *r)
{
  char *text = NULL;
  size_t size = 0;
  FILE *stream = open_memstream(&text, &size);
  if (!stream)
    return false;
  bool ok = keys_write(r->keys, scene, stream, true);
  ok = fclose(stream) == 0 && ok;
  scene->fingerprint = ok ? XXH64(text, size, 0) : 0;
  free(text);
  return ok;
}

/* The effective scene, with a comment that says where it is from; to be freed. */
static char *effective_text(const struct scene *scene, const struct scene_source *r)
{
  char *text = NULL;
  size_t size = 0;
  FILE *stream = open_memstream(&text, &size);
  if (!stream)
    return NULL;
  fputs("# The effective scene of ", stream);
  text_print(stream, r->path);
  fputs(", every default filled in", stream);
  for (size_t i = 0; r->settings && i < r->settings->count; i++) {
    fputs("; --set ", stream);
    text_print(stream, r->settings->option[i]);
  }
  fputs("\n", stream);
  bool ok = keys_write(r->keys, scene, stream, false);
  if (fclose(stream) == 0 && ok)
    return text;
  free(text);
  return NULL;
}

/* What files keep must mean the same when it is read as what a file has kept. */
static bool set_text(struct scene *scene, const struct scene_source *r, bool defaults)
{
  const bool same = r->text && (!r->settings || r->settings->count == 0) && (!defaults || r->missing == MISSING_ABSENT);
  scene->path = strdup(r->path);
  scene->text = same ? strndup(r->text, r->size) : effective_text(scene, r);
  return scene->path && scene->text;
}

static bool read_whole(struct scene *scene, const struct scene_source *r)
{
  struct key_gaps gaps = {r->missing, false};
  if (!read_tree(r, &scene->tree) || !keys_read(scene->tree.root, r->keys, &gaps, scene, r->message) ||
      !finish_model(scene, r))
    return false;
  if (scene_says(scene, "observe.from_time"))
    scene->observe.from = step_of_time(scene->observe_from_time, scene->model.time_step);
  scene->seed = scene->model.seed;
  if (!set_text(scene, r, gaps.defaults) || !set_fingerprint(scene, r))
    return message_no_memory(r->message, "%s: out of memory", r->path);
  scene->steps = r->steps ? *r->steps : scene->steps;
  return (r->kept || check_observed(scene, r->message)) &&
         (!model_has_bead(&scene->model) || check_force(scene, r->message)) && check_lags(scene, r->message) &&
         (r->open_end || check_from(scene, r->message)) && check_trajectory(scene, r->message) &&
         (!r->look_for_files || scene_finds_snapshot(scene, r->message));
}

static bool read_once(struct scene *scene, const struct scene_source *r)
{
  memset(scene, 0, sizeof *scene);
  const bool ok = read_whole(scene, r);
  if (!ok)
    scene_free(scene);
  return ok;
}

bool scene_read_source(const struct scene_source *source, struct scene *scene)
{
  if (!read_once(scene, source))
    return false;
  if (!source->fingerprint || *source->fingerprint == scene->fingerprint || source->missing == MISSING_ABSENT)
    return true;
  struct scene old;
  struct message ignored;
  struct scene_source again = *source;
  again.missing = MISSING_ABSENT;
  again.message = &ignored;
  if (read_once(&old, &again) && old.fingerprint == *source->fingerprint) {
    scene_free(scene);
    *scene = old;
  } else {
    scene_free(&old);
  }
  return true;
}

void scene_free(struct scene *scene)
{
  model_free(&scene->model);
  tree_free(&scene->tree);
  free(scene->snapshot);
  free(scene->path);
  free(scene->text);
  memset(scene, 0, sizeof *scene);
}

static struct scene_source kept_text(const char *path, const char *text, size_t size, struct message *message)
{
  return (struct scene_source){.keys = &scene_keys,
                               .path = path,
                               .text = text,
                               .size = size,
                               .missing = MISSING_ABSENT,
                               .open_end = true,
                               .kept = true,
                               .message = message};
}

bool scene_read_text(const char *path, const char *text, size_t size, struct scene *scene, struct message *message)
{
  const struct scene_source source = kept_text(path, text, size, message);
  return scene_read_source(&source, scene);
}

bool scene_read_text_set(const char *path, const char *text, size_t size, const struct scene_settings *settings,
                         struct scene *scene, struct message *message)
{
  struct scene_source source = kept_text(path, text, size, message);
  source.settings = settings;
  return scene_read_source(&source, scene);
}

bool scene_read_text_numbers(const char *path, const char *text, size_t size, struct scene *scene,
                             struct message *message)
{
  struct scene_source source = kept_text(path, text, size, message);
  source.numbers_only = true;
  return scene_read_source(&source, scene);
}

static bool read_file(struct scene_source *source, struct scene *scene)
{
  char *text = yaml_read_file(source->path, &source->size, source->message);
  source->text = text;
  const bool ok = text && scene_read_source(source, scene);
  free(text);
  return ok;
}

bool scene_read_set(const char *path, const struct scene_settings *settings, struct scene *scene,
                    struct message *message)
{
  return read_file(
      &(struct scene_source){
          .keys = &scene_keys, .path = path, .settings = settings, .look_for_files = true, .message = message},
      scene);
}

bool scene_read_numbers(const char *path, const struct scene_settings *settings, struct scene *scene,
                        struct message *message)
{
  return read_file(&(struct scene_source){.keys = &scene_keys,
                                          .path = path,
                                          .settings = settings,
                                          .look_for_files = true,
                                          .numbers_only = true,
                                          .message = message},
                   scene);
}

bool scene_read(const char *path, struct scene *scene, struct message *message)
{
  return scene_read_set(path, NULL, scene, message);
}

bool scene_read_as(const char *path, const struct scene_settings *settings, uint64_t fingerprint, struct scene *scene,
                   struct message *message)
{
  return read_file(
      &(struct scene_source){
          .keys = &scene_keys, .path = path, .settings = settings, .fingerprint = &fingerprint, .message = message},
      scene);
}

/* --- files ------------------------------------------------------------------------------------------------------- */

char *scene_snapshot_path(const struct scene *scene)
{
  return scene->snapshot ? beside(scene->path, scene->snapshot) : NULL;
}

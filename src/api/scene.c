/* Scenes behind include/uncross.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/handle.h"
#include "files/checkpoint.h"
#include "scene/scene_keys.h"
#include "scene/set.h"
#include "scene/yaml.h"

static struct scene_settings settings_of(const struct uncross_scene *scene)
{
  return (struct scene_settings){scene->settings, (const char *const *)scene->setting, scene->given};
}

/* The code of what went wrong with a scene. */
static int code_of(const struct message *message)
{
  return message->kind == MESSAGE_NO_MEMORY ? UNCROSS_NO_MEMORY : UNCROSS_BAD_INPUT;
}

/* How a scene is read: see struct scene_source. */
struct reading {
  bool numbers_only, look_for_files, open_end;
};

/* checkpoint: that of the run which the scene is read for; NULL: none. */
static int read_source(const struct uncross_scene *from, struct reading how, const char *checkpoint,
                       struct scene *scene, uncross_error *error)
{
  struct message message;
  uint64_t fingerprint;
  const struct scene_settings settings = settings_of(from);
  const struct scene_source source = {
      .keys = &scene_keys,
      .path = from->name,
      .text = from->text,
      .size = from->text ? strlen(from->text) : 0,
      .settings = &settings,
      .look_for_files = how.look_for_files,
      .numbers_only = how.numbers_only,
      .open_end = how.open_end,
      .steps = from->has_steps ? &from->steps : NULL,
      .fingerprint = checkpoint && checkpoint_fingerprint(checkpoint, &fingerprint) ? &fingerprint : NULL,
      .message = &message};
  if (!scene_read_source(&source, scene))
    return fail(error, code_of(&message), message.text, NULL);
  if (from->has_seed)
    scene->seed = scene->model.seed = from->seed;
  return UNCROSS_OK;
}

int handle_read(const struct uncross_scene *from, const char *checkpoint, struct scene *scene, uncross_error *error)
{
  return read_source(from, (struct reading){false, false, false}, checkpoint, scene, error);
}

static int check(const struct uncross_scene *scene, bool look_for_files, bool open_end, uncross_error *error)
{
  struct scene made;
  const int code = read_source(scene, (struct reading){true, look_for_files, open_end}, NULL, &made, error);
  if (code == UNCROSS_OK)
    scene_free(&made);
  return code;
}

/* --- making ------------------------------------------------------------------------------------------------------ */

/* text: NULL for none. */
static uncross_scene *make(const char *name, const char *text, size_t size)
{
  uncross_scene *scene = calloc(1, sizeof *scene);
  if (!scene)
    return NULL;
  scene->name = strdup(name);
  scene->text = text ? strndup(text, size) : NULL;
  if (scene->name && (!text || scene->text))
    return scene;
  uncross_scene_free(scene);
  return NULL;
}

/* Whether settings can be read: count texts. */
static bool settings_fit(const char *const *settings, size_t count, uncross_error *error)
{
  char what[64] = "settings";
  bool fit = count == 0 || settings;
  for (size_t k = 0; fit && k < count; k++) {
    fit = settings[k] != NULL;
    snprintf(what, sizeof what, "settings[%zu]", k);
  }
  return fit || (fail_null(error, what), false);
}

/* Appends a setting, which becomes the scene's to free. */
static int append(struct uncross_scene *scene, char *setting, uncross_error *error)
{
  char **more = setting ? realloc(scene->setting, (scene->settings + 1) * sizeof *more) : NULL;
  if (!more) {
    free(setting);
    return fail(error, UNCROSS_NO_MEMORY, "no memory for a setting", NULL);
  }
  scene->setting = more;
  scene->setting[scene->settings++] = setting;
  return UNCROSS_OK;
}

static uncross_scene *make_with(const char *name, const char *text, size_t size, const char *const *settings,
                                size_t count, uncross_error *error)
{
  uncross_scene *scene = make(name, text, size);
  int code = scene ? UNCROSS_OK : fail(error, UNCROSS_NO_MEMORY, "no memory for this scene", NULL);
  for (size_t k = 0; code == UNCROSS_OK && k < count; k++)
    code = append(scene, strdup(settings[k]), error);
  if (scene)
    scene->given = scene->settings;
  if (code == UNCROSS_OK)
    code = check(scene, false, true, error); /* uncross_scene_set_steps may follow, or a resume without the snapshot */
  if (code == UNCROSS_OK)
    return scene;
  uncross_scene_free(scene);
  return NULL;
}

uncross_scene *uncross_scene_parse(const char *name, const char *text, const char *const *settings, size_t count,
                                   uncross_error *error)
{
  if (!name || !text) {
    fail_null(error, "name or text");
    return NULL;
  }
  if (!settings_fit(settings, count, error))
    return NULL;
  struct call call;
  call_begin(&call, false);
  uncross_scene *scene = make_with(name, text, strlen(text), settings, count, error);
  call_end(&call);
  return scene;
}

uncross_scene *uncross_scene_read(const char *path, const char *const *settings, size_t count, uncross_error *error)
{
  if (!path) {
    fail_null(error, "path");
    return NULL;
  }
  if (!settings_fit(settings, count, error))
    return NULL;
  struct call call;
  struct message message;
  size_t size;
  call_begin(&call, false);
  char *text = yaml_read_file(path, &size, &message);
  uncross_scene *scene = text ? make_with(path, text, size, settings, count, error) : NULL;
  if (!text)
    fail(error, code_of(&message), message.text, NULL);
  free(text);
  call_end(&call);
  return scene;
}

uncross_scene *uncross_scene_new(uncross_error *error)
{
  uncross_scene *scene = make("settings", NULL, 0);
  if (!scene)
    fail(error, UNCROSS_NO_MEMORY, "no memory for this scene", NULL);
  return scene;
}

void uncross_scene_free(uncross_scene *scene)
{
  if (!scene)
    return;
  for (size_t k = 0; k < scene->settings; k++)
    free(scene->setting[k]);
  free(scene->setting);
  free(scene->name);
  free(scene->text);
  free(scene);
}

/* --- setting ----------------------------------------------------------------------------------------------------- */

/* Whether all settings, and then this one, name keys and hold values. */
static bool can_be_set(const struct uncross_scene *scene, const char *setting, struct message *message)
{
  struct tree tree = {.root = NULL};
  bool ok = !scene->text || yaml_read(&tree, scene->name, scene->text, strlen(scene->text), message);
  for (size_t k = 0; ok && k < scene->settings; k++)
    ok = tree_set_option(&tree, &scene_keys, scene->setting[k], k < scene->given, message);
  ok = ok && tree_set_option(&tree, &scene_keys, setting, false, message);
  tree_free(&tree);
  return ok;
}

static int set(struct uncross_scene *scene, const char *path, const char *value, uncross_error *error)
{
  struct message message;
  const size_t size = strlen(path) + strlen(value) + 2;
  char *setting = malloc(size);
  if (!setting)
    return append(scene, NULL, error);
  snprintf(setting, size, "%s=%s", path, value);
  if (can_be_set(scene, setting, &message))
    return append(scene, setting, error);
  free(setting);
  return fail(error, code_of(&message), message.text, NULL);
}

int uncross_scene_set(uncross_scene *scene, const char *path, const char *value, uncross_error *error)
{
  if (!scene || !path || !value)
    return fail_null(error, "scene, path or value");
  struct call call;
  call_begin(&call, false);
  const int code = set(scene, path, value, error);
  call_end(&call);
  return code;
}

int uncross_scene_set_steps(uncross_scene *scene, uint64_t steps, uncross_error *error)
{
  if (!scene)
    return fail_null(error, "scene");
  if (steps > MOST_STEPS)
    return fail_steps(error, MOST_STEPS);
  scene->has_steps = true;
  scene->steps = steps;
  return UNCROSS_OK;
}

int uncross_scene_set_seed(uncross_scene *scene, uint64_t seed, uncross_error *error)
{
  if (!scene)
    return fail_null(error, "scene");
  scene->has_seed = true;
  scene->seed = seed;
  return UNCROSS_OK;
}

int uncross_scene_watch_start(uncross_scene *scene, uncross_start_watch *watch, void *context, uncross_error *error)
{
  if (!scene)
    return fail_null(error, "scene");
  scene->watch = watch;
  scene->context = context;
  return UNCROSS_OK;
}

/* --- looking ----------------------------------------------------------------------------------------------------- */

int uncross_scene_check(const uncross_scene *scene, uncross_error *error)
{
  if (!scene)
    return fail_null(error, "scene");
  struct call call;
  call_begin(&call, false);
  const int code = check(scene, true, false, error);
  call_end(&call);
  return code;
}

static char *effective_text(const struct uncross_scene *from, uncross_error *error)
{
  struct scene scene;
  char *text = NULL;
  size_t size;
  if (handle_read(from, NULL, &scene, error) != UNCROSS_OK)
    return NULL;
  FILE *stream = open_memstream(&text, &size);
  bool ok = stream && scene_write(&scene, stream, false);
  scene_free(&scene);
  if (stream)
    ok = fclose(stream) == 0 && ok;
  if (ok)
    return text;
  free(text);
  fail(error, UNCROSS_NO_MEMORY, "no memory for the text of the scene", NULL);
  return NULL;
}

char *uncross_scene_text(const uncross_scene *scene, uncross_error *error)
{
  if (!scene) {
    fail_null(error, "scene");
    return NULL;
  }
  struct call call;
  call_begin(&call, false);
  char *text = effective_text(scene, error);
  call_end(&call);
  return text;
}

/* The text of a scalar, or "[a, b]" of a list of them; false if it is anything else. */
static bool print_value(const struct node *node, FILE *stream)
{
  if (node->type == NODE_SCALAR)
    return node_text(node) && fputs(node_text(node), stream) >= 0;
  bool ok = node->type == NODE_LIST;
  for (size_t k = 0; ok && k < node->count; k++) {
    fputs(k ? ", " : "[", stream);
    ok = node->item[k]->type == NODE_SCALAR && print_value(node->item[k], stream);
  }
  fputs(ok ? "]" : "", stream);
  return ok;
}

/* The node at a path, with items of lists by number or by name, and nothing less. */
static const struct node *node_exactly(const struct node *node, const char *path)
{
  while (node && *path) {
    char part[80];
    const size_t length = strcspn(path, ".");
    snprintf(part, sizeof part, "%.*s", (int)length, path);
    node = node->type == NODE_LIST ? node_item_of(node, part) : node_value(node, part);
    path += length + (path[length] == '.');
  }
  return node;
}

static char *get(const struct uncross_scene *scene, const char *path, uncross_error *error)
{
  struct tree tree = {.root = NULL};
  struct message message = {.text = "no memory for a value"};
  char *text = effective_text(scene, error), *found = NULL;
  size_t size;
  if (!text)
    return NULL;
  if (yaml_read(&tree, scene->name, text, strlen(text), &message)) {
    const struct node *node = node_exactly(tree.root, path);
    FILE *stream = open_memstream(&found, &size);
    const bool is_value = stream && node && print_value(node, stream);
    if (stream)
      message_set(&message, "%s: %s", path, node ? "a section, no value" : "no such key in this scene");
    if ((stream && fclose(stream) != 0) || !is_value) {
      free(found);
      found = NULL;
    }
  }
  tree_free(&tree);
  free(text);
  if (!found)
    fail(error, code_of(&message), message.text, NULL);
  return found;
}

char *uncross_scene_get(const uncross_scene *scene, const char *path, uncross_error *error)
{
  if (!scene || !path) {
    fail_null(error, "scene or path");
    return NULL;
  }
  struct call call;
  call_begin(&call, false);
  char *found = get(scene, path, error);
  call_end(&call);
  return found;
}

int uncross_scene_number(const uncross_scene *scene, const char *path, double *value, uncross_error *error)
{
  if (!scene || !path || !value)
    return fail_null(error, "scene, path or value");
  uncross_error trouble = {.code = UNCROSS_BAD_INPUT};
  struct call call;
  call_begin(&call, false);
  char *text = get(scene, path, &trouble), *end = text;
  const double number = text ? strtod(text, &end) : 0.0;
  const bool ok = text && end != text && *end == '\0';
  if (text && !ok)
    fail(&trouble, UNCROSS_BAD_INPUT, "this key holds no single number", NULL);
  uncross_free(text);
  call_end(&call);
  if (ok)
    *value = number;
  else if (error)
    *error = trouble;
  return ok ? UNCROSS_OK : trouble.code;
}

int uncross_scene_warnings(const uncross_scene *scene, void (*tell)(void *context, const char *text), void *context,
                           uncross_error *error)
{
  if (!scene || !tell)
    return fail_null(error, "scene or tell");
  struct call call;
  struct scene made;
  call_begin(&call, false);
  const int code = handle_read(scene, NULL, &made, error);
  if (code == UNCROSS_OK) {
    scene_warnings(&made, tell, context);
    scene_free(&made);
  }
  call_end(&call);
  return code;
}

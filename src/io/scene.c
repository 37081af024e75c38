#include "io/scene.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

#include "fiber/start.h"
#include "io/scene_keys.h"
#include "observe/theory.h"

/* A scene on its way from a draft to a model: values are in range, each taken alone; what follows looks at them
 * together. */
struct settling {
  const struct yaml_file *file;
  const yaml_node_t *root;
  struct draft *draft;
  struct message *message;
  bool look_for_files; /* whether the snapshot can be read */
};

/* Where the value of section.key stands, or the section if the key is not given, or the whole if that is not either. */
static const yaml_node_t *place_of(const struct settling *s, const yaml_node_t *section, const char *key)
{
  const yaml_node_t *value = yaml_value_of(s->file, section, key);
  return value ? value : section ? section : s->root;
}

static const yaml_node_t *kind_node(const struct settling *s, uint32_t k)
{
  return yaml_item(s->file, yaml_value_of(s->file, s->root, "fibers"), k);
}

static struct draft_kind *draft_kind(const struct settling *s, uint32_t k)
{
  return (struct draft_kind *)s->draft->fibers.item + k;
}

/* --- solvent ----------------------------------------------------------------------------------------------------- */

/* Exact at the angles whose cosine and sine are whole numbers. */
static void set_rotation(struct solvent_model *solvent)
{
  const double angle = solvent->rotation_angle, radians = angle * (3.14159265358979323846 / 180.0);
  solvent->cosine = angle == 90.0 ? 0.0 : angle == 180.0 ? -1.0 : cos(radians);
  solvent->sine = angle == 90.0 ? 1.0 : angle == 180.0 ? 0.0 : sin(radians);
}

static bool settle_interval(const struct settling *s, const yaml_node_t *node)
{
  struct model *m = &s->draft->scene.model;
  double ratio = s->draft->collision_interval / m->time_step, whole = nearbyint(ratio);
  if (!(whole >= 1.0 && whole <= 1e9 && fabs(ratio - whole) <= 1e-9 * whole))
    return yaml_refuse(
        s->file, place_of(s, node, "collision_interval"), s->message,
        "solvent.collision_interval: %.15g is %.10g time steps of %.15g; allowed: a whole multiple of the "
        "time step, 1 to 1e9 of them",
        s->draft->collision_interval, ratio, m->time_step);
  m->solvent.interval_steps = (uint32_t)whole;
  return true;
}

enum { MOST_PHANTOMS = 1000 }; /* per cell: keeps their momentum within a part of its sum's range, see solvent/bath.c */

/* Phantoms are a heat bath of their own, without a past or a motion that others could act on. */
static bool settle_phantoms(const struct settling *s, const yaml_node_t *node)
{
  const struct solvent_model *m = &s->draft->scene.model.solvent;
  const struct {
    bool ok;
    const char *why;
  } rows[] = {
      {!m->hydrodynamics, "phantoms carry no hydrodynamic interactions; allowed with hydrodynamics: false"},
      {m->thermostat == THERMOSTAT_NONE, "phantoms are a thermostat; allowed with thermostat: none"},
      {vec3_norm(m->acceleration) == 0.0, "phantoms are not accelerated; allowed with acceleration: [0, 0, 0]"},
      {m->per_cell <= MOST_PHANTOMS, "too many phantoms; allowed with a per_cell of at most 1000"},
      {s->draft->fibers.count > 0, "phantoms are drawn for fibers only, and there are none; allowed: particles"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (!rows[i].ok)
      return yaml_refuse(s->file, place_of(s, node, "bath"), s->message, "solvent.bath: %s", rows[i].why);
  return true;
}

static bool settle_particles(const struct settling *s, const yaml_node_t *node)
{
  struct model *m = &s->draft->scene.model;
  if (model_has_phantoms(m))
    return settle_phantoms(s, node);
  double particles = nearbyint(m->solvent.per_cell * box_volume(&m->box));
  if (!(particles >= 1.0 && particles < 2147483648.0))
    return yaml_refuse(s->file, place_of(s, node, "per_cell"), s->message,
                       "solvent.per_cell: %.15g in a box of %.0f cells makes %.0f particles; allowed: 1 to 2147483647",
                       m->solvent.per_cell, box_volume(&m->box), particles);
  m->solvent.particles = (uint32_t)particles;
  return true;
}

static bool settle_solvent(const struct settling *s)
{
  const yaml_node_t *node = yaml_value_of(s->file, s->root, "solvent");
  set_rotation(&s->draft->scene.model.solvent);
  return !node || (settle_interval(s, node) && settle_particles(s, node));
}

/* --- fibers ------------------------------------------------------------------------------------------------------ */

static bool settle_name(const struct settling *s, uint32_t k)
{
  const char *name = draft_kind(s, k)->kind.name;
  for (uint32_t i = 0; i < k; i++)
    if (strcmp(name, draft_kind(s, i)->kind.name) == 0)
      return yaml_refuse(s->file, place_of(s, kind_node(s, k), "name"), s->message,
                         "fibers.name: '%s' is the name of an earlier kind; allowed: a name of its own", name);
  return true;
}

/* Masses are summed exactly, in multiples of MODEL_MASS_UNIT. */
static bool settle_mass(const struct settling *s, uint32_t k)
{
  struct fiber_kind *kind = &draft_kind(s, k)->kind;
  double rounded = nearbyint(kind->mass / MODEL_MASS_UNIT) * MODEL_MASS_UNIT;
  if (rounded <= 0.0)
    return yaml_refuse(s->file, place_of(s, kind_node(s, k), "mass"), s->message,
                       "fibers.mass: %.15g is rounded to a multiple of 2^-16 = 1.52587890625e-05, which is 0; allowed: "
                       "1.52587890625e-05 to 65536",
                       kind->mass);
  kind->mass = rounded;
  return true;
}

/* kappa = l_p/l0, Eq. (2) */
static bool settle_bending(const struct settling *s, uint32_t k)
{
  struct draft_kind *d = draft_kind(s, k);
  const yaml_node_t *node = kind_node(s, k), *persistence = yaml_value_of(s->file, node, "persistence_length");
  if (!persistence)
    return true;
  if (yaml_value_of(s->file, node, "bending"))
    return yaml_refuse(s->file, persistence, s->message,
                       "fibers.persistence_length: bending is given too; allowed: one of the two");
  if (d->kind.bond_length == 0.0)
    return yaml_refuse(
        s->file, persistence, s->message,
        "fibers.persistence_length: bending = persistence_length/bond_length needs a bond_length above 0; "
        "allowed: give bending instead");
  d->kind.bending = d->persistence_length / d->kind.bond_length;
  return true;
}

static bool settle_shape(const struct settling *s, uint32_t k)
{
  struct fiber_kind *kind = &draft_kind(s, k)->kind;
  const yaml_node_t *node = kind_node(s, k), *start = yaml_value_of(s->file, node, "start");
  if (kind->ring && kind->vertices < 3)
    return yaml_refuse(s->file, place_of(s, node, "vertices"), s->message,
                       "fibers.vertices: a ring of %" PRIu32 "; allowed: 3 or more", kind->vertices);
  if (!start)
    kind->start = kind->ring ? START_CIRCLE : START_EQUILIBRIUM;
  if (kind->ring != (kind->start == START_CIRCLE))
    return yaml_refuse(s->file, start, s->message, "fibers.start: %s for %s; allowed: %s",
                       scene_start_words[kind->start], kind->ring ? "a ring" : "an open fiber",
                       kind->ring ? "circle" : "equilibrium | straight");
  return true;
}

/* Bonds must stay below half the shortest edge, where another image of a vertex is as near; and everything must be
 * within reach of lattice_from_a0 when it is laid, and of 64-bit positions for a long run after that. */
static bool settle_extent(const struct settling *s, uint32_t k)
{
  const struct fiber_kind *kind = &draft_kind(s, k)->kind;
  const yaml_node_t *node = kind_node(s, k);
  const double bond = fiber_mean_bond(kind), limit = 0.5 * box_shortest_edge(&s->draft->scene.model.box);
  if (kind->vertices < 2)
    return true;
  if (!(bond < limit))
    return yaml_refuse(
        s->file, place_of(s, node, "bond_length"), s->message,
        "fibers.bond_length: the mean length of a bond is %.6g a0; allowed: below half the shortest edge of "
        "the box, %.6g a0",
        bond, limit);
  const double contour = theory_contour(kind), half = kind->ring ? contour / 6.283185307179586 : 0.5 * contour;
  const double longest = kind->start == START_EQUILIBRIUM ? 1e6 : LATTICE_MAX_MOVE - 1.0;
  const double extent = kind->start == START_EQUILIBRIUM ? contour : half;
  if (!(extent < longest))
    return yaml_refuse(s->file, place_of(s, node, "vertices"), s->message,
                       "fibers.vertices: %" PRIu32 " of them make %s of %.6g a0; allowed: below %.6g a0",
                       kind->vertices,
                       kind->start == START_EQUILIBRIUM ? "a contour"
                       : kind->ring                     ? "a radius"
                                                        : "a half length",
                       extent, longest);
  return true;
}

static bool copy_places(const struct settling *s, uint32_t k)
{
  struct draft_kind *d = draft_kind(s, k);
  const struct draft_place *place = d->places.item;
  const uint32_t count = d->places.count;
  d->kind.center = calloc(count, sizeof *d->kind.center);
  d->kind.direction = calloc(count, sizeof *d->kind.direction);
  if (!d->kind.center || !d->kind.direction)
    return message_set(s->message, "%s: out of memory", s->file->path);
  for (uint32_t i = 0; i < count; i++) {
    d->kind.center[i] = place[i].center;
    d->kind.direction[i] = place[i].direction;
  }
  d->kind.placed = count;
  return true;
}

static bool settle_places(const struct settling *s, uint32_t k)
{
  const struct draft_kind *d = draft_kind(s, k);
  const struct draft_place *place = d->places.item;
  const yaml_node_t *list = yaml_value_of(s->file, kind_node(s, k), "places");
  if (d->places.count == 0)
    return true;
  if (d->kind.start == START_EQUILIBRIUM)
    return yaml_refuse(s->file, list, s->message,
                       "fibers.places: fibers that start in equilibrium are placed at random; allowed with start: "
                       "straight, or for rings");
  if (d->places.count > d->kind.count)
    return yaml_refuse(s->file, yaml_item(s->file, list, d->kind.count), s->message,
                       "fibers.places: %" PRIu32 " places; allowed: at most as many as fibers, %" PRIu32,
                       d->places.count, d->kind.count);
  for (uint32_t i = 0; i < d->places.count; i++)
    if (!(vec3_norm(place[i].direction) > 1e-6))
      return yaml_refuse(s->file, place_of(s, yaml_item(s->file, list, i), "direction"), s->message,
                         "fibers.places.direction: no direction; allowed: any vector longer than 1e-6");
  return copy_places(s, k);
}

/* The leap-frog of the fastest vibration: Eqs. (4) and (8), is stable below omega dt = 2. */
static bool settle_stability(const struct settling *s, uint32_t k)
{
  const struct fiber_kind *kind = &draft_kind(s, k)->kind;
  const double dt = s->draft->scene.model.time_step, omega = theory_highest_frequency(kind);
  return omega * dt < 2.0 ||
         yaml_refuse(s->file, place_of(s, s->root, "time_step"), s->message,
                     "time_step: %.15g is unstable for the fibers '%s', whose highest frequency is %.6g / t0; allowed: "
                     "below %.6g, and a tenth of that for accuracy",
                     dt, kind->name, omega, 2.0 / omega);
}

static bool settle_count(const struct settling *s, uint32_t k, uint64_t *vertices)
{
  const struct fiber_kind *kind = &draft_kind(s, k)->kind;
  *vertices += (uint64_t)kind->count * kind->vertices;
  return *vertices <= INT32_MAX ||
         yaml_refuse(s->file, place_of(s, kind_node(s, k), "count"), s->message,
                     "fibers.count: %" PRIu64 " vertices up to here; allowed: 2147483647 in all", *vertices);
}

static bool settle_fibers(const struct settling *s)
{
  uint64_t vertices = 0;
  for (uint32_t k = 0; k < s->draft->fibers.count; k++)
    if (!(settle_name(s, k) && settle_mass(s, k) && settle_bending(s, k) && settle_shape(s, k) &&
          settle_count(s, k, &vertices) && settle_extent(s, k) && settle_places(s, k) && settle_stability(s, k)))
      return false;
  return true;
}

/* --- the whole --------------------------------------------------------------------------------------------------- */

static bool settle_observables(const struct settling *s)
{
  const struct observe_plan *plan = &s->draft->scene.observe;
  const yaml_node_t *dynamics =
      yaml_value_of(s->file, yaml_value_of(s->file, s->root, "observe"), observable_names[OBSERVE_DYNAMICS]);
  if (plan->longest_lag == 0 || plan->longest_lag >= plan->every[OBSERVE_DYNAMICS])
    return true;
  return yaml_refuse(s->file, place_of(s, dynamics, "longest_lag"), s->message,
                     "observe.dynamics.longest_lag: %" PRIu64 " steps, sampled every %" PRIu64
                     "; allowed: 0 (as long as the run allows), or at least one sample's distance",
                     plan->longest_lag, plan->every[OBSERVE_DYNAMICS]);
}

/* Moves the kinds into the model, so that model_free frees them. */
static bool move_kinds(const struct settling *s)
{
  struct model *m = &s->draft->scene.model;
  const uint32_t kinds = s->draft->fibers.count;
  m->kind = calloc(kinds ? kinds : 1, sizeof *m->kind);
  if (!m->kind)
    return message_set(s->message, "%s: out of memory", s->file->path);
  for (uint32_t k = 0; k < kinds; k++) {
    m->kind[k] = draft_kind(s, k)->kind;
    draft_kind(s, k)->kind.center = draft_kind(s, k)->kind.direction = NULL;
  }
  m->kinds = kinds;
  return model_finish(m) || message_set(s->message, "%s: out of memory for this many vertices", s->file->path);
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

static bool settle_snapshot(const struct settling *s)
{
  const char *snapshot = s->draft->scene.snapshot;
  if (!snapshot || !s->look_for_files)
    return true;
  char *path = beside(s->file->path, snapshot);
  bool ok = path && access(path, R_OK) == 0;
  if (!ok)
    yaml_refuse(s->file, place_of(s, yaml_value_of(s->file, s->root, "start"), "snapshot"), s->message,
                "start.snapshot: '%s' cannot be read: %s; allowed: a checkpoint or an H5MD file",
                path ? path : snapshot, strerror(errno));
  free(path);
  return ok;
}

static bool settle(const struct settling *s)
{
  struct model *m = &s->draft->scene.model;
  m->box = box_of_cells(m->box.cells[0], m->box.cells[1], m->box.cells[2]);
  if (!settle_solvent(s) || !settle_fibers(s) || !settle_observables(s) || !settle_snapshot(s))
    return false;
  if (m->solvent.particles == 0 && s->draft->fibers.count == 0)
    return yaml_refuse(s->file, s->root, s->message,
                       "there is nothing to simulate; a scene has a 'solvent', 'fibers', or both");
  return move_kinds(s);
}

static void free_draft(struct draft *draft)
{
  struct draft_kind *d = draft->fibers.item;
  for (uint32_t k = 0; k < draft->fibers.count; k++) {
    free(d[k].places.item);
    free(d[k].kind.center);
    free(d[k].kind.direction);
  }
  free(d);
  draft->fibers = (struct key_list){NULL, 0};
}

static bool read_draft(struct draft *draft, const struct yaml_file *file, bool look_for_files, struct message *message)
{
  const yaml_node_t *root = yaml_file_root(file);
  if (!root)
    return message_at(message, file->path, 1, 1, "the scene is empty; a scene is a YAML mapping, see docs/scene.md");
  if (root->type != YAML_MAPPING_NODE)
    return yaml_refuse(file, root, message, "not a mapping; a scene is a YAML mapping, see docs/scene.md");
  const struct settling settling = {file, root, draft, message, look_for_files};
  bool ok = keys_read(file, root, &scene_top_table, draft, message) && settle(&settling);
  free_draft(draft);
  return ok;
}

/* XXH64, seed 0, of the effective physics written out: comments and layout do not matter. */
static bool set_fingerprint(struct scene *scene)
{
  char *text = NULL;
  size_t size = 0;
  FILE *stream = open_memstream(&text, &size);
  if (!stream)
    return false;
  scene_write(scene, stream, true);
  bool ok = fclose(stream) == 0;
  scene->fingerprint = ok ? XXH64(text, size, 0) : 0;
  free(text);
  return ok;
}

static bool read_scene(const char *path, const char *text, size_t size, bool look_for_files, struct scene *scene,
                       struct message *message)
{
  struct yaml_file file;
  struct draft draft;
  memset(&draft, 0, sizeof draft);
  if (!yaml_file_open(&file, path, text, size, message))
    return false;
  bool ok = read_draft(&draft, &file, look_for_files, message);
  yaml_file_close(&file);
  *scene = draft.scene;
  if (ok) {
    scene->path = strdup(path);
    scene->text = strndup(text, size);
    ok = (scene->path && scene->text && set_fingerprint(scene)) || message_set(message, "%s: out of memory", path);
  }
  if (!ok)
    scene_free(scene);
  return ok;
}

bool scene_read_text(const char *path, const char *text, size_t size, struct scene *scene, struct message *message)
{
  return read_scene(path, text, size, false, scene, message);
}

void scene_free(struct scene *scene)
{
  model_free(&scene->model);
  free(scene->snapshot);
  free(scene->path);
  free(scene->text);
  memset(scene, 0, sizeof *scene);
}

/* --- files ------------------------------------------------------------------------------------------------------- */

enum { SCENE_MAX_BYTES = 1 << 26 }; /* a scene is written by a person or a small script */

/* The whole file, to be freed; NULL, with a message, on failure. */
static char *read_whole_file(const char *path, size_t *size, struct message *message)
{
  FILE *file = fopen(path, "rb");
  char *text = NULL;
  size_t room = 1 << 14;
  *size = 0;
  bool ok = file && (text = malloc(room)) != NULL;
  while (ok && !feof(file)) {
    *size += fread(text + *size, 1, room - *size, file);
    if (ferror(file) || *size > SCENE_MAX_BYTES) {
      ok = false;
    } else if (*size == room) {
      char *more = realloc(text, room *= 2);
      ok = more != NULL;
      text = more ? more : text;
    }
  }
  if (!ok) {
    message_set(message, "%s: cannot be read: %s; a scene is a YAML file of at most 64 MiB", path,
                *size > SCENE_MAX_BYTES ? "too large" : strerror(errno));
    free(text);
    text = NULL;
  }
  if (file)
    fclose(file);
  return text;
}

char *scene_snapshot_path(const struct scene *scene)
{
  return scene->snapshot ? beside(scene->path, scene->snapshot) : NULL;
}

bool scene_read(const char *path, struct scene *scene, struct message *message)
{
  size_t size;
  char *text = read_whole_file(path, &size, message);
  if (!text)
    return false;
  bool ok = read_scene(path, text, size, true, scene, message);
  free(text);
  return ok;
}

/* The process that lets HDF5 look at a file with frames. */
#include "files/frames_apart.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "files/foreign.h"
#include "files/frames.h"
#include "files/reader.h"
#include "files/trajectory.h"
#include "scene/scene.h"
#include "wall/motion.h"

#define LOST_NUMBER 2 /* verdicts that are sent are not negative */

struct source {
  const char *path;
  struct frames_about about;
  unsigned failures; /* of HDF5 */
  hid_t file;
  struct trajectory *trajectory; /* NULL: a checkpoint */
  struct structure structure;
  char *scene;
  double *position, *velocity; /* [3 rows] */
};

/* --- what the file is -------------------------------------------------------------------------------------------- */

static void read_creator(hid_t file, struct frames_about *about)
{
  hid_t h5md = h5_open_group(file, "h5md"), creator = h5_open_group(h5md, "creator");
  hid_t by = h5_open_group(h5md, "author");
  snprintf(about->creator, sizeof about->creator, "unknown");
  snprintf(about->author, sizeof about->author, "unknown");
  if (creator >= 0) {
    h5_get_text(creator, "name", about->creator, sizeof about->creator);
    h5_get_text(creator, "version", about->version, sizeof about->version);
  }
  if (by >= 0)
    h5_get_text(by, "name", about->author, sizeof about->author);
  h5_close(by);
  h5_close(creator);
  h5_close(h5md);
  H5Eclear2(H5E_DEFAULT);
}

/* Earlier trajectories of ours hold the seed only, which was the stream; and no slide, which was 0. */
static void read_stream(hid_t file, struct frames_about *about)
{
  hid_t parameters = h5_open_group(file, "parameters"), own = h5_open_group(parameters, "uncross");
  about->has_stream = own >= 0 && h5_get(own, "seed", H5T_NATIVE_UINT64, 0, &about->seed);
  if (!about->has_stream || !h5_get(own, "stream", H5T_NATIVE_UINT64, 0, &about->stream))
    about->stream = about->seed;
  if (own < 0 || !h5_get(own, "slide", H5T_NATIVE_UINT64, 0, &about->slide))
    about->slide = 0;
  h5_close(own);
  h5_close(parameters);
  H5Eclear2(H5E_DEFAULT);
}

enum { WORD = 16, AXES = 3 };

/* Three words of an attribute, cut to their first letters. Others write them with variable lengths. */
static bool read_words(hid_t object, const char *name, char word[AXES][WORD])
{
  hid_t attribute = object >= 0 && H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
  hid_t stored = attribute < 0 ? -1 : H5Aget_type(attribute), space = attribute < 0 ? -1 : H5Aget_space(attribute);
  hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, WORD);
  bool ok = stored >= 0 && H5Tget_class(stored) == H5T_STRING && H5Sget_simple_extent_npoints(space) == AXES;
  if (ok && H5Tis_variable_str(stored) > 0) {
    char *text[AXES] = {NULL};
    ok = H5Aread(attribute, stored, text) >= 0;
    for (int k = 0; k < AXES; k++) {
      snprintf(word[k], WORD, "%s", ok && text[k] ? text[k] : "");
      H5free_memory(text[k]);
    }
  } else if (ok) {
    H5Tset_cset(type, H5Tget_cset(stored));
    ok = H5Aread(attribute, type, word) >= 0;
  }
  h5_close(type);
  h5_close(space);
  h5_close(stored);
  h5_close(attribute);
  return ok;
}

static void read_boundary(const struct trajectory *t, struct frames_about *about)
{
  static const char allowed[] = "periodic, none";
  char word[AXES][WORD] = {""};
  hid_t box = h5_open_group(t->group, "box");
  about->bounded = read_words(box, "boundary", word);
  if (!about->bounded && box >= 0 && H5Aexists(box, "boundary") > 0 && !about->unfit[0])
    snprintf(about->unfit, sizeof about->unfit, "its box has a boundary that is not three words; allowed: %s", allowed);
  for (int k = 0; k < AXES && about->bounded; k++) {
    about->closed[k] = strncmp(word[k], "none", WORD) == 0;
    const bool known = about->closed[k] || strncmp(word[k], "periodic", WORD) == 0;
    char text[WORD + 1] = "", shown[4 * WORD + 1];
    memcpy(text, word[k], WORD);
    if (!known && !about->unfit[0])
      snprintf(about->unfit, sizeof about->unfit, "its box is '%s' along %c; allowed: %s",
               text_escape(text, shown, sizeof shown), "xyz"[k], allowed);
  }
  h5_close(box);
  H5Eclear2(H5E_DEFAULT);
}

/* id: of the rows, NULL: none. */
static bool open_structure(struct source *s, hid_t particles, hid_t connectivity, const int64_t *id, uint32_t rows,
                           struct message *message)
{
  struct message why = {.text = ""};
  bool ok = particles >= 0 && structure_read(particles, connectivity, id, rows, &s->structure, &why);
  if (!ok && why.text[0]) {
    message_set(message, "%s: %s", s->path, why.text);
    message->kind = why.kind;
    return false;
  }
  return ok || h5_fail(message, s->path, "damaged, its species or bonds cannot be read");
}

/* After h5_text_read has failed. */
static bool no_text(const struct source *s, const char *damaged, struct message *message)
{
  return errno == ENOMEM ? message_no_memory(message, "%s: out of memory", s->path)
                         : h5_fail(message, s->path, damaged);
}

static bool open_trajectory(struct source *s, struct message *message)
{
  struct trajectory *t = s->trajectory;
  if (!trajectory_find(t, message) || !foreign_is_one(t, message))
    return false;
  const int found = h5_look(t->file, "connectivity");
  hid_t connectivity = h5_open_object(t->file, "connectivity");
  s->about.frames = t->frames;
  s->about.rows = t->particles;
  s->about.steps = t->step >= 0;
  s->about.velocities = t->velocity >= 0;
  s->about.checked = t->checksum >= 0;
  const bool none = found == 0 && t->checksum < 0; /* what we write has bonds, if only none */
  bool ok = none || connectivity >= 0 || h5_fail(message, s->path, "damaged, its bonds cannot be read");
  /* Without a frame only this dataset proves how many particles there are. */
  const hsize_t rows[1] = {t->particles};
  if (ok && (t->frames > 0 || h5_array_is(t->group, "species", 1, rows))) {
    int64_t *id = foreign_ids(t);
    ok = open_structure(s, t->group, connectivity, id, t->particles, message);
    free(id);
  }
  h5_close(connectivity);
  const int told = ok ? trajectory_read_scene(t, &s->scene) : 0;
  ok = ok && (told >= 0 || no_text(s, "damaged, its scene cannot be read", message));
  if (ok)
    read_creator(t->file, &s->about);
  if (ok)
    read_stream(t->file, &s->about);
  if (ok)
    foreign_look(t, &s->structure, &s->about);
  if (ok)
    read_boundary(t, &s->about);
  return ok;
}

static bool open_checkpoint(struct source *s, struct message *message)
{
  struct checkpoint_summary *summary = &s->about.summary;
  if (!checkpoint_find(s->file, s->path, s->about.checked, summary, message))
    return false;
  hid_t group = h5_open_group(s->file, "structure");
  const bool ok = open_structure(s, group, group, NULL, summary->vertices, message);
  h5_close(group);
  s->about.frames = 1;
  s->about.rows = summary->vertices + summary->particles;
  s->about.steps = s->about.velocities = true;
  s->about.slide = summary->head.slide;
  s->scene = ok ? h5_text_read(s->file, "scene") : NULL;
  return ok && (s->scene || no_text(s, "damaged checkpoint: its scene cannot be read", message));
}

static bool open_source(struct source *s, enum h5_trouble *trouble, struct message *message)
{
  s->file = h5_open(s->path, false, &s->about.checked, trouble, message);
  apart_shut();
  if (s->file < 0)
    return false;
  *trouble = H5_UNREADABLE;
  h5_watch(&s->failures);
  s->about.checkpoint = checkpoint_is(s->file);
  if (!s->about.checkpoint) {
    s->trajectory = trajectory_allocate(s->path);
    if (!s->trajectory)
      return message_no_memory(message, "%s: out of memory", s->path);
    s->trajectory->file = s->file;
  }
  const bool ok = (s->about.checkpoint ? open_checkpoint : open_trajectory)(s, message) &&
                  (s->failures == 0 || message_set(message, "%s: damaged: HDF5 cannot read some part of it", s->path));
  *trouble = ok ? H5_FINE : message->kind != MESSAGE_WRONG ? H5_UNREADABLE : H5_DAMAGED;
  return ok;
}

/* --- frames ------------------------------------------------------------------------------------------------------ */

static bool make_room(struct source *s, struct message *message)
{
  const size_t numbers = ((size_t)s->about.rows + 1) * 3;
  if (!s->position)
    s->position = malloc(numbers * sizeof *s->position);
  if (!s->velocity && s->about.velocities)
    s->velocity = malloc(numbers * sizeof *s->velocity);
  return (s->position && (s->velocity || !s->about.velocities)) ||
         message_no_memory(message, "%s: out of memory", s->path);
}

/* The model of the scene that a checkpoint holds: walls, shear and springs say where particles are between collisions.
 * False if it cannot be read, or is of other numbers. */
static bool read_model(const struct source *s, struct scene *scene)
{
  const struct checkpoint_summary *summary = &s->about.summary;
  struct message ignored;
  if (!scene_read_text(s->path, s->scene, strlen(s->scene), scene, &ignored))
    return false;
  const struct model *m = &scene->model;
  shear_begin(&scene->model, summary->head.slide);
  if (m->solvent.particles == summary->particles && m->vertices == summary->vertices &&
      m->dumbbells.pairs == summary->dumbbells && memcmp(m->box.cells, summary->cells, sizeof summary->cells) == 0)
    return true;
  scene_free(scene);
  return false;
}

static enum frame_verdict load_checkpoint(struct source *s, struct frame_moment *moment, struct message *message)
{
  const struct checkpoint_summary *summary = &s->about.summary;
  struct scene scene;
  const bool known = read_model(s, &scene);
  const struct model model = known ? scene.model : checkpoint_model(summary);
  struct state state;
  if (!state_alloc(&state, &model)) {
    if (known)
      scene_free(&scene);
    message_no_memory(message, "%s: out of memory", s->path);
    return FRAME_LOST;
  }
  bool ok = checkpoint_read_state(s->file, s->path, summary, &state, message);
  if (ok) { /* which has particles in the order of their ids */
    frame_positions(&state, &model, state.solvent.id, s->position);
    frame_velocities(&state, &model, state.solvent.id, s->velocity);
  }
  state_free(&state);
  if (known)
    scene_free(&scene);
  *moment = (struct frame_moment){summary->numbers.step, (double)summary->numbers.step * summary->time_step, true, {0}};
  for (int k = 0; k < 3; k++)
    moment->edge[k] = summary->cells[k];
  return ok ? FRAME_FINE : message->kind != MESSAGE_WRONG ? FRAME_LOST : FRAME_DAMAGED;
}

static enum frame_verdict load(struct source *s, uint64_t frame, struct frame_moment *moment, struct message *message)
{
  if (!make_room(s, message))
    return FRAME_LOST;
  if (!s->trajectory)
    return load_checkpoint(s, moment, message);
  memset(moment, 0, sizeof *moment);
  s->failures = 0;
  moment->has_box = true;
  const bool fine = trajectory_load(s->trajectory, frame, &moment->step, &moment->time, moment->edge, &moment->has_box,
                                    s->position, s->velocity, message);
  if (fine && s->failures > 0)
    message_set(message, "%s: frame %" PRIu64 " (step %" PRIu64 ") is damaged: HDF5 cannot read some part of it",
                s->path, frame, moment->step);
  return fine && s->failures == 0 ? FRAME_FINE : FRAME_DAMAGED;
}

static bool put_structure(struct apart *link, const struct structure *s)
{
  const int32_t kinds = s->kinds, has_mass = s->mass != NULL, stored_bonds = s->stored_bonds;
  return apart_put(link, &s->particles, sizeof s->particles) && apart_put(link, &kinds, sizeof kinds) &&
         apart_put(link, &s->bonds, sizeof s->bonds) && apart_put(link, &stored_bonds, sizeof stored_bonds) &&
         apart_put(link, s->species, s->particles * sizeof *s->species) &&
         apart_put(link, s->next, s->particles * sizeof *s->next) &&
         apart_put(link, s->name, (size_t)s->kinds * sizeof *s->name) && apart_put(link, &has_mass, sizeof has_mass) &&
         (!has_mass || apart_put(link, s->mass, s->particles * sizeof *s->mass));
}

static void answer(struct apart *link, struct source *s, const struct frame_request *request)
{
  struct message message = {.text = ""};
  struct frame_moment moment = {0};
  const enum frame_verdict verdict = load(s, request->frame, &moment, &message);
  const size_t bytes = 3 * sizeof(double) * (size_t)s->about.rows;
  apart_put_verdict(link, verdict == FRAME_LOST ? LOST_NUMBER : (int)verdict, &message);
  if (verdict == FRAME_LOST)
    return;
  apart_put(link, &moment, sizeof moment);
  if (verdict == FRAME_FINE && request->rows && apart_put(link, s->position, bytes) && s->velocity)
    apart_put(link, s->velocity, bytes);
}

/* The file is not closed: HDF5 may fail once more there, and the process ends anyway. */
static void let_go(struct source *s)
{
  structure_free(&s->structure);
  free(s->scene);
  free(s->position);
  free(s->velocity);
}

void frames_serve(struct apart *link)
{
  struct source s = {.path = link->path};
  struct message message = {.text = ""};
  struct frame_request request;
  enum h5_trouble trouble;
  bool ok = open_source(&s, &trouble, &message);
  apart_put_verdict(link, (int)(ok ? H5_FINE : trouble), &message);
  ok = ok && apart_put(link, &s.about, sizeof s.about) && put_structure(link, &s.structure) &&
       apart_put_text(link, s.scene);
  while (ok && apart_get(link, &request, sizeof request)) {
    apart_go_on(link);
    answer(link, &s, &request);
  }
  let_go(&s);
}

/* --- sorts of files ---------------------------------------------------------------------------------------------- */

/* False if the file has particles that cannot be read. */
static bool find_sort(hid_t file, enum h5_sort *sort)
{
  static const struct {
    const char *format;
    enum h5_sort sort;
  } known[] = {{CHECKPOINT_FORMAT, H5_CHECKPOINT}, {"uncross pack", H5_PACK}};
  char format[64];
  const int particles = h5_look(file, "particles");
  *sort = particles > 0 ? H5_TRAJECTORY : H5_OTHER;
  for (size_t k = 0; k < sizeof known / sizeof *known; k++)
    if (h5_get_text(file, "format", format, sizeof format) && strcmp(format, known[k].format) == 0)
      *sort = known[k].sort;
  return particles >= 0;
}

void sort_serve(struct apart *link)
{
  struct message message = {.text = ""};
  enum h5_trouble trouble;
  bool sealed;
  unsigned failures = 0;
  hid_t file = h5_open(link->path, false, &sealed, &trouble, &message);
  apart_shut();
  h5_watch(&failures);
  enum h5_sort sort = H5_OTHER;
  if (file >= 0 && (!find_sort(file, &sort) || failures > 0)) {
    trouble = H5_DAMAGED;
    message_set(&message, "%s: damaged: HDF5 cannot read some part of it", link->path);
  }
  apart_put_verdict(link, (int)trouble, &message);
  if (trouble == H5_FINE)
    apart_put(link, &sort, sizeof sort);
}

/* Frames of any file: opened, and read one by one. */
#include "files/frames.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "files/foreign.h"
#include "files/trajectory.h"
#include "wall/motion.h"

#define DAMAGED "damaged: HDF5 cannot read some part of it"

/* --- sorts of files ---------------------------------------------------------------------------------------------- */

static enum h5_trouble trouble_of(const struct far *far, const struct message *message)
{
  return far->lost.text[0]                ? (far->apart.died ? H5_DEADLY : H5_UNREADABLE)
         : message->kind != MESSAGE_WRONG ? H5_UNREADABLE
                                          : H5_DAMAGED;
}

static enum h5_sort sort_of(struct far *far)
{
  static const struct {
    const char *format;
    enum h5_sort sort;
  } known[] = {{CHECKPOINT_FORMAT, H5_CHECKPOINT}, {"uncross pack", H5_PACK}};
  char format[64] = "";
  far_get_text(far, "", "", "format", 0, format, sizeof format);
  for (size_t k = 0; k < sizeof known / sizeof *known; k++)
    if (strcmp(format, known[k].format) == 0)
      return known[k].sort;
  return far_has(far, "", "particles") ? H5_TRAJECTORY : H5_OTHER;
}

bool h5_find_sort(const char *path, enum h5_sort *sort, enum h5_trouble *trouble, struct message *message)
{
  struct far far;
  if (!far_open(&far, path, trouble, message))
    return false;
  const bool unread = far_look(&far, "", "particles").kind == FAR_BROKEN;
  *sort = sort_of(&far);
  const bool ok = far_whole(&far, unread ? UINT64_MAX : 0, DAMAGED, message);
  *trouble = ok ? H5_FINE : trouble_of(&far, message);
  far_close(&far);
  return ok;
}

/* --- opening ----------------------------------------------------------------------------------------------------- */

/* id: of the rows, NULL: none. */
static bool open_structure(struct frames *f, const char *particles, const char *connectivity, const int64_t *id,
                           uint32_t rows, struct message *message)
{
  struct message why = {.text = ""};
  if (far_look(&f->file, "", particles).kind == FAR_GROUP &&
      structure_read(&f->file, particles, connectivity, id, rows, &f->structure, &why))
    return true;
  if (!why.text[0])
    return far_fail(&f->file, message, "damaged, its species or bonds cannot be read");
  message_set(message, "%s: %s", f->path, why.text);
  message->kind = why.kind;
  return false;
}

/* what: it is damaged without its scene. */
static bool open_scene(struct frames *f, const char *in, bool needed, const char *what, struct message *message)
{
  if (!needed && far_look(&f->file, in, "scene").kind == FAR_NOTHING)
    return true;
  f->scene = far_text(&f->file, in, "scene");
  return f->scene || far_fail(&f->file, message, what);
}

static bool open_trajectory(struct frames *f, struct message *message)
{
  struct frames_about *about = &f->about;
  if (!h5md_find(f, message) || !foreign_is_one(f, message))
    return false;
  const enum far_kind bonds = (enum far_kind)far_look(&f->file, "", "connectivity").kind;
  if (bonds == FAR_BROKEN || (bonds == FAR_NOTHING && about->checked)) /* what we write has bonds, if only none */
    return far_fail(&f->file, message, "damaged, its bonds cannot be read");
  /* Without a frame only this dataset proves how many particles there are. */
  const struct far_thing species = far_look(&f->file, f->layout.group, "species");
  bool ok = true;
  if (about->frames > 0 || (far_is(&species, 1) && species.dims[0] == about->rows)) {
    int64_t *id = foreign_ids(f);
    ok = open_structure(f, f->layout.group, bonds > FAR_NOTHING ? "connectivity" : NULL, id, about->rows, message);
    free(id);
  }
  ok = ok && open_scene(f, "parameters/uncross", false, "damaged, its scene cannot be read", message);
  if (ok)
    h5md_tell(f);
  return ok;
}

static bool open_checkpoint(struct frames *f, struct message *message)
{
  struct frames_about *about = &f->about;
  struct checkpoint_summary *summary = &about->summary;
  if (!checkpoint_find(&f->file, summary, message) ||
      !open_structure(f, "structure", "structure", NULL, summary->vertices, message))
    return false;
  about->frames = 1;
  about->rows = summary->vertices + summary->particles;
  about->steps = about->velocities = true;
  about->checked = f->file.sealed;
  about->slide = summary->head.slide;
  return open_scene(f, "", true, "damaged checkpoint: its scene cannot be read", message);
}

static bool open_contents(struct frames *f, struct message *message)
{
  f->about.checkpoint = checkpoint_is(&f->file);
  return (f->about.checkpoint ? open_checkpoint : open_trajectory)(f, message) &&
         far_whole(&f->file, 0, DAMAGED, message);
}

struct frames *frames_open(const char *path, enum h5_trouble *trouble, struct message *message)
{
  struct frames *f = calloc(1, sizeof *f);
  *trouble = H5_UNREADABLE;
  if (f)
    f->path = strdup(path);
  if (!f || !f->path) {
    free(f);
    message_no_memory(message, "%s: out of memory", path);
    return NULL;
  }
  if (!far_open(&f->file, f->path, trouble, message)) {
    free(f->path);
    free(f);
    return NULL;
  }
  message->kind = MESSAGE_WRONG;
  if (open_contents(f, message))
    return f;
  far_whole(&f->file, f->file.failures, DAMAGED, message); /* that the reader is no more says most */
  *trouble = trouble_of(&f->file, message);
  frames_close(f);
  return NULL;
}

bool frames_scene(const struct frames *f, struct scene *scene)
{
  struct message ignored;
  errno = 0;
  if (!f->scene || !scene_read_text_numbers(f->path, f->scene, strlen(f->scene), scene, &ignored))
    return false;
  if (shear_finish(&scene->model)) {
    shear_begin(&scene->model, f->about.slide);
    return true;
  }
  scene_free(scene);
  return false;
}

void frames_close(struct frames *f)
{
  if (!f)
    return;
  far_close(&f->file);
  structure_free(&f->structure);
  free(f->picture.position);
  free(f->picture.velocity);
  free(f->scene);
  free(f->path);
  free(f);
}

/* --- frames ------------------------------------------------------------------------------------------------------ */

/* Only now, when there is a frame whose shape has been looked at. */
static bool make_room(struct frames *f, struct message *message)
{
  struct picture *p = &f->picture;
  struct message ignored;
  const size_t numbers = 3 * (size_t)f->about.rows;
  p->position = p->position ? p->position : far_room(&f->file, numbers, sizeof *p->position, &ignored);
  if (f->about.velocities && !p->velocity)
    p->velocity = far_room(&f->file, numbers, sizeof *p->velocity, &ignored);
  return (p->position && (p->velocity || !f->about.velocities)) ||
         message_no_memory(message, "%s: out of memory", f->path);
}

/* The model of the scene that a checkpoint holds: walls, shear and springs say where particles are between collisions.
 * False if it cannot be read, or is of other numbers. */
static bool read_model(const struct frames *f, struct scene *scene)
{
  const struct checkpoint_summary *summary = &f->about.summary;
  const struct model *m = &scene->model;
  if (!frames_scene(f, scene))
    return false;
  if (m->solvent.particles == summary->particles && m->vertices == summary->vertices &&
      m->dumbbells.pairs == summary->dumbbells && memcmp(m->box.cells, summary->cells, sizeof summary->cells) == 0)
    return true;
  scene_free(scene);
  return false;
}

static bool load_state(struct frames *f, const struct model *model, struct message *message)
{
  struct picture *p = &f->picture;
  struct state state;
  if (!far_affords(&f->file, state_bytes(model)) || !state_alloc(&state, model))
    return message_no_memory(message, "%s: out of memory", f->path);
  const bool ok = checkpoint_read_state(&f->file, &f->about.summary, &state, NULL, message);
  if (ok) { /* which has particles in the order of their ids */
    frame_positions(&state, model, state.solvent.id, p->position);
    frame_velocities(&state, model, state.solvent.id, p->velocity);
  }
  state_free(&state);
  return ok;
}

static bool load_checkpoint(struct frames *f, uint64_t frame, struct message *message)
{
  const struct checkpoint_summary *summary = &f->about.summary;
  struct picture *p = &f->picture;
  struct scene scene;
  (void)frame;
  const bool known = read_model(f, &scene);
  const struct model model = known ? scene.model : checkpoint_model(summary);
  const bool ok = load_state(f, &model, message);
  if (known)
    scene_free(&scene);
  p->step = summary->numbers.step;
  p->time = (double)p->step * summary->time_step;
  p->has_box = true;
  for (int k = 0; k < 3; k++)
    p->edge[k] = summary->cells[k];
  return ok;
}

/* The first number that is not finite; 3 rows if there is none. */
static size_t find_odd(const double *number, uint32_t rows)
{
  size_t k = 0;
  while (k < 3 * (size_t)rows && isfinite(number[k]))
    k++;
  return k;
}

static bool finite(const struct frames *f, uint64_t frame, const char *what, const double *number,
                   struct message *message)
{
  const size_t k = number ? find_odd(number, f->about.rows) : 3 * (size_t)f->about.rows;
  return k == 3 * (size_t)f->about.rows ||
         message_set(message, "%s: frame %" PRIu64 " (step %" PRIu64 "): the %s of particle %zu is not a finite number",
                     f->path, frame, f->picture.step, what, k / 3);
}

enum frame_verdict frames_check(struct frames *f, uint64_t frame, struct message *message)
{
  struct picture *p = &f->picture;
  message->kind = MESSAGE_WRONG;
  *p = (struct picture){.position = p->position, .velocity = p->velocity};
  if (frame >= f->about.frames) {
    message_set(message, "%s: frame %" PRIu64 " asked for; it has %" PRIu64, f->path, frame, f->about.frames);
    return FRAME_LOST;
  }
  if (!make_room(f, message))
    return FRAME_LOST;
  if ((f->about.checkpoint ? load_checkpoint : h5md_load)(f, frame, message))
    return FRAME_FINE;
  const bool lost = !far_whole(&f->file, f->file.failures, "", message);
  return lost || message->kind != MESSAGE_WRONG ? FRAME_LOST : FRAME_DAMAGED;
}

enum frame_verdict frames_read(struct frames *f, uint64_t frame, struct message *message)
{
  const enum frame_verdict verdict = frames_check(f, frame, message);
  return verdict != FRAME_FINE || (finite(f, frame, "position", f->picture.position, message) &&
                                   finite(f, frame, "velocity", f->picture.velocity, message))
             ? verdict
             : FRAME_DAMAGED;
}

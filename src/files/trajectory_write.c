/* Trajectories are made, and continued. */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files/frames.h"
#include "files/same_run.h"
#include "files/structure.h"
#include "files/trajectory.h"
#include "version.h"

#define PATH_SIZE 4096

/* --- creating ---------------------------------------------------------------------------------------------------- */

static bool write_h5md(hid_t file)
{
  const int32_t version[2] = {1, 1};
  hid_t root = h5_group(file, "h5md"), by = h5_group(root, "author"), creator = h5_group(root, "creator");
  bool ok = h5_put(root, "version", H5T_NATIVE_INT32, 2, version) && h5_put_text(by, "name", "uncross") &&
            h5_put_text(creator, "name", "uncross") && h5_put_text(creator, "version", UNCROSS_VERSION);
  h5_close(by);
  h5_close(creator);
  h5_close(root);
  return ok;
}

/* What H5MD leaves to each program: parameters/uncross. */
static bool write_parameters(struct trajectory *t, const struct model *model, const struct trajectory_options *options,
                             const char *scene_text)
{
  const hsize_t sums[2] = {0, FRAME_SUMS};
  const int32_t version = TRAJECTORY_VERSION;
  hid_t all = h5_group(t->file, "parameters"), own = h5_group(all, "uncross");
  bool ok = h5_put(own, "format_version", H5T_NATIVE_INT32, 0, &version) &&
            h5_put(own, "seed", H5T_NATIVE_UINT64, 0, &options->seed) &&
            h5_put(own, "stream", H5T_NATIVE_UINT64, 0, &options->stream) &&
            h5_put(own, "slide", H5T_NATIVE_UINT64, 0, &model->shear.slid) &&
            h5_put(own, "time_step", H5T_NATIVE_DOUBLE, 0, &model->time_step) &&
            h5_put(own, "vertices", H5T_NATIVE_UINT32, 0, &model->vertices) &&
            h5_text_write(own, "scene", scene_text ? scene_text : "");
  t->checksum = ok ? h5_dataset(own, "checksum", H5T_NATIVE_UINT64, 2, sums, true, 1024 / FRAME_SUMS) : -1;
  ok = t->checksum >= 0;
  h5_close(own);
  h5_close(all);
  return ok;
}

static bool write_connectivity(hid_t file, const struct model *model)
{
  hobj_ref_t particles;
  hid_t group = h5_group(file, "connectivity");
  bool ok =
      structure_write_bonds(group, model) && H5Rcreate(&particles, file, "/particles/trajectory", H5R_OBJECT, -1) >= 0;
  hid_t bonds = ok ? H5Dopen2(group, "bonds", H5P_DEFAULT) : -1;
  ok = ok && h5_put(bonds, "particles_group", H5T_STD_REF_OBJ, 0, &particles);
  h5_close(bonds);
  h5_close(group);
  return ok;
}

/* A time-dependent element: a group with `value`, and links to the one `step` and `time` of the whole file. */
static hid_t add_element(struct trajectory *t, hid_t parent, const char *name, int rank, const hsize_t *dims)
{
  hsize_t bytes = sizeof(double);
  for (int k = 1; k < rank; k++)
    bytes *= dims[k];
  hid_t element = h5_group(parent, name);
  hid_t value = h5_dataset(element, "value", H5T_NATIVE_DOUBLE, rank, dims, true,
                           bytes < TRAJECTORY_CHUNK ? TRAJECTORY_CHUNK / bytes : 1);
  if (t->step < 0) {
    const hsize_t none[1] = {0};
    t->step = h5_dataset(element, "step", H5T_NATIVE_INT64, 1, none, true, 1024);
    t->time = h5_dataset(element, "time", H5T_NATIVE_DOUBLE, 1, none, true, 1024);
  } else {
    H5Olink(t->step, element, "step", H5P_DEFAULT, H5P_DEFAULT);
    H5Olink(t->time, element, "time", H5P_DEFAULT, H5P_DEFAULT);
  }
  h5_close(element);
  if (t->step >= 0 && t->time >= 0)
    return value;
  h5_close(value); /* else a further element would make them anew */
  return -1;
}

static bool add_box(struct trajectory *t, const struct model *model)
{
  const int32_t dimension = 3;
  char boundary[3][9] = {"periodic", "periodic", "periodic"};
  const hsize_t dims[3] = {0, 3, 3};
  hid_t type = H5Tcopy(H5T_C_S1);
  for (int k = 0; k < 3; k++)
    if (model->box.boundary[k] != BOUNDARY_PERIODIC) /* H5MD has no word for images that slide */
      memcpy(boundary[k], "none\0\0\0\0", sizeof boundary[k]);
  H5Tset_size(type, sizeof boundary[0]);
  hid_t box = h5_group(t->group, "box");
  bool ok = h5_put(box, "dimension", H5T_NATIVE_INT32, 0, &dimension) && h5_put(box, "boundary", type, 3, boundary);
  t->edges = add_element(t, box, "edges", 3, dims);
  h5_close(type);
  h5_close(box);
  return ok && t->edges >= 0;
}

static bool make_room(struct trajectory *t, const struct model *model)
{
  t->row = malloc(((size_t)t->particles + 1) * 3 * sizeof *t->row);
  t->slot = t->solvent ? malloc(((size_t)model->solvent.particles + 1) * sizeof *t->slot) : NULL;
  return t->row && (t->slot || !t->solvent);
}

static bool create_contents(struct trajectory *t, const struct model *model, const struct trajectory_options *options,
                            const char *scene_text)
{
  const hsize_t dims[3] = {0, t->particles, 3};
  hid_t particles = h5_group(t->file, "particles");
  t->group = h5_group(particles, "trajectory");
  h5_close(particles);
  t->position = t->group < 0 ? -1 : add_element(t, t->group, "position", 3, dims);
  if (options->velocities && t->position >= 0)
    t->velocity = add_element(t, t->group, "velocity", 3, dims);
  return t->position >= 0 && (t->velocity >= 0 || !options->velocities) && add_box(t, model) &&
         structure_write_particles(t->group, model, t->solvent) && write_h5md(t->file) &&
         write_parameters(t, model, options, scene_text) && write_connectivity(t->file, model) &&
         H5Fflush(t->file, H5F_SCOPE_GLOBAL) >= 0;
}

static uint32_t rows_wanted(const struct model *model, const struct trajectory_options *options)
{
  return model->vertices + (options->solvent ? model->solvent.particles : 0);
}

/* The folder of a run's trajectory and its name there; else no folder, and the path. */
struct place {
  struct folder folder;
  const char *file;
};

static struct place place_of(const char *path, const struct trajectory_options *options)
{
  const char *slash = strrchr(path, '/');
  if (!options->folder)
    return (struct place){{"", FOLDER_BY_NAME}, path};
  return (struct place){*options->folder, slash ? slash + 1 : path};
}

/* HDF5 opens files by path. What it opened must be the file in the folder that is locked. */
static bool in_place(const struct trajectory *t, const struct trajectory_options *options, struct message *message)
{
  const struct place place = place_of(t->path, options);
  return !options->folder || folder_holds(&place.folder, place.file, h5_descriptor(t->file), message);
}

static struct trajectory *create(const char *path, const struct model *model, const struct trajectory_options *options,
                                 const char *scene_text, struct message *message)
{
  struct trajectory *t = trajectory_allocate(path);
  if (!t) {
    message_no_memory(message, "%s: out of memory", path);
    return NULL;
  }
  t->solvent = options->solvent && model_has_solvent(model);
  t->particles = rows_wanted(model, options);
  t->file = h5_create(path, message);
  if (t->file < 0)
    return trajectory_give_up(t);
  if (!in_place(t, options, message)) {
    remove(path); /* it was made just now, wherever it is */
    return trajectory_give_up(t);
  }
  size_t bytes = 32 * ((size_t)t->particles + model->bonds) + strlen(scene_text ? scene_text : "") + TRAJECTORY_SLACK;
  bool ok = trajectory_reserve(t, bytes, message);
  if (ok && !(make_room(t, model) && create_contents(t, model, options, scene_text)))
    ok = h5_fail(message, path, "trajectory cannot be created");
  h5_trim(t->file);
  trajectory_let_readers_in(t);
  if (ok)
    return t;
  const struct place place = place_of(path, options);
  folder_remove(&place.folder, place.file);
  return trajectory_give_up(t);
}

/* --- resuming ---------------------------------------------------------------------------------------------------- */

/* Frames that stay. */
struct kept {
  uint64_t frames, last_step;
  bool checked; /* against checksums */
};

static bool set_frames(struct trajectory *t, uint64_t frames)
{
  const hid_t datasets[] = {t->position, t->velocity, t->edges, t->time, t->checksum, t->step};
  bool ok = true;
  for (size_t k = 0; k < sizeof datasets / sizeof *datasets; k++) {
    hsize_t dims[3];
    if (datasets[k] < 0)
      continue;
    ok = ok && h5_shape(datasets[k], 3, dims) >= 1;
    dims[0] = frames;
    ok = ok && H5Dset_extent(datasets[k], dims) >= 0;
  }
  t->frames = frames;
  return ok;
}

/* How many frames are of steps up to this one, and the last step among them. Each of them is held against its
 * checksums. FRAME_DAMAGED, with a message, if one is damaged, or if steps do not increase; FRAME_LOST if that cannot
 * be found out. A frame that comes later may be damaged: it is not kept. */
static enum frame_verdict find_kept(struct frames *frames, uint64_t keep_to_step, uint64_t *keep, uint64_t *last_step,
                                    struct message *message)
{
  const struct frames_about *about = &frames->about;
  if (about->checkpoint || !about->steps) {
    message_set(message, "%s: not a trajectory of this program", frames->path);
    return FRAME_DAMAGED;
  }
  *last_step = 0;
  for (*keep = 0; *keep < about->frames; ++*keep) {
    const enum frame_verdict verdict = frames_check(frames, *keep, message);
    const uint64_t step = frames->picture.step;
    if (verdict != FRAME_LOST && step > keep_to_step)
      return FRAME_FINE;
    if (verdict != FRAME_FINE)
      return verdict;
    if (*keep > 0 && step <= *last_step) {
      message_set(message, "%s: frame %" PRIu64 " is of step %" PRIu64 ", the frame before it of step %" PRIu64,
                  frames->path, *keep, step, *last_step);
      return FRAME_DAMAGED;
    }
    *last_step = step;
  }
  return FRAME_FINE;
}

bool trajectory_find_end(const char *path, uint64_t keep_to_step, uint64_t *end)
{
  enum h5_trouble trouble;
  struct message ignored;
  uint64_t keep, last_step;
  struct frames *frames = frames_open(path, &trouble, &ignored);
  const bool ok = frames && find_kept(frames, keep_to_step, &keep, &last_step, &ignored) == FRAME_FINE;
  if (ok)
    *end = keep > 0 ? last_step + 1 : 0;
  frames_close(frames);
  return ok;
}

/* The file must be of the same run and the same particles, or the frames to come would not fit. */
static bool same_contents(const struct frames *frames, const struct model *model,
                          const struct trajectory_options *options, struct message *message)
{
  const struct frames_about *about = &frames->about;
  if (!same_run_frames(frames, model, options, message))
    return false;
  if (about->rows != rows_wanted(model, options) || about->velocities != options->velocities)
    message_set(message,
                "%s: its frames hold %u particles %s velocities, the scene asks for %u %s (trajectory.solvent, "
                "trajectory.velocities); move the file away, or resume with the interrupted run's settings",
                frames->path, about->rows, about->velocities ? "with" : "without", rows_wanted(model, options),
                options->velocities ? "with" : "without");
  return about->rows == rows_wanted(model, options) && about->velocities == options->velocities;
}

bool trajectory_fits(const char *path, const struct model *model, const struct trajectory_options *options,
                     struct message *message)
{
  enum h5_trouble trouble;
  struct message ignored;
  struct frames *frames = frames_open(path, &trouble, &ignored);
  const bool fits = !frames || same_contents(frames, model, options, message);
  frames_close(frames);
  return fits;
}

/* Renames a damaged file to the first free NAME.damaged.N.h5. */
static bool set_aside(const struct place *place, const char *path, const char *why, struct message *message)
{
  char aside[PATH_SIZE];
  size_t stem = strlen(place->file);
  if (stem > 3 && strcmp(place->file + stem - 3, ".h5") == 0)
    stem -= 3;
  for (int n = 1; n < 10000; n++) {
    if (snprintf(aside, sizeof aside, "%.*s.damaged.%d.h5", (int)stem, place->file, n) >= (int)sizeof aside)
      break;
    if (folder_has(&place->folder, aside))
      continue;
    if (!folder_rename(&place->folder, place->file, aside))
      break;
    message_set(message, "%s cannot be continued (%.300s); it was renamed to %.300s and a new trajectory begins here",
                path, why, aside);
    return true;
  }
  return message_set(message, "%s: damaged, and cannot be renamed: move it away", path);
}

/* The process that read the file died, or could not be asked. That may be for want of memory, too: so the file stays.
 */
static bool leave_alone(const char *path, struct message *message)
{
  return message_set(message, "%.600s; %s is left as it is (if `uncross verify` calls it damaged, move it away)",
                     message->text, path);
}

/* What is there, as a process of its own finds it: how many frames stay. Nothing is written before this. damaged: that
 * process says so. */
static bool look_at(const char *path, const struct model *model, const struct trajectory_options *options,
                    uint64_t keep_to_step, struct kept *kept, bool *damaged, struct message *message)
{
  enum h5_trouble trouble;
  struct frames *frames = frames_open(path, &trouble, message);
  *damaged = trouble == H5_DAMAGED;
  if (!frames)
    return trouble == H5_DEADLY ? leave_alone(path, message) : false;
  enum frame_verdict verdict = FRAME_FINE;
  const bool same = same_contents(frames, model, options, message);
  if (same)
    verdict = find_kept(frames, keep_to_step, &kept->frames, &kept->last_step, message);
  *damaged = verdict == FRAME_DAMAGED;
  kept->checked = frames->about.checked;
  frames_close(frames);
  if (verdict == FRAME_LOST)
    return leave_alone(path, message);
  return same && !*damaged;
}

/* What is removed has not been read before. */
static bool drop_after(struct trajectory *t, const struct kept *kept)
{
  t->last_step = kept->last_step;
  return t->edges >= 0 && t->time >= 0 && kept->frames <= t->frames && set_frames(t, kept->frames) &&
         H5Fflush(t->file, H5F_SCOPE_GLOBAL) >= 0;
}

static struct trajectory *resume_existing(const char *path, const struct model *model,
                                          const struct trajectory_options *options, uint64_t keep_to_step,
                                          bool *damaged, struct message *message)
{
  enum h5_trouble trouble;
  struct kept kept = {0};
  bool sealed;
  if (!look_at(path, model, options, keep_to_step, &kept, damaged, message))
    return NULL;
  struct trajectory *t = trajectory_allocate(path);
  if (!t) {
    message_no_memory(message, "%s: out of memory", path);
    return NULL;
  }
  t->file = h5_open(path, true, &sealed, &trouble, message);
  if (t->file < 0 || !in_place(t, options, message) || !trajectory_find(t, message))
    return trajectory_give_up(t);
  t->solvent = options->solvent && model_has_solvent(model);
  if (!make_room(t, model)) {
    message_no_memory(message, "%s: out of memory", path);
    return trajectory_give_up(t);
  }
  if (!drop_after(t, &kept)) {
    *damaged = true;
    h5_fail(message, path, "its later frames cannot be removed");
    return trajectory_give_up(t);
  }
  if (!kept.checked && kept.frames > 0)
    message_set(message, "%s: an earlier program wrote it without checksums; its frames are kept as they are", path);
  trajectory_let_readers_in(t);
  return t;
}

struct trajectory *trajectory_open(const char *path, const struct model *model,
                                   const struct trajectory_options *options, bool resume, uint64_t keep_to_step,
                                   const char *scene_text, struct message *message)
{
  const struct place place = place_of(path, options);
  message->text[0] = '\0';
  if (rows_wanted(model, options) == 0) {
    message_set(message, "%s: a trajectory of no particles: there are no fibers, and the solvent is not asked for",
                path);
    return NULL;
  }
  if (resume && folder_has(&place.folder, place.file)) {
    struct message why = {.text = ""};
    bool damaged;
    struct trajectory *t = resume_existing(path, model, options, keep_to_step, &damaged, &why);
    if (t || !damaged)
      *message = why;
    if (t)
      return t;
    if (!damaged || !set_aside(&place, path, why.text, message))
      return NULL;
  }
  return create(path, model, options, scene_text, message);
}

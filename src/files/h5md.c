/* What an H5MD file has, ours or another's: its datasets, its words, its frames. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "files/foreign.h"
#include "files/frames.h"
#include "files/trajectory.h"

#define MOST_EDGE 1e9 /* a0, of a box of any program */
#define OWN "parameters/uncross"

/* --- datasets ---------------------------------------------------------------------------------------------------- */

/* That it cannot be read must not look as if it were not there. */
static struct far_thing find(struct frames *f, const char *in, const char *name)
{
  const struct far_thing thing = far_look(&f->file, in, name);
  f->layout.unread |= thing.kind == FAR_BROKEN || (thing.kind == FAR_DATASET && thing.rank == -2);
  return thing;
}

/* particles/trajectory, or the first group of particles that another program wrote. */
static void find_particles(struct frames *f)
{
  char name[256] = "trajectory", first[256];
  if (find(f, "particles", name).kind <= FAR_NOTHING && far_link(&f->file, "particles", 0, first, sizeof first))
    memcpy(name, first, sizeof name);
  snprintf(f->layout.group, sizeof f->layout.group, "particles/%s", name);
}

/* Whether there is a dataset of this rank with one entry per frame. Fewer frames than so far known bound the number of
 * whole frames. */
static bool find_series(struct frames *f, const char *in, const char *name, int rank, struct far_thing *series)
{
  *series = find(f, in, name);
  const bool is = far_is(series, rank);
  if (is && series->dims[0] < f->about.frames)
    f->about.frames = series->dims[0];
  return is;
}

/* `name`: of shape [frames][particles][3]. */
static bool find_vectors(struct frames *f, const char *name)
{
  const uint64_t frames = f->about.frames;
  struct far_thing s;
  const bool is = find_series(f, f->layout.group, name, 3, &s) && s.dims[2] == 3 && s.dims[1] <= INT32_MAX &&
                  (f->about.rows == 0 || f->about.rows == s.dims[1]);
  if (is)
    f->about.rows = (uint32_t)s.dims[1];
  else
    f->about.frames = frames;
  return is;
}

/* What we wrote says so in parameters/uncross, with a version; version 2 has checksums. */
static void find_checksums(struct frames *f)
{
  struct frames_layout *layout = &f->layout;
  struct far_thing sums;
  const bool own = find(f, "", OWN).kind > FAR_NOTHING;
  const int told = own ? far_get(&f->file, "", OWN, "format_version", FAR_SHORT, 0, &layout->version) : 0;
  layout->ours = told != 0;
  layout->unread |= told < 0;
  f->about.checked =
      layout->ours && layout->version >= 2 && find_series(f, OWN, "checksum", 2, &sums) && sums.dims[1] == FRAME_SUMS;
}

static bool is_known(const struct frames_layout *layout)
{
  return !layout->ours || (layout->version >= 1 && layout->version <= TRAJECTORY_VERSION);
}

/* What a file of ours lacks though its version promises it, or NULL. */
static const char *what_is_missing(const struct frames *f)
{
  const struct {
    bool there;
    const char *text;
  } promised[] = {{f->about.steps, "its steps (position/step)"},
                  {f->layout.times, "its times (position/time)"},
                  {f->about.checked, "its checksums (" OWN "/checksum)"}};
  for (size_t k = 0; f->layout.version >= 2 && k < sizeof promised / sizeof *promised; k++)
    if (!promised[k].there)
      return promised[k].text;
  return NULL;
}

static void find_box(struct frames *f)
{
  struct frames_layout *layout = &f->layout;
  layout->edges = find(f, layout->group, "box/edges");
  layout->edges_change = layout->edges.kind == FAR_GROUP;
  if (layout->edges_change)
    find_series(f, layout->group, "box/edges/value", 3, &layout->edges);
}

bool h5md_find(struct frames *f, struct message *message)
{
  struct frames_layout *layout = &f->layout;
  struct far_thing series;
  f->about.frames = UINT64_MAX;
  find_particles(f);
  const bool there = find_vectors(f, "position/value");
  if (there) {
    f->about.velocities = find_vectors(f, "velocity/value");
    f->about.steps = find_series(f, layout->group, "position/step", 1, &series);
    layout->times = find_series(f, layout->group, "position/time", 1, &series);
    layout->images = far_has(&f->file, layout->group, "image");
    find_box(f);
    find_checksums(f);
  }
  if (layout->unread)
    return far_fail(&f->file, message, "damaged, or its contents cannot be used");
  if (!there)
    return message_set(message, "%s: an HDF5 file without an H5MD trajectory (particles/trajectory/position/value)",
                       f->path);
  if (!is_known(layout))
    return message_set(message, "%s: damaged, or of a later program: its version is %" PRId32 "; allowed: 1 to %d",
                       f->path, layout->version, TRAJECTORY_VERSION);
  const char *missing = what_is_missing(f);
  return !missing || message_set(message,
                                 "%s: damaged: %s are missing, or of another shape; no trajectory of version 2 is read "
                                 "without them",
                                 f->path, missing);
}

/* --- words ------------------------------------------------------------------------------------------------------- */

/* Earlier trajectories of ours hold the seed only, which was the stream; and no slide, which was 0. */
static void tell_stream(struct frames *f)
{
  struct frames_about *about = &f->about;
  about->has_stream = far_get(&f->file, "", OWN, "seed", FAR_COUNT, 0, &about->seed) > 0;
  if (!about->has_stream || far_get(&f->file, "", OWN, "stream", FAR_COUNT, 0, &about->stream) <= 0)
    about->stream = about->seed;
  if (far_get(&f->file, "", OWN, "slide", FAR_COUNT, 0, &about->slide) <= 0)
    about->slide = 0;
}

enum { WORD = 64, AXES = 3 };

static void tell_boundary(struct frames *f)
{
  static const char allowed[] = "periodic, none";
  struct frames_about *about = &f->about;
  char word[AXES][WORD] = {""};
  const int told = far_get_text(&f->file, f->layout.group, "box", "boundary", AXES, word[0], WORD);
  about->bounded = told > 0;
  if (told < 0 && !about->unfit[0])
    snprintf(about->unfit, sizeof about->unfit, "its box has a boundary that is not three words; allowed: %s", allowed);
  for (int k = 0; k < AXES && about->bounded; k++) {
    about->closed[k] = strcmp(word[k], "none") == 0;
    const bool known = about->closed[k] || strcmp(word[k], "periodic") == 0;
    char shown[4 * WORD];
    if (!known && !about->unfit[0])
      snprintf(about->unfit, sizeof about->unfit, "its box is '%s' along %c; allowed: %s",
               text_escape(word[k], shown, sizeof shown), "xyz"[k], allowed);
  }
}

void h5md_tell(struct frames *f)
{
  struct frames_about *about = &f->about;
  snprintf(about->creator, sizeof about->creator, "unknown");
  snprintf(about->author, sizeof about->author, "unknown");
  far_get_text(&f->file, "h5md", "creator", "name", 0, about->creator, sizeof about->creator);
  far_get_text(&f->file, "h5md", "creator", "version", 0, about->version, sizeof about->version);
  far_get_text(&f->file, "h5md", "author", "name", 0, about->author, sizeof about->author);
  tell_stream(f);
  foreign_look(f);
  tell_boundary(f);
}

/* --- frames ------------------------------------------------------------------------------------------------------ */

/* H5MD allows edges as a vector or as a matrix, and for each frame or once. False if there are none, or the box is not
 * rectangular. */
static bool read_box(struct frames *f, uint64_t frame, double edge[3])
{
  const struct far_thing *e = &f->layout.edges;
  const bool change = f->layout.edges_change;
  const int64_t rank = e->rank - change; /* of one frame's */
  double values[9];
  if (e->kind != FAR_DATASET || rank < 1 || rank > 2 || e->dims[e->rank - 1] != 3 ||
      (rank == 2 && e->dims[e->rank - 2] != 3) ||
      !far_read(&f->file, f->layout.group, change ? "box/edges/value" : "box/edges", change ? frame : FAR_PLAIN,
                FAR_REAL, (int)e->rank, e->dims, values))
    return false;
  bool rectangular = true;
  for (int k = 0; k < 3; k++) {
    edge[k] = rank == 2 ? values[4 * k] : values[k];
    rectangular &= edge[k] > 0.0 && edge[k] <= MOST_EDGE;
  }
  for (int k = 0; rank == 2 && k < 9; k++)
    rectangular &= k % 4 == 0 || values[k] == 0.0;
  return rectangular;
}

static bool read_moment(struct frames *f, uint64_t frame, int64_t *step, double *time)
{
  const uint64_t dims[1] = {0};
  const char *group = f->layout.group;
  *step = 0;
  *time = 0.0;
  return (!f->about.steps || far_read(&f->file, group, "position/step", frame, FAR_INTEGER, 1, dims, step)) &&
         (!f->layout.times || far_read(&f->file, group, "position/time", frame, FAR_REAL, 1, dims, time));
}

static bool odd_frame(const struct frames *f, uint64_t frame, int64_t step, const char *what, struct message *message)
{
  return message_set(message, "%s: frame %" PRIu64 " (step %" PRId64 ") is damaged: %s", f->path, frame, step, what);
}

/* Names the first table that is not what was written. */
static bool fits_sums(struct frames *f, uint64_t frame, int64_t step, struct message *message)
{
  static const char *const wrong[FRAME_SUMS] = {
      [SUM_MOMENT] = "its step or time does not fit its checksum",
      [SUM_EDGES] = "its box (box/edges) does not fit its checksum",
      [SUM_POSITION] = "its positions (position/value) do not fit their checksum",
      [SUM_VELOCITY] = "its velocities (velocity/value) do not fit their checksum"};
  const struct picture *p = &f->picture;
  const size_t numbers = 3 * (size_t)f->about.rows;
  const uint64_t dims[2] = {0, FRAME_SUMS};
  const uint64_t found[FRAME_SUMS] = {frame_sum_moment(frame, step, p->time), frame_sum_numbers(frame, p->edge, 3),
                                      frame_sum_numbers(frame, p->position, numbers),
                                      f->about.velocities ? frame_sum_numbers(frame, p->velocity, numbers) : 0};
  uint64_t stored[FRAME_SUMS];
  if (!far_read(&f->file, OWN, "checksum", frame, FAR_COUNT, 2, dims, stored))
    return odd_frame(f, frame, step, "its checksums cannot be read", message);
  for (int k = 0; k < FRAME_SUMS; k++)
    if (stored[k] != found[k])
      return odd_frame(f, frame, step, wrong[k], message);
  return true;
}

/* Positions and velocities, from the file or unfolded; false, with a message. */
static bool load_rows(struct frames *f, uint64_t frame, int64_t step, struct message *message)
{
  struct picture *p = &f->picture;
  const uint64_t dims[3] = {0, f->about.rows, 3};
  if (!far_read(&f->file, f->layout.group, "position/value", frame, FAR_REAL, 3, dims, p->position))
    return odd_frame(f, frame, step, "its positions (position/value) cannot be read", message);
  if (f->about.velocities &&
      !far_read(&f->file, f->layout.group, "velocity/value", frame, FAR_REAL, 3, dims, p->velocity))
    return odd_frame(f, frame, step, "its velocities (velocity/value) cannot be read", message);
  if (f->about.checked && !fits_sums(f, frame, step, message))
    return false;
  return foreign_unfold(f, frame) ||
         odd_frame(f, frame, step, "its images (image/value) cannot be read, or have no rectangular box", message);
}

bool h5md_load(struct frames *f, uint64_t frame, struct message *message)
{
  struct picture *p = &f->picture;
  const uint64_t failures = f->file.failures;
  int64_t step = 0;
  if (!read_moment(f, frame, &step, &p->time))
    return odd_frame(f, frame, 0, "its step or time cannot be read", message);
  p->step = (uint64_t)step;
  p->has_box = read_box(f, frame, p->edge);
  if (!load_rows(f, frame, step, message))
    return false;
  if (step < 0 || !isfinite(p->time))
    return odd_frame(f, frame, step, "its step or time is no number that a step or time can be", message);
  return f->file.failures == failures || odd_frame(f, frame, step, "HDF5 cannot read some part of it", message);
}

/* Frames of a trajectory or checkpoint as text, from what the file says about itself; its scene, where it holds one,
 * tells which kinds bend. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "files/export_format.h"
#include "files/snapshot.h"
#include "scene/scene.h"
#include "wall/motion.h"

static const struct export_format *const export_formats[] = {&export_xyz, &export_lammps, &export_lammps_dump,
                                                             &export_vtf};
enum { FORMATS = sizeof export_formats / sizeof export_formats[0] };

static const struct export_format *find_format(const char *name, struct message *message)
{
  char allowed[128] = "";
  for (size_t k = 0, used = 0; k < FORMATS; k++) {
    if (!name || strcmp(name, export_formats[k]->name) == 0)
      return export_formats[k];
    used += (size_t)snprintf(allowed + used, sizeof allowed - used, "%s%s", k > 0 ? ", " : "", export_formats[k]->name);
  }
  message_set(message, "--format %s: no such format; there are %s", name, allowed);
  return NULL;
}

/* --- fibers ------------------------------------------------------------------------------------------------------ */

/* All rows that bonds lead to from this one get their places, in the fiber of this number. In a file of another program
 * bonds may lead anywhere: a row keeps the first place that it gets. */
static void follow_fiber(const struct structure *s, int32_t first, struct place *place)
{
  int32_t along = 0;
  for (int32_t row = first; row >= 0 && place[row].fiber < 0; row = s->next[row])
    place[row] = (struct place){first, along++};
}

/* [particles] into `place`; number: scratch, [particles]. At first a fiber has the number of its first row. Open fibers
 * begin where no bond leads to; what is left then are rings. */
static void find_places(const struct structure *s, struct place *place, int32_t *number)
{
  const int32_t rows = (int32_t)s->particles;
  int32_t fibers = 0;
  for (int32_t row = 0; row < rows; row++)
    place[row] = (struct place){-1, -1}, number[row] = 0;
  for (int32_t row = 0; row < rows; row++)
    if (s->next[row] >= 0)
      number[s->next[row]] = 1; /* a bond leads here */
  for (int rings = 0; rings < 2; rings++)
    for (int32_t row = 0; row < rows; row++)
      if (!structure_is_solvent(s, s->species[row]) && (rings || !number[row]))
        follow_fiber(s, row, place);
  for (int32_t row = 0; row < rows; row++)
    if (place[row].along == 0)
      number[row] = fibers++;
  for (int32_t row = 0; row < rows; row++)
    if (place[row].fiber >= 0)
      place[row].fiber = number[place[row].fiber];
}

/* To be freed; NULL if memory is short. */
static struct place *places_of(const struct structure *s)
{
  struct place *place = calloc(s->particles + (size_t)1, sizeof *place);
  int32_t *number = malloc((s->particles + (size_t)1) * sizeof *number);
  if (place && number)
    find_places(s, place, number);
  free(number);
  if (!number) {
    free(place);
    return NULL;
  }
  return place;
}

/* --- what formats share ------------------------------------------------------------------------------------------- */

bool export_is_solvent(const struct export_view *v, uint32_t row)
{
  const struct structure *is = &v->frames->structure;
  return row >= is->particles || structure_is_solvent(is, is->species[row]);
}

/* x folded into [0, edge). */
static double fold(double x, double edge)
{
  double r = x - edge * floor(x / edge);
  return r < edge ? r : 0.0;
}

/* A frame stands at a whole step: two half steps each. */
static struct export_cell cell_of(const struct export_view *v)
{
  const struct picture *p = &v->frames->picture;
  const struct model *m = v->model;
  struct export_cell c = {.edge = {p->edge[0], p->edge[1], p->edge[2]}};
  for (int k = 0; k < 3; k++)
    c.periodic[k] = m ? m->box.boundary[k] != BOUNDARY_WALL : !v->frames->about.closed[k];
  c.leans = m && model_is_sheared(m);
  if (!c.leans)
    return c;
  const double slid = (double)shear_offset(m, 2 * p->step) * LATTICE_UNIT;
  c.tilt = slid > 0.5 * c.edge[0] ? slid - c.edge[0] : slid;
  c.speed = shear_rate(m, shear_interval(m, 2 * p->step)) * c.edge[1];
  return c;
}

void export_place(const struct export_view *v, uint32_t row, double x[3], double image[3])
{
  const struct export_cell *c = &v->cell;
  for (int k = 0; k < 3; k++)
    x[k] = v->frames->picture.position[3 * (size_t)row + (size_t)k], image[k] = 0.0;
  for (int k = 2; k >= 0 && v->wrapped; k--) { /* x is last: it slides when y is folded */
    const double begin = k == 0 ? c->tilt * (x[1] / c->edge[1]) : 0.0, folded = fold(x[k] - begin, c->edge[k]) + begin;
    image[k] = c->periodic[k] ? round((x[k] - folded) / c->edge[k]) : 0.0;
    x[k] = c->periodic[k] ? folded : x[k];
    x[0] -= k == 1 ? image[1] * c->tilt : 0.0;
  }
}

bool export_velocity(const struct export_view *v, uint32_t row, double u[3])
{
  const double *velocity = v->frames->picture.velocity;
  double x[3], image[3];
  export_place(v, row, x, image);
  for (int k = 0; velocity && k < 3; k++)
    u[k] = velocity[3 * (size_t)row + (size_t)k] - (k == 0 ? image[1] * v->cell.speed : 0.0);
  return velocity != NULL;
}

void export_name(FILE *out, const char *name)
{
  for (name = text_shown(name); *name; name++)
    fputc(strchr("\" \t\r\n=\\:", *name) ? '_' : *name, out);
}

/* --- frames ------------------------------------------------------------------------------------------------------- */

/* True if it can go on: the frame is in frames->picture, or it may be left out. */
static bool fetch(struct frames *s, uint64_t frame, const struct export_options *options, bool *fine,
                  struct message *message)
{
  enum frame_verdict verdict = frames_read(s, frame, message);
  if (verdict == FRAME_FINE && !s->picture.has_box) {
    message_set(message, "%s: frame %" PRIu64 ": its box (box/edges) cannot be read or is not rectangular", s->path,
                frame);
    verdict = FRAME_DAMAGED;
  }
  *fine = verdict == FRAME_FINE;
  if (verdict == FRAME_DAMAGED && options->notes)
    fprintf(options->notes, "uncross: left out: %s\n", message->text);
  return *fine || (verdict == FRAME_DAMAGED && options->notes);
}

static bool choose(const struct frames *s, const struct export_options *options, uint64_t *last,
                   struct message *message)
{
  if (options->first > options->last)
    return message_set(message, "%s: no frames: the first asked for is %" PRIu64 ", the last %" PRIu64, s->path,
                       options->first, options->last);
  if (options->first >= s->about.frames)
    return message_set(message,
                       "%s: first frame %" PRIu64 " asked for; it has frames 0 to %" PRIu64 " (%" PRIu64 " in all)",
                       s->path, options->first, s->about.frames ? s->about.frames - 1 : 0, s->about.frames);
  *last = options->last < s->about.frames ? options->last : s->about.frames - 1;
  return true;
}

static bool print_frames(struct frames *s, const struct export_format *format, struct export_view *v, FILE *out,
                         struct message *message)
{
  const struct export_options *options = v->options;
  const uint64_t stride = options->stride ? options->stride : 1;
  uint64_t last = 0, printed = 0;
  bool fine;
  if (!choose(s, options, &last, message) || (format->allows && !format->allows(v, message)))
    return false;
  uint64_t frame = format->one_frame ? last - (last - options->first) % stride : options->first;
  for (;; frame += stride) {
    if (!fetch(s, frame, options, &fine, message))
      return false;
    v->cell = cell_of(v);
    if (fine && printed++ == 0 && format->begin)
      format->begin(out, v);
    if (fine)
      format->frame(out, v);
    if (ferror(out) || last - frame < stride)
      break;
  }
  if (format->one_frame && printed == 0)
    return message_set(message, "%s: frame %" PRIu64 " is damaged, and %s hold one frame; choose another with --last",
                       s->path, frame, format->title);
  if (fflush(out) != 0 || ferror(out))
    return message_set(message, "%s: %s could not be written: %s", s->path, format->title, strerror(errno));
  return true;
}

/* --- view --------------------------------------------------------------------------------------------------------- */

/* The scene that the file holds, without a message if it cannot be read. */
static bool read_model(const struct frames *s, struct scene *scene)
{
  struct message ignored;
  return s->scene && scene_read_text(s->path, s->scene, strlen(s->scene), scene, &ignored);
}

/* Numbers of the rows that are printed, to be freed; NULL if memory is short. */
static int32_t *number_rows(struct export_view *v)
{
  const uint32_t rows = v->frames->about.rows;
  int32_t *number = malloc((rows + (size_t)1) * sizeof *number);
  v->solvent = true;
  for (uint32_t row = 0; row < rows && !v->options->solvent; row++)
    v->solvent = v->solvent && export_is_solvent(v, row);
  for (uint32_t row = 0; number && row < rows; row++)
    number[row] = v->solvent || !export_is_solvent(v, row) ? (int32_t)v->shown++ : -1;
  return number;
}

static int32_t *bonds_back(const struct structure *s)
{
  int32_t *prev = malloc((s->particles + (size_t)1) * sizeof *prev);
  for (uint32_t row = 0; prev && row < s->particles; row++)
    prev[row] = -1;
  for (uint32_t row = 0; prev && row < s->particles; row++)
    if (s->next[row] >= 0)
      prev[s->next[row]] = (int32_t)row;
  return prev;
}

bool trajectory_export(const char *path, const struct export_options *options, FILE *out, struct message *message)
{
  enum h5_trouble trouble;
  const struct export_format *format = find_format(options->format, message);
  struct frames *frames = format ? frames_open(path, &trouble, message) : NULL;
  if (!frames)
    return false;
  struct scene scene;
  const bool has_scene = read_model(frames, &scene);
  if (has_scene)
    shear_begin(&scene.model, frames->about.slide);
  struct place *place = places_of(&frames->structure);
  int32_t *prev = bonds_back(&frames->structure);
  struct export_view v = {.frames = frames, .options = options, .place = place, .prev = prev};
  int32_t *number = number_rows(&v);
  v.number = number;
  v.model = has_scene ? &scene.model : NULL;
  v.wrapped = options->wrapped || format->folds;
  const bool ok = place && prev && number
                      ? print_frames(frames, format, &v, out, message)
                      : message_no_memory(message, "%s: no memory for the places of its particles", path);
  free(number);
  free(prev);
  free(place);
  if (has_scene)
    scene_free(&scene);
  frames_close(frames);
  return ok;
}

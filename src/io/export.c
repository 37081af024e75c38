/* Extended XYZ of a trajectory or checkpoint, from what the file says about itself: no scene is read. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/checkpoint.h"
#include "io/structure.h"
#include "io/trajectory.h"

/* Programs that read XYZ want chemical symbols; these stand for the kinds of fiber, one after the other. */
static const char *const symbols[] = {"C", "N", "O", "F", "P", "S", "B", "Si", "Cl", "Se"};
#define SOLVENT_SYMBOL "H"

/* One frame, ready to be printed. */
struct picture {
  uint32_t rows;
  double *position, *velocity; /* [3 rows]; velocity is NULL if not stored */
  double edge[3];
  uint64_t step;
  double time;
};

/* Where frames come from: either of the two files. */
struct source {
  const char *path;
  struct trajectory *trajectory; /* NULL: a checkpoint */
  hid_t file;
  struct checkpoint_summary summary;
  struct structure structure;
  uint64_t frames;
  struct picture picture;
};

static const char *symbol_of(int32_t species)
{
  size_t n = sizeof symbols / sizeof *symbols;
  return symbols[(size_t)(species < 0 ? 0 : species) % n];
}

/* --- sources ----------------------------------------------------------------------------------------------------- */

static bool open_structure(struct source *s, hid_t particles, hid_t connectivity, uint32_t rows,
                           struct message *message)
{
  bool ok = particles >= 0 && structure_read(particles, connectivity, rows, &s->structure);
  return ok || message_set(message, "%s: its species or bonds cannot be read", s->path);
}

static bool open_trajectory(struct source *s, struct message *message)
{
  s->trajectory = trajectory_open_read(s->path, message);
  if (!s->trajectory)
    return false;
  struct trajectory *t = s->trajectory;
  int found = h5_look(t->file, "connectivity");
  hid_t connectivity = found > 0 ? H5Oopen(t->file, "connectivity", H5P_DEFAULT) : -1;
  bool ok = found == 0 || connectivity >= 0 || h5_fail(message, s->path, "its bonds cannot be read");
  ok = ok && open_structure(s, t->group, connectivity, t->particles, message);
  h5_close(connectivity);
  s->frames = trajectory_frames(t);
  s->picture.rows = t->particles;
  return ok;
}

static bool open_checkpoint(struct source *s, struct message *message)
{
  s->file = checkpoint_open(s->path, &s->summary, message);
  if (s->file < 0)
    return false;
  hid_t group = h5_open_group(s->file, "structure");
  bool ok = open_structure(s, group, group, s->summary.vertices, message);
  h5_close(group);
  s->frames = 1;
  s->picture.rows = s->summary.vertices + s->summary.particles;
  return ok;
}

static bool make_room(struct source *s, struct message *message)
{
  struct picture *p = &s->picture;
  bool velocity = !s->trajectory || trajectory_has_velocities(s->trajectory);
  p->position = malloc(((size_t)p->rows + 1) * 3 * sizeof *p->position);
  p->velocity = velocity ? malloc(((size_t)p->rows + 1) * 3 * sizeof *p->velocity) : NULL;
  return (p->position && (p->velocity || !velocity)) || message_set(message, "%s: out of memory", s->path);
}

static bool source_open(struct source *s, const char *path, struct message *message)
{
  enum h5_trouble trouble;
  *s = (struct source){.path = path, .file = -1};
  hid_t file = h5_open(path, false, &trouble, message);
  if (file < 0)
    return false;
  bool checkpoint = checkpoint_is(file);
  h5_close(file);
  return (checkpoint ? open_checkpoint : open_trajectory)(s, message) && make_room(s, message);
}

static void source_close(struct source *s)
{
  struct message ignored;
  trajectory_close(s->trajectory, &ignored);
  h5_close(s->file);
  structure_free(&s->structure);
  free(s->picture.position);
  free(s->picture.velocity);
}

static bool load_checkpoint(struct source *s, struct message *message)
{
  const struct checkpoint_summary *summary = &s->summary;
  const int *cells = summary->cells;
  struct model model = {.box = box_of_cells(cells[0], cells[1], cells[2]), .time_step = summary->time_step};
  struct state state;
  model.solvent.particles = summary->particles;
  model.solvent.acceleration = summary->acceleration;
  model.vertices = summary->vertices;
  if (!state_alloc(&state, &model))
    return message_set(message, "%s: out of memory", s->path);
  bool ok = checkpoint_read_state(s->file, s->path, summary, &state, message);
  if (ok) { /* which has particles in the order of their ids */
    frame_positions(&state, &model, state.solvent.id, s->picture.position);
    frame_velocities(&state, &model, state.solvent.id, s->picture.velocity);
  }
  state_free(&state);
  for (int k = 0; k < 3; k++)
    s->picture.edge[k] = cells[k];
  s->picture.step = summary->step;
  s->picture.time = (double)summary->step * summary->time_step;
  return ok;
}

static bool load(struct source *s, uint64_t frame, struct message *message)
{
  struct picture *p = &s->picture;
  struct trajectory *t = s->trajectory;
  if (!t)
    return load_checkpoint(s, message);
  if (!trajectory_edges(t, frame, p->edge))
    return message_set(message, "%s: its box (box/edges) cannot be read or is not rectangular", s->path);
  bool ok = trajectory_moment(t, frame, &p->step, &p->time) && trajectory_rows(t, t->position, frame, p->position) &&
            (!p->velocity || trajectory_rows(t, t->velocity, frame, p->velocity));
  return ok || h5_fail(message, s->path, "a frame cannot be read");
}

/* --- printing ---------------------------------------------------------------------------------------------------- */

static bool row_is_solvent(const struct source *s, uint32_t row)
{
  const struct structure *is = &s->structure;
  return row >= is->particles || structure_is_solvent(is, is->species[row]);
}

/* Names between quotes in the comment line. */
static void print_name(FILE *out, const char *name)
{
  for (; *name; name++)
    fputc(strchr("\" \t\r\n=\\:", *name) ? '_' : *name, out);
}

static void print_comment(FILE *out, const struct source *s, bool solvent)
{
  const struct picture *p = &s->picture;
  const char *between = "";
  fprintf(out, "Lattice=\"%.17g 0 0 0 %.17g 0 0 0 %.17g\" Properties=species:S:1:pos:R:3%s:id:I:1:next:I:1", p->edge[0],
          p->edge[1], p->edge[2], p->velocity ? ":velo:R:3" : "");
  fprintf(out, " pbc=\"T T T\" Step=%" PRIu64 " Time=%.17g kinds=\"", p->step, p->time);
  for (int k = 0; k < s->structure.kinds; k++) {
    bool is_solvent = structure_is_solvent(&s->structure, k);
    if (is_solvent && !solvent)
      continue;
    fprintf(out, "%s%s:", between, is_solvent ? SOLVENT_SYMBOL : symbol_of(k));
    print_name(out, s->structure.name[k]);
    between = " ";
  }
  fputs("\"\n", out);
}

/* x folded into [0, edge). */
static double fold(double x, double edge)
{
  double r = x - edge * floor(x / edge);
  return r < edge ? r : 0.0;
}

static void print_row(FILE *out, const struct source *s, uint32_t row, bool wrapped)
{
  const struct structure *is = &s->structure;
  const double *x = &s->picture.position[3 * (size_t)row], *edge = s->picture.edge;
  fputs(row_is_solvent(s, row) ? SOLVENT_SYMBOL : symbol_of(is->species[row]), out);
  for (int k = 0; k < 3; k++)
    fprintf(out, " %.17g", wrapped ? fold(x[k], edge[k]) : x[k]);
  for (int k = 0; s->picture.velocity && k < 3; k++)
    fprintf(out, " %.17g", s->picture.velocity[3 * (size_t)row + (size_t)k]);
  fprintf(out, " %" PRIu32 " %" PRId32 "\n", row, row < is->particles ? is->next[row] : -1);
}

static void print_frame(FILE *out, const struct source *s, const struct export_options *options)
{
  uint32_t shown = 0;
  for (uint32_t row = 0; row < s->picture.rows; row++)
    shown += options->solvent || !row_is_solvent(s, row);
  fprintf(out, "%" PRIu32 "\n", shown);
  print_comment(out, s, options->solvent);
  for (uint32_t row = 0; row < s->picture.rows; row++)
    if (options->solvent || !row_is_solvent(s, row))
      print_row(out, s, row, options->wrapped);
}

static bool print_frames(struct source *s, const struct export_options *options, FILE *out, struct message *message)
{
  const uint64_t stride = options->stride ? options->stride : 1;
  if (options->first > options->last)
    return message_set(message, "%s: no frames: the first asked for is %" PRIu64 ", the last %" PRIu64, s->path,
                       options->first, options->last);
  if (options->first >= s->frames)
    return message_set(message,
                       "%s: first frame %" PRIu64 " asked for; it has frames 0 to %" PRIu64 " (%" PRIu64 " in all)",
                       s->path, options->first, s->frames ? s->frames - 1 : 0, s->frames);
  uint64_t last = options->last < s->frames ? options->last : s->frames - 1;
  for (uint64_t frame = options->first; frame <= last; frame += stride) {
    if (!load(s, frame, message))
      return false;
    print_frame(out, s, options);
    if (ferror(out) || last - frame < stride)
      break;
  }
  if (fflush(out) != 0 || ferror(out))
    return message_set(message, "%s: extended XYZ could not be written: %s", s->path, strerror(errno));
  return true;
}

bool trajectory_export(const char *path, const struct export_options *options, FILE *out, struct message *message)
{
  struct source source;
  bool ok = source_open(&source, path, message) && print_frames(&source, options, out, message);
  source_close(&source);
  return ok;
}

/* Extended XYZ of a trajectory or checkpoint, from what the file says about itself: no scene is read. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "files/frames.h"
#include "files/snapshot.h"

/* Programs that read XYZ want chemical symbols; these stand for the kinds of fiber, one after the other. */
static const char *const symbols[] = {"C", "N", "O", "F", "P", "S", "B", "Si", "Cl", "Se"};
#define SOLVENT_SYMBOL "H"

static const char *symbol_of(int32_t species)
{
  size_t n = sizeof symbols / sizeof *symbols;
  return symbols[(size_t)(species < 0 ? 0 : species) % n];
}

/* --- fibers ------------------------------------------------------------------------------------------------------ */

/* Where a row stands: in which fiber, counted from 0 in the order of their first vertices, and at which place along
 * it; both -1 for solvent. */
struct place {
  int32_t fiber, along;
};

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

/* --- printing ---------------------------------------------------------------------------------------------------- */

static bool row_is_solvent(const struct frames *s, uint32_t row)
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

static void print_comment(FILE *out, const struct frames *s, bool solvent)
{
  const struct picture *p = &s->picture;
  const char *between = "";
  fprintf(
      out,
      "Lattice=\"%.17g 0 0 0 %.17g 0 0 0 %.17g\" Properties=species:S:1:pos:R:3%s:id:I:1:next:I:1:fiber:I:1:place:I:1",
      p->edge[0], p->edge[1], p->edge[2], p->velocity ? ":velo:R:3" : "");
  fprintf(out, " pbc=\"T T T\" Step=%" PRIu64 " Time=%.17g kinds=\"", p->step, text_real(p->time));
  for (int k = 0; k < s->structure.kinds; k++) {
    bool is_solvent = structure_is_solvent(&s->structure, k);
    if (is_solvent && !solvent)
      continue;
    fprintf(out, "%s%s:", between, is_solvent ? SOLVENT_SYMBOL : symbol_of(k));
    print_name(out, text_shown(s->structure.name[k]));
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

static void print_row(FILE *out, const struct frames *s, const struct place *place, uint32_t row, bool wrapped)
{
  const struct structure *is = &s->structure;
  const double *x = &s->picture.position[3 * (size_t)row], *edge = s->picture.edge;
  fputs(row_is_solvent(s, row) ? SOLVENT_SYMBOL : symbol_of(is->species[row]), out);
  for (int k = 0; k < 3; k++)
    fprintf(out, " %.17g", text_real(wrapped ? fold(x[k], edge[k]) : x[k]));
  for (int k = 0; s->picture.velocity && k < 3; k++)
    fprintf(out, " %.17g", text_real(s->picture.velocity[3 * (size_t)row + (size_t)k]));
  const struct place none = {-1, -1}, at = row < is->particles ? place[row] : none;
  fprintf(out, " %" PRIu32 " %" PRId32 " %" PRId32 " %" PRId32 "\n", row, row < is->particles ? is->next[row] : -1,
          at.fiber, at.along);
}

static void print_frame(FILE *out, const struct frames *s, const struct place *place,
                        const struct export_options *options)
{
  uint32_t shown = 0;
  for (uint32_t row = 0; row < s->about.rows; row++)
    shown += options->solvent || !row_is_solvent(s, row);
  fprintf(out, "%" PRIu32 "\n", shown);
  print_comment(out, s, options->solvent);
  for (uint32_t row = 0; row < s->about.rows; row++)
    if (options->solvent || !row_is_solvent(s, row))
      print_row(out, s, place, row, options->wrapped);
}

/* True if it can go on: the frame is printed, or it may be left out. */
static bool show_frame(struct frames *s, const struct place *place, uint64_t frame,
                       const struct export_options *options, FILE *out, struct message *message)
{
  enum frame_verdict verdict = frames_read(s, frame, message);
  if (verdict == FRAME_FINE && !s->picture.has_box) {
    message_set(message, "%s: frame %" PRIu64 ": its box (box/edges) cannot be read or is not rectangular", s->path,
                frame);
    verdict = FRAME_DAMAGED;
  }
  if (verdict == FRAME_FINE)
    print_frame(out, s, place, options);
  else if (verdict == FRAME_DAMAGED && options->notes)
    fprintf(options->notes, "uncross: left out: %s\n", message->text);
  return verdict == FRAME_FINE || (verdict == FRAME_DAMAGED && options->notes);
}

static bool print_frames(struct frames *s, const struct place *place, const struct export_options *options, FILE *out,
                         struct message *message)
{
  const uint64_t stride = options->stride ? options->stride : 1;
  if (options->first > options->last)
    return message_set(message, "%s: no frames: the first asked for is %" PRIu64 ", the last %" PRIu64, s->path,
                       options->first, options->last);
  if (options->first >= s->about.frames)
    return message_set(message,
                       "%s: first frame %" PRIu64 " asked for; it has frames 0 to %" PRIu64 " (%" PRIu64 " in all)",
                       s->path, options->first, s->about.frames ? s->about.frames - 1 : 0, s->about.frames);
  uint64_t last = options->last < s->about.frames ? options->last : s->about.frames - 1;
  for (uint64_t frame = options->first; frame <= last; frame += stride) {
    if (!show_frame(s, place, frame, options, out, message))
      return false;
    if (ferror(out) || last - frame < stride)
      break;
  }
  if (fflush(out) != 0 || ferror(out))
    return message_set(message, "%s: extended XYZ could not be written: %s", s->path, strerror(errno));
  return true;
}

bool trajectory_export(const char *path, const struct export_options *options, FILE *out, struct message *message)
{
  enum h5_trouble trouble;
  struct frames *frames = frames_open(path, &trouble, message);
  if (!frames)
    return false;
  struct place *place = places_of(&frames->structure);
  const bool ok = place ? print_frames(frames, place, options, out, message)
                        : message_set(message, "%s: no memory for the places of its particles", path);
  free(place);
  frames_close(frames);
  return ok;
}

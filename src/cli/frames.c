/* `uncross frames`: the frames of a trajectory or checkpoint as plain numbers, for programs that leave HDF5 to this
 * one. docs/files.md describes the form. */
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "cli/command.h"
#include "files/frames.h"
#include "scene/scene.h"
#include "wall/motion.h"

/* Model: of the file's scene; NULL: it holds none that can be read. */
static void print_head(const struct frames *f, const struct model *model)
{
  const struct structure *s = &f->structure;
  const int kinds = model ? (int)model->kinds : -1;
  printf("%" PRIu64 " %" PRIu32 " %" PRIu32 " %d %d %d\n", f->about.frames, f->about.rows, s->particles,
         f->about.velocities, s->kinds, kinds);
  for (int k = 0; k < s->kinds; k++)
    printf("%s\n", text_shown(s->name[k]));
  for (int k = 0; k < kinds; k++)
    printf("%.17g %.17g %.17g\n", model->kind[k].bond_length, model->kind[k].spring, model->kind[k].bending);
  fwrite(s->species, sizeof *s->species, s->particles, stdout);
  fwrite(s->next, sizeof *s->next, s->particles, stdout);
  for (uint32_t row = 0; row < s->particles; row++)
    fwrite(&(double){structure_mass(s, row)}, sizeof(double), 1, stdout);
}

/* A frame stands at a whole step: two half steps each. The cell of a sheared box leans by what the image beyond y = L
 * has slid, from -Lx/2 to Lx/2; and that image moves. */
static void print_frame(const struct frames *f, const struct model *m)
{
  const struct picture *p = &f->picture;
  const bool leans = m && model_is_sheared(m);
  const double slid = leans ? (double)shear_offset(m, 2 * p->step) * LATTICE_UNIT : 0.0;
  printf("fine %" PRIu64 " %.17g", p->step, p->time);
  for (int k = 0; k < 3; k++)
    printf(" %.17g %d", p->edge[k], m ? m->box.boundary[k] != BOUNDARY_WALL : !f->about.closed[k]);
  printf(" %d %.17g %.17g\n", leans, slid > 0.5 * p->edge[0] ? slid - p->edge[0] : slid,
         leans ? shear_rate(m, shear_interval(m, 2 * p->step)) * p->edge[1] : 0.0);
  fwrite(p->position, 3 * sizeof(double), f->about.rows, stdout);
  if (p->velocity)
    fwrite(p->velocity, 3 * sizeof(double), f->about.rows, stdout);
}

/* Those whose numbers standard input says, until it ends. False, with a message, if there can be no more. */
static bool answer(struct frames *f, const struct model *model, struct message *message)
{
  char line[32];
  while (fflush(stdout) == 0 && fgets(line, sizeof line, stdin)) {
    char *end;
    const uint64_t frame = strtoull(line, &end, 10);
    if (line[0] < '0' || line[0] > '9' || (*end != '\n' && !(*end == 0 && feof(stdin))))
      return message_set(message, "standard input: '%s' is not the number of a frame", line);
    const enum frame_verdict verdict = frames_read(f, frame, message);
    if (verdict == FRAME_LOST)
      return false;
    if (verdict == FRAME_FINE && f->picture.has_box)
      print_frame(f, model);
    else if (verdict == FRAME_FINE)
      printf("damaged %s: frame %" PRIu64 ": its box (box/edges) cannot be read or is not rectangular\n",
             text_shown(f->path), frame);
    else
      printf("damaged %s\n", message->text);
  }
  return true;
}

enum exit_code command_frames(const struct arguments *a)
{
  enum h5_trouble trouble;
  struct message message, ignored;
  struct frames *f = frames_open(a->file[0], &trouble, &message);
  struct scene scene;
  const bool known = f && f->scene && scene_read_text(f->path, f->scene, strlen(f->scene), &scene, &ignored);
  if (known)
    shear_begin(&scene.model, f->about.slide);
  if (f)
    print_head(f, known ? &scene.model : NULL);
  const bool ok = f && answer(f, known ? &scene.model : NULL, &message);
  if (known)
    scene_free(&scene);
  frames_close(f);
  if (!ok)
    fprintf(stderr, "uncross: %s\n", message.text);
  return ok ? EXIT_DONE : message.kind == MESSAGE_NO_MEMORY ? EXIT_TROUBLE : EXIT_BAD_INPUT;
}

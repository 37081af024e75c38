/* Frames, as the process that reads a file gets them. The other side is frames_apart.c. */
#include "files/frames.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "files/frames_apart.h"

#define MOST_SCENE ((size_t)1 << 26) /* bytes of a scene's text */

/* --- what the file is ------------------------------------------------------------------------------------------- */

static enum h5_trouble trouble_of(int verdict, const struct apart *apart)
{
  return verdict == H5_DAMAGED ? H5_DAMAGED : apart->died ? H5_DEADLY : H5_UNREADABLE;
}

bool h5_find_sort(const char *path, enum h5_sort *sort, enum h5_trouble *trouble, struct message *message)
{
  struct apart apart;
  *trouble = H5_UNREADABLE;
  if (!apart_start(&apart, path, "sort", message))
    return false;
  const int verdict = apart_get_verdict(&apart, message);
  const bool ok = verdict == H5_FINE && (apart_get(&apart, sort, sizeof *sort) || apart_lost(&apart, message));
  *trouble = ok ? H5_FINE : trouble_of(verdict, &apart);
  apart_end(&apart);
  return ok;
}

/* --- what the file says about itself ----------------------------------------------------------------------------- */

static void end_text(char *text, size_t size)
{
  text[size - 1] = '\0';
}

static bool get_structure(struct apart *apart, struct structure *s)
{
  uint32_t particles;
  int32_t kinds, stored_bonds, has_mass = 0;
  if (!apart_get(apart, &particles, sizeof particles) || !apart_get(apart, &kinds, sizeof kinds) ||
      !apart_get(apart, &s->bonds, sizeof s->bonds) || !apart_get(apart, &stored_bonds, sizeof stored_bonds) ||
      kinds < 0)
    return false;
  s->stored_bonds = stored_bonds;
  s->particles = particles;
  s->kinds = kinds;
  s->species = calloc((size_t)particles + 1, sizeof *s->species);
  s->next = calloc((size_t)particles + 1, sizeof *s->next);
  s->name = calloc((size_t)kinds + 1, sizeof *s->name);
  bool ok = s->species && s->next && s->name && apart_get(apart, s->species, particles * sizeof *s->species) &&
            apart_get(apart, s->next, particles * sizeof *s->next) &&
            apart_get(apart, s->name, (size_t)kinds * sizeof *s->name) && apart_get(apart, &has_mass, sizeof has_mass);
  if (ok && has_mass) {
    s->mass = calloc((size_t)particles + 1, sizeof *s->mass);
    ok = s->mass && apart_get(apart, s->mass, particles * sizeof *s->mass);
  }
  for (int k = 0; ok && k < kinds; k++)
    end_text(s->name[k], sizeof s->name[k]);
  return ok;
}

static bool get_about(struct frames *f)
{
  struct frames_about *about = &f->about;
  if (!apart_get(&f->apart, about, sizeof *about) || !get_structure(&f->apart, &f->structure) ||
      !apart_get_text(&f->apart, MOST_SCENE, &f->scene))
    return false;
  end_text(about->summary.head.version, sizeof about->summary.head.version);
  end_text(about->creator, sizeof about->creator);
  end_text(about->version, sizeof about->version);
  end_text(about->author, sizeof about->author);
  end_text(about->unfit, sizeof about->unfit);
  return true;
}

static struct frames *give_up(struct frames *f)
{
  frames_close(f);
  return NULL;
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
  if (!apart_start(&f->apart, f->path, "frames", message))
    return give_up(f);
  const int verdict = apart_get_verdict(&f->apart, message);
  bool ok = verdict == H5_FINE;
  if (ok && !get_about(f))
    ok = f->apart.broken ? apart_lost(&f->apart, message) : message_no_memory(message, "%s: out of memory", path);
  *trouble = ok ? H5_FINE : trouble_of(verdict, &f->apart);
  return ok ? f : give_up(f);
}

void frames_close(struct frames *f)
{
  if (!f)
    return;
  apart_end(&f->apart);
  structure_free(&f->structure);
  free(f->picture.position);
  free(f->picture.velocity);
  free(f->scene);
  free(f->path);
  free(f);
}

/* --- frames ------------------------------------------------------------------------------------------------------ */

/* Only now, when there is a frame whose shape the other side has looked at. */
static bool make_room(struct frames *f, struct message *message)
{
  struct picture *p = &f->picture;
  const size_t numbers = ((size_t)f->about.rows + 1) * 3;
  p->position = p->position ? p->position : malloc(numbers * sizeof *p->position);
  if (f->about.velocities)
    p->velocity = p->velocity ? p->velocity : malloc(numbers * sizeof *p->velocity);
  return (p->position && (p->velocity || !f->about.velocities)) ||
         message_no_memory(message, "%s: out of memory", f->path);
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

static enum frame_verdict ask(struct frames *f, uint64_t frame, bool rows, struct message *message)
{
  struct picture *p = &f->picture;
  struct frame_moment moment;
  const struct frame_request request = {.frame = frame, .rows = rows};
  if (frame >= f->about.frames) {
    message_set(message, "%s: frame %" PRIu64 " asked for; it has %" PRIu64, f->path, frame, f->about.frames);
    return FRAME_LOST;
  }
  apart_put(&f->apart, &request, sizeof request);
  const int verdict = apart_get_verdict(&f->apart, message);
  if (verdict != FRAME_FINE && verdict != FRAME_DAMAGED)
    return FRAME_LOST;
  if (!apart_get(&f->apart, &moment, sizeof moment)) {
    apart_lost(&f->apart, message);
    return FRAME_LOST;
  }
  p->step = moment.step, p->time = moment.time, p->has_box = moment.has_box;
  memcpy(p->edge, moment.edge, sizeof p->edge);
  if (verdict == FRAME_DAMAGED)
    return FRAME_DAMAGED;
  if (rows && !make_room(f, message))
    return FRAME_LOST;
  const size_t bytes = 3 * sizeof(double) * (size_t)f->about.rows;
  if (rows &&
      !(apart_get(&f->apart, p->position, bytes) && (!p->velocity || apart_get(&f->apart, p->velocity, bytes)))) {
    apart_lost(&f->apart, message);
    return FRAME_LOST;
  }
  return !rows || (finite(f, frame, "position", p->position, message) &&
                   finite(f, frame, "velocity", p->velocity, message))
             ? FRAME_FINE
             : FRAME_DAMAGED;
}

enum frame_verdict frames_read(struct frames *f, uint64_t frame, struct message *message)
{
  return ask(f, frame, true, message);
}

enum frame_verdict frames_check(struct frames *f, uint64_t frame, struct message *message)
{
  return ask(f, frame, false, message);
}

/* Checkpoints for a model: a process of its own reads them (apart.h), this one checks what it is handed. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files/checkpoint_parts.h"
#include "files/reader.h"
#include "files/structure.h"

/* After the verdict about the file and the summary, requests for arrays are answered until the link is cut: with a
 * verdict (enum answer), and the bytes if it is 0. */
struct request {
  char group[32], name[256];
  uint64_t dims[2], rank;
  uint64_t type; /* as wide as the others, so that no unset byte is sent */
};

enum type { REALS, INTEGERS, SHORT_INTEGERS, TYPES };
enum answer { FINE, ABSENT, BROKEN };

static const size_t bytes_of[TYPES] = {sizeof(double), sizeof(int64_t), sizeof(int32_t)};

/* --- the reader's side ------------------------------------------------------------------------------------------- */

static hid_t type_of(uint64_t type)
{
  const hid_t types[TYPES] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_INT64, H5T_NATIVE_INT32};
  return types[type];
}

static enum answer read_array(hid_t file, const struct request *r, void *data)
{
  hid_t group = h5_open_group(file, r->group);
  const int found = group < 0 ? -1 : h5_look(group, r->name);
  const hsize_t dims[2] = {r->dims[0], r->dims[1]};
  const bool ok = found > 0 && h5_array_read(group, r->name, type_of(r->type), (int)r->rank, dims, data);
  h5_close(group);
  return ok ? FINE : found == 0 ? ABSENT : BROKEN;
}

static void answer(struct apart *link, hid_t file, const struct request *r)
{
  const size_t bytes = bytes_of[r->type] * (size_t)r->dims[0] * (size_t)(r->rank > 1 ? r->dims[1] : 1);
  struct message message = {.text = ""};
  void *data = malloc(bytes + 1);
  const enum answer how = data ? read_array(file, r, data) : BROKEN;
  if (!data)
    message_no_memory(&message, "%s: out of memory", link->path);
  else if (how != FINE)
    h5_fail(&message, link->path, "damaged checkpoint: its positions or velocities cannot be read or fail their check");
  apart_put_verdict(link, (int)how, &message);
  if (how == FINE)
    apart_put(link, data, bytes);
  free(data);
}

void checkpoint_serve(struct apart *link)
{
  struct checkpoint_summary summary;
  struct message message = {.text = ""};
  struct request request;
  enum h5_trouble trouble;
  bool sealed;
  unsigned failures;
  hid_t file = h5_open(link->path, false, &sealed, &trouble, &message);
  apart_shut();
  h5_watch(&failures);
  bool ok =
      file >= 0 && checkpoint_find(file, link->path, sealed, &summary, &message) &&
      (failures == 0 || message_set(&message, "%s: damaged checkpoint: HDF5 cannot read some part of it", link->path));
  apart_put_verdict(link, ok ? 0 : 1, &message);
  ok = ok && apart_put(link, &summary, sizeof summary);
  while (ok && apart_get(link, &request, sizeof request)) {
    apart_go_on(link);
    answer(link, file, &request);
  }
}

/* --- the side that asks ------------------------------------------------------------------------------------------ */

/* -1, with a message: the reader is gone. ABSENT and BROKEN: with one, too, that speaks of positions. */
static int ask(struct apart *apart, const char *group, const char *name, enum type type, uint64_t rows,
               uint64_t columns, void *data, struct message *message)
{
  struct request r = {.dims = {rows, columns}, .rank = columns > 0 ? 2 : 1, .type = type};
  snprintf(r.group, sizeof r.group, "%s", group);
  snprintf(r.name, sizeof r.name, "%s", name);
  apart_put(apart, &r, sizeof r);
  const int how = apart_get_verdict(apart, message);
  const size_t bytes = bytes_of[type] * (size_t)rows * (size_t)(columns > 0 ? columns : 1);
  if (how != FINE || apart_get(apart, data, bytes))
    return how;
  apart_lost(apart, message);
  return -1;
}

#define SAME "; they must be equal"

static bool fits_vertices(struct apart *apart, const struct model *m, struct message *message)
{
  struct message why = {.text = "its masses cannot be read"};
  void *stored = malloc(((size_t)m->bonds + m->vertices + 1) * 8); /* pairs of numbers, then masses */
  if (!stored)
    return message_no_memory(message, "%s: out of memory", apart->path);
  int how = ask(apart, "structure", "bonds", SHORT_INTEGERS, m->bonds, 2, stored, message);
  const bool same = how == FINE && structure_same_bonds(stored, m);
  if (!same && how >= 0)
    message_set(message, "%s: its bonds are not the scene's (other fibers, or a damaged file)", apart->path);
  how = same ? ask(apart, "structure", "mass", REALS, m->vertices, 0, stored, message) : -1;
  const bool fits = how == FINE && !structure_masses_differ(stored, m->vertices, m, &why);
  if (!fits && how >= 0)
    message_set(message, "%s: %s", apart->path, why.text);
  free(stored);
  return fits;
}

static bool fits_model(struct apart *apart, const struct checkpoint_summary *s, const struct model *m,
                       struct message *message)
{
  const char *path = apart->path;
  const int *cells = m->box.cells;
  struct message why;
  if (memcmp(s->cells, cells, sizeof s->cells) != 0)
    return message_set(message, "%s: its box is %d x %d x %d cells, the scene's %d x %d x %d" SAME, path, s->cells[0],
                       s->cells[1], s->cells[2], cells[0], cells[1], cells[2]);
  if (s->particles != m->solvent.particles)
    return message_set(message, "%s: it holds %u solvent particles, the scene %u" SAME, path, s->particles,
                       m->solvent.particles);
  if (s->vertices != m->vertices)
    return message_set(message, "%s: it holds %u fiber vertices, the scene %u" SAME, path, s->vertices, m->vertices);
  if (s->dumbbells != m->dumbbells.pairs)
    return message_set(message, "%s: it holds %u dumbbells, the scene %u" SAME, path, s->dumbbells, m->dumbbells.pairs);
  if (structure_walls_differ(s->wall_rows > 0, m, &why))
    return message_set(message, "%s: %s", path, why.text);
  if ((s->beads > 0) != model_has_bead(m))
    return message_set(message, "%s: it is of a solvent %s bead, the scene has %s", path,
                       s->beads > 0 ? "around a" : "without a", s->beads > 0 ? "none" : "one");
  return fits_vertices(apart, m, message);
}

/* Earlier checkpoints hold no settings; they are taken to be the scene's, or 0 if there was no such setting. */
static bool same_setting(struct apart *apart, const char *name, const struct observe_block *block,
                         struct message *message)
{
  const int64_t wanted = *(const int64_t *)block->data;
  int64_t stored;
  const int how = ask(apart, "observers", name, INTEGERS, 1, 0, &stored, message);
  if (how == ABSENT)
    stored = block->later ? 0 : wanted;
  if (how == BROKEN)
    message_set(message, "%s: damaged checkpoint: '%s' cannot be read", apart->path, name);
  if (how != FINE && how != ABSENT)
    return false;
  return stored == wanted ||
         message_set(message,
                     "observe.%s: %" PRId64 " in the scene, but %" PRId64 " in the run so far (%s), whose averages go "
                     "on; a resumed run keeps it",
                     name, wanted, stored, apart->path);
}

static bool fits_integers(const struct observe_block *block)
{
  bool fit = true;
  for (size_t k = 0; block->integer && !block->wraps && k < block->count; k++) {
    const int64_t number = ((const int64_t *)block->data)[k];
    fit &= number > -OBSERVE_MOST_INTEGER && number < OBSERVE_MOST_INTEGER;
  }
  return fit;
}

static bool get_block(struct apart *apart, const struct observe_block *block, struct message *message)
{
  char name[256];
  checkpoint_block_name(block, name, sizeof name);
  if (block->setting)
    return same_setting(apart, name, block, message);
  const int how =
      ask(apart, "observers", name, block->integer ? INTEGERS : REALS, block->count, 0, block->data, message);
  if (how == FINE && !fits_integers(block))
    return message_set(message, "%s: damaged checkpoint: the memory of '%s' holds a number that no run has",
                       apart->path, block->name);
  if (how == ABSENT && block->later) {
    for (size_t k = 0; k < block->count; k++)
      ((double *)block->data)[k] = NAN;
    return true;
  }
  return how == FINE || how < 0
             ? how == FINE
             : message_set(message,
                           "%s: no memory of the observable '%s' in this size (damaged, or not sampled by this run so "
                           "far: resume without it, or begin a run from this checkpoint with start.snapshot)",
                           apart->path, block->name);
}

static bool get_rows(void *from, const struct state_group *group, const struct state_field *field, void *rows,
                     struct message *message)
{
  return ask(from, "state", field->name, field->integer ? INTEGERS : REALS, group->rows, 3, rows, message) == FINE;
}

static bool get_blocks(struct apart *apart, const struct observe_block *blocks, size_t count, struct message *message)
{
  bool ok = true;
  for (size_t b = 0; ok && b < count; b++)
    ok = get_block(apart, &blocks[b], message);
  return ok;
}

static bool get_summary(struct apart *apart, struct checkpoint_summary *summary, struct message *message)
{
  if (apart_get_verdict(apart, message) != 0)
    return false;
  if (!apart_get(apart, summary, sizeof *summary))
    return apart_lost(apart, message);
  summary->head.version[sizeof summary->head.version - 1] = '\0';
  return true;
}

bool checkpoint_look(const char *path, struct checkpoint_summary *summary, struct message *message)
{
  struct apart apart;
  if (!apart_start(&apart, path, "checkpoint", message))
    return false;
  const bool ok = get_summary(&apart, summary, message);
  apart_end(&apart);
  return ok;
}

bool checkpoint_fingerprint(const char *path, uint64_t *fingerprint)
{
  struct checkpoint_summary summary;
  struct message ignored;
  const bool ok = checkpoint_look(path, &summary, &ignored);
  if (ok)
    *fingerprint = summary.head.fingerprint;
  return ok;
}

bool checkpoint_fetch(const char *path, const struct model *model, struct checkpoint_summary *summary,
                      struct state *state, const struct observe_block *blocks, size_t block_count,
                      struct message *message)
{
  struct apart apart;
  if (!apart_start(&apart, path, "checkpoint", message))
    return false;
  const bool ok = get_summary(&apart, summary, message) && fits_model(&apart, summary, model, message) &&
                  checkpoint_each_array(state, get_rows, &apart, path, message) &&
                  get_blocks(&apart, blocks, block_count, message);
  apart_end(&apart);
  if (!ok)
    return false;
  checkpoint_take_numbers(state, &summary->numbers);
  return checkpoint_check(state, summary, model->next, path, message);
}

bool checkpoint_read(const char *path, const struct model *model, struct checkpoint_head *head, struct state *state,
                     const struct observe_block *blocks, size_t block_count, struct message *message)
{
  struct checkpoint_summary summary;
  if (!checkpoint_fetch(path, model, &summary, state, blocks, block_count, message))
    return false;
  *head = summary.head;
  return true;
}

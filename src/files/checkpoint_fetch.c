/* Checkpoints for a model. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files/checkpoint_parts.h"
#include "files/structure.h"

#define SAME "; they must be equal"

static bool fits_vertices(struct far *far, const struct model *m, struct message *message)
{
  const char *path = far->apart.path;
  const uint64_t bonds[2] = {m->bonds, 2}, rows[1] = {m->vertices};
  struct message why = {.text = "its masses cannot be read"};
  void *stored = malloc(((size_t)m->bonds + m->vertices + 1) * 8); /* pairs of numbers, then masses */
  if (!stored)
    return message_no_memory(message, "%s: out of memory", path);
  const bool same =
      far_read(far, "structure", "bonds", FAR_ALL, FAR_SHORT, 2, bonds, stored) && structure_same_bonds(stored, m);
  if (!same)
    message_set(message, "%s: its bonds are not the scene's (other fibers, or a damaged file)", path);
  const bool fits = same && far_read(far, "structure", "mass", FAR_ALL, FAR_REAL, 1, rows, stored) &&
                    !structure_masses_differ(stored, m->vertices, m, &why);
  if (same && !fits)
    message_set(message, "%s: %s", path, why.text);
  free(stored);
  return fits;
}

static bool fits_model(struct far *far, const struct checkpoint_summary *s, const struct model *m,
                       struct message *message)
{
  const char *path = far->apart.path;
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
  return fits_vertices(far, m, message);
}

/* An array of observers. FAR_NOTHING: there is none; FAR_BROKEN: not of this shape, or it cannot be read. */
static enum far_kind read_block(struct far *far, const char *name, const struct observe_block *block, void *data)
{
  const uint64_t dims[1] = {block->setting ? 1 : block->count};
  if (far_look(far, "observers", name).kind == FAR_NOTHING && far_has(far, "", "observers"))
    return FAR_NOTHING;
  const bool read = far_read(far, "observers", name, FAR_ALL, block->integer || block->setting ? FAR_INTEGER : FAR_REAL,
                             1, dims, data);
  return read ? FAR_DATASET : FAR_BROKEN;
}

/* Earlier checkpoints hold no settings; they are taken to be the scene's, or 0 if there was no such setting. */
static bool same_setting(struct far *far, const char *name, const struct observe_block *block, struct message *message)
{
  const int64_t wanted = *(const int64_t *)block->data;
  int64_t stored;
  const enum far_kind found = read_block(far, name, block, &stored);
  if (found == FAR_BROKEN)
    return message_set(message, "%s: damaged checkpoint: '%s' cannot be read", far->apart.path, name);
  if (found == FAR_NOTHING)
    stored = block->later ? 0 : wanted;
  return stored == wanted ||
         message_set(message,
                     "observe.%s: %" PRId64 " in the scene, but %" PRId64 " in the run so far (%s), whose averages go "
                     "on; a resumed run keeps it",
                     name, wanted, stored, far->apart.path);
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

static bool get_block(struct far *far, const struct observe_block *block, struct message *message)
{
  char name[256];
  checkpoint_block_name(block, name, sizeof name);
  if (block->setting)
    return same_setting(far, name, block, message);
  const enum far_kind found = read_block(far, name, block, block->data);
  if (found == FAR_DATASET)
    return fits_integers(block) ||
           message_set(message, "%s: damaged checkpoint: the memory of '%s' holds a number that no run has",
                       far->apart.path, block->name);
  for (size_t k = 0; found == FAR_NOTHING && block->later && k < block->count; k++)
    ((double *)block->data)[k] = NAN;
  return (found == FAR_NOTHING && block->later) ||
         message_set(message,
                     "%s: no memory of the observable '%s' in this size (damaged, or not sampled by this run so "
                     "far: resume without it, or begin a run from this checkpoint with start.snapshot)",
                     far->apart.path, block->name);
}

static bool get_blocks(struct far *far, const struct observe_block *blocks, size_t count, struct message *message)
{
  bool ok = true;
  for (size_t b = 0; ok && b < count; b++)
    ok = get_block(far, &blocks[b], message);
  return ok;
}

/* With the summary; to be closed with `end`, also after a failure. */
static bool begin(struct far *far, const char *path, struct checkpoint_summary *summary, struct message *message)
{
  enum h5_trouble trouble;
  return far_open(far, path, &trouble, message) && checkpoint_find(far, summary, message) &&
         far_whole(far, 0, "damaged checkpoint: HDF5 cannot read some part of it", message);
}

/* That the reader is no more says most. */
static bool end(struct far *far, bool ok, struct message *message)
{
  const bool fine = far_whole(far, far->failures, "", message) && ok;
  far_close(far);
  return fine;
}

bool checkpoint_look(const char *path, struct checkpoint_summary *summary, struct message *message)
{
  struct far far;
  return end(&far, begin(&far, path, summary, message), message);
}

bool checkpoint_fetch(const char *path, const struct model *model, struct checkpoint_summary *summary,
                      struct state *state, const struct observe_block *blocks, size_t block_count,
                      struct message *message)
{
  struct far far;
  const bool ok = begin(&far, path, summary, message) && fits_model(&far, summary, model, message) &&
                  checkpoint_read_state(&far, summary, state, model->next, message) &&
                  get_blocks(&far, blocks, block_count, message);
  return end(&far, ok, message);
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

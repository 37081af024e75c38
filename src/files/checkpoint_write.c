/* Checkpoints are put together in memory, and put in place as a whole. */
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "files/checkpoint_parts.h"
#include "files/folder.h"
#include "files/frames.h"
#include "files/structure.h"

/* --- writing ----------------------------------------------------------------------------------------------------- */

/* One field, its rows in the order of their numbers: the same bytes whatever the order in memory. */
static bool write_field(hid_t group, const struct state_group *rows, const struct state_field *field,
                        const uint32_t *slot)
{
  const hsize_t dims[2] = {rows->rows, 3};
  void *data = malloc(((size_t)rows->rows + 1) * 24);
  if (data)
    state_field_get(rows, field, slot, data);
  const bool ok = data && h5_array_write(group, field->name, checkpoint_field_type(field), 2, dims, data);
  free(data);
  return ok;
}

static bool write_state(hid_t group, const struct state *state)
{
  struct state_group rows[STATE_GROUPS];
  state_groups(state, rows);
  bool ok = true;
  for (int g = 0; ok && g < STATE_GROUPS; g++) {
    uint32_t *slot = malloc(((size_t)rows[g].rows + 1) * sizeof *slot);
    ok = slot;
    if (ok)
      state_group_slots(&rows[g], slot);
    for (size_t f = 0; ok && f < rows[g].fields && checkpoint_has_group(&rows[g]); f++)
      ok = write_field(group, &rows[g], &rows[g].field[f], rows[g].id ? slot : NULL);
    free(slot);
  }
  return ok;
}

static bool write_blocks(hid_t group, const struct observe_block *blocks, size_t count)
{
  bool ok = true;
  for (size_t b = 0; ok && b < count; b++) {
    char name[256];
    const hsize_t dims[1] = {blocks[b].count};
    const int64_t nothing = 0;
    checkpoint_block_name(&blocks[b], name, sizeof name);
    ok = h5_array_write(group, name, checkpoint_block_type(&blocks[b]), 1, dims,
                        blocks[b].data ? blocks[b].data : &nothing);
  }
  return ok;
}

struct contents {
  struct checkpoint_summary summary;
  const struct model *model;
  const struct state *state;
  const struct observe_block *blocks;
  size_t block_count;
  const char *scene_text;
};

static bool write_contents(hid_t file, struct contents *c)
{
  const int32_t version = CHECKPOINT_VERSION;
  hid_t head = h5_group(file, "head"), structure = h5_group(file, "structure");
  hid_t state = h5_group(file, "state"), observers = h5_group(file, "observers");
  bool ok = h5_put_text(file, "format", CHECKPOINT_FORMAT) &&
            h5_put(file, "format_version", H5T_NATIVE_INT32, 0, &version) &&
            h5_put_text(head, "version", c->summary.head.version) && checkpoint_fields(file, &c->summary, true) &&
            h5_put(head, "frames_end", H5T_NATIVE_UINT64, 0, &c->summary.head.frames_end) &&
            structure_write_particles(structure, c->model, false) && structure_write_bonds(structure, c->model) &&
            checkpoint_numbers(state, &c->summary.numbers, true) && write_state(state, c->state) &&
            write_blocks(observers, c->blocks, c->block_count) &&
            h5_text_write(file, "scene", c->scene_text ? c->scene_text : "");
  h5_close(head);
  h5_close(structure);
  h5_close(state);
  h5_close(observers);
  return ok;
}

static struct checkpoint_summary summary_of(const struct checkpoint_head *head, const struct model *model,
                                            const struct state *state)
{
  struct checkpoint_summary s = {.head = *head,
                                 .dimensions = model->dimensions,
                                 .time_step = model->time_step,
                                 .acceleration = model->solvent.acceleration,
                                 .particles = state->solvent.n,
                                 .vertices = state->vertices,
                                 .dumbbells = state->dumbbells.n,
                                 .wall_rows = state->wall_rows,
                                 .beads = state->beads};
  checkpoint_take_numbers(&s.numbers, state);
  s.head.version[sizeof s.head.version - 1] = '\0';
  memcpy(s.cells, model->box.cells, sizeof s.cells);
  return s;
}

/* The whole file as bytes: it is made in memory, so that every error of the disk is met in file_replace. */
static void *make_image(struct contents *c, size_t *bytes, const char *path, struct message *message)
{
  size_t estimate = ((size_t)c->state->solvent.n + c->state->vertices) * 64;
  for (size_t b = 0; b < c->block_count; b++)
    estimate += c->blocks[b].count * sizeof(double) + 1024;
  hid_t file = h5_create_in_memory(estimate + estimate / 16);
  void *image = file >= 0 && write_contents(file, c) ? h5_image(file, bytes) : NULL;
  if (!image)
    h5_fail(message, path, "the checkpoint could not be put together (memory?)");
  h5_close(file);
  return image;
}

bool checkpoint_write_in(const struct folder *folder, const char *file, struct checkpoint_head *head,
                         const struct model *model, const struct state *state, const struct observe_block *blocks,
                         size_t block_count, const char *scene_text, struct message *message)
{
  char path[4096];
  folder_path(folder, file, path, sizeof path);
  head->state_hash = state_hash(state);
  head->slide = model->shear.slid;
  head->state_digest = state_digest(state);
  struct contents contents = {summary_of(head, model, state), model, state, blocks, block_count, scene_text};
  size_t bytes;
  if (head->state_hash == 0)
    return message_set(message, "%s: checkpoint not written: no memory; an earlier one is untouched", path);
  void *image = make_image(&contents, &bytes, path, message);
  bool ok = image && file_replace(folder, file, image, bytes, message);
  free(image);
  return ok;
}

/* Whether a checkpoint may be put there by its path, where files of others may be: nothing is there, or a checkpoint.
 */
static bool is_place_of_checkpoint(const char *path, struct message *message)
{
  const struct folder none = {"", FOLDER_BY_NAME};
  enum h5_sort sort;
  enum h5_trouble trouble;
  struct message ignored;
  if (!folder_has_place(&none, path, message))
    return false;
  if (folder_find(&none, path, message) != FOLDER_HAS)
    return true; /* what cannot be known cannot be written either */
  return (h5_find_sort(path, &sort, &trouble, &ignored) && sort == H5_CHECKPOINT) ||
         message_set(message,
                     "%s: is not a checkpoint, or a damaged one; nothing is written over it: name another file", path);
}

/* The file that is written first. A killed program may have left it, and it may be another file of the same name. */
static bool is_part_ours(const char *path, struct message *message)
{
  static const unsigned char signature[] = {0x89, 'H', 'D', 'F'};
  const struct folder none = {"", FOLDER_BY_NAME};
  unsigned char head[sizeof signature];
  char part[4096];
  if ((size_t)snprintf(part, sizeof part, "%s.part", path) >= sizeof part)
    return message_set(message, "%.200s...: path too long", path);
  if (!folder_has(&none, part))
    return true;
  const int fd = folder_open_file(&none, part, O_RDONLY);
  const ssize_t bytes = fd < 0 ? -1 : read(fd, head, sizeof head);
  if (fd >= 0)
    close(fd);
  return bytes == 0 || (bytes == sizeof head && memcmp(head, signature, sizeof head) == 0) ||
         message_set(message,
                     "%s: is needed for a moment, and holds something else: name another file, or move it away", part);
}

bool checkpoint_write(const char *path, struct checkpoint_head *head, const struct model *model,
                      const struct state *state, const struct observe_block *blocks, size_t block_count,
                      const char *scene_text, struct message *message)
{
  const struct folder none = {"", FOLDER_BY_NAME};
  return is_place_of_checkpoint(path, message) && is_part_ours(path, message) &&
         checkpoint_write_in(&none, path, head, model, state, blocks, block_count, scene_text, message);
}

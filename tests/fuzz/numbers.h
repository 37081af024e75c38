/* Checkpoints of which every checksum is right, and some number is not one that a run would have written. */
#ifndef UNCROSS_TESTS_FUZZ_NUMBERS_H
#define UNCROSS_TESTS_FUZZ_NUMBERS_H

#include <xxhash.h>

#include "files/folder.h"
#include "foreign.h"
#include "observe/observe.h"
#include "start/start.h"

static const char observed_text[] =
    "observe: {conserved: {every: 1}, temperature: {every: 1}, statics: {every: 1}, dynamics: {every: 1, longest_lag: "
    "8}, collisions: "
    "{every: 1}, profile: {every: 1, slabs: 4}, stress: {every: 1}, orientation: {every: 1}}\n";

/* Where something in memory stands in the file, and for arrays, where their checksum does. */
struct place {
  void *memory;
  size_t bytes, at, checksum;
};

#define MOST_PLACES 64

static struct {
  struct scene scene;
  struct state state, changed;
  struct checkpoint_head head;
  struct observers *observers;
  const struct observe_block *blocks;
  struct observe_block *changes; /* [count] the same, with memory of their own */
  void **kept;                   /* [count] what the blocks hold after the run */
  size_t count;
  struct place number[MOST_PLACES], array[MOST_PLACES];
  size_t numbers, arrays;
  size_t hash; /* where that of the state stands */
  struct victim file;
} observed;

static bool take_nothing(void *context, const struct observe_table *table)
{
  (void)context;
  return table->rows == 0 || table->value != NULL;
}

/* Some steps, seen by all observers. */
static void go_on(struct state *state, struct work *work, int steps)
{
  observers_watch(observed.observers, work);
  for (int k = 0; k < steps && step_advance(state, &observed.scene.model, work, NULL); k++)
    require(observers_sample(observed.observers, &observed.scene.model, state, NULL), "nothing is observed");
  require(observers_summaries(observed.observers, &observed.scene.model, take_nothing, NULL), "no tables");
}

/* The state and the memory of observers, as they were after the run. Solvent particles get the numbers of their places.
 */
static void restore(void)
{
  observed.head = (struct checkpoint_head){.fingerprint = observed.scene.fingerprint, .seed = 1, .version = "fuzz"};
  struct state_group from[STATE_GROUPS], to[STATE_GROUPS];
  char *rows = malloc(((size_t)observed.state.solvent.n + observed.state.vertices) * 24);
  state_groups(&observed.state, from);
  state_groups(&observed.changed, to);
  for (size_t k = 0; k < state_number_count; k++)
    memcpy((char *)&observed.changed + state_numbers[k].offset, (char *)&observed.state + state_numbers[k].offset,
           state_numbers[k].bytes);
  for (int g = 0; g < 2; g++)
    for (size_t f = 0; f < from[g].fields; f++) {
      state_field_get(&from[g], &from[g].field[f], NULL, rows);
      state_field_set(&to[g], &to[g].field[f], rows);
    }
  free(rows);
  for (size_t k = 0; k < observed.count; k++)
    memcpy(observed.changes[k].data, observed.kept[k], observed.blocks[k].count * 8);
}

/* --- where numbers stand in the file ---------------------------------------------------------------------------------
 */

static size_t find_bytes(const void *bytes, size_t count)
{
  size_t found = 0, times = 0;
  for (size_t at = 0; at + count <= observed.file.size; at++)
    if (memcmp(observed.file.data + at, bytes, count) == 0)
      found = at, times++;
  require(times == 1, "a number is not once in a checkpoint");
  return found;
}

static void write_checkpoint(void)
{
  struct message message;
  const struct folder none = {"", FOLDER_BY_NAME};
  require(checkpoint_write_in(&none, observed.file.path, &observed.head, &observed.scene.model, &observed.changed,
                              observed.changes, observed.count, scene_text, &message),
          message.text);
  free(observed.file.data);
  take_file(&observed.file);
}

/* A value of which there is no other in the file. */
static void add_number(void *memory, size_t bytes)
{
  const uint64_t some = (observed.numbers + 1) * 0x9e3779b97f4a7c15u;
  require(observed.numbers < MOST_PLACES, "many numbers");
  memcpy(memory, &some, bytes);
  observed.number[observed.numbers++] = (struct place){.memory = memory, .bytes = bytes};
}

#define HEAD_INTEGERS 7 /* of the numbers, the first */
#define HEAD_NUMBERS 10

static void find_numbers_of_head(void)
{
  struct checkpoint_head *h = &observed.head;
  uint64_t *const whole[] = {
      &h->fingerprint,         &h->seed,      &h->stream.key, &h->stream.parent, &h->stream.parent_step,
      &h->stream.parent_state, &h->frames_end};
  double *const real[] = {&h->wall_seconds, &h->start_energy, &h->start_momentum.x};
  for (size_t k = 0; k < sizeof whole / sizeof *whole; k++)
    add_number(whole[k], 8);
  for (size_t k = 0; k < sizeof real / sizeof *real; k++)
    add_number(real[k], 8);
  for (size_t k = 0; k < state_number_count; k++)
    add_number((char *)&observed.changed + state_numbers[k].offset, state_numbers[k].bytes);
  write_checkpoint();
  for (size_t k = 0; k < observed.numbers; k++)
    observed.number[k].at = find_bytes(observed.number[k].memory, observed.number[k].bytes);
  observed.hash = find_bytes(&h->state_hash, 8);
}

/* memory: NULL for a field of the state. */
static void add_array(hid_t file, const char *group, const char *name, void *memory, size_t bytes)
{
  char path[128];
  snprintf(path, sizeof path, "%s/%s", group, name);
  hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
  const haddr_t at = dataset < 0 ? HADDR_UNDEF : H5Dget_offset(dataset);
  require(at != HADDR_UNDEF && at + bytes <= observed.file.size && observed.arrays < MOST_PLACES, "an array");
  const uint64_t hash = XXH64(observed.file.data + at, bytes, 0);
  observed.array[observed.arrays++] = (struct place){memory, bytes, at, find_bytes(&hash, 8)};
  H5Dclose(dataset);
}

/* Fields of the state first, in the order of its groups. */
static void find_arrays(void)
{
  struct state_group group[STATE_GROUPS];
  hid_t file = H5Fopen(observed.file.path, H5F_ACC_RDONLY, H5P_DEFAULT);
  state_groups(&observed.changed, group);
  for (int g = 0; g < 2; g++)
    for (size_t f = 0; f < group[g].fields; f++)
      add_array(file, "state", group[g].field[f].name, NULL, (size_t)group[g].rows * 24);
  for (size_t k = 0; k < observed.count; k++)
    if (observed.changes[k].count * 8 > 256) /* shorter ones may be twice in the file */
      add_array(file, "observers", observed.changes[k].name, observed.changes[k].data, observed.changes[k].count * 8);
  H5Fclose(file);
}

static void find_places(void)
{
  restore();
  find_numbers_of_head();
  restore();
  write_checkpoint();
  find_arrays();
}

static void make_observed(const char *folder)
{
  struct message message;
  struct work work;
  char text[1024];
  const int length = snprintf(text, sizeof text, "%s%s", scene_text, observed_text);
  snprintf(observed.file.path, sizeof observed.file.path, "%.40s/uncross-fuzz-%d-n.h5", folder, (int)getpid());
  require(scene_read_text("observed", text, (size_t)length, &observed.scene, &message), message.text);
  const struct model *model = &observed.scene.model;
  observed.observers = observers_create(&observed.scene.observe, model);
  require(observed.observers && work_alloc(&work, model) && state_alloc(&observed.state, model) &&
              state_alloc(&observed.changed, model) && start_state(&observed.state, model, &work),
          "memory");
  go_on(&observed.state, &work, 6);
  work_free(&work);
  observed.count = observers_blocks(observed.observers, &observed.blocks);
  observed.changes = malloc(observed.count * sizeof *observed.changes);
  observed.kept = malloc(observed.count * sizeof *observed.kept);
  for (size_t k = 0; k < observed.count; k++) {
    const size_t bytes = observed.blocks[k].count * 8;
    observed.changes[k] = observed.blocks[k];
    observed.changes[k].data = malloc(bytes + 1);
    observed.kept[k] = malloc(bytes + 1);
    memcpy(observed.kept[k], observed.blocks[k].data, bytes);
  }
  find_places();
}

static void end_observed(void)
{
  for (size_t k = 0; k < observed.count; k++) {
    free(observed.changes[k].data);
    free(observed.kept[k]);
  }
  free(observed.changes);
  free(observed.kept);
  remove(observed.file.path);
  free(observed.file.data);
  observers_free(observed.observers);
  state_free(&observed.state);
  state_free(&observed.changed);
  scene_free(&observed.scene);
  memset(&observed, 0, sizeof observed);
}

/* An integer that is at some edge, or near what it was. */
static uint64_t integer_of(uint8_t kind, uint64_t was)
{
  return kind < 64    ? (uint64_t)1 << kind
         : kind < 128 ? ((uint64_t)1 << (kind - 64)) - 1
         : kind < 192 ? (uint64_t)0 - ((uint64_t)1 << (kind - 128))
                      : was + (kind - 224u);
}

static void change_number(void *at, bool integer, uint8_t kind)
{
  uint64_t whole;
  double real;
  memcpy(&whole, at, sizeof whole);
  memcpy(&real, at, sizeof real);
  whole = integer_of(kind, whole);
  real = number_of(kind, real);
  memcpy(at, integer ? (void *)&whole : (void *)&real, sizeof whole);
}

/* A row of the state. */
static void change_row(const uint8_t *c)
{
  struct state_group group[STATE_GROUPS];
  state_groups(&observed.changed, group);
  const struct state_group *g = &group[c[0] % 2];
  const struct state_field *field = &g->field[(c[0] >> 1) % g->fields];
  char *row = malloc((size_t)g->rows * 24);
  state_field_get(g, field, NULL, row);
  change_number(row + 24 * (((size_t)c[1] << 4 | c[2] >> 4) % g->rows) + 8 * (c[2] % 3), field->integer, c[3]);
  state_field_set(g, field, row);
  free(row);
}

static void change_count(const uint8_t *c)
{
  const struct state_number *n = &state_numbers[c[1] % state_number_count];
  uint64_t value = 0;
  char *at = (char *)&observed.changed + n->offset;
  memcpy(&value, at, n->bytes);
  value = integer_of(c[3], value);
  memcpy(at, &value, n->bytes);
}

static void change_block(const uint8_t *c)
{
  const struct observe_block *block = &observed.changes[c[1] % observed.count];
  if (block->count > 0)
    change_number((char *)block->data + 8 * ((size_t)c[2] % block->count), block->integer, c[3]);
}

static void change_head(const uint8_t *c)
{
  struct place *p = &observed.number[c[1] % HEAD_NUMBERS];
  change_number(p->memory, c[1] % HEAD_NUMBERS < HEAD_INTEGERS, c[3]);
}

/* --- changes ---------------------------------------------------------------------------------------------------------
 */

/* A change is four bytes: what, two for which, and the kind of number. At most 16. */
static void change_numbers(const uint8_t *data, size_t size)
{
  static void (*const changes[4])(const uint8_t *) = {change_row, change_count, change_block, change_head};
  restore();
  for (size_t k = 0; k + 4 <= size && k < 64; k += 4)
    changes[data[k] >> 6](data + k);
}

/* The file of these numbers, with all its checksums. */
static void put_numbers(void)
{
  const struct victim *file = &observed.file;
  uint8_t *copy = malloc(file->size);
  const size_t end = file->size - SEAL_BYTES;
  const uint64_t hash = state_hash(&observed.changed);
  struct state_group group[STATE_GROUPS];
  const struct place *p = observed.array;
  state_groups(&observed.changed, group);
  memcpy(copy, file->data, file->size);
  for (size_t k = 0; k < observed.numbers; k++)
    memcpy(copy + observed.number[k].at, observed.number[k].memory, observed.number[k].bytes);
  memcpy(copy + observed.hash, &hash, sizeof hash);
  for (int g = 0; g < 2; g++)
    for (size_t f = 0; f < group[g].fields; f++, p++)
      state_field_get(&group[g], &group[g].field[f], NULL, copy + p->at);
  for (; p < observed.array + observed.arrays; p++)
    memcpy(copy + p->at, p->memory, p->bytes);
  for (size_t k = 0; k < observed.arrays; k++) {
    const uint64_t sum = XXH64(copy + observed.array[k].at, observed.array[k].bytes, 0);
    memcpy(copy + observed.array[k].checksum, &sum, sizeof sum);
  }
  rehash_headers(file, copy);
  seal_make(copy, end, copy + end);
  put(file->path, copy, file->size);
  free(copy);
}

/* As a run goes on from it, and says what it has seen. */
static void go_on_from_numbers(void)
{
  struct checkpoint_head head;
  struct message message = {.text = ""};
  struct work work;
  const uint64_t written = state_hash(&observed.changed);
  if (!checkpoint_read(observed.file.path, &observed.scene.model, &head, &observed.changed, observed.blocks,
                       observed.count, &message)) {
    require_reason(&message, "a checkpoint was refused without a word");
    return;
  }
  require(state_hash(&observed.changed) == written, "what is read is not what was written");
  require(work_alloc(&work, &observed.scene.model), "memory");
  go_on(&observed.changed, &work, 2);
  work_free(&work);
}

#endif

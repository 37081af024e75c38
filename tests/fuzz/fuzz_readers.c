/*
 * libFuzzer over what reads files: `make fuzz SECONDS=60`. The first byte of an input chooses the reader:
 *   s  the rest is a scene, as text
 *   c  the rest are changes of a valid checkpoint, which is then read
 *   t  the same of a trajectory
 * A change is four bytes: position (three, modulo the length) and what is xor-ed there; at most 16 of them, and if
 * their number is odd the file also ends at the last position. HDF5 itself is not the target: changes are few and the
 * files small.
 *
 * What is asserted: a scene that is read is also written and read back with the same fingerprint; a checkpoint that is
 * read is the one that was written.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/scene.h"
#include "io/snapshot.h"
#include "step.h"

int LLVMFuzzerInitialize(int *count, char ***words);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char scene_text[] = "box: [4, 4, 4]\ntime_step: 0.01\nsteps: 2\nseed: 1\nsolvent: {per_cell: 2, "
                                 "collision_interval: 0.02}\nfibers:\n  - {name: a, count: 2, vertices: 4, mass: 5, "
                                 "bond_length: 0.5, spring: 100, bending: 4}\n";

/* A valid file in memory, and where it is put, changed, to be read. */
struct victim {
  uint8_t *data;
  size_t size;
  char path[64];
};

static struct {
  struct scene scene;
  struct state state;
  struct victim checkpoint, trajectory;
  uint64_t hash;
} all;

static void require(bool what, const char *name)
{
  if (what)
    return;
  fprintf(stderr, "fuzz_readers: %s\n", name);
  abort();
}

static void take_file(struct victim *victim)
{
  FILE *file = fopen(victim->path, "rb");
  require(file != NULL, "fopen");
  victim->data = malloc(1 << 20);
  victim->size = fread(victim->data, 1, 1 << 20, file);
  fclose(file);
}

static void make_files(void)
{
  struct message message;
  const struct model *model = &all.scene.model;
  struct checkpoint_head head = {.fingerprint = all.scene.fingerprint, .seed = 1, .version = "fuzz"};
  const struct trajectory_options options = {.solvent = true, .velocities = true, .seed = 1};
  require(checkpoint_write(all.checkpoint.path, &head, model, &all.state, NULL, 0, scene_text, &message), message.text);
  remove(all.trajectory.path); /* of a process that crashed, and had this number */
  struct trajectory *t = trajectory_open(all.trajectory.path, model, &options, false, 0, scene_text, &message);
  require(t && trajectory_append(t, model, &all.state, &message) && trajectory_close(t, &message), message.text);
  take_file(&all.checkpoint);
  take_file(&all.trajectory);
}

static void end(void)
{
  remove(all.checkpoint.path);
  remove(all.trajectory.path);
  free(all.checkpoint.data);
  free(all.trajectory.data);
  state_free(&all.state);
  scene_free(&all.scene);
  memset(&all, 0, sizeof all);
}

int LLVMFuzzerInitialize(int *count, char ***words)
{
  (void)count, (void)words;
  struct message message;
  struct work work;
  require(scene_read_text("seed", scene_text, strlen(scene_text), &all.scene, &message), message.text);
  require(state_alloc(&all.state, &all.scene.model) && work_alloc(&work, &all.scene.model), "memory");
  require(step_start(&all.state, &all.scene.model, &work), "start");
  work_free(&work);
  all.hash = state_hash(&all.state);
  const char *folder = getenv("TMPDIR") ? getenv("TMPDIR") : ".";
  snprintf(all.checkpoint.path, sizeof all.checkpoint.path, "%.40s/uncross-fuzz-%d-c.h5", folder, (int)getpid());
  snprintf(all.trajectory.path, sizeof all.trajectory.path, "%.40s/uncross-fuzz-%d-t.h5", folder, (int)getpid());
  make_files();
  atexit(end);
  return 0;
}

/* The scene as it is written out, to be freed. */
static char *written(const struct scene *scene, size_t *size)
{
  char *text = NULL;
  FILE *stream = open_memstream(&text, size);
  scene_write(scene, stream, false);
  fclose(stream);
  return text;
}

static void read_scene(const uint8_t *data, size_t size)
{
  struct scene scene, again;
  struct message message = {""};
  if (!scene_read_text("fuzz.yaml", (const char *)data, size, &scene, &message)) {
    require(message.text[0] != '\0', "a scene was refused without a word");
    return;
  }
  size_t length;
  char *text = written(&scene, &length);
  require(scene_read_text("again.yaml", text, length, &again, &message), message.text);
  require(again.fingerprint == scene.fingerprint, "written and read back, a scene has another fingerprint");
  free(text);
  scene_free(&again);
  scene_free(&scene);
}

/* Puts the changed file where it is read. */
static void damage(const struct victim *victim, const uint8_t *data, size_t size)
{
  uint8_t *copy = malloc(victim->size);
  size_t changes = size / 4 < 16 ? size / 4 : 16, end = victim->size;
  memcpy(copy, victim->data, victim->size);
  for (size_t k = 0; k < changes; k++) {
    const uint8_t *c = data + 4 * k;
    size_t at = ((size_t)c[0] << 16 | (size_t)c[1] << 8 | c[2]) % victim->size;
    copy[at] ^= c[3];
    end = changes % 2 ? at : victim->size;
  }
  FILE *file = fopen(victim->path, "wb");
  require(file && fwrite(copy, 1, end, file) == end, "fwrite");
  fclose(file);
  free(copy);
}

static void read_checkpoint(void)
{
  struct checkpoint_head head;
  struct message message = {""};
  if (checkpoint_read(all.checkpoint.path, &all.scene.model, &head, &all.state, NULL, 0, &message))
    require(state_hash(&all.state) == all.hash, "a changed checkpoint was taken for good");
  else
    require(message.text[0] != '\0', "a checkpoint was refused without a word");
}

static void read_trajectory(void)
{
  struct message message = {""};
  struct trajectory *t = trajectory_open_read(all.trajectory.path, &message);
  if (!t) {
    require(message.text[0] != '\0', "a trajectory was refused without a word");
    return;
  }
  free(trajectory_scene_text(t));
  if (trajectory_frames(t) > 0)
    trajectory_read(t, &all.scene.model, 0, &all.state, &message);
  trajectory_close(t, &message);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  if (size == 0)
    return 0;
  if (data[0] == 's') {
    read_scene(data + 1, size - 1);
  } else if (data[0] == 'c') {
    damage(&all.checkpoint, data + 1, size - 1);
    read_checkpoint();
  } else if (data[0] == 't') {
    damage(&all.trajectory, data + 1, size - 1);
    read_trajectory();
  }
  return 0;
}

/*
 * libFuzzer over what reads files: `make fuzz SECONDS=60`. The first byte of an input chooses the reader:
 *   s      the rest is a scene, as text
 *   o      the rest is a pack, as text: it is compared with a whole one, dumped, and answered
 *   k, j   the rest is a table, or run.json: it is verified and described
 *   c, t   the rest are changes of a valid checkpoint or trajectory, which is then read as a resume and `analyze` do
 *   e, f   the same of a checkpoint or trajectory, which is exported and verified
 *   p      the same of a pack, which is compared with the whole one, dumped, and answered
 *   C, E   as c, e, with all checksums of the file's structure made anew, and P as p with its seal, so that what is
 *          behind them is reached
 *   K      the rest are changes of a run's numbers, of which a checkpoint is written: it is resumed
 *   h      the rest are changes of a trajectory without checksums, as other programs write them: a run starts from it
 *   H      the same, but each change gives a number of the frame another value (number_of)
 *   q      as h, of a pack: it is compared with ours, dumped, and answered
 *   r      the rest is a port's trace, as text: it is compared with ours
 *   R      the rest are changes of our trace, which is then compared with ours
 * Another first byte stands for one of these.
 * FUZZ_READERS=soj in the environment: these readers only. A change is four bytes: position (three, modulo the length)
 * and what is xor-ed there; at most 16 of them, and if their number is odd the file also ends at the last position.
 * HDF5 itself is not the target: it runs in a process of its own, which may die, but not of our own code.
 *
 * What is asserted: a scene that is read is also written and read back with the same fingerprint; what is read of a
 * changed checkpoint, or of a changed trajectory or pack with its checksums, is what was written; a state that a run
 * starts from is sound, and can be stepped on; a trace is the same as ours only if its hashes are; nothing is refused
 * without a word.
 */
#include "files/frames.h"
#include "files/verify.h"
#include "numbers.h"
#include "scene/scene_keys.h"

int LLVMFuzzerInitialize(int *count, char ***words);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Some operators only: of a whole pack the search for what explains a difference takes ten times as long. */
static void keep_some(struct pack *pack)
{
  static const char kept[] =
      " model bin bond_force contact_search impulse kick shift solve stream sum sweep event_drift ";
  char word[PACK_WORD + 2];
  size_t count = 0;
  for (size_t k = 0; k < pack->count; k++) {
    snprintf(word, sizeof word, " %s ", pack->table[k].place.operator_name);
    if (strstr(kept, word))
      pack->table[count++] = pack->table[k];
    else
      free(pack->table[k].value.data);
  }
  pack->count = count;
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
  FILE *out = fopen(all.pack.path, "wb");
  require(out && oracle_emit(&all.scene, &all.whole, &message), "a pack");
  keep_some(&all.whole);
  require(pack_write(&all.whole, out, "pack", &message), "a pack");
  fclose(out);
  oracle_sort(&all.whole);
  take_file(&all.checkpoint);
  take_file(&all.trajectory);
  take_file(&all.pack);
  make_foreign();
  make_port();
  make_trace();
}

static void end(void)
{
  remove(all.checkpoint.path);
  remove(all.trajectory.path);
  remove(all.pack.path);
  remove(all.foreign.path);
  remove(all.port.path);
  remove(all.ours.path);
  remove(all.text);
  free(all.checkpoint.data);
  free(all.trajectory.data);
  free(all.pack.data);
  free(all.foreign.data);
  free(all.port.data);
  free(all.ours.data);
  work_free(&all.work);
  free(all.frame);
  free(all.dump);
  pack_free(&all.whole);
  state_free(&all.state);
  scene_free(&all.scene);
  scene_free(&all.starter);
  memset(&all, 0, sizeof all);
  end_observed();
}

/* Text of a file's frames, a line each, to be freed; NULL with a message if one cannot be read. */
static char *exported(const char *path, struct message *message)
{
  enum h5_trouble trouble;
  struct frames *f = frames_open(path, &trouble, message);
  struct sink sink;
  sink_open(&sink);
  bool ok = f;
  for (uint64_t frame = 0; ok && frame < f->about.frames; frame++) {
    ok = frames_read(f, frame, message) == FRAME_FINE;
    for (size_t k = 0; ok && k < 3 * (size_t)f->about.rows; k++)
      fprintf(sink.stream, "%a %a ", f->picture.position[k], f->picture.velocity ? f->picture.velocity[k] : 0.0);
    fputc('\n', sink.stream);
  }
  frames_close(f);
  char *text = sink_close(&sink);
  if (ok)
    return text;
  free(text);
  return NULL;
}

static char *dumped(const struct pack *pack)
{
  struct sink sink;
  sink_open(&sink);
  pack_dump(pack, false, sink.stream);
  return sink_close(&sink);
}

int LLVMFuzzerInitialize(int *count, char ***words)
{
  (void)count, (void)words;
  struct message message;
  const char *readers = getenv("FUZZ_READERS");
  all.readers = readers && *readers ? readers : "sokjctefpCEPKhHqrR";
  require(scene_read_text("seed", scene_text, strlen(scene_text), &all.scene, &message), message.text);
  require(state_alloc(&all.state, &all.scene.model) && work_alloc(&all.work, &all.scene.model), "memory");
  require(start_state(&all.state, &all.scene.model, &all.work), "start");
  all.hash = state_hash(&all.state);
  const char *folder = getenv("TMPDIR") ? getenv("TMPDIR") : ".";
  snprintf(all.checkpoint.path, sizeof all.checkpoint.path, "%.40s/uncross-fuzz-%d-c.h5", folder, (int)getpid());
  snprintf(all.trajectory.path, sizeof all.trajectory.path, "%.40s/uncross-fuzz-%d-t.h5", folder, (int)getpid());
  snprintf(all.pack.path, sizeof all.pack.path, "%.40s/uncross-fuzz-%d-p.h5", folder, (int)getpid());
  snprintf(all.foreign.path, sizeof all.foreign.path, "%.40s/uncross-fuzz-%d-h.h5", folder, (int)getpid());
  snprintf(all.port.path, sizeof all.port.path, "%.40s/uncross-fuzz-%d-q.h5", folder, (int)getpid());
  snprintf(all.ours.path, sizeof all.ours.path, "%.40s/uncross-fuzz-%d-r.csv", folder, (int)getpid());
  make_files();
  make_observed(folder);
  all.frame = exported(all.trajectory.path, &message);
  all.dump = dumped(&all.whole);
  require(all.frame && all.dump, "a whole file cannot be read");
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

/* As `check` reads it: a scene of 2^31 vertices is right, and takes no memory. */
static bool read_numbers(const char *path, const char *text, size_t size, struct scene *scene, struct message *message)
{
  return scene_read_source(&(struct scene_source){.keys = &scene_keys,
                                                  .path = path,
                                                  .text = text,
                                                  .size = size,
                                                  .missing = MISSING_ABSENT,
                                                  .numbers_only = true,
                                                  .message = message},
                           scene);
}

static void read_scene(const uint8_t *data, size_t size)
{
  struct scene scene, again;
  struct message message = {.text = ""};
  if (!read_numbers("fuzz.yaml", (const char *)data, size, &scene, &message)) {
    require(message.text[0] != '\0', "a scene was refused without a word");
    return;
  }
  size_t length;
  char *text = written(&scene, &length);
  require(read_numbers("again.yaml", text, length, &again, &message), message.text);
  require(again.fingerprint == scene.fingerprint, "written and read back, a scene has another fingerprint");
  free(text);
  scene_free(&again);
  scene_free(&scene);
}

static void read_checkpoint(void)
{
  struct checkpoint_head head;
  struct message message = {.text = ""};
  if (checkpoint_read(all.checkpoint.path, &all.scene.model, &head, &all.state, NULL, 0, &message))
    require(state_hash(&all.state) == all.hash, "a changed checkpoint was taken for good");
  else
    require_reason(&message, "a checkpoint was refused without a word");
}

static void read_trajectory(void)
{
  struct message message = {.text = ""};
  struct trajectory *t = trajectory_open_read(all.trajectory.path, &message);
  if (!t) {
    require_reason(&message, "a trajectory was refused without a word");
    return;
  }
  free(trajectory_scene_text(t));
  if (trajectory_frames(t) > 0 && !trajectory_read(t, &all.scene.model, 0, &all.state, &message))
    require_reason(&message, "a frame was refused without a word");
  trajectory_close(t, &message);
}

static void export_and_verify(const char *path, const char *right)
{
  struct message message = {.text = ""};
  bool other;
  char *text = exported(path, &message);
  if (!text)
    require_reason(&message, "a file was not exported, without a word");
  else
    require(!right || strcmp(text, right) == 0 || !strchr(text, '\n') || strlen(text) == 0,
            "a changed frame was exported");
  struct sink sink;
  sink_open(&sink);
  const enum condition condition = verify_file(path, &other, sink.stream);
  char *said = sink_close(&sink);
  require(other || (strlen(said) > 0 && !strstr(said, "ended early")), "verified without a word");
  require(condition != CONDITION_WHOLE || text, "a file is called whole, and cannot be exported");
  free(said);
  free(text);
}

/* Takes the pack: its tables are sorted. */
static void answer_pack(struct pack *pack)
{
  for (int whole = 0; whole < 2; whole++) {
    struct message message = {.text = ""};
    struct pack answers;
    if (!oracle_answer(pack, whole, &answers, &message))
      require_reason(&message, "a pack was not answered, without a word");
    pack_free(&answers);
  }
}

enum pack_use { WHOLE, TO_COMPARE, TO_DUMP };

static void read_pack(const char *path, enum pack_use use)
{
  struct message message = {.text = ""};
  struct pack pack;
  if (!pack_read(path, &pack, &message)) {
    require_reason(&message, "a pack was refused without a word");
    return;
  }
  const struct oracle_options options = {0};
  struct oracle_summary summary;
  struct sink sink;
  sink_open(&sink);
  if (!oracle_align(&all.whole, &pack, &message) ||
      (use != TO_DUMP && !oracle_compare(&all.whole, &pack, &options, sink.stream, &summary, &message)))
    require_reason(&message, "a pack was not compared, without a word");
  free(sink_close(&sink));
  oracle_sort(&pack);
  char *text = dumped(&pack);
  require(use != WHOLE || strcmp(text, all.dump) == 0, "a changed pack was taken for good");
  free(text);
  answer_pack(&pack);
  pack_free(&pack);
}

/* The text as a file of this ending. */
static void read_text(const uint8_t *data, size_t size, const char *ending)
{
  const char *folder = getenv("TMPDIR") ? getenv("TMPDIR") : ".";
  bool other;
  snprintf(all.text, sizeof all.text, "%.40s/uncross-fuzz-%d%s", folder, (int)getpid(), ending);
  put(all.text, data, size);
  if (strcmp(ending, ".txt") == 0) {
    read_pack(all.text, TO_COMPARE);
  } else {
    struct sink sink;
    sink_open(&sink);
    verify_file(all.text, &other, sink.stream);
    char *said = sink_close(&sink);
    require(strlen(said) > 0, "verified without a word");
    free(said);
  }
  remove(all.text);
}

static char reader_of(uint8_t byte)
{
  const char *found = byte ? strchr(all.readers, byte) : NULL;
  return found ? *found : all.readers[byte % strlen(all.readers)];
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  if (size == 0)
    return 0;
  const uint8_t *rest = data + 1;
  const char reader = reader_of(data[0]);
  size--;
  switch (reader) {
  case 's':
    read_scene(rest, size);
    break;
  case 'o':
    read_text(rest, size, ".txt");
    break;
  case 'k':
    read_text(rest, size, ".csv");
    break;
  case 'j':
    read_text(rest, size, ".json");
    break;
  case 'c':
  case 'C':
    damage(&all.checkpoint, reader == 'C' ? HEADERS_AND_SEAL : NOTHING, rest, size);
    read_checkpoint();
    break;
  case 't':
    damage(&all.trajectory, NOTHING, rest, size);
    read_trajectory();
    break;
  case 'e':
  case 'E':
    damage(&all.checkpoint, reader == 'E' ? HEADERS_AND_SEAL : NOTHING, rest, size);
    export_and_verify(all.checkpoint.path, NULL);
    break;
  case 'f':
    damage(&all.trajectory, NOTHING, rest, size);
    export_and_verify(all.trajectory.path, all.frame);
    break;
  case 'p':
  case 'P':
    damage(&all.pack, reader == 'P' ? SEAL : NOTHING, rest, size);
    read_pack(all.pack.path, WHOLE);
    break;
  case 'K':
    change_numbers(rest, size);
    put_numbers();
    go_on_from_numbers();
    break;
  case 'q':
    damage(&all.port, HEADERS, rest, size);
    read_pack(all.port.path, size % 4 == 0 ? TO_COMPARE : TO_DUMP); /* to compare takes most of the time */
    break;
  case 'h':
    damage(&all.foreign, HEADERS, rest, size);
    start_from_foreign();
    break;
  case 'H':
    damage_numbers(rest, size);
    start_from_foreign();
    break;
  case 'r':
    compare_trace(rest, size);
    break;
  case 'R':
    compare_changed_trace(rest, size);
    break;
  default:
    break;
  }
  return 0;
}

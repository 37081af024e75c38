/* What other programs write and this one reads: trajectories that runs start from, and traces of ports. */
#ifndef UNCROSS_TESTS_FUZZ_FOREIGN_H
#define UNCROSS_TESTS_FUZZ_FOREIGN_H

#include <hdf5.h>
#include <math.h>

#include "files/start.h"
#include "step.h"
#include "system/sound.h"
#include "victims.h"

/* Where three doubles stand in the file, one after another. */
static size_t find_row(const struct victim *victim, const double row[3])
{
  for (size_t at = 0; at + 3 * sizeof *row <= victim->size; at++)
    if (memcmp(victim->data + at, row, 3 * sizeof *row) == 0)
      return at;
  require(false, "a frame's numbers are not in its file");
  return 0;
}

/* Of the first vertex, as frames have them: a0, a0/t0. */
static void find_numbers(void)
{
  const struct point r = all.state.position[0];
  const struct vec3 v = all.state.velocity[0];
  const double position[3] = {(double)r.x * LATTICE_UNIT, (double)r.y * LATTICE_UNIT, (double)r.z * LATTICE_UNIT};
  const double velocity[3] = {v.x, v.y, v.z};
  all.numbers[0] = find_row(&all.foreign, position);
  all.numbers[1] = find_row(&all.foreign, velocity);
  all.rows = all.scene.model.vertices + all.scene.model.solvent.particles;
}

static bool start(struct message *message)
{
  struct stream stream;
  return scene_start(&all.starter, &all.state, &all.work, &stream, message);
}

/* Our trajectory without what only we write, checksums among it. A run starts from it as it is. */
static void make_foreign(void)
{
  struct message message;
  char text[1024];
  const int length = snprintf(text, sizeof text, "%sstart: {snapshot: %s}\n", scene_text, all.foreign.path);
  require(scene_read_text("start", text, (size_t)length, &all.starter, &message), message.text);
  put(all.foreign.path, all.trajectory.data, all.trajectory.size);
  hid_t file = H5Fopen(all.foreign.path, H5F_ACC_RDWR, H5P_DEFAULT);
  require(file >= 0 && H5Ldelete(file, "parameters/uncross", H5P_DEFAULT) >= 0 && H5Fclose(file) >= 0, "HDF5");
  take_file(&all.foreign);
  find_numbers();
  require(start(&message), message.text);
}

/* Our pack without seal and checksums. */
static herr_t forget_checksum(hid_t file, const char *name, const H5O_info_t *info, void *context)
{
  (void)context;
  return info->type == H5O_TYPE_DATASET ? H5Adelete_by_name(file, name, "xxh64", H5P_DEFAULT) : 0;
}

static void make_port(void)
{
  put(all.port.path, all.pack.data, all.pack.size - SEAL_BYTES);
  hid_t file = H5Fopen(all.port.path, H5F_ACC_RDWR, H5P_DEFAULT);
  require(file >= 0 && H5Adelete(file, "seal") >= 0 &&
              H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, forget_checksum, NULL) >= 0 && H5Fclose(file) >= 0,
          "HDF5");
  take_file(&all.port);
}

static void make_trace(void)
{
  struct message message;
  bool stopped;
  FILE *out = fopen(all.ours.path, "wb");
  require(out && oracle_trace(&all.scene, 0, out, &stopped, &message), "a trace");
  fclose(out);
  take_file(&all.ours);
}

/* Numbers that no frame should have, and such as are only just right. */
static double number_of(uint8_t kind, double was)
{
  const double edge = 4.0;
  const double some[] = {NAN,    INFINITY, -INFINITY, -0.0,   0.0,       edge,      -edge,        0.5 * edge,
                         1e-300, 1e300,    -1e-17,    8192.0, 2097152.0, 2097151.9, edge - 1e-13, 0x1p-1074};
  return kind < 16   ? some[kind]
         : kind < 80 ? was + ldexp(kind % 2 ? 1.0 : -1.0, kind - 64)
                     : was * (kind - 160.0) / 16.0;
}

/* A change: which array and row (two bytes), component, kind of number. */
static void damage_numbers(const uint8_t *data, size_t size)
{
  uint8_t *copy = malloc(all.foreign.size);
  memcpy(copy, all.foreign.data, all.foreign.size);
  for (size_t k = 0; k + 4 <= size && k < 64; k += 4) {
    const size_t row = ((size_t)(data[k] & 127) << 8 | data[k + 1]) % all.rows;
    uint8_t *at = copy + all.numbers[data[k] >> 7] + (3 * row + data[k + 2] % 3) * sizeof(double);
    double number;
    memcpy(&number, at, sizeof number);
    number = number_of(data[k + 3], number);
    memcpy(at, &number, sizeof number);
  }
  put(all.foreign.path, copy, all.foreign.size);
  free(copy);
}

static void start_from_foreign(void)
{
  struct message message = {.text = ""};
  struct fault *fault = &all.work.fault;
  if (start(&message)) {
    require(state_sound(&all.state, &all.starter.model, fault), "a run starts from a state that is not sound");
    if (!step_advance(&all.state, &all.starter.model, &all.work, NULL))
      require(fault->code != FAULT_NONE, "a step failed without a word");
  } else {
    require_reason(&message, "a start was refused without a word");
  }
  *fault = (struct fault){.code = FAULT_NONE};
}

static void compare_trace(const uint8_t *data, size_t size)
{
  struct message message = {.text = ""};
  struct oracle_summary summary = {0};
  struct sink sink;
  const bool same = size == all.ours.size && memcmp(data, all.ours.data, size) == 0;
  const char *folder = getenv("TMPDIR") ? getenv("TMPDIR") : ".";
  snprintf(all.text, sizeof all.text, "%.40s/uncross-fuzz-%d.csv", folder, (int)getpid());
  put(all.text, data, size);
  sink_open(&sink);
  if (!oracle_compare_traces(all.ours.path, all.text, sink.stream, &summary, &message))
    require(message.text[0] != '\0' && !same, "a trace was not compared, without a word");
  else
    require(!same || summary.verdict == ORACLE_SAME, "our own trace differs");
  free(sink_close(&sink));
  remove(all.text);
}

static void compare_changed_trace(const uint8_t *data, size_t size)
{
  size_t length;
  uint8_t *copy = changed(&all.ours, NOTHING, data, size, &length);
  compare_trace(copy, length);
  free(copy);
}

#endif

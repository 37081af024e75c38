/* What the tests of files share: a folder of their own, whole files in memory, runs to be stored. */
#ifndef UNCROSS_TESTS_FILES_H
#define UNCROSS_TESTS_FILES_H

#include "support.h"

#include <dirent.h>
#include <hdf5.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/message.h"
#include "files/folder.h"
#include "files/snapshot.h"

/* A folder that is not open, in memory of the enclosing block. */
#define by_name(path) (&(struct folder){(path), FOLDER_BY_NAME})

/* A new empty folder; its name goes to `folder`. */
static inline void make_folder(char folder[64])
{
  snprintf(folder, 64, "/tmp/uncross-test-XXXXXX");
  assert_non_null(mkdtemp(folder));
}

static inline void remove_folder(const char *folder)
{
  DIR *dir = opendir(folder);
  assert_non_null(dir);
  for (struct dirent *entry = readdir(dir); entry; entry = readdir(dir)) {
    char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    if (entry->d_name[0] != '.')
      remove(path);
  }
  closedir(dir);
  assert_int_equal(rmdir(folder), 0);
}

/* folder/name, in memory of the enclosing block. */
#define in_folder(folder, name) in_folder_(folder, name, (char[128]){""})
static inline const char *in_folder_(const char *folder, const char *name, char *path)
{
  snprintf(path, 128, "%s/%s", folder, name);
  return path;
}

static inline bool is_there(const char *path)
{
  struct stat status;
  return stat(path, &status) == 0;
}

/* A whole file, with a NUL behind it; to be freed. */
static inline char *slurp(const char *path, size_t *bytes)
{
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  fseek(file, 0, SEEK_END);
  *bytes = (size_t)ftell(file);
  rewind(file);
  char *data = malloc(*bytes + 1);
  assert_int_equal(fread(data, 1, *bytes, file), *bytes);
  data[*bytes] = '\0';
  fclose(file);
  return data;
}

static inline void spill(const char *path, const char *data, size_t bytes)
{
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(data, 1, bytes, file), bytes);
  assert_int_equal(fclose(file), 0);
}

/* A disk that is full after so many bytes of any one file: writes beyond fail with EFBIG. RLIM_INFINITY ends it. */
static inline void limit_files(rlim_t bytes)
{
  signal(SIGXFSZ, SIG_IGN);
  struct rlimit limit = {0};
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
  limit.rlim_cur = bytes;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

/* Fibers and rings in a solvent that lags behind: 41 steps with a collision every second one. */
static inline struct test_run small_run(uint64_t steps)
{
  struct model m = test_model(6, 5, 7, 5, 0.01, 2);
  test_add_kind(&m, 5, 8);
  struct fiber_kind *ring = test_add_kind(&m, 3, 6);
  ring->ring = true;
  ring->start = START_CIRCLE;
  ring->bending = 0.0;
  m.solvent.acceleration = (struct vec3){0.01, -0.02, 0.03};
  struct test_run r = test_start(m);
  test_steps(&r, steps);
  return r;
}

/* snapshot_read_start, whoever made the file. */
static inline bool read_start(const char *path, const struct model *model, struct state *state, struct message *message)
{
  struct snapshot_origin origin;
  return snapshot_read_start(path, model, state, &origin, message);
}

/* No HDF5 object may be left open. */
static inline void assert_all_closed(void)
{
  assert_int_equal(H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
}

#endif

#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "faults/inject.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <xxhash.h>
#include <yaml.h>

static const char *const kind_names[INJECT_KINDS] = {"memory", "file", "hdf5", "signal"};

struct plan {
  uint64_t calls[INJECT_KINDS];
  enum inject_kind kind;
  uint64_t n; /* 0: none fails */
  bool on, hit;
};

static struct plan *plan; /* shared with the processes that read files (files/reader.h) */
static FILE *bad;         /* the file that has an error */
static bool held;         /* of this process alone */

void inject_arm(enum inject_kind kind, uint64_t n, bool on)
{
  bad = NULL;
  *plan = (struct plan){.kind = kind, .n = n, .on = on};
}

bool inject_disarm(void)
{
  plan->n = 0;
  return plan->hit;
}

void inject_hold(bool wanted)
{
  held = wanted;
}

/* Whether this call is to fail. */
static bool fails(enum inject_kind kind)
{
  if (!plan || held)
    return false;
  uint64_t call = ++plan->calls[kind];
  if (kind != plan->kind || plan->n == 0 || call < plan->n || (call > plan->n && !plan->on))
    return false;
  plan->hit = true;
  static const int number[INJECT_KINDS] = {ENOMEM, ENOSPC, ENOSPC, EINTR};
  errno = number[kind];
  return true;
}

#define PLAN "UNCROSS_FAULT_PLAN" /* the file that a parent shares with its readers */

/* The plan of the process that started this one as its reader, or a new one. */
static bool share_plan(void)
{
  char name[] = "/dev/shm/uncross-faults-XXXXXX", path[64];
  const char *parents = getenv(PLAN);
  int fd = parents ? open(parents, O_RDWR | O_CLOEXEC) : -1;
  const bool known = fd >= 0;
  if (!known && (fd = mkstemp(name)) < 0)
    abort();
  if (!known && (unlink(name) != 0 || ftruncate(fd, sizeof *plan) != 0))
    abort();
  void *shared = mmap(NULL, sizeof *plan, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (shared == MAP_FAILED)
    abort();
  plan = shared;
  if (known) {
    close(fd);
    return true;
  }
  /* It stays open, in an outer program too (src/cli/outer.c): readers open it by its name in /proc. */
  snprintf(path, sizeof path, "/proc/%d/fd/%d", (int)getpid(), fd);
  setenv(PLAN, path, 1);
  return false;
}

/* Before the constructor of tests/reader.c, which may not return. */
__attribute__((constructor(101))) static void begin(void)
{
  if (share_plan())
    return;
  const char *wish = getenv("UNCROSS_FAIL");
  for (int kind = 0; wish && kind < INJECT_KINDS; kind++) {
    size_t length = strlen(kind_names[kind]);
    if (strncmp(wish, kind_names[kind], length) == 0 && wish[length] == ':')
      inject_arm((enum inject_kind)kind, strtoull(wish + length + 1, NULL, 10), strchr(wish, '+') != NULL);
  }
}

FILE *__real_fopen(const char *path, const char *mode);
int __real_fclose(FILE *file);

__attribute__((destructor)) static void end(void)
{
  plan->n = 0;
  const char *path = getenv("UNCROSS_CALLS");
  FILE *file = path ? __real_fopen(path, "w") : NULL;
  if (!file)
    return;
  for (int kind = 0; kind < INJECT_KINDS; kind++)
    fprintf(file, "%s %" PRIu64 "\n", kind_names[kind], plan->calls[kind]);
  __real_fclose(file);
}

/* A wrapper that fails before the real function is called, and one that fails after it (nothing stays open). */
#define INSTEAD(kind, type, failure, name, parameters, arguments)                                                      \
  type __real_##name parameters;                                                                                       \
  type __wrap_##name parameters;                                                                                       \
  type __wrap_##name parameters                                                                                        \
  {                                                                                                                    \
    return fails(kind) ? (failure) : __real_##name arguments;                                                          \
  }
#define AFTER(kind, type, failure, name, parameters, arguments)                                                        \
  type __real_##name parameters;                                                                                       \
  type __wrap_##name parameters;                                                                                       \
  type __wrap_##name parameters                                                                                        \
  {                                                                                                                    \
    type result = __real_##name arguments;                                                                             \
    return fails(kind) ? (failure) : result;                                                                           \
  }

/* --- memory ------------------------------------------------------------------------------------------------------ */

INSTEAD(INJECT_MEMORY, void *, NULL, malloc, (size_t n), (n))
INSTEAD(INJECT_MEMORY, void *, NULL, calloc, (size_t n, size_t size), (n, size))
INSTEAD(INJECT_MEMORY, void *, NULL, realloc, (void *p, size_t n), (p, n))
INSTEAD(INJECT_MEMORY, void *, NULL, aligned_alloc, (size_t edge, size_t n), (edge, n))
INSTEAD(INJECT_MEMORY, char *, NULL, strdup, (const char *text), (text))
INSTEAD(INJECT_MEMORY, char *, NULL, strndup, (const char *text, size_t n), (text, n))
INSTEAD(INJECT_MEMORY, ssize_t, -1, getline, (char **line, size_t *n, FILE *f), (line, n, f))
INSTEAD(INJECT_MEMORY, FILE *, NULL, open_memstream, (char **text, size_t *n), (text, n))
INSTEAD(INJECT_MEMORY, XXH64_state_t *, NULL, XXH64_createState, (void), ())
INSTEAD(INJECT_MEMORY, int, 0, yaml_parser_initialize, (yaml_parser_t * parser), (parser))
INSTEAD(INJECT_MEMORY, char *, NULL, json_dumps, (const json_t *json, size_t flags), (json, flags))

json_t *__wrap_json_pack(const char *format, ...);
json_t *__wrap_json_pack(const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  json_t *json = json_vpack_ex(NULL, 0, format, arguments);
  va_end(arguments);
  if (!fails(INJECT_MEMORY))
    return json;
  json_decref(json);
  return NULL;
}

/* --- files ------------------------------------------------------------------------------------------------------- */

INSTEAD(INJECT_FILE, FILE *, NULL, fopen, (const char *path, const char *mode), (path, mode))
INSTEAD(INJECT_FILE, FILE *, NULL, fdopen, (int fd, const char *mode), (fd, mode))
INSTEAD(INJECT_FILE, int, -1, renameat, (int fd, const char *from, int there, const char *to), (fd, from, there, to))
INSTEAD(INJECT_FILE, int, -1, fstatat, (int fd, const char *name, struct stat *status, int how),
        (fd, name, status, how))
INSTEAD(INJECT_FILE, int, -1, mkdir, (const char *path, mode_t mode), (path, mode))
INSTEAD(INJECT_FILE, int, -1, stat, (const char *path, struct stat *status), (path, status))
INSTEAD(INJECT_FILE, int, -1, fstat, (int fd, struct stat *status), (fd, status))
INSTEAD(INJECT_FILE, int, -1, ftruncate, (int fd, off_t n), (fd, n))
INSTEAD(INJECT_FILE, int, -1, fseek, (FILE * f, long n, int from), (f, n, from))
AFTER(INJECT_FILE, int, EOF, fflush, (FILE * f), (f))
AFTER(INJECT_FILE, int, -1, close, (int fd), (fd))

/* Those that a signal may interrupt. */
ssize_t __real_write(int fd, const void *data, size_t n);
ssize_t __wrap_write(int fd, const void *data, size_t n);
ssize_t __wrap_write(int fd, const void *data, size_t n)
{
  return fails(INJECT_SIGNAL) || fails(INJECT_FILE) ? -1 : __real_write(fd, data, n);
}

int __real_posix_fallocate(int fd, off_t at, off_t n);
int __wrap_posix_fallocate(int fd, off_t at, off_t n);
int __wrap_posix_fallocate(int fd, off_t at, off_t n)
{
  return fails(INJECT_SIGNAL) || fails(INJECT_FILE) ? errno : __real_posix_fallocate(fd, at, n);
}

/* A disk that does not answer, whatever signals come. */
int __real_fsync(int fd);
int __wrap_fsync(int fd);
int __wrap_fsync(int fd)
{
  const char *slow = getenv("UNCROSS_SLOW");
  struct timespec left = {slow ? atoi(slow) : 0, 0};
  while (nanosleep(&left, &left) != 0)
    ;
  return fails(INJECT_FILE) ? -1 : __real_fsync(fd);
}

int __real_clock_gettime(clockid_t clock, struct timespec *t);
int __wrap_clock_gettime(clockid_t clock, struct timespec *t);
int __wrap_clock_gettime(clockid_t clock, struct timespec *t)
{
  const char *haste = getenv("UNCROSS_HASTE");
  const int result = __real_clock_gettime(clock, t);
  t->tv_sec *= haste ? atoi(haste) : 1;
  t->tv_nsec *= haste ? atoi(haste) : 1; /* more than a second: nobody minds */
  return result;
}

/* A file with an error keeps it until it is closed. */
int __real_ferror(FILE *f);
int __wrap_ferror(FILE *f);
int __wrap_ferror(FILE *f)
{
  if (f != bad && fails(INJECT_FILE))
    bad = f;
  return f == bad || __real_ferror(f);
}

int __wrap_fclose(FILE *f);
int __wrap_fclose(FILE *f)
{
  if (f == bad)
    bad = NULL;
  int result = __real_fclose(f);
  return fails(INJECT_FILE) ? EOF : result;
}

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  return fails(INJECT_FILE) ? -1 : __real_open(path, flags, mode);
}

int __real_openat(int folder, const char *path, int flags, ...);
int __wrap_openat(int folder, const char *path, int flags, ...);
int __wrap_openat(int folder, const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  return fails(INJECT_FILE) ? -1 : __real_openat(folder, path, flags, mode);
}

/* What glibc calls in their places where a program is hardened and the flags are no constants. */
int __wrap___open_2(const char *path, int flags);
int __wrap___open_2(const char *path, int flags)
{
  return __wrap_open(path, flags);
}

int __wrap___openat_2(int folder, const char *path, int flags);
int __wrap___openat_2(int folder, const char *path, int flags)
{
  return __wrap_openat(folder, path, flags);
}

/* --- HDF5 -------------------------------------------------------------------------------------------------------- */

#define HDF5(type, name, parameters, arguments) INSTEAD(INJECT_HDF5, type, -1, name, parameters, arguments)
#define HDF5_CLOSE(name) AFTER(INJECT_HDF5, herr_t, -1, name, (hid_t h), (h))

HDF5(hid_t, H5Fopen, (const char *path, unsigned flags, hid_t access), (path, flags, access))
HDF5(hid_t, H5Fcreate, (const char *path, unsigned flags, hid_t how, hid_t access), (path, flags, how, access))
HDF5(htri_t, H5Fis_hdf5, (const char *path), (path))
HDF5(herr_t, H5Fflush, (hid_t h, H5F_scope_t scope), (h, scope))
HDF5(herr_t, H5Fget_filesize, (hid_t h, hsize_t *size), (h, size))
HDF5(herr_t, H5Fget_vfd_handle, (hid_t h, hid_t access, void **handle), (h, access, handle))
HDF5(ssize_t, H5Fget_file_image, (hid_t h, void *data, size_t n), (h, data, n))
HDF5(hid_t, H5Gcreate2, (hid_t h, const char *name, hid_t l, hid_t c, hid_t a), (h, name, l, c, a))
HDF5(hid_t, H5Gopen2, (hid_t h, const char *name, hid_t a), (h, name, a))
HDF5(hid_t, H5Dcreate2, (hid_t h, const char *name, hid_t t, hid_t s, hid_t l, hid_t c, hid_t a),
     (h, name, t, s, l, c, a))
HDF5(hid_t, H5Dopen2, (hid_t h, const char *name, hid_t a), (h, name, a))
HDF5(herr_t, H5Dread, (hid_t h, hid_t t, hid_t m, hid_t f, hid_t p, void *data), (h, t, m, f, p, data))
HDF5(herr_t, H5Dwrite, (hid_t h, hid_t t, hid_t m, hid_t f, hid_t p, const void *data), (h, t, m, f, p, data))
HDF5(herr_t, H5Dset_extent, (hid_t h, const hsize_t *dims), (h, dims))
HDF5(hid_t, H5Dget_space, (hid_t h), (h))
HDF5(hid_t, H5Dget_type, (hid_t h), (h))
HDF5(hid_t, H5Acreate2, (hid_t h, const char *name, hid_t t, hid_t s, hid_t c, hid_t a), (h, name, t, s, c, a))
HDF5(hid_t, H5Aopen, (hid_t h, const char *name, hid_t a), (h, name, a))
HDF5(htri_t, H5Aexists, (hid_t h, const char *name), (h, name))
HDF5(herr_t, H5Aread, (hid_t h, hid_t t, void *data), (h, t, data))
HDF5(herr_t, H5Awrite, (hid_t h, hid_t t, const void *data), (h, t, data))
HDF5(hid_t, H5Aget_space, (hid_t h), (h))
HDF5(hid_t, H5Aget_type, (hid_t h), (h))
HDF5(htri_t, H5Lexists, (hid_t h, const char *name, hid_t a), (h, name, a))
HDF5(hid_t, H5Oopen, (hid_t h, const char *name, hid_t a), (h, name, a))
HDF5(hid_t, H5Screate_simple, (int rank, const hsize_t *dims, const hsize_t *most), (rank, dims, most))
HDF5(int, H5Sget_simple_extent_ndims, (hid_t h), (h))
HDF5(int, H5Sget_simple_extent_dims, (hid_t h, hsize_t *dims, hsize_t *most), (h, dims, most))
HDF5(hssize_t, H5Sget_simple_extent_npoints, (hid_t h), (h))
HDF5(herr_t, H5Sselect_hyperslab,
     (hid_t h, H5S_seloper_t o, const hsize_t *s, const hsize_t *d, const hsize_t *n, const hsize_t *b),
     (h, o, s, d, n, b))
HDF5(herr_t, H5Rcreate, (void *reference, hid_t h, const char *name, H5R_type_t type, hid_t s),
     (reference, h, name, type, s))
HDF5(hid_t, H5Tcopy, (hid_t h), (h))
HDF5(hid_t, H5Tget_super, (hid_t h), (h))
HDF5(herr_t, H5Tget_member_value, (hid_t h, unsigned k, void *value), (h, k, value))
HDF5_CLOSE(H5Fclose)
HDF5_CLOSE(H5Oclose)
HDF5_CLOSE(H5Sclose)
HDF5_CLOSE(H5Pclose)
HDF5_CLOSE(H5Tclose)
HDF5_CLOSE(H5Aclose)

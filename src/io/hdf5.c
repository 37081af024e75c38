#include "io/hdf5.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#define HASH_NAME "xxh64"

/* --- errors ------------------------------------------------------------------------------------------------------ */

struct reason {
  char *text;
  size_t size;
};

static herr_t take_innermost(unsigned n, const H5E_error2_t *error, void *context)
{
  const struct reason *reason = context;
  if (n > 0 || !error->desc)
    return 0;
  /* Of a failed read or write HDF5 tells the time of day and all arguments; the system's own words are enough. */
  const char *rest = strstr(error->desc, ": time = "), *quoted = rest ? strstr(rest, "error message = '") : NULL;
  if (quoted)
    quoted += strlen("error message = '");
  if (quoted)
    snprintf(reason->text, reason->size, "%.*s: %.*s", (int)(rest - error->desc), error->desc,
             (int)strcspn(quoted, "'"), quoted);
  else
    snprintf(reason->text, reason->size, "%s", error->desc);
  return 0;
}

void h5_reason(char *text, size_t size)
{
  snprintf(text, size, "unknown HDF5 error");
  struct reason reason = {text, size};
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_innermost, &reason);
  H5Eclear2(H5E_DEFAULT);
}

int h5_fail(struct message *message, const char *path, const char *doing)
{
  char reason[256];
  h5_reason(reason, sizeof reason);
  return message_set(message, "%s: %s: %s", path, doing, reason);
}

/* Not at exit either: the library would try once more to close a file that it could not write, and crash (1.10.8). Our
 * files are closed by then. */
static void silence(void)
{
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

/* --- files ------------------------------------------------------------------------------------------------------- */

/* HDF5 locks the files it opens (flock) and would call one in use damaged, so who holds it is asked first. */
static bool readable(const char *path, bool writable, struct message *message)
{
  int fd = open(path, writable ? O_RDWR : O_RDONLY);
  if (fd < 0)
    return message_set(message, "%s: cannot be opened for %s: %s", path, writable ? "writing" : "reading",
                       strerror(errno));
  struct stat status;
  bool regular = fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
  bool in_use = regular && flock(fd, (writable ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(fd);
  if (!regular)
    return message_set(message, "%s: not a file but a folder or a device", path);
  if (in_use)
    return message_set(message, "%s: in use by another process (a run that still writes it?)", path);
  return true;
}

static hid_t new_format(void)
{
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
  return access;
}

hid_t h5_open(const char *path, bool writable, enum h5_trouble *trouble, struct message *message)
{
  silence();
  *trouble = H5_UNREADABLE;
  if (!readable(path, writable, message))
    return -1;
  *trouble = H5_DAMAGED;
  if (H5Fis_hdf5(path) <= 0) {
    H5Eclear2(H5E_DEFAULT);
    message_set(message, "%s: not an HDF5 file, or its beginning is damaged", path);
    return -1;
  }
  hid_t access = new_format();
  hid_t file = H5Fopen(path, writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
  h5_close(access);
  if (file < 0)
    h5_fail(message, path, "damaged HDF5 file");
  else
    *trouble = H5_FINE;
  return file;
}

static hid_t create(const char *path, unsigned how, hid_t access)
{
  silence();
  hid_t creation = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_obj_track_times(creation, false);
  hid_t file = H5Fcreate(path, how, creation, access);
  h5_close(creation);
  h5_close(access);
  return file;
}

hid_t h5_create(const char *path)
{
  hid_t file = create(path, H5F_ACC_EXCL, new_format());
  if (file < 0 && access(path, F_OK) == 0)
    errno = EEXIST; /* HDF5 looks for itself, and leaves no errno */
  return file;
}

hid_t h5_create_in_memory(size_t bytes)
{
  hid_t access = new_format();
  H5Pset_fapl_core(access, bytes + 65536, false);
  return create("memory", H5F_ACC_TRUNC, access);
}

/* H5Fget_file_image says how many bytes are in use (the memory is a multiple of the increment), but its copy is not
 * used: it clears a flag in the superblock, whose checksum is then wrong (HDF5 1.10.8). */
void *h5_image(hid_t file, size_t *bytes)
{
  void **memory = NULL;
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 || H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&memory) < 0 || !memory)
    return NULL;
  ssize_t size = H5Fget_file_image(file, NULL, 0);
  void *image = size > 0 && *memory ? malloc((size_t)size) : NULL;
  if (image) {
    memcpy(image, *memory, (size_t)size);
    *bytes = (size_t)size;
  }
  return image;
}

static bool close_any(hid_t handle)
{
  switch (H5Iget_type(handle)) {
  case H5I_FILE:
    return H5Fclose(handle) >= 0;
  case H5I_GENPROP_LST:
    return H5Pclose(handle) >= 0;
  case H5I_DATASPACE:
    return H5Sclose(handle) >= 0;
  case H5I_DATATYPE:
    return H5Tclose(handle) >= 0;
  case H5I_ATTR:
    return H5Aclose(handle) >= 0;
  default:
    return H5Oclose(handle) >= 0;
  }
}

/* Every call of the library forgets the errors of the one before; those of a failure must outlive the tidying up. */
bool h5_close(hid_t handle)
{
  if (handle < 0)
    return true;
  hid_t errors = H5Eget_current_stack();
  bool ok = close_any(handle);
  if (ok && H5Eget_num(errors) > 0)
    H5Eset_current_stack(errors);
  else
    H5Eclose_stack(errors);
  return ok;
}

/* --- room on the disk -------------------------------------------------------------------------------------------- */

static int descriptor_of(hid_t file)
{
  int *fd = NULL;
  return H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&fd) >= 0 && fd ? *fd : -1;
}

int h5_reserve(hid_t file, size_t bytes)
{
  hsize_t size;
  int fd = descriptor_of(file);
  if (fd < 0 || H5Fget_filesize(file, &size) < 0)
    return EIO;
  int error;
  do
    error = posix_fallocate(fd, (off_t)size, (off_t)bytes);
  while (error == EINTR); /* a signal came, which the run looks at after its step */
  if (error)
    h5_trim(file);
  return error;
}

int h5_sync(hid_t file)
{
  return fsync(descriptor_of(file)) == 0 ? 0 : errno;
}

void h5_trim(hid_t file)
{
  hsize_t size;
  struct stat status;
  int fd = descriptor_of(file);
  if (fd >= 0 && H5Fget_filesize(file, &size) >= 0 && fstat(fd, &status) == 0 && (hsize_t)status.st_size > size &&
      ftruncate(fd, (off_t)size) != 0)
    return; /* a longer file is sound too */
}

/* --- objects ----------------------------------------------------------------------------------------------------- */

hid_t h5_group(hid_t parent, const char *name)
{
  hid_t creation = H5Pcreate(H5P_GROUP_CREATE);
  H5Pset_obj_track_times(creation, false);
  hid_t group = H5Gcreate2(parent, name, H5P_DEFAULT, creation, H5P_DEFAULT);
  h5_close(creation);
  return group;
}

hid_t h5_open_group(hid_t parent, const char *name)
{
  return parent >= 0 && h5_has(parent, name) ? H5Gopen2(parent, name, H5P_DEFAULT) : -1;
}

static hid_t little_endian(hid_t type)
{
  hid_t copy = H5Tcopy(type);
  H5T_class_t class = H5Tget_class(type);
  if (class == H5T_INTEGER || class == H5T_FLOAT)
    H5Tset_order(copy, H5T_ORDER_LE);
  return copy;
}

hid_t h5_dataset(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *dims, bool grows, hsize_t chunk)
{
  hsize_t most[4], chunks[4];
  for (int k = 0; k < rank; k++)
    most[k] = chunks[k] = dims[k];
  hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(creation, false);
  if (grows) {
    /* Fill values, so that the unused rows of a last chunk are zeros and not whatever was in memory. */
    H5Pset_fill_time(creation, H5D_FILL_TIME_ALLOC);
    most[0] = H5S_UNLIMITED;
    chunks[0] = chunk;
    H5Pset_chunk(creation, rank, chunks);
  }
  hid_t space = rank > 0 ? H5Screate_simple(rank, dims, most) : H5Screate(H5S_SCALAR);
  hid_t stored = little_endian(type);
  hid_t dataset = H5Dcreate2(parent, name, stored, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  h5_close(stored);
  h5_close(space);
  h5_close(creation);
  return dataset;
}

int h5_shape(hid_t dataset, int most, hsize_t *dims)
{
  if (dataset < 0)
    return -1;
  hid_t space = H5Dget_space(dataset);
  int rank = space < 0 ? -1 : H5Sget_simple_extent_ndims(space);
  bool readable = rank >= 0 && (rank > most || rank == 0 || H5Sget_simple_extent_dims(space, dims, NULL) >= 0);
  h5_close(space);
  return !readable ? -2 : rank > most ? -1 : rank;
}

int h5_look(hid_t parent, const char *name)
{
  if (H5Iget_type(parent) == H5I_DATASET)
    return 0;
  int found = H5Lexists(parent, name, H5P_DEFAULT);
  return found > 0 ? H5Oexists_by_name(parent, name, H5P_DEFAULT) : found;
}

bool h5_has(hid_t parent, const char *name)
{
  bool has = h5_look(parent, name) > 0;
  H5Eclear2(H5E_DEFAULT);
  return has;
}

/* --- attributes -------------------------------------------------------------------------------------------------- */

bool h5_put(hid_t object, const char *name, hid_t type, size_t count, const void *data)
{
  hsize_t dims[1] = {count};
  hid_t space = count ? H5Screate_simple(1, dims, NULL) : H5Screate(H5S_SCALAR);
  hid_t stored = little_endian(type);
  hid_t attribute = H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT);
  bool ok = attribute >= 0 && H5Awrite(attribute, type, data) >= 0;
  h5_close(attribute);
  h5_close(stored);
  h5_close(space);
  return ok;
}

bool h5_get(hid_t object, const char *name, hid_t type, size_t count, void *data)
{
  hid_t attribute = H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
  hid_t space = attribute < 0 ? -1 : H5Aget_space(attribute);
  bool ok = space >= 0 && H5Sget_simple_extent_npoints(space) == (hssize_t)(count ? count : 1) &&
            H5Aread(attribute, type, data) >= 0;
  h5_close(space);
  h5_close(attribute);
  return ok;
}

static hid_t text_type(size_t length)
{
  hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, length + 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

bool h5_put_text(hid_t object, const char *name, const char *text)
{
  hid_t type = text_type(strlen(text));
  bool ok = h5_put(object, name, type, 0, text);
  h5_close(type);
  return ok;
}

/* Texts written by others may be of variable length, which HDF5 does not convert to ours. */
static bool get_variable_text(hid_t attribute, hid_t stored, char *text, size_t size)
{
  char *value = NULL;
  hid_t type = H5Tcopy(stored);
  bool ok = H5Aread(attribute, type, &value) >= 0 && value && strlen(value) < size;
  if (ok)
    snprintf(text, size, "%s", value);
  H5free_memory(value);
  h5_close(type);
  return ok;
}

bool h5_get_text(hid_t object, const char *name, char *text, size_t size)
{
  hid_t attribute = H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
  hid_t stored = attribute < 0 ? -1 : H5Aget_type(attribute);
  hid_t space = attribute < 0 ? -1 : H5Aget_space(attribute);
  bool ok = stored >= 0 && H5Tget_class(stored) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1;
  if (ok && H5Tis_variable_str(stored) > 0) {
    ok = get_variable_text(attribute, stored, text, size);
  } else if (ok) {
    ok = H5Tget_size(stored) <= size && H5Aread(attribute, stored, text) >= 0;
    if (ok)
      text[H5Tget_size(stored) < size ? H5Tget_size(stored) : size - 1] = '\0';
  }
  h5_close(space);
  h5_close(stored);
  h5_close(attribute);
  return ok;
}

/* --- whole datasets ---------------------------------------------------------------------------------------------- */

static uint64_t hash_of(hid_t type, int rank, const hsize_t *dims, const void *data)
{
  size_t bytes = H5Tget_size(type);
  for (int k = 0; k < rank; k++)
    bytes *= (size_t)dims[k];
  return XXH64(data, bytes, 0);
}

bool h5_array_write(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *dims, const void *data)
{
  hid_t dataset = h5_dataset(parent, name, type, rank, dims, false, 0);
  uint64_t hash = hash_of(type, rank, dims, data);
  bool ok = dataset >= 0 && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0 &&
            h5_put(dataset, HASH_NAME, H5T_NATIVE_UINT64, 0, &hash);
  h5_close(dataset);
  return ok;
}

static bool same_class(hid_t dataset, hid_t type)
{
  hid_t stored = H5Dget_type(dataset);
  H5T_class_t is = stored < 0 ? H5T_NO_CLASS : H5Tget_class(stored), wanted = H5Tget_class(type);
  h5_close(stored);
  return is == wanted || (wanted == H5T_INTEGER && is == H5T_ENUM);
}

bool h5_array_read(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *dims, void *data)
{
  hsize_t found[4];
  hid_t dataset = H5Dopen2(parent, name, H5P_DEFAULT);
  bool ok = dataset >= 0 && h5_shape(dataset, 4, found) == rank && same_class(dataset, type);
  for (int k = 0; ok && k < rank; k++)
    ok = found[k] == dims[k];
  ok = ok && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
  if (ok && H5Aexists(dataset, HASH_NAME) > 0) {
    uint64_t hash;
    ok = h5_get(dataset, HASH_NAME, H5T_NATIVE_UINT64, 0, &hash) && hash == hash_of(type, rank, dims, data);
  }
  h5_close(dataset);
  return ok;
}

bool h5_text_write(hid_t parent, const char *name, const char *text)
{
  hid_t type = text_type(strlen(text));
  bool ok = h5_array_write(parent, name, type, 0, NULL, text);
  h5_close(type);
  return ok;
}

char *h5_text_read(hid_t parent, const char *name)
{
  hid_t dataset = h5_has(parent, name) ? H5Dopen2(parent, name, H5P_DEFAULT) : -1;
  hid_t stored = dataset < 0 ? -1 : H5Dget_type(dataset);
  char *text = NULL;
  if (stored >= 0 && H5Tget_class(stored) == H5T_STRING && H5Tis_variable_str(stored) == 0) {
    size_t size = H5Tget_size(stored);
    text = calloc(size + 1, 1);
    if (text && !h5_array_read(parent, name, stored, 0, NULL, text)) {
      free(text);
      text = NULL;
    }
  }
  h5_close(stored);
  h5_close(dataset);
  return text;
}

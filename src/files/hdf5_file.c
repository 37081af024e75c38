/* Files of HDF5: opened, made on disk or in memory, given room. */
#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#if H5_VERSION_GE(1, 14, 0)
#include <H5FDdevelop.h>
#endif
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "files/hdf5.h"
#include "files/lock.h"
#include "files/seal.h"

#define H5_MEMORY ((size_t)8 << 20) /* bytes: what HDF5 has beside data, its caches and tables included */
#define MOST_READ ((size_t)1 << 30) /* bytes of a file that are in memory at a time: a frame, not all of them */
#define COPIES 2                    /* of them: HDF5's and ours */

static void silence(void)
{
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

bool h5_has_memory(const char *path, size_t bytes, struct message *message)
{
  return memory_to_spare(bytes + H5_MEMORY) ||
         message_no_memory(message, "%s: no memory (HDF5 is not called with less than %zu MiB to spare)", path,
                           (bytes + H5_MEMORY) >> 20);
}

/* --- files ------------------------------------------------------------------------------------------------------- */

static bool say_in_use(const char *path, struct message *message)
{
  return message_set(message, "%s: in use by another process (a run that still writes it?)", path);
}

/* A run that writes a frame has the file to itself for that moment (trajectory_append). */
static enum lock lock_for(int fd, bool writable)
{
  return lock_wait(fd, writable, writable ? 0.0 : 2.0);
}

/* The file, locked until it is closed; below 0, with a message. A pipe would block. */
static int open_locked(const char *path, bool writable, size_t *bytes, struct message *message)
{
  int fd = open(path, (writable ? O_RDWR : O_RDONLY) | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) {
    message_set(message, "%s: cannot be opened for %s: %s", path, writable ? "writing" : "reading", strerror(errno));
    return -1;
  }
  struct stat status;
  const bool regular = fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
  *bytes = regular ? (size_t)status.st_size : 0;
  if (regular && lock_for(fd, writable) != LOCK_IN_USE)
    return fd;
  close(fd); /* without the lock */
  if (regular)
    say_in_use(path, message);
  else
    message_set(message, "%s: not a file but a folder, a pipe or a device", path);
  return -1;
}

static void leave_and_close(int fd)
{
  lock_leave(fd);
  close(fd);
}

/* HDF5's own locks are off: it takes a file system without locks for a damaged file. lock.h does it. What a list of
 * properties says of locks does not suffice: HDF5_USE_FILE_LOCKING in the surroundings of a host overrides it, and HDF5
 * may have read that long ago. So the list has HDF5's driver of plain files without its functions that lock. A file
 * that the host opens itself, by the whole driver, is then another one to HDF5, though of the same name. */
static bool never_lock(hid_t access)
{
  if (H5Pset_fapl_sec2(access) < 0) /* HDF5_DRIVER names another one for lists that name none */
    return false;
  H5FD_t *any = H5FDopen("/", H5F_ACC_RDONLY, access, HADDR_UNDEF); /* to see what the driver is made of */
  if (!any)
    return false;
  H5FD_class_t driver = *any->cls;
  driver.terminate = NULL; /* of the driver that this is a copy of */
  driver.lock = NULL;
  driver.unlock = NULL;
  const hid_t own = H5FDregister(&driver);
  const bool ok = own >= 0 && H5Pset_driver(access, own, NULL) >= 0;
  if (own >= 0)
    H5FDunregister(own); /* the list, and a file that is opened with it, keep it */
  return H5FDclose(any) >= 0 && ok;
}

static hid_t new_format(void)
{
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
  return access;
}

/* For files on disk; below 0 if that cannot be had. */
static hid_t without_locks(void)
{
  hid_t access = new_format();
  if (access >= 0 && never_lock(access))
    return access;
  h5_close(access);
  return -1;
}

static hid_t open_hdf5(const char *path, bool writable, bool *sealed, enum h5_trouble *trouble, struct message *message)
{
  const enum seal seal = seal_check(path, message);
  *sealed = seal == SEAL_FITS;
  *trouble = seal == SEAL_UNREADABLE ? H5_UNREADABLE : H5_DAMAGED;
  if (seal == SEAL_UNREADABLE || seal == SEAL_BROKEN)
    return -1;
  if (H5Fis_hdf5(path) <= 0) {
    H5Eclear2(H5E_DEFAULT);
    message_set(message, "%s: not an HDF5 file (as checkpoint.h5 and trajectory.h5 are), or its beginning is damaged",
                path);
    return -1;
  }
  hid_t access = without_locks();
  hid_t file = access < 0 ? -1 : H5Fopen(path, writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
  h5_close(access);
  if (file < 0) {
    *trouble = access < 0 ? H5_UNREADABLE : H5_DAMAGED;
    h5_fail(message, path, access < 0 ? "HDF5 cannot be told how to open it" : "damaged HDF5 file");
    return -1;
  }
  if (lock_for(h5_descriptor(file), writable) != LOCK_IN_USE) {
    *trouble = H5_FINE;
    return file;
  }
  *trouble = H5_UNREADABLE;
  say_in_use(path, message);
  h5_close(file);
  return -1;
}

hid_t h5_open(const char *path, bool writable, bool *sealed, enum h5_trouble *trouble, struct message *message)
{
  size_t bytes;
  *trouble = H5_UNREADABLE;
  const int fd = open_locked(path, writable, &bytes, message);
  if (fd < 0)
    return -1;
  if (writable) /* HDF5's descriptor is to have the lock alone; readers share theirs, so that no frame comes in between
                 */
    leave_and_close(fd);
  const size_t read = writable ? 0 : COPIES * (bytes < MOST_READ ? bytes : MOST_READ);
  hid_t file = -1;
  if (h5_has_memory(path, read, message)) {
    silence();
    file = open_hdf5(path, writable, sealed, trouble, message);
  }
  if (!writable)
    leave_and_close(fd);
  return file;
}

static hid_t create(const char *path, unsigned how, hid_t access)
{
  hid_t creation = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_obj_track_times(creation, false);
  hid_t file = access < 0 ? -1 : H5Fcreate(path, how, creation, access);
  h5_close(creation);
  h5_close(access);
  return file;
}

hid_t h5_create(const char *path, struct message *message)
{
  struct stat status;
  if (lstat(path, &status) == 0) {
    message_set(message, "%s: cannot be created: %s", path, strerror(EEXIST));
    return -1;
  }
  if (!h5_has_memory(path, 0, message))
    return -1;
  silence();
  hid_t file = create(path, H5F_ACC_EXCL, without_locks());
  if (file >= 0)
    lock_take(h5_descriptor(file), true); /* nobody else knows of it yet */
  else
    h5_fail(message, path, "cannot be created");
  return file;
}

bool h5_close_locked(hid_t file)
{
  const int fd = file < 0 ? -1 : fcntl(h5_descriptor(file), F_DUPFD_CLOEXEC, 0);
  const bool ok = h5_close(file);
  if (fd >= 0)
    leave_and_close(fd);
  return ok;
}

hid_t h5_create_in_memory(size_t bytes)
{
  if (!memory_to_spare(COPIES * bytes + H5_MEMORY))
    return -1;
  silence();
  hid_t access = new_format();
  /* HDF5 takes two files of one name for one file: another thread may have one open, too. A thread has one at a time.
   */
  char name[64];
  snprintf(name, sizeof name, "memory of %p", (void *)name);
  H5Pset_fapl_core(access, bytes + 65536, false);
  return create(name, H5F_ACC_TRUNC, access);
}

/* H5Fget_file_image says how many bytes are in use (the memory is a multiple of the increment), but its copy is not
 * used: it clears a flag in the superblock, whose checksum is then wrong (HDF5 1.10.8). */
void *h5_image(hid_t file, size_t *bytes)
{
  void **memory = NULL;
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 || H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&memory) < 0 || !memory)
    return NULL;
  ssize_t size = H5Fget_file_image(file, NULL, 0);
  unsigned char *image = size > 0 && *memory ? malloc((size_t)size + SEAL_BYTES) : NULL;
  if (image) {
    memcpy(image, *memory, (size_t)size);
    seal_make(image, (size_t)size, image + size);
    *bytes = (size_t)size + SEAL_BYTES;
  }
  return image;
}

/* --- room on the disk -------------------------------------------------------------------------------------------- */

int h5_descriptor(hid_t file)
{
  int *fd = NULL;
  return H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&fd) >= 0 && fd ? *fd : -1;
}

int h5_reserve(hid_t file, size_t bytes)
{
  hsize_t size;
  int fd = h5_descriptor(file);
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
  return fsync(h5_descriptor(file)) == 0 ? 0 : errno;
}

void h5_trim(hid_t file)
{
  hsize_t size;
  struct stat status;
  int fd = h5_descriptor(file);
  if (fd >= 0 && H5Fget_filesize(file, &size) >= 0 && fstat(fd, &status) == 0 && (hsize_t)status.st_size > size &&
      ftruncate(fd, (off_t)size) != 0)
    return; /* a longer file is sound too */
}

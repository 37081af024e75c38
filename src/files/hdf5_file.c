/* Files of HDF5: opened, made on disk or in memory, given room. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "files/hdf5.h"
#include "files/lock.h"
#include "files/seal.h"

static void silence(void)
{
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
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
static int open_locked(const char *path, bool writable, struct message *message)
{
  int fd = open(path, (writable ? O_RDWR : O_RDONLY) | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) {
    message_set(message, "%s: cannot be opened for %s: %s", path, writable ? "writing" : "reading", strerror(errno));
    return -1;
  }
  struct stat status;
  const bool regular = fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
  if (regular && lock_for(fd, writable) != LOCK_IN_USE)
    return fd;
  close(fd);
  if (regular)
    say_in_use(path, message);
  else
    message_set(message, "%s: not a file but a folder, a pipe or a device", path);
  return -1;
}

/* HDF5's own locks are off: it takes a file system without locks for a damaged file. lock.h does it. */
static hid_t new_format(void)
{
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_file_locking(access, false, true);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
  return access;
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
  hid_t access = new_format();
  hid_t file = H5Fopen(path, writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
  h5_close(access);
  if (file < 0) {
    h5_fail(message, path, "damaged HDF5 file");
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
  silence();
  *trouble = H5_UNREADABLE;
  const int fd = open_locked(path, writable, message);
  if (fd < 0)
    return -1;
  if (writable) /* HDF5's descriptor is to have the lock alone; readers share theirs, so that no frame comes in between
                 */
    close(fd);
  const hid_t file = open_hdf5(path, writable, sealed, trouble, message);
  if (!writable)
    close(fd);
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
  if (file >= 0)
    lock_take(h5_descriptor(file), true); /* nobody else knows of it yet */
  else if (access(path, F_OK) == 0)
    errno = EEXIST; /* HDF5 looks for itself, and leaves no errno */
  return file;
}

hid_t h5_create_in_memory(size_t bytes)
{
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

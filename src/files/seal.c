#include "files/seal.h"

#include <errno.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define XXH_STATIC_LINKING_ONLY /* the size of XXH64_state_t */
#include <xxhash.h>

#include "base/opening.h"

static const char magic[16] = {'u', 'n', 'c', 'r', 'o', 's', 's', ' ', 's', 'e', 'a', 'l', ' ', 'v', '1', '\n'};
#define BLOCK_BYTES 16384

static void put_number(unsigned char *at, uint64_t number)
{
  for (int k = 0; k < 8; k++)
    at[k] = (unsigned char)(number >> 8 * k);
}

static uint64_t get_number(const unsigned char *at)
{
  uint64_t number = 0;
  for (int k = 0; k < 8; k++)
    number |= (uint64_t)at[k] << 8 * k;
  return number;
}

static void put_seal(uint64_t bytes, uint64_t hash, unsigned char seal[SEAL_BYTES])
{
  memcpy(seal, magic, sizeof magic);
  put_number(seal + sizeof magic, bytes);
  put_number(seal + sizeof magic + 8, hash);
}

void seal_make(const void *data, size_t bytes, unsigned char seal[SEAL_BYTES])
{
  put_seal(bytes, XXH64(data, bytes, 0), seal);
}

static bool read_all(int fd, void *data, size_t bytes)
{
  char *rest = data;
  while (bytes > 0) {
    const ssize_t n = read(fd, rest, bytes);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return false;
    rest += n;
    bytes -= (size_t)n;
  }
  return true;
}

/* The hash of the first so many bytes. Needs no memory, so that it cannot fail for want of it. */
static bool hash_file(int fd, uint64_t bytes, uint64_t *hash)
{
  char block[BLOCK_BYTES];
  XXH64_state_t state;
  XXH64_reset(&state, 0);
  bool ok = lseek(fd, 0, SEEK_SET) == 0;
  while (ok && bytes > 0) {
    const size_t n = bytes < sizeof block ? (size_t)bytes : sizeof block;
    ok = read_all(fd, block, n);
    if (ok)
      XXH64_update(&state, block, n);
    bytes -= n;
  }
  *hash = XXH64_digest(&state);
  return ok;
}

static enum seal check(int fd, const char *path, struct message *message)
{
  struct stat status;
  unsigned char found[SEAL_BYTES], right[SEAL_BYTES];
  uint64_t hash = 0;
  bool ok = fstat(fd, &status) == 0;
  if (ok && status.st_size < SEAL_BYTES)
    return SEAL_NONE;
  const uint64_t bytes = ok ? (uint64_t)status.st_size - SEAL_BYTES : 0;
  ok = ok && lseek(fd, (off_t)bytes, SEEK_SET) >= 0 && read_all(fd, found, sizeof found);
  if (ok && memcmp(found, magic, sizeof magic) != 0)
    return SEAL_NONE;
  if (!ok || !hash_file(fd, bytes, &hash)) {
    message_set(message, "%s: cannot be read: %s", path, strerror(errno));
    return SEAL_UNREADABLE;
  }
  put_seal(bytes, hash, right);
  if (memcmp(found, right, sizeof right) == 0)
    return SEAL_FITS;
  message_set(message,
              "%s: damaged: its bytes are not those that were written (%" PRIu64 " bytes with hash %016" PRIx64
              "; its seal says %" PRIu64 " with %016" PRIx64 ")",
              path, bytes, hash, get_number(found + sizeof magic), get_number(found + sizeof magic + 8));
  return SEAL_BROKEN;
}

enum seal seal_check(const char *path, struct message *message)
{
  const int fd = open_regular(path, message);
  if (fd < 0)
    return SEAL_UNREADABLE;
  const enum seal seal = check(fd, path, message);
  close(fd);
  return seal;
}

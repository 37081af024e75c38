/* Linked into the programs of `make sanitize` only. A child that reads a file (src/files/apart.c) ends by _exit, and
 * may open no more files. Here it writes down what it reached before it ends. Its limits are soft ones, which it may
 * raise. */
#include <stdbool.h>
#include <stddef.h>
#include <sys/resource.h>

int __llvm_profile_write_file(void); /* of clang's runtime */
void __real__exit(int code) __attribute__((noreturn));
void inject_hold(bool held) __attribute__((weak)); /* inject.h, where it is linked */
void __wrap__exit(int code) __attribute__((noreturn));

void __wrap__exit(int code)
{
  static const int lowered[] = {RLIMIT_NOFILE, RLIMIT_AS};
  struct rlimit limit;
  for (size_t k = 0; k < sizeof lowered / sizeof *lowered; k++)
    if (getrlimit(lowered[k], &limit) == 0) {
      limit.rlim_cur = limit.rlim_max;
      setrlimit(lowered[k], &limit);
    }
  if (inject_hold)
    inject_hold(true);
  __llvm_profile_write_file();
  if (inject_hold)
    inject_hold(false);
  __real__exit(code);
}

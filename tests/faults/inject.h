/*
 * Failures on demand. A program that is linked with inject.c and FAULT_FLAGS of the Makefile (-Wl,--wrap=...) calls
 * memory, files and HDF5 through counting wrappers: the n-th call of a kind fails, as if memory or disk had run out.
 * Libraries call the real functions; what fails is what our own code calls.
 *
 * From outside: UNCROSS_FAIL=KIND:N fails call N of memory, file, hdf5 or signal (N+: all calls from N on), and
 * UNCROSS_CALLS names a file that gets the number of calls of each kind when the program ends. UNCROSS_SLOW=SECONDS: so
 * long does fsync take. UNCROSS_HASTE=FACTOR: so many times as fast is the clock.
 */
#ifndef UNCROSS_TESTS_INJECT_H
#define UNCROSS_TESTS_INJECT_H

#include <stdbool.h>
#include <stdint.h>

enum inject_kind {
  INJECT_MEMORY,
  INJECT_FILE,
  INJECT_HDF5,
  INJECT_SIGNAL, /* the call is interrupted by a signal (EINTR), to be made again */
  INJECT_KINDS
};

/* From now on counts anew, and fails call number n (from 1; 0: none) of this kind, with all later ones if `on`. */
void inject_arm(enum inject_kind kind, uint64_t n, bool on);

/* While held, calls of this process are not counted and do not fail: for instruments. */
void inject_hold(bool held);

/* No more failures. Returns whether there was one. */
bool inject_disarm(void);

#endif

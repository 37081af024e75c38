#!/usr/bin/env bash
# The port for all cores under ThreadSanitizer, with clang's OpenMP and Archer: ports/parallel/check-races. Prints TAP.
# Needs: BUILD, the build folder; clang and libomp-dev, else it is skipped.
set -u
top=$(cd "$(dirname "$0")/../.." && pwd)
if ! compgen -G '/usr/lib/llvm-*/lib/libarcher.so' >/dev/null || ! command -v clang++ >/dev/null; then
  echo "ok 1 # SKIP clang and libomp-dev are not installed"
  echo "1..1"
  exit 0
fi
MAKEFLAGS='' make -s -C "$top/ports/parallel" -j2 tsan UNCROSS="$(realpath "${UNCROSS:-$top/build/uncross}")"

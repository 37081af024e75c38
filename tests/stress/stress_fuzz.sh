#!/usr/bin/env bash
# Inputs of each kind that other programs write, by the fuzzer (tests/fuzz/fuzz_readers.c): a million outputs and traces of ports, as
# text; and of files of HDF5, each of which a process of its own reads, ten thousand trajectories that runs start from, and packs.
# CASES=100 for a hundredth of it. Prints TAP. Needs clang, else it is skipped.
set -u
cd "$(dirname "$0")/../.." || exit 1
if ! command -v clang >/dev/null; then
  echo "ok 1 # SKIP clang is not installed"
  echo "1..1"
  exit 0
fi
cases=${CASES:-10000}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
count=0
failures=0
for kind in r:100 R:100 o:100 H:1 h:1 p:1 P:1; do
  reader=${kind%:*}
  count=$((count + 1))
  mkdir -p "build/fuzz/corpus-$reader"
  if MAKEFLAGS='' FUZZ_READERS=$reader make -s fuzz FUZZ="-runs=$((cases * ${kind#*:})) build/fuzz/corpus-$reader tests/fuzz/corpus" >"$log" 2>&1; then
    echo "ok $count - reader $reader: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs"
  else
    echo "not ok $count - reader $reader"
    tail -n 20 "$log"
    failures=$((failures + 1))
  fi
done
echo "1..$count"
exit $((failures > 0))

#!/usr/bin/env bash
# A million inputs of each kind that other programs write, by the fuzzer (tests/fuzz/fuzz_readers.c): checkpoints with other numbers
# and right checksums, or with changed structure; trajectories that runs start from; packs, outputs and traces of ports. Some ten hours
# of CPU time. CASES=10000 for a hundredth of it, KINDS="K h" for some. A million records are stress_records.py. Prints TAP. Needs
# clang, else it is skipped.
set -u
cd "$(dirname "$0")/../.." || exit 1
if ! command -v clang >/dev/null; then
  echo "ok 1 # SKIP clang is not installed"
  echo "1..1"
  exit 0
fi
cases=${CASES:-1000000}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
count=0
failures=0
for reader in ${KINDS:-K h H C E q P r R o}; do
  count=$((count + 1))
  mkdir -p "build/fuzz/corpus-$reader"
  if MAKEFLAGS='' FUZZ_READERS=$reader make -s fuzz FUZZ="-runs=$cases build/fuzz/corpus-$reader tests/fuzz/corpus" >"$log" 2>&1; then
    echo "ok $count - reader $reader: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs"
  else
    echo "not ok $count - reader $reader"
    tail -n 20 "$log"
    failures=$((failures + 1))
  fi
done
echo "1..$count"
exit $((failures > 0))

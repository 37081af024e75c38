#!/usr/bin/env bash
# Values that were never set, which the sanitizers do not see: a run, its resume and what reads its files, under valgrind.
# Prints TAP. Needs: BUILD, the build folder; valgrind, else it is skipped. Builds the program for plain x86-64 first.
set -u
top=$(cd "$(dirname "$0")/../.." && pwd)
if ! command -v valgrind >/dev/null; then
  echo "ok 1 # SKIP valgrind is not installed"
  echo "1..1"
  exit 0
fi
build=$(realpath "${BUILD:-build}")/valgrind
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
MAKEFLAGS='' make -s -C "$top" MARCH=x86-64 OPTIMIZE='-O1 -march=x86-64' BUILD="$build" "$build/uncross" >"$dir/log" 2>&1 || cat "$dir/log"
cat >"$dir/scene.yaml" <<YAML
box: [6, 5, 4]
time_step: 0.01
steps: 20
seed: 1
solvent: {per_cell: 3, collision_interval: 0.02, thermostat: maxwell-boltzmann}
fibers:
  - {name: rod, count: 10, vertices: 6, mass: 5, bond_length: 0.5, spring: 100, bending: 4}
  - {name: loop, count: 3, vertices: 5, mass: 5, bond_length: 0.4, spring: 100, bending: 0, ring: true}
observe:
  conserved: {every: 2}
  temperature: {every: 2}
  statics: {every: 2}
  dynamics: {every: 2}
  collisions: {every: 2}
trajectory: {every: 5, velocities: true, solvent: true}
YAML
count=0
failures=0
cd "$dir" || exit 1
for command in "check scene.yaml" "run scene.yaml --out run --steps 12" "run scene.yaml --out run --resume" \
  "info run/checkpoint.h5" "info run/trajectory.h5" "frames run/trajectory.h5" \
  "analyze run/trajectory.h5 --out again"; do
  count=$((count + 1))
  # shellcheck disable=SC2086
  if echo 0 | valgrind -q --error-exitcode=99 "$build/uncross" $command >out 2>err; then
    echo "ok $count - uncross $command"
  else
    echo "not ok $count - uncross $command"
    sed 's/^/# /' err | head -n 40
    failures=$((failures + 1))
  fi
done
echo "1..$count"
exit $((failures > 0))

#!/usr/bin/env bash
# The same bits from gcc and clang, for any processor or this one: state hashes of short runs of several scenes and of all
# shipped ones, and packs of every operator alone. Each takes the fastest kernel that it has for this processor. What is
# short of it: tests/kernel/test_shipped.c and tests/oracle, which `make check` builds by gcc and `make sanitize` by clang.
# Needs: UNCROSS, the program (default build/uncross); builds the others into its build folder. Prints TAP.
set -u
uncross=$(realpath "${UNCROSS:-build/uncross}")
top=$(cd "$(dirname "$0")/../.." && pwd)
build=$(dirname "$uncross")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
count=0
failures=0

ok() { # ok STATUS NAME
  count=$((count + 1))
  if [ "$1" = 0 ]; then echo "ok $count - $2"; else echo "not ok $count - $2"; failures=$((failures + 1)); fi
}

scene() { # scene ORDER THERMOSTAT HYDRODYNAMICS ANGLE FORBIDDEN
  cat <<YAML
box: [8, 9, 7]
time_step: 0.01
steps: 200
order: $1
solvent: {per_cell: 5, collision_interval: 0.02, thermostat: $2, hydrodynamics: $3, rotation_angle: $4}
fibers:
  - {name: fiber, count: 25, vertices: 16, mass: 5, bond_length: 0.5, spring: 100, persistence_length: 8}
  - {name: chain, count: 9, vertices: 10, mass: 3, bond_length: 0, spring: 12}
crossing: {forbidden: $5}
YAML
}
scene kick-split none true 90 true >"$dir/default.yaml"
scene drift-split rescale true 130 true >"$dir/rescale-130.yaml"
scene paper maxwell-boltzmann true 90 true >"$dir/paper-boltzmann.yaml"
scene kick-split none false 90 false >"$dir/phantom-no-hydrodynamics.yaml"
scene kick-split none 'false, bath: phantoms' 90 true >"$dir/bath.yaml"
scene drift-split none true 90 'true, rule: event-driven' >"$dir/event-driven.yaml"

mkdir "$dir/shipped"
for scene in "$top"/scenes/*.yaml; do # without what they observe, which may begin after the run's few steps
  awk '/^[a-z]/ { skip = /^observe/ } !skip' "$scene" | sed 's/^steps:.*/steps: 20/' >"$dir/shipped/$(basename "$scene")"
done

hashes() { # hashes PROGRAM FOLDER: of all scenes there
  for scene in "$2"/*.yaml; do
    "$1" run "$scene" --out "$dir/run" --quiet || echo "failed"
    sed -n 's/.*"state_hash": "\([0-9a-f]*\)".*/\1/p' "$dir/run/run.json"
    rm -rf "$dir/run"
  done
}
# Packs differ in no bit; what docs/port/tolerances.md leaves to the C library may differ within tolerance: normal and Gamma
# deviates, and cosine and sine of the 130 degrees of `mixed`.
exact=order,long_sweep,sweep,bond_force,bend_force,force,kick,stream,shift,bin,sum,solve,rescale,swap,contact_search,impulse,long_event_drift,event_drift
packs() { # packs PROGRAM: compared with those of $uncross
  local scene status only
  for scene in dense mixed events; do
    rm -f "$dir/theirs.h5"
    "$1" oracle emit "reference-data/$scene.yaml" -o "$dir/theirs.h5" || return 1
    "$uncross" oracle compare "$dir/$scene.h5" "$dir/theirs.h5" >"$dir/log"
    status=$?
    only=$exact
    if [ $scene != mixed ]; then only=$only,rotate; fi
    if [ $status != 0 ]; then sed 's/^/# /' "$dir/log"; fi
    { [ $status = 0 ] || [ $status = 6 ]; } || return 1
    "$uncross" oracle compare "$dir/$scene.h5" "$dir/theirs.h5" --only "$only" >"$dir/log" || return 1
  done
}
cd "$top" || exit 1
for scene in dense mixed events; do
  "$uncross" oracle emit "reference-data/$scene.yaml" -o "$dir/$scene.h5" || echo "failed"
done

wanted=$(hashes "$uncross" "$dir")
shipped=$(hashes "$uncross" "$dir/shipped")
for variant in "clang x86-64" "gcc x86-64" "clang native"; do
  read -r compiler march <<<"$variant"
  folder=$build/bits-$compiler-$march
  rm -f "$folder/uncross"
  MAKEFLAGS='' make -s -j2 -C "$top" CC="$compiler" MARCH="$march" BUILD="$folder" "$folder/uncross" >"$dir/log" 2>&1 || cat "$dir/log"
  [ "$(hashes "$folder/uncross" "$dir")" = "$wanted" ]
  ok $? "$compiler -march=$march: the same bits in six scenes"
  [ "$(hashes "$folder/uncross" "$dir/shipped")" = "$shipped" ]
  ok $? "$compiler -march=$march: the same bits in the shipped scenes"
  packs "$folder/uncross"
  ok $? "$compiler -march=$march: the same packs"
done
[ "$(echo "$wanted" | sort -u | wc -l)" = 6 ]
ok $? "the six scenes differ"
[ "$(echo "$shipped" | sort -u | grep -cx '[0-9a-f]\{16\}')" = "$(find "$dir/shipped" -name '*.yaml' | wc -l)" ]
ok $? "the shipped scenes run, and differ"
echo "1..$count"
exit $((failures > 0))

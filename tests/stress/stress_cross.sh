#!/usr/bin/env bash
# The same bits on another processor: the program for aarch64, run by QEMU, against this machine's, in all shipped scenes. Equal are
# state hashes, tables and trajectories, byte for byte; a checkpoint of one is finished by the other; packs of every operator agree.
# The process that reads checkpoints is started by the kernel, so that part needs one that runs aarch64 by itself (qemu-user-binfmt).
# Prints TAP. Needs: UNCROSS, the program (default build/uncross); Debian's cross compiler, QEMU and packages, else it is skipped.
# Builds the other program into the build folder first.
set -u
uncross=$(realpath "${UNCROSS:-build/uncross}")
top=$(cd "$(dirname "$0")/../.." && pwd)
build=$(dirname "$uncross")/cross
root=$build/root
compiler=aarch64-linux-gnu-gcc
for tool in $compiler qemu-aarch64 apt-get; do
  if ! command -v "$tool" >/dev/null; then
    echo "ok 1 # SKIP $tool is not installed"
    echo "1..1"
    exit 0
  fi
done
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
count=0
failures=0

ok() { # ok STATUS NAME
  count=$((count + 1))
  if [ "$1" = 0 ]; then echo "ok $count - $2"; else echo "not ok $count - $2"; failures=$((failures + 1)); fi
}

cd "$top" || exit 1
tools/cross-root arm64 "$root"
MAKEFLAGS='' PKG_CONFIG_SYSROOT_DIR=$root PKG_CONFIG_LIBDIR=$root/usr/lib/aarch64-linux-gnu/pkgconfig \
  make -s -j2 CC="$compiler --sysroot=$root" OPTIMIZE=-O2 BUILD="$build" "$build/uncross" >"$dir/log" 2>&1 || cat "$dir/log"
export QEMU_LD_PREFIX=$root
other=(qemu-aarch64 "$build/uncross")
"${other[@]}" --version
ok $? "the program for aarch64 runs"
if [ $failures != 0 ]; then
  echo "1..$count"
  exit 1
fi

by_kernel=no
if "$build/uncross" --version >"$dir/log" 2>&1; then
  by_kernel=yes
else
  echo "# checkpoints are not changed from one to the other: this kernel does not start programs for aarch64"
fi

short() { # short SCENE: few steps, and observables that begin within them
  awk '/^[a-z]/ { skip = /^(observe|trajectory)/ } !skip' "$1" | sed 's/^steps:.*/steps: 40/'
  printf 'observe: {conserved: {every: 5}, temperature: {every: 5}}\ntrajectory: {every: 10, velocities: true, solvent: true}\n'
}

field() { sed -n "s/.*\"$1\": \"\\([0-9a-f]*\\)\".*/\\1/p" "$2/run.json"; }

file=$dir/scene.yaml
for scene in scenes/*.yaml; do
  short "$scene" >"$file"
  "$uncross" run "$file" --out "$dir/ours" --quiet
  "${other[@]}" run "$file" --out "$dir/theirs" --quiet
  hash=$(field state_hash "$dir/ours")
  [ -n "$hash" ] && [ "$hash" = "$(field state_hash "$dir/theirs")" ]
  ok $? "$scene: the same state"
  differ=0
  for path in "$dir"/ours/*.csv "$dir/ours/trajectory.h5"; do cmp "$path" "$dir/theirs/${path##*/}" || differ=1; done
  ok $differ "$scene: the same tables and trajectory"
  case $by_kernel$scene in
    yes*semidilute* | yes*dense.yaml | yes*shear.yaml | yes*dumbbells.yaml)
      "$uncross" run "$file" --out "$dir/first" --steps 10 --quiet &&
        "${other[@]}" run "$file" --out "$dir/first" --resume --steps 25 --quiet &&
        "$uncross" run "$file" --out "$dir/first" --resume --quiet && [ "$hash" = "$(field state_hash "$dir/first")" ]
      ok $? "$scene: begun on one, taken up by the other, finished on the first"
      ;;
  esac
  rm -rf "$dir"/ours "$dir"/theirs "$dir"/first
done
for scene in dense mixed events; do
  "$uncross" oracle emit "reference-data/$scene.yaml" -o "$dir/ours.h5" &&
    "${other[@]}" oracle emit "reference-data/$scene.yaml" -o "$dir/theirs.h5" &&
    "$uncross" oracle compare "$dir/ours.h5" "$dir/theirs.h5" >"$dir/log"
  ok $? "reference-data/$scene.yaml: the same packs"
  rm -f "$dir"/*.h5
done
echo "1..$count"
exit $((failures > 0))

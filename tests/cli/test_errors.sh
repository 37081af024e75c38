#!/usr/bin/env bash
# What the command line refuses, and with which exit code and words; what it says while it runs. Prints TAP.
# Needs: UNCROSS, the program (default build/uncross).
set -u
uncross=$(realpath "${UNCROSS:-build/uncross}")
dir=$(mktemp -d)
trap 'chattr -i "$dir/fixed" 2>/dev/null; chmod -R u+w "$dir"; rm -rf "$dir"' EXIT
count=0
failures=0

ok() { # ok STATUS NAME
  count=$((count + 1))
  if [ "$1" = 0 ]; then echo "ok $count - $2"; else echo "not ok $count - $2"; failures=$((failures + 1)); fi
}
gives() { # gives CODE PATTERN ARGUMENTS ...: the exit code, and a line of standard error
  local wanted=$1 pattern=$2
  shift 2
  "$uncross" "$@" >"$dir/out" 2>"$dir/err"
  local code=$?
  { [ "$code" = "$wanted" ] && { [ -z "$pattern" ] || grep -q -- "$pattern" "$dir/err"; }; }
  ok $? "uncross ${*//"$dir"\//}: $code, $(sed "s|$dir/||g; 1q" "$dir/err" | cut -c 1-120)"
}

cat >"$dir/scene.yaml" <<YAML
box: [4, 4, 4]
time_step: 0.01
steps: 20
seed: 1
solvent: {per_cell: 3, collision_interval: 0.02}
fibers:
  - {name: a, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100, bending: 4}
observe:
  conserved: {every: 1}
  dynamics: {every: 1}
trajectory: {every: 10, velocities: true}
YAML
scene=$dir/scene.yaml run=$dir/run
gives 0 '' run "$scene" --out "$run"
grep -q '^finished at step 20 of 20 after ' "$dir/out" && grep -q '^state hash [0-9a-f]\{16\}$' "$dir/out"
ok $? "a run says how it ended"
{ cat "$run/trajectory.h5"; } >"$dir/frames.h5"

# words
gives 2 'unknown command' fly "$scene"
gives 2 'unrecognized option' run "$scene" --folder "$run"
gives 2 'requires an argument' run "$scene" --out
gives 2 'a file is missing' check
gives 2 'one file only' check "$scene" "$scene"
gives 2 '--out DIR is missing' run "$scene"
gives 2 '--out DIR is missing' analyze "$dir/frames.h5"
gives 2 '--stride 0: not a whole number from 1 to' export "$dir/frames.h5" --stride 0
for number in x 1x '' -1 1.5 18446744073709551616; do
  gives 2 "--first $number: not a whole number" export "$dir/frames.h5" --first "$number"
done

# files
gives 2 'missing.yaml' check "$dir/missing.yaml"

# thick fibers that overlap at the start, or find no room: at their key, and nothing is written
cat >"$dir/thick.yaml" <<YAML
box: [8, 8, 8]
time_step: 0.01
steps: 20
fibers:
  - name: a
    count: 2
    vertices: 4
    mass: 5
    bond_length: 0.5
    spring: 100
    diameter: 0.3
    start: straight
    places:
      - {center: [4, 4, 4], direction: [1, 0, 0]}
      - {center: [4, 4, 4.2], direction: [0, 1, 0]}
crossing: {rule: event-driven}
YAML
gives 2 'thick.yaml:15:18: .*overlaps with another: their axes are 0.2 a0 apart; allowed: more than 0.3' run "$dir/thick.yaml" --out "$dir/thick"
[ ! -e "$dir/thick" ]
ok $? "thick fibers that overlap leave no folder"
sed -e 's/diameter: 0.3/bending: 0/; s/4, 4.2/4, 4/' "$dir/thick.yaml" >"$dir/thin.yaml"
gives 2 'thin.yaml:15:18: .*bond . of fiber 1 touches another; allowed: bonds that are apart' run "$dir/thin.yaml" --out "$dir/thin"
sed -e '/start:/,/- {center: .*1, 0\]/d' -e 's/count: 2/count: 2000/; s/diameter: 0.3/diameter: 0.5/' "$dir/thick.yaml" >"$dir/full.yaml"
gives 2 'full.yaml:11:15: .*overlaps with others wherever it is laid' run "$dir/full.yaml" --out "$dir/thick"
# tubes thicker than bonds are long; without contacts at their own time; a snapshot of thin lines whose tubes overlap
sed -e 's/diameter: 0.3/diameter: 0.6/' "$dir/thick.yaml" >"$dir/wide.yaml"
gives 2 'wide.yaml:11:15: .*0.6 for bonds of a mean length of 0.538.* a0' run "$dir/wide.yaml" --out "$dir/thick"
sed -e 's/event-driven/sequential/' "$dir/thick.yaml" >"$dir/turns.yaml"
gives 2 'turns.yaml:11:15: .*sequential knows thin lines only' run "$dir/turns.yaml" --out "$dir/thick"
sed -e 's/diameter: 0.3/diameter: 0/' "$dir/thick.yaml" >"$dir/thin.yaml"
gives 0 '' run "$dir/thin.yaml" --out "$dir/thin" --quiet
{ sed -e '/start:/,/- {center: .*1, 0\]/d' "$dir/thick.yaml" && echo 'start: {snapshot: thin/checkpoint.h5}'; } >"$dir/again.yaml"
gives 2 'again.yaml:13:19: .*overlaps with another: their axes are 0.2.* a0 apart' run "$dir/again.yaml" --out "$dir/thick"
[ ! -e "$dir/thick" ]
ok $? "no refused scene of thick fibers leaves a folder"

# A bead: overlapped by a placed fiber, larger than the box allows, driven faster than is allowed.
cat >"$dir/bead.yaml" <<YAML
box: [12, 12, 12]
time_step: 0.05
steps: 20
solvent: {per_cell: 5, collision_interval: 0.05}
bead:
  radius: 2
  center: [6, 6, 6]
  drive:
    force: [5, 0, 0]
fibers:
  - name: a
    count: 2
    vertices: 4
    mass: 5
    bond_length: 0.5
    spring: 100
    diameter: 0.2
    start: straight
    places:
      - {center: [6, 6, 9], direction: [1, 0, 0]}
      - {center: [6, 8.05, 6], direction: [0, 0, 1]}
crossing: {rule: event-driven}
YAML
gives 2 'bead.yaml:21:18: .*bond 4 of fiber 1 overlaps with the bead: its axis is 2.06.* a0 from the center; allowed: more than 2.1' run "$dir/bead.yaml" --out "$dir/bead"
sed 's/8.05/8.2/; s/radius: 2/radius: 4/' "$dir/bead.yaml" >"$dir/large.yaml"
gives 2 'large.yaml:6:11: bead.radius: 4 a0 in a box whose shortest edge is 12 a0; allowed: at most 3 a0' run "$dir/large.yaml" --out "$dir/bead"
sed 's/8.05/8.2/; s/\[5, 0, 0\]/[0, 500, 0]/' "$dir/bead.yaml" >"$dir/fast.yaml"
gives 2 'fast.yaml:9:12: bead.drive.force: 500 kT/a0 drives the bead at .*too near the speed of sound; allowed: at most' run "$dir/fast.yaml" --out "$dir/bead"
[ ! -e "$dir/bead" ]
ok $? "beads that cannot be leave no folder"

# `check` answers at once, in little memory, whatever the numbers in the scene: 5 s (they take 0.3 s) and 2 GiB.
at_once() { # at_once CODE PATTERN SCENE: as gives, of `check`
  local wanted=$1 pattern=$2
  (ulimit -v 2097152 && exec timeout 5 "$uncross" check "$3") >"$dir/out" 2>&1
  local code=$?
  { [ "$code" = "$wanted" ] && grep -q -- "$pattern" "$dir/out"; }
  ok $? "uncross check ${3#"$dir"/}, at once: $code"
}
kind='vertices: 1500, mass: 5, bond_length: 0.5, spring: 100, bending: 4'
sed '/^fibers:/,$d' "$scene" >"$dir/many.yaml"
cp "$dir/many.yaml" "$dir/kinds.yaml"
echo "fibers: [{name: a, count: 1431655, $kind}]" >>"$dir/many.yaml"
# With address sanitizers a limit of memory cannot be set.
if (ulimit -v 2097152 && exec "$uncross" --version) >/dev/null 2>&1; then
  at_once 0 ' vertices  *2.14748e+09' "$dir/many.yaml"
fi
echo 'fibers:' >>"$dir/kinds.yaml"
for k in {1..4096}; do echo "  - {name: k$k, count: 1, mass: 5.$((10000 + k)), ${kind/mass: 5, /}}"; done >>"$dir/kinds.yaml"
(ulimit -t 10 && "$uncross" check "$dir/kinds.yaml") >"$dir/out" 2>&1 && grep -q '^Fibers .k4096.$' "$dir/out"
ok $? "check of 4096 kinds, at once"
echo "  - {name: last, count: 1, $kind}" >>"$dir/kinds.yaml"
gives 2 'fibers: 4097 kinds; allowed: at most 4096' check "$dir/kinds.yaml"
printf '[%.0s' {1..100000} >"$dir/deep.yaml"
timeout 5 "$uncross" check "$dir/deep.yaml" 2>"$dir/err" || grep -q 'deep.yaml:1:33: nested too deeply; allowed: 32' "$dir/err"
ok $? "a deep scene is refused at once"
gives 2 'missing.h5' info "$dir/missing.h5"
gives 2 'missing.h5' export "$dir/missing.h5"
gives 2 'missing.h5' analyze "$dir/missing.h5" --out "$dir/new"
gives 2 'not an HDF5 file' analyze "$scene" --out "$dir/new"
gives 2 'not a file but' export "$dir"
gives 2 'without an H5MD trajectory' analyze "$run/checkpoint.h5" --out "$dir/new"
gives 2 'cannot create' export "$dir/frames.h5" --out "$scene"
gives 4 'cannot create' export "$dir/frames.h5" --out "$dir/nowhere/out.xyz"
gives 2 'first frame 3 asked for' export "$dir/frames.h5" --first 3 --out "$dir/out.xyz"
gives 2 'no frames: the first asked for is 2, the last 1' export "$dir/frames.h5" --first 2 --last 1 --out "$dir/out.xyz"
[ ! -e "$dir/out.xyz" ]
ok $? "an export that fails leaves no file"
gives 2 'is not a folder' analyze "$dir/frames.h5" --out "$scene"
ln -s loop "$dir/loop"
gives 4 'loop: cannot find out what this is: ' analyze "$dir/frames.h5" --out "$dir/loop"
"$uncross" run "$scene" --out "$dir/loop" --resume 2>"$dir/err"
grep -q 'loop: cannot find out what this is: ' "$dir/err"
ok $? "a folder that cannot be looked into is not told to hold nothing to resume"
"$uncross" verify "$scene" >"$dir/out"
[ $? = 2 ] && grep -q 'not a file that verify knows: checkpoints and trajectories' "$dir/out"
ok $? "verify of a file that it does not know: 2, $(sed "s|$dir/||g; 1q" "$dir/out" | cut -c 1-120)"
printf '# uncross pack 2: operator step row table.component value\nhalf a line\n' >"$dir/half.txt"
"$uncross" verify "$dir/half.txt" >"$dir/out"
[ $? = 9 ] && grep -q 'half.txt:2:.*not understood' "$dir/out"
ok $? "verify of a damaged pack: 9, $(sed "s|$dir/||g; 1q" "$dir/out" | cut -c 1-120)"
printf '# of a port\nbonds 3 0 out.force.x 1\nhalf a line\n' >"$dir/half.txt"
"$uncross" verify "$dir/half.txt" >"$dir/out"
[ $? = 9 ] && grep -q 'half.txt:3:.*not understood' "$dir/out"
ok $? "verify of a damaged pack of a port: 9, $(sed "s|$dir/||g; 1q" "$dir/out" | cut -c 1-120)"
gives 0 'conserved: left out: the solvent is not in the frames' analyze "$dir/frames.h5" --out "$dir/tables"
if [ -w /dev/full ]; then
  "$uncross" export "$dir/frames.h5" >/dev/full 2>"$dir/err"
  { [ $? = 4 ] && grep -q 'written: No space left\|cannot write: No space left' "$dir/err"; }
  ok $? "export to a full device: exit code 4, and says so"
fi

# frames
for choice in "--first 1" "--last 1" "--stride 2" "--wrapped" "--first 1 --last 1"; do
  # shellcheck disable=SC2086
  "$uncross" export "$dir/frames.h5" $choice >"$dir/out" 2>"$dir/err"
  ok $? "export $choice: steps$(sed -n 's/.* Step=\([0-9]*\) .*/ \1/p' "$dir/out" | tr -d '\n')"
done
[ "$(sed -n 's/.* Step=\([0-9]*\) .*/\1/p' "$dir/out")" = 10 ]
ok $? "export --first 1 --last 1 gives the frame of step 10 alone"

# runs
gives 2 'holds a run already (checkpoint.h5)' run "$scene" --out "$run"
gives 0 '' run "$scene" --out "$run" --resume --steps 21 --seed 1 --quiet
gives 2 "seed 1; a resumed run keeps its seed" run "$scene" --out "$run" --resume --steps 22 --seed 2
sed 's/seed: 1/seed: 2/' "$scene" >"$dir/other.yaml"
gives 2 "seed 1; a resumed run keeps its seed" run "$dir/other.yaml" --out "$run" --resume --steps 22
gives 2 "seed 1; a resumed run keeps its seed" run "$scene" --out "$run" --resume --steps 22 --set seed=2
gives 0 '' run "$scene" --out "$run" --resume --steps 22
sed 's/bending: 4/bending: 5/' "$scene" >"$dir/other.yaml"
gives 2 'bending is 5 there, 4 in the run so far' run "$dir/other.yaml" --out "$run" --resume --steps 23
sed 's/conserved: {every: 1}/statics: {every: 1}/' "$scene" >"$dir/other.yaml"
gives 2 'no memory of the observable' run "$dir/other.yaml" --out "$run" --resume --steps 23
"$uncross" run "$scene" --out "$dir/stop'd here" --set "box=[4, 4, 5]" --steps 100000000 >"$dir/out" 2>"$dir/err" &
for ((waited = 0; waited < 1000; waited++)); do # a shell has its background ignore SIGINT, until the program looks for it
  [ ! -e "$dir/stop'd here" ] || break
  sleep 0.1
done
[ -e "$dir/stop'd here" ] || kill -KILL $!
kill -INT $!
wait $!
[ $? = 5 ] && grep -qF "go on with:  $uncross run " "$dir/out"
ok $? "SIGINT: exit code 5, and what to do next"
next=$(sed -n 's/^go on with:  //p' "$dir/out")
for seconds in 2 4 8 16 32; do # on a busy machine a signal may come before the program looks for it
  eval "timeout -s INT $seconds $next" >"$dir/out" 2>&1
  status=$?
  ! grep -q '^go on with:' "$dir/out" || break
done
[ "$status" = 124 ] && grep -q '^go on with:  .* run ' "$dir/out"
ok $? "what is printed is the whole command, as a shell takes it"
"$uncross" info "$dir/stop'd here" >"$dir/out" && grep -q 'run.json: record of a run' "$dir/out" && grep -q 'checkpoint.h5: checkpoint of' "$dir/out"
ok $? "info of a run's folder"
gives 2 'a folder without run.json' info "$dir"

# Nothing can be written: root may write anywhere, but not where no file can change.
mkdir "$dir/fixed"
if chattr +i "$dir/fixed" 2>/dev/null; then
  gives 4 'cannot' run "$scene" --out "$dir/fixed/run"
  gives 4 'cannot write here' analyze "$dir/frames.h5" --out "$dir/fixed"
  chattr -i "$dir/fixed"
else
  echo "# no folder can be made immutable here: skipped"
fi
if mkdir "$dir/mounted" && mount -t tmpfs -o size=4m none "$dir/mounted" 2>/dev/null; then
  "$uncross" run "$scene" --out "$dir/mounted/run" --quiet --steps 5
  before=$(cksum <"$dir/mounted/run/checkpoint.h5")
  mount -o remount,ro "$dir/mounted"
  gives 4 'Read-only' run "$scene" --out "$dir/mounted/run" --resume
  [ "$before" = "$(cksum <"$dir/mounted/run/checkpoint.h5")" ]
  ok $? "a file system that became read-only: the checkpoint stays"
  umount "$dir/mounted"
else
  echo "# no tmpfs may be mounted here: a read-only file system was not tried"
fi
echo "1..$count"
exit $((failures > 0))

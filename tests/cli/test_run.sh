#!/usr/bin/env bash
# The program from outside: runs, resumes, interruptions, bad input. Prints TAP.
# Needs: UNCROSS, the program (default build/uncross).
set -u
uncross=$(realpath "${UNCROSS:-build/uncross}")
top=$(cd "$(dirname "$0")/../.." && pwd)
dir=$(mktemp -d)
trap 'chmod -R u+w "$dir"; rm -rf "$dir"' EXIT
count=0
failures=0

ok() { # ok STATUS NAME
  count=$((count + 1))
  if [ "$1" = 0 ]; then echo "ok $count - $2"; else echo "not ok $count - $2"; failures=$((failures + 1)); fi
}
same() { # same WANTED FOUND NAME
  [ "$1" = "$2" ]; ok $? "$3 ($2)"
}
hash_of() { # of run.json in this folder
  sed -n 's/.*"state_hash": "\([0-9a-f]*\)".*/\1/p' "$1/run.json"
}
run() { # run FOLDER [options]: exit code in $code, errors in $dir/err
  local folder=$1
  shift
  "$uncross" run "$dir/scene.yaml" --out "$folder" --quiet "$@" >"$dir/out" 2>"$dir/err"
  code=$?
}

# A small dense suspension in which everything is asked for.
scene() {
  cat <<YAML
box: [8, 8, 8]
time_step: 0.01
steps: 400
seed: 18446744073709551615
solvent:
  per_cell: 5
  collision_interval: 0.02
fibers:
  - name: fiber
    count: 30
    vertices: 16
    mass: 5
    bond_length: 0.5
    spring: 100
    persistence_length: 8
YAML
}
observed() {
  cat <<YAML
observe:
  conserved: {every: 10}
  temperature: {every: 10}
  statics: {every: 10}
  dynamics: {every: 10}
  collisions: {every: 10}
trajectory: {every: 10, velocities: true, solvent: true}
YAML
}
scene >"$dir/plain.yaml"
{ scene; observed; } >"$dir/observed.yaml"

cp "$dir/plain.yaml" "$dir/scene.yaml"
run "$dir/plain"
same 0 "$code" "a run ends with exit code 0"
plain=$(hash_of "$dir/plain")
[ -n "$plain" ]; ok $? "its run.json holds a state hash ($plain)"
run "$dir/plain"
same 2 "$code" "a second run into the same folder is refused"
same "$plain" "$(hash_of "$dir/plain")" "and changes nothing"

cp "$dir/observed.yaml" "$dir/scene.yaml"
run "$dir/observed"
same "$plain" "$(hash_of "$dir/observed")" "observed or not: the same final state"

# Stopped and resumed twice, at steps that are no multiples of any cadence: the same state, and the same tables.
run "$dir/parts" --steps 137
run "$dir/parts" --resume --steps 263
run "$dir/parts" --resume
same 0 "$code" "a resumed run ends with exit code 0"
same "$plain" "$(hash_of "$dir/parts")" "in three parts or in one: the same final state"
for table in "$dir/observed"/*.csv; do
  cmp -s "$table" "$dir/parts/${table##*/}"
  ok $? "in three parts or in one: the same table ${table##*/}"
done

# The same without solvent particles.
sed 's/^  collision_interval.*/&\n  hydrodynamics: false\n  bath: phantoms/' "$dir/plain.yaml" >"$dir/scene.yaml"
run "$dir/bath-plain"
same 0 "$code" "a bath of phantoms: a run ends with exit code 0"
bath=$(hash_of "$dir/bath-plain")
sed 's/^  collision_interval.*/&\n  hydrodynamics: false\n  bath: phantoms/' "$dir/observed.yaml" >"$dir/scene.yaml"
run "$dir/bath-parts" --steps 137
run "$dir/bath-parts" --resume --steps 263
run "$dir/bath-parts" --resume
same "$bath" "$(hash_of "$dir/bath-parts")" "a bath of phantoms: observed, in three parts, or neither: the same final state"
"$uncross" analyze "$dir/bath-parts/trajectory.h5" --out "$dir/bath-analyzed" >/dev/null 2>"$dir/err"
ok $? "a bath of phantoms: its trajectory is analyzed"
cmp -s "$dir/bath-parts/dynamics-fiber.csv" "$dir/bath-analyzed/dynamics-fiber.csv"
ok $? "a bath of phantoms: the same dynamics from its frames"
cp "$dir/observed.yaml" "$dir/scene.yaml"

# Interrupted by a signal, in the middle of the loop.
"$uncross" run "$dir/scene.yaml" --out "$dir/killed" --steps 100000000 --quiet >/dev/null 2>"$dir/err" &
for ((waited = 0; waited < 1000; waited++)); do # its folder comes after it looks for signals
  [ ! -e "$dir/killed" ] || break
  sleep 0.1
done
[ -e "$dir/killed" ] || kill -KILL $!
sleep 1
kill -TERM $!
wait $!
same 5 $? "SIGTERM: exit code 5"
reached=$(sed -n 's/.*"steps": \([0-9]*\).*/\1/p' "$dir/killed/run.json")
run "$dir/killed" --resume --steps $((reached + 50))
same 0 "$code" "and the run goes on from its checkpoint (step $reached)"
run "$dir/straight" --steps $((reached + 50))
same "$(hash_of "$dir/straight")" "$(hash_of "$dir/killed")" "interrupted or not: the same final state"

# Killed without warning after its last checkpoint: rows and frames after it are made again, not doubled.
run "$dir/crashed" --steps 200
cp "$dir/crashed/checkpoint.h5" "$dir/keep.h5"
run "$dir/crashed" --resume --steps 300
cp "$dir/keep.h5" "$dir/crashed/checkpoint.h5"
run "$dir/crashed" --resume
for table in "$dir/observed"/*.csv; do
  cmp -s "$table" "$dir/crashed/${table##*/}"
  ok $? "after a crash: the same table ${table##*/}"
done

# The observables of the trajectory are those of the run.
"$uncross" analyze "$dir/observed/trajectory.h5" --out "$dir/again" >"$dir/out" 2>"$dir/err"
same 0 $? "analyze ends with exit code 0"
for table in "$dir/observed"/*.csv; do
  [ "${table##*/}" = collisions.csv ] && continue
  cmp -s "$table" "$dir/again/${table##*/}"
  ok $? "analyze: the run's own table ${table##*/}"
done

# A trajectory that a crash has damaged: set aside, said so, and the run goes on.
cp -r "$dir/crashed" "$dir/damaged"
head -c 3000 "$dir/crashed/trajectory.h5" >"$dir/damaged/trajectory.h5"
run "$dir/damaged" --resume --steps 420
{ [ "$code" = 0 ] && grep -q damaged "$dir/err" && [ -e "$dir/damaged/trajectory.damaged.1.h5" ]; }
ok $? "a damaged trajectory is set aside: $(head -c 160 "$dir/err")"

# Bad input: exit code 2, a message, nothing written.
refused() { # refused NAME PATTERN [options of run]: scene in $dir/scene.yaml
  local name=$1 pattern=$2
  shift 2
  run "$dir/refused" "$@"
  local written=0
  [ -e "$dir/refused" ] && written=1
  { [ "$code" = 2 ] && [ "$written" = 0 ] && grep -q -- "$pattern" "$dir/err"; }
  ok $? "$name: $(head -c 160 "$dir/err")"
}
sed 's/spring: 100/sprin: 100/' "$dir/plain.yaml" >"$dir/scene.yaml"
refused "unknown key" "scene.yaml:1[0-9]:[0-9]*: .*spring"
cp "$dir/plain.yaml" "$dir/scene.yaml"
refused "seed beyond 64 bits" "seed" --seed 18446744073709551616
refused "negative steps" "steps" --steps -5
head -c 2000 "$dir/plain/checkpoint.h5" >"$dir/cut.h5"
{ cat "$dir/plain.yaml"; echo "start: {snapshot: cut.h5}"; } >"$dir/scene.yaml"
refused "truncated snapshot" "cut.h5"
{ cat "$dir/plain.yaml"; echo "start: {snapshot: missing.h5}"; } >"$dir/scene.yaml"
refused "missing snapshot" "missing.h5"

sed 's/spring: 100/spring: 90/' "$dir/plain.yaml" >"$dir/scene.yaml"
run "$dir/plain" --resume --steps 500
same 2 "$code" "a resume with another scene is refused"
cp "$dir/plain.yaml" "$dir/scene.yaml"
run "$dir/plain" --resume --steps 500 --seed 7
same 2 "$code" "a resume with another seed is refused"
run "$dir/nothing" --resume
same 2 "$code" "a resume of nothing is refused"

# A folder that cannot be written; root may write anywhere, so a file stands in its way.
touch "$dir/file"
run "$dir/file/folder"
same 2 "$code" "a folder that cannot be made is refused"

# A full disk: the previous checkpoint survives.
if mkdir "$dir/small" && mount -t tmpfs -o size=2m none "$dir/small" 2>/dev/null; then
  run "$dir/small/run" --steps 10
  before=$(cksum <"$dir/small/run/checkpoint.h5")
  dd if=/dev/zero of="$dir/small/ballast" bs=1k 2>/dev/null
  run "$dir/small/run" --resume --steps 20
  same 4 "$code" "a full disk: exit code 4"
  same "$before" "$(cksum <"$dir/small/run/checkpoint.h5")" "and the previous checkpoint survives"
  umount "$dir/small"
else
  echo "# no tmpfs may be mounted here: full disk not tried"
fi

# A snapshot of a run starts another one.
{ cat "$dir/plain.yaml"; echo "start: {snapshot: plain/checkpoint.h5}"; } >"$dir/scene.yaml"
run "$dir/second" --steps 10
same 0 "$code" "a checkpoint serves as the start of another run"

# A snapshot is given no velocity: it must flow as the scene says.
{ cat "$dir/plain.yaml"; echo "flow: [0.5, -0.25, 0]"; } >"$dir/scene.yaml"
run "$dir/flowing" --steps 20
{ cat "$dir/plain.yaml"; echo "flow: [0.5, -0.25, 0]"; echo "start: {snapshot: flowing/checkpoint.h5}"; } >"$dir/scene.yaml"
run "$dir/flows-on" --steps 10
same 0 "$code" "a snapshot that flows as the scene says"
flow=$(($(wc -l <"$dir/plain.yaml") + 1))
sed -i 's/flowing/plain/' "$dir/scene.yaml"
refused "a flow, and a snapshot at rest" "scene.yaml:$flow:7: flow: the center of mass of 'plain/checkpoint.h5' moves at"
{ cat "$dir/plain.yaml"; echo "flow: [0.01, 0, 0]"; echo "start: {snapshot: plain/checkpoint.h5}"; } >"$dir/scene.yaml"
refused "a flow slower than heat, and a snapshot at rest" "scene.yaml:$flow:7: flow: "
{ cat "$dir/plain.yaml"; echo "start: {snapshot: flowing/checkpoint.h5}"; } >"$dir/scene.yaml"
refused "a snapshot that flows, and no flow" "scene.yaml:$flow:19: flow: .* moves at \[0\.[45]"
bath="hydrodynamics: false, bath: phantoms"
sed "s/^  collision_interval.*/&\n  ${bath//, /\\n  }/" "$dir/plain.yaml" >"$dir/scene.yaml"
{ echo "flow: [0.5, 0, 0]"; echo "start: {snapshot: bath-plain/checkpoint.h5}"; } >>"$dir/scene.yaml"
run "$dir/taken-along" --steps 10
same 0 "$code" "a bath of phantoms takes any snapshot along"

# Every example scene is accepted.
for example in "$top"/scenes/*.yaml; do
  "$uncross" check "$example" >"$dir/out" 2>"$dir/err"
  ok $? "check scenes/${example##*/}"

  # Each goes on from a checkpoint as if it had not stopped.
  name=$(basename "$example" .yaml)
  short=(--set observe.from=0 --quiet)
  "$uncross" run "$example" --out "$dir/$name" "${short[@]}" --steps 24 &&
    "$uncross" run "$example" --out "$dir/$name-parts" "${short[@]}" --steps 13 &&
    "$uncross" run "$example" --out "$dir/$name-parts" "${short[@]}" --steps 24 --resume
  ok $? "scenes/${example##*/} goes on"
  same "$(hash_of "$dir/$name")" "$(hash_of "$dir/$name-parts")" "scenes/${example##*/} in two parts"
  rm -rf "${dir:?}/$name" "$dir/$name-parts"
done
for command in "info $dir/plain/checkpoint.h5" "info $dir/observed/trajectory.h5" "info $dir/plain/run.json" \
  "info $dir/observed/conserved.csv" "export $dir/observed/trajectory.h5" "--help" "--version"; do
  # shellcheck disable=SC2086
  "$uncross" $command >"$dir/out" 2>"$dir/err"
  ok $? "uncross ${command%% *} ${command##*/}"
done
"$uncross" >/dev/null 2>&1
same 2 $? "no command: exit code 2"
"$uncross" info "$dir/file" >/dev/null 2>&1
same 2 $? "info of an empty file: exit code 2"

echo "1..$count"
exit $((failures > 0))

#!/usr/bin/env bash
# kill -9 at random moments, most of them while files are written: after each, the checkpoint must be whole, and the run
# must go on from it; after all of them the final state and the tables must be those of a run without any. Prints TAP.
# Needs: UNCROSS, the program (default build/uncross). KILLS: how many (default 12). SEED: of the moments.
set -u
uncross=$(realpath "${UNCROSS:-build/uncross}")
kills=${KILLS:-12}
RANDOM=${SEED:-$((($(date +%s) ^ $$) & 32767))}
dir=$(mktemp -d)
trap 'chmod -R u+w "$dir"; rm -rf "$dir"' EXIT
count=0
failures=0

ok() { # ok STATUS NAME
  count=$((count + 1))
  if [ "$1" = 0 ]; then echo "ok $count - $2"; else echo "not ok $count - $2"; failures=$((failures + 1)); fi
}
hash_of() { # of a checkpoint: empty if it is not whole, to the last byte
  "$uncross" verify "$1/checkpoint.h5" >"$dir/err" 2>&1 && "$uncross" info "$1/checkpoint.h5" 2>"$dir/err" | sed -n 's/.*state hash \([0-9a-f]*\).*/\1/p'
}
step_of() {
  "$uncross" info "$1/checkpoint.h5" 2>/dev/null | sed -n 's/^  step \([0-9]*\),.*/\1/p'
}

# A checkpoint, a frame and all tables at every step: the run does little but write.
cat >"$dir/scene.yaml" <<YAML
box: [8, 8, 8]
time_step: 0.01
steps: 100000
seed: 5
solvent:
  per_cell: 5
  collision_interval: 0.02
fibers:
  - {name: fiber, count: 20, vertices: 8, mass: 5, bond_length: 0.5, spring: 100, bending: 8}
observe:
  conserved: {every: 1}
  statics: {every: 1}
  dynamics: {every: 1, longest_lag: 20}
trajectory: {every: 5, velocities: true}
checkpoint: {seconds: 1e-9}
YAML

"$uncross" run "$dir/scene.yaml" --out "$dir/run" --steps 1 --quiet
resumed=0
unwritten=0
for ((k = 1; k <= kills; k++)); do
  before=$(step_of "$dir/run")
  "$uncross" run "$dir/scene.yaml" --out "$dir/run" --resume --quiet 2>"$dir/err.$k" &
  began=$(stat -c %i "$dir/run/checkpoint.h5")
  if [ $((k % 2)) = 0 ]; then # half of them once it goes on, however slow the machine; the others whenever it is
    for ((waited = 0; waited < 1000; waited++)); do
      [ "$(stat -c %i "$dir/run/checkpoint.h5")" = "$began" ] || break
      sleep 0.01
    done
  fi
  sleep "0.$(printf '%03d' $((20 + RANDOM % 180)))"
  kill -9 $! 2>/dev/null || { ok 1 "run $k was no longer there: $(head -c 200 "$dir/err.$k")"; break; }
  wait $! 2>/dev/null
  after=$(step_of "$dir/run")
  [ -e "$dir/run/checkpoint.h5.part" ] && unwritten=$((unwritten + 1))
  { [ -n "$after" ] && [ "$after" -ge "$before" ] && [ -n "$(hash_of "$dir/run")" ]; } || {
    ok 1 "after kill $k (step $before, then '$after') the checkpoint is whole: $(head -c 200 "$dir/err")"
    break
  }
  [ "$after" -gt "$before" ] && resumed=$((resumed + 1))
done
[ "$k" -gt "$kills" ]
ok $? "$kills kills ($unwritten of them in the middle of a checkpoint), and the checkpoint is whole after each"
[ "$resumed" -gt 0 ]
ok $? "the runs went on in between ($resumed times, to step ${after:-?})"

# All as if nothing had happened. (A trajectory may have been caught between two writes; it is then set aside, and said so.)
last=$((${after:-0} + 10))
"$uncross" run "$dir/scene.yaml" --out "$dir/run" --resume --quiet --steps "$last" 2>>"$dir/err.all"
ok $? "the killed run ends at step $last"
sed 's/seconds: 1e-9/seconds: 0/' "$dir/scene.yaml" >"$dir/straight.yaml"
"$uncross" run "$dir/straight.yaml" --out "$dir/straight" --quiet --steps "$last"
hash=$(hash_of "$dir/straight")
{ [ -n "$hash" ] && [ "$hash" = "$(hash_of "$dir/run")" ]; }
ok $? "killed or not: the same final state ($hash)"
for table in "$dir/straight"/*.csv; do
  cmp -s "$table" "$dir/run/${table##*/}"
  ok $? "killed or not: the same table ${table##*/}"
done
"$uncross" verify "$dir/run" "$dir/straight" >"$dir/verified"
ok $? "killed or not: all files of the run are whole"
aside=$(find "$dir/run" -name 'trajectory.damaged.*.h5' | wc -l)
echo "# $aside trajectories were caught between two writes and set aside"
"$uncross" info "$dir/run/trajectory.h5" >/dev/null 2>"$dir/err"
ok $? "its trajectory can be read"
echo "1..$count"
exit $((failures > 0))

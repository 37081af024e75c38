#!/usr/bin/env bash
# Help of each command, what --set changes, and --out in all commands that write. Prints TAP.
# Needs: UNCROSS, the program (default build/uncross).
set -u
uncross=$(realpath "${UNCROSS:-build/uncross}")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
count=0
failures=0

ok() { # ok STATUS NAME
  count=$((count + 1))
  if [ "$1" = 0 ]; then echo "ok $count - $2"; else echo "not ok $count - $2"; failures=$((failures + 1)); fi
}
gives() { # gives CODE PATTERN ARGUMENTS ...: the exit code, and a line of standard output or error
  local wanted=$1 pattern=$2
  shift 2
  "$uncross" "$@" >"$dir/out" 2>&1
  local code=$?
  { [ "$code" = "$wanted" ] && grep -q -- "$pattern" "$dir/out"; }
  ok $? "uncross ${*//"$dir"\//}: $code, $pattern"
}
lacks() { # lacks PATTERN: in what was said last
  ! grep -q -- "$1" "$dir/out"
  ok $? "... without $1"
}

gives 0 '^  uncross run SCENE --out DIR \[options\]  *runs' --help
gives 0 '^  8  oracle judge: cannot tell' help
for command in check map run sweep info schema export topology crossings analyze plot 'oracle emit' 'oracle trace' 'oracle dump' 'oracle compare' 'oracle judge'; do
  # shellcheck disable=SC2086
  gives 0 "^usage: uncross $command" $command --help
  cp "$dir/out" "$dir/first"
  # shellcheck disable=SC2086
  "$uncross" help $command >"$dir/out" && cmp -s "$dir/out" "$dir/first"
  ok $? "uncross help $command says the same"
  grep -q '^  0  done$' "$dir/out" && grep -q '^  -h, --help ' "$dir/out"
  ok $? "... with exit codes and options"
done
gives 0 '^  --seed S .* (0 \.\. 2^64-1)$' run -h
gives 0 '^  5  interrupted' run --help
lacks '^  6  '
lacks 'stride'
gives 0 '^  -o, --out DIR ' analyze --help
gives 0 '^  -o, --out FILE ' export --help
lacks '--resume'
gives 0 '^  --false-alarm P .* (1e-09 \.\. 0.5)$' oracle judge --help
gives 0 '^  uncross oracle emit SCENE' oracle --help
gives 2 'unknown command fly' help fly
gives 2 "oracle: no such action: fly; .uncross oracle --help" oracle fly
gives 2 'oracle: no such action: (none given)' oracle
gives 2 ".uncross run --help. lists" run
gives 2 'oracle emit: --out FILE is missing' oracle emit scene.yaml
gives 2 'two files are needed' oracle compare one
gives 2 '--false-alarm 0.6: not a number from 1e-09 to 0.5' oracle judge a b --false-alarm 0.6
gives 2 '--steps 9223372036854775808: not a whole number from 0 to 9223372036854775807' run a -o b --steps 9223372036854775808
gives 2 'schema: takes no file' schema scene.yaml

cat >"$dir/scene.yaml" <<YAML
box: [4, 4, 4]
time_step: 0.01
steps: 4
seed: 1
solvent: {per_cell: 3, collision_interval: 0.02}
fibers:
  - {name: a, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100, bending: 4}
crossing: {rule: sequential}
trajectory: {every: 2, velocities: true}
YAML
sed 's/per_cell: 3/per_cell: 5/; s/count: 2/count: 3/' "$dir/scene.yaml" >"$dir/other.yaml"
hash_of() {
  sed -n 's/.*"state_hash": "\([0-9a-f]*\)".*/\1/p' "$1/run.json"
}
"$uncross" run "$dir/scene.yaml" -o "$dir/set" --set solvent.per_cell=5 --quiet --set fibers.0.count=3
ok $? "run -o DIR --set ... --set ..."
"$uncross" run "$dir/other.yaml" --out "$dir/other" --quiet
[ -n "$(hash_of "$dir/set")" ] && [ "$(hash_of "$dir/set")" = "$(hash_of "$dir/other")" ]
ok $? "what is set is as if the scene said it"
"$uncross" run "$dir/scene.yaml" -o "$dir/set" --resume --quiet --steps 6 --set solvent.per_cell=5 --set fibers.0.count=3
ok $? "and so it is in a resumed run"
gives 2 'solvent.per_cell is 3 there, 5 in the run so far' run "$dir/scene.yaml" -o "$dir/set" --resume --steps 8
gives 0 'per_cell: 7' check "$dir/scene.yaml" --set solvent.per_cell=7
gives 2 'per_cel' check "$dir/scene.yaml" --set solvent.per_cel=7
gives 2 "--set fibers.a.mass=3: 'mass' is set already, by '--set fibers.0.mass=2'; allowed: one of them" check "$dir/scene.yaml" --set fibers.0.mass=2 --set fibers.a.mass=3
gives 2 "'seed' is set already, by '--set seed=2'" run "$dir/scene.yaml" --out "$dir/never" --set seed=2 --set seed=2
gives 2 "run: --steps 5 and --set steps=6 are one key; allowed: one of them" run "$dir/scene.yaml" --out "$dir/never" --steps 5 --set steps=6
gives 2 "run: --seed 5 and --set seed=6 are one key; allowed: one of them" run "$dir/scene.yaml" --out "$dir/never" --set seed=6 --seed 5
gives 2 'requires an argument' check "$dir/scene.yaml" --set
for words in "export $dir/set/trajectory.h5" "oracle emit $dir/scene.yaml" "oracle trace $dir/scene.yaml"; do
  for option in -o --out; do
    rm -f "$dir/written"
    # shellcheck disable=SC2086
    "$uncross" $words $option "$dir/written" && [ -s "$dir/written" ]
    ok $? "${words%% /*} $option FILE"
  done
done
rm -f "$dir/pack.h5"
"$uncross" oracle emit "$dir/scene.yaml" -o "$dir/pack.h5" && "$uncross" oracle dump "$dir/pack.h5" --out "$dir/text" && [ -s "$dir/text" ]
ok $? "oracle dump --out FILE"
"$uncross" analyze "$dir/set/trajectory.h5" -o "$dir/tables"
ok $? "analyze -o DIR"
if [ -w /dev/full ]; then
  for words in "help" "run --help" "schema" "oracle --help"; do
    # shellcheck disable=SC2086
    "$uncross" $words >/dev/full 2>"$dir/err"
    { [ $? = 4 ] && grep -q 'standard output: cannot write' "$dir/err"; }
    ok $? "uncross $words to a full device: exit code 4"
  done
fi
echo "1..$count"
exit $((failures > 0))

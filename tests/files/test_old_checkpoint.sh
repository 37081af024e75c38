#!/bin/bash
# A checkpoint of an earlier program resumes to the state that the earlier program reaches: keys that have been added and
# defaults that have changed since then make no difference.
#
# tests/files/old was made by the program of commit af01d53, which then went on by itself:
#   uncross run tests/files/old/scene.yaml --out a               (state hash e32928c5f9c6f083 at step 20; checkpoint.h5 kept)
#   uncross run tests/files/old/scene.yaml --out a --resume --steps 200         (state hash 1ab491b309b4eb0d)
set -euo pipefail
uncross=${UNCROSS:?} folder=$(mktemp -d "${BUILD:?}/old.XXXXXX")
trap 'rm -rf "$folder"' EXIT
failed=0

expect() { # what, wanted, found
  [ "$2" = "$3" ] || { echo "$1: expected '$2', found '$3'"; failed=1; }
}

cp tests/files/old/checkpoint.h5 "$folder"
said=$("$uncross" run tests/files/old/scene.yaml --out "$folder" --resume --steps 200 | sed -n 's/^state hash //p')
expect "an old checkpoint goes on" 1ab491b309b4eb0d "$said"

# another scene is told
cp tests/files/old/checkpoint.h5 "$folder"
if message=$("$uncross" run tests/files/old/scene.yaml --set time_step=0.005 --set solvent.collision_interval=0.015 \
  --out "$folder" --resume 2>&1); then
  echo "a checkpoint of another time step was resumed"
  failed=1
fi
case $message in
  *"time step"* | *"is of another scene than tests/files/old/scene.yaml"*) ;;
  *) expect "the message" "... is of another scene than ..." "$message" ;;
esac

# the same keys, set from outside, are the same scene
said=$("$uncross" run tests/files/old/scene.yaml --set fibers.rods.mass=3.3 --out "$folder" --resume --steps 200 |
  sed -n 's/^state hash //p')
expect "a setting that changes nothing" 1ab491b309b4eb0d "$said"

exit $failed

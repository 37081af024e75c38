#!/usr/bin/env bash
# tests/faults/test_power.py with every state that it finds, and two sequences of choices.
for seed in ${SEEDS:-1 2}; do
  SEED=$seed POWER=${POWER:-0} /usr/bin/python3 "$(dirname "$0")/../faults/test_power.py" || exit 1
done

#!/usr/bin/env bash
# tests/faults/test_program.py with 25 times as many failures.
FAULTS=250 exec /usr/bin/python3 "$(dirname "$0")/../faults/test_program.py"

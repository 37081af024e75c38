#!/usr/bin/env bash
# tests/faults/test_program.py with every single call of HDF5.
FAULTS=all exec /usr/bin/python3 "$(dirname "$0")/../faults/test_program.py"

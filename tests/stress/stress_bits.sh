#!/usr/bin/env bash
# The same bits from both compilers, each for any processor and for this one. Needs UNCROSS.
BITS=all exec bash "$(dirname "$0")/../cli/test_bits.sh"

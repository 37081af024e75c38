#!/usr/bin/env bash
# tests/cli/test_kill.sh with 200 kills.
KILLS=${KILLS:-200} exec bash "$(dirname "$0")/../cli/test_kill.sh"

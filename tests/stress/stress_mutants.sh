#!/usr/bin/env bash
# Bugs made at random (tools/mutants --generic): most are seen. Those that nothing sees are listed, for a
# human to judge (docs/mutants.md). Prints TAP. $1: how many, 12 unless told; $2: the seed.
set -u
top=$(cd "$(dirname "$0")/../.." && pwd)
log=$(mktemp)
trap 'rm -f "$log"' EXIT
"$top/tools/mutants" --generic "${1:-12}" --seed "${2:-3}" --build "${BUILD:-build}/generic" >"$log" 2>&1 && status=0 || status=1
sed 's/^/# /' "$log"
killed=$(grep -cE '^ *[0-9.]+ s  killed ' "$log")
survived=$(grep -cE '^ *[0-9.]+ s  SURVIVED ' "$log")
verdict="not ok"
if [ "$status" = 0 ] && [ "$killed" -gt "$survived" ]; then verdict=ok; fi
echo "$verdict 1 - $killed bugs seen, $survived not"
echo "1..1"
[ "$verdict" = ok ]

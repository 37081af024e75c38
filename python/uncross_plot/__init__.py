"""Pages of runs: `uncross plot` (docs/running.md). It reads files only, so it needs no library of uncross."""

"""Pages of runs: `uncross plot` (docs/plot.md). It reads files only, so it needs no library of uncross."""

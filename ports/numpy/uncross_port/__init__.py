"""A second implementation of uncross, in NumPy, written from docs/porting.md and docs/conventions.md alone."""

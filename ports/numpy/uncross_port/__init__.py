"""A second implementation of uncross, in NumPy, written from docs/port/contract.md and docs/conventions.md alone."""

"""Runs a scene over a grid of values and seeds, and averages: docs/running.md.

grid: which runs; jobs: processes; averages: tables; slurm: the same as a job array; files: what the campaign of
validation/ shares with it.
"""

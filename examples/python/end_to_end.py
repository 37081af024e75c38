"""A scene from a file, a thousand steps, and the end-to-end distance of its fibers.

usage: python3 end_to_end.py SCENE [STEPS]
"""
import sys

import numpy as np
import uncross


def end_to_end(run):
    """Root mean square over all open fibers, in a0."""
    first, last = run.first[:-1], run.first[1:] - 1
    is_open = run.next[last] < 0
    vector = (run.positions[last] - run.positions[first])[is_open] * uncross.LATTICE_UNIT
    return np.sqrt((vector**2).sum(axis=1).mean())


run = uncross.Run(sys.argv[1]).advance(int(sys.argv[2]) if len(sys.argv) > 2 else 1000)
print(f"step {run.step}, hash {run.hash:016x}, end-to-end distance {end_to_end(run):.6f} a0")

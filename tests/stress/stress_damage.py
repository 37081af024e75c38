"""Damaged checkpoints, trajectories and packs, through every reader (tests/files/damage.py).

usage: stress_damage.py [FLIPS CUTS SEED]      needs UNCROSS; prints one line of counts
"""
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "files"))
import damage  # noqa: E402  (found by the line above)


def main():
    flips, cuts, seed = (int(word) for word in sys.argv[1:4]) if len(sys.argv) > 3 else (2700, 675, 2026)
    with tempfile.TemporaryDirectory() as folder:
        bench = damage.Bench(folder)
        wrong = bench.attack(flips, cuts, seed)
    for line in wrong[:50]:
        print(line)
    print(", ".join(f"{bench.counts[key]} {key}" for key in (
        "flips", "cuts", "readings", "crashes", "hangs", "wrong results accepted", "accepted, same result",
        "isolated deaths")))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

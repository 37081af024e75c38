"""Crossings of bonds between two frames: `uncross crossings` finds pairs and decides what it can, exact.py the rest."""
import collections
import os
import subprocess

from . import exact, frame

Crossing = collections.namedtuple("Crossing", "bonds image sign t s other")  # s, other: fractions of the first bond and of the second
Touch = collections.namedtuple("Touch", "bonds image")

# crossings: [Crossing]; touches: [Touch]. count: {(bonds, image): (crossings, net)} of all pairs with one, ties broken by exact.perturbed.
# looked_at: pairs; near: those of them that are nearer at the first frame than was asked.
Between = collections.namedtuple("Between", "crossings touches count looked_at near")


class Ended(Exception):
    """The other program has ended, with this exit code: above 0 if it has said why."""


class Finder:
    def __init__(self, topology):
        self.bonds = [tuple(bond) for bond in topology.bonds.tolist()]
        self.ids = topology.ids
        self.child = subprocess.Popen([os.environ.get("UNCROSS", "uncross"), "crossings"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._send(b"%d %d\n" % (len(topology.ids), len(self.bonds)), topology.bonds.astype("<u4").tobytes())

    def _send(self, *parts):
        try:
            for part in parts:
                self.child.stdin.write(part)
            self.child.stdin.flush()
        except BrokenPipeError:
            raise Ended(self.child.wait()) from None

    def close(self):
        self.child.stdout.close()
        self.child.kill()  # it has nothing to lose
        self.child.wait()
        self.child.stdin.close()

    def between(self, first, last, near=0):
        """Two frames, one after the other. near: lattice units."""
        numbers = (*first.edge, *last.edge, *map(int, first.periodic), first.offset, last.offset, near)
        self._send((" ".join(map(str, numbers)) + "\n").encode(), first.position.astype("<i8").tobytes(), last.position.astype("<i8").tobytes())
        found, touches, count = [], [], collections.defaultdict(lambda: (0, 0))
        while True:
            word, *rest = self.child.stdout.readline().split() or [b""]
            if word == b"done":
                return Between(found, touches, dict(count), *map(int, rest))
            if word == b"far":
                raise frame.Refused("moves between two frames, or bonds, reach through so many images of the box that they cannot be looked at; "
                                    "are positions unwrapped in the same way in all frames?")
            if word not in (b"crossed", b"unsure"):
                raise Ended(self.child.wait())
            i, j, *image = map(int, rest[:5])
            pair = (i, j), tuple(image)
            if word == b"crossed":
                crossings, counted = [(int(rest[5]), *map(float, rest[6:]))], None
            else:
                crossings, touched, counted = self._decide(first, last, *pair)
                touches += [Touch(*pair)] if touched else []
            found += [Crossing(*pair, *crossing) for crossing in crossings]
            signs = [crossing[0] for crossing in (crossings if counted is None else counted)]
            if signs:
                count[pair] = count[pair][0] + len(signs), count[pair][1] + sum(signs)

    def _decide(self, first, last, bonds, image):
        """Crossings, whether they touch, and the crossings that count for parity: None if they are the same."""
        (a, b), (c, d) = (self.bonds[k] for k in bonds)
        shared = {a, b} & {c, d} if not any(image) else ()
        places = [[place(f, vertex, image if k > 1 else (0, 0, 0)) for f in (first, last)] for k, vertex in enumerate((a, b, c, d))]
        vector = lambda x, y: exact.linear(*([v - u for u, v in zip(places[x][t], places[y][t])] for t in (0, 1)))
        if shared:
            p, q = (b in shared) and (1, 0) or (0, 1), (d in shared) and (3, 2) or (2, 3)
            return [], exact.folds(vector(*p), vector(*q)), []
        found = exact.meetings(vector(0, 1), vector(2, 3), vector(0, 2))
        if not found.touched:
            return found.crossings, False, None
        ties = exact.perturbed([int(self.ids[vertex]) for vertex in (a, b, c, d)], places) if bonds[0] != bonds[1] else found
        return found.crossings, True, ties.crossings


def place(f, vertex, image):
    return [x + shift for x, shift in zip(f.position[vertex].tolist(), frame.image(f, image))]

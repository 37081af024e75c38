"""Images of a point force between two walls, in a box that is periodic along them.

A force along x acts on a Stokes fluid between walls at y = 0 and y = H, at the height y. Seen along the walls, the velocity there is a sum of
waves; those across their wave vector k (transverse) and those along it (longitudinal) are solutions of ordinary equations in y. A periodic
box has the waves k = 2 pi (i, j)/L, the fluid without images has all. All mobilities are in 1/(eta a0).
"""
import math

import numpy
from scipy import integrate

WIDTH = 1.0  # a0, of a Gaussian by which the force is spread: the images, L away, do not see it


def transverse(k, height, distance):
    """u'' - k^2 u = -delta, u = 0 at the walls: sinh(k y) sinh(k (H - y))/(k sinh(k H))."""
    near, far = math.expm1(-2.0 * k * height), math.expm1(-2.0 * k * (distance - height))
    return near * far / (-2.0 * k * math.expm1(-2.0 * k * distance))


def clamped(k, y):
    """The two stream functions that vanish at y = 0 with their slopes, and three derivatives of each, over exp(k y)."""
    sinh, cosh = -0.5 * math.expm1(-2.0 * k * y), 0.5 * (1.0 + math.exp(-2.0 * k * y))
    return numpy.array([[y * sinh, sinh + k * y * cosh, 2.0 * k * cosh + k * k * y * sinh, 3.0 * k * k * sinh + k**3 * y * cosh],
                        [k * y * cosh - sinh, k * k * y * sinh, k * k * sinh + k**3 * y * cosh, 2.0 * k**3 * cosh + k**4 * y * sinh]])


def longitudinal(k, height, distance):
    """(D^2 - k^2)^2 psi = -delta', u = psi': at the force psi'' jumps by -1, the rest is continuous."""
    below, above = clamped(k, height), clamped(k, distance - height) * [1.0, -1.0, 1.0, -1.0]
    parts = numpy.linalg.solve(numpy.vstack([below, -above]).T, [0.0, 0.0, 1.0, 0.0])
    return float(parts[:2] @ below[:, 1])


def images(height, distance, length):
    """What the images in a box of `length` along both directions add to the mobility along the walls.

    The mean flow (k = 0) is that of a force without a gradient of pressure, so transverse. Without images half of the waves of smallest
    k are longitudinal: these carry no flow through the slit. The difference is H w^2/(24 L^2), w = 6 (y/H) (1 - y/H)."""
    least = 1e-4 / distance

    def mean(k):
        k = max(k, least)
        return 0.5 * (transverse(k, height, distance) + longitudinal(k, height, distance)) * math.exp(-(k * WIDTH)**2)

    most = math.ceil(6.0 / WIDTH * length / (2.0 * math.pi))
    steps = numpy.arange(-most, most + 1)
    squares, times = numpy.unique(numpy.add.outer(steps**2, steps**2), return_counts=True)
    box = sum(n * mean(2.0 * math.pi * math.sqrt(q) / length) for q, n in zip(squares, times)) / length**2
    alone = integrate.quad(lambda k: k * mean(k), 0.0, 8.0 / WIDTH, limit=400, epsrel=1e-11)[0] / (2.0 * math.pi)
    flow = 0.5 * (transverse(least, height, distance) - longitudinal(least, height, distance))
    return box - alone + flow / length**2

"""lib/flow.py against numbers that were worked out by hand or elsewhere, and against a simulated fluctuating fluid."""
import math
import pathlib
import sys
import tempfile
import types
import unittest

import numpy

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "validation"))

from lib import dumbbells, flow, runs
from lib.flow_runs import POINTS, Point


class Theory(unittest.TestCase):
    def test_viscosities(self):
        """To four digits where they are formulas; those of AT+a come from averages that are known to 0.7 %."""
        table = {("2d-n10", "srd"): 37.5113, ("2d-n10", "at-a"): 37.6224, ("2d-n10", "at+a"): 17.869, ("2d-n3", "at-a"): 8.599,
                 ("2d-n3", "at+a"): 3.459, ("3d-n5", "srd"): 2.4959, ("3d-n5", "at-a"): 3.7129, ("3d-n5", "at+a"): 1.7653,
                 ("3d-n10", "srd"): 25.085, ("3d-n10", "at-a"): 37.622, ("3d-n10", "at+a"): 16.95}
        for (name, rule), expected in table.items():
            with self.subTest(name=name, rule=rule):
                self.assertAlmostEqual(sum(flow.viscosity(POINTS[name], rule)) / expected, 1.0, delta=2e-4)

    def test_milne(self):
        """b of the integral; bounce-back takes 0.0177 at the point of the walls."""
        k = numpy.linspace(1e-3, 4000.0, 4000001)
        sinc = numpy.sinc(k / (2.0 * math.pi))
        integrand = numpy.log(12.0 * (1.0 - sinc * sinc) / k**2) / k**2
        rest = (2.0 * math.log(k[-1]) + 2.0 - math.log(12.0)) / k[-1]  # of -ln(12/k^2)/k^2 beyond
        b = -(numpy.trapezoid(integrand, k) if hasattr(numpy, "trapezoid") else numpy.trapz(integrand, k)) / math.pi + rest / math.pi
        # below k[0] the integrand is -1/15 + O(k^2) ... (1 - sinc^2 = k^2/12 - k^4/360)
        b += k[0] / 30.0 / math.pi
        self.assertAlmostEqual(b, flow.MILNE, delta=2e-6)
        self.assertAlmostEqual(flow.slip_length(POINTS["2d-n10"], "at-a"), 0.2097, delta=1e-4)

    def test_oscillation(self):
        """Shear rate in the middle over the walls', n 10, eta 37.62, L 20: amplitude and phase in degrees."""
        for omega, slip, expected in ((0.01, 0.0, (0.9996, -2.54)), (0.05, 0.0, (0.9903, -12.64)), (0.2, 0.0, (0.8700, -48.16)),
                                      (0.01, 0.21, (0.9790, -2.64)), (0.2, 0.21, (0.8431, -49.94))):
            with self.subTest(omega=omega, slip=slip):
                v = flow.oscillating(numpy.array([10.0 - 1e-3, 10.0 + 1e-3]), 20.0, 37.62, slip, 10.0 * omega)
                rate = (v[1] - v[0]) / 2e-3 * 10.0
                self.assertAlmostEqual(abs(rate), expected[0], delta=2e-4)
                self.assertAlmostEqual(math.degrees(numpy.angle(rate)), expected[1], delta=0.01)


class Response(unittest.TestCase):
    def test_solves_its_equation(self):
        """-eta g'' + i rho omega g = delta: by finite differences, between walls and in a periodic box."""
        y, eta = (numpy.arange(400) + 0.5) * 0.05, 3.0
        for rho_omega in (0.0, 2.0):
            g = flow.between_walls(y, 20.0, eta, 0.3, rho_omega)
            operator = (2.0 * g[1:-1] - g[:-2] - g[2:]) * eta / 0.05**2 + 1j * rho_omega * g[1:-1]
            delta = numpy.eye(400)[1:-1] / 0.05
            self.assertLess(abs(operator - delta).max() * 0.05, 1e-2)
            slope = (g[1, 200] - g[0, 200]) / 0.05  # extrapolated, it vanishes at -b
            self.assertAlmostEqual(abs(g[0, 200] - slope * (y[0] + 0.3)), 0.0, delta=1e-3)
        g = flow.periodic(y, 20.0, eta)
        operator = (2.0 * g - numpy.roll(g, 1, 0) - numpy.roll(g, -1, 0)) * eta / 0.05**2
        self.assertLess(abs(operator - numpy.eye(400) / 0.05 + 0.05).max() * 0.05, 1e-2)  # less the mean force

    def test_covariance_of_averages(self):
        """A chain of slabs that exchange momentum at random (Ornstein and Uhlenbeck), between walls at rest: averages over a long time
        scatter as `between_walls` says."""
        rng = numpy.random.default_rng(5)
        slabs, eta, rho, area, dt, steps, replicas = 8, 2.0, 5.0, 3.0, 0.05, 4000, 400
        v, total = numpy.zeros((replicas, slabs)), numpy.zeros((replicas, slabs))
        for _ in range(steps):
            # stresses at the faces: walls half a slab away, of twice the gradient and twice the variance
            edge = numpy.concatenate([numpy.zeros((replicas, 1)), v, numpy.zeros((replicas, 1))], axis=1)
            width = numpy.array([0.5] + [1.0] * (slabs - 1) + [0.5])
            noise = rng.normal(size=(replicas, slabs + 1)) * numpy.sqrt(2.0 * eta / (area * width * dt))
            stress = eta * numpy.diff(edge, axis=1) / width + noise
            v = v + dt / rho * numpy.diff(stress, axis=1)
            total += v
        y, time = numpy.arange(slabs) + 0.5, steps * dt
        found = numpy.cov((total / steps).T)
        expected = 2.0 / (area * time) * flow.between_walls(y, float(slabs), eta, 0.0)
        self.assertLess(abs(found - expected).max() / expected.max(), 0.25)  # variances of 400 values scatter by 7 %; time is 12 relaxations
        self.assertGreater((found / expected)[3:5, 3:5].mean(), 0.75)

    def test_fit(self):
        """Correlated errors: the covariance of the coefficients is what replicas scatter by."""
        y, rng = numpy.arange(10) + 0.5, numpy.random.default_rng(6)
        covariance = flow.between_walls(y, 10.0, 1.0, 0.2).real + 0.1 * numpy.eye(10)
        root = numpy.linalg.cholesky(covariance)
        basis = [numpy.ones(10), y]
        fits = [flow.generalised(basis, 1.0 + 2.0 * y + root @ rng.normal(size=10), covariance) for _ in range(2000)]
        values = numpy.array([fit.value for fit in fits])
        self.assertLess(abs(values.mean(axis=0) - [1.0, 2.0]).max(), 5.0 * fits[0].error.max() / math.sqrt(2000))
        self.assertLess(abs(numpy.cov(values.T) / fits[0].covariance - 1.0).max(), 0.15)
        self.assertLess(abs(numpy.mean([fit.chi2 for fit in fits]) - 8.0), 0.4)

    def test_curve(self):
        y = numpy.linspace(0.1, 1.0, 10)
        p, _ = flow.curve(lambda p: p[0] - p[1] * y**p[2], (1.0, 0.2, 2.0), 1.1 - 0.3 * y**3.0, numpy.eye(10))
        self.assertLess(abs(p - [1.1, 0.3, 3.0]).max(), 1e-6)

    def test_heat_conductivity(self):
        self.assertAlmostEqual(sum(flow.heat_conductivity(Point(2, 10, 0.1))), 20.0 * (0.05 * 1.2 + 1.0 / 12.0), delta=1e-9)


class Series(unittest.TestCase):
    def test_oscillation_of_a_series_that_was_thinned(self):
        """Rows are means over their own intervals, two or four of them may have become one: G' and G'' stay."""
        every, rows, period, storage, loss = 0.02, 40, 0.8, 3.0, 5.0
        omega = 2.0 * math.pi / period

        def integral(time):
            return (-storage * math.cos(omega * time) + loss * math.sin(omega * time)) / omega

        lines = [f"{row},{row * every},{(integral(row * every) - integral((row - 1) * every)) / every!r}" for row in range(1, 20 * rows + 1)]
        text = f"shear: {{period: {period}}}\nobserve: {{from: 0, stress: {{every: 1}}}}\ntime_step: {every}\n"
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "stress.csv"
            for together in (1, 2, 4):
                path.write_text("\n".join(["step,time,sigma_xy", *lines]) + "\n")
                runs.thin(path, 20 * rows // together)
                columns = numpy.genfromtxt(path, delimiter=",", names=True)
                self.assertEqual(len(columns), 20 * rows // together)
                result = types.SimpleNamespace(table=lambda name, columns=columns: columns, run=types.SimpleNamespace(scene_text=text))
                _, values = dumbbells.harmonic(result, "sigma_xy")
                self.assertAlmostEqual(values.mean().real, loss, delta=1e-9)
                self.assertAlmostEqual(-values.mean().imag, storage, delta=1e-9)
                self.assertEqual(len(values), 20)


if __name__ == "__main__":
    unittest.main()

"""What a flow of the solvent comes to: its profile beside theory, and viscosity, slip and moduli from profile and stress.

Formulas: docs/flow.md and docs/observables.md. Theory is that of `uncross check`.
"""
import dataclasses
import math
import re

import numpy

from . import tables

BULK = 0.6  # part of the gap in the middle, where the slope between walls is taken
BETWEEN = 1.0  # a0: at walls the parabola is not fitted nearer than this


@dataclasses.dataclass
class Measured:
    """A number with a bound of its standard error; theory, or nan. fluid: what theory is of, if it is not all that flows here. over:
    in a suspension, the viscosity of the solvent alone."""
    name: str
    value: float
    error: float
    unit: str = ""
    theory: float = math.nan
    source: str = ""
    fluid: str = ""
    over: float = math.nan


EXACT = ("slope of the profile",)  # of the box itself: it holds for a suspension, too


class Numbers(dict):
    """{name: value} of `uncross check`, which leaves out what means nothing in a scene: nan."""

    def __missing__(self, _):
        return numpy.float64(math.nan)


class Flow:
    """The flow of a run; `kind` is empty if there is none, or no profile."""

    def __init__(self, run):
        self.numbers, self.sources, self.kind = Numbers(), {}, ""
        for heading, rows in run.derived:
            if heading.startswith(("Solvent", "Dumbbells", "Walls", "Shear", "Flow by", "Suspension")):
                self.numbers.update({row.name: numpy.float64(row.value) for row in rows})
                self.sources.update({row.name: row.source for row in rows})
            if heading.startswith(("Walls", "Shear", "Flow by")):
                self.kind = heading.split()[0].lower()
        self.profile, self.stress, self.shape_of_dumbbells = run.table("profile"), run.table("stress"), run.table("dumbbells")
        if self.profile is None or self.profile.rows < 4 or "y" not in self.profile.data or "viscosity" not in self.numbers:
            self.kind = ""
            return
        places = self.profile.data["y"]
        begins = re.search(r"(?m)^ +from: (\d+)", run.scene)
        self.begins = float(begins[1]) if begins else 0.0  # the step at which averages begin
        self.edge = places[-1] + places[0]
        self.oscillates = "vx_in_phase" in self.profile.data
        self.eta_alone = self.numbers["viscosity"]
        self.eta = self.numbers.get("viscosity of the loaded fluid", self.eta_alone)  # with loose vertices
        self.slip = self.numbers.get("slip length", 0.0)

    # --- theory ---

    @property
    def force(self):
        """Body force per volume, kT/a0^4, from the largest velocity that `uncross check` expects."""
        if "largest velocity by the force" in self.numbers:
            return self.numbers["largest velocity by the force"] * 8.0 * self.eta / self.edge**2 / (1.0 + 4.0 * self.slip / self.edge)
        if "largest velocity" in self.numbers:
            return self.numbers["largest velocity"] * self.eta * (self.wave**2 if self.is_sine else 32.0 / self.edge**2)
        return 0.0

    @property
    def wave(self):
        return 2.0 * math.pi / self.edge

    @property
    def is_sine(self):
        return "k^2" in self.sources.get("largest velocity", "")

    def shape(self, y):
        """The velocity of a force with a profile, for a force per volume and a viscosity of 1."""
        if self.is_sine:
            return numpy.sin(self.wave * y) / self.wave**2
        half, within = 0.5 * self.edge, y % (0.5 * self.edge)
        return numpy.where(y < half, 1.0, -1.0) * 0.5 * within * (half - within)

    def expected(self, y):
        """v_x at these places, of a steady flow; None without theory."""
        if self.oscillates or not self.kind:
            return None
        with numpy.errstate(all="ignore"):
            return self._steady(y, y - 0.5 * self.edge)

    def _steady(self, y, about):
        if self.kind == "shear":
            return self.numbers["shear rate"] * about
        if self.kind == "flow":
            return self.force / self.eta * self.shape(y)
        rate = self.numbers.get("effective shear rate", 0.0)
        if "slip length" not in self.numbers:
            return None
        return rate * about + self.force / (2.0 * self.eta) * (y * (self.edge - y) + self.slip * self.edge)

    # --- what was measured ---

    def fit(self, columns, name="vx", inside=None):
        """[(coefficient, bound of its error)] of least squares in these columns. Slabs move together, so that their errors
        may add up: the bound is their sum, as if they always did."""
        inside = slice(None) if inside is None else inside
        values, errors = self.profile.column(name)[inside], self.profile.bars(name)[inside]
        weights = numpy.linalg.pinv(numpy.array([c[inside] for c in columns]).T)
        return [(w @ values, abs(w) @ errors) for w in weights]

    def mean_stress(self, *names):
        """Mean over the rows from `observe: from` on, and its error."""
        rows = numpy.mean([self.stress.column(n) for n in names], axis=0)[self.stress.column("step") > self.begins]
        rows = rows[numpy.isfinite(rows)]
        return (rows.mean(), tables.blocked_error(rows)) if len(rows) else (math.nan, math.nan)

    def measured(self):
        """Without what is no number: a quotient by 0, or of a column or a number that is not there."""
        if not self.kind:
            return []
        with numpy.errstate(all="ignore"):
            return [one for one in self._of_suspension(self._found()) if math.isfinite(one.value)]

    def _found(self):
        if self.oscillates:
            return self._response() + (self._moduli() if self.kind == "shear" else [])
        return {"walls": self._walls, "shear": self._shear, "flow": self._driven}[self.kind]()

    @property
    def is_suspension(self):
        return self.numbers.get("vertices", 0.0) > 0.0

    def _of_suspension(self, found):
        """With fibers in the solvent, theory is that of loose vertices in it; bonds make it another fluid, and nobody knows the slip.
        What all of them add to the solvent is eta_r."""
        if not self.is_suspension:
            return found
        told, loaded = [], self.numbers["... over that of the solvent"]
        for one in found:
            known = math.isfinite(one.theory) and one.name not in EXACT
            fluid = self.fluid if one.name != "slip length" else "solvent alone"
            if one.name != "viscosity":
                told.append(dataclasses.replace(one, fluid=fluid if known else ""))
                continue
            loose = f"; loose vertices would make it {loaded:.4g}" if math.isfinite(loaded) and fluid else ""
            told += [dataclasses.replace(one, fluid=fluid if known else "", over=self.eta_alone),
                     Measured("viscosity over the solvent's, η_r", one.value / self.eta_alone, one.error / self.eta_alone,
                              source=f"{one.source}, over that of the solvent alone{loose}")]
        return told

    @property
    def fluid(self):
        """What theory is of; empty if it is all that flows here."""
        if not self.is_suspension:
            return ""
        loaded = "viscosity of the loaded fluid" in self.numbers
        return "solvent alone" if not loaded else "loose vertices" if self.numbers.get("bonds", 0.0) > 0.0 else ""

    def _over(self, stress, rate, name, source):
        value = stress[0] / rate[0]
        error = abs(value) * math.hypot(stress[1] / stress[0], rate[1] / rate[0])
        return Measured(name, value, error, "m/a0 t0", self.eta, source)

    def _walls(self):
        about = self.profile.data["y"] - 0.5 * self.edge
        one, half = numpy.ones_like(about), 0.5 * self.edge
        found = []
        applied = self.numbers.get("shear rate of the walls", 0.0)
        if self.force:
            inside = abs(about) < half - BETWEEN
            (top, top_error), _, (bend, bend_error) = self.fit([one, about, about**2], inside=inside)
            relative = abs(bend_error / bend)
            reach = math.sqrt(max(0.0, -top / bend))
            found += [Measured("largest velocity by the force", top, top_error, "a0/t0",
                               self.numbers["largest velocity by the force"], "parabola"),
                      Measured("viscosity", -0.5 * self.force / bend, abs(0.5 * self.force / bend) * relative, "m/a0 t0", self.eta,
                               "curvature of the parabola")]
            if not applied:
                found.append(Measured("slip length", reach - half, 0.5 * reach * (relative + abs(top_error / top)), "a0",
                                      self.numbers["slip length"], "where the parabola is 0"))
        if applied:
            inside = abs(about) < BULK * half
            slope = self.fit([one, about], inside=inside)[1]
            found.append(Measured("shear rate in the bulk", *slope, "1/t0", self.numbers["effective shear rate"],
                                  f"slope in the middle {100 * BULK:.0f} % of the gap"))
            found.append(Measured("slip length", half * (applied / slope[0] - 1.0), half * applied / slope[0]**2 * slope[1], "a0",
                                  self.numbers["slip length"], "L/2 (rate of the walls/rate in the bulk - 1)"))
            if self.stress is not None and not self.force:
                found.append(self._over(self.mean_stress("sigma_lower", "sigma_upper"), slope, "viscosity",
                                        "stress on the walls over the rate in the bulk"))
                if "sigma_xy" in self.stress.data:
                    found.append(self._over(self.mean_stress("sigma_xy"), slope, "viscosity",
                                            "stress in the bulk over the rate in the bulk"))
        return found + ([] if self.force else self._normal())  # stress.csv is relative to a linear flow

    def _shear(self):
        about = self.profile.data["y"] - 0.5 * self.edge
        rate = self.numbers["shear rate"]
        slope = self.fit([numpy.ones_like(about), about])[1]
        found = [Measured("slope of the profile", *slope, "1/t0", rate, "all slabs")]
        if self.stress is not None and "sigma_xy" in self.stress.data:
            found.append(self._over(self.mean_stress("sigma_xy"), (rate, 0.0), "viscosity", "stress over the rate"))
        return found + self._normal() + self._dumbbells(rate)

    def _driven(self):
        amplitude, error = self.fit([self.shape(self.profile.data["y"])])[0]
        largest = abs(self.shape(numpy.array([0.25 * self.edge]))[0])
        eta = self.force / amplitude
        return [Measured("largest velocity", amplitude * largest, error * largest, "a0/t0", self.numbers["largest velocity"],
                         "amplitude of the profile"),
                Measured("viscosity", eta, eta * abs(error / amplitude), "m/a0 t0", self.eta, "force over this amplitude")]

    def _normal(self):
        if self.stress is None or "N1" not in self.stress.data:
            return []
        return [Measured("first normal stress difference", *self.mean_stress("N1"), "kT/a0³",
                         self.numbers["first normal stress difference"], "mean in time")]

    def _dumbbells(self, rate):
        """Springs of a sheared box: their part of the viscosity, and their shape."""
        found = []
        if self.stress is not None and "sigma_xy_spring" in self.stress.data and self.numbers.get("dumbbells", 0.0) > 0.0:
            value, error = self.mean_stress("sigma_xy_spring")
            found.append(Measured("viscosity of the springs", value / rate, error / abs(rate), "m/a0 t0",
                                  self.numbers["viscosity of the springs"], "their stress over the rate"))
        if self.shape_of_dumbbells is not None and self.shape_of_dumbbells.rows:
            for column, name, unit in (("extension", "extension", ""), ("chi", "angle with the flow", "degrees")):
                found.append(Measured(name, self.shape_of_dumbbells.column(column)[0], self.shape_of_dumbbells.bars(column)[0],
                                      unit, self.numbers[name], "mean over dumbbells and time"))
        return found

    # --- oscillation ---

    def _response(self):
        about = self.profile.data["y"] - 0.5 * self.edge
        inside = abs(about) < (BULK if self.kind == "walls" else 1.0) * 0.5 * self.edge
        columns = [numpy.ones_like(about), about]
        applied = self.numbers.get("shear rate of the walls", self.numbers["shear rate"])
        cosine, sine = (self.fit(columns, name, inside)[1] for name in ("vx_in_phase", "vx_out_of_phase"))
        size = numpy.hypot(cosine[0], sine[0])
        error = numpy.hypot(cosine[0] * cosine[1], sine[0] * sine[1]) / size
        theory = 1.0 + 0.0j
        if self.kind == "walls":
            weights = numpy.linalg.pinv(numpy.array([c[inside] for c in columns]).T)
            theory = complex(weights[1] @ self.wave_between_walls(about[inside]))
        return [Measured("rate in the middle over that applied", size / applied, error / applied, "", abs(theory),
                         "first harmonic of the profile"),
                Measured("its phase lag", math.degrees(math.atan2(sine[0], cosine[0])),
                         math.degrees(numpy.hypot(cosine[0] * sine[1], sine[0] * cosine[1]) / size**2), "degrees",
                         -math.degrees(math.atan2(theory.imag, theory.real)), "")]

    def wave_between_walls(self, about):
        """Complex amplitude of v_x at these places from the middle, for walls that shear at a rate of 1: a viscous wave from
        each wall, with slip (Stokes' second problem between two walls)."""
        if "inertia number" not in self.numbers:
            return numpy.full(len(about), complex(math.nan, math.nan))
        half = 0.5 * self.edge
        k = numpy.sqrt(1j * 8.0 * self.numbers["inertia number"]) / self.edge  # k^2 = i omega rho/eta
        return half * numpy.sinh(k * about) / (numpy.sinh(k * half) + self.slip * k * numpy.cosh(k * half))

    def _moduli(self):
        """G' and G'' of stress = rate/omega (G'' cos + G' sin): period by period, from whose scatter the error comes."""
        if self.stress is None or not {"sigma_xy", "time"} <= set(self.stress.data) or "period" not in self.numbers:
            return []
        period, time = self.numbers["period"], self.stress.data["time"]
        every = time[1] - time[0] if len(time) > 1 else period
        rows, omega = round(period / every), 2.0 * math.pi / period
        good = numpy.isfinite(self.stress.data["sigma_xy"]) & (self.stress.column("step") > self.begins)
        time, sigma = time[good] - 0.5 * every, self.stress.data["sigma_xy"][good]  # a row is the mean since the one before
        count = len(time) // rows if rows >= 8 and abs(rows * every - period) < 1e-6 * period else 0
        if count < 2:
            return []
        smooth = 0.5 * omega * every / math.sin(0.5 * omega * every)
        found = []
        for name, wave, theory in (("loss modulus G''", numpy.cos, self.numbers.get("loss modulus", omega * self.eta)),
                                   ("storage modulus G'", numpy.sin, self.numbers.get("storage modulus", 0.0))):
            parts = [2.0 * (sigma[k:k + rows] * wave(omega * time[k:k + rows])).mean() for k in range(0, count * rows, rows)]
            scale = omega / self.numbers["shear rate"] * smooth
            found.append(Measured(name, scale * numpy.mean(parts), scale * numpy.std(parts, ddof=1) / math.sqrt(count), "kT/a0³",
                                  theory, f"stress of {count} periods" + ("" if "loss modulus" in self.numbers else "; theory: without memory")))
        return found

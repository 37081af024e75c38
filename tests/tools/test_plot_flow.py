#!/usr/bin/python3
"""What `uncross plot` reads from tables of a flow. The tables are made here, from solutions of the Stokes equation with a
viscosity and slip that are not those of theory, so that what is found is known."""
import cmath
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import warnings

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, UNCROSS  # noqa: E402

os.environ["UNCROSS"] = str(UNCROSS)
sys.path.insert(0, str(TOP / "python"))
from uncross_plot import compare, distrust, flow, page, runs, tables  # noqa: E402

ETA, SLIP, EDGE, RHO = 30.0, 0.4, 20, 10.0
SOLVENT = """box: [8, 20, 1]
dimensions: 2
time_step: 0.02
steps: 1000
solvent: {per_cell: 10, collision_interval: 0.02, rule: at-a%s}
%s
"""


def tell(folder, scene, profile, stress=None):
    """A folder as a run leaves it: {column: values} of each table."""
    (folder / "run.json").write_text('{"scene": %s}' % json.dumps(scene), encoding="utf-8")
    for name, table in (("profile", profile), ("stress", stress)):
        if table:
            lines = [",".join(table), *(",".join(repr(float(v)) for v in row) for row in zip(*table.values()))]
            (folder / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def profile(velocity, error=1e-9, **more):
    y = [k + 0.5 for k in range(EDGE)]
    return {"y": y, "vx": [velocity(v) for v in y], "vx_error": [error] * EDGE,
            **{name: [f(v) for v in y] for name, f in more.items()}}


def stress(xy, lower=math.nan, upper=math.nan, rows=64):
    time = [0.2 * k for k in range(1, rows + 1)]
    return {"step": [10 * k for k in range(1, rows + 1)], "time": time, "sigma_xy": [xy] * rows, "N1": [0.25] * rows,
            "sigma_lower": [lower] * rows, "sigma_upper": [upper] * rows}


class Flows(unittest.TestCase):
    def found(self, scene, *tables):
        with tempfile.TemporaryDirectory() as folder:
            tell(pathlib.Path(folder), scene, *tables)
            run = runs.read(folder)
            self.assertEqual(run.trouble, [])
            page.measured_flow(run)
            return flow.Flow(run).measured()

    def one(self, found, name, source=""):
        fits = [m for m in found if m.name == name and m.source.startswith(source)]
        self.assertEqual(len(fits), 1, found)
        return fits[0]

    def near(self, measured, value, relative=1e-3):
        self.assertAlmostEqual(measured.value, value, delta=relative * abs(value))

    def test_couette(self):
        rate = 0.05 / (1.0 + 2.0 * SLIP / EDGE)
        found = self.found(SOLVENT % ("", "walls: {kind: no-slip, shear_rate: 0.05}"),
                           profile(lambda y: rate * (y - EDGE / 2)), stress(ETA * rate * 1.5, 0.9 * ETA * rate, 1.1 * ETA * rate))
        self.near(self.one(found, "shear rate in the bulk", "slope"), rate)
        self.near(self.one(found, "slip length", "L/2"), SLIP)
        self.near(self.one(found, "viscosity", "stress on the walls"), ETA)
        self.near(self.one(found, "viscosity", "stress in the bulk"), 1.5 * ETA)
        self.near(self.one(found, "first normal stress difference", "mean"), 0.25)
        self.assertAlmostEqual(self.one(found, "slip length", "L/2").theory, 0.2096, delta=1e-3)

    def test_stress_of_a_transient_is_left_out(self):
        rate, table = 0.05, stress(1.0, 1.0, 1.0)
        for name in ("sigma_xy", "sigma_lower", "sigma_upper"):
            table[name] = [9.0] * 32 + [ETA * rate] * 32
        found = self.found(SOLVENT % ("", "walls: {kind: no-slip, shear_rate: 0.05}\nobserve:\n  from: 320"),
                           profile(lambda y: rate * (y - EDGE / 2)), table)
        self.near(self.one(found, "viscosity", "stress on the walls"), ETA)

    def test_errors_of_slabs_add_up(self):
        """The bound of a slope is that of slabs that move together on each side of the middle."""
        error, rate = 0.01, 0.05
        found = self.found(SOLVENT % ("", "walls: {kind: no-slip, shear_rate: 0.05}"),
                           profile(lambda y: rate * (y - EDGE / 2), error), stress(1.0, 1.0, 1.0))
        about = [y + 0.5 - EDGE / 2 for y in range(EDGE) if abs(y + 0.5 - EDGE / 2) < 0.3 * EDGE]
        bound = error * sum(abs(y) for y in about) / sum(y * y for y in about)
        self.assertAlmostEqual(self.one(found, "shear rate in the bulk").error, bound, delta=1e-9)

    def test_poiseuille(self):
        force = RHO * 0.02
        found = self.found(SOLVENT % (", acceleration: [0.02, 0, 0]", "walls: {kind: no-slip}"),
                           profile(lambda y: force / (2 * ETA) * (y * (EDGE - y) + SLIP * EDGE)), stress(0.0))
        self.near(self.one(found, "viscosity", "curvature"), ETA)
        self.assertEqual([m for m in found if "normal" in m.name], [])
        self.near(self.one(found, "slip length", "where"), math.sqrt(EDGE**2 / 4 + SLIP * EDGE) - EDGE / 2)
        self.near(self.one(found, "largest velocity by the force", "parabola"), force / (2 * ETA) * (EDGE**2 / 4 + SLIP * EDGE))

    def test_forces_with_a_profile(self):
        force, k = RHO * 0.02, 2.0 * math.pi / EDGE
        sine = self.found(SOLVENT % (", acceleration: [0.02, 0, 0], profile: sine", ""),
                          profile(lambda y: force / (ETA * k * k) * math.sin(k * y)))
        self.near(self.one(sine, "viscosity", "force"), ETA)
        half = EDGE / 2
        reverse = self.found(SOLVENT % (", acceleration: [0.02, 0, 0], profile: reverse", ""),
                             profile(lambda y: (1 if y < half else -1) * force / (2 * ETA) * (y % half) * (half - y % half)))
        self.near(self.one(reverse, "viscosity", "force"), ETA)

    def test_loose_vertices_are_a_fluid_of_their_own(self):
        """Vertices without bonds: theory is that of the fluid with them, and the force is that on the solvent alone."""
        force, scene = RHO * 0.02, SOLVENT % (", acceleration: [0.02, 0, 0]", "walls: {kind: no-slip}\nfibers: [{name: p, count: 320, vertices: 1, mass: 5}]\ncrossing: {forbidden: false}")
        found = self.found(scene, profile(lambda y: force / (2 * ETA) * (y * (EDGE - y) + SLIP * EDGE)), stress(0.0))
        self.near(self.one(found, "viscosity", "curvature"), ETA)
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "scene.yaml").write_text(scene)
            done = subprocess.run([str(UNCROSS), "check", folder + "/scene.yaml"], capture_output=True, text=True, check=True)
        loaded = float(re.search(r"eta_l +(\S+)", done.stdout)[1])
        self.assertAlmostEqual(self.one(found, "viscosity", "curvature").theory, loaded, delta=1e-4 * loaded)
        own = float(re.search(r"viscosity +eta +(\S+)", done.stdout)[1])
        self.near(self.one(found, "viscosity over the solvent's, η_r", "curvature"), ETA / own)

    def test_sheared(self):
        found = self.found(SOLVENT % ("", "shear: {rate: 0.1}"), profile(lambda y: 0.1 * (y - EDGE / 2)), stress(0.1 * ETA))
        self.near(self.one(found, "slope of the profile", "all"), 0.1)
        self.near(self.one(found, "viscosity", "stress"), ETA)

    def test_moduli(self):
        """A stress of G' = 3 and G'' = 7 times the strain, and its mean over the time since the row before."""
        period, rate, storage, loss = 4.0, 0.1, 3.0, 7.0
        omega = 2 * math.pi / period
        def mean(begin, end):  # of strain (G' sin + G'' cos)
            strain = rate / omega
            return strain * (storage * (math.cos(omega * begin) - math.cos(omega * end)) +
                             loss * (math.sin(omega * end) - math.sin(omega * begin))) / (omega * (end - begin))
        table = stress(0.0, rows=200)
        table["sigma_xy"] = [mean(t - 0.2, t) for t in table["time"]]
        found = self.found(SOLVENT % ("", "shear: {rate: 0.1, period: 4}"),
                           profile(lambda y: 0.0, vx_in_phase=lambda y: 0.1 * (y - EDGE / 2), vx_in_phase_error=lambda y: 1e-9,
                                   vx_out_of_phase=lambda y: 0.0, vx_out_of_phase_error=lambda y: 1e-9), table)
        self.near(self.one(found, "loss modulus G''", "stress"), loss)
        self.near(self.one(found, "storage modulus G'", "stress"), storage)
        self.near(self.one(found, "rate in the middle over that applied", "first"), 1.0)

    def test_oscillating_walls(self):
        """The viscous waves of two walls; that of theory has the viscosity and slip of `uncross check`."""
        period, slip, eta = 30.0, 0.20962, 37.6224
        wave = cmath.sqrt(2j * math.pi / period * RHO / eta)
        def velocity(y):
            about = y - EDGE / 2
            return 0.05 * EDGE / 2 * cmath.sinh(wave * about) / (cmath.sinh(wave * EDGE / 2) + slip * wave * cmath.cosh(wave * EDGE / 2))
        found = self.found(SOLVENT % ("", "walls: {kind: no-slip, shear_rate: 0.05, period: 30}"),
                           profile(lambda y: 0.0, vx_in_phase=lambda y: velocity(y).real, vx_in_phase_error=lambda y: 1e-9,
                                   vx_out_of_phase=lambda y: -velocity(y).imag, vx_out_of_phase_error=lambda y: 1e-9))
        for name in ("rate in the middle over that applied", "its phase lag"):
            measured = self.one(found, name)
            self.near(measured, measured.theory)
        self.assertGreater(self.one(found, "its phase lag").value, 10.0)

    def test_top_of_the_page(self):
        """What was measured stands there beside theory."""
        with tempfile.TemporaryDirectory() as folder:
            tell(pathlib.Path(folder), SOLVENT % ("", "shear: {rate: 0.1}"), profile(lambda y: 0.1 * (y - EDGE / 2)),
                 {**stress(0.0), "sigma_xy": [3.0 + 0.01 * (-1)**k for k in range(64)]})
            front = dict(page.front(runs.read(folder)))
        self.assertRegex(str(front["What came out"]), r"Viscosity 30\.\d* ± 0\.\d+ m/a0 t0, theory 37\.62 \(stress over the rate\)")

    def test_box_of_a_flow(self):
        """A flow has its own box, and no picture of fibers where there are none."""
        scene = (SOLVENT % ("", "walls: {kind: no-slip, shear_rate: 0.05}")).replace("box: [8, 20, 1]", "box: [2, 4, 1]")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            (path / "scene.yaml").write_text(scene, encoding="utf-8")
            subprocess.run([str(UNCROSS), "run", str(path / "scene.yaml"), "--out", str(path / "run"), "--quiet"], check=True)
            run = runs.read(str(path / "run"))
            self.assertEqual(dict(page.front(run))["What ran"], "The solvent between two walls, in a box of 2 × 4 × 1 a0.")
            self.assertNotIn("Fibers", [section.title for section in page.sections_of(run)])

    SUSPENSION = """box: [20, 20, 10]
time_step: 0.02
steps: 1000
solvent: {per_cell: 5, collision_interval: 0.02, thermostat: maxwell-boltzmann}
shear: {rate: 0.1}
fibers: [{name: dimer, count: 4000, vertices: 2, mass: 5, bond_length: 0.5, spring: 100}]
"""

    def test_suspension(self):
        """The theory of loose vertices is no theory of bonds: it is named, and no difference in errors is given. eta_r
        is the measured 30 over the solvent's 11.183819 (tests/theory/test_theory.c)."""
        with tempfile.TemporaryDirectory() as folder:
            tell(pathlib.Path(folder), self.SUSPENSION, profile(lambda y: 0.1 * (y - EDGE / 2)),
                 {**stress(0.0), "sigma_xy": [3.0 + 0.01 * (-1)**k for k in range(64)]})
            run = runs.read(folder)
        found = flow.Flow(run).measured()
        self.near(self.one(found, "viscosity over the solvent's, η_r", "stress"), 30.0 / 11.183819)
        rows = {row[0]: row for row in page.measured_flow(run)[0].rows}
        self.assertEqual(rows["viscosity"][3:5], ("32.4877, loose vertices", ""))
        self.assertNotEqual(rows["slope of the profile"][4], "")  # of the box, and exact
        told = str(dict(page.front(run))["What came out"])
        self.assertRegex(told, r"Viscosity 30\.\d* ± 0\.\d+ m/a0 t0, 2\.682\d ± 0\.0011 times that of the solvent alone")
        self.assertNotIn("theory 11", told)

    def test_springs_have_a_viscosity_only_where_they_are(self):
        """The column is there in every sheared box; without dumbbells it is 0, and no result."""
        springs = {**stress(3.0), "sigma_xy_spring": [0.0] * 64}
        found = self.found(SOLVENT % ("", "shear: {rate: 0.1}"), profile(lambda y: 0.1 * (y - EDGE / 2)), springs)
        self.assertEqual([m for m in found if "springs" in m.name], [])

    def test_two_flows(self):
        """The comparison has the table of the flow: viscosities of 30 and 33, errors from the scatter of the stress."""
        with tempfile.TemporaryDirectory() as folder:
            found = []
            for name, xy in (("a", 3.0), ("b", 3.3)):
                (pathlib.Path(folder) / name).mkdir()
                tell(pathlib.Path(folder) / name, SOLVENT % ("", "shear: {rate: 0.1}"), profile(lambda y: 0.1 * (y - EDGE / 2)),
                     {**stress(0.0), "sigma_xy": [xy + 0.01 * (-1)**k for k in range(64)]})
                found.append(runs.read(f"{folder}/{name}"))
            rows = {row[0]: row for row in compare.flow_table(*found, ("a", "b")).blocks[0].rows}
        error = 0.01 * math.sqrt(64 / 63) / math.sqrt(64) / 0.1
        self.assertEqual(rows["viscosity"][1:3], (page.with_error(30.0, error), page.with_error(33.0, error)))
        self.assertEqual(rows["viscosity"][4], f"{3.0 / (error * math.sqrt(2.0)):+.1f}")
        self.assertEqual(compare.flow_table(found[0], runs.Run("x"), ("a", "x")).blocks, [])

    def test_a_profile_that_has_not_become_steady(self):
        """tau = L^2/(pi^2 nu), nu = 37.62/10 of check: 10.8 t0. A run of 20 t0 still has 2 * exp(-2)... of the start in its mean; one of 500 t0
        that averages from 100 t0 on has not."""
        scene = SOLVENT % (", acceleration: [0.02, 0, 0]", "walls: {kind: no-slip}\nobserve:\n  from: %d")
        for steps, begins, told in ((1000, 0, True), (25000, 5000, False), (25000, 0, True)):
            with tempfile.TemporaryDirectory() as folder:
                tell(pathlib.Path(folder), scene % begins, profile(lambda y: 0.01 * y * (EDGE - y)))
                record = {"scene": scene % begins, "steps": steps, "time": 0.02 * steps, "status": "finished"}
                (pathlib.Path(folder) / "run.json").write_text(json.dumps(record), encoding="utf-8")
                doubts = [text for text in distrust.of_run(runs.read(folder)) if "has not become steady" in text]
            self.assertEqual(len(doubts), told, (steps, begins))

    def test_captions_know_the_box(self):
        for line, words in (("walls: {kind: no-slip}", "between two walls"), ("shear: {rate: 0.1}", "in a sheared box"), ("", "in a periodic box")):
            scene = f"box: [8, 8, 8]\ntime_step: 0.01\nsteps: 0\n{line}\nfibers: [{{name: rod, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100}}]\n"
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder)
                (path / "scene.yaml").write_text(scene + "solvent: {per_cell: 5, collision_interval: 0.02, thermostat: maxwell-boltzmann}\n", encoding="utf-8")
                subprocess.run([str(UNCROSS), "run", str(path / "scene.yaml"), "--out", str(path / "run"), "--quiet"], check=True)
                run = runs.read(str(path / "run"))
                figure = page.picture_of(run.frames).blocks[0]
                self.assertIn(words, figure.caption)
                self.assertIn(words, page._what(run))
                self.assertEqual("periodic" in figure.caption, not line, figure.caption)
                self.assertEqual("the walls" in figure.caption, "walls" in line)

    # A flow of each sort, with a table of everything that a page reads of it.
    SORTS = ((", acceleration: [0.02, 0, 0]", "walls: {kind: no-slip}", False), ("", "walls: {kind: no-slip, shear_rate: 0.05}", False),
             ("", "walls: {kind: no-slip, shear_rate: 0.05, period: 4}", True), ("", "shear: {rate: 0.1}", False),
             ("", "shear: {rate: 0.1, period: 4}", True), (", acceleration: [0.02, 0, 0], profile: sine", "", False),
             ("", "shear: {rate: 0.1}\ndumbbells: {spring: 1}", False))

    def sort(self, solvent, line, oscillates, rate=0.1):
        """A Run of such a flow."""
        wave = {f"vx_{part}{error}": lambda y: rate * (y - EDGE / 2) for part in ("in_phase", "out_of_phase") for error in ("", "_error")}
        lone = {"extension": [1.1], "extension_error": [0.1], "chi": [40.0], "chi_error": [1.0]}
        with tempfile.TemporaryDirectory() as folder:
            tell(pathlib.Path(folder), SOLVENT % (solvent, line), profile(lambda y: rate * (y - EDGE / 2), **(wave if oscillates else {})),
                 {**stress(3.0, 3.0, 3.0), "sigma_xy_spring": [1.0] * 64})
            (pathlib.Path(folder) / "dumbbells.csv").write_text(
                ",".join(lone) + "\n" + ",".join(str(v[0]) for v in lone.values()) + "\n", encoding="utf-8")
            run = runs.read(folder)
        self.assertEqual(run.trouble, [])
        return run

    def told(self, run):
        """Words of all that is read of a flow; an error here is a page that is not made."""
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return str([page.measured_flow(run), page.front(run), [f(3.0) for _, f, _ in page.flow_guides(run)], distrust.of_run(run)])

    def test_a_number_or_column_that_is_missing_stops_no_page(self):
        """`uncross check` leaves out what means nothing in a scene, a table what its scene has not. Each in turn."""
        for sort in self.SORTS:
            run = self.sort(*sort)
            self.assertIn("modulus" if sort[2] and "shear:" in sort[1] else "phase lag" if sort[2] else "viscosity", self.told(run))
            for _, rows in run.derived:
                for k, row in enumerate(list(rows)):
                    del rows[k]
                    with self.subTest(sort=sort, without=row.name):
                        self.told(run)
                    rows.insert(k, row)
            for table in run.tables:
                whole = dict(table.data)
                for column in whole:
                    run.tables[run.tables.index(table)] = table = tables.Table(table.name, {c: v for c, v in whole.items() if c != column})
                    with self.subTest(sort=sort, without=f"{table.name}: {column}"):
                        self.told(run)
                run.tables[run.tables.index(table)] = tables.Table(table.name, whole)

    def test_a_flow_of_zeros_is_no_quotient(self):
        for sort in self.SORTS:
            with self.subTest(sort=sort):
                self.told(self.sort(*sort, rate=0.0))
        self.told(self.sort("", "shear: {rate: 0}", False))

    def test_springs_have_the_viscosity_that_theory_gives(self):
        """Their stress 1 over the rate 0.1; theory is the row of `uncross check`, n_d kT/omega_H."""
        run = self.sort(*self.SORTS[-1])
        springs = self.one(flow.Flow(run).measured(), "viscosity of the springs")
        self.near(springs, 10.0)
        self.assertGreater(springs.theory, 0.0)
        self.assertIn("Dumbbells", " ".join(heading for heading, _ in run.derived))

    def test_no_flow(self):
        self.assertEqual(self.found(SOLVENT % ("", ""), profile(lambda y: 0.0), stress(0.0)), [])


if __name__ == "__main__":
    unittest.main()

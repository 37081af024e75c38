"""Pages of `uncross plot`: a run of rods, rings and single beads under a force.

Needs UNCROSS, the program (default build/uncross). Pictures are held against the bonds that the file lists, pages against
the files of the folder, numbers against what the files say.
"""
import base64
import contextlib
import html.parser
import io
import json
import math
import os
import pathlib
import re
import shutil
import sys
import tempfile
import types
import unittest
import unittest.mock
import warnings
import xml.etree.ElementTree as xml

import h5py
import numpy
from PIL import Image

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import support  # noqa: E402
from support import TOP, UNCROSS, load  # noqa: E402

os.environ["UNCROSS"] = str(UNCROSS)
sys.path.insert(0, str(TOP / "python"))
from uncross_plot import columns, distrust, fibers, page, runs, sweeps, tables  # noqa: E402

SCENE = """box: [8, 8, 10]
time_step: 0.01
steps: 200
seed: 3
solvent: {per_cell: 3, collision_interval: 0.02}
fibers:
  - {name: rods, count: 20, vertices: 12, mass: 5, bond_length: 0.5, spring: 100, persistence_length: 50}
  - {name: rings, count: 6, vertices: 16, ring: true, mass: 5, bond_length: 0.5, spring: 100, persistence_length: 2}
  - {name: beads, count: 40, vertices: 1, mass: 5, bond_length: 0.5, spring: 100, force: [0.1, 0, 0]}
observe: {conserved: {every: 5}, temperature: {every: 5}, collisions: {every: 20}, statics: {every: 5}, dynamics: {every: 5}}
trajectory: {every: 50}
"""
RODS, RINGS, BEADS, BONDS = 20, 6, 40, 20 * 11 + 6 * 16  # from the scene: a ring has as many bonds as vertices
VOID = {"meta", "img", "br"}


def uncross(*words, environment=None):
    done = support.uncross(*words, env={**os.environ, **(environment or {})})
    return done.returncode, done.stdout, done.stderr


program = load(TOP / "tools" / "uncross-plot")


def plot(*words):
    """(code, standard output, standard error) of `uncross plot`, in this process: its packages take a second to read."""
    told, error = io.StringIO(), io.StringIO()
    with warnings.catch_warnings(action="error"), contextlib.redirect_stdout(told), contextlib.redirect_stderr(error), unittest.mock.patch.object(
            sys, "argv", ["uncross plot", *map(str, words)]):
        code = program.main()
    return code, told.getvalue(), error.getvalue()


class Page(html.parser.HTMLParser):
    """A page, read strictly: every element is closed in turn."""

    def __init__(self, path):
        super().__init__()
        self.open, self.images, self.tables, self.addresses, self.words, self.cells = [], [], [], [], [], []
        self.text = pathlib.Path(path).read_text(encoding="utf-8")
        self.feed(self.text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if tag not in VOID:
            self.open.append(tag)
        if tag == "img":
            self.images.append(attrs)
        if "data-table" in attrs:
            self.tables.append(attrs["data-table"])
        self.addresses += [attrs[k] for k in ("src", "href", "data", "srcset") if k in attrs]
        if tag in ("td", "th", "dd", "li", "figcaption", "caption"):
            self.cells.append("")

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, (tag, self.getpos())

    def handle_data(self, data):
        if "style" not in self.open:
            self.words.append(data)
            if self.cells:
                self.cells[-1] += data

    @property
    def said(self):
        return " ".join(" ".join(self.words).split())

    def picture(self, number):
        return base64.b64decode(self.images[number]["src"].split(",", 1)[1])


class Folder(unittest.TestCase):
    """One run, and its page with a movie, which is made when a test first asks for it."""

    made = None

    @classmethod
    def setUpClass(cls):
        cls.dir = pathlib.Path(tempfile.mkdtemp())
        (cls.dir / "mix.yaml").write_text(SCENE)
        cls.run_dir = cls.dir / "mix"
        assert uncross("run", cls.dir / "mix.yaml", "--out", cls.run_dir, "--quiet")[0] == 0

    @property
    def page(self):
        if Folder.made is None:
            self.assertEqual(uncross("plot", self.run_dir, "--movie"), (0, f"{self.run_dir}/page.html\n", ""))
            Folder.made = Page(self.run_dir / "page.html")
        return Folder.made

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.dir)

    def copy(self, name):
        """A copy of the run to spoil."""
        where = self.dir / name
        shutil.copytree(self.run_dir, where, ignore=shutil.ignore_patterns("*.html"))
        return where

    def record(self, name, **changes):
        where = self.copy(name)
        record = json.loads((where / "run.json").read_text())
        (where / "run.json").write_text(json.dumps({**record, **changes}))
        return distrust.of_run(runs.read(str(where)))

    # --- the page ---

    def test_the_page_needs_nothing_else(self):
        self.assertTrue(self.page.text.startswith("<!DOCTYPE html>"))
        for address in self.page.addresses:
            self.assertRegex(address, "^(data:|#)")
        self.assertNotRegex(re.sub(r'src="data:[^"]*"', "", self.page.text), r"https?:|\bfile:|url\(|@import|<script|<link")
        for number, image in enumerate(self.page.images):
            if image["src"].startswith("data:image/svg"):
                root = xml.fromstring(self.page.picture(number))
                for element in root.iter():
                    for key, value in element.attrib.items():
                        self.assertTrue(not key.endswith("href") or value.startswith("#"), value)

    def test_every_picture_has_words(self):
        self.assertGreater(len(self.page.images), 8)
        for image in self.page.images:
            self.assertGreater(len(image["alt"]), 15)
            self.assertTrue(image["title"])
        figures = [int(n) for n in re.findall(r"Figure (\d+)\.", self.page.said)]
        self.assertEqual(figures, list(range(1, self.page.text.count("<figure") + 1)))

    def test_figures_can_be_read_on_a_telephone(self):
        """A column of 358 pixels: letters of 9 points are at least 7.5 pixels high there. A point of a figure is a point of print."""
        for number, image in enumerate(self.page.images):
            if image["src"].startswith("data:image/svg") and not image["title"].startswith("Fibers"):
                wide = float(re.search(r'<svg[^>]* width="([\d.]+)pt"', self.page.picture(number).decode())[1])
                self.assertGreater(9.0 * 358.0 / wide, 7.5, image["title"])

    def test_every_table_has_a_figure(self):
        names = sorted(p.stem for p in self.run_dir.glob("*.csv"))
        self.assertEqual(len(names), 9)
        self.assertEqual(sorted(self.page.tables), names)

    def test_every_column_is_declared_and_documented(self):
        documented = (TOP / "docs/observables.md").read_text()
        for path in self.run_dir.glob("*.csv"):
            table = tables.read(path, path.stem)
            for name in table.data:
                if not table.is_error(name):
                    self.assertIn(name, columns.COLUMNS)
                    self.assertTrue(name == "step" or f"`{name}`" in documented, name)
            shown = [c for panel in columns.panels(path.stem, table.values) for c in panel.columns]
            if table.rows > 1:
                self.assertEqual(sorted(shown), sorted(table.values))

    def test_single_beads_have_no_empty_figure(self):
        self.assertNotIn("Size and shape of 'beads'", [a["title"] for a in self.page.images])
        self.assertIn("Size and shape of 'beads', in numbers", self.page.said)

    def test_the_diffusion_coefficient_is_about_the_drift(self):
        """A force acts on the beads: D = g_cm/6t holds their drift."""
        run = runs.read(str(self.run_dir))
        self.assertTrue(any("contain (v t)^2" in text for text in run.record["warnings"]))
        table = run.table("dynamics-beads")
        rows = numpy.flatnonzero((table.data["intervals"] >= 16) & numpy.isfinite(table.data["D_about_mean"]))
        value = page.with_error(table.data["D_about_mean"][rows[-1]], table.data["D_about_mean_error"][rows[-1]])
        self.assertIn(f"D of 'beads' about its drift {value} a0²/t0 at lag {table.data['time'][rows[-1]]:.3g} t0", self.page.said)

    def test_a_sweep_is_told_how(self):
        folder = self.dir / "swept"
        (folder / "fibers.rod.count=10/seed-1").mkdir(parents=True)
        for name in ("runs.csv", "summary.csv"):
            (folder / name).write_text("run,code\nfibers.rod.count=10/seed-1,0\n")
        for path in (folder, folder / "summary.csv", folder / "runs.csv"):
            code, _, error = plot("--compare", path, self.run_dir, "-o", self.dir / "no.html")
            self.assertEqual(code, 2)
            self.assertIn("of a sweep; give the folder of one of its points", error)
            self.assertIn(f"{folder}/fibers.rod.count=10", error)

    def test_a_sweep_has_a_page(self):
        folder = self.dir / "grid"
        folder.mkdir()
        (folder / "runs.csv").write_text("folder,k,start,seed,exit_code,status,steps,state_hash,message\n" + "".join(
            f"k={k}_start={s}/seed-1,{k},{s},1,{3 * (k == 40)},x,9,ab,why\n" for k in (10, 20, 40) for s in ("a", "b")))
        (folder / "summary.csv").write_text(
            "folder,k,start,seeds,D_about_mean_rod,D_about_mean_rod_error,D_about_mean_rod_block_error,lag_rod\n" + "".join(
                f"k={k}_start={s},{k},{s},1,{0.5 / k:.17g},nan,0.001,2.5\n" for k in (10, 20, 40) for s in ("a", "b")))
        code, told, error = plot(folder)
        self.assertEqual((code, error), (0, ""))
        made = Page(told.strip())
        self.assertEqual(made.tables, ["D_about_mean_rod"])
        self.assertEqual(len(made.images), 1)
        svg = made.picture(0).decode()
        self.assertEqual(svg.count('id="LineCollection_'), 4)  # error bars of a series for each start, and of its entry in the legend
        self.assertIn("6 runs of 6 points; seeds 1.", made.said)
        self.assertIn("3 things:", made.said)  # two runs have not finished, and what the others warned of is lost
        self.assertIn("what the run warned of is not known (4 of 6 runs)", made.said)
        self.assertIn("k=40_start=a/seed-1: exit code 3", made.said)
        self.assertIn("0.0500 ± 0.0010", made.said)
        self.assertEqual(plot(folder)[0], 2)  # nothing is written over
        (folder / "summary.csv").write_text("k,seeds\n1\n")
        self.assertEqual(plot(folder, "-o", self.dir / "bad.html")[0], 2)

    def test_error_bars_and_labels(self):
        svg = "".join(self.page.picture(i).decode() for i, a in enumerate(self.page.images) if a["title"].startswith("Motion of 'rods'"))
        self.assertGreater(svg.count('id="LineCollection_'), 5)  # a collection of bars for each series with errors
        table = tables.read(self.run_dir / "dynamics-rods.csv", "dynamics-rods")
        self.assertEqual(columns.column("D").label, r"diffusion coefficient $D(t) = g_\mathrm{cm}/2dt$ / $(a_0^2/t_0)$")
        bare = tables.Table("dynamics-rods", {k: v for k, v in table.data.items() if not k.endswith("_error")})
        self.assertNotIn('id="LineCollection_', "".join(svg for svg, _ in tables.figure(bare)))

    def test_what_came_out_and_where_from(self):
        record = json.loads((self.run_dir / "run.json").read_text())
        for key in ("version", "commit", "compiler", "flags", "seed", "state_hash", "scene_fingerprint"):
            self.assertIn(str(record[key]), self.page.said)
        self.assertIn("Finished: step 200 of 200, 2 t0", self.page.said)
        self.assertIn(f"{RODS} fibers of 12 vertices ('rods'), {RINGS} rings of 16 vertices ('rings'), {BEADS} single beads "
                      "('beads') in a periodic box of 8 × 8 × 10 a0.", self.page.said)
        self.assertIn(" ".join(record["scene"].split()), self.page.said)

    def test_derived_numbers_are_those_of_check(self):
        told = uncross("check", self.dir / "mix.yaml")[1]
        heading, wanted = "", []
        for line in told.splitlines():
            heading = line if line[:1].strip() else heading
            value = re.fullmatch(r"\s+(\S.*?)\s{2,}.*?\s([-+.e\d]+)(?: .*)?", line[:63])
            if value and re.match("Solvent|Fibers|Suspension", heading):
                wanted.append((value[1], value[2]))
        found = [(row.name, row.value) for _, rows in runs.read(str(self.run_dir)).derived for row in rows]
        self.assertGreater(len(found), 60)
        self.assertEqual(found, wanted)

    def test_si_units(self):
        """Against arithmetic of its own: a0 = 50 nm, 300 K; a time that is given."""
        out = self.dir / "si.html"
        self.assertEqual(uncross("plot", self.run_dir, "--units", "a0=50nm,T=300K,t0=2us", "--out", out)[0], 0)
        said = Page(out).said
        self.assertIn("a0 = 50 nm; t0 = 2 us;", said)
        self.assertIn("2 t0 = 4 us.", said)
        self.assertIn("wrong:", said)
        numbers = {row.name: row for _, rows in runs.read(str(self.run_dir), "a0=50nm,T=300K,t0=2us").derived for row in rows}
        length, unit = numbers["mean bond length"].si.split()
        self.assertEqual(unit, "nm")
        self.assertAlmostEqual(float(length), 50.0 * float(numbers["mean bond length"].value), delta=2e-4 * float(length))
        code, _, told = uncross("plot", self.run_dir, "--units", "a0=50parsec,T=300K", "--out", self.dir / "no.html")
        self.assertEqual(code, 2)
        self.assertIn("parsec", told)
        self.assertFalse((self.dir / "no.html").exists())

    # --- the picture ---

    def drawn(self, number=0):
        root = xml.fromstring(self.page.picture(number))
        kind = "{http://www.w3.org/2000/svg}"
        pieces = [(int(e.get("data-n")), [float(x) for x in re.findall(r"[-.\d]+", e.get("d"))])
                  for e in root.iter(kind + "path") if e.get("class") == "b"]
        return pieces, [int(e.get("data-n")) for e in root.iter(kind + "circle") if e.get("data-n")]

    def test_all_bonds_and_no_others_are_drawn(self):
        pieces, beads = self.drawn()
        with h5py.File(self.run_dir / "trajectory.h5") as file:
            bonds = file["connectivity/bonds"][:]
        self.assertEqual(len(bonds), BONDS)
        self.assertEqual({n for n, _ in pieces}, set(range(BONDS)))
        self.assertEqual(len(beads), BEADS)
        self.assertEqual(set(beads) & set(bonds.ravel().tolist()), set())
        self.assertIn(f"{BONDS} bonds of {RODS + RINGS} fibers and {BEADS} single beads", self.page.said)
        # The box is some 700 pixels wide and 8 a0; a bond is shorter than 1 a0.
        self.assertLess(max(math.hypot(x1 - x0, y1 - y0) for _, (x0, y0, x1, y1) in pieces), 110)

    def test_sheared_images_slide(self):
        """Bonds of a sheared box: points along each, folded by hand with the slide, lie on its pieces, and pieces lie in the box."""
        random = numpy.random.default_rng(7)
        edges, slide = numpy.array([4.0, 5.0, 6.0]), 1.3
        a = random.uniform(-9, 9, (200, 3))
        step = random.uniform(-1.9, 1.9, (200, 3))
        bonds = numpy.stack([numpy.arange(200), numpy.arange(200) + 200], 1)
        structure = fibers.Structure("", edges, ["x"], numpy.zeros(400, int), bonds, numpy.zeros(400, int), "")
        ends, number = fibers.pieces(structure, numpy.concatenate([a, a + step]), slide)
        self.assertTrue(((ends > -1e-9) & (ends < edges + 1e-9)).all())
        self.assertTrue(numpy.allclose(numpy.bincount(number, numpy.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), 200), numpy.linalg.norm(step, axis=1)))
        for part in (0.03, 0.31, 0.77):
            for bond in range(200):
                x, y, z = a[bond] + part * step[bond]
                over = math.floor(y / edges[1])
                place = numpy.array([(x - over * slide) % edges[0], y - over * edges[1], z % edges[2]])
                mine = ends[number == bond]
                along = mine[:, 1] - mine[:, 0]
                t = numpy.clip(((place - mine[:, 0]) * along).sum(1) / (along**2).sum(1), 0.0, 1.0)
                self.assertLess(numpy.linalg.norm(mine[:, 0] + t[:, None] * along - place, axis=1).min(), 1e-9)

    def test_the_slide_is_that_of_the_run(self):
        """Against wrapped places that uncross exports, modulo the edge along x; a steady shear, and one that oscillates."""
        for number, shear in enumerate(("{rate: 0.37}", "{rate: 0.9, period: 4}")):
            (self.dir / "shear.yaml").write_text(
                f"box: [4, 4, 4]\ntime_step: 0.01\nsteps: 700\nshear: {shear}\nsolvent: {{per_cell: 3, collision_interval: 0.02, thermostat: maxwell-boltzmann}}\n"
                "fibers: [{name: rods, count: 20, vertices: 3, mass: 3, bond_length: 0.5, spring: 50}]\ncrossing: {forbidden: false}\ntrajectory: {every: 350}\n")
            folder = self.dir / f"shear{number}"
            self.assertEqual(uncross("run", self.dir / "shear.yaml", "--out", folder, "--quiet")[0], 0)
            code, told, error = uncross("export", folder / "trajectory.h5", "--format", "xyz", "--wrapped")
            self.assertEqual(code, 0, error)
            rows = [line.split() for line in told.splitlines()]
            there = numpy.array([[float(word) for word in row[1:4]] for row in rows if row and row[0] == "C"]).reshape(3, 60, 3)
            with fibers.File(str(folder / "trajectory.h5")) as file:
                for frame in range(3):
                    points = fibers.folded(file.structure, file.positions(frame), file.slide(frame))
                    gap = points - there[frame]
                    gap[:, 0] -= 4.0 * numpy.round(gap[:, 0] / 4.0)
                    self.assertLess(abs(gap).max(), 1e-3)
                self.assertGreater(abs(file.positions(2)[:, 1] // 4).max(), 0)  # some have gone round

    def test_pieces_are_the_bond(self):
        """Random bonds through faces, edges and corners: lengths add up, pieces lie in the box, ends meet at faces."""
        random = numpy.random.default_rng(5)
        edges = numpy.array([4.0, 5.0, 6.0])
        a = random.uniform(-9, 9, (400, 3))
        step = random.uniform(-1.9, 1.9, (400, 3))
        step[:20, 0] = 0.0  # along faces
        points = numpy.concatenate([a, a + step])
        bonds = numpy.stack([numpy.arange(400), numpy.arange(400) + 400], 1)
        structure = fibers.Structure("", edges, ["x"], numpy.zeros(800, int), bonds, numpy.zeros(800, int), "")
        ends, number = fibers.pieces(structure, points)
        self.assertGreater(len(ends), 500)
        self.assertTrue(((ends > -1e-9) & (ends < edges + 1e-9)).all())
        length = numpy.bincount(number, numpy.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), 400)
        numpy.testing.assert_allclose(length, numpy.linalg.norm(step, axis=1), rtol=1e-9)
        middle = (ends.mean(axis=1) - a[number]) / edges  # each piece lies on the bond, up to whole edges
        along = (middle - numpy.round(middle - step[number] / edges / 2)) * edges
        cross = numpy.linalg.norm(numpy.cross(along - step[number] / 2, step[number]), axis=1)
        self.assertLess(numpy.median(cross), 1e-9)
        folded, order = fibers.pieces(structure, points - edges * numpy.floor(points / edges))
        numpy.testing.assert_allclose(numpy.bincount(order, numpy.linalg.norm(folded[:, 1] - folded[:, 0], axis=1), 400), length,
                                      rtol=1e-9)

    def test_a_bond_is_inside_or_leaves(self):
        structure = fibers.Structure("", numpy.array([4.0, 4.0, 4.0]), ["x"], numpy.zeros(2, int), numpy.array([[0, 1]]),
                                     numpy.zeros(2, int), "")
        one = fibers.pieces(structure, numpy.array([[1.0, 1.0, 1.0], [1.5, 1.0, 1.0]]))[0]
        self.assertEqual(one.tolist(), [[[1, 1, 1], [1.5, 1, 1]]])
        two = fibers.pieces(structure, numpy.array([[3.75, 1.0, 1.0], [4.5, 1.0, 1.0]]))[0]
        self.assertEqual(sorted(two.tolist()), [[[0, 1, 1], [0.5, 1, 1]], [[3.75, 1, 1], [4, 1, 1]]])

    def test_a_bead_is_where_it_is_folded_to(self):
        edges = numpy.array([4.0, 5.0, 6.0])
        structure = fibers.Structure("", edges, ["x", "bead"], numpy.array([0, 0, 1]), numpy.array([[0, 1]]),
                                     numpy.array([0, 0, 1]), "")
        points = numpy.array([[1.0, 2.0, 3.0], [1.5, 2.0, 3.0], [1.0 + 2 * 4, 2.0 - 5, 3.0 + 6]])
        found = {mark.a == mark.b: mark for mark in fibers.marks(structure, points, fibers.Camera(edges))}
        numpy.testing.assert_allclose(found[True].a, found[False].a, atol=1e-9)

    def test_kinds_fibers_and_rings(self):
        for name in ("trajectory.h5", "checkpoint.h5"):
            with fibers.File(self.run_dir / name) as file:
                s = file.structure
                self.assertEqual(s.kinds, ["rods", "rings", "beads"])
                self.assertEqual([s.kinds[k] for k in s.rings], ["rings"])
                sizes = numpy.bincount(s.fiber)
                self.assertEqual(sizes.tolist(), [12] * RODS + [16] * RINGS + [1] * BEADS)
        with fibers.File(self.run_dir / "trajectory.h5") as a, fibers.File(self.run_dir / "checkpoint.h5") as b:
            numpy.testing.assert_array_equal(a.positions(-1), b.positions(0))

    def test_the_movie_plays(self):
        with Image.open(io.BytesIO(self.page.picture(1))) as movie:
            self.assertEqual((movie.format, movie.n_frames), ("WEBP", 5))
            frames = []
            for number in (0, 4):
                movie.seek(number)
                frames.append(numpy.asarray(movie.convert("L"), float))
        self.assertGreater(numpy.abs(frames[0] - frames[1]).mean(), 0.5)
        self.assertLess(frames[0].min(), 120)

    # --- what to distrust ---

    def test_warnings_are_on_the_front(self):
        front = self.page.text[self.page.text.index("<dl"):self.page.text.index("</dl>")]
        self.assertIn("net force of (4, 0, 0)", front)
        self.assertIn("the run lasted 2 t0, and a fiber turns in", front)
        self.assertEqual(front.count("<dt>"), 5)

    def test_ends_faults_and_clusters(self):
        told = self.record("ended", status="stopped", reason="bond 7 is too long", steps=120)
        self.assertEqual(told[0], "The run did not finish: it is 'stopped' at step 120 of 200: bond 7 is too long.")
        self.assertIn("'running' at step 0 of 200", self.record("runs", status="running", steps=0)[0])
        counts = {"executed": 3, "possible": 3, "moves": 9, "negative": 0, "rigid": 2}
        self.assertTrue(any("2 contacts made bonds move rigidly" in t for t in self.record("rigid", collisions=counts)))
        self.assertFalse(any("rigid" in t or "finish" in t for t in distrust.of_run(runs.read(str(self.run_dir)))))

    def test_a_damaged_file_is_named_and_not_drawn(self):
        where = self.copy("damaged")
        for name in ("trajectory.h5", "checkpoint.h5"):
            data = bytearray((where / name).read_bytes())
            data[len(data) // 2] ^= 1
            (where / name).write_bytes(data)
        run = runs.read(str(where))
        self.assertIsNone(run.frames)
        told = " ".join(distrust.of_run(run))
        self.assertRegex(told, r"trajectory\.h5: .*damaged|trajectory\.h5: .*checksum")
        self.assertRegex(told, r"checkpoint\.h5: ")
        code, _, error = plot(where / "checkpoint.h5")
        self.assertEqual(code, 2)
        self.assertIn("checkpoint.h5: ", error)

    def synthetic(self, name, data):
        run = runs.Run("nowhere")
        run.tables.append(tables.Table(name, {k: numpy.array(v, float) for k, v in data.items()}))
        return distrust.of_run(run)

    def test_unsteady_short_and_wrong_averages(self):
        random = numpy.random.default_rng(1)
        noise, time = random.normal(1.0, 0.01, 200), numpy.arange(200.0)
        self.assertEqual(self.synthetic("temperature", {"time": time, "solvent": noise}), [])
        told = self.synthetic("temperature", {"time": time, "solvent": noise + 0.0004 * (time - 100)})
        self.assertEqual(len(told), 1)
        self.assertIn("solvent is not steady", told[0])
        self.assertIn("not those of equilibrium", self.synthetic("temperature", {"time": time, "solvent": noise + 0.03})[0])
        told = self.synthetic("dynamics-x", {"time": [1, 2], "g": [1, 2], "g_error": [0.1, math.nan], "intervals": [40, 4]})
        self.assertIn("too few values for an error of g.", told[0])
        self.assertIn("from lag 2 t0 on, fewer than 16 pairs", told[1])

    def test_theory_is_held_against_open_fibers(self):
        run = runs.read(str(self.run_dir))
        self.assertEqual(run.exact(run.table("statics-rings")), {})
        drawn = {figure.name: figure.caption for kind in ("rings", "rods") for figure in page.figure_of(run, run.table(f"statics-{kind}"))
                 if isinstance(figure, page.Figure)}
        self.assertIn("No theory for this kind", drawn["statics-rings"])
        self.assertNotIn("No theory", drawn["statics-rods"])
        exact = run.exact(run.table("statics-rods"))
        self.assertEqual(sorted(exact), ["Ree2", "cos", "l", "lp"])
        self.assertAlmostEqual(exact["l"], 0.538462)
        self.assertAlmostEqual(exact["Ree2"], 5.82559**2, places=3)
        table = run.table("statics-rods")
        table.data["l"] = exact["l"] + 6 * table.errors("l")
        self.assertTrue(any("statics-rods: l = " in text and "6.0 standard errors" in text for text in distrust.of_run(run)))

    # --- single files, two runs ---

    def test_a_table_alone(self):
        code, told, _ = plot(self.run_dir / "statics-rods.csv", "--out", self.dir / "statics.html")
        self.assertEqual((code, told), (0, f"{self.dir}/statics.html\n"))
        self.assertEqual(Page(self.dir / "statics.html").tables, ["statics-rods"])

    def test_a_checkpoint_alone(self):
        shutil.copy(self.run_dir / "checkpoint.h5", self.dir / "state.h5")
        self.assertEqual(plot(self.dir / "state.h5")[0], 0)
        alone = Page(self.dir / "state.html")
        self.assertEqual((len(alone.images), alone.tables), (1, []))
        self.assertIn("1 frame, to step 200 (2 t0)", alone.said)

    def test_a_line_that_is_being_written(self):
        """A run that is still going may have written a part of a line."""
        where = self.copy("growing")
        record = json.loads((where / "run.json").read_text())
        text = (where / "temperature.csv").read_text()
        (where / "temperature.csv").write_text(text[:-30])
        self.assertTrue(any("temperature.csv:42:" in line for line in runs.read(str(where)).trouble))
        (where / "run.json").write_text(json.dumps({**record, "status": "running"}))
        run = runs.read(str(where))
        self.assertEqual((run.trouble, run.table("temperature").rows), ([], 40))

    def test_an_unknown_table_is_drawn(self):
        path = self.dir / "other.csv"
        path.write_text("density,pressure,pressure_error\n1,2,0.1\n2,3,0.2\n4,nan,nan\n")
        table = tables.read(path, "other")
        self.assertEqual((table.x, table.values), ("density", ["pressure"]))
        self.assertTrue(all("<svg" in svg for svg, _ in tables.figure(table)))

    def test_compare(self):
        for name, seed in (("one", 5), ("two", 6)):
            (self.dir / f"{name}.yaml").write_text(re.sub("observe:.*", "observe: {temperature: {every: 5}, statics: {every: 5}}",
                                                          SCENE).replace("trajectory: {every: 50}\n", ""))
            self.assertEqual(uncross("run", self.dir / f"{name}.yaml", "--out", self.dir / name, "--seed", seed, "--quiet")[0], 0)
        out = self.dir / "both.html"
        code, _, error = plot("--compare", self.dir / "one", self.dir / "two", "-o", out)
        self.assertEqual((code, error), (0, ""))
        both = Page(out)
        self.assertEqual(sorted(set(both.tables)), ["statics-rings", "statics-rods", "temperature"])
        a, b = (tables.read(self.dir / name / "statics-rods.csv", "statics-rods") for name in ("one", "two"))
        z = (b.data["l"][0] - a.data["l"][0]) / math.hypot(a.data["l_error"][0], b.data["l_error"][0])
        row = re.search(r"of &#39;rods&#39;, in numbers.*?bond length</td>.*?</tr>", both.text, re.S)[0]
        self.assertIn(f'<td class="n">{z:+.1f}</td>', row)
        self.assertNotIn("the same random numbers", both.said)
        same = runs.read(str(self.dir / "one"))
        self.assertEqual(distrust.kin_of_pair(same, same)[0][:52], "Both draw the same random numbers (stream 5): their f"[:52])
        begun, other = ({"stream": stream, "stream_from": {"stream": "1", "step": 3, "state": "0f"}} for stream in "34")
        told = distrust.kin_of_pair(types.SimpleNamespace(records=[begun]), types.SimpleNamespace(records=[other]))
        self.assertEqual([text[:40] for text in told], ["Both begin with the same state of a snap"])

    def test_runs_of_a_sweep_that_are_no_independent_ones(self):
        self.assertEqual(distrust.kin({"a": [("5", ""), ("6", "")], "b": [("7", "")]}), [])
        twice, apart = distrust.kin({"a": [("5", ""), ("5", "")]}), distrust.kin({"a": [("5", "")], "b": [("5", "")]})
        self.assertIn("a: runs that are averaged draw the same random numbers", twice[0])
        self.assertIn("All points have the same seeds", apart[0])
        begun = distrust.kin({"a": [("5", "0f"), ("6", "0f")]})
        self.assertIn("begin with the same state of a snapshot", begun[0])
        self.assertEqual([len(twice), len(apart), len(begun)], [1, 1, 1])

    def test_differences_are_of_the_same_place(self):
        a = tables.Table("dynamics-x", {"time": numpy.array([1.0, 2, 3]), "g": numpy.array([1.0, 4, 9]),
                                        "g_error": numpy.array([0.3, 0.3, 0.3])})
        b = tables.Table("dynamics-x", {"time": numpy.array([2.0, 3, 5]), "g": numpy.array([5.0, 7, 1]),
                                        "g_error": numpy.array([0.4, 0.4, 0.4])})
        x, gap, error = tables.difference(a, b, "g")
        self.assertEqual((x.tolist(), gap.tolist()), ([2, 3], [1, -2]))
        numpy.testing.assert_allclose(error, 0.5)
        self.assertAlmostEqual(tables.summary(a, b, "g")[4], -4.0)
        self.assertEqual(tables.difference(b, a, "g")[1].tolist(), [-1, 2])

    def test_numbers_with_errors(self):
        for value, error, text in ((1.23456, 0.0123, "1.235 ± 0.012"), (123.4, 5.6, "123.4 ± 5.6"), (1234, 56, "1234 ± 56"),
                                   (1.2e-5, 3e-7, "(1.200 ± 0.030)e-5"), (-2.5, 0.0, "-2.5"), (math.nan, 1, "nan")):
            self.assertEqual(page.with_error(value, error), text)

    # --- refusals ---

    def test_nothing_is_written_over(self):
        before = self.page.text.encode()
        code, told, error = uncross("plot", self.run_dir)
        self.assertEqual((code, told), (2, ""))
        self.assertEqual(error, f"uncross: {self.run_dir}/page.html: is there already, and nothing is written over; "
                         "--out FILE names another\n")
        self.assertEqual((self.run_dir / "page.html").read_bytes(), before)
        with contextlib.redirect_stderr(io.StringIO()):  # one that appears while the page is made
            self.assertEqual(program.write(str(self.run_dir / "page.html"), "other"), 4)
        self.assertEqual((self.run_dir / "page.html").read_bytes(), before)

    def refused(self, text, *words, code=2):
        out = self.dir / "refused.html"
        found, told, error = plot(*words, *([] if "-o" in words else ["-o", out]))
        self.assertEqual((found, told), (code, ""), error)
        self.assertEqual(error.count("\n"), 1, error)
        self.assertIn(text, error)
        self.assertFalse(out.exists())

    def test_what_is_refused(self):
        bad = self.dir / "bad.csv"
        bad.write_text("time,g\n1,2\n2,two\n")
        (self.dir / "good.csv").write_text("time,g\n1,2\n2,3\n")
        empty = self.dir / "empty"
        empty.mkdir()
        self.refused("nowhere: No such file or directory", self.dir / "nowhere")
        self.refused("mix.yaml: neither a folder of a run, nor a table", self.dir / "mix.yaml")
        self.refused("bad.csv:3:3: 'two' is not a number", bad)
        self.refused("empty: not the folder of a run", empty)
        self.refused("give the folder of the run", self.run_dir / "run.json")
        self.refused("--compare takes two", "--compare", self.run_dir)
        self.refused("no trajectory of two frames or more for --movie", self.run_dir / "checkpoint.h5", "--movie")
        self.refused("cannot write: No such file or directory", bad.with_name("good.csv"), "-o", self.dir / "no" / "page.html",
                     code=4)
        code, _, error = plot(self.run_dir, self.run_dir)
        self.assertEqual(code, 2)
        self.assertIn("--out FILE is missing", error)

    def test_fibers_without_solvent_have_pages(self):
        """`uncross check` has no friction of a vertex in a medium that is overdamped, or where there is none."""
        scene = ("box: [8, 8, 8]\ntime_step: 0.001\nsteps: 20\nfibers: [{name: a, count: 2, vertices: 8, mass: 2, bond_length: 0.5, spring: 100, "
                 "bending: 50}]\ncrossing: {forbidden: false}\nobserve: {dynamics: {every: 5}}\n")
        for number, line in enumerate(("", "medium: {kind: overdamped, rate: 10}\n", "medium: {kind: overdamped, rate: 10, inextensible: true}\n",
                                       "walls: {kind: slip}\n", "medium: {kind: private, rate: 10}\n")):
            path = self.dir / f"alone{number}"
            path.with_suffix(".yaml").write_text(scene + line)
            self.assertEqual(uncross("run", path.with_suffix(".yaml"), "--out", path, "--quiet")[0], 0)
            run = runs.read(str(path))
            self.assertEqual(len(page.guides(run, "a")), line.startswith("medium: {kind: private"))
            self.assertEqual(bool(run.derived[0][0].startswith("Medium")), line.startswith("medium"))

    def test_surroundings_do_not_change_a_page(self):
        """Settings of matplotlib in the current folder, of the user and of the environment; Python's own."""
        table = self.dir / "surrounded.csv"
        table.write_text("time,g,g_error\n1,2,0.1\n2,3,0.1\n3,5,0.1\n")
        hostile = self.dir / "hostile"
        (hostile / "matplotlib").mkdir(parents=True)
        for place in (hostile, hostile / "matplotlib"):
            (place / "matplotlibrc").write_text("text.usetex: True\naxes.facecolor: red\nlines.linewidth: 9\n")
        settings = {"MPLBACKEND": "nonsense", "PYTHONWARNINGS": "error", "MATPLOTLIBRC": str(hostile / "matplotlibrc"),
                    "XDG_CONFIG_HOME": str(hostile)}
        pages = []
        for number, (folder, more) in enumerate(((self.dir, {}), (hostile, settings))):
            done = support.uncross("plot", table, "-o", self.dir / f"page{number}.html", cwd=folder, env={**os.environ, **more})
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            pages.append((self.dir / f"page{number}.html").read_bytes())
        self.assertEqual(*pages)

    def test_nobody_listens(self):
        """All descriptors closed, as of a daemon; a full disk under standard error."""
        table = self.dir / "unheard.csv"
        table.write_text("time,g\n1,2\n2,3\n")
        for number, closed in enumerate(('<&- >&- 2>&-', '2>/dev/full')):
            page_path = self.dir / f"unheard{number}.html"
            done = support.subprocess.run(["sh", "-c", f'exec "$@" {closed}', "sh", UNCROSS, "plot", table, "-o", page_path], check=False,
                                          stdout=support.subprocess.DEVNULL)
            self.assertEqual((done.returncode, page_path.exists()), (0, True), closed)

    def test_figures_without_data_say_so(self):
        """Frozen fibers do not move: each mean square displacement is 0, which has no logarithm, and curves are one, with all names."""
        table = self.dir / "dynamics-a.csv"
        names = ("end_to_end", "end_to_end_unit", "axis_unit")
        table.write_text("time,intervals,g,g_error,D,D_error," + ",".join(f"{name},{name}_error" for name in names) + "\n" +
                         "".join(f"{t},{100 - t},0,0,0,0,1,0,1,0,1,0\n" for t in (1, 2, 4, 8, 16)))
        self.assertEqual(plot(table, "-o", self.dir / "frozen.html"), (0, f"{self.dir}/frozen.html\n", ""))

    def test_tables_that_no_sweep_wrote(self):
        folder = self.dir / "foreign"
        folder.mkdir()
        (folder / "summary.csv").write_text("folder,seeds\na,1\n")
        (folder / "runs.csv").write_text("name\na\n")
        self.refused("runs.csv: not a table of a sweep: no column folder", folder)

    def test_a_missing_package_is_named(self):
        hidden = self.dir / "hidden"
        hidden.mkdir()
        (hidden / "sitecustomize.py").write_text("import importlib.util as u\nfind = u.find_spec\n"
                                                 "u.find_spec = lambda n, *a: None if n == 'h5py' else find(n, *a)\n")
        code, told, error = uncross("plot", self.run_dir, "-o", self.dir / "hidden.html",
                                    environment={"PYTHONPATH": str(hidden), "PATH": "/usr/bin:/bin"})
        self.assertEqual((code, told), (1, ""))
        self.assertEqual(error, "uncross: plot: needs python3-h5py; `apt-get install python3-h5py` installs what is missing\n")
        group = re.search(r"\[plot\]=\"(.*)\"", (TOP / "tools/install-dependencies").read_text())[1].split()
        program = (TOP / "tools/uncross-plot").read_text()
        self.assertEqual(sorted(re.findall(r"python3-\w+", program.split("NEEDED")[1].split("}")[0])), sorted(group[1:]))


if __name__ == "__main__":
    unittest.main()

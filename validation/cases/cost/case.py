"""Sec. IV D: what a step costs, and how long one tau_r takes."""
import numpy

from lib import figures
from lib import semidilute as sd
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "Run time against volume and density"
PAPER = "Sec. IV D"

# Cells along an edge: fibers. c L^3 = 100 in growing boxes; growing density in the paper's box.
VOLUMES = ((16, 12), (20, 24), (24, 42), (32, 100), (40, 195), (48, 338))
DENSITIES = ((32, 0), (32, 30), (32, 55), (32, 100), (32, 175), (32, 300), (32, 550), (32, 1000))


def campaign():
    systems = [f"{cells}:{fibers}" for cells, fibers in dict.fromkeys(VOLUMES + DENSITIES)]
    return [Run("steps", program=["step_cost", 9, 200, *systems, "32:200:32"], hours=0.03)]  # the last: each cut in two


def runs(tier):
    """None in the quick tier: a time decides no merge, and `make counts` sees a slower step."""
    return campaign() if tier == "campaign" else []



# --- what runs say ----------------------------------------------------------------------------------------------------

def rows(results):
    if "steps" not in results or not results["steps"].text:
        return []
    table = results["steps"].columns
    return [{key: float(table[key][k]) for key in table if key not in ("rule", "scheme")} for k in range(len(table["cells"]))]


def exponent(x, y):
    """(slope of ln y against ln x, error from scatter)."""
    x, y = numpy.log(x), numpy.log(y)
    slope, height = numpy.polyfit(x, y, 1)
    spread = numpy.sqrt(((y - slope * x - height)**2).sum() / max(len(x) - 2, 1) / ((x - x.mean())**2).sum())
    return float(slope), float(spread)


def by_volume(table):
    return [row for row in table if abs(row["cL3"] - 100) < 5 and row["vertices"] == 64]


def by_density(table):
    edge = 32 if any(row["cells"] == 32 and row["fibers"] != 100 for row in table) else 16
    return [row for row in table if row["cells"] == edge and row["vertices"] == 64]


def hours(milliseconds, time):
    """Of so many t0 at dt 0.01."""
    return milliseconds * time * 100 / 3.6e6


def short_rotation_time():
    """tau_r of fibers cut in two, scaled from the paper's as rigid rods'."""
    whole, half = (sd.rod_rotation_time((n - 1) * sd.BOND, 0.6, 11.184) for n in (64, 32))
    return sd.PAPER_ROTATION_TIME * half / whole


def evaluate(results, tier):
    if tier == "quick":
        return Outcome([], [], "")
    table = rows(results)
    volume = Verdict("cost.volume", "exponent of CPU time per step against volume, c L³ = 100", 1.0,
                     "paper: proportional to the volume; every stage is a loop over particles or cells", 0.05, kind="paper", timed=True,
                     reason="Larger boxes outgrow the caches.")
    density = Verdict("cost.density", "exponent of the fibers' share of CPU time against c L³, upper half of the "
                                      "densities", 1.0,
                      "paper: rate “scales approximately inversely linear with … c L³”; tests of pairs grow faster", 0.05,
                      kind="paper", timed=True,
                      reason="The number of pairs of bonds that come near each other grows as the square of the "
                             "density.")
    prose = PROSE
    if len(by_volume(table)) >= 3:
        chosen = by_volume(table)
        sd.measured(volume, exponent([row["cells"]**3 for row in chosen],
                                     [row["milliseconds"] for row in chosen]), 0.05)
    chosen = by_density(table)
    if len(chosen) >= 3:
        bare = min(row["milliseconds"] for row in chosen)
        upper = sorted((row for row in chosen if row["fibers"] > 0), key=lambda row: row["cL3"])[-3:]
        sd.measured(density, exponent([row["cL3"] for row in upper],
                                      [row["milliseconds"] - bare for row in upper]), 0.05)
    standard = next((row for row in table if row["cells"] == 32 and row["fibers"] == 100 and row["vertices"] == 64), None)
    if standard:
        ms = standard["milliseconds"]
        prose += (f"\n\nAt c L³ = 100 a step takes {ms:.2f} ms here, {1000 / ms:.0f} steps per second, the paper's "
                  f"30. One τ_r of 8.3·10⁴ t0 at "
                  f"dt 0.01: **{hours(ms, sd.PAPER_ROTATION_TIME):.1f} h, the paper's 75 h**.")
    cut = next((row for row in table if row["vertices"] == 32), None)
    if standard and cut:
        ms = cut["milliseconds"]
        prose += (f" Each fiber cut in two, at the same mesh size: {ms / standard['milliseconds']:.2f} times as long per "
                  f"step, τ_r {short_rotation_time():.3g} t0 (rigid rods): **{hours(ms, short_rotation_time()):.1f} h, the "
                  f"paper's 11 h**.")
    for row in table:
        if row["cells"] == 32 and row["vertices"] == 64 and row["fibers"] in (30, 300, 1000):
            prose += f" c L³ = {row['fibers']:.0f}: {hours(row['milliseconds'], sd.PAPER_ROTATION_TIME):.1f} h."
    return Outcome([volume, density], [Figure("cost", "Smallest CPU time of a step in nine rounds; in each, every system has its turn. Left: growing boxes "
                                                      "at c L³ = 100. "
                                              "Right: growing density, and the same less the time of the box without "
                                              "fibers.",
                                              lambda: draw(table))], prose)


def draw(table):
    figure, above, below = figures.with_residuals(height=4.6, columns=2)
    chosen = by_volume(table)
    if chosen:
        volume = numpy.array([row["cells"]**3 for row in chosen])
        time = numpy.array([row["milliseconds"] for row in chosen])
        error = numpy.array([row["milliseconds_error"] for row in chosen])
        per = time[0] / volume[0]
        figures.points(above[0], volume, time, error, 0, label="measured")
        figures.theory(above[0], volume, per * volume, label="∝ volume")
        figures.points(below[0], volume, time / volume / per - 1.0, error / volume / per, 0)
    chosen = [row for row in by_density(table) if row["fibers"] > 0]
    if len(chosen) > 1:
        bare = min(row["milliseconds"] for row in by_density(table))
        density = numpy.array([row["cL3"] for row in chosen])
        time = numpy.array([row["milliseconds"] for row in chosen])
        error = numpy.array([row["milliseconds_error"] for row in chosen])
        figures.points(above[1], density, time, error, 0, label="a step")
        figures.points(above[1], density, time - bare, error, 1, label="less the solvent's")
        line = (time - bare)[0] * density / density[0]
        figures.theory(above[1], density, line, label="∝ c L³")
        figures.points(below[1], density, (time - bare) / line - 1.0, error / line, 1)
    for panel, residual, label in zip(above, below, ("volume ($a_0^3$)", "$cL^3$")):
        panel.set(xscale="log", yscale="log", ylabel="CPU ms per step")
        residual.set(xscale="log", xlabel=label, ylabel="over line − 1")
        figures.legend(panel)
    return figure


PROSE = """Run time is linear in the volume, and grows faster where boxes outgrow the caches. The fibers' share is linear in c L³
up to some 200. At higher density the search for crossings adds a part that grows as its square. Times are of one core of
the machine of this run, and have no verdict; exponents have. Error bars: the difference to the second fastest of nine
rounds."""

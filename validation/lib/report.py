"""The report: report.html, report.json, report.xml, from the results of runs. The same data make the same bytes."""
import concurrent.futures
import functools
import html
import json
import math
import multiprocessing
import pathlib
import re
import traceback
import xml.etree.ElementTree as xml

import jinja2

from lib import case as cases
from lib import figures, runs

TITLES = {"quick": "Reduced systems (make validate)", "campaign": "The paper's own systems (make campaign)"}
TEMPLATE = pathlib.Path(__file__).resolve().parent / "report.html.jinja"


def rounded(x, digits=10):
    """Rounded to far more digits than any error bar has, and fewer than another libm or BLAS changes."""
    if x is None or not math.isfinite(x):
        return None
    return float(f"{x:.{digits}g}")


def verdict_row(case, verdict):
    return {"id": verdict.id, "claim": case, "statement": verdict.statement, "source": verdict.source,
            "kind": verdict.kind, "verdict": verdict.verdict, "reason": "; ".join(filter(None, (verdict.moves, verdict.reason))),
            **{key: rounded(getattr(verdict, key)) for key in
               ("expected", "expected_error", "measured", "error", "tolerance", "allowed", "z")},
            "detects": rounded(verdict.seen), "power": rounded(verdict.power),
            **({"second": [rounded(x) for x in verdict.second]} if verdict.second else {}), **({"timed": True} if verdict.timed else {}),
            **({"doubtful": True} if verdict.verdict == "undecided" and verdict.doubtful and not verdict.blind else {})}


def failures(rows, tier):
    """Those rows of verdicts that make the report fail. In the quick tier all runs are made, so each number must be there, and be
    decided, but for one that a busy machine makes uncertain, and one of 3 to 4.4 standard errors, which chance makes in one verdict of 370."""
    return [row for row in rows if row["verdict"] == "fail" or (
        tier == "quick" and row["verdict"] == "undecided" and not row.get("doubtful") and not (row.get("timed") and row["measured"] is not None))]


def provenance_row(result):
    """Which run of which code this was."""
    session, record, run = result.session, result.record, result.run
    version = re.fullmatch(r"\S+ (\S+) \(commit (\S+); (.*); (-std.*)\)", session.get("version", "")) or [""] * 5
    return {"run": run.path, "what": " ".join(session.get("command", [])), "seed": run.seed if run.scene else None,
            "steps": result.steps or None, "wanted": run.steps or None, "finished": result.finished,
            "commit": record.get("commit", version[2]), "compiler": record.get("compiler", version[3]),
            "fingerprint": record.get("scene_fingerprint"), "state_hash": record.get("state_hash"),
            "digest": result.digest, "cpu_seconds": result.cpu_seconds}


def evaluate(module, name, results, tier):
    """(verdicts, figures, prose) of a case. If its evaluation raises an error, this is a failed verdict, and the other cases go on."""
    try:
        outcome = cases.evaluate(module, results, tier)
        with figures.styled():
            drawn = [{"name": figure.name, "caption": figure.caption, "svg": figures.svg(figure.draw())}
                     for figure in outcome.figures]
        return [verdict_row(name, verdict) for verdict in outcome.verdicts], drawn, outcome.prose
    except Exception as error:  # whatever it is: results may be nan, or not there
        traceback.print_exc()
        return [verdict_row(name, cases.Verdict(f"{name}.evaluate", "the case can be evaluated", 1.0, "", 0.0, measured=0.0,
                                                 reason=f"{type(error).__name__}: {error}"))], [], ""


def section(name, tier, every):
    """The section of one case. The case is given the results that exist; runs without results are not in the dict."""
    module = cases.load(name)
    results = [result for result in every if result.run.case == name]
    present = {result.run.name: result for result in results if result.exists}
    present.update({result.run.path: result for result in every
                    if result.exists and result.run.case in getattr(module, "USES", ())})
    verdicts, drawn, prose_text = evaluate(module, name, present, tier)
    return {"id": name, "title": module.TITLE, "paper": module.PAPER, "prose": prose_text, "figures": drawn,
            "verdicts": verdicts,
            "runs": [provenance_row(result) for result in results if result.exists],
            "absent": [result.run.path for result in results if not result.exists],
            "unfinished": [result.run.path for result in results if result.exists and not result.finished],
            "cpu_seconds": math.fsum(result.cpu_seconds for result in results),
            "hours_estimated": math.fsum(result.run.hours for result in results)}


def junit(tier, sections):
    """JUnit XML, a test case per verdict. A finding about the paper ("not reproduced") passes, with its text. "Undecided" is a
    failure if `failures` says so, and else skipped."""
    suites = xml.Element("testsuites", name="validation")
    for part in sections:
        bad = failures(part["verdicts"], tier)
        skipped = [row for row in part["verdicts"] if row["verdict"] == "undecided" and row not in bad]
        suite = xml.SubElement(suites, "testsuite", name=part["id"], tests=str(len(part["verdicts"])),
                               failures=str(len(bad)), skipped=str(len(skipped)), time=f"{part['cpu_seconds']:.1f}")
        for row in part["verdicts"]:
            case = xml.SubElement(suite, "testcase", classname=part["id"], name=row["id"])
            text = (f"{row['statement']}: measured {row['measured']} +- {row['error']}, expected {row['expected']}, "
                    f"tolerance {row['tolerance']} ({row['source']}). {row['reason']}")
            if row in bad:
                xml.SubElement(case, "failure", message=row["verdict"]).text = text
            elif row in skipped:
                xml.SubElement(case, "skipped", message=text)
            else:
                xml.SubElement(case, "system-out").text = f"{row['verdict']}: {text}"
    xml.indent(suites)
    return xml.tostring(suites, encoding="unicode", xml_declaration=True) + "\n"


def digits_of(x, error):
    """(digits after the point, power of ten to take out): two digits of the error, at most six of the number."""
    scale = max(abs(x), abs(error))
    power = math.floor(math.log10(scale)) if scale > 0 and not 1e-3 <= scale < 1e5 else 0
    digits = 1 - math.floor(math.log10(error)) if error > 0 else 3 - math.floor(math.log10(scale)) if scale > 0 else 0
    most = 5 - math.floor(math.log10(scale)) if scale > 0 else 0
    return max(0, min(digits, most) + power), power


def plusminus(x, error):
    """12.34 ± 0.56, both to the same digit; without an error, four significant digits."""
    if x is None:
        return "–"
    digits, power = digits_of(x, error or 0.0)
    text = f"{x / 10.0**power:.{digits}f}"
    if error:
        text += f" ± {error / 10.0**power:.{digits}f}"
    text = text.replace("-", "−")
    return f"({text})·10{superscript(power)}" if power and error else f"{text}·10{superscript(power)}" if power else text


def number(x):
    """Three significant digits, for numbers that need no more."""
    if x is None:
        return "–"
    if x == 0 or 1e-3 <= abs(x) < 1e5:
        return f"{x:.3g}".replace("-", "−")
    power = math.floor(math.log10(abs(x)))
    return f"{x / 10.0**power:.3g}·10{superscript(power)}".replace("-", "−")


def signed(z):
    return "" if z is None else f"{z:+.1f}".replace("-", "−")


def superscript(power):
    return str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def code(text):
    """HTML of a line with `code`."""
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(text.strip(), quote=False))


def prose(text):
    """Paragraphs with `code` and **bold** as HTML."""
    marked = code(text)
    marked = re.sub(r"\*\*(.+?)\*\*", r"<b>\1</b>", marked)
    return "".join(f"<p>{paragraph}</p>\n" for paragraph in re.split(r"\n\s*\n", marked) if paragraph.strip())


def page(tier, sections):
    environment = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(prose=prose, cpu=runs.duration, number=number, plusminus=plusminus, code=code, signed=signed,
                               badge=lambda row: row["verdict"].split()[0])
    return environment.from_string(TEMPLATE.read_text()).render(
        tier=tier, titles=TITLES, sections=sections, total=math.fsum(part["cpu_seconds"] for part in sections),
        count={one: sum(row["verdict"] == one for part in sections for row in part["verdicts"]) for one in cases.VERDICTS})


def summary(tier, sections):
    """What report.json holds."""
    keys = ("id", "title", "paper", "cpu_seconds", "hours_estimated", "absent", "unfinished")
    return {"tier": tier, "claims": [row for part in sections for row in part["verdicts"]],
            "sections": [{key: part[key] for key in keys} for part in sections],
            "runs": [row for part in sections for row in part["runs"]]}


STANDING = """# Where the campaign stands

<!-- written by `validation/run report --tier campaign` -->

**[The paper's figures, beside this program's](paper.md)**: what each figure and table of the paper shows, what this program shows, and why they differ where they do.

**[Every row of the sources](rows.md)**: each figure, equation and claim of the paper, the slides and the dumbbell fluid, with its state, the verdict that decides, and what is absent with its cost.

The campaign runs the paper's own systems. It has used {hours:.1f} of the {planned:.0f} core-hours that are planned. This page counts its
[verdicts](../../validation/README.md#verdicts), and lists all that are not a pass.
All numbers, those that pass too, stand in `reference-data/campaign/report.json`; `validation/run report --tier campaign` makes the page of it, `report.html` beside it.

| claim | | pass | within allowance | fail | not reproduced | undecided | runs: finished, begun, all | core-hours |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |
{cases}
{failed}
## How large the differences are

Standard errors z between measured and expected number, of all verdicts that have both. Normal errors and right theories would make the last row.

| | up to 1 | 1 to 2 | 2 to 3 | 3 to 4.4 | above | root mean square |
| --- | --- | --- | --- | --- | --- | --- |
{differences}

## What a verdict can see

The *power* of a verdict is the smallest change of the value that would turn it red in 95 of 100 repetitions: the tolerance, and 1.64 standard errors. It is below {power[0]} of the expected number for a
quarter of the verdicts, below {power[1]} for half of them, and below {power[2]} for three quarters. The report has each of them. These see no change of less than 30 %:
{blunt}.

## Within the theory's stated allowance

The difference is larger than the error bars explain, and smaller than the error that was stated for the theory beforehand. Measured (expected); the report has the
rest.

{covered}

## Not reproduced

The measured number differs from the paper's, or from the number of a formula that the paper uses. The last column gives the reason, where it is known.

| | measured | expected | why |
| --- | --- | --- | --- |
{findings}

## Undecided

The number is not measured yet, or its error is still so large that it would agree with a wrong value, too.

| | so far | expected |
| --- | --- | --- |
{undecided}
"""


FAILED = """
## Fail

The numbers should agree, and do not.

| | measured | expected | z |
| --- | --- | --- | --- |
{failed}
"""


def differences(claims):
    """Rows of the table of z: of the verdicts of each word, and of normal errors."""
    edges, lines = (0.0, 1.0, 2.0, 3.0, 4.4, math.inf), []
    for word in ("pass", "within allowance", "fail", "not reproduced"):
        z = [abs(row["z"]) for row in claims if row["verdict"] == word and row["z"] is not None]
        if z:
            counts = [sum(low < x <= high for x in z) + (low == 0.0) * z.count(0.0) for low, high in zip(edges, edges[1:])]
            lines.append(f"| {word} | {' | '.join(map(str, counts))} | {math.sqrt(math.fsum(x * x for x in z) / len(z)):.1f} |")
    chance = [math.erfc(low / math.sqrt(2.0)) - math.erfc(high / math.sqrt(2.0)) for low, high in zip(edges, edges[1:])]
    all_of_them = sum(row["verdict"] == "pass" for row in claims)
    return "\n".join([*lines, f"| {all_of_them} normal values | {' | '.join(number(all_of_them * p) for p in chance)} | 1.0 |"])


BLUNT = 0.3  # of the expected number


def powers(claims):
    """Three quartiles of power over expected number, of what agrees; and the names of those that are above BLUNT."""
    share = {row["id"]: row["power"] / abs(row["expected"]) for row in claims
             if row["verdict"] in ("pass", "within allowance") and row["expected"] and row.get("power") is not None}
    ordered = sorted(share.values()) or [math.nan]
    quartiles = [f"{100 * ordered[len(ordered) * k // 4]:.2g} %" for k in (1, 2, 3)]
    return quartiles, ", ".join(f"`{name}` ({100 * x:.0f} %)" for name, x in share.items() if x > BLUNT) or "none"


def standing(summed):
    """docs/claims/README.md, from what report.json holds."""
    def rows(case, word):
        return [row for row in summed["claims"] if row["claim"] == case and row["verdict"] == word]

    def cell(text):
        return " ".join(text.split()).replace("|", "\\|")
    table, failed, covered, findings, undecided = [], [], [], [], []
    for part in summed["sections"]:
        name, counts = part["id"], [len(rows(part["id"], word)) for word in cases.VERDICTS]
        have = sum(row["run"].startswith(name + "/") for row in summed["runs"])
        table.append(f"| [{name}]({name}.md) | {cell(part['title'])} | {' | '.join(map(str, counts))} | "
                      f"{have - len(part['unfinished'])}, {have}, {have + len(part['absent'])} | {part['cpu_seconds'] / 3600.0:.1f} |")
        failed += [f"| `{row['id']}`: {cell(row['statement'])} | {plusminus(row['measured'], row['error'])} | "
                   f"{plusminus(row['expected'], row['expected_error'])} ({cell(row['source'])}) | {signed(row['z'])} |" for row in rows(name, "fail")]
        near = [f"`{row['id'].removeprefix(name + '.')}` {plusminus(row['measured'], row['error'])} ({number(row['expected'])})"
                for row in rows(name, "within allowance")]
        covered += [f"- [{name}]({name}.md): {', '.join(near)}"] if near else []
        reasons = [cell(row["reason"]) for row in rows(name, "not reproduced")]
        findings += [f"| `{row['id']}`{'' if reason == last else ': ' + cell(row['statement'])} | {plusminus(row['measured'], row['error'])} | "
                     f"{plusminus(row['expected'], row['expected_error'])} | {'as above' if reason == last else reason} |"
                     for row, reason, last in zip(rows(name, "not reproduced"), reasons, [None, *reasons])]
        undecided += [f"| `{row['id']}`: {cell(row['statement'])} | {plusminus(row['measured'], row['error'])} | "
                      f"{plusminus(row['expected'], row['expected_error'])} |" for row in rows(name, "undecided")]
    quartiles, blunt = powers(summed["claims"])
    return STANDING.format(differences=differences(summed["claims"]), power=quartiles, blunt=blunt, hours=math.fsum(part["cpu_seconds"] for part in summed["sections"]) / 3600.0,
                           planned=math.fsum(part["hours_estimated"] for part in summed["sections"]),
                           cases="\n".join(table), failed=FAILED.format(failed="\n".join(failed)) if failed else "", covered="\n".join(covered) or "- nothing", findings="\n".join(findings), undecided="\n".join(undecided) or "| nothing | | |")


def write_standing(summed, page):
    page.write_text(standing(json.loads(summed.read_text())))


def all_sections(names, tier, results, jobs):
    """The sections in their order, made by so many processes. Each process takes the next case when it has time."""
    make_one = functools.partial(section, tier=tier, every=results)
    if jobs == 1:
        return list(map(make_one, names))
    with concurrent.futures.ProcessPoolExecutor(jobs, multiprocessing.get_context("fork")) as pool:
        return list(pool.map(make_one, names))


def renewed(old, new, order):
    """A summary in which the cases of a newer one take the place of what they were. order: names of all cases."""
    case_of = {"claims": lambda row: row["claim"], "sections": lambda row: row["id"], "runs": lambda row: row["run"].partition("/")[0]}
    again = {part["id"] for part in new["sections"]}
    found = {"tier": new["tier"]}
    for key, case in case_of.items():
        rows = [row for row in old[key] if case(row) in order and case(row) not in again] + new[key]
        found[key] = sorted(rows, key=lambda row: order.index(case(row)))
    return found


def make(tier, all_runs, names, work, out, jobs=1, renew=False):
    """Writes the three files into `out`; 1 if a verdict is among its `failures`. renew: report.json keeps its other cases, and is the only file."""
    results = runs.results_of(all_runs, work)
    sections = all_sections(names, tier, results, jobs)
    sections = [part for part in sections if part["verdicts"] or part["runs"]]
    out = pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    found = summary(tier, sections)
    if renew:
        found = renewed(json.loads((out / "report.json").read_text()), found, cases.names())
    (out / "report.json").write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n")
    if renew:
        return tell(tier, sections, out)
    (out / "report.xml").write_text(junit(tier, sections))
    (out / "report.html").write_text(page(tier, sections))
    return tell(tier, sections, out)


def tell(tier, sections, out):
    rows = [row for part in sections for row in part["verdicts"]]
    width = max((len(row["id"]) for row in rows), default=0)
    for row in rows:
        z = "" if row["z"] is None else f"  z {row['z']:+.1f}"
        print(f"{row['verdict']:<14} {row['id']:<{width}}  {plusminus(row['measured'], row['error'])}, expected "
              f"{plusminus(row['expected'], row['expected_error'])} within {number(row['tolerance'])}{z}")
    bad = failures(rows, tier)
    undecided = [row for row in rows if row["verdict"] == "undecided" and row not in bad]
    for part in sections:
        print(f"{part['id']}: {runs.duration(part['cpu_seconds'])} of CPU time, {len(part['runs'])} runs")
    print(f"report: {out / 'report.html'}")
    if undecided:
        print(f"{len(undecided)} verdicts are undecided: their runs are to come, or too short, or the machine is too busy")
    print(f"{sum(row['verdict'] in ('pass', 'within allowance', 'not reproduced') for row in rows)} passed, {len(bad)} failed")
    return 1 if bad else 0

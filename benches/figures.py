#!/usr/bin/env python3
"""Draws the figures that benches/compare measures, and keeps the tables of docs/research what the CSV files say.

usage: figures.py [--check] RESULTS.csv ...

The files are those that `make figures` writes, of figures and of builds, in any order.

Writes docs/charts/figure-*.svg, and in docs/research/figures.md and docs/research/levels.md replaces what stands between <!-- table: NAME --> and
<!-- end -->. With --check it writes nothing and fails where a page differs, or a chart is not the drawing of these rows.
"""
import math
import os
import sys

import charts
import claims
from charts import BLUE, DASHED, DOTTED, FOREST, GREEN, GREY, INDIGO, ORANGE, PINK, RED, SKY, SOLID, WINE
from charts import Axis, Cell, Cells, Curve, Kind, Line, Panel, Panels, Row, Style
from rows import in_order, machine, read, with_numbers

PAGES = [os.path.join(charts.FOLDER, "..", "research", page) for page in ("figures.md", "levels.md")]
NUMBERS = ("best_ns", "mean_steps", "by_levels", "error", "best_ms", "bytes")
STYLES = {
    "most violated": Style("most violated plane (SWIFT)", BLUE),
    "first violated": Style("first violated plane (as in V-Clip, but not V-Clip)", RED, marker="s"),
    "nothing": Style("nothing: the last features", GREY),
    "LUT 2 5.625": Style("LUT 2 5.625", RED, marker="s"),
    "DK 100 Double-Double": Style("DK 100 Double-Double", GREEN, marker="^"),
    "quadric 0.03125": Style("quadric 0.03125", INDIGO, marker="D"),
    "cuts 0.03125": Style("outer cuts 0.03125 (ours)", ORANGE, marker="v"),
    "automatic": Style("automatic (ours)", BLUE),
    "shells": Style("shells (ours)", BLUE),
    "no levels": Style("no levels: automatic", BLUE),
    "quadric 0.25": Style("quadric 0.25", GREEN, marker="^"),
    "cuts 0.25": Style("outer cuts 0.25 (ours)", ORANGE, marker="v"),
    "2 levels": Style("2 levels", PINK, marker="D"),
    "3 levels": Style("3 levels", GREEN, marker="^"),
    "4 levels": Style("4 levels", ORANGE, marker="v"),
    "levels and table": Style("quadric 0.25, from shells (ours)", INDIGO, DASHED, "X"),
    "table alone": Style("no levels, from shells (ours)", SKY, DASHED, "P"),
}
for colour, cut_off in ((BLUE, 20), (GREEN, 100), (RED, 250)):
    for dash, marker, policy in ((SOLID, "o", "Single"), (DASHED, "s", "Single-Single"), (DOTTED, "^", "Double-Double")):
        STYLES[f"{cut_off} {policy}"] = Style(f"{cut_off} {policy}", colour, dash, marker)
for dash, marker, degrees in ((SOLID, "s", "5.625"), (DASHED, "^", "11.25")):
    for colour, factor in ((GREEN, 1), (RED, 2), (INDIGO, 4)):
        STYLES[f"{factor} {degrees}"] = Style(f"{factor} {degrees}", colour, dash, marker)
RATES = {
    "quadric 0.5": (GREY, SOLID, "s"), "quadric 0.25": (GREEN, SOLID, "^"), "quadric 0.125": (RED, SOLID, "P"),
    "quadric 0.0625": (WINE, SOLID, "X"), "quadric 0.03125": (INDIGO, SOLID, "D"), "cuts 0.25": (FOREST, DASHED, "^"),
    "cuts 0.03125": (ORANGE, DASHED, "v"),
}

QUERIES = {"distance": "exact distance", "intersection": "intersection", "approximate": "approximate distance, error 0.01",
           "contact": "contact"}
NAMES = {  # figure: title
    "5": "Figure 5: the rule of marching",
    "6": "Figure 6: look-up tables (radius factor, resolution in degrees), exact distance",
    "7": "Figure 7: Dobkin-Kirkpatrick levels (triangles of the coarsest, refinement), intersection",
    "8": "Figure 8: Dobkin-Kirkpatrick levels (triangles of the coarsest, refinement), exact distance",
    "9": "Figure 9: quadric levels (decimation, levels), intersection",
    "10": "Figure 10: quadric levels (decimation, levels), exact distance",
    "11": "Figure 11: the best of each, intersection",
    "12": "Figure 12: the best of each, exact distance",
}

def read_all(paths):
    """On what each figure was measured, and the rows of all files: of figures, and of builds."""
    heads, kinds = {}, {"figure": [], "bytes": []}
    for path in paths:
        head, rows = read(path)
        kind = next((kind for kind in kinds if kind in rows[0]), None)
        if kind is None:
            sys.exit(f"{path}: not a file of benches/compare")
        kinds[kind] += with_numbers(rows, NUMBERS)
        if kind == "figure":
            where = ", ".join(part for part in machine(head[0]).split(", ") if not part.endswith("passes"))
            heads.update({row["figure"]: where for row in rows})
    return heads, *kinds.values()


def style(name):
    """Names may end in a number of levels, as "quadric 0.25 (3)"."""
    base = name.split(" (")[0]
    if base != name and base in RATES:
        return Style(name, *RATES[base])
    return STYLES[name]


def chart(title, machine, x, panels, note=""):
    """panels: rows of panels of times, all over the same axis."""
    curves = [curve for row in panels for panel in row for curve in panel.curves]
    y = charts.value_axis("time a query", [ns for curve in curves for _, ns in curve.points], charts.duration)
    styles = {name: style(name) for name in in_order(curve.series for curve in curves)}
    return Panels(title, machine, x, styles, [Row(row, y, 190) for row in panels], note)


def over_motion(rows, place):
    points = {}
    for r in rows:
        points.setdefault(r["series"], {})[r["step"]] = (place[r["step"]], r["best_ns"])
    return [curve for series, found in points.items() for curve in charts.over_motion(series, found)]


def grid(rows, columns, title):
    """Rows of panels over the motion: one for each value of the one column, in each of them one for each value of the other."""
    x, place = charts.motion_axis(in_order(r["step"] for r in rows))
    panels = []
    for across in in_order(r[columns[0]] for r in rows):
        here = [r for r in rows if r[columns[0]] == across]
        panels.append([Panel(title(across, along), over_motion([r for r in here if r[columns[1]] == along], place))
                       for along in in_order(r[columns[1]] for r in here)])
    return x, panels


def paper_figures(heads, rows):
    for figure, title in NAMES.items():
        here = [r for r in rows if r["figure"] == figure]
        if here:
            x, panels = grid(here, ("orbit", "model"), lambda orbit, model: f"{model}-{model}, {orbit} orbit")
            yield f"figure-{figure}", chart(title, heads[figure], x, panels, "Bodies of 1,002 vertices.")


def error_curves(rows, place):
    """Approximate distance joined; intersection at the left end and exact distance at the right apart."""
    curves = []
    for series in in_order(r["series"] for r in rows):
        here = [r for r in rows if r["series"] == series]
        joined = [(place[r["error"]], r["best_ns"]) for r in here if r["query"] == "approximate"]
        apart = [(place[r["query"]], r["best_ns"]) for r in here if r["query"] in place]
        curves += [Curve(series, joined), Curve(series, apart, Kind.DOTS)]
    return curves


def error_figures(heads, rows):
    """Time over the error asked for."""
    rows = [r for r in rows if r["figure"] == "error"]
    if not rows:
        return
    errors = sorted({r["error"] for r in rows if r["query"] == "approximate"}, reverse=True)
    # To the right errors are smaller.
    place = {error: 1 / error for error in errors}
    place.update({"intersection": 0.08 / errors[0], "distance": 6 / errors[-1]})
    decades = [(place[error], f"{error:.0e}".replace("e-0", "e-")) for error in errors if f"{error:e}".startswith("1.000000")]
    ticks = [(place["intersection"], "verdict"), *decades, (place["distance"], "exact")]
    x = Axis("error of an approximate distance that was asked for, in radii; at the ends intersection and exact distance",
             place["intersection"] / 2.2, place["distance"] * 2.2, ticks)
    for step in ("10", "random"):
        panels = []
        for orbit in in_order(r["orbit"] for r in rows):
            models = in_order(r["model"] for r in rows)
            cells = {m: [r for r in rows if (r["orbit"], r["model"], r["step"]) == (orbit, m, step)] for m in models}
            panels.append([Panel(f"{m}-{m}, {orbit} orbit", error_curves(cell, place)) for m, cell in cells.items()])
        motion = "random poses" if step == "random" else f"{step}° a query"
        yield f"figure-error-{step}", chart(f"Time over the error asked for, {motion}", heads["error"], x, panels)


def size_figures(heads, rows):
    rows = [r for r in rows if r["figure"] == "size"]
    for query in in_order(r["query"] for r in rows):
        here = [r for r in rows if r["query"] == query]
        x, panels = grid(here, ("n", "model"), lambda n, model: f"{model}-{model}, {2 * n - 4:,} triangles")
        yield f"figure-size-{query}", chart(f"Larger bodies, {QUERIES[query]}, small orbit", heads["size"], x, panels)


RATIOS = ((1.1, charts.GOOD), (1.25, charts.BAD[0]), (1.6, charts.BAD[1]), (math.inf, charts.BAD[2]))


def choice_figure(heads, rows):
    """How many times as long as the best fixed setting the automatic one takes, cell by cell."""
    cells = claims.choice_cells(rows)
    if not cells:
        return
    steps, queries = in_order(step for *_, step in cells), in_order(query for query, *_ in cells)
    lines = []
    for query, orbit, model in sorted(in_order(key[:3] for key in cells), key=lambda line: queries.index(line[0])):
        here = []
        for step in steps:
            ratio, name, _ = cells[query, orbit, model, step]
            here.append(Cell(f"{ratio:.2f}", name.split()[0], next(colour for limit, colour in RATIOS if ratio <= limit)))
        label = f"{query}, {model}-{model}, {orbit}"
        lines.append(Line(label, here, gap_before=bool(lines) and not lines[-1].label.startswith(query)))
    names = {limit: f"up to {limit}" for limit, _ in RATIOS} | {math.inf: "more"}
    yield "figure-choice", Cells(
        "The automatic choice beside the best fixed setting of each cell", heads["choice"],
        "times as long as the best fixed setting, and which that is (quadric 0.03125, cuts 0.25: through levels)",
        [("random" if step == "random" else step + "°", "") for step in steps], lines,
        [(colour, names[limit]) for limit, colour in RATIOS], 170)


def figures(heads, rows):
    """All charts by name."""
    return dict(made for of_kind in (paper_figures, error_figures, size_figures, choice_figure) for made in of_kind(heads, rows))


def main():
    arguments = sys.argv[1:]
    check = arguments[:1] == ["--check"]
    paths = arguments[1:] if check else arguments
    if not paths:
        sys.exit(__doc__)
    heads, rows, builds = read_all(paths)
    made = claims.tables(rows, builds)
    for page in PAGES:
        with open(page) as file:
            text = file.read()
        filled = claims.fill(text, made)
        if check and filled != text:
            sys.exit(f"{page} does not say what the CSV files say: run make charts")
        if not check:
            with open(page, "w") as file:
                file.write(filled)
    for name, drawing in figures(heads, rows).items():
        path = os.path.join(charts.FOLDER, name + ".svg")
        if check:
            charts.check(path, drawing)
        else:
            charts.draw(path, drawing, paths)


if __name__ == "__main__":
    main()

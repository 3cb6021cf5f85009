#!/usr/bin/env python3
"""Draws the figures that benches/compare measures, and keeps the tables of docs/figures.md what the CSV files say.

usage: figures.py [--check] RESULTS.csv ...

The files are those that `make figures` writes, of figures, of verdicts beside libccd's and of builds, in any order.

Writes docs/charts/figure-*.svg, and in docs/figures.md and docs/levels.md replaces what stands between <!-- table: NAME --> and
<!-- end -->. With --check it writes nothing and fails where a page or a chart differs. No package beyond Python itself is needed.
"""
import contextlib
import csv
import filecmp
import io
import math
import os
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import claims  # noqa: E402
import plot  # noqa: E402
from plot import Panel, in_order, legend, limits, step_positions, text_element  # noqa: E402

CHARTS = os.path.join(HERE, "..", "docs", "charts")
PAGES = [os.path.join(HERE, "..", "docs", page) for page in ("figures.md", "levels.md")]
BLUE, RED, GREEN, VIOLET, BROWN, TEAL, GREY = "#0b5fa5", "#d1495b", "#5f8a2b", "#8b5fbf", "#c98a1b", "#2f8f83", "#777777"
THIN, DOTS = "6 3", "2 3"
STYLES = {
    "most violated": (BLUE, "", "most violated plane (SWIFT)"),
    "first violated": (RED, "", "first violated plane (as in V-Clip, but not V-Clip)"),
    "nothing": (GREY, "", "nothing: the last features"),
    "LUT 2 5.625": (RED, "", "LUT 2 5.625"),
    "DK 100 Double-Double": (GREEN, "", "DK 100 Double-Double"),
    "quadric 0.03125": (VIOLET, "", "quadric 0.03125"),
    "cuts 0.03125": (BROWN, "", "outer cuts 0.03125 (ours)"),
    "automatic": (BLUE, "", "automatic (ours)"),
    "shells": (BLUE, "", "shells (ours)"),
    "no levels": (BLUE, "", "no levels: automatic"),
    "quadric 0.25": (GREEN, "", "quadric 0.25"),
    "cuts 0.25": (BROWN, "", "outer cuts 0.25 (ours)"),
    "2 levels": (VIOLET, "", "2 levels"),
    "3 levels": (GREEN, "", "3 levels"),
    "4 levels": (BROWN, "", "4 levels"),
    "levels and table": (TEAL, THIN, "quadric 0.25, from shells (ours)"),
    "table alone": ("#41a1e0", THIN, "no levels, from shells (ours)"),
}
for colour, cut_off in ((BLUE, 20), (GREEN, 100), (RED, 250)):
    for dash, policy in (("", "Single"), (THIN, "Single-Single"), (DOTS, "Double-Double")):
        STYLES[f"{cut_off} {policy}"] = (colour, dash, f"{cut_off} {policy}")
for dash, degrees in (("", "5.625"), (THIN, "11.25")):
    for colour, factor in ((GREEN, 1), (RED, 2), (VIOLET, 4)):
        STYLES[f"{factor} {degrees}"] = (colour, dash, f"{factor} {degrees}")
RATES = {"quadric 0.5": GREY, "quadric 0.25": GREEN, "quadric 0.125": RED, "quadric 0.0625": BROWN, "quadric 0.03125": VIOLET,
         "cuts 0.25": TEAL, "cuts 0.03125": BLUE}

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
MOTION = "motion from one query to the next; time a query, bodies of 1,002 vertices"


def read(paths):
    """On what each figure was measured, and the rows of all files: of figures, of verdicts beside peers, and of builds; numbers as floats."""
    heads, kinds = {}, {"figure": [], "disagreements": [], "bytes": []}
    for path in paths:
        with open(path) as file:
            head = file.readline().lstrip("# ").strip()
            rows = list(csv.DictReader(file))
        kind = next((kind for kind in kinds if kind in rows[0]), None)
        if kind is None:
            sys.exit(f"{path}: not a file of benches/compare")
        for row in rows:
            row["n"] = int(row["n"])
            for name in row.keys() & {"best_ns", "mean_steps", "by_levels", "error", "best_ms", "bytes"}:
                row[name] = float(row[name])
        kinds[kind] += rows
        if kind == "figure":
            machine = ", ".join(part for part in head.split(", ") if not part.endswith("passes"))
            heads.update({row["figure"]: machine for row in rows})
    return heads, *kinds.values()


def style_rates(names):
    """The styles of names that end in a number of levels, as "quadric 0.25 (3)"."""
    for name in names:
        base = name.split(" (")[0]
        if base != name and base in RATES:
            plot.STYLES[name] = (RATES[base], "" if base.startswith("quadric") else THIN, name)


def grid(path, head, title, panels, ticks, note):
    """panels: rows of (title, {series: [(unit, ns, whether a line leads there)]}); ticks: (unit, label)."""
    series = in_order(name for row in panels for _, curves in row for name in curves)
    style_rates(series)
    times = [ns for row in panels for _, curves in row for points in curves.values() for _, ns, _ in points]
    low, high = limits(times)
    width_of_one, height, gap, left = 330, 250, 18, 66
    width = left + len(panels[0]) * (width_of_one + gap)
    entries, used = legend([plot.style(name, series) for name in series], left, 50, width - left - 16)
    top = 50 + used + 20
    parts = plot.title(head, title, width) + entries
    for i, row in enumerate(panels):
        for k, (name, curves) in enumerate(row):
            panel = Panel(left + k * (width_of_one + gap), top + i * (height + 50), width_of_one, height, low, high)
            panel.frame(name, ticks, k == 0)
            for method, points in curves.items():
                colour, dash, _ = plot.style(method, series)
                panel.curve([(unit, ns) for unit, ns, joined in points if joined], colour, dash)
                for unit, ns, _ in points:
                    panel.dot(unit, ns, colour)
            parts += panel.parts
    bottom = top + len(panels) * (height + 50) - 8
    parts.append(text_element(left, bottom, note))
    plot.write(path, width, bottom + 14, parts)


def over_motion(rows):
    """The curves of a panel, and the ticks."""
    position = step_positions(in_order(r["step"] for r in rows))
    curves = {}
    for r in rows:
        curves.setdefault(r["series"], []).append((position[r["step"]], r["best_ns"], r["step"] != "random"))
    return curves


def motion_ticks(rows):
    position = step_positions(in_order(r["step"] for r in rows))
    return [(unit, step if step == "random" else step + "°") for step, unit in position.items()]


def draw_paper(folder, heads, rows):
    for figure, title in NAMES.items():
        here = [r for r in rows if r["figure"] == figure]
        if not here:
            continue
        panels = []
        for orbit in in_order(r["orbit"] for r in here):
            models = in_order(r["model"] for r in here)
            cells = {m: [r for r in here if (r["orbit"], r["model"]) == (orbit, m)] for m in models}
            panels.append([(f"{m}-{m}, {orbit} orbit", over_motion(cells[m])) for m in models])
        grid(os.path.join(folder, f"figure-{figure}.svg"), heads[figure], title, panels, motion_ticks(here), MOTION)


def draw_error(folder, heads, rows):
    """Approximate distance over the error asked for, with intersection at the left end and exact distance at the right."""
    rows = [r for r in rows if r["figure"] == "error"]
    errors = sorted({r["error"] for r in rows if r["query"] == "approximate"}, reverse=True)
    most, least = math.log10(errors[0]), math.log10(errors[-1])
    unit = {e: 0.16 + 0.68 * (most - math.log10(e)) / (most - least) for e in errors}
    decade = {e: f"1e{round(math.log10(e))}" if math.log10(e) % 1 in (0.0, 1.0) else "" for e in errors}
    ticks = [(0.04, "verdict")] + [(unit[e], decade[e]) for e in errors] + [(0.96, "exact")]
    for step in ("10", "random"):
        panels = []
        for orbit in in_order(r["orbit"] for r in rows):
            row = []
            for model in in_order(r["model"] for r in rows):
                curves = {}
                for r in rows:
                    if (r["orbit"], r["model"], r["step"]) == (orbit, model, step):
                        at = {"intersection": 0.04, "distance": 0.96}.get(r["query"])
                        point = (unit[r["error"]], r["best_ns"], True) if at is None else (at, r["best_ns"], False)
                        curves.setdefault(r["series"], []).append(point)
                row.append((f"{model}-{model}, {orbit} orbit", curves))
            panels.append(row)
        motion = "random poses" if step == "random" else f"{step}° a query"
        if rows:
            grid(os.path.join(folder, f"figure-error-{step}.svg"), heads["error"], f"Time over the error asked for, {motion}", panels, ticks,
                 "error of an approximate distance in radii; intersection to the left, exact distance to the right")


def draw_size(folder, heads, rows):
    rows = [r for r in rows if r["figure"] == "size"]
    for query in in_order(r["query"] for r in rows):
        here = [r for r in rows if r["query"] == query]
        panels = []
        for n in in_order(r["n"] for r in here):
            models = in_order(r["model"] for r in here)
            cells = {m: [r for r in here if (r["n"], r["model"]) == (n, m)] for m in models}
            panels.append([(f"{m}-{m}, {2 * n - 4:,} triangles", over_motion(cells[m])) for m in models])
        grid(os.path.join(folder, f"figure-size-{query}.svg"), heads["size"], f"Larger bodies, {QUERIES[query]}, small orbit", panels,
             motion_ticks(here), "motion from one query to the next; time a query")


def draw_choice(folder, heads, rows):
    """How many times as long as the best fixed setting the automatic one takes, cell by cell."""
    cells = claims.choice_cells(rows)
    if not cells:
        return
    steps = in_order(step for *_, step in cells)
    queries = in_order(query for query, *_ in cells)
    lines = sorted(in_order((query, orbit, model) for query, orbit, model, _ in cells), key=lambda line: queries.index(line[0]))
    left, top, wide, high = 270, 92, 104, 19
    width = left + len(steps) * wide + 16
    parts = plot.title(heads["choice"], "The automatic choice beside the best fixed setting of each cell", width)
    parts.append(text_element(16, 44, "times as long as the best fixed setting, and which that is (quadric 0.03125, cuts 0.25: through levels); green: up to 1.1"))
    for k, step in enumerate(steps):
        parts.append(text_element(left + k * wide + wide / 2, top - 10, step if step == "random" else step + "°", "middle", "bold"))
    y, last = top, None
    for query, orbit, model in lines:
        if query != last:
            y += 10 if last else 0
            last = query
        parts.append(text_element(left - 10, y + 14, f"{query}, {model}-{model}, {orbit}", "end"))
        for k, step in enumerate(steps):
            ratio, name, _ = cells[query, orbit, model, step]
            fill = "#dcefdc" if ratio <= 1.1 else "#fff0c8" if ratio <= 1.25 else "#f9c9a0" if ratio <= 1.6 else "#ee8f7f"
            x = left + k * wide
            parts.append(f'<rect x="{x}" y="{y}" width="{wide - 2}" height="{high - 2}" fill="{fill}"/>')
            parts.append(text_element(x + 6, y + 13, f"{ratio:.2f}"))
            parts.append(text_element(x + wide - 8, y + 13, name.split()[0], "end"))
        y += high
    plot.write(os.path.join(folder, "figure-choice.svg"), width, y + 10, parts)


def draw(folder, heads, rows):
    for figures in (draw_paper, draw_error, draw_size, draw_choice):
        figures(folder, heads, rows)


def main():
    arguments = sys.argv[1:]
    check = arguments[:1] == ["--check"]
    paths = arguments[1:] if check else arguments
    if not paths:
        sys.exit(__doc__)
    heads, rows, verdicts, builds = read(paths)
    made = claims.tables(rows, verdicts, builds)
    for page in PAGES:
        with open(page) as file:
            text = file.read()
        filled = claims.fill(text, made)
        if check and filled != text:
            sys.exit(f"{page} does not say what the CSV files say: run benches/figures.py")
        if not check:
            with open(page, "w") as file:
                file.write(filled)
    plot.STYLES.update(STYLES)
    if not check:
        os.makedirs(CHARTS, exist_ok=True)
        return draw(CHARTS, heads, rows)
    with tempfile.TemporaryDirectory() as folder:
        with contextlib.redirect_stdout(io.StringIO()):
            draw(folder, heads, rows)
        for name in os.listdir(folder):
            if not filecmp.cmp(os.path.join(folder, name), os.path.join(CHARTS, name), shallow=False):
                sys.exit(f"docs/charts/{name} does not show what the CSV files say: run benches/figures.py")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Draws the charts of bodies.csv, which compare --bodies writes, and checks what pages say of it and of bodies-instructions.csv.

usage: bodies.py RESULTS.csv [OUTPUT_DIRECTORY]
       bodies.py --again
       bodies.py --check

Writes into the directory (docs/charts)
  bodies-accuracy.svg    distances: time per query over error, a row a family, a panel a motion, one mark a method and tolerance
  bodies-depths.svg      the same of depths
  bodies-grid.svg        how many times as long the best peer takes: a line a body, a column a motion, for three queries
  bodies-motion.svg      time per query over motion, a row a query, a panel a family
  bodies-vertices.svg    time per query over the vertices of a round ellipsoid, a row a query, a panel a motion
  bodies-sides.svg       the same over the sides of a cylinder
With --again they are drawn anew from benches/results/bodies.csv, with the tables of the pages, of which one is of
benches/results/bodies-instructions.csv. With --check nothing is drawn, and the program fails where a chart or a page does not say
what these files say.
"""
import math
import os
import re
import sys

import charts
from charts import DASHED, DOTTED, Axis, Cell, Cells, Curve, Kind, Line, Panel, Panels, Row, Style
from rows import geometric_mean, in_order, machine, read

HERE = os.path.dirname(os.path.abspath(__file__))
RESULTS, INSTRUCTIONS = (os.path.join(HERE, "results", name) for name in ("bodies.csv", "bodies-instructions.csv"))
NUMBERS = ("best_ns", "worst_error", "widest", "n1", "judged", "wrong", "missed")
SCENE = ("query", "family", "body", "form", "step")  # all other columns of bodies-instructions.csv are methods
COUNT = "instructions"
OWN, LEVELS = "swiftprox", "swiftprox-levels"
# Of each way of a library its mark; tolerances, behind the last dash, share it.
WAYS = {
    OWN: Style("swiftprox", charts.BLUE),
    LEVELS: Style("swiftprox, levels", charts.SKY, DASHED, "D"),
    "parry-hc": Style("parry3d-f64, climbing", charts.RED, marker="s"),
    "parry-round": Style("parry3d-f64, primitives", charts.RED, DASHED, "s"),
    "coal": Style("coal", charts.INDIGO, marker="D"),
    "mujoco": Style("MuJoCo", charts.PINK, DASHED, "v"),
    "jolt": Style("Jolt", charts.GREEN, marker="p"),
    "bullet": Style("Bullet, double", charts.ORANGE, DASHED, "^"),
    "libccd-gjk": Style("libccd GJK", charts.GREY, DOTTED, "s"),
    "libccd-epa": Style("libccd EPA", charts.GREY, DOTTED, "X"),
    "libccd-mpr": Style("libccd MPR", charts.INK, DOTTED, "P"),
    "fcl": Style("FCL over libccd", charts.FOREST, marker="P"),
    "fcl-indep": Style("FCL's own solver", charts.OLIVE, DASHED, "X"),
}
FRONT = "front"
FAMILIES = {"paper": "ellipsoids of 1,002 vertices", "real": "real hulls", "cad": "CAD-like bodies", "unlike": "a box beside each",
            "round": "round bodies"}
QUERIES = {"distance": "small", "verdict": "small", "depth": "deep"}
# Of each query the strongest way of each library, which is measured of all bodies.
STRONGEST = {"distance": (OWN, "parry-hc", "coal-1e-10", "mujoco-1e-6", "jolt-1e-6"),
             "verdict": (OWN, "parry-hc", "coal-1e-6", "libccd-mpr-1e-4", "jolt-1e-6"),
             "depth": (OWN, "parry-hc", "coal-1e-10", "mujoco-1e-6", "jolt-1e-6")}
# Of round bodies the libraries' own primitives.
PRIMITIVES = ("parry-round", "coal-round-1e-10", "bullet-round-1e-6")
STEPS = ("0.1", "1", "10", "random")
ERRORS = Axis("", 1e-17, 4.0, [(10.0**e, f"1e{e}" if e else "1") for e in range(-16, 1, 4)])
LEAST_ERROR = 1e-16  # what is less is rounding, and drawn at this place


def way(method):
    """coal-1e-6: coal; swiftprox-levels-1e-2: swiftprox-levels."""
    return max((known for known in WAYS if method == known or method.startswith(known + "-")), key=len)


def motion(step):
    return "random poses" if step == "random" else f"{step}° per query"


def of(rows, **wanted):
    return [row for row in rows if all(row[name] == value for name, value in wanted.items())]


def legend_of(rows):
    present = {way(row["method"]) for row in rows}
    return {name: style for name, style in WAYS.items() if name in present}


def others_of(rows):
    """The other libraries, as in a sentence."""
    return ", ".join(style.label.replace(",", "") for name, style in legend_of(rows).items() if name not in (OWN, LEVELS))


def strongest(rows):
    """Of the three queries, each on its orbit, the rows of the strongest methods."""
    return [row for row in rows if QUERIES.get(row["query"]) == row["orbit"] and row["method"] in STRONGEST[row["query"]] + PRIMITIVES]


def mean(rows):
    return geometric_mean([row["best_ns"] for row in rows])


# ---- speed against accuracy ----

def mark(rows, is_own):
    """(error, time) of a method over the bodies of a panel. What is guaranteed counts for our own, what was observed for others."""
    errors = [row["widest"] if is_own else row["worst_error"] for row in rows]
    errors = [error for error in errors if not math.isnan(error)]
    return (min(max([*errors, LEAST_ERROR]), ERRORS.high), mean(rows))


def front(points):
    """The marks that no other is both quicker and more accurate than, from the most accurate on, as steps."""
    kept = []
    for error, time in sorted(points):
        if not kept or time < kept[-1][1]:
            kept.append((error, time))
    corners = []
    for k, (error, time) in enumerate(kept):
        corners += [(error, kept[k - 1][1])] if k else []
        corners.append((error, time))
    return corners + [(ERRORS.high, kept[-1][1])]


def accuracy(where, rows, query, title, axis):
    orbit = QUERIES[query]
    rows = of(rows, query=query, orbit=orbit)
    everywhere = {row["body"] + row["form"] for row in rows if row["method"] in ("coal-1e-4", "fcl-1e-6")}
    rows = [row for row in rows if row["body"] + row["form"] in everywhere]
    families = [family for family in FAMILIES if of(rows, family=family)]
    legend = {name: style for name, style in WAYS.items() if any(way(row["method"]) == name for row in rows)}
    made = []
    for family in families:
        panels, times = [], []
        for step in STEPS:
            here = of(rows, family=family, step=step)
            points = {method: mark(of(here, method=method), way(method) in (OWN, LEVELS)) for method in in_order(r["method"] for r in here)}
            times += [time for _, time in points.values()]
            curves = [Curve(FRONT, front(points.values()), Kind.LINE)]
            for name in reversed(legend):
                own = sorted(point for method, point in points.items() if way(method) == name)
                curves += [Curve(name, own, Kind.JOINED if len(own) > 1 else Kind.DOTS)] if own else []
            panels.append(Panel(motion(step), curves))
        panels[0].title = f"{FAMILIES[family].split(' of ')[0]}: {panels[0].title.removesuffix(' per query')}"
        made.append(Row(panels, charts.value_axis("time per query", times, charts.duration), 130))
    legend = {**legend, FRONT: Style("the front", charts.FRAME, DASHED)}
    bodies = {family: len({row["body"] for row in of(rows, family=family)}) for family in families}
    said = ", ".join(f"{count} {FAMILIES[family]}" for family, count in bodies.items())
    wrong = sum(int(row["wrong"]) for row in rows if row["method"] == OWN)
    x = Axis(axis, ERRORS.low, ERRORS.high, ERRORS.ticks)
    return Panels(title, where, x, legend, made,
                  f"One mark a method and tolerance; geometric means over {said}. Others: the worst error observed, truth in integers.\n"
                  f"swiftprox: the widest interval that it guarantees. Left and down is better. Wrong verdicts of swiftprox: {wrong}.\n"
                  "A library that refuses bodies, Jolt those of more than 256 vertices, has its mean over the others.")


# ---- the grid ----

BANDS = ((8, charts.NAVY), (4, "#6aaed6"), (2, "#abd0e6"), (1, "#deebf7"), (0.5, "#fbd38d"), (0, "#f2a05f"))


def band(ratio):
    return next(colour for least, colour in BANDS if ratio >= least)


def ratios(rows, step, cost="best_ns"):
    """Of each body how many times as long, or as many instructions, the other library that needs least takes."""
    found = {}
    for row in of(rows, step=step):
        found.setdefault((row["body"], row["form"]), {})[row["method"]] = row[cost]
    return [min(time for method, time in times.items() if method != OWN) / times[OWN]
            for times in found.values() if OWN in times and len(times) > 1]


def grid_lines(rows):
    """A line's name and its rows: an ellipsoid's sizes, a kind of real hulls, a solid in all its forms."""
    lines = []
    for family in ("paper", "real", "cad", "round"):
        here = of(rows, family=family)
        name = (lambda row: row["body"].split("/")[0] if row["family"] == "real" else
                f"{row['body']} {int(row['form']):,}" if row["family"] == "paper" else row["body"])
        for body in in_order(map(name, here)):
            lines.append((family, body, [row for row in here if name(row) == body]))
    return lines


def grid(where, rows):
    rows = strongest(rows)

    def cells(here):
        for query in QUERIES:
            asked = of(here, query=query)
            for step in STEPS:
                found = ratios(asked, step)
                if not found:
                    yield Cell("", "", charts.REFUSED)
                    continue
                middle, least = geometric_mean(found), min(found)
                text = f"{middle:.1f}" if middle < 9.95 else f"{middle:.0f}"
                yield Cell(text, f" {least:.1f}" if len(found) > 1 and least < 9.95 else "", band(middle))

    lines, before = [], None
    for family, name, here in grid_lines(rows):
        lines.append(Line(name, list(cells(here)), gap_before=before not in (None, family)))
        before = family
    for family in FAMILIES:
        lines.append(Line(FAMILIES[family].replace("of 1,002 vertices", "of all sizes"), list(cells(of(rows, family=family))),
                          gap_before=family == "paper", bold=True))
    columns = [(query, motion(step).replace(" per query", "").replace(" poses", "")) for query in QUERIES for step in STEPS]
    legend = [(colour, f"{least} and more" if least else "less") for least, colour in BANDS]
    return Cells("Speed-up over the fastest other library", where,
                 f"of {others_of(rows)}: geometric mean, small the least, where a line is several bodies",
                 columns, lines, legend + [(charts.REFUSED, "no pose overlaps")], 138)


# ---- time over motion, vertices and sides ----

def over_motion(where, rows):
    rows = [row for row in strongest(rows) if row["form"] in ("1002", "hull", "turned", "primitives")]
    x, place = charts.motion_axis(STEPS)
    made = []
    for query in QUERIES:
        panels, times = [], []
        for family in FAMILIES:
            here, curves = of(rows, query=query, family=family), []
            for method in in_order(row["method"] for row in here):
                points = {step: (place[step], mean(of(here, method=method, step=step))) for step in STEPS
                          if of(here, method=method, step=step)}
                times += [time for _, time in points.values()]
                curves += charts.over_motion(way(method), points)
            panels.append(Panel(FAMILIES[family].replace(" of 1,002 vertices", ""), curves))
        made.append(Row(panels, charts.value_axis(f"{query}: time per query", times, charts.duration), 140))
    return Panels("Time per query over motion", where, x, legend_of(rows), made,
                  "Geometric means over the bodies of a family; of round bodies the others have primitives.\n"
                  "A library that refuses bodies, Jolt those of more than 256 vertices, has its mean over the others.")


def over_size(where, rows, size, title, axis):
    """`size` says the size of a row's body; 0 of bodies that are not of the chart."""
    rows = [row for row in strongest(rows) if size(row)]
    sizes, made = sorted({size(row) for row in rows}), []
    for query in QUERIES:
        here, panels = of(rows, query=query), []
        for step in STEPS:
            own = of(here, step=step)
            curves = [Curve(way(method), sorted((size(row), row["best_ns"]) for row in of(own, method=method)))
                      for method in in_order(row["method"] for row in own)]
            panels.append(Panel(f"{query}, {motion(step)}", curves))
        made.append(Row(panels, charts.value_axis("time per query", [row["best_ns"] for row in here], charts.duration), 130))
    x = Axis(axis, sizes[0] / 1.3, sizes[-1] * 1.3, [(n, charts.count(n if n < 1000 else 1000 * round(n / 1000))) for n in sizes])
    return Panels(title, where, x, legend_of(rows), made)


def vertices_of(row):
    return row["n1"] if (row["family"], row["body"]) == ("paper", "fat") else 0


def sides_of(row):
    kind, _, sides = row["body"].partition("-")
    return int(sides) if (row["family"], row["form"], kind) == ("cad", "turned", "cylinder") else 0


# ---- tables ----

MOTIONS = {"0.1": "0.1°", "1": "1°", "10": "10°", "random": "random"}
NAMED = 3  # bodies of a query whose ratios are the least


def judgement(rows):
    """Beside whom, how many answers were held against integers, and how they stood."""
    own = [row for row in rows if row["method"].startswith(OWN)]
    judged, wrong, missed = (sum(int(row[name]) for row in own) for name in ("judged", "wrong", "missed"))
    return f"The others: {others_of(strongest(rows))}. Integers judged {judged:,} answers of the run: {wrong} were wrong, and {missed} intervals missed the truth."


def family_table(rows):
    """Geometric means of the ratios of a family's bodies, and the least of them; then how certain the answers were."""
    certain, rows = judgement(rows), strongest(rows)
    lines = ["| query | bodies | " + " | ".join(MOTIONS.values()) + " | least |", "|---|---|" + "--:|" * (len(STEPS) + 1)]
    for query in QUERIES:
        for family, name in FAMILIES.items():
            found = [ratios(of(rows, query=query, family=family), step) for step in STEPS]
            cells = [f"{geometric_mean(here):.1f}" for here in found] + [f"{min(map(min, found)):.1f}"]
            lines.append(f"| {query} | {name.replace('of 1,002 vertices', 'of 10 to 100,002 vertices')} | " + " | ".join(cells) + " |")
    return "\n".join(lines + ["", certain])


FIRST = (("distance", "1"), ("verdict", "1"), ("depth", "1"), ("depth", "10"))
ASKED = {"distance": "distance", "verdict": "overlap test", "depth": "depth"}


def first_table(rows):
    """Geometric means over the real hulls, of the libraries that take all of them, the best per line in bold."""
    rows = of(strongest(rows), family="real")
    shown = [name for name in WAYS if name not in ("jolt", LEVELS) and of([{"way": way(row["method"])} for row in rows], way=name)]
    lines = ["| | " + " | ".join(WAYS[name].label.split(",")[0] for name in shown) + " |", "|---|" + "--:|" * len(shown)]
    for query, step in FIRST:
        means = {way(row["method"]): mean(of(rows, query=query, step=step, method=row["method"])) for row in of(rows, query=query, step=step)}
        best = min(time for name, time in means.items() if name in shown)
        cells = ["" if name not in means else f"**{means[name]:,.0f}**" if means[name] == best else f"{means[name]:,.0f}" for name in shown]
        lines.append(f"| {ASKED[query]}, {MOTIONS[step]} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def weak_table(rows):
    """Of each query the bodies with the least ratios, each at its worst motion and in its worst form."""
    rows = strongest(rows)
    lines = ["| query | least speed-up over the fastest other library |", "|---|---|"]
    for query in QUERIES:
        least = {}
        for body in in_order((row["body"], row["form"]) for row in of(rows, query=query)):
            for step in STEPS:
                for ratio in ratios(of(rows, query=query, body=body[0], form=body[1]), step):
                    least[body[0]] = min(least.get(body[0], (math.inf,)), (ratio, step, body[1]))
        worst = sorted(least.items(), key=lambda item: item[1])[:NAMED]
        said = "; ".join(f"{body} {form}, {MOTIONS[step]}: {ratio:.2f}" for body, (ratio, step, form) in worst)
        lines.append(f"| {query} | {said} |")
    return "\n".join(lines)


def instruction_table(counts):
    """Geometric means of a family: our instructions per query, and behind them how many times as many the other library takes that
    takes the fewest."""
    lines = ["| query | bodies | " + " | ".join(MOTIONS[step] for step in STEPS) + " |", "|---|---|" + "--:|" * len(STEPS)]
    for query in QUERIES:
        for family, name in FAMILIES.items():
            here = of(counts, query=query, family=family)
            cells = [f"{geometric_mean([row[COUNT] for row in of(here, method=OWN, step=step)]):,.0f}"
                     f" ({geometric_mean(ratios(here, step, COUNT)):.1f})" for step in STEPS]
            lines.append(f"| {query} | {name.replace('of 1,002 vertices', 'of 10 to 1,002 vertices')} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def tables_of(rows, counts):
    """Of each page the tables by name."""
    return {"README.md": {"first": first_table(rows)},
            "docs/benchmarks.md": {"bodies": family_table(rows), "weak": weak_table(rows)},
            "benches/README.md": {"instructions": instruction_table(counts)}}


def with_tables(text, tables):
    """The page with each table between its two comments made anew."""
    for name, table in tables.items():
        text, count = re.subn(rf"(<!-- table: {name} -->\n).*?(<!-- end -->)", lambda found: found[1] + table + "\n" + found[2], text,
                              flags=re.DOTALL)
        if count != 1:
            sys.exit(f"there are {count} tables called {name}")
    return text


# ---- files ----

def numbers_of(path):
    """Where was measured, and the rows."""
    head, rows = read(path)
    for row in rows:
        row.update((name, float(row[name] or math.nan)) for name in NUMBERS)
    return machine(head[0]), rows


def counts_of(path):
    """A row for each method of a scene, which stand beside each other in the file."""
    _, scenes = read(path)
    return [{**{name: scene[name] for name in SCENE}, "method": method, COUNT: float(count)}
            for scene in scenes for method, count in scene.items() if method not in SCENE and count]


def made_of(where, rows):
    """The charts by name."""
    return {
        "bodies-accuracy": accuracy(where, rows, "distance", "Speed against accuracy of distances, small orbit", "error of the distance, in radii of the bodies"),
        "bodies-depths": accuracy(where, rows, "depth", "Speed against accuracy of depths, deep orbit", "error of the depth, in radii of the bodies"),
        "bodies-grid": grid(where, rows),
        "bodies-motion": over_motion(where, rows),
        "bodies-vertices": over_size(where, rows, vertices_of, "Time per query over the vertices of a round ellipsoid", "vertices"),
        "bodies-sides": over_size(where, rows, sides_of, "Time per query over the sides of a cylinder", "sides"),
    }


def chart_path(name, folder=charts.FOLDER):
    return os.path.join(folder, name + ".svg")


def pages(rows):
    """Of each page its file, what it says, and what it should say."""
    for page, tables in tables_of(rows, counts_of(INSTRUCTIONS)).items():
        path = os.path.join(HERE, "..", page)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        yield path, text, with_tables(text, tables)


def main():
    arguments = sys.argv[1:]
    if arguments == ["--check"]:
        where, rows = numbers_of(RESULTS)
        for name, chart in made_of(where, rows).items():
            charts.check(chart_path(name), chart)
        for path, text, wanted in pages(rows):
            if text != wanted:
                sys.exit(f"{os.path.basename(path)} does not say what bodies.csv and bodies-instructions.csv say: run make charts")
    elif arguments == ["--again"]:
        where, rows = numbers_of(RESULTS)
        for name, chart in made_of(where, rows).items():
            charts.draw(chart_path(name), chart, [RESULTS])
        for path, _, wanted in pages(rows):
            with open(path, "w", encoding="utf-8") as file:
                file.write(wanted)
    elif len(arguments) in (1, 2) and not arguments[0].startswith("--"):
        for name, chart in made_of(*numbers_of(arguments[0])).items():
            charts.draw(chart_path(name, *arguments[1:]), chart, arguments[:1])
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()

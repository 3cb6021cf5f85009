#!/usr/bin/env python3
"""Draws the charts of the CSV files of benches/compare and of benches/worst_case.rs.

usage: plot.py RESULTS.csv [OUTPUT_DIRECTORY]
       plot.py --again
       plot.py --check

Writes into the directory (docs/charts), for each number of vertices N in a file of benches/compare,
  speed-N.svg      time per query over degrees per step, one panel an orbit, one line a method
  accuracy-N.svg   time per query over error, one panel a scene, one point a method
and of benches/worst_case.rs
  steps.svg        the most steps and the longest query over the number of vertices, one panel a motion, one line a body
of compare --crowd, for each kind of bodies,
  scenes-KIND.svg  time per step over the number of bodies, a row a question, a panel a motion, one line a method
of compare --query depth
  depth-speed.svg     time per query over degrees per step, one panel a number of vertices, one line a method
  depth-accuracy.svg  time per query over error, one panel a motion, one line a library over its tolerances
and of stability/depths.py
  depth-failures.svg  wrong depths and normals, NaN and crashes of the hard families, a row a family, a column a method
With --again each of these in docs/charts is drawn anew from the CSV file that it names. With --check nothing is drawn, and the
program fails where one is not the drawing of the file that it names.
"""
import dataclasses
import glob
import math
import os
import sys

import charts
from charts import DASHED, DOTTED, Axis, Cell, Cells, Curve, Kind, Line, Panel, Panels, Row, Style
from rows import geometric_mean, in_order, machine, read, with_numbers

RESULTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "results")
METHODS = {
    "swiftprox": Style("swiftprox, tight interval", charts.BLUE),
    "parry-hc": Style("parry3d-f64, hill climbing", charts.RED, marker="s"),
    "parry-hc-matrix": Style("parry3d-f64, with matrices", charts.ORANGE, DASHED, "v"),
    "parry-hc-steepest": Style("parry3d-f64, steepest climb", charts.PINK, DOTTED, "^"),
    "fcl-1e-6": Style("FCL (libccd), 1e-6", charts.FOREST, marker="P"),
    "fcl-1e-10": Style("FCL (libccd), 1e-10", charts.OLIVE, DASHED, "X"),
}
CROWDS = {
    "swiftprox": Style("swiftprox", charts.BLUE),
    "swiftprox-2": Style("swiftprox, two threads", charts.SKY, DASHED, "D"),
    "parry": Style("parry3d-f64, refitted", charts.RED, marker="s"),
    "parry-rebuilt": Style("parry3d-f64, rebuilt", charts.ORANGE, DASHED, "v"),
    "fcl": Style("FCL, dynamic tree", charts.FOREST, marker="P"),
    "sweep-and-prune": Style("three-axis sweep and prune, our pairs", charts.GREY, DOTTED, "^"),
}
DEPTHS = {  # of each library the way that the chart of speeds shows
    "swiftprox": ("swiftprox", Style("swiftprox, tight interval", charts.BLUE)),
    "coal": ("coal-1e-10", Style("coal, 1e-10", charts.INDIGO, marker="D")),
    "mujoco": ("mujoco-1e-6", Style("MuJoCo, 1e-6", charts.PINK, DASHED, "v")),
    "jolt": ("jolt-1e-6", Style("Jolt, 1e-6", charts.GREEN, marker="p")),
    "parry": ("parry-hc", Style("parry3d-f64, hill climbing", charts.RED, marker="s")),
    "bullet": ("bullet-1e-4", Style("Bullet, 1e-4", charts.ORANGE, DASHED, "^")),
    "libccd-epa": ("libccd-epa-1e-4", Style("libccd EPA, 1e-4", charts.GREY, DOTTED, "X")),
    "libccd-mpr": ("libccd-mpr-1e-4", Style("libccd MPR, 1e-4", charts.INK, DOTTED, "P")),
    "fcl": ("fcl-1e-6", Style("FCL (libccd), 1e-6", charts.FOREST, marker="P")),
}
DEPTH_MODELS = ("fat", "plate")  # long ones intersect in a few poses only
OTHERS = [(charts.INDIGO, "o"), (charts.WINE, "s"), (charts.GREY, "^"), (charts.GREEN, "D")]
BODIES = [  # in the order of the CSV file
    (charts.BLUE, "o"), (charts.SKY, "s"), (charts.INDIGO, "D"), (charts.RED, "^"), (charts.ORANGE, "v"), (charts.PINK, "D"),
    (charts.WINE, "X"), (charts.GREEN, "o"), (charts.OLIVE, "s"), (charts.FOREST, "^"), (charts.INK, "P"),
]
# Errors below this are rounding and drawn at this place: the exact values say nothing more on a logarithmic axis.
LEAST_ERROR = 1e-16
ERRORS = Axis("error of the distance, in radii of the bodies", LEAST_ERROR / 4, 4.0,
              [(10.0**e, f"1e{e}" if e else "1") for e in range(-16, 1, 4)])


def styles(methods):
    unknown = [method for method in methods if method not in METHODS]
    more = {method: Style(method, colour, marker=marker) for method, (colour, marker) in zip(unknown, OTHERS * len(unknown))}
    return {method: {**METHODS, **more}[method] for method in sorted(methods, key=(list(METHODS) + unknown).index)}


def motion(step):
    return "random poses" if step == "random" else f"{step}° per query"


def speed(machine, n, rows):
    orbits, steps = in_order(r["orbit"] for r in rows), in_order(r["step"] for r in rows)
    x, place = charts.motion_axis(steps)
    means = {}
    for r in rows:
        means.setdefault((r["orbit"], r["method"], r["step"]), []).append(r["best_ns"])
    means = {key: geometric_mean(times) for key, times in means.items()}

    def curves(orbit, method):
        points = {step: (place[step], means[orbit, method, step]) for step in steps if (orbit, method, step) in means}
        return charts.over_motion(method, points)

    legend = styles(in_order(r["method"] for r in rows))
    panels = [Panel(f"{orbit} orbit", [curve for method in legend for curve in curves(orbit, method)]) for orbit in orbits]
    return Panels(f"Exact distance with witness points, {n:,} vertices: time per query", machine, x, legend,
                  [Row(panels, charts.value_axis("time per query", means.values(), charts.duration), 230)],
                  "Geometric means over the models " + ", ".join(in_order(r["model"] for r in rows)) + ".")


def worst_errors(rows):
    """The worst error of each method in a scene, of rows (model, method) of it.

    The errors in the CSV file are differences from the first method's distances, this library's. Its own would be 0, which says
    nothing; what can be observed of it is the difference from the closest library that answers by itself, for no other is known
    to err less.
    """
    found = {}
    for model in in_order(r["model"] for r in rows):
        here = {r["method"]: r for r in rows if r["model"] == model and not math.isnan(r["worst_error"])}
        others = [r["worst_error"] for r in here.values() if math.isnan(r["worst_width"])]
        for method, row in here.items():
            is_own = not math.isnan(row["worst_width"])
            if is_own and others:
                found.setdefault(method, []).append(row["worst_error"] + min(others))
            elif not is_own:
                found.setdefault(method, []).append(row["worst_error"])
    return {method: max(errors) for method, errors in found.items()}


def accuracy_curves(legend, rows):
    """Dots at the worst errors; where an interval is guaranteed, a ring at the widest one, tied to the dot by a line."""
    curves = []
    errors = worst_errors(rows)
    for method in reversed(legend):  # the first on top
        here = [r for r in rows if r["method"] == method]
        if not here:
            continue
        time = geometric_mean([r["best_ns"] for r in here])
        widths = [r["worst_width"] for r in here if not math.isnan(r["worst_width"])]
        dot = [(max(errors[method], LEAST_ERROR), time)] if method in errors else []
        ring = [(max(*widths, LEAST_ERROR), time)] if widths else []
        if dot and ring:
            curves.append(Curve(method, dot + ring, Kind.LINE))
        curves += [Curve(method, points, kind) for points, kind in ((ring, Kind.RINGS), (dot, Kind.DOTS)) if points]
    return curves


def accuracy(machine, n, rows):
    steps = [s for s in in_order(r["step"] for r in rows) if s in ("0.1", "1", "10", "random")]
    rows = [r for r in rows if r["step"] in steps]
    legend = styles(in_order(r["method"] for r in rows))
    y = charts.value_axis("time per query", [r["best_ns"] for r in rows], charts.duration)

    def panel(orbit, step):
        here = [r for r in rows if (r["orbit"], r["step"]) == (orbit, step)]
        return Panel(f"{orbit} orbit, {motion(step)}", accuracy_curves(legend, here))

    return Panels(f"Speed against accuracy, {n:,} vertices", machine, ERRORS, legend,
                  [Row([panel(orbit, step) for step in steps], y, 140) for orbit in in_order(r["orbit"] for r in rows)],
                  "Dots: the worst error observed, as the difference from swiftprox's distances; for swiftprox from the closest other library's.\n"
                  "Rings: the widest interval that swiftprox guarantees to hold the distance. Times are geometric means over the models.")


def depth_means(rows):
    """Times per query, geometric means over the models, by number of vertices, step and method."""
    times = {}
    for r in rows:
        if r["model"] in DEPTH_MODELS:
            times.setdefault((r["n"], r["step"], r["method"]), []).append(r["best_ns"])
    return {key: geometric_mean(found) for key, found in times.items()}


def depth_speed(machine, rows):
    means = depth_means(rows)
    shown = {library: way for library, (way, _) in DEPTHS.items() if any(method == way for _, _, method in means)}
    sizes, steps = in_order(n for n, _, _ in means), in_order(step for _, step, _ in means)
    x, place = charts.motion_axis(steps)

    def curves(n, library):
        way = shown[library]
        return charts.over_motion(library, {step: (place[step], means[n, step, way]) for step in steps if (n, step, way) in means})

    panels = [Panel(f"{n:,} vertices", [curve for library in shown for curve in curves(n, library)]) for n in sizes]
    values = [time for (_, _, method), time in means.items() if method in shown.values()]
    boxes = {r["method"]: r["best_ns"] for r in rows if r["model"] == "box"}
    told = ", ".join(f"{DEPTHS[library][1].label.split(', ')[0]} {boxes[way] / 1000:.2f}" for library, way in shown.items() if way in boxes)
    return Panels("Depth of intersecting bodies: time per query", machine, x, {library: DEPTHS[library][1] for library in shown},
                  [Row(panels, charts.value_axis("time per query", values, charts.duration), 230)],
                  "Geometric means over the models " + ", ".join(DEPTH_MODELS) + ", intersecting poses of the deep orbit." +
                  (f"\nA box at rest on another, in µs: {told}." if boxes else ""))


def depth_accuracy(machine, rows):
    n = 1002 if any(r["n"] == 1002 for r in rows) else rows[0]["n"]
    rows = [r for r in rows if r["n"] == n and r["model"] in DEPTH_MODELS]
    steps, means = in_order(r["step"] for r in rows), depth_means(rows)
    legend = {library: dataclasses.replace(style, label=style.label.split(", ")[0]) for library, (_, style) in DEPTHS.items()
              if any(of_library(r["method"], library) for r in rows)}

    def curve(step, library):
        points = []
        for method in in_order(r["method"] for r in rows if of_library(r["method"], library)):
            here = [r for r in rows if (r["step"], r["method"]) == (step, method)]
            errors = [r["worst_width"] if library == "swiftprox" else r["worst_error"] for r in here]
            if here:
                points.append((min(max(*errors, LEAST_ERROR), 4.0), means[n, step, method]))
        return Curve(library, sorted(points), Kind.JOINED)

    panels = [Panel(motion(step), [curve(step, library) for library in reversed(legend)]) for step in steps]
    axis = dataclasses.replace(ERRORS, label="error of the depth, in radii of the bodies")
    return Panels(f"Speed against accuracy of the depth, {n:,} vertices", machine, axis, legend,
                  [Row(pair, charts.value_axis("time per query", [r["best_ns"] for r in rows], charts.duration), 150)
                   for pair in (panels[:2], panels[2:]) if pair],
                  "swiftprox: the widest interval that it guarantees, asked for errors from the provable to 1e-2. Others: the worst error\n"
                  "observed, against that interval, over their tolerances. Geometric means over the models " + ", ".join(DEPTH_MODELS) + ".")


FAILED = ("depth", "normal", "separated", "nan", "threw", "aborted", "timed_out")
SHARES = tuple(zip((0.01, 0.03, 0.1, 0.3, 1), charts.BAD))  # of the poses: up to how much which colour


def depth_failures(machine, rows):
    methods, families = in_order(r["method"] for r in rows), in_order(r["family"] for r in rows)
    found = {(r["family"], r["method"]): r for r in rows}

    def line(name, here):
        cells = []
        for method in methods:
            sums = [found[family, method] for family in here]
            asked, failed = (sum(int(r[count]) for r in sums for count in counts) for counts in (("poses",), FAILED))
            refused = sum(int(r["refused"]) for r in sums)
            cells.append(failure_cell(asked - refused, failed, refused))
        return Line(name, cells, str(sum(int(found[family, methods[0]]["poses"]) for family in here)),
                    gap_before=name == "all", bold=name == "all")

    columns = [(method.split("-1e")[0], "1e" + method.split("-1e")[1] if "-1e" in method else "") for method in methods]
    legend = [(charts.GOOD, "none")] + [(colour, f"up to {100 * share:g} %") for share, colour in SHARES]
    return Cells("Failures of depths on hard cases", machine,
                 "how many poses: depth off by more than 1e-6 of the size, right depth with a wrong normal, overlap denied, NaN, failure, "
                 "crash or hang", columns, [line(family, [family]) for family in families] + [line("all", families)],
                 legend + [(charts.REFUSED, "no shape made; −n: of n poses")], 96, "poses")


def failure_cell(asked, failed, refused):
    if asked == 0:
        return Cell("refused", "", charts.REFUSED)
    colour = next(colour for share, colour in SHARES if failed <= share * asked) if failed else charts.GOOD
    return Cell(str(failed), f"−{refused}" if refused else "", colour)


def of_library(method, library):
    """Whether a method is a library's: parry-hc, coal-1e-10."""
    return method == library or method.startswith(library + "-")


def steps(machine, rows):
    bodies, motions = in_order(r["body"] for r in rows), in_order(r["motion"] for r in rows)
    sizes = sorted({r["n"] for r in rows})
    x = Axis("vertices n of each body", sizes[0] / 1.3, sizes[-1] * 1.3, [(n, charts.count(n)) for n in sizes if math.log10(n) % 1 == 0])
    legend = {"bound": Style("bound, 81 + n" + ("; of depths 400" if "depth" in motions else ""), charts.GREY, DASHED)}
    legend.update((body, Style(body, colour, marker=marker)) for body, (colour, marker) in zip(bodies, BODIES))
    bounds = {motion: [(n, 400 if motion == "depth" else 81 + n) for n in sizes] for motion in motions}
    made = []
    for column, name, label in (("worst_steps", "steps", charts.count), ("worst_ns", "longest query", charts.duration)):
        # A query that needs no step at all is drawn at one.
        values = {(r["motion"], r["body"], r["n"]): max(r[column], 1.0) for r in rows if not math.isnan(r[column])}
        counts = column == "worst_steps"
        y = charts.value_axis("most steps of a query" if counts else "longest query",
                              [*values.values(), *(value for m in motions if counts for _, value in bounds[m])], label)
        panels = []
        for motion in (m for m in motions if any(key[0] == m for key in values)):  # depths have no times
            limits = [Curve("bound", bounds[motion], Kind.LINE)] if counts else []
            points = {body: [(n, values[motion, body, n]) for n in sizes if (motion, body, n) in values] for body in bodies}
            panels.append(Panel(f"{name}, {motion}", limits + [Curve(body, found) for body, found in points.items()]))
        made.append(Row(panels, y, 210))
    return Panels("Worst queries over the number of vertices", machine, x, legend, made)


def crowds(machine, bodies, rows):
    """Means over the steps; a thin line reaches up to the worst one."""
    counts = sorted({int(r["count"]) for r in rows})
    x = Axis("bodies in the scene", counts[0] / 1.3, counts[-1] * 1.3, [(n, charts.count(n)) for n in counts])
    legend = {method: CROWDS[method] for method in CROWDS if method in {r["method"] for r in rows}}
    questions, motions = in_order(r["query"] for r in rows), in_order(r["motion"] for r in rows)
    found = {(r["query"], r["motion"], r["method"], int(r["count"])): (1e6 * r["mean_ms"], 1e6 * r["worst_ms"]) for r in rows}

    def curves(question, motion, method):
        here = {n: found[question, motion, method, n] for n in counts if (question, motion, method, n) in found}
        worst = [Curve(method, [(n, mean), (n, most)], Kind.LINE) for n, (mean, most) in here.items()]
        return [Curve(method, [(n, mean) for n, (mean, _) in here.items()])] + worst

    names = {"all": "all move a little", "brisk": "all move briskly", "5%": "5 % move", "1%": "1 % move", "rest": "a pile at rest",
             "teleport": "all jump"}
    asked = {"intersection": "intersecting", "distance": "within 0.25", "contact": "depth, manifold"}

    def row(question):
        values = [t for key, times in found.items() if key[0] == question for t in times]
        panels = [Panel(names[m], [c for method in legend for c in curves(question, m, method)]) for m in motions]
        return Row(panels, charts.value_axis(f"{asked[question]}: time per step", values, charts.duration), 210)

    return Panels(f"Scenes of many bodies ({bodies} vertices): time per step, poses set and query answered", machine, x, legend,
                  [row(question) for question in questions],
                  "Points: means over the steps. Lines up from them: to the worst step. One thread unless the legend says two.")


def made_of(path):
    """The charts of a CSV file by name."""
    head, rows = read(path)
    where = machine(head[0])
    if "normal" in rows[0]:
        return {"depth-failures": depth_failures(where, rows)}
    if "body" in rows[0]:
        return {"steps": steps(where, with_numbers(rows, ("worst_steps", "worst_ns")))}
    if "bodies" in rows[0]:
        with_numbers(rows, ("mean_ms", "worst_ms"))
        # Spheres and cubes are a table of docs/scenes.md.
        kinds = [kind for kind in in_order(r["bodies"] for r in rows) if " " in kind]
        return {f"scenes-{kind.split()[0]}": crowds(where, kind, [r for r in rows if r["bodies"] == kind]) for kind in kinds}
    with_numbers(rows, ("best_ns", "worst_error", "worst_width"))
    if "asked" in rows[0]:
        return {"depth-speed": depth_speed(where, rows), "depth-accuracy": depth_accuracy(where, rows)}
    made = {}
    for n in in_order(r["n"] for r in rows):
        here = [r for r in rows if r["n"] == n]
        made.update({f"speed-{n}": speed(where, n, here), f"accuracy-{n}": accuracy(where, n, here)})
    return made


def committed():
    """The charts in docs/charts that are made here: where each is, what it should be, and its CSV file."""
    for kind in ("speed-*", "accuracy-*", "depth-*", "steps", "scenes-*"):
        for path in sorted(glob.glob(os.path.join(charts.FOLDER, kind + ".svg"))):
            name, named = os.path.basename(path)[:-4], charts.source(path)
            csv = os.path.join(RESULTS, *named[:1])
            if not os.path.isfile(csv):
                sys.exit(f"{name}.svg names no file of benches/results as its source: draw it anew with benches/plot.py")
            made = made_of(csv)
            if name not in made:
                sys.exit(f"{name}.svg: {named[0]} has no such chart")
            yield path, made[name], csv


def main():
    arguments = sys.argv[1:]
    if arguments == ["--check"]:
        for path, chart, _ in committed():
            charts.check(path, chart)
    elif arguments == ["--again"]:
        for path, chart, csv in committed():
            charts.draw(path, chart, [csv])
    elif len(arguments) in (1, 2):
        folder = arguments[1] if len(arguments) == 2 else charts.FOLDER
        for name, chart in made_of(arguments[0]).items():
            charts.draw(os.path.join(folder, name + ".svg"), chart, arguments[:1])
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()

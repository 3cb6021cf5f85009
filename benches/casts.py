#!/usr/bin/env python3
"""Draws the chart of casts, docs/charts/casts.svg, and fills the tables of docs/motions.md, from what compare --casts wrote.

usage: casts.py RESULTS.csv
       casts.py --check RESULTS.csv      nothing is written, and it fails where page or chart do not say what the file says
"""
import os

import charts
import claims
from charts import Cell, Cells, Line
from rows import in_order, machine, read, with_numbers

PAGE = os.path.join(charts.FOLDER, "..", "motions.md")
METHODS = {  # in the order of the columns
    "swiftprox": ("swiftprox", ""), "samples-100": ("100", "samples"), "samples-1000": ("1,000", "samples"),
    "parry-nonlinear": ("parry", "nonlinear"), "parry-linear": ("parry", "linear"), "parry-sweep": ("parry", "sweep_toi"),
    "box3d": ("Box3D", "time of impact"),
    "fcl": ("FCL", "advancement"), "bullet": ("Bullet", "convex cast"),
}
SHARES = tuple(zip((0.01, 0.03, 0.1, 0.3, 1), charts.BAD))  # of the motions answered wrongly: up to how much which colour


def micro(ns):
    """Microseconds, two digits."""
    value = ns / 1000
    return f"{value:,.0f}" if value >= 10 else f"{value:.1f}" if value >= 1 else f"{value:.2f}"


def faults(row, most=4):
    """What a method said wrongly, the most frequent kinds: missed hits, hits of free motions, hits at another time, no answer.
    Samples know no time between two of them."""
    named = [("m", "misses"), ("f", "false_hits"), ("t", "off"), ("u", "unknown")]
    if row["method"].startswith("samples"):
        named.remove(("t", "off"))
    least = sorted((row[column] for _, column in named), reverse=True)[:most][-1]
    return " ".join(f"{letter} {int(row[column])}" for letter, column in named if row[column] and row[column] >= least)


def wrong(row):
    return row["misses"] + row["false_hits"] + (0 if row["method"].startswith("samples") else row["off"])


def cell(row):
    if row is None:
        return Cell("–", "", charts.REFUSED)
    share = wrong(row) / row["count"]
    colour = next(colour for limit, colour in SHARES if share <= limit) if share else charts.GOOD
    # A cell has room for one.
    return Cell(micro(row["best_ns"]), faults(row, 1), colour)


def chart(head, rows):
    found = {(r["scene"], r["method"]): r for r in rows}
    methods = [method for method in METHODS if any(method == r["method"] for r in rows)]
    lines = [Line(scene, [cell(found.get((scene, method))) for method in methods]) for scene in in_order(r["scene"] for r in rows)]
    legend = [(charts.GOOD, "none wrong")] + [(colour, f"up to {100 * share:g} %") for share, colour in SHARES]
    return Cells("Casts of moving bodies", machine(head),
                 "µs per motion; beside it the most frequent of m missed hits, f hits of free motions, t times off by more than 1e-3, u no answer",
                 [METHODS[method] for method in methods], lines, legend + [(charts.REFUSED, "not asked")], 130)


LEFT_TO_THE_CHART = ("samples-100", "hulls 20, spin 2", "hulls 1000, spin 2", "graze 1e-6", "bullet, spin 5")


def cast_table(rows):
    found = {(r["scene"], r["method"]): r for r in rows}
    methods = [method for method in METHODS if any(method == r["method"] for r in rows) and method not in LEFT_TO_THE_CHART]
    lines = ["| scene | motions, hits | " + " | ".join(" ".join(METHODS[m]).strip() for m in methods) + " |",
             "|---|--:|" + "--:|" * len(methods)]
    for scene in in_order(r["scene"] for r in rows if r["scene"] not in LEFT_TO_THE_CHART):
        first = found[scene, methods[0]]
        here = [found.get((scene, method)) for method in methods]
        told = [" ".join(filter(None, (micro(row["best_ns"]), faults(row)))) if row else "–" for row in here]
        told[0] += f" ({first['mean_queries']:.1f})"
        lines.append(f"| {scene} | {int(first['count'])}, {int(first['hits'])} | " + " | ".join(told) + " |")
    return "\n".join(lines)


def ray_table(rows):
    lines = ["| rays | rays, hits | swiftprox, ns | parry, ns | times |", "|---|--:|--:|--:|--:|"]
    for scene in in_order(r["scene"] for r in rows):
        ours, theirs = ([r for r in rows if (r["scene"], r["method"]) == (scene, m)][0] for m in ("swiftprox", "parry"))
        told = " ".join(filter(None, (f"{theirs['best_ns']:,.0f}", faults(theirs))))
        lines.append(f"| {scene.removeprefix('rays, ')} | {int(ours['count'])}, {int(ours['hits'])} | {ours['best_ns']:,.0f} | {told} | "
                     f"{theirs['best_ns'] / ours['best_ns']:.1f} |")
    return "\n".join(lines)


def main():
    [path], check = claims.files_and_check(1, __doc__)
    head, rows = read(path)
    with_numbers(rows, ("count", "hits", "best_ns", "mean_queries", "misses", "false_hits", "off", "unknown"))
    casts, rays = ([r for r in rows if r["asked"] == asked] for asked in ("cast", "ray"))
    made = {"casts": cast_table(casts), "rays": ray_table(rays)}
    claims.show(PAGE, made, (os.path.join(charts.FOLDER, "casts.svg"), chart(head[0], casts)), path, check)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Draws the chart of the worst cases from the CSV of benches/worst_case.rs.

usage: plot_steps.py RESULTS.csv [OUTPUT.svg]

Two rows of panels, a column for each motion: the most steps of marching, below the bound in the code, and the longest time of a
query over the number of vertices, a line for each body. No package beyond Python itself is needed.
"""
import csv
import math
import sys

from plot import FRAME, Panel, duration, in_order, legend, limits, title, write

COLOURS = ["#0b5fa5", "#41a1e0", "#8fc4ee", "#d1495b", "#e8919c", "#c98a1b", "#8a6d5c", "#6b8f3a", "#a9c47f", "#3a8f85", "#8b5fbf"]
BOUND = (FRAME, "5 3", "bound, 81 + n")
ROWS = [("worst_steps", "steps", "{:g}".format), ("worst_ns", "longest query", duration)]


def read(path):
    with open(path) as file:
        head = file.readline().lstrip("# ").strip()
        rows = list(csv.DictReader(file))
    for row in rows:
        for name, value in row.items():
            if name not in ("body", "motion"):
                row[name] = float(value)
    return head, rows


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    head, rows = read(sys.argv[1])
    bodies, motions = in_order(r["body"] for r in rows), in_order(r["motion"] for r in rows)
    colours = dict(zip(bodies, COLOURS))
    sizes = sorted({r["n"] for r in rows})
    low, high = math.log10(sizes[0]), math.log10(sizes[-1])
    position = {n: 0.03 + 0.94 * (math.log10(n) - low) / (high - low) for n in sizes}
    ticks = [(position[n], f"{n:g}" if n < 1000 else f"{n / 1000:g}k") for n in sizes if math.log10(n) == round(math.log10(n))]
    side, gap, left, panel_height, row_gap = 220, 16, 66, 220, 50
    width = left + len(motions) * (side + gap)
    styles = [BOUND] + [(colours[body], "", body) for body in bodies]
    entries, used = legend(styles, left, 48, width - left - 16)
    top = 48 + used + 18
    parts = title(head, "Worst queries over the number of vertices n", width) + entries
    for i, (column, name, label) in enumerate(ROWS):
        # A query that needs no step at all is drawn at one.
        values = {(r["motion"], r["body"], r["n"]): max(r[column], 1.0) for r in rows}
        bound = [(position[n], 81.0 + n) for n in sizes] if column == "worst_steps" else []
        least, most = limits([*values.values(), *(value for _, value in bound)])
        for k, motion in enumerate(motions):
            panel = Panel(left + k * (side + gap), top + i * (panel_height + row_gap), side, panel_height, least, most)
            panel.frame(f"{name}, {motion}", ticks, k == 0, label)
            if bound:
                panel.curve(bound, BOUND[0], BOUND[1])
            for body in bodies:
                points = [(position[n], values[motion, body, n]) for n in sizes if (motion, body, n) in values]
                panel.curve(points, colours[body], "")
                for unit, value in points:
                    panel.dot(unit, value, colours[body])
            parts += panel.parts
    bottom = top + len(ROWS) * (panel_height + row_gap) + 6
    write(sys.argv[2] if len(sys.argv) == 3 else "docs/charts/steps.svg", width + 6, bottom, parts)


main()

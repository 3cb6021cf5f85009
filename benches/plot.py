#!/usr/bin/env python3
"""Draws the charts from a CSV of benches/compare.

usage: plot.py RESULTS.csv [OUTPUT_DIRECTORY]

Writes, for each number of vertices N, into the directory (docs/charts):
  speed-N.svg      ns a query over degrees a step, one panel an orbit, one line a method
  accuracy-N.svg   ns a query over error, one panel a scene, one point a method
No package beyond Python itself is needed.
"""
import csv
import math
import os
import sys

STYLES = {  # method: colour, dash pattern, label
    "swiftprox": ("#0b5fa5", "", "swiftprox, tight interval"),
    "swiftprox-verdict": ("#41a1e0", "5 3", "swiftprox, verdict bounds"),
    "parry-hc": ("#d1495b", "", "parry3d-f64, hill climbing"),
    "parry-hc-matrix": ("#e8919c", "5 3", "the same, with matrices"),
    "parry-hc-steepest": ("#e8919c", "2 3", "the same, climbing to the steepest"),
    "fcl-1e-6": ("#6b8f3a", "", "FCL (libccd), 1e-6"),
    "fcl-1e-10": ("#a9c47f", "5 3", "FCL (libccd), 1e-10"),
}
EXTRA = ["#8b5fbf", "#c98a1b", "#3a8f85", "#8a6d5c", "#555555", "#b03a8f"]
INK, FRAME, GRID = "#222222", "#999999", "#e4e4e4"
# Errors below this are rounding and drawn at this place: the exact values say nothing more on a logarithmic axis.
LEAST_ERROR = 1e-17


def read(path):
    """The CSV's head line and its rows, numbers as floats."""
    with open(path) as file:
        head = file.readline().lstrip("# ").strip()
        rows = list(csv.DictReader(file))
    for row in rows:
        row["n"] = int(row["n"])
        for name in ("best_ns", "worst_error", "worst_width"):
            row[name] = float(row[name])
    return head, rows


def in_order(items):
    return list(dict.fromkeys(items))


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def style(method, methods):
    if method in STYLES:
        return STYLES[method]
    others = [m for m in methods if m not in STYLES]
    return EXTRA[others.index(method) % len(EXTRA)], "", method


class Panel:
    """A rectangle with a logarithmic y axis; x positions are given in [0, 1]."""

    def __init__(self, left, top, width, height, low, high):
        self.left, self.top, self.width, self.height = left, top, width, height
        self.low, self.high = math.log10(low), math.log10(high)
        self.parts = []

    def x(self, unit):
        return self.left + unit * self.width

    def y(self, value):
        return self.top + self.height * (self.high - math.log10(value)) / (self.high - self.low)

    def frame(self, title, x_ticks, labelled, y_label=None):
        """x_ticks: (unit, label); y labels, durations unless `y_label` makes others, only where `labelled`."""
        for exponent in range(math.floor(self.low), math.ceil(self.high) + 1):
            for digit in (1, 2, 5):
                value = digit * 10.0**exponent
                if self.low - 1e-9 <= math.log10(value) <= self.high + 1e-9:
                    y = self.y(value)
                    self.line(self.left, y, self.left + self.width, y, GRID)
                    if labelled:
                        self.text(self.left - 6, y + 4, (y_label or duration)(value), "end")
        free = -math.inf
        for unit, label in x_ticks:
            x, half = self.x(unit), 3.4 * len(label)
            self.line(x, self.top, x, self.top + self.height, GRID)
            if x - half > free:
                self.text(x, self.top + self.height + 15, label, "middle")
                free = x + half
        self.parts.append(
            f'<rect x="{self.left:.1f}" y="{self.top:.1f}" width="{self.width:.1f}" '
            f'height="{self.height:.1f}" fill="none" stroke="{FRAME}"/>')
        self.text(self.left + self.width / 2, self.top - 7, title, "middle", "bold")

    def line(self, x1, y1, x2, y2, colour, width=1.0):
        self.parts.append(
            f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" '
            f'stroke="{colour}" stroke-width="{width}"/>')

    def text(self, x, y, text, anchor, weight="normal"):
        self.parts.append(text_element(x, y, text, anchor, weight))

    def curve(self, points, colour, dash):
        path = " ".join(f"{self.x(u):.1f},{self.y(v):.1f}" for u, v in points)
        self.parts.append(
            f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.8" '
            f'stroke-dasharray="{dash}"/>')

    def dot(self, unit, value, colour, hollow=False):
        fill = "white" if hollow else colour
        self.parts.append(
            f'<circle cx="{self.x(unit):.1f}" cy="{self.y(value):.1f}" r="3.4" fill="{fill}" '
            f'stroke="{colour}" stroke-width="1.5"/>')


def text_element(x, y, text, anchor="start", weight="normal", turn=""):
    return (f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-weight="{weight}" '
            f'fill="{INK}"{turn}>{text}</text>')


def duration(ns):
    for unit, name in ((1e6, "ms"), (1e3, "µs")):
        if ns >= unit:
            return f"{ns / unit:g} {name}"
    return f"{ns:g} ns"


def legend(styles, left, top, width):
    """Entries (colour, dash pattern, label) from left to right, in as many lines as it takes; and the height used."""
    parts, x, y = [], left, top
    for colour, dash, label in styles:
        advance = 46 + 6.3 * len(label)
        if x + advance > left + width:
            x, y = left, y + 18
        parts.append(f'<line x1="{x}" y1="{y - 4}" x2="{x + 24}" y2="{y - 4}" stroke="{colour}" '
                     f'stroke-width="2" stroke-dasharray="{dash}"/>')
        parts.append(f'<circle cx="{x + 12}" cy="{y - 4}" r="3.4" fill="{colour}"/>')
        parts.append(text_element(x + 30, y, label))
        x += advance
    return parts, y - top + 18


def write(path, width, height, parts):
    with open(path, "w") as out:
        out.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
                  f'width="{width:.0f}" height="{height:.0f}" font-family="sans-serif" font-size="12">\n'
                  f'<rect width="100%" height="100%" fill="white"/>\n')
        out.write("\n".join(parts))
        out.write("\n</svg>\n")
    print(path)


def limits(values):
    """The decade fractions 1, 2, 5 around the values."""
    steps = [d * 10.0**e for e in range(-3, 12) for d in (1, 2, 5)]
    return max(s for s in steps if s <= min(values)), min(s for s in steps if s >= max(values))


def step_positions(steps):
    """Steps on a logarithmic axis, 'random' apart at the right end."""
    degrees = [float(s) for s in steps if s != "random"]
    low, high = (math.log10(min(degrees)), math.log10(max(degrees))) if degrees else (0.0, 1.0)
    span = 0.79 / (high - low) if high > low else 0.0
    return {s: 0.94 if s == "random" else 0.03 + span * (math.log10(float(s)) - low) for s in steps}


def title(head, text, width):
    return [text_element(16, 22, text, weight="bold"),
            # Without the compiler's flags, which stand in the CSV file.
            text_element(width - 16, 22, head.split(", -")[0], "end")]


def draw_speed(path, head, n, rows):
    orbits, steps = in_order(r["orbit"] for r in rows), in_order(r["step"] for r in rows)
    methods = in_order(r["method"] for r in rows)

    def mean(orbit, step, method):
        times = [r["best_ns"] for r in rows if (r["orbit"], r["step"], r["method"]) == (orbit, step, method)]
        return geometric_mean(times) if times else None

    means = {(o, s, m): mean(o, s, m) for o in orbits for s in steps for m in methods}
    low, high = limits([v for v in means.values() if v])
    position = step_positions(steps)
    side, gap, left, panel_height = 300, 18, 66, 300
    width = left + len(orbits) * (side + gap)
    entries, used = legend([style(m, methods) for m in methods], left, 48, width - left - 16)
    top = 48 + used + 18
    parts = title(head, f"Exact distance with witness points, {n} vertices: time a query", width) + entries
    for k, orbit in enumerate(orbits):
        panel = Panel(left + k * (side + gap), top, side, panel_height, low, high)
        panel.frame(f"{orbit} orbit", [(position[s], s if s == "random" else s + "°") for s in steps], k == 0)
        for method in methods:
            colour, dash, _ = style(method, methods)
            known = [(s, means[orbit, s, method]) for s in steps if means[orbit, s, method]]
            panel.curve([(position[s], v) for s, v in known if s != "random"], colour, dash)
            for s, v in known:
                panel.dot(position[s], v, colour)
        parts += panel.parts
    bottom = top + panel_height + 36
    parts.append(text_element(left, bottom, "motion from one query to the next; geometric mean over the models "
                              + ", ".join(in_order(r["model"] for r in rows))))
    write(path, width, bottom + 14, parts)


def draw_accuracy(path, head, n, rows):
    """Full dots: the largest error observed; rings: the largest width of a guaranteed interval."""
    orbits = in_order(r["orbit"] for r in rows)
    steps = [s for s in in_order(r["step"] for r in rows) if s in ("0.1", "1", "10", "random")]
    rows = [r for r in rows if r["step"] in steps]
    methods = in_order(r["method"] for r in rows)
    low, high = limits([r["best_ns"] for r in rows])
    decades = (math.log10(LEAST_ERROR), 0.0)

    def unit(error):
        decade = math.log10(max(error, LEAST_ERROR))
        return 0.03 + 0.94 * (decade - decades[0]) / (decades[1] - decades[0])

    ticks = [(unit(10.0**e), f"1e{e}" if e else "1") for e in range(-16, 1, 4)]
    side, gap, left, panel_height, row_gap = 200, 16, 66, 170, 44
    width = left + len(steps) * (side + gap)
    entries, used = legend([style(m, methods) for m in methods], left, 48, width - left - 16)
    top = 48 + used + 18
    parts = title(head, f"Speed against accuracy, {n} vertices", width) + entries
    for i, orbit in enumerate(orbits):
        for k, step in enumerate(steps):
            panel = Panel(left + k * (side + gap), top + i * (panel_height + row_gap), side, panel_height, low, high)
            motion = "random" if step == "random" else f"{step}° a query"
            panel.frame(f"{orbit}, {motion}", ticks, k == 0)
            for method in methods:
                colour, _, _ = style(method, methods)
                cell = [r for r in rows if (r["orbit"], r["step"], r["method"]) == (orbit, step, method)]
                if not cell:
                    continue
                time = geometric_mean([r["best_ns"] for r in cell])
                errors = [r["worst_error"] for r in cell if not math.isnan(r["worst_error"])]
                widths = [r["worst_width"] for r in cell if not math.isnan(r["worst_width"])]
                if widths:
                    panel.dot(unit(max(widths)), time, colour, hollow=True)
                elif errors:
                    panel.dot(unit(max(errors)), time, colour)
            parts += panel.parts
    bottom = top + len(orbits) * (panel_height + row_gap)
    parts.append(text_element(left, bottom, "error of the distance, models of radius 1. Full dots: the worst observed; "
                              "rings: the width of the widest guaranteed interval"))
    write(path, width, bottom + 16, parts)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    head, rows = read(sys.argv[1])
    directory = sys.argv[2] if len(sys.argv) == 3 else "docs/charts"
    os.makedirs(directory, exist_ok=True)
    for n in in_order(r["n"] for r in rows):
        here = [r for r in rows if r["n"] == n]
        draw_speed(os.path.join(directory, f"speed-{n}.svg"), head, n, here)
        draw_accuracy(os.path.join(directory, f"accuracy-{n}.svg"), head, n, here)


if __name__ == "__main__":
    main()

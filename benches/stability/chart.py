#!/usr/bin/env python3
"""Draws the failure chart, and keeps the tables of docs/stability.md what the CSV files say.

  chart.py COUNTS.csv COST.csv SVG PAGE.md [--check]

Writes the SVG, and in the page replaces what stands between <!-- table: NAME --> and <!-- end -->. With --check it writes nothing
and fails where either differs. No package beyond Python itself is needed.
"""
import csv
import math
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
from plot import FRAME, INK, text_element  # noqa: E402
from stability import COUNTS, FAILURES, TIERS  # noqa: E402

COLUMNS = (  # method of the chart, two lines of head; a star: verdicts only
    ("swiftprox", "swiftprox", ""),
    ("libccd-gjk", "libccd GJK", "*"),
    ("libccd-mpr=1e-10", "libccd MPR", "1e-10 *"),
    ("fcl-libccd=1e-10", "FCL libccd", "1e-10"),
    ("fcl-indep=1e-10", "FCL indep", "1e-10"),
    ("parry", "parry", ""),
    ("parry-hull", "parry", "own hull"),
    ("parry-hc", "parry", "climbing"),
    ("coal=1e-10", "coal", "1e-10"),
    ("coal-hull=1e-10", "coal own", "hull, 1e-10"),
)
NONE_COLOUR, REFUSED_COLOUR = "#e3f1e4", "#d9d9d9"
SCALE = ((255, 243, 205), (244, 165, 100), (165, 25, 45))  # shares of 0.1 %, 3 % and all
LEFT, TOP, WIDTH, HEIGHT = 150, 92, 84, 23


def read(path):
    """The head lines and the rows of a CSV file, whole numbers as such."""
    with open(path) as file:
        lines = file.read().splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    for row in rows:
        row.update((name, int(value)) for name, value in row.items() if value.isdigit())
    return [line[2:] for line in lines if line.startswith("#")], rows


def in_order(items):
    return list(dict.fromkeys(items))


def total(rows):
    """The sum of some rows of counts."""
    sums = {count: sum(row[count] for row in rows) for count in ("poses",) + COUNTS}
    sums["worst_wrong"] = max(float(row["worst_wrong"]) for row in rows)
    sums["worst_error"] = max(float(row["worst_error"]) for row in rows)
    return sums


def failures(row):
    return sum(row[failure] for failure in FAILURES)


# ---- the chart ----

def colour(share):
    if share == 0:
        return NONE_COLOUR
    place = max(0.0, 2 + math.log10(share) / 1.5)
    lower = min(int(place), 1)
    part = place - lower
    return "#" + "".join("%02x" % round(a + part * (b - a)) for a, b in zip(SCALE[lower], SCALE[lower + 1]))


def cell(x, y, row):
    """The count of failures on the colour of their share of the poses that the method did not refuse."""
    asked = row["poses"] - row["refused"]
    failed = failures(row)
    if asked == 0:
        box, text = REFUSED_COLOUR, "refused"
    else:
        box, text = colour(failed / asked), str(failed)
        if row["refused"]:
            text += f'<tspan font-size="9" dx="4">−{row["refused"]}</tspan>'
    label = text_element(x + WIDTH / 2 - 1, y + HEIGHT / 2 + 3, text, "middle")
    if asked and failed / asked > 0.15:
        label = label.replace(f'fill="{INK}"', 'fill="white"')
    return [f'<rect x="{x}" y="{y}" width="{WIDTH - 2}" height="{HEIGHT - 2}" fill="{box}"/>', label]


def legend(x, y):
    parts = [f'<rect x="{x}" y="{y}" width="34" height="14" fill="{NONE_COLOUR}"/>', text_element(x + 40, y + 11, "none")]
    for k, share in enumerate((0.001, 0.01, 0.1, 1)):
        at = x + 92 + 92 * k
        parts.append(f'<rect x="{at}" y="{y}" width="34" height="14" fill="{colour(share)}"/>')
        parts.append(text_element(at + 40, y + 11, f"{100 * share:g} %"))
    at = x + 92 + 92 * 4
    parts.append(f'<rect x="{at}" y="{y}" width="34" height="14" fill="{REFUSED_COLOUR}"/>')
    return parts + [text_element(at + 40, y + 11, "no shape made; −n: of so many poses")]


def chart(head, rows):
    """The SVG as text."""
    found = {(row["family"], row["method"]): row for row in rows}
    columns = [column for column in COLUMNS if any(method == column[0] for _, method in found)]
    families = in_order(row["family"] for row in rows)
    width = LEFT + len(columns) * WIDTH + 64
    parts = [text_element(16, 24, "Failures on hard cases", weight="bold"),
             text_element(width - 16, 24, head[0].split(",")[0], "end"),
             text_element(16, 42, "how many poses: wrong verdict, distance off by more than 1e-6 of the size (* says none), NaN, "
                                  "exception, crash or hang; colour: their share")]
    for k, (_, first, second) in enumerate(columns):
        x = LEFT + k * WIDTH + WIDTH / 2 - 1
        parts += [text_element(x, TOP - 22, first, "middle", "bold"), text_element(x, TOP - 8, second, "middle")]
    parts.append(text_element(width - 16, TOP - 8, "poses", "end"))
    for i, family in enumerate(families + ["all"]):
        y = TOP + i * HEIGHT + (8 if family == "all" else 0)
        weight = "bold" if family == "all" else "normal"
        parts.append(text_element(LEFT - 8, y + HEIGHT / 2 + 3, family, "end", weight))
        for k, (method, _, _) in enumerate(columns):
            here = [found[f, method] for f in (families if family == "all" else [family])]
            parts += cell(LEFT + k * WIDTH, y, total(here))
        poses = sum(found[f, columns[0][0]]["poses"] for f in (families if family == "all" else [family]))
        parts.append(text_element(width - 16, y + HEIGHT / 2 + 3, str(poses), "end", weight))
    bottom = TOP + (len(families) + 1) * HEIGHT + 8
    parts.append(f'<line x1="{LEFT}" y1="{bottom - HEIGHT - 5}" x2="{width - 16}" y2="{bottom - HEIGHT - 5}" stroke="{FRAME}"/>')
    parts += legend(LEFT, bottom + 14)
    height = bottom + 44
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
            f'font-family="sans-serif" font-size="12">\n<rect width="100%" height="100%" fill="white"/>\n'
            + "\n".join(parts) + "\n</svg>\n")


# ---- the tables ----

def table(head, rows):
    aligned = ["---"] + ["--:"] * (len(head) - 1)
    return "\n".join("| " + " | ".join(str(item) for item in row) + " |" for row in [head, aligned] + rows)


def small(value):
    return "" if float(value) == 0 else f"{float(value):.0e}"


def totals_table(rows):
    """Each method over all families."""
    lines = []
    for method in in_order(row["method"] for row in rows):
        sums = total([row for row in rows if row["method"] == method])
        lines.append([f"`{method}`", failures(sums), sums["wrong"], sums["gross"], small(sums["worst_wrong"]), sums["off"],
                      small(sums["worst_error"]), sums["nan"], sums["threw"], sums["aborted"], sums["timed_out"], sums["refused"]])
    return table(["method", "failures", "wrong", "of them gross", "worst, over L", "off", "worst, over L", "NaN", "threw",
                  "aborted", "timed out", "refused"], lines)


def cost_table(costs):
    """How often each tier was needed, and the time of a query it decided."""
    lines = []
    for family in in_order(row["family"] for row in costs):
        tiers = {row["tier"]: row for row in costs if row["family"] == family}
        answers = sum(row["answers"] for row in tiers.values())
        line = [family, answers]
        for tier in TIERS:
            row = tiers.get(tier)
            line += [f'{100 * row["answers"] / answers:.0f} %', duration(row["median_ns"]), duration(row["worst_ns"])] if row else [""] * 3
        lines.append(line)
    answers = sum(row["answers"] for row in costs)
    line = ["**all**", answers]
    for tier in TIERS:
        here = [row for row in costs if row["tier"] == tier]
        line += [f'{100 * sum(row["answers"] for row in here) / answers:.0f} %', "", duration(max(row["worst_ns"] for row in here))]
    return table(["family", "poses"] + [head for tier in TIERS for head in (tier, "median", "worst")], lines + [line])


def duration(nanoseconds):
    return f"{nanoseconds} ns" if nanoseconds < 1000 else f"{nanoseconds / 1000:.1f} µs"


def page(text, head, rows, costs):
    """The page with its tables made anew."""
    tables = {"totals": totals_table(rows), "cost": cost_table(costs),
              "settings": "\n".join(f"- `{line.split(': ')[0]}`: {line.split(': ', 1)[1]}" for line in head[1:])}

    def anew(match):
        return f"<!-- table: {match[1]} -->\n{tables[match[1]]}\n<!-- end -->"

    return re.sub(r"<!-- table: (\w+) -->\n.*?<!-- end -->", anew, text, flags=re.DOTALL)


def main():
    if len(sys.argv) not in (5, 6):
        sys.exit(__doc__)
    head, rows = read(sys.argv[1])
    _, costs = read(sys.argv[2])
    with open(sys.argv[4]) as file:
        text = file.read()
    made = {sys.argv[3]: chart(head, rows), sys.argv[4]: page(text, head, rows, costs)}
    for path, content in made.items():
        if sys.argv[5:] == ["--check"]:
            with open(path) as file:
                if file.read() != content:
                    sys.exit("%s is not what chart.py makes of %s" % (path, sys.argv[1]))
        else:
            with open(path, "w") as out:
                out.write(content)
            print(path)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Draws the failure chart, and keeps the tables of docs/stability.md what the CSV files say.

  report.py COUNTS.csv COST.csv SVG PAGE.md [--check]

Writes the page, in which it replaces what stands between <!-- table: NAME --> and <!-- end -->, the SVG, and beside it one of the
totals, -total.svg. With --check it writes nothing and fails where the page differs, or an SVG is not the drawing of these counts.
"""
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
import charts  # noqa: E402
from charts import Bars, Cell, Cells, Line  # noqa: E402
from rows import in_order, machine, read  # noqa: E402
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
SHARES = tuple(zip((0.01, 0.03, 0.1, 0.3, 1), charts.BAD))  # of the poses: up to how much which colour


def read_both(counts_csv, cost_csv):
    """The head lines and the rows of counts, and the rows of costs; whole numbers as such."""
    head, counts = read(counts_csv)
    _, costs = read(cost_csv)
    for row in counts + costs:
        row.update((name, int(value)) for name, value in row.items() if value.isdigit())
    return head, counts, costs


def total(rows):
    """The sum of some rows of counts."""
    sums = {count: sum(row[count] for row in rows) for count in ("poses",) + COUNTS}
    sums["worst_wrong"] = max(float(row["worst_wrong"]) for row in rows)
    sums["worst_error"] = max(float(row["worst_error"]) for row in rows)
    return sums


def failures(row):
    return sum(row[failure] for failure in FAILURES)


# ---- the chart ----

def cell(sums):
    """The count of failures on the colour of their share of the poses that the method did not refuse."""
    asked = sums["poses"] - sums["refused"]
    failed = failures(sums)
    if asked == 0:
        return Cell("refused", "", charts.REFUSED)
    colour = next(colour for share, colour in SHARES if failed <= share * asked) if failed else charts.GOOD
    return Cell(str(failed), f'−{sums["refused"]}' if sums["refused"] else "", colour)


def chart(head, rows):
    found = {(row["family"], row["method"]): row for row in rows}
    columns = [column for column in COLUMNS if any(method == column[0] for _, method in found)]
    families = in_order(row["family"] for row in rows)
    lines = []
    for name, here in [(family, [family]) for family in families] + [("all", families)]:
        sums = [total([found[family, method] for family in here]) for method, _, _ in columns]
        lines.append(Line(name, [cell(column) for column in sums], str(sums[0]["poses"]), gap_before=name == "all", bold=name == "all"))
    legend = [(charts.GOOD, "none")] + [(colour, f"up to {100 * share:g} %") for share, colour in SHARES]
    return Cells("Failures on hard cases", machine(head[0]),
                 "how many poses: wrong verdict, distance off by more than 1e-6 of the size (* says none), NaN, exception, crash or hang; "
                 "colour: their share", [column[1:] for column in columns], lines,
                 legend + [(charts.REFUSED, "no shape made; −n: of n poses")], 96, "poses")


def total_chart(head, rows):
    """The failures of each method over all families."""
    names = {method: " ".join(part for part in (first, second.strip("* ")) if part) for method, first, second in COLUMNS}
    lines = [(names[method], failures(total([row for row in rows if row["method"] == method])))
             for method in names if any(row["method"] == method for row in rows)]
    return Bars("Failures on hard poses", machine(head[0]), lines, 130)


# ---- the tables ----

def table(head, rows):
    aligned = ["---"] + ["--:"] * (len(head) - 1)
    return "\n".join("| " + " | ".join(str(item) for item in row) + " |" for row in [head, aligned] + rows)


def small(value):
    return "" if float(value) == 0 else f"{float(value):.0e}"


def totals_table(rows):
    """Each method over all families, without the kinds of failure that none has."""
    columns = [("failures", failures), ("wrong", "wrong"), ("gross", "gross"), ("off", "off"), ("NaN", "nan"), ("threw", "threw"),
               ("aborted", "aborted"), ("timed out", "timed_out"), ("refused", "refused")]
    sums = {method: total([row for row in rows if row["method"] == method]) for method in in_order(row["method"] for row in rows)}
    values = {head: [of(row) if callable(of) else row[of] for row in sums.values()] for head, of in columns}
    shown = {head: column for head, column in values.items() if head == "failures" or any(column)}
    return table(["method", *shown], [[f"`{method}`", *line] for method, line in zip(sums, zip(*shown.values()))])


COSTLIEST = 2  # families that the page shows


def cost_table(costs):
    """How often each tier was needed, and the time of a query it decided: all families, and those that need integers most."""
    shares, lines = {}, {}
    for family in in_order(row["family"] for row in costs):
        tiers = {row["tier"]: row for row in costs if row["family"] == family}
        answers = sum(row["answers"] for row in tiers.values())
        shares[family] = tiers["exact"]["answers"] / answers if "exact" in tiers else 0
        line = [family, answers]
        for tier in TIERS:
            row = tiers.get(tier)
            line += [f'{100 * row["answers"] / answers:.0f} %', duration(row["median_ns"]), duration(row["worst_ns"])] if row else [""] * 3
        lines[family] = line
    answers = sum(row["answers"] for row in costs)
    line = ["**all**", answers]
    for tier in TIERS:
        here = [row for row in costs if row["tier"] == tier]
        line += [f'{100 * sum(row["answers"] for row in here) / answers:.0f} %', "", duration(max(row["worst_ns"] for row in here))]
    costliest = sorted(lines, key=lambda family: -shares[family])[:COSTLIEST]
    return table(["family", "poses"] + [head for tier in TIERS for head in (tier, "median", "worst")], [lines[family] for family in costliest] + [line])


def duration(nanoseconds):
    return f"{nanoseconds} ns" if nanoseconds < 1000 else f"{nanoseconds / 1000:.1f} µs"


WORST = "100000"  # the largest number of vertices of benches/results/worst-case.csv


def longest_table():
    """The longest query of each motion, and the most steps; without the depths, which are not timed there."""
    _, rows = read(os.path.join(HERE, "..", "results", "worst-case.csv"))
    rows = [row for row in rows if row["motion"] != "depth" and row["n"] == WORST]
    lines = []
    for motion in in_order(row["motion"] for row in rows):
        here = [row for row in rows if row["motion"] == motion]
        slowest, farthest = (max(here, key=lambda row: float(row[name])) for name in ("worst_ns", "worst_steps"))
        lines.append((motion, f"{float(slowest['worst_ns']) / 1e6:.1f} ms", slowest["body"],
                      f"{int(farthest['worst_steps']):,}", farthest["body"]))
    return table(("motion", "longest query", "of", "most steps", "of"), lines)


def page(text, rows, costs):
    """The page with its tables made anew."""
    tables = {"longest": longest_table(), "totals": totals_table(rows), "cost": cost_table(costs)}

    def anew(match):
        return f"<!-- table: {match[1]} -->\n{tables[match[1]]}\n<!-- end -->"

    return re.sub(r"<!-- table: (\w+) -->\n.*?<!-- end -->", anew, text, flags=re.DOTALL)


def main():
    if len(sys.argv) not in (5, 6):
        sys.exit(__doc__)
    counts_csv, cost_csv, svg, page_path = sys.argv[1:5]
    check = sys.argv[5:] == ["--check"]
    head, rows, costs = read_both(counts_csv, cost_csv)
    with open(page_path) as file:
        text = file.read()
    filled = page(text, rows, costs)
    if check and filled != text:
        sys.exit(f"{page_path} does not say what {counts_csv} says: run make charts")
    drawn = {svg: chart(head, rows), svg.replace(".svg", "-total.svg"): total_chart(head, rows)}
    if check:
        for path, made in drawn.items():
            charts.check(path, made)
        return
    with open(page_path, "w") as out:
        out.write(filled)
    print(page_path)
    for path, made in drawn.items():
        charts.draw(path, made, [counts_csv])


if __name__ == "__main__":
    main()

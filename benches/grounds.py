#!/usr/bin/env python3
"""Draws the chart of contacts with grounds, docs/charts/grounds.svg, and fills the table of rays in docs/grounds.md, from what
compare --grounds wrote.

usage: grounds.py CONTACTS.csv RAYS.csv
       grounds.py --check CONTACTS.csv RAYS.csv      nothing is written, and it fails where page or chart do not say what the files say
"""
import os

import charts
import claims
from charts import Cell, Cells, Line
from rows import in_order, machine, read, with_numbers

PAGE = os.path.join(charts.FOLDER, "..", "grounds.md")
METHODS = {  # in the order of the columns
    "swiftprox": ("swiftprox", ""), "parry": ("parry", ""), "parry-fixed": ("parry", "edges mended"),
    "jolt": ("Jolt", "float"), "jolt-removing": ("Jolt", "edges removed"),
}
SHARES = tuple(zip((0.005, 0.01, 0.03, 1), charts.BAD))  # of the normals that are steep: up to how much which colour


def cell(row):
    if row is None:
        return Cell("–", "", charts.REFUSED)
    share = row["ghosts"] / max(1, row["normals"])
    colour = next(colour for limit, colour in SHARES if share <= limit) if share else charts.GOOD
    return Cell(f"{row['best_ns'] / 1000:.1f}", f"{row['points'] / row['count']:.0f}", colour)


def chart(head, rows):
    scene_of = lambda row: f"{row['surface']}: {row['body']}, {row['motion']}"
    found = {(scene_of(r), r["method"]): r for r in rows}
    methods = [method for method in METHODS if any(method == r["method"] for r in rows)]
    lines = [Line(scene, [cell(found.get((scene, method))) for method in methods]) for scene in in_order(map(scene_of, rows))]
    legend = [(charts.GOOD, "no normal is steep")] + [(colour, f"up to {100 * share:g} %") for share, colour in SHARES]
    return Cells("Contacts of bodies with grounds of 20,000 triangles", machine(head),
                 "µs per body; beside it points per body; steep normals are over 45° off, on ground of at most 16°",
                 [METHODS[method] for method in methods], lines, legend, 210)


def ray_table(rows):
    methods = in_order(row["method"] for row in rows)
    found = {(row["triangles"], row["method"]): row for row in rows}
    lines = ["| triangles | " + " | ".join(f"{method}, ns" for method in methods) + " |", "|--:|" + "--:|" * len(methods)]
    for count in in_order(row["triangles"] for row in rows):
        times = " | ".join(f"{found[count, method]['best_ns']:,.0f}" for method in methods)
        lines.append(f"| {int(count):,} | {times} |")
    return "\n".join(lines)


def main():
    [contacts, rays], check = claims.files_and_check(2, __doc__)
    head, rows = read(contacts)
    with_numbers(rows, ("count", "best_ns", "points", "normals", "ghosts"))
    _, of_rays = read(rays)
    with_numbers(of_rays, ("best_ns",))
    drawn = (os.path.join(charts.FOLDER, "grounds.svg"), chart(head[0], rows))
    claims.show(PAGE, {"rays": ray_table(of_rays)}, drawn, contacts, check)


if __name__ == "__main__":
    main()

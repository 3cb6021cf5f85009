#!/usr/bin/env python3
"""Plays scenes in rigid-body engines, and draws of the numbers docs/charts/engines.svg, docs/pictures/card-house.svg and the tables of docs/engines.md.

usage: engines.py --play FOLDER RESULTS.csv   FOLDER has the programs of examples/engines; pictures go to docs/pictures
       engines.py RESULTS.csv
       engines.py --check RESULTS.csv         nothing is written, and it fails where page or chart do not say what the file says
"""
import csv
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

import charts
import claims
import rows
from charts import Axis, Curve, Kind, Panel, Panels, Row, Style

PAGE = os.path.join(charts.FOLDER, "..", "engines.md")
PICTURES = os.path.join(charts.FOLDER, "..", "pictures")
RUNS = {"mujoco": 4, "bullet": 4, "dart": 1}  # a run of DART takes half an hour
COLUMNS = ("moved_m", "energy_j", "contacts", "step_us")
SHORT = {"ten boxes": "boxes", "eight drums": "drums", "wall of 33 bricks": "wall", "arch of 11 wedges": "arch",
         "card house": "cards", "36 hulls in a tray": "tray"}
STYLES = {"own": Style("the engine's own collider", charts.RED, marker="s"), "swiftprox": Style("swiftprox", charts.BLUE)}


# ---- playing ----

def play(folder, engine):
    """The rows of an engine's runs. Times are the least of them; all else has to be the same."""
    merged = None
    with tempfile.TemporaryDirectory() as place:
        for _ in range(RUNS[engine]):
            subprocess.run([os.path.join(folder, engine + "_compare"), place], check=True)
            _, found = rows.read(os.path.join(place, f"engines-{engine}.csv"))
            times = [min(float(row["step_us"]) for row in of) for of in zip(found, merged or found)]
            for row, time, before in zip(found, times, merged or found):
                row["step_us"] = time
                if any(row[column] != before[column] for column in row if column != "step_us"):
                    sys.exit(f"{engine}: {row['scene']} ended in two ways: {before}, {row}")
            merged = found
        shutil.copy(os.path.join(place, f"engines-{engine}.svg"), PICTURES)
    return merged


def play_all(folder, path):
    played = []
    for engine in RUNS:
        if os.path.exists(os.path.join(folder, engine + "_compare")):
            played += play(folder, engine)
        else:
            print(f"{engine} is not installed: left out", file=sys.stderr)
    if not played:
        sys.exit("none of the engines is installed")
    with open(path, "w", newline="") as out:
        out.write(f"# {rows.here()}\n")
        table = csv.DictWriter(out, played[0].keys(), lineterminator="\n")
        table.writeheader()
        table.writerows(played)


# ---- the first picture of README.md ----

HERO = os.path.join(PICTURES, "card-house.svg")
HERO_SCENE, HERO_WIDTH, HERO_HEIGHT = "card house", 410, 280
WHOLE, LOWER_HALF = ('viewBox="0 0 600 760"', '<rect '), ('viewBox="0 345 600 410"', '<rect y="345" ')


def hero():
    """The card house of docs/pictures/engines-dart.svg by either collider, beside each other."""
    with open(os.path.join(PICTURES, "engines-dart.svg"), encoding="utf-8") as file:
        text = file.read()
    x = re.search(rf'<text x="(\d+)" y="\d+">{HERO_SCENE}</text>', text)[1]
    panels = re.findall(rf'<svg x="{x}" y="\d+" width="\d+" height="\d+" (.*?</svg>)', text, re.DOTALL)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * HERO_WIDTH + 10}" height="{HERO_HEIGHT + 20}" '
             f'font-family="sans-serif" font-size="13">\n<rect width="100%" height="100%" fill="white"/>']
    for k, (name, panel) in enumerate(zip(("contacts by FCL", "contacts by swiftprox"), panels, strict=True)):
        for whole, lower in zip(WHOLE, LOWER_HALF):
            panel = panel.replace(whole, lower)
        parts.append(f'<text x="{k * (HERO_WIDTH + 10)}" y="14">{name}</text>\n'
                     f'<svg x="{k * (HERO_WIDTH + 10)}" y="20" width="{HERO_WIDTH}" height="{HERO_HEIGHT}" {panel}')
    return "\n".join(parts) + "\n</svg>\n"


# ---- page and chart ----

def of_scenes(played, engine):
    """{scene: {collider: row}}"""
    found = {}
    for row in played:
        if row["engine"] == engine:
            found.setdefault(row["scene"], {})[row["collider"]] = row
    return found


def table(played, engine):
    names, formats = {"moved_m": "moved, m", "step_us": "step, µs"}, {"moved_m": "{:.2g}", "step_us": "{:,.0f}"}
    head = ["scene"] + [cell for column in names for cell in (f"{names[column]}: {engine}", "swiftprox")]
    lines = [[scene] + [formats[column].format(of[collider][column]) if collider in of else "–"
                        for column in names for collider in STYLES] for scene, of in of_scenes(played, engine).items()]
    return claims.table(head, lines)


def decades(label, values, name):
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    step = 1 if high - low < 8 else 4
    return Axis(label, 10.0**low, 10.0**high, [(10.0**e, name(e)) for e in range(low, high + 1) if e % step == 0])


def chart(where, played):
    engines = rows.in_order(row["engine"] for row in played)
    x = Axis("scene", 0.6, 2.0**(len(SHORT) - 1) / 0.6, [(2.0**k, short) for k, short in enumerate(SHORT.values())])
    place = {scene: 2.0**k for k, scene in enumerate(SHORT)}

    def panel(engine, column, title):
        of = of_scenes(played, engine)
        return Panel(f"{engine}: {title}", [Curve(collider, [(place[scene], by[collider][column]) for scene, by in of.items()
                                                             if collider in by], Kind.DOTS) for collider in STYLES])

    said = {"moved_m": ("moved", "metres", lambda e: f"{10.0**e:g}"), "energy_j": ("energy", "joules", lambda e: f"1e{e}"),
            "step_us": ("a step", "time", lambda e: charts.duration(10.0**(e + 3)))}
    made = [Row([panel(engine, column, title) for engine in engines],
                decades(label, [row[column] for row in played], name), 110) for column, (title, label, name) in said.items()]
    return Panels("Scenes in rigid-body engines, after 10 simulated seconds", where, x, STYLES, made,
                  "How far the body that moved most is from where it began (in the tray all fall first), the kinetic energy, and the median\n"
                  "time of a step in the last fifth.")


def main():
    arguments = sys.argv[1:]
    if arguments[:1] == ["--play"] and len(arguments) == 3:
        return play_all(*arguments[1:])
    [path], check = claims.files_and_check(1, __doc__)
    head, played = rows.read(path)
    rows.with_numbers(played, COLUMNS)
    where = rows.machine(head[0])
    made = {engine.lower(): table(played, engine) for engine in rows.in_order(row["engine"] for row in played)}
    made["machine"] = f"Measured on: {where}."
    if check:
        with open(HERO, encoding="utf-8") as file:
            if file.read() != hero():
                sys.exit("card-house.svg is not of engines-dart.svg: run make charts")
    else:
        with open(HERO, "w", encoding="utf-8") as file:
            file.write(hero())
    claims.show(PAGE, made, (os.path.join(charts.FOLDER, "engines.svg"), chart(where, played)), path, check)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Checks that sentences and tables of docs/benchmarks.md, docs/choosing.md and docs/compounds.md that have numbers say what the CSV files of benches/results say.
Each is made anew here, and the page has to have it word for word."""
import os
import sys

from rows import geometric_mean, machine, read

HERE = os.path.dirname(os.path.abspath(__file__))


SPEED, BUILD, CROWDS = "2026-11-22-intel-xeon.csv", "figures-build.csv", "crowds.csv"
COMPOUNDS = "compounds.csv"


def rows_of(name):
    return read(os.path.join(HERE, "results", name))[1]


def commit_of(name):
    """As the head of a CSV file names it."""
    head, _ = read(os.path.join(HERE, "results", name))
    return next(part for part in machine(head[0]).split(", ") if part.startswith("commit "))


def table_times():
    times = [float(row["best_ms"]) for row in rows_of(BUILD) if (row["n"], row["method"]) == ("1002", "table")]
    return f"makes its look-up table: {min(times):.2f} to {max(times):.2f} ms at 1,002 vertices"


def mesh_times():
    def between(n, digits):
        times = [float(row["best_ms"]) for row in rows_of(BUILD) if (row["n"], row["method"]) == (n, "swiftprox-mesh")]
        return f"{min(times):.{digits}f} to {max(times):.{digits}f} ms"

    return f"{between('1002', 1)} at 1,002 vertices, {between('10002', 0)} at 10,002, {between('100002', 0)} at 100,002"


def second_thread():
    times = {}
    for row in rows_of(CROWDS):
        if row["motion"] == "all" and int(row["count"]) >= 10000:
            times.setdefault((row["bodies"], row["count"], row["query"]), {})[row["method"]] = float(row["mean_ms"])
    saved = [100 * (1 - of["swiftprox-2"] / of["swiftprox"]) for of in times.values() if "swiftprox-2" in of]
    return f"saves {min(saved):.0f} to {max(saved):.0f} % of a step of 10,000 bodies or more where all move"


MOTIONS = {"0.1": "0.1°", "1": "1°", "10": "10°", "random": "random"}


def mean_ns(rows, column="best_ns", **wanted):
    """The geometric mean of a time over the rows that have the wanted values, of each motion."""
    of = {}
    for row in rows:
        if all(row[name] == value for name, value in wanted.items()):
            of.setdefault(row["step"], []).append(float(row[column]))
    return {step: f"{geometric_mean(times):.0f}" for step, times in of.items()}


def table(first, lines):
    """A table whose columns are motions; a line is a name and a time for each."""
    head = [f"| {first} | " + " | ".join(MOTIONS.values()) + " |", "|---|" + "--:|" * len(MOTIONS)]
    return "\n".join(head + [f"| {name} | " + " | ".join(times[step] for step in MOTIONS) + " |" for name, times in lines])


def query_table():
    rows = rows_of("figures-choice.csv")
    orbits = {"small": "apart", "deep": "at times overlapping"}
    return table("query", [(f"{query}, {said}", mean_ns(rows, query=query, orbit=orbit, series="automatic"))
                           for query in ("intersection", "distance", "approximate", "contact") for orbit, said in orbits.items()])


def depth_table():
    rows = rows_of("depths.csv")
    lines = [(f"{int(n):,}", mean_ns(rows, n=n, orbit="deep", method="swiftprox")) for n in ("102", "1002", "10002")]
    resting = mean_ns(rows, orbit="resting", method="swiftprox")["resting"]
    return table("vertices", lines + [("a box on a box", {step: resting if step == "0.1" else "" for step in MOTIONS})])


def speed_table():
    rows = rows_of(SPEED)
    columns = [mean_ns(rows, n="1002", orbit="small", method=method) for method in ("swiftprox", "parry-hc", "fcl-1e-6")]
    head = ["| motion per query | swiftprox | parry | FCL |", "|---|--:|--:|--:|"]
    return "\n".join(head + [f"| {name} | " + " | ".join(times[step] for times in columns) + " |" for step, name in MOTIONS.items()])


def commits():
    """Tables and meshes are of the same commit as queries."""
    if commit_of(BUILD) != commit_of(SPEED):
        sys.exit(f"{BUILD} and {SPEED} are of different commits, which docs/benchmarks.md takes for one")
    return f"at {commit_of(SPEED)}", f"the second thread at {commit_of(CROWDS)}"


def check(page, said):
    with open(os.path.join(HERE, "..", page), encoding="utf-8") as file:
        text = file.read()
    missing = [part for part in said if part not in text]
    if missing:
        sys.exit(f"{page} does not say what the CSV files say:\n" + "\n".join(missing))


def main():
    queries = f"<!-- table: queries -->\n{speed_table()}\n<!-- end -->"
    check("docs/benchmarks.md", (queries, *commits(), table_times(), mesh_times(), second_thread()))
    check("docs/compounds.md", (f"at {commit_of(COMPOUNDS)}",))
    check("docs/choosing.md", (f"<!-- table: queries -->\n{query_table()}\n<!-- end -->", f"<!-- table: depths -->\n{depth_table()}\n<!-- end -->"))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Checks that the sentences of README.md that have numbers say what the CSV files of benches/results say. Each is made anew here, and
the page has to have it word for word."""
import os
import sys

from rows import read

HERE = os.path.dirname(os.path.abspath(__file__))


def rows_of(name):
    return read(os.path.join(HERE, "results", name))[1]


def table_times():
    times = [float(row["best_ms"]) for row in rows_of("figures-build.csv") if (row["n"], row["method"]) == ("1002", "table")]
    return f"makes its look-up table: {min(times):.2f} to {max(times):.2f} ms at 1,002 vertices"


def mesh_times():
    def between(n, digits):
        times = [float(row["best_ms"]) for row in rows_of("figures-build.csv") if (row["n"], row["method"]) == (n, "swiftprox-mesh")]
        return f"{min(times):.{digits}f} to {max(times):.{digits}f} ms"

    return f"{between('1002', 1)} at 1,002 vertices, {between('10002', 0)} at 10,002"


def second_thread():
    times = {}
    for row in rows_of("crowds.csv"):
        if row["motion"] == "all" and int(row["count"]) >= 10000:
            times.setdefault((row["bodies"], row["count"], row["query"]), {})[row["method"]] = float(row["mean_ms"])
    saved = [100 * (1 - of["swiftprox-2"] / of["swiftprox"]) for of in times.values() if "swiftprox-2" in of]
    return f"a second thread saves {min(saved):.0f} to {max(saved):.0f} % of a step of 10,000 bodies or more where all move"


def main():
    with open(os.path.join(HERE, "..", "README.md")) as file:
        text = file.read()
    missing = [said for said in (table_times(), mesh_times(), second_thread()) if said not in text]
    if missing:
        sys.exit("README.md does not say what the CSV files say:\n" + "\n".join(missing))


if __name__ == "__main__":
    main()

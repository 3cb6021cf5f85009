"""Rows of the CSV files in benches/results, and what every script does with them."""
import csv
import datetime
import math
import os
import subprocess


def read(path):
    """The head lines of a CSV file, without their "# ", and its rows, whose numbers are floats."""
    with open(path) as file:
        lines = file.read().splitlines()
    head = [line[2:] for line in lines if line.startswith("# ")]
    rows = list(csv.DictReader(line for line in lines if not line.startswith("# ")))
    return head, rows


def with_numbers(rows, names):
    """The rows with those of the named columns that they have as floats, and n as a whole number."""
    for row in rows:
        row.update((name, float(row[name])) for name in row.keys() & set(names))
        if "n" in row:
            row["n"] = int(row["n"])
    return rows


def machine(head):
    """On which machine, of which commit and when was measured, what a CSV file's first line begins with; then how, without the
    compiler's flags."""
    return head.split(", -")[0]


def here():
    """The machine, the commit and the day of now, as the first line of a CSV file has them."""
    with open("/proc/cpuinfo") as info:
        cpu = next((line.split(":")[1].strip() for line in info if line.startswith("model name")), "unknown CPU")
    commit = subprocess.run(["git", "describe", "--always", "--dirty", "--abbrev=7", "--exclude=*"], capture_output=True, text=True,
                            cwd=os.path.dirname(os.path.abspath(__file__))).stdout.strip() or "unknown"
    return f"{cpu}, commit {commit}, {datetime.date.today()}"


def in_order(items):
    return list(dict.fromkeys(items))


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))

#!/usr/bin/env python3
"""Counts the instructions of fixed queries and holds them against committed numbers.

  instructions.py VALGRIND PROGRAM [--bless]

PROGRAM is instructions.c, which calls `measured` for each case it prints. A case fails whose count a query differs from
instructions.csv by more than 5 %, also where it is less: then the better number is to be kept. --bless, or BLESS=1 in the
environment, writes the numbers found instead.

Counts depend on the machine's vector units alone: the numbers are of AVX2, the most that valgrind knows.
Without it, and on other processors than x86-64, nothing is counted.
"""
import csv
import glob
import os
import platform
import re
import subprocess
import sys
import tempfile

QUERIES = 180
TOLERANCE = 0.05
NUMBERS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "instructions.csv")


def has_avx2():
    if platform.machine() != "x86_64" or not os.path.exists("/proc/cpuinfo"):
        return False
    with open("/proc/cpuinfo") as info:
        return re.search(r"^flags\s*:.*\bavx2\b.*\bfma\b|^flags\s*:.*\bfma\b.*\bavx2\b", info.read(), re.M) is not None


def count(valgrind, program):
    """Instructions a query of each case, in order."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "counts")
        command = [valgrind, "--quiet", "--tool=callgrind", "--toggle-collect=measured", "--dump-after=measured",
                   "--callgrind-out-file=" + out, program]
        run = subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True)
        names = run.stdout.splitlines()[:-1]
        totals = []
        for part in range(1, len(names) + 1):
            (path,) = glob.glob(f"{out}.{part}")
            with open(path) as dump:
                totals.append(int(re.search(r"^(?:summary|totals): (\d+)", dump.read(), re.M).group(1)))
    return {name: round(total / QUERIES) for name, total in zip(names, totals)}


def differences(found, expected):
    """A line for each case that differs."""
    for name in sorted(found.keys() ^ expected.keys()):
        yield f"{name}: is in one of the two lists only"
    for name, number in found.items():
        if name in expected and abs(number - expected[name]) > TOLERANCE * expected[name]:
            yield f"{name}: {number} instructions a query, not {expected[name]} ({number / expected[name] - 1:+.0%})"


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--bless"]
    if len(arguments) != 2:
        sys.exit(__doc__)
    if not has_avx2():
        print("no AVX2: nothing is counted")
        return
    found = count(*arguments)
    if len(arguments) < len(sys.argv) - 1 or os.environ.get("BLESS"):
        with open(NUMBERS, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([("case", "instructions"), *found.items()])
        return
    with open(NUMBERS, newline="") as file:
        expected = {row["case"]: int(row["instructions"]) for row in csv.DictReader(file)}
    lines = list(differences(found, expected))
    print("\n".join(lines) or f"{len(found)} cases are within {TOLERANCE:.0%}")
    if lines:
        sys.exit("where that is meant: BLESS=1 ctest --test-dir build -R instructions")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""SWIFT.h beside SWIFT++ and SWIFT 1.x: legacy.py FOLDER, where legacy_bench and legacy_cost are.

The libraries of old are not in this project. Their figures were measured elsewhere: with their own headers, another machine and
programs that do the same kind of work. So they say about how long a step took them, and no ratio here is exact. Instructions do not
depend on the machine, and little on the compiler.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile

# Microseconds a step for pairs, milliseconds for scenes; SWIFT++ and SWIFT 1.x.
CELLS = [
    ("one pair, 1,002 vertices, 0.1°, µs", ["pair", "0.1"], "0.21", "0.20"),
    ("… 1°, µs", ["pair", "1"], "0.30", "0.26"),
    ("… 10°, µs", ["pair", "10"], "0.57", "0.46"),
    ("… 60°, µs", ["pair", "60"], "1.48", "1.10"),
    # The sides of the cube that give about as many pairs a step, 759 and 2,776.
    ("1,000 boxes, few pairs (theirs: 759), ms", ["boxes", "30.1"], "10.7", "6.9"),
    ("1,000 boxes, more pairs (theirs: 2,776), ms", ["boxes", "19.5"], "23.6", "12.8 to 18.7"),
    ("200 boxes, all 19,900 pairs, ms", ["all"], "7.3", "6.5"),
]

# Of the original for one step of a pair of 1,002 vertices, 0.1° a step.
INSTRUCTIONS_OF_OLD = 2057


def instructions(program, steps):
    """All that callgrind counts in so many steps."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "callgrind")
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", program, "pair", "legacy", str(steps), "0.1"]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    bench, cost = (os.path.join(sys.argv[1], name) for name in ("legacy_bench", "legacy_cost"))
    print("| | SWIFT++ | SWIFT 1.x | SWIFT.h | pairs a step |")
    print("|---|--:|--:|--:|--:|")
    for name, arguments, plus_plus, first in CELLS:
        done = subprocess.run([bench, *arguments], capture_output=True, text=True, check=True)
        time, pairs = done.stdout.split()
        print(f"| {name} | {plus_plus} | {first} | {float(time):.2f} | {int(pairs):,} |", flush=True)
    if shutil.which("valgrind") is None:
        print("valgrind is not installed: instructions are not counted")
        return
    # What making the scene takes is in both.
    few, many = (instructions(cost, steps) for steps in (1000, 3000))
    print(f"| one pair, 0.1°, instructions a step | {INSTRUCTIONS_OF_OLD:,} | | {(many - few) / 2000:,.0f} | 1 |")


if __name__ == "__main__":
    main()

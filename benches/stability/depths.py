#!/usr/bin/env python3
"""Asks methods how deep the bodies of every hard case are in each other, and counts how each fails.

  depths.py CASES --csv FILE [--compare FILE] [--methods LIST]

CASES is as in stability.py, and so are runners, but that the program of benches/compare is all of them: compare --depths METHOD A B
POSES, which makes the exact hulls itself. Of a pose a line says one of

  depth DEPTH OVERLAP [LOWER UPPER]   OVERLAP is that along the normal said, computed by the runner from all vertices
  separated
  failed

Poses whose true depth is more than 0 are asked. What is counted, each pose once, the first that holds:

  refused, aborted, timed_out, threw   as in stability.py
  nan        a depth that is not a number
  separated  bodies said to be apart whose depth is more than the tolerance
  depth      a depth that is off by more than the tolerance; of this library an interval that does not hold the true one
  normal     a right depth with a normal along which the bodies overlap by more, by more than the tolerance

The tolerance is 1e-6 L, and the band of stability.py, of this library too. `worst_error` is the worst error of a depth over L.
"""
import argparse
import concurrent.futures
import csv
import math
import os
import sys
from collections import Counter
from decimal import Decimal

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import stability  # noqa: E402
from stability import Judge, Method, cases  # noqa: E402

METHODS = ("swiftprox", "coal-1e-10", "mujoco-1e-10", "jolt-1e-6", "parry-hc", "bullet-1e-4", "libccd-epa-1e-10",
           "libccd-mpr-1e-10", "fcl-1e-10")
COUNTS = ("depth", "normal", "separated", "nan", "threw", "aborted", "timed_out", "refused")


class Overlapping(Judge):
    """The poses of a case whose bodies overlap, and what is true of them."""

    def __init__(self, case):
        super().__init__(case)
        deep = [i for i, truth in enumerate(self.truths) if Decimal(truth[8]) > 0]
        self.poses, self.truths = [self.poses[i] for i in deep], [self.truths[i] for i in deep]

    def fault_of_depth(self, i, words, own):
        """What is wrong with the answer to pose i, or None; and by how much its depth, over L."""
        if words[0] not in ("depth", "separated"):
            return "threw" if words[0] == "failed" else words[0], Decimal(0)
        least, most = Decimal(self.truths[i][8]), Decimal(self.truths[i][9])
        tolerance = Decimal(1e-6) * self.size + self.band(i)
        if words[0] == "separated":
            return "separated" if least > tolerance else None, Decimal(0)
        depth, overlap, *interval = (float(word) for word in words[1:])
        if not math.isfinite(depth):
            return "nan", Decimal(0)
        error = max(least - Decimal(depth), Decimal(depth) - most, Decimal(0))
        missed = own and (Decimal(interval[0]) > most or Decimal(interval[1]) < least)
        if missed or error > tolerance:
            return "depth", error / self.size
        # Of a depth next to nothing any normal will do.
        if least > tolerance and not overlap <= most + tolerance:
            return "normal", error / self.size
        return None, error / self.size


def run_case(method, case, judge, seconds):
    counts, worst = Counter(), Decimal(0)
    answers, _ = stability.ask(method, (case.first, case.second), judge.poses, seconds)
    for i, words in enumerate(answers):
        fault, error = judge.fault_of_depth(i, words, method.own)
        counts.update(["poses"] + [fault] * bool(fault))
        worst = max(worst, error)
    return counts, worst


def run_all(found, methods, seconds, jobs):
    """Counts and the worst error, by family and method."""
    rows = {}
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        waiting = []
        for case in found:
            judge = Overlapping(case)
            if judge.poses:
                waiting += [(case, method, pool.submit(run_case, method, case, judge, seconds)) for method in methods]
        for case, method, future in waiting:
            counts, worst = future.result()
            before = rows.get((case.family, method.name), (Counter(), Decimal(0)))
            rows[case.family, method.name] = (before[0] + counts, max(before[1], worst))
    return rows


def write(path, rows):
    with open(path, "w", newline="") as out:
        out.write(stability.head({}, [])[0] + "\n")
        table = csv.writer(out, lineterminator="\n")
        table.writerow(("family", "method", "poses") + COUNTS + ("worst_error",))
        for (family, method), (counts, worst) in rows.items():
            table.writerow([family, method, counts["poses"]] + [counts[count] for count in COUNTS] + ["%.1e" % worst])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", metavar="CASES")
    parser.add_argument("--csv", metavar="FILE", required=True, help="where the counts go")
    parser.add_argument("--compare", metavar="FILE", default="benches/compare/target/release/compare", help="the runner")
    parser.add_argument("--methods", metavar="LIST", default=",".join(METHODS), help="separated by commas")
    parser.add_argument("--seconds", metavar="S", type=float, default=10, help="the time limit of a pose (10)")
    parser.add_argument("--jobs", metavar="N", type=int, default=os.cpu_count(), help="runners at a time (all processors)")
    arguments = parser.parse_args()
    methods = [Method(name, [arguments.compare, "--depths", name], name == "swiftprox") for name in arguments.methods.split(",")]
    rows = run_all(cases.find_cases(arguments.cases), methods, arguments.seconds, arguments.jobs)
    write(arguments.csv, rows)
    for method in methods:
        total = sum((counts for (_, name), (counts, _) in rows.items() if name == method.name), Counter())
        print("%-16s %s" % (method.name, " ".join("%s %d" % (count, total[count]) for count in ("poses",) + COUNTS)))
    own = [counts for (_, name), (counts, _) in rows.items() if name == "swiftprox"]
    if any(counts[count] for counts in own for count in COUNTS if count != "refused"):
        sys.exit("this library failed")


if __name__ == "__main__":
    main()

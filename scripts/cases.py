#!/usr/bin/env python3
"""Holds swiftprox-query against exact truth: every verdict, every interval, in exact decimals and without any tolerance.

  cases.py TOOL DIR [--query contact|distance|intersection|approximate|depth] [--error E] [--levels ...]
           [--start ...] [--answers OUT] [--timeout SECONDS]

DIR holds folders of one of two forms; both may occur:

  FAMILY/cases.txt                a case a line: A B POSES TRUTH, files in the same folder
  SIZE/ORBIT_STEP.poses           a model against itself: the models are SIZE/MODEL.off,
  SIZE/truth/MODEL_ORBIT_STEP.txt   the truth tells which model met which poses

A truth file has 13 numbers a pose, with more digits than doubles have:
  lo hi  ax ay az  bx by bz  depth_lo depth_hi  nx ny nz
The true distance lies in [lo, hi]; lo > 0: disjoint, else the closed objects have a common point.

The tool runs with --input hull. What is counted, a family a row:

  wrong   verdicts that are not the truth: lower > 0 claims disjoint, distance = lower = upper = 0 intersecting, and
          anything else is wrong
  missed  disjoint pairs whose reported interval does not meet [lo, hi]
  wide    disjoint pairs with upper - lower above the promise: 2e-14 max(r1 + r2, distance), r the largest distance of a
          vertex from the local centre; in families of cases, which are hard, also 1e-13 (L + 2e-3 W) where that is more, L the
          larger bounding-box diagonal and W the largest world coordinate. `width` is the largest as a fraction of that promise,
          less what printing added; of --query approximate E (r1 + r2) where that is more. Not looked at with
          --query intersection
  refused, failed, hung: poses left without an answer by an exit status of 2, another end, or no end in time

With --query depth these are of the depth instead: its true value lies in [depth_lo, depth_hi], a distance of nan claims disjoint,
and an upper end of 0 touching.

Exit status 0 when all of these are 0. With --answers, OUT/FAMILY/CASE.ans is written for judges that read 11 numbers a
pose, dist depth a b n, with n running from A to B, the other way round than the tool's; where the objects penetrate,
points are left out, as the judge knows nearest points alone.
"""
import argparse
import collections
import glob
import math
import os
import subprocess
import sys
from decimal import Decimal

Case = collections.namedtuple("Case", "family name first second poses truth workload")

STATUSES = ("marched", "coherent", "fallback", "exact", "spheres", "tolerance", "narrow", "apart", "stalled")
FAILURES = ("wrong", "missed", "wide", "refused", "failed", "hung")


# ---- what there is to run ----

def find_cases(root):
    found = []
    for folder in sorted(entry.path for entry in os.scandir(root) if entry.is_dir()):
        if os.path.isfile(os.path.join(folder, "cases.txt")):
            found += listed_cases(folder)
        else:
            found += workload_cases(folder)
    return found


def listed_cases(folder):
    cases = []
    with open(os.path.join(folder, "cases.txt")) as lines:
        for line in lines:
            if line.strip():
                first, second, poses, truth = (os.path.join(folder, name) for name in line.split())
                cases.append(Case(os.path.basename(folder), stem(poses), first, second, poses, truth, False))
    return cases


def workload_cases(folder):
    cases = []
    for truth in sorted(glob.glob(os.path.join(folder, "truth", "*_*_*.txt"))):
        model, orbit = stem(truth).split("_", 1)
        mesh = os.path.join(folder, model + ".off")
        poses = os.path.join(folder, orbit + ".poses")
        family = "%s %s" % (os.path.basename(folder), model)
        cases.append(Case(family, orbit, mesh, mesh, poses, truth, True))
    return cases


def stem(path):
    return os.path.splitext(os.path.basename(path))[0]


def read_numbers(path):
    """The lines of a text file as lists of words, without blank lines and comments."""
    with open(path) as lines:
        rows = [line.split() for line in lines]
    return [row for row in rows if row and not row[0].startswith("#")]


def read_off_vertices(path):
    with open(path) as lines:
        words = " ".join(line.split("#")[0] for line in lines).split()
    if words[0] != "OFF":
        sys.exit("%s: not an OFF file" % path)
    count = int(words[1])
    numbers = [float(word) for word in words[4:4 + 3 * count]]
    return [numbers[3 * i:3 * i + 3] for i in range(count)]


# ---- the widths that are promised ----

def diagonal(vertices):
    return math.dist([min(axis) for axis in zip(*vertices)], [max(axis) for axis in zip(*vertices)])


def local_radius(vertices):
    """About the centre that can be subtracted exactly: the middle of a far coordinate range, else 0."""
    centre = []
    for axis in zip(*vertices):
        middle, half = (min(axis) + max(axis)) / 2, (max(axis) - min(axis)) / 2
        centre.append(middle if half <= abs(middle) / 3 else 0.0)
    return max(math.dist(vertex, centre) for vertex in vertices)


def largest_world_coordinate(vertices, pose):
    return max(abs(pose[4 * i] * x + pose[4 * i + 1] * y + pose[4 * i + 2] * z + pose[4 * i + 3])
               for x, y, z in vertices for i in range(3))


class Promise:
    """How wide the interval of a case's pose may be."""

    def __init__(self, case, error=0.0):
        self.workload = case.workload
        self.first = read_off_vertices(case.first)
        self.second = read_off_vertices(case.second)
        self.radii = local_radius(self.first) + local_radius(self.second)
        self.size = max(diagonal(self.first), diagonal(self.second))
        self.error = error * self.radii

    def width(self, pose, distance):
        ordinary = max(2e-14 * max(self.radii, distance), self.error)
        if self.workload:
            return ordinary
        world = max(largest_world_coordinate(self.first, pose[:12]), largest_world_coordinate(self.second, pose[12:]))
        return max(ordinary, 1e-13 * (self.size + 2e-3 * world))


# ---- running and judging ----

class Row:
    """The counts of one family."""

    def __init__(self):
        self.counts = collections.Counter()
        self.widest = 0.0

    def add(self, other):
        self.counts.update(other.counts)
        self.widest = max(self.widest, other.widest)


def run_tool(arguments, case, promise):
    """The answers as lists of words, and what cut them short: None, or one of `refused`, `failed`, `hung`."""
    command = [arguments.tool, case.first, case.second, case.poses, "--input", "hull", "--query", arguments.query]
    if arguments.query != "depth":
        command += ["--levels", arguments.levels, "--start", arguments.start]
    if arguments.query == "approximate":
        command += ["--error", repr(promise.error)]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=arguments.timeout)
    except subprocess.TimeoutExpired as expired:
        lines = (expired.stdout or b"").decode().splitlines()
        return [line.split() for line in lines[:-1]], "hung", "no end within %g s" % arguments.timeout
    answers = [line.split() for line in done.stdout.splitlines()]
    message = done.stderr.strip() or "exit status %d" % done.returncode
    return answers, {0: None, 2: "refused"}.get(done.returncode, "failed"), message


def judge_pose(query, row, answer, truth, pose, promise, complain):
    """Counts one answer of the tool, and complains about what is not as promised."""
    lo, hi = Decimal(truth[0]), Decimal(truth[1])
    distance, lower, upper = (Decimal(answer[i]) for i in (0, 11, 12))
    row.counts[answer[13]] += 1
    disjoint = lo > 0
    if query == "depth":
        lo, hi = Decimal(truth[8]), Decimal(truth[9])
    row.counts["disjoint" if disjoint else "penetrating" if Decimal(truth[8]) > 0 else "touching"] += 1
    if query == "depth":
        claims_disjoint, claims_touching = distance.is_nan(), distance == 0 and upper == 0
        right = claims_disjoint if disjoint else not claims_disjoint and claims_touching == (hi == 0)
    else:
        right = not lower.is_nan() and lower > 0 if disjoint else distance == lower == upper == 0
    if not right:
        row.counts["wrong"] += 1
        complain("wrong: truth [%s, %s], answer %s in [%s, %s] by %s" % (lo, hi, distance, lower, upper, answer[13]))
        return
    if disjoint == (query == "depth"):
        return
    bounded = not upper.is_nan()
    if lower > hi or (bounded and upper < lo):
        row.counts["missed"] += 1
        complain("missed: truth [%s, %s], interval [%s, %s] by %s" % (lo, hi, lower, upper, answer[13]))
    if bounded and promise:
        apart = 0.0 if query == "depth" else float(distance)
        excess = float(upper - lower - printing(lower) - printing(upper))
        # Nothing is promised of two points, and nothing is to be.
        width = excess / promise.width([float(word) for word in pose], apart) if excess > 0 else 0.0
        row.widest = max(row.widest, width)
        if width > 1:
            row.counts["wide"] += 1
            complain("wide: %.3g of the promise, [%s, %s] by %s" % (width, lower, upper, answer[13]))


def printing(bound):
    """How much wider, at most, printing made the interval: bounds are rounded outward to 17 digits."""
    return Decimal(1).scaleb(bound.adjusted() - 16) if bound else Decimal(0)


def judge_case(arguments, case):
    row = Row()
    poses, truths = read_numbers(case.poses), read_numbers(case.truth)
    if len(poses) != len(truths):
        sys.exit("%s: %d lines of truth for %d poses" % (case.truth, len(truths), len(poses)))
    tight = arguments.query != "intersection"
    promise = Promise(case, arguments.error if arguments.query == "approximate" else 0.0)
    answers, cut, message = run_tool(arguments, case, promise)
    if cut is None and len(answers) != len(poses):
        cut, message = "failed", "%d answers" % len(answers)

    def complain(number, what):
        print("%s %s pose %d: %s" % (case.family, case.name, number + 1, what), file=sys.stderr)

    answers = answers[:len(poses)]
    row.counts["poses"] += len(poses)
    for i, (answer, truth, pose) in enumerate(zip(answers, truths, poses)):
        judge_pose(arguments.query, row, answer, truth, pose, promise if tight else None, lambda what, i=i: complain(i, what))
    if cut:
        row.counts[cut] += max(1, len(poses) - len(answers))
        complain(len(answers), "%s: %s" % (cut, message))
    if arguments.answers:
        write_answers(os.path.join(arguments.answers, case.family, case.name + ".ans"), answers, truths)
    return row


def write_answers(path, answers, truths):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as out:
        for answer, truth in zip(answers, truths):
            points = ["nan"] * 6 if Decimal(truth[8]) > 0 else answer[2:8]
            said = answer[:2] + points + [negated(word) for word in answer[8:11]]
            out.write(" ".join(said) + "\n")


def negated(word):
    return word if word == "nan" else word[1:] if word.startswith("-") else "-" + word


# ---- the table ----

def print_table(rows):
    columns = ("poses", "disjoint", "touching", "penetrating") + FAILURES
    print(" ".join(["%-20s" % "family"] + ["%*s" % (len(c) + 1, c) for c in columns] + ["   width"] +
                   ["%9s" % s for s in STATUSES]))
    for family, row in rows:
        print(" ".join(["%-20s" % family] + ["%*d" % (len(c) + 1, row.counts[c]) for c in columns] +
                       ["%8.3f" % row.widest] + ["%9d" % row.counts[s] for s in STATUSES]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool", help="the swiftprox-query to run")
    parser.add_argument("directory", metavar="DIR")
    parser.add_argument("--query", default="contact", choices=("contact", "distance", "intersection", "approximate", "depth"))
    parser.add_argument("--error", metavar="E", type=float, default=0.01, help="of --query approximate, over r1 + r2 (0.01)")
    parser.add_argument("--levels", default="auto", choices=("auto", "none", "quadric", "dk", "outer"))
    parser.add_argument("--start", default="auto", choices=("auto", "cache", "table", "cold"))
    parser.add_argument("--answers", metavar="OUT")
    parser.add_argument("--timeout", metavar="SECONDS", type=float, default=120)
    arguments = parser.parse_args()

    cases = find_cases(arguments.directory)
    if not cases:
        sys.exit("%s: no cases in there" % arguments.directory)
    rows = {}
    for number, case in enumerate(cases):
        if sys.stderr.isatty():
            print("\r\033[K%d of %d: %s %s" % (number + 1, len(cases), case.family, case.name), end="\r", file=sys.stderr)
        rows.setdefault(case.family, Row()).add(judge_case(arguments, case))
    total = Row()
    for row in rows.values():
        total.add(row)
    if sys.stderr.isatty():
        print("\033[K", end="", file=sys.stderr)
    print_table(list(rows.items()) + [("all", total)])
    sys.exit(any(total.counts[failure] for failure in FAILURES))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Runs every method on every hard case and counts how each fails.

  stability.py CASES --csv FILE --cost FILE [--build DIR] [--compare FILE] [--coal PYTHON] [--methods LIST]

CASES holds a folder a family in the form of scripts/cases.py. Each method is a program of its own, a runner, started for
each case; one that crashes or hangs is started again behind the pose that did it. A method whose runner is not there is left
out with a word.

A runner is called with two meshes and a file of poses. This library gets the meshes as they are, the peers their exact hulls as
triangles, whatever the family does to the meshes. It writes a line when it is prepared and one for each pose, at once:

  ready SETTINGS
  separated [DISTANCE [LOWER UPPER MARCHING FALLBACK EXACT NANOSECONDS]]
  intersecting [the same]
  failed

A runner that refuses a body ends with exit status 2 before `ready`. Only this library's says more than the distance.

What is counted, each pose once, the first that holds:

  refused    the method makes no shape of a body
  aborted    the process died: a signal, a failed assertion, a panic
  timed_out  no answer within --seconds (before `ready`: six times as long)
  threw      an exception or a report of failure instead of an answer
  nan        a distance that is not a number
  wrong      a verdict that is not the truth. Peers are forgiven within a band of 1e-12 L + 2e-15 W: L the larger bounding-box
             diagonal (1 for two points), W the largest world coordinate; this library nothing
  missed     this library only: an interval that does not hold the true distance
  off        a distance of a disjoint pair that is off by more than 1e-6 L, a peer's by more than 1e-6 L and the band

`gross` are the wrong ones by more than 1e-6 L, `worst_wrong` how far the worst is from being right (the true distance or depth,
or the distance said of touching bodies), `worst_error` the worst error of a distance; both over L.
"""
import argparse
import collections
import concurrent.futures
import csv
import os
import platform
import select
import statistics
import subprocess
import sys
import tempfile
import time
from decimal import Decimal

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, "..", "..", "scripts"), os.path.join(HERE, "..")]
import cases  # noqa: E402
from rows import here  # noqa: E402

REFUSED = 2  # the exit status of a runner
FAILURES = ("wrong", "off", "missed", "nan", "threw", "aborted", "timed_out")
COUNTS = ("wrong", "gross", "off", "missed", "nan", "threw", "aborted", "timed_out", "refused")
TIERS = ("marched", "fallback", "exact")

Method = collections.namedtuple("Method", "name command own")


def all_methods(build, compare, coal):
    runner = os.path.join(build, "benches", "stability", "run_")
    return [
        Method("swiftprox", [runner + "swiftprox"], True),
        *peers([runner + "libccd"], "libccd-gjk", "libccd-mpr", "libccd-mpr=1e-10"),
        *peers([runner + "fcl"], *(name + tight for name in ("fcl-libccd", "fcl-indep") for tight in ("", "=1e-10"))),
        *peers([compare, "--answers"], "parry", "parry-hull", "parry-hc"),
        *peers([coal, os.path.join(HERE, "run_coal.py")], "coal", "coal=1e-10", "coal-hull=1e-10"),
    ]


def peers(runner, *names):
    return [Method(name, [*runner, name], False) for name in names]


# ---- running ----

class Hulls:
    """The exact hulls of meshes, made once each in a folder of their own."""

    def __init__(self, program, folder):
        self.program, self.folder, self.known = program, folder, {}

    def of(self, mesh):
        if mesh not in self.known:
            self.known[mesh] = os.path.join(self.folder, "%d.off" % len(self.known))
            with open(self.known[mesh], "w") as out:
                subprocess.run([self.program, mesh], stdout=out, check=True)
        return self.known[mesh]


class Runner:
    """One process, read line by line with a time limit."""

    def __init__(self, command):
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.text = b""

    def line(self, seconds):
        """The next line; None at the end; TimeoutError."""
        deadline = time.monotonic() + seconds
        while b"\n" not in self.text:
            ready, _, _ = select.select([self.process.stdout], [], [], max(0.0, deadline - time.monotonic()))
            if not ready:
                raise TimeoutError
            more = os.read(self.process.stdout.fileno(), 1 << 16)
            if not more:
                return None
            self.text += more
        line, self.text = self.text.split(b"\n", 1)
        return line.decode()

    def end(self):
        self.process.kill()
        self.process.stdout.close()
        return self.process.wait()


def ask(method, meshes, poses, seconds):
    """The method's answer to each pose as a list of words, of one word where there is none; and its settings."""
    answers, settings = [], ""
    while len(answers) < len(poses):
        with tempfile.NamedTemporaryFile("w", suffix=".poses") as rest:
            rest.writelines(" ".join(pose) + "\n" for pose in poses[len(answers):])
            rest.flush()
            runner = Runner([*method.command, *meshes, rest.name])
            try:
                settings = read_answers(runner, answers, len(poses), seconds) or settings
            finally:
                runner.end()
    return answers, settings


def read_answers(runner, answers, count, seconds):
    """Appends what a runner says, and what ended it. Returns its settings."""
    try:
        line = runner.line(6 * seconds)
        if line is None:
            status = runner.process.wait()
            if status not in (REFUSED, 101) and status >= 0:
                sys.exit("%s: exit status %d" % (" ".join(runner.process.args), status))
            answers += [["refused" if status == REFUSED else "aborted"]] * (count - len(answers))
            return None
    except TimeoutError:
        answers += [["timed_out"]] * (count - len(answers))
        return None
    if not line.startswith("ready "):
        sys.exit("%s: %s" % (" ".join(runner.process.args), line))
    try:
        while len(answers) < count:
            words = runner.line(seconds)
            answers.append(["aborted"] if words is None else words.split())
            if words is None:
                break
    except TimeoutError:
        answers.append(["timed_out"])
    return line[len("ready "):]


# ---- judging ----

class Judge:
    """What is true of a case."""

    def __init__(self, case):
        self.name = "%s %s" % (case.family, case.name)
        self.poses, self.truths = cases.read_numbers(case.poses), cases.read_numbers(case.truth)
        if len(self.poses) != len(self.truths):
            sys.exit("%s: %d lines of truth for %d poses" % (case.truth, len(self.truths), len(self.poses)))
        self.promise = cases.Promise(case)
        self.size = Decimal(self.promise.size) or Decimal(1)

    def band(self, i):
        pose = [float(word) for word in self.poses[i]]
        bodies = ((self.promise.first, pose[:12]), (self.promise.second, pose[12:]))
        world = max(cases.largest_world_coordinate(vertices, at) for vertices, at in bodies)
        return Decimal(1e-12) * self.size + Decimal(2e-15) * Decimal(world)

    def fault(self, i, words, own):
        """What is wrong with the answer to pose i, or None; by how much the verdict, the distance is wrong, over L."""
        if words[0] not in ("separated", "intersecting"):
            return "threw" if words[0] == "failed" else words[0], 0, 0
        separated = words[0] == "separated"
        said = Decimal(float(words[1])) if len(words) > 1 else None
        if separated and said is not None and said.is_nan():
            return "nan", 0, 0
        lo, hi, depth = (Decimal(self.truths[i][k]) for k in (0, 1, 8))
        disjoint = lo > 0
        if separated != disjoint:
            miss = lo if disjoint else depth or said or Decimal(0)
            if own or miss > self.band(i):
                return "wrong", miss / self.size, 0
            return None, 0, 0
        missed = own and self.interval_fault(i, words)
        if missed:
            return missed, 0, 0
        if not disjoint or said is None:
            return None, 0, 0
        error = max(lo - said, said - hi, Decimal(0))
        off = error > Decimal(1e-6) * self.size and (own or error > Decimal(1e-6) * self.size + self.band(i))
        return "off" if off else None, 0, error / self.size

    def interval_fault(self, i, words):
        """Holds the interval of this library against the truth as scripts/cases.py does."""
        row = cases.Row()
        distance, lower, upper = (Decimal(float(word)) for word in words[1:4])
        if any(number.is_nan() for number in (distance, lower, upper)):
            return "nan"
        cases.judge_pose("distance", row, [distance] + ["nan"] * 10 + [lower, upper, ""], self.truths[i], self.poses[i], None,
                         lambda what: print("%s pose %d: %s" % (self.name, i + 1, what), file=sys.stderr))
        return next((fault for fault in ("wrong", "missed") if row.counts[fault]), None)


# ---- counting ----

class Row:
    """One method on one family."""

    def __init__(self):
        self.counts = collections.Counter()
        self.worst_wrong = self.worst_error = Decimal(0)
        self.costs = []  # of this library: tier, steps, nanoseconds
        self.settings = ""

    def add(self, other):
        self.counts.update(other.counts)
        self.worst_wrong = max(self.worst_wrong, other.worst_wrong)
        self.worst_error = max(self.worst_error, other.worst_error)
        self.costs += other.costs
        self.settings = self.settings or other.settings


def run_case(method, meshes, judge, seconds):
    row = Row()
    answers, row.settings = ask(method, meshes, judge.poses, seconds)
    for i, words in enumerate(answers):
        fault, miss, error = judge.fault(i, words, method.own)
        row.counts.update(["poses"] + [fault] * bool(fault) + ["gross"] * (miss > Decimal(1e-6)))
        row.worst_wrong, row.worst_error = max(row.worst_wrong, miss), max(row.worst_error, error)
        if method.own and len(words) == 8:
            marching, fallback, exact, nanoseconds = (int(word) for word in words[4:])
            row.costs.append((TIERS[2 if exact else 1 if fallback else 0], marching + fallback + exact, nanoseconds))
    return row


def run_all(found, methods, exact_hull, seconds, jobs):
    """Rows by family and method."""
    rows = {}
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        hulls, waiting = Hulls(exact_hull, folder), []
        for case in found:
            judge, hulled = Judge(case), (hulls.of(case.first), hulls.of(case.second))
            for method in methods:
                rows.setdefault((case.family, method.name), Row())
                meshes = (case.first, case.second) if method.own else hulled
                waiting.append((case, method, pool.submit(run_case, method, meshes, judge, seconds)))
        for done, (case, method, future) in enumerate(waiting):
            rows[case.family, method.name].add(future.result())
            if sys.stderr.isatty():
                print("\r\033[K%d of %d: %s %s" % (done + 1, len(waiting), case.family, method.name), end="\r", file=sys.stderr)
    return rows


# ---- results ----

def head(rows, methods):
    """What was run where, as comments."""
    lines = ["# %s, %s" % (here(), platform.platform())]
    for method in methods:
        said = (row.settings for (_, name), row in rows.items() if name == method.name and row.settings)
        lines.append("# %s: %s" % (method.name, next(said, "no settings said")))
    return lines


def write_counts(path, rows, methods):
    with open(path, "w", newline="") as out:
        out.write("\n".join(head(rows, methods)) + "\n")
        table = csv.writer(out, lineterminator="\n")
        table.writerow(("family", "method", "poses") + COUNTS + ("worst_wrong", "worst_error"))
        for (family, method), row in rows.items():
            table.writerow([family, method, row.counts["poses"]] + [row.counts[count] for count in COUNTS] +
                           ["%.1e" % row.worst_wrong, "%.1e" % row.worst_error])


def write_costs(path, rows):
    with open(path, "w", newline="") as out:
        table = csv.writer(out, lineterminator="\n")
        table.writerow(("family", "tier", "answers", "median_ns", "worst_ns", "worst_steps"))
        for (family, _), row in rows.items():
            for tier in TIERS:
                steps, times = [[cost[k] for cost in row.costs if cost[0] == tier] for k in (1, 2)]
                if times:
                    table.writerow([family, tier, len(times), round(statistics.median(times)), max(times), max(steps)])


def print_table(rows, methods):
    """The failures of each method, a family a row; behind a plus what it refused."""
    print(" ".join(["%-16s %6s" % ("family", "poses")] + ["%12s" % method.name for method in methods]))
    for family in dict.fromkeys(family for family, _ in rows):
        here = [rows[family, method.name].counts for method in methods]
        cells = ["%d%s" % (sum(c[f] for f in FAILURES), "+%d" % c["refused"] if c["refused"] else "") for c in here]
        print(" ".join(["%-16s %6d" % (family, here[0]["poses"])] + ["%12s" % cell for cell in cells]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", metavar="CASES")
    parser.add_argument("--csv", metavar="FILE", required=True, help="where the counts go")
    parser.add_argument("--cost", metavar="FILE", required=True, help="where the tiers and times of this library go")
    parser.add_argument("--build", metavar="DIR", default="build", help="where CMake built the runners (build)")
    parser.add_argument("--compare", metavar="FILE", default="benches/compare/target/release/compare", help="parry's runner")
    parser.add_argument("--coal", metavar="PYTHON", default="build/peers/bin/python", help="a Python that has coal")
    parser.add_argument("--methods", metavar="LIST", help="only these, separated by commas")
    parser.add_argument("--seconds", metavar="S", type=float, default=10, help="the time limit of a pose (10)")
    parser.add_argument("--jobs", metavar="N", type=int, default=os.cpu_count(), help="runners at a time (all processors)")
    arguments = parser.parse_args()

    methods = all_methods(arguments.build, arguments.compare, arguments.coal)
    if arguments.methods:
        methods = [method for method in methods if method.name in arguments.methods.split(",")]
    for method in [method for method in methods if not os.path.exists(method.command[0])]:
        print("%s: %s is not there: left out" % (method.name, method.command[0]), file=sys.stderr)
        methods.remove(method)
    exact_hull = os.path.join(arguments.build, "benches", "stability", "exact_hull")
    rows = run_all(cases.find_cases(arguments.cases), methods, exact_hull, arguments.seconds, arguments.jobs)
    write_counts(arguments.csv, rows, methods)
    write_costs(arguments.cost, rows)
    print_table(rows, methods)
    if any(row.counts[failure] for (_, name), row in rows.items() for failure in FAILURES if name == "swiftprox"):
        sys.exit("this library failed")


if __name__ == "__main__":
    main()

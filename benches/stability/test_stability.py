#!/usr/bin/env python3
"""Tests stability.py and report.py:  test_stability.py BUILD

A runner that fails in every way there is gets every failure counted; the runners that are built answer two tiny families
without any; and the committed chart and page are what the committed CSV files say.
"""
import contextlib
import csv
import glob
import io
import os
import re
import subprocess
import sys
import tempfile
import textwrap
import unittest
from decimal import Decimal

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
sys.path.insert(0, HERE)
import report  # noqa: E402
import stability  # noqa: E402
from stability import Method, cases  # noqa: E402

BUILD = sys.argv.pop(1)
CUBE = "OFF\n8 0 0\n" + "".join("%d %d %d\n" % (k & 1, k >> 1 & 1, k >> 2) for k in range(8))  # L is the root of 3
HAIR = str(Decimal(2**-43))  # about 1e-13: a gap that peers need not see


def poses(*gaps):
    here = "1 0 0 %s 0 1 0 0 0 0 1 0"
    return "".join(here % 0 + " " + here % (1 + float(gap)) + "\n" for gap in gaps)


def truth(gap, depth="0"):
    return " ".join([gap, gap] + ["0"] * 6 + [depth, depth, "1 0 0"]) + "\n"


class Families(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        for family, gaps, truths in (
                ("apart", ("1", "0.5", "0.25", "2"), [truth("1"), truth("0.5"), truth("0.25"), truth("2")]),
                ("meeting", ("0", "-0.5"), [truth("0"), truth("0", "0.5")])):
            os.mkdir(os.path.join(self.folder.name, family))
            self.write(family + "/cube.off", CUBE)
            self.write(family + "/c0.poses", poses(*gaps))
            self.write(family + "/c0.truth", "".join(truths))
            self.write(family + "/cases.txt", "cube.off cube.off c0.poses c0.truth\n")

    def write(self, name, text):
        with open(os.path.join(self.folder.name, name), "w") as out:
            out.write(text)

    def run_methods(self, methods, seconds=5.0):
        exact_hull = os.path.join(BUILD, "benches", "stability", "exact_hull")
        return stability.run_all(cases.find_cases(self.folder.name), methods, exact_hull, seconds, 2)

    def fake(self, said, own=False, prepare=""):
        """A method that says, by the gap of a pose, one of several things, or runs it as code."""
        self.write("fake.py", "import os, sys, time\nsaid = %r\n%s\nprint('ready fake', flush=True)\n" % (said, prepare) +
                   textwrap.dedent("""\
                       for line in open(sys.argv[3]):
                           what = said['%g' % (float(line.split()[15]) - 1)]
                           if what.endswith(')'):
                               exec(what)
                           print(what, flush=True)
                       """))
        return Method("fake", [sys.executable, os.path.join(self.folder.name, "fake.py")], own)

    def counts(self, said, seconds=5.0, **how):
        rows = self.run_methods([self.fake(said, **how)], seconds)
        total = stability.Row()
        for row in rows.values():
            total.add(row)
        return {name: number for name, number in total.counts.items() if number and name != "poses"}, total

    RIGHT = {"1": "separated 1", "0.5": "separated 0.5", "0.25": "separated 0.25", "2": "separated 2", "0": "intersecting",
             "-0.5": "intersecting"}

    def test_right_answers_are_no_failures(self):
        self.assertEqual(self.counts(self.RIGHT)[0], {})
        self.assertEqual(self.counts({**self.RIGHT, "1": "separated"})[0], {})

    def test_every_failure_is_counted_and_the_run_goes_on_behind_it(self):
        said = {"1": "os.abort()", "0.5": "separated nan", "0.25": "separated 0.2500005", "2": "time.sleep(60)", "0": "failed",
                "-0.5": "separated 0.5"}
        counts, total = self.counts(said, seconds=2.0)
        self.assertEqual(counts, {"aborted": 1, "nan": 1, "timed_out": 1, "threw": 1, "wrong": 1, "gross": 1})
        self.assertAlmostEqual(float(total.worst_wrong), 0.5 / 3**0.5)
        self.assertEqual(self.counts({**self.RIGHT, "0.25": "separated 0.250002"})[0], {"off": 1})

    def test_a_refusal_is_no_failure_but_a_crash_before_the_first_answer_is(self):
        self.assertEqual(self.counts(self.RIGHT, prepare="sys.exit(2)")[0], {"refused": 6})
        self.assertEqual(self.counts(self.RIGHT, prepare="os.abort()")[0], {"aborted": 6})

    def test_peers_have_the_band_and_this_library_has_none(self):
        self.write("apart/c0.truth", truth(HAIR) + truth("0.5") + truth("0.25") + truth("2"))
        blind = {**self.RIGHT, "1": "intersecting"}
        self.assertEqual(self.counts(blind)[0], {})
        own = {gap: "separated %s %s %s 1 0 0 100" % (gap, gap, gap) if answer.startswith("separated")
               else "intersecting 0 0 0 1 0 0 100" for gap, answer in blind.items()}
        self.assertEqual(self.counts(own, own=True)[0], {"wrong": 1})
        missed = {**own, "1": "separated %s %s %s 1 0 0 100" % (HAIR, HAIR, HAIR), "2": "separated 2 2.5 2.5 1 0 0 100"}
        with contextlib.redirect_stderr(io.StringIO()) as complaint:
            self.assertEqual(self.counts(missed, own=True)[0], {"missed": 1})
        self.assertIn("apart c0 pose 4: missed", complaint.getvalue())
        self.assertEqual(self.counts({**own, "2": "separated 2 2 nan 1 0 0 100"}, own=True)[0], {"wrong": 1, "nan": 1})

    def test_the_runners_that_are_built_answer_easy_poses(self):
        methods = [method for method in stability.all_methods(BUILD, "", "") if os.path.exists(method.command[0])]
        self.assertIn("swiftprox", [method.name for method in methods])
        rows = self.run_methods(methods)
        for key, row in rows.items():
            counts = {name: number for name, number in row.counts.items() if number}
            self.assertEqual(counts, {"poses": 4 if key[0] == "apart" else 2}, key)
        self.assertEqual(len(rows["apart", "swiftprox"].costs), 4)
        counts_csv, cost = (os.path.join(self.folder.name, name) for name in ("counts.csv", "cost.csv"))
        stability.write_counts(counts_csv, rows, methods)
        stability.write_costs(cost, rows)
        head, counts, costs = report.read_both(counts_csv, cost)
        page = report.page("<!-- table: totals -->\n<!-- end -->\n<!-- table: cost -->\n<!-- end -->\n", counts, costs)
        self.assertIn("| `swiftprox` | 0 |", page)
        self.assertIn("| apart | 4 |", page)
        lines = report.chart(head, counts).lines
        self.assertEqual([(line.label, line.cells[0].text, line.last) for line in lines], [("apart", "0", "4"), ("meeting", "0", "2"), ("all", "0", "6")])

    def test_the_committed_chart_and_page_say_what_the_csv_says(self):
        made = [os.path.join(ROOT, *path.split("/")) for path in
                ("benches/results/stability.csv", "benches/results/stability-cost.csv", "docs/charts/failures.svg", "docs/stability.md")]
        subprocess.run([sys.executable, os.path.join(HERE, "report.py"), *made, "--check"], check=True)

    def test_the_committed_counts_are_of_all_families_and_this_library_failed_in_none(self):
        sources = glob.glob(os.path.join(ROOT, "testkit", "src", "hard", "*.rs"))
        families = {name for path in sources for name in re.findall(r'^ *name: "(\w+)",$', open(path).read(), re.M)}
        with open(os.path.join(ROOT, "benches", "results", "stability.csv")) as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        ours = [row for row in rows if row["method"] == "swiftprox"]
        self.assertEqual({row["family"] for row in ours}, families)
        for row in ours:
            self.assertEqual([row[failure] for failure in stability.FAILURES], ["0"] * len(stability.FAILURES), row["family"])


if __name__ == "__main__":
    unittest.main()

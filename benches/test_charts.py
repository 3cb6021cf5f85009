#!/usr/bin/env python3
"""Tests charts.py, and what plot.py makes of CSV files: a drawn chart that is not that of its data is found out without matplotlib.

The same bytes from the same data, and the same as those committed, are asserted where this Python has the matplotlib that drew
those; elsewhere these tests are left out and say so.
"""
import glob
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import charts  # noqa: E402
import plot  # noqa: E402
from charts import Kind  # noqa: E402

SPEED = os.path.join(charts.FOLDER, "speed-1002.svg")


def version_here():
    try:
        import matplotlib
    except ImportError:
        return None
    return matplotlib.__version__


def version_of(path):
    with open(path) as file:
        return re.search(r"Matplotlib v([\d.]+)", file.read())[1]


class Drawn(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.path = os.path.join(self.folder, "speed-1002.svg")
        shutil.copy(SPEED, self.path)
        self.csv = os.path.join(plot.RESULTS, charts.source(SPEED)[0])
        self.chart = plot.made_of(self.csv)["speed-1002"]

    def change(self, path, old, new):
        with open(path) as file:
            text = file.read()
        self.assertIn(old, text)
        with open(path, "w") as file:
            file.write(text.replace(old, new, 1))

    def assert_refused(self, chart, reason):
        with self.assertRaisesRegex(SystemExit, reason):
            charts.check(self.path, chart)

    def test_a_committed_chart_is_that_of_the_csv_it_names(self):
        charts.check(self.path, self.chart)

    def test_another_number_in_the_csv_is_found_out(self):
        csv = os.path.join(self.folder, "other.csv")
        shutil.copy(self.csv, csv)
        with open(csv) as file:
            first = file.read().splitlines()[2].split(",")
        self.change(csv, ",".join(first[:7]), ",".join(first[:6] + [str(float(first[6]) * 1.01)]))
        self.assert_refused(plot.made_of(csv)["speed-1002"], "does not show")

    def test_a_chart_that_was_edited_is_found_out(self):
        self.change(self.path, ' y="', ' y="1')
        self.assert_refused(self.chart, "was changed")

    def test_a_chart_without_digests_and_one_that_is_missing_are_refused(self):
        self.change(self.path, "sha256:", "")
        self.assert_refused(self.chart, "does not show")
        os.remove(self.path)
        self.assert_refused(self.chart, "is missing")

    def test_every_committed_chart_is_text_and_says_what_drew_it_of_what_measured_where_and_when(self):
        committed = glob.glob(os.path.join(charts.FOLDER, "*.svg"))
        self.assertTrue(committed)
        for path in committed:
            self.assertTrue(charts.source(path), path)
            self.assertTrue(version_of(path), path)
            self.assertLess(os.path.getsize(path), 100_000, path)
            with open(path) as file:
                self.assertRegex(file.read(), r">[^<>,]+, commit [0-9a-f]{7}, \d{4}-\d\d-\d\d\b", path)

    @unittest.skipUnless(version_here() == version_of(SPEED), f"charts are drawn by matplotlib {version_of(SPEED)}, here is {version_here()}")
    def test_the_same_data_gives_the_same_bytes(self):
        subprocess.run([sys.executable, os.path.join(HERE, "plot.py"), self.csv, self.folder], check=True, stdout=subprocess.DEVNULL,
                       env=dict(os.environ, PYTHONHASHSEED="1"))
        for name in ("speed-1002.svg", "accuracy-1002.svg"):
            with open(os.path.join(self.folder, name), "rb") as drawn, open(os.path.join(charts.FOLDER, name), "rb") as committed:
                self.assertEqual(drawn.read(), committed.read(), name)


class Errors(unittest.TestCase):
    @staticmethod
    def row(method, error, width=math.nan, model="fat"):
        return {"model": model, "method": method, "worst_error": error, "worst_width": width, "best_ns": 100.0}

    def test_our_own_error_is_seen_from_the_closest_other_library_of_each_scene(self):
        rows = [self.row("swiftprox", 0.0, 4e-14), self.row("parry", 1e-7), self.row("fcl", 2e-15),
                self.row("swiftprox", 0.0, 4e-14, "long"), self.row("parry", 3e-15, model="long"), self.row("fcl", 1e-3, model="long")]
        self.assertEqual(plot.worst_errors(rows), {"swiftprox": 3e-15, "parry": 1e-7, "fcl": 1e-3})

    def test_nothing_is_seen_of_it_without_another_library_or_where_nothing_separates(self):
        self.assertEqual(plot.worst_errors([self.row("swiftprox", 0.0, 4e-14)]), {})
        self.assertEqual(plot.worst_errors([self.row("swiftprox", math.nan, 4e-14), self.row("parry", math.nan)]), {})

    def test_dot_and_ring_are_drawn_and_tied(self):
        rows = [self.row("swiftprox", 0.0, 4e-14), self.row("fcl", 2e-15)]
        curves = plot.accuracy_curves({"swiftprox": None, "fcl": None}, rows)
        self.assertEqual([(curve.series, curve.kind, [x for x, _ in curve.points]) for curve in curves],
                         [("fcl", Kind.DOTS, [2e-15]), ("swiftprox", Kind.LINE, [2e-15, 4e-14]), ("swiftprox", Kind.RINGS, [4e-14]),
                          ("swiftprox", Kind.DOTS, [2e-15])])


class Axes(unittest.TestCase):
    def test_values_stand_between_round_ones_and_have_their_unit(self):
        axis = charts.value_axis("time", [70.0, 3000.0], charts.duration)
        self.assertEqual([label for _, label in axis.ticks], ["50 ns", "100 ns", "200 ns", "500 ns", "1 µs", "2 µs", "5 µs"])
        axis = charts.value_axis("steps", [3.0, 120000.0], charts.count)
        self.assertEqual([label for _, label in axis.ticks], ["10", "100", "1k", "10k", "100k"])

    def test_random_poses_stand_apart_behind_the_degrees(self):
        axis, place = charts.motion_axis(["0.1", "90", "random"])
        self.assertEqual([label for _, label in axis.ticks], ["0.1°", "90°", "random"])
        self.assertTrue(axis.low < 0.1 and 180 < place["random"] < axis.high)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Tests what bodies.py makes of a CSV file of compare --bodies."""
import math
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bodies  # noqa: E402


def row(method, time, body="box", step="1", query="distance", family="cad", error=1e-9, widest=math.nan, form="turned"):
    return {"query": query, "family": family, "body": body, "form": form, "orbit": bodies.QUERIES[query], "step": step,
            "method": method, "best_ns": float(time), "worst_error": error, "widest": widest, "n1": 8.0,
            "judged": 12.0, "wrong": 0.0, "missed": 0.0}


class Ways(unittest.TestCase):
    def test_tolerances_of_a_way_share_its_mark(self):
        for method, wanted in (("coal-1e-10", "coal"), ("swiftprox", "swiftprox"), ("swiftprox-1e-2", "swiftprox"),
                               ("swiftprox-levels", "swiftprox-levels"), ("swiftprox-levels-1e-1", "swiftprox-levels"),
                               ("fcl-1e-6", "fcl"), ("fcl-indep-1e-6", "fcl-indep"), ("parry-hc", "parry-hc")):
            self.assertEqual(bodies.way(method), wanted)


class Accuracy(unittest.TestCase):
    def test_our_own_mark_stands_at_the_widest_interval_and_others_at_the_worst_error(self):
        rows = [row("any", 100, error=1e-9, widest=1e-3), row("any", 400, error=1e-8, widest=1e-4)]
        self.assertEqual(bodies.mark(rows, True)[0], 1e-3)
        error, time = bodies.mark(rows, False)
        self.assertEqual(error, 1e-8)
        self.assertAlmostEqual(time, 200)

    def test_an_error_of_nothing_stands_at_the_place_of_rounding(self):
        self.assertEqual(bodies.mark([row("any", 1, error=0.0)], False)[0], bodies.LEAST_ERROR)
        self.assertEqual(bodies.mark([row("any", 1, error=math.nan)], False)[0], bodies.LEAST_ERROR)

    def test_the_front_leaves_out_what_is_beaten(self):
        corners = bodies.front([(1e-3, 50.0), (1e-9, 100.0), (1e-6, 200.0), (1e-2, 60.0)])
        self.assertEqual(corners, [(1e-9, 100.0), (1e-3, 100.0), (1e-3, 50.0), (bodies.ERRORS.high, 50.0)])


class Ratios(unittest.TestCase):
    def test_the_quickest_other_library_counts_body_by_body(self):
        rows = [row("swiftprox", 100), row("parry-hc", 500), row("coal-1e-10", 300), row("swiftprox", 10, body="disc"),
                row("parry-hc", 5, body="disc"), row("parry-hc", 1, body="alone")]
        self.assertEqual(sorted(bodies.ratios(rows, "1")), [0.5, 3.0])
        self.assertEqual(bodies.ratios(rows, "10"), [])

    def test_other_orbits_and_tolerances_are_no_part_of_it(self):
        kept, loose, deep = row("coal-1e-10", 1), row("coal-1e-1", 1), row("parry-hc", 1)
        deep["orbit"] = "deep"
        self.assertEqual(bodies.strongest([kept, loose, deep]), [kept])

    def test_where_others_are_quicker_the_colour_is_another(self):
        self.assertEqual([bodies.band(ratio) for ratio in (8, 1, 0.99, 0.1)],
                         [bodies.BANDS[0][1], bodies.BANDS[3][1], bodies.BANDS[4][1], bodies.BANDS[5][1]])

    def test_the_least_ratios_are_named_with_form_and_motion(self):
        rows = [each for query in bodies.QUERIES for each in (
            row("swiftprox", 100, query=query), row("parry-hc", 150, query=query),
            row("swiftprox", 100, query=query, step="10"), row("parry-hc", 80, query=query, step="10", form="turned"))]
        self.assertIn("| depth | box turned, 10°: 0.80 |", bodies.weak_table(rows))


class Instructions(unittest.TestCase):
    HEAD = "# any, commit abc, 2026-01-01, how\nquery,family,body,form,step,swiftprox,parry-hc,coal-1e-10\n"

    def counts(self, lines):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "counts.csv")
            with open(path, "w") as file:
                file.write(self.HEAD + lines)
            return bodies.counts_of(path)

    def test_what_was_not_asked_is_no_row(self):
        found = self.counts("distance,cad,box,turned,1,100,700,\n")
        self.assertEqual([(row["method"], row["instructions"]) for row in found], [("swiftprox", 100.0), ("parry-hc", 700.0)])

    def test_a_family_has_its_means_and_the_library_that_takes_the_fewest(self):
        lines = "".join(f"{query},{family},{body},turned,{step},{own},{parry},{coal}\n" for query in bodies.QUERIES for family in bodies.FAMILIES
                        for step in bodies.STEPS for body, own, parry, coal in (("box", 100, 200, 300), ("disc", 400, 9000, 3200)))
        self.assertIn("| depth | CAD-like bodies | 200 (4.0) | 200 (4.0) | 200 (4.0) | 200 (4.0) |", bodies.instruction_table(self.counts(lines)))


class Pages(unittest.TestCase):
    def test_a_table_is_made_anew_and_one_that_is_missing_is_refused(self):
        page = "before\n<!-- table: a -->\nold\n<!-- end -->\n<!-- table: b -->\nkept\n<!-- end -->\n"
        made = bodies.with_tables(page, {"a": "new"})
        self.assertEqual(made, page.replace("old", "new"))
        with self.assertRaises(SystemExit):
            bodies.with_tables(page, {"c": "new"})

    def test_every_chart_is_made_of_the_committed_rows(self):
        if not os.path.exists(bodies.RESULTS):
            self.skipTest("no benches/results/bodies.csv")
        self.assertEqual(len(bodies.made_of(*bodies.numbers_of(bodies.RESULTS))), 6)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Tests swiftprox-query from outside, and scripts/cases.py, which judges it:  test_query.py TOOL"""
import math
import os
import pty
import re
import subprocess
import sys
import tempfile
import threading
import unittest
from decimal import Decimal, getcontext

getcontext().prec = 40
TOOL = sys.argv.pop(1)
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
BOX = os.path.join(ROOT, "examples", "models", "box.off")  # half sides 0.8, 0.5, 0.3
PRISM = os.path.join(ROOT, "examples", "models", "prism.obj")
SPHERE = os.path.join(ROOT, "examples", "models", "sphere.stl")


def pose(x, y, z):
    return "1 0 0 %s 0 1 0 %s 0 0 1 %s" % (x, y, z)


HERE = pose(0, 0, 0)
APART = HERE + " " + pose(2, 0, 0)
DIAGONAL = HERE + " " + pose("2.6", "2", 0)  # 1 along x and 1 along y, not quite: 2.6 and 0.8 are rounded
INTERSECTING = HERE + " " + pose(0.5, 0.5, 0)


class Query(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name, content):
        path = os.path.join(self.folder.name, name)
        with open(path, "wb") as out:
            out.write(content if isinstance(content, bytes) else content.encode())
        return path

    def run_tool(self, *arguments, stdin=None):
        return subprocess.run([TOOL, *arguments], input=stdin, capture_output=True, text=True, timeout=60)

    def answers(self, poses, *options, meshes=(BOX, BOX)):
        done = self.run_tool(*meshes, self.file("poses", poses), *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        rows = [line.split() for line in done.stdout.splitlines()]
        for row in rows:
            self.assertEqual(len(row), 15)
            self.assertIn(row[13], ("marched", "coherent", "fallback", "exact", "spheres", "tolerance", "narrow", "apart"))
            self.assertGreaterEqual(int(row[14]), 0)
        return rows

    def test_the_tolerance_of_pairs(self):
        """The boxes are 0.4 and 3.4 apart; of those beyond the tolerance a lower bound is told, and that it is beyond."""
        poses = "".join(HERE + " " + pose(x, 0, 0) + "\n" for x in (2, 5))
        for query in ("contact", "distance", "intersection", "approximate"):
            near, far = self.answers(poses, "--query", query, "--max-distance", "1")
            self.assertTrue(float(near[11]) <= 0.4 and float(near[12]) <= 1, near)
            self.assertTrue(1 < float(far[11]) <= 3.4 and far[12] == "inf" and far[2] == "nan", far)
            self.assertEqual(self.answers(poses, "--query", query, "--max-distance", "inf"), self.answers(poses, "--query", query))

    def test_casts_tell_when_objects_first_touch(self):
        lines = [" ".join((HERE, pose(4, 0, 0), HERE, pose(x, y, 0))) for x, y in (("0", "0"), ("5", "0"), ("-4", "4"))]
        motions = self.file("motions", "\n".join(lines) + "\n")
        done = self.run_tool(BOX, BOX, motions, "--query", "cast", "--time-tolerance", "1e-6")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        hit, free, passing = [line.split() for line in done.stdout.splitlines()]
        self.assertEqual((hit[0], free[0], passing[0]), ("hit", "free", "free"))
        # The boxes' sides are 1.6 long along x: B touches A where it is that far.
        self.assertTrue(Decimal(hit[1]) <= Decimal("0.6") <= Decimal(hit[2]) <= Decimal(hit[1]) + Decimal("1.01e-6"), hit)
        self.assertEqual(hit[3:5], ["nan", "0"])
        self.assertEqual((free[1], free[2], free[4]), ("1", "nan", "nan"))
        self.assertTrue(2 < float(free[3]) <= 2.4, free)
        self.assertGreater(int(hit[5]), 0)
        done = self.run_tool(BOX, BOX, motions, "--query", "cast", "--max-distance", "2.5")
        self.assertEqual([line.split()[0] for line in done.stdout.splitlines()], ["hit", "hit", "hit"])
        done = self.run_tool(BOX, BOX, motions, "--query", "cast", "--bench", "2")
        self.assertRegex(done.stdout, r"^[0-9.e+]+ [0-9.e+]+\n$")
        self.refused(2, "poses:1", BOX, BOX, self.file("poses", APART + "\n"), "--query", "cast")

    def refused(self, status, message, *arguments):
        done = self.run_tool(*arguments)
        self.assertEqual(done.returncode, status)
        self.assertIn(message, done.stderr)
        self.assertEqual(done.stdout, "")

    # -- answers --

    def test_a_separated_pair(self):
        row = self.answers(APART)[0]
        # The boxes end at the double next to 0.8.
        true = 2 - 2 * Decimal(0.8)
        self.assertLessEqual(Decimal(row[11]), true)
        self.assertLessEqual(true, Decimal(row[12]))
        self.assertAlmostEqual(float(row[0]), 0.4)
        self.assertEqual(float(row[2]), 0.8)
        self.assertEqual(float(row[5]), 1.2)
        self.assertEqual([float(x) for x in row[8:11]], [-1, 0, 0])

    def test_printed_bounds_hold_as_decimals(self):
        row = self.answers(DIAGONAL)[0]
        along_x = Decimal(2.6) - 2 * Decimal(0.8)
        true = (along_x * along_x + 1).sqrt()
        self.assertLessEqual(Decimal(row[11]), true)
        self.assertLessEqual(true, Decimal(row[12]))
        self.assertLess(Decimal(row[12]) - Decimal(row[11]), Decimal("1e-13"))

    def test_an_intersecting_pair(self):
        for query in ("contact", "distance", "intersection"):
            row = self.answers(INTERSECTING, "--query", query)[0]
            self.assertEqual([row[0], row[11], row[12]], ["0", "0", "0"])
            self.assertEqual(row[1] == "nan", query != "contact")

    def test_a_contact_has_points_and_a_normal(self):
        row = [float(x) for x in self.answers(INTERSECTING)[0][2:11]]
        self.assertAlmostEqual(sum(x * x for x in row[6:]), 1.0)

    def test_a_contact_says_how_deep_it_is(self):
        deep = [float(x) for x in self.answers(INTERSECTING, "--query", "depth")[0][:13]]
        distance, depth, a, b, n, lower, upper = deep[0], deep[1], deep[2:5], deep[5:8], deep[8:11], deep[11], deep[12]
        self.assertEqual(distance, 0)
        self.assertTrue(0 < lower <= depth <= upper < lower + 1e-13)
        for i in range(3):
            self.assertAlmostEqual(b[i] - a[i], depth * n[i], places=13)
        row = [float(x) for x in self.answers(INTERSECTING)[0][:13]]
        self.assertEqual(row[1:11], deep[1:11])
        self.assertEqual(row[11:], [0, 0])
        apart = self.answers(APART, "--query", "depth")[0]
        self.assertEqual(apart[:2] + apart[11:14], ["nan", "0", "0", "0", "apart"])
        self.assertEqual(self.answers(APART)[0][1], "nan")
        wide = [float(x) for x in self.answers(INTERSECTING, "--query", "depth", "--error", "10")[0][11:13]]
        self.assertTrue(wide[0] <= depth <= wide[1])

    def test_the_verdict_alone(self):
        row = self.answers(APART, "--query", "intersection")[0]
        self.assertEqual([row[0]] + row[2:11], ["nan"] * 10)
        self.assertGreater(float(row[11]), 0)

    def test_all_formats(self):
        for mesh in (BOX, PRISM, SPHERE):
            self.assertEqual(len(self.answers(APART, meshes=(BOX, mesh))), 1)

    def test_a_hull_of_points(self):
        points = self.file("points.off", "OFF\n2 0 0\n0 0 0\n1 0 0\n")
        row = self.answers(HERE + " " + pose(0, 0, 2), "--input", "hull", meshes=(points, points))[0]
        self.assertTrue(float(row[11]) <= 2 <= float(row[12]))
        self.refused(2, "points.off", points, points, self.file("poses", APART))

    # -- pose files --

    def test_comments_blank_lines_and_line_ends(self):
        text = "# a comment\r\n\n  \t\r\n" + APART + "\r\n  # another\n" + " " * 100000 + APART
        self.assertEqual(len(self.answers(text)), 2)
        self.assertEqual(self.answers(""), [])

    def test_count_looks_no_further(self):
        self.assertEqual(len(self.answers(APART + "\n" + APART + "\nrubbish\n", "--count", "2")), 2)

    def test_the_standard_input(self):
        done = self.run_tool(BOX, BOX, "-", stdin=APART + "\n")
        self.assertEqual((done.returncode, len(done.stdout.splitlines())), (0, 1))

    def test_bad_lines_are_named(self):
        for bad, message in ((b"1 2 3", "3 numbers"), (APART.encode() + b" 7", "25 numbers"),
                             (APART.encode()[:-1] + b"nan", "not finite"), (APART.encode()[:-1] + b"-inf", "not finite"),
                             (APART.encode()[:-1] + b"1e999", "not finite"), (b"1 2x 3", "'2x' is not a number"),
                             (b"\x00\xff", "a zero byte"), (b"\x00", "a zero byte"), (b"# a\x00b", "a zero byte"),
                             (APART.encode() + b"\x00", "a zero byte"), (b"1\x00 2", "a zero byte")):
            poses = self.file("bad.poses", APART.encode() + b"\n# comment\n" + bad + b"\n")
            self.refused(2, "bad.poses:3: ", BOX, BOX, poses)
            self.refused(2, message, BOX, BOX, poses)

    def test_a_pose_that_the_library_refuses_is_named(self):
        sheared = "1 1 0 0 0 1 0 0 0 0 1 0 " + pose(2, 0, 0)
        done = self.run_tool(BOX, BOX, self.file("sheared.poses", APART + "\n\n" + sheared + "\n" + APART + "\n"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("sheared.poses:3: ", done.stderr)
        self.assertEqual(len(done.stdout.splitlines()), 1)

    # -- other files --

    def test_bad_meshes_are_named(self):
        poses = self.file("poses", APART)
        box = "OFF\n8 6 0\n" + "".join("%d %d %d\n" % (i & 1, i >> 1 & 1, i >> 2) for i in range(8))
        sides = ("4 0 4 6 2\n", "4 1 3 7 5\n", "4 0 1 5 4\n", "4 2 6 7 3\n", "4 0 2 3 1\n", "4 4 5 7 6\n")
        bad = {"line 5: vertex 2 of 3: \"rubbish\" is not a number": "OFF\n3 1 0\n0 0 0\n1 0 0\n0 rubbish 0\n3 0 1 2\n",
               "line 12: face 1, corner 2: vertex index 8 is out of range (8 vertices)":
                   box + "4 0 4 6 2\n4 1 3 8 5\n" + "".join(sides[2:]),
               "face 2: edge 4-5 belongs to no other face": box.replace("8 6 0", "8 5 0") + "".join(sides[:5]),
               "face 3: edge 2-3 runs in the same direction in face 4: the faces are not consistently oriented":
                   box + "".join(sides[:3]) + "4 2 3 7 6\n" + "".join(sides[4:]),
               "face 5: vertex 4 lies 2.041e-1 off its plane (allowed 2.449e-9)": box.replace("1 1 1", "1 1 2") + "".join(sides)}
        cure = "; --input hull takes the hull of the vertices"
        for message, mesh in bad.items():
            message += "" if message.startswith("line") else cure
            path = self.file("bad.off", mesh)
            for meshes in ((path, BOX), (BOX, path)):
                done = self.run_tool(*meshes, poses)
                self.assertEqual((done.returncode, done.stdout, done.stderr), (2, "", "%s: %s\n" % (path, message)))
        for arguments, missing in ((("none.off", BOX, poses), "none.off: cannot be read: "),
                                   ((BOX, BOX, "none.poses"), "none.poses: ")):
            done = self.run_tool(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertRegex(done.stderr, "^%sNo such file or directory( \\(os error 2\\))?\n$" % missing)

    # -- the command line --

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full")
    def test_what_cannot_be_written_is_told(self):
        for arguments in ((BOX, BOX, self.file("poses", APART)), ("--help",), ("--version",)):
            with open("/dev/full", "w") as full:
                done = subprocess.run([TOOL, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
            self.assertEqual(done.returncode, 1)
            self.assertIn("swiftprox-query: the output cannot be written: ", done.stderr)

    def test_approximate_distances(self):
        poses = "\n".join("%s %s" % (HERE, pose(3.3 + 0.01 * i, 0.2, 0.1)) for i in range(20))
        exact = self.answers(poses, "--query", "distance", meshes=(SPHERE, PRISM))
        for levels in ("none", "auto", "quadric", "dk", "outer"):
            for error in (0.0, 0.01, 0.5):
                options = ("--query", "approximate", "--error", str(error), "--levels", levels)
                for row, true in zip(self.answers(poses, *options, meshes=(SPHERE, PRISM)), exact, strict=True):
                    self.assertLessEqual(Decimal(row[11]), Decimal(true[12]))
                    self.assertLessEqual(Decimal(true[11]), Decimal(row[12]))
                    self.assertLessEqual(Decimal(row[12]) - Decimal(row[11]), max(Decimal(error), Decimal("1e-12")))
        self.assertEqual(self.answers(INTERSECTING, "--query", "approximate", "--error", "1")[0][11:13], ["0", "0"])

    def test_times(self):
        done = self.run_tool(BOX, BOX, self.file("poses", (APART + "\n") * 50), "--bench", "3")
        best, median = map(float, done.stdout.split())
        self.assertTrue(0 < best <= median)
        self.refused(2, "no queries", BOX, BOX, self.file("poses", ""), "--bench", "3")


    # -- the progress bar --

    def on_terminal(self, *arguments, with_answers=False, status=0):
        """What a run writes to a terminal: to the standard error alone, or the answers as well; and the answers if not."""
        ours, its = pty.openpty()
        try:
            process = subprocess.Popen([TOOL, *arguments], stdin=subprocess.DEVNULL, stderr=its,
                                       stdout=its if with_answers else subprocess.PIPE)
        finally:
            os.close(its)
        patience = threading.Timer(60, process.kill)
        patience.start()
        text = b""
        try:
            while chunk := os.read(ours, 65536):
                text += chunk
        except OSError:  # what Linux says when nobody holds the other end any more
            pass
        os.close(ours)
        answers = process.communicate()[0]
        patience.cancel()
        self.assertEqual(process.returncode, status, text)
        return text.decode(), (answers or b"").decode()

    def check_bars(self, text, behind):
        """Drawn over each other and erased in the end; each is as full as what stands behind it says, in two numbers."""
        self.assertTrue(text.endswith("\r\x1b[K"), text)
        bars = [bar for bar in text.replace("\x1b[K", "").split("\r") if bar]
        self.assertGreater(len(bars), 0)
        last = 0
        for bar in bars:
            match = re.fullmatch(r"\[(#* *)\] " + behind, bar)
            self.assertTrue(match, bar)
            self.assertEqual(len(match[1]), 40)
            filled, done, total = match[1].count("#"), int(match[2]), int(match[3] or 100)
            self.assertTrue(last <= filled <= 40 * (done + 1) / total and 40 * done / total < filled + 1, bar)
            last = filled

    def long_to_build(self):
        """Points on a sphere, of which levels after Dobkin and Kirkpatrick take seconds."""
        count = 30000
        lines = ["OFF", "%d 0 0" % count]
        for i in range(count):
            z = 1 - (2 * i + 1) / count
            r = math.sqrt(1 - z * z)
            lines.append("%r %r %r" % (r * math.cos(2.4 * i), r * math.sin(2.4 * i), z))
        return self.file("sphere.off", "\n".join(lines) + "\n")

    def test_a_bar_shows_how_far_the_shapes_are_built(self):
        sphere, poses = self.long_to_build(), self.file("poses", APART)
        options = (poses, "--input", "hull", "--levels", "dk")
        text, answers = self.on_terminal(BOX, sphere, *options)
        self.check_bars(text, r"(\d+) % of B()")
        self.assertEqual(len(answers.split()), 15)
        # No terminal, no bar; on the terminal that the answers go to it is gone before them.
        quiet = self.run_tool(sphere, BOX, *options)
        self.assertEqual((quiet.returncode, quiet.stderr), (0, ""))
        text, _ = self.on_terminal(sphere, BOX, *options, with_answers=True)
        bars, _, rest = text.rpartition("% of A")
        self.check_bars(bars + "% of A\r\x1b[K", r"(\d+) % of A()")
        self.assertEqual(rest.replace("\r\x1b[K", ""), quiet.stdout.replace("\n", "\r\n"))
        # So it is before a message.
        text, _ = self.on_terminal(sphere, sphere, self.file("bad", "1 2 3"), *options[1:], status=2)
        self.assertRegex(text, r"% of A\r\x1b\[K[^\r]*bad:1: ")

    def test_a_bar_shows_how_far_the_queries_are(self):
        poses = self.file("poses", (APART + "\n") * 1000)
        nanoseconds = float(self.run_tool(BOX, BOX, poses, "--bench", "10").stdout.split()[0])
        passes = int(1.5e9 / (1000 * nanoseconds))
        text, answers = self.on_terminal(BOX, BOX, poses, "--bench", str(passes))
        self.check_bars(text, r"(\d+) of (%d)" % passes)
        self.assertEqual(len(answers.split()), 2)


class Cases(unittest.TestCase):
    """The referee passes what is right and finds what is wrong."""

    ROOT_2 = "1.4142135623730950488016887242096980785697"

    def judge(self, lo, hi, poses=HERE + " 1 0 0 2 0 1 0 2 0 0 1 0", mesh="0 0 0\n1 0 0\n0 1 0\n1 1 0\n", options=()):
        with tempfile.TemporaryDirectory() as root:
            family = os.path.join(root, "family")
            os.mkdir(family)
            for name, text in (("square.off", "OFF\n4 0 0\n" + mesh), ("c0.poses", poses + "\n"),
                               ("c0.truth", lo + " " + hi + " 0" * 11 + "\n"),
                               ("cases.txt", "square.off square.off c0.poses c0.truth\n")):
                with open(os.path.join(family, name), "w") as out:
                    out.write(text)
            script = os.path.join(ROOT, "scripts", "cases.py")
            return subprocess.run([sys.executable, script, TOOL, root, *options], capture_output=True, text=True, timeout=60)

    def test_the_truth_passes(self):
        done = self.judge(self.ROOT_2, self.ROOT_2)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_approximate_answers_are_judged_by_the_error_asked_for(self):
        for options in (("--error", "0.1", "--levels", "quadric"), ("--error", "0", "--start", "cold")):
            done = self.judge(self.ROOT_2, self.ROOT_2, options=("--query", "approximate", *options))
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        done = self.judge("0", "0", options=("--query", "approximate"))
        self.assertEqual(done.returncode, 1)

    def test_a_wrong_verdict_fails(self):
        done = self.judge("0", "0")
        self.assertEqual(done.returncode, 1)
        self.assertIn("wrong: ", done.stderr)

    def test_a_missed_interval_fails(self):
        done = self.judge("1.41421356237", "1.41421356238".replace("8", "7"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("missed: ", done.stderr)

    def test_a_refusal_fails(self):
        done = self.judge(self.ROOT_2, self.ROOT_2, poses="1 2 3")
        self.assertEqual(done.returncode, 1)
        self.assertIn("refused: ", done.stderr)


if __name__ == "__main__":
    unittest.main()

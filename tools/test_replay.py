#!/usr/bin/env python3
"""Tests swiftprox-replay from outside:  test_replay.py TOOL RECORDER"""
import math
import os
import pty
import random
import subprocess
import sys
import tempfile
import unittest

TOOL = sys.argv.pop(1)
RECORDER = sys.argv.pop(1)  # writes a recording to the file that it is given
MODELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "models")
BOX = os.path.join(MODELS, "box.off")  # half sides 0.8, 0.5, 0.3
BALL = os.path.join(MODELS, "sphere.stl")
HEAD = "# swiftprox scene 1\n"
BOXES = HEAD + f"shape box {BOX}\nobject box fixed\nobject box\nobject box\n"


def at(number, x, y=0, z=0):
    return f"{number} 1 0 0 {x} 0 1 0 {y} 0 0 1 {z}\n"


def ball_of(rings, around):
    """A ball in OFF with so many points on each ring, and two poles."""
    points, faces = [(0.0, 0.0, 1.0)], []
    for ring in range(1, rings + 1):
        polar = math.pi * ring / (rings + 1)
        for i in range(around):
            turn = 2 * math.pi * i / around
            points.append((math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar)))
    points.append((0.0, 0.0, -1.0))
    for i in range(around):
        after = (i + 1) % around
        faces.append((0, 1 + i, 1 + after))
        faces.append((len(points) - 1, len(points) - 1 - around + after, len(points) - 1 - around + i))
        for above in range(1, 1 + (rings - 1) * around, around):
            below = above + around
            faces += [(above + i, below + i, below + after), (above + i, below + after, above + after)]
    return (f"OFF\n{len(points)} {len(faces)} 0\n" + "".join("%.17g %.17g %.17g\n" % point for point in points) +
            "".join("3 %d %d %d\n" % face for face in faces))


def forged(recording):
    """The recording with another number of pairs in its first answer, and checksums that are right (src/scene/recording/mod.rs)."""
    total, out, place = 0xCBF29CE484222325, bytearray(), 12

    def add(data):
        nonlocal total
        for byte in data:
            total = (total ^ byte) * 0x100000001B3 % 2**64
        out.extend(data)

    add(recording[:12])
    is_first = True
    while place < len(recording):
        kind, length = (int.from_bytes(recording[place + at:place + at + 4], "little") for at in (0, 4))
        content = bytearray(recording[place + 12:place + 12 + length])
        if kind == 22 and is_first:
            content[2] += 1
            is_first = False
        add(recording[place:place + 8])
        add((total % 2**32).to_bytes(4, "little"))
        add(content)
        add(total.to_bytes(8, "little"))
        place += 20 + length
    return bytes(out)


class Replay(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, content, name="scene.txt"):
        path = os.path.join(self.folder.name, name)
        with open(path, "w") as out:
            out.write(content)
        return path

    def play(self, content, *options):
        done = subprocess.run([TOOL, self.file(content), *options], capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return [line.split() for line in done.stdout.splitlines()]

    def refused(self, status, message, *arguments, stdin=None):
        done = subprocess.run([TOOL, *arguments], input=stdin, capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stdout), (status, ""))
        self.assertIn(message, done.stderr)

    def refused_scene(self, line, message, content, status=2):
        path = self.file(content)
        self.refused(status, f"{path}:{line}: {message}", path)

    # -- answers --

    def test_what_is_listed_in_each_step(self):
        rows = self.play(BOXES + "step\n" + at(1, 3) + at(2, 6) + "step\n" + at(2, 1.5) + "step\n", "--verify")
        self.assertEqual([row[:4] for row in rows], [
            [str(step), a, b, outcome]
            for step, outcomes in enumerate((["separated"] * 3, ["separated", "intersecting", "intersecting"],
                                             ["separated", "intersecting", "intersecting"]))
            for (a, b), outcome in zip((("0", "1"), ("0", "2"), ("1", "2")), outcomes)])
        for row in rows:
            distance, lower, upper = map(float, row[4:7])
            self.assertTrue(lower <= distance <= upper)
            self.assertEqual(row[7], "nan")
        self.assertAlmostEqual(float(rows[0][4]), 1.4)

    def test_the_tolerance(self):
        scene = BOXES + "step\n" + at(1, 2.1) + at(2, 9)
        self.assertEqual(len(self.play(scene)), 3)
        self.assertEqual([row[1:3] for row in self.play(scene, "--max-distance", "0.6")], [["0", "1"]])
        self.assertEqual(self.play(scene, "--max-distance", "0.4"), [])
        self.assertEqual(self.play(scene, "--query", "contact"), [])
        self.assertEqual(len(self.play(scene, "--query", "contact", "--max-distance", "0.6")), 1)

    def test_depths(self):
        scene = BOXES + "step\n" + at(1, 1.5) + at(2, 9) + "step\n" + at(1, 1.6, 0, 0.5) + "step\n" + at(1, 1.7)
        rows = self.play(scene, "--query", "contact", "--max-distance", "0.2", "--verify")
        self.assertEqual([row[:4] for row in rows], [
            ["0", "0", "1", "intersecting"], ["1", "0", "1", "intersecting"], ["2", "0", "1", "separated"]])
        self.assertAlmostEqual(float(rows[0][7]), 0.1)
        self.assertLessEqual(float(rows[1][7]), 1e-7)  # the model's coordinates are as the file has them
        self.assertEqual(rows[2][7], "nan")
        self.assertEqual([row[4] for row in rows[:2]], ["0", "0"])
        distances = self.play(scene, "--query", "distance", "--max-distance", "0.2")
        self.assertTrue(all(row[7] == "nan" for row in distances))

    def test_approximate_distances(self):
        """Levels answer of a body of many vertices: intervals within the error, and all of a step within the budget."""
        ball = self.file(ball_of(200, 200), "ball.off")
        scene = HEAD + f"shape ball {ball}\n" + "object ball\n" * 4
        scene += "".join("step\n" + "".join(at(i, 2.5 * i + 0.01 * step) for i in range(4)) for step in range(3))
        exact = self.play(scene)

        def widths(*options):
            rows = self.play(scene, "--query", "approximate", "--verify", *options)
            self.assertEqual([row[:4] for row in rows], [row[:4] for row in exact])
            for row, near in zip(rows, exact):
                self.assertTrue(float(row[5]) <= float(near[6]) and float(near[5]) <= float(row[6]), (row, near))
            return [float(row[6]) - float(row[5]) for row in rows]

        self.assertLess(max(widths()), 1e-12)
        wide = widths("--error", "0.1")
        self.assertTrue(1e-6 < max(wide) <= 0.1, wide)
        shared = widths("--budget", "0.3")
        for step in range(3):
            self.assertTrue(1e-6 < sum(shared[6 * step:6 * step + 6]) <= 0.3, shared)
        self.assertLess(max(widths("--budget", "0", "--error", "0.1")), 1e-12)
        # Of contacts the error is that of depths.
        self.assertEqual(len(self.play(BOXES + "step\n" + at(1, 1.5) + at(2, 9), "--query", "contact", "--error", "0.1")), 1)

    def test_the_verdict_alone(self):
        rows = self.play(BOXES + "step\n" + at(1, 0.5) + at(2, 9), "--query", "intersection", "--verify")
        self.assertEqual([row[:4] for row in rows], [["0", "0", "1", "intersecting"]])

    def test_shapes_lie_beside_the_scene_and_names_may_hold_blanks(self):
        with open(BOX) as model:
            self.file(model.read(), "my box.off")
        rows = self.play(HEAD + "\n# two\nshape a my box.off \nobject a\nobject a\nstep\n" + at(1, 2))
        self.assertAlmostEqual(float(rows[0][4]), 0.4)

    def test_the_standard_input(self):
        scene = BOXES + "step\n" + at(1, 2) + at(2, 9)
        done = subprocess.run([TOOL, "-"], input=scene, capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, len(done.stdout.splitlines())), (0, 3))

    # -- recordings --

    def recording(self):
        path = os.path.join(self.folder.name, "scene.swiftprox")
        if not os.path.exists(path):
            subprocess.run([RECORDER, path], check=True, timeout=60)
        return path

    def play_recording(self, *options):
        done = subprocess.run([TOOL, self.recording(), *options], capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return [line.split() for line in done.stdout.splitlines()]

    def test_a_recording(self):
        rows = self.play_recording("--verify")
        # Contacts with depths, distances, what is near a shape put somewhere, and what a removal leaves; see record_scene.c.
        self.assertEqual([row[:4] for row in rows], [
            ["0", "0", "1", "intersecting"],
            ["1", "0", "1", "intersecting"], ["1", "0", "2", "separated"], ["1", "1", "2", "separated"],
            ["2", "2", "-", "intersecting"],
            ["3", "0", "3", "separated"]])
        self.assertAlmostEqual(float(rows[0][7]), 0.25)
        self.assertEqual(self.play_recording("--verify", "--workers", "2"), rows)

    def test_a_recording_asked_something_else(self):
        rows = self.play_recording("--query", "distance", "--max-distance", "inf", "--verify")
        self.assertEqual([row[0] for row in rows], ["0"] * 3 + ["1"] * 3 + ["2"] * 3 + ["3"] * 3)
        self.assertEqual([row[:3] for row in self.play_recording("--query", "intersection")],
                         [[str(step), "0", "1"] for step in range(3)])
        self.assertEqual(len(self.play_recording("--max-distance", "0")), 3)

    def test_a_recording_as_a_bench(self):
        mean, median, worst, pairs, total = map(float, self.play_recording("--bench", "3")[0])
        self.assertEqual(pairs, len(self.play_recording()))
        self.assertTrue(0 < median <= worst and 0 < mean <= worst and total > 0)

    def test_a_recording_that_is_cut_off_damaged_or_forged(self):
        path = self.recording()
        with open(path, "rb") as file:
            whole = file.read()
        rows = self.play_recording()

        def play(content):
            with open(path, "wb") as file:
                file.write(content)
            done = subprocess.run([TOOL, path, "--verify"], capture_output=True, text=True, timeout=60)
            return done.returncode, done.stderr, [line.split() for line in done.stdout.splitlines()]

        status, message, listed = play(whole[:-20])
        self.assertEqual((status, listed), (0, rows))
        self.assertIn("was not ended", message)
        status, message, listed = play(whole[:-200] + b"x" + whole[-199:])
        self.assertEqual((status, listed), (2, rows[:len(listed)]))
        self.assertIn("at byte ", message)
        self.assertEqual(play(whole[:10])[0], 2)

        # An answer that is not the recorded one.
        status, message, listed = play(forged(whole))
        self.assertEqual((status, listed), (1, []))
        self.assertIn("step 0: the answer is not the recorded one", message)

    def test_a_bench_lists_what_the_answers_list(self):
        draw = random.Random(7)
        scene = HEAD + f"shape box {BOX}\nshape ball {BALL}\n" + "object box\nobject ball\n" * 10
        for _ in range(5):
            scene += "step\n" + "".join(at(i, *(draw.uniform(-3, 3) for _ in range(3))) for i in range(20))
        rows = self.play(scene, "--max-distance", "0.5", "--verify")
        mean, median, worst, pairs, total = map(float, self.play(scene, "--max-distance", "0.5", "--bench", "2")[0])
        self.assertEqual(pairs, len(rows))
        self.assertGreater(pairs, 50)
        self.assertTrue(math.isclose(total, sum(float(row[4]) for row in rows), rel_tol=1e-9))
        self.assertTrue(0 < median <= worst and 0 < mean <= worst)

    def test_a_bar_for_people_alone(self):
        primary, secondary = pty.openpty()
        self.addCleanup(os.close, primary)
        scene = BOXES + ("step\n" + at(1, 2)) * 2000
        # More passes than anybody waits for: it ends when the bar is there.
        tool = subprocess.Popen([TOOL, self.file(scene), "--bench", "999999"], stdout=subprocess.DEVNULL, stderr=secondary)
        os.close(secondary)
        self.addCleanup(tool.wait)
        self.addCleanup(tool.kill)
        seen = ""
        while "\r[" not in seen and tool.poll() is None:
            seen += os.read(primary, 1 << 16).decode()
        self.assertIn("\r[", seen)

    # -- refusals --

    def test_bad_scenes(self):
        self.refused_scene(1, "a scene begins with the line", "shape a b\n")
        self.refused_scene(1, "a scene begins with the line", HEAD.strip() + "0\n")
        self.refused_scene(2, "a shape is `shape NAME FILE`", HEAD + "shape box\n")
        self.refused_scene(3, "this shape has been named before", HEAD + f"shape a {BOX}\nshape a {BOX}\n")
        self.refused_scene(2, "no shape of this name is above", HEAD + "object a\n")
        self.refused_scene(3, "an object is", HEAD + f"shape a {BOX}\nobject a solid\n")
        self.refused_scene(7, "all objects stand above the first step", BOXES + "step\nobject box\n")
        self.refused_scene(6, "a move stands above the first step", BOXES + at(1, 2))
        self.refused_scene(7, "object 3, but there are 3, numbered from 0", BOXES + "step\n" + at(3, 2))
        self.refused_scene(7, "object 99999999999999999999, but", BOXES + "step\n" + at("9" * 20, 2))
        self.refused_scene(7, "neither shape, object nor step", BOXES + "step\n" + at(-1, 2))
        self.refused_scene(7, "neither shape, object nor step", BOXES + "step\nwalk\n")
        self.refused_scene(6, "`step` stands alone", BOXES + "step 1\n")
        self.refused_scene(7, "11 numbers where a pose has 12", BOXES + "step\n1" + " 0" * 11 + "\n")
        self.refused_scene(7, "number 4 is not finite", BOXES + "step\n" + at(1, "inf"))
        self.refused_scene(7, "", BOXES + "step\n1" + " 0" * 12 + "\n")  # no rotation
        self.refused_scene(2, "", HEAD + "shape a missing.off\nobject a\nstep\n")
        self.refused(2, "No such file", "missing.txt")
        path = self.file(BOXES + "step\n")
        self.refused(2, "there is no step to time", path, "--bench", "1")


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Tests swiftprox-tune from outside:  test_tune.py TOOL RECORDER INCLUDE [CC [CXX]]

INCLUDE has the library's headers: what is recommended is compiled with them, by the compilers that are named."""
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

TOOL, RECORDER, INCLUDE, *COMPILERS = sys.argv[1:]
MODELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "models")
BALL = os.path.join(MODELS, "sphere.stl")
LINE = re.compile(r"^([* ]) +(\S+) +(\S+)  (\S.*)$", re.MULTILINE)


def scene(steps=6, apart=2.4):
    """A row of balls that turn and sway."""
    lines = ["# swiftprox scene 1", f"shape ball {BALL}"] + ["object ball"] * 5
    for step in range(steps):
        lines.append("step")
        for i in range(5):
            angle = 0.1 * step + i
            c, s = math.cos(angle), math.sin(angle)
            lines.append(f"{i} {c!r} {-s!r} 0 {i * apart + 0.2 * s!r} {s!r} {c!r} 0 0 0 0 1 0")
    return "\n".join(lines) + "\n"


class Tune(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, name, content):
        path = os.path.join(self.folder, name)
        with open(path, "w") as out:
            out.write(content)
        return path

    def tune(self, *arguments):
        done = subprocess.run([TOOL, *arguments], capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def refused(self, message, *arguments):
        done = subprocess.run([TOOL, *arguments], capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn(message, done.stderr)

    def points(self, said):
        """(on the front, time, width, setting) of each line, in order."""
        head, _, _ = said.partition("\n\n")
        found = [(star == "*", float(time), float(width), setting) for star, time, width, setting in LINE.findall(head)]
        self.assertEqual(len(found), len(head.splitlines()) - 1, head)
        return found

    def code(self, said):
        """What is recommended first, in C and in C++."""
        part = said.split("\nRecommended")[1]
        c, cpp = part.split("\nIn C:\n")[1].split("\nIn C++:\n")
        return c, re.split(r"\n(?:No error|Recommended)", cpp)[0]

    def test_every_setting_is_timed_and_the_front_is_what_no_other_beats(self):
        points = self.points(self.tune(self.file("scene.txt", scene()), "--max-distance", "1", "--workers", "2", "--passes", "2"))
        settings = [setting for _, _, _, setting in points]
        self.assertEqual(len(set(settings)), len(settings))
        for wanted in ("exact", "exact, start at the tables", "exact, start afresh", "exact, 2 threads", "exact, shapes without tables",
                       "error 0.1", "error 0.01", "exact, shapes with levels, through all levels",
                       "error 0.1, shapes with levels, through all levels"):
            self.assertIn(wanted, settings)
        self.assertEqual([time for _, time, _, _ in points], sorted(time for _, time, _, _ in points))
        self.assertTrue(all(time > 0 and 0 <= width < 0.11 for _, time, width, _ in points), points)
        self.assertTrue(points[0][0], "the quickest is on the front")
        for on_front, time, width, setting in points:
            # As printed, with four digits: what is beaten by less may be on the front.
            clearly_beaten = any(t < 0.999 * time and w < 0.99 * width for _, t, w, _ in points)
            self.assertFalse(on_front and clearly_beaten, setting)
            error = re.match("error ([^,]*)", setting)
            self.assertLessEqual(width, 1.001 * float(error[1]) + 1e-12 if error else 1e-12, setting)

    def test_the_drawing_has_the_front(self):
        said = self.tune(self.file("scene.txt", scene()), "--max-distance", "1", "--passes", "1")
        drawing = [line.split("|")[1] for line in said.splitlines() if "|" in line]
        self.assertEqual(len(drawing), 14)
        self.assertIn("*", "".join(drawing))

    def test_a_recording_is_tuned_for_what_it_asks(self):
        recording = os.path.join(self.folder, "recording")
        subprocess.run([RECORDER, recording], check=True, timeout=60)
        said = self.tune(recording, "--passes", "1")
        self.assertIn("swiftprox_scene_query_contact(", said)
        self.assertNotIn("shapes with", said)
        self.assertIn("swiftprox_scene_query_intersection(", self.tune(recording, "--query", "intersection", "--passes", "1"))

    def test_the_recommended_error_is_at_most_what_is_allowed(self):
        said = self.tune(self.file("scene.txt", scene()), "--max-distance", "1", "--error", "1e-5", "--passes", "1")
        self.assertIn("Recommended for that error", said)
        error = re.search(r"query\.absolute_error = (\S+);", said)
        self.assertTrue(error is None or float(error[1]) <= 1e-5, said)

    def test_recommended_code_compiles(self):
        if not COMPILERS:
            self.skipTest("no compiler was named")
        path = self.file("scene.txt", scene())
        for options in (("--max-distance", "1"), ("--query", "contact", "--error", "0.1"), ("--query", "intersection")):
            c, cpp = self.code(self.tune(path, *options, "--passes", "1"))
            bodies = [("a.c", "#include <swiftprox.h>\nvoid tuned(swiftprox_scene *scene)\n{\n%s(void)answer; (void)status;\n}\n", c, "-std=c99"),
                      ("a.cpp", "#include <swiftprox.hpp>\nvoid tuned(swiftprox::Scene &scene)\n{\n%s(void)answer;\n}\n", cpp, "-std=c++17")]
            for compiler, (name, frame, code, standard) in zip(COMPILERS, bodies):
                lines = code.splitlines()
                includes = "".join(line + "\n" for line in lines if line.startswith("#include"))
                rest = "".join(line + "\n" for line in lines if not line.startswith("#include"))
                # What the program around it hands on, to shapes and to the scene.
                handed = re.findall(r"^swiftprox_\w+_options (\w+) =", rest, re.MULTILINE) if name == "a.c" else []
                rest += "".join(f"(void){variable};\n" for variable in handed)
                source = self.file(name, includes + frame % rest)
                done = subprocess.run([compiler, standard, "-fsyntax-only", "-Wall", "-Werror", "-I", INCLUDE, source],
                                      capture_output=True, text=True, timeout=60)
                self.assertEqual((done.returncode, done.stderr), (0, ""), code)

    def test_what_cannot_be_tuned_is_refused(self):
        path = self.file("scene.txt", scene(steps=1))
        self.refused("there is no step to time", path)
        self.refused("have no meaning for --query intersection", path, "--query", "intersection", "--error", "1")
        self.refused("none.txt", os.path.join(self.folder, "none.txt"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

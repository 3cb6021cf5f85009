#!/usr/bin/env python3
"""Tests that all tools and examples treat their command lines alike:  test_command_lines.py RECORDER PROGRAM ...

tools/program.h has the rules. `hello` is not among them: it is the example of the README as it stands there, and reads no command
line."""
import os
import subprocess
import sys
import tempfile
import unittest

RECORDER = sys.argv[1]  # writes a recording to the file that it is given
# An empty word stands for a program that is not built: newer CMake hands it on.
PROGRAMS = {os.path.basename(path): path for path in sys.argv[2:] if path}
MODELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "models")
BOX = os.path.join(MODELS, "box.off")

# Operands that are enough, and options with a value that each takes.
OPERANDS = {"swiftprox-query": (BOX, BOX, "POSES"), "swiftprox-replay": ("SCENE",), "swiftprox-tune": ("SCENE",),
            "demo": (BOX, BOX), "tower": (MODELS,),
            "scene": (MODELS,), "swiftprox-sweep": ("SCENE", "POSES"), "arm_rrt": (MODELS,)}
OPTIONS = {"swiftprox-query": ("--query", "--max-distance", "--error", "--start", "--levels", "--input", "--count", "--bench"),
           "swiftprox-replay": ("--query", "--max-distance", "--error", "--budget", "--input", "--workers", "--bench", "--html"),
           "swiftprox-tune": ("--query", "--max-distance", "--error", "--input", "--workers", "--passes"),
           "swiftprox-sweep": ("--out", "--share", "--max-distance", "--input", "--times"), "certified_edge": ("--svg",),
           "demo": ("--orbit", "--svg", "--record"),
           "tower": ("--svg", "--record", "--seconds"), "pile": ("--record",), "crowd": ("--svg",)}
CHOICES = {"--query", "--start", "--levels", "--input"}
NUMBERS = {"--error": ("-1", "x", "nan", ""), "--budget": ("-1", "x", "nan", ""),
           "--max-distance": ("-1", "x", "nan", ""), "--share": ("0", "x", "1048577"), "--orbit": ("-1", "0", "x", "1e6"),
           "--count": ("0", "-1", "x", " 1", "9" * 30), "--bench": ("0", "x", "1.5"), "--workers": ("0", "1025", "many"), "--passes": ("0", "x"),
           "--seconds": ("0", "2", "3601", "x")}


def run(name, *arguments):
    return subprocess.run([PROGRAMS[name], *arguments], capture_output=True, text=True, timeout=60)


class CommandLines(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, name, content):
        path = os.path.join(self.folder, name)
        with open(path, "w") as out:
            out.write(content)
        return path

    def refused(self, name, named, *arguments):
        """Nothing is done and nothing printed; the message is that of the program, and has the word."""
        done = run(name, *arguments)
        self.assertEqual((done.returncode, done.stdout), (2, ""), (name, arguments))
        first = done.stderr.splitlines()[0]
        self.assertTrue(first.startswith(name + ": ") and named in first, done.stderr)
        self.assertIn("usage: " + name, done.stderr)

    def test_help_and_version_wherever_they_stand(self):
        for name in PROGRAMS:
            for arguments in (("--help",),) + ((("-h",), (BOX, "--help"), ("--unknown", "--help")) if name != "legacy" else ()):
                done = run(name, *arguments)
                self.assertEqual((done.returncode, done.stderr), (0, ""), (name, arguments))
                self.assertTrue(done.stdout.startswith("usage: " + name), done.stdout)
            if name != "legacy":
                self.assertRegex(run(name, "--version").stdout, r"^%s \d+\.\d+\.\d+\n$" % name)

    def test_what_is_not_known_is_named(self):
        for name in PROGRAMS:
            for unknown in ("--unknown", "-x", "--unknown=1"):
                self.refused(name, unknown.split("=")[0], unknown)
            self.refused(name, "stray", *OPERANDS.get(name, ()), "stray")

    def test_missing_and_bad_values_are_named(self):
        for name, options in OPTIONS.items():
            if name not in PROGRAMS:
                continue  # swiftprox-sweep, where MPI is not installed
            operands = OPERANDS.get(name, ())
            for option in options:
                self.refused(name, option + " wants a value", *operands, option)
                self.refused(name, option + " wants a value", option, "--", *operands)
                for bad in ("any",) if option in CHOICES else NUMBERS.get(option, ()):
                    self.refused(name, option, *operands, option, bad)
                    self.refused(name, option, option + "=" + bad, *operands)
        self.refused("swiftprox-replay", "--verify takes no value", "SCENE", "--verify=yes")

    def test_operands_that_are_missing(self):
        self.refused("swiftprox-query", "two meshes and a pose file are needed", BOX, BOX)
        for player in ("swiftprox-replay", "swiftprox-tune"):
            self.refused(player, "a scene is needed")

    def test_values_behind_an_equals_sign_and_operands_behind_dashes(self):
        poses = self.file("--poses", "1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 2 0 1 0 0 0 0 1 0\n")
        done = subprocess.run([PROGRAMS["swiftprox-query"], "--query=distance", "--", BOX, BOX, "--poses"], cwd=self.folder,
                              capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""), poses)
        self.assertEqual(len(done.stdout.split()), 15)

    def test_options_without_a_meaning_beside_the_others(self):
        recording = os.path.join(self.folder, "recording")
        subprocess.run([RECORDER, recording], check=True, timeout=60)
        for query in ("distance", "intersection"):
            self.refused("swiftprox-query", "--error has no meaning for --query " + query, BOX, BOX, "POSES", "--error", "1",
                         "--query", query)
        for option, value in (("--start", "cold"), ("--levels", "dk")):
            self.refused("swiftprox-query", option + " has no meaning for --query depth", BOX, BOX, "POSES", "--query", "depth",
                         option, value)
        self.refused("swiftprox-query", "--max-distance has no meaning for --query depth", BOX, BOX, "POSES", "--query", "depth",
                     "--max-distance", "1")
        for query in ((), ("--query", "distance"), ("--query", "intersection")):
            self.refused("swiftprox-replay", "--error has a meaning for --query approximate", recording, "--error", "1", *query)
        for query in ((), ("--query", "distance"), ("--query", "contact")):
            self.refused("swiftprox-replay", "--budget has a meaning for --query approximate", recording, "--budget", "1", *query)
        self.refused("swiftprox-replay", "--input has no meaning for a recording", recording, "--input", "strict")
        self.refused("swiftprox-replay", "--max-distance has no meaning for --query intersection", recording, "--max-distance", "1",
                     "--query", "intersection")
        self.refused("swiftprox-replay", "--verify has no meaning beside --bench", recording, "--verify", "--bench", "1")

    def test_files_to_be_written_are_tried_first(self):
        for name, option in (("demo", "--svg"), ("demo", "--record"), ("certified_edge", "--svg"), ("tower", "--svg"),
                             ("tower", "--record"), ("pile", "--record"), ("crowd", "--svg"), ("swiftprox-replay", "--html")):
            for path in (os.path.join(self.folder, "none", "a.svg"), self.folder):
                self.refused(name, path, option, path)
        # The trial leaves no file behind, and none changed, where the program goes on to refuse something else.
        kept = self.file("kept.svg", "kept")
        for path in (kept, os.path.join(self.folder, "new.svg")):
            self.refused("tower", "stray", "--svg", path, MODELS, "stray")
        self.assertEqual(os.listdir(self.folder), ["kept.svg"])
        with open(kept) as file:
            self.assertEqual(file.read(), "kept")

    def test_refusals_name_options_and_no_constants_of_c(self):
        square = self.file("square.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n4 3 2 1 0\n")
        point = self.file("open.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n")
        scene = "# swiftprox scene 1\nshape a %s\nobject a\nstep\n"
        stray = self.file("stray.off", "OFF\n5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n5 5 5\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")
        for mesh, option in ((square, "--input flat"), (point, "--input hull"), (stray, "--input hull"), (stray, "--input patch")):
            for done in (run("swiftprox-query", mesh, mesh, "POSES"),
                         run("swiftprox-replay", self.file("scene.txt", scene % mesh))):
                self.assertEqual(done.returncode, 2)
                self.assertIn(option, done.stderr)
                self.assertNotIn("SWIFTPROX_", done.stderr)

    def test_advice_about_a_vertex_of_no_face_is_right(self):
        # The cube [-1, 1]³ and a vertex at x = 5 that is in no face, twice, 8 apart: 6 between the cubes, 2 from that vertex.
        stray = os.path.join(MODELS, "..", "..", "tests", "fixtures", "meshes", "stray.obj")
        poses = self.file("poses.txt", "1 0 0 0  0 1 0 0  0 0 1 0  1 0 0 8  0 1 0 0  0 0 1 0\n")
        refused = run("swiftprox-query", stray, stray, poses)
        self.assertEqual(refused.returncode, 2)
        self.assertLess(refused.stderr.index("--input patch takes the hull of the faces"), refused.stderr.index("--input hull"))
        for policy, distance in (("patch", 6), ("hull", 2)):
            done = run("swiftprox-query", stray, stray, poses, "--input", policy)
            self.assertEqual((done.returncode, float(done.stdout.split()[0])), (0, distance), done.stderr)

    def test_a_damaged_recording_is_named_once(self):
        recording = os.path.join(self.folder, "recording")
        subprocess.run([RECORDER, recording], check=True, timeout=60)
        with open(recording, "r+b") as file:
            file.seek(-200, os.SEEK_END)
            file.write(b"x")
        done = run("swiftprox-replay", recording)
        self.assertEqual((done.returncode, done.stderr.count(recording)), (2, 1), done.stderr)

    @unittest.skipUnless(os.path.exists("/dev/zero"), "no /dev/zero")
    def test_devices_that_never_end_are_refused(self):
        for name, arguments in (("swiftprox-query", (BOX, BOX, "/dev/zero")), ("swiftprox-replay", ("/dev/zero",))):
            done = run(name, *arguments)
            self.assertEqual((done.returncode, done.stderr),
                             (2, "/dev/zero: it is a device; regular files, pipes and terminals are read\n"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

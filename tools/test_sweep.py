#!/usr/bin/env python3
"""Tests swiftprox-sweep over one, two and three ranks:  test_sweep.py SWEEP MPIEXEC RECORDER"""
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SWEEP, MPIEXEC, RECORDER = sys.argv[1:4]
MODELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "models")
# As root, and with more ranks than cores, Open MPI wants to be told that this is meant.
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_btl": "self,vader",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none"}
SCENE = f"# swiftprox scene 1\nshape box {os.path.join(MODELS, 'box.off')}\nobject box\nobject box fixed\nobject box fixed\nstep\n" \
        "1 1 0 0 3 0 1 0 0 0 0 1 0\n2 1 0 0 -3 0 1 0 0 0 0 1 0\n"
IDENTITY = "1 0 0 %r 0 1 0 %r 0 0 1 %r"


def numbers(count, seed, words):
    """Poses, or edges of two each, anywhere near the boxes."""
    chance = random.Random(seed)
    place = lambda: IDENTITY % tuple(chance.uniform(-5, 5) for _ in range(3))
    return "".join(" ".join(place() for _ in range(words)) + "\n" for _ in range(count))


def fnv(digest, text):
    """FNV-1a, 64 bits."""
    for byte in text.encode():
        digest = (digest ^ byte) * 0x100000001b3 % 2**64
    return digest


def sums(lines, share):
    """The checksums of whole shares behind a head: of all up to the end of each."""
    digest, text = fnv(0xcbf29ce484222325, lines[0]) if lines else 0, ""
    for first in range(1, len(lines), share):
        if first + share > len(lines) < 1001:
            break  # the last share of all is shorter
        digest = fnv(digest, "".join(lines[first:first + share]))
        text += "%016x\n" % digest
    return text


class Sweep(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.scene = self.file("scene.txt", SCENE)
        self.poses = self.file("poses", numbers(1000, 1, 1))
        self.edges = self.file("edges", numbers(300, 2, 2))

    def path(self, name):
        return os.path.join(self.folder, name)

    def file(self, name, content):
        with open(self.path(name), "w") as out:
            out.write(content)
        return self.path(name)

    def read(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def command(self, ranks, *arguments):
        return [MPIEXEC, "-n", str(ranks), SWEEP, *arguments] if ranks else [SWEEP, *arguments]

    def run_sweep(self, ranks, *arguments, **more):
        return subprocess.run(self.command(ranks, *arguments), capture_output=True, text=True, timeout=120, env=ENVIRONMENT, **more)

    def good(self, ranks, *arguments):
        done = self.run_sweep(ranks, *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done.stdout

    def refused(self, named, *arguments):
        done = self.run_sweep(0, *arguments)
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertIn(named, done.stderr)

    def test_any_number_of_ranks_writes_the_same(self):
        for items, count, words in ((self.poses, 1000, 4), (self.edges, 300, 5)):
            told = [self.good(ranks, self.scene, items, "--out", self.path(f"out{ranks}"), "--share", "64") for ranks in (1, 2, 3)]
            found = [self.read(f"out{ranks}") for ranks in (1, 2, 3)]
            self.assertEqual(found[0], found[1])
            self.assertEqual(found[0], found[2])
            lines = found[0].splitlines()[1:]
            self.assertEqual({len(line.split()) for line in lines}, {words})
            self.assertEqual(len(lines), count)
            for outcome in {line.split()[0] for line in lines}:
                counted = sum(line.startswith(outcome + " ") for line in lines)
                for text in told:
                    self.assertIn(f"{outcome} {counted}\n", text)
            self.assertFalse(os.path.exists(self.path("out1.part")))

    def test_results_are_right(self):
        poses = self.file("known", (IDENTITY + "\n") % (0.0, 0.0, 0.0) + (IDENTITY + "\n") % (2.9, 0.0, 0.0))
        self.good(0, self.scene, poses, "--out", self.path("out"))
        _, first, second = (line.split() for line in self.read("out").splitlines())
        self.assertEqual((first[0], second[0], second[3]), ("separated", "intersecting", "1"))
        side = 3 - float(first[1])  # both boxes are alike
        self.assertLess(float(first[2]) - float(first[1]), 1e-12)
        edges = self.file("known edges", (IDENTITY + " " + IDENTITY + "\n") % (0.0, 0.0, 0.0, 6.0, 0.0, 0.0)
                          + (IDENTITY + " " + IDENTITY + "\n") % (0.0, 0.0, 0.0, 0.0, 5.0, 0.0))
        self.good(0, self.scene, edges, "--out", self.path("out"))
        _, hit, free = (line.split() for line in self.read("out").splitlines())
        self.assertEqual((hit[0], hit[4], free[0], free[4]), ("hit", "1", "free", "-"))
        self.assertLess(abs(float(hit[2]) - (3 - side) / 6), 1e-8)
        self.assertGreater(float(free[3]), 0)

    def test_a_recording_is_a_scene(self):
        recording = self.path("recording")
        subprocess.run([RECORDER, recording], check=True, timeout=60)
        self.good(2, recording, self.poses, "--out", self.path("out"))
        self.assertEqual(len(self.read("out").splitlines()), 1001)

    def kill_when(self, job, size):
        """Kills a rank once so much is written, and then what is left of the job."""
        part = self.path("out.part")
        while job.poll() is None and not (os.path.exists(part) and os.path.getsize(part) >= size):
            time.sleep(0.001)
        found = subprocess.run(["pgrep", "-s", str(job.pid)], capture_output=True, text=True)
        ranks = sorted(int(pid) for pid in found.stdout.split() if int(pid) != job.pid)
        for pid in reversed(ranks):
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass  # it ended with the one before
        job.kill()
        job.wait(timeout=60)

    def test_what_is_killed_goes_on(self):
        """A rank is killed, and with it the job, again and again; and a line is cut in two."""
        edges = self.file("many", numbers(12000, 3, 2))
        self.good(2, self.scene, edges, "--out", self.path("whole"), "--share", "16")
        arguments = (self.scene, edges, "--out", self.path("out"), "--share", "16")
        was_killed = False
        for size in (1, 60000, 200000):
            job = subprocess.Popen(self.command(2, *arguments), env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
            self.kill_when(job, size)
            part = self.path("out.part")
            # A job that ends before it is killed leaves no part, and the next begins anew.
            was_killed = os.path.exists(part) and os.path.getsize(part) > 5000
            if was_killed:
                with open(part, "r+b") as file:
                    file.truncate(os.path.getsize(part) - 7)
        told = self.good(3, *arguments)
        self.assertEqual(self.read("out"), self.read("whole"))
        if was_killed:
            self.assertNotIn("from an earlier run 0\n", told)

    def test_a_part_is_gone_on_with(self):
        """Whatever it holds: the head, some shares, a share that is not whole, a line that is not."""
        self.good(0, self.scene, self.poses, "--out", self.path("whole"), "--share", "64")
        whole = self.read("whole")
        lines = whole.splitlines(keepends=True)
        for kept, from_before in ((0, 0), (1, 0), (64, 0), (65, 64), (300, 256), (1001, 1000)):
            for more in ("", lines[min(kept, 1000)][:9] if kept < 1001 else ""):
                for summed in {kept, 1001}:
                    # A run may be killed between the two files, whichever comes first on the disk.
                    self.file("out.part", "".join(lines[:kept]) + more)
                    self.file("out.part.sums", sums(lines[:summed], 64) + "1234" if summed else "")
                    told = self.good(0, self.scene, self.poses, "--out", self.path("out"), "--share", "64")
                    self.assertIn(f"from an earlier run {from_before}\n", told)
                    self.assertEqual(self.read("out"), whole)
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("out.part")], [])

    def test_a_part_that_was_changed_is_done_again(self):
        """Only the head and the ends of lines were looked at, so a line that was changed stayed as it was."""
        self.good(0, self.scene, self.poses, "--out", self.path("whole"), "--share", "64")
        whole = self.read("whole")
        lines = whole.splitlines(keepends=True)
        at = 1 + 64 * 3 + 10  # in the fourth share
        digit = lines[at][:-3] + chr(ord(lines[at][-3]) ^ 1) + lines[at][-2:]
        changed = {"a digit": lines[:at] + [digit] + lines[at + 1:],
                   "a zero byte": lines[:at] + [lines[at][:5] + "\0" + lines[at][6:]] + lines[at + 1:],
                   "a long line": lines[:at] + [" " * 5000 + lines[at]] + lines[at + 1:],
                   "a line less": lines[:at] + lines[at + 1:],
                   "lines that changed places": lines[:at] + lines[at + 1:at - 1:-1] + lines[at + 2:],
                   "shares that changed places": lines[:193] + lines[257:321] + lines[193:257] + lines[321:]}
        for what, found in changed.items():
            self.file("out.part", "".join(found[:900]))
            self.file("out.part.sums", sums(lines[:900], 64))
            done = self.run_sweep(0, self.scene, self.poses, "--out", self.path("out"), "--share", "64")
            self.assertEqual(done.returncode, 0, what)
            self.assertIn("out.part: it was changed behind result 192: what follows is answered again", done.stderr, what)
            self.assertIn("from an earlier run 192\n", done.stdout, what)
            self.assertEqual(self.read("out"), whole, what)
        # So is one whose checksums were changed, and without them nothing is believed.
        for changed, from_before in ((sums(lines[:900], 64).replace("\n", "x", 1), 0), ("", 0)):
            self.file("out.part", "".join(lines[:900]))
            self.file("out.part.sums", changed)
            done = self.run_sweep(0, self.scene, self.poses, "--out", self.path("out"), "--share", "64")
            self.assertEqual((done.returncode, self.read("out")), (0, whole))
            self.assertIn(f"from an earlier run {from_before}\n", done.stdout)

    def test_a_part_of_another_sweep_is_kept(self):
        for content in ("something else\n", "# swiftprox-sweep 1 poses 3 share 256 max_distance 0 scene 0 items 0\n"):
            self.file("out.part", content)
            self.refused("it is of another sweep", self.scene, self.poses, "--out", self.path("out"))
            self.assertEqual(self.read("out.part"), content)

    def test_a_full_disk(self):
        """The file may not grow beyond some bytes; what was written in time is gone on with."""
        poses = numbers(8000, 4, 1)
        self.good(0, self.scene, self.file("more", poses), "--out", self.path("whole"), "--share", "64")
        job = subprocess.Popen(self.command(0, self.scene, "-", "--out", self.path("out"), "--share", "64"), env=ENVIRONMENT,
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        # Once it has read more than a pipe holds MPI has begun, which makes large files of its own.
        job.stdin.write(poses[:-100])
        job.stdin.flush()
        resource.prlimit(job.pid, resource.RLIMIT_FSIZE, (20000, 20000))
        _, message = job.communicate(poses[-100:], timeout=60)
        self.assertEqual(job.returncode, 1, message)
        self.assertIn("out.part: it cannot be written: ", message)
        self.assertFalse(os.path.exists(self.path("out")))
        told = self.good(2, self.scene, self.path("more"), "--out", self.path("out"), "--share", "64")
        self.assertNotIn("from an earlier run 0\n", told)
        self.assertEqual(self.read("out"), self.read("whole"))

    def test_what_is_no_file_is_not_replaced(self):
        pipe = self.path("pipe")
        os.mkfifo(pipe)
        for name in ("out", "out.part", "out.part.sums"):
            os.symlink(pipe, self.path(name))
            self.refused("it is no regular file", self.scene, self.poses, "--out", self.path("out"))
            self.assertTrue(os.path.islink(self.path(name)))
            os.remove(self.path(name))

    def test_bad_input(self):
        out = ("--out", self.path("out"))
        self.refused("--out is needed", self.scene, self.poses)
        self.refused("none", self.path("none"), self.poses, *out)
        self.refused("none", self.scene, self.path("none"), *out)
        self.refused("bad:2: ", self.scene, self.file("bad", "# poses\n1 2 3\n"), *out)
        self.refused("bad:2: ", self.scene, self.file("bad", (IDENTITY + "\n1 2\n") % (0.0, 0.0, 0.0)), *out)
        # The words of a line were counted up to a zero byte, again and again.
        pose = IDENTITY % (0.0, 0.0, 0.0)
        for number, text in ((1, "\0"), (1, "\0\n" + pose), (1, "# a\0b\n" + pose), (1, pose + "\0"), (2, pose + "\n\0\0"),
                             (1, "1 2\0 3\n")):
            self.refused(f"nul:{number}: a zero byte", self.scene, self.file("nul", text), *out)
        self.refused("nul.txt:3: a zero byte", self.file("nul.txt", SCENE.replace("object", "obj\0ect", 1)), self.poses, *out)
        self.refused("--max-distance has no meaning for poses", self.scene, self.poses, "--max-distance", "1", *out)
        self.refused("one has to move", self.file("fixed.txt", SCENE.replace("object box\n", "object box fixed\n")), self.poses, *out)
        skewed = self.file("skewed", "2 0 0 0 0 1 0 0 0 0 1 0\n")
        done = self.run_sweep(2, self.scene, skewed, *out)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("orthonormal", done.stderr)

    def test_nothing_is_asked_of_an_empty_file(self):
        self.good(2, self.scene, self.file("empty", "# no poses\n"), "--out", self.path("out"))
        self.assertEqual(len(self.read("out").splitlines()), 1)

    def test_times_of_shares(self):
        self.good(2, self.scene, self.poses, "--out", self.path("out"), "--share", "64", "--times", self.path("times"))
        times = [float(line) for line in self.read("times").splitlines()]
        self.assertEqual(len(times), 16)
        self.assertTrue(all(time > 0 for time in times))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

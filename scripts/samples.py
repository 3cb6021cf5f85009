#!/usr/bin/env python3
"""Tests the samples of README.md, CONTRIBUTING.md and docs/*.md:  samples.py BUILD LIBRARIES

BUILD is a build folder with tests, LIBRARIES where Cargo puts the libraries. A sample is a block between lines of ```, and these
rules hold:

  ```c, ```cpp   stands word for word in the file that a comment before it names, <!-- sample: examples/hello.c -->; CTest runs that
  ```python      stands word for word in the file that a comment before it names; the test `python` runs it
  ```cmake       is a whole CMakeLists.txt: it is configured and built where hello.c is, with the installed library
  ```sh          is run, in a folder that looks like the project's, with the library installed in $HOME/swiftprox, in a shell that
                 knows what README.md exports and no more. What builds the project is not run again: of `make` the targets have to
                 be there
  ```text        is shown; behind <!-- prints: hello --> it is what that example prints, up to the last digits of numbers

Code that is indented and in no block is refused."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD, LIBRARIES = (os.path.abspath(path) for path in sys.argv[1:3])
NOTE = re.compile(r"<!-- (sample|prints): (\S+) -->")
# They build the project, which takes minutes; a build folder with tests is what they leave.
BUILDS = re.compile(r"(make|cargo|git clone|cmake -S|cmake --install)\b")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
DIGITS = 1e-9
IDENTITY = "1 0 0 0 0 1 0 0 0 0 1 0"
APART = "1 0 0 5 0 1 0 0 0 0 1 0"
INPUTS = {"POSES": f"{IDENTITY} {APART}\n", "MOTIONS": f"{IDENTITY} {APART} {IDENTITY} {IDENTITY}\n",
          "SCENE": "# swiftprox scene 1\nshape box A.off\nobject box\nobject box\nstep\n1 1 0 0 2.2 0 1 0 0 0 0 1 0\nstep\n1 1 0 0 2.1 0 1 0 0 0 0 1 0\n"}
# What is no program of its own: which is made of it.
PROGRAMS = {"examples/planner/arm.c": "arm_rrt", "examples/planner/arm_scene.c": "arm_scene"}
# What is there only where MPI, OMPL or a browser is: what follows in a block needs it.
OPTIONAL = ("build/tools/swiftprox-sweep", "build/examples/planner/ompl_planner", "scripts/page_picture.py")
# Open MPI, else: "detected an attempt to run as root", "not enough slots".
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}


def read(*parts):
    with open(os.path.join(ROOT, *parts), encoding="utf-8") as file:
        return file.read()


def pages():
    found = [os.path.join(folder, name) for folder in ("docs", "docs/research") for name in os.listdir(os.path.join(ROOT, folder))]
    return ["README.md", "CONTRIBUTING.md"] + sorted(page for page in found if page.endswith(".md"))


def exports():
    """What README.md tells a reader's shell, for good: the blocks of all pages are run after it."""
    return [line for line in read("README.md").splitlines() if line.startswith("export ")]


class Block:
    """A sample: where it stands, in which language, and what the comment before it says."""

    def __init__(self, place, language, note):
        self.place, self.language, self.note, self.lines = place, language, note, []

    @property
    def text(self):
        return "\n".join(self.lines) + "\n"


def blocks(page):
    """The samples of a page, and the lines of code outside of them."""
    found, strays, block, note, before = [], [], None, None, ""
    for number, line in enumerate(read(page).splitlines(), 1):
        place = f"{page}:{number}"
        if block and line == "```":
            found.append(block)
            block = None
        elif block:
            block.lines.append(line)
        elif line.startswith("```"):
            block = Block(place, line[3:], note)
        elif line.startswith("    ") and not before.strip():
            strays.append(place)
        note = NOTE.match(line).groups() if NOTE.match(line) else note if not line.strip() else None
        before = line
    return found, strays


def program_of(path):
    """The executable that an example is built to."""
    if path in PROGRAMS:
        return PROGRAMS[path]
    name, extension = os.path.splitext(os.path.relpath(path, "examples"))
    return name.replace("/", "_") + ("_cpp" if extension == ".cpp" else "")


def same(shown, printed):
    """The same words, and the same numbers up to their last digits."""
    if NUMBER.sub("0", shown) != NUMBER.sub("0", printed):
        return False
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed))
    return all(abs(float(a) - float(b)) <= DIGITS * max(abs(float(a)), abs(float(b))) for a, b in pairs)


class Samples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.blocks = []
        for page in pages():
            found, strays = blocks(page)
            if strays:
                raise AssertionError(f"indented code; put it between lines of ```: {strays}")
            cls.blocks += found
        cls.home = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, cls.home)
        cls.prefix = os.path.join(cls.home, "swiftprox")
        subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.prefix], check=True, capture_output=True)
        cls.environment = {**os.environ, **MPI, "HOME": cls.home}
        for name in ("PKG_CONFIG_PATH", "LD_LIBRARY_PATH"):
            cls.environment.pop(name, None)

    def of(self, *languages):
        found = [block for block in self.blocks if block.language in languages]
        self.assertTrue(found, languages)
        return found

    def run_in(self, folder, *command):
        done = subprocess.run(command, cwd=folder, env=self.environment, capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")
        return done.stdout

    def test_installed_pages_have_no_dead_link(self):
        folder, count = os.path.join(self.prefix, "share", "doc", "swiftprox"), 0
        for here, _, names in os.walk(folder):
            for name in (name for name in names if name.endswith(".md")):
                with open(os.path.join(here, name), encoding="utf-8") as file:
                    targets = re.findall(r"\]\(([^)#]+)", file.read())
                for target in (target for target in targets if not target.startswith("http")):
                    self.assertTrue(os.path.exists(os.path.join(here, target)), f"{name} links to {target}")
                    count += 1
        self.assertGreater(count, 80)

    def test_languages_are_known(self):
        for block in self.blocks:
            self.assertIn(block.language, ("c", "cpp", "cmake", "sh", "text", "python"), block.place)

    def test_code_is_that_of_examples_which_are_run(self):
        tests = json.loads(self.run_in(BUILD, "ctest", "--show-only=json-v1"))["tests"]
        run = {os.path.basename(test["command"][0]) for test in tests if "command" in test}
        for block in self.of("c", "cpp"):
            self.assertTrue(block.note and block.note[0] == "sample", f"{block.place}: no comment says which file it is from")
            path = block.note[1]
            self.assertIn(block.text, read(path), f"{block.place} is not in {path}")
            self.assertIn(program_of(path), run, f"{block.place}: no test runs {path}")

    def test_python_is_that_of_examples(self):
        for block in self.of("python"):
            self.assertTrue(block.note and block.note[0] == "sample", f"{block.place}: no comment says which file it is from")
            self.assertIn(block.text, read(block.note[1]), f"{block.place} is not in {block.note[1]}")

    def test_examples_print_what_is_shown(self):
        for block in self.of("text"):
            if block.note:
                printed = self.run_in(self.home, os.path.join(BUILD, "examples", block.note[1]))
                self.assertTrue(same(block.text, printed), f"{block.place}\n{block.text}{printed}")

    def test_projects_of_cmake_find_the_library(self):
        for index, text in enumerate(sorted({block.text for block in self.of("cmake")})):
            folder = os.path.join(self.home, f"project{index}")
            os.mkdir(folder)
            shutil.copy(os.path.join(ROOT, "examples", "hello.c"), folder)
            with open(os.path.join(folder, "CMakeLists.txt"), "w", encoding="utf-8") as file:
                file.write(text)
            self.run_in(folder, "cmake", "-S", ".", "-B", "build", "-DCMAKE_PREFIX_PATH=" + self.prefix)
            self.run_in(folder, "cmake", "--build", "build")
            self.assertIn("distance 1.15", self.run_in(folder, "build/hello"))

    def project(self):
        """A folder that looks like the project's, built, and the files that pages take for examples."""
        folder = tempfile.mkdtemp(dir=self.home)
        for name in ("examples", "include", "docs", "benches", "tests"):
            os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))
        os.symlink(BUILD, os.path.join(folder, "build"))
        os.mkdir(os.path.join(folder, "target"))
        os.symlink(LIBRARIES, os.path.join(folder, "target", "release"))
        for name, model in (("A.off", "box.off"), ("B.obj", "prism.obj")):
            shutil.copy(os.path.join(ROOT, "examples", "models", model), os.path.join(folder, name))
        for name, text in INPUTS.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        return folder

    def check_make(self, line):
        """Its targets and variables are those of the Makefile."""
        makefile = read("Makefile")
        for word in line.split("#")[0].split()[1:]:
            name = word.split("=")[0]
            wanted = rf"\$\({name}\)|\$\(if \$\({name}\)" if "=" in word else rf"^{name}:"
            self.assertRegex(makefile, re.compile(wanted, re.MULTILINE), line)

    def test_commands_run(self):
        static = subprocess.run("echo 'int main(void) { return 0; }' | cc -static -x c - -o /dev/null", shell=True, capture_output=True)
        folders = {}
        for block in self.of("sh"):
            page = block.place.split(":")[0]
            folders[page] = folders.get(page) or self.project()
            script = ["set -eu", *(exports() if page != "README.md" else [])]
            for line in block.lines:
                if line.startswith("make "):
                    self.check_make(line)
                if BUILDS.match(line) or (" -static " in line and static.returncode != 0):
                    continue
                if any(part in line and not os.path.exists(os.path.join(folders[page], part)) for part in OPTIONAL):
                    break
                script.append(line)
            with self.subTest(block.place):
                self.run_in(folders[page], "bash", "-c", "\n".join(script))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

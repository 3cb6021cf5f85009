#!/usr/bin/env python3
"""Compares the sizes that docs/install.md states with those of a build:  test_sizes.py CC LIBRARIES INCLUDE NEEDS...

LIBRARIES are the libraries as installed, NEEDS what a static program links besides. Sizes differ from compiler to compiler: a page is
wrong that is off by more than a sixth."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

CC, LIBRARIES, INCLUDE = sys.argv[1:4]
NEEDS = sys.argv[4:]
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
MEGABYTE, TOLERANCE = 1e6, 1 / 6
COLLECTING = "-Wl,--gc-sections"


def megabytes(*path):
    return os.path.getsize(os.path.join(*path)) / MEGABYTE


def hello(*options):
    """The size of examples/hello.c with the static library, or None where it cannot be linked so."""
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, "hello")
        done = subprocess.run([CC, "-std=c99", os.path.join(ROOT, "examples", "hello.c"), "-I" + INCLUDE, os.path.join(LIBRARIES, "libswiftprox.a"),
                               *options, "-o", program], capture_output=True)
        return megabytes(program) if done.returncode == 0 else None


class Sizes(unittest.TestCase):
    def test_the_page_says_what_the_files_have(self):
        with open(os.path.join(ROOT, "docs", "install.md"), encoding="utf-8") as page:
            text = page.read()
        table = re.search(r"\| what, on x86-64 \| MB \|\n\|---\|--:\|\n((?:\|.*\n)+)", text)[1]
        said = [float(row.rstrip("| ").rpartition("|")[2]) for row in table.splitlines()]
        said.append(float(re.search(r"Without it `hello` has ([\d.]+) MB", text)[1]))
        without = [need for need in NEEDS if need != COLLECTING]
        self.assertNotEqual(without, NEEDS)
        found = [megabytes(LIBRARIES, "libswiftprox.a"), megabytes(LIBRARIES, "libswiftprox.so"),
                 hello(*NEEDS), hello("-static", *NEEDS), hello(*without)]
        self.assertEqual(len(said), len(found))
        off = [(page, size) for page, size in zip(said, found) if size is not None and abs(size - page) > TOLERANCE * page]
        self.assertEqual(off, [], "said and found, of all: %s %s" % (said, found))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

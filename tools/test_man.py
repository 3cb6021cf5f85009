#!/usr/bin/env python3
"""Tests the manual pages of the tools:  test_man.py FOLDER TOOL ...

The folder has tools and pages. Each page has every word of --help, and groff and man, where they are installed, read it without a
warning."""
import os
import re
import shutil
import subprocess
import sys
import unittest

FOLDER, *TOOLS = sys.argv[1:]


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True, env={**os.environ, "MANWIDTH": "200", "LC_ALL": "C.UTF-8"})


def words(text):
    return re.findall(r"[\w/|-]+", text)


class ManualPages(unittest.TestCase):
    def test_every_word_of_help_is_there(self):
        for tool in TOOLS:
            with open(os.path.join(FOLDER, tool + ".1"), encoding="utf-8") as file:
                page = file.read()
            for roff, character in ((r"\fB", ""), (r"\fI", ""), (r"\fR", ""), (r"\-", "-"), (r"\&", "")):
                page = page.replace(roff, character)
            text = run(os.path.join(FOLDER, tool), "--help").stdout
            self.assertGreater(len(re.findall(r"^  --", text, re.MULTILINE)), 5)
            lacking = set(words(text.removeprefix("usage: "))) - set(words(page))
            # Headings of sections have these words otherwise.
            self.assertEqual(lacking - {"Exit", "status"}, set(), tool)

    def test_readers_have_no_warnings(self):
        commands = [command for command in (("groff", "-ww", "-man", "-Tutf8"), ("man", "--warnings", "-l")) if shutil.which(command[0])]
        if not commands:
            self.skipTest("neither groff nor man is installed")
        for tool in TOOLS:
            for command in commands:
                read = run(*command, os.path.join(FOLDER, tool + ".1"))
                self.assertEqual(read.stderr, "", command)
                self.assertIn("EXIT STATUS", re.sub(".\x08", "", read.stdout), command)  # bold is a letter typed twice


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

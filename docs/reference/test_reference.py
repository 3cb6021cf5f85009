#!/usr/bin/env python3
"""Tests the HTML that Doxygen makes:  test_reference.py FOLDER

It is made there, without a warning. Its links lead somewhere. Each declaration of the C headers stands in a group, and each group of
include/contents.txt in one by use."""
import os
import re
import subprocess
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
FOLDER = sys.argv[1]


def read(*parts):
    with open(os.path.join(*parts), encoding="utf-8", errors="replace") as file:
        return file.read()


class Reference(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        made = subprocess.run([os.path.join(HERE, "make.sh"), FOLDER], capture_output=True, text=True)
        if made.returncode != 0:
            raise AssertionError(made.stdout + made.stderr)
        html = os.path.join(FOLDER, "html")
        cls.files = {name: read(html, name) for name in os.listdir(html) if name.endswith(".html")}

    def test_links_lead_somewhere(self):
        anchors = {name: set(re.findall(r'(?:id|name)="([^"]+)"', text)) for name, text in self.files.items()}
        count = 0
        for name, text in self.files.items():
            for link in re.findall(r'(?:href|src|data)="([^"]+)"', text):
                if re.match("https?:|javascript:", link):
                    continue
                target, _, anchor = link.partition("#")
                target = target or name
                self.assertTrue(os.path.exists(os.path.join(FOLDER, "html", target)), f"{name} links to {link}")
                if anchor and target in anchors:
                    self.assertIn(anchor, anchors[target], f"{name} links to {link}")
                count += 1
        self.assertGreater(count, 1000)

    def test_each_declaration_is_in_a_group(self):
        groups = "".join(text for name, text in self.files.items() if name.startswith("group__swiftprox__"))
        shown = set(re.findall(r"(\w+)\s*</(?:a|td)>", groups))
        names = [line for line in read(ROOT, "include", "contents.txt").splitlines() if re.fullmatch(r"\w+", line)]
        self.assertGreater(len(names), 150)
        self.assertEqual([name for name in names if name not in shown], [])

    def test_each_group_is_in_one_by_use(self):
        groups = re.findall(r"^group (\w+) ", read(ROOT, "include", "contents.txt"), re.MULTILINE)
        by_use = re.findall(r"@addtogroup swiftprox_(\w+)\n \*  @ingroup use_\w+", read(HERE, "groups.dox"))
        self.assertEqual(sorted(groups), sorted(by_use))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

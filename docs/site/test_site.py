#!/usr/bin/env python3
"""Tests that all links of the site lead somewhere, anchors included:

  test_site.py FOLDER        the site in the folder; where Chromium is, that no page is wider than the window, too: PICTURES=DIR
                             keeps pictures of them
  test_site.py               the pages alone, made in a folder of their own

Status 77, with the reason, where Python lacks what makes the pages."""
import html.parser
import os
import re
import shutil
import sys
import tempfile
import unittest
import urllib.parse

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))
import browser  # noqa: E402

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else None
PAGES_ALONE = FOLDER is None
BROWSER = os.environ.get("BROWSER", "chromium")
OTHERS = re.compile(r"reference/|crowd\.html$")
# Rustdoc's own scripts make these: lines of a source, and a part of a page that opens when its link is clicked.
BY_SCRIPT = re.compile(r"\d+-\d+$|impl-")


class Links(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.anchors, self.targets = {"", "top"}, []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name"):
                self.anchors.add(value)
            elif name in ("href", "src", "data") and tag not in ("base", "meta") and value:
                self.targets.append(value)


def dead_links(folder):
    """Links that lead nowhere, as (page, link); and how many there are altogether."""
    pages = {}
    for place, _, names in os.walk(folder):
        for name in names:
            if name.endswith(".html"):
                path = os.path.join(place, name)
                with open(path, encoding="utf-8", errors="replace") as file:
                    pages[path] = Links(file.read())
    dead, count = [], 0
    for path, page in pages.items():
        for link in page.targets:
            # A trait's script of implementors: rustdoc names it, and writes it only where there are some.
            if re.match(r"\w+:|//", link) or "/trait.impl/" in link:
                continue
            file, _, anchor = urllib.parse.unquote(link).partition("#")
            target = os.path.normpath(os.path.join(os.path.dirname(path), file.partition("?")[0])) if file else path
            count += 1
            there = os.path.isfile(target)
            if not there or target in pages and anchor not in pages[target].anchors and not BY_SCRIPT.match(anchor):
                dead.append((os.path.relpath(path, folder), link))
    return dead, count


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = FOLDER
        if PAGES_ALONE:
            folder = tempfile.TemporaryDirectory()
            cls.addClassCleanup(folder.cleanup)
            cls.folder = folder.name
            pages.Site(cls.folder).make()

    def test_links_lead_somewhere(self):
        dead, count = dead_links(self.folder)
        self.assertEqual(dead, [])
        self.assertGreater(count, 1000)

    @unittest.skipIf(PAGES_ALONE or not shutil.which(BROWSER), "no Chromium, or the pages alone")
    def test_no_page_is_wider_than_the_window(self):
        own = [os.path.join(place, name) for place, _, names in os.walk(self.folder) for name in names if name.endswith(".html")]
        own = sorted(path for path in own if not OTHERS.match(os.path.relpath(path, self.folder)))
        self.assertGreater(len(own), 30)
        with browser.Browser() as tab:
            for width in (1280, 390):
                tab.resize(width, 900)
                for path in own:
                    tab.open("file://" + os.path.abspath(path))
                    self.assertLessEqual(tab.run("document.documentElement.scrollWidth"), width, path)
                    self.keep(tab, path, width)

    def keep(self, tab, path, width):
        folder = os.environ.get("PICTURES")
        if folder:
            name = os.path.relpath(path, self.folder)[:-len(".html")].replace("/", "-")
            with open(os.path.join(folder, f"{name}-{width}.png"), "wb") as file:
                file.write(tab.screenshot())

    def test_dead_links_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "a.html"), "w") as file:
                file.write('<h1 id="here"></h1><a href="#here"></a><a href="#there"></a><img src="b.svg"><a href="https://x"></a>')
            self.assertEqual(dead_links(folder), ([("a.html", "#there"), ("a.html", "b.svg")], 3))


if __name__ == "__main__":
    if PAGES_ALONE:
        try:
            import pages
        except ImportError as error:
            print(f"skipped: {error.name} is not installed (Debian: python3-markdown-it, python3-pygments)")
            sys.exit(77)
    unittest.main(argv=sys.argv[:1])

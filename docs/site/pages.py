#!/usr/bin/env python3
"""The pages as HTML:  pages.py FOLDER

README.md becomes index.html. Whatever a page links to comes along: pages, sources with colours, all other files as they are. The
bar above each page leads to the parts of the site that the folder has."""
import html
import os
import posixpath
import re
import shutil
import sys

from markdown_it import MarkdownIt
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import get_lexer_by_name, get_lexer_for_filename
from pygments.util import ClassNotFound

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
BAR = (("guides", "docs/index.html"), ("C", "reference/c/index.html"), ("C++", "reference/c/namespaceswiftprox.html"),
       ("Rust", "reference/rust/swiftprox/index.html"), ("Python", "reference/python/swiftprox.html"),
       ("benchmarks", "docs/benchmarks.html"), ("a crowd in 3-D", "crowd.html"))
# What browsers show, or what nobody wants in colours.
AS_THEY_ARE = (".csv", ".svg", ".png", ".json", ".obj", ".off", ".txt")
COLOURS = HtmlFormatter(style="tango", nowrap=True)
PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<link rel="stylesheet" href="{up}site.css">
</head>
<body>
<header><a href="{up}index.html">swiftprox</a> <span>{version}</span> <nav>{bar}</nav></header>
<div class="page">
<main>
{body}</main>
<nav class="side">{side}</nav>
</div>
</body>
</html>
"""


def read(path):
    """A page, without badges: their addresses hold only where the repository is."""
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return re.sub(r"^\[!\[.*\n", "", file.read(), flags=re.MULTILINE)


def colours(code, language):
    try:
        return highlight(code, get_lexer_by_name(language), COLOURS) if language else ""
    except ClassNotFound:
        return ""


def address(path):
    """Where the site has a file of the repository; none: nowhere."""
    full = os.path.join(ROOT, path)
    if path == "README.md":
        return "index.html"
    if path.endswith(".md"):
        return path[:-3] + ".html"
    if not os.path.isfile(full):
        return None
    return path if path.endswith(AS_THEY_ARE) else path + ".html"


def title(page):
    return re.search("^# (.*)", read(page), re.MULTILINE)[1]


def slug(words, taken):
    """The anchor of a heading, as GitHub makes it."""
    name = re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", "-")
    taken[name] = taken.get(name, -1) + 1
    return f"{name}-{taken[name]}" if taken[name] else name


class Site:
    def __init__(self, folder):
        self.folder = folder
        self.version = re.search(r'^version = "(.*)"', read("Cargo.toml"), re.MULTILINE)[1]
        self.reader = MarkdownIt("commonmark", {"highlight": lambda code, language, _: colours(code, language)}).enable("table")
        self.reader.add_render_rule("table_open", lambda *_: '<div class="wide"><table>\n')
        self.reader.add_render_rule("table_close", lambda *_: "</table></div>\n")
        self.groups = self.contents()

    def contents(self):
        """The tables of docs/index.md: a heading and pages with their titles each."""
        groups = []
        for line in read("docs/index.md").splitlines():
            if heading := re.fullmatch(r"\| ([\w ]+) \| \|", line):
                groups.append((heading[1], []))
            elif link := re.match(r"\| \[.*?\]\((.*?)\)", line):
                path = posixpath.normpath("docs/" + link[1])
                groups[-1][1].append((path, title(path)))
        return groups

    def frame(self, path, heading, body):
        up = "../" * path.count("/")
        bar = " ".join(f'<a href="{up}{target}">{name}</a>' for name, target in BAR if self.has(target))
        side = ""
        for group, pages in self.groups:
            rows = "".join(f'<li><a href="{up}{address(page)}">{html.escape(words)}</a></li>' for page, words in pages)
            side += f"<h2>{group}</h2><ul>{rows}</ul>"
        self.write(path, PAGE.format(title=html.escape(heading), up=up, bar=bar, side=side, body=body, version=self.version))

    def has(self, target):
        """Whether this part of the site is made, or is a page."""
        return target.startswith("docs/") or os.path.exists(os.path.join(self.folder, *target.split("/")[:2]))

    def write(self, path, text):
        place = os.path.join(self.folder, path)
        os.makedirs(os.path.dirname(place), exist_ok=True)
        with open(place, "w", encoding="utf-8") as file:
            file.write(text)

    def relink(self, page, target, found):
        """A link of a page as it is in the site; none: nothing is there."""
        if re.match(r"\w+:|#", target):
            return target
        file, mark, anchor = target.partition("#")
        path = posixpath.normpath(posixpath.join(posixpath.dirname(page), file))
        if os.path.isdir(os.path.join(ROOT, path)):
            path = next((p for p in (path + "/index.md", path + "/README.md") if os.path.exists(os.path.join(ROOT, p))), path)
        place = address(path)
        if place is None:
            return None
        found.append(path)
        return posixpath.relpath(place, posixpath.dirname(address(page)) or ".") + mark + anchor

    def page(self, path):
        """Writes a page; returns the files that it links to."""
        found, taken = [], {}
        tokens = self.reader.parse(read(path))
        for token, inside in zip(tokens, tokens[1:] + tokens[-1:]):
            if token.type == "heading_open":
                token.attrSet("id", slug("".join(child.content for child in inside.children), taken))
            elif token.type == "html_block" and token.content.startswith("<!--"):
                token.content = ""
            elif token.type == "inline":
                token.children = list(self.shown(path, token.children, found))
        self.frame(address(path), title(path), self.reader.renderer.render(tokens, self.reader.options, {}))
        return found

    def shown(self, path, children, found):
        """What stands in a line, with links as they are in the site. Of a link that leads nowhere the words stay, and a page that
        is called by its file has its title."""
        leads, named = True, None
        for child in children:
            if child.type == "link_open":
                target = self.relink(path, child.attrGet("href"), found)
                leads = target is not None
                named = found[-1] if leads and found and child.attrGet("href").endswith(".md") else None
                child.attrSet("href", target)
            elif child.type == "image":
                child.attrSet("src", self.relink(path, child.attrGet("src"), found))
            elif child.type == "text" and named and child.content.endswith(".md"):
                child.content = title(named)
            if leads or child.type not in ("link_open", "link_close"):
                yield child
            if child.type == "link_close":
                leads, named = True, None

    def source(self, path):
        text = read(path)
        try:
            text = highlight(text, get_lexer_for_filename(path), COLOURS)
        except ClassNotFound:
            text = html.escape(text)
        self.frame(address(path), path, f"<h1>{html.escape(path)}</h1>\n<pre><code>{text}</code></pre>\n")

    def make(self):
        waiting, done = ["README.md", "docs/index.md"] + [page for _, pages in self.groups for page, _ in pages], set()
        while waiting:
            path = waiting.pop()
            if path in done:
                continue
            done.add(path)
            if path.endswith(".md"):
                waiting += self.page(path)
            elif path.endswith(AS_THEY_ARE):
                place = os.path.join(self.folder, path)
                os.makedirs(os.path.dirname(place), exist_ok=True)
                shutil.copyfile(os.path.join(ROOT, path), place)
            else:
                self.source(path)
        with open(os.path.join(HERE, "site.css"), encoding="utf-8") as file:
            self.write("site.css", file.read() + COLOURS.get_style_defs("pre"))
        return done


if __name__ == "__main__":
    made = Site(sys.argv[1]).make()
    print(f"{sys.argv[1]}: {sum(path.endswith('.md') for path in made)} pages, {len(made)} files")

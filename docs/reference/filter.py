#!/usr/bin/env python3
"""What Doxygen reads of a file:  filter.py FILE

Of a page: pictures by their names alone, as Doxygen looks for them; and only those links that lead to other pages or to headers, as
the HTML has no other files. Of a header: comments that Doxygen would take for plain ones."""
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)]*)\)")
LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)]*)\)")


def is_shown(target, folder):
    """Whether the HTML has it."""
    if target.startswith(("http", "#")):
        return True
    path = os.path.relpath(os.path.join(folder, target.split("#")[0]), ROOT)
    return path.endswith(".md") and os.path.dirname(path) in ("", "docs", os.path.join("docs", "research"))


def page(text, folder):
    def link(found):
        words, target = found.groups()
        if target.split("#")[0].endswith(("swiftprox.h", "swiftprox.hpp")):
            return os.path.basename(target)
        if is_shown(target, folder):
            # An anchor of a page, by the name that Doxygen gives it, is left to the reader's eyes.
            return f"[{words}]({target if target.startswith('http') else target.split('#')[0]})"
        return words

    text = PICTURE.sub(lambda found: f"![{found[1]}]({os.path.basename(found[2])})", text)
    return LINK.sub(link, text)


def header(text, name):
    text = re.sub(r"\A/\*", rf"/** @file {name}\n *", text)
    return re.sub(r"^( *)/\*(?= |$)", r"\1/**", text, flags=re.MULTILINE) if name == "SWIFT.h" else text


def main():
    path = os.path.abspath(sys.argv[1])
    with open(path, encoding="utf-8") as file:
        text = file.read()
    folder, name = os.path.split(path)
    if name.endswith(".md"):
        text = page(text, folder)
    elif name.endswith((".h", ".hpp")):
        text = header(text, name)
    sys.stdout.write(text)


if __name__ == "__main__":
    main()

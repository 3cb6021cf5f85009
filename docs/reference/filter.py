#!/usr/bin/env python3
"""What Doxygen reads of a header:  filter.py FILE

Comments that Doxygen would take for plain ones are marked."""
import os
import re
import sys


def header(text, name):
    text = re.sub(r"\A/\*", rf"/** @file {name}\n *", text)
    return re.sub(r"^( *)/\*(?= |$)", r"\1/**", text, flags=re.MULTILINE) if name == "SWIFT.h" else text


def main():
    path = sys.argv[1]
    with open(path, encoding="utf-8") as file:
        text = file.read()
    sys.stdout.write(header(text, os.path.basename(path)) if path.endswith((".h", ".hpp")) else text)


if __name__ == "__main__":
    main()

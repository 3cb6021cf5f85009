#!/usr/bin/env python3
"""Writes a tool's manual page from what its --help prints:  man.py PAGE TOOL ...

--help is the one source. A first paragraph says what the tool does. A line that begins with two spaces is a term, and behind two more
what it means; lines that follow deeper go on. A line behind two spaces without a meaning is shown as it stands."""
import re
import subprocess
import sys

TERM = re.compile(r"  (\S+(?: \S+)*)  +(\S+(?: \S+)*)$")


def escape(text):
    """As roff wants it. A hyphen between letters is one; all others are typed by whoever copies them."""
    text = text.replace("\\", "\\e")
    text = re.sub(r"(?<![^\W\d])-|-(?![^\W\d])", r"\\-", text)
    return "\\&" + text if text.startswith((".", "'")) else text


def emphasise(text):
    """Options and their values in a synopsis or a term."""
    text = re.sub(r"(?<!\S)(\[?)(\\-\\-[a-z-]+)", r"\1\\fB\2\\fR", escape(text))
    return re.sub(r"\b([A-Z]+)\b(?!\\fR)", r"\\fI\1\\fR", text)


def paragraphs(text):
    return [block.splitlines() for block in re.split(r"\n\s*\n", text.strip("\n"))]


def body(lines):
    """The lines of a paragraph in roff."""
    page = []
    column = None  # where the meaning of the last term stands
    for line in lines:
        indent = len(line) - len(line.lstrip())
        term = TERM.match(line)
        if indent == 0:
            page += [".PP", escape(line)] if column else [escape(line)]
            column = None
        elif term:
            page += [".TP", emphasise(term[1]), escape(term[2])]
            column = term.start(2)
        elif column and indent == column:
            page.append(escape(line.strip()))
        else:
            page += [".nf", escape(line[column or 2:]), ".fi"]
    return "\n".join(page).replace("\n.fi\n.nf\n", "\n").splitlines()


def page_of(name, version, help_text):
    usage, *rest = paragraphs(help_text)
    what, *rest = rest
    summary = " ".join(what).rstrip(".")
    synopsis = " ".join(" ".join(usage).removeprefix("usage: " + name).split())
    page = [f'.TH {name.upper()} 1 "" "swiftprox {version}" "User Commands"',
            ".SH NAME", f"{name} \\- {escape(summary[0].lower() + summary[1:])}",
            ".SH SYNOPSIS", ".ad l", f"\\fB{escape(name)}\\fR", emphasise(synopsis), ".ad b",
            ".SH DESCRIPTION", *map(escape, what)]
    section = "DESCRIPTION"
    for lines in rest:
        wanted = section
        if re.match(r"  (?:--|[A-Z])", lines[0]):
            wanted = "OPERANDS AND OPTIONS"
        elif lines[0].startswith("Exit status: "):
            wanted = "EXIT STATUS"
            lines = [lines[0].removeprefix("Exit status: "), *lines[1:]]
        elif section != "DESCRIPTION":
            wanted = "OUTPUT"
        page += [".PP"] if wanted == section else [f".SH {wanted}"]
        page += body(lines)
        section = wanted
    return "\n".join(page + [".SH SEE ALSO", "The page tools.md of the documentation of swiftprox, with examples."]) + "\n"


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main():
    path, *tool = sys.argv[1:]  # a command, for tools that an emulator runs
    name, version = output_of(*tool, "--version").split()
    text = page_of(name, version, output_of(*tool, "--help"))
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()

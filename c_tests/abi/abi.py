#!/usr/bin/env python3
"""Watches the binary interface that the headers declare.

usage: abi.py [--cc CC] HEADERS FORMER DUMP CHANGELOG

    HEADERS    the folder of today's headers
    FORMER     that of the headers that programs were compiled with before
    DUMP       what abidw says of today's, as committed; BLESS=1 in the environment rewrites it

Fails where today's interface is not that of the dump; where a program compiled with the former headers would not find what it
calls, or find it with other arguments; and where CHANGELOG.md does not name, for this version, what has changed since.

What abidw reads is no library: Rust's debug information says nothing about C. It is a stand-in, compiled by a C compiler from the
headers, with a body for each function. tests/project/ compares the library with the headers: its symbols, and its structs.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile

# abidiff's status, as bits.
FAILED, INCOMPATIBLE = 3, 8
DUMPED = ("--drop-private-types", "--no-show-locs", "--no-corpus-path", "--no-comp-dir-path", "--no-elf-needed",
          "--no-write-default-sizes")

# What abidiff writes of changes that a program compiled before would run into. The rest is added, or at the end of a struct; and a
# number of 32 bits may get a sign, which it does without where it is 0 or 1.
SIGNED = "type name changed from 'unsigned int' to 'int'"
BREAKS = re.compile(rf"data member deletion|offset changed|enumerator (deletion|change)|(?!{SIGNED})(type name|entity) changed"
                    r"|was (added|removed)|^  \[D\]", re.MULTILINE)


def run(*command):
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode:
        sys.exit(f"{' '.join(command)}: {result.stderr or result.stdout}")
    return result.stdout


def stand_in(cc, headers, folder, name):
    """A shared library with the functions that the headers declare. Its name is the same for all: it is a part of the interface."""
    text = run(cc, "-E", "-P", "-DSWIFTPROX_NODISCARD=", "-x", "c", os.path.join(headers, "swiftprox_tuning.h"))
    functions = re.findall(r"^((?!typedef)[a-z][^;{}]*?\bswiftprox_\w+\([^;{}]*\));", text, re.MULTILINE)
    os.mkdir(os.path.join(folder, name))
    source, library = (os.path.join(folder, name, file) for file in ("stand_in.c", "libswiftprox.so"))
    with open(source, "w") as file:
        file.write('#include "swiftprox_tuning.h"\n')
        file.writelines(re.sub(r"\s+", " ", function) + " { for (;;) { } }\n" for function in functions)
    run(cc, "-w", "-g", "-O0", "-shared", "-fPIC", "-I", headers, source, "-o", library)
    return library


def difference(headers, old, new):
    """What abidiff says, and its status."""
    result = subprocess.run(["abidiff", "--harmless", "--headers-dir1", headers, "--headers-dir2", headers, old, new],
                            capture_output=True, text=True)
    if result.returncode & FAILED:
        sys.exit(f"abidiff: {result.stderr or result.stdout}")
    return result.stdout, result.returncode


def grown(report):
    """The structs that abidiff reports of another size."""
    return sorted(set(re.findall(r"type 'struct (\w+)'[^\n]*\n\s+type size changed", report)))


def may_grow(headers, name):
    """Whether a struct begins with its size."""
    for file in ("swiftprox.h", "swiftprox_tuning.h"):
        with open(os.path.join(headers, file)) as opened:
            code = re.sub(r"/\*.*?\*/", "", opened.read(), flags=re.DOTALL)
        if re.search(rf"typedef struct {name} {{\s*size_t struct_size;", code):
            return True
    return False


def told(changelog):
    """What CHANGELOG.md tells of the newest version, and what of that under `ABI`."""
    with open(changelog) as file:
        newest = file.read().split("\n## ")[1]
    parts = newest.split("\n### ABI\n")
    if len(parts) != 2 or not parts[1].strip():
        sys.exit(f"{changelog} has no words under `### ABI` for its newest version, {newest.splitlines()[0]}")
    return newest, parts[1]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cc", default="cc")
    for name in ("headers", "former", "dump", "changelog"):
        parser.add_argument(name)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        now = stand_in(given.cc, given.headers, folder, "now")
        if os.environ.get("BLESS"):
            with open(given.dump, "w") as file:
                file.write(run("abidw", *DUMPED, "--headers-dir", given.headers, now))
        report, status = difference(given.headers, given.dump, now)
        if status:
            sys.exit(f"{report}\nThe interface is not that of {given.dump}. Where it is to change, tell it in CHANGELOG.md under ABI, "
                     "then rewrite the file: BLESS=1 ctest -R abi_dump")

        newest, abi = told(given.changelog)
        report, status = difference(given.headers, stand_in(given.cc, given.former, folder, "former"), now)
        larger = grown(report)
        if status & INCOMPATIBLE or BREAKS.search(report) or not all(may_grow(given.headers, name) for name in larger):
            sys.exit(f"{report}\nPrograms compiled with {given.former} no longer run.")
        added = re.findall(r"^  \[A\] .*\{(\w+)\}$", report, re.MULTILINE)
        # An _init_sized function comes with its struct.
        missing = [name for name in added if f"`{name}`" not in newest and not name.endswith("_init_sized")]
        missing += [name for name in larger if f"`{name}`" not in abi]
        if missing:
            sys.exit(f"{given.changelog} does not name {', '.join(missing)}, which changed since {given.former}")
        print(f"{len(added)} functions added since the former headers, structs grown: {', '.join(larger)}; all are told")


if __name__ == "__main__":
    main()

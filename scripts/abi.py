#!/usr/bin/env python3
"""Whether programs linked with the last tagged version run with this one:  abi.py [TAG]

Compares the stable declarations of the C headers, as include/contents.txt has them: functions, callbacks, enumerators, constants,
and the layouts of c_tests/abi/layout.h. What is new may be new; what was there stays, but for structs that know their size and grow
at their end. Before the first tag there is nothing to compare, nor across versions whose libraries have different names."""
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LAYOUT = "c_tests/abi/layout.h"
# They name the version itself.
VERSIONS = re.compile(r"SWIFTPROX_VERSION_")


def read_here(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=True).stdout


def of_tag(tag):
    return lambda path: git("show", f"{tag}:{path}")


def interface_version(read):
    """What the name of the shared library has: build.rs."""
    major, minor = re.search(r'^version = "(\d+)\.(\d+)', read("Cargo.toml"), re.MULTILINE).groups()
    return f"0.{minor}" if major == "0" else major


def without_name(parameter):
    """A parameter's type: its name may change."""
    return re.sub(r"(?<=[\s*])\w+(?=(\[\w*\])*$)", "", parameter.strip())


def surface(read):
    """All declarations, as texts by name and member or enumerator, and the names of the stable ones."""
    headers, stable, is_stable = [], set(), False
    for line in read("include/contents.txt").splitlines():
        if line.startswith("header "):
            headers.append(read("include/" + line.split()[1]))
        elif line.startswith("group "):
            is_stable = line.split()[2] == "stable"
        elif is_stable and re.fullmatch(r"\w+", line):
            stable.add(line)
    text = re.sub(r"/\*.*?\*/", "", "\n".join(headers), flags=re.DOTALL)
    found = {}
    for returned, name, parameters in re.findall(r"^([\w ]+[\s*]+)(swiftprox_\w+)\(([^()]*)\);", text, re.MULTILINE):
        types = ", ".join(" ".join(without_name(p).split()) for p in parameters.split(","))
        found[name, ""] = f"{' '.join(returned.split())} ({types})"
    for declaration, name in re.findall(r"^(typedef [^;{}]*\(\*(swiftprox_\w+)\)[^;]*);", text, re.MULTILINE):
        found[name, ""] = " ".join(declaration.split())
    for name, body in re.findall(r"^typedef enum (swiftprox_\w+)[^{;]*\{(.*?)\}", text, re.MULTILINE | re.DOTALL):
        found.update({(name, enumerator): value for enumerator, value in re.findall(r"(\w+) = ([^,\s]+)", body)})
    for name, value in re.findall(r"^#define (SWIFTPROX_\w+) +([\w.+-]+)$", text, re.MULTILINE):
        if not VERSIONS.match(name):
            found[name, ""] = value
    layout = read(LAYOUT)
    grow = {name for name in re.findall(r"MEMBER\((\w+), struct_size, 0,", layout)}
    for name, size, alignment in re.findall(r"^STRUCT\((\w+), (\d+), (\d+)\)", layout, re.MULTILINE):
        found[name, ""] = f"alignment {alignment}" if name in grow else f"size {size}, alignment {alignment}"
    for name, member, offset, size in re.findall(r"^MEMBER\((\w+), (\w+), (\d+), (\d+)\)", layout, re.MULTILINE):
        found[name, member] = f"offset {offset}, size {size}"
    return found, stable


def breaks(before, now):
    """What a program of before would miss now; each argument reads a file."""
    (old, stable), (new, _) = surface(before), surface(now)
    if not stable or len(old) < len(stable):
        raise ValueError("the headers are not understood")
    return [f"{name}{'.' + part if part else ''}: {text} -> {new.get((name, part), 'gone')}"
            for (name, part), text in sorted(old.items()) if name in stable and new.get((name, part)) != text]


def last_tag():
    try:
        return git("describe", "--tags", "--abbrev=0", "--match", "v[0-9]*").strip()
    except (OSError, subprocess.CalledProcessError):
        return None


def main():
    tag = sys.argv[1] if len(sys.argv) > 1 else last_tag()
    if not tag:
        print("ABI watch: begins with the first tag")
        return
    former, current = interface_version(of_tag(tag)), interface_version(read_here)
    if former != current:
        print(f"ABI watch: {current} may differ from {tag}: its library has another name")
        return
    found = breaks(of_tag(tag), read_here)
    if found:
        sys.exit(f"ABI watch: programs linked with {tag} break:\n  " + "\n  ".join(found))
    print(f"ABI watch: what was stable in {tag} is unchanged")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Runs what README.md tells a newcomer in a clone: to a program. In a folder of its own, which goes afterwards.

usage: newcomer.py [CARGO TARGET_DIR]

The clone is of this project, as it is committed. With CARGO and TARGET_DIR the library is not built again: the clone's build asks that Cargo
for the library of this project, which it has built in that folder. All else is done as the page says. Status 77: there is no git
or no repository to clone, or no pkg-config."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SKIPPED = 77
CARGO_OF_THIS_PROJECT = """#!{python}
import os, sys
os.chdir({root!r})
os.execv({cargo!r}, [{cargo!r}] + [argument.replace({clone!r}, {root!r}) for argument in sys.argv[1:]])
"""


def commands():
    """The block of README.md that builds and installs, and the beginning of what the program prints."""
    with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as file:
        text = file.read()
    block = re.search(r"```sh\n(make build\n.*?)```", text, re.DOTALL)[1]
    printed = re.search(r"```text\n(.*?) within", text)[1]
    return block, printed


def reuse(folder, cargo, target_dir):
    """The environment in which the clone's build finds the library built."""
    bin_folder = os.path.join(folder, "bin")
    os.mkdir(bin_folder)
    stand_in = os.path.join(bin_folder, "cargo")
    with open(stand_in, "w", encoding="utf-8") as file:
        file.write(CARGO_OF_THIS_PROJECT.format(python=sys.executable, root=ROOT, cargo=cargo, clone=os.path.join(folder, "swiftprox")))
    os.chmod(stand_in, 0o755)
    home = os.path.expanduser("~")
    return {"PATH": bin_folder + os.pathsep + os.environ["PATH"], "CARGO_TARGET_DIR": target_dir,
            "CARGO_HOME": os.environ.get("CARGO_HOME", os.path.join(home, ".cargo")),
            "RUSTUP_HOME": os.environ.get("RUSTUP_HOME", os.path.join(home, ".rustup"))}


def main():
    is_repository = shutil.which("git") and subprocess.run(["git", "-C", ROOT, "rev-parse", "HEAD"], capture_output=True).returncode == 0
    if not is_repository or not shutil.which("pkg-config"):
        return SKIPPED
    block, printed = commands()
    with tempfile.TemporaryDirectory() as folder:
        folder = os.path.realpath(folder)
        environment = {**os.environ, **(reuse(folder, *sys.argv[1:3]) if sys.argv[1:] else {}), "HOME": folder}
        for name in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS"):  # those of a make that runs the tests
            environment.pop(name, None)
        script = f"set -eux\ngit clone --quiet '{ROOT}' swiftprox\ncd swiftprox\n{block}"
        done = subprocess.run(["bash", "-c", script], cwd=folder, env=environment, stdout=subprocess.PIPE, text=True)
    print(done.stdout)
    if done.returncode != 0 or printed not in done.stdout:
        sys.exit(f"the commands of README.md do not end in {printed!r}: status {done.returncode}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

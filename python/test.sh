#!/bin/sh
# Builds the package as `pip install .` does, into a virtual environment of its own, and tests it:  test.sh BUILD LIBRARY
#
# Exit status 77, with the reason, where Python has no venv, or its tools cannot be had.
cd "${0%/*}/.." || exit 1
venv=$1/python/venv
library=$2
python=${PYTHON:-python3}
skip() { echo "skipped: $1"; exit 77; }
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null || skip "no Python 3.10 or newer"
if [ ! -x "$venv/bin/pip" ]; then
    "$python" -m venv "$venv" >/dev/null 2>&1 || { rm -rf "$venv"; skip "Python has no venv"; }
fi
"$venv/bin/python" -c 'import os, sysconfig; os.stat(sysconfig.get_path("include") + "/Python.h")' 2>/dev/null ||
    skip "Python's headers are not installed"
"$venv/bin/pip" install --quiet --retries 1 'scikit-build-core>=0.10' 'nanobind>=2.4' numpy pytest ninja >"$1/python/pip.log" 2>&1 ||
    skip "its packages cannot be had from PyPI; $1/python/pip.log has why"
"$venv/bin/pip" install --quiet --no-build-isolation --no-deps . || exit 1
# For the examples; those whose packages cannot be had are skipped.
for package in trimesh yourdfpy mujoco matplotlib; do
    "$venv/bin/pip" install --quiet --retries 1 $package >>"$1/python/pip.log" 2>&1 || echo "$package cannot be had"
done
SWIFTPROX_LIBRARY=$library "$venv/bin/python" -m pytest -q -rs python/tests

# Sourced from the root of the project: PEERS_PYTHON is a Python that has coal and MuJoCo, from PyPI in an environment of its own in
# build/; empty where they cannot be installed.
if [ ! -x build/peers/bin/python ]; then
    { python3 -m venv build/peers && build/peers/bin/pip install -q coal==3.0.3 mujoco==4.0.0; } || rm -rf build/peers
fi
PEERS_PYTHON=
if [ -x build/peers/bin/python ]; then PEERS_PYTHON="$PWD/build/peers/bin/python"; fi

"""Every example runs, where the packages that it needs are installed."""
import json
import pathlib
import subprocess
import sys

import pytest

EXAMPLES = pathlib.Path(__file__).parent.parent / "examples"
NEEDS = {"hello": (), "meshes": ("trimesh",), "mujoco_step": ("mujoco",), "robot": ("yourdfpy",), "interval": ("matplotlib",),
         "link": ()}


def test_all_examples_are_here():
    assert {path.stem for path in EXAMPLES.glob("*.py")} == set(NEEDS)


@pytest.mark.parametrize("name", NEEDS)
def test_example(name, tmp_path):
    for package in NEEDS[name]:
        pytest.importorskip(package)
    done = subprocess.run([sys.executable, EXAMPLES / f"{name}.py"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and done.stdout, done.stderr


def test_the_link_is_read_group_by_group(tmp_path):
    done = subprocess.run([sys.executable, EXAMPLES / "link.py"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.stdout.splitlines() == [
        "5 pieces: base, arm, finger_left, bridge, finger_right",
        "a rod between the fingers is 0.040 m from finger_left",
        "as it falls, it meets bridge at t = 0.300",
    ]


def test_the_link_is_read_part_by_part(tmp_path):
    groups = (EXAMPLES / "link.obj").read_text().split("\ng ")[1:]
    corners = [[list(map(float, line.split()[1:])) for line in group.splitlines() if line.startswith("v ")] for group in groups]
    (tmp_path / "link.json").write_text(json.dumps([[vertices, [[0, 1, 2]]] for vertices in corners]))
    command = [sys.executable, EXAMPLES / "link.py", "link.json"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.stdout.splitlines()[:2] == [
        "5 pieces: part 0, part 1, part 2, part 3, part 4",
        "a rod between the fingers is 0.040 m from part 2",
    ], done.stderr

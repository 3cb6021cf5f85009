#!/usr/bin/env python3
"""Writes what docs/sweep.md measures: a scene of 30 fixed bodies and one that moves, and poses and motions of that.

usage: sweep_scene.py FOLDER COUNT
"""
import math
import os
import random
import sys

MODELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "models")
SHAPES = ("ellipsoid.off", "prism.obj", "box.off")
BODIES = 30
SIZE = 8.0  # half the side of the cube that holds the middles of bodies and the places of poses


def turn(chance):
    """A rotation, of a random unit quaternion, row by row."""
    w, x, y, z = (chance.gauss(0, 1) for _ in range(4))
    n = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / n, x / n, y / n, z / n
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))


def pose(rows, place):
    return " ".join(f"{x:.17g}" for row, t in zip(rows, place) for x in (*row, t))


def place(chance, about=(0, 0, 0), reach=SIZE):
    return [x + chance.uniform(-reach, reach) for x in about]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    folder, count = sys.argv[1], int(sys.argv[2])
    chance = random.Random(1)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "scene.txt"), "w") as scene:
        print("# swiftprox scene 1", file=scene)
        for shape in SHAPES:
            print("shape", shape.split(".")[0], os.path.abspath(os.path.join(MODELS, shape)), file=scene)
        print("object", SHAPES[0].split(".")[0], file=scene)
        for k in range(BODIES):
            print("object", SHAPES[k % len(SHAPES)].split(".")[0], "fixed", file=scene)
        print("step", file=scene)
        for k in range(BODIES):
            print(k + 1, pose(turn(chance), place(chance)), file=scene)
    with open(os.path.join(folder, "poses"), "w") as poses, open(os.path.join(folder, "motions"), "w") as motions:
        for _ in range(count):
            rows, here = turn(chance), place(chance)
            print(pose(rows, here), file=poses)
            print(pose(rows, here), pose(turn(chance), place(chance, here, 1.0)), file=motions)


if __name__ == "__main__":
    main()

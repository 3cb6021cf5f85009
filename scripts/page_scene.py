#!/usr/bin/env python3
"""Prints a scene of bodies that drift and turn, for swiftprox-replay:  page_scene.py BODIES STEPS > scene.txt

The bodies are about as dense at any number."""
import math
import os
import random
import sys

MODELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "models")
FILES = ("box.off", "prism.obj", "sphere.stl", "ellipsoid.off")


def main():
    count, steps = int(sys.argv[1]), int(sys.argv[2])
    draw = random.Random(1)
    side = 75 * (count / 10000) ** (1 / 3)
    print("# swiftprox scene 1")
    for file in FILES:
        print("shape", file, os.path.join(MODELS, file))
    bodies = []
    for body in range(count):
        print("object", FILES[body % len(FILES)])
        bodies.append([draw.uniform(0, side) for _ in range(3)] + [draw.uniform(0, 2 * math.pi), draw.uniform(-1, 1)])
    for step in range(steps):
        print("step")
        for body, (x, y, z, heading, climb) in enumerate(bodies):
            c, s = math.cos(heading + 0.05 * step), math.sin(heading + 0.05 * step)
            place = x + 0.1 * step * math.cos(heading), y + 0.1 * step * math.sin(heading), z + 0.05 * step * climb
            print(body, c, -s, 0, place[0], s, c, 0, place[1], 0, 0, 1, place[2])


if __name__ == "__main__":
    main()

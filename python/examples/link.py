"""A robot's link of convex pieces, and a rod between its fingers.

python link.py [FILE]

FILE is an OBJ file of groups, as CoACD and V-HACD write them, or the parts that coacd.run_coacd returns, as JSON: a list of
[vertices, faces]. json.dump([[v.tolist(), f.tolist()] for v, f in parts], file) writes them.
"""
import json
import pathlib
import sys

import numpy as np
import swiftprox as sp


def read_groups(path):
    """The vertices that each group's faces use. Numbers count from 1, or backwards from the last vertex."""
    vertices, groups = [], {}
    name = "unnamed"
    for line in pathlib.Path(path).read_text().splitlines():
        key, *words = line.split() or [""]
        if key == "v":
            vertices.append([float(word) for word in words[:3]])
        elif key in ("g", "o"):
            name = " ".join(words) or "unnamed"
        elif key == "f":
            numbers = [int(word.split("/")[0]) for word in words]
            groups.setdefault(name, set()).update(n - 1 if n > 0 else len(vertices) + n for n in numbers)
    return {name: np.array([vertices[n] for n in sorted(used)]) for name, used in groups.items()}


def read_parts(path):
    """The vertices of each part."""
    return {f"part {k}": np.array(vertices) for k, (vertices, _) in enumerate(json.loads(pathlib.Path(path).read_text()))}


def at(x, y, z):
    return np.column_stack([np.eye(3), [x, y, z]])


path = sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "link.obj"
groups = read_parts(path) if str(path).endswith(".json") else read_groups(path)
names = list(groups)
link = sp.Compound([sp.Shape(points, policy="hull") for points in groups.values()])
print(link.piece_count, "pieces:", ", ".join(names))

bodies = sp.CompoundPair(link, sp.Shape.box(0.2, 0.01, 0.01))
here, between = np.eye(4), at(0, 0.01, 0.47)
answer = bodies.distance(here, between)
bodies.verify(here, between, answer)
assert answer.piece1 is not None
print(f"a rod between the fingers is {answer.distance:.3f} m from {names[answer.piece1]}")

fall = sp.Motion.between(between, at(0, 0.01, 0.27))
cast = bodies.cast(here, fall)
bodies.verify(here, fall, cast)
print(f"as it falls, it meets {names[cast.piece1]} at t = {cast.t_lower:.3f}" if cast.piece1 is not None else "it falls past")

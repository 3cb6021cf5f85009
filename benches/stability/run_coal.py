"""Runs coal:  run_coal.py coal|coal-hull[=TOLERANCE] A B POSES

`coal` takes the triangles as they are (coal.Convex), `coal-hull` lets coal make the hull of the points (Convex.convexHull,
which is qhull). Needs the package coal from PyPI. The protocol is that of stability.py.
"""
import os
import sys

import coal
import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts"))
import cases  # noqa: E402

REFUSED = 2


def body(path, own_hull):
    points = coal.StdVec_Vec3s()
    for vertex in cases.read_off_vertices(path):
        points.append(numpy.array(vertex))
    if own_hull:
        return coal.Convex.convexHull(points, True, "Qt")
    triangles = coal.StdVec_Triangle()
    for row in cases.read_numbers(path)[2 + len(points):]:
        triangles.append(coal.Triangle(*(int(word) for word in row[1:])))
    return coal.Convex(points, triangles)


def placed(pose):
    rows = numpy.array([float(word) for word in pose]).reshape(3, 4)
    return coal.Transform3s(rows[:, :3], rows[:, 3])


def request(kind, tolerance):
    made = kind()
    if tolerance:
        made.gjk_tolerance = made.epa_tolerance = tolerance
    return made


def answer(first, second, pose, tolerance):
    at_first, at_second = placed(pose[:12]), placed(pose[12:])
    collided, separated = coal.CollisionResult(), coal.DistanceResult()
    coal.collide(first, at_first, second, at_second, request(coal.CollisionRequest, tolerance), collided)
    if collided.isCollision():
        return "intersecting"
    coal.distance(first, at_first, second, at_second, request(coal.DistanceRequest, tolerance), separated)
    return "separated %.17g" % max(separated.min_distance, 0.0)


def main():
    method, a, b, poses = sys.argv[1:]
    name, _, tolerance = method.partition("=")
    tolerance = float(tolerance) if tolerance else None
    try:
        first, second = body(a, name == "coal-hull"), body(b, name == "coal-hull")
    except Exception as refusal:
        print(refusal, file=sys.stderr)
        sys.exit(REFUSED)
    maker = "Convex.convexHull" if name == "coal-hull" else "Convex"
    print("ready coal %s, %s, tolerances %g" % (coal.__version__, maker, tolerance or 1e-6), flush=True)
    for pose in cases.read_numbers(poses):
        try:
            print(answer(first, second, pose, tolerance), flush=True)
        except Exception as failure:
            print("failed", flush=True)
            print(failure, file=sys.stderr)


main()

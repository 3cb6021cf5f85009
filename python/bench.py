#!/usr/bin/env python3
"""Times the package beside others: bench.py LIBRARY [CSV]

100-vertex hulls at random poses. Every method gets the same pairs; the methods take turns, five rounds, and the least time counts.
LIBRARY is the shared C library; a loop in C over swiftprox_pair_distances with one pose is what "C" means, in blocks of one cache."""
import ctypes
import sys
import time

import numpy as np
import swiftprox as sp

ROUNDS, COUNT = 7, 4000
rng = np.random.default_rng(1)


def hull():
    points = rng.normal(size=(100, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def rotations(count):
    w, x, y, z = (lambda q: q / np.linalg.norm(q, axis=0))(rng.normal(size=(4, count)))
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return np.moveaxis(np.array(rows), 2, 0)


def poses(count, spread):
    return np.ascontiguousarray(np.concatenate([rotations(count), rng.uniform(-spread, spread, (count, 3, 1))], 2))


A, B = hull(), hull()
X1, X2 = poses(COUNT, 2.5), poses(COUNT, 2.5)
L1, L2 = list(X1), list(X2)
K1, K2 = [sp.Pose(x) for x in L1], [sp.Pose(x) for x in L2]
shape1, shape2 = sp.Shape(A), sp.Shape(B)
MANY = 4
B1, B2 = np.tile(X1, (MANY, 1, 1)), np.tile(X2, (MANY, 1, 1))


class Many(ctypes.Structure):
    _fields_ = [("shape", ctypes.c_void_p), ("poses", ctypes.c_void_p), ("count", ctypes.c_size_t)]


def c_method(path):
    library = ctypes.CDLL(path)

    def shape(points):
        made = ctypes.c_void_p()
        library.swiftprox_shape_create_from_points(points.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(len(points)), None,
                                                   ctypes.byref(made))
        return made
    one, two = shape(A), shape(B)
    answers = np.zeros(COUNT, sp.dtype("distance"))

    def run():
        cache = ctypes.create_string_buffer(96)
        library.swiftprox_pair_distances(Many(one, X1.ctypes.data, COUNT), Many(two, X2.ctypes.data, COUNT), cache, None,
                                         ctypes.c_void_p(answers.ctypes.data))
    return run


def loop(one, two):
    def run():
        distance = sp.Pair(shape1, shape2).distance
        for a, b in zip(one, two):
            distance(a, b)
    return run


def batch(one, two, threads):
    return lambda: sp.Pair(shape1, shape2).distances(one, two, threads=threads)


methods = {"C": (c_method(sys.argv[1]), COUNT), "arrays, a call each": (loop(L1, L2), COUNT),
           "kept poses, a call each": (loop(K1, K2), COUNT), "one batch": (batch(X1, X2, 1), COUNT),
           "4 batches, one thread": (batch(B1, B2, 1), MANY * COUNT), "4 batches, two threads": (batch(B1, B2, 2), MANY * COUNT)}
try:
    import coal
    def coal_hull(points):
        vertices = coal.StdVec_Vec3s()
        vertices.extend(list(points))
        return coal.Convex.convexHull(vertices, False, "Qt")
    ca, cb = coal_hull(A), coal_hull(B)
    c1, c2 = ([coal.Transform3s(x[:, :3].copy(), x[:, 3].copy()) for x in xs] for xs in (L1, L2))

    def coal_run():
        request, result = coal.DistanceRequest(), coal.DistanceResult()
        for a, b in zip(c1, c2):
            result.clear()
            coal.distance(ca, a, cb, b, request, result)
    coal_run()
    methods["coal " + coal.__version__] = (coal_run, COUNT)
except Exception as error:
    print("coal is left out:", error)
try:
    import fcl
    from scipy.spatial import ConvexHull
    def fcl_hull(points):
        faces = ConvexHull(points).simplices
        return fcl.Convex(points, len(faces), np.concatenate([np.full((len(faces), 1), 3), faces], 1).ravel())
    fa, fb = fcl.CollisionObject(fcl_hull(A)), fcl.CollisionObject(fcl_hull(B))
    f1, f2 = ([fcl.Transform(x[:, :3].copy(), x[:, 3].copy()) for x in xs] for xs in (L1, L2))

    def fcl_run():
        request, result = fcl.DistanceRequest(), fcl.DistanceResult()
        for a, b in zip(f1, f2):
            fa.setTransform(a)
            fb.setTransform(b)
            fcl.distance(fa, fb, request, result)
    fcl_run()
    methods["python-fcl"] = (fcl_run, COUNT)
except Exception as error:
    print("python-fcl is left out:", error)
try:
    import mujoco
    xml = "".join(f'<mesh name="{name}" inertia="convex" vertex="{" ".join(map(str, points.ravel()))}"/>' for name, points in (("a", A), ("b", B)))
    model = mujoco.MjModel.from_xml_string(f'<mujoco><asset>{xml}</asset><worldbody><body mocap="true"><geom type="mesh" mesh="a"/></body>'
                                           '<body mocap="true"><geom type="mesh" mesh="b"/></body></worldbody></mujoco>')
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    m1, m2 = X1[:, :, :3].reshape(-1, 9), X2[:, :, :3].reshape(-1, 9)

    def mujoco_run():
        points = np.empty(6)
        for k in range(COUNT):
            data.geom_xpos[0], data.geom_xpos[1] = X1[k, :, 3], X2[k, :, 3]
            data.geom_xmat[0], data.geom_xmat[1] = m1[k], m2[k]
            mujoco.mj_geomDistance(model, data, 0, 1, 1e6, points)
    mujoco_run()
    methods["MuJoCo " + mujoco.__version__] = (mujoco_run, COUNT)
except Exception as error:
    print("MuJoCo is left out:", error)

best = {}
for _ in range(ROUNDS):
    for name, (run, count) in methods.items():
        begin = time.perf_counter()
        run()
        best[name] = min(best.get(name, 1e9), (time.perf_counter() - begin) / count * 1e9)
print("| method | ns a pair | above C |\n|---|--:|--:|")
for name, spent in best.items():
    print(f"| {name} | {spent:,.0f} | {spent - best['C']:,.0f} |")
print(f"\ntwo threads: {best['4 batches, one thread'] / best['4 batches, two threads']:.2f} times as fast as one")

#!/usr/bin/env python3
"""Writes the sample models of the examples, from formulas.

  sample_models.py [DIR]      DIR: examples/models beside this script's folder

  box.off        a box of quadrilaterals
  prism.obj      a prism over a regular heptagon
  sphere.stl     a geodesic sphere: an icosahedron divided once, 42 vertices (ASCII)
  ellipsoid.off  an ellipsoid with the half axes 1, 0.6 and 0.3: rings turned by half a step, 202 vertices
"""
import math
import os
import sys


def box(x, y, z):
    vertices = [(sx * x, sy * y, sz * z) for sz in (-1, 1) for sy in (-1, 1) for sx in (-1, 1)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return vertices, faces


def prism(corners, radius, half_height):
    ring = [2 * math.pi * i / corners for i in range(corners)]
    vertices = [(radius * math.cos(t), radius * math.sin(t), z) for z in (-half_height, half_height) for t in ring]
    sides = [(i, (i + 1) % corners, corners + (i + 1) % corners, corners + i) for i in range(corners)]
    bottom = tuple(reversed(range(corners)))
    top = tuple(range(corners, 2 * corners))
    return vertices, [bottom, top] + sides


def sphere(divisions):
    golden = (1 + math.sqrt(5)) / 2
    vertices = [unit(v) for v in (
        (-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0), (0, -1, golden), (0, 1, golden),
        (0, -1, -golden), (0, 1, -golden), (golden, 0, -1), (golden, 0, 1), (-golden, 0, -1), (-golden, 0, 1))]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
             (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
             (8, 6, 7), (9, 8, 1)]
    for _ in range(divisions):
        middles = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(vertices)
                vertices.append(unit([p + q for p, q in zip(vertices[a], vertices[b])]))
            return middles[key]

        finer = []
        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    return vertices, faces


def ellipsoid(half_axes, rings, ring_size):
    points = [(0.0, 0.0, 1.0)]
    for i in range(rings):
        polar = math.pi * (i + 1) / (rings + 1)
        for j in range(ring_size):
            turn = 2 * math.pi * (j + 0.5 * (i % 2)) / ring_size
            points.append((math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar)))
    points.append((0.0, 0.0, -1.0))

    def at(ring, j):
        return 1 + ring * ring_size + j % ring_size

    south = len(points) - 1
    faces = [(0, at(0, j), at(0, j + 1)) for j in range(ring_size)]
    for i in range(rings - 1):
        ahead = i % 2  # the ring below is half a step ahead of an even ring, half a step behind an odd one
        for j in range(ring_size):
            faces.append((at(i, j), at(i + 1, j - 1 + ahead), at(i + 1, j + ahead)))
            faces.append((at(i, j), at(i + 1, j + ahead), at(i, j + 1)))
    faces += [(south, at(rings - 1, j + 1), at(rings - 1, j)) for j in range(ring_size)]
    return [tuple(a * x for a, x in zip(half_axes, p)) for p in points], faces


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def write_off(path, model):
    vertices, faces = model
    with open(path, "w") as out:
        out.write("OFF\n%d %d 0\n" % (len(vertices), len(faces)))
        out.writelines("%.17g %.17g %.17g\n" % v for v in vertices)
        out.writelines("%d %s\n" % (len(f), " ".join(map(str, f))) for f in faces)


def write_obj(path, model):
    vertices, faces = model
    with open(path, "w") as out:
        out.writelines("v %.17g %.17g %.17g\n" % v for v in vertices)
        out.writelines("f %s\n" % " ".join(str(i + 1) for i in f) for f in faces)


def write_stl(path, name, model):
    vertices, faces = model
    with open(path, "w") as out:
        out.write("solid %s\n" % name)
        for face in faces:
            a, b, c = (vertices[i] for i in face)
            u = [q - p for p, q in zip(a, b)]
            w = [q - p for p, q in zip(a, c)]
            normal = unit((u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]))
            out.write("facet normal %.9g %.9g %.9g\nouter loop\n" % normal)
            out.writelines("vertex %.9g %.9g %.9g\n" % v for v in (a, b, c))
            out.write("endloop\nendfacet\n")
        out.write("endsolid %s\n" % name)


def main():
    default = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "models")
    directory = sys.argv[1] if len(sys.argv) > 1 else default
    os.makedirs(directory, exist_ok=True)
    write_off(os.path.join(directory, "box.off"), box(0.8, 0.5, 0.3))
    write_obj(os.path.join(directory, "prism.obj"), prism(7, 0.5, 0.8))
    write_stl(os.path.join(directory, "sphere.stl"), "sphere", sphere(1))
    write_off(os.path.join(directory, "ellipsoid.off"), ellipsoid((1.0, 0.6, 0.3), 10, 20))


if __name__ == "__main__":
    main()

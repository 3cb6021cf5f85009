"""The distance of two trimesh meshes, convex and not, and its proof."""
import numpy as np
import swiftprox
import trimesh

ball = trimesh.creation.icosphere(subdivisions=3, radius=1.0)
box = trimesh.creation.box(extents=(1, 2, 3))
pair = swiftprox.Pair(swiftprox.Shape(ball.vertices), swiftprox.Shape(box.vertices))
here, there = np.eye(4), trimesh.transformations.rotation_matrix(0.5, (1, 1, 0), (3, 0, 0))
there[0, 3] += 3
answer = pair.distance(here, there)
pair.verify(here, there, answer)
print(answer, "proved")

# A body that is not convex, in solid pieces, and a ball in its hole.
torus = trimesh.creation.torus(major_radius=1.0, minor_radius=0.3)
ring = swiftprox.Compound.from_mesh(torus.vertices, torus.faces, tolerance=0.01)
bodies = swiftprox.CompoundPair(ring, swiftprox.Shape.sphere(0.3))
answer = bodies.distance(np.eye(4), np.eye(4))
bodies.verify(np.eye(4), np.eye(4), answer)
print(f"a ring of {ring.piece_count} pieces is {answer.distance:.3f} from a ball in its hole")

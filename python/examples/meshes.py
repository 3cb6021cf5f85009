"""The distance of two trimesh meshes, and its proof."""
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

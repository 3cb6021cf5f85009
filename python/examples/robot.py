"""An arm of a URDF file against a shelf: 10,000 states in one call."""
import io

import numpy as np
import swiftprox
import yourdfpy

LINK = '<link name="{0}"><collision><origin xyz="0.2 0 0"/><geometry><box size="0.4 0.06 0.06"/></geometry></collision></link>'
JOINT = ('<joint name="j{1}" type="revolute"><parent link="{0}"/><child link="{1}"/><origin xyz="0.4 0 0"/><axis xyz="{2}"/>'
         '<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>')
URDF = ('<robot name="arm">' + "".join(LINK.format(name) for name in "abc") + JOINT.format("a", "b", "0 0 1") +
        JOINT.format("b", "c", "0 1 0") + "</robot>")
robot = yourdfpy.URDF.load(io.StringIO(URDF), load_meshes=False, build_scene_graph=True, build_collision_scene_graph=True)

scene = swiftprox.Scene()
links, offsets = [], []
for name, link in robot.link_map.items():
    for part in link.collisions:
        links.append((name, scene.add(swiftprox.Shape.box(*np.asarray(part.geometry.box.size) / 2))))
        offsets.append(part.origin)
for height in (-0.3, 0.3):
    board = np.eye(4)
    board[:3, 3] = 0.7, 0.5, height
    scene.add(swiftprox.Shape.box(0.3, 0.15, 0.01), board, fixed=True)

states = np.random.default_rng(0).uniform(-1.5, 1.5, (10_000, 2))
poses = np.empty((len(states), len(links), 3, 4))
for k, state in enumerate(states):
    robot.update_cfg(state)
    for n, (name, _) in enumerate(links):
        poses[k, n] = (robot.get_transform(name, collision_geometry=False) @ offsets[n])[:3]
ids = [number for _, number in links]
answers = scene.least_distance(ids, poses=poses, max_distance=0.05)
print("hits:", (answers["upper"] == 0).sum(), "nearer than 5 cm:", (answers["upper"] <= 0.05).sum(), "of", len(states))

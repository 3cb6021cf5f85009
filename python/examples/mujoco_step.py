"""Checks that bodies of a MuJoCo model are apart after a step."""
import mujoco
import numpy as np
import swiftprox

MODEL = """<mujoco><worldbody>
<body pos="0 0 1"><freejoint/><geom type="box" size="0.2 0.2 0.2"/></body>
<body pos="0.5 0 1"><freejoint/><geom type="capsule" size="0.1 0.3"/></body>
<body pos="0 0.45 1"><freejoint/><geom type="sphere" size="0.2"/></body>
</worldbody></mujoco>"""
model = mujoco.MjModel.from_xml_string(MODEL)
data = mujoco.MjData(model)
mujoco.mj_step(model, data)


def shape(geom):
    size, kind = model.geom_size[geom], model.geom_type[geom]
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        return swiftprox.Shape.box(*size)
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        return swiftprox.Shape.capsule(size[1], size[0])
    return swiftprox.Shape.sphere(size[0])


poses = np.concatenate([data.geom_xmat.reshape(-1, 3, 3), data.geom_xpos[:, :, None]], axis=2)
shapes = [shape(geom) for geom in range(model.ngeom)]
for a in range(model.ngeom):
    for b in range(a):
        pair = swiftprox.Pair(shapes[a], shapes[b])
        answer = pair.distance(poses[a], poses[b])
        pair.verify(poses[a], poses[b], answer)
        print(a, b, answer, "proved")

"""Tests the plug-in in MuJoCo's Python:  test_plugin.py PLUGIN SCENES

PLUGIN is libswiftprox_mujoco.so, SCENES the folder where mujoco_compare has written the scenes of docs/engines.md. MuJoCo's own
collider is asked before the plug-in is loaded, which is for good.
"""
import ctypes
import glob
import os
import sys
import threading
import unittest

import mujoco
import numpy
from mujoco import rollout

PLUGIN, SCENES = sys.argv.pop(1), sys.argv.pop(1)
PATHS = sorted(glob.glob(os.path.join(SCENES, "*.xml")))
STEPS = 1000
FALLEN = 0.05  # half the smallest body's height

SHAPES = {
    "sphere": 'type="sphere" size=".1"',
    "capsule": 'type="capsule" size=".05 .1"',
    "box": 'type="box" size=".1 .08 .06"',
    "mesh": 'type="mesh" mesh="hull"',
    "cylinder": 'type="cylinder" size=".1 .05"',
    "ellipsoid": 'type="ellipsoid" size=".1 .08 .05"',
}
OURS = ("sphere", "capsule", "box", "mesh")


class Counts(ctypes.Structure):
    _fields_ = [(name, ctypes.c_uint64) for name in ("answered", "passed_on", "pairs", "bodies")]


def counts():
    now = Counts()
    ctypes.CDLL(PLUGIN).swiftprox_mujoco_get_counts(ctypes.byref(now))
    return now


def model_of(first, second, more="", scale="1"):
    """Two geoms, the second free to move."""
    return mujoco.MjModel.from_xml_string(f"""
        <mujoco><asset><mesh name="hull" scale="{scale} {scale} {scale}" vertex="0 0 0 .2 0 0 0 .2 0 0 0 .2 .2 .2 0 .1 .2 .2"/></asset>
        <worldbody><geom {first} margin="0.02"/><body><freejoint/><geom {second} margin="0.02"/></body></worldbody>{more}</mujoco>""")


def poses(count):
    """Places about the first geom, and unit quaternions."""
    random = numpy.random.default_rng(1)
    for _ in range(count):
        way, quaternion = random.normal(size=3), random.normal(size=4)
        yield numpy.concatenate([way / numpy.linalg.norm(way) * random.uniform(0.02, 0.3), quaternion / numpy.linalg.norm(quaternion)])


def contacts(model, data, pose):
    """Distances, normals and positions of the contacts at a pose."""
    data.qpos[:] = pose
    mujoco.mj_kinematics(model, data)
    mujoco.mj_collision(model, data)
    found = data.contact
    return numpy.array(found.dist), numpy.array(found.frame).reshape(-1, 9)[:, :3], numpy.array(found.pos).reshape(-1, 3)


def all_contacts(model, count=200):
    data = mujoco.MjData(model)
    return [contacts(model, data, pose) for pose in poses(count)]


def least_distances(model, count=200):
    data = mujoco.MjData(model)
    found = []
    for pose in poses(count):
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        found.append(mujoco.mj_geomDistance(model, data, 0, 1, 1.0, None))
    return numpy.array(found)


def play(model, steps=STEPS):
    """How far the body that moved most is from where it began, and the whole state at the end."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    began = data.xpos.copy()
    for _ in range(steps):
        mujoco.mj_step(model, data)
    return numpy.linalg.norm(data.xpos - began, axis=1).max(), numpy.concatenate([data.qpos, data.qvel])


def flat_box_contacts():
    """Of a box that has lost its height and a sphere, three times."""
    model = model_of(SHAPES["box"], SHAPES["sphere"])
    data = mujoco.MjData(model)
    model.geom_size[0][2] = 0
    return numpy.array([contacts(model, data, [0, 0, 0.09, 1, 0, 0, 0])[0] for _ in range(3)])


def kinds():
    names = list(SHAPES)
    return [(first, second) for i, first in enumerate(names) for second in names[i:]]


MODELS = [mujoco.MjModel.from_xml_path(path) for path in PATHS]
OWN_MOVED = [play(model)[0] for model in MODELS]
OWN_CONTACTS = {kind: all_contacts(model_of(*(SHAPES[name] for name in kind))) for kind in kinds()}
OWN_DISTANCES = {kind: least_distances(model_of(*(SHAPES[name] for name in kind))) for kind in kinds()}
OWN_FLAT_BOX = flat_box_contacts()
mujoco.mj_loadPluginLibrary(PLUGIN)


class Scenes(unittest.TestCase):
    def test_what_stands_with_mujocos_collider_stands_with_ours(self):
        self.assertEqual(len(PATHS), 6)
        for path, model, own in zip(PATHS, MODELS, OWN_MOVED):
            with self.subTest(path):
                before = counts()
                moved, _ = play(model)
                self.assertTrue(moved < FALLEN or own >= FALLEN, (moved, own))
                self.assertGreater(counts().answered, before.answered + STEPS)
                self.assertEqual(counts().passed_on, before.passed_on)


class Pairs(unittest.TestCase):
    def test_types_are_ours_or_stay_mujocos(self):
        for kind in kinds():
            with self.subTest(kind):
                before = counts().answered
                found = all_contacts(model_of(*(SHAPES[name] for name in kind)))
                is_ours = all(name in OURS for name in kind)
                self.assertEqual(counts().answered > before, is_ours)
                if not is_ours:
                    for now, own in zip(found, OWN_CONTACTS[kind]):
                        for ours, theirs in zip(now, own):
                            self.assertTrue(numpy.array_equal(ours, theirs))

    def test_round_bodies_have_mujocos_contacts(self):
        """MuJoCo has closed forms for these: the same distance, normal and place."""
        for kind in [("sphere", "sphere"), ("sphere", "capsule"), ("capsule", "capsule"), ("sphere", "box")]:
            with self.subTest(kind):
                found = all_contacts(model_of(*(SHAPES[name] for name in kind)))
                for now, own in zip(found, OWN_CONTACTS[kind]):
                    self.assertEqual(len(now[0]), len(own[0]))
                    for ours, theirs in zip(now, own):
                        numpy.testing.assert_allclose(ours, theirs, atol=1e-12)

    def test_distances_of_separate_geoms_are_mujocos(self):
        for kind in kinds():
            with self.subTest(kind):
                found, own = least_distances(model_of(*(SHAPES[name] for name in kind))), OWN_DISTANCES[kind]
                apart = own > 0
                self.assertGreater(apart.sum(), 20)
                # MuJoCo's search ends at ccd_tolerance, 1e-6.
                numpy.testing.assert_allclose(found[apart], own[apart], atol=2e-6)

    def test_a_box_on_a_box_has_four_contacts(self):
        """Half heights 0.06 and 0.06, the second lowered by 0.001: corners at height 0.06 and 0.059."""
        model = model_of(SHAPES["box"], SHAPES["box"])
        distances, normals, places = contacts(model, mujoco.MjData(model), [0, 0, 0.119, 1, 0, 0, 0])
        numpy.testing.assert_allclose(distances, [-0.001] * 4, atol=1e-15)
        numpy.testing.assert_allclose(normals, [[0, 0, 1]] * 4, atol=1e-15)
        numpy.testing.assert_allclose(sorted(map(tuple, numpy.round(places, 12))),
                                      [(x, y, 0.0595) for x in (-0.1, 0.1) for y in (-0.08, 0.08)], atol=1e-12)

    def test_a_lying_capsule_has_two_contacts(self):
        for under in ("box", "mesh"):
            model = model_of('type="box" size="1 1 .5"' if under == "box" else 'type="mesh" mesh="slab"', SHAPES["capsule"],
                             '<asset><mesh name="slab" vertex="1 1 .5 1 1 -.5 1 -1 .5 1 -1 -.5 -1 1 .5 -1 1 -.5 -1 -1 .5 -1 -1 -.5"/></asset>')
            half = numpy.sqrt(0.5)
            distances, normals, _ = contacts(model, mujoco.MjData(model), [0, 0, 0.549, half, 0, half, 0])
            with self.subTest(under):
                numpy.testing.assert_allclose(distances, [-0.001] * 2, atol=1e-7)
                # From the geom of the smaller type, the capsule, to the other.
                numpy.testing.assert_allclose(normals, [[0, 0, -1]] * 2, atol=1e-7)

    def test_a_mesh_is_its_hull_scaled(self):
        """An L of two boxes: a ball in its notch touches the hull."""
        notch = """<asset><mesh name="l" vertex="0 0 0 2 0 0 2 0 1 1 0 1 1 0 2 0 0 2 0 1 0 2 1 0 2 1 1 1 1 1 1 1 2 0 1 2"
            face="0 1 3 1 2 3 0 3 5 3 4 5 6 9 7 7 9 8 6 11 9 9 11 10 0 7 1 0 6 7 1 8 2 1 7 8 2 9 3 2 8 9 3 10 4 3 9 10 4 11 5 4 10 11 5 6 0 5 11 6"
            scale=".1 .1 .1"/></asset>"""
        model = mujoco.MjModel.from_xml_string(f"""<mujoco>{notch}<worldbody><body><freejoint/><geom type="mesh" mesh="l"/></body>
            <body pos=".14 .05 .14"><freejoint/><geom type="sphere" size=".005"/></body></worldbody></mujoco>""")
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        # The hull's slanting face is x + z = 0.3.
        self.assertEqual(data.ncon, 1)
        numpy.testing.assert_allclose(data.contact.dist[0], (0.28 - 0.3) / numpy.sqrt(2) - 0.005, atol=1e-7)

    def test_margin_gap_and_condim_are_mujocos_to_judge(self):
        pair = '<contact><pair geom1="a" geom2="b" margin="0.01" gap="0.004" condim="6"/></contact>'
        model = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody><geom name="a" type="box" size="1 1 .5"/><body pos="0 0 .605">
            <freejoint/><geom name="b" type="box" size=".1 .1 .1"/></body></worldbody>{pair}</mujoco>""")
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        self.assertEqual(data.ncon, 4)
        numpy.testing.assert_allclose(data.contact.dist, 0.005, atol=1e-15)
        self.assertTrue((data.contact.dim == 6).all())
        data.qpos[2] = 0.62
        mujoco.mj_forward(model, data)
        self.assertEqual(data.ncon, 0)


class Changes(unittest.TestCase):
    def test_a_size_changed_between_calls_counts(self):
        model = model_of(SHAPES["box"], SHAPES["sphere"])
        data = mujoco.MjData(model)
        for height in (0.06, 0.07, 0.05):
            model.geom_size[0][2] = height
            model.geom_rbound[0] = 1
            distances, _, _ = contacts(model, data, [0, 0, 0.15, 1, 0, 0, 0])
            numpy.testing.assert_allclose(distances, [0.15 - 0.1 - height], atol=1e-15)

    def test_a_mesh_changed_in_place_counts(self):
        model, large = (model_of(SHAPES["mesh"], SHAPES["sphere"], scale=scale) for scale in ("1", "1.5"))
        data = mujoco.MjData(model)
        fresh = all_contacts(large)
        for pose in poses(10):
            contacts(model, data, pose)
        model.mesh_vert[:] = large.mesh_vert
        model.geom_rbound[:] = 1
        model.geom_aabb[:] = large.geom_aabb
        model.geom_pos[:] = large.geom_pos
        for pose, expected in zip(poses(200), fresh):
            numpy.testing.assert_allclose(contacts(model, data, pose)[0], expected[0], atol=1e-12)

    def test_models_that_come_and_go_leave_nothing_without_bound(self):
        """Models of the same names and numbers, at addresses that were others': only sizes tell them apart."""
        for i in range(300):
            height = 0.02 + 0.0001 * i
            model = model_of(f'type="box" size=".1 .1 {height}"', SHAPES["sphere"])
            distances, _, _ = contacts(model, mujoco.MjData(model), [0, 0, height + 0.1 - 0.001, 1, 0, 0, 0])
            numpy.testing.assert_allclose(distances, [-0.001], atol=1e-15)
        self.assertLessEqual(counts().bodies, 2 * counts().pairs)

    def test_what_is_kept_has_a_bound(self):
        """64 plates side by side, each pair of them asked for, of 20 data at once: more pairs than are kept, 512 * 64."""
        plates = "".join(f'<body pos="0 0 {i / 1000}"><freejoint/><geom name="g{i}" type="box" size="1 1 .0001"/></body>' for i in range(64))
        pairs = "".join(f'<pair geom1="g{i}" geom2="g{j}"/>' for i in range(64) for j in range(i))
        model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{plates}</worldbody><contact>{pairs}</contact></mujoco>")
        kept, before = [mujoco.MjData(model) for _ in range(20)], counts()
        for data in kept:
            mujoco.mj_kinematics(model, data)
            mujoco.mj_collision(model, data)
            self.assertEqual(data.ncon, 0)
        self.assertEqual(counts().answered - before.answered, 20 * 2016)
        self.assertLessEqual(counts().pairs, 512 * 64)
        self.assertGreater(counts().pairs, 20000)
        self.assertLess(counts().bodies, 1000)

    def test_copies_share_bodies(self):
        model = MODELS[0]
        first, end = play(model, 50)
        before = counts().bodies
        copy = model.__copy__()
        second, copied_end = play(copy, 50)
        self.assertEqual(counts().bodies, before)
        self.assertEqual(first, second)
        self.assertTrue(numpy.array_equal(end, copied_end))

    def test_models_in_turn_end_as_alone(self):
        alone = [play(model, 100)[1] for model in MODELS[:2]]
        both = [mujoco.MjData(model) for model in MODELS[:2]]
        for model, data in zip(MODELS, both):
            mujoco.mj_forward(model, data)
        for _ in range(100):
            for model, data in zip(MODELS, both):
                mujoco.mj_step(model, data)
        for data, expected in zip(both, alone):
            self.assertTrue(numpy.array_equal(numpy.concatenate([data.qpos, data.qvel]), expected))

    def test_a_run_after_a_reset_repeats_its_bits(self):
        model = MODELS[3]
        self.assertIn("drums", PATHS[3])
        data, ends = mujoco.MjData(model), []
        for shift in (0, 0.01, 0.02):
            # At time 0, too, another pose leaves nothing behind.
            mujoco.mj_resetData(model, data)
            data.qpos[0::7] += shift * numpy.arange(model.nq // 7)
            mujoco.mj_forward(model, data)
            mujoco.mj_resetData(model, data)
            mujoco.mj_forward(model, data)
            for _ in range(200):
                mujoco.mj_step(model, data)
            ends.append(data.qpos.copy())
        self.assertTrue(numpy.array_equal(ends[0], ends[1]))
        self.assertTrue(numpy.array_equal(ends[0], ends[2]))


class Threads(unittest.TestCase):
    def test_threads_end_as_one_does(self):
        """Three threads a model, steps without the interpreter's lock."""
        jobs = [model for model in MODELS[:2] for _ in range(3)]
        alone, ends = [play(model, 200)[1] for model in jobs], [None] * len(jobs)

        def run(i):
            ends[i] = play(jobs[i], 200)[1]

        threads = [threading.Thread(target=run, args=(i,)) for i in range(len(jobs))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for end, expected in zip(ends, alone):
            self.assertTrue(numpy.array_equal(end, expected))


    def test_mujocos_own_threads_roll_out_alike(self):
        """Twelve runs from one state, by three threads that take data in turn."""
        model = MODELS[3]
        start = mujoco.MjData(model)
        mujoco.mj_resetData(model, start)
        state = numpy.empty(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
        mujoco.mj_getState(model, start, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
        before = counts()
        runs, _ = rollout.rollout(model, [mujoco.MjData(model) for _ in range(3)], numpy.tile(state, (12, 1)), nstep=100)
        self.assertGreater(counts().answered, before.answered + 1200)
        for run in runs[1:]:
            self.assertTrue(numpy.array_equal(run, runs[0]))


class Refusals(unittest.TestCase):
    def test_a_body_that_we_refuse_is_mujocos(self):
        before = counts()
        self.assertTrue(numpy.array_equal(flat_box_contacts(), OWN_FLAT_BOX))
        self.assertEqual(counts().passed_on, before.passed_on + 3)
        self.assertEqual(counts().answered, before.answered)


unittest.main(verbosity=2)

"""The package: its bits are those of the C library, bad input is an exception with a message, threads do no harm.

SWIFTPROX_LIBRARY names the shared library of the same build."""
# pyright: reportArgumentType=false, reportOptionalIterable=false
import ctypes
import os
import threading

import numpy as np
import pytest
import swiftprox as sp

RANDOM = np.random.default_rng(7)
EYE = np.eye(4)[:3]


def poses(count, spread=3.0):
    axes = RANDOM.normal(size=(count, 4))
    w, x, y, z = (axes / np.linalg.norm(axes, axis=1, keepdims=True)).T
    made = np.empty((count, 3, 4))
    made[:, 0, :3] = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], 1)
    made[:, 1, :3] = np.stack([2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], 1)
    made[:, 2, :3] = np.stack([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], 1)
    made[:, :, 3] = RANDOM.uniform(-spread, spread, (count, 3))
    return made


def at(x, y=0.0, z=0.0):
    return np.hstack([np.eye(3), [[x], [y], [z]]])


POINTS1, POINTS2 = RANDOM.normal(size=(60, 3)), RANDOM.normal(size=(60, 3))
X1, X2 = poses(3000), poses(3000)


def pair():
    return sp.Pair(sp.Shape(POINTS1), sp.Shape(POINTS2))


class Placed(ctypes.Structure):
    _fields_ = [("shape", ctypes.c_void_p), ("pose", ctypes.c_void_p)]


@pytest.mark.skipif("SWIFTPROX_LIBRARY" not in os.environ, reason="SWIFTPROX_LIBRARY names no library")
def test_the_bits_are_those_of_c():
    library = ctypes.CDLL(os.environ["SWIFTPROX_LIBRARY"])

    def shape(points):
        made = ctypes.c_void_p()
        assert library.swiftprox_shape_create_from_points(points.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(len(points)), None,
                                                          ctypes.byref(made)) == 0
        return made

    one, two, cache = shape(POINTS1), shape(POINTS2), ctypes.create_string_buffer(96)
    said = np.zeros(1000, sp.dtype("distance"))
    for k in range(1000):
        assert library.swiftprox_pair_distance(Placed(one, X1[k].ctypes.data), Placed(two, X2[k].ctypes.data), cache, None,
                                               ctypes.c_void_p(said[k:].ctypes.data)) == 0
    together = pair().distances(X1[:1000], X2[:1000])
    single = pair()
    for name in said.dtype.names:
        assert said[name].tobytes() == together[name].tobytes(), name
    for k in range(1000):
        answer = single.distance(X1[k], sp.Pose(X2[k]))
        assert (answer.distance, answer.lower, answer.upper) == (said["distance"][k], said["lower"][k], said["upper"][k])
        assert np.array_equal(answer.world1, said["world1"][k], equal_nan=True)


def test_threads_change_no_bit():
    names = sp.dtype("distance").names
    one, two = pair().distances(X1, X2), pair().distances(X1, X2, threads=2)
    assert all(one[name].tobytes() == two[name].tobytes() for name in names)


def test_threads_that_share_a_pair_and_a_scene_take_turns():
    shared, scene, wrong = pair(), sp.Scene(), []
    ids = [scene.add(sp.Shape.sphere(0.5), at(2.0 * k)) for k in range(4)]

    def work():
        for k in range(300):
            answer = shared.distance(X1[k], X2[k])
            if (answer.outcome == sp.Outcome.INTERSECTING) != (verdicts[k] == sp.Outcome.INTERSECTING):
                wrong.append(k)
            scene.set_poses(X1[:4], ids)
            scene.within()
            shared.distances(X1[:50], X2[:50], threads=2)

    verdicts = pair().distances(X1[:300], X2[:300])["outcome"]
    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert not any(thread.is_alive() for thread in threads) and not wrong


def test_answers_verify_and_forged_ones_do_not():
    bodies = sp.Pair(sp.Shape.box(1, 1, 1), sp.Shape.sphere(0.5))
    answer = bodies.distance(EYE, at(4))
    assert answer.outcome == sp.Outcome.SEPARATED and answer.lower <= 2.5 <= answer.upper and answer.feature1[0] == "face"
    assert np.allclose(answer.world1, [1, 0, 0]) and np.allclose(answer.normal, [-1, 0, 0])
    bodies.verify(EYE, at(4), answer)
    with pytest.raises(sp.Unverified):
        bodies.verify(EYE, at(5), answer)
    boxes = sp.Pair(sp.Shape.box(1, 1, 1), sp.Shape.box(1, 1, 1))
    manifold = boxes.manifold(EYE, at(0, 0, 1.9))
    assert len(manifold.points) == 4 and manifold.lower <= -0.1 <= manifold.upper
    boxes.verify(EYE, at(0, 0, 1.9), manifold)
    parting = sp.Motion.between(at(1.5), at(4))
    assert bodies.cast(EYE, parting).outcome == "hit"
    parted = bodies.cast(EYE, parting, ignores_parting=True)
    assert parted.outcome == "free" and 0 < parted.t_parted < 1e-3
    cast = bodies.cast(EYE, sp.Motion.between(at(4), at(0)))
    assert cast.outcome == "hit" and cast.t_lower <= 0.625 <= cast.t_upper
    bodies.verify(EYE, sp.Motion.between(at(4), at(0)), cast)
    signed = boxes.signed(EYE, at(0, 0, 1.5))
    assert signed.lower <= -0.5 <= signed.upper < 0


def test_curved_bodies():
    ball = sp.Shape.sphere(0.5)
    for body in sp.Shape.cylinder(1, 2), sp.Shape.cone(1, 2, 0.01), sp.Shape.ellipsoid(1, 0.5, 0.5):
        assert 0 < body.deviation <= 0.01 and ball.deviation == 0
        # Along z, from below: by hand, but for the ellipsoid along x.
        at_gap = (lambda gap: at(1.5 + gap)) if body.vertex_count > 1000 else (lambda gap: at(0, 0, -2.5 - gap))
        bodies = sp.Pair(body, ball)
        answer = bodies.distance(EYE, at_gap(1))
        assert answer.outcome == sp.Outcome.SEPARATED and answer.lower <= 1 <= answer.upper <= answer.lower + body.deviation + 1e-12
        bodies.verify(EYE, at_gap(1), answer)
        assert bodies.distance(EYE, at_gap(1e-6)).outcome == sp.Outcome.UNDECIDED
        assert bodies.distance(EYE, at_gap(-0.1)).outcome == sp.Outcome.INTERSECTING
    with pytest.raises(sp.InputError, match="at least"):
        sp.Shape.cylinder(1, 1, 1e-9)


def test_gradients_are_what_differences_say():
    bodies = sp.Pair(sp.Shape(POINTS1), sp.Shape(POINTS2))

    def turned(pose, axis, angle, about):
        k = np.cross(np.eye(3), axis)
        turn = np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
        return np.column_stack([turn @ pose[:, :3], about + turn @ (pose[:, 3] - about)])

    seen = 0
    for pose1, pose2 in zip(X1[:40], X2[:40]):
        answer, about, h = bodies.signed(pose1, pose2), np.array([0.3, -0.2, 0.5]), 1e-5
        gradient = bodies.gradient(pose1, pose2, answer, about)
        assert gradient.body1.shape == gradient.body2.shape == (6,) and np.array_equal(gradient.body1[:3], answer.normal)
        for k in range(3):
            axis = np.eye(3)[k]
            one, other = (bodies.signed(turned(pose1, axis, sign * h, about), pose2).distance for sign in (1, -1))
            seen += abs((one - other) / (2 * h) - gradient.body1[3 + k]) < 1e-5
            moved = [pose2 + sign * h * np.column_stack([np.zeros((3, 3)), axis]) for sign in (1, -1)]
            one, other = (bodies.signed(pose1, pose).distance for pose in moved)
            seen += abs((one - other) / (2 * h) - gradient.body2[k]) < 1e-5
    assert seen > 225
    boxes = sp.Pair(sp.Shape.box(1, 1, 1), sp.Shape.box(1, 1, 1))
    flat = boxes.gradient(EYE, at(0, 0, 4), boxes.distance(EYE, at(0, 0, 4)))
    assert not flat.is_unique and np.array_equal(flat.body2[:3], [0, 0, 1])


def test_poses_come_in_many_forms():
    bodies = sp.Pair(sp.Shape.box(1, 1, 1), sp.Shape.sphere(0.5))
    four = np.vstack([at(4), [0, 0, 0, 1]])
    expected = bodies.distance(sp.Pose(), at(4)).distance
    for pose in (four, four.T.copy().T, four.astype(np.float32), four.tolist(), at(4).tolist(), sp.Pose(four), four.astype(int)):
        assert bodies.distance(EYE, pose).distance == expected
    assert (bodies.distances(EYE, np.stack([four] * 5))["distance"] == expected).all()
    assert len(bodies.distances(EYE, np.empty((0, 3, 4)))) == 0
    assert np.array_equal(sp.Pose(four).matrix, at(4))


def refusals():
    bodies = sp.Pair(sp.Shape.box(1, 1, 1), sp.Shape.sphere(0.5))
    four = np.vstack([at(4), [0, 0, 0, 1]])
    scene = sp.Scene()
    one = scene.add(sp.Shape.sphere(1))
    nan = np.full((3, 4), np.nan)
    return [
        (lambda: bodies.distance(four.T, EYE), "column-major"),
        (lambda: bodies.distance(at(4).T, EYE), "column-major"),
        (lambda: bodies.distance(np.ones((4, 4)), EYE), "last row"),
        (lambda: bodies.distance(at(4).ravel(), EYE), "reshape"),
        (lambda: bodies.distance(nan, EYE), "finite"),
        (lambda: bodies.distance(2 * EYE, EYE), ""),
        (lambda: bodies.distance([None], EYE), "pose1"),
        (lambda: bodies.distance("text", EYE), "pose1"),
        (lambda: bodies.distance([EYE, EYE], EYE), "one is wanted"),
        (lambda: bodies.distance(EYE, EYE, -1), ""),
        (lambda: bodies.distances(X1[:3], X2[:4]), "3 poses"),
        (lambda: bodies.distances(X1[:3], X2[:3], threads=0), "threads"),
        (lambda: bodies.distances(np.concatenate([X1[:2000], nan[None]]), EYE), ""),
        (lambda: bodies.verify(EYE, EYE, 3), "answer"),
        (lambda: bodies.gradient(EYE, at(4), 3), "answer"),
        (lambda: bodies.gradient(EYE, at(4), bodies.distance(EYE, at(4), 1)), "normal"),
        (lambda: bodies.gradient(EYE, at(4), bodies.distance(EYE, at(4)), [1, 2]), "reference1"),
        (lambda: bodies.cast(EYE, EYE, -1), ""),
        (lambda: sp.Shape(np.zeros((4, 2))), "(4, 2)"),
        (lambda: sp.Shape(np.zeros((4, 3))), ""),
        (lambda: sp.Shape(POINTS1, policy="none"), "policy"),
        (lambda: sp.Shape(POINTS1, [[0, 1, -2]]), "negative"),
        (lambda: sp.Shape(POINTS1, [[0, 1, 99]]), ""),
        (lambda: sp.Shape(POINTS1, np.zeros((2, 3))), "whole"),
        (lambda: sp.Shape.box(-1, 1, 1), ""),
        (lambda: sp.Shape.sphere(float("nan")), ""),
        (lambda: scene.remove(12345), ""),
        (lambda: scene.set_poses(X1[:2]), ""),
        (lambda: scene.set_poses(X1[:2], [one]), "1 ids"),
        (lambda: scene.add([]), ""),
        (lambda: scene.ray([0, 0], [1, 0, 0]), "(2,)"),
        (lambda: scene.ray([0, 0, 0], [0, 0, 0]), ""),
        (lambda: scene.ray([0, 0, 0], [1, 0, 0], hits="last"), "hits"),
        (lambda: scene.within(piece_pairs="last"), "piece_pairs"),
        (lambda: scene.first_hit([one], EYE[None]), "times"),
        (lambda: scene.least_distance([one], poses=EYE), "poses"),
        (lambda: sp.Ground([[0, 0, 0]], [[0, 0, 9]]), ""),
        (lambda: sp.dtype("nothing"), "dtype"),
    ]


@pytest.mark.parametrize("number", range(len(refusals())))
def test_bad_input_is_an_exception_with_a_message(number):
    call, words = refusals()[number]
    with pytest.raises(ValueError) as caught:
        call()
    assert isinstance(caught.value, sp.Error) and words in str(caught.value) and len(str(caught.value)) > 10


def test_files(tmp_path):
    with pytest.raises(sp.FileError, match="nowhere"):
        sp.load(tmp_path / "nowhere.off")
    (tmp_path / "a.off").write_text("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")
    shape = sp.load(str(tmp_path / "a.off"))
    assert shape.vertex_count == 4 and abs(shape.volume - 1 / 6) < 1e-15
    assert sp.Shape(shape.vertices, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).face_count == 4


def test_a_scene():
    scene = sp.Scene(threads=2)
    box, ball = sp.Shape.box(1, 1, 1), sp.Shape.sphere(0.5)
    first, second, third = scene.add(box, user_data=5), scene.add([ball], at(0, 0, 1.4)), scene.add(ball, at(4))
    near = scene.within(0.5)
    assert near["object1"].tolist() == [first] and near["object2"].tolist() == [second] and near["user_data1"].tolist() == [5]
    contacts, points = scene.contacts()
    assert len(contacts) == 1 and contacts["point_count"][0] == len(points) == 1 and points["lower"][0] <= -0.1 <= points["upper"][0]
    assert abs(scene.least_distance([third])["lower"] - 2.5) < 1e-12
    states = np.stack([[at(4)], [at(3)], [at(1)]])
    many = scene.least_distance([third], poses=states)
    assert np.allclose(many["upper"], [2.5, 1.5, 0], atol=1e-12) and many["object2"].tolist() == [first] * 3
    hit = scene.first_hit([third], states, in_order=True)
    assert (hit.time, hit.object1, hit.object2) == (2, third, first)
    assert scene.first_hit([third], states[:2]).time is None
    hits = scene.ray([9, 0, 0], [-1, 0, 0], hits="all")
    assert hits["object"].tolist() == [third, first] and hits["entry"][0][0] <= 4.5 <= hits["entry"][0][1]
    cast = scene.cast([third], sp.Motion.between(at(4), at(0)))
    assert cast.outcome == "hit" and cast.t_lower <= 0.625 <= cast.t_upper and cast.object2 == first
    scene.set_poses(np.stack([at(0), at(9), at(18)]))
    assert len(scene.within(1)) == 0
    scene.remove(second)
    assert len(scene.within()) == 1
    scene.add([box, ball], at(5))
    assert len(scene.within()) == 5
    for piece_pairs in "first", "nearest":
        assert len(scene.within(piece_pairs=piece_pairs)) == 3
        assert len(scene.contacts(np.inf, piece_pairs=piece_pairs)[0]) == 3


def test_a_ground():
    ground = sp.Ground([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    box = sp.Shape.box(1, 1, 1)
    assert abs(ground.distance(box, at(0, 0, 3)).distance - 2) < 1e-12
    assert ground.triangles.tolist() == [[[-9, -9, 0], [9, -9, 0], [0, 9, 0]]]
    contacts, points = ground.contacts(box, at(0, 0, 0.9))
    assert len(contacts) == 1 and len(points) == 4 and np.allclose(contacts["normal"][0], [0, 0, 1])


def test_a_ground_in_a_scene():
    scene = sp.Scene()
    floor = scene.add(sp.Ground([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]]), at(0, 0, -1), user_data=4)
    box = scene.add(sp.Shape.box(1, 1, 1), at(0, 0, 3))
    near = scene.within(4)
    assert near["object1"].tolist() == [floor] and near["object2"].tolist() == [box] and near["user_data1"].tolist() == [4]
    assert abs(scene.least_distance([box])["lower"] - 3) < 1e-12
    cast = scene.cast([box], sp.Motion.between(at(0, 0, 3), at(0, 0, -1)))
    assert cast.outcome == "hit" and cast.object2 == floor and cast.t_lower <= 0.75 <= cast.t_upper


def test_rays_and_casts_at_a_ground():
    ground = sp.Ground([[-9, -9, 0], [9, -9, 0], [0, 9, 0], [0, 9, 5]], [[0, 1, 2], [0, 3, 1]])
    hit = ground.ray([0, 0, 8], [0, 0, -2])
    # The second triangle rises from the line y = -9 to z = 5 at y = 9.
    assert hit.outcome == "hit" and hit.part == 1 and hit.entry[0] <= 2.75 <= hit.entry[1] <= hit.entry[0] + 1e-11
    below = ground.ray([0, 0, -1], [0, 0, 1])
    assert below.part == 0 and below.entry[0] <= 1 <= below.entry[1] and np.array_equal(below.normal, [0, 0, -1])
    assert below.feature == ("face", 0)
    miss = ground.ray([0, 0, 8], [0, 0, -2], t_max=2)
    assert miss.outcome == "miss" and miss.part is None and np.isnan(miss.entry).all()

    flat, box = sp.Ground([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]]), sp.Shape.box(1, 1, 1)
    cast = flat.cast(box, sp.Motion.between(at(0, 0, 4), at(0, 0, 0)))
    assert cast.outcome == "hit" and cast.triangle == 0 and cast.t_lower <= 0.75 <= cast.t_upper <= cast.t_lower + 1e-9
    assert np.array_equal(cast.contact.normal, [0, 0, 1]) and isinstance(cast, sp.Cast)
    early = flat.cast(box, sp.Motion.between(at(0, 0, 4), at(0, 0, 0)), 1.0)
    assert early.t_lower <= 0.5 <= early.t_upper
    free = flat.cast(box, sp.Motion.between(at(0, 0, 4), at(0, 0, 3)))
    assert free.outcome == "free" and free.triangle is None and 1.9 < free.clearance <= 2
    with pytest.raises(sp.InputError, match="max_distance"):
        flat.cast(box, EYE, -1)


def dumbbell():
    """Two cubes of the half extent 1, about (-2, 0, 0) and (2, 0, 0)."""
    return sp.Compound([sp.Shape.box(1, 1, 1)] * 2, [at(-2), at(2)])


def test_a_pair_of_compounds():
    body, ball = dumbbell(), sp.Shape.sphere(0.5)
    bodies = sp.CompoundPair(body, ball)
    assert not bodies.intersects(EYE, at(0)) and bodies.intersects(EYE, at(3.25))
    answer = bodies.distance(EYE, at(5))
    assert answer.lower <= 1.5 <= answer.upper and (answer.piece1, answer.piece2) == (1, 0)
    assert answer.outcome == sp.Outcome.SEPARATED and isinstance(answer, sp.Distance) and "piece1=1" in repr(answer)
    assert np.allclose(answer.world1, [3, 0, 0]) and np.allclose(answer.local1, [1, 0, 0]) and np.allclose(answer.normal, [-1, 0, 0])
    bodies.verify(EYE, at(5), answer)
    with pytest.raises(sp.Unverified):
        bodies.verify(EYE, at(4.5), answer)
    with pytest.raises(sp.InputError, match="CompoundDistance"):
        bodies.verify(EYE, at(5), 1.5)
    met = bodies.distance(EYE, at(-2))
    assert met.outcome == sp.Outcome.INTERSECTING and met.piece1 == 0
    bodies.verify(EYE, at(-2), met)
    beyond = bodies.distance(EYE, at(5), 1)
    assert beyond.outcome == sp.Outcome.BEYOND and beyond.piece1 is None and beyond.piece2 is None
    bodies.verify(EYE, at(5), beyond)
    signed = bodies.signed(EYE, at(2, 0, 1.25))
    assert signed.lower <= -0.25 <= signed.upper and signed.piece1 == 1

    channel = sp.Compound([sp.Shape.box(3, 2, 0.5), sp.Shape.box(0.5, 2, 3), sp.Shape.box(0.5, 2, 3)], [at(0, 0, -0.5), at(-2), at(2)])
    peg = sp.CompoundPair(sp.Shape.box(1.75, 1, 1), channel)
    deep = peg.depth(at(0, 0, 2.75), EYE)
    assert np.isclose(deep.lower, 0.25) and np.isclose(deep.upper, 1.25) and np.allclose(deep.translation, [0, 0, 1.25])
    assert deep.deepest.piece1 == 0 and deep.deepest.piece2 in (1, 2) and "upper=1.25" in repr(deep)
    peg.verify(at(0, 0, 2.75), EYE, deep)
    with pytest.raises(sp.Unverified):
        peg.verify(at(0, 0, 2.5), EYE, deep)
    assert peg.depth(at(0, 0, 9), EYE).upper == 0

    slab = sp.CompoundPair(body, sp.Shape.box(5, 5, 1))
    contacts, points = slab.contacts(EYE, at(0, 0, -1.75))
    assert contacts["piece1"].tolist() == [0, 1] and contacts["point_count"].tolist() == [4, 4] and len(points) == 8
    assert (contacts["lower"] <= -0.25).all() and (contacts["upper"] >= -0.25).all() and contacts["first_point"].tolist() == [0, 4]
    assert len(slab.contacts(EYE, at(0, 0, -2.25))[0]) == 0 and len(slab.contacts(EYE, at(0, 0, -2.25), 0.5)[0]) == 2
    comb = sp.Compound([sp.Shape.box(0.1, 1, 1)] * 40, [at(k) for k in range(40)])
    contacts, points = sp.CompoundPair(comb, sp.Shape.box(50, 5, 1)).contacts(EYE, at(0, 0, -1.75))
    assert contacts["piece1"].tolist() == list(range(40)) and len(points) == 160


def test_casts_of_compounds():
    bodies, fall = sp.CompoundPair(dumbbell(), dumbbell()), sp.Motion.between(at(3, 0, 10), at(3, 0, 0))
    hit = bodies.cast(EYE, fall)
    assert hit.outcome == "hit" and (hit.piece1, hit.piece2) == (1, 0) and hit.t_lower <= 0.8 <= hit.t_upper <= hit.t_lower + 1e-9
    assert np.allclose(hit.contact.normal, [0, 0, -1]) and isinstance(hit, sp.Cast)
    bodies.verify(EYE, fall, hit)
    with pytest.raises(sp.Unverified):
        bodies.verify(EYE, sp.Motion.between(at(3, 0, 9), at(3, 0, 0)), hit)
    past = sp.Motion.between(at(0, 2.5, 10), at(0, 2.5, 0))
    free = bodies.cast(EYE, past)
    assert free.outcome == "free" and free.piece1 is None and 0 < free.clearance <= 0.5
    bodies.verify(EYE, past, free)
    assert bodies.cast(EYE, past, 0.75).outcome == "hit"
    # The ball is at 2 (cos, sin, 0) of its angle, a quarter turn in all. It meets the plane y = 1.5 at 30 degrees.
    ball = sp.CompoundPair(sp.Compound([sp.Shape.sphere(0.5)], [at(2)]), sp.Shape.box(9, 1, 9))
    turn = sp.Motion.screw(EYE, [0, 0, 0], [0, 0, np.pi / 2])
    hit = ball.cast(turn, at(0, 2.5))
    assert hit.t_lower <= 1 / 3 + 1e-12 and hit.t_upper >= 1 / 3 - 1e-12 and hit.t_upper <= hit.t_lower + 1e-9
    ball.verify(turn, at(0, 2.5), hit)


def test_rays_and_points_against_a_compound():
    body = dumbbell()
    hit = body.ray(EYE, [9, 0, 0], [-2, 0, 0])
    assert hit.outcome == "hit" and hit.part == 1 and hit.entry[0] <= 3 <= hit.entry[1] and hit.exit[0] <= 4 <= hit.exit[1]
    assert np.array_equal(hit.normal, [1, 0, 0]) and hit.feature[0] == "face"
    assert body.ray(at(0, 0, 1), [0, 0, 9], [0, 0, -1]).part is None
    assert body.ray(EYE, [-2, 0, 0], [0, 0, 1]).outcome == "inside"
    point = body.point(EYE, [2.5, 0, 0])
    assert point.location == "inside" and point.piece == 1 and point.lower <= -0.5 <= point.upper
    assert body.point(at(1), [4, 0.5, 0]).location == "on"
    outside = body.point(EYE, [-6, 4, 1])
    assert outside.location == "outside" and outside.piece == 0 and outside.lower <= np.sqrt(18) <= outside.upper
    assert np.allclose(outside.world, [-3, 1, 1])


def test_compounds_are_made_of_shapes_and_meshes():
    body = dumbbell()
    shape, pose = body.piece(1)
    assert body.piece_count == 2 and shape.vertex_count == 8 and np.array_equal(pose, at(2))
    made = sp.Compound(sp.Shape.box(0.1, 1, 1 + k) for k in range(3))
    assert np.abs(made.piece(2)[0].vertices).max() == 3 and sp.Scene().add(sp.Shape.sphere(1 + k) for k in range(3))
    # An L of the area 3, one high: outline, then both lids and the walls.
    outline = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]
    points = [[x, y, z] for z in (0, 1) for x, y in outline]
    walls = [[k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k] for k in range(6)]
    mesh = sp.Compound.from_mesh(points, [[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11], *walls])
    ball = sp.CompoundPair(mesh, sp.Shape.sphere(0.25))
    near = ball.distance(EYE, at(1.5, 1.5, 0.5))
    # The corner of the L is a quarter from the ball along x and y.
    assert near.lower <= 0.25 <= near.upper and not ball.intersects(EYE, at(1.5, 1.5, 0.5))
    for call, words in [
        (lambda: sp.Compound([]), "at least one piece"),
        (lambda: sp.Compound([shape], EYE), "(1, 3, 4)"),
        (lambda: sp.Compound([shape], [EYE, EYE]), "(1, 3, 4)"),
        (lambda: sp.Compound([shape], [2 * EYE]), "piece 0"),
        (lambda: body.piece(2), "piece 2"),
        (lambda: sp.CompoundPair(body, 3), "compound2"),
        (lambda: sp.Compound.from_mesh(points, [[0, 1, 99]]), "99"),
        (lambda: body.ray(EYE, [0, 0, 0], [0, 0, 0]), "direction"),
        (lambda: body.point(EYE, [0, 0]), "(2,)"),
    ]:
        with pytest.raises(sp.InputError) as caught:
            call()
        assert words in str(caught.value) and len(str(caught.value)) > 10


def test_threads_that_share_a_pair_of_compounds_take_turns():
    shared, wrong = sp.CompoundPair(dumbbell(), dumbbell()), []

    def work():
        for pose in X1[:300]:
            answer = shared.distance(EYE, pose)
            if answer.outcome == sp.Outcome.INTERSECTING and not shared.intersects(EYE, pose):
                wrong.append(pose)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert not any(thread.is_alive() for thread in threads) and not wrong

#!/usr/bin/env python3
"""Tests the page of swiftprox-replay --html:  test_page.py TOOL RECORDER Data|Browser

Data looks into the file, Browser opens it in headless Chromium."""
import base64
import decimal
import json
import math
import os
import random
import re
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import unittest

import browser

TOOL, RECORDER = sys.argv[1], sys.argv[2]  # the second writes a recording to the file that it is given
MODELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "models")
HEAD = "# swiftprox scene 1\n"
BOXES = HEAD + f"shape box {MODELS}/box.off\nobject box fixed\nobject box\nobject box\n"  # half sides 0.8, 0.5, 0.3
INTERSECTING = 3
STEP_WORDS, PAIR_CODES, MARCH = 22, 11, 7  # as tools/page/recording.js has them


def at(number, x, y=0, z=0):
    return f"{number} 1 0 0 {x} 0 1 0 {y} 0 0 1 {z}\n"


def printed(value, rounding=decimal.ROUND_HALF_EVEN):
    """As printf("%.17g") in that direction."""
    if not math.isfinite(value) or value == 0:
        return "%g" % value
    digits = decimal.Context(prec=17, rounding=rounding).create_decimal(decimal.Decimal(value))
    power = digits.adjusted()
    mantissa = "".join(map(str, digits.as_tuple().digits)).ljust(17, "0")[:17]
    sign = "-" if value < 0 else ""
    if -4 <= power < 17:
        digits = "0" * -power + mantissa
        point = max(power, 0) + 1
        return (sign + digits[:point] + "." + digits[point:]).rstrip("0").rstrip(".")
    return f"{sign}{mantissa[0]}.{mantissa[1:]}".rstrip("0").rstrip(".") + "e%+03d" % power


class Page(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def file(self, content, name="scene.txt"):
        with open(self.path(name), "w") as out:
            out.write(content)
        return self.path(name)

    def recording(self, *options):
        subprocess.run([RECORDER, self.path("scene.swiftprox"), *options], check=True, timeout=60)
        return self.path("scene.swiftprox")

    def run_tool(self, *arguments, **options):
        return subprocess.run([TOOL, *arguments], capture_output=True, text=True, timeout=60, **options)

    def make(self, scene, *options):
        """The page of a scene."""
        done = self.run_tool(scene, *options, "--html", self.path("page.html"))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"page\.html: \d+\.\d MB, \d+ steps, \d+ bodies, \d+ of \d+ pairs\n$")
        return self.path("page.html")

    def lines(self, scene, *options):
        """What the tool prints of it."""
        done = self.run_tool(scene, *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.splitlines()


def blocks(path):
    with open(path, encoding="utf-8") as page:
        text = page.read()
    found = {name: base64.b64decode(data) for name, data in re.findall(r'<script type="text/plain" id="([\w.]+)">([^<]*)<', text)}
    return json.loads(re.search(r'id="head">(.*?)</script>', text)[1]), found


def numbers(data, kind):
    return [number for number, in struct.iter_unpack("<" + kind, data)]


def groups(items, size):
    return [items[i:i + size] for i in range(0, len(items), size)]


class Data(Page):
    def test_it_loads_nothing(self):
        with open(self.make(self.file(BOXES + "step\n")), encoding="utf-8") as page:
            text = page.read()
        self.assertIn("default-src 'none'", text)
        self.assertEqual(set(re.findall(r"https?://[^\"'` ]*", text)), {"http://www.w3.org/2000/svg"})  # the name of SVG
        self.assertEqual(re.findall(r"(?:\ssrc|\shref)\s*=|url\(|@import|\bfetch\(|\bimport\(|XMLHttpRequest|WebSocket", text), [])
        self.assertEqual(re.findall(r"@[A-Z]+@", text), [])
        self.assertLess(len(text), 100000)

    def test_names_of_files_stay_text(self):
        scene = self.file(BOXES + "step\n", "a<script><!-- \"\\.txt")
        head, _ = blocks(self.make(scene))
        self.assertEqual(head["scene"], os.path.basename(scene))

    def test_numbers_are_those_that_are_printed(self):
        draw = random.Random(5)
        scene = BOXES
        for _ in range(6):
            scene += "step\n" + at(1, *(draw.uniform(-1.5, 1.5) for _ in range(3))) + at(2, *(draw.uniform(-2, 2) for _ in range(3)))
        options = ("--query", "contact", "--max-distance", "2")
        _, data = blocks(self.make(self.file(scene), *options))
        counts = [words[2] for words in groups(numbers(data["steps"], "I"), STEP_WORDS)]
        steps = [step for step, count in enumerate(counts) for _ in range(count)]
        lines = []
        for step, bodies, codes, (value, lower, upper) in zip(
                steps, groups(numbers(data["pair.bodies"], "I"), 2), groups(data["pair.codes"], PAIR_CODES),
                groups(numbers(data["pair.intervals"], "d"), 3)):
            if codes[0] == INTERSECTING:
                self.assertTrue(0 <= lower <= value <= upper)
                lines.append(f"{step} {bodies[0]} {bodies[1]} intersecting 0 0 0 {printed(value)}")
            else:
                lines.append(f"{step} {bodies[0]} {bodies[1]} separated {printed(value)} "
                             f"{printed(lower, decimal.ROUND_FLOOR)} {printed(upper, decimal.ROUND_CEILING)} nan")
        self.assertGreater(len(lines), 10)
        self.assertEqual(sorted(lines), sorted(self.lines(self.path("scene.txt"), *options)))

    def test_marches_end_at_the_witness_points(self):
        draw = random.Random(6)
        scene = BOXES + "".join("step\n" + at(1, draw.uniform(1.7, 3), 0.3, 0.2) + at(2, draw.uniform(3.5, 5), 0.1, 1) for _ in range(6))
        head, data = blocks(self.make(self.file(scene), "--query", "distance"))
        kinds, lines = iter(data["march.kinds"]), iter(groups(numbers(data["march.lines"], "f"), 6))
        points, count = iter(groups(numbers(data["pair.points"], "d"), 9)), 0
        for codes in groups(data["pair.codes"], PAIR_CODES):
            drawn = [(next(kinds), next(lines)) for _ in range(codes[9] + 256 * codes[10])]
            steps = [line for kind, line in drawn if kind == MARCH]
            self.assertGreater(len(steps), 0)
            if codes[6]:
                point = next(points)
                self.assertEqual(drawn[-1][0], MARCH)
                for k in range(3):  # from object 2 to object 1
                    self.assertAlmostEqual(drawn[-1][1][k] + head["origin"][k], point[3 + k], delta=1e-6)
                    self.assertAlmostEqual(drawn[-1][1][3 + k] + head["origin"][k], point[k], delta=1e-6)
                count += 1
        self.assertGreater(count, 10)
        self.assertEqual((next(kinds, None), next(lines, None), next(points, None)), (None, None, None))

    def test_poses_are_those_of_the_scene_up_to_the_precision_that_is_said(self):
        draw = random.Random(3)
        scene, poses, far = BOXES, [], 1e6  # far from the world's origin, where floats are coarse
        for _ in range(20):
            scene += "step\n"
            moved = {}
            for body in draw.sample(range(3), 2):
                q = [draw.gauss(0, 1) for _ in range(4)]
                size = math.hypot(*q)
                x, y, z, w = (part / size for part in q)
                rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
                place = [far + draw.uniform(-5, 5) for _ in range(3)]
                moved[body] = [rows[i] + [place[i]] for i in range(3)]
                scene += f"{body} " + " ".join(repr(number) for row in moved[body] for number in row) + "\n"
            poses.append(moved)
        head, data = blocks(self.make(self.file(scene), "--query", "intersection"))
        centre = head["shapes"][0]["centre"]
        moves = iter(zip(numbers(data["move.bodies"], "I"), groups(numbers(data["move.places"], "f"), 3),
                         groups(numbers(data["move.turns"], "h"), 4)))
        counts = [words[1] for words in groups(numbers(data["steps"], "I"), STEP_WORDS)]
        self.assertEqual(counts, [3] + [2] * 19)  # what stands still is not told again
        for step, moved in enumerate(poses):
            for _ in range(counts[step]):
                body, place, turn = next(moves)
                if body not in moved:
                    continue
                rows = moved[body]
                reach = max(abs(part) for part in place)
                for k in range(3):
                    true = sum(rows[k][i] * centre[i] for i in range(3)) + rows[k][3]
                    self.assertLessEqual(abs(place[k] + head["origin"][k] - true), reach * 2.0 ** -23 + 1e-9)
                x, y, z, w = (part / head["turnScale"] for part in turn)
                self.assertAlmostEqual(math.hypot(x, y, z, w), 1, delta=1e-4)
                self.assertAlmostEqual(1 - 2 * (y * y + z * z), rows[0][0], delta=2e-4)
                self.assertAlmostEqual(2 * (x * y + z * w), rows[1][0], delta=2e-4)
                self.assertAlmostEqual(2 * (x * z - y * w), rows[2][0], delta=2e-4)
                self.assertAlmostEqual(2 * (y * z + x * w), rows[2][1], delta=2e-4)

    def test_a_recording_of_objects_that_come_and_go(self):
        _, data = blocks(self.make(self.recording(), "--verify"))
        gone = [body for body, place in zip(numbers(data["move.bodies"], "I"), groups(numbers(data["move.places"], "f"), 3))
                if math.isnan(place[0])]
        self.assertEqual(gone, [1])
        pairs = groups(numbers(data["pair.bodies"], "I"), 2)
        self.assertEqual(sorted(pairs), [[0, 1], [0, 1], [0, 2], [0, 3], [1, 2], [2, 0xffffffff]])

    def test_a_ground_is_drawn_and_touched(self):
        """Four by three heights with a hole at the corner of one of six cells: ten triangles are left. A cube is 0.25 in them."""
        head, data = blocks(self.make(self.recording("ground"), "--verify"))
        self.assertEqual([shape["isGround"] for shape in head["shapes"]], [True, False])
        shape, cube = head["shapes"]
        self.assertEqual((shape["vertices"], shape["triangles"], shape["centre"]), (12, 10, [6, 4, 0.25]))
        self.assertGreaterEqual(shape["radius"], math.hypot(6, 4))
        vertices = groups(numbers(data["shape.vertices"], "f"), 3)[:12]
        heights = [0.5 if v == 11 else 0 for v in range(12)]
        for v in set(range(12)) - {8}:
            self.assertEqual(vertices[v], [4 * (v % 4) - 6, 4 * (v // 4) - 4, heights[v] - 0.25])
        triangles = groups(numbers(data["shape.triangles"], "I"), 3)
        cells = [(row, column) for row in range(2) for column in range(3) if (row, column) != (1, 0)]
        wanted = [[a, *pair] for row, column in cells for a in (4 * row + column,) for pair in ((a + 1, a + 5), (a + 5, a + 4))]
        self.assertEqual(triangles[:len(wanted)], wanted)
        self.assertEqual(len(triangles), len(wanted) + cube["triangles"])
        self.assertEqual(groups(numbers(data["bodies"], "I"), 4), [[0, 0, 0, 1], [1, 0, 1, 0]])
        self.assertEqual(head["origin"], cube["centre"])  # a ground may reach far beyond the others
        moves = list(zip(numbers(data["move.bodies"], "I"), groups(numbers(data["move.places"], "f"), 3)))
        self.assertEqual(moves, [(0, [25.5, 3.5, -0.25]), (1, [0, 0, 0]), (0, [1.25, -3, 0])])
        self.assertEqual(groups(numbers(data["pair.bodies"], "I"), 2), [[0, 1]])
        codes = list(data["pair.codes"])
        self.assertEqual((codes[0], codes[7] + 256 * codes[8]), (INTERSECTING, 4))
        for on_ground, on_cube in ((point[:3], point[3:]) for point in groups(numbers(data["contact.points"], "f"), 6)):
            self.assertEqual((on_ground[2], on_cube[2]), (-0.25, -0.5))  # seen from the cube's centre
            self.assertEqual((abs(on_cube[0]), abs(on_cube[1])), (0.5, 0.5))
        gaps = groups(numbers(data["contact.gaps"], "d"), 2)
        self.assertTrue(all(lower <= -0.25 <= upper for lower, upper in gaps))

    def test_the_pieces_of_a_compound_are_drawn_and_named(self):
        """Each under the pose of the object, by numbers that doubles have: the second piece is turned, in an object that is too."""
        head, data = blocks(self.make(self.recording("compound"), "--verify"))
        self.assertEqual(len(head["shapes"]), 1)
        self.assertEqual(groups(numbers(data["bodies"], "I"), 4), [[0, 0, 0, 0], [0, 1, 0, 0], [1, 0, 0, 0]])
        self.assertEqual([words[1] for words in groups(numbers(data["steps"], "I"), STEP_WORDS)], [3, 2, 2])
        places = groups(numbers(data["move.places"], "f"), 3)
        seen = [[round(place[k] + head["origin"][k], 6) for k in range(3)] for place in places[:5]]
        self.assertEqual(seen, [[9.5, 0.5, 0.5], [9.5, 2.5, 0.5], [8.75, 3, 0.75], [0.5, 0.5, 0.5], [2.5, 0.5, 0.5]])
        half, scale = math.sqrt(0.5), head["turnScale"]
        turns = [[round(part / scale, 4) for part in turn] for turn in groups(numbers(data["move.turns"], "h"), 4)]
        self.assertEqual(turns[:5], [[0, 0, round(z, 4), round(w, 4)] for z, w in ((half, half), (1, 0), (0, 1), (0, 1), (half, half))])
        self.assertEqual(numbers(data["move.bodies"], "I"), [0, 1, 2, 0, 1, 0, 1])
        self.assertTrue(all(math.isnan(place[0]) for place in places[5:]))
        self.assertEqual(groups(numbers(data["pair.bodies"], "I"), 2), [[1, 2]])
        codes = list(data["pair.codes"])
        self.assertEqual((codes[0], codes[7] + 256 * codes[8]), (INTERSECTING, 4))
        self.assertIn(MARCH, list(data["march.kinds"]))

    def test_the_nearest_pairs_are_kept_where_all_have_no_room(self):
        count, steps = 340, 7
        draw = random.Random(1)
        scene = HEAD + f"shape box {MODELS}/box.off\n" + "object box\n" * count
        for _ in range(steps):
            scene += "step\n" + "".join(at(i, *(draw.uniform(-40, 40) for _ in range(3))) for i in range(count))
        page = self.make(self.file(scene))
        self.assertLess(os.path.getsize(page), 57e6)
        self.assertGreater(os.path.getsize(page), 55e6)
        _, data = blocks(page)
        words = groups(numbers(data["steps"], "I"), STEP_WORDS)
        self.assertEqual([row[3] for row in words], [count * (count - 1) // 2] * steps)
        kept = words[0][2]
        self.assertEqual([row[2] for row in words], [kept] * steps)
        values = groups(numbers(data["pair.intervals"], "d"), 3)
        distances = [0 if math.isnan(value) else value for value, _, _ in values[:kept]]
        self.assertEqual(distances, sorted(distances))
        listed = sorted(float(line.split()[4]) for line in self.lines(self.file(scene.split("step\n")[0] + "step\n" +
                                                                               scene.split("step\n")[1])))
        self.assertEqual(distances, listed[:kept])

    def test_refusals_leave_what_was_there(self):
        page = self.file("kept", "page.html")
        scene = self.file(BOXES + "step\n")

        def refused(status, message, *arguments, **options):
            done = self.run_tool(*arguments, **options)
            self.assertEqual((done.returncode, done.stdout), (status, ""))
            self.assertIn(message, done.stderr)
            with open(page) as file:
                self.assertEqual(file.read(), "kept")
            self.assertEqual([name for name in os.listdir(self.folder) if name.endswith(".part")], [])

        refused(2, "No such file", scene, "--html", self.path("none/page.html"))
        refused(2, "irectory", scene, "--html", self.folder)
        refused(2, "it is a device or a pipe", scene, "--html", "/dev/null")
        refused(2, "--html would replace the scene", scene, "--html", scene)
        refused(2, "--html has no meaning beside --bench", scene, "--html", page, "--bench", "1")
        refused(2, "there is no step to show", self.file(BOXES, "empty.txt"), "--html", page)
        refused(2, "No such file", self.path("missing.txt"), "--html", page)

        def no_room():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

        refused(1, "page.html: it cannot be written: File too large", scene, "--html", page, preexec_fn=no_room)
        refused(1, "out.html: it cannot be written: File too large", scene, "--html", self.path("out.html"), preexec_fn=no_room)
        self.assertNotIn("out.html", os.listdir(self.folder))


COUNTER = """
window.drawn = { frames: 0, lines: 0, triangles: 0, shadows: 0 };
const context = WebGL2RenderingContext.prototype, draw = context.drawElementsInstanced, clear = context.clear;
context.drawElementsInstanced = function(kind, length, type, offset, count) {
  const isSeen = this.getParameter(this.FRAMEBUFFER_BINDING) === null;
  drawn[kind === this.LINES ? "lines" : isSeen ? "triangles" : "shadows"] += count;
  return draw.call(this, kind, length, type, offset, count);
};
context.clear = function(mask) {
  const isSeen = this.getParameter(this.FRAMEBUFFER_BINDING) === null;
  drawn.frames += isSeen && mask & this.COLOR_BUFFER_BIT ? 1 : 0;
  return clear.call(this, mask);
};"""


class Browser(Page):
    def open(self, tab, page, moves=False):
        """It stands still unless it `moves`, as whoever wants no motion sees it."""
        tab.call("Emulation.setEmulatedMedia",
                 features=[{"name": "prefers-reduced-motion", "value": "no-preference" if moves else "reduce"}])
        tab.open("file://" + page)
        failed = [event for event in tab.events if event.get("method") == "Runtime.exceptionThrown"]
        self.assertEqual(failed, [])
        loaded = {event["params"]["request"]["url"] for event in tab.events if event.get("method") == "Network.requestWillBeSent"}
        self.assertEqual(loaded, {"file://" + page})

    def open_counting(self, tab, page, moves=False):
        """With what its first frames draw in `drawn`: bodies by the kind of their primitives."""
        script = tab.call("Page.addScriptToEvaluateOnNewDocument", source=COUNTER)["identifier"]
        self.open(tab, page, moves)
        tab.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)
        tab.frame()

    def around(self, tab, spot, radius=2):
        """The colours about a place of the view."""
        return {pixel for row in tab.pixels((spot[0] - radius, spot[1] - radius, 2 * radius + 1, 2 * radius + 1)) for pixel in row}

    def test_the_page(self):
        with browser.Browser(1000, 700) as tab:
            self.numbers_are_printed_alike(tab)
            self.every_pair_says_what_the_tool_prints(tab, self.recording())
            self.every_pair_says_what_the_tool_prints(tab, self.boxes(), "--query", "contact", "--max-distance", "3")
            self.bodies_are_where_they_are(tab)
            self.pairs_are_picked_by_clicks(tab)
            self.it_obeys_keys(tab)
            self.it_opens_playing_until_somebody_acts(tab)
            self.a_grid_and_shadows_are_below_the_bodies(tab)
            self.a_crowd_is_drawn_once_and_without_edges_that_nobody_sees(tab)
            self.a_large_scene_waits_and_throws_no_shadows(tab)
            self.a_ground_is_lit_and_picked(tab)
            self.a_compound_is_picked_by_its_pieces(tab)

    def boxes(self):
        """Three boxes beside each other; the third moves over the second, then into it."""
        return self.file(BOXES + "step\n" + at(1, 3) + at(2, 6) + "step\n" + at(2, 3.1, 0.2, 1) + "step\n" + at(2, 3.1, 0.2, 0.45))

    def numbers_are_printed_alike(self, tab):
        self.open(tab, self.make(self.boxes()))
        draw = random.Random(9)
        values = [0.0, -0.0, 1.0, 0.1, 100.0, 1e16, 1e17, 123456789012345678.0, 1e-4, 1e-5, 5e-324, 1.7976931348623157e308, 2.0 ** -25,
                  -2.0 ** -25, 0.5 + 2.0 ** -53, 1 - 2.0 ** -53, 9.9999999999999999e22, 0.0001 - 2.0 ** -66]
        while len(values) < 300:
            value, = struct.unpack("<d", draw.randbytes(8))
            values += [value, draw.uniform(-1, 1)] if math.isfinite(value) else []
        for direction, rounding in ((0, decimal.ROUND_HALF_EVEN), (-1, decimal.ROUND_FLOOR), (1, decimal.ROUND_CEILING)):
            shown = tab.run(f"{json.dumps(values)}.map(value => printed(value, {direction}))")
            self.assertEqual(shown, [printed(value, rounding) for value in values])
        self.assertEqual([printed(value) for value in values], ["%.17g" % value for value in values])

    def every_pair_says_what_the_tool_prints(self, tab, scene, *options):
        self.open(tab, self.make(scene, *options))
        shown = []
        for step in range(tab.run("Number(document.getElementById('step').max)") + 1):
            tab.run(f"(() => {{ const slider = document.getElementById('step'); slider.value = {step};"
                    " slider.dispatchEvent(new Event('input')); })()")
            rows = tab.run("document.querySelectorAll('#list tbody tr').length")
            for row in range(rows):
                tab.run(f"document.querySelectorAll('#list tbody tr')[{row}].click()")
                shown.append(tab.run("document.getElementById('line').textContent"))
        self.assertEqual(sorted(shown), sorted(self.lines(scene, *options)))

    def bodies_are_where_they_are(self, tab):
        """By their projections: a body is drawn there in a colour of its own, and not where it is no more. What touches is marked."""
        self.open(tab, self.make(self.boxes(), "--query", "contact", "--max-distance", "0"))
        self.assertTrue(tab.run("page.isSolid"))
        tab.key("g")  # no ground behind them
        paper = {tuple(tab.run("partsOf(readColours().paper).slice(0, 3)"))}
        tab.frame()
        spots = [tab.run(f"page.spotOfBody({body})") for body in range(3)]
        colours = [self.around(tab, spot, 0) for spot in spots]
        self.assertEqual(len(set.union(paper, *colours)), 4)
        before = self.around(tab, spots[2])
        tab.key("ArrowRight")
        tab.frame()
        self.assertEqual(self.around(tab, spots[2]), paper)  # it has gone
        self.assertNotEqual(before, paper)
        self.assertNotEqual(self.around(tab, tab.run("page.spotOfBody(2)")), paper)
        touching = tuple(tab.run("partsOf(readColours().touching).slice(0, 3)"))
        self.assertEqual(tab.run("document.querySelectorAll('#list tbody tr').length"), 0)
        tab.key("ArrowRight")
        tab.frame()
        self.assertEqual(tab.run("document.querySelector('#list tbody tr').dataset.pair"), "1 2")
        mark = tab.run("spotOf(pairOf(page.recording, findPair(page.recording, 2, 1, 2)), projector(page.camera))")
        self.assertIn(touching, self.around(tab, [round(x) for x in mark]))

    def pairs_are_picked_by_clicks(self, tab):
        self.open(tab, self.make(self.boxes(), "--query", "distance", "--max-distance", "3"))
        tab.frame()
        for body in (2, 1):
            tab.click(*tab.run(f"page.spotOfBody({body})"))
        self.assertEqual(tab.run("page.state.picked"), [1, 2])
        self.assertEqual(tab.run("document.getElementById('line').textContent").split()[:3], ["0", "1", "2"])
        tab.key("ArrowRight")  # where the third is over the second
        tab.frame()
        seen = tab.run("pairOf(page.recording, findPair(page.recording, 1, 1, 2)).march.filter(line => line.isFeature)"
                       ".map(({ drawn: [a, b] }) => projector(page.camera)(add(a, add(b, a, -1), 0.3)))")
        march = tuple(tab.run("partsOf(readColours().march).slice(0, 3)"))
        self.assertGreater(len(seen), 0)
        for spot in seen:
            self.assertIn(march, self.around(tab, [round(x) for x in spot]))
        tab.key("ArrowLeft")
        tab.key("Escape")
        self.assertIsNone(tab.run("page.state.picked"))
        tab.frame()
        between = tab.run("projector(page.camera)(middle(...pairOf(page.recording, findPair(page.recording, 0, 0, 1)).drawn))")
        tab.click(*between)
        self.assertEqual(tab.run("page.state.picked"), [0, 1])

    def it_obeys_keys(self, tab):
        self.assertEqual(tab.run("page.state.step"), 0)
        tab.key("End")
        self.assertEqual(tab.run("page.state.step"), 2)
        tab.key("Home")
        self.assertEqual(tab.run("page.state.step"), 0)
        tab.key(" ")
        self.assertEqual(tab.run("document.getElementById('play').textContent"), "Pause")
        tab.key(" ")
        self.assertEqual(tab.run("document.getElementById('play').textContent"), "Play")

    def it_opens_playing_until_somebody_acts(self, tab):
        def wait_for(step):
            tab.run(f"new Promise(done => {{ const look = () => page.state.step === {step} ? done() : setTimeout(look, 5); look(); }})")

        def middle_of(selector):
            return tab.run(f"(() => {{ const box = document.querySelector('{selector}').getBoundingClientRect();"
                           " return [box.x + box.width / 2, box.y + box.height / 2]; })()")

        def plays():
            return (tab.run("page.state.isPlaying"), tab.run("document.getElementById('play').textContent"))

        page = self.make(self.boxes(), "--query", "contact", "--max-distance", "3")
        for selector in ("#play", "#step", "#list tbody tr"):
            self.open(tab, page, moves=True)
            self.assertEqual(plays(), (True, "Pause"))
            self.assertEqual(tab.run("document.getElementById('speed').value"), "1")  # three steps
            tab.run("(() => { const speed = document.getElementById('speed'); speed.value = '30';"
                    " speed.dispatchEvent(new Event('change')); })()")
            wait_for(2)
            wait_for(0)  # and anew
            tab.click(*middle_of(selector))
            self.assertEqual(plays(), (False, "Play"))
        self.assertIsNotNone(tab.run("page.state.picked"))  # the row, though rows change while it plays
        self.open(tab, page)
        self.assertEqual(plays(), (False, "Play"))  # for who wants no motion
        self.open(tab, self.make(self.file(BOXES + "step\n")), moves=True)
        self.assertEqual(plays(), (False, "Play"))  # there is one step
        self.assertEqual(tab.run("Array.from(document.querySelectorAll('details'), details => details.open)"), [False] * 2)

    def a_grid_and_shadows_are_below_the_bodies(self, tab):
        """The third box floats high above the others. Its shadow is where the light puts it, by arithmetic of its own."""
        self.open(tab, self.make(self.file(BOXES + "step\n" + at(1, 3) + at(2, 1, -2.5, 2))))
        middle, ground, light = (tab.run(script) for script in
                                 ("placeOf(page.recording, moveOf(page.recording, 2, 0))", "page.camera.ground", "lightOf(page.camera)"))
        self.assertAlmostEqual(middle[2] - ground[2], 2 + 0.3, delta=1e-5)  # the lowest are 0.3 below their centres
        far = (middle[2] - ground[2]) / light[2]
        shaded, beside = ([int(x) for x in tab.run(f"projector(page.camera)({point})")] for point in
                          ([middle[k] - far * light[k] for k in range(3)], [ground[0], ground[1] - 2.5, ground[2]]))
        shown = [self.around(tab, shaded, 1), self.around(tab, beside, 25)]
        tab.key("g")
        tab.frame()
        hidden = [self.around(tab, shaded, 1), self.around(tab, beside, 25)]
        paper = {tuple(tab.run("partsOf(readColours().paper).slice(0, 3)"))}
        self.assertEqual(hidden, [paper, paper])
        self.assertLess(max(map(sum, shown[0])), sum(*paper) - 60)  # a shadow
        self.assertGreater(len(shown[1]), 2)  # lines of a grid
        self.assertLess(min(map(sum, shown[1])), sum(*paper) - 10)

    def a_crowd_is_drawn_once_and_without_edges_that_nobody_sees(self, tab):
        """What opening a crowd costs is drawing, where there is no graphics card: each frame of 10,000 bodies seconds of it. Two frames
        with the edges of all were drawn until November 2026."""
        bodies, draw = 200, random.Random(4)
        scene = HEAD + f"shape box {MODELS}/box.off\n" + "object box\n" * bodies + "step\n"
        scene += "".join(at(i, *(draw.uniform(-50, 50) for _ in range(3))) for i in range(bodies))
        page = self.make(self.file(scene), "--query", "intersection")
        self.open_counting(tab, page)
        self.assertEqual(tab.run("drawn"), {"frames": 1, "lines": 0, "triangles": bodies, "shadows": bodies})
        near = tab.run("(() => { const { camera, recording } = page; camera.target = placeOf(recording, moveOf(recording, 7, 0));"
                       " camera.distance = 10; page.draw(); return drawn.lines; })()")
        self.assertTrue(0 < near < bodies, near)

    def a_large_scene_waits_and_throws_no_shadows(self, tab):
        bodies, draw = 1251, random.Random(5)  # of 400 triangles: half a million
        scene = HEAD + f"shape body {MODELS}/ellipsoid.off\n" + "object body\n" * bodies + "step\n"
        scene += "".join(at(i, *(draw.uniform(-90, 90) for _ in range(3))) for i in range(bodies)) + "step\n" + at(0, 1)
        self.open_counting(tab, self.make(self.file(scene), "--query", "intersection"), moves=True)
        self.assertEqual(tab.run("drawn"), {"frames": 1, "lines": 0, "triangles": bodies, "shadows": 0})
        self.assertFalse(tab.run("page.state.isPlaying"))

    def a_ground_is_lit_and_picked(self, tab):
        """Under the cube and in its shadow, instead of the grid. A click finds it, and with the cube its pair."""
        self.open(tab, self.make(self.recording("ground"), "--query", "contact"))
        tab.key("End")
        tab.frame()
        light = tab.run("lightOf(page.camera)")
        shade = [0.6, 0.15, -0.25]  # beside the cube, whose half sides are 0.5; the ray to the light leaves through its top
        self.assertTrue(all(abs(shade[k] + 0.75 * light[k] / light[2]) < 0.45 for k in range(2)))
        spots = {"shade": shade, "ground": [0.9, -0.9, -0.25]}
        spots = {name: [int(x) for x in tab.run(f"projector(page.camera)({spot})")] for name, spot in spots.items()}
        seen = {name: max(map(sum, self.around(tab, spot, 1))) for name, spot in spots.items()}
        paper = tab.run("partsOf(readColours().paper).slice(0, 3)")
        self.assertLess(seen["ground"], sum(paper) - 20)
        self.assertEqual(tab.run("placeOfPair(pairOf(page.recording, 0)).map(x => Math.round(1e6 * x) / 1e6)"), [0, 0, -0.375])
        self.assertLess(seen["shade"], seen["ground"] - 40)
        tab.click(*spots["ground"])
        self.assertEqual(tab.run("page.state.body"), 0)
        tab.click(*tab.run("page.spotOfBody(1)"))
        self.assertEqual(tab.run("page.state.picked"), [0, 1])
        self.assertIn("4 points", tab.run("document.getElementById('pair').textContent"))
        tab.key("Escape")
        tab.key("g")
        tab.frame()
        self.assertEqual(self.around(tab, spots["ground"], 1), {tuple(paper)})
        tab.click(*spots["ground"])
        self.assertEqual(tab.run("page.state.body"), 0xffffffff)
        tab.key("g")

    def a_compound_is_picked_by_its_pieces(self, tab):
        self.open(tab, self.make(self.recording("compound"), "--query", "contact", "--max-distance", "2"))
        tab.key("g")
        tab.frame()
        paper = {tuple(tab.run("partsOf(readColours().paper).slice(0, 3)"))}
        for body in (0, 1):
            self.assertNotEqual(self.around(tab, tab.run(f"page.spotOfBody({body})"), 0), paper)
        rows = tab.run("Array.from(document.querySelectorAll('#list tbody tr'), row => row.cells[0].textContent)")
        self.assertEqual(rows, ["0.1 and 1", "0.0 and 1"])
        tab.click(*tab.run("page.spotOfBody(0)"))  # it stands before the others
        self.assertEqual(tab.run("page.state.body"), 0)
        self.assertIn("Body 0.0 is picked", tab.run("document.getElementById('pair').textContent"))
        tab.key("Escape")
        tab.run("document.querySelector('#list tbody tr').click()")
        self.assertEqual(tab.run("page.state.picked"), [1, 2])
        self.assertIn("4 points", tab.run("document.getElementById('pair').textContent"))
        tab.key("g")

    def test_without_webgl_edges_are_drawn_and_words_say_so(self):
        with browser.Browser(1000, 700, ["--disable-3d-apis"]) as tab:
            self.open(tab, self.make(self.boxes()))
            self.assertFalse(tab.run("page.isSolid"))
            self.assertIn("no WebGL 2", tab.run("document.getElementById('notice').textContent"))
            tab.frame()
            spot = tab.run("page.spotOfBody(1)")
            self.assertGreater(len(self.around(tab, spot, 40)), 1)
            tab.click(*spot)
            self.assertEqual(tab.run("page.state.body"), 1)
            self.open(tab, self.make(self.recording("ground")))
            tab.key("End")
            tab.frame()
            edge = tab.run("projector(page.camera)([-0.75, 0.1, -0.25])")  # on a rim of the ground, at its hole
            self.assertGreater(len(self.around(tab, [round(x) for x in edge])), 1)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

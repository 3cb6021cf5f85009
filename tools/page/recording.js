
/* ---- recording.js: the scene's data, and where to find what in them (tools/page_file.c writes them) ---- */

const NO_BODY = 0xffffffff;
const OUTCOMES = ["none", "separated", "beyond", "intersecting", "undecided"];
const SEPARATED = 1, INTERSECTING = 3;
const DECISIONS = ["nothing", "marching", "coherence", "fallback", "integers", "tolerance", "budget", "bounding spheres",
  "inscribed spheres"];
const FEATURES = ["none", "vertex", "edge", "face"];
const KINDS = ["intersection", "distance", "contact", "approximate distance"];
const LEVELS = 8;
const STEP_WORDS = 5 + DECISIONS.length + LEVELS;
const PAIR_CODES = 11;
const DRAWN_MARCH = 7; /* of swiftprox_draw_kind: other lines of a march are features */

/* Places where the runs of `counts` begin, and where the last ends. */
function firstOf(length, countOf) {
  const first = new Uint32Array(length + 1);
  for (let i = 0; i < length; i++) {
    first[i + 1] = first[i] + countOf(i);
  }
  return first;
}

/* Edges between faces that are not nearly in one plane, as pairs of vertices: what is drawn as lines. */
function findEdges(vertices, triangles) {
  const FLAT = Math.cos(12 * Math.PI / 180);
  const count = vertices.length / 3;
  const normals = new Float64Array(triangles.length);
  const owner = new Map(); /* of directed edges */
  const point = (v, k) => vertices[3 * v + k];
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = triangles.subarray(t, t + 3);
    const u = [0, 1, 2].map(k => point(b, k) - point(a, k)), v = [0, 1, 2].map(k => point(c, k) - point(a, k));
    normals.set(unit(cross(u, v)), t);
    owner.set(a * count + b, t).set(b * count + c, t).set(c * count + a, t);
  }
  const edges = [];
  for (const [key, t] of owner) {
    const a = Math.floor(key / count), b = key % count;
    const other = owner.get(b * count + a);
    const isFlat = other !== undefined &&
      normals[t] * normals[other] + normals[t + 1] * normals[other + 1] + normals[t + 2] * normals[other + 2] > FLAT;
    if (other === undefined || (a < b && !isFlat)) {
      edges.push(a, b);
    }
  }
  if (triangles.length === 0 && count === 2) {
    edges.push(0, 1); /* a segment */
  }
  return new Uint32Array(edges);
}

/* Without a graphics card the lines of a larger ground would take seconds a frame. */
const MOST_EDGED_TRIANGLES = 50000;

/* All edges of a ground, as pairs of vertices, and their mean length; none of a large one. */
function findGroundEdges(vertices, triangles) {
  if (triangles.length > 3 * MOST_EDGED_TRIANGLES) {
    return { edges: new Uint32Array(0), edgeLength: 0 };
  }
  const count = vertices.length / 3;
  const keys = new Float64Array(triangles.length);
  for (let i = 0; i < triangles.length; i++) {
    const [a, b] = [triangles[i], triangles[i % 3 === 2 ? i - 2 : i + 1]];
    keys[i] = Math.min(a, b) * count + Math.max(a, b);
  }
  const ends = keys.sort().filter((key, i) => i === 0 || key !== keys[i - 1]);
  const edges = new Uint32Array(2 * ends.length);
  let sum = 0;
  ends.forEach((key, i) => {
    const [a, b] = [Math.floor(key / count), key % count];
    edges.set([a, b], 2 * i);
    sum += Math.hypot(...[0, 1, 2].map(k => vertices[3 * a + k] - vertices[3 * b + k]));
  });
  return { edges, edgeLength: sum / ends.length };
}

/* Shapes and grounds share two arrays; each says where its part begins. */
function readShapes(head) {
  const vertices = takeArray("shape.vertices", Float32Array), triangles = takeArray("shape.triangles", Uint32Array);
  let vertex = 0, corner = 0;
  return head.shapes.map(({ vertices: count, triangles: faces, radius, isGround }) => {
    const shape = {
      isGround, radius: Math.max(radius, 1e-30),
      vertices: vertices.subarray(3 * vertex, 3 * (vertex + count)),
      triangles: triangles.subarray(corner, corner + 3 * faces),
    };
    Object.assign(shape, isGround ? findGroundEdges(shape.vertices, shape.triangles) :
      { edges: findEdges(shape.vertices, shape.triangles), edgeLength: shape.radius });
    vertex += count;
    corner += 3 * faces;
    return shape;
  });
}

/* The moves of each body in order, so that the last one up to a step is found by bisection. */
function readMoves(bodyCount, stepCount, firstMove) {
  const bodies = takeArray("move.bodies", Uint32Array);
  const counts = new Uint32Array(bodyCount);
  bodies.forEach(body => counts[body]++);
  const first = firstOf(bodyCount, body => counts[body]);
  const next = first.slice();
  const order = new Uint32Array(bodies.length), steps = new Uint32Array(bodies.length);
  for (let step = 0; step < stepCount; step++) {
    for (let move = firstMove[step]; move < firstMove[step + 1]; move++) {
      const place = next[bodies[move]]++;
      order[place] = move;
      steps[place] = step;
    }
  }
  return { first, order, steps, places: takeArray("move.places", Float32Array), turns: takeArray("move.turns", Int16Array) };
}

function readRecording() {
  const head = JSON.parse(document.getElementById("head").textContent);
  const bodies = takeArray("bodies", Uint32Array), steps = takeArray("steps", Uint32Array);
  const stepCount = steps.length / STEP_WORDS, bodyCount = bodies.length / 4;
  const stepWord = word => step => steps[STEP_WORDS * step + word];
  const codes = takeBytes("pair.codes");
  const pairCount = codes.length / PAIR_CODES;
  const code = (pair, at) => codes[PAIR_CODES * pair + at];
  return {
    head, steps, stepCount, bodyCount, bodies, pairCount, code,
    shapes: readShapes(head),
    moves: readMoves(bodyCount, stepCount, firstOf(stepCount, stepWord(1))),
    firstPair: firstOf(stepCount, stepWord(2)),
    pairBodies: takeArray("pair.bodies", Uint32Array),
    intervals: takeArray("pair.intervals", Float64Array),
    points: takeArray("pair.points", Float64Array),
    features: takeArray("pair.features", Uint32Array),
    contacts: takeArray("contact.points", Float32Array),
    gaps: takeArray("contact.gaps", Float64Array),
    kinds: takeBytes("march.kinds"),
    lines: takeArray("march.lines", Float32Array),
    firstPoint: firstOf(pairCount, pair => code(pair, 6)),
    firstContact: firstOf(pairCount, pair => code(pair, 7) + 256 * code(pair, 8)),
    firstLine: firstOf(pairCount, pair => code(pair, 9) + 256 * code(pair, 10)),
  };
}

/* ---- bodies ---- */

const objectOf = (recording, body) => recording.bodies[4 * body];
const isGround = (recording, body) => recording.shapes[shapeOf(recording, body)].isGround;
const hasGrounds = recording => recording.shapes.some(shape => shape.isGround);
const pieceOf = (recording, body) => recording.bodies[4 * body + 1];
const shapeOf = (recording, body) => recording.bodies[4 * body + 2];
const isFixed = (recording, body) => recording.bodies[4 * body + 3] !== 0;

/* What a body is called: its object, and its piece where that has several; - where it is in no scene. */
function nameOf(recording, body) {
  if (body === NO_BODY) {
    return "-";
  }
  const object = objectOf(recording, body);
  const hasMore = (body > 0 && objectOf(recording, body - 1) === object) ||
    (body + 1 < recording.bodyCount && objectOf(recording, body + 1) === object);
  return hasMore ? object + "." + pieceOf(recording, body) : String(object);
}

/* The move that put a body where it is in a step, or -1 where it is not there. */
function moveOf(recording, body, step) {
  const { first, order, steps, places } = recording.moves;
  let low = first[body], high = first[body + 1];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (steps[middle] <= step) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  if (low === first[body]) {
    return -1;
  }
  const move = order[low - 1];
  return Number.isNaN(places[3 * move]) ? -1 : move;
}

const placeOf = (recording, move) => Array.from(recording.moves.places.subarray(3 * move, 3 * move + 3));

function turnOf(recording, move) {
  const turn = Array.from(recording.moves.turns.subarray(4 * move, 4 * move + 4));
  const length = Math.hypot(...turn);
  return turn.map(part => part / length);
}

/* ---- pairs: numbered over all steps, in each the deepest and nearest first ---- */

/* The pair of two bodies in a step, or -1 where it is not kept. */
function findPair(recording, step, one, two) {
  for (let pair = recording.firstPair[step]; pair < recording.firstPair[step + 1]; pair++) {
    if (recording.pairBodies[2 * pair] === one && recording.pairBodies[2 * pair + 1] === two) {
      return pair;
    }
  }
  return -1;
}

/* How far apart a pair is, less than 0 where the objects overlap: the estimate and its interval. */
function gapOf(recording, pair) {
  const [value, lower, upper] = recording.intervals.subarray(3 * pair, 3 * pair + 3);
  if (recording.code(pair, 0) !== INTERSECTING) {
    return { value, lower, upper };
  }
  return Number.isNaN(value) ? { value: 0, lower: 0, upper: 0 } : { value: -value, lower: -upper, upper: -lower };
}

/* Numbers in the world frame, and the same seen from the page's origin, which are drawn. */
function pairOf(recording, pair) {
  const { code, head } = recording;
  const [value, lower, upper] = recording.intervals.subarray(3 * pair, 3 * pair + 3);
  const isIntersecting = code(pair, 0) === INTERSECTING;
  const answer = {
    bodies: Array.from(recording.pairBodies.subarray(2 * pair, 2 * pair + 2)),
    outcome: code(pair, 0), decidedBy: code(pair, 1), levels: [code(pair, 2), code(pair, 3)],
    isIntersecting,
    distance: isIntersecting ? 0 : value, lower: isIntersecting ? 0 : lower, upper: isIntersecting ? 0 : upper,
    depth: isIntersecting ? { value, lower, upper } : null,
    manifold: [], march: [],
  };
  const here = point => point.map((x, k) => x - head.origin[k]);
  if (code(pair, 6)) {
    const at = recording.firstPoint[pair];
    const numbers = Array.from(recording.points.subarray(9 * at, 9 * at + 9));
    const ids = recording.features.subarray(4 * at, 4 * at + 4);
    answer.world = [numbers.slice(0, 3), numbers.slice(3, 6)];
    answer.drawn = answer.world.map(here);
    answer.normal = numbers.slice(6);
    answer.features = [0, 1].map(i => ({ kind: code(pair, 4 + i), ids: ids.subarray(2 * i, 2 * i + 2) }));
  }
  for (let at = recording.firstContact[pair]; at < recording.firstContact[pair + 1]; at++) {
    const numbers = Array.from(recording.contacts.subarray(6 * at, 6 * at + 6));
    answer.manifold.push({ drawn: [numbers.slice(0, 3), numbers.slice(3)], lower: recording.gaps[2 * at], upper: recording.gaps[2 * at + 1] });
  }
  for (let at = recording.firstLine[pair]; at < recording.firstLine[pair + 1]; at++) {
    const numbers = Array.from(recording.lines.subarray(6 * at, 6 * at + 6));
    answer.march.push({ isFeature: recording.kinds[at] !== DRAWN_MARCH, drawn: [numbers.slice(0, 3), numbers.slice(3)] });
  }
  return answer;
}

/* The line that swiftprox-replay prints of a pair. */
function lineOf(recording, step, answer) {
  const objects = answer.bodies.map(body => body === NO_BODY ? "-" : objectOf(recording, body));
  const outcome = ["separated", "intersecting"].find(word => word === OUTCOMES[answer.outcome]) || "undecided";
  return [step, ...objects, outcome, printed(answer.distance), printed(answer.lower, -1), printed(answer.upper, 1),
    printed(answer.depth ? answer.depth.value : NaN)].join(" ");
}


/* ---- camera.js: vectors, and a camera that turns about a point ---- */

const add = (a, b, scale = 1) => a.map((x, k) => x + scale * b[k]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const middle = (a, b) => a.map((x, k) => 0.5 * (x + b[k]));

function unit(a) {
  const length = Math.hypot(...a);
  return length > 0 ? a.map(x => x / length) : a;
}

/* A vector turned by a unit quaternion x y z w. */
function turned(turn, v) {
  const [x, y, z, w] = turn;
  const t = cross([x, y, z], v).map(part => 2 * part);
  return add(add(v, t, w), cross([x, y, z], t));
}

const FIELD_OF_VIEW = 35 * Math.PI / 180;

function makeCamera() {
  /* extent: half of what moves; reach: how far anything is from the origin; ground: the point of it below the scene */
  return { target: [0, 0, 0], yaw: -1.05, pitch: 0.3, distance: 1, extent: 1, reach: 1, ground: [0, 0, 0], up: 2,
    width: 1, height: 1 };
}

/* The axes of the world, of which the last goes up. */
const worldAxes = up => [1, 2, 3].map(k => [0, 1, 2].map(i => i === (up + k) % 3 ? 1 : 0));

/* Towards the light, which stands still in the world: over the shoulder of an eye that has not turned. */
function lightOf(camera) {
  const [first, second, up] = worldAxes(camera.up);
  return unit(add(add(first.map(x => -0.3 * x), second, -0.55), up, 1.1));
}

/* The axes of the picture: to the right, up, and to the eye. */
function axesOf(camera) {
  const [first, second, up] = worldAxes(camera.up);
  const level = add(first.map(x => x * Math.cos(camera.yaw)), second, Math.sin(camera.yaw));
  const back = add(level.map(x => x * Math.cos(camera.pitch)), up, Math.sin(camera.pitch));
  const right = unit(cross(up, back));
  return { right, up: cross(back, right), back };
}

const eyeOf = camera => add(camera.target, axesOf(camera).back, camera.distance);

/* Column-major, as WebGL takes it. */
function matrixOf(camera) {
  const { right, up, back } = axesOf(camera);
  const eye = eyeOf(camera);
  const f = 1 / Math.tan(FIELD_OF_VIEW / 2);
  const far = camera.distance + Math.hypot(...camera.target) + camera.reach;
  const near = Math.max(camera.distance * 0.02, far * 1e-5);
  const rows = [
    [right, f * camera.height / camera.width],
    [up, f],
    [back, (far + near) / (near - far)],
  ].map(([axis, scale]) => [...axis.map(x => x * scale), -dot(axis, eye) * scale]);
  rows[2][3] += 2 * far * near / (near - far);
  rows.push([...back.map(x => -x), dot(back, eye)]);
  return Float32Array.from({ length: 16 }, (_, i) => rows[i % 4][i >> 2]);
}

/* Points of the scene as pixels of the page, or null behind the eye. */
function projector(camera) {
  const { right, up, back } = axesOf(camera);
  const eye = eyeOf(camera);
  const scale = camera.height / 2 / Math.tan(FIELD_OF_VIEW / 2);
  return point => {
    const seen = add(point, eye, -1);
    const depth = -dot(seen, back);
    return depth <= camera.distance * 0.02 ? null :
      [camera.width / 2 + scale * dot(seen, right) / depth, camera.height / 2 - scale * dot(seen, up) / depth];
  };
}

/* Pixels that a length at the target takes. */
const pixelsPerLength = camera => camera.height / 2 / Math.tan(FIELD_OF_VIEW / 2) / camera.distance;

function turnCamera(camera, dx, dy) {
  camera.yaw -= dx * 0.008;
  camera.pitch = Math.min(1.55, Math.max(-1.55, camera.pitch + dy * 0.008));
}

function moveCamera(camera, dx, dy) {
  const { right, up } = axesOf(camera);
  const scale = 1 / pixelsPerLength(camera);
  camera.target = add(add(camera.target, right, -dx * scale), up, dy * scale);
}

function zoomCamera(camera, factor) {
  camera.distance = Math.min(20 * camera.extent, Math.max(1e-5 * camera.extent, camera.distance * factor));
}

/* Spheres around bodies at a few moves of each over time, seen from the origin. */
function sampleSpheres(recording) {
  const { first, order, places } = recording.moves;
  const spheres = [];
  for (let body = 0; body < recording.bodyCount; body++) {
    const { radius } = recording.shapes[shapeOf(recording, body)];
    const stride = Math.max(1, Math.floor((first[body + 1] - first[body]) / 8));
    for (let at = first[body]; at < first[body + 1]; at += stride) {
      const move = order[at], [x, y, z] = places.subarray(3 * move, 3 * move + 3);
      if (!Number.isNaN(x)) {
        spheres.push({ body, move, radius, place: [x, y, z] });
      }
    }
  }
  return spheres;
}

/* A box that holds most of the spheres: one that is flung away does not make the others small. Null of none. */
function boxOf(spheres) {
  const quantile = (numbers, part) => numbers.sort()[Math.round(part * (numbers.length - 1))];
  const ends = (part, side) => [0, 1, 2].map(k =>
    quantile(Float64Array.from(spheres, ({ place, radius }) => place[k] + side * radius), part));
  return spheres.length === 0 ? null : [ends(0.01, -1), ends(0.99, 1)];
}

/* Puts spheres into the picture with a little room about them. */
function fitSpheres(camera, spheres) {
  const { right, up, back } = axesOf(camera);
  const slope = Math.tan(FIELD_OF_VIEW / 2), wide = slope * camera.width / camera.height;
  for (const axis of [right, up]) {
    const end = side => spheres.reduce((most, { place, radius }) => Math.max(most, side * dot(axis, place) + radius), -Infinity);
    camera.target = add(camera.target, axis, (end(1) - end(-1)) / 2 - dot(axis, camera.target));
  }
  const [x, y, z] = [right, up, back].map(axis => dot(axis, camera.target));
  camera.distance = spheres.reduce((most, { place, radius }) => {
    const aside = Math.max((Math.abs(dot(right, place) - x) + radius) / wide, (Math.abs(dot(up, place) - y) + radius) / slope);
    return Math.max(most, 1.05 * aside + dot(back, place) - z);
  }, 0);
}

/* How low the bodies in the spheres get, or `floor` without any. The spheres say which are worth a look. */
function lowestOf(recording, spheres, up, floor) {
  const axis = worldAxes(up)[2];
  let lowest = Infinity;
  for (const { body, move, radius, place } of spheres.slice().sort((a, b) => a.place[up] - a.radius - b.place[up] + b.radius)) {
    if (place[up] - radius >= lowest) {
      break;
    }
    const { vertices } = recording.shapes[shapeOf(recording, body)];
    const [x, y, z, w] = turnOf(recording, move), down = turned([-x, -y, -z, w], axis);
    for (let v = 0; v < vertices.length; v += 3) {
      lowest = Math.min(lowest, place[up] + dot(down, vertices.subarray(v, v + 3)));
    }
  }
  return Number.isFinite(lowest) ? lowest : floor;
}

/* Shows what moves, and of what is fixed all that is no larger than that and not far away. */
function frameScene(camera, recording) {
  const all = sampleSpheres(recording), moving = all.filter(({ body }) => !isFixed(recording, body));
  let shown = moving.length > 0 ? moving : all;
  let box = boxOf(shown) || [[-1, -1, -1], [1, 1, 1]];
  const halfOf = () => Math.hypot(...add(box[1], box[0], -1)) / 2;
  if (moving.length > 0) {
    const target = middle(...box), extent = halfOf();
    shown = all.filter(({ body, radius, place }) => !isFixed(recording, body) ||
      (radius <= extent && Math.hypot(...add(place, target, -1)) <= 2 * extent));
    box = boxOf(shown);
  }
  camera.target = middle(...box);
  camera.extent = Math.max(halfOf(), 1e-30);
  camera.reach = all.reduce((far, { place, radius }) => Math.max(far, Math.hypot(...place) + radius), camera.extent);
  const within = shown.filter(({ place }) => place.every((x, k) => x >= box[0][k] && x <= box[1][k]));
  camera.ground = camera.target.slice();
  camera.ground[camera.up] = lowestOf(recording, within, camera.up, box[0][camera.up]);
  fitSpheres(camera, within.length > 0 ? within : [{ place: camera.target, radius: camera.extent }]);
}

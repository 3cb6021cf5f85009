
/* ---- overlay.js: what is drawn over the bodies: pairs, the picked pair, axes and a length ---- */

function line(context, from, to) {
  if (from && to) {
    context.beginPath();
    context.moveTo(...from);
    context.lineTo(...to);
    context.stroke();
  }
}

function disc(context, spot, radius) {
  if (spot) {
    context.beginPath();
    context.arc(spot[0], spot[1], radius, 0, 2 * Math.PI);
    context.fill();
  }
}

function arrow(context, from, to) {
  const length = from && to ? Math.hypot(to[0] - from[0], to[1] - from[1]) : 0;
  if (length < 1) {
    return;
  }
  const along = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
  const size = Math.min(9, length / 2);
  const wing = side => [to[0] - size * along[0] + side * 0.45 * size * along[1], to[1] - size * along[1] - side * 0.45 * size * along[0]];
  line(context, from, [to[0] - 0.6 * size * along[0], to[1] - 0.6 * size * along[1]]);
  context.beginPath();
  [to, wing(1), wing(-1)].forEach((spot, i) => i ? context.lineTo(...spot) : context.moveTo(...spot));
  context.fill();
}

/* Words that can be read on whatever is behind. */
function label(context, words, spot, colours, colour = colours.ink) {
  context.lineWidth = 3;
  context.lineJoin = "round";
  context.strokeStyle = colours.paper;
  context.strokeText(words, ...spot);
  context.fillStyle = colour;
  context.fillText(words, ...spot);
}

/* Where a pair is: the middle between its witness points, or without these that of its manifold, as of a body in a ground; or null. */
function placeOfPair(answer) {
  if (answer.drawn && !Number.isNaN(answer.drawn[0][0])) {
    return middle(...answer.drawn);
  }
  const points = answer.manifold.map(point => middle(...point.drawn));
  return points.length > 0 ? points.reduce((sum, point) => add(sum, point, 1 / points.length), [0, 0, 0]) : null;
}

/* Where a pair is drawn, or null. */
function spotOf(answer, project) {
  const place = placeOfPair(answer);
  return place ? project(place) : null;
}

/* A dot that is seen on whatever is behind, filled or, of a pair that does not touch, hollow. */
function mark(context, spot, colours, colour, isFilled) {
  context.beginPath();
  context.arc(spot[0], spot[1], 3, 0, 2 * Math.PI);
  context.lineWidth = isFilled ? 2 : 4;
  context.strokeStyle = colours.paper;
  context.stroke();
  context.fillStyle = context.strokeStyle = isFilled ? colour : colours.paper;
  context.fill();
  if (!isFilled) {
    context.lineWidth = 1.5;
    context.strokeStyle = colour;
    context.stroke();
  }
}

/* The lines between all pairs, the nearest of many, and where they touch or nearly do. Returns where a click finds them. Without a
 * graphics card the marks of a crowd would take longer than its bodies: there are plain lines and dots instead. */
function drawPairs(context, recording, step, project, colours) {
  const MOST = 3000, MOST_MARKED = 300;
  const spots = [];
  const [from, to] = [recording.firstPair[step], recording.firstPair[step + 1]];
  const isMarked = to - from <= MOST_MARKED;
  for (let pair = from; pair < Math.min(to, from + MOST); pair++) {
    const answer = pairOf(recording, pair);
    const spot = spotOf(answer, project);
    if (!spot) {
      continue;
    }
    const colour = colours[colourOfOutcome(answer.outcome)];
    spots.push({ pair, spot, colour, isIntersecting: answer.isIntersecting });
    if (!answer.isIntersecting) {
      for (const [width, shade] of isMarked ? [[4, colours.paper], [1.5, colour]] : [[1, colour]]) {
        context.lineWidth = width;
        context.strokeStyle = shade;
        line(context, ...answer.drawn.map(project));
      }
    } else if (!isMarked) {
      context.fillStyle = colour;
      disc(context, spot, 2);
    }
  }
  if (isMarked) {
    spots.forEach(({ spot, colour, isIntersecting }) => mark(context, spot, colours, colour, isIntersecting));
  }
  return spots;
}

/* Points in their order around the normal, so that their outline does not cross itself. */
function aroundNormal(points, normal) {
  const centre = points.reduce((sum, point) => add(sum, point, 1 / points.length), [0, 0, 0]);
  const first = unit(cross(normal, Math.abs(normal[0]) < 0.7 ? [1, 0, 0] : [0, 1, 0])), second = cross(normal, first);
  const angle = point => Math.atan2(dot(add(point, centre, -1), second), dot(add(point, centre, -1), first));
  return points.slice().sort((a, b) => angle(a) - angle(b));
}

function drawManifold(context, answer, project, colours) {
  const points = answer.manifold.map(point => middle(...point.drawn));
  const spots = (answer.normal ? aroundNormal(points, answer.normal) : points).map(project);
  if (spots.length === 0 || spots.includes(null)) {
    return;
  }
  context.strokeStyle = context.fillStyle = colours.manifold;
  context.lineWidth = 1.5;
  context.beginPath();
  spots.forEach((spot, i) => i ? context.lineTo(...spot) : context.moveTo(...spot));
  context.closePath();
  context.globalAlpha = 0.3;
  context.fill();
  context.globalAlpha = 1;
  context.stroke();
  spots.forEach(spot => disc(context, spot, 3));
}

/* The way to the nearest features: those of each step, and dashed what lies between. */
function drawMarch(context, answer, project, colours) {
  context.strokeStyle = colours.march;
  for (const { isFeature, drawn } of answer.march) {
    context.lineWidth = isFeature ? 2 : 1;
    context.setLineDash(isFeature ? [] : [4, 3]);
    line(context, ...drawn.map(project));
  }
  context.setLineDash([]);
}

/* The picked pair: the march, its manifold, the normal, and the witness points with what lies between. */
function drawPicked(context, recording, answer, size, project, colours) {
  drawMarch(context, answer, project, colours);
  drawManifold(context, answer, project, colours);
  const spot = answer.drawn ? spotOf(answer, project) : null;
  if (spot && !Number.isNaN(answer.normal[0])) {
    context.strokeStyle = context.fillStyle = colours.normal;
    context.lineWidth = 1.5;
    arrow(context, spot, project(add(placeOfPair(answer), answer.normal, size)));
  }
  if (spot && !Number.isNaN(answer.drawn[0][0])) {
    context.strokeStyle = answer.isIntersecting ? colours.touching : colours.near;
    context.lineWidth = 2.5;
    line(context, ...answer.drawn.map(project));
    answer.drawn.forEach((point, i) => {
      context.fillStyle = i ? colours.two : colours.one;
      disc(context, project(point), 4.5 - i);
    });
  }
}

/* x, y and z in the corner. */
function drawAxes(context, camera, colours) {
  const LENGTH = 26;
  const { right, up, back } = axesOf(camera);
  const centre = [44, camera.height - 44];
  const order = [0, 1, 2].sort((a, b) => back[a] - back[b]);
  for (const axis of order) {
    const tip = [centre[0] + LENGTH * right[axis], centre[1] - LENGTH * up[axis]];
    context.strokeStyle = context.fillStyle = colours.quiet;
    context.lineWidth = 1.5;
    line(context, centre, tip);
    label(context, "xyz"[axis], [centre[0] + 1.35 * (tip[0] - centre[0]) - 3, centre[1] + 1.35 * (tip[1] - centre[1]) + 4], colours);
  }
}

/* 1, 2 or 5 times a power of ten: the largest that is not above. */
function roundLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].find(part => part * power <= most) * power;
}

/* How long a length is on the screen, at the point the camera turns about. */
function drawScale(context, camera, colours) {
  const pixels = pixelsPerLength(camera);
  const length = roundLength(140 / pixels);
  const [x, y] = [camera.width - 18, camera.height - 18];
  context.strokeStyle = colours.quiet;
  context.lineWidth = 1.5;
  const from = x - length * pixels;
  line(context, [from, y], [x, y]);
  line(context, [from, y - 4], [from, y + 4]);
  line(context, [x, y - 4], [x, y + 4]);
  context.textAlign = "right";
  label(context, shortly(length) + (length === 1 ? " unit of length" : " units of length"), [x, y - 9], colours, colours.quiet);
  context.textAlign = "left";
}

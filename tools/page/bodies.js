
/* ---- bodies.js: all bodies of a step by WebGL 2, one call for each shape; without it their outlines in 2-D ---- */

/* A body is 9 words: place, turn, colour, and its number plus 1 as a colour, by which the body under a pixel is found. */
const BODY_WORDS = 9;

/* Edges of bodies with a smaller radius in pixels would hide their faces; they appear up to twice that. */
const LEAST_EDGED = 12;

/* Triangles of all bodies from which on a scene is large: without a graphics card a frame takes a second of it. Outlines are not
 * smoothed then, which more than doubles that, nor are there shadows. */
const MOST_TRIANGLES = 500000;

const VERTEX_SHADER = `#version 300 es
uniform mat4 view;
uniform float pixels; /* of a length of 1 at a distance of 1 */
uniform float radius; /* of a ground the length of an edge */
uniform int mode;     /* 0: faces, 1: edges, 2: numbers, 3: shadows */
uniform bool isGround;
uniform vec4 plane;   /* the ground: upwards, and how high */
uniform vec3 light;   /* towards it */
uniform float extent; /* of the scene */
layout(location = 0) in vec3 vertex;
layout(location = 1) in vec3 place;
layout(location = 2) in vec4 turn;
layout(location = 3) in vec4 colour;
layout(location = 4) in vec4 number;
out vec3 world;
out vec4 paint;
void main() {
  vec3 t = 2.0 * cross(turn.xyz, vertex);
  world = place + vertex + turn.w * t + cross(turn.xyz, t);
  gl_Position = view * vec4(world, 1.0);
  float size = radius * pixels / max(gl_Position.w, 1e-30);
  float share = clamp(size / ${LEAST_EDGED}.0 - 1.0, 0.0, 1.0);
  paint = mode == 2 ? number : mode == 1 ? vec4(colour.rgb * 0.5, share * colour.a * (isGround ? 0.22 : 1.0)) : colour;
  if (mode == 3) { /* fainter from above; what is below throws none */
    float high = max(dot(plane.xyz, world) - plane.w, 0.0);
    gl_Position = dot(plane.xyz, place) < plane.w ? vec4(2.0) : view * vec4(world - light * high / dot(plane.xyz, light), 1.0);
    paint = vec4(max(1.0 - 0.5 * high / extent, 0.2));
  }
}`;

/* How dark shadows are at a place of their picture: a disc of samples on a spiral. */
const SHADOW_AT = `
float shadowAt(sampler2D shadows, vec2 at) {
  float dark = 0.0;
  for (int i = 0; i < 16; i++) {
    float r = 0.006 * sqrt((float(i) + 0.5) / 16.0), turn = 2.4 * float(i);
    dark += textureLod(shadows, 0.5 + 0.5 * at + r * vec2(cos(turn), sin(turn)), 1.0).r / 16.0;
  }
  return dark;
}`;

const FRAGMENT_SHADER = `#version 300 es
precision highp float;
precision highp int;
${SHADOW_AT}
uniform int mode;
uniform bool isGround;
uniform vec3 eye;
uniform vec3 light;
uniform vec4 plane;
uniform mat4 above;       /* the plane of the shadows as the whole picture */
uniform sampler2D shadows;
uniform float shadow;     /* how dark */
in vec3 world;
in vec4 paint;
out vec4 result;
float lightOn() { /* of a place on a ground: what stands towards the light was thrown on the plane, and so is the place */
  vec2 at = (above * vec4(world - light * (dot(plane.xyz, world) - plane.w) / dot(plane.xyz, light), 1.0)).xy;
  return 1.0 - (1.0 - smoothstep(0.8, 1.0, length(at))) * shadow * shadowAt(shadows, at);
}
void main() {
  result = paint;
  if (mode == 0) {
    vec3 normal = normalize(cross(dFdx(world), dFdy(world)));
    if (dot(normal, eye - world) < 0.0) { normal = -normal; }
    vec3 back = normalize(eye - world);
    float sky = 0.5 + 0.5 * dot(normal, plane.xyz);
    vec4 share = isGround ? vec4(0.28, 0.2, 0.53, 0.0) : vec4(0.56, 0.18, 0.32, 0.08); /* slopes are to be told apart */
    float shade = dot(share, vec4(1.0, sky, max(dot(normal, light), 0.0), max(dot(normal, back), 0.0)));
    float gloss = 0.1 * pow(max(dot(normal, normalize(light + back)), 0.0), 24.0);
    result.rgb = min(result.rgb * shade + (isGround ? 0.0 : gloss), 1.0);
    result.rgb *= isGround && shadow > 0.0 ? lightOn() : 1.0;
  }
}`;

function makeProgram(gl, ...sources) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, sources[0]], [gl.FRAGMENT_SHADER, sources[1]]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    throw new Error(gl.getProgramInfoLog(program));
  }
  return program;
}

const uniformsOf = (gl, program, names) => Object.fromEntries(names.map(name => [name, gl.getUniformLocation(program, name)]));

function makeBuffer(gl, target, data) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(target, buffer);
  gl.bufferData(target, data, gl.STATIC_DRAW);
  return buffer;
}

/* All shapes in one buffer of vertices, one of corners of triangles and one of ends of edges; each shape says where. */
function mergeShapes(shapes) {
  const total = list => shapes.reduce((sum, shape) => sum + shape[list].length, 0);
  const vertices = new Float32Array(total("vertices"));
  const merged = { vertices, triangles: new Uint32Array(total("triangles")), edges: new Uint32Array(total("edges")), parts: [] };
  let vertex = 0, corner = 0, end = 0;
  for (const shape of shapes) {
    vertices.set(shape.vertices, vertex);
    merged.triangles.set(shape.triangles.map(v => v + vertex / 3), corner);
    merged.edges.set(shape.edges.map(v => v + vertex / 3), end);
    merged.parts.push({ corner, corners: shape.triangles.length, end, ends: shape.edges.length });
    vertex += shape.vertices.length;
    corner += shape.triangles.length;
    end += shape.edges.length;
  }
  return merged;
}

/* Whether bodies have so many triangles that a frame takes long without a graphics card. */
function isLarge(recording) {
  let count = 0;
  for (let body = 0; body < recording.bodyCount; body++) {
    count += recording.shapes[shapeOf(recording, body)].triangles.length / 3;
  }
  return count >= MOST_TRIANGLES;
}

/* What draws with WebGL 2, or null where there is none. */
function makeSolids(canvas, recording) {
  const gl = canvas.getContext("webgl2", { antialias: !isLarge(recording), alpha: false });
  if (!gl) {
    return null;
  }
  const program = makeProgram(gl, VERTEX_SHADER, FRAGMENT_SHADER);
  const uniforms = uniformsOf(gl, program, ["view", "pixels", "radius", "mode", "isGround", "eye", "light", "plane",
    "extent", "above", "shadow"]);
  const merged = mergeShapes(recording.shapes);
  const vertices = makeBuffer(gl, gl.ARRAY_BUFFER, merged.vertices);
  const bodies = gl.createBuffer(), edged = gl.createBuffer();
  const arrays = ["triangles", "edges"].map(list => {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    makeBuffer(gl, gl.ELEMENT_ARRAY_BUFFER, merged[list]);
    gl.bindBuffer(gl.ARRAY_BUFFER, vertices);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    for (let place = 0; place <= 4; place++) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribDivisor(place, place === 0 ? 0 : 1);
    }
    return array;
  });
  gl.bindVertexArray(null);
  return { gl, canvas, recording, uniforms, program, parts: merged.parts, bodies, edged, arrays, words: new Float32Array(0), groups: [],
    picking: null, ground: makeGround(gl), hidesGrounds: false };
}

/* The bodies of a step, by shape; those that are picked come last and are drawn over the others. `paintOf` gives the colour of a
 * body, 4 parts from 0 to 255. */
function loadBodies(solids, step, paintOf, picked) {
  const { gl, recording } = solids;
  const lists = [recording.shapes.map(() => []), recording.shapes.map(() => [])];
  let count = 0;
  for (let body = 0; body < recording.bodyCount; body++) {
    const move = moveOf(recording, body, step);
    if (move >= 0) {
      lists[picked.includes(body) ? 1 : 0][shapeOf(recording, body)].push(body, move);
      count++;
    }
  }
  const words = new Float32Array(BODY_WORDS * count), bytes = new Uint8Array(words.buffer);
  solids.groups = lists.map(() => []);
  let at = 0;
  lists.forEach((list, group) => list.forEach((members, shape) => {
    solids.groups[group].push({ shape, first: at, count: members.length / 2 });
    for (let i = 0; i < members.length; i += 2, at++) {
      const [body, move] = [members[i], members[i + 1]];
      words.set(recording.moves.places.subarray(3 * move, 3 * move + 3), BODY_WORDS * at);
      words.set(turnOf(recording, move), BODY_WORDS * at + 3);
      bytes.set(paintOf(body), 4 * (BODY_WORDS * at + 7));
      const number = body + 1;
      bytes.set([number & 255, number >> 8 & 255, number >> 16 & 255, number >> 24 & 255], 4 * (BODY_WORDS * at + 8));
    }
  }));
  solids.words = words;
  solids.ground.isShadowDue = true;
  gl.bindBuffer(gl.ARRAY_BUFFER, solids.bodies);
  gl.bufferData(gl.ARRAY_BUFFER, words, gl.DYNAMIC_DRAW);
}

/* The bodies whose edges are seen, as loadBodies has all: of a crowd from afar there are none, and lines cost more than faces. */
function loadEdged(solids, camera) {
  const { gl, words, recording } = solids;
  const matrix = matrixOf(camera), pixels = pixelsOf(solids.canvas);
  const kept = new Float32Array(words.length);
  let at = 0;
  const groups = solids.groups.map(group => group.map(({ shape, first, count }) => {
    const begin = at, { radius } = recording.shapes[shape];
    for (let body = first; body < first + count; body++) {
      const from = BODY_WORDS * body;
      const depth = matrix[3] * words[from] + matrix[7] * words[from + 1] + matrix[11] * words[from + 2] + matrix[15];
      if (depth > -radius && radius * pixels > LEAST_EDGED * (depth - radius)) {
        kept.set(words.subarray(from, from + BODY_WORDS), BODY_WORDS * at++);
      }
    }
    return { shape, first: begin, count: at - begin };
  }));
  gl.bindBuffer(gl.ARRAY_BUFFER, solids.edged);
  gl.bufferData(gl.ARRAY_BUFFER, kept.subarray(0, BODY_WORDS * at), gl.DYNAMIC_DRAW);
  return groups;
}

const FACES = 0, EDGES = 1, NUMBERS = 2, SHADOWS = 3;

function drawGroup(solids, group, mode) {
  const { gl, uniforms, parts, recording } = solids;
  gl.bindVertexArray(solids.arrays[mode === EDGES ? 1 : 0]);
  gl.bindBuffer(gl.ARRAY_BUFFER, mode === EDGES ? solids.edged : solids.bodies);
  gl.uniform1i(uniforms.mode, mode);
  for (const { shape, first, count } of group) {
    const part = parts[shape], { isGround, edgeLength } = recording.shapes[shape];
    const [kind, from, length] = mode === EDGES ? [gl.LINES, part.end, part.ends] : [gl.TRIANGLES, part.corner, part.corners];
    if (count === 0 || length === 0 || (isGround && solids.hidesGrounds)) {
      continue;
    }
    const stride = 4 * BODY_WORDS, offset = stride * first;
    gl.vertexAttribPointer(1, 3, gl.FLOAT, false, stride, offset);
    gl.vertexAttribPointer(2, 4, gl.FLOAT, false, stride, offset + 12);
    gl.vertexAttribPointer(3, 4, gl.UNSIGNED_BYTE, true, stride, offset + 28);
    gl.vertexAttribPointer(4, 4, gl.UNSIGNED_BYTE, true, stride, offset + 32);
    gl.uniform1f(uniforms.radius, edgeLength);
    gl.uniform1i(uniforms.isGround, isGround);
    gl.drawElementsInstanced(kind, length, gl.UNSIGNED_INT, 4 * from, count);
  }
}

/* The pixels of a length of 1 at a distance of 1. */
const pixelsOf = canvas => canvas.height / 2 / Math.tan(FIELD_OF_VIEW / 2);

function setView(solids, camera) {
  const { gl, uniforms } = solids;
  const up = worldAxes(camera.up)[2];
  gl.useProgram(solids.program);
  gl.viewport(0, 0, solids.canvas.width, solids.canvas.height);
  gl.uniformMatrix4fv(uniforms.view, false, matrixOf(camera));
  gl.uniform1f(uniforms.pixels, pixelsOf(solids.canvas));
  gl.uniform3fv(uniforms.eye, eyeOf(camera));
  gl.uniform3fv(uniforms.light, lightOf(camera));
  gl.uniform4f(uniforms.plane, ...up, dot(up, camera.ground));
  gl.uniformMatrix4fv(uniforms.above, false, shadowMatrix(camera));
  gl.bindTexture(gl.TEXTURE_2D, solids.ground.shadows);
  gl.enable(gl.DEPTH_TEST);
}

/* Faces before their edges, which would else fight with them. Of bodies that are picked one sees through the faces. `ink`: of the
 * grid, which is drawn where the scene has no ground of its own, or null for neither. */
function drawSolids(solids, camera, paper, ink) {
  const { gl, uniforms } = solids;
  const hasShadows = ink && !isLarge(solids.recording), hasGrid = ink && !hasGrounds(solids.recording);
  solids.hidesGrounds = !ink;
  if (hasShadows && solids.ground.isShadowDue) {
    drawShadows(solids, camera);
  }
  setView(solids, camera);
  gl.uniform1f(uniforms.shadow, hasShadows ? SHADOW : 0);
  gl.clearColor(...paper.map(part => part / 255), 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.enable(gl.POLYGON_OFFSET_FILL);
  gl.polygonOffset(2, 4);
  const edged = loadEdged(solids, camera);
  solids.groups.forEach((group, isPicked) => {
    if (isPicked) {
      gl.clear(gl.DEPTH_BUFFER_BIT);
    }
    gl.depthMask(!isPicked);
    drawGroup(solids, group, FACES);
    gl.depthMask(true);
    drawGroup(solids, edged[isPicked], EDGES);
    if (hasGrid && !isPicked) {
      drawGround(solids, camera, ink, hasShadows);
      gl.useProgram(solids.program);
    }
  });
}

/* The body under a pixel of the page, or NO_BODY. */
function bodyAt(solids, camera, x, y) {
  const { gl, canvas } = solids;
  if (!solids.picking) {
    solids.picking = { frame: gl.createFramebuffer(), colour: gl.createRenderbuffer(), depth: gl.createRenderbuffer() };
  }
  const { frame, colour, depth } = solids.picking;
  const scale = canvas.width / camera.width;
  const number = new Uint8Array(4);
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  for (const [buffer, format, place] of [[colour, gl.RGBA8, gl.COLOR_ATTACHMENT0], [depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, canvas.width, canvas.height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
  }
  setView(solids, camera);
  gl.disable(gl.BLEND);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  solids.groups.forEach(group => drawGroup(solids, group, NUMBERS));
  gl.readPixels(Math.floor(x * scale), canvas.height - 1 - Math.floor(y * scale), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, number);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return new Uint32Array(number.buffer)[0] === 0 ? NO_BODY : new Uint32Array(number.buffer)[0] - 1;
}

/* ---- without WebGL ---- */

/* Edges as lines, as many as can be drawn in a moment. */
function drawOutlines(context, recording, step, camera, paintOf) {
  const MOST = 60000;
  const project = projector(camera);
  const bodies = Array.from({ length: recording.bodyCount }, (_, body) => body);
  const order = [false, true].flatMap(isLast => bodies.filter(body => isGround(recording, body) === isLast));
  let drawn = 0;
  context.lineWidth = 1;
  for (const body of order) {
    const move = moveOf(recording, body, step);
    if (move < 0) {
      continue;
    }
    const { vertices, edges } = recording.shapes[shapeOf(recording, body)];
    const place = placeOf(recording, move), turn = turnOf(recording, move);
    const spot = v => project(add(place, turned(turn, Array.from(vertices.subarray(3 * v, 3 * v + 3)))));
    context.strokeStyle = `rgb(${paintOf(body).slice(0, 3)})`;
    context.beginPath();
    for (let i = 0; i < edges.length && drawn < MOST; i += 2, drawn++) {
      const from = spot(edges[i]), to = spot(edges[i + 1]);
      if (from && to) {
        context.moveTo(...from);
        context.lineTo(...to);
      }
    }
    context.stroke();
  }
}

/* The body whose centre is nearest to a pixel, if it is near, else NO_BODY. */
function bodyNearest(recording, step, camera, x, y) {
  const project = projector(camera);
  let [nearest, least] = [NO_BODY, 40];
  for (let body = 0; body < recording.bodyCount; body++) {
    const move = moveOf(recording, body, step);
    const spot = move < 0 ? null : project(placeOf(recording, move));
    const distance = spot ? Math.hypot(spot[0] - x, spot[1] - y) : Infinity;
    if (distance < least) {
      [nearest, least] = [body, distance];
    }
  }
  return nearest;
}

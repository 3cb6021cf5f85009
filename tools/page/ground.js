
/* ---- ground.js: a grid in the plane below the scene, and on it the shadows of the bodies ---- */

const SHADOW_PIXELS = 1024;

/* How dark shadows are. */
const SHADOW = 0.42;

const GROUND_VERTEX_SHADER = `#version 300 es
uniform mat4 view;
uniform vec3 eye, centre, first, second;
uniform float reach;
out vec2 at; /* from the centre, 1 at the rim */
void main() {
  at = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
  gl_Position = view * vec4(centre + reach * (at.x * first + at.y * second), 1.0);
  gl_Position.z += 0.001 * (view * vec4(eye, 1.0)).z; /* as deep as a thousandth nearer to the eye: a floor may be in this plane */
}`;

/* Lines a cell apart, each fifth of them stronger; they fade to the rim, and where they would be denser than pixels. */
const GROUND_FRAGMENT_SHADER = `#version 300 es
precision highp float;
uniform sampler2D shadows;
uniform float cells;  /* from the centre to the rim */
uniform vec2 offset;  /* of the centre, in cells */
uniform vec3 ink;
uniform float shadow; /* how dark */
in vec2 at;
out vec4 result;
${SHADOW_AT}
float lines(vec2 place) {
  vec2 width = fwidth(place), off = abs(fract(place - 0.5) - 0.5);
  vec2 cover = clamp(1.0 - off / width, 0.0, 1.0) * (1.0 - smoothstep(0.2, 0.6, width));
  return max(cover.x, cover.y);
}
void main() {
  vec2 place = at * cells + offset;
  float fade = 1.0 - smoothstep(0.35, 1.0, length(at));
  float line = fade * max(0.22 * lines(place), 0.5 * lines(place / 5.0));
  float dark = shadow > 0.0 ? shadow * fade * shadowAt(shadows, at) : 0.0;
  result = vec4(ink * line * (1.0 - dark), 1.0 - (1.0 - line) * (1.0 - dark)); /* times its opacity */
}`;

/* How far the ground goes from its centre. */
const groundReach = camera => 2.6 * camera.extent;

function makeGround(gl) {
  const program = makeProgram(gl, GROUND_VERTEX_SHADER, GROUND_FRAGMENT_SHADER);
  const names = ["view", "eye", "centre", "first", "second", "reach", "shadows", "cells", "offset", "ink", "shadow"];
  const uniforms = uniformsOf(gl, program, names);
  const shadows = gl.createTexture(), frame = gl.createFramebuffer();
  gl.bindTexture(gl.TEXTURE_2D, shadows);
  gl.texStorage2D(gl.TEXTURE_2D, 2, gl.R8, SHADOW_PIXELS, SHADOW_PIXELS);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, shadows, 0);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return { program, uniforms, shadows, frame, isShadowDue: true };
}

/* Column-major: the ground's plane as the whole picture. */
function shadowMatrix(camera) {
  const [first, second] = worldAxes(camera.up);
  const rows = [first, second, [0, 0, 0]].map(axis => [...axis, -dot(axis, camera.ground)].map(x => x / groundReach(camera)));
  rows.push([0, 0, 0, 1]);
  return Float32Array.from({ length: 16 }, (_, i) => rows[i % 4][i >> 2]);
}

/* The shadows from above. Of several the darkest counts; a body larger than the scene is the floor and throws none, and no ground does. */
function drawShadows(solids, camera) {
  const { gl, uniforms, ground, recording } = solids;
  const up = worldAxes(camera.up)[2];
  gl.useProgram(solids.program);
  gl.bindTexture(gl.TEXTURE_2D, null); /* what is drawn into cannot be read */
  gl.bindFramebuffer(gl.FRAMEBUFFER, ground.frame);
  gl.viewport(0, 0, SHADOW_PIXELS, SHADOW_PIXELS);
  gl.uniformMatrix4fv(uniforms.view, false, shadowMatrix(camera));
  gl.uniform4f(uniforms.plane, ...up, dot(up, camera.ground));
  gl.uniform3fv(uniforms.light, lightOf(camera));
  gl.uniform1f(uniforms.extent, camera.extent);
  gl.disable(gl.DEPTH_TEST);
  gl.enable(gl.BLEND);
  gl.blendEquation(gl.MAX);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT);
  const throwsOne = ({ shape }) => !recording.shapes[shape].isGround && recording.shapes[shape].radius <= camera.extent;
  solids.groups.forEach(group => drawGroup(solids, group.filter(throwsOne), SHADOWS));
  gl.blendEquation(gl.FUNC_ADD);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.bindTexture(gl.TEXTURE_2D, ground.shadows);
  gl.generateMipmap(gl.TEXTURE_2D);
  ground.isShadowDue = false;
}

function drawGround(solids, camera, ink, hasShadows) {
  const { gl, ground, recording } = solids;
  const { uniforms } = ground;
  const [first, second] = worldAxes(camera.up);
  const reach = groundReach(camera), cell = roundLength(camera.extent / 4);
  const offset = [first, second].map(axis => (dot(axis, recording.head.origin) + dot(axis, camera.ground)) / cell % 5);
  gl.useProgram(ground.program);
  gl.uniformMatrix4fv(uniforms.view, false, matrixOf(camera));
  gl.uniform3fv(uniforms.eye, eyeOf(camera));
  gl.uniform3fv(uniforms.centre, camera.ground);
  gl.uniform3fv(uniforms.first, first);
  gl.uniform3fv(uniforms.second, second);
  gl.uniform1f(uniforms.reach, reach);
  gl.uniform1f(uniforms.cells, reach / cell);
  gl.uniform2fv(uniforms.offset, offset);
  gl.uniform3fv(uniforms.ink, ink.slice(0, 3).map(part => part / 255));
  gl.uniform1f(uniforms.shadow, hasShadows ? SHADOW : 0);
  gl.bindTexture(gl.TEXTURE_2D, ground.shadows);
  gl.bindVertexArray(null);
  gl.depthMask(false);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.depthMask(true);
}

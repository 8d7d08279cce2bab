// SPDX-License-Identifier: Apache-2.0
// @ts-check
// Draws an object into a canvas by WebGL 2. What it draws comes as packs (src/engine/view), each of which can be replaced
// at any time.
import { clipFromRelative, dot, ofPixel, plus } from './camera.js';
import { filterShader, litShader, partShader, plainShader, screenShader, vertexShader } from './shaders.js';
import { makeTarget, Targets } from './targets.js';

/** @typedef {import('./camera.js').Camera} Camera */
/** @typedef {import('./pack.js').Pack} Pack */
/** @typedef {import('./pack.js').Numbers} Numbers */
/**
 * @typedef {object} View what is shown, and how
 * @property {Camera} camera capture frame; its size is that of the picture
 * @property {string} channel one of `channels`
 * @property {number[][]} room_from_object rotation of directions of the object to those of the light, rows
 * @property {number} [strength] of the light, as a factor
 * @property {number} samples per pixel and axis, 1 or 2
 * @property {boolean} [rough] edges of triangles are not smoothed, which takes less time
 * @property {boolean} [coarse] drawn by the coarse triangles, if there are any, which takes less time
 * @property {number} highlight index of a part, 0 for none
 * @property {number[]} [hidden] indices of parts that are not drawn
 */
/** @typedef {import('./targets.js').Target} Target */

export const channels = ['lit', 'albedo', 'normal', 'roughness', 'metalness'];
const kEncoded = new Set(['lit', 'albedo']);  // channels that are colors
const kHighlight = [1.0, 0.55, 0.1];
const kUnits = ['uIrradiance', 'uReflection', 'uSurface', 'uBase', 'uFresnel', 'uLobe'];
export const noTurn = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

/** Starts to make a program; madeProgram() waits for it. @param {WebGL2RenderingContext} gl @param {string} vertex @param {string} fragment */
function makeProgram(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [type, source] of /** @type {[number, string][]} */ ([[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]])) {
    const shader = /** @type {WebGLShader} */ (gl.createShader(type));
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    gl.deleteShader(shader);
  }
  gl.linkProgram(program);
  return program;
}

/** Waits for a program. Start all programs before the first wait, because drivers make them at the same time. @param {WebGL2RenderingContext} gl @param {WebGLProgram} program */
function madeProgram(gl, program) {
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
    const logs = (gl.getAttachedShaders(program) ?? []).map((s) => gl.getShaderInfoLog(s)).join('');
    throw new Error(`The graphics driver refuses a shader: ${gl.getProgramInfoLog(program)} ${logs}`);
  }
}

/** Uniforms by name. @param {WebGL2RenderingContext} gl @param {WebGLProgram} program */
function uniformsOf(gl, program) {
  /** @type {Object<string, WebGLUniformLocation | null>} */
  const out = {};
  const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) ?? 0;
  for (let i = 0; i < count; ++i) {
    const name = gl.getActiveUniform(program, i)?.name ?? '';
    out[name] = gl.getUniformLocation(program, name);
  }
  return out;
}

/** The nearest and the farthest distance along the axis of a camera of the corners of a box. @param {Camera} camera @param {any} box */
function depthRange(camera, box) {
  const forward = /** @type {import('./camera.js').Vec3} */ (camera.world_from_cam.map((row) => row[2]));
  const middle = plus(box.min, box.size, 0.5), radius = Math.hypot(...box.size) / 2;
  const depth = dot(plus(middle, camera.center, -1), forward);
  const far = Math.max(depth + radius, radius);
  return [Math.max(depth - radius, far / 2000), far];
}

export class Renderer {
  /** @param {HTMLCanvasElement} canvas Errors: no WebGL 2. */
  constructor(canvas) {
    const gl = canvas.getContext('webgl2', {alpha: true, antialias: false, depth: false});
    if (!gl) throw new Error('This browser has no WebGL 2.');
    this.canvas = canvas;
    this.gl = gl;
    const names = gl.getExtension('WEBGL_debug_renderer_info');
    /** Whether WebGL is rendered in software. */
    this.software = /swiftshader|llvmpipe|software|basic render/i.test(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
    this.lit = makeProgram(gl, vertexShader, litShader);
    this.plain = makeProgram(gl, vertexShader, plainShader);
    this.part = makeProgram(gl, vertexShader, partShader);
    this.filter = makeProgram(gl, screenShader, filterShader);
    const programs = [this.lit, this.plain, this.part, this.filter];
    for (const program of programs) madeProgram(gl, program);
    this.uniforms = new Map(programs.map((p) => [p, uniformsOf(gl, p)]));
    this.vertices = gl.createVertexArray();
    this.screen = gl.createVertexArray();
    /** @type {Map<string, WebGLBuffer>} */
    this.buffers = new Map();
    /** @type {Map<string, WebGLTexture>} */
    this.textures = new Map();
    /** @type {Map<string, any>} heads of the packs by kind */
    this.heads = new Map();
    /** Numbers of corners of the triangles and of the coarse ones. */
    this.corners = {triangles: 0, coarse: 0};
    this.targets = new Targets(gl);
    /** @type {Target | null} */
    this.pixel = null;
    gl.vertexAttribI4ui(5, 0, 0, 0, 0);  // the bounce of packs without one
  }

  /** Forgets the object. */
  clear() {
    const {gl} = this;
    this.heads.clear();
    gl.bindVertexArray(this.vertices);
    for (const location of [4, 5]) gl.disableVertexAttribArray(location);
    gl.bindVertexArray(null);
  }

  /** Whether it has all packs that a lit picture needs. */
  get complete() {
    return this.hasSurface && ['vertex_light', 'light', 'tables'].every((kind) => this.heads.has(kind));
  }

  /** Whether it has all packs that channels without light need. */
  get hasSurface() { return this.heads.has('shape') && this.heads.has('look'); }

  /** @param {Pack} pack of any kind; replaces the one of that kind */
  set(pack) {
    const {head, arrays} = pack;
    if (head.kind === 'shape') this.setShape(arrays);
    if (head.kind === 'coarse') this.setTriangles('coarse', arrays.triangles);
    if (head.kind === 'look') this.setAttributes([[2, 'albedo', arrays.albedo, true], [3, 'material', arrays.material, true]]);
    if (head.kind === 'vertex_light')
      this.setAttributes([[4, 'sky', arrays.visibility, true], [5, 'bounce', arrays.bounce, false]]);  // not 'visibility', which is the name of the shape's
    if (head.kind === 'reflections') this.setReflections(arrays);
    if (head.kind === 'light') this.setLight(head, arrays);
    if (head.kind === 'tables') this.setTables(head, arrays);
    this.heads.set(head.kind, head);
  }

  /** @param {Object<string, Numbers>} arrays */
  setShape(arrays) {
    this.setAttributes([[0, 'positions', arrays.positions, true], [1, 'normals', arrays.normals, true]]);
    this.setBytes(6, 'visibility', arrays.visibility, 3);
    this.corners.coarse = 0;  // they were of another surface
    this.setTriangles('triangles', arrays.triangles);
  }

  /** @param {'triangles' | 'coarse'} name @param {Numbers} corners */
  setTriangles(name, corners) {
    const {gl} = this;
    gl.bindVertexArray(this.vertices);
    this.upload(gl.ELEMENT_ARRAY_BUFFER, name, corners);
    gl.bindVertexArray(null);
    this.corners[name] = corners.length;
  }

  /** Visibility and reflections of the object in itself, more exact than the visibility of the shape, which must be set before. @param {Object<string, Numbers>} arrays */
  setReflections(arrays) {
    this.setBytes(6, 'visibility', arrays.visibility, 3);
    this.setBytes(9, 'object', arrays.object, 7);
  }

  /** @param {number} first location @param {string} name @param {Numbers} values @param {number} count of locations, of four bytes each */
  setBytes(first, name, values, count) {
    const {gl} = this;
    gl.bindVertexArray(this.vertices);
    this.upload(gl.ARRAY_BUFFER, name, values);
    for (let k = 0; k < count; ++k) {
      gl.enableVertexAttribArray(first + k);
      gl.vertexAttribPointer(first + k, 4, gl.BYTE, true, 4 * count, 4 * k);
    }
    gl.bindVertexArray(null);
  }

  /** @param {[number, string, Numbers, boolean][]} list of location, name, values, and whether the shader reads shares of 1 */
  setAttributes(list) {
    const {gl} = this;
    gl.bindVertexArray(this.vertices);
    for (const [location, name, values, shares] of list) {
      this.upload(gl.ARRAY_BUFFER, name, values);
      gl.enableVertexAttribArray(location);
      if (!shares) gl.vertexAttribIPointer(location, 1, gl.UNSIGNED_INT, 0, 0);
      else if (values instanceof Uint8Array) gl.vertexAttribPointer(location, 4, gl.UNSIGNED_BYTE, true, 0, 0);
      else if (values instanceof Uint16Array) gl.vertexAttribPointer(location, 4, gl.UNSIGNED_SHORT, true, 0, 0);
      else gl.vertexAttribPointer(location, 2, gl.SHORT, true, 0, 0);
    }
    gl.bindVertexArray(null);
  }

  /** @param {number} target @param {string} name @param {Numbers} values */
  upload(target, name, values) {
    const {gl} = this;
    const buffer = this.buffers.get(name) ?? gl.createBuffer();
    this.buffers.set(name, buffer);
    gl.bindBuffer(target, buffer);
    gl.bufferData(target, values, gl.STATIC_DRAW);
  }

  /** @param {string} name @param {number} target @returns {void} binds a texture of that name, a new one if there is none */
  bindTexture(name, target) {
    const {gl} = this;
    const texture = this.textures.get(name) ?? gl.createTexture();
    this.textures.set(name, texture);
    gl.bindTexture(target, texture);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) gl.texParameteri(target, side, gl.CLAMP_TO_EDGE);
    for (const size of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(target, size, gl.LINEAR);
  }

  /** @param {any} head @param {Object<string, Numbers>} arrays */
  setLight(head, arrays) {
    const {gl} = this;
    const i = head.irradiance_side, r = head.reflection_side, kind = gl.UNSIGNED_INT_5_9_9_9_REV;
    this.bindTexture('uIrradiance', gl.TEXTURE_2D);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB9_E5, i, i, 0, gl.RGB, kind, arrays.irradiance);
    this.bindTexture('uReflection', gl.TEXTURE_3D);
    gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGB9_E5, r, r, head.reflection_levels, 0, gl.RGB, kind, arrays.reflection);
  }

  /** @param {any} head @param {Object<string, Numbers>} arrays */
  setTables(head, arrays) {
    const {gl} = this;
    for (const [name, values, columns] of /** @type {[string, Numbers, number][]} */ (
      [['uSurface', arrays.surface, head.columns], ['uBase', arrays.base, head.columns],
        ['uFresnel', arrays.fresnel, head.columns], ['uLobe', arrays.lobe, 1]])) {
      this.bindTexture(name, gl.TEXTURE_2D);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, columns, head.rows, 0, gl.RGBA, gl.FLOAT, values);
    }
  }

  /**
   * Draws into the canvas, which gets the camera's size; nothing while what the channel needs is missing.
   * @param {View} view
   */
  draw(view) {
    const {gl} = this;
    const {width, height} = view.camera;
    if (!(view.channel === 'lit' ? this.complete : this.hasSurface) || gl.isContextLost()) return;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    const {samples, mean} = this.targets.of(width * view.samples, height * view.samples, Boolean(view.rough));
    this.drawSurface(view, (samples ?? mean).frame, mean.width, mean.height);
    if (samples) {
      gl.bindFramebuffer(gl.READ_FRAMEBUFFER, samples.frame);
      gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, mean.frame);
      gl.blitFramebuffer(0, 0, mean.width, mean.height, 0, 0, mean.width, mean.height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.disable(gl.DEPTH_TEST);
    gl.useProgram(this.filter);
    const u = this.uniforms.get(this.filter) ?? {};
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, mean.parts[0]);
    gl.uniform1i(u.uSamples, 0);
    gl.uniform1i(u.uPerPixel, view.samples);
    gl.uniform1i(u.uEncode, kEncoded.has(view.channel) ? 1 : 0);
    gl.bindVertexArray(this.screen);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.bindVertexArray(null);
  }

  /** @param {View} view @param {WebGLFramebuffer} frame @param {number} width @param {number} height */
  drawSurface(view, frame, width, height) {
    const {gl} = this;
    const lit = view.channel === 'lit';
    const u = this.begin(lit ? this.lit : this.plain, view.camera, frame, width, height, view.hidden);
    gl.uniform1i(u.uChannel, Math.max(channels.indexOf(view.channel), 0));
    gl.uniform1i(u.uHighlight, view.highlight);
    gl.uniform3fv(u.uHighlightColor, kHighlight);
    if (lit) this.bindLight(view, u);
    this.drawTriangles(view.coarse && this.corners.coarse > 0 ? 'coarse' : 'triangles');
  }

  /** @param {View} view @param {Object<string, WebGLUniformLocation | null>} u of the program */
  bindLight(view, u) {
    const {gl} = this;
    const tables = this.heads.get('tables'), light = this.heads.get('light');
    kUnits.forEach((name, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(name === 'uReflection' ? gl.TEXTURE_3D : gl.TEXTURE_2D, this.textures.get(name) ?? null);
      gl.uniform1i(u[name], unit);
    });
    gl.uniform1f(u.uStrength, view.strength ?? 1);
    const [a, b, c] = view.room_from_object;
    gl.uniformMatrix3fv(u.uRoom, true, [...a, ...b, ...c]);
    const fitted = this.heads.get('reflections');
    gl.uniform1f(u.uVisibilityScale, (fitted ?? this.heads.get('shape')).visibility_scale);
    gl.uniform1f(u.uObjectScale, fitted ? fitted.object_scale : 0);
    gl.uniform1f(u.uIrradianceSide, light.irradiance_side);
    gl.uniform1f(u.uReflectionSide, light.reflection_side);
    gl.uniform1f(u.uReflectionLevels, light.reflection_levels);
    gl.uniform2f(u.uTableSize, tables.columns, tables.rows);
    gl.uniform1f(u.uMinRoughness, tables.min_roughness);
    gl.uniform1f(u.uMiddleShare, tables.middle_share);
    gl.uniform1f(u.uDielectricF0, tables.dielectric_f0);
    gl.uniform1f(u.uMetalF0, tables.metal_f0);
  }

  /** Clears a target and makes a program ready. @param {WebGLProgram} program @param {Camera} camera @param {WebGLFramebuffer} frame @param {number} width @param {number} height @param {number[]} [hidden] */
  begin(program, camera, frame, width, height, hidden = []) {
    const {gl} = this;
    const box = this.heads.get('shape'), u = this.uniforms.get(program) ?? {};
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.viewport(0, 0, width, height);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(program);
    const [near, far] = depthRange(camera, box);
    gl.uniformMatrix4fv(u.uClip, false, clipFromRelative(camera, near, far));
    gl.uniform3fv(u.uBoxMin, plus(box.min, camera.center, -1));
    gl.uniform3fv(u.uBoxSize, box.size);
    const bits = new Uint32Array(8);
    for (const part of hidden) bits[part >> 5] |= 1 << (part & 31);
    gl.uniform1uiv(u['uHidden[0]'], bits);
    return u;
  }

  /** @param {'triangles' | 'coarse'} name */
  drawTriangles(name) {
    const {gl} = this;
    gl.bindVertexArray(this.vertices);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers.get(name) ?? null);
    gl.drawElements(gl.TRIANGLES, this.corners[name], gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
  }

  /** Waits until the pictures that were asked for are drawn. @returns {Promise<void>} */
  finished() {
    const {gl} = this, sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!sync) return Promise.resolve();  // the context is lost
    gl.flush();
    return new Promise((resolve) => {
      const look = () => {
        if (!gl.isContextLost() && gl.getSyncParameter(sync, gl.SYNC_STATUS) !== gl.SIGNALED) return void setTimeout(look, 4);
        gl.deleteSync(sync);
        resolve();
      };
      setTimeout(look, 0);
    });
  }

  /**
   * The part that a pixel shows: its index, 0 for none; -1 where the object is not.
   * @param {Camera} camera
   * @param {number} x pixels
   * @param {number} y
   * @param {number[]} [hidden] indices of parts that are not there
   */
  partAt(camera, x, y, hidden) {
    const {gl} = this;
    if (!this.hasSurface || gl.isContextLost()) return -1;
    this.pixel ??= makeTarget(gl, 1, 1, gl.RGBA8, 0);
    this.begin(this.part, ofPixel(camera, x, y), this.pixel.frame, 1, 1, hidden);
    this.drawTriangles('triangles');
    const out = new Uint8Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
    return out[3] > 0 ? out[0] : -1;
  }
}

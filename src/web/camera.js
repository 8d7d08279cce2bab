// SPDX-License-Identifier: Apache-2.0
// @ts-check
// Pinhole cameras as render.json has them: OpenCV axes (x right, y down, z into the scene), pixel centers at +0.5.

/**
 * @typedef {[number, number, number]} Vec3
 * @typedef {object} Camera
 * @property {number} width pixels, as all numbers up to skew
 * @property {number} height
 * @property {number} fx
 * @property {number} fy
 * @property {number} cx
 * @property {number} cy
 * @property {number} [skew]
 * @property {number[][]} world_from_cam rows of the rotation
 * @property {Vec3} center
 */

/** @param {Vec3} a @param {Vec3} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {Vec3} a @param {Vec3} b @returns {Vec3} */
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/** @param {Vec3} a @param {Vec3} b @param {number} [share] of b @returns {Vec3} */
export const plus = (a, b, share = 1) => [a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]];
/** @param {Vec3} a @param {number} s @returns {Vec3} */
export const mul = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
/** @param {Vec3} a @returns {Vec3} of length 1, or 0 where `a` is 0 */
export const unit = (a) => {
  const size = Math.hypot(a[0], a[1], a[2]) || 1;
  return [a[0] / size, a[1] / size, a[2] / size];
};

/**
 * The rotation about an axis, counter-clockwise seen from its tip, in rows.
 * @param {Vec3} axis unit
 * @param {number} angle radians
 * @returns {Vec3[]}
 */
export function rotation(axis, angle) {
  const [x, y, z] = axis;
  const c = Math.cos(angle), s = Math.sin(angle), k = 1 - c;
  return [
    [c + k * x * x, k * x * y - s * z, k * x * z + s * y],
    [k * x * y + s * z, c + k * y * y, k * y * z - s * x],
    [k * x * z - s * y, k * y * z + s * x, c + k * z * z],
  ];
}

/**
 * The same view in another number of pixels, with the same field of view along the shorter side.
 * @param {Camera} camera
 * @param {number} width
 * @param {number} height
 * @returns {Camera}
 */
export function resized(camera, width, height) {
  const scale = Math.min(width, height) / Math.min(camera.width, camera.height);
  return {
    ...camera, width, height,
    fx: camera.fx * scale, fy: camera.fy * scale, skew: (camera.skew ?? 0) * scale,
    cx: width / 2 + (camera.cx - camera.width / 2) * scale,
    cy: height / 2 + (camera.cy - camera.height / 2) * scale,
  };
}

/**
 * A camera whose picture is one pixel of the picture of another one.
 * @param {Camera} camera
 * @param {number} x
 * @param {number} y
 * @returns {Camera}
 */
export function ofPixel(camera, x, y) {
  return {...camera, width: 1, height: 1, cx: camera.cx - x, cy: camera.cy - y};
}

/**
 * Clip coordinates from positions relative to the camera's center, in columns.
 * @param {Camera} camera
 * @param {number} near distances of the near and the far plane
 * @param {number} far
 */
export function clipFromRelative(camera, near, far) {
  const {width: w, height: h, fx, fy, cx, cy, skew = 0} = camera;
  const depth = (far + near) / (far - near), shift = (-2 * far * near) / (far - near);
  const rows = [
    [(2 * fx) / w, (2 * skew) / w, (2 * cx) / w - 1, 0],
    [0, (-2 * fy) / h, 1 - (2 * cy) / h, 0],
    [0, 0, depth, shift],
    [0, 0, 1, 0],
  ];
  const r = camera.world_from_cam;
  const out = new Float32Array(16);
  for (let row = 0; row < 4; ++row) {
    for (let column = 0; column < 3; ++column)
      out[4 * column + row] = rows[row][0] * r[column][0] + rows[row][1] * r[column][1] + rows[row][2] * r[column][2];
    out[12 + row] = rows[row][3];
  }
  return out;
}

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Directions as points of a square, by the octahedral mapping of src/core/math/octahedron.h. */

/** @param {number} x @param {number} y in [-1, 1] @returns {[number, number, number]} unit */
export function fromOctahedron(x, y) {
  const z = 1 - Math.abs(x) - Math.abs(y);
  const [a, b] = z < 0 ? [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)] : [x, y], size = Math.hypot(a, b, z);
  return [a / size, b / size, z / size];
}

/** @param {number} x @param {number} y @param {number} z of any length but 0 @returns {[number, number]} */
export function onOctahedron(x, y, z) {
  const sum = Math.abs(x) + Math.abs(y) + Math.abs(z), u = x / sum, v = y / sum;
  return z < 0 ? [(1 - Math.abs(v)) * (u < 0 ? -1 : 1), (1 - Math.abs(u)) * (v < 0 ? -1 : 1)] : [u, v];
}

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** A mirror ball that shows the light. Places on the ball: x to the right, y down, (0, 0) in the middle, at distance 1 its rim. */
import { add, dot, mul, sub, unit } from './camera.js';
import { onOctahedron } from './octahedron.js';

/** @typedef {import('./camera.js').Vec} Vec */
/** @typedef {[Vec, Vec, Vec]} Axes right, down, forward of the camera */

/** The direction of the light that is reflected at a place on the ball. @param {number} x @param {number} y @param {Axes} axes @returns {Vec} */
export function mirrored(x, y, axes) {
  const r = Math.max(1, Math.hypot(x, y)), u = x / r, v = y / r, z = Math.sqrt(Math.max(0, 1 - u * u - v * v));
  const normal = sub(add(mul(axes[0], u), mul(axes[1], v)), mul(axes[2], z));
  return add(mul(normal, 2 * z), axes[2]);
}

/** The place on the ball where light from a direction is reflected. @param {Vec} direction unit @param {Axes} axes @returns {{x: number, y: number}} */
export function placeOnBall(direction, axes) {
  const half = unit(sub(direction, axes[2]));
  return { x: dot(half, axes[0]), y: dot(half, axes[1]) };
}

/** The radiance of a map on the octahedron, at the node nearest to a direction. @param {Uint32Array} map @param {number} side @param {Vec} d @returns {Vec} */
export function radianceOf(map, side, d) {
  const [x, y] = onOctahedron(...d);
  const at = (/** @type {number} */ v) => Math.round((v * 0.5 + 0.5) * (side - 1));
  const bits = map[at(y) * side + at(x)], scale = 2 ** ((bits >>> 27) - 24);
  return [(bits & 511) * scale, (bits >>> 9 & 511) * scale, (bits >>> 18 & 511) * scale];
}

/**
 * @param {HTMLCanvasElement} canvas square @param {Axes} axes
 * @param {(d: Vec) => Vec} radiance from a direction, linear @param {Vec | null} sun the direction to it
 */
export function drawBall(canvas, axes, radiance, sun) {
  const n = canvas.width, c = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d')), image = c.createImageData(n, n);
  for (let j = 0; j < n; ++j) for (let i = 0; i < n; ++i) {
    const x = (2 * i + 1) / n - 1, y = (2 * j + 1) / n - 1, inside = 1 - Math.hypot(x, y);
    if (inside < 0) continue;
    const color = radiance(mirrored(x, y, axes)).map((v) => 255 * (v / (1 + v)) ** (1 / 2.2));
    image.data.set([...color, 255 * Math.min(1, inside * n / 2)], 4 * (j * n + i));
  }
  c.putImageData(image, 0, 0);
  if (!sun) return;
  const at = placeOnBall(sun, axes);
  for (const [style, radius] of /** @type {[string, number][]} */ ([['#000', 7], ['#ffe08a', 5]])) {
    c.fillStyle = style;
    c.beginPath();
    c.arc((at.x + 1) / 2 * n, (at.y + 1) / 2 * n, radius, 0, 2 * Math.PI);
    c.fill();
  }
}

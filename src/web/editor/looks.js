// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** The look of each part, which is the mean color and material of its vertices, for the list of parts; and the place of each part. */

/** @typedef {{color: string, roughness: number, metalness: number}} Look color: in CSS */

/** A linear value, encoded as sRGB, 0 to 255. @param {number} v */
const byteOf = (v) => Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));

/** Looks by name of the part. A part that is covered by later ones has none. @param {import('../pack.js').Pack} pack "look" @returns {Map<string, Look>} */
export function partLooks({ head, arrays }) {
  const names = /** @type {string[]} */ (head.parts), { albedo, material } = arrays;
  const sums = names.map(() => ({ n: 0, rgb: [0, 0, 0], roughness: 0, metalness: 0 }));
  for (let v = 0; v < material.length / 4; ++v) {
    const sum = sums[material[4 * v + 3]];
    ++sum.n;
    for (let c = 0; c < 3; ++c) sum.rgb[c] += (albedo[4 * v + c] / 65535) ** 2;  // the pack holds square roots
    sum.roughness += material[4 * v] / 255;
    sum.metalness += material[4 * v + 2] / 255;
  }
  /** @type {Map<string, Look>} */
  const looks = new Map();
  sums.forEach(({ n, rgb, roughness, metalness }, i) => {
    if (i > 0 && n > 0) looks.set(names[i], { color: `rgb(${rgb.map((s) => byteOf(s / n)).join(' ')})`, roughness: roughness / n, metalness: metalness / n });
  });
  return looks;
}

/**
 * A ball around a part, about the middle of its box, in the capture frame; null: no vertex belongs to the part.
 * @param {import('../pack.js').Pack} shape @param {import('../pack.js').Pack} look @param {string} name
 * @returns {{center: [number, number, number], radius: number} | null}
 */
export function partBall(shape, look, name) {
  const { positions } = shape.arrays, { material } = look.arrays, index = look.head.parts.indexOf(name);
  const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
  const of = (/** @type {number} */ v, /** @type {number} */ k) => shape.head.min[k] + shape.head.size[k] * positions[4 * v + k] / 65535;
  const each = (/** @type {(v: number) => void} */ work) => { for (let v = 0; v < material.length / 4; ++v) if (material[4 * v + 3] === index) work(v); };
  each((v) => [0, 1, 2].forEach((k) => {
    min[k] = Math.min(min[k], of(v, k));
    max[k] = Math.max(max[k], of(v, k));
  }));
  if (index <= 0 || min[0] > max[0]) return null;
  const center = /** @type {[number, number, number]} */ (min.map((m, k) => (m + max[k]) / 2));
  let radius = 0;
  each((v) => { radius = Math.max(radius, Math.hypot(...center.map((c, k) => of(v, k) - c))); });
  return { center, radius };
}

/** A picture of a ball: its highlight is the wider, the rougher the surface is, and has the color of a metal. @param {Look} look @returns {string} CSS */
export function swatch({ color, roughness, metalness }) {
  const shine = metalness > 0.5 ? `color-mix(in srgb, ${color} 45%, white)` : 'white';
  return `radial-gradient(circle at 35% 30%, ${shine}, ${color} ${Math.round(12 + 70 * roughness)}%)`;
}

/** @param {Look} look */
export const lookText = ({ roughness, metalness }) => `roughness ${roughness.toFixed(2)}${metalness > 0.05 ? `, metalness ${metalness.toFixed(2)}` : ''}`;

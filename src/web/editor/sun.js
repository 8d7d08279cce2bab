// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Adds a sun to the light in which the page draws: to the maps of the light, and to the light that arrives at each vertex. */
import { times } from './camera.js';
import { fromOctahedron, onOctahedron } from './octahedron.js';

/** @typedef {import('./camera.js').Vec} Vec */
/** @typedef {import('../pack.js').Pack} Pack */
/** @typedef {import('../pack.js').Numbers} Numbers */
/** @typedef {{direction: Vec, strength: number}} Sun direction: towards the sun, in the object's frame */

const bits = new DataView(new ArrayBuffer(4));
const scales = Float64Array.from({ length: 34 }, (_, exponent) => 2 ** (24 - exponent));  // factor of the integers that share an exponent

/** The same as `shared_exponent()` of src/engine/view/quantize.h. @param {number} r @param {number} g @param {number} b linear, >= 0 */
export function packed(r, g, b) {
  const largest = Math.min(65408, Math.max(r, g, b, 2 ** -16));
  bits.setFloat32(0, largest);
  let exponent = ((bits.getUint32(0) >>> 23) & 255) - 127 + 16;
  if (Math.round(largest * scales[exponent]) === 512) ++exponent;
  const scale = scales[exponent], of = (/** @type {number} */ v) => Math.max(0, Math.min(511, Math.round(v * scale)));
  return (exponent << 27 | of(b) << 18 | of(g) << 9 | of(r)) >>> 0;
}

/** Three floats for each number of a map. @param {Numbers} map with shared exponents */
function unpacked(map) {
  const out = new Float32Array(3 * map.length);
  for (let i = 0; i < map.length; ++i) {
    const v = map[i], scale = 1 / scales[v >>> 27];
    out[3 * i] = (v & 511) * scale;
    out[3 * i + 1] = (v >>> 9 & 511) * scale;
    out[3 * i + 2] = (v >>> 18 & 511) * scale;
  }
  return out;
}

/** Directions of the nodes of a map, row by row. @param {number} side */
function nodes(side) {
  const out = new Float32Array(3 * side * side), at = (/** @type {number} */ i) => 2 * i / (side - 1) - 1;
  for (let i = 0; i < side * side; ++i) out.set(fromOctahedron(at(i % side), at(Math.floor(i / side))), 3 * i);
  return out;
}

/** The node of a map nearest to a direction. @param {number} side @param {number} x @param {number} y @param {number} z */
function nodeAt(side, x, y, z) {
  const [a, b] = onOctahedron(x, y, z);
  return Math.round((b * 0.5 + 0.5) * (side - 1)) * side + Math.round((a * 0.5 + 0.5) * (side - 1));
}

/** Linear interpolation in a table. @param {Numbers} table at equal distances @param {number} first index of its first node @param {number} count @param {number} at in [0, 1] */
function look(table, first, count, at) {
  const x = Math.max(0, Math.min(1, at)) * (count - 1), i = Math.min(count - 2, Math.floor(x)), t = x - i;
  return table[first + i] * (1 - t) + table[first + i + 1] * t;
}

/** The mean over all directions and over the three channels of a map. @param {Float32Array} map @param {number} side */
function meanOver(map, side) {
  const share = (/** @type {number} */ n) => (n === 0 || n === side - 1 ? 0.5 : 1);
  let sum = 0, weights = 0;
  for (let j = 0; j < side; ++j) for (let i = 0; i < side; ++i) {
    const k = 3 * (j * side + i), x = 2 * i / (side - 1) - 1, y = 2 * j / (side - 1) - 1, z = 1 - Math.abs(x) - Math.abs(y);
    // Solid angle of the piece of the octahedron around a node. At the border it is half a piece, in the corners a quarter.
    const far = z < 0 ? Math.hypot(1 - Math.abs(y), 1 - Math.abs(x), z) : Math.hypot(x, y, z);
    const weight = share(i) * share(j) / far ** 3;
    weights += weight;
    sum += weight * (map[k] + map[k + 1] + map[k + 2]) / 3;
  }
  return sum / weights;
}

/** The light of a sky, to which a sun is added. */
export class Sky {
  /** @param {Pack} light "light" @param {Pack} arriving "vertex_light" under it @param {Pack} shape "shape" @param {Pack} tables "sun" */
  constructor(light, arriving, shape, tables) {
    this.light = light;
    this.arriving = arriving;
    this.shape = shape;
    this.tables = tables;
    this.irradiance = unpacked(light.arrays.irradiance);
    this.reflection = unpacked(light.arrays.reflection);
    this.received = meanOver(this.irradiance, light.head.irradiance_side);
    this.irradianceNodes = nodes(light.head.irradiance_side);
    this.reflectionNodes = nodes(light.head.reflection_side);
    this.normals = new Float32Array(3 * arriving.arrays.bounce.length);
    const { normals } = shape.arrays;
    for (let v = 0; v < arriving.arrays.bounce.length; ++v) this.normals.set(fromOctahedron(Math.max(-1, normals[2 * v] / 32767), Math.max(-1, normals[2 * v + 1] / 32767)), 3 * v);
  }

  /** The irradiance of the sun on a surface, without occlusion. @param {number} cosine between the normal and the direction of the sun @param {number} power */
  falls(cosine, power) { return power * look(this.tables.arrays.irradiance, 0, this.tables.head.nodes, 0.5 + 0.5 * cosine); }

  /**
   * The light with the sun.
   * @param {Sun} sun @param {Vec[]} turn rotation of directions of the object to those of the light, rows
   * @returns {Pack[]} "light" and "vertex_light"
   */
  with(sun, turn) {
    const power = sun.strength * this.received, room = times(turn, sun.direction);
    return [{ head: this.light.head, arrays: { irradiance: this.falling(room, power), reflection: this.mirrored(room, power) } }, this.reaching(sun, turn, power)];
  }

  /** The map of irradiance with the sun. @param {Vec} to direction towards the sun, frame of the light @param {number} power */
  falling(to, power) {
    const n = this.irradiance.length / 3, out = new Uint32Array(n), { irradiance: e, irradianceNodes: d } = this;
    for (let i = 0; i < n; ++i) {
      const more = this.falls(d[3 * i] * to[0] + d[3 * i + 1] * to[1] + d[3 * i + 2] * to[2], power);
      out[i] = packed(e[3 * i] + more, e[3 * i + 1] + more, e[3 * i + 2] + more);
    }
    return out;
  }

  /** The map of reflections with the sun. @param {Vec} to direction towards the sun, frame of the light @param {number} power */
  mirrored(to, power) {
    const n = this.reflectionNodes.length / 3, out = new Uint32Array(this.light.arrays.reflection), { reflection: r, reflectionNodes: d } = this;
    const { nodes: count } = this.tables.head, table = this.tables.arrays.reflection;
    for (let i = 0; i < n; ++i) {
      const apart = Math.hypot(d[3 * i] - to[0], d[3 * i + 1] - to[1], d[3 * i + 2] - to[2]), at = Math.sqrt(apart / 2);
      for (let level = 0, k = i; k < out.length; ++level, k += n) {
        const more = power * look(table, level * count, count, at);
        if (more > 1e-3 * r[3 * k + 1]) out[k] = packed(r[3 * k] + more, r[3 * k + 1] + more, r[3 * k + 2] + more);
      }
    }
    return out;
  }

  /**
   * The share of the light that arrives at each vertex: of the sun, its irradiance times the visibility of its direction. The bounce is
   * scaled by the factor by which the sun raises the light that arrives at all vertices together.
   * @param {Sun} sun @param {Vec[]} turn @param {number} power @returns {Pack}
   */
  reaching({ direction: [x, y, z] }, turn, power) {
    const { visibility: skyVisibility, bounce } = this.arriving.arrays, n = bounce.length, out = new Uint8Array(skyVisibility), { normals, irradiance: sky } = this;
    const visibility = this.shape.arrays.visibility, scale = this.shape.head.visibility_scale / 127, side = this.light.head.irradiance_side;
    const terms = [1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y].map((t) => t * scale), before = [0, 0, 0], after = [0, 0, 0];
    const [a, b, c] = turn;
    for (let v = 0; v < n; ++v) {
      const nx = normals[3 * v], ny = normals[3 * v + 1], nz = normals[3 * v + 2];
      const node = 3 * nodeAt(side, a[0] * nx + a[1] * ny + a[2] * nz, b[0] * nx + b[1] * ny + b[2] * nz, c[0] * nx + c[1] * ny + c[2] * nz);
      const falls = Math.max(0, this.falls(nx * x + ny * y + nz * z, power));
      let visible = 0;
      for (let k = 0; k < 9; ++k) visible += terms[k] * visibility[12 * v + k];
      const arrives = falls * Math.max(0, Math.min(1, visible));
      for (let k = 0; k < 3; ++k) {
        const e = sky[node + k], was = e * skyVisibility[4 * v + k] / 255;
        before[k] += was;
        after[k] += was + arrives;
        if (falls > 0) out[4 * v + k] = Math.round(255 * (was + arrives) / Math.max(e + falls, 1e-9));
      }
    }
    const [r, g, l] = after.map((s, k) => s / Math.max(before[k], 1e-9)), own = unpacked(bounce);
    return { head: this.arriving.head, arrays: { visibility: out, bounce: Uint32Array.from({ length: n }, (_, v) => packed(own[3 * v] * r, own[3 * v + 1] * g, own[3 * v + 2] * l)) } };
  }
}

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/**
 * Approximates how handles pull the surface, until the program has computed it: vertices within the reach of a handle, measured along the
 * surface, follow it, less the farther away they are.
 */
import { add, rotation, sub, times } from './camera.js';
import { fromOctahedron, onOctahedron } from './octahedron.js';

/** @typedef {import('./camera.js').Vec} Vec */
/** @typedef {import('../pack.js').Pack} Pack */
/** @typedef {{from: Vec, to: Vec, axis: Vec, degrees: number}} Handle axis: unit, of its rotation. A handle that neither moves nor turns is a pin */
/**
 * @typedef {{vertices: Uint32Array, shares: Float32Array[], triangles: Uint32Array, normals: Float32Array}} Plan
 * vertices: those that move; shares: by which each of them follows each handle; triangles: places in the list of corners of the triangles
 * that have one of the vertices; normals: of the vertices, before they move.
 */

const kDisc = 0.15;  // share of the reach that moves with the handle, as in src/engine/edit/deform.cpp
const kBins = 256;  // of distances(), which visits vertices by bins instead of sorting them

/** @param {Handle} h */
const moves = (h) => h.degrees !== 0 || h.from.some((v, k) => v !== h.to[k]);

export class Pull {
  /** @param {Pack} shape "shape" */
  constructor(shape) {
    this.shape = shape;
    const { positions, triangles } = shape.arrays, { min, size } = shape.head, n = positions.length / 4;
    this.positions = Float32Array.from({ length: 3 * n }, (_, i) => min[i % 3] + size[i % 3] * positions[4 * Math.floor(i / 3) + i % 3] / 65535);
    // Neighbors of vertex v, most of them twice: others[begins[v]] to others[begins[v + 1] - 1].
    this.begins = new Uint32Array(n + 1);
    for (const v of triangles) this.begins[v + 1] += 2;
    for (let v = 0; v < n; ++v) this.begins[v + 1] += this.begins[v];
    this.others = new Uint32Array(2 * triangles.length);
    const next = this.begins.slice();
    for (let t = 0; t < triangles.length; t += 3) for (let k = 0; k < 3; ++k) {
      const v = triangles[t + k];
      this.others[next[v]++] = triangles[t + (k + 1) % 3];
      this.others[next[v]++] = triangles[t + (k + 2) % 3];
    }
    /** @type {{key: string, plan: Plan} | null} */
    this.last = null;
  }

  /** @param {number} v @returns {Vec} */
  at(v) { return [this.positions[3 * v], this.positions[3 * v + 1], this.positions[3 * v + 2]]; }

  /** The vertex nearest to a point. @param {Vec} p */
  nearest(p) {
    let best = 0, smallest = Infinity;
    for (let v = 0; v < this.positions.length / 3; ++v) {
      const d = (this.positions[3 * v] - p[0]) ** 2 + (this.positions[3 * v + 1] - p[1]) ** 2 + (this.positions[3 * v + 2] - p[2]) ** 2;
      if (d < smallest) [best, smallest] = [v, d];
    }
    return best;
  }

  /** Lengths of the shortest paths along edges; infinite beyond `reach`. @param {number} start vertex @param {number} reach @param {(v: number) => boolean} may whether a path may lead over a vertex */
  distances(start, reach, may) {
    const p = this.positions, far = new Float32Array(p.length / 3).fill(Infinity), bins = Array.from({ length: kBins + 1 }, () => /** @type {number[]} */ ([]));
    const binOf = (/** @type {number} */ d) => Math.floor(kBins * d / reach);
    far[start] = 0;
    bins[0].push(start);
    for (let b = 0; b <= kBins; ++b) for (let v = bins[b].pop(); v !== undefined; v = bins[b].pop()) {
      if (binOf(far[v]) < b) continue;
      for (let i = this.begins[v]; i < this.begins[v + 1]; ++i) {
        const w = this.others[i], d = far[v] + Math.hypot(p[3 * w] - p[3 * v], p[3 * w + 1] - p[3 * v + 1], p[3 * w + 2] - p[3 * v + 2]);
        if (d > reach || !(Math.fround(d) < far[w]) || !may(w)) continue;
        far[w] = d;
        bins[binOf(far[w])]?.push(w);
      }
    }
    return far;
  }

  /** The weight of a handle at every vertex: 1 at the handle, 0 beyond its reach. @param {Handle} h @param {number} reach @param {(v: number) => boolean} may */
  weights(h, reach, may) {
    return this.distances(this.nearest(h.from), reach, may).map((d) => {
      const t = Math.max(0, Math.min(1, (d / reach - kDisc) / (1 - kDisc)));
      return (1 - t) ** 2 * (1 + 2 * t);
    });
  }

  /** What does not change while the same handles are moved. @param {Handle[]} handles @param {number} reach @param {(v: number) => boolean} may @returns {Plan} */
  plan(handles, reach, may) {
    const all = handles.map((h) => this.weights(h, reach, may)), moving = handles.map(moves), n = this.positions.length / 3;
    const vertices = Uint32Array.from(function* () { for (let v = 0; v < n; ++v) if (all.some((w, k) => moving[k] && w[v] > 0)) yield v; }());
    const shares = handles.map(() => new Float32Array(vertices.length));
    vertices.forEach((v, i) => {
      // At a handle the shares of the others are 0.
      const own = all.map((w, k) => w[v] * all.reduce((left, other, j) => (j === k ? left : left * (1.0001 - other[v])), 1));
      const sum = own.reduce((a, b) => a + b), largest = Math.max(...all.map((w, k) => (moving[k] ? w[v] : 0)));
      own.forEach((o, k) => { shares[k][i] = largest * o / sum; });
    });
    const { triangles: corners } = this.shape.arrays, index = new Int32Array(n).fill(-1);
    vertices.forEach((v, i) => { index[v] = i; });
    const triangles = Uint32Array.from(function* () { for (let t = 0; t < corners.length; t += 3) if (index[corners[t]] >= 0 || index[corners[t + 1]] >= 0 || index[corners[t + 2]] >= 0) yield t; }());
    this.index = index;
    const plan = { vertices, shares, triangles, normals: new Float32Array(0) };
    plan.normals = this.normals(plan, this.positions);
    return plan;
  }

  /** Unit normals of the plan's vertices, from its triangles. @param {Plan} plan @param {Float32Array} p positions */
  normals({ vertices, triangles }, p) {
    const corners = this.shape.arrays.triangles, index = /** @type {Int32Array} */ (this.index), out = new Float32Array(3 * vertices.length);
    for (const t of triangles) {
      const a = 3 * corners[t], b = 3 * corners[t + 1], c = 3 * corners[t + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2], vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      for (let k = 0; k < 3; ++k) {
        const i = 3 * index[corners[t + k]];
        if (i < 0) continue;
        out[i] += x;
        out[i + 1] += y;
        out[i + 2] += z;
      }
    }
    for (let i = 0; i < out.length; i += 3) {
      const size = Math.hypot(out[i], out[i + 1], out[i + 2]) || 1;
      for (let k = 0; k < 3; ++k) out[i + k] /= size;
    }
    return out;
  }

  /**
   * Positions and normals of the pulled surface, as in a pack "shape", and the box of the positions.
   * @param {Handle[]} handles @param {number} reach @param {string} part name of the part that alone may move
   * @param {(v: number) => boolean} may whether a vertex may move
   */
  moved(handles, reach, part, may) {
    const key = JSON.stringify([handles.map((h) => [h.from, moves(h)]), reach, part]);
    if (this.last?.key !== key) this.last = { key, plan: this.plan(handles, reach, may) };
    const { plan } = this.last, p = this.positions.slice(), turns = handles.map((h) => rotation(h.axis, h.degrees * Math.PI / 180));
    plan.vertices.forEach((v, i) => {
      const from = this.at(v);
      handles.forEach((h, k) => {
        if (!moves(h) || plan.shares[k][i] === 0) return;
        const to = add(h.to, times(turns[k], sub(from, h.from)));
        for (let c = 0; c < 3; ++c) p[3 * v + c] += plan.shares[k][i] * (to[c] - from[c]);
      });
    });
    return { ...quantized(p), normals: this.turnedNormals(plan, p) };
  }

  /** Normals of the pack, changed as much as those of the triangles. @param {Plan} plan @param {Float32Array} p positions */
  turnedNormals(plan, p) {
    const out = Int16Array.from(this.shape.arrays.normals), after = this.normals(plan, p);
    plan.vertices.forEach((v, i) => {
      const was = fromOctahedron(out[2 * v] / 32767, out[2 * v + 1] / 32767), n = was.map((w, k) => w + after[3 * i + k] - plan.normals[3 * i + k]);
      out.set(onOctahedron(n[0], n[1], n[2] || 1e-9).map((x) => Math.round(32767 * x)), 2 * v);
    });
    return out;
  }
}

/** As in a pack. @param {Float32Array} p positions */
function quantized(p) {
  const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity], out = new Uint16Array(4 * p.length / 3);
  for (let i = 0; i < p.length; ++i) {
    min[i % 3] = Math.min(min[i % 3], p[i]);
    max[i % 3] = Math.max(max[i % 3], p[i]);
  }
  const size = max.map((m, k) => m - min[k]);
  for (let v = 0; v < p.length / 3; ++v) for (let k = 0; k < 3; ++k) out[4 * v + k] = size[k] > 0 ? Math.round(65535 * (p[3 * v + k] - min[k]) / size[k]) : 0;
  return { positions: out, min, size };
}

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/**
 * The camera of the view, in the capture frame. Axes are OpenCV's: x right, y down, z into the scene; pixels
 * have their centers at +0.5. It has the field of view of a photograph, whose rectangle is fitted into the canvas.
 */
import { cross, dot, mul, plus, rotation, unit } from '../camera.js';

export { cross, dot, mul, rotation, unit };

/** @typedef {import('../camera.js').Vec3} Vec */
/** @typedef {{width: number, height: number, fx: number, fy: number, cx: number, cy: number, skew: number, world_from_cam: Vec[], center: Vec}} CameraJson */

/** @param {Vec} a @param {Vec} b */
export const add = (a, b) => plus(a, b);
/** @param {Vec} a @param {Vec} b */
export const sub = (a, b) => plus(a, b, -1);
/** @param {Vec} a */
export const length = (a) => Math.hypot(...a);
/** A matrix times a vector. @param {Vec[]} rows @param {Vec} v @returns {Vec} */
export const times = (rows, v) => [dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)];

export class ViewCamera {
  /** @param {CameraJson} lens a photograph's camera @param {Vec} target point that the view turns about @param {Vec} up unit @param {number} radius of the object */
  constructor(lens, target, up, radius) {
    this.home = { lens, target };
    /** @type {Vec} */
    this.target = target;
    /** @type {CameraJson} */
    this.lens = lens;
    /** @type {Vec} */
    this.center = lens.center;
    /** @type {[Vec, Vec, Vec]} right, down, forward */
    this.axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    this.up = up;
    this.radius = radius;
    this.goHome();
  }

  goHome() {
    this.take(this.home.lens);
    this.target = this.home.target;
  }

  /** Moves to the camera of a photograph. @param {CameraJson} c */
  take(c) {
    this.lens = c;
    this.center = c.center;
    const r = c.world_from_cam;
    this.axes = [[r[0][0], r[1][0], r[2][0]], [r[0][1], r[1][1], r[2][1]], [r[0][2], r[1][2], r[2][2]]];
    const ahead = dot(sub(this.target, this.center), this.axes[2]);
    if (ahead > 0) this.target = add(this.center, mul(this.axes[2], ahead));  // the point on the axis nearest to the previous target
  }

  distance() { return length(sub(this.target, this.center)); }

  /** Turns about the target. Angles in radians: about the up axis, and up or down. @param {number} around @param {number} over */
  orbit(around, over) {
    const tilt = Math.asin(Math.max(-1, Math.min(1, dot(this.axes[2], this.up))));
    const limit = 1.5;
    const allowed = Math.max(-limit, Math.min(limit, tilt - over)) - tilt;
    const tilting = rotation(this.axes[0], -allowed), turning = rotation(this.up, around);
    const move = (/** @type {Vec} */ v) => times(turning, times(tilting, v));
    const arm = move(sub(this.center, this.target));
    this.axes = /** @type {[Vec, Vec, Vec]} */ (this.axes.map(move));
    this.center = add(this.target, arm);
  }

  /** Moves the camera and its target, by pixels of a canvas. @param {number} dx @param {number} dy @param {number} width @param {number} height */
  pan(dx, dy, width, height) {
    const c = this.json(width, height);
    const s = this.distance() / c.fx;
    const shift = add(mul(this.axes[0], -dx * s), mul(this.axes[1], -dy * s));
    this.center = add(this.center, shift);
    this.target = add(this.target, shift);
  }

  /** Moves nearer (factor < 1) to what is seen at a pixel, or farther from it. @param {number} factor @param {number} x @param {number} y @param {number} width @param {number} height */
  zoom(factor, x, y, width, height) {
    const near = 0.05 * this.radius, far = 60 * this.radius, d = this.distance();
    const s = Math.max(near, Math.min(far, d * factor)) / d;
    const c = this.json(width, height);
    const at = add(this.center, add(mul(this.axes[2], d), add(mul(this.axes[0], d * (x - c.cx) / c.fx), mul(this.axes[1], d * (y - c.cy) / c.fy))));
    this.center = add(at, mul(sub(this.center, at), s));
    this.target = add(at, mul(sub(this.target, at), s));
  }

  /** Moves so that a whole ball is seen. @param {Vec} center @param {number} radius */
  frame(center, radius) {
    const c = this.lens, half = Math.min(c.width / c.fx, c.height / c.fy) / 2;
    const d = 1.15 * radius / Math.sin(Math.atan(half));
    this.target = center;
    this.center = sub(center, mul(this.axes[2], d));
    this.lens = { ...c, cx: c.width / 2, cy: c.height / 2 };
  }

  /** The rectangle of a canvas that the photograph fills. @param {number} width @param {number} height */
  rectangle(width, height) {
    const s = Math.min(width / this.lens.width, height / this.lens.height);
    const w = s * this.lens.width, h = s * this.lens.height;
    return { x: (width - w) / 2, y: (height - h) / 2, width: w, height: h, scale: s };
  }

  /** The camera with the size of a canvas. @param {number} width @param {number} height @returns {CameraJson} */
  json(width, height) {
    const r = this.rectangle(width, height), l = this.lens, [x, y, z] = this.axes;
    return {
      width, height,
      fx: l.fx * r.scale, fy: l.fy * r.scale, cx: l.cx * r.scale + r.x, cy: l.cy * r.scale + r.y, skew: l.skew * r.scale,
      world_from_cam: [[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]],
      center: this.center,
    };
  }
}

/** The pixel where a camera sees a point; depth: of the point, along the axis of the camera. @param {CameraJson} c @param {Vec} p @returns {{x: number, y: number, depth: number}} */
export function seen(c, p) {
  const away = sub(p, c.center), r = c.world_from_cam;
  const [x, y, z] = [0, 1, 2].map((k) => r[0][k] * away[0] + r[1][k] * away[1] + r[2][k] * away[2]);
  return { x: (c.fx * x + c.skew * y) / z + c.cx, y: c.fy * y / z + c.cy, depth: z };
}

/** The point at a pixel of a camera, at a depth along its axis. @param {CameraJson} c @param {number} x @param {number} y @param {number} depth @returns {Vec} */
export function pointAt(c, x, y, depth) {
  const v = (y - c.cy) / c.fy, u = (x - c.cx - c.skew * v) / c.fx;
  const r = c.world_from_cam;
  return /** @type {Vec} */ ([0, 1, 2].map((k) => c.center[k] + depth * (r[k][0] * u + r[k][1] * v + r[k][2])));
}

/** Where a camera sees the corners of the picture of another one, `over`, that stands at a depth before `over`: upper left, upper right, lower right, lower left. @param {CameraJson} over @param {number} depth @param {CameraJson} camera */
export const cornersOf = (over, depth, camera) => [[0, 0], [over.width, 0], [over.width, over.height], [0, over.height]].map(([x, y]) => seen(camera, pointAt(over, x, y, depth)));

/**
 * The transform of a canvas that draws a picture between four corners. It is affine, so it misses the lower right corner a little.
 * @param {{x: number, y: number}[]} corners @param {number} width @param {number} height @returns {[number, number, number, number, number, number]}
 */
export const ontoCorners = ([a, b, , d], width, height) => [(b.x - a.x) / width, (b.y - a.y) / width, (d.x - a.x) / height, (d.y - a.y) / height, a.x, a.y];

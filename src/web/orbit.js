// SPDX-License-Identifier: Apache-2.0
// @ts-check
// A camera that moves around an object.
import { cross, dot, mul, plus, unit } from './camera.js';

/** @typedef {import('./camera.js').Camera} Camera */
/** @typedef {import('./camera.js').Vec3} Vec3 */

const kFieldOfView = 0.6;        // radians, along the shorter side
const kMaxElevation = 1.55;     // radians; less than from straight above, where left and right would swap
const kNearest = 1.05, kFarthest = 20;  // times the object's radius

export class Orbit {
  /**
   * @param {Vec3} center of the object
   * @param {number} radius of a sphere around it
   * @param {Vec3} up unit
   * @param {Vec3} from direction from the object towards the camera at the start
   */
  constructor(center, radius, up, from) {
    this.center = center;
    this.radius = radius;
    this.up = up;
    /** @type {Vec3} */
    const side = Math.abs(dot(up, unit(from))) < 0.99 ? from : [up[1], up[2], up[0]];
    this.right = unit(cross(up, side));  // with `front`, the axes of the azimuth
    this.front = cross(this.right, up);
    this.start = {azimuth: 0, elevation: Math.asin(dot(unit(from), up))};
    this.azimuth = 0;
    this.elevation = 0;
    this.distance = 1;
    this.target = center;
    this.home();
  }

  /** Moves back to the start. */
  home() {
    this.azimuth = this.start.azimuth;
    this.elevation = Math.min(Math.max(this.start.elevation, -kMaxElevation), kMaxElevation);
    this.distance = (1.08 * this.radius) / Math.sin(kFieldOfView / 2);
    this.target = this.center;
  }

  /** Moves the camera to the right and up, around the target. @param {number} right radians @param {number} up */
  turn(right, up) {
    this.azimuth += right;
    this.elevation = Math.min(Math.max(this.elevation + up, -kMaxElevation), kMaxElevation);
  }

  /** @param {number} factor of the distance */
  zoom(factor) {
    this.distance = Math.min(Math.max(this.distance * factor, kNearest * this.radius), kFarthest * this.radius);
  }

  /** Moves the target and the camera with it. @param {number} right shares of the shorter side of the picture @param {number} down */
  pan(right, down) {
    const size = 2 * this.distance * Math.tan(kFieldOfView / 2);
    const [x, y] = this.axes();
    const moved = plus(plus(this.target, x, -right * size), y, -down * size);
    const offset = plus(moved, this.center, -1), length = Math.hypot(...offset);
    const max = 2 * this.radius;
    this.target = length > max ? plus(this.center, offset, max / length) : moved;
  }

  /** Right, down and forward of the camera. @returns {Vec3[]} */
  axes() {
    const c = Math.cos(this.elevation), s = Math.sin(this.elevation);
    const level = plus(mul(this.front, Math.cos(this.azimuth)), this.right, Math.sin(this.azimuth));
    const away = plus(mul(level, c), this.up, s);
    const forward = mul(away, -1);
    const right = unit(cross(forward, this.up));
    return [right, cross(forward, right), forward];
  }

  /**
   * @param {number} width pixels
   * @param {number} height
   * @returns {Camera}
   */
  camera(width, height) {
    const [x, y, z] = this.axes();
    const focal = Math.min(width, height) / (2 * Math.tan(kFieldOfView / 2));
    return {
      width, height, fx: focal, fy: focal, cx: width / 2, cy: height / 2,
      world_from_cam: [0, 1, 2].map((row) => [x[row], y[row], z[row]]),
      center: plus(this.target, z, -this.distance),
    };
  }
}

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** How fine the page's own pictures are while something moves: as fine as there is time for. */

/** @typedef {{scale: number, rough: boolean, coarse: boolean}} Step share of the pixels of a side; whether edges are left as they are; whether triangles are few */

/**
 * Where a driver draws in software the second takes a third of the time of the first, the third half of that, because most of it goes into
 * the triangles, and the last half again.
 * @type {Step[]}
 */
export const steps = [{ scale: 1, rough: false, coarse: false }, { scale: 1, rough: true, coarse: false },
  { scale: 1, rough: true, coarse: true }, { scale: 0.5, rough: true, coarse: true }];
const kSlow = 100;  // milliseconds
const kQuick = kSlow / 4;  // so that the next finer one is not slow
const kOften = 4;  // pictures that must be quick

export class Pace {
  /** @param {boolean} software whether the driver draws without a graphics processor */
  constructor(software) {
    this.at = software ? steps.length - 2 : 0;
    this.quick = 0;  // how many were, one after the other
    this.first = true;  // picture of this step, for which the driver prepares itself
  }

  get step() { return steps[this.at]; }

  /** @param {number} milliseconds that a picture of this step took */
  took(milliseconds) {
    if (this.first) {
      this.first = false;
      return;
    }
    this.quick = milliseconds < kQuick ? this.quick + 1 : 0;
    if (milliseconds > kSlow) this.go(milliseconds > 3 * kSlow ? 2 : 1);
    else if (this.quick === kOften) this.go(-1);
  }

  /** @param {number} by how many steps coarser */
  go(by) {
    const at = Math.max(0, Math.min(steps.length - 1, this.at + by));
    this.first = at !== this.at;
    this.at = at;
    this.quick = 0;
  }
}

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Chooses the quality of the page's own pictures while something moves: the best that can be drawn in time. */

/** @typedef {{scale: number, rough: boolean, coarse: boolean}} Step a level of quality. scale: factor of width and height; rough: edges are not smoothed; coarse: fewer triangles are drawn */

/**
 * From the best quality to the fastest. Relative times where a driver draws in software, which spends most of it on triangles: 1, 1/3, 1/6, 1/12.
 * @type {Step[]}
 */
export const steps = [{ scale: 1, rough: false, coarse: false }, { scale: 1, rough: true, coarse: false },
  { scale: 1, rough: true, coarse: true }, { scale: 0.5, rough: true, coarse: true }];
const kSlow = 100;  // milliseconds
const kQuick = kSlow / 4;  // low enough that pictures of the next better step are not slow
const kQuickInARow = 4;  // pictures after which the next better step is tried

export class Pace {
  /** @param {boolean} software whether the driver draws without a graphics processor */
  constructor(software) {
    this.at = software ? steps.length - 2 : 0;
    this.quick = 0;  // number of consecutive quick pictures
    this.first = true;  // the next picture is the first of this step and not measured, because the driver prepares itself for it
  }

  get step() { return steps[this.at]; }

  /** Chooses the step of the next picture. @param {number} milliseconds that a picture of this step took */
  took(milliseconds) {
    if (this.first) {
      this.first = false;
      return;
    }
    this.quick = milliseconds < kQuick ? this.quick + 1 : 0;
    if (milliseconds > kSlow) this.go(milliseconds > 3 * kSlow ? 2 : 1);
    else if (this.quick === kQuickInARow) this.go(-1);
  }

  /** @param {number} by number of steps towards the fastest */
  go(by) {
    const at = Math.max(0, Math.min(steps.length - 1, this.at + by));
    this.first = at !== this.at;
    this.at = at;
    this.quick = 0;
  }
}

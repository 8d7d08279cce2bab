// SPDX-License-Identifier: Apache-2.0
// @ts-check

/** Runs an action, one run at a time. However many calls come during a run, one more run follows it, with the state at that time. */
export class Newest {
  /** @param {() => Promise<any>} work */
  constructor(work) {
    this.work = work;
    this.again = false;
    /** @type {Promise<void> | null} */
    this.running = null;
  }

  /** @returns {Promise<void>} done when no run is left */
  run() {
    this.again = true;
    this.running ??= this.all();
    return this.running;
  }

  async all() {
    try {
      while (this.again) {
        this.again = false;
        await this.work();
      }
    } finally { this.running = null; }
  }
}

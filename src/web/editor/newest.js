// SPDX-License-Identifier: Apache-2.0
// @ts-check

/** Does something once at a time. What is asked for meanwhile waits, and is then done once: as things stand by then. */
export class Newest {
  /** @param {() => Promise<any>} work */
  constructor(work) {
    this.work = work;
    this.again = false;
    /** @type {Promise<void> | null} */
    this.running = null;
  }

  /** @returns {Promise<void>} when nothing is left to do */
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

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Changes of shape that are tried: while a handle moves the page pulls the surface by itself, at rest the program bends it. */
import { complain } from './dom.js';
import { postJson } from './api.js';
import { Newest } from './newest.js';

const kRest = 150;  // milliseconds without movement until the program is asked

/** @typedef {{handles: import('./pull.js').Handle[], reach: number}} Pulled reach: along the surface, in the object's units */

export class ShapeTrial {
  /**
   * @param {import('./stage.js').Stage} stage
   * @param {() => object | null} params of the edit; null: nothing is tried any more
   * @param {() => Pulled | null} pulled null: it is not known
   */
  constructor(stage, params, pulled) {
    this.stage = stage;
    this.params = params;
    this.pulled = pulled;
    this.number = 0;  // of the trial
    this.moves = 0;
    this.timer = 0;
    this.newest = new Newest(() => this.ask());
  }

  /** Something has moved. */
  moved() {
    ++this.moves;
    clearTimeout(this.timer);
    const pulled = this.pulled();
    if (pulled && this.stage.pull(pulled.handles, pulled.reach)) this.timer = window.setTimeout(() => this.newest.run(), kRest);
    else this.newest.run();
  }

  /** What was asked for is not wanted any more. */
  end() {
    ++this.number;
    clearTimeout(this.timer);
  }

  async ask() {
    const params = this.params(), { number, moves } = this;
    if (!params) return;
    try {
      const made = await postJson('preview', { op: 'deform', params });
      const late = number !== this.number || (this.stage.pulling && moves !== this.moves);
      if (!late) await this.stage.tryEdit(made.token);
    } catch (error) { if (number === this.number) complain(error); }
  }
}

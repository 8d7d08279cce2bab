// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Previews of changes of shape. While a handle moves, the page pulls the surface approximately; at rest the program computes the edit. */
import { complain } from './dom.js';
import { postJson } from './api.js';
import { Newest } from './newest.js';

const kRest = 150;  // milliseconds without movement until the program computes the edit

/** @typedef {{handles: import('./pull.js').Handle[], reach: number}} Pulled reach: along the surface, capture units */

export class ShapeTrial {
  /**
   * @param {import('./stage.js').Stage} stage
   * @param {() => object | null} params of the edit; null: there is nothing to preview any more
   * @param {() => Pulled | null} pulled handles for the page; null: they are not known yet
   */
  constructor(stage, params, pulled) {
    this.stage = stage;
    this.params = params;
    this.pulled = pulled;
    this.number = 0;  // of the trial, to ignore previews of an earlier one
    this.moves = 0;  // number of movements
    this.timer = 0;
    this.newest = new Newest(() => this.ask());
  }

  /** A handle has moved. */
  moved() {
    ++this.moves;
    clearTimeout(this.timer);
    const pulled = this.pulled();
    if (pulled && this.stage.pull(pulled.handles, pulled.reach)) this.timer = window.setTimeout(() => this.newest.run(), kRest);
    else this.newest.run();
  }

  /** Ends the trial; a preview that was asked for is ignored. */
  end() {
    ++this.number;
    clearTimeout(this.timer);
  }

  /** Previews the edit as the program computes it. */
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

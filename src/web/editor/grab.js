// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Grab: a point of the surface is dragged parallel to the plane of the picture, and its surroundings follow. */
import { pointAt, seen } from './camera.js';
import { el, showValue, slider } from './dom.js';
import { postJson } from './api.js';
import { ring } from './paint.js';
import { ShapeTrial } from './trial.js';

export class GrabTool {
  /** @param {import('./stage.js').Stage} stage @param {import('./store.js').Store} store */
  constructor(stage, store) {
    this.stage = stage;
    this.store = store;
    this.name = 'grab';
    this.label = 'Grab';
    this.hint = 'Drag a point of the object; the surface within the circle follows. [ ] change the circle.';
    this.reach = 0.25;  // of the object's radius
    /** @type {any} */
    this.start = null;
    /** @type {any} */
    this.at = null;
    /** @type {import('./camera.js').Vec | null} the point of the surface where the drag began, once it is known */
    this.from = null;
    this.trial = new ShapeTrial(stage, () => (this.start ? this.params() : null), () => this.pulled());
  }

  options() {
    const part = this.store.part;
    return [
      el('label', {}, 'Reach', slider('grab-reach', [0.03, 1], this.reach, (reach) => { this.reach = reach; this.stage.redraw(); })),
      el('span', {}, part ? `Only the part ${part} moves.` : 'The whole object can move.'),
    ];
  }

  leave() { this.cancel(); this.at = null; }

  /** @param {any} p */
  hover(p) { this.at = p; this.stage.redraw(); }
  /** @param {any} p */
  down(p) {
    this.start = p;
    this.camera = this.stage.json();
    this.moved = false;
    this.from = null;
    postJson('pick', { camera: this.camera, pixel: [p.x, p.y] }).then((found) => { if (this.start === p) this.from = found?.position ?? null; }).catch(() => {});
  }
  /** @param {any} p */
  move(p) {
    this.at = p;
    if (!this.start) return;
    this.moved ||= Math.hypot(p.x - this.start.x, p.y - this.start.y) > 4;
    this.stage.redraw();
    if (this.moved) this.trial.moved();
  }

  params() {
    return { camera: this.camera, pixel: [this.start.x, this.start.y], drag: [this.at.x - this.start.x, this.at.y - this.start.y],
      radius: this.reach * this.store.object.radius, ...(this.store.part ? { part: this.store.part } : {}) };
  }

  pulled() {
    const { from, camera, at } = this;
    if (!from || !camera) return null;
    return { handles: [{ from, to: pointAt(camera, at.x, at.y, seen(camera, from).depth), axis: /** @type {import('./camera.js').Vec} */ ([0, 0, 1]), degrees: 0 }], reach: this.reach * this.store.object.radius };
  }

  /** @param {any} p */
  async up(p) {
    if (!this.start) return;
    this.at = p;
    this.trial.end();
    const params = this.params(), moved = this.moved;
    this.start = null;
    if (moved) await this.store.change('edit', { op: 'deform', params });
    await this.stage.tryEdit(null);
  }

  cancel() {
    this.trial.end();
    if (!this.start) return;
    this.start = null;
    this.stage.tryEdit(null);
  }
  drop() { this.cancel(); }

  /** @param {number} factor */
  size(factor) {
    this.reach = Math.max(0.03, Math.min(1, this.reach * factor));
    showValue('grab-reach', this.reach);
    this.stage.redraw();
  }

  /** @param {CanvasRenderingContext2D} c */
  draw(c) {
    const p = this.start ?? this.at;
    if (!p) return;
    const camera = this.stage.json(), r = this.reach * (this.store.object?.radius ?? 1) * camera.fx / this.stage.camera.distance();
    ring(c, p.x, p.y, r);
    if (!this.start || !this.at) return;
    ring(c, this.start.x, this.start.y, 5);
    c.strokeStyle = '#ffb454';
    c.lineWidth = 2.5;
    c.beginPath();
    c.moveTo(this.start.x, this.start.y);
    c.lineTo(this.at.x, this.at.y);
    c.stroke();
    ring(c, this.at.x, this.at.y, 7);
  }
}

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Bends the surface by several handles, which are moved and turned, and by pins, which hold it in place. */
import { add, dot, mul, pointAt, seen, sub, length } from './camera.js';
import { complain, el, field, select, slider, toast } from './dom.js';
import { postJson } from './api.js';
import { ring } from './paint.js';
import { ShapeTrial } from './trial.js';

/** @typedef {import('./camera.js').Vec} Vec */
/** @typedef {{pin: boolean, from: Vec, to: Vec, axis: Vec, degrees: number}} BendPoint */

const kNear = 14;  // pixels of the screen within which a press hits a handle or pin

export class BendTool {
  /** @param {import('./stage.js').Stage} stage @param {import('./store.js').Store} store */
  constructor(stage, store) {
    this.stage = stage;
    this.store = store;
    this.name = 'bend';
    this.label = 'Bend';
    this.hint = 'Click to set handles and pins, then drag handles or use the sliders. Enter keeps it, Esc discards it, Delete removes a point.';
    this.reach = 0.25;  // of the object's radius
    this.sets = 'handle';
    /** @type {BendPoint[]} */
    this.points = [];
    /** @type {BendPoint | null} */
    this.selected = null;
    this.dragging = false;
    this.trial = new ShapeTrial(stage, () => (this.changes() ? this.params() : null), () => this.pulled());
  }

  /** Whether there is something to keep or discard. */
  tries() { return this.points.length > 0; }

  options() {
    return [
      el('label', {}, 'A click sets', select({ id: 'bend-sets' }, [['handle', 'a handle'], ['pin', 'a pin']], this.sets, (sets) => { this.sets = sets; })),
      el('label', {}, 'Reach', slider('bend-reach', [0.03, 1], this.reach, (reach) => { this.reach = reach; this.preview(); })),
      el('button', { class: 'primary of-trial', id: 'bend-keep', onclick: () => this.keep() }, 'Keep'),
      el('button', { class: 'of-trial', onclick: () => this.drop() }, 'Discard'),
    ];
  }

  /** Sliders of the selected handle, in the axes of the view. */
  panel() {
    const p = this.selected;
    if (!p || p.pin) return [el('p', {}, this.points.length ? 'Select a handle to move and turn it.' : 'Click on the object to set handles and pins.')];
    const [right, down] = this.stage.camera.axes, size = this.store.object.radius, moved = sub(p.to, p.from);
    const move = (/** @type {string} */ id, /** @type {string} */ label, /** @type {number} */ max, /** @type {number} */ value, /** @type {(v: number) => void} */ set) =>
      field(label, id, [-max, max], value, (v) => v.toFixed(2), (v) => { set(v); this.stage.redraw(); this.preview(); });
    const along = (/** @type {Vec} */ axis) => (/** @type {number} */ v) => { p.to = add(p.to, mul(axis, v * size - dot(sub(p.to, p.from), axis))); };
    return [
      move('bend-right', 'Right', 1, dot(moved, right) / size, along(right)),
      move('bend-up', 'Up', 1, -dot(moved, down) / size, along(mul(down, -1))),
      move('bend-turn', 'Turned', 180, p.degrees, (v) => { p.axis = this.stage.camera.axes[2]; p.degrees = v; }),
    ];
  }

  leave() { this.drop(); }

  /** The handle or pin at a place of the pointer. @param {any} p @returns {BendPoint | null} */
  at(p) {
    const camera = this.stage.json(), { scale } = this.stage.size();
    const near = (/** @type {BendPoint} */ b) => { const s = seen(camera, b.to); return Math.hypot(s.x - p.x, s.y - p.y); };
    const best = this.points.reduce((/** @type {BendPoint | null} */ a, b) => (a && near(a) <= near(b) ? a : b), null);
    return best && near(best) < kNear * scale ? best : null;
  }

  /** Whether a press is for this tool although it is beside the object: handles may lie there. @param {any} p */
  takes(p) { return this.at(p) !== null; }

  /** @param {any} p */
  down(p) {
    const hit = this.at(p);
    this.adding = !hit;
    if (hit) this.select(hit);
    this.dragging = hit !== null && !hit.pin;
  }

  /** @param {any} p */
  move(p) {
    if (!this.dragging || !this.selected) return;
    const camera = this.stage.json();
    this.selected.to = pointAt(camera, p.x, p.y, seen(camera, this.selected.to).depth);
    this.stage.redraw();
    this.preview();
  }

  /** @param {any} p */
  async up(p) {
    if (this.dragging) this.stage.emit('options');
    this.dragging = false;
    if (this.adding) await this.addAt(p);
    this.adding = false;
  }

  cancel() { this.dragging = this.adding = false; }

  /** @param {any} p */
  async addAt(p) {
    if (this.changes()) return toast('Set all points before you move one, or keep this edit and then set more.');
    try {
      const found = await postJson('pick', { camera: this.stage.json(), pixel: [p.x, p.y] });
      if (!found) return;
      const point = { pin: this.sets === 'pin', from: found.position, to: found.position, axis: /** @type {Vec} */ ([0, 0, 1]), degrees: 0 };
      this.points.push(point);
      this.select(point);
    } catch (error) { complain(error); }
  }

  /** @param {BendPoint | null} point */
  select(point) {
    this.selected = point;
    this.stage.emit('options');
    this.stage.redraw();
  }

  /** Whether a handle is moved or turned. */
  changes() { return this.points.some(moves); }

  /** Parameters of the edit. A handle that is neither moved nor turned becomes a pin. */
  params() {
    const [first, ...more] = this.points.filter(moves).map(({ from, to, axis, degrees }) => ({ from, to, ...(degrees ? { turn: mul(axis, degrees) } : {}) }));
    const pins = this.points.filter((p) => !moves(p)).map((p) => p.from);
    return { ...first, ...(more.length ? { more } : {}), ...(pins.length ? { pins } : {}),
      radius: this.reach * this.store.object.radius, ...(this.store.part ? { part: this.store.part } : {}) };
  }

  pulled() {
    const handles = this.points.map((p) => (moves(p) ? p : { ...p, to: p.from, degrees: 0 }));
    return { handles, reach: this.reach * this.store.object.radius };
  }

  preview() { if (this.changes()) this.trial.moved(); }

  async keep() {
    if (!this.changes()) return;
    const params = this.params();
    this.forget();
    await this.store.change('edit', { op: 'deform', params });
    await this.stage.tryEdit(null);
  }

  drop() {
    const had = this.changes();
    this.forget();
    if (had) this.stage.tryEdit(null);
  }

  forget() {
    this.trial.end();
    this.dragging = false;
    this.points = [];
    this.select(null);
  }

  undo() { return this.takeAway(this.points.at(-1) ?? null); }
  remove() { return this.takeAway(this.selected); }

  /** @param {BendPoint | null} point @returns {boolean} whether there was one */
  takeAway(point) {
    if (!point) return false;
    this.points = this.points.filter((p) => p !== point);
    this.select(this.points.at(-1) ?? null);
    if (this.changes()) this.preview();
    else if (this.stage.preview || this.stage.pulling) {
      this.trial.end();
      this.stage.tryEdit(null);
    }
    return true;
  }

  /** @param {number} factor */
  size(factor) {
    this.reach = Math.max(0.03, Math.min(1, this.reach * factor));
    this.stage.emit('options');
    this.preview();
  }

  /** @param {CanvasRenderingContext2D} c */
  draw(c) {
    const camera = this.stage.json(), { scale } = this.stage.size();
    for (const p of this.points) {
      const from = seen(camera, p.from), to = seen(camera, p.to), on = p === this.selected, r = (on ? 9 : 7) * scale;
      if (p.pin) square(c, to.x, to.y, r, on);
      else {
        line(c, from, to);
        ring(c, to.x, to.y, r);
        c.fillStyle = on ? '#ffb454' : '#1557c0';
        c.beginPath();
        c.arc(to.x, to.y, r - 2, 0, 2 * Math.PI);
        c.fill();
        line(c, to, { x: to.x + 2 * r * Math.sin(p.degrees * Math.PI / 180), y: to.y - 2 * r * Math.cos(p.degrees * Math.PI / 180) });
      }
      if (on && !p.pin) ring(c, from.x, from.y, this.reach * this.store.object.radius * camera.fx / from.depth);
    }
  }
}

/** @param {BendPoint} p */
const moves = (p) => !p.pin && (length(sub(p.to, p.from)) > 1e-9 || p.degrees !== 0);

/** @param {CanvasRenderingContext2D} c @param {{x: number, y: number}} a @param {{x: number, y: number}} b */
function line(c, a, b) {
  for (const [color, width] of /** @type {[string, number][]} */ ([['#000a', 4], ['#ffb454', 2]])) {
    c.strokeStyle = color;
    c.lineWidth = width;
    c.beginPath();
    c.moveTo(a.x, a.y);
    c.lineTo(b.x, b.y);
    c.stroke();
  }
}

/** @param {CanvasRenderingContext2D} c @param {number} x @param {number} y @param {number} r @param {boolean} on */
function square(c, x, y, r, on) {
  c.fillStyle = on ? '#ffb454' : '#fff';
  c.strokeStyle = '#000';
  c.lineWidth = 2;
  c.fillRect(x - r, y - r, 2 * r, 2 * r);
  c.strokeRect(x - r, y - r, 2 * r, 2 * r);
}

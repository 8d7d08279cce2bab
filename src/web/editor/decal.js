// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** A picture that is laid onto the object: it is moved, turned and scaled, and then painted into the color of the object. */
import { cornersOf, ontoCorners } from './camera.js';
import { complain, el, slider, toast } from './dom.js';
import { postJson, upload } from './api.js';
import { Newest } from './newest.js';
import { dashed, polygon } from './paint.js';

/** @typedef {import('./camera.js').CameraJson} CameraJson */

export class DecalTool {
  /** @param {import('./stage.js').Stage} stage @param {import('./store.js').Store} store */
  constructor(stage, store) {
    this.stage = stage;
    this.store = store;
    this.name = 'decal';
    this.label = 'Decal';
    this.hint = 'Drop a picture on the object, or choose one and click where it should lie. Drag moves it, [ ] scale it, Enter presses it in, Esc discards it.';
    this.width = 0.5;  // of the object's radius
    this.turn = 0;  // degrees, clockwise
    /** @type {{id: string, file: Blob, name: string, bitmap: ImageBitmap} | null} */
    this.picture = null;
    /** @type {{camera: CameraJson, pixel: [number, number]} | null} the camera and the pixel at which its middle lies */
    this.place = null;
    /** @type {CameraJson | null} the camera whose picture the decal is */
    this.over = null;
    this.number = 0;
    this.locations = new Newest(() => this.locateNow());
    this.pressed = false;
    this.timer = 0;
  }

  /** Whether there is something to keep or discard. */
  tries() { return this.place !== null; }

  options() {
    const row = (/** @type {string} */ label, /** @type {'width' | 'turn'} */ key, /** @type {number} */ min, /** @type {number} */ max) =>
      el('label', {}, label, slider(`decal-${key}`, [min, max], this[key], (value) => { this[key] = value; this.locate(); }, { onchange: () => this.preview() }));
    return [
      el('button', { id: 'decal-choose', onclick: () => this.choose() }, 'Picture…'), row('Size', 'width', 0.02, 2), row('Turned', 'turn', -180, 180),
      el('button', { class: 'primary of-trial', id: 'decal-keep', onclick: () => this.keep() }, 'Press in'), el('button', { class: 'of-trial', onclick: () => this.drop() }, 'Discard'),
    ];
  }

  leave() { this.drop(); }

  choose() {
    const input = el('input', { type: 'file', accept: 'image/*' });
    input.onchange = () => { if (input.files[0]) this.take(input.files[0]); };
    input.click();
  }

  /** @param {File} file @param {{x: number, y: number}} [at] where it was dropped */
  async take(file, at) {
    try {
      const bitmap = await createImageBitmap(file), known = ['image/png', 'image/jpeg'].includes(file.type);
      const picture = known ? file : await pngOf(bitmap);
      this.picture = { id: await upload(picture, file.name), file: picture, name: file.name, bitmap };
      if (!at) return toast('Click on the object where the picture should lie.');
      this.put(at);
      await this.preview();
    } catch (error) { complain(error); }
  }

  /** @param {{x: number, y: number}} p */
  put(p) {
    this.place = { camera: this.stage.json(), pixel: [p.x, p.y] };
    return this.locate();
  }

  decal() { return { pixel: this.place?.pixel, width: this.width * this.store.object.radius, turn: this.turn }; }

  locate() { return this.locations.run(); }

  /** Asks the program for the camera whose picture the decal is. */
  async locateNow() {
    if (!this.place || !this.picture) return;
    const { width, height } = this.picture.bitmap;
    try {
      const over = await postJson('decal', { camera: this.place.camera, decal: this.decal(), size: [width, height] });
      if (this.place) this.over = over;
    } catch (error) { complain(error); }
    this.stage.redraw();
  }

  params() { return { strokes: [{ camera: this.place?.camera, scribble: this.picture?.id, decal: this.decal() }] }; }

  /** Shows the object with the decal in its color. */
  async preview() {
    if (!this.place || !this.picture) return;
    const number = ++this.number;
    try {
      const made = await postJson('preview', { op: 'paint', params: this.params() });
      if (number === this.number) await this.stage.tryEdit(made.token, true);
    } catch (error) { if (number === this.number) complain(error); }
  }

  async keep() {
    if (!this.place || !this.picture) return;
    const params = this.params(), { file, name } = this.picture;
    this.forget();
    await this.store.change('edit', async () => {
      await upload(file, name);
      return { op: 'paint', params };
    });
    await this.stage.tryEdit(null);
  }

  drop() {
    const had = this.place !== null;
    this.forget();
    if (had) this.stage.tryEdit(null);
  }

  forget() {
    ++this.number;
    this.place = this.over = null;
    this.pressed = false;
    this.stage.redraw();
  }

  /** @returns {boolean} whether there was something to take back */
  undo() {
    if (!this.place) return false;
    this.drop();
    return true;
  }

  /** @param {any} p */
  down(p) {
    if (!this.picture) return this.choose();
    this.pressed = true;
    this.put(p);
  }

  /** @param {any} p */
  move(p) { if (this.pressed && p.onObject) this.put(p); }

  up() {
    if (this.pressed) this.preview();
    this.pressed = false;
  }

  cancel() { this.pressed = false; }

  /** @param {number} factor */
  size(factor) {
    this.width = Math.max(0.02, Math.min(2, this.width * factor));
    this.stage.emit('options');
    this.locate();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.preview(), 250);
  }

  /** Corners of the decal, in pixels of the frame. @param {CameraJson} over */
  corners(over) { return cornersOf(over, over.fx * this.width * this.store.object.radius / over.width, this.stage.json()); }

  /** @param {CanvasRenderingContext2D} c */
  draw(c) {
    if (!this.over || !this.picture) return;
    const corners = this.corners(this.over), { width, height } = this.picture.bitmap;
    c.save();
    c.transform(...ontoCorners(corners, width, height));
    c.globalAlpha = 0.85;
    if (this.pressed || !this.stage.preview) c.drawImage(this.picture.bitmap, 0, 0);
    c.restore();
    dashed(c, polygon(corners));
  }
}

/** @param {ImageBitmap} bitmap @returns {Promise<Blob>} */
function pngOf(bitmap) {
  const canvas = document.createElement('canvas');
  canvas.width = bitmap.width;
  canvas.height = bitmap.height;
  canvas.getContext('2d')?.drawImage(bitmap, 0, 0);
  return new Promise((resolve) => canvas.toBlob((blob) => resolve(/** @type {Blob} */ (blob)), 'image/png'));
}

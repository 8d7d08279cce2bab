// SPDX-License-Identifier: Apache-2.0
// @ts-check
/**
 * Paint and erase. A stroke is drawn as dabs in the plane of the picture, and the program projects it onto the surface that the camera
 * sees. Strokes that follow each other quickly become one edit; until it is stored, each of them can be undone alone.
 */
import { cornersOf, ontoCorners, seen } from './camera.js';
import { complain, el, select, showValue, slider } from './dom.js';
import { postJson, upload } from './api.js';

const kIdle = 900;  // milliseconds after the last stroke until the strokes are stored

/** The brush; paint and eraser share it. size: pixels of the screen; other: the second color; pen: what its pressure changes. */
export const brush = { size: 26, hardness: 0.8, opacity: 1, color: '#d8342c', other: '#f2f2f2', target: 'albedo', material: '', pen: 'size' };

/** @typedef {{canvas: HTMLCanvasElement, opacity: number}} Stroke opacity: of the brush when it was drawn */

/** @param {number} width @param {number} height */
const blank = (width, height) => Object.assign(document.createElement('canvas'), { width, height });

export class PaintTool {
  /** @param {import('./stage.js').Stage} stage @param {import('./store.js').Store} store @param {boolean} erase */
  constructor(stage, store, erase) {
    this.stage = stage;
    this.store = store;
    this.erase = erase;
    this.name = erase ? 'erase' : 'paint';
    this.label = erase ? 'Erase' : 'Paint';
    this.hint = erase ? 'Drag on the object to restore its own color and material.'
      : 'Drag on the object. [ ] size, I takes a color, Shift and a click: a straight line. Beside the object, drag to turn it.';
    /** @type {{camera: any, canvas: HTMLCanvasElement, strokes: Stroke[]} | null} strokes that are not stored yet */
    this.pending = null;
    /** @type {{canvas: HTMLCanvasElement, camera: any, kept: boolean}[]} strokes that are being stored, or are stored (`kept`) and not in the picture yet */
    this.saving = [];
    /** @type {Stroke | null} that is being drawn */
    this.stroke = null;
    /** @type {any} the end of the stroke so far, or of the last one */
    this.last = null;
    /** @type {any} the pointer */
    this.at = null;
    this.timer = 0;
    this.picking = false;  // the next click takes a color
    stage.addEventListener('moved', () => { this.at = null; this.keep(); });
    stage.addEventListener('drawn', () => { this.saving = this.saving.filter((s) => !s.kept); });
    this.busy = 0;  // number of calls of keep() that store something
  }

  leave() { this.keep(); this.at = null; }

  options() {
    const row = (/** @type {string} */ label, /** @type {'size' | 'hardness' | 'opacity'} */ key, /** @type {number} */ min, /** @type {number} */ max) =>
      el('label', {}, label, slider(`brush-${key}`, [min, max], brush[key], (value) => { brush[key] = value; this.stage.redraw(); }));
    const sliders = [row('Size', 'size', 2, 160), row('Hardness', 'hardness', 0, 1)];
    if (this.erase) return sliders;
    return [
      el('label', {}, 'Color', el('input', { type: 'color', id: 'brush-color', value: brush.color, oninput: (/** @type {any} */ e) => this.setColor(e.target.value) })),
      el('button', { class: 'small', title: 'Swap the two colors (X)', onclick: () => this.swap() }, el('span', { class: 'swatch', id: 'other-color' }), ' Swap'),
      ...sliders, row('Opacity', 'opacity', 0.05, 1),
      el('button', { class: 'small', id: 'brush-pick', title: 'The next click takes the color there (I: at once)', 'aria-pressed': String(this.picking), onclick: () => { this.picking = !this.picking; this.stage.emit('options'); } }, 'Take color'),
      el('label', {}, 'Pen', select({ id: 'brush-pen', title: 'What the pressure of a pen changes' },
        [['size', 'size'], ['opacity', 'opacity'], ['both', 'both'], ['none', 'nothing']], brush.pen, (pen) => { brush.pen = pen; })),
      el('label', {}, 'As', select({ id: 'brush-target' }, [['albedo', 'its own color'], ['appearance', 'seen color'], ['radiance', 'glow']], brush.target,
        (target) => { this.keep(); brush.target = target; })),
      el('label', {}, 'Material', select({ id: 'brush-material' }, [['', 'as it is'], ...(this.store.object?.presets ?? []).map((name) => [name, name])], brush.material,
        (material) => { this.keep(); brush.material = material; })),
    ];
  }

  enter() {
    const other = document.getElementById('other-color');
    if (other) other.style.background = brush.other;
  }

  /** @param {string} color */
  setColor(color) {
    if (this.pending) this.keep();
    brush.color = color;
    showValue('brush-color', color);
    this.stage.redraw();
  }

  swap() {
    const color = brush.color;
    this.setColor(brush.other);
    brush.other = color;
    this.enter();
  }

  /** Takes the albedo under the pointer as the color of the brush. @param {any} [at] */
  async pickColor(at = this.at) {
    if (!at) return;
    try {
      const point = await postJson('pick', { camera: this.stage.json(), pixel: [at.x, at.y] });
      if (point) this.setColor(point.albedo);
    } catch (error) { complain(error); }
  }

  /** @param {any} p */
  hover(p) {
    this.at = p;
    this.stage.redraw();
  }

  /** @param {any} p */
  down(p) {
    if (this.picking) {
      this.picking = false;
      this.stage.emit('options');
      return this.pickColor(p);
    }
    clearTimeout(this.timer);
    const from = p.shift && this.last ? this.last : p;
    this.stroke = { canvas: blank(this.stage.picture.width, this.stage.picture.height), opacity: this.erase ? 1 : brush.opacity };
    this.left = 0;
    this.last = from;
    this.dab(p);
    this.move(p);
  }

  /** @param {any} p */
  move(p) {
    this.at = p;
    if (!this.stroke || !this.last) return;
    const radius = this.radius(p), step = Math.max(0.5, radius * 0.18);
    const dx = p.x - this.last.x, dy = p.y - this.last.y, d = Math.hypot(dx, dy);
    for (let at = step; at <= d; at += step) this.dab({ ...p, x: this.last.x + dx * at / d, y: this.last.y + dy * at / d });
    if (d >= step || d === 0) this.last = p;
    this.stage.redraw();
  }

  /** Of the brush, in pixels of the frame. @param {any} p */
  radius(p) { return Math.max(0.5, brush.size * this.stage.size().scale * (['size', 'both'].includes(brush.pen) ? 0.35 + 0.65 * p.pressure : 1)); }

  color() { return this.erase ? '#ffffff' : brush.color; }

  /** @param {any} p */
  dab(p) {
    const c = /** @type {CanvasRenderingContext2D} */ (this.stroke?.canvas.getContext('2d')), r = this.radius(p);
    const color = this.color();
    if (brush.hardness >= 0.98) c.fillStyle = color;
    else {
      const g = c.createRadialGradient(p.x, p.y, r * brush.hardness, p.x, p.y, r);
      g.addColorStop(0, color);
      g.addColorStop(1, `${color}00`);
      c.fillStyle = g;
    }
    c.globalAlpha = ['opacity', 'both'].includes(brush.pen) ? p.pressure : 1;
    c.beginPath();
    c.arc(p.x, p.y, r, 0, 2 * Math.PI);
    c.fill();
  }

  cancel() {
    this.stroke = null;
    this.stage.redraw();
  }

  up() {
    if (!this.stroke) return;
    const { width, height } = this.stroke.canvas;
    this.pending ??= { camera: this.stage.json(), canvas: blank(width, height), strokes: [] };
    this.pending.strokes.push(this.stroke);
    this.stroke = null;
    this.flatten();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.keep(), kIdle);
    this.store.emit('saving');
  }

  /** Draws all strokes that are not stored, which have one color, into one picture. */
  flatten() {
    const pending = this.pending, c = pending?.canvas.getContext('2d');
    if (!pending || !c) return;
    const { width, height } = pending.canvas;
    c.clearRect(0, 0, width, height);
    for (const { canvas, opacity } of pending.strokes) {
      c.globalAlpha = opacity;
      c.drawImage(canvas, 0, 0);
    }
    // Dabs over each other round their color again and again. Where it differs, the program takes it for a pattern.
    c.globalAlpha = 1;
    c.globalCompositeOperation = 'source-in';
    c.fillStyle = this.color();
    c.fillRect(0, 0, width, height);
    c.globalCompositeOperation = 'source-over';
    this.stage.redraw();
  }

  /** Removes the last stroke that is not stored. @returns {boolean} whether there was one */
  undo() {
    if (!this.pending) return false;
    clearTimeout(this.timer);
    this.pending.strokes.pop();
    if (this.pending.strokes.length === 0) this.pending = null;
    this.flatten();
    this.stage.redraw();
    if (this.pending) this.timer = window.setTimeout(() => this.keep(), kIdle);
    return true;
  }

  /** Stores the strokes as an edit. @returns {Promise<void>} */
  async keep() {
    clearTimeout(this.timer);
    const pending = this.pending;
    if (!pending) return;
    const { canvas, camera } = pending, saved = { canvas, camera, kept: false };
    const forget = () => { this.saving = this.saving.filter((s) => s !== saved); };
    this.pending = null;
    this.saving.push(saved);
    const look = this.erase ? { erase: true } : { target: brush.target, ...(brush.material ? { material: brush.material } : {}) };
    ++this.busy;
    try {
      const png = await new Promise((resolve) => canvas.toBlob(resolve, 'image/png'));
      const done = await this.store.change('edit', async () => (
        { op: 'paint', params: { strokes: [{ camera, scribble: await upload(png, 'scribble.png') }], ...look } }));
      saved.kept = true;
      if (!done) forget();
    } catch (error) {
      forget();
      complain(error);
    } finally {
      --this.busy;
      this.stage.redraw();
    }
  }

  unsaved() { return this.pending !== null || this.stroke !== null || this.busy > 0; }

  /**
   * Draws strokes that are being stored. While the camera moves they are shown as if they lay in a plane before the middle of the object,
   * parallel to the picture in which they were drawn.
   * @param {CanvasRenderingContext2D} c @param {HTMLCanvasElement} canvas @param {import('./camera.js').CameraJson} camera
   */
  drawSaved(c, canvas, camera) {
    const { center, radius } = this.store.object, { width, height } = canvas;
    const corners = cornersOf(camera, Math.max(seen(camera, center).depth - radius / 2, radius / 20), this.stage.json());
    const map = ontoCorners(corners, width, height), behind = map[0] * map[3] <= map[1] * map[2] || corners.some((p) => p.depth <= 0);
    if (behind) return;
    c.save();
    c.transform(...map);
    c.drawImage(canvas, 0, 0);
    c.restore();
  }

  /** @param {CanvasRenderingContext2D} c */
  draw(c) {
    c.save();
    for (const { canvas, camera } of this.saving) this.drawSaved(c, canvas, camera);
    if (this.pending) c.drawImage(this.pending.canvas, 0, 0);
    if (this.stroke) {
      c.globalAlpha = this.erase ? 0.6 : this.stroke.opacity;
      c.drawImage(this.stroke.canvas, 0, 0);
    }
    // Hides strokes beside the object, which cannot be painted.
    if (this.stage.picture.style.opacity !== '0') {
      c.globalAlpha = 1;
      c.globalCompositeOperation = 'destination-in';
      c.drawImage(this.stage.picture, 0, 0);
    }
    c.restore();
    if (this.at) ring(c, this.at.x, this.at.y, this.radius(this.at));
  }

  /** @param {number} factor */
  size(factor) { this.set('size', Math.max(2, Math.min(160, brush.size * factor))); }
  /** @param {number} step */
  hardness(step) { this.set('hardness', Math.max(0, Math.min(1, brush.hardness + step))); }

  /** @param {number} share */
  opacity(share) { if (!this.erase) this.set('opacity', share); }

  /** @param {'size' | 'hardness' | 'opacity'} key @param {number} value */
  set(key, value) {
    brush[key] = value;
    showValue(`brush-${key}`, value);
    this.stage.redraw();
  }
}

/** A circle that can be seen on any background. @param {CanvasRenderingContext2D} c @param {number} x @param {number} y @param {number} r */
export function ring(c, x, y, r) {
  for (const [color, width] of /** @type {[string, number][]} */ ([['#000a', 3], ['#fff', 1.25]])) {
    c.strokeStyle = color;
    c.lineWidth = width;
    c.beginPath();
    c.arc(x, y, r, 0, 2 * Math.PI);
    c.stroke();
  }
}

/** @param {{x: number, y: number}[]} points */
export function polygon(points) {
  const path = new Path2D();
  for (const { x, y } of points) path.lineTo(x, y);
  path.closePath();
  return path;
}

/** A dashed outline that can be seen on any background. @param {CanvasRenderingContext2D} c @param {Path2D} path */
export function dashed(c, path) {
  for (const [color, dash] of /** @type {[string, number[]][]} */ ([['#000', []], ['#fff', [6, 6]]])) {
    c.strokeStyle = color;
    c.lineWidth = 1.5;
    c.setLineDash(dash);
    c.stroke(path);
  }
  c.setLineDash([]);
}

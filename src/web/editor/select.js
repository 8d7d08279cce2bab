// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Selects parts by clicks or with a lasso; and the overlay that shows a part. */
import { complain, el, select, showValue, toast } from './dom.js';
import { postForBlob, postJson, upload } from './api.js';
import { Newest } from './newest.js';
import { dashed, polygon, ring } from './paint.js';

/** Colors of parts, by their place in the list. Parts can also be told apart by names and outlines. */
export const partColors = ['#ffb454', '#6ea8ff', '#6fd08c', '#e58cff', '#ff8080', '#5fd7d7', '#d7c75f', '#b0a0ff'];

/** A mask in a color, with a rim. @param {Blob} png gray @param {string} color @returns {Promise<HTMLCanvasElement>} */
async function tinted(png, color) {
  const picture = await createImageBitmap(png);
  const canvas = document.createElement('canvas');
  canvas.width = picture.width;
  canvas.height = picture.height;
  const c = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  c.drawImage(picture, 0, 0);
  const image = c.getImageData(0, 0, canvas.width, canvas.height), d = image.data, w = canvas.width;
  const [r, g, b] = [1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16));
  const inside = new Uint8Array(d.length / 4);
  for (let i = 0; i < inside.length; ++i) inside[i] = d[4 * i] > 127 ? 1 : 0;
  for (let i = 0; i < inside.length; ++i) {
    const rim = inside[i] && !(inside[i - 1] && inside[i + 1] && inside[i - w] && inside[i + w] && inside[i - 2 * w] && inside[i + 2 * w]);
    d.set([r, g, b, inside[i] ? (rim ? 255 : 92) : 0], 4 * i);
  }
  c.putImageData(image, 0, 0);
  return canvas;
}

/** Shows the selected part, or the one that is previewed, above the picture. */
export class PartOverlay {
  /** @param {import('./stage.js').Stage} stage @param {import('./store.js').Store} store */
  constructor(stage, store) {
    this.stage = stage;
    this.store = store;
    /** @type {HTMLCanvasElement | null} */
    this.mask = null;
    this.asked = 0;  // number of the last request
    /** @type {string | null} of the preview that is shown */
    this.token = null;
    stage.addEventListener('moved', () => {
      this.mask = null;
      ++this.asked;  // a mask that is on its way is one for the previous camera
    });
    stage.addEventListener('exact', () => { if (!this.mask) this.refresh(); });
    store.on('part', () => this.refresh());
    store.on('revision', () => this.refresh());
  }

  /** Shows a preview, or the selected part. @param {string | null} token of the preview */
  show(token) {
    this.token = token;
    return this.refresh();
  }

  async refresh() {
    const asked = ++this.asked, part = this.store.part;
    if (!this.token && !part) {
      this.mask = null;
      this.stage.redraw();
      return;
    }
    const index = this.store.state.parts.findIndex((p) => p.name === part);
    const color = partColors[Math.max(0, this.token ? this.store.state.parts.length : index) % partColors.length];
    try {
      const what = this.token ? { token: this.token } : { part };
      const mask = await tinted(await postForBlob('mask', { camera: this.stage.json(), ...what }), color);
      if (asked === this.asked) this.mask = mask;
    } catch (error) {
      if (asked === this.asked) this.mask = null;
    }
    this.stage.redraw();
  }

  /** @param {CanvasRenderingContext2D} c */
  draw(c) { if (this.mask) c.drawImage(this.mask, 0, 0, c.canvas.width, c.canvas.height); }
}

export class PartTool {
  /** @param {import('./stage.js').Stage} stage @param {import('./store.js').Store} store @param {PartOverlay} overlay */
  constructor(stage, store, overlay) {
    this.stage = stage;
    this.store = store;
    this.overlay = overlay;
    this.name = 'part';
    this.label = 'Part';
    this.hint = 'Click on the part; with Alt or the right button, on what is not part of it. Or draw around it with the lasso. Enter keeps it, Esc discards it.';
    this.segmenter = 'grow';
    this.how = 'new';
    this.by = 'click';  // or 'lasso'
    this.through = false;  // a lasso selects hidden surface behind, too
    /** @type {{x: number, y: number}[]} the lasso's outline, complete or being drawn */
    this.outline = [];
    this.drawing = false;
    this.number = 0;  // of the selection; previews of an earlier one are ignored
    this.quick = true;  // preview first what the network finds in the view of the clicks alone
    this.previews = new Newest(() => this.previewNow());
    /** @type {{x: number, y: number, out: boolean}[]} */
    this.clicks = [];
    /** @type {any} camera of the clicks */
    this.camera = null;
    /** @type {string | null} of the preview of the selection; null: it is not made yet */
    this.token = null;
    this.previewed = '';  // what the preview was made of
    /** @type {any} */
    this.report = null;
    /** @type {any} */
    this.pressed = null;
    /** @type {any} */
    this.at = null;
    stage.addEventListener('moved', () => { if (this.clicks.length) this.camera ??= null; });
  }

  /** Whether a press is for this tool although it is beside the object: a lasso may begin there. */
  takes() { return this.by === 'lasso'; }

  clear() {
    this.clicks = [];
    this.outline = [];
    this.drawing = false;
    this.camera = null;
    this.token = null;
    ++this.number;
    this.overlay.show(null);
  }

  leave() { this.clear(); }

  /** Whether there is something to keep or discard. */
  tries() { return this.clicks.length > 0 || this.outline.length > 0; }

  options() {
    const selected = this.store.part;
    const modes = [['new', 'New part'], ...(selected ? [['add', `Add to ${selected}`], ['subtract', `Take from ${selected}`], ['intersect', `Cut with ${selected}`]] : [])];
    return [
      el('label', {}, 'By', select({ id: 'part-by' }, [['click', 'clicks'], ['lasso', 'lasso']], this.by, (by) => { this.by = by; this.drop(); this.stage.emit('options'); })),
      ...(this.by === 'lasso' ? [el('label', {}, el('input', { type: 'checkbox', id: 'part-through', checked: this.through,
        onchange: (/** @type {any} */ e) => { this.through = e.target.checked; this.preview(); } }), 'also hidden surface')] : []),
      el('label', {}, 'Makes', select({ id: 'part-how' }, modes, this.how, (how) => { this.how = how; this.preview(); })),
      ...(this.store.object?.segment && this.by === 'click' ? [el('label', {}, 'Found by', select({}, [['grow', 'color and creases'], ['sam', 'network']], this.segmenter,
        (segmenter) => { this.segmenter = segmenter; this.preview(); }))] : []),
      el('label', {}, 'Name', el('input', { type: 'text', id: 'part-name', placeholder: 'part', maxlength: '60', autocomplete: 'off' })),
      el('button', { class: 'primary of-trial', id: 'part-keep', onclick: () => this.keep() }, 'Keep'),
      el('button', { class: 'of-trial', onclick: () => this.drop() }, 'Discard'),
    ];
  }

  /** Shift, Ctrl or both choose how the selected part is changed. @param {any} p */
  chooseHow(p) {
    if (!this.store.part || !(p.shift || p.ctrl)) return;
    this.how = p.shift && p.ctrl ? 'intersect' : p.shift ? 'add' : 'subtract';
    showValue('part-how', this.how);
  }

  /** @param {any} p */
  down(p) {
    this.pressed = p;
    if (this.by !== 'lasso') return;
    this.clear();
    this.chooseHow(p);
    this.camera = this.stage.json();
    this.drawing = true;
    this.outline = [{ x: p.x, y: p.y }];
  }

  /** @param {any} p */
  move(p) {
    this.at = p;
    if (!this.drawing) return;
    this.outline.push({ x: p.x, y: p.y });
    this.stage.redraw();
  }

  /** @param {any} p */
  up(p) {
    if (this.by !== 'lasso') return this.click(this.pressed ?? p);
    this.drawing = false;
    if (this.outline.length < 8) return this.drop();
    this.preview();
  }

  cancel() { if (this.drawing) this.drop(); }

  /** The inside of the outline, white on black. @returns {Promise<Blob>} */
  maskPicture() {
    const { width, height } = this.stage.picture, canvas = document.createElement('canvas');
    Object.assign(canvas, { width, height });
    const c = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
    c.fillStyle = '#000';
    c.fillRect(0, 0, width, height);
    c.fillStyle = '#fff';
    c.fill(polygon(this.outline));
    return new Promise((resolve) => canvas.toBlob((blob) => resolve(/** @type {Blob} */ (blob)), 'image/png'));
  }

  /** @param {any} p */
  click(p) {
    if (!p.onObject || this.by === 'lasso') return;
    if (!this.clicks.length) this.chooseHow(p);
    if (!this.camera) this.camera = this.stage.json();
    else if (JSON.stringify(this.camera) !== JSON.stringify(this.stage.json())) {
      toast('All clicks must be in the view of the first one. Keep the part, then add to it from here.');
      return;
    }
    this.clicks.push({ x: p.x, y: p.y, out: p.alt });
    this.stage.redraw();
    this.preview();
  }

  /** @param {any} p */
  hover(p) { this.at = p; }

  undo() {
    if (this.outline.length) {
      this.drop();
      return true;
    }
    if (!this.clicks.length) return false;
    this.clicks.pop();
    if (this.clicks.length) this.preview();
    else this.clear();
    this.stage.redraw();
    return true;
  }

  /** Parameters of the edit that makes the part. @returns {Promise<any>} */
  async params() {
    const camera = this.camera, part = this.store.part, combine = this.how !== 'new' && part ? { [this.how]: part } : {};
    const of = (/** @type {boolean} */ out) => this.clicks.filter((c) => c.out === out).map((c) => [c.x, c.y]);
    const name = /** @type {HTMLInputElement | null} */ (document.getElementById('part-name'))?.value.trim() ?? '';
    const what = this.outline.length ? { mask: await upload(await this.maskPicture(), 'mask.png'), in_view: !this.through }
      : { positive: of(false), negative: of(true), segmenter: this.segmenter };
    return { camera, ...what, ...combine, ...(name ? { name } : {}) };
  }

  /** @param {boolean} [quick] */
  preview(quick = true) {
    this.quick = quick;
    this.token = null;
    return this.previews.run();
  }

  async previewNow() {
    if (!this.outline.length && !this.clicks.some((c) => !c.out)) return;
    const number = this.number, late = () => number !== this.number || this.previews.again;
    const ask = (/** @type {any} */ params) => postJson('preview', { op: 'part', params });
    try {
      const params = await this.params(), what = this.key(params);
      if (this.quick && params.segmenter === 'sam') {
        const seen = await ask({ ...params, views: 1 });
        if (late()) return;
        this.overlay.show(seen.token);
      }
      const made = await ask(params);
      if (late()) return;
      this.token = made.token;
      this.previewed = what;
      this.report = made.report;
      await this.overlay.show(made.token);
      toast(`${made.part}: ${(100 * made.report.share).toFixed(1)} % of the surface. Enter keeps it.`);
    } catch (error) { if (!late()) complain(error); }
  }

  /** Two previews with the same key are of the same edit. @param {any} params */
  key(params) { return JSON.stringify([params, this.store.state.revision]); }

  async keep() {
    if (!this.clicks.length && !this.outline.length) return;
    const number = this.number;
    // The name may have changed since the preview; a mask is another upload each time.
    if (!this.token || this.outline.length || this.key(await this.params()) !== this.previewed) await this.preview(false);
    const token = number === this.number ? this.token : null;
    this.token = null;
    if (!token) return;
    const done = await this.store.change('commit', { token });
    if (!done) return;
    this.clear();
    this.store.select(done.part);
    toast(`Part ${done.part} is kept.`);
  }

  drop() {
    this.clear();
    this.stage.redraw();
  }

  /** @param {CanvasRenderingContext2D} c */
  draw(c) {
    if (this.outline.length && (this.drawing || !this.overlay.mask)) dashed(c, polygon(this.outline));
    for (const k of this.clicks) {
      const r = 8;
      ring(c, k.x, k.y, r);
      c.fillStyle = k.out ? '#c62828' : '#1b7f3b';
      c.beginPath();
      c.arc(k.x, k.y, r - 1, 0, 2 * Math.PI);
      c.fill();
      c.strokeStyle = '#fff';
      c.lineWidth = 2;
      c.beginPath();
      c.moveTo(k.x - 4, k.y); c.lineTo(k.x + 4, k.y);
      if (!k.out) { c.moveTo(k.x, k.y - 4); c.lineTo(k.x, k.y + 4); }
      c.stroke();
    }
  }
}

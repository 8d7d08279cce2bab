// SPDX-License-Identifier: Apache-2.0
// @ts-check
/**
 * The picture. At rest it is the program's own frame, in tiles, first with one sample a pixel and then with four.
 * While something moves it is drawn here, by WebGL 2; without that, by small frames of the program.
 */
import { Live } from './live.js';
import { ViewCamera } from './camera.js';
import { byId } from './dom.js';

/** @typedef {import('./camera.js').CameraJson} CameraJson */

const kRest = 140;  // milliseconds without movement until the exact frame is asked for
const kMaxSide = 1024;  // pixels of an exact frame
const kQuickSide = 288;
/** @type {[string, string][]} names of the program, and for people */
export const channels = [['rgb', 'Lit'], ['albedo', 'Albedo'], ['diffuse', 'Diffuse'], ['specular', 'Shine'], ['normal', 'Normals'], ['roughness', 'Roughness']];

export class Stage extends EventTarget {
  /** @param {import('./store.js').Store} store */
  constructor(store) {
    super();
    this.store = store;
    this.view = byId('view');
    /** @type {HTMLCanvasElement} */
    this.picture = byId('picture');
    /** @type {HTMLCanvasElement} */
    this.overlay = byId('overlay');
    this.live = new Live(byId('live'), store, () => this.liveReady());
    this.back = document.createElement('canvas');  // the frame that arrives
    /** @type {HTMLCanvasElement | null} the last exact frame, for what lies under the pointer */
    this.exact = null;
    this.camera = new ViewCamera({ width: 1, height: 1, fx: 1, fy: 1, cx: 0.5, cy: 0.5, skew: 0, world_from_cam: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], center: [0, 0, -1] }, [0, 0, 0], [0, 0, 1], 1);
    this.channel = 'rgb';
    /** @type {import('./light.js').Light} light that is looked under */
    this.light = { rotate: 0, scale: 1 };
    /** @type {string | null} token of the edit that is previewed */
    this.preview = null;
    this.pulling = false;  // the page shows a shape that the program does not know yet
    /** @type {string | null} view whose photograph the camera stands at */
    this.photo = null;
    this.seq = 0;
    /** @type {{seq: number, kind: 'quick' | 'rest', samples: number, stale: boolean} | null} */
    this.asked = null;
    this.timer = 0;
    this.waiting = 0;
    this.fresh = false;  // the page has not drawn the object yet
    /** @type {(context: CanvasRenderingContext2D) => void} */
    this.drawTool = () => {};
    store.line.on('tile', (tile) => this.takeTile(tile));
    store.line.on('frame', (frame) => this.finish(frame));
    store.line.on('error', () => { this.asked = null; });
    store.line.on('welcome', () => this.moved());
    store.on('revision', () => this.changed());
    store.on('mode', ({ mode }) => { if (mode === 'project') this.begin(); });
    new ResizeObserver(() => this.resized()).observe(this.view);
  }

  begin() {
    const o = this.store.object;
    this.camera = new ViewCamera(o.start.camera, o.center, o.up, o.radius);
    this.camera.frame(o.center, o.radius);
    this.camera.home = { lens: this.camera.json(o.start.camera.width, o.start.camera.height), target: o.center };
    this.light = { rotate: 0, scale: 1 };
    this.preview = null;
    this.pulling = false;
    this.photo = null;
    byId('cover').classList.remove('done');
    this.picture.getContext('2d')?.clearRect(0, 0, this.picture.width, this.picture.height);
    this.fresh = true;
    this.live.begin().catch(() => {});
    this.resized();
  }

  /** Pixels of the exact frame. */
  size() {
    const { clientWidth: w, clientHeight: h } = this.view;
    const scale = Math.min(window.devicePixelRatio || 1, 2, kMaxSide / Math.max(w, h, 1));
    return { width: Math.max(16, Math.round(w * scale)), height: Math.max(16, Math.round(h * scale)), scale };
  }

  /** The camera of the exact frame. @returns {CameraJson} */
  json() {
    const { width, height } = this.size();
    return this.camera.json(width, height);
  }

  resized() {
    const { width, height } = this.size();
    if (this.picture.width !== width || this.picture.height !== height) {
      for (const canvas of [this.picture, this.overlay]) {
        canvas.width = width;
        canvas.height = height;
      }
    }
    this.emit('resized');
    this.moved();
  }

  /** @param {string} type */
  emit(type) { this.dispatchEvent(new Event(type)); }

  isLive() { return this.live.shows(this.channel, this.light, this.preview, this.photo); }

  /** Shows all but some parts, which only the page's own picture can. @param {string[]} names */
  hide(names) {
    if (names.length === this.live.hidden.size && names.every((name) => this.live.hidden.has(name))) return;
    this.live.hidden = new Set(names);
    this.emit('hidden');
    this.moved();
  }

  /** The page can draw the object anew: below the exact frame, if there is one. */
  async liveReady() {
    this.emit('looks');
    const first = !byId('cover').classList.contains('done');
    if (!this.isLive() && !(first && this.live.unlit())) return;
    // A driver's first picture takes long where it draws in software; that of the program is on its way.
    if (this.fresh && this.isLive()) return;
    if (this.exact) return;  // it is under that
    await this.live.drawSoon(this.json(), this.channel, this.light);
    byId('cover').classList.add('done');
    if (!this.exact && (first || this.isLive())) this.picture.style.opacity = '0';  // it is of the object before
    this.liveDrawn();
    if (this.isLive() && (this.asked?.kind === 'quick' || (!this.asked && !this.exact))) this.moved();
  }

  /** The page has drawn, the object as it is now if it has all of that. */
  liveDrawn() {
    if (this.isLive()) this.emit('drawn');
    this.redraw();
  }

  /** Shows an edit that is not kept, or none. @param {string | null} token @param {boolean} [look] whether it changes nothing but the look */
  async tryEdit(token, look = false) {
    this.preview = token;
    this.pulling = false;
    if (!token) this.live.letGo();
    if (token && look) await this.live.preview(token).catch(() => false);
    else if (!token) await this.live.refresh().catch(() => {});
    this.moved();
  }

  /** Shows at once nearly how handles pull the surface; the program's own shape comes by tryEdit(). @param {import('./pull.js').Handle[]} handles @param {number} reach @returns {boolean} whether it can */
  pull(handles, reach) {
    if (!this.live.shows(this.channel, this.light, null, this.photo) || !this.live.pull(handles, reach, this.store.part)) return false;
    this.preview = null;
    this.pulling = true;
    this.moved();
    return true;
  }

  /** The camera or what it sees has changed. */
  moved() {
    if (this.store.state.mode !== 'project') return;
    this.emit('moved');
    this.exact = null;
    clearTimeout(this.timer);
    if (this.isLive()) {
      this.store.line.send({ type: 'rest' });
      this.asked = null;
      this.picture.style.opacity = '0';
      cancelAnimationFrame(this.waiting);
      this.fresh = false;
      this.waiting = requestAnimationFrame(() => {
        this.live.drawSoon(this.json(), this.channel, this.light);
        byId('cover').classList.add('done');
        this.liveDrawn();
      });
    } else {
      if (this.asked?.kind === 'quick') this.asked.stale = true;
      else this.ask('quick', 1);
      this.redraw();
    }
    this.timer = window.setTimeout(() => this.rest(), kRest);
    byId('badge').textContent = '';
  }

  /** The object has changed, seen by the same camera: the picture stays until the next one. */
  changed() {
    if (this.store.state.mode !== 'project') return;
    clearTimeout(this.timer);
    this.exact = null;
    this.pulling = false;
    const kept = [...this.live.hidden].filter((name) => this.store.state.parts.some((p) => p.name === name));
    if (kept.length < this.live.hidden.size) this.hide(kept);
    this.live.refresh().catch(() => {});
    this.asked = null;
    this.rest();
  }

  rest() {
    if (this.pulling) return;
    const own = this.live.hidden.size > 0 && this.live.renderer;
    if (this.isLive() && (own || !this.store.line.ready)) this.restLive(own ? 'some parts hidden' : '');
    if (own && (this.isLive() || !this.live.current())) return;
    if (this.asked?.kind === 'quick') {
      this.timer = window.setTimeout(() => this.rest(), kRest);  // that one first
      return;
    }
    this.ask('rest', 1);
  }

  /** The page's own picture, where no other comes. @param {string} badge */
  async restLive(badge) {
    const { timer } = this;
    cancelAnimationFrame(this.waiting);  // where frames come late, it would be drawn over this, more coarsely
    await this.live.drawSoon(this.json(), this.channel, this.light, true);
    byId('cover').classList.add('done');
    this.liveDrawn();
    if (timer === this.timer) byId('badge').textContent = badge;
  }

  /** @param {'quick' | 'rest'} kind @param {number} samples */
  ask(kind, samples) {
    if (!this.store.line.ready || this.store.state.mode !== 'project') return;
    let { width, height } = this.size();
    if (kind === 'quick') {
      const s = Math.min(1, kQuickSide / Math.max(width, height));
      width = Math.max(16, Math.round(width * s));
      height = Math.max(16, Math.round(height * s));
    }
    this.asked = { seq: ++this.seq, kind, samples, stale: false };
    this.back.width = width;
    this.back.height = height;
    this.store.line.send({
      type: 'view', seq: this.seq, camera: this.camera.json(width, height), samples, channel: this.channel,
      light: this.light, as_photographed: this.photo !== null, ...(this.preview ? { preview: this.preview } : {}), ...(this.store.line.far ? { packed: true } : {}),
    });
  }

  /** @param {import('./api.js').Tile} tile */
  takeTile(tile) {
    if (tile.seq !== this.asked?.seq) return;
    this.back.getContext('2d')?.putImageData(new ImageData(tile.pixels, tile.width, tile.height), tile.x, tile.y);
    if (this.asked.kind !== 'rest' || this.picture.style.opacity === '0') return;
    const context = this.picture.getContext('2d');
    context?.clearRect(tile.x, tile.y, tile.width, tile.height);
    context?.drawImage(this.back, tile.x, tile.y, tile.width, tile.height, tile.x, tile.y, tile.width, tile.height);
  }

  /** @param {import('./messages.js').FrameNews} frame */
  finish({ seq }) {
    const asked = this.asked;
    if (!asked || seq !== asked.seq) return;
    this.asked = null;
    const { width, height } = this.picture, context = this.picture.getContext('2d');
    context?.clearRect(0, 0, width, height);
    context?.drawImage(this.back, 0, 0, width, height);
    this.picture.style.opacity = '1';
    byId('cover').classList.add('done');
    this.emit('drawn');
    this.redraw();
    if (asked.kind === 'quick') {
      if (asked.stale) this.ask('quick', 1);
      return;
    }
    this.exact = this.back;
    this.back = document.createElement('canvas');
    byId('badge').textContent = asked.samples === 1 ? 'exact' : 'refined';
    this.emit('exact');
    if (asked.samples === 1) this.ask('rest', 2);
    else this.settle();
  }

  settle() {
    if (this.fresh && this.isLive()) this.live.drawSoon(this.json(), this.channel, this.light);  // so that it moves at once
    this.fresh = false;
    this.emit('settled');
  }

  /** Whether a picture is complete and nothing is under way. */
  settled() {
    const badge = byId('badge').textContent ?? '';
    return this.asked === null && (this.exact !== null ? badge.startsWith('refined') : badge === 'some parts hidden');
  }

  /** Whether the object is at a pixel of the frame. @param {number} x @param {number} y */
  onObject(x, y) {
    const { width, height } = this.picture;
    if (x < 0 || y < 0 || x >= width || y >= height) return false;
    if (this.isLive() && !this.exact) return this.live.onObject(this.json(), x, y);
    const pixel = this.picture.getContext('2d')?.getImageData(Math.floor(x), Math.floor(y), 1, 1).data;
    return (pixel?.[3] ?? 0) > 127;
  }

  redraw() {
    const context = this.overlay.getContext('2d');
    if (!context) return;
    context.clearRect(0, 0, this.overlay.width, this.overlay.height);
    this.drawTool(context);
  }

  /** What is seen of the object and the photograph, on white, as a PNG. @returns {Promise<Blob | null>} */
  snapshot() {
    const { width, height } = this.picture, copy = document.createElement('canvas');
    Object.assign(copy, { width, height });
    const c = /** @type {CanvasRenderingContext2D} */ (copy.getContext('2d'));
    c.fillStyle = '#fff';
    c.fillRect(0, 0, width, height);
    const own = this.picture.style.opacity === '0';
    if (own) this.live.draw(this.json(), this.channel, this.light);  // a canvas of WebGL can be read only right after that
    c.drawImage(own ? this.live.canvas : this.picture, 0, 0, width, height);
    this.drawPhoto(c);
    return new Promise((resolve) => copy.toBlob(resolve, 'image/png'));
  }

  /** The photograph as far as it is seen. @param {CanvasRenderingContext2D} c */
  drawPhoto(c) {
    const photo = byId('photo'), wipe = byId('wipe'), r = this.camera.rectangle(c.canvas.width, c.canvas.height);
    if (photo.hidden) return;
    c.beginPath();
    c.rect(r.x, r.y, r.width * (wipe.hidden ? 1 : wipe.value / 100), r.height);
    c.clip();
    c.drawImage(photo, r.x, r.y, r.width, r.height);
  }
}

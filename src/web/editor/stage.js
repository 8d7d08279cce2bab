// SPDX-License-Identifier: Apache-2.0
// @ts-check
/**
 * The picture of the object. At rest it is the exact frame, which the program computes and sends in tiles, first with one sample a pixel
 * and then with four. While something moves, the page draws the picture by WebGL 2 (live.js); without WebGL 2 the program sends small frames.
 */
import { Live } from './live.js';
import { ViewCamera } from './camera.js';
import { byId } from './dom.js';

/** @typedef {import('./camera.js').CameraJson} CameraJson */

const kRest = 140;  // milliseconds without movement until the exact frame is asked for
const kMaxSide = 1024;  // pixels of an exact frame
const kQuickSide = 288;  // pixels of the program's frames while something moves
/** @type {[string, string][]} names of the channels in requests, and in the page */
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
    this.back = document.createElement('canvas');  // the frame that is arriving
    /** @type {HTMLCanvasElement | null} the exact frame that is shown; null: another picture is */
    this.exact = null;
    this.camera = new ViewCamera({ width: 1, height: 1, fx: 1, fy: 1, cx: 0.5, cy: 0.5, skew: 0, world_from_cam: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], center: [0, 0, -1] }, [0, 0, 0], [0, 0, 1], 1);
    this.channel = 'rgb';
    /** @type {import('./light.js').Light} light that the picture shows */
    this.light = { rotate: 0, scale: 1 };
    /** @type {string | null} token of the edit that is previewed */
    this.preview = null;
    this.pulling = false;  // handles pull the surface, and the program has not made that shape yet
    /** @type {string | null} view from whose camera the object is seen; null: from another place */
    this.photo = null;
    this.seq = 0;  // number of the last frame that was asked for
    /** @type {{seq: number, kind: 'quick' | 'rest', samples: number, stale: boolean} | null} the frame that is awaited; stale: another one is needed after it */
    this.asked = null;
    this.timer = 0;  // of rest()
    this.waiting = 0;  // animation frame that draws the next picture
    this.fresh = false;  // the page has not drawn this object yet
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

  /** Another object is open. */
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

  /** Hides parts. Only the page's own picture can hide them, so it stays instead of the exact frame. @param {string[]} names of all hidden parts */
  hide(names) {
    if (names.length === this.live.hidden.size && names.every((name) => this.live.hidden.has(name))) return;
    this.live.hidden = new Set(names);
    this.emit('hidden');
    this.moved();
  }

  /** The page can draw a new picture, see Live. */
  async liveReady() {
    this.emit('looks');
    const first = !byId('cover').classList.contains('done');
    if (!this.isLive() && !(first && this.live.unlit())) return;
    // The first picture of a driver that draws in software takes long. The program's frame arrives earlier.
    if (this.fresh && this.isLive()) return;
    if (this.exact) return;  // the exact frame covers the page's picture
    await this.live.drawSoon(this.json(), this.channel, this.light);
    byId('cover').classList.add('done');
    if (!this.exact && (first || this.isLive())) this.picture.style.opacity = '0';  // it still shows the previous object
    this.liveDrawn();
    if (this.isLive() && (this.asked?.kind === 'quick' || (!this.asked && !this.exact))) this.moved();
  }

  /** The page has drawn a picture: 'drawn' if it is complete. */
  liveDrawn() {
    if (this.isLive()) this.emit('drawn');
    this.redraw();
  }

  /** Previews an edit, or none. @param {string | null} token of the preview @param {boolean} [look] whether it changes only color and material */
  async tryEdit(token, look = false) {
    this.preview = token;
    this.pulling = false;
    if (!token) this.live.letGo();
    if (token && look) await this.live.preview(token).catch(() => false);
    else if (!token) await this.live.refresh().catch(() => {});
    this.moved();
  }

  /** Shows at once approximately how handles pull the surface; the program's shape follows by tryEdit(). @param {import('./pull.js').Handle[]} handles @param {number} reach @returns {boolean} whether it can */
  pull(handles, reach) {
    if (!this.live.shows(this.channel, this.light, null, this.photo) || !this.live.pull(handles, reach, this.store.part)) return false;
    this.preview = null;
    this.pulling = true;
    this.moved();
    return true;
  }

  /** The camera, the light, the channel or the preview has changed. */
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

  /** The object was edited. The present picture stays until the next one arrives. */
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

  /** Nothing moves any more: shows the exact frame, or what stands for it. */
  rest() {
    if (this.pulling) return;
    const own = this.live.hidden.size > 0 && this.live.renderer;
    if (this.isLive() && (own || !this.store.line.ready)) this.restLive(own ? 'some parts hidden' : '');
    if (own && (this.isLive() || !this.live.current())) return;
    if (this.asked?.kind === 'quick') {
      this.timer = window.setTimeout(() => this.rest(), kRest);  // after the quick frame
      return;
    }
    this.ask('rest', 1);
  }

  /** Shows the page's own picture at its best, where no exact frame will replace it. @param {string} badge text */
  async restLive(badge) {
    const { timer } = this;
    cancelAnimationFrame(this.waiting);  // else, if it came late, it would replace this picture by a coarser one
    await this.live.drawSoon(this.json(), this.channel, this.light, true);
    byId('cover').classList.add('done');
    this.liveDrawn();
    if (timer === this.timer) byId('badge').textContent = badge;
  }

  /** Asks the program for a frame. @param {'quick' | 'rest'} kind @param {number} samples per pixel and axis */
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
      light: this.light, as_photographed: this.photo !== null, ...(this.preview ? { preview: this.preview } : {}), ...(this.store.line.slow ? { packed: true } : {}),
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

  /** The picture is refined. */
  settle() {
    if (this.fresh && this.isLive()) this.live.drawSoon(this.json(), this.channel, this.light);  // so that the next movement is shown at once
    this.fresh = false;
    this.emit('settled');
  }

  /** Whether the picture is refined and no frame is awaited. */
  settled() {
    const badge = byId('badge').textContent ?? '';
    return this.asked === null && (this.exact !== null ? badge.startsWith('refined') : badge === 'some parts hidden');
  }

  /** Whether a pixel of the frame shows the object. @param {number} x @param {number} y */
  onObject(x, y) {
    const { width, height } = this.picture;
    if (x < 0 || y < 0 || x >= width || y >= height) return false;
    if (this.isLive() && !this.exact) return this.live.onObject(this.json(), x, y);
    const pixel = this.picture.getContext('2d')?.getImageData(Math.floor(x), Math.floor(y), 1, 1).data;
    return (pixel?.[3] ?? 0) > 127;
  }

  /** Draws what the tool shows over the picture. */
  redraw() {
    const context = this.overlay.getContext('2d');
    if (!context) return;
    context.clearRect(0, 0, this.overlay.width, this.overlay.height);
    this.drawTool(context);
  }

  /** The object and the photograph as they are shown, on white, as a PNG. @returns {Promise<Blob | null>} */
  snapshot() {
    const { width, height } = this.picture, copy = document.createElement('canvas');
    Object.assign(copy, { width, height });
    const c = /** @type {CanvasRenderingContext2D} */ (copy.getContext('2d'));
    c.fillStyle = '#fff';
    c.fillRect(0, 0, width, height);
    const own = this.picture.style.opacity === '0';
    if (own) this.live.draw(this.json(), this.channel, this.light);  // a canvas of WebGL can be read only right after it was drawn
    c.drawImage(own ? this.live.canvas : this.picture, 0, 0, width, height);
    this.drawPhoto(c);
    return new Promise((resolve) => copy.toBlob(resolve, 'image/png'));
  }

  /** Draws the part of the photograph that is shown. @param {CanvasRenderingContext2D} c */
  drawPhoto(c) {
    const photo = byId('photo'), wipe = byId('wipe'), r = this.camera.rectangle(c.canvas.width, c.canvas.height);
    if (photo.hidden) return;
    c.beginPath();
    c.rect(r.x, r.y, r.width * (wipe.hidden ? 1 : wipe.value / 100), r.height);
    c.clip();
    c.drawImage(photo, r.x, r.y, r.width, r.height);
  }
}

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** The object drawn in the page, with the program's own shading. Without WebGL 2 it shows nothing, and the program's frames do. */
import { getBytes } from './api.js';

/** @type {Record<string, string>} channels of the program that the renderer knows */
const kChannels = { rgb: 'lit', albedo: 'albedo', normal: 'normal', roughness: 'roughness' };
const kKinds = ['tables', 'shape', 'look', 'light', 'vertex_light'];

export class Live {
  /** @param {HTMLCanvasElement} canvas @param {import('./store.js').Store} store @param {() => void} ready called when there is something new to draw */
  constructor(canvas, store, ready) {
    this.canvas = canvas;
    this.store = store;
    this.ready = ready;
    /** @type {any} */
    this.renderer = null;
    /** @type {any} */
    this.modules = null;
    /** @type {Record<string, string>} keys of what the renderer has */
    this.have = {};
    /** @type {string | null} the preview whose look the renderer has */
    this.previewed = null;
    this.off = new URLSearchParams(location.search).has('frames');  // for tests: only the program's frames
  }

  async begin() {
    this.have = {};
    this.previewed = null;
    if (this.off) return;
    try {
      this.modules ??= await Promise.all([import('../renderer.js'), import('../pack.js'), import('../camera.js')]);
      this.renderer ??= new this.modules[0].Renderer(this.canvas);
    } catch {
      this.renderer = null;
      return;
    }
    await this.refresh();
  }

  /** Fetches what has changed. @returns {Promise<void>} */
  async refresh() {
    const keys = this.store.state.packs;
    if (!this.renderer || !keys) return;
    let changed = false;
    if (this.previewed) delete this.have.look;
    this.previewed = null;
    for (const kind of kKinds) {
      if (this.have[kind] === keys[kind]) continue;
      const bytes = await getBytes(`/api/pack/${kind}?key=${keys[kind]}`);
      if (keys !== this.store.state.packs) return this.refresh();
      this.set(kind, bytes);
      this.have[kind] = keys[kind];
      changed = true;
    }
    if (changed) this.ready();
  }

  /** @param {string} kind @param {ArrayBuffer} bytes */
  set(kind, bytes) { this.renderer.set(this.modules[1].readPack(bytes, kind)); }

  /** Shows an edit of the look that is not kept. @param {string} token @returns {Promise<boolean>} whether it can */
  async preview(token) {
    if (!this.current()) return false;
    const bytes = await getBytes(`/api/pack/look?preview=${token}`);
    this.set('look', bytes);
    this.previewed = token;
    return true;
  }

  current() {
    const keys = this.store.state.packs;
    return Boolean(this.renderer?.complete && keys && kKinds.every((kind) => this.have[kind] === keys[kind]));
  }

  /** @param {string} channel @param {{scale: number, env?: string}} light @param {string | null} preview @param {string | null} photo */
  shows(channel, light, preview, photo) {
    const still = photo === null || this.store.object?.material?.light?.motion === 'world';
    return channel in kChannels && light.scale === 1 && !light.env && preview === this.previewed && still && this.current();
  }

  /** @param {any} camera @param {string} channel @param {{rotate: number}} light */
  draw(camera, channel, light) {
    const turn = this.modules[2].rotation(this.store.object.up, -light.rotate * Math.PI / 180);
    this.renderer.draw({ camera, channel: kChannels[channel], room_from_object: turn, samples: 1, highlight: 0 });
  }

  /** Whether the object is at a pixel. @param {any} camera @param {number} x @param {number} y */
  onObject(camera, x, y) { return this.renderer?.partAt(camera, x, y) >= 0; }
}

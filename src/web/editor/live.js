// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Draws the object in the page, by the same shading as the program's. Without WebGL 2 it draws nothing, and the stage shows the program's frames only. */
import { getBytes, postJson } from './api.js';
import { partBall, partLooks } from './looks.js';
import { Pace, steps } from './pace.js';
import { takePack } from './start.js';

/** @typedef {import('./light.js').Light} Light */
/** @typedef {import('../pack.js').Pack} Pack */
/** @typedef {import('./pull.js').Pull} Pull */
/** @typedef {import('./sun.js').Sky} Sky */

/** @type {Record<string, string>} channels of the program that the renderer knows */
const kChannels = { rgb: 'lit', albedo: 'albedo', normal: 'normal', roughness: 'roughness' };
const kLate = 1200;  // milliseconds after which the surface is shown without light, if the light is not there
const kCoarse = 'coarse';  // pack of fewer triangles for quick pictures; fetched last, and only where pictures take long
const kLit = ['light', 'vertex_light'], kSurface = ['shape', 'look'], kLight = ['tables', ...kLit];

export class Live {
  /** @param {HTMLCanvasElement} canvas @param {import('./store.js').Store} store @param {() => void} ready called when a new picture can be drawn */
  constructor(canvas, store, ready) {
    this.canvas = canvas;
    this.store = store;
    this.ready = ready;
    /** @type {any} */
    this.renderer = null;
    /** @type {any} */
    this.modules = null;
    /** @type {Record<string, string>} keys of the packs that the renderer has, by kind */
    this.have = {};
    /** @type {Set<string>} names of parts that are not shown */
    this.hidden = new Set();
    /** @type {Record<string, Pack>} the light of the object and how it arrives at the vertices, by kind */
    this.own = {};
    /** @type {{env: string, light?: Pack, vertex_light?: Pack} | null} the same for an environment that is previewed */
    this.other = null;
    /** @type {Pack | null} tables of what a sun adds to a light */
    this.sun = null;
    this.sunAsked = false;
    /** @type {{sky: Sky, of: Pack[]} | null} the light that a sun was last added to */
    this.sky = null;
    /** @type {{of: Pack[], sun: string}} the packs and the sun of the light that the renderer has */
    this.lit = { of: [], sun: '' };
    /** @type {typeof import('./sun.js') | null} loaded when the light tool is first chosen */
    this.suns = null;
    /** @type {Pull | null} for the shape that was last pulled */
    this.puller = null;
    /** @type {typeof import('./pull.js') | null} loaded when a shape is first pulled */
    this.pulls = null;
    this.pulled = false;  // the renderer shows a shape that handles pull
    /** @type {Record<string, Pack>} the packs in kSurface, which hold the surface and its parts, by kind */
    this.surface = {};
    /** @type {Map<string, import('./looks.js').Look>} color and material of parts, by name */
    this.looks = new Map();
    /** @type {string | null} token of the preview whose look the renderer has */
    this.previewed = null;
    /** @type {{keys: Record<string, string>, packs: Map<string, Promise<ArrayBuffer>>} | null} packs that were asked for before the renderer was ready */
    this.ahead = null;
    /** @type {Map<string, {key: string, bytes: Promise<ArrayBuffer>}>} packs that are being fetched, by kind */
    this.underway = new Map();
    this.pace = new Pace(false);
    /** @type {{draw: () => void, rest: boolean} | null} the picture that is drawn next */
    this.next = null;
    /** @type {Promise<void> | null} done when the picture that is being drawn, and all after it, are drawn */
    this.drawing = null;
    this.off = new URLSearchParams(location.search).has('frames');  // for tests: only the program's frames
    this.prepared = this.off ? Promise.resolve() : this.prepare();  // at once, because it takes a while
  }

  /** Another object is open. */
  async begin() {
    this.have = {};
    this.surface = {};
    this.own = {};
    this.other = null;
    this.sky = null;
    this.puller = null;
    this.pulled = false;
    this.lit = { of: [], sun: '' };
    this.previewed = null;
    this.hidden.clear();
    if (this.off) return;
    this.ahead = { keys: this.store.state.packs, packs: this.fetchMissing() };
    await this.prepared;
    this.renderer?.clear();
    await this.refresh();
  }

  async prepare() {
    try {
      this.modules = await Promise.all([import('../renderer.js'), import('../pack.js'), import('../camera.js')]);
      this.renderer = new this.modules[0].Renderer(this.canvas);
      this.pace = new Pace(this.renderer.software);
    } catch { /* there is no WebGL 2 */ }
  }

  /** Fetches all packs that have changed. Shows them together; but a new object is shown without light first if its light is late. @returns {Promise<void>} */
  async refresh() {
    /** @type {Record<string, string>} */
    const keys = this.store.state.packs;
    if (!this.renderer || !keys) return;
    if (this.previewed) delete this.have.look;
    this.previewed = null;
    const packs = this.ahead?.keys === keys ? this.ahead.packs : this.fetchMissing(), missing = [...packs.keys()];
    this.ahead = null;
    const late = !this.renderer.complete && await Promise.race([Promise.all(packs.values()).then(() => false), new Promise((resolve) => setTimeout(() => resolve(true), kLate))]);
    const steps = late ? [kSurface, kLight].map((kinds) => kinds.filter((kind) => packs.has(kind))) : [missing];
    for (const kinds of steps) {
      const bytes = await Promise.all(kinds.map((kind) => packs.get(kind)));
      if (keys !== this.store.state.packs) return this.refresh();
      kinds.forEach((kind, i) => this.set(kind, /** @type {ArrayBuffer} */ (bytes[i]), keys[kind]));
      if (kinds.length) this.ready();
    }
    this.refreshCoarse();
  }

  /** Fetches the coarse triangles if pictures take so long that they are needed. */
  async refreshCoarse() {
    const key = this.store.state.packs?.[kCoarse];
    if (!key || !this.pace.step.coarse || this.have[kCoarse] === key || !this.has(['shape'])) return;
    const bytes = await this.fetchPack(kCoarse, key).catch(() => null);  // without them all triangles are drawn
    if (bytes && this.store.state.packs?.[kCoarse] === key && this.has(['shape'])) this.set(kCoarse, bytes, key);
  }

  /** Starts to fetch packs that have changed. @returns {Map<string, Promise<ArrayBuffer>>} by kind */
  fetchMissing() {
    /** @type {Record<string, string>} */
    const keys = this.store.state.packs ?? {};
    return new Map(Object.keys(keys).filter((kind) => kind !== kCoarse && this.have[kind] !== keys[kind]).map((kind) => [kind, this.fetchPack(kind, keys[kind])]));
  }

  /** @param {string} kind @param {string} key */
  fetchPack(kind, key) {
    const before = this.underway.get(kind);
    if (before?.key === key) return before.bytes;
    const bytes = takePack(kind, key) ?? getBytes(`/api/pack/${kind}?key=${key}${this.packed()}`);
    bytes.catch(() => this.underway.delete(kind));  // refresh() handles the error
    this.underway.set(kind, { key, bytes });
    return bytes;
  }

  packed() { return this.store.line.slow ? '&packed=1' : ''; }

  /** Gives a pack to the renderer. @param {string} kind @param {ArrayBuffer} bytes @param {string} key */
  set(kind, bytes, key) {
    const pack = this.modules[1].readPack(bytes, kind);
    this.renderer.set(pack);
    if (kLit.includes(kind)) {
      this.own[kind] = pack;
      this.lit = { of: [], sun: '' };
    }
    if (kSurface.includes(kind)) this.surface[kind] = pack;
    if (kind === 'look') this.looks = partLooks(pack);
    if (kind === 'shape') {
      delete this.have[kCoarse];
      this.sky = null;
      this.puller = null;
      this.pulled = false;
      if (this.other) this.prepareEnvironment(this.other.env);  // for the new vertices
    }
    this.have[kind] = key;
    this.underway.delete(kind);
  }

  /**
   * Draws the surface approximately as handles pull it, until letGo() or until the pack of another shape comes.
   * @param {import('./pull.js').Handle[]} handles @param {number} reach @param {string | null} part that alone may move; null: everything may
   * @returns {boolean} whether it can
   */
  pull(handles, reach, part) {
    const { shape, look } = this.surface;
    if (!this.current()) return false;
    if (!this.pulls) import('./pull.js').then((module) => { this.pulls = module; }, () => {});
    if (!this.pulls) return false;
    if (this.puller?.shape !== shape) this.puller = new this.pulls.Pull(shape);
    const index = look.head.parts.indexOf(part), { material } = look.arrays, may = part ? (/** @type {number} */ v) => material[4 * v + 3] === index : () => true;
    const { positions, normals, min, size } = this.puller.moved(handles, reach, part ?? '', may);
    this.place(positions, normals, { ...shape.head, min, size });
    this.pulled = true;
    return true;
  }

  /** Draws the surface without pull() again. */
  letGo() {
    const { shape } = this.surface;
    if (this.pulled && shape) this.place(shape.arrays.positions, shape.arrays.normals, shape.head);
    this.pulled = false;
  }

  /** Moves the vertices in the renderer. @param {import('../pack.js').Numbers} positions @param {import('../pack.js').Numbers} normals @param {any} head */
  place(positions, normals, head) {
    this.renderer.setAttributes([[0, 'positions', positions, true], [1, 'normals', normals, true]]);
    this.renderer.heads.set('shape', head);
  }

  /** Fetches what is needed to add a sun to a light, once. */
  async prepareSun() {
    if (this.sunAsked || !this.renderer) return;
    this.sunAsked = true;
    try {
      const [bytes, suns] = await Promise.all([getBytes('/api/pack/sun'), import('./sun.js')]);
      this.suns = suns;
      this.sun = this.modules[1].readPack(bytes, 'sun');
    } catch {
      this.sunAsked = false;  // the program's frames show the sun meanwhile
    }
  }

  /**
   * Fetches the light of an environment that is previewed. Until it arrives, the program's frames show it.
   * @param {string | undefined} env id of the upload; undefined: only the object's own light is needed
   */
  async prepareEnvironment(env) {
    this.other = env && this.renderer && !this.store.state.read_only ? { env } : null;
    const { other } = this;
    if (!other) return;
    await this.fetchOther(other).catch(() => {});
  }

  /** @param {{env: string, light?: Pack, vertex_light?: Pack}} other */
  async fetchOther(other) {
    const { token } = await postJson('preview', { op: 'light', params: { env: other.env } });
    const [light, arriving] = await Promise.all(kLit.map(async (kind) => this.modules[1].readPack(await getBytes(`/api/pack/${kind}?preview=${token}${this.packed()}`), kind)));
    other.light = light;
    other.vertex_light = arriving;
  }

  /** The maps of a light, without its rotation and its sun; null: they are not fetched. @param {Light} light @returns {Pack | null} */
  mapsOf(light) { return (light.env ? (this.other?.env === light.env ? this.other.light : null) : this.own.light) ?? null; }

  /** Gives a light to the renderer. @param {Light} light @param {import('./camera.js').Vec[]} turn rotation of directions of the object to those of the light */
  setLight(light, turn) {
    const from = light.env ? this.other : this.own, sun = light.sun && this.sun ? JSON.stringify([light.sun, light.rotate]) : '';
    if (!from?.light || !from.vertex_light) return;
    const of = [from.light, from.vertex_light], same = (/** @type {Pack[]} */ packs) => of.every((p, i) => p === packs[i]);
    if (same(this.lit.of) && this.lit.sun === sun) return;
    if (sun && this.suns && !(this.sky && same(this.sky.of))) this.sky = { sky: new this.suns.Sky(of[0], of[1], this.surface.shape, /** @type {Pack} */ (this.sun)), of };
    for (const pack of sun && this.sky && light.sun ? this.sky.sky.with(light.sun, turn) : of) this.renderer.set(pack);
    this.lit = { of, sun };
  }

  /** Shows a previewed edit that changes only color and material. @param {string} token @returns {Promise<boolean>} whether it can */
  async preview(token) {
    if (!this.current()) return false;
    const bytes = await getBytes(`/api/pack/look?preview=${token}${this.packed()}`);
    this.set('look', bytes, '');
    this.previewed = token;
    return true;
  }

  /** Whether the renderer has the present packs of these kinds. @param {string[]} kinds */
  has(kinds) {
    /** @type {Record<string, string>} */
    const keys = this.store.state.packs;
    return Boolean(this.renderer && keys && kinds.every((kind) => this.have[kind] === keys[kind] || (kind === 'look' && this.previewed)));
  }

  /** Whether all packs that pictures need are those of the present object. */
  current() { return this.has([...kSurface, ...kLight]); }

  /** Whether it has the surface but not the light, so that it can draw the albedo only. */
  unlit() { return Boolean(this.renderer && !this.renderer.complete && this.has(kSurface)); }

  /** Whether it can draw a picture as asked for. @param {string} channel @param {Light} light @param {string | null} preview token @param {string | null} photo view whose light is shown */
  shows(channel, light, preview, photo) {
    const still = photo === null || this.store.object?.material?.light?.motion === 'world';
    return channel in kChannels && this.mapsOf(light) !== null && (!light.sun || this.sun !== null) && (preview === this.previewed || this.pulled) && still && this.current();
  }

  /** @param {any} camera @param {string} channel @param {Light} light @param {import('./pace.js').Step} [step] */
  draw(camera, channel, light, { scale, rough, coarse } = steps[0]) {
    const turn = this.modules[2].rotation(this.store.object.up, -light.rotate * Math.PI / 180);
    if (this.renderer.complete) this.setLight(light, turn);
    const small = this.modules[2].resized(camera, Math.ceil(scale * camera.width), Math.ceil(scale * camera.height));
    this.renderer.draw({ camera: small, channel: this.renderer.complete ? kChannels[channel] : 'albedo', room_from_object: turn, strength: light.scale, samples: 1, rough, coarse, highlight: 0, hidden: this.hiddenIndices() });
  }

  /**
   * Draws with the quality that there is time for, or, at rest, with the best. Of the pictures that are asked for while another one is
   * drawn, only the last is drawn.
   * @param {any} camera @param {string} channel @param {Light} light @param {boolean} [rest]
   * @returns {Promise<void>} done when this picture, or a later one instead, is drawn
   */
  drawSoon(camera, channel, light, rest = false) {
    this.next = { draw: () => this.draw(camera, channel, light, rest ? steps[0] : this.pace.step), rest };
    this.drawing ??= this.drawNext();
    return this.drawing;
  }

  async drawNext() {
    while (this.next) {
      const { draw, rest } = this.next, began = performance.now();
      this.next = null;
      draw();
      await this.renderer.finished();
      if (rest) continue;
      this.pace.took(performance.now() - began);
      this.refreshCoarse();
    }
    this.drawing = null;
  }

  /** @returns {number[]} */
  hiddenIndices() {
    const names = this.renderer?.heads.get('look')?.parts ?? [];
    return [...this.hidden].map((name) => names.indexOf(name)).filter((index) => index > 0);
  }

  /** A ball around a part; null: the page does not have it. @param {string} name */
  ballOf(name) {
    const { shape, look } = this.surface;
    return this.has(kSurface) ? partBall(shape, look, name) : null;
  }

  /** Whether a pixel shows the object. @param {any} camera @param {number} x @param {number} y */
  onObject(camera, x, y) { return this.renderer?.partAt(camera, x, y, this.hiddenIndices()) >= 0; }
}

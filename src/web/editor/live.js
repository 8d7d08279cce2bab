// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** The object drawn in the page, with the program's own shading. Without WebGL 2 it shows nothing, and the program's frames do. */
import { getBytes, postJson } from './api.js';
import { partBall, partLooks } from './looks.js';
import { Pace, steps } from './pace.js';
import { onItsWay } from './start.js';

/** @typedef {import('./light.js').Light} Light */
/** @typedef {import('../pack.js').Pack} Pack */
/** @typedef {import('./pull.js').Pull} Pull */
/** @typedef {import('./sun.js').Sky} Sky */

/** @type {Record<string, string>} channels of the program that the renderer knows */
const kChannels = { rgb: 'lit', albedo: 'albedo', normal: 'normal', roughness: 'roughness' };
const kLate = 1200;  // milliseconds
const kCoarse = 'coarse';  // triangles for quick pictures: come last, and only where pictures take long
const kLit = ['light', 'vertex_light'], kSurface = ['shape', 'look'], kLight = ['tables', ...kLit];

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
    /** @type {Set<string>} names of parts that are not shown */
    this.hidden = new Set();
    /** @type {Record<string, Pack>} the light of the object and what arrives of it, by kind */
    this.own = {};
    /** @type {{env: string, light?: Pack, vertex_light?: Pack} | null} the same of an environment that is looked under */
    this.other = null;
    /** @type {Pack | null} what a sun adds */
    this.sun = null;
    this.sunComes = false;
    /** @type {{sky: Sky, of: Pack[]} | null} the light that a sun was last added to */
    this.sky = null;
    /** @type {{of: Pack[], sun: string}} the light that the renderer has */
    this.lit = { of: [], sun: '' };
    /** @type {typeof import('./sun.js') | null} loaded with the first sun */
    this.suns = null;
    /** @type {Pull | null} of the shape that was last pulled */
    this.puller = null;
    /** @type {typeof import('./pull.js') | null} loaded when it is first pulled */
    this.pulls = null;
    this.pulled = false;  // the renderer has a shape that is pulled by handles
    /** @type {Record<string, Pack>} those that say where the surface and parts are, by kind */
    this.surface = {};
    /** @type {Map<string, import('./looks.js').Look>} how parts look, by name */
    this.looks = new Map();
    /** @type {string | null} the preview whose look the renderer has */
    this.previewed = null;
    /** @type {{keys: Record<string, string>, packs: Map<string, Promise<ArrayBuffer>>} | null} packs that were asked for ahead */
    this.ahead = null;
    /** @type {Map<string, {key: string, bytes: Promise<ArrayBuffer>}>} packs that are on their way, by kind */
    this.underway = new Map();
    this.pace = new Pace(false);
    /** @type {{draw: () => void, rest: boolean} | null} the picture that comes next */
    this.next = null;
    /** @type {Promise<void> | null} the one that is being drawn, and those after it */
    this.drawing = null;
    this.off = new URLSearchParams(location.search).has('frames');  // for tests: only the program's frames
    this.prepared = this.off ? Promise.resolve() : this.prepare();  // before there is an object: it takes a while
  }

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

  /** Fetches what has changed, all at once. Where there is nothing yet and the light is late, the surface comes first. @returns {Promise<void>} */
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

  async refreshCoarse() {
    const key = this.store.state.packs?.[kCoarse];
    if (!key || !this.pace.step.coarse || this.have[kCoarse] === key || !this.has(['shape'])) return;
    const bytes = await this.fetchPack(kCoarse, key).catch(() => null);  // the fine ones do
    if (bytes && this.store.state.packs?.[kCoarse] === key && this.has(['shape'])) this.set(kCoarse, bytes, key);
  }

  /** @returns {Map<string, Promise<ArrayBuffer>>} packs on their way, by kind */
  fetchMissing() {
    /** @type {Record<string, string>} */
    const keys = this.store.state.packs ?? {};
    return new Map(Object.keys(keys).filter((kind) => kind !== kCoarse && this.have[kind] !== keys[kind]).map((kind) => [kind, this.fetchPack(kind, keys[kind])]));
  }

  /** @param {string} kind @param {string} key */
  fetchPack(kind, key) {
    const before = this.underway.get(kind);
    if (before?.key === key) return before.bytes;
    const bytes = onItsWay(kind, key) ?? getBytes(`/api/pack/${kind}?key=${key}${this.packed()}`);
    bytes.catch(() => this.underway.delete(kind));  // refresh() awaits each, if those before it arrive
    this.underway.set(kind, { key, bytes });
    return bytes;
  }

  packed() { return this.store.line.far ? '&packed=1' : ''; }

  /** @param {string} kind @param {ArrayBuffer} bytes @param {string} key */
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
      if (this.other) this.lookUnder(this.other.env);  // other light arrives at other vertices
    }
    this.have[kind] = key;
    this.underway.delete(kind);
  }

  /**
   * Draws the surface as handles pull it, nearly, until another shape comes or it is let go.
   * @param {import('./pull.js').Handle[]} handles @param {number} reach @param {string | null} part what alone may move @returns {boolean} whether it can
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

  letGo() {
    const { shape } = this.surface;
    if (this.pulled && shape) this.place(shape.arrays.positions, shape.arrays.normals, shape.head);
    this.pulled = false;
  }

  /** @param {import('../pack.js').Numbers} positions @param {import('../pack.js').Numbers} normals @param {any} head */
  place(positions, normals, head) {
    this.renderer.setAttributes([[0, 'positions', positions, true], [1, 'normals', normals, true]]);
    this.renderer.heads.set('shape', head);
  }

  /** Fetches what a sun adds to a light, once. */
  async prepareSun() {
    if (this.sunComes || !this.renderer) return;
    this.sunComes = true;
    try {
      const [bytes, suns] = await Promise.all([getBytes('/api/pack/sun'), import('./sun.js')]);
      this.suns = suns;
      this.sun = this.modules[1].readPack(bytes, 'sun');
    } catch {
      this.sunComes = false;  // the program's frames show it
    }
  }

  /**
   * Fetches the light of an environment that is not kept. Until it is there, the program's frames show it.
   * @param {string | undefined} env id of the upload; none: only the object's own light is needed
   */
  async lookUnder(env) {
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

  /** The maps of the light that is looked under, without its turn and its sun, if they are here. @param {Light} light @returns {Pack | null} */
  mapsOf(light) { return (light.env ? (this.other?.env === light.env ? this.other.light : null) : this.own.light) ?? null; }

  /** Gives the renderer the light that is looked under. @param {Light} light @param {import('./camera.js').Vec[]} turn */
  shine(light, turn) {
    const from = light.env ? this.other : this.own, sun = light.sun && this.sun ? JSON.stringify([light.sun, light.rotate]) : '';
    if (!from?.light || !from.vertex_light) return;
    const of = [from.light, from.vertex_light], same = (/** @type {Pack[]} */ packs) => of.every((p, i) => p === packs[i]);
    if (same(this.lit.of) && this.lit.sun === sun) return;
    if (sun && this.suns && !(this.sky && same(this.sky.of))) this.sky = { sky: new this.suns.Sky(of[0], of[1], this.surface.shape, /** @type {Pack} */ (this.sun)), of };
    for (const pack of sun && this.sky && light.sun ? this.sky.sky.with(light.sun, turn) : of) this.renderer.set(pack);
    this.lit = { of, sun };
  }

  /** Shows an edit of the look that is not kept. @param {string} token @returns {Promise<boolean>} whether it can */
  async preview(token) {
    if (!this.current()) return false;
    const bytes = await getBytes(`/api/pack/look?preview=${token}${this.packed()}`);
    this.set('look', bytes, '');
    this.previewed = token;
    return true;
  }

  /** @param {string[]} kinds */
  has(kinds) {
    /** @type {Record<string, string>} */
    const keys = this.store.state.packs;
    return Boolean(this.renderer && keys && kinds.every((kind) => this.have[kind] === keys[kind] || (kind === 'look' && this.previewed)));
  }

  /** Whether what is drawn is the object as it is now. */
  current() { return this.has([...kSurface, ...kLight]); }

  /** Whether it has the surface and waits for the light: it can draw the albedo. */
  unlit() { return Boolean(this.renderer && !this.renderer.complete && this.has(kSurface)); }

  /** @param {string} channel @param {Light} light @param {string | null} preview @param {string | null} photo */
  shows(channel, light, preview, photo) {
    const still = photo === null || this.store.object?.material?.light?.motion === 'world';
    return channel in kChannels && this.mapsOf(light) !== null && (!light.sun || this.sun !== null) && (preview === this.previewed || this.pulled) && still && this.current();
  }

  /** @param {any} camera @param {string} channel @param {Light} light @param {import('./pace.js').Step} [step] */
  draw(camera, channel, light, { scale, rough, coarse } = steps[0]) {
    const turn = this.modules[2].rotation(this.store.object.up, -light.rotate * Math.PI / 180);
    if (this.renderer.complete) this.shine(light, turn);
    const small = this.modules[2].resized(camera, Math.ceil(scale * camera.width), Math.ceil(scale * camera.height));
    this.renderer.draw({ camera: small, channel: this.renderer.complete ? kChannels[channel] : 'albedo', room_from_object: turn, strength: light.scale, samples: 1, rough, coarse, highlight: 0, hidden: this.hiddenIndices() });
  }

  /**
   * Draws as finely as there is time for, or, at rest, as well as it can. Of the pictures that are asked for while one is drawn only the
   * last is.
   * @param {any} camera @param {string} channel @param {Light} light @param {boolean} [rest]
   * @returns {Promise<void>} when it, or one after it, is drawn
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

  /** Where a part is, if the page knows. @param {string} name */
  ballOf(name) {
    const { shape, look } = this.surface;
    return this.has(kSurface) ? partBall(shape, look, name) : null;
  }

  /** Whether the object is at a pixel. @param {any} camera @param {number} x @param {number} y */
  onObject(camera, x, y) { return this.renderer?.partAt(camera, x, y, this.hiddenIndices()) >= 0; }
}

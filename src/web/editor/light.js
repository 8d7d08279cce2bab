// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Turns, scales and replaces the light, and adds a sun. The page shows the object in that light at once; Keep makes it an edit. */
import { add, cross, dot, mul, rotation, times, unit } from './camera.js';
import { complain, el, field, toast } from './dom.js';
import { upload } from './api.js';

/** @typedef {import('./camera.js').Vec} Vec */
/** @typedef {{rotate: number, scale: number, env?: string, sun?: {direction: Vec, strength: number}}} Light that is previewed; env: id of an upload; sun: direction towards it, capture frame */

const kBall = 120;  // pixels a side

const degreesOf = (/** @type {number} */ v) => `${Math.round(v)}°`;

export class LightTool {
  /** @param {import('./stage.js').Stage} stage @param {import('./store.js').Store} store @param {() => void} changed */
  constructor(stage, store, changed) {
    this.stage = stage;
    this.store = store;
    this.changed = changed;
    this.name = 'light';
    this.label = 'Light';
    this.hint = 'Click on the ball to add a sun; turn the light with Shift and the right button; drop an .hdr or .exr on the view. Keep stores the light.';
    this.file = '';
    /** @type {File | null} */
    this.env = null;
    /** @type {HTMLCanvasElement | null} */
    this.ball = null;
    /** @type {typeof import('./ball.js') | null} loaded when a ball is first shown */
    this.balls = null;
    stage.addEventListener('moved', () => this.drawBall());
    stage.addEventListener('exact', () => this.drawBall());
  }

  differs() { const l = this.stage.light; return l.rotate !== 0 || l.scale !== 1 || l.env !== undefined || l.sun !== undefined; }

  panel() {
    const l = this.stage.light;
    return [
      el('p', {}, this.file && l.env ? `Previewing ${this.file}.` : 'The object’s light, as edited so far.'),
      this.makeBall(),
      field('Turned', 'light-rotate', [-180, 180, 1], l.rotate, degreesOf, (rotate) => this.show({ rotate }), { ondblclick: () => this.set({ rotate: 0 }) }),
      field('Strength', 'light-scale', [-2, 2, 0.05], Math.log2(l.scale), (v) => (2 ** v).toFixed(2), (v) => this.show({ scale: 2 ** v }), { ondblclick: () => this.set({ scale: 1 }) }),
      ...this.sunFields(),
      el('div', { class: 'buttons' },
        el('button', { onclick: () => this.choose() }, 'Environment…'),
        el('button', { class: 'primary', id: 'light-keep', onclick: () => this.keep() }, 'Keep'),
        el('button', { id: 'light-drop', onclick: () => this.drop() }, 'Discard')),
    ];
  }

  /** Direction of the sun: angle about the up axis, and height above the horizon, degrees. */
  sunAngles() {
    const [a, b, up] = this.upright(), d = unit(this.stage.light.sun?.direction ?? add(a, up)), degrees = 180 / Math.PI;
    return { around: Math.atan2(dot(d, b), dot(d, a)) * degrees, height: Math.asin(Math.max(-1, Math.min(1, dot(d, up)))) * degrees };
  }

  /** Two axes of the horizon, and up. @returns {[Vec, Vec, Vec]} */
  upright() {
    const up = unit(this.store.object.up), a = unit(cross(up, Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
    return [a, cross(up, a), up];
  }

  sunFields() {
    const angles = this.sunAngles(), strength = this.stage.light.sun?.strength ?? 0;
    const put = () => {
      const [a, b, up] = this.upright(), t = angles.around * Math.PI / 180, h = angles.height * Math.PI / 180;
      this.putSun(add(mul(add(mul(a, Math.cos(t)), mul(b, Math.sin(t))), Math.cos(h)), mul(up, Math.sin(h))));
    };
    return [
      field('Sun', 'sun-strength', [0, 8, 0.1], strength, (v) => v.toFixed(1), (v) => this.strengthen(v), { title: 'Relative to the rest of the light; 0: no sun', ondblclick: () => this.strengthen(0) }),
      field('Sun around', 'sun-around', [-180, 180, 1], angles.around, degreesOf, (v) => { angles.around = v; put(); }),
      field('Sun height', 'sun-height', [-90, 90, 1], angles.height, degreesOf, (v) => { angles.height = v; put(); }),
    ];
  }

  /** @param {Vec} direction */
  putSun(direction) { this.show({ sun: { direction: unit(direction), strength: this.stage.light.sun?.strength || 1 } }); }

  /** @param {number} strength */
  strengthen(strength) {
    const [a, , up] = this.upright();
    this.show({ sun: strength > 0 ? { direction: this.stage.light.sun?.direction ?? unit(add(a, up)), strength } : undefined });
  }

  makeBall() {
    const at = (/** @type {PointerEvent} */ e) => {
      const r = /** @type {HTMLCanvasElement} */ (this.ball).getBoundingClientRect();
      if (this.balls) this.putSun(this.balls.mirrored(2 * (e.clientX - r.left) / r.width - 1, 2 * (e.clientY - r.top) / r.height - 1, this.stage.camera.axes));
    };
    const ball = el('canvas', { class: 'ball', id: 'light-ball', width: kBall, height: kBall, 'aria-hidden': 'true', title: 'A mirror ball: click to place the sun where its reflection should be',
      onpointerdown: (/** @type {PointerEvent} */ e) => { ball.setPointerCapture(e.pointerId); at(e); },
      onpointermove: (/** @type {PointerEvent} */ e) => { if (e.buttons & 1) at(e); },
      onpointerup: () => this.changed() });
    this.ball = ball;
    import('./ball.js').then((balls) => { this.balls = balls; this.drawBall(); }, () => {});  // without the ball there are still the sliders
    return ball;
  }

  drawBall() {
    const { ball, balls } = this;
    if (!balls || !ball?.isConnected) return;
    const { light, camera, live } = this.stage, pack = live.mapsOf(light);
    const turn = rotation(unit(this.store.object.up), -light.rotate * Math.PI / 180);
    const level = pack ? pack.arrays.reflection.subarray(0, pack.head.reflection_side ** 2) : null;
    balls.drawBall(ball, camera.axes, (d) => {
      if (!level || !pack) return [0.25, 0.25, 0.25];  // gray, while the map of this light is not fetched
      return mul(balls.radianceOf(/** @type {Uint32Array} */ (level), pack.head.reflection_side, times(turn, d)), light.scale);
    }, light.sun?.direction ?? null);
  }

  update() { for (const id of ['light-keep', 'light-drop']) { const b = /** @type {any} */ (document.getElementById(id)); if (b) b.disabled = !this.differs(); } }

  enter() {
    this.update();
    this.stage.live.prepareSun();
  }

  /** Previews a light. @param {Partial<Light>} values to change */
  show(values) {
    Object.assign(this.stage.light, values);
    this.stage.moved();
    this.update();
  }

  /** The same, and updates the sliders. @param {Partial<Light>} values to change */
  set(values) {
    this.show(values);
    this.changed();
  }

  /** @param {number} degrees */
  turn(degrees) {
    let rotate = this.stage.light.rotate + degrees;
    if (rotate > 180) rotate -= 360;
    if (rotate < -180) rotate += 360;
    this.set({ rotate });
  }

  choose() {
    const input = el('input', { type: 'file', accept: '.hdr,.exr,.npy,image/*' });
    input.onchange = () => { if (input.files[0]) this.take(input.files[0]); };
    input.click();
  }

  /** @param {File} file */
  async take(file) {
    try {
      const env = await upload(file, file.name);
      this.file = file.name;
      this.env = file;
      this.set({ env });
      this.stage.live.prepareEnvironment(env).then(() => this.drawBall());
      toast(`Previewing ${file.name}; Keep makes it the object’s light.`);
    } catch (error) { complain(error); }
  }

  async keep() {
    if (!this.differs()) return;
    const params = { ...this.stage.light }, { env } = this;
    const done = await this.store.change('edit', async () => {
      if (params.env && env) await upload(env, env.name);
      return { op: 'light', params };
    });
    if (done) this.drop();
  }

  drop() {
    this.stage.light = { rotate: 0, scale: 1 };
    this.stage.live.prepareEnvironment(undefined);
    this.file = '';
    this.stage.moved();
    this.changed();
    this.update();
  }
}

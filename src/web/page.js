// SPDX-License-Identifier: Apache-2.0
// @ts-check
// The page that `cei3d export -o object.html` writes: an object, its light, and controls.
import { plus, rotation, unit } from './camera.js';
import { Controls } from './controls.js';
import { Orbit } from './orbit.js';
import { readPack } from './pack.js';
import { Renderer, channels } from './renderer.js';

/** @typedef {import('./camera.js').Camera} Camera */
/** @typedef {import('./pack.js').Pack} Pack */

const kPacks = ['tables', 'light', 'shape', 'look', 'vertex_light', 'reflections'];
const kRest = 150;             // milliseconds after the last change until the smooth picture is drawn
const kMaxPixels = 2600;      // of a side of the canvas

/** @template {HTMLElement} T @param {string} id @param {new () => T} type @returns {T} */
function element(id, type) {
  const e = document.getElementById(id);
  if (!(e instanceof type)) throw new Error(`The page lacks its "${id}".`);
  return e;
}

/** The pack in a data block of the page. @param {string} kind @returns {Promise<Pack>} */
async function packOf(kind) {
  if (!('DecompressionStream' in globalThis)) throw new Error('This page needs a browser of 2023 or later.');
  const text = atob(element(`data-${kind}`, HTMLScriptElement).textContent ?? '');
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return readPack(await new Response(stream).arrayBuffer(), kind);
}

/** The distance of the farthest vertex from the middle of the box. @param {Pack} shape */
function radiusOf({head, arrays: {positions}}) {
  let radius = 0;
  for (let i = 0; i < positions.length; i += 4) {
    const offset = [0, 1, 2].map((k) => (positions[i + k] / 65535 - 0.5) * head.size[k]);
    radius = Math.max(radius, Math.hypot(...offset));
  }
  return radius;
}

class Page {
  /** @param {Pack[]} packs in the order of kPacks */
  constructor(packs) {
    this.packs = packs;
    this.about = JSON.parse(element('data-about', HTMLScriptElement).textContent ?? '{}');
    this.canvas = element('object', HTMLCanvasElement);
    this.name = element('part', HTMLParagraphElement);
    this.light = element('light', HTMLInputElement);
    this.degrees = element('degrees', HTMLOutputElement);
    this.up = unit(this.about.up);
    this.channel = channels[0];
    this.highlight = 0;
    this.frame = 0;
    this.rest = 0;
    this.fine = false;
    const ofKind = /** @param {string} kind */ (kind) => packs[kPacks.indexOf(kind)];
    /** @type {string[]} */
    this.parts = ofKind('look').head.parts;
    const shape = ofKind('shape'), {min, size} = shape.head;
    const middle = plus(min, size, 0.5);
    this.orbit = new Orbit(middle, radiusOf(shape), this.up, this.about.from);
    this.renderer = this.makeRenderer();
    this.controls = new Controls(this.canvas, this.orbit, {
      moved: () => this.changed(),
      turnLight: (degrees) => this.turnLight(Number(this.light.value) + degrees),
      hover: (e) => this.hover(e),
    });
    this.addPanel();
    new ResizeObserver(() => this.changed()).observe(this.canvas);
    this.canvas.addEventListener('webglcontextlost', (e) => e.preventDefault());
    this.canvas.addEventListener('webglcontextrestored', () => {
      this.renderer = this.makeRenderer();
      this.changed();
    });
  }

  makeRenderer() {
    const renderer = new Renderer(this.canvas);
    for (const pack of this.packs) renderer.set(pack);
    return renderer;
  }

  addPanel() {
    const list = element('channels', HTMLFieldSetElement);
    for (const channel of channels) {
      const label = document.createElement('label'), input = document.createElement('input');
      Object.assign(input, {type: 'radio', name: 'channel', value: channel, checked: channel === this.channel});
      input.addEventListener('change', () => this.show(channel));
      label.append(input, channel);
      list.append(label);
    }
    const parts = element('parts', HTMLFieldSetElement);
    this.parts.forEach((name, part) => {
      if (part === 0) return;
      const button = document.createElement('button');
      Object.assign(button, {type: 'button', textContent: name});
      for (const on of ['focus', 'pointerenter']) button.addEventListener(on, () => this.mark(part));
      for (const off of ['blur', 'pointerleave']) button.addEventListener(off, () => this.mark(0));
      parts.append(button);
    });
    parts.hidden = this.parts.length < 2;
    this.light.addEventListener('input', () => this.turnLight(Number(this.light.value)));
    element('home', HTMLButtonElement).addEventListener('click', () => {
      this.orbit.home();
      this.changed();
    });
    this.canvas.addEventListener('keydown', (e) => {
      if (e.key.toLowerCase() !== 'c' || e.ctrlKey || e.metaKey || e.altKey) return;
      this.show(channels[(channels.indexOf(this.channel) + 1) % channels.length]);
    });
    element('panel', HTMLFormElement).hidden = false;
  }

  /** @param {string} channel */
  show(channel) {
    this.channel = channel;
    for (const input of document.querySelectorAll('input[name=channel]'))
      if (input instanceof HTMLInputElement) input.checked = input.value === channel;
    this.changed();
  }

  /** @param {number} degrees counter-clockwise seen from above; any */
  turnLight(degrees) {
    const within = degrees - 360 * Math.round(degrees / 360);
    this.light.value = String(within);
    this.degrees.value = `${Math.round(within)}°`;
    this.changed();
  }

  /** @param {number} part */
  mark(part) {
    if (part === this.highlight) return;
    this.highlight = part;
    this.changed();
  }

  /** Names the part under the pointer. @param {PointerEvent | null} e */
  hover(e) {
    if (this.parts.length < 2) return;
    let part = -1;
    if (e) {
      const scale = this.canvas.width / Math.max(this.canvas.clientWidth, 1);
      part = this.renderer.partAt(this.camera(), Math.floor(e.offsetX * scale), Math.floor(e.offsetY * scale));
      this.name.style.transform = `translate(${e.clientX + 14}px, ${e.clientY + 14}px)`;
    }
    this.name.textContent = part > 0 ? this.parts[part] : '';
    this.mark(Math.max(part, 0));
  }

  /** The camera of the canvas as it is now. @returns {Camera} */
  camera() {
    const {clientWidth: w, clientHeight: h} = this.canvas;
    const scale = Math.min(window.devicePixelRatio || 1, kMaxPixels / Math.max(w, h, 1));
    return this.orbit.camera(Math.max(1, Math.round(w * scale)), Math.max(1, Math.round(h * scale)));
  }

  /** @param {Camera} camera @param {number} samples */
  draw(camera, samples) {
    // To turn the light counter-clockwise, the directions in which it is looked up are turned clockwise.
    const turn = rotation(this.up, (-Number(this.light.value) * Math.PI) / 180);
    const {channel, highlight} = this;
    this.renderer.draw({camera, channel, room_from_object: turn, samples, highlight});
  }

  /** Draws with one sample in the next frame, and with four per pixel when nothing changes any more. */
  changed() {
    this.fine = false;
    window.clearTimeout(this.rest);
    this.rest = window.setTimeout(() => {
      this.draw(this.camera(), 2);
      this.fine = true;
    }, kRest);
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      this.draw(this.camera(), 1);
    });
  }
}

async function start() {
  const message = element('message', HTMLParagraphElement);
  try {
    const page = new Page(await Promise.all(kPacks.map(packOf)));
    message.hidden = true;
    page.changed();
    return page;
  } catch (e) {
    message.textContent = e instanceof Error ? e.message : String(e);
    throw e;
  }
}

/** For tests and scripts: pictures that the page draws for the cameras of a render.json. */
Object.assign(globalThis, {
  cei3d: {
    page: start(),
    /** @param {Page} page @param {Camera} camera @param {string} channel @param {number} degrees of the light */
    picture(page, camera, channel = 'lit', degrees = 0) {
      page.show(channel);
      page.turnLight(degrees);
      page.draw(camera, 2);
      return page.canvas.toDataURL('image/png');
    },
  },
});

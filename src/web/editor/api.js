// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Talks to the program: requests by fetch; frames and messages to all windows by one WebSocket. */

const KEY = 'cei3d-key';

/** Takes the key from behind the # of the address, and removes it there, so that no history and no screenshot shows it. */
function takeKey() {
  const match = /[#&]k=([0-9a-f]+)/.exec(location.hash);
  if (match) {
    sessionStorage.setItem(KEY, match[1]);
    history.replaceState(null, '', location.pathname + location.search);
  }
  return sessionStorage.getItem(KEY) ?? '';
}
let key = takeKey();
export const hasKey = () => key !== '';

export class ApiError extends Error {
  /** @param {number} status @param {string} message @param {string} hint */
  constructor(status, message, hint) {
    super(message);
    this.status = status;
    this.hint = hint;
  }
}

/** @param {string} path @param {RequestInit & {headers?: Record<string, string>}} [options] @returns {Promise<Response>} */
async function request(path, options = {}) {
  let response;
  try {
    response = await fetch(path, { ...options, headers: { Authorization: `Bearer ${key}`, ...options.headers } });
  } catch {
    throw new ApiError(0, 'The program does not answer.', 'Is cei3d still running?');
  }
  if (response.ok) return response;
  const text = await response.text();
  let answer = { error: text || `The program refused (${response.status}).`, hint: '' };
  try { answer = JSON.parse(text); } catch { /* the answer is plain text */ }
  throw new ApiError(response.status, answer.error, answer.hint ?? '');
}

/** @param {string} path @returns {Promise<any>} */
export const getJson = async (path) => (await request(path)).json();
/** @param {string} path @returns {Promise<Blob>} */
export const getBlob = async (path) => (await request(path)).blob();
/** @param {string} path @returns {Promise<ArrayBuffer>} */
export const getBytes = async (path) => (await request(path)).arrayBuffer();

/** @param {string} route @param {object} [body] @param {string} [revision] @returns {Promise<Response>} */
const post = (route, body = {}, revision = '') => request(`/api/${route}`, {
  method: 'POST',
  body: JSON.stringify(body),
  headers: { 'Content-Type': 'application/json', ...(revision ? { 'If-Match': revision } : {}) },
});
/** @param {string} route @param {object} [body] @param {string} [revision] @returns {Promise<any>} */
export const postJson = async (route, body, revision) => (await post(route, body, revision)).json();
/** @param {string} route @param {object} [body] @param {string} [revision] @returns {Promise<Blob>} */
export const postForBlob = async (route, body, revision) => (await post(route, body, revision)).blob();

/** @param {Blob} file @param {string} name @returns {Promise<string>} id of the upload */
export async function upload(file, name) {
  const response = await request(`/api/upload?name=${encodeURIComponent(name)}`, {
    method: 'POST', body: file, headers: { 'Content-Type': 'application/octet-stream' },
  });
  return (await response.json()).id;
}

/** @typedef {import('./messages.js').TileHead & {pixels: Uint8ClampedArray<ArrayBuffer>}} Tile */

/** @param {ArrayBuffer} bytes @returns {Tile} whose pixels are still compressed if it is `packed` */
function readTile(bytes) {
  const length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  return { ...head, pixels: new Uint8ClampedArray(bytes, 4 + length) };
}

/** The tile with its pixels uncompressed. @param {Tile} tile @returns {Promise<Tile>} */
async function unpacked(tile) {
  const stream = new Blob([tile.pixels]).stream().pipeThrough(new DecompressionStream('gzip'));
  return { ...tile, pixels: new Uint8ClampedArray(await new Response(stream).arrayBuffer()) };
}

export const kSlowRoundTrip = 15;  // milliseconds; from here on compressing packs and frames saves time

/** The WebSocket. When it closes it is opened again, after 1, 2, 4, 4, ... seconds. */
export class Line extends EventTarget {
  constructor() {
    super();
    this.wait = 1000;
    /** @type {WebSocket | null} */
    this.socket = null;
    this.ready = false;
    this.timer = 0;
    /** The last message to all windows that arrived here: the run of the program and the number of the message. @type {{run: string, after: number} | null} */
    this.heard = null;
    this.slow = false;  // compressing what is sent saves time
    /** @type {Promise<void>} done when all messages so far are passed on */
    this.order = Promise.resolve();
    this.packed = 0;  // number of tiles that are being uncompressed
    this.open();
    // The program may have been restarted, and its new address pasted into this window.
    window.addEventListener('hashchange', () => {
      key = takeKey();
      this.wait = 1000;
      this.socket?.close();
    });
  }

  open() {
    const socket = new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/socket`);
    socket.binaryType = 'arraybuffer';
    let opened = false, asked = 0;
    socket.onopen = () => {
      opened = true;
      asked = performance.now();
      socket.send(JSON.stringify({ type: 'hello', token: key, ...this.heard }));
    };
    socket.onmessage = ({ data }) => {
      if (!this.ready) this.slow = performance.now() - asked > kSlowRoundTrip;
      this.take(data);
    };
    socket.onclose = () => {
      if (this.ready) this.emit('lost', null);
      else if (opened) this.emit('unknownServer', null);
      this.ready = false;
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => this.open(), this.wait);
      this.wait = Math.min(2 * this.wait, 4000);
    };
    this.socket = socket;
  }

  /** Passes messages on in their order, although some tiles have to be uncompressed first. @param {string | ArrayBuffer} data */
  take(data) {
    if (typeof data === 'string') {
      const message = JSON.parse(data);
      if (this.packed === 0) this.pass(message);
      else this.order = this.order.then(() => this.pass(message));
      return;
    }
    const tile = readTile(data);
    if (!tile.packed) return this.emit('tile', tile);
    ++this.packed;
    const pixels = unpacked(tile);
    this.order = this.order.then(async () => this.emit('tile', await pixels)).catch(() => {}).finally(() => { --this.packed; });
  }

  /** @param {any} message */
  pass(message) {
    if (message.type === 'welcome') {
      this.ready = true;
      this.wait = 1000;
      this.heard = { run: message.run, after: message.event };
    } else if (message.event && this.heard) this.heard.after = message.event;
    this.emit(message.type, message);
  }

  /** Done when the program answers again; if the socket has not noticed that it was away, after a second. @returns {Promise<void>} */
  back() {
    return new Promise((resolve) => {
      this.addEventListener('welcome', () => resolve(), { once: true });
      if (this.ready) window.setTimeout(resolve, 1000);
    });
  }

  /** @param {string} type @param {any} detail */
  emit(type, detail) { this.dispatchEvent(new CustomEvent(type, { detail })); }
  /** @param {string} type @param {(detail: any) => void} listener */
  on(type, listener) { this.addEventListener(type, (e) => listener(/** @type {CustomEvent} */ (e).detail)); }
  /** @param {object} message */
  send(message) { if (this.ready) this.socket?.send(JSON.stringify(message)); }
}

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Small pictures of the object after each edit. The browser stores them until the window is closed, so that they survive a reload of the page. */

export const kWidth = 80, kHeight = 60;

export class Thumbs {
  constructor() {
    /** @type {Map<string, {of: string, url: string}>} what the picture shows, and its address, by key */
    this.shown = new Map();
  }

  /** @param {string} key @param {string} of what the picture must show @returns {string | undefined} its address; undefined: there is no such picture */
  get(key, of) {
    const known = this.shown.get(key);
    if (known?.of === of) return known.url;
    const stored = sessionStorage.getItem(key);
    const [stored_of, picture] = stored ? JSON.parse(stored) : [];
    return stored && stored_of === of ? this.show(key, of, picture) : undefined;
  }

  /** @param {string} key @param {string} of @param {HTMLCanvasElement | ImageBitmap} picture of any size */
  keep(key, of, picture) {
    const small = document.createElement('canvas'), { width: w, height: h } = picture, s = Math.max(kWidth / w, kHeight / h);
    small.width = kWidth;
    small.height = kHeight;
    small.getContext('2d')?.drawImage(picture, (kWidth - w * s) / 2, (kHeight - h * s) / 2, w * s, h * s);
    const bytes = small.toDataURL('image/png').split(',')[1];
    this.show(key, of, bytes);
    try {
      sessionStorage.setItem(key, JSON.stringify([of, bytes]));
    } catch { /* the browser's storage is full, so a reload loses this picture */ }
  }

  /** @param {string} key @param {string} of @param {string} base64 of a PNG file */
  show(key, of, base64) {
    this.forget(key);
    const url = URL.createObjectURL(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], { type: 'image/png' }));
    this.shown.set(key, { of, url });
    return url;
  }

  /** @param {string} key */
  forget(key) {
    const known = this.shown.get(key);
    if (known) URL.revokeObjectURL(known.url);
    this.shown.delete(key);
  }

  clear() { for (const key of [...this.shown.keys()]) this.forget(key); }
}

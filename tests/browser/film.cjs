// SPDX-License-Identifier: Apache-2.0
// film.cjs PROGRAM PROJECT CHROMIUM OUT.webp: a short film of the editor for the README, with real edits of a copy of PROJECT.
const fs = require('node:fs');
const { withEditor, settled } = require('./serve.cjs');
const { middle, put } = require('./page.cjs');

const [program, project, executablePath, out] = process.argv.slice(2);
const kMaxBytes = 1e6;

/** A chunk of RIFF. @param {string} name @param {Buffer} data */
function chunk(name, data) {
  const head = Buffer.alloc(8);
  head.write(name, 'latin1');
  head.writeUInt32LE(data.length, 4);
  return Buffer.concat([head, data, Buffer.alloc(data.length % 2)]);
}

const u24 = (...values) => Buffer.concat(values.map((v) => Buffer.from([v & 255, v >> 8 & 255, v >> 16 & 255])));

/** The chunks of a WebP picture that hold its pixels; frames must not have others. @param {Buffer} picture */
function pixels(picture) {
  const parts = [];
  for (let at = 12; at < picture.length;) {
    const end = at + 8 + picture.readUInt32LE(at + 4), padded = end + (end - at) % 2;
    if (['VP8 ', 'VP8L'].includes(picture.toString('latin1', at, at + 4))) parts.push(picture.subarray(at, padded));
    at = padded;
  }
  return Buffer.concat(parts);
}

/** A WebP film that repeats forever. @param {{picture: Buffer, milliseconds: number}[]} frames pictures: WebP without alpha, all of one size */
function film(frames, width, height) {
  const size = u24(width - 1, height - 1);
  const parts = [chunk('VP8X', Buffer.concat([Buffer.from([2, 0, 0, 0]), size])), chunk('ANIM', Buffer.alloc(6))];
  for (const { picture, milliseconds } of frames)
    parts.push(chunk('ANMF', Buffer.concat([u24(0, 0), size, u24(milliseconds), Buffer.from([2]), pixels(picture)])));
  return chunk('RIFF', Buffer.concat([Buffer.from('WEBP'), ...parts]));
}

/** Makes frames of screenshots; equal neighbors become one frame. */
class Camera {
  constructor(page, converter) {
    Object.assign(this, { page, converter, frames: [], last: '' });
  }

  async shoot(milliseconds) {
    const png = (await this.page.screenshot()).toString('base64');
    if (png === this.last) {
      this.frames.at(-1).milliseconds += milliseconds;
      return;
    }
    this.last = png;
    const made = await this.converter.evaluate(async (text) => {
      const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], { type: 'image/png' }));
      const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
      canvas.getContext('2d', { alpha: false }).drawImage(bitmap, 0, 0);
      const bytes = new Uint8Array(await (await canvas.convertToBlob({ type: 'image/webp', quality: 0.72 })).arrayBuffer());
      return { width: bitmap.width, height: bitmap.height, text: btoa(Array.from(bytes, (b) => String.fromCharCode(b)).join('')) };
    }, png);
    Object.assign(this, { width: made.width, height: made.height });
    this.frames.push({ picture: Buffer.from(made.text, 'base64'), milliseconds });
  }
}

/** Waits for the photographs of the strip, which are loaded after the picture is complete. */
const photographs = (page) => page.waitForFunction(() => {
  const strip = document.getElementById('strip').getBoundingClientRect();
  const inSight = [...document.querySelectorAll('#strip button')].filter((b) => b.getBoundingClientRect().left < strip.right);
  return inSight.length > 0 && inSight.every((b) => b.querySelector('img')?.complete);
}, null, { timeout: 60000 });

/** Waits for the page's own picture. */
const drawn = (page) => page.evaluate(async () => {
  for (let i = 0; i < 2; ++i) await new Promise((resolve) => requestAnimationFrame(resolve));
  await globalThis.cei3d.stage.live.drawing;
});

async function play(page, camera) {
  const still = async (milliseconds) => { await settled(page); await camera.shoot(milliseconds); };
  await settled(page);
  // As fine as on a machine with a graphics processor.
  await page.evaluate(() => { const { pace } = globalThis.cei3d.stage.live; Object.assign(pace, { at: 0, took: () => {} }); });
  await photographs(page);
  await still(900);
  for (let i = 0; i < 12; ++i) {
    await page.evaluate(() => { const { stage } = globalThis.cei3d; stage.camera.orbit(0.06, 0.01); stage.moved(); });
    await drawn(page);
    await camera.shoot(90);
  }
  await still(600);
  await page.keyboard.press('b');
  await page.fill('#brush-color', '#1f6fe0');
  const at = await middle(page);
  await page.mouse.move(at.x - 70, at.y - 10);
  await page.mouse.down();
  for (let i = 0; i < 10; ++i) {
    await page.mouse.move(at.x - 70 + 14 * i, at.y - 10 + 22 * Math.sin(i * 0.9), { steps: 4 });
    await camera.shoot(80);
  }
  await page.mouse.up();
  await still(1100);
  await page.keyboard.press('m');
  for (const v of [0.35, 0.2, 0.1]) {
    await put(page, '#properties input[data-key="roughness"]', v);
    await still(350);
  }
  await page.keyboard.press('l');
  for (let i = 1; i <= 10; ++i) {
    await put(page, '#light-rotate', 16 * i);
    await drawn(page);
    await camera.shoot(90);
  }
  await still(1500);
}

withEditor({ program, project, executablePath, copy: true }, async ({ server, browser }) => {
  const context = await browser.newContext({ viewport: { width: 1180, height: 720 }, deviceScaleFactor: 0.6, colorScheme: 'dark', reducedMotion: 'reduce' });
  const page = await context.newPage(), converter = await context.newPage();
  await page.bringToFront();
  await page.goto(server.url);
  const camera = new Camera(page, converter);
  await play(page, camera);
  const bytes = film(camera.frames, camera.width, camera.height);
  fs.writeFileSync(out, bytes);
  console.log(`${out}: ${camera.frames.length} frames of ${camera.width} x ${camera.height}, ${Math.round(bytes.length / 1000)} kB`);
  if (bytes.length > kMaxBytes) throw new Error('The film is too large for the README.');
}).catch((error) => { console.error(error); process.exit(1); });

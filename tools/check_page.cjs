#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// check_page.cjs PAGE.html RENDERED... [--min DB]: an exported page in a headless browser. Its pictures by the cameras of
// RENDERED/render.json, under that light turned as there, must be those in RENDERED (PSNR on white, of rgb and albedo if it
// is there); it must ask the network for nothing, write nothing to the console, and obey the keyboard. Exit code 1
// if not; 77 where Chromium or the npm package playwright-core is not installed (./run web).
'use strict';
const fs = require('fs');
const path = require('path');
const {browserPath, optional} = require('./npm.cjs');

const dataUrl = (file) => `data:image/png;base64,${fs.readFileSync(file).toString('base64')}`;

// Runs in a page: PSNR of two pictures on white.
async function psnr([a, b]) {
  const pixels = async (url) => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext('2d', {willReadFrequently: true});
    context.fillStyle = '#ffffff';
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, canvas.width, canvas.height).data;
  };
  const [p, q] = [await pixels(a), await pixels(b)];
  if (p.length !== q.length) return 0;
  let sum = 0;
  for (let i = 0; i < p.length; ++i) if (i % 4 < 3) sum += ((p[i] - q[i]) / 255) ** 2;
  return 10 * Math.log10(1 / Math.max((sum * 4) / 3 / p.length, 1e-10));
}

const channelNames = {rgb: 'lit', albedo: 'albedo'};  // those whose pictures have an alpha channel

async function compare(page, judge, folder) {
  const record = JSON.parse(fs.readFileSync(path.join(folder, 'render.json'), 'utf8'));
  const means = {};
  for (const channel of record.channels.filter((c) => c in channelNames)) {
    const scores = [];
    for (const camera of record.cameras) {
      const picture = await page.evaluate(
          async ([c, name, degrees]) => globalThis.cei3d.picture(await globalThis.cei3d.page, c, name, degrees),
          [camera, channelNames[channel], channel === 'rgb' ? record.light.rotate_degrees : 0]);
      if (process.env.CEI3D_PICTURES)
        fs.writeFileSync(path.join(process.env.CEI3D_PICTURES, `${channel}-${camera.file}`), Buffer.from(picture.split(',')[1], 'base64'));
      scores.push(await judge.evaluate(psnr, [picture, dataUrl(path.join(folder, channel, camera.file))]));
    }
    means[channel] = scores.reduce((a, b) => a + b) / scores.length;
    console.log(`${folder} ${channel}: ${scores.map((s) => s.toFixed(2)).join(' ')}; mean ${means[channel].toFixed(2)} dB`);
  }
  return means;
}

// What the keyboard does to the view. @returns names of what it does not do
async function keyboardFaults(page) {
  const state = () => page.evaluate(async () => {
    const p = await globalThis.cei3d.page;
    return {azimuth: p.orbit.azimuth, distance: p.orbit.distance, target: p.orbit.target, channel: p.channel,
      light: p.light.value, focus: document.activeElement.id};
  });
  const faults = [];
  await page.keyboard.press('Tab');
  const before = await state();
  if (before.focus !== 'object') faults.push('Tab does not reach the object first');
  const press = async (key, what, changed) => {
    const a = await state();
    await page.keyboard.press(key);
    if (!changed(a, await state())) faults.push(`${key} does not ${what}`);
  };
  await press('ArrowRight', 'turn by 5 degrees', (a, b) => Math.abs(b.azimuth - a.azimuth - Math.PI / 36) < 1e-9);
  await press('+', 'zoom', (a, b) => b.distance < a.distance);
  await press('Shift+ArrowUp', 'move', (a, b) => String(a.target) !== String(b.target));
  await press(']', 'turn the light', (a, b) => Number(b.light) === Number(a.light) + 5);
  await press('c', 'show the next channel', (a, b) => a.channel !== b.channel);
  await press('Home', 'return', (a, b) => b.azimuth === before.azimuth && b.distance === before.distance);
  return faults;
}

async function main() {
  const args = process.argv.slice(2);
  const at = args.indexOf('--min');
  const min = at < 0 ? 34 : Number(args.splice(at, 2)[1]);
  const [file, ...folders] = args;
  const driver = optional('playwright-core'), executablePath = browserPath();
  if (!driver || !executablePath) {
    console.log(`SKIP: the page in a browser: ${driver ? 'Chromium' : 'playwright-core'} is not installed (./run web)`);
    process.exit(77);
  }
  const root = process.getuid && process.getuid() === 0;
  const browser = await driver.chromium.launch({executablePath, args: root ? ['--no-sandbox'] : []});
  const faults = [];
  try {
    const judge = await browser.newPage();
    const page = await browser.newPage({viewport: {width: 640, height: 480}});
    const url = `file://${path.resolve(file)}`;
    page.on('console', (m) => m.text().includes('GPU stall') || faults.push(`the console says: ${m.text()}`));
    page.on('pageerror', (e) => faults.push(`error: ${e.message}`));
    page.on('request', (r) => r.url() === url || r.url().startsWith('blob:') || faults.push(`it asks for ${r.url()}`));
    await page.goto(url);
    await page.evaluate(async () => { await globalThis.cei3d.page; });
    faults.push(...await keyboardFaults(page));
    for (const folder of folders)
      for (const [channel, mean] of Object.entries(await compare(page, judge, folder)))
        if (!(mean >= min)) faults.push(`${folder}: ${channel} is ${mean.toFixed(2)} dB from our render, less than ${min}`);
  } finally {
    await browser.close();
  }
  for (const fault of new Set(faults)) console.log(`${file}: ${fault}`);
  process.exit(faults.length === 0 ? 0 : 1);
}
main();

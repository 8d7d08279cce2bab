// SPDX-License-Identifier: Apache-2.0
// making.cjs PROGRAM CAPTURE PICTURES CHROMIUM: makes an object in the editor, with pictures meanwhile, stops and resumes.
const fs = require('node:fs');
const { check, state, picturesIn, accessible, tidy, zoomed, withPage } = require('./page.cjs');

const [program, project, pictures, executablePath] = process.argv.slice(2);
fs.mkdirSync(pictures, { recursive: true });
const picture = picturesIn(pictures);

const mode = (page, name) => page.waitForFunction((m) => globalThis.cei3d?.store.state.mode === m && document.querySelector('#place .column'), name, { timeout: 60000 });
const seen = (page) => page.waitForFunction(() => document.getElementById('making-picture')?.naturalWidth > 50, null, { timeout: 60000 });

/** The share of pixels of the picture that are not its white background. */
const inked = (page) => page.evaluate(() => {
  const img = document.getElementById('making-picture'), canvas = document.createElement('canvas');
  Object.assign(canvas, { width: img.naturalWidth, height: img.naturalHeight });
  const c = canvas.getContext('2d');
  c.drawImage(img, 0, 0);
  const d = c.getImageData(0, 0, canvas.width, canvas.height).data;
  return d.filter((v, i) => i % 4 === 1 && v < 200).length / (d.length / 4);
});

withPage({ program, project, executablePath, picture }, async ({ page, server }) => {
  await page.goto(server.url);
  await mode(page, 'capture');
  check('the capture can be used', await page.isEnabled('#make'));
  await accessible(page, 'a capture');
  await page.selectOption('#minutes', '60');
  await page.click('#make');
  await mode(page, 'reconstructing');
  await seen(page);
  const share = await inked(page);
  check(`the object is seen while it is made: ${(100 * share).toFixed(0)} % of the picture`, share > 0.02 && share < 0.9);
  await picture(page, '1-making');
  await tidy(page, 'making');
  await accessible(page, 'making');
  await zoomed(page, 'making');
  await page.click('#stop');
  await mode(page, 'capture');
  check('stopped: what is done is kept', (await state(page)).resume === true && (await page.textContent('#make')) === 'Go on where it stopped');
  await picture(page, '2-stopped');
  await page.click('#make');
  await mode(page, 'reconstructing');
  await seen(page);
  check('it goes on', true);
  await page.click('#stop');
  await mode(page, 'capture');
}).catch((error) => { console.error(error.message); process.exit(1); });

// SPDX-License-Identifier: Apache-2.0
// Helpers of browser tests for the editor's page.
const fs = require('node:fs');
const path = require('node:path');
const { withEditor } = require('./serve.cjs');
const axe = fs.readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

const kScale = 0.5;  // device pixels per pixel: pictures with a quarter of the pixels take a quarter of the time
const began = Date.now();
const say = (text) => console.log(`${((Date.now() - began) / 1000).toFixed(1)} s  ${text}`);

function check(what, condition) {
  if (!condition) throw new Error(`FAILED: ${what}`);
  say(what);
}

const state = (page) => page.evaluate(() => globalThis.cei3d.store.state);
/** @param {string} folder @returns {(page: any, name: string) => Promise<Buffer>} saves what the page shows */
const picturesIn = (folder) => async (page, name) => page.screenshot({ path: path.join(folder, `${name}.png`) });

/** Checks the page for violations of accessibility rules, in its dark and its light colors. */
async function accessible(page, name) {
  await page.evaluate(axe);
  for (const colorScheme of ['light', 'dark']) {
    await page.emulateMedia({ colorScheme });
    // Rules that are not about colors need not be checked twice.
    const runOnly = colorScheme === 'dark' ? ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa'] : { type: 'rule', values: ['color-contrast'] };
    const { violations } = await page.evaluate((only) => window.axe.run(document, { runOnly: only }), runOnly);
    for (const v of violations) console.log(v.id, v.help, v.nodes.slice(0, 3).map((n) => n.html.slice(0, 160)));
    check(`no violation of WCAG 2.2 AA, ${colorScheme}: ${name}`, violations.length === 0);
  }
}

/** Checks that the page's areas do not overlap and nothing is cut off. */
async function tidy(page, name) {
  const problems = await page.evaluate(() => {
    const areas = ['.bar', '#tools', '#stage', '#panels', '#strip', '.status'].map((s) => [s, document.querySelector(s)]).filter(([, n]) => n && n.offsetParent !== null || n?.getBoundingClientRect().width > 0);
    const out = [];
    for (const [a, x] of areas) for (const [b, y] of areas) {
      const p = x.getBoundingClientRect(), q = y.getBoundingClientRect();
      if (a < b && p.left < q.right - 1 && q.left < p.right - 1 && p.top < q.bottom - 1 && q.top < p.bottom - 1) out.push(`${a} ${b}`);
    }
    if (document.documentElement.scrollWidth > innerWidth || document.documentElement.scrollHeight > innerHeight) out.push('the page scrolls');
    return out;
  });
  check(`the page is tidy: ${name} ${problems}`, problems.length === 0);
}

/** Checks the page at a zoom of 200 %, which is a window of half the size. */
async function zoomed(page, name) {
  const size = page.viewportSize();
  await page.setViewportSize({ width: size.width / 2, height: size.height / 2 });
  await tidy(page, `${name}, 200 %`);
  await accessible(page, `${name}, 200 %`);
  await page.setViewportSize(size);
}

/** RGBA of pixels of the picture. */
const pixels = (page, list) => page.evaluate((at) => {
  const c = document.getElementById('picture').getContext('2d');
  return at.map(([x, y]) => [...c.getImageData(Math.round(x), Math.round(y), 1, 1).data]);
}, list);

/** The middle of the object's pixels, in pixels of the window (x, y) and of the picture (fx, fy); scale: from the former to the latter. */
const middle = (page) => page.evaluate(() => {
  const canvas = document.getElementById('picture'), { width, height } = canvas;
  const d = canvas.getContext('2d').getImageData(0, 0, width, height).data;
  let n = 0, sx = 0, sy = 0;
  for (let y = 0; y < height; y += 2) for (let x = 0; x < width; x += 2) if (d[4 * (y * width + x) + 3] > 200) { n += 1; sx += x; sy += y; }
  const r = canvas.getBoundingClientRect(), s = r.width / width;
  return { n, scale: 1 / s, fx: sx / n, fy: sy / n, x: r.left + (sx / n) * s, y: r.top + (sy / n) * s };
});

async function drag(page, from, to, options = {}) {
  await page.mouse.move(...from);
  await page.mouse.down(options);
  await page.mouse.move((from[0] + to[0]) / 2, (from[1] + to[1]) / 2, { steps: 4 });
  await page.mouse.move(...to, { steps: 4 });
  await page.mouse.up(options);
}

/** Sets a slider or list to a value, as a user who moves and releases it. */
const put = (page, selector, value) => page.locator(selector).evaluate((node, v) => {
  node.value = v;
  for (const type of ['input', 'change']) node.dispatchEvent(new Event(type));
}, String(value));

/** PSNR of what the page draws against the program's refined frame of the same camera, on white, 8 bits. */
const likeness = (page) => page.evaluate(() => {
  const { stage } = globalThis.cei3d, { width, height } = stage.picture;
  stage.live.draw(stage.json(), stage.channel, stage.light);
  const copy = document.createElement('canvas');
  const pixels = (source) => {
    copy.width = width;
    copy.height = height;
    const c = copy.getContext('2d');
    c.fillStyle = '#fff';
    c.fillRect(0, 0, width, height);
    c.drawImage(source, 0, 0);
    return c.getImageData(0, 0, width, height).data;
  };
  const a = pixels(stage.live.canvas), b = pixels(stage.picture);
  let sum = 0;
  for (let i = 0; i < a.length; ++i) if (i % 4 !== 3) sum += (a[i] - b[i]) ** 2;
  return 10 * Math.log10(255 ** 2 / (sum / (3 * a.length / 4)));
});

/**
 * Opens the project in a browser and runs a test in it. Fails if the page logs an error.
 * @param {{program: string, project: string, executablePath: string, picture: (page: any, name: string) => Promise<Buffer>, flags?: string[]}} what
 * @param {(at: {page: any, context: any, server: import('./serve.cjs').Server, restart: () => Promise<void>, errors: string[]}) => Promise<void>} test
 */
async function withPage({ program, project, executablePath, picture, flags }, test) {
  await withEditor({ program, project, executablePath, flags }, async (editor) => {
    const at = /** @type {any} */ (Object.assign(editor, { errors: [] }));
    at.context = await at.browser.newContext({ viewport: { width: 1280, height: 720 }, deviceScaleFactor: kScale, acceptDownloads: true, colorScheme: 'dark', reducedMotion: 'reduce' });
    at.page = await at.context.newPage();
    at.page.on('pageerror', (error) => at.errors.push(String(error)));
    at.page.on('console', (m) => { if (m.type() === 'error' && !/Failed to load resource|WebSocket connection/.test(m.text())) at.errors.push(m.text()); });
    try {
      await test(at);
      check(`no errors in the page ${at.errors.join('\n')}`, at.errors.length === 0);
    } catch (error) {
      await picture(at.page, 'failed').catch(() => {});
      console.log(at.errors.join('\n'));
      throw error;
    }
  });
}

module.exports = { say, check, state, picturesIn, accessible, tidy, zoomed, pixels, middle, drag, put, likeness, withPage };

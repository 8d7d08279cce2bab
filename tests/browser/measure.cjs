// SPDX-License-Identifier: Apache-2.0
// measure.cjs PROGRAM PROJECT CHROMIUM: how fast and how true the live editor is; prints a table. PROJECT is copied before
// it is changed. Times of the page are with software rendering, as everything headless.
const { execFileSync } = require('node:child_process');
const fs = require('node:fs');
const path = require('node:path');
const zlib = require('node:zlib');
const { withEditor, settled, megabytes, median } = require('./serve.cjs');
const { likeness } = require('./page.cjs');

const [program, original, executablePath] = process.argv.slice(2);

const row = (what, value) => console.log(`| ${what} | ${value} |`);
const ms = (t) => `${Math.round(t)} ms`;

/** The size of the editor's page and of the files that it names. */
function bundle() {
  const web = path.join(__dirname, '../../src/web'), page = fs.readFileSync(path.join(web, 'editor/index.html'));
  const named = new Set([...page.toString().matchAll(/(?:href|src)="\/app\/([^"]+)"/g)].map((m) => m[1]));
  let raw = 0, packed = 0;
  for (const bytes of [page, ...[...named].map((name) => fs.readFileSync(path.join(web, name)))]) {
    raw += bytes.length;
    packed += zlib.gzipSync(bytes).length;
  }
  row('size of the page, raw and gzipped', `${Math.round(raw / 1000)} kB, ${Math.round(packed / 1000)} kB`);
}

async function look(page) {
  const views = await page.evaluate(() => globalThis.cei3d.store.object.views.map((v) => v.name));
  const chosen = [0, 1, 2, 3].map((i) => views[Math.floor((i + 0.5) * views.length / 4)]);
  const still = [], turned = [];
  for (const name of chosen) {
    await page.evaluate((n) => {
      const { stage, store } = globalThis.cei3d;
      stage.light = { rotate: 0, scale: 1 };
      stage.camera.take(store.object.views.find((v) => v.name === n).camera);
      stage.moved();
    }, name);
    await settled(page);
    still.push(await likeness(page));
    await page.evaluate(() => {
      const { stage } = globalThis.cei3d;
      stage.light = { rotate: 60, scale: 1 };
      stage.moved();
    });
    await settled(page);
    turned.push(await likeness(page));
  }
  await page.evaluate(() => { globalThis.cei3d.stage.light = { rotate: 0, scale: 1 }; globalThis.cei3d.stage.moved(); });
  await settled(page);
  const text = (list) => `${(list.reduce((a, b) => a + b) / list.length).toFixed(1)} dB (${list.map((v) => v.toFixed(1)).join(', ')})`;
  row('page against the exact frame, on white, 4 views', text(still));
  row('the same, light turned by 60 degrees', text(turned));
}

async function frames(page) {
  const times = await page.evaluate(async () => {
    const { steps } = await import(document.querySelector('link[href$="pace.js"]').href);
    const { stage } = globalThis.cei3d, { live } = stage, gl = live.renderer.gl, camera = stage.camera.json(512, 512);
    for (let i = 0; i < 12; ++i) await live.drawSoon(camera, 'rgb', stage.light);
    await live.refreshCoarse();
    const time = (step) => {
      const t = performance.now();
      live.draw(camera, 'rgb', stage.light, step);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      return performance.now() - t;
    };
    const all = steps.map((step) => Array.from({ length: 12 }, () => time(step)));
    return { all, chosen: steps.indexOf(live.pace.step), coarse: live.renderer.corners.coarse / 3 };
  });
  row('one frame of the page for 512 x 512, in software, by the steps of pace.js', times.all.map((t) => ms(median(t))).join(', '));
  row('the step it takes while something moves; coarse triangles', `${times.chosen}; ${times.coarse}`);
}

/** The time from an action until a condition holds; both are evaluated in the page. */
const timed = (page, action, holds) => page.evaluate(async ([a, h]) => {
  const wait = (f) => new Promise((resolve) => { const step = () => (f() ? resolve() : setTimeout(step, 2)); step(); });
  const t = performance.now();
  new Function('cei3d', a)(globalThis.cei3d);
  await wait(new Function('cei3d', `return ${h}`).bind(null, globalThis.cei3d));
  return performance.now() - t;
}, [action, holds]);

async function edits(page) {
  const rough = (v) => `cei3d.stage.exact = null; cei3d.store.change('edit', { op: 'material', params: { roughness: ${v} }, amend: ${v !== 0.3} })`;
  await timed(page, rough(0.3), 'cei3d.settled()');
  const release = [], undo = [], picture = [];
  for (const v of [0.4, 0.5, 0.6]) release.push(await timed(page, rough(v), 'cei3d.store.saving === 0 && cei3d.stage.exact !== null'));
  await settled(page);
  for (const step of ['undo', 'redo', 'undo', 'redo', 'undo']) {
    undo.push(await timed(page, `cei3d.stage.exact = null; cei3d.store.change('${step}')`, 'cei3d.store.saving === 0 && cei3d.stage.live.current()'));
    picture.push(await timed(page, '', 'cei3d.stage.exact !== null'));
    await settled(page);
  }
  row('slider released to exact frame', ms(median(release)));
  row('undo to right picture of the page; to exact frame', `${ms(median(undo))}; ${ms(median(undo) + median(picture))}`);
}

async function paints(page, project) {
  await page.keyboard.press('b');
  const box = await page.locator('#view').boundingBox();
  const times = [];
  for (let i = 0; i < 3; ++i) {
    const x = box.x + box.width / 2, y = box.y + box.height / 2 + 12 * i;
    await page.mouse.move(x - 20, y);
    await page.mouse.down();
    await page.mouse.move(x + 20, y, { steps: 4 });
    await page.mouse.up();
    const n = await page.evaluate(() => globalThis.cei3d.store.state.done);
    times.push(await timed(page, "document.getElementById('view').dispatchEvent(new Event('x')); cei3d.keepPaint()", `cei3d.store.state.done > ${n}`));
    await settled(page);
  }
  row('paint kept, from the last dab', ms(median(times)));
  const id = fs.readdirSync(path.join(project, 'edits')).find((n) => n.endsWith('-paint'));
  const stroke = JSON.parse(fs.readFileSync(path.join(project, 'edits', id, 'edit.json'))).params.strokes[0];
  const camera = path.join(path.dirname(project), 'camera.json'), copy = path.join(path.dirname(project), 'copy');
  fs.writeFileSync(camera, JSON.stringify({ cameras: [{ ...stroke.camera, name: 'own' }] }));
  fs.cpSync(original, copy, { recursive: true });
  const t = Date.now();
  execFileSync(program, ['edit', copy, 'paint', '--camera', camera, '--scribble', path.join(project, 'edits', id, 'scribble.png'), '--quiet']);
  row('the same by the command line', ms(Date.now() - t));
}

/** A handle in the middle of the object, dragged for two seconds; then what the program computes of it. Returns that edit's parameters. */
async function bends(page) {
  await page.keyboard.press('j');
  const box = await page.locator('#view').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction(() => globalThis.cei3d.bend.points.length === 1, null, { timeout: 10000 });
  const dragged = await page.evaluate(async () => {
    const { bend, stage } = globalThis.cei3d, [point] = bend.points, size = globalThis.cei3d.store.object.radius;
    const pull = async (k) => {
      point.to = point.from.map((v, i) => v + 0.1 * size * stage.camera.axes[0][i] * Math.sin(k / 5));
      bend.preview();
      await new Promise(requestAnimationFrame);
      await stage.live.drawing;
    };
    while (!stage.pulling) await pull(1);  // until the code for it is loaded
    for (let k = 0; k < 12; ++k) await pull(k);
    const began = performance.now();
    let drawn = 0;
    for (; performance.now() < began + 2000; ++drawn) await pull(drawn);
    return drawn / (performance.now() - began) * 1000;
  });
  const made = await page.evaluate(async () => {
    const { postJson } = await import(document.querySelector('link[href$="api.js"]').href);
    const params = globalThis.cei3d.bend.params(), all = [];
    let report;
    for (let k = 0; k < 5; ++k) {
      const t = performance.now();
      ({ report } = await postJson('preview', { op: 'deform', params: { ...params, to: params.to.map((v) => v * (1 + 0.01 * k)) } }));
      all.push(performance.now() - t);
    }
    return { all, vertices: report.vertices, params };
  });
  await page.evaluate(() => globalThis.cei3d.bend.drop());
  await settled(page);
  row('a dragged handle: pictures of the page', `${dragged.toFixed(1)} a second`);
  row(`the same by the program, ${made.vertices} vertices`, ms(median(made.all)));
  return made.params;
}

/** Pictures of the page while the camera turns for `seconds`: milliseconds between them. */
const orbit = (page, seconds) => page.evaluate(async (time) => {
  const { stage } = globalThis.cei3d, gaps = [], end = performance.now() + 1000 * time;
  for (let before = performance.now(); before < end;) {
    stage.camera.orbit(0.05, 0);
    stage.moved();
    await new Promise(requestAnimationFrame);
    await stage.live.drawing;
    gaps.push(performance.now() - before);
    before = performance.now();
  }
  return gaps;
}, seconds);

/** The camera turns alone, and while the program computes an edit again and again. @param {object} bend its parameters */
async function turns(page, bend) {
  await orbit(page, 1);
  const alone = await orbit(page, 3);
  const busy = page.evaluate(async (params) => {
    const { postJson } = await import(document.querySelector('link[href$="api.js"]').href);
    for (const end = performance.now() + 3000; performance.now() < end;) await postJson('preview', { op: 'deform', params });
  }, bend);
  const beside = await orbit(page, 3);
  await busy;
  const text = (list) => `${ms(median(list))}, at most ${ms(Math.max(...list))}`;
  row('the camera turns: between pictures, alone; while the program bends the object', `${text(alone)}; ${text(beside)}`);
  await settled(page);
}

/** Clicks for the network, if it is installed: the first one, others in the same view, and what they select in all views. */
async function clicks(page) {
  if (!await page.evaluate(() => globalThis.cei3d.store.object.segment)) return row('clicks for the network', 'not installed');
  const times = await page.evaluate(async () => {
    const { postJson } = await import(document.querySelector('link[href$="api.js"]').href), { stage } = globalThis.cei3d;
    const camera = stage.json(), x = camera.width / 2, y = camera.height / 2;
    const time = async (n, views) => {
      const positive = Array.from({ length: n }, (_, i) => [x + 2 * i, y + i]), t = performance.now();
      await postJson('preview', { op: 'part', params: { camera, positive, segmenter: 'sam', ...views } });
      return performance.now() - t;
    };
    const own = [];
    for (let n = 1; n <= 4; ++n) own.push(await time(n, { views: 1 }));
    return { own, all: [await time(4, {}), await time(3, {})] };
  });
  const [first, ...more] = times.own;
  row('a click for the network, by its own view: the first, with the loading of it; another one', `${ms(first)}; ${more.map(ms).join(', ')}`);
  row('the same by all views: the first time; with another click', times.all.map(ms).join('; '));
}

withEditor({ program, project: original, executablePath, copy: true }, async (at) => {
  const { server, project } = at, page = await at.browser.newPage({ viewport: { width: 868, height: 674 } });
  const start = Date.now();
  await page.goto(server.url);
  await page.waitForFunction(() => document.getElementById('cover').classList.contains('done'), null, { polling: 10 });
  const first = Date.now() - start;
  await page.waitForFunction(() => globalThis.cei3d.stage.live.current(), null, { polling: 10 });
  const lit = Date.now() - start;
  await page.waitForFunction(() => globalThis.cei3d.stage.exact !== null, null, { polling: 10 });
  const exact = Date.now() - start;
  await settled(page);
  console.log('| | |\n|---|---|');
  row('`open` to address', ms(1000 * at.seconds));
  row('page to first picture; to its own lit picture; to exact frame; refined', [first, lit, exact, Date.now() - start].map(ms).join('; '));
  await look(page);
  await frames(page);
  await edits(page);
  await paints(page, project);
  await turns(page, await bends(page));
  await clicks(page);
  row('memory of the program; of the page’s scripts', `${Math.round(megabytes(server.process.pid))} MB; ${Math.round((await page.evaluate(() => performance.memory.usedJSHeapSize)) / 1e6)} MB`);
  bundle();
}).catch((error) => { console.error(error); process.exit(1); });

// SPDX-License-Identifier: Apache-2.0
// editor.cjs PROGRAM PROJECT PICTURES CHROMIUM: a session with most tools of the live editor, in a browser, and with lost connections.
const fs = require('node:fs');
const { settled } = require('./serve.cjs');
const { say, check, state, picturesIn, accessible, tidy, pixels, middle, drag, put, likeness, withPage } = require('./page.cjs');

const [program, project, pictures, executablePath] = process.argv.slice(2);
fs.mkdirSync(pictures, { recursive: true });
const picture = picturesIn(pictures);

async function firstSession(page, url) {
  /** @type {string[]} */
  const asked = [];
  page.on('request', (r) => asked.push(new URL(r.url()).pathname));
  await page.goto(url);
  await page.waitForFunction(() => document.getElementById('cover').classList.contains('done'), null, { timeout: 30000 });
  say('first picture');
  await settled(page);
  check('the key left the address', !page.url().includes('k='));
  await picture(page, '1-open');
  await tidy(page, '1280 x 720');
  await accessible(page, 'open');

  const at = await middle(page);
  check('the object is in the picture', at.n > 800);
  const packs = asked.map((p) => p.startsWith('/api/pack/')), photos = asked.map((p) => p.startsWith('/api/photo/'));
  check('what the picture needs is asked for before photographs', packs.lastIndexOf(true) >= 4 && (photos.indexOf(true) < 0 || photos.indexOf(true) > packs.lastIndexOf(true)));
  check(`and not again and again: ${packs.filter(Boolean).length} packs`, packs.filter(Boolean).length <= 10);
  await drawsItself(page);
  const box = await page.locator('#view').boundingBox();
  const before = await page.evaluate(() => globalThis.cei3d.stage.json().center.join());
  await drag(page, [box.x + 30, box.y + box.height - 40], [box.x + 150, box.y + box.height - 60]);
  check('dragging beside the object turns it', before !== await page.evaluate(() => globalThis.cei3d.stage.json().center.join()));
  await settled(page);
  await page.keyboard.press('Home');
  await settled(page);
}

/** The number of vertices for which each input of the page's shader has values. */
const vertexCounts = (page) => page.evaluate(() => {
  const { gl, vertices } = globalThis.cei3d.stage.live.renderer;
  const bytes = { [gl.BYTE]: 1, [gl.UNSIGNED_BYTE]: 1, [gl.SHORT]: 2, [gl.UNSIGNED_SHORT]: 2, [gl.UNSIGNED_INT]: 4 };
  gl.bindVertexArray(vertices);
  const counts = Array.from({ length: 9 }, (_, i) => {
    const of = (what) => gl.getVertexAttrib(i, gl[`VERTEX_ATTRIB_ARRAY_${what}`]);
    gl.bindBuffer(gl.ARRAY_BUFFER, of('BUFFER_BINDING'));
    return gl.getBufferParameter(gl.ARRAY_BUFFER, gl.BUFFER_SIZE) / (of('STRIDE') || of('SIZE') * bytes[of('TYPE')]);
  });
  gl.bindVertexArray(null);
  return counts;
});

/** The picture that the page draws while something moves is close to the program's frame. */
async function drawsItself(page) {
  await page.waitForFunction(() => globalThis.cei3d.stage.live.current(), null, { timeout: 30000 });
  const counts = await vertexCounts(page);
  check(`every input has a value for every vertex: ${counts}`, new Set(counts).size === 1 && counts[0] > 100);
  const psnr = await likeness(page);
  check(`the page draws what the program does: ${psnr.toFixed(1)} dB`, psnr > 34);
}

async function paints(page) {
  const at = await middle(page);
  await page.keyboard.press('b');
  await page.fill('#brush-color', '#10c040');
  const [was] = await pixels(page, [[at.fx, at.fy]]);
  await drag(page, [at.x - 20, at.y], [at.x + 20, at.y]);
  await page.waitForTimeout(100);
  await picture(page, '2-stroke');
  await settled(page);
  check('a stroke is an edit', (await state(page)).done === 1);
  const [is] = await pixels(page, [[at.fx, at.fy]]);
  check(`the paint is green: ${was} to ${is}`, is[1] > is[0] + 40 && is[1] > is[2] + 20);
  await picture(page, '3-painted');
  await page.keyboard.press('Control+z');
  await settled(page);
  const [back] = await pixels(page, [[at.fx, at.fy]]);
  check('undo gives the same picture', back.join() === was.join() && (await state(page)).done === 0);
  await page.keyboard.press('Control+y');
  await settled(page);
  check('redo gives the same picture', (await pixels(page, [[at.fx, at.fy]]))[0].join() === is.join());
  await page.fill('#brush-color', '#0000ff');
  await page.focus('#view');
  await page.keyboard.press('i');
  await page.waitForFunction(() => document.getElementById('brush-color').value !== '#0000ff');
  const taken = await page.inputValue('#brush-color');
  const [r, g, b] = [1, 3, 5].map((i) => parseInt(taken.slice(i, i + 2), 16));
  check(`the eyedropper takes the paint's albedo: ${taken}`, g > 150 && r < 60 && b < 110);
}

async function selects(page) {
  const at = await middle(page);
  await page.keyboard.press('p');
  await page.fill('#part-name', 'side');
  // Not on the head: as this object is a rough one, a click there may select all of it, which is refused.
  await page.keyboard.down('Alt');
  await page.mouse.click(at.x - 110, at.y + 40);
  await page.keyboard.up('Alt');
  await page.mouse.click(at.x, at.y);
  await page.waitForFunction(() => globalThis.cei3d.store.state.mode === 'project' && document.querySelector('.toast')?.textContent.includes('% of the surface'), null, { timeout: 30000 });
  await picture(page, '4-part');
  await page.focus('#view');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => globalThis.cei3d.store.part === 'side', null, { timeout: 30000 });
  await settled(page);
  check('a part by a click', (await state(page)).parts[0].name === 'side');
  await picture(page, '5-part-kept');
  await accessible(page, 'a part is selected');
}

async function polishes(page) {
  await page.keyboard.press('v');
  await page.keyboard.press('m');
  const slider = page.locator('#properties input[data-key="roughness"]');
  const done = (await state(page)).done;
  for (const value of ['0.35', '0.15']) {
    await slider.evaluate((node, v) => { node.value = v; node.dispatchEvent(new Event('input')); }, value);
    await page.waitForTimeout(150);
    await slider.evaluate((node) => node.dispatchEvent(new Event('change')));
    await settled(page);
  }
  const now = await state(page);
  check('two drags of a slider are one step', now.done === done + 1);
  check('with the last value', now.history[now.done - 1].params.roughness === 0.15 && now.history[now.done - 1].params.part === 'side');
  await picture(page, '6-material');
  await accessible(page, 'material');
}

async function lights(page) {
  await page.keyboard.press('l');
  const strong = await page.evaluate(() => {
    const { stage } = globalThis.cei3d, slider = document.getElementById('light-scale');
    slider.value = '1';
    slider.dispatchEvent(new Event('input'));
    return [stage.light.scale, stage.isLive(), stage.asked];
  });
  check(`twice the light is shown by the page itself: ${strong}`, strong[0] === 2 && strong[1] && strong[2] === null);
  await settled(page);
  const psnr = await likeness(page);
  check(`as the program does: ${psnr.toFixed(1)} dB`, psnr > 34);
  await put(page, '#light-scale', 0);
  await put(page, '#light-rotate', 70);
  await settled(page);
  const done = (await state(page)).done;
  await picture(page, '7-light');
  await page.click('#light-keep');
  await page.waitForFunction((n) => globalThis.cei3d.store.state.done === n + 1, done, { timeout: 30000 });
  await settled(page);
  check('light is kept', (await state(page)).history.at(-1).params.rotate_degrees === 70);
}

async function compares(page) {
  await page.keyboard.press('v');
  await page.focus('#view');
  await page.keyboard.press('n');
  await settled(page);
  await page.keyboard.press('c');
  await page.waitForFunction(() => document.getElementById('photo').complete && !document.getElementById('photo').hidden);
  await page.waitForTimeout(400);
  await picture(page, '8-compare');
  await accessible(page, 'compare');
  await page.focus('#view');
  await page.keyboard.press('c');
  await page.keyboard.press('Home');
  await settled(page);
}

/** The file that a button of the dialog downloads. */
async function exported(page, title) {
  const [download] = await Promise.all([page.waitForEvent('download', { timeout: 60000 }), page.click(`[data-export="${title}"]`)]);
  const bytes = fs.readFileSync(await download.path());
  await page.waitForFunction(() => /downloads/.test(document.getElementById('export-note').textContent));
  return { name: download.suggestedFilename(), bytes };
}

/** No export overwrites the files of another format, or of the same format for another use. */
async function distinctNames(page) {
  const asked = [];
  await page.route('**/api/export', (route) => { asked.push(route.request().postDataJSON().file); return route.fulfill({ status: 400, json: { error: 'asked' } }); });
  const titles = ['GLB', 'glTF and files', 'USDZ', 'OBJ', 'PLY', 'Page', 'Light, HDR', 'Light, EXR'];
  for (const purpose of ['', 'web', 'ar', 'dcc']) {
    await page.selectOption('#export-for', purpose);
    for (const title of purpose ? titles.slice(0, 4) : titles) {
      const n = asked.length;
      await page.click(`[data-export="${title}"]`);
      await page.waitForFunction(() => /asked/.test(document.getElementById('export-note').textContent));
      check(`${title} is asked for`, asked.length === n + 1);
    }
  }
  await page.unroute('**/api/export');
  // Files that belong to a .gltf or an .obj have its name without the ending.
  const stems = asked.map((file) => (/\.(gltf|obj)$/.test(file) ? file.replace(/\.\w+$/, '') : file));
  check(`names of exports differ: ${asked.join(' ')}`, new Set(stems).size === asked.length);
}

async function exports(page) {
  await page.click('#export');
  await page.waitForSelector('#dialog[open]');
  await accessible(page, 'export');
  await picture(page, '9-export');
  check('an export arrives', (await exported(page, 'PLY')).bytes.subarray(0, 3).toString() === 'ply');
  await distinctNames(page);
  await page.locator('#dialog details').evaluate((node) => { node.open = true; });
  await page.selectOption('#export-for', 'web');
  await page.fill('#export-faces', '400');
  await page.selectOption('#export-texture', '512');
  await page.fill('#export-size', '0.25');
  await page.fill('#export-turntable', '2');
  await accessible(page, 'export with options');
  const glb = await exported(page, 'GLB'), json = JSON.parse(glb.bytes.subarray(20, 20 + glb.bytes.readUInt32LE(12)));
  const { min, max } = json.accessors.find((a) => a.min), node = json.nodes.find((n) => n.scale);
  const side = Math.max(...max.map((v, k) => (v - min[k]) * (node?.scale[k] ?? 1)));
  check(`GLB for the web, ${side.toFixed(3)} m: ${glb.name}`, glb.name === 'spot-web.glb' && json.images[0].mimeType === 'image/jpeg' && Math.abs(side - 0.25) < 0.01);
  check('a page in one file', (await exported(page, 'Page')).bytes.subarray(0, 9).toString().toLowerCase() === '<!doctype');
  check('the light as OpenEXR', (await exported(page, 'Light, EXR')).bytes.readUInt32LE(0) === 20000630);
  const turntable = await exported(page, 'Turntable');
  check('a turntable', turntable.name === 'spot-turntable.zip' && [0, 1].every((i) => turntable.bytes.includes(`turn_00${i}.png`)) && !turntable.bytes.includes('turn_002.png'));
  await page.fill('#export-faces', '1');
  await page.click('[data-export="PLY"]');
  await page.waitForFunction(() => /has 4 to/.test(document.getElementById('export-note').textContent));
  check('what cannot be exported is said in the dialog', true);
  await page.keyboard.press('Escape');
  await page.keyboard.press('?');
  await page.waitForSelector('#dialog[open]');
  await picture(page, '10-help');
  await accessible(page, 'help');
  await page.keyboard.press('Escape');
}

async function twoWindows(context, page, url) {
  const other = await context.newPage();
  await other.goto(url);
  await settled(other);
  const before = (await state(page)).done;
  check('a second window shows the same history', (await state(other)).done === before);
  await other.keyboard.press('Control+z');
  await page.waitForFunction((n) => globalThis.cei3d.store.state.done === n - 1, before, { timeout: 20000 });
  await other.waitForFunction((r) => globalThis.cei3d.store.state.revision === r, (await state(page)).revision, { timeout: 20000 });
  say('undo in one window is seen in the other');
  // A window that reconnects gets the messages that it missed, and needs no full state.
  const asked = [];
  other.on('request', (r) => asked.push(new URL(r.url()).pathname));
  await other.evaluate(() => { const { line } = globalThis.cei3d.store; line.wait = 600000; line.socket.close(); });
  await other.waitForFunction(() => !globalThis.cei3d.store.line.ready);
  await page.evaluate(() => globalThis.cei3d.store.change('redo'));
  check('a window without connection does not know', (await state(other)).done === before - 1);
  await other.evaluate(() => { const { line } = globalThis.cei3d.store; clearTimeout(line.timer); line.open(); });
  await other.waitForFunction((n) => globalThis.cei3d.store.state.done === n && !globalThis.cei3d.store.lost, before, { timeout: 20000 });
  check('a window that was away for a while gets what it missed', asked.filter((p) => p === '/api/state').length === 1);
  await settled(page);
  await other.close();
}

/** kill -9 while a stroke is drawn: acknowledged edits are stored, and the stroke is sent when the program is back. */
async function dies(page, server) {
  const before = await state(page);
  const at = await middle(page);
  await page.keyboard.press('b');
  await page.mouse.move(at.x - 15, at.y + 12);
  await page.mouse.down();
  await page.mouse.move(at.x, at.y + 12, { steps: 3 });
  await server.kill();
  await page.mouse.move(at.x + 15, at.y + 12, { steps: 3 });
  await page.mouse.up();
  await page.waitForFunction(() => !document.getElementById('banner').hidden, null, { timeout: 10000 });
  check('the page says that the program is gone', true);
  await picture(page, '11-lost');
  await accessible(page, 'lost connection');
  const log = JSON.parse(require('node:child_process').execFileSync(program, ['log', project, '--json']));
  check('every acknowledged edit is there', log.edits.length === before.history.length);
}

/** Presses Tab until an element has the focus. */
async function tabTo(page, selector) {
  for (let i = 0; i < 80; ++i) {
    if (await page.evaluate((s) => document.activeElement?.matches(s), selector)) return;
    await page.keyboard.press('Tab');
  }
  throw new Error(`FAILED: Tab does not get to ${selector}`);
}

const steps = (page, n) => page.waitForFunction((m) => globalThis.cei3d.store.state.done === m, n, { timeout: 30000 });

/** From the start view to an exported object without a mouse. */
async function keyboardOnly(page) {
  const { keyboard } = page, { done } = await state(page);
  await page.evaluate(() => { document.activeElement?.blur(); globalThis.cei3d.store.select(null); });
  await keyboard.press('ArrowLeft');
  await settled(page);
  await keyboard.press('b');
  for (const [key, share] of [['4', '0.4'], ['0', '1']]) {
    await keyboard.press(key);
    check(`${key} is an opacity of ${share}`, (await page.inputValue('#brush-opacity')) === share);
  }
  await keyboard.press('.');
  for (const key of ['ArrowUp', ',', 'ArrowRight', 'ArrowLeft', 'Enter']) await keyboard.press(key);
  await settled(page);
  check('painting by keys alone', (await state(page)).done === done + 1);
  await keyboard.press('Control+z');
  await settled(page);
  for (const key of ['g', ',', 'ArrowRight', 'ArrowLeft', 'ArrowLeft']) await keyboard.press(key);
  await page.waitForFunction(() => globalThis.cei3d.stage.preview !== null, null, { timeout: 30000 });
  for (const key of ['Escape', 'ArrowRight']) await keyboard.press(key);
  await settled(page);
  check('grabbing by keys alone, and canceled', (await state(page)).done === done && await page.evaluate(() => globalThis.cei3d.stage.preview === null));
  await keyboard.press('p');
  const walk = async (keys) => { for (const [key, times] of Object.entries(keys)) for (let i = 0; i < times; ++i) await keyboard.press(key); };
  await walk({ ArrowLeft: 9, ArrowDown: 4 });
  await keyboard.press('Alt+ ');
  await walk({ ArrowRight: 9, ArrowUp: 3 });
  await keyboard.press(' ');
  await page.waitForFunction(() => globalThis.cei3d.stage.preview !== null || document.querySelector('#part-keep:enabled') !== null);
  await tabTo(page, '#part-name');
  await keyboard.type('front');
  await tabTo(page, '#part-keep');
  await keyboard.press('Enter');
  await page.waitForFunction(() => globalThis.cei3d.store.part === 'front', null, { timeout: 30000 });
  await settled(page);
  await keyboard.press('m');
  await tabTo(page, '[data-key="metalness"]');
  for (let i = 0; i < 3; ++i) await keyboard.press('ArrowRight');
  await settled(page);
  check('a part and its material by keys alone', (await state(page)).parts.some((p) => p.name === 'front') && (await state(page)).history[done + 1].params.part === 'front');
  await keyboard.press('l');
  await tabTo(page, '#light-rotate');
  for (let i = 0; i < 5; ++i) await keyboard.press('ArrowRight');
  await tabTo(page, '#light-keep');
  await keyboard.press('Enter');
  await steps(page, done + 3);
  check('light by keys alone', (await state(page)).history[done + 2].params.rotate_degrees === 5);
  await settled(page);
  await keyboard.press('Control+s');
  await page.waitForSelector('#dialog[open]');
  await tabTo(page, '[data-export="PLY"]');
  const [download] = await Promise.all([page.waitForEvent('download'), keyboard.press('Enter')]);
  check('export by keys alone', download.suggestedFilename() === 'spot.ply');
  await keyboard.press('Escape');
  await tabTo(page, '#view');
  await keyboard.press('.');
  await keyboard.press('u');
  check('the panels can be hidden', await page.isHidden('#panels'));
  await keyboard.press('u');
}

/** Steps that a command made while no window was open get pictures, too. */
async function commandsHavePictures(at) {
  const { page } = at, { done } = await state(page);
  await at.server.kill();
  for (const roughness of ['0.4', '0.6']) require('node:child_process').execFileSync(program, ['edit', project, 'material', '--roughness', roughness, '--quiet']);
  await at.restart();
  await page.goto(at.server.url);
  await steps(page, done + 2);
  await page.waitForFunction((n) => [n + 1, n + 2].every((step) => document.querySelector(`#history li[data-step="${step}"] img.thumb`)), done, { timeout: 60000 });
  say('steps that a command made have pictures');
}

withPage({ program, project, executablePath, picture }, async (at) => {
  const { page } = at;
  await firstSession(page, at.server.url);
  await paints(page);
  await selects(page);
  await polishes(page);
  await lights(page);
  await compares(page);
  await exports(page);
  await keyboardOnly(page);
  await twoWindows(at.context, page, at.server.url);
  const revision = (await state(page)).revision, thumbs = await page.locator('#history img.thumb').count();
  await page.reload();
  await settled(page);
  check('a reload shows the same', (await state(page)).revision === revision);
  check('with the pictures of its history', thumbs > 1 && await page.locator('#history img.thumb').count() >= thumbs);
  const { done } = await state(page);
  await dies(page, at.server);
  await at.restart();
  await page.goto(at.server.url);
  await page.waitForFunction((n) => globalThis.cei3d.store.state.done === n + 1, done, { timeout: 20000 });
  await settled(page);
  check('what was drawn meanwhile is saved when the program is back', true);
  const aside = page.locator('#history details');
  check('what was undone and then displaced is set aside', (await aside.locator('summary').textContent()).startsWith('1 set aside'));
  await aside.locator('summary').click();
  await accessible(page, 'edits that are set aside');
  await commandsHavePictures(at);
  await page.setViewportSize({ width: 820, height: 1180 });
  await settled(page);
  await tidy(page, 'tablet');
  await picture(page, '12-tablet');
}).catch((error) => { console.error(error.message); process.exit(1); });

// SPDX-License-Identifier: Apache-2.0
// states.cjs PROGRAM FOLDER PICTURES CHROMIUM: what the editor shows when there is nothing to edit. FOLDER has an empty folder, a broken
// object and an object, named empty, broken and object. Opens each of them, the last one also read-only, in a browser without WebGL 2, and
// when its program ends; then FOLDER itself.
const fs = require('node:fs');
const path = require('node:path');
const { settled } = require('./serve.cjs');
const { check, state, picturesIn, accessible, tidy, zoomed, middle, pixels, withPage } = require('./page.cjs');

const [program, folder, pictures, executablePath] = process.argv.slice(2);
fs.mkdirSync(pictures, { recursive: true });
const picture = picturesIn(pictures);
const opened = (name, flags, test) => withPage({ program, project: path.join(folder, name), executablePath, picture, flags }, test);
const mode = (page, name) => page.waitForFunction((m) => globalThis.cei3d?.store.state.mode === m && document.querySelector('#place .column'), name, { timeout: 30000 });

async function explainsItself({ page, context, server }) {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.goto(server.url);
  await mode(page, 'library');
  check('an empty folder offers the sample', (await page.getByRole('button', { name: 'Try the sample' }).count()) === 1);
  await page.getByRole('button', { name: 'Copy' }).click();
  await page.locator('.toast').waitFor();
  const command = await page.evaluate(() => navigator.clipboard.readText());
  check(`and the command for bare photographs: ${command}`, command === `cei3d capture PHOTOS -o ${path.resolve(folder, 'empty/capture')}`);
  await picture(page, 'empty');
  await tidy(page, 'empty');
  await accessible(page, 'an empty folder');
  await zoomed(page, 'an empty folder');
}

async function offersWhatThereIs({ page, server }) {
  await page.goto(server.url);
  await mode(page, 'library');
  const cards = await page.locator('.card b').allTextContents();
  check(`a folder's objects can be chosen: ${cards}`, cards.join() === 'broken,object');
  await picture(page, 'library');
  await tidy(page, 'library');
  await accessible(page, 'a folder');
  await zoomed(page, 'a folder');
  await page.getByRole('button', { name: 'Try the sample' }).click();
  await mode(page, 'capture');
  check('what the check found is shown', (await page.locator('.card').count()) >= 3);
  await picture(page, 'check');
  await accessible(page, 'what the check found');
  await zoomed(page, 'what the check found');
}

async function missesItsKey({ page, server }) {
  await page.goto(server.url.replace(/#.*/, ''));
  await page.getByRole('heading', { name: 'The key is missing' }).waitFor();
  await page.waitForFunction(() => globalThis.cei3d?.store.lost, null, { timeout: 30000 });
  check('without a key the page says one thing only', await page.isHidden('#banner'));
  await picture(page, 'without-key');
  await accessible(page, 'a missing key');
  await zoomed(page, 'a missing key');
}

async function losesItsProgram({ page, server, restart }) {
  const says = (text) => page.waitForFunction((t) => document.getElementById('banner').innerText.includes(t), text, { timeout: 30000 });
  await page.goto(server.url);
  await settled(page);
  await server.kill();
  await says('does not answer');
  await accessible(page, 'a lost connection');
  await restart();
  await says('restarted');
  check('another program at the same address has another key', true);
  await picture(page, 'restarted');
  await accessible(page, 'a restarted program');
}

async function saysWhatFailed({ page, server }) {
  await page.goto(server.url);
  await mode(page, 'failed');
  check(`the error is shown: ${(await state(page)).error}`, (await page.textContent('#place')).includes('scene.json'));
  await picture(page, 'failed-to-open');
  await accessible(page, 'what cannot be opened');
}

async function opensReadOnly({ page, server }) {
  await page.goto(server.url);
  await settled(page);
  const tools = await page.locator('#tools button:enabled').evaluateAll((list) => list.map((b) => b.dataset.tool));
  check(`read-only: ${tools}`, tools.join() === 'look,light');
  await page.keyboard.press('b');
  check('the brush stays where it is', await page.evaluate(() => document.querySelector('[data-tool="look"]').getAttribute('aria-checked')) === 'true');
  await accessible(page, 'read-only');
  await page.click('#export');
  await page.waitForSelector('#dialog[open]');
  check('nothing but the picture can be saved', (await page.locator('[data-export]').evaluateAll((list) => list.map((b) => b.dataset.export))).join() === 'Picture');
  await accessible(page, 'read-only, export');
}

const chosen = (page) => page.getAttribute('#tools [aria-checked="true"]', 'data-tool');

/** Keys that type characters can be switched off everywhere but on the view. */
async function hasNoSingleKeys({ page, server }) {
  const press = async (focus, key) => {
    await page.focus(focus);
    await page.keyboard.press(key);
    return chosen(page);
  };
  const put = async (on) => {
    await page.click('#help');
    await page.setChecked('#single-keys', on);
    await page.keyboard.press('Escape');
  };
  await page.goto(server.url);
  await settled(page);
  await put(false);
  check('a single key is off beside the view', (await press('#export', 'b')) === 'look');
  check('and acts on it', (await press('#view', 'b')) === 'paint');
  await page.reload();
  await settled(page);
  check('after a reload it is still off', (await press('#export', 'b')) === 'look');
  await put(true);
  check('switched on it acts everywhere', (await press('#export', 'b')) === 'paint');
}

/** Plays that a reconstruction has ended, without running one. */
async function startsWithPaint({ page, server }) {
  const after = (mode) => page.evaluate((m) => { const { store } = globalThis.cei3d; store.state = { ...store.state, mode: m }; return store.refresh(); }, mode);
  await page.goto(server.url);
  await settled(page);
  check('an object that is opened has the tool for looking', (await chosen(page)) === 'look');
  await after('reconstructing');
  check('one that was just made can be painted at once', (await chosen(page)) === 'paint');
  check('and a message says how', (await page.textContent('#toasts')).includes('Drag on the object to paint'));
  await settled(page);
  await accessible(page, 'an object that was just made');
  await zoomed(page, 'painting');
  await settled(page);
  await after('library');
  check('and later, too', (await chosen(page)) === 'look');
}

/** A page without WebGL shows the program's frames only. */
async function hasNoWebGl({ page, server }) {
  await page.goto(server.url.replace('/#', '/?frames#'));
  await settled(page);
  check('the page does not draw by itself', await page.evaluate(() => globalThis.cei3d.stage.live.renderer === null));
  check('the object is in the picture', (await middle(page)).n > 800);
  const quick = page.evaluate(() => new Promise((resolve) => {
    const { stage } = globalThis.cei3d, { finish } = stage, frames = [];
    stage.finish = (frame) => { frames.push(stage.asked?.kind); finish.call(stage, frame); if (stage.settled()) resolve(frames); };
  }));
  await page.focus('#view');
  for (let i = 0; i < 6; ++i) await page.keyboard.press('ArrowLeft');
  const kinds = await quick;
  await settled(page);
  check(`while it turns there are small frames, then the exact ones: ${kinds}`, kinds[0] === 'quick' && kinds.slice(-2).join() === 'rest,rest');
  await page.keyboard.press('b');
  const at = await middle(page), [was] = await pixels(page, [[at.fx, at.fy]]);
  await page.fill('#brush-color', '#10c040');
  await page.mouse.click(at.x, at.y);
  await page.waitForFunction(() => globalThis.cei3d.store.state.done === 1, null, { timeout: 30000 });
  await settled(page);
  const [is] = await pixels(page, [[at.fx, at.fy]]);
  check(`and it can be painted: ${was} to ${is}`, is[1] > is[0] + 40 && is[1] > is[2] + 20);
  await picture(page, 'without-webgl');
}

(async () => {
  await opened('empty', [], explainsItself);
  await opened('broken', [], saysWhatFailed);
  await opened('object', ['--read-only'], opensReadOnly);
  await opened('object', [], startsWithPaint);
  await opened('object', [], hasNoSingleKeys);
  await opened('object', [], hasNoWebGl);
  await opened('object', [], losesItsProgram);
  await opened('object', [], missesItsKey);
  await opened('.', [], offersWhatThereIs);
})().catch((error) => { console.error(error.message); process.exit(1); });

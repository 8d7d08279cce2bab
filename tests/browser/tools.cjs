// SPDX-License-Identifier: Apache-2.0
// tools.cjs PROGRAM PROJECT PICTURES CHROMIUM: the editor's tools for parts, shape, light and decals, in a browser.
const fs = require('node:fs');
const path = require('node:path');
const { settled } = require('./serve.cjs');
const { check, state, picturesIn, accessible, pixels, middle, drag, put, likeness, withPage } = require('./page.cjs');

const [program, project, pictures, executablePath] = process.argv.slice(2);
fs.mkdirSync(pictures, { recursive: true });
const picture = picturesIn(pictures);

const steps = (page, n) => page.waitForFunction((m) => globalThis.cei3d.store.state.done === m, n, { timeout: 60000 });
const last = async (page) => (await state(page)).history.filter((e) => e.done).at(-1);

/** Draws the outline of a box in the window with the mouse. */
async function lasso(page, x, y, half, modifier) {
  if (modifier) await page.keyboard.down(modifier);
  await page.mouse.move(x - half, y - half);
  await page.mouse.down();
  for (const [dx, dy] of [[1, -1], [1, 1], [-1, 1], [-1, -0.8]]) await page.mouse.move(x + half * dx, y + half * dy, { steps: 6 });
  await page.mouse.up();
  if (modifier) await page.keyboard.up(modifier);
}

async function keptLasso(page, x, y, half, modifier) {
  const { done } = await state(page);
  const asked = page.waitForResponse((r) => r.url().endsWith('/api/mask'));
  await lasso(page, x, y, half, modifier);
  await asked;
  await page.focus('#view');
  await page.keyboard.press('Enter');
  await steps(page, done + 1);
  await settled(page);
}

async function lassos(page) {
  const at = await middle(page);
  await page.keyboard.press('s');
  await page.fill('#part-name', 'patch');
  await keptLasso(page, at.x, at.y, 40);
  const first = (await state(page)).parts[0];
  check(`a lasso makes a part: ${(100 * first.share).toFixed(1)} %`, first.name === 'patch' && first.share > 0.001 && first.share < 0.5);
  await picture(page, '1-lasso');
  await accessible(page, 'lasso');
  await keptLasso(page, at.x + 60, at.y, 30, 'Shift');
  const more = (await state(page)).parts[0];
  check('with Shift it adds to the part', more.share > first.share && (await last(page)).params.add === 'patch');
  await keptLasso(page, at.x + 40, at.y, 20, 'Control');
  const less = (await state(page)).parts[0];
  check('with Ctrl it takes from it', less.share < more.share && (await last(page)).params.subtract === 'patch');
}

async function names(page) {
  const { done } = await state(page);
  const shown = () => page.textContent('#parts .label');
  await page.click('[data-rename="patch"]');
  await page.fill('#parts input', 'nose');
  await accessible(page, 'a part gets a name');
  await page.keyboard.press('Escape');
  check('Esc leaves the name', (await shown()) === 'patch');
  await page.click('[data-rename="patch"]');
  await page.fill('#parts input', 'nose');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.querySelector('#parts .label')?.textContent === 'nose', null, { timeout: 10000 });
  const now = await state(page);
  check('a part has the name that it was given, and commands know it', now.done === done && now.history.at(-1).name === 'nose' && now.parts[0].name === 'patch');
  const ball = await page.locator('#parts .swatch').evaluate((node) => [node.style.background, node.title]);
  check(`its color and material are beside it: ${ball[1]}`, ball[0].includes('radial-gradient') && /roughness 0\.\d\d/.test(ball[1]));
}

/** Compares the picture of the export dialog with a screenshot where the object is; elsewhere it must be white. */
async function savesWhatIsSeen(page) {
  // What was drawn last may not be on the screen yet.
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  const shot = await page.screenshot({ clip: await page.locator('#picture').boundingBox() });
  const { inside, worst, ground } = await page.evaluate(async (base64) => {
    const { stage } = globalThis.cei3d, { width, height } = stage.picture;
    const bytes = (source) => {
      const copy = Object.assign(document.createElement('canvas'), { width, height }), c = copy.getContext('2d');
      c.drawImage(source, 0, 0, width, height);
      return c.getImageData(0, 0, width, height).data;
    };
    const decoded = async (blob) => bytes(await createImageBitmap(blob));
    const screen = await decoded(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))])), saved = await decoded(await stage.snapshot());
    stage.live.draw(stage.json(), stage.channel, stage.light);
    const own = bytes(stage.live.canvas);
    let inside = 0, worst = 0;
    for (let y = 0.3 * height | 0; y < 0.7 * height; y += 3) for (let x = 0.35 * width | 0; x < 0.65 * width; x += 3) {
      const i = 4 * (y * width + x);
      if (own[i + 3] < 255) continue;
      ++inside;
      for (let k = 0; k < 3; ++k) worst = Math.max(worst, Math.abs(saved[i + k] - screen[i + k]));
    }
    return { inside, worst, ground: [...saved.subarray(0, 4)] };
  }, shot.toString('base64'));
  check(`a saved picture is that of the page, on white: ${inside} pixels, ${worst} levels, ${ground}`, inside > 200 && worst <= 2 && ground.every((v) => v === 255));
}

/** The key F moves the camera nearer to the selected part. */
async function framesPart(page) {
  const distance = () => page.evaluate(() => globalThis.cei3d.stage.camera.distance());
  await settled(page);
  await page.focus('#view');
  await page.keyboard.press('f');
  const near = await distance();
  const part = await page.evaluate(() => globalThis.cei3d.store.part);
  await page.evaluate(() => globalThis.cei3d.store.select(null));
  await page.keyboard.press('f');
  const far = await distance();
  check(`the part ${part} is framed from ${near.toFixed(2)}, the object from ${far.toFixed(2)}`, part !== null && near < 0.9 * far);
  await page.evaluate((name) => globalThis.cei3d.store.select(name), part);
  await page.keyboard.press('Home');
  await settled(page);
}

/** What the mask of a part covers of the picture, in pixels. */
const covered = (page) => page.evaluate(() => {
  const canvas = document.getElementById('overlay'), { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  return data.filter((alpha, i) => i % 4 === 3 && alpha > 0).length;
});

/** Selects a part, does something before the part's mask has arrived, and lets it arrive. */
async function beforeMask(page, part, action) {
  await page.evaluate(() => globalThis.cei3d.store.select(null));
  let acted;
  const over = new Promise((resolve) => { acted = resolve; });
  const asked = page.waitForRequest('**/api/mask'), arrived = page.waitForResponse('**/api/mask');
  await page.route('**/api/mask', async (route) => {
    await over;
    await route.continue();
  });
  await page.evaluate((name) => globalThis.cei3d.store.select(name), part);
  await asked;
  await action();
  acted();
  await (await arrived).finished();
  await page.unroute('**/api/mask');
  await page.waitForTimeout(200);  // for the page to decode it
}

async function hides(page) {
  const at = await middle(page);
  await page.keyboard.press('v');
  await settled(page);
  await page.focus('#view');
  await beforeMask(page, 'patch', () => {});
  const pixelsOfPart = await covered(page);
  check(`the mask of a selected part covers ${pixelsOfPart} pixels`, pixelsOfPart > 50);
  await beforeMask(page, 'patch', async () => {
    await page.keyboard.press('h');
    await settled(page);
  });
  check('a mask that arrives after the picture has changed is not shown', (await covered(page)) === 0);
  check('a part is hidden', (await page.getAttribute('[data-hide="patch"]', 'aria-pressed')) === 'true');
  const there = (p) => p.evaluate(([x, y]) => {
    const { stage } = globalThis.cei3d;
    return [stage.live.renderer.partAt(stage.json(), x, y, stage.live.hiddenIndices()), stage.live.renderer.partAt(stage.json(), x, y)];
  }, [at.fx, at.fy]);
  const [shown, whole] = await there(page);
  check(`what is seen there is not the part: ${shown}, ${whole}`, whole === 1 && shown !== 1);
  await picture(page, '2-hidden');
  await savesWhatIsSeen(page);
  await accessible(page, 'a part is hidden');
  await page.focus('#view');
  await page.keyboard.press('Shift+H');
  await settled(page);
  check('all parts are shown again', (await page.getAttribute('[data-hide="patch"]', 'aria-pressed')) === 'false');
}

async function bends(page) {
  const { done } = await state(page), at = await middle(page);
  await page.evaluate(() => globalThis.cei3d.store.select(null));
  await page.keyboard.press('j');
  const points = () => page.evaluate(() => globalThis.cei3d.bend.points.length);
  for (const [i, [dx, dy, pin]] of [[-50, 0, false], [50, 0, false], [0, 30, true]].entries()) {
    await page.selectOption('#bend-sets', pin ? 'pin' : 'handle');
    await page.mouse.click(at.x + dx, at.y + dy);
    await page.waitForFunction((n) => globalThis.cei3d.bend.points.length === n, i + 1, { timeout: 10000 });
  }
  await page.mouse.click(at.x + 50, at.y);
  check('a click on a handle selects it', (await points()) === 3 && (await page.locator('#bend-turn').count()) === 1);
  await put(page, '#bend-turn', 25);
  await drag(page, [at.x - 50, at.y], [at.x - 70, at.y - 25]);
  check('the page bends the object while the handle moves', await page.evaluate(() => globalThis.cei3d.stage.isLive() && globalThis.cei3d.stage.live.pulled));
  await page.waitForFunction(() => globalThis.cei3d.stage.preview !== null, null, { timeout: 30000 });
  await settled(page);
  const bent = await likeness(page);
  await page.evaluate(() => globalThis.cei3d.stage.live.letGo());
  const before = await likeness(page);
  check(`nearly as the program does: ${bent.toFixed(1)} dB, not bent ${before.toFixed(1)} dB`, bent > before + 0.5);
  await picture(page, '3-bend');
  await accessible(page, 'bending');
  await page.focus('#view');
  await page.keyboard.press('Enter');
  await steps(page, done + 1);
  await settled(page);
  const { params } = await last(page);
  check('two handles, a turn and a pin are one edit', params.more?.length === 1 && params.pins?.length === 1 && Math.abs(Math.hypot(...params.more[0].turn) - 25) < 1e-3);
  check('the points are gone', (await points()) === 0);
  await picture(page, '4-bent');
}

async function shines(page) {
  const { done } = await state(page);
  await page.keyboard.press('l');
  const ball = await page.locator('#light-ball').boundingBox();
  const light = () => page.evaluate(() => globalThis.cei3d.stage.light);
  await page.waitForFunction(() => document.getElementById('light-ball').getContext('2d').getImageData(60, 60, 1, 1).data[3] > 0);  // the ball is drawn
  await page.mouse.click(ball.x + 0.35 * ball.width, ball.y + 0.3 * ball.height);
  await settled(page);
  const { sun } = await light();
  check(`a click on the ball puts a sun: ${sun.direction.map((v) => v.toFixed(2))}`, Math.abs(Math.hypot(...sun.direction) - 1) < 1e-6 && sun.strength === 1);
  await put(page, '#sun-strength', 3);
  await page.waitForFunction(() => globalThis.cei3d.stage.live.sun !== null, null, { timeout: 10000 });
  await settled(page);
  await picture(page, '5-sun');
  // While a light is previewed, the page draws it and the program's present frame does not show it.
  const [psnr, plain] = [await likeness(page), await likenessUnder(page, { rotate: 0, scale: 1 })];
  check(`the page draws the sun by itself: ${psnr.toFixed(1)} dB, without it ${plain.toFixed(1)} dB`, (await page.evaluate(() => globalThis.cei3d.stage.isLive())) && psnr > 26 && psnr > plain + 4);
  await accessible(page, 'a sun');
  await page.click('#light-keep');
  await steps(page, done + 1);
  await settled(page);
  const kept = (await last(page)).params;
  check('the sun is kept', kept.sun.strength === 3 && kept.sun.direction.every((v, k) => Math.abs(v - sun.direction[k]) < 1e-9));
  check('and the page shows the object’s own light again', (await light()).sun === undefined);
}

/** likeness() while a light is previewed. */
async function likenessUnder(page, light) {
  const was = await page.evaluate((l) => { const { stage } = globalThis.cei3d, before = stage.light; stage.light = l; return before; }, light);
  const psnr = await likeness(page);
  await page.evaluate((l) => { globalThis.cei3d.stage.light = l; }, was);
  return psnr;
}

/** A picture that is dropped beside the object becomes the light, in which the page draws, too. */
async function environments(page) {
  const { done } = await state(page), box = await page.locator('#view').boundingBox();
  await page.keyboard.press('v');
  await settled(page);
  await dropPicture(page, box.x + 8, box.y + box.height - 8);
  await page.waitForFunction(() => globalThis.cei3d.stage.light.env && globalThis.cei3d.stage.isLive(), null, { timeout: 60000 });
  await settled(page);
  const [psnr, own] = [await likeness(page), await likenessUnder(page, { rotate: 0, scale: 1 })];
  check(`the page draws under an environment: ${psnr.toFixed(1)} dB, under the object's light ${own.toFixed(1)} dB`, psnr > 30 && psnr > own + 4);
  await page.click('#light-drop');
  await settled(page);
  const back = await likeness(page);
  check(`and under the object's light again: ${back.toFixed(1)} dB`, back > 30 && (await state(page)).done === done);
}

/** Drops a picture on the view at a pixel of the window. */
const dropPicture = (page, x, y) => page.evaluate(async ([cx, cy]) => {
  const canvas = document.createElement('canvas');
  canvas.width = 64;
  canvas.height = 32;
  const c = canvas.getContext('2d');
  c.fillStyle = '#0030ff';
  c.fillRect(0, 0, 64, 32);
  const blob = await new Promise((resolve) => canvas.toBlob(resolve, 'image/png'));
  const data = new DataTransfer();
  data.items.add(new File([blob], 'blue.png', { type: 'image/png' }));
  document.getElementById('view').dispatchEvent(new DragEvent('drop', { dataTransfer: data, clientX: cx, clientY: cy, bubbles: true, cancelable: true }));
}, [x, y]);

async function lays(page) {
  const { done } = await state(page);
  await page.keyboard.press('v');
  const at = await middle(page);
  await dropPicture(page, at.x, at.y);
  await page.waitForFunction(() => globalThis.cei3d.stage.preview !== null, null, { timeout: 30000 });
  check('a picture dropped on the object is a decal', await page.evaluate(() => document.querySelector('[data-tool="decal"]').getAttribute('aria-checked')) === 'true');
  await put(page, '#decal-turn', 30);
  await page.keyboard.press(']');
  await drag(page, [at.x, at.y], [at.x + 12, at.y + 6]);
  await settled(page);
  await picture(page, '6-decal');
  await accessible(page, 'a decal');
  await page.focus('#view');
  await page.keyboard.press('Enter');
  await steps(page, done + 1);
  await settled(page);
  const [color] = await pixels(page, [[at.fx + 12 * at.scale, at.fy + 6 * at.scale]]);
  check(`its color is there: ${color}`, color[2] > color[0] + 40 && color[2] > color[1] + 20);
  await picture(page, '7-pressed');
}

async function picksAndPens(page) {
  const { done } = await state(page), at = await middle(page);
  await page.keyboard.press('b');
  await page.click('#brush-pick');
  await page.mouse.click(at.x + 12, at.y + 6);
  await page.waitForFunction(() => document.getElementById('brush-pick').getAttribute('aria-pressed') === 'false' && !/d8342c/.test(document.getElementById('brush-color').value), null, { timeout: 10000 });
  const taken = await page.inputValue('#brush-color');
  check(`the next click takes the color: ${taken}`, parseInt(taken.slice(5, 7), 16) > parseInt(taken.slice(1, 3), 16) + 40);
  await accessible(page, 'paint');
  // Chromium's own pens cannot be scripted, so the events are made here.
  const radii = await page.evaluate(([x, y]) => {
    const view = document.getElementById('view'), out = [];
    const send = (type, px, more) => view.dispatchEvent(new PointerEvent(type, { pointerId: 7, pointerType: 'pen', isPrimary: true, clientX: px, clientY: y, buttons: 1, bubbles: true, cancelable: true, ...more }));
    view.setPointerCapture = () => {};
    for (const pressure of [1, 0.2]) out.push(globalThis.cei3d.paint.radius({ pressure }));
    send('pointerdown', x, { pressure: 0.5, buttons: 32, button: 5 });
    send('pointermove', x + 10, { pressure: 0.5, buttons: 32 });
    send('pointerup', x + 10, { pressure: 0, buttons: 0, button: 5 });
    return out;
  }, [at.x + 12, at.y + 6]);
  check(`less pressure, a smaller brush: ${radii}`, radii[1] < 0.6 * radii[0]);
  await steps(page, done + 1);
  await settled(page);
  check('the eraser of a pen erases', (await last(page)).params.erase === true);
}

withPage({ program, project, executablePath, picture }, async ({ page, server }) => {
  await page.goto(server.url);
  await settled(page);
  await lassos(page);
  await names(page);
  await framesPart(page);
  await hides(page);
  await environments(page);
  await shines(page);
  await lays(page);
  await picksAndPens(page);
  await bends(page);
  fs.writeFileSync(path.join(pictures, 'history.json'), JSON.stringify((await state(page)).history));
}).catch((error) => { console.error(error.message); process.exit(1); });

// SPDX-License-Identifier: Apache-2.0
// long.cjs PROGRAM PROJECT CHROMIUM [STROKES RELOADS KILLS [SEED [MINUTES]]]: a long session on a copy of PROJECT: strokes, spread over at
// least so many minutes, reloads, and kill -9 of the program at random moments, after which all acknowledged edits must be stored. Prints
// the growth of memory.
const { execFileSync } = require('node:child_process');
const { withEditor, settled, megabytes, median } = require('./serve.cjs');

const [program, original, executablePath, ...counts] = process.argv.slice(2);
const [strokes, reloads, kills, seed, minutes] = [1000, 100, 50, 1, 0].map((n, i) => Number(counts[i] ?? n));

let dice = seed;
/** In [0, 1). [Park and Miller 1988] */
const random = () => (dice = dice * 48271 % 2147483647) / 2147483647;
const logged = (project) => JSON.parse(execFileSync(program, ['log', project, '--json'], { maxBuffer: 1 << 30 })).edits.filter((e) => e.done && !e.set_aside).length;

const tenth = (n) => Math.ceil(n / 10);

/** At which strokes an event happens that happens n times. @param {number} n @returns {Set<number>} */
function moments(n) {
  const chosen = new Set();
  while (chosen.size < Math.min(n, strokes)) chosen.add(Math.floor(random() * strokes));
  return chosen;
}

/** Draws a short stroke somewhere on the object and returns before it is kept. */
const stroke = (page) => page.evaluate(([a, b, c]) => {
  const { paint, stage } = globalThis.cei3d, { width, height } = stage.picture;
  for (let i = 0; i < 300; ++i) {
    const x = width * (0.3 + 0.4 * ((a + 0.7549 * i) % 1)), y = height * (0.3 + 0.4 * ((b + 0.5698 * i) % 1));
    // Not at the rim of the object, where a stroke may miss the surface.
    if (![[-8, 0], [20, 5], [0, -8], [0, 8]].every(([dx, dy]) => stage.onObject(x + dx, y + dy))) continue;
    const p = { x, y, pressure: 1, shift: false, alt: false, ctrl: false, onObject: true, erase: false };
    paint.setColor(`#${Math.floor(c * 0xffffff).toString(16).padStart(6, '0')}`);
    paint.down(p);
    paint.move({ ...p, x: x + 12, y: y + 5 });
    paint.up();
    globalThis.kept = paint.keep();
    return;
  }
  throw new Error('The object is not in the picture.');
}, [random(), random(), random()]);

/** kill -9 at a random moment after a stroke was drawn; compares the stored edits with the acknowledged ones. */
async function killed(at, page, count) {
  await page.waitForTimeout(700 * random());
  const acknowledged = await page.evaluate(() => globalThis.cei3d.store.state.done);
  await at.server.kill();
  const there = logged(at.project);
  count.lost += there < acknowledged;
  count.unacknowledged += there > acknowledged;
  await at.restart();
  await page.goto(at.server.url);
}

async function strokesAndMore(at, page, count) {
  const reloadAt = moments(reloads), killAt = moments(kills);
  const heap = async () => page.evaluate(() => { globalThis.gc?.(); return performance.memory.usedJSHeapSize / 1e6; });
  const start = Date.now();
  await page.goto(at.server.url);
  await settled(page);
  for (let i = 0; i < strokes; ++i) {
    await page.waitForTimeout(Math.max(0, start + 60000 * minutes * i / strokes - Date.now()));
    const begin = Date.now(), before = await page.evaluate(() => globalThis.cei3d.store.state.done);
    await stroke(page);
    if (killAt.has(i)) {
      await killed(at, page, count);
      await page.waitForFunction((n) => globalThis.cei3d?.store.state.done >= n && globalThis.cei3d.settled(), before + 1, { timeout: 60000 });
    } else {
      await page.waitForFunction((n) => globalThis.cei3d.store.state.done === n, before + 1, { timeout: 60000 });
      count.seconds.push((Date.now() - begin) / 1000);
    }
    if (reloadAt.has(i)) {
      await page.reload();
      await settled(page);
    }
    count.memory.push(megabytes(at.server.process.pid));
    if ((i + 1) % tenth(strokes) && i !== strokes - 1) continue;
    count.heap.push(await heap());
    console.error(`${i + 1} strokes, ${Math.round(count.memory[i])} MB`);
  }
  await settled(page);
  count.done = await page.evaluate(() => globalThis.cei3d.store.state.done);
}

function report(count, there) {
  const middle = (list) => median(list).toFixed(2), few = tenth(count.seconds.length);
  console.log('| | |\n|---|---|');
  console.log(`| strokes, reloads, kills, at least | ${strokes}, ${reloads}, ${kills}, ${minutes} minutes |`);
  console.log(`| edits in the page; in the project | ${count.done}; ${there} |`);
  console.log(`| kills after which an acknowledged edit was gone; after which one was there that was not yet acknowledged | ${count.lost}; ${count.unacknowledged} |`);
  console.log(`| stroke to kept edit, median of the first and of the last tenth | ${middle(count.seconds.slice(0, few))} s; ${middle(count.seconds.slice(-few))} s |`);
  count.heap.forEach((page, k) => {
    const first = k * tenth(strokes), some = count.memory.slice(first, first + tenth(strokes));
    console.log(`| memory, strokes ${first + 1} to ${first + some.length}: program, median and maximum; scripts of the page | ` +
      `${Math.round(median(some))}, ${Math.round(Math.max(...some))} MB; ${page.toFixed(1)} MB |`);
  });
}

withEditor({ program, project: original, executablePath, copy: true, args: ['--js-flags=--expose-gc', '--enable-precise-memory-info'] }, async (at) => {
  const page = await at.browser.newPage({ viewport: { width: 868, height: 674 } });
  const begun = logged(at.project);
  const count = { lost: 0, unacknowledged: 0, done: 0, seconds: [], memory: [], heap: [] }, refused = [];
  page.on('response', async (r) => { if (r.status() >= 400) refused.push(`${r.status()} ${r.url()} ${await r.text().catch(String)}`); });
  try {
    await strokesAndMore(at, page, count);
  } catch (error) {
    console.error(refused.join('\n'));
    throw error;
  }
  await at.server.kill();
  const there = logged(at.project);
  report(count, there);
  if (count.lost > 0 || count.done !== there || count.done !== begun + strokes) throw new Error('Edits are missing or doubled.');
}).catch((error) => { console.error(error); process.exit(1); });

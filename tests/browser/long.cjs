// SPDX-License-Identifier: Apache-2.0
// long.cjs PROGRAM PROJECT CHROMIUM [STROKES RELOADS KILLS [SEED]]: a long session on a copy of PROJECT: strokes, reloads, and kill -9
// of the program at random moments, after each of which every acknowledged edit must be there. Prints how memory grows.
const { execFileSync } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { chromium } = require('playwright-core');
const { serve, settled } = require('./serve.cjs');

const [program, original, executablePath, ...counts] = process.argv.slice(2);
const [strokes, reloads, kills, seed] = [1000, 100, 50, 1].map((n, i) => Number(counts[i] ?? n));
const project = path.join(fs.mkdtempSync(path.join(os.tmpdir(), 'cei3d-long-')), 'object');
fs.cpSync(original, project, { recursive: true });

let dice = seed;
/** In [0, 1). [Park and Miller 1988] */
const random = () => (dice = dice * 48271 % 2147483647) / 2147483647;
const megabytes = (pid) => Number(/VmRSS:\s*(\d+)/.exec(fs.readFileSync(`/proc/${pid}/status`, 'utf8'))[1]) / 1024;
const logged = () => JSON.parse(execFileSync(program, ['log', project, '--json'], { maxBuffer: 1 << 30 })).edits.filter((e) => e.done && !e.set_aside).length;

/** Which of so many events happen at each step. @param {number} n @returns {Set<number>} */
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
    // Not at the rim, which a stroke does not reach.
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

async function main() {
  const reloadAt = moments(reloads), killAt = moments(kills);
  let server = await serve(program, project), lost = 0, unacknowledged = 0;
  const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--js-flags=--expose-gc', '--enable-precise-memory-info'] });
  const page = await browser.newPage({ viewport: { width: 868, height: 674 } });
  const heap = async () => page.evaluate(() => { globalThis.gc?.(); return performance.memory.usedJSHeapSize / 1e6; });
  const seconds = [], memory = [], refused = [];
  page.on('response', async (r) => { if (r.status() >= 400) refused.push(`${r.status()} ${r.url()} ${await r.text().catch(String)}`); });
  try {
    await page.goto(server.url);
    await settled(page);
    for (let i = 0; i < strokes; ++i) {
      const begin = Date.now(), before = await page.evaluate(() => globalThis.cei3d.store.state.done);
      await stroke(page);
      if (killAt.has(i)) {
        await page.waitForTimeout(700 * random());
        server.process.removeAllListeners('exit');
        const gone = new Promise((resolve) => server.process.on('exit', resolve));
        const acknowledged = await page.evaluate(() => globalThis.cei3d.store.state.done);
        server.process.kill('SIGKILL');
        await gone;
        const there = logged();
        lost += there < acknowledged;
        unacknowledged += there > acknowledged;
        server = await serve(program, project, server.port);
        await page.goto(server.url);
        await page.waitForFunction((n) => globalThis.cei3d?.store.state.done >= n && globalThis.cei3d.settled(), before + 1, { timeout: 60000 });
      } else {
        await page.waitForFunction((n) => globalThis.cei3d.store.state.done === n, before + 1, { timeout: 60000 });
        seconds.push((Date.now() - begin) / 1000);
      }
      if (reloadAt.has(i)) {
        await page.reload();
        await settled(page);
      }
      if (i % Math.ceil(strokes / 10) === 0 || i === strokes - 1) memory.push([i + 1, megabytes(server.process.pid), await heap()]);
    }
    await settled(page);
    const done = await page.evaluate(() => globalThis.cei3d.store.state.done);
    server.process.removeAllListeners('exit');
    server.process.kill('SIGKILL');
    const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)].toFixed(2);
    const tenth = Math.ceil(seconds.length / 10);
    console.log('| | |\n|---|---|');
    console.log(`| strokes, reloads, kills | ${strokes}, ${reloads}, ${kills} |`);
    console.log(`| edits in the page; in the project | ${done}; ${logged()} |`);
    console.log(`| kills after which an acknowledged edit was gone; after which one was there that was not yet acknowledged | ${lost}; ${unacknowledged} |`);
    console.log(`| stroke to kept edit, median of the first and of the last tenth | ${median(seconds.slice(0, tenth))} s; ${median(seconds.slice(-tenth))} s |`);
    for (const [i, program_, page_] of memory) console.log(`| memory after ${i} strokes: program; scripts of the page | ${Math.round(program_)} MB; ${page_.toFixed(1)} MB |`);
    if (lost > 0 || done !== logged() || done !== strokes) throw new Error('Edits are missing or doubled.');
  } catch (error) {
    console.error(refused.join('\n'));
    throw error;
  } finally {
    server.process.removeAllListeners('exit');
    server.process.kill('SIGKILL');
    await browser.close();
    fs.rmSync(path.dirname(project), { recursive: true });
  }
}

main().catch((error) => { console.error(error); process.exit(1); });

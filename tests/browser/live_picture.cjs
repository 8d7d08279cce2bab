// SPDX-License-Identifier: Apache-2.0
// live_picture.cjs PROGRAM CAPTURE CHROMIUM [STEPS [TIMES]]: how much longer a reconstruction takes in the editor, whose page shows
// the object meanwhile, than by the command line. Both go on from the same start, in turn.
const { spawn, spawnSync } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { withEditor, median } = require('./serve.cjs');

const [program, original, executablePath, steps = '600', times = '3'] = process.argv.slice(2);
const seconds = (since) => (Date.now() - since) / 1000;

/** Begins an object of the capture and stops it in its first steps. */
async function begin(capture, object) {
  const child = spawn(program, ['reconstruct', capture, '-o', object, '--iterations', steps, '--quiet'], { stdio: 'ignore' });
  const ended = new Promise((resolve) => child.on('exit', resolve));
  const runs = path.join(object, 'runs'), wait = (time) => new Promise((resolve) => setTimeout(resolve, 1000 * time));
  const planned = (run) => fs.readFileSync(path.join(runs, run, 'log.jsonl')).includes('"plan"');
  while (!(fs.existsSync(runs) && fs.readdirSync(runs).some(planned))) await wait(0.2);
  await wait(5);  // an object without a step of training is not kept
  child.kill('SIGINT');
  await ended;
}

function byCommand(object) {
  const start = Date.now();
  const { status } = spawnSync(program, ['reconstruct', '-o', object, '--resume', '--quiet'], { stdio: 'inherit' });
  if (status) throw new Error(`reconstruct ended with ${status}`);
  return seconds(start);
}

/** Returns the seconds that it takes, and the number of pictures that the page showed. */
async function inEditor(capture) {
  let took = 0, pictures = 0;
  await withEditor({ program, project: capture, executablePath }, async ({ server, browser }) => {
    const page = await browser.newPage({ viewport: { width: 868, height: 674 } });
    page.on('response', (r) => { if (r.url().includes('/api/making') && r.ok()) ++pictures; });
    await page.goto(server.url);
    await page.waitForSelector('#make');
    const start = Date.now();
    await page.click('#make');
    await page.waitForFunction(() => globalThis.cei3d.store.state.mode === 'project', null, { timeout: 0, polling: 50 });
    took = seconds(start);
  });
  return { took, pictures };
}

(async () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'cei3d-'));
  try {
    const capture = path.join(folder, 'capture'), object = `${capture}-object`, kept = path.join(folder, 'begun');
    fs.cpSync(original, capture, { recursive: true });
    await begin(capture, object);
    fs.cpSync(object, kept, { recursive: true });
    const again = () => {
      fs.rmSync(object, { recursive: true });
      fs.cpSync(kept, object, { recursive: true });
    };
    const ratios = [];
    for (let k = 0; k < Number(times); ++k) {
      again();
      const alone = byCommand(object);
      again();
      const { took, pictures } = await inEditor(capture);
      ratios.push(took / alone);
      console.log(`by the command line ${alone.toFixed(1)} s; in the editor ${took.toFixed(1)} s, ${pictures} pictures: ${(took / alone).toFixed(3)} times`);
    }
    console.log(`median ${median(ratios).toFixed(3)} times`);
  } finally { fs.rmSync(folder, { recursive: true }); }
})().catch((error) => { console.error(error); process.exit(1); });

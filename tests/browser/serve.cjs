// SPDX-License-Identifier: Apache-2.0
// Program and browser for scripts: starts both, and ends both even if the script fails.
const { spawn } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { chromium } = require('playwright-core');

/** @typedef {{process: import('node:child_process').ChildProcess, url: string, port: number, kill: () => Promise<void>}} Server */

/** `cei3d open`. port 0: any free one. flags: of the command. @returns {Promise<Server>} */
function serve(program, folder, port = 0, flags = []) {
  const [command, ...args] = [program, 'open', folder, '--no-browser', '--port', String(port), '--json', ...flags];
  const child = spawn(command, args, { stdio: ['ignore', 'pipe', 'inherit'] });
  let ended = false;
  const gone = new Promise((resolve) => child.on('exit', resolve));
  /** kill -9; returns when it is gone. */
  const kill = async () => {
    ended = true;
    child.kill('SIGKILL');
    await gone;
  };
  return new Promise((resolve, reject) => {
    let text = '';
    child.stdout.on('data', (data) => {
      text += data;
      if (!text.trimEnd().endsWith('}')) return;
      const { url } = JSON.parse(text);
      resolve({ process: child, url, port: Number(new URL(url).port), kill });
    });
    child.on('exit', (code) => { if (!ended) reject(new Error(`cei3d open ended with ${code}`)); });
  });
}

/**
 * Runs some work with a program that serves the project, and a browser. copy: of the project, which is deleted after the work.
 * @param {{program: string, project: string, executablePath: string, copy?: boolean, args?: string[], flags?: string[]}} what args: of the browser; flags: of `cei3d open`
 * @param {(at: {project: string, server: Server, browser: any, restart: () => Promise<void>, seconds: number}) => Promise<void>} work
 *   restart(): after server.kill(), at the same port; seconds: until the program answered
 */
async function withEditor({ program, project, executablePath, copy = false, args = [], flags = [] }, work) {
  const folder = copy ? fs.mkdtempSync(path.join(os.tmpdir(), 'cei3d-')) : '';
  const at = /** @type {any} */ ({ project: copy ? path.join(folder, path.basename(path.resolve(project))) : project });
  at.restart = async () => { at.server = await serve(program, at.project, at.server.port, flags); };
  try {
    if (copy) fs.cpSync(project, at.project, { recursive: true });
    const begin = Date.now();
    at.server = await serve(program, at.project, 0, flags);
    at.seconds = (Date.now() - begin) / 1000;
    at.browser = await chromium.launch({ executablePath, args: ['--no-sandbox', ...args] });
    await work(at);
  } finally {
    await at.server?.kill();
    await at.browser?.close();
    if (copy) fs.rmSync(folder, { recursive: true });
  }
}

/** Waits until the picture is refined and everything is stored. */
const settled = (page) => page.waitForFunction(() => globalThis.cei3d?.settled(), null, { timeout: 60000, polling: 30 });

/** Megabytes of memory of a process. @param {number} pid */
const megabytes = (pid) => Number(/VmRSS:\s*(\d+)/.exec(fs.readFileSync(`/proc/${pid}/status`, 'utf8'))[1]) / 1024;

/** @param {number[]} list */
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

module.exports = { serve, withEditor, settled, megabytes, median };

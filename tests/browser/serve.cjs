// SPDX-License-Identifier: Apache-2.0
// Starts `cei3d open` for scripts.
const { spawn } = require('node:child_process');

/** port 0: any free one. @returns {Promise<{process: import('node:child_process').ChildProcess, url: string, port: number}>} */
function serve(program, folder, port = 0) {
  const child = spawn(program, ['open', folder, '--no-browser', '--port', String(port), '--json'], { stdio: ['ignore', 'pipe', 'inherit'] });
  return new Promise((resolve, reject) => {
    let text = '';
    child.stdout.on('data', (data) => {
      text += data;
      if (!text.trimEnd().endsWith('}')) return;
      const { url } = JSON.parse(text);
      resolve({ process: child, url, port: Number(new URL(url).port) });
    });
    child.on('exit', (code) => reject(new Error(`cei3d open ended with ${code}`)));
  });
}

/** Waits until the picture is complete and all is saved. */
const settled = (page) => page.waitForFunction(() => globalThis.cei3d?.settled(), null, { timeout: 60000, polling: 30 });

module.exports = { serve, settled };

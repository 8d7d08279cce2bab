// SPDX-License-Identifier: Apache-2.0
// npm packages and programs that may not be installed; null where they are not. Packages are looked for in NODE_PATH and
// where tools/install_web.sh puts them.
'use strict';
const {execSync} = require('child_process');
const fs = require('fs');
const path = require('path');

const kInstalled = path.join(__dirname, '../build/web/node_modules');

exports.optional = (name) => {
  for (const from of [name, path.join(kInstalled, name)]) {
    try {
      return require(from);
    } catch (e) {
      if (e.code !== 'MODULE_NOT_FOUND') throw e;
    }
  }
  return null;
};

// The folder of a package whose modules a browser loads.
exports.folderOf = (name) => {
  const folders = [...(process.env.NODE_PATH || '').split(path.delimiter), kInstalled].filter(Boolean);
  return folders.map((f) => path.join(f, name)).find((f) => fs.existsSync(f)) || null;
};

exports.browserPath = () => {
  for (const name of ['chromium-headless-shell', 'chromium', 'chromium-browser', 'google-chrome']) {
    try {
      return execSync(`command -v ${name}`, {stdio: ['ignore', 'pipe', 'ignore']}).toString().trim();
    } catch (e) { /* the next */ }
  }
  return null;
};

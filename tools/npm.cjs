// SPDX-License-Identifier: Apache-2.0
// An npm package that may not be installed: from NODE_PATH, or from where tools/install_web.sh puts it; else null.
'use strict';
const path = require('path');

exports.optional = (name) => {
  for (const from of [name, path.join(__dirname, '../build/web/node_modules', name)]) {
    try {
      return require(from);
    } catch (e) {
      if (e.code !== 'MODULE_NOT_FOUND') throw e;
    }
  }
  return null;
};

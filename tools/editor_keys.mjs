// SPDX-License-Identifier: Apache-2.0
// editor_keys.mjs [DOCUMENT]: the tables of keys and gestures, from the editor's own; with a document, exit 1 if it has others.
import fs from 'node:fs';

const source = fs.readFileSync(new URL('../src/web/editor/keys.js', import.meta.url), 'utf8');
const { keyTable, gestures, written } = await import(`data:text/javascript,${encodeURIComponent(source)}`);

const row = (cells) => `| ${cells.join(' | ')} |`;
const code = (key) => `\`${written(key)}\``;
const lines = keyTable.flatMap(({ title, keys }) => [`| ${title} | |`, '|---|---|', ...keys.map((k) => row([k.keys.map(code).join(' '), k.text])), '']);
lines.push('| Mouse, pen and fingers | |', '|---|---|', ...gestures.map(row), '');
const text = lines.join('\n');

if (process.argv[2]) {
  if (fs.readFileSync(process.argv[2], 'utf8').includes(text)) process.exit(0);
  console.error(`${process.argv[2]} has other keys than src/web/editor/keys.js; put in what node tools/editor_keys.mjs prints.`);
  process.exit(1);
}
process.stdout.write(text);

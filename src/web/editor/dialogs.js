// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Export and help. */
import { byId, complain, el, openDialog, toast } from './dom.js';
import { getBlob, postJson } from './api.js';
import { gestures, keyTable, written } from './keys.js';

/** @param {Blob} blob @param {string} name */
export function save(blob, name) {
  const a = el('a', { href: URL.createObjectURL(blob), download: name });
  document.body.append(a);
  a.click();
  a.remove();
  setTimeout(() => URL.revokeObjectURL(a.href), 10000);
}

/** @type {[string, string, string, object][]} suffix, title, for whom, options */
const formats = [
  ['.glb', 'GLB', 'Web, games, most programs; one file with textures', {}],
  ['.usdz', 'USDZ', 'iPhone, iPad, Vision, USD programs', {}],
  ['.obj', 'OBJ', 'Old programs; with .mtl and pictures', {}],
  ['.ply', 'PLY', 'Mesh with colors at its vertices', {}],
  ['.glb', 'GLB for the web', 'Small: 30,000 faces, JPEG textures', { for: 'web' }],
  ['.hdr', 'Light', 'The environment as a picture for other renderers', {}],
];

/** @param {import('./store.js').Store} store @param {import('./stage.js').Stage} stage */
export function exportDialog(store, stage) {
  const name = store.state.name.replace(/[^A-Za-z0-9._-]/g, '_') || 'object';
  const note = el('p', { role: 'status' }, `Files are also kept in ${store.state.folder}/exports.`);
  const choice = (/** @type {[string, string, string, object]} */ [suffix, title, text, options]) => el('button', { 'data-export': title, onclick: async () => {
    const buttons = [...byId('dialog').querySelectorAll('.choices button')];
    buttons.forEach((b) => { b.disabled = true; });
    note.textContent = `Writing ${title}…`;
    try {
      const made = await postJson('export', { file: `${name}${suffix}`, ...options });
      for (const f of made.files) save(await getBlob(`/api/download/${encodeURIComponent(f.name)}`), f.name);
      note.textContent = `${made.files.map((/** @type {any} */ f) => `${f.name} (${(f.bytes / 1e6).toFixed(1)} MB)`).join(', ')} is in your downloads and in ${made.folder}.`;
    } catch (error) {
      note.textContent = '';
      complain(error);
    }
    buttons.forEach((b) => { b.disabled = false; });
  } }, title, el('small', {}, text));
  openDialog('Export', el('div', { class: 'choices' }, ...(store.state.read_only ? [] : formats.map(choice)),
    el('button', { onclick: async () => { const png = await stage.snapshot(); if (png) save(png, `${name}.png`); toast('The picture is in your downloads.'); } }, 'Picture', el('small', {}, 'What you see, as PNG'))),
    note, el('div', { class: 'buttons' }, el('button', { onclick: () => byId('dialog').close() }, 'Close')));
}

export function helpDialog() {
  const line = (/** @type {Node[]} */ left, /** @type {string} */ right) => el('div', {}, el('span', {}, right), el('span', {}, ...left));
  openDialog('Keys and gestures',
    ...keyTable.flatMap((group) => [el('h3', {}, group.title), el('div', { class: 'keys' }, ...group.keys.map((k) => line(k.keys.map((key) => el('kbd', {}, written(key))), k.text)))]),
    el('h3', {}, 'Mouse, pen and fingers'), el('div', { class: 'keys' }, ...gestures.map(([how, what]) => line([document.createTextNode(what)], how))),
    el('div', { class: 'buttons' }, el('button', { class: 'primary', onclick: () => byId('dialog').close() }, 'Close')));
}

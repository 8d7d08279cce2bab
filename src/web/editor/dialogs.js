// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** The dialogs for export and help; loaded when one of them is first opened. */
import { byId, el, select } from './dom.js';
import { getBlob, postJson } from './api.js';
import { gestures, keyTable, written } from './keys.js';
import { setSingleKeys, singleKeys } from './settings.js';

/** Fills the dialog of the page and opens it. @param {string} title @param {...(Node | string)} content */
function openDialog(title, ...content) {
  const dialog = byId('dialog');
  dialog.replaceChildren(el('div', { class: 'inside' }, el('h2', { id: 'dialog-title' }, title), ...content));
  if (!dialog.open) dialog.showModal();
  dialog.scrollTop = 0;
}

/** @param {Blob} blob @param {string} name */
function save(blob, name) {
  const a = el('a', { href: URL.createObjectURL(blob), download: name });
  document.body.append(a);
  a.click();
  a.remove();
  setTimeout(() => URL.revokeObjectURL(a.href), 10000);
}

/** What the object is exported for, as in `export --for`; sizes and formats follow from it. @type {[string, string][]} */
const purposes = [
  ['', 'Any use: 50,000 faces, textures of 2048 texels'],
  ['web', 'The web: 30,000 faces, 1024 texels, JPEG'],
  ['ar', 'Phones and glasses: 50,000 faces, 2048 texels, JPEG, standing in the origin'],
  ['dcc', 'Modeling programs: 200,000 faces, 4096 texels'],
];

const kTextured = ['for', 'faces', 'texture', 'image', 'origin', 'size', 'unit_scale', 'light'];

/**
 * A format. ending: of the file's name, distinct where files would overwrite each other. options: the fields below that apply to it.
 * more: members of the request besides those of the fields.
 * @typedef {{title: string, text: string, ending: string, options: string[], more?: object}} Format
 * @type {Format[]}
 */
export const formats = [
  { title: 'GLB', text: 'Web, games, most programs; one file with textures', ending: '.glb', options: kTextured },
  { title: 'glTF and files', text: 'The same as text, with its pictures beside it', ending: '-gltf.gltf', options: kTextured },
  { title: 'USDZ', text: 'iPhone, iPad, Vision, USD programs', ending: '.usdz', options: kTextured },
  { title: 'OBJ', text: 'Old programs; with .mtl and pictures', ending: '.obj', options: kTextured },
  { title: 'PLY', text: 'Mesh with colors at its vertices', ending: '.ply', options: ['faces', 'light'] },
  { title: 'Points', text: 'Handler points with normals, colors and parts, as PLY', ending: '-points.ply', options: ['light'], more: { points: true } },
  { title: 'Page', text: 'Share it as one HTML file that any browser shows', ending: '.html', options: ['for', 'faces'] },
  { title: 'Light, HDR', text: 'The environment as a picture for other renderers', ending: '-light.hdr', options: [] },
  { title: 'Light, EXR', text: 'The same as OpenEXR', ending: '-light.exr', options: [] },
  { title: 'Light, JSON', text: 'Its lobes: axis, sharpness and radiance, as text', ending: '-light.json', options: [] },
  { title: 'Light, NPY', text: 'The same as an array for NumPy', ending: '-light.npy', options: [] },
];
const kTurntableSide = 1024;  // pixels

/** @param {string} key @param {string} label @param {[string, string][]} list of value and text */
const choose = (key, label, list) => el('label', { class: 'field' }, label, select({ id: `export-${key}` }, list, ''));
/** @param {string} key @param {string} label @param {object} attributes */
const number = (key, label, attributes) => el('label', { class: 'field wide' }, label, el('input', { type: 'number', id: `export-${key}`, ...attributes }));

/** The fields of the options, each of which may be left empty. */
function exportFields() {
  return [choose('for', 'For', purposes), el('details', {}, el('summary', {}, 'More'), el('div', { class: 'two' },
    number('faces', 'Faces', { min: '4', step: '1', placeholder: 'as many as fit the use' }),
    choose('texture', 'Texels', [['', 'as fits the use'], ['0', 'none: colors at the vertices (GLB)'], ...['512', '1024', '2048', '4096', '8192'].map((n) => /** @type {[string, string]} */ ([n, `${n} × ${n}`]))]),
    choose('image', 'Pictures', [['', 'as fits the use'], ['png', 'PNG'], ['jpeg', 'JPEG'], ['webp', 'WebP (GLB and glTF)']]),
    choose('origin', 'Origin', [['', 'as fits the use'], ['input', 'that of the photographs'], ['base', 'below the object, upright']]),
    number('size', 'Longest side', { min: '0', step: 'any', placeholder: 'meters; as captured' }),
    number('unit_scale', 'Or scale', { min: '0', step: 'any', placeholder: 'meters per unit; 1', title: 'Meters per unit of the capture, instead of the longest side' }),
    choose('light', 'Light', [['', 'not with the object'], ['fit', 'beside it, as an HDR picture']]),
    number('turntable', 'Turntable', { min: '1', step: '1', value: '36', title: 'How many frames' })))];
}

/** The values of the fields that are not empty. @param {string[]} keys @returns {Record<string, any>} */
export function chosen(keys) {
  /** @type {Record<string, any>} */
  const out = {};
  for (const key of keys) {
    const text = byId(`export-${key}`).value;
    if (text !== '') out[key] = ['faces', 'texture', 'size', 'unit_scale', 'turntable'].includes(key) ? Number(text) : key === 'light' ? true : text;
  }
  return out;
}

/** @param {import('./store.js').Store} store @returns {[number, number]} size of the frames of a turntable */
function turntableSize(store) {
  const { width, height } = store.object.start.camera, s = Math.min(1, kTurntableSide / Math.max(width, height));
  return [Math.max(1, Math.round(width * s)), Math.max(1, Math.round(height * s))];
}

/** @param {import('./store.js').Store} store @param {import('./stage.js').Stage} stage */
export function exportDialog(store, stage) {
  const name = store.state.name.replace(/[^A-Za-z0-9._-]/g, '_') || 'object';
  const note = el('p', { role: 'status', id: 'export-note' }, `Files are also kept in ${store.state.folder}/exports.`);
  /** @param {string} title @param {string} text @param {() => Promise<string>} work returns the text to show when it is done */
  const choice = (title, text, work) => el('button', { 'data-export': title, onclick: async () => {
    const buttons = [...byId('dialog').querySelectorAll('.choices button')];
    buttons.forEach((b) => { b.disabled = true; });
    note.textContent = `Writing ${title}…`;
    note.textContent = await work().catch((error) => (error.status === 499 ? 'Stopped.' : `${error.message} ${error.hint ?? ''}`));
    buttons.forEach((b) => { b.disabled = false; });
  } }, title, el('small', {}, text));
  /** @param {string} route @param {object} body */
  const write = async (route, body) => {
    const made = await postJson(route, body);
    for (const f of made.files) save(await getBlob(`/api/download/${encodeURIComponent(f.name)}`), f.name);
    return `${made.files.map((/** @type {any} */ f) => `${f.name} (${(f.bytes / 1e6).toFixed(1)} MB)`).join(', ')} is in your downloads and in ${made.folder}.`;
  };
  const format = (/** @type {Format} */ f) => choice(f.title, f.text, () => {
    const options = chosen(f.options);
    return write('export', { file: `${name}${options.for ? `-${options.for}` : ''}${f.ending}`, ...options, ...f.more });
  });
  const turntable = () => write('turntable', { file: `${name}-turntable.zip`, size: turntableSize(store), turntable: 36, ...chosen(['turntable']) });
  const picture = async () => {
    const png = await stage.snapshot();
    if (png) save(png, `${name}.png`);
    return 'The picture is in your downloads.';
  };
  const locked = store.state.read_only;
  openDialog('Export', ...(locked ? [] : exportFields()), el('div', { class: 'choices' }, ...(locked ? [] : [...formats.map(format),
    choice('Turntable', 'Frames all around it, as PNG in one archive', turntable)]), choice('Picture', 'What you see, as PNG', picture)),
    note, el('div', { class: 'buttons' }, el('button', { onclick: () => byId('dialog').close() }, 'Close')));
}

function singleKeysField() {
  return el('p', {}, el('label', {}, el('input', { type: 'checkbox', id: 'single-keys', checked: singleKeys(), 'aria-describedby': 'single-keys-note',
    onchange: (/** @type {any} */ e) => setSingleKeys(e.target.checked) }), ' Single-key shortcuts'),
  el('small', { id: 'single-keys-note' }, ` Off: keys without ${written('Mod')} act only while the view of the object has the focus.`));
}

export function helpDialog() {
  const line = (/** @type {Node[]} */ left, /** @type {string} */ right) => el('div', {}, el('span', {}, right), el('span', {}, ...left));
  openDialog('Keys and gestures', singleKeysField(),
    ...keyTable.flatMap((group) => [el('h3', {}, group.title), el('div', { class: 'keys' }, ...group.keys.map((k) => line(k.keys.map((key) => el('kbd', {}, written(key))), k.text)))]),
    el('h3', {}, 'Mouse, pen and fingers'), el('div', { class: 'keys' }, ...gestures.map(([how, what]) => line([document.createTextNode(what)], how))),
    el('div', { class: 'buttons' }, el('button', { class: 'primary', autofocus: true, onclick: () => byId('dialog').close() }, 'Close')));
}

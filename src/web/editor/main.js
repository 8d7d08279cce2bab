// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** The editor: makes its tools and panels and connects them. */
import { hasKey, postJson } from './api.js';
import { byId, complain, el, glyph, select, toast } from './dom.js';
import { BendTool } from './bend.js';
import { DecalTool } from './decal.js';
import { GrabTool } from './grab.js';
import { Input } from './input.js';
import { actionOf, isSingle, keyOf } from './keys.js';
import { LightTool } from './light.js';
import { PaintTool } from './paint.js';
import { HistoryPanel, PartsPanel, PhotoStrip } from './panels.js';
import { MaterialTool, objectPanel } from './properties.js';
import { PartOverlay, PartTool } from './select.js';
import { singleKeys } from './settings.js';
import { channels, Stage } from './stage.js';
import { Store } from './store.js';

const store = new Store();
const stage = new Stage(store);
const overlay = new PartOverlay(stage, store);
const look = { name: 'look', label: 'Look', hint: 'Drag to turn, right button to move, wheel to zoom. B paints, P selects a part, ? shows all keys.' };
const paint = new PaintTool(stage, store, false), erase = new PaintTool(stage, store, true);
const light = new LightTool(stage, store, () => drawProperties());
const parts = new PartTool(stage, store, overlay), decal = new DecalTool(stage, store), bend = new BendTool(stage, store);
/** @type {any[]} */
const tools = [look, paint, erase, decal, parts, new GrabTool(stage, store), bend, new MaterialTool(stage, store), light];
/** @type {any} */
let tool = look;

/** @param {string} name */
function choose(name) {
  const next = tools.find((t) => t.name === name);
  if (!next || (store.state.read_only && !['look', 'light'].includes(name))) return;
  input.cancelReticle();
  if (next !== tool) tool.leave?.();
  tool = next;
  if (tool.down) stage.hide([]);  // the tool works on the whole object, hidden parts included
  drawTools();
  drawOptions();
  drawProperties();
  byId('hint').textContent = tool.hint;
  tool.enter?.();
  stage.redraw();
}

/** The tool for a press; the eraser of a pen erases, after the strokes before it are stored. @param {import('./input.js').Point} [p] */
function toolFor(p) {
  if (!p?.erase || tool !== paint) return tool;
  paint.keep();
  return erase;
}

const input = new Input(stage, toolFor, {
  undo, redo,
  turnLight: (degrees, done) => { light.turn(degrees); if (done) choose('light'); },
  size: (factor) => tool.size?.(factor),
});
stage.drawTool = (/** @type {CanvasRenderingContext2D} */ context) => {
  overlay.draw(context);
  tool.draw?.(context);
  input.drawReticle(context);
  for (const b of byId('options').querySelectorAll('button.of-trial')) b.disabled = !tool.tries?.();
};

function drawTools() {
  byId('tools').replaceChildren(...tools.map((t) => el('button', {
    role: 'radio', 'aria-checked': String(t === tool), title: `${t.label} (${keyOf(`tool:${t.name}`)})`, 'data-tool': t.name,
    disabled: store.state.read_only && !['look', 'light'].includes(t.name), onclick: () => choose(t.name),
  }, glyph(t.name), el('span', {}, t.label))));
}

function drawOptions() { byId('options').replaceChildren(...(tool.options?.() ?? [])); tool.enter?.(); stage.redraw(); }

function drawProperties() {
  if (document.activeElement?.closest('#properties') && /** @type {any} */ (document.activeElement).type === 'range' && tool !== light) return;
  const focused = document.activeElement?.id;
  byId('properties').replaceChildren(el('h2', { id: 'properties-title' }, tool.panel ? tool.label : 'Object'), ...(tool.panel?.() ?? objectPanel(store)));
  if (focused && byId('properties').querySelector(`#${CSS.escape(focused)}`)) byId(focused).focus();
  light.update();
}

function undo() {
  if (tool.undo?.()) return;
  if (store.canUndo() && !store.state.read_only) store.change('undo');
}
function redo() { if (store.canRedo() && !store.state.read_only) store.change('redo'); }

async function remove() {
  if (tool.remove?.()) return;
  const part = store.part;
  if (!part) return toast('Select a part first; Delete removes it.');
  const done = await store.change('edit', { op: 'remove', params: { part } });
  if (done) toast(`${part} is removed; ${keyOf('undo')} brings it back.`);
}

/** @param {string} name */
function goToPhoto(name) {
  const view = store.object.views.find((v) => v.name === name);
  if (!view) return;
  stage.camera.take(view.camera);
  stage.photo = name;
  stage.emit('photo');
  stage.moved();
}

/** @type {typeof import('./dialogs.js') | null} loaded when a dialog is first opened */
let dialogs = null;

/** @param {'exportDialog' | 'helpDialog'} name */
async function openDialog(name) {
  // Not loaded while no server answers, because a browser may remember the failure of a module for good.
  if (!store.lost || store.unknownServer) dialogs ??= await import('./dialogs.js').catch(() => null);
  if (dialogs) dialogs[name](store, stage);
  else complain('The program does not answer.');
}

const strip = new PhotoStrip(store, stage, goToPhoto);
let comparing = false, holding = false;

async function drawPhoto() {
  const photo = byId('photo'), wipe = byId('wipe');
  const shown = stage.photo !== null && (comparing || holding);
  photo.hidden = !shown;
  wipe.hidden = !shown || !comparing;
  if (!shown || !stage.photo) return;
  const { width, height, scale } = stage.size(), r = stage.camera.rectangle(width, height);
  Object.assign(photo.style, { left: `${r.x / scale}px`, top: `${r.y / scale}px`, width: `${r.width / scale}px`, height: `${r.height / scale}px` });
  photo.style.clipPath = comparing && !holding ? `inset(0 ${100 - wipe.value}% 0 0)` : 'none';
  try {
    photo.src = await strip.url(stage.photo, Math.ceil(r.width));
  } catch (error) { complain(error); }
}
byId('wipe').addEventListener('input', drawPhoto);
stage.addEventListener('photo', drawPhoto);
stage.addEventListener('resized', drawPhoto);

function compare() {
  if (!strip.views.length) return;
  if (!stage.photo) strip.next(1);
  comparing = !comparing;
  drawActions();
  drawPhoto();
}

function nextChannel() {
  const at = channels.findIndex(([name]) => name === stage.channel);
  setChannel(channels[(at + 1) % channels.length][0]);
}
/** @param {string} name */
function setChannel(name) {
  stage.channel = name;
  drawActions();
  stage.moved();
}

function drawActions() {
  const locked = store.state.read_only;
  byId('actions').replaceChildren(
    el('button', { class: 'icon', id: 'undo', 'aria-label': 'Undo', title: `Undo (${keyOf('undo')})`, disabled: locked || !(store.canUndo() || tool.unsaved?.()), onclick: undo }, glyph('undo')),
    el('button', { class: 'icon', id: 'redo', 'aria-label': 'Redo', title: `Redo (${keyOf('redo')})`, disabled: locked || !store.canRedo(), onclick: redo }, glyph('redo')),
    select({ 'aria-label': 'Channel', title: `What the picture shows (${keyOf('channel')})`, id: 'channel' }, channels, stage.channel, setChannel),
    el('button', { id: 'compare', 'aria-pressed': String(comparing), disabled: !strip.views.length,
      title: strip.views.length ? `Compare with a photograph (${keyOf('compare')})` : 'The photographs are not where they were when the object was made', onclick: compare }, 'Compare'),
    el('button', { class: 'primary', id: 'export', title: `Export (${keyOf('export')})`, onclick: () => openDialog('exportDialog') }, 'Export'));
}

function drawSaved() {
  const node = byId('saved'), unsaved = tools.some((t) => t.unsaved?.()) || store.saving > 0;
  const editing = store.state.mode === 'project';
  node.className = `saved ${store.lost ? 'lost' : unsaved ? 'busy' : ''}`;
  node.textContent = !editing ? '' : store.lost ? 'Not connected' : store.state.read_only ? 'Read-only' : unsaved ? 'Saving…' : 'All changes saved';
  byId('banner').hidden = !store.lost || !hasKey();  // the page explains a missing key itself
  byId('banner').textContent = store.unknownServer ? 'The program was restarted. Paste the address that it printed into this window; what you did meanwhile is kept here.'
    : 'The program does not answer; trying again. What you do meanwhile is kept here.';
}

/** Moves the camera so that the selected part, or the whole object, fills the view. Parts are shown with a minimum size. */
function frame() {
  const { center, radius } = store.object, ball = store.part ? stage.live.ballOf(store.part) : null;
  stage.camera.frame(ball?.center ?? center, ball ? Math.max(ball.radius, radius / 10) : radius);
  input.leavePhoto();
  stage.moved();
}

/** @param {KeyboardEvent} e */
function hold(e) {
  if (e.repeat) return;
  stage.view.focus({ preventScroll: true });  // so that it gets the arrow keys
  input.holdReticle();
}

/** Actions that are allowed while keys drag; the others could change the view or the tool during the drag. */
const whileHeld = ['arrows', 'keep', 'drop', 'hold', 'reticle', 'smaller', 'larger', 'help'];

/** @type {Record<string, (e: KeyboardEvent) => void>} */
const actions = {
  undo, redo, remove, compare,
  'pick-color': () => paint.pickColor(),
  'swap-colors': () => paint.swap(),
  lasso: () => { parts.by = 'lasso'; choose('part'); },
  hide: () => { if (store.part) partsPanel.toggle(store.part); else toast('Select a part first; H hides it.'); },
  'show-all': () => stage.hide([]),
  smaller: () => tool.size?.(1 / 1.15), larger: () => tool.size?.(1.15),
  opacity: (e) => tool.opacity?.((Number(e.key) || 10) / 10),
  softer: () => tool.hardness?.(-0.1), harder: () => tool.hardness?.(0.1),
  keep: () => { if (!input.releaseReticle()) tool.keep?.(); },
  drop: () => { if (!input.cancelReticle()) tool.drop ? tool.drop() : tool.cancel?.(); },
  frame,
  home: () => { stage.camera.goHome(); input.leavePhoto(); stage.moved(); },
  arrows: (e) => input.arrows(e),
  zoom: (e) => { const { width, height } = stage.size(); stage.camera.zoom(e.key === '-' ? 1.1 : 1 / 1.1, width / 2, height / 2, width, height); input.leavePhoto(); stage.moved(); },
  'next-photo': () => strip.next(1), 'previous-photo': () => strip.next(-1),
  'hold-photo': () => { if (!stage.photo && strip.views.length) strip.next(1); holding = true; drawPhoto(); },
  channel: nextChannel, reticle: () => input.toggleReticle(), hold, bare: () => { document.body.classList.toggle('bare'); },
  export: () => openDialog('exportDialog'), help: () => openDialog('helpDialog'),
};

window.addEventListener('keydown', (e) => {
  const target = /** @type {HTMLElement} */ (e.target), onView = target === stage.view || target === document.body;
  if (byId('dialog').open || (isSingle(e) && !singleKeys() && target !== stage.view)) return;
  if (e.key === ' ' && onView) {
    e.preventDefault();
    if (!input.clickReticle({ alt: e.altKey, shift: e.shiftKey })) input.space = true;
    return;
  }
  const action = actionOf(e);
  if (!action) return;
  const typing = target.matches('input[type="text"], input[type="number"], select');
  if (typing || (!onView && ['arrows', 'keep', 'home', 'zoom'].includes(action))) return;
  if (store.state.mode !== 'project' && action !== 'help') return;
  e.preventDefault();
  if (input.held && !whileHeld.includes(action)) return;
  if (action.startsWith('tool:')) choose(action.slice(5));
  else actions[action]?.(e);
});
window.addEventListener('keyup', (e) => { if (e.key === '\\') { holding = false; drawPhoto(); } });
window.addEventListener('beforeunload', (e) => { if (tools.some((t) => t.unsaved?.()) || store.saving > 0) e.preventDefault(); });
for (const type of ['dragover', 'drop']) window.addEventListener(type, (e) => e.preventDefault());
stage.view.addEventListener('drop', (/** @type {DragEvent} */ e) => { const file = e.dataTransfer?.files[0]; if (file && store.state.mode === 'project' && !store.state.read_only) take(file, input.point(e)); });

/** A picture that is dropped on the object becomes a decal; everything else becomes the light. @param {File} file @param {import('./input.js').Point} at */
function take(file, at) {
  const isDecal = at.onObject && file.type.startsWith('image/') && !/\.(hdr|exr)$/i.test(file.name);
  choose(isDecal ? 'decal' : 'light');
  isDecal ? decal.take(file, at) : light.take(file);
}
stage.addEventListener('options', () => { drawOptions(); drawProperties(); });
stage.addEventListener('hidden', () => { if (stage.live.hidden.size && tool.down) choose('look'); });

const partsPanel = new PartsPanel(store, stage, { newPart: () => choose('part'), remove });
new HistoryPanel(store, stage);
byId('help').addEventListener('click', () => openDialog('helpDialog'));
byId('back').addEventListener('click', async () => { try { await store.take(await postJson('close')); } catch (error) { complain(error); } });
byId('job-stop').addEventListener('click', () => postJson('cancel').catch(complain));

/** @type {Promise<void> | null} */
let places = null;
function showPlaces() {
  byId('hint').textContent = '';
  places ??= import('./places.js').then(({ Places }) => { new Places(store); }, complain);
}

let jobTimer = 0;
store.line.on('progress', (p) => {
  if (p.job === 'reconstruct') return;
  const job = byId('job');
  clearTimeout(jobTimer);
  job.hidden = p.fraction >= 1;
  byId('job-bar').value = p.fraction;
  byId('job-text').textContent = `${p.stage}${p.message ? ` · ${p.message}` : ''}`;
  jobTimer = window.setTimeout(() => { job.hidden = true; }, 8000);
});
store.on('saving', () => { drawSaved(); drawActions(); if (store.saving === 0) byId('job').hidden = true; });
store.on('state', (state) => {
  document.body.dataset.mode = state.mode;
  document.title = state.name ? `${state.name} · CEI-3D` : 'CEI-3D';
  byId('name').textContent = state.name ?? '';
  byId('back').hidden = !state.can_close;
  if (state.mode !== 'project') showPlaces();
  drawActions();
  drawSaved();
  drawTools();
  drawProperties();
});
store.on('mode', (state) => {
  if (state.mode !== 'project') return;
  const first = store.made && !state.read_only;  // select the paint tool after a reconstruction
  choose(first ? 'paint' : 'look');
  if (first) toast(`Drag on the object to paint; ${keyOf('undo')} takes anything back.`);
  if (state.note) toast(state.note, { bad: true });
});
store.on('part', () => { drawOptions(); drawProperties(); });
if (!hasKey()) {
  byId('place').replaceChildren(el('div', { class: 'column' }, el('h2', {}, 'The key is missing'), el('p', {}, 'Open the whole address that cei3d printed, with what follows the #.')));
}

/** For tests: the parts of the editor, and whether the picture is complete and everything is stored. */
Object.assign(window, { cei3d: { store, stage, paint, bend, keepPaint: () => paint.keep(), settled: () => stage.settled() && store.saving === 0 && !tools.some((t) => t.unsaved?.()) } });

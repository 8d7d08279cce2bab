// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** The lists around the view: parts, history, photographs. */
import { byId, el, glyph, nameInPlace, toast } from './dom.js';
import { getBlob, postForBlob } from './api.js';
import { resized } from '../camera.js';
import { lookText, swatch } from './looks.js';
import { partColors } from './select.js';
import { kHeight, kWidth, Thumbs } from './thumbs.js';

/** @type {Record<string, string>} */
const opNames = { paint: 'Paint', material: 'Material', light: 'Light', deform: 'Bend', remove: 'Remove', part: 'Part' };
/** @type {Record<string, string>} */
const opGlyphs = { paint: 'paint', material: 'material', light: 'light', deform: 'grab', remove: 'trash', part: 'part' };

/** What an edit did: "gold, roughness 0.40". @param {import('./store.js').Edit} e @returns {string} */
export function describe(e) {
  const p = e.params, words = [];
  if (e.op === 'paint') words.push(p.erase ? 'erased' : p.target === 'albedo' ? '' : p.target, (e.strokes ?? 1) > 1 ? `${e.strokes} views` : '');
  if (p.name) words.push(p.name);
  if (p.part) words.push(p.part);
  if (p.material) words.push(p.material);
  for (const key of ['roughness', 'specular', 'metalness']) if (p[key] !== undefined) words.push(`${key} ${Number(p[key]).toFixed(2)}`);
  if (p.color) words.push(p.color);
  if (p.env) words.push(String(p.env).split('/').at(-1));
  if (p.sun) words.push('sun');
  if (p.more) words.push(`${1 + p.more.length} handles`);
  if (p.pins) words.push(`${p.pins.length} ${p.pins.length === 1 ? 'pin' : 'pins'}`);
  if (p.rotate_degrees) words.push(`${Math.round(p.rotate_degrees)}°`);
  if (p.scale) words.push(`× ${Number(p.scale).toFixed(2)}`);
  return words.filter(Boolean).join(', ');
}

export class PartsPanel {
  /** @param {import('./store.js').Store} store @param {import('./stage.js').Stage} stage @param {{newPart: () => void, remove: () => void}} actions */
  constructor(store, stage, actions) {
    this.store = store;
    this.stage = stage;
    this.actions = actions;
    for (const type of ['hidden', 'looks']) stage.addEventListener(type, () => this.draw());
    store.on('state', () => this.draw());
    store.on('part', () => this.draw());
  }

  /** @param {string} name */
  toggle(name) {
    const hidden = this.stage.live.hidden;
    if (!this.stage.live.renderer) return toast('Parts can be hidden only where the page draws by WebGL 2.');
    this.stage.hide(hidden.has(name) ? [...hidden].filter((n) => n !== name) : [...hidden, name]);
  }

  /** The name of the part in this page: that of the edit that made it, if the user named that, else the one that commands use. @param {import('./store.js').Part} p */
  title(p) { return this.store.done().filter((e) => e.op === 'part' && e.params.name === p.name && e.name).at(-1)?.name ?? p.name; }

  /** A swatch of the part's look, with a border of the color in which the part is shown when it is selected. @param {string} name @param {number} index */
  ball(name, index) {
    const look = this.stage.live.looks.get(name), node = el('span', { class: 'swatch part', title: look ? lookText(look) : undefined });
    node.style.background = look ? swatch(look) : 'none';
    node.style.borderColor = partColors[index % partColors.length];
    return node;
  }

  /** @param {import('./store.js').Part} p @param {Element} label */
  rename(p, label) {
    nameInPlace(label, this.title(p), `Name of ${p.name}`, (name) => { if (name === null) this.draw(); else this.store.change('rename', { id: p.edit, name }); });
  }

  draw() {
    const { store } = this, hidden = this.stage.live.hidden;
    if (document.activeElement?.matches('#parts input')) return;  // a name is being typed
    const rows = store.state.parts.map((p, i) => {
      const on = store.part === p.name, off = hidden.has(p.name), title = this.title(p);
      const label = el('button', { class: 'label', 'aria-pressed': String(on), title: on ? 'Selected; click again for the whole object' : `Select ${p.name}`,
        onclick: () => store.select(on ? null : p.name), ondblclick: () => { if (!store.state.read_only) this.rename(p, label); } }, title);
      return el('li', { class: `${on ? 'on' : ''} ${off ? 'off' : ''}` }, el('div', { class: 'row' }, this.ball(p.name, i), label,
        el('span', { class: 'quiet' }, `${(100 * p.share).toFixed(1)} %`),
        el('button', { title: `Rename ${title}`, 'aria-label': `Rename ${title}`, 'data-rename': p.name, disabled: store.state.read_only, onclick: () => this.rename(p, label) }, glyph('pencil')),
        el('button', { title: `${off ? 'Show' : 'Hide'} ${p.name} (H)`, 'aria-label': `Hide ${p.name}`, 'aria-pressed': String(off), 'data-hide': p.name,
          onclick: () => this.toggle(p.name) }, glyph(off ? 'hidden' : 'eye')),
        el('button', { title: `Remove ${p.name} (Delete)`, 'aria-label': `Remove ${p.name}`, disabled: store.state.read_only,
          onclick: () => { store.select(p.name); this.actions.remove(); } }, glyph('trash'))));
    });
    byId('parts').replaceChildren(
      el('h2', { id: 'parts-title' }, 'Parts', el('button', { class: 'small', disabled: store.state.read_only, onclick: this.actions.newPart }, 'New')),
      rows.length ? el('ul', { class: 'list' }, ...rows) : el('p', {}, 'None yet. Press P and click on the object to select one.'));
  }
}

export class HistoryPanel {
  /** @param {import('./store.js').Store} store @param {import('./stage.js').Stage} stage */
  constructor(store, stage) {
    this.store = store;
    this.stage = stage;
    this.thumbs = new Thumbs();
    /** @type {Set<string>} steps whose picture could not be fetched, by thumbKey() */
    this.without = new Set();
    this.fetching = false;
    store.on('state', () => this.draw());
    store.on('mode', () => { this.thumbs.clear(); this.without.clear(); });  // the pictures are of another object
    stage.addEventListener('exact', () => this.keepThumb(stage));
    stage.addEventListener('settled', () => this.fetchThumbs());
    byId('history').addEventListener('scroll', () => this.fetchThumbs(), true);
  }

  /** The first visible step without a picture, as those that were made by a command or in another window. @returns {{edit: import('./store.js').Edit | null, done: number} | undefined} */
  missing() {
    const steps = this.store.state.history.filter((e) => !e.set_aside);
    const rows = [...byId('history').querySelectorAll('li[data-step]')], list = byId('history').querySelector('ul')?.getBoundingClientRect();
    const inSight = rows.filter((row) => { const r = row.getBoundingClientRect(); return list && r.bottom > list.top && r.top < list.bottom; });
    return inSight.map((row) => Number(/** @type {HTMLElement} */ (row).dataset.step)).map((done) => ({ edit: steps[done - 1] ?? null, done }))
      .find(({ edit }) => !this.thumbOf(edit) && !this.without.has(this.thumbKey(edit).join()));
  }

  /** Fetches missing pictures one after the other, while the program has nothing else to do. */
  async fetchThumbs() {
    if (this.fetching || !this.stage.settled()) return;
    this.fetching = true;
    for (let step = this.missing(); step && this.stage.settled(); step = this.missing()) if (!await this.fetchThumb(step)) break;
    this.fetching = false;
  }

  /** @param {{edit: import('./store.js').Edit | null, done: number}} step @returns {Promise<boolean>} whether the history is still the same */
  async fetchThumb({ edit, done }) {
    const key = this.thumbKey(edit), { revision } = this.store.state;
    this.without.add(key.join());  // so that it is not asked for again, even if it fails
    try {
      const camera = resized(this.stage.camera.home.lens, kWidth, kHeight);
      this.thumbs.keep(...key, await createImageBitmap(await postForBlob('step', { camera, samples: 2, done }, revision)));
      byId('history').querySelector(`li[data-step="${done}"] .thumb`)?.replaceWith(this.thumb(edit, ''));  // not draw(), which would scroll the list
    } catch (error) {
      if (/** @type {any} */ (error).status !== 409) return true;
      this.without.delete(key.join());
      return false;
    }
    return true;
  }

  /** Keeps the present picture as that of the last edit. @param {import('./stage.js').Stage} stage */
  keepThumb(stage) {
    const edit = this.store.last() ?? null;
    if (this.thumbOf(edit) || stage.preview || stage.channel !== 'rgb') return;
    this.thumbs.keep(...this.thumbKey(edit), stage.picture);
    this.draw();
  }

  /** The key of the edit's picture, and a text for what it shows: when that changes, the picture is outdated. @param {import('./store.js').Edit | null} edit null: the object before all edits @returns {[string, string]} */
  thumbKey(edit) {
    const { state, object } = this.store;
    return [`thumb ${state.folder} ${edit?.id ?? ''}`, `${object?.summary} ${JSON.stringify(edit?.params)}`];
  }

  /** @param {import('./store.js').Edit | null} edit */
  thumbOf(edit) { return this.thumbs.get(...this.thumbKey(edit)); }

  /** @param {import('./store.js').Edit | null} edit @param {string} otherwise name of a glyph */
  thumb(edit, otherwise) {
    const url = this.thumbOf(edit);
    return url ? el('img', { class: 'thumb', src: url, alt: '' }) : el('span', { class: 'thumb' }, glyph(otherwise));
  }

  /** @param {import('./store.js').Edit} e @param {number} index */
  row(e, index) {
    const { store } = this, locked = store.state.read_only;
    const now = index === store.state.done - 1 && e.done;
    const label = el('button', { class: 'label', disabled: locked, title: e.done ? 'Go back to this step' : 'Go forward to this step', 'aria-current': now ? 'step' : undefined,
      onclick: () => store.change('goto', { done: index + 1 }) }, e.name || (opNames[e.op] ?? e.op), ' ', el('span', { class: 'quiet' }, describe(e)));
    return el('li', { class: [now ? 'on' : '', e.enabled ? '' : 'off', e.done ? '' : 'undone'].join(' '), 'data-step': index + 1 }, el('div', { class: 'row' },
      this.thumb(e, opGlyphs[e.op] ?? 'paint'), label,
      el('button', { 'aria-label': `Rename ${e.id}`, title: 'Rename', disabled: locked, onclick: () => this.rename(e, label) }, glyph('pencil')),
      el('button', { 'aria-label': e.enabled ? `Switch ${e.id} off` : `Switch ${e.id} on`, title: e.enabled ? 'Switch off' : 'Switch on', 'aria-pressed': String(!e.enabled), disabled: locked,
        onclick: () => store.change('toggle', { id: e.id }) }, glyph(e.enabled ? 'eye' : 'hidden'))));
  }

  /** @param {import('./store.js').Edit} e @param {Element} label */
  rename(e, label) {
    nameInPlace(label, e.name ?? '', `Name of ${e.id}`, (name) => { if (name === null) this.draw(); else this.store.change('rename', { id: e.id, name }); });
  }

  draw() {
    const { store } = this, all = store.state.history;
    const steps = all.filter((e) => !e.set_aside), aside = all.filter((e) => e.set_aside);
    const rows = steps.map((e, i) => this.row(e, i)).reverse();
    const start = el('li', { class: store.state.done === 0 ? 'on' : '', 'data-step': 0 }, el('div', { class: 'row' }, this.thumb(null, 'look'),
      el('button', { class: 'label', disabled: store.state.read_only, title: 'Go back to the object before all edits', 'aria-current': store.state.done === 0 ? 'step' : undefined,
        onclick: () => store.change('goto', { done: 0 }) }, 'As reconstructed')));
    byId('history').replaceChildren(el('h2', { id: 'history-title' }, 'History'),
      el('ul', { class: 'list tall' }, ...rows, start, ...(aside.length ? [this.aside(aside)] : [])));
  }

  /** @param {import('./store.js').Edit[]} aside */
  aside(aside) {
    return el('li', {}, el('details', {}, el('summary', {}, `${aside.length} set aside by later edits`),
      el('ul', { class: 'list' }, ...aside.map((e) => el('li', { class: 'undone' }, el('div', { class: 'row' },
        el('span', { class: 'label' }, e.name || opNames[e.op], ' ', el('span', { class: 'quiet' }, describe(e))),
        el('button', { class: 'small', onclick: () => this.store.change('restore', { id: e.id }) }, 'Restore'))))),
      el('button', { class: 'small danger', onclick: () => this.store.change('forget') }, 'Forget these')));
  }
}

export class PhotoStrip {
  /** @param {import('./store.js').Store} store @param {import('./stage.js').Stage} stage @param {(name: string) => void} go */
  constructor(store, stage, go) {
    this.store = store;
    this.stage = stage;
    this.go = go;
    /** @type {Map<string, string>} */
    this.urls = new Map();
    /** @type {any[]} */
    this.views = [];
    /** @type {HTMLElement[]} visible buttons without pictures */
    this.wanted = [];
    this.loading = false;
    store.on('mode', ({ mode }) => { if (mode === 'project') this.begin(); });
    stage.addEventListener('photo', () => this.mark());
    stage.addEventListener('exact', () => this.loadWanted());
  }

  begin() {
    for (const url of this.urls.values()) URL.revokeObjectURL(url);
    this.urls.clear();
    this.wanted = [];
    this.views = this.store.object.views.filter((v) => v.photo);
    const strip = byId('strip');
    if (this.views.length === 0) {
      strip.replaceChildren(el('p', {}, 'The photographs are not where they were when the object was made.'));
      return;
    }
    const seen = new IntersectionObserver((entries) => {
      for (const e of entries) if (e.isIntersecting) {
        seen.unobserve(e.target);
        this.wanted.push(/** @type {HTMLElement} */ (e.target));
      }
      if (this.stage.exact) this.loadWanted();
    }, { root: strip, rootMargin: '0px 400px' });
    strip.replaceChildren(...this.views.map((v) => el('button', { 'aria-label': `Photograph ${v.name}`, title: v.name, 'aria-pressed': 'false', 'data-view': v.name, onclick: () => this.go(v.name) })));
    for (const b of strip.children) seen.observe(b);
  }

  /** Loads pictures one after the other, so that they do not delay the packs and frames of the object. */
  async loadWanted() {
    if (this.loading) return;
    this.loading = true;
    for (let button = this.wanted.shift(); button; button = this.wanted.shift()) await this.load(button);
    this.loading = false;
  }

  /** @param {HTMLElement} button */
  async load(button) {
    try {
      button.replaceChildren(el('img', { src: await this.url(button.dataset.view ?? '', 96), alt: '', draggable: false }));
    } catch { /* the button stays without a picture */ }
  }

  /** @param {string} view @param {number} width @returns {Promise<string>} */
  async url(view, width) {
    const key = `${view} ${width}`, known = this.urls.get(key);
    if (known) return known;
    const url = URL.createObjectURL(await getBlob(`/api/photo/${view.split('/').map(encodeURIComponent).join('/')}?width=${width}`));
    this.urls.set(key, url);
    return url;
  }

  mark() {
    for (const b of byId('strip').children) {
      const on = b.dataset.view === this.stage.photo;
      b.setAttribute('aria-pressed', String(on));
      if (on) b.scrollIntoView({ block: 'nearest', inline: 'nearest' });
    }
  }

  /** @param {number} step */
  next(step) {
    if (!this.views.length) return;
    const at = this.views.findIndex((v) => v.name === this.stage.photo);
    this.go(this.views[(at + step + this.views.length) % this.views.length].name);
  }
}

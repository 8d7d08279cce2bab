// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Shows what is open when it is not an object: a folder, a capture and what its check found, a running reconstruction. Loaded when needed. */
import { byId, complain, el, select, toast } from './dom.js';
import { getBlob, postJson } from './api.js';

/** @type {[string, string][]} first word of the name of a stage, and the name that is shown */
const stages = [['loading', 'Photographs'], ['start', 'Outline'], ['geometry', 'Shape'], ['polish', 'Polish'], ['surface', 'Surface'], ['appearance', 'Light, color and material'], ['finer', 'Finer surface'], ['residual', 'Correction']];

/** @param {number} seconds */
function clock(seconds) {
  const s = Math.max(0, Math.round(seconds));
  return `${Math.floor(s / 60)}:${String(s % 60).padStart(2, '0')}`;
}

/** A path, quoted for a shell if necessary. @param {string} path */
const quoted = (path) => (/^[\w./~-]+$/.test(path) ? path : `'${path.replaceAll("'", "'\\''")}'`);

/** A command, and a button that copies it. @param {string} command */
function copied(command) {
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(command);
      toast('The command is copied.');
    } catch { toast('The browser does not let this page copy; select the command.', { bad: true }); }
  };
  return el('div', { class: 'inline' }, el('pre', { class: 'command' }, command), el('button', { onclick: copy }, 'Copy'));
}

export class Places {
  /** @param {import('./store.js').Store} store */
  constructor(store) {
    this.store = store;
    store.on('state', (state) => this.draw(state));
    this.draw(store.state);
    store.line.on('making', () => this.show());
    store.line.on('progress', (p) => { if (p.job === 'reconstruct') this.progress(p); });
  }

  /** @param {any} state */
  draw(state) {
    const place = byId('place');
    if (state.mode === 'project') return place.replaceChildren();
    const column = el('div', { class: 'column' });
    const make = { library: () => this.library(state), capture: () => this.capture(state), checking: () => this.checking(state), reconstructing: () => this.running(state), failed: () => this.failed(state) }[/** @type {string} */ (state.mode)];
    column.append(...(make ? make() : [el('p', {}, 'Opening…')]));
    place.replaceChildren(column);
  }

  /** @param {any} state */
  library(state) {
    const open = (/** @type {string} */ id) => async () => { try { await this.store.take(await postJson('open', { id })); } catch (error) { complain(error); } };
    const again = () => el('button', { class: 'big', onclick: async () => { try { await this.store.take(await postJson('close')); } catch (error) { complain(error); } } }, 'Refresh');
    const sample = state.sample ? el('button', { class: 'big primary', onclick: open('sample') }, 'Try the sample') : null;
    if (state.entries.length === 0)
      return [el('h2', {}, 'Nothing here yet'),
        el('p', {}, 'An object is made from photographs whose cameras are known, with masks of what is the object. Put such a capture into this folder:'),
        el('pre', {}, state.folder),
        el('p', {}, 'A capture is a folder in one of these forms:'), el('pre', {}, state.formats),
        el('p', {}, 'From photographs alone, this command makes a capture. PHOTOS is their folder; COLMAP finds the cameras. Come back to this page afterwards.'),
        copied(`cei3d capture PHOTOS -o ${quoted(`${state.folder}/capture`)}`),
        el('div', { class: 'inline' }, sample, again())];
    const damaged = (/** @type {any} */ e) => el('div', { class: 'card error' }, el('b', {}, e.name), el('span', { class: 'kind' }, 'photographs that cannot be read'), el('small', {}, e.problem));
    const card = (/** @type {any} */ e) => e.problem ? damaged(e) : el('button', { class: 'card', onclick: open(e.id) }, el('b', {}, e.name),
      el('span', { class: 'kind' }, e.kind === 'capture' ? 'photographs' : e.finished ? 'object' : 'object, not finished'),
      el('small', {}, e.kind === 'capture' ? 'Check it and make an object from it' : e.finished ? 'Edit it' : 'Continue it'));
    return [el('h2', {}, 'Objects and captures'), el('p', {}, state.folder), el('div', { class: 'cards' }, ...state.entries.map(card)),
      el('div', { class: 'inline' }, sample, state.entries.some((/** @type {any} */ e) => e.problem) ? again() : null)];
  }

  /** @param {any} state */
  checking(state) {
    return [el('h2', {}, state.name), el('p', { class: 'inline' }, el('span', { class: 'spinner' }), 'Checking the photographs, cameras and masks')];
  }

  /** @param {any} state */
  failed(state) { return [el('h2', {}, 'This cannot be opened'), el('p', {}, state.error)]; }

  /** @param {any} state */
  capture(state) {
    const check = state.check, findings = check?.findings ?? [];
    const usable = state.resume || check?.usable;
    const cards = findings.map((/** @type {any} */ f) => el('div', { class: `card ${f.severity}` },
      el('span', { class: 'kind' }, { error: 'must be fixed', warning: 'may cost quality', note: 'note' }[/** @type {string} */ (f.severity)] ?? f.severity), el('b', {}, f.what), el('small', {}, f.fix)));
    const minutes = select({ id: 'minutes', 'aria-label': 'Time' }, [['60', '1 minute: a first look'], ['300', '5 minutes: good'], ['900', '15 minutes: better'], ['3600', '1 hour: best']], '300');
    const go = el('button', { class: 'big primary', id: 'make', disabled: !usable, onclick: () => this.start(Number(minutes.value), state.resume) }, state.resume ? 'Go on where it stopped' : 'Make the object');
    return [el('h2', {}, state.name), ...(check ? this.facts(check) : [el('p', {}, 'This object is not finished. What was done so far is kept.')]),
      el('div', { class: 'cards' }, ...cards),
      el('div', { class: 'inline' }, go, state.resume ? null : minutes),
      el('p', {}, `It is kept in ${state.project}.`)];
  }

  /** @param {any} check */
  facts(check) {
    const views = Object.entries(check.splits).map(([name, s]) => `${/** @type {any} */ (s).views} ${name}`).join(', ');
    const fact = (/** @type {string} */ title, /** @type {string} */ text) => el('div', { class: 'card good' }, el('b', {}, title), el('small', {}, text));
    return [el('div', { class: 'cards' }, fact('Photographs found', views), fact('Cameras understood', `${check.format}, ${check.normalization ? 'object located' : 'object not located'}`),
      ...Object.entries(check.splits).slice(0, 1).map(([, s]) => fact('Masks found', `the object fills ${(100 * /** @type {any} */ (s).coverage.mean).toFixed(0)} % of a picture on average`)))];
  }

  /** @param {number} seconds @param {boolean} resume */
  async start(seconds, resume) {
    try {
      await postJson('reconstruct', resume ? { resume: true } : { seconds });
    } catch (error) { complain(error); }
  }

  /** @param {any} state */
  running(state) {
    return [el('h2', {}, `Making ${state.name}`),
      el('img', { id: 'making-picture', alt: 'The object so far', width: 320, hidden: true }),
      el('progress', { max: 1, value: 0, id: 'making', 'aria-label': 'Reconstruction' }),
      el('p', { id: 'making-text', role: 'status' }, 'Starting'),
      el('ol', { class: 'stages', id: 'making-stages' }, ...stages.map(([key, text]) => el('li', { 'data-stage': key }, text))),
      el('div', { class: 'inline' }, el('button', { class: 'big', id: 'stop', onclick: () => postJson('cancel').catch(complain) }, 'Stop and keep what is done'))];
  }

  /** Shows the present state of the object that is being reconstructed. */
  async show() {
    const picture = byId('making-picture');
    if (!picture) return;
    try {
      const url = URL.createObjectURL(await getBlob('/api/making'));
      URL.revokeObjectURL(picture.src);
      picture.src = url;
      picture.hidden = false;
    } catch { /* the next picture comes soon */ }
  }

  /** @param {any} p */
  progress(p) {
    const bar = byId('making');
    if (!bar) return;
    bar.value = p.fraction;
    byId('making-text').textContent = [`${Math.round(100 * p.fraction)} %`, p.stage, p.message, p.seconds_left >= 0 ? `${clock(p.seconds_left)} left` : ''].filter(Boolean).join(' · ');
    const items = [...byId('making-stages').children];
    const now = items.findIndex((li) => p.stage.startsWith(/** @type {any} */ (li).dataset.stage));
    if (now < 0) return;
    items.forEach((li, i) => { li.className = i < now ? 'done' : i === now ? 'now' : ''; });
  }
}

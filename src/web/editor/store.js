// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** What the page knows of the program: its state, and how to change it. One change at a time, in order. */
import { ApiError, getJson, hasKey, Line, postJson } from './api.js';
import { complain } from './dom.js';
import { Newest } from './newest.js';
import { started } from './start.js';

/** @typedef {import('./messages.js').ProjectState} State of an open project; of other places it has `mode`, and what they show */
/** @typedef {import('./messages.js').ObjectInfo} ObjectInfo */
/** @typedef {State['history'][number]} Edit */
/** @typedef {State['parts'][number]} Part */

export class Store extends EventTarget {
  constructor() {
    super();
    /** @type {State} */
    this.state = /** @type {any} */ ({ mode: 'opening', history: [], parts: [] });
    /** @type {ObjectInfo} none before a project is open */
    this.object = /** @type {any} */ (null);
    /** @type {string | null} name of the selected part */
    this.part = null;
    this.made = false;  // the object that is open was made while this page looked on
    this.saving = 0;
    this.lost = false;
    this.line = new Line();
    this.stranger = false;  // a program answers that does not know this page's key
    let before = false;
    this.line.on('welcome', ({ complete }) => {
      this.stranger = false;
      this.setLost(false);
      if (before && !complete) this.refresh();  // else the news that come now say what is to be done
      before = true;
    });
    this.line.on('stranger', () => { this.stranger = true; this.setLost(true); });
    this.line.on('lost', () => this.setLost(true));
    this.line.on('state', (news) => this.hear(news));
    /** @type {Promise<any>} */
    this.queue = Promise.resolve();
    this.begun = false;
    this.refreshing = new Newest(() => this.refreshNow());
    if (hasKey()) this.refresh();
  }

  /** @param {string} type @param {(detail: any) => void} listener */
  on(type, listener) { this.addEventListener(type, (e) => listener(/** @type {CustomEvent} */ (e).detail)); }
  /** @param {string} type @param {any} [detail] */
  emit(type, detail) { this.dispatchEvent(new CustomEvent(type, { detail })); }

  /** @param {boolean} lost */
  setLost(lost) {
    this.lost = lost;
    this.emit('saving');
  }

  /** The answer to a change of this window, which may be on its way, brings the same state. @param {{mode: string, revision: string}} news */
  async hear({ mode, revision }) {
    await this.queue;
    await this.refreshing.running;
    if (mode !== 'project' || this.state.mode !== mode || this.state.revision !== revision) await this.refresh();
  }

  /** One after the other: two that take the same state would both open the object. */
  refresh() { return this.refreshing.run(); }

  async refreshNow() {
    try {
      const got = this.begun ? null : await started;
      this.begun = true;
      this.line.far ||= got?.far ?? false;
      await this.take(got?.state ?? await getJson('/api/state'), got?.object);
    } catch (error) {
      if (/** @type {any} */ (error).status !== 0) complain(error);
    }
  }

  /** @param {any} state @param {ObjectInfo} [object] that is open then */
  async take(state, object) {
    const before = this.state;
    if (state.mode === 'project' && (before.mode !== 'project' || before.folder !== state.folder)) {
      this.object = object ?? await getJson('/api/object');
      this.part = null;
    }
    state.history ??= [];
    state.parts ??= [];
    if (JSON.stringify(state.packs) === JSON.stringify(before.packs)) state.packs = before.packs;  // the same object: nothing is new
    this.state = state;
    if (before.mode !== state.mode) this.made = before.mode === 'reconstructing' && state.mode === 'project';
    if (this.part && !state.parts.some((/** @type {Part} */ p) => p.name === this.part)) this.part = null;
    if (before.mode !== state.mode || before.folder !== state.folder) this.emit('mode', state);
    this.emit('state', state);
    if (before.revision !== state.revision) this.emit('revision', { before, state });
  }

  /** @param {string | null} name */
  select(name) {
    this.part = name;
    this.emit('part', name);
  }

  /**
   * Changes the object. Waits for the changes before it; where the connection is lost it tries again when it is back.
   * @param {string} route @param {object | (() => Promise<object>)} [body] a function is called before each try: it sends the files that the body
   * names, which a program that was started anew does not have
   * @returns {Promise<any>} the result; undefined: it failed and the user knows
   */
  change(route, body = {}) {
    ++this.saving;
    this.emit('saving');
    const done = this.queue.then(() => this.send(route, body)).catch(complain);
    this.queue = done.finally(() => {
      --this.saving;
      this.emit('saving');
    });
    return done;
  }

  /** @param {string} route @param {any} make @returns {Promise<any>} */
  async send(route, make) {
    const before = this.state;
    for (let tries = 0; ;) {
      /** @type {any} */
      let body = {};
      try {
        body = typeof make === 'function' ? await make() : make;
        ++tries;
        const answer = await postJson(route, body, before.revision);
        await this.take(answer.state);
        return answer.result;
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
        if (error.status === 409) {
          await this.refresh();
          // The first try arrived before the connection was lost: the history has grown by it.
          const last = this.last();
          if (route === 'edit' && tries > 1 && last?.op === body.op && this.state.done === before.done + 1) return last;
          throw error;
        }
        if (error.status !== 0) throw error;
        this.setLost(true);
        await new Promise((resolve) => this.line.addEventListener('welcome', resolve, { once: true }));
      }
    }
  }

  /** Edits that are done, in order. @returns {Edit[]} */
  done() { return this.state.history.slice(0, this.state.done); }
  /** The last edit that is done. @returns {Edit | undefined} */
  last() { return this.done().at(-1); }
  canUndo() { return this.state.done > 0; }
  canRedo() { return this.state.history.some((e) => !e.done && !e.set_aside); }
}

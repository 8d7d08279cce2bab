// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** The state of the program as the page knows it, and changes to it, which are sent one at a time, in order. */
import { ApiError, getJson, hasKey, Line, postJson } from './api.js';
import { complain } from './dom.js';
import { Newest } from './newest.js';
import { started } from './start.js';

/** @typedef {import('./messages.js').ProjectState} State of an open project; in other modes it has `mode`, and what places.js shows */
/** @typedef {import('./messages.js').ObjectInfo} ObjectInfo */
/** @typedef {State['history'][number]} Edit */
/** @typedef {State['parts'][number]} Part */

const kTries = 5;  // of an edit whose files are gone

export class Store extends EventTarget {
  constructor() {
    super();
    /** @type {State} */
    this.state = /** @type {any} */ ({ mode: 'opening', history: [], parts: [] });
    /** @type {ObjectInfo} null before a project is open */
    this.object = /** @type {any} */ (null);
    /** @type {string | null} name of the selected part */
    this.part = null;
    this.made = false;  // the object was reconstructed while this page was open
    this.saving = 0;
    this.lost = false;
    this.line = new Line();
    this.unknownServer = false;  // a program with another key answers
    let before = false;
    this.line.on('welcome', ({ complete }) => {
      this.unknownServer = false;
      this.setLost(false);
      if (before && !complete) this.refresh();  // otherwise the missed messages follow
      before = true;
    });
    this.line.on('unknownServer', () => { this.unknownServer = true; this.setLost(true); });
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

  /** Another window may have changed the state. Waits for the answer to a change of this window first, which may bring that state. @param {{mode: string, revision: string}} news */
  async hear({ mode, revision }) {
    await this.queue;
    await this.refreshing.running;
    if (mode !== 'project' || this.state.mode !== mode || this.state.revision !== revision) await this.refresh();
  }

  /** Fetches the state. One call at a time, because two calls that get the same state would both open the object. */
  refresh() { return this.refreshing.run(); }

  async refreshNow() {
    try {
      const got = this.begun ? null : await started;
      this.begun = true;
      this.line.slow ||= got?.slow ?? false;
      await this.take(got?.state ?? await getJson('/api/state'), got?.object);
    } catch (error) {
      if (/** @type {any} */ (error).status !== 0) complain(error);
    }
  }

  /** Makes a state the present one. @param {any} state @param {ObjectInfo} [object] that is open in it */
  async take(state, object) {
    const before = this.state;
    if (state.mode === 'project' && (before.mode !== 'project' || before.folder !== state.folder)) {
      this.object = object ?? await getJson('/api/object');
      this.part = null;
    }
    state.history ??= [];
    state.parts ??= [];
    if (JSON.stringify(state.packs) === JSON.stringify(before.packs)) state.packs = before.packs;  // the same object, by which Live sees that no pack changed
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
   * Changes the object. Waits for the changes before it; if the connection is lost, tries again when it is back.
   * @param {string} route @param {object | (() => Promise<object>)} [body] a function is called before each try and uploads the files that
   * the body names, because a program that was restarted does not have them
   * @returns {Promise<any>} the result; undefined: it failed, and the user was told
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
          // An earlier try arrived although its answer was lost: then the history has grown by this edit.
          const last = this.last();
          if (route === 'edit' && tries > 1 && last?.op === body.op && this.state.done === before.done + 1) return last;
          throw error;
        }
        // The files of the edit were sent to a program that was restarted since.
        if (error.status === 410 && typeof make === 'function' && tries < kTries) continue;
        // 401: the program was restarted, and this page does not have its new key yet.
        if (error.status !== 0 && error.status !== 401) throw error;
        this.setLost(true);
        await this.line.back();
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

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Material: a tool whose controls are in the panel. Dragging a slider previews a change; releasing it stores the edit. */
import { complain, el, field, select } from './dom.js';
import { postJson } from './api.js';
import { Newest } from './newest.js';

/** @type {[string, string, string][]} key, label, what it means */
const sliders = [
  ['roughness', 'Roughness', '0: mirror, 1: chalk'],
  ['specular', 'Specular', 'strength of the reflection where it is not a metal'],
  ['metalness', 'Metalness', '0: no metal, 1: metal'],
];

export class MaterialTool {
  /** @param {import('./stage.js').Stage} stage @param {import('./store.js').Store} store */
  constructor(stage, store) {
    this.stage = stage;
    this.store = store;
    this.name = 'material';
    this.label = 'Material';
    this.hint = 'Drag a slider to preview a change; releasing it stores one step. Double-click a slider to reset it.';
    this.number = 0;
    /** @type {object | null} the change that the next preview shows */
    this.wanted = null;
    this.previews = new Newest(() => this.previewNow());
  }

  /** The last edit, if it changed the material of what is selected now: a further change then replaces it. */
  own() {
    const last = this.store.last();
    return last?.op === 'material' && last.enabled && (last.params.part ?? '') === (this.store.part ?? '') ? last : null;
  }

  values() {
    const base = this.store.object?.material ?? {};
    /** @type {any} */
    const values = { roughness: base.roughness, specular: base.specular, metalness: base.metalness };
    for (const e of this.store.done())
      if (e.op === 'material' && e.enabled && (!e.params.part || e.params.part === this.store.part))
        for (const [key] of sliders) if (e.params[key] !== undefined) values[key] = e.params[key];
    return values;
  }

  panel() {
    const values = this.values(), params = this.own()?.params ?? {};
    const row = (/** @type {[string, string, string]} */ [key, label, title]) => field(label, `material-${key}`, [0, 1, 0.01], values[key] ?? 0.5, (v) => v.toFixed(2),
      (v) => this.try({ [key]: v }), {
        title, 'data-key': key, onchange: (/** @type {any} */ e) => this.keep({ [key]: Number(e.target.value) }),
        ondblclick: () => this.keep({ [key]: /** @type {Record<string, any>} */ (this.store.object.material)[key] }),
      });
    const tint = params.color ?? '#b0b0b0';
    return [
      el('p', {}, this.store.part ? `Of the part ${this.store.part}.` : 'Of the whole object; select a part to change only that.'),
      ...sliders.map(row),
      el('label', { class: 'field wide' }, 'Color', el('span', { class: 'inline' }, el('input', { type: 'color', value: tint, id: 'material-color',
        oninput: (/** @type {any} */ e) => this.try({ color: e.target.value, ...this.replaced() }), onchange: (/** @type {any} */ e) => this.keep({ color: e.target.value, ...this.replaced() }) }),
        el('label', { title: 'The color replaces the texture; otherwise it tints it' }, el('input', { type: 'checkbox', id: 'material-replace', checked: params.replace === true }), ' no texture'))),
      el('label', { class: 'field' }, 'Preset', select({ id: 'material-preset' }, [['', 'choose'], ...(this.store.object?.presets ?? []).map((name) => [name, name])], params.material,
        (material) => { if (material) this.keep({ material }, true); })),
    ];
  }

  replaced() { return /** @type {any} */ (document.getElementById('material-replace'))?.checked ? { replace: true } : {}; }

  /** Parameters of the edit: the change, and what the last edit set besides. @param {object} change @param {boolean} fresh nothing of the last edit */
  params(change, fresh = false) {
    const own = fresh ? {} : { ...(this.own()?.params ?? {}) };
    delete (/** @type {any} */ (own).part);
    return { ...own, ...change, ...(this.store.part ? { part: this.store.part } : {}) };
  }

  /** @param {object} change */
  try(change) {
    this.wanted = change;
    return this.previews.run();
  }

  async previewNow() {
    if (!this.wanted) return;
    const number = this.number, params = this.params(this.wanted);
    this.wanted = null;
    try {
      const made = await postJson('preview', { op: 'material', params, amend: this.own() !== null });
      if (number === this.number) await this.stage.tryEdit(made.token, true);
    } catch (error) { complain(error); }
  }

  /** @param {object} change @param {boolean} [fresh] */
  async keep(change, fresh = false) {
    ++this.number;
    this.wanted = null;
    // A function, because the edit that it amends is known only when the changes before it are made.
    await this.store.change('edit', async () => ({ op: 'material', params: this.params(change, fresh), amend: this.own() !== null }));
    await this.stage.tryEdit(null);
  }

  leave() {
    ++this.number;
    this.wanted = null;
    if (this.stage.preview) this.stage.tryEdit(null);
  }
}

/** A summary of the object, shown when no tool needs the panel. @param {import('./store.js').Store} store */
export function objectPanel(store) {
  const o = store.object;
  if (!o) return [];
  return [el('p', {}, o.summary), ...(o.warning ? [el('p', {}, o.warning)] : [])];
}

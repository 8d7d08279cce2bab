// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Makes and changes elements of the page. Text is always set as text, never as markup. */

/**
 * A new element.
 * @param {string} tag
 * @param {Record<string, any>} [attributes] "class", "on..." functions, properties or attributes
 * @param {...(Node | string | null | undefined)} children
 * @returns {any}
 */
export function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
    else if (key === 'class') node.className = value;
    else if (key in node && typeof value !== 'string') /** @type {any} */ (node)[key] = value;
    else node.setAttribute(key, value === true ? '' : String(value));
  }
  for (const child of children) if (child !== null && child !== undefined) node.append(child);
  return node;
}

/** A list to choose from. @param {Record<string, any>} attributes @param {string[][]} list of value and text @param {string} value that is chosen @param {(value: string) => void} [set] */
export const select = (attributes, list, value, set) => el('select', { ...attributes, onchange: set && ((/** @type {any} */ e) => set(e.target.value)) },
  ...list.map(([v, text]) => el('option', { value: v, selected: v === value }, text)));

/** @param {string} id @param {[number, number, (number | string)?]} range minimum, maximum, step @param {number} value @param {(value: number) => void} set @param {Record<string, any>} [more] attributes */
export const slider = (id, [min, max, step = 'any'], value, set, more) => el('input', { type: 'range', id, min, max, step: String(step), value: String(value),
  oninput: (/** @type {any} */ e) => set(Number(e.target.value)), ...more });

/**
 * A slider of a panel with its label, and its value as text. @param {string} label @param {string} id @param {[number, number, (number | string)?]} range @param {number} value
 * @param {(value: number) => string} text @param {(value: number) => void} set @param {Record<string, any>} [more] attributes of the slider
 */
export function field(label, id, range, value, text, set, more) {
  const out = el('output', {}, text(value));
  return el('label', { class: 'field' }, label, slider(id, range, value, (v) => { set(v); out.textContent = text(v); }, more), out);
}

/** @param {string} id @returns {any} */
export const byId = (id) => document.getElementById(id);

/** Updates an input to a value that was changed elsewhere, if the page has that input now. @param {string} id @param {number | string} value */
export function showValue(id, value) {
  const input = byId(id);
  if (input) input.value = String(value);
}

const NS = 'http://www.w3.org/2000/svg';
/** @type {Record<string, string>} paths on a grid of 24 */
const GLYPHS = {
  look: 'M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12zM12 9.3a2.7 2.7 0 1 1 0 5.4 2.7 2.7 0 0 1 0-5.4z',
  paint: 'M14.5 4.5l5 5L10 19c-2 2-6 1.5-6.5 1.5C4 19.5 4 16 5.5 14.5zM12 7l5 5',
  erase: 'M8 20h12M4.5 14.5L13 6l6 6-8 8H8z',
  decal: 'M4 5h11v11H4zM8 8h4v4H8zM15 9l5-1.5 2 11-11 1.5-.7-4',
  bend: 'M4 19c0-9 5-13 16-13M4 16.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5zM20 3.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5zM8 8.5h4v4H8z',
  part: 'M12 3v18M3 12h18M12 7.5a4.5 4.5 0 1 0 0 9 4.5 4.5 0 0 0 0-9z',
  grab: 'M12 21c-4 0-6.5-3-6.5-6.5V9m3 3V5.5m3 5.5V4m3 7V5.5m3 7V8v6.5C17.5 18.5 15.5 21 12 21M5.5 9v3',
  material: 'M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18zM8 8.5a4 4 0 0 1 3-2',
  light: 'M12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8zM12 2.5V5m0 14v2.5M2.5 12H5m14 0h2.5M5.3 5.3L7 7m10 10l1.7 1.7M5.3 18.7L7 17m10-10l1.7-1.7',
  undo: 'M8 5L3.5 9.5 8 14M3.5 9.5H14a6 6 0 0 1 0 12h-3', redo: 'M16 5l4.5 4.5L16 14M20.5 9.5H10a6 6 0 0 0 0 12h3',
  trash: 'M5 7h14M10 7V4.5h4V7M7 7l1 13h8l1-13M10.5 11v5.5m3-5.5v5.5', eye: 'M2.5 12S6 6 12 6s9.5 6 9.5 6S18 18 12 18 2.5 12 2.5 12zM12 10a2 2 0 1 1 0 4 2 2 0 0 1 0-4z',
  hidden: 'M4 4l16 16M9 6.5A9 9 0 0 1 12 6c6 0 9.5 6 9.5 6a16 16 0 0 1-3 3.5M6 8.5A15 15 0 0 0 2.5 12S6 18 12 18a9 9 0 0 0 3-.5',
  pencil: 'M4 20l1-4L16 5l3 3L8 19z',
};

/** @param {string} name @returns {SVGElement} */
export function glyph(name) {
  const svg = document.createElementNS(NS, 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('class', 'glyph');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(NS, 'path');
  path.setAttribute('d', GLYPHS[name] ?? '');
  svg.append(path);
  return svg;
}

/**
 * Shows a message for a few seconds; errors stay longer.
 * @param {string} text @param {{bad?: boolean, more?: string}} [options]
 */
export function toast(text, { bad = false, more = '' } = {}) {
  const node = el('div', { class: bad ? 'toast bad' : 'toast' }, text, more ? el('span', { class: 'more' }, ` ${more}`) : null);
  byId('toasts').append(node);
  while (byId('toasts').children.length > 3) byId('toasts').firstChild.remove();
  setTimeout(() => node.remove(), bad ? 9000 : 4000);
}

/** Shows an error. @param {any} error */
export function complain(error) {
  if (error?.status === 499) return;  // the user stopped it
  toast(error?.message ?? String(error), { bad: true, more: error?.hint ?? '' });
}

/**
 * Replaces a node by an input for a new name. Enter, or leaving the input, keeps the name; Esc does not.
 * @param {Element} node @param {string} name @param {string} label @param {(name: string | null) => void} done null: the name stays as it is
 */
export function nameInPlace(node, name, label, done) {
  const input = el('input', { type: 'text', value: name, maxlength: '80', 'aria-label': label });
  const finish = (/** @type {boolean} */ keep) => {
    input.onblur = null;
    input.blur();
    const now = input.value.trim();
    done(keep && now !== name ? now : null);
  };
  input.onkeydown = (/** @type {KeyboardEvent} */ k) => {
    k.stopPropagation();
    if (k.key === 'Enter' || k.key === 'Escape') finish(k.key === 'Enter');
  };
  input.onblur = () => finish(true);
  node.replaceWith(input);
  input.focus();
  input.select();
}

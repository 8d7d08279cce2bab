// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Small helpers for elements. Text is always set as text, never as markup. */

/**
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

/** @param {string} id @returns {any} */
export const byId = (id) => document.getElementById(id);

const NS = 'http://www.w3.org/2000/svg';
/** @type {Record<string, string>} paths on a grid of 24 */
const GLYPHS = {
  look: 'M2.500 12S6 5.500 12 5.500 21.500 12 21.500 12 18 18.500 12 18.500 2.500 12 2.500 12zM12 9.300a2.700 2.700 0 1 1 0 5.400 2.700 2.700 0 0 1 0-5.400z',
  paint: 'M14.500 4.500l5 5L10 19c-2 2-6 1.500-6.500 1.500C4 19.500 4 16 5.500 14.500zM12 7l5 5',
  erase: 'M8 20h12M4.500 14.500L13 6l6 6-8 8H8z',
  decal: 'M4 5h11v11H4zM8 8h4v4H8zM15 9l5-1.500 2 11-11 1.500-.700-4',
  bend: 'M4 19c0-9 5-13 16-13M4 16.500a2.500 2.500 0 1 0 0 5 2.500 2.500 0 0 0 0-5zM20 3.500a2.500 2.500 0 1 0 0 5 2.500 2.500 0 0 0 0-5zM8 8.500h4v4H8z',
  part: 'M12 3v18M3 12h18M12 7.500a4.500 4.500 0 1 0 0 9 4.500 4.500 0 0 0 0-9z',
  grab: 'M12 21c-4 0-6.500-3-6.500-6.500V9m3 3V5.500m3 5.500V4m3 7V5.500m3 7V8v6.500C17.500 18.500 15.500 21 12 21M5.500 9v3',
  material: 'M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18zM8 8.500a4 4 0 0 1 3-2',
  light: 'M12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8zM12 2.500V5m0 14v2.500M2.500 12H5m14 0h2.500M5.300 5.300L7 7m10 10l1.700 1.700M5.300 18.700L7 17m10-10l1.700-1.700',
  undo: 'M8 5L3.500 9.500 8 14M3.500 9.500H14a6 6 0 0 1 0 12h-3', redo: 'M16 5l4.500 4.500L16 14M20.500 9.500H10a6 6 0 0 0 0 12h3',
  trash: 'M5 7h14M10 7V4.500h4V7M7 7l1 13h8l1-13M10.500 11v5.500m3-5.500v5.500', eye: 'M2.500 12S6 6 12 6s9.500 6 9.500 6S18 18 12 18 2.500 12 2.500 12zM12 10a2 2 0 1 1 0 4 2 2 0 0 1 0-4z',
  hidden: 'M4 4l16 16M9 6.500A9 9 0 0 1 12 6c6 0 9.500 6 9.500 6a16 16 0 0 1-3 3.500M6 8.500A15 15 0 0 0 2.500 12S6 18 12 18a9 9 0 0 0 3-.5',
  pencil: 'M4 20l1-4L16 5l3 3L8 19z', compare: 'M12 3v18M4 6h5v12H4zM15 6h5v12h-5z', plus: 'M12 5v14M5 12h14',
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
 * A message that goes away by itself; errors stay longer.
 * @param {string} text @param {{bad?: boolean, more?: string}} [options]
 */
export function toast(text, { bad = false, more = '' } = {}) {
  const node = el('div', { class: bad ? 'toast bad' : 'toast' }, text, more ? el('span', { class: 'more' }, ` ${more}`) : null);
  byId('toasts').append(node);
  while (byId('toasts').children.length > 3) byId('toasts').firstChild.remove();
  setTimeout(() => node.remove(), bad ? 9000 : 4000);
}

/** @param {any} error */
export function complain(error) {
  if (error?.status === 499) return;  // the user stopped it
  toast(error?.message ?? String(error), { bad: true, more: error?.hint ?? '' });
}

/**
 * A field for a new name in the place of a node. Enter and leaving it keep the name, Esc does not.
 * @param {Element} node @param {string} name @param {string} label @param {(name: string | null) => void} done null: it stays as it is
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

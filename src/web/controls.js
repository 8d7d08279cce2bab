// SPDX-License-Identifier: Apache-2.0
// @ts-check
// Moves an Orbit by mouse, touch and keyboard.

/** @typedef {import('./orbit.js').Orbit} Orbit */
/**
 * @typedef {object} Wishes
 * @property {() => void} moved the orbit has changed
 * @property {(degrees: number) => void} turnLight
 * @property {(event: PointerEvent | null) => void} hover null: the pointer is not over the object
 */

const kTurn = 2.6;             // radians per shorter side of the element
const kStep = Math.PI / 36;    // radians per key press
const kLightStep = 5, kLightTurn = 180;  // degrees per key press, and per shorter side

/** What a drag does. @param {PointerEvent} e */
function dragOf(e) {
  if (e.button === 2) return e.shiftKey ? 'light' : 'pan';
  if (e.button === 1) return e.shiftKey ? 'pan' : 'turn';
  return e.shiftKey ? 'pan' : 'turn';
}

export class Controls {
  /**
   * @param {HTMLElement} element that can have the focus
   * @param {Orbit} orbit
   * @param {Wishes} wishes
   */
  constructor(element, orbit, wishes) {
    this.element = element;
    this.orbit = orbit;
    this.wishes = wishes;
    /** @type {Map<number, {x: number, y: number}>} */
    this.pointers = new Map();
    this.drag = '';
    element.style.touchAction = 'none';
    element.addEventListener('contextmenu', (e) => e.preventDefault());
    element.addEventListener('pointerdown', (e) => this.down(e));
    element.addEventListener('pointermove', (e) => this.move(e));
    for (const end of /** @type {const} */ (['pointerup', 'pointercancel']))
      element.addEventListener(end, (e) => this.pointers.delete(e.pointerId));
    element.addEventListener('pointerleave', () => wishes.hover(null));
    element.addEventListener('wheel', (e) => this.wheel(e), {passive: false});
    element.addEventListener('keydown', (e) => this.key(e));
  }

  /** Pixels of the element that count as one whole move. */
  get unit() {
    return Math.max(1, Math.min(this.element.clientWidth, this.element.clientHeight));
  }

  /** @param {PointerEvent} e */
  down(e) {
    this.element.setPointerCapture(e.pointerId);
    this.element.focus({preventScroll: true});
    if (this.pointers.size === 0) this.drag = dragOf(e);
    this.pointers.set(e.pointerId, {x: e.clientX, y: e.clientY});
    e.preventDefault();
  }

  /** @param {PointerEvent} e */
  move(e) {
    const last = this.pointers.get(e.pointerId);
    if (!last) {
      this.wishes.hover(e);
      return;
    }
    const x = (e.clientX - last.x) / this.unit, y = (e.clientY - last.y) / this.unit;
    if (this.pointers.size > 1) this.pinch(e, last, x, y);
    else this.dragged(x, y);
    this.pointers.set(e.pointerId, {x: e.clientX, y: e.clientY});
    this.wishes.moved();
  }

  /** @param {number} x shares of the shorter side @param {number} y */
  dragged(x, y) {
    if (this.drag === 'turn') this.orbit.turn(-kTurn * x, kTurn * y);
    if (this.drag === 'pan') this.orbit.pan(x, y);
    if (this.drag === 'light') this.wishes.turnLight(kLightTurn * x);
  }

  /** Two fingers. @param {PointerEvent} e @param {{x: number, y: number}} last @param {number} x @param {number} y */
  pinch(e, last, x, y) {
    this.orbit.pan(x / this.pointers.size, y / this.pointers.size);
    for (const [id, other] of this.pointers) {
      if (id === e.pointerId) continue;
      const before = Math.hypot(last.x - other.x, last.y - other.y);
      const after = Math.hypot(e.clientX - other.x, e.clientY - other.y);
      if (before > 0 && after > 0) this.orbit.zoom(before / after);
      return;
    }
  }

  /** @param {WheelEvent} e */
  wheel(e) {
    const pixels = e.deltaY * (e.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1);
    this.orbit.zoom(Math.exp(0.0015 * Math.max(-200, Math.min(200, pixels))));
    this.wishes.moved();
    e.preventDefault();
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
    const arrow = arrows[/** @type {keyof arrows} */ (e.key)];
    if (arrow && e.shiftKey) this.orbit.pan(-arrow[0] / 20, arrow[1] / 20);
    else if (arrow) this.orbit.turn(kStep * arrow[0], kStep * arrow[1]);
    else if (e.key === '+' || e.key === '=') this.orbit.zoom(1 / 1.1);
    else if (e.key === '-') this.orbit.zoom(1.1);
    else if (e.key === 'Home') this.orbit.home();
    else if (e.key === '[' || e.key === ']') this.wishes.turnLight(e.key === '[' ? -kLightStep : kLightStep);
    else return;
    this.wishes.moved();
    e.preventDefault();
  }
}

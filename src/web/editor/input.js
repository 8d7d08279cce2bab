// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Pointers and arrow keys on the view: moves the camera itself, and passes everything else to the tool. */
import { toast } from './dom.js';

/**
 * @typedef {{x: number, y: number, pressure: number, shift: boolean, alt: boolean, ctrl: boolean, onObject: boolean, erase: boolean}} Point
 * A place of the pointer, in pixels of the exact frame.
 */

const kTap = 6;  // pixels by which the pointer may move during a click
const kTurn = 0.0065;  // radians a pixel
const kPalm = 500;  // milliseconds after the pen is lifted in which touches count as those of the hand that holds it

export class Input {
  /** @param {import('./stage.js').Stage} stage @param {(p?: Point) => any} tool the tool for a press at a point @param {{undo: () => void, redo: () => void, turnLight: (degrees: number, done: boolean) => void, size: (factor: number) => void}} actions */
  constructor(stage, tool, actions) {
    this.stage = stage;
    this.tool = tool;
    this.actions = actions;
    /** @type {Map<number, {x: number, y: number}>} */
    this.down = new Map();
    /** @type {string | null} what the drag does */
    this.doing = null;
    this.space = false;
    /** @type {any} the tool of the pressed pointer */
    this.used = null;
    /** @type {{x: number, y: number} | null} place of the pointer that is moved by keys, pixels of the frame; null: there is none */
    this.reticle = null;
    /** @type {any} the tool that is dragged by keys; null: none is */
    this.held = null;
    this.touches = { max: 0, moved: 0 };  // maximum number of fingers that were down at once; pixels that they moved
    /** @type {number | null} pointer of the pen that is down */
    this.pen = null;
    this.penLifted = -Infinity;  // when, in milliseconds
    const view = stage.view;
    view.addEventListener('pointerdown', (/** @type {PointerEvent} */ e) => this.press(e));
    view.addEventListener('pointermove', (/** @type {PointerEvent} */ e) => this.move(e));
    view.addEventListener('pointerup', (/** @type {PointerEvent} */ e) => this.release(e));
    view.addEventListener('pointercancel', (/** @type {PointerEvent} */ e) => this.release(e));
    view.addEventListener('pointerleave', () => { if (!this.doing) this.tool().hover?.(null); });
    view.addEventListener('contextmenu', (/** @type {Event} */ e) => e.preventDefault());
    view.addEventListener('wheel', (/** @type {WheelEvent} */ e) => this.wheel(e), { passive: false });
    window.addEventListener('keyup', (e) => { if (e.key === ' ') this.space = false; });
  }

  /** @param {PointerEvent | DragEvent} event @returns {Point} */
  point(event) {
    const e = /** @type {PointerEvent} */ (event);
    const r = this.stage.view.getBoundingClientRect(), { scale } = this.stage.size();
    const x = (e.clientX - r.left) * scale, y = (e.clientY - r.top) * scale;
    return {
      x, y, pressure: e.pointerType === 'pen' ? e.pressure : 1, shift: e.shiftKey, alt: e.altKey, ctrl: e.ctrlKey || e.metaKey,
      onObject: this.stage.onObject(x, y), erase: e.pointerType === 'pen' && (e.buttons & 32) !== 0,
    };
  }

  /** @param {PointerEvent} e */
  press(e) {
    if (/** @type {Element} */ (e.target).closest('input, button, select, label, .options')) return;
    e.preventDefault();
    if (this.isPalm(e)) return;
    this.cancelReticle();
    if (e.pointerType === 'pen') this.takePen(e);
    this.stage.view.focus({ preventScroll: true });
    this.stage.view.setPointerCapture(e.pointerId);
    this.down.set(e.pointerId, { x: e.clientX, y: e.clientY });
    if (this.down.size === 1) this.touches = { max: 1, moved: 0 };
    if (this.down.size > 1) {
      this.touches.max = Math.max(this.touches.max, this.down.size);
      if (this.doing === 'tool') this.used.cancel?.();
      this.doing = 'pinch';
      return;
    }
    this.start = { x: e.clientX, y: e.clientY, moved: false };
    const p = this.point(e);
    this.used = this.tool(p);
    this.doing = this.choose(e, p);
    if (this.doing === 'tool') this.used.down?.(p);
  }

  /** Whether a touch is that of the hand that holds the pen. @param {PointerEvent} e */
  isPalm(e) { return e.pointerType === 'touch' && (this.pen !== null || e.timeStamp - this.penLifted < kPalm); }

  /** The pen goes down. Cancels what other pointers do, because they are the hand that holds the pen. @param {PointerEvent} e */
  takePen(e) {
    if (this.doing === 'tool') this.used.cancel?.();
    this.doing = null;
    this.down.clear();
    this.pen = e.pointerId;
  }

  /** What a drag does that begins with this press. @param {PointerEvent} e @param {Point} p */
  choose(e, p) {
    if (e.button === 1) return e.shiftKey ? 'pan' : 'orbit';
    if (e.button === 2) return e.shiftKey ? 'light' : e.ctrlKey ? 'size' : 'pan';
    if (e.altKey || this.space) return 'orbit';
    return this.used.down && (p.onObject || this.used.takes?.(p)) ? 'tool' : 'orbit';
  }

  /** @param {PointerEvent} e */
  move(e) {
    const last = this.down.get(e.pointerId);
    if (!last) {
      if (e.pointerType !== 'touch') this.tool().hover?.(this.point(e));
      return;
    }
    const dx = e.clientX - last.x, dy = e.clientY - last.y;
    if (this.doing === 'pinch') return this.pinch(e);
    this.down.set(e.pointerId, { x: e.clientX, y: e.clientY });
    if (this.start && Math.hypot(e.clientX - this.start.x, e.clientY - this.start.y) > kTap) this.start.moved = true;
    const { scale, width, height } = this.stage.size(), camera = this.stage.camera;
    if (this.doing === 'tool') {
      const events = e.getCoalescedEvents?.() ?? [];
      for (const c of events.length ? events : [e]) this.used.move?.(this.point(c));
      return;
    }
    if (this.doing === 'orbit') camera.orbit(-dx * kTurn, -dy * kTurn);
    if (this.doing === 'pan') camera.pan(dx * scale, dy * scale, width, height);
    if (this.doing === 'light') return this.actions.turnLight(dx * 0.5, false);
    if (this.doing === 'size') return this.actions.size(Math.exp(dx * 0.01));
    this.leavePhoto();
    this.stage.moved();
  }

  /** @param {PointerEvent} e */
  pinch(e) {
    const [a, b] = [...this.down.values()];
    this.down.set(e.pointerId, { x: e.clientX, y: e.clientY });
    const [c, d] = [...this.down.values()];
    if (!b || !d) return;
    const { scale, width, height } = this.stage.size(), r = this.stage.view.getBoundingClientRect();
    const before = Math.hypot(a.x - b.x, a.y - b.y), after = Math.hypot(c.x - d.x, c.y - d.y);
    const mx = (c.x + d.x) / 2, my = (c.y + d.y) / 2;
    this.touches.moved += Math.abs(after - before) + Math.hypot(mx - (a.x + b.x) / 2, my - (a.y + b.y) / 2);
    this.stage.camera.pan((mx - (a.x + b.x) / 2) * scale, (my - (a.y + b.y) / 2) * scale, width, height);
    this.stage.camera.zoom(before / Math.max(after, 1), (mx - r.left) * scale, (my - r.top) * scale, width, height);
    this.leavePhoto();
    this.stage.moved();
  }

  /** @param {PointerEvent} e */
  release(e) {
    if (!this.down.delete(e.pointerId)) return;
    if (e.pointerId === this.pen) {
      this.pen = null;
      this.penLifted = e.timeStamp;
    }
    const doing = this.doing, p = this.point(e);
    if (this.down.size > 0) return;
    this.doing = null;
    if (doing === 'pinch') {
      if (this.touches.moved < 2 * kTap) this.touches.max > 2 ? this.actions.redo() : this.actions.undo();
      return;
    }
    if (doing === 'tool') return this.used.up?.(p);
    if (doing === 'light') return this.actions.turnLight(0, true);
    if (this.start && !this.start.moved && e.type === 'pointerup') this.tool().click?.({ ...p, alt: p.alt || e.button === 2 });
  }

  /** @param {WheelEvent} e */
  wheel(e) {
    e.preventDefault();
    const p = this.point(/** @type {any} */ (e)), { width, height } = this.stage.size();
    const step = e.deltaMode === 1 ? 30 * e.deltaY : e.deltaY;
    this.stage.camera.zoom(Math.exp(Math.max(-200, Math.min(200, step)) * (e.ctrlKey ? 0.008 : 0.0015)), p.x, p.y, width, height);
    this.leavePhoto();
    this.stage.moved();
  }

  /** The camera is no longer that of a photograph. */
  leavePhoto() {
    if (this.stage.photo === null) return;
    this.stage.photo = null;
    this.stage.emit('photo');
  }

  /** Moves the pointer by an arrow key, if it is moved by keys; otherwise the camera. @param {KeyboardEvent} e */
  arrows(e) {
    const dx = { ArrowLeft: -1, ArrowRight: 1 }[e.key] ?? 0, dy = { ArrowUp: -1, ArrowDown: 1 }[e.key] ?? 0;
    const { width, height } = this.stage.size();
    if (this.reticle) {
      const step = e.shiftKey ? 2 : 12;
      this.reticle = { x: Math.max(0, Math.min(width - 1, this.reticle.x + step * dx)), y: Math.max(0, Math.min(height - 1, this.reticle.y + step * dy)) };
      const p = this.keyPoint();
      if (this.held) this.held.move?.(p);
      else this.tool().hover?.(p);
      this.stage.redraw();
      return;
    }
    if (e.shiftKey) this.stage.camera.pan(-30 * dx, -30 * dy, width, height);
    else this.stage.camera.orbit(dx * Math.PI / 36, dy * Math.PI / 36);
    this.leavePhoto();
    this.stage.moved();
  }

  /** The pointer that is moved by keys. @param {{alt?: boolean, shift?: boolean}} [keys] that are held @returns {Point} */
  keyPoint({ alt = false, shift = false } = {}) {
    const { x, y } = this.reticle ?? { x: 0, y: 0 };
    return { x, y, pressure: 1, shift, alt, ctrl: false, onObject: this.stage.onObject(x, y), erase: false };
  }

  toggleReticle() {
    this.cancelReticle();
    const { width, height } = this.stage.size();
    this.reticle = this.reticle ? null : { x: width / 2, y: height / 2 };
    this.stage.redraw();
  }

  /** Clicks at the pointer that is moved by keys, or ends its drag. @param {{alt: boolean, shift: boolean}} keys */
  clickReticle(keys) {
    if (!this.reticle) return false;
    if (this.releaseReticle()) return true;
    const p = this.keyPoint(keys), tool = this.tool();
    if (tool.down && p.onObject) {
      tool.down(p);
      tool.up?.(p);
    } else tool.click?.(p);
    return true;
  }

  /** Begins a drag by keys, or ends it. Shows the pointer that is moved by keys, if it is not shown. */
  holdReticle() {
    if (!this.reticle) this.toggleReticle();
    if (this.releaseReticle()) return;
    const p = this.keyPoint(), tool = this.tool();
    if (!tool.down) return toast('This tool drags nothing. Choose another one.');
    if (!p.onObject && !tool.takes?.(p)) return toast('Move the pointer onto the object first, with the arrow keys.');
    this.held = tool;
    tool.down(p);
    toast('The arrow keys drag now. Enter ends the drag, Esc cancels it.');
    this.stage.redraw();
  }

  /** Ends the drag by keys. @returns {boolean} whether there was one */
  releaseReticle() {
    const tool = this.held;
    this.held = null;
    tool?.up?.(this.keyPoint());
    this.stage.redraw();
    return tool !== null;
  }

  /** Cancels the drag by keys. @returns {boolean} whether there was one */
  cancelReticle() {
    const tool = this.held;
    if (!tool) return false;
    this.held = null;
    tool.cancel?.();
    this.stage.redraw();
    return true;
  }

  /** @param {CanvasRenderingContext2D} c */
  drawReticle(c) {
    if (!this.reticle) return;
    const { x, y } = this.reticle;
    for (const [color, width] of /** @type {[string, number][]} */ ([['#000c', 4], ['#fff', 1.5]])) {
      c.strokeStyle = color;
      c.lineWidth = width;
      c.beginPath();
      for (const [a, b] of [[-14, -4], [4, 14]]) {
        c.moveTo(x + a, y); c.lineTo(x + b, y);
        c.moveTo(x, y + a); c.lineTo(x, y + b);
      }
      if (this.held) {
        c.moveTo(x + 9, y);
        c.arc(x, y, 9, 0, 2 * Math.PI);
      }
      c.stroke();
    }
  }
}

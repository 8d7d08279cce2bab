// SPDX-License-Identifier: Apache-2.0
// @ts-check
/**
 * All keys and gestures. The editor's keys, its help and docs/editor.md are made from these tables.
 * "Mod" is Ctrl, or Cmd on a Mac.
 */

/** @typedef {{keys: string[], action: string, text: string}} Key */

/** @type {{title: string, keys: Key[]}[]} */
export const keyTable = [
  { title: 'Tools', keys: [
    { keys: ['V'], action: 'tool:look', text: 'Look' },
    { keys: ['B'], action: 'tool:paint', text: 'Paint' },
    { keys: ['E'], action: 'tool:erase', text: 'Erase paint' },
    { keys: ['D'], action: 'tool:decal', text: 'Lay a picture onto the object' },
    { keys: ['P'], action: 'tool:part', text: 'Select a part' },
    { keys: ['S'], action: 'lasso', text: 'Select a part with a lasso' },
    { keys: ['G'], action: 'tool:grab', text: 'Grab and bend' },
    { keys: ['J'], action: 'tool:bend', text: 'Bend with handles and pins' },
    { keys: ['M'], action: 'tool:material', text: 'Material' },
    { keys: ['L'], action: 'tool:light', text: 'Light' },
    { keys: ['I'], action: 'pick-color', text: 'Take the color under the pointer' },
    { keys: ['X'], action: 'swap-colors', text: 'Swap the two colors' },
    { keys: ['['], action: 'smaller', text: 'Smaller brush, decal or reach' },
    { keys: [']'], action: 'larger', text: 'Larger brush, decal or reach' },
    { keys: ['Shift+['], action: 'softer', text: 'Softer brush' },
    { keys: ['Shift+]'], action: 'harder', text: 'Harder brush' },
    { keys: ['1', '2', '3', '4', '5', '6', '7', '8', '9', '0'], action: 'opacity', text: 'Opacity of the brush: 10 % to 90 %, 100 %' },
    { keys: ['Enter'], action: 'keep', text: 'Keep what is previewed' },
    { keys: ['Escape'], action: 'drop', text: 'Discard what is previewed' },
  ] },
  { title: 'History', keys: [
    { keys: ['Mod+Z'], action: 'undo', text: 'Undo' },
    { keys: ['Shift+Mod+Z', 'Mod+Y'], action: 'redo', text: 'Redo' },
    { keys: ['Delete'], action: 'remove', text: 'Remove the selected part, or the selected handle or pin' },
  ] },
  { title: 'View', keys: [
    { keys: ['H'], action: 'hide', text: 'Hide or show the selected part' },
    { keys: ['Shift+H'], action: 'show-all', text: 'Show all parts' },
    { keys: ['F'], action: 'frame', text: 'Show the selected part, or the whole object' },
    { keys: ['Home'], action: 'home', text: 'Start view' },
    { keys: ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'], action: 'arrows', text: 'Turn by 5°; with Shift, move' },
    { keys: ['+', '-'], action: 'zoom', text: 'Nearer, farther' },
    { keys: ['N'], action: 'next-photo', text: 'Next photograph' },
    { keys: ['Shift+N'], action: 'previous-photo', text: 'Previous photograph' },
    { keys: ['\\'], action: 'hold-photo', text: 'Show the photograph while held' },
    { keys: ['C'], action: 'compare', text: 'Compare with the photograph' },
    { keys: ['T'], action: 'channel', text: 'Next channel: lit, albedo, diffuse, shine, normals, roughness' },
    { keys: ['.'], action: 'reticle', text: 'Pointer by keys: arrows move it, Space clicks, with Alt or Shift as by mouse' },
    { keys: [','], action: 'hold', text: 'Hold its button: arrows drag, Enter lets go, Esc cancels' },
    { keys: ['U'], action: 'bare', text: 'Hide or show the panels' },
    { keys: ['Mod+S'], action: 'export', text: 'Export' },
    { keys: ['?'], action: 'help', text: 'This help; keys without Ctrl can be switched off here' },
  ] },
];

/** Gestures, for the help. @type {[string, string][]} */
export const gestures = [
  ['Left button on the object', 'the tool'],
  ['Left button beside it, Alt and left, or the middle button', 'turn'],
  ['Right button, or Shift and the middle button', 'move'],
  ['Wheel, or pinch', 'zoom at the pointer'],
  ['Shift and the right button', 'turn the light'],
  ['Ctrl and the right button', 'size of the brush'],
  ['Shift and a click, painting', 'a straight line'],
  ['Alt or the right button, selecting a part', 'a click that is not on the part'],
  ['Shift, selecting a part', 'adds to the selected part; Ctrl takes from it, both cut it'],
  ['A picture dropped on the object', 'a decal'],
  ['A picture dropped beside it, or an .hdr or .exr', 'the light'],
  ['The eraser of a pen, painting', 'erases'],
  ['Two fingers', 'move and zoom; a tap of two undoes, of three redoes'],
];

/** @param {KeyboardEvent} e @returns {string} "Shift+Mod+Z" */
function nameOf(e) {
  const name = e.key.length === 1 ? e.key.toUpperCase() : e.key;
  const bracket = { '{': '[', '}': ']' }[name];
  if (bracket) return `Shift+${bracket}`;
  const letter = /^[A-Z]$/.test(name) || e.key.length > 1;
  return (e.shiftKey && letter ? 'Shift+' : '') + (e.ctrlKey || e.metaKey ? 'Mod+' : '') + (name === '=' ? '+' : name);
}

/** @param {KeyboardEvent} e @returns {string | undefined} the action of a key */
export function actionOf(e) {
  if (e.altKey) return undefined;
  const name = nameOf(e), plain = name.replace(/^Shift\+(Arrow)/, '$1');
  for (const group of keyTable)
    for (const k of group.keys) if (k.keys.includes(name) || (k.action === 'arrows' && k.keys.includes(plain))) return k.action;
  return undefined;
}

/** Whether a key types a character. Such keys are also pressed by dictation and by accident. @param {KeyboardEvent} e */
export const isSingle = (e) => e.key.length === 1 && !e.ctrlKey && !e.metaKey;

/** @param {string} action @returns {string} its first key, as written */
export function keyOf(action) {
  for (const group of keyTable) for (const k of group.keys) if (k.action === action) return written(k.keys[0]);
  return '';
}

/** @param {string} key */
export function written(key) {
  const mac = typeof navigator !== 'undefined' && /Mac|iP(hone|ad)/.test(navigator.platform ?? '');
  return key.replace('Mod', mac ? 'Cmd' : 'Ctrl').replace('ArrowLeft', '←').replace('ArrowRight', '→').replace('ArrowUp', '↑').replace('ArrowDown', '↓').replace('Escape', 'Esc');
}

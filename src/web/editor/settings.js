// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Settings of the user for all objects, which the browser stores. */

const kSingleKeys = 'cei3d-single-keys';
let single = readSetting();

function readSetting() {
  try {
    return localStorage.getItem(kSingleKeys) !== 'off';
  } catch { return true; }  // the browser refuses to store settings
}

/** Whether keys without a modifier act wherever the focus is; if not, they act only while the view has it. */
export const singleKeys = () => single;

/** @param {boolean} on */
export function setSingleKeys(on) {
  single = on;
  try {
    localStorage.setItem(kSingleKeys, on ? 'on' : 'off');
  } catch { /* the setting lasts until the page is closed */ }
}

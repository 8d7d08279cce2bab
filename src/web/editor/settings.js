// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** What the user has set for all objects; the browser keeps it. */

const kSingleKeys = 'cei3d-single-keys';
let single = readSetting();

function readSetting() {
  try {
    return localStorage.getItem(kSingleKeys) !== 'off';
  } catch { return true; }  // the browser keeps nothing
}

/** Whether keys without a modifier act wherever the focus is; otherwise only while the view has it. */
export const singleKeys = () => single;

/** @param {boolean} on */
export function setSingleKeys(on) {
  single = on;
  try {
    localStorage.setItem(kSingleKeys, on ? 'on' : 'off');
  } catch { /* until the page is closed */ }
}

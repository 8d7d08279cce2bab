// SPDX-License-Identifier: Apache-2.0
// @ts-check
// Reads packs of arrays, the form in which a page gets an object from the program (src/engine/view/pack.h).

/**
 * @typedef {Uint8Array | Int8Array | Uint16Array | Int16Array | Uint32Array | Float32Array} Numbers
 * @typedef {{head: any, arrays: Object<string, Numbers>}} Pack
 */

const kArrayTypes = {u8: Uint8Array, i8: Int8Array, u16: Uint16Array, i16: Int16Array, u32: Uint32Array, f32: Float32Array};

/**
 * @param {ArrayBuffer} buffer
 * @param {string} kind that the pack must have, "shape" for example
 * @returns {Pack} arrays are views of the buffer
 */
export function readPack(buffer, kind) {
  const size = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
  if (head.kind !== kind) throw new Error(`The page has a "${head.kind}" where it needs a "${kind}".`);
  /** @type {Object<string, Numbers>} */
  const arrays = {};
  for (const [name, a] of Object.entries(head.arrays)) {
    const type = kArrayTypes[/** @type {keyof kArrayTypes} */ (a.type)];
    arrays[name] = new type(buffer, 4 + size + a.at, a.shape[0] * a.shape[1]);
  }
  return {head, arrays};
}

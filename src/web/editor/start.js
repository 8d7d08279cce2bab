// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** What the page needs first is asked for while the rest of it is still loading. */
import { getBytes, getJson, hasKey, kFar } from './api.js';

const kUnused = 20000;  // milliseconds after which nobody takes them any more

/** @type {Map<string, Promise<ArrayBuffer>>} packs that are on their way, by kind and key */
const packs = new Map();

/** Milliseconds that the answer took there and back, where the browser says so without what the page did meanwhile. @param {string} path @param {number} begin when it was asked for */
function waited(path, begin) {
  const t = /** @type {PerformanceResourceTiming | undefined} */ (performance.getEntriesByType('resource').find((e) => e.name.endsWith(path)));
  return t && t.responseStart > 0 ? t.responseStart - t.requestStart : performance.now() - begin;
}

async function start() {
  const begin = performance.now(), got = { ...await getJson('/api/start'), far: false };
  got.far = waited('/api/start', begin) > kFar;
  if (got.far || new URLSearchParams(location.search).has('frames')) return got;  // it is asked for otherwise, or not at all
  for (const [kind, key] of Object.entries(got.state.packs ?? {})) {
    if (kind === 'coarse') continue;  // comes last
    const bytes = getBytes(`/api/pack/${kind}?key=${key}`);
    bytes.catch(() => {});  // who takes it sees that
    packs.set(`${kind} ${key}`, bytes);
  }
  setTimeout(() => packs.clear(), kUnused);
  return got;
}

/** The state, the object, and whether the line is long; null: they could not be had. @type {Promise<{state: any, object: any, far: boolean} | null>} */
export const started = hasKey() ? start().catch(() => null) : Promise.resolve(null);

/** A pack that is already on its way. @param {string} kind @param {string} key */
export function onItsWay(kind, key) {
  const name = `${kind} ${key}`, bytes = packs.get(name);
  packs.delete(name);
  return bytes;
}

// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** Asks for what the page needs first while its other modules are still loading. */
import { getBytes, getJson, hasKey, kSlowRoundTrip } from './api.js';

const kUnused = 20000;  // milliseconds after which packs that were not used are dropped

/** @type {Map<string, Promise<ArrayBuffer>>} packs that were asked for, by kind and key */
const packs = new Map();

/**
 * Milliseconds of the round trip of a request, without the time that the page was busy, if the browser tells it.
 * @param {string} path @param {number} begin time of the request
 */
function waited(path, begin) {
  const t = /** @type {PerformanceResourceTiming | undefined} */ (performance.getEntriesByType('resource').find((e) => e.name.endsWith(path)));
  return t && t.responseStart > 0 ? t.responseStart - t.requestStart : performance.now() - begin;
}

async function start() {
  const begin = performance.now(), got = { ...await getJson('/api/start'), slow: false };
  got.slow = waited('/api/start', begin) > kSlowRoundTrip;
  // Over a slow connection packs are asked for later, compressed; a page that shows the program's frames needs none.
  if (got.slow || new URLSearchParams(location.search).has('frames')) return got;
  for (const [kind, key] of Object.entries(got.state.packs ?? {})) {
    if (kind === 'coarse') continue;  // fetched last, by Live
    const bytes = getBytes(`/api/pack/${kind}?key=${key}`);
    bytes.catch(() => {});  // the error is handled by the one that takes the pack
    packs.set(`${kind} ${key}`, bytes);
  }
  setTimeout(() => packs.clear(), kUnused);
  return got;
}

/** The state, the object, and whether the connection is slow; null: they could not be fetched. @type {Promise<{state: any, object: any, slow: boolean} | null>} */
export const started = hasKey() ? start().catch(() => null) : Promise.resolve(null);

/** A pack that was asked for here; undefined: it was not. @param {string} kind @param {string} key */
export function takePack(kind, key) {
  const name = `${kind} ${key}`, bytes = packs.get(name);
  packs.delete(name);
  return bytes;
}

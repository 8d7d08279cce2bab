// SPDX-License-Identifier: Apache-2.0
// What the editor's modules do, with stand-ins for the browser and the program: node --test tests/web
import assert from 'node:assert/strict';
import test from 'node:test';

const standIns = {
  location: { hash: '', host: '', protocol: 'http:', search: '' }, sessionStorage: { getItem: () => null }, WebSocket: class {},
  window: { addEventListener() {} }, document: { getElementById: () => ({ append() {}, children: [] }), createElement: () => ({ append() {}, remove() {} }) },
};
for (const [name, value] of Object.entries(standIns)) Object.defineProperty(globalThis, name, { value, configurable: true, writable: true });
const { Store } = await import('../../src/web/editor/store.js');

const soon = () => new Promise((resolve) => { setTimeout(resolve, 0); });

// A program, and what befalls the edits that it is sent: 'lost': the answer, 'unheard': the edit, 'late': another window was quicker.
function programWith(fates) {
  const history = [], state = () => ({ mode: 'project', folder: 'f', history: [...history], done: history.length, parts: [], revision: `r${history.length}` });
  globalThis.fetch = async (path, { method, body, headers }) => {
    if (method !== 'POST') return Response.json(path === '/api/state' ? state() : {});
    const fate = fates.shift();
    if (fate === 'late') history.push({ op: 'paint', of: 'another window' });
    if (fate === 'unheard') throw new Error('no connection');
    if (headers['If-Match'] !== state().revision) return Response.json({ error: 'changed in another window' }, { status: 409 });
    history.push(JSON.parse(body));
    if (fate === 'lost') throw new Error('no connection');
    return Response.json({ result: history.at(-1), state: state() });
  };
  return history;
}

test('an edit of another window never counts as the one that was refused', async () => {
  const history = programWith(['lost', 'repeated', 'unheard', 'repeated', 'late']), store = new Store();
  await store.refresh();
  const paint = async (of) => {
    let over = false;
    const done = store.send('edit', { op: 'paint', of }).finally(() => { over = true; });
    done.catch(() => {});
    for (; !over; await soon()) store.line.emit('welcome', { complete: true });  // the connection is back
    return done;
  };
  assert.equal((await paint('first')).of, 'first');  // it arrived, only its answer did not
  assert.equal((await paint('second')).of, 'second');
  await assert.rejects(paint('third'), { status: 409 });
  assert.deepEqual(history.map((e) => e.of), ['first', 'second', 'another window']);
});

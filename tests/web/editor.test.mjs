// SPDX-License-Identifier: Apache-2.0
// What the editor's modules do, with stand-ins for the browser and the program: node --test tests/web
import assert from 'node:assert/strict';
import fs from 'node:fs';
import test from 'node:test';

const drawn = [];  // pictures on canvases, and how opaque
const filled = [];  // colors of rectangles, and how they are combined with what is there
const context = {
  globalAlpha: 1, globalCompositeOperation: 'source-over', drawImage(picture) { drawn.push([picture, this.globalAlpha]); }, transform(...map) { this.map = map; },
  fillRect() { filled.push([this.fillStyle, this.globalCompositeOperation, this.globalAlpha]); },
};
for (const name of ['arc', 'beginPath', 'clearRect', 'fill', 'restore', 'save', 'stroke']) context[name] = () => {};
const standIns = {
  location: { hash: '', host: '', protocol: 'http:', search: '' }, sessionStorage: { getItem: () => null }, WebSocket: class {},
  window: { addEventListener() {}, setTimeout: () => 0 }, document: { getElementById: (id) => (id === 'toasts' ? { append() {}, children: [] } : null), createElement: () => ({ append() {}, getContext: () => context, toBlob: (take) => take('png') }) },
};
const timer = globalThis.setTimeout;
standIns.setTimeout = (work, wait) => (wait > 100 ? 0 : timer(work, wait));  // messages do not go away
for (const [name, value] of Object.entries(standIns)) Object.defineProperty(globalThis, name, { value, configurable: true, writable: true });
const { chosen, formats } = await import('../../src/web/editor/dialogs.js');
const { Input } = await import('../../src/web/editor/input.js');
const { Newest } = await import('../../src/web/editor/newest.js');
const { brush, PaintTool } = await import('../../src/web/editor/paint.js');
const { PartTool } = await import('../../src/web/editor/select.js');
const { Store } = await import('../../src/web/editor/store.js');

const soon = () => new Promise((resolve) => { timer(resolve, 0); });
async function until(is) {
  for (let i = 0; i < 10000 && !is(); ++i) await soon();
  assert.ok(is());
}

// A program, and what befalls the edits that it is sent: 'lost': the answer, 'unheard': the edit, 'late': another window was quicker,
// 'stranger': the program was restarted, and has another key, 'empty': it was restarted, and does not have the uploads.
function programWith(fates) {
  const history = [], state = () => ({ mode: 'project', folder: 'f', history: [...history], done: history.length, parts: [], revision: `r${history.length}` });
  globalThis.fetch = async (path, { method, body, headers }) => {
    if (method !== 'POST') return Response.json(path === '/api/state' ? state() : {});
    const fate = fates.shift();
    if (fate === 'late') history.push({ op: 'paint', of: 'another window' });
    if (fate === 'unheard') throw new Error('no connection');
    if (fate === 'stranger') return Response.json({ error: 'another key' }, { status: 401 });
    if (fate === 'empty') return Response.json({ error: 'sent files are gone' }, { status: 410 });
    if (headers['If-Match'] !== state().revision) return Response.json({ error: 'changed in another window' }, { status: 409 });
    history.push(JSON.parse(body));
    if (fate === 'lost') throw new Error('no connection');
    return Response.json({ result: history.at(-1), state: state() });
  };
  return history;
}

test('an edit is sent until it arrives, and one of another window never counts as the one that was refused', async () => {
  const history = programWith(['lost', 'repeated', 'unheard', 'repeated', 'stranger', 'stranger', 'empty', 'arrives', 'late']), store = new Store();
  await store.refresh();
  const paint = async (of) => {
    let over = false;
    const done = store.send('edit', async () => ({ op: 'paint', of })).finally(() => { over = true; });
    done.catch(() => {});
    for (; !over; await soon()) store.line.emit('welcome', { complete: true });  // the connection is back
    return done;
  };
  assert.equal((await paint('first')).of, 'first');  // it arrived, only its answer did not
  assert.equal((await paint('second')).of, 'second');
  assert.equal((await paint('third')).of, 'third');
  await assert.rejects(paint('fourth'), { status: 409 });
  assert.deepEqual(history.map((e) => e.of), ['first', 'second', 'third', 'another window']);
});

test('an edit is sent again although the socket never noticed that the program was away', async () => {
  const history = programWith(['unheard', 'arrives']), store = new Store();
  await store.refresh();
  store.line.ready = true;
  window.setTimeout = (work) => timer(work, 0);
  try {
    await store.send('edit', { op: 'paint', of: 'first' });
  } finally {
    window.setTimeout = () => 0;
  }
  assert.deepEqual(history.map((e) => e.of), ['first']);
});

test('an object counts as made once, in the page that saw it being made', async () => {
  programWith([]);
  const store = new Store(), seen = [];
  store.on('mode', () => seen.push(store.made));
  await store.refresh();
  for (const mode of ['reconstructing', 'library', 'capture']) {
    store.state = { ...store.state, mode };
    await store.refresh();
  }
  assert.deepEqual(seen, [false, true, false, false]);
});

test('of what is asked for while something runs only the last is done', async () => {
  const done = [];
  let wanted = 0, finish = () => {};
  const newest = new Newest(() => { done.push(wanted); return new Promise((resolve) => { finish = resolve; }); });
  const ask = (value) => { wanted = value; return newest.run(); };
  const all = [1, 2, 3, 4].map(ask);
  assert.deepEqual(done, [1]);
  finish();
  await until(() => done.length > 1);
  finish();
  await Promise.all(all);
  assert.deepEqual(done, [1, 4]);
  ask(5);
  assert.deepEqual(done, [1, 4, 5]);
});

test('work that failed does not keep later work from being done', async () => {
  let times = 0;
  const newest = new Newest(async () => { if (++times === 1) throw new Error('first'); });
  await assert.rejects(newest.run());
  await newest.run();
  assert.equal(times, 2);
});

// A tool for parts, previews that wait for their answers, and the tokens that were kept.
function partTool() {
  const asked = [], kept = [];
  globalThis.fetch = (path, { body }) => new Promise((resolve) => {
    const answer = (token) => resolve(token ? Response.json({ token, part: 'part', report: { share: 0.1 } }) : Response.json({ error: 'nothing is there' }, { status: 400 }));
    asked.push({ path, answer, clicks: JSON.parse(body).params.positive?.length });
  });
  const stage = { json: () => ({}), redraw() {}, addEventListener() {} };
  const store = { part: null, state: { revision: 'r0' }, select() {}, change: async (route, { token }) => { kept.push(token); return { part: 'part' }; } };
  const tool = new PartTool(stage, store, { show: async () => {} });
  const click = (x) => tool.click({ x, y: 0, onObject: true, alt: false });
  return { tool, store, asked, kept, click };
}

test('quick clicks are previewed one at a time, the newest ones', async () => {
  const { asked, click, tool } = partTool();
  for (const x of [1, 2, 3]) click(x);
  await until(() => asked.length > 0);
  await soon();
  assert.equal(asked.length, 1);
  asked[0].answer('first');
  await until(() => asked.length > 1);
  assert.equal(tool.token, null);
  asked[1].answer('all');
  await tool.previews.running;
  assert.deepEqual(asked.map((a) => a.clicks), [1, 3]);
  assert.equal(tool.token, 'all');
});

test('a part is kept as it was clicked last, or not at all', async () => {
  const { asked, kept, click, tool } = partTool();
  const answer = async (count, token) => { await until(() => asked.length === count); asked[count - 1].answer(token); };
  click(1);
  await answer(1, 'first');
  await tool.previews.running;
  click(2);
  const keeping = tool.keep();
  await answer(2, 'second');
  await answer(3, null);
  await keeping;
  assert.deepEqual(kept, []);
  const twice = [tool.keep(), tool.keep()];
  await answer(4, 'both');
  await answer(5, 'again');
  await Promise.all(twice);
  assert.deepEqual(kept, ['again']);
});

test('a part is kept as it is shown, unless the object has changed since', async () => {
  const { asked, kept, click, tool, store } = partTool();
  click(1);
  await until(() => asked.length === 1);
  asked[0].answer('shown');
  await tool.previews.running;
  await Promise.all([tool.keep(), tool.keep()]);  // as by a double click
  assert.deepEqual(kept, ['shown']);
  assert.equal(asked.length, 1);
  click(2);
  await until(() => asked.length === 2);
  asked[1].answer('old');
  await tool.previews.running;
  store.state.revision = 'r1';
  const keeping = tool.keep();
  await until(() => asked.length === 3);
  asked[2].answer('new');
  await keeping;
  assert.deepEqual(kept, ['shown', 'new']);
});

test('what is discarded while it is being kept is not kept, nor what is clicked then', async () => {
  const { asked, kept, click, tool } = partTool();
  click(1);
  const keeping = tool.keep();
  await until(() => asked.length === 1);
  tool.drop();
  click(2);
  asked[0].answer('first');
  await until(() => asked.length === 2);
  asked[1].answer('other');
  await keeping;
  assert.deepEqual(kept, []);
});

// The view's pointers, and what the tool and the camera are told.
function pointers() {
  const heard = [], listeners = {}, say = (word) => () => { heard.push(word); };
  const view = { addEventListener: (type, listener) => { listeners[type] = listener; }, focus() {}, setPointerCapture() {}, getBoundingClientRect: () => ({ left: 0, top: 0 }) };
  const camera = { orbit: say('orbit'), pan: say('pan'), zoom: say('zoom') };
  const stage = { view, camera, photo: null, size: () => ({ scale: 1, width: 100, height: 100 }), onObject: () => true, moved() {}, redraw() {} };
  const tool = { down: say('down'), move: say('move'), up: say('up'), cancel: say('cancel'), hover: say('hover') };
  const input = new Input(stage, () => tool, { undo: say('undo'), redo: say('redo') });
  const send = (type, pointerType, timeStamp, pointerId = pointerType === 'pen' ? 1 : 2) => listeners[`pointer${type}`](
    { type: `pointer${type}`, pointerType, pointerId, timeStamp, clientX: timeStamp / 10, clientY: 0, buttons: 1, button: 0, target: { closest: () => null }, preventDefault() {} });
  const words = () => heard.splice(0).join(' ');
  return { heard, input, send, stage, tool, words };
}

test('the hand that holds a pen does not disturb its stroke', () => {
  const { send, words } = pointers();
  send('down', 'pen', 0);
  send('down', 'touch', 10);
  send('move', 'touch', 20);
  send('move', 'pen', 30);
  send('up', 'pen', 1000);
  send('move', 'touch', 1010);
  send('up', 'touch', 1020);
  send('down', 'touch', 1300);
  send('up', 'touch', 1310);
  assert.equal(words(), 'down move up');
  send('down', 'touch', 1600);  // a finger
  send('up', 'touch', 1610);
  assert.equal(words(), 'down up');
});

test('a hand that comes before its pen gives way', () => {
  const { send, words } = pointers();
  send('down', 'touch', 0);
  send('down', 'pen', 50);
  send('move', 'touch', 60);
  send('move', 'pen', 70);
  send('up', 'touch', 80);
  send('up', 'pen', 90);
  assert.equal(words(), 'down cancel down move up');
});

test('two fingers still move and zoom', () => {
  const { send, words } = pointers();
  send('down', 'touch', 0, 3);
  send('down', 'touch', 0, 4);
  send('move', 'touch', 90, 4);
  assert.equal(words(), 'down cancel pan zoom');
});

// The pointer by keys, in the middle of the view, and what the tool is told, with places.
function keyPointer() {
  const { heard, input, send, stage, tool, words } = pointers();
  stage.onObject = (x) => x < 90;
  for (const word of ['down', 'move', 'up']) tool[word] = (p) => { heard.push(`${word} ${p.x},${p.y}${p.shift ? ' shift' : ''}`); };
  input.toggleReticle();
  return { arrow: (key) => input.arrows({ key, shiftKey: false }), input, send, words };
}

test('keys alone press, drag and let go', () => {
  const { arrow, input, words } = keyPointer();
  arrow('ArrowLeft');
  assert.equal(words(), 'hover');
  input.holdReticle();
  arrow('ArrowRight');
  arrow('ArrowDown');
  assert.ok(input.releaseReticle());
  assert.equal(words(), 'down 38,50 move 50,50 move 50,62 up 50,62');
  assert.ok(!input.releaseReticle());
  assert.equal(words(), '');
});

test('a click by keys is one place, with the keys that are held', () => {
  const { arrow, input, words } = keyPointer();
  input.clickReticle({ alt: false, shift: true });
  assert.equal(words(), 'down 50,50 shift up 50,50 shift');
  input.holdReticle();
  arrow('ArrowUp');
  input.clickReticle({ alt: false, shift: false });  // lets go
  assert.equal(words(), 'down 50,50 move 50,38 up 50,38');
});

test('what is dragged by keys is canceled by itself or by a mouse, and begins on the object', () => {
  const { arrow, input, send, words } = keyPointer();
  input.holdReticle();
  assert.ok(input.cancelReticle() && !input.cancelReticle());
  assert.equal(words(), 'down 50,50 cancel');
  input.holdReticle();
  send('down', 'mouse', 0);
  assert.equal(words(), 'down 50,50 cancel down 0,0');
  for (let i = 0; i < 4; ++i) arrow('ArrowRight');
  words();
  input.holdReticle();  // beside it
  assert.ok(!input.held);
  assert.equal(words(), '');
});

function paintTool() {
  const camera = { width: 40, height: 30, fx: 40, fy: 40, cx: 20, cy: 15, skew: 0, world_from_cam: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], center: [0, 0, -4] };
  const stage = Object.assign(new EventTarget(), { picture: { width: 40, height: 30, style: { opacity: '0' } }, size: () => ({ scale: 1 }), json: () => camera, redraw() {} });
  const store = { emit() {}, object: { center: [0, 0, 0], radius: 1 } }, tool = new PaintTool(stage, store, false);
  const stroke = (opacity) => {
    Object.assign(brush, { opacity, hardness: 1 });
    tool.down({ x: 1, y: 1, pressure: 1 });
    tool.up();
  };
  return { stage, store, tool, stroke };
}

test('a stroke keeps the opacity that it was drawn with', () => {
  const { tool, stroke } = paintTool();
  stroke(0.3);
  stroke(0.8);
  brush.opacity = 1;
  drawn.length = 0;
  tool.flatten();
  assert.deepEqual(drawn.map(([, opacity]) => opacity), [0.3, 0.8]);
  tool.undo();
  assert.equal(drawn.at(-1)[1], 0.3);
});

test('strokes that are kept have one color, exactly', () => {
  const { tool, stroke } = paintTool();
  tool.setColor('#123456');
  filled.length = 0;
  stroke(0.3);
  assert.deepEqual(filled, [['#123456', 'source-in', 1]]);
  assert.equal(context.globalCompositeOperation, 'source-over');
});

test('a stroke that is being kept is seen until a picture has it, wherever the camera goes', async () => {
  const { stage, store, tool, stroke } = paintTool(), answers = [];
  store.change = () => new Promise((resolve) => { answers.push(resolve); });
  const shown = () => { drawn.length = 0; tool.draw(context); return drawn.length; };
  const tell = (...types) => types.forEach((type) => stage.dispatchEvent(new Event(type)));
  stroke(1);
  tell('moved', 'drawn', 'moved');
  assert.equal(shown(), 1);
  assert.deepEqual(context.map, [1, 0, 0, 1, 0, 0]);
  stroke(1);
  tell('moved');
  await until(() => answers.length === 2);
  answers[0]('made');
  await soon();
  assert.equal(shown(), 2);  // its picture is on its way
  tell('drawn');
  assert.equal(shown(), 1);
  answers[1](undefined);
  await soon();
  assert.equal(shown(), 0);  // refused
});

test('the dialog offers all that the program exports', () => {
  const source = (file) => fs.readFileSync(new URL(`../../src/${file}`, import.meta.url), 'utf8');
  const words = (text, pattern) => new Set([...text.matchAll(pattern)].map(([, word]) => word));
  const endings = words(source('engine/session/session_export.cpp'), /"(\.\w+)"/g);
  assert.deepEqual(new Set(formats.map((f) => /\.\w+$/.exec(f.ending)[0])), endings);
  assert.equal(new Set(formats.map((f) => f.ending.replace(/\.(gltf|obj)$/, ''))).size, formats.length);  // other files are beside these
  const [reader] = /^ExportRequest export_request\(.*?^}/ms.exec(source('apps/server/edit_json.cpp'));
  const keys = words(reader.replaceAll(/"(input|base)"/g, ''), /"(\w+)"/g);
  assert.deepEqual(new Set(['file', ...formats.flatMap((f) => [...f.options, ...Object.keys(f.more ?? {})])]), keys);
});

test('what is chosen for an export is sent as the program reads it', () => {
  const fields = { 'export-faces': '400', 'export-unit_scale': '0.5', 'export-light': 'fit', 'export-texture': '0', 'export-for': '', 'export-image': 'png' };
  const { getElementById } = document;
  document.getElementById = (id) => ({ value: fields[id] });
  assert.deepEqual(chosen(['faces', 'unit_scale', 'light', 'texture', 'for', 'image']), { faces: 400, unit_scale: 0.5, light: true, texture: 0, image: 'png' });
  document.getElementById = getElementById;
});

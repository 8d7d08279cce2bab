// SPDX-License-Identifier: Apache-2.0
// The modules of src/web that need no browser: node --test tests/web
import assert from 'node:assert/strict';
import fs from 'node:fs';
import test from 'node:test';
import vm from 'node:vm';
import { clipFromRelative, cross, dot, ofPixel, plus, resized, rotation, unit } from '../../src/web/camera.js';
import { Orbit } from '../../src/web/orbit.js';
import { readPack } from '../../src/web/pack.js';
import { mirrored, placeOnBall, radianceOf } from '../../src/web/editor/ball.js';
import { cornersOf, ontoCorners, pointAt, seen } from '../../src/web/editor/camera.js';
import { actionOf, gestures, isSingle, keyTable } from '../../src/web/editor/keys.js';
import { Pace, steps } from '../../src/web/editor/pace.js';
import { lookText, partBall, partLooks, swatch } from '../../src/web/editor/looks.js';

const near = (a, b, tolerance = 1e-5) => assert.ok(Math.abs(a - b) < tolerance, `${a} is not ${b}`);

// Pixel of a world point by the pinhole equation.
function pixelOf(camera, p) {
  const local = [0, 1, 2].map((k) => dot(camera.world_from_cam.map((row) => row[k]), plus(p, camera.center, -1)));
  return [camera.fx * local[0] / local[2] + (camera.skew ?? 0) * local[1] / local[2] + camera.cx,
    camera.fy * local[1] / local[2] + camera.cy, local[2]];
}

function pixelOfClip(camera, p) {
  const m = clipFromRelative(camera, 0.5, 50), r = [...plus(p, camera.center, -1), 1];
  const clip = [0, 1, 2, 3].map((row) => [0, 1, 2, 3].reduce((sum, k) => sum + m[4 * k + row] * r[k], 0));
  return [(clip[0] / clip[3] + 1) / 2 * camera.width, (1 - clip[1] / clip[3]) / 2 * camera.height, clip[2] / clip[3]];
}

const someCamera = () => {
  const z = unit([1, 2, -0.5]), x = unit(cross(z, [0, 0, 1])), y = cross(z, x);
  return {width: 300, height: 200, fx: 280, fy: 250, cx: 140, cy: 110, skew: 3, center: [-3, -5, 2],
    world_from_cam: [0, 1, 2].map((k) => [x[k], y[k], z[k]])};
};

test('clip coordinates are those of the pinhole camera', () => {
  const camera = someCamera();
  for (const p of [[0, 0, 0], [0.5, -0.3, 0.8], [-1, 1, 0]]) {
    const want = pixelOf(camera, p), got = pixelOfClip(camera, p);
    near(got[0], want[0], 1e-3);
    near(got[1], want[1], 1e-3);
    assert.ok(got[2] > -1 && got[2] < 1);
  }
});

test('a pixel keeps its place in its own camera and in other sizes', () => {
  const camera = someCamera(), p = [0.2, 0.1, -0.4], [x, y] = pixelOf(camera, p);
  const [u, v] = pixelOf(ofPixel(camera, Math.floor(x), Math.floor(y)), p);
  assert.ok(u >= 0 && u < 1 && v >= 0 && v < 1);
  const half = pixelOf(resized(camera, 150, 100), p);
  near(half[0], x / 2);
  near(half[1], y / 2);
});

test('rotations are counter-clockwise', () => {
  const r = rotation([0, 0, 1], Math.PI / 2).map((row) => dot(row, [1, 0, 0]));
  [0, 1, 0].forEach((v, k) => near(r[k], v));
});

test('an orbit looks at its target, upright', () => {
  const orbit = new Orbit([1, 2, 3], 2, [0, 0, 1], [1, 1, 0.5]);
  orbit.turn(0.7, -0.2);
  orbit.pan(0.1, 0.05);
  const camera = orbit.camera(400, 300);
  const [x, y] = pixelOf(camera, orbit.target);
  near(x, 200);
  near(y, 150);
  assert.ok(pixelOf(camera, plus(orbit.target, [0, 0, 1], 0.1))[1] < 150);  // up is up
  near(Math.hypot(...plus(camera.center, orbit.target, -1)), orbit.distance);
  const [right, down, forward] = orbit.axes();
  cross(right, down).forEach((v, k) => near(v, forward[k]));
});

test('an orbit starts where it is told, shows all of the object, and comes home', () => {
  for (const [up, from] of [[[0, 0, 1], [3, -4, 2]], [[0, 1, 0], [0, 5, 0.001]], [[0, 1, 0], [0, 5, 0]]]) {
    const orbit = new Orbit([0, 0, 0], 1, up, from);
    const away = unit(orbit.camera(100, 100).center);
    assert.ok(dot(away, unit(from)) > 0.99);
    const before = orbit.camera(100, 100);
    orbit.turn(1, 0.3);
    orbit.zoom(2);
    orbit.pan(0.2, 0.2);
    orbit.home();
    assert.deepEqual(orbit.camera(100, 100), before);
    const side = orbit.axes()[0];
    const edge = pixelOf(before, side)[0];
    assert.ok(edge > 70 && edge < 100);
  }
});

test('an orbit stays within its limits', () => {
  const orbit = new Orbit([0, 0, 0], 1, [0, 0, 1], [1, 0, 0]);
  for (let k = 0; k < 100; ++k) {
    orbit.turn(0.1, 1);
    orbit.zoom(0.5);
    orbit.pan(1, 1);
  }
  assert.ok(orbit.elevation < Math.PI / 2 && orbit.distance >= 1 && Math.hypot(...orbit.target) <= 2.001);
  assert.ok(orbit.camera(10, 10).world_from_cam.flat().every(Number.isFinite));
});

function packBytes(head, data) {
  const text = new TextEncoder().encode(JSON.stringify(head).padEnd(Math.ceil(JSON.stringify(head).length / 4) * 4));
  const out = new Uint8Array(4 + text.length + data.length);
  new DataView(out.buffer).setUint32(0, text.length, true);
  out.set(text, 4);
  out.set(data, 4 + text.length);
  return out.buffer;
}

test('packs have arrays of their types', () => {
  const head = {kind: 'look', parts: ['', 'a'], arrays: {a: {at: 0, type: 'u8', shape: [3, 1]}, b: {at: 4, type: 'i16', shape: [1, 2]}}};
  const bytes = packBytes(head, [1, 2, 3, 0, 255, 255, 2, 0]);
  const pack = readPack(bytes, 'look');
  assert.deepEqual([...pack.arrays.a], [1, 2, 3]);
  assert.deepEqual([...pack.arrays.b], [-1, 2]);
  assert.deepEqual(pack.head.parts, ['', 'a']);
  assert.throws(() => readPack(bytes, 'shape'));
});

test('the editor sees a point where the pinhole equation has it, and finds it again', () => {
  const camera = someCamera();
  for (const p of [[0, 0, 0], [0.5, -0.3, 0.8], [-1, 1, 0]]) {
    const [x, y, depth] = pixelOf(camera, p), at = seen(camera, p);
    near(at.x, x);
    near(at.y, y);
    near(at.depth, depth);
    pointAt(camera, at.x, at.y, at.depth).forEach((v, k) => near(v, p[k]));
  }
});

test('a picture across the view lies where another camera sees what it shows', () => {
  const camera = someCamera(), other = {...camera, fx: 300, center: plus(camera.center, [0.5, -0.2, 0.7]), world_from_cam: rotation([0, 0, 1], 0.1).map((row) => [0, 1, 2].map((k) => dot(row, camera.world_from_cam.map((r) => r[k]))))};
  const at = ([a, b, c, d, e, f], x, y) => [a * x + c * y + e, b * x + d * y + f];
  for (const [to, points] of [[camera, [[0, 0], [300, 200], [120, 70]]], [other, [[0, 0], [300, 0], [0, 200]]]]) {
    const map = ontoCorners(cornersOf(camera, 5, to), 300, 200);
    for (const [x, y] of points) {
      const want = pixelOf(to, pointAt(camera, x, y, 5)), got = at(map, x, y);
      near(got[0], want[0]);
      near(got[1], want[1]);
    }
  }
});

test('light is seen on the ball where a mirror shows it', () => {
  const r = someCamera().world_from_cam, axes = [0, 1, 2].map((k) => r.map((row) => row[k]));
  for (const [x, y] of [[0, 0], [0.3, -0.5], [-0.6, 0.2]]) {
    const d = mirrored(x, y, axes), back = placeOnBall(d, axes);
    near(Math.hypot(...d), 1);
    near(back.x, x);
    near(back.y, y);
  }
  near(dot(mirrored(0, 0, axes), axes[2]), -1);  // the middle shows who looks
  assert.ok(dot(mirrored(0.4, 0, axes), axes[0]) > 0 && dot(mirrored(0, 0.4, axes), axes[1]) > 0);
});

test('a map on the octahedron is read at its nodes', () => {
  const side = 5, map = new Uint32Array(side * side).map((_, i) => (i + 1) | (24 << 27));
  for (const [d, node] of [[[0, 0, 1], 12], [[1, 0, 0], 14], [[0, 1, 0], 22], [[-1, 0, 0], 10], [[0, 0, -1], 24]])
    assert.equal(radianceOf(map, side, d)[0], node + 1, String(d));
});

test('no two tools have the same key', () => {
  const all = keyTable.flatMap((group) => group.keys.flatMap((k) => k.keys));
  assert.equal(new Set(all).size, all.length);
  const key = (name, more = {}) => actionOf({key: name, shiftKey: false, ctrlKey: false, metaKey: false, altKey: false, ...more});
  assert.equal(key('d'), 'tool:decal');
  assert.equal(key('H', {shiftKey: true}), 'show-all');
  assert.equal(key('h'), 'hide');
  assert.equal(key('7'), 'opacity');
  assert.ok(gestures.length > 5);
});

test('a key that types is single, one with Ctrl or without a character is not', () => {
  const single = (key, more = {}) => isSingle({key, shiftKey: false, ctrlKey: false, metaKey: false, altKey: false, ...more});
  for (const key of ['b', '?', '.', ' ', '7']) assert.ok(single(key), key);
  assert.ok(single('H', {shiftKey: true}));
  for (const key of ['Enter', 'Escape', 'Delete', 'Home', 'ArrowLeft']) assert.ok(!single(key), key);
  assert.ok(!single('z', {ctrlKey: true}) && !single('z', {metaKey: true}));
});

test('the setting of single keys outlives the page, and a browser that keeps nothing', async () => {
  const stored = new Map(), fresh = (n) => import(`../../src/web/editor/settings.js?${n}`);
  const before = Object.getOwnPropertyDescriptor(globalThis, 'localStorage');
  const storage = (value) => Object.defineProperty(globalThis, 'localStorage', {configurable: true, ...value});
  storage({value: {getItem: (k) => stored.get(k) ?? null, setItem: (k, v) => stored.set(k, v)}});
  const first = await fresh(1);
  assert.equal(first.singleKeys(), true);
  first.setSingleKeys(false);
  assert.equal((await fresh(2)).singleKeys(), false);
  storage({get() { throw new Error('forbidden'); }});
  const third = await fresh(3);
  assert.equal(third.singleKeys(), true);
  third.setSingleKeys(false);
  assert.equal(third.singleKeys(), false);
  if (before) Object.defineProperty(globalThis, 'localStorage', before);
  else delete globalThis.localStorage;
});

test('a part looks as its vertices do on average', () => {
  const root = (v) => Math.round(65535 * Math.sqrt(v));
  // Two vertices of the part, linear 0.1 and 0.3, and one beside it; nothing is left of a part that another one covers.
  const albedo = new Uint16Array([...[0.1, 0.3, 0.9].flatMap((v) => [root(v), root(v), 0, 0])]);
  const material = new Uint8Array([51, 127, 255, 1, 153, 127, 255, 1, 0, 0, 0, 0]);
  const looks = partLooks({ head: { parts: ['', 'ear', 'covered'] }, arrays: { albedo, material } });
  assert.deepEqual([...looks.keys()], ['ear']);
  const ear = looks.get('ear');
  assert.equal(ear.color, 'rgb(124 124 0)');  // of linear 0.2, IEC 61966-2-1
  near(ear.roughness, 0.4);
  near(ear.metalness, 1);
  assert.equal(lookText(ear), 'roughness 0.40, metalness 1.00');
  assert.ok(swatch(ear).includes('rgb(124 124 0)'));
});

test('a part is where its vertices are', () => {
  const box = { min: [-1, 2, 0], size: [4, 2, 8] };
  // Three corners of the box, of which the last is of no part, and a vertex on its edge.
  const at = [[0, 0, 0], [65535, 0, 0], [65535, 65535, 65535], [13107, 0, 0]], parts = [1, 1, 0, 2];
  const shape = { head: box, arrays: { positions: new Uint16Array(at.flatMap((p) => [...p, 0])) } };
  const look = { head: { parts: ['', 'edge', 'dot', 'covered'] }, arrays: { material: new Uint8Array(parts.flatMap((i) => [0, 0, 0, i])) } };
  assert.deepEqual(partBall(shape, look, 'edge'), { center: [1, 2, 0], radius: 2 });
  const dot = partBall(shape, look, 'dot');
  near(dot.center[0], -0.2);
  near(dot.radius, 0);
  for (const name of ['covered', 'unknown', '']) assert.equal(partBall(shape, look, name), null);
});

test('the editor asks for all its modules at once', () => {
  const web = new URL('../../src/web/', import.meta.url), page = fs.readFileSync(new URL('editor/index.html', web), 'utf8');
  const files = new Set(['editor/main.js']);
  for (const file of files)
    for (const [, to] of fs.readFileSync(new URL(file, web), 'utf8').matchAll(/^import .* from '(.*)'/gm))
      files.add(new URL(to, new URL(file, web)).href.slice(web.href.length));
  const asked = [...page.matchAll(/modulepreload" href="\/app\/(.*)"/g)].map(([, file]) => file);
  files.delete('editor/main.js');
  for (const file of ['renderer.js', 'shaders.js', 'targets.js', 'camera.js', 'pack.js']) files.add(file);  // when an object is opened
  assert.deepEqual(asked.sort(), [...files].sort());
});

// As cmake/embed.cmake joins them.
test('the modules of the exported page are one script', () => {
  const root = new URL('../../', import.meta.url), read = (file) => fs.readFileSync(new URL(file, root), 'utf8');
  const names = /set\(modules ([a-z ]*)\)/.exec(read('cmake/embed.cmake'))[1].split(' ');
  const joined = names.map((name, at) => {
    const text = read(`src/web/${name}.js`);
    for (const [, from] of text.matchAll(/^import .* from '\.\/(.*)\.js';/gm)) assert.ok(names.slice(0, at).includes(from), `${name} before ${from}`);
    return text.replaceAll(/(^|\n)import {[^}]*} from '[^']*';/g, '').replaceAll('\nexport ', '\n');
  }).join('');
  assert.ok(!/^(import|export) /m.test(joined));
  new vm.Script(joined);  // names differ
});

test('pictures are as fine as there is time for', () => {
  const run = (pace, costs, pictures) => { for (let i = 0; i < pictures; ++i) pace.took(costs[pace.at] + (pace.first ? 900 : 0)); return pace.at; };
  const software = [600, 160, 90, 40], hardware = [6, 4, 3, 2];
  const slow = new Pace(false);
  assert.equal(run(slow, software, 4), 2);  // the driver prepares itself twice
  assert.equal(run(slow, software, 100), 2);
  assert.equal(run(new Pace(true), software, 100), 2);
  const quick = new Pace(true);
  assert.equal(run(quick, hardware, 15), 0);
  assert.equal(run(quick, hardware, 100), 0);
  assert.ok(run(quick, hardware.map((t) => 20 * t), 10) > 0);  // something else uses it, too
  assert.equal(run(quick, hardware, 30), 0);
  assert.deepEqual(steps[0], { scale: 1, rough: false, coarse: false });
});

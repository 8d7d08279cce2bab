#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// check_readers.cjs [--standing METERS] REPORT.json...: what readers of others find in exported files. REPORT: what
// `cei3d export --json` printed of a .glb, .gltf, .obj, .ply or .usdz. three.js, in a headless browser, and tinyusdz, of
// .usdz, must find the vertices, triangles and pictures that the report names, and in all files the same box and the same
// texels; with --standing a box of this longest side that stands in the origin. Exit code 1 if not; 77 where Chromium or
// npm packages are not installed (./run web).
'use strict';
const fs = require('fs');
const path = require('path');
const {browserPath, folderOf, optional} = require('./npm.cjs');

const kOrigin = 'http://asset.test';
const kTypes = {'.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm', '.png': 'image/png',
  '.jpg': 'image/jpeg', '.webp': 'image/webp'};
const kPictures = {glb: ['base_color', 'occlusion_roughness_metalness', 'normal'], ply: []};
kPictures.gltf = kPictures.usdz = kPictures.glb;
kPictures.obj = ['base_color', 'normal'];  // three.js has no word for the others

const kPage = `<!doctype html><script type="importmap">{"imports": {"three": "${kOrigin}/npm/three/build/three.module.js",
  "three/addons/": "${kOrigin}/npm/three/examples/jsm/", "tinyusdz/": "${kOrigin}/npm/tinyusdz/"}}</script>`;

// The page's network: the npm packages, and the folders of the files.
async function serve(page, files) {
  await page.route(`${kOrigin}/**`, (route) => {
    const [, root, ...rest] = decodeURIComponent(new URL(route.request().url()).pathname).split('/');
    if (root === 'page.html') return route.fulfill({contentType: 'text/html', body: kPage});
    if (root === 'read_asset.mjs') return route.fulfill({contentType: kTypes['.mjs'], body: fs.readFileSync(path.join(__dirname, root))});
    const file = root === 'npm' ? path.join(folderOf(rest[0]), ...rest.slice(1)) : path.join(path.dirname(files[root]), ...rest);
    if (!fs.existsSync(file)) return route.fulfill({status: 404});
    return route.fulfill({contentType: kTypes[path.extname(file)] || 'application/octet-stream', body: fs.readFileSync(file)});
  });
  await page.goto(`${kOrigin}/page.html`);
}

const sizeOf = (box) => Math.max(...[0, 1, 2].map((a) => box[3 + a] - box[a]));
const differ = (a, b, tolerance) => a.some((x, i) => !(Math.abs(x - b[i]) <= tolerance));

// @returns what a reader found of a file that the report does not say
function faultsOf(report, kind, found) {
  const faults = [];
  const expect = (what, a, b) => a === b || faults.push(`${what}: ${a}, not ${b}`);
  expect('triangles', found.triangles, report.triangles);
  expect('vertices', found.vertices, report.vertices);
  const names = report.files.map((f) => path.basename(f));
  const known = kPictures[kind];
  expect('pictures', Object.keys(rolesOf(found)).sort().join(), [...known].sort().join());
  for (const [role, p] of Object.entries(rolesOf(found))) {
    expect(`width of ${role}`, p.width, report.texture.size);
    expect(`height of ${role}`, p.height, report.texture.size);
    expect(`color space of ${role}`, p.encoded, role === 'base_color');
    if (['obj', 'gltf'].includes(kind) && !names.some((n) => n.endsWith(p.name || '?'))) faults.push(`${p.name} is not in the report`);
    if (p.name && !p.name.includes(role)) faults.push(`${role} is named ${p.name}`);
  }
  return faults;
}

// The pictures by our names for them.
function rolesOf(found) {
  const roles = {map: 'base_color', normalMap: 'normal', roughnessMap: 'occlusion_roughness_metalness'};
  return Object.fromEntries(Object.entries(roles).filter(([r]) => found.pictures[r]).map(([r, name]) => [name, found.pictures[r]]));
}

function faultsBetween(first, found) {
  const faults = [];
  if (differ(first.box, found.box, 1e-5 * sizeOf(first.box))) faults.push(`its box is [${found.box}], not [${first.box}]`);
  const [a, b] = [rolesOf(first), rolesOf(found)];
  for (const role of Object.keys(a))
    if (b[role] && a[role].texels !== b[role].texels) faults.push(`${role} has other texels`);
  return faults;
}

function standingFaults(box, meters) {
  const middle = [(box[0] + box[3]) / 2, box[1], (box[2] + box[5]) / 2, sizeOf(box)];
  return differ(middle, [0, 0, 0, meters], 1e-5 * meters) ? [`its box [${box}] does not stand in the origin`] : [];
}

async function checkAll(page, reports, standing) {
  let first = null, good = true;
  for (const [i, report] of reports.entries()) {
    const kind = path.extname(report.file).slice(1), url = `${kOrigin}/${i}/${encodeURIComponent(path.basename(report.file))}`;
    for (const reader of kind === 'usdz' ? [kind, 'tinyusdz'] : [kind]) {
      const found = await page.evaluate(async ([r, u]) => (await import('/read_asset.mjs')).read(r, u), [reader, url]);
      first = first || found;
      const faults = [...faultsOf(report, kind, found), ...faultsBetween(first, found),
        ...(standing ? standingFaults(found.box, standing) : [])];
      const name = `${report.file} by ${reader === 'tinyusdz' ? reader : 'three.js'}`;
      console.log(`${name}: ${found.vertices} vertices, ${found.triangles} triangles, ${Object.keys(rolesOf(found)).length} pictures`);
      for (const fault of faults) console.log(`${name}: ${fault}`);
      good = good && faults.length === 0;
    }
  }
  return good;
}

async function main() {
  const args = process.argv.slice(2);
  const at = args.indexOf('--standing');
  const standing = at < 0 ? null : Number(args.splice(at, 2)[1]);
  const driver = optional('playwright-core'), executablePath = browserPath();
  const lacking = !driver || !folderOf('three') ? 'npm packages are' : !executablePath ? 'Chromium is' : null;
  if (lacking) {
    console.log(`SKIP: exported assets in three.js and tinyusdz: ${lacking} not installed (./run web)`);
    process.exit(77);
  }
  const reports = args.map((file) => JSON.parse(fs.readFileSync(file, 'utf8'))).flatMap((r) => r.exports || [r]);
  const browser = await driver.chromium.launch({executablePath, args: process.getuid() === 0 ? ['--no-sandbox'] : []});
  try {
    const page = await browser.newPage();
    await serve(page, reports.map((r) => path.resolve(r.file)));
    process.exitCode = (await checkAll(page, reports, standing)) ? 0 : 1;
  } finally {
    await browser.close();
  }
}
main();

#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// check_gltf.cjs FILE.glb|FILE.gltf...: what two programs of others say about exported assets. Khronos' validator must find
// no error and no warning, in the files beside a .gltf neither; tangents must be those that MikkTSpace computes. Exit code 1
// if not; 77 where the npm packages gltf-validator and mikktspace are not installed (./run web).
'use strict';
const fs = require('fs');
const path = require('path');
const {optional} = require('./npm.cjs');

const validator = optional('gltf-validator');
const mikktspace = optional('mikktspace');

// A file's description, and its one buffer.
function contents(file) {
  const bytes = fs.readFileSync(file);
  if (path.extname(file) === '.gltf') {
    const json = JSON.parse(bytes.toString('utf8'));
    return {json, binary: fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(json.buffers[0].uri)))};
  }
  const size = bytes.readUInt32LE(12);
  return {json: JSON.parse(bytes.toString('utf8', 20, 20 + size)), binary: bytes.subarray(28 + size)};
}

function arrays({json, binary}) {
  const floats = (index) => {
    const a = json.accessors[index];
    const view = json.bufferViews[a.bufferView];
    const width = {SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4}[a.type];
    const from = binary.byteOffset + (view.byteOffset || 0);
    const copy = binary.buffer.slice(from, from + 4 * width * a.count);
    return a.componentType === 5125 ? new Uint32Array(copy) : new Float32Array(copy);
  };
  const primitives = json.meshes.flatMap((m) => m.primitives);  // of all parts, which share vertices
  const at = primitives[0].attributes;
  if (at.TANGENT === undefined) return null;
  return {
    indices: Uint32Array.from(primitives.flatMap((p) => [...floats(p.indices)])),
    positions: floats(at.POSITION),
    normals: floats(at.NORMAL),
    uv: floats(at.TEXCOORD_0),
    tangents: floats(at.TANGENT),
  };
}

const spread = (values, indices, width) => {
  const out = new Float32Array(indices.length * width);
  indices.forEach((v, i) => out.set(values.subarray(v * width, v * width + width), i * width));
  return out;
};

// Degrees between the file's tangents and MikkTSpace's, of every corner, ascending; and how many signs are wrong.
function tangentErrors(file) {
  const a = arrays(contents(file));
  if (!a) return null;
  const theirs = mikktspace.generateTangents(
      spread(a.positions, a.indices, 3), spread(a.normals, a.indices, 3), spread(a.uv, a.indices, 2));
  const ours = spread(a.tangents, a.indices, 4);
  const errors = [];
  let signs = 0;
  for (let i = 0; i < ours.length; i += 4) {
    const cosine = ours[i] * theirs[i] + ours[i + 1] * theirs[i + 1] + ours[i + 2] * theirs[i + 2];
    errors.push(Math.acos(Math.min(1, cosine)) * 180 / Math.PI);
    if (ours[i + 3] !== -theirs[i + 3]) ++signs;  // glTF's sign is minus theirs: v grows downwards
  }
  return {errors: errors.sort((x, y) => x - y), signs};
}

async function check(file) {
  const beside = async (uri) => new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri))));
  const {issues} = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)),
      {uri: path.basename(file), externalResourceFunction: beside});
  for (const m of issues.messages.filter((m) => m.severity < 2)) console.log(`${file}: ${m.code} ${m.message} ${m.pointer}`);
  let text = `${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings`;
  let good = issues.numErrors + issues.numWarnings === 0;
  const t = mikktspace && tangentErrors(file);
  if (t) {
    const at = (share) => t.errors[Math.min(t.errors.length - 1, Math.floor(share * t.errors.length))];
    text += `; tangents: median ${at(0.5).toFixed(4)}, 99.9 % ${at(0.999).toFixed(3)} degrees from MikkTSpace's, ` +
        `${t.signs} wrong signs`;
    good = good && at(0.99) < 0.1 && at(0.999) < 0.5 && t.signs < t.errors.length / 1000;
  }
  console.log(text);
  return good;
}

async function main() {
  if (!validator) {
    console.log('SKIP: assets by the glTF validator: the npm package gltf-validator is not installed (./run web)');
    process.exit(77);
  }
  if (!mikktspace) console.log('SKIP: tangents of assets: the npm package mikktspace is not installed (./run web)');
  let good = true;
  for (const file of process.argv.slice(2)) good = (await check(file)) && good;
  process.exit(good ? 0 : 1);
}
main();

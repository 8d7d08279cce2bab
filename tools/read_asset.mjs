// SPDX-License-Identifier: Apache-2.0
// Runs in a browser, for check_readers.cjs: what three.js and tinyusdz find in an exported file.
import * as THREE from 'three';

const addon = async (name) => (await import(`three/addons/loaders/${name}.js`))[name];

// By the kind of file. @param {THREE.LoadingManager} manager
const loaders = {
  glb: async (url, manager) => (await new (await addon('GLTFLoader'))(manager).loadAsync(url)).scene,
  ply: async (url, manager) => new THREE.Mesh(await new (await addon('PLYLoader'))(manager).loadAsync(url), []),
  usdz: async (url, manager) => new (await addon('USDLoader'))(manager).loadAsync(url),
  obj: async (url, manager) => {
    const materials = await new (await addon('MTLLoader'))(manager).loadAsync(url.replace(/obj$/, 'mtl'));
    return new (await addon('OBJLoader'))(manager).setMaterials(materials).loadAsync(url);
  },
  tinyusdz: async (url) => {
    const {TinyUSDZLoader} = await import('tinyusdz/TinyUSDZLoader.js');
    const stage = await (await new TinyUSDZLoader().init()).loadAsync(url);
    return objectOf(stage, stage.getDefaultRootNode());
  },
};
loaders.gltf = loaders.glb;

// tinyusdz' nodes and meshes as those of three.js.
async function objectOf(stage, node) {
  const object = node.nodeType === 'mesh' ? await meshOf(stage, stage.getMesh(node.contentId)) : new THREE.Group();
  object.applyMatrix4(new THREE.Matrix4().fromArray(node.localMatrix));
  for (const child of node.children || []) object.add(await objectOf(stage, child));
  return object;
}

async function meshOf(stage, mesh) {
  const geometry = new THREE.BufferGeometry().setIndex(new THREE.BufferAttribute(mesh.faceVertexIndices, 1));
  geometry.setAttribute('position', new THREE.BufferAttribute(mesh.points, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(mesh.normals, 3));
  geometry.setAttribute('uv', new THREE.BufferAttribute(mesh.texcoords, 2));
  const ids = stage.getMaterial(mesh.materialId), material = new THREE.MeshStandardMaterial();
  material.map = await textureOf(stage, ids.diffuseColorTextureId);
  material.roughnessMap = await textureOf(stage, ids.roughnessTextureId);
  material.normalMap = await textureOf(stage, ids.normalTextureId);
  return new THREE.Mesh(geometry, material);
}

async function textureOf(stage, id) {
  const {uri, data, usdColorSpace} = stage.getImage(stage.getTexture(id).textureImageId);
  const texture = new THREE.Texture(await createImageBitmap(new Blob([data])));
  texture.name = uri;
  texture.colorSpace = usdColorSpace === 'srgb' ? THREE.SRGBColorSpace : THREE.NoColorSpace;
  return texture;
}

function boxOf(object) {
  const box = new THREE.Box3().setFromObject(object, true);
  return [...box.min.toArray(), ...box.max.toArray()];
}

// Vertices that differ and are used; readers may give every corner of a triangle its own.
function countsOf(object) {
  const vertices = new Set();
  let triangles = 0;
  const values = (attribute, i) => {
    if (!attribute) return '';
    const n = attribute.itemSize;
    return Array.from(attribute.array.subarray(n * i, n * i + n), Math.fround).join();
  };
  object.traverse(({isMesh, geometry}) => {
    if (!isMesh) return;
    const {position, normal, uv} = geometry.attributes, corners = geometry.index ? geometry.index.count : position.count;
    for (let k = 0; k < corners; ++k) {
      const i = geometry.index ? geometry.index.getX(k) : k;
      vertices.add(`${values(position, i)} ${values(normal, i)} ${values(uv, i)}`);
    }
    triangles += corners / 3;
  });
  return {vertices: vertices.size, triangles};
}

// By three.js' names for their roles.
async function picturesOf(object, failed) {
  const materials = [], out = {};
  object.traverse((o) => { if (o.isMesh) materials.push(o.material); });
  for (const material of materials.flat())
    for (const [role, texture] of Object.entries(material))
      if (texture && texture.isTexture) out[role] = await pictureOf(texture, failed);
  return out;
}

// texels: a number that says which they are.
async function pictureOf(texture, failed) {
  while (!texture.image || texture.image.complete === false) {
    if (failed.length > 0) throw new Error(`${failed[0]} cannot be loaded`);
    await new Promise((resolve) => { setTimeout(resolve, 20); });
  }
  const {image} = texture, {width, height} = image;
  const context = new OffscreenCanvas(width, height).getContext('2d', {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  let texels = 0;
  for (const value of context.getImageData(0, 0, width, height).data) texels = (Math.imul(texels, 31) + value) | 0;
  const name = texture.name || (image.src && !image.src.startsWith('blob:') ? image.src.split('/').pop() : '');
  return {name, width, height, encoded: texture.colorSpace === THREE.SRGBColorSpace, texels};
}

/** @param {string} reader a kind of file, or "tinyusdz" @param {string} url */
export async function read(reader, url) {
  const manager = new THREE.LoadingManager(), failed = [];
  manager.onError = (what) => failed.push(what);
  const object = await loaders[reader](url, manager);
  return {box: boxOf(object), ...countsOf(object), pictures: await picturesOf(object, failed)};
}

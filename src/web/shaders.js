// SPDX-License-Identifier: Apache-2.0
// @ts-check
// The program's shading (docs/method.md#shading), approximated by values at vertices and by maps of the light. Formulas
// that depend only on material and angle are read from tables (src/engine/view/view_light.h).

export const vertexShader = `#version 300 es
precision highp float;
layout(location = 0) in vec4 aPosition;
layout(location = 1) in vec2 aNormal;
layout(location = 2) in vec4 aAlbedo;
layout(location = 3) in vec4 aMaterial;
layout(location = 4) in vec4 aVisibility;
layout(location = 5) in uint aBounce;
layout(location = 6) in vec4 aVisibility0;
layout(location = 7) in vec4 aVisibility1;
layout(location = 8) in vec4 aVisibility2;
layout(location = 9) in vec4 aObject0;
layout(location = 10) in vec4 aObject1;
layout(location = 11) in vec4 aObject2;
layout(location = 12) in vec4 aObject3;
layout(location = 13) in vec4 aObject4;
layout(location = 14) in vec4 aObject5;
layout(location = 15) in vec4 aObject6;
uniform mat4 uClip;
uniform vec3 uBoxMin, uBoxSize;  // relative to the camera
uniform float uVisibilityScale, uObjectScale;
out vec3 vPosition, vNormal, vVisibility, vBounce, vMaterial, vObject;
out vec4 vAlbedo, vVisibility1, vVisibility2;
out float vVisibility0;
flat out int vPart;

vec3 fromOctahedron(vec2 p) {
  vec3 d = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (d.z < 0.0) d.xy = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
  return normalize(d);
}

vec3 fromSharedExponent(uint bits) {
  return vec3(uvec3(bits, bits >> 9, bits >> 18) & 511u) * exp2(float(bits >> 27) - 24.0);
}

// Mean radiance of the surface itself over the reflection lobe. docs: src/engine/view/reflection_fit.h
vec3 objectReflected(vec3 n, vec3 v) {
  vec3 d = 2.0 * dot(n, v) * n - v;
  vec3 sum = aObject0.xyz + vec3(aObject0.w, aObject1.xy) * d.y + vec3(aObject1.zw, aObject2.x) * d.z + aObject2.yzw * d.x +
             aObject3.xyz * (d.x * d.y) + vec3(aObject3.w, aObject4.xy) * (d.y * d.z) +
             vec3(aObject4.zw, aObject5.x) * (3.0 * d.z * d.z - 1.0) + aObject5.yzw * (d.x * d.z) +
             aObject6.xyz * (d.x * d.x - d.y * d.y);
  return max(sum * (aObject6.w * aObject6.w * uObjectScale), 0.0);
}

void main() {
  vPosition = uBoxMin + aPosition.xyz * uBoxSize;
  vNormal = fromOctahedron(aNormal);
  vAlbedo = vec4(aAlbedo.rgb * aAlbedo.rgb, aAlbedo.a);
  vMaterial = aMaterial.xyz;
  vVisibility = aVisibility.rgb;
  vBounce = fromSharedExponent(aBounce);
  vVisibility0 = aVisibility0.x * uVisibilityScale;
  vVisibility1 = vec4(aVisibility0.yzw, aVisibility1.x) * uVisibilityScale;
  vVisibility2 = vec4(aVisibility1.yzw, aVisibility2.x) * uVisibilityScale;
  vPart = int(aMaterial.w * 255.0 + 0.5);
  vObject = objectReflected(vNormal, normalize(-vPosition));
  gl_Position = uClip * vec4(vPosition, 1.0);
}`;

// A bit for every part.
const isHidden = `bool isHidden() { return (uHidden[vPart >> 5] >> uint(vPart & 31) & 1u) != 0u; }`;

/** The surface with its color; color: GLSL that sets `vec3 color` of the normal n and the direction v to the camera. @param {string} before @param {string} color */
const surfaceWith = (before, color) => `#version 300 es
precision highp float;
precision highp int;
precision highp sampler3D;
in vec3 vPosition, vNormal, vVisibility, vBounce, vMaterial, vObject;
in vec4 vAlbedo, vVisibility1, vVisibility2;
in float vVisibility0;
flat in int vPart;
uniform int uChannel, uHighlight;
uniform uint uHidden[8];
uniform vec3 uHighlightColor;
out vec4 outColor;
${before}
${isHidden}
void main() {
  if (isHidden()) discard;
  vec3 n = normalize(vNormal), v = normalize(-vPosition);
  vec3 color;
  ${color}
  if (vPart > 0 && vPart == uHighlight) color = mix(color, uHighlightColor, 0.4);
  outColor = vec4(color, 1.0);
}`;

// Channels that need no light. Drivers prepare this shader in a fraction of the time of the other one.
export const plainShader = surfaceWith('', `
  if (uChannel == 1) color = vAlbedo.rgb;
  else if (uChannel == 2) color = n * 0.5 + 0.5;
  else color = vec3(uChannel == 3 ? vMaterial.x : vMaterial.z);`);

export const litShader = surfaceWith(`
uniform mat3 uRoom;  // directions of the light from those of the object
uniform sampler2D uIrradiance, uSurface, uBase, uFresnel, uLobe;
uniform sampler3D uReflection;
uniform float uIrradianceSide, uReflectionSide, uReflectionLevels;
uniform vec2 uTableSize;
uniform float uMinRoughness, uMiddleShare, uDielectricF0, uMetalF0, uStrength;
uniform float uObjectScale;  // 0: the reflections of the object in itself are not known
const float kPi = 3.14159265;

vec2 octahedral(vec3 d, float side) {
  vec2 p = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
  if (d.z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
  return ((p * 0.5 + 0.5) * (side - 1.0) + 0.5) / side;
}

// Mean visibility over a lobe: bands 1 and 2 are smoothed. docs: src/engine/view/visibility_harmonics.h
float visibility(vec3 d, vec2 smoothed) {
  float first = dot(vVisibility1.xyz, d.yzx);
  float second = vVisibility1.w * d.x * d.y + vVisibility2.x * d.y * d.z + vVisibility2.y * (3.0 * d.z * d.z - 1.0) +
                 vVisibility2.z * d.x * d.z + vVisibility2.w * (d.x * d.x - d.y * d.y);
  return clamp(vVisibility0 + smoothed.x * first + smoothed.y * second, 0.0, 1.0);
}

vec3 reflection(vec3 d, float level) {
  return texture(uReflection, vec3(octahedral(uRoom * d, uReflectionSide),
                                   (level * (uReflectionLevels - 1.0) + 0.5) / uReflectionLevels)).rgb;
}

// Light over one of the two reflection lobes, as over three round ones, as far as they are above the horizon.
// axis: written.
vec3 alongLobe(vec4 lobe, vec3 n, vec3 mirror, vec3 across, out vec3 axis) {
  axis = normalize(mix(mirror, n, lobe.x));
  vec3 side = cross(across, axis) * sin(lobe.z), middle = axis * cos(lobe.z);
  vec3 weights = vec3(uMiddleShare, vec2(0.5 - 0.5 * uMiddleShare));
  vec3 above = vec3(dot(axis, n), dot(middle + side, n), dot(middle - side, n));
  weights /= 1.0 + exp(-clamp(lobe.w * above, -40.0, 40.0));
  return (reflection(axis, lobe.y) * weights.x + reflection(middle + side, lobe.y) * weights.y +
          reflection(middle - side, lobe.y) * weights.z) / (weights.x + weights.y + weights.z);
}

// The reflection where the surface hides a part of the sky.
vec3 withObject(vec3 sky, vec3 n, vec3 mirror, vec3 axis, vec2 smoothed) {
  if (uObjectScale > 0.0) return sky * visibility(mirror, vec2(1.0)) + vObject;
  float free = visibility(axis, smoothed);
  // The mean radiance of what blocks the sky: the bounce over the blocked share of the cosine.
  float blocked = 1.0 - visibility(n, vec2(2.0 / 3.0, 0.25));
  return sky * free + vBounce / (kPi * max(blocked, 0.05)) * (1.0 - free);
}

vec3 lit(vec3 n, vec3 v, float roughness, float specular, float metalness) {
  vec3 albedo = vAlbedo.rgb;
  float nv = dot(n, v);
  vec2 at = vec2(sqrt(clamp(nv, 0.0, 1.0)), clamp((roughness - uMinRoughness) / (1.0 - uMinRoughness), 0.0, 1.0));
  vec2 uv = (at * (uTableSize - 1.0) + 0.5) / uTableSize;
  vec4 surface = texture(uSurface, uv);
  vec2 smoothed = texture(uLobe, vec2(0.5, uv.y)).xy;
  float dielectric = (1.0 - metalness) * uDielectricF0 * specular;
  float f0 = dielectric + metalness * uMetalF0, f90 = mix(min(2.0 * specular, 1.0), 1.0, metalness);
  float share = f0 * surface.x / max(f0 * surface.x + f90 * surface.y, 1e-6);
  vec3 mirror = normalize(2.0 * nv * n - v), across = cross(n, v);
  across /= max(length(across), 1e-4);
  vec3 baseAxis, fresnelAxis;
  vec3 sky = alongLobe(texture(uBase, uv), n, mirror, across, baseAxis) * share;
  sky += alongLobe(texture(uFresnel, uv), n, mirror, across, fresnelAxis) * (1.0 - share);
  vec3 reflected = withObject(sky, n, mirror, normalize(mix(fresnelAxis, baseAxis, share)), smoothed);
  vec3 irradiance = texture(uIrradiance, octahedral(uRoom * n, uIrradianceSide)).rgb * vVisibility + vBounce;
  vec3 color = albedo * irradiance * ((1.0 - metalness) / kPi * surface.z) +
               ((albedo * metalness + dielectric) * surface.x + f90 * surface.y) * reflected;
  return mix(max(color, 0.0) * uStrength, albedo, vAlbedo.a);
}`, 'color = lit(n, v, vMaterial.x, vMaterial.y, vMaterial.z);');

export const partShader = `#version 300 es
precision highp float;
precision highp int;
flat in int vPart;
uniform uint uHidden[8];
out vec4 outColor;
${isHidden}
void main() {
  if (isHidden()) discard;
  outColor = vec4(float(vPart) / 255.0, 0.0, 0.0, 1.0);
}`;

// The whole picture.
export const screenShader = `#version 300 es
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(corner * 4.0 - 1.0, 0.0, 1.0);
}`;

// The mean of a pixel's 2 x 2 samples by the weights of a tent of two pixels' width, as in the program's own pictures; a
// single sample as it is. From linear to display-encoded color.
export const filterShader = `#version 300 es
precision highp float;
uniform sampler2D uSamples;
uniform int uPerPixel;
uniform bool uEncode;
out vec4 outColor;

vec4 filtered(vec2 pixel) {
  vec2 size = vec2(textureSize(uSamples, 0));
  if (uPerPixel == 1) return texture(uSamples, (pixel + 0.5) / size);
  vec2 low = 2.0 * pixel + 0.25, high = 2.0 * pixel + 1.75;  // between a far sample and a near one
  return 0.25 * (texture(uSamples, low / size) + texture(uSamples, vec2(low.x, high.y) / size) +
                 texture(uSamples, vec2(high.x, low.y) / size) + texture(uSamples, high / size));
}

vec3 encoded(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
  vec4 sum = filtered(floor(gl_FragCoord.xy));
  vec3 color = sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0);
  outColor = vec4((uEncode ? encoded(color) : clamp(color, 0.0, 1.0)) * sum.a, sum.a);
}`;

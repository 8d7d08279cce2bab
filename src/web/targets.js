// SPDX-License-Identifier: Apache-2.0
// @ts-check
// The buffers into which the renderer draws before a picture is shown.

/** @typedef {{frame: WebGLFramebuffer, width: number, height: number, parts: (WebGLRenderbuffer | WebGLTexture)[]}} Target */

const kMultisamples = 4;

/** A new buffer: multisampled, or a texture if `multisamples` is 0. @param {WebGL2RenderingContext} gl @param {number} width @param {number} height @param {number} format @param {number} multisamples @returns {Target} */
export function makeTarget(gl, width, height, format, multisamples) {
  const frame = gl.createFramebuffer(), depth = gl.createRenderbuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
  gl.renderbufferStorageMultisample(gl.RENDERBUFFER, multisamples, gl.DEPTH_COMPONENT24, width, height);
  gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  if (multisamples > 0) {
    const color = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, color);
    gl.renderbufferStorageMultisample(gl.RENDERBUFFER, multisamples, format, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, color);
    return {frame, width, height, parts: [color, depth]};
  }
  const color = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, color);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
  for (const size of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, size, gl.LINEAR);
  for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, color, 0);
  return {frame, width, height, parts: [color, depth]};
}

/** @param {WebGL2RenderingContext} gl @param {Target} target */
function dropTarget(gl, target) {
  gl.deleteFramebuffer(target.frame);
  for (const part of target.parts) {
    if (part instanceof WebGLTexture) gl.deleteTexture(part);
    else gl.deleteRenderbuffer(part);
  }
}

/** The samples of a picture and their mean, made anew when another size is needed. */
export class Targets {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    // Half floats, where the hardware can draw into them, so that samples are averaged before they are clipped to 1.
    const float = gl.getExtension('EXT_color_buffer_half_float') || gl.getExtension('EXT_color_buffer_float');
    this.format = float ? gl.RGBA16F : gl.SRGB8_ALPHA8;
    /** @type {{samples: Target | null, mean: Target} | null} samples: null for a rough picture */
    this.now = null;
  }

  /** @param {number} width @param {number} height @param {boolean} rough */
  of(width, height, rough) {
    const {gl, now} = this;
    if (now && (now.mean.width !== width || now.mean.height !== height || (now.samples === null) !== rough)) {
      for (const target of [now.samples, now.mean]) if (target) dropTarget(gl, target);
      this.now = null;
    }
    this.now ??= {samples: rough ? null : makeTarget(gl, width, height, this.format, kMultisamples),
      mean: makeTarget(gl, width, height, this.format, 0)};
    return this.now;
  }
}

// SPDX-License-Identifier: Apache-2.0
// Images of a scene, in two steps: trace (expensive, cacheable) and shade (cheap; all that light and paint
// change).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "model/scene/scene.h"

namespace cei3d {

class SceneLight;  // engine/render/scene_light.h
struct HitMemory;  // engine/render/hit_memory.h

// Every sub-pixel sample that met the surface, ordered by pixel.
struct GBuffer {
  int width = 0, height = 0;
  std::vector<uint8_t> samples;       // #pixels, along an axis: a grid of samples x samples
  std::vector<Hit> hits;              // #H
  std::vector<float> depths;          // #H, z-depth in unit frame
  std::vector<uint16_t> sub_pixels;   // #H, which sample of its pixel, see core/math/sub_pixel.h
  std::vector<uint32_t> pixel_start;  // #pixels + 1: pixel p owns hits [start[p], start[p + 1])
  int samples_of(size_t pixel) const { return int(samples[pixel]) * samples[pixel]; }
};
// Hits of the rays (unit frame) that meet the surface, in order. ray_of_hit: written, #hits.
std::vector<Hit> trace_rays(const Device&, const Field& sdf, const Surface&, std::span<const Ray> rays,
                            std::vector<uint32_t>& ray_of_hit);

// Moves hits along their rays (directions: #hits, unit) onto the zero set of the field, and sets their
// normals (and `edges`, if not empty) by sdf_normals().
void refine_hits(const Device&, const Field& sdf, std::span<const Vec3f> directions, std::span<Hit> hits,
                 std::span<float> edges = {});

// Moves hits on the mesh of the scene along their to_camera onto its surface, changes of shape included.
void refine_hits(const Device&, const Scene&, std::vector<Hit>& hits);

// Where hits are: on the zero set of the field, or on the mesh, with its normals, which is several times as
// fast and at most about a hundredth away.
enum class OnSurface { field, mesh };

// trace_rays() for the scene with its changes of shape.
std::vector<Hit> trace_rays(const Device&, const Scene&, std::span<const Ray> rays,
                            std::vector<uint32_t>& ray_of_hit, OnSurface = OnSurface::field);

// camera: unit frame. samples: per pixel and axis, at most 16. If more than 1, pixels on the silhouette get
// twice as many: they are few, and coverage needs the steps (docs/notebook/0015).
GBuffer trace_view(const Device&, const Scene&, const Camera& camera, int samples = 2,
                   OnSurface = OnSurface::field);

// A pixel is the tent-weighted mean of the samples within one pixel of its center, close to the filters of
// renderers and lenses (Blackman-Harris of 1.5 pixels, Gaussians): on ground-truth surfaces its coverage is 9
// dB closer to the truth than a box filter's.
struct Frame {
  Image rgb, albedo, diffuse, specular;  // RGBA, linear, straight alpha
  Image normal;                          // RGB, unit vectors in the capture's axes; 0 where nothing was hit
  Image depth;                           // 1 channel, z-depth in capture units; 0 where nothing was hit
  Image roughness, metalness;            // 1 channel; 0 where nothing was hit
  Image mask;                            // 1 channel, coverage
  std::vector<uint8_t> edited;           // #pixels, 1: a sample of the pixel lies in the region of an edit
};
Frame shade_view(const Device&, const Scene&, const SceneLight&, const GBuffer&);
// Frame::albedo alone. albedo: #hits, linear.
Image filtered_albedo(const GBuffer&, std::span<const Vec3f> albedo);
// shade_view(), the same bit for bit. memory: of an earlier frame of the same buffer
// (engine/render/hit_memory.h); what is unchanged is taken from it, and this frame is kept in it.
Frame shade_view(const Device&, const Scene&, const SceneLight&, const GBuffer&, HitMemory& memory);
Frame shade_view(const Device&, const Scene&, const GBuffer&);  // for a single view

}  // namespace cei3d

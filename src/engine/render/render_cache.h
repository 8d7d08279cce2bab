// SPDX-License-Identifier: Apache-2.0
// Data that frames of one object share, kept in memory within limits, and some of it in files: transport and
// light of each shape version, traced views and the light on their hits. The key of a value is everything
// that it depends on, so no value is ever stale, and a frame is the same bit for bit with the cache and
// without. For one thread at a time; the values are immutable.
#pragma once

#include <memory>
#include <vector>

#include "engine/render/hit_memory.h"
#include "engine/render/render.h"
#include "engine/render/vertex_light_files.h"

namespace cei3d {

// Limits in bytes. A 512 x 512 frame of 2 x 2 samples that the object half fills takes about 50 MB of
// `views`.
struct RenderCacheLimits {
  size_t transports = size_t(512) << 20, lights = size_t(256) << 20, views = size_t(256) << 20,
         colors = size_t(64) << 20;
};

struct TracedView {
  GBuffer buffer;
  HitMemory memory;  // of its latest frame
};

class RenderCache {
 public:
  explicit RenderCache(const Device& device, RenderCacheLimits limits = {}, VertexLightFiles = {});

  SceneLight light(const Scene&);  // must not outlive the cache
  // light(); that on the reconstructed shape is kept in a file, too.
  SceneLight light_to_keep(const Scene&);
  // Whether light() reads from a file what would take seconds to compute.
  bool light_is_stored(const Scene& scene) const {
    return scene.shape_versions.size() <= 1 && files_.has(scene.light);
  }
  // camera: unit frame. See trace_view().
  std::shared_ptr<TracedView> trace(const Scene&, const Camera& camera, int samples);
  // view: of the scene's present shape.
  Frame shade(const Scene&, const SceneLight&, TracedView& view);

  const CacheCount& transport_count() const { return transports_.count(); }
  const CacheCount& light_count() const { return lights_.count(); }
  const CacheCount& view_count() const { return views_.count(); }
  // What it has made of each layer.
  size_t layer_bytes() const { return seen_.bytes(); }
  // Hits of all frames so far whose light was computed, and whose light was taken over from the frame before.
  size_t hits_lit() const { return hits_lit_; }
  size_t hits_kept() const { return hits_kept_; }

 private:
  using SurfacePtr = std::shared_ptr<const Surface>;
  struct TransportKey {
    SurfacePtr surface, before;  // of the shape version and the one before it; null for version 0
    bool operator==(const TransportKey&) const = default;
  };
  struct LightKey {
    SurfacePtr surface, before;
    std::shared_ptr<const Field> albedo;
    MaterialField material;
    std::vector<float> light;
    bool operator==(const LightKey&) const = default;
  };
  struct ViewKey {
    SurfacePtr surface;
    std::shared_ptr<const Field> sdf;
    std::vector<double> camera;
    int samples;
    bool operator==(const ViewKey&) const = default;
  };
  std::shared_ptr<const Transport> transport(const Scene&, size_t version);
  std::shared_ptr<const VersionLight> version_light(const Scene&, size_t version, const VersionLight* before);
  std::shared_ptr<const VersionLight> made_light(const Scene&, size_t version, const VersionLight* before);

  const Device& device_;
  LruCache<TransportKey, const Transport> transports_;
  LruCache<LightKey, const VersionLight> lights_;
  LruCache<ViewKey, TracedView> views_;
  SeenHistories seen_;
  VertexLightFiles files_;
  size_t hits_lit_ = 0, hits_kept_ = 0;
};

}  // namespace cei3d

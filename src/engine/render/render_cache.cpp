// SPDX-License-Identifier: Apache-2.0
#include "engine/render/render_cache.h"

#include <algorithm>

namespace cei3d {
namespace {

std::vector<double> numbers_of(const Camera& c) {
  std::vector<double> n{double(c.width), double(c.height), c.fx, c.fy, c.cx, c.cy, c.skew};
  for (const Vec3d& row : c.world_from_cam.row) n.insert(n.end(), {row.x, row.y, row.z});
  n.insert(n.end(), {c.center.x, c.center.y, c.center.z});
  return n;
}

size_t bytes_of(const GBuffer& g) {
  return g.hits.size() * (sizeof(Hit) + sizeof(float) + sizeof(uint16_t)) +
         g.samples.size() * (sizeof(uint8_t) + sizeof(uint32_t));
}

// Bytes of a full HitMemory: appearance, radiance and network output of each hit.
size_t memory_bytes(const GBuffer& g) { return g.hits.size() * (4 * sizeof(Vec3f) + 6 * sizeof(float)); }

// Four values at each vertex; the lighting has a copy.
size_t bytes_of(const VersionLight& light) { return 8 * light.vertices.visibility.size() * sizeof(Vec3f); }

std::shared_ptr<const Surface> surface_before(const Scene& scene, size_t version) {
  return version == 0 ? nullptr : surface_of_version(scene, version - 1);
}

}  // namespace

RenderCache::RenderCache(const Device& device, RenderCacheLimits limits, VertexLightFiles files)
    : device_(device),
      transports_(limits.transports),
      lights_(limits.lights),
      views_(limits.views),
      seen_(limits.colors),
      files_(std::move(files)) {}

std::shared_ptr<const Transport> RenderCache::transport(const Scene& scene, size_t version) {
  TransportKey key{surface_of_version(scene, version), surface_before(scene, version)};
  if (auto kept = transports_.find(key)) return kept;
  const auto made = transport_of_version(scene, version);
  return transports_.put(std::move(key), made, made->bytes());
}

std::shared_ptr<const VersionLight> RenderCache::version_light(const Scene& scene, size_t version,
                                                               const VersionLight* before) {
  LightKey key{surface_of_version(scene, version), surface_before(scene, version), scene.albedo,
               scene.material, to_array(scene.light)};
  if (auto kept = lights_.find(key)) return kept;
  const auto made = made_light(scene, version, before);
  return lights_.put(std::move(key), made, bytes_of(*made));
}

std::shared_ptr<const VersionLight> RenderCache::made_light(const Scene& scene, size_t version,
                                                            const VersionLight* before) {
  if (version == 0)
    if (auto stored = files_.find(scene.light, rest_materials(device_, scene)))
      return light_on_version(device_, scene, version, std::move(*stored));
  return light_on_version(device_, scene, version, *transport(scene, version), before);
}

SceneLight RenderCache::light_to_keep(const Scene& scene) {
  SceneLight made = light(scene);
  files_.put(scene.light, version_light(scene, 0, nullptr)->vertices);
  return made;
}

SceneLight RenderCache::light(const Scene& scene) {
  VersionLights lights;
  for (size_t k = 0; k < std::max<size_t>(scene.shape_versions.size(), 1); ++k)
    lights.push_back(version_light(scene, k, lights.empty() ? nullptr : lights.back().get()));
  return SceneLight(device_, scene, std::move(lights), &seen_);
}

std::shared_ptr<TracedView> RenderCache::trace(const Scene& scene, const Camera& camera, int samples) {
  ViewKey key{scene.surface, scene.sdf, numbers_of(camera), samples};
  if (auto kept = views_.find(key)) return kept;
  const auto view = std::make_shared<TracedView>(TracedView{trace_view(device_, scene, camera, samples), {}});
  return views_.put(std::move(key), view, bytes_of(view->buffer) + memory_bytes(view->buffer));
}

Frame RenderCache::shade(const Scene& scene, const SceneLight& light, TracedView& view) {
  Frame frame = shade_view(device_, scene, light, view.buffer, view.memory);
  hits_kept_ += view.memory.lit->kept;
  hits_lit_ += view.buffer.hits.size() - view.memory.lit->kept;
  return frame;
}

}  // namespace cei3d

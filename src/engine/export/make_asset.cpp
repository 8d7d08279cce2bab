// SPDX-License-Identifier: Apache-2.0
#include "engine/export/make_asset.h"

#include <algorithm>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "model/geometry/mesh/simplify.h"
#include "model/scene/appearance.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

// The surface may be farther from the simplified one than the error of the last collapse says, which is a
// mean over planes.
float reach_of(float error) {
  constexpr float kTimes = 5, kMin = 0.01f, kMax = 0.05f;
  return std::clamp(kTimes * error, kMin, kMax);
}

void to_capture_frame(TexturedMesh& mesh, const Normalization& n) {
  for (Vec3f& p : mesh.positions) p = to_float(n.capture_from_unit(to_double(p)));
}

// A triangle is in the part of two of its corners, else of its first. vertex: of the scene's surface, #V.
std::vector<NamedTriangles> by_part(const Scene& scene, const std::vector<uint32_t>& vertex,
                                    const TexturedMesh& mesh, const std::string& name) {
  const PartsOfHits parts = parts_of(scene, vertex_hits(scene.surface->mesh()));
  std::vector<NamedTriangles> out;
  for (const std::string& part : parts.names) out.push_back({part.empty() ? name : part, {}});
  for (const auto& t : mesh.triangles) {
    const uint8_t a = parts.of[vertex[t[0]]], b = parts.of[vertex[t[1]]], c = parts.of[vertex[t[2]]];
    out[b == c ? b : a].triangles.push_back(t);
  }
  std::erase_if(out, [](const NamedTriangles& part) { return part.triangles.empty(); });
  return out;
}

}  // namespace

MadeAsset make_asset(const Device& device, const Scene& scene, const std::string& name,
                     const AssetOptions& options, Progress& progress) {
  if (!scene.surface || !scene.albedo) fail("The object has no surface to export; reconstruct it again.");
  progress.report({"simplify", 0.02, -1, ""});
  const Simplified coarse = simplified(scene.surface->mesh(), options.faces);
  check_cancelled(progress, "The export was interrupted; nothing was written.");
  progress.report({"unwrap", 0.1, -1, ""});
  const Atlas atlas = unwrap(coarse.mesh, options.texture);
  check_cancelled(progress, "The export was interrupted; nothing was written.");
  MadeAsset out;
  out.asset.name = name;
  out.asset.mesh = textured_mesh(coarse.mesh, atlas);
  std::vector<uint32_t> vertex;
  for (const uint32_t v : atlas.vertex) vertex.push_back(coarse.vertex[v]);
  out.asset.parts = by_part(scene, vertex, out.asset.mesh, name);
  out.textures = bake(device, scene, out.asset.mesh, {options.texture, reach_of(coarse.error)}, progress);
  to_capture_frame(out.asset.mesh, scene.normalization);
  out.asset.placement = placement_of(out.asset.mesh.positions, scene.up, options.placement);
  progress.report({"pictures", 0.9, -1, ""});
  out.asset.pictures = encode(out.textures, options.pictures);
  out.report = {.vertices = out.asset.mesh.positions.size(),
                .triangles = out.asset.mesh.triangles.size(),
                .charts = atlas.charts,
                .atlas = quality_of(coarse.mesh, atlas, options.texture),
                .error = double(coarse.error) / scene.normalization.scale};
  return out;
}

}  // namespace cei3d

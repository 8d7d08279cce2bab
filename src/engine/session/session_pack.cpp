// SPDX-License-Identifier: Apache-2.0
// The object as the page draws it.
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "engine/project/project.h"
#include "engine/render/render_cache.h"
#include "engine/session/edit_plan.h"
#include "engine/session/light_choice.h"
#include "engine/session/session.h"
#include "engine/session/version.h"
#include "engine/session/vertex_look.h"
#include "engine/view/view_light.h"
#include "engine/view/view_mesh.h"
#include "model/scene/aspects.h"

namespace cei3d {
namespace {

std::string key_of(const SgMixture& light) {
  const std::vector<float> numbers = to_array(light);
  return content_hash({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)});
}

}  // namespace

const Appearance& Session::look_of_vertices(const Scene& scene) {
  const std::vector<Hit> hits = vertex_hits(scene.surface->mesh());
  Appearance look = vertex_look_
                        ? appearance_after(*device_, scene, hits, vertex_look_->key, vertex_look_->look)
                        : appearance_at(*device_, scene, hits);
  vertex_look_ = std::make_unique<VertexLook>(VertexLook{AppearanceKey(scene), std::move(look)});
  return vertex_look_->look;
}

std::string Session::view_pack(const std::string& kind, const EditPreview* on_top) {
  return threads_->run([&]() -> std::string {
    if (kind == "tables") return view_tables();
    if (kind == "sun") return view_sun(kSunSharpness);
    const Scene scene = on_top ? on_top->scene() : project().scene();
    if (kind == "light") return view_light(*device_, scene.light);
    const ViewMesh mesh = view_mesh(scene);
    if (kind == "shape") return view_shape(scene, mesh);
    if (kind == "coarse") return view_coarse(scene, mesh);
    if (kind == "look") return view_look(scene, mesh, look_of_vertices(scene));
    if (kind == "vertex_light") {
      const SceneLight light = on_top ? frames_->light(scene) : frames_->light_to_keep(scene);
      return view_vertex_light(light.vertices(), mesh);
    }
    fail_usage("There is no pack '{}'.", kind);
  });
}

Json Session::view_keys() const {
  return threads_->run([&]() -> Json {
    const Scene scene = project().scene();
    std::string shape = kVersion + project().base_key(), look;
    for (const EditLayer& layer : scene.layers) {
      const Aspects changes = changed_by(layer);
      if (changes.shape) shape += layer.content;
      if (changes.look || changes.parts) look += layer.content;
    }
    shape = content_hash(shape);
    const std::string light = key_of(scene.light);
    return {{"tables", kVersion},
            {"shape", shape},
            {"coarse", shape},
            {"look", content_hash(shape + look)},
            {"vertex_light", content_hash(shape + light)},
            {"light", kVersion + light}};
  });
}

}  // namespace cei3d

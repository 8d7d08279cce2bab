// SPDX-License-Identifier: Apache-2.0
#include "model/scene/layer.h"

#include <algorithm>

#include "core/base/json_reader.h"
#include "model/geometry/shape/vec_json.h"
#include "model/scene/stored.h"

namespace cei3d {
namespace {

Json tint_json(const Tint& t) {
  Json j = {{"color", vector_json(t.color)}, {"keep_texture", t.keep_texture}, {"mean", vector_json(t.mean)}};
  if (t.blend != 1) j["blend"] = t.blend;
  return j;
}

Tint tint_from(JsonReader reader) {
  const Tint tint{to_float(vector_from(reader, "color")), reader.require<bool>("keep_texture"),
                  to_float(vector_from(reader, "mean")), reader.optional("blend", 1.0f)};
  reader.finish();
  return tint;
}

Json change_json(const MaterialChange& c) {
  Json j = Json::object();
  if (c.roughness) j["roughness"] = *c.roughness;
  if (c.specular) j["specular"] = *c.specular;
  if (c.metalness) j["metalness"] = *c.metalness;
  if (c.roughness_scale) j["roughness_scale"] = *c.roughness_scale;
  if (c.blend != 1) j["blend"] = c.blend;
  return j;
}

MaterialChange change_from(JsonReader reader) {
  const MaterialChange change{reader.optional<float>("roughness"), reader.optional<float>("specular"),
                              reader.optional<float>("metalness"), reader.optional<float>("roughness_scale"),
                              reader.optional("blend", 1.0f)};
  reader.finish();
  return change;
}

// Regions use the same tensor names, so each gets a prefix of its own.
Json save_further(const std::vector<Region>& regions, Tensors& tensors) {
  Json heads = Json::array();
  for (const Region& region : regions) {
    Tensors own;
    Json head;
    region.save(own, head);
    const std::string prefix = fmt::format("also/{}/", heads.size());
    for (auto& [name, tensor] : own) tensors[prefix + name] = std::move(tensor);
    heads.push_back(std::move(head));
  }
  return heads;
}

std::vector<Region> load_further(const Tensors& tensors, const Json& heads, const std::string& what) {
  std::vector<Region> regions;
  for (const Json& head : heads) {
    const std::string prefix = fmt::format("also/{}/", regions.size());
    Tensors own;
    for (const auto& [name, tensor] : tensors)
      if (name.starts_with(prefix)) own[name.substr(prefix.size())] = tensor;
    regions.push_back(Region::load(own, head, "A region in 'also' of " + what));
  }
  return regions;
}

}  // namespace

LayerWeights::LayerWeights(const EditLayer& layer) : everywhere_(layer.everywhere) {
  regions_.emplace_back(layer.region);
  for (const Region& r : layer.also) regions_.emplace_back(r);
}

float LayerWeights::at(Vec3f position, Vec3f normal) {
  if (everywhere_) return 1;
  float w = 0;
  for (Region::Weights& r : regions_)
    if (w < 1) w = max(w, r.at(position, normal));
  return w;
}

float EditLayer::weight(Vec3f position, Vec3f normal) const {
  return LayerWeights(*this).at(position, normal);
}

bool EditLayer::may_meet(const AxisBox& box) const {
  return everywhere || region.may_meet(box) ||
         std::any_of(also.begin(), also.end(), [&](const Region& r) { return r.may_meet(box); });
}

// Members with their default value are not written, so that edits of the first format, which knew only region
// and albedo, are stored as before.
void save_layer(const EditLayer& layer, Tensors& tensors, Json& head) {
  head["id"] = layer.id;
  if (layer.everywhere)
    head["everywhere"] = true;
  else
    layer.region.save(tensors, head["region"]);
  if (!layer.also.empty()) head["also"] = save_further(layer.also, tensors);
  if (layer.shape_version != kLatestVersion) head["pose"] = layer.shape_version;
  if (!layer.part.empty()) head["part"] = layer.part;
  save_field(layer.albedo.share(), "albedo", tensors, head);
  if (layer.unlit) head["unlit"] = true;
  if (layer.erase) head["erase"] = true;
  if (layer.erase_material) head["erase_material"] = true;
  if (layer.tint) head["tint"] = tint_json(*layer.tint);
  if (!layer.material.empty()) head["material"] = change_json(layer.material);
  if (layer.light) save_light(*layer.light, tensors, head);
  if (layer.reshape) save_reshape(*layer.reshape, tensors, head["reshape"]);
  save_field(layer.sdf, "sdf", tensors, head);
}

EditLayer load_layer(const Tensors& tensors, const Json& head, const std::string& what) {
  return checked_load("edit", [&] {
    JsonReader reader(head, what);
    EditLayer layer;
    layer.id = reader.require<std::string>("id");
    layer.everywhere = reader.optional("everywhere", false);
    if (!layer.everywhere)
      layer.region = Region::load(tensors, reader.member("region"), "'region' of " + what);
    if (reader.has("also")) layer.also = load_further(tensors, reader.array("also"), what);
    layer.shape_version = reader.optional("pose", kLatestVersion);
    layer.part = reader.optional<std::string>("part", "");
    layer.albedo = load_field("albedo", tensors, reader);
    layer.unlit = reader.optional("unlit", false);
    layer.erase = reader.optional("erase", false);
    layer.erase_material = reader.optional("erase_material", false);
    if (reader.has("tint")) layer.tint = tint_from(reader.object("tint"));
    if (reader.has("material")) layer.material = change_from(reader.object("material"));
    if (reader.has("light")) layer.light = load_light(tensors, reader.object("light"));
    if (reader.has("reshape"))
      layer.reshape = std::make_shared<const Reshape>(
          load_reshape(tensors, reader.member("reshape"), "'reshape' of " + what));
    layer.sdf = load_field("sdf", tensors, reader);
    reader.finish();
    return layer;
  });
}

EditLayer shelved(EditLayer layer, const std::shared_ptr<Shelf>& shelf, const std::string& name,
                  std::function<EditLayer()> read) {
  constexpr size_t kSmallField = 4096;  // bytes; paint of one color has some hundreds
  const auto shared = std::make_shared<const std::function<EditLayer()>>(std::move(read));
  layer.region = layer.region.shelved(shelf, name, [shared] { return (*shared)().region; });
  for (size_t i = 0; i < layer.also.size(); ++i)
    layer.also[i] = layer.also[i].shelved(shelf, name, [shared, i] { return (*shared)().also.at(i); });
  const std::shared_ptr<const Field> albedo = layer.albedo.share();
  if (!albedo) return layer;
  size_t bytes = sizeof(Field);
  for (const Param& p : albedo->params().all()) bytes += p.value.size() * sizeof(float);
  if (bytes <= kSmallField) return layer;
  layer.albedo = Shelved<Field>(shelf, name, bytes, albedo, [shared] { return (*shared)().albedo.share(); });
  return layer;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "model/scene/stored.h"

#include <cstring>

#include "core/base/bytes.h"
#include "core/base/json.h"
#include "model/geometry/shape/vec_tensors.h"

namespace cei3d {

static_assert(sizeof(SgLobe) == 7 * sizeof(float));

void save_field(const std::shared_ptr<const Field>& field, const std::string& name, Tensors& tensors,
                Json& head) {
  if (!field) return;
  head[name] = to_json(field->config());
  field->params().save(tensors, name);
}

std::shared_ptr<const Field> load_field(const std::string& name, const Tensors& tensors, JsonReader& head) {
  if (!head.has(name.c_str())) return nullptr;
  const std::string what = fmt::format("'{}' of {}", name, head.what());
  auto field = std::make_shared<Field>(field_config_from_json(head.member(name.c_str()), what), 0);
  field->params().load(tensors, name);
  return field;
}

Tensor tensor_of(const SgMixture& light) {
  Tensor t{{int64_t(light.lobes.size()), 7}, std::vector<float>(7 * light.lobes.size()), {}};
  if (!light.lobes.empty()) std::memcpy(t.f32.data(), light.lobes.data(), t.f32.size() * sizeof(float));
  return t;
}

SgMixture light_from(const Tensors& tensors, const std::string& name, int64_t lobes) {
  SgMixture light;
  light.lobes.resize(size_t(lobes));
  const Tensor& t = require_tensor(tensors, name, {lobes, 7});
  if (!light.lobes.empty()) std::memcpy(light.lobes.data(), t.f32.data(), t.f32.size() * sizeof(float));
  return light;
}

void save_light(const SgMixture& light, Tensors& tensors, Json& head) {
  head["light"] = {{"lobes", light.lobes.size()}};
  tensors["light"] = tensor_of(light);
}

SgMixture load_light(const Tensors& tensors, JsonReader head) {
  const int64_t lobes = rows_from(head.member("lobes"));
  head.finish();
  return light_from(tensors, "light", lobes);
}

}  // namespace cei3d

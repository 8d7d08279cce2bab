// SPDX-License-Identifier: Apache-2.0
// Storage that scenes and edits share: fields and lights as tensors with a JSON head.
#pragma once

#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/base/json_reader.h"
#include "core/base/tensors.h"
#include "model/field/field.h"
#include "model/light/sg_mixture.h"

namespace cei3d {

// Writes head[name] and tensors "name/..."; nothing for a null field. load_field() returns null when there is
// nothing.
void save_field(const std::shared_ptr<const Field>&, const std::string& name, Tensors& tensors, Json& head);
std::shared_ptr<const Field> load_field(const std::string& name, const Tensors& tensors, JsonReader& head);

Tensor tensor_of(const SgMixture&);
SgMixture light_from(const Tensors&, const std::string& name, int64_t lobes);

// head["light"] and tensor "light".
void save_light(const SgMixture&, Tensors& tensors, Json& head);
SgMixture load_light(const Tensors& tensors, JsonReader light_head);

// Runs load(); a missing or wrong JSON key becomes an error that says the description is damaged.
template <class F>
auto checked_load(const char* what, F load) {
  try {
    return load();
  } catch (const Json::exception& e) {
    fail("The description of the {} is damaged ({}). Restore the project from a copy, or make it again.",
         what, e.what());
  }
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "model/scene/aspects.h"

#include "core/base/error.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

struct Name {
  const char* name;
  bool Aspects::*member;
};
constexpr Name kNames[] = {{"shape", &Aspects::shape},
                           {"look", &Aspects::look},
                           {"light", &Aspects::light},
                           {"parts", &Aspects::parts}};

}  // namespace

Aspects changed_by(const EditLayer& l) {
  return {.shape = bool(l.reshape),
          .look = l.albedo || l.erase || l.erase_material || l.tint || !l.material.empty(),
          .light = l.light.has_value(),
          .parts = !l.part.empty()};
}

bool meet(Aspects a, Aspects b) {
  for (const Name& n : kNames)
    if (a.*n.member && b.*n.member) return true;
  return false;
}

Json to_json(Aspects a) {
  Json list = Json::array();
  for (const Name& n : kNames)
    if (a.*n.member) list.push_back(Json(std::string(n.name)));
  return list;
}

Aspects aspects_from_json(const Json& list) {
  Aspects a;
  for (const Json& j : list) {
    bool known = false;
    for (const Name& n : kNames)
      if (j.get<std::string>() == n.name) a.*n.member = known = true;
    if (!known) fail("{} is not what an edit can change. Update cei3d.", j.dump());
  }
  return a;
}

}  // namespace cei3d

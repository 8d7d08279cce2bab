// SPDX-License-Identifier: Apache-2.0
// What of a scene an edit changes, and what of the scene below it its result depends on: an edit has to be
// made anew when, and only when, an edit before it that changes what it depends on has come or gone.
#pragma once

#include "core/base/json.h"
#include "model/scene/layer.h"

namespace cei3d {

struct Aspects {
  bool shape = false;  // the surface
  bool look = false;   // base color or material
  bool light = false;
  bool parts = false;  // what names of parts mean
  bool operator==(const Aspects&) const = default;
};

Aspects changed_by(const EditLayer&);
bool meet(Aspects, Aspects);  // have one in common

// A list of names: ["shape", "parts"]. Error: an unknown one.
Json to_json(Aspects);
Aspects aspects_from_json(const Json&);

}  // namespace cei3d

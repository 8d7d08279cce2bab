// SPDX-License-Identifier: Apache-2.0
// Aspects of a scene that an edit reads and writes: its dependency mask. An edit is remade when, and only
// when, an edit before it that changes an aspect it reads has appeared or disappeared.
#pragma once

#include "core/base/json_fwd.h"
#include "model/scene/layer.h"

namespace cei3d {

struct Aspects {
  bool shape = false;  // surface
  bool look = false;   // albedo or material
  bool light = false;
  bool parts = false;  // meaning of part names
  bool operator==(const Aspects&) const = default;
};

Aspects changed_by(const EditLayer&);
bool meet(Aspects, Aspects);  // whether the two have an aspect in common

// A list of names: ["shape", "parts"]. Error: an unknown one.
Json to_json(Aspects);
Aspects aspects_from_json(const Json&);

}  // namespace cei3d

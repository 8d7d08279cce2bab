// SPDX-License-Identifier: Apache-2.0
// An edit before it is made, and before it is stored.
#pragma once

#include "core/base/json.h"
#include "engine/project/project.h"
#include "engine/session/edit_ops.h"

namespace cei3d {

// What a command becomes: kind of edit, stored parameters and input files.
struct EditPlan {
  std::string op;
  Json params;
  EditInputs inputs;
};

// An edit that is made and not stored: it is shown, then committed or dropped.
struct EditPreview {
  EditRecord record;
  EditLayer layer;
  Scene below;  // the scene that it was made on
  Stack stack;  // the history that it was made for
  Project::Place place = Project::Place::on_top;
  double load_seconds = 0;

  Scene scene() const { return with_layer(below, layer); }
};

}  // namespace cei3d

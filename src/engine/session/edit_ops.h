// SPDX-License-Identifier: Apache-2.0
// The edits as functions of what is stored of them: their parameters and input files. So each can be made
// anew when what lies below it has changed, and on another reconstruction of the same capture.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/json_reader.h"
#include "core/base/progress.h"
#include "core/compute/device.h"
#include "model/scene/aspects.h"
#include "model/scene/scene.h"

namespace cei3d {

class RenderCache;
struct EditRecord;
using EditInputs = std::vector<std::pair<std::string, std::string>>;  // file name, bytes

struct EditContext {
  const Device& device;
  const Capture& capture;
  const Scene& scene;  // what lies below the edit
  RenderCache& frames;
  Progress& progress;
};

struct EditJob {
  std::string id;  // of the new layer
  Json params;     // of the operation's present version, as they are stored: lengths and positions in the
                   // capture's frame
  EditInputs inputs;

  const std::string& input(const std::string& name) const;  // error when there is none
  JsonReader reader() const { return {params, "Edit " + id}; }
};

struct EditOutcome {
  EditLayer layer;
  Json report;  // what came of it; "seconds": by stage
};

struct EditOp {
  const char* name;
  int version;  // of the operation: raised when its parameters or its results change
  EditOutcome (*make)(const EditContext&,
                      const EditJob&);     // does not change the scene; unknown parameters are errors
  Aspects (*depends)(const Json& params);  // of the scene below, beside the base
  Json (*migrate)(Json params,
                  int version) = nullptr;  // parameters of an older version; null: they are the same
};
// Error: an operation that this program does not know.
const EditOp& edit_op(const std::string& name);
// The parameters of a stored edit as the operation's present version has them. Error: a newer version made
// the edit.
Json present_params(const EditOp&, const EditRecord&);

// The operations; each is in the file edit_*.cpp of its kind.
extern const EditOp kPaintOp, kMaterialOp, kLightOp, kDeformOp, kRemoveOp, kPartOp;

}  // namespace cei3d

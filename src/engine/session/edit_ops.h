// SPDX-License-Identifier: Apache-2.0
// Each kind of edit as a function of its stored parameters and input files, so that an edit can be remade
// when the scene below it has changed, and on another reconstruction of the same capture.
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
class SamMemory;
struct EditRecord;
using EditInputs = std::vector<std::pair<std::string, std::string>>;  // file name, bytes

struct EditContext {
  const Device& device;
  const Capture& capture;
  const Scene& scene;  // the scene below the edit
  RenderCache& frames;
  SamMemory& sam;
  Progress& progress;
};

struct EditJob {
  std::string id;  // of the new layer
  Json params;  // as stored, in the operation's present version; lengths and positions in the capture frame
  EditInputs inputs;

  const std::string& input(const std::string& name) const;  // error when there is none
  JsonReader reader() const { return {params, "Edit " + id}; }
};

struct EditOutcome {
  EditLayer layer;
  Json report;  // of the result; "seconds": by stage
};

struct EditOp {
  const char* name;
  int version;  // of the operation: raised when its parameters or its results change
  // Makes the layer; does not change the scene. Error: an unknown parameter.
  EditOutcome (*make)(const EditContext&, const EditJob&);
  // Aspects of the scene below that the result depends on, besides the base.
  Aspects (*depends)(const Json& params);
  // Converts parameters of an older version; null: they are the same.
  Json (*migrate)(Json params, int version) = nullptr;
};
// Error: an operation that this program does not know.
const EditOp& edit_op(const std::string& name);
// The parameters of a stored edit, converted to the operation's present version. Error: a newer version made
// the edit.
Json present_params(const EditOp&, const EditRecord&);

// The operations; each is in the file edit_*.cpp of its kind.
extern const EditOp kPaintOp, kMaterialOp, kLightOp, kDeformOp, kRemoveOp, kPartOp;

}  // namespace cei3d

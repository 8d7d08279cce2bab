// SPDX-License-Identifier: Apache-2.0
// The objects of an evaluation, in OUT/objects: reconstructed, resumed or copied there.
#pragma once

#include <string>

#include "core/base/json.h"
#include "engine/evaluate/evaluation.h"
#include "engine/evaluate/kept_values.h"

namespace cei3d {

std::string full_path(const std::filesystem::path&);  // "" for none

struct EvaluationObject {
  std::string name;  // of its folder
  ReconstructOptions options;
  bool given = false;  // a copy of the request's project
};

class EvaluationObjects {
 public:
  // Errors: no such capture, view or finished object, an object of another capture, OUT is a project.
  EvaluationObjects(Session&, const EvaluationRequest&);

  const Capture& capture() const { return loaded_; }
  int training_views() const { return training_views_; }
  EvaluationObject whole() const;                          // from all photographs
  EvaluationObject with(const ReconstructOptions&) const;  // objects with equal options are one
  Json settings(const EvaluationObject&) const;            // everything the object depends on
  // Opens the object in the session, without edits; reconstructs it if needed. Returns the seconds of its
  // reconstruction, 0 if it was given.
  double open(const EvaluationObject&, Progress&);

 private:
  Json describe_given(const Capture&);
  double make(const EvaluationObject&, const std::filesystem::path& folder, Progress&);

  Session& session_;
  const EvaluationRequest& r_;
  KeptValues kept_;
  Capture loaded_;
  std::string capture_, fingerprint_;
  int training_views_ = 0;
  Json given_;
};

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// An object of a catalog: what to make of which capture.
#pragma once

#include <string>
#include <vector>

#include "core/base/json_reader.h"
#include "engine/capture/capture.h"
#include "engine/reconstruct/reconstruct.h"

namespace cei3d {

// The object with edits on top, in the order in which they are made. An edit is {"edit": OP, ...} with the
// parameters that `log --json` shows, or {"edit": "replay", "project": FOLDER}: the history of another
// object.
struct BatchVariant {
  std::string name;
  Json edits;  // an array
};

// What stays when an item is done. all: everything. project: without the projects of variants, which can be
// made again in seconds. exports: without any project.
enum class BatchKeep { all, project, exports };

struct BatchItem {
  std::string id;  // 1 to 100 of A-Z a-z 0-9 . _ -, not starting with a dot
  std::filesystem::path capture;
  CaptureOptions capture_options;
  ReconstructOptions options;
  std::vector<std::string> steps;    // of batch_step_names()
  std::vector<std::string> exports;  // suffixes without a dot: "glb"
  std::string purpose;               // of exports: "", "web", "ar" or "dcc"
  double unit_scale = 1;             // meters per capture unit
  int frames = 24;                   // of a turntable
  std::vector<BatchVariant> variants;
  BatchKeep keep = BatchKeep::project;
  double stub_seconds = 0;
  bool planned = false;  // `plan` has seen the capture
  Json tags;             // of the user, an object; copied into the index

  // Everything that the result depends on besides the capture, as JSON.
  Json reconstruction, capture_reading, asset;
};

// "check", "reconstruct", "figures", "export", "turntable", "stub". stub writes a small file, to try a
// launcher.
const std::vector<std::string>& batch_step_names();

bool is_batch_id(const std::string&);

// The keys of `line` take the place of those of `defaults`; "options" are joined key by key.
Json with_defaults(const Json& defaults, const Json& line);

// A line of a manifest after with_defaults(). what: it is, in errors. Errors: an unknown key, a value of the
// wrong type or out of range, no capture where a step needs one.
BatchItem batch_item_from(const Json&, const std::string& what);

}  // namespace cei3d

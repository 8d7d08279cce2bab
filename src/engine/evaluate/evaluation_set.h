// SPDX-License-Identifier: Apache-2.0
// The paper's evaluation of several captures: each one's own report, and one page with the tables of all and
// their means.
#pragma once

#include "core/base/json.h"
#include "engine/evaluate/evaluation.h"

namespace cei3d {

struct EvaluationSetRequest {
  std::vector<std::filesystem::path> captures;
  // What is asked of each capture; `capture`, `out` and the edits (the capture's own, or made ones) are
  // filled in.
  EvaluationRequest each;
  int seeds = 1;        // objects of each capture, of seeds options.seed, options.seed + 1, ...
  bool boards = false;  // also write_boards()
};

struct EvaluatedCapture {
  std::string name;                       // of its folder in `out`
  std::string failed;                     // why there is no report; empty: there is
  std::vector<EvaluationReport> reports;  // one a seed
};

struct EvaluationSetReport {
  std::vector<EvaluatedCapture> captures;
  Json json() const;
  std::string markdown() const;
};

// Writes OUT/report.md, report.json, and OUT/NAME for each capture, with seed-N below it for each seed. A
// capture that fails is reported and left out of the means. Errors: as evaluate_capture(), but for those.
EvaluationSetReport evaluate_captures(Session&, const EvaluationSetRequest&, Progress&);

// Boards for a user study: for each capture up to five views of the painted object, the results of the
// methods side by side in an order that differs from view to view. OUT/boards/NAME-VIEW.png; key.json says
// which is which. The order is a function of the names.
void write_boards(const EvaluationSetReport&, const std::filesystem::path& out);

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// The edited branch of the albedo: a small field of its own for the surface that an edit colors. [paper sec.
// 4.2, F_ae]
#pragma once

#include <memory>
#include <vector>

#include "core/base/progress.h"
#include "core/base/settings.h"
#include "core/compute/device.h"
#include "model/field/field.h"

namespace cei3d {

// Points of the surface and the albedo that they get.
struct BranchSamples {
  std::vector<Vec3f> positions;    // unit frame
  std::vector<Vec3f> targets;      // #positions, linear
  float pixel = 0;                 // the finest detail of the targets, unit frame
  const Field* trained = nullptr;  // albedo of the unedited surface, F_at, for BranchStart::trained
};

enum class BranchLoss { cross_entropy, l1 };  // l1: [paper eq. 17]
// A small network over a hash grid, or a copy of the trained albedo network, as the paper has it.
enum class BranchStart { small, trained };

struct BranchOptions {
  int steps = 400, batch = 2048;
  int levels = 8, hidden_layers = 1, width = 32;
  float table_rate = 2e-2f, layer_rate = 1e-2f;  // Adam rates
  bool decay = true;                             // they fall along half a cosine; else they are constant
  BranchStart start = BranchStart::small;        // trained: levels, layers and width are not read
  BranchLoss loss = BranchLoss::cross_entropy;
};
const SettingTable<BranchOptions>& branch_settings();

// Error: cancelled.
std::shared_ptr<const Field> fit_branch(const Device&, const BranchSamples&, const BranchOptions&,
                                        uint64_t seed, Progress&);

// Gradient of the mean absolute difference of three outputs from the target. [paper eq. 17]
FieldTrainer::Loss absolute_difference(const std::vector<Vec3f>& target);

// The same color everywhere, exactly. color: linear.
std::shared_ptr<const Field> uniform_branch(Vec3f color);

}  // namespace cei3d

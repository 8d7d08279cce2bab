// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/run_state.h"

#include <gtest/gtest.h>

#include "core/base/json.h"

namespace cei3d {
namespace {

TEST(RunState, ColorsAreDividedByExposureAndBrightness) {
  RunState state;
  EXPECT_TRUE(exposures_of(state).empty());
  state.brightness = {1.5f, 0.5f};
  EXPECT_EQ(exposures_of(state).at(0).y, 1.5f);
  state.scene.exposures = {{"a", {2, 1, 1}}, {"b", {1, 1, 4}}};
  const std::vector<Vec3f> both = exposures_of(state);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].x, 3);
  EXPECT_EQ(both[1].z, 2);
  state.brightness.clear();
  EXPECT_EQ(exposures_of(state).at(1).z, 4);
}

TEST(RunState, KeepsTheBrightnessInItsCheckpoint) {
  RunState state;
  state.brightness = {1.1f, 0.9f, 1.0f / 3};
  Tensors tensors;
  Json head;
  save_state(state, tensors, head);
  EXPECT_EQ(load_state(tensors, head, {}).brightness, state.brightness);
}

}  // namespace
}  // namespace cei3d

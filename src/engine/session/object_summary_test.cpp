// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/session/requests.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string warning_of(double physical, double with_residual) {
  ObjectSummary object;
  object.explained = Explained{physical, with_residual};
  return object.warning();
}

TEST(ObjectSummary, SaysWhereLightAndMaterialExplainMuchLessThanTheResidual) {
  EXPECT_THAT(ObjectSummary().warning(), IsEmpty());
  EXPECT_THAT(warning_of(34.0, 34.5), IsEmpty());
  EXPECT_THAT(warning_of(27.0, 30.0), HasSubstr("27.0 dB, with the correction 30.0 dB"));
}

TEST(ObjectSummary, SaysWhereNothingExplainsThePhotographs) {
  EXPECT_THAT(warning_of(18.8, 19.2), HasSubstr("to 19.2 dB only"));
}

TEST(ObjectSummary, SaysWhetherTheStrengthOfTheLightIsKnownOrAssumed) {
  ObjectSummary object;
  EXPECT_THAT(object.light_text(), HasSubstr("assumed"));
  object.light_error = Vec3f{0.02f, 0.05f, 0.03f};
  EXPECT_THAT(object.light_text(), HasSubstr("known to 5 %"));
}

}  // namespace
}  // namespace cei3d

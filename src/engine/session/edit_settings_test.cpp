// SPDX-License-Identifier: Apache-2.0
// Numbers and choices of edits, on a project that holds a sphere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error_of.h"
#include "core/base/json.h"
#include "engine/session/test_edits.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

class EditSettings : public EditTest {
 protected:
  static constexpr Vec3d kFrom{kSphereRadius, 0, 0}, kTo{0.85, 0, 0.1};

  static DeformCommand drag(std::vector<std::string> set) {
    DeformCommand c{PointDrag{kFrom, kTo}, 0.35, ""};
    c.set = std::move(set);
    return c;
  }
  std::string refusal(const DeformCommand& c) {
    const Error e = error_of([&] { session_.deform(c, quiet_); });
    EXPECT_EQ(e.code(), ErrorCode::usage) << e.what();
    return e.what();
  }
};

TEST_F(EditSettings, OfADragAreStoredAndDoWhatTheySay) {
  session_.deform(drag({"handle_share=0.5", "iterations=3"}), quiet_);
  const LogEntry stored = session_.log().back();
  EXPECT_EQ(stored.params.at("set"), Json({{"handle_share", 0.5}, {"iterations", 3}}));
  EXPECT_LE(stored.report.at("iterations").get<int>(), 3);
  // Surface within half the radius, measured on the sphere, moves with the handle, and some beyond it less.
  const std::vector<Vec3f> before = sphere_scene().surface->mesh().positions;
  const Reshape change = *scene("a").layers.back().reshape;
  size_t near = 0, less = 0;
  for (size_t i = 0; i < change.moved.size(); ++i) {
    const Vec3f p = before[change.moved[i]];
    const float off = length(change.positions[i] - p - to_float(kTo - kFrom));
    const float distance = kSphereRadius * std::acos(clamp(p.x / kSphereRadius, -1.0f, 1.0f));
    if (distance < 0.15f) {
      ++near;
      EXPECT_LT(off, 1e-5f);
    }
    less += off > 0.01f;
  }
  EXPECT_GT(near, 40u);
  EXPECT_GT(less, 40u);
}

TEST_F(EditSettings, WrongOnesChangeNothing) {
  EXPECT_THAT(refusal(drag({"handle_shore=0.2"})), HasSubstr("'handle_share'"));
  EXPECT_THAT(refusal(drag({"handle_share=2"})), HasSubstr("0.01 to 0.9"));
  EXPECT_THAT(refusal(drag({"refit.step=9"})), HasSubstr("'refit.steps'"));
  EXPECT_THAT(refusal(drag({"refit.steps=9"})), HasSubstr("geometry field"));
  EXPECT_TRUE(session_.log().empty());
}

TEST_F(EditSettings, StoredOnesAreCheckedToo) {
  const Json params = {{"from", {kFrom.x, 0, 0}}, {"to", {kTo.x, 0, kTo.z}}, {"radius", 0.35}};
  Json wrong = params;
  wrong["set"] = {{"handle_share", "wide"}};
  EXPECT_THAT(error_of([&] { session_.edit_by_params("deform", wrong, quiet_); }).what(),
              HasSubstr("handle_share"));
  EXPECT_TRUE(session_.log().empty());
  session_.edit_by_params("deform", params, quiet_);
  EXPECT_EQ(session_.log().size(), 1u);
}

TEST(SettingsOfEdits, AreThoseOfTheirOptions) {
  for (const char* edit : {"paint", "part", "deform"}) {
    const Json j = settings_of_edit(edit).json();
    EXPECT_EQ(j.at("edit"), edit);
    EXPECT_GE(j.at("settings").size(), 5u) << edit;
    for (const Json& s : j.at("settings")) EXPECT_FALSE(s.at("value").is_null()) << s.dump();
  }
}

}  // namespace
}  // namespace cei3d

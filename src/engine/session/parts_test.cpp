// SPDX-License-Identifier: Apache-2.0
// Parts by commands, on a project that holds a sphere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error_of.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/io/image_file.h"
#include "engine/project/project.h"
#include "engine/render/sphere_scene.h"
#include "engine/session/session.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kSize = 64;

class PartsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    View v;
    v.name = "train/r_0";
    v.camera = camera_towards_origin({0, -3, 0.3}, kSize);
    Capture c;
    c.root = "/nowhere";
    c.format = "nerf-synthetic";
    c.views = {v};
    Project::create(folder(), {}, c, false).save_base(sphere_with_handlers());
    session_.open(folder(), Session::Access::write);
  }
  fs::path folder() const { return temp_.path() / "object"; }

  // The columns from x0 to x1 of the view.
  PartCommand columns(int x0, int x1) {
    Image mask(kSize, kSize, 1);
    for (int y = 0; y < kSize; ++y)
      for (int x = x0; x < x1; ++x) *mask.at(x, y) = 1;
    const fs::path file = temp_.path() / "mask.png";
    write_png(file, mask);
    PartCommand c;
    c.view = "r_0";
    c.mask = file;
    return c;
  }
  Image mask_of(const std::string& part) {
    session_.part_masks({temp_.path() / "masks", ProjectViews{}, part, 1}, quiet_);
    return read_image(temp_.path() / "masks" / "r_0.png");
  }

  TempFolder temp_;
  Session session_;
  Progress quiet_;
};

TEST_F(PartsTest, AreNamedListedAndShown) {
  const EditSummary s = session_.select_part(columns(0, 24), quiet_);
  EXPECT_EQ(s.id, "0001-part");
  PartCommand right = columns(40, kSize);
  right.name = "right";
  session_.select_part(right, quiet_);
  session_.select_part(columns(30, 34), quiet_);
  const std::vector<PartInfo> parts = session_.parts();
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].name, "part1");
  EXPECT_EQ(parts[1].name, "part2");
  EXPECT_EQ(parts[2].name, "right");
  EXPECT_EQ(parts[2].edit, "0002-part");
  const Image mask = mask_of("right");
  for (int y = 24; y < 40; ++y)
    for (int x = 20; x < 46; ++x)
      if (std::abs(x - 40) > 1) {
        EXPECT_EQ(*mask.at(x, y), x > 40 ? 1 : 0) << x << ' ' << y;
      }
  session_.undo(quiet_);
  EXPECT_EQ(session_.parts().size(), 2u);
}

TEST_F(PartsTest, ACombinedPartKeepsItsName) {
  session_.select_part(columns(0, 30), quiet_);
  PartCommand c = columns(24, 40);
  c.add = "part1";
  EXPECT_EQ(session_.select_part(c, quiet_).report.at("part"), "part1");
  EXPECT_EQ(session_.parts().size(), 1u);
  EXPECT_EQ(*mask_of("part1").at(36, 32), 1);
  c = columns(16, 60);
  c.subtract = "part1";
  c.name = "rest";
  session_.select_part(c, quiet_);
  EXPECT_EQ(*mask_of("rest").at(20, 32), 0);
  // Without the part it is made from, it cannot be made.
  EXPECT_THAT(error_of([&] { session_.toggle("0001-part", quiet_); }).what(), HasSubstr("0002-part"));
}

TEST_F(PartsTest, APartLikeAnEditedOneIsRemadeWithThatEdit) {
  PartCommand metal = columns(24, 40);
  metal.name = "plate";
  metal.effects.preset = "copper";
  session_.select_part(metal, quiet_);
  PartCommand like;
  like.view = "r_0";
  like.like = {32, 32};
  like.name = "all copper";
  session_.select_part(like, quiet_);
  const Json params = session_.log().back().params;
  EXPECT_EQ(params.at("like"), Json({32.0, 32.0}));
  const Image plate = mask_of("plate"), copper = mask_of("all copper");
  for (int y = 26; y < 38; ++y)
    for (int x = 18; x < 46; ++x)
      if (std::abs(x + 0.5 - 24) > 2 && std::abs(x + 0.5 - 40) > 2) {
        EXPECT_EQ(*copper.at(x, y), *plate.at(x, y)) << x << ' ' << y;
      }
  // Without the copper, the object has one material.
  EXPECT_THAT(error_of([&] { session_.toggle("0001-part", quiet_); }).what(), HasSubstr("one material"));
}

TEST_F(PartsTest, SettingsAreStoredAndWrongOnesRefused) {
  PartCommand metal = columns(24, 40);
  metal.effects.preset = "copper";
  metal.set = {"graph.lightness=1"};
  session_.select_part(metal, quiet_);
  EXPECT_EQ(session_.log().back().params.at("set"), Json({{"graph.lightness", 1.0}}));
  PartCommand like;
  like.view = "r_0";
  like.like = {32, 32};
  const auto refusal = [&](std::vector<std::string> set) {
    like.set = std::move(set);
    return std::string(error_of([&] { session_.select_part(like, quiet_); }).what());
  };
  // Limits that copper and the rest keep make them one material.
  EXPECT_THAT(refusal({"like.roughness=1", "like.metalness=1"}), HasSubstr("one material"));
  EXPECT_THAT(refusal({"like.metal=1"}), HasSubstr("'like.metalness'"));
  EXPECT_THAT(refusal({"like.metalness=0"}), HasSubstr("0.0001 to 1"));
  EXPECT_THAT(refusal({"graph.crease=1"}), HasSubstr("not grown"));
  metal.set = {"like.color=1"};
  EXPECT_THAT(error_of([&] { session_.select_part(metal, quiet_); }).what(), HasSubstr("'like'"));
  EXPECT_EQ(session_.log().size(), 1u);
}

TEST_F(PartsTest, WrongCommandsChangeNothing) {
  const auto code = [&](const PartCommand& c) {
    return error_of([&] { session_.select_part(c, quiet_); }).code();
  };
  PartCommand c;
  c.view = "r_0";
  EXPECT_EQ(code(c), ErrorCode::usage);  // neither clicks nor mask
  c.positive = {{1, 1}};
  EXPECT_EQ(code(c), ErrorCode::failed);  // background
  c.view = "r_7";
  EXPECT_EQ(code(c), ErrorCode::usage);
  c = columns(10, 30);
  c.effects.roughness = 1.5f;
  EXPECT_EQ(code(c), ErrorCode::usage);
  c = columns(10, 30);
  c.like = {32, 32};
  EXPECT_EQ(code(c), ErrorCode::usage);  // a mask, too
  c = columns(10, 30);
  c.like_color = true;
  EXPECT_EQ(code(c), ErrorCode::usage);
  c = {};
  c.view = "r_0";
  c.like = {32, 32};
  EXPECT_THAT(error_of([&] { session_.select_part(c, quiet_); }).what(), HasSubstr("has one material"));
  c.segmenter = "sam";
  EXPECT_EQ(code(c), ErrorCode::usage);  // a network needs prompts
  c = columns(10, 30);
  c.keep_color = true;
  EXPECT_EQ(code(c), ErrorCode::usage);  // of which scribble?
  EXPECT_EQ(error_of([&] { mask_of("ear"); }).code(), ErrorCode::usage);
  EXPECT_TRUE(session_.log().empty());
}

}  // namespace
}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// Scores of a sphere whose photographs are its own renders: what should be perfect is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "core/base/test_source.h"
#include "core/base/test_unknown_keys.h"
#include "core/infer/onnx.h"
#include "core/infer/test_networks.h"
#include "engine/io/image_file.h"
#include "engine/metrics/psnr.h"
#include "engine/project/project.h"
#include "engine/render/sphere_scene.h"
#include "engine/session/session.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kSize = 48;

class EvalTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Capture capture;
    capture.root = temp_.path();
    capture.format = "nerf-synthetic";
    for (const Vec3d center : {Vec3d{0, -3, 0.3}, Vec3d{0.4, -3, -0.3}, Vec3d{0, 3, 0.3}}) {
      View v;
      v.name = fmt::format("train/r_{}", capture.views.size());
      v.camera = camera_towards_origin(center, kSize);
      v.image_path = temp_.path() / "photos/rgb" / fmt::format("r_{}.png", capture.views.size());
      capture.views.push_back(v);
    }
    Project::create(temp_.path() / "object", {}, capture, false).save_base(sphere_with_handlers());
    session_.open(temp_.path() / "object", Session::Access::write);
    render("photos");
  }
  void render(const std::string& folder) {
    RenderRequest r;
    r.out = temp_.path() / folder;
    r.channels = {Channel::rgb};
    session_.render(r, quiet_);
  }
  // Green in a square about the middle of the first view.
  std::string paint() {
    Image s(kSize, kSize, 4);
    for (int y = 18; y < 30; ++y)
      for (int x = 18; x < 30; ++x) s.at(x, y)[1] = s.at(x, y)[3] = 1;
    write_png(temp_.path() / "scribble.png", s);
    PaintCommand command;
    command.strokes = {{"r_0", temp_.path() / "scribble.png"}};
    return session_.paint(command, quiet_).id;
  }
  // All pixels within the rows and columns [begin, end) of every view.
  void write_masks(int begin, int end) {
    Image mask(kSize, kSize, 1);
    for (int y = begin; y < end; ++y)
      for (int x = begin; x < end; ++x) *mask.at(x, y) = 1;
    for (int i = 0; i < 3; ++i) write_png(temp_.path() / "masks" / fmt::format("r_{}.png", i), mask);
  }
  Image picture(const std::string& folder, int view) const {
    return over_background(read_image(temp_.path() / folder / "rgb" / fmt::format("r_{}.png", view)), 1);
  }
  fs::path network(const std::string& name, const std::string& content) {
    write_file_atomic(temp_.path() / name, content);
    return temp_.path() / name;
  }
  TempFolder temp_;
  Session session_{"cpu"};
  Progress quiet_;
};

TEST_F(EvalTest, OwnRendersAreMatchedExactly) {
  const EvalReport r = session_.evaluate({}, quiet_);
  EXPECT_EQ(r.views.size(), 3u);
  EXPECT_TRUE(std::isinf(r.psnr));
  EXPECT_DOUBLE_EQ(*r.flip, 0);
  EXPECT_TRUE(std::isinf(r.psnr_masked));
  EXPECT_DOUBLE_EQ(r.ssim, 1);
  EXPECT_FALSE(r.lpips || r.fid || r.edit);
  EXPECT_EQ(r.markdown().find("LPIPS"), std::string::npos);  // nothing about what was not asked for
  EXPECT_FALSE(r.json().contains("fid"));
}

TEST_F(EvalTest, PaintLeavesTheRestAsItWas) {
  EvalRequest request;
  request.edit = paint();
  const EvalReport r = session_.evaluate(request, quiet_);
  EXPECT_TRUE(std::isinf(r.psnr));  // the views are scored without the edit
  ASSERT_TRUE(r.edit && r.edit->rest);
  EXPECT_FALSE(r.edit->truth);
  EXPECT_TRUE(std::isinf(r.edit->rest->psnr));
  EXPECT_EQ(r.edit->rest->views, 3u);
  EXPECT_LT(r.edit->rest->ssim, 1);  // windows at the border see the paint ...
  EXPECT_GT(r.edit->rest->ssim, 0.9);
  EXPECT_EQ(r.json()["edit"]["non_edited"]["psnr"], "infinite");
}

TEST_F(EvalTest, EditAgainstTruth) {
  EvalRequest request;
  request.edit = paint();
  request.truth = temp_.path() / "after/rgb";
  request.masks = temp_.path() / "masks";
  render("after");
  write_masks(16, 32);
  EditScore score = *session_.evaluate(request, quiet_).edit;
  ASSERT_TRUE(score.truth);
  EXPECT_TRUE(std::isinf(score.truth->psnr_inside));
  EXPECT_EQ(score.truth->pixels_inside, 3u * 16 * 16);
  EXPECT_GT(score.truth->iou, 0.2);  // two views show most of 12 x 12, the third nothing
  EXPECT_LT(score.truth->iou, 2.0 * 13 * 13 / (3 * 16 * 16));
  EXPECT_EQ(score.truth->pixels_outside, 3u * (kSize * kSize - 20 * 20));
  EXPECT_EQ(score.truth->views, 3u);

  // Masks in a corner: now every pixel that the paint changed leaks.
  write_masks(0, 4);
  score = *session_.evaluate(request, quiet_).edit;
  size_t changed = 0;
  for (int v = 0; v < 3; ++v) {
    const Image before = picture("photos", v), after = picture("after", v);
    for (size_t i = 0; i < size_t(kSize * kSize); ++i)
      changed += !std::equal(&before.data[3 * i], &before.data[3 * i] + 3, &after.data[3 * i]);
  }
  EXPECT_EQ(score.truth->changed_outside, changed);
  EXPECT_EQ(score.truth->iou, 0);
  EXPECT_GT(changed, 100u);
  EXPECT_LT(score.rest->ssim, 0.99);
}

TEST_F(EvalTest, AReportIsReadAsItWasWrittenAndShowsItsPictures) {
  EvalRequest request;
  request.edit = paint();
  request.pictures = temp_.path() / "pictures";
  const EvalReport r = session_.evaluate(request, quiet_);
  EXPECT_EQ(eval_report_from_json(Json::parse(r.json().dump())).json(), r.json());
  const auto read = [](const Json& bad) { eval_report_from_json(bad, "row.json"); };
  EXPECT_EQ(objects_with_unknown_keys_read(r.json(), "row.json", read), std::vector<std::string>());
  render("after");
  const Image three = read_image(temp_.path() / "pictures/r_1.png");
  ASSERT_EQ(three.width, 3 * kSize);
  const Image photo = picture("photos", 1), after = picture("after", 1);
  constexpr float kRounding = 0.51f / 255;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      EXPECT_NEAR(three.rgb(x, y).y, photo.rgb(x, y).y, kRounding);
      EXPECT_NEAR(three.rgb(2 * kSize + x, y).y, after.rgb(x, y).y, kRounding);
    }
}

TEST_F(EvalTest, LightIsEverywhereAndLeavesNoRest) {
  EvalRequest request;
  LightChoice brighter;
  brighter.scale = 2;
  request.edit = session_.change_light(brighter, quiet_).id;
  EXPECT_FALSE(session_.evaluate(request, quiet_).edit->rest);
}

TEST_F(EvalTest, SaysWhatIsMissing) {
  EvalRequest request;
  request.edit = "0007-paint";
  EXPECT_THROW(session_.evaluate(request, quiet_), Error);
  request.edit = paint();
  request.truth = request.masks = temp_.path() / "nowhere";
  try {
    session_.evaluate(request, quiet_);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("named like the views"));
  }
}

class EvalNetworks : public EvalTest {
 protected:
  void SetUp() override {
    if (!OnnxRuntime::available(source_file("build/sam")))
      GTEST_SKIP() << "no ONNX Runtime here; ./run sam installs it";
    EvalTest::SetUp();
  }
};

TEST_F(EvalNetworks, FiguresAreThoseOfTheNetworksOnThePictures) {
  EvalRequest request;
  request.networks.lpips = network("lpips.onnx", test_networks::squared_distance());
  request.networks.fid = network("fid.onnx", test_networks::channel_means());
  request.edit = paint();
  render("after");
  const EvalReport r = session_.evaluate(request, quiet_);
  EXPECT_DOUBLE_EQ(*r.lpips, 0);
  EXPECT_NEAR(*r.fid, 0, 1e-9);
  EXPECT_DOUBLE_EQ(*r.edit->rest->lpips, 0);
  EXPECT_GT(*r.edit->fid, 1e-6);
  EXPECT_THAT(r.markdown(), HasSubstr("| LPIPS |"));
}

}  // namespace
}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/synthetic_capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "core/math/color.h"
#include "engine/io/image_file.h"
#include "engine/synthetic/truth_files.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

SynthRequest small_request(const fs::path& out) {
  SynthRequest r;
  r.out = out;
  r.shape = "ball";
  r.width = 24, r.height = 20;
  r.views = 3, r.test_views = 3;
  r.samples = 4;
  return r;
}

SynthReport make(const SynthRequest& r) {
  Progress quiet;
  return make_capture(r, quiet);
}

TEST(SyntheticCapture, HasTheFilesOfTheSceneLayout) {
  const TempFolder temp;
  const fs::path out = temp.path() / "ball";
  const SynthReport report = make(small_request(out));
  EXPECT_EQ(report.relit_views, 4);
  for (const char* file :
       {"transforms_train.json", "transforms_test.json", "meta.json", "mesh_gt.ply", "train/r_002.png",
        "test/r_002.png", "envs/daylight.hdr", "envs/evening.hdr", "envs/studio.hdr", "gt/albedo/r_000.png",
        "gt/normal/r_001.png", "gt/depth/r_001.png", "gt/roughness/r_002.png", "gt/metalness/r_002.png",
        "gt/mask/r_002.png", "edits/relight/evening/r_000.png", "edits/relight/studio/r_002.png"})
    EXPECT_TRUE(fs::exists(out / file)) << file;
  EXPECT_FALSE(fs::exists(out / "edits/relight/studio/r_001.png"));
  EXPECT_EQ(read_image(out / "gt/roughness/r_000.png").channels, 4);
  EXPECT_THAT(message([&] { make(small_request(out)); }), HasSubstr("exists already"));
}

TEST(SyntheticCapture, TheLightFileIsTheLightThatWasUsed) {
  const TempFolder temp;
  SynthRequest r = small_request(temp.path() / "c");
  r.views = 1, r.test_views = 0;
  r.light_tint = {1, 0.5f, 0.25f};
  r.light_strength = 0.5f;
  make(r);
  const Image map = read_image(r.out / "envs/daylight.hdr");
  const SgMixture light = scene_of(r).light;
  const SgMixture plain = scene_of(small_request("x")).light;
  for (const Vec3f w : {Vec3f{0, 0, 1}, normalize(Vec3f{0.6f, -0.4f, 0.7f}), normalize(Vec3f{-1, 1, 0})}) {
    const Vec3f got = env_radiance(map, w), truth = radiance(light, w), untinted = radiance(plain, w);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], truth[c], 0.01 * max(truth.x, truth.y));
    EXPECT_NEAR(truth.x, 0.5f * untinted.x, 1e-5f * untinted.x);
    EXPECT_NEAR(truth.z, 0.125f * untinted.z, 1e-5f * untinted.z);
  }
}

TEST(SyntheticCapture, RegionsAndRoughnessReplaceThoseOfTheSet) {
  SynthRequest r = small_request("x");
  r.shape = "teapot";
  r.material = "enamel";
  r.regions = {{"lid", {{0.4f, 0.3f, 1}, {0.1f, 0.2f, 0.3f}}}};
  const SyntheticScene s = scene_of(r);
  ASSERT_EQ(s.shape.regions[2], "lid");
  EXPECT_EQ(s.finishes[2].material.specular, 0.3f);
  EXPECT_EQ(s.finishes[1].material.metalness, 1);
  r.roughness = 0.8f;
  for (const Finish& f : scene_of(r).finishes) EXPECT_EQ(f.material.roughness, 0.8f);
  r.roughness = 0.01f;
  EXPECT_THAT(message([&] { scene_of(r); }), HasSubstr("roughness 0.01 of body"));
  r.regions = {{"snout", {}}};
  EXPECT_THAT(message([&] { scene_of(r); }), HasSubstr("it has body, band, lid, trim"));
}

TEST(SyntheticCapture, NoiseHasTheDeviationAskedFor) {
  Image gray(200, 200, 4, 0.25f);
  for (size_t i = 3; i < gray.data.size() / 2; i += 4) gray.data[i] = 0;
  const Image noisy = with_noise(gray, 0.02f, 1, 7);
  double sum = 0, squares = 0, n = 0;
  for (size_t i = 0; i < gray.data.size(); i += 4) {
    if (gray.data[i + 3] == 0) {
      EXPECT_EQ(noisy.data[i], 0.25f);
      continue;
    }
    const double d = srgb_from_linear(noisy.data[i]) - srgb_from_linear(0.25f);
    sum += d, squares += d * d, ++n;
  }
  EXPECT_NEAR(sum / n, 0, 0.001);
  EXPECT_NEAR(std::sqrt(squares / n), 0.02, 0.001);
}

class Impatient : public Progress {
  bool is_cancelled() const override { return true; }
};

TEST(SyntheticCapture, CanBeInterrupted) {
  const TempFolder temp;
  Impatient user;
  EXPECT_THAT(message([&] { make_capture(small_request(temp.path() / "c"), user); }),
              HasSubstr("Interrupted"));
}

}  // namespace
}  // namespace cei3d

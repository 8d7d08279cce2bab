// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <functional>
#include <random>

#include "core/base/error_of.h"
#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_format.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/check.h"
#include "engine/capture/test_npz.h"
#include "engine/io/npy.h"
#include "engine/io/zip_file.h"

namespace cei3d {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

void expect_same_projection(const Camera& a, const Camera& b, Vec3d about) {
  for (const Vec3d d : {Vec3d{0, 0, 0}, Vec3d{0.7, 0.3, -0.3}, Vec3d{-0.7, 0.7, 0.6}}) {
    const Vec3d u = a.project(about + d), v = b.project(about + d);
    EXPECT_NEAR(length(u - v), 0, 1e-6);
  }
}

Matrix34 matrix34(const std::vector<double>& m) {
  Matrix34 p;
  for (size_t i = 0; i < 12; ++i) p.m[i / 4][i % 4] = m[i];
  return p;
}

TEST(Idr, ProjectionsComeApart) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto vec = [&] { return Vec3d{normal(random), normal(random), normal(random)}; };
  for (int i = 0; i < 200; ++i) {
    Camera truth = look_at(vec() * 3.0, vec(), {80, 60, 100 + 20 * normal(random)}, vec());
    truth.fy = truth.fx * (1 + 0.1 * normal(random));
    truth.cx += 9 * normal(random);
    truth.skew = 3 * normal(random);
    const double factor = std::exp(3 * normal(random)) * (i % 2 ? -1 : 1);
    Camera c = camera_from_projection(matrix34(world_mat(truth, factor)), "x");
    c.cx += 0.5, c.cy += 0.5;
    const double scale = 1e-7 * length(truth.center) + 1e-7;
    EXPECT_NEAR(c.fx, truth.fx, 1e-6);
    EXPECT_NEAR(c.fy, truth.fy, 1e-6);
    EXPECT_NEAR(c.cx, truth.cx, 1e-6);
    EXPECT_NEAR(c.cy, truth.cy, 1e-6);
    EXPECT_NEAR(c.skew, truth.skew, 1e-6);
    EXPECT_NEAR(length(c.center - truth.center), 0, scale);
    for (int r = 0; r < 3; ++r)
      EXPECT_NEAR(length(c.world_from_cam.row[r] - truth.world_from_cam.row[r]), 0, 1e-8);
  }
}

TEST(Idr, SameBallGivesTheSameCamerasAndPictures) {
  const TempFolder temp;
  const TestBall ball;
  const auto views = test_views(ball, 11);
  write_nerf_split(temp.path() / "nerf", "train", ball, views);
  write_idr(temp.path() / "idr", ball, views);
  const Capture a = load_capture(temp.path() / "nerf"), b = load_capture(temp.path() / "idr");
  EXPECT_EQ(b.format, "idr");
  EXPECT_TRUE(b.warnings.empty());
  ASSERT_EQ(b.views.size(), 11u);
  for (size_t i = 0; i < b.views.size(); ++i) {
    EXPECT_EQ(b.views[i].name, fmt::format("image/{:06}", i));
    EXPECT_EQ(b.views[i].camera.width, 64);
    expect_same_projection(a.views[i].camera, b.views[i].camera, ball.center);
    EXPECT_EQ(load_linear_rgba(a.views[i]).data, load_linear_rgba(b.views[i]).data);
  }
  const CaptureReport report = check(b);
  EXPECT_NEAR(length(report.normalization->center - ball.center), 0, 0.1 * ball.radius);
  EXPECT_EQ(load_capture(temp.path() / "idr" / "cameras_sphere.npz").views.size(), 11u);
  EXPECT_EQ(find_view(b, "000003").name, "image/000003");
}

TEST(Idr, TestEveryHoldsViewsOut) {
  const TempFolder temp;
  const TestBall ball;
  write_idr(temp.path(), ball, test_views(ball, 11));
  const std::vector<View> test = views_of(load_capture(temp.path(), {"", 8}), Split::test);
  ASSERT_EQ(test.size(), 2u);
  EXPECT_EQ(test[1].name, "image/000008");
}

// The world of such a file stands anyhow: what is up comes from the cameras alone, tilted as they are.
TEST(Idr, UpFollowsTheCameras) {
  const TempFolder temp;
  const TestBall ball;
  auto views = test_views(ball, 24);
  const Mat3d turn{{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
  for (TestView& v : views) {
    v.camera.world_from_cam = turn * v.camera.world_from_cam;
    v.camera.center = turn * v.camera.center;
  }
  write_idr(temp.path(), {turn * ball.center, ball.radius}, views);
  EXPECT_GT(dot(load_capture(temp.path()).up, turn * Vec3d{0, 0, 1}), std::cos(0.05));
}

TEST(Idr, FilesAreMatchedByNumberThenByOrder) {
  const TempFolder temp;
  const TestBall ball;
  write_idr(temp.path(), ball, test_views(ball, 4));
  const fs::path images = temp.path() / "image";
  fs::copy(images / "000001.png", images / "000007.png");  // one without a camera
  Capture c = load_capture(temp.path());
  ASSERT_EQ(c.warnings.size(), 1u);
  EXPECT_THAT(c.warnings[0], HasSubstr("1 of 5"));
  EXPECT_EQ(c.views[3].image_path.filename(), "000003.png");
  fs::remove(images / "000007.png");
  fs::remove(images / "000001.png");  // a camera without an image: check() says which
  CaptureOptions strict;
  strict.strict = true;
  c = load_capture(temp.path(), strict);
  EXPECT_EQ(c.views[1].image_path.filename(), "000001.png");
  EXPECT_EQ(c.views[2].image_path.filename(), "000002.png");
  EXPECT_FALSE(check(c).usable());
  fs::copy(images / "000000.png", images / "rect_b.png");  // other names: as sorted
  fs::rename(images / "000000.png", images / "rect_a.png");
  c = load_capture(temp.path());
  EXPECT_EQ(c.views[0].image_path.filename(), "000002.png");
  EXPECT_EQ(c.views[3].image_path.filename(), "rect_b.png");
  fs::remove(images / "rect_b.png");
  EXPECT_THAT(message([&] { load_capture(temp.path()); }), HasSubstr("neither by name nor by number"));
}

TEST(Idr, CamerasOfAnotherPictureSizeAreSuspected) {
  const TempFolder temp;
  const TestBall ball;
  auto views = test_views(ball, 3);
  write_idr(temp.path(), ball, views);
  std::map<std::string, std::string> files;
  for (size_t i = 0; i < 3; ++i) {
    Camera& c = views[i].camera;
    for (double* k : {&c.fx, &c.fy, &c.cx, &c.cy}) *k *= 2;
    files[fmt::format("world_mat_{}.npy", i)] = test_npy(world_mat(c));
  }
  write_file_atomic(temp.path() / "cameras_sphere.npz", test_zip(files));
  const Capture c = load_capture(temp.path());
  ASSERT_EQ(c.warnings.size(), 1u);
  EXPECT_THAT(c.warnings[0], HasSubstr("resized"));
}

TEST(Idr, BadMatricesGetSentences) {
  const TempFolder temp;
  const TestBall ball;
  write_idr(temp.path(), ball, test_views(ball, 2));
  const std::vector<double> good = world_mat(test_views(ball, 2)[0].camera);
  std::vector<double> nan = good, flat = good;
  nan[5] = NAN;
  for (size_t i = 0; i < 4; ++i) flat[i] = 2 * flat[4 + i];
  const std::pair<std::string, const char*> cases[] = {
      {test_npy(nan), "world_mat_1 of"},
      {test_npy(flat), "cannot be inverted"},
      {test_npy(std::vector<double>(16)), "cannot be inverted"},
      {test_npy("<f8", "(2, 8)", std::string(128, '\0')), "4 x 4"},
      {test_npy("<i8", "(4, 4)", std::string(128, '\0')), "float32 nor float64"},
      {test_npy("<f8", "(4, 4)", std::string(100, '\0')), "bytes"},
      {"", "not a usable .npy"},
  };
  for (const auto& [npy, says] : cases) {
    const std::string zip = test_zip({{"world_mat_0.npy", test_npy(good)}, {"world_mat_1.npy", npy}});
    write_file_atomic(temp.path() / "cameras_sphere.npz", zip);
    EXPECT_THAT(message([&] { load_capture(temp.path()); }), HasSubstr(says));
  }
  write_file_atomic(temp.path() / "cameras_sphere.npz", test_zip({{"K.npy", test_npy(good)}}));
  EXPECT_THAT(message([&] { load_capture(temp.path()); }), HasSubstr("no matrices world_mat_0"));
  fs::remove_all(temp.path() / "image");
  write_file_atomic(temp.path() / "cameras_sphere.npz", test_zip({{"world_mat_0.npy", test_npy(good)}}));
  EXPECT_THAT(message([&] { load_capture(temp.path()); }), HasSubstr("no images"));
}

TEST(Idr, OtherEntriesAndFortranOrderAreFine) {
  const TempFolder temp;
  const TestBall ball;
  const auto views = test_views(ball, 1);
  write_idr(temp.path(), ball, views);
  const std::vector<double> m = world_mat(views[0].camera);
  std::vector<double> t(16);
  for (size_t i = 0; i < 16; ++i) t[4 * (i % 4) + i / 4] = m[i];
  write_file_atomic(temp.path() / "cameras_sphere.npz", test_zip({{"world_mat_0.npy", test_npy(t, true)},
                                                                  {"world_mat_inv_0.npy", "junk"},
                                                                  {"world_mat_.npy", "junk"},
                                                                  {"notes.txt", "junk"}}));
  expect_same_projection(load_capture(temp.path()).views.at(0).camera, views[0].camera, ball.center);
}

TEST(Idr, ScaleMatStatesTheRegion) {
  const TempFolder temp;
  const TestBall ball;
  const auto views = test_views(ball, 1);
  write_idr(temp.path(), ball, views);
  const auto load = [&](double scale) {
    const std::vector<double> m{scale, 0, 0, 1, 0, scale, 0, 2, 0, 0, scale, 3, 0, 0, 0, 1};
    write_file_atomic(temp.path() / "cameras_sphere.npz",
                      test_zip({{"world_mat_0.npy", test_npy(world_mat(views[0].camera))},
                                {"scale_mat_0.npy", test_npy(m)}}));
    return load_capture(temp.path());
  };
  const Capture c = load(231);
  ASSERT_TRUE(c.region);
  EXPECT_EQ(c.region->radius, 231);
  EXPECT_EQ(length(c.region->center - Vec3d{1, 2, 3}), 0);
  for (const double bad : {0.0, double(NAN)}) {
    const Capture without = load(bad);
    EXPECT_FALSE(without.region);
    ASSERT_EQ(without.warnings.size(), 1u);
    EXPECT_THAT(without.warnings[0], HasSubstr("scale_mat_0"));
  }
}

TEST(Zip, HoldsWhatWasPutIn) {
  const std::map<std::string, std::string> files{{"a", "alpha"}, {"b/c", std::string(1000, 'x')}, {"e", ""}};
  EXPECT_EQ(unzip(test_zip(files), "x", 1 << 20), files);
}

TEST(Zip, HostileArchivesAreErrors) {
  const std::string good = test_zip({{"a", "alpha"}, {"b", "beta"}});
  EXPECT_THROW(unzip("", "x", 1000), Error);
  for (size_t n = 0; n < good.size(); ++n) EXPECT_THROW(unzip(good.substr(0, n), "cut", 1000), Error) << n;
  std::mt19937 random(3);
  for (int i = 0; i < 3000; ++i) {
    std::string s = good;
    for (int k = 0; k < 3; ++k) s[random() % s.size()] = char(random());
    try {
      unzip(s, "flipped", 1000);
    } catch (const Error&) {
    }
  }
  std::string flipped = good;
  flipped[good.find("alpha")] = 'A';
  EXPECT_THROW(unzip(flipped, "checksum", 1000), Error);
  EXPECT_THAT(message([&] { unzip(good, "big", 5); }), HasSubstr("more than"));
}

}  // namespace
}  // namespace cei3d

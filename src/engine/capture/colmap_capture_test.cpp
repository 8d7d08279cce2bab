// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "core/base/error_of.h"
#include "core/base/temp_folder.h"
#include "core/image/resample.h"
#include "core/math/color.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/test_formats.h"

namespace cei3d {
namespace {
namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class Colmap : public testing::Test {
 protected:
  void expect_views(const Capture& capture) const {
    ASSERT_EQ(capture.views.size(), views_.size());
    for (size_t i = 0; i < views_.size(); ++i) {
      EXPECT_EQ(capture.views[i].name, views_[i].stem);
      for (const Vec3d p : {Vec3d{0.3, -0.2, 0.5}, Vec3d{1, 0.1, 0.2}, Vec3d{-0.4, 0.5, 1.1}})
        EXPECT_NEAR(length(capture.views[i].camera.project(p) - views_[i].camera.project(p)), 0, 1e-6);
    }
  }
  const TempFolder temp_;
  const fs::path& folder_ = temp_.path();
  const TestBall ball_{};
  const std::vector<TestView> views_ = test_views(ball_, 6);
};

TEST_F(Colmap, TextAndBinaryInEveryFolder) {
  write_images(folder_ / "a" / "images", ball_, views_);
  for (const char* place : {"sparse/0", "sparse", "colmap/sparse/0", "dense/sparse", "."}) {
    const fs::path model = folder_ / "a" / place;
    write_colmap_bin(model, ball_, views_);
    const Capture binary = load_capture(folder_ / "a");
    EXPECT_EQ(binary.format, "colmap");
    expect_views(binary);
    expect_views(load_capture(model));
    for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) fs::remove(model / name);
    write_colmap_txt(model, ball_, views_);
    const Capture text = load_capture(folder_ / "a");
    expect_views(text);
    EXPECT_TRUE(text.warnings.empty()) << text.warnings[0];
    EXPECT_EQ(load_linear_rgba(text.views[3]).data, load_linear_rgba(binary.views[3]).data);
    for (const char* name : {"cameras.txt", "images.txt", "points3D.txt"}) fs::remove(model / name);
  }
}

TEST_F(Colmap, OfSeveralModelsTheOneWithMostImages) {
  write_images(folder_ / "images", ball_, views_);
  write_colmap_bin(folder_ / "sparse" / "0", ball_, {views_.begin(), views_.begin() + 2});
  write_colmap_txt(folder_ / "sparse" / "1", ball_, views_);
  const Capture capture = load_capture(folder_);
  expect_views(capture);
  EXPECT_THAT(capture.warnings.at(0), AllOf(HasSubstr("2 models"), HasSubstr("6 of 8")));
}

TEST_F(Colmap, ImagesElsewhereAreNotOpened) {
  std::vector<TestView> views = views_;
  write_images(folder_ / "home" / "capture" / "images", ball_, views);
  views[2].stem = "../../../secret";
  write_png(folder_ / "secret.png", Image(8, 8, 3, 0.5f));
  write_colmap_txt(folder_ / "home" / "capture" / "sparse" / "0", ball_, views);
  EXPECT_THAT(message([&] { load_capture(folder_ / "home" / "capture"); }),
              AllOf(HasSubstr("secret.png"), HasSubstr("outside of the capture's folder")));
}

struct LensCase {
  TestColmap model;
  const char* name;
};
std::vector<LensCase> lens_cases() {
  using K = LensKind;
  return {
      {{2, "SIMPLE_RADIAL", {-0.2}, {K::perspective, {-0.2, 0, 0, 0}, {}, 0, 0}, {}}, "simple radial"},
      {{3, "RADIAL", {-0.2, 0.05}, {K::perspective, {-0.2, 0.05, 0, 0}, {}, 0, 0}, {}}, "radial"},
      {{4,
        "OPENCV",
        {-0.2, 0.05, 0.004, -0.006},
        {K::perspective, {-0.2, 0.05, 0, 0}, {}, 0.004, -0.006},
        {}},
       "opencv"},
      {{6,
        "FULL_OPENCV",
        {0.5, 0.1, 0.004, -0.006, 0.02, 0.6, 0.1, 0.01},
        {K::perspective, {0.5, 0.1, 0.02, 0}, {0.6, 0.1, 0.01}, 0.004, -0.006},
        {}},
       "full"},
      {{5, "OPENCV_FISHEYE", {0.02, -0.01, 0.002, 0}, {K::fisheye, {0.02, -0.01, 0.002, 0}, {}, 0, 0}, {}},
       "fisheye"}};
}

// The ball as the lens shows it: every pixel of a large pinhole drawing, seen through the lens.
Image through_lens(const TestBall& ball, const PhotoCamera& photo) {
  Camera wide = photo.camera();
  wide.fx *= 3, wide.fy *= 3, wide.width *= 5, wide.height *= 5;
  wide.cx = wide.width / 2.0, wide.cy = wide.height / 2.0;
  const Image drawn = ball_image(ball, wide);
  Image out(photo.camera().width, photo.camera().height, 4);
  constexpr int kSub = 4;
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      double sum[4] = {};
      for (int s = 0; s < kSub * kSub; ++s) {
        const Vec2d at{x + (s % kSub + 0.5) / kSub, y + (s / kSub + 0.5) / kSub};
        const Vec2d from = *pinhole_from_photo(photo, wide, at);
        const float* p = drawn.at(int(from.x), int(from.y));
        for (int c = 0; c < 3; ++c) sum[c] += p[c] * p[3] / (kSub * kSub);
        sum[3] += p[3] / (kSub * kSub);
      }
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = sum[3] > 0 ? float(sum[c] / sum[3]) : 0;
      out.at(x, y)[3] = float(sum[3]);
    }
  return out;
}

// Undistorted photographs show the ball where a pinhole camera would.
TEST_F(Colmap, LensesAreUndone) {
  for (const LensCase& lens : lens_cases()) {
    SCOPED_TRACE(lens.name);
    const fs::path folder = folder_ / lens.name;
    const std::vector<TestView> views = test_views(ball_, 2, 128, 96);
    for (const TestView& v : views)
      write_png(folder / "images" / (v.stem + ".png"), through_lens(ball_, {v.camera, lens.model.distortion}),
                16);
    write_colmap_txt(folder / "sparse", ball_, views, lens.model);
    const Capture capture = load_capture(folder);
    ASSERT_EQ(capture.views.size(), 2u);
    for (const View& view : capture.views) {
      ASSERT_TRUE(view.photo);
      EXPECT_EQ(view.photo->lens(), lens.model.distortion);
      const Image seen = load_linear_rgba(view);
      Camera fine = view.camera;
      fine.width *= 4, fine.height *= 4, fine.fx *= 4, fine.fy *= 4, fine.cx *= 4, fine.cy *= 4;
      const Image truth = downscale(ball_image(ball_, fine), 4);
      ASSERT_EQ(seen.width, truth.width);
      double error = 0, alpha = 0;
      for (size_t i = 0; i < seen.data.size(); i += 4) {
        const double a = std::max(0.0f, seen.data[i + 3]);
        alpha += square(a - truth.data[i + 3]);
        // The photographs are written as sRGB values of the drawing's.
        for (size_t c = 0; c < 3; ++c)
          error += square(a * seen.data[i + c] - truth.data[i + 3] * linear_from_srgb(truth.data[i + c])) / 3;
      }
      const double n = double(seen.width) * seen.height;
      EXPECT_GT(-10 * std::log10(error / n), 36);  // the edge of the ball is sharper than bicubic samples
      EXPECT_GT(-10 * std::log10(alpha / n), 30);
    }
  }
}

// What a lens shows at a pixel of the photograph, linear: waves of 8 pixels.
double wave(Vec2d pixel, int channel) {
  const double a = 2 * M_PI / 8;
  return 0.5 + 0.2 * std::sin(a * (pixel.x + 2 * channel)) +
         0.2 * std::sin(a * (0.6 * pixel.x + 0.8 * pixel.y) + channel);
}

// The pixel of the direction (x, y, 1), by the formulas of COLMAP's models and with its parameters.
Vec2d pixel_of(const TestColmap& m, const Camera& c, double x, double y) {
  std::vector<double> k = m.lens;
  k.resize(8, 0);
  const double r2 = x * x + y * y;
  double f = (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  Vec2d tangential{2 * k[2] * x * y + k[3] * (r2 + 2 * x * x), 2 * k[3] * x * y + k[2] * (r2 + 2 * y * y)};
  if (m.model == 5) {
    const double r = std::sqrt(r2), t = std::atan(r), t2 = t * t;
    f = r > 0 ? t * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])))) / r : 1;
    tangential = {0, 0};
  }
  return {c.fx * (x * f + tangential.x) + c.cx, c.fy * (y * f + tangential.y) + c.cy};
}

// Mean square error of the view against the waves, where they lie 3 pixels inside the photograph.
double error_of_waves(const View& view, const TestColmap& model, const Camera& photo) {
  const Image seen = load_linear_rgba(view);
  const Camera& c = view.camera;
  double error = 0, n = 0;
  for (int y = 0; y < seen.height; ++y)
    for (int x = 0; x < seen.width; ++x) {
      const Vec2d at = pixel_of(model, photo, (x + 0.5 - c.cx) / c.fx, (y + 0.5 - c.cy) / c.fy);
      if (at.x < 3 || at.y < 3 || at.x > photo.width - 3 || at.y > photo.height - 3) continue;
      EXPECT_NEAR(seen.at(x, y)[3], 1, 1e-5);
      for (int k = 0; k < 3; ++k) error += square(seen.at(x, y)[k] - wave(at, k)) / 3;
      ++n;
    }
  EXPECT_GT(n, 0.8 * photo.width * photo.height);
  return error / n;
}

// With bilinear samples 40 to 42 dB would be left, with samples a twentieth of a pixel aside 44.
TEST_F(Colmap, SmoothPhotographsAreUndistortedPrecisely) {
  const std::vector<TestView> views = test_views(ball_, 1, 128, 96);
  const Camera& camera = views[0].camera;
  Image photo(camera.width, camera.height, 3);
  for (int y = 0; y < photo.height; ++y)
    for (int x = 0; x < photo.width; ++x)
      for (int c = 0; c < 3; ++c) photo.at(x, y)[c] = float(wave({x + 0.5, y + 0.5}, c));
  for (const LensCase& lens : lens_cases()) {
    SCOPED_TRACE(lens.name);
    const fs::path folder = folder_ / lens.name;
    write_png(folder / "images" / (views[0].stem + ".png"), srgb_from_linear(photo), 16);
    write_colmap_txt(folder / "sparse", ball_, views, lens.model);
    const Capture capture = load_capture(folder);
    EXPECT_GT(-10 * std::log10(error_of_waves(capture.views.at(0), lens.model, camera)), 45);
  }
}

TEST_F(Colmap, ViewsAreCroppedToTheObjectAndKnowWhatTheyDoNotShow) {
  const TestColmap lens = lens_cases()[2].model;
  Image photo = through_lens(ball_, {views_[0].camera, lens.distortion});
  for (int y = 0; y < photo.height; ++y) photo.at(0, y)[3] = 1;  // the object reaches the border
  write_images(folder_ / "images", ball_, views_);
  write_png(folder_ / "images" / "r_000.png", photo);
  write_colmap_bin(folder_, ball_, views_, lens);
  const Capture capture = load_capture(folder_);
  const Camera& whole = capture.views[0].camera;
  EXPECT_NE(whole.width, photo.width);
  EXPECT_LT(capture.views[1].camera.width, 64);
  const Mask mask = load_mask(capture.views[0]);
  EXPECT_EQ(mask.object[size_t(whole.height / 2) * whole.width + 2], kUnknown);
  EXPECT_EQ(load_linear_rgba(capture.views[0]).at(2, whole.height / 2)[3], kUnknownAlpha);
}

TEST_F(Colmap, SightingsAreReadWithTheirPoints) {
  write_images(folder_ / "images", ball_, views_);
  TestColmap model;
  model.points = points_on_ball(ball_, 40);
  write_colmap_bin(folder_, ball_, views_, model);
  for (const View& v : load_capture(folder_).views) {
    ASSERT_TRUE(v.sightings);
    EXPECT_GT(v.sightings->size(), 8u);
    for (const Sighting& s : *v.sightings) {
      const Vec3d p = v.camera.project(s.point);
      EXPECT_NEAR(p.x, s.pixel.x, 1e-6);
      EXPECT_NEAR(p.y, s.pixel.y, 1e-6);
    }
  }
}

TEST_F(Colmap, BrokenFilesAreErrorsThatNameThem) {
  write_images(folder_ / "images", ball_, views_);
  write_colmap_bin(folder_, ball_, views_);
  for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) {
    const std::string bytes = read_file(folder_ / name);
    for (size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 40) {
      write_file_atomic(folder_ / name, bytes.substr(0, n));
      EXPECT_THAT(message([&] { load_capture(folder_); }), HasSubstr(name));
    }
    write_file_atomic(folder_ / name, bytes);
  }
  fs::remove(folder_ / "cameras.bin");
  fs::remove(folder_ / "images.bin");
  write_colmap_txt(folder_, ball_, views_);
  write_file_atomic(folder_ / "cameras.txt", "1 PINHOLE 64 48 80 80 32 24\n");
  EXPECT_THAT(message([&] { load_capture(folder_); }), HasSubstr("names camera 2"));
  write_file_atomic(folder_ / "cameras.txt", "1 PINHOLE 64 48 80 8x 32 24\n");
  EXPECT_THAT(message([&] { load_capture(folder_); }), AllOf(HasSubstr("Line 1"), HasSubstr("8x")));
}

// Models that are not read are named, with what to do, also those that a later COLMAP may have.
TEST_F(Colmap, CameraModelsThatAreNotReadAreNamed) {
  write_images(folder_ / "images", ball_, views_);
  write_colmap_bin(folder_, ball_, views_);
  std::string cameras = read_file(folder_ / "cameras.bin");
  const std::pair<char, const char*> models[] = {
      {7, "model FOV"}, {16, "model EUCM"}, {17, "model EQUIRECTANGULAR"}, {99, "model '99'"}};
  for (const auto& [id, name] : models) {
    cameras[12] = id;
    write_file_atomic(folder_ / "cameras.bin", cameras);
    EXPECT_THAT(message([&] { load_capture(folder_); }),
                AllOf(HasSubstr("Camera 6"), HasSubstr(name), HasSubstr("colmap image_undistorter")));
  }
  fs::remove(folder_ / "cameras.bin");
  fs::remove(folder_ / "images.bin");
  write_colmap_txt(folder_, ball_, views_);
  for (const std::string name : {"EUCM", "LATER_MODEL"}) {
    write_file_atomic(folder_ / "cameras.txt", "1 " + name + " 64 48 80 80 32 24\n");
    EXPECT_THAT(message([&] { load_capture(folder_); }),
                AllOf(HasSubstr("Line 1"), HasSubstr(name), HasSubstr("colmap image_undistorter")));
  }
}

}  // namespace
}  // namespace cei3d

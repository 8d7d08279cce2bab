// SPDX-License-Identifier: Apache-2.0
// One object in every format: the same cameras and the same pixels.
#include <gmock/gmock.h>

#include <cstdlib>
#include <functional>

#include "core/base/error_of.h"
#include "core/base/temp_folder.h"
#include "core/base/test_source.h"
#include "core/math/color.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_format.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/test_formats.h"
#include "engine/io/test_jpeg.h"

namespace cei3d {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

class Formats : public testing::Test {
 protected:
  using Writer = std::function<void(const fs::path&)>;
  const TempFolder temp_;
  const TestBall ball_{};
  const std::vector<TestView> views_ = test_views(ball_, 7);
  const std::pair<const char*, Writer> writers_[9] = {
      {"nerf-synthetic", [&](const fs::path& f) { write_nerf_split(f, "train", ball_, views_); }},
      {"physg", [&](const fs::path& f) { write_physg(f, ball_, views_); }},
      {"idr", [&](const fs::path& f) { write_idr(f, ball_, views_); }},
      {"colmap", [&](const fs::path& f) { write_colmap_bin(f / "sparse/0", ball_, views_); }},
      {"metashape", [&](const fs::path& f) { write_metashape(f, views_); }},
      {"realitycapture", [&](const fs::path& f) { write_realitycapture(f, views_); }},
      {"llff", [&](const fs::path& f) { write_llff(f, views_); }},
      {"meshroom", [&](const fs::path& f) { write_meshroom(f, views_, false); }},
      {"meshroom", [&](const fs::path& f) { write_meshroom(f, views_, true); }},
  };
};

TEST_F(Formats, OneObjectInEveryFormatIsTheSame) {
  std::vector<std::string> written;
  for (const auto& [name, write] : writers_) {
    SCOPED_TRACE(name);
    const fs::path folder = temp_.path() / std::to_string(written.size());
    written.push_back(name);
    const bool own_images = written.size() <= 3;
    if (!own_images) write_images(folder / "images", ball_, views_);
    write(folder);
    const Capture capture = load_capture(folder);
    EXPECT_EQ(capture.format, name);
    ASSERT_EQ(capture.views.size(), views_.size());
    for (size_t i = 0; i < views_.size(); ++i) {
      const Camera &a = capture.views[i].camera, &b = views_[i].camera;
      EXPECT_EQ(a.width, b.width);
      EXPECT_EQ(a.height, b.height);
      EXPECT_NEAR(length(a.center - b.center), 0, 1e-6);
      for (int r = 0; r < 3; ++r)
        EXPECT_NEAR(length(a.world_from_cam.row[r] - b.world_from_cam.row[r]), 0, 1e-6);
      for (const Vec3d p : {Vec3d{0.3, -0.2, 0.5}, Vec3d{1, 0.1, 0.2}})
        EXPECT_NEAR(length(a.project(p) - b.project(p)), 0, 1e-6);
      Image expected = ball_image(ball_, b);
      for (size_t k = 0; k < expected.data.size(); ++k)
        if (k % 4 != 3) expected.data[k] = std::round(expected.data[k] * 255) / 255;
      EXPECT_EQ(load_linear_rgba(capture.views[i]).data, linear_from_srgb(expected).data);
    }
    EXPECT_EQ(load_capture(folder, {name, 0}).views.size(), views_.size());
  }
  for (const CaptureFormat& f : capture_formats()) EXPECT_THAT(written, testing::Contains(f.name));
}

// The one table of formats is what the documents say.
TEST_F(Formats, StandInTheDocuments) {
  const std::string readme = read_file(source_file("README.md")),
                    method = read_file(source_file("docs/method.md"));
  EXPECT_THAT(readme, HasSubstr(capture_format_programs()));
  for (const CaptureFormat& f : capture_formats()) {
    const std::string row = fmt::format("| `{}` | {} | {} |", f.name, f.programs, f.layout);
    EXPECT_THAT(method, HasSubstr(row));
  }
}

TEST_F(Formats, MetashapeLensesAreOpenCvsWithTangentialTermsSwapped) {
  const LensDistortion lens{LensKind::perspective, {-0.1, 0.02, 0, 0}, {}, 0.003, -0.001};
  write_images(temp_.path() / "images", ball_, views_);
  write_metashape(temp_.path(), views_, lens);
  const Capture capture = load_capture(temp_.path());
  ASSERT_TRUE(capture.views[0].photo);
  EXPECT_EQ(capture.views[0].photo->lens(), lens);
  EXPECT_THAT(capture.warnings.at(0), HasSubstr("1 cameras"));
}

TEST_F(Formats, BrokenFilesAreErrorsThatNameThem) {
  const std::pair<const char*, Writer> texts[] = {
      {"cameras.xml", [&](const fs::path& f) { write_metashape(f, views_); }},
      {"cameras.csv", [&](const fs::path& f) { write_realitycapture(f, views_); }},
      {"poses_bounds.npy", [&](const fs::path& f) { write_llff(f, views_); }},
      {"cameras.sfm", [&](const fs::path& f) { write_meshroom(f, views_, false); }}};
  for (const auto& [name, write] : texts) {
    const fs::path folder = temp_.path() / name;
    write_images(folder / "images", ball_, views_);
    write(folder);
    const std::string bytes = read_file(folder / name);
    for (size_t n = 100; n + 40 < bytes.size(); n += 1 + bytes.size() / 20) {
      write_file_atomic(folder / name, bytes.substr(0, n));
      try {
        load_capture(folder);
      } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr(folder.string()));
      }
    }
    std::string letters = bytes;
    for (char& c : letters)
      if (c == '4') c = 'x';
    write_file_atomic(folder / name, letters);
    try {
      load_capture(folder);
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr(folder.string()));
    }
  }
}

// Masks where the programs leave them, white or black.
TEST_F(Formats, MasksAreFoundByEveryHabit) {
  const char* const habits[] = {"masks/{}.png",       "masks/{}.png.png",   "mask/{}.png",
                                "images/{}.mask.png", "images/{}_mask.png", "images/dynamic_mask_{}.png",
                                "images/masks/{}.png"};
  for (const char* habit : habits) {
    for (const bool dark : habit == habits[0] ? std::vector<bool>{false, true} : std::vector<bool>{false}) {
      SCOPED_TRACE(habit);
      const TempFolder temp;
      write_metashape(temp.path(), views_);
      for (const TestView& v : views_) {
        const Image rgba = ball_image(ball_, v.camera);
        Image rgb(rgba.width, rgba.height, 3), mask(rgba.width, rgba.height, 1);
        for (size_t i = 0; i < mask.data.size(); ++i) {
          for (size_t c = 0; c < 3; ++c) rgb.data[3 * i + c] = rgba.data[4 * i + c];
          mask.data[i] = dark ? 1 - rgba.data[4 * i + 3] : rgba.data[4 * i + 3];
        }
        write_png(temp.path() / "images" / (v.stem + ".png"), rgb);
        write_png(temp.path() / fmt::format(fmt::runtime(habit), v.stem), mask);
      }
      const Capture capture = load_capture(temp.path());
      ASSERT_EQ(capture.views.size(), views_.size());
      for (size_t i = 0; i < views_.size(); ++i) {
        EXPECT_EQ(capture.views[i].dark_object, dark);
        const Image seen = load_linear_rgba(capture.views[i]), truth = ball_image(ball_, views_[i].camera);
        for (size_t k = 3; k < seen.data.size(); k += 4) ASSERT_EQ(seen.data[k], truth.data[k]);
      }
      EXPECT_EQ(capture.warnings.size(), dark ? 2u : 1u);
      EXPECT_EQ(dark, capture.warnings.back().find("dark was taken to mean the object") != std::string::npos);
    }
  }
}

// Stored pixels are used as they are, unless the camera has the sides that EXIF turns them to.
TEST_F(Formats, ImagesAreTurnedOnlyWhereTheCameraIs) {
  const std::vector<TestView> upright = test_views(ball_, 4, 48, 64);
  for (const bool turned_camera : {false, true}) {
    const fs::path folder = temp_.path() / (turned_camera ? "turned" : "stored");
    std::vector<TestView> views = turned_camera ? upright : test_views(ball_, 4, 64, 48);
    for (const TestView& v : views) {
      const Image rgba = ball_image(ball_, v.camera);
      Image rgb(64, 48, 3), mask(v.camera.width, v.camera.height, 1);
      for (size_t i = 0; i < mask.data.size(); ++i) mask.data[i] = rgba.data[4 * i + 3];
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
          std::copy_n(turned_camera ? rgba.at(47 - y, x) : rgba.at(x, y), 3, rgb.at(x, y));
      write_file_atomic(folder / "images" / (v.stem + ".png"), with_exif(encode_jpeg(rgb, 100), 6));
      write_png(folder / "masks" / (v.stem + ".png"), mask);
    }
    write_colmap_txt(folder, ball_, views);
    for (const View& view : load_capture(folder).views) {
      const Image seen = load_linear_rgba(view), drawn = ball_image(ball_, view.camera);
      double error = 0, n = 0;
      for (int y = 4; y < seen.height - 4; ++y)
        for (int x = 4; x < seen.width - 4; ++x) {
          if (drawn.at(x, y)[3] < 1 || drawn.at(x - 4, y)[3] < 1 || drawn.at(x + 4, y)[3] < 1) continue;
          error += std::abs(srgb_from_linear(seen.at(x, y)[0]) - drawn.at(x, y)[0]), ++n;
        }
      EXPECT_LT(error / n, 0.02) << view.name;
      EXPECT_NEAR(CaptureImages().exposure(view).value_or(0), 200.0 / 50 / 16, 1e-12);  // with_exif()
    }
  }
}

TEST_F(Formats, SizesMayDiffer) {
  std::vector<TestView> views = test_views(ball_, 4);
  for (const TestView& v : test_views(ball_, 7, 48, 96)) views.push_back({"t_" + v.stem, v.camera});
  write_images(temp_.path() / "images", ball_, views);
  write_colmap_bin(temp_.path(), ball_, views);
  const Capture capture = load_capture(temp_.path());
  ASSERT_EQ(capture.views.size(), 11u);
  EXPECT_EQ(capture.views[0].camera.width, 64);
  EXPECT_EQ(capture.views[10].camera.height, 96);
}

// Images at half the size of the cameras, and masks at another one.
TEST_F(Formats, CamerasAreScaledToTheirImages) {
  std::vector<TestView> large = views_;
  for (TestView& v : large)
    for (double* k : {&v.camera.fx, &v.camera.fy, &v.camera.cx, &v.camera.cy}) *k *= 2;
  for (TestView& v : large) v.camera.width *= 2, v.camera.height *= 2;
  write_images(temp_.path() / "images", ball_, views_);
  for (const TestView& v : large) {
    const Image rgba = ball_image(ball_, v.camera);
    Image mask(rgba.width, rgba.height, 1);
    for (size_t i = 0; i < mask.data.size(); ++i) mask.data[i] = rgba.data[4 * i + 3];
    write_png(temp_.path() / "masks" / (v.stem + ".png"), mask);
  }
  write_colmap_bin(temp_.path(), ball_, large);
  const Capture capture = load_capture(temp_.path());
  ASSERT_EQ(capture.warnings.size(), 1u);
  EXPECT_THAT(capture.warnings[0], HasSubstr("from 128 x 96 to 64 x 48"));
  for (size_t i = 0; i < views_.size(); ++i) {
    EXPECT_NEAR(capture.views[i].camera.fx, views_[i].camera.fx, 1e-9);
    const Mask mask = load_mask(capture.views[i]);
    size_t wrong = 0;
    const Image truth = ball_image(ball_, views_[i].camera);
    for (size_t k = 0; k < mask.object.size(); ++k) wrong += mask.object[k] != (truth.data[4 * k + 3] > 0.5f);
    EXPECT_LT(wrong, 60u);  // pixels of the outline
  }
}

// A converter that copies, and counts its calls.
class Heic : public Formats {
 protected:
  Heic() : path_(std::getenv("PATH")) {
    write_images(folder() / "images", ball_, views_);
    for (const TestView& v : views_) fs::rename(image(v, ".png"), image(v, ".HEIC"));
    write_converter(fmt::format("echo >> {}\ncp \"$3\" \"$4\"\n", calls().string()));
    setenv("PATH", ((temp_.path() / "bin").string() + ":" + path_).c_str(), 1);
  }
  ~Heic() override { setenv("PATH", path_.c_str(), 1); }
  fs::path folder() const { return temp_.path() / "capture"; }
  void write_converter(const std::string& script) const {
    const fs::path program = temp_.path() / "bin/heif-convert";
    write_file_atomic(program, "#!/bin/sh\n" + script);
    fs::permissions(program, fs::perms::owner_all);
  }
  fs::path calls() const { return temp_.path() / "calls"; }
  fs::path image(const TestView& v, const char* suffix) const {
    return folder() / "images" / (v.stem + suffix);
  }
  void expect_all_read() const {
    for (int i = 0; i < 2; ++i) {
      const Capture capture = load_capture(folder());
      ASSERT_EQ(capture.views.size(), views_.size());
      EXPECT_EQ(capture.views[2].image_path.filename(), "r_002.jpg");
      EXPECT_EQ(capture.views[2].name.find('.'), std::string::npos) << capture.views[2].name;
      EXPECT_EQ(load_mask(capture.views[2]).width, views_[2].camera.width);
      EXPECT_EQ(read_file(calls()).size(), views_.size());  // once each
    }
  }

 private:
  std::string path_;
};

TEST_F(Heic, ImagesOfPosedCapturesAreConvertedOnce) {
  Json j{{"camera_angle_x", 2 * std::atan(0.5 * views_[0].camera.width / views_[0].camera.fx)},
         {"frames", Json::array()}};
  for (const TestView& v : views_) j["frames"].push_back(nerf_frame("images/" + v.stem + ".HEIC", v.camera));
  write_file_atomic(folder() / "transforms.json", j.dump());
  expect_all_read();
}

TEST_F(Heic, AreFoundByTheirNames) {
  write_meshroom(folder(), views_, false);
  expect_all_read();
}

TEST_F(Heic, ThatCannotBeReadAreNamed) {
  write_meshroom(folder(), views_, false);
  write_converter("echo no good\nexit 1\n");
  EXPECT_THAT(message([&] { load_capture(folder()); }), HasSubstr("heif-convert said: no good"));
}

}  // namespace
}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/check.h"

#include <gmock/gmock.h>

#include <functional>

#include "core/base/error_of.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"
#include "engine/capture/test_capture.h"
#include "engine/io/test_jpeg.h"

namespace cei3d {
namespace {
namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Check : public testing::Test {
 protected:
  Check() { write_nerf_split(folder(), "train", ball_, views_); }
  const fs::path& folder() const { return temp_.path(); }
  fs::path picture(int i) const { return folder() / "train" / (views_[size_t(i)].stem + ".png"); }
  std::string complaint() const {
    try {
      require_usable(load_capture(folder()));
    } catch (const Error& e) {
      return e.what();
    }
    return "usable";
  }
  // Loads the cameras, changes them, checks.
  std::string complaint_about(const std::function<void(Capture&)>& change) const {
    Capture capture = load_capture(folder());
    change(capture);
    try {
      require_usable(capture);
    } catch (const Error& e) {
      return e.what();
    }
    return "usable";
  }
  // Stores an image as a JPEG, whatever its name says, with its mask in a file.
  void store_as_jpeg(size_t i, const std::function<std::string(const std::string&)>& with_notes) const {
    const Image rgba = ball_image(ball_, views_[i].camera);
    Image rgb(rgba.width, rgba.height, 3), mask(rgba.width, rgba.height, 1);
    for (size_t k = 0; k < mask.data.size(); ++k) {
      std::copy_n(&rgba.data[4 * k], 3, &rgb.data[3 * k]);
      mask.data[k] = rgba.data[4 * k + 3];
    }
    write_file_atomic(picture(int(i)), with_notes(encode_jpeg(rgb, 95)));
    write_png(folder() / "train" / (views_[i].stem + "_mask.png"), mask);
  }
  std::string all_findings() const {
    std::string all;
    for (const Finding& f : check(load_capture(folder())).findings) all += f.what;
    return all;
  }
  const TempFolder temp_;
  const TestBall ball_{};
  const std::vector<TestView> views_ = test_views(ball_, 20);
};

TEST_F(Check, GoodCaptureIsUnderstood) {
  write_nerf_split(folder(), "test", ball_, test_views(ball_, 3));
  const CaptureReport report = check(load_capture(folder()));
  EXPECT_TRUE(report.usable());
  EXPECT_TRUE(report.findings.empty()) << report.findings[0].what;
  ASSERT_EQ(report.splits.size(), 2u);
  EXPECT_EQ(report.splits[0].views, 20);
  EXPECT_EQ(report.splits[0].size, (ImageSize{64, 48}));
  // A ball of radius r at distance d covers pi (f r)^2 / (d^2 - r^2) pixels of the frame, nearly.
  const double truth = 3.14159 * std::pow(1.4 * 64, 2) / (4.5 * 4.5 - 1) / (64 * 48);
  EXPECT_NEAR(report.splits[0].coverage, truth, 0.03 * truth);
  ASSERT_TRUE(report.normalization);
  EXPECT_NEAR(report.distance, 4.5 * ball_.radius, 0.05);
}

TEST_F(Check, MissingPicturesAreListed) {
  fs::remove(picture(3));
  fs::remove(picture(5));
  Capture capture = load_capture(folder());
  EXPECT_EQ(capture.views.size(), 18u);
  EXPECT_TRUE(check(capture).usable());
  EXPECT_THAT(capture.warnings.at(0), AllOf(HasSubstr("2 of 20 images are missing"), HasSubstr("train/r_003"),
                                            HasSubstr("train/r_005")));
  CaptureOptions strict;
  strict.strict = true;
  EXPECT_THAT(message([&] { require_usable(load_capture(folder(), strict)); }),
              AllOf(HasSubstr("2 of 20 images are missing"), HasSubstr("train/r_003")));
  for (int i = 0; i < 12; ++i) fs::remove(picture(i));  // more than half: something else is wrong
  EXPECT_THAT(complaint(), HasSubstr("12 of 20 images are missing"));
}

TEST_F(Check, TruncatedPicture) {
  const std::string bytes = read_file(picture(3));
  write_file_atomic(picture(3), bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(complaint(), AllOf(HasSubstr("r_003.png"), HasSubstr("broken PNG")));
  write_file_atomic(picture(0), bytes.substr(0, 20));  // the picture that tells the size
  EXPECT_THAT(complaint(), AllOf(HasSubstr("2 of 20"), HasSubstr("r_000.png")));
}

TEST_F(Check, AnImageOfOtherProportionsThanItsCamera) {
  Json j = Json::parse(read_file(folder() / "transforms_train.json"));
  j["w"] = 64, j["h"] = 48;
  write_file_atomic(folder() / "transforms_train.json", j.dump());
  write_png(picture(4), Image(32, 30, 4, 1.0f));
  EXPECT_THAT(complaint(), AllOf(HasSubstr("r_004.png"), HasSubstr("32 x 30"), HasSubstr("belong together")));
}

TEST_F(Check, EmptyMask) {
  write_png(picture(4), Image(64, 48, 4, 0.0f));
  EXPECT_THAT(complaint(), AllOf(HasSubstr("1 of 20 masks are empty"), HasSubstr("r_004")));
  for (int i = 0; i < 20; ++i) write_png(picture(i), Image(64, 48, 4, 0.0f));
  EXPECT_THAT(complaint(), HasSubstr("20 of 20 masks are empty"));
}

TEST_F(Check, NeitherAlphaNorMask) {
  for (int i = 0; i < 20; ++i) write_png(picture(i), Image(64, 48, 3, 0.5f));
  EXPECT_THAT(complaint(), HasSubstr("neither an alpha channel nor a mask"));
}

TEST_F(Check, OpaqueAlphaIsNoMask) {
  for (int i = 0; i < 20; ++i) write_png(picture(i), Image(64, 48, 4, 1.0f));
  EXPECT_THAT(complaint(), HasSubstr("cover the whole image"));
}

TEST_F(Check, BadPoses) {
  EXPECT_THAT(complaint_about([](Capture& c) { c.views[2].camera.center.y = NAN; }),
              AllOf(HasSubstr("1 of 20 poses"), HasSubstr("r_002")));
  EXPECT_THAT(complaint_about([](Capture& c) { c.views[2].camera.world_from_cam.row[0].x = NAN; }),
              HasSubstr("poses"));
  EXPECT_THAT(complaint_about([](Capture& c) { c.views[2].camera.world_from_cam.row[0].x += 0.1; }),
              HasSubstr("poses"));
  EXPECT_THAT(complaint_about([](Capture& c) {
                for (Vec3d& row : c.views[2].camera.world_from_cam.row) row.x = -row.x;  // a reflection
              }),
              HasSubstr("poses"));
  EXPECT_THAT(complaint_about([](Capture& c) {
                for (View& v : c.views) v.camera.center = {NAN, NAN, NAN};
              }),
              HasSubstr("20 of 20 poses"));
}

TEST_F(Check, PosesThatDisagreeWithMasks) {
  EXPECT_THAT(complaint_about([](Capture& c) {
                for (View& v : c.views)
                  for (Vec3d& row : v.camera.world_from_cam.row) row = {row.x, -row.y, -row.z};
              }),
              HasSubstr("disagree"));
}

TEST_F(Check, TooFewViews) {
  EXPECT_THAT(complaint_about([](Capture& c) { c.views.resize(2); }), HasSubstr("only 2 training views"));
  EXPECT_THAT(complaint_about([](Capture& c) { c.views.clear(); }), HasSubstr("only 0 training views"));
}

TEST_F(Check, CutObjectAndCameraThatLooksAwayAreWarnings) {
  Capture capture = load_capture(folder());
  Image cut = ball_image(ball_, views_[1].camera);
  for (int x = 0; x < 64; ++x) cut.at(x, 0)[3] = 1;
  write_png(picture(1), cut);
  View away = capture.views[0];
  away.name = "test/away";
  away.split = Split::test;
  away.camera.center = ball_.center + (away.camera.center - ball_.center) * -1.0;
  capture.views.push_back(away);
  const CaptureReport report = check(capture);
  std::string all;
  for (const Finding& f : report.findings) all += f.what;
  EXPECT_THAT(all, AllOf(HasSubstr("cut by the frame border: train/r_001"),
                         HasSubstr("look away from the object: test/away")));
}

TEST_F(Check, ColorProfilesThatCannotBeUsedAreNamed) {
  store_as_jpeg(3, [](const std::string& jpeg) { return with_profile(jpeg, "no color profile"); });
  store_as_jpeg(
      7, [](const std::string& jpeg) { return with_profile(jpeg, p3_profile().replace(16, 4, "CMYK")); });
  store_as_jpeg(9, [](const std::string& jpeg) { return with_profile(jpeg, p3_profile()); });
  EXPECT_THAT(all_findings(),
              HasSubstr("2 of 20 images have a color profile that is damaged or not of RGB, and "
                        "are taken for sRGB: train/r_003, train/r_007."));
}

TEST_F(Check, WhiteBalanceLeftToTheCameraIsNamed) {
  store_as_jpeg(5, [](const std::string& jpeg) { return with_exif(jpeg, 1, 1); });
  EXPECT_THAT(all_findings(), Not(HasSubstr("white balance")));
  for (const int i : {3, 8}) store_as_jpeg(i, [](const std::string& jpeg) { return with_exif(jpeg, 1, 0); });
  EXPECT_THAT(
      all_findings(),
      HasSubstr("it chose the white balance of 2 of 20 photographs itself, so their colors may differ: "
                "train/r_003, train/r_008."));
}

TEST_F(Check, DrawsCameras) {
  const Capture capture = load_capture(folder());
  const CaptureReport report = check(capture);
  const Image image = draw_cameras(capture, *report.normalization, 200);
  EXPECT_EQ(image.width, 400);
  // A camera sits where it should: its dot is blue in the panel from above.
  const Vec3d p = report.normalization->unit_from_capture(capture.views[0].camera.center);
  double reach = 1;
  for (const View& v : capture.views)
    reach = std::max(reach, length(report.normalization->unit_from_capture(v.camera.center)));
  const Vec3d right = normalize(cross(Vec3d{1, 0, 0}, Vec3d{0, 0, 1})), away = cross(Vec3d{0, 0, 1}, right);
  const int x = int((dot(p, right) / (1.1 * reach) * 0.5 + 0.5) * 200),
            y = int((0.5 - dot(p, away) / (1.1 * reach) * 0.5) * 200);
  EXPECT_GT(image.at(x, y)[2], image.at(x, y)[0] + 0.3f);
}

}  // namespace
}  // namespace cei3d

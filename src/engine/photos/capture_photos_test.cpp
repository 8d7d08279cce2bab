// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/capture_photos.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/system.h"
#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/colmap_model.h"
#include "engine/capture/test_formats.h"
#include "engine/photos/colmap_run.h"
#include "engine/photos/photo_files.h"
#include "engine/photos/still_pixels.h"

namespace cei3d {
namespace {
namespace fs = std::filesystem;

TEST(ColmapProgress, IsReadFromWhatItPrints) {
  EXPECT_FALSE(colmap_progress("Feature extraction\n", 10));
  EXPECT_DOUBLE_EQ(*colmap_progress("Processed file [1/8]\n  Name: a\nProcessed file [2/8]\n", 8), 0.25);
  EXPECT_DOUBLE_EQ(*colmap_progress("Matching block [2/2, 1/2] in 1.2s\nMatching block [2/2, 2/2]", 8), 0.75);
  EXPECT_DOUBLE_EQ(*colmap_progress("Matching image [30/40]", 40), 0.75);
  EXPECT_DOUBLE_EQ(*colmap_progress("Registering image #12 (3)\n\n  => Image sees 40 / 90 points", 12), 0.25);
  EXPECT_FALSE(colmap_progress("Processed file [x/8]", 8));
}

TEST(FullLens, ProjectsAsBefore) {
  const TempFolder folder;
  TestColmap model;
  model.model = 2, model.lens = {0.03};
  write_colmap_bin(folder.path(), TestBall(), test_views(TestBall(), 2), model);
  EXPECT_FALSE(give_full_lens(folder.path()));  // two cameras
  write_colmap_bin(folder.path(), TestBall(), test_views(TestBall(), 1), model);
  const ColmapModel::Camera before = read_colmap_model(folder.path()).cameras.at(1);
  EXPECT_EQ(before.lens.radial[0], 0.03);
  EXPECT_TRUE(give_full_lens(folder.path()));
  const ColmapModel::Camera after = read_colmap_model(folder.path()).cameras.at(1);
  EXPECT_EQ(after.lens, before.lens);
  for (const auto member : {&Camera::fx, &Camera::fy, &Camera::cx, &Camera::cy})
    EXPECT_EQ(after.k.*member, before.k.*member);
  EXPECT_FALSE(give_full_lens(folder.path()));  // it has one
}

Image gray(int width, int height) { return Image(width, height, 3, 0.45f); }

// The ball before gray, as photographs without masks, and in the place of COLMAP a script that hands out a
// model with the true poses.
class Photos : public testing::Test {
 protected:
  void SetUp() override {
    const TestBall ball;
    views_ = test_views(ball, 12, 96, 72);
    for (const TestView& v : views_) {
      const Image rgba = ball_image(ball, v.camera);
      Image photo = gray(rgba.width, rgba.height);
      for (size_t i = 0; i < photo.data.size() / 3; ++i)
        for (size_t c = 0; c < 3; ++c)
          photo.data[3 * i + c] += rgba.data[4 * i + 3] * (rgba.data[4 * i + c] - photo.data[3 * i + c]);
      write_png(photos() / (v.stem + ".png"), photo);
    }
    write_png(root_.path() / "plate.png", gray(96, 72));
    TestColmap model;
    model.points = points_on_ball(ball, 300);
    write_colmap_bin(root_.path() / "model/0", ball, views_, model);
    write_program(R"(#!/bin/sh
echo "$1 $2" >> ROOT/calls
[ "$2" = -h ] && exit 0
[ "$1" = mapper ] || exit 0
while [ "$1" != --output_path ]; do shift; done
cp -r ROOT/model/0 "$2"
)");
    ASSERT_EQ(setenv("PATH", (bin().string() + ":" + old_path_).c_str(), 1), 0);
  }
  void TearDown() override { setenv("PATH", old_path_.c_str(), 1); }

  void write_program(std::string text) const {
    for (size_t at; (at = text.find("ROOT")) != std::string::npos;)
      text.replace(at, 4, root_.path().string());
    write_file_atomic(bin() / "colmap", text);
    fs::permissions(bin() / "colmap", fs::perms::owner_all);
  }
  fs::path bin() const { return root_.path() / "bin"; }
  fs::path photos() const { return root_.path() / "photos"; }
  PhotosRequest request() const {
    PhotosRequest r;
    r.photos = photos(), r.out = root_.path() / "capture", r.plate = root_.path() / "plate.png";
    return r;
  }
  std::string calls() const { return read_file(root_.path() / "calls"); }

  TempFolder root_;
  std::vector<TestView> views_;
  std::string old_path_ = std::getenv("PATH");
  Progress progress_;
};

TEST_F(Photos, BecomeACapture) {
  const PhotosReport r = capture_photos(request(), progress_);
  EXPECT_EQ(r.photos, 12u);
  EXPECT_EQ(r.posed, 12u);
  EXPECT_TRUE(r.without_pose.empty() && r.without_mask.empty());
  const Capture capture = load_capture(r.out);
  ASSERT_EQ(capture.views.size(), 12u);
  for (size_t i = 0; i < capture.views.size(); ++i) {
    const View& v = capture.views[i];
    EXPECT_LT(length(v.camera.center - views_[i].camera.center), 1e-9);
    const Mask mask = load_file_mask(v);
    const Image truth = ball_image(TestBall(), views_[i].camera);
    size_t differ = 0;
    for (size_t p = 0; p < mask.object.size(); ++p)
      differ += (mask.object[p] == kObject) != (truth.data[4 * p + 3] > 0.5f);
    EXPECT_LT(double(differ), 0.01 * double(mask.object.size())) << v.name;
  }
}

TEST_F(Photos, AreNotPosedTwice) {
  capture_photos(request(), progress_);
  const std::string once = calls();
  capture_photos(request(), progress_);
  EXPECT_EQ(calls().substr(once.size()), "feature_extractor -h\n");
}

TEST_F(Photos, GetNewMasksForOtherClicks) {
  const fs::path mask = request().out / "masks/r_003.png";
  capture_photos(request(), progress_);
  write_png(mask, Image(96, 72, 1));  // painted by the user
  capture_photos(request(), progress_);
  EXPECT_EQ(read_image(mask).data, Image(96, 72, 1).data);
  PhotosRequest clicked = request();
  clicked.clicks = {{"r_003", {48, 36}, true}};
  capture_photos(clicked, progress_);
  EXPECT_NE(read_image(mask).data, Image(96, 72, 1).data);
  EXPECT_EQ(read_image(request().out / "work/earlier_masks/r_003.png").data, Image(96, 72, 1).data);
}

TEST_F(Photos, OfAnotherFolderAreRefused) {
  capture_photos(request(), progress_);
  PhotosRequest other = request();
  other.photos = root_.path();
  EXPECT_NE(message([&] { capture_photos(other, progress_); }).find("was begun with"), std::string::npos);
}

TEST_F(Photos, OfOneFolderAreTakenByOneProcess) {
  capture_photos(request(), progress_);
  const std::optional<FileLock> other = FileLock::take(request().out / "work/lock");
  ASSERT_TRUE(other);
  EXPECT_NE(message([&] { capture_photos(request(), progress_); }).find("Another process"),
            std::string::npos);
}

TEST_F(Photos, FolderWithOtherFilesIsRefused) {
  write_file_atomic(request().out / "mine.txt", "x");
  EXPECT_NE(message([&] { capture_photos(request(), progress_); }).find("is not empty"), std::string::npos);
}

TEST_F(Photos, WithTooFewPosesAreRefused) {
  write_colmap_bin(root_.path() / "model/0", TestBall(), {views_.begin(), views_.begin() + 5}, {});
  EXPECT_NE(message([&] { capture_photos(request(), progress_); }).find("only 5 of 12"), std::string::npos);
}

// Of a turntable that nobody mentioned: the strict search poses few.
TEST_F(Photos, AreAlsoPosedAsOnATurntable) {
  for (const bool found : {true, false}) {
    write_colmap_bin(root_.path() / "few/0", TestBall(), {views_.begin(), views_.begin() + 5}, {});
    write_program(fmt::format(R"(#!/bin/sh
[ "$2" = -h ] && exit 0
[ "$1" = mapper ] || {{ echo "$@" >> ROOT/calls; exit 0; }}
model={}
for word in "$@"; do [ "$word" = --Mapper.init_min_tri_angle ] && model=model; done
[ $model ] || exit 1
while [ "$1" != --output_path ]; do shift; done
cp -r ROOT/$model/0 "$2"
)",
                              found ? "few" : ""));
    EXPECT_EQ(capture_photos(request(), progress_).posed, 12u) << found;
    EXPECT_NE(calls().find("--ImageReader.mask_path"), std::string::npos);
    fs::remove_all(request().out);
  }
}

TEST_F(Photos, WhoseProgramFailsAreRefusedWithItsWords) {
  write_program("#!/bin/sh\n[ \"$2\" = -h ] && exit 0\necho no good >&2\nexit 3\n");
  const std::string error = message([&] { capture_photos(request(), progress_); });
  EXPECT_NE(error.find("feature_extractor failed"), std::string::npos) << error;
}

TEST_F(Photos, WithoutColmapSayWhatToInstall) {
  setenv("PATH", root_.path().c_str(), 1);
  EXPECT_NE(message([&] { capture_photos(request(), progress_); }).find("not installed"), std::string::npos);
  EXPECT_FALSE(fs::exists(request().out));
}

TEST_F(Photos, OfOneNameAreRefused) {
  fs::copy_file(photos() / "r_003.png", photos() / "r_003.jpg");
  EXPECT_NE(message([&] { capture_photos(request(), progress_); }).find("two photographs named r_003"),
            std::string::npos);
}

TEST_F(Photos, WithAClickOutsideAreRefused) {
  PhotosRequest r = request();
  r.clicks = {{"r_003", {500, 10}, true}};
  EXPECT_NE(message([&] { capture_photos(r, progress_); }).find("is outside"), std::string::npos);
}

// The name of the converted file, and a converter that fails.
TEST_F(Photos, OfPhonesAreConverted) {
  fs::create_directories(root_.path() / "phone");
  for (int i = 0; i < 8; ++i)
    fs::copy_file(photos() / "r_003.png", root_.path() / ("phone/IMG_" + std::to_string(i) + ".HEIC"));
  const auto write_converter = [&](const std::string& script) {
    write_file_atomic(bin() / "heif-convert", "#!/bin/sh\n" + script);
    fs::permissions(bin() / "heif-convert", fs::perms::owner_all);
  };
  write_converter("echo no good\nexit 1\n");
  const auto copied = [&] {
    return copy_photos(root_.path() / "phone", root_.path() / "to", 100, progress_);
  };
  EXPECT_NE(message([&] { copied(); }).find("heif-convert said: no good"), std::string::npos)
      << message([&] { copied(); });
  write_converter("cp \"$3\" \"$4\"\n");
  EXPECT_EQ(copied().names.size(), 8u);
  EXPECT_EQ(copied().names.front(), "IMG_0.jpg");
}

TEST_F(Photos, FewerThanEightAreRefused) {
  const fs::path few = root_.path() / "few";
  fs::create_directories(few);
  fs::copy_file(photos() / "r_003.png", few / "r_003.png");
  EXPECT_NE(message([&] { copy_photos(few, root_.path() / "to", 100, progress_); }).find("has 1 photographs"),
            std::string::npos);
}

// A square moves over a still background.
TEST(StillPixels, AreThoseThatNothingMovesOver) {
  const TempFolder folder;
  std::vector<fs::path> photos;
  for (int i = 0; i < 8; ++i) {
    Image photo(64, 48, 3, 0.6f);
    for (int y = 16; y < 32; ++y)
      for (int x = 0; x < 64; ++x)
        for (int c = 0; c < 3; ++c) photo.at(x, y)[c] = float((x + 5 * i) % 16) / 16;
    photos.push_back(folder.path() / (std::to_string(i) + ".png"));
    write_png(photos.back(), photo);
  }
  const StillPixels still = still_pixels(photos, Progress());
  ASSERT_EQ(still.reduction, 1);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      EXPECT_EQ(still.area[size_t(y) * 64 + x], y < 16 || y >= 32) << x << " " << y;
}

}  // namespace
}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// The check names what is wrong with damaged copies of a good capture, and nothing is wrong with the good
// one.
#include "engine/capture/doctor.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <iostream>
#include <regex>
#include <set>

#include "core/base/error.h"
#include "core/base/temp_folder.h"
#include "core/base/test_source.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/check.h"
#include "engine/capture/spread.h"
#include "engine/capture/test_colmap_damage.h"
#include "engine/capture/test_damage.h"
#include "engine/capture/test_formats.h"
#include "engine/capture/write_capture.h"
#include "engine/io/test_jpeg.h"

namespace cei3d {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

std::string sentences(const CaptureReport& report, Severity from) {
  std::string text;
  for (const Finding& f : report.findings)
    if (f.severity >= from) text += f.what + "\n";
  return text;
}

// What the check says, or why the capture cannot be loaded.
std::string what_check_says(const fs::path& folder) {
  try {
    return sentences(check(load_capture(folder)), Severity::warning);
  } catch (const Error& e) {
    return e.what();
  }
}

// Training views of a capture, spread around the object, with RGBA images.
void write_some_views(const fs::path& capture, int count, const fs::path& folder) {
  Capture c = load_capture(capture);
  if (count > 0 && views_of(c, Split::train).size() > size_t(count)) keep_training_views(c, count);
  std::erase_if(c.views, [](const View& v) { return v.split != Split::train; });
  write_capture(c, folder);
}

void copy_capture(const fs::path& from, const fs::path& to) {
  fs::remove_all(to);
  fs::copy(from, to, fs::copy_options::recursive);
}

// Number of damages, of every Nth, that are not named; prints them.
int not_named(const fs::path& good, const fs::path& work, size_t every = 1) {
  int missed = 0;
  const std::vector<Damage> all = usual_damages();
  for (size_t i = 0; i < all.size(); i += every) {
    const Damage& damage = all[i];
    copy_capture(good, work);
    DamagedCapture copy(work);
    damage.make(copy);
    copy.save();
    const std::string said = what_check_says(work);
    if (std::regex_search(said, std::regex(damage.says))) continue;
    ++missed;
    std::cout << "not named: " << damage.name << "; said: " << (said.empty() ? "nothing\n" : said);
  }
  return missed;
}

TEST(Doctor, NamesTheUsualMistakes) {
  const TempFolder temp;
  write_some_views(source_file("samples/spot"), 24, temp.path() / "good");
  EXPECT_EQ(what_check_says(temp.path() / "good"), "");
  EXPECT_EQ(not_named(temp.path() / "good", temp.path() / "copy", 2), 0);
}

// The object of a good capture.
Normalization object_of(const Capture& capture) { return check(capture).normalization.value(); }

int not_named_of_colmap(const fs::path& good, const fs::path& work) {
  int missed = 0;
  const Capture capture = load_capture(good);
  const ColmapCopy copy(capture, object_of(capture), work);
  std::vector<Finding> of_the_model;
  check_tracks(load_capture(work), of_the_model);
  EXPECT_TRUE(of_the_model.empty());
  for (const ColmapDamage& damage : usual_colmap_damages()) {
    damage.make(copy);
    const std::string said = what_check_says(work);
    copy.write_model("0", copy.views());
    fs::remove_all(copy.model("1"));
    if (std::regex_search(said, std::regex(damage.says))) continue;
    ++missed;
    std::cout << "not named: " << damage.name << "; said: " << (said.empty() ? "nothing\n" : said);
  }
  return missed;
}

TEST(Doctor, NamesTheMistakesOfColmapModels) {
  const TempFolder temp;
  write_some_views(source_file("samples/spot"), 24, temp.path() / "good");
  EXPECT_EQ(not_named_of_colmap(temp.path() / "good", temp.path() / "colmap"), 0);
}

// Its views are cropped to the object, to sizes that differ: of the masks of spot some are reduced by two,
// some by one.
TEST(Doctor, FindsNothingInACleanColmapModel) {
  const TempFolder temp;
  const fs::path good = temp.path() / "good", model = temp.path() / "colmap";
  write_some_views(source_file("samples/spot"), 24, good);
  const Capture capture = load_capture(good);
  const ColmapCopy copy(capture, object_of(capture), model);
  std::set<int> factors;
  for (const View& v : load_capture(model).views)
    factors.insert(reduction_of(v.camera.width, v.camera.height));
  EXPECT_GT(factors.size(), 1u);
  EXPECT_EQ(what_check_says(model), "");
}

// The image as a telephone stores it: a JPEG in Display P3, with its mask in a file.
void store_in_p3(DamagedCapture& c, size_t i) {
  const Image image = read_image(c.image(i)), linear = linear_from_srgb(image);
  Image p3(image.width, image.height, 3), mask(image.width, image.height, 1);
  for (size_t k = 0; k < mask.data.size(); ++k) {
    const float *v = &linear.data[4 * k], r = v[0], g = v[1], b = v[2];
    p3.data[3 * k] = 0.8225f * r + 0.1774f * g;  // [CSS Color 4, section 10.12]
    p3.data[3 * k + 1] = 0.0332f * r + 0.9669f * g;
    p3.data[3 * k + 2] = 0.0171f * r + 0.0724f * g + 0.9108f * b;
    mask.data[k] = v[3];
  }
  const std::string stem = c.name(i);
  write_png(c.folder() / (stem + "_mask.png"), mask);
  write_file_atomic(c.folder() / (stem + ".jpg"),
                    with_profile(encode_jpeg(srgb_from_linear(std::move(p3)), 98), p3_profile()));
  c.frame(i)["file_path"] = stem + ".jpg";
  c.frame(i)["mask_path"] = stem + "_mask.png";
}

TEST(Doctor, ImagesInDisplayP3AreLikeTheOthers) {
  const TempFolder temp;
  write_some_views(source_file("samples/spot"), 24, temp.path() / "good");
  copy_capture(temp.path() / "good", temp.path() / "copy");
  DamagedCapture copy(temp.path() / "copy");
  for (const size_t i : {3, 4, 11}) store_in_p3(copy, i);
  copy.save();
  EXPECT_EQ(what_check_says(temp.path() / "copy"), "");
  const View good = load_capture(temp.path() / "good").views[4],
             p3 = load_capture(temp.path() / "copy").views[4];
  ASSERT_EQ(p3.image_path.extension(), ".jpg");
  const Image a = load_linear_rgba(good), b = load_linear_rgba(p3);
  double difference = 0, object = 0;
  for (size_t i = 0; i < a.data.size(); i += 4)
    for (size_t c = 0; c < 3 && a.data[i + 3] == 1; ++c)
      difference += std::abs(a.data[i + c] - b.data[i + c]), ++object;
  EXPECT_LT(difference / object, 0.008);  // without the profile: more than 0.02
}

// All damages of all captures in CEI3D_CAPTURES (separated by colons): minutes.
TEST(Doctor, NamesMistakesInMoreCaptures) {
  const char* list = std::getenv("CEI3D_CAPTURES");
  if (!list) GTEST_SKIP() << "damaged copies of other captures: CEI3D_CAPTURES names none";
  const TempFolder temp;
  int missed = 0, all = 0;
  std::istringstream captures(list);
  for (std::string capture; std::getline(captures, capture, ':');) {
    std::cout << capture << ": " << what_check_says(capture);
    write_some_views(capture, 30, temp.path() / "good");
    missed += not_named(temp.path() / "good", temp.path() / "copy");
    missed += not_named_of_colmap(temp.path() / "good", temp.path() / "colmap");
    all += int(usual_damages().size() + usual_colmap_damages().size());
    fs::remove_all(temp.path() / "colmap");
    fs::remove_all(temp.path() / "good");
  }
  std::cout << all - missed << " of " << all << " damaged copies are named\n";
  EXPECT_LE(missed, all / 10);
}

class Tracks : public testing::Test {
 protected:
  Tracks() {
    model_.model = 4, model_.model_name = "OPENCV";
    model_.lens = {-0.15, 0.05, 0.012, -0.004};
    model_.distortion = {LensKind::perspective, {-0.15, 0.05, 0, 0}, {}, 0.012, -0.004};
    model_.points = points_on_ball(ball_, 60);
    write_images(temp_.path() / "images", ball_, views_);
  }
  // The observations are those of the true lens; the cameras are written as changed.
  std::string said(const std::function<void(std::vector<double>&)>& change) {
    write_colmap_txt(temp_.path(), ball_, views_, model_);
    change_colmap_cameras(temp_.path(), 8, change);
    std::vector<Finding> findings;
    check_tracks(load_capture(temp_.path()), findings);
    std::string sentence;
    for (const Finding& f : findings) sentence += f.what;
    return sentence;
  }
  const TempFolder temp_;
  const TestBall ball_{};
  const std::vector<TestView> views_ = test_views(ball_, 20, 320, 240);
  TestColmap model_;
};

TEST_F(Tracks, NameWrongReadingsOfTheCamera) {
  using P = std::vector<double>;
  EXPECT_EQ(said([](P&) {}), "");
  EXPECT_THAT(said([](P& p) { std::swap(p[6], p[7]); }), HasSubstr("p1 and p2 are exchanged"));
  EXPECT_THAT(said([](P& p) { p[2] += 0.5, p[3] += 0.5; }), HasSubstr("(-0.5, -0.5): half a pixel"));
  EXPECT_THAT(said([](P& p) { p[2] -= 0.5, p[3] -= 0.5; }), HasSubstr("(+0.5, +0.5): half a pixel"));
  EXPECT_THAT(said([](P& p) { p[4] = -p[4], p[5] = -p[5]; }), HasSubstr("other sign"));
  EXPECT_THAT(said([](P& p) {
                for (int i = 0; i < 4; ++i) p[size_t(i)] *= 2;
              }),
              HasSubstr("K is multiplied by 0.5"));
}

TEST_F(Tracks, RepairedCamerasFitAgain) {
  said([](std::vector<double>& p) { std::swap(p[6], p[7]); });
  Capture capture = load_capture(temp_.path());
  std::vector<Finding> findings;
  check_tracks(capture, findings);
  for (const Finding& f : findings)
    if (f.repair) f.repair(capture);
  write_capture(capture, temp_.path() / "repaired");
  const Capture again = load_capture(temp_.path() / "repaired");
  ASSERT_EQ(again.views.size(), views_.size());
  for (size_t i = 0; i < views_.size(); ++i) {
    EXPECT_EQ(again.views[i].photo->lens(), model_.distortion);
    EXPECT_NEAR(length(again.views[i].camera.center - views_[i].camera.center), 0, 1e-9);
  }
}

TEST(WriteCapture, IsReadAsItWas) {
  const TempFolder temp;
  const TestBall ball;
  const auto views = test_views(ball, 5);
  write_physg(temp.path() / "a" / "train", ball, views);
  write_physg(temp.path() / "a" / "test", ball, test_views(ball, 2));
  const Capture a = load_capture(temp.path() / "a");
  write_capture(a, temp.path() / "b");
  const Capture b = load_capture(temp.path() / "b");
  ASSERT_EQ(b.views.size(), 7u);
  for (size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(b.views[i].split, a.views[i].split);
    EXPECT_NEAR(length(b.views[i].camera.project({1, 2, 3}) - a.views[i].camera.project({1, 2, 3})), 0, 1e-9);
    EXPECT_EQ(load_linear_rgba(b.views[i]).data, load_linear_rgba(a.views[i]).data);
  }
  EXPECT_THROW(write_capture(a, temp.path() / "b"), Error);
}

}  // namespace
}  // namespace cei3d

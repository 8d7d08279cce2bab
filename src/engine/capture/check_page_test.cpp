// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/check_page.h"

#include <gtest/gtest.h>

#include <set>

#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"
#include "engine/capture/test_capture.h"

namespace cei3d {
namespace {

// A capture of a ball, without a mask in every second of the first 16 views, more than a sentence names. In
// another the frame cuts the ball.
class DoubtfulViews : public testing::Test {
 protected:
  DoubtfulViews() {
    const TestBall ball;
    const std::vector<TestView> views = test_views(ball, 20);
    write_nerf_split(temp_.path(), "train", ball, views);
    const auto picture = [&](size_t i) { return temp_.path() / "train" / (views[i].stem + ".png"); };
    for (size_t i = 0; i < 16; i += 2) {
      write_png(picture(i), Image(64, 48, 4));
      empty_.insert("train/" + views[i].stem);
    }
    Image cut = ball_image(ball, views[1].camera);
    for (int x = 0; x < cut.width; ++x) cut.at(x, 0)[3] = 1;
    write_png(picture(1), cut);
    capture_ = load_capture(temp_.path());
    report_ = check(capture_);
  }
  std::set<std::string> views_of(const std::string& what) const {
    std::set<std::string> names;
    for (const Finding& f : report_.findings)
      if (f.what.find(what) != std::string::npos) names.insert(f.views.begin(), f.views.end());
    return names;
  }
  const TempFolder temp_;
  std::set<std::string> empty_;
  Capture capture_;
  CaptureReport report_;
};

TEST_F(DoubtfulViews, AreAllListedByTheFinding) {
  EXPECT_EQ(views_of("masks are empty"), empty_);
  EXPECT_EQ(views_of("cut by the frame border"), std::set<std::string>{capture_.views[1].name});
}

TEST_F(DoubtfulViews, HaveARedFrameOnTheContactSheet) {
  constexpr int kSize = 60, kCell = kSize + 8;
  const Image sheet = contact_sheet(capture_, report_, kSize);
  const int columns = sheet.width / kCell;
  for (int i = 0; i < int(capture_.views.size()); ++i) {
    const float* corner = sheet.at(i % columns * kCell, i / columns * kCell);
    EXPECT_EQ(corner[0] > 2 * corner[1], empty_.contains(capture_.views[size_t(i)].name)) << i;
  }
}

TEST_F(DoubtfulViews, OfANoteHaveNone) {
  CaptureReport report;
  report.findings.push_back({Severity::note, "A note.", "", {capture_.views[0].name}});
  EXPECT_EQ(check_page(capture_, report).find("class=\"doubtful\""), std::string::npos);
  report.findings[0].severity = Severity::warning;
  EXPECT_NE(check_page(capture_, report).find("class=\"doubtful\""), std::string::npos);
}

}  // namespace
}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/check_page.h"

#include <gtest/gtest.h>

#include <set>

#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"
#include "engine/capture/test_capture.h"

namespace cei3d {
namespace {

// A capture of a ball, cut off by the frame in every second of the first 16 views: more than a sentence
// names.
class DoubtfulViews : public testing::Test {
 protected:
  DoubtfulViews() {
    const TestBall ball;
    const std::vector<TestView> views = test_views(ball, 20);
    write_nerf_split(temp_.path(), "train", ball, views);
    for (size_t i = 0; i < 16; i += 2) {
      Image cut = ball_image(ball, views[i].camera);
      for (int x = 0; x < cut.width; ++x) cut.at(x, 0)[3] = 1;
      write_png(temp_.path() / "train" / (views[i].stem + ".png"), cut);
      names_.insert("train/" + views[i].stem);
    }
    capture_ = load_capture(temp_.path());
    report_ = check(capture_);
  }
  const TempFolder temp_;
  std::set<std::string> names_;
  Capture capture_;
  CaptureReport report_;
};

TEST_F(DoubtfulViews, AreAllListedByTheFinding) {
  std::set<std::string> listed;
  for (const Finding& f : report_.findings)
    if (f.what.find("cut by the frame border") != std::string::npos)
      listed.insert(f.views.begin(), f.views.end());
  EXPECT_EQ(listed, names_);
}

TEST_F(DoubtfulViews, HaveARedFrameOnTheContactSheet) {
  constexpr int kSize = 60, kCell = kSize + 8;
  const Image sheet = contact_sheet(capture_, report_, kSize);
  const int columns = sheet.width / kCell;
  for (int i = 0; i < int(capture_.views.size()); ++i) {
    const float* corner = sheet.at(i % columns * kCell, i / columns * kCell);
    EXPECT_EQ(corner[0] > 2 * corner[1], names_.contains(capture_.views[size_t(i)].name)) << i;
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

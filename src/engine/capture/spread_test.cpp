// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/spread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/base/error.h"

namespace cei3d {
namespace {

// Cameras at these places on a line, and one held out.
Capture on_a_line(const std::vector<double>& places) {
  Capture c;
  for (const double x : places) {
    View v;
    v.name = std::to_string(c.views.size());
    v.camera.center = {x, 0, 0};
    c.views.push_back(v);
  }
  c.views.push_back(c.views.front());
  c.views.back().split = Split::test;
  return c;
}

std::set<double> kept(const std::vector<double>& places, int count) {
  Capture c = on_a_line(places);
  keep_training_views(c, count);
  EXPECT_EQ(c.views.size(), places.size() + 1);
  EXPECT_EQ(c.views.back().split, Split::test);
  std::set<double> x;
  for (const View& v : c.views)
    if (v.split == Split::train) x.insert(v.camera.center.x);
  return x;
}

TEST(Spread, TakesTheEndsThenTheMiddles) {
  const std::vector<double> places{0, 1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(kept(places, 2), (std::set<double>{0, 8}));
  EXPECT_EQ(kept(places, 3), (std::set<double>{0, 4, 8}));
  EXPECT_EQ(kept(places, 5), (std::set<double>{0, 2, 4, 6, 8}));
  EXPECT_EQ(kept(places, 9).size(), 9u);
  EXPECT_EQ(kept(places, 0).size(), 9u);
}

TEST(Spread, CamerasAtOnePlaceAreStillAsManyAsWanted) {
  EXPECT_EQ(kept({1, 1.5, 1.25, 4}, 4).size(), 4u);
  Capture c = on_a_line({1, 1, 1, 1});
  keep_training_views(c, 3);
  EXPECT_EQ(
      std::count_if(c.views.begin(), c.views.end(), [](const View& v) { return v.split == Split::train; }),
      3);
}

TEST(Spread, FewerAreAmongMore) {
  std::vector<double> places;
  for (int i = 0; i < 40; ++i) places.push_back(double(i * i % 61) + 0.01 * i);
  for (int n = 2; n < 20; ++n) {
    const std::set<double> few = kept(places, n), more = kept(places, 2 * n);
    EXPECT_EQ(few.size(), size_t(n));
    EXPECT_TRUE(std::includes(more.begin(), more.end(), few.begin(), few.end()));
  }
}

TEST(Spread, RefusesWhatIsNotThere) {
  EXPECT_THROW(kept({1, 2, 3}, 4), Error);
  EXPECT_THROW(kept({1, 2, 3}, 1), Error);
  EXPECT_THROW(kept({1, 2, 3}, -2), Error);
}

}  // namespace
}  // namespace cei3d

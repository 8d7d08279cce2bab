// SPDX-License-Identifier: Apache-2.0
#include "engine/bench/bench.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/project/project.h"
#include "engine/render/sphere_scene.h"
#include "engine/session/session.h"

namespace cei3d {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

double median_by_sorting(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return 0.5 * (v[(v.size() - 1) / 2] + v[v.size() / 2]);
}

TEST(Bench, SpreadIsMedianAndMedianAbsoluteDeviation) {
  for (const std::vector<double>& v :
       {std::vector<double>{3}, {1, 2}, {5, 1, 9}, {4, 4, 4, 4}, {7, 1, 3, 100, 2}, {6, 5, 4, 3, 2, 1}}) {
    const Spread s = spread_of(v, true);
    EXPECT_EQ(s.median, median_by_sorting(v));
    std::vector<double> away;
    for (const double x : v) away.push_back(std::abs(x - s.median));
    EXPECT_EQ(s.deviation, median_by_sorting(away));
    EXPECT_EQ(s.best, *std::max_element(v.begin(), v.end()));
    EXPECT_EQ(spread_of(v, false).best, *std::min_element(v.begin(), v.end()));
    EXPECT_EQ(s.repeats, int(v.size()));
  }
  EXPECT_THROW(spread_of({}, true), Error);
}

void expect_sound(const std::vector<BenchFigure>& figures) {
  std::set<std::string> names;
  for (const BenchFigure& f : figures) {
    EXPECT_TRUE(names.insert(f.name).second) << f.name;
    EXPECT_GE(f.spread.deviation, 0) << f.name;
    EXPECT_GE(f.spread.repeats, 2) << f.name;
    EXPECT_FALSE(f.unit.empty()) << f.name;
    for (const auto& [peak, fraction] : f.of) EXPECT_GE(fraction, 0) << f.name << " of " << peak;
  }
}

const BenchFigure& figure(const std::vector<BenchFigure>& figures, const std::string& name) {
  const auto it =
      std::find_if(figures.begin(), figures.end(), [&](const BenchFigure& f) { return f.name == name; });
  if (it == figures.end()) fail("There is no figure {}.", name);
  return *it;
}

TEST(Bench, KernelsAreComparedWithTheirPeaks) {
  const Session session;
  const std::vector<BenchFigure> figures = bench_kernels(session.device(), 2);
  expect_sound(figures);
  for (const BenchFigure& f : figures) EXPECT_GT(f.spread.median, 0) << f.name;
  const BenchFigure& backward = figure(figures, "hash encoding, jet backward, table 2^15");
  ASSERT_EQ(backward.of.size(), 2u);
  EXPECT_EQ(backward.of[0].first, "read-modify-write peak");
  EXPECT_NEAR(backward.of[0].second * figure(figures, "read-modify-write peak").spread.best,
              backward.spread.best, 1e-9 * backward.spread.best);
}

TEST(Bench, PartsOfAStepMakeTheStep) {
  Session session("auto", 1);
  Progress quiet;
  const fs::path before = fs::current_path();
  const TempFolder temp;
  fs::current_path(temp.path());  // no samples here: the ball that is made up
  const std::vector<BenchFigure> figures = bench_training(session.device(), {{}, 0, 3, 1, 2}, quiet);
  fs::current_path(before);
  expect_sound(figures);
  EXPECT_THAT(figures[0].subject, HasSubstr("ball"));
  const double step = figure(figures, "processor time, the step").spread.median;
  double parts = 0;
  for (const BenchFigure& f : figures)
    if (!f.of.empty()) parts += f.spread.median;
  EXPECT_NEAR(parts / step, 1, 1e-6);  // medians of two are means
  EXPECT_GT(figure(figures, "geometry stage, rays").spread.median, 0);
}

TEST(Bench, ObjectIsNotChanged) {
  const TempFolder temp;
  const fs::path folder = temp.path() / "object";
  {
    View v;
    v.name = "train/r_0";
    v.camera = camera_towards_origin({0, -3, 0.3}, 64);
    Capture c;
    c.root = "/nowhere";
    c.format = "nerf-synthetic";
    c.views = {v};
    Project::create(folder, {}, c, false).save_base(sphere_with_handlers());
  }
  Session session;
  Progress quiet;
  const std::vector<BenchFigure> figures = bench_object(session, folder, 2, quiet);
  expect_sound(figures);
  EXPECT_EQ(figures.size(), 17u);
  session.open(folder, Session::Access::read);
  EXPECT_EQ(session.info().edits, 0u);
  session.close();
  EXPECT_THROW(bench_object(session, temp.path(), 2, quiet), Error);
}

TEST(Bench, JsonSaysAllOfAFigure) {
  BenchReport r;
  r.figures = {{"kernels", "spot", "x", "GB/s", false, {4, 0.5, 3, 7}, {{"peak", 0.25}}}};
  const Json f = r.json()["figures"][0];
  EXPECT_EQ(f["median"], 4);
  EXPECT_EQ(f["deviation"], 0.5);
  EXPECT_EQ(f["best"], 3);
  EXPECT_EQ(f["repeats"], 7);
  EXPECT_EQ(f["better"], "lower");
  EXPECT_EQ(f["subject"], "spot");
  EXPECT_EQ(f["of"]["peak"], 0.25);
  EXPECT_THAT(r.text(), testing::AllOf(HasSubstr("25 % of peak"), HasSubstr("GB/s")));
}

}  // namespace
}  // namespace cei3d

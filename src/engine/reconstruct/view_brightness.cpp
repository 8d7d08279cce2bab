// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/view_brightness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "core/math/quantile.h"

namespace cei3d {
namespace {

constexpr float kPart = 0.15f;                   // side of a part, unit frame
constexpr float kDark = 0.01f, kBright = 0.85f;  // of all channels
constexpr int kFewestSamples = 15;               // of a photograph in a part
constexpr size_t kFewestParts = 5;               // of a photograph
constexpr int kRounds = 20;

struct Sums {
  double photo = 0, radiance = 0;
  int samples = 0;
};

// How much brighter a part is in a photograph than explained, as a logarithm.
struct Difference {
  size_t view, part;
  double value;
};

double sum_of(Vec3f v) { return double(v.x) + double(v.y) + double(v.z); }

bool usable(Vec3f v) { return std::min({v.x, v.y, v.z}) > kDark && std::max({v.x, v.y, v.z}) < kBright; }

std::vector<Difference> differences_of(std::span<const ComparedSample> samples, size_t& parts) {
  std::map<std::array<int, 3>, size_t> part_at;
  std::map<std::array<size_t, 2>, Sums> sums;  // by view and part
  for (const ComparedSample& s : samples) {
    if (!usable(s.photo) || !usable(s.radiance)) continue;
    const std::array<int, 3> cell{int(std::floor(s.position.x / kPart)),
                                  int(std::floor(s.position.y / kPart)),
                                  int(std::floor(s.position.z / kPart))};
    const size_t part = part_at.try_emplace(cell, part_at.size()).first->second;
    Sums& sum = sums[{s.view, part}];
    sum.photo += sum_of(s.photo);
    sum.radiance += sum_of(s.radiance);
    ++sum.samples;
  }
  parts = part_at.size();
  std::vector<Difference> out;
  for (const auto& [at, sum] : sums)
    if (sum.samples >= kFewestSamples) out.push_back({at[0], at[1], std::log(sum.photo / sum.radiance)});
  return out;
}

// Median of the lists that have enough; 0 for others.
std::vector<double> medians(std::vector<std::vector<double>> lists, size_t fewest) {
  std::vector<double> out;
  for (std::vector<double>& list : lists)
    out.push_back(list.size() < std::max<size_t>(fewest, 1) ? 0 : median(std::move(list)));
  return out;
}

}  // namespace

std::vector<float> view_brightness(std::span<const ComparedSample> samples, size_t views) {
  size_t parts = 0;
  const std::vector<Difference> differences = differences_of(samples, parts);
  std::vector<double> of_views(views, 0), of_parts;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::vector<double>> by_part(parts), by_view(views);
    for (const Difference& d : differences) by_part[d.part].push_back(d.value - of_views[d.view]);
    of_parts = medians(std::move(by_part), 1);
    for (const Difference& d : differences) by_view[d.view].push_back(d.value - of_parts[d.part]);
    of_views = medians(std::move(by_view), kFewestParts);
    const double mean = std::accumulate(of_views.begin(), of_views.end(), 0.0) / double(views);
    for (double& v : of_views) v -= mean;
  }
  std::vector<float> out;
  for (const double v : of_views) out.push_back(float(std::exp(v)));
  return out;
}

}  // namespace cei3d

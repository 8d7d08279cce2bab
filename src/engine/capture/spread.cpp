// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/spread.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/math/rng.h"

namespace cei3d {

void keep_training_views(Capture& capture, int count) {
  if (count == 0) return;
  std::vector<View*> train;
  for (View& v : capture.views)
    if (v.split == Split::train) train.push_back(&v);
  if (count < 2)
    fail_usage("The number of training views should be 2 or more (or 0 for all), not {}.", count);
  if (size_t(count) > train.size())
    fail_usage("{} views are asked for: the capture has {} training views.", count, train.size());
  constexpr double kFar = std::numeric_limits<double>::max();
  std::vector<double> distance(train.size(), kFar);  // squared, to the nearest chosen one
  size_t chosen = 0;
  for (View* v : train) v->split = Split::val;
  for (int n = 0; n < count; ++n) {
    train[chosen]->split = Split::train;
    distance[chosen] = -1;
    for (size_t i = 0; i < train.size(); ++i) {
      const Vec3d d = train[i]->camera.center - train[chosen]->camera.center;
      distance[i] = std::min(distance[i], dot(d, d));
    }
    chosen = size_t(std::max_element(distance.begin(), distance.end()) - distance.begin());
  }
}

void hold_out_random(Capture& capture, double share, uint64_t seed) {
  std::vector<std::pair<uint32_t, View*>> order;
  for (View& v : capture.views)
    if (v.split == Split::train) order.push_back({Rng(seed, 0, order.size()).bits(), &v});
  const double count = std::max(1.0, std::round(share * double(order.size())));
  if (!(share > 0 && share < 1) || double(order.size()) - count < 2)
    fail_usage("A random share of {} cannot be held out of {} views.", share, order.size());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t i = 0; i < size_t(count); ++i) order[i].second->split = Split::test;
}

}  // namespace cei3d

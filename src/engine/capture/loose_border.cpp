// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/loose_border.h"

#include <algorithm>
#include <cmath>

#include "core/math/color.h"
#include "core/math/quantile.h"
#include "model/geometry/mesh/graph_walk.h"

namespace cei3d {
namespace {

constexpr double kWidth = 0.01;  // of the band within the mask, as a share of the image's longer side
constexpr int kMinWidth = 3;     // pixels
constexpr double kBackgroundBelief = 0.7;  // from which a pixel is taken for background
constexpr double kTypicalSteps = 3;        // a step of that many typical ones is unlikely
constexpr float kMinTypical = 0.01f;  // of a step between neighbors, sRGB: what noise and compression leave
constexpr double kMinWeight = 1e-4;
constexpr double kNowhere = 1e-9;  // of ending in the band: a part of it may touch neither side

enum class Place : uint8_t { outside, background, band, object };

// The band is where the outline may be: within the mask, and a pixel beside it.
std::vector<Place> places_of(const HullMask& mask) {
  const int w = mask.camera.width, h = mask.camera.height;
  Area object(mask.mask.size()), background(mask.mask.size());
  for (size_t i = 0; i < object.size(); ++i)
    object[i] = mask.mask[i] == kObject, background[i] = mask.mask[i] == kBackground;
  const int width = std::max(kMinWidth, int(std::lround(kWidth * std::max(w, h))));
  const Area beside = dilated(object, w, h, 1), near = dilated(background, w, h, width);
  std::vector<Place> out(object.size(), Place::outside);
  for (size_t i = 0; i < out.size(); ++i) {
    if (background[i]) out[i] = beside[i] ? Place::band : Place::background;
    if (object[i]) out[i] = near[i] ? Place::band : Place::object;
  }
  return out;
}

// Two neighbors, of which one at least is in the band.
struct Step {
  uint32_t a, b;
  float size;  // distance of the colors, sRGB
};

std::vector<Step> steps_of(const Image& photograph, const std::vector<Place>& places) {
  const auto w = uint32_t(photograph.width);
  const auto srgb = [&](uint32_t i) { return srgb_from_linear(photograph.rgb(int(i % w), int(i / w))); };
  std::vector<Step> out;
  const auto add = [&](uint32_t a, uint32_t b) {
    const bool used = places[a] != Place::outside && places[b] != Place::outside;
    if (used && (places[a] == Place::band || places[b] == Place::band))
      out.push_back({a, b, length(srgb(a) - srgb(b))});
  };
  for (uint32_t i = 0; i < places.size(); ++i) {
    if (i % w + 1 < w) add(i, i + 1);
    if (i + w < places.size()) add(i, i + w);
  }
  return out;
}

// Probability of each pixel of the band that a random walker, to whom steps of color are unlikely, reaches
// the background before the object; of other pixels 0. [Grady 2006]
std::vector<double> background_belief(const std::vector<Place>& places, const std::vector<Step>& steps) {
  std::vector<float> sizes;
  for (const Step& s : steps) sizes.push_back(s.size);
  const double typical = std::max(kMinTypical, median(std::move(sizes)));
  std::vector<int> index(places.size(), -1);
  int n = 0;
  for (size_t i = 0; i < places.size(); ++i)
    if (places[i] == Place::band) index[i] = n++;
  std::vector<WalkEdge> edges;
  std::vector<WalkSeed> seeds;
  const auto leave = [&](uint32_t from, uint32_t to, double weight) {
    seeds.push_back({index[from], weight, places[to] == Place::background ? 1.0 : 0.0});
  };
  for (const Step& s : steps) {
    const double weight = std::exp(-square(s.size / (kTypicalSteps * typical)) / 2) + kMinWeight;
    if (index[s.a] < 0)
      leave(s.b, s.a, weight);
    else if (index[s.b] < 0)
      leave(s.a, s.b, weight);
    else
      edges.push_back({index[s.a], index[s.b], weight});
  }
  for (int i = 0; i < n; ++i) seeds.push_back({i, kNowhere, 0});
  const std::vector<double> solved = walk_to_seeds(n, edges, seeds);
  std::vector<double> out(places.size());
  for (size_t i = 0; i < places.size(); ++i)
    if (index[i] >= 0) out[i] = solved[size_t(index[i])];
  return out;
}

}  // namespace

Area loose_border(const Image& photograph, const HullMask& mask) {
  const int w = mask.camera.width, h = mask.camera.height;
  const std::vector<Place> places = places_of(mask);
  const std::vector<Step> steps = steps_of(photograph, places);
  if (steps.empty()) return Area(mask.mask.size());
  const std::vector<double> belief = background_belief(places, steps);
  Area out(belief.size()), beside(belief.size()), deep(belief.size());
  for (size_t i = 0; i < out.size(); ++i) {
    out[i] = mask.mask[i] == kObject && belief[i] > kBackgroundBelief;
    beside[i] = mask.mask[i] == kBackground;
  }
  // The outermost pixels of a good mask show some background, too.
  beside = dilated(beside, w, h, 1);
  for (size_t i = 0; i < out.size(); ++i) deep[i] = out[i] && !beside[i];
  deep = dilated(deep, w, h, 1);
  for (size_t i = 0; i < out.size(); ++i) out[i] = out[i] && deep[i];
  return out;
}

}  // namespace cei3d

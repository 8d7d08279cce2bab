// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/prompts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/thinned.h"

namespace cei3d {
namespace {

// Maximum numbers of pixels that are compared. Thinned pixels still show the whole part, because the order of
// handler points is random in space.
constexpr size_t kCandidates = 400;
constexpr size_t kOthers = 3000;  // pixels that candidates keep away from
constexpr float kFar = 1e9f;

float distance(Vec2f a, Vec2f b) { return std::hypot(a.x - b.x, a.y - b.y); }

float nearest(Vec2f p, std::span<const Vec2f> others) {
  float best = kFar;
  for (Vec2f o : others) best = std::min(best, distance(p, o));
  return best;
}

struct Candidate {
  Vec2f pixel;
  float clearance;  // distance in pixels to the nearest pixel of another belief
};

std::vector<Candidate> candidates(std::span<const Vec2f> pixels, std::span<const Vec2f> others) {
  std::vector<Candidate> result;
  for (Vec2f p : thinned(pixels, kCandidates)) result.push_back({p, nearest(p, others)});
  return result;
}

// Greedily chooses the candidate farthest from those chosen and, with half the weight, from the border.
void choose(const std::vector<Candidate>& from, size_t count, std::vector<Vec2f>& chosen) {
  for (size_t n = 0; n < count; ++n) {
    float best = 0;
    Vec2f pixel{0, 0};
    for (const Candidate& c : from) {
      const float value = std::min(nearest(c.pixel, chosen), 2 * c.clearance);
      if (value <= best) continue;
      best = value;
      pixel = c.pixel;
    }
    if (best <= 0) return;
    chosen.push_back(pixel);
  }
}

// Root mean square distance from the mean.
float extent(std::span<const Vec2f> pixels) {
  double x = 0, y = 0, xx = 0;
  for (Vec2f p : pixels) {
    x += p.x;
    y += p.y;
    xx += double(p.x) * p.x + double(p.y) * p.y;
  }
  const auto n = double(std::max<size_t>(pixels.size(), 1));
  return float(std::sqrt(std::max(xx / n - (x * x + y * y) / (n * n), 0.0)));
}

std::vector<Vec2f> joined(std::span<const Vec2f> a, std::span<const Vec2f> b) {
  std::vector<Vec2f> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

}  // namespace

void add_prompts(const BelievedPixels& pixels, size_t count, Prompts& prompts) {
  const std::vector<Vec2f> not_in = thinned(joined(pixels.out, pixels.unknown), kOthers);
  const std::vector<Vec2f> in = thinned(pixels.in, kOthers);
  choose(candidates(pixels.in, not_in), count, prompts.positive);
  std::vector<Candidate> outside = candidates(pixels.out, in);
  const float reach = 2 * extent(pixels.in);
  std::vector<Candidate> near;
  for (const Candidate& c : outside)
    if (c.clearance <= reach) near.push_back(c);
  choose(near.empty() ? outside : near, count, prompts.negative);
}

std::vector<Vec2f> spread(std::span<const Vec2f> pixels, size_t count) {
  if (pixels.empty() || count == 0) return {};
  Vec2f mean{0, 0};
  for (const Vec2f p : pixels) mean.x += p.x / float(pixels.size()), mean.y += p.y / float(pixels.size());
  const auto nearer = [&](Vec2f a, Vec2f b) { return distance(a, mean) < distance(b, mean); };
  std::vector<Vec2f> chosen{*std::min_element(pixels.begin(), pixels.end(), nearer)};
  while (chosen.size() < std::min(count, pixels.size())) {
    const auto closer = [&](Vec2f a, Vec2f b) { return nearest(a, chosen) < nearest(b, chosen); };
    chosen.push_back(*std::max_element(pixels.begin(), pixels.end(), closer));
  }
  return chosen;
}

Vec2f deepest(std::span<const Vec2f> wrong, std::span<const Vec2f> right) {
  const std::vector<Vec2f> others = thinned(right, kOthers);
  Vec2f best = wrong.front();
  float depth = -1;
  for (const Candidate& c : candidates(wrong, others)) {
    if (c.clearance <= depth) continue;
    depth = c.clearance;
    best = c.pixel;
  }
  return best;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/like.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/math/color.h"
#include "engine/edit/handler_colors.h"
#include "engine/edit/part_seeds.h"
#include "model/scene/appearance.h"
#include "model/scene/handler_hits.h"

namespace cei3d {
namespace {

// Difference over the maximum; 1: the limit.
float material_difference(const Material& a, const Material& b, const LikeLimits& limits) {
  return max(abs(a.roughness - b.roughness) / limits.roughness,
             abs(a.metalness - b.metalness) / limits.metalness);
}

float color_difference(Vec3f a, Vec3f b, const LikeLimits& limits) {
  return length(srgb_from_linear(a) - srgb_from_linear(b)) / limits.color;
}

void check_not_everything(std::span<const float> scores, bool color) {
  constexpr double kEverything = 0.995;
  const auto like = std::count_if(scores.begin(), scores.end(), [](float s) { return s >= 0.5f; });
  if (double(like) < kEverything * double(scores.size())) return;
  if (color)
    fail(
        "The object has one material and one color; change those of the whole object, or select a part by "
        "positive clicks.");
  fail(
      "The object has one material; go by the color, too (like color), or select a part by positive clicks "
      "or "
      "a mask.");
}

}  // namespace

std::vector<float> like_scores(const Device& device, const Scene& scene, const PartRequest& r) {
  const std::vector<Hit> clicked = clicked_hits(device, scene, r, std::span(&r.like->pixel, 1));
  const Appearance wanted = appearance_at(device, scene, clicked);
  const Appearance points = appearance_at(device, scene, handler_hits(scene));
  std::vector<float> scores(points.material.size());
  for (size_t i = 0; i < scores.size(); ++i) {
    const LikeLimits& limits = r.options.like;
    float difference = material_difference(points.material[i], wanted.material[0], limits);
    if (r.like->color)
      difference = max(difference, color_difference(points.albedo[i], wanted.albedo[0], limits));
    scores[i] = clamp(1 - 0.5f * difference, 0.0f, 1.0f);
  }
  check_not_everything(scores, r.like->color);
  return scores;
}

}  // namespace cei3d

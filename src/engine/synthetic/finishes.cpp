// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/finishes.h"

#include <cmath>

#include "core/base/error.h"
#include "core/math/brdf.h"
#include "core/math/color.h"
#include "engine/synthetic/names.h"

namespace cei3d {
namespace {

struct NamedFinish {
  const char* region;
  Finish finish;
};
struct FinishSet {
  const char* name;
  std::vector<NamedFinish> finishes;  // the first one is for the regions that have none
};

Vec3f srgb(int r, int g, int b) {
  return linear_from_srgb(Vec3f{float(r) / 255, float(g) / 255, float(b) / 255});
}

// Reflectance along the normal of gold, copper and brass as renderers use it, linear Rec. 709.
constexpr Vec3f kGold{1, 0.766f, 0.336f}, kCopper{0.955f, 0.638f, 0.538f}, kBrass{0.887f, 0.789f, 0.434f};

std::vector<FinishSet> finish_sets() {
  const Material plastic{0.3f, 0.5f, 0}, gloss{0.12f, 0.5f, 0}, clay{0.7f, 0.4f, 0}, copper{0.3f, 0.5f, 1};
  const Vec3f red = srgb(176, 58, 46), rose = srgb(214, 150, 120), navy = srgb(30, 50, 96),
              cream = srgb(230, 220, 190), sand = srgb(190, 140, 100), umber = srgb(120, 76, 50),
              green = srgb(60, 120, 80);
  return {{"plastic",
           {{"body", {plastic, red, rose}}, {"band", {plastic, cream}}, {"lid", {plastic, navy, green}}}},
          {"gloss", {{"body", {gloss, navy, green}}, {"band", {gloss, cream}}, {"lid", {gloss, red}}}},
          {"clay", {{"body", {clay, sand, umber}}, {"band", {clay, cream}}, {"lid", {clay, umber}}}},
          {"copper", {{"body", {copper, kCopper, kCopper * 0.6f}}, {"band", {copper, kCopper * 0.3f}}}},
          {"enamel",
           {{"body", {{0.15f, 0.5f, 0}, navy, srgb(60, 90, 150)}},
            {"band", {{0.2f, 0.5f, 1}, kGold}},
            {"lid", {{0.7f, 0.4f, 0}, sand, umber}},
            {"trim", {{0.35f, 0.5f, 1}, kBrass}}}}};
}

}  // namespace

float pattern_at(Vec3f p) {
  const float wave = std::sin(9 * p.x + 1) * std::sin(8 * p.y + 2) + std::sin(7 * p.z + 3 * p.x);
  const float specks = std::sin(23 * p.x + 2 * p.z) * std::sin(21 * p.y) * std::sin(22 * p.z + 1);
  return specks > 0.75f ? 1.0f : clamp(0.5f + 0.25f * wave, 0.0f, 1.0f);
}

Vec3f albedo_at(const Finish& f, Vec3f p) {
  if (!f.second_color) return f.color;
  const float s = pattern_at(p);
  return f.color * (1 - s) + *f.second_color * s;
}

std::vector<std::string> finish_set_names() {
  std::vector<std::string> names;
  for (const FinishSet& set : finish_sets()) names.push_back(set.name);
  return names;
}

std::vector<Finish> finish_set(const std::string& name, const std::vector<std::string>& regions) {
  for (const FinishSet& set : finish_sets()) {
    if (set.name != name) continue;
    std::vector<Finish> out(regions.size(), set.finishes[0].finish);
    for (const NamedFinish& f : set.finishes)
      for (size_t i = 0; i < regions.size(); ++i)
        if (regions[i] == f.region) out[i] = f.finish;
    return out;
  }
  fail_usage("There is no material '{}'; there are {}.", name, listed(finish_set_names()));
}

void require_valid(const Finish& f, const std::string& region) {
  const auto require = [&](float value, float low, const char* what) {
    if (!(value >= low && value <= 1))
      fail_usage("The {} {} of {} is not in the range from {} to 1.", what, value, region, low);
  };
  require(f.material.roughness, kMinRoughness, "roughness");
  require(f.material.specular, 0, "specular");
  require(f.material.metalness, 0, "metalness");
}

}  // namespace cei3d

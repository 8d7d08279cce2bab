// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/linear_split.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/math/color.h"
#include "engine/reconstruct/appearance/split_system.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

constexpr float kSmoothest = 0.12f, kRoughest = 0.95f;
constexpr double kFar = 1.25;  // a residual this much above the best ends the scan
// A metal explains everything by reflections; of a matte object of many colors it explains as much as a
// dielectric does (dtu24). Of a metal (teapot) it leaves a fifth.
constexpr double kMetalBy = 0.5;

struct Solution {
  SplitUnknowns x;
  std::vector<Vec3f> color;  // of a metal
  double residual = 0;
};

// Solves for one size of the problem.
class Solver {
 public:
  Solver(const Transport& transport, const SurfaceSamples& samples, const LinearSplitOptions& options,
         Progress& progress)
      : mesh_(transport.surface().mesh()),
        rows_(make_split_rows(transport.surface(), samples, options)),
        options_(options),
        progress_(progress),
        system_(mesh_, rows_, options) {
    start_.diffuse.assign(mesh_.positions.size(), {0, 0, 0});
    start_.light.assign(size_t(2) * options.light_height * options.light_height, {0, 0, 0});
  }
  size_t rows() const { return rows_.size(); }

  Solution dielectric(float roughness) {
    system_.set_metal({});
    system_.set_roughness(roughness);
    Solution s{start_, {}, 0};
    system_.solve(s.x, options_.rounds, options_.steps);
    return finish(std::move(s), false);
  }
  Solution metal(float roughness) {
    system_.set_roughness(roughness);
    Solution s{start_, std::vector<Vec3f>(mesh_.positions.size(), Vec3f{0.7f, 0.7f, 0.7f}), 0};
    for (int round = 0; round < 3; ++round) {
      check_cancelled(progress_);
      system_.set_metal(s.color);
      system_.solve(s.x, 3, 8);
      s.color = system_.fit_metal_color(s.x);
    }
    system_.set_metal(s.color);
    return finish(std::move(s), true);
  }
  std::vector<LinearSplit::Trial> trials;

 private:
  Solution finish(Solution s, bool metal) {
    check_cancelled(progress_);
    s.residual = system_.residual(s.x);
    trials.push_back({metal, system_.roughness(), s.residual});
    progress_.log(fmt::format(R"({{"stage":"split","metal":{},"roughness":{:.3f},"residual":{:.3e}}})", metal,
                              system_.roughness(), s.residual));
    return s;
  }
  const Mesh& mesh_;
  std::vector<SplitRow> rows_;
  LinearSplitOptions options_;
  Progress& progress_;
  SplitSystem system_;
  SplitUnknowns start_;
};

// The largest roughness whose non-negative light fits within the tolerance of the best: a smaller one with a
// blurred light fits about as well as the truth, a larger one asks for negative light. A coarse scan, then
// bisection.
template <class F>
float search_roughness(F residual_at, const LinearSplitOptions& o) {
  if (o.fixed_roughness > 0) return o.fixed_roughness;
  std::map<float, double> tried;
  double least = std::numeric_limits<double>::infinity();
  const auto solve = [&](float r) {
    tried[r] = residual_at(r);
    least = std::min(least, tried[r]);
  };
  for (float r = kSmoothest; r < kRoughest && (tried.empty() || tried.rbegin()->second < kFar * least);
       r *= o.scan_step)
    solve(r);
  const auto last_good = [&] {
    auto it = std::prev(tried.end());
    while (it->second > (1 + o.tolerance) * least) --it;
    return it;
  };
  for (int k = 0; k < o.refinements; ++k) {
    const auto good = last_good(), next = std::next(good);
    if (next == tried.end()) break;
    solve(std::sqrt(good->first * next->first));
  }
  return last_good()->first;
}

// Light and a metal's color share a factor per channel that reflections leave open: the light is taken to be
// gray on average.
void make_light_gray(Solution& s, int height) {
  Vec3f mean{0, 0, 0};
  for (int i = 0; i < height; ++i)
    for (int j = 0; j < 2 * height; ++j)
      mean += s.x.light[size_t(i) * 2 * height + j] * env_solid_angle(i, 2 * height, height);
  const float gray = luminance(mean);
  for (int c = 0; c < 3; ++c) {
    const float k = gray / max(mean[c], 1e-6f * gray);
    for (Vec3f& l : s.x.light) l[c] *= k;
    for (Vec3f& a : s.color) a[c] /= k;
  }
  // No reflectance above one: the brightest hundredth decides the common scale.
  std::vector<float> peak;
  for (const Vec3f& a : s.color) peak.push_back(std::max({a.x, a.y, a.z}));
  std::nth_element(peak.begin(), peak.begin() + peak.size() * 99 / 100, peak.end());
  const float k = max(1.0f, peak[peak.size() * 99 / 100]);
  for (Vec3f& l : s.x.light) l = l * k;
  for (Vec3f& a : s.color) a = a / k;
}

// Base colors of a dielectric, unclamped: what it sends out diffusely over what reaches it.
std::vector<Vec3f> base_colors(const Transport& transport, const LinearSplit& r) {
  const std::vector<Vec3f> sky = transport.sky(sky_radiance(r.light)), bounce = transport.bounce(r.diffuse);
  std::vector<Vec3f> color(r.diffuse.size());
  for (size_t v = 0; v < color.size(); ++v)
    for (int c = 0; c < 3; ++c) color[v][c] = kPi * r.diffuse[v][c] / max(sky[v][c] + bounce[v][c], 1e-4f);
  return color;
}

float percentile(std::vector<float> values, double share) {
  const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Reflections show the product of light and specular reflectance; the split takes specular 0.5 for granted.
// On surfaces that reflect less the light comes out too dark, and more diffuse light leaves them than
// arrives. No base color is above one: that bounds the light from below, and the specular reflectance from
// above.
void brighten_light(const Transport& transport, LinearSplit& r) {
  constexpr double kShare = 0.98;  // of the surface is believed
  constexpr int kRounds = 3;       // the bounce does not scale with the light
  float all = 1;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Vec3f> color = base_colors(transport, r);
    Vec3f gain;
    for (int c = 0; c < 3; ++c) {
      std::vector<float> channel(color.size());
      for (size_t v = 0; v < color.size(); ++v) channel[v] = color[v][c];
      gain[c] = max(percentile(std::move(channel), kShare), 1.0f);
    }
    for (size_t i = 0; i < r.light.data.size(); ++i) r.light.data[i] *= gain[int(i % 3)];
    all *= luminance(gain);
  }
  r.material.specular /= all;
}

Image to_image(const std::vector<Vec3f>& light, int height) {
  Image map(2 * height, height, 3);
  for (size_t i = 0; i < light.size(); ++i)
    for (int c = 0; c < 3; ++c) map.data[3 * i + c] = light[i][c];
  return map;
}

std::vector<Vec3f> clamped(std::vector<Vec3f> v, float high) {
  for (Vec3f& x : v)
    for (int c = 0; c < 3; ++c) x[c] = clamp(x[c], 0.0f, high);
  return v;
}

}  // namespace

SkyRadiance sky_radiance(const Image& light) {
  const auto& sky = sky_directions();
  SkyRadiance sum(sky.size(), Vec3f{0, 0, 0});
  std::vector<float> total(sky.size(), 0);
  // A pixel feeds the directions around it by a narrow lobe about as wide as their spacing.
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x) {
      const Vec3f d = env_direction(float(x) + 0.5f, float(y) + 0.5f, light.width, light.height);
      const float area = env_solid_angle(y, light.width, light.height);
      for (size_t k = 0; k < sky.size(); ++k) {
        const float c = dot(d, sky[k]);
        if (c < 0.95f) continue;
        const float w = area * std::exp(256 * (c - 1));
        sum[k] += light.rgb(x, y) * w;
        total[k] += w;
      }
    }
  for (size_t k = 0; k < sky.size(); ++k) sum[k] = sum[k] / total[k];
  return sum;
}

LinearSplit linear_split(const Transport& transport, const SurfaceSamples& samples,
                         const LinearSplitOptions& options, Progress& progress) {
  const Mesh& mesh = transport.surface().mesh();
  LinearSplitOptions coarse = options;
  coarse.most_hits = options.search_hits;
  coarse.light_height = options.search_height;
  Solver search(transport, samples, coarse, progress);
  if (search.rows() < 1000)
    fail("only {} pixels see the surface well enough to tell light from material; are masks and poses right?",
         search.rows());
  const double dielectric_residual = search.dielectric(0.2f).residual,
               metal_residual = search.metal(0.2f).residual;
  LinearSplit result;
  const bool is_metal = metal_residual < kMetalBy * dielectric_residual;
  const float roughness = search_roughness(
      [&](float r) { return (is_metal ? search.metal(r) : search.dielectric(r)).residual; }, options);
  Solver fine(transport, samples, options, progress);
  Solution solution = is_metal ? fine.metal(roughness) : fine.dielectric(roughness);
  if (is_metal) {
    make_light_gray(solution, options.light_height);
    result.material = {roughness, 0.5f, 1};
    result.light = to_image(solution.x.light, options.light_height);
    result.albedo = clamped(solution.color, 1);
    result.diffuse.assign(mesh.positions.size(), {0, 0, 0});
  } else {
    result.material = {roughness, 0.5f, 0};
    result.light = to_image(solution.x.light, options.light_height);
    result.diffuse = clamped(solution.x.diffuse, 1e6f);
    brighten_light(transport, result);
    result.albedo = clamped(base_colors(transport, result), 1);
  }
  result.trials = std::move(search.trials);
  result.trials.insert(result.trials.end(), fine.trials.begin(), fine.trials.end());
  return result;
}

}  // namespace cei3d

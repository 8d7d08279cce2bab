// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/linear_split.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/math/color.h"
#include "core/math/parabola.h"
#include "core/math/quantile.h"
#include "engine/reconstruct/appearance/shading_light.h"
#include "engine/reconstruct/appearance/split_irradiance.h"
#include "engine/reconstruct/appearance/split_solver.h"
#include "model/geometry/shape/vec_json.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

constexpr float kSmoothest = 0.12f, kRoughest = 0.95f;
constexpr double kFar = 1.25;  // a residual this much above the best ends the scan
// Maximum ratio of the residuals of a metal and a dielectric for an object to be a metal. On a matte object
// of many colors the ratio is 1 (dtu24), on a metal 0.2 (teapot).
constexpr double kMaxMetalRatio = 0.5;
// Several materials always fit a little better than one. They are chosen only if the residual falls below
// this factor, and by more than the noise of good photographs, 40 dB.
constexpr double kMaxSeveralRatio = 0.75, kNoise = 1e-4;
// This factor where they are expected: a surface that was polished with several materials should not be
// explained by one after all because of noise.
constexpr double kMaxExpectedRatio = 0.85;
// If the light was scaled up by more than this to keep the albedo at most 1, its strength is unknown.
constexpr float kMaxKnownGain = 1.1f;
// If the light was scaled up by more than this, it has faded in the separation: reflections do not determine
// it. White paint raises it by kMaxGain at most.
constexpr float kMaxGain = 4, kFaded = 1.1f * kMaxGain;
// Systematic error of the light, as a share of the unexplained variance over that explained by reflections,
// as for errors of regressors.
constexpr double kSharedError = 0.1;
// The search for several materials stops if its first rounds leave a larger share than this of the residual
// of one material, unless several are expected: on objects of one material .91 and more, of several up to .88
// (docs/notebook/0051-gaps-up-to-their-outline.md).
constexpr double kMaxFirstRoundRatio = 0.9;
// The roughness is the largest whose residual is so close to the smallest, relatively, where photographs are
// explained worse than to 25 dB: what shape and reflections of the object in itself leave unexplained is
// smallest for surfaces that are too smooth. Where they are explained well, the smallest residual is nearer
// to the truth.
constexpr double kTolerance = 0.008, kBadlyExplained = 3e-3;
// Maximum roughness of the one material with which the search for several materials begins.
constexpr float kFirstRoughness = 0.3f;

// The roughness of the smallest residual, or the largest within the tolerance of it: a coarse scan, refined
// about the smallest, and a parabola through it and its neighbors over the logarithm.
template <class F>
float search_roughness(F residual_at, const LinearSplitOptions& o) {
  if (o.fixed_roughness > 0) return o.fixed_roughness;
  std::map<float, double> tried;
  const auto smallest = [&] {
    return std::min_element(tried.begin(), tried.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; });
  };
  const auto solve = [&](float r) { tried[r] = residual_at(r); };
  for (float r = kSmoothest;
       r < kRoughest && (tried.empty() || tried.rbegin()->second < kFar * smallest()->second);
       r *= o.scan_step)
    solve(r);
  for (int k = 0; k < o.refinements; ++k) {
    const auto best = smallest(), next = std::next(best);
    if (best != tried.begin()) solve(std::sqrt(std::prev(best)->first * best->first));
    if (next != tried.end()) solve(std::sqrt(best->first * next->first));
  }
  const auto best = smallest(), next = std::next(best);
  const double rise = kTolerance * std::min(1.0, best->second / kBadlyExplained) * best->second;
  auto last = std::prev(tried.end());
  while (last->second > best->second + rise) --last;
  if (best == tried.begin() || next == tried.end()) return last->first;
  const double steps = last_offset_within(std::prev(best)->second, best->second, next->second, rise);
  const float between = best->first * float(std::pow(next->first / best->first, steps));
  return last == best ? between : std::max(last->first, between);
}

// Reflections of metals determine light and color only up to a factor per channel: the mean of the light is
// assumed to be gray.
void make_light_gray(SplitSolution& s, int height) {
  Vec3f mean{0, 0, 0};
  for (int i = 0; i < height; ++i)
    for (int j = 0; j < 2 * height; ++j)
      mean += s.x.light[size_t(i) * 2 * height + j] * env_solid_angle(i, 2 * height, height);
  const float gray = luminance(mean);
  for (int c = 0; c < 3; ++c) {
    const float k = gray / max(mean[c], 1e-6f * gray);
    for (Vec3f& l : s.x.light) l[c] *= k;
    for (Vec3f& a : s.materials.color) a[c] /= k;
  }
  // No reflectance above one: the brightest hundredth decides the common scale.
  std::vector<float> peak;
  for (const Vec3f& a : s.materials.color) peak.push_back(std::max({a.x, a.y, a.z}));
  const size_t rank = peak.size() * 99 / 100;
  const float k = max(1.0f, value_of_rank(std::move(peak), rank));
  for (Vec3f& l : s.x.light) l = l * k;
  for (Vec3f& a : s.materials.color) a = a / k;
}

// Albedo of the vertices: pi D over irradiance, not clamped, for dielectrics.
std::vector<Vec3f> vertex_albedo(const Transport& transport, const SplitSolution& s, int height,
                                 const LightTurns* turns) {
  const std::vector<Vec3f> irradiance = split_irradiance(transport, s.x, s.materials, height, turns);
  std::vector<Vec3f> color = s.materials.color;
  for (uint32_t v = 0; v < color.size(); ++v)
    for (int c = 0; c < 3 && !s.materials.is_metal(v); ++c)
      color[v][c] = kPi * s.x.diffuse[v][c] / max(irradiance[v][c], 1e-4f);
  return color;
}

// The vertex nearest to each sample: weights vertices by how often they are seen.
std::vector<uint32_t> seen_vertices(const Mesh& mesh, const SurfaceSamples& samples) {
  std::vector<uint32_t> seen;
  for (const Hit& h : samples.hits) seen.push_back(nearest_corner(mesh.triangles[h.triangle], h.b1, h.b2));
  return seen;
}

// By how much the mean squared error of the samples, in display units, grows if no color exceeds `limit`.
double clamping_error(const std::vector<Vec3f>& color, const std::vector<Vec3f>& irradiance,
                      const std::vector<uint32_t>& seen, float limit) {
  const auto display = [](float radiance) { return double(srgb_from_linear(min(radiance, 1.0f))); };
  double sum = 0;
  for (const uint32_t v : seen)
    for (int c = 0; c < 3; ++c) {
      if (color[v][c] <= limit) continue;
      const float white = irradiance[v][c] / kPi;
      sum += square(display(color[v][c] * white) - display(limit * white));
    }
  return sum / double(3 * std::max<size_t>(seen.size(), 1));
}

// The largest of the channels' quantiles of the albedo of dielectrics; 0: there are none.
float bright_albedo(const std::vector<Vec3f>& color, const SplitMaterials& materials,
                    const std::vector<uint32_t>& seen, double share) {
  float largest = 0;
  for (int c = 0; c < 3; ++c) {
    std::vector<float> channel;
    for (const uint32_t v : seen)
      if (!materials.is_metal(v)) channel.push_back(color[v][c]);
    if (channel.empty()) return 0;
    largest = max(largest, quantile(std::move(channel), share));
  }
  return largest;
}

// Reflections determine the product of light and specular reflectance; the separation assumes kUsualSpecular,
// and colors of metals are free. On surfaces that reflect less, or where paint was taken for metal, the light
// comes out too dark and colors above 1. That no color exceeds 1 raises the light and lowers the specular
// reflectance: until it holds for most dielectrics, and costs little in the images for all that is seen.
// Errors of surface that receives little light do not count much there.
float brighten_light(const Transport& transport, const std::vector<uint32_t>& seen, SplitSolution& s,
                     int height, const LightTurns* turns, Progress& progress) {
  constexpr double kKept = 0.98;  // share of the dielectric samples
  constexpr double kCost = 0.02;  // share of the residual that the bound may add to it
  constexpr float kStep = 1.02f;
  constexpr int kRounds = 3;  // the bounce does not scale with the light
  float all = 1;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Vec3f> color = vertex_albedo(transport, s, height, turns),
                             irradiance = split_irradiance(transport, s.x, s.materials, height, turns);
    // Common to all channels: the albedo does not determine the color of the light.
    float gain = max(1.0f, bright_albedo(color, s.materials, seen, kKept));
    while (all * gain < kMaxGain && clamping_error(color, irradiance, seen, gain) > kCost * s.residual)
      gain *= kStep;
    for (Vec3f& l : s.x.light) l = l * gain;
    for (Vec3f& a : s.materials.color) a = a / gain;
    all *= gain;
  }
  for (Material& m : s.materials.of) m.specular /= all;
  progress.log(Json{{"stage", "light strength"}, {"gain", all}}.dump());
  return all;
}

std::vector<Vec3f> clamped(std::vector<Vec3f> v, float high) {
  for (Vec3f& x : v)
    for (int c = 0; c < 3; ++c) x[c] = clamp(x[c], 0.0f, high);
  return v;
}

LinearSplitOptions material_search_options(const LinearSplitOptions& options) {
  LinearSplitOptions o = options;
  o.max_hits = options.material_hits;
  o.light_height = options.search_height;
  return o;
}

LinearSplitOptions search_options(const LinearSplitOptions& options) {
  LinearSplitOptions o = material_search_options(options);
  o.max_hits = options.search_hits;
  o.in_patches = true;
  return o;
}

struct OneMaterial {
  bool is_metal;
  float roughness;
};

// guess: the last solution.
OneMaterial search_one_material(SplitSolver search, const LinearSplitOptions& options,
                                std::vector<LinearSplit::Trial>& trials, SplitGuess& guess) {
  if (search.rows() < 1000)
    fail("Only {} pixels see the surface well enough to tell light from material. Are masks and poses right?",
         search.rows());
  const double dielectric_residual = search.dielectric(0.2f).residual,
               metal_residual = search.metal(0.2f).residual;
  const bool is_metal = metal_residual < kMaxMetalRatio * dielectric_residual;
  const float roughness = search_roughness(
      [&](float r) { return (is_metal ? search.metal(r) : search.dielectric(r)).residual; }, options);
  trials = std::move(search.trials);
  guess = search.last();
  return {is_metal, roughness};
}

// None where one material is sufficient. guess: the last solution.
std::optional<SplitMaterials> search_materials(SplitSolver search, const OneMaterial& found, bool expected,
                                               SplitGuess& guess) {
  const auto one = [&](float roughness) {
    return found.is_metal ? search.metal(roughness) : search.dielectric(roughness);
  };
  SplitSolution start = one(found.roughness);
  if (start.residual < kNoise) return {};
  const double max_residual =
      expected ? std::numeric_limits<double>::infinity() : kMaxFirstRoundRatio * start.residual;
  if (found.roughness > kFirstRoughness) start = one(kFirstRoughness);
  SplitSolution several = search.several(std::move(start), max_residual);
  if (several.residual > max_residual) return {};
  guess = search.last();
  return std::move(several.materials);
}

// A few dielectric vertices say nothing of the light.
bool all_metal(const SplitSolution& s) { return s.materials.metal_share() > 1 - kFewVertices; }

// Combines the prior of the light's color with the estimate from the samples and scales the light. Returns
// the remaining covariance.
LightCovariance correct_light(SplitSolver& solver, const LinearSplitOptions& options, SplitSolution& s,
                              Progress& progress) {
  if (all_metal(s)) return {};
  LightScale evidence = solver.light_correction(s);
  // The common strength was already combined with the colors of the metals.
  if (s.materials.metal_share() > 0)
    evidence.factor = evidence.factor / std::cbrt(evidence.factor.x * evidence.factor.y * evidence.factor.z);
  for (int c = 0; c < 3; ++c)
    evidence.covariance.row[c][c] +=
        square(kSharedError * std::min(s.residual / std::max(evidence.reflected[c], 1e-12), 20.0));
  Vec3f mean{0, 0, 0};
  for (size_t i = 0; i < s.x.light.size(); ++i)
    mean += s.x.light[i] * env_solid_angle(int(i) / (2 * options.light_height), 2 * options.light_height,
                                           options.light_height);
  const LightBelief belief = weigh_light_color(evidence, mean, options.light_color);
  solver.scale_light(s, belief.factor);
  progress.log(
      Json{{"stage", "light color"},
           {"evidence", vector_json(evidence.factor)},
           {"evidence_error", vector_json(relative_error(evidence.covariance).value_or(Vec3f{0, 0, 0}))},
           {"factor", vector_json(belief.factor)}}
          .dump());
  return belief.covariance;
}

struct Solved {
  SplitSolution solution;
  LightCovariance light_error;
};

// The solution of the final size, its materials found by searches of smaller ones.
Solved solve(const Transport& transport, const SurfaceSamples& samples, const LinearSplitOptions& options,
             Progress& progress, std::vector<LinearSplit::Trial>& trials) {
  SplitGuess guess;
  const auto solver = [&](const LinearSplitOptions& o) {
    return SplitSolver(transport, samples, o, progress, guess);
  };
  const OneMaterial found = search_one_material(solver(search_options(options)), options, trials, guess);
  std::optional<SplitMaterials> materials;
  if (options.fixed_roughness <= 0)
    materials =
        search_materials(solver(material_search_options(options)), found, options.several_expected, guess);
  SplitSolver fine = solver(options);
  SplitSolution best = found.is_metal ? fine.metal(found.roughness) : fine.dielectric(found.roughness);
  trials.insert(trials.end(), fine.trials.begin(), fine.trials.end());
  if (materials) {
    SplitSolution several = fine.with_materials(*materials);
    progress.log(Json{{"stage", "materials"}, {"one", best.residual}, {"several", several.residual}}.dump());
    if (several_explain_more(best.residual, several.residual, options.several_expected))
      best = std::move(several);
  }
  const LightCovariance error = correct_light(fine, options, best, progress);
  return {std::move(best), error};
}

Material mean_of(const std::vector<Material>& materials) {
  double roughness = 0, specular = 0, metalness = 0;
  for (const Material& m : materials)
    roughness += m.roughness, specular += m.specular, metalness += m.metalness;
  const double n = double(materials.size());
  return {float(roughness / n), float(specular / n), float(metalness / n)};
}

float smoothest_of(const std::vector<Material>& materials) {
  std::vector<float> roughness;
  for (const Material& m : materials) roughness.push_back(m.roughness);
  return quantile(std::move(roughness), 0.01);
}

LinearSplit result_of(const Transport& transport, SplitSolution s, const LinearSplitOptions& options,
                      const LightTurns* turns) {
  LinearSplit result;
  const auto& of = s.materials.of;
  result.material = mean_of(of);
  if (std::any_of(of.begin(), of.end(), [&](const Material& m) { return !(m == of.front()); }))
    result.materials = of;
  else
    result.material = of.front();
  result.smoothest = smoothest_of(of);
  result.light = light_image(s.x.light, options.light_height);
  result.albedo = clamped(vertex_albedo(transport, s, options.light_height, turns), 1);
  result.diffuse = std::move(s.x.diffuse);
  return result;
}

// gain: factor by which the light was scaled up in the end.
LinearSplit separate(const Transport& transport, const SurfaceSamples& samples,
                     const LinearSplitOptions& options, Progress& progress, float& gain) {
  std::vector<LinearSplit::Trial> trials;
  auto [s, light_error] = solve(transport, samples, options, progress, trials);
  const LightTurns* turns = samples.turned.turns;
  s.x.diffuse = clamped(std::move(s.x.diffuse), 1e6f);
  if (all_metal(s))
    make_light_gray(s, options.light_height);
  else
    gain = brighten_light(transport, seen_vertices(transport.surface().mesh(), samples), s,
                          options.light_height, turns, progress);
  LinearSplit result = result_of(transport, std::move(s), options, turns);
  result.trials = std::move(trials);
  if (gain <= kMaxKnownGain) result.light_error = light_error;
  return result;
}

// For a light that has faded: the one that the shading shows, and the roughness that explains best under it
// how the surface looks from different sides.
LinearSplit separate_by_shading(const Transport& transport, const SurfaceSamples& samples,
                                const LinearSplitOptions& options, Progress& progress, LinearSplit faded) {
  SkyRadiance sky = light_of_shading(transport, faded.diffuse, options.seed).sky;
  if (const Vec3f color = options.light_color.color; options.light_color.kind == LightColorPrior::Kind::known)
    for (Vec3f& l : sky) l = l * color / luminance(color);
  const LinearSplitOptions fewer = search_options(options);
  SplitSolver search(transport, samples, fewer, progress), fine(transport, samples, options, progress);
  const float roughness = search_roughness(
      [&](float r) { return search.under_light(grid_of_sky(sky, fewer.light_height), r).residual; }, fewer);
  LinearSplit result =
      result_of(transport, fine.under_light(grid_of_sky(sky, options.light_height), roughness), options,
                samples.turned.turns);
  result.trials = std::move(faded.trials);
  return result;
}

}  // namespace

std::vector<double> held_out_residuals(const Transport& transport, const SurfaceSamples& samples,
                                       const LinearSplitOptions& options, float roughness,
                                       bool several_materials, Progress& progress) {
  SplitSolver solver(transport, samples, options, progress);
  SplitSolution s = solver.dielectric(roughness);
  if (several_materials) s = solver.several(std::move(s), std::numeric_limits<double>::infinity());
  std::vector<double> out;
  for (const SplitSystem::ViewError& e : solver.errors_of_views(s))
    if (e.count > 0) out.push_back(e.mean());
  return out;
}

bool several_explain_more(double one, double several, bool expected) {
  const double ratio = expected ? kMaxExpectedRatio : kMaxSeveralRatio;
  return several < std::min(ratio * one, one - kNoise);
}

LinearSplit linear_split(const Transport& transport, const SurfaceSamples& samples,
                         const LinearSplitOptions& options, Progress& progress) {
  float gain = 1;
  LinearSplit result = separate(transport, samples, options, progress, gain);
  if (gain < kFaded || options.fixed_roughness > 0 || samples.turned.turns) return result;
  progress.log(Json{{"stage", "light faded"}, {"gain", gain}}.dump());
  return separate_by_shading(transport, samples, options, progress, std::move(result));
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/split_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/math/color.h"
#include "core/math/quantile.h"
#include "engine/reconstruct/appearance/split_irradiance.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

// Rounds of materials and light go on as long as each plain round lowers the residual below kArrived of that
// of the plain round before. Convergence is slow: a light that is too sharp and surfaces that are too rough
// explain the photographs nearly as well as the truth, so that each round removes at most a fifth of the
// error (docs/notebook/0022). Therefore every second round extrapolates the logarithm of the roughness by
// kExtended. The plain rounds between correct overshoot (docs/notebook/0035), and they alone set the strength
// of the light: with more of them it would drift where dielectrics hardly determine it.
constexpr int kMinRounds = 6, kMaxRounds = 20;
constexpr double kArrived = 0.98;
constexpr float kExtended = 4;
// Rounds of linearization for a turning light: without a guess, and with one.
constexpr int kFirstTurns = 3, kTurns = 2;
constexpr int kDiffusion = 20;  // steps, of evidence over the surface
// Steps of metal_probability(). In the first rounds, under a light that is still wrong, each vertex decides
// for itself (docs/notebook/0039).
constexpr int kWalk = 150;
// Ratio of the errors of a metal and a dielectric at which a vertex is as likely one as the other.
constexpr float kEvenRatio = 0.85f;
// Upper bounds of the diffuse albedo of a vertex, in multiples of white: while the scale of the light is
// uncertain, and afterwards.
constexpr float kFirstWhite = 3, kLastWhite = 1.3f;
// Minimum reflectance under a given light, over the usual one: the smallest that light_scale() can tell from
// 0. On a surface without reflections, those of a smooth light cost more than they add (docs/notebook/0033).
constexpr float kMinReflected = 0.05f;

std::vector<uint8_t> corners_of(const std::vector<SplitRow>& rows, size_t vertices) {
  std::vector<uint8_t> out(vertices, 0);
  for (const SplitRow& row : rows)
    for (const auto& corners : {row.vertices, row.far_vertices})
      for (const uint32_t v : corners) out[v] = 1;
  return out;
}

}  // namespace

SplitSolver::SplitSolver(const Transport& transport, const SurfaceSamples& samples,
                         const LinearSplitOptions& options, Progress& progress, SplitGuess guess)
    : transport_(transport),
      mesh_(transport.surface().mesh()),
      colors_(mean_colors(mesh_, samples, options)),
      rows_(make_split_rows(transport.surface(), samples, options, colors_)),
      options_(options),
      progress_(progress),
      system_(mesh_, rows_, options),
      at_rows_(options.in_patches ? corners_of(rows_, mesh_.positions.size()) : std::vector<uint8_t>()),
      guess_(std::move(guess)) {
  if (const LightTurns* turns = samples.turned.turns)
    turning_ = std::make_unique<TurningIrradiance>(transport, *turns, options.light_height, at_rows_);
}

SplitUnknowns SplitSolver::uniform() const {
  Vec3f mean{0, 0, 0};
  for (const SplitRow& r : rows_) mean += r.color / float(rows_.size());
  const size_t cells = size_t(2) * options_.light_height * options_.light_height;
  return {colors_, std::vector<Vec3f>(cells, mean)};
}

SplitSolution SplitSolver::guess(SplitMaterials materials) {
  if (guess_.light.width == 0) return {uniform(), std::move(materials)};
  SplitSolution s{guessed(), std::move(materials)};
  turn_diffuse_light(s);
  return s;
}

SplitUnknowns SplitSolver::guessed() const {
  const int height = options_.light_height, width = 2 * height;
  SplitUnknowns x{guess_.diffuse, {}};
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      x.light.push_back(
          env_radiance(guess_.light, env_direction(float(column) + 0.5f, float(row) + 0.5f, width, height)));
  return x;
}

void SplitSolver::remember(const SplitUnknowns& x) {
  guess_ = {x.diffuse, light_image(x.light, options_.light_height)};
}

SplitSolution SplitSolver::solved(SplitSolution s, int rounds, int steps) {
  check_cancelled(progress_);
  system_.set_light(s.x.light);
  system_.set_materials(s.materials);
  system_.solve(s.x, rounds, steps);
  turn_diffuse_light(s);
  return s;
}

void SplitSolver::turn_diffuse_light(const SplitSolution& s) {
  if (!turning_) return;
  TurningIrradiance::Turned turned = turning_->turn(s.x, s.materials, rows_);
  system_.set_diffuse_light_grad(std::move(turned.grad));
  irradiance_ = std::move(turned.irradiance);
}

SplitSolution SplitSolver::with_fitted_metals(SplitSolution s, int rounds, int steps) {
  s = solved(std::move(s), rounds, steps);
  s.materials.color = system_.fit_metal_color(s.x);
  return s;
}

SplitSolution SplitSolver::finish(SplitSolution s, bool metal, float roughness) {
  check_cancelled(progress_);
  system_.set_materials(s.materials);
  s.residual = system_.residual(s.x);
  trials.push_back({metal, roughness, s.residual});
  progress_.log(fmt::format(R"({{"stage":"split","metal":{},"roughness":{:.3f},"residual":{:.3e}}})", metal,
                            roughness, s.residual));
  return s;
}

SplitSolution SplitSolver::dielectric(float roughness) {
  const bool first = guess_.light.width == 0;
  SplitSolution s = guess(one_material(mesh_.positions.size(), {roughness, kUsualSpecular, 0}));
  const int turns = !turning_ ? 1 : first ? kFirstTurns : kTurns;
  for (int turn = 0; turn < turns; ++turn)
    s = solved(std::move(s), turning_ ? 2 : options_.rounds, options_.steps);
  remember(s.x);
  return finish(std::move(s), false, roughness);
}

SplitSolution SplitSolver::metal(float roughness) {
  SplitSolution s{uniform(), one_material(mesh_.positions.size(), {roughness, kUsualSpecular, 1})};
  system_.set_diffuse_light_grad({});  // metals have no diffuse light
  for (int round = 0; round < 3; ++round) s = with_fitted_metals(std::move(s), 3, 8);
  return finish(std::move(s), true, roughness);
}

SplitSolution SplitSolver::under_light(const std::vector<Vec3f>& light, float roughness) {
  SplitSolution s{{colors_, light}, one_material(mesh_.positions.size(), {roughness, kUsualSpecular, 0})};
  system_.set_light(light);
  system_.set_materials(s.materials);
  const LightScale found = lit_samples(s.x).light_scale(s.materials, mesh_.positions);
  const bool known = found.covariance.row[0].x < 1;
  const float share = known ? clamp(luminance(found.factor), kMinReflected, 1.0f) : kMinReflected;
  SplitUnknowns as_reflected = s.x;
  for (Vec3f& l : as_reflected.light) l = l * share;
  s.x.diffuse = lit_samples(as_reflected).fit_diffuse(s.materials, s.x.diffuse);
  for (Material& m : s.materials.of) m.specular *= share;
  s = finish(std::move(s), false, roughness);
  progress_.log(Json{{"stage", "light from shading"}, {"roughness", roughness}, {"reflected", share}}.dump());
  return s;
}

std::vector<Vec3f> SplitSolver::white_radiance(const SplitSolution& s, float albedo) const {
  std::vector<Vec3f> out =
      turning_ ? irradiance_
               : split_irradiance(transport_, s.x, s.materials, options_.light_height, nullptr, at_rows_);
  for (Vec3f& e : out) e = e * (albedo / kPi);
  return out;
}

LitSamples SplitSolver::lit_samples(const SplitUnknowns& x) {
  return LitSamples(mesh_.positions.size(), rows_, system_.targets(x), system_.blurs(), x.light);
}

// A vertex far from all samples keeps its material.
void SplitSolver::choose_materials(const SplitUnknowns& x, const SimilarNeighbors& near, bool settled,
                                   float extended, SplitMaterials& materials) {
  const std::vector<Vec3f> white = white_radiance({x, materials, 0}, settled ? kLastWhite : kFirstWhite);
  MaterialEvidence evidence = lit_samples(x).evidence(white);
  diffuse_evidence(near, kDiffusion, evidence);
  const std::vector<float> metals = metal_probability(near, evidence, kEvenRatio, settled ? kWalk : 0);
  for (size_t v = 0; v < materials.of.size(); ++v) {
    if (evidence.samples[v] <= 0) continue;
    const BestMaterials b = best_materials(evidence.of(v));
    const bool metal = metals[v] > 0.5f;
    float roughness = metal ? b.metal_roughness : b.dielectric_roughness;
    if (const float before = materials.of[v].roughness; metal == materials.is_metal(uint32_t(v)))
      roughness = clamp(before * std::pow(roughness / before, extended), BlurLadder::roughness(0),
                        BlurLadder::roughness(BlurLadder::kLevels - 1));
    materials.of[v] = {roughness, kUsualSpecular, metal ? 1.0f : 0.0f};
  }
}

namespace {

void scale(SplitSolution& s, Vec3f factor) {
  for (Vec3f& l : s.x.light) l = l * factor;
  for (Vec3f& a : s.materials.color) a = a / factor;
}

}  // namespace

// D of dielectrics changes by the change of the best fit per vertex: that fit is noisy, its change is not.
void SplitSolver::scale_light(SplitSolution& s, Vec3f factor) {
  system_.set_materials(s.materials);
  const std::vector<Vec3f> before = lit_samples(s.x).fit_diffuse(s.materials, s.x.diffuse);
  scale(s, factor);
  const std::vector<Vec3f> after = lit_samples(s.x).fit_diffuse(s.materials, s.x.diffuse);
  for (size_t v = 0; v < before.size(); ++v)
    for (int c = 0; c < 3; ++c) s.x.diffuse[v][c] = max(s.x.diffuse[v][c] + after[v][c] - before[v][c], 0.0f);
}

namespace {

// The brightest channel of colored metals, as a high quantile over vertices, because patina and dirt only
// darken; 0 if there are few. Gray metals are not used: their reflectance is anywhere between .5 and .97.
float colored_metal_peak(const SplitMaterials& materials) {
  constexpr float kColored = 1.25f;  // ratio of the brightest and the darkest channel
  constexpr double kClean = 0.7;     // the quantile; estimates of vertices scatter
  std::vector<float> peaks;
  for (uint32_t v = 0; v < materials.of.size(); ++v) {
    if (!materials.is_metal(v)) continue;
    const Vec3f c = materials.color[v];
    const float peak = max(c.x, max(c.y, c.z));
    if (peak > kColored * min(c.x, min(c.y, c.z))) peaks.push_back(peak);
  }
  if (double(peaks.size()) < kFewVertices * double(materials.of.size())) return 0;
  const auto rank = size_t(kClean * double(peaks.size()));
  return value_of_rank(std::move(peaks), rank);
}

}  // namespace

// Reflections of metals do not determine the scale of the light. Those of dielectrics determine it per
// channel; the colors of metals determine a common factor: colored metals are gold, copper and their alloys,
// whose brightest channel reflects .89 to 1 (docs/method.md#materials). The two are combined by inverse
// variance.
void SplitSolver::fix_scale(SplitSolution& s) {
  constexpr float kPeak = 0.94f;
  constexpr float kPeakError = 0.2f, kDielectricError = 0.1f;  // standard deviations of the logarithms
  if (s.materials.metal_share() > 1 - kFewVertices) return;    // decided after the separation
  const Vec3f of_dielectrics = lit_samples(s.x).light_scale(s.materials, mesh_.positions).factor;
  scale(s, of_dielectrics);
  const float peak = colored_metal_peak(s.materials);
  progress_.log(Json{
      {"stage", "scale"},
      {"dielectrics", {of_dielectrics.x, of_dielectrics.y, of_dielectrics.z}},
      {"metal_peak",
       peak}}.dump());
  if (peak <= 0) return;
  const float share = square(kDielectricError) / (square(kDielectricError) + square(kPeakError));
  const float common = std::pow(peak / kPeak, share);
  scale(s, {common, common, common});
}

LightScale SplitSolver::light_correction(const SplitSolution& s) {
  system_.set_materials(s.materials);
  return lit_samples(s.x).light_correction(s.materials, mesh_.positions);
}

SplitSolution SplitSolver::several(SplitSolution s, double max_residual) {
  const SimilarNeighbors near(mesh_, colors_);
  double before = std::numeric_limits<double>::infinity();
  system_.set_materials(s.materials);
  for (int round = 0; round < kMaxRounds; ++round) {
    check_cancelled(progress_);
    const bool extended = round % 2 == 0;
    choose_materials(s.x, near, round + 1 >= kMinRounds, extended ? kExtended : 1, s.materials);
    system_.set_materials(s.materials);
    s.materials.color = system_.fit_metal_color(s.x);
    if (!extended) fix_scale(s);
    s = solved(std::move(s), 2, 8);
    s.residual = system_.residual(s.x);
    progress_.log(Json{{"stage", "materials"}, {"round", round}, {"residual", s.residual}}.dump());
    if (extended) continue;
    if (s.residual > max_residual) return s;
    if (round + 1 >= kMinRounds && s.residual > kArrived * before) break;
    before = s.residual;
  }
  remember(s.x);
  return s;
}

SplitSolution SplitSolver::with_materials(const SplitMaterials& materials) {
  SplitSolution s = guess(materials);
  for (int round = 0; round < 3; ++round) {
    s = with_fitted_metals(std::move(s), 3, 8);
    fix_scale(s);
  }
  system_.set_materials(s.materials);
  s.residual = system_.residual(s.x);
  return s;
}

}  // namespace cei3d

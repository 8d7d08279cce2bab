// SPDX-License-Identifier: Apache-2.0
#include "model/light/light_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "core/base/error.h"

namespace cei3d {
namespace {

// Standard deviation of the logarithms of red over green and blue over green. By that daylight of 5000 and of
// 9000 K, without white balance, is off from that of 6500 K in its blue.
constexpr double kNearWhite = 0.3;
constexpr double kKnown = 1e-3;  // standard deviation for a given color
constexpr double kSplit = 0.7;  // standard deviation of the logarithm of the strength, without other evidence
// Error of the reflection model, independent per channel, relative.
constexpr double kModelError = 0.04;

// From the logarithms of the channels to those of red over green and blue over green.
constexpr std::array<std::array<double, 3>, 2> kRatios = {{{1, -1, 0}, {0, -1, 1}}};

Mat3d with_diagonal(Mat3d m, double add) {
  m.row[0].x += add;
  m.row[1].y += add;
  m.row[2].z += add;
  return m;
}

}  // namespace

std::string light_color_text(const LightColorPrior& p) {
  if (p.kind == LightColorPrior::Kind::free) return "free";
  if (p.kind == LightColorPrior::Kind::near_white) return "near-white";
  return fmt::format("{:g},{:g},{:g}", p.color.x, p.color.y, p.color.z);
}

std::optional<LightColorPrior> light_color_from(const std::string& text) {
  using Kind = LightColorPrior::Kind;
  if (text == "free") return LightColorPrior{Kind::free, {1, 1, 1}};
  if (text == "near-white") return LightColorPrior{Kind::near_white, {1, 1, 1}};
  std::istringstream in(text);
  Vec3f c;
  char a = 0, b = 0;
  if (!(in >> c.x >> a >> c.y >> b >> c.z) || a != ',' || b != ',' || !in.eof()) return {};
  if (!(std::min({c.x, c.y, c.z}) > 0) || !(std::max({c.x, c.y, c.z}) <= 1e6f)) return {};
  return LightColorPrior{Kind::known, c};
}

std::optional<Vec3f> relative_error(const LightCovariance& c) {
  const Vec3d variance{c.row[0].x, c.row[1].y, c.row[2].z};
  if (!(min(variance.x, min(variance.y, variance.z)) > 0)) return {};
  return to_float(Vec3d{std::sqrt(variance.x), std::sqrt(variance.y), std::sqrt(variance.z)});
}

// Minimizes (s - e)' C^-1 (s - e) + |s|^2 / split^2 + |q + B s|^2 / width^2 over the logarithms s of the
// factor: e is the estimate, B s are log ratios of channels, q those of the light over the prior color.
LightBelief weigh_light_color(const LightScale& evidence, Vec3f mean, const LightColorPrior& prior) {
  const Mat3d measured = inverse(with_diagonal(evidence.covariance, kModelError * kModelError));
  Mat3d precision = with_diagonal(measured, 1 / (kSplit * kSplit));
  Vec3d logs, said;
  for (int c = 0; c < 3; ++c) {
    logs[c] = std::log(std::max(double(mean[c]), 1e-9)) - std::log(double(prior.color[c]));
    said[c] = std::log(double(evidence.factor[c]));
  }
  Vec3d pull = measured * said;
  const double width = prior.kind == LightColorPrior::Kind::known ? kKnown : kNearWhite;
  for (const auto& b : kRatios) {
    if (prior.kind == LightColorPrior::Kind::free) break;
    const Vec3d ratio{b[0], b[1], b[2]};
    for (int i = 0; i < 3; ++i) precision.row[i] += ratio * (b[size_t(i)] / (width * width));
    pull += ratio * (-dot(ratio, logs) / (width * width));
  }
  LightBelief out;
  out.covariance = inverse(precision);
  const Vec3d s = out.covariance * pull;
  for (int c = 0; c < 3; ++c) out.factor[c] = float(std::exp(s[c]));
  return out;
}

}  // namespace cei3d
